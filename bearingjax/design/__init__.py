"""Design data: materials, profiles, ribs, bearings. Nothing is solved here.

Names
-----

- Ball bearings: `DeepGrooveBallBearing`, `AngularContactBallBearing`,
  `DoubleRowBallRow`, `FourPointBallBearing`, `SelfAligningBallRow`,
  `ThrustBallBearing`, `AbstractBallBearing`, `Groove`.
- Roller bearings: `CylindricalRollerBearing`, `NeedleRollerBearing`,
  `TaperedRollerBearing`, `CylindricalThrustRollerBearing`,
  `TaperedThrustRollerBearing`, `AbstractRollerBearing`.
- Barrel and crossed rollers: `SphericalRollerRow`, `SphericalThrustRollerBearing`,
  `ToroidalRollerBearing`, `CrossedRollerRow`, `AbstractBarrelBearing`,
  `pitch_on_sphere`.
- Any bearing: `AbstractBearing`.
- Sets: `BearingSet`, `SetRow`, `PreloadSpring`, `rows_of`.
- Profiles: `Straight`, `CircularCrown`, `CrownedEnds`, `Logarithmic`, `Lundberg`,
  `JohnsGohar`, `FujiwaraKawase`, `Tabulated`, `AbstractProfile`.
- Ribs: `Rib`, `Ribs`, `RIB_NAMES`.
- Materials: `Material`, `MATERIALS`, `contact_modulus`.
- Form errors and deviations: `FormErrors`, `RacewayErrors`, `Harmonics`, `Spall`,
  `Deviation`, `with_raceways`.
- Tolerances: `ball_grade`, `BallGrade`, `BALL_GRADES`, `roller_grade`, `RollerGrade`,
  `ROLLER_GRADES`, `running_accuracy`, `RunningAccuracy`, `TOLERANCE_CLASSES`.
"""

from .abstract import AbstractBearing
from .ball import AbstractBallBearing, Groove
from .ball_types import (
    AngularContactBallBearing,
    DeepGrooveBallBearing,
    DoubleRowBallRow,
    FourPointBallBearing,
    SelfAligningBallRow,
    ThrustBallBearing,
)
from .barrel import (
    AbstractBarrelBearing,
    CrossedRollerRow,
    CylindricalThrustRollerBearing,
    SphericalRollerRow,
    SphericalThrustRollerBearing,
    TaperedThrustRollerBearing,
    ToroidalRollerBearing,
    pitch_on_sphere,
)
from .bearing import (
    AbstractRollerBearing,
    CylindricalRollerBearing,
    NeedleRollerBearing,
    TaperedRollerBearing,
)
from .bearing_set import BearingSet, PreloadSpring, SetRow, rows_of
from .deviation import Deviation, with_raceways
from .form_error import FormErrors, Harmonics, RacewayErrors, Spall
from .logarithmic import FujiwaraKawase, JohnsGohar, Logarithmic, Lundberg
from .material import MATERIALS, Material, contact_modulus
from .profile import AbstractProfile, CircularCrown, CrownedEnds, Straight
from .rib import RIB_NAMES, Rib, Ribs
from .tabulated import Tabulated
from .tolerance import (
    BALL_GRADES,
    ROLLER_GRADES,
    TOLERANCE_CLASSES,
    BallGrade,
    RollerGrade,
    RunningAccuracy,
    ball_grade,
    roller_grade,
    running_accuracy,
)

__all__ = [
    "DeepGrooveBallBearing", "AngularContactBallBearing", "DoubleRowBallRow",
    "FourPointBallBearing", "SelfAligningBallRow", "ThrustBallBearing",
    "AbstractBallBearing", "Groove",
    "CylindricalRollerBearing", "NeedleRollerBearing", "TaperedRollerBearing",
    "CylindricalThrustRollerBearing", "TaperedThrustRollerBearing",
    "AbstractRollerBearing", "SphericalRollerRow", "SphericalThrustRollerBearing",
    "ToroidalRollerBearing", "CrossedRollerRow", "AbstractBarrelBearing",
    "pitch_on_sphere", "AbstractBearing", "BearingSet", "SetRow", "PreloadSpring",
    "rows_of", "Straight", "CircularCrown", "CrownedEnds", "Logarithmic", "Lundberg",
    "JohnsGohar", "FujiwaraKawase", "Tabulated", "AbstractProfile", "Rib", "Ribs",
    "RIB_NAMES", "Material", "MATERIALS", "contact_modulus", "FormErrors",
    "RacewayErrors", "Harmonics", "Spall", "Deviation", "with_raceways", "ball_grade",
    "BallGrade", "BALL_GRADES", "roller_grade", "RollerGrade", "ROLLER_GRADES",
    "running_accuracy", "RunningAccuracy", "TOLERANCE_CLASSES",
]  # fmt: skip

"""Rolling-bearing mechanics in JAX: one energy, differentiated.

SI units everywhere (m, N, rad, kg, s, Pa). float64 is the working precision; turn it on
before the first array is made:

    import jax
    jax.config.update("jax_enable_x64", True)

What each part does stands in its own docstring: `help(bearingjax.statics)` (load
solves, sweeps, what to do when one fails), `element` (choices of numerics, speed),
`optimise`, `rotor`, `rotor.nonlinear`, `skid`, `noise`, `contact.halfspace`.

Names
-----

A name stands at the top level if a calculation of one bearing starts with it: its
bearing and the parts of the drawing, what it runs under (speed, seats, preload, oil,
load cases), the function that gives the answer, and what says whether the answer holds.
Everything else is in the package of its subject, as are the classes of results and the
choices of laws and numerics: `life.Life`, `contact.ISO16281`, `rotor.Rotor`. Every
package lists its names in the same way, see `help(bearingjax.rotor)`.

- Packages, from the ground up: `numerics`, `files`, `design`, `fits`, `contact`,
  `lubrication`, `element`, `statics`, `life`, `cases`, `catalogue`, `friction`,
  `optimise`, `skid`, `rotor`, `shafts`, `noise`, `decide`, `validation`, `report`,
  `plot`, `studies`.
- Ball bearings: `DeepGrooveBallBearing`, `AngularContactBallBearing`,
  `FourPointBallBearing`, `SelfAligningBallRow`, `ThrustBallBearing`.
- Roller bearings: `CylindricalRollerBearing`, `NeedleRollerBearing`,
  `TaperedRollerBearing`, `CylindricalThrustRollerBearing`,
  `TaperedThrustRollerBearing`, `SphericalRollerRow`, `SphericalThrustRollerBearing`,
  `ToroidalRollerBearing`, `CrossedRollerRow`.
- Sets of rows: `BearingSet`, `SetRow`, `PreloadSpring`.
- Parts of a drawing: `Material`, `Rib`, `Ribs`, `Straight`, `CircularCrown`,
  `CrownedEnds`, `Logarithmic`, `Lundberg`, `JohnsGohar`, `FujiwaraKawase`, `Tabulated`.
- From a designation: `load_bearing`, `catalogue_entry`, `catalogue_entries`.
- The bearing as an element: `BearingElement`, `Speed`, `FREEDOMS`.
- Installation: `Installed`, `Mounting`, `FitConditions`, `preload`.
- Under a load: `solve_load`, `Support`, `linearise`, `refine`.
- Under many loads: `sweep`, `Cases`, `stack_designs`, `spectrum_life`.
- Ratings and life: `ratings`, `dynamic_capacity`, `static_capacity`, `rating_life`,
  `LifeConditions`.
- Oil and friction: `Lubricant`, `films`, `friction_torque`.
- Whether an answer holds: `Result`, `SolveError`, `warnings`.
- Identification from measurements: `identify`.
- Selection of a bearing from the catalogue: `select`.
- Tolerance analysis: `tolerances`.
- Scene files: `run`, `read_scene`, `SceneError`.
- The program: `keep_programs`, `__version__`.

Conventions
-----------

- z is the bearing axis; azimuth from +x towards +y. Ring freedoms (ux uy uz gx gy gz),
  outer ring first: `q` has 12. Loads (Fx Fy Fz Mx My Mz) act on the moving ring at the
  origin, the centre of the row; in a set the origin is where `position` is zero.
- `force` = dV/dq, the load that holds the rings there; `stiffness` = its derivative.
  With gyroscopic moments, or contact constants that follow the operating angle, not all
  forces have a potential: `stiffness` is then the exact Jacobian, not quite symmetric
  (`element.has_potential(speed)` tells).
- Raceway order: outer, inner. Rib order: `outer_minus`, `outer_plus`, `inner_minus`,
  `inner_plus` (-z, +z).
- A taper's large roller ends lie at -z: an inner-ring load along +z closes the bearing.
  So it is for a positive contact angle of balls. `position` along a roller runs from
  the large end to the small one, also in mirrored rows. In a set mirrored rows carry
  the other way.
- Barrel rollers and their raceways are arcs; profiles are measured from the arcs. The
  origin of a spherical roller bearing is the centre of its sphere. Thrust bearings:
  the inner ring is the shaft washer, at -z; an inner-ring load along +z closes them.
- Osculation is groove radius over ball diameter (0.52). Contact angles are positive
  where a row carries along +z. A deep groove bearing's zero has the rings centred, an
  angular contact bearing's has the balls just touching at their contact angle.
- With `Finite()` kinematics a ring's gx, gy are its rotation vector; its moments are
  conjugate to them (for tilts of a degree: moments about x and y within a per cent). A
  self-aligning bearing's tilts are prescribed: nothing restrains them.
- A set's `inner_offset` is what was ground off: `preload(element, force)` finds it. A
  `PreloadSpring` presses its row with force less stiffness times travel, never pulls.
- `radial_internal_clearance` is diametral; a quarter of it stands at each raceway of a
  roller. Negative: preload.
- Oils and films: temperatures in K, pressures above atmosphere, contact modulus E*
  (films take E' = 2 E* of it), entrainment speed the mean of both surface speeds
  relative to the contact. Slip and traction are those of the ball or roller.
- Rolling elements of a row may differ: `ball_deviation`, `roller_deviation` (diameter
  less the common one; the raceways stay) and `azimuth_deviation` (azimuth less that of
  even spacing), one number each.
- gz turns the set of rollers (rolling without slip). It is operating data: no torque
  comes of it, unless `cage_torque=True`; then moments about z are the virtual work of
  the contact forces. Derivatives of an answer with respect to a prescribed gz count all
  the same.
- A groove has no far side: a ball lifted past the groove centre touches nothing there.
  A turning ball that has left a raceway goes round as if that contact lay opposite its
  other one. On the loaded side a groove goes on beyond its shoulder; give the
  shoulder's height to be told (`solution.shoulder_margin`).
- The mass of a rolling element is that of its volume: give the `Material` of hollow or
  coated ones a density to match.
"""

import importlib as _importlib
from typing import TYPE_CHECKING as _TYPE_CHECKING

from . import (
    cases,
    catalogue,
    contact,
    design,
    element,
    fits,
    friction,
    life,
    lubrication,
    numerics,
    statics,
)
from ._version import __version__
from .cases import Cases, spectrum_life, stack_designs, sweep
from .catalogue import catalogue_entries, catalogue_entry
from .design import (
    AngularContactBallBearing,
    BearingSet,
    CircularCrown,
    CrossedRollerRow,
    CrownedEnds,
    CylindricalRollerBearing,
    CylindricalThrustRollerBearing,
    DeepGrooveBallBearing,
    FourPointBallBearing,
    FujiwaraKawase,
    JohnsGohar,
    Logarithmic,
    Lundberg,
    Material,
    NeedleRollerBearing,
    PreloadSpring,
    Rib,
    Ribs,
    SelfAligningBallRow,
    SetRow,
    SphericalRollerRow,
    SphericalThrustRollerBearing,
    Straight,
    Tabulated,
    TaperedRollerBearing,
    TaperedThrustRollerBearing,
    ThrustBallBearing,
    ToroidalRollerBearing,
)
from .element import FREEDOMS, BearingElement, Speed
from .fits import FitConditions, Mounting
from .friction import films, friction_torque
from .life import (
    LifeConditions,
    dynamic_capacity,
    rating_life,
    ratings,
    static_capacity,
)
from .lubrication import Lubricant
from .numerics import Result, SolveError, keep_programs
from .statics import (
    Installed,
    Support,
    linearise,
    preload,
    refine,
    solve_load,
    warnings,
)

if _TYPE_CHECKING:
    from . import (
        decide,
        files,
        noise,
        optimise,
        plot,
        report,
        rotor,
        shafts,
        skid,
        studies,
        validation,
    )
    from .decide import identify, select, tolerances
    from .files import SceneError
    from .studies.bearing.read_scene import load_bearing, read_scene
    from .studies.study import run

__all__ = [
    "numerics", "files", "design", "fits", "contact", "lubrication", "element",
    "statics", "life", "cases", "catalogue", "friction", "optimise", "skid", "rotor",
    "shafts", "noise", "decide", "validation", "report", "plot", "studies",
    "DeepGrooveBallBearing",
    "AngularContactBallBearing", "FourPointBallBearing", "SelfAligningBallRow",
    "ThrustBallBearing", "CylindricalRollerBearing", "NeedleRollerBearing",
    "TaperedRollerBearing", "CylindricalThrustRollerBearing",
    "TaperedThrustRollerBearing", "SphericalRollerRow", "SphericalThrustRollerBearing",
    "ToroidalRollerBearing", "CrossedRollerRow", "BearingSet", "SetRow",
    "PreloadSpring", "Material", "Rib", "Ribs", "Straight", "CircularCrown",
    "CrownedEnds", "Logarithmic", "Lundberg", "JohnsGohar", "FujiwaraKawase",
    "Tabulated", "load_bearing", "catalogue_entry", "catalogue_entries",
    "BearingElement", "Speed", "FREEDOMS", "Installed", "Mounting", "FitConditions",
    "preload", "solve_load", "Support", "linearise", "refine", "sweep", "Cases",
    "stack_designs", "spectrum_life", "ratings", "dynamic_capacity", "static_capacity",
    "rating_life", "LifeConditions", "Lubricant", "films", "friction_torque", "Result",
    "SolveError", "warnings", "identify", "select", "tolerances", "run", "read_scene",
    "SceneError",
    "keep_programs", "__version__",
]  # fmt: skip


# Imported at first use: packages, and names of the top level with their package.
_LATE = dict.fromkeys(
    "decide files noise optimise plot report rotor shafts skid studies"
    " validation".split()
) | {
    "SceneError": "files",
    "identify": "decide",
    "select": "decide",
    "tolerances": "decide",
    "load_bearing": "studies.bearing.read_scene",
    "read_scene": "studies.bearing.read_scene",
    "run": "studies.study",
}


def __getattr__(name: str):
    """Import a package, or a name of one, at its first use (PEP 562)."""
    if name not in _LATE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    package = _importlib.import_module(f"{__name__}.{_LATE[name] or name}")
    value = getattr(package, name) if _LATE[name] else package
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """All public names, imported or not."""
    return sorted({*globals(), *_LATE})

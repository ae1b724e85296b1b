"""What stands on the drawing: materials, profiles, ribs, bearings. Data, no solving."""

from .bearing import AbstractRollerBearing as AbstractRollerBearing
from .bearing import CylindricalRollerBearing as CylindricalRollerBearing
from .bearing import NeedleRollerBearing as NeedleRollerBearing
from .bearing import TaperedRollerBearing as TaperedRollerBearing
from .material import MATERIALS as MATERIALS
from .material import Material as Material
from .material import contact_modulus as contact_modulus
from .profile import AbstractProfile as AbstractProfile
from .profile import CircularCrown as CircularCrown
from .profile import CrownedEnds as CrownedEnds
from .profile import FujiwaraKawase as FujiwaraKawase
from .profile import JohnsGohar as JohnsGohar
from .profile import Logarithmic as Logarithmic
from .profile import Lundberg as Lundberg
from .profile import Straight as Straight
from .profile import Tabulated as Tabulated
from .rib import ARRANGEMENTS as ARRANGEMENTS
from .rib import RIB_NAMES as RIB_NAMES
from .rib import Rib as Rib
from .rib import Ribs as Ribs

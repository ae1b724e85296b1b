"""The bearing as an element: one energy, its equilibrium and its derivatives."""

from .bearing_element import BearingElement as BearingElement
from .bearing_element import Evaluated as Evaluated
from .bearing_element import Row as Row
from .constants import ContactConstants as ContactConstants
from .constants import contact_constants as contact_constants
from .frame import FREEDOMS as FREEDOMS
from .frame import LOADS as LOADS
from .frame import RINGS as RINGS
from .inertia import Speed as Speed
from .inertia import inertia_force as inertia_force
from .inertia import mass_and_inertia as mass_and_inertia
from .inertia import roller_speeds as roller_speeds
from .kinematics import AbstractKinematics as AbstractKinematics
from .kinematics import Finite as Finite
from .kinematics import Linearised as Linearised

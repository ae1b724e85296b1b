"""The bearing in a rotor: linear, nonlinear vibration, coefficients, adapters."""

from . import vibration as vibration
from .bearing_support import BearingSupport as BearingSupport
from .coefficients import stiffness_table as stiffness_table
from .critical import CriticalSpeeds as CriticalSpeeds
from .critical import critical_speeds as critical_speeds
from .damping import AbstractDamping as AbstractDamping
from .damping import ModalDamping as ModalDamping
from .damping import ProportionalDamping as ProportionalDamping
from .modes import Modes as Modes
from .modes import campbell as campbell
from .modes import modes as modes
from .parts import AbstractPart as AbstractPart
from .parts import AbstractSupport as AbstractSupport
from .parts import Disc as Disc
from .parts import Housing as Housing
from .parts import LinearSupport as LinearSupport
from .parts import PointMass as PointMass
from .preload_offset import preload_offset as preload_offset
from .response import Unbalance as Unbalance
from .response import UnbalanceResponse as UnbalanceResponse
from .response import unbalance_response as unbalance_response
from .ross import to_ross as to_ross
from .rotor import Rotor as Rotor
from .rotor import RotorMatrices as RotorMatrices
from .shaft import STATION_FREEDOMS as STATION_FREEDOMS
from .shaft import Shaft as Shaft

"""Dynamics: balls that skid."""

from .conditions import Conditions as Conditions
from .conditions import by_raceway as by_raceway
from .conditions import conditions as conditions
from .history import SkidHistory as SkidHistory
from .model import SkidModel as SkidModel
from .motion import SkidState as SkidState
from .ring_load import LoadHistory as LoadHistory
from .ring_load import SinusoidalLoad as SinusoidalLoad
from .ring_speed import SpeedTable as SpeedTable
from .ring_speed import ramp as ramp
from .steady import Power as Power
from .steady import SteadySkid as SteadySkid
from .steady import steady_skid as steady_skid
from .surroundings import Cage as Cage
from .surroundings import Drag as Drag
from .transient import skid as skid
from .warning import skid_warnings as skid_warnings

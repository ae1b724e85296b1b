"""Dynamics: balls that skid."""

from .conditions import Conditions as Conditions
from .conditions import by_raceway as by_raceway
from .conditions import conditions as conditions
from .model import SkidModel as SkidModel
from .steady import Power as Power
from .steady import SteadySkid as SteadySkid
from .steady import steady_skid as steady_skid
from .surroundings import Cage as Cage
from .surroundings import Drag as Drag
from .warning import skid_warnings as skid_warnings

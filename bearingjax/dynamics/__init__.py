"""Dynamics: balls that skid."""

from .model import SkidModel as SkidModel
from .steady import Power as Power
from .steady import SteadySkid as SteadySkid
from .steady import steady_skid as steady_skid
from .surroundings import Cage as Cage
from .surroundings import Drag as Drag

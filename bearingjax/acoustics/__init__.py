"""Noise and vibration: spectra, bands, levels, and where lines come from."""

from .level import REFERENCE_ACCELERATION as REFERENCE_ACCELERATION
from .level import acceleration_of as acceleration_of
from .level import combined as combined
from .level import level as level

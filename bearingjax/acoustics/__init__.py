"""Noise and vibration: spectra, bands, levels, and where lines come from."""

from .bands import Bands as Bands
from .bands import band_levels as band_levels
from .bands import band_root_mean_square as band_root_mean_square
from .bands import is_held as is_held
from .bands import octave_bands as octave_bands
from .bands import third_octave_bands as third_octave_bands
from .bands import total_root_mean_square as total_root_mean_square
from .level import REFERENCE_ACCELERATION as REFERENCE_ACCELERATION
from .level import acceleration_of as acceleration_of
from .level import combined as combined
from .level import level as level
from .lines import UNNAMED as UNNAMED
from .lines import Line as Line
from .lines import name_lines as name_lines
from .orders import KinematicFrequencies as KinematicFrequencies
from .orders import WavinessForce as WavinessForce
from .orders import kinematic_frequencies as kinematic_frequencies
from .orders import waviness_force as waviness_force
from .spectrum import AbstractWindow as AbstractWindow
from .spectrum import Hann as Hann
from .spectrum import Rectangular as Rectangular
from .spectrum import Spectrum as Spectrum
from .spectrum import spectrum as spectrum

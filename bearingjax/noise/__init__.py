"""Noise and vibration: form errors to vibration, spectra, bands, levels, lines.

A bearing on its rig (`NoiseModel`): one ring turns at constant speed, the other one (or
the shaft) may move and is loaded, every ball or roller is a mass of its own, the cage
carries them round, a sensor touches the ring. `vibration(model, ...)` follows it in
time under its form errors (`bearingjax.design.FormErrors`, `Harmonics`, `design.Spall`;
differences of diameter and spacing are the bearing's own: `ball_deviation`,
`azimuth_deviation`). `natural_modes` has frequencies and shapes with the rolling
elements' own masses; `excitation` the quasi-static displacement and force of the rings
over the turn; `linear_model` and `transfer` the way from there to the sensor.

Levels and bands of the acceleration (`level`, `band_levels`), prominent lines with
their names (`name_lines`: `3 BPFO`, `BPFI + shaft`, `2 cage`), the errors that cause
them to first order (`line_causes`), and the number of contacts of every element
(`contact_states`). `model_warnings`, `record_warnings` and `contribution_warnings` give
the warnings of the command line on a record and its levels. `monte_carlo` draws
bearings within tolerance classes and gives the distribution of their levels, and
`source_contributions` the share of every tolerance in it. On CPUs the short steps of
`vibration` are 1.4 times as fast on one thread: set `PJRT_NPROC=1` in the environment
before JAX starts, as the command line does.

Waves and damping are seldom known: levels compare designs and tolerances, they do not
predict the reading of a rig. Example: the notebook noise_from_form_errors.
"""

from .bands import Bands as Bands
from .bands import band_levels as band_levels
from .bands import band_root_mean_square as band_root_mean_square
from .bands import band_shift as band_shift
from .bands import is_held as is_held
from .bands import octave_bands as octave_bands
from .bands import third_octave_bands as third_octave_bands
from .bands import total_root_mean_square as total_root_mean_square
from .causes import line_causes as line_causes
from .contact_width import contact_half_width as contact_half_width
from .contact_width import with_bridged_waves as with_bridged_waves
from .dynamics.cage import GuidedCage as GuidedCage
from .dynamics.cage_contact import CageContact as CageContact
from .dynamics.contact_states import ContactStates as ContactStates
from .dynamics.contact_states import contact_states as contact_states
from .dynamics.system import NoiseSystem as NoiseSystem
from .level import REFERENCE_ACCELERATION as REFERENCE_ACCELERATION
from .level import acceleration_of as acceleration_of
from .level import combine_levels as combine_levels
from .level import level as level
from .linear import LinearModel as LinearModel
from .linear import Transfer as Transfer
from .linear import linear_model as linear_model
from .linear import transfer as transfer
from .lines import UNNAMED as UNNAMED
from .lines import Line as Line
from .lines import name_lines as name_lines
from .model import NoiseModel as NoiseModel
from .monte_carlo import MonteCarlo as MonteCarlo
from .monte_carlo import monte_carlo as monte_carlo
from .monte_carlo import sampled_model as sampled_model
from .natural import NaturalModes as NaturalModes
from .natural import after_orbit as after_orbit
from .natural import natural_modes as natural_modes
from .natural import ring_modes as ring_modes
from .natural import stiffness as stiffness
from .orders import KinematicFrequencies as KinematicFrequencies
from .orders import WavinessForce as WavinessForce
from .orders import kinematic_frequencies as kinematic_frequencies
from .orders import waviness_force as waviness_force
from .quasi_static import Excitation as Excitation
from .quasi_static import excitation as excitation
from .scatter import RandomWaves as RandomWaves
from .scatter import SampledErrors as SampledErrors
from .scatter import Tolerances as Tolerances
from .scatter import sample_errors as sample_errors
from .sensor import Sensor as Sensor
from .sound import sound as sound
from .sound import write_sound as write_sound
from .source_contributions import SourceContributions as SourceContributions
from .source_contributions import source_contributions as source_contributions
from .spectrum import AbstractWindow as AbstractWindow
from .spectrum import Hann as Hann
from .spectrum import Rectangular as Rectangular
from .spectrum import Spectrum as Spectrum
from .spectrum import spectrum as spectrum
from .static_start import static_start as static_start
from .vibration import CageMotion as CageMotion
from .vibration import Vibration as Vibration
from .vibration import bandwidth as bandwidth
from .vibration import needed_steps as needed_steps
from .vibration import rounding as rounding
from .vibration import vibration as vibration
from .warning import contribution_warnings as contribution_warnings
from .warning import model_warnings as model_warnings
from .warning import record_warnings as record_warnings

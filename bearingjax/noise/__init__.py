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

Names
-----

- The bearing on its rig: `NoiseModel`, `Sensor`, `GuidedCage`, `CageContact`,
  `static_start`, `with_bridged_waves`, `contact_half_width`.
- Vibration in time: `vibration`, `Vibration`, `CageMotion`, `needed_steps`,
  `bandwidth`, `contact_states`, `ContactStates`.
- Small and slow motion: `natural_modes`, `NaturalModes`, `ring_modes`, `linear_model`,
  `LinearModel`, `transfer`, `Transfer`, `excitation`, `Excitation`.
- Spectra: `spectrum`, `Spectrum`, `Hann`, `Rectangular`, `AbstractWindow`,
  `envelope_spectrum`, `HIGH_BAND`.
- Levels and bands: `level`, `acceleration_of`, `combine_levels`,
  `REFERENCE_ACCELERATION`, `octave_bands`, `third_octave_bands`, `Bands`,
  `band_levels`, `band_root_mean_square`, `band_shift`, `total_root_mean_square`.
- Lines and orders: `kinematic_frequencies`, `KinematicFrequencies`, `waviness_force`,
  `WavinessForce`, `name_lines`, `NameRule`, `PeakRule`, `Line`, `line_causes`.
- Many bearings: `Tolerances`, `RandomWaves`, `sample_errors`, `SampledErrors`,
  `sampled_model`, `monte_carlo`, `RecordOptions`, `LevelOptions`, `MonteCarlo`,
  `source_contributions`, `ContributionOptions`, `SourceContributions`.
- Sound and warnings: `sound`, `write_sound`, `model_warnings`, `record_warnings`,
  `contribution_warnings`.
"""

from .bands import (
    Bands,
    band_levels,
    band_root_mean_square,
    band_shift,
    octave_bands,
    third_octave_bands,
    total_root_mean_square,
)
from .causes import line_causes
from .contact_width import contact_half_width, with_bridged_waves
from .dynamics.cage import GuidedCage
from .dynamics.cage_contact import CageContact
from .dynamics.contact_states import ContactStates, contact_states
from .level import REFERENCE_ACCELERATION, acceleration_of, combine_levels, level
from .linear import LinearModel, Transfer, linear_model, transfer
from .lines import Line, NameRule, PeakRule, name_lines
from .model import NoiseModel
from .monte_carlo import (
    LevelOptions,
    MonteCarlo,
    RecordOptions,
    monte_carlo,
    sampled_model,
)
from .natural import NaturalModes, natural_modes, ring_modes
from .orders import (
    KinematicFrequencies,
    WavinessForce,
    kinematic_frequencies,
    waviness_force,
)
from .quasi_static import Excitation, excitation
from .scatter import RandomWaves, SampledErrors, Tolerances, sample_errors
from .sensor import Sensor
from .sound import sound, write_sound
from .source_contributions import (
    ContributionOptions,
    SourceContributions,
    source_contributions,
)
from .spectrum import (
    HIGH_BAND,
    AbstractWindow,
    Hann,
    Rectangular,
    Spectrum,
    envelope_spectrum,
    spectrum,
)
from .static_start import static_start
from .vibration import CageMotion, Vibration, bandwidth, needed_steps, vibration
from .warning import contribution_warnings, model_warnings, record_warnings

__all__ = [
    "NoiseModel", "Sensor", "GuidedCage", "CageContact", "static_start",
    "with_bridged_waves", "contact_half_width", "vibration", "Vibration", "CageMotion",
    "needed_steps", "bandwidth", "contact_states", "ContactStates", "natural_modes",
    "NaturalModes", "ring_modes", "linear_model", "LinearModel", "transfer", "Transfer",
    "excitation", "Excitation", "spectrum", "Spectrum", "Hann", "Rectangular",
    "AbstractWindow", "envelope_spectrum", "HIGH_BAND", "level", "acceleration_of",
    "combine_levels",
    "REFERENCE_ACCELERATION", "octave_bands", "third_octave_bands", "Bands",
    "band_levels", "band_root_mean_square", "band_shift", "total_root_mean_square",
    "kinematic_frequencies", "KinematicFrequencies", "waviness_force", "WavinessForce",
    "name_lines", "NameRule", "PeakRule", "Line", "line_causes", "Tolerances",
    "RandomWaves", "sample_errors", "SampledErrors", "sampled_model", "monte_carlo",
    "RecordOptions", "LevelOptions", "MonteCarlo", "source_contributions",
    "ContributionOptions", "SourceContributions", "sound", "write_sound",
    "model_warnings", "record_warnings", "contribution_warnings",
]  # fmt: skip

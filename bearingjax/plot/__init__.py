"""Plots of bearings and solutions; matplotlib is imported at the first plot.

A plot draws on the axes `ax`, on those of a new figure if they are `None`, and returns
them; a page returns its figure.

Names
-----

- Pages: `overview`, `sweep_overview`, `life_overview`, `contact_overview`,
  `optimise_overview`, `identify_overview`, `noise_overview`, `skid_overview`,
  `rotor_overview`, `shaft_overview`, `selection_overview`, `tolerance_overview`,
  `validation_overview`.
- Drawings: `drawing`, `cross_section`, `cross_sections`, `rotor_section`, `profile`.
- A solved bearing: `load_zone`, `contact_angles`, `ellipses`, `pressure_map`,
  `pressure_profiles`, `load_displacement`, `stiffness_over_speed`.
- Half-space contacts: `contact_map`, `contact_surface`, `contact_stress`,
  `contact_line_load`, `centre_pressure`.
- Noise: `acceleration_over_time`, `noise_spectrum`, `noise_envelope`, `band_bars`,
  `contact_state_map`, `level_distribution`, `source_bars`.
- Rotors: `campbell_diagram`, `mode_shapes`, `linear_curve`, `speed_curve`,
  `response_curve`, `orbits`, `waveforms`, `waterfall`.
- Skidding over the orbit: `load_over_orbit`, `sliding_over_orbit`, `spin_over_orbit`,
  `heat_over_orbit`, `cage_force_over_orbit`.
- Skidding over time: `speed_over_time`, `slip_over_time`, `load_over_time`,
  `sliding_over_time`, `spin_over_time`, `cage_force_over_time`, `power_over_time`.
- Other plots of skidding: `cage_speed`, `power_bars`, `sliding_spectrum`, `heat_map`,
  `sliding_map`.
"""

from .contact import (
    centre_pressure,
    contact_line_load,
    contact_map,
    contact_overview,
    contact_stress,
    contact_surface,
)
from .decisions import identify_overview, selection_overview, tolerance_overview
from .drawings.drawing import drawing
from .drawings.section import cross_section, cross_sections
from .element_contacts import contact_angles, ellipses, pressure_map, pressure_profiles
from .life import life_overview
from .load import load_displacement, load_zone, stiffness_over_speed
from .noise import (
    acceleration_over_time,
    band_bars,
    contact_state_map,
    level_distribution,
    noise_envelope,
    noise_overview,
    noise_spectrum,
    source_bars,
)
from .optimise_overview import optimise_overview
from .page import overview
from .profiles import profile
from .rotors.rotor import rotor_section
from .rotors.rotor_vibration import (
    campbell_diagram,
    linear_curve,
    mode_shapes,
    orbits,
    response_curve,
    rotor_overview,
    speed_curve,
    waterfall,
    waveforms,
)
from .shafts import shaft_overview
from .skidding.skid import cage_speed, heat_map, power_bars, skid_overview, sliding_map
from .skidding.skid_curves import (
    cage_force_over_orbit,
    cage_force_over_time,
    heat_over_orbit,
    load_over_orbit,
    load_over_time,
    power_over_time,
    sliding_over_orbit,
    sliding_over_time,
    sliding_spectrum,
    slip_over_time,
    speed_over_time,
    spin_over_orbit,
    spin_over_time,
)
from .sweep import sweep_overview
from .validation import validation_overview

__all__ = [
    "overview", "sweep_overview", "life_overview", "contact_overview",
    "optimise_overview", "identify_overview", "noise_overview", "skid_overview",
    "rotor_overview", "shaft_overview", "selection_overview", "tolerance_overview",
    "validation_overview", "drawing", "cross_section", "cross_sections",
    "rotor_section", "profile", "load_zone",
    "contact_angles", "ellipses", "pressure_map", "pressure_profiles",
    "load_displacement", "stiffness_over_speed", "contact_map", "contact_surface",
    "contact_stress", "contact_line_load", "centre_pressure", "acceleration_over_time",
    "noise_spectrum", "noise_envelope", "band_bars", "contact_state_map",
    "level_distribution",
    "source_bars", "campbell_diagram", "mode_shapes", "linear_curve", "speed_curve",
    "response_curve", "orbits", "waveforms", "waterfall", "load_over_orbit",
    "sliding_over_orbit", "spin_over_orbit", "heat_over_orbit", "cage_force_over_orbit",
    "speed_over_time", "slip_over_time", "load_over_time", "sliding_over_time",
    "spin_over_time", "cage_force_over_time", "power_over_time", "cage_speed",
    "power_bars", "sliding_spectrum", "heat_map", "sliding_map",
]  # fmt: skip

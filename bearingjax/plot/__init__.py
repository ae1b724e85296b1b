"""Plots of bearings and solutions; matplotlib is imported at the first plot."""

from .balls import contact_angles as contact_angles
from .balls import ellipses as ellipses
from .contact import contact_map as contact_map
from .contact import contact_overview as contact_overview
from .contact import contact_surface as contact_surface
from .contact_lines import centre_pressure as centre_pressure
from .contact_lines import contact_line_load as contact_line_load
from .contact_stress import contact_stress as contact_stress
from .load import load_displacement as load_displacement
from .load import load_zone as load_zone
from .load import stiffness_over_speed as stiffness_over_speed
from .optimised import optimised as optimised
from .page import overview as overview
from .pressure import pressure_map as pressure_map
from .pressure import pressure_profiles as pressure_profiles
from .profiles import profile as profile
from .section import cross_section as cross_section

"""Friction torque, lubricant films of solved bearings, reference speed."""

from .contact_films import Films as Films
from .contact_films import films as films
from .friction import SUPPLIES as SUPPLIES
from .friction import Friction as Friction
from .friction import friction_torque as friction_torque
from .friction_skf import SkfFriction as SkfFriction
from .friction_skf import skf_friction_torque as skf_friction_torque
from .friction_skf import skf_series as skf_series
from .friction_skf import skf_series_of as skf_series_of
from .reference_speed import heat_area as heat_area
from .reference_speed import reference_factors as reference_factors
from .reference_speed import reference_speed as reference_speed
from .reference_speed import thermal_speed as thermal_speed

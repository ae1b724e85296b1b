"""Oil between rolling surfaces: viscosity, films, traction."""

from .film import Film as Film
from .film import Regime as Regime
from .film import at_least as at_least
from .film import inlet_heating as inlet_heating
from .film import lambda_ratio as lambda_ratio
from .film import line_film as line_film
from .film import point_film as point_film
from .film import starvation as starvation
from .lubricant import Density as Density
from .lubricant import Lubricant as Lubricant
from .oils import OILS as OILS
from .oils import free_volume_23699 as free_volume_23699
from .oils import iso_vg as iso_vg
from .oils import mil_l_23699 as mil_l_23699
from .viscosity import AbstractAmbient as AbstractAmbient
from .viscosity import AbstractCoefficient as AbstractCoefficient
from .viscosity import AbstractPressureLaw as AbstractPressureLaw
from .viscosity import Barus as Barus
from .viscosity import ConstantCoefficient as ConstantCoefficient
from .viscosity import DynamicCoefficient as DynamicCoefficient
from .viscosity import Exponential as Exponential
from .viscosity import FreeVolume as FreeVolume
from .viscosity import KinematicCoefficient as KinematicCoefficient
from .viscosity import Roelands as Roelands
from .viscosity import Walther as Walther
from .viscosity_index import viscosity_at_100 as viscosity_at_100

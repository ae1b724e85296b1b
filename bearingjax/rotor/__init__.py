"""The bearing in a rotor: coefficients over speed, adapters to rotor packages."""

from .coefficients import stiffness_table as stiffness_table
from .ross import to_ross as to_ross

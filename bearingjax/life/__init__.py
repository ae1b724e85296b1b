"""Ratings and rating life: ISO 281, ISO 76, ISO/TS 16281.

`dynamic_capacity`, `static_capacity` and `fatigue_load_limit` rate a bearing, or a set
of alike ones, by ISO 281 and ISO 76 from its geometry; `ratings`, and so every life,
takes what is given or what the catalogue prints for a bearing of it instead, and says
which is which. A catalogue's C may be higher: makers use factors of their own. Bearings
steeper than 45 degrees are rated by axial loads.
"""

from .equivalent_load import EquivalentLoad as EquivalentLoad
from .equivalent_load import equivalent_load as equivalent_load
from .life import LIFE_OUTPUTS as LIFE_OUTPUTS
from .life import Life as Life
from .life import LifeConditions as LifeConditions
from .life import rating_life as rating_life
from .life_factor import CLEANLINESS as CLEANLINESS
from .life_factor import Cleanliness as Cleanliness
from .life_factor import life_factor as life_factor
from .life_factor import reliability_factor as reliability_factor
from .life_factor import viscosity_ratio as viscosity_ratio
from .life_warning import life_warnings as life_warnings
from .rating import Ratings as Ratings
from .rating import dynamic_capacity as dynamic_capacity
from .rating import fatigue_load_limit as fatigue_load_limit
from .rating import rated_axially as rated_axially
from .rating import ratings as ratings
from .rating import static_capacity as static_capacity
from .refined_life import refined_lamina_loads as refined_lamina_loads

"""Seats of bearings: ISO 286, interference, mounted clearance, temperatures.

Names
-----

- The mounted bearing: `mount`, `Mounting`, `FitConditions`, `fit_state`, `FitState`,
  `radial_clearance`, `with_radial_clearance`, `with_bearing_dimensions`,
  `needed_drive_up`.
- From the drawing to operation: `fit_states`, `FitStates`.
- Scatter of sizes: `SizeLimits`, `clearance_range`, `ClearanceRange`, `mounting_at`,
  `PLACES`.
- ISO 286: `limits`, `Limits`, `standard_tolerance`, `LIMIT_CLASSES`.
- Tolerances of bearings: `bore_limits`, `outside_limits`.
- Clearance before mounting: `ball_clearance`, `roller_clearance`,
  `self_aligning_clearance`, `spherical_roller_clearance`, `toroidal_roller_clearance`,
  `CLEARANCE_CLASSES`.
- Materials that grow: `WarmMaterial`, `WARM_MATERIALS`.
"""

from .fit_limits import (
    CLEARANCE_CLASSES,
    ball_clearance,
    bore_limits,
    outside_limits,
    roller_clearance,
    self_aligning_clearance,
    spherical_roller_clearance,
    toroidal_roller_clearance,
)
from .fit_range import (
    PLACES,
    ClearanceRange,
    FitStates,
    SizeLimits,
    clearance_range,
    fit_states,
    mounting_at,
)
from .fits import FitConditions, FitState, Mounting, fit_state, needed_drive_up
from .iso286 import LIMIT_CLASSES, Limits, limits, standard_tolerance
from .mounting import (
    mount,
    radial_clearance,
    with_bearing_dimensions,
    with_radial_clearance,
)
from .warm_material import WARM_MATERIALS, WarmMaterial

__all__ = [
    "mount", "Mounting", "FitConditions", "fit_state", "FitState", "radial_clearance",
    "with_radial_clearance", "with_bearing_dimensions", "needed_drive_up", "fit_states",
    "FitStates", "SizeLimits", "clearance_range", "ClearanceRange", "mounting_at",
    "PLACES", "limits", "Limits", "standard_tolerance", "LIMIT_CLASSES", "bore_limits",
    "outside_limits", "ball_clearance", "roller_clearance", "self_aligning_clearance",
    "spherical_roller_clearance", "toroidal_roller_clearance", "CLEARANCE_CLASSES",
    "WarmMaterial", "WARM_MATERIALS",
]  # fmt: skip

"""Two bodies, one contact: line contact laws, Hertz point contact, pressures.

Names
-----

- Laws of line contacts: `Palmgren`, `ISO16281`, `LineConstant`, `CoupledSlices`.
- Laws of point contacts: `FreeAngle`, `OperatingAngle`, `ZeroAngle`, `PointConstant`.
- Parents of your own laws: `AbstractLineLaw`, `AbstractSliceLaw`,
  `AbstractLineContact`, `LineContact`, `AbstractPointLaw`.
- Hertz's point contact: `ellipse`, `Ellipse`, `shear_below`, `axis_stress`, `Shear`,
  `sphere_constant`, `sphere_peak_pressure`.
- Hertz's line contact: `half_width`, `peak_pressure`, `relative_radius`.
"""

from .coupled import CoupledSlices
from .hertz import (
    Ellipse,
    Shear,
    axis_stress,
    ellipse,
    shear_below,
    sphere_constant,
    sphere_peak_pressure,
)
from .line import (
    ISO16281,
    AbstractLineLaw,
    LineConstant,
    Palmgren,
    half_width,
    peak_pressure,
    relative_radius,
)
from .line_contact import AbstractLineContact, AbstractSliceLaw, LineContact
from .point_law import (
    AbstractPointLaw,
    FreeAngle,
    OperatingAngle,
    PointConstant,
    ZeroAngle,
)

__all__ = [
    "Palmgren", "ISO16281", "LineConstant", "CoupledSlices", "FreeAngle",
    "OperatingAngle", "ZeroAngle", "PointConstant", "AbstractLineLaw",
    "AbstractSliceLaw", "AbstractLineContact", "LineContact", "AbstractPointLaw",
    "ellipse", "Ellipse", "shear_below", "axis_stress", "Shear", "sphere_constant",
    "sphere_peak_pressure", "half_width", "peak_pressure", "relative_radius",
]  # fmt: skip

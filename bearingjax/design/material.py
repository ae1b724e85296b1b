"""Materials of rollers and rings."""

from typing import Any, ClassVar

import equinox as eqx

from ..numerics.shown import Printable
from ..numerics.types import Real
from ..numerics.units import real
from .checks import check_fields


class Material(Printable):
    """An isotropic elastic material, by default bearing steel.

    Attributes:
        elastic_modulus: Young's modulus E [Pa].
        poisson_ratio: Poisson's ratio ν [1].
        density: Density [kg/m³].

    Traced: all fields.
    """

    about: ClassVar[str] = "an isotropic elastic material, by default bearing steel"
    elastic_modulus: Real = eqx.field(
        **real("Pa", "Young's modulus E", above=0), default=206e9
    )
    poisson_ratio: Real = eqx.field(
        **real("1", "Poisson's ratio ν", above=-1, below=0.5), default=0.3
    )
    density: Real = eqx.field(**real("kg/m³", "density", above=0), default=7850.0)

    def __check_init__(self):
        check_fields(self)

    @classmethod
    def steel(cls) -> "Material":
        """Through-hardened bearing steel: 206 GPa, 0.3, 7850 kg/m³."""
        return cls()

    @classmethod
    def silicon_nitride(cls) -> "Material":
        """Hot isostatically pressed Si3N4 of hybrid bearings: 310 GPa, 0.26, 3200.

        Source: middle of the ranges that makers of hybrid bearings print (300 to
            320 GPa, 0.26, 3200 to 3250 kg/m³).
        """
        return cls(310e9, 0.26, 3200.0)

    @classmethod
    def zirconia(cls) -> "Material":
        """Yttria-stabilised ZrO2: 205 GPa, 0.30, 6050 kg/m³.

        Source: usual data-sheet values of Y-TZP (200 to 210 GPa, 0.3, 6000 to 6100).
        """
        return cls(205e9, 0.30, 6050.0)


MATERIALS = {
    "steel": Material.steel,
    "silicon_nitride": Material.silicon_nitride,
    "zirconia": Material.zirconia,
}
"""Makers of the named materials."""


def contact_modulus(a: Material, b: Material) -> Any:
    """Contact modulus E* = 1/((1-ν1²)/E1 + (1-ν2²)/E2) of two bodies [Pa].

    A number of JAX, or of NumPy for materials of NumPy numbers.

    Source: Johnson, Contact Mechanics (1985), eq. (4.20).
    """
    return 1.0 / (
        (1.0 - a.poisson_ratio**2) / a.elastic_modulus
        + (1.0 - b.poisson_ratio**2) / b.elastic_modulus
    )

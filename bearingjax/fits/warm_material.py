"""Materials with their thermal expansion."""

import equinox as eqx

from ..design.checks import in_range, instance
from ..design.material import Material
from ..numerics.types import Real
from ..numerics.units import real


class WarmMaterial(eqx.Module):
    """A material and its thermal expansion, by default of bearing steel.

    Attributes:
        material: Elastic constants and density.
        expansion: Coefficient of linear thermal expansion α [1/K].

    Traced: all fields.

    Source: 12e-6 1/K of bearing steel: catalogue of SNH; NTN and IKO print 12.5e-6.
        The others: usual data-sheet values, 3 to 3.3e-6 for silicon nitride.
    """

    material: Material = eqx.field(default_factory=Material)
    expansion: Real = eqx.field(**real("1/K"), default=12e-6)

    def __check_init__(self):
        instance(self, "material", Material)
        in_range(self, "expansion", -1e-4, 1e-3)

    @classmethod
    def steel(cls) -> "WarmMaterial":
        """Bearing steel: 206 GPa, 0.3, 7850 kg/m³, 12e-6 1/K."""
        return cls()

    @classmethod
    def cast_iron(cls) -> "WarmMaterial":
        """Grey cast iron: 110 GPa, 0.26, 7200 kg/m³, 10.5e-6 1/K."""
        return cls(Material(110e9, 0.26, 7200.0), 10.5e-6)

    @classmethod
    def aluminium(cls) -> "WarmMaterial":
        """Aluminium alloys: 70 GPa, 0.33, 2700 kg/m³, 23e-6 1/K."""
        return cls(Material(70e9, 0.33, 2700.0), 23e-6)

    @classmethod
    def silicon_nitride(cls) -> "WarmMaterial":
        """Silicon nitride, as `Material.silicon_nitride`: 3.2e-6 1/K."""
        return cls(Material.silicon_nitride(), 3.2e-6)

    @classmethod
    def zirconia(cls) -> "WarmMaterial":
        """Zirconia, as `Material.zirconia`: 10.5e-6 1/K."""
        return cls(Material.zirconia(), 10.5e-6)


WARM_MATERIALS = {
    "steel": WarmMaterial.steel,
    "cast_iron": WarmMaterial.cast_iron,
    "aluminium": WarmMaterial.aluminium,
    "silicon_nitride": WarmMaterial.silicon_nitride,
    "zirconia": WarmMaterial.zirconia,
}
"""Makers of the named materials."""

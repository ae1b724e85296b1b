"""The [lubricant] table of a scene: an oil, its temperature, its law of traction."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from ... import lubrication
from ...files.quantity import kind_of
from ...files.schema import Keys, scene_key
from ...friction.friction import SUPPLIES
from ...numerics.units import CELSIUS, unit_of
from ...numerics.warning import Warning

VISCOSITY_LAWS = {
    "free_volume": lubrication.FreeVolume,
    "barus": lubrication.Barus,
    "roelands": lubrication.Roelands,
}
"""Laws of viscosity over pressure; the first includes the temperature."""

TRACTIONS = {
    "newtonian": lubrication.Newtonian,
    "eyring": lubrication.Eyring,
    "limiting": lubrication.LimitingStress,
    "slip_curve": lubrication.SlipCurve,
    "dry": lubrication.DryFriction,
}

DENSITY = 900.0
"""Default density of an oil at 15 °C [kg/m³]."""

_AMBIENT = ("grade", "cold_viscosity", "reference_viscosity")
_OF_PRESSURE = ("barus", "roelands")
"""Laws of the pressure alone, which require the ambient viscosity."""


class LubricantKeys(Keys):
    about = (
        "[lubricant]: an oil by its name, or by a law of its viscosity over pressure"
    )

    numbers: ClassVar[Mapping[str, type]] = {
        "`law` = free_volume": lubrication.FreeVolume,
        "`cold_viscosity`": lubrication.Walther,
        "`reference_viscosity`": lubrication.Exponential,
    }

    temperature: float = scene_key(
        "temperature of the oil", "temperature", least=-60, most=250
    )
    name: str | None = scene_key("one of these oils", choices=tuple(lubrication.OILS))
    law: str | None = scene_key(
        "law of viscosity over pressure, in place of a `name`",
        choices=tuple(VISCOSITY_LAWS),
        without={"name": ""},
    )
    coefficient: float | None = scene_key(
        "pressure-viscosity coefficient of the law, required",
        "pressure coefficient",
        only={"law": _OF_PRESSURE},
    )
    grade: float | None = scene_key(
        "ISO VG, the viscosity at 40 °C in mm²/s", only={"law": _OF_PRESSURE}
    )
    viscosity_index: float | None = scene_key(
        "viscosity index of a `grade` or an ISO VG", otherwise="95"
    )
    reference_viscosity: float | None = scene_key(
        "viscosity at `reference_temperature`", "viscosity", needs=("law",)
    )
    reference_temperature: float | None = scene_key(
        "temperature of the reference",
        "temperature",
        needs=("reference_viscosity",),
        otherwise="`temperature`; `free_volume` needs it",
    )
    film_coefficient: float | None = scene_key(
        "pressure-viscosity coefficient for films",
        "pressure coefficient",
        needs=("law",),
        otherwise="α* of the law, 1/∫ μ(0)/μ(p) dp, not its slope at zero pressure",
    )
    density: float | None = scene_key(
        "density at `density_temperature`",
        "density",
        needs=("law",),
        otherwise=f"{DENSITY:g} kg/m³, and it is said",
    )
    density_slope: float | None = scene_key(
        "loss of density per kelvin",
        "density slope",
        needs=("law",),
        otherwise=f"{lubrication.Density.slope:g} kg/(m³ K)",
    )
    density_temperature: float | None = scene_key(
        "temperature of the density", "temperature", needs=("law",), otherwise="15 °C"
    )
    traction: lubrication.AbstractTraction = scene_key(
        "law of traction, of what skids", of=TRACTIONS, default="newtonian"
    )
    supply: str = scene_key(
        "how the oil is supplied, for the friction torque of `solve`",
        choices=SUPPLIES,
        default="oil_bath",
    )
    roughness: float | None = scene_key(
        "root mean square of both surfaces together, for the films of `solve`",
        "length",
        above=0,
        below=1e-4,
    )

    @property
    def oil_name(self) -> str:
        """Name of the oil, or of its law."""
        return str(self.name or self.law)

    @property
    def assumed(self) -> tuple[Warning, ...]:
        """Assumptions made about the oil."""
        if self.law is None or self.density is not None:
            return ()
        density = f"{DENSITY:g} kg/m³ is taken at 15 °C"
        words = f"the oil's density is not given: {density}"
        return (Warning("assumed_density", words, DENSITY),)

    def check(self) -> None:
        if self.law is None and self.name is None:
            names = ", ".join(lubrication.OILS)
            problem = f"is missing; give one of {names}, or a `law` with its numbers"
            raise self.table.error("name", problem)
        graded = self.grade is not None or self.oil_name.startswith("ISO VG")
        if self.viscosity_index is not None and not graded:
            problem = "goes with a `grade`, or with the `name` of an ISO VG"
            raise self.table.error("viscosity_index", problem)
        more = self.density_slope, self.density_temperature
        if self.density is None and more != (None, None):
            problem = "is missing; the other numbers of the density go with it"
            raise self.table.error("density", problem)

    def oil(self) -> lubrication.Lubricant:
        """Build the lubricant."""
        if self.name is not None:
            index = self.viscosity_index
            given = {} if index is None else {"viscosity_index": index}
            with self.table.building():
                return lubrication.OILS[self.name](**given)
        if self.law == "free_volume":
            ambient = pressure = self.build_law(lubrication.FreeVolume)
        else:
            ambient = self._ambient()
            # Raises if it is missing.
            coefficient = self.table.quantity("coefficient", "pressure coefficient")
            with self.table.building():
                pressure = VISCOSITY_LAWS[self.law or ""](coefficient)
        density = {
            "value": DENSITY if self.density is None else self.density,
            "slope": self.density_slope,
            "reference_temperature": self.density_temperature,
        }
        given = {name: value for name, value in density.items() if value is not None}
        with self.table.building():
            return lubrication.Lubricant(
                ambient, pressure, lubrication.Density(**given), self.film_coefficient
            )

    def _ambient(self) -> lubrication.AbstractAmbient:
        """Read the law of viscosity at atmospheric pressure, of one of three forms."""
        table = self.table
        given = [key for key in _AMBIENT if key in table]
        if len(given) != 1:
            ways = ", ".join(f"`{key}`" for key in _AMBIENT)
            problem = "is missing" if not given else f"stands beside `{given[0]}`"
            key = "reference_viscosity" if not given else given[1]
            raise table.error(key, f"{problem}; give one of {ways}")
        if self.grade is not None:
            index = 95.0 if self.viscosity_index is None else self.viscosity_index
            self.fill(viscosity_index=index)
            with table.building(index="viscosity_index"):
                return lubrication.Walther.from_grade(self.grade, index)
        if given == ["cold_viscosity"]:
            return self.build_law(lubrication.Walther)
        # Without coefficients the viscosity is that at the given temperature.
        values = dict(reference_temperature=self.temperature, first=0.0, second=0.0)
        for name in ("reference_viscosity", *values):
            if name in table:
                kind = kind_of(unit_of(lubrication.Exponential, name))
                values[name] = table.quantity(name, kind)
        with table.building():
            return lubrication.Exponential(**values)


def describe_oil(lubricant: lubrication.Lubricant, temperature: float) -> str:
    """Describe viscosity, pressure coefficient and density of an oil.

    Args:
        lubricant: The oil.
        temperature: Its temperature [K].
    """
    viscosity, coefficient, density = (
        float(np.asarray(value))
        for value in (
            lubricant.viscosity(0.0, temperature),
            lubricant.pressure_coefficient(temperature),
            lubricant.density.at(temperature),
        )
    )
    return (
        f"{temperature - CELSIUS:.4g} °C: {1e3 * viscosity:.4g} mPa s,"
        f" {1e9 * coefficient:.4g} 1/GPa, {density:.4g} kg/m³"
    )

"""The [lubricant] table of a scene: an oil, its temperature, its law of traction."""

import numpy as np

from ..lubrication import (
    OILS,
    AbstractAmbient,
    AbstractTraction,
    Barus,
    Density,
    DryFriction,
    Exponential,
    Eyring,
    FreeVolume,
    LimitingStress,
    Lubricant,
    Newtonian,
    Roelands,
    SlipCurve,
    Walther,
    iso_vg,
)
from ..numerics.units import unit_of
from .table import Table

LAWS = {"free_volume": FreeVolume, "barus": Barus, "roelands": Roelands}
"""Laws of viscosity over pressure; the first has the temperature in it."""

TRACTIONS = {
    "newtonian": Newtonian,
    "eyring": Eyring,
    "limiting": LimitingStress,
    "slip_curve": SlipCurve,
    "dry": DryFriction,
}

DENSITY = 900.0
"""Of an oil at 15 °C whose density is not given [kg/m³]."""

_AMBIENT = ("grade", "cold_viscosity", "reference_viscosity")
_COLDEST, _HOTTEST = -60.0, 250.0
_ZERO = 273.15


def read_lubricant(table: Table) -> tuple[Lubricant, float, tuple[str, ...]]:
    """An oil, its temperature [K], and what was assumed of it.

    Args:
        table: `[lubricant]`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    temperature = table.quantity("temperature", "temperature")
    celsius = temperature - _ZERO
    if not _COLDEST <= celsius <= _HOTTEST:
        allowed = f"from {_COLDEST:g} to {_HOTTEST:g} °C"
        raise table.error("temperature", f"{celsius:.5g} °C is not allowed; {allowed}")
    if "law" in table:
        if "name" in table:
            raise table.error("law", "give either `name` or this, not both")
        oil, odd = _by_law(table, temperature)
        return oil, temperature, odd
    if "name" not in table:
        names = ", ".join(OILS)
        problem = f"is missing; give one of {names}, or a `law` with its numbers"
        raise table.error("name", problem)
    return _named(table), temperature, ()


def read_traction(table: Table) -> AbstractTraction:
    """Law of traction at the key `traction`, by its name or with its numbers.

    Args:
        table: `[lubricant]`.
    """
    given = table.table_or_word("traction", tuple(TRACTIONS))
    if given is None:
        table.fill("traction", "newtonian")
        return Newtonian()
    if isinstance(given, Table):
        kind, own = TRACTIONS[given.choice("type", tuple(TRACTIONS))], given
    else:
        kind, own = TRACTIONS[given], table.empty("traction")
    values = own.fields(kind)
    with own.building():
        return kind(**values)


def _named(table: Table) -> Lubricant:
    name = table.choice("name", tuple(OILS))
    if not name.startswith("ISO VG") or "viscosity_index" not in table:
        return OILS[name]()
    index = table.number("viscosity_index")
    with table.building():
        return iso_vg(float(name.split()[-1]), index)


def _by_law(table: Table, temperature: float) -> tuple[Lubricant, tuple[str, ...]]:
    law = LAWS[table.choice("law", tuple(LAWS))]
    if law is FreeVolume:
        values = table.fields(FreeVolume)
        with table.building():
            ambient = pressure = FreeVolume(**values)
    else:
        coefficient = table.quantity("coefficient", "pressure coefficient")
        ambient = _ambient(table, temperature)
        with table.building():
            pressure = law(coefficient)
    of_films = table.quantity("film_coefficient", "pressure coefficient", None)
    density, odd = _density(table)
    with table.building():
        return Lubricant(ambient, pressure, density, of_films), odd


def _ambient(table: Table, temperature: float) -> AbstractAmbient:
    """Viscosity at atmospheric pressure, by one of three ways."""
    given = [key for key in _AMBIENT if key in table]
    if len(given) != 1:
        ways = ", ".join(f"`{key}`" for key in _AMBIENT)
        problem = "is missing" if not given else f"stands beside `{given[0]}`"
        key = "reference_viscosity" if not given else given[1]
        raise table.error(key, f"{problem}; give one of {ways}")
    if given == ["grade"]:
        grade, index = table.number("grade"), table.number("viscosity_index", 95.0)
        with table.building():
            return Walther.from_grade(grade, index)
    if given == ["cold_viscosity"]:
        values = table.fields(Walther)
        with table.building():
            return Walther(**values)
    # Without factors the viscosity is that of the one temperature that there is.
    values = {"reference_temperature": temperature, "first": 0.0, "second": 0.0}
    for name in ("reference_viscosity", *values):
        if name in table:
            values[name] = table.real(name, unit_of(Exponential, name))
    with table.building():
        return Exponential(**values)


def _density(table: Table) -> tuple[Density, tuple[str, ...]]:
    keys = {
        "value": "density",
        "slope": "density_slope",
        "reference_temperature": "density_temperature",
    }
    values = {}
    for name, key in keys.items():
        value = table.real(key, unit_of(Density, name), None)
        if value is not None:
            values[name] = value
    odd = ()
    if "value" not in values:
        if values:
            problem = "is missing; the other numbers of the density go with it"
            raise table.error("density", problem)
        values["value"] = DENSITY
        odd = (f"the oil's density is not given: {DENSITY:g} kg/m³ is taken at 15 °C",)
    with table.building():
        return Density(**values), odd


def described(lubricant: Lubricant, temperature: float) -> str:
    """Viscosity, pressure coefficient and density of an oil in words.

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
        f"{temperature - _ZERO:.4g} °C: {1e3 * viscosity:.4g} mPa s,"
        f" {1e9 * coefficient:.4g} 1/GPa, {density:.4g} kg/m³"
    )

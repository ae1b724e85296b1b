"""Units of fields: stated once, with the field, for checks, tables and messages."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np

from .types import as_real

Units = str | tuple[Any, ...]
"""A unit, or those of the entries along the last axes of an array, nested."""


def unit(name: Units, about: str = "", **allowed: Any) -> dict[str, Any]:
    """Metadata of a field of real numbers, `eqx.field(metadata=unit("m"))`.

    Args:
        name: SI unit; "1" for a pure number. Of an array with entries of several
            units those of the entries along its last axes: ("m", "m", "rad"). They
            begin anew where the axis is longer.
        about: What it is, in one line without a full stop; empty of one that a scene
            cannot give.
        **allowed: As in `meaning`; or how reports show a result of each rolling
            element: `column`, the heading of its column, and `largest`, the name of its
            largest number, which is a result too.
    """
    return {"unit": name} | (meaning(about, **allowed) if about else allowed)


def real(name: Units, about: str = "", **allowed: Any) -> dict[str, Any]:
    """Arguments of a field of type `Real`, which `as_real` converts.

    A field is `mass: Real = eqx.field(**real("kg", "mass of the ring", above=0))`.

    Args:
        name, about, **allowed: As in `unit`.
    """
    return {"converter": as_real, "metadata": unit(name, about, **allowed)}


def meaning(about: str, **allowed: Any) -> dict[str, Any]:
    """Metadata of a field that a scene may give.

    Args:
        about: As in `unit`.
        **allowed: Values that are allowed, as attributes of `files.schema.Key`: their
            range (`above`, `least`, `below`, `most`, in SI), which the class checks too
            (`design.checks.check_fields`), `choices` of words, and what is meant
            `otherwise`, without it.
    """
    return {"about": about, **allowed}


def units(*names: str) -> dict[str, Any]:
    """Metadata of an array whose entries have several units.

    Args:
        names: SI units of its entries, in no order.
    """
    return {"units": names}


def unit_of(owner: Any, path: str, index: tuple[int, ...] = ()) -> str:
    """Unit of a field, as shown after a number.

    Args:
        owner: Class of the field, or an instance: a Module, whose fields have units as
            metadata, or a named tuple, whose fields are `Annotated[..., unit("N")]`.
        path: Name of the field; dotted, "rows.0.position", of a part of an instance;
            numbers at the end are the entry of an array.
        index: Which entry of an array.

    Returns:
        SI unit; empty for a pure number, a count, other objects, and for an array
        of several units without the index of one entry.

    Raises:
        KeyError, AttributeError: If there is no such field.
    """
    *parts, name = path.split(".")
    while name.isdecimal():
        index = (int(name), *index)
        *parts, name = parts
    for part in parts:
        owner = owner[int(part)] if isinstance(owner, tuple) else getattr(owner, part)
    return entry_unit(field_metadata(owner, name).get("unit", "1"), index)


def entry_unit(stated: Units, index: Sequence[int]) -> str:
    """Unit of an entry of an array, empty for a pure number.

    Args:
        stated: Units of the array, as in `unit`.
        index: Which entry; empty for an array of several units without it.
    """
    units = np.asarray(stated)
    if len(index) < units.ndim:
        return ""
    last = zip(index[len(index) - units.ndim :], units.shape, strict=True)
    found = str(units[tuple(k % size for k, size in last)])
    return "" if found == "1" else found


def field_metadata(owner: Any, name: str) -> Mapping[str, Any]:
    """Metadata of a field of a dataclass or of a named tuple.

    Args:
        owner: Class of the field, or an instance.
        name: Field.

    Raises:
        KeyError: If there is no such field.
    """
    if dataclasses.is_dataclass(owner):
        return {f.name: f.metadata for f in dataclasses.fields(owner)}[name]
    kind = owner if isinstance(owner, type) else type(owner)
    stated: dict[str, Any] = {}
    for base in reversed(kind.__mro__):
        stated |= base.__dict__.get("__annotations__", {})
    found: dict[str, Any] = {}
    for one in get_args(stated[name])[1:]:
        found |= one if isinstance(one, dict) else {}
    return found


CELSIUS = 273.15
"""0 °C [K]."""

_SHOWN = {
    "m": (1e6, "µm"),
    "rad": (1e3, "mrad"),
    "Pa": (1e-6, "MPa"),
    "N": (1e-3, "kN"),
    "rad/s": (30.0 / np.pi, "rpm"),
    "rev": (1e-6, "million rev"),
    "1/rev": (1e6, "1/million rev"),
    "m²/s": (1e6, "mm²/s"),
}
_LARGE = {
    "m": (1e-3, 1e3, "mm"),
    "Pa": (1e10, 1e-9, "GPa"),
    "rad": (0.1, 180.0 / np.pi, "deg"),
}

_SMALL_FORCE = 100.0
"""Force below which a single number is shown in N."""

DISPLAYED = {
    shown: (factor, 0.0, unit)
    for kinds in (_SHOWN.items(), [(k, large[1:]) for k, large in _LARGE.items()])
    for unit, (factor, shown) in kinds
} | {"°C": (1.0, CELSIUS, "K")}
"""By the unit shown: factor from SI, its zero in SI, the SI unit."""


def display_unit(unit: str, largest: float = 0.0) -> tuple[float, str]:
    """Factor from SI, and the unit in which numbers are shown to people.

    Args:
        unit: SI unit; empty for a pure number.
        largest: The largest number that is shown so [SI]: lengths from 1 mm are shown
            in mm, moduli in GPa, angles from 0.1 rad in degrees.
    """
    least, factor, shown = _LARGE.get(unit, (np.inf, 1.0, unit))
    return (factor, shown) if largest >= least else _SHOWN.get(unit, (1.0, unit))


def shown_count(count: int, noun: str) -> str:
    """A number of things, as it is shown to people: "1 step", "2 steps"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def shown_number(value: float, unit: str, digits: int = 4) -> str:
    """A number with its unit, as it is shown to people: "25 µm", "60 °C".

    Args:
        value: In SI; temperatures, not their differences, in K.
        unit: SI unit; empty for a pure number.
        digits: Significant digits.
    """
    if np.isinf(value):
        return "infinite" if value > 0.0 else "-infinite"
    if unit == "K":
        return f"{value - CELSIUS:.{digits}g} °C"
    small = unit == "N" and abs(value) < _SMALL_FORCE
    factor, shown = (1.0, unit) if small else display_unit(unit, abs(value))
    return f"{factor * value:.{digits}g} {shown}".rstrip()


def shown_change(value: float, unit: str, digits: int = 4) -> str:
    """A difference, such as an error, as `shown_number` shows numbers: "2 K"."""
    kelvin = unit == "K" and np.isfinite(value)
    return f"{value:.{digits}g} K" if kelvin else shown_number(value, unit, digits)


def rpm(speed: Any) -> str:
    """Format a speed in rpm.

    Args:
        speed: Speed [rad/s].
    """
    return f"{float(speed) * 30.0 / np.pi:.5g} rpm"

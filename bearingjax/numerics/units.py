"""Units of fields: stated once, with the field, for checks, tables and messages."""

import ast
import dataclasses
import functools
import inspect
import re
import sys
from typing import Any

import numpy as np

Units = str | tuple[Any, ...]
"""A unit, or those of the entries along the last axes of an array, nested."""


def unit(name: Units) -> dict[str, Any]:
    """Metadata of a field of real numbers, `eqx.field(metadata=unit("m"))`.

    Args:
        name: SI unit; "1" for a pure number. Of an array with entries of several
            units those of the entries along its last axes: ("m", "m", "rad"). They
            begin anew where the axis is longer.
    """
    return {"unit": name}


def unit_of(owner: Any, path: str, index: tuple[int, ...] = ()) -> str:
    """Unit of a field, as shown after a number.

    Args:
        owner: Class of the field, or an instance: a Module with metadata, or a named
            tuple, whose docstring states its units.
        path: Name of the field; dotted, "rows.0.position", of a part of an instance;
            a number at the end is the entry of an array.
        index: Which entry of an array.

    Returns:
        SI unit; empty for a pure number, a count, other objects, and for an array
        of several units without the index of one entry.

    Raises:
        KeyError, AttributeError: If there is no such field.
    """
    *parts, name = path.split(".")
    if name.isdecimal():
        *parts, name = parts
        index = (int(path.rpartition(".")[2]),)
    for part in parts:
        owner = owner[int(part)] if isinstance(owner, tuple) else getattr(owner, part)
    if dataclasses.is_dataclass(owner):
        fields = {field.name: field for field in dataclasses.fields(owner)}
        units = np.asarray(fields[name].metadata.get("unit", "1"))
    else:
        stated = stated_units(owner if isinstance(owner, type) else type(owner), name)
        units = np.asarray(stated[0] if len(stated) == 1 else stated or "1")
    if len(index) < units.ndim:
        return ""
    last = zip(index[len(index) - units.ndim :], units.shape, strict=True)
    found = str(units[tuple(k % size for k, size in last)])
    return "" if found == "1" else found


def stated_units(kind: type, name: str) -> tuple[str, ...]:
    """Units that a class or its parents state of an attribute, in their docstrings.

    Args:
        kind: Class whose docstring has an entry "name: what it is [unit]", or
            "name, other: what they are [N, N m]"; its first line may state the unit of
            all entries without one.
        name: Attribute.

    Returns:
        Those of the last brackets; empty if there are none.

    Raises:
        KeyError: If the docstring does not state it.
    """
    entry = rf"^ +(?:\w+, )*{name}(?:, \w+)*: (.*?)(?=^ +\w+(?:, \w+)*: |^\s*$|\Z)"
    said = False
    for base in kind.__mro__:
        text = docstring(base)
        found = re.search(entry, text, re.M | re.S)
        if found:
            said = True
            for part in (found[1], text.partition("\n")[0]):
                units = re.findall(r"\[([^]]*)\]", part)
                if units:
                    return tuple(u.strip() for u in units[-1].split(","))
    if not said:
        raise KeyError(f"{kind.__name__}: the docstring does not state {name}")
    return ()


@functools.cache
def docstring(kind: type) -> str:
    """Docstring of a class, without its parents' and without indentation.

    Args:
        kind: Class; of one of this package the source is read if Python runs without
            docstrings, `python -OO`.
    """
    if sys.flags.optimize >= 2 and kind.__module__.startswith("bearingjax"):
        return _docstrings(kind.__module__).get(kind.__name__, "")
    return inspect.cleandoc(kind.__dict__.get("__doc__") or "")


@functools.cache
def _docstrings(module: str) -> dict[str, str]:
    """Docstrings of the classes of a module, by their names."""
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    kinds = [node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    return {kind.name: ast.get_docstring(kind) or "" for kind in kinds}


_SHOWN = {
    "m": (1e6, "µm"),
    "rad": (1e3, "mrad"),
    "Pa": (1e-6, "MPa"),
    "N": (1e-3, "kN"),
    "rad/s": (30.0 / np.pi, "rpm"),
    "rev": (1e-6, "million rev"),
    "1/rev": (1e6, "1/million rev"),
}


def display_unit(unit: str, largest: float = 0.0) -> tuple[float, str]:
    """Factor from SI, and the unit in which numbers are shown to people.

    Args:
        unit: SI unit; empty for a pure number.
        largest: The largest number that is shown so [SI]: lengths from 1 mm are shown
            in mm, moduli in GPa.
    """
    if unit == "m" and largest >= 1e-3:
        return 1e3, "mm"
    if unit == "Pa" and largest >= 1e10:
        return 1e-9, "GPa"
    return _SHOWN.get(unit, (1.0, unit))


def shown_count(count: int, noun: str) -> str:
    """A number of things, as it is shown to people: "1 step", "2 steps"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


CELSIUS = 273.15
"""0 °C [K]."""


def shown_number(value: float, unit: str) -> str:
    """A number with its unit, as it is shown to people: "25 µm", "60 °C".

    Args:
        value: In SI; temperatures, not their differences, in K.
        unit: SI unit; empty for a pure number.
    """
    if unit == "K":
        return f"{value - CELSIUS:.4g} °C"
    factor, shown = display_unit(unit, abs(value))
    return f"{factor * value:.4g} {shown}".rstrip()

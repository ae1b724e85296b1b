"""The structure of the inputs of a compiled program, as text.

Two inputs with the same text give the same program: all that JAX traces is named by
shape and type, all that it does not trace by value. Inputs that may not be
distinguished reliably have no text: no program is kept rather than a wrong one.
"""

import dataclasses
import enum
import hashlib
import sys
from typing import Any

import jax
import numpy as np


class UnknownStructure(TypeError):
    """Something that cannot be named for certain."""


def structure(tree: Any) -> str:
    """Name the structure of nested modules, tuples, lists, dicts and arrays.

    Args:
        tree: Arguments of a program; its JAX arrays are traced, all else is static.

    Raises:
        UnknownStructure: For classes from outside the package, functions that are not
            found by their name, and all other objects.
    """
    return _name(tree, False)


def _name(value: Any, static: bool) -> str:
    if value is None or type(value) in (bool, int, float, str):
        return repr(value)
    if isinstance(value, jax.Array) and not static:
        return f"array{value.shape}{value.dtype}{value.weak_type:d}"
    if isinstance(value, jax.Array | np.ndarray | np.generic):
        held = np.asarray(value)
        if held.dtype.hasobject:
            raise UnknownStructure(f"array of {held.dtype}")
        digest = hashlib.sha256(held.tobytes()).hexdigest()
        return f"numbers{held.shape}{held.dtype}{type(value).__name__}{digest}"
    if isinstance(value, jax.sharding.Mesh):
        # The devices themselves are named by what surrounds a program.
        return f"mesh{value.axis_names}{value.devices.shape}"
    if isinstance(value, enum.Enum):
        return f"{_place(type(value))}.{value.name}"
    if type(value) in (tuple, list):
        inner = ",".join(_name(one, static) for one in value)
        return f"{type(value).__name__}({inner})"
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        inner = ",".join(_name(one, static) for one in value)
        return f"{_place(type(value))}({inner})"
    if type(value) is dict:
        if not all(type(key) is str for key in value):
            raise UnknownStructure("dict whose keys are not all text")
        # As JAX does, whatever the order in which they were written.
        inner = ",".join(f"{k!r}:{_name(value[k], static)}" for k in sorted(value))
        return f"dict({inner})"
    if isinstance(value, type) or hasattr(value, "__qualname__"):
        return _place(value)
    if dataclasses.is_dataclass(value):
        return _module(value, static)
    raise UnknownStructure(f"{type(value).__module__}.{type(value).__qualname__}")


def _module(value: Any, static: bool) -> str:
    """Name a module by its class and fields, which define it completely."""
    fields = dataclasses.fields(value)
    names = {field.name for field in fields}
    if not vars(value).keys() <= names:
        raise UnknownStructure(f"{type(value).__qualname__} with more than its fields")
    inner = ",".join(
        f"{field.name}={_name(getattr(value, field.name), _is_static(field, static))}"
        for field in fields
    )
    return f"{_place(type(value))}({inner})"


def _is_static(field: dataclasses.Field, static: bool) -> bool:
    return static or bool(field.metadata.get("static", False))


def _place(named: Any) -> str:
    """Module and name of a class or function of this package."""
    place, name = named.__module__, named.__qualname__
    found: Any = sys.modules.get(place)
    for part in name.split("."):
        found = getattr(found, part, None)
    if found is not named or place.split(".")[0] != __name__.split(".")[0]:
        raise UnknownStructure(f"{place}.{name}")
    return f"{place}.{name}"

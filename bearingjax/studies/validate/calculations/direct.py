"""Any public function or method, called with the inputs of a case."""

import dataclasses
import functools
import importlib
import inspect
from collections.abc import Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....catalogue.entry import bearing_of_entry, catalogue_entry
from ....design.bearing_set import BearingSet, rows_of
from ....design.keywords import bearing_of
from ....numerics.types import Reals, Scalar

_ARRAYS = Scalar, Reals, Reals | float
"""Annotations of arguments that NumPy's arrays and numbers do not meet."""


def bearing_by(bearing: str | Mapping[str, Any], arrangement: str = "") -> Any:
    """Return a bearing by its designation or its keywords: alone, one `row` of it, or
    a pair."""
    if isinstance(bearing, str):
        own = bearing_of_entry(catalogue_entry(bearing))
    else:
        own = bearing_of(bearing)
    if arrangement == "row":
        return rows_of(own)[0].bearing
    return getattr(BearingSet, arrangement)(own, 0.03) if arrangement else own


def call(function: str, **given: Any) -> Mapping[str, Any]:
    """Return what a public function returns, as `value` or its fields by name.

    Args:
        function: "life.ratings" is that of `bearingjax`; "oil.density.at" is a method
            of the argument `oil`.
        given: Its arguments by name; those of a row may be dotted, "mounting.bore".
            `bearing` is a designation, or keywords of a design, with an `arrangement`
            of it. A table with `make` is what that function returns.
    """
    for key in [key for key in given if "." in key]:
        table, _, name = key.partition(".")
        given[table] = {**given[table], name: given.pop(key)}
    if "bearing" in given:
        given["bearing"] = bearing_by(given["bearing"], given.pop("arrangement", ""))
    found = _as_data(_call_named({"make": function, **given}))
    return found if isinstance(found, Mapping) else {"value": found}


def _call_named(value: Any) -> Any:
    if not isinstance(value, Mapping) or "make" not in value:
        return value
    given = {
        name: _call_named(inner) for name, inner in value.items() if name != "make"
    }
    first, *names = value["make"].split(".")
    if hasattr(given.get(first), names[0]):
        called = functools.reduce(getattr, names, given.pop(first))
    else:
        owner = ".".join(("...", first, *names[:-1]))
        called = getattr(importlib.import_module(owner, __package__), names[-1])
    kinds = inspect.signature(called).parameters
    arrays = {name for name in given if kinds[name].annotation in _ARRAYS}
    return called(**{k: jnp.asarray(v) if k in arrays else v for k, v in given.items()})


def _as_data(found: Any) -> Any:
    """Return a result as tables by the names of its fields, lists and numbers; a named
    tuple with its properties that are numbers."""
    if isinstance(found, jax.Array | np.ndarray):
        return np.asarray(found).tolist()
    kind = type(found)
    names = [*getattr(kind, "_fields", ())]
    own = [k for k, v in vars(kind).items() if names and isinstance(v, property)]
    names += [k for k in own if isinstance(getattr(found, k), jax.Array)]
    if dataclasses.is_dataclass(found):
        names = [field.name for field in dataclasses.fields(found)]
    if names:
        found = {name: getattr(found, name) for name in names}
    if isinstance(found, Mapping):
        return {name: _as_data(value) for name, value in found.items()}
    if isinstance(found, list | tuple):
        return [_as_data(value) for value in found]
    return found

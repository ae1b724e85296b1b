"""Validation of design data: every message names parameter, value, unit and range.

Checks act on concrete numbers and let traced ones through: under `jit` or `grad` a
design was checked when it was made, and a bad traced number ends in a result code.
They use NumPy, because an eager JAX operation would have to be compiled.

A field of the owner is checked by its name: its value and unit are looked up. Of
anything else, value and unit are `given` after all other arguments.
"""

import dataclasses
from collections.abc import Collection, Sequence
from numbers import Real
from operator import ge, gt, le, lt
from typing import Any

import jax
import numpy as np
from jax.core import Tracer

from ..numerics.units import unit_of


def is_traced(value: Any) -> bool:
    """Whether a value is being traced, so that its number is not known."""
    return isinstance(value, Tracer)


def are_known(*trees: Any) -> bool:
    """Whether functions of these may look at their numbers: none is traced, nor is the
    function that calls, in which JAX gives no operation a number.

    Args:
        trees: Modules, tuples, dicts of arrays.
    """
    if any(map(is_traced, jax.tree.leaves(trees))):
        return False
    return not is_traced(jax.device_put(0.0))


def floats(*values: Any) -> list[float] | None:
    """Numbers as Python floats, or `None` if one is traced (or no number at all)."""
    if any(is_traced(v) or not is_real(v) for v in values):
        return None
    return [float(v) for v in values]


def check(owner: Any, name: str, ok: Any, allowed: str, *given: Any) -> None:
    """Raise unless `ok`.

    Args:
        owner: Instance, class or name of the checked object.
        name: Parameter.
        ok: Whether its value is allowed; skipped if traced.
        allowed: Allowed values, ending the sentence "it must be ...".
        given: Value and unit (empty for a pure number), if not a field of `owner`.

    Raises:
        ValueError: If `ok` is false.
    """
    value, unit = given or _field(owner, name)
    if is_traced(ok) or is_traced(value) or bool(np.all(ok)):
        return
    shown = _with_unit(_format_value(value), unit)
    raise ValueError(f"{_title(owner)}: `{name}` is {shown}; it must be {allowed}.")


def check_filled(owner: Any, filled: Any, places: int) -> None:
    """Raise unless a number of filled places is a whole one of them.

    Args:
        owner: The bearing.
        filled: Its `filled`: an array of whole numbers.
        places: Number of its places.

    Raises:
        TypeError: If it is no array of whole numbers, which a program may take.
        ValueError: If it is below 1 or above the number of places.
    """
    if getattr(getattr(filled, "dtype", None), "kind", "") != "i":
        raise TypeError(
            f"{_title(owner)}: `filled` is {filled!r}; it must be an array of whole"
            " numbers, as `design.places.with_places` makes it."
        )
    if not is_traced(filled):
        known = np.asarray(filled)
        allowed = f"from 1 to the number of places, {places}"
        check(owner, "filled", (known >= 1) & (known <= places), allowed, known, "")


def is_real(value: Any) -> bool:
    """Whether a value is a real number or an array of them; traced ones pass."""
    if is_traced(value):
        return True
    try:
        return np.asarray(value).dtype.kind not in _ODD + "b"
    except (TypeError, ValueError):
        return False


def number(owner: Any, name: str, *given: Any) -> None:
    """A single finite number.

    Args:
        owner, name, given: As in `check`.

    Raises:
        TypeError: If it is text, a bool, another object or nothing at all.
        ValueError: If it is an array, NaN or infinite.
    """
    title, (value, unit) = _title(owner), given or _field(owner, name)
    if not is_real(value):
        raise TypeError(
            f"{title}: `{name}` is {value!r}; it must be a number"
            f"{f' in {unit}' if unit else ''} (units belong in scene files)."
        )
    allowed = f"one number{f' in {unit}' if unit else ''}"
    of_shape(owner, name, np.shape(value) == (), allowed, value)
    if not is_traced(value):
        check(owner, name, np.isfinite(value), "a finite number", value, unit)


def real_numbers(owner: str, name: str, value: Any, wanted: str) -> None:
    """Real numbers: an array, or lists of them.

    Args:
        owner: Function that was called.
        name: Parameter.
        value: Value that it was given.
        wanted: Ending of the sentence "it must be ...".

    Raises:
        TypeError: For text, dicts, `None` or complex numbers, there or in a list.
    """
    rest = [value]
    while rest:
        one = rest.pop()
        if isinstance(one, Sequence) and not isinstance(one, str | bytes):
            rest.extend(one)
            continue
        dtype = getattr(one, "dtype", None)
        if dtype is None and hasattr(one, "__array__"):  # a table of another package
            dtype = np.asarray(one).dtype
        real = isinstance(one, Real) if dtype is None else dtype.kind not in _ODD
        if not real:
            shown = repr(one)
            shown = shown if len(shown) < 60 else f"{shown[:57]}..."
            where = "is" if one is value else "holds"
            raise TypeError(f"{owner}: `{name}` {where} {shown}; it must be {wanted}.")


_ODD = "OUSc"
"""Kinds of NumPy's dtypes that are no real numbers: objects, texts, complex ones."""


def finite(owner: Any, name: str, *given: Any) -> None:
    """A finite number, or an array of them; arguments as in `check`."""
    value, _ = given or _field(owner, name)
    if not is_traced(value):
        check(owner, name, np.isfinite(value), "finite", *given)


def positive(owner: Any, name: str, *given: Any) -> None:
    """A finite number above zero; arguments as in `check`."""
    _check_bounds(owner, name, 0.0, np.inf, False, given)


def non_negative(owner: Any, name: str, *given: Any) -> None:
    """A finite number of at least zero; arguments as in `check`."""
    _check_bounds(owner, name, 0.0, np.inf, True, given)


def in_range(
    owner: Any, name: str, low: Any, high: Any, *given: Any, include_low: bool = False
) -> None:
    """A finite number between `low` and `high`.

    Args:
        owner, name, given: As in `check`.
        low, high: Bounds; `high` is excluded, `low` unless `include_low`.
        include_low: Whether `low` itself is allowed.
    """
    _check_bounds(owner, name, low, high, include_low, given)


def _check_bounds(owner, name, low, high, include_low, given):
    value, unit = given or _field(owner, name)
    number(owner, name, value, unit)
    numbers = floats(value, low, high)
    if numbers is None:
        return
    v, least, most = numbers
    inside = (v >= least if include_low else v > least) and v < most
    least = f"{'at least' if include_low else 'above'} {least:.6g}"
    words = least if most == np.inf else f"{least} and below {most:.6g}"
    check(owner, name, inside, _with_unit(words, unit), value, unit)


def check_fields(owner: Any) -> None:
    """Fields in the ranges, or among the words, that they state; `None` if by default.

    Args:
        owner: A module with fields such as `eqx.field(**real("m", "length", above=0))`.
    """
    for field in dataclasses.fields(owner):
        value, stated = getattr(owner, field.name), field.metadata
        ends = {name: stated[name] for name in _INSIDE if name in stated}
        if value is None and field.default is None:
            continue
        if "choices" in stated:
            one_of(owner, field.name, value, stated["choices"])
        if not ends:
            continue
        number(owner, field.name)
        known = floats(value)
        if known is not None:
            inside = all(_INSIDE[name](known[0], end) for name, end in ends.items())
            words = " and ".join(f"{_WORDS[k]} {end:.6g}" for k, end in ends.items())
            allowed = _with_unit(words, unit_of(owner, field.name))
            check(owner, field.name, inside, allowed)


_INSIDE = {"above": gt, "least": ge, "below": lt, "most": le}
_WORDS = {"above": "above", "least": "at least", "below": "below", "most": "at most"}


def count(owner: Any, name: str, value: Any, least: int = 1) -> None:
    """A whole number of at least `least`; bools do not pass.

    Raises:
        TypeError: If it is not an integer.
        ValueError: If it is below.
    """
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    allowed = f"a whole number of at least {least}"
    must_be(owner, name, value, whole, allowed, TypeError)
    check(owner, name, value >= least, allowed, value, "")


def flag(owner: Any, name: str, value: Any) -> None:
    """True or false; raises `TypeError` for anything else."""
    must_be(owner, name, value, isinstance(value, bool), "True or False", TypeError)


def instance(owner: Any, name: str, *kinds: type | None) -> None:
    """A field that holds an object of one of several classes, or `None`.

    Raises:
        TypeError: If it holds something else.
    """
    names = ["None" if k is None else k.__name__ for k in kinds]
    allowed = " or ".join(n.removeprefix("Abstract") for n in names)
    known = tuple(type(None) if k is None else k for k in kinds)
    of_class(owner, name, getattr(owner, name), known, f"a {allowed}")


def all_of_class(owner: Any, name: str, values: Any, kinds: Any, allowed: str) -> None:
    """A list or tuple of objects of one of several classes.

    Args:
        owner, name, kinds, allowed: As in `of_class`.
        values: The objects.

    Raises:
        TypeError: If one is something else.
    """
    for value in values:
        if not isinstance(value, kinds):
            held = f"{_title(owner)}: `{name}` holds a {type(value).__name__}"
            raise TypeError(f"{held}; it must hold {allowed}.")


def of_class(owner: Any, name: str, value: Any, kinds: Any, allowed: str) -> None:
    """An object of a class, or of one of several.

    Args:
        owner, name: Class or function, and the field or argument checked.
        allowed: What is allowed, in words.
        value: The object.
        kinds: Classes that are allowed.

    Raises:
        TypeError: If it is something else.
    """
    if not isinstance(value, kinds):
        kind = type(value).__name__
        raise TypeError(f"{_title(owner)}: `{name}` is a {kind}; it must be {allowed}.")


def integration(owner: Any, options: Any) -> None:
    """Numerics of an integration in time, with its limits.

    Args:
        owner: As in `check`.
        options: With `tolerance`, `max_steps` and `derivatives`.

    Raises:
        TypeError, ValueError: For a tolerance or a limit that is not above zero, or an
            unknown mode of derivatives.
    """
    positive(owner, "tolerance", options.tolerance, "")
    count(owner, "max_steps", options.max_steps)
    modes = "reverse", "forward"
    one_of(owner, "derivatives", options.derivatives, modes, " or ".join(modes))


def of_shape(owner: Any, name: str, fits: bool, allowed: str, *given: Any) -> None:
    """An array of an allowed shape.

    Args:
        owner, name: Class or function, and the field or argument checked.
        allowed: What is allowed, in words.
        fits: Whether its shape is allowed.
        given: The array, if not a field of `owner`.

    Raises:
        ValueError: If it is not.
    """
    if not fits:
        value = given[0] if given else getattr(owner, name)
        shape = np.shape(value) if is_real(value) else type(value).__name__
        raise ValueError(
            f"{_title(owner)}: `{name}` has shape {shape}; it must be {allowed}."
        )


def one_of(
    owner: Any, name: str, value: Any, names: Collection[str], allowed: str = ""
) -> None:
    """One of several names.

    Args:
        owner, name: Class or function, and the field or argument checked.
        value: Name that was given.
        names: Allowed names.
        allowed: What is allowed, in words; by default the choices are listed.

    Raises:
        ValueError: If it is none of them.
    """
    words = allowed or f"one of {', '.join(names)}"
    must_be(owner, name, value, value in names, words)


def must_be(
    owner: Any,
    name: str,
    value: Any,
    ok: bool,
    allowed: str,
    error: type[Exception] = ValueError,
) -> None:
    """Raise `error` unless `ok`, with the value as Python writes it.

    Args:
        owner, name: Class or function, and the field or argument checked.
        value: The value.
        ok: Whether it is allowed.
        allowed: Allowed values, ending the sentence "it must be ...".
        error: Class of the exception.
    """
    if not ok:
        raise error(f"{_title(owner)}: `{name}` is {value!r}; it must be {allowed}.")


def _field(owner, name):
    """Value and unit of a field."""
    return getattr(owner, name), unit_of(owner, name)


def _title(owner) -> str:
    """Name of the owner in messages, from a name, a class or an instance of it."""
    if isinstance(owner, str):
        return owner
    return (owner if isinstance(owner, type) else type(owner)).__name__


def _with_unit(words: str, unit: str) -> str:
    return f"{words} {unit}".strip()


def _format_value(value) -> str:
    if is_traced(value):
        return "a traced value"
    array = np.asarray(value)
    if array.shape == ():
        return f"{float(array):.6g}"
    if array.ndim > 1 and array.size > 12:
        return f"an array of shape {array.shape}"
    return np.array2string(array, precision=6, threshold=6)

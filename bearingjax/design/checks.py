"""Validation of design data: every message names parameter, value, unit and range.

Checks act on concrete numbers and let traced ones through: under `jit` or `grad` a
design was checked when it was made, and a bad traced number ends in a result code.
"""

import jax
import jax.numpy as jnp
import numpy as np


def is_traced(value) -> bool:
    """Whether a value is being traced, and has no number to look at."""
    return isinstance(value, jax.core.Tracer)


def check(owner, name: str, value, unit: str, ok, allowed: str) -> None:
    """Raise unless `ok`.

    Args:
        owner: Instance (or name) of what is being checked.
        name: Parameter.
        value: Its value, as shown in the message [`unit`].
        unit: Unit; empty for a pure number.
        ok: Whether the value is allowed; skipped if traced.
        allowed: What is allowed, ending the sentence "it must be ...".

    Raises:
        ValueError: If `ok` is false.
    """
    if is_traced(ok) or is_traced(value) or bool(np.all(ok)):
        return
    shown = f"{_show(value)} {unit}".strip()
    title = owner if isinstance(owner, str) else type(owner).__name__
    raise ValueError(f"{title}: `{name}` is {shown}; it must be {allowed}.")


def number(owner, name: str, value, unit: str) -> None:
    """A single finite number [`unit`].

    Raises:
        ValueError: If it is an array, NaN or infinite.
    """
    if jnp.shape(value) != ():
        title = type(owner).__name__
        raise ValueError(
            f"{title}: `{name}` has shape {jnp.shape(value)}; it must be one number"
            f"{f' in {unit}' if unit else ''}."
        )
    check(owner, name, value, unit, jnp.isfinite(value), "a finite number")


def positive(owner, name: str, value, unit: str) -> None:
    """A finite number above zero [`unit`]."""
    number(owner, name, value, unit)
    check(owner, name, value, unit, value > 0, _with_unit("above 0", unit))


def non_negative(owner, name: str, value, unit: str) -> None:
    """A finite number of at least zero [`unit`]."""
    number(owner, name, value, unit)
    check(owner, name, value, unit, value >= 0, _with_unit("at least 0", unit))


def in_range(
    owner, name: str, value, unit: str, low, high, include_low: bool = False
) -> None:
    """A finite number between `low` and `high` [`unit`].

    Args:
        owner, name, value, unit: As in `check`.
        low, high: Bounds; `high` is excluded, `low` unless `include_low`.
        include_low: Whether `low` itself is allowed.
    """
    number(owner, name, value, unit)
    above = (value >= low) if include_low else (value > low)
    words = f"{'at least' if include_low else 'above'} {_show(low)} and below"
    check(
        owner,
        name,
        value,
        unit,
        above & (value < high),
        _with_unit(f"{words} {_show(high)}", unit),
    )


def count(owner, name: str, value) -> None:
    """A whole number of at least one; bools do not pass.

    Raises:
        TypeError: If it is not an integer.
        ValueError: If it is below one.
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(
            f"{type(owner).__name__}: `{name}` is {value!r}; it must be a whole number"
            " of at least 1."
        )
    check(owner, name, value, "", value >= 1, "a whole number of at least 1")


def _with_unit(words: str, unit: str) -> str:
    return f"{words} {unit}".strip()


def _show(value) -> str:
    if is_traced(value):
        return "a traced value"
    array = np.asarray(value)
    if array.shape == ():
        return f"{float(array):.6g}"
    return np.array2string(array, precision=6, threshold=6)

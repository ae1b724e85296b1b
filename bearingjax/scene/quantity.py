"""Quantities as scene files write them: a number and a unit, read by pint."""

import functools
import math
import re

_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")

KINDS = {
    "length": ("m", "mm"),
    "angle": ("rad", "deg"),
    "force": ("N", "kN"),
    "moment": ("N m", "N m"),
    "speed": ("rad/s", "rpm"),
    "pressure": ("Pa", "GPa"),
    "density": ("kg/m^3", "kg/m^3"),
    "line constant": ("N/m^(19/9)", "N/m^(19/9)"),
}
"""Kind of quantity to its SI unit and a unit that a message may suggest."""


class SceneError(ValueError):
    """A scene that cannot be read; the message names file, key, fault and remedy."""


@functools.cache
def _units():
    import pint

    return pint.UnitRegistry()


def to_si(text: object, kind: str) -> float:
    """Number in SI of a quantity such as "65 mm".

    Args:
        text: What stands in the file.
        kind: Key of `KINDS`.

    Returns:
        Finite number in the SI unit of the kind.

    Raises:
        SceneError: If it is not a number with a unit of this kind; the message does
            not name the key, which the caller knows.
    """
    unit, example = KINDS[kind]
    wanted = f'a {kind} with its unit is wanted, such as "5 {example}"'
    if isinstance(text, bool) or not isinstance(text, str | int | float):
        raise SceneError(f"{text!r} is not a quantity; {wanted}")
    if not isinstance(text, str):
        raise SceneError(f"{text!r} has no unit; {wanted}")
    match = _NUMBER.fullmatch(text)
    if match is None:
        raise SceneError(f"{text!r} does not begin with a finite number; {wanted}")
    number, name = match.groups()
    if not name:
        raise SceneError(f"{text!r} has no unit; {wanted}")
    value = float(number) * _factor(text, name, unit, kind, wanted)
    if not math.isfinite(value):
        raise SceneError(f"{text!r} is out of range; {wanted}")
    return value


def _factor(text, name, unit, kind, wanted):
    import pint

    registry = _units()
    try:
        given = registry.parse_units(name)
    except (pint.errors.PintError, ValueError, TypeError, AttributeError) as error:
        unknown = f"{text!r} has the unknown unit {name!r}; {wanted}"
        raise SceneError(unknown) from error
    if kind == "speed" and "hertz" in str(given):
        # pint counts 1 Hz as 1 rad/s, which nobody means.
        raise SceneError(f"{text!r} is a frequency; give rpm, deg/s or rad/s")
    target = registry.parse_units(unit)
    one = registry.Quantity(1.0, given)
    if not one.check(target.dimensionality):
        raise SceneError(f"{text!r} is not a {kind}; {wanted}")
    return float(one.to(target).magnitude)

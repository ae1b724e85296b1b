"""Quantities as written in scene files: a number and a unit, read by pint."""

import decimal
import functools
import math
import re

# Characters allowed in a unit; it may not begin with another number, except 1/s.
_UNIT = re.compile(r"(?:1\s*/|[A-Za-zµμ°])[A-Za-zµμ°·²³\d\s*/^().+-]*")
_TURNS = ("radian", "degree", "turn", "revolution", "arcminute", "arcsecond", "grade")
_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")

_REVOLUTIONS = dict.fromkeys(
    "1/min min^-1 min^(-1) min**-1 min⁻¹ r/min rev/min U/min RPM".split(), "rpm"
)
_WRITTEN = {
    "speed": _REVOLUTIONS,
    "frequency": _REVOLUTIONS,
    "moment": {
        "Nm": "N m",
        "Nmm": "N mm",
        "mNm": "mN m",
        "kNm": "kN m",
        "kNmm": "kN mm",
        "MNm": "MN m",
    },
    "viscosity": {"Pas": "Pa s", "mPas": "mPa s"},
}
"""Alternative spellings of units, by kind. As a speed 1/min counts revolutions, as in
machine standards; pint would take radians, a factor of 2 pi less."""

KINDS = {
    "length": ("m", "mm"),
    "angle": ("rad", "deg"),
    "force": ("N", "kN"),
    "moment": ("N m", "N m"),
    "speed": ("rad/s", "rpm"),
    "duration": ("h", "h"),
    "pressure": ("Pa", "GPa"),
    "density": ("kg/m³", "kg/m^3"),
    "stiffness": ("N/m", "N/mm"),
    "tilting stiffness": ("N m/rad", "kN m/rad"),
    "line load": ("N/m", "N/mm"),
    "line constant": ("N/m^(19/9)", "N/m^(19/9)"),
    "point constant": ("N/m^(3/2)", "N/m^(3/2)"),
    "time": ("s", "s"),
    "temperature": ("K", "°C"),
    "square of a temperature": ("K²", "K^2"),
    "temperature coefficient": ("1/K", "1/K"),
    "pressure coefficient": ("1/Pa", "1/GPa"),
    "viscosity": ("Pa s", "mPa s"),
    "kinematic viscosity": ("m²/s", "mm^2/s"),
    "density slope": ("kg/(m³ K)", "kg/(m^3 K)"),
    "thermal conductivity": ("W/(m K)", "W/(m K)"),
    "moment of inertia": ("kg m²", "kg mm^2"),
    "sliding speed": ("m/s", "mm/s"),
    "reciprocal speed": ("s/m", "s/m"),
    "mass": ("kg", "kg"),
    "unbalance": ("kg m", "g mm"),
    "acceleration": ("m/s²", "m/s^2"),
    "frequency": ("rad/s", "Hz"),
    "damping": ("N s/m", "N s/mm"),
    "tilting damping": ("N m s/rad", "N m s/rad"),
    "rate": ("1/s", "1/s"),
    "power": ("W", "kW"),
    "thermal conductance": ("W/K", "W/K"),
    "heat capacity": ("J/K", "kJ/K"),
}
"""Kind of quantity to its SI unit and a unit suggested in messages. Of several kinds
with the same unit, the first is taken where only the unit is known."""


def kind_of(unit: str) -> str:
    """Return the kind of quantity of a unit.

    Args:
        unit: Unit of a field, from `unit_of`.

    Raises:
        KeyError: If there is no such kind.
    """
    kinds = {known: kind for kind, (known, _) in reversed(KINDS.items())}
    return kinds[unit]


class SceneError(ValueError):
    """A scene that cannot be read; the message names file, key, fault and remedy."""


@functools.cache
def _units():
    import pint

    try:
        # pint caches its parsed definitions: this saves 0.15 s per start.
        return pint.UnitRegistry(cache_folder=":auto:")
    except OSError:
        return pint.UnitRegistry()


def to_si(text: object, kind: str) -> float:
    """Convert a quantity such as "65 mm" to a number in SI.

    Args:
        text: Value in the file.
        kind: Key of `KINDS`.

    Returns:
        Finite number in the SI unit of the kind.

    Raises:
        SceneError: If it is not a number with a unit of this kind; the message does
            not name the key, which the caller adds.
    """
    unit, example = KINDS[kind]
    article = _article(kind)
    wanted = f'{article} {kind} with its unit is wanted, such as "5 {example}"'
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
    if re.match(r",\d", name):
        raise SceneError(f"{text!r} has a comma; write a decimal point, 5.2, no comma")
    name = _WRITTEN.get(kind, {}).get(name.replace(" ", ""), name)
    if not _UNIT.fullmatch(name):
        raise SceneError(f"{text!r} has the unknown unit {name!r}; {wanted}")
    value = _converted(number, text, name, unit, kind, wanted)
    if not math.isfinite(value):
        raise SceneError(f"{text!r} is out of range; {wanted}")
    return value


def _converted(number, text, name, unit, kind, wanted):
    """Convert the number to another unit, if the unit is of this kind."""
    article = _article(kind)
    registry = _units()
    try:
        given = registry.parse_units(name)
    except Exception as error:
        # pint's parser also raises tokenizer errors for arbitrary text.
        unknown = f"{text!r} has the unknown unit {name!r}; {wanted}"
        raise SceneError(unknown) from error
    target = registry.parse_units(unit)
    one = registry.Quantity(1.0, given)
    if not one.check(target.dimensionality):
        raise SceneError(f"{text!r} is not {article} {kind}; {wanted}")
    # pint converts 1 Hz to 1 rad/s and 5 percent to 0.05 rad; neither is intended.
    if kind == "speed" and not _turns(str(given)):
        raise SceneError(f"{text!r} is a frequency; give rpm, deg/s or rad/s")
    if kind == "angle" and not _turns(str(given)):
        raise SceneError(f"{text!r} is not an angle; {wanted}")
    if kind == "temperature":
        return float(registry.Quantity(float(number), given).to(target).magnitude)
    # A frequency in Hz counts vibrations, one in rpm or rad/s is a shaft speed.
    per_turn = 2.0 * math.pi if kind == "frequency" and not _turns(str(given)) else 1.0
    return _scaled(number, per_turn * float(one.to(target).magnitude))


def _scaled(number: str, factor: float) -> float:
    """Multiply a number by the factor of its unit; a power of ten shifts the decimal
    exponent, so that 10 µm are exactly 1e-05 m."""
    tens = round(math.log10(factor))
    if math.isclose(factor, 10.0**tens, rel_tol=1e-14):
        return float(decimal.Decimal(number).scaleb(tens))
    return float(number) * factor


def _article(kind: str) -> str:
    return "an" if kind[0] in "aeiou" else "a"


def _turns(unit: str) -> bool:
    return "steradian" not in unit and any(name in unit for name in _TURNS)

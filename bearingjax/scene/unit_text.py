"""Units as engineers write them: listed names, their products, quotients and powers."""

import functools
import math
import re
import unicodedata
from typing import NamedTuple

_NAMES = {
    "m": ("nµumcdk", 1.0, ""),
    "in inch inches": ("", 0.0254, "m"),
    "ft": ("", 0.3048, "m"),
    "mil thou": ("", 2.54e-5, "m"),
    "g": ("µumk", 1e-3, ""),
    "t": ("", 1e3, "kg"),
    "lb lbs": ("", 0.45359237, "kg"),
    "oz": ("", 0.028349523125, "kg"),
    "s second seconds": ("nµum", 1.0, ""),
    "min minute minutes": ("", 60.0, "s"),
    "h hour hours": ("", 3600.0, "s"),
    "d day days": ("", 86400.0, "s"),
    "a year years": ("", 365.25 * 86400.0, "s"),
    "K °C degC": ("", 1.0, ""),
    "°F degF": ("", 5.0 / 9.0, "K"),
    "rad radian radians": ("µum", 1.0, ""),
    "deg ° degree degrees": ("", math.pi / 180.0, "rad"),
    "arcmin ′ '": ("", math.pi / 10800.0, "rad"),
    'arcsec "': ("", math.pi / 648000.0, "rad"),
    "gon": ("", math.pi / 200.0, "rad"),
    "turn turns rev r U tr": ("", 2.0 * math.pi, "rad"),
    "rpm RPM": ("", math.pi / 30.0, "rad/s"),
    "Hz": ("k", 1.0, "1/s"),
    "N": ("µumkM", 1.0, "kg m/s^2"),
    "kgf kp": ("", 9.80665, "N"),
    "lbf": ("", 4.4482216152605, "N"),
    "Nm": ("µumkM", 1.0, "N m"),
    "Nmm": ("k", 1e-3, "N m"),
    "Ncm": ("", 1e-2, "N m"),
    "Ns": ("", 1.0, "N s"),
    "Pa": ("mhkMG", 1.0, "N/m^2"),
    "bar": ("m", 1e5, "Pa"),
    "psi": ("kM", 6894.757293168361, "Pa"),
    "Pas": ("m", 1.0, "Pa s"),
    "P": ("c", 0.1, "Pa s"),
    "St": ("c", 1e-4, "m^2/s"),
    "J": ("µumkM", 1.0, "N m"),
    "W": ("µumkM", 1.0, "N m/s"),
    "PS": ("", 735.49875, "W"),
    "hp": ("", 745.6998715822702, "W"),
    "gmm": ("", 1e-6, "kg m"),
    "kgmm": ("", 1e-3, "kg m"),
}
"""Names of a unit to its prefixes, which go with the first name, its size, and the unit
in which that is counted; empty for base units, which are counted in SI."""

_PREFIXES = {"n": 1e-9, "µ": 1e-6, "u": 1e-6, "m": 1e-3, "c": 1e-2, "d": 1e-1}
_PREFIXES |= {"": 1.0, "h": 1e2, "k": 1e3, "M": 1e6, "G": 1e9}

_FACTOR = re.compile(
    r"(^|\s*[*/.-]\s*|\s+|(?=\())"  # how it is joined
    r"(?:\(([^()]*)\)|(1)(?=\s*/)|([A-Za-zµ°]+|[′'\"]))"  # group, 1 of 1/s, or name
    r"(?:\s*\^\s*(-?\d\d?(?:\.\d+)?)(?::([1-9]))?|(?<=[A-Za-z])(-?[1-9]))?"  # power
    r"(?![\d^])"
)
_ALIKE = str.maketrans("º˚″", '°°"')
_PLAIN = str.maketrans({"μ": "µ", "−": "-", "–": "-", **dict.fromkeys("·⋅∙•×", "*")})


class Unit(NamedTuple):
    """A unit.

    Attributes:
        size: In SI units; of temperatures, the size of one degree.
        dimension: Powers of metre, kilogram, second, kelvin and radian.
        name: The name, if it is a single one; empty for products and powers.
    """

    size: float
    dimension: tuple[float, ...]
    name: str = ""


def plain_unit(text: str) -> str:
    """Return a unit in the characters of the lists, with one for each of the signs that
    look alike: µ, blanks, dots, minus, raised digits.

    Args:
        text: Unit as written.
    """
    text = unicodedata.normalize("NFKC", text.translate(_ALIKE)).translate(_PLAIN)
    text = text.replace("**", "^").strip()
    return re.sub(r"\^\s*\(\s*(-?[\d.]+)\s*(/?)\s*(\d?)\s*\)", _power, text)


def _power(found: re.Match[str]) -> str:
    return f"^{found[1]}:{found[3]}" if found[2] else f"^{found[1]}{found[3]}"


def parse_unit(text: str) -> Unit | None:
    """Return a unit, or `None` if a part of it is not known.

    Args:
        text: From `plain_unit`, such as "kN/mm", "N m", "min^-1", "W/(m K)".
    """
    return _product(text, _units())


def spellings(name: str) -> list[str]:
    """Return the known names that differ from one in capital letters alone.

    Args:
        name: Any text.
    """
    return [known for known in _units() if known.lower() == name.lower()]


@functools.cache
def _units() -> dict[str, Unit]:
    """Return the units of all names with their prefixes."""
    found: dict[str, Unit] = {}
    base = iter(range(5))
    for names, (prefixes, size, counted) in _NAMES.items():
        first, *others = names.split()
        of = _product(counted, found) if counted else None
        if of is None:
            place = next(base)
            of = Unit(1.0, tuple(float(k == place) for k in range(5)))
        for prefix in ("", *prefixes):
            whole = _PREFIXES[prefix] * size * of.size
            found[prefix + first] = Unit(whole, of.dimension, prefix + first)
        found |= {name: Unit(size * of.size, of.dimension, name) for name in others}
    return found


def _product(text: str, units: dict[str, Unit]) -> Unit | None:
    """Return a unit made of others."""
    size, dimension, at = 1.0, (0.0,) * 5, 0
    while at < len(text):
        found = _FACTOR.match(text, at)
        if found is None or (at == 0) == bool(found[1]):
            return None
        joined, group, one, name, power, over, short = found.groups()
        of = Unit(1.0, (0.0,) * 5) if one else units.get(name)
        if group is not None:
            of = _product(group, units)
        exponent = float(power or short or 1.0) / float(over or 1.0)
        if of is None or not 0.0 < abs(exponent) < 10.0:
            return None
        if (at, found.end(), exponent) == (0, len(text), 1.0):
            return of
        exponent = -exponent if "/" in joined else exponent
        size *= of.size**exponent
        pairs = zip(dimension, of.dimension, strict=True)
        dimension = tuple(a + exponent * b for a, b in pairs)
        at = found.end()
    return Unit(size, dimension) if text else None

"""Quantities as written in scene files: a number and a unit, read by pint."""

import decimal
import functools
import itertools
import math
import re
import unicodedata
from fractions import Fraction
from importlib.resources import files
from typing import Any

from ..numerics.constants import read_package_table

_NUMBER = re.compile(
    r"\s*([-+−]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+−]?[0-9]+)?)(.*)"
)
_LETTER = "[A-Za-zµ°]"
_POWER = r"-?(?=[\d.]*[1-9])1?\d(?:\.\d+)?(?!\d)"
# What pint may see: m^9^9 would take it for ever, and m//s is m/s to it.
_UNIT = re.compile(
    rf"(?:{_LETTER}|1(?= ?/)|[*() ]|/(?!/)"
    rf"|\^ ?(?:{_POWER}|\( ?{_POWER}(?: ?/ ?[1-9])? ?\))(?! ?\^|{_LETTER}))+",
    re.ASCII,
)
_ALIKE = str.maketrans("º˚″", '°°"')
_PLAIN = str.maketrans({"μ": "µ", "−": "-", "–": "-", **dict.fromkeys("·⋅∙•×", "*")})
_TICKS = str.maketrans({"'": "arcmin", "′": "arcmin", '"': "arcsec"})
_HIDDEN = dict.fromkeys(map(ord, "\u200b\u2060\ufeff"))
_ZEROS = {"°C": "273.15", "degC": "273.15", "°F": "459.67", "degF": "459.67"}
"""Zero of a temperature, above the absolute one and in its own degrees."""
_PER_MINUTE = "1/min", "min-1", "min^-1", "min^(-1)"
"""As a speed 1/min counts revolutions, as in machine standards."""
_ANGLE = {"frequency": "({}) turn"}
_ANGLE |= dict.fromkeys(("tilting stiffness", "tilting damping"), "({})/rad")
"""Units whose radians may be left out; as a frequency, cycles are counted then."""

_LISTED = read_package_table("bearingjax.files", "quantities.toml")
QUANTITIES: dict[str, tuple[str, str]] = {
    k: tuple(v) for k, v in _LISTED["kinds"].items()
}
"""Kind of quantity to its SI unit and a unit suggested in messages. Of several kinds
with the same unit, the first is taken where only the unit is known."""
_UNITS: dict[str, str] = _LISTED["units"]
"""Single names of units by kind; any product or quotient of the right dimension may be
written as well."""
_SLIPS: dict[str, dict[str, str]] = _LISTED["slips"]
"""What to write in place of names that mean another thing, or one of two, by kind."""


def scene_number(value: float, kind: str, largest: float | None = None) -> str:
    """Return a number with the unit that scenes usually have: "72.5 mm", "3000 rpm".

    Args:
        value: In SI.
        kind: Key of `QUANTITIES`; empty for a pure number.
        largest: Number whose unit it takes [SI]; by default its own.
    """
    size = abs(value if largest is None else largest)
    factor, unit = {
        "length": (1e3, "mm"),
        "angle": (180.0 / math.pi, "deg"),
        "speed": (30.0 / math.pi, "rpm"),
        "frequency": (0.5 / math.pi, "Hz"),
        "pressure": (1e-9, "GPa") if size >= 1e9 else (1e-6, "MPa"),
        "force": (1e-3, "kN") if size >= 1e3 else (1.0, "N"),
    }.get(kind, (1.0, QUANTITIES[kind][0] if kind else ""))
    return f"{factor * value:.6g} {unit}".rstrip()


def kind_of(unit: str) -> str:
    """Return the kind of quantity of a unit; empty if it is.

    Args:
        unit: Unit of a field, from `unit_of`.

    Raises:
        KeyError: If there is no such kind.
    """
    kinds = {known: kind for kind, (known, _) in reversed(QUANTITIES.items())}
    return kinds[unit] if unit else ""


class SceneError(ValueError):
    """A scene that cannot be read; the message names file, line, key, fault and
    remedy."""


_WEIGHTS = {"lb": "lbf", "lbs": "lbf", "kg": "kgf"}


def to_si(text: object, kind: str) -> float:
    """Convert a quantity such as "65 mm" to a number in SI.

    Args:
        text: Value in the file.
        kind: Key of `QUANTITIES`.

    Returns:
        Finite number in the SI unit of the kind.

    Raises:
        SceneError: If it is not a number with a unit of this kind; the message does
            not name the key, which the caller adds.
    """
    article = article_of(kind)
    wanted = (
        f'{article} {kind} with its unit is wanted, such as "5 {QUANTITIES[kind][1]}"'
    )
    if isinstance(text, bool) or not isinstance(text, str | int | float):
        raise SceneError(f"{text!r} is not a quantity; {wanted}")
    if not isinstance(text, str):
        raise SceneError(f"{text!r} has no unit; {wanted}")
    match = _NUMBER.fullmatch(text.translate(_HIDDEN))
    if match is None:
        raise SceneError(f"{text!r} does not begin with a finite number; {wanted}")
    number, written = match[1].replace("−", "-"), match[2].strip()
    name = _plain_unit(written)
    if not name:
        raise SceneError(f"{text!r} has no unit; {wanted}")
    if re.match(r",\d", name):
        raise SceneError(f"{text!r} has a comma; write a decimal point, 5.2, no comma")
    if re.match(r"['’_\d]\s*\d|\d(?!\s*/)", name):
        raise SceneError(f"{text!r} has parted digits; write them together, 1000.5")
    size = _size(name, kind)
    if size is None:
        known = _parse(name)
        if kind == "speed" and known and known[1] == {"[time]": -1}:
            raise SceneError(f"{text!r} is a frequency; give rpm, deg/s or rad/s")
        problem = f"is not {article} {kind}"
        if known is None or known[1] == _si_unit(kind)[1]:
            problem = f"has the unknown unit {written!r}"
            if kind in _UNITS:
                wanted += f"; its units: {', '.join(_UNITS[kind].split())}"
        raise SceneError(f"{text!r} {problem}{_cure(name, kind)}; {wanted}")
    value = float(number)
    if math.isfinite(value) and (value != 0.0 or kind == "temperature"):
        value = _scale(decimal.Decimal(number), size, name, kind)
    if not math.isfinite(value) or (value == 0.0 and re.match(r"[^eE]*[1-9]", number)):
        raise SceneError(f"{text!r} is out of range; {wanted}")
    return value


def _plain_unit(unit: str) -> str:
    """Return a unit with one character for each of those that look alike: µ, blanks,
    dots, minus, raised digits."""
    unit = unicodedata.normalize("NFKC", unit.translate(_ALIKE)).translate(_PLAIN)
    return " ".join(unit.replace("**", "^").split())


@functools.cache
def _registry() -> Any:
    """Return the units of `units.txt`, without the cache folder of pint, which programs
    share, and without prefixes, or 20 Grad would be a billion radians."""
    import pint

    listed = files("bearingjax.files") / "units.txt"
    return pint.UnitRegistry(str(listed), cache_folder=None, on_redefinition="raise")


@functools.lru_cache(1024)
def _parse(text: str) -> tuple[float, dict[str, float]] | None:
    """Return the size in SI and the dimension of a unit such as "kN/mm", "N-m", "min-1"
    or "W/(m K)", or `None` if a part of it is not known."""
    registry = _registry()
    unit = re.sub(rf"(?<={_LETTER})(-?[1-9])(?!\.?\d)", r"^\1", text.translate(_TICKS))
    unit = re.sub(rf" ?[.-] ?(?={_LETTER}|\()", "*", unit)
    names = re.findall(f"{_LETTER}+", unit)
    if not (_UNIT.fullmatch(unit) and names and {*registry}.issuperset(names)):
        return None
    try:
        parsed = registry.parse_units(unit)
        size = float(registry.get_root_units(parsed)[0])
        powers = {k: round(float(p), 9) for k, p in parsed.dimensionality.items()}
    except Exception:  # of any kind, also of the tokenizer of Python
        return None
    known = size, {k: p for k, p in powers.items() if p}
    return known if 0.0 < size < math.inf else None


def _size(name: str, kind: str) -> float | None:
    """Return the size of a unit in that in which the kind is counted, or `None` if it
    is unknown or not of this kind."""
    if name.startswith("/"):  # 5e-6/K
        name = f"1{name}"
    if kind in ("speed", "frequency") and name.replace(" ", "") in _PER_MINUTE:
        name = "rpm"
    if kind in ("moment", "tilting stiffness"):  # foot-pounds are those of force
        name = re.sub(r"\blbs?\b", "lbf", name)
    given = unit = _parse(name)
    if given and given[1] != _si_unit(kind)[1]:
        unit = _parse(_ANGLE.get(kind, "{}").format(name))
    is_name = re.fullmatch(f"{_LETTER}+", name)
    listed = [_parse(_plain_unit(known)) for known in _UNITS.get(kind, "").split()]
    if is_name and listed and given not in listed:
        return None
    if kind == "temperature" and not is_name:
        return None
    return (
        unit[0] / _si_unit(kind)[0] if unit and unit[1] == _si_unit(kind)[1] else None
    )


def _si_unit(kind: str) -> tuple[float, dict[str, float]]:
    """Return size and dimension of the unit in which a kind is counted."""
    unit = _parse(_plain_unit(QUANTITIES[kind][0]))
    assert unit is not None
    return unit


def _cure(name: str, kind: str) -> str:
    """Return what to write in place of a wrong unit, in brackets; empty if unknown."""
    slip = _SLIPS.get(kind, {}).get(name)
    if slip is None:
        words = re.split(f"({_LETTER}+)", name)
        known = sorted(_registry(), reverse=True)  # mN before MN
        spelt = [[k for k in known if k.lower() == w.lower()] for w in words]
        spelt = [[*k, _WEIGHTS.get(w, w)] for k, w in zip(spelt, words, strict=True)]
        tried = map("".join, itertools.islice(itertools.product(*spelt), 99))
        found = dict.fromkeys(one for one in tried if _size(one, kind))
        slip = " or ".join(found)
    return f" (write {slip})" if slip else ""


def _scale(number: decimal.Decimal, size: float, name: str, kind: str) -> float:
    """Convert a number to SI; a power of ten shifts its decimal exponent, so that 10 µm
    are exactly 1e-05 m."""
    tens = round(math.log10(size))
    if kind == "temperature":
        degree = Fraction(size).limit_denominator(9)
        return float((Fraction(number) + Fraction(_ZEROS.get(name, "0"))) * degree)
    if math.isclose(size, 10.0**tens, rel_tol=1e-14):
        return float(number.scaleb(tens))
    return float(number) * size


def size_of_unit(name: str) -> float:
    """Return how many SI units a unit is, of any kind; 1 for none.

    Raises:
        ValueError: If it is not known.
    """
    known = _parse(_plain_unit(name)) if name else (1.0, {})
    if known is None:
        raise ValueError(f"the unit {name!r} is not known")
    return known[0]


def read_quantity(text: str) -> float | None:
    """Return a text such as "12 kN" or "70 °C" in SI, whatever its kind; `None` if it
    is not a number with a unit."""
    match = _NUMBER.fullmatch(text)
    name = _plain_unit(match[2]) if match else ""
    if match is None or not name:
        return None
    if name in _ZEROS:
        return to_si(text, "temperature")
    known = _parse(name)
    return None if known is None else float(match[1].replace("−", "-")) * known[0]


def article_of(kind: str) -> str:
    """Return the article of a kind of quantity."""
    return "an" if kind[0] in "aeiou" else "a"

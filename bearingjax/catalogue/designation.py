"""Designations of bearings as printed in catalogues and on boxes: "6205-2RS1/C3".

The letters that makers add are data, in `suffixes.toml`.
"""

import functools
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from ..fits.fit_limits import CLEARANCE_CLASSES, MOTOR_CLASS
from ..numerics.constants import read_package_table

MAKERS = (
    *("SKF", "FAG", "INA", "NSK", "NTN", "SNR", "KOYO", "JTEKT", "TIMKEN", "NACHI"),
    *("URB", "THK", "IKO", "RHP", "NKE", "NMB", "EZO", "ZKL", "ZWZ", "FBJ", "EPK"),
    "ZEN",
)
"""Manufacturer names that may stand before or after a designation."""

_LONGEST = 60
"""Characters of the longest text that is taken for a designation."""

# Latin letters typed on a Cyrillic keyboard, wide ones, dashes.
_PLAIN = str.maketrans("АВСЕНКМОРТХУ‐‑–—−\xa0　", "ABCEHKMOPTXY-----  ")
_PLAIN |= {code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)}

# A class, and a part of its range unless the letter begins something else, "C3LHT23".
# The E of NSK after it tells the quality of motors.
_CLASSES = "|".join((*CLEARANCE_CLASSES, MOTOR_CLASS))
_CLEARANCE = re.compile(
    rf"({_CLASSES})(?![\dX])([HLMP](?=-|$|[VW]T|GJ))?(E(?=-|$|NS|A[SV]))?"
)


class Suffixes(NamedTuple):
    """Meaning of the letters around the number of a designation.

    Attributes:
        clearance: Class of internal clearance, with the part of its range, "C3H", or
            `None` if none is named.
        without_effect: Letters with their meaning, "2RS1 (seals or shields)".
        roles: Letters that change the bearing, by what they change: "taper",
            "sleeve", "ceramic", "stainless" (`suffixes.toml`).
    """

    clearance: str | None = None
    without_effect: tuple[str, ...] = ()
    roles: Mapping[str, str] = {}


class _Letters(NamedTuple):
    """Letters of one meaning, as `suffixes.toml` has them."""

    pattern: re.Pattern[str]
    meaning: str
    role: str
    types: tuple[str, ...]


@functools.cache
def _table(name: str) -> tuple[_Letters, ...]:
    """Read the `suffixes` or the `prefixes`."""
    return tuple(
        _Letters(
            re.compile("|".join(one["forms"])),
            one["meaning"],
            one.get("role", ""),
            tuple(one.get("types", ())),
        )
        for one in read_package_table("bearingjax.catalogue", "suffixes.toml")[name]
    )


_WITHIN = r"(?!(?<=\d)/(?=\d)|(?<=[A-Z])/(?=[A-Z]))"
"""Not before a slash between digits or letters, a part of the name: 320/28, 418/414."""


def compact(text: str) -> str:
    """Return a designation in capitals, without separators but in 320/28."""
    return re.sub(rf"{_WITHIN}[\s./_-]+", "", text.upper())


def split_designation(
    text: str, names: Mapping[str, tuple[Any, ...]]
) -> tuple[str, Suffixes]:
    """Split a designation into its listed name and the letters around it.

    Args:
        text: As written, such as "SKF 6205-2RS1/C3".
        names: By known names, compact, what they name: type, key, changes, remarks.

    Raises:
        ValueError: If it has no known name, two readings as 62202RS, or letters whose
            meaning is not known, or that contradict each other.
    """
    plain = text.translate(_PLAIN)
    # "ß" would become "SS", and other signs than these no separators.
    known = re.fullmatch(r"[\w\s.,;:/+()\[\]*'\"-]*", plain) and plain.isascii()
    plain = plain.upper() if known else ""
    words = re.sub(rf"{_WITHIN}[^A-Z0-9]+", "-", plain).strip("-")
    if len(text) > _LONGEST or known and not words:
        raise ValueError(f'{text!r} is not a designation, such as "6205-2RS1/C3"')
    makers = "|".join(MAKERS)
    words = re.sub(rf"^({makers})-?(?=[A-Z0-9])|-({makers})$", "", words)
    before: list[tuple[str, _Letters]] = []
    while not (found := _matching_names(words, names)):
        prefix = _prefix(words)
        if prefix is None or prefix in before:
            raise ValueError(_unknown_message(text, plain, names))
        before.append(prefix)
        words = words[len(prefix[0]) :].lstrip("-")
    name, rest = found[0]
    fewer = name[:-1], f"2{rest}"
    if fewer in found and re.match(r"R|NS|Z(?!Z)", rest):
        problem = f"may be {name} with {rest} or {fewer[0]} with {fewer[1]}; write"
        raise ValueError(f"{text!r} {problem} {name}-{rest} or {'-'.join(fewer)}")
    kind = names[name][0]
    if any(letters.types and kind not in letters.types for _, letters in before):
        raise ValueError(_unknown_message(text, plain, names))
    for name, rest in found:
        if names[name][:3] != names[found[0][0]][:3]:
            break  # letters of another bearing, such as an angle of A, AC
        after = _split_suffixes(rest, kind)
        if after is not None:
            return name, _meaning((*before, *after), text)
    name, rest = found[0]
    known = f"{_CLASSES.replace('|', ', ')}, seals, shields, cages, accuracy"
    problem = f"has letters after {name} that are not known: {_culprit(rest, kind)!r}"
    raise ValueError(f"{text!r} {problem} (known are {known})")


def _matching_names(words: str, names: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the names with which a text begins, the longest first, and the rests.

    Separators may stand between letters and digits: 62/22 is not 6222, nor 7205 A-C a
    7205 AC; 25580-25520 of inch bearings is 25580/25520.
    """
    found, name = [], ""
    for place, sign in enumerate(words):
        if sign == "-":
            if re.match(r"\d{3}-\d{3}", words[max(place - 3, 0) :]):
                name += "/"
            elif words[place - 1].isdigit() == words[place + 1].isdigit():
                break
            continue
        name += sign
        rest = words[place + 1 :].replace("/", "-")
        # Another digit would belong to the number, but for that of 62052RS.
        if name in names and not re.match(r"(?!2[A-Z])\d", rest):
            found.append((name, rest))
    return found[::-1]


def _prefix(words: str) -> tuple[str, _Letters] | None:
    """Return the longest prefix of a text, and what it means."""
    for length in (3, 2, 1):
        for letters in _table("prefixes"):
            if letters.pattern.fullmatch(words[:length]):
                return words[:length], letters
    return None


@functools.lru_cache(maxsize=1024)
def _split_suffixes(
    rest: str, kind: str
) -> tuple[tuple[str, _Letters | None], ...] | None:
    """Split what follows a name into known letters, the longest first.

    Returns:
        Letters and what they mean, `None` of a class of clearance; `None` if letters
        are left over.
    """
    if not rest:
        return ()
    if rest[0] == "-":
        return _split_suffixes(rest[1:], kind)
    found = _CLEARANCE.match(rest)
    if found and (tail := _split_suffixes(rest[found.end() :], kind)) is not None:
        return ((found[0], None), *tail)
    for length in range(min(len(rest), 10), 0, -1):
        for letters in _table("suffixes"):
            if letters.types and kind not in letters.types:
                continue
            match = letters.pattern.match(rest)
            if letters.pattern.fullmatch(rest, 0, length) or (
                match and match.end() == length
            ):
                tail = _split_suffixes(rest[length:], kind)
                if tail is not None:
                    return ((rest[:length], letters), *tail)
    return None


def _culprit(rest: str, kind: str) -> str:
    """Return the first word of a text that is not known."""
    words = rest.strip("-").split("-")
    for place, word in enumerate(words):
        pairs = words[max(place - 1, 0) : place + 1], words[place : place + 2]
        if all(_split_suffixes("-".join(w), kind) is None for w in ([word], *pairs)):
            return word
    return "-".join(words)


def _meaning(parts: tuple[tuple[str, _Letters | None], ...], text: str) -> Suffixes:
    clearance, idle, roles = None, {}, {}
    for word, letters in parts:
        word = word.replace("-", "")
        role = letters.role if letters else ""
        if letters is None or role == "accuracy and clearance":
            found = _CLEARANCE.match(f"C{word[2]}" if letters else word)
            assert found is not None
            named = found[1] + (found[2] or "")
            if clearance not in (None, named):
                problem = f"names two classes of clearance, {clearance} and {named}"
                raise ValueError(f"{text!r} {problem}")
            clearance = named
            if found[3]:
                idle["E (quality of motors)"] = None
        if role in ("", "accuracy and clearance") and letters:
            idle[f"{word} ({letters.meaning})"] = None
        elif role:
            if roles.get(role, word) != word:
                problem = f"names {roles[role]} and {word}, which exclude each other"
                raise ValueError(f"{text!r} {problem}")
            roles[role] = word
    return Suffixes(clearance, tuple(idle), roles)


def _unknown_message(text: str, plain: str, names: Mapping[str, Any]) -> str:
    squeezed = re.sub(r"[^A-Z0-9]+", "", plain)
    words = f"{text!r} is not a bearing of the catalogue"
    bore = re.search(r"(?<!\d)\d\d\d?/(\d\d)(?!\d)", plain)
    if bore:
        words += f" (/{bore[1]} is a bore of {bore[1]} mm, part of the number)"
        squeezed = ""
    begun = [name for name in names if squeezed and name.startswith(squeezed)]
    near = sorted(begun, key=len) or _similar_names(squeezed, names)
    hint = f"; near it: {', '.join(near[:6])}" if near else ""
    cure = "; of an unlisted one `bearingjax new --type …` estimates the inside"
    return f"{words}{hint}{cure}"


def _similar_names(squeezed: str, names: Mapping[str, Any]) -> list[str]:
    """Return names one mistake away: two signs swapped; one other, more or less."""
    cuts = [(squeezed[:k], squeezed[k:]) for k in range(len(squeezed) + 1)]
    swapped = {a + b[1] + b[0] + b[2:] for a, b in cuts if len(b) > 1}
    close = {a + b[1:] for a, b in cuts if b}
    for sign in "ABCEJKNPQRUX0123456789/":
        close |= {a + sign + b for a, b in cuts} | {a + sign + b[1:] for a, b in cuts}
    found = sorted((close - swapped) & set(names))
    digits = re.sub(r"\D", "", squeezed)
    # First those of as many signs or the same digits.
    length = len(squeezed)
    found.sort(key=lambda n: (re.sub(r"\D", "", n) != digits) + (len(n) != length))
    return [*sorted(swapped & set(names)), *found]

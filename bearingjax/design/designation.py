"""Designations of bearings as printed in catalogues and on boxes: "6205-2RS1/C3"."""

import difflib
import re
from collections.abc import Iterable
from typing import NamedTuple

from .fit_limits import CLEARANCE_CLASSES

MAKERS = (
    "SKF",
    "FAG",
    "INA",
    "NSK",
    "NTN",
    "SNR",
    "KOYO",
    "TIMKEN",
    "NACHI",
    "URB",
    "THK",
)
"""Manufacturer names that may precede a designation."""

# Suffixes of several makers that do not affect the calculation.
_WITHOUT_EFFECT = {
    "seals or shields": r"2?RS[RHL12]?\d?|2?RZ|2?ZZ?|LL[UBHX]|DDU?|VV|UU?",
    "cage": r"TN[9HG]?|TNP|TVP2?B?|TVPB|TVH|TV|TB|T2X?|J[12]?|M[ABLPT]?[12]?|PH[AS]*|P"
    r"|Y|L|W",
    "accuracy or steel": r"P[654]X?|P0|PN|QE[456]|VA\d+|Q|QCL7C|A|XL",
    "lubrication holes": r"W(?:20|26|33|64)|S",
    "grease": r"HT\d*|LT\d*|WT|[MV]T\d+|LHT\d+|GJN",
    "mounting": r"C[ABC]|G[ABC]?|U[ALO]|N[12]?|Z?NR",
    "tapered bore": r"K(?:30)?",
}
# A class, and a part of its range unless the letter begins a grease suffix or, before
# a digit, an accuracy suffix.
_PART = r"(?:(?!L?HT|[LMV]T)[HLMP](?!\d))?"
_CLEARANCE = rf"(?:{'|'.join(CLEARANCE_CLASSES)})(?!\d|X){_PART}"


class Suffixes(NamedTuple):
    """Meaning of the suffixes of a designation.

    Attributes:
        clearance: Class of internal clearance, with the part of its range, "C3H", or
            `None` if none is named.
        without_effect: Suffixes with their meaning, "2RS1 (seals or shields)".
        taper: "K" or "K30" for a tapered bore, else "".
    """

    clearance: str | None
    without_effect: tuple[str, ...]
    taper: str = ""


def compact(text: str) -> str:
    """Return a designation in capitals, without separators."""
    return re.sub(r"[\s./_-]+", "", text.upper())


def split_designation(text: str, names: Iterable[str]) -> tuple[str, Suffixes]:
    """Split a designation into its listed name and suffixes.

    Args:
        text: As written, such as "SKF 6205-2RS1/C3".
        names: Known names, compact.

    Raises:
        ValueError: If it does not begin with a known name, or has suffixes whose
            meaning is not known.
    """
    if not compact(text):
        raise ValueError(f'{text!r} is not a designation, such as "6205-2RS1/C3"')
    names = tuple(names)
    words = text.upper().split()
    if len(words) > 1 and words[0] in MAKERS:
        words = words[1:]
    whole = " ".join(words)
    squeezed = compact(whole)
    # The longest first, "7205B" before "7205".
    for name in sorted(names, key=len, reverse=True):
        if squeezed.startswith(name) and not _goes_on(squeezed[len(name) :]):
            return name, _suffixes(_after(whole, name), name, text)
    raise ValueError(_unknown(text, squeezed, names))


def _goes_on(rest: str) -> bool:
    """Whether the rest continues the number of a name: 62055 is not 6205."""
    return bool(re.match(r"\d(?!RS|RZ|Z)", rest))


def _after(whole: str, name: str) -> str:
    """Return the text that follows a compact name in a non-compact designation."""
    kept = iter(name)
    wanted = next(kept)
    for place, letter in enumerate(whole):
        if letter == wanted:
            wanted = next(kept, "")
            if not wanted:
                return whole[place + 1 :]
    return ""


def _suffixes(rest: str, name: str, text: str) -> Suffixes:
    clearance, idle, taper = None, [], ""
    for word in re.split(r"[\s./_-]+", rest):
        while word:
            found = re.match(_CLEARANCE, word)
            if found:
                if clearance not in (None, found[0]):
                    problem = f"names two classes of clearance, {clearance} and"
                    raise ValueError(f"{text!r} {problem} {found[0]}")
                clearance = found[0]
                word = word[found.end() :]
                continue
            taken, meaning = _idle(word)
            if not taken:
                known = (
                    f"{', '.join(CLEARANCE_CLASSES)}, seals, shields, cages, accuracy"
                )
                problem = f"has letters after {name} that are not known: {word!r}"
                raise ValueError(f"{text!r} {problem} (known are {known})")
            if meaning == "tapered bore":
                taper = taken
            else:
                idle.append(f"{taken} ({meaning})")
            word = word[len(taken) :]
    return Suffixes(clearance, tuple(idle), taper)


def _idle(word: str) -> tuple[str, str]:
    """Return the longest suffix without effect with which a word begins."""
    best, meaning = "", ""
    for kind, pattern in _WITHOUT_EFFECT.items():
        found = re.match(pattern, word)
        # A regular expression takes the first alternative, not the longest.
        for length in range(len(word), len(best), -1):
            if found and re.fullmatch(pattern, word[:length]):
                best, meaning = word[:length], kind
                break
    return best, meaning


def _unknown(text: str, squeezed: str, names: tuple[str, ...]) -> str:
    begun = [name for name in names if name.startswith(squeezed)]
    near = begun or difflib.get_close_matches(squeezed, names, 4, 0.7)
    hint = f"; near it: {', '.join(sorted(near)[:6])}" if near else ""
    cure = "; of an unlisted one `bearingjax new --type …` estimates the inside"
    return f"{text!r} is not a bearing of the catalogue{hint}{cure}"

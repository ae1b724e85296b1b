"""Warnings of all layers: one class, tables of their kinds, and those of many cases."""

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

Own = TypeVar("Own")
"""The class that a method belongs to: its name in quotes is Python's own `Warning`."""


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Warning(str):
    """A warning: its sentence, which knows what it is about.

    It is a string, equal to its `words`: it prints, joins and goes to files as one.

    Attributes:
        kind: Stable name of the kind of warning, as of `Sweep.warning_sizes`.
        words: The sentence.
        size: The number that is doubtful, in SI; NaN if there is none.
        limit: Its last value without a warning, NaN if there is none.
        where: Part, rolling elements or raceways concerned, in words; may be empty.
    """

    kind: str
    words: str
    size: float = math.nan
    limit: float = math.nan
    where: str = ""

    def __new__(cls, kind: str, words: str, *about: Any, **numbers: Any) -> Any:
        """Make the text of it."""
        return super().__new__(cls, words)

    def __getnewargs__(self) -> Any:
        """Arguments from which copies and unpickled warnings are made."""
        return self.kind, self.words

    def about(self: Own, name: str) -> Own:
        """Return the warning as one about a named part, which begins its sentence.

        Args:
            name: Name of the part, such as a bearing of a machine.
        """
        own: Any = self
        where = f"{name}: {own.where}" if own.where else name
        return dataclasses.replace(own, words=f"{name}: {own}", where=where)

    def followed_by(self: Own, words: str) -> Own:
        """Return the warning with more words at the end of its sentence.

        Args:
            words: These words, with the comma or space before them.
        """
        own: Any = self
        return dataclasses.replace(own, words=f"{own}{words}")


def warnings_of(name: str, warnings: Iterable[Warning]) -> list[Warning]:
    """Return warnings as those of a named part.

    Args:
        name: Name of the part, such as a bearing of a machine.
        warnings: Its warnings.
    """
    return [one.about(name) for one in warnings]


@dataclasses.dataclass(frozen=True)
class Kind:
    """A kind of warning.

    Attributes:
        limit: Largest size that gives no warning, in the unit of the size.
        text: The sentence with `{size}`, `{limit}` and `{where}`.
        where: Concrete results -> the rows, elements or numbers concerned, in words.
        many: Size -> the words in place of those of `where` for many cases.
        shown: Size -> the number in the sentence; of the limit, too.
        of_all: Whether it is reported only if it applies to all cases.
    """

    limit: float
    text: str
    where: Callable[..., str] = lambda *results: ""
    many: Callable[[float], str] = lambda size: ""
    shown: Callable[[float], float] = lambda size: size
    of_all: bool = False

    def warning(self, name: str, size: float, where: str = "") -> Warning:
        """Return the warning about a size.

        Args:
            name: Name of the kind.
            size: Size of the warning.
            where: From `where`; empty for many cases.
        """
        where = where or self.many(size)
        shown, limit = self.shown(size), self.shown(self.limit)
        words = self.text.format(size=shown, limit=limit, where=where)
        return Warning(name, words, size, self.limit, where.strip(" (,)"))


def exceeded_kinds(
    warned: Mapping[str, np.ndarray], kinds: Mapping[str, Kind]
) -> dict[str, np.ndarray]:
    """Whether each case has each kind, by name (case,); kinds without cases left out.

    Args:
        warned: Name -> size of the warning (case,), NaN where it does not apply.
        kinds: Kinds of warnings by name, in the order in which they are reported.

    Raises:
        KeyError: For a name that is not among the kinds: lives have kinds of their own
            (`life.life_warning.ALL`), and a warning must not be lost.
    """
    if unknown := sorted(set(warned) - set(kinds)):
        raise KeyError(f"no kind of warning is called {', '.join(unknown)}")
    over = {
        name: warned[name] > kind.limit
        for name, kind in kinds.items()
        if name in warned
    }
    for name in [name for name in over if kinds[name].of_all]:
        if (~over[name] & np.isfinite(warned[name])).any():
            del over[name]
    return {name: cases for name, cases in over.items() if cases.any()}


def warnings_of_cases(
    warned: Mapping[str, np.ndarray], kinds: Mapping[str, Kind]
) -> list[Warning]:
    """Return the warnings of many cases: each kind once, with its worst case.

    Args:
        warned: Size of each kind of warning by name (case,), NaN where it does not
            apply.
        kinds: Kinds of warnings by name, in the order in which they are reported.

    Raises:
        KeyError: For a name that is not among the kinds.
    """
    out = []
    for name, cases in exceeded_kinds(warned, kinds).items():
        worst = int(np.nanargmax(warned[name]))
        one = kinds[name].warning(name, float(warned[name][worst]))
        out.append(in_cases(one, int(cases.sum()), len(cases), worst))
    return out


def in_cases(worst: Warning, count: int, of: int, case: int) -> Warning:
    """Return the warning of the worst of several cases, with the number that have it.

    Args:
        worst: The warning of that case.
        count: Number of cases with such a warning.
        of: Number of all cases.
        case: Number of the worst one.
    """
    where = f", in {count} of {of} cases, worst case {case}"
    return worst if of == 1 else worst.followed_by(where)

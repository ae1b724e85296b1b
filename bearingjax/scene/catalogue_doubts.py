"""Lines of a [bearing] that look left over from another designation than it has."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..design.fit_limits import CLEARANCE_CLASSES
from .catalogue_entry import (
    CLEARANCE,
    CLEARANCES,
    CatalogueEntry,
    FromCatalogue,
    catalogue,
    same_key,
)
from .quantity import SceneError, to_si

_FAR = 0.05
"""Change of the pitch circle beyond that of one bearing of another make, whose inside
was measured; neighbours of a series are further apart [1]."""


def catalogue_doubts(
    keys: Mapping[str, Any], taken: FromCatalogue, varied: Iterable[str] = ()
) -> tuple[str, ...]:
    """Warnings of lines that are of another designation, a sentence each.

    A scene of `new` has every line. Whoever then changes the designation alone keeps
    the old bearing below it, which is solved. One dimension or two that are changed on
    purpose are no reason to warn.

    Args:
        keys: Keys of [bearing] with those of the catalogue.
        taken: What was taken from there.
        varied: Keys that the cases of a scene vary ("bearing.n_balls"); with keys of
            the bearing among them its lines are meant, as written they are checked
            without.
    """
    meant = [k for k in varied if k.startswith("bearing.") and "designation" not in k]
    if meant or not taken.overridden:
        return ()
    return _of_another(keys, taken) or _other_class(keys, taken)


def _of_another(keys, taken) -> tuple[str, ...]:
    """That the inside is that of another bearing."""
    entry, changed = taken.entry, set(taken.overridden) - {CLEARANCE}
    others = [e for e in catalogue() if e.type == entry.type]
    cure = "leave out the lines that are not meant"
    whole = [e for e in others if changed & set(e.table) and _agrees(keys, e, e.table)]
    if whole:
        words = f"the lines beside `designation` are those of {_names(whole)}"
        return (f"bearing: {words}, not of {entry.designation}; {cure}",)
    main = [k for k in taken.overridden if k in _MAIN]
    if len(main) < 2:
        return ()
    alike = [e for e in others if _agrees(keys, e, main)]
    pitch, own = (_length(table, "pitch_diameter") for table in (keys, entry.table))
    if not alike and (pitch is None or own is None or abs(pitch / own - 1.0) < _FAR):
        return ()
    shown = " and ".join(f"`{key}`" for key in main)
    words = f"{shown} are {'far from those' if not alike else 'not those'} of"
    whose = f", but those of {_names(alike)}" if alike else ""
    return (f"bearing: {words} {entry.designation}{whose}; {cure}",)


_MAIN = ("pitch_diameter", "ball_diameter", "roller_diameter")
"""Dimensions that tell a bearing: two of them stand in every one."""


def _agrees(keys: Mapping[str, Any], entry: CatalogueEntry, names) -> bool:
    """Whether keys of a bearing are those of an entry, whatever its clearance."""
    return all(same_key(entry, k, keys.get(k)) for k in names if k != CLEARANCE)


def _names(entries) -> str:
    return " or ".join(entry.designation for entry in entries)


def _other_class(keys, taken) -> tuple[str, ...]:
    """That a class of clearance is named, and another clearance given."""
    entry, given = taken.entry, _length(keys, CLEARANCE)
    if entry.type not in CLEARANCES or CLEARANCE not in taken.overridden:
        return ()
    limits = {name: _limits(entry, name) for name in CLEARANCE_CLASSES}
    middles = [
        name
        for name, ends in limits.items()
        if ends is not None
        and given is not None
        and abs(given - 0.5 * sum(ends)) < 1e-4 * abs(sum(ends))
    ]
    own = entry.clearance_class
    named = entry.designation.endswith(f"/{own}")
    ends = None if own is None else _limits(entry, own)
    if ends is None or not (named or middles):
        return ()
    is_of = f", the middle of class {middles[0]}," if middles else ""
    return (
        f"bearing: `{CLEARANCE}` ({keys[CLEARANCE]}){is_of} counts in place of class"
        f" {own} of {entry.designation} ({1e6 * ends[0]:.3g} to {1e6 * ends[1]:.3g} µm)"
        "; a [fit] takes it as exact, without the limits of a class",
    )


def _limits(entry: CatalogueEntry, name: str) -> tuple[float, float] | None:
    """Limits of a class of clearance [m], `None` where the size has none."""
    find = entry.class_limits
    if find is None:
        return None
    try:
        low, high = find(name, entry.bore)
    except ValueError:
        return None
    return float(low), float(high)


def _length(table: Mapping[str, Any], key: str) -> float | None:
    """A length [m]; `None` if it is absent, or no length, which is told elsewhere."""
    try:
        return to_si(table.get(key), "length")
    except SceneError:
        return None

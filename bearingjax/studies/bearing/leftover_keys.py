"""Detection of [bearing] lines that appear left over from another designation."""

from collections.abc import Iterable, Mapping
from typing import Any

from ...catalogue.entry import CLEARANCE, CLEARANCES, CatalogueEntry, catalogue_entries
from ...files.quantity import SceneError, to_si
from ...fits.fit_limits import CLEARANCE_CLASSES
from ...numerics.warning import Warning
from .catalogue_keys import FromCatalogue, same_key

_FAR = 0.05
"""Relative change of the pitch diameter above that measured between makers of one
bearing; neighbours of a series differ by more [1]."""


def leftover_warnings(
    keys: Mapping[str, Any], taken: FromCatalogue, varied: Iterable[str] = ()
) -> tuple[Warning, ...]:
    """Return a warning of lines that belong to another designation.

    A scene written by `new` has every line. If only the designation is then changed,
    the old dimensions below it remain and are solved. One or two dimensions changed
    on purpose do not cause a warning.

    Args:
        keys: Keys of [bearing] with those of the catalogue.
        taken: Record of the catalogue entry.
        varied: Keys varied by the cases of a scene ("bearing.n_balls"); if these
            include keys of the bearing its lines are taken as intended, and not
            checked.
    """
    meant = [k for k in varied if k.startswith("bearing.") and "designation" not in k]
    if meant or not taken.overridden:
        return ()
    words = _of_another(keys, taken) or _other_class(keys, taken)
    return (Warning("leftover_keys", f"bearing: {words}"),) if words else ()


def _of_another(keys, taken) -> str:
    """Say that the internal geometry is that of another bearing."""
    entry, changed = taken.entry, set(taken.overridden) - {CLEARANCE}
    others = [e for e in catalogue_entries() if e.type == entry.type]
    cure = "leave out the lines that are not meant"
    whole = [
        e for e in others if changed & set(e.design) and _agrees(keys, e, e.design)
    ]
    if whole:
        words = f"the lines beside `designation` are those of {_names(whole)}"
        return f"{words}, not of {entry.designation}; {cure}"
    main = [k for k in taken.overridden if k in _MAIN]
    if len(main) < 2:
        return ""
    alike = [e for e in others if _agrees(keys, e, main)]
    pitch, own = _length(keys, "pitch_diameter"), entry.design.get("pitch_diameter")
    if not alike and (pitch is None or own is None or abs(pitch / own - 1.0) < _FAR):
        return ""
    shown = " and ".join(f"`{key}`" for key in main)
    words = f"{shown} are {'far from those' if not alike else 'not those'} of"
    whose = f", but those of {_names(alike)}" if alike else ""
    return f"{words} {entry.designation}{whose}; {cure}"


_MAIN = ("pitch_diameter", "ball_diameter", "roller_diameter")
"""Dimensions that identify a bearing: each bearing has two of them."""


def _agrees(keys: Mapping[str, Any], entry: CatalogueEntry, names) -> bool:
    """Whether keys of a bearing equal those of an entry, clearance excluded."""
    return all(same_key(entry, k, keys.get(k)) for k in names if k != CLEARANCE)


def _names(entries) -> str:
    return " or ".join(entry.designation for entry in entries)


def _other_class(keys, taken) -> str:
    """Say that there is a clearance that differs from the named clearance class."""
    entry, given = taken.entry, _length(keys, CLEARANCE)
    if entry.type not in CLEARANCES or CLEARANCE not in taken.overridden:
        return ""
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
        return ""
    is_of = f", the middle of class {middles[0]}," if middles else ""
    return (
        f"`{CLEARANCE}` ({keys[CLEARANCE]}){is_of} counts in place of class"
        f" {own} of {entry.designation} ({1e6 * ends[0]:.3g} to {1e6 * ends[1]:.3g} µm)"
        "; a [fit] takes it as exact, without the limits of a class"
    )


def _limits(entry: CatalogueEntry, name: str) -> tuple[float, float] | None:
    """Return the limits of a clearance class [m]; `None` if the size has none."""
    find = entry.class_limits
    if find is None:
        return None
    try:
        low, high = find(name, entry.bore)
    except ValueError:
        return None
    return float(low), float(high)


def _length(table: Mapping[str, Any], key: str) -> float | None:
    """Return a length [m]; `None` if absent or invalid, which is reported elsewhere."""
    try:
        return to_si(table.get(key), "length")
    except SceneError:
        return None

"""Keys of [bearing] from the catalogue, and those that a scene gives otherwise."""

import dataclasses
import math
from collections.abc import Iterable, Mapping
from typing import Any

from ...catalogue.entry import (
    CLEARANCE,
    ENTRY_UNITS,
    CatalogueEntry,
    catalogue_entry,
    in_catalogue_unit,
)
from ...design.published import with_published
from ...files.quantity import SceneError, to_si
from ...files.table import Table
from .read_design import BALLS, ROLLERS, read_design


def listed_bearing(designation: str) -> CatalogueEntry:
    """Look up a bearing named on the command line.

    Args: as `catalogue_entry`.

    Raises:
        SceneError: If there is no such bearing.
    """
    try:
        return catalogue_entry(designation)
    except ValueError as error:
        raise SceneError(str(error)) from error


def as_keys(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return numbers of the catalogue as in a scene, with the units of catalogues.

    Args:
        values: `design` or `printed` of an entry.
    """
    found = {}
    for key, value in values.items():
        if isinstance(value, Mapping):
            found[key] = as_keys(value)
        elif isinstance(value, float) and ENTRY_UNITS.get(key, "mm"):
            found[key] = in_catalogue_unit(key, value)
        else:
            found[key] = value
    return found


@dataclasses.dataclass(frozen=True)
class FromCatalogue:
    """Catalogue entry of a scene's `designation`.

    Attributes:
        entry: The bearing of the catalogue.
        overridden: Keys to which the scene gives other values.
    """

    entry: CatalogueEntry
    overridden: tuple[str, ...]

    @property
    def rerated_keys(self) -> tuple[str, ...]:
        """Overridden keys on which load ratings depend: the published ones are void."""
        fields = {**ROLLERS, **BALLS}[self.entry.type].rated_fields
        return tuple(key for key in self.overridden if key in fields)

    def add_published(self, row: Any) -> Any:
        """Return a row of the scene with the published ratings unless they are void."""
        if self.rerated_keys:
            return row
        return with_published(row, self.entry.ratings_for(row))

    def override(self, keys: Iterable[str]) -> "FromCatalogue":
        """Mark further scene keys, such as "bearing.n_balls", as overridden."""
        given = [key.split(".")[1] for key in keys if key.startswith("bearing.")]
        names = dict.fromkeys((*self.overridden, *given))
        return dataclasses.replace(self, overridden=tuple(names))

    def __str__(self):
        words = [
            f"{self.entry.designation} (catalogue)",
            f"inner geometry {self.entry.geometry}",
        ]
        if self.overridden:
            words.append(f"overridden: {', '.join(self.overridden)}")
        return ", ".join(words)


CLEARED_ROLLERS = ("spherical_roller", "toroidal_roller")
"""Types with clearance classes whose clearance does not follow from an angle."""

_INSTEAD = {
    "contact_angle": (CLEARANCE,),
    "ribs": ("arrangement", "rib", "axial_internal_clearance"),
}
"""Keys replaced by a given key: one follows from the other."""


def merge_catalogue_keys(
    entry: CatalogueEntry, given: Mapping[str, Any]
) -> tuple[dict[str, Any], FromCatalogue]:
    """Complete the keys of [bearing] from the catalogue.

    Args:
        entry: Catalogue entry of the designation.
        given: Keys given in addition to the designation; nested tables are merged
            key by key, unless they name a `type`.

    Returns:
        All keys, and the record of the catalogue entry.
    """
    dropped = {name for key in given for name in _INSTEAD.get(key, ())}
    if entry.type in CLEARED_ROLLERS:
        dropped.discard(CLEARANCE)
    keys = as_keys(entry.design)
    merged = {k: v for k, v in keys.items() if k not in dropped}
    changed = []
    for key, value in given.items():
        own = keys.get(key)
        if isinstance(own, Mapping) and isinstance(value, Mapping):
            value = value if "type" in value else {**own, **value}
        merged[key] = value
        if not same_key(entry, key, value):
            changed.append(key)
    return merged, FromCatalogue(entry, tuple(changed))


def same_key(entry: CatalogueEntry, key: str, value: Any) -> bool:
    """Whether a key of a scene's [bearing] equals its catalogue value.

    Args:
        entry: Catalogue entry.
        key: Key of [bearing].
        value: Value as written in the scene.
    """
    own = as_keys({key: entry.design.get(key)})[key]
    return _are_equal(value, own) or _are_equal(value, _fill_defaults(entry).get(key))


_FILLED: dict[str, dict[str, Any]] = {}


def _fill_defaults(entry: CatalogueEntry) -> dict[str, Any]:
    """Return the keys of a bearing with all defaults, as echoed in the JSON."""
    if entry.designation not in _FILLED:
        table = Table(as_keys(entry.design), entry.designation)
        read_design(table)
        _FILLED[entry.designation] = table.echo()
    return _FILLED[entry.designation]


def _are_equal(value: Any, own: Any) -> bool:
    """Whether two scene values are equal, such as "7.94 mm" and "0.00794 m"."""
    if isinstance(value, Mapping) and isinstance(own, Mapping):
        return set(value) == set(own) and all(
            _are_equal(value[k], own[k]) for k in value
        )
    if value == own or not (isinstance(value, str) and isinstance(own, str)):
        return value == own
    for kind in ("length", "angle"):
        try:
            return math.isclose(to_si(value, kind), to_si(own, kind), rel_tol=1e-9)
        except SceneError:
            continue
    return False

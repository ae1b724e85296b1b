"""The [bearing] and [set] tables of a scene: the design as drawn."""

import dataclasses
import difflib
from typing import Any

from ...catalogue.entry import CatalogueEntry, catalogue_entry
from ...design import AbstractBearing, BearingSet, PreloadSpring, SetRow
from ...design.bearing_set import shares_rings
from ...files.schema import Keys, key_of, read_keys, scene_key
from ...files.table import Table, text_of
from ...statics.preload import check_preload
from .catalogue_keys import FromCatalogue, merge_catalogue_keys
from .read_design import BALLS, ROLLERS, read_row, two_row_name, with_both_rows

SETS = ("back_to_back", "face_to_face", "tandem", "rows")

EXTRA_KEYS = (
    "set",
    "contact",
    "numerics",
    "fit",
    "temperature",
    "raceway_control",
    "friction_coefficient",
)
"""Keys of a rotor's [bearings.NAME] that do not belong to [bearing]."""


def read_bearing(
    table: Table, parent: Table, found: tuple[dict[str, Any], FromCatalogue] | None
) -> tuple[AbstractBearing | BearingSet, float | None]:
    """Read a bearing, or the set of such bearings, and its preload.

    Args:
        table: Table of the bearing.
        parent: The table that holds its `set`, if there is one.
        found: From `read_designation`.

    Returns:
        Bearing or set, and its preload force [N] or `None`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    table = _complete(table, found)
    bearing = _read_row(table, found)
    if "set" not in parent:
        return with_both_rows(table, bearing), None
    if shares_rings(bearing):
        problem = f"a {two_row_name(bearing)} bearing has both its rows already"
        raise parent.error("set", problem)
    return _set(parent.table("set"), bearing)


def _read_row(
    table: Table, found: tuple[dict[str, Any], FromCatalogue] | None
) -> AbstractBearing:
    """Read a row, with the published ratings of its designation."""
    row = read_row(table)
    return row if found is None else found[1].add_published(row)


def read_designation(table: Table) -> tuple[dict[str, Any], FromCatalogue] | None:
    """Expand the `designation` of a [bearing], or the entry that a program puts there;
    `None` without one.

    Args:
        table: Table of the bearing; none of its keys are marked as read.

    Returns:
        Its keys completed from the catalogue, and the record of the catalogue entry;
        without the keys in `EXTRA_KEYS`.

    Raises:
        SceneError: If the designation is not known, or of another `type`.
    """
    given = {k: v for k, v in table.keys_given().items() if k not in EXTRA_KEYS}
    if "designation" not in table:
        return None
    name = text_of(given.pop("designation"))
    if not isinstance(name, str | CatalogueEntry):
        problem = 'is not a designation, a text such as "6205-2RS1/C3"'
        if isinstance(name, int):
            problem = f'is a number; a designation is a text in quotes, "{name}"'
        raise table.error("designation", f"{name!r} {problem}")
    try:
        entry = catalogue_entry(name) if isinstance(name, str) else name
    except ValueError as error:
        raise table.error("designation", error) from error
    kind = given.get("type", entry.type)
    if kind != entry.type:
        problem = f"is {kind!r}, but {entry.designation} is {entry.type!r}"
        raise table.error("type", f"{problem}; leave one of them out")
    return merge_catalogue_keys(entry, given)


def _complete(
    table: Table, found: tuple[dict[str, Any], FromCatalogue] | None
) -> Table:
    """Return the keys of a bearing, with those of its designation."""
    if found is None and "type" not in table:
        meant = difflib.get_close_matches("designation", table.keys(), 1, 0.7)
        if meant:
            problem = "unknown key (did you mean `designation`?)"
            raise table.error(meant[0], problem)
        problem = "is missing; give it, or a `type` with all sizes, one of"
        raise table.error("designation", f"{problem} {', '.join((*ROLLERS, *BALLS))}")
    if found is None:
        return table
    table.skip("designation")
    whole = table.with_values(found[0])
    # The echo states whose ratings apply, and the clearance.
    whole.fill("designation", found[1].entry.designation)
    return whole


class SpringKeys(Keys):
    about = "Spring that presses a row"

    spring_force: float | None = key_of(PreloadSpring, "force")
    spring_stiffness: float = key_of(
        PreloadSpring, "stiffness", needs=("spring_force",)
    )

    @property
    def spring(self) -> PreloadSpring | None:
        """Preload spring, or `None`."""
        if self.spring_force is None:
            return None
        with self.table.building():
            return PreloadSpring(self.spring_force, self.spring_stiffness)


class RowKeys(SpringKeys):
    about = "[[set.rows]]: a row in its place"

    position: float = key_of(SetRow, "position", default=dataclasses.MISSING)
    mirrored: bool = key_of(SetRow, "mirrored")
    inner_offset: float = key_of(SetRow, "inner_offset")

    def row(self, common: AbstractBearing) -> SetRow:
        """Build the row.

        Args:
            common: Bearing of rows that do not define one.
        """
        bearing = common
        if "bearing" in self.table:
            own = self.table.table("bearing")
            found = read_designation(own)
            bearing = _read_row(_complete(own, found), found)
        if shares_rings(bearing):
            problem = f"a {two_row_name(bearing)} bearing is no row of a set"
            raise self.table.error("bearing", problem)
        place = {"position": self.position, "inner_offset": self.inner_offset}
        with self.table.building():
            return SetRow(bearing, mirrored=self.mirrored, spring=self.spring, **place)


_IN_PAIRS = ("preload_force", "preload_offset", "spring_force")


class SetKeys(SpringKeys):
    about = "[set]: several bearings that act as one"

    arrangement: str = scene_key("how the rows stand", choices=SETS)
    spacing: float | None = scene_key(
        "distance of the rows; of `rows` their `position` counts", "length"
    )
    count: int = scene_key(
        "rows of a tandem", default=2, only={"arrangement": ("tandem",)}
    )
    preload_offset: float | None = scene_key(
        "travel of the rings that grinding leaves to be closed", "length"
    )
    preload_force: float | None = scene_key(
        "force to which the rows are ground", "force", without={"preload_offset": ""}
    )
    rows: tuple[RowKeys, ...] = scene_key(
        "the rows", default=(), only={"arrangement": ("rows",)}
    )

    def check(self) -> None:
        table = self.table
        if self.arrangement == "rows":
            for key in ("spacing", "preload_offset", "spring_force"):
                if key in table:
                    raise table.error(key, "is of each row here; write it in `rows`")
            if not self.rows:
                table.tables("rows")  # which must be there
        else:
            table.quantity("spacing", "length")
        for key in _IN_PAIRS if self.arrangement == "tandem" else ():
            if key in table:
                problem = "is for rows that face each other; those of a tandem do not"
                raise table.error(key, problem)

    def set_of(self, bearing: AbstractBearing) -> BearingSet:
        """Build the set of bearings, before grinding to `preload_force`.

        Args:
            bearing: Bearing of all rows that do not define one.
        """
        if self.arrangement == "rows":
            rows = tuple(row.row(bearing) for row in self.rows)
            with self.table.building():
                return BearingSet(rows)
        spacing, spring = self.spacing or 0.0, self.spring
        with self.table.building():
            if self.arrangement == "tandem":
                return BearingSet.tandem(bearing, spacing, self.count)
            build = getattr(BearingSet, self.arrangement)
            return build(bearing, spacing, self.preload_offset or 0.0, spring)


def _set(table: Table, bearing: AbstractBearing) -> tuple[BearingSet, float | None]:
    keys = read_keys(SetKeys, table)
    pack, force = keys.set_of(bearing), keys.preload_force
    if force is not None:
        with table.building(force="preload_force"):
            check_preload(pack, force)
    return pack, force

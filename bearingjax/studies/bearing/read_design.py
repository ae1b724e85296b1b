"""A bearing from the keys of its design."""

from ... import design
from ...design.bearing_set import shares_rings
from ...design.keywords import BALLS, PROFILES, ROLLERS, both_rows
from ...design.rib import ARRANGEMENTS
from ...element import RINGS
from ...files.schema import build, read_values
from ...files.table import Table, format_number, written_numbers

SPHERES = "spherical_roller", "spherical_thrust_roller"
"""Rollers in an outer raceway whose radius may stand for the pitch diameter."""
WITH_LETTERS = "cylindrical_roller", "needle_roller"
"""Rollers whose ribs have an `arrangement` by letters."""


def read_design(table: Table) -> design.AbstractBearing | design.BearingSet:
    """Read a bearing, or the set of both rows that share its rings.

    Args:
        table: Table of the bearing, without a `designation`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    return with_both_rows(table, read_row(table))


def read_row(table: Table) -> design.AbstractBearing:
    """Read a bearing of one row.

    Args: as `read_design`.
    """
    kind = table.choice("type", (*ROLLERS, *BALLS))
    if kind in BALLS:
        return build(BALLS[kind], table, required_numbers(kind), **_materials(table))
    return _rollers(table, kind)


def with_both_rows(
    table: Table, bearing: design.AbstractBearing
) -> design.AbstractBearing | design.BearingSet:
    """Return the set of both rows of a bearing whose rows share rings, else itself.

    Args:
        table: As in `read_design`.
        bearing: From `read_row`.
    """
    staggered = (
        not shares_rings(bearing)
        or bearing.is_ball
        or bearing.is_crossed
        or table.flag("staggered", True)
    )
    with table.building():
        return both_rows(bearing, staggered)


def two_row_name(bearing: design.AbstractBearing) -> str:
    """Name the kind of a bearing of two rows, which share rings."""
    if bearing.is_ball:
        return "double-row ball" if bearing.is_paired else "self-aligning"
    return "crossed roller" if bearing.is_crossed else "spherical roller"


def required_numbers(kind: str) -> tuple[str, ...]:
    """Return the numbers that a [bearing] must give despite a class default.

    Args:
        kind: `type` of the bearing.
    """
    if kind in ("tapered_roller", "tapered_thrust_roller"):
        return ("roller_axis_angle", "roller_half_angle")
    grooved = kind in BALLS and kind != "self_aligning_ball"
    return ("outer_osculation",) if grooved else ()


PITCH_FOLLOWS = (
    "contact_angle",
    "outer_raceway_radius",
    "profile_offset",
    "radial_internal_clearance",
    "roller_diameter",
    "roller_profile_radius",
)
"""Numbers from which a pitch diameter that is left out follows."""


def pitch_follows(table: Table) -> bool:
    """Whether the pitch diameter of a [bearing] follows from its other numbers.

    Args: as `read_design`.
    """
    return table.raw("type", None) in SPHERES and "pitch_diameter" not in table


def _rollers(table: Table, kind: str) -> design.AbstractRollerBearing:
    derived = pitch_follows(table)
    if derived and "outer_raceway_radius" not in table:
        problem = "is missing, and so is `outer_raceway_radius`; one of them must be a"
        raise table.error("pitch_diameter", f"{problem} length, a text with its unit")
    left_out = ("pitch_diameter",) if derived else ()
    values = {
        **read_values(ROLLERS[kind], table, required_numbers(kind), left_out),
        "roller_profile": read_profile(table.table("roller_profile")),
    }
    if derived:
        values["pitch_diameter"] = design.pitch_on_sphere(**values)
        table.fill("pitch_diameter", format_number(values["pitch_diameter"], "m"))
    raceways = table.table("raceway_profile")
    for ring in RINGS:
        values[f"{ring}_raceway_profile"] = read_profile(raceways.table(ring))
    values["ribs"] = _ribs(table, kind)
    values |= _materials(table)
    with table.building():
        return ROLLERS[kind](**values)


def _materials(table: Table) -> dict[str, design.Material | None]:
    found = {
        "material": read_material(table, "material") or design.Material(),
        "ring_material": read_material(table, "ring_material"),
    }
    for key, material in found.items():
        if material is not None:
            table.fill(key, written_numbers(material))
    return found


def read_material(table: Table, key: str) -> design.Material | None:
    """Read the material at a key, by its name or its numbers; `None` if absent."""
    given = table.table_or_word(key, tuple(design.MATERIALS))
    if given is None:
        return None
    if isinstance(given, str):
        return design.MATERIALS[given]()
    return build(design.Material, given)


def _ribs(table: Table, kind: str) -> design.Ribs:
    if kind == "crossed_roller":
        for key in ("ribs", "rib", "arrangement"):
            if key in table:
                raise table.error(key, "is for others; crossed rollers have no ribs")
        return design.Ribs()
    if "arrangement" not in table:
        for key in ("rib", "axial_internal_clearance"):
            if key in table:
                raise table.error(key, "belongs to an `arrangement`, which is missing")
        ribs = table.table("ribs")
        given = {name: ribs.table(name) for name in design.RIB_NAMES}
        return design.Ribs(
            **{name: _rib(given[name]) for name in design.RIB_NAMES if name in ribs}
        )
    if "ribs" in table:
        raise table.error("ribs", "give either `arrangement` or `ribs`, not both")
    if kind not in WITH_LETTERS:
        problem = "is for cylindrical and needle rollers; others name their `ribs`"
        raise table.error("arrangement", problem)
    name = table.choice("arrangement", tuple(ARRANGEMENTS))
    play = table.quantity("axial_internal_clearance", "length", None)
    common = table.table("rib", required=True)
    rib = _rib(common)
    if play is not None and "axial_gap" in common:
        problem = "give either `rib.axial_gap` or this, not both"
        raise table.error("axial_internal_clearance", problem)
    if play is not None:
        common.fill("axial_gap", None)  # it follows from the clearance
    with table.building():
        return design.Ribs.arrangement(name, rib, play)


def _rib(table: Table) -> design.Rib:
    if "end_radius" in table and table.word("end_radius") == "flat":
        problem = "flat ends have no point contact; give the radius of the end sphere"
        raise table.error("end_radius", problem)
    return build(design.Rib, table)


def read_profile(table: Table) -> design.AbstractProfile:
    """Read the profile of a roller or raceway; straight if the table is empty."""
    return build(PROFILES[table.choice("type", tuple(PROFILES), "straight")], table)

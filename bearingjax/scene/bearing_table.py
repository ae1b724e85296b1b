"""The [bearing] and [set] tables of a scene: what stands on the drawing."""

import difflib
from typing import Any

from ..design import (
    ARRANGEMENTS,
    MATERIALS,
    RIB_NAMES,
    AbstractProfile,
    AbstractRollerBearing,
    AngularContactBallBearing,
    Bearing,
    BearingSet,
    CircularCrown,
    CrownedEnds,
    CylindricalRollerBearing,
    DeepGrooveBallBearing,
    FourPointBallBearing,
    FujiwaraKawase,
    JohnsGohar,
    Logarithmic,
    Lundberg,
    Material,
    NeedleRollerBearing,
    PreloadSpring,
    Rib,
    Ribs,
    SelfAligningBallRow,
    SetRow,
    Straight,
    Tabulated,
    TaperedRollerBearing,
    ThrustBallBearing,
)
from ..element import RINGS
from ..statics.preload import check_preload
from .catalogue_entry import FromCatalogue, catalogue_entry, taken_from
from .quantity import SceneError
from .table import Table, written_numbers

ROLLERS = {
    "cylindrical_roller": CylindricalRollerBearing,
    "needle_roller": NeedleRollerBearing,
    "tapered_roller": TaperedRollerBearing,
}
BALLS = {
    "deep_groove_ball": DeepGrooveBallBearing,
    "angular_contact_ball": AngularContactBallBearing,
    "four_point_ball": FourPointBallBearing,
    "self_aligning_ball": SelfAligningBallRow,
    "thrust_ball": ThrustBallBearing,
}
SETS = ("back_to_back", "face_to_face", "tandem", "rows")

BESIDE = (
    "set",
    "contact",
    "numerics",
    "fit",
    "temperature",
    "raceway_control",
    "friction_coefficient",
)
"""Keys of a rotor's [bearings.NAME] that are none of a [bearing]."""

PROFILES = {
    "straight": Straight,
    "circular_crown": CircularCrown,
    "crowned_ends": CrownedEnds,
    "logarithmic": Logarithmic,
    "lundberg": Lundberg,
    "johns_gohar": JohnsGohar,
    "fujiwara_kawase": FujiwaraKawase,
    "tabulated": Tabulated,
}


def read_bearing(
    table: Table, beside: Table
) -> tuple[Bearing | BearingSet, float | None]:
    """A bearing, or the set of such bearings, and its preload.

    Args:
        table: Of the bearing.
        beside: The table in which its `set` stands, if there is one.

    Returns:
        Bearing or set, and the force to which it is preloaded [N] or `None`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    bearing = _single(table)
    if isinstance(bearing, SelfAligningBallRow):
        if "set" in beside:
            raise beside.error(
                "set", "a self-aligning bearing has both its rows already"
            )
        with table.building():
            return BearingSet.self_aligning(bearing), None
    if "set" not in beside:
        return bearing, None
    return _set(beside.table("set"), bearing)


def designated(table: Table) -> tuple[dict[str, Any], FromCatalogue] | None:
    """What a [bearing] with a `designation` stands for; `None` without one.

    Args:
        table: Of the bearing; nothing in it counts as asked for by this.

    Returns:
        Its keys with those of the catalogue, and what was taken from there; without
        what stands beside them (`BESIDE`).

    Raises:
        SceneError: If the designation is not known, or of another `type`.
    """
    given = {k: v for k, v in table.keys_given().items() if k not in BESIDE}
    if "designation" not in table:
        return None
    name = given.pop("designation")
    if not isinstance(name, str):
        problem = 'is not a designation, a text such as "6205-2RS1/C3"'
        if isinstance(name, int):
            problem = f'is a number; a designation is a text in quotes, "{name}"'
        raise table.error("designation", f"{name!r} {problem}")
    try:
        entry = catalogue_entry(name)
    except SceneError as error:
        raise table.error("designation", error) from error
    kind = given.get("type", entry.type)
    if kind != entry.type:
        problem = f"is {kind!r}, but {entry.designation} is {entry.type!r}"
        raise table.error("type", f"{problem}; leave one of them out")
    return taken_from(entry, given)


def _single(table: Table) -> Bearing:
    """A bearing of one row."""
    found = designated(table)
    if found is None and "type" not in table:
        meant = difflib.get_close_matches("designation", table.keys(), 1, 0.7)
        if meant:
            problem = "unknown key (did you mean `designation`?)"
            raise table.error(meant[0], problem)
    if found is not None:
        table.skip("designation")
        table = table.completed(found[0])
        # In the echo it says whose ratings count, and what clearance.
        table.fill("designation", found[1].entry.designation)
    kind = table.choice("type", (*ROLLERS, *BALLS))
    return _balls(table, kind) if kind in BALLS else _rollers(table, kind)


def _own(row: Table, common: Bearing) -> Bearing:
    """The bearing of a row of a set: its own, or the one of all rows without."""
    if "bearing" not in row:
        return common
    own = row.table("bearing")
    bearing = _single(own)
    if isinstance(bearing, SelfAligningBallRow):
        raise row.error("bearing", "a self-aligning bearing is no row of a set")
    return bearing


def _set(table: Table, bearing: Bearing) -> tuple[BearingSet, float | None]:
    arrangement = table.choice("arrangement", SETS)
    if arrangement == "tandem":
        for key in ("preload_force", "preload_offset", "spring_force"):
            if key in table:
                problem = "is for rows that face each other; those of a tandem do not"
                raise table.error(key, problem)
        spacing, count = table.quantity("spacing", "length"), table.integer("count", 2)
        with table.building():
            return BearingSet.tandem(bearing, spacing, count), None
    force = table.quantity("preload_force", "force", None)
    if arrangement == "rows":
        rows = []
        for row in table.tables("rows"):
            places = row.fields(SetRow, "position")
            mirrored, spring = row.flag("mirrored", False), _spring(row)
            own = _own(row, bearing)
            with row.building():
                rows.append(SetRow(own, mirrored=mirrored, spring=spring, **places))
        with table.building():
            pack = BearingSet(tuple(rows))
    else:
        spacing = table.quantity("spacing", "length")
        offset = table.quantity("preload_offset", "length", None)
        spring = _spring(table)
        if force is not None and offset is not None:
            problem = "give either `preload_offset` or this, not both"
            raise table.error("preload_force", problem)
        with table.building():
            build = getattr(BearingSet, arrangement)
            pack = build(bearing, spacing, offset or 0.0, spring)
    if force is not None:
        with table.building():
            check_preload(pack, force)
    return pack, force


def _spring(table: Table) -> PreloadSpring | None:
    force = table.quantity("spring_force", "force", None)
    stiffness = table.quantity("spring_stiffness", "stiffness", None)
    if force is None:
        if stiffness is not None:
            raise table.error("spring_stiffness", "goes with `spring_force`")
        return None
    with table.building():
        return PreloadSpring(force, 0.0 if stiffness is None else stiffness)


def _balls(table: Table, kind: str) -> Bearing:
    required = () if kind == "self_aligning_ball" else ("outer_osculation",)
    values = {
        "n_balls": table.integer("n_balls"),
        **table.fields(BALLS[kind], *required),
        **_materials(table),
    }
    with table.building():
        return BALLS[kind](**values)


def _rollers(table: Table, kind: str) -> AbstractRollerBearing:
    required = ("roller_axis_angle", "roller_half_angle")
    values = {
        "n_rollers": table.integer("n_rollers"),
        **table.fields(ROLLERS[kind], *required),
        "roller_profile": read_profile(table.table("roller_profile")),
    }
    raceways = table.table("raceway_profile")
    for ring in RINGS:
        values[f"{ring}_raceway_profile"] = read_profile(raceways.table(ring))
    values["ribs"] = _ribs(table, kind)
    values |= _materials(table)
    with table.building():
        return ROLLERS[kind](**values)


def _materials(table: Table) -> dict[str, Material | None]:
    found = {
        "material": read_material(table, "material") or Material(),
        "ring_material": read_material(table, "ring_material"),
    }
    for key, material in found.items():
        if material is not None:
            table.fill(key, written_numbers(material))
    return found


def read_material(table: Table, key: str) -> Material | None:
    """Material at a key, by its name or its numbers; `None` if absent."""
    given = table.table_or_word(key, tuple(MATERIALS))
    if given is None:
        return None
    if isinstance(given, str):
        return MATERIALS[given]()
    values = given.fields(Material)
    with given.building():
        return Material(**values)


def _ribs(table: Table, kind: str) -> Ribs:
    if "arrangement" not in table:
        for key in ("rib", "axial_internal_clearance"):
            if key in table:
                raise table.error(key, "belongs to an `arrangement`, which is missing")
        ribs = table.table("ribs")
        given = {name: ribs.table(name) for name in RIB_NAMES}
        return Ribs(**{name: _rib(given[name]) for name in RIB_NAMES if name in ribs})
    if "ribs" in table:
        raise table.error("ribs", "give either `arrangement` or `ribs`, not both")
    if kind == "tapered_roller":
        problem = "is for cylindrical and needle rollers; a taper names its `ribs`"
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
        return Ribs.arrangement(name, rib, play)


def _rib(table: Table) -> Rib:
    if "end_radius" in table and table.word("end_radius") == "flat":
        problem = "flat ends have no point contact; give the radius of the end sphere"
        raise table.error("end_radius", problem)
    values = table.fields(Rib)
    with table.building():
        return Rib(**values)


def read_profile(table: Table) -> AbstractProfile:
    """Profile of a roller or a raceway; straight if the table is empty."""
    kind = PROFILES[table.choice("type", tuple(PROFILES), "straight")]
    values = table.fields(kind)
    with table.building():
        return kind(**values)

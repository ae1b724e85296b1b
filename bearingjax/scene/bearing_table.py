"""The [bearing] and [set] tables of a scene: what stands on the drawing."""

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
from .table import Table

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

KIND_OF = {
    **dict.fromkeys(
        (
            "pitch_diameter roller_diameter roller_length ball_diameter crown_radius"
            " radial_internal_clearance straight_length dub_off_length dub_off_radius"
            " half_width end_drop end_radius contact_height axial_gap row_offset"
            " outer_shoulder inner_shoulder"
        ).split(),
        "length",
    ),
    **dict.fromkeys(
        (
            "first_azimuth roller_axis_angle roller_half_angle contact_angle shim_angle"
        ).split(),
        "angle",
    ),
    **dict.fromkeys(("contact_modulus", "elastic_modulus"), "pressure"),
    **dict.fromkeys(
        (
            "coefficient load_factor crowned_fraction outer_osculation inner_osculation"
            " poisson_ratio"
        ).split(),
        "number",
    ),
    "design_load": "force",
    "density": "density",
}
"""Kind of quantity of a number on the drawing, by its key: for all that reads one."""


def drawn(table: Table, name: str, *default: Any, key: str | None = None) -> Any:
    """Number on the drawing, in SI.

    Args:
        table: Where it stands.
        name: What it is, a key of `KIND_OF`.
        default: If absent; without a default it is required.
        key: Key in the table; default: the name.

    Raises:
        SceneError: If it is no such quantity.
    """
    key, kind = key or name, KIND_OF[name]
    if kind == "number":
        return table.number(key, *default)
    return table.quantity(key, kind, *default)


def read_bearing(top: Table) -> tuple[Bearing | BearingSet, float | None]:
    """The bearing of a scene, or the set of such bearings, and its preload.

    Args:
        top: The whole scene.

    Returns:
        Bearing or set, and the force to which it is preloaded [N] or `None`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    table = top.table("bearing", required=True)
    kind = table.choice("type", (*ROLLERS, *BALLS))
    if kind == "self_aligning_ball" and "outer_osculation" in table:
        problem = "the outer raceway is a sphere about the middle of the bearing"
        raise table.error("outer_osculation", problem)
    bearing = _balls(table, kind) if kind in BALLS else _rollers(table, kind)
    if isinstance(bearing, SelfAligningBallRow):
        if "set" in top:
            raise top.error("set", "a self-aligning bearing has both its rows already")
        with table.building():
            return BearingSet.self_aligning(bearing), None
    return _set(top.table("set"), bearing) if "set" in top else (bearing, None)


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
            values = (
                row.quantity("position", "length"),
                row.flag("mirrored", False),
                row.quantity("inner_offset", "length", 0.0),
                _spring(row),
            )
            with row.building():
                rows.append(SetRow(bearing, *values))
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
    values: dict[str, Any] = {"n_balls": table.integer("n_balls")}
    for key in ("pitch_diameter", "ball_diameter"):
        values[key] = drawn(table, key)
    for ring in RINGS[1:] if kind == "self_aligning_ball" else RINGS:
        values[f"{ring}_osculation"] = drawn(table, f"{ring}_osculation")
        key = f"{ring}_shoulder"
        values[key] = drawn(table, key, None)
    values["first_azimuth"] = drawn(table, "first_azimuth", 0.0)
    if "ball_deviation" in table:
        values["ball_deviation"] = table.quantities("ball_deviation", "length")
    play, angle = "radial_internal_clearance", "contact_angle"
    if kind == "deep_groove_ball":
        values[play] = drawn(table, play, None)
        values[angle] = drawn(table, angle, None)
    if kind == "angular_contact_ball":
        values[angle] = drawn(table, angle)
    if kind == "four_point_ball":
        values[play] = drawn(table, play, 0.0)
        values["shim_angle"] = drawn(table, "shim_angle")
    if kind == "self_aligning_ball":
        values["row_offset"] = drawn(table, "row_offset")
        values[play] = drawn(table, play, 0.0)
    values["material"] = read_material(table, "material") or Material()
    values["ring_material"] = read_material(table, "ring_material")
    with table.building():
        return BALLS[kind](**values)


def _rollers(table: Table, kind: str) -> AbstractRollerBearing:
    values: dict[str, Any] = {"n_rollers": table.integer("n_rollers")}
    for key in ("pitch_diameter", "roller_diameter", "roller_length"):
        values[key] = drawn(table, key)
    play = "radial_internal_clearance"
    values[play] = drawn(table, play, 0.0)
    values["first_azimuth"] = drawn(table, "first_azimuth", 0.0)
    if kind == "tapered_roller":
        values["roller_axis_angle"] = drawn(table, "roller_axis_angle")
        values["roller_half_angle"] = drawn(table, "roller_half_angle")
    values["roller_profile"] = read_profile(table.table("roller_profile"))
    raceways = table.table("raceway_profile")
    for ring in RINGS:
        values[f"{ring}_raceway_profile"] = read_profile(raceways.table(ring))
    values["ribs"] = _ribs(table, kind)
    values["material"] = read_material(table, "material") or Material()
    values["ring_material"] = read_material(table, "ring_material")
    with table.building():
        return ROLLERS[kind](**values)


def read_material(table: Table, key: str) -> Material | None:
    """Material at a key, by its name or its numbers; `None` if absent."""
    given = table.table_or_word(key, tuple(MATERIALS))
    if given is None:
        return None
    if isinstance(given, str):
        return MATERIALS[given]()
    steel = Material()
    values = (
        drawn(given, "elastic_modulus", steel.elastic_modulus),
        drawn(given, "poisson_ratio", steel.poisson_ratio),
        drawn(given, "density", steel.density),
    )
    with given.building():
        return Material(*values)


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
    with table.building():
        return Ribs.arrangement(name, rib, play)


def _rib(table: Table) -> Rib:
    if "end_radius" in table and table.word("end_radius") == "flat":
        problem = "flat ends have no point contact; give the radius of the end sphere"
        raise table.error("end_radius", problem)
    values = (
        drawn(table, "end_radius"),
        drawn(table, "contact_height"),
        drawn(table, "axial_gap", 0.0),
    )
    with table.building():
        return Rib(*values)


def read_profile(table: Table) -> AbstractProfile:
    """Profile of a roller or a raceway; straight if the table is empty."""
    kind = table.choice("type", tuple(_PROFILE_READERS), "straight")
    with table.building():
        return _PROFILE_READERS[kind](table)


def _design_load(table: Table) -> dict[str, float]:
    values = {"design_load": drawn(table, "design_load")}
    modulus = drawn(table, "contact_modulus", None)
    return values if modulus is None else {**values, "contact_modulus": modulus}


_PROFILE_READERS = {
    "straight": lambda t: Straight(),
    "circular_crown": lambda t: CircularCrown(drawn(t, "crown_radius")),
    "crowned_ends": lambda t: CrownedEnds(
        drawn(t, "straight_length"),
        drawn(t, "crown_radius"),
        drawn(t, "dub_off_length", None),
        drawn(t, "dub_off_radius", None),
    ),
    "logarithmic": lambda t: Logarithmic(drawn(t, "coefficient", 0.00035)),
    "lundberg": lambda t: Lundberg(**_design_load(t)),
    "johns_gohar": lambda t: JohnsGohar(
        **_design_load(t), half_width=drawn(t, "half_width")
    ),
    "fujiwara_kawase": lambda t: FujiwaraKawase(
        **_design_load(t),
        load_factor=drawn(t, "load_factor"),
        crowned_fraction=drawn(t, "crowned_fraction"),
        end_drop=drawn(t, "end_drop"),
    ),
    "tabulated": lambda t: Tabulated(
        t.quantities("positions", "length"), t.quantities("drops", "length")
    ),
}

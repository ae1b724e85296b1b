"""The [bearing] and [set] tables of a scene: the design as drawn."""

import dataclasses
import difflib
from typing import Any

from ..design import (
    ARRANGEMENTS,
    MATERIALS,
    RIB_NAMES,
    AbstractBearing,
    AbstractProfile,
    AbstractRollerBearing,
    AngularContactBallBearing,
    BearingSet,
    CircularCrown,
    CrossedRollerRow,
    CrownedEnds,
    CylindricalRollerBearing,
    CylindricalThrustRollerBearing,
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
    SphericalRollerRow,
    SphericalThrustRollerBearing,
    Straight,
    Tabulated,
    TaperedRollerBearing,
    TaperedThrustRollerBearing,
    ThrustBallBearing,
    ToroidalRollerBearing,
    pitch_on_sphere,
    shares_rings,
)
from ..element import RINGS
from ..statics.preload import check_preload
from .catalogue_entry import FromCatalogue, catalogue_entry, taken_from
from .quantity import SceneError
from .schema import Keys, read_keys, scene_key
from .table import Table, written, written_numbers

ROLLERS = {
    "cylindrical_roller": CylindricalRollerBearing,
    "needle_roller": NeedleRollerBearing,
    "tapered_roller": TaperedRollerBearing,
    "spherical_roller": SphericalRollerRow,
    "toroidal_roller": ToroidalRollerBearing,
    "cylindrical_thrust_roller": CylindricalThrustRollerBearing,
    "tapered_thrust_roller": TaperedThrustRollerBearing,
    "spherical_thrust_roller": SphericalThrustRollerBearing,
    "crossed_roller": CrossedRollerRow,
}
BALLS = {
    "deep_groove_ball": DeepGrooveBallBearing,
    "angular_contact_ball": AngularContactBallBearing,
    "four_point_ball": FourPointBallBearing,
    "self_aligning_ball": SelfAligningBallRow,
    "thrust_ball": ThrustBallBearing,
}
"""Bearings by `type` in a scene; readers, schema and messages follow from `ROLLERS` and
`BALLS`."""
SPHERES = "spherical_roller", "spherical_thrust_roller"
"""Rollers in an outer raceway whose radius may stand for the pitch diameter."""
WITH_LETTERS = "cylindrical_roller", "needle_roller"
"""Rollers whose ribs have an `arrangement` by letters."""
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
) -> tuple[AbstractBearing | BearingSet, float | None]:
    """Read a bearing, or the set of such bearings, and its preload.

    Args:
        table: Table of the bearing.
        beside: The table that holds its `set`, if there is one.

    Returns:
        Bearing or set, and its preload force [N] or `None`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    bearing = _single(table)
    if shares_rings(bearing):
        if "set" in beside:
            problem = f"a {_named(bearing)} bearing has both its rows already"
            raise beside.error("set", problem)
        if isinstance(bearing, CrossedRollerRow):
            return BearingSet.crossed(bearing), None
        staggered = bearing.is_ball or table.flag("staggered", True)
        with table.building():
            return BearingSet.self_aligning(bearing, staggered=staggered), None
    if "set" not in beside:
        return bearing, None
    return _set(beside.table("set"), bearing)


def _named(bearing: AbstractBearing) -> str:
    """Name the kind of a bearing of two rows."""
    if bearing.is_ball:
        return "self-aligning"
    return (
        "crossed roller"
        if isinstance(bearing, CrossedRollerRow)
        else "spherical roller"
    )


def designated(table: Table) -> tuple[dict[str, Any], FromCatalogue] | None:
    """Expand the `designation` of a [bearing]; `None` without one.

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


def _single(table: Table) -> AbstractBearing:
    """Read a bearing of one row."""
    found = designated(table)
    if found is None and "type" not in table:
        meant = difflib.get_close_matches("designation", table.keys(), 1, 0.7)
        if meant:
            problem = "unknown key (did you mean `designation`?)"
            raise table.error(meant[0], problem)
        problem = "is missing; give it, or a `type` with all sizes, one of"
        raise table.error("designation", f"{problem} {', '.join((*ROLLERS, *BALLS))}")
    if found is not None:
        table.skip("designation")
        table = table.completed(found[0])
        # The echo states whose ratings apply, and the clearance.
        table.fill("designation", found[1].entry.designation)
    kind = table.choice("type", (*ROLLERS, *BALLS))
    if found is not None and kind == "spherical_roller":
        table.skip("staggered")  # of both rows, read with them
    return _balls(table, kind) if kind in BALLS else _rollers(table, kind)


@dataclasses.dataclass(frozen=True, kw_only=True)
class SpringKeys(Keys):
    """Spring that presses a row."""

    spring_force: float | None = scene_key(
        "force of the spring that preloads, where the row just touches", "force"
    )
    spring_stiffness: float = scene_key(
        "force that it loses per travel",
        "stiffness",
        default=0.0,
        needs=("spring_force",),
    )

    @property
    def spring(self) -> PreloadSpring | None:
        """Preload spring, or `None`."""
        if self.spring_force is None:
            return None
        with self.table.building():
            return PreloadSpring(self.spring_force, self.spring_stiffness)


@dataclasses.dataclass(frozen=True, kw_only=True)
class RowKeys(SpringKeys):
    """[[set.rows]]: a row in its place."""

    position: float = scene_key("place along the axis", "length")
    mirrored: bool = scene_key("whether it is turned round", default=False)
    inner_offset: float = scene_key(
        "axial offset of the inner ring against the outer one: preload by ground rings",
        "length",
        default=0.0,
    )

    def row(self, common: AbstractBearing) -> SetRow:
        """Build the row.

        Args:
            common: Bearing of rows that do not define one.
        """
        bearing = common
        if "bearing" in self.table:
            bearing = _single(self.table.table("bearing"))
        if shares_rings(bearing):
            problem = f"a {_named(bearing)} bearing is no row of a set"
            raise self.table.error("bearing", problem)
        place = {"position": self.position, "inner_offset": self.inner_offset}
        with self.table.building():
            return SetRow(bearing, mirrored=self.mirrored, spring=self.spring, **place)


_IN_PAIRS = ("preload_force", "preload_offset", "spring_force")


@dataclasses.dataclass(frozen=True, kw_only=True)
class SetKeys(SpringKeys):
    """[set]: several bearings that act as one."""

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
        with table.building():
            check_preload(pack, force)
    return pack, force


def required_numbers(kind: str) -> tuple[str, ...]:
    """Return the numbers that a [bearing] must give despite a class default.

    Args:
        kind: `type` of the bearing.
    """
    if kind in ("tapered_roller", "tapered_thrust_roller"):
        return ("roller_axis_angle", "roller_half_angle")
    grooved = kind in BALLS and kind != "self_aligning_ball"
    return ("outer_osculation",) if grooved else ()


def _balls(table: Table, kind: str) -> AbstractBearing:
    values = {
        "n_balls": table.integer("n_balls"),
        **table.fields(BALLS[kind], *required_numbers(kind)),
        **_materials(table),
    }
    with table.building():
        return BALLS[kind](**values)


def _rollers(table: Table, kind: str) -> AbstractRollerBearing:
    derived = kind in SPHERES and "pitch_diameter" not in table
    if derived and "outer_raceway_radius" not in table:
        problem = "is missing, and so is `outer_raceway_radius`; one of them must be a"
        raise table.error("pitch_diameter", f"{problem} length, a text with its unit")
    left_out = ("pitch_diameter",) if derived else ()
    values = {
        "n_rollers": table.integer("n_rollers"),
        **table.fields(ROLLERS[kind], *required_numbers(kind), left_out=left_out),
        "roller_profile": read_profile(table.table("roller_profile")),
    }
    if derived:
        values["pitch_diameter"] = pitch_on_sphere(**values)
        table.fill("pitch_diameter", written(values["pitch_diameter"], "m"))
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
    """Read the material at a key, by its name or its numbers; `None` if absent."""
    given = table.table_or_word(key, tuple(MATERIALS))
    if given is None:
        return None
    if isinstance(given, str):
        return MATERIALS[given]()
    values = given.fields(Material)
    with given.building():
        return Material(**values)


def _ribs(table: Table, kind: str) -> Ribs:
    if kind == "crossed_roller":
        for key in ("ribs", "rib", "arrangement"):
            if key in table:
                raise table.error(key, "is for others; crossed rollers have no ribs")
        return Ribs()
    if "arrangement" not in table:
        for key in ("rib", "axial_internal_clearance"):
            if key in table:
                raise table.error(key, "belongs to an `arrangement`, which is missing")
        ribs = table.table("ribs")
        given = {name: ribs.table(name) for name in RIB_NAMES}
        return Ribs(**{name: _rib(given[name]) for name in RIB_NAMES if name in ribs})
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
        return Ribs.arrangement(name, rib, play)


def _rib(table: Table) -> Rib:
    if "end_radius" in table and table.word("end_radius") == "flat":
        problem = "flat ends have no point contact; give the radius of the end sphere"
        raise table.error("end_radius", problem)
    values = table.fields(Rib)
    with table.building():
        return Rib(**values)


def read_profile(table: Table) -> AbstractProfile:
    """Read the profile of a roller or raceway; straight if the table is empty."""
    kind = PROFILES[table.choice("type", tuple(PROFILES), "straight")]
    values = table.fields(kind)
    with table.building():
        return kind(**values)

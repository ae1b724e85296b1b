"""Scene files: from TOML to a bearing, how it runs, and what is wanted."""

import dataclasses
import re
import tomllib
import warnings
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path
from typing import Any

import jax

from ..contact.line import ISO16281, AbstractLineLaw, LineConstant, Palmgren
from ..design import (
    ARRANGEMENTS,
    MATERIALS,
    RIB_NAMES,
    AbstractProfile,
    AbstractRollerBearing,
    CircularCrown,
    CrownedEnds,
    CylindricalRollerBearing,
    FujiwaraKawase,
    JohnsGohar,
    Logarithmic,
    Lundberg,
    Material,
    NeedleRollerBearing,
    Rib,
    Ribs,
    Straight,
    Tabulated,
    TaperedRollerBearing,
)
from ..element import FREEDOMS, LOADS, RINGS, BearingElement, Finite, Linearised, Speed
from ..numerics import BFGS, ContactMapped, Midpoint, TrustRegionNewton
from .quantity import SceneError
from .table import Table

BEARINGS = {
    "cylindrical_roller": CylindricalRollerBearing,
    "needle_roller": NeedleRollerBearing,
    "tapered_roller": TaperedRollerBearing,
}
LINE_LAWS = {"palmgren": Palmgren, "iso16281": ISO16281}
QUADRATURES = {"contact_mapped": ContactMapped, "midpoint": Midpoint}
KINEMATICS = {"linearised": Linearised, "finite": Finite}
EQUILIBRIA = {"newton": TrustRegionNewton, "bfgs": BFGS}


@dataclasses.dataclass(frozen=True)
class Scene:
    """What a scene file asks for, in SI.

    Attributes:
        name: Name of the file without its ending.
        element: The bearing with its law and numerics.
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring [N, N m].
        prescribed: Displacements given by freedom name [m, rad].
        free: Freedoms that may move, or `None` for all that the bearing restrains.
        fixed_ring: "outer" or "inner".
        speed: Ring speeds, or `None` if both rings stand still.
        tolerance: Relative residual of the load solve, or `None` for the default.
        points: Positions along the rollers at which loads are reported.
        warnings: What the validation found odd but possible.
    """

    name: str
    element: BearingElement
    load: tuple[float, ...]
    prescribed: dict[str, float]
    free: tuple[str, ...] | None
    fixed_ring: str
    speed: Speed | None
    tolerance: float | None
    points: int
    warnings: tuple[str, ...]

    @property
    def moving_ring(self) -> str:
        """The ring that is loaded."""
        return RINGS[1 - RINGS.index(self.fixed_ring)]


def shipped_scenes() -> dict[str, Path]:
    """Scenes that come with the package, by name."""
    folder = Path(str(files("bearingjax.scene") / "examples"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_bearing(source: str | Path) -> AbstractRollerBearing:
    """The bearing of a scene file.

    Args:
        source: Path of a `.toml` scene, or the name of a shipped one.

    Raises:
        SceneError: If the scene cannot be read.
    """
    return read_scene(source).element.bearing


def read_scene(source: str | Path, settings: Iterable[str] = ()) -> Scene:
    """Read a scene file.

    Args:
        source: Path of a `.toml` file, or the name of a shipped scene.
        settings: Changes "dotted.key=value" to what the file says; the value is
            TOML, or text without quotes ("operating.load.Fz=-6 kN").

    Returns:
        The scene, validated.

    Raises:
        SceneError: One line that names file, key, fault and what is allowed.
    """
    if not jax.config.jax_enable_x64:  # type: ignore[attr-defined]
        raise SceneError(
            "scenes are solved in float64, which is off: call"
            ' jax.config.update("jax_enable_x64", True) before anything else'
        )
    path = _find(source)
    data = _parse(path)
    for setting in settings:
        _set(data, setting, path.name)
    top = Table(data, path.name)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        bearing = _bearing(top.table("bearing", required=True))
    scene = _scene(top, path.stem, bearing, tuple(str(w.message) for w in caught))
    top.finish()
    return scene


def _find(source):
    path = Path(source)
    if path.suffix != ".toml" and not path.is_file():
        shipped = shipped_scenes()
        if str(source) in shipped:
            return shipped[str(source)]
        raise SceneError(
            f"{source}: neither a .toml file nor a shipped scene ({', '.join(shipped)})"
        )
    if not path.is_file():
        raise SceneError(f"{source}: no such file")
    return path


def _parse(path):
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (ValueError, OSError) as error:
        # TOML syntax, encoding, and numbers too long to convert are all ValueErrors.
        raise SceneError(f"{path.name}: cannot be read as TOML: {error}") from error


def _set(data: dict, setting: str, file: str) -> None:
    key, equals, text = setting.partition("=")
    parts = [part.strip() for part in key.split(".")]
    if not equals or not all(re.fullmatch(r"[A-Za-z0-9_-]+", p) for p in parts):
        raise SceneError(
            f"{file}: {setting!r} is not a setting; write key=value, such as"
            ' "operating.load.Fy=-4 kN"'
        )
    for depth, part in enumerate(parts[:-1]):
        data = data.setdefault(part, {})
        if not isinstance(data, dict):
            inner = ".".join(parts[: depth + 1])
            raise SceneError(f"{file}: `{inner}` is not a table, so {key!r} fails")
    try:
        data[parts[-1]] = tomllib.loads(f"value = {text}")["value"]
    except ValueError:
        data[parts[-1]] = text.strip()


def _scene(top, name, bearing, odd) -> Scene:
    line_law = _line_law(top.table("contact"))
    operating, numerics = top.table("operating"), top.table("numerics")
    with numerics.building():
        element = BearingElement(bearing, line_law, *_numerics(numerics))
    tolerance = numerics.number("tolerance", None)
    if tolerance is not None and not 1e-14 <= tolerance < 1e-2:
        problem = f"{tolerance:g} is not allowed; from 1e-14 to below 0.01"
        raise numerics.error("tolerance", problem)
    free = operating.words("free", FREEDOMS[:5])
    prescribed = _components(operating, "prescribed", FREEDOMS, ("length", "angle"))
    both = sorted(set(free or ()) & set(prescribed))
    if both:
        problem = f"{', '.join(both)} is both free and prescribed; choose one"
        raise operating.error("free", problem)
    load = _components(operating, "load", LOADS, ("force", "moment"))
    rpm = {r: operating.quantity(f"{r}_speed", "speed", 0.0) for r in RINGS}
    return Scene(
        name=name,
        element=element,
        load=tuple(load.get(component, 0.0) for component in LOADS),
        prescribed=prescribed,
        free=free,
        fixed_ring=operating.choice("fixed_ring", RINGS, "outer"),
        speed=Speed(rpm["inner"], rpm["outer"]) if any(rpm.values()) else None,
        tolerance=tolerance,
        points=top.table("output").integer("points", 101, least=2),
        warnings=odd,
    )


def _components(operating, key, names, kinds) -> dict[str, float]:
    """Table of six components: the first three of one kind, the others of another."""
    table = operating.table(key)
    values = {}
    for index, name in enumerate(names):
        value = table.quantity(name, kinds[index // 3], None)
        if value is not None:
            values[name] = value
    return values


def _line_law(contact: Table) -> AbstractLineLaw:
    law = contact.choice("line_law", tuple(LINE_LAWS), "palmgren")
    constant = contact.quantity("line_constant", "line constant", None)
    if constant is None:
        return LINE_LAWS[law]()
    with contact.building():
        return LineConstant(constant)


def _numerics(numerics: Table):
    rule = numerics.choice("quadrature", tuple(QUADRATURES), "contact_mapped")
    points = numerics.integer("points", None)
    kinematics = numerics.choice("kinematics", tuple(KINEMATICS), "linearised")
    solver = numerics.choice("equilibrium", tuple(EQUILIBRIA), "newton")
    quadrature = QUADRATURES[rule]() if points is None else QUADRATURES[rule](points)
    return KINEMATICS[kinematics](), quadrature, EQUILIBRIA[solver]()


def _bearing(table: Table) -> AbstractRollerBearing:
    kind = table.choice("type", tuple(BEARINGS))
    values: dict[str, Any] = {"n_rollers": table.integer("n_rollers")}
    for key in ("pitch_diameter", "roller_diameter", "roller_length"):
        values[key] = table.quantity(key, "length")
    play = "radial_internal_clearance"
    values[play] = table.quantity(play, "length", 0.0)
    values["first_azimuth"] = table.quantity("first_azimuth", "angle", 0.0)
    if kind == "tapered_roller":
        values["roller_axis_angle"] = table.quantity("roller_axis_angle", "angle")
        values["roller_half_angle"] = table.quantity("roller_half_angle", "angle")
    values["roller_profile"] = _profile(table.table("roller_profile"))
    raceways = table.table("raceway_profile")
    for ring in RINGS:
        values[f"{ring}_raceway_profile"] = _profile(raceways.table(ring))
    values["ribs"] = _ribs(table, kind)
    values["material"] = _material(table, "material") or Material()
    values["ring_material"] = _material(table, "ring_material")
    with table.building():
        return BEARINGS[kind](**values)


def _material(table: Table, key: str) -> Material | None:
    given = table.table_or_word(key, tuple(MATERIALS))
    if given is None:
        return None
    if isinstance(given, str):
        return MATERIALS[given]()
    steel = Material()
    values = (
        given.quantity("elastic_modulus", "pressure", steel.elastic_modulus),
        given.number("poisson_ratio", steel.poisson_ratio),
        given.quantity("density", "density", steel.density),
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
        table.quantity("end_radius", "length"),
        table.quantity("contact_height", "length"),
        table.quantity("axial_gap", "length", 0.0),
    )
    with table.building():
        return Rib(*values)


def _profile(table: Table) -> AbstractProfile:
    kind = table.choice("type", tuple(_PROFILE_READERS), "straight")
    with table.building():
        return _PROFILE_READERS[kind](table)


def _design_load(table: Table) -> dict[str, float]:
    values = {"design_load": table.quantity("design_load", "force")}
    modulus = table.quantity("contact_modulus", "pressure", None)
    return values if modulus is None else {**values, "contact_modulus": modulus}


_PROFILE_READERS = {
    "straight": lambda t: Straight(),
    "circular_crown": lambda t: CircularCrown(t.quantity("crown_radius", "length")),
    "crowned_ends": lambda t: CrownedEnds(
        t.quantity("straight_length", "length"),
        t.quantity("crown_radius", "length"),
        t.quantity("dub_off_length", "length", None),
        t.quantity("dub_off_radius", "length", None),
    ),
    "logarithmic": lambda t: Logarithmic(t.number("coefficient", 0.00035)),
    "lundberg": lambda t: Lundberg(**_design_load(t)),
    "johns_gohar": lambda t: JohnsGohar(
        **_design_load(t), half_width=t.quantity("half_width", "length")
    ),
    "fujiwara_kawase": lambda t: FujiwaraKawase(
        **_design_load(t),
        load_factor=t.number("load_factor"),
        crowned_fraction=t.number("crowned_fraction"),
        end_drop=t.quantity("end_drop", "length"),
    ),
    "tabulated": lambda t: Tabulated(
        t.quantities("positions", "length"), t.quantities("drops", "length")
    ),
}

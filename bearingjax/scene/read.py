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

from ..contact.coupled import CoupledSlices
from ..contact.line import ISO16281, AbstractLineLaw, LineConstant, Palmgren
from ..contact.point_law import (
    AbstractPointLaw,
    FreeAngle,
    OperatingAngle,
    PointConstant,
    ZeroAngle,
)
from ..design import is_ball, n_elements, rows_of
from ..element import (
    FREEDOMS,
    LOADS,
    RINGS,
    AbstractKinematics,
    AbstractRacewayControl,
    BearingElement,
    CentrifugalOnly,
    ConstantAngle,
    EqualShare,
    Finite,
    FrictionLimited,
    InnerControl,
    Linearised,
    LoadShare,
    OperatingCentrifugal,
    OuterControl,
    Speed,
)
from ..element.frame import LOAD_UNITS, MOTION_UNITS
from ..numerics import BFGS, ContactMapped, Midpoint, TrustRegionNewton
from ..numerics.quadrature import AbstractQuadrature
from ..numerics.units import unit_of
from ..statics.sweep import CHUNK
from .bearing_table import read_bearing
from .quantity import SceneError
from .table import Table

LINE_LAWS = {
    "palmgren": Palmgren,
    "iso16281": ISO16281,
    "coupled_slices": CoupledSlices,
}
QUADRATURES = {"contact_mapped": ContactMapped, "midpoint": Midpoint}
KINEMATICS = {
    "linearised": Linearised,
    "constant_angle": ConstantAngle,
    "finite": Finite,
}
POINT_LAWS = {
    "free_angle": FreeAngle,
    "zero_angle": ZeroAngle,
    "operating_angle": OperatingAngle,
}
CONTROLS = {
    "outer": OuterControl,
    "inner": InnerControl,
    "equal_share": EqualShare,
    "load_share": LoadShare,
    "friction_limited": FrictionLimited,
    "centrifugal_only": CentrifugalOnly,
    "operating_centrifugal": OperatingCentrifugal,
}
MOST_SLICES = 10_000
"""Most slices of a roller."""

MOST_POINTS = 10_000
"""Most positions along a roller: line load and pressure on two raceways, 0.8 MB each
roller as JSON."""

EQUILIBRIA = {"newton": TrustRegionNewton, "bfgs": BFGS}


@dataclasses.dataclass(frozen=True)
class Scene:
    """What a scene file asks for, in SI.

    Attributes:
        name: Name of the file without its ending.
        element: The bearing with its law and numerics, before it is preloaded.
        preload_force: Force to which its rows are ground [N], or `None`.
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
    element: BearingElement[Any]
    preload_force: float | None
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


def load_bearing(source: str | Path) -> Any:
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
    path = find_scene(source)
    return scene_of(parse_bearing(path, settings), path)


def scene_of(data: dict[str, Any], path: Path) -> Scene:
    """The scene in parsed data.

    Args:
        data: From `parse_scene`.
        path: Where from, for messages.

    Raises:
        SceneError: As `read_scene`.
    """
    top = Table(data, path.name)
    # What other commands ask for.
    top.skip("cases", "optimise")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        bearing, preload = read_bearing(top)
    scene = _scene(
        top, path.stem, bearing, preload, tuple(str(w.message) for w in caught)
    )
    top.finish()
    return scene


def find_scene(source: str | Path) -> Path:
    """Path of a scene file or of a shipped scene.

    Raises:
        SceneError: If there is none, or float64 is off.
    """
    if not jax.config.jax_enable_x64:  # type: ignore[attr-defined]
        raise SceneError(
            "scenes are solved in float64, which is off: call"
            ' jax.config.update("jax_enable_x64", True) before anything else'
        )
    path = Path(source)
    if path.suffix != ".toml" and not path.is_file():
        shipped = shipped_scenes()
        if str(source) in shipped:
            return shipped[str(source)]
        raise SceneError(
            f"{source}: neither a .toml file nor a shipped scene ({', '.join(shipped)})"
        )
    if not path.is_file():
        problem = "is a folder; name a file" if path.is_dir() else "no such file"
        raise SceneError(f"{source}: {problem}")
    return path


def is_contact(data: dict[str, Any]) -> bool:
    """Whether parsed data are of one contact, not of a bearing."""
    return "bearing" not in data and not {"roller", "raceway"}.isdisjoint(data)


def parse_bearing(path: Path, settings: Iterable[str]) -> dict[str, Any]:
    """As `parse_scene`, of a bearing.

    Raises:
        SceneError: As `parse_scene`; if it is the scene of one contact.
    """
    data = parse_scene(path, settings)
    if is_contact(data):
        problem = "is the scene of one contact, a [roller] on a [raceway], not of a"
        cure = f"`bearingjax contact {path.stem}` solves it"
        raise SceneError(f"{path.name}: {problem} [bearing]; {cure}")
    return data


def parse_scene(path: Path, settings: Iterable[str]) -> dict[str, Any]:
    """A scene file as parsed, with its settings changed.

    Args:
        path: Of the file.
        settings: As in `read_scene`.

    Raises:
        SceneError: If it is no TOML, or a setting does not fit.
    """
    data = _parse(path)
    for setting in settings:
        _set(data, setting, path.name)
    return data


def _parse(path):
    try:
        # Editors of Windows put a mark before the text.
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        problem = f"cannot be read: {error.strerror or error}"
        raise SceneError(f"{path.name}: {problem}") from error
    except UnicodeDecodeError as error:
        problem = f"cannot be read as TOML: {error}; save it as UTF-8"
        raise SceneError(f"{path.name}: {problem}") from error
    except (ValueError, RecursionError) as error:
        # TOML syntax, and numbers too long to convert, are ValueErrors.
        raise SceneError(f"{path.name}: cannot be read as TOML: {error}") from error


def _set(data: dict, setting: str, file: str) -> None:
    key, equals, text = setting.partition("=")
    parts = [part.strip() for part in key.split(".")]
    if not equals or not all(re.fullmatch(r"[A-Za-z0-9_-]+", p) for p in parts):
        raise SceneError(
            f"{file}: {setting!r} is not a setting; write key=value, such as"
            ' "operating.load.Fy=-4 kN"'
        )
    try:
        parsed = tomllib.loads(f"value = {text}")
    except ValueError:
        parsed = {}
    # Lines that follow would be lost: it is text then.
    value = parsed["value"] if len(parsed) == 1 else text.strip()
    assign(data, ".".join(parts), value, file)


def assign(data: dict[str, Any], key: str, value: Any, file: str) -> None:
    """Set a dotted key in parsed data.

    Args:
        data: Changed in place.
        key: Dotted key.
        value: As parsed.
        file: For the message.

    Raises:
        SceneError: If the key leads through what is no table.
    """
    parts = key.split(".")
    for depth, part in enumerate(parts[:-1]):
        data = data.setdefault(part, {})
        if not isinstance(data, dict):
            inner = ".".join(parts[: depth + 1])
            raise SceneError(f"{file}: `{inner}` is not a table, so {key!r} fails")
    data[parts[-1]] = value


def _scene(top, name, bearing, preload, odd) -> Scene:
    contact = top.table("contact")
    operating, numerics = top.table("operating"), top.table("numerics")
    if is_ball(bearing):
        choices: dict[str, Any] = {
            "point_law": _point_law(contact),
            "raceway_control": _control(operating),
        }
        if "kinematics" in numerics:
            choices["kinematics"] = _kinematics(numerics)
    else:
        law = read_line_law(contact)
        n_rollers = sum(n_elements(row.bearing) for row in rows_of(bearing))
        choices = {"line_law": law, "kinematics": _kinematics(numerics)}
        if not isinstance(law, CoupledSlices):
            choices["quadrature"] = _quadrature(numerics, n_rollers)
    solver = numerics.choice("equilibrium", tuple(EQUILIBRIA), "newton")
    with numerics.building():
        element = BearingElement(bearing, equilibrium=EQUILIBRIA[solver](), **choices)
    tolerance = numerics.number("tolerance", None)
    if tolerance is not None and not 1e-14 <= tolerance < 1e-2:
        problem = f"{tolerance:g} is not allowed; from 1e-14 to below 0.01"
        raise numerics.error("tolerance", problem)
    free = operating.words("free", FREEDOMS[:5])
    prescribed = _components(operating, "prescribed", FREEDOMS, MOTION_UNITS)
    both = sorted(set(free or ()) & set(prescribed))
    if both:
        problem = f"{', '.join(both)} is both free and prescribed; choose one"
        raise operating.error("free", problem)
    load = _components(operating, "load", LOADS, LOAD_UNITS)
    for freedom, component in zip(FREEDOMS, LOADS, strict=True):
        left_out = free is not None and freedom not in (*free, "gz")
        if load.get(component) and (left_out or freedom in prescribed):
            why = "prescribed" if freedom in prescribed else "not among `free`"
            problem = (
                f"{component} acts on {freedom}, which is {why}: its support would take"
                " that load; choose one"
            )
            raise operating.error("load", problem)
    speeds = {r: operating.real(f"{r}_speed", unit_of(Speed, r), 0.0) for r in RINGS}
    held = is_ball(bearing) and isinstance(element.kinematics, ConstantAngle)
    if held and any(speeds.values()):
        problem = "constant_angle is for balls at rest; leave out the speeds"
        raise numerics.error("kinematics", problem)
    return Scene(
        name=name,
        element=element,
        preload_force=preload,
        load=tuple(load.get(component, 0.0) for component in LOADS),
        prescribed=prescribed,
        free=free,
        fixed_ring=operating.choice("fixed_ring", RINGS, "outer"),
        speed=Speed(**speeds) if any(speeds.values()) else None,
        tolerance=tolerance,
        points=_points(top.table("output"), bearing),
        warnings=odd,
    )


def _components(operating, key, names, units) -> dict[str, float]:
    """Table of six components, each with its unit."""
    given = operating.raw(key, {})
    if not isinstance(given, dict):
        example = {"load": 'Fy = "-4 kN"', "prescribed": 'uz = "10 um"'}[key]
        problem = f"{given!r} is not a table; name the components, {{ {example} }}"
        raise operating.error(key, problem)
    table = operating.table(key)
    values = {}
    for name, unit in zip(names, units, strict=True):
        value = table.real(name, unit, None)
        if value is not None:
            values[name] = value
    return values


def read_line_law(contact: Table) -> AbstractLineLaw:
    """Line law of a `[contact]` table."""
    law = contact.choice("line_law", tuple(LINE_LAWS), "palmgren")
    if law == "coupled_slices":
        with contact.building():
            return CoupledSlices(contact.integer("slices", CoupledSlices().slices))
    constant = contact.real("line_constant", unit_of(LineConstant, "value"), None)
    if constant is None:
        return LINE_LAWS[law]()
    with contact.building():
        return LineConstant(constant)


def _quadrature(numerics: Table, n_rollers: int) -> AbstractQuadrature:
    rule = numerics.choice("quadrature", tuple(QUADRATURES), "contact_mapped")
    points = numerics.integer("points", None)
    if rule == "midpoint" and points is not None and points > MOST_SLICES:
        size = 8e-9 * CHUNK * 2 * n_rollers * points
        problem = (
            f"{points} is too many slices: {size:.3g} GB in each array of a sweep, of"
            f" {CHUNK} cases at a time; at most {MOST_SLICES}"
        )
        raise numerics.error("points", problem)
    with numerics.building():
        return QUADRATURES[rule]() if points is None else QUADRATURES[rule](points)


def _kinematics(numerics: Table) -> AbstractKinematics:
    return KINEMATICS[numerics.choice("kinematics", tuple(KINEMATICS), "linearised")]()


def _point_law(contact: Table) -> AbstractPointLaw:
    law = contact.choice("point_law", tuple(POINT_LAWS), "free_angle")
    outer, inner = (
        contact.real(f"{ring}_constant", unit_of(PointConstant, ring), None)
        for ring in RINGS
    )
    if outer is None and inner is None:
        return POINT_LAWS[law]()
    for name, value in (("outer_constant", outer), ("inner_constant", inner)):
        if value is None:
            raise contact.error(name, "is missing; give the constants of both rings")
    with contact.building():
        return PointConstant(outer, inner)


def _control(operating: Table) -> AbstractRacewayControl:
    name = operating.choice("raceway_control", tuple(CONTROLS), "outer")
    friction = "friction_coefficient"
    if name != "friction_limited":
        if friction in operating:
            problem = 'goes with `raceway_control` = "friction_limited" only'
            raise operating.error(friction, problem)
        return CONTROLS[name]()
    with operating.building():
        unit = unit_of(FrictionLimited, "friction")
        return FrictionLimited(operating.real(friction, unit))


def _points(output: Table, bearing) -> int:
    """Positions along a roller; balls have none."""
    if is_ball(bearing):
        return 2
    points = output.integer("points", 101, least=2)
    if points > MOST_POINTS:
        rollers = sum(n_elements(row.bearing) for row in rows_of(bearing))
        size = 4 * 20e-6 * rollers * points
        problem = (
            f"{points} is too many, {size:.3g} MB of JSON for {rollers} rollers; at"
            f" most {MOST_POINTS}, which is closer than a roller's surface is known"
        )
        raise output.error("points", problem)
    return points

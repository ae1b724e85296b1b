"""Scenes: a bearing, its load and speeds, and the numerics of its solve."""

import dataclasses
import functools
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ...catalogue.entry import CatalogueEntry, bearing_of_entry, catalogue_entry
from ...design import AbstractBearing, BearingSet, rows_of
from ...element import RINGS, BearingElement, ConstantAngle, Speed
from ...files import SceneError, shipped_scenes
from ...files.scene_file import find_scene, is_scene, parse_bearing
from ...files.schema import read_keys
from ...files.table import Table
from ...fits import FitStates
from ...life import LifeConditions, given_rating_warnings
from ...numerics import TrustRegionNewton, Warning
from ...numerics.compiled.programs import program
from ...statics import Installed, SetPreload, SolveOptions, Support
from ...statics.options import DEFAULT_TOLERANCE
from .catalogue_keys import FromCatalogue
from .leftover_keys import leftover_warnings
from .oil import Oil, read_oil
from .read_bearing import read_bearing, read_designation
from .read_choices import KINEMATICS, read_choices
from .read_fit import FitNotes, read_fits
from .read_life import lubrication_warnings, read_life
from .read_operating import (
    MOST_POINTS,
    OperatingKeys,
    OutputKeys,
    SolveKeys,
    relative_speed,
)


@dataclasses.dataclass(frozen=True)
class Scene:
    """Contents of a scene file, in SI.

    Attributes:
        name: Name of the file without its ending.
        installed: The bearing with its law and numerics, its preload, seats and
            temperatures.
        fits: What is said of its seats, or `None`: solved with the drawing dimensions.
        oil: Its lubricant, or `None`: no friction or films are reported.
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring [N, N m].
        prescribed: Displacements given by freedom name [m, rad].
        free: Free freedoms, or `None` for all that the bearing restrains.
        fixed_ring: "outer" or "inner".
        speed: Ring speeds, or `None` if both rings are at rest.
        tolerance: Relative residual of the load solve, or `None` for the default.
        points: Positions along the rollers at which loads are reported.
        life: Conditions of its rating life, or `None`: not requested.
        warnings: Warnings of suspicious but possible values.
        catalogue: Catalogue entry of its `designation`, or `None` without one.
        inputs: The scene as it was read, all quantities in SI, defaults filled in, in
            the form of a scene file.
        preload_of_set: Preload of a set on its seats, or `None`: not computed
            (`with_set_preload`).
    """

    name: str
    installed: Installed
    fits: FitNotes | None
    oil: Oil | None
    load: tuple[float, ...]
    prescribed: dict[str, float]
    free: tuple[str, ...] | None
    fixed_ring: str
    speed: Speed | None
    tolerance: float | None
    points: int
    life: LifeConditions | None
    warnings: tuple[Warning, ...]
    catalogue: FromCatalogue | None = None
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)
    preload_of_set: SetPreload | None = None

    @property
    def entry(self) -> CatalogueEntry | None:
        """Catalogue entry of its `designation`, or `None` without one."""
        return None if self.catalogue is None else self.catalogue.entry

    @property
    def moving_ring(self) -> str:
        """Name of the loaded ring."""
        return RINGS[1 - RINGS.index(self.fixed_ring)]

    @property
    def support(self) -> Support:
        """What holds the rings."""
        return Support(self.free, self.prescribed, self.fixed_ring)

    @property
    def solve_options(self) -> SolveOptions:
        """Numerics of the load solves."""
        return SolveOptions(self.points, self.tolerance)

    @property
    def element(self) -> BearingElement[Any]:
        """The bearing with its law and numerics, before preloading and mounting."""
        return self.installed.drawing

    @property
    def preload_force(self) -> float | None:
        """Preload force to which its rows are ground [N], or `None`."""
        force = self.installed.preload
        return None if force is None else float(force)

    @functools.cached_property
    def fit_states(self) -> FitStates | None:
        """Clearance and seats, drawing to operation; `None` without fits."""
        return self.installed.fit_states()

    def grind_rows(self) -> Installed:
        """Return the installed bearing with its rows ground to their preload.

        Fails: offsets are NaN where the preload was not reached.
        """
        if self.installed.preload is None:
            return self.installed
        return _grind_rows(self.installed)

    def running(self) -> BearingElement[Any]:
        """Return the element that all commands solve: ground, mounted, in operation."""
        return self.grind_rows().element_at()


@program(quick=True, what="rows ground to their preload")
def _grind_rows(bearing: Installed) -> Installed:
    return bearing.grind_rows(throw=False)


def load_bearing(source: str | Path) -> Any:
    """Load a bearing by its designation, or that of a scene file, as drawn.

    Args:
        source: A designation such as "6205" or "NJ 206 ECP/C3" (see
            `catalogue_entry`), the path of a `.toml` scene, or the name of a shipped
            one.

    Returns:
        The bearing, or the set of both rows of one whose rows share rings. One of the
        catalogue carries its published ratings and axial factors.

    Raises:
        SceneError: If the scene cannot be read, or nothing has this name.
        TypeError: If `source` is neither a string nor a path.
    """
    if not isinstance(source, str | Path):
        problem = 'it must be a text such as "6205", or a path'
        raise TypeError(f"load_bearing: `source` is {source!r}; {problem}.")
    if is_scene(source):
        return read_scene(source).element.bearing
    try:
        return bearing_of_entry(catalogue_entry(str(source)))
    except ValueError as error:
        scenes = ", ".join(shipped_scenes())
        problem = f"{error}; nor is it a .toml file or a shipped scene ({scenes})"
        raise SceneError(problem) from error


def read_scene(source: str | Path, settings: Iterable[str] = ()) -> Scene:
    """Read a scene file.

    Args:
        source: Path of a `.toml` file, or the name of a shipped scene.
        settings: Changes "dotted.key=value" to the scene; the value is
            TOML, or text without quotes ("operating.load.Fz=-6 kN").

    Returns:
        The scene, validated.

    Raises:
        SceneError: One line with file, line, key, fault and the allowed values.
    """
    path = find_scene(source)
    return with_speed_warnings(scene_of(parse_bearing(path, settings), path))


def with_speed_warnings(scene: Scene, turns: Any = None) -> Scene:
    """Add warnings of speeds above those of the catalogue to a scene.

    Args:
        scene: From `scene_of`.
        turns: Relative speed of the rings, of one or many cases [rad/s]; `None`: that
            of the scene.
    """
    turns = relative_speed(scene.speed) if turns is None else turns
    texts = scene.installed.speed_warnings(turns)
    every = dict.fromkeys((*scene.warnings, *texts))
    return dataclasses.replace(scene, warnings=tuple(every))


def scene_of(
    data: dict[str, Any],
    path: Path,
    varied: Iterable[str] = (),
    other_keys: Iterable[str] = (),
    places: Mapping[str, str] | None = None,
) -> Scene:
    """Build the scene of parsed data.

    Args:
        data: From `parse_scene`.
        path: Path of the file, for messages.
        varied: Keys varied by its cases: these count as given, even where equal to
            the catalogue.
        other_keys: Keys of the table of the bearing that are read elsewhere.
        places: As in `Table`, of a bearing that is part of a machine.

    Raises: as `read_scene`.
    """
    top = Table(data, path, places=places)
    # Tables of other commands.
    top.skip("cases", "optimise", "identify", "tolerances", "cage", "dynamics")
    top.skip("deviations", "vibration")
    table = top.table("bearing", required=True)
    table.know(*other_keys)
    found = read_designation(table)
    if found is not None:
        found = found[0], found[1].override(varied)
    bearing, preload = read_bearing(table, top, found)
    catalogue = None if found is None else found[1]
    warned = bearing.warnings
    if found is not None:
        warned += leftover_warnings(*found, varied)
    rows = data.get("set", {}).get("rows", ())
    if rows and all("bearing" in row for row in rows):
        words = (
            "set: every row has a `bearing` of its own, so that [bearing] is none of"
            " them, and nothing that the catalogue says of it counts; write that of a"
            " row there, and leave it out of the row"
        )
        warned = (*warned, Warning("unused_bearing", words))
        own, *others = (row["bearing"] for row in rows)
        alike = all(other == own for other in others)
        found = read_designation(Table(own, path)) if alike else None
        catalogue = None if found is None else found[1]
    scene = _scene(top, path.stem, bearing, preload, catalogue, warned)
    top.finish()
    warned = scene.warnings
    # Bearings of machines, sweeps and measurements may get their speeds elsewhere.
    alone = places is None and not {"cases", "identify"} & data.keys()
    if alone and scene.speed is None:
        warned += control_warnings(data)
    return dataclasses.replace(scene, inputs=top.echo(), warnings=warned)


def control_warnings(data: Mapping[str, Any]) -> tuple[Warning, ...]:
    """Return a warning if a scene at rest has a raceway control, which does nothing."""
    if "raceway_control" not in data.get("operating", {}):
        return ()
    words = "operating.raceway_control: balls at rest have no gyroscopic moment;"
    return (Warning("unused_control", f"{words} it acts at a speed alone"),)


def check_equilibrium(
    numerics: Table, element: BearingElement[Any], speed: Speed | None
) -> None:
    """Raise SceneError if forces at a speed have no energy that the method minimises.

    Args:
        numerics: [numerics] of the scene.
        element: Its bearing.
        speed: Ring speeds, or `None` at rest.
    """
    newton = isinstance(element.equilibrium, TrustRegionNewton)
    if not newton and not element.has_potential(speed):
        problem = "minimises an energy, and gyroscopic moments and contact constants at"
        problem += " the operating angle have none; leave it out, or write newton"
        raise numerics.error("equilibrium", problem)


def read_element(
    bearing: AbstractBearing | BearingSet,
    contact: Table,
    operating: Table,
    numerics: Table,
) -> BearingElement[Any]:
    """Return a bearing with the laws and numerics chosen by a scene.

    Args:
        bearing: The design.
        contact, operating, numerics: As in `read_choices`.
    """
    choices = read_choices(contact, operating, numerics, bearing)
    with numerics.building():
        element = BearingElement(bearing, **choices)
    for name, kind in KINEMATICS.items():
        if type(element.kinematics) is kind:
            numerics.fill("kinematics", name)
    return element


def _scene(top, name, bearing, preload, catalogue, warned) -> Scene:
    numerics, asked = top.table("numerics"), read_keys(SolveKeys, top.table("numerics"))
    operating = read_keys(OperatingKeys, top.table("operating"))
    speed = operating.speed
    oil = None
    if "lubricant" in top:
        oil, assumed = read_oil(top.table("lubricant"))
        warned += assumed
    own = top.table("bearing")
    bearing, seats, fits = read_fits(top, own, bearing, speed, catalogue)
    element = read_element(bearing, top.table("contact"), operating.table, numerics)
    numerics.fill("tolerance", asked.tolerance or DEFAULT_TOLERANCE["float64"])
    points = 2 if bearing.is_ball else _points(top.table("output"), bearing)
    held = bearing.is_ball and isinstance(element.kinematics, ConstantAngle)
    if held and speed is not None:
        problem = "constant_angle is for balls at rest; leave out the speeds"
        raise numerics.error("kinematics", problem)
    check_equilibrium(numerics, element, speed)
    operating.fill_free(bearing)
    life = read_life(top, bearing, speed, points)
    speeds = "limiting_speed", "reference_speed"
    if catalogue is not None:
        seats |= {name: getattr(catalogue.entry, name) for name in speeds}
        if fits is not None:
            warned += tuple(catalogue.entry.seat_warnings(seats["mounting"]))
    installed = Installed(element, preload, **seats)
    fixed_to = "space" if life is None else life.load_fixed_to
    warned += tuple(installed.seat_warnings(fixed_to))
    warned += lubrication_warnings(top, oil)
    if life is not None:
        warned += tuple(given_rating_warnings(bearing, vars(life)))
    return Scene(
        name=name,
        installed=installed,
        fits=fits,
        oil=oil,
        load=operating.loads,
        prescribed=operating.prescribed_values,
        free=operating.free,
        fixed_ring=operating.fixed_ring,
        speed=speed,
        tolerance=asked.tolerance,
        points=points,
        life=life,
        warnings=warned,
        catalogue=catalogue,
    )


def _points(output: Table, bearing) -> int:
    """Read the number of positions along a roller."""
    points = read_keys(OutputKeys, output).points
    if points > MOST_POINTS:
        rollers = sum(row.bearing.n_elements for row in rows_of(bearing))
        size = 4 * 20e-6 * rollers * points
        problem = (
            f"{points} is too many, {size:.3g} MB of JSON for {rollers} rollers; at"
            f" most {MOST_POINTS}, which is closer than a roller's surface is known"
        )
        raise output.error("points", problem)
    return points

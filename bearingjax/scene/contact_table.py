"""Scenes of one roller on one raceway: [roller], [raceway] and how they are pressed."""

import dataclasses
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..contact.halfspace import FreeEnds, RollerContact
from ..contact.line import AbstractLineLaw
from ..design import Material
from .bearing_table import read_material, read_profile
from .choices_table import LineContactKeys
from .scene_file import find_scene, parse_scene
from .schema import read_keys
from .table import Table, written_numbers

LAWS = ("palmgren", "iso16281")
"""Line laws of slices that know nothing of their neighbours."""

SIDES = {"inner": 1.0, "outer": -1.0}
"""Sign of the curvature of a raceway."""

MOST_ACROSS, MOST_ALONG = 1001, 4001
MOST_NUMBERS = 5e7
"""Most numbers in the influence of cells graded or with free ends: 0.4 GB."""


@dataclasses.dataclass(frozen=True)
class ContactScene:
    """What a scene of one contact asks for, in SI.

    Attributes:
        name: Name of the file without its ending.
        contact: Roller and raceway.
        loads: Loads [N]; empty if the approach is given.
        approach: Approach at the middle of the roller [m], or `None`.
        moment: Moment of the pressure about the middle [N m], or `None`.
        tilt: Tilt [rad], or `None`.
        listed: Whether the scene lists its loads.
        law: Line law of the slices that the contact is compared with.
        across, along: Number of cells.
        grading: As of `graded_grid`.
        half_width: Half width of the grid [m]; `None`: found for each load.
        tolerance: Residual at which to stop, or `None` for the default.
        max_steps: Step limit.
        field: Whether the pressure of every cell is written.
        warnings: What the validation found odd but possible.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    name: str
    contact: RollerContact
    loads: tuple[float, ...]
    approach: float | None
    moment: float | None
    tilt: float | None
    listed: bool
    law: AbstractLineLaw
    across: int
    along: int
    grading: float
    half_width: float | None
    tolerance: float | None
    max_steps: int
    field: bool
    warnings: tuple[str, ...]
    inputs: dict[str, Any]

    @property
    def cases(self) -> list[dict[str, float]]:
        """What is given in each case, by the names of `RollerContact.solve`."""
        held = {"approach": self.approach, "moment": self.moment, "tilt": self.tilt}
        rest = {name: value for name, value in held.items() if value is not None}
        return [{"load": load, **rest} for load in self.loads] or [rest]


def is_bearing(source: str | Path, settings: Iterable[str] = ()) -> bool:
    """Whether a scene is one of a bearing, not of a single contact.

    Args:
        source, settings: As in `read_scene`.

    Raises:
        SceneError: If there is no such scene, or it cannot be read.
    """
    data = parse_scene(find_scene(source), settings)
    return "bearing" in data and {"roller", "raceway"}.isdisjoint(data)


def read_contact(source: str | Path, settings: Iterable[str] = ()) -> ContactScene:
    """Read a scene of one roller on one raceway.

    Args:
        source, settings: As in `read_scene`.

    Raises:
        SceneError: One line that names file, key, fault and what is allowed.
    """
    path = find_scene(source)
    data = parse_scene(path, settings)
    top = Table(data, path.name)
    if "bearing" in data:
        problem = "a contact is one [roller] on one [raceway], or a roller of a bearing"
        raise top.error("bearing", problem)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        contact = _contact(top)
    scene = _scene(top, path.stem, contact, tuple(str(w.message) for w in caught))
    top.finish()
    return dataclasses.replace(scene, inputs=top.echo())


def _contact(top: Table) -> RollerContact:
    roller, raceway = top.table("roller", required=True), top.table("raceway")
    length = _positive(roller, "length", "length")
    small, large = _diameters(roller)
    profile = read_profile(roller.table("profile"))
    material = read_material(roller, "material") or Material()
    radius, widening = _raceway(raceway, max(small, large))
    ring_profile = read_profile(raceway.table("profile"))
    ring_material = read_material(raceway, "material") or material
    for table, given in ((roller, material), (raceway, ring_material)):
        table.fill("material", written_numbers(given))
    with roller.building():
        return RollerContact(
            length,
            small,
            large,
            half_angle=roller.quantity("half_angle", "angle", None),
            raceway_radius=radius,
            raceway_half_angle=widening,
            roller_profile=profile,
            raceway_profile=ring_profile,
            material=material,
            raceway_material=ring_material,
            free_ends=FreeEnds() if roller.flag("free_ends", False) else None,
        )


def _diameters(roller: Table) -> tuple[float, float]:
    ends = ("small_diameter", "large_diameter")
    if not any(key in roller for key in ends):
        diameter = _positive(roller, "diameter", "length")
        return diameter, diameter
    if "diameter" in roller:
        problem = "give either this or `small_diameter` and `large_diameter`"
        raise roller.error("diameter", problem)
    small, large = (_positive(roller, key, "length") for key in ends)
    if large < small:
        problem = f"is below `small_diameter`, {1e3 * small:g} mm"
        raise roller.error("large_diameter", problem)
    return small, large


def _raceway(raceway: Table, roller_diameter: float) -> tuple[float, float]:
    """Radius normal to the generatrix in the middle, signed, and half cone angle."""
    if "diameter" not in raceway:
        for key in ("side", "half_angle"):
            if key in raceway:
                problem = "goes with `diameter`; without it the raceway is a plane"
                raise raceway.error(key, problem)
        return np.inf, 0.0
    diameter = _positive(raceway, "diameter", "length")
    side = raceway.choice("side", tuple(SIDES))
    angle = raceway.quantity("half_angle", "angle", 0.0)
    if not abs(angle) < 0.7:
        problem = f"{np.rad2deg(angle):.4g} deg is not allowed; below 40.1 in size"
        raise raceway.error("half_angle", problem)
    if side == "outer" and diameter <= roller_diameter:
        problem = (
            f"an outer raceway is wider than the roller, {1e3 * roller_diameter:g}"
        )
        raise raceway.error("diameter", f"{problem} mm")
    return SIDES[side] * 0.5 * diameter / np.cos(angle), angle


def _scene(top: Table, name, contact: RollerContact, odd) -> ContactScene:
    operating = top.table("operating", required=True)
    numerics, law = top.table("numerics"), top.table("contact")
    law.choice("line_law", LAWS, "palmgren")
    loads, listed = _loads(operating)
    grid = _grid(numerics, contact)
    if grid["grading"] > 1.0 or contact.free_ends is not None:
        count = max(len(loads), 1) * grid["across"] * grid["along"] ** 2
        if count > MOST_NUMBERS:
            problem = (
                f"{grid['along']} cells take too much memory, graded or with free ends;"
                " fewer graded ones do as well, or take `grading` = 1 without free ends"
            )
            raise numerics.error("along", problem)
    tolerance = numerics.number("tolerance", None)
    if tolerance is not None and not 1e-14 <= tolerance < 1e-2:
        problem = f"{tolerance:g} is not allowed; from 1e-14 to below 0.01"
        raise numerics.error("tolerance", problem)
    return ContactScene(
        name=name,
        contact=contact,
        loads=loads,
        listed=listed,
        **_motion(operating, loads),
        law=read_keys(LineContactKeys, law).law,
        **grid,
        tolerance=tolerance,
        max_steps=numerics.integer("max_steps", 500),
        field=top.table("output").flag("field", False),
        warnings=odd,
        inputs={},
    )


def _loads(operating: Table) -> tuple[tuple[float, ...], bool]:
    """Loads, and whether they are a list; none if the approach is given."""
    if "load" not in operating:
        if "approach" not in operating:
            problem = "is missing; give it, a list of loads, or `approach`"
            raise operating.error("load", problem)
        return (), False
    if "approach" in operating:
        raise operating.error("approach", "give either `load` or this, not both")
    listed = isinstance(operating.raw("load"), list)
    if listed:
        loads = operating.quantities("load", "force")
    else:
        loads = [operating.quantity("load", "force")]
    if not loads:
        raise operating.error("load", "is an empty list; give one load at least")
    for load in loads:
        if not load > 0:
            raise operating.error("load", f"{load:g} N must be above 0")
    return tuple(loads), listed


def _motion(operating: Table, loads) -> dict[str, float | None]:
    approach = None if loads else operating.quantity("approach", "length")
    moment = operating.quantity("moment", "moment", None)
    tilt = operating.quantity("tilt", "angle", None)
    if moment is not None and tilt is not None:
        raise operating.error("tilt", "give either `moment` or this, not both")
    if moment is not None and not loads:
        raise operating.error("moment", "goes with `load`; an approach has a `tilt`")
    if tilt is not None and not abs(tilt) < 0.1:
        problem = f"{tilt:g} rad is not allowed; below 0.1 rad in size"
        raise operating.error("tilt", problem)
    return {"approach": approach, "moment": moment, "tilt": tilt}


def _grid(numerics: Table, contact: RollerContact) -> dict:
    across = numerics.integer("across", 35, least=3)
    along = numerics.integer("along", 64, least=3)
    for key, value, most in (
        ("across", across, MOST_ACROSS),
        ("along", along, MOST_ALONG),
    ):
        if value > most:
            raise numerics.error(key, f"{value} is too many cells; at most {most}")
    grading = numerics.number("grading", 2.0)
    if not 1.0 <= grading <= 4.0:
        problem = f"{grading:g} is not allowed; from 1 (even cells) to 4"
        raise numerics.error("grading", problem)
    width = None
    if "half_width" in numerics:
        width = _positive(numerics, "half_width", "length")
        gap = contact.gap(contact.grid(width, across, 3, 1.0))
        if not np.isfinite(np.asarray(gap)).all():
            problem = f"{1e3 * width:g} mm is wider than the roller or its raceway"
            raise numerics.error("half_width", problem)
    return {"across": across, "along": along, "grading": grading, "half_width": width}


def _positive(table: Table, key: str, kind: str) -> float:
    value = table.quantity(key, kind)
    if not value > 0:
        raise table.error(key, f"{value:g} m must be above 0")
    return value

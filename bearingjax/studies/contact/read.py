"""Scenes of one roller on one raceway: [roller], [raceway] and their loading."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ...contact.halfspace import FreeEnds, RollerContact
from ...contact.line import AbstractLineLaw
from ...design import AbstractProfile, Material
from ...files.scene_file import find_scene, parse_scene
from ...files.schema import Keys, key_of, read_keys, scene_key
from ...files.table import Table, written_numbers
from ...numerics.warning import Warning
from ..bearing.read_choices import LineContactKeys
from ..bearing.read_design import read_material, read_profile

SLICE_LAWS = ("palmgren", "iso16281")
"""Line laws of independent slices."""

SIDES = {"inner": 1.0, "outer": -1.0}
"""Sign of the curvature of a raceway."""

MOST_NUMBERS = 5e7
"""Most influence coefficients of a graded grid or one with free ends: 0.4 GB."""


def _profile(table: Table, name: str) -> AbstractProfile:
    return read_profile(table.table(name))


_EITHER = "give either this or `small_diameter` and `large_diameter`"
_PROFILE = {"$ref": "#/$defs/profile"}
_MATERIAL = {"$ref": "#/$defs/material"}


class RollerKeys(Keys):
    about = "[roller]: a cylindrical or tapered roller"

    length: float = key_of(
        RollerContact, "roller_length", above=0, refusal="must be above 0"
    )
    diameter: float | None = scene_key(
        "diameter of a cylindrical roller",
        "length",
        above=0,
        without={"small_diameter": _EITHER},
    )
    small_diameter: float | None = key_of(
        RollerContact, "small_diameter", above=0, needs=("large_diameter",)
    )
    large_diameter: float | None = key_of(
        RollerContact, "large_diameter", above=0, needs=("small_diameter",)
    )
    half_angle: float | None = key_of(
        RollerContact, "half_angle", otherwise="that of its diameters"
    )
    profile: AbstractProfile = scene_key(
        "shape along it", default="straight", reader=_profile, json=_PROFILE
    )
    material: Material | None = scene_key(
        "material", otherwise="steel", reader=read_material, json=_MATERIAL
    )
    free_ends: bool = scene_key("whether its end faces bear no stress", default=False)

    @property
    def ends(self) -> tuple[float, float]:
        """Small and large end diameter [m]."""
        small, large = self.small_diameter, self.large_diameter
        both = self.diameter or 0.0  # checked when it was read
        return small or both, large or both

    def check(self) -> None:
        if self.diameter is None and self.small_diameter is None:
            self.table.quantity("diameter", "length")  # raises that it is missing
        small, large = self.ends
        if large < small:
            problem = f"is below `small_diameter`, {1e3 * small:g} mm"
            raise self.table.error("large_diameter", problem)


class RacewayKeys(Keys):
    about = "[raceway]: a plane, a cylinder or a cone"

    diameter: float | None = scene_key(
        "diameter in the middle", "length", above=0, otherwise="a plane"
    )
    side: str | None = scene_key(
        "ring that has it",
        choices=tuple(SIDES),
        needs=("diameter",),
        hint="without it the raceway is a plane",
    )
    half_angle: float = scene_key(
        "half cone angle",
        "angle",
        default=0.0,
        above=-40.1,
        below=40.1,
        shown="deg",
        refusal="is not allowed; below 40.1 in size",
        needs=("diameter",),
        hint="without it the raceway is a plane",
    )
    profile: AbstractProfile = key_of(RollerKeys, "profile")
    material: Material | None = key_of(
        RollerKeys, "material", otherwise="that of the roller"
    )

    @property
    def radius(self) -> float:
        """Signed radius normal to the generatrix at mid-length [m]."""
        if self.diameter is None or self.side is None:
            return np.inf
        return SIDES[self.side] * 0.5 * self.diameter / np.cos(self.half_angle)

    def check(self) -> None:
        if self.diameter is not None and self.side is None:
            self.table.choice("side", tuple(SIDES))  # raises that it is missing


class ContactOperatingKeys(Keys):
    about = "[operating] of one contact: how roller and raceway are pressed"

    load: float | tuple[float, ...] | None = scene_key(
        "load, or a list of loads", "force", above=0, refusal="must be above 0"
    )
    approach: float | None = scene_key(
        "approach in the middle", "length", without={"load": ""}
    )
    moment: float | None = scene_key(
        "moment of the pressure about the middle",
        "moment",
        needs=("load",),
        hint="an approach has a `tilt`",
    )
    tilt: float | None = scene_key(
        "tilt; above zero it closes the gap at positive positions",
        "angle",
        above=-0.1,
        below=0.1,
        refusal="is not allowed; below 5.73 deg in size",
        without={"moment": ""},
    )

    @property
    def listed(self) -> bool:
        """Whether it lists its loads."""
        return isinstance(self.load, tuple)

    @property
    def loads(self) -> tuple[float, ...]:
        """All loads [N]; empty if the approach is given."""
        if self.load is None:
            return ()
        return self.load if isinstance(self.load, tuple) else (self.load,)

    def check(self) -> None:
        if self.load is None and self.approach is None:
            problem = "is missing; give it, a list of loads, or `approach`"
            raise self.table.error("load", problem)
        if self.load == ():
            raise self.table.error("load", "is an empty list; give one load at least")


class ContactNumericsKeys(Keys):
    about = "[numerics] of one contact: the cells of its grid, and when to stop"

    across: int = scene_key(
        "cells across the contact",
        default=35,
        least=3,
        most=1001,
        refusal="is too many cells; at most 1001",
    )
    along: int = scene_key(
        "cells along the roller",
        default=64,
        least=3,
        most=4001,
        refusal="is too many cells; at most 4001",
    )
    grading: float = scene_key(
        "exponent by which cells are shorter towards the ends; 1: even",
        default=2.0,
        least=1,
        most=4,
        refusal="is not allowed; from 1 (even cells) to 4",
    )
    half_width: float | None = scene_key(
        "half width of the grid", "length", above=0, otherwise="found for each load"
    )
    tolerance: float | None = scene_key(
        "relative residual at which it ends",
        least=1e-14,
        below=0.01,
        otherwise="that of the solver",
    )
    max_steps: int = scene_key("most steps of the solver", default=500)


class SliceLawKeys(Keys):
    about = "[contact]: the slices that a contact is compared with"

    line_law: str = key_of(LineContactKeys, "line_law", choices=SLICE_LAWS)
    line_constant: float | None = key_of(LineContactKeys, "line_constant", only={})

    @property
    def law(self) -> AbstractLineLaw:
        """Line law of the slices."""
        return read_keys(LineContactKeys, self.table).law


class ContactOutputKeys(Keys):
    about = "[output] of one contact"

    field: bool = scene_key("whether every cell's pressure is written", default=False)


@dataclasses.dataclass(frozen=True)
class ContactScene:
    """Scene of one contact, in SI.

    Attributes:
        name: Name of the file without its ending.
        contact: Roller and raceway.
        law: Line law of the slices that the contact is compared with.
        operating: How roller and raceway are pressed.
        numerics: Cells of the grid, and when to stop.
        field: Whether to output the pressure of every cell.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    name: str
    contact: RollerContact
    law: AbstractLineLaw
    operating: ContactOperatingKeys
    numerics: ContactNumericsKeys
    warnings: tuple[Warning, ...]
    field: bool = False
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def cases(self) -> list[dict[str, float]]:
        """Keyword arguments of `RollerContact.solve` for each case."""
        rest = {k: v for k, v in self.operating.given.items() if k != "load"}
        return [{"load": load, **rest} for load in self.operating.loads] or [rest]


def is_bearing(source: str | Path, settings: Iterable[str] = ()) -> bool:
    """Whether a scene describes a bearing, not a single contact.

    Args: as `read_scene`.

    Raises:
        SceneError: If there is no such scene, or it cannot be read.
    """
    data = parse_scene(find_scene(source), settings)
    return "bearing" in data and {"roller", "raceway"}.isdisjoint(data)


def read_contact(source: str | Path, settings: Iterable[str] = ()) -> ContactScene:
    """Read a scene of one roller on one raceway.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    data = parse_scene(path, settings)
    top = Table(data, path)
    if "bearing" in data:
        problem = "a contact is one [roller] on one [raceway], or a roller of a bearing"
        raise top.error("bearing", problem)
    roller = read_keys(RollerKeys, top.table("roller", required=True))
    raceway = read_keys(RacewayKeys, top.table("raceway"))
    scene = _scene(top, path.stem, _contact(roller, raceway))
    top.finish()
    return dataclasses.replace(scene, inputs=top.echo())


def _contact(roller: RollerKeys, raceway: RacewayKeys) -> RollerContact:
    small, large = roller.ends
    if raceway.side == "outer" and (raceway.diameter or 0.0) <= large:
        problem = f"an outer raceway is wider than the roller, {1e3 * large:g} mm"
        raise raceway.table.error("diameter", problem)
    material = roller.material or Material()
    ring_material = raceway.material or material
    for table, given in ((roller.table, material), (raceway.table, ring_material)):
        table.fill("material", written_numbers(given))
    with roller.table.building():
        return RollerContact(
            roller.length,
            small,
            large,
            half_angle=roller.half_angle,
            raceway_radius=raceway.radius,
            raceway_half_angle=raceway.half_angle,
            roller_profile=roller.profile,
            raceway_profile=raceway.profile,
            material=material,
            raceway_material=ring_material,
            free_ends=FreeEnds() if roller.free_ends else None,
        )


def _scene(top: Table, name, contact: RollerContact) -> ContactScene:
    operating = read_keys(ContactOperatingKeys, top.table("operating", required=True))
    numerics = read_keys(ContactNumericsKeys, top.table("numerics"))
    _check_grid(numerics, contact, len(operating.loads))
    return ContactScene(
        name=name,
        contact=contact,
        operating=operating,
        numerics=numerics,
        law=read_keys(SliceLawKeys, top.table("contact")).law,
        field=read_keys(ContactOutputKeys, top.table("output")).field,
        warnings=contact.warnings,
    )


def _check_grid(keys: ContactNumericsKeys, contact: RollerContact, loads: int) -> None:
    """Raise SceneError for a grid too large for the memory or for the bodies."""
    if keys.grading > 1.0 or contact.free_ends is not None:
        if max(loads, 1) * keys.across * keys.along**2 > MOST_NUMBERS:
            problem = (
                f"{keys.along} cells take too much memory, graded or with free ends;"
                " fewer graded ones do as well, or take `grading` = 1 without free ends"
            )
            raise keys.table.error("along", problem)
    if keys.half_width is not None:
        gap = contact.gap(contact.grid(keys.half_width, keys.across, 3, 1.0))
        if not np.isfinite(np.asarray(gap)).all():
            width = f"{1e3 * keys.half_width:g} mm"
            problem = f"{width} is wider than the roller or its raceway"
            raise keys.table.error("half_width", problem)

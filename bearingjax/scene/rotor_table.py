"""Reading the scene of a rotor: shaft, discs, loads; bearings and tasks beside it."""

import dataclasses
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..design import Material
from ..element.frame import LOAD_UNITS, LOADS
from ..numerics.gravity import GRAVITY
from ..rotor import (
    AbstractDamping,
    AbstractPart,
    Disc,
    ModalDamping,
    PointMass,
    ProportionalDamping,
    RotorLoads,
    Shaft,
    StationForce,
    Unbalance,
)
from .bearing_table import read_material
from .quantity import kind_of
from .rotor_mounts import read_mounts
from .rotor_scene import RotorScene
from .rotor_tasks import read_campbell, read_response, read_transient
from .scene_file import find_scene, is_rotor, parse_scene
from .stations import read_station
from .table import Table, written_numbers

AXES = {
    "horizontal": (0.0, -GRAVITY, 0.0),
    "vertical": (0.0, 0.0, -GRAVITY),
    "none": (0.0, 0.0, 0.0),
}
"""Where gravity pulls [m/s²]."""
MOST_ELEMENTS = 200
"""Most elements of a shaft: eigenvalues of 2000 states take minutes."""


def read_rotor(source: str | Path, settings: Iterable[str] = ()) -> RotorScene:
    """Read the scene of a rotor.

    Args:
        source, settings: As in `read_scene`.

    Raises:
        SceneError: One line that names file, key, fault and what is allowed.
    """
    path = find_scene(source)
    data = parse_scene(path, settings)
    top = Table(data, path.name)
    if not is_rotor(data):
        key = "bearing" if "bearing" in data else "rotor"
        problem = "the scene of a rotor has a [rotor], and its bearings as [bearings.…]"
        raise top.error(key, problem)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scene = _scene(top, path)
    top.finish()
    odd = tuple(dict.fromkeys(str(w.message) for w in caught))
    return dataclasses.replace(scene, warnings=odd, inputs=top.echo())


def _scene(top: Table, path: Path) -> RotorScene:
    rotor = top.table("rotor")
    shaft = _shaft(rotor)
    discs = _discs(rotor, shaft)
    speed = rotor.quantity("speed", "speed", 0.0)
    mounts = read_mounts(top, rotor, shaft, speed, path)
    excitation = rotor.table("excitation")
    axis = rotor.choice("axis", tuple(AXES), "horizontal")
    loads = _loads(excitation, shaft, AXES[axis])
    shown = _shown(shaft, discs, loads)
    return RotorScene(
        name=path.stem,
        shaft=shaft,
        discs=discs,
        mounts=mounts,
        damping=_damping(rotor),
        rigid=rotor.flag("rigid", False),
        speed=speed,
        axis=axis,
        loads=loads,
        n_modes=rotor.integer("modes", 10),
        campbell=read_campbell(rotor),
        response=read_response(rotor, shaft, loads, shown),
        transient=read_transient(rotor, shaft, shown),
        warnings=(),
        inputs={},
    )


def _shaft(rotor: Table) -> Shaft:
    lengths, outer, bore, divisions, materials = [], [], [], [], []
    for segment in rotor.tables("shaft"):
        length = segment.quantity("length", "length")
        if not length > 0.0:
            raise segment.error("length", f"{length:g} m is not allowed; above 0 m")
        lengths.append(length)
        outer.append(segment.quantity("outer_diameter", "length"))
        bore.append(segment.quantity("bore", "length", 0.0))
        divisions.append(segment.integer("divisions", 1))
        materials.append(_material(segment))
        if sum(divisions) > MOST_ELEMENTS:
            problem = f"{sum(divisions)} elements are too many; at most {MOST_ELEMENTS}"
            raise segment.error("divisions", problem)
        if not 0.0 <= bore[-1] < outer[-1]:
            allowed = f"from 0 to below the outer diameter, {outer[-1]:g} m"
            key = "bore" if "bore" in segment else "outer_diameter"
            value = bore[-1] if "bore" in segment else outer[-1]
            allowed = allowed if "bore" in segment else "above 0 m"
            raise segment.error(key, f"{value:g} m is not allowed; {allowed}")
    stations = np.concatenate([[0.0], np.cumsum(lengths)])
    with rotor.building():
        return Shaft(stations, outer, bore, tuple(materials), tuple(divisions))


def _material(table: Table) -> Material:
    """A material, steel if none is named; its numbers stand in the echo."""
    material = read_material(table, "material") or Material()
    table.fill("material", written_numbers(material))
    return material


def _discs(rotor: Table, shaft: Shaft) -> tuple[AbstractPart, ...]:
    if "discs" not in rotor:
        return ()
    return tuple(_disc(table, shaft) for table in rotor.tables("discs"))


def _disc(table: Table, shaft: Shaft) -> AbstractPart:
    station = read_station(table, shaft)
    inertias = ("polar_inertia", "diametral_inertia")
    if "mass" not in table:
        for name in inertias:
            if name in table:
                raise table.error(name, "goes with `mass`, which is missing")
        outer, width = (
            table.quantity(k, "length") for k in ("outer_diameter", "width")
        )
        bore = table.quantity("bore", "length", 0.0)
        material = _material(table)
        with table.building():
            return Disc.of_size(station, outer, width, bore, material)
    for name in ("outer_diameter", "width", "bore", "material"):
        if name in table:
            raise table.error(name, "give either `mass` or the sizes of a disc")
    mass = table.quantity("mass", "mass")
    given = [name for name in inertias if name in table]
    with table.building():
        if not given:
            return PointMass(station, mass)
        polar, diametral = (table.quantity(k, "moment of inertia") for k in inertias)
        return Disc(station, mass, polar, diametral)


def _damping(rotor: Table) -> AbstractDamping | None:
    if "damping_ratio" in rotor:
        if "damping" in rotor:
            raise rotor.error("damping", "give either `damping_ratio` or this")
        ratio = rotor.number("damping_ratio")
        if not 0.0 <= ratio < 1.0:
            problem = f"{ratio:g} is not allowed; from 0 to below 1"
            raise rotor.error("damping_ratio", problem)
        return ModalDamping(ratio) if ratio else None
    if "damping" not in rotor:
        return None
    table = rotor.table("damping")
    values = {
        "mass_factor": table.quantity("mass_factor", "rate", 0.0),
        "stiffness_factor": table.quantity("stiffness_factor", "time", 0.0),
    }
    with table.building():
        return ProportionalDamping(**values)


def _loads(table: Table, shaft: Shaft, gravity: tuple[float, ...]) -> RotorLoads:
    unbalances, forces = [], []
    for one in table.tables("unbalance") if "unbalance" in table else ():
        station = read_station(one, shaft)
        moment = one.quantity("moment", "unbalance")
        phase = one.quantity("phase", "angle", 0.0)
        with one.building():
            unbalances.append(Unbalance(station, moment, phase))
    for one in table.tables("forces") if "forces" in table else ():
        station = read_station(one, shaft)
        kinds = zip(LOADS[:5], LOAD_UNITS, strict=False)
        force = [one.quantity(name, kind_of(unit), 0.0) for name, unit in kinds]
        if not any(force):
            one.finish()
            problem = f"is missing; give one at least of {', '.join(LOADS[:5])}"
            raise one.error("Fy", problem)
        forces.append(StationForce(station, force))
    base = table.table("base_acceleration")
    shaken = [base.quantity(axis, "acceleration", 0.0) for axis in "xyz"]
    with table.building():
        return RotorLoads(tuple(unbalances), tuple(forces), gravity, shaken)


def _shown(shaft: Shaft, discs: Any, loads: RotorLoads) -> int:
    """Station that report and picture show unless another one is asked for."""
    for part in (*loads.unbalances, *discs):
        return part.station
    return shaft.n_segments // 2

"""The [vibration] table of a scene: a bearing on its rig, and how it is listened to."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..acoustics import (
    REFERENCE_ACCELERATION,
    Hann,
    NoiseModel,
    Rectangular,
    Sensor,
    octave_bands,
    third_octave_bands,
)
from ..acoustics.reference_levels import NORM
from ..design import BearingSet, FormErrors, n_elements, rows_of
from ..element import FREEDOMS, RINGS
from ..element.bearing_element import BearingElement
from .deviations_table import read_deviations
from .noise_scene import DIRECTIONS, NoiseScene
from .read import Scene, scene_of, with_speed_told
from .scene_file import find_scene, parse_bearing
from .table import Table, written
from .tolerance_table import read_tolerance

BANDS = {"octave": octave_bands, "third_octave": third_octave_bands}
WINDOWS = {"hann": Hann, "rectangular": Rectangular}
NORMS = {"85-176211": NORM}
"""Largest allowed levels, by the bearing that they are for."""
HELD = "held"
"""Word in place of `tilting_inertia` for a ring that does not tilt."""
MOST_SAMPLES = 200_000
"""Most samples of a record: some 20 MB as JSON."""


def read_noise(
    source: str | Path, settings: Iterable[str] = (), *, bearings: int = 0
) -> NoiseScene:
    """Read a scene of a bearing whose noise is wanted.

    Args:
        source, settings: As in `read_scene`.
        bearings: How many random bearings are wanted beside it.

    Raises:
        SceneError: One line that names file, key, fault and what is allowed.
    """
    path = find_scene(source)
    data = parse_bearing(path, settings)
    top = Table(data, path.name)
    scene = with_speed_told(scene_of(data, path))
    vibration = top.table("vibration", required=True)
    operating, deviations = top.table("operating"), top.table("deviations")
    _check_operating(operating, scene)
    element = scene.running()
    bearing: Any = element.bearing
    counts = tuple(n_elements(row.bearing) for row in rows_of(bearing))
    errors, common = read_deviations(deviations, counts, path.parent)
    deviations.finish()
    values = {
        "mass": vibration.quantity("mass", "mass"),
        "load": scene.load,
        "speed": scene.speed,
        "errors": _of_rows(errors),
        "sensor": _sensor(vibration),
        "moving_ring": _moving_ring(vibration, operating),
        **_tilting(vibration, scene),
    }
    retardation = vibration.quantity("retardation", "time", None)
    if retardation is not None:
        values["retardation"] = retardation
    with vibration.building():
        model = NoiseModel(element, **values)
        # As a number of the scene, which the echo has.
        model = dataclasses.replace(model, tilting_inertia=model.inertia)
        line = dataclasses.replace(
            model, element=_nominal(element), errors=_of_rows(common)
        )
    tolerances, tighter, seed = None, (), 0
    if "tolerance" in vibration or bearings:
        table = vibration.table("tolerance", required=True)
        tolerances, tighter, seed = read_tolerance(table, bearing)
    found = NoiseScene(
        scene=scene,
        model=model,
        line=line,
        bridging=vibration.flag("bridging", False),
        **_record(vibration),
        **_levels(vibration),
        tolerances=tolerances,
        tighter=tighter,
        seed=seed,
        bearings=bearings,
        warnings=scene.warnings,
        inputs={},
    )
    vibration.finish()
    vibration.fill("moving_ring", model.moving_ring)
    vibration.fill("retardation", written(float(model.retardation), "s"))
    inertia = model.inertia
    told = HELD if inertia is None else written(float(inertia), "kg m^2")
    vibration.fill("tilting_inertia", told)
    own = {"deviations": deviations.echo(), "vibration": vibration.echo()}
    inputs = {**scene.inputs, "operating": _held(scene, model.moving_ring), **own}
    return dataclasses.replace(found, inputs=inputs)


def _of_rows(errors: tuple[FormErrors, ...]) -> FormErrors | tuple[FormErrors, ...]:
    first, *more = errors
    return errors if more else first


def _nominal(element: BearingElement) -> BearingElement:
    """The bearing with rolling elements that do not differ from each other."""
    fields = "ball_deviation", "roller_deviation", "azimuth_deviation"

    def even(bearing):
        mine = {k: None for k in fields if getattr(bearing, k, None) is not None}
        return dataclasses.replace(bearing, **mine) if mine else bearing

    bearing: Any = element.bearing
    if isinstance(bearing, BearingSet):
        rows = [
            dataclasses.replace(row, bearing=even(row.bearing)) for row in bearing.rows
        ]
        return dataclasses.replace(element, bearing=BearingSet(tuple(rows)))
    return dataclasses.replace(element, bearing=even(bearing))


def _held(scene: Scene, moving: str) -> dict[str, Any]:
    """The echo of [operating], without supports: `tilting_inertia` says what tilts."""
    kept = dict(scene.inputs["operating"])
    for key in ("free", "prescribed"):
        kept.pop(key, None)
    return {**kept, "fixed_ring": RINGS[1 - RINGS.index(moving)]}


def _check_operating(operating: Table, scene: Scene) -> None:
    """Rings that turn, and of whose motions only both tilts may be held, at zero."""
    tilts, moving = set(FREEDOMS[3:5]), set(FREEDOMS[:5])
    words = "the ring shifts in ux, uy and uz; only gx and gy may be held, both at 0"
    if set(scene.free or moving) not in (moving, moving - tilts):
        raise operating.error("free", f"is not that of a vibration: {words}")
    held = {name: x for name, x in scene.prescribed.items() if name != "gz" or x}
    if set(held) not in (set(), tilts) or any(held.values()):
        raise operating.error("prescribed", f"is not that of a vibration: {words}")
    if scene.speed is None:
        problem = "is zero" if "inner_speed" in operating else "is missing"
        rest = "and so is `outer_speed`; nothing vibrates at rest"
        raise operating.error("inner_speed", f"{problem}, {rest}")


def _tilting(table: Table, scene: Scene) -> dict[str, Any]:
    """Whether the moving ring tilts, and its inertia if it is given."""
    held = "gx" in scene.prescribed or "gx" not in (scene.free or FREEDOMS)
    if table.raw("tilting_inertia", None) == HELD:
        return {"tilts": False}
    inertia = table.quantity("tilting_inertia", "moment of inertia", None)
    if held and inertia is not None:
        problem = "is given, but [operating] holds gx and gy; choose one"
        raise table.error("tilting_inertia", problem)
    return {"tilts": not held, "tilting_inertia": inertia}


def _moving_ring(vibration: Table, operating: Table) -> str:
    """The ring that the load acts on; the outer one unless the scene says another."""
    fixed = operating.word("fixed_ring")
    moving = vibration.choice("moving_ring", RINGS, None)
    if fixed is None:
        return moving or "outer"
    if moving == fixed:
        problem = f"{moving!r} is the `fixed_ring` of [operating]; it must be the other"
        raise vibration.error("moving_ring", problem)
    return RINGS[1 - RINGS.index(fixed)]


def _sensor(table: Table) -> Sensor | None:
    stiffness = table.quantity("sensor_stiffness", "stiffness", None)
    damping = table.quantity("sensor_damping", "damping", None)
    if stiffness is None and damping is None:
        if "sensor_direction" in table:
            problem = "goes with `sensor_stiffness` or `sensor_damping`"
            raise table.error("sensor_direction", problem)
        return None
    with table.building():
        return Sensor(stiffness or 0.0, damping or 0.0, _direction(table))


def _direction(table: Table) -> list[float]:
    given = table.raw("sensor_direction", "y")
    if isinstance(given, list):
        numbers = [one for one in given if isinstance(one, int | float)]
        if len(numbers) == 3 and len(given) == 3 and not any(map(_is_bool, given)):
            return [float(one) for one in numbers]
    elif given in DIRECTIONS:
        return [float(given == name) for name in DIRECTIONS]
    problem = f"{given!r} is not known; it must be x, y, z or three bare numbers"
    raise table.error("sensor_direction", problem)


def _is_bool(value: object) -> bool:
    return isinstance(value, bool)


def _record(table: Table) -> dict[str, Any]:
    turns, settle = table.integer("turns", 8), table.integer("settle", 2, least=0)
    samples = table.integer("samples", 2048, least=16)
    if samples % 2:
        raise table.error("samples", f"{samples} is odd; it must be even")
    if (turns + settle) * samples > MOST_SAMPLES:
        number = f"{turns + settle} turns of {samples} are too many"
        raise table.error("samples", f"{number}; at most {MOST_SAMPLES} samples")
    return {
        "turns": turns,
        "settle": settle,
        "samples": samples,
        "steps": table.integer("steps", None),
    }


def _levels(table: Table) -> dict[str, Any]:
    reference = table.quantity("reference", "acceleration", REFERENCE_ACCELERATION)
    if not reference > 0.0:
        problem = f"{reference:g} m/s² is not allowed; above 0"
        raise table.error("reference", problem)
    kind = table.choice("bands", tuple(BANDS), "octave")
    norm = table.choice("norm", tuple(NORMS), None)
    if norm is not None and kind != "octave":
        raise table.error("norm", "is of octaves; take `bands` = octave")
    if norm is not None and reference != REFERENCE_ACCELERATION:
        problem = f"counts from {REFERENCE_ACCELERATION:g} m/s²; leave out `reference`"
        raise table.error("norm", problem)
    return {
        "reference": reference,
        "bands": BANDS[kind](),
        "norm": None if norm is None else np.array(NORMS[norm]),
        "window": WINDOWS[table.choice("window", tuple(WINDOWS), "hann")](),
    }

"""The bearing of a scene on its noise rig as a design whose numbers may change."""

import dataclasses
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...decide import NoiseDesign
from ...element import RINGS
from ...files.table import Table
from ...noise import with_bridged_waves
from ..bearing.read_scene import Scene
from ..noise.read import NoiseScene, noise_of
from ..noise.read_deviations import RACEWAYS
from .read_optimise import installed_numbers


def noise_design(
    data: dict[str, Any], path: Path
) -> tuple[Scene, NoiseDesign, dict[str, tuple[str, ...]]]:
    """Return the bearing of a scene on the rig of [vibration].

    Args:
        data: The scene as parsed.
        path: Its path.

    Returns:
        The scene, whose inputs have the rig; the design; its numbers by their key in
        the scene, with their paths in the design.

    Raises:
        SceneError: If it cannot be read, is of a set, or has no waves.
    """
    found, top = noise_of(data, path), Table(data, path)
    scene, rig = found.scene, found.model
    if found.vibration.bridging:
        rig = with_bridged_waves(rig)
    turning = RINGS[int(abs(rig.speed.inner) > abs(rig.speed.outer))]
    along = {} if rig.sensor is None else {"direction": rig.sensor.direction}
    with top.building():
        design = NoiseDesign(
            scene.installed,
            rig,
            found.vibration.bands,
            reference=found.reference,
            turning=turning,
            **along,
        )
    numbers = {
        key: tuple(f"installed.{path}" for path in paths)
        for key, paths in installed_numbers(scene).items()
    }
    for own in ("mass", "retardation", "sensor.stiffness", "sensor.damping"):
        if rig.sensor is not None or "sensor" not in own:
            numbers[f"vibration.{own.replace('.', '_')}"] = (f"rig.{own}",)
    numbers |= dict(_waves(found))
    return dataclasses.replace(scene, inputs=found.inputs), design, numbers


def _waves(found: NoiseScene) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the numbers of [[deviations.waves]] by key, those of an order with its
    place behind, with their paths in the design."""
    counts: dict[str, int] = {}
    for k, one in enumerate(found.inputs["deviations"].get("waves", ())):
        ring = RACEWAYS.get(one["part"])
        head = "elements" if ring is None else f"{ring}.{one['direction']}"
        place = counts[head] = counts.get(head, -1) + 1
        orders = np.size(one["order"])
        rows: Any = [""]
        if ring is None:
            shapes: Any = found.model.errors_of_rows[0].elements
            rows = range(shapes[place].amplitude.shape[0])
            rows = [f".{j}" for j in rows if one.get("element") in (None, j)]
        for name in ("amplitude", "phase"):
            path = f"rig.errors.{head}.{place}.{name}"
            each = [tuple(f"{path}{row}.{i}" for row in rows) for i in range(orders)]
            key = f"deviations.waves.{k}.{name}"
            yield key, tuple(path for paths in each for path in paths)
            if orders > 1:
                yield from ((f"{key}.{i}", paths) for i, paths in enumerate(each))

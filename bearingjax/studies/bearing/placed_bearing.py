"""A bearing of a machine, [bearings.NAME], read as the scene of a bearing alone."""

import contextlib
import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...catalogue.entry import catalogue_entry
from ...files.table import Table, text_of
from ...numerics.warning import Warning
from ...rotor import Shaft, seat_size_warnings
from .read_bearing import EXTRA_KEYS
from .read_design import BALLS
from .read_scene import Scene, scene_of

_CONTROL = ("raceway_control", "friction_coefficient")
"""Keys of `EXTRA_KEYS` that stand in [operating] of a bearing alone."""
_AT_REST = "constant_angle"
"""Kinematics that know no speed."""
COMMON = ("life", "lubricant")
"""Tables of the machine that a bearing may have for itself."""


def read_machine_bearing(
    top: Table,
    table: Table,
    name: str,
    path: Path,
    other_keys: tuple[str, ...] = (),
    speed: float = 1.0,
    known: dict[str, Any] | None = None,
) -> Scene:
    """Read [bearings.NAME] as a scene, with [life] and [lubricant] of the machine.

    Args:
        top: Scene of the machine.
        table: `[bearings.NAME]`.
        name: NAME.
        path: Path of the scene.
        other_keys: Keys of the table that the machine reads itself.
        speed: Speed of the inner ring [rad/s]; lives and fits take that of the machine.
        known: Scenes read before, by what was read; added to.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed; the message names
            the keys of the machine.
    """
    known = {} if known is None else known
    own = {k: v for k, v in table.keys_given().items() if k not in other_keys}
    table.skip(*own)
    inside = (*EXTRA_KEYS, *COMMON)
    data: dict[str, Any] = {
        "bearing": {k: v for k, v in own.items() if k not in inside},
        **{k: v for k, v in own.items() if k in EXTRA_KEYS and k not in _CONTROL},
        "operating": {k: own[k] for k in _CONTROL if k in own},
    }
    numerics = data.get("numerics")
    held = isinstance(numerics, Mapping) and numerics.get("kinematics") == _AT_REST
    if speed and not held:
        data["operating"]["inner_speed"] = f"{speed!r} rad/s"
    for key in (*COMMON, "output"):
        both = []
        if key in top:
            both.append(top.raw(key))
            top.fill(key, both[0])
        if key in own and key != "output":
            both.append(own[key])
        if all(isinstance(one, Mapping) for one in both):
            data |= (
                {key: {k: v for one in both for k, v in one.items()}} if both else {}
            )
        else:
            data[key] = both[-1]
    if isinstance(data.get("life"), dict) and _is_ball(own):
        data["life"].pop("edge_stress", None)
    mark = repr(data)
    if mark not in known:
        head = f"bearings.{name}"
        places = {"bearing": head, "operating": head}
        places |= {key: f"{head}.{key}" for key in inside if key not in COMMON}
        places |= {key: f"{head}.{key}" for key in COMMON if key in own}
        found = scene_of(data, path, (), (*inside, *other_keys), places)
        known[mark] = dataclasses.replace(found, name=name)
    scene = known[mark]
    for key, value in bearing_inputs(scene.inputs).items():
        table.fill(key, value)
    for key in COMMON:
        if key in own:
            table.fill(key, own[key])
    return scene


def bearing_inputs(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Convert the inputs of a scene to those of one [bearings.NAME].

    Args:
        inputs: `Scene.inputs`.
    """
    tables = {key: dict(inputs[key]) for key in EXTRA_KEYS if key in inputs}
    tables.get("numerics", {}).pop("tolerance", None)  # of its own load solve
    operating = inputs.get("operating", {})
    chosen = {key: operating[key] for key in EXTRA_KEYS if key in operating}
    return {**inputs["bearing"], **tables, **chosen}


def seat_misfits(scene: Scene, shaft: Shaft, station: int) -> list[Warning]:
    """Return a warning if the shaft of a bearing or of its fit differs from that at its
    station.
    """
    seat = scene.installed.mounting or scene.entry
    if seat is not None:
        return seat_size_warnings(shaft, station, seat)
    return []


def _is_ball(own: Mapping[str, Any]) -> bool:
    """Whether the keys of a bearing are of one with balls."""
    kind, name = own.get("type"), text_of(own.get("designation"))
    if kind is None and isinstance(name, str):
        with contextlib.suppress(ValueError):
            kind = catalogue_entry(name).type
    return kind in BALLS

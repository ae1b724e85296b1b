"""Scene of a rotor."""

import dataclasses
from typing import Any

import numpy as np

from ...numerics.warning import Warning
from ...rotor import AbstractDamping, AbstractPart, Shaft
from .mounts import Mount
from .tasks import ResponseKeys, TransientKeys


@dataclasses.dataclass(frozen=True)
class RotorScene:
    """Scene of a rotor, in SI.

    Attributes:
        name: Name of the file without its ending.
        shaft: The shaft.
        discs: Discs and point masses.
        mounts: Supports of the shaft.
        damping: Damping in addition to the mounts, or `None`.
        rigid: Whether the shaft is rigid.
        speed: Rotor speed [rad/s].
        axis: "horizontal", "vertical" or "none": shaft direction relative to gravity.
        loads: `RotorLoads` on it.
        n_modes: Number of modes reported.
        campbell: Speeds of the Campbell diagram (speed,) [rad/s], or `None`.
        response, transient: Settings of these analyses, or `None`.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`);
            bearings of other scenes are included.
    """

    name: str
    shaft: Shaft
    discs: tuple[AbstractPart, ...]
    mounts: tuple[Mount, ...]
    damping: AbstractDamping | None
    rigid: bool
    speed: float
    axis: str
    loads: Any
    n_modes: int
    campbell: np.ndarray | None
    response: ResponseKeys | None
    transient: TransientKeys | None
    warnings: tuple[Warning, ...] = ()
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def seats(self) -> tuple[tuple[Mount, tuple[int, ...]], ...]:
        """Each bearing with fits, by its first mount, and its stations."""
        found: dict[int, tuple[Mount, tuple[int, ...]]] = {}
        for mount in self.mounts:
            if mount.scene is not None and mount.scene.fits is not None:
                first, stations = found.get(id(mount.element), (mount, ()))
                found[id(mount.element)] = first, (*stations, mount.station)
        return tuple(found.values())

    @property
    def station_names(self) -> tuple[str, ...]:
        """Number and parts of each station, such as "1 disc"."""
        here: list[list[str]] = [[] for _ in range(self.shaft.n_segments + 1)]
        for disc in self.discs:
            kind = type(disc).__name__
            here[disc.station].append("disc" if kind == "Disc" else "mass")
        for mount in self.mounts:
            here[mount.station].append(mount.name)
        return tuple(" ".join([str(k), *what]) for k, what in enumerate(here))

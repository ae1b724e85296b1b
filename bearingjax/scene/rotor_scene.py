"""What the scene of a rotor asks for."""

import dataclasses
from typing import Any

import numpy as np

from ..element import BearingElement
from ..rotor import AbstractDamping, AbstractPart, Housing, Shaft
from ..statics.installed import Installed
from .fit_table import Fits
from .rotor_tasks import ResponseKeys, TransientKeys


@dataclasses.dataclass(frozen=True)
class Mount:
    """What holds a station of the shaft, as a scene has it, in SI.

    Attributes:
        station: Number of the station.
        name: Of the bearing; "springs" without one.
        installed: The bearing with its seats, or `None`: springs.
        fits: Its seats, temperatures and the speed of the rotor, or `None`: it is
            taken as on the drawing.
        preload: Axial force that the bearing alone carries in its place [N], or `None`.
        offset: Axial displacement of the inner ring in its place [m].
        law: "fixed_angle", "moving_angle", "cubic", or `None` for the bearing itself.
        turned: Whether it faces the other way.
        inertia: Whether its rolling elements feel the speed.
        stiffness: Of springs, in ux uy uz gx gy (5,) [N/m, N m].
        damping: Likewise (5,) [N s/m, N m s].
        housing: What it stands on; `None`: ground.
    """

    station: int
    name: str
    installed: Installed | None
    fits: Fits | None
    preload: float | None
    offset: float
    law: str | None
    turned: bool
    inertia: bool
    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    housing: Housing | None

    @property
    def element(self) -> BearingElement[Any] | None:
        """The bearing before it is preloaded and mounted."""
        return None if self.installed is None else self.installed.drawing


@dataclasses.dataclass(frozen=True)
class RotorScene:
    """What the scene of a rotor asks for, in SI.

    Attributes:
        name: Name of the file without its ending.
        shaft: The shaft.
        discs: Discs and point masses.
        mounts: What holds it.
        damping: Besides that of the mounts, or `None`.
        rigid: Whether the shaft does not bend.
        speed: Of the rotor [rad/s].
        axis: "horizontal", "vertical" or "none": where gravity pulls.
        loads: `RotorLoads` on it.
        n_modes: Number of modes that are reported.
        campbell: Speeds of the Campbell diagram (speed,) [rad/s], or `None`.
        response, transient: Or `None`.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`);
            bearings of other scenes are in it.
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
    warnings: tuple[str, ...]
    inputs: dict[str, Any]

    @property
    def seats(self) -> tuple[tuple[Mount, tuple[int, ...]], ...]:
        """Each bearing with fits, by its first mount, and its stations."""
        found: dict[int, tuple[Mount, tuple[int, ...]]] = {}
        for mount in self.mounts:
            if mount.fits is not None:
                first, stations = found.get(id(mount.element), (mount, ()))
                found[id(mount.element)] = first, (*stations, mount.station)
        return tuple(found.values())

    @property
    def station_names(self) -> tuple[str, ...]:
        """Each station with what sits there, such as "1 disc"."""
        here: list[list[str]] = [[] for _ in range(self.shaft.n_segments + 1)]
        for disc in self.discs:
            kind = type(disc).__name__
            here[disc.station].append("disc" if kind == "Disc" else "mass")
        for mount in self.mounts:
            here[mount.station].append(mount.name)
        return tuple(" ".join([str(k), *what]) for k, what in enumerate(here))

"""Scene of the noise of a bearing."""

import dataclasses
from typing import Any

import numpy as np

from ...noise import AbstractWindow, Bands, NoiseModel, Tolerances
from ...numerics.warning import Warning
from ..bearing.read_scene import Scene


@dataclasses.dataclass(frozen=True)
class NoiseScene:
    """Scene of the vibration of a bearing, in SI.

    Attributes:
        scene: The scene without [vibration].
        model: The bearing on its rig, with its form errors.
        line: Model common to all bearings of the production line: with `waves` and
            `spalls`, but without spectra, profiles and differences of the rolling
            elements, which belong to this bearing only.
        bridging: Whether contacts average waves over their width; `run_noise` applies
            it to both models.
        turns, settle, samples: As in `vibration`.
        steps: As in `vibration`; `None`: as many as needed.
        reference: Acceleration of 0 dB [m/s²].
        bands: Bands of the levels.
        norm: Largest allowed level of each band (band,) [dB], or `None`.
        window: Window of the spectrum.
        tolerances: Scatter of the bearings, or `None`.
        tighter: Names of the next tighter grade and class, with their factors on the
            sources [1].
        seed: Seed of the random bearings.
        bearings: Number of random bearings.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    scene: Scene
    model: NoiseModel
    line: NoiseModel
    bridging: bool
    turns: int
    settle: int
    samples: int
    steps: int | None
    reference: float
    bands: Bands
    norm: np.ndarray | None
    window: AbstractWindow
    tolerances: Tolerances | None
    tighter: tuple[tuple[str, dict[str, float]], ...]
    seed: int
    bearings: int
    warnings: tuple[Warning, ...]
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.scene.name

    @property
    def counts(self) -> dict[str, int]:
        """Sizes of a record, by the names of the arguments of `vibration`."""
        return {"turns": self.turns, "settle": self.settle, "samples": self.samples}

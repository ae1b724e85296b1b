"""What a scene asks for of the noise of a bearing."""

import dataclasses
from typing import Any

import numpy as np

from ..noise import AbstractWindow, Bands, NoiseModel, Tolerances
from .read import Scene

DIRECTIONS = ("x", "y", "z")
"""Directions of the acceleration that is told."""


@dataclasses.dataclass(frozen=True)
class NoiseScene:
    """What a scene asks for of the vibration of a bearing, in SI.

    Attributes:
        scene: The scene without it.
        model: The bearing on its rig, with its form errors.
        line: What all bearings of its line have in common: `waves` and `spalls`, but
            no spectra, profiles and differences of the rolling elements, which are of
            this one bearing.
        bridging: Whether contacts average waves over their width; `run_noise` gives
            both models that.
        turns, settle, samples: As in `vibration`.
        steps: As in `vibration`; `None`: as many as are needed.
        reference: Acceleration of 0 dB [m/s²].
        bands: Bands of the levels.
        norm: Largest allowed level of each band (band,) [dB], or `None`.
        window: Of the spectrum.
        tolerances: How bearings scatter, or `None`.
        tighter: Names of the next tighter grade and class, and what they make of the
            sources [1].
        seed: Of the random bearings.
        bearings: How many random bearings are wanted.
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
    warnings: tuple[str, ...]
    inputs: dict[str, Any]

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.scene.name

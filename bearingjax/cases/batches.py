"""How the cases of a sweep are worked off: batches, devices, starts, an early end."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import jax
import numpy as np

from ..design.checks import count

CHUNK = 512
"""Most cases of a batch, of which `load_search.SLOTS` are at work at a time. The first
batch has no solved cases to start from: an eighth of a sweep at most, or 64; smaller
ones end in slots that wait (benchmarks/load_solve_throughput.py)."""


@dataclasses.dataclass(frozen=True)
class Batches:
    """How a sweep works off its cases; answers and result codes are the same.

    Attributes:
        chunk: Cases of a batch, the first of which start from first contact; `None`:
            64 to `CHUNK`, by the number of cases.
        devices: Devices over which the cases are spread; `None`: all of
            `jax.devices()`, of all processes.
            (`jax.config.update("jax_num_cpu_devices", 2)` before anything else makes a
            processor with two cores two devices.)
        near: Whether each case starts from the nearest one that is solved by then,
            moved by its stiffness. Cases that fail so, or that have a direction which
            nothing holds, are solved again from first contact; so answers and result
            codes are the same to the tolerance, in fewer steps. False, and in float32:
            all cases start from first contact.
        progress: Whether a bar is shown.
        stop: Called between blocks. Once it returns true no further block is begun,
            and the remaining cases have the code `NOT_RUN`. It must return the same in
            all processes. (A KeyboardInterrupt loses what was solved; a signal handler
            whose flag `stop` returns does not.)

    Raises:
        ValueError: For a chunk that is no whole number of at least 1.
    """

    chunk: int | None = None
    devices: Sequence[Any] | None = None
    near: bool = True
    progress: bool = False
    stop: Callable[[], bool] | None = None

    def __post_init__(self):
        chunk = self.chunk
        if chunk is not None:
            count("Batches", "chunk", chunk)

    def places(self) -> np.ndarray:
        """Devices over which the cases are spread (device,)."""
        return np.array(jax.devices() if self.devices is None else list(self.devices))

    def size(self, count: int) -> int:
        """Cases of a batch of a sweep.

        Args:
            count: Number of cases of the sweep.
        """
        share = max(1, count // (8 * self.places().size))
        usual = min(CHUNK, max(64, 2 ** (share.bit_length() - 1)))
        return usual if self.chunk is None else self.chunk

"""Settings that every load solve of the package takes."""

import dataclasses
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Int

from ..design.checks import in_range
from ..numerics.types import RealOrNone, as_array
from ..numerics.units import real

DEFAULT_TOLERANCE = {"float64": 1e-11, "float32": 1e-4}
"""Relative residual at which a solve ends, by dtype of the design [1]."""


class SolveOptions(eqx.Module):
    """Numerics of a load solve, the same for all cases of a sweep or an optimisation.

    Attributes:
        points: Positions along the rollers at which loads are reported.
        tolerance: Relative residual at which the solve ends [1]; `None`: 1e-11 in
            float64, 1e-4 in float32. Displacements are off by up to thirty times as
            much, relative to the largest: 1e-6 takes a fifth less time than the
            default, 1e-4 a quarter (benchmarks/load_solve_throughput.py).
        max_steps: Step limit of the load solve.

    Traced: tolerance, max_steps; another value does not compile anew. Static: points.

    Raises:
        ValueError: For a tolerance that is not between 0 and 1.
    """

    points: int = eqx.field(static=True, default=101)
    tolerance: RealOrNone = eqx.field(**real("1"), default=None)
    max_steps: Int[Array, ""] = eqx.field(
        converter=lambda n: as_array(n, jnp.int32), default=200
    )

    def __check_init__(self):
        if self.tolerance is not None:
            in_range(self, "tolerance", 0.0, 1.0)

    def for_dtype(self, dtype: Any) -> "SolveOptions":
        """Return options with a tolerance of this dtype, by default the usual one."""
        given = self.tolerance
        tolerance = DEFAULT_TOLERANCE[str(dtype)] if given is None else given
        return dataclasses.replace(self, tolerance=as_array(tolerance, dtype))

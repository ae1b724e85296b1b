"""Settings that every load solve of the package takes."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Int

from ..design.checks import in_range, one_of
from ..element.frame import FREEDOMS, RINGS
from ..numerics.types import Scalar, as_array, as_real
from ..numerics.units import unit

DEFAULT_TOLERANCE = {"float64": 1e-11, "float32": 1e-4}
"""Relative residual at which a solve ends, by dtype of the design [1]."""


def _names(free: Any) -> Any:
    """A tuple of names; `None` and a text, which `check` refuses, stay as they are."""
    return free if free is None or isinstance(free, str) else tuple(free)


class SolveOptions(eqx.Module):
    """Settings of a load solve, the same for all cases of a sweep or an optimisation.

    `solve_load`, `sweep`, `optimise` and `linearise` take them as keyword arguments,
    put them together here once, and hand them on.

    Attributes:
        free: Freedoms of the moving ring that may move; `None`: all that the bearing
            can restrain and that are not prescribed.
        fixed_ring: "outer" or "inner".
        points: Positions along the rollers at which loads are reported.
        tolerance: Relative residual at which the solve ends [1]; `None`:
            `DEFAULT_TOLERANCE`.
        max_steps: Step limit of the load solve.

    Traced: tolerance, max_steps; another value does not compile anew. Static: all
    others.
    """

    free: tuple[str, ...] | None = eqx.field(
        static=True, converter=_names, default=None
    )
    fixed_ring: str = eqx.field(static=True, default="outer")
    points: int = eqx.field(static=True, default=101)
    tolerance: Scalar | None = eqx.field(
        converter=as_real, default=None, metadata=unit("1")
    )
    max_steps: Int[Array, ""] = eqx.field(
        converter=lambda n: as_array(n, jnp.int32), default=200
    )

    @property
    def moving_ring(self) -> str:
        """The ring that the load acts on."""
        return RINGS[1 - RINGS.index(self.fixed_ring)]

    def for_dtype(self, dtype: Any) -> "SolveOptions":
        """Return options with a tolerance of this dtype, by default the usual one."""
        given = self.tolerance
        tolerance = DEFAULT_TOLERANCE[str(dtype)] if given is None else given
        return dataclasses.replace(self, tolerance=as_array(tolerance, dtype))

    def check(self, owner: str, tolerance: str = "tolerance") -> None:
        """Raise for settings that no bearing can be solved with.

        Args:
            owner: The function that was called, for the message.
            tolerance: Its parameter for the tolerance.

        Raises:
            TypeError: For a text in place of names, or of a number.
            ValueError: For unknown names, or a tolerance that is not between 0 and 1.
        """
        one_of(owner, "fixed_ring", self.fixed_ring, RINGS, "'outer' or 'inner'")
        if isinstance(self.free, str):
            raise TypeError(
                f"{owner}: `free` is {self.free!r}; it must be a list of names."
            )
        check_names(owner, "free", self.free or ())
        if "gz" in (self.free or ()):
            raise ValueError(
                f"{owner}: `free` contains gz, which no rolling bearing restrains; it"
                " is operating data (prescribe it to turn the set of rollers)."
            )
        if self.tolerance is not None:
            in_range(owner, tolerance, 0.0, 1.0, self.tolerance, "")


def check_names(owner: str, what: str, names: Sequence[str]) -> None:
    """Raise unless all names are freedoms.

    Args:
        owner: The function that was called.
        what: Its parameter.
        names: Names that it was given.
    """
    unknown = [name for name in names if name not in FREEDOMS]
    if unknown:
        raise ValueError(
            f"{owner}: `{what}` names {', '.join(map(repr, unknown))}; freedoms are"
            f" {', '.join(FREEDOMS)}."
        )

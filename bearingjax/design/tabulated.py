"""Measured profiles: cubics through the points of a table."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..numerics.types import Number, Reals, as_real
from ..numerics.units import unit
from .checks import check, is_traced
from .profile import AbstractProfile


class Tabulated(AbstractProfile):
    """A measured profile: a cubic from each point to the next.

    Its slope at each point is that of the parabola through the point and both
    neighbours, so that a parabolic crown is exact. At a step the cubics overshoot on
    both sides, with evenly spaced points by 0.074 of its height. With `ContactMapped`
    every high spot carries its load, to 1e-6 of the whole, in a time that grows with
    the number of points: fifty take four times as long as five, five hundred forty
    times. Leave out points where the profile is smooth. Derivatives of loads by the
    table are good to 1e-7, of the stiffness by `drops` to 1e-6 and by `positions` to
    1e-3; more `points` of `ContactMapped` make them exact.

    Attributes:
        positions: s, ascending, from one roller end to the other or beyond (n,) [m].
        drops: Drop there, at least 0 (n,) [m].

    Traced: all fields. Static: the number of points.
    Source: Overhauser (1968), for points at any distance.
    """

    about: ClassVar[str] = "a measured profile: a cubic from each point to the next"
    positions: Float[Array, " table"] = eqx.field(
        converter=as_real,
        metadata=unit(
            "m", "places s along the roller, ascending, from end to end or beyond"
        ),
    )
    drops: Float[Array, " table"] = eqx.field(
        converter=as_real, metadata=unit("m", "drop at each place, at least 0")
    )

    protruding: ClassVar[bool] = True
    """Between its points a cubic may overshoot below zero."""

    def __check_init__(self):
        shape = jnp.shape(self.positions)
        if len(shape) != 1 or shape[0] < 3 or jnp.shape(self.drops) != shape:
            raise ValueError(
                f"Tabulated: `positions` and `drops` have shapes {shape} and"
                f" {jnp.shape(self.drops)}; they must be two lists of the same length,"
                " at least 3."
            )
        if is_traced(self.positions) or is_traced(self.drops):
            return
        positions, drops = np.asarray(self.positions), np.asarray(self.drops)
        for name, values in (("positions", positions), ("drops", drops)):
            check(self, name, np.isfinite(values), "finite numbers")
        check(self, "positions", np.diff(positions) > 0, "ascending")
        check(self, "drops", drops >= 0, "at least 0 m")

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        return self.between_knots(position).drop(position, length, diameter)

    def knots(self) -> Float[Array, " knot"] | None:
        return self.positions

    def between_knots(self, position: Reals) -> "AbstractProfile":
        s, d = self.positions, self.drops
        last = s.shape[0] - 1
        k = jnp.clip(jnp.searchsorted(s, position, side="right") - 1, 0, last - 1)
        step = s[k + 1] - s[k]
        chord = (d[k + 1] - d[k]) / step

        def bend(middle):
            i = jnp.clip(middle, 1, last - 1)
            left, right = s[i] - s[i - 1], s[i + 1] - s[i]
            turn = (d[i + 1] - d[i]) / right - (d[i] - d[i - 1]) / left
            return turn / (left + right)

        # The parabola of the left point blends into that of the right one.
        first = bend(k)
        more = bend(k + 1) - first
        return _Cubic(s[k], (d[k], chord - step * first, first - more, more / step))

    def _check_against(self, length, diameter):
        positions, end = np.asarray(self.positions), 0.5 * length
        covers = min(-positions[0], positions[-1]) >= end * (1.0 - 1e-9)
        allowed = f"a table that covers the roller, from {-end:.6g} to {end:.6g} m"
        check(self, "positions", covers, allowed)


class _Cubic(AbstractProfile):
    """Cubic between two points of a table.

    Attributes:
        start: Position of the first point (...) [m].
        factors: Factors of powers 0 to 3 of the distance from there [m^(1-power)].
    """

    protruding: ClassVar[bool] = True

    start: Reals
    factors: tuple[Reals, ...]

    def drop(self, position, length, diameter):
        x = position - self.start
        constant, first, second, third = self.factors
        return constant + x * (first + x * (second + x * third))

"""Loads of balls or rollers around the bearing, tabulated for time integration.

Loads, angles and all else that depends on the load alone are worked out at places
spread evenly around the bearing, and joined by a periodic spline of fifth degree.
Viscosities and films, which change by orders of magnitude, are interpolated as their
logarithms; areas and pressures, which vanish with the load, as they are.
"""

from math import comb, factorial
from typing import ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

from ..element.inertia import Speed
from ..numerics.types import Scalar
from .ball_motion import LoadedBall
from .roller_motion import LoadedRoller

_DEGREE = 5


class _Row(NamedTuple):
    """A `LoadedBall` or `LoadedRoller` as numbers to interpolate."""

    load: Array
    angle: Array | None
    patch: tuple[Array, ...]
    extent: Array
    log_mean: Array
    log_film: Array


class LoadTable(eqx.Module):
    """Loaded balls or rollers over the azimuth; from `load_table`.

    Attributes:
        rows: For every place the coefficients of the spline, of one place what is
            there; then its number [1] (place, n). The number stands here because a
            compiler may work out the place of an angle twice, and round it to two
            neighbouring places: number and coefficients are then of one.
        like: One of them, for what does not depend on its place.

    Largest errors against an evaluation at the azimuth itself, five balls under 250 N
        axial and 160 N radial load (27 to 300 N on a contact), with 24, 48, 96 and 192
        places: loads and angles 9e-5, 7e-7, 4e-9, 5e-11, viscosities at every azimuth
        2e-3, 4e-5, 2e-7, 2e-9 of themselves. Where a ball or roller loses its load,
        errors fall with the distance of the places only slowly.
    """

    rows: Float[Array, "place n"]
    like: LoadedBall | LoadedRoller

    n_own: ClassVar[int] = 0
    n_shared: ClassVar[int] = 0
    unit: ClassVar[float] = 1.0
    force: ClassVar[float] = 1.0

    @property
    def n_spins(self) -> int:
        """Number of spin components."""
        return self.like.n_spins

    @property
    def mass(self) -> Scalar:
        """Mass of a ball or roller [kg]."""
        return self.like.mass

    def push(self, time: Scalar, ring: Array) -> Array:
        """Return an empty load: a table has no unknowns to balance (0,) [N]."""
        return jnp.zeros_like(ring)

    def ball_at(
        self, azimuth: Scalar, speed: Speed, centre: Array, ring: Array
    ) -> tuple[LoadedBall | LoadedRoller, Array, Array]:
        """Return the same as `BalancedLoads.ball_at`; only `azimuth` is used."""
        return self.ball(azimuth), jnp.zeros_like(centre), jnp.zeros_like(ring)

    def ball(self, azimuth: Scalar) -> LoadedBall | LoadedRoller:
        """Return the ball or roller at an azimuth.

        Args:
            azimuth: Any angle [rad].
        """
        count = self.rows.shape[0]
        if count == 1:
            return _ball(self.rows[0, :-1], self.like)
        place = azimuth * (0.5 * count / jnp.pi)
        before = _DEGREE // 2
        first = jnp.floor(jax.lax.stop_gradient(place)).astype(jnp.int32) - before
        index = (first + jnp.arange(_DEGREE + 1, dtype=jnp.int32)) % count
        rows = self.rows[index]
        # Whole turns off, whichever place was found at their end.
        way = place - jax.lax.stop_gradient(rows[before, -1])
        way = way - count * jnp.round((way - 0.5) / count)
        powers = jnp.stack([way**k for k in range(_DEGREE + 1)])
        weight = jnp.asarray(_pieces(), powers.dtype) @ powers
        return _ball(weight @ rows[:, :-1], self.like)


def load_table(balls: LoadedBall | LoadedRoller) -> LoadTable:
    """Create a table.

    Args:
        balls: At one place, or at places spread evenly around the bearing from azimuth
            zero on, at least 6; leading axis place.
    """
    rows = jax.vmap(lambda ball: ravel_pytree(_row(ball))[0])(balls)
    count = rows.shape[0]
    if count > 1:
        rows = _coefficients(rows)
    number = jnp.arange(count, dtype=rows.dtype)[:, None]
    like = jax.tree.map(lambda b: b[0], balls)
    return LoadTable(jnp.concatenate([rows, number], axis=1), like)


def _row(ball):
    patch, film = ball.patch, ball.film
    extent = patch.extent
    loaded = extent > 0
    # Mean viscosities, of force and of spin moment: they are finite without load.
    mean = patch.moments[:, ::2] / jnp.where(loaded, extent, 1.0)
    mean = jnp.where(loaded, mean, patch.thinnest[:, None])
    films = jnp.concatenate(
        [film.unit_speed[:, None], film.central_factor[:, None], film.factors], axis=1
    )
    return _Row(
        ball.load,
        getattr(ball, "angle", None),
        patch.numbers(),
        extent,
        jnp.log(mean),
        jnp.log(films),
    )


def _ball(numbers, like):
    row = _as_row(numbers, like)
    # A spline may pass below zero beside places without load.
    total, polar = jnp.moveaxis(
        jnp.maximum(row.extent, 0.0) * jnp.exp(row.log_mean), -1, 0
    )
    films = jnp.exp(row.log_film)
    # ∫μ y dA: of an ellipse it vanishes; on a roller without spin about the contact
    # normal it has no effect.
    moments = jnp.stack([total, jnp.zeros_like(total), polar], axis=-1)
    patch = like.patch.with_numbers(row.patch, moments)
    film = eqx.tree_at(
        lambda f: (f.unit_speed, f.central_factor, f.factors),
        like.film,
        (films[:, 0], films[:, 1], films[:, 2:]),
    )
    new = jnp.maximum(row.load, 0.0), patch, film
    ball = eqx.tree_at(lambda b: (b.load, b.patch, b.film), like, new)
    if row.angle is None:
        return ball
    return eqx.tree_at(lambda b: b.angle, ball, row.angle)


def _as_row(numbers, like):
    """Return the `_Row` from its flat vector of `ravel_pytree`."""
    leaves, tree = jax.tree.flatten(jax.eval_shape(_row, like))
    ends = np.cumsum([leaf.size for leaf in leaves])[:-1]
    parts = jnp.split(numbers, ends)
    return tree.unflatten(
        [part.reshape(leaf.shape) for part, leaf in zip(parts, leaves, strict=True)]
    )


def _pieces():
    """Return the polynomial pieces of the B-spline (piece, power over a knot span).

    In the order of the coefficients: the oldest one is in its last piece.
    """
    p = _DEGREE
    pieces = np.zeros((p + 1, p + 1))
    for i in range(p + 1):
        for k in range(i + 1):
            sign = (-1) ** k * comb(p + 1, k) / factorial(p)
            for m in range(p + 1):
                pieces[p - i, m] += sign * comb(p, m) * (i - k) ** (p - m)
    return pieces


def _coefficients(values: Float[Array, "place n"]) -> Float[Array, "place n"]:
    """Return the coefficients of the periodic spline through values at its knots."""
    count = values.shape[0]
    kernel = np.zeros(count)
    for k, weight in enumerate(_pieces()[:, 0]):
        kernel[(k - _DEGREE // 2) % count] += weight
    symbol = np.fft.rfft(kernel).real[:, None]
    waves = jnp.fft.rfft(values, axis=0)
    return jnp.fft.irfft(waves / jnp.asarray(symbol, waves.dtype), n=count, axis=0)

"""Stress in a half-space below a contact, from the pressure of all cells.

Each stress is a sum of second derivatives of two potentials of the pressure, known for
a uniform rectangle as differences over its four corners. Summed over cells, corners
meet: what counts at a corner is the second difference of the pressure around it.

Source: A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929); potentials: Johnson, Contact
    Mechanics (1985), section 3.2. Corner functions derived here, without cancellation.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ...design.checks import check
from ...numerics.compiled.programs import program
from ...numerics.lapack import eigh
from ...numerics.types import Number, Reals, Scalar, as_real
from .grid import Grid
from .pressure import ContactSolution

Places = Float[Array | np.ndarray, "..."] | float | int
"""Numbers of any shape."""


class Stress(eqx.Module):
    """Stress tensor at points below the surface, tension positive; z into the body.

    Attributes:
        xx, yy, zz: Normal stresses (...) [Pa].
        xy, yz, zx: Shear stresses (...) [Pa].
    """

    xx: Reals
    yy: Reals
    zz: Reals
    xy: Reals
    yz: Reals
    zx: Reals

    @property
    def von_mises(self) -> Reals:
        """Equivalent stress of von Mises [Pa]; zero, with derivative zero, at rest."""
        normal = (self.xx - self.yy) ** 2 + (self.yy - self.zz) ** 2
        normal = normal + (self.zz - self.xx) ** 2
        square = 0.5 * normal + 3.0 * (self.xy**2 + self.yz**2 + self.zx**2)
        some = square > 0
        return jnp.where(some, jnp.sqrt(jnp.where(some, square, 1.0)), 0.0)

    @property
    def tensor(self) -> Float[Array, "... 3 3"]:
        """The whole tensor [Pa]."""
        rows = (
            (self.xx, self.xy, self.zx),
            (self.xy, self.yy, self.yz),
            (self.zx, self.yz, self.zz),
        )
        return jnp.stack([jnp.stack(row, axis=-1) for row in rows], axis=-2)

    @property
    def principal(self) -> Float[Array, "... 3"]:
        """Principal stresses, ascending [Pa]."""
        return jnp.vectorize(eigh, signature="(n,n)->(n),(n,n)")(self.tensor)[0]

    @property
    def greatest_shear(self) -> Reals:
        """Largest shear stress in any plane, half of Tresca's [Pa]."""
        principal = self.principal
        return 0.5 * (principal[..., 2] - principal[..., 0])


def stress_below(
    solution: ContactSolution, x: Places, y: Places, z: Places, poisson: Number = 0.3
) -> Stress:
    """Stress under a solved contact, in either body.

    A section across the roller: x (n, 1), one y, z (m,); along it: x = 0, y (n, 1).

    Args:
        solution: The contact.
        x, y: Across and along the roller (...) [m], broadcast with z.
        z: Depth, zero or more (...) [m].
        poisson: Poisson's ratio of the body [1].

    Returns:
        Stress, of the broadcast shape; differentiable with respect to the pressure.

    Raises:
        ValueError: If a depth is negative, or Poisson's ratio out of range.

    Valid: The body a half-space; not nearer to a corner of a cell than a tenth of the
        cell, where the steps of the pressure show.
    """
    check("stress_below", "z", jnp.all(as_real(z) >= 0), "zero or more", z, "m")
    ratio = as_real(poisson)
    check(
        "stress_below",
        "poisson",
        (ratio > -1.0) & (ratio <= 0.5),
        "above -1, at most 0.5",
        ratio,
        "",
    )
    # In the precision of the solution.
    dtype = solution.pressure.dtype
    places = jnp.broadcast_arrays(*(as_real(v).astype(dtype) for v in (x, y, z)))
    return _stress(
        solution.grid,
        solution.pressure,
        places,
        ratio.astype(dtype),
        places[0].shape,
    )


@program
def _stress(grid, pressure, places, poisson, shape):
    xs, ys, steps = _corners(grid, pressure)
    points = jnp.stack([place.ravel() for place in places], axis=-1)

    def point_stress(point):
        u, v = point[0] - xs[:, None], point[1] - ys[None, :]
        parts = corner_stress(u, v, point[2], poisson)
        return jnp.stack([jnp.sum(part * steps) for part in parts])

    found = lax.map(jax.checkpoint(point_stress), points, batch_size=64)
    return Stress(*(found[:, k].reshape(shape) for k in range(6)))


def corner_stress(u: Reals, v: Reals, z: Reals, poisson: Scalar) -> tuple[Reals, ...]:
    """Stress under one corner of a uniformly loaded rectangle.

    That of the rectangle is the sum over its corners, + at the two whose x and y are
    both the lower or both the upper ones, - at the other two.

    Args:
        u, v: Point less corner [m].
        z: Depth, zero or more [m].
        poisson: Poisson's ratio [1].

    Returns:
        xx, yy, zz, xy, yz, zx, over the pressure [1].
    """
    u, v, z = jnp.broadcast_arrays(u, v, z)
    r = jnp.sqrt(u * u + v * v + z * z)
    r = jnp.where(r > 0, r, 1.0)
    # Second derivatives of V: xx, yy, zx, yz.
    across, across_z = _ratios(u, z, v, r)
    along, along_z = _ratios(v, z, u, r)
    sunk = -jnp.arctan2(u * v, z * r)
    # And of the logarithmic potential.
    spread = _angle(v, u) - _angle(z * v, u * r)
    other = _angle(u, v) - _angle(z * u, v * r)
    low = jnp.log(r + z)
    rest = 1.0 - 2.0 * poisson
    unit = 0.5 / jnp.pi
    return (
        unit * (2.0 * poisson * sunk - z * across - rest * spread),
        unit * (2.0 * poisson * sunk - z * along - rest * other),
        unit * (sunk + z * (across + along)),
        unit * (-z / r - rest * low),
        unit * (-z * along_z),
        unit * (-z * across_z),
    )


def _ratios(u, z, v, r):
    """u and z over r (r + v), of which the second factor may cancel."""
    near = u * u + z * z
    some = near > 0
    share = jnp.where(
        v < 0, (r - v) / (r * jnp.where(some, near, 1.0)), 1.0 / (r * (r + jnp.abs(v)))
    )
    share = jnp.where(some, share, 0.0)
    return u * share, z * share


def _angle(rise, run):
    """arctan(rise/run), zero where the run is."""
    none = run == 0
    return jnp.where(none, 0.0, jnp.arctan(rise / jnp.where(none, 1.0, run)))


def _corners(grid: Grid, pressure):
    """Positions of all corners of cells, and their weights (m+1, n+1) [Pa]."""
    pressure, m = grid.unfold(pressure), grid.n_across
    xs = 2.0 * grid.half_x * (jnp.arange(m + 1, dtype=pressure.dtype) - 0.5 * m)
    padded = jnp.pad(pressure, 1)
    steps = jnp.diff(jnp.diff(padded, axis=0), axis=1)
    return xs, grid.edges, steps

"""Hertz point contact: constant, ellipse, peak pressure, stresses below the surface.

Two bodies touch in a point; the sum of their curvatures is `rolling` in the rolling
direction and `transverse` across it. The semi-axes are `rolling` and `transverse`
likewise, and either may be the longer one: all formulas are smooth through the circle.

Source: H. Hertz (1882); K. L. Johnson, Contact Mechanics (1985), chapters 3 and 4. The
integrals are written with D = (K - E)/m and B = K - D (see `numerics.elliptic`).
"""

from typing import Annotated, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax

from ..numerics.elliptic import carlson_rd, complete
from ..numerics.implicit import attach_roots, stop_gradient
from ..numerics.power import positive_power
from ..numerics.types import Reals
from ..numerics.units import unit

POINT_EXPONENT = (3, 2)
"""Load ∝ approach^(3/2), as a fraction."""

# Newton steps: quadratic from a start within 10 %.
_STEPS = 6


class Ellipse(NamedTuple):
    """Contact ellipse of two bodies, for any load.

    Semi-axes grow with the cube root of the load Q.

    Attributes:
        ratio: Semi-axis in rolling direction over the one across [1].
        constant: c of Q = c·approach^(3/2) [N/m^(3/2)].
        rolling: Semi-axis in rolling direction over Q^(1/3) [m/N^(1/3)].
        transverse: Semi-axis across over Q^(1/3) [m/N^(1/3)].
    """

    ratio: Annotated[Reals, unit("1")]
    constant: Annotated[Reals, unit("N/m^(3/2)")]
    rolling: Annotated[Reals, unit("m/N^(1/3)")]
    transverse: Annotated[Reals, unit("m/N^(1/3)")]

    def semi_axes(self, load: Reals) -> tuple[Reals, Reals]:
        """Semi-axes in rolling direction and across [m] under a load Q [N]."""
        root = positive_power(load, 1, 3)
        return self.rolling * root, self.transverse * root

    def approach(self, load: Reals) -> Reals:
        """Approach of the bodies [m] under a load Q [N]."""
        return positive_power(load / self.constant, 2, 3)

    def load(self, approach: Reals) -> Reals:
        """Load Q [N] of an approach [m]; 0 where apart."""
        return self.constant * positive_power(approach, *POINT_EXPONENT)

    def peak_pressure(self, load: Reals) -> Reals:
        """Pressure in the middle, 3Q/(2π a b) [Pa], of a load Q [N]."""
        area = jnp.pi * self.rolling * self.transverse
        return 1.5 * positive_power(load, 1, 3) / area


def ellipse(rolling: Reals, transverse: Reals, modulus: Reals) -> Ellipse:
    """Exact Hertz contact from the sums of curvatures.

    Args:
        rolling: Sum of both bodies' curvatures in the rolling direction [1/m].
        transverse: Sum of both bodies' curvatures across; hollow surfaces count
            negative [1/m].
        modulus: Contact modulus E* [Pa].

    Returns:
        Ellipse, differentiable to every order. NaN unless both sums are positive (a
        groove as tight as the ball has no point contact).
    """
    valid = (rolling > 0) & (transverse > 0)
    x, y = jnp.where(valid, rolling, 1.0), jnp.where(valid, transverse, 1.0)
    # Unknown: log of (rolling semi-axis / transverse one); x large makes it small.
    goal = jnp.log(x) - jnp.log(y)
    exponent = _axis_exponent(goal)
    ratio = jnp.where(valid, jnp.exp(exponent), jnp.nan)
    k, b, d = complete(ratio)
    # Of the transverse semi-axis a, with ratio = b/a: y = 3QD/(π E* a³).
    e = b + ratio * ratio * d
    across = jnp.cbrt(3.0 * e / (jnp.pi * modulus * (rolling + transverse))) / jnp.cbrt(
        ratio * ratio
    )
    c = 2.0 * jnp.pi * modulus * across / (3.0 * k)
    return Ellipse(ratio, c * jnp.sqrt(c), ratio * across, across)


def _axis_exponent(goal):
    def residual(t, goal):
        ratio = jnp.exp(t)
        _, b, d = complete(ratio)
        # transverse/rolling curvature = ratio² D/B
        return 2.0 * t + jnp.log(d / b) + goal

    return _root(residual, -goal * 2.0 / jnp.pi, goal)


def _root(residual, start, args):
    """Root of residual(y, args), element by element, from a start near it."""
    frozen = stop_gradient(args)

    def step(_, y):
        f, slope = jax.jvp(lambda v: residual(v, frozen), (y,), (jnp.ones_like(y),))
        return y - f / slope

    return attach_roots(
        residual, lax.fori_loop(0, _STEPS, step, stop_gradient(start)), args
    )


def axis_stress(
    ratio: Reals, depth: Reals, poisson: Reals
) -> tuple[Reals, Reals, Reals]:
    """Principal stresses below the middle of the contact, over the peak pressure.

    Args:
        ratio: Semi-axis b along x over the one a along y, any positive number [1].
        depth: Depth over the semi-axis a [1].
        poisson: Poisson's ratio [1].

    Returns:
        σx, σy, σz over the peak pressure [1], compression negative.

    Source: Thomas & Hoersch (1930) as in Johnson (1985), with the factor 1/e²
        divided out, incomplete integrals as Carlson's R_D.
    """
    z2, b2 = depth * depth, ratio * ratio
    below, beside = 1.0 + z2, b2 + z2
    root = jnp.sqrt(below * beside)
    t = beside / root
    jy = (2.0 / 3.0) * carlson_rd(z2, beside, below)
    jx = (2.0 / 3.0) * carlson_rd(z2, below, beside)
    part = 1.0 / (below * (1.0 + t))
    along_y = -0.5 * part + 0.5 * depth * jy
    along_y_nu = part - 1.0 / root + 0.5 * depth * jx
    along_x = 0.5 * part * (1.0 + 2.0 * t) / t - 1.0 / root + 0.5 * depth * jx
    along_x_nu = -part + 0.5 * depth * jy
    return (
        2.0 * ratio * (along_x + poisson * along_x_nu),
        2.0 * ratio * (along_y + poisson * along_y_nu),
        -ratio / root,
    )


class Shear(NamedTuple):
    """Shear stresses below a contact, over the peak pressure, and their depths.

    Attributes:
        greatest: Largest shear stress below the middle, in the section across the
            longer axis; no other is larger if Poisson's ratio is 0.25 or more [1].
        depth: Its depth over the shorter semi-axis [1].
        orthogonal: Amplitude of the shear stress that alternates, in planes along
            and across the surface, while the contact rolls by [1].
        orthogonal_depth: Its depth over the semi-axis in rolling direction [1].
    """

    greatest: Annotated[Reals, unit("1")]
    depth: Annotated[Reals, unit("1")]
    orthogonal: Annotated[Reals, unit("1")]
    orthogonal_depth: Annotated[Reals, unit("1")]


def shear_below(ratio: Reals, poisson: Reals) -> Shear:
    """Largest shear stresses below the surface of an elliptic contact.

    Args:
        ratio: Semi-axis in rolling direction over the one across [1].
        poisson: Poisson's ratio [1].

    Returns:
        Shear, each of the shape of `ratio`. At the circle two directions change
        places: the derivative of `greatest` with respect to `ratio` jumps there.

    Source: greatest: `axis_stress`, its maximum over the depth; orthogonal:
        Lundberg & Palmgren, Dynamic Capacity of Rolling Bearings (1947).
    """
    ratio, poisson = jnp.broadcast_arrays(ratio, poisson)
    narrow = jnp.where(ratio > 1, 1.0 / ratio, ratio)

    def shear(depth, args):
        narrow, poisson = args
        across, _, normal = axis_stress(narrow, narrow * depth, poisson)
        return 0.5 * (across - normal)

    def slope(depth, args):
        _, rate = jax.jvp(lambda v: shear(v, args), (depth,), (jnp.ones_like(depth),))
        return rate

    args = narrow, poisson
    # 0.786 b below a line, 0.48 b below a circle (Poisson's ratio 0.3).
    depth = _root(slope, 0.786 - 0.306 * narrow, args)
    # (t² - 1)(2t - 1) = ratio²; t is 1 below a line.
    square = ratio * ratio
    t = _root(
        lambda t, square: (t * t - 1.0) * (2.0 * t - 1.0) - square,
        1.0 + 0.5 * square / (1.0 + jnp.cbrt(square * square)),
        square,
    )
    root = jnp.sqrt(2.0 * t - 1.0)
    return Shear(
        greatest=shear(depth, args),
        depth=depth,
        orthogonal=root / (2.0 * t * (t + 1.0)),
        orthogonal_depth=1.0 / ((t + 1.0) * root),
    )


def sphere_constant(radius: Reals, modulus: Reals) -> Reals:
    """Constant c of Q = c·approach^(3/2) of a sphere on a plane, (4/3) E* sqrt(R).

    Args:
        radius: Radius of the sphere [m].
        modulus: Contact modulus E* [Pa].

    Returns:
        c [N/m^(3/2)].

    Source: Hertz (1882); Johnson, Contact Mechanics, eq. (4.23).
    """
    return 4.0 / 3.0 * modulus * jnp.sqrt(radius)


def sphere_peak_pressure(load: Reals, radius: Reals, modulus: Reals) -> Reals:
    """Largest pressure of a sphere on a plane, (6 Q E*²/(π³ R²))^(1/3).

    Args:
        load: Load Q ≥ 0 [N].
        radius: Radius of the sphere [m].
        modulus: Contact modulus E* [Pa].

    Returns:
        Pressure [Pa].

    Source: Hertz (1882); Johnson, Contact Mechanics, eq. (4.24).
    """
    return jnp.cbrt(6.0 * load * modulus**2 / (jnp.pi**3 * radius**2))

"""Integrals over the part of [-1, 1] where a + b ξ - h(ξ) is positive.

Both rules place their nodes as ξ = middle + half·τ with fixed τ, so that all
moments of an integrand are one product with a constant basis (w, w τ, w τ²).

* `Midpoint`: equal slices of the whole interval, the customary rule. Once the
  positive part ends inside the interval its error falls only linearly with the
  number of slices (slower still for stiffness).
* `ContactMapped`: finds where the argument changes sign and puts Gauss-Legendre
  nodes, graded to both ends, on the positive interval alone.
"""

import abc
from collections.abc import Callable
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from .implicit import attach_roots, stop

Offset = Callable[[Array], Array]


class Nodes(NamedTuple):
    """Quadrature nodes of one integral.

    Attributes:
        middle: Middle of the loaded interval of each panel (panel,) [1].
        half: Its half width (panel,) [1].
        argument: a + b ξ - h(ξ) at the nodes (panel, point), unit of a.
    """

    middle: Float[Array, " panel"]
    half: Float[Array, " panel"]
    argument: Float[Array, "panel point"]


class AbstractQuadrature(eqx.Module):
    """Rule for integrals of a function of (a + b ξ - h(ξ)) over its positive part."""

    @abc.abstractmethod
    def reference(self) -> tuple[np.ndarray, np.ndarray]:
        """Fixed nodes τ in [-1, 1] and weights (they sum to 2)."""

    @abc.abstractmethod
    def table(self, offset: Offset, kinks: tuple, dtype) -> tuple:
        """What depends on the offset h alone, computed once per design."""

    @abc.abstractmethod
    def nodes(self, offset: Callable, args, table, a: Array, b: Array) -> Nodes:
        """Nodes for given a, b; `offset(args, ξ)` is h."""

    def basis(self, dtype) -> Float[Array, "point 3"]:
        """Constant matrix (w, w τ, w τ²)."""
        tau, weight = self.reference()
        return jnp.asarray(
            np.stack([weight, weight * tau, weight * tau**2], axis=-1), dtype=dtype
        )


class Midpoint(AbstractQuadrature):
    """Equal slices, the integrand taken at the middle of each.

    Attributes:
        points: Number of slices.

    Static: all fields.
    """

    points: int = eqx.field(static=True, default=20)

    def __check_init__(self):
        _check_points(self.points)

    def reference(self):
        edges = np.linspace(-1.0, 1.0, self.points + 1)
        middle = 0.5 * (edges[1:] + edges[:-1])
        return middle, np.full(self.points, 2.0 / self.points)

    def table(self, offset, kinks, dtype):
        tau, _ = self.reference()
        return (offset(jnp.asarray(tau, dtype=dtype)),)

    def nodes(self, offset, args, table, a, b):
        (fixed,) = table
        tau = jnp.asarray(self.reference()[0], dtype=a.dtype)
        one = jnp.ones((1,), dtype=a.dtype)
        return Nodes(0.0 * one, one, (a + b * tau - fixed)[None, :])


class ContactMapped(AbstractQuadrature):
    """Gauss-Legendre nodes graded to both ends of each loaded interval.

    [-1, 1] is cut into panels at the kinks of h. In each panel the interval from
    the first to the last positive argument is found (a scan over fixed points, the
    maximum and the two ends refined by safeguarded Newton steps) and mapped with a
    polynomial substitution of power 3 at both ends, which resolves the powers 1/9
    and 10/9 at a zone edge. Where h is convex, the loaded part of a panel is one
    interval and the rule is spectrally accurate; for other shapes (measured
    profiles) gaps inside the interval are masked, at reduced accuracy.

    Zone edges move with their arguments under differentiation (implicit function
    theorem), interval ends and kinks as well.

    Attributes:
        points: Nodes per panel.
        scan: Fixed points per panel on which the loaded interval is looked for.

    Static: all fields.
    """

    points: int = eqx.field(static=True, default=32)
    scan: int = eqx.field(static=True, default=25)

    def __check_init__(self):
        _check_points(self.points)

    def reference(self):
        x, w = np.polynomial.legendre.leggauss(self.points)
        t = 0.5 * (x + 1.0)
        graded = t**3 * (10.0 + t * (-15.0 + 6.0 * t))
        slope = 30.0 * t**2 * (1.0 - t) ** 2
        return 2.0 * graded - 1.0, w * slope

    def table(self, offset, kinks, dtype):
        one = jnp.ones((), dtype=dtype)
        ends = jnp.stack([-one, *kinks, one])
        start, stop_ = ends[:-1], ends[1:]
        grid = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, self.scan))
        grid[0], grid[-1] = 0.0, 1.0
        grid = jnp.asarray(grid, dtype=dtype)[None, :]
        # Both ends exactly, so that "loaded at the end" is decided at the end.
        at = start[:, None] * (1.0 - grid) + stop_[:, None] * grid
        at = lax.stop_gradient(at)
        return start, stop_, at, lax.stop_gradient(offset(at))

    def nodes(self, offset, args, table, a, b):
        start, end, at, fixed = table
        edges = stop((start, end, at, fixed, a, b))
        left, right, inner = _loaded_interval(lambda x: offset(stop(args), x), *edges)

        def argument(x, traced):
            a, b, args = traced
            return a + b * x - offset(args, x)

        roots = attach_roots(argument, jnp.stack([left, right]), (a, b, args))
        left = jnp.where(inner[0], roots[0], start)
        right = jnp.where(inner[1], roots[1], end)
        middle, half = 0.5 * (left + right), 0.5 * (right - left)
        tau = jnp.asarray(self.reference()[0], dtype=a.dtype)
        position = middle[:, None] + half[:, None] * tau[None, :]
        return Nodes(middle, half, argument(position, (a, b, args)))


def _loaded_interval(offset, start, end, at, fixed, a, b):
    """First and last zero of a + b ξ - h in each panel, and which are inside.

    Args:
        offset: h, elementwise.
        start, end: Panel ends (panel,).
        at, fixed: Scan points and h there (panel, scan).
        a, b: Scalars.

    Returns:
        left, right (panel,), and inner (2, panel): the edge is a root inside the
        panel rather than the panel's end.
    """

    def value_and_slope(x):
        h, slope = jax.jvp(offset, (x,), (jnp.ones_like(x),))
        return a + b * x - h, b - slope

    def slope_and_curvature(x):
        return jax.jvp(lambda y: value_and_slope(y)[1], (x,), (jnp.ones_like(x),))

    f = a + b * at - fixed
    peak_value = jnp.max(f, axis=1, keepdims=True)
    peak = jnp.max(jnp.where(f >= peak_value, at, start[:, None]), axis=1)
    peak_value = peak_value[:, 0]

    # The maximum, because a lightly loaded zone may lie between two scan points.
    # Loops, not unrolled: one fused kernel of all of this takes XLA 10 s to compile.
    lo = jnp.max(jnp.where(at < peak[:, None], at, start[:, None]), axis=1)
    hi = jnp.min(jnp.where(at > peak[:, None], at, end[:, None]), axis=1)

    def climb(_, top):
        slope, curvature = slope_and_curvature(top)
        convex = curvature < 0
        newton = top - slope / jnp.where(convex, curvature, -1.0)
        return jnp.clip(jnp.where(convex, newton, top), lo, hi)

    top = lax.fori_loop(0, 4, climb, peak)
    top_value = value_and_slope(top)[0]
    peak = jnp.where(top_value > peak_value, top, peak)
    peak_value = jnp.maximum(top_value, peak_value)

    # Brackets of both edges: the outermost positive scan points (or the maximum)
    # and their open neighbours outside.
    somewhere = jnp.where(f > 0, at, peak[:, None])
    first = jnp.minimum(peak, jnp.min(somewhere, axis=1))
    final = jnp.maximum(peak, jnp.max(somewhere, axis=1))
    below = jnp.max(jnp.where(at < first[:, None], at, start[:, None]), axis=1)
    above = jnp.min(jnp.where(at > final[:, None], at, end[:, None]), axis=1)
    # First guess: the parabola through the maximum, exact for a crown.
    _, curvature = slope_and_curvature(peak)
    width = jnp.sqrt(
        jnp.maximum(2.0 * peak_value, 0.0) / jnp.where(curvature < 0, -curvature, 1.0)
    )
    inside, outside = jnp.stack([first, final]), jnp.stack([below, above])
    guess = jnp.stack([peak - width, peak + width])

    def bracketed(x, inside, outside):
        between = (x - inside) * (x - outside) <= 0
        return jnp.where(between, x, 0.5 * (inside + outside))

    def refine(_, packed):
        x, inside, outside = packed
        x = bracketed(x, inside, outside)
        value, slope = value_and_slope(x)
        positive = value > 0
        newton = x - value / jnp.where(slope == 0, 1.0, slope)
        return jnp.stack(
            [newton, jnp.where(positive, x, inside), jnp.where(positive, outside, x)]
        )

    x, inside, outside = lax.fori_loop(
        0, 6, refine, jnp.stack([guess, inside, outside])
    )
    between = (x - inside) * (x - outside) <= 0
    x = jnp.where(between, x, outside)
    empty = peak_value <= 0
    left, right = jnp.where(empty, peak, x[0]), jnp.where(empty, peak, x[1])
    return left, right, jnp.stack([(f[:, 0] <= 0) | empty, (f[:, -1] <= 0) | empty])


def _check_points(points):
    if not isinstance(points, int) or isinstance(points, bool) or points < 1:
        raise ValueError(
            f"`points` is {points!r}; it must be a whole number of at least 1."
        )

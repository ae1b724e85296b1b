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
from functools import partial
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from .compiled.elementwise import elementwise
from .implicit import attach_roots, stop_gradient
from .units import unit

Offset = Callable[[Array], Array]

# Steps that find a zone edge from its scan interval: to 1e-8 on the singular end of a
# logarithm, where less is in error in the integrals.
_OF_ANY = 5

# On arcs, from the middle of a panel: steps to the top, of which the first is exact for
# a parabola, and to the edges, after the exact ones of the parabola at the top.
_TO_TOP, _OF_ARCS = 2, 2
_INSET = 1e-9  # share of a panel that its ends are not approached to
_SETTLED = 1e-9

MOST_NODES = 500
"""Most nodes of a panel: NumPy finds them in a second."""


class Nodes(NamedTuple):
    """Quadrature nodes of one integral.

    Attributes:
        middle: Middle of the loaded interval of each panel (panel,) [1].
        half: Its half width (panel,) [1].
        argument: a + b ξ - h(ξ) at the nodes (panel, point), unit of a.
    """

    middle: Annotated[Float[Array, " panel"], unit("1")]
    half: Annotated[Float[Array, " panel"], unit("1")]
    argument: Float[Array, "panel point"]


class AbstractQuadrature(eqx.Module):
    """Rule for integrals of a function of (a + b ξ - h(ξ)) over its positive part."""

    @abc.abstractmethod
    def reference(self) -> tuple[np.ndarray, np.ndarray]:
        """Fixed nodes τ in [-1, 1] and weights (they sum to 2)."""

    @abc.abstractmethod
    def table(
        self, offset: Offset, kinks: tuple | Array, dtype: Any, arcs: bool = False
    ) -> tuple:
        """Return the terms that depend on the offset h only, once per design; `arcs`
        as in `nodes`."""

    @abc.abstractmethod
    def nodes(
        self,
        offset: Callable,
        args: Any,
        table: tuple,
        a: Array,
        b: Array,
        arcs: bool = False,
    ) -> Nodes:
        """Nodes for given a, b; `offset(args, ξ)` is h.

        `arcs`: h is made of straight lines and flat arcs, kinks between them. Static.
        """

    def basis(self, dtype: Any) -> Float[Array, "point 3"]:
        """Constant matrix (w, w τ, w τ²)."""
        tau, weight = self.reference()
        return jnp.asarray(
            np.stack([weight, weight * tau, weight * tau**2], axis=-1), dtype=dtype
        )


class Midpoint(AbstractQuadrature):
    """Equal slices, the integrand taken at the middle of each.

    Peaks of a measured profile between two midpoints are missed.

    Attributes:
        points: Number of slices.

    Static: all fields.
    """

    points: int = eqx.field(static=True, default=20)

    def __check_init__(self):
        _check_points(self.points)

    def reference(self) -> tuple[np.ndarray, np.ndarray]:
        edges = np.linspace(-1.0, 1.0, self.points + 1)
        middle = 0.5 * (edges[1:] + edges[:-1])
        return middle, np.full(self.points, 2.0 / self.points)

    def table(
        self, offset: Offset, kinks: tuple | Array, dtype: Any, arcs: bool = False
    ) -> tuple:
        tau, _ = self.reference()
        return (offset(jnp.asarray(tau, dtype=dtype)),)

    def nodes(
        self,
        offset: Callable,
        args: Any,
        table: tuple,
        a: Array,
        b: Array,
        arcs: bool = False,
    ) -> Nodes:
        (fixed,) = table
        tau = jnp.asarray(self.reference()[0], dtype=a.dtype)
        one = jnp.ones((1,), dtype=a.dtype)
        return Nodes(0.0 * one, one, (a + b * tau - fixed)[None, :])


class ContactMapped(AbstractQuadrature):
    """Gauss-Legendre nodes graded to both ends of each loaded interval.

    [-1, 1] is cut into panels at the kinks of h. In each panel the interval from
    the first to the last positive argument is found (a scan over fixed points, the
    two ends refined by safeguarded steps of third order) and mapped with a
    polynomial substitution of power 3 at both ends, which resolves the powers 1/9
    and 10/9 at a zone edge. Where h is convex, the loaded part of a panel is one
    interval and the rule is spectrally accurate; gaps inside the interval, of other
    formulas, are masked, at reduced accuracy. Measured profiles have several loaded
    parts: they are integrated from point to point (`pieces`), to 1e-6 as well.

    Zone edges move with their arguments under differentiation (implicit function
    theorem), interval ends and kinks as well.

    Attributes:
        points: Nodes per panel.
        scan: Fixed points per panel on which the loaded interval is looked for.

    Static: all fields.
    """

    points: int = eqx.field(static=True, default=32)
    scan: int = eqx.field(static=True, default=32)

    def __check_init__(self):
        _check_points(self.points)
        if self.points > MOST_NODES:
            raise ValueError(
                f"`points` is {self.points}; it must be at most {MOST_NODES}: the nodes"
                " are eigenvalues of a full matrix of that size, and 32 err by 1e-8."
            )
        if not isinstance(self.scan, int) or self.scan < 3:
            raise ValueError(
                f"`scan` is {self.scan!r}; it must be a whole number of at least 3."
            )

    def reference(self) -> tuple[np.ndarray, np.ndarray]:
        x, w = np.polynomial.legendre.leggauss(self.points)
        t = 0.5 * (x + 1.0)
        graded = t**3 * (10.0 + t * (-15.0 + 6.0 * t))
        slope = 30.0 * t**2 * (1.0 - t) ** 2
        return 2.0 * graded - 1.0, w * slope

    def table(
        self, offset: Offset, kinks: tuple | Array, dtype: Any, arcs: bool = False
    ) -> tuple:
        one = jnp.ones((), dtype=dtype)
        ends = jnp.stack([-one, *kinks, one])
        start, end = ends[:-1], ends[1:]
        if arcs:
            return start, end
        index = jnp.arange(self.scan, dtype=dtype)[None, :]
        at = stop_gradient(_scan_point(index, start[:, None], end[:, None], self.scan))
        fixed, slope = jax.jvp(offset, (at,), (jnp.ones_like(at),))
        return start, end, at, stop_gradient(fixed), stop_gradient(slope)

    def nodes(
        self,
        offset: Callable,
        args: Any,
        table: tuple,
        a: Array,
        b: Array,
        arcs: bool = False,
    ) -> Nodes:
        start, end, *_ = table
        frozen: Any = stop_gradient((*table, a, b))
        if arcs:
            left, right, inner = _loaded_arcs(offset, stop_gradient(args), *frozen)
        else:
            known = partial(offset, stop_gradient(args))
            left, right, inner = _loaded_interval(known, *frozen)

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


def _scan_point(index, start, end, count):
    """Scan points of a panel, ends included, crowded towards both: profiles may end in
    a logarithm."""
    t = index / (count - 1)
    left, right = t**5, (1.0 - t) ** 5
    return (start * right + end * left) / (left + right)


def _loaded_arcs(offset, args, start, end, a, b):
    """Loaded intervals as in `_loaded_interval`, for one arc per panel: no scan."""
    rows = start, end, a, b
    left, right, first, last = elementwise(_loaded_arc, rows, (offset, args))
    return left, right, jnp.stack([first, last])


def _loaded_arc(start, end, a, b, given):
    """Edges of a + b ξ - h > 0 in one panel, and whether they are inside; scalars.

    Args:
        start, end, a, b: Ends of the panel, and the line.
        given: h, and its arguments before ξ.

    The top is found by Newton's method, the edges from there as the roots of the local
    parabola: both exact at once of a parabola, which a flat arc nearly is.
    """
    offset = partial(*given)

    def slope_of(x):
        return jax.jvp(offset, (x,), (jnp.ones_like(x),))

    def slope_expansion(x):
        (h, h1), (_, h2) = jax.jvp(slope_of, (x,), (jnp.ones_like(x),))
        return a + b * x - h, b - h1, -h2

    # At the very ends, kinks, derivatives would be those of the next panel.
    inset = _INSET * (end - start)
    low, high = start + inset, end - inset
    top = 0.5 * (start + end)
    for _ in range(_TO_TOP):
        _, first, second = slope_expansion(top)
        bent = second < 0
        step = first / jnp.where(bent, -second, 1.0)
        # A straight line is highest at an end.
        top = jnp.where(bent, top + step, jnp.where(first > 0, end, start))
        top = jnp.clip(top, low, high)
    # Apart, or a compiler repeats all of this for each edge.
    value, first, second = lax.optimization_barrier(slope_expansion(top))
    # Of the parabola at the top; of a straight line the end.
    highest = value - 0.5 * first * first / jnp.where(second < 0, second, -jnp.inf)
    left, right = (top + _to_edge(s, value, first, second) for s in (1.0, -1.0))
    for _ in range(_OF_ARCS):
        left, right = lax.optimization_barrier((left, right))
        left = jnp.clip(left, low, high)
        left = left + _to_edge(1.0, *slope_expansion(left))
        right = jnp.clip(right, low, high)
        right = right + _to_edge(-1.0, *slope_expansion(right))
    inner = [a + b * x - offset(x) <= 0 for x in (start, end)]
    left = jnp.where(inner[0], jnp.clip(left, start, end), start)
    right = jnp.where(inner[1], jnp.clip(right, left, end), end)
    loaded = highest > 0
    left, right = (jnp.where(loaded, x, top) for x in (left, right))
    return left, right, inner[0], inner[1]


def _to_edge(side, value, first, second):
    """Step to the root of the local parabola, the left one where `side` is 1."""
    square = first * first - 2.0 * value * second
    base = first + side * jnp.sqrt(jnp.maximum(square, 0.0))
    return -2.0 * value / jnp.where(base == 0, 1.0, base)


def _loaded_interval(offset, start, end, at, fixed, slope, a, b):
    """First and last zero of a + b ξ - h in each panel, and which are inside.

    Args:
        offset: h, elementwise.
        start, end: Panel ends (panel,).
        at, fixed, slope: Scan points, h and its derivative there (panel, scan).
        a, b: Scalars.

    Returns:
        left, right (panel,), right ≥ left, and inner (2, panel): the edge is a root
        inside the panel rather than the panel's end.
    """
    count = at.shape[1]
    f = a + b * at - fixed
    index = jnp.arange(count, dtype=a.dtype)[None, :]
    positive = f > 0
    first = jnp.min(jnp.where(positive, index, 1.0 * count), axis=1)
    final = jnp.max(jnp.where(positive, index, -1.0), axis=1)
    # A lightly loaded zone may lie between two scan points: on both sides of the top,
    # which is not beyond the ends (where the slope of a limited logarithm is lost).
    top = 1.0 + jnp.sum(jnp.where(b - slope[:, 1:-1] > 0, 1.0, 0.0), axis=1)
    some = final >= 0
    inside = jnp.stack([jnp.where(some, first, top), jnp.where(some, final, top - 1)])
    outside = jnp.stack(
        [jnp.where(some, first, top) - 1, jnp.where(some, final + 1, top)]
    )
    inside, outside = (
        _scan_point(jnp.clip(i, 0.0, count - 1.0), start[None, :], end[None, :], count)
        for i in (inside, outside)
    )
    side = jnp.asarray([[1.0], [-1.0]], dtype=a.dtype)
    x = refined_edges(_OF_ANY, offset, a, b, inside, outside, side, some[None, :])
    inner = jnp.stack([f[:, 0] <= 0, f[:, -1] <= 0])
    left = jnp.where(inner[0], x[0], start)
    right = jnp.where(inner[1], x[1], end)
    return left, jnp.maximum(left, right), inner


def refined_edges(
    steps: int,
    offset: Callable,
    a: Any,
    b: Any,
    inside: Array,
    outside: Array,
    side: Any,
    some: Array | bool,
) -> Array:
    """Zeros of a + b ξ - h, one between each two points of unlike sign.

    Args:
        steps: Number of refinements of an edge.
        offset: h, elementwise.
        a, b: Scalars.
        inside, outside: Points where it is positive, and where it is not.
        side: 1 where it rises, -1 where it falls; goes with the shape of `inside`.
        some: Whether it is positive at `inside`, of the same shape.

    Returns:
        The zeros, shape of `inside`.
    """
    # Which root of the local parabola: the left edge on rising ground, the right one
    # on falling.
    one = jnp.ones_like(outside)

    def slope_of(x):
        return jax.jvp(offset, (x,), (one,))

    def refine(_, state):
        x, inside, outside = state
        (h, h1), (_, h2) = jax.jvp(slope_of, (x,), (one,))
        value, first, second = a + b * x - h, b - h1, -h2
        inside = jnp.where(value > 0, x, inside)
        outside = jnp.where(value > 0, outside, x)
        # Root of the local parabola (exact for a crown, else of third order). If it has
        # none: its top, or Newton's step where that is longer (a steep profile end).
        square = first * first - 2.0 * value * second
        base = first + side * jnp.sqrt(jnp.maximum(square, 0.0))
        root = -2.0 * value / jnp.where(base == 0, 1.0, base)
        crest = -first / jnp.where(second < 0, second, -1.0)
        newton = -value / jnp.where(first == 0, 1.0, first)
        longer = jnp.where(jnp.abs(newton) > jnp.abs(crest), newton, crest)
        new = x + jnp.where(square < 0, longer, root)
        # A step of round-off may leave the bracket: its ends come from other roundings.
        between = (new - inside) * (new - outside) <= 0
        between = between | (jnp.abs(new - x) <= _SETTLED)
        # Past a point that is known to be positive: go on from there.
        past = some & ((new - inside) * (inside - outside) > 0)
        safe = jnp.where(past, inside, 0.5 * (inside + outside))
        new = jnp.where(between, new, safe)
        return new, inside, outside

    x, *_ = lax.fori_loop(0, steps, refine, (outside, inside, outside))
    return x


def _check_points(points):
    if not isinstance(points, int) or isinstance(points, bool) or points < 1:
        raise ValueError(
            f"`points` is {points!r}; it must be a whole number of at least 1."
        )

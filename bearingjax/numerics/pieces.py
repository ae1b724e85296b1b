"""Integrals over the positive parts of a + b ξ - h(ξ), of which there may be many.

Measured profiles have many high spots. Between two of their points they are smooth:
each such interval is cut where h turns its curvature, each part where the argument
has its top or its bottom. On what remains the argument only rises or only falls, so
that the signs at both ends tell whether there is a zone edge. None is missed.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .implicit import attach_roots, stop_gradient
from .quadrature import AbstractQuadrature, ContactMapped, Nodes, Offset, refined_edges

# Steps to a top (of a cubic one suffices), and from there to a zone edge.
_TO_TOP, _TO_EDGE = 3, 5
_LEAST = 10
"""Nodes per piece: the energy at a zone edge to 1e-6 of a piece, its stiffness too."""


class Pieces(AbstractQuadrature):
    """Graded nodes on pieces on which the argument is monotone.

    Nodes are graded as those of `ContactMapped`. Zone edges move with their arguments
    under differentiation; where two pieces meet, what moves cancels.

    Attributes:
        points: Nodes per piece, of which there are four per interval.

    Static: all fields.
    Valid: h that changes the sign of its curvature once between two knots: a cubic,
        or a cubic and little more. If oftener, a gap or a zone within one piece of an
        interval is integrated with the nodes that fall on it.
    """

    points: int = eqx.field(static=True)

    def reference(self) -> tuple[np.ndarray, np.ndarray]:
        return ContactMapped(self.points).reference()

    def table(
        self, offset: Offset, kinks: tuple | Array, dtype: Any, arcs: bool = False
    ) -> tuple:
        """Table of the rule; `kinks` are the ends of the intervals, (interval + 1,).

        `offset` is taken at (interval, n) positions, a row in each interval.
        """
        cuts = stop_gradient(jnp.asarray(kinks))
        ends = jnp.stack([cuts[:-1], cuts[1:]], axis=1)
        one = jnp.ones_like(ends)

        def slope_of(x):
            return jax.jvp(offset, (x,), (one[:, : x.shape[1]],))[1]

        _, bend = jax.jvp(slope_of, (ends,), (one,))
        start, end = ends[:, :1], ends[:, 1:]
        before, after = bend[:, :1], bend[:, 1:]
        turns = before * after < 0
        share = before / jnp.where(turns, before - after, 1.0)
        cut = start + jnp.where(turns, share, 0.5) * (end - start)
        bounds = jnp.concatenate([start, cut, end], axis=1)
        _, slope = jax.jvp(offset, (bounds,), (jnp.ones_like(bounds),))
        return stop_gradient((bounds, slope))

    def nodes(
        self,
        offset: Callable,
        args: Any,
        table: tuple,
        a: Array,
        b: Array,
        arcs: bool = False,
    ) -> Nodes:
        ends = _monotone(
            partial(offset, stop_gradient(args)), *stop_gradient((table, b))
        )
        left, right = ends[:, :-1], ends[:, 1:]

        def argument(x, traced):
            a, b, args = traced
            return a + b * x - offset(args, x)

        at = argument(ends, stop_gradient((a, b, args)))
        first, last = at[:, :-1] > 0, at[:, 1:] > 0
        root = refined_edges(
            _TO_EDGE,
            partial(offset, stop_gradient(args)),
            stop_gradient(a),
            stop_gradient(b),
            jnp.where(first, left, right),
            jnp.where(first, right, left),
            jnp.where(first, -1.0, 1.0).astype(a.dtype),
            True,
        )
        root = attach_roots(argument, root, (a, b, args))
        start = jnp.where(~first & last, root, left)
        end = jnp.where(first & ~last, root, right)
        end = jnp.where(first | last, end, start)
        middle, half = 0.5 * (start + end), 0.5 * (end - start)
        tau = jnp.asarray(self.reference()[0], dtype=a.dtype)
        position = middle[:, :, None] + half[:, :, None] * tau[None, None, :]
        rows = position.shape[0]
        values = argument(position.reshape(rows, -1), (a, b, args))
        return Nodes(
            middle.reshape(-1), half.reshape(-1), values.reshape(-1, self.points)
        )


def of_intervals(rule: ContactMapped, intervals: int) -> Pieces:
    """The rule for h made of several intervals: fewer nodes on each, the more they are.

    Args:
        rule: Its `points` serve each piece of two intervals.
        intervals: Number of intervals.
    """
    share = math.ceil(2 * rule.points / intervals)
    return Pieces(min(rule.points, max(_LEAST, share)))


def _monotone(offset, table, b):
    """Ends of the pieces (interval, 5) on which a + b ξ - h only rises or falls."""
    bounds, slope = table
    start, end = bounds[:, :-1], bounds[:, 1:]
    rate = b - slope
    first, last = rate[:, :-1], rate[:, 1:]

    def slope_of(x):
        return jax.jvp(offset, (x,), (jnp.ones_like(x),))[1]

    # The root of b - h': from falling to rising ground or the other way.
    falls = first > 0
    top = refined_edges(
        _TO_TOP,
        slope_of,
        b,
        jnp.zeros_like(b),
        jnp.where(falls, start, end),
        jnp.where(falls, end, start),
        jnp.where(falls, -1.0, 1.0).astype(b.dtype),
        True,
    )
    # Without any the part is one piece, and the other of no length: at the end where
    # a top would enter, so that nothing jumps when it does.
    nearer = jnp.where(jnp.abs(first) < jnp.abs(last), start, end)
    top = jnp.where(first * last < 0, top, nearer)
    pairs = jnp.stack([start, top], axis=2).reshape(start.shape[0], -1)
    return jnp.concatenate([pairs, end[:, -1:]], axis=1)

"""Approaches of all contacts of a roller from the motions of roller and rings.

The approach along a raceway is affine in the position whatever the motion, so each
raceway contact has two coordinates: a at the middle of the roller and b, the part from
tilt at its +ξ end; each rib has one. All are in metres.

Motions are in roller axes (`frame.to_roller_axes`). The roller's own three unknowns x
are counted from the mean of both rings, with the tilt times half the length.
"""

import abc
import dataclasses
from typing import Annotated, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.expansion import Expansion
from ..numerics.linear import dot
from ..numerics.units import unit
from .constants import ContactConstants
from .rolling_element import RingMotion, Unknowns


class Approaches(NamedTuple):
    """Coordinates of the contacts of a roller.

    Attributes:
        raceway: a and b at the outer, then at the inner raceway (2, 2) [m].
        rib: Approach at each rib (rib, 1) [m], or `None` without ribs.
    """

    raceway: Annotated[Float[Array, "2 2"], unit("m")]
    rib: Annotated[Float[Array, "rib 1"] | None, unit("m")]


class AbstractRollerGeometry(eqx.Module):
    """Map from motions to approaches."""

    @property
    @abc.abstractmethod
    def is_linear(self) -> bool:
        """Whether approaches are affine, and depend on motions between rings only."""

    @abc.abstractmethod
    def coordinates(self, rings: RingMotion, x: Unknowns) -> Approaches:
        """Approaches of all contacts, or coordinates from which they follow.

        Args:
            rings: Motions of the rings in roller axes [m, rad].
            x: The roller's own unknowns (3,) [m].
        """

    @abc.abstractmethod
    def on_raceways(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[Float[Array, "2 2"], Float[Array, "2 2 3"]]:
        """a and b at both raceways [m], and their derivatives by x [1].

        Args: as in `coordinates`.
        """

    def expansion(self, coordinates: Approaches) -> Expansion:
        """Approaches of all contacts as functions of `coordinates`, contact by contact.

        Only for geometries that are not linear.
        """
        raise NotImplementedError

    @abc.abstractmethod
    def with_heights(self, heights: Float[Array, "2"]) -> "AbstractRollerGeometry":
        """Return the geometry with material added along the normals of both raceways.

        Args:
            heights: At the outer and the inner raceway [m].
        """


class LinearisedRoller(AbstractRollerGeometry):
    """Small rotations: the displacement of a point (z, r) is (u - r θ, v + z θ).

    Attributes:
        start: Approaches without motion (contact,) [m].
        of_rings: Their change with the motion between the rings (contact, 3).
        of_own: Their change with x (contact, 3).

    Source: `FiniteRoller` to first order.
    """

    start: Float[Array, " contact"]
    of_rings: Float[Array, "contact 3"]
    of_own: Float[Array, "contact 3"]

    @classmethod
    def from_constants(cls, constants: ContactConstants) -> "LinearisedRoller":
        """Terms that do not depend on the motion, computed once per design."""
        rows = _rows(constants)
        ribs = constants.ribs
        on_outer = [True, True, False, False, *(() if ribs is None else ribs.on_outer)]
        # Ring minus roller = ±(inner - outer)/2 - x.
        half = jnp.asarray([-0.5 if outer else 0.5 for outer in on_outer], rows.dtype)
        one = jnp.ones_like(constants.half_length)
        scale = jnp.stack([one, one, 1.0 / constants.half_length])
        start = jnp.ravel(jnp.stack([-constants.gap, 0.0 * constants.gap], axis=1))
        if ribs is not None:
            start = jnp.concatenate([start, -ribs.gap])
        return cls(start, half[:, None] * rows, -scale[None] * rows)

    @property
    def is_linear(self) -> bool:
        return True

    def with_heights(self, heights: Float[Array, "2"]) -> "AbstractRollerGeometry":
        more = jnp.ravel(jnp.stack([heights, 0.0 * heights], axis=1))
        return dataclasses.replace(self, start=self.start.at[:4].add(more))

    def coordinates(self, rings: RingMotion, x: Unknowns) -> Approaches:
        moved = self.of_rings * rings.difference[None] + self.of_own * x[None]
        return _by_name(self.start + jnp.sum(moved, axis=1))

    def on_raceways(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[Float[Array, "2 2"], Float[Array, "2 2 3"]]:
        return self.coordinates(rings, x).raceway, self.of_own[:4].reshape(2, 2, 3)


class FiniteRoller(AbstractRollerGeometry):
    """Finite rotations in the section, normals undeformed: formula (3) of the paper.

    Of barrel rollers the approach is that to the centre of the raceway's arc, and both
    a and b are those of `LineContact.exact`.

    The coordinates of each contact are the displacement (z, r) at O of its ring against
    the roller, and the angles of ring and roller: linear in the motions.

    Attributes:
        raceways, ribs: Contacts at rest; `None` without ribs.
        of_outer, of_inner, of_own: Change of the coordinates with the motions of the
            rings and with x (contact, 4, 3).

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (3); arcs by elementary geometry.
    """

    raceways: "_Arc | _Point"
    ribs: "_Point | None"
    of_outer: Float[Array, "contact 4 3"]
    of_inner: Float[Array, "contact 4 3"]
    of_own: Float[Array, "contact 4 3"]

    @classmethod
    def from_constants(cls, constants: ContactConstants) -> "FiniteRoller":
        """Terms that do not depend on the motion, computed once per design."""
        c, ribs = constants, constants.ribs
        one, half = jnp.ones_like(c.half_length), 0.5 * c.diameter
        sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
        turned, place = _section_axes(c).T, jnp.stack([c.axial_place, c.pitch_radius])

        def in_section(*vectors):
            """(t, m) at the outer and the inner raceway in (z, r)."""
            return jnp.stack([jnp.stack(v) for v in vectors]) @ turned

        normal = in_section((sin, cos), (sin, -cos))
        along = in_section((cos, -sin), (cos, sin))
        middle = place[None] + in_section((0.0 * one, half), (0.0 * one, -half))
        if c.arc_radii is not None:
            curvature = 1.0 / jnp.stack(c.arc_radii[1:])
            length = jnp.stack([c.half_length] * 2)
            raceways = _Arc(c.gap, normal, middle, along, curvature, length)
        else:
            ends = jnp.stack([middle, c.half_length * along], axis=1)
            gap = jnp.stack([c.gap, 0.0 * c.gap], axis=1)
            share = jnp.stack([jnp.stack([one, 0.0 * one])] * 2)
            normals = jnp.stack([normal, normal], axis=1)
            raceways = _Point(gap, normals, share, ends, ends)
        on_outer = [True, False, *(() if ribs is None else ribs.on_outer)]
        if ribs is not None:
            ends = (place[None] + p @ turned for p in (ribs.point, ribs.centre))
            share = jnp.ones_like(ribs.gap)
            ribs = _Point(ribs.gap, ribs.normal @ turned, share, *ends)
            ribs = jax.tree.map(lambda a: a[:, None], ribs)
        # Rows: z, r, angle of the ring, angle of the roller.
        moved = jnp.concatenate([c.from_axes[:2], jnp.zeros((2, 3), one.dtype)])
        angle = jnp.eye(4, dtype=one.dtype)[:, :, None] * c.from_axes[None, 2:]
        of_ring, of_mean = moved + angle[2], angle[3] - moved
        outer = jnp.asarray(on_outer)[:, None, None]
        scale = jnp.stack([one, one, 1.0 / c.half_length])
        return cls(
            raceways,
            ribs,
            0.5 * of_mean[None] + jnp.where(outer, of_ring[None], 0.0),
            0.5 * of_mean[None] + jnp.where(outer, 0.0, of_ring[None]),
            jnp.stack([of_mean * scale[None]] * len(on_outer)),
        )

    @property
    def is_linear(self) -> bool:
        return False

    def with_heights(self, heights: Float[Array, "2"]) -> "AbstractRollerGeometry":
        gap = self.raceways.gap
        # Of the points, the first is the middle.
        gap = gap - heights if gap.ndim == 1 else gap.at[:, 0].add(-heights)
        return eqx.tree_at(lambda g: g.raceways.gap, self, gap)

    def coordinates(self, rings: RingMotion, x: Unknowns) -> Approaches:
        outer, inner, own = (v[None, None] for v in (*rings, x))
        moved = self.of_outer * outer + self.of_inner * inner + self.of_own * own
        u = jnp.sum(moved, axis=-1)
        return Approaches(u[:2], None if self.ribs is None else u[2:])

    def on_raceways(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[Float[Array, "2 2"], Float[Array, "2 2 3"]]:
        found = self.expansion(self.coordinates(rings, x))
        rates = found.gradient.raceway[..., None] * self.of_own[:2, None]
        return found.value.raceway, jnp.sum(rates, axis=-2)

    def expansion(self, coordinates: Approaches) -> Expansion:
        found = _expand(self.raceways, coordinates.raceway)
        if self.ribs is None:
            return jax.tree.map(lambda a: Approaches(a, None), found)
        return jax.tree.map(Approaches, found, _expand(self.ribs, coordinates.rib))


def _expand(contacts, u):
    return jax.vmap(lambda one, u: one.expansion(u))(contacts, u)


class _Point(eqx.Module):
    """Approaches -n·(motion between points of ring and roller) - gap, for one contact.

    Attributes:
        gap: At rest (k,) [m].
        normal: Unit vectors n of the drawing, in (z, r) (k, 2).
        share: Share of the displacement at O: 1, or 0 for a difference of points (k,).
        point, own: Points of ring and roller at rest, or differences (k, 2) [m].
    """

    gap: Array
    normal: Array
    share: Array
    point: Array
    own: Array

    def expansion(self, u: Float[Array, "4"]) -> Expansion:
        """Approaches (k,) from the coordinates, see `FiniteRoller`."""
        return jax.vmap(_moved_points, (None, 0))(u, self)


class _Arc(eqx.Module):
    """a and b of a contact with an arc of a raceway that keeps its shape.

    Attributes:
        gap: At rest [m].
        normal, middle, along: In (z, r) at rest: unit vector from the roller to the
            raceway, middle of the generator [m], unit vector along it (2,).
        curvature: Curvature of the arc [1/m].
        half_length: Half length of the roller [m].
    """

    gap: Array
    normal: Array
    middle: Array
    along: Array
    curvature: Array
    half_length: Array

    def expansion(self, u: Float[Array, "4"]) -> Expansion:
        """a and b (2,) from the coordinates, see `FiniteRoller`.

        From the moved middle of the roller the centre of the arc, of curvature k,
        stands by (k f - n)/k with the normal n of the moved ring, along the unit vector
        e. All is finite where k is zero.
        """
        k, swing, roll = self.curvature, _tangent(u[2]), _tangent(u[3])
        n, g = _rotate(swing, self.normal), _rotate(roll, self.along)
        c = _rotate(swing, self.middle) + self.gap * n
        m = _rotate(roll, self.middle)
        f = u[:2] + self.gap * n + _turn(swing, self.middle) - _turn(roll, self.middle)
        far = k * dot(f, f) - 2.0 * dot(n, f)
        distance = jnp.sqrt(1.0 + k * far)
        e = k * f - n
        # Parts along e and across it. The divisions end a kernel: products XLA would
        # repeat wherever they are used.
        (n, n1), (g, g1), (f, f1), (c, c1), (m, m1) = (
            (dot(e, v) / distance, _cross(e, v) / distance) for v in (n, g, f, c, m)
        )
        z, r = e / distance
        # What the ring moves turns as c, the roller as m.
        along, across = jnp.stack([z, r, -c1, m1]), jnp.stack([-r, z, c, -m])
        of_ring, of_own = jnp.asarray([[0, 0, 1, 0], [0, 0, 0, 1]], u.dtype)
        # e turns and grows; against the generator it leans.
        turn = (k * across - n * of_ring) / distance
        grown = (k * along + n1 * of_ring) / distance
        lean = turn - of_own
        rings, owns = jnp.outer(of_ring, of_ring), jnp.outer(of_own, of_own)
        bend = ((n1 - k * c1) * rings + k * m1 * owns) / distance
        bend = bend - jnp.outer(grown, turn) - jnp.outer(turn, grown)
        swept = jnp.outer(across, turn) - n / distance * jnp.outer(of_ring, across)
        swept = swept + (n * f / distance - c) * rings + m * owns
        first = along - (n * f1 - n1 * f) / distance * of_ring
        second = g * jnp.outer(lean, lean) - g1 * bend
        half = self.half_length
        return Expansion(
            jnp.stack([far / (1.0 + distance), -half * g]),
            jnp.stack([first, -half * g1 * lean]),
            jnp.stack([swept, half * second]),
        )


def _moved_points(u, at):
    """One approach of `_Point`."""
    normal, point, own = at.normal, at.point, at.own
    swing, roll = _tangent(u[2]), _tangent(u[3])
    moved = at.share * u[:2] + _turn(swing, point) - _turn(roll, own)
    point, own = _rotate(swing, point), _rotate(roll, own)
    first = jnp.stack(
        [*(-at.share * normal), _cross(normal, point), _cross(own, normal)]
    )
    second = jnp.stack(
        [0.0 * at.gap, 0.0 * at.gap, dot(normal, point), -dot(normal, own)]
    )
    return Expansion(-at.gap - dot(normal, moved), first, jnp.diag(second))


def _cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def _tangent(angle):
    """tan(angle/2) and twice its squared cosine. Both end in a division, as above."""
    half = 0.5 * angle
    tangent = jnp.sin(half) / jnp.cos(half)
    return tangent, 2.0 / (1.0 + tangent * tangent)


def _turn(turning, vector):
    """Change of a vector (z, r) turned from z towards r, without cancellation."""
    tangent, share = turning
    versine, sine = share * tangent * tangent, share * tangent
    return jnp.stack(
        [
            -versine * vector[0] - sine * vector[1],
            -versine * vector[1] + sine * vector[0],
        ]
    )


def _rotate(turning, vector):
    return vector + _turn(turning, vector)


def _by_name(approaches):
    ribs = approaches[4:, None]
    return Approaches(approaches[:4].reshape(2, 2), ribs if ribs.size else None)


def _rows(constants):
    """Rows g with approach change = g · (ring motion - roller motion)."""
    c = constants
    sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
    lever = 0.5 * c.diameter * sin
    zero, half = jnp.zeros_like(sin), c.half_length
    rows = [
        jnp.stack([-sin, -cos, lever]),
        jnp.stack([zero, zero, -half]),
        jnp.stack([-sin, cos, -lever]),
        jnp.stack([zero, zero, half]),
    ]
    if c.arc_radii is not None:
        # A raceway that moves along the roller by w seems turned by w/radius.
        for k, (side, radius) in enumerate(
            zip((1.0, -1.0), c.arc_radii[1:], strict=True)
        ):
            along = jnp.stack([cos, -side * sin, -0.5 * side * c.diameter * cos])
            rows[2 * k + 1] = rows[2 * k + 1] - half / radius * along
    if c.ribs is not None:
        n, s = c.ribs.normal, c.ribs.centre
        turn = s[:, 0] * n[:, 1] - s[:, 1] * n[:, 0]
        rows += list(-jnp.stack([n[:, 0], n[:, 1], turn], axis=1))
    return jnp.stack(rows)


def _section_axes(constants):
    """Columns t, m in (z, r)."""
    c, s = jnp.cos(constants.axis_angle), jnp.sin(constants.axis_angle)
    return jnp.stack([jnp.stack([c, s]), jnp.stack([-s, c])])

"""Approaches of all contacts of a roller from the motions of roller and rings.

The approach along a raceway is affine in the position whatever the motion, so each
raceway contact has two coordinates: a at the middle of the roller and b, the part from
tilt at its +ξ end; each rib has one. All are in metres.

Motions are in roller axes (`frame.to_roller_axes`). The roller's own three unknowns x
are counted from the mean of both rings, with the tilt times half the length.
"""

import abc
import dataclasses
from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from .constants import ContactConstants
from .rolling_element import RingMotion, Unknowns


class Approaches(NamedTuple):
    """Coordinates of the contacts of a roller.

    Attributes:
        raceway: a and b at the outer, then at the inner raceway (2, 2) [m].
        rib: Approach at each rib (rib, 1) [m], or `None` without ribs.
    """

    raceway: Float[Array, "2 2"]
    rib: Float[Array, "rib 1"] | None


class AbstractRollerGeometry(eqx.Module):
    """Map from motions to approaches."""

    @property
    @abc.abstractmethod
    def is_linear(self) -> bool:
        """Whether approaches are affine, and depend on motions between rings only."""

    @abc.abstractmethod
    def approaches(self, rings: RingMotion, x: Unknowns) -> Approaches:
        """Approaches of all contacts.

        Args:
            rings: Motions of the rings in roller axes [m, rad].
            x: The roller's own unknowns (3,) [m].
        """

    @abc.abstractmethod
    def raised(self, heights: Float[Array, "2"]) -> "AbstractRollerGeometry":
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
    def of(cls, constants: ContactConstants) -> "LinearisedRoller":
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
    def is_linear(self):
        return True

    def raised(self, heights):
        more = jnp.ravel(jnp.stack([heights, 0.0 * heights], axis=1))
        return dataclasses.replace(self, start=self.start.at[:4].add(more))

    def approaches(self, rings, x):
        moved = self.of_rings * rings.between[None] + self.of_own * x[None]
        return _named(self.start + jnp.sum(moved, axis=1))


class FiniteRoller(AbstractRollerGeometry):
    """Finite rotations in the section, normals undeformed: formula (3) of the paper.

    Of barrel rollers the approach is that to the centre of the raceway's arc, and both
    coordinates are those of `contact.line_contact.arc_approach`.

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (3); arcs by elementary geometry.
    """

    constants: ContactConstants

    @property
    def is_linear(self):
        return False

    def raised(self, heights):
        gap = self.constants.gap - heights
        return FiniteRoller(dataclasses.replace(self.constants, gap=gap))

    def approaches(self, rings, x):
        c = self.constants
        back = c.from_axes
        outer, inner = back @ rings.outer, back @ rings.inner
        roller = back @ c.motion(rings, x)
        axes = _section_axes(c)
        place = jnp.stack([c.axial_place, c.pitch_radius])
        out = []
        sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
        for k, (ring, sign) in enumerate(((outer, 1.0), (inner, -1.0))):
            normal = axes @ jnp.stack([sin, sign * cos])
            direction = axes @ jnp.stack([cos, -sign * sin])
            middle = place + axes @ jnp.stack([0.0 * cos, sign * 0.5 * c.diameter])
            moved = _displacement(ring, middle) - _displacement(roller, middle)
            if c.arc_radii is not None:
                generator = direction + _turn(roller[2], direction)
                normal = normal + _turn(ring[2], normal)
                curvature = 1.0 / c.arc_radii[1 + k]
                out += _of_arc(c, k, curvature, moved, normal, generator)
                continue
            turned = _turn(ring[2], direction) - _turn(roller[2], direction)
            out += [-c.gap[k] - normal @ moved, -c.half_length * (normal @ turned)]
        ribs = c.ribs
        for k, on_outer in enumerate(() if ribs is None else ribs.on_outer):
            assert ribs is not None
            ring = outer if on_outer else inner
            moved = _displacement(ring, place + axes @ ribs.point[k]) - _displacement(
                roller, place + axes @ ribs.centre[k]
            )
            out.append(-ribs.gap[k] - (axes @ ribs.normal[k]) @ moved)
        return _named(jnp.stack(out))


def _of_arc(c, k, curvature, moved, normal, generator):
    """Coordinates of a contact with an arc, from the motion between its middles.

    The centre of the arc stands from the middle of the roller by f - R n, where n is
    the normal of the moved ring.
    """
    f = c.gap[k] * normal + moved
    far = curvature * (f @ f) - 2.0 * (normal @ f)
    distance = jnp.sqrt(1.0 + curvature * far)
    a = far / (1.0 + distance)
    sine = (curvature * (f @ generator) - normal @ generator) / distance
    return [a, -c.half_length * sine]


def _named(approaches):
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


def _turn(angle, vector):
    """Change of a vector (z, r) turned by `angle` from z towards r."""
    # 1 - cos without cancellation.
    versine, sine = 2.0 * jnp.sin(0.5 * angle) ** 2, jnp.sin(angle)
    return jnp.stack(
        [
            -versine * vector[0] - sine * vector[1],
            -versine * vector[1] + sine * vector[0],
        ]
    )


def _displacement(motion, point):
    """Displacement of a point of a body that moves by (u, v, θ) about O."""
    return motion[:2] + _turn(motion[2], point)

"""Motion of a ball relative to the grooves of its rings.

A ball has two unknowns, the place (z, r) of its centre in its axial section. It is
measured from where the rings carry it: from the mean of both for small tilts, from the
outer ring's node for rings that turn by any angle.
"""

import abc
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.types import Number, Scalar
from ..frame import section_matrix, turn_factors
from ..rolling_element import RingMotion, Unknowns


class AbstractBallGeometry(eqx.Module):
    """Motions of one ball relative to its grooves."""

    is_linear: ClassVar[bool]
    """Whether motions are affine, and depend on motions between the rings only."""

    n_displacements: ClassVar[int]
    """Number of displacements, the first motions of a ring."""

    @abc.abstractmethod
    def axes(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        """Motion of one ring in the ball's axes, from its six freedoms."""

    @abc.abstractmethod
    def travel(self, rings: RingMotion, x: Unknowns) -> Float[Array, "contact 2"]:
        """Motion (z, r) of the ball centre against each groove centre [m].

        Args:
            rings: Motions of the rings in the ball's axes [m, rad].
            x: Ball centre (z, r) from where the rings take it (2,) [m].
        """

    @abc.abstractmethod
    def places(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[Float[Array, "2"], Float[Array, "2 3"]]:
        """Displacement (z, r) of the ball [m], and motion (z, r, θ) of the outer and
        the inner ring at the ball's undisturbed place (2, 3) [m, m, rad].

        Forces on them act on rings and ball by the transpose of this.
        """

    @abc.abstractmethod
    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        """(u, v, θ) of the ball at the node on the axis [m, m, rad]."""

    def midpoint(self, rings: RingMotion) -> Unknowns:
        """Position given by the rings, where the tether holds the ball (2,) [m]."""
        return jnp.zeros((2,), rings.outer.dtype)

    @abc.abstractmethod
    def reach(self, rings: RingMotion) -> Scalar:
        """Relative displacement of the rings in the ball's section [m]."""

    def lever(self, x: Unknowns) -> Number:
        """z of the ball from the origin of its row's axes [m]."""
        return 0.0


class LinearisedBall(AbstractBallGeometry):
    """Rings that turn by small angles. The energy is then convex.

    Ring motions are (z, r, θ) at the ball's place; x counts from the mean of the rings.

    Attributes:
        tilted: Motion of each groove centre from the tilt between the rings, less that
            of the ball's place (contact, 2) [m/rad]; zero at the outer ring.
        sides: 1/2 for contacts with the outer ring, else -1/2 (contact,).
        pitch_radius: Radius of the circle of ball centres [m].
    """

    tilted: Float[Array, "contact 2"]
    sides: Float[Array, " contact"]
    pitch_radius: Scalar

    is_linear: ClassVar[bool] = True
    n_displacements: ClassVar[int] = 2

    def axes(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        shift = jnp.eye(3, dtype=self.sides.dtype).at[0, 2].set(-self.pitch_radius)
        return shift @ section_matrix(azimuth)

    def travel(self, rings: RingMotion, x: Unknowns) -> Float[Array, "contact 2"]:
        between = rings.difference
        moved = self.sides[:, None] * between[None, :2] + x[None, :]
        return moved - self.tilted * between[2]

    def places(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[Float[Array, "2"], Float[Array, "2 3"]]:
        return rings.mean[:2] + x, jnp.stack(rings)

    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        place = rings.mean[:2] + x
        return jnp.stack([place[0], place[1], jnp.zeros_like(place[0])])

    def reach(self, rings: RingMotion) -> Scalar:
        between = rings.difference
        lever = jnp.max(jnp.abs(self.tilted))
        return jnp.abs(between[0]) + jnp.abs(between[1]) + lever * jnp.abs(between[2])


class FiniteBall(AbstractBallGeometry):
    """Rings that turn by any angle: groove centres move exactly.

    Ring motions are displacement and rotation vector at the node, in axes (radial,
    tangential, axial) at the ball's azimuth (6,). The ball stays in that axial section
    of the outer ring's node; x counts from there. Forces are conjugate to the rotation
    vectors: moments about the axes for small tilts, and about the axis of a tilt of any
    size. Rings are turned about their axis first (which they do not feel), then tilted
    by (gx, gy, 0). Tractions and gyroscopic moment act at the undisturbed place of the
    ball, as for small tilts.

    A ring is a body of revolution: only its axis counts, and of the ball its height
    along that axis and its distance from it.

    Attributes:
        along: z of the circle of ball centres from the node [m].
        inner_offset: Place of the inner raceway along its own axis, from the
            drawing's [m].
        pitch_radius: Radius of the circle of ball centres [m].
        n_arcs: Arcs of one raceway. Static.
    """

    along: Scalar
    inner_offset: Scalar
    pitch_radius: Scalar
    n_arcs: int = eqx.field(static=True)

    is_linear: ClassVar[bool] = False
    n_displacements: ClassVar[int] = 3

    def axes(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        c, s = jnp.cos(azimuth), jnp.sin(azimuth)
        o, i = jnp.zeros_like(c), jnp.ones_like(c)
        rows = [[c, s, o], [-s, c, o], [o, o, i]]
        turn = jnp.stack([jnp.stack(row) for row in rows])
        # A body of revolution does not feel a turn about its own axis.
        tilt = turn.at[2, 2].set(0.0)
        return jax.scipy.linalg.block_diag(turn, tilt)

    def _motion_in_ring(self, away, ring):
        """Motion (z, r) of the ball in the axes of a ring.

        Args:
            away: Displacement (radial, tangential, axial) of the ball against the
                ring's node (3,).
            ring: Motion of the ring (6,).
        """
        x, y, z = away
        gx, gy = ring[3], ring[4]
        radius, along = self.pitch_radius, self.along
        sine, versine = turn_factors(gx * gx + gy * gy)
        lift = -versine * (gx * gx + gy * gy)
        axial = sine * (gy * (radius + x) - gx * y) + lift * (along + z) + z
        # r² - R² without cancellation.
        change = x * (2.0 * radius + x) + y * y + z * (2.0 * along + z)
        change = change - axial * (2.0 * along + axial)
        away = jnp.sqrt(radius * radius + change)
        return jnp.stack([axial, change / (away + radius)])

    def travel(self, rings: RingMotion, x: Unknowns) -> Float[Array, "contact 2"]:
        from_outer = jnp.stack([x[1], jnp.zeros_like(x[0]), x[0]])
        away = jnp.stack([from_outer, from_outer - rings.difference[:3]])
        both = jax.vmap(self._motion_in_ring)(away, jnp.stack(rings))
        both = both.at[1, 0].add(-self.inner_offset)
        return jnp.repeat(both, self.n_arcs, axis=0)

    def places(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[Float[Array, "2"], Float[Array, "2 3"]]:
        ball = jnp.stack([rings.outer[2] + x[0], rings.outer[0] + x[1]])
        ring = [
            jnp.stack(
                [
                    r[2] - self.pitch_radius * r[4],
                    r[0] + self.along * r[4],
                    r[4],
                ]
            )
            for r in rings
        ]
        return ball, jnp.stack(ring)

    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        outer = rings.outer
        return jnp.stack([outer[2] + x[0], outer[0] + x[1], jnp.zeros_like(x[0])])

    def midpoint(self, rings: RingMotion) -> Unknowns:
        between = rings.difference[:3]
        gx, gy = rings.inner[3], rings.inner[4]
        sine, versine = turn_factors(gx * gx + gy * gy)
        z = between[2] - sine * gy * self.pitch_radius
        z = z - versine * (gx * gx + gy * gy) * self.along
        r = between[0] + sine * gy * self.along - versine * gy * gy * self.pitch_radius
        return jnp.stack([z, r])

    def reach(self, rings: RingMotion) -> Scalar:
        moved = self.travel(rings, self.midpoint(rings))
        return jnp.max(jnp.sum(jnp.abs(moved), axis=1))

    def lever(self, x: Unknowns) -> Number:
        return self.along + x[0]

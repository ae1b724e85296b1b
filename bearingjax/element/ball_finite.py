"""A ball between rings that turn by any angle."""

import jax
import jax.numpy as jnp
import numpy as np

from ..numerics.implicit import stop
from ..numerics.linear import dot
from ..numerics.types import Scalar
from .ball import AbstractBallModel
from .frame import turn_factors
from .model import Derivatives


class FiniteBall(AbstractBallModel):
    """A ball between rings that turn by any angle: groove centres move exactly.

    `rings` are both rings' displacements and rotation vectors at the node, seen in
    axes (radial, tangential, axial) at the ball's azimuth (12,). The ball stays in
    that axial section of the outer ring's node; x counts from there. Forces are
    conjugate to the rotation vectors: moments about the axes for small tilts, and
    about the axis of a tilt of any size. Rings are turned about their axis first (which
    they do not feel), then tilted by (gx, gy, 0). Tractions and gyroscopic moment act
    at the undisturbed place of the ball, as for small tilts.

    A ring is a body of revolution: only its axis e counts, and of the ball its
    height along that axis and its distance from it.

    Attributes:
        along: z of the circle of ball centres from the node [m].
        inner_offset: Place of the inner raceway along its own axis, from the
            drawing's [m].
    """

    along: Scalar
    inner_offset: Scalar

    @property
    def is_convex(self):
        return False

    @property
    def places_itself(self):
        return True

    @property
    def n_forces(self):
        return 3

    def section(self, azimuth):
        c, s = jnp.cos(azimuth), jnp.sin(azimuth)
        o, i = jnp.zeros_like(c), jnp.ones_like(c)
        rows = [[c, s, o], [-s, c, o], [o, o, i]]
        turn = jnp.stack([jnp.stack(row) for row in rows])
        # A body of revolution does not feel a turn about its own axis.
        tilt = turn.at[2, 2].set(0.0)
        return jax.scipy.linalg.block_diag(turn, tilt)

    def _against(self, seen):
        """Motion (z, r) of the ball in the axes of a ring.

        `seen` (5,): displacement (radial, tangential, axial) of the ball against the
        ring's node, and the tilts gx, gy of the ring.
        """
        x, y, z, gx, gy = seen
        radius, along = self.pitch_radius, self.along
        sine, versine = turn_factors(gx * gx + gy * gy)
        lift = -versine * (gx * gx + gy * gy)
        axial = sine * (gy * (radius + x) - gx * y) + lift * (along + z) + z
        # r² - R² without cancellation.
        change = x * (2.0 * radius + x) + y * y + z * (2.0 * along + z)
        change = change - axial * (2.0 * along + axial)
        away = jnp.sqrt(radius * radius + change)
        return jnp.stack([axial, change / (away + radius)])

    def _maps(self):
        """What `_against` sees of (rings, x), for both rings (2, 5, 14)."""
        maps = np.zeros((2, 5, 14))
        for ring in (0, 1):
            maps[ring, 0, 13] = maps[ring, 2, 12] = 1.0
            maps[ring, 3, 6 * ring + 3] = maps[ring, 4, 6 * ring + 4] = 1.0
        for k in range(3):
            maps[1, k, k], maps[1, k, 6 + k] = 1.0, -1.0
        return jnp.asarray(maps, self.along.dtype)

    def moved(self, rings, x):
        both = jax.vmap(self._against)(self._maps() @ jnp.concatenate([rings, x]))
        both = both.at[1, 0].add(-self.inner_offset)
        return jnp.repeat(both, len(self.grooves.on_outer) // 2, axis=0)

    def amid(self, rings):
        between = rings[6:9] - rings[:3]
        gx, gy = rings[9], rings[10]
        sine, versine = turn_factors(gx * gx + gy * gy)
        z = between[2] - sine * gy * self.pitch_radius
        z = z - versine * (gx * gx + gy * gy) * self.along
        r = between[0] + sine * gy * self.along - versine * gy * gy * self.pitch_radius
        return jnp.stack([z, r])

    def reach(self, rings):
        return jnp.max(jnp.sum(jnp.abs(self.moved(rings, self.amid(rings))), axis=1))

    def motion(self, rings, x, outer):
        return jnp.stack([rings[2] + x[0], rings[0] + x[1], jnp.zeros_like(x[0])])

    def inertia(self, rings, x):
        out = super().inertia(rings, x)
        return None if out is None else out.at[2].add((self.along + x[0]) * out[1])

    def derivatives(self, rings, x, of_own=False, responses=()):
        contacts = self.contacts(rings, x)
        load, energy, force, blocks = self._contact_terms(contacts)
        # The guide has no reaction on the rings: it is no part of the bearing.
        off = x - stop(self.amid(rings))
        energy = energy + 0.5 * self.guide * dot(off, off)
        y = jnp.concatenate([rings, x])
        size = 2 if of_own else 14
        own = jnp.pad(jnp.ones_like(x), (size - 2, 0))
        gradient = self.guide * jnp.pad(off, (size - 2, 0))
        hessian = self.guide * jnp.diag(own)
        # Of each ring: forces and stiffness of its contacts, and how they turn.
        f = jnp.sum(force.reshape(2, -1, 2), axis=1)
        stiff = jnp.sum(blocks.reshape(2, -1, 2, 2), axis=1)
        maps = self._maps()
        slope = jax.vmap(jax.jacfwd(self._against))(maps @ y)
        curve = jax.vmap(jax.jacfwd(jax.jacfwd(self._against)))(maps @ y)
        k = jnp.einsum("kai,kab,kbj->kij", slope, stiff, slope)
        k = k + jnp.einsum("ka,kaij->kij", f, curve)
        maps = maps[:, :, -size:]
        gradient = gradient + jnp.einsum("kai,kab,kbj->j", f[:, :, None], slope, maps)
        hessian = hessian + jnp.einsum("kai,kab,kbj->ij", maps, k, maps)
        if self.turning is not None and not self._has_reaction:
            pull = jnp.stack([0.0 * x[0], self.turning.centrifugal])
            gradient = gradient - self._on_ball(pull, of_own)
            energy = energy - self.turning.centrifugal * (rings[0] + x[1])
        if not self.has_potential:
            extra, jacobian = self._without_potential(rings, x, of_own)
            gradient, hessian = gradient + extra, hessian + jacobian
        return Derivatives(energy, gradient, hessian, load)

    def _on_ball(self, force, of_own):
        if of_own:
            return force
        zero = jnp.zeros_like(force[0])
        node = jnp.stack([force[1], zero, force[0]])
        return jnp.concatenate([node, jnp.zeros((9,), force.dtype), force])

    def _pushed(self, rings, x, on_contacts, on_ball, on_rings, of_own):
        size = 2 if of_own else 14
        out = jnp.zeros((size,), x.dtype)
        if on_contacts is not None:
            _, back = jax.vjp(lambda x, rings: self.moved(rings, x), x, rings)
            own, on_these = back(on_contacts)
            out = own if of_own else jnp.concatenate([on_these, own])
        if on_ball is not None:
            out = out + self._on_ball(on_ball, of_own)
        if on_rings is not None and not of_own:
            for k in (0, 1):
                axial, radial, moment = on_rings[k]
                moment = moment - self.pitch_radius * axial + self.along * radial
                pushes = jnp.stack([radial, 0.0 * radial, axial, 0.0 * radial, moment])
                out = out.at[6 * k : 6 * k + 5].add(pushes)
        return out

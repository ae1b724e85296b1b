"""A ball between rings that turn by small angles: the default, and convex."""

import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.linear import dot
from .ball import AbstractBallModel
from .ball_contacts import add
from .frame import section_matrix
from .model import Derivatives


class LinearisedBall(AbstractBallModel):
    """A ball between rings that turn by small angles. Convex.

    `rings` are the inner ring's motion against the outer one at the ball's place
    (3,), or, turning, both rings' motions (6,). x counts from the mean of the rings.

    Attributes:
        lever: Part of the motion of an inner groove centre from the ring's tilt,
            subtracted (contact, 2) [m/rad]; zero at the outer ring.
    """

    lever: Float[Array, "contact 2"]

    def section(self, azimuth):
        shift = jnp.eye(3, dtype=self.diameter.dtype).at[0, 2].set(-self.pitch_radius)
        return shift @ section_matrix(azimuth)

    @property
    def relative(self):
        return self.turning is None

    def _between(self, rings):
        """Motion of the inner ring against the outer one, at the ball centre."""
        return rings if self.relative else rings[3:] - rings[:3]

    def reach(self, rings):
        between = self._between(rings)
        lever = jnp.max(jnp.abs(self.lever))
        moved = jnp.abs(between[0]) + jnp.abs(between[1])
        return moved + lever * jnp.abs(between[2])

    def motion(self, rings, x, outer):
        between = self._between(rings)
        # Without speed `rings` know only the motion against the outer ring.
        u = outer[0] - self.pitch_radius * outer[2] + 0.5 * between[0] + x[0]
        v = outer[1] + 0.5 * between[1] + x[1]
        return jnp.stack([u, v, jnp.zeros_like(u)])

    def moved(self, rings, x):
        between = self._between(rings)
        moved = self._sides()[:, None] * between[None, :2] + x[None, :]
        return moved + self.lever * between[2]

    def _sides(self):
        sides = [0.5 * outwards for outwards in self.grooves.outwards]
        return jnp.asarray(sides, self.diameter.dtype)

    def derivatives(self, rings, x, of_own=False, responses=()):
        contacts = self.contacts(rings, x)
        load, energy, force, blocks = self._contact_terms(contacts)
        energy = energy + 0.5 * self.guide * dot(x, x)
        kzz, kzr, krr = blocks[:, 0, 0], blocks[:, 0, 1], blocks[:, 1, 1]

        def matrix(*rows):
            return jnp.stack([jnp.stack(row) for row in rows])

        pzz, pzr, prr = add(kzz) + self.guide, add(kzr), add(krr) + self.guide
        hessian = own = matrix([pzz, pzr], [pzr, prr])
        gradient = self._generalised(force[:, 0], force[:, 1], of_own)
        gradient = gradient + self.guide * jnp.pad(x, (gradient.shape[0] - 2, 0))
        if not of_own:
            s, (lz, lr) = self._sides(), (self.lever[:, 0], self.lever[:, 1])
            # Per contact: d(moved)/d(between) = [s 0 lz; 0 s lr], d(moved)/dx = 1.
            tz, tr = kzz * lz + kzr * lr, kzr * lz + krr * lr
            stz, str_ = add(s * tz), add(s * tr)
            # s² is a quarter.
            ring = matrix(
                [0.25 * add(kzz), 0.25 * add(kzr), stz],
                [0.25 * add(kzr), 0.25 * add(krr), str_],
                [stz, str_, add(lz * tz + lr * tr)],
            )
            side = matrix(
                [add(s * kzz), add(s * kzr)],
                [add(s * kzr), add(s * krr)],
                [add(tz), add(tr)],
            )
            hessian = self._expanded(ring, side, own)
        if self.turning is not None and not self._has_reaction:
            pull = self._on_all(jnp.stack([0.0 * x[0], self.turning.centrifugal]))
            gradient = gradient - (pull[-2:] if of_own else pull)
            raised = 0.5 * (rings[1] + rings[4]) + x[1]
            energy = energy - self.turning.centrifugal * raised
        if not self.has_potential:
            extra, jacobian = self._without_potential(rings, x, of_own)
            gradient, hessian = gradient + extra, hessian + jacobian
        return Derivatives(energy, gradient, hessian, load)

    def _generalised(self, fz, fr, of_own):
        """Forces on (rings, x), or on x, from forces at the contacts (contact,)."""
        own = jnp.stack([add(fz), add(fr)])
        if of_own:
            return own
        s = self._sides()
        tilt = add(self.lever[:, 0] * fz + self.lever[:, 1] * fr)
        between = jnp.stack([add(s * fz), add(s * fr), tilt])
        rings = [between] if self.turning is None else [-between, between]
        return jnp.concatenate([*rings, own])

    def _expanded(self, ring, side, own):
        """Stiffness for (rings, x) from that for (between, x)."""
        if self.turning is None:
            return jnp.block([[ring, side], [side.T, own]])
        return jnp.block(
            [[ring, -ring, -side], [-ring, ring, side], [-side.T, side.T, own]]
        )

    def _on_all(self, force):
        """A force on the ball (2,), as generalised force on (rings, x)."""
        # x counts from the mean of the rings: half of the force on each.
        half = jnp.pad(0.5 * force, (0, 1))
        return jnp.concatenate([half, half, force])

    def _pushed(self, rings, x, on_contacts, on_ball, on_rings, of_own):
        size = 2 if of_own else rings.shape[0] + 2
        out = jnp.zeros((size,), x.dtype)
        if on_contacts is not None:
            out = out + self._generalised(on_contacts[:, 0], on_contacts[:, 1], of_own)
        if on_ball is not None:
            out = out + (on_ball if of_own else self._on_all(on_ball))
        if on_rings is not None and not of_own:
            out = out + jnp.pad(on_rings.reshape(-1), (0, 2))
        return out

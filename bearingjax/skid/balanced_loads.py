"""Contact loads of balls from the equilibrium of ring and balls at every time.

For loads that vary in time, and for balls that are not evenly spaced. Ring and balls
follow the load without inertia in the sections of the bearing: their positions are
unknowns along with the motion, and are balanced by the same time steps.
"""

from collections.abc import Callable
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..contact.hertz import Ellipse
from ..element import BearingModel, RingMotion, Speed, ball_mass
from ..element.balls.ball_contacts import angles
from ..element.energy import derivatives, ring_motions
from ..element.rolling_element import split_rings
from ..numerics.types import Scalar
from ..statics.balance import Balance
from .ball_motion import LoadedBall
from .contact_loads import loaded_ball
from .model import SkidModel


class BalancedLoads(eqx.Module):
    """Loads of the balls from equilibrium at every time.

    Attributes:
        skid: The bearing and its oil.
        prepared: The bearing at ring speeds that do not change, or `None`.
        ellipses: Ellipses of its contacts, or `None` where they change with their
            angles.
        balance: Balance of the ring, with its free freedoms.
        load: Function of time [s] that returns the load on the ring (6,) [N, N m];
            a pytree.
        unit: Unit of the unknowns [m].
        force: Scale of the unbalanced force [N].
    """

    skid: SkidModel
    prepared: BearingModel | None
    ellipses: Ellipse | None
    balance: Balance
    load: Callable[[Scalar], Any]
    unit: Scalar
    force: Scalar

    n_own: ClassVar[int] = 2
    n_spins: ClassVar[int] = LoadedBall.n_spins
    n_shared: ClassVar[int] = 6

    @property
    def mass(self) -> Scalar:
        """Mass of a ball [kg]."""
        bearing = self.skid.bearing
        return ball_mass(bearing.ball_diameter, bearing.material.density)[0]

    def ball_at(
        self,
        azimuth: Scalar,
        speed: Speed,
        centre: Float[Array, "2"],
        ring: Float[Array, "6"],
    ) -> tuple[LoadedBall, Float[Array, "2"], Float[Array, "6"]]:
        """Return a ball, its force residual, and its share of the force on the
        ring [N].

        Args:
            azimuth: Its azimuth [rad].
            speed: Speed of the rings.
            centre: Its centre (z, r) relative to its position between the rings [m].
            ring: Unknowns of the ring's balance [m].
        """
        skid, model = self.skid, self.prepared
        if model is None:
            model = skid.element.model(speed)
        ball = model.rows[0].element
        axes = ball.axes(azimuth)
        both = RingMotion(*split_rings(self.balance.ring_freedoms(ring)))
        seen = axes @ both.difference
        if not ball.sees_difference:
            seen = jnp.concatenate([axes @ both.outer, axes @ both.inner])
        forces = derivatives(ball, seen, centre, with_hessian=False).gradient
        moved = ball.coordinates(ring_motions(ball, seen), centre)
        outwards = jnp.asarray(ball.grooves.outwards, moved.dtype)
        angle = angles(outwards[:, None] * ball.grooves.touch(moved).normal)
        load = ball.respond(moved).aux
        law, contacts = skid.point_law, (load, angle, self.ellipses)
        loaded = loaded_ball(skid.bearing, law, skid.oil, *contacts)
        on_rings = ring_motions(ball, forces[:-2])
        moving = on_rings.outer if self.balance.outer_moves else on_rings.inner
        if ball.sees_difference and self.balance.outer_moves:
            moving = -on_rings.inner
        return loaded, -forces[-2:], self.balance.free_part(axes.T @ moving)

    def push(self, time: Scalar, ring: Float[Array, "6"]) -> Float[Array, "6"]:
        """Return the load in the balance of the ring; for a held freedom, its
        deviation from the prescribed value, as a force [N].

        Args:
            time: Time [s].
            ring: Unknowns of the balance [m].
        """
        balance = self.balance
        apart = (1.0 - balance.free) * ring - balance.held_values
        load = jnp.asarray(self.load(time), ring.dtype)
        return balance.free_part(load) - apart * (self.force / self.unit)

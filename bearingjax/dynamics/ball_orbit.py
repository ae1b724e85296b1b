"""How skidding balls move in the end: each is free in its pocket.

Under an axial load every ball moves evenly: four equations. Otherwise its motion
repeats from orbit to orbit, and is found as a whole: at places spread evenly over the
orbit, with derivatives along it by the interpolating trigonometric polynomial.
"""

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import n_elements
from ..element.inertia import Speed
from ..numerics.types import Scalar
from ..statics.solution import BallSolution
from .ball_motion import (
    BallState,
    LoadedBall,
    rolling,
    sliding,
    tractions,
    unbalanced,
)
from .loaded import contact_loads, loaded_ball
from .model import SkidModel
from .orbit_search import AbstractOrbit, derivatives
from .steady_results import Power, SteadySkid


class BallOrbit(AbstractOrbit):
    """Equations of a ball; unknowns are spin and orbit at each place.

    Attributes:
        model: The bearing, its oil and what surrounds the balls.
        ball: The ball at all places (place,).
        speed: Ring speeds.
        density: Of the oil [kg/m³].
        along: Matrix of derivatives along the orbit (place, place) [1].
        start: As of `AbstractOrbit`.
    """

    model: SkidModel
    ball: LoadedBall
    speed: Speed
    density: Scalar
    along: Float[Array, "place place"]
    start: Float[Array, " unknown"]

    def _local(self, ball, y, slope):
        """Forces out of balance of one place [N], and how large those are that cancel.

        Args:
            ball: The ball at that place.
            y: Its spin and orbit (4,).
            slope: How they change along the orbit (4,).
        """
        state = BallState(y[:3], y[3])
        _, pulls, drag = self.forces(ball, state)
        moment, force = unbalanced(ball, state, pulls, drag)
        change = state.orbit * slope
        rotation = change[:3].at[2].add(change[3])
        radius = 0.5 * ball.diameter
        out = jnp.concatenate(
            [
                (moment - ball.moment * rotation) / radius,
                (force - ball.mass * ball.pitch_radius * change[3])[None],
            ]
        )
        size = jnp.sum(jnp.abs(pulls.resultants.force)) + jnp.abs(drag)
        return out, size + jnp.sum(jnp.abs(pulls.resultants.moment)) / radius

    def forces(self, ball, state):
        """Motion of a ball against its raceways, tractions, and drag of the oil [N]."""
        moving = sliding(ball, state, self.speed)
        drag = self.model.drag.force(
            state.orbit, ball.frontal_area, ball.pitch_radius, self.density
        )
        return moving, tractions(ball, self.model.traction, moving), drag

    def unbalanced(self, y):
        y = y.reshape(-1, 4)
        out, sizes = jax.vmap(self._local)(self.ball, y, self.along @ y)
        return out.reshape(-1), sizes

    def jacobian(self, y):
        y = y.reshape(-1, 4)
        function = jax.jacfwd(self._local, argnums=(1, 2), has_aux=True)
        (own, sloped), _ = jax.vmap(function)(self.ball, y, self.along @ y)
        count = y.shape[0]
        if count == 1:
            return own[0]
        eye = jnp.eye(count, dtype=y.dtype)
        whole = jnp.einsum("kl,kij->kilj", eye, own)
        whole = whole + jnp.einsum("kl,kij->kilj", self.along, sloped)
        return whole.reshape(4 * count, 4 * count)

    def inertia(self):
        ball = self.ball
        spin, turn = ball.moment / (0.5 * ball.diameter), ball.mass * ball.pitch_radius
        own = jnp.stack([spin, spin, spin, turn], axis=1)
        whole = jnp.diag(own.reshape(-1))
        axial = 4 * jnp.arange(spin.shape[0]) + 2
        return whole.at[axial, axial + 1].set(spin)

    def described(self, y, **known):
        ball, speed = self.ball, self.speed
        y = y.reshape(-1, 4)

        def one(ball, y):
            state = BallState(y[:3], y[3])
            moving, pulls, drag = self.forces(ball, state)
            return moving, pulls, -drag * ball.pitch_radius * state.orbit

        moving, pulls, lost = jax.vmap(one)(ball, y)
        around = y[:, 3]
        # In time, not along the orbit: a ball is longer where it is slow.
        still = around == 0
        time = jnp.where(still, 1.0, 1.0 / jnp.where(still, 1.0, around))
        share = time / jnp.sum(time)
        mean_orbit = jnp.sum(share * around)
        balls = n_elements(self.model.bearing)

        def mean(values):
            return balls * jnp.sum(share * values)

        outer = ball.side > 0
        on_inner = mean(jnp.sum(jnp.where(outer, 0.0, pulls.ring_torque), axis=1))
        on_outer = mean(jnp.sum(jnp.where(outer, pulls.ring_torque, 0.0), axis=1))
        ahead = _ahead(share) * ball.pitch_radius[0]
        return SteadySkid(
            contact_load=ball.load,
            contact_angle=ball.angle,
            orbit_speed=around,
            rolling_orbit_speed=jax.vmap(partial(rolling, speed=speed))(ball).orbit,
            spin=y[:, :3],
            film=pulls.film,
            sliding=moving.slip,
            contact_spin=moving.spin,
            heat=pulls.resultants.heat,
            cage_speed=mean_orbit,
            wander=jnp.max(ahead) - jnp.min(ahead),
            friction_torque=-on_inner,
            power=Power(
                drive=-on_inner * speed.inner - on_outer * speed.outer,
                contacts=mean(jnp.sum(pulls.resultants.heat, axis=1)),
                drag=mean(lost),
                cage=jnp.zeros_like(mean_orbit),
            ),
            **known,
        )


def ball_orbit(
    model: SkidModel,
    solution: BallSolution,
    speed: Speed,
    load_speed: Speed,
    azimuth: Float[Array, " place"],
) -> BallOrbit:
    """Equations of the balls of a solved bearing.

    Args:
        model: The bearing, its oil and what surrounds the balls.
        solution: Of its load.
        speed: Ring speeds.
        load_speed: Ring speeds of that solution.
        azimuth: The places, spread evenly (place,) [rad].
    """
    bearing, law = model.bearing, model.point_law
    at = model.element.model(load_speed), bearing, law, solution.displacement, azimuth
    make = partial(loaded_ball, bearing, law, model.oil)
    ball = jax.vmap(make)(*contact_loads(*at))
    start = jax.vmap(partial(rolling, speed=speed))(ball)
    start = jnp.concatenate([start.spin, start.orbit[:, None]], axis=1).reshape(-1)
    density = model.lubricant.density.at(model.temperature)
    along = jnp.asarray(derivatives(azimuth.shape[0]), azimuth.dtype)
    return BallOrbit(
        model=model, ball=ball, speed=speed, density=density, along=along, start=start
    )


def _ahead(share):
    """How far a ball is ahead of even motion, at the places [rad]."""
    count = share.shape[0]
    late = jnp.cumsum(share - 1.0 / count)
    # At the places themselves, by the trapezoidal rule.
    return -2.0 * jnp.pi * (late - 0.5 * (share - 1.0 / count))

"""Steady motion of skidding balls, each free in its pocket.

Under an axial load every ball moves evenly: four equations. Otherwise its motion
repeats from orbit to orbit, and is found as a whole: at places spread evenly over the
orbit, with derivatives along it by the interpolating trigonometric polynomial.
"""

from functools import partial
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...element.balls.ball_speed import ball_mass
from ...element.solved_row import RowResults, SolvedRow
from ...numerics.types import Reals, Scalar
from ..ball_motion import (
    LEAST_LOAD,
    BallState,
    pure_rolling,
    residual_moments,
    sliding,
    tractions,
)
from ..contact_loads import contact_loads, loaded_ball
from .orbit_search import AbstractOrbit, Common, Own, Unknowns
from .steady_results import Power, SteadyMotion, SteadySkid, driving


class BallOrbit(AbstractOrbit):
    """Equations of a ball; unknowns are, at each place and each from pure rolling, the
    spin about x, the slip on the outer raceway over the ball's radius, the spin about
    the normal there, and the orbit.

    Where oil is stiff the ball sticks to the outer raceway, although spin and orbit may
    differ much from pure rolling: so slip and spin there are unknowns, not differences
    of speeds.
    """

    n_own: ClassVar = 4
    n_common: ClassVar = 0

    def excess(self, own: Float[Array, "place k"], common: Common) -> Reals:
        return own[:, 3]

    def bodies_of(self, row: RowResults) -> tuple[Any, Array]:
        of, law = self.model.bearing, self.model.point_law
        make = partial(loaded_ball, of, law, self.model.oil)
        ball = jax.vmap(make)(*contact_loads(row, of, law))
        rolls = jax.vmap(partial(pure_rolling, speed=self.speed))(ball)
        return ball, jnp.concatenate([rolls.spin, rolls.orbit[:, None]], axis=1)

    def motion(self, body: Any, rolls: Own, own: Own) -> Own:
        normal, across = _axes(body)
        lever = body.pitch_radius + 0.5 * body.diameter * normal[1]
        turned = own[1] + own[3] * lever / (0.5 * body.diameter)
        spin = turned * across + (own[2] - own[3] * normal[2]) * normal
        return rolls + jnp.append(spin.at[0].add(own[0]), own[3])

    def local(
        self, body: Any, rolls: Own, own: Own, slope: Own, common: Common
    ) -> tuple[Float[Array, " k+c"], Scalar]:
        state, _, pulls, drag = self.forces(body, rolls, own)
        moment, force = residual_moments(body, state, pulls, drag)
        change = state.orbit * slope
        rotation = change[:3].at[2].add(change[3])
        radius = 0.5 * body.diameter
        normal, across = _axes(body)
        turning = (moment - body.moment * rotation) / radius
        out = jnp.stack(
            [
                turning[0],
                turning @ across,
                turning @ normal,
                force - body.mass * body.pitch_radius * change[3],
            ]
        )
        size = jnp.sum(jnp.abs(pulls.resultants.force)) + jnp.abs(drag)
        return out, size + jnp.sum(jnp.abs(pulls.resultants.moment)) / radius

    def forces(self, ball: Any, rolls: Any, own: Any) -> tuple:
        """Return the motion of a ball, its sliding, tractions, and drag of the oil
        [N]."""
        whole = self.motion(ball, rolls, own)
        state = BallState(whole[:3], whole[3])
        moving = sliding(ball, state, self.speed)
        # All is linear in the speeds. At two contacts rolling does not slip, nor does
        # it spin on the outer one.
        free = sliding(ball, BallState(rolls[:3], rolls[3]), self.speed)
        slip, spin = free.slip, free.spin
        normal, _ = _axes(ball)
        sin, cos, radius = jnp.sin(ball.angle), jnp.cos(ball.angle), 0.5 * ball.diameter
        # Sine and cosine of the angle from the outer normal, and how far the contact
        # passes as the ball orbits without slip there.
        turn, same = (
            sin * normal[1] - cos * normal[2],
            cos * normal[1] + sin * normal[2],
        )
        first = ball.pitch_radius + radius * normal[1]
        passing = ball.side * first * same - ball.lever
        if len(ball.outwards) == 2:
            slip, spin = jnp.zeros_like(slip), spin.at[0].set(0.0)
            # Nor are there differences on the outer one, which round-off would fill.
            turn, passing = (v.at[0].set(0.0) for v in (turn, passing))
            same = same.at[0].set(1.0)
        _, slips, spins, orbit = own
        along = radius * (slips * same + (spins - orbit * normal[2]) * turn)
        slip = slip.at[:, 0].add(ball.side * along + orbit * passing)
        slip = slip.at[:, 1].add(ball.side * radius * own[0])
        spin = spin + spins * same - (slips + orbit * first / radius) * turn
        spin = spin + orbit * (sin - normal[2] * same)
        moving = moving._replace(slip=slip, spin=spin)
        drag = self.model.drag.force(
            state.orbit, ball.frontal_area, ball.pitch_radius, self.density
        )
        return state, moving, tractions(ball, self.model.traction, moving), drag

    def inertia(self) -> Float[Array, "unknown unknown"]:
        bearing, places = self.model.bearing, self.azimuth.shape[0]
        diameter, pitch = bearing.ball_diameter, bearing.pitch_diameter
        mass, moment = ball_mass(diameter, bearing.material.density)
        spin = moment / (0.5 * diameter)
        own = jnp.diag(jnp.stack([spin, spin, spin, 0.5 * mass * pitch]))
        own = own.at[1, 3].set(spin * pitch / diameter)
        whole = jnp.kron(jnp.eye(places, dtype=own.dtype), own)
        return jnp.pad(whole, (0, self.start.size - whole.shape[0]))

    def describe(self, y: Unknowns, solved: SolvedRow, **known: Any) -> SteadyMotion:
        speed, (own, _, _) = self.speed, self.parts(y)
        ball, rolls = self.bodies(y, solved)

        def describe_ball(ball, rolls, own):
            state, moving, pulls, drag = self.forces(ball, rolls, own)
            return state, moving, pulls, -drag * ball.pitch_radius * state.orbit

        state, moving, pulls, lost = jax.vmap(describe_ball)(ball, rolls, own)
        around = state.orbit
        # Means over time, not along the orbit: a ball spends longer where it is slow.
        still = around == 0
        time = jnp.where(still, 1.0, 1.0 / jnp.where(still, 1.0, around))
        share = time / jnp.sum(time)
        mean_orbit = jnp.sum(share * around)
        balls = self.model.bearing.n_elements

        def mean(values):
            return balls * jnp.sum(share * values)

        outer = ball.side > 0
        on_inner = mean(jnp.sum(jnp.where(outer, 0.0, pulls.ring_torque), axis=1))
        on_outer = mean(jnp.sum(jnp.where(outer, pulls.ring_torque, 0.0), axis=1))
        ahead = _lead(share) * ball.pitch_radius[0]
        return SteadySkid(
            contact_load=ball.load,
            contact_angle=ball.angle,
            orbit_speed=around,
            rolling_orbit_speed=rolls[:, 3],
            spin=state.spin,
            film=pulls.film,
            sliding=moving.slip,
            contact_spin=moving.spin,
            heat=pulls.resultants.heat,
            cage_speed=mean_orbit,
            wander=jnp.max(ahead) - jnp.min(ahead),
            ring_torque=jnp.stack([-on_outer, -on_inner]),
            friction_torque=driving(-on_outer, -on_inner, speed),
            power=Power(
                drive=-on_inner * speed.inner - on_outer * speed.outer,
                contacts=mean(jnp.sum(pulls.resultants.heat, axis=1)),
                drag=mean(lost),
                cage=jnp.zeros_like(mean_orbit),
            ),
            **known,
        )


def _axes(ball):
    """Return unit vectors of the outer raceway: normal n, the mean of its contacts,
    and the axis about which a ball turns as it rolls there."""
    if len(ball.outwards) == 2:
        cos, sin = jnp.cos(ball.angle[0]), jnp.sin(ball.angle[0])
    else:
        weight = jnp.where(ball.side > 0, ball.load + LEAST_LOAD, 0.0)
        cos, sin = weight @ jnp.cos(ball.angle), weight @ jnp.sin(ball.angle)
        length = jnp.sqrt(cos * cos + sin * sin)
        cos, sin = cos / length, sin / length
    none = jnp.zeros_like(cos)
    return jnp.stack([none, cos, sin]), jnp.stack([none, sin, -cos])


def _lead(share):
    """Return the lead of a ball over uniform motion, at the places [rad]."""
    count = share.shape[0]
    late = jnp.cumsum(share - 1.0 / count)
    # At the places themselves, by the trapezoidal rule.
    return -2.0 * jnp.pi * (late - 0.5 * (share - 1.0 / count))

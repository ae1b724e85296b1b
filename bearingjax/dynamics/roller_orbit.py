"""How skidding rollers move in the end: they all orbit with the cage.

In a roller bearing under radial load most rollers touch the outer raceway alone, and
the cage drives them: each has the orbital speed of the cage, and its own spin, which
repeats from orbit to orbit. The cage pushes a roller forwards or backwards with what
its tangential balance lacks; these forces add up to nothing.

Source: T. A. Harris, An Analytical Method to Predict Skidding in High Speed Roller
    Bearings, ASLE Transactions 9 (1966) 229-241, for the assumption; here with the
    inertia of the spin.
"""

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import n_elements
from ..element.inertia import Speed
from ..numerics.types import Scalar
from ..statics.solution import RollerSolution
from .loaded import loaded_rollers
from .model import SkidModel
from .orbit_search import AbstractOrbit, derivatives
from .roller_motion import (
    LoadedRoller,
    RollerState,
    rolling,
    sliding,
    tractions,
    unbalanced,
)
from .steady_results import Power, SteadyRollerSkid


class RollerOrbit(AbstractOrbit):
    """Equations of the rollers; unknowns are the spin at each place, and the orbit.

    Both are counted from pure rolling: where oil is stiff, slips are smaller than the
    round-off of the speeds, and so they are no differences of speeds.

    Attributes:
        model: The bearing, its oil and what surrounds the rollers.
        roller: A roller at all places (place,).
        rolls: Its motion in pure rolling (place,).
        speed: Ring speeds.
        density: Of the oil [kg/m³].
        along: Matrix of derivatives along the orbit (place, place) [1].
        start: As of `AbstractOrbit`.
    """

    model: SkidModel
    roller: LoadedRoller
    rolls: RollerState
    speed: Speed
    density: Scalar
    along: Float[Array, "place place"]
    start: Float[Array, " unknown"]

    def _local(self, roller, rolls, spin, slope, orbit):
        """Spin and orbit out of balance at one place [N], and the size of forces."""
        state, _, pulls, drag = self.forces(roller, rolls, spin, orbit)
        moment, force = unbalanced(roller, pulls, drag)
        radius = 0.5 * roller.diameter
        out = (moment - roller.moment * state.orbit * slope) / radius
        size = jnp.sum(jnp.abs(pulls.force)) + jnp.abs(drag)
        return (out, force), size

    def forces(self, roller, rolls, spin, orbit):
        """Motion of a roller, that against its raceways, tractions, and the force of
        the oil between the rings [N]; `spin` and `orbit` from pure rolling."""
        state = RollerState(rolls.spin + spin, rolls.orbit + orbit)
        # Linear in all speeds, and rolling does not slip.
        moving = sliding(roller, state, self.speed)._replace(
            slip=sliding(roller, RollerState(spin, orbit), Speed()).slip
        )
        drag = self.model.drag.force(
            state.orbit, roller.frontal_area, roller.pitch_radius, self.density
        )
        return state, moving, tractions(roller, self.model.traction, moving), drag

    def unbalanced(self, y):
        spin, orbit = y[:-1], y[-1]
        each = jax.vmap(self._local, in_axes=(0, 0, 0, 0, None))
        given = self.roller, self.rolls, spin, self.along @ spin, orbit
        (out, force), sizes = each(*given)
        return jnp.concatenate([out, jnp.mean(force, keepdims=True)]), sizes

    def jacobian(self, y):
        spin, orbit = y[:-1], y[-1]
        function = jax.jacfwd(self._local, argnums=(2, 3, 4), has_aux=True)
        each = jax.vmap(function, in_axes=(0, 0, 0, 0, None))
        given = self.roller, self.rolls, spin, self.along @ spin, orbit
        (of_out, of_force), _ = each(*given)
        own, sloped, orbiting = of_out
        spins = jnp.diag(own) + sloped[:, None] * self.along
        share = 1.0 / spin.shape[0]
        row = share * of_force[0]
        corner = jnp.mean(of_force[2], keepdims=True)
        upper = jnp.concatenate([spins, orbiting[:, None]], axis=1)
        return jnp.concatenate([upper, jnp.concatenate([row, corner])[None]])

    def inertia(self):
        roller = self.roller
        spin = roller.moment / (0.5 * roller.diameter)
        rollers = n_elements(self.model.bearing)
        radius = roller.pitch_radius[0]
        turn = roller.mass[0] * radius + self.model.cage.inertia / (rollers * radius)
        whole = jnp.diag(jnp.concatenate([spin, turn[None]]))
        return whole.at[:-1, -1].set(spin)

    def described(self, y, **known):
        roller, speed = self.roller, self.speed

        def one(roller, rolls, spin):
            state, moving, pulls, drag = self.forces(roller, rolls, spin, y[-1])
            push = jnp.sum(pulls.force) - drag
            lost = -drag * roller.pitch_radius * state.orbit
            return state, moving, pulls, push, lost

        found = jax.vmap(one)(roller, self.rolls, y[:-1])
        state, moving, pulls, push, lost = found
        rollers = n_elements(self.model.bearing)

        def mean(values):
            return rollers * jnp.mean(values)

        on_outer, on_inner = (mean(pulls.ring_torque[:, k]) for k in range(2))
        return SteadyRollerSkid(
            contact_load=roller.load,
            orbit_speed=state.orbit,
            rolling_orbit_speed=self.rolls.orbit,
            spin=state.spin,
            rolling_spin=self.rolls.spin,
            film=pulls.film,
            sliding=moving.slip,
            heat=pulls.heat,
            cage_speed=state.orbit[0],
            cage_force=push,
            friction_torque=-on_inner,
            power=Power(
                drive=-on_inner * speed.inner - on_outer * speed.outer,
                contacts=mean(jnp.sum(pulls.heat, axis=1)),
                drag=mean(lost),
                cage=jnp.zeros_like(y[-1]),
            ),
            **known,
        )


def roller_orbit(
    model: SkidModel,
    solution: RollerSolution,
    speed: Speed,
    load_speed: Speed,
    azimuth: Float[Array, " place"],
) -> RollerOrbit:
    """Equations of the rollers of a solved bearing.

    Args:
        model: The bearing, its oil and what surrounds the rollers.
        solution: Of its load.
        speed: Ring speeds.
        load_speed: Ring speeds of that solution.
        azimuth: The places, spread evenly (place,) [rad].
    """
    roller = loaded_rollers(model, solution.displacement, load_speed, azimuth)
    rolls = jax.vmap(partial(rolling, speed=speed))(roller)
    density = model.lubricant.density.at(model.temperature)
    along = jnp.asarray(derivatives(azimuth.shape[0]), azimuth.dtype)
    start = jnp.zeros(azimuth.shape[0] + 1, azimuth.dtype)
    return RollerOrbit(
        model=model,
        roller=roller,
        rolls=rolls,
        speed=speed,
        density=density,
        along=along,
        start=start,
    )

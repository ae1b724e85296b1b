"""Steady motion of skidding rollers, which all orbit with the cage.

In a roller bearing under radial load most rollers touch the outer raceway alone, and
the cage drives them: each has the orbital speed of the cage, and its own spin, which
repeats from orbit to orbit. The cage force on a roller closes its tangential balance;
these forces sum to zero.

Source: T. A. Harris, An Analytical Method to Predict Skidding in High Speed Roller
    Bearings, ASLE Transactions 9 (1966) 229-241, for the assumption; here with the
    inertia of the spin.
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...element.inertia import Speed, mass_and_inertia
from ...element.solved_row import RowResults, SolvedRow
from ...numerics.types import Reals, Scalar
from ..conditions import conditions_of
from ..contact_loads import loaded_rollers
from ..roller_motion import (
    LoadedRoller,
    RollerState,
    pure_rolling,
    residual_moments,
    sliding,
    tractions,
)
from .orbit_search import AbstractOrbit, Common, Own, Unknowns
from .steady_results import Power, SteadyMotion, SteadyRollerSkid, driving


class RollerOrbit(AbstractOrbit):
    """Equations of the rollers; unknowns are the spin at each place, and the orbit."""

    n_own: ClassVar = 1
    n_common: ClassVar = 1

    def excess(self, own: Float[Array, "place k"], common: Common) -> Reals:
        return common[0]

    def bodies_of(self, row: RowResults) -> tuple[Any, Array]:
        roller = loaded_rollers(row, self.model.oil)
        return roller, jax.vmap(self.rolls)(roller).spin[:, None]

    def rolls(self, roller: LoadedRoller) -> RollerState:
        """Motion of a roller in pure rolling."""
        return pure_rolling(roller, self.speed)

    def local(
        self, body: Any, rolls: Own, own: Own, slope: Own, common: Common
    ) -> tuple[Float[Array, " k+c"], Scalar]:
        state, _, pulls, drag = self.forces(body, own[0], common[0])
        moment, force = residual_moments(body, pulls, drag)
        radius = 0.5 * body.diameter
        out = (moment - body.moment * state.orbit * slope[0]) / radius
        size = jnp.sum(jnp.abs(pulls.force)) + jnp.abs(drag)
        return jnp.stack([out, force]), size

    def forces(self, roller: Any, spin: Any, orbit: Any) -> tuple:
        """Return the motion of a roller, its sliding, tractions, and the force of
        the oil between the rings [N]; `spin` and `orbit` from pure rolling."""
        rolls = self.rolls(roller)
        state = RollerState(rolls.spin + spin, rolls.orbit + orbit)
        # Linear in all speeds, and rolling does not slip.
        moving = sliding(roller, state, self.speed)._replace(
            slip=sliding(roller, RollerState(spin, orbit), Speed()).slip
        )
        drag = self.model.drag.force(
            state.orbit, roller.frontal_area, roller.pitch_radius, self.density
        )
        return state, moving, tractions(roller, self.model.traction, moving), drag

    def inertia(self) -> Float[Array, "unknown unknown"]:
        constants = self.model.element.model(self.speed).rows[0].element.constants
        mass, moment, _ = mass_and_inertia(constants)
        radius, spin = constants.pitch_radius, moment / (0.5 * constants.diameter)
        rollers, places = self.model.bearing.n_elements, self.azimuth.shape[0]
        turn = mass * radius + self.model.cage.inertia / (rollers * radius)
        own = jnp.full(places, spin)
        whole = jnp.diag(jnp.append(own, turn)).at[:-1, -1].set(own)
        return jnp.pad(whole, (0, self.start.size - whole.shape[0]))

    def describe(self, y: Unknowns, solved: SolvedRow, **known: Any) -> SteadyMotion:
        speed, (own, common, _) = self.speed, self.parts(y)
        roller, _ = self.bodies(y, solved)

        def describe_roller(roller, spin):
            state, moving, pulls, drag = self.forces(roller, spin, common[0])
            push = jnp.sum(pulls.force) - drag
            lost = -drag * roller.pitch_radius * state.orbit
            conditions = conditions_of(self.model, roller, moving, pulls.film)
            return state, self.rolls(roller), moving, pulls, push, lost, conditions

        found = jax.vmap(describe_roller)(roller, own[:, 0])
        state, rolls, moving, pulls, push, lost, conditions = found
        rollers = self.model.bearing.n_elements

        def mean(values):
            return rollers * jnp.mean(values)

        on_outer, on_inner = (mean(pulls.ring_torque[:, k]) for k in range(2))
        return SteadyRollerSkid(
            contact_load=roller.load,
            orbit_speed=state.orbit,
            rolling_orbit_speed=rolls.orbit,
            spin=state.spin,
            rolling_spin=rolls.spin,
            film=pulls.film,
            sliding=moving.slip,
            heat=pulls.heat,
            cage_speed=state.orbit[0],
            cage_force=push,
            conditions=conditions,
            ring_torque=jnp.stack([-on_outer, -on_inner]),
            friction_torque=driving(-on_outer, -on_inner, speed),
            power=Power(
                drive=-on_inner * speed.inner - on_outer * speed.outer,
                contacts=mean(jnp.sum(pulls.heat, axis=1)),
                drag=mean(lost),
                cage=jnp.zeros_like(common[0]),
            ),
            **known,
        )

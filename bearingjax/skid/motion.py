"""Motion of all balls or rollers of a bearing and its cage, with its derivatives.

Both have equations of the same names, in `ball_motion` and `roller_motion`, chosen by
the type of their loads. Below, balls are balls or rollers.

A ball's place is its lead over its pocket, so that the pocket's force depends on one
small number. Balls are coupled through the cage, and through the ring where it is in
equilibrium at every time; so they are the bodies of an `AbstractSystem`.

The force of a pocket has a kink where contact begins; it is kept, not rounded off. The
force itself is continuous and has a potential, so that the power balance is exact, and
the pocket clearance stays what it is; the step control makes a few short steps there.
"""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import AbstractBearing
from ..numerics.types import Scalar
from ..numerics.units import unit
from . import ball_motion, roller_motion
from .balanced_loads import BalancedLoads
from .ball_motion import BallState, LoadedBall
from .coupled import AbstractSystem, CoupledState, Masses
from .load_table import LoadTable
from .model import SkidModel
from .ring_speed import SpeedTable
from .roller_motion import LoadedRoller, RollerState

_REST = 1e-8
"""Time in which a residual force moves ring and balls by their unit [s]: without load
the ring has no stiffness, and the equilibrium would be singular. Under a load that
varies at 200 rad/s the residual is some 1e-5 of the largest contact load."""


class Work(NamedTuple):
    """Work [J] or power [W]: that of the drive is the sum of the others and of storage.

    Attributes:
        drive: Drive of the rings.
        contacts: Heat of the raceway contacts.
        drag: Lost in the oil between the rings.
    """

    drive: Annotated[Array, unit("W")]
    contacts: Annotated[Array, unit("W")]
    drag: Annotated[Array, unit("W")]


class SkidState(NamedTuple):
    """Motion of all balls and the cage, and position of the ring.

    Attributes:
        spin: Spin of each ball relative to its orbiting frame, tangential, radial,
            axial (ball, 3); of a roller about its axis (roller, 1) [rad/s].
        orbit: Orbital speeds (ball,) [rad/s].
        lead: Angle by which each ball is ahead of the middle of its pocket (ball,)
            [rad].
        cage_speed: Speed of the cage [rad/s].
        cage_turn: Angle by which the cage has turned [rad].
        centre: Centre of each ball (z, r) from where the rings take it (ball, 2) [m].
        ring: Unknowns of the ring's balance (6,) [m].

    Where the loads are tabulated there is nothing in centre (ball, 0) and ring (0,).
    """

    spin: Annotated[Float[Array, "ball axis"], unit("rad/s")]
    orbit: Annotated[Float[Array, " ball"], unit("rad/s")]
    lead: Annotated[Float[Array, " ball"], unit("rad")]
    cage_speed: Annotated[Scalar, unit("rad/s")]
    cage_turn: Annotated[Scalar, unit("rad")]
    centre: Annotated[Float[Array, "ball z"], unit("m")]
    ring: Annotated[Float[Array, " unknown"], unit("m")]


def rest_state(bearing: AbstractBearing) -> SkidState:
    """Return the state of elements and cage at rest, each element in the middle of its
    pocket, for loads that are tabulated: the `start` of `simulate`.

    Args:
        bearing: The bearing, one row.
    """
    count, spins = bearing.n_elements, 3 if bearing.is_ball else 1
    zero, each = jnp.zeros(()), jnp.zeros(count)
    nothing = jnp.zeros((count, 0)), jnp.zeros(0)
    return SkidState(jnp.zeros((count, spins)), each, each, zero, zero, *nothing)


class Surroundings(eqx.Module):
    """Surroundings of the balls.

    Attributes:
        model: Traction law, drag, cage.
        loads: Contact loads of the balls.
        speed: Speed of the rings, over time.
        place: Azimuths of the pockets at rest (ball,) [rad].
        density: Density of the oil [kg/m³].
        gravity: Acceleration against y [m/s²].
    """

    model: SkidModel
    loads: LoadTable | BalancedLoads
    speed: SpeedTable
    place: Float[Array, " ball"]
    density: Scalar
    gravity: Scalar


class ElementState(NamedTuple):
    """A ball at an instant.

    Attributes:
        ball: Its loads: `LoadedBall` or `LoadedRoller`.
        azimuth: Azimuth of the ball [rad].
        state: Its motion: `BallState` or `RollerState`.
        moving: Its motion against the raceways: `Sliding` or `RollerSliding`.
        pulls: `Tractions` or `RollerTractions`.
        push: Force of the cage, in the sense in which angles are counted [N].
        drag: Force of the oil, likewise [N].
        weight: Force of gravity, likewise [N].
        unbalanced: Force on it in its section that is not balanced [N].
        on_ring: Its share of the force that holds the ring [N].
    """

    ball: Any
    azimuth: Annotated[Scalar, unit("rad")]
    state: Any
    moving: Any
    pulls: Any
    push: Annotated[Scalar, unit("N")]
    drag: Annotated[Scalar, unit("N")]
    weight: Annotated[Scalar, unit("N")]
    unbalanced: Annotated[Float[Array, " z"], unit("N")]
    on_ring: Annotated[Float[Array, " unknown"], unit("N")]

    @property
    def ring_torque(self) -> tuple[Scalar, Scalar]:
        """On the inner and on the outer ring about the bearing axis [N m]."""
        torque, outer = self.pulls.ring_torque, self.ball.side > 0
        on_inner = jnp.sum(jnp.where(outer, 0.0, torque))
        return on_inner, jnp.sum(jnp.where(outer, torque, 0.0))


def equations_of_motion(ball: LoadedBall | LoadedRoller) -> Any:
    """Return the module of the equations of motion."""
    return roller_motion if isinstance(ball, LoadedRoller) else ball_motion


def one_ball(
    environment: Surroundings, time: Scalar, place: Scalar, state: SkidState
) -> ElementState:
    """Return a ball at an instant.

    Args:
        environment: Surroundings of the balls.
        time: Time [s].
        place: Azimuth of its pocket at rest [rad].
        state: State of this ball alone, with cage and ring.
    """
    model, azimuth = environment.model, place + state.cage_turn + state.lead
    speed = environment.speed.at(time)
    here = azimuth, speed, state.centre, state.ring
    ball, unbalanced, on_ring = environment.loads.ball_at(*here)
    equations, motion = equations_of_motion(ball), BallState(state.spin, state.orbit)
    if isinstance(ball, LoadedRoller):
        motion = RollerState(state.spin[0], state.orbit)
    moving = equations.sliding(ball, motion, speed)
    turning = state.orbit, ball.frontal_area, ball.pitch_radius
    return ElementState(
        ball,
        azimuth,
        motion,
        moving,
        equations.tractions(ball, model.traction, moving),
        model.cage.force(-state.lead * ball.pitch_radius),
        model.drag.force(*turning, environment.density),
        -ball.mass * environment.gravity * jnp.cos(azimuth),
        unbalanced,
        on_ring,
    )


_AXES: Any = (0, 0, 0, None, None, 0, None)
"""Axes of the balls in their state."""


def each_ball(
    environment: Surroundings, time: Scalar, state: SkidState
) -> ElementState:
    """Return all balls at an instant, leading axis ball; arguments as in `one_ball`."""

    def rates_of(place, state):
        return one_ball(environment, time, place, state)

    return jax.vmap(rates_of, in_axes=(0, SkidState(*_AXES)))(environment.place, state)


def power(environment: Surroundings, time: Scalar, ball: ElementState) -> Work:
    """Return the powers of one ball [W]; arguments as in `one_ball`."""
    speed, (on_inner, on_outer) = environment.speed.at(time), ball.ring_torque
    return Work(
        drive=-on_inner * speed.inner - on_outer * speed.outer,
        contacts=jnp.sum(ball.pulls.heat),
        drag=-ball.drag * ball.ball.pitch_radius * ball.state.orbit,
    )


def energies(environment: Surroundings, ball: ElementState) -> tuple[Scalar, Scalar]:
    """Return kinetic and potential energy, of pocket and weight, of a ball [J]."""
    of_ball, cage = ball.ball, environment.model.cage
    height = of_ball.pitch_radius * jnp.sin(ball.azimuth)
    pressed = ball.push**2 / (2.0 * cage.stiffness)
    weight = of_ball.mass * environment.gravity * height
    kinetic = equations_of_motion(of_ball).kinetic_energy(of_ball, ball.state)
    return kinetic, pressed + weight


class SkidSystem(AbstractSystem):
    """Balls and cage as bodies with shared unknowns, in units of their own.

    Attributes:
        environment: Surroundings of the balls.
        speed: Unit of speeds [rad/s].
        energy: Unit of work [J].
    """

    environment: Surroundings
    speed: Scalar
    energy: Scalar

    @property
    def bodies(self) -> Float[Array, " ball"]:
        """Azimuths of the pockets at rest [rad]."""
        return self.environment.place

    @property
    def masses(self) -> Masses:
        """Masses: 1 for speeds and angles; balls and ring are in equilibrium at every
        time, except for a ring without stiffness."""
        loads, real = self.environment.loads, self.speed.dtype
        own = [1.0] * (loads.n_spins + 2) + [_REST] * loads.n_own
        shared = [1.0] * 2 + [_REST] * loads.n_shared
        return Masses(jnp.asarray(own, real), jnp.asarray(shared, real))

    @property
    def _units(self):
        """Units of the unknowns: of a ball, and shared."""
        loads, one = self.environment.loads, jnp.ones_like(self.speed)
        own = (
            [self.speed] * (loads.n_spins + 1)
            + [one]
            + [loads.unit * one] * loads.n_own
        )
        shared = [self.speed, one] + [loads.unit * one] * loads.n_shared
        return jnp.stack(own), jnp.stack(shared)

    def pack(self, state: SkidState) -> CoupledState:
        """Return the unknowns of a motion, with zero work."""
        of_balls = state.orbit[:, None], state.lead[:, None]
        own = jnp.concatenate([state.spin, *of_balls, state.centre], axis=1)
        of_cage = jnp.stack([state.cage_speed, state.cage_turn])
        shared = jnp.concatenate([of_cage, state.ring])
        units = self._units
        own = own / units[0][None, :]
        return CoupledState(own, shared / units[1], jnp.zeros(3, own.dtype))

    def unpack(self, packed: CoupledState) -> tuple[SkidState, Work]:
        """Return the motion and the work done."""
        work = Work(*(packed.sums * self.energy))
        return self._state(packed.own, packed.shared), work

    def _state(self, own, shared):
        """Return the state of one ball or of all, with cage and ring."""
        units = self._units
        own = own * jnp.broadcast_to(units[0], own.shape)
        shared = shared * units[1]
        n = self.environment.loads.n_spins
        of_ball = own[..., :n], own[..., n], own[..., n + 1]
        return SkidState(*of_ball, shared[0], shared[1], own[..., n + 2 :], shared[2:])

    def body(
        self,
        which: Any,
        time: Scalar,
        own: Float[Array, " k"],
        shared: Float[Array, " m"],
    ) -> tuple[Float[Array, " k"], Float[Array, " m"], Float[Array, " w"]]:
        """Return rates and powers of a ball, as `AbstractSystem`."""
        environment, state = self.environment, self._state(own, shared)
        ball = one_ball(environment, time, which, state)
        force = ball.push + ball.drag + ball.weight
        change = equations_of_motion(ball.ball).rates(
            ball.ball, ball.state, ball.pulls, force
        )
        turning = jnp.stack([change.orbit, state.orbit - state.cage_speed])
        of_cage = -ball.ball.pitch_radius * ball.push / environment.model.cage.inertia
        of_cage = jnp.stack([of_cage, jnp.zeros_like(of_cage)])
        # Forces out of balance, in units so large as the lengths that they move.
        yielding = environment.loads.unit / environment.loads.force
        spins = jnp.reshape(change.spin, (-1,))
        own = jnp.concatenate([spins, turning, yielding * ball.unbalanced])
        shared = jnp.concatenate([of_cage, -yielding * ball.on_ring])
        work = jnp.stack(list(power(environment, time, ball)))
        units = self._units
        return own / units[0], shared / units[1], work / self.energy

    def shared_rates(
        self, time: Scalar, shared: Float[Array, " m"]
    ) -> tuple[Float[Array, " m"], Float[Array, " w"]]:
        """Return rates from cage rotation and ring load, as `AbstractSystem`."""
        loads, units = self.environment.loads, self._units[1]
        own = shared * units
        turning = jnp.stack([jnp.zeros_like(own[0]), own[0]])
        push = loads.push(time, own[2:]) * (loads.unit / loads.force)
        changes = jnp.concatenate([turning, push]) / units
        return changes, jnp.zeros(3, changes.dtype)

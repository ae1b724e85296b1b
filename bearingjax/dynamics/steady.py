"""The state in which skidding balls end, without the way there.

Under an axial load every ball moves evenly: four equations. Otherwise its motion
repeats from orbit to orbit, and is found as a whole: at places spread evenly over the
orbit, with derivatives along it by the interpolating trigonometric polynomial. The
cage keeps out of it: balls are free in their pockets, and `SteadySkid.wander` says
whether the pockets are wide enough for that.

The search is an implicit integration in time with steps that grow as it calms down: it
begins as the motion would, from pure rolling, and ends as Newton's method.
"""

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design.checks import is_traced
from ..element.ball_speed import ball_kinematics
from ..element.inertia import Speed
from ..numerics import lanes
from ..numerics.implicit import attach_by, stop, unless_failed
from ..numerics.linear import solve
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar, namespace
from ..numerics.units import unit
from ..statics.balls import BallResults
from ..statics.load import solve_load
from .ball_motion import BallState, LoadedBall, sliding, tractions, unbalanced
from .loaded import contact_loads, loaded_ball
from .model import SkidModel

_STEPS = 300
_TOLERANCE = {"float64": 1e-10, "float32": 1e-3}
_FIRST = 1e-5
"""First step in time [s]."""
_PLACES = 96
"""Least number of places along an orbit."""


class Power(NamedTuple):
    """Mean powers [W]: the drive's is the sum of the others.

    Attributes:
        drive: What turns the rings.
        contacts: Heat of the raceway contacts.
        drag: Lost in the oil between the rings.
        cage: Lost at the cage.
    """

    drive: Scalar
    contacts: Scalar
    drag: Scalar
    cage: Scalar


class SteadySkid(eqx.Module):
    """How skidding balls move in the end. Axes: place along the orbit; contact, as of
    `BallResults`.

    Attributes:
        solution: The bearing under its load.
        azimuth: The places (place,) [rad]; one place stands for all under an axial
            load.
        contact_load: Loads (place, contact) [N].
        contact_angle: Angles (place, contact) [rad].
        orbit_speed: Of the ball (place,) [rad/s].
        rolling_orbit_speed: With outer raceway control at the contact angles (place,)
            [rad/s].
        spin: Of the ball relative to its orbiting frame, tangential, radial, axial
            (place, 3) [rad/s].
        film: Central films (place, contact) [m].
        sliding: Slip in the middle of the contacts, along the rolling direction and
            across (place, contact, 2) [m/s].
        contact_spin: About the contact normals (place, contact) [rad/s].
        heat: Of each contact (place, contact) [W].
        cage_speed: Mean orbital speed [rad/s].
        wander: How far a ball goes ahead of even motion and falls behind it, together
            [m]: less than the pocket clearance, or the cage takes part.
        friction_torque: That turns the inner ring, the mean over the orbit [N m].
        power: Mean powers.
        residual: Force out of balance relative to the tractions [1].
        steps: Steps of the search.
        result: `Result` code.
    """

    solution: BallResults
    azimuth: Float[Array, " place"] = eqx.field(metadata=unit("rad"))
    contact_load: Float[Array, "place contact"] = eqx.field(metadata=unit("N"))
    contact_angle: Float[Array, "place contact"] = eqx.field(metadata=unit("rad"))
    orbit_speed: Float[Array, " place"] = eqx.field(metadata=unit("rad/s"))
    rolling_orbit_speed: Float[Array, " place"] = eqx.field(metadata=unit("rad/s"))
    spin: Float[Array, "place 3"] = eqx.field(metadata=unit("rad/s"))
    film: Float[Array, "place contact"] = eqx.field(metadata=unit("m"))
    sliding: Float[Array, "place contact 2"] = eqx.field(metadata=unit("m/s"))
    contact_spin: Float[Array, "place contact"] = eqx.field(metadata=unit("rad/s"))
    heat: Float[Array, "place contact"] = eqx.field(metadata=unit("W"))
    cage_speed: Scalar = eqx.field(metadata=unit("rad/s"))
    wander: Scalar = eqx.field(metadata=unit("m"))
    friction_torque: Scalar = eqx.field(metadata=unit("N m"))
    power: Power
    residual: Scalar = eqx.field(metadata=unit("1"))
    steps: Int[Array, ""]
    result: Int[Array, ""]

    @property
    def slip(self) -> Float[Array | np.ndarray, "*n place"]:
        """1 - orbit/rolling orbit (place,) [1]."""
        return 1.0 - self.orbit_speed / self.rolling_orbit_speed

    @property
    def sliding_speed(self) -> Float[Array | np.ndarray, "*n place contact"]:
        """Sizes of `sliding` (place, contact) [m/s]."""
        return namespace(self.sliding).sqrt((self.sliding**2).sum(axis=-1))

    @property
    def pitch_angle(self) -> Float[Array | np.ndarray, "*n place"]:
        """Angle between spin axis and bearing axis (place,) [rad]."""
        return namespace(self.spin).arctan2(self.spin[..., 1], -self.spin[..., 2])


def steady_skid(
    model: SkidModel,
    load: Any,
    *,
    speed: Speed,
    places: int | None = None,
    prescribed: Any = None,
    free: Sequence[str] | None = None,
    fixed_ring: str = "outer",
    throw: bool = True,
) -> SteadySkid:
    """How the balls of a bearing skid in the end.

    Args:
        model: The bearing, its oil and what surrounds the balls.
        load: On the moving ring, as of `solve_load` (6,) [N, N m].
        speed: Ring speeds.
        places: Places along the orbit, a multiple of the number of balls, or 1 where
            all balls bear the same; static. Default: 1 if they do, else at least 96 (so
            too if it cannot be known, because the load is traced).
        prescribed, free, fixed_ring: As of `solve_load`.
        throw: Raise if it cannot be solved; otherwise read `result`.

    Returns:
        The motion, differentiable with respect to design, oil, load and speeds.

    Errors of the places, of the orbit speed of an angular contact bearing at 250 N
        axially and 160 N radially, against an integration in time: 3e-4 with 50, 2e-6
        with 100, 3e-8 with 200. More slip in a narrow zone needs more.

    Raises:
        ValueError: For a number of places that does not suit.
        SolveError: If not solved, and `throw` is set.

    Fails: codes of the load solve; `STEP_LIMIT`, `NON_FINITE`; `GRID_MISFIT` if one
        place stands for balls that bear unlike loads.
    """
    solution = solve_load(
        model.element,
        load,
        speed=speed,
        prescribed=prescribed,
        free=free,
        fixed_ring=fixed_ring,
        throw=throw,
    )
    count = _places(model, solution, places)
    found = _steady(model, solution, speed, count)
    if not throw:
        return found
    return raise_unless_converged(found, found.result, lambda: _message(found))


def _places(model, solution, places):
    balls = solution.azimuth.shape[-1]
    known = not is_traced(solution.contact_load)
    if places is None:
        if known and not bool(_unlike(solution)):
            return 1
        return balls * -(-_PLACES // balls)
    if known and places == 1 and bool(_unlike(solution)):
        raise ValueError(
            "steady_skid: `places` is 1, but the balls bear unlike loads; it must be a"
            f" multiple of the {balls} balls."
        )
    if places != 1 and (places % balls or places < 1):
        raise ValueError(
            f"steady_skid: `places` is {places}; it must be 1 or a multiple of the"
            f" {balls} balls."
        )
    return places


def _unlike(solution):
    """Whether the balls bear unlike loads."""
    loads = solution.contact_load
    spread = jnp.max(loads, axis=0) - jnp.min(loads, axis=0)
    return jnp.any(spread > 1e-6 * jnp.max(loads))


def _message(found):
    label = Result(int(found.result)).label
    return (
        f"steady_skid: {label} after {int(found.steps)} steps; force out of balance"
        f" {float(found.residual):.1e} of the tractions."
    )


class _Given(NamedTuple):
    """What the search is given; leading axis place.

    `along` is the matrix of derivatives along the orbit.
    """

    model: SkidModel
    ball: LoadedBall
    speed: Speed
    density: Scalar
    along: Float[Array, "place place"]
    start: Float[Array, "place 4"]


class _State(NamedTuple):
    y: Float[Array, "place 4"]
    out: Float[Array, "place 4"]
    size: Scalar
    goal: Scalar
    step: Scalar
    steps: Int[Array, ""]


@partial(eqx.filter_jit)
def _steady(model, solution, speed, count) -> SteadySkid:
    bearing, law = model.bearing, model.point_law
    bearing_model = model.element.model(speed)
    turn = jnp.asarray(2.0 * np.pi * np.arange(count) / count, model.temperature.dtype)
    azimuth = solution.azimuth[0] + turn
    at = bearing_model, bearing, law, solution.displacement, azimuth
    load, angle = contact_loads(*at)
    oil = model.lubricant, model.temperature, model.least_film
    ball = jax.vmap(partial(loaded_ball, bearing, law, *oil))(load, angle)
    rolling = jax.vmap(partial(rolling_ball, speed))(ball)
    start = jnp.stack(
        [
            jnp.zeros_like(rolling.orbit),
            rolling.rotation * rolling.axis[:, 0],
            -rolling.rotation * rolling.axis[:, 1],
            rolling.orbit,
        ],
        axis=1,
    )
    density = model.lubricant.density.at(model.temperature)
    along = jnp.asarray(_derivatives(count), azimuth.dtype)
    given = _Given(model, ball, speed, density, along, start)
    loop = lanes.Loop(_init, _step, _terminate, _finish)
    y, residual, steps, result = lanes.run(loop, stop(given), 16 if count == 1 else 2)
    if count == 1:
        # One ball does not stand for all.
        misfit = _unlike(solution) & (result == int(Result.CONVERGED))
        result = jnp.where(misfit, int(Result.GRID_MISFIT), result)
    result = jnp.maximum(result, solution.result).astype(jnp.int32)
    y = attach_by(_residual, y, given, _correction)
    y = unless_failed(y, result == int(Result.CONVERGED))
    return _results(given, solution, azimuth, y, rolling, residual, steps, result)


def rolling_ball(speed, ball):
    """Outer raceway control at the contact angles."""
    direction = jnp.stack([jnp.sin(ball.angle), jnp.cos(ball.angle)], axis=1)
    half = len(ball.outwards) // 2
    weighted = (ball.load + 1e-9)[:, None] * direction
    sums = weighted[:half].sum(axis=0), weighted[half:].sum(axis=0)
    outer, inner = (v / jnp.sqrt(v @ v) for v in sums)
    ratio = 0.5 * ball.diameter / ball.pitch_radius
    return ball_kinematics(outer, inner, jnp.ones_like(ratio), ratio, speed)


def _derivatives(count):
    """Matrix of d/dφ on an even grid: of the trigonometric interpolant."""
    if count == 1:
        return np.zeros((1, 1))
    k = np.arange(count)
    apart = k[:, None] - k[None, :]
    angle = np.pi * apart / count
    with np.errstate(divide="ignore"):
        ends = 1.0 / (np.tan(angle) if count % 2 == 0 else np.sin(angle))
    return np.where(apart == 0, 0.0, 0.5 * (-1.0) ** apart * ends)


def _local(given, ball, y, slope):
    """Forces out of balance of one place [N], and how large those are that cancel.

    Args:
        given: `_Given`.
        ball: The ball at that place.
        y: Its spin and orbit (4,).
        slope: How they change along the orbit (4,).
    """
    model, state = given.model, BallState(y[:3], y[3])
    drag = model.drag.force(
        state.orbit, ball.diameter, ball.pitch_radius, given.density
    )
    pulls = tractions(ball, model.traction, sliding(ball, state, given.speed))
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


def _evaluated(given, y):
    return jax.vmap(partial(_local, given))(given.ball, y, given.along @ y)


def _residual(y, given):
    return _evaluated(given, y)[0]


def _jacobian(given, y):
    """Of `_residual` (place·4, place·4)."""
    function = jax.jacfwd(partial(_local, given), argnums=(1, 2), has_aux=True)
    (own, sloped), _ = jax.vmap(function)(given.ball, y, given.along @ y)
    count = y.shape[0]
    if count == 1:
        return own[0]
    eye = jnp.eye(count, dtype=y.dtype)
    whole = jnp.einsum("kl,kij->kilj", eye, own)
    whole = whole + jnp.einsum("kl,kij->kilj", given.along, sloped)
    return whole.reshape(4 * count, 4 * count)


def _inertia(given):
    """Mass matrix that belongs to `_residual` (place·4, place·4)."""
    ball = given.ball
    spin, turn = ball.moment / (0.5 * ball.diameter), ball.mass * ball.pitch_radius
    own = jnp.stack([spin, spin, spin, turn], axis=1)
    whole = jnp.diag(own.reshape(-1))
    axial = 4 * jnp.arange(spin.shape[0]) + 2
    return whole.at[axial, axial + 1].set(spin)


def _solve(matrix, right):
    """Of a matrix with positive diagonal."""
    if right.shape[0] == 4:
        return solve(matrix, right, False)
    return jnp.linalg.solve(matrix, right)


def _init(given):
    none = jnp.zeros_like(given.start[0, 0])
    nothing = jnp.zeros_like(given.start)
    first = jnp.full_like(none, _FIRST)
    return _State(given.start, nothing, none, none, first, jnp.full((), -1, jnp.int32))


def _step(given, state):
    first = state.steps < 0
    matrix = _jacobian(given, state.y)
    shifted = _inertia(given) / state.step - matrix
    move = _solve(shifted, state.out.reshape(-1)).reshape(state.y.shape)
    y = jnp.where(first, state.y, state.y + move)
    out, sizes = _evaluated(given, y)
    size = jnp.max(jnp.abs(out))
    # Round-off of the speeds, in the stiffness of the film.
    tiny = jnp.finfo(y.dtype).eps
    noise = 8.0 * tiny * jnp.max(jnp.abs(matrix) @ jnp.abs(y.reshape(-1)))
    goal = _TOLERANCE[str(y.dtype)] * jnp.max(sizes) + noise
    ratio = state.size / jnp.maximum(size, jnp.finfo(y.dtype).tiny)
    taken = first | (ratio > 0.5)
    longer = state.step * jnp.clip(2.0 * ratio, 1.5, 10.0)
    step = jnp.where(taken, longer, 0.2 * state.step)
    new = _State(
        y, out, size, goal, jnp.where(first, state.step, step), state.steps + 1
    )
    kept = state._replace(step=step, steps=state.steps + 1)
    return lanes.Either(taken, new, kept)


def _terminate(given, state):
    finite = jnp.isfinite(state.step) & jnp.all(jnp.isfinite(state.y))
    going = (state.size > state.goal) & finite & (state.steps < _STEPS)
    return (state.steps >= 0) & ~going


def _finish(given, state):
    finite = jnp.all(jnp.isfinite(state.y)) & jnp.isfinite(state.size)
    done = state.size <= state.goal
    result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
    result = jnp.where(finite, result, int(Result.NON_FINITE)).astype(jnp.int32)
    scale = jnp.maximum(state.goal, jnp.finfo(state.goal.dtype).tiny)
    tolerance = _TOLERANCE[str(state.y.dtype)]
    return state.y, tolerance * state.size / scale, state.steps, result


def _correction(of_y, y, change, given):
    # Traction resists: it is the negative Jacobian whose diagonal is positive.
    return _solve(-_jacobian(given, y), change.reshape(-1)).reshape(y.shape)


def _results(given, solution, azimuth, y, rolling, residual, steps, result):
    model, ball, speed = given.model, given.ball, given.speed

    def one(ball, y):
        state = BallState(y[:3], y[3])
        moving = sliding(ball, state, speed)
        pulls = tractions(ball, model.traction, moving)
        drag = model.drag.force(
            state.orbit, ball.diameter, ball.pitch_radius, given.density
        )
        lost = -drag * ball.pitch_radius * state.orbit
        return moving, pulls, lost

    moving, pulls, lost = jax.vmap(one)(ball, y)
    orbit = y[:, 3]
    # In time, not along the orbit: a ball is longer where it is slow.
    still = orbit == 0
    time = jnp.where(still, 1.0, 1.0 / jnp.where(still, 1.0, orbit))
    share = time / jnp.sum(time)
    mean_orbit = jnp.sum(share * orbit)
    balls = solution.azimuth.shape[0]

    def mean(values):
        return balls * jnp.sum(share * values)

    outer = ball.side > 0
    on_inner = mean(jnp.sum(jnp.where(outer, 0.0, pulls.ring_torque), axis=1))
    on_outer = mean(jnp.sum(jnp.where(outer, pulls.ring_torque, 0.0), axis=1))
    ahead = _ahead(share) * ball.pitch_radius[0]
    return SteadySkid(
        solution=solution,
        azimuth=azimuth,
        contact_load=ball.load,
        contact_angle=ball.angle,
        orbit_speed=orbit,
        rolling_orbit_speed=rolling.orbit,
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
        residual=residual,
        steps=steps,
        result=result,
    )


def _ahead(share):
    """How far a ball is ahead of even motion, at the places [rad]."""
    count = share.shape[0]
    late = jnp.cumsum(share - 1.0 / count)
    # At the places themselves, by the trapezoidal rule.
    return -2.0 * jnp.pi * (late - 0.5 * (share - 1.0 / count))

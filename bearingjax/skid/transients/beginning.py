"""Surroundings and initial motion of the balls or rollers of a solved bearing."""

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np

from ...element.inertia import Speed
from ...numerics.compiled.programs import program
from ...numerics.implicit import stop_gradient
from ...numerics.types import Scalar
from ...statics.balance import Balance
from ...statics.solution import BallSolution, RollerSolution
from ..balanced_loads import BalancedLoads
from ..contact_loads import (
    at_places,
    contact_ellipses,
    contact_loads,
    loaded_ball,
    loaded_rollers,
)
from ..load_table import load_table
from ..model import SkidModel
from ..motion import SkidState, Surroundings, equations_of_motion
from ..ring_speed import SpeedTable


def _tabulate_loads(model, solution, speed, places):
    """Tabulate the loads of balls or rollers around a bearing solved at a speed."""
    azimuth = solution.azimuth[:1]
    if places > 1:
        even = 2.0 * np.pi * np.arange(places) / places
        azimuth = jnp.asarray(even, solution.azimuth.dtype)
    there = at_places(model.element.model(speed), solution.displacement, azimuth)
    if not isinstance(solution, BallSolution):
        return load_table(loaded_rollers(there, model.oil))
    bearing, law = model.bearing, model.point_law
    at = contact_loads(there, bearing, law)
    balls = jax.vmap(partial(loaded_ball, bearing, law, model.oil))(*at)
    return load_table(balls)


@program(quick=True)
def surroundings(
    model: SkidModel,
    solution: BallSolution | RollerSolution,
    load_speed: Speed,
    speed: SpeedTable,
    gravity: Scalar,
    places: int,
) -> tuple[Surroundings, SkidState]:
    """Return surroundings of the balls of a solved bearing, and pure rolling as start.

    Args:
        model: The bearing and its oil.
        solution: Solution under its load.
        load_speed: Ring speeds of that solution.
        speed: Ring speeds over time.
        gravity: Against y [m/s²].
        places: Places of the table. Static.
    """
    table = _tabulate_loads(model, solution, load_speed, places)
    centre = jnp.zeros((*solution.azimuth.shape, 0))
    return _begin(model, table, solution, speed, gravity, centre, jnp.zeros(0))


@program(quick=True)
def balanced_surroundings(
    model: SkidModel,
    solution: BallSolution,
    balance: Balance,
    load: Callable,
    speed: SpeedTable,
    gravity: Scalar,
) -> tuple[Surroundings, SkidState]:
    """Return `surroundings` for a ring that is in equilibrium at every time.

    Args:
        model, solution, speed, gravity: As in `surroundings`.
        balance: Balance of the ring, with its free freedoms.
        load: Function of time [s] (6,) [N, N m].
    """
    q, zero = solution.displacement, jnp.zeros_like(speed.time[0])
    now = model.element.model(speed.at(zero))
    row, prepared = now.rows[0], now if speed.time.shape[0] == 1 else None
    solved = row.solve(q, solution.azimuth, now.equilibrium, None)
    ring, centre = q[balance.moving_slice] / balance.scale, solved.state.x
    size = 1.0 + jnp.max(jnp.abs(solution.contact_load))
    unit = 1e-3 * model.bearing.ball_diameter
    law, ellipses = model.point_law, None
    if not law.curvature_follows_angle:
        cosines = jnp.ones_like(solution.contact_angle[0])
        ellipses = contact_ellipses(model.bearing, law, cosines)
    known = prepared, ellipses
    loads = BalancedLoads(model, *known, balance, load, *stop_gradient((unit, size)))
    return _begin(model, loads, solution, speed, gravity, centre, ring)


def _begin(model, loads, solution, speed, gravity, centre, ring):
    density = model.lubricant.density.at(model.temperature)
    environment = Surroundings(model, loads, speed, solution.azimuth, density, gravity)
    return environment, _rolling_start(environment, centre, ring)


def _rolling_start(environment, centre, ring):
    """Return the state of pure rolling, with balls or rollers in mid pocket."""
    speed = environment.speed.at(environment.speed.time[0] * 0.0)
    ball, _, _ = jax.vmap(lambda at, c: environment.loads.ball_at(at, speed, c, ring))(
        environment.place, centre
    )
    rolling = jax.vmap(partial(equations_of_motion(ball).pure_rolling, speed=speed))(
        ball
    )
    spin = rolling.spin.reshape(*rolling.orbit.shape, -1)
    none, turning = jnp.zeros_like(rolling.orbit), jnp.mean(rolling.orbit)
    return SkidState(spin, rolling.orbit, none, turning, none[0], centre, ring)

"""Steady state of skidding balls and rollers, without time integration.

Balls are free in their pockets: the cage keeps out of it, and `SteadySkid.wander` says
whether the pockets are wide enough for that (`ball_orbit`). Rollers are carried round
by the cage (`roller_orbit`).
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from ...design import AbstractBallBearing, AbstractRollerBearing
from ...design.abstract import nearest_entry
from ...design.bearing_set import pitch_radius
from ...design.checks import is_traced
from ...element.inertia import Speed
from ...numerics.compiled.programs import program
from ...numerics.result import Result, raise_unless_converged
from ...statics.balance import balance_of
from ...statics.load import raise_if_failed, solve
from ...statics.load_case import LoadCase, load_case
from ...statics.support import RESTRAINED, Support
from ..model import SkidModel
from .ball_orbit import BallOrbit
from .orbit_search import NO_TRACTION, derivatives, search, with_derivatives
from .roller_orbit import RollerOrbit

_PLACES = 96
"""Least number of places along an orbit."""
_PRESSED = 1e-7
"""Load of a ball or roller on both rings, over the largest, above round-off [1].
"""
_IMBALANCE = {"float64": 1e-6, "float32": 1e-2}
"""Largest relative error of the power balance in a steady state [1]."""


def steady(
    model: SkidModel,
    load: Any,
    *,
    speed: Speed,
    places: int | None = None,
    load_speed: Speed | None = None,
    support: Support = RESTRAINED,
    throw: bool = True,
) -> Any:
    """Find the steady motion of the balls or rollers of a skidding bearing.

    Args:
        model: The bearing, its oil and its surroundings.
        load: On the moving ring, as in `solve_load` (6,) [N, N m].
        speed: Ring speeds.
        places: Places along the orbit, a multiple of the number of balls or rollers, or
            1 where all loads are equal; static. Default: 1 if so, else at least 96
            (also if the load is traced).
        load_speed: Ring speeds whose pure rolling gives the centrifugal forces, as in
            the published method; default: the orbit of the steady state gives them,
            so that contact loads are consistent with the slip.
        support: As in `solve_load`.
        throw: Raise if it cannot be solved; otherwise read `result`.

    Returns:
        `SteadySkid` of balls, `SteadyRollerSkid` of rollers, differentiable with
        respect to design, oil, load and speeds.

    Errors of the places, of the orbit speed of an angular contact bearing at 250 N
        axially and 160 N radially, against an integration in time: 3e-4 with 50, 2e-6
        with 100, 3e-8 with 200. More slip in a narrow zone needs more. Of the slip of
        36 rollers, against 864 places: 1e-4 with 108, 1e-5 with 432.

    Where no ball or roller is loaded by both rings, as without load, drag stops them:
    they slip completely, under the loads of pure rolling.

    Raises:
        ValueError: For a number of places that does not suit.
        SolveError: If not solved, and `throw` is set.

    Fails: codes of the load solve; `STEP_LIMIT`, `NON_FINITE`; `GRID_MISFIT` if one
        place stands for balls that bear unlike loads, or if the places are too few:
        more than a millionth of the power is then missing (`imbalance`).
    """
    check_places("skid.steady", model.bearing, places)
    carried = speed if load_speed is None else load_speed
    solution = solve(model.element, load, support, speed=carried)
    if throw:
        solution = raise_if_failed(solution, "skid.steady")
    count = _places(model.bearing, solution, places)
    case = load_case(model.bearing, load, support, speed=carried)
    follows = load_speed is None
    found = end_state(model, solution, case, speed, count, follows)
    if not throw:
        return found
    return raise_unless_converged(
        found,
        found.result,
        lambda: f"skid.steady: {found.failure_message}.",
        "skid.steady",
    )


def check_places(owner: str, bearing: Any, places: int | None) -> None:
    """Raise for an invalid number of places.

    Args:
        owner: Function or class that was called.
        bearing: The design.
        places: As in `skid.steady`.

    Raises:
        ValueError: If it is neither 1 nor a multiple of the number of balls.
    """
    number = bearing.n_elements
    if places is None or places == 1 or (places > 0 and places % number == 0):
        return
    raise ValueError(
        f"{owner}: `places` is {places}; it must be 1 or a multiple of the {number}"
        f" {f'{bearing.noun}s'}."
    )


def _places(bearing, solution, places):
    number, kind = bearing.n_elements, f"{bearing.noun}s"
    known = not is_traced(solution.roller_load)
    alike = known and not bool(_loads_differ(solution))
    if places is None:
        return 1 if alike else enough_places(bearing)
    if known and places == 1 and not alike:
        raise ValueError(
            f"skid.steady: `places` is 1, but the {kind} bear unlike loads; it must be"
            f" a multiple of the {number} {kind}."
        )
    return places


def enough_places(bearing: Any) -> int:
    """Return the default number of places along an orbit, where loads differ."""
    number = bearing.n_elements
    return number * -(-_PLACES // number)


def _loads_differ(solution):
    """Return whether the loads of balls or rollers differ."""
    loads = solution.roller_load
    spread = jnp.max(loads, axis=0) - jnp.min(loads, axis=0)
    return jnp.any(spread > 1e-6 * jnp.max(loads))


def _is_pressed(solution):
    """Return whether any ball or roller is loaded by both rings."""
    loads = solution.roller_load
    return jnp.max(jnp.min(loads, axis=1)) > _PRESSED * jnp.max(loads)


_ORBITS: dict[type, Any] = {
    AbstractBallBearing: BallOrbit,
    AbstractRollerBearing: RollerOrbit,
}


@program(quick=True)
def end_state(
    model: SkidModel,
    solution: Any,
    case: LoadCase,
    speed: Speed,
    count: int,
    follows: bool = True,
) -> Any:
    """Find the steady motion in a solved bearing; never raises.

    Args:
        model: The bearing, its oil and its surroundings.
        solution: Solution under its load, for balls or rollers in pure rolling.
        case: Load case that the solution solves.
        speed: Ring speeds.
        count: Number of places along the orbit. Static.
        follows: Whether loads follow the orbit from that of pure rolling. Static.

    Returns, Fails: As in `skid.steady`.
    """
    bearing = model.bearing
    turn = jnp.asarray(2.0 * np.pi * np.arange(count) / count, model.temperature.dtype)
    balance = balance_of(case, pitch_radius(bearing))
    kind = nearest_entry(_ORBITS, bearing)
    solved = solution.result == int(Result.CONVERGED)
    ring = solution.displacement[balance.moving_slice] / balance.scale
    rolling = jnp.zeros(count * kind.n_own + kind.n_common, ring.dtype)
    orbit = kind(
        model=model,
        speed=speed,
        carried=speed if case.speed is None else case.speed,
        follows=follows,
        pressed=_is_pressed(solution).astype(ring.dtype),
        balance=balance,
        azimuth=solution.azimuth[0] + turn,
        density=model.lubricant.density.at(model.temperature),
        along=jnp.asarray(derivatives(count), turn.dtype),
        least=jnp.sum(solution.roller_load),
        # A search from nowhere ends at once.
        start=jnp.concatenate([rolling, jnp.where(solved, ring, jnp.nan)]),
    )
    found = search(orbit)
    result = jnp.where(solved, found.result, solution.result)
    if count == 1:
        # One place does not stand for all.
        misfit = _loads_differ(solution) & (result == int(Result.CONVERGED))
        result = jnp.where(misfit, int(Result.GRID_MISFIT), result)
    y = with_derivatives(orbit, found.y, result)
    end = orbit.describe(
        y,
        found.solved,
        solution=solution,
        displacement=balance.ring_freedoms(orbit.parts(y)[2]),
        azimuth=orbit.azimuth,
        residual=found.residual,
        steps=found.steps,
        result=result,
    )
    result = _checked_power(result, _missing(end, speed, orbit), count)
    return eqx.tree_at(lambda t: t.result, end, result.astype(jnp.int32))


def _checked_power(result, missing, count):
    """Return the code of a search with the missing share of the power (`_missing`).

    Forces in balance whose powers are not: too few places, or lost in round-off.
    """
    lost = missing > _IMBALANCE[str(missing.dtype)]
    wrong = Result.STEP_LIMIT if count == 1 else Result.GRID_MISFIT
    return jnp.where(lost & (result == int(Result.CONVERGED)), int(wrong), result)


def _missing(found, speed, orbit):
    """Return `imbalance`, relative to at least a negligible loss [1]."""
    power, fastest = (
        found.power,
        jnp.maximum(jnp.abs(speed.inner), jnp.abs(speed.outer)),
    )
    losses = power.contacts + power.drag + power.cage
    least = NO_TRACTION * orbit.least * fastest * pitch_radius(orbit.model.bearing)
    tiny = jnp.finfo(losses.dtype).tiny
    return jnp.abs(power.drive - losses) / jnp.maximum(jnp.maximum(losses, least), tiny)

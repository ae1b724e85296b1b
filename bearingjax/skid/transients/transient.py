"""Transient skidding: balls or rollers of a bearing and its cage, integrated in time.

Contacts hold a ball with rates of 1e6 1/s and far beyond, against orbits of some 10 ms:
the method is implicit, with the exact Jacobian. The powers are integrated with the
motion, so that the power balance measures the integration itself.
"""

from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design import AbstractBallBearing, AbstractRollerBearing
from ...design.abstract import nearest_entry
from ...design.bearing_set import pitch_radius
from ...design.checks import check, count, integration, is_traced, one_of
from ...element.inertia import Speed
from ...numerics.compiled.programs import program
from ...numerics.constants import GRAVITY
from ...numerics.implicit import stop_gradient
from ...numerics.in_time import IntegrationOptions
from ...numerics.result import Result, raise_unless_converged
from ...numerics.types import Scalar, as_real
from ...numerics.units import meaning, unit
from ...statics.balance import balance_of
from ...statics.load import raise_if_failed, solve
from ...statics.load_case import load_case
from ...statics.support import RESTRAINED, Support
from ..balanced_loads import BalancedLoads
from ..conditions import conditions_of
from ..model import SkidModel
from ..motion import SkidState, each_ball, energies, equations_of_motion, power
from ..orbits.steady_results import driving
from ..ring_speed import SpeedTable, as_table
from .beginning import balanced_surroundings, surroundings
from .history import SkidHistory, SkidRollerHistory
from .integration import integrate_motion

_PLACES = 96
"""Number of places of the table."""

CAUSES = {
    Result.NO_LOAD_PATH: "The load over time pulls the ring out of the bearing, where"
    " nothing holds it: change the load, or fix that freedom.",
    Result.NON_FINITE: "No step was small enough, or numbers are not finite: a"
    " Newtonian film of an oil that pressure or cold makes a glass does so; take a law"
    " of traction that yields, such as a limiting stress.",
}
"""Causes and remedies of integrations that end early."""


class SkidOptions(eqx.Module):
    """How contact loads in time are found, and numerics of their integration.

    Attributes:
        tolerance: Error allowed of speeds relative to the fastest ring, of angles in
            rad, of work relative to the kinetic energy of rolling balls [1]. The error
            of a step is held below a fiftieth of it. In smooth motion the error stays
            below it; where balls strike the cage, 6 to 70 times larger ones were seen.
        max_steps: Step limit.
        derivatives: "reverse" or "forward": the mode in which the result can be
            differentiated. Where balls meet or leave the cage on the way derivatives
            need a small tolerance: 1e-2 off at 1e-8, 2e-3 at 1e-10 was seen.
        progress: Whether a bar is shown.
        axis: "vertical": no gravity along the orbits; "horizontal": it acts against y,
            along the orbits only, as its radial part is small against contact loads.
        balanced: Whether the ring is balanced at every time; of balls alone. `None`: if
            the load is a function of time.
        places: Places of the table of loads, 1 where all loads are equal, or at least
            6. `None`: 1 if they are, else 96 (also if the load is traced).
        load_speed: Ring speeds at which tabulated loads and angles are worked out;
            `None`: those at the end. Balanced ones are of the speeds of the time.

    Traced: tolerance, load_speed. Static: all others.

    Raises:
        TypeError, ValueError: For settings that do not exist.
    """

    tolerance: Scalar = eqx.field(
        converter=as_real,
        metadata=unit("1", "relative error of the integration"),
        default=1e-6,
    )
    max_steps: int = eqx.field(
        static=True, default=20_000, metadata=meaning("most steps of the integration")
    )
    derivatives: str = eqx.field(static=True, default="reverse")
    progress: bool = eqx.field(static=True, default=False)
    axis: str = eqx.field(static=True, default="vertical")
    balanced: bool | None = eqx.field(
        static=True,
        default=None,
        metadata=meaning("whether the ring of balls is in balance at every time"),
    )
    places: int | None = eqx.field(
        static=True,
        default=None,
        metadata=meaning(
            "places along an orbit; 1 or 6 and more, of the end state 1 or a multiple"
            " of the number of balls or rollers"
        ),
    )
    load_speed: Speed | None = None

    def __check_init__(self):
        integration("SkidOptions", self)
        axes = "vertical", "horizontal"
        one_of("SkidOptions", "axis", self.axis, axes, " or ".join(axes))
        if self.places is not None:
            count("SkidOptions", "places", self.places)
            if 1 < self.places < 6:
                raise ValueError(
                    f"SkidOptions: `places` is {self.places}; it must be 1 or at least"
                    " 6."
                )

    def integration(self) -> IntegrationOptions:
        """Numerics of the integration alone."""
        how = self.derivatives, self.progress
        return IntegrationOptions(self.tolerance, self.max_steps, *how)


def simulate(
    model: SkidModel,
    load: Any,
    *,
    speed: Speed | SpeedTable,
    times: Any,
    start: SkidState | None = None,
    support: Support = RESTRAINED,
    options: SkidOptions | None = None,
    throw: bool = True,
) -> Any:
    """Integrate the motion of the balls or rollers of a bearing and its cage.

    Contact loads and angles are quasi-static, with the inertia of pure rolling, however
    far the balls slip (end states of `skid.steady` have that of their orbits). Of a
    constant load they are tabulated
    around the bearing, for the ring where `solve_load` finds it. Of a load that varies
    in time they follow from a balance of the ring at every time, with the balls where
    they are. That is what `balanced` does for a constant load too: steps cost three to
    four times as much, and balls that bunch share the load as they do. (12 balls in
    wide pockets, 600 N axial and 400 N radial, 50 ms: with the table contact loads are
    off by up to 10 N of 319 N, orbit speeds by 1e-3, sliding by 0.016 m/s of
    0.14 m/s.)

    Args:
        model: The bearing, its oil and its surroundings.
        load: On the moving ring, as in `solve_load` (6,) [N, N m]; or over time:
            `LoadHistory`, `SinusoidalLoad`, or another pytree that is a function of
            time [s] and returns such a load.
        speed: Speed of the rings: constant, or over time.
        times: When to report, rising from 0 on; the motion ends at the last (time,)
            [s]. Between its steps the motion is interpolated by cubics.
        start: Motion at the beginning; default: rolling with outer raceway control, at
            rest if the rings are.
        support: As in `solve_load`.
        options: Contact loads and numerics; `None`: `SkidOptions()`.
        throw: Raise if the end is not reached; otherwise read `result`.

    Returns:
        `SkidHistory` of balls, `SkidRollerHistory` of rollers, differentiable with
        respect to design, oil, load, speeds and start.

    Raises:
        TypeError: If the ring of a roller bearing is to be balanced at every time.
        ValueError: For times that do not rise from 0.
        SolveError: If the end is not reached, and `throw` is set.

    Fails: codes of the load solve; `STEP_LIMIT`; `NO_LOAD_PATH` if a load over time
        pulls the ring out of the bearing; `NON_FINITE` where steps shrink to 1e-14 of
        the duration, as next to rates that are not numbers, or where a film is as stiff
        as a Newtonian glass: spins settle in it within 1e-15 s.
    """
    options = SkidOptions() if options is None else options
    end = as_real(times[-1])
    if not is_traced(times):
        each = np.asarray(times)
        rising = each[0] >= 0.0 and bool(np.all(np.diff(each) > 0)) and each[-1] > 0
        check("skid.simulate", "times", rising, "rising from 0 on", each, "s")
    table, zero = as_table(speed), jnp.zeros_like(end)
    balanced, places = options.balanced, options.places
    varies = callable(load)
    if balanced is None:
        balanced = varies
    elif varies and not balanced:
        raise ValueError(
            "skid.simulate: `load` varies in time; `balanced` must not be false, as no"
            " table holds its contact loads."
        )
    if balanced:
        model.check_balls("skid with `balanced`")
    at = table.at(zero) if balanced else table.at(end)
    if options.load_speed is not None and not balanced:
        at = options.load_speed
    first = load(zero) if callable(load) else load
    solution: Any = solve(model.element, first, support, speed=at)
    if throw:
        solution = raise_if_failed(solution, "skid.simulate")
    gravity = as_real(GRAVITY if options.axis == "horizontal" else 0.0)
    if balanced:
        over_time = load if callable(load) else _Constant(as_real(load))
        # Without its load, which comes over time.
        case = load_case(model.bearing, None, support)
        balance = balance_of(case, pitch_radius(model.bearing))
        environment, rolling = balanced_surroundings(
            model, solution, balance, over_time, table, gravity
        )
    else:
        if places is None:
            places = 1 if _loads_equal(solution.roller_load) else _PLACES
        environment, rolling = surroundings(model, solution, at, table, gravity, places)
    start = rolling if start is None else _taken_up(start, rolling)
    steps = options.integration()
    found = _skid(environment, solution, start, as_real(times), end, steps)
    if not throw:
        return found
    return raise_unless_converged(
        found, found.result, lambda: _message(found), "skid.simulate"
    )


def _loads_equal(loads):
    """Return whether all balls are known to carry equal loads."""
    if is_traced(loads):
        return False
    least, most = np.min(loads, axis=0), np.max(loads, axis=0)
    return bool(np.all(most - least <= 1e-6 * np.max(most)))


def _message(found):
    label = Result(int(found.result)).label
    time, speed = stop_gradient((found.time, found.cage_speed))  # being differentiated
    reached = time[np.isfinite(speed)]
    last = f"{float(reached[-1]):.3g} s" if len(reached) else "the first time"
    cause = CAUSES.get(Result(int(found.result)), "")
    return (
        f"skid.simulate: {label} after {int(found.steps)} steps, behind {last} of"
        f" {float(time[-1]):.3g} s. {cause}".rstrip()
    )


class _Constant(eqx.Module):
    """Constant load."""

    load: Float[Array, "6"]

    def __call__(self, time):
        return self.load


def _taken_up(start, rolling):
    """Return the start of a motion, with ring and balls of rolling if tabulated."""
    if start.ring.shape == rolling.ring.shape:
        return start
    return start._replace(centre=rolling.centre, ring=rolling.ring)


@program
def _skid(environment, solution, start, times, duration, options):
    moved = integrate_motion(environment, start, times, duration, options)
    found: Any = jax.vmap(partial(_report, environment))(times, moved.state)
    q = jnp.broadcast_to(solution.displacement, (times.shape[0], 12))
    result = jnp.maximum(moved.result, solution.result)
    if isinstance(environment.loads, BalancedLoads):
        q = jax.vmap(environment.loads.balance.ring_freedoms)(moved.state.ring)
        # Nothing but `_REST` slows a ring that the load pulls away.
        away = jnp.any(
            jnp.abs(moved.state.ring) > environment.model.bearing.ball_diameter
        )
        lost = jnp.where(away, int(Result.NO_LOAD_PATH), int(Result.CONVERGED))
        result = jnp.maximum(result, lost.astype(result.dtype))
    kind, _ = nearest_entry(_HISTORIES, environment.model.bearing)
    return kind(
        solution=solution,
        time=times,
        displacement=q,
        **moved._replace(result=result)._asdict(),
        **found,
    )


def _report(environment, time, state):
    """Return the entries of a history at one instant."""
    balls = each_ball(environment, time, state)
    powers, energy = jax.tree.map(
        lambda of_balls: jnp.sum(of_balls, axis=0),
        jax.vmap(
            lambda ball: (power(environment, time, ball), energies(environment, ball))
        )(balls),
    )
    kinetic, potential = energy
    speed = environment.speed.at(time)
    inner, outer = (-jnp.sum(torque) for torque in balls.ring_torque)
    rolling = jax.vmap(
        partial(equations_of_motion(balls.ball).pure_rolling, speed=speed)
    )(balls.ball)
    _, more = nearest_entry(_HISTORIES, environment.model.bearing)
    return dict(
        **more(environment, balls),
        azimuth=balls.azimuth,
        contact_load=balls.ball.load,
        rolling_orbit_speed=rolling.orbit,
        film=balls.pulls.film,
        sliding=balls.moving.slip,
        heat=balls.pulls.heat,
        cage_force=balls.push,
        friction_torque=driving(outer, inner, speed),
        ring_torque=jnp.stack([outer, inner]),
        power=powers,
        kinetic_energy=kinetic
        + 0.5 * environment.model.cage.inertia * state.cage_speed**2,
        potential_energy=potential,
    )


def _more_of_balls(environment, balls):
    return {"contact_angle": balls.ball.angle, "contact_spin": balls.moving.spin}


def _more_of_rollers(environment, rollers):
    conditions = jax.vmap(partial(conditions_of, environment.model))
    pulls = rollers.pulls
    return {"conditions": conditions(rollers.ball, rollers.moving, pulls.film)}


_HISTORIES: dict[type, Any] = {
    AbstractBallBearing: (SkidHistory, _more_of_balls),
    AbstractRollerBearing: (SkidRollerHistory, _more_of_rollers),
}
"""Class of the history, and its entries at an instant that the other has not."""

"""Lives of all bearings of a system of shafts, under one load case or many."""

import copy
from collections.abc import Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from ..cases.cases import check_hours
from ..cases.output_labels import label_output
from ..design import rows_of
from ..element.frame import LOAD_UNITS, MOTION_UNITS
from ..element.inertia import Speed
from ..life.life import LifeConditions, rating_life
from ..life.life_warning import life_sizes
from ..life.rating import check_alike
from ..life.reference_life import BALLS, exponents_of
from ..life.required_life import NEEDED
from ..numerics.compiled.programs import program
from ..numerics.labels import to_xarray
from ..numerics.shown import Printable
from ..numerics.types import Scalar, in_numpy
from ..numerics.units import unit
from ..statics.solution import Solution
from ..statics.warning import sizes
from .equilibrium import check_torques, system_state, torques_left
from .power import power_flow
from .seats import in_place, speed_of, with_preload_offsets
from .state import SystemSolution
from .system import ShaftSystem, feel_speed

BATCH = 64
"""Cases that are solved side by side."""
FEW = 32
"""Cases up to which each is solved alone, by the programs of a kind of bearing: the one
of many cases takes longer to compile than these to run."""
_NEWTON = 40
"""Steps of Newton's method for the life of a system, which is convex: 8 suffice."""

LIVES = (
    "static_safety",
    "basic_rating_life",
    "reference_rating_life",
    "modified_rating_life",
    "damage",
)
"""Numbers of a `Life` that a `DutyResult` has; the damage is last."""
_KEPT = LIVES, NEEDED


class DutyResult(Printable):
    """Load cases of a system of shafts, or one, without its axis. Numbers of failed
    cases are NaN.

    Attributes:
        load: On each inner ring in global axes (case, bearing, 6) [N, N m].
        displacement: As in `SystemSolution` (case, bearing, 6) [m, rad].
        misalignment: Misalignment of each mesh (case, mesh) [rad].
        speed: Speed of each shaft (case, shaft) [rad/s].
        loss: Power lost in meshes (case,) [W].
        result: `Result` code (case,).
        peak_pressure: Largest contact pressure (case, bearing) [Pa]; NaN of springs.
        lives: Numbers of `LIVES` by name (case, bearing); NaN of springs.
        friction: Power lost in each bearing (case, bearing) [W]; `None`: not asked for.
        warned: For each bearing the size of every kind of warning about its solution
            and its life that can arise, by name (case,); empty of springs.
        fatigue: For each bearing what `judge_life` takes of its lives, by name
            (case, ...); empty of springs.
    """

    load: Float[Array | np.ndarray, "*case bearing component=6"] = eqx.field(
        metadata=unit(LOAD_UNITS)
    )
    displacement: Float[Array | np.ndarray, "*case bearing freedom=6"] = eqx.field(
        metadata=unit(MOTION_UNITS)
    )
    misalignment: Float[Array | np.ndarray, "*case mesh"] = eqx.field(
        metadata=unit("rad")
    )
    speed: Float[Array | np.ndarray, "*case shaft"] = eqx.field(metadata=unit("rad/s"))
    loss: Float[Array | np.ndarray, "*case"] = eqx.field(metadata=unit("W"))
    result: Int[Array | np.ndarray, "*case"]
    peak_pressure: Float[Array | np.ndarray, "*case bearing"] = eqx.field(
        metadata=unit("Pa")
    )
    lives: dict[str, Float[Array | np.ndarray, "*case bearing"]]
    warned: tuple[dict[str, Any], ...] = eqx.field(repr=False)
    friction: Float[Array | np.ndarray, "*case bearing"] | None = eqx.field(
        metadata=unit("W"), default=None
    )
    fatigue: tuple[dict[str, Any], ...] = eqx.field(repr=False, default=())

    label_entry = staticmethod(label_output)
    to_xarray = to_xarray


def solve_duty(
    systems: Sequence[ShaftSystem],
    conditions: Sequence[Sequence[LifeConditions | None]],
) -> DutyResult:
    """Solve many load cases of a system of shafts, with the lives of its bearings.

    Args:
        systems: The system in each case: one structure, other numbers.
        conditions: Conditions of the life of each bearing in each case
            (case, bearing); `None` of springs.

    Returns:
        DutyResult; nothing is raised for a failed case, read `result`.

    Raises:
        ValueError: If there are no cases, they differ in structure, the torques of one
            do not balance, or a bearing is a set of unlike rows.
    """
    if not systems or len(systems) != len(conditions):
        raise ValueError(
            f"solve_duty: {len(systems)} systems and {len(conditions)} conditions; give"
            " one case at least, and both for each."
        )
    systems = align_systems(systems)
    for seat in systems[0].seats:
        if seat.installed is not None:
            check_alike(seat.installed.drawing.bearing)
    fast = systems[0].inertia
    offsets: dict[Any, Any] = {}
    whole = [with_preload_offsets(system, offsets) for system in systems]
    found = _map(state_of, whole)
    _check_balances(systems, found)
    lives: list[tuple[Any, Any, Any, Any]] = []
    first = systems[0]
    for k, seat in enumerate(first.seats):
        if seat.installed is None:
            none = np.full(len(systems), np.nan)
            lives.append((none, dict.fromkeys(LIVES, none), {}, {}))
            continue
        speeds = [speed_of(first, k, speed)[0] for speed in np.asarray(found["speed"])]
        given = [
            (system.seats[k].installed, motion, speed, of_case[k])
            for system, motion, speed, of_case in zip(
                systems, found["motion"][:, k], speeds, conditions, strict=True
            )
        ]
        lives.append(_map(_rate, given, fast))
    names = [n for n in LIVES if any(n in life[1] for life in lives)]
    never = np.full(len(systems), np.nan)
    return DutyResult(
        load=found["load"],
        displacement=found["displacement"],
        misalignment=found["misalignment"],
        speed=found["speed"],
        loss=found["loss"],
        result=found["result"],
        peak_pressure=np.stack([life[0] for life in lives], axis=1),
        lives={
            name: np.stack([life[1].get(name, never) for life in lives], axis=1)
            for name in names
        },
        warned=tuple(life[2] for life in lives),
        fatigue=tuple(life[3] for life in lives),
    )


def align_systems(systems: Sequence[ShaftSystem]) -> list[ShaftSystem]:
    """Return systems of one structure: what is fast in one case feels the speed in all,
    and shafts are divided as in the first case.

    Args:
        systems: The system in each case.

    Raises:
        ValueError: If parts stand in another order in one of them.
    """
    fast = feel_speed(system.inertia for system in systems)
    first, found = systems[0], []
    for k, system in enumerate(systems):
        for plan, own in zip(first.plans, system.plans, strict=True):
            if own._replace(divisions=plan.divisions) != plan:
                raise ValueError(
                    f"solve_duty: in case {k} parts stand in another order on their"
                    " shafts than in the first."
                )
        other = copy.copy(system)
        object.__setattr__(other, "inertia", fast)
        object.__setattr__(other, "plans", first.plans)
        found.append(other)
    return found


def _check_balances(systems: Sequence[ShaftSystem], found: dict[str, Any]) -> None:
    """Raise if given torques do not balance in a case, which is named."""
    shaft = power_flow(systems[0]).output_shaft
    if shaft is None:
        return
    for k, system in enumerate(systems):
        try:
            check_torques(system, shaft, found["left"][k], found["most"][k])
        except ValueError as error:
            raise ValueError(f"{error} (case {k})") from error


def _map(function: Any, given: Sequence[Any], *static: Any) -> Any:
    """Return function(one) of all, stacked in NumPy; shared leaves are not copied."""
    trees = [jax.tree.structure(one) for one in given]
    for k, tree in enumerate(trees):
        if tree != trees[0]:
            raise ValueError(
                f"solve_duty: case {k} has other parts or conditions than case 0, such"
                " as another bearing; only numbers may differ between cases."
            )
    leaves = [jax.tree.leaves(one) for one in given]
    varying, shared = [], []
    for column in zip(*leaves, strict=True):
        arrays = eqx.is_array_like(column[0])
        same = all(x is column[0] for x in column) or (
            arrays and all(np.array_equal(x, column[0]) for x in column[1:])
        )
        varying.append(None if same else np.stack([np.asarray(x) for x in column]))
        shared.append(column[0] if same else None)
    if all(v is None for v in varying):
        once = jax.device_get(function(given[0], *static))
        return jax.tree.map(lambda x: np.stack([x] * len(given)), once)
    if len(given) <= FEW:
        each = [jax.device_get(function(one, *static)) for one in given]
        return jax.tree.map(lambda *values: np.stack(values), *each)
    both = _map_cases(function, varying, shared, trees[0], static)
    return jax.device_get(both)


@program
def _map_cases(function, varying, shared, tree, static):
    def call_case(mine):
        leaves = [s if v is None else v for v, s in zip(mine, shared, strict=True)]
        return function(jax.tree.unflatten(tree, leaves), *static)

    return lax.map(call_case, varying, batch_size=BATCH)


def state_of(system: ShaftSystem) -> dict[str, Any]:
    """Return loads, motions, speeds, losses and result of one case by their names.

    Args:
        system: From `with_preload_offsets`.
    """
    return numbers_of(system_state(system)[0])


def numbers_of(found: SystemSolution) -> dict[str, Any]:
    """Return what `state_of` does of a system that is solved.

    Args:
        found: Its solution.
    """
    found = in_numpy(found)
    names = "load displacement misalignment motion result".split()
    kept = {name: getattr(found, name) for name in names}
    left, most = torques_left(found.power)
    left = 0.0 * most if left is None else left
    more = {"loss": found.power.loss, "left": left, "most": most}
    return {**kept, "speed": found.power.speed, **more}


def _rate(
    given: Any, inertia: bool | None
) -> tuple[Scalar, dict[str, Any], dict[str, Any], dict[str, Any]]:
    installed, motion, speed, conditions = given
    solution = in_place(installed, motion, speed, inertia, 101)
    return bearing_results(solution, speed, conditions)


def bearing_results(
    solution: Solution, speed: Speed, conditions: LifeConditions
) -> tuple[Scalar, dict[str, Any], dict[str, Any], dict[str, Any]]:
    """Return peak pressure, numbers of `LIVES`, sizes of warnings, and what
    `judge_life` takes, of a bearing.

    Args:
        solution: From `in_place`.
        speed: Its ring speeds.
        conditions: Life conditions of the bearing.
    """
    solution = in_numpy(solution)
    given = solution.element, solution, conditions
    life = in_numpy(rating_life(*given, speed=speed))
    known = {name: value for name, value in vars(life).items() if value is not None}
    lives, parts = ({k: known[k] for k in names if k in known} for names in _KEPT)
    doubts = life_sizes(solution.element.bearing, life.ratings, vars(life))
    return solution.roller_pressure.max(), lives, sizes(solution) | doubts, parts


def bearing_hours(
    damage: Float[Array | np.ndarray, "case bearing"],
    speed: Float[Array | np.ndarray, "case bearing"],
    hours: Float[Array | np.ndarray, " case"] | None = None,
) -> Any:
    """Return the life of each bearing under a spectrum (bearing,) [h].

    Args:
        damage: Damage, as in `DutyResult` [1/rev].
        speed: Speed of the shaft of each bearing [rad/s].
        hours: Time in each case [h]; `None`: the same in all.

    Raises:
        ValueError: For hours that are negative, or all zero.

    Source: Palmgren (1924), Miner (1945); ISO 281.
    """
    used = jnp.sum(case_damage(damage, speed, hours), axis=0)
    return jnp.where(used == 0, jnp.inf, 1.0 / jnp.where(used == 0, 1.0, used))


def case_damage(
    damage: Float[Array | np.ndarray, "case bearing"],
    speed: Float[Array | np.ndarray, "case bearing"],
    hours: Float[Array | np.ndarray, " case"] | None = None,
) -> Array:
    """Return the damage of each case in an hour of the spectrum (case, bearing) [1/h].

    Args:
        damage: Damage, as in `DutyResult` [1/rev].
        speed: Speed of the shaft of each bearing [rad/s].
        hours: Time in each case [h]; `None`: the same in all.

    Raises:
        ValueError: For hours that are negative, or all zero.
    """
    check_hours(hours)
    share = jnp.ones(damage.shape[0]) if hours is None else jnp.asarray(hours)
    share = (share / jnp.sum(share))[:, None]
    turns = jnp.abs(speed) * (3600.0 / (2.0 * jnp.pi))
    return share * damage * turns


@program(quick=True)
def system_life(system: ShaftSystem, hours: Any) -> Scalar:
    """Return the life that all bearings together reach with their reliability [h].

    The probabilities that the bearings survive multiply; each follows Weibull's
    distribution with the slope of its rolling elements, 10/9 of balls and 9/8 of
    rollers: the sum of (L/L_k)^e_k is one at the life L of the system.

    Args:
        system: The system.
        hours: Life of each bearing (bearing,), infinite of springs [h].

    Returns:
        Life; infinite if no bearing accumulates damage. Differentiable.
    """
    kinds = [
        BALLS
        if seat.installed is None
        else exponents_of(rows_of(seat.installed.drawing.bearing)[0].bearing)
        for seat in system.seats
    ]
    slope = jnp.asarray([kind.spread[0] / kind.spread[1] for kind in kinds])
    mortal = jnp.isfinite(hours) | jnp.isnan(hours)
    log = jnp.where(mortal, jnp.log(jnp.where(mortal, hours, 1.0)), 0.0)

    def excess(x, log):
        part = jnp.where(mortal, jnp.exp(slope * (x - log)), 0.0)
        return jnp.sum(part) - 1.0, jnp.sum(slope * part)

    def step(x, log):
        value, rate = excess(x, log)
        return x - value / jnp.where(rate > 0, rate, 1.0)

    still = lax.stop_gradient(log)
    start = jnp.min(jnp.where(mortal, still, jnp.inf))
    start = jnp.where(jnp.isfinite(start), start, 0.0)
    x = lax.fori_loop(0, _NEWTON, lambda _, x: step(x, still), start)
    # One step more has the derivatives of the root.
    life = jnp.exp(step(lax.stop_gradient(x), log))
    return jnp.where(jnp.any(mortal), life, jnp.inf)

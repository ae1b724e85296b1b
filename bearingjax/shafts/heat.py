"""Temperatures of a system of shafts: friction warms bearings, and warmth loads them.

Each bearing has two temperatures, of its inner ring with the shaft below it and of its
outer ring with the seat around it; the housing with the oil sump may have one more.
Friction heats both rings alike, losses of meshes heat the housing. Heat flows from the
inner ring along the shaft to the ambience, from ring to ring, from the outer ring to
the housing, or without one to the ambience, and from the housing to the ambience.
Friction depends on temperature through viscosity, and through the clearance and the
preload of warm rings, shafts and housings.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from ..design import FitConditions
from ..design.checks import check, in_range, is_traced, number, positive
from ..element.inertia import Speed
from ..lubrication import Lubricant
from ..numerics.implicit import attach_by, stop
from ..numerics.lapack import eigvals, solve_any
from ..numerics.programs import program
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from ..rotor.held import of_each
from ..statics.friction import friction_torque
from ..statics.friction_skf import skf_friction_torque
from ..statics.solution import Solution
from .equilibrium import system_state
from .seats import adjusted, in_place, speed_of
from .state import SystemSolution
from .system import ShaftSystem

_HOTTEST = 300.0
"""Rise above the ambience from which there is no thermal equilibrium [K]."""
_STEPS = 100
_TOLERANCE = 1e-10
"""Heat out of balance over the heat that is made [1]."""
_LEAST, _GROWTH = 1.5, 4.0
"""Factors by which the steps in time grow as the balance is approached [1]."""


class ThermalPaths(eqx.Module):
    """Paths of the heat of a bearing.

    Attributes:
        inner: From the inner ring along the shaft to the ambience [W/K].
        outer: From the outer ring to the housing, or without one to the ambience [W/K].
        through: From ring to ring, by rolling elements and oil [W/K].
        shaft_share: Rise of the shaft below the bearing over that of the inner ring,
            above the ambience [1].
        housing_share: Rise of the seat over that of the outer ring [1].
        inner_capacity: Heat capacity of the inner ring with the shaft below it, which
            counts in time only [J/K].
        outer_capacity: Heat capacity of the outer ring with its seat, likewise [J/K].
        lubricant: The oil.
        supply: As in `friction_torque`.
        skf: Whether friction is that of SKF's model, else of Palmgren's.
        series: Of SKF's model, as in `skf_friction_torque`.
        diameters: Bore and outside diameter for SKF's model (2,) [m].

    Traced: all numbers. Static: supply, skf, series.
    """

    inner: Scalar = eqx.field(converter=as_real, metadata=unit("W/K"))
    outer: Scalar = eqx.field(converter=as_real, metadata=unit("W/K"))
    lubricant: Lubricant
    through: Scalar = eqx.field(converter=as_real, metadata=unit("W/K"), default=0.0)
    shaft_share: Scalar = eqx.field(converter=as_real, metadata=unit("1"), default=1.0)
    housing_share: Scalar = eqx.field(
        converter=as_real, metadata=unit("1"), default=1.0
    )
    inner_capacity: Scalar = eqx.field(
        converter=as_real, metadata=unit("J/K"), default=1000.0
    )
    outer_capacity: Scalar = eqx.field(
        converter=as_real, metadata=unit("J/K"), default=1000.0
    )
    supply: str = eqx.field(static=True, default="oil_bath")
    skf: bool = eqx.field(static=True, default=False)
    series: str | None = eqx.field(static=True, default=None)
    diameters: Float[Array, "2"] | None = eqx.field(
        converter=as_real, metadata=unit(2 * ("m",)), default=None
    )

    def __check_init__(self):
        for name in ("inner", "outer", "inner_capacity", "outer_capacity"):
            positive(self, name)
        for name in ("shaft_share", "housing_share"):
            in_range(self, name, 0.0, 1.0 + 1e-9, include_low=True)


class HeatNetwork(eqx.Module):
    """Paths of all heat of a system.

    Attributes:
        ambient: Temperature of the ambience [K].
        paths: Of each bearing; `None` of springs.
        housing: From the housing to the ambience [W/K]; `None`: the housing is as cold
            as the ambience, and takes the losses of the meshes.
        housing_capacity: Heat capacity of housing and oil [J/K].
    """

    ambient: Scalar = eqx.field(converter=as_real, metadata=unit("K"))
    paths: tuple[ThermalPaths | None, ...] = eqx.field(converter=tuple)
    housing: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("W/K"), default=None
    )
    housing_capacity: Scalar = eqx.field(
        converter=as_real, metadata=unit("J/K"), default=20e3
    )

    def __check_init__(self):
        number(self, "ambient")
        if not is_traced(self.ambient):
            warm = 150.0 < float(self.ambient) < 600.0
            check(self, "ambient", warm, "a temperature in K, from 150 to 600 K")
        if self.housing is not None:
            positive(self, "housing")
        positive(self, "housing_capacity")

    @property
    def nodes(self) -> int:
        """Number of temperatures."""
        return 2 * len(self.paths) + (self.housing is not None)

    def conductance(self) -> Float[Array, "node node"]:
        """Matrix of conductances: heat that leaves each node over all rises [W/K]."""
        n, house = self.nodes, 2 * len(self.paths)
        matrix = jnp.zeros((n, n), jnp.result_type(float))
        for k, path in enumerate(self.paths):
            i, o = 2 * k, 2 * k + 1
            if path is None:
                matrix = matrix.at[i, i].set(1.0).at[o, o].set(1.0)
                continue
            matrix = matrix.at[i, i].add(path.inner).at[o, o].add(path.outer)
            matrix = _between(matrix, i, o, path.through)
            if self.housing is not None:
                matrix = matrix.at[house, house].add(path.outer)
                matrix = matrix.at[house, o].add(-path.outer)
                matrix = matrix.at[o, house].add(-path.outer)
        if self.housing is not None:
            matrix = matrix.at[house, house].add(self.housing)
        return matrix

    def capacity(self) -> Float[Array, " node"]:
        """Heat capacity of each node [J/K]."""
        found = [
            one
            for path in self.paths
            for one in (
                (as_real(1.0),) * 2
                if path is None
                else (path.inner_capacity, path.outer_capacity)
            )
        ]
        more = [] if self.housing is None else [self.housing_capacity]
        return jnp.stack([*found, *more])


def _between(matrix, i, j, conductance):
    matrix = matrix.at[i, i].add(conductance).at[j, j].add(conductance)
    return matrix.at[i, j].add(-conductance).at[j, i].add(-conductance)


class ThermalState(eqx.Module):
    """Temperatures of a system in equilibrium with its friction.

    Attributes:
        inner_ring: Temperature of each inner ring (bearing,) [K].
        outer_ring: Temperature of each outer ring (bearing,) [K].
        housing: Of housing and oil [K]; the ambience without a node of its own.
        friction: Power lost in each bearing (bearing,) [W].
        system: The system with these temperatures.
        solution: Its equilibrium.
        slowest: Rate at which the slowest disturbance decays [1/s]: as it approaches
            zero friction grows as fast with temperature as cooling does. Not
            differentiable.
        residual: Heat out of balance over the heat made [1].
        steps: Steps of the search.
        result: `Result` code; `STEP_LIMIT` where temperatures run away.
    """

    inner_ring: Float[Array, " bearing"] = eqx.field(metadata=unit("K"))
    outer_ring: Float[Array, " bearing"] = eqx.field(metadata=unit("K"))
    housing: Scalar = eqx.field(metadata=unit("K"))
    friction: Float[Array, " bearing"] = eqx.field(metadata=unit("W"))
    system: ShaftSystem
    solution: SystemSolution
    slowest: Scalar = eqx.field(metadata=unit("1/s"))
    residual: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]


Balance = Callable[[Float[Array, " node"], Any], Float[Array, " node"]]
"""Heat made at every node over the rises of temperature [W]."""


def steady_rises(
    heat: Balance, args: Any, conductance: Array, capacity: Array
) -> tuple[Array, Array, Array, Array, Array]:
    """Find the temperatures that a system reaches from the cold.

    Time steps of the linearly implicit Euler rule follow the warming up and grow as it
    ends, where they become Newton's: a state that is not stable is not reached.

    Args:
        heat: Function (rises, args) -> heat made at each node (node,) [W].
        args: Pytree with all that the heat depends on.
        conductance: Of the network (node, node) [W/K].
        capacity: Of the nodes (node,) [J/K].

    Returns:
        Rises above the ambience (node,) [K], differentiable with respect to args,
        conductance and capacity; rate of the slowest disturbance [1/s]; residual [1];
        steps; whether it was found. Rises are those of the last step if it was not.
    """
    still, *network = stop((args, conductance, capacity))

    def evaluated(rise):
        return _with_slope(lambda rise: (heat(rise, still), ()), rise)

    found, _ = _searched(evaluated, network, (), lax.while_loop)

    def balance(rise, args):
        heat_args, conductance = args
        return heat(rise, heat_args) - conductance @ rise

    def undone(of_rise, rise, change, args):
        matrix = jax.jacfwd(of_rise)(rise)
        return -solve_any(matrix, change)

    rise = attach_by(balance, found.rise, (args, conductance), undone)
    return rise, -found.fastest, found.residual, found.steps, found.solved


def _with_slope(heat, rise):
    """Return heat made at every node, its slope over the rises, and something else.

    Args:
        heat: Rises -> heat made at every node, and something else.
        rise: Rises (node,) [K].
    """

    def both(rise):
        made, more = heat(rise)
        return made, (made, more)

    slope, (made, more) = jax.jacfwd(both, has_aux=True)(rise)
    return made, slope, more


class _Search(NamedTuple):
    """State of the search of `steady_rises`.

    Attributes:
        after: Rises to be looked at next (node,) [K].
        rise: Rises that were looked at last (node,) [K].
        fastest: Rate at which the fastest disturbance of them grows [1/s].
        residual: Heat out of balance over the heat made [1].
        time: Length of the step in time [s].
        steps: Number of steps.
        going: Whether to go on.
    """

    after: Array
    rise: Array
    fastest: Array
    residual: Array
    time: Array
    steps: Array
    going: Array

    @property
    def solved(self):
        return (self.residual <= _TOLERANCE) & (self.fastest < 0)


def _searched(evaluated, network, nothing, while_loop):
    """Search the temperatures that a system reaches from the cold.

    Args:
        evaluated: Rises -> heat made, its slope, and something else.
        network: Conductance and capacity as in `steady_rises`.
        nothing: In place of what else is evaluated, before the first step.
        while_loop: `lax.while_loop`, or `_while_loop`.

    Returns:
        Last state, and what else was evaluated at its `rise`.
    """

    def step(carry):
        made, slope, more = evaluated(carry[0].after)
        return _advanced(carry[0], made, slope, network), more

    begin = _beginning(network)
    return while_loop(lambda carry: carry[0].going, step, (begin, nothing))


def _while_loop(going, step, carry):
    """`lax.while_loop` of steps that are compiled one by one."""
    while going(carry):
        carry = step(carry)
    return carry


@program(quick=True)
def _beginning(network):
    conductance, capacity = network
    zero, none = jnp.zeros_like(capacity), jnp.zeros((), capacity.dtype)
    shortest = jnp.min(capacity / jnp.diagonal(conductance))
    counted = jnp.zeros((), jnp.int32), jnp.ones((), bool)
    return _Search(zero, zero, none, none + jnp.inf, 0.3 * shortest, *counted)


@program(quick=True)
def _advanced(state, made, slope, network):
    """Return the state after a step, from heat and slope at `state.after`."""
    rise, (conductance, capacity) = state.after, network
    slope, left = slope - conductance, made - conductance @ rise
    size, total = jnp.max(jnp.abs(left)), jnp.sum(jnp.abs(made))
    new = jnp.where(size > 0, size / jnp.maximum(total, 1e-30), 0.0)
    # Nodes of little capacity settle first; the others need steps that grow.
    nearer = state.residual / new
    least = jnp.where(nearer < 1.0, 0.5, _LEAST)
    factor = jnp.clip(nearer, least, _GROWTH)
    grown = jnp.where(state.steps > 0, factor, 1.0) * state.time
    # A step past the growth of what is not stable would lead anywhere.
    fastest = jnp.max(jnp.real(eigvals(slope / capacity[:, None])))
    limit = 0.5 / jnp.where(fastest > 0, fastest, 1.0)
    grown = jnp.where(fastest > 0, jnp.minimum(grown, limit), grown)
    after = rise + solve_any(jnp.diag(capacity / grown) - slope, left)
    going = (new > _TOLERANCE) & jnp.all(after < _HOTTEST)
    going = going & (state.steps + 1 < _STEPS)
    return _Search(after, rise, fastest, new, grown, state.steps + 1, going)


def rises_over_time(
    heat: Balance, args: Any, conductance: Array, capacity: Array, times: Array, n: int
) -> Array:
    """Integrate the warming up from the cold.

    Args:
        heat, args, conductance, capacity: As in `steady_rises`.
        times: Rising, from 0 (time,) [s].
        n: Steps between two times. Static.

    Returns:
        Rises above the ambience (time, node) [K]; NaN from where they run away.

    Source: Verwer's ROS2, linearly implicit, of second order and L-stable.
    """

    def evaluated(rise):
        return _with_slope(lambda rise: (heat(rise, args), ()), rise)[:2]

    def made(rise):
        return heat(rise, args)

    return _integrated(evaluated, made, [conductance, capacity], times, n, lax.scan)


_GAMMA = 1.0 - np.sqrt(0.5)


def _integrated(evaluated, made, network, times, n, scan):
    """Return rises over time (time, node) [K].

    Args:
        evaluated: Rises -> heat made, and its slope.
        made: Rises -> heat made.
        network: Conductance and capacity as in `rises_over_time`.
        times, n: As there.
        scan: `lax.scan`, or `_scan`.
    """

    def step(rise, length):
        there, slope = evaluated(rise)
        between, k1, matrix = _half_way(rise, there, slope, length, network)
        known = rise, k1, matrix, between
        return _whole_way(known, made(between), length, network)

    def interval(rise, length):
        after, _ = scan(step, rise, jnp.full(n, length / n))
        return after, after

    start = jnp.zeros_like(network[1])
    _, found = scan(interval, start, jnp.diff(times))
    return jnp.concatenate([start[None], found])


def _scan(step, carry, given):
    """`lax.scan` of steps that are compiled one by one."""
    found = []
    for one in np.asarray(given):
        carry, out = step(carry, jnp.asarray(one))
        found.append(out)
    return carry, jnp.asarray(np.stack(found))


@program(quick=True)
def _half_way(rise, made, slope, length, network):
    """Return rises at which heat is wanted once more, and what is known by then."""
    conductance, capacity = network
    rate = (made - conductance @ rise) / capacity
    eye = jnp.eye(capacity.shape[0], dtype=capacity.dtype)
    matrix = eye - _GAMMA * length * (slope - conductance) / capacity[:, None]
    k1 = solve_any(matrix, rate)
    return rise + length * k1, k1, matrix


@program(quick=True)
def _whole_way(known, made, length, network):
    """Return rises after a step, NaN where they run away, and as they are."""
    (rise, k1, matrix, between), (conductance, capacity) = known, network
    rate = (made - conductance @ between) / capacity
    k2 = solve_any(matrix, rate - 2.0 * k1)
    after = rise + length * (1.5 * k1 + 0.5 * k2)
    return jnp.where(jnp.all(after < _HOTTEST), after, jnp.nan), after


def solve_heat(
    system: ShaftSystem, network: HeatNetwork, *, throw: bool = True
) -> ThermalState:
    """Find the temperatures of a turning system, and its equilibrium at them.

    Args:
        system: The system; clearances, preloads and the distance of its bearings change
            with temperature where bearings have seats (`Installed.mounting`).
        network: Paths of the heat.
        throw: Raise if there is no thermal equilibrium. Static.

    Returns:
        ThermalState, differentiable with respect to all numbers of both.

    Fails: `STEP_LIMIT`: temperatures run away.

    Raises:
        ValueError: If the system is at rest, or paths and bearings differ in number.
        SolveError: If no equilibrium was found and `throw`.
    """
    _check(system, network)
    cold = adjusted(system)
    if _is_traced(cold, network):
        rise, slowest, residual, steps, solved = _steady(cold, network)
        known = _within(rise)
        solution, _ = system_state(with_temperatures(cold, network, known))
    else:

        def evaluated(rise):
            return _evaluated(cold, network, rise)

        given = [_conductance(network), _capacity(network)]
        found, solution = _searched(evaluated, given, None, _while_loop)
        rise, slowest, residual = found.rise, -found.fastest, found.residual
        steps, solved, known = found.steps, found.solved, _within(rise)
        if np.any(np.asarray(known) != np.asarray(rise)):
            solution = evaluated(known)[2]
    flow = _conductance(network) @ rise
    warm = jnp.where(solved, rise, jnp.nan) + network.ambient
    rings = warm[: 2 * len(network.paths)].reshape(-1, 2)
    result = jnp.where(solved, solution.result, int(Result.STEP_LIMIT))
    found = ThermalState(
        inner_ring=rings[:, 0],
        outer_ring=rings[:, 1],
        housing=network.ambient if network.housing is None else warm[-1],
        friction=flow[: 2 * len(network.paths)].reshape(-1, 2).sum(axis=1),
        system=with_temperatures(system, network, known),
        solution=solution,
        slowest=slowest,
        residual=residual,
        steps=steps,
        result=result,
    )

    return (
        raise_unless_converged(found, result, lambda: overheated(found))
        if throw
        else found
    )


def overheated(state: ThermalState) -> str:
    """Return the message on a system without thermal equilibrium.

    Args:
        state: From `solve_heat`.
    """
    if int(state.solution.result) not in (Result.CONVERGED, Result.NON_FINITE):
        label = Result(int(state.solution.result)).label
        return f"solve_heat: the shafts have no equilibrium when warm: {label}."
    return (
        "solve_heat: no thermal equilibrium within"
        f" {_HOTTEST:g} K above the ambience: friction grows faster with temperature"
        " than cooling. Give less preload or speed, more clearance, or larger"
        " conductances."
    )


def warm_up(
    system: ShaftSystem, network: HeatNetwork, times: Any, *, steps: int = 1
) -> Float[Array, "time node"]:
    """Integrate the temperatures of a system that starts from the cold.

    Args:
        system, network: As in `solve_heat`.
        times: Rising from 0 (time,) [s].
        steps: Steps between two times; twice as many tell the error.

    Returns:
        Temperatures (time, node) [K]: inner and outer ring of each bearing in turn,
        then the housing if it has a node; NaN from where they run away.
    """
    _check(system, network)
    cold, times = adjusted(system), as_real(times)
    if _is_traced(cold, network, times):
        return network.ambient + _transient(cold, network, times, steps)

    def evaluated(rise):
        return _evaluated(cold, network, rise)[:2]

    def made(rise):
        return evaluated(rise)[0]

    given = [_conductance(network), _capacity(network)]
    return network.ambient + _integrated(evaluated, made, given, times, steps, _scan)


def runaway_speed(
    system: ShaftSystem, network: HeatNetwork, highest: float, tolerance: float = 1e-3
) -> float:
    """Return the speed of the drive from which temperatures run away [rad/s].

    Args:
        system, network: As in `solve_heat`; the sign of the drive's speed is kept.
        highest: Speed up to which it is sought, above 0 [rad/s].
        tolerance: Of the speed, relative [1].

    Returns:
        Speed, infinite if they do not run away up to the highest.
    """
    assert system.drive is not None
    sense = -1.0 if float(system.drive.speed) < 0 else 1.0

    def stays(speed):
        turning = eqx.tree_at(lambda s: s.drive.speed, system, as_real(sense * speed))
        found = solve_heat(turning, network, throw=False)
        return int(found.result) == Result.CONVERGED

    if stays(highest):
        return np.inf
    low, high = 0.0, highest
    while high - low > tolerance * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stays(middle) else (low, middle)
    return high


def _check(system, network) -> None:
    if len(network.paths) != len(system.seats):
        raise ValueError(
            f"solve_heat: the network has {len(network.paths)} paths and the system"
            f" {len(system.seats)} bearings; give one for each, `None` of springs."
        )
    for seat, path in zip(system.seats, network.paths, strict=True):
        if (seat.installed is None) != (path is None):
            raise ValueError(
                f"solve_heat: {seat.name} is a bearing without paths of its heat, or"
                " springs with them."
            )
    if system.drive is None or (
        not is_traced(system.drive.speed) and float(system.drive.speed) == 0.0
    ):
        raise ValueError("solve_heat: the system is at rest; nothing warms it.")


def _is_traced(*trees: Any) -> bool:
    return any(is_traced(leaf) for leaf in jax.tree.leaves(trees))


def _within(rise):
    """Return rises at which materials have numbers, of what has run away."""
    return jnp.clip(rise, -_HOTTEST / 3.0, _HOTTEST)


@program(quick=True)
def _evaluated(system, network, rise):
    """Return heat made at every node, its slope, and the equilibrium there.

    The one program of search and warming up, where nothing is traced: their loops run
    in Python, as compiling takes far longer than running.
    """
    return _with_slope(lambda rise: heat_and_state(rise, system, network), rise)


@program(quick=True)
def _conductance(network):
    return network.conductance()


@program(quick=True)
def _capacity(network):
    return network.capacity()


@program(quick=True)
def _steady(system, network):
    given = network.conductance(), network.capacity()
    return steady_rises(heat_made, (system, network), *given)


@program(quick=True)
def _transient(system, network, times, n):
    given = network.conductance(), network.capacity()
    return rises_over_time(heat_made, (system, network), *given, times, n)


def with_temperatures(
    system: ShaftSystem, network: HeatNetwork, rises: Float[Array, " node"]
) -> ShaftSystem:
    """Return a system whose bearings on seats have the temperatures of a network.

    Args:
        system: The system.
        network: Paths of the heat.
        rises: Of its nodes above the ambience (node,) [K].
    """
    seats = []
    for k, (seat, path) in enumerate(zip(system.seats, network.paths, strict=True)):
        installed = seat.installed
        if installed is None or path is None or installed.mounting is None:
            seats.append(seat)
            continue
        inner, outer = rises[2 * k], rises[2 * k + 1]
        known = installed.conditions
        cold = as_real(293.15) if known is None else known.reference
        base = network.ambient - jnp.where(cold > 0, 0.0, 293.15)
        parts = {
            "shaft": path.shaft_share * inner,
            "inner_ring": inner,
            "elements": 0.5 * (inner + outer),
            "outer_ring": outer,
            "housing": path.housing_share * outer,
        }
        warm = FitConditions(
            **{name: base + rise for name, rise in parts.items()}, reference=cold
        )
        seats.append(
            eqx.tree_at(
                lambda s: s.installed.conditions,
                seat,
                warm,
                is_leaf=lambda leaf: leaf is None,
            )
        )
    return eqx.tree_at(lambda s: s.seats, system, tuple(seats))


def friction_power(oil: Any, solution: Solution, temperature: Any) -> Scalar:
    """Return the power lost in a bearing [W].

    Args:
        oil: `ThermalPaths`, or another Module with their lubricant, supply, skf, series
            and diameters.
        solution: Of the bearing, turning.
        temperature: Of its oil [K].

    Raises:
        ValueError: For bearings without known constants of friction.
    """
    viscosity = oil.lubricant.kinematic_viscosity(temperature)
    given = solution, viscosity, oil.supply
    if not oil.skf:
        return friction_torque(*given).power
    sizes = None if oil.diameters is None else tuple(oil.diameters)
    return skf_friction_torque(*given, series=oil.series, diameters=sizes).power


def heat_made(
    rises: Float[Array, " node"], args: tuple[ShaftSystem, HeatNetwork]
) -> Float[Array, " node"]:
    """Return the heat made at every node [W].

    Args:
        rises: Of the nodes above the ambience (node,) [K].
        args: The system, from `adjusted`, and its network.
    """
    return heat_and_state(rises, *args)[0]


def heat_and_state(
    rises: Float[Array, " node"], system: ShaftSystem, network: HeatNetwork
) -> tuple[Float[Array, " node"], SystemSolution]:
    """Return the heat made at every node [W], and the equilibrium there.

    Args:
        rises: Of the nodes above the ambience (node,) [K].
        system: The system, from `adjusted`.
        network: Paths of its heat.
    """
    warm = with_temperatures(system, network, rises)
    solution, _ = system_state(warm)
    none = jnp.zeros_like(rises[0])
    made = [none] * network.nodes
    if network.housing is not None:
        made[-1] = solution.power.loss
    turning = [k for k, path in enumerate(network.paths) if path is not None]
    if not turning:
        return jnp.stack(made), solution
    speeds = [speed_of(warm, k, solution.power.speed)[0].inner for k in turning]
    oil = [network.ambient + 0.5 * (rises[2 * k] + rises[2 * k + 1]) for k in turning]

    def lost(both, motion, turns, temperature):
        installed, path = both
        given = motion, Speed(inner=turns), warm.inertia, 2
        return friction_power(path, in_place(installed, *given), temperature)

    # Like bearings share one program.
    parts = [(warm.seats[k].installed, network.paths[k]) for k in turning]
    given = solution.motion[np.array(turning, int)], jnp.stack(speeds), jnp.stack(oil)
    for k, power in zip(turning, of_each(lost, parts, *given), strict=True):
        made[2 * k] = made[2 * k + 1] = 0.5 * power
    return jnp.stack(made), solution

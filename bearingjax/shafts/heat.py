"""Temperatures of a system of shafts: friction warms bearings, and warmth loads them.

Each bearing has two temperatures, of its inner ring with the shaft below it and of its
outer ring with the seat around it; the housing with the oil sump may have one more.
Friction heats both rings alike, losses of meshes heat the housing. Heat flows from the
inner ring along the shaft to the surroundings, from ring to ring, from the outer ring
to the housing, or without one to the surroundings, and from the housing to these.
Friction depends on temperature through viscosity, and through the clearance and the
preload of warm rings, shafts and housings.
"""

from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design.checks import check, check_fields, is_traced, number
from ..element.inertia import Speed
from ..fits import FitConditions
from ..friction.reference_speed import heat_area
from ..numerics.compiled.programs import program
from ..numerics.labels import to_xarray
from ..numerics.result import Result, raise_unless_converged
from ..numerics.shown import Printable
from ..numerics.types import Real, RealOrNone, Scalar, as_real
from ..numerics.units import real, unit
from ..rotor.like_parts import map_parts
from .bearing_oil import BearingOil
from .equilibrium import system_state
from .heat_balance import (
    HOTTEST,
    integrate_heat,
    rises_over_time,
    search_temperatures,
    steady_rises,
    stepped_scan,
    stepped_while,
    with_slope,
)
from .seats import in_place, speed_of, with_preload_offsets
from .state import SystemSolution
from .system import ShaftSystem

SEAT_FLOW = 16e3 / 50.0
"""Heat flow that ISO 15312 takes from the seats of a radial bearing, over the area of
the seats and the rise of temperature [W/(m² K)]."""


def usual_conductance(bore: Any, outside_diameter: Any, width: Any) -> Any:
    """Usual conductance of each ring of a radial bearing, for `ThermalPaths` [W/K].

    Half of the heat flow at the reference of ISO 15312, over its rise of 50 K.

    Args:
        bore, outside_diameter, width: As in `heat_area` [m].
    """
    return 0.5 * SEAT_FLOW * heat_area(bore, outside_diameter, width)


class ThermalPaths(eqx.Module):
    """Paths of the heat of a bearing.

    Attributes:
        inner: From the inner ring along the shaft to the surroundings [W/K].
        outer: From the outer ring to the housing, or without one to the surroundings
            [W/K].
        through: From ring to ring, by rolling elements and oil [W/K].
        shaft_share: Rise of the shaft below the bearing over that of the inner ring,
            above the surroundings [1].
        housing_share: Rise of the seat over that of the outer ring [1].
        inner_capacity: Heat capacity of the inner ring with the shaft below it, which
            counts in time only [J/K].
        outer_capacity: Heat capacity of the outer ring with its seat, likewise [J/K].
        oil: Oil of the bearing, as warm as the mean of both rings.

    Traced: all numbers.
    """

    about: ClassVar[str] = "paths of the heat of a bearing"
    inner: Real = eqx.field(
        **real(
            "W/K",
            "from the inner ring along the shaft to the surroundings",
            above=0,
            otherwise="by the area of its seats",
        )
    )
    outer: Real = eqx.field(
        **real(
            "W/K",
            "from the outer ring to the housing, or without one to the surroundings",
            above=0,
            otherwise="by the area of its seats",
        )
    )
    oil: BearingOil
    through: Real = eqx.field(
        **real("W/K", "from ring to ring, by rolling elements and oil"), default=0.0
    )
    shaft_share: Real = eqx.field(
        **real(
            "1",
            "rise of the shaft below the bearing over that of the inner ring",
            least=0,
            most=1,
        ),
        default=1.0,
    )
    housing_share: Real = eqx.field(
        **real("1", "rise of the seat over that of the outer ring", least=0, most=1),
        default=1.0,
    )
    inner_capacity: Real = eqx.field(
        **real(
            "J/K", "heat capacity of the inner ring with the shaft below it", above=0
        ),
        default=1000.0,
    )
    outer_capacity: Real = eqx.field(
        **real("J/K", "heat capacity of the outer ring with its seat", above=0),
        default=1000.0,
    )

    def __check_init__(self):
        check_fields(self)


class HeatNetwork(eqx.Module):
    """Paths of all heat of a system.

    Attributes:
        ambient: Temperature of the surroundings [K].
        paths: Heat paths of each bearing; `None` of springs.
        housing: From the housing to the surroundings [W/K]; `None`: the housing is as
            cold as the surroundings, and takes the losses of the meshes.
        housing_capacity: Heat capacity of housing and oil [J/K].
    """

    ambient: Real = eqx.field(**real("K", "temperature of the surroundings"))
    paths: tuple[ThermalPaths | None, ...] = eqx.field(converter=tuple)
    housing: RealOrNone = eqx.field(
        **real(
            "W/K",
            "from the housing to the surroundings",
            above=0,
            otherwise="as cold as the surroundings; it takes the losses of meshes",
        ),
        default=None,
    )
    housing_capacity: Real = eqx.field(
        **real("J/K", "heat capacity of housing and oil", above=0), default=20e3
    )

    def __check_init__(self):
        number(self, "ambient")
        if not is_traced(self.ambient):
            warm = 150.0 < float(self.ambient) < 600.0
            check(self, "ambient", warm, "a temperature in K, from 150 to 600 K")
        check_fields(self)

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
            matrix = _add_conductance(matrix, i, o, path.through)
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


def _add_conductance(matrix, i, j, conductance):
    matrix = matrix.at[i, i].add(conductance).at[j, j].add(conductance)
    return matrix.at[i, j].add(-conductance).at[j, i].add(-conductance)


class ThermalState(Printable):
    """Temperatures of a system in equilibrium with its friction.

    Attributes:
        inner_ring: Temperature of each inner ring (bearing,) [K].
        outer_ring: Temperature of each outer ring (bearing,) [K].
        housing: Temperature of housing and oil [K]; the surroundings without a node of
            its own.
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
    residual: Scalar = eqx.field(metadata=unit("1"))
    steps: Int[Array, ""]
    result: Int[Array, ""]

    to_xarray = to_xarray

    @property
    def failure_message(self) -> str:
        """Why there is no thermal equilibrium, in words; empty if there is one."""
        if int(self.result) == Result.CONVERGED:
            return ""
        if int(self.solution.result) not in (Result.CONVERGED, Result.NON_FINITE):
            label = Result(int(self.solution.result)).label
            return f"solve_heat: the shafts have no equilibrium when warm: {label}."
        return (
            "solve_heat: no thermal equilibrium within"
            f" {HOTTEST:g} K above the surroundings: friction grows faster with"
            " temperature than cooling. Give less preload or speed, more clearance, or"
            " larger conductances."
        )


def solve_heat(
    system: ShaftSystem, network: HeatNetwork, *, throw: bool = True
) -> ThermalState:
    """Find the temperatures of a system, and its equilibrium at them.

    A system at rest is as cold as the surroundings.

    Args:
        system: The system; clearances, preloads and the distance of its bearings change
            with temperature where bearings have seats (`Installed.mounting`), without
            them only the viscosity of the oil.
        network: Paths of the heat.
        throw: Raise if there is no thermal equilibrium. Static.

    Returns:
        ThermalState, differentiable with respect to all numbers of both.

    Fails: `STEP_LIMIT`: temperatures run away.

    Raises:
        ValueError: If paths and bearings differ in number.
        SolveError: If no equilibrium was found and `throw`.
    """
    _check(system, network)
    cold = with_preload_offsets(system)
    if _is_traced(cold, network):
        rise, slowest, residual, steps, solved = _steady(cold, network)
        known = _clip_rises(rise)
        solution, _ = system_state(with_temperatures(cold, network, known))
    else:

        def evaluate(rise):
            return _evaluate_at_rest(cold, network, rise)

        given = [_conductance(network), _capacity(network)]
        found, solution = search_temperatures(evaluate, given, None, stepped_while)
        rise, slowest, residual = found.rise, -found.fastest, found.residual
        steps, solved, known = found.steps, found.solved, _clip_rises(rise)
        if np.any(np.asarray(known) != np.asarray(rise)):
            solution = evaluate(known)[2]
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

    if not throw:
        return found
    return raise_unless_converged(
        found, result, lambda: found.failure_message, "solve_heat"
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
    cold, times = with_preload_offsets(system), as_real(times)
    if _is_traced(cold, network, times):
        return network.ambient + _transient(cold, network, times, steps)

    def evaluate(rise):
        return _evaluate_at_rest(cold, network, rise)[:2]

    def heat_at(rise):
        return evaluate(rise)[0]

    given = [_conductance(network), _capacity(network)]
    return network.ambient + integrate_heat(
        evaluate, heat_at, given, times, steps, stepped_scan
    )


def runaway_speed(
    system: ShaftSystem, network: HeatNetwork, highest: float, tolerance: float = 1e-3
) -> float:
    """Return the speed of the drive from which temperatures run away [rad/s].

    Args:
        system, network: As in `solve_heat`; the sign of the drive's speed is kept.
        highest: Speed up to which it is sought, above 0 [rad/s].
        tolerance: Relative error allowed of the speed [1].

    Returns:
        Speed, infinite if they do not run away up to the highest.
    """
    assert system.drive is not None
    sense = -1.0 if float(system.drive.speed) < 0 else 1.0

    def stays(speed):
        drive = eqx.tree_at(lambda d: d.speed, system.drive, as_real(sense * speed))
        turning = system.with_parts(drive=drive)
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


def _evaluate_at_rest(system, network, rise):
    """Return `_evaluate`; at rest nothing makes heat."""
    if system.turns:
        return _evaluate(system, network, rise)
    solution, _ = system_state(with_temperatures(system, network, rise))
    return jnp.zeros_like(rise), jnp.zeros((rise.size, rise.size)), solution


def _is_traced(*trees: Any) -> bool:
    return any(is_traced(leaf) for leaf in jax.tree.leaves(trees))


def _clip_rises(rise):
    """Return rises at which materials have numbers, of what has run away."""
    return jnp.clip(rise, -HOTTEST / 3.0, HOTTEST)


@program(quick=True)
def _evaluate(system, network, rise):
    """Return heat made at every node, its slope, and the equilibrium there.

    The one program of search and warming up, where nothing is traced: their loops run
    in Python, as compiling takes far longer than running.
    """
    return with_slope(lambda rise: heat_and_state(rise, system, network), rise)


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
        rises: Rise of its nodes above the surroundings (node,) [K].
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


def heat_made(
    rises: Float[Array, " node"], args: tuple[ShaftSystem, HeatNetwork]
) -> Float[Array, " node"]:
    """Return the heat made at every node [W].

    Args:
        rises: Rise of the nodes above the surroundings (node,) [K].
        args: The system, from `with_preload_offsets`, and its network.
    """
    return heat_and_state(rises, *args)[0]


def heat_and_state(
    rises: Float[Array, " node"], system: ShaftSystem, network: HeatNetwork
) -> tuple[Float[Array, " node"], SystemSolution]:
    """Return the heat made at every node [W], and the equilibrium there.

    Args:
        rises: Rise of the nodes above the surroundings (node,) [K].
        system: The system, from `with_preload_offsets`.
        network: Paths of its heat.
    """
    warm = with_temperatures(system, network, rises)
    solution, _ = system_state(warm)
    none = jnp.zeros_like(rises[0])
    made = [none] * network.nodes
    if network.housing is not None:
        made[-1] = solution.power.loss
    turning = [k for k, path in enumerate(network.paths) if path is not None]
    if not turning or warm.inertia is None:
        return jnp.stack(made), solution
    speeds = [speed_of(warm, k, solution.power.speed)[0].inner for k in turning]
    oil = [network.ambient + 0.5 * (rises[2 * k] + rises[2 * k + 1]) for k in turning]

    def power_loss(both, motion, turns, temperature):
        installed, path = both
        given = motion, Speed(inner=turns), warm.inertia, 2
        return path.oil.power(in_place(installed, *given), temperature)

    # Like bearings share one program.
    parts = [(warm.seats[k].installed, network.paths[k]) for k in turning]
    given = solution.motion[np.array(turning, int)], jnp.stack(speeds), jnp.stack(oil)
    for k, power in zip(turning, map_parts(power_loss, parts, *given), strict=True):
        made[2 * k] = made[2 * k + 1] = 0.5 * power
    return jnp.stack(made), solution

"""Temperatures of a network: those that it reaches from the cold, and on the way.

Where nothing is traced the loops run in Python (`stepped_while`, `stepped_scan`), over
steps that are compiled one by one.
"""

from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ..numerics.compiled.programs import program
from ..numerics.implicit import attach_by, stop_gradient
from ..numerics.lapack import eigvals, solve_any
from ..numerics.types import T
from ..numerics.units import unit

HOTTEST = 300.0
"""Rise above the surroundings from which there is no thermal equilibrium [K]."""
_STEPS = 100
_TOLERANCE = 1e-10
"""Heat out of balance over the heat that is made [1]."""
_LEAST, _GROWTH = 1.5, 4.0
"""Factors by which the steps in time grow as the balance is approached [1]."""

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
        conductance: Conductances of the network (node, node) [W/K].
        capacity: Heat capacity of the nodes (node,) [J/K].

    Returns:
        Rises above the surroundings (node,) [K], differentiable with respect to args,
        conductance and capacity; rate of the slowest disturbance [1/s]; residual [1];
        steps; whether it was found. Rises are those of the last step if it was not.
    """
    still, *network = stop_gradient((args, conductance, capacity))

    def evaluate(rise):
        return with_slope(lambda rise: (heat(rise, still), ()), rise)

    found, _ = search_temperatures(evaluate, network, (), lax.while_loop)

    def balance(rise, args):
        heat_args, conductance = args
        return heat(rise, heat_args) - conductance @ rise

    def correct(of_rise, rise, change, args):
        matrix = jax.jacfwd(of_rise)(rise)
        return -solve_any(matrix, change)

    rise = attach_by(balance, found.rise, (args, conductance), correct)
    return rise, -found.fastest, found.residual, found.steps, found.solved


def with_slope(heat: Callable, rise: Float[Array, " node"]) -> tuple:
    """Return heat made at every node, its slope over the rises, and something else.

    Args:
        heat: Rises -> heat made at every node, and something else.
        rise: Rises (node,) [K].
    """

    def with_value(rise):
        made, more = heat(rise)
        return made, (made, more)

    slope, (made, more) = jax.jacfwd(with_value, has_aux=True)(rise)
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

    after: Annotated[Array, unit("K")]
    rise: Annotated[Array, unit("K")]
    fastest: Annotated[Array, unit("1/s")]
    residual: Annotated[Array, unit("1")]
    time: Annotated[Array, unit("s")]
    steps: Array
    going: Array

    @property
    def solved(self):
        return (self.residual <= _TOLERANCE) & (self.fastest < 0)


def search_temperatures(
    evaluated: Callable, network: Any, nothing: Any, while_loop: Callable
) -> tuple:
    """Search the temperatures that a system reaches from the cold.

    Args:
        evaluated: Rises -> heat made, its slope, and something else.
        network: Conductance and capacity as in `steady_rises`.
        nothing: In place of what else is evaluated, before the first step.
        while_loop: `lax.while_loop`, or `stepped_while`.

    Returns:
        Last state, and what else was evaluated at its `rise`.
    """

    def step(carry):
        made, slope, more = evaluated(carry[0].after)
        return _advance(carry[0], made, slope, network), more

    begin = _begin(network)
    return while_loop(lambda carry: carry[0].going, step, (begin, nothing))


def stepped_while(going: Callable, step: Callable, carry: T) -> T:
    """`lax.while_loop` of steps that are compiled one by one."""
    while going(carry):
        carry = step(carry)
    return carry


@program(quick=True)
def _begin(network):
    conductance, capacity = network
    zero, none = jnp.zeros_like(capacity), jnp.zeros((), capacity.dtype)
    shortest = jnp.min(capacity / jnp.diagonal(conductance))
    counted = jnp.zeros((), jnp.int32), jnp.ones((), bool)
    return _Search(zero, zero, none, none + jnp.inf, 0.3 * shortest, *counted)


@program(quick=True)
def _advance(state, made, slope, network):
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
    going = (new > _TOLERANCE) & jnp.all(after < HOTTEST)
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
        Rises above the surroundings (time, node) [K]; NaN from where they run away.

    Source: Verwer's ROS2, linearly implicit, of second order and L-stable.
    """

    def evaluate(rise):
        return with_slope(lambda rise: (heat(rise, args), ()), rise)[:2]

    def heat_at(rise):
        return heat(rise, args)

    return integrate_heat(
        evaluate, heat_at, [conductance, capacity], times, n, lax.scan
    )


_GAMMA = 1.0 - np.sqrt(0.5)


def integrate_heat(
    evaluated: Callable,
    made: Callable,
    network: Any,
    times: Array,
    n: int,
    scan: Callable,
) -> Array:
    """Return rises over time (time, node) [K].

    Args:
        evaluated: Rises -> heat made, and its slope.
        made: Rises -> heat made.
        network: Conductance and capacity as in `rises_over_time`.
        times, n: As there.
        scan: `lax.scan`, or `stepped_scan`.
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


def stepped_scan(step: Callable, carry: Any, given: Any) -> tuple[Any, Array]:
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
    return jnp.where(jnp.all(after < HOTTEST), after, jnp.nan), after

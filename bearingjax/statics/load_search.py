"""The search for the equilibrium under a load, and its calls of the bearing model.

Minimises V(q) - load·q over the free freedoms of the moving ring. With linearised
kinematics this is convex, so the trust-region Newton method on the exact V, V′, V″
converges from anywhere, or runs away where nothing holds the load, and says so.
"""

from collections.abc import Callable
from functools import partial
from typing import Annotated, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ..design import AbstractBallBearing, SetRow
from ..element.bearing_model import BearingModel, SolvedElements
from ..numerics.compiled import batched_loop
from ..numerics.implicit import attach_by, stop_gradient
from ..numerics.linear import null_space, solve
from ..numerics.minimise import (
    Evaluation,
    Minimum,
    Problem,
    TrustRegionNewton,
    continuation,
)
from ..numerics.types import Scalar
from ..numerics.units import unit
from .balance import Balance
from .options import SolveOptions

SLOTS, IDLE = 64, 4
"""Cases of a batch that are at work at a time, and how many of them may be done."""


class SearchMemory(NamedTuple):
    """State kept from an evaluation of the energy.

    Attributes:
        solved: The solved rolling elements.
        stiffness: Stiffness of the free unknowns, zero for held ones (6, 6) [N/m].
    """

    solved: SolvedElements
    stiffness: Annotated[Float[Array, "6 6"], unit("N/m")]


class SearchStart(NamedTuple):
    """Start of a search.

    Attributes:
        y: First unknowns (6,) [m].
        step: First bound of the steps [m].
        limit: Size of the unknowns beyond which the load is not supported [m].
        load: Components of the load along the free unknowns (6,) [N].
        size: Its size [N].
        inertia: Largest inertia force of a rolling element [N].
        factor: Multiple of the load at the start of the search, at least 1.
    """

    y: Annotated[Float[Array, "6"], unit("m")]
    step: Annotated[Scalar, unit("m")]
    limit: Annotated[Scalar, unit("m")]
    load: Annotated[Float[Array, "6"], unit("N")]
    size: Annotated[Scalar, unit("N")]
    inertia: Annotated[Scalar, unit("N")]
    factor: Scalar


def search_start(
    rows: tuple[SetRow, ...],
    model: BearingModel,
    balance: Balance,
    start: Float[Array, "6"] | None,
) -> SearchStart:
    """First unknowns and first load of a search, from the sizes of the bearing.

    A load that presses the contacts by far less than the play that it takes up is
    approached from a larger one, by tens: with it, as with a barrier method, all
    contacts that matter are found early and Newton's method stays on their side.

    Args:
        rows: Designs of the rows.
        model: The bearing at the speeds.
        balance: The load and what holds the rings.
        start: As in `solve_load`.
    """
    load, radius = balance.free_part(balance.load), balance.radius
    size = jnp.sqrt(load @ load)
    play = _play(rows)
    pressing = _load_for(model, play)
    factor = jnp.where(size > 0, jnp.maximum(1.0, pressing / size), 1.0)
    y = balance.held_values
    if start is not None:
        there = jnp.where(jnp.isfinite(start), start, 0.0)
        near = balance.free * there / balance.scale
        known = jnp.all(jnp.isfinite(start)) & (near @ near < radius * radius)
        y = y + jnp.where(known, near, 0.0)
        factor = jnp.where(known, 1.0, factor)
    limit = 8.0 * radius + jnp.abs(y[5])
    # About the way on which play is taken up and a contact bears the load. Far shorter
    # ones cost a step for each factor of four, longer ones may turn barrel rollers out
    # of their raceways under loads beyond all ratings.
    step = 1e-7 * radius + play + _approach_under(model, size, radius)
    inertia = _largest_inertia(model, size)
    return SearchStart(y, step, limit, load, size, inertia, factor)


def search(
    model: BearingModel,
    balance: Balance,
    begin: SearchStart,
    options: SolveOptions,
) -> Minimum:
    """Minimise the energy less the work of the load. Without derivatives.

    Args:
        model: The bearing at the speeds.
        balance: The load and what holds the rings.
        begin: Start of the search.
        options: Settings, the tolerance among them.
    """
    solver = TrustRegionNewton(symmetric=model.has_potential, softest=0.03)
    # To know its shapes takes a part of the time of tracing a solve: once.
    shapes = jax.eval_shape(model.unsolved_state)
    problem = partial(_problem, shapes=shapes)
    loop = continuation(solver, problem, lambda given: given.begin.factor)
    given = _Inputs(model, balance, begin, options)
    return batched_loop.run(loop, given, slots=SLOTS, idle=IDLE)


class _Inputs(NamedTuple):
    """The arguments of `search`."""

    model: BearingModel
    balance: Balance
    begin: SearchStart
    options: SolveOptions


def _problem(given: _Inputs, shapes: SolvedElements) -> Problem:
    model, balance, begin, options = given
    # Nothing carries a load, so no solve starts from it.
    unsolved = jax.tree.map(lambda a: jnp.zeros(a.shape, a.dtype), shapes)
    none = jnp.zeros((6, 6), balance.radius.dtype)
    return Problem(
        _energy(model, balance),
        begin.y,
        begin.step,
        memory=SearchMemory(unsolved, none),
        direction=begin.load / jnp.where(begin.size > 0, begin.size, 1.0),
        limit=begin.limit,
        force=begin.load,
        tolerance=options.tolerance,
        max_steps=options.max_steps,
    )


def _energy(model: BearingModel, balance: Balance) -> Callable[..., Evaluation]:
    """The energy of the bearing as a function of the unknowns, without the load."""
    weight, moving = balance.free * balance.scale, balance.moving_slice

    def function(y, _, before):
        q = balance.ring_freedoms(y)
        solved = model.solve(q, model.starts(before.solved))
        e = model.evaluate(q, solved)
        h = jnp.outer(weight, weight) * e.stiffness[moving, moving]
        # Round-off of forces that cancel, and of positions in a stiff bearing.
        floor = e.magnitude + jnp.trace(h) * jnp.sqrt(y @ y)
        return Evaluation(
            value=e.energy if model.has_potential else jnp.full_like(e.energy, jnp.nan),
            gradient=balance.free_part(e.force[moving]),
            hessian=h + jnp.diag(1.0 - balance.free),
            scale=e.magnitude,
            noise=jnp.finfo(y.dtype).eps * floor,
            memory=SearchMemory(solved, h),
        )

    return function


def differentiable_unknowns(
    model: BearingModel, balance: Balance, minimum: Minimum
) -> Float[Array, "6"]:
    """The unknowns found, differentiable by the implicit function theorem [m].

    In directions in which the ring floats, also oblique ones, derivatives by a load
    along them are infinite: the smallest load moves the ring until other elements carry
    load. All other derivatives are zero there. If no element contacts both rings, at
    rest or at speed, the ring floats in all free directions.

    Args:
        model: The bearing at the speeds.
        balance: The load and what holds the rings.
        minimum: Result of the search; its memory is `SearchMemory`.
    """
    # All that is traced goes through the arguments: a derivative rule must not close
    # over it.
    known = minimum.memory
    apart = model.is_apart(known.solved)
    stiffness = jnp.where(apart, 0.0, known.stiffness)
    args = model, balance, known.solved, stiffness

    def correction(of_y, y, change, args):
        model, balance, _, stiffness = args
        floating = _free_projector(stiffness, balance.free)
        return -_by_stiffness(
            jax.jacfwd(of_y)(y), change, floating, model.has_potential
        )

    y = attach_by(_residual, minimum.x, args, correction)
    load = balance.free_part(balance.load)
    return _without_limit(y, load, stiffness, balance.free)


def _free_projector(stiffness, free):
    """Projector on the free directions that no more than round-off holds (6, 6) [1]."""
    size = jnp.max(jnp.diagonal(stiffness))
    size = jnp.where(size > 0, size, 1.0)
    return null_space(stop_gradient(stiffness / size + jnp.diag(1.0 - free)))


def _by_stiffness(stiffness, force, floating, symmetric):
    """Displacement of the unknowns [m] under a force, zero along those that float.

    Along unrestrained directions it would be round-off divided by round-off.
    """
    size = jnp.max(jnp.diagonal(stiffness))
    force = force - floating @ force
    moved = solve(stiffness + size * floating, force, symmetric)
    return moved - floating @ moved


@jax.custom_jvp
def _without_limit(y, load, stiffness, free):
    """`y`, with infinite derivatives by a load along which it floats."""
    return y


def _rule(primals, tangents):
    change, by_load, *_ = tangents
    y, _, stiffness, free = primals
    change = jnp.zeros_like(y) if isinstance(change, SymbolicZero) else change
    if not isinstance(by_load, SymbolicZero):
        change = change + _infinite_rate(by_load, _free_projector(stiffness, free))
    return _without_limit(*primals), change


def _infinite_rate(rate, floating):
    """Infinity times the part of `rate` that floats, 0 where that is round-off.

    To JAX it is a linear solve, which says itself what its transpose is.
    """

    def times(_, rate):
        part = floating @ rate
        least = jnp.sqrt(jnp.finfo(rate.dtype).eps) * jnp.max(jnp.abs(rate))
        return jnp.where(jnp.abs(part) <= least, 0.0, jnp.inf * part)

    return lax.custom_linear_solve(lambda x: 0.0 * x, rate, times, times)


_without_limit.defjvp(_rule, symbolic_zeros=True)


def _residual(y, args):
    """Zero in balance."""
    model, balance, solved, _ = args
    # Held freedoms take their prescribed values, not those of `y`, which would make the
    # Jacobian between held and free ones unsymmetric.
    held = balance.held_values
    q = balance.ring_freedoms(balance.free * y + held)
    # gz may be prescribed: the answer follows it through the azimuths.
    force = model.force(q, model.follow_azimuths(q, solved))
    return balance.out_of_balance(force) + (1.0 - balance.free) * y - held


def _play(rows: tuple[SetRow, ...]) -> Scalar:
    """Largest play between the rings, radial or axial [m]."""
    plays = [row.bearing.play + jnp.abs(row.inner_offset) for row in rows]
    # Less than this and a small load would follow the groove in tiny steps.
    least = [
        2e-3 * row.bearing.centre_distances[1]
        for row in rows
        if isinstance(row.bearing, AbstractBallBearing)
    ]
    return jnp.max(jnp.stack([jnp.zeros_like(plays[0]), *plays, *least]))


def _load_for(model: BearingModel, approach: Scalar) -> Scalar:
    """Load of one raceway contact pressed by `approach` [N]."""
    loads = model.of_elements(lambda one: one.hints.approximate_load(approach))
    return jnp.max(jnp.stack([jnp.max(load) for load in loads]))


def _approach_under(model: BearingModel, size: Scalar, radius: Scalar) -> Scalar:
    """About the approach of one raceway contact under a load of that size [m].

    Between the powers 2/3 of points and 9/10 of lines; at most a tenth of the radius,
    and zero where the elements do not estimate their loads.
    """
    known = 1e-3 * radius
    load = _load_for(model, known)
    loaded = load > 0
    approach = known * (size / jnp.where(loaded, load, 1.0)) ** 0.8
    return jnp.where(loaded, jnp.minimum(approach, 0.1 * radius), 0.0)


def _largest_inertia(model: BearingModel, like: Scalar) -> Scalar:
    """Largest inertia force of a rolling element [N]."""
    sizes = model.of_elements(lambda one: one.hints.inertia_scale())
    found = [jnp.max(size) for size in sizes if size is not None]
    return jnp.max(jnp.stack(found)) if found else jnp.zeros_like(like)

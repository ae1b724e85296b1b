"""Equilibrium of one rolling element between given rings, and its condensation.

Its own unknowns are those that minimise its energy, a convex problem with linearised
kinematics; where part of the forces has no potential, those that balance them.
"""

import dataclasses
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..numerics import lanes
from ..numerics.implicit import attach, recall, stop
from ..numerics.linear import dot, norm, smallest_pivot, solve, trace
from ..numerics.minimise import (
    AbstractMinimiser,
    Evaluation,
    Problem,
    TrustRegionNewton,
)
from ..numerics.result import Result
from ..numerics.types import Scalar
from .model import AbstractModel, Derivatives, Rings, Unknowns


class LocalState(NamedTuple):
    """Solved state of one rolling element.

    Attributes:
        x: Its unknowns (n,) [m].
        residual: Force that is out of balance, relative to the contact loads [1].
        unbalanced: That force, of the unknowns in metres [N].
        steps: Evaluations that the solve took.
        result: `Result` code.
        responses: `AbstractModel.responses` at x, or empty.
    """

    x: Unknowns
    residual: Scalar
    unbalanced: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]
    responses: Any = ()


class Near(NamedTuple):
    """A rolling element solved at rings near by, from which it may start.

    Attributes:
        offset: Its unknowns less `AbstractModel.amid`, NaN if not known (n,) [m].
        follow: How its unknowns follow the rings (n, r).
        rings: Motion of both rings then (r,) [m, rad].
    """

    offset: Unknowns
    follow: Float[Array, "n r"]
    rings: Rings


def solve_element(
    model: AbstractModel,
    rings: Rings,
    magnitude: Scalar,
    minimiser: AbstractMinimiser,
    near: Near | None = None,
) -> LocalState:
    """Equilibrium of one rolling element in its own unknowns.

    Args:
        model: The rolling element.
        rings: Motion of both rings in its axes (r,) [m, rad].
        magnitude: Size of the displacements from which `rings` was computed, for
            the round-off floor of the residual [m].
        minimiser: Local solver.
        near: Its state at rings near by; `None`: not known.

    Returns:
        State whose `x` is differentiable, to every order, with respect to the model
        (design and speeds) and the ring motion.

    Raises:
        TypeError: If the solver needs a potential that the forces do not have.

    Fails: `STEP_LIMIT`, `NON_FINITE`; `NO_LOAD_PATH` if inertia throws the element
        off, because no contact holds it; `SADDLE` with finite kinematics.
    """
    if not model.has_potential:
        if not isinstance(minimiser, TrustRegionNewton):
            raise TypeError(
                f"BearingElement: `equilibrium` is {type(minimiser).__name__}(), which"
                " minimises an energy; gyroscopic moments and contact constants at the"
                " operating angle have none. Use TrustRegionNewton()."
            )
        minimiser = dataclasses.replace(minimiser, symmetric=False)
    given = _prepare(*stop((model, rings, magnitude, near)))
    state = lanes.run(_loop(minimiser), given)

    def residual(x, args):
        model, rings = args
        return model.derivatives(rings, x, of_own=True).gradient

    x = attach(residual, state.x, (model, rings), model.has_potential)
    return state._replace(x=x)


def is_loose(
    model: AbstractModel, off: Unknowns, magnitude: Scalar, load: Scalar, pull: Unknowns
) -> Bool[Array, ""]:
    """Whether a rolling element is held by no more than the guide spring.

    Its contacts then carry next to nothing, and what they carry does not balance, as
    a real squeeze between the rings does. The energy being convex, the load left out
    is bounded by the small one found here.

    Args:
        model: The rolling element.
        off: Its unknowns, less where the rings take it [m].
        magnitude: Size of the displacements of the rings [m].
        load: Sum of the sizes of contact loads and inertia force [N].
        pull: Derivative of the energy with respect to x [N].

    Returns:
        False for NaN, which must not pass for an open contact.
    """
    guide = model.guide
    contacts = pull - guide * off
    unbalanced = dot(contacts, contacts) >= (0.03 * load) ** 2
    # About 1e-8 N. With ten times this, rollers jump that matter to loads of 1e-3 N;
    # with a tenth, some loose rollers do not come to rest (benchmarks/robust_*.py).
    return unbalanced & (load <= 100.0 * guide * _size(model, off, magnitude))


def _size(model, x, magnitude):
    return magnitude + model.gap + norm(x)


def _load(model, derivatives):
    load = jnp.sum(derivatives.contact_load)
    inertia = model.inertia_size()
    return load if inertia is None else load + inertia


def solved_derivatives(
    model: AbstractModel, rings: Rings, magnitude: Scalar, state: LocalState
) -> Derivatives:
    """Energy and derivatives of a solved rolling element; all zero if it is loose.

    Without this an element that the guide spring leans on two rings would pass the
    stiffness of that contact, which falls only with the tenth root of its load (of a
    ball, the third).

    Args:
        model, rings, magnitude: As in `solve_element`.
        state: From `solve_element`.
    """
    x, responses = state.x, state.responses
    if jax.tree.leaves(responses):
        # The last step of the solve has them; only a derivative needs them anew.
        args = (model, rings, x)
        responses = recall(type(model).responses, responses, args)
    d = model.derivatives(rings, x, responses=responses)
    load = _load(model, d)
    pull = d.gradient[-model.n_unknowns :]
    off = x - model.amid(rings)
    loose = is_loose(*stop((model, off, magnitude, load, pull)))
    return jax.tree.map(lambda v: jnp.where(loose, 0.0, v), d)


class _Given(NamedTuple):
    """What a solve is given, and what depends on no step of it."""

    model: AbstractModel
    rings: Rings
    magnitude: Scalar
    centre: Unknowns
    start: Unknowns
    radius: Scalar
    is_open: Bool[Array, ""] | None


def _prepare(model, rings, magnitude, near) -> _Given:
    start, centre = model.first(rings), model.amid(rings)
    if near is not None:
        start = _followed(model, near, rings, start)
    is_open = model.is_open(rings)
    if is_open is not None:
        start = jnp.where(is_open, centre, start)
    radius = model.reach(rings) + model.gap + 1e-6 * model.diameter
    return _Given(model, rings, magnitude, centre, start, radius, is_open)


def _problem(given: _Given) -> Problem:
    model, rings = given.model, given.rings
    eps = jnp.finfo(rings.dtype).eps

    def function(x, with_hessian, *_):
        responses = model.responses(rings, x)
        d = model.derivatives(rings, x, of_own=True, responses=responses)
        g, h = d.gradient, d.hessian
        scale = _load(model, d)
        # Round-off of positions, and what is small against the guide's own force.
        size = _size(model, x, given.magnitude)
        noise = size * (eps * trace(h) + 1e-6 * model.guide)
        # A loose element need not be placed: its solve is over.
        loose = is_loose(model, x - given.centre, given.magnitude, scale, g)
        noise = jnp.where(loose, norm(g), noise)
        scale = jnp.where(loose, jnp.inf, scale)
        value = d.energy if model.has_potential else jnp.full_like(d.energy, jnp.nan)
        hessian = h if with_hessian else h[:0]
        return Evaluation(value, g, hessian, scale, noise, responses)

    def shape(x, step, size):
        return model.shape(rings, x, step, size)

    memory = jax.tree.map(
        lambda a: jnp.zeros(a.shape, a.dtype),
        jax.eval_shape(model.responses, rings, given.start),
    )
    shaping = shape if model.shapes_steps else None
    return Problem(function, given.start, given.radius, shaping, memory)


def _loop(minimiser: AbstractMinimiser) -> lanes.Loop:
    """The search of one element, which an open one need not begin."""
    loop = minimiser.loop(_problem)

    def terminate(given, state):
        ended = loop.terminate(given, state)
        return ended if given.is_open is None else ended | given.is_open

    def finish(given, state):
        minimum, is_open = loop.finish(given, state), given.is_open
        if is_open is not None:
            # Its loop has not run.
            minimum = minimum._replace(
                residual=jnp.where(is_open, 0.0, minimum.residual),
                unbalanced=jnp.where(is_open, 0.0, minimum.unbalanced),
                steps=jnp.where(is_open, 0, minimum.steps),
                result=jnp.where(is_open, int(Result.CONVERGED), minimum.result),
            )
        return _solved(given.model, given.rings, minimum)

    return loop._replace(terminate=terminate, finish=finish)


def _solved(model, rings, minimum) -> LocalState:
    result = minimum.result
    # Where part of the forces has no potential a pivot says nothing.
    if model.has_potential and not model.is_convex:
        h = model.derivatives(rings, minimum.x, of_own=True).hessian
        saddle = (smallest_pivot(h) < -1e-9) & (result == Result.CONVERGED)
        result = jnp.where(saddle, int(Result.SADDLE), result)
    if model.may_leave:
        # Thrown off: inertia along a direction that only the guide holds.
        lost = model.thrown_off(rings, minimum.x) & (result != int(Result.NON_FINITE))
        result = jnp.where(lost, int(Result.NO_LOAD_PATH), result)
    result = result.astype(jnp.int32)
    return LocalState(
        minimum.x,
        minimum.residual,
        minimum.unbalanced,
        minimum.steps,
        result,
        minimum.memory,
    )


def _followed(model, near, rings, otherwise):
    """Where an element gets to that follows the rings from near by."""
    moved = rings - near.rings
    step = near.follow @ moved
    reach, length = model.reach(moved), norm(step)
    # Barely held, it would go astray.
    step = step * jnp.minimum(1.0, reach / jnp.where(length > 0, length, 1.0))
    x = near.offset + model.amid(near.rings) + step
    return jnp.where(jnp.all(jnp.isfinite(x)), x, otherwise)


def near_by(model: AbstractModel, rings: Rings, state: LocalState, solved) -> Near:
    """What a solve at rings near by may start from.

    Args:
        model, rings, state: As solved.
        solved: Its `solved_derivatives`.
    """
    n = model.n_unknowns
    h = solved.hessian
    held = jnp.any(solved.contact_load > 0)
    offset = jnp.where(held, state.x - model.amid(rings), jnp.nan)
    follow = -solve(h[-n:, -n:], h[-n:, :-n], model.has_potential)
    return stop(Near(offset, jnp.where(held, follow, 0.0), rings))


def settle(state: LocalState, load: Scalar) -> LocalState:
    """Forgive the elements whose imbalance is nothing beside the bearing's load.

    A ball in the unloaded half, with no more than a slow orbit's centrifugal force to
    seat it, may need more steps than there are; it does not matter.

    Args:
        state: Solved elements, leading axis element.
        load: Largest contact load of the bearing [N].
    """
    late = state.result == int(Result.STEP_LIMIT)
    idle = late & (state.unbalanced <= 1e-12 * load)
    return state._replace(
        result=jnp.where(idle, int(Result.CONVERGED), state.result),
        residual=jnp.where(idle, 0.0, state.residual),
    )


def condensed_force(model: AbstractModel, solved: Derivatives) -> Rings:
    """Forces on the rings at the solved state, in the element's axes [N, N m]."""
    return solved.gradient[: -model.n_unknowns]


def condensed_stiffness(
    model: AbstractModel, hessian: Float[Array, "m m"]
) -> Float[Array, "r r"]:
    """K_rr - K_rx K_xx⁻¹ K_xr; symmetric to round-off if there is a potential.

    Args:
        model: The rolling element.
        hessian: Derivatives of its forces with respect to (rings, x).

    Source: static condensation 9 to 6, Sorokin, Zhang, Ivannikov (2018).
    """
    n = model.n_unknowns
    coupling, back = hessian[-n:, :-n], hessian[:-n, -n:]
    symmetric = model.has_potential
    moved = solve(hessian[-n:, -n:], coupling, symmetric)
    left = coupling if symmetric else back.T
    k = hessian[:-n, :-n] - jnp.sum(left[:, :, None] * moved[:, None, :], axis=0)
    return 0.5 * (k + k.T) if symmetric else k

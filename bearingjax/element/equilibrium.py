"""Equilibrium of one rolling element between given rings, and its condensation.

Its own unknowns are those that minimise its energy, a convex problem with linearised
kinematics; where part of the forces has no potential, those that balance them. Without
them, it is an energy of the ring motions alone.
"""

import dataclasses
from functools import partial
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..numerics import AbstractMinimiser, Evaluation, Result, TrustRegionNewton
from ..numerics.compiled import batched_loop
from ..numerics.expansion import Expansion
from ..numerics.implicit import attach, stop_gradient
from ..numerics.linear import dot, norm, smallest_pivot, solve, trace
from ..numerics.minimise import Problem
from ..numerics.types import Scalar
from ..numerics.units import unit, units
from .energy import derivatives, response, ring_motions
from .rolling_element import AbstractRollingElement, Unknowns

Rings = Float[Array, " r"]


_IDLE = 1e-7
"""Load over the largest of the bearing below which an element is idle [1]."""


class LocalState(NamedTuple):
    """Equilibrium position of a rolling element, and statistics of the solve.

    Attributes:
        x: Its unknowns (n,) [m].
        residual: Force that is out of balance, relative to the contact loads [1].
        unbalanced: Force out of balance, for unknowns in metres [N].
        steps: Evaluations that the solve took.
        result: `Result` code.
        contact_response: Contact response there, `AbstractRollingElement.respond`.
    """

    x: Annotated[Unknowns, unit("m")]
    residual: Annotated[Scalar, unit("1")]
    unbalanced: Annotated[Scalar, unit("N")]
    steps: Int[Array, ""]
    result: Int[Array, ""]
    contact_response: Expansion


class ElementStart(NamedTuple):
    """Rolling element solved at nearby ring positions, as a starting point.

    Attributes:
        offset: Its unknowns less its midpoint, NaN if not known (n,) [m].
        follow: Derivatives of its unknowns by the ring motions (n, r).
        rings: Motions of the rings then, see `energy.ring_motions` (r,) [m, rad].
    """

    offset: Annotated[Unknowns, unit("m")]
    follow: Float[Array, "n r"]
    rings: Annotated[Rings, units("m", "rad")]


class SolvedElement(NamedTuple):
    """Rolling element in equilibrium, with all data for its condensed energy.

    Attributes:
        element: The rolling element.
        state: Its equilibrium.
        magnitude: As in `solve_element` [m].
    """

    element: AbstractRollingElement
    state: LocalState
    magnitude: Annotated[Scalar, unit("m")]


def solve_element(
    element: AbstractRollingElement,
    rings: Rings,
    magnitude: Scalar,
    minimiser: AbstractMinimiser,
    near: ElementStart | None = None,
    absent: Bool[Array, ""] | None = None,
) -> tuple[LocalState, Expansion]:
    """Equilibrium of one rolling element in its own unknowns.

    Args:
        element: The rolling element.
        rings: Motions of the rings in its axes, see `ring_motions` (r,) [m, rad].
        magnitude: Size of the displacements from which `rings` was computed, for
            the round-off floor of the residual [m].
        minimiser: Local solver.
        near: Its state at rings near by; `None`: not known.
        absent: Whether there is none in its place, where nothing is solved and nothing
            carries load; `None`: there is.

    Returns:
        Its state, without derivatives (`own_unknowns` attaches them), and its
        `condense` energy there.

    Raises:
        TypeError: If the solver needs a potential that the forces do not have.

    Fails: `STEP_LIMIT`, `NON_FINITE`; `NO_LOAD_PATH` if inertia ejects the element,
        because no contact holds it; `SADDLE` with finite kinematics.
    """
    if not element.has_potential:
        if not isinstance(minimiser, TrustRegionNewton):
            raise TypeError(
                "BearingElement: `equilibrium` is a method that minimises an energy;"
                " gyroscopic moments and contact constants at the operating angle have"
                " none. Use Newton's method, the default."
            )
        minimiser = dataclasses.replace(minimiser, symmetric=False)
    frozen = stop_gradient((element, rings, magnitude, near))
    if element.n_unknowns == 0:
        state = _without_unknowns(*frozen[:2])
        found = condense(frozen[1], SolvedElement(frozen[0], state, frozen[2]))
        if absent is None:
            return state, found
        nothing = unloaded_result(frozen[1], state.x, state.contact_response)
        return jax.tree.map(partial(jnp.where, absent), nothing, (state, found))
    given = _prepare(*frozen, absent)
    contacts = jax.eval_shape(response, element, rings, given.start)
    loop = _loop(minimiser, contacts, given.is_open is not None)
    return batched_loop.run(loop, given, *element.hints.slots)


def _without_unknowns(element, rings) -> LocalState:
    contacts = response(element, rings, rings[:0])
    finite = jnp.all(jnp.isfinite(rings))
    result = jnp.where(finite, int(Result.CONVERGED), int(Result.NON_FINITE))
    zero = jnp.zeros((), rings.dtype)
    steps = jnp.zeros((), jnp.int32)
    return LocalState(rings[:0], zero, zero, steps, result.astype(jnp.int32), contacts)


def own_unknowns(solved: SolvedElement, rings: Rings) -> Unknowns:
    """Own unknowns of a solved rolling element, with their derivatives [m].

    Args:
        solved: The element and its equilibrium.
        rings: Motions of the rings there (r,) [m, rad].

    Returns:
        (n,), differentiable to any order with respect to the element (design and
        speeds) and the ring motions.
    """
    element = solved.element
    if element.n_unknowns == 0:
        return solved.state.x

    def residual(x, args):
        element, rings = args
        return derivatives(element, rings, x, of_own=True, with_hessian=False).gradient

    return attach(residual, solved.state.x, (element, rings), element.has_potential)


def is_loose(
    element: AbstractRollingElement,
    off: Unknowns,
    magnitude: Scalar,
    load: Scalar,
    pull: Unknowns,
) -> Bool[Array, ""]:
    """Whether a rolling element is held by no more than its tether spring.

    Its contacts then carry almost no load, and that load is not in balance, unlike
    that of an element squeezed between the rings. As the energy is convex, the load
    left out is bounded by the small one found here.

    Args:
        element: The rolling element.
        off: Its unknowns, less its midpoint [m].
        magnitude: Size of the displacements of the rings [m].
        load: Sum of the sizes of contact loads and inertia force [N].
        pull: Derivative of the energy with respect to x [N].

    Returns:
        False for NaN, which must not pass for an open contact.
    """
    tether = element.tether
    contacts = pull - tether * off
    unbalanced = dot(contacts, contacts) >= (0.03 * load) ** 2
    # About 1e-8 N. With ten times this, rollers jump that matter to loads of 1e-3 N;
    # with a tenth, some loose rollers do not come to rest (benchmarks/robust_*.py).
    return unbalanced & (load <= 100.0 * tether * _size(element, off, magnitude))


def _size(element, x, magnitude):
    return magnitude + element.hints.gap + norm(x)


def _load(element, contacts):
    load = jnp.sum(contacts.aux)
    inertia = element.hints.inertia_scale()
    return load if inertia is None else load + inertia


class CondensedAux(NamedTuple):
    """Results of a condensed rolling element in addition to its energy.

    Attributes:
        contact_load: Load of each contact (contact,) [N].
        follow: Derivatives of its unknowns by the ring motions (n, r).
    """

    contact_load: Annotated[Float[Array, " contact"], unit("N")]
    follow: Float[Array, "n r"]


def condense(rings: Rings, solved: SolvedElement, order: int = 2) -> Expansion:
    """min_x U(rings, x) of a solved rolling element, its forces and stiffness.

    All zero if it is loose. Without this an element that the tether leans on two rings
    would pass the stiffness of that contact, which falls only with the tenth root of
    its load (of a ball, the third).

    Args:
        rings: Motions of the rings where it was solved (r,) [m, rad].
        solved: The element and its equilibrium.
        order: 1 if forces are wanted, without stiffness and `CondensedAux`. Static.

    Returns:
        Energy [J], forces on the rings (r,) [N, N m], stiffness (r, r), and
        `CondensedAux`. The stiffness is K_rr - K_rx K_xx⁻¹ K_xr; symmetric to
        round-off if there is a potential.

    Source: static condensation 9 to 6, Sorokin, Zhang, Ivannikov (2018).
    """
    element, contacts = solved.element, solved.state.contact_response
    n, r = element.n_unknowns, rings.shape[0]
    x = own_unknowns(solved, rings)
    d = derivatives(element, rings, x, contacts, with_hessian=order > 1)
    found = Expansion(d.energy, d.gradient[:r], ())
    if order > 1:
        stiffness, follow = _condensed_stiffness(element, d.hessian, r)
        found = found._replace(
            hessian=stiffness, aux=CondensedAux(contacts.aux, follow)
        )
    if n == 0:
        return found
    off = x - element.hints.midpoint(ring_motions(element, rings))
    size = _load(element, contacts)
    given = element, off, solved.magnitude, size, d.gradient[r:]
    loose = is_loose(*stop_gradient(given))
    return jax.tree.map(lambda v: jnp.where(loose, 0.0, v), found)


def _condensed_stiffness(element, hessian, r):
    """K_rr - K_rx K_xx⁻¹ K_xr, and -K_xx⁻¹ K_xr."""
    if element.n_unknowns == 0:
        return hessian, hessian[r:]
    coupling, back = hessian[r:, :r], hessian[:r, r:]
    symmetric = element.has_potential
    moved = solve(hessian[r:, r:], coupling, symmetric)
    left = coupling if symmetric else back.T
    k = hessian[:r, :r] - jnp.sum(left[:, :, None] * moved[:, None, :], axis=0)
    return (0.5 * (k + k.T) if symmetric else k), -moved


class _Inputs(NamedTuple):
    """Inputs of a solve, and quantities that are constant over its steps."""

    element: AbstractRollingElement
    rings: Rings
    magnitude: Scalar
    centre: Unknowns
    start: Unknowns
    radius: Scalar
    is_open: Bool[Array, ""] | None


def _prepare(element, rings, magnitude, near, absent) -> _Inputs:
    hints, motions = element.hints, ring_motions(element, rings)
    start, centre = hints.start(motions), hints.midpoint(motions)
    if near is not None:
        start = _follow_rings(element, near, rings, start)
    rest = hints.at_rest(motions)
    if rest is not None:
        place, apart = rest
        start = jnp.where(apart, place, start)
    is_open = hints.is_open(motions)
    if absent is not None:
        is_open = absent if is_open is None else absent | is_open
    if is_open is not None:
        start = jnp.where(is_open, centre, start)
    radius = hints.reach(motions) + hints.gap + 1e-6 * element.diameter
    return _Inputs(element, rings, magnitude, centre, start, radius, is_open)


def _problem(given: _Inputs, shapes) -> Problem:
    element, rings, magnitude = given.element, given.rings, given.magnitude
    eps, hints = jnp.finfo(rings.dtype).eps, element.hints

    def function(x, with_hessian, *_):
        contacts = response(element, rings, x)
        d = derivatives(element, rings, x, contacts, of_own=True)
        scale = _load(element, contacts)
        # Round-off of positions, and forces small against that of the tether.
        noise = eps * hints.spread * trace(d.hessian) + 1e-6 * element.tether
        noise = _size(element, x, magnitude) * noise
        # A loose element need not be placed: its solve is over.
        loose = is_loose(element, x - given.centre, magnitude, scale, d.gradient)
        noise = jnp.where(loose, norm(d.gradient), noise)
        scale = jnp.where(loose, jnp.inf, scale)
        value = d.energy if element.has_potential else jnp.full_like(d.energy, jnp.nan)
        hessian = d.hessian if with_hessian else d.hessian[:0]
        kept = contacts if hints.keeps_response else ()
        return Evaluation(value, d.gradient, hessian, scale, noise, kept)

    def correct_step(x, step, size):
        return hints.correct_step(ring_motions(element, rings), x, step, size)

    memory = _zeros(shapes)
    correction = correct_step if hints.corrects_steps else None
    return Problem(function, given.start, given.radius, correction, memory)


def _loop(minimiser: AbstractMinimiser, contacts, may_be_open) -> batched_loop.Loop:
    """Iteration for one element, skipped for an open one.

    Args:
        minimiser: Local solver.
        contacts: Contact response, of which only the shapes count.
        may_be_open: Whether `is_open` of the element is known.
    """

    def problem_of(given):
        return _problem(given, contacts if given.element.hints.keeps_response else ())

    def finish(given, state):
        element, rings = given.element, given.rings
        state = _solve(element, rings, loop.finish(given, state))
        return state, condense(rings, SolvedElement(element, state, given.magnitude))

    def trivial_result(given):
        return unloaded_result(given.rings, given.centre, contacts)

    is_trivial = (lambda given: given.is_open) if may_be_open else None
    loop = minimiser.loop(problem_of)
    return loop._replace(
        finish=finish, trivial_result=trivial_result, is_trivial=is_trivial
    )


def unloaded_result(
    rings: Rings, x: Unknowns, contacts: Any
) -> tuple[LocalState, Expansion]:
    """Return the result of `solve_element` for an element that carries no load.

    Args:
        rings: Motions of the rings in its axes (r,) [m, rad].
        x: Its unknowns (n,) [m].
        contacts: Contact response, of which only the shapes count.
    """
    n, r = x.shape[0], rings.shape[0]
    zero, none = jnp.zeros((), rings.dtype), jnp.zeros((), jnp.int32)
    nothing = _zeros(contacts)
    state = LocalState(x, zero, zero, none, none, nothing)
    aux = CondensedAux(nothing.aux, jnp.zeros((n, r), rings.dtype))
    return state, Expansion(
        zero, jnp.zeros_like(rings), jnp.zeros((r, r), rings.dtype), aux
    )


def _zeros(shapes):
    return jax.tree.map(lambda a: jnp.zeros(a.shape, a.dtype), shapes)


def _solve(element, rings, minimum) -> LocalState:
    result = minimum.result
    contacts = minimum.memory or response(element, rings, minimum.x)
    # Where part of the forces has no potential a pivot says nothing.
    if element.has_potential and not element.is_convex:
        h = derivatives(element, rings, minimum.x, contacts, of_own=True).hessian
        saddle = (smallest_pivot(h) < -1e-9) & (result == Result.CONVERGED)
        result = jnp.where(saddle, int(Result.SADDLE), result)
    if element.hints.may_be_ejected:
        # Inertia along a direction that only the tether holds.
        motions = ring_motions(element, rings)
        lost = element.hints.is_ejected(motions, minimum.x)
        lost = lost & (result != int(Result.NON_FINITE))
        result = jnp.where(lost, int(Result.NO_LOAD_PATH), result)
    return LocalState(
        minimum.x,
        minimum.residual,
        minimum.unbalanced,
        minimum.steps,
        result.astype(jnp.int32),
        contacts,
    )


def _follow_rings(element, near, rings, otherwise):
    """Predict the position of an element that follows the rings from near by."""
    moved = rings - near.rings
    hints, before = element.hints, ring_motions(element, near.rings)
    step = near.follow @ moved
    reach, length = hints.reach(ring_motions(element, moved)), norm(step)
    # Barely held, it would go astray.
    step = step * jnp.minimum(1.0, reach / jnp.where(length > 0, length, 1.0))
    x = near.offset + hints.midpoint(before) + step
    return jnp.where(jnp.all(jnp.isfinite(x)), x, otherwise)


def element_start(
    solved: SolvedElement, rings: Rings, aux: CondensedAux
) -> ElementStart:
    """Starting point for a solve with the rings at a nearby position.

    Args:
        solved: The element and its equilibrium.
        rings: Motions of the rings there (r,) [m, rad].
        aux: `CondensedAux` of its `condense` energy.
    """
    element = solved.element
    held = jnp.any(aux.contact_load > 0)
    off = solved.state.x - element.hints.midpoint(ring_motions(element, rings))
    follow = jnp.where(held, aux.follow, 0.0)
    return stop_gradient(ElementStart(jnp.where(held, off, jnp.nan), follow, rings))


def accept_small(
    state: LocalState, load: Scalar, passed: Float[Array, "*element"] | None = None
) -> LocalState:
    """Count rolling elements as converged if their imbalance affects no result.

    A ball or roller in the unloaded half, with no more than a slow orbit's centrifugal
    force to seat it, may need more steps than there are; it does not matter.

    Args:
        state: Solved elements, leading axis element.
        load: Largest contact load of the bearing [N].
        passed: Load that each element passes from ring to ring, if that is known [N].
    """
    late = state.result == int(Result.STEP_LIMIT)
    idle = state.unbalanced <= 1e-12 * load
    if passed is not None:
        idle = idle | (jnp.maximum(state.unbalanced, passed) <= _IDLE * load)
    idle = late & idle
    return state._replace(
        result=jnp.where(idle, int(Result.CONVERGED), state.result),
        residual=jnp.where(idle, 0.0, state.residual),
    )

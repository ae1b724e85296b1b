"""Derivatives through a solved system, without differentiating the iterations.

The implicit function theorem, written as a recursive derivative rule: right at every
order, forward and reverse, under `jit` and `vmap`, with no host callback.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.custom_derivatives import SymbolicZero
from jax.flatten_util import ravel_pytree
from jaxtyping import Array

from .linear import solve
from .types import T


def attach(
    residual: Callable, solution: Array, args: Any, symmetric: bool = True
) -> Array:
    """Attach to a solution of residual(y, args) = 0 its dependence on `args`.

    The value returned is `solution`; its derivative is
    dy = -(∂residual/∂y)⁻¹ ∂residual/∂args · dargs. The rule calls itself for the
    point of evaluation, so second and higher derivatives are exact as well.

    Args:
        residual: Function (y, args) -> array like `y`, with a positive
            (semi)definite Jacobian in y.
        solution: Solved y (n,); its own derivative is ignored.
        args: Any pytree; leaves that are not arrays are static.
        symmetric: Whether the Jacobian is symmetric: `residual` is the gradient of
            an energy. Static.

    Returns:
        `solution`, differentiable with respect to `args`.

    Source: implicit function theorem; a rule that makes one differentiable Newton
        step instead would be wrong in the second derivative.
    """

    def correction(of_y, y, change, _):
        return -solve(jax.jacfwd(of_y)(y), change, symmetric)

    return attach_by(residual, solution, args, correction)


def attach_roots(residual: Callable, solution: Array, args: Any) -> Array:
    """`attach` for independent scalar roots, element by element, any sign of slope.

    Args:
        residual: Function (y, args) -> array like `y`, element k of the result
            depending on element k of y only.
        solution: Roots, any shape; their own derivative is ignored.
        args: As in `attach`.

    Returns:
        `solution`, differentiable; where the slope is zero (the root has just
        vanished) the derivative is zero.
    """

    def correction(of_y, y, change, _):
        _, slope = jax.jvp(of_y, (y,), (jnp.ones_like(y),))
        flat = slope == 0
        return jnp.where(flat, 0.0, -change / jnp.where(flat, 1.0, slope))

    return attach_by(residual, solution, args, correction)


def attach_by(
    residual: Callable, solution: Any, args: Any, correction: Callable
) -> Any:
    """`attach` with a linear solver of one's own, for any pytree of unknowns.

    Args:
        residual: Function (y, args) -> pytree like `y`.
        solution: Solved y; its own derivative is ignored.
        args: As in `attach`.
        correction: (residual as a function of y alone, y, change, args) -> change of y
            that undoes the change of the residual, -(∂residual/∂y)⁻¹·change; linear in
            `change`, and transposable for reverse mode.

    Returns:
        `solution`, differentiable with respect to `args`.
    """
    traced, others, joined = _partition(args)

    def balance(y, traced, others):
        return residual(y, joined(traced, others))

    @jax.custom_jvp
    def keep_solution(y, traced, others):
        return y

    @keep_solution.defjvp
    def _rule(primals, tangents):
        y0, traced, others = primals
        y = keep_solution(y0, traced, others)
        _, change = jax.jvp(lambda t: balance(y, t, others), (traced,), (tangents[1],))
        now = joined(traced, others)
        return y, correction(lambda v: balance(v, traced, others), y, change, now)

    return keep_solution(stop_gradient(solution), traced, others)


def _partition(args):
    """Floating arrays of a pytree, its other arrays, and how to join them again.

    A derivative rule must be given all that is traced, flags and counts too.
    """
    arrays, static = eqx.partition(args, eqx.is_array)
    traced, others = eqx.partition(arrays, eqx.is_inexact_array)
    return traced, others, lambda *parts: eqx.combine(*parts, static)


def unless_failed(function: Callable, args: tuple, solved: Any) -> Any:
    """function(*args), with derivatives that are NaN if the solve failed.

    A failed solve ends anywhere, and a derivative there is not valid. For inputs that
    do not change it is still zero: a failed case of a batch that a mask leaves out does
    not affect the gradient of the others, whatever its values.

    Args:
        function: Function of args -> pytree; it is differentiated with respect to its
            arguments only, and must not close over traced values.
        args: Tuple of pytrees; leaves that are not arrays are static.
        solved: Whether the solve succeeded, a scalar flag.

    Returns:
        Result of `function`, differentiable with respect to `args`.
    """
    traced, others, joined = _partition(args)
    # No change gets through if not solved, in neither direction.
    gated = jax.tree.map(lambda x: jnp.where(solved, x, lax.stop_gradient(x)), traced)
    found, rest, whole = _partition(function(*joined(gated, others)))
    # One by one: components without a tangent are not differentiated.
    marked = jax.tree.map(lambda effect: _mark_unsolved(effect, traced, solved), found)
    return whole(marked, rest)


@jax.custom_jvp
def _mark_unsolved(effect, cause, solved):
    """The effect; if not solved, its changes are NaN where its cause changes."""
    return effect


def _marked_rule(primals, tangents):
    values, tree = jax.tree.flatten(primals[0])
    causes = [c for c in jax.tree.leaves(tangents[1]) if not _is_none(c)]
    changes = jax.tree.leaves(tangents[0])
    effects = [e for e in changes if not _is_none(e)]
    if causes and effects:
        effects = _spoil_unsolved(causes, effects, primals[2])
    known = iter(effects)
    # No symbolic zeros: under `vmap` they would miss the axis of the batch.
    changes = [
        jnp.zeros_like(v) if _is_none(c) else next(known)
        for v, c in zip(values, changes, strict=True)
    ]
    return _mark_unsolved(*primals), jax.tree.unflatten(tree, changes)


def _is_none(change):
    return isinstance(change, SymbolicZero)


_mark_unsolved.defjvp(_marked_rule, symbolic_zeros=True)


def _spoil_unsolved(causes, effects, solved):
    """The effects; if not solved, NaN if any cause is not zero, else zero.

    To JAX it is a linear solve, which says itself what its transpose is: the same with
    causes and effects exchanged.
    """
    cause, _ = ravel_pytree(_parts(causes))
    effect, apart = ravel_pytree(_parts(effects))
    n = cause.shape[0]

    def nan_if_changed(changes):
        return jnp.where(~solved & jnp.any(changes != 0), jnp.nan, 0.0)

    def spoil(_, both):
        effect = jnp.where(solved, both[n:], nan_if_changed(both[:n]))
        return jnp.concatenate([jnp.zeros_like(both[:n]), effect])

    def transpose(_, both):
        cause = jnp.full_like(both[:n], nan_if_changed(both[n:]))
        return jnp.concatenate([cause, jnp.where(solved, both[n:], 0.0)])

    both = jnp.concatenate([cause, effect])
    found = apart(lax.custom_linear_solve(lambda x: x, both, spoil, transpose)[n:])
    return [lax.complex(*x) if isinstance(x, tuple) else x for x in found]


def _parts(arrays):
    """Real and imaginary parts of complex arrays; real arrays as they are."""
    return [(x.real, x.imag) if jnp.iscomplexobj(x) else x for x in arrays]


def recall(function: Callable, values: Any, args: tuple) -> Any:
    """function(*args) where its values are known already.

    The values returned are `values`; derivatives, to any order, are those of
    `function`, which is evaluated for them alone.

    Args:
        function: Function of args -> pytree of floating arrays.
        values: Its result; their own derivative is ignored.
        args: Tuple of pytrees; leaves that are not arrays are static.

    Returns:
        `values`, differentiable with respect to `args`.
    """
    traced, others, joined = _partition(args)

    @jax.custom_jvp
    def keep_values(values, traced, others):
        return values

    @keep_values.defjvp
    def _rule(primals, tangents):
        values, traced, others = primals
        _, change = jax.jvp(
            lambda t: function(*joined(t, others)), (traced,), (tangents[1],)
        )
        return keep_values(*primals), change

    return keep_values(stop_gradient(values), traced, others)


@eqx.filter_custom_jvp
def through_jacobian(given: Any, *inputs: Array, function: Callable) -> Array:
    """function(given, *inputs), differentiated by its few inputs once.

    Where many tangents reach it through few numbers, such as all freedoms of a shaft
    through the motion of one station, they are multiplied by its Jacobian and do not
    go through the function one by one.

    Args:
        given: Pytree; its tangents take the usual way.
        *inputs: Arrays.
        function: Function of them whose result is an array. Static.

    Returns:
        The result of `function`, with its derivatives to any order.
    """
    return function(given, *inputs)


@through_jacobian.def_jvp
def _rule_through_jacobian(primals, tangents, *, function):
    given, *inputs = primals
    moved = {k: t for k, t in enumerate(tangents[1:]) if t is not None}

    def evaluate(*some):
        now = dict(enumerate(inputs)) | dict(zip(moved, some, strict=True))
        value = function(given, *now.values())
        return value, value

    some = [inputs[k] for k in moved]
    if moved:
        every = tuple(range(len(some)))
        slopes, value = jax.jacfwd(evaluate, every, has_aux=True)(*some)
    else:
        slopes, value = (), function(given, *inputs)
    change = jnp.zeros_like(value)
    for slope, move in zip(slopes, moved.values(), strict=True):
        change = change + jnp.tensordot(slope, move, jnp.ndim(move))
    if jax.tree.leaves(tangents[0]):
        _, more = eqx.filter_jvp(
            lambda given: function(given, *inputs), (given,), (tangents[0],)
        )
        change = change + more
    return value, change


def with_zeros(given: Any, change: Any, *axes: int) -> Any:
    """Return a change with zeros in place of `None`: a program that takes it is the
    same whatever changes.

    Args:
        given: What changes.
        change: Its change, from `equinox.filter_jvp`, or several.
        *axes: Leading axes of several changes.
    """

    def fill(leaf, moved):
        still = moved is None and eqx.is_inexact_array(leaf)
        return np.zeros(axes + leaf.shape, leaf.dtype) if still else moved

    return jax.tree.map(fill, given, change)


def stop_gradient(tree: T) -> T:
    """`lax.stop_gradient` on every floating array of a pytree."""
    return jax.tree.map(
        lambda x: lax.stop_gradient(x) if eqx.is_inexact_array(x) else x, tree
    )

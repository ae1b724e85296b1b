"""Derivatives through a solved system, without differentiating the iterations.

The implicit function theorem, written as a recursive derivative rule: right at every
order, forward and reverse, under `jit` and `vmap`, with no host callback.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax

from .linear import solve


def attach(residual, solution, args, symmetric: bool = True):
    """Attach to a solution of residual(y, args) = 0 its dependence on `args`.

    The value returned is `solution`; its derivative is
    dy = -(∂residual/∂y)⁻¹ ∂residual/∂args · dargs. The rule calls itself for the
    point of evaluation, so second and higher derivatives are exact as well.

    Args:
        residual: Function (y, args) -> array like `y`, with a positive
            (semi)definite Jacobian in y.
        solution: Solved y (n,); its own derivative is ignored.
        args: Any pytree; what is no array is static.
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


def attach_roots(residual, solution, args):
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


def attach_by(residual, solution, args, correction):
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
    traced, others, joined = _parted(args)

    def bound(y, traced, others):
        return residual(y, joined(traced, others))

    @jax.custom_jvp
    def attached(y, traced, others):
        return y

    @attached.defjvp
    def _rule(primals, tangents):
        y0, traced, others = primals
        y = attached(y0, traced, others)
        _, change = jax.jvp(lambda t: bound(y, t, others), (traced,), (tangents[1],))
        now = joined(traced, others)
        return y, correction(lambda v: bound(v, traced, others), y, change, now)

    return attached(stop(solution), traced, others)


def _parted(args):
    """Floating arrays of a pytree, its other arrays, and how to join them again.

    A derivative rule must be given all that is traced, flags and counts too.
    """
    arrays, static = eqx.partition(args, eqx.is_array)
    traced, others = eqx.partition(arrays, eqx.is_inexact_array)
    return traced, others, lambda *parts: eqx.combine(*parts, static)


def unless_failed(value, solved):
    """`value`, with derivatives that are NaN if it was not solved for.

    A failed solve ends anywhere, and a derivative there is no answer.

    Args:
        value: Floating array.
        solved: Whether it was solved for, a scalar flag.
    """

    @jax.custom_jvp
    def known(value, factor):
        return value

    @known.defjvp
    def _rule(primals, tangents):
        return known(*primals), tangents[0] * primals[1]

    return known(value, jnp.where(solved, 1.0, jnp.nan).astype(value.dtype))


def recall(function, values, args):
    """function(*args) where its values are known already.

    The values returned are `values`; derivatives, to any order, are those of
    `function`, which is evaluated for them alone.

    Args:
        function: Function of args -> pytree of floating arrays.
        values: What it returns; their own derivative is ignored.
        args: Tuple of pytrees; what is no array is static.

    Returns:
        `values`, differentiable with respect to `args`.
    """
    traced, others, joined = _parted(args)

    @jax.custom_jvp
    def recalled(values, traced, others):
        return values

    @recalled.defjvp
    def _rule(primals, tangents):
        values, traced, others = primals
        _, change = jax.jvp(
            lambda t: function(*joined(t, others)), (traced,), (tangents[1],)
        )
        return recalled(*primals), change

    return recalled(stop(values), traced, others)


def stop(tree):
    """`lax.stop_gradient` on every floating array of a pytree."""
    return jax.tree.map(
        lambda x: lax.stop_gradient(x) if eqx.is_inexact_array(x) else x, tree
    )

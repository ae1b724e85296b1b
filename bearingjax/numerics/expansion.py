"""Differentiable function from a value, gradient and Hessian computed in one pass.

An integral, or a solved equilibrium, gives all three at once. Left to automatic
differentiation each would be computed again, at high cost. Here the values are used in
a chain of derivative rules: the derivative of the value is the gradient, that of the
gradient the Hessian. Outer functions, usually geometry, are differentiated as usual:
`jax.grad` and `jax.hessian` then cost almost nothing.

Arrays are (..., k) for k arguments of one function each: many functions side by side,
none of which depends on the arguments of another.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero

from .implicit import stop_gradient


class Expansion(NamedTuple):
    """Value and derivatives of functions of u; pytrees of the structure of u.

    Attributes:
        value: (...) [any unit].
        gradient: (..., k).
        hessian: (..., k, k): derivatives of the gradient. It need not be symmetric:
            of forces that have no potential the rule is the same.
        aux: Further results of the pass; they have no derivatives here.
    """

    value: Any
    gradient: Any
    hessian: Any
    aux: Any = ()


Function = Callable[[Any, Any, int], Expansion]
"""(u, args, order) -> `Expansion`, of which only terms up to `order` are used: 0
value, 1 gradient, 2 Hessian. Higher terms may be left out."""


def expand(
    function: Function, u: Any, args: Any, known: Expansion | None = None
) -> Any:
    """The value of a function, with the derivatives that the same pass has found.

    Args:
        function: See `Function`; a plain function of a module, itself differentiable:
            derivatives with respect to `args`, and of the Hessian, are taken of it.
        u: Pytree of floating arrays (..., k).
        args: Any pytree; leaves that are not floating arrays are static.
        known: Result of `function` here, if available; it must be exact.

    Returns:
        The value; differentiable to any order with respect to u and args.
    """
    (value, _, _), given = _orders(function, u, args, known)
    return value(*given)


def expanded_all(
    function: Function, u: Any, args: Any, known: Expansion | None = None
) -> Expansion:
    """Value, gradient and Hessian as in `expand`, each with its derivatives."""
    orders, given = _orders(function, u, args, known)
    value, gradient, hessian = (order(*given) for order in orders)
    return Expansion(value, gradient, hessian, given[-1].aux)


def _orders(function, u, args, known):
    leaves, structure = jax.tree.flatten(args)
    traced = [x if eqx.is_inexact_array(x) else None for x in leaves]
    others = [None if eqx.is_inexact_array(x) else x for x in leaves]

    def expand(u, traced, others, order=2):
        return _call_jitted((function, structure, order), u, traced, others)

    if known is None:
        known = expand(stop_gradient(u), stop_gradient(traced), others)

    @jax.custom_jvp
    def hessian(u, traced, others, known):
        return known.hessian

    @jax.custom_jvp
    def gradient(u, traced, others, known):
        return known.gradient

    @jax.custom_jvp
    def value(u, traced, others, known):
        return known.value

    def of_hessian(primals, tangents):
        u, traced, others, _ = primals
        change = jax.tree.map(_instantiate, (u, traced), tangents[:2])
        _, third = jax.jvp(
            lambda u, t: expand(u, t, others).hessian, (u, traced), change
        )
        return hessian(*primals), third

    def of_gradient(primals, tangents):
        moved = jax.tree.map(_times, hessian(*primals), tangents[0])
        change = _and_of_args(expand, 1, primals, tangents, moved)
        return gradient(*primals), change

    def of_value(primals, tangents):
        moved = jax.tree.map(_inner, gradient(*primals), tangents[0])
        return value(*primals), _and_of_args(expand, 0, primals, tangents, moved)

    hessian.defjvp(of_hessian, symbolic_zeros=True)
    gradient.defjvp(of_gradient, symbolic_zeros=True)
    value.defjvp(of_value, symbolic_zeros=True)
    return (value, gradient, hessian), (u, traced, others, stop_gradient(known))


@partial(jax.jit, static_argnums=0)
def _call_jitted(static, u, traced, others) -> Expansion:
    """The function itself. Under `jit` its trace, and that of its derivative, is kept
    and used again."""
    function, structure, order = static
    leaves = [o if t is None else t for t, o in zip(traced, others, strict=True)]
    return function(u, jax.tree.unflatten(structure, leaves), order)


def _and_of_args(bound, order, primals, tangents, change):
    """`change`, plus that of function(u, args)[order] by the arguments other than u."""
    u, traced, others, _ = primals
    if all(_is_zero(leaf) for leaf in jax.tree.leaves(tangents[1])):
        return change
    dtraced = jax.tree.map(_instantiate, traced, tangents[1])
    _, more = jax.jvp(
        lambda t: bound(u, t, others, order)[order], (traced,), (dtraced,)
    )
    return jax.tree.map(jnp.add, change, more)


def _times(matrix, change):
    """Σ_j matrix[..., i, j] change[..., j]; written out, so that it fuses."""
    if _is_zero(change):
        return jnp.zeros(matrix.shape[:-1], matrix.dtype)
    k = matrix.shape[-1]
    if k > 3:
        return jnp.sum(matrix * change[..., None, :], axis=-1)
    terms = [matrix[..., j] * change[..., j : j + 1] for j in range(k)]
    return sum(terms[1:], start=terms[0])


def _inner(gradient, change):
    """Σ_j gradient[..., j] change[..., j]."""
    if _is_zero(change):
        return jnp.zeros(gradient.shape[:-1], gradient.dtype)
    k = gradient.shape[-1]
    if k > 3:
        return jnp.sum(gradient * change, axis=-1)
    terms = [gradient[..., j] * change[..., j] for j in range(k)]
    return sum(terms[1:], start=terms[0])


def _instantiate(x, change):
    return jnp.zeros_like(x) if _is_zero(change) else change


def _is_zero(x):
    return isinstance(x, SymbolicZero)


def compose(outer: Expansion, inner: Expansion) -> Expansion:
    """Expansion of functions of functions, by the chain rule.

    Args:
        outer: Functions of (..., k).
        inner: The k arguments as functions of (..., m), with one more axis in all
            arrays.
    """

    # Sums over an axis: what they are of, XLA does not work out anew for each use.
    def first_order(slope, rate):
        return jnp.sum(slope[..., None] * rate, axis=-2)

    def second_order(slope, bend, rate, curved):
        turned = jnp.sum(bend[..., None] * rate[..., None, :, :], axis=-2)
        terms = slope[..., None, None] * curved
        terms = terms + rate[..., :, None] * turned[..., None, :]
        return jnp.sum(terms, axis=-3)

    rates = inner.gradient
    return Expansion(
        outer.value,
        jax.tree.map(first_order, outer.gradient, rates),
        jax.tree.map(second_order, outer.gradient, outer.hessian, rates, inner.hessian),
        outer.aux,
    )


def by_autodiff(function: Callable[..., Any], u: Any, *constants: Any) -> Expansion:
    """Expansion of functions side by side, by automatic differentiation.

    For functions without integrals or powers that make their derivatives long.

    Args:
        function: Smooth function of (k,) and of the arguments `constants` -> scalar.
        u: Arguments of each (..., k).
        *constants: Pytrees of more arguments, such as constants of each contact, with
            the leading axes of u; no derivatives by them are returned.

    Returns:
        Value (...), gradient (..., k) and Hessian (..., k, k).
    """

    def expand_one(u, *constants):
        def slopes(u):
            value, gradient = jax.value_and_grad(function)(u, *constants)
            return gradient, (value, gradient)

        hessian, (value, gradient) = jax.jacfwd(slopes, has_aux=True)(u)
        return Expansion(value, gradient, hessian)

    axes = u.shape[:-1]

    def flatten_axes(a):
        return a.reshape(-1, *a.shape[len(axes) :])

    flat = jax.vmap(expand_one)(flatten_axes(u), *jax.tree.map(flatten_axes, constants))
    return jax.tree.map(lambda a: a.reshape(*axes, *a.shape[1:]), flat)

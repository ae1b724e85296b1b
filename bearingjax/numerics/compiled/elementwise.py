"""Scalar functions of many numbers at a time, in long rows that a processor likes.

Under nested `vmap` a compiler sees arrays such as (lane, raceway, edge), whose last
axes are too short for vector instructions. Here all axes become one.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_batching import custom_vmap
from jaxtyping import Array


def elementwise(function: Callable, rows: tuple[Array, ...], args: Any) -> Any:
    """Apply a function of scalars to arrays, element by element. Without derivatives.

    Args:
        function: (one element of each row, args) -> pytree of scalars; it sees no
            traced number but its arguments. Its trace is kept for as long as it lives:
            give a function of a module.
        rows: Arrays that broadcast against each other.
        args: Arguments common to all elements, any pytree; non-arrays are static, and
            hashable.

    Returns:
        Pytree of arrays of the common shape.
    """
    arrays, others = eqx.partition(args, eqx.is_array)
    leaves, tree = jax.tree.flatten(arrays)
    constants, around = jax.tree.flatten(others)
    static = function, tree, around, tuple(constants)
    shape = jnp.broadcast_shapes(*(row.shape for row in rows))
    one = partial(_of_scalars, static)

    @custom_vmap
    def apply(rows, leaves):
        shape = rows[0].shape

        def flatten_axes(x):
            return x.reshape(-1, *x.shape[len(shape) :])

        # Written out: broadcast within a loop, they would keep it from vectorising.
        given = lax.optimization_barrier(jax.tree.map(flatten_axes, (rows, leaves)))
        return jax.tree.map(lambda y: y.reshape(shape), jax.vmap(one)(*given))

    @apply.def_vmap
    def _rule(size, batched, *given):
        whole = jax.tree.map(
            lambda flag, x: x if flag else jnp.broadcast_to(x, (size, *x.shape)),
            tuple(batched),
            given,
        )
        out = apply(*whole)
        return out, jax.tree.map(lambda _: True, out)

    return apply(
        [jnp.broadcast_to(row, shape) for row in rows],
        [jnp.broadcast_to(leaf, (*shape, *leaf.shape)) for leaf in leaves],
    )


@partial(jax.jit, static_argnums=0)
def _of_scalars(static, rows, leaves):
    """The function of one element of each row, traced once."""
    function, tree, around, constants = static
    parts = jax.tree.unflatten(tree, leaves), jax.tree.unflatten(around, constants)
    return function(*rows, eqx.combine(*parts))

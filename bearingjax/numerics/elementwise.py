"""Scalar functions of many numbers at a time, in long rows that a processor likes.

Under nested `vmap` a compiler sees arrays such as (lane, raceway, edge), whose last
axes are too short for vector instructions. Here all axes become one.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_batching import custom_vmap


def elementwise(function: Callable, *args: Any) -> Any:
    """Apply a function of scalars to arrays, element by element.

    Args:
        function: Of pytrees of scalars -> pytree of scalars; it sees no traced number
            but its arguments. Without derivatives.
        *args: Pytrees of arrays that broadcast against each other; what is no array is
            static.

    Returns:
        Pytree of arrays of the common shape.
    """
    arrays, static = eqx.partition(args, eqx.is_array)
    leaves, tree = jax.tree.flatten(arrays)
    shape = jnp.broadcast_shapes(*(leaf.shape for leaf in leaves))

    def one(leaves):
        return function(*eqx.combine(jax.tree.unflatten(tree, leaves), static))

    @custom_vmap
    def apply(leaves):
        shape = leaves[0].shape
        # Written out: broadcast within a loop, they would keep it from vectorising.
        rows = lax.optimization_barrier([leaf.reshape(-1) for leaf in leaves])
        return jax.tree.map(lambda y: y.reshape(shape), jax.vmap(one)(rows))

    @apply.def_vmap
    def _rule(size, batched, leaves):
        whole = [
            leaf if flag else jnp.broadcast_to(leaf, (size, *leaf.shape))
            for leaf, flag in zip(leaves, batched[0], strict=True)
        ]
        out = apply(whole)
        return out, jax.tree.map(lambda _: True, out)

    return apply([jnp.broadcast_to(leaf, shape) for leaf in leaves])

"""Evaluation of all supports of a rotor, or other parts: like ones share one program.

The program of a bearing is by far the largest part of a rotor's; two bearings of one
structure, whatever their numbers, are traced and compiled once.
"""

from collections.abc import Callable, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp

from .parts import AbstractSupport


def map_parts(function: Callable, parts: Sequence[Any], *arrays: Any) -> Any:
    """Map function(part, *its arrays) over all parts, such as supports.

    Args:
        function: It must not read station or housing of a support.
        parts: One or more pytrees.
        *arrays: With `part` as first axis.

    Returns:
        What it returns, with `part` as first axis.
    """
    kinds: list[tuple[list[int], list[Any]]] = []
    for k, part in enumerate(parts):
        one = part.without_place() if isinstance(part, AbstractSupport) else part
        same = (kind for kind in kinds if _are_alike(kind[1][0], one))
        members, alike = next(same, ([], []))
        if not members:
            kinds.append((members, alike))
        members.append(k)
        alike.append(one)
    found = {}
    for members, alike in kinds:
        given = [array[jnp.asarray(members)] for array in arrays]
        found |= zip(members, _of_kind(function, alike, given), strict=True)
    return jax.tree.map(lambda *one: jnp.stack(one), *(found[k] for k in sorted(found)))


def _of_kind(function, alike, given):
    if len(alike) == 1:
        return [function(alike[0], *(array[0] for array in given))]
    parts = [eqx.partition(part, eqx.is_array) for part in alike]
    rest = parts[0][1]
    stacked = jax.tree.map(lambda *leaf: jnp.stack(leaf), *(part[0] for part in parts))

    def call(numbers, *arrays):
        return function(eqx.combine(numbers, rest), *arrays)

    every = jax.vmap(call)(stacked, *given)
    leaves, tree = jax.tree.flatten(every)
    return [tree.unflatten([leaf[k] for leaf in leaves]) for k in range(len(alike))]


def _are_alike(one, other):
    """Return whether two parts differ in numbers only."""
    if jax.tree.structure(one) != jax.tree.structure(other):
        return False
    (a, rest), (b, others) = (eqx.partition(s, eqx.is_array) for s in (one, other))
    pairs = zip(jax.tree.leaves(a), jax.tree.leaves(b), strict=True)
    return jax.tree.leaves(rest) == jax.tree.leaves(others) and all(
        x.shape == y.shape and x.dtype == y.dtype for x, y in pairs
    )

"""Iterations of many problems, few of which wait for the slowest.

Under `vmap` a `while_loop` goes on with every lane until the last is done. Here all
lanes go on only while most of them need it; the rest is gathered, some at a time.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_batching import custom_vmap

PART = 8
"""One lane in so many goes on at a time when no more than half are left."""

LEAST = 16
"""Fewest lanes that go on at a time: a pass of fewer costs its overhead."""


class Loop(NamedTuple):
    """An iteration: `while unfinished(state): state = step(state)`.

    Attributes:
        begin: First state, any pytree of arrays.
        unfinished: state -> whether to go on.
        step: state -> next state.
        finish: last state -> what is wanted of it.
    """

    begin: Any
    unfinished: Callable[[Any], Any]
    step: Callable[[Any], Any]
    finish: Callable[[Any], Any]

    def run(self) -> Any:
        """What comes out of the iteration."""
        return self.finish(lax.while_loop(self.unfinished, self.step, self.begin))


def run(loop_of: Callable[..., Loop], *args) -> Any:
    """`loop_of(*args).run()`, which under `vmap` lets few lanes wait for others.

    Args:
        loop_of: Function of `args`, and of no other traced number.
        *args: Pytrees; what is no array is static.

    Returns:
        As `Loop.finish`. Derivatives are not for here: see `implicit`.
    """
    arrays, static = eqx.partition(args, eqx.is_array)
    leaves, tree = jax.tree.flatten(arrays)

    def build(leaves):
        return loop_of(*eqx.combine(jax.tree.unflatten(tree, leaves), static))

    @custom_vmap
    def one(leaves):
        return build(leaves).run()

    @one.def_vmap
    def _rule(size, batched, leaves):
        out = _many(build, tuple(batched[0]))(leaves)
        return out, jax.tree.map(lambda _: True, out)

    return one(leaves)


def _many(build, flags):
    """The loops of lanes, flagged leaves with a leading axis."""

    @custom_vmap
    def many(leaves):
        return _in_lanes(build, flags, leaves)

    @many.def_vmap
    def _rule(size, batched, leaves):
        count = _count(flags, leaves, batched[0])
        both = tuple(a or b for a, b in zip(flags, batched[0], strict=True))

        def joined(leaf, old, new):
            if not (old or new):
                return leaf
            if not new:
                leaf = jnp.broadcast_to(leaf, (size, *leaf.shape))
            elif not old:
                shape = (size, count, *leaf.shape[1:])
                leaf = jnp.broadcast_to(leaf[:, None], shape)
            return leaf.reshape(size * count, *leaf.shape[2:])

        joint = [joined(*x) for x in zip(leaves, flags, batched[0], strict=True)]
        out = _many(build, both)(joint)
        out = jax.tree.map(lambda a: a.reshape(size, count, *a.shape[1:]), out)
        return out, jax.tree.map(lambda _: True, out)

    return many


def _count(flags, leaves, batched):
    """Number of lanes, of leaves that may have one axis more in front."""
    for leaf, flag, more in zip(leaves, flags, batched, strict=True):
        if flag:
            return leaf.shape[1 if more else 0]
    raise AssertionError("no leaf has lanes")


def _in_lanes(build, flags, leaves):
    common = [leaf for leaf, flag in zip(leaves, flags, strict=True) if not flag]
    own = [leaf for leaf, flag in zip(leaves, flags, strict=True) if flag]

    def loop(mine):
        rest, mine = iter(common), iter(mine)
        return build([next(mine if flag else rest) for flag in flags])

    begin = jax.vmap(lambda mine: loop(mine).begin)(own)
    going = jax.vmap(lambda mine, state: loop(mine).unfinished(state))(own, begin)
    ended = _compacting(loop, own, begin, going)
    return jax.vmap(lambda mine, state: loop(mine).finish(state))(own, ended)


def _compacting(loop, own, state, going):
    """Passes with all lanes while most of them go on, then with some at a time.

    Lanes are gathered anew once half of those at work are done, not sooner: gathering
    costs a good part of a pass.
    """

    def pass_(mine, state, going):
        new = loop(mine).step(state)
        new = jax.tree.map(lambda a, b: jnp.where(going, a, b), new, state)
        return new, going & loop(mine).unfinished(new)

    def passes(own, state, going, fewest):
        """Until no more than `fewest` go on."""
        return lax.while_loop(
            lambda carry: jnp.sum(carry[1]) > fewest,
            lambda carry: jax.vmap(pass_)(own, *carry),
            (state, going),
        )

    count = going.shape[0]
    width = count // PART
    if width < LEAST:
        return passes(own, state, going, 0)[0]

    def some(carry):
        state, going = carry
        (place,) = jnp.nonzero(going, size=width, fill_value=count)
        source = jnp.minimum(place, count - 1)
        waiting = jnp.sum(going) > width
        part = jax.tree.map(lambda a: a[source], (own, state))
        fewest = jnp.where(waiting, width // 2, 0)
        new = passes(part[0], part[1], place < count, fewest)
        # Out of range is dropped.
        return jax.tree.map(lambda a, b: a.at[place].set(b, mode="drop"), carry, new)

    carry = passes(own, state, going, count // 2)
    return lax.while_loop(lambda carry: jnp.any(carry[1]), some, carry)[0]

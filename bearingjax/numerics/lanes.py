"""Iterations of many problems, few of which wait for the slowest.

Under `vmap` a `while_loop` goes on with every lane until the last is done. Here all
lanes go on only while most of them need it; the rest is gathered, some at a time.

An example: how often each of many numbers halves until it is below a limit. What does
not change from step to step is prepared by the caller, once, and is `given`:

    halve = Loop(
        init=lambda given: (given.number, 0),
        step=lambda given, state: (0.5 * state[0], state[1] + 1),
        terminate=lambda given, state: state[0] < given.limit,
        finish=lambda given, state: state[1],
    )
    times = jax.vmap(lambda number: run(halve, Given(number, limit)))(numbers)

`Given` is any pytree. Its leaves that are alike in all lanes, as `limit` here, are kept
once.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_batching import custom_vmap
from jaxtyping import Array, Bool

PART = 8
"""One lane in so many goes on at a time when no more than half are left."""

LEAST = 16
"""Fewest lanes that go on at a time: a pass of fewer costs its overhead."""

SMALL = 64
"""Most numbers of a leaf that is packed with others."""


class Loop(NamedTuple):
    """An iteration: `init`, then `step` until `terminate`, then `finish`.

    Attributes:
        init: given -> first state, any pytree of arrays, one of them floating.
        step: (given, state) -> next state.
        terminate: (given, state) -> whether to stop.
        finish: (given, last state) -> what is wanted of it.
    """

    init: Callable[[Any], Any]
    step: Callable[[Any, Any], Any]
    terminate: Callable[[Any, Any], Any]
    finish: Callable[[Any, Any], Any]

    def run(self, given) -> Any:
        """What comes out of the iteration."""
        begin = self.init(given)
        pack, unpack = packing(begin)
        last = lax.while_loop(
            lambda packed: ~self.terminate(given, unpack(packed)),
            lambda packed: pack(self.step(given, unpack(packed))),
            pack(begin),
        )
        return self.finish(given, unpack(last))


class Either(NamedTuple):
    """One of two states: one selection in the compiled loop, not one per leaf.

    A step may return it, or what contains it, in place of the state.

    Attributes:
        flag: Which of them.
        yes: If true.
        no: If false, same structure.
    """

    flag: Bool[Array, ""]
    yes: Any
    no: Any


def packing(example) -> tuple[Callable[[Any], list[Array]], Callable[[Any], Any]]:
    """How to make one array of the small leaves of a state, and the state of it again.

    A pass of a compiled loop then ends in one kernel, not in one per leaf: in batches
    of small problems a fifth of the time.

    Args:
        example: State with at least one floating leaf. Flags and integers become such
            numbers: exact, up to 2²⁴ in float32.

    Returns:
        Functions state -> list of arrays -> state.
    """
    leaves, tree = jax.tree.flatten(example)
    dtype = next(a.dtype for a in leaves if jnp.issubdtype(a.dtype, jnp.floating))
    known = (dtype, bool, jnp.int32)
    small = [k for k, a in enumerate(leaves) if a.size <= SMALL and a.dtype in known]
    scalars = [k for k in small if not leaves[k].shape]
    vectors = [k for k in small if leaves[k].shape]
    large = [k for k in range(len(leaves)) if k not in small]

    def pack(state):
        choices = jax.tree.leaves(state, is_leaf=_is_either)
        flags = [one.flag for one in choices if _is_either(one)]
        if not flags:
            return joined(state)

        def side(k):
            either = jax.tree.map(
                lambda one: one[k] if _is_either(one) else one,
                state,
                is_leaf=_is_either,
            )
            return joined(either)

        (flag,) = flags
        yes, no = side(1), side(2)
        return [jnp.where(flag, a, b) for a, b in zip(yes, no, strict=True)]

    def joined(state):
        found = jax.tree.leaves(state)
        parts = [found[k].reshape(-1).astype(dtype) for k in vectors]
        numbers = [found[k].astype(dtype) for k in scalars]
        # Stacked first: XLA fuses no more than eight parts.
        parts = [*parts, *([jnp.stack(numbers)] if numbers else [])]
        return [jnp.concatenate(parts), *(found[k] for k in large)]

    def unpack(packed):
        first, *rest = packed
        found = dict(zip(large, rest, strict=True))
        begin = 0
        for k in (*vectors, *scalars):
            a = leaves[k]
            part = first[begin : begin + a.size]
            found[k] = part.reshape(a.shape).astype(a.dtype)
            begin += a.size
        return jax.tree.unflatten(tree, [found[k] for k in range(len(leaves))])

    return pack, unpack


def _is_either(node):
    return isinstance(node, Either)


def run(loop: Loop, given) -> Any:
    """`loop.run(given)`, which under `vmap` lets few lanes wait for others.

    Args:
        loop: Its functions see no traced number but those of `given`.
        given: Pytree; what is no array is static.

    Returns:
        As `Loop.finish`. Derivatives are not for here: see `implicit`.
    """
    arrays, static = eqx.partition(given, eqx.is_array)
    leaves, tree = jax.tree.flatten(arrays)

    def whole(leaves):
        return eqx.combine(jax.tree.unflatten(tree, leaves), static)

    @custom_vmap
    def one(leaves):
        return loop.run(whole(leaves))

    @one.def_vmap
    def _rule(size, batched, leaves):
        out = _many(loop, whole, tuple(batched[0]))(leaves)
        return out, jax.tree.map(lambda _: True, out)

    return one(leaves)


def _many(loop, whole, flags):
    """The loops of lanes, flagged leaves with a leading axis."""

    @custom_vmap
    def many(leaves):
        return _in_lanes(loop, whole, flags, leaves)

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
        out = _many(loop, whole, both)(joint)
        out = jax.tree.map(lambda a: a.reshape(size, count, *a.shape[1:]), out)
        return out, jax.tree.map(lambda _: True, out)

    return many


def _count(flags, leaves, batched):
    """Number of lanes, of leaves that may have one axis more in front."""
    for leaf, flag, more in zip(leaves, flags, batched, strict=True):
        if flag:
            return leaf.shape[1 if more else 0]
    raise AssertionError("no leaf has lanes")


def _in_lanes(loop, whole, flags, leaves):
    common = [leaf for leaf, flag in zip(leaves, flags, strict=True) if not flag]
    own = [leaf for leaf, flag in zip(leaves, flags, strict=True) if flag]

    def given(mine):
        rest, mine = iter(common), iter(mine)
        return whole([next(mine if flag else rest) for flag in flags])

    if jax.tree.leaves(own)[0].shape[0] // PART < LEAST:
        return jax.vmap(lambda mine: loop.run(given(mine)))(own)
    state = jax.eval_shape(lambda mine: loop.init(given(mine)), [a[0] for a in own])
    pack, unpack = packing(state)
    packed = Loop(
        lambda mine: pack(loop.init(given(mine))),
        lambda mine, s: pack(loop.step(given(mine), unpack(s))),
        lambda mine, s: loop.terminate(given(mine), unpack(s)),
        lambda mine, s: loop.finish(given(mine), unpack(s)),
    )
    state = jax.vmap(packed.init)(own)
    going = ~jax.vmap(packed.terminate)(own, state)
    ended = _compacting(packed, own, state, going)
    return jax.vmap(packed.finish)(own, ended)


def _compacting(loop, own, state, going):
    """Passes with all lanes while most of them go on, then with some at a time.

    Lanes are gathered anew once half of those at work are done, not sooner: gathering
    costs a good part of a pass.
    """

    def pass_(mine, state, going):
        new = loop.step(mine, state)
        new = jax.tree.map(lambda a, b: jnp.where(going, a, b), new, state)
        return new, going & ~loop.terminate(mine, new)

    def passes(own, state, going, fewest):
        """Until no more than `fewest` go on."""
        return lax.while_loop(
            lambda carry: jnp.sum(carry[1]) > fewest,
            lambda carry: jax.vmap(pass_)(own, *carry),
            (state, going),
        )

    count = going.shape[0]
    width = count // PART

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

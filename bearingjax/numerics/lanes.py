"""Iterations of many problems, none of which waits for the slowest.

Under `vmap` a `while_loop` goes on with every lane until the last is done. Here the
problems of a batch stand in a queue. Some at a time are at work, each in a slot; once
part of the slots are done, their problems leave and the next ones enter.

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

SLOTS, IDLE = 64, 16
"""Slots, and how many of them may be idle, if not said otherwise. What the slots hold
should stay in the cache of a core."""

SMALL = 64
"""Most numbers of a leaf that is packed with others."""


class Loop(NamedTuple):
    """An iteration: `init`, then `step` until `terminate`, then `finish`.

    Attributes:
        init: given -> first state, any pytree of arrays, one of them floating.
        step: (given, state) -> next state.
        terminate: (given, state) -> whether to stop.
        finish: (given, last state) -> what is wanted of it.
        rest: given -> (whether nothing is to be done, what is wanted then); `None`:
            something always is.
    """

    init: Callable[[Any], Any]
    step: Callable[[Any, Any], Any]
    terminate: Callable[[Any, Any], Any]
    finish: Callable[[Any, Any], Any]
    rest: Callable[[Any], tuple[Bool[Array, ""], Any]] | None = None

    def run(self, given) -> Any:
        """What comes out of the iteration."""
        begin = self.init(given)
        pack, unpack = packing(begin)
        resting, rest = (None, None) if self.rest is None else self.rest(given)

        def ended(packed):
            done = self.terminate(given, unpack(packed))
            return done if resting is None else done | resting

        last = lax.while_loop(
            lambda packed: ~ended(packed),
            lambda packed: pack(self.step(given, unpack(packed))),
            pack(begin),
        )
        found = self.finish(given, unpack(last))
        if resting is None:
            return found
        return jax.tree.map(lambda a, b: jnp.where(resting, a, b), rest, found)


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
        example: State. Flags and integers become numbers of the type of its first
            floating leaf: exact, up to 2²⁴ in float32.

    Returns:
        Functions state -> list of arrays -> state.
    """
    leaves, tree = jax.tree.flatten(example)
    floating = [a.dtype for a in leaves if jnp.issubdtype(a.dtype, jnp.floating)]
    dtype = floating[0] if floating else None
    known = (dtype, bool, jnp.int32) if floating else ()
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
        others = [found[k] for k in large]
        if not small:
            return others
        parts = [found[k].reshape(-1).astype(dtype) for k in vectors]
        numbers = [found[k].astype(dtype) for k in scalars]
        # Stacked first: XLA fuses no more than eight parts.
        parts = [*parts, *([jnp.stack(numbers)] if numbers else [])]
        return [*others, jnp.concatenate(parts)]

    def unpack(packed):
        found = dict(zip(large, packed, strict=False))
        first, begin = packed[-1], 0
        for k in (*vectors, *scalars):
            a = leaves[k]
            part = first[begin : begin + a.size]
            found[k] = part.reshape(a.shape).astype(a.dtype)
            begin += a.size
        return jax.tree.unflatten(tree, [found[k] for k in range(len(leaves))])

    return pack, unpack


def _is_either(node):
    return isinstance(node, Either)


def run(loop: Loop, given, slots: int = SLOTS, idle: int = IDLE) -> Any:
    """`loop.run(given)`, which under `vmap` lets few lanes wait for others.

    Args:
        loop: Its functions see no traced number but those of `given`.
        given: Pytree; what is no array is static.
        slots: How many problems of a batch are at work at a time, while others wait. A
            batch of fewer than two times as many is stepped together by `vmap`.
        idle: How many slots may be done before they are refilled, while problems wait.
            It costs a part of a step, and more where states are large.

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
        out = _many(loop, whole, (slots, idle), tuple(batched[0]))(leaves)
        return out, jax.tree.map(lambda _: True, out)

    return one(leaves)


def _many(loop, whole, slots, flags):
    """The loops of lanes, flagged leaves with a leading axis."""

    @custom_vmap
    def many(leaves):
        return _in_lanes(loop, whole, slots, flags, leaves)

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
        out = _many(loop, whole, slots, both)(joint)
        out = jax.tree.map(lambda a: a.reshape(size, count, *a.shape[1:]), out)
        return out, jax.tree.map(lambda _: True, out)

    return many


def _count(flags, leaves, batched):
    """Number of lanes, of leaves that may have one axis more in front."""
    for leaf, flag, more in zip(leaves, flags, batched, strict=True):
        if flag:
            return leaf.shape[1 if more else 0]
    raise AssertionError("no leaf has lanes")


def _in_lanes(loop, whole, slots, flags, leaves):
    common = [leaf for leaf, flag in zip(leaves, flags, strict=True) if not flag]
    own = [leaf for leaf, flag in zip(leaves, flags, strict=True) if flag]

    def given(mine):
        rest, mine = iter(common), iter(mine)
        return whole([next(mine if flag else rest) for flag in flags])

    count = own[0].shape[0]
    if count < 2 * slots[0]:
        return jax.vmap(lambda mine: loop.run(given(mine)))(own)
    return _queued(loop, given, own, count, slots)


def _queued(loop, given, own, count, slots):
    """All problems, some at a time; see the top of this file."""
    width, spare = slots
    one = [jax.ShapeDtypeStruct(a.shape[1:], a.dtype) for a in own]
    begin = jax.eval_shape(lambda mine: loop.init(given(mine)), one)
    if loop.rest is None:
        end = jax.eval_shape(lambda mine, s: loop.finish(given(mine), s), one, begin)
    else:
        _, end = jax.eval_shape(lambda mine: loop.rest(given(mine)), one)
    # Three arrays are moved about in place of very many.
    pack_own, unpack_own = packing(one)
    pack, unpack = packing(begin)
    pack_end, unpack_end = packing(end)

    def enter(mine, fresh):
        problem = given(unpack_own(mine))
        state = loop.init(problem)
        return pack(state), fresh & ~loop.terminate(problem, state)

    def step(mine, state, going):
        problem = given(unpack_own(mine))
        new = pack(loop.step(problem, unpack(state)))
        new = [jnp.where(going, a, b) for a, b in zip(new, state, strict=True)]
        return new, going & ~loop.terminate(problem, unpack(new))

    def leave(mine, state):
        return pack_end(loop.finish(given(unpack_own(mine)), unpack(state)))

    def resting(mine):
        idle, found = loop.rest(given(mine))
        return idle, pack_end(found)

    if loop.rest is None:
        idle = jnp.zeros((count,), bool)
        out = _blank(pack_end, end, count)
    else:
        idle, out = jax.vmap(resting)(own)
    own = jax.vmap(pack_own)(own)
    (queue,) = jnp.nonzero(~idle, size=count, fill_value=count)
    waiting = jnp.sum(~idle)

    def refilled(taken, place, state, going):
        """The next of the queue in slots that do not go on."""
        following = taken + jnp.cumsum(~going) - 1
        fresh = queue.at[following].get(mode="fill", fill_value=count)
        place = jnp.where(going, place, fresh)
        mine = [a[jnp.minimum(place, count - 1)] for a in own]
        entered, begun = jax.vmap(enter)(mine, ~going & (place < count))
        state = [
            jnp.where(going.reshape(-1, *[1] * (a.ndim - 1)), a, b)
            for a, b in zip(state, entered, strict=True)
        ]
        return taken + jnp.sum(~going), place, mine, state, going | begun

    def turn(carry):
        out, taken, place, mine, state, going = carry
        # Those at work leave the others alone until many slots are done: to refill
        # them costs a good part of a step.
        fewest = jnp.where(taken < waiting, width - spare, 0)
        state, going = lax.while_loop(
            lambda now: jnp.sum(now[1]) > fewest,
            lambda now: jax.vmap(step)(mine, *now),
            (state, going),
        )
        found = jax.vmap(leave)(mine, state)
        # What is out of range is dropped.
        to = jnp.where(going, count, place)
        out = [a.at[to].set(b, mode="drop") for a, b in zip(out, found, strict=True)]
        return out, *refilled(taken, place, state, going)

    nobody = jnp.zeros((width,), bool)
    none = jnp.zeros_like(waiting), jnp.zeros((width,), queue.dtype)
    begin = refilled(*none, _blank(pack, begin, width), nobody)
    carry = lax.while_loop(lambda c: jnp.any(c[2] < count), turn, (out, *begin))
    return jax.vmap(unpack_end)(carry[0])


def _blank(pack, example, count):
    """Zeros in the shape of `count` packed examples."""
    shapes = jax.eval_shape(pack, example)
    return [jnp.zeros((count, *a.shape), a.dtype) for a in shapes]

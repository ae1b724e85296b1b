"""Iterations of many problems, none of which waits for the slowest.

Under `vmap` a `while_loop` runs every lane until the last is done. Here the problems of
a batch wait in a queue. Some at a time are iterated, each in a slot; once part of the
slots are done, their problems leave and the next ones enter.

An example: the number of halvings of each of many numbers until it is below a limit.
Data that do not change from step to step are prepared once by the caller, as `given`:

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

import dataclasses
import functools
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jax.core import ShapedArray
from jax.extend.core import Primitive
from jax.interpreters import batching, mlir
from jaxtyping import Array, Bool

SLOTS, IDLE = 64, 16
"""Default number of slots, and how many of them may be idle. The data of the slots
should fit the cache of a core."""

WIDER = 64
"""Multiple of the slots on a GPU, whose threads want more problems at a time."""

SMALL = 64
"""Largest size of a leaf that is packed with others."""


class Loop(NamedTuple):
    """An iteration: `init`, then `step` until `terminate`, then `finish`.

    Attributes:
        init: given -> first state, any pytree of arrays, one of them floating.
        step: (given, state) -> next state.
        terminate: (given, state) -> whether to stop.
        finish: (given, last state) -> result.
        trivial_result: given -> arrays of the same shapes and types as the result of
            `finish`, which then need not be traced to find them; `None`: it is traced.
        is_trivial: given -> whether the problem needs no iteration; its result is then
            `trivial_result`. `None`: every problem is iterated.
    """

    init: Callable[[Any], Any]
    step: Callable[[Any, Any], Any]
    terminate: Callable[[Any, Any], Any]
    finish: Callable[[Any, Any], Any]
    trivial_result: Callable[[Any], Any] | None = None
    is_trivial: Callable[[Any], Bool[Array, ""]] | None = None

    def run(self, given: Any) -> Any:
        """Run the iteration on one problem and return its result."""
        begin = self.init(given)
        pack, unpack = packing(begin)
        resting = None if self.is_trivial is None else self.is_trivial(given)

        def is_done(packed):
            done = self.terminate(given, unpack(packed))
            return done if resting is None else done | resting

        last = lax.while_loop(
            lambda packed: ~is_done(packed),
            lambda packed: pack(self.step(given, unpack(packed))),
            pack(begin),
        )
        found = self.finish(given, unpack(last))
        if resting is None:
            return found
        assert self.trivial_result is not None, "`is_trivial` needs `trivial_result`"
        nothing = self.trivial_result(given)
        return jax.tree.map(lambda a, b: jnp.where(resting, a, b), nothing, found)

    def shapes(self, given: Any) -> Any:
        """Shapes and types of the result of `run`."""
        return jax.eval_shape(
            self.run if self.trivial_result is None else self.trivial_result, given
        )


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


def packing(example: Any) -> tuple[Callable[[Any], list[Array]], Callable[[Any], Any]]:
    """Functions that pack the small leaves of a state into one array, and unpack it.

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
            return join_leaves(state)

        def side(k):
            either = jax.tree.map(
                lambda one: one[k] if _is_either(one) else one,
                state,
                is_leaf=_is_either,
            )
            return join_leaves(either)

        (flag,) = flags
        yes, no = side(1), side(2)
        return [jnp.where(flag, a, b) for a, b in zip(yes, no, strict=True)]

    def join_leaves(state):
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


def run(loop: Loop, given: Any, slots: int = SLOTS, idle: int = IDLE) -> Any:
    """`loop.run(given)`, which under `vmap` lets few lanes wait for others.

    The loop is traced when the program is lowered, and so once: one problem and a
    batch, over any number of axes, are one operation until then.

    Args:
        loop: Its functions use no traced number except those of `given`.
        given: Pytree; leaves that are not arrays are static.
        slots: Number of problems of a batch iterated at a time, while others wait;
            `WIDER` times as many on a GPU. A batch of fewer than two times as many is
            stepped together by `vmap`.
        idle: Number of slots that may be done before they are refilled, while problems
            wait; at most all. It costs a part of a step, and more with large states.

    Returns:
        Result of `Loop.finish`. It has no derivatives: see `implicit`.
    """
    arrays, static = eqx.partition(given, eqx.is_array)
    leaves, tree = jax.tree.flatten(arrays)

    def rebuild_problem(leaves):
        return eqx.combine(jax.tree.unflatten(tree, leaves), static)

    shapes, returned = jax.tree.flatten(loop.shapes(given))
    # With more than all of them it would wait for ever.
    pair = slots, min(idle, slots)
    task = _Task(loop, rebuild_problem, pair, [(a.shape, a.dtype) for a in shapes])
    out = _batched_loop.bind(
        *leaves, task=task, flags=(False,) * len(leaves), count=None
    )
    return jax.tree.unflatten(returned, out)


@dataclasses.dataclass(frozen=True, eq=False)
class _Task:
    """Static data shared by the lanes of one `run`.

    Attributes:
        loop: The iteration.
        rebuild_problem: Leaves of one problem -> argument of its functions.
        slots: Number of slots, and how many of them may be idle.
        out: Shape and type of every leaf of the result.
    """

    loop: Loop
    rebuild_problem: Callable[[Sequence[Array]], Any]
    slots: tuple[int, int]
    out: list[tuple[tuple[int, ...], Any]]

    def program(self, *leaves: Array, flags: tuple[bool, ...], count: int | None):
        """Compute the result of the operation.

        Args:
            *leaves: Leaves of the argument.
            flags: Which of them have a leading axis of lanes.
            count: Number of lanes; `None`: one problem, without such an axis.

        Returns:
            Leaves of the result, each with the axis of lanes.
        """
        if count is None:
            found = self.loop.run(self.rebuild_problem(leaves))
        else:
            found = _in_lanes(self, flags, leaves, count)
        found = jax.tree.leaves(found)
        known = [(a.shape, a.dtype) for a in self.avals(count)]
        if known != [(a.shape, a.dtype) for a in found]:
            raise TypeError(
                "bearingjax: the precision was changed inside a function that JAX"
                " traces (enable_x64 within jit), but it is compiled with the one that"
                " holds outside. Change it around the call, or before all else:"
                ' jax.config.update("jax_enable_x64", True)'
            )
        return found

    def avals(self, count: int | None) -> list[ShapedArray]:
        """Shapes and types of the result."""
        front = () if count is None else (count,)
        return [ShapedArray((*front, *a), dtype) for a, dtype in self.out]


_batched_loop = Primitive("batched_loop")
_batched_loop.multiple_results = True


@_batched_loop.def_impl
def _call(*leaves, task, **choices):
    return jax.jit(functools.partial(task.program, **choices))(*leaves)


@_batched_loop.def_abstract_eval
def _abstract(*leaves, task, flags, count):
    return task.avals(count)


def _lower(*leaves, task, **choices):
    return task.program(*leaves, **choices)


def _lowered_wide(*leaves, task, **choices):
    slots, idle = (WIDER * n for n in task.slots)
    return _lower(
        *leaves, task=dataclasses.replace(task, slots=(slots, idle)), **choices
    )


mlir.register_lowering(_batched_loop, mlir.lower_fun(_lower))
for _platform in ("cuda", "rocm"):
    mlir.register_lowering(
        _batched_loop, mlir.lower_fun(_lowered_wide), platform=_platform
    )


def _batch(leaves, axes, *, task, flags, count):
    """One more axis of `vmap` makes more lanes of the same kind."""
    more = [axis is not None for axis in axes]
    leaves = [
        jnp.moveaxis(leaf, axis, 0) if new else leaf
        for leaf, axis, new in zip(leaves, axes, more, strict=True)
    ]
    size = next(leaf.shape[0] for leaf, new in zip(leaves, more, strict=True) if new)
    both = tuple(a or b for a, b in zip(flags, more, strict=True))

    def join_axes(leaf, old, new):
        if count is None or not (old or new):
            return leaf
        if not new:
            leaf = jnp.broadcast_to(leaf, (size, *leaf.shape))
        elif not old:
            shape = (size, count, *leaf.shape[1:])
            leaf = jnp.broadcast_to(leaf[:, None], shape)
        return leaf.reshape(size * count, *leaf.shape[2:])

    joint = [join_axes(*x) for x in zip(leaves, flags, more, strict=True)]
    lanes = size if count is None else size * count
    out = _batched_loop.bind(*joint, task=task, flags=both, count=lanes)
    if count is not None:
        out = [a.reshape(size, count, *a.shape[1:]) for a in out]
    return out, [0] * len(out)


batching.primitive_batchers[_batched_loop] = _batch


def _in_lanes(task, flags, leaves, count):
    common = [leaf for leaf, flag in zip(leaves, flags, strict=True) if not flag]
    own = [leaf for leaf, flag in zip(leaves, flags, strict=True) if flag]

    def problem_of(mine):
        rest, mine = iter(common), iter(mine)
        return task.rebuild_problem([next(mine if flag else rest) for flag in flags])

    if count < 2 * task.slots[0]:
        return jax.vmap(lambda mine: task.loop.run(problem_of(mine)))(own)
    return _run_queue(task, problem_of, own, count)


def _run_queue(task, given, own, count):
    """All problems, some at a time; see the top of this file."""
    loop, (width, spare) = task.loop, task.slots
    one = [jax.ShapeDtypeStruct(a.shape[1:], a.dtype) for a in own]
    begin = jax.eval_shape(lambda mine: loop.init(given(mine)), one)
    end = task.avals(None)
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

    def finish(mine, state):
        found = loop.finish(given(unpack_own(mine)), unpack(state))
        return pack_end(jax.tree.leaves(found))

    def find_trivial(mine):
        problem = given(mine)
        return loop.is_trivial(problem), pack_end(
            jax.tree.leaves(loop.trivial_result(problem))
        )

    if loop.is_trivial is None:
        idle = jnp.zeros((count,), bool)
        out = _empty_slots(pack_end, end, count)
    else:
        idle, out = jax.vmap(find_trivial)(own)
    own = jax.vmap(pack_own)(own)
    (queue,) = jnp.nonzero(~idle, size=count, fill_value=count)
    waiting = jnp.sum(~idle)

    def refill(taken, place, state, going):
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
        found = jax.vmap(finish)(mine, state)
        # What is out of range is dropped.
        to = jnp.where(going, count, place)
        out = [a.at[to].set(b, mode="drop") for a, b in zip(out, found, strict=True)]
        return out, *refill(taken, place, state, going)

    at_work = jnp.zeros((width,), bool)
    none = jnp.zeros_like(waiting), jnp.zeros((width,), queue.dtype)
    begin = refill(*none, _empty_slots(pack, begin, width), at_work)
    carry = lax.while_loop(lambda c: jnp.any(c[2] < count), turn, (out, *begin))
    return jax.vmap(unpack_end)(carry[0])


def _empty_slots(pack, example, count):
    """Zeros in the shape of `count` packed examples."""
    shapes = jax.eval_shape(pack, example)
    return [jnp.zeros((count, *a.shape), a.dtype) for a in shapes]

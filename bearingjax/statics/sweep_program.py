"""Blocks of cases over devices: the compiled program of a sweep."""

import math
import time
from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.experimental import multihost_utils
from jax.sharding import Mesh, NamedSharding
from jax.sharding import PartitionSpec as Spec

from ..element.frame import RINGS
from ..numerics.result import Result
from .cases import solve_case
from .life import LifeConditions, life_of, life_outputs
from .life_warning import life_sizes
from .options import SolveOptions
from .solution import Solution
from .warning import sizes

BLOCK = 4096
"""Cases of a device between two visits of the host, or a chunk if that is more."""

LARGEST = 4 * 2**30
"""Bytes that the outputs of a sweep may take."""

_PAUSE = 0.005
"""Seconds between two looks at a block under way."""

ALWAYS = ("result", "unrestrained")
"""Outputs that every sweep has."""

WARNED = "warning_"
"""Before the names of the outputs that are sizes of warnings."""


class Task(eqx.Module):
    """What is done with every case.

    Attributes:
        options: How it is solved.
        keep: Of a Solution, the outputs by name.
        warn: Whether to look for warnings.
        lives: Names of `LIFE_OUTPUTS` that are kept too.
        life: Conditions of the life; `None`: it is not looked at.

    Traced: the numbers of `options` and `life`. Static: all else.
    """

    options: SolveOptions
    keep: Callable[[Solution], dict[str, jax.Array]] = eqx.field(static=True)
    warn: bool = eqx.field(static=True)
    lives: tuple[str, ...] = eqx.field(static=True, default=())
    life: LifeConditions | None = None

    def solve(self, element, case, start=None) -> Solution:
        """The solution of a case, in the design that it chooses."""
        if case.design is not None:
            element = jax.tree.map(lambda leaf: leaf[case.design], element)
        return solve_case(element, case, self.options, start)

    def outputs(self, solution) -> dict[str, jax.Array]:
        """What is kept of a solution; numbers of a failed one are NaN."""
        solved = solution.converged

        def told(value):
            if jnp.issubdtype(value.dtype, jnp.floating):
                return jnp.where(solved, value, jnp.nan)
            return value

        kept = {name: told(v) for name, v in _arrays(self.keep(solution)).items()}
        warned = sizes(solution) if self.warn else {}
        if self.life is not None:
            life = life_of(solution.element, solution, self.life)
            lives = life_outputs(life, self.lives)
            kept |= {name: told(v) for name, v in lives.items()}
            if self.warn:
                bearing = solution.element.bearing
                doubts = life_sizes(bearing, life.ratings, vars(life))
                warned |= {name: told(size) for name, size in doubts.items()}
        always = {name: getattr(solution, name) for name in ALWAYS}
        return {**kept, **always, **{WARNED + k: size for k, size in warned.items()}}


def _arrays(kept) -> dict[str, jax.Array]:
    """What a function for `outputs` returned, if it is a dict of arrays."""
    if not isinstance(kept, dict):
        raise TypeError(
            f"sweep: `outputs` returns a {type(kept).__name__}; it must return a dict"
            " of arrays by name."
        )
    for name, value in kept.items():
        if not eqx.is_array_like(value):
            raise TypeError(
                f"sweep: `outputs` returns a {type(value).__name__} as {name!r}; it"
                " must be an array or a number."
            )
    return {name: jnp.asarray(value) for name, value in kept.items()}


class Program:
    """Blocks of cases over devices.

    Args:
        element: The bearing or designs.
        task: What is done with every case.
        chunk: Cases of a batch.
        devices: Where to.
    """

    def __init__(self, element, task, chunk, devices):
        self.element, self.task, self.chunk = element, task, chunk
        self.mesh = Mesh(devices, ("case",))

    def run(self, cases, neighbours, progress, stop=None):
        """All outputs of all cases, NumPy arrays by name; after `stop` the rest are
        `NOT_RUN`."""
        n = cases.count
        lanes = self.mesh.size * min(self.chunk, math.ceil(n / self.mesh.size))
        chunks = max(1, BLOCK * self.mesh.size // lanes)
        block = lanes * min(chunks, math.ceil(n / lanes))
        shard = NamedSharding(self.mesh, Spec("case"))
        held = jax.tree.map(np.asarray, cases)
        found: dict[str, np.ndarray] = {}
        pending, last = None, 0
        with _bar(n if progress else None) as advance:
            for begin in [*range(0, n, block), None]:
                if pending is not None and stop is not None and stop():
                    begin = None
                if begin is not None:
                    end = min(begin + block, n)
                    part = jax.tree.map(lambda a: _padded(a[begin:end], block), held)  # noqa: B023
                    given = jax.tree.map(lambda a: _spread(a, shard), part)
                    given = (
                        self.element,
                        given,
                        self.task,
                        lanes // self.mesh.size,
                        neighbours,
                        self.mesh,
                    )
                    if not found:
                        shapes = eqx.filter_eval_shape(_solve_block, *given)
                        found = _room(shapes, n, block)
                    out = _solve_block(*given)
                    submitted = (out, begin, end)
                else:
                    submitted = None
                # The next block is on its way while this one is fetched.
                if pending is not None:
                    values, first, last = pending
                    if stop is not None:
                        _wait(values)
                    for name, value in values.items():
                        found[name][first:last] = _whole(value)[: last - first]
                    advance(last - first)
                pending = submitted
                if begin is None:
                    break
        for name, values in found.items():
            values[last:] = not_run(name, values.dtype)
        return found


@eqx.filter_jit
def _solve_block(element, cases, task, lanes, neighbours, mesh):
    """A block of cases, each device its share in chunks of `lanes`."""
    arrays, static = eqx.partition((element, task), eqx.is_array)

    def share(arrays, cases):
        element, task = eqx.combine(arrays, static)

        def one(case, start=None):
            return task.solve(element, case, start)

        if neighbours:
            return _in_turn(one, task, cases, lanes)
        return lax.map(lambda c: task.outputs(one(c)), cases, batch_size=lanes)

    spread = jax.shard_map(
        share,
        mesh=mesh,
        in_specs=(Spec(), Spec("case")),
        out_specs=Spec("case"),
        check_vma=False,
    )
    return spread(arrays, cases)


def _in_turn(one, task, cases, lanes):
    """Each lane takes a run of cases, each case from the solution before it."""
    first = 6 * RINGS.index(task.options.moving_ring)
    moving = slice(first, first + 6)
    # (lane, turn) -> turn first, for the scan.
    runs = jax.tree.map(
        lambda a: jnp.swapaxes(a.reshape(lanes, -1, *a.shape[1:]), 0, 1), cases
    )

    def lane(start, case):
        solution = one(case, start)
        there = jnp.where(solution.converged, solution.displacement[moving], jnp.nan)
        return there, task.outputs(solution)

    begin = jnp.full((lanes, 6), jnp.nan, cases.load.dtype)
    _, outputs = lax.scan(jax.vmap(lane), begin, runs)
    return jax.tree.map(
        lambda a: jnp.swapaxes(a, 0, 1).reshape(-1, *a.shape[2:]), outputs
    )


def _padded(array, size):
    missing = size - array.shape[0]
    if missing == 0:
        return array
    return np.concatenate([array, np.repeat(array[-1:], missing, axis=0)])


def _spread(array, sharding):
    return jax.make_array_from_callback(array.shape, sharding, lambda i: array[i])


def _whole(array):
    """A global array on this host."""
    if array.is_fully_addressable:
        return np.asarray(array)
    return np.asarray(multihost_utils.process_allgather(array, tiled=True))


def _wait(values):
    """Until they are there; signals are heard meanwhile, which NumPy would not do."""
    while not all(value.is_ready() for value in values.values()):
        time.sleep(_PAUSE)


def not_run(name: str, dtype: np.dtype) -> int | float:
    """What an output holds of a case that was not run.

    Args:
        name: Of the output.
        dtype: Its type.
    """
    if name == "result":
        return Result.NOT_RUN
    return np.nan if dtype.kind == "f" else 0


def _room(out, n, block):
    """Empty arrays for the outputs of all cases."""
    needed = sum(v.dtype.itemsize * v.size // block * n for v in out.values())
    if needed > LARGEST:
        raise ValueError(
            f"sweep: the outputs of {n} cases take {needed / 2**30:.3g} GiB, more than"
            f" {LARGEST / 2**30:g}; name those that you need in `outputs`, or use fewer"
            " `points`."
        )
    return {name: np.empty((n, *v.shape[1:]), v.dtype) for name, v in out.items()}


class _bar:
    """Progress in cases; nothing if `total` is `None`."""

    def __init__(self, total):
        self.bar = None
        if total is not None:
            from tqdm import tqdm

            self.bar = tqdm(total=total, unit="case", unit_scale=True)

    def __enter__(self):
        return self.bar.update if self.bar is not None else lambda n: None

    def __exit__(self, *_):
        if self.bar is not None:
            self.bar.close()

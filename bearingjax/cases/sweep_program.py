"""Blocks of cases over devices: the compiled program of a sweep."""

import functools
import math
import time
from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.experimental import multihost_utils
from jax.sharding import Mesh, NamedSharding
from jax.sharding import PartitionSpec as Spec

from ..design import rows_of
from ..element.bearing_element import BearingElement
from ..life.life import LifeConditions, life_outputs, rating_life
from ..life.life_warning import life_sizes
from ..numerics.compiled.programs import program
from ..numerics.result import Result
from ..numerics.types import as_array, with_fields
from ..statics import Solution, SolveOptions, Support
from ..statics.warning import sizes
from .cases import Cases, solve_case
from .near_starts import (
    add_solved,
    common_properties,
    nothing_known,
    starts,
    unsafe_to_start_near,
)

BLOCK = 4096
"""Cases of a device between two visits of the host, or a chunk if that is more."""

LARGEST_OUTPUTS = 4 * 2**30
"""Bytes that the outputs of a sweep may take."""

_PAUSE = 0.005
"""Seconds between two looks at a block under way."""

ALWAYS = ("result", "unrestrained")
"""Outputs that every sweep has."""

_LOST = "_lost"
"""Output that says which cases are solved again, from first contact."""

WARNED = "warning_"
"""Before the names of the outputs that are sizes of warnings."""


def named_sizes(outputs: dict[str, Any]) -> dict[str, Any]:
    """Return the sizes of warnings among outputs, by the kind of warning.

    Args:
        outputs: Outputs by name.
    """
    pairs = outputs.items()
    return {k.removeprefix(WARNED): x for k, x in pairs if k.startswith(WARNED)}


class Task(eqx.Module):
    """Operations that a sweep performs on every case.

    Attributes:
        support: What holds the rings.
        options: Numerics of the load solve.
        keep: Function Solution -> outputs by name.
        warn: Whether to look for warnings.
        lives: Names of the `LIFE_OUTPUTS` that are also kept.
        life: Conditions of the life; `None`: no life is computed.

    Traced: the numbers of `options` and `life`. Static: all else.
    """

    support: Support
    options: SolveOptions
    keep: Callable[[Solution], dict[str, jax.Array]] = eqx.field(static=True)
    warn: bool = eqx.field(static=True)
    lives: tuple[str, ...] = eqx.field(static=True, default=())
    life: LifeConditions | None = None

    def solve(
        self, element: BearingElement, case: Cases, start: Any = None
    ) -> Solution:
        """Solve a case, with the design that it selects."""
        if case.design is not None:
            element = jax.tree.map(lambda leaf: leaf[case.design], element)
        return solve_case(element, case, self.support, self.options, start)

    def outputs(self, solution: Any, case: Cases) -> dict[str, jax.Array]:
        """Outputs of a solved case by name; floats of a failed solve are NaN."""
        solved = solution.converged

        def nan_if_failed(value):
            if jnp.issubdtype(value.dtype, jnp.floating):
                return jnp.where(solved, value, jnp.nan)
            return value

        kept = {
            name: nan_if_failed(v) for name, v in _arrays(self.keep(solution)).items()
        }
        warned = sizes(solution) if self.warn else {}
        if self.life is not None:
            oiled = self.life
            if case.viscosity is not None and oiled.viscosity is not None:
                oiled = with_fields(oiled, viscosity=case.viscosity)
            swing: Any = case.oscillation
            life = rating_life(solution.element, solution, oiled, oscillation=swing)
            lives = life_outputs(life, self.lives)
            kept |= {name: nan_if_failed(v) for name, v in lives.items()}
            if self.warn:
                bearing = solution.element.bearing
                doubts = life_sizes(bearing, life.ratings, vars(life))
                warned |= {name: nan_if_failed(size) for name, size in doubts.items()}
        always = {name: getattr(solution, name) for name in ALWAYS}
        return {**kept, **always, **{WARNED + k: size for k, size in warned.items()}}


def _arrays(kept) -> dict[str, jax.Array]:
    """Check that an `outputs` function returned a dict of arrays; return the arrays."""
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
        task: Operations on every case.
        chunk: Cases of a batch.
        devices: Devices to run on.
    """

    def __init__(self, element, task, chunk, devices):
        self.element, self.task, self.chunk = element, task, chunk
        self.mesh = Mesh(devices, ("case",))

    def run(
        self,
        cases: Cases,
        near: bool = True,
        progress: Any = False,
        stop: Callable | None = None,
    ) -> dict[str, np.ndarray]:
        """All outputs of all cases, NumPy arrays by name; after `stop` the rest are
        `NOT_RUN`.

        Cases started near by that end without a valid result are solved again from
        first contact.
        """
        held = jax.tree.map(
            np.asarray, (cases, unsafe_to_start_near(self.element, cases))
        )
        found = self._blocks(held, cases.count, near, progress, stop)
        lost = np.flatnonzero(found.pop(_LOST))
        if lost.size:
            again = jax.tree.map(lambda a: a[lost], held)
            anew = self._blocks(again, cases.count, False)
            for name, values in found.items():
                values[lost] = anew[name]
        return found

    def _may_be_large(self, n):
        """Whether outputs may take too much; their shapes then cost a tracing."""
        rows = rows_of(self.element.bearing)
        elements = sum(row.bearing.n_places for row in rows)
        numbers = n * elements * (20 * self.task.options.points + 1000)
        return 8 * numbers > LARGEST_OUTPUTS

    def _blocks(self, held, like, near, progress=False, stop=None):
        """Outputs of cases, in blocks as in a sweep of `like` cases."""
        n, devices = held[0].count, self.mesh.size
        lanes = min(self.chunk, math.ceil(like / devices))
        chunks = min(max(1, BLOCK // lanes), math.ceil(like / (devices * lanes)))
        block = devices * lanes * chunks
        shard = NamedSharding(self.mesh, Spec("case"))
        alike = common_properties(self.element, held[0], self.task.support)
        known = nothing_known(lanes, devices, held[1].shape[1])
        known = jax.tree.map(lambda a: _spread_over_devices(a, shard), known)
        found: dict[str, np.ndarray] = {}
        pending, last = None, 0
        with _progress_bar(n if progress else None) as bar:
            for begin in [*range(0, n, block), None]:
                if pending is not None and stop is not None and stop():
                    begin = None
                if begin is not None:
                    end = min(begin + block, n)
                    part = jax.tree.map(lambda a: _pad_chunk(a[begin:end], block), held)  # noqa: B023
                    given = (
                        self.element,
                        jax.tree.map(lambda a: _spread_over_devices(a, shard), part),
                        known,
                        as_array(near, bool),
                        self.task,
                        lanes,
                        alike,
                        self.mesh,
                    )
                    if not found and self._may_be_large(n):
                        _check_size(eqx.filter_eval_shape(_solve_block, *given)[0], n)
                    out, known = _solve_block(*given)
                    if not found:
                        _check_size(out, n)
                        found = {
                            name: np.empty((n, *v.shape[1:]), v.dtype)
                            for name, v in out.items()
                        }
                    submitted = (out, begin, end)
                else:
                    submitted = None
                # The next block is on its way while this one is fetched.
                if pending is not None:
                    values, first, last = pending
                    if stop is not None:
                        _wait_for(values)
                    for name, value in values.items():
                        found[name][first:last] = _copy_to_host(value)[: last - first]
                    bar.update(last - first)
                pending = submitted
                if begin is None:
                    break
        for name, values in found.items():
            values[last:] = not_run(name, values.dtype)
        return found


@program
def _solve_block(element, given, known, near, task, lanes, alike, mesh):
    """Solve a block of cases, each device its share in shuffled chunks of `lanes`, each
    started from the solved cases; return outputs and the solved cases at the end."""
    arrays, static = eqx.partition((element, task), eqx.is_array)

    def share(arrays, given, known, near):
        element, task = eqx.combine(arrays, static)
        n = given[0].count
        order = np.random.default_rng(0).permutation(n)

        def chunk(known, given):
            cases, other = given
            start = starts(known, cases, other, alike)
            start = jnp.where(near, start, jnp.nan)
            solve = functools.partial(task.solve, element)
            solutions = jax.vmap(solve)(cases, start)
            known, unsound = add_solved(known, solutions, cases, other, alike)
            lost = unsound & jnp.isfinite(start[:, 0])
            return known, jax.vmap(task.outputs)(solutions, cases) | {_LOST: lost}

        def cut_lanes(a):
            return a[order].reshape(n // lanes, lanes, *a.shape[1:])

        known, out = lax.scan(chunk, known, jax.tree.map(cut_lanes, given))
        back = np.argsort(order)
        return jax.tree.map(lambda a: a.reshape(n, *a.shape[2:])[back], out), known

    spread = jax.shard_map(
        share,
        mesh=mesh,
        in_specs=(Spec(), Spec("case"), Spec("case"), Spec()),
        out_specs=Spec("case"),
        check_vma=False,
    )
    return spread(arrays, given, known, near)


def _pad_chunk(array, size):
    missing = size - array.shape[0]
    if missing == 0:
        return array
    # A case of NaN ends at once.
    fill = np.repeat(array[-1:], missing, axis=0)
    fill = np.full_like(fill, np.nan) if array.dtype.kind == "f" else fill
    return np.concatenate([array, fill])


def _spread_over_devices(array, sharding):
    return jax.make_array_from_callback(array.shape, sharding, lambda i: array[i])


def _copy_to_host(array):
    """Copy a global array to this host."""
    if array.is_fully_addressable:
        return np.asarray(array)
    return np.asarray(multihost_utils.process_allgather(array, tiled=True))


def _wait_for(values):
    """Wait until arrays are computed; unlike NumPy, handle signals meanwhile."""
    while not all(value.is_ready() for value in values.values()):
        time.sleep(_PAUSE)


def not_run(name: str, dtype: np.dtype) -> int | float:
    """Return the value of an output for a case that was not run."""
    if name == "result":
        return Result.NOT_RUN
    return np.nan if dtype.kind == "f" else 0


def _check_size(out, n):
    """Raise if the outputs of all cases take too much memory."""
    needed = sum(v.dtype.itemsize * math.prod((n, *v.shape[1:])) for v in out.values())
    if needed > LARGEST_OUTPUTS:
        raise ValueError(
            f"sweep: the outputs of {n} cases take {needed / 2**30:.3g} GiB, more than"
            f" {LARGEST_OUTPUTS / 2**30:g}; name those that you need in `outputs`, or"
            " use fewer `points`."
        )


def _progress_bar(total):
    """Return a bar of progress in cases; it is not shown if `total` is `None`."""
    from tqdm import tqdm

    return tqdm(total=total, unit="case", unit_scale=True, disable=total is None)

"""Load sweeps: many cases of a bearing, or of many designs, in blocks and chunks.

A chunk of some tens of cases is solved as one batch, small enough for the cache; chunk
follows chunk on each device; blocks of chunks go over all devices and come back to the
host, so that memory stays bounded however long the sweep is. JAX does the distribution,
over the devices of one process or of many (`jax.distributed`).
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.experimental import multihost_utils
from jax.sharding import Mesh, NamedSharding
from jax.sharding import PartitionSpec as Spec
from jaxtyping import Array, Bool, Float

from ..design import rows_of
from ..element.bearing_element import BearingElement
from ..element.frame import RINGS
from ..numerics.result import Result
from .cases import Cases, solve_case
from .solution import Solution

CHUNK = 64
"""Cases of a batch: what fits the cache (benchmarks/batch_throughput.py)."""

BLOCK = 64
"""Chunks of a device between two visits of the host."""

LARGEST = 4 * 2**30
"""Bytes that the outputs of a sweep may take."""

SUMMARIES: dict[str, Callable[[Solution], Array]] = {
    "peak_pressure": lambda s: jnp.max(s.contact_pressure),
    "largest_load": lambda s: jnp.max(s.roller_load),
    "n_loaded": lambda s: jnp.sum(s.load_zone),
    "iterations": lambda s: s.stats.iterations,
    "residual": lambda s: s.stats.residual,
}
"""Outputs beside the fields of a Solution: largest contact pressure [Pa], largest load
of a rolling element [N], number of loaded elements, steps of the load solve, residual.
"""

ALWAYS = ("result", "unrestrained")


class Sweep(eqx.Module):
    """Solved cases: every output with a leading axis (case,), as NumPy arrays.

    An output is an attribute (`sweep.displacement`); units and other axes are those of
    `Solution`. Where `result` is not `CONVERGED`, floating outputs are NaN.

    Attributes:
        cases: What was asked.
        outputs: By name, leading axis case.
        moving_ring: "outer" or "inner".
    """

    cases: Cases
    outputs: dict[str, np.ndarray]
    moving_ring: str = eqx.field(static=True)

    def __getattr__(self, name: str) -> Any:
        outputs = self.__dict__.get("outputs", {})
        if name in outputs:
            return outputs[name]
        raise AttributeError(
            f"Sweep has no output {name!r}; it has {', '.join(outputs)}"
        )

    @property
    def converged(self) -> Bool[np.ndarray, " case"]:
        """Which cases were solved."""
        return np.asarray(self.outputs["result"]) == Result.CONVERGED

    def counts(self) -> dict[str, int]:
        """How many cases ended with each result code, by its label."""
        codes, counts = np.unique(self.outputs["result"], return_counts=True)
        pairs = zip(codes, counts, strict=True)
        return {Result(int(code)).label: int(count) for code, count in pairs}


def stack_designs(elements: Sequence[BearingElement[Any]]) -> BearingElement[Any]:
    """Designs of one structure as one element whose numbers have a leading axis.

    Args:
        elements: Of the same classes, counts and parts.

    Raises:
        ValueError: If there are none, or their structures differ.
    """
    if not elements:
        raise ValueError("stack_designs: `elements` is empty; one design at least.")
    structures = [jax.tree.structure(element) for element in elements]
    shapes = [[np.shape(leaf) for leaf in jax.tree.leaves(e)] for e in elements]
    for k in range(1, len(elements)):
        if structures[k] != structures[0] or shapes[k] != shapes[0]:
            raise ValueError(
                f"stack_designs: design {k} is of another structure than design 0;"
                " classes, numbers of rolling elements and parts must be the same."
            )
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *elements)


def n_designs(element: BearingElement[Any]) -> int | None:
    """Number of designs that an element holds (`stack_designs`), or `None`: one."""
    shape = np.shape(rows_of(element.bearing)[0].bearing.pitch_diameter)
    return shape[0] if shape else None


def sweep(
    element: BearingElement[Any],
    cases: Cases | Float[Array | np.ndarray, "case 6"],
    *,
    outputs: Sequence[str] | Callable[[Solution], dict[str, Array]] | None = None,
    free: Sequence[str] | None = None,
    fixed_ring: str = "outer",
    points: int = 101,
    tolerance: float | None = None,
    max_steps: int = 200,
    neighbours: bool = False,
    chunk: int | None = None,
    progress: bool = False,
    devices: Sequence[Any] | None = None,
) -> Sweep:
    """Solve many cases. One bad case never spoils another: each has its own code.

    Args:
        element: The bearing; or many designs in one (`stack_designs`, or made under
            `jax.vmap`): then case k is of design k, or of `cases.design[k]`.
        cases: `Cases`, or loads (case, 6) [N, N m].
        outputs: Fields of `Solution` and names of `SUMMARIES` to be kept, or a
            function of one Solution; what is not kept is not computed. `None`: all
            fields of `Solution`.
        free, fixed_ring, points, tolerance, max_steps: As in `solve_load`.
        neighbours: Cases that follow each other are alike, as on a fine grid: each
            then starts from the solution before it. A case that ends at the step limit
            so is solved again from the beginning.
        chunk: Cases solved as one batch; default `CHUNK`.
        progress: Show a bar.
        devices: Over which the cases are spread; default all of `jax.devices()`, of
            all processes. (`jax.config.update("jax_num_cpu_devices", 2)` before all
            else makes two of a processor with two cores.)

    Returns:
        Sweep, whole in every process.

    Raises:
        ValueError: For unknown names, designs that do not fit the cases, outputs that
            would not fit memory, and as `solve_load`.

    Fails: as `solve_load`, in `Sweep.result`, case by case.
    """
    every = cases if isinstance(cases, Cases) else Cases(cases)
    if fixed_ring not in RINGS:
        raise ValueError(
            f"sweep: `fixed_ring` is {fixed_ring!r}; it must be 'outer' or 'inner'."
        )
    every = _with_designs(element, every)
    size = CHUNK if chunk is None else chunk
    if not isinstance(size, int) or size < 1:
        raise ValueError(f"sweep: `chunk` is {chunk!r}; a whole number of at least 1.")
    keep = outputs if callable(outputs) else Keep(_checked(outputs))
    free = None if free is None else tuple(free)
    options = _Options(free, fixed_ring, points, tolerance, keep)
    places = np.array(jax.devices() if devices is None else list(devices))
    program = _Program(element, options, size, places)
    found = program.run(every, max_steps, neighbours, progress)
    if neighbours:
        codes = found["result"]
        lost = np.flatnonzero((codes == Result.STEP_LIMIT) | (codes == Result.SADDLE))
        if lost.size:
            again = jax.tree.map(lambda a: np.asarray(a)[lost], every)
            anew = program.run(again, max_steps, False, False)
            for name, values in found.items():
                values[lost] = anew[name]
    return Sweep(every, found, RINGS[1 - RINGS.index(fixed_ring)])


class Keep(eqx.Module):
    """What is kept of a Solution, by name; `None`: all its arrays."""

    names: tuple[str, ...] | None = eqx.field(static=True)

    def __call__(self, solution: Solution) -> dict[str, Array]:
        names = list(self.names or ())
        if self.names is None:
            fields = vars(solution).items()
            names = [name for name, value in fields if eqx.is_array(value)]
            names += ["iterations", "residual"]
        return {name: _output(solution, name) for name in names}


def _output(solution, name) -> Any:
    if name in SUMMARIES:
        return SUMMARIES[name](solution)
    value = getattr(solution, name, None)
    if not eqx.is_array(value):
        fields = [n for n, v in vars(solution).items() if eqx.is_array(v)]
        raise ValueError(
            f"sweep: `outputs` names {name!r}; there are"
            f" {', '.join([*fields, *SUMMARIES])}."
        )
    return value


def _checked(outputs):
    if outputs is None:
        return None
    if isinstance(outputs, str) or not all(isinstance(n, str) for n in outputs):
        raise ValueError(
            f"sweep: `outputs` is {outputs!r}; it must be a list of names."
        )
    return tuple(dict.fromkeys(outputs))


def _with_designs(element, cases):
    designs = n_designs(element)
    if designs is None:
        if cases.design is None:
            return cases
        raise ValueError("sweep: cases choose among designs, but `element` is one.")
    if cases.design is None:
        if designs != cases.count:
            raise ValueError(
                f"sweep: {designs} designs for {cases.count} cases; there must be as"
                " many, or `Cases(design=...)` says which case has which."
            )
        every = np.arange(designs)
        return eqx.tree_at(lambda c: c.design, cases, every, is_leaf=_is_none)
    index = np.asarray(cases.design)
    if index.min() < 0 or index.max() >= designs:
        raise ValueError(
            f"sweep: `design` runs from {index.min()} to {index.max()}; there are"
            f" designs 0 to {designs - 1}."
        )
    return cases


def _is_none(x):
    return x is None


class _Options(eqx.Module):
    """What is the same for all cases. Static."""

    free: tuple[str, ...] | None = eqx.field(static=True)
    fixed_ring: str = eqx.field(static=True)
    points: int = eqx.field(static=True)
    tolerance: float | None = eqx.field(static=True)
    keep: Any = eqx.field(static=True)

    def solve(self, element, case, max_steps, start=None):
        if case.design is not None:
            element = jax.tree.map(lambda leaf: leaf[case.design], element)
        return solve_case(
            element,
            case,
            free=self.free,
            fixed_ring=self.fixed_ring,
            points=self.points,
            tolerance=self.tolerance,
            max_steps=max_steps,
            start=start,
        )

    def outputs(self, solution):
        solved = solution.converged

        def told(value):
            if jnp.issubdtype(value.dtype, jnp.floating):
                return jnp.where(solved, value, jnp.nan)
            return value

        kept = jax.tree.map(told, self.keep(solution))
        return {**kept, **{name: getattr(solution, name) for name in ALWAYS}}


class _Program:
    """Blocks of cases over devices.

    Args:
        element: The bearing or designs.
        options: What is the same for all cases.
        chunk: Cases of a batch.
        devices: Where to.
    """

    def __init__(self, element, options, chunk, devices):
        self.element, self.options, self.chunk = element, options, chunk
        self.mesh = Mesh(devices, ("case",))

    def run(self, cases, max_steps, neighbours, progress):
        """All outputs of all cases, NumPy arrays by name."""
        n = cases.count
        lanes = self.mesh.size * min(self.chunk, math.ceil(n / self.mesh.size))
        block = lanes * min(BLOCK, math.ceil(n / lanes))
        shard = NamedSharding(self.mesh, Spec("case"))
        held = jax.tree.map(np.asarray, cases)
        found: dict[str, np.ndarray] = {}
        pending = None
        with _bar(n if progress else None) as advance:
            for begin in [*range(0, n, block), None]:
                if begin is not None:
                    end = min(begin + block, n)
                    part = jax.tree.map(lambda a: _padded(a[begin:end], block), held)  # noqa: B023
                    given = jax.tree.map(lambda a: _spread(a, shard), part)
                    given = (
                        self.element,
                        given,
                        jnp.asarray(max_steps),
                        self.options,
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
                    for name, value in values.items():
                        found[name][first:last] = _whole(value)[: last - first]
                    advance(last - first)
                pending = submitted
        return found


@eqx.filter_jit
def _solve_block(element, cases, max_steps, options, lanes, neighbours, mesh):
    """A block of cases, each device its share in chunks of `lanes`."""
    arrays, static = eqx.partition((element, max_steps), eqx.is_array)

    def share(arrays, cases):
        element, max_steps = eqx.combine(arrays, static)

        def one(case, start=None):
            return options.solve(element, case, max_steps, start)

        if neighbours:
            return _in_turn(one, options, cases, lanes)
        return lax.map(lambda c: options.outputs(one(c)), cases, batch_size=lanes)

    spread = jax.shard_map(
        share,
        mesh=mesh,
        in_specs=(Spec(), Spec("case")),
        out_specs=Spec("case"),
        check_vma=False,
    )
    return spread(arrays, cases)


def _in_turn(one, options, cases, lanes):
    """Each lane takes a run of cases, each case from the solution before it."""
    moving = slice(6, 12) if options.fixed_ring == "outer" else slice(0, 6)
    # (lane, turn) -> turn first, for the scan.
    runs = jax.tree.map(
        lambda a: jnp.swapaxes(a.reshape(lanes, -1, *a.shape[1:]), 0, 1), cases
    )

    def lane(start, case):
        solution = one(case, start)
        there = jnp.where(solution.converged, solution.displacement[moving], jnp.nan)
        return there, options.outputs(solution)

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

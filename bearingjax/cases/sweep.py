"""Load sweeps: many cases of a bearing, or of many designs, in blocks and chunks.

A chunk of some tens of cases is solved as one batch, small enough for the processor's
cache. Each device solves one chunk after another. Results come back to the host after
each block of chunks, so that memory stays bounded however long the sweep is. JAX
distributes the chunks over the devices of one process or of many (`jax.distributed`).
"""

import functools
from collections.abc import Callable, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..design import AbstractBearing, BearingSet, rows_of
from ..design.bearing_set import bearings_of
from ..design.checks import is_traced, must_be, of_class
from ..design.places import has_empty_places, with_places
from ..element.bearing_element import BearingElement, check_element
from ..life.life import LIFE_OUTPUTS, LifeConditions
from ..life.life_warning import ALL
from ..life.rating import check_alike
from ..numerics.labels import make_dataset
from ..numerics.result import Result
from ..numerics.shown import Printable
from ..numerics.types import with_fields
from ..numerics.warning import Warning, exceeded_kinds, warnings_of_cases
from ..statics import Solution, SolveOptions, Support
from ..statics.empty_places import blank_empty_places
from ..statics.support import RESTRAINED, check_held
from .batches import Batches
from .cases import Cases
from .names_of_zeros import structural_zeros
from .output_labels import FIELD_OF_LARGEST, label_cases, label_output
from .sweep_program import Program, Task, named_sizes


def _largest_value(field: str, solution: Solution) -> Array:
    return jnp.max(getattr(solution, field))


SUMMARIES: dict[str, Callable[[Solution], Array]] = {
    name: functools.partial(_largest_value, field)
    for name, field in FIELD_OF_LARGEST.items()
} | {
    "n_loaded": lambda s: jnp.sum(s.load_zone),
    "iterations": lambda s: s.stats.iterations,
    "residual": lambda s: s.stats.residual,
}
"""Outputs other than fields of a Solution: the largest numbers of fields that state a
name for it (`FIELD_OF_LARGEST`: the largest load of a rolling element, the largest
contact pressure), number of loaded elements, steps of the load solve, residual."""


class Sweep(Printable):
    """Solved cases: every output with a leading axis (case,), as NumPy arrays.

    An output is an attribute (`sweep.displacement`); units and other axes are those of
    `Solution`. Where `result` is not `CONVERGED`, floating outputs are NaN.

    Attributes:
        cases: The cases that were solved.
        outputs: By name, leading axis case; among them `warning_KIND`, the size of
            every kind of warning that can arise
            (`statics.warning_kinds.SOLUTION_KINDS`, and with conditions of a life
            `life.life_warning.LIFE_KINDS`).
        moving_ring: "outer" or "inner".
        zeros: (output, names along its last axes whose numbers are zero whatever the
            case), each; a table leaves them out.
    """

    cases: Cases
    outputs: dict[str, np.ndarray]
    moving_ring: str = eqx.field(static=True)
    zeros: tuple[tuple[str, tuple[str, ...]], ...] = eqx.field(static=True, default=())

    label_entry = staticmethod(label_output)

    def __getattr__(self, name: str) -> Any:
        outputs = self.__dict__.get("outputs", {})
        if name in outputs:
            return outputs[name]
        raise AttributeError(
            f"Sweep has no output {name!r}; it has {', '.join(outputs)}"
        )

    @property
    def converged(self) -> Bool[np.ndarray, " case"]:
        """Whether each case was solved."""
        return np.asarray(self.outputs["result"]) == Result.CONVERGED

    def counts(self) -> dict[str, int]:
        """Number of cases with each result code, by label."""
        codes, counts = np.unique(self.outputs["result"], return_counts=True)
        pairs = zip(codes, counts, strict=True)
        return {Result(int(code)).label: int(count) for code, count in pairs}

    @property
    def warning_sizes(self) -> dict[str, np.ndarray]:
        """Size of every kind of warning, by its name (case,)."""
        return named_sizes(self.outputs)

    @property
    def warnings(self) -> list[Warning]:
        """A warning of each kind: in how many cases, and the worst."""
        return warnings_of_cases(self.warning_sizes, ALL)

    def warning_counts(self) -> dict[str, int]:
        """Number of cases with each kind of warning; kinds without cases left out."""
        return {
            name: int(cases.sum())
            for name, cases in exceeded_kinds(self.warning_sizes, ALL).items()
        }

    def to_xarray(self) -> Any:
        """Return outputs and cases with names and units, as an `xarray.Dataset`.

        Raises:
            ImportError: Without xarray.
        """
        found = {name: label_output(name, v) for name, v in self.outputs.items()}
        return make_dataset({**label_cases(self.cases), **found})


def stack_designs(elements: Sequence[BearingElement[Any]]) -> BearingElement[Any]:
    """Designs of one structure as one element whose numbers have a leading axis.

    Their numbers of rolling elements may differ. All have as many places then, and the
    results of an empty place are NaN.

    Args:
        elements: Elements of the same classes and parts.

    Raises:
        TypeError: If one is no BearingElement.
        ValueError: If there are none, or their structures differ.
    """
    if isinstance(elements, BearingElement | AbstractBearing | BearingSet):
        raise TypeError("stack_designs: `elements` is one; it must be a list of them.")
    for element in elements:
        check_element("stack_designs", element)
    if not elements:
        raise ValueError("stack_designs: `elements` is empty; one design at least.")
    elements = _with_common_places(elements)
    first = structure_of(elements[0])
    for k, element in enumerate(elements):
        if structure_of(element) != first:
            raise ValueError(
                f"stack_designs: design {k} is of another structure than design 0;"
                " classes, numbers of rows and parts must be the same."
            )
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *elements)


def structure_of(design: Any) -> tuple[Any, ...]:
    """Return what designs have in common that are stacked: parts and shapes."""
    leaves, structure = jax.tree.flatten(design)
    return structure, tuple(map(np.shape, leaves))


def _with_common_places(elements):
    """Elements with empty places, if their numbers of rolling elements differ."""
    counts = [[row.n_places for row in bearings_of(e.bearing)] for e in elements]
    padded = any(has_empty_places(element.bearing) for element in elements)
    if not padded and all(count == counts[0] for count in counts):
        return elements
    most = max(map(max, counts))
    return [with_fields(e, bearing=with_places(e.bearing, most)) for e in elements]


def n_designs(element: BearingElement[Any]) -> int | None:
    """Number of designs stacked in an element (`stack_designs`); `None`: only one."""
    shape = np.shape(rows_of(element.bearing)[0].bearing.pitch_diameter)
    return shape[0] if shape else None


def sweep(
    element: BearingElement[Any],
    cases: Cases | Float[Array | np.ndarray, "case 6"],
    *,
    outputs: Sequence[str] | Callable[[Solution], dict[str, Array]] | None = None,
    support: Support = RESTRAINED,
    options: SolveOptions | None = None,
    life: LifeConditions | None = None,
    warn: bool = True,
    batches: Batches | None = None,
) -> Sweep:
    """Solve many cases. One bad case never spoils another: each has its own code.

    Args:
        element: The bearing; or many designs in one (`stack_designs`, or made under
            `jax.vmap`): then case k is of design k, or of `cases.design[k]`.
        cases: `Cases`, or loads (case, 6) [N, N m].
        outputs: Fields of `Solution` and names of `SUMMARIES` and `LIFE_OUTPUTS` to be
            kept, or a function of one Solution; what is not kept is not computed.
            `None`: all fields of `Solution`.
        support, options: As in `solve_load`; displacements are those of the cases.
        life: Conditions of rating lives among `outputs`, and of warnings about lives
            even if none is kept; `None`: lives are not looked at, or if `outputs` name
            one `LifeConditions()`.
        warn: Look for warnings (`bj.warnings`) in every case.
        batches: How the cases are worked off: sizes of batches, devices, starts, a bar
            of progress, an early end. `None`: `Batches()`.

    Returns:
        Sweep with all cases, in every process.

    Raises:
        TypeError: For anything but an element; under `jit`, `grad` or `vmap`.
        ValueError: For unknown names, loads on held freedoms, designs that do not fit
            the cases, outputs that would not fit memory, and as `solve_load`.

    Fails: as `solve_load`, in `Sweep.result`, case by case; `NOT_RUN` after `stop`.
    """
    check_element("sweep", element)
    if any(is_traced(leaf) for leaf in jax.tree.leaves((element, cases, life))):
        raise TypeError(
            "sweep: the design or the cases are traced (jit, grad, vmap); a sweep runs"
            " programs of its own. Map `solve_load(..., throw=False)` over them with"
            " jax.vmap instead, or many at a time with jax.lax.map."
        )
    every = cases if isinstance(cases, Cases) else Cases(cases)
    options = SolveOptions() if options is None else options
    batches = Batches() if batches is None else batches
    every = _with_designs(element, every)
    support.check_for_cases("sweep")
    check_held("sweep", every.load, support, every.prescribed)
    of_class("sweep", "life", life, LifeConditions | None, "LifeConditions")
    keep, lives = _output_function(outputs)
    life = LifeConditions() if lives and life is None else life
    if life is not None:
        check_alike(element.bearing)
    task = Task(support, options, keep, warn, lives, life)
    places = batches.places()
    program = Program(element, task, batches.size(every.count), places)
    # The looser tolerance of float32 would leave near starts a digit less.
    near = batches.near and jax.config.read("jax_enable_x64")
    found = program.run(every, near, batches.progress, batches.stop)
    zeros = structural_zeros(element, every, support)
    return Sweep(every, found, support.moving_ring, zeros)


class Keep(eqx.Module):
    """Picks outputs of a Solution by name; `None`: all its arrays, steps, residual."""

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
            f" {', '.join([*fields, *SUMMARIES, *LIFE_OUTPUTS])}."
        )
    return blank_empty_places(solution, name, value)


def _output_function(outputs: Any) -> tuple[Any, tuple[str, ...]]:
    """Function for the outputs of a solution, and the names of the life outputs."""
    if callable(outputs):
        return outputs, ()
    names = _check_outputs(outputs)
    if names is None:
        return Keep(None), ()
    of_life = *LIFE_OUTPUTS, "limit_ratio", "raceway_damage"
    lives = tuple(name for name in names if name in of_life)
    return Keep(tuple(name for name in names if name not in lives)), lives


def _check_outputs(outputs):
    if outputs is None:
        return None
    names = not isinstance(outputs, str) and all(isinstance(n, str) for n in outputs)
    must_be("sweep", "outputs", outputs, names, "a list of names")
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

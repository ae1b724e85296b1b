"""Results of cases as a function of the numbers of a design."""

import dataclasses
import functools
import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ..cases.cases import Cases
from ..cases.output_labels import OPERATING_CLEARANCE, OPERATING_PRELOAD, label_output
from ..cases.sweep import SUMMARIES, Keep
from ..cases.sweep_program import Task, named_sizes
from ..design import rows_of
from ..design.bearing_set import bearings_of
from ..design.checks import check_fields
from ..design.places import element_places, with_places
from ..element.bearing_element import BearingElement
from ..files.table import not_among
from ..fits import radial_clearance
from ..friction.friction import friction_torque
from ..life.life import LIFE_OUTPUTS, Life, LifeConditions
from ..life.life_warning import ALL
from ..numerics.compiled.programs import program
from ..numerics.labels import stated_axes
from ..numerics.result import Result
from ..numerics.types import Real, with_fields
from ..numerics.units import real
from ..numerics.warning import Warning, warnings_of_cases
from ..optimise.design_problem import CHUNK
from ..optimise.system import (
    AbstractSystem,
    Design,
    Reading,
    describe_failure,
    has_loads,
    loads_of,
    prepare,
    solved_case,
)
from ..optimise.variable import with_numbers
from ..statics import Installed, SolveOptions, Support
from ..statics.preload import remaining_preload
from ..statics.solution import solution_kind
from ..statics.warning import solution_warnings

_FRICTION = "friction_torque"
_STATES = (OPERATING_CLEARANCE, OPERATING_PRELOAD, _FRICTION)
_COUNTED = ("element", "row")
"""Axes whose length depends on the bearing."""


class Oiled(Installed):
    """An installed bearing with an oil whose viscosity may be an unknown.

    Attributes:
        viscosity: Kinematic viscosity, used in place of that of the life [m²/s].
    """

    viscosity: Real = eqx.field(**real("m²/s", above=0), kw_only=True)

    def __check_init__(self):
        check_fields(self)


class CaseModel(eqx.Module):
    """Results of solved cases, as a function of numbers of the design.

    A result is named as its column in the table of a sweep, without the unit:
    "displacement_inner_uz", "peak_pressure", "life_hours"; for the moving ring
    "displacement_uz" and "stiffness_uz" suffice. "friction_torque" [N m] by Palmgren
    needs a life with a viscosity, and a speed. Results of a failed case are NaN.

    The results of a system (`optimise.AbstractSystem`) are its `readings`.

    Attributes:
        design: The bearing, as drawn (`BearingElement`) or `Installed`; or a system.
        support: Support of the rings; prescribed displacements are those of the cases.
        options: Numerics of the load solves.
        life: Conditions of the rating life, where lives are among the results.
        supply: Oil supply, as `friction_torque` takes it.
        varied: Numbers of the design that differ from case to case, by their dotted
            path (case,) [SI].
        paths: Dotted paths that each argument sets, a sequence for each argument.
        places: Results that are returned, by name.

    Traced: all numbers. Static: supply, paths, places.

    Raises:
        TypeError: If the design is of another class.
    """

    design: Any
    support: Support = Support()
    options: SolveOptions = eqx.field(default_factory=SolveOptions)
    life: LifeConditions | None = None
    supply: str = eqx.field(static=True, default="oil_bath")
    varied: dict[str, Any] = eqx.field(default_factory=dict)
    paths: tuple[tuple[str, ...], ...] = eqx.field(static=True, default=())
    places: tuple[tuple[str, Reading], ...] = eqx.field(static=True, default=())

    def __check_init__(self):
        if not isinstance(self.design, BearingElement | Installed | AbstractSystem):
            raise TypeError(
                f"CaseModel: `design` is {type(self.design).__name__}; it must be a"
                " BearingElement, Installed or a system of `bearingjax.optimise`; of"
                " anything else give a function (values, cases) -> numbers by name."
            )

    def place(self, name: str) -> Reading:
        """Return output, entry and unit of the result of a name.

        Raises:
            ValueError: If no result has this name.
        """
        if isinstance(self.design, AbstractSystem):
            known = self.design.readings()
        elif name == _FRICTION:
            if self.life is None or self.life.viscosity is None:
                raise ValueError(f"{name} needs an oil: a `life` with a viscosity")
            return Reading(name, 0, "N m")
        else:
            known = dict(self._names_with_places(name))
        if name not in known:
            raise ValueError(not_among(name, [*known] or [n for n, _ in self._axes()]))
        return known[name]

    def for_numbers(
        self, paths: Sequence[Sequence[str]], names: Sequence[str]
    ) -> "CaseModel":
        """Return the model with its arguments and results chosen.

        Rows get empty places (`PLACES`), so that bearings of a kind share one program.

        Args:
            paths: Dotted paths in the design that each argument sets.
            names: Names of the results.

        Raises:
            ValueError: As `place`.
        """
        found = tuple((name, self.place(name)) for name in names)
        more = {"paths": tuple(map(tuple, paths)), "places": found}
        return dataclasses.replace(self, design=_with_places(self.design), **more)

    def __call__(
        self, values: Float[Array, " number"], cases: Any
    ) -> dict[str, Float[Array, " case"]]:
        """Return results by name (case,) [SI], at numbers of the design [SI]."""
        return self._in_cases(self._numbers, values, cases)

    def warnings(self, values: Any, cases: Any) -> list[Warning]:
        """Return warnings about solved cases, each kind once, as `sweep` has them.

        Args:
            values: Numbers of the design, concrete (number,) [SI].
            cases: The cases.
        """
        if isinstance(self.design, AbstractSystem):
            first = {path: np.asarray(x)[0] for path, x in self.varied.items()}
            system: Any = self.design_at(np.asarray(values), first)

            @functools.cache
            def solved():
                if system.is_solved_by_parts(cases):
                    return system.solve_by_parts(cases, None)[0]
                return jax.device_get(_solve_system(self, jnp.asarray(values), cases))

            found = system.warnings(cases, solved)
            if solved.cache_info().currsize and has_loads(solved()):
                return [*solution_warnings(loads_of(solved())), *found]
            return found
        sizes = jax.device_get(_warning_sizes(self, jnp.asarray(values), cases))
        return warnings_of_cases(sizes, ALL)

    def _in_cases(self, function: Callable, values: Any, cases: Any) -> dict[str, Any]:
        """Return outputs in all cases of a function of design, solution and case."""
        shared = None if self.varied else self.design_at(values, {})

        def outputs(given):
            case, varied = given
            design = self.design_at(values, varied) if shared is None else shared
            solved = solved_case(design, case, self.support, self.options)
            return function(design, solved, case)

        given = cases, {path: jnp.asarray(x) for path, x in self.varied.items()}
        if cases.count <= CHUNK:
            return jax.vmap(outputs)(given)
        return lax.map(outputs, given, batch_size=CHUNK)

    def why_failed(self, values: Any, cases: Cases, case: int) -> str:
        """Return in words why a case fails at concrete numbers of the design."""
        one, varied = jax.tree.map(lambda leaf: leaf[case], (cases, self.varied))
        design = self.design_at(np.asarray(values), varied)
        solved = solved_case(design, one, self.support, self.options)
        label = Result(int(solved.result)).label
        return f"case {case}: {label}: {describe_failure(design, solved)}"

    def design_at(self, values: Any, varied: dict[str, Any]) -> Design:
        """Return the design at values of its paths, and of one case by path [SI]."""
        pairs = zip(self.paths, values, strict=True)
        numbers = {path: x for several, x in pairs for path in several}
        return prepare(with_numbers(self.design, numbers | varied), None)

    def _numbers(self, design: Design, solution: Any, case: Any) -> dict[str, Array]:
        if isinstance(design, AbstractSystem):
            kept = {at.output: getattr(solution, at.output) for _, at in self.places}
            return self._entries(kept, solution.result == Result.CONVERGED)
        wanted = dict.fromkeys(place.output for _, place in self.places)
        lives = tuple(name for name in wanted if name in LIFE_OUTPUTS)
        life = self._life(design) or LifeConditions()
        keep = Keep(tuple(name for name in wanted if name not in (*lives, *_STATES)))
        task = Task(
            self.support, self.options, keep, False, lives, life if lives else None
        )
        kept = task.outputs(solution, case)
        if OPERATING_CLEARANCE in wanted:
            row = rows_of(solution.element.bearing)[0].bearing
            kept[OPERATING_CLEARANCE] = radial_clearance(row)
        if OPERATING_PRELOAD in wanted:
            given = solution.element, solution.speed
            kept[OPERATING_PRELOAD] = remaining_preload(*given, throw=False)
        if _FRICTION in wanted:
            oil: Any = life.viscosity if case.viscosity is None else case.viscosity
            kept[_FRICTION] = friction_torque(solution, oil, self.supply).torque
        real = solution.displacement.dtype
        numbers = {name: kept[name].astype(real) for name in wanted}
        return self._entries(numbers, solution.converged)

    def _life(self, design: Design) -> LifeConditions | None:
        if self.life is None or not isinstance(design, Oiled):
            return self.life
        return with_fields(self.life, viscosity=design.viscosity)

    def _entries(self, kept: dict[str, Array], solved: Any) -> dict[str, Array]:
        return {
            name: jnp.where(solved, jnp.ravel(kept[at.output])[at.entry], jnp.nan)
            for name, at in self.places
        }

    def _axes(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield outputs of a case with their axes, except those along a roller."""
        for kind in (solution_kind(_drawing(self.design).choices), Life):
            for field in dataclasses.fields(kind):
                axes = stated_axes(field.type)
                known = kind is not Life or field.name in LIFE_OUTPUTS
                if known and "unit" in field.metadata and axes is not None:
                    if all(a in _COUNTED or "=" in a for a in axes):
                        yield field.name, axes
        yield from dict.fromkeys((*SUMMARIES, *_STATES), ()).items()

    def _names_with_places(self, name: str) -> Iterator[tuple[str, Reading]]:
        """Yield name and place of the results of each output that begins a name."""
        rows = bearings_of(_drawing(self.design).bearing)
        places, counts = (
            sum(r.n_places for r in rows),
            [int(r.n_elements) for r in rows],
        )
        sizes = {"element": places, "row": len(rows)}
        there = np.arange(places)  # empty places may follow the elements of a row
        if sum(counts) < places:
            there = element_places(tuple(counts))[0]
        own = f"{self.support.moving_ring}_"
        for output, axes in self._axes():
            if name != output and not name.startswith(f"{output}_"):
                continue
            shape = [sizes.get(a) or int(a.rpartition("=")[2]) for a in axes]
            entries = np.arange(math.prod(shape)).reshape(1, *shape)
            entries = entries[:, there] if axes[:1] == ("element",) else entries
            for header, labels, column in label_output(output, entries).columns(output):
                title, _, unit = header.removesuffix("]").partition(" [")
                place = Reading(output, int(column[0]), unit)
                yield title, place
                if labels and all(label.startswith(own) for label in labels):
                    short = [label.removeprefix(own) for label in labels]
                    short = short[:1] if len(set(short)) == 1 else short
                    yield "_".join([output, *short]), place


@program(quick=True, level=1, what="cases of the system")
def _solve_system(model, values, cases):
    return model._in_cases(lambda design, solved, case: solved, values, cases)


@program(quick=True, level=1, what="warnings of the cases")
def _warning_sizes(model, values, cases):
    """Return the size of every kind of warning by name (case,)."""

    def sizes(design, solution, case):
        life, given = model._life(design), (model.support, model.options)
        return Task(*given, Keep(()), True, (), life).outputs(solution, case)

    return named_sizes(model._in_cases(sizes, values, cases))


def _drawing(design: Any) -> BearingElement[Any]:
    return design.drawing if isinstance(design, Installed) else design


def _with_places(design: Any) -> Any:
    if isinstance(design, AbstractSystem):
        return design
    if isinstance(design, Installed):
        return with_fields(design, drawing=_with_places(design.drawing))
    return with_fields(design, bearing=with_places(design.bearing))

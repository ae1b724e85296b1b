"""Solution of a bearing: displacement, force, stiffness, loads, pressures, code."""

import dataclasses
import functools
from collections.abc import Iterator
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from ..design import AbstractBearing, BearingSet
from ..design.bearing_set import bearings_of
from ..element.bearing_element import BearingElement
from ..element.bearing_model import BearingModel, BearingResponse, SolvedElements
from ..element.choices import BallChoices, RollerChoices
from ..element.frame import (
    FREEDOMS,
    LOAD_UNITS,
    LOADS,
    MOTION_UNITS,
    RINGS,
    STIFFNESS_UNITS,
)
from ..element.inertia import Speed
from ..element.solved_row import RowResults
from ..numerics import Result, TrustRegionNewton
from ..numerics.labels import axes_of, to_xarray
from ..numerics.shown import Fact, Printable, facts_of, has_numbers, numbers_text
from ..numerics.types import Number, Ring, Scalar, in_numpy
from ..numerics.units import unit
from .balls import BallResults, above_round_off, ball_results
from .rollers import RollerResults, roller_results

LARGEST_PRESSURE = 4e9
"""Contact pressure above which steel is no longer elastic [Pa]."""

_BALANCED, _ROUND_OFF = 1e-10, 1e-7
"""Residuals of a load solve, and of its rolling elements, that are out of balance by no
more than what round-off leaves of large loads [1]."""


_FIRST = "result force displacement roller_load roller_pressure".split()
"""Fields of a solution that `print` shows."""


class Stats(eqx.Module):
    """Statistics of a load solve.

    Attributes:
        residual: Force out of balance on the free freedoms relative to the load,
            moments divided by the pitch radius [1].
        iterations: Steps of the load solve.
        roller_residual: Largest relative residual of a rolling element [1].
        roller_iterations: Most steps of a rolling element in the last evaluation.
    """

    residual: Scalar = eqx.field(metadata=unit("1"))
    iterations: Int[Array, ""]
    roller_residual: Scalar = eqx.field(metadata=unit("1"))
    roller_iterations: Int[Array, ""]


class Solution(Printable):
    """A solved bearing. Axes: element counts the rollers or balls, in a set row by row;
    raceway and ring are (outer, inner). Under `jax.vmap` cases come before them.

    If `result` is not `CONVERGED` the numbers are those of the last step, not of an
    equilibrium.

    Attributes:
        displacement: Ring freedoms (12,) [m, rad].
        force: External load that holds the rings (12,) [N, N m].
        stiffness: Tangent stiffness (12, 12) [N/m, N, N m]; not quite symmetric if
            gyroscopic moments act or contact constants follow the operating angle.
        roller_load: Load of each roller or ball on each raceway (element, 2) [N].
        roller_pressure: Largest Hertz pressure of each roller or ball on each raceway
            (element, 2) [Pa]; of a roller also between the positions of the output.
        roller_motion: (u, v, θ) of each roller or ball in its section, at the node on
            the axis (element, 3) [m, m, rad].
        azimuth: Azimuth of each roller or ball [rad].
        result: `Result` code.
        unrestrained: Index of the freedom of the moving ring that no contact holds
            against the load, if the result is `NO_LOAD_PATH`; otherwise -1 (also if
            it is a rolling element that no contact holds).
        stats: Statistics of the load solve.
        spring_travel: Travel of the ring of each row on its seat by its spring,
            closing the row (row,) [m]; zero without a spring, `None` if no row has one.
        spring_force: Force of each row's spring (row,) [N], or `None`.
        row_sizes: Number of rolling elements of each row.
        pitch_radius: Pitch radius of the bearing, the largest of a set [m].
        element: The bearing that was solved.
        speed: Ring speeds, or `None`; balls have kinematics if, and only if, there are
            speeds.
        free: Freedoms of the moving ring that were free.
        held: Freedoms of the moving ring that a support held, at a prescribed
            displacement or at zero; `force` there is the reaction of the support.
        moving_ring: "outer" or "inner".

    Static: row_sizes, free, held, moving_ring.
    """

    displacement: Float[Array, "ring_freedom=12"] = eqx.field(
        metadata=unit(MOTION_UNITS)
    )
    force: Float[Array, "ring_component=12"] = eqx.field(metadata=unit(LOAD_UNITS))
    stiffness: Float[Array, "ring_freedom=12 moved_ring_freedom=12"] = eqx.field(
        metadata=unit(STIFFNESS_UNITS)
    )
    roller_load: Float[Array, "element raceway=2"] = eqx.field(
        metadata=unit("N", column="load", largest="largest_load")
    )
    roller_pressure: Float[Array, "element raceway=2"] = eqx.field(
        metadata=unit("Pa", column="pmax", largest="peak_pressure")
    )
    roller_motion: Float[Array, "element section_freedom=3"] = eqx.field(
        metadata=unit(("m", "m", "rad"))
    )
    azimuth: Float[Array, " element"] = eqx.field(metadata=unit("rad"))
    result: Int[Array, ""]
    unrestrained: Int[Array, ""]
    stats: Stats
    spring_travel: Float[Array, " row"] | None = eqx.field(metadata=unit("m"))
    spring_force: Float[Array, " row"] | None = eqx.field(metadata=unit("N"))
    pitch_radius: Scalar = eqx.field(metadata=unit("m"))
    element: BearingElement
    speed: Speed | None
    row_sizes: tuple[int, ...] = eqx.field(static=True)
    free: tuple[str, ...] = eqx.field(static=True)
    held: tuple[str, ...] = eqx.field(static=True)
    moving_ring: str = eqx.field(static=True)

    def shown_facts(self) -> Iterator[Fact]:
        """Yield what an engineer looks at first, and the names of the other fields."""
        facts = list(facts_of(self, _FIRST))
        known = all(map(has_numbers, (self.result, self.stiffness, self.roller_load)))
        if known and not np.ndim(self.result):
            facts[0] = (*facts[0][:3], self.failure_message or "of the load solve")
            zone, ring = np.asarray(self.load_zone), RINGS.index(self.moving_ring)
            loaded, of = f"{zone.sum()} of {zone.size}", f"of the {RINGS[ring]} ring"
            own = np.diagonal(self.stiffness).reshape(2, 6)[ring]
            units = np.repeat(["kN/mm", "N m/mrad"], 3)
            text = numbers_text(own * np.repeat([1e-6, 1e-3], 3), units, FREEDOMS)
            facts += [(1, "load_zone", loaded, "rolling elements under load")]
            facts += [(1, "stiffness", text, f"diagonal, {of}")]
        yield from facts
        shown = {name for _, name, *_ in facts}
        others = [f.name for f in dataclasses.fields(self) if f.name not in shown]
        yield 1, "further", "", ", ".join(others)

    @property
    def load_zone(self) -> Bool[Array | np.ndarray, "*case element"]:
        """Whether each element carries load between the raceways, above round-off."""
        return above_round_off(self.roller_load).all(axis=-1)

    @property
    def converged(self) -> Bool[Array | np.ndarray, "*case"] | np.bool_:
        """Whether the result code is `CONVERGED`."""
        return in_numpy(self.result) == Result.CONVERGED

    @property
    def failure_message(self) -> str:
        """Cause and cure of a failed solve of one case, in words; empty if it
        converged.

        Raises:
            ValueError: For a solution of several cases.
        """
        check_single("failure_message", self)
        return _describe_failure(self)

    def to_xarray(self) -> Any:
        """Return all arrays with names and units, as an `xarray.Dataset`.

        Raises:
            ImportError: Without xarray.
        """
        parts = ("kinematics",) if hasattr(self, "kinematics") else ()
        return to_xarray(self, "stats", *parts)


class RollerSolution(Solution, RollerResults):
    """Solution of a roller bearing: that of `Solution`, and `RollerResults`."""


class BallSolution(Solution, BallResults):
    """Solution of a ball bearing: that of `Solution`, and `BallResults`."""


def check_single(owner: str, solution: Solution) -> None:
    """Raise unless a solution is of one case.

    Raises:
        ValueError: For a solution with a leading case axis.
    """
    if jnp.ndim(solution.result):
        raise ValueError(
            f"{owner}: `solution` holds several cases; map over them with jax.vmap."
        )


def no_load_path(solution: Solution, freedom: int) -> str:
    """Cause and cure of a load that nothing holds, in words; also of traced solutions.

    Args:
        solution: Solution.
        freedom: Index of the freedom of the moving ring that it concerns.
    """
    name, load = FREEDOMS[freedom], LOADS[freedom]
    if name in solution.held:
        return (
            f"The load has {load}, but {name} of the {solution.moving_ring} ring is"
            " held (prescribed, or left out of the free ones): its support would take"
            f" that load. Leave out {load}, or free {name}."
        )
    return (
        f"No load path in {name} of the {solution.moving_ring} ring: the bearing does"
        " not hold the load in this direction. Add load or preload that closes it,"
        " turn the load round, or prescribe that freedom."
    )


def _describe_failure(solution: Solution) -> str:
    result = Result(int(solution.result))
    stats = solution.stats
    if result is Result.CONVERGED:
        return ""
    if result is Result.NO_LOAD_PATH:
        if int(solution.unrestrained) < 0:
            return (
                "No load path for a rolling element: it leaves its raceway, because"
                " nothing holds it (a turning roller without a rib, along its axis; a"
                " ball of a thrust bearing, out of its groove; a barrel roller that far"
                " too much load or tilt turns over). Add the rib or axial load, or"
                " lower the speed; check the load and its unit."
            )
        return no_load_path(solution, int(solution.unrestrained))
    if result is Result.NON_FINITE:
        return (
            "Numbers that are not finite or far outside the bearing: check loads,"
            " speeds, prescribed displacements and dimensions for NaN, infinity and"
            " units."
        )
    if result is Result.SADDLE:
        return (
            "The equilibrium of a roller or ball is a saddle, not a minimum (finite"
            " kinematics): use linearised kinematics, or more load or length of"
            " contact."
        )
    residual, local = float(stats.residual), float(stats.roller_residual)
    pressure = float(solution.roller_pressure.max())
    # Of an element of another kind it is not known.
    absurd = not pressure <= LARGEST_PRESSURE
    if residual < _BALANCED and local < _ROUND_OFF and absurd:
        return (
            f"The rolling elements balance to {local:.1e} of their load and no closer,"
            " in round-off: loads so large press steep roller ends or the smallest gaps"
            " beyond what numbers resolve. Check the load and its unit; the contact"
            f" pressure is {1e-9 * pressure:.3g} GPa."
        )
    cure, newton = "check load, clearance, preload and dimensions", TrustRegionNewton
    usual = isinstance(solution.element.equilibrium, newton)
    if residual < _BALANCED:
        more = "raise their step limit (from Python, `max_steps` of `equilibrium`)"
        if not usual:
            more = "use Newton's method for them (`equilibrium`)"
        return (
            f"Step limit of the rolling elements: the rings balance to {residual:.1e}"
            f" of the load, rolling elements only to {local:.1e}: {cure}, or {more}."
        )
    cure += ", or raise the step limit (from Python, `max_steps` of the solve)"
    if not usual:
        cure += ", or use Newton's method for the rolling elements (`equilibrium`)"
    return (
        f"Step limit reached after {int(stats.iterations)} steps, relative residual"
        f" {residual:.1e}, rolling elements {local:.1e}: {cure}."
    )


def describe(
    element: BearingElement,
    model: BearingModel,
    q: Ring,
    points: int,
    solved: SolvedElements,
    rolling: BearingModel | None = None,
    least: Number = 0.0,
    fixed_stiffness: bool = False,
) -> tuple[dict, BearingResponse]:
    """All fields of a `Solution` that follow from the ring freedoms.

    Args:
        element: The bearing.
        model: Its model at the speeds.
        q: Ring freedoms [m, rad].
        points: Positions along a roller.
        solved: Its rolling elements at q.
        rolling: Model of which balls have their kinematics, where they do not feel the
            speed; `None`: the model.
        least: As in `BearingModel.convergence` [N].
        fixed_stiffness: As in `BearingModel.evaluate`. Static.
    """
    rows = model.results(q, solved)
    evaluated = model.evaluate(q, solved, least, fixed_stiffness)
    shown = rows
    if rolling is not None:
        pairs = zip(rows, rolling.rows, strict=True)
        shown = tuple(one.as_rolling(row) for one, row in pairs)
    special = contact_results(element.choices, element.bearing, shown, points)
    if any(row.row.absent is not None for row in rows):
        absent = jnp.concatenate([row.row.absent for row in rows])
        special = _without_absent(solution_kind(element.choices), special, absent)
    return {
        "displacement": q,
        "force": evaluated.force,
        "stiffness": evaluated.stiffness,
        "roller_motion": jnp.concatenate([row.motions() for row in rows]),
        "azimuth": jnp.concatenate([row.azimuth for row in rows]),
        **_springs(rows),
        "row_sizes": tuple(row.azimuth.shape[0] for row in rows),
        **special,
    }, evaluated


def _without_absent(kind: type, fields: dict, absent: Bool[Array, " element"]) -> dict:
    """Fields of a solution in which empty places carry nothing."""
    found = dict(fields)
    for name, values in fields.items():
        axes = axes_of(kind, name) or ("",)
        if values is not None and axes[0] == "element":
            # Shoulders that are not loaded are not reached.
            nothing = jnp.inf if name == "shoulder_margin" else 0.0
            places = absent.reshape(-1, *[1] * (values.ndim - 1))
            found[name] = jnp.where(places, nothing, values)
    return found


@functools.singledispatch
def contact_results(
    choices: Any,
    bearing: AbstractBearing | BearingSet,
    rows: tuple[RowResults, ...],
    points: Any,
) -> dict:
    """Results of the contacts of solved rows; register a new kind of choices here.

    Returns:
        Fields of the kind of `Solution` that `solution_kind` names. Of a kind of
        rolling element that is not registered: the loads of its first two contacts,
        outer and inner raceway, and pressures of NaN, as they are unknown.
    """
    load = jnp.concatenate([row.contact_load[:, :2] for row in rows])
    return {"roller_load": load, "roller_pressure": jnp.full_like(load, jnp.nan)}


@contact_results.register
def _(choices: RollerChoices, bearing, rows, points):
    return roller_results(rows, points)


@contact_results.register
def _(choices: BallChoices, bearing, rows, points):
    designs: Any = list(bearings_of(bearing))
    return ball_results(rows, designs, choices.point_law)


def solution_kind(choices: Any) -> type[Solution]:
    """Kind of `Solution` that has the fields of `contact_results`."""
    kinds = {RollerChoices: RollerSolution, BallChoices: BallSolution}
    found = (kind for of, kind in kinds.items() if isinstance(choices, of))
    return next(found, Solution)


def _springs(rows: tuple[RowResults, ...]) -> dict:
    if all(row.travel is None for row in rows):
        return {"spring_travel": None, "spring_force": None}
    travel, force = [], []
    for result in rows:
        spring = result.row.spring
        if spring is None or result.travel is None:
            travel.append(jnp.zeros_like(result.row.ratio))
            force.append(jnp.zeros_like(result.row.ratio))
        else:
            travel.append(result.travel)
            force.append(spring.push(result.travel)[1])
    return {"spring_travel": jnp.stack(travel), "spring_force": jnp.stack(force)}

"""Measures of a design over its operating cases: one smooth number each.

A measure is any function (element, cases, solution) -> scalar, where the solution has
a leading case axis; those here are Modules. The solution of a system (`system.py`) is
its own, such as a skidding end state; those here use the loads in it. Life
over a load spectrum is one in `life.py`.

Maxima and minima are smooth (`smooth.py`).
"""

import abc
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import rows_of
from ..design.checks import check, number, one_of
from ..element.frame import FREEDOMS, RINGS, STIFFNESS_UNITS
from ..fits import Mounting, radial_clearance
from ..numerics.types import Real, Reals, Scalar
from ..numerics.units import real, unit_of
from ..statics.preload import remaining_preload
from ..statics.solution import RollerSolution, Solution
from .smooth import (
    SMOOTHING_EXPONENT,
    largest,
    smallest,
    smooth_maximum,
    smooth_minimum,
)
from .system import Design, loads_of


class AbstractMeasure(eqx.Module):
    """One number of a design over its cases."""

    @abc.abstractmethod
    def __call__(self, element: Design, cases: Any, solution: Any) -> Scalar:
        """The measure, smooth in the design.

        Args:
            element: The design.
            cases: Its operating cases.
            solution: Solution of the cases, leading axis case.
        """

    def exact_value(self, element: Design, cases: Any, solution: Any) -> Scalar:
        """The measure with the true maximum or minimum in place of the smooth one.

        Args: as `__call__`.
        """
        return self(element, cases, solution)

    @property
    def as_objective(self) -> "AbstractMeasure":
        """Measure to minimise if this is an objective: itself, or one that falls as it
        rises."""
        return self

    @property
    def reported_as(self) -> "AbstractMeasure":
        """Measure that reports show in its place: itself, or a more familiar one."""
        return self

    def reported_value(self, value: Any) -> Any:
        """Convert a value of this measure to that of `reported_as`."""
        return value

    @property
    def maximised(self) -> bool:
        """Whether minimising it maximises `reported_as`."""
        return False

    @property
    def least_size(self) -> float:
        """Smallest scale by which an optimisation divides it as an objective."""
        return 0.0

    @property
    @abc.abstractmethod
    def label(self) -> str:
        """Name in reports."""

    @property
    @abc.abstractmethod
    def unit(self) -> str:
        """SI unit."""


class AbstractSmooth(AbstractMeasure):
    """A measure with a smooth maximum or minimum in it.

    Attributes:
        exponent: Exponent of the smooth maximum or minimum, above 1. With a larger one
            it is closer to the true one, but its derivative changes faster.
    """

    exponent: float = eqx.field(static=True, default=SMOOTHING_EXPONENT, kw_only=True)

    def __check_init__(self):
        number(self, "exponent")
        above = 1.0 < self.exponent <= 1e4
        check(self, "exponent", above, "above 1 and at most 10000")


class AbstractLargest(AbstractSmooth):
    """The largest of many samples."""

    @abc.abstractmethod
    def samples(self, solution: Any) -> Reals:
        """The numbers, at least 0, of which the measure is the largest.

        Args:
            solution: Solutions of the cases, leading axis case.
        """

    def __call__(self, element, cases, solution):
        return smooth_maximum(self.samples(solution), self.exponent)

    def exact_value(self, element: Design, cases: Any, solution: Any) -> Scalar:
        return largest(self.samples(solution))


class PeakPressure(AbstractLargest):
    """Largest contact pressure of all cases, elements, raceways and positions [Pa].

    The smooth maximum is over the largest pressures of all contacts and, of rollers,
    the pressures at the `points` positions of the solution. With few positions it has
    kinks where the place of the largest pressure jumps. Hours do not matter.

    Attributes:
        exponent: Exponent of the smooth maximum. A larger one is closer to the true
            maximum, but its derivative changes faster.

    Static: exponent.
    """

    def samples(self, solution: Any) -> Reals:
        return _pressures(solution)

    @property
    def label(self) -> str:
        return "peak pressure"

    @property
    def unit(self) -> str:
        return unit_of(Solution, "roller_pressure")


class MeanPressure(AbstractSmooth):
    """Mean, over the hours of the cases, of the peak pressure of each case [Pa].

    Without hours all cases count alike.

    Attributes:
        exponent: Exponent of the smooth maximum within a case.

    Static: exponent.
    """

    def __call__(self, element, cases, solution):
        pressure = _pressures(solution)
        peaks = jax.vmap(lambda p: smooth_maximum(p, self.exponent))(pressure)
        return _mean(peaks, cases)

    def exact_value(self, element: Design, cases: Any, solution: Any) -> Scalar:
        return _mean(jax.vmap(largest)(_pressures(solution)), cases)

    @property
    def label(self) -> str:
        return "mean peak pressure"

    @property
    def unit(self) -> str:
        return unit_of(Solution, "roller_pressure")


class EdgeLoad(AbstractLargest):
    """Largest load per length at a roller end, of all cases and raceways [N/m].

    Attributes:
        exponent: Exponent of the smooth maximum.

    Static: exponent.
    """

    def samples(self, solution: Any) -> Reals:
        solution = loads_of(solution)
        if not isinstance(solution, RollerSolution):
            raise ValueError(
                "EdgeLoad: balls have no ends; the bearing must be of rollers."
            )
        return solution.edge_load

    @property
    def label(self) -> str:
        return "edge load"

    @property
    def unit(self) -> str:
        return unit_of(RollerSolution, "edge_load")


class Displacement(AbstractLargest):
    """Largest size of a displacement of the moving ring against the other [m, rad].

    Attributes:
        freedom: One of ux, uy, uz, gx, gy.
        exponent: Exponent of the smooth maximum over the cases.

    Static: all.
    """

    freedom: str = eqx.field(static=True)

    def __check_init__(self):
        _check_freedom(self, self.freedom)

    def samples(self, solution: Any) -> Reals:
        solution = loads_of(solution)
        if self.freedom not in solution.free:
            raise ValueError(
                f"Displacement: `freedom` is {self.freedom!r}, which is not free: no"
                f" design moves it. Free are {', '.join(solution.free) or 'none'}."
            )
        moved = solution.displacement[:, 6:] - solution.displacement[:, :6]
        return jnp.abs(moved[:, FREEDOMS.index(self.freedom)])

    @property
    def label(self) -> str:
        return f"displacement {self.freedom}"

    @property
    def unit(self) -> str:
        return unit_of(Solution, "displacement", (FREEDOMS.index(self.freedom),))


class Stiffness(AbstractSmooth):
    """Smallest stiffness of the moving ring in one freedom, of all cases [N/m, N m].

    The diagonal of the tangent stiffness: the other freedoms are held.

    Attributes:
        freedom: One of ux, uy, uz, gx, gy.
        exponent: Exponent of the smooth minimum over the cases.

    Static: all.
    """

    freedom: str = eqx.field(static=True)

    def __check_init__(self):
        _check_freedom(self, self.freedom)

    def __call__(self, element, cases, solution):
        values = _stiffness(solution, self.freedom, self.freedom)
        return smooth_minimum(values, self.exponent)

    def exact_value(self, element: Design, cases: Any, solution: Any) -> Scalar:
        return smallest(_stiffness(solution, self.freedom, self.freedom))

    @property
    def label(self) -> str:
        return f"stiffness {self.freedom}"

    @property
    def unit(self) -> str:
        return unit_of(Solution, "stiffness", 2 * (FREEDOMS.index(self.freedom),))


class OperatingClearance(AbstractMeasure):
    """Smallest radial internal clearance in operation, of all cases [m].

    Of a set, that of its first row.
    """

    def __call__(self, element, cases, solution):
        def clearance(one):
            return radial_clearance(rows_of(one.element.bearing)[0].bearing)

        return smallest(jax.vmap(clearance)(loads_of(solution)))

    @property
    def label(self) -> str:
        return "operating clearance"

    @property
    def unit(self) -> str:
        return unit_of(Mounting, "radial_clearance")


class OperatingPreload(AbstractMeasure):
    """Smallest preload between the unloaded rows of a set in operation [N].

    Of all cases, at their speeds; 0 where there is play.
    """

    def __call__(self, element, cases, solution):
        def preload(one):
            return remaining_preload(one.element, one.speed, throw=False)

        return smallest(jax.vmap(preload)(loads_of(solution)))

    @property
    def label(self) -> str:
        return "operating preload"

    @property
    def unit(self) -> str:
        return "N"


class StiffnessTarget(AbstractMeasure):
    """Square of the relative difference of a stiffness from its target [1].

    The mean of (k/target - 1)² over the hours of the cases; without hours all count
    alike.

    Attributes:
        target: Wanted stiffness, not zero [N/m, N, N m].
        freedom: Row of the stiffness of the moving ring, one of ux, uy, uz, gx, gy.
        other: Its column; `None`: the diagonal.

    Traced: target. Static: the freedoms.
    """

    target: Real = eqx.field(**real(STIFFNESS_UNITS))
    freedom: str = eqx.field(static=True)
    other: str | None = eqx.field(static=True, default=None)

    def __check_init__(self):
        pair = self.freedom, self.other or self.freedom
        for freedom in pair:
            _check_freedom(self, freedom)
        given = self.target, unit_of(self, "target", tuple(map(FREEDOMS.index, pair)))
        number(self, "target", *given)
        check(self, "target", self.target != 0, f"other than 0 {given[1]}", *given)

    def __call__(self, element, cases, solution):
        value = _stiffness(solution, self.freedom, self.other or self.freedom)
        return _mean((value / self.target - 1.0) ** 2, cases)

    @property
    def least_size(self) -> float:
        # A difference of 1 %: divided by less, round-off about a target that is met
        # would look like a slope.
        return 1e-4

    @property
    def label(self) -> str:
        pair = self.freedom if self.other is None else f"{self.freedom} {self.other}"
        return f"miss of stiffness {pair}"

    @property
    def unit(self) -> str:
        return ""


def label_of(measure: Any) -> str:
    """Name of a measure, or of a plain function."""
    if isinstance(measure, AbstractMeasure):
        return measure.label
    return getattr(measure, "__name__", type(measure).__name__)


def exact_of(measure: Any, element: Design, cases: Any, solution: Any) -> Scalar:
    """`exact_value` of a measure; for a plain function its value.

    Args:
        measure: Any measure.
        element, cases, solution: As in `AbstractMeasure.__call__`.
    """
    call = measure.exact_value if isinstance(measure, AbstractMeasure) else measure
    return call(element, cases, solution)


def least_size_of(measure: Any) -> float:
    """`least_size` of a measure; for a plain function 0."""
    return measure.least_size if isinstance(measure, AbstractMeasure) else 0.0


def hour_weights(cases: Any) -> Float[Array, " case"]:
    """Share of each case in all hours; equal shares if the cases have no hours."""
    hours = jnp.ones(cases.count) if cases.hours is None else jnp.asarray(cases.hours)
    return hours / jnp.sum(hours)


def _pressures(solution):
    """Pressures of all contacts, of rollers also along them (case, sample)."""
    solution = loads_of(solution)
    count = solution.contact_pressure.shape[0]
    samples = solution.contact_pressure.reshape(count, -1)
    if not isinstance(solution, RollerSolution):
        return samples
    peaks = solution.roller_pressure.reshape(count, -1)
    return jnp.concatenate([samples, peaks], axis=1)


def _mean(values, cases):
    """Mean over the hours of the cases."""
    return jnp.sum(hour_weights(cases) * values)


def _stiffness(solution, row, column):
    solution = loads_of(solution)
    first = 6 * RINGS.index(solution.moving_ring)
    i, j = (first + FREEDOMS.index(name) for name in (row, column))
    return solution.stiffness[:, i, j]


def _check_freedom(owner, freedom):
    one_of(owner, "freedom", freedom, FREEDOMS[:5])

"""Designs to be optimised: a bearing alone, on its seats, or with more, such as oil;
or a machine with several bearings."""

import abc
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple

import equinox as eqx

from ..cases.cases import Cases, case_speed, solve_case
from ..element.bearing_element import BearingElement, check_element
from ..numerics.warning import Warning
from ..statics.installed import Installed
from ..statics.options import SolveOptions
from ..statics.solution import Solution
from ..statics.support import Support


class Reading(NamedTuple):
    """Where a number of a solved case stands: in which output, at which entry, counted
    along all axes; and its SI unit, empty for a pure number."""

    output: str
    entry: int
    unit: str


class AbstractSystem(eqx.Module):
    """A bearing with all else that its cases need, with its own solve of a case.

    A system with several bearings has operating cases of its own kind, with `count` and
    `hours`; its solved cases have no `solution`, and its measures are its own.

    Attributes:
        of_cases: Class of its operating cases.
    """

    of_cases: ClassVar[type] = Cases

    @property
    @abc.abstractmethod
    def element(self) -> BearingElement[Any]:
        """The bearing in it."""

    @abc.abstractmethod
    def check(self, cases: Cases) -> None:
        """Raise if the cases are not valid for this system.

        Raises:
            ValueError: If they lack something.
        """

    @abc.abstractmethod
    def solve_case(self, case: Cases, support: Support, options: SolveOptions) -> Any:
        """Solve one case; nothing is raised for a failed solve.

        Args:
            case: Cases without their leading axis.
            support: What holds the rings.
            options: Numerics of the load solve.

        Returns:
            A Module with the load solve of the bearing as `solution`, if there is one
            bearing, and the `Result` code of the whole solve as `result`.
        """

    def is_solved_by_parts(self, cases: Any) -> bool:
        """Whether `solve_by_parts` solves such cases; by default there is none."""
        return False

    def solve_by_parts(self, cases: Any, changes: Any) -> tuple[Any, Any]:
        """Solve all cases of known numbers with calls of smaller programs, and return
        the derivatives along changes of the design.

        Args:
            cases: Operating cases.
            changes: Changes of the design (change, …), `None` for what is no real
                number; or `None`: no derivatives.

        Returns:
            Solved cases (case, …), and their changes (change, case, …); `None` without
            any, and if a case failed.
        """
        raise NotImplementedError

    @abc.abstractmethod
    def failure_message(self, solved: Any) -> str:
        """Reason why a case failed, in words.

        Args:
            solved: From `solve_case`, concrete.
        """

    def readings(self) -> dict[str, Reading]:
        """Numbers of solved cases that can be measured, by name, their outputs being
        fields of `solve_case`; by default none."""
        return {}

    def warnings(self, cases: Any, solved: Callable[[], Any]) -> list[Warning]:
        """Warnings other than those of the loads; none by default.

        Args:
            cases: Operating cases.
            solved: Returns the solved cases, concrete, leading axis case.
        """
        return []


Design = BearingElement[Any] | Installed | AbstractSystem


def check_design(owner: str, design: Any, cases: Any) -> None:
    """Raise unless the design can be optimised over such cases.

    Raises:
        TypeError: If it is neither an element, nor installed, nor a system.
        ValueError: If the cases lack something.
    """
    if isinstance(design, AbstractSystem):
        design.check(cases)
    elif not isinstance(design, Installed):
        check_element(owner, design)


def solved_case(
    design: Design,
    case: Any,
    support: Support,
    options: SolveOptions,
    start: Any = None,
) -> Any:
    """Solve one case of a design; for an element the load solve.

    An installed bearing is mounted at the speeds of the case, if it has any.

    Args:
        design, case, support, options: As in `AbstractSystem.solve_case`.
        start: Displacement of the moving ring of a bearing from which its solve starts
            (6,) [m, rad]; `None`, or NaN: from first contact. A system ignores it.
    """
    if isinstance(design, AbstractSystem):
        return design.solve_case(case, support, options)
    if isinstance(design, Installed):
        design = design.element_at(case_speed(case), throw=False)
    return solve_case(design, case, support, options, start)


def prepare(design: Design, build: Callable[[Any], Any] | None) -> Design:
    """Return a changed design ready to be solved: the rows of a set are ground once.

    Args:
        design: The design with the values of its variables.
        build: As in `optimise`.
    """
    if build is not None:
        design = build(design)
    return design.grind_rows(throw=False) if isinstance(design, Installed) else design


def element_of(design: Design) -> BearingElement[Any]:
    """The bearing of a design.

    Args:
        design: An element, an installed bearing or a system.
    """
    if isinstance(design, Installed):
        return design.element_at()
    return design.element if isinstance(design, AbstractSystem) else design


def loads_of(solved: Any) -> Any:
    """Load solve of a solved case.

    Args:
        solved: From `solved_case`; of one or of many cases.

    Raises:
        TypeError: For those of a system of several bearings.
    """
    if isinstance(solved, Solution):
        return solved
    if not has_loads(solved):
        raise TypeError(
            "optimise: a measure of one bearing was asked of a system of several; take"
            " those of the system, such as `bearingjax.shafts.Worst`."
        )
    return solved.solution


def has_loads(solved: Any) -> bool:
    """Whether solved cases are of one bearing.

    Args:
        solved: As in `loads_of`.
    """
    return isinstance(solved, Solution) or hasattr(solved, "solution")


def describe_failure(design: Design, solved: Any) -> str:
    """Reason why a case failed, in words.

    Args:
        design: The design.
        solved: From `solved_case`, concrete.
    """
    loads = loads_of(solved) if has_loads(solved) else None
    if loads is not None and (
        not isinstance(design, AbstractSystem) or int(loads.result)
    ):
        return loads.failure_message
    assert isinstance(design, AbstractSystem)
    return design.failure_message(solved)

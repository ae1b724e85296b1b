"""What can be optimised: a bearing alone, or one with more about it, such as oil."""

import abc
from typing import Any

import equinox as eqx

from ..element.bearing_element import BearingElement, check_element
from ..statics.cases import Cases, solve_case
from ..statics.options import SolveOptions
from ..statics.solution import Solution, message


class AbstractSystem(eqx.Module):
    """A bearing and what else its cases need, which says itself how they are solved."""

    @property
    @abc.abstractmethod
    def element(self) -> BearingElement[Any]:
        """The bearing in it."""

    @abc.abstractmethod
    def check(self, cases: Cases) -> None:
        """Raise if it has no use for such cases.

        Args:
            cases: Operating cases.

        Raises:
            ValueError: If they lack something.
        """

    @abc.abstractmethod
    def solve_case(self, case: Cases, options: SolveOptions) -> Any:
        """What is solved in one case; nothing is raised for a failed solve.

        Args:
            case: Cases without their leading axis.
            options: Settings of the load solve.

        Returns:
            A Module with the load solve as `solution` and the `Result` code of all
            that was solved as `result`.
        """

    @abc.abstractmethod
    def message(self, solved: Any) -> str:
        """Why a case failed, in words.

        Args:
            solved: From `solve_case`, concrete.
        """


Design = BearingElement[Any] | AbstractSystem


def check_design(owner: str, design: Any, cases: Any) -> None:
    """Raise unless it can be optimised over such cases.

    Args:
        owner: Function that was called.
        design: What it was given.
        cases: Operating cases.

    Raises:
        TypeError: If it is neither an element nor a system.
        ValueError: If the cases lack something.
    """
    if isinstance(design, AbstractSystem):
        design.check(cases)
    else:
        check_element(owner, design)


def solved_case(design: Design, case: Cases, options: SolveOptions) -> Any:
    """What is solved in one case of a design; of an element its load.

    Args:
        design, case, options: As of `AbstractSystem.solve_case`.
    """
    if isinstance(design, AbstractSystem):
        return design.solve_case(case, options)
    return solve_case(design, case, options)


def element_of(design: Design) -> BearingElement[Any]:
    """The bearing of a design.

    Args:
        design: An element or a system.
    """
    return design.element if isinstance(design, AbstractSystem) else design


def loads_of(solved: Any) -> Any:
    """The load solve of what was solved.

    Args:
        solved: From `solved_case`; of one or of many cases.
    """
    return solved if isinstance(solved, Solution) else solved.solution


def failure(design: Design, solved: Any) -> str:
    """Why a case failed, in words.

    Args:
        design: The design.
        solved: From `solved_case`, concrete.
    """
    loads = loads_of(solved)
    if not isinstance(design, AbstractSystem) or int(loads.result):
        return message(loads, loads.moving_ring)
    return design.message(solved)

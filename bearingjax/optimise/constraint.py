"""Constraints of an optimisation: bounds on measures."""

from collections.abc import Callable
from typing import Any

import equinox as eqx

from ..design.checks import check, number, of_class
from ..numerics.types import Scalar, as_real
from .measure import label_of

_A_MEASURE = "a function (element, cases, solution) -> scalar, such as Stiffness('uy')"


def _as_bound(value):
    """Converter: of no unit that is known here, which `as_real` would promise."""
    return as_real(value)


class Constraint(eqx.Module):
    """Bounds on a measure.

    Attributes:
        measure: Bounded measure, such as `Stiffness('uy')`, or any function
            (element, cases, solution) -> scalar.
        lower: Least value, or `None` [unit of the measure].
        upper: Largest value, or `None` [unit of the measure].

    Traced: the bounds. Static: which of them are given.
    """

    measure: Any
    lower: Scalar | None = eqx.field(converter=_as_bound, default=None)
    upper: Scalar | None = eqx.field(converter=_as_bound, default=None)

    def __check_init__(self):
        of_class(self, "measure", self.measure, Callable, _A_MEASURE)
        bounds = {"lower": self.lower, "upper": self.upper}
        if all(bound is None for bound in bounds.values()):
            raise ValueError("Constraint: give `lower`, `upper` or both.")
        for name, bound in bounds.items():
            if bound is not None:
                number(self, name, bound, "")
        if self.lower is not None and self.upper is not None:
            above = self.upper > self.lower
            check(self, "upper", above, "above `lower`", self.upper, "")

    @property
    def label(self) -> str:
        """Name in reports."""
        return label_of(self.measure)

    def bounds_text(self, show: Callable[[float], str]) -> str:
        """Return the bounds in words, such as "at least 1 mm and at most 2 mm".

        Args:
            show: Formats a bound.
        """
        ends = ("at least", self.lower), ("at most", self.upper)
        return " and ".join(f"{w} {show(float(x))}" for w, x in ends if x is not None)

"""A bearing in design that is solved as its fits and the speed of the case leave it."""

from typing import Any

import equinox as eqx

from ..design import FitConditions, Mounting, mounted
from ..design.checks import instance
from ..element.bearing_element import BearingElement
from ..statics.cases import solve_case
from .system import AbstractSystem


class MountedBearing(AbstractSystem):
    """A bearing on its seats, for `bearingjax.optimise`.

    Any number may be a variable: "mounting.shaft_interference",
    "unmounted.bearing.radial_internal_clearance" (the clearance before mounting),
    "conditions.inner_ring" (a temperature, of the scale of `conditions.reference`).

    Attributes:
        unmounted: The bearing, its preload set, before it is mounted.
        mounting: Its seats.
        conditions: Temperatures; the speeds of a case go before those given here.

    Traced: all numbers.
    """

    unmounted: BearingElement[Any]
    mounting: Mounting
    conditions: FitConditions = eqx.field(default_factory=FitConditions)

    def __check_init__(self):
        instance(self, "unmounted", BearingElement)
        instance(self, "mounting", Mounting)
        instance(self, "conditions", FitConditions)

    @property
    def element(self):
        return self._mounted(self.conditions)

    def check(self, cases):
        pass

    def solve_case(self, case, options):
        speeds = {"speed": case.inner_speed, "outer_speed": case.outer_speed}
        given = {name: value for name, value in speeds.items() if value is not None}
        conditions = eqx.tree_at(
            lambda c: [getattr(c, name) for name in given],
            self.conditions,
            list(given.values()),
        )
        return solve_case(self._mounted(conditions), case, options)

    def message(self, solved):
        return ""  # of a load solve that converged there is nothing to tell

    def _mounted(self, conditions):
        new = mounted(self.unmounted.bearing, self.mounting, conditions)
        return eqx.tree_at(lambda e: e.bearing, self.unmounted, new)

"""The bearing as it runs: preloaded, mounted on its seats, warm and turning."""

import dataclasses
from typing import Any

import equinox as eqx

from ..design.checks import instance
from ..element.bearing_element import BearingElement
from ..element.inertia import Speed
from ..fits import FitConditions, Mounting, mounted
from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .preload import preload
from .service_warning import speed_warnings


class Installed(eqx.Module):
    """A bearing with its preload, its seats and its temperatures.

    The order is that of the workshop: the rows of a set are ground to their preload,
    then the bearing is mounted, then it gets warm and turns. Every command of
    bearingjax solves the element that `at` returns.

    Any number may be a variable of `optimise`: "drawing.bearing.contact_angle",
    "mounting.shaft_interference", "conditions.inner_ring" (a temperature, on the scale
    of `conditions.reference`).

    Attributes:
        drawing: The bearing with its laws and numerics, before it is ground and
            mounted.
        preload: Axial force to which the rows of a set are ground [N]; `None`: the
            `inner_offset` of its rows are those of the drawing.
        mounting: Seats; `None`: clearance and contact angles are those of the drawing.
        conditions: Temperatures and speeds; `None`: at rest, at the temperature of the
            measured sizes.
        limiting_speed: Speed limit of its catalogue, of one ring against the
            other [rad/s]; `None`: not known. It does not affect the solution.
        reference_speed: Thermal reference speed of its catalogue, the same way [rad/s].

    Traced: all numbers. Static: which fields are `None`.

    Raises:
        TypeError: If a part is of another kind.
        ValueError: If `conditions` are given without `mounting`, which they act on.
    """

    drawing: BearingElement[Any]
    preload: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("N"), default=None
    )
    mounting: Mounting | None = None
    conditions: FitConditions | None = None
    limiting_speed: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("rad/s"), default=None
    )
    reference_speed: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("rad/s"), default=None
    )

    def __check_init__(self):
        instance(self, "drawing", BearingElement)
        instance(self, "mounting", Mounting, None)
        instance(self, "conditions", FitConditions, None)
        if self.conditions is not None and self.mounting is None:
            raise ValueError(
                "Installed: `conditions` are given and `mounting` is None; temperatures"
                " and speeds change the clearance of a bearing on its seats: give both"
                " or neither."
            )

    def ground(self, *, throw: bool = True) -> "Installed":
        """Return the bearing with its rows ground to give `preload`.

        Args:
            throw: Raise if the preload solve fails; otherwise the offsets are NaN.

        Returns:
            Bearing whose `drawing` has the `inner_offset` that `preload` gives, and
            whose `preload` is `None`.

        Raises:
            TypeError, ValueError, SolveError: As `bearingjax.preload`.
        """
        if self.preload is None:
            return self
        element = preload(self.drawing, self.preload, throw=throw)
        return dataclasses.replace(self, drawing=element, preload=None)

    def at(
        self, speed: Speed | None = None, *, throw: bool = True
    ) -> BearingElement[Any]:
        """The element to be solved: ground, mounted, warm and turning.

        Args:
            speed: Ring speeds, at which seats lose interference by centrifugal growth;
                `None`: those of `conditions`. The solve needs them too.
            throw: As in `ground`.

        Returns:
            Element with the offsets, clearances and contact angles in operation,
            differentiable with respect to every number.

        Raises:
            TypeError, ValueError: As `mounted`; those of `ground`.
        """
        element = self.ground(throw=throw).drawing
        if self.mounting is None:
            return element
        conditions = FitConditions() if self.conditions is None else self.conditions
        if speed is not None:
            conditions = eqx.tree_at(
                lambda c: (c.speed, c.outer_speed),
                conditions,
                (speed.inner, speed.outer),
            )
        bearing = mounted(element.bearing, self.mounting, conditions)
        return eqx.tree_at(lambda e: e.bearing, element, bearing)

    def speed_warnings(self, turns: Any) -> list[str]:
        """Warnings about speeds beyond those of its catalogue, a sentence each.

        Args:
            turns: As in `statics.speed_warnings`, concrete.
        """
        return speed_warnings(
            turns,
            limiting_speed=self.limiting_speed,
            reference_speed=self.reference_speed,
        )

"""The bearing as it runs: preloaded, mounted on its seats, warm and turning."""

import dataclasses
from collections.abc import Iterable
from typing import Any

import equinox as eqx
import jax
import numpy as np

from ..design.checks import instance
from ..element import BearingElement, Speed
from ..fits import (
    FitConditions,
    FitStates,
    Limits,
    Mounting,
    SizeLimits,
    fit_states,
    mount,
    mounting_at,
    with_bearing_dimensions,
)
from ..numerics.compiled.programs import program
from ..numerics.shown import Printable
from ..numerics.types import RealOrNone, as_array, as_real
from ..numerics.units import real, rpm
from ..numerics.warning import Warning
from .preload import SetPreload, is_opposed, preload, remaining_preload
from .service_warning import MOST_DRIFT, preload_warnings, seat_warnings, speed_warnings

_EXACT = 1e-9
"""Length by which a size may miss its limits, by round-off [m]."""

_LEAST = 1e-6
"""Force below which the preload counts as zero, by round-off [N]."""


def _as_limits(given: SizeLimits | None) -> SizeLimits | None:
    if given is None:
        return None
    return SizeLimits(*(Limits(*map(as_real, ends)) for ends in given))


class Installed(Printable):
    """A bearing with its preload, its seats and its temperatures.

    The order is that of the workshop: the rows of a set are ground to their preload,
    then the bearing is mounted, then it gets warm and turns. Every command of
    bearingjax solves the element that `element_at` returns. `fit_states` and
    `set_preload` give clearance, seats and preload from the drawing to operation,
    `warnings` what is suspicious about them.

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
        limits: Limits of clearance, seats and rings, for the ranges of `fit_states` and
            `set_preload`; `None`: no tolerances. They do not affect the solution, which
            has the sizes of `mounting` (`fits.mounting_at`).
        limiting_speed: Speed limit of its catalogue, of one ring against the
            other [rad/s]; `None`: not known. It does not affect the solution.
        reference_speed: Thermal reference speed of its catalogue, the same way [rad/s].

    Traced: all numbers. Static: which fields are `None`.

    Raises:
        TypeError: If a part is of another kind.
        ValueError: If `conditions` or `limits` are given without `mounting`, which they
            act on.
    """

    drawing: BearingElement[Any]
    preload: RealOrNone = eqx.field(**real("N"), default=None)
    mounting: Mounting | None = None
    conditions: FitConditions | None = None
    limits: SizeLimits | None = eqx.field(converter=_as_limits, default=None)
    limiting_speed: RealOrNone = eqx.field(**real("rad/s"), default=None)
    reference_speed: RealOrNone = eqx.field(**real("rad/s"), default=None)

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
        if self.limits is not None and self.mounting is None:
            raise ValueError(
                "Installed: `limits` are given and `mounting` is None; they are the"
                " limits of its sizes: give both or neither."
            )

    def grind_rows(self, *, throw: bool = True) -> "Installed":
        """Return the bearing with its rows ground to give `preload`.

        Args:
            throw: Raise if the preload solve fails; otherwise the offsets are NaN.

        Returns:
            Bearing whose `drawing` has the `inner_offset` that `preload` gives, and
            whose `preload` is `None`.

        Raises: as `bearingjax.preload`.
        """
        if self.preload is None:
            return self
        element = preload(self.drawing, self.preload, throw=throw)
        return dataclasses.replace(self, drawing=element, preload=None)

    def element_at(
        self, speed: Speed | None = None, *, throw: bool = True
    ) -> BearingElement[Any]:
        """The element to be solved: ground, mounted, warm and turning.

        Args:
            speed: Ring speeds, at which seats lose interference by centrifugal growth;
                `None`: those of `conditions`. The solve needs them too.
            throw: As in `grind_rows`.

        Returns:
            Element with the offsets, clearances and contact angles in operation,
            differentiable with respect to every number.

        Raises:
            TypeError, ValueError: As `mount`; those of `grind_rows`.
        """
        element = self.grind_rows(throw=throw).drawing
        if self.mounting is None:
            return element
        turning = self if speed is None else self.with_speed(speed)
        bearing = mount(element.bearing, self.mounting, turning.conditions)
        return eqx.tree_at(lambda e: e.bearing, element, bearing)

    def with_speed(self, speed: Speed) -> "Installed":
        """Return the bearing with other ring speeds in its `conditions`.

        A bearing without seats, which no speed loosens, is returned unchanged.

        Args:
            speed: Ring speeds.
        """
        if self.mounting is None:
            return self
        conditions = FitConditions() if self.conditions is None else self.conditions
        conditions = eqx.tree_at(
            lambda c: (c.speed, c.outer_speed), conditions, (speed.inner, speed.outer)
        )
        return dataclasses.replace(self, conditions=conditions)

    def fit_states(self) -> FitStates | None:
        """Clearance and seats before mounting, mounted and in operation, in NumPy.

        Nothing is compiled; numbers must be concrete (for derivatives see
        `fits.fit_states`). Of a set, those of its first row.

        Returns:
            The states, over the tolerances too if there are `limits`; `None` without
            `mounting`.

        Raises:
            TypeError, ValueError: As `fits.with_bearing_dimensions`, and
                `fits.clearance_range`.
        """
        if self.mounting is None:
            return None
        mounting = with_bearing_dimensions(self.mounting, self.drawing.bearing)
        return fit_states(*jax.device_get((mounting, self.conditions, self.limits)))

    def set_preload(self, speed: Speed | None = None) -> SetPreload | None:
        """Preload between the rows of a set: as ground, mounted and in operation [N].

        Numbers must be concrete.

        Args:
            speed: Ring speeds in operation, which move balls outwards; `None`: at rest.
                Seats turn at those of `conditions`.

        Returns:
            The preload, over the tolerances of the seats too if there are `limits`;
            `None` without `mounting`, or if no rows press each other.

        Raises:
            TypeError, ValueError: As `bearingjax.preload`, and `fits.clearance_range`.
        """
        own = self.mounting
        if own is None or not is_opposed(self.drawing.bearing):
            return None
        ground = dataclasses.replace(self.grind_rows(throw=False), limits=None)
        cold = dataclasses.replace(ground, conditions=None)
        # On seats without contact the set stays as ground, and has the same structure
        # as the others.
        loose = -1e-3 * own.bore
        at = {"middle": own, **self._seats_at_ends(own)}
        states: dict[str, Any] = {
            "ground": (_element_on(_fitting(own, loose, loose), cold), None)
        }
        for place, seats in at.items():
            states[f"{place} mounted"] = _element_on(seats, cold), None
            states[f"{place} operating"] = _element_on(seats, ground), speed
        possible = {k: state for k, state in states.items() if state[0] is not None}
        elements = _stack([element for element, _ in possible.values()])
        speeds = None
        if speed is not None:
            still = Speed(0.0, 0.0)
            speeds = _stack([still if s is None else s for _, s in possible.values()])
        found = np.asarray(_preloads(elements, speeds))
        # Round-off is not a preload.
        found = np.where(np.abs(found) < _LEAST, 0.0, found)
        force = dict.fromkeys(states, np.nan)
        force |= {k: float(x) for k, x in zip(possible, found, strict=True)}

        def ends(state):
            if "loosest" not in at:
                return None
            return force[f"loosest {state}"], force[f"tightest {state}"]

        nominal = force["middle mounted"], force["middle operating"]
        return SetPreload(force["ground"], *nominal, ends("mounted"), ends("operating"))

    def _seats_at_ends(self, own: Mounting) -> dict[str, Mounting]:
        """Return the tightest and loosest seats; none if the limits are exact."""
        seats = () if self.limits is None else jax.device_get(self.limits[1:])
        if not any(ends.lower != ends.upper for ends in seats):
            return {}
        whole = jax.device_get(with_bearing_dimensions(own, self.drawing.bearing))
        found = {}
        for place in ("tightest", "loosest"):
            # The clearance is that as ground.
            there = mounting_at(whole, place, Limits(0.0, 0.0), *seats)
            fits = there.shaft_interference, there.housing_interference
            found[place] = _fitting(own, *fits)
        return found

    def seat_warnings(self, load_fixed_to: str = "space") -> list[Warning]:
        """Warnings about its seats, at the speeds of `conditions`.

        Args: as `LifeConditions`.
        """
        states = self.fit_states()
        if states is None:
            return []
        texts = self._limit_warnings(float(states.free))
        seats = states.mounted, states.operating, states.loosest
        speed = None
        if (c := self.conditions) is not None:
            speed = Speed(c.speed, c.outer_speed)
        return texts + seat_warnings(*seats, speed=speed, load_fixed_to=load_fixed_to)

    def _limit_warnings(self, free: float) -> list[Warning]:
        """Return warnings about sizes outside their limits."""
        if self.mounting is None or self.limits is None:
            return []
        seats, limits = jax.device_get((self.mounting, self.limits))
        sizes = {
            "radial clearance before mounting": (free, *limits.clearance),
            "interference of the shaft": (
                seats.shaft_interference,
                limits.shaft.lower - limits.bore.upper,
                limits.shaft.upper - limits.bore.lower,
            ),
            "interference of the housing": (
                seats.housing_interference,
                limits.outside_diameter.lower - limits.housing.upper,
                limits.outside_diameter.upper - limits.housing.lower,
            ),
        }
        found = []
        for name, (size, lower, upper) in sizes.items():
            if lower - _EXACT <= size <= upper + _EXACT:
                continue
            words = (
                f"fit: the {name} is {1e6 * size:.4g} µm, outside its limits,"
                f" {1e6 * lower:.4g} to {1e6 * upper:.4g} µm: what is told over the"
                " tolerances is of other bearings"
            )
            limit = float(lower if size < lower else upper)
            found.append(Warning("outside_limits", words, float(size), limit))
        return found

    def held_clearance_warnings(
        self, speed: float, others: Iterable[float]
    ) -> list[Warning]:
        """Warnings about solving other speeds with the clearance at one: centrifugal
        growth of shaft and inner ring changes it.

        Args:
            speed: Speed of the inner ring whose clearance is taken [rad/s].
            others: Further speeds that are solved with it [rad/s].
        """
        left = {}
        for turns in dict.fromkeys((speed, *others)):
            states = self.with_speed(Speed(turns, 0.0)).fit_states()
            if states is None:
                return []
            left[turns] = float(states.operating.radial_clearance)
        far = max(left, key=lambda turns: abs(left[turns] - left[speed]))
        drift = abs(left[far] - left[speed])
        if drift <= MOST_DRIFT:
            return []
        words = (
            f"all speeds are solved with the radial clearance at {rpm(speed)},"
            f" {1e6 * left[speed]:.4g} µm; at {rpm(far)} its fits leave"
            f" {1e6 * left[far]:.4g} µm"
        )
        return [Warning("held_clearance", words, drift, MOST_DRIFT)]

    def warnings(
        self, speed: Speed | None = None, load_fixed_to: str = "space"
    ) -> list[Warning]:
        """Warnings about its design, its seats, its speed and the preload of its rows;
        what a solution says is told by `statics.warnings`.

        Args:
            speed: Ring speeds; `None`: at rest.
            load_fixed_to: As in `LifeConditions`.
        """
        turning = self if speed is None else self.with_speed(speed)
        found = [*self.drawing.warnings, *turning.seat_warnings(load_fixed_to)]
        if speed is not None:
            found += self.speed_warnings(speed.inner - speed.outer)
        preload = turning.set_preload(speed)
        return found + ([] if preload is None else preload_warnings(preload))

    def speed_warnings(self, turns: Any) -> list[Warning]:
        """Warnings about speeds beyond those of its catalogue.

        Args:
            turns: As in `statics.speed_warnings`, concrete.
        """
        return speed_warnings(
            turns,
            limiting_speed=self.limiting_speed,
            reference_speed=self.reference_speed,
        )


def _fitting(mounting: Mounting, shaft: Any, housing: Any) -> Mounting:
    """Return the seats with other interferences [m]."""
    return eqx.tree_at(
        lambda m: (m.shaft_interference, m.housing_interference),
        mounting,
        (as_array(shaft, float), as_array(housing, float)),
    )


def _element_on(seats: Mounting, ground: Installed) -> BearingElement[Any] | None:
    """Return the set on seats; `None` if its balls have no contact angle left."""
    try:
        return dataclasses.replace(ground, mounting=seats).element_at()
    except ValueError:
        return None


def _stack(trees: list[Any]) -> Any:
    return jax.tree.map(lambda *x: as_array(np.stack(x), float), *trees)


@program(quick=True, what="preload of a set on its seats")
def _preloads(elements, speeds):
    def preload_at(element, speed):
        return remaining_preload(element, speed, throw=False)

    return eqx.filter_vmap(preload_at)(elements, speeds)

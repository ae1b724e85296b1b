"""Skidding in design: a preloaded bearing with its oil, and measures of its cases."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp

from ..cases.cases import Cases, case_support, solve_case
from ..design.checks import instance, number
from ..element import BearingElement, Speed
from ..numerics import Result, Warning
from ..numerics.types import Real, Reals
from ..numerics.units import real, unit_of
from ..optimise.measure import AbstractLargest, AbstractMeasure, hour_weights
from ..optimise.system import AbstractSystem
from ..statics import SolveOptions, Support
from ..statics.load_case import load_case
from .conditions import conditions
from .model import SkidModel
from .orbits.steady import check_places, end_state, enough_places
from .orbits.steady_results import SteadyMotion
from .warning import skid_warnings


class SkiddingBearing(AbstractSystem):
    """A preloaded bearing whose balls or rollers may slip, for `bearingjax.optimise`.

    Every case is solved as by `skid.steady`. Any number may be a variable:
    "preload", "model.element.bearing.contact_angle", "model.temperature".

    Attributes:
        model: The bearing, its oil and its surroundings.
        preload: Axial force on the moving ring, added to that of every case, as from a
            soft spring: it does not change with speed or load [N].
        places: Places along the orbit, as in `skid.steady`; `None`: at least 96. 1 will
            do where all cases load all balls alike.

    Traced: all numbers. Static: places, the classes.
    """

    model: SkidModel
    preload: Real = eqx.field(**real("N"), default=0.0)
    places: int | None = eqx.field(static=True, default=None)

    def __check_init__(self):
        instance(self, "model", SkidModel)
        number(self, "preload")
        check_places("SkiddingBearing", self.model.bearing, self.places)

    @property
    def element(self) -> BearingElement[Any]:
        return self.model.element

    def check(self, cases: Cases) -> None:
        if cases.inner_speed is None and cases.outer_speed is None:
            raise ValueError(
                "optimise: `cases` have no ring speeds; give `inner_speed` or"
                " `outer_speed` in rad/s, or nothing skids."
            )

    def solve_case(self, case: Cases, support: Support, options: SolveOptions) -> Any:
        model = self.model
        load = jnp.asarray(case.load).at[2].add(self.preload)
        loaded = eqx.tree_at(lambda c: c.load, case, load)
        solution = solve_case(model.element, loaded, support, options)
        still = jnp.zeros_like(self.preload)
        rings = case.inner_speed, case.outer_speed
        speed = Speed(*(still if ring is None else ring for ring in rings))
        places = enough_places(model.bearing) if self.places is None else self.places
        held = case_support(loaded, support)
        whole = load_case(model.bearing, loaded.load, held, speed=speed)
        return end_state(model, solution, whole, speed, places)

    def failure_message(self, solved: Any) -> str:
        if int(solved.result) == Result.GRID_MISFIT:
            count = self.model.bearing.n_elements
            return (
                "its balls or rollers bear unlike loads: `places` must be a multiple"
                f" of {count}"
            )
        return f"no end state of skidding: {solved.failure_message}"

    def warnings(self, cases: Cases, solved: Callable[[], Any]) -> list[Warning]:
        still, rings = jnp.zeros(cases.count), (cases.inner_speed, cases.outer_speed)
        rings = (still if ring is None else jnp.asarray(ring) for ring in rings)
        speed = jax.vmap(Speed)(*rings)
        balls = self.model.bearing.is_ball
        ended = solved()
        state = conditions(self.model, ended, speed) if balls else None
        return skid_warnings(self.model, ended, state)


class FrictionTorque(AbstractMeasure):
    """Mean magnitude of the friction torque over the hours of the cases [N m].

    Of sliding, drag and cage; see `SkidModel` for what is left out.

    Without hours all cases count alike. Of a `SkiddingBearing`.
    """

    def __call__(self, element, cases, solution):
        torque = _skidding(self, solution).friction_torque
        return jnp.sum(hour_weights(cases) * jnp.abs(torque))

    @property
    def label(self) -> str:
        return "friction torque"

    @property
    def unit(self) -> str:
        return unit_of(SteadyMotion, "friction_torque")


class FrictionPower(AbstractMeasure):
    """Mean friction power over the hours of the cases.

    That of all its parts, in W. Without hours all cases count alike. Of a
    `SkiddingBearing`.
    """

    def __call__(self, element, cases, solution):
        power = _skidding(self, solution).power.drive
        return jnp.sum(hour_weights(cases) * power)

    @property
    def label(self) -> str:
        return "friction power"

    @property
    def unit(self) -> str:
        return "W"


class CageSlip(AbstractLargest):
    """Largest magnitude of cage slip over all cases [1].

    Size of `SteadyMotion.cage_slip`. Hours do not matter. Of a `SkiddingBearing`.

    Both count as skidding. At high speed gyroscopic moments lay the spin axes of the
    balls flat, towards the bearing axis. Balls then roll past the outer raceway faster
    than in pure rolling, and the cage leads, although they slide.

    Attributes:
        exponent: Exponent of the smooth maximum over the cases.

    Static: exponent.
    """

    def samples(self, solution: Any) -> Reals:
        return jnp.abs(_skidding(self, solution).cage_slip)

    @property
    def label(self) -> str:
        return "slip of the cage"

    @property
    def unit(self) -> str:
        return ""


def _skidding(measure, solution) -> SteadyMotion:
    if not isinstance(solution, SteadyMotion):
        raise ValueError(
            f"{type(measure).__name__}: nothing skids in what was solved; optimise a"
            " `SkiddingBearing` of bearingjax.skid in place of the element."
        )
    return solution

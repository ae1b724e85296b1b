"""Every kind of warning: a value of the solution, its limit and the text."""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from ..design import (
    AbstractBarrelBearing,
    AngularContactBallBearing,
    SphericalThrustRollerBearing,
    rows_of,
)
from ..design.bearing_set import bearings_of, is_self_aligning
from ..element import BearingElement, Linearised, Speed
from ..numerics.units import shown_count
from ..numerics.warning import Kind
from . import warning_sizes as sizes
from .rollers import EDGE_PRESSURE
from .solution import BallSolution, RollerSolution, Solution, solution_kind


@dataclasses.dataclass(frozen=True)
class SolutionKind(Kind):
    """A kind of warning about a solution; its `where` takes the solution.

    Attributes:
        size: Solution -> size of the warning, a scalar.
        applies: (element, speed) -> whether it can arise at all. Static.
    """

    size: Callable[[Solution], Any] = dataclasses.field(kw_only=True)
    applies: Callable[[BearingElement, Speed | None], bool] = dataclasses.field(
        kw_only=True, default=lambda element, speed: True
    )


def _of_balls(element, speed):
    return issubclass(solution_kind(element.choices), BallSolution)


def _of_rollers(element, speed):
    # Rolling elements of a user's own have neither of the two kinds of results.
    return issubclass(solution_kind(element.choices), RollerSolution)


def _has_ribs(element, speed):
    return any(row.rib_names for row in bearings_of(element.bearing))


def _has_shoulder(element, speed):
    return any(row.shoulders for row in bearings_of(element.bearing))


def _is_linearised(element, speed):
    # A spherical outer ring tilts exactly; `arc_travel` says what the inner one lacks.
    linearised = isinstance(element.kinematics, Linearised)
    return linearised and not is_self_aligning(element.bearing)


def _is_linearised_barrel(element, speed):
    rows = list(bearings_of(element.bearing))
    barrels = all(isinstance(row, AbstractBarrelBearing) for row in rows)
    return barrels and isinstance(element.kinematics, Linearised)


def _is_spherical_thrust(element, speed):
    rows = list(bearings_of(element.bearing))
    return all(isinstance(row, SphericalThrustRollerBearing) for row in rows)


def _balls(count: float) -> str:
    return shown_count(round(count), "ball")


def _of_raceways(solution: Solution, concerned: Any) -> str:
    """Rolling elements and raceways in brackets; empty if there are none."""
    where = sizes.of_raceways(solution, concerned)
    return f" ({where})" if where else ""


SOLUTION_KINDS: dict[str, SolutionKind] = {
    "implausible_number": SolutionKind(
        0.0,
        "far outside the sizes of rolling bearings: {where}; are these SI units?",
        sizes.odd_names,
        "{:.0f} numbers of the design".format,
        size=sizes.implausible_dimensions,
    ),
    "no_stiffness": SolutionKind(
        0.0,
        "no stiffness in {where}: nothing holds it there, and its place is arbitrary",
        sizes.loose_names,
        "{:.0f} free directions".format,
        size=sizes.unrestrained_directions,
    ),
    "unloaded_row": SolutionKind(
        0.0,
        "{where} is unloaded: the other rows or their springs hold all",
        sizes.idle_numbers,
        "{:.0f} of the rows".format,
        applies=lambda element, _: len(rows_of(element.bearing)) > 1,
        size=sizes.unloaded_rows,
    ),
    "slack_spring": SolutionKind(
        0.0,
        "the spring of {where} is slack",
        sizes.slack_numbers,
        "{:.0f} of the rows".format,
        applies=lambda element, _: any(
            r.spring is not None for r in rows_of(element.bearing)
        ),
        size=sizes.slack_springs,
    ),
    "contact_pressure": SolutionKind(
        sizes.LARGEST_PRESSURE,
        "contact pressure of {size:.5g} MPa: beyond {limit:.0f} MPa steel is no longer"
        " elastic{where}",
        lambda s: _of_raceways(s, s.roller_pressure > sizes.LARGEST_PRESSURE),
        shown=lambda size: 1e-6 * size,
        size=lambda solution: solution.roller_pressure.max(),
    ),
    "static_limit": SolutionKind(
        1.0,
        "contact pressure {size:.4g} times that of the static load rating of ISO 76"
        "{where}",
        lambda s: f" ({1e-6 * sizes.static_limit(s.element.bearing):.0f} MPa)",
        size=lambda s: s.roller_pressure.max() / sizes.static_limit(s.element.bearing),
    ),
    "contact_width": SolutionKind(
        sizes.LARGEST_WIDTH,
        "half width of a contact {size:.2g} of its radius: Hertz's theory is for small"
        " strains, up to about {limit:g}",
        applies=_of_rollers,
        size=sizes.widths,
    ),
    "contact_ellipse": SolutionKind(
        sizes.LARGEST_ELLIPSE,
        "semi-axis of a contact ellipse {size:.2g} of the ball's radius: beyond"
        " {limit:g} Hertz's parabolas are a tenth off ball and groove",
        applies=_of_balls,
        size=sizes.ellipses,
    ),
    "contact_angle": SolutionKind(
        sizes.LARGEST_ANGLE,
        "contact angle {size:.3g} deg from the middle of the raceway: no groove goes so"
        " far; the ball would ride on the edge of its shoulder",
        shown=lambda size: 180.0 / np.pi * size,
        applies=_of_balls,
        size=sizes.groove_angles,
    ),
    "tilt": SolutionKind(
        sizes.LARGEST_TILT_ERROR,
        "tilt beyond small rotations: linearised kinematics leave out {size:.2g} % of"
        " {where} (finite kinematics do not)",
        lambda s: (
            "the motion"
            if {"gx", "gy"} <= set(s.free)
            else "the approach of the contacts, and loads err by about as much"
        ),
        lambda size: "the approach of the contacts, or of free motion",
        shown=lambda size: 100.0 * size,
        applies=_is_linearised,
        size=sizes.tilt_error,
    ),
    "arc_travel": SolutionKind(
        sizes.LARGEST_TILT_ERROR,
        "travel along barrel rollers: linearised kinematics leave out {size:.2g} % of"
        " the axial force (finite kinematics do not)",
        shown=lambda size: 100.0 * size,
        applies=_is_linearised_barrel,
        size=sizes.travel_error,
    ),
    "free_tilt": SolutionKind(
        1.0,
        "the ring tilts freely, {where}: if shaft and housing hold it straighter,"
        " prescribe gx and gy (in a scene's [operating]: prescribed = {{ gx ="
        ' "0 mrad", gy = "0 mrad" }}), or leave them out of `free`',
        lambda s: sizes.tilt_in_words(s, sizes.free_tilt(s)),
        "{:.3g} times what makers allow for".format,
        size=sizes.free_tilt,
    ),
    "prescribed_tilt": SolutionKind(
        1.0,
        "tilt of {where}",
        lambda s: sizes.tilt_in_words(s, sizes.prescribed_tilt(s)),
        "{:.3g} times what makers allow for".format,
        size=sizes.prescribed_tilt,
    ),
    "speed": SolutionKind(
        sizes.LARGEST_SPEED,
        "n·dm of {size:.3g} mm/min: most greases and oil baths end at {limit:.0e}"
        " mm/min; it takes oil jet or oil-air, and a cage made for it",
        applies=lambda _, speed: speed is not None,
        size=sizes.speed_factor,
    ),
    "negative_clearance": SolutionKind(
        0.0,
        "runs with a radial clearance of {size:.3g} µm: its rolling elements are"
        " pressed whatever the load, and harder as the inner ring warms",
        shown=lambda size: -1e6 * size,
        applies=lambda element, speed: (
            speed is not None and sizes.has_clearance(element.bearing)
        ),
        size=sizes.clearance_lost,
    ),
    "radial_share": SolutionKind(
        sizes.LARGEST_RADIAL_SHARE,
        "radial load of {size:.3g} times the axial one: beyond {limit:g} makers of"
        " spherical roller thrust bearings ask for another bearing that carries it",
        applies=_is_spherical_thrust,
        size=sizes.radial_share,
    ),
    "rib_interference": SolutionKind(
        0.0,
        "ribs press on the roller ends: {size:.4g} µm of interference, unloaded and"
        " centred",
        shown=lambda size: 1e6 * size,
        applies=_has_ribs,
        size=sizes.interference,
    ),
    "truncated_ellipse": SolutionKind(
        0.0,
        "truncated contact ellipse: it reaches over the shoulder by up to {size:.4g}"
        " µm; pressure and stiffness there are not Hertz's{where}",
        lambda s: f" ({sizes.truncated_balls(s)})",
        shown=lambda size: 1e6 * size,
        applies=_has_shoulder,
        size=sizes.truncation,
    ),
    "beyond_groove": SolutionKind(
        0.0,
        "balls beyond the bottom of the groove, on the cylindrical land beside it, with"
        f" more than {100.0 * sizes.LAND_SHARE:g} % of"
        " a contact's load: {where}; pressure and stiffness there are worked out with"
        " the curvature of the groove, a land presses harder and is softer",
        lambda s: sizes.of_raceways(s, sizes.load_beyond_groove(s)),
        _balls,
        applies=lambda element, _: any(
            isinstance(row.bearing, AngularContactBallBearing)
            for row in rows_of(element.bearing)
        ),
        size=sizes.on_land_count,
    ),
    "lifted_ball": SolutionKind(
        0.0,
        "lifted off the inner raceway by centrifugal force, more than"
        f" {100.0 * sizes.SMALLEST_LOAD:g} %"
        " of the largest load: {where}",
        lambda s: sizes.name_by_number(
            "ball", np.flatnonzero(sizes.balls_off_inner_ring(s))
        ),
        _balls,
        applies=lambda element, speed: _of_balls(element, speed) and speed is not None,
        size=sizes.lifted_count,
    ),
    "edge_loaded": SolutionKind(
        EDGE_PRESSURE,
        "edge-loaded roller: {size:.4g} MPa at the roller end, where the line-contact"
        " laws know no pressure peak{where}",
        lambda s: _of_raceways(s, sizes.ends_over(s).any(axis=2)),
        shown=lambda size: 1e-6 * size,
        applies=_of_rollers,
        size=sizes.edge_pressure,
    ),
}
"""Every kind of warning, by name, in the order in which they are reported."""

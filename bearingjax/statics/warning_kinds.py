"""Every kind of warning: a value of the solution, its limit and the text."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..design import (
    AbstractBallBearing,
    AbstractBarrelBearing,
    AbstractRollerBearing,
    AngularContactBallBearing,
    SphericalThrustRollerBearing,
    rows_of,
)
from ..design.bearing_set import bearings_of, is_self_aligning
from ..element.bearing_element import BearingElement
from ..element.choices import BallChoices, RollerChoices
from ..element.inertia import Speed
from ..element.kinematics import Linearised
from ..numerics.units import shown_count
from . import warning_sizes as sizes
from .rollers import EDGE_PRESSURE
from .solution import Solution


class Kind(NamedTuple):
    """A kind of warning.

    Attributes:
        applies: (element, speed) -> whether it can arise at all. Static.
        size: Solution -> size of the warning, a scalar.
        limit: Largest size that gives no warning, in the unit of `size`.
        text: The sentence with `{size}`, `{limit}` and `{where}`.
        where: Concrete solution -> the rows, elements or numbers concerned, in words.
        many: Size -> the words in place of those of `where` for many cases.
        factor: Factor of size and limit in the text.
        of_all: Whether it is reported only if it applies to all cases.
    """

    applies: Callable[[BearingElement, Speed | None], bool]
    size: Callable[[Solution], Any]
    limit: float
    text: str
    where: Callable[[Solution], str] = lambda solution: ""
    many: Callable[[float], str] = lambda size: ""
    factor: float = 1.0
    of_all: bool = False

    def words(self, size: float, where: str) -> str:
        """Return the sentence about a size.

        Args:
            size: Size of the warning.
            where: From `where`; "" for many cases.
        """
        size, limit = self.factor * size, self.factor * self.limit
        where = where or self.many(size)
        return self.text.format(size=size, limit=limit, where=where)


def _always(element, speed):
    return True


def _of_balls(element, speed):
    return isinstance(element.choices, BallChoices)


def _of_rollers(element, speed):
    return isinstance(element.choices, RollerChoices)


def _has_ribs(element, speed):
    bearings = list(bearings_of(element.bearing))
    rollers = [b for b in bearings if isinstance(b, AbstractRollerBearing)]
    return any(bearing.ribs.present for bearing in rollers)


def _has_shoulder(element, speed):
    bearings = list(bearings_of(element.bearing))
    balls = [b for b in bearings if isinstance(b, AbstractBallBearing)]
    shoulders = [s for b in balls for s in (b.outer_shoulder, b.inner_shoulder)]
    return any(shoulder is not None for shoulder in shoulders)


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


KINDS: dict[str, Kind] = {
    "implausible_number": Kind(
        _always,
        sizes.implausible_dimensions,
        0.0,
        "far outside the sizes of rolling bearings: {where}; are these SI units?",
        sizes.odd_names,
        "{:.0f} numbers of the design".format,
    ),
    "no_stiffness": Kind(
        _always,
        sizes.unrestrained_directions,
        0.0,
        "no stiffness in {where}: nothing holds it there, and its place is arbitrary",
        sizes.loose_names,
        "{:.0f} free directions".format,
    ),
    "unloaded_row": Kind(
        lambda element, _: len(rows_of(element.bearing)) > 1,
        sizes.unloaded_rows,
        0.0,
        "{where} is unloaded: the other rows or their springs hold all",
        sizes.idle_numbers,
        "{:.0f} of the rows".format,
    ),
    "slack_spring": Kind(
        lambda element, _: any(r.spring is not None for r in rows_of(element.bearing)),
        sizes.slack_springs,
        0.0,
        "the spring of {where} is slack",
        sizes.slack_numbers,
        "{:.0f} of the rows".format,
    ),
    "contact_pressure": Kind(
        _always,
        lambda solution: solution.roller_pressure.max(),
        sizes.LARGEST_PRESSURE,
        "contact pressure of {size:.5g} MPa: beyond {limit:.0f} MPa steel is no longer"
        " elastic{where}",
        lambda s: _of_raceways(s, s.roller_pressure > sizes.LARGEST_PRESSURE),
        factor=1e-6,
    ),
    "static_limit": Kind(
        _always,
        lambda s: s.roller_pressure.max() / sizes.static_limit(s.element.bearing),
        1.0,
        "contact pressure {size:.4g} times that of the static load rating of ISO 76"
        "{where}",
        lambda s: f" ({1e-6 * sizes.static_limit(s.element.bearing):.0f} MPa)",
    ),
    "contact_width": Kind(
        _of_rollers,
        sizes.widths,
        sizes.LARGEST_WIDTH,
        "half width of a contact {size:.2g} of its radius: Hertz's theory is for small"
        " strains, up to about {limit:g}",
    ),
    "contact_ellipse": Kind(
        _of_balls,
        sizes.ellipses,
        sizes.LARGEST_ELLIPSE,
        "semi-axis of a contact ellipse {size:.2g} of the ball's radius: beyond"
        " {limit:g} Hertz's parabolas are a tenth off ball and groove",
    ),
    "contact_angle": Kind(
        _of_balls,
        sizes.groove_angles,
        sizes.LARGEST_ANGLE,
        "contact angle {size:.3g} deg from the middle of the raceway: no groove goes so"
        " far; the ball would ride on the edge of its shoulder",
        factor=180.0 / np.pi,
    ),
    "tilt": Kind(
        _is_linearised,
        sizes.tilt_error,
        sizes.LARGEST_TILT_ERROR,
        "tilt beyond small rotations: linearised kinematics leave out {size:.2g} % of"
        " {where} (Finite() kinematics do not)",
        lambda s: (
            "the motion"
            if {"gx", "gy"} <= set(s.free)
            else "the approach of the contacts, and loads err by about as much"
        ),
        lambda size: "the approach of the contacts, or of free motion",
        factor=100.0,
    ),
    "arc_travel": Kind(
        _is_linearised_barrel,
        sizes.travel_error,
        sizes.LARGEST_TILT_ERROR,
        "travel along barrel rollers: linearised kinematics leave out {size:.2g} % of"
        " the axial force (Finite() kinematics do not)",
        factor=100.0,
    ),
    "free_tilt": Kind(
        _always,
        sizes.free_tilt,
        1.0,
        "the ring tilts freely, {where}: if shaft and housing hold it straighter,"
        " prescribe gx and gy (in a scene's [operating]: prescribed = {{ gx ="
        ' "0 mrad", gy = "0 mrad" }}), or leave them out of `free`',
        lambda s: sizes.tilt_in_words(s, sizes.free_tilt(s)),
        "{:.3g} times what makers allow for".format,
    ),
    "prescribed_tilt": Kind(
        _always,
        sizes.prescribed_tilt,
        1.0,
        "tilt of {where}",
        lambda s: sizes.tilt_in_words(s, sizes.prescribed_tilt(s)),
        "{:.3g} times what makers allow for".format,
    ),
    "speed": Kind(
        lambda _, speed: speed is not None,
        sizes.speed_factor,
        sizes.LARGEST_SPEED,
        "n·dm of {size:.3g} mm/min: most greases and oil baths end at {limit:.0e}"
        " mm/min; it takes oil jet or oil-air, and a cage made for it",
    ),
    "negative_clearance": Kind(
        lambda element, speed: (
            speed is not None and sizes.has_clearance(element.bearing)
        ),
        sizes.clearance_lost,
        0.0,
        "runs with a radial clearance of {size:.3g} µm: its rolling elements are"
        " pressed whatever the load, and harder as the inner ring warms",
        factor=-1e6,
    ),
    "radial_share": Kind(
        _is_spherical_thrust,
        sizes.radial_share,
        sizes.LARGEST_RADIAL_SHARE,
        "radial load of {size:.3g} times the axial one: beyond {limit:g} makers of"
        " spherical roller thrust bearings ask for another bearing that carries it",
    ),
    "rib_interference": Kind(
        _has_ribs,
        sizes.interference,
        0.0,
        "ribs press on the roller ends: {size:.4g} µm of interference, unloaded and"
        " centred",
        factor=1e6,
    ),
    "truncated_ellipse": Kind(
        _has_shoulder,
        sizes.truncation,
        0.0,
        "truncated contact ellipse: it reaches over the shoulder by up to {size:.4g}"
        " µm; pressure and stiffness there are not Hertz's{where}",
        lambda s: f" ({sizes.truncated_balls(s)})",
        factor=1e6,
    ),
    "beyond_groove": Kind(
        lambda element, _: any(
            isinstance(row.bearing, AngularContactBallBearing)
            for row in rows_of(element.bearing)
        ),
        sizes.on_land_count,
        0.0,
        "balls beyond the bottom of the groove, on the cylindrical land beside it, with"
        f" more than {100.0 * sizes.LAND_SHARE:g} % of"
        " a contact's load: {where}; pressure and stiffness there are worked out with"
        " the curvature of the groove, a land presses harder and is softer",
        lambda s: sizes.of_raceways(s, sizes.load_beyond_groove(s)),
        _balls,
    ),
    "lifted_ball": Kind(
        lambda element, speed: _of_balls(element, speed) and speed is not None,
        sizes.lifted_count,
        0.0,
        "lifted off the inner raceway by centrifugal force, more than"
        f" {100.0 * sizes.SMALLEST_LOAD:g} %"
        " of the largest load: {where}",
        lambda s: sizes.name_by_number(
            "ball", np.flatnonzero(sizes.balls_off_inner_ring(s))
        ),
        _balls,
    ),
    "edge_loaded": Kind(
        _of_rollers,
        sizes.edge_pressure,
        EDGE_PRESSURE,
        "edge-loaded roller: {size:.4g} MPa at the roller end, where the line-contact"
        " laws know no pressure peak{where}",
        lambda s: _of_raceways(s, sizes.ends_over(s).any(axis=2)),
        factor=1e-6,
    ),
}
"""Every kind of warning, by name, in the order in which they are reported."""

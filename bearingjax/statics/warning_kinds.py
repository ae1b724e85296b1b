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
    bearings_of,
    is_self_aligning,
    rows_of,
)
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
        words: (size, where) -> the sentence; where is "" for many cases.
        where: Concrete solution -> the rows, elements or numbers concerned, in words.
    """

    applies: Callable[[BearingElement, Speed | None], bool]
    size: Callable[[Solution], Any]
    limit: float
    words: Callable[[float, str], str]
    where: Callable[[Solution], str] = lambda solution: ""


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


def _in_brackets(where):
    return f" ({where})" if where else ""


def _odd_words(size, where):
    what = where or f"{size:.0f} numbers of the design"
    return f"far outside the sizes of rolling bearings: {what}; are these SI units?"


def _loose_words(size, where):
    what = where or f"{size:.0f} free directions"
    return f"no stiffness in {what}: nothing holds it there, and its place is arbitrary"


def _idle_words(size, where):
    what = where or f"{size:.0f} of the rows"
    return f"{what} is unloaded: the other rows or their springs hold all"


def _spring_words(size, where):
    return f"the spring of {where or f'{size:.0f} of the rows'} is slack"


def _pressure_words(size, where):
    return (
        f"contact pressure of {1e-6 * size:.5g} MPa: beyond"
        f" {1e-6 * sizes.LARGEST_PRESSURE:.0f} MPa steel is no longer elastic"
        f"{_in_brackets(where)}"
    )


def _static_words(size, where):
    return (
        f"contact pressure {size:.4g} times that of the static load rating of ISO 76"
        f"{_in_brackets(where)}"
    )


def _width_words(size, where):
    return (
        f"half width of a contact {size:.2g} of its radius: Hertz's theory is for small"
        f" strains, up to about {sizes.LARGEST_WIDTH:g}"
    )


def _ellipse_words(size, where):
    return (
        f"semi-axis of a contact ellipse {size:.2g} of the ball's radius: beyond"
        f" {sizes.LARGEST_ELLIPSE:g} Hertz's parabolas are a tenth off ball and groove"
    )


def _groove_words(size, where):
    return (
        f"contact angle {np.rad2deg(size):.3g} deg from the middle of the raceway: no"
        " groove goes so far; the ball would ride on the edge of its shoulder"
    )


def _tilt_words(size, where):
    what = where or "the approach of the contacts, or of free motion"
    return (
        "tilt beyond small rotations: linearised kinematics leave out"
        f" {100.0 * size:.2g} % of {what} (Finite() kinematics do not)"
    )


def _travel_words(size, where):
    return (
        "travel along barrel rollers: linearised kinematics leave out"
        f" {100 * size:.2g} % of the axial force (Finite() kinematics do not)"
    )


def _free_tilt_words(size, where):
    what = where or f"{size:.3g} times what makers allow for"
    return (
        f"the ring tilts freely, {what}: if shaft and housing hold it straighter,"
        ' prescribe gx and gy (in a scene\'s [operating]: prescribed = { gx = "0 mrad",'
        ' gy = "0 mrad" }), or leave them out of `free`'
    )


def _prescribed_tilt_words(size, where):
    return f"tilt of {where or f'{size:.3g} times what makers allow for'}"


def _radial_words(size, where):
    return (
        f"radial load of {size:.3g} times the axial one: beyond"
        f" {sizes.LARGEST_RADIAL_SHARE:g} makers of spherical roller thrust bearings"
        " ask for another bearing that carries it"
    )


def _clearance_words(size, where):
    return (
        f"runs with a radial clearance of {-1e6 * size:.3g} µm: its rolling elements"
        " are pressed whatever the load, and harder as the inner ring warms"
    )


def _speed_words(size, where):
    return (
        f"n·dm of {size:.3g} mm/min: most greases and oil baths end at"
        f" {sizes.LARGEST_SPEED:.0e} mm/min; it takes oil jet or oil-air, and a cage"
        " made for it"
    )


def _rib_words(size, where):
    return (
        f"ribs press on the roller ends: {1e6 * size:.4g} µm of interference, unloaded"
        " and centred"
    )


def _truncated_words(size, where):
    return (
        "truncated contact ellipse: it reaches over the shoulder by up to"
        f" {1e6 * size:.4g} µm; pressure and stiffness there are not Hertz's"
        f"{_in_brackets(where)}"
    )


def _land_words(size, where):
    return (
        "balls beyond the bottom of the groove, on the cylindrical land beside it, with"
        f" more than {100.0 * sizes.LAND_SHARE:g} % of a contact's load:"
        f" {where or shown_count(round(size), 'ball')}; pressure and stiffness there"
        " are worked out with the curvature of the groove, a land presses harder and is"
        " softer"
    )


def _lifted_words(size, where):
    return (
        "lifted off the inner raceway by centrifugal force, more than"
        f" {100.0 * sizes.SMALLEST_LOAD:g} % of the largest load: "
        f"{where or shown_count(round(size), 'ball')}"
    )


def _edge_words(size, where):
    return (
        f"edge-loaded roller: {1e-6 * size:.4g} MPa at the roller end, where the"
        f" line-contact laws know no pressure peak{_in_brackets(where)}"
    )


KINDS: dict[str, Kind] = {
    "implausible_number": Kind(
        _always, sizes.oddities, 0.0, _odd_words, sizes.odd_names
    ),
    "no_stiffness": Kind(_always, sizes.loose, 0.0, _loose_words, sizes.loose_names),
    "unloaded_row": Kind(
        lambda element, _: len(rows_of(element.bearing)) > 1,
        sizes.idle_rows,
        0.0,
        _idle_words,
        sizes.idle_numbers,
    ),
    "slack_spring": Kind(
        lambda element, _: any(r.spring is not None for r in rows_of(element.bearing)),
        sizes.slack_springs,
        0.0,
        _spring_words,
        sizes.slack_numbers,
    ),
    "contact_pressure": Kind(
        _always,
        lambda solution: solution.roller_pressure.max(),
        sizes.LARGEST_PRESSURE,
        _pressure_words,
        lambda s: sizes.of_raceways(s, s.roller_pressure > sizes.LARGEST_PRESSURE),
    ),
    "static_limit": Kind(
        _always,
        lambda s: s.roller_pressure.max() / sizes.static_limit(s.element.bearing),
        1.0,
        _static_words,
        lambda s: f"{1e-6 * sizes.static_limit(s.element.bearing):.0f} MPa",
    ),
    "contact_width": Kind(_of_rollers, sizes.widths, sizes.LARGEST_WIDTH, _width_words),
    "contact_ellipse": Kind(
        _of_balls, sizes.ellipses, sizes.LARGEST_ELLIPSE, _ellipse_words
    ),
    "contact_angle": Kind(
        _of_balls, sizes.groove_angles, sizes.LARGEST_ANGLE, _groove_words
    ),
    "tilt": Kind(
        _is_linearised,
        sizes.tilt_error,
        sizes.LARGEST_TILT_ERROR,
        _tilt_words,
        lambda s: (
            "the motion"
            if {"gx", "gy"} <= set(s.free)
            else "the approach of the contacts, and loads err by about as much"
        ),
    ),
    "arc_travel": Kind(
        _is_linearised_barrel,
        sizes.travel_error,
        sizes.LARGEST_TILT_ERROR,
        _travel_words,
    ),
    "free_tilt": Kind(
        _always,
        sizes.free_tilt,
        1.0,
        _free_tilt_words,
        lambda s: sizes.tilt_in_words(s, sizes.free_tilt(s)),
    ),
    "prescribed_tilt": Kind(
        _always,
        sizes.prescribed_tilt,
        1.0,
        _prescribed_tilt_words,
        lambda s: sizes.tilt_in_words(s, sizes.prescribed_tilt(s)),
    ),
    "speed": Kind(
        lambda _, speed: speed is not None,
        sizes.speed_factor,
        sizes.LARGEST_SPEED,
        _speed_words,
    ),
    "negative_clearance": Kind(
        lambda element, speed: (
            speed is not None and sizes.has_clearance(element.bearing)
        ),
        sizes.clearance_lost,
        0.0,
        _clearance_words,
    ),
    "radial_share": Kind(
        _is_spherical_thrust,
        sizes.radial_share,
        sizes.LARGEST_RADIAL_SHARE,
        _radial_words,
    ),
    "rib_interference": Kind(_has_ribs, sizes.interference, 0.0, _rib_words),
    "truncated_ellipse": Kind(
        _has_shoulder,
        sizes.truncation,
        0.0,
        _truncated_words,
        sizes.truncated_balls,
    ),
    "beyond_groove": Kind(
        lambda element, _: any(
            isinstance(row.bearing, AngularContactBallBearing)
            for row in rows_of(element.bearing)
        ),
        sizes.on_land_count,
        0.0,
        _land_words,
        lambda s: sizes.of_raceways(s, sizes.on_land(s)),
    ),
    "lifted_ball": Kind(
        lambda element, speed: _of_balls(element, speed) and speed is not None,
        sizes.lifted_count,
        0.0,
        _lifted_words,
        lambda s: sizes.numbered("ball", np.flatnonzero(sizes.lifted(s))),
    ),
    "edge_loaded": Kind(
        _of_rollers,
        sizes.edge_pressure,
        EDGE_PRESSURE,
        _edge_words,
        lambda s: sizes.of_raceways(s, sizes.ends_over(s)),
    ),
}
"""Every kind of warning, by name, in the order in which they are reported."""

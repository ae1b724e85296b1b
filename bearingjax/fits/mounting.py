"""Mounted bearings, with the radial clearance that remains after fitting.

Fits, temperatures and speed change the radial distance of the raceways, and in a set
the axial distances of the inner and of the outer rings. Growth of the rolling elements
beyond that of their rings reduces clearance along the contact normals. Other changes
are neglected: pitch and ball diameters, by a ten thousandth.
"""

from dataclasses import replace
from typing import Any

import jax.numpy as jnp

from ..design import AngularContactBallBearing, BearingSet, SetRow, rows_of
from ..design.bearing_set import AbstractBearing, shares_rings
from ..design.checks import number, of_class
from ..numerics.types import Scalar, as_real
from .fits import AxialStrains, FitConditions, FitState, Mounting, fit_state


def raceway_diameters(bearing: AbstractBearing) -> tuple[Scalar, Scalar]:
    """Diameters up to which the rings of a row count as thick-walled cylinders [m].

    Of deep groove bearings and cylindrical rollers, at the bottom of the raceways. Of
    other balls, where they touch at the free contact angle: near the mean thickness of
    a ring whose shoulders differ. Of tapered rollers, in their middle.

    Returns:
        Inner and outer raceway.

    Raises:
        TypeError: If it is a thrust bearing or no bearing.
    """
    check_radial("raceway_diameters", bearing)
    return bearing.raceway_diameters


def radial_clearance(bearing: AbstractBearing) -> Scalar:
    """Radial internal clearance of a row, between the ends of its radial play [m].

    Of angular contact bearings 2A (1 - cos α0), A the distance of the groove centres.
    A tapered roller stays with the inner ring and its large rib. Radial motion of the
    outer ring closes the gap by the cosine of the outer raceway's angle.

    Args:
        bearing: One row.

    Raises:
        TypeError: If it is a thrust bearing or no bearing.
    """
    check_radial("radial_clearance", bearing)
    return bearing.clearance


def with_radial_clearance(bearing: AbstractBearing, clearance: Any) -> Any:
    """Return the row with another radial internal clearance.

    Of an angular contact bearing it is the free contact angle that changes: grooves
    that come nearer radially are met at a smaller angle.

    Args:
        bearing: One row.
        clearance: Radial internal clearance as in `radial_clearance` [m].

    Raises:
        TypeError: As `radial_clearance`.
        ValueError: If the bearing does not allow it: an angular contact bearing needs
            some, or there is no contact angle.
    """
    check_radial("with_radial_clearance", bearing)
    clearance = as_real(clearance)
    number("with_radial_clearance", "clearance", clearance, "m")
    return bearing.with_clearance(clearance)


def with_bearing_dimensions(
    mounting: Mounting, bearing: AbstractBearing | BearingSet
) -> Mounting:
    """Return the mounting with the sizes of a bearing where its own are `None`.

    Args:
        mounting: The seats.
        bearing: A row, or a set, whose first row counts.

    Raises:
        TypeError: As `radial_clearance`.
        ValueError: If the rings are not thicker than the raceways.
    """
    of_class("sized", "mounting", mounting, Mounting, "a Mounting")
    row = rows_of(bearing)[0].bearing
    inner, outer = raceway_diameters(row)
    own = {
        "inner_raceway": inner,
        "outer_raceway": outer,
        "radial_clearance": radial_clearance(row),
        "contact_angle": row.touching_angle,
    }
    missing = {k: v for k, v in own.items() if getattr(mounting, k) is None}
    return replace(mounting, **missing)


def mount(
    bearing: AbstractBearing | BearingSet,
    mounting: Mounting,
    conditions: FitConditions | None = None,
) -> Any:
    """Return the bearing with its clearance after fits, temperatures and speed.

    Load ratings stay those of the drawing (`rated_contact_angle`).

    Differentiable with respect to every number. A clearance below zero is preload, with
    which any load solve goes on; only angular contact bearings need some clearance.

    In a set the rows of angular contact are preloaded more, or less: the balls touch
    elsewhere, and the rings stay where they are on shaft and in housing (`inner_offset`
    takes the difference of A sin α0, and what warm balls grow along the axis). And what
    grows between the rows, on the shaft and in the housing, moves their rings against
    each other (`row_shifts`). Set its preload first, `preload` being that of the
    bearings as they are ground. Of one row, displacements count from where the mounted
    balls touch.

    Args:
        bearing: One row or a set, of a radial type.
        mounting: Its seats; sizes that are `None` are those of the bearing, in a set of
            each row.
        conditions: Temperatures and speed; `None`: mounted, at rest, at the temperature
            of the measured sizes.

    Returns:
        Bearing of the same type.

    Raises:
        TypeError: For thrust bearings and values that are not bearings.
        ValueError: If the rings are not thicker than the raceways, or as
            `with_radial_clearance` and `row_shifts`.
    """
    if not isinstance(bearing, BearingSet):
        return _on_seats(
            bearing, fit_state(with_bearing_dimensions(mounting, bearing), conditions)
        )
    states = _states(bearing, mounting, conditions)
    shifts = _shifts(bearing, mounting, states)
    parts = zip(bearing.rows, states, shifts, strict=True)
    return BearingSet(tuple(_mounted_row(*part) for part in parts))


def _states(bearing: BearingSet, mounting, conditions) -> list[FitState]:
    """Fit state of each row of a set."""
    return [
        fit_state(with_bearing_dimensions(mounting, row.bearing), conditions)
        for row in bearing.rows
    ]


def _on_seats(bearing: AbstractBearing, state: FitState) -> Any:
    """Return a row with its clearance after fits."""
    # Load ratings are made with the angle of the drawing, whatever the fits.
    return with_radial_clearance(bearing, state.radial_clearance).rated_as(bearing)


def _mounted_row(row: SetRow, state: FitState, shift) -> SetRow:
    nearer = axial_approach(row.bearing, state)
    # A row is pressed by its inner ring moving along +z; mirrored, along -z.
    offset = row.inner_offset + shift + (-nearer if row.mirrored else nearer)
    return replace(row, bearing=_on_seats(row.bearing, state), inner_offset=offset)


def axial_approach(bearing: Any, state: FitState) -> Any:
    """Return how far the place where a row touches comes nearer along the axis [m]: of
    angular contact, whose displacements count from there. Others count from a place of
    their rings: 0. The row is as drawn; its state is that of its own sizes."""
    if not isinstance(bearing, AngularContactBallBearing):
        return 0.0
    sine = jnp.sin(_on_seats(bearing, state).free_contact_angle)
    # Balls that grow bring the groove centres nearer: by what is radial of it the
    # free angle has changed, the rest is axial.
    nearer = bearing.ball_diameter * state.element_strain * sine
    change = jnp.sin(bearing.free_contact_angle) - sine
    return nearer + bearing.centre_distance * change


def row_shifts(
    bearing: BearingSet,
    mounting: Mounting,
    conditions: FitConditions | None = None,
) -> list[Any]:
    """Shift of each inner ring against its outer ring, as the parts between rows grow.

    From the middle of a row rings reach half of their width; between them is only
    shaft, or housing. Inner rings keep their places on the shaft and outer ones
    theirs in the housing, whether against shoulders or clamped one against the other.
    The mean of all places stays where it is: only differences press rows.

    Args:
        bearing: A set.
        mounting: Its seats, as in `mount`.
        conditions: Temperatures and speeds, as in `mount`.

    Returns:
        Of each row, along +z of the set [m]; 0 of a bearing whose rows share both
        rings (`shares_rings`).

    Raises:
        ValueError: If `mounting.ring_width` is `None`.
    """
    return _shifts(bearing, mounting, _states(bearing, mounting, conditions))


def _shifts(bearing: BearingSet, mounting, states: list[FitState]) -> list[Any]:
    """Row shifts as in `row_shifts`, from the fit state of each row."""
    if shares_rings(bearing):
        return [0.0] * len(bearing.rows)
    width = mounting.ring_width
    if width is None:
        raise ValueError(
            "Mounting: `ring_width` is None; a set needs it: between its rows the rings"
            " grow over this length, beyond it shaft and housing."
        )
    places = jnp.stack([row.position for row in bearing.rows])
    strains = zip(*(state.strains for state in states), strict=True)
    parts = AxialStrains(*(jnp.stack(values) for values in strains))
    inner = _growth(places, width, parts.inner_ring, parts.shaft)
    outer = _growth(places, width, parts.outer_ring, parts.housing)
    return list(inner - outer)


def _growth(places, width, rings, seats):
    """Shift of rows as the parts between neighbours grow, with constant mean [m]."""
    order = jnp.argsort(places)
    gaps = jnp.diff(places[order])
    rings, seats = (0.5 * (x[order][1:] + x[order][:-1]) for x in (rings, seats))
    within = jnp.minimum(gaps, width)
    steps = rings * within + seats * (gaps - within)
    grown = jnp.concatenate([jnp.zeros(1, places.dtype), jnp.cumsum(steps)])
    return (grown - jnp.mean(grown))[jnp.argsort(order)]


def check_radial(owner: str, bearing: Any) -> None:
    """Raise unless fits change the radial clearance of a row.

    Raises:
        TypeError: If it is a thrust bearing or no single row.
    """
    kinds = () if getattr(bearing, "is_thrust", False) else AbstractBearing
    of_class(owner, "bearing", bearing, kinds, "a radial ball or roller bearing")

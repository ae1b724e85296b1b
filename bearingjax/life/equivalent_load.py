"""Equivalent load of a bearing: one load in place of a radial and an axial one.

P of ISO 281 is the load with which the basic rating life is computed, P0 of ISO 76 that
which is compared with the static rating. Both are greatest values of X Fr + Y Fa.
ISO 281 passes from one pair of factors to the other at Fa/Fr = e, where its rounded
factors leave a step of up to 2 %; the greatest value of both pairs has none.

Moments, speeds and clearance are not in it: the reference rating life has them
(`left_out`). Only crossed roller bearings count a moment, as 2 M/D_pw beside Fr.

How far the tables are confirmed, number by number: deep groove and 10 degrees by SKF
(normal and C3 clearance); 15, 25 and 40 degrees, single and double, dynamic and static,
by Luoyang Bearing (LYC), 15 degrees by SKF too (C4); double rows of 30 and 35 degrees
by LYC, the latter by SKF as well, of four-point bearings; tapers by e, Y and Y0 of NSK;
crossed rollers, the double rows of 45 degrees, by THK, IKO and Harmonic Drive.
5, 20 and 45 degrees, and all others again, agree with the theory they were made by
(ISO/TR 1281-1, 7.2) to their last digit; Y0 of 5, 10, 20 and 45 degrees was found
nowhere but in the standard.
"""

from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import (
    AbstractBallBearing,
    AbstractBearing,
    AbstractRollerBearing,
    AngularContactBallBearing,
    BearingSet,
    FourPointBallBearing,
    SelfAligningBallRow,
    rows_of,
)
from ..design.abstract import nearest_entry
from ..design.checks import of_shape
from ..numerics.linear import lengths
from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .rating import published_factors, rated_axially

# Fa/(Z D²) in MPa, and Y of a single row, Y1, Y2 of two, at each (ISO 281, table 3).
_RELATIVE = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
_DEEP_GROOVE = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)
_ANGLES = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0)
_X = (0.56, 0.46, 0.44, 0.43, 0.41, 0.39, 0.37, 0.35, 0.33)
_X2 = (0.78, 0.75, 0.72, 0.70, 0.67, 0.63, 0.60, 0.57, 0.54)
_STEEP = {
    "y": (1.00, 0.87, 0.76, 0.66, 0.57, 0.50),
    "y1": (1.09, 0.92, 0.78, 0.66, 0.55, 0.47),
    "y2": (1.63, 1.41, 1.24, 1.07, 0.93, 0.81),
}
_FLAT = {
    "y": (
        _DEEP_GROOVE,
        (1.88, 1.71, 1.52, 1.41, 1.34, 1.23, 1.10, 1.01, 1.00),
        (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00),
    ),
    "y1": (
        (2.78, 2.40, 2.07, 1.87, 1.75, 1.58, 1.39, 1.26, 1.21),
        (2.18, 1.98, 1.76, 1.63, 1.55, 1.42, 1.27, 1.17, 1.16),
        (1.65, 1.57, 1.46, 1.38, 1.34, 1.26, 1.14, 1.12, 1.12),
    ),
    "y2": (
        (3.74, 3.23, 2.78, 2.52, 2.36, 2.13, 1.87, 1.69, 1.63),
        (3.06, 2.78, 2.47, 2.29, 2.18, 2.00, 1.79, 1.64, 1.63),
        (2.39, 2.28, 2.11, 2.00, 1.93, 1.82, 1.66, 1.63, 1.63),
    ),
}
# Static factors of ISO 76: a single row has X0 = 0.5, two have 1.
_Y0 = (0.52, 0.50, 0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22)
_Y0_DOUBLE = (1.04, 1.00, 0.92, 0.84, 0.76, 0.66, 0.58, 0.52, 0.44)


class Factors(NamedTuple):
    """Factors of radial and axial load: P is the greatest of X Fr + Y Fa.

    Attributes:
        dynamic: Rows (X, Y) of ISO 281 (pair, 2) [1].
        static: Rows (X0, Y0) of ISO 76 (pair, 2) [1].
    """

    dynamic: Annotated[Float[Array, "pair 2"], unit("1")]
    static: Annotated[Float[Array, "pair 2"], unit("1")]


class EquivalentLoad(NamedTuple):
    """Equivalent loads.

    Attributes:
        dynamic: P of ISO 281 [N].
        static: P0 of ISO 76 [N].
    """

    dynamic: Annotated[Scalar, unit("N")]
    static: Annotated[Scalar, unit("N")]


def equivalent_load(
    bearing: AbstractBearing | BearingSet, load: Float[Array | np.ndarray, "..."]
) -> EquivalentLoad:
    """Equivalent dynamic and static load of a bearing or of a set of like rows.

    Args:
        bearing: The design. A set whose rows carry axial load in both directions
            counts as a double-row bearing, one of rows in tandem as single rows side
            by side.
        load: On the moving ring (6,) [N, N m]; the moments do not count but of crossed
            rollers, nor does axial load of rollers without a contact angle.

    Returns:
        P and P0: axial loads of thrust bearings, else radial ones; NaN if a force is.

    Raises:
        ValueError: If `load` is not of shape (6,), or the rows of a set are unlike.

    Source: ISO 281:2007, tables 3, 4, 7 and 9; ISO 76:2006, tables 2 and 3, and its
        formulas for thrust bearings.
    """
    load = as_real(load)
    allowed = "(6,): Fx Fy Fz Mx My Mz in N, N m"
    of_shape("equivalent_load", "load", load.shape == (6,), allowed, load)
    radial = lengths(load[:2])
    if _is_crossed(bearing):
        pitch = rows_of(bearing)[0].bearing.pitch_diameter
        radial = radial + 2.0 * lengths(load[3:5]) / pitch
    axial = jnp.abs(load[2])
    factors = load_factors(bearing, axial)
    both = jnp.stack([radial, axial])
    return EquivalentLoad(
        jnp.max(jnp.sum(factors.dynamic * both[None], axis=1)),
        jnp.max(jnp.sum(factors.static * both[None], axis=1)),
    )


class LeftOut(NamedTuple):
    """Parts of a load that the equivalent loads leave out.

    Attributes:
        radial: Load of thrust bearings at 90°, without factor in ISO 281 [N].
        axial: Axial load of rollers without a contact angle: cylindrical and needle
            rollers, whose ribs bear it, and shifted toroidal rollers [N].
        moment: Moment about the pressure centre, the intersection of contact normals
            and axis, along the tilts that are free; none of crossed rollers [N m].
    """

    radial: Annotated[Scalar, unit("N")]
    axial: Annotated[Scalar, unit("N")]
    moment: Annotated[Scalar, unit("N m")]


def left_out(
    bearing: AbstractBearing | BearingSet,
    load: Float[Array, "6"],
    free: Sequence[str] = ("gx", "gy"),
) -> LeftOut:
    """Return the parts of a load that its equivalent loads leave out.

    Args:
        bearing, load: As in `equivalent_load`; moments about the centre of the bearing.
        free: Freedoms that follow from the load. A tilt that is held bears a moment of
            its support: the standard too takes rings that are held parallel.
    """
    rows = rows_of(bearing)
    row: Any = rows[0].bearing
    angle = row.nominal_contact_angle
    flat = _is_flat(angle)
    straight = jnp.where(angle > 0, 0.0, nearest_entry(_LEFT_OUT, row))
    below = jnp.where(flat, 0.0, angle)
    reach = 0.5 * row.pitch_diameter * jnp.tan(below) - row.axial_place
    places = [r.position + (reach if r.mirrored else -reach) for r in rows]
    # Of a bearing that is rated axially it is far away, but for the centre of a sphere.
    far = flat if row.tilts_alone else rated_axially(bearing)
    centre = jnp.where(far, 0.0, sum(places) / len(rows))
    across = load[3:5] + centre * jnp.stack([load[1], -load[0]])
    across = across * jnp.asarray([name in free for name in ("gx", "gy")], load.dtype)
    return LeftOut(
        lengths(load[:2]) * jnp.where(flat, 1.0, 0.0),
        jnp.abs(load[2]) * straight,
        lengths(across) * (0.0 if _is_crossed(bearing) else 1.0),
    )


def _is_crossed(bearing) -> bool:
    """Whether it has crossed rollers of both orientations."""
    rows = rows_of(bearing)
    crossed = all(row.bearing.is_crossed for row in rows)
    return crossed and len({row.mirrored for row in rows}) == 2


def _is_flat(angle):
    """Whether a contact angle is 90 degrees: the row carries no radial load."""
    return angle > 0.5 * np.pi - 1e-5


def load_factors(bearing: AbstractBearing | BearingSet, axial: Scalar) -> Factors:
    """Factors of ISO 281 and ISO 76 of a bearing or of a set of like rows.

    Self-aligning ball bearings and spherical roller bearings of the catalogue have the
    factors of axial load that it prints: those of the former are up to a sixth larger
    than their estimated contact angles give.

    Args:
        bearing: The design.
        axial: Axial load, on which those of small contact angles depend [N].
    """
    rows = rows_of(bearing)
    row = rows[0].bearing
    turned = sum(row.mirrored for row in rows)
    double = 0 < turned < len(rows)
    angle = row.nominal_contact_angle
    # Rows that share the axial load: all of radial contact, else those of a side.
    sharing = len(rows), max(turned, len(rows) - turned)
    radial = nearest_entry(_RADIAL, row)(row, angle, double, sharing, axial)
    printed = published_factors(bearing)
    if printed is not None:
        y1, y2, y0 = printed[0]
        own = jnp.stack([y1, y2]), jnp.stack([y0, jnp.zeros_like(y0)])
        radial = tuple(
            factors.at[:, 1].set(jnp.where(printed[1], y, factors[:, 1]))
            for factors, y in zip(radial, own, strict=True)
        )
    # At 90 degrees it carries no radial load at all.
    alone = jnp.stack([jnp.zeros_like(angle), jnp.ones_like(angle)])[None]
    thrust = [
        jnp.where(_is_flat(angle), alone, factors)
        for factors in _of_thrust(angle, nearest_entry(_FIRST, row), double)
    ]
    steep = rated_axially(bearing)
    return Factors(
        *(jnp.where(steep, t, r) for t, r in zip(thrust, radial, strict=True))
    )


def _pairs(*pairs) -> Array:
    return jnp.stack([jnp.stack([jnp.asarray(v) for v in pair]) for pair in pairs])


def _pressure(row, axial):
    """Axial load over n D² of balls [MPa]."""
    return 1e-6 * axial / (row.n_elements * row.ball_diameter**2)


def _of_self_aligning(row, angle, double, sharing, axial):
    one, zero, cot = jnp.ones_like(angle), jnp.zeros_like(angle), 1.0 / jnp.tan(angle)
    if double:
        dynamic = _pairs((one, 0.42 * cot), (0.65 * one, 0.65 * cot))
        return dynamic, _pairs((one, 0.44 * cot), (one, zero))
    dynamic = _pairs((one, zero), (0.4 * one, 0.4 * cot))
    return dynamic, _pairs((0.5 * one, 0.22 * cot), (one, zero))


def _of_radial_contact(row, angle, double, sharing, axial):
    one, zero = jnp.ones_like(angle), jnp.zeros_like(angle)
    # All rows share the axial load.
    y = _interpolate(_RELATIVE, _DEEP_GROOVE, _pressure(row, axial) / sharing[0])
    dynamic = _pairs((one, zero), (0.56 * one, y))
    return dynamic, _pairs((0.6 * one, 0.5 * one), (one, zero))


def _of_angular_contact(row, angle, double, sharing, axial):
    one, zero = jnp.ones_like(angle), jnp.zeros_like(angle)
    pressure = _pressure(row, axial)
    degrees = jnp.degrees(angle)

    def factor_at(values):
        return _interpolate(_ANGLES, values, degrees)

    def y_of(name):
        alone = pressure / sharing[1]
        flat = [_interpolate(_RELATIVE, values, alone) for values in _FLAT[name]]
        steep = jnp.asarray(_STEEP[name], degrees.dtype)
        return factor_at(jnp.concatenate([jnp.stack(flat), steep]))

    # A four-point bearing holds both ways, as two rows do.
    if double or row.rated_rows == 2:
        dynamic = _pairs((one, y_of("y1")), (factor_at(_X2), y_of("y2")))
        return dynamic, _pairs((one, factor_at(_Y0_DOUBLE)), (one, zero))
    dynamic = _pairs((one, zero), (factor_at(_X), y_of("y")))
    return dynamic, _pairs((0.5 * one, factor_at(_Y0)), (one, zero))


def _of_rollers(row, angle, double, sharing, axial):
    one, zero = jnp.ones_like(angle), jnp.zeros_like(angle)
    tilted = angle > 0
    cot = jnp.where(tilted, 1.0 / jnp.tan(jnp.where(tilted, angle, 1.0)), 0.0)
    # Without a contact angle axial load goes through the ribs: it is not rated.
    second = jnp.where(tilted, 1.0, 0.0)
    if double:
        dynamic = _pairs((one, 0.45 * cot), (0.67 * second, 0.67 * cot))
        return dynamic, _pairs((one, 0.44 * cot), (one, zero))
    dynamic = _pairs((one, zero), (0.4 * second, 0.4 * cot))
    return dynamic, _pairs((0.5 * second, 0.22 * cot), (one, zero))


def _thrust_balls(angle, tangent):
    """X of the second pair, and the first pair, of thrust balls below 90 degrees."""
    sine = jnp.sin(angle)
    x = 1.25 * tangent * (1.0 - 2.0 / 3.0 * sine)
    first = 20.0 / 13.0 * tangent * (1.0 - sine / 3.0)
    return x, (first, (10.0 / 13.0) * (1.0 - sine / 3.0))


def _thrust_rollers(angle, tangent):
    return tangent, (1.5 * tangent, 0.67 * jnp.ones_like(angle))


_RADIAL = {
    AbstractBallBearing: _of_radial_contact,
    AngularContactBallBearing: _of_angular_contact,
    FourPointBallBearing: _of_angular_contact,
    SelfAligningBallRow: _of_self_aligning,
    AbstractRollerBearing: _of_rollers,
}
"""Factors X and Y, X0 and Y0 of radial bearings, by class."""

_FIRST = {AbstractBallBearing: _thrust_balls, AbstractRollerBearing: _thrust_rollers}
"""Factors of thrust bearings below 90 degrees, by class."""

_LEFT_OUT = {AbstractBallBearing: 0.0, AbstractRollerBearing: 1.0}
"""Part of an axial load that is left out at a contact angle of zero, by class [1]."""


def _of_thrust(angle, first_of, double):
    """Thrust bearings below 90 degrees."""
    one = jnp.ones_like(angle)
    tangent = jnp.tan(jnp.where(_is_flat(angle), 0.0, angle))
    x, first = first_of(angle, tangent)
    second = (x, one)
    dynamic = _pairs(first, second) if double else _pairs(second, second)
    static = (2.3 * tangent, one)
    return dynamic, _pairs(static, static)


def _interpolate(places, values, at):
    """Values between the lines of a table; beyond its ends those of the ends."""
    xp = jnp.asarray(np.asarray(places), at.dtype)
    return jnp.interp(at, xp, jnp.asarray(values, at.dtype))

"""Whether the rolling elements of two rows overlap."""

import math
from typing import Any

from .ball import AbstractBallBearing
from .checks import floats


def overlap(one: Any, other: Any) -> bool:
    """Whether the orbiting sections of two rows overlap; traced rows never do.

    Args:
        one, other: Rows of a set, both of balls or both of rollers.
    """
    if isinstance(one.bearing, AbstractBallBearing):
        mine, others = _ball(one), _ball(other)
        if mine is None or others is None:
            return False
        apart = math.hypot(mine[0] - others[0], mine[1] - others[1])
        return apart < (mine[2] + others[2]) * (1.0 - 1e-9)
    if one.bearing.is_crossed and other.bearing.is_crossed:
        return False  # one behind the other in the same groove
    mine, others = _corners(one), _corners(other)
    if mine is None or others is None:
        return False
    return not (_is_separated(mine, others) or _is_separated(others, mine))


def _ball(row):
    """z and r of the middle of a ball, and its radius [m]."""
    bearing = row.bearing
    numbers = floats(
        row.position, bearing.axial_place, bearing.pitch_diameter, bearing.ball_diameter
    )
    if numbers is None:
        return None
    position, place, pitch, ball = numbers
    return position + (-place if row.mirrored else place), 0.5 * pitch, 0.5 * ball


def _corners(row):
    """(z, r) of the corners of a roller, round its section [m]."""
    bearing = row.bearing
    side = -1.0 if row.mirrored else 1.0
    numbers = floats(
        row.position,
        bearing.pitch_diameter,
        bearing.roller_diameter,
        bearing.roller_length,
        bearing.axis_angle,
        bearing.half_angle,
        bearing.axial_place,
    )
    if numbers is None:
        return None
    position, pitch, diameter, length, axis, half, place = numbers
    sine, cosine = math.sin(axis), math.cos(axis)
    corners, lost = [], bearing.end_drop()
    around = (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0)
    for end, way in around:
        along = 0.5 * end * length * math.cos(half)
        radius = 0.5 * diameter - 0.5 * end * length * math.sin(half)
        across = way * (radius - abs(end) * lost)
        # Roller axes t, m in (z, r): the large end lies at -z, outwards.
        z = place + along * cosine + across * sine
        corners.append(
            (position + side * z, 0.5 * pitch - along * sine + across * cosine)
        )
    return corners


def _is_separated(mine, others):
    """Whether a side of one convex polygon separates it from another."""
    for k in range(len(mine)):
        (z, r), (z2, r2) = mine[k - 1], mine[k]
        normal = r2 - r, z - z2

        def projections(points, normal=normal):
            return [normal[0] * p[0] + normal[1] * p[1] for p in points]

        own, far = projections(mine), projections(others)
        size = 1e-9 * max(abs(x) for x in own + far)
        if min(far) >= max(own) - size or max(far) <= min(own) + size:
            return True
    return False

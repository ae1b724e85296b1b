"""Rows of rolling elements: load integrals, orbits of balls, kinematic orders."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ....contact.line import LineConstant
from ....design import BearingSet, Material
from ....design.ball_types import AngularContactBallBearing
from ....design.bearing import TaperedRollerBearing
from ....element.balls.ball_speed import EqualShare
from ....element.bearing_element import BearingElement
from ....element.inertia import Speed
from ....noise.orders import kinematic_frequencies
from ....numerics.quadrature import Midpoint
from ....statics.load import solve_load
from ....statics.support import Support

_MANY = 720
"""Rolling elements that stand for a load spread around the orbit."""
_SMALL = 1e-9
"""Approach that leaves contact angles as they are [m]."""


def load_integrals(
    zone: np.ndarray, rollers: bool = False, double_row: bool = False
) -> dict[str, np.ndarray]:
    """Return Sjövall's load integrals, by a row of many rolling elements.

    Args:
        zone: Loaded parts ε of the diameter (n,) [1].
        rollers: Whether contacts are lines, of exponent 10/9.
        double_row: Whether another row bears with 1 - ε.

    Returns:
        Integrals for radial and axial load; their ratio, which for a thrust bearing is
        twice the lever over the pitch diameter; its inverse; 1 over the first; largest
        load of the other row over that of the first, its radial load likewise.
    """
    angle = np.radians(40.0)
    if rollers:
        bearing = TaperedRollerBearing(
            _MANY, 1.0, 0.004, 0.004, roller_axis_angle=angle, roller_half_angle=0.0
        )
        laws = {"line_law": LineConstant(1e11), "quadrature": Midpoint(1)}
    else:
        bearing = AngularContactBallBearing(
            _MANY,
            1.0,
            0.004,
            contact_angle=angle,
            outer_osculation=0.7,
            inner_osculation=0.7,
        )
        laws = {}
    made = BearingSet.back_to_back(bearing, 0.01) if double_row else bearing
    element = BearingElement(made, **laws)
    q = np.zeros((len(zone), 12))
    q[:, 6] = _SMALL / (2.0 * zone) / np.cos(angle)
    q[:, 8] = (2.0 * zone - 1.0) * _SMALL / (2.0 * zone) / np.sin(angle)

    @eqx.filter_jit
    def evaluate(element, q):
        rows = [row.contact_load[:, 1] for row in element.rows(q)]
        return element.force(q), rows

    found = [evaluate(element, jnp.asarray(one)) for one in q]
    force = np.array([one[0] for one in found])
    loads = np.array([[np.asarray(row) for row in one[1]] for one in found])
    largest = loads.max(axis=-1)
    whole = _MANY * largest[:, 0]
    radial = force[:, 6] / (whole * np.cos(angle))
    axial = force[:, 8] / (whole * np.sin(angle))
    towards = loads @ np.cos(2.0 * np.pi * np.arange(_MANY) / _MANY)
    with np.errstate(divide="ignore"):
        ratio = radial / axial
        return {
            "radial": radial,
            "axial": axial,
            "ratio": ratio,
            "inverse": 1.0 / radial,
            "largest": largest[:, -1] / largest[:, 0],
            "share": towards[:, -1] / towards[:, 0],
        }


def balls_along_the_orbit(
    n_balls: int,
    pitch_diameter: float,
    ball_diameter: float,
    contact_angle: float,
    osculation: float,
    speed: float,
    axial_load: float,
    alone: float,
    radial_load: float,
) -> dict[str, float]:
    """Return the inner contact load of a ball along its orbit.

    The loads act in the plane of the inner groove's centre; both raceways share the
    gyroscopic moment.

    Args:
        n_balls, pitch_diameter, ball_diameter, contact_angle, osculation: Of the
            bearing [1, m, m, rad, 1].
        speed: Of the inner ring [rad/s].
        axial_load, radial_load: [N].
        alone: Load of a ball without radial load [N].

    Returns:
        Largest load, at the radial load; that opposite; the least; the least of a
        periodic cubic spline through the loads of the balls; where along the orbit the
        load falls below `alone`, exceeds it again, and falls below it again [1].
    """
    bearing = AngularContactBallBearing(
        int(n_balls),
        pitch_diameter,
        ball_diameter,
        contact_angle=contact_angle,
        outer_osculation=osculation,
        inner_osculation=osculation,
        material=Material(206e9, 0.3, 7850.0),
    )
    element = BearingElement(bearing, raceway_control=EqualShare())
    lever = float(bearing.grooves[1].axial) * radial_load
    turning = Speed(speed)
    solved = solve_load(
        element, [radial_load, 0.0, axial_load, 0.0, lever, 0.0], speed=turning
    )
    single = dataclasses.replace(bearing, n_balls=1)
    one = BearingElement(single, raceway_control=EqualShare())

    @eqx.filter_jit
    def along(one, displacement):
        def load(place):
            moved = eqx.tree_at(lambda e: e.bearing.first_azimuth, one, place)
            return moved.rows(displacement, turning)[0].contact_load[0, 1]

        return jax.vmap(load)(jnp.linspace(0.0, 2.0 * jnp.pi, _MANY, endpoint=False))

    load = np.asarray(along(one, solved.displacement))
    spline = _periodic_spline(np.asarray(solved.roller_load)[:, 1], _MANY)
    above = load > alone
    changes = np.flatnonzero(above != np.roll(above, 1)) / _MANY
    first, second, third = changes[:3] if len(changes) > 3 else (np.nan,) * 3
    return {
        "largest": load.max(),
        "under": load[0],
        "opposite": load[_MANY // 2],
        "least": load.min(),
        "spline": spline.min(),
        "falls": first,
        "rises": second,
        "falls_again": third,
    }


def _periodic_spline(values, count):
    """Return a cubic spline through values at equal steps of a period."""
    n = len(values)
    matrix = 4.0 * np.eye(n) + np.roll(np.eye(n), 1, 0) + np.roll(np.eye(n), -1, 0)
    jump = np.roll(values, -1) - 2.0 * values + np.roll(values, 1)
    bends = np.linalg.solve(matrix, 6.0 * jump)
    t, k = np.modf(np.arange(count) * n / count)
    a, b = k.astype(int) % n, (k.astype(int) + 1) % n
    bend = ((1 - t) ** 3 - (1 - t)) * bends[a] + (t**3 - t) * bends[b]
    return (1 - t) * values[a] + t * values[b] + bend / 6.0


def kinematic_orders(
    n_balls: np.ndarray,
    ball_diameter: np.ndarray,
    pitch_diameter: np.ndarray,
    contact_angle: np.ndarray,
) -> dict[str, np.ndarray]:
    """Return the kinematic frequencies of bearings over that of the shaft [1].

    Args:
        n_balls: Numbers of balls (n,).
        ball_diameter, pitch_diameter: Sizes (n,) [m].
        contact_angle: Contact angles (n,) [rad].
    """
    found = []
    for n, ball, pitch, angle in zip(
        n_balls, ball_diameter, pitch_diameter, contact_angle, strict=True
    ):
        bearing = AngularContactBallBearing(
            int(n),
            float(pitch),
            float(ball),
            contact_angle=float(angle) or 0.1,
            outer_osculation=0.52,
            inner_osculation=0.52,
        )
        orders = kinematic_frequencies(bearing, Speed(1.0), float(angle)).orders
        found.append([*orders, orders.twice_rotation])
    names = ("inner", "outer", "cage", "bpfo", "bpfi", "bsf", "twice_bsf")
    return dict(zip(names, np.array(found, float).T, strict=True))

"""Rows of rolling elements: load integrals, and loads along the orbit."""

import dataclasses
from typing import Any

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
from ....numerics.quadrature import Midpoint
from ....statics.load import solve_load
from ....statics.support import Support
from .direct import bearing_by

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
        Radial and axial integral, their ratio, 1 over the first; largest load of the
        last row over that of the first, and its radial load likewise.
    """
    angle = np.radians(40.0)
    if rollers:
        bearing = TaperedRollerBearing(
            _MANY, 1.0, 0.004, 0.004, roller_axis_angle=angle, roller_half_angle=0.0
        )
        laws = {"line_law": LineConstant(1e11), "quadrature": Midpoint(1)}
    else:
        wide = dict.fromkeys(("outer_osculation", "inner_osculation"), 0.7)
        given: dict[str, Any] = wide | {"contact_angle": angle}
        bearing = AngularContactBallBearing(_MANY, 1.0, 0.004, **given)
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


def stiffness_ratio(
    bearing: dict[str, Any], line_constant: float = 0.0
) -> dict[str, float]:
    """Return the stiffness of a row across a radial load over that along it.

    Args:
        bearing: Its keywords.
        line_constant: Constant of the line law, of exponent 10/9, of rollers that
            are taken as points [N/m^(19/9)]; 0: balls.
    """
    line = {"line_law": LineConstant(line_constant or 1.0), "quadrature": Midpoint(1)}
    element = BearingElement(bearing_by(bearing), **(line if line_constant else {}))
    load, across = [1e3, 0.0, 0.0, 0.0, 0.0, 0.0], Support(free=["ux", "uy"])
    stiffness = solve_load(element, load, support=across).stiffness
    return {"ratio": float(stiffness[7, 7] / stiffness[6, 6])}


def balls_along_the_orbit(
    bearing: dict[str, Any],
    speed: float,
    axial_load: float,
    radial_load: np.ndarray,
    alone: float,
) -> dict[str, np.ndarray]:
    """Return inner contact loads along the orbit of a steel ball.

    Args:
        bearing: Fields of an angular contact ball bearing.
        speed: Of the inner ring; raceways share the gyroscopic moment [rad/s].
        axial_load: In the plane of the inner groove's centre [N].
        radial_load: Likewise (n,) [N].
        alone: Load of a ball without radial load [N].

    Returns:
        Load under the radial load, opposite and the least (n,); where along the orbit,
        as a share, it falls below `alone`, exceeds it, and falls below it again.
    """
    steel, turning = Material(206e9, 0.3, 7850.0), Speed(speed)
    made = AngularContactBallBearing(**bearing, material=steel)
    single = dataclasses.replace(made, n_balls=1)
    element, one = (
        BearingElement(rows, raceway_control=EqualShare()) for rows in (made, single)
    )
    lever = float(made.grooves[1].axial)

    @eqx.filter_jit
    def along(one, displacement):
        def load(place):
            moved = eqx.tree_at(lambda e: e.bearing.first_azimuth, one, place)
            return moved.rows(displacement, turning)[0].contact_load[0, 1]

        return jax.vmap(load)(jnp.linspace(0.0, 2.0 * jnp.pi, _MANY, endpoint=False))

    found = []
    for radial in map(float, radial_load):
        load = [radial, 0.0, axial_load, 0.0, lever * radial, 0.0]
        solved = solve_load(element, load, speed=turning)
        load = np.asarray(along(one, solved.displacement))
        above = load > alone
        changes = np.flatnonzero(above != np.roll(above, 1)) / _MANY
        zones = changes[:3] if len(changes) > 3 else np.full(3, np.nan)
        found.append([load[0], load[_MANY // 2], load.min(), *zones])
    names = "under", "opposite", "least", "falls", "rises", "falls_again"
    return dict(zip(names, np.array(found).T, strict=True))

"""Solutions made of chosen numbers: a picture needs no solver."""

from typing import Any

import jax.numpy as jnp
import numpy as np

import bearingjax as bj
from bearingjax.design import rows_of
from bearingjax.statics.solution import BallSolution, RollerSolution, Stats

TOP = 1000.0
"""Largest load of a rolling element [N]."""


def solution(bearing, angles=(), points=21):
    """A solution whose loads fall with the cosine from azimuth 270 degrees on.

    Args:
        bearing: A bearing or a set.
        angles: Contact angles of balls, of each contact of all rows [rad].
        points: Positions along a roller.
    """
    rows = [row.bearing for row in rows_of(bearing)]
    sizes = tuple(row.n_elements for row in rows)
    azimuth = np.concatenate(
        [
            float(row.first_azimuth) + np.arange(n) * 2 * np.pi / n
            for row, n in zip(rows, sizes, strict=True)
        ]
    )
    load = TOP * np.maximum(-np.sin(azimuth), 0.0)
    load[load < 1e-6 * TOP] = 0.0
    load = np.stack([load, load], axis=1)
    common = dict(
        displacement=np.arange(12.0) * 1e-6,
        force=np.zeros(12),
        stiffness=1e7 * np.eye(12),
        roller_load=load,
        roller_motion=np.zeros((len(azimuth), 3)),
        azimuth=azimuth,
        pitch_radius=0.5 * float(rows[0].pitch_diameter),
    )
    if angles:
        kind, special = BallSolution, _balls(load, angles)
    else:
        kind, special = RollerSolution, _rollers(rows[0], load, points, len(rows))
    known = {name: jnp.asarray(value) for name, value in (common | special).items()}
    whole = jnp.asarray(0)
    none: dict[str, Any] = dict.fromkeys(("spring_travel", "spring_force", "speed"))
    if angles:
        none |= dict.fromkeys(("kinematics", "gyroscopic_moment", "centrifugal_force"))
    real = jnp.asarray(0.0)
    return kind(
        **known,
        **none,
        result=whole,
        unrestrained=jnp.asarray(-1),
        stats=Stats(real, whole, real, whole),
        element=bj.BearingElement(bearing),
        row_sizes=sizes,
        free=(),
        held=(),
        moving_ring="inner",
    )


def _balls(load, angles):
    half = len(angles) // 2
    load = np.repeat(load, half, axis=1)
    axes = np.stack([1e-4 * np.cbrt(load / TOP), 1e-3 * np.cbrt(load / TOP)], axis=-1)
    pressure = 2e9 * np.cbrt(load / TOP) * np.repeat([0.9, 1.0], half)
    return dict(
        contact_load=load,
        contact_angle=np.broadcast_to(angles, load.shape),
        contact_pressure=pressure,
        roller_pressure=pressure[:, ::half],
        semi_axes=axes,
        approach=np.zeros(load.shape),
        shoulder_margin=np.full(load.shape, np.inf),
    )


def _rollers(bearing, load, points, rows):
    length = float(bearing.roller_length)
    position = np.linspace(-0.5 * length, 0.5 * length, points)
    # An elliptic pressure over the middle, less where the load is less.
    share = 0.4 + 0.55 * load / TOP
    shape = 1.0 - (2.0 * position / length / share[..., None]) ** 2
    pressure = np.sqrt(np.maximum(shape, 0.0) * (load / TOP)[..., None])
    pressure = pressure * np.array([1.3e9, 1.5e9])[:, None]
    zero = np.zeros((len(load), 2, 2))
    return dict(
        rib_load=np.zeros((len(load), 4)),
        position=position if rows == 1 else np.tile(position, (len(load), 1)),
        line_load=pressure * 1e-4,
        contact_pressure=pressure,
        contact_half_width=pressure * 1e-14,
        roller_pressure=pressure.max(axis=2),
        edge_load=zero,
        edge_pressure=zero,
    )

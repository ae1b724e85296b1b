"""Factors of the load ratings, and lives of worked examples, by ISO 281 and ISO 76."""

from collections.abc import Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....design.bearing_set import rows_of
from ....life import row_rating
from ....life.equivalent_load import equivalent_load
from ....life.life_factor import life_factor, viscosity_ratio
from ....life.rating import ratings
from ....life.reference_life import exponents_of
from .direct import bearing_by


def ball_factors(ratio: np.ndarray) -> dict[str, np.ndarray]:
    """Return f_c and f_0 over D cos α/D_pw (n,), of one row of one ball of 1 mm."""

    def row(gamma, angle, osculation):
        pitch = 1e-3 * jnp.cos(angle) / gamma
        return row_rating.BallRow(1, jnp.asarray(1e-3), pitch, angle, osculation)

    def steep(gamma, degrees):
        angle = jnp.deg2rad(degrees)
        one = row(gamma, angle, (0.535, 0.535))
        along = jnp.cos(angle) ** 0.7 * jnp.tan(angle)
        return row_rating.steep_ball_dynamic(one, row_rating.THRUST, 1) / along / 1.3

    def table(gamma):
        zero = jnp.zeros_like(gamma)
        radial, thrust = (row(gamma, zero, o) for o in ((0.53, 0.52), (0.535, 0.535)))
        kinds = row_rating.ANGULAR_CONTACT, row_rating.THRUST
        found = {f"f_c {angle}": steep(gamma, zero + angle) for angle in (45, 60, 75)}
        return found | {
            "f_c": row_rating.radial_ball_dynamic(radial, kinds[0], 1) / 1.3,
            "f_c 90": row_rating.thrust_ball_dynamic(thrust, kinds[1], 1) / 1.3,
            "f_0": row_rating.ball_static(radial, kinds[0]) / 5.0,
            "f_0 thrust": row_rating.ball_static(thrust, kinds[1]),
        }

    return jax.device_get(jax.jit(jax.vmap(table))(jnp.asarray(ratio)))


def modified_life(
    bearing: str | Mapping[str, Any],
    load: np.ndarray,
    speed: np.ndarray | float,
    viscosity: np.ndarray | float,
    contamination: float,
    mean_diameter: float,
    arrangement: str = "",
    **given: float,
) -> dict[str, Any]:
    """Return ratings, equivalent load and modified life of ISO 281, without a solve.

    Args:
        bearing, arrangement: As in `direct.bearing_by`.
        load: On the bearing, in each interval (n, 6) [N, N m].
        speed: Speed of the inner ring in each interval (n,) [rad/s].
        viscosity: Kinematic viscosity of the oil in each interval (n,) [m²/s].
        contamination: e_C [1].
        mean_diameter: Of κ, in place of the pitch diameter [m].
        given: Ratings in place of those of the bearing [N].
    """
    own = bearing_by(bearing, arrangement)
    row, rated = rows_of(own)[0].bearing, ratings(own, **given)
    c = float(rated.dynamic_capacity)
    p, p0 = np.array([equivalent_load(own, jnp.asarray(one)) for one in load], float).T
    speed, viscosity = (x * np.ones_like(p) for x in (speed, viscosity))
    below = contamination * float(rated.fatigue_load_limit) / p

    @jax.vmap
    def oiled(nu, omega, ratio):
        kappa = viscosity_ratio(nu, omega, jnp.asarray(mean_diameter))
        return kappa, life_factor(kappa, ratio, row.is_ball, row.is_thrust)

    kappa, a_iso = map(np.asarray, oiled(*map(jnp.asarray, (viscosity, speed, below))))
    n, d = exponents_of(row).basic
    life = 1e6 * (c / p) ** (n / d)
    time = 2.0 * np.pi * life / speed
    return {
        "C": c,
        "P": p,
        "C/P": c / p,
        "C0/P0": float(rated.static_capacity) / p0,
        "viscosity": viscosity / kappa,
        "kappa": kappa,
        "load ratio": below,
        "a_iso": a_iso,
        "life": life,
        "time": time,
        "modified time": a_iso * time,
    }

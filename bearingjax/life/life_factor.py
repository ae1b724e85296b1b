"""Factors of the modified rating life: reliability, lubrication, contamination.

L_nm = a1 a_ISO L10. The factor a_ISO grows with the viscosity ratio κ and with
e_C C_u/P, how far the load lies below the fatigue limit of clean steel.

Source: ISO 281:2007, clause 9 and annex A; a1 by ISO/TR 1281-2.
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from ..design.checks import in_range, positive
from ..numerics.power import positive_power
from ..numerics.types import Flag, Number, Real, RealOrNone, Reals, Scalar, as_real
from ..numerics.units import real

LARGEST_FACTOR = 50.0
"""Largest a_ISO of the standard [1]."""

KAPPA = (0.1, 4.0)
"""Viscosity ratios of the diagrams of a_ISO and e_C [1]. Beyond them a_ISO is that at
the end, and so is e_C above; below 0.1 its formula goes on to zero."""

_FLOOR, _SPREAD = 0.05, 1.5
"""Smallest a1, and Weibull's exponent of early failures (ISO/TR 1281-2)."""

_FAR = 1e6
"""e_C C_u/P without load [1]: far above where a_ISO is at its largest."""


def reliability_factor(reliability: Scalar) -> Scalar:
    """a1, the life that more than 90 % of the bearings reach, over L10 [1].

    Gives the table of ISO 281:2007 to its last digit.

    Args:
        reliability: Share of bearings that reach it, from 0.9 to below 1 [1].

    Source: ISO/TR 1281-2, three-parameter Weibull distribution.
    """
    size = jnp.log(reliability) / jnp.log(0.9)
    return _FLOOR + (1.0 - _FLOOR) * size ** (1.0 / _SPREAD)


def viscosity_ratio(viscosity: Scalar, speed: Scalar, pitch_diameter: Scalar) -> Scalar:
    """κ, the viscosity over that which a sufficient film needs [1].

    The two branches of the standard do not join: at 1000 r/min κ drops by 2.3 %.

    Args:
        viscosity: Kinematic viscosity at the temperature of operation [m²/s].
        speed: Speed of one ring against the other, at least 0 [rad/s].
        pitch_diameter: D_pw [m].

    Source: ISO 281:2007, ν1 = 45000 n^-0.83 D_pw^-0.5 below 1000 r/min, from there
        4500 n^-0.5 D_pw^-0.5, in mm²/s, r/min and mm.
    """
    turns = speed * (30.0 / jnp.pi)
    slow = turns < 1000.0
    fast = jnp.sqrt(jnp.where(slow, 1.0, turns)) / 4500.0
    speed_part = jnp.where(slow, positive_power(turns, 83, 100) / 45000.0, fast)
    return 1e6 * viscosity * jnp.sqrt(1e3 * pitch_diameter) * speed_part


def life_factor(
    kappa: Number, load_ratio: Reals | float, balls: bool, thrust: Flag | bool
) -> Reals:
    """a_ISO of the systems approach [1], at most 50.

    Args:
        kappa: Viscosity ratio κ, taken as 0.1 below that and as 4 above [1].
        load_ratio: e_C C_u/P [1].
        balls: Whether the rolling elements are balls, else rollers. Static.
        thrust: Whether it is a thrust bearing.

    Source: ISO 281:2007, formulas (31) to (42); all constants agree with those of an
        independent program (in C, of all four types of bearing).
    """
    kappa, load_ratio = jnp.clip(as_real(kappa), *KAPPA), as_real(load_ratio)
    low, high = kappa < 0.4, kappa >= 1.0
    power = jnp.where(low, 0.054381, jnp.where(high, 0.071739, 0.19087))
    film = kappa**-power
    if balls:
        film = jnp.where(low, 2.2649, 1.9987) * film
        film = positive_power(2.5671 - film, 83, 100)
        share = jnp.where(thrust, 1.0 / 3.0, 1.0) * load_ratio
        rest = 1.0 - film * positive_power(share, 1, 3)
        exponent = 9.3
    else:
        film = 1.5859 - jnp.where(low, 1.3993, 1.2348) * film
        share = jnp.where(thrust, 0.4, 1.0) * load_ratio
        rest = 1.0 - film * positive_power(share, 2, 5)
        exponent = 9.185
    # Where 0.1 rest^-exponent would be above 50.
    least = (LARGEST_FACTOR / 0.1) ** (-1.0 / exponent)
    return 0.1 * jnp.maximum(rest, least) ** -exponent


def load_ratio(contamination: Scalar, limit: Scalar, load: Reals) -> Reals:
    """e_C C_u/P [1]; a large number where there is no load.

    Args:
        contamination: e_C [1].
        limit: Fatigue load limit C_u [N].
        load: P [N].
    """
    loaded = load > 0
    ratio = contamination * limit / jnp.where(loaded, load, 1.0)
    # Not (P > 0) is no load, but NaN stays NaN.
    return jnp.where(load <= 0, _FAR, jnp.where(loaded, ratio, load))


class Cleanliness(eqx.Module):
    """Cleanliness of a lubricant: e_C = min(a κ^0.68 D_pw^0.55, 1) (1 - b/D_pw^(1/3)),
    κ at most 4.

    Attributes:
        film: a, with D_pw in mm [1].
        size: b, with D_pw in mm [1].
        large: b above a pitch diameter of 500 mm [1]; `None`: equal to `size`.

    Traced: all fields.

    Source: ISO 281:2007, annex A.
    """

    film: Real = eqx.field(**real("1"))
    size: Real = eqx.field(**real("1"))
    large: RealOrNone = eqx.field(**real("1"), default=None)

    def __check_init__(self):
        positive(self, "film")
        positive(self, "size")
        if self.large is not None:
            positive(self, "large")

    def factor(self, kappa: Number, pitch_diameter: Number) -> Scalar:
        """Contamination factor e_C, from 0 to 1 [1].

        Small bearings in dirty oil have 0.

        Args:
            kappa: Viscosity ratio κ, taken as 4 above that, where the diagrams of the
                standard end [1].
            pitch_diameter: D_pw [m].
        """
        kappa = jnp.minimum(as_real(kappa), KAPPA[1])
        size = 1e3 * as_real(pitch_diameter)
        film = self.film * positive_power(kappa, 17, 25) * size**0.55
        b = self.size
        if self.large is not None:
            b = jnp.where(size < 500.0, b, self.large)
        return jnp.minimum(film, 1.0) * jnp.maximum(1.0 - b / jnp.cbrt(size), 0.0)


CLEANLINESS = {
    "circulating oil -/13/10": (0.0864, 0.5663),
    "circulating oil -/15/12": (0.0432, 0.9987),
    "circulating oil -/17/14": (0.0288, 1.6329),
    "circulating oil -/19/16": (0.0216, 2.3362),
    "oil bath -/13/10": (0.0864, 0.6796),
    "oil bath -/15/12": (0.0288, 1.141),
    "oil bath -/17/14": (0.0133, 1.67),
    "oil bath -/19/16": (0.00864, 2.5164),
    "oil bath -/21/18": (0.00411, 3.8974),
    "grease, high": (0.0864, 0.6796),
    "grease, normal": (0.0432, 1.141),
    "grease, slight to typical": (0.0177, 1.887, 1.677),
    "grease, severe": (0.0115, 2.662),
    "grease, very severe": (0.00617, 4.06),
}
"""Constants of `Cleanliness` by name. Oils have their class of ISO 4406; circulating
oil is filtered in line, an oil bath off line or not at all.

Source: ISO 281:2007, annex A. "grease, high", and "grease, slight to typical" above
    500 mm, agree with what MASTA computes (to 0.1 %, as two public programs quote it),
    the former with a third program. The other lines were found nowhere but in the
    standard. But for 0.0177 each `film` is a simple part of 0.0864 (1/2, 1/3, 1/4,
    1/6.5, 1/7.5, 1/10, 1/14, 1/21), and e_C falls from class to class through the
    ranges of the standard's table of guide values, which makers print as well.
"""


def as_contamination(value: Any) -> Any:
    """Converter of a contamination: replaces a name of `CLEANLINESS` by its value.

    Args:
        value: e_C, a `Cleanliness` or a name; anything else comes back unchanged.
    """
    if isinstance(value, str):
        return Cleanliness(*CLEANLINESS[value]) if value in CLEANLINESS else value
    return value if isinstance(value, Cleanliness) else as_real(value)


def check_contamination(owner: Any, value: Any) -> None:
    """Raise unless it is a `Cleanliness` or a number of at least 0 and at most 1."""
    if isinstance(value, Cleanliness):
        return
    if isinstance(value, str):
        raise ValueError(
            f"{type(owner).__name__}: `contamination` is {value!r}; it must be e_C from"
            f" 0 to 1, or one of {', '.join(map(repr, CLEANLINESS))}."
        )
    in_range(owner, "contamination", 0.0, 1.0 + 1e-12, value, "", include_low=True)

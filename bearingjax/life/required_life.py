"""A required life: whether it is kept, and what would keep it.

Geometry, loads of the contacts, speeds and temperature stay as they are: then lives
change with C, in proportion to which C_u changes; κ with the viscosity; e_C of a class
of cleanliness with κ.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBearing, BearingSet, rows_of
from ..design.bearing_set import bearings_of, pitch_radius
from ..numerics.compiled.programs import program
from ..numerics.power import positive_power
from ..numerics.types import as_real
from .life import LifeConditions
from .life_factor import CLEANLINESS, KAPPA, Cleanliness, life_factor
from .rating import is_axial
from .reference_life import BALLS, exponents_of

NEEDED = ("viscosity_ratio", "damage_share", "limit_ratio")
"""Numbers of a `Life` from which `judge_life` tells what would keep a required one."""

_CLEAN = 1e-9
"""e_C that counts as 0: any dirt will do."""


@dataclasses.dataclass(frozen=True)
class RequiredLife:
    """Verdict on a required life, and the least that would keep it.

    Each number is that with all others as they are; `None` where none would do, or if
    it is not known.

    Attributes:
        factor: Life over the required one [1]; infinite without damage.
        dynamic_capacity: Smallest C, with C_u in proportion [N].
        basic_capacity: Smallest C for the basic life L10 [N].
        viscosity: Smallest kinematic viscosity of the oil in operation, at least that
            of κ = 0.1, where the standard begins [m²/s].
        contamination_factor: Smallest e_C, of the cleanest oil 1 [1].
        cleanliness: The dirtiest class of each kind of supply that would do.
    """

    factor: float
    dynamic_capacity: float | None = None
    basic_capacity: float | None = None
    viscosity: float | None = None
    contamination_factor: float | None = None
    cleanliness: tuple[str, ...] = ()

    @property
    def kept(self) -> bool:
        """Whether the life is at least the required one, but for round-off."""
        return self.factor >= 1.0 - 1e-9


def judge_life(
    bearing: AbstractBearing | BearingSet,
    conditions: LifeConditions,
    factor: float,
    basic: float,
    capacity: float,
    lives: Mapping[str, Any],
    share: Any = (1.0,),
) -> RequiredLife:
    """Tell what would keep a required life, of one load or of a spectrum.

    Args:
        bearing: The bearing that was solved.
        conditions: Conditions of its life, with the required one.
        factor: Life over the required one [1]: the modified life, or without a
            lubricant the reference life times a1.
        basic: Basic life over the required one [1].
        capacity: C of the bearing [N].
        lives: Numbers of `NEEDED` with a leading axis (case,), where they are known.
        share: Share of every case in the damage (case,) [1].

    Source: ISO 281:2007; the parts of a row as in `rating_life`.
    """
    known = {name: jnp.asarray(lives[name]) for name in NEEDED if name in lives}
    if not math.isfinite(factor) or "limit_ratio" not in known:
        return RequiredLife(factor)
    kind = exponents_of(rows_of(bearing)[0].bearing)
    power = kind.load[0] / kind.load[1]
    oiled = "viscosity_ratio" in known

    def a_iso(*changed):
        return np.asarray(_life_factors(bearing, known, *map(as_real, changed)))

    def used(c=1.0, oil=1.0, clean=conditions.contamination):
        """Part of the required life that is used, with C and the viscosity times so."""
        now = a_iso(oil, clean, c) if oiled else 1.0
        return float(np.sum(unit / now)) * c**-power

    unit = np.asarray(share) / factor
    if oiled:
        unit = unit * a_iso(1.0, conditions.contamination, 1.0)
    size = (_least(used, 1e-6, 1e6) or math.nan) * capacity
    least = size, capacity * basic ** -(kind.basic[1] / kind.basic[0])
    if not oiled:
        return RequiredLife(factor, *least)
    kappa = np.asarray(known["viscosity_ratio"])
    ends = KAPPA[0] / kappa.max(), KAPPA[1] / kappa[kappa > 0].min()
    times = _least(lambda oil: used(oil=oil), *ends)
    clean = _least(lambda e: used(clean=e), _CLEAN, 1.0)
    good = [k for k, of in CLEANLINESS.items() if used(clean=Cleanliness(*of)) <= 1.0]
    return RequiredLife(
        factor,
        *least,
        None if times is None else times * float(conditions.viscosity),  # pyright: ignore
        0.0 if clean == _CLEAN else clean,
        tuple({k.partition(",")[0].partition(" -")[0]: k for k in good}.values()),
    )


@program(quick=True)
def _life_factors(bearing, lives, oil, clean, times) -> Float[Array, " case"]:
    """a_ISO of every case, its oil and C changed, as of all parts of its rows."""
    kind = exponents_of(rows_of(bearing)[0].bearing)
    n, d = kind.spread

    def factor_of_case(kappa, shares, limit):
        dirt = clean
        if isinstance(clean, Cleanliness):
            dirt = clean.factor(kappa, 2.0 * pitch_radius(bearing))
        tired = jnp.zeros_like(kappa)
        for k, row in enumerate(bearings_of(bearing)):
            thrust = jnp.asarray(is_axial(row.is_thrust, row.nominal_contact_angle))
            of = life_factor(kappa, times * dirt * limit[k], kind is BALLS, thrust)
            tired += jnp.sum(jnp.sum(shares[k], axis=0) * positive_power(of, -n, d))
        return jnp.where(tired > 0, tired, 1.0) ** -(d / n)

    numbers = (lives[name] for name in NEEDED)
    return jax.vmap(lambda kappa, *parts: factor_of_case(oil * kappa, *parts))(*numbers)


def _least(used: Callable[[float], float], low: float, high: float) -> float | None:
    """The least argument from `low` to `high` with which no more than the required life
    is used; `None` if there is none."""
    from scipy.optimize import brentq

    if used(low) <= 1.0:
        return low
    if used(high) > 1.0:
        return None
    ends = math.log(low), math.log(high)
    root: Any = brentq(lambda x: math.log(used(math.exp(x))), *ends, xtol=1e-12)
    return math.exp(root)

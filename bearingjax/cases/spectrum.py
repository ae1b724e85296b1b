"""Life under a load spectrum: the damage of its cases adds up (Palmgren, Miner)."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import of_shape
from ..numerics.shown import Printable
from ..numerics.types import array_namespace
from ..numerics.units import unit
from .cases import Cases


class SpectrumLife(Printable):
    """Life under all cases of a spectrum, one after the other again and again.

    Attributes:
        rating_life: In revolutions of one ring against the other [rev].
        life_hours: In hours [h]; `None` if the cases have no speeds.
        damage_share: Share of each case in the damage (case,) [1]; zero if there is
            none at all.
    """

    rating_life: Float[Array | np.ndarray, ""] = eqx.field(metadata=unit("rev"))
    life_hours: Float[Array | np.ndarray, ""] | None = eqx.field(metadata=unit("h"))
    damage_share: Float[Array | np.ndarray, " case"] = eqx.field(metadata=unit("1"))


def spectrum_life(
    cases: Cases, damage: Float[Array | np.ndarray, " case"]
) -> SpectrumLife:
    """Life under a spectrum of cases.

    Args:
        cases: With `hours` and speeds. Without hours all cases take the same time;
            without speeds all turn alike, and there is no life in hours.
        damage: Part of the life that one revolution uses in each case (case,) [1/rev]:
            `Life.damage`, as the output "damage" of a sweep.

    Returns:
        Life; infinite without damage, NaN if that of a case is NaN. Differentiable.

    Raises:
        ValueError: If there are not as many damages as cases.

    Source: Palmgren (1924), Miner (1945); ISO 281 with several loads.
    """
    allowed = f"({cases.count},), a number for each case"
    fits = np.shape(damage) == (cases.count,)
    of_shape("spectrum_life", "damage", fits, allowed, damage)
    xp: Any = array_namespace(damage)
    hours = xp.ones_like(damage) if cases.hours is None else cases.hours
    turns = revolutions_per_hour(cases, xp)
    weight = hours if turns is None else hours * turns
    parts = weight * damage
    total = xp.sum(parts)
    nothing = total == 0
    once = xp.where(nothing, 1.0, total)

    def life(amount):
        return xp.asarray(xp.where(nothing, np.inf, xp.sum(amount) / once))

    return SpectrumLife(
        life(weight), None if turns is None else life(hours), parts / once
    )


def revolutions_per_hour(cases: Cases, xp: Any = jnp) -> Any:
    """Revolutions of one ring relative to the other (case,) [1/h]; `None`: no speeds.

    Args:
        cases: Operating cases.
        xp: NumPy or JAX.
    """
    speeds = [s for s in (cases.inner_speed, cases.outer_speed) if s is not None]
    if not speeds:
        return None
    between = speeds[0] - speeds[1] if len(speeds) == 2 else speeds[0]
    return xp.abs(between) * (3600.0 / (2.0 * np.pi))


def relative_speed(cases: Cases) -> np.ndarray:
    """Return the speed of one ring relative to the other (case,) [rad/s]."""
    turns = revolutions_per_hour(cases, np)
    return np.zeros(cases.count) if turns is None else turns * np.pi / 1800.0

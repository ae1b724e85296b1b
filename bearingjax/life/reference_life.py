"""Reference rating life: fatigue of every raceway from the loads of its contacts.

A raceway of contact capacity Q_c that bears the loads Q_j lives, in millions of
revolutions, L = (Q_c/Q_e)^p with the equivalent load Q_e, a mean of powers of the Q_j.
Raceways, rows and laminae are parts of which none may fail: L^-e = Σ L_part^-e
(Weibull). All is written in these shares, (Q_e/Q_c)^(p e), which are zero, with zero
derivatives, where there is no load.

The contact capacities follow from the rating C of the row. C is, by definition, the
radial load with half of the elements loaded (no clearance) that the row bears for a
million revolutions, its inner ring turning. Statics then gives the equivalent contact
loads: Q_e = F/(J Z cos α), J = 0.407 and 0.389 for balls at the inner and outer
raceway, 0.378 and 0.364 for rollers (Sjövall's integrals); with an axial load on a
thrust bearing all contacts bear F/(Z sin α). So the cosine stands in the first power
here. With (cos α)^0.7, as some prints have it, a bearing under its own rating would
not last a million revolutions: at 40 degrees a fifth less. Capacities that MASTA gives
for an HR30306J (14.16 and 24.20 kN, of 59.5 kN) have the first power too.

The load by which a lamina of a radial bearing enters a_ISO is 0.323 Z n cos α times
the mean of its equivalent loads, as ISO 16281 prints it; statics alone would have
0.378. It agrees with a_ISO of the same case by MASTA to 1.3 %, 0.378 would not.

Sources: ISO/TS 16281:2008, and ISO 16281:2025, formulas 29 to 33, as a public program
    for tapered rollers quotes them and compares them with MASTA; Lundberg and Palmgren
    (1947, 1952); ISO/TR 1281-1.
"""

from typing import Annotated, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBallBearing, AbstractBearing, AbstractRollerBearing
from ..design.abstract import nearest_entry
from ..numerics.power import positive_power
from ..numerics.types import Scalar
from ..numerics.units import unit
from .oscillation import arc_factor, critical_amplitudes, mean_of_swing
from .rating import is_axial

LEAST_LAMINAE = 30
"""Laminae of a roller, at least (ISO/TS 16281)."""


class Fatigue(NamedTuple):
    """Exponents of fatigue, as fractions, and constants of the contact capacities.

    Attributes:
        load: p of L = (Q_c/Q_e)^p, also of the mean over a ring that turns against the
            load.
        spread: e of Weibull's distribution.
        radial: J of the outer and the inner raceway, load turning against the inner.
        ratio: J_inner/J_outer as the standard rounds it.
        reduction: C over that of evenly loaded contacts; radial and thrust bearings.
        lamina: Load by which a part of a radial bearing enters a_ISO, over that of
            statics.
        basic: p of L10 = (C/P)^p of ISO 281.
    """

    load: tuple[int, int]
    spread: tuple[int, int]
    radial: tuple[float, float]
    ratio: float
    reduction: tuple[float, float]
    lamina: float
    basic: tuple[int, int]

    @property
    def share(self) -> tuple[int, int]:
        """p e: exponent of the shares, and of the mean over a ring that does not turn
        against the load."""
        return self.load[0] * self.spread[0], self.load[1] * self.spread[1]


BALLS = Fatigue((3, 1), (10, 9), (0.389, 0.407), 1.044, (1.0, 1.0), 1.0, (3, 1))
ROLLERS = Fatigue(
    (4, 1), (9, 8), (0.364, 0.378), 1.038, (0.83, 0.73), 0.323 / 0.378, (10, 3)
)
_FATIGUE = {AbstractBallBearing: BALLS, AbstractRollerBearing: ROLLERS}


class RowFatigue(NamedTuple):
    """Fatigue of a row.

    Attributes:
        share: L^-e of every raceway and track, in millions of revolutions
            (raceway, track) [1]. Tracks are the arcs of a ball's raceways, or the
            laminae of a roller's.
        load: Load with which a part of the row enters a_ISO (part,) [N]: of balls a
            pair of arcs, of rollers a lamina. It is that of a bearing without clearance
            which tires as much, its parts evenly loaded, but for `Fatigue.lamina`.
        fatigue: Its exponents. Static.
    """

    share: Annotated[Float[Array, "2 track"], unit("1")]
    load: Annotated[Float[Array, " part"], unit("N")]
    fatigue: Fatigue


def exponents_of(bearing: AbstractBearing) -> Fatigue:
    """Exponents and constants of its rolling elements."""
    return nearest_entry(_FATIGUE, bearing)


def contact_capacities(
    bearing: AbstractBearing, capacity: Scalar, angle: Scalar
) -> Float[Array, "2"]:
    """Load of every contact under which a raceway lasts a million revolutions.

    Args:
        bearing: A single row.
        capacity: Its dynamic rating C [N].
        angle: Nominal contact angle α [rad].

    Returns:
        Q_ce, Q_ci of the outer and the inner raceway, or of housing and shaft washer
        [N].

    Source: ISO/TS 16281:2008, but cos α as above.
    """
    kind = exponents_of(bearing)
    thrust = is_axial(bearing.is_thrust, angle)
    many = bearing.n_elements * jnp.where(thrust, jnp.sin(angle), jnp.cos(angle))
    ratio = nearest_entry(_RING_RATIO, bearing)(bearing, angle)
    weaker = ratio * jnp.where(thrust, 1.0, kind.ratio)
    outer, inner = (jnp.where(thrust, 1.0, j) for j in kind.radial)
    of_c = capacity / (many * jnp.where(thrust, *reversed(kind.reduction)))
    n, d = kind.share
    power = weaker ** (n / d)
    return of_c * jnp.stack(
        [
            (1.0 + 1.0 / power) ** (d / n) / outer,
            (1.0 + power) ** (d / n) / inner,
        ]
    )


def _ratio_of_rollers(bearing, angle):
    gamma = bearing.roller_diameter * jnp.cos(angle) / bearing.pitch_diameter
    return ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)


def _ratio_of_balls(bearing, angle):
    gamma = bearing.ball_diameter * jnp.cos(angle) / bearing.pitch_diameter
    outer, inner = (d + 0.5 * bearing.ball_diameter for d in bearing.centre_distances)
    less = [2.0 * r - bearing.ball_diameter for r in (outer, inner)]
    osculation = (inner / outer * less[0] / less[1]) ** 0.41
    return ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * osculation


_RING_RATIO = {
    AbstractBallBearing: _ratio_of_balls,
    AbstractRollerBearing: _ratio_of_rollers,
}
"""Contact capacity of the inner over that of the outer raceway, by class [1]."""


def row_fatigue(
    bearing: AbstractBearing,
    capacity: Scalar,
    angle: Scalar,
    loads: Float[Array, "element 2 track"],
    turning: Float[Array, "2"],
    amplitude: Scalar | None = None,
) -> RowFatigue:
    """Fatigue of a row.

    Args:
        bearing: A single row.
        capacity: Its dynamic rating C [N].
        angle: Nominal contact angle α [rad].
        loads: Load of every element on both raceways: of balls on each arc, of rollers
            on each lamina, with its concentration of stress [N].
        turning: 1 where the ring turns against the load, 0 where it does not.
        amplitude: Half of the swing of an oscillation [rad]; 0, `None`: the rings turn.

    Source: ISO/TS 16281:2008, basic reference rating life and equivalent load of a
        lamina; of thrust bearings, whose formula was not found, by the statics above.
    """
    kind = exponents_of(bearing)
    balls = kind is BALLS
    tracks = 1 if balls else loads.shape[2]
    capacities = contact_capacities(bearing, capacity, angle)
    # The volume at risk of a lamina is less than the roller's: q_c = Q_c n^(-7/9).
    x = loads * (tracks ** (7.0 / 9.0) / capacities)[None, :, None]
    # Empty places carry nothing.
    count = bearing.n_elements
    wear = positive_power(x, *kind.load)
    turns = positive_power(jnp.sum(wear, 0) / count, *kind.spread)
    arcs = jnp.ones_like(turning)
    if amplitude is not None:
        swings = amplitude > 0
        swing = jnp.where(swings, amplitude, 1.0)
        turns = jnp.where(swings, mean_of_swing(wear, count, swing, kind.spread), turns)
        covering = swing / critical_amplitudes(bearing, angle)
        uneven = arc_factor(covering, kind.spread[0] / kind.spread[1])
        arcs = jnp.where(swings, uneven, 1.0)
    stands = jnp.sum(positive_power(x, *kind.share), 0) / count
    share = jnp.where(turning[:, None] > 0, turns, stands)
    thrust = is_axial(bearing.is_thrust, angle)
    whole = capacity / jnp.where(thrust, *reversed(kind.reduction))
    n, d = kind.share
    # Balls have no parts of their own in the standard: their load follows from L10r.
    outer = 1.0 if balls else jnp.where(thrust, 1.0, kind.ratio ** (n / d))
    part = tracks * (outer * share[0] + share[1])
    load = whole * jnp.where(thrust, 1.0, kind.lamina) * positive_power(part, d, n)
    return RowFatigue(arcs[:, None] * share, load, kind)


def edge_stress(n_laminae: int) -> np.ndarray:
    """Concentration of stress of every lamina of a roller (lamina,) [1].

    Near 1 but for the laminae at the ends, 2.3 there, whatever the profile: the
    standard's stand-in for a solution of the contact, as `refine` gives one. The fewer
    laminae, the longer these ends: at sharp ends under load the life then depends on
    their number, by a quarter between 30 and 50.

    Args:
        n_laminae: Number of laminae.

    Source: ISO/TS 16281:2008, 1 - 0.01/ln(1.985 |2k - n - 1|/(2n - 2)).
    """
    k = np.arange(1, n_laminae + 1)
    place = np.abs(2 * k - n_laminae - 1) / (2 * n_laminae - 2)
    # In the middle of an odd number the logarithm is infinite.
    middle = place == 0
    logarithm = np.log(1.985 * np.where(middle, 1.0, place))
    return np.where(middle, 1.0, 1.0 - 0.01 / logarithm)

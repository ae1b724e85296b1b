"""Logarithmic profiles: standard, Lundberg, Johns-Gohar, Fujiwara-Kawase."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from ..numerics.types import Number, Real, Reals, Scalar
from ..numerics.units import real
from .checks import in_range
from .profile import AbstractProfile

STEEL_MODULUS = 206e9 / (2.0 * (1.0 - 0.3**2))
"""Contact modulus E* of steel on steel [Pa]."""


class Logarithmic(AbstractProfile):
    """Logarithmic profile of ISO/TS 16281, 0.00035 D ln(1/(1 - (2s/L)²)).

    Infinite at the very end; here limited to 354 times coefficient times D,
    which no load reaches.

    Attributes:
        coefficient: 0.00035 in the standard [1].

    Traced: all fields.
    Source: ISO/TS 16281:2008, reference geometry of rollers.
    """

    about: ClassVar[str] = "ISO/TS 16281: 0.00035 D ln(1/(1 - (2s/L)²))"
    coefficient: Real = eqx.field(
        **real("1", "coefficient of the logarithm", above=0), default=0.00035
    )

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        return self.coefficient * diameter * _log_one_over(2.0 * position / length, 1.0)


class Lundberg(AbstractProfile):
    """Lundberg's profile: even pressure along the roller at the design load.

    Drop Q/(π L E*) ln(1/(1 - (2s/L)²)), infinite at the very end and limited there as
    in `Logarithmic`. It is the drop of roller and raceway together: use it on one.

    Attributes:
        design_load: Load Q of the contact for which it is made [N].
        contact_modulus: E* of the pair [Pa].

    Traced: all fields.
    Source: Lundberg (1939); in the form of Fujiwara and Kawase (2007).
    """

    about: ClassVar[str] = "even pressure along the roller at the design load"
    design_load: Real = eqx.field(
        **real("N", "load Q of the contact for which it is made", above=0)
    )
    contact_modulus: Real = eqx.field(
        **real("Pa", "E* of the pair", above=0), default=STEEL_MODULUS
    )

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        unit = self.design_load / (jnp.pi * length * self.contact_modulus)
        return unit * _log_one_over(2.0 * position / length, 1.0)


class JohnsGohar(AbstractProfile):
    """Johns and Gohar's profile: Lundberg's with a finite end.

    Drop Q/(π L E*) ln(1/(1 - (1 - 0.3033 b/a)(2s/L)²)) with a = L/2.

    Attributes:
        design_load: Load Q of the contact for which it is made [N].
        half_width: Hertz half width b of the contact at that load, from
            `contact.half_width(Q/L, relative radius, E*)` [m].
        contact_modulus: E* of the pair [Pa].

    Traced: all fields.
    Source: Johns and Gohar (1981); in the form of Fujiwara and Kawase (2007).
    """

    about: ClassVar[str] = "Johns and Gohar: Lundberg's with a finite end"
    design_load: Real = eqx.field(
        **real("N", "load Q of the contact for which it is made", above=0)
    )
    half_width: Real = eqx.field(
        **real("m", "Hertz half width b of the contact at that load", above=0)
    )
    contact_modulus: Real = eqx.field(
        **real("Pa", "E* of the pair", above=0), default=STEEL_MODULUS
    )

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        unit = self.design_load / (jnp.pi * length * self.contact_modulus)
        part = 1.0 - 0.3033 * self.half_width / (0.5 * length)
        return unit * _log_one_over(2.0 * position / length, part)

    def _check_against(self, length, diameter):
        in_range(self, "half_width", 0.0, 0.5 * length)


class FujiwaraKawase(AbstractProfile):
    """Fujiwara and Kawase's modified logarithmic profile, three design parameters.

    With A = K1 Q/(π L E*) and x running from 0 where the crowning begins to 1 at the
    end of the roller, drop = A ln(1/(1 - (1 - exp(-zm/A)) x²)); the middle is straight.
    The end drop is limited to some 350 A, which no load reaches.

    Attributes:
        design_load: Load Q of the contact [N].
        load_factor: K1, factor on the design load [1].
        crowned_fraction: K2, crowned part of the length, 0 < K2 ≤ 1 [1].
        end_drop: zm, drop at the very end [m].
        contact_modulus: E* of the pair [Pa].

    Traced: all fields.
    Source: Fujiwara and Kawase, NTN Technical Review 75 (2007), their E' = 2 E*.
    """

    about: ClassVar[str] = "Fujiwara and Kawase: three design parameters"
    design_load: Real = eqx.field(**real("N", "load Q of the contact", above=0))
    load_factor: Real = eqx.field(**real("1", "K1, factor on the design load", above=0))
    crowned_fraction: Real = eqx.field(
        **real("1", "K2, crowned part of the length", above=0, most=1)
    )
    end_drop: Real = eqx.field(**real("m", "z_m, drop at the very end", above=0))
    contact_modulus: Real = eqx.field(
        **real("Pa", "E* of the pair", above=0), default=STEEL_MODULUS
    )

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        load = self.load_factor * self.design_load
        unit = load / (jnp.pi * length * self.contact_modulus)
        # From the end of the roller, where 1 - x² would cancel: x = 1 - out.
        crowned = 0.5 * length * self.crowned_fraction
        out = jnp.minimum((0.5 * length - jnp.abs(position)) / crowned, 1.0)
        rest = out * (2.0 - out) + jnp.exp(-self.end_drop / unit) * (1.0 - out) ** 2
        return -unit * jnp.log(_floor_root(rest))

    def kinks(self, length: Scalar) -> tuple[Scalar, ...]:
        begin = 0.5 * length * (1.0 - self.crowned_fraction)
        return (-begin, begin)


def _log_one_over(x, part):
    """ln(1/(1 - part x²)), limited where the argument vanishes."""
    root = jnp.sqrt(part)
    rest = (1.0 - root * x) * (1.0 + root * x)
    if rest.dtype == jnp.float64:
        return -jnp.log(_floor_root(rest))
    # In float32 the smallest number would limit the drop to one that loads can reach,
    # and so would the round-off of a position near the end: there take float64's limit.
    least = 8.0 * jnp.finfo(rest.dtype).eps
    return jnp.where(rest > least, -jnp.log(jnp.maximum(rest, least)), _MOST)


_MOST = 354.198209
"""Logarithm at the very end of a profile that is infinite there [1]: that of float64,
half of ln(1/2.2e-308)."""


def _floor_root(rest):
    """At least the root of the smallest number, so that first and second derivatives
    of its logarithm stay finite."""
    return jnp.maximum(rest, jnp.sqrt(jnp.finfo(rest.dtype).tiny))

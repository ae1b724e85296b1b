"""Film thickness of elliptical and line contacts.

A formula is a product of powers, and all but the speed is known once the load is: a
`Film` holds factors and exponents, so that the film at a speed costs one power. With

    U = μ₀ u/(E' R), G = E' α, W = Q/(E' R²) or q/(E' R), E' = 2 E*,

u is the mean of both surface speeds relative to the contact, R the relative radius in
rolling direction, κ the semi-axis of the ellipse across over that in rolling direction.
"""

from enum import IntEnum

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design.checks import check, is_traced, non_negative, number, positive
from ..numerics.power import smooth_power
from ..numerics.types import Count, Flag, Number, Scalar, as_real
from ..numerics.units import unit

# U below which the film falls as its square, micrometres per second: the formulas' own
# power has no derivative at rest.
_REST = 1e-16
# W below which the film no longer grows, millinewtons: it would be infinite unloaded.
_UNLOADED = 1e-10


class Regime(IntEnum):
    """Whether pressure thickens the oil and flattens the surfaces."""

    ISOVISCOUS_RIGID = 0
    PIEZOVISCOUS_RIGID = 1
    ISOVISCOUS_ELASTIC = 2
    PIEZOVISCOUS_ELASTIC = 3


class Film(eqx.Module):
    """Film of a contact under its load, for any speed; from `point_film`, `line_film`.

    At rest the film is zero, smoothly, and a law of traction that divides by it needs
    `at_least`. An unloaded contact has the finite film of a load of W = 1e-10.

    Attributes:
        unit_speed: Speed at which U = 1 [m/s].
        central_factor: Central film there [m].
        factors: Minimum film there by the formula of each `Regime` (4,) [m].
        central_exponent: Exponent of U in the central film.
        exponents: Exponents of the minimum films (4,).

    Static: both exponents.
    """

    unit_speed: Scalar = eqx.field(metadata=unit("m/s"))
    central_factor: Scalar = eqx.field(metadata=unit("m"))
    factors: Float[Array, "4"] = eqx.field(metadata=unit("m"))
    central_exponent: float = eqx.field(static=True)
    exponents: tuple[float, ...] = eqx.field(static=True)

    def central(self, speed: Number) -> Scalar:
        """Film in the middle of the contact [m].

        Args:
            speed: Entrainment speed, the mean of both surface speeds relative to the
                contact, of either sign [m/s].
        """
        return self.central_factor * self._power(speed, self.central_exponent)

    def minimum(self, speed: Number) -> Scalar:
        """Least film [m]; `speed` as in `central`."""
        return self._of_regimes(speed)[-1]

    def regime(self, speed: Number) -> Count:
        """Code of the `Regime`.

        Surfaces are rigid where the film of rigid surfaces and constant viscosity is
        thicker than either elastic one; pressure thickens the oil where that makes the
        film thicker. At rest: 0.

        Source: the charts of Johnson (1970) and of Hamrock & Dowson (1979), read with
            Johnson's narrow piezoviscous-rigid wedge for line contacts too.
        """
        plain, thick, soft, both = self._of_regimes(speed)
        elastic = jnp.maximum(soft, both) > plain
        piezoviscous = jnp.where(elastic, both > soft, thick > plain)
        return 2 * elastic.astype(int) + piezoviscous.astype(int)

    def outside_validity(self, speed: Number) -> Flag:
        """Whether the contact is not elastohydrodynamic, which the formulas are for."""
        return self.regime(speed) != Regime.PIEZOVISCOUS_ELASTIC

    def _of_regimes(self, speed):
        powers = [self._power(speed, exponent) for exponent in self.exponents]
        return [factor * p for factor, p in zip(self.factors, powers, strict=True)]

    def _power(self, speed, exponent):
        return smooth_power(as_real(speed) / self.unit_speed, exponent, _REST)


def point_film(
    load: Number,
    ratio: Number,
    radius: Number,
    modulus: Number,
    viscosity: Number,
    coefficient: Number,
) -> Film:
    """Film of an elliptical contact, rolling along the short axis.

    Central H = 2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 exp(-0.73 κ)), least film
    H = 3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 κ)), both times R.

    Args:
        load: Normal load Q, at least 0 [N].
        ratio: κ, semi-axis across over that in rolling direction, at least 1 [1].
        radius: Relative radius in rolling direction R [m].
        modulus: Contact modulus E*; E' is twice it [Pa].
        viscosity: μ₀ at the inlet, atmospheric pressure [Pa s].
        coefficient: Pressure-viscosity coefficient α [1/Pa].

    Valid: fitted for 1 ≤ κ ≤ 8, U of 1.7e-12 to 5e-11, W of 1e-7 to 1.3e-6 and G of
        2300 to 6800; used well beyond. See `Film.outside_validity`.
    Source: Hamrock & Dowson, J. Lubrication Technology 99 (1977) 264-276; films of the
        other regimes: Hamrock & Dowson (1979), piezoviscous and rigid: Jeng, Hamrock &
        Brewe (1987).
    """
    title = "point_film"
    modulus, radius, mu, alpha = _check(title, modulus, radius, viscosity, coefficient)
    non_negative(title, "load", load, "N")
    number(title, "ratio", ratio, "")
    if not is_traced(ratio):
        words = "at least 1: across over rolling direction"
        check(title, "ratio", ratio >= 1.0, words, ratio, "")
    g, w = _groups(modulus, alpha, as_real(load) / (2.0 * modulus * radius**2))
    k = as_real(ratio)
    spread = k ** (0.5 * jnp.pi)  # transverse over rolling radius, nearly
    leak = 1.0 / (1.0 + 2.0 / (3.0 * spread))
    rigid = 128.0 * spread * (leak * (0.131 * jnp.arctan(0.5 * spread) + 1.683)) ** 2
    factors = (
        rigid * w**-2.0,
        141.0 * g**0.375 * w**-0.875 * -jnp.expm1(-0.0387 * spread),
        8.70 * w ** (0.67 * 8.0 / 3.0 - 2.0) * (1.0 - 0.85 * jnp.exp(-0.31 * k)),
        3.63 * g**0.49 * w**-0.073 * -jnp.expm1(-0.68 * k),
    )
    return Film(
        unit_speed=2.0 * modulus * radius / mu,
        central_factor=radius
        * (2.69 * g**0.53 * w**-0.067 * (1.0 - 0.61 * jnp.exp(-0.73 * k))),
        factors=radius * jnp.stack(factors),
        central_exponent=0.67,
        exponents=(2.0, 1.25, 0.66, 0.68),
    )


def line_film(
    line_load: Number,
    radius: Number,
    modulus: Number,
    viscosity: Number,
    coefficient: Number,
) -> Film:
    """Film of a line contact.

    Central H = 2.922 U^0.692 G^0.470 W^-0.166, least film
    H = 1.714 U^0.694 G^0.568 W^-0.128, both times R.

    Args:
        line_load: Load per length q, at least 0 [N/m].
        radius, modulus, viscosity, coefficient: As in `point_film`.

    Source: Pan & Hamrock, J. Tribology 111 (1989) 246-251; films of the other regimes:
        Martin (1916), Blok (1950), Herrebrugh (1968), as in Johnson (1970).
    """
    title = "line_film"
    modulus, radius, mu, alpha = _check(title, modulus, radius, viscosity, coefficient)
    non_negative(title, "line_load", line_load, "N/m")
    g, w = _groups(modulus, alpha, as_real(line_load) / (2.0 * modulus * radius))
    factors = (
        4.9 / w,
        1.66 * g ** (2.0 / 3.0),
        3.10 * w**-0.2,
        1.714 * g**0.568 * w**-0.128,
    )
    return Film(
        unit_speed=2.0 * modulus * radius / mu,
        central_factor=radius * (2.922 * g**0.470 * w**-0.166),
        factors=radius * jnp.stack(factors),
        central_exponent=0.692,
        exponents=(1.0, 2.0 / 3.0, 0.6, 0.694),
    )


def _check(title, modulus, radius, viscosity, coefficient) -> tuple[Scalar, ...]:
    positive(title, "modulus", modulus, "Pa")
    positive(title, "radius", radius, "m")
    positive(title, "viscosity", viscosity, "Pa s")
    positive(title, "coefficient", coefficient, "1/Pa")
    return tuple(as_real(x) for x in (modulus, radius, viscosity, coefficient))


def _groups(modulus, coefficient, load):
    """G, and W kept from zero."""
    return 2.0 * modulus * coefficient, jnp.sqrt(load * load + _UNLOADED**2)

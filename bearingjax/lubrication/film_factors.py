"""Film factors: heated or starved inlet, standstill, rough surfaces."""

import equinox as eqx
import jax.numpy as jnp

from ..design.checks import check, is_traced, non_negative, number, positive
from ..numerics.power import smooth_power
from ..numerics.types import Number, Scalar, as_real
from ..numerics.units import unit
from .patch import AbstractPatch

# Entrainment speed below which the slide-to-roll ratio falls to zero [m/s].
_SLOW = 1e-6


def inlet_heating(
    loading: Number, peak_pressure: Number, modulus: Number, slide_to_roll: Number
) -> Scalar:
    """Factor of the film, at most 1, for the oil sheared warm in the inlet.

    (1 - 13.2 (p/E') L^0.42)/(1 + 0.213 (1 + 2.23 S^0.83) L^0.64). Where the numerator
    would fall below one half, far outside its range, it goes on as a hyperbola.

    Args:
        loading: Thermal loading parameter L, from `Lubricant.thermal_loading` [1].
        peak_pressure: Hertz's largest pressure [Pa].
        modulus: Contact modulus E*; E' is twice it [Pa].
        slide_to_roll: S, slip over entrainment speed, of either sign [1].

    Source: Gupta, Cheng, Zhu, Forster & Schrand, Tribology Transactions 35 (1992)
        269-274.
    """
    heat = as_real(loading)
    relative = as_real(peak_pressure) / (2.0 * as_real(modulus))
    x = 13.2 * relative * smooth_power(heat, 0.42, 1e-8)
    pressed = jnp.where(x < 0.5, 1.0 - x, 0.25 / jnp.maximum(x, 0.5))
    sheared = 1.0 + 2.23 * smooth_power(as_real(slide_to_roll), 0.83, 1e-6)
    return pressed / (1.0 + 0.213 * sheared * smooth_power(heat, 0.64, 1e-8))


class WarmInlet(eqx.Module):
    """Oil that shearing warms in the inlets of contacts, at any speed.

    Attributes:
        loading: Thermal loading parameter at 1 m/s, L/u² [s²/m²].
        modulus: Contact modulus E* [Pa].
    """

    loading: Scalar = eqx.field(metadata=unit("s²/m²"))
    modulus: Scalar = eqx.field(metadata=unit("Pa"))

    def factor(self, patch: AbstractPatch, slip: Scalar, speed: Scalar) -> Scalar:
        """`inlet_heating` of a contact [1].

        Args:
            patch: Contact under its load.
            slip: Slip in rolling direction [m/s].
            speed: Entrainment speed [m/s].
        """
        ratio = slip * speed / (speed * speed + _SLOW * _SLOW)
        heat = self.loading * speed * speed
        return inlet_heating(heat, patch.peak, self.modulus, ratio)


def starvation(
    inlet: Number, central: Number, minimum: Number, radius: Number, semi_axis: Number
) -> tuple[Scalar, Scalar]:
    """Factors of central and least film, at most 1, for a starved inlet.

    Args:
        inlet: Distance of the oil's edge from the middle of the contact, over the
            semi-axis in rolling direction, above 1 [1].
        central, minimum: Films with plenty of oil [m].
        radius: Relative radius in rolling direction [m].
        semi_axis: Semi-axis in rolling direction [m].

    Source: Hamrock & Dowson, J. Lubrication Technology 99 (1977) 15-23.
    """
    number("starvation", "inlet", inlet, "")
    if not is_traced(inlet):
        words = "above 1, the edge of the contact"
        check("starvation", "inlet", inlet > 1.0, words, inlet, "")
    inlet, scale = as_real(inlet), as_real(radius) / as_real(semi_axis) ** 2

    def factor(film, share, exponent, power):
        # Inlet distance that is enough over the one there is.
        enough = share * smooth_power(as_real(film) * scale, exponent, 1e-8)
        return jnp.maximum(enough / (inlet - 1.0), 1.0) ** -power

    return factor(central, 3.06, 0.58, 0.29), factor(minimum, 3.34, 0.56, 0.25)


def at_least(film: Scalar, least: Number) -> Scalar:
    """Film with a lower bound that remains at standstill: sqrt(film² + least²) [m].

    Args:
        film: Film thickness [m].
        least: Positive thickness, such as the composite roughness [m].
    """
    positive("at_least", "least", least, "m")
    return jnp.sqrt(film * film + as_real(least) ** 2)


def lambda_ratio(film: Number, roughness: Number, other: Number) -> Scalar:
    """Film over composite roughness, film/sqrt(R1² + R2²) [1].

    Args:
        film: Film thickness, usually the least [m].
        roughness, other: Root mean square roughness of both surfaces [m].
    """
    non_negative("lambda_ratio", "roughness", roughness, "m")
    positive("lambda_ratio", "other", other, "m")
    return as_real(film) / jnp.hypot(as_real(roughness), as_real(other))

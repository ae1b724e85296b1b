"""Named oils."""

import math
from functools import partial

from ..numerics.types import Number, array_namespace, as_real, in_numpy
from .coefficient import DynamicCoefficient, KinematicCoefficient
from .lubricant import Density, Lubricant
from .viscosity import Exponential, FreeVolume, Roelands, Walther

GRADES = (10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460)
"""ISO viscosity grades among the named oils."""


def mil_l_23699() -> Lubricant:
    """Ester oil of aircraft engines to MIL-L-23699 (MIL-PRF-23699), 5 mm²/s at 100 °C.

    Temperature: 0.0276 exp(3609.6 D + 7.7657e5 D²) Pa s, D = 1/T - 1/311.11 K.
    Film coefficient: exp(-17.496) μ^0.15607 1/Pa. Density: 966 and 922 kg/m³ at 300
    and 367 K, 0.6 % low at 233 K. Pressure: a free volume law fitted to these, not
    measured; its constants of Tait are generic. Its α* is 15.96 1/GPa at 30 °C, and
    within 6 % of the film coefficient from 20 to 100 °C.

    Source: correlations of the ADORE programs (Gupta) for this oil; viscosities within
        the military specification (4.9 to 5.4 mm²/s at 100 °C).
    """
    return Lubricant(
        ambient=Exponential(0.0276, 311.11, 3609.6, 7.7657e5),
        pressure=free_volume_23699(),
        density=Density(966.0, (966.0 - 922.0) / (367.0 - 300.0), 300.0),
        coefficient=DynamicCoefficient(math.exp(-17.496), 0.15607),
    )


def free_volume_23699() -> FreeVolume:
    """The free volume law fitted to MIL-L-23699: to 3 % of its μ(T), 20 to 130 °C.

    Source: fitted to the correlations of `mil_l_23699`; a surrogate, for the measured
        set of Bair & Kottke (2003) was not at hand.
    """
    return FreeVolume(
        reference_viscosity=0.0376390,
        B=2.30134,
        R0=0.728634,
        epsilon=-1.02448e-3,
        a_V=7.1e-4,
        K0_prime=11.0,
        K00=9.0e9,
        beta_K=6.5e-3,
        reference_temperature=303.15,
    )


def iso_vg(grade: Number, viscosity_index: Number = 95.0) -> Lubricant:
    """Paraffinic mineral oil of an ISO viscosity grade.

    Args:
        grade: ISO VG: kinematic viscosity at 40 °C in mm²/s.
        viscosity_index: Viscosity index, 0 to 400 [1].

    Source: temperature by ASTM D341 and D2270; pressure by Roelands with the
        coefficient of mineral oils of Gold et al. (2001); density
        872 + 12 ln(grade/32) kg/m³ at 15 °C, usual data-sheet values to 10 kg/m³.
    """
    grade = in_numpy(as_real(grade))
    coefficient = KinematicCoefficient(9.904e-9, 0.139)
    return Lubricant(
        ambient=Walther.from_grade(grade, viscosity_index),
        pressure=Roelands(coefficient),
        density=Density(872.0 + 12.0 * array_namespace(grade).log(grade / 32.0)),
        coefficient=coefficient,
    )


OILS = {"MIL-L-23699": mil_l_23699} | {
    f"ISO VG {grade}": partial(iso_vg, float(grade)) for grade in GRADES
}
"""Makers of the named oils."""

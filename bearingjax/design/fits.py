"""Fits of rings on shaft and in housing, and the radial internal clearance they leave.

Shaft, rings and housing are thick-walled cylinders in plane stress, each ring as thick
as from its seat to the bottom of its raceway: without shoulders, of full section. All
lengths are of diameters. An interference is positive where the fit is tight; a loose
fit has no pressure.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp

from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .checks import check, concrete, in_range, instance, non_negative, number, positive
from .iso286 import Limits
from .material import Material


class WarmMaterial(eqx.Module):
    """A material and its thermal expansion, by default of bearing steel.

    Attributes:
        material: Elastic constants and density.
        expansion: Coefficient of linear thermal expansion α [1/K].

    Traced: all fields.

    Source: 12e-6 1/K of bearing steel: catalogue of SNH; NTN and IKO print 12.5e-6.
    """

    material: Material = eqx.field(default_factory=Material)
    expansion: Scalar = eqx.field(
        converter=as_real, metadata=unit("1/K"), default=12e-6
    )

    def __check_init__(self):
        instance(self, "material", Material)
        number(self, "expansion")


class Mounting(eqx.Module):
    """A radial bearing on its shaft and in its housing.

    Attributes:
        bore: Bore diameter of the inner ring, d [m].
        inner_raceway: Diameter of the inner raceway where it is smallest, F [m].
        outer_raceway: Diameter of the outer raceway where it is largest, E [m].
        outside_diameter: Of the outer ring, D [m].
        housing_diameter: Outside diameter of the housing around the bearing [m].
        radial_clearance: Radial internal clearance before mounting [m].
        shaft_interference: Diameter of the shaft less the bore, as measured [m].
        housing_interference: Outside diameter of the bearing less the housing's bore,
            as measured [m].
        shaft_bore: Bore of a hollow shaft; 0 of a solid one [m].
        shaft_smoothing: Interference that the smoothed surfaces take away, on the shaft
            (`smoothing`) [m].
        housing_smoothing: Likewise in the housing [m].
        shaft, inner_ring, outer_ring, housing, elements: Materials; of the rolling
            elements only their expansion counts.

    Traced: all fields.
    """

    bore: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    inner_raceway: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    outer_raceway: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    outside_diameter: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    housing_diameter: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    radial_clearance: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    shaft_interference: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    housing_interference: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    shaft_bore: Scalar = eqx.field(converter=as_real, metadata=unit("m"), default=0.0)
    shaft_smoothing: Scalar = eqx.field(
        converter=as_real, metadata=unit("m"), default=0.0
    )
    housing_smoothing: Scalar = eqx.field(
        converter=as_real, metadata=unit("m"), default=0.0
    )
    shaft: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    inner_ring: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    outer_ring: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    housing: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    elements: WarmMaterial = eqx.field(default_factory=WarmMaterial)

    def __check_init__(self):
        positive(self, "bore")
        smaller = "bore"
        for name in _DIAMETERS[1:]:
            _larger(self, name, smaller)
            smaller = name
        in_range(self, "shaft_bore", 0.0, self.bore, include_low=True)
        for name in ("radial_clearance", "shaft_interference", "housing_interference"):
            number(self, name)
        for name in ("shaft_smoothing", "housing_smoothing"):
            non_negative(self, name)
        for name in ("shaft", "inner_ring", "outer_ring", "housing", "elements"):
            instance(self, name, WarmMaterial)


_DIAMETERS = (
    "bore",
    "inner_raceway",
    "outer_raceway",
    "outside_diameter",
    "housing_diameter",
)


def _larger(owner, name, smaller):
    """Raise unless a diameter is above another one, which the message names."""
    positive(owner, name)
    known = concrete(getattr(owner, name), getattr(owner, smaller))
    if known is not None:
        check(owner, name, known[0] > known[1], f"above `{smaller}`, {known[1]:.6g} m")


class FitConditions(eqx.Module):
    """Temperatures above that of the measured sizes, and speed.

    Attributes:
        shaft: Temperature rise of the shaft, even throughout it; likewise below [K].
        inner_ring: Of the inner ring [K].
        elements: Of the rolling elements [K].
        outer_ring: Of the outer ring [K].
        housing: Of the housing [K].
        speed: Speed at which shaft and inner ring rotate [rad/s].

    Traced: all fields.
    """

    shaft: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    inner_ring: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    elements: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    outer_ring: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    housing: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    speed: Scalar = eqx.field(converter=as_real, metadata=unit("rad/s"), default=0.0)

    def __check_init__(self):
        for name in (
            "shaft",
            "inner_ring",
            "elements",
            "outer_ring",
            "housing",
            "speed",
        ):
            number(self, name)


def smoothing(seat: Any, ring: Any) -> Any:
    """Interference that two fitted surfaces lose as their peaks are smoothed [m].

    0.4 (Rz + Rz), of the diameter.

    Args:
        seat, ring: Mean roughness depth Rz of shaft or housing, and of the ring [m].

    Source: DIN 7190-1 (2017), as the manual of the bearing program of MESYS states it;
        earlier editions took twice as much.
    """
    return 0.4 * (seat + ring)


class FitState(NamedTuple):
    """What fits, temperatures and speed do to a bearing.

    Attributes:
        shaft_interference: Interference left between shaft and inner ring, less the
            smoothing; negative is loose [m].
        housing_interference: Likewise between outer ring and housing [m].
        shaft_pressure: Pressure between shaft and inner ring, 0 where loose [Pa].
        housing_pressure: Likewise between outer ring and housing [Pa].
        inner_raceway_growth: Growth of the inner raceway's diameter [m].
        outer_raceway_growth: Growth of the outer raceway's diameter [m].
        radial_clearance: Radial internal clearance in these conditions [m].
    """

    shaft_interference: Any
    housing_interference: Any
    shaft_pressure: Any
    housing_pressure: Any
    inner_raceway_growth: Any
    outer_raceway_growth: Any
    radial_clearance: Any


def fit_state(mounting: Mounting, conditions: FitConditions | None = None) -> FitState:
    """Fits and radial internal clearance of a mounted bearing, unloaded.

    Differentiable with respect to every number; where a fit just comes loose the slope
    is the mean of both sides.

    Args:
        mounting: The bearing and its seats.
        conditions: Temperatures and speed; `None` is mounted, at rest, at the
            temperature of the measured sizes.

    Source: Lamé's thick cylinders and rotating discs, Timoshenko & Goodier, Theory of
        Elasticity (1970), articles 28 and 32.
    """
    m, c = mounting, FitConditions() if conditions is None else conditions
    shaft_interference = (
        m.shaft_interference
        - m.shaft_smoothing
        + m.bore * (_strain(m.shaft, c.shaft) - _strain(m.inner_ring, c.inner_ring))
        + _spin_outside(m.shaft.material, m.shaft_bore, m.bore, c.speed)
        - _spin_inside(m.inner_ring.material, m.bore, m.inner_raceway, c.speed)
    )
    housing_interference = (
        m.housing_interference
        - m.housing_smoothing
        + m.outside_diameter
        * (_strain(m.outer_ring, c.outer_ring) - _strain(m.housing, c.housing))
    )
    shaft_pressure = jnp.maximum(shaft_interference, 0.0) / (
        _squeeze(m.shaft.material, m.shaft_bore, m.bore)
        + _stretch(m.inner_ring.material, m.bore, m.inner_raceway)
    )
    housing_pressure = jnp.maximum(housing_interference, 0.0) / (
        _squeeze(m.outer_ring.material, m.outer_raceway, m.outside_diameter)
        + _stretch(m.housing.material, m.outside_diameter, m.housing_diameter)
    )
    inner = (
        m.inner_raceway * _strain(m.inner_ring, c.inner_ring)
        + _spin_outside(m.inner_ring.material, m.bore, m.inner_raceway, c.speed)
        + shaft_pressure
        * _across(m.inner_ring.material, m.bore, m.inner_raceway, m.bore)
    )
    outer = m.outer_raceway * _strain(
        m.outer_ring, c.outer_ring
    ) - housing_pressure * _across(
        m.outer_ring.material, m.outer_raceway, m.outside_diameter, m.outside_diameter
    )
    # Two rolling elements and the clearance fill the room between the raceways.
    elements = (m.outer_raceway - m.inner_raceway - m.radial_clearance) * _strain(
        m.elements, c.elements
    )
    return FitState(
        shaft_interference,
        housing_interference,
        shaft_pressure,
        housing_pressure,
        inner,
        outer,
        m.radial_clearance + outer - inner - elements,
    )


def _strain(body, rise):
    return body.expansion * rise


def _squeeze(material, inside, outside):
    """Loss of outside diameter over a pressure on it [m/Pa]."""
    ratio = (outside**2 + inside**2) / (outside**2 - inside**2)
    return outside / material.elastic_modulus * (ratio - material.poisson_ratio)


def _stretch(material, inside, outside):
    """Growth of inside diameter over a pressure in it [m/Pa]."""
    ratio = (outside**2 + inside**2) / (outside**2 - inside**2)
    return inside / material.elastic_modulus * (ratio + material.poisson_ratio)


def _across(material, inside, outside, pressed):
    """Change of the other diameter of a ring over a pressure on one, `pressed` [m/Pa].

    The stress at the free surface is a hoop stress alone, 2 p pressed²/(b² - a²).
    """
    free = inside + outside - pressed
    stress = 2.0 * pressed**2 / (outside**2 - inside**2)
    return stress * free / material.elastic_modulus


def _spin_outside(material, inside, outside, speed):
    """Growth of the outside diameter of a ring that rotates [m]."""
    return _spin(material, outside, inside, speed)


def _spin_inside(material, inside, outside, speed):
    """Growth of the inside diameter of a ring that rotates [m]."""
    return _spin(material, inside, outside, speed)


def _spin(material, own, other, speed):
    """Growth of one diameter of a free ring: hoop strain at that free surface [m].

    σ = ρ ω²/4 ((3 + ν) other² + (1 - ν) own²), in radii.
    """
    nu = material.poisson_ratio
    hoop = (
        material.density
        * speed**2
        / 16.0
        * ((3.0 + nu) * other**2 + (1.0 - nu) * own**2)
    )
    return own * hoop / material.elastic_modulus


class ClearanceRange(NamedTuple):
    """Radial internal clearance of many bearings whose sizes scatter.

    Attributes:
        middle: With all sizes in the middle of their limits [m].
        worst: Least and largest of all [m].
        probable: Root sum of squares of what each size does alone, about the middle:
            the same share of bearings is within as of each size within its limits, if
            sizes are normal and independent, and fits do not come loose [m].
    """

    middle: Any
    worst: Limits
    probable: Limits


def clearance_range(
    mounting: Mounting,
    clearance: Limits,
    shaft: Limits,
    bore: Limits,
    housing: Limits,
    outside_diameter: Limits,
    conditions: FitConditions | None = None,
) -> ClearanceRange:
    """Radial internal clearance over the tolerances of all sizes of a mounting.

    Args:
        mounting: The bearing and its seats; its clearance and interferences do not
            count, all else does.
        clearance: Limits of the clearance before mounting [m].
        shaft, bore, housing, outside_diameter: Limits of the deviations of shaft
            diameter, bore, housing bore and outside diameter (`limits`, `bore_limits`,
            `outside_limits`) [m].
        conditions: As of `fit_state`.

    Raises:
        ValueError: If a lower limit is above the upper one.
    """
    given = {
        "clearance": clearance,
        "shaft": shaft,
        "bore": bore,
        "housing": housing,
        "outside_diameter": outside_diameter,
    }
    for name, (lower, upper) in given.items():
        known = concrete(lower, upper)
        if known is not None and known[0] > known[1]:
            raise ValueError(
                f"clearance_range: `{name}` is {known[0]:.6g} to {known[1]:.6g} m; its"
                " lower limit must not be above its upper one."
            )

    def result(sizes):
        return fit_state(
            replace(
                mounting,
                radial_clearance=sizes["clearance"],
                shaft_interference=sizes["shaft"] - sizes["bore"],
                housing_interference=sizes["outside_diameter"] - sizes["housing"],
            ),
            conditions,
        ).radial_clearance

    # Large shafts and outside diameters take clearance, the other sizes give it.
    tight = {
        name: limits[1 if name in ("shaft", "outside_diameter") else 0]
        for name, limits in given.items()
    }
    loose = {
        name: limits[0 if name in ("shaft", "outside_diameter") else 1]
        for name, limits in given.items()
    }
    mean = {name: (tight[name] + loose[name]) / 2.0 for name in given}
    middle = result(mean)
    squares = sum(
        (result({**mean, name: loose[name]}) - result({**mean, name: tight[name]})) ** 2
        / 4.0
        for name in given
    )
    half = jnp.sqrt(squares)
    return ClearanceRange(
        middle,
        Limits(result(tight), result(loose)),
        Limits(middle - half, middle + half),
    )

"""Thermal reference speed; worked and printed speeds are validation cases."""

import jax
import numpy as np
import pytest
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.friction import (
    heat_area,
    reference_factors,
    reference_speed,
    thermal_speed,
)
from bearingjax.friction.reference_speed import _FACTORS, _factors_of

RPM = 30.0 / np.pi


def test_friction_balances_the_heat_of_a_large_bearing():
    """Above 50 000 mm² the flow falls; the equation as ISO 15312 writes it, in mm."""
    bore, outside, width, static = 0.2, 0.36, 0.098, 1.93e6
    area = heat_area(bore, outside, width)
    speed = float(reference_speed(0.28, area, static, (4.0, 0.00019))) * RPM
    drag = 1e-7 * 4.0 * (12.0 * speed) ** (2 / 3) * 280.0**3
    friction = np.pi * speed / 30e3 * (drag + 0.00019 * 0.05 * static * 280.0)
    surface = 1e6 * area
    heat = 0.016 * (surface / 5e4) ** -0.34 * surface
    assert surface > 5e4 and friction == pytest.approx(heat, rel=1e-9)


def test_slopes():
    start = np.array([0.14, 0.0405, 475e3, 4.0, 0.00019])

    def speed(x):
        return reference_speed(x[0], x[1], x[2], (x[3], x[4]))

    slopes = jax.jit(jax.grad(speed))(start)
    for k, slope in enumerate(slopes):
        step = 1e-5 * start[k] * np.eye(5)[k]
        ends = [float(speed(start + sign * step)) for sign in (-1, 1)]
        difference = (ends[1] - ends[0]) / (2e-5 * start[k])
        np.testing.assert_allclose(slope, difference, rtol=10 * DIFFERENCE)


def test_speeds_of_the_catalogue():
    known = thermal_speed(bj.catalogue_entry("22220"))
    assert known is not None
    factors = reference_factors("spherical_roller", "22")
    assert factors is not None
    static = bj.catalogue_entry("22220").static_capacity
    assert static is not None
    own = reference_speed(0.14, heat_area(0.1, 0.18, 0.046), static, factors)
    assert known == pytest.approx(float(own), rel=1e-12)
    # A surface by its washers, another by its outside; none where no factors are.
    entry = bj.catalogue_entry("29412")
    names = "shaft_washer_diameter", "housing_washer_bore"
    shaft, housing = (entry.printed[name] for name in names)
    area = 0.25 * np.pi * (0.13**2 + shaft**2 - housing**2 - 0.06**2)
    own = reference_speed(
        0.095, area, entry.static_capacity, (5.0, 0.0005), thrust=True
    )
    assert thermal_speed(entry) == pytest.approx(float(own), rel=1e-12)
    assert reference_factors("needle_roller", "49") is None
    for name in ("NU 215", "NU 2205", "6205", "7205B", "30205", "81102"):
        assert thermal_speed(bj.catalogue_entry(name)) is not None
    for name in ("NU 305", "6005", "32010 X", "C 3052", "RB 25025", "QJ 211"):
        assert thermal_speed(bj.catalogue_entry(name)) is None


def test_every_series_with_factors_is_reached_by_an_entry():
    """Also with a class of clearance, and where the number has no letters (33010)."""
    reached = {
        (e.type, *factors)
        for e in bj.catalogue_entries()
        if (factors := _factors_of(e)) is not None
    }
    table = {(kind, *f) for kind, rows in _FACTORS.items() for f in rows.values()}
    assert reached == table
    for name in ("6205/C3", "625", "33010", "33110", "33205", "NU 2205 EC/C4"):
        assert thermal_speed(bj.catalogue_entry(name)) is not None
    for name in ("7205 C", "608", "16005", "NU 305 EC"):
        assert thermal_speed(bj.catalogue_entry(name)) is None


@pytest.mark.parametrize(
    "wrong, wanted",
    [
        (dict(area=-1.0), "reference_speed: `area` is -1 m²; it must be above 0"),
        (dict(static_capacity=0.0), "`static_capacity` is 0 N; it must be above 0"),
        (dict(factors=(0.0, 1e-4)), "`f0r` is 0"),
    ],
)
def test_reference_speed_rejects_invalid_arguments(wrong, wanted):
    given = dict(mean_diameter=0.1, area=0.02, static_capacity=1e5, factors=(2.0, 2e-4))
    with pytest.raises(ValueError, match=wanted):
        reference_speed(**{**given, **wrong})

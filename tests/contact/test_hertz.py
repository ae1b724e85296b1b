"""Hertz: half widths, peak pressures and constants against each other and by hand."""

import jax
import jax.numpy as jnp
import numpy as np
from tolerances import ROUNDING

from bearingjax.contact import (
    half_width,
    peak_pressure,
    relative_radius,
    sphere_constant,
    sphere_peak_pressure,
)

MODULUS = jnp.asarray(206e9 / (2 * (1 - 0.3**2)))  # 113187 MPa
LOADS = jnp.asarray([1.0, 50.0, 2e3, 4e4])


def test_modulus_of_steel():
    assert round(float(MODULUS) / 1e6) == 113187


def test_sphere_constant():
    """(4/3) E* sqrt(R), and the approach a²/R of the contact radius a."""
    radius = jnp.asarray([0.01, 0.1, 1.0])
    got = sphere_constant(radius, MODULUS)
    np.testing.assert_allclose(
        got, 4 / 3 * float(MODULUS) * np.sqrt(radius), rtol=ROUNDING
    )
    contact = np.cbrt(3 * 100.0 * np.asarray(radius) / (4 * float(MODULUS)))
    np.testing.assert_allclose(got * (contact**2 / radius) ** 1.5, 100.0, rtol=1e-12)


def test_sphere_peak_pressure():
    """p0 = 3Q/(2π a²) with a³ = 3QR/(4E*)."""
    radius = jnp.asarray(0.25)
    contact = np.cbrt(3 * np.asarray(LOADS) * 0.25 / (4 * float(MODULUS)))
    want = 3 * np.asarray(LOADS) / (2 * np.pi * contact**2)
    got = sphere_peak_pressure(LOADS, radius, MODULUS)
    np.testing.assert_allclose(got, want, rtol=ROUNDING)
    assert sphere_peak_pressure(jnp.asarray(0.0), radius, MODULUS) == 0.0


def test_line_peak_pressure():
    """p0 = 2q/(π b), and an elliptic pressure of this width carries q."""
    line_load, radius = 1e3 * LOADS, jnp.asarray(0.0058)
    b = np.asarray(half_width(line_load, radius, MODULUS))
    want = np.sqrt(4 * np.asarray(line_load) * 0.0058 / (np.pi * float(MODULUS)))
    np.testing.assert_allclose(b, want, rtol=ROUNDING)
    peak = peak_pressure(line_load, radius, MODULUS)
    np.testing.assert_allclose(peak, 2 * line_load / (np.pi * b), rtol=ROUNDING)
    # The other classical form: p0 = E* b/(2ρ).
    np.testing.assert_allclose(peak, MODULUS * b / (2 * 0.0058), rtol=ROUNDING)


def test_line_by_hand():
    """q = 360.5 N/mm on a roller of 14 mm, inner raceway of 29.25 mm: 1.51 GPa."""
    radius = relative_radius(jnp.asarray(0.007), jnp.asarray(0.02925))
    np.testing.assert_allclose(radius, 0.007 * 0.02925 / 0.03625, rtol=ROUNDING)
    peak = peak_pressure(jnp.asarray(360.5e3), radius, MODULUS)
    assert abs(float(peak) / 1e9 - 1.516) < 5e-4


def test_relative_radius():
    """Concave outer raceways conform, convex inner ones do not, flats leave as is."""
    roller = jnp.asarray(0.007)
    inner = relative_radius(roller, jnp.asarray(0.02925))
    outer = relative_radius(roller, jnp.asarray(-0.04325))
    flat = relative_radius(roller, jnp.asarray(jnp.inf))
    assert inner < flat < outer
    np.testing.assert_allclose(flat, 0.007, rtol=ROUNDING)
    np.testing.assert_allclose(outer, 0.007 * 0.04325 / 0.03625, rtol=ROUNDING)


def test_unloaded_lines():
    """Nothing but zero and derivative zero where apart; NaN passes through."""
    radius = jnp.asarray(0.0058)
    for law in (half_width, peak_pressure):
        slope = jax.jit(
            jax.vmap(jax.value_and_grad(lambda q, f=law: f(q, radius, MODULUS)))
        )
        value, derivative = slope(jnp.asarray([0.0, -1.0, jnp.nan, 4.0, 1.0]))
        np.testing.assert_array_equal(value[:2], 0.0)
        np.testing.assert_array_equal(derivative[:2], 0.0)
        assert np.isnan(value[2])
        # A square root: half the value by the load.
        np.testing.assert_allclose(value[3], 2 * value[4], rtol=ROUNDING)
        np.testing.assert_allclose(derivative[3], value[3] / 8.0, rtol=ROUNDING)

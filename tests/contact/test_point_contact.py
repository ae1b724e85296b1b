"""Elliptic Hertz contact: limits, derivatives, brute-force stresses.

Tables are validation cases: `hertz_tables`, `brewe_hamrock_ratios`.
"""

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.contact import (
    axis_stress,
    ellipse,
    shear_below,
    sphere_constant,
    sphere_peak_pressure,
)

MODULUS = jnp.asarray(113.2e9)


def test_peak_pressure():
    """That of an ellipsoid over the contact ellipse, whichever axis is the long one."""
    curvatures = jnp.asarray([[118.0, 90.0, 2.0], [2.0, 30.0, 118.0]])
    contact = ellipse(curvatures[0], curvatures[1], MODULUS)
    load = jnp.asarray(1e3)
    a, b = contact.semi_axes(load)
    peak = contact.peak_pressure(load)
    np.testing.assert_allclose(peak, 1.5 * load / (np.pi * a * b), rtol=ROUNDING)


def test_sphere():
    """Equal curvatures: the closed form of the sphere, no 0/0."""
    radius = jnp.asarray([1e-3, 0.2, 3.0])
    contact = ellipse(1.0 / radius, 1.0 / radius, MODULUS)
    want = sphere_constant(radius, MODULUS)
    np.testing.assert_allclose(contact.constant, want, rtol=ROUNDING)
    np.testing.assert_allclose(contact.ratio, 1.0, rtol=ROUNDING)
    load = jnp.asarray(700.0)
    np.testing.assert_allclose(
        contact.peak_pressure(load),
        sphere_peak_pressure(load, radius, MODULUS),
        rtol=ROUNDING,
    )
    np.testing.assert_allclose(contact.load(contact.approach(load)), load, rtol=1e-12)


def test_mirror():
    """The other axis first: the same contact, over twelve decades of curvature."""
    curvature, one = jnp.asarray(np.geomspace(1e-6, 1e6, 41)), jnp.ones(41)
    soft = jnp.asarray(1.0)
    first, second = ellipse(curvature, one, soft), ellipse(one, curvature, soft)
    np.testing.assert_allclose(first.constant, second.constant, rtol=ROUNDING)
    np.testing.assert_allclose(first.rolling, second.transverse, rtol=ROUNDING)
    np.testing.assert_allclose(first.ratio * second.ratio, 1.0, rtol=ROUNDING)


def test_line_limit():
    """A long ellipse has the pressure of the line contact under its middle.

    The Hertz strip: p0 = E* b ρ/2, from b² = 4 q/(π E* ρ) and q = π b p0/2.
    """
    contact = ellipse(jnp.asarray(100.0), jnp.asarray(1e-6), MODULUS)
    load = jnp.asarray(1e4)
    b, _ = contact.semi_axes(load)
    peak = contact.peak_pressure(load)
    strip = MODULUS * b * 100.0 / 2.0
    # The ellipse is 2e5 times longer than wide: the strip but for its square.
    np.testing.assert_allclose(peak, strip, rtol=1e-6)


def test_derivatives_with_radii():
    """Every output against central differences, exactly at the sphere as well."""

    @jax.jit
    def outputs(curvatures):
        contact = ellipse(curvatures[0], curvatures[1], MODULUS)
        return jnp.log(jnp.stack(contact))

    jacobian = jax.jit(jax.jacfwd(outputs))
    backward, curvature = jax.jit(jax.jacrev(outputs)), jax.jit(jax.hessian(outputs))
    for point in ([80.0, 80.0], [80.0, 79.999999], [80.0, 5.0], [3.0, 90.0]):
        x = jnp.asarray(point)
        forward, reverse = jacobian(x), backward(x)
        np.testing.assert_allclose(forward, reverse, rtol=ROUNDING, atol=ROUNDING)
        second = curvature(x)
        for k in range(2):
            h = 1e-5 * point[k] * np.eye(2)[k]
            rate = (outputs(x + h) - outputs(x - h)) / (2e-5 * point[k])
            np.testing.assert_allclose(forward[:, k], rate, rtol=1e-8, atol=1e-12)
            rate = (jacobian(x + h) - jacobian(x - h)) / (2e-5 * point[k])
            np.testing.assert_allclose(
                second[:, :, k], rate, rtol=DIFFERENCE, atol=1e-10
            )


def test_homogeneous():
    """Euler: scaling both curvatures by s scales K_h by s^(-1/2), E* linearly."""

    def constant(s, e):
        return ellipse(70.0 * s, 4.0 * s, e).constant

    one, e = jnp.asarray(1.0), MODULUS
    value = constant(one, e)
    slopes = jax.grad(constant, argnums=(0, 1))(one, e)
    np.testing.assert_allclose(slopes[0], -0.5 * value, rtol=ROUNDING)
    np.testing.assert_allclose(slopes[1] * e, value, rtol=ROUNDING)


def test_open_and_impossible():
    """No load: zeros with zero slopes. Too tight a groove: NaN, and NaN stays NaN."""
    contact = ellipse(jnp.asarray(70.0), jnp.asarray(4.0), MODULUS)
    for quantity in (contact.approach, contact.load, contact.peak_pressure):
        value, slope = jax.value_and_grad(quantity)(jnp.asarray(0.0))
        assert value == 0.0 and slope == 0.0
        assert np.isnan(quantity(jnp.asarray(jnp.nan)))
    for rolling, transverse in ((70.0, 0.0), (70.0, -1.0), (-1.0, 4.0), (np.nan, 4.0)):
        bad = ellipse(jnp.asarray(rolling), jnp.asarray(transverse), MODULUS)
        assert all(np.isnan(x) for x in bad)


def test_jit_vmap():
    """One program for many contacts gives what one contact gives."""
    rolling, transverse = jnp.asarray([[60.0, 90.0, 5.0], [60.0, 3.0, 80.0]])
    together = jax.jit(ellipse)(rolling, transverse, MODULUS)
    batched = jax.vmap(lambda x, y: ellipse(x, y, MODULUS))(rolling, transverse)
    for k in range(3):
        alone = ellipse(rolling[k], transverse[k], MODULUS)
        for a, b, c in zip(together, batched, alone, strict=True):
            np.testing.assert_allclose([a[k], b[k]], c, rtol=ROUNDING)


def test_axis_stress_circle():
    """Johnson (1985): below a circle, closed form."""
    depth = np.linspace(0.0, 4.0, 41)
    depth[0] = 1e-12
    for poisson in (0.0, 0.28, 0.5):
        x, y, z = axis_stress(jnp.ones(41), jnp.asarray(depth), jnp.asarray(poisson))
        radial = -(1 + poisson) * (1 - depth * np.arctan(1 / depth))
        radial += 0.5 / (1 + depth**2)
        np.testing.assert_allclose(x, radial, atol=ROUNDING)
        np.testing.assert_allclose(y, radial, atol=ROUNDING)
        np.testing.assert_allclose(z, -1 / (1 + depth**2), rtol=ROUNDING)


def test_axis_stress_line():
    """Below a long ellipse: the Hertz strip (Johnson), plane strain along it."""
    ratio, poisson = 1e-10, 0.3
    depth = np.array([0.2, 0.786, 2.0])
    x, y, z = axis_stress(
        jnp.asarray(ratio), jnp.asarray(ratio * depth), jnp.asarray(poisson)
    )
    root = np.sqrt(1 + depth**2)
    across = -((1 + 2 * depth**2) / root - 2 * depth)
    np.testing.assert_allclose(x, across, rtol=1e-8)
    np.testing.assert_allclose(z, -1 / root, rtol=1e-8)
    np.testing.assert_allclose(y, poisson * (across - 1 / root), rtol=1e-8)


def test_axis_stress_surface():
    """In the surface: σx = -2ν - (1 - 2ν) a/(a + b) (Johnson); axes swapped."""
    ratio, poisson = jnp.asarray([0.1, 0.7, 1.0, 4.0]), jnp.asarray(0.3)
    x, y, z = axis_stress(ratio, jnp.zeros(4), poisson)
    np.testing.assert_allclose(x, -(0.6 + 0.4 / (1 + ratio)), rtol=ROUNDING)
    np.testing.assert_allclose(y, -(0.6 + 0.4 * ratio / (1 + ratio)), rtol=ROUNDING)
    np.testing.assert_allclose(z, -1.0, rtol=ROUNDING)
    depth = jnp.asarray([0.2, 0.5, 1.0, 3.0])
    there = axis_stress(ratio, depth, poisson)
    swapped = axis_stress(1 / ratio, depth / ratio, poisson)
    np.testing.assert_allclose(there[0], swapped[1], atol=ROUNDING)
    np.testing.assert_allclose(there[1], swapped[0], atol=ROUNDING)


def test_greatest_shear():
    """Against a scan of the depth."""
    ratio = jnp.asarray([1e-5, 0.05, 0.2, 0.5, 0.8, 1.0, 1.6, 12.0])
    for poisson in (0.25, 0.3, 0.5):
        shear = shear_below(ratio, jnp.asarray(poisson))
        narrow = np.minimum(np.asarray(ratio), 1 / np.asarray(ratio))
        depth = np.linspace(0.01, 2.0, 20001)
        for k, r in enumerate(narrow):
            stress = axis_stress(
                jnp.asarray(r), jnp.asarray(r * depth), jnp.asarray(poisson)
            )
            x, y, z = map(np.asarray, stress)
            tau = 0.5 * (np.maximum(np.maximum(x, y), z) - np.minimum(z, y))
            best = tau.argmax()
            # A maximum: quadratic in the spacing of the scan.
            np.testing.assert_allclose(shear.greatest[k], tau[best], rtol=1e-7)
            assert abs(shear.depth[k] - depth[best]) < 1.1e-4


@functools.cache
def _nodes():
    return np.polynomial.legendre.leggauss(240)


def _orthogonal(ratio, x, z):
    """τ_xz/p0 at (x, 0, z) by Boussinesq's τ = -3 P z² x/(2π r⁵), brute force.

    Semi-axes: `ratio` along x (the rolling direction), 1 along y.
    """
    u, w = _nodes()
    # s = sin v: the edge of the ellipse, a square root, becomes smooth.
    v = 0.5 * np.pi * u
    s, weight = np.sin(v), 0.5 * np.pi * w * np.cos(v)
    across = np.cos(v)[:, None] * s[None, :]
    pressure = np.cos(v)[:, None] * np.cos(v)[None, :]
    dx = x - ratio * s[:, None]
    r5 = (dx**2 + across**2 + z * z) ** 2.5
    area = ratio * weight[:, None] * (np.cos(v)[:, None] * weight[None, :])
    return float(np.sum(area * pressure * 1.5 / np.pi * z * z * dx / r5))


@pytest.mark.parametrize("ratio", [0.15, 0.6, 1.0, 2.0])
def test_orthogonal_shear(ratio):
    """Lundberg & Palmgren's closed form is the largest τ_xz of the whole section."""
    scipy_optimize = pytest.importorskip("scipy.optimize")
    shear = shear_below(jnp.asarray(ratio), jnp.asarray(0.3))
    found = scipy_optimize.minimize(
        lambda p: -abs(_orthogonal(ratio, ratio * p[0], ratio * p[1])),
        [0.9, float(shear.orthogonal_depth) * 1.1],
        method="Nelder-Mead",
        options={"xatol": 1e-7, "fatol": 1e-12},
    )
    np.testing.assert_allclose(shear.orthogonal, -found.fun, rtol=1e-8)
    # A maximum is flat: its place is good to the root of its value.
    np.testing.assert_allclose(shear.orthogonal_depth, found.x[1], rtol=1e-3)


@pytest.mark.slow
def test_shear_derivatives():
    """Derivatives of the shear stresses with the ratio, by central differences."""

    @jax.jit
    def outputs(ratio):
        return jnp.stack(shear_below(ratio, jnp.asarray(0.3)))

    derivative = jax.jit(jax.jacfwd(outputs))

    for point in (0.1, 0.7, 3.0):
        x = jnp.asarray(point)
        rate = (outputs(x * 1.00001) - outputs(x * 0.99999)) / (2e-5 * point)
        got = derivative(x)
        np.testing.assert_allclose(got, rate, rtol=1e-7, atol=1e-10)
    assert np.isfinite(derivative(jnp.asarray(1.0))).all()


def test_float32():
    """Single precision stays within a few of its roundings."""
    rolling = jnp.asarray([70.0, 60.0, 3.0], jnp.float32)
    transverse = jnp.asarray([4.0, 60.0, 80.0], jnp.float32)
    modulus = MODULUS.astype(jnp.float32)
    got = ellipse(rolling, transverse, modulus)
    want = ellipse(rolling.astype(float), transverse.astype(float), MODULUS)
    for a, b in zip(got, want, strict=True):
        assert a.dtype == jnp.float32
        np.testing.assert_allclose(a, b, rtol=5e-6)

"""Shapes of form errors, their tables, and how rolling elements meet them."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.design import FormErrors, Harmonics, RacewayErrors, Spall
from bearingjax.design.form_error import Surface, Surfaces, Table, total

SURFACE = Surface(jnp.asarray(0.03), jnp.asarray(0.005))
ANGLES = jnp.linspace(-7.0, 9.0, 301)


def test_measured_harmonics_pass_through_points():
    points = np.random.default_rng(0).normal(size=33) * 1e-6
    points -= points.mean()
    shape = Harmonics.from_heights(points)
    at = 2 * np.pi / 33 * jnp.arange(33.0)
    np.testing.assert_allclose(shape.height(at, SURFACE), points, atol=1e-18)
    wave = Harmonics.from_heights(3e-6 * np.cos(5 * at + 0.4), highest=8)
    assert wave.amplitude[4] == pytest.approx(3e-6, rel=ROUNDING)
    assert wave.phase[4] == pytest.approx(0.4, rel=ROUNDING)
    assert np.all(np.delete(np.asarray(wave.amplitude), 4) < 1e-20)


def test_a_flat_profile_has_finite_derivatives():
    slope = jax.jacfwd(lambda p: Harmonics.from_heights(p).amplitude)(jnp.zeros(8))
    assert np.all(np.isfinite(slope))


def test_spall_height_follows_element_arc():
    length, deep = 2e-3, Spall(1.0, 2e-3, 1.0)
    arc = jnp.asarray([-0.5, -0.4, 0.0, 0.3, 0.5]) * length / 0.03
    inside = np.array([0.0, 0.1, 0.5, 0.2, 0.0]) * length
    fall = SURFACE.relative - np.sqrt(SURFACE.relative**2 - inside**2)
    found = -deep.height(1.0 + arc, SURFACE)
    # A parabola for the circle: (x/ρ)²/4 of it.
    np.testing.assert_allclose(found, fall, rtol=0.02, atol=1e-15)
    floor = Spall(1.0, length, 20e-6).height(1.0 + arc + 2 * jnp.pi, SURFACE)
    np.testing.assert_allclose(
        floor, -np.minimum(20e-6, -deep.height(1 + arc, SURFACE)), atol=1e-15
    )


def test_tables():
    """To (2πk/n)⁴/384 of a wave of order k."""
    shapes = (Harmonics((2, 40), (3e-6, 1e-6), (0.3, 1.0)),)
    (table,) = Table.from_shapes(shapes, SURFACE, 2048)
    exact = total(shapes, ANGLES, SURFACE)
    bound = 1e-6 * (2 * np.pi * 40 / 2048) ** 4 / 384
    error = np.abs(table.height(ANGLES, SURFACE) - exact)
    assert np.max(error) < 1.1 * bound
    assert Table.from_shapes((), SURFACE, 16) == ()


def test_errors_turn_with_their_parts():
    bearing = bj.DeepGrooveBallBearing(
        7, 0.05, 0.01, outer_osculation=0.52, inner_osculation=0.52
    )
    surfaces = Surfaces.from_bearing(bearing)
    errors = FormErrors(
        outer=RacewayErrors(axial=Harmonics(3, 1e-6)),
        inner=RacewayErrors(outwards=Harmonics(2, 1e-6), raised=Harmonics(5, 1e-7)),
        elements=Harmonics((2, 3), np.full((7, 2), 1e-8)),
    )
    azimuth = jnp.linspace(0.0, 5.0, 7)
    outer, inner, rolled = jnp.asarray(0.2), jnp.asarray(1.5), jnp.linspace(-3, 3, 7)
    given = surfaces, azimuth, outer, inner, rolled
    found = errors.deviations(*given)
    np.testing.assert_allclose(found[:, 0, 0], 1e-6 * np.cos(3 * (azimuth - 0.2)))
    np.testing.assert_allclose(found[:, 1, 1], 1e-6 * np.cos(2 * (azimuth - 1.5)))
    # Both contacts of an element see an even wave alike, an odd one oppositely.
    even, odd = np.cos(2 * rolled) * 1e-8, np.cos(3 * rolled) * 1e-8
    own = 1e-7 * np.cos(5 * (azimuth - 1.5))
    np.testing.assert_allclose(found[:, 0, 2], even + odd, atol=1e-20)
    np.testing.assert_allclose(found[:, 1, 2], own + even - odd, atol=1e-20)
    tables = errors.as_tables(surfaces, 2048)
    np.testing.assert_allclose(tables.deviations(*given), found, atol=1e-13)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Harmonics(2.5, 1e-6), "whole numbers from 1"),
        (lambda: Harmonics((2, 3), 1e-6), "2 orders"),
        (lambda: Harmonics(2, np.nan), "finite"),
        (lambda: Harmonics(2, "1 um"), "must be numbers"),
        (lambda: Harmonics.from_heights([1.0, 2.0]), "at least 4 heights"),
        (lambda: Harmonics.from_heights(np.ones(9), 5), "from 1 to 4"),
        (lambda: Spall(0.0, -1e-3, 1e-6), "`length`"),
        (lambda: RacewayErrors(axial=(1e-6,)), "Harmonics or Spall"),
    ],
)
def test_wrong_shapes(make, words):
    with pytest.raises((TypeError, ValueError), match=words):
        make()

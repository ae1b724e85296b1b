"""Viscosity, density and pressure coefficients of oils; printed ones are validation
cases."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import theirs
from scipy.integrate import simpson
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj
from bearingjax.lubrication import (
    OILS,
    Barus,
    ConstantCoefficient,
    Density,
    Exponential,
    FreeVolume,
    Roelands,
    Walther,
    free_volume_23699,
    iso_vg,
    mil_l_23699,
)

WARM = 303.15
OIL = mil_l_23699()
FREE = free_volume_23699()
PURE = bj.Lubricant(FREE, FREE, OIL.density)
"""The fitted free volume law over temperature as well."""
AMBIENT = Exponential(0.1, 313.15, 3000.0, 0.0)


@jax.jit
def state(oil, pressure, temperature):
    """Viscosity, its kinematic value at ambient pressure, film coefficient and α*."""
    return (
        oil.viscosity(pressure, temperature),
        oil.kinematic_viscosity(temperature),
        oil.pressure_coefficient(temperature),
        oil.isoviscous_coefficient(temperature),
    )


def of(oil, pressure, temperature=WARM):
    return [float(v) for v in state(oil, float(pressure), float(temperature))]


def test_viscosity_under_pressure_of_the_fitted_law():
    """At the temperature of the fit, where the oil has the same law."""
    for pressure in (0.5e9, 0.8e9, 1e9):
        assert of(PURE, pressure)[0] == pytest.approx(of(OIL, pressure)[0], rel=1e-3)


def test_free_volume_law():
    """Its limits at p = 0, α* and the fit to the correlation over temperature."""
    viscosity, _, _, star = of(PURE, 0.0)
    np.testing.assert_allclose(viscosity, FREE.reference_viscosity, rtol=ROUNDING)
    slope = 2.30134 * 0.728634 / (1 - 0.728634) ** 2 / (9e9 * np.exp(-6.5e-3 * WARM))
    found = jax.grad(lambda p: jnp.log(PURE.viscosity(p, WARM)))(0.0)
    np.testing.assert_allclose(found, slope, rtol=ROUNDING)
    name = "reciprocal asymptotic isoviscous pressure"
    known = theirs("mil_l_23699_properties", name)[-1]
    assert abs(star - known) < 0.005e-9
    for celsius in (20.0, 40.0, 70.0, 100.0, 130.0):
        pure, oil = (of(each, 0.0, 273.15 + celsius) for each in (PURE, OIL))
        assert abs(pure[0] / oil[0] - 1.0) < 0.03
        assert abs(pure[3] / oil[2] - 1.0) < (0.062 if celsius <= 100 else 0.13)


@pytest.mark.parametrize(
    "oil",
    [
        PURE,
        iso_vg(100.0),
        bj.Lubricant(AMBIENT, Roelands(2e-8), Density(880.0)),
        bj.Lubricant(AMBIENT, Barus(2e-8), Density(880.0)),
    ],
    ids=["free volume", "Roelands", "Roelands alone", "Barus"],
)
def test_films_take_the_isoviscous_coefficient_unless_one_is_given(oil):
    """The integral by Simpson's rule instead."""
    pressure = np.linspace(0.0, 3e9, 20_001)
    viscosity = np.asarray(oil.viscosity(jnp.asarray(pressure), WARM))
    whole = simpson(viscosity[0] / viscosity, x=pressure)
    _, _, coefficient, star = of(oil, 0.0)
    np.testing.assert_allclose(star, 1.0 / whole, rtol=1e-8)
    assert oil.coefficient is not None or coefficient == star


@pytest.mark.parametrize("law", [Barus, Roelands])
def test_pressure_coefficient_of_constant_viscosity_is_zero(law):
    """Nor NaN in its derivative: α* is the slope, of Barus' law α, and near no growth
    that of any law."""

    def star(alpha):
        oil = bj.Lubricant(AMBIENT, law(alpha), Density(880.0))
        return oil.pressure_coefficient(WARM)

    value, slope = jax.value_and_grad(star)(0.0)
    assert value == 0.0
    np.testing.assert_allclose(slope, 1.0, rtol=ROUNDING)


def test_barus_and_roelands():
    alpha, pressure = 2e-8, 6e8
    ambient = 0.1 * np.exp(3000.0 * (1 / WARM - 1 / 313.15))
    barus = bj.Lubricant(AMBIENT, Barus(alpha), Density(880.0))
    want = ambient * np.exp(alpha * pressure)
    np.testing.assert_allclose(of(barus, pressure)[0], want, rtol=ROUNDING)
    roelands = bj.Lubricant(AMBIENT, Roelands(alpha), Density(880.0))
    depth = np.log(ambient) + 9.67
    grown = (1 + 5.1e-9 * pressure) ** (alpha / (5.1e-9 * depth))
    want = ambient * np.exp(depth * (grown - 1))
    np.testing.assert_allclose(of(roelands, pressure)[0], want, rtol=1e-11)
    np.testing.assert_allclose(of(barus, 0.0)[2], alpha, rtol=ROUNDING)
    given = bj.Lubricant(AMBIENT, Barus(alpha), Density(880.0), coefficient=1.5e-8)
    assert float(given.pressure_coefficient(WARM)) == 1.5e-8


def test_iso_grades():
    """Grade at 40 °C; between the points the line of ASTM D341."""
    for grade in (10, 46, 460):
        oil = OILS[f"ISO VG {grade}"]()
        np.testing.assert_allclose(oil.kinematic_viscosity(313.15), 1e-6 * grade)
    law = Walther(313.15, 100e-6, 373.15, 11.1e-6)
    lines = [np.log10(np.log10(v + 0.7)) for v in (100.0, 11.1)]
    share = np.log10(343.15 / 313.15) / np.log10(373.15 / 313.15)
    want = 10 ** (10 ** (lines[0] + share * (lines[1] - lines[0]))) - 0.7
    got = np.exp(float(law.log_viscosity(jnp.asarray(343.15), jnp.asarray(900.0))))
    np.testing.assert_allclose(got, 900e-6 * want, rtol=ROUNDING)


def test_finite_from_cold_to_hot_and_up_to_four_gigapascal():
    """Value and gradient; beyond the fluid range the flag says so."""
    grid = [
        g.ravel()
        for g in jnp.meshgrid(jnp.linspace(0, 4e9, 9), jnp.linspace(233.15, 473.15, 5))
    ]
    barus = bj.Lubricant(iso_vg(460.0).ambient, Barus(4e-8), Density(900.0))

    @jax.jit
    def both(oil, pressure, temperature):
        log = lambda p, t: jnp.log(oil.viscosity(p, t))  # noqa: E731
        value, slopes = jax.vmap(jax.value_and_grad(log, (0, 1)))(pressure, temperature)
        flag = jax.vmap(oil.outside_fluid_range)(pressure, temperature)
        return value, *slopes, flag, jax.vmap(oil.isoviscous_coefficient)(temperature)

    for oil in (OIL, PURE, iso_vg(10.0), iso_vg(460.0), barus):
        value, by_pressure, by_temperature, flag, alpha = both(oil, *grid)
        assert np.all(np.isfinite([value, by_pressure, by_temperature, alpha]))
        assert np.all(by_pressure >= 0) and np.all(value < 37.7)
        np.testing.assert_array_equal(flag, value > np.log(1e12))
        assert np.all(alpha > 0)


def test_derivatives_by_every_number():
    """Against central differences, of ln μ at 0.6 GPa, α* and the film coefficient."""

    def measures(oil, temperature):
        found = (
            oil.viscosity(6e8, temperature),
            oil.isoviscous_coefficient(temperature),
            oil.pressure_coefficient(temperature),
        )
        return jnp.log(jnp.stack(found))

    for oil in (PURE, iso_vg(68.0)):
        leaves, tree = jax.tree.flatten((oil, jnp.asarray(WARM)))
        at = jnp.stack(leaves)
        at_x = jax.jit(lambda x, tree=tree: measures(*jax.tree.unflatten(tree, [*x])))
        exact = jax.jit(jax.jacfwd(at_x))(at) * at[None]
        whole, step = np.asarray(at)[None], 1e-5 * np.diag(at)
        near = jax.jit(jax.vmap(at_x))(jnp.concatenate([whole + step, whole - step]))
        change = (near[: at.size] - near[at.size :]) / 2e-5
        np.testing.assert_allclose(
            exact.T, change, atol=1e2 * DIFFERENCE, rtol=DIFFERENCE
        )
    by_grade = jax.grad(lambda g: iso_vg(g).viscosity(0.0, 373.15))(jnp.asarray(100.0))
    ends = [float(iso_vg(100.0 + s).viscosity(0.0, 373.15)) for s in (0.01, -0.01)]
    np.testing.assert_allclose(by_grade, (ends[0] - ends[1]) / 0.02, rtol=DIFFERENCE)


def test_float32():
    """ln μ loses 2e-6 of its terms, of which the largest is 20: μ is right to 1e-4."""
    narrow = jax.tree.map(lambda x: x.astype(jnp.float32), PURE)
    for pressure in (0.0, 0.6e9, 1.2e9):
        got = state(narrow, jnp.float32(pressure), jnp.float32(WARM))
        assert all(v.dtype == jnp.float32 for v in got)
        np.testing.assert_allclose(np.stack(got), of(PURE, pressure), rtol=1e-4)


@pytest.mark.parametrize(
    "make, message",
    [
        (
            lambda: Walther(313.15, -1e-5, 373.15, 1e-6),
            r"`cold_viscosity` is -1e-05 m²/s",
        ),
        (lambda: Walther(-1.0, 1e-5, 373.15, 1e-6), r"`cold` is -1 K.*above 0 K"),
        (
            lambda: Walther(373.15, 1e-5, 313.15, 1e-6),
            r"`hot` is 313.15 K.*above `cold`",
        ),
        (lambda: Walther(313.15, 1e-5, 373.15, 1e-4), r"below `cold_viscosity`"),
        (lambda: Walther.from_grade(-32.0), r"`grade` is -32 mm²/s.*above 0"),
        (
            lambda: Walther.from_grade(1.0),
            r"`viscosity` is 1e-06 m²/s.*at least 6.473e-06",
        ),
        (lambda: iso_vg(32.0, 500.0), r"`index` is 500; .*at least 0 and below 400"),
        (
            lambda: Exponential(-0.1, 300.0, 1.0, 1.0),
            r"`reference_viscosity` is -0.1 Pa s",
        ),
        (
            lambda: FreeVolume(0.1, 2.0, 1.2, 0, 0, 11, 9e9, 0, 300),
            r"`R0` is 1.2; .*below 1",
        ),
        (lambda: ConstantCoefficient(np.nan), r"`coefficient` is nan 1/Pa.*finite"),
        (lambda: Density(-880.0), r"`value` is -880 kg/m³.*above 0"),
        (
            lambda: OIL.viscosity(0.0, -5.0),
            r"Lubricant: `temperature` is -5 K.*above 0 K",
        ),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message) as raised:
        make()
    assert "\n" not in str(raised.value)


def test_parts_of_the_wrong_kind(untyped):
    with pytest.raises(TypeError, match="`pressure` is a Exponential; it must be"):
        bj.Lubricant(AMBIENT, AMBIENT, Density(880.0))

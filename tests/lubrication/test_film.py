"""Films against their formulas, evaluated here in the groups g_V and g_E of the charts,
and against formulas of other authors."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.lubrication import (
    Regime,
    inlet_heating,
    iso_vg,
    lambda_ratio,
    line_film,
    mil_l_23699,
    point_film,
    starvation,
)
from bearingjax.lubrication.film_factors import at_least

# A 12.7 mm ball on an inner raceway under 100 N.
E_STAR, RADIUS, MU, ALPHA = 113.19e9, 4.98e-3, 0.0376, 15.1e-9
POINT = (100.0, 9.43, RADIUS, E_STAR, MU, ALPHA)
LINE = (2e5, RADIUS, E_STAR, MU, ALPHA)
SPEED = 2.66


def groups(load, speed):
    return MU * speed / (2 * E_STAR * RADIUS), 2 * E_STAR * ALPHA, load


def test_point_film():
    """E' is 2 E*, and the speed the mean of both surfaces."""
    u, g, w = groups(100.0 / (2 * E_STAR * RADIUS**2), SPEED)
    film = point_film(*POINT)
    central = 2.69 * u**0.67 * g**0.53 * w**-0.067 * (1 - 0.61 * np.exp(-0.73 * 9.43))
    least = 3.63 * u**0.68 * g**0.49 * w**-0.073 * (1 - np.exp(-0.68 * 9.43))
    np.testing.assert_allclose(film.central(SPEED), RADIUS * central, rtol=1e-9)
    np.testing.assert_allclose(film.minimum(SPEED), RADIUS * least, rtol=1e-9)
    assert 0.1e-6 < float(film.minimum(SPEED)) < float(film.central(SPEED)) < 1e-6
    # Either way round, and equal steel: E' = E/(1 - nu²).
    np.testing.assert_allclose(film.central(-SPEED), film.central(SPEED))
    np.testing.assert_allclose(2 * E_STAR, 206e9 / (1 - 0.3**2), rtol=1e-4)


@pytest.mark.parametrize("load, speed", [(100.0, SPEED), (1.0, 8.0), (10.0, 0.1)])
def test_regimes_of_a_point_contact(load, speed):
    u, g, w = groups(load / (2 * E_STAR * RADIUS**2), speed)
    film = point_film(load, *POINT[1:])
    g_v, g_e, k = g * w**3 / u**2, w ** (8 / 3) / u**2, 9.43
    radii = k ** (np.pi / 2)
    side = 1 / (1 + 2 / (3 * radii))
    films = (
        128 * radii * side**2 * (0.131 * np.arctan(radii / 2) + 1.683) ** 2,
        141 * g_v**0.375 * (1 - np.exp(-0.0387 * radii)),
        8.70 * g_e**0.67 * (1 - 0.85 * np.exp(-0.31 * k)),
    )
    got = film._of_regimes(jnp.asarray(speed))
    np.testing.assert_allclose(
        got[:3], RADIUS * np.stack(films) * (u / w) ** 2, rtol=1e-6
    )
    # The chart's own piezoviscous-elastic film is the formula of 1977, rounded.
    chart = 3.42 * g_v**0.49 * g_e**0.17 * (1 - np.exp(-0.68 * k))
    np.testing.assert_allclose(got[3], RADIUS * chart * (u / w) ** 2, rtol=0.03)


def test_line_film():
    u, g, w = groups(2e5 / (2 * E_STAR * RADIUS), SPEED)
    film = line_film(*LINE)
    central = RADIUS * 2.922 * u**0.692 * g**0.470 * w**-0.166
    np.testing.assert_allclose(film.central(SPEED), central, rtol=1e-9)
    least = RADIUS * 1.714 * u**0.694 * g**0.568 * w**-0.128
    np.testing.assert_allclose(film.minimum(SPEED), least, rtol=1e-9)
    # Dowson & Toyoda (1979) and Dowson & Higginson (1966), from other solutions.
    others = 3.06 * u**0.69 * g**0.56 * w**-0.1, 2.65 * u**0.7 * g**0.54 * w**-0.13
    np.testing.assert_allclose([central, least], RADIUS * np.stack(others), rtol=0.25)
    g_v, g_e = g * w**1.5 / u**0.5, w / u**0.5
    films = np.stack([4.9, 1.66 * g_v ** (2 / 3), 3.10 * g_e**0.8])
    got = film._of_regimes(jnp.asarray(SPEED))
    np.testing.assert_allclose(got[:3], RADIUS * films * u / w, rtol=1e-6)


def test_regimes():
    """Loaded steel is elastohydrodynamic; a feather load and soft bodies are not."""
    cases = {
        Regime.PIEZOVISCOUS_ELASTIC: point_film(*POINT),
        Regime.ISOVISCOUS_RIGID: point_film(1e-3, *POINT[1:]),
        Regime.PIEZOVISCOUS_RIGID: point_film(10.0, *POINT[1:4], 0.11, 5e-8),
        Regime.ISOVISCOUS_ELASTIC: point_film(1.0, 1.0, RADIUS, 5e6, MU, ALPHA),
    }
    for regime, film in cases.items():
        assert int(film.regime(SPEED)) == regime
        assert bool(film.outside_validity(SPEED)) == (
            regime != Regime.PIEZOVISCOUS_ELASTIC
        )
    assert int(line_film(*LINE).regime(SPEED)) == Regime.PIEZOVISCOUS_ELASTIC
    assert bool(line_film(1e-3, *LINE[1:]).outside_validity(SPEED))


def measures(numbers):
    """ln of every film and factor, of all real numbers at once."""
    load, ratio, radius, modulus, viscosity, coefficient, speed, loading, slide = (
        numbers
    )
    point = point_film(load, ratio, radius, modulus, viscosity, coefficient)
    line = line_film(1e3 * load, radius, modulus, viscosity, coefficient)
    films = [f(speed) for x in (point, line) for f in (x.central, x.minimum)]
    starved = starvation(0.127 * ratio, films[0], films[1], radius, 0.04 * radius)
    warm = inlet_heating(loading, 5e-3 * modulus, modulus, slide)
    return jnp.stack([*films, *starved, warm])


def test_derivatives():
    at = jnp.asarray([*POINT, SPEED, 0.3, 0.05])
    of = jax.jit(lambda x: jnp.log(measures(x)))
    exact = jax.jit(jax.jacfwd(of))(at) * at[None]
    steps = 1e-5 * jnp.diag(at)
    ends = [jax.vmap(of)(at[None] + s * steps) for s in (1.0, -1.0)]
    np.testing.assert_allclose(exact.T, (ends[0] - ends[1]) / 2e-5, atol=DIFFERENCE)


def test_at_rest_and_unloaded():
    """Film zero at rest, finite unloaded; value, gradient and Hessian are finite."""
    at = jnp.asarray([*POINT, SPEED, 0.3, 0.05])
    both = jax.jit(lambda x: (measures(x), jax.jacfwd(measures)(x)))
    curved = jax.jit(jax.hessian(lambda x: point_film(*x[:6]).central(x[6])))
    for zeros in ([6], [0], [0, 6], [7, 8], [0, 6, 7, 8]):
        x = at.at[jnp.asarray(zeros)].set(0.0)
        value, slope = both(x)
        assert np.all(np.isfinite(value)) and np.all(np.isfinite(slope))
        assert np.all(np.isfinite(curved(x)))
        np.testing.assert_array_equal(value[:4] == 0.0, 6 in zeros)
    assert float(at_least(jnp.asarray(0.0), 1e-8)) == 1e-8


def test_inlet_heating():
    p, loading, slide = 1.2e9, 2.0, 0.4
    above = 1 - 13.2 * p / (2 * E_STAR) * loading**0.42
    below = 1 + 0.213 * (1 + 2.23 * slide**0.83) * loading**0.64
    heated = jax.jit(inlet_heating)
    got = [heated(loading, p, E_STAR, s * slide) for s in (1, -1)]
    np.testing.assert_allclose(got, above / below, rtol=1e-8)
    assert float(heated(0.0, p, E_STAR, slide)) == 1.0
    # Positive, and with a continuous slope, however hot.
    share = jax.value_and_grad(lambda x: inlet_heating(x, 3e9, E_STAR, 1.0))
    share = jax.jit(jax.vmap(share))
    value, slope = share(jnp.geomspace(1e-3, 1e5, 4001))
    assert np.all(value > 0) and np.all(slope < 0)
    assert np.max(np.abs(np.diff(np.log(-slope)))) < 0.02
    oil = mil_l_23699()
    step = 1e-3
    of = jax.jit(lambda t: (oil.viscosity(0.0, t), oil.thermal_loading(t, SPEED)))
    up, here, down = (of(303.15 + s * step) for s in (1, 0, -1))
    want = -(up[0] - down[0]) / (2 * step) * SPEED**2 / 0.14
    np.testing.assert_allclose(here[1], want, rtol=1e-7)


def test_starvation():
    """None from the inlet distance m* on; a film of nothing at the edge."""
    film, b = 0.3e-6, 5e-5
    enough = 1 + 3.06 * (film * RADIUS / b**2) ** 0.58
    least = 1 + 3.34 * (0.8 * film * RADIUS / b**2) ** 0.56
    for m in (1.1, 1.5, 4.0):
        got = starvation(m, film, 0.8 * film, RADIUS, b)
        want = (
            min(((m - 1) / (enough - 1)) ** 0.29, 1),
            min(((m - 1) / (least - 1)) ** 0.25, 1),
        )
        np.testing.assert_allclose(got, want, rtol=1e-9)
    assert starvation(4.0, film, 0.8 * film, RADIUS, b) == (1.0, 1.0)


def test_lambda_ratio():
    np.testing.assert_allclose(lambda_ratio(0.5e-6, 3e-8, 4e-8), 10.0, rtol=ROUNDING)


def test_float32():
    """Sums of logarithms up to 25: 2e-6."""
    at = [*POINT, SPEED, 0.3, 0.05]
    got = jax.jit(measures)([jnp.float32(x) for x in at])
    assert got.dtype == jnp.float32
    np.testing.assert_allclose(got, jax.jit(measures)(at), rtol=1e-5)
    film = point_film(*(jnp.float32(x) for x in POINT))
    chain = jax.jit(jax.grad(jax.grad(film.central)))
    assert np.isfinite(chain(jnp.float32(0.0)))


def test_of_an_oil():
    """A film under `vmap` over loads and speeds, with the numbers of an oil."""
    oil = iso_vg(68.0)

    @jax.jit
    @jax.vmap
    def central(load, speed):
        mu, alpha = oil.viscosity(0.0, 343.15), oil.pressure_coefficient(343.15)
        return point_film(load, 6.0, RADIUS, E_STAR, mu, alpha).central(speed)

    got = central(jnp.asarray([10.0, 100.0, 1000.0]), jnp.asarray([1.0, 2.0, 4.0]))
    np.testing.assert_allclose(
        got / got[0], [1, 2**0.67 * 10**-0.067, 4**0.67 * 0.1**0.134]
    )


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: point_film(-1.0, *POINT[1:]), r"`load` is -1 N.*at least 0 N"),
        (
            lambda: point_film(1.0, 0.5, *POINT[2:]),
            r"`ratio` is 0.5; .*at least 1: across",
        ),
        (lambda: point_film(*POINT[:2], -1e-3, *POINT[3:]), r"`radius` is -0.001 m"),
        (lambda: point_film(*POINT[:4], -0.1, ALPHA), r"`viscosity` is -0.1 Pa s"),
        (lambda: point_film(*POINT[:5], np.nan), r"`coefficient` is nan 1/Pa.*finite"),
        (lambda: line_film(-1.0, *LINE[1:]), r"line_film: `line_load` is -1 N/m"),
        (lambda: starvation(0.9, 1e-7, 1e-7, 1e-3, 1e-4), r"`inlet` is 0.9; .*above 1"),
        (lambda: at_least(jnp.asarray(0.0), 0.0), r"`least` is 0 m.*above 0 m"),
        (lambda: lambda_ratio(1e-7, -1e-8, 1e-8), r"`roughness` is -1e-08 m"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message) as raised:
        make()
    assert "\n" not in str(raised.value)

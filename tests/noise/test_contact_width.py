"""Half width of contacts against formulas of others, and what it leads to."""

import jax.numpy as jnp
import numpy as np
import pytest
import scipy.special
from registry import balls

import bearingjax as bj
from bearingjax.design.form_error import (
    FormErrors,
    Harmonics,
    RacewayErrors,
    Surface,
    Surfaces,
)
from bearingjax.noise import NoiseModel, contact_half_width, with_bridged_waves
from bearingjax.noise.static_start import static_start
from bearingjax.noise.warning import _short_waves

YOUNG = 206e9 / (1.0 - 0.3**2)
"""E' of two bodies of steel, 2/((1-ν²)/E + (1-ν²)/E) [Pa]."""


def test_balls():
    """Brewe and Hamrock (1977): within their 5 % of Hertz."""
    bearing = balls(7)
    angle = float(bearing.free_cosine)
    radius, pitch = 0.5 * float(bearing.ball_diameter), float(bearing.pitch_diameter)
    groove = 2.0 * radius * float(bearing.outer_osculation)
    along = radius * (1.0 + 2.0 * radius * angle / pitch)
    across = 1.0 / (1.0 / radius - 1.0 / groove)
    ratio = 1.0339 * (across / along) ** 0.636
    integral = 1.0003 + 0.5968 * along / across
    mean = 1.0 / (1.0 / along + 1.0 / across)
    loads = np.array([[0.0, 30.0], [0.0, 50.0]])
    of_loads = (6.0 * integral * 40.0 * mean / (np.pi * ratio * YOUNG)) ** (1 / 3)
    assert contact_half_width(bearing, loads) == pytest.approx(of_loads, rel=0.05)


def test_rollers():
    """Johnson (1985), 4.43: a² = 4 P R/(π E*), on the outer raceway."""
    bearing = bj.CylindricalRollerBearing(9, 0.052, 0.0082, 0.0115)
    radius = 0.0041 * (1.0 + 0.0082 / 0.052)
    wanted = np.sqrt(4.0 * (500.0 / 0.0115) * radius / (np.pi * 0.5 * YOUNG))
    found = contact_half_width(bearing, np.full((9, 2), 500.0))
    assert found == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize(("pressure", "radius"), [(1.0, 0.02), (0.5, 0.01)])
def test_contacts_leave_the_mean_of_waves(pressure, radius):
    """Closed forms of the mean of a cosine over the pressure of an ellipse, a line."""
    order = np.array([1.0, 30.0, 100.0, 400.0, 900.0])
    x = order * 1e-4 / radius
    wanted = 3.0 * (np.sin(x) - x * np.cos(x)) / x**3
    if pressure == 0.5:
        wanted = 2.0 * scipy.special.j1(x) / x
    surface = Surface(*map(jnp.asarray, (radius, 0.004, 1e-4, pressure)))
    left = np.asarray(surface.bridged_share(jnp.asarray(order)))
    np.testing.assert_allclose(left, wanted, atol=1e-7)
    assert left[0] > 0.99 and abs(left[-1]) < 0.35
    assert np.all(Surface(*surface[:2]).bridged_share(jnp.asarray(order)) == 1.0)


@pytest.mark.slow
def test_bridged_model_attenuates_short_waves():
    """Errors that the balls meet are those of waves made smaller by hand."""
    row = balls(7)
    order = np.array([3, 400])

    def model(amplitude):
        waves = RacewayErrors(outwards=Harmonics(order, amplitude, [0.2, 0.4]))
        return NoiseModel(
            bj.BearingElement(row), 0.3, [0.0, 0.0, -300.0, 0, 0, 0],
            bj.Speed(inner=200.0), FormErrors(outer=waves), tilts=False,
        )  # fmt: skip

    given = with_bridged_waves(model([1e-6, 1e-6]))
    assert given.half_width is not None
    (half,) = given.half_width
    system = given.still_system()
    start, _ = static_start(given, system)
    loads = np.asarray(system.contact_loads(start, jnp.zeros(())))
    assert half == pytest.approx(contact_half_width(row, loads), rel=1e-9)
    x = order * float(half) / float(Surfaces.from_bearing(row).outer.radius)
    left = 3.0 * (np.sin(x) - x * np.cos(x)) / x**3
    assert left[1] < 0.9
    time = jnp.asarray(1.3e-3)
    found, wanted = (
        np.asarray(m.system().deviations(m.system().azimuth(time), time))
        for m in (given, model(1e-6 * left))
    )
    np.testing.assert_allclose(found, wanted, atol=1e-6 * np.abs(wanted).max())
    # Said of the bearing that does not.
    (told,) = _short_waves(model([1e-6, 1e-6]), loads[None], None)
    assert "vibration.bridging" in told and not list(_short_waves(given, loads, None))


def test_contact_half_width_without_load():
    assert contact_half_width(balls(7), np.zeros((7, 2))) == 0.0

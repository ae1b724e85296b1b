"""Where skidding ends, against a balance of balls that roll and against itself."""

import importlib
from functools import partial
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from han_chu import BEARING, ELEMENT, FREE, MODEL, SPEED
from published import theirs
from registry import taper

import bearingjax as bj
from bearingjax import Support, skid
from bearingjax.element.inertia import Speed
from bearingjax.lubrication import mil_l_23699
from bearingjax.numerics.result import Result, SolveError
from bearingjax.skid import Drag, SkidModel, conditions, skid_warnings
from bearingjax.skid.contact_loads import ring_forces
from bearingjax.skid.orbits import orbit_search
from bearingjax.skid.orbits.orbit_search import derivatives
from bearingjax.skid.orbits.steady_results import Power

steady_module = importlib.import_module(
    "bearingjax.skid.orbits.steady"
)  # a function's name

ENDS = 40.0, 80.0, 120.0, 200.0, 300.0, 400.0, 520.0, 600.0
"""Axial loads of the validation case `han_chu_end_states` [N]."""

ASIDE = float(0.02 * BEARING.ball_diameter * np.sin(np.radians(25.0)))
"""From the middle of the balls to the inner groove's centre, where method 001 has the
ring's motion and load [m]."""


def under(axial, model=MODEL, radial=0.0, **choices):
    load = jnp.zeros(6).at[2].set(axial).at[0].set(radial)
    return skid.steady(
        model, load, speed=SPEED, support=Support(FREE), places=1, **choices
    )


@pytest.fixture(scope="module")
def one_place():
    """All loads in one call, and a last one that is not axial; contact loads are those
    of pure rolling, as in the published method."""

    def end(axial, radial):
        return under(axial, radial=radial, load_speed=SPEED, throw=False)

    loads = jnp.asarray([*ENDS, 600.0])
    radial = jnp.zeros(len(ENDS) + 1).at[-1].set(200.0)
    return jax.jit(jax.vmap(end))(loads, radial)


@pytest.fixture(scope="module")
def axial(one_place):
    return jax.tree.map(lambda a: a[:-1], one_place)


@pytest.fixture(scope="module")
def many_places():
    """Combined loads, and a last one that is axial."""

    def one(axial, radial):
        load = jnp.zeros(6).at[1].set(radial).at[2].set(axial)
        load = load.at[3].set(-ASIDE * radial)
        given = dict(speed=SPEED, load_speed=SPEED, support=Support(FREE))
        return skid.steady(MODEL, load, **given, throw=False)

    loads = [600.0, 600.0, 600.0, 120.0], [100.0, 400.0, 500.0, 0.0]
    return jax.jit(jax.vmap(one))(*map(jnp.array, loads))


@pytest.fixture(scope="module")
def combined(many_places):
    return jax.tree.map(lambda a: a[:-1], many_places)


LOADED = [0, 3, 4]
"""Places of these loads among those of the validation case `han_chu_orbits`."""


def row(result, k):
    return jax.tree.map(lambda a: np.asarray(a)[k], result)


@pytest.mark.slow
def test_the_row_is_solved_in_one_place_of_the_program(monkeypatch):
    """Its equilibrium is most of what is traced and compiled."""
    traced = []

    def counted(*given):
        traced.append(given)
        return ring_forces(*given)

    monkeypatch.setattr(orbit_search, "ring_forces", counted)

    def end(load):
        given = dict(speed=SPEED, support=Support(FREE), places=12, throw=False)
        return skid.steady(MODEL, load, **given)

    jax.jit(end).lower(jnp.zeros(6).at[2].set(80.0))
    assert len(traced) == 1


@pytest.mark.slow
def test_axial_load_is_carried(axial):
    """AF001-6."""
    for k, load in enumerate(ENDS):
        end = row(axial, k)
        axially = 12 * end.contact_load[0] * np.sin(end.contact_angle[0])
        np.testing.assert_allclose(axially, load, rtol=0.11 if load < 100 else 0.04)


def test_end_state_at_520_newton(axial):
    """Spins at the contacts of unlike sign, balanced, and no slip amid."""
    end = row(axial, list(ENDS).index(520.0))
    assert end.contact_spin[0, 0] > 0.0 > end.contact_spin[0, 1]
    assert np.all(end.sliding_speed < 6e-3)


@pytest.mark.slow
def test_power_of_the_drive_is_heat(axial, combined):
    for result, within in ((axial, 1e-9), (combined, 1e-7)):
        p = result.power
        lost = p.contacts + p.drag + p.cage
        np.testing.assert_allclose(lost, p.drive, rtol=within)
        torque = result.friction_torque * float(SPEED.inner)
        np.testing.assert_allclose(torque, p.drive, rtol=1e-12)


def finely(values, count=720):
    """Values at places along the orbit, at more of them: their trigonometric
    interpolant, from the azimuth of the first."""
    spectrum = np.fft.rfft(values)
    return np.fft.irfft(spectrum, count) * count / values.size


@pytest.mark.slow
def test_combined_loads(combined):
    """Two loaded zones, one above the other, as in the balance of a ball; next to no
    slip there, more between, most where the load is least."""
    assert np.all(combined.result == Result.CONVERGED)
    near = np.arange(720) < 360  # the azimuth of the first place is 0
    orbits = partial(theirs, "han_chu_orbits")
    names = "load under the radial load", "load opposite"
    names = *names, "least load of a ball in every place"
    wanted = np.array([orbits(name)[LOADED] for name in names]).T
    for k, (peak, other, least) in enumerate(wanted):
        end = row(combined, k)
        load, slip = finely(end.contact_load[:, 1]), end.sliding_speed[:, 1]
        np.testing.assert_allclose(load[near].max(), peak, rtol=1e-3)
        np.testing.assert_allclose(load[~near].max(), other, rtol=1e-3)
        np.testing.assert_allclose(load.min(), least, rtol=1e-2)
        places = np.degrees(end.azimuth) % 360.0
        assert slip[places == 90.0] < 0.1 * slip.max()
        assert slip[places == 270.0] < 0.5 * slip.max()
        middle = 0.5 * (load.min() + load.max())
        assert end.contact_load[np.argmax(slip), 1] < middle
        before, after = np.cos(end.azimuth) > 0.1, np.cos(end.azimuth) < -0.1
        if k > 0:  # where the load rises to its top there is more than where it falls
            assert slip[before].max() > slip[after].max()
    # Zones in which the load is above that of the axial load alone, in orbits.
    load = finely(row(combined, 1).contact_load[:, 1])
    above = load > theirs("han_chu_axial", "contact load, inner")[-1]
    end = orbits("end of the zone around the load, of the orbit")[3]
    begin, last = (orbits(f"{x} of the zone opposite")[3] for x in ("begin", "end"))
    np.testing.assert_allclose(np.mean(above & near), 2.0 * end, atol=4e-3)
    np.testing.assert_allclose(np.mean(above & ~near), last - begin, atol=4e-3)
    most = np.max(combined.sliding_speed[..., 1], axis=1)
    assert np.all(np.diff(most) > 0)
    # A small ripple, and a small decrease of the cage speed.
    change = np.diff(combined.cage_speed) / combined.cage_speed[0]
    assert np.all(change < 0) and np.all(change > -0.01)


def test_ring_displacement(combined):
    """The radial load along y."""
    moved = np.asarray(combined.displacement)[1, 6:].copy()
    moved[1] -= ASIDE * moved[3]
    names = "radial displacement", "axial displacement", "tilt"
    want = [theirs("han_chu_combined", name)[0] for name in names]
    np.testing.assert_allclose(np.abs(moved[[1, 2, 3]]), want, rtol=1e-3)


def test_steady_single_place_matches_many_places(axial, many_places):
    """Under an axial load the periodic orbit is even."""
    many, end = row(many_places, -1), row(axial, list(ENDS).index(120.0))
    assert int(many.result) == Result.CONVERGED
    count = len(many.spin)
    assert count >= BEARING.n_balls
    np.testing.assert_allclose(many.spin, np.tile(end.spin, (count, 1)), rtol=1e-6)
    np.testing.assert_allclose(many.orbit_speed, end.orbit_speed[0], rtol=1e-9)
    assert float(many.wander) < 1e-12


@pytest.mark.parametrize("count", [6, 7])
def test_derivative_along_the_orbit(count):
    """Of all waves that the places can tell."""
    phi = 2.0 * np.pi * np.arange(count) / count
    for n in range((count + 1) // 2):
        for wave, slope in ((np.cos, lambda x: -np.sin(x)), (np.sin, np.cos)):
            got = derivatives(count) @ wave(n * phi)
            np.testing.assert_allclose(got, n * slope(n * phi), atol=1e-12)


@pytest.mark.slow
def test_standstill_and_both_rings():
    """At rest nothing moves; the sense of rotation and the frame do not matter."""
    load = jnp.array([0.0, 0.0, 120.0, 0.0, 0.0, 0.0])
    choices = dict(support=Support(FREE), places=1)
    rest = skid.steady(MODEL, load, speed=Speed(), **choices)
    np.testing.assert_array_equal(rest.spin, 0.0)
    np.testing.assert_array_equal(rest.orbit_speed, 0.0)
    np.testing.assert_array_equal(rest.slip, 0.0)
    assert float(rest.imbalance) == 0.0
    forward = skid.steady(MODEL, load, speed=Speed(inner=209.0), **choices)
    back = skid.steady(MODEL, load, speed=Speed(inner=-209.0), **choices)
    np.testing.assert_allclose(back.orbit_speed, -forward.orbit_speed, rtol=1e-9)
    np.testing.assert_allclose(back.slip, forward.slip, rtol=1e-7)
    # The spin axis leans the other way out of the section.
    mirrored = forward.spin * jnp.array([[1.0, -1.0, -1.0]])
    np.testing.assert_allclose(back.spin, mirrored, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(back.friction_torque, -forward.friction_torque)


def at(celsius):
    """The model at a temperature; a weak type would be another program."""
    return eqx.tree_at(lambda m: m.temperature, MODEL, np.array(celsius + 273.15))


STIFF = Speed(inner=60e3 * np.pi / 30.0)
"""With these balls the outer raceway makes a glass of the oil."""


@pytest.fixture(scope="module")
def stiff():
    """End states with loads of pure rolling, of the model at any temperature."""

    @jax.jit
    def end(load, speed, carried, temperature):
        model = eqx.tree_at(lambda m: m.temperature, MODEL, temperature)
        given = dict(support=Support(FREE), places=1, throw=False)
        found = skid.steady(model, load, speed=speed, load_speed=carried, **given)
        return found

    def one(axial, speed, carried=None, celsius=30.0):
        load = np.array([0.0, 0.0, axial, 0.0, 0.0, 0.0])
        return end(load, speed, carried or speed, np.array(celsius + 273.15))

    return one


@pytest.mark.slow
def test_stiff_oil_does_not_hide_slip(stiff):
    """The power of the drive turns balls against 54 kW of drag, which takes 8 N m at
    the least; with oil at -20 °C the balance holds too."""
    fast = stiff(400.0, STIFF)
    for end in (fast, stiff(3000.0, SPEED, celsius=-20.0)):
        assert int(end.result) == Result.CONVERGED
        assert float(end.residual) < 1e-10
        lost = end.power.contacts + end.power.drag
        np.testing.assert_allclose(end.power.drive, lost, rtol=1e-7)
        assert float(end.slip[0]) > 1e-6
    # Drag on twelve balls at the orbit found, by hand.
    speed = float(fast.cage_speed) * float(BEARING.pitch_diameter)
    density = float(MODEL.lubricant.density.at(MODEL.temperature))
    area = 0.25 * np.pi * float(BEARING.ball_diameter) ** 2
    drag = 12 * 0.125 * 0.1 * 2.0 * density * area * speed**1.95
    np.testing.assert_allclose(fast.power.drag, 0.5 * drag * speed, rtol=1e-6)
    assert float(fast.friction_torque) > 0.5 * drag * speed / float(STIFF.inner)


@pytest.mark.parametrize("celsius", [-40.0, -20.0])
@pytest.mark.slow
def test_steady_converges_for_glassy_oil(celsius):
    """Whose round-off is as large as the load that is not balanced at first."""
    model = at(celsius)
    load, speed = np.array([0.0, 0.0, 600.0, 0.0, 0.0, 0.0]), Speed(inner=1047.2)
    given = dict(speed=speed, support=Support(FREE), places=1, throw=False)
    end = skid.steady(model, load, **given)
    assert int(end.result) == Result.CONVERGED
    assert abs(float(end.imbalance)) < 1e-6


@pytest.mark.slow
def test_skid_warnings_shear_stress_above_pressure(stiff):
    """At 0 °C and 0.91 GPa."""
    end, model = stiff(600.0, SPEED, celsius=0.0), at(0.0)
    state = conditions(model, end, SPEED)
    (text,) = skid_warnings(model, end, state)
    assert text.startswith("shear stresses of 6.6 times the pressure by a Newtonian")


@pytest.mark.slow
def test_derivative_of_the_torque_at_such_stress():
    model = at(0.0)

    def torque(speed):
        load = np.array([0.0, 0.0, 600.0, 0.0, 0.0, 0.0])
        given = dict(
            speed=Speed(inner=speed), support=Support(FREE), places=1, throw=False
        )
        return skid.steady(model, load, **given).friction_torque

    value = jax.jit(jax.value_and_grad(torque))
    got = float(value(SPEED.inner)[1])
    wide, narrow = (
        float(value(SPEED.inner + n * 0.5)[0] - value(SPEED.inner - n * 0.5)[0])
        for n in (2.0, 1.0)
    )
    np.testing.assert_allclose(got, (8.0 * narrow - wide) / 6.0, rtol=1e-5)


@pytest.mark.slow
def test_friction_torque_is_taken_at_driven_ring(stiff):
    outer = stiff(80.0, Speed(outer=SPEED.inner))
    torque = outer.friction_torque
    np.testing.assert_allclose(torque * float(SPEED.inner), outer.power.drive)
    assert float(torque) == float(outer.ring_torque[0]) != float(outer.ring_torque[1])
    inner = stiff(80.0, SPEED)
    assert float(inner.friction_torque) == float(inner.ring_torque[1])


@pytest.mark.parametrize("axial, speed", [(40.0, SPEED), (400.0, STIFF)])
@pytest.mark.slow
def test_steady_ball_loads_match_orbit_speed(stiff, axial, speed):
    """As where load solve and end state are repeated in turn until they agree."""
    load = np.array([0.0, 0.0, axial, 0.0, 0.0, 0.0])
    end = skid.steady(MODEL, load, speed=speed, support=Support(FREE), places=1)
    apart = 0.0
    for _ in range(12):
        last = stiff(axial, speed, Speed(speed.inner + apart, speed.outer + apart))
        apart = float(last.orbit_speed[0] - last.rolling_orbit_speed[0])
    for name in ("slip", "contact_load", "contact_angle", "friction_torque"):
        got, want = getattr(end, name), getattr(last, name)
        np.testing.assert_allclose(got, want, rtol=1e-7, err_msg=name)
    # The centrifugal force is that of the orbit: radially the ball is in balance, but
    # for what holds its axis, which the angles leave over.
    mass = 7850.0 * np.pi / 6.0 * float(BEARING.ball_diameter) ** 3
    pull = mass * 0.5 * float(BEARING.pitch_diameter) * float(end.cage_speed) ** 2
    radial = np.asarray(end.contact_load * np.cos(end.contact_angle))[0]
    np.testing.assert_allclose(radial[0] - radial[1], pull, rtol=0.02)


@pytest.mark.slow
def test_without_load_drag_stops_the_balls():
    """Nothing is pressed against the ring that turns, so nothing drives."""
    end = skid.steady(
        MODEL, np.zeros(6), speed=SPEED, support=bj.Support(free=["uz"]), places=1
    )
    np.testing.assert_allclose(end.slip, 1.0, rtol=1e-5)
    assert abs(float(end.friction_torque)) < 1e-15
    state = conditions(MODEL, end, SPEED)
    assert any("nothing drives" in text for text in skid_warnings(MODEL, end, state))


def test_steady_single_place_rejects_unequal_loads(one_place):
    assert int(one_place.result[-1]) == Result.GRID_MISFIT
    with pytest.raises(ValueError, match="unlike loads"):
        under(600.0, radial=200.0)


@pytest.mark.parametrize(
    "result, missing, count, wanted",
    [
        (Result.CONVERGED, 0.9e-6, 96, Result.CONVERGED),
        (Result.CONVERGED, 1.1e-6, 96, Result.GRID_MISFIT),
        (Result.CONVERGED, 1.1e-6, 1, Result.STEP_LIMIT),
        (Result.NO_LOAD_PATH, 1.0, 96, Result.NO_LOAD_PATH),
        (Result.CONVERGED, np.float32(0.009), 96, Result.CONVERGED),
        (Result.CONVERGED, np.float32(0.011), 96, Result.GRID_MISFIT),
    ],
)
def test_steady_takes_places_as_too_few_by_power(result, missing, count, wanted):
    """A millionth of the power may be missing; with one place that is no misfit."""
    missing = jnp.asarray(missing)
    assert int(steady_module._checked_power(int(result), missing, count)) == wanted


def test_steady_missing_power_by_hand():
    """Relative to the losses, and where next to nothing drives to a least traction of
    all loads at the pitch circle."""
    speed = Speed(inner=100.0, outer=-300.0)
    orbit = SimpleNamespace(least=jnp.asarray(2e3), model=MODEL)
    least = orbit_search.NO_TRACTION * 2e3 * 300.0 * 0.5 * float(BEARING.pitch_diameter)
    for drive, contacts, base in ((9.0, 7.0, 10.0), (0.0, 0.0, 3.0), (least, -3.0, 0)):
        power = Power(*map(jnp.asarray, (drive, contacts, 2.0, 1.0)))
        got = steady_module._missing(SimpleNamespace(power=power), speed, orbit)
        wanted = abs(drive - contacts - 3.0) / (base or least)
        np.testing.assert_allclose(got, wanted, rtol=1e-9)


def test_steady_without_load_path():
    load = jnp.array([0.0, 0.0, -120.0, 0.0, 0.0, 0.0])  # pulled apart
    with pytest.raises(SolveError):
        skid.steady(MODEL, load, speed=SPEED, support=Support(FREE), places=1)
    lost = skid.steady(
        MODEL, load, speed=SPEED, support=Support(FREE), places=1, throw=False
    )
    assert int(lost.result) == Result.NO_LOAD_PATH


def test_bad_input():
    with pytest.raises(ValueError, match="multiple of the 12 balls"):
        skid.steady(
            MODEL,
            [0, 0, 100.0, 0, 0, 0],
            speed=SPEED,
            support=Support(FREE),
            places=7,
        )
    oil = mil_l_23699()
    with pytest.raises(TypeError, match="of one ball bearing"):
        SkidModel(bj.BearingElement(taper()), oil, 303.15)
    with pytest.raises(ValueError, match="temperature"):
        SkidModel(ELEMENT, oil, -3.0)
    with pytest.raises(TypeError, match="lubricant"):
        SkidModel(ELEMENT, "oil", 303.15)
    with pytest.raises(ValueError, match="fill"):
        Drag(fill=1.2)

"""Vibration of a bearing in time: decay, lines, steps, derivatives, failures."""

import dataclasses
import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.design import FormErrors, Harmonics, RacewayErrors
from bearingjax.noise import (
    NoiseModel,
    Sensor,
    level,
    natural_modes,
    needed_steps,
)
from bearingjax.noise import vibration as in_time
from bearingjax.noise.static_start import static_start

SPEED = bj.Speed(inner=600.0)
BALLS = bj.BearingElement(
    bj.DeepGrooveBallBearing(
        7,
        0.05,
        0.01,
        outer_osculation=0.52,
        inner_osculation=0.52,
        ball_deviation=np.zeros(7),
    )
)
WAVES = FormErrors(
    outer=RacewayErrors(outwards=Harmonics((6, 9), (0.0, 0.0))),
    inner=RacewayErrors(axial=Harmonics((7,), (0.0,))),
)
AXIAL = NoiseModel(
    BALLS, 0.2, [0.0, 0.0, -100.0, 0, 0, 0], SPEED, WAVES, retardation=2e-6, tilts=False
)
SHORT = {"turns": 1, "settle": 1, "samples": 64, "steps": 60}


def with_waves(outer=(0.0, 0.0), inner=0.0):
    return dataclasses.replace(
        AXIAL,
        errors=FormErrors(
            outer=RacewayErrors(outwards=Harmonics((6, 9), jnp.asarray(outer))),
            inner=RacewayErrors(axial=Harmonics((7,), jnp.asarray([inner]))),
        ),
    )


def with_large_ball(deviation):
    bearing = dataclasses.replace(BALLS.bearing, ball_deviation=deviation)
    return dataclasses.replace(AXIAL, element=bj.BearingElement(bearing))


def rms(model, **change):
    return np.asarray(in_time(model, **(SHORT | change)).acceleration).std(axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [(-20.0, 30.0), (-30.0, 20.0), (30.0, 0.0)])
@pytest.mark.parametrize("swapped", [False, True])
def test_shaft_is_the_ring_that_turns_faster_either_way(speed, swapped):
    rings = bj.Speed(*(speed[::-1] if swapped else speed))
    model = dataclasses.replace(AXIAL, speed=rings)
    assert model.shaft_speed == 30.0
    assert jax.jit(lambda m: m.shaft_speed)(model) == 30.0


def test_damping_follows_the_rate_of_loads_along_their_normals():
    """Contacts go round with the balls; that their forces turn is no change of them.

    Under a radial load balls without clearance touch in the middle of their grooves.
    """
    load = [0.0, -300.0, 0.0, 0, 0, 0]
    turning = bj.Speed(inner=4000.0)
    model = dataclasses.replace(
        AXIAL, load=load, speed=turning, errors=FormErrors(), retardation=1e-4
    )
    system = model.still_system()
    start, result = static_start(model, system)
    assert result == 0
    h, zero = 1e-7, jnp.zeros(())
    loads = [np.asarray(system.contact_loads(start, zero + k * h)) for k in (-1, 0, 1)]
    outer = (loads[1] + 1e-4 * (loads[2] - loads[0]) / (2.0 * h))[:, 0]
    at = np.asarray(system.azimuth(zero))
    push = np.stack([np.cos(at), np.sin(at)]) @ outer + load[:2]
    found = np.asarray(system.forces(start, 0.0 * start, zero, start))[:2]
    np.testing.assert_allclose(found, push, atol=1e-6 * 300.0)
    # The rate in fixed axes has τ Ω times the load across it, 15 % here.
    assert np.abs(found - load[:2]).max() > 1.0


@pytest.mark.slow
def test_in_time_without_load_path():
    """Its ring lies anywhere in its clearance, though inertia presses the balls."""
    bearing = dataclasses.replace(BALLS.bearing, radial_internal_clearance=1e-5)
    none = dataclasses.replace(
        AXIAL, element=bj.BearingElement(bearing), load=jnp.zeros(6)
    )
    assert natural_modes(none).result == bj.Result.NO_LOAD_PATH
    with pytest.raises(bj.SolveError, match="nothing presses the rolling elements"):
        in_time(none, **SHORT)
    # A bearing without clearance that is preloaded needs no load.
    tight = dataclasses.replace(bearing, radial_internal_clearance=-1e-5)
    tight = dataclasses.replace(none, element=bj.BearingElement(tight))
    assert natural_modes(tight).result == bj.Result.CONVERGED


@pytest.mark.slow
def test_in_time_without_form_errors_stays_at_rest():
    found = in_time(AXIAL, **(SHORT | {"settle": 0}))
    # What is out of balance by 1e-9 of the load may be there.
    assert np.max(np.abs(found.acceleration)) < 1e-9 * 100.0 / 0.2


def test_lines_of_waves_and_of_a_large_ball():
    z, carried = 7, float(AXIAL.system(8).speeds[2])
    wavy = in_time(with_waves(outer=(1e-8, 0.0)), **SHORT)
    # Outer order z - 1: radial, at z times the cage, which no whole turns hold: the
    # motion of the ring's centre turns, so that z A cos and sin of z ω_c t remain.
    time = np.asarray(wavy.time) + 2 * np.pi / 600.0
    a = np.asarray(wavy.acceleration)
    w = z * carried
    basis = np.stack([np.cos(w * time), np.sin(w * time)], axis=1)
    for direction in (0, 1):
        fit = np.linalg.lstsq(basis, a[:, direction], rcond=None)
        assert fit[1][0] < 1e-3 * np.sum(a[:, direction] ** 2)
    assert np.std(a[:, 2]) < 1e-3 * np.std(a[:, 0])
    # Inner axial order z: along the axis at z times (shaft less cage).
    a = np.asarray(in_time(with_waves(inner=1e-8), **SHORT).acceleration)
    w = z * (600.0 - carried)
    basis = np.stack([np.cos(w * time), np.sin(w * time)], axis=1)
    fit = np.linalg.lstsq(basis, a[:, 2], rcond=None)
    assert fit[1][0] < 1e-3 * np.sum(a[:, 2] ** 2)
    # Order 9 = z + 2 makes no force at first order.
    quiet = rms(with_waves(outer=(0.0, 1e-8)))
    assert np.max(quiet[:2]) < 1e-2 * np.std(np.asarray(wavy.acceleration)[:, 0])


@pytest.mark.slow
def test_error_of_a_step():
    """Order 4: half the step, a sixteenth of the error."""
    model = with_waves(outer=(2e-8, 0.0), inner=2e-8)
    motion = [
        np.asarray(in_time(model, **(SHORT | {"steps": n})).displacement)
        for n in (30, 60, 120)
    ]
    errors = [np.abs(m - motion[2]).max() for m in motion[:2]]
    assert errors[1] < 1e-4 * np.abs(motion[2]).max()
    assert 12.0 < errors[0] / errors[1] * 15 / 16 < 20.0


LINES = np.arange(2, 6)
"""Of a record of a turn: a band, which holds the lines of the waves."""
NUMBERS = np.array([1e-8, 2e-8, 0.2, -100.0, 10e-6, 2e-6])


def band_level(values):
    """Level of a band along x and y, weighted [dB]; result, and loads of contacts."""
    outer, inner, mass, axial, clearance, retardation = values
    bearing = dataclasses.replace(BALLS.bearing, radial_internal_clearance=clearance)
    model = dataclasses.replace(
        with_waves(outer=(outer, 0.0), inner=inner),
        element=bj.BearingElement(bearing),
        mass=mass,
        load=AXIAL.load.at[2].set(axial),
        retardation=retardation,
    )
    found = in_time(model, **(SHORT | {"steps": 24}), throw=False)
    turned = 2 * np.pi / 64 * np.outer(LINES, np.arange(64))
    acceleration = found.acceleration[:, :2]
    lines = np.cos(turned) @ acceleration, np.sin(turned) @ acceleration
    square = jnp.sum(lines[0] ** 2 + lines[1] ** 2, axis=0) * (2.0 / 64**2)
    total = level(jnp.sqrt(square)) @ np.array([1.0, 0.7])
    return total, (found.result, found.contact_load)


@pytest.fixture(scope="module")
def slopes():
    """Function (numbers) -> derivatives of the level, result, loads."""
    return jax.jit(jax.grad(band_level, has_aux=True))


@pytest.mark.slow
def test_derivatives_of_the_level_of_a_band(slopes):
    """By all numbers at once, along two ways through them."""
    gradient = np.asarray(slopes(NUMBERS)[0]) * NUMBERS
    for way in np.random.default_rng(1).normal(size=(2, 6)):
        # A V of step sizes: its lowest point counts.
        errors = []
        for share in (1e-3, 1e-4, 1e-5):
            ends = [band_level(NUMBERS * (1.0 + s * way))[0] for s in (share, -share)]
            difference = float(ends[0] - ends[1]) / (2.0 * share)
            errors.append(abs(difference / (gradient @ way) - 1.0))
        assert min(errors) < 10 * DIFFERENCE


@pytest.mark.slow
def test_gradients_of_unloaded_bearing_are_finite(slopes):
    """With clearance: balls ride on the outer ring, the inner one touches nothing."""
    loose = np.array([1e-8, 2e-8, 0.2, 0.0, 20e-6, 2e-6])
    gradient, (code, load) = slopes(loose)
    assert int(code) == int(bj.Result.NO_LOAD_PATH)
    # The level does not depend on where the ring floats, which moves without limit
    # under a load: by the load it changes by round-off, and the code says the rest.
    assert abs(gradient[3]) < 1e-12 and gradient[0] != 0.0
    assert np.all(np.isfinite(gradient))
    assert np.all(load[..., 0] > 0.0) and not np.any(load[..., 1])


def test_a_ball_larger_than_the_others_shakes_with_the_cage():
    model = with_large_ball(2e-6 * np.eye(7)[0])
    found = in_time(model, **SHORT)
    assert np.max(found.contact_load[:, 0]) > 1.2 * np.max(found.contact_load[:, 1:])
    assert rms(model)[0] > 10.0 * rms(with_waves(outer=(1e-12, 0.0)))[0]


def test_a_strongly_damped_contact_needs_shorter_steps():
    """The fastest motion then creeps with 1/(ω² τ), not with 1/ω."""
    model = dataclasses.replace(AXIAL, retardation=5e-5)
    assert needed_steps(model, 64) > 5 * needed_steps(AXIAL, 64)


def test_in_time_reports_too_few_steps():
    """Beyond what is stable a motion may stay finite, because contacts open."""
    found = in_time(AXIAL, **(SHORT | {"steps": 12}), throw=False)
    assert int(found.result) != int(bj.Result.CONVERGED)
    assert int(in_time(AXIAL, **SHORT).result) == int(bj.Result.CONVERGED)


def test_in_time_halves_unstable_steps(monkeypatch):
    """As where form errors press contacts much harder than the load does."""
    module = sys.modules[in_time.__module__]
    monkeypatch.setattr(module, "needed_steps", lambda *_: 12)
    how = {k: v for k, v in SHORT.items() if k != "steps"}
    found = in_time(AXIAL, **how)
    assert found.steps == 24
    given = in_time(AXIAL, **(SHORT | {"steps": 24}))
    np.testing.assert_array_equal(found.displacement, given.displacement)


def test_failures():
    with pytest.raises(bj.SolveError, match="not finite"):
        in_time(AXIAL, **(SHORT | {"steps": 5}))
    gone = in_time(AXIAL, **(SHORT | {"steps": 5}), throw=False)
    assert int(gone.result) == int(bj.Result.NON_FINITE)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: in_time(AXIAL, turns=0), "`turns`"),
        (lambda: in_time(AXIAL, settle=-1), "`settle`"),
        (
            lambda: in_time(dataclasses.replace(AXIAL, speed=bj.Speed())),
            "another than 0",
        ),
        (lambda: dataclasses.replace(AXIAL, mass=-1.0), "`mass`"),
        (lambda: dataclasses.replace(AXIAL, load=[0, 0, -1, 1.0, 0, 0]), "not tilt"),
        (lambda: dataclasses.replace(AXIAL, load=[0, 0, -1, 0, 0, 1.0]), "axis"),
        (lambda: dataclasses.replace(AXIAL, moving_ring="cage"), "'outer' or"),
        (lambda: Sensor(1e4, direction=[0.0, 0.0, 0.0]), "`direction`"),
    ],
)
def test_wrong_input(make, words):
    with pytest.raises((TypeError, ValueError), match=words):
        make()

"""Levels of lines and bands to first order, and what is identified by them."""

import dataclasses
from types import SimpleNamespace
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy import stats

import bearingjax as bj
from bearingjax import noise
from bearingjax.cases import Cases
from bearingjax.decide import (
    CaseModel,
    NoiseDesign,
    NoiseLevel,
    Scatter,
    tolerances,
    truncated_normal,
)
from bearingjax.decide.identify import _read_call, _warnings
from bearingjax.decide.least_squares import Fit
from bearingjax.decide.noise_design import UNLIKE
from bearingjax.decide.tolerance_effects import Sampled
from bearingjax.design import FormErrors, Harmonics, RacewayErrors, Spall
from bearingjax.element import Speed
from bearingjax.numerics.warning import Warning
from bearingjax.optimise import Variable
from bearingjax.statics import Installed

SPEED, LOAD = 188.5, np.array([0.0, 0.0, 150.0, 0.0, 0.0, 0.0])
FREE = bj.Support(free=["ux", "uy", "uz", "gx", "gy"], fixed_ring="inner")
BALL = Harmonics(
    [2, 4],
    np.outer(np.linspace(0.5, 1.5, 9), [10e-9, 8e-9]),
    np.random.default_rng(0).uniform(0, 6, (9, 2)),
)
OUTER = RacewayErrors(
    axial=Harmonics([9], [20e-9], [0.3]),
    outwards=Harmonics([8, 17], [30e-9, 10e-9], [0.1, 2.0]),
)
INNER = RacewayErrors(outwards=Harmonics([1, 8, 10], [3e-7, 25e-9, 22e-9]))


def design(outer=OUTER, inner=INNER, elements=(BALL,), **more):
    bearing = bj.DeepGrooveBallBearing(
        9,
        39.04e-3,
        7.938e-3,
        outer_osculation=0.525,
        inner_osculation=0.515,
        radial_internal_clearance=12e-6,
    )
    drawn, errors = bj.BearingElement(bearing), FormErrors(outer, inner, elements)
    sensor = noise.Sensor(2000.0, 0.0, (0.0, 1.0, 0.0))
    rig = noise.NoiseModel(drawn, 0.06, LOAD, Speed(SPEED, 0.0), errors, sensor=sensor)
    return NoiseDesign(Installed(drawn), rig, **more)


def cases(*speeds):
    return Cases(np.tile(LOAD, (len(speeds), 1)), inner_speed=np.array(speeds))


def test_readings_names_by_kinematics():
    found = [*design().readings()]
    assert found[:6] == [
        *("line_BPFO", "line_2_BPFO", "line_shaft"),
        *("line_BPFI_minus_shaft", "line_BPFI_plus_shaft", "line_2_BSF_minus_cage"),
    ]
    assert "band_31.5" in found and found[-1] == "total_level"
    thirds = design(bands="third_octave").readings()
    assert "band_40" in thirds and thirds["band_5"].unit == "dB"
    # An eccentric ring at rest moves nothing.
    still = RacewayErrors(outwards=Harmonics([1, 9], [1e-6, 1e-8]))
    assert [*design(still, RacewayErrors(), ()).readings()][:2] == [
        *("line_BPFO", "band_4")
    ]


def test_noise_design_refuses():
    spall = RacewayErrors(raised=Spall(0.0, 1e-3, 1e-5))
    with pytest.raises(ValueError, match=r"Harmonics, Spall'; it must be waves"):
        design(inner=spall)
    with pytest.raises(ValueError, match="'none'; it must be waves"):
        design(RacewayErrors(), RacewayErrors(), ())
    with pytest.raises(ValueError, match=r"`elements` has shape \(2,\).*\(9, ...\)"):
        design(elements=(Harmonics([2, 4], [10e-9, 8e-9]),))
    with pytest.raises(ValueError, match="`bands` is 'half'"):
        design(bands="half")
    one = design()
    with pytest.raises(ValueError, match="`inner_speed` is .*must be other than 0"):
        one.check(cases(SPEED, 0.0))
    both = dataclasses.replace(cases(SPEED), outer_speed=np.array([1.0]))
    with pytest.raises(ValueError, match="`outer_speed` is .*must be 0: one ring"):
        one.check(both)
    for given, text in (
        (dict(load=[[0, 0, 150.0, 0, 0, 1.0]]), r"\[\[1.\]\] N m; it must be 0 for"),
        (dict(prescribed={"gx": 1e-4}), "`cases` is 'with displacements'"),
    ):
        with pytest.raises(ValueError, match=text):
            one.check(Cases(**{"load": LOAD, **given}, inner_speed=[SPEED]))
    with pytest.raises(ValueError, match="NoiseLevel: `reading` is 'total_level'"):
        NoiseLevel()(bj.BearingElement(one.installed.drawing.bearing), None, None)


def test_a_tenth_of_the_largest_load_parts_doubtful_levels(monkeypatch):
    """Of both raceways the worse; a case whose rolling elements carry nothing fails."""
    loads = [
        [[7.9, 9], [80, 80]],
        [[9, 7], [80, 80]],
        [[7.5, 9], [80, 80]],
        [[0, 0]] * 2,
    ]
    each = iter(np.array(loads, float))
    solve = lambda *_: SimpleNamespace(roller_load=next(each))  # noqa: E731
    monkeypatch.setattr(noise.NoiseModel, "solve", solve)
    (one,) = design().warnings(cases(*[SPEED] * 4))
    assert one.size == 7 / 80 and one.endswith("in 3 of 4 cases, worst case 1")
    each = iter(np.array([[[8, 8], [80, 80]]], float))
    assert design().warnings(cases(SPEED)) == []  # a tenth


@pytest.mark.slow
def test_warnings_of_unlike_loads():
    """Those in time differ: under 150 N along the radius alone by 16 dB in total."""
    loads = (150.0, 300.0), (0.0, 150.0), (0.0, 0.0)  # the last one fails
    load = np.array([[0, radial, axial, 0, 0, 0] for axial, radial in loads])
    given = Cases(load, inner_speed=[SPEED] * 3)
    (one,) = design().warnings(given)
    assert one.kind == "unlike_loads" and one.size < 1e-3 and one.limit == UNLIKE
    assert one.endswith("in 1 of 3 cases, worst case 1")
    assert design().warnings(cases(SPEED)) == []


def test_warnings_are_those_of_what_is_found(monkeypatch):
    """Of the design that is identified, and of the one whose numbers scatter."""

    def told(self, cases, solved=None):
        play = float(self.installed.drawing.bearing.radial_internal_clearance)
        return [Warning("unlike_loads", f"{play:.3g}")]

    monkeypatch.setattr(NoiseDesign, "warnings", told)
    path, one = "installed.drawing.bearing.radial_internal_clearance", design()
    unknowns, error = [Variable(path, 1e-5, 2e-5)], {"line_BPFO": 1.0}
    asked = CaseModel(one, FREE), cases(SPEED), unknowns, {"line_BPFO": 50.0}, error
    given, numbers = _read_call(*asked, ()), np.array([50.0])
    fit = Fit(np.array([0.5]), numbers, np.ones((1, 1)), np.array(0.0), np.array(1))
    assert _warnings(given, fit, 0.5, 0.0) == ["1.5e-05"]

    def solve(self, samples, slopes):
        return (
            1e6 * samples,
            np.zeros(len(samples), int),
            np.full((len(samples), 1, 1), 1e6),
        )

    monkeypatch.setattr(Sampled, "solve", solve)
    scatters = [Scatter(path, truncated_normal(1e-5, 2e-5))]
    found = tolerances(one, cases(SPEED), scatters, [NoiseLevel()], samples=16)
    assert found.warnings == ["at the mean: 1.5e-05"]  # not of the 1.2e-05 given


@pytest.mark.slow
def test_levels_as_vibration_in_time():
    """Total and lines by 0.03 dB. Two lines are 2 Hz apart, nearer than a spectrum of
    the record parts them: amplitudes are those of all lines that fit it best."""
    one, case = design(), jax.tree.map(lambda leaf: leaf[0], cases(SPEED))
    options = bj.statics.SolveOptions()
    found = jax.jit(lambda c: one.solve_case(c, FREE, options))(case)
    assert int(found.result) == 0
    motion = noise.vibration(one.rig, turns=32, settle=8, samples=512)
    given = motion.acceleration[:, :3], float(motion.duration)
    lines = noise.spectrum(*given, float(motion.shaft_frequency), window=noise.Hann())
    step = given[1] / len(given[0])
    angle = 2.0 * np.pi * step * np.outer(np.arange(len(given[0])), found.frequency)
    waves = np.hstack([np.cos(angle), np.sin(angle)])
    weight = np.hanning(len(waves))[:, None]
    seen = weight[:, 0] * np.asarray(given[0][:, 1])
    both = np.linalg.lstsq(weight * waves, seen, rcond=None)[0].reshape(2, -1)
    exact = np.asarray(noise.level(np.sqrt(0.5 * np.sum(both**2, axis=0))))
    heard = exact > 30.0
    assert heard.sum() == 9
    np.testing.assert_allclose(found.line[heard], exact[heard], atol=0.03)
    total = noise.level(noise.total_root_mean_square(lines))[1]
    np.testing.assert_allclose(found.total, total, atol=0.03)
    bands = noise.band_levels(lines, noise.octave_bands(), highest=1000.0)[:, 1]
    held = np.isfinite(bands) & (np.asarray(bands) > 30.0)
    assert held.sum() >= 3
    np.testing.assert_allclose(found.band[held], bands[held], atol=0.05)


@pytest.mark.slow
def test_levels_of_random_bearings_as_in_time():
    """Each of those of `noise.monte_carlo`, of random amplitude, at two clearances."""
    wave, path = (60e-9, 8, 8), "rig.errors.outer.outwards.0.amplitude.0"
    one = design(RacewayErrors(outwards=Harmonics([8], [wave[0]])), elements=())
    play = "installed.drawing.bearing.radial_internal_clearance"
    scatters = [
        Scatter(path, stats.rayleigh(scale=wave[0] / 2**0.5)),
        Scatter(play, truncated_normal(6e-6, 18e-6)),
    ]
    asked = one, cases(SPEED), scatters, [NoiseLevel()]
    sampled = Sampled(*asked, samples=8, support=FREE)
    given = noise.Tolerances(outer_outwards=noise.RandomWaves(*wave))
    bare = design(RacewayErrors(), elements=()).rig
    records = noise.RecordOptions(turns=5, settle=2, samples=256, batch=4)

    def size(key):
        errors: Any = noise.sampled_model(bare, given, key).errors
        return errors.outer.outwards[0].amplitude[0]

    for clearance in scatters[1].ends:
        rig = eqx.tree_at(
            lambda m: m.element.bearing.radial_internal_clearance,
            bare,
            np.asarray(clearance),
        )
        found = noise.monte_carlo(rig, given, 4, jax.random.key(1), records=records)
        amplitude = np.asarray(jax.vmap(size)(found.keys))
        samples = np.stack([amplitude, np.full(4, clearance)], axis=1)
        values, result, _ = sampled.solve(samples, False)
        assert not result.any() and np.ptp(values) > 2.0
        np.testing.assert_allclose(values[:, 0], found.level[:, 1], atol=5e-3)


@pytest.mark.slow
def test_identify_waviness_of_twin():
    """Amplitudes from line levels at two speeds; those of orders 8 and 10 of the outer
    raceway, which move the ring at one line, are not told apart; derivatives as by
    differences."""
    outer = Harmonics([8, 10, 17], [30e-9, 20e-9, 10e-9], [0.1, 0.3, 2.0])
    one, at = design(RacewayErrors(outwards=outer)), cases(SPEED, 2 * SPEED)
    paths = [f"rig.errors.outer.outwards.0.amplitude.{k}" for k in range(3)]
    paths += ["rig.errors.inner.outwards.0.amplitude.2"]
    names = "line_BPFO", "line_2_BPFO", "line_BPFI_plus_shaft"
    both = ["installed.drawing.bearing.radial_internal_clearance", *paths]
    true = np.array([12e-6, 30e-9, 20e-9, 10e-9, 22e-9])
    model = CaseModel(one, FREE).for_numbers([[p] for p in both], names)

    def twice(x):
        found = model(x, at)
        levels = jnp.stack([found[name] for name in names])
        return levels, levels

    solve = jax.jit(jax.jacfwd(twice, has_aux=True))
    slopes, exact = solve(jnp.asarray(true))
    for k, size in enumerate(true):
        step = 2e-4 * size * np.eye(5)[k]
        far = solve(true + 2 * step)[1] - solve(true - 2 * step)[1]
        near = solve(true + step)[1] - solve(true - step)[1]
        by = (8 * near - far) / (12 * 2e-4 * size)
        np.testing.assert_allclose(slopes[..., k], by, rtol=1e-6, atol=1e-6 / size)
    assert np.all(np.abs(slopes[0, :, 1:3]) * true[1:3] > 0.1)  # dB, of line_BPFO
    noisy = exact + np.random.default_rng(3).normal(0.0, 0.3, (3, 2))
    readings = dict(zip(names, noisy, strict=True))
    unknowns = [Variable(p, 1e-9, 2e-7, 2e-8) for p in paths]
    errors = dict.fromkeys(names, 0.3)
    found = bj.identify(CaseModel(one, FREE), at, unknowns, readings, errors)
    assert found.converged and not found.identifiable
    assert len(found.untold) == 1
    assert all(path in found.untold[0] for path in paths[:2]), found.untold
    off = np.abs(found.estimate - true[1:])[2:] / found.standard_error[2:]
    assert np.all(off < 3.0)
    assert np.all(found.standard_error[2:] < 0.05 * true[3:])


def test_patterns_are_the_waves_at_the_rolling_elements():
    """Deviations of raceway and balls at their azimuths, by hand."""
    one = design(elements=())
    frequency, pattern = one._patterns(one.rig)
    azimuth, names = np.asarray(one.rig.still_system().row.azimuth), [*one.readings()]
    for name, ring, order, size, phase in (
        ("line_2_BPFO", 0, 17, 10e-9, 2.0),
        ("line_BPFI_plus_shaft", 1, 10, 22e-9, 0.0),
    ):
        expected = np.zeros((9, 2, 3), complex)
        expected[:, ring, 1] = size * np.exp(1j * (order * azimuth + phase))
        found = np.asarray(pattern[names.index(name)])
        np.testing.assert_allclose(found, expected, atol=1e-3 * size, err_msg=name)
    # That of the nominal contact angle; the load has changed it.
    kinematic = noise.kinematic_frequencies(one.rig.element.bearing, one.rig.speed)
    assert frequency[names.index("line_2_BPFO")] == pytest.approx(
        2 * float(kinematic.outer_passage), rel=1e-2
    )

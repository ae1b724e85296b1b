"""Lines of spectra are found above a floor, and named after the kinematics."""

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.noise import (
    Hann,
    NameRule,
    PeakRule,
    kinematic_frequencies,
    name_lines,
    spectrum,
)

TURN = 2 * np.pi
SHAFT = 25.0
SPEED = bj.Speed(inner=SHAFT * TURN)
BEARING = bj.FourPointBallBearing(
    14,
    0.0775,
    0.014288,
    outer_osculation=0.52,
    inner_osculation=0.52,
    shim_angle=np.radians(20.0),
)
ANGLE = np.radians(23.6)
KINEMATIC = kinematic_frequencies(BEARING, SPEED, ANGLE)
CAGE, OUTER, INNER, BALL = (
    float(one)
    for one in (
        KINEMATIC.cage,
        KINEMATIC.outer_passage,
        KINEMATIC.inner_passage,
        KINEMATIC.rotation,
    )
)
TONES = {
    "cage": (CAGE, 0.3),
    "shaft": (SHAFT, 1.0),
    "2 BSF - cage": (2 * BALL - CAGE, 0.2),
    "2 BSF": (2 * BALL, 0.4),
    "BPFO": (OUTER, 2.0),
    "BPFI - 2 shaft": (INNER - 2 * SHAFT, 0.1),
    "BPFI": (INNER, 0.7),
    "BPFI + shaft": (INNER + SHAFT, 0.15),
    "3 BPFO": (3 * OUTER, 0.5),
    "ring mode": (2703.0, 0.9),
    "unnamed": (1777.0, 0.25),
}


def record(turns, count, noise=0.0, tones=TONES):
    time = turns / SHAFT * np.arange(count) / count
    places, sizes = np.array(list(tones.values())).T
    y = np.cos(2 * np.pi * np.outer(time, places) + np.arange(len(places))) @ sizes
    return y + noise * np.random.default_rng(0).normal(size=count)


def test_lines_between_bins():
    """In 8 s with noise: every line with its own frequency and size, and no other."""
    turns, noise = 200, 0.1
    y = record(turns, 2**16, noise)
    found = spectrum(y, turns / SHAFT, SHAFT, window=Hann())
    lines = name_lines(found, BEARING, SPEED, ANGLE, natural={"ring mode": 2703.0})
    want = sorted((place, size, name) for name, (place, size) in TONES.items())
    assert [line.name for line in lines] == [name for *_, name in want]
    resolution = SHAFT / turns
    spread = noise * np.sqrt(2 * 1.5 / 2**16)  # of a line, by the noise in it
    for line, (place, size, _) in zip(lines, want, strict=True):
        assert abs(line.frequency - place) < 0.1 * resolution
        assert abs(line.amplitude - size) < 5 * spread
        np.testing.assert_allclose(line.order, line.frequency / SHAFT)
    again = name_lines(found, BEARING, SPEED, ANGLE, natural={"ring mode": 2703.0})
    assert again == lines


def test_lines_on_bins_without_a_window():
    places = {"shaft": (SHAFT, 1.0), "3 shaft": (75.0, 0.2), "unnamed": (218.75, 0.1)}
    found = spectrum(record(4, 1024, tones=places), 4 / SHAFT, SHAFT)
    lines = name_lines(found, BEARING, SPEED, ANGLE, names=NameRule(tolerance=1e-6))
    assert [line.name for line in lines] == list(places)
    for line, (place, size) in zip(lines, places.values(), strict=True):
        np.testing.assert_allclose(line.frequency, place)
        np.testing.assert_allclose(line.amplitude, size, rtol=1e-9)


def test_directions_are_taken_together():
    one = record(200, 2**13)
    both = np.stack([0.6 * one, 0.8 * one], axis=1)
    options = dict(window=Hann())
    alone = spectrum(one, 200 / SHAFT, SHAFT, **options)
    pair = spectrum(both, 200 / SHAFT, SHAFT, **options)
    lines = [name_lines(found, BEARING, SPEED, ANGLE) for found in (alone, pair)]
    assert [line.name for line in lines[0]] == [line.name for line in lines[1]]
    np.testing.assert_allclose(
        [line[:3] for line in lines[0]], [line[:3] for line in lines[1]], rtol=1e-9
    )


def only(place, speed=SPEED, turns=200, natural=None, **rule):
    """Name of a lone line."""
    y = record(turns, 2**15, tones={"": (place, 1.0)})
    found = spectrum(y, turns / SHAFT, SHAFT, window=Hann())
    (line,) = name_lines(
        found, BEARING, speed, ANGLE, natural=natural, names=NameRule(**rule)
    )
    return line.name


def test_name_lines_prefers_simplest_name():
    # The cage passes 14 balls over a fixed raceway in a turn: 14 cage is BPFO.
    assert only(OUTER, harmonics=20) == "BPFO"
    # All balls over both raceways: a harmonic of the shaft, or sidebands of BPFI.
    assert only(2 * SHAFT) == "2 shaft"
    # Of equally simple ones the nearest.
    near = 0.5 * (SHAFT + CAGE)
    few = {"tolerance": 10.0, "harmonics": 1, "sidebands": 0}
    assert only(near - 0.3, **few) == "cage"
    assert only(near + 0.3, **few) == "shaft"
    assert only(near, tolerance=1.0) == "unnamed"
    # Coarse lines: what is met exactly before what is simpler and far, but not before
    # what is simpler and as near.
    assert only(INNER - 2 * SHAFT, tolerance=20.0) == "BPFI - 2 shaft"
    assert only(3 * OUTER, tolerance=2 * abs(2 * INNER - 3 * OUTER)) == "3 BPFO"
    assert only(OUTER + 0.1, tolerance=20.0, harmonics=20) == "BPFO"
    # A natural frequency gives way to what the rolling makes.
    own = {"low mode": OUTER + 0.01, "high mode": 900.0}
    assert only(OUTER, natural=own) == "BPFO"
    assert only(899.99, natural=own, harmonics=1) == "high mode"


def test_limits_of_the_search():
    place = INNER + 2 * SHAFT
    assert only(place) == "BPFI + 2 shaft"
    assert only(place, sidebands=1) == "unnamed"
    assert only(11 * OUTER, harmonics=11) == "11 BPFO"
    assert only(11 * OUTER, sidebands=0) == "unnamed"


def test_name_lines_with_rotating_rings():
    both = bj.Speed(inner=SHAFT * TURN, outer=-7.3 * TURN)
    kinematic = kinematic_frequencies(BEARING, both, ANGLE)
    assert only(7.3, both) == "outer ring"
    assert only(SHAFT, both) == "inner ring"
    assert only(float(kinematic.outer_passage) - 7.3, both) == "BPFO - outer ring"
    assert only(float(kinematic.inner_passage) + SHAFT, both) == "BPFI + inner ring"
    alone = bj.Speed(outer=SHAFT * TURN)
    kinematic = kinematic_frequencies(BEARING, alone, ANGLE)
    assert only(SHAFT, alone) == "shaft"
    assert only(float(kinematic.outer_passage) + SHAFT, alone) == "BPFO + shaft"


def test_noise_has_no_lines():
    """Of 4096 lines of noise the largest is near sqrt(lg 4096/lg 2) = 3.5 medians."""
    y = np.random.default_rng(3).normal(size=8192)
    found = spectrum(y, 8.0, SHAFT)
    assert name_lines(found, BEARING, SPEED) == ()
    assert 0 < len(name_lines(found, BEARING, SPEED, peaks=PeakRule(factor=3.0))) < 20
    # Every third line is larger than both beside it.
    found = name_lines(found, BEARING, SPEED, peaks=PeakRule(factor=0.0))
    np.testing.assert_allclose(len(found), 4096 / 3, rtol=0.05)
    # Records of nothing, and one of a mean alone.
    for y in (np.zeros(256), np.full(256, 3.0)):
        assert name_lines(spectrum(y, 0.16, SHAFT), BEARING, SPEED) == ()


def test_wrong_settings():
    for name, value in dict(harmonics=0, sidebands=-1, tolerance=-1.0).items():
        with pytest.raises(ValueError, match=f"`{name}` is"):
            NameRule(**{name: value})
    for name, value in dict(neighbours=0, factor=-1.0, least=-1.0, largest=-1).items():
        with pytest.raises(ValueError, match=f"`{name}` is"):
            PeakRule(**{name: value})
    found = spectrum(np.zeros(64), 0.16, SHAFT)
    with pytest.raises(ValueError, match="natural.*mode.*-3 Hz"):
        name_lines(found, BEARING, SPEED, natural={"mode": -3.0})

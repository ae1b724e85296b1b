"""Sets and self-aligning bearings on a noise rig, beside the element of the bearing.

The element finds the place of every rolling element by its equilibrium, row by row; the
equations of motion have all rows as one, each rolling element free.
"""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import SOLVER

import bearingjax as bj
from bearingjax.design import FormErrors, Harmonics, RacewayErrors, with_raceways
from bearingjax.noise import (
    NameRule,
    NoiseModel,
    Tolerances,
    excitation,
    linear_model,
    name_lines,
    sampled_model,
    spectrum,
)
from bearingjax.noise.dynamics.dynamic_row import of_rows
from bearingjax.noise.static_start import static_start
from bearingjax.noise.warning import _gyroscopic

SPEED = bj.Speed(inner=300.0)
LOAD = [50.0, -100.0, -200.0, 1.0, 2.0, 0.0]
ROW = bj.AngularContactBallBearing(
    8, 0.05, 0.01, contact_angle=0.4, outer_osculation=0.52, inner_osculation=0.52
)
OFF_CENTRE = bj.BearingSet(
    (
        bj.SetRow(ROW, -0.008, inner_offset=10e-6),
        bj.SetRow(dataclasses.replace(ROW, n_balls=9), 0.012, mirrored=True),
    )
)
"""Rows of other numbers of balls, neither of which stands at the node."""


def model(bearing, load=LOAD, tilting=1e-4, **more):
    """A bearing that is held from tilting where its `tilting` inertia is None."""
    given = {"tilting_inertia": tilting, "tilts": tilting is not None}
    return NoiseModel(bj.BearingElement(bearing), 0.5, load, SPEED, **given, **more)


def condensed(found, k):
    """Stiffness of the ring, and what deviations push it with; elements at rest."""
    stiffness, push = np.asarray(found.stiffness), np.asarray(found.push)
    shape = push.shape
    share = np.linalg.solve(stiffness[k:, k:], stiffness[k:, :k]).T
    ring = stiffness[:k, :k] - share @ stiffness[k:, :k]
    flat = push.reshape(len(push), -1)
    return ring, (flat[:k] - share @ flat[k:]).reshape(k, *shape[1:])


def with_deviations(element, met):
    """The set whose rolling elements find their raceways so."""
    parts = of_rows(met, element.bearing)
    rows = tuple(
        dataclasses.replace(row, bearing=with_raceways(row.bearing, own))
        for row, own in zip(element.bearing.rows, parts, strict=True)
    )
    return dataclasses.replace(element, bearing=bj.BearingSet(rows))


@pytest.fixture(scope="module")
def pair():
    """Two rows at rest, whose balls all bear."""
    one = dataclasses.replace(model(OFF_CENTRE), speed=bj.Speed())
    return one, linear_model(one)


@pytest.mark.slow
def test_noise_set_stiffness_matches_element(pair):
    one, found = pair
    solution = bj.solve_load(
        one.element, LOAD, support=bj.Support(fixed_ring="inner", free=one.freedoms)
    )
    ring, _ = condensed(found, 5)
    element = np.asarray(solution.stiffness)[:5, :5]
    np.testing.assert_allclose(ring, element, rtol=0, atol=SOLVER * element.max())


@pytest.mark.slow
def test_noise_set_deviation_forces_match_element(pair):
    one, found = pair
    solution = bj.solve_load(
        one.element, LOAD, support=bj.Support(fixed_ring="inner", free=one.freedoms)
    )
    q = solution.displacement

    @jax.jit
    def push(met):
        # What holds the ring, reversed.
        return -with_deviations(one.element, met).force(q)[:5]

    _, ours = condensed(found, 5)
    theirs = jax.jacobian(push)(jnp.zeros((17, 2, 3)))
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=SOLVER * np.max(theirs))


@pytest.mark.slow
def test_a_set_of_one_row_is_the_row():
    """Of both ways to look: mirrored, its errors and its load are mirrored too."""
    errors = FormErrors(inner=RacewayErrors(axial=Harmonics((3, 7), (1e-7, 2e-7))))
    push = np.array([0.0, -20.0, -100.0, 0.0, 0.0, 0.0])
    alone = model(ROW, push, None, errors=errors)
    turned = bj.BearingSet((bj.SetRow(ROW, 0.0, mirrored=True),))
    mirrored = model(turned, push * [1, 1, -1, 1, 1, 1], None, errors=errors)
    both = alone, mirrored
    one, other = (np.asarray(excitation(m, samples=8).force) for m in both)
    size = np.abs(one).max()
    other = other * [1, 1, -1, -1, -1, 1]
    np.testing.assert_allclose(one, other, rtol=0, atol=SOLVER * size)
    moving = [
        m.system().forces(start, 0 * start, jnp.array(1e-3), start)
        for m in (alone, mirrored)
        for start in [static_start(m, m.still_system())[0]]
    ]
    moving[1] = moving[1].at[2].multiply(-1)
    size = np.abs(moving[0]).max()
    np.testing.assert_allclose(*moving, rtol=0, atol=SOLVER * size)


@pytest.mark.slow
def test_a_self_aligning_bearing_stands_in_balance():
    row = bj.SelfAligningBallRow(
        9, 0.046, 0.0087, inner_osculation=0.53, row_offset=0.0049
    )
    bearing = bj.BearingSet.self_aligning(row)
    load = [0.0, -500.0, -50.0, 0.0, 0.0, 0.0]
    one = model(bearing, load, None)
    system = one.still_system()
    start, result = static_start(one, system)
    assert result == 0
    left = system.contact_forces(start, jnp.zeros(())).at[:3].add(-one.load[:3])
    assert np.abs(left).max() < SOLVER * 500.0
    with pytest.raises(ValueError, match="nothing holds from tilting"):
        model(bearing, load)


def test_rows_are_drawn_on_their_own():
    found = sampled_model(
        model(OFF_CENTRE), Tolerances(diameter=1e-6), jax.random.key(0)
    ).element.bearing.rows
    one, other = (np.asarray(row.bearing.ball_deviation) for row in found)
    assert one.shape == (8,) and other.shape == (9,)
    assert np.all(np.abs(one - other[:8]) > 0)


def test_name_lines_states_row_of_unequal_rows():
    turns, passage = 200, 9 * 0.4089
    time = np.arange(8 * turns * 4) / (8 * 4)
    heard = spectrum(np.cos(2 * np.pi * passage * time), turns / 1.0, 1.0)
    rows = [dataclasses.replace(ROW, n_balls=n) for n in (8, 9)]
    pair = bj.BearingSet((bj.SetRow(rows[0], -0.01), bj.SetRow(rows[1], 0.01)))
    (line,) = name_lines(
        heard, pair, bj.Speed(inner=2 * np.pi), names=NameRule(tolerance=0.05)
    )
    assert line.name == "BPFO of row 1"


def test_gyroscopic_warning_matches_harris():
    """As Harris has them, rolling on the outer raceway, at the free contact angle."""
    omega, load = 1500.0, np.full((2, 17, 2), 20.0)
    mass, ratio = 7850.0 * np.pi / 6.0 * 0.01**3, 0.2
    sine, cosine = np.sin(0.4), np.cos(0.4)
    pitch = np.arctan2(sine, cosine + ratio)
    along = np.cos(pitch) * cosine + np.sin(pitch) * sine
    rolls = (
        omega / ratio / (along * (1 / (1 + ratio * cosine) + 1 / (1 - ratio * cosine)))
    )
    orbit = 0.5 * omega * (1.0 - ratio * cosine)
    moment = mass * 0.01**2 / 10.0 * rolls * orbit * np.sin(pitch)
    fast = dataclasses.replace(model(OFF_CENTRE), speed=bj.Speed(inner=omega))
    texts = list(_gyroscopic(fast, load))
    assert [text.partition(" of row ")[2][0] for text in texts] == ["0", "1"]
    share = 100.0 * 2.0 * moment / 0.01 / 20.0
    assert f"tractions of {share:.2g} % of their loads" in texts[0] and share < 30.0
    assert not list(_gyroscopic(fast, 20.0 * load))
    asked = bj.BearingElement(OFF_CENTRE, raceway_control=bj.element.CentrifugalOnly())
    assert not list(_gyroscopic(dataclasses.replace(fast, element=asked), load))


def test_errors_of_a_set_are_one_for_each_row():
    errors = FormErrors(), FormErrors()
    assert model(OFF_CENTRE, errors=errors).errors_of_rows == errors
    assert len(model(OFF_CENTRE).errors_of_rows) == 2
    with pytest.raises(ValueError, match="of 3 rows; the bearing has 2"):
        model(OFF_CENTRE, errors=(*errors, FormErrors()))


def test_noise_model_rejects_sprung_and_unlike_sets():
    sprung = bj.BearingSet.back_to_back(ROW, 0.02, spring=bj.PreloadSpring(100.0))
    with pytest.raises(ValueError, match="a spring presses a row"):
        model(sprung)
    deep = bj.DeepGrooveBallBearing(
        8, 0.05, 0.01, outer_osculation=0.52, inner_osculation=0.52
    )
    four = bj.FourPointBallBearing(
        8, 0.05, 0.01, outer_osculation=0.52, inner_osculation=0.52, shim_angle=0.3
    )
    unlike = bj.BearingSet((bj.SetRow(deep, -0.01), bj.SetRow(four, 0.01)))
    with pytest.raises(ValueError, match="unlike structure"):
        model(unlike).system(8)

"""Forces and displacements of rings that turn slowly on raceways with form errors.

Orders that shake, and at which frequency: sums over evenly spaced elements. Sizes: one
Newton step of the bearing, and a ball between two springs condensed by hand.
"""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.design import with_raceways
from bearingjax.design.deviation import deviation_of
from bearingjax.design.form_error import FormErrors, Harmonics, RacewayErrors
from bearingjax.element.azimuth import azimuths
from bearingjax.noise import NoiseModel, excitation, waviness_force
from bearingjax.noise.quasi_static import at_instant

ABSENT = 1e-3  # of lines that balance, over those that do not (small amplitudes)
SPEED = bj.Speed(inner=50.0 * np.pi)
AXIAL = [0.0, 0.0, -200.0, 0.0, 0.0, 0.0]
PULLED = jnp.array([0.0, 0.0, 200.0, 0.0, 0.0, 0.0])


def standing(element):
    return bj.solve_load(
        element, AXIAL, support=bj.Support(fixed_ring="inner", free=("ux", "uy", "uz"))
    )


def deep_groove(z, diameter, pitch):
    return bj.DeepGrooveBallBearing(
        z, pitch, diameter, outer_osculation=0.52, inner_osculation=0.52
    )


EIGHT = deep_groove(8, 6.747e-3, 28.5e-3)
FOURTEEN = deep_groove(14, 14.288e-3, 77.5e-3)
SEVEN = balls(7, azimuth_deviation=0.05 * np.sin([1.0, 5.0, 2.0, 6.0, 3.0, 0.5, 4.0]))


def with_waves(bearing, highest, kind="outwards", part="inner", size=1e-9):
    """Model of order k alone, k up to `highest`: one program for all of them."""
    element = bj.BearingElement(bearing)

    def model(order, size=size, phase=0.0):
        every = np.arange(1, highest + 1)
        waves = Harmonics(every, size * (every == order), phase * np.ones(highest))
        errors = RacewayErrors(**{kind: waves})
        given = FormErrors(**{part: errors})
        return NoiseModel(element, 0.3, AXIAL, SPEED, given, tilts=False)

    return model


def found(model, **choice):
    """Force on the held ring or displacement of the free one, its even parts gone."""
    both = []
    for one in (model, scaled(model, -1.0)):
        answer = excitation(one, samples=32, **choice)
        assert not answer.result.any()
        held = choice.get("held", True)
        both.append(answer.force if held else answer.displacement)
        time = answer.time
    return np.asarray(time), 0.5 * np.asarray(both[0] - both[1])


def scaled(model, factor):
    """The same with waves of other heights."""

    def one(path, leaf):
        return factor * leaf if path[-1].name == "amplitude" else leaf

    errors = jax.tree_util.tree_map_with_path(one, model.errors)
    return dataclasses.replace(model, errors=errors)


@pytest.mark.parametrize("part", ["inner", "outer"])
@pytest.mark.slow
def test_orders_and_frequencies_of_eight_balls(part):
    """KIN-2: kZ pushes axially, kZ ± 1 radially, all others balance."""
    of_order = with_waves(EIGHT, 17, part=part)
    series = {n: found(of_order(n)) for n in (1, 2, 4, 6, 7, 8, 9, 10, 15, 16, 17)}
    radial = {n: force[:, 0] + 1j * force[:, 1] for n, (_, force) in series.items()}
    largest = np.abs(radial[9]).max(), np.abs(series[8][1][:, 2]).max()
    for n, (time, force) in series.items():
        lines = waviness_force(EIGHT, SPEED, part, n)
        for line in np.asarray(lines.radial):
            turning = np.exp(2j * np.pi * line * time)
            size = np.mean(radial[n] * np.conj(turning))
            assert abs(size) > 0.9 * largest[0]
            left = radial[n] - size * turning
            assert np.abs(left).max() < ABSENT * largest[0], n
        for line in np.asarray(lines.axial):
            angle = 2 * np.pi * line * time
            basis = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            size = np.linalg.lstsq(basis, force[:, 2])[0]
            assert np.hypot(*size) > 0.9 * largest[1]
            left = force[:, 2] - basis @ size
            assert np.abs(left).max() < ABSENT * largest[1], n
        if not lines.radial.size:
            assert np.abs(radial[n]).max() < ABSENT * largest[0], n
        if not lines.axial.size:
            assert np.abs(force[:, 2]).max() < ABSENT * largest[1], n


def test_orders_of_the_four_point_bearings_fourteen_balls():
    """A multiple of fourteen along the axis, one less or more across it."""
    of_order = with_waves(FOURTEEN, 43)
    size = {n: np.abs(found(of_order(n))[1]).max(axis=0) for n in (*range(1, 17), 43)}
    radial = {n: max(force[:2]) for n, force in size.items()}
    assert {n for n in radial if radial[n] > ABSENT * radial[13]} == {
        n for n in size if n % 14 in (1, 13)
    }
    assert {n for n in size if size[n][2] > ABSENT * size[14][2]} == {14}


@pytest.fixture(scope="module")
def uneven():
    """Seven balls, unevenly spaced: a wave of order 5 raised on the inner raceway."""
    model = with_waves(SEVEN, 8, "raised")(5, phase=0.4)
    return model, found(model), found(model, held=False)


def turned(model, time):
    system = dataclasses.replace(model.system(8), errors=None)
    element = at_instant(model.element, system, jnp.asarray(time))
    return element, np.asarray(azimuths(element.bearing))


@pytest.mark.slow
def test_a_small_wave_pushes_as_the_slope_of_the_ring_force(uneven):
    model, (time, force), (_, moved) = uneven
    held = standing(model.element).displacement

    @jax.jit
    def step(element, q, met):
        def of_met(met):
            bearing = with_raceways(element.bearing, met)
            return dataclasses.replace(element, bearing=bearing).force(q)

        push = -jax.jvp(of_met, (jnp.zeros_like(met),), (met,))[1][:6]
        return push, element.stiffness(q)[:3, :3]

    for k in range(0, 32, 5):
        element, at = turned(model, time[k])
        met = np.zeros((7, 2, 3))
        met[:, 1, 2] = 1e-9 * np.cos(5 * (at - SPEED.inner * time[k]) + 0.4)
        met = jnp.asarray(met)
        push, _ = step(element, held, met)
        size = np.abs(push).max()
        np.testing.assert_allclose(force[k], push, rtol=0, atol=DIFFERENCE * size)
        # The free ring moves on as the balls do, also without form errors.
        free = standing(element).displacement
        push, stiffness = step(element, free, met)
        expected = np.linalg.solve(stiffness, push[:3])
        scale = DIFFERENCE * np.abs(expected).max()
        np.testing.assert_allclose(moved[k, :3], expected, rtol=0, atol=scale)


@pytest.mark.slow
def test_a_ball_between_two_springs(uneven):
    """Contact stiffness 3/2 K d^(1/2) of both contacts, in series along the normal."""
    model, (time, force), _ = uneven
    element = model.element
    solution = standing(element)
    for k in range(0, 32, 5):
        at_time, at = turned(model, time[k])
        (row,) = at_time.rows(solution.displacement)
        load = np.asarray(row.contact_load)
        constant = np.asarray(element.model().rows[0].element.constant)
        rate = 1.5 * constant ** (2 / 3) * load ** (1 / 3)
        series = 1.0 / np.sum(1.0 / rate, axis=1)
        height = 1e-9 * np.cos(5 * (at - SPEED.inner * time[k]) + 0.4)
        # The outer ring is pushed along the line of both contacts, away from the ball.
        angle = contact_angles(model, solution, at)
        normal = [
            np.cos(angle) * np.cos(at),
            np.cos(angle) * np.sin(at),
            np.sin(angle),
        ]
        push = np.asarray(normal) @ (series * height)
        size = np.abs(push).max()
        np.testing.assert_allclose(force[k, :3], push, rtol=0, atol=DIFFERENCE * size)


def contact_angles(model, solution, at):
    """Of the line between the groove centres, from the drawing and the ring's place."""
    bearing = model.element.bearing
    d, free = 0.0095, np.radians(25.0)
    apart = (0.53 + 0.52 - 1.0) * d
    x, y, z = np.asarray(solution.displacement[:3])
    radial = apart * np.cos(free) - (x * np.cos(at) + y * np.sin(at))
    axial = apart * np.sin(free) - z
    assert deviation_of(bearing).diameter is None
    return np.arctan2(axial, radial)


def test_uneven_spacing_lets_every_order_shake(uneven):
    """003.5; evenly spaced, orders 3 to 5 of seven balls would balance."""
    of_order = with_waves(SEVEN, 8, "raised")
    sizes = [np.abs(found(of_order(n))[1]).max() for n in range(1, 9)]
    assert min(sizes) > 0.01 * max(sizes)


def test_excitation_of_eccentric_raceway():
    model = with_waves(EIGHT, 17)(1, 1e-7)
    answer = excitation(model, samples=32, held=False)
    angle = SPEED.inner * answer.time
    expected = 1e-7 * jnp.stack([jnp.cos(angle), jnp.sin(angle)], axis=1)
    np.testing.assert_allclose(answer.displacement[:, :2], expected, atol=1e-13)
    np.testing.assert_allclose(answer.displacement[:, 2], 0.0, atol=1e-13)
    # Its load is carried at every instant.
    np.testing.assert_allclose(answer.force[:, :3], 0.0, atol=1e-7)


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.slow
def test_derivatives(held):
    model = with_waves(SEVEN, 8, "raised")(5, 1e-7)

    @jax.jit
    @jax.value_and_grad
    def pushed(values):
        changed = dataclasses.replace(model, load=model.load * values[0])
        changed = scaled(changed, values[1])
        answer = excitation(changed, samples=8, held=held, throw=False)
        seen = answer.force if held else answer.displacement
        return 1e8 ** (not held) * jnp.sum(seen[3, :3] * jnp.array([1.0, 2.0, 3.0]))

    at = jnp.ones(2)
    _, slope = pushed(at)
    for k in range(2):
        away = jnp.zeros(2).at[k].set(1e-4)
        difference = (pushed(at + away)[0] - pushed(at - away)[0]) / 2e-4
        assert float(slope[k]) == pytest.approx(float(difference), rel=DIFFERENCE)


def test_excitation_rejects_invalid_arguments():
    model = with_waves(EIGHT, 17)(1)
    still = dataclasses.replace(model, speed=bj.Speed(0.0))
    with pytest.raises(ValueError, match="`speed` is 0"):
        excitation(still)
    with pytest.raises(ValueError, match="`samples` is 0"):
        excitation(model, samples=0)
    pulled = dataclasses.replace(with_waves(SEVEN, 8, "raised")(5), load=PULLED)
    with pytest.raises(bj.SolveError, match="excitation: 32 of 32 instants"):
        excitation(pulled, samples=32)

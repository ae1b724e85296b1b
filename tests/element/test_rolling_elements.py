"""What may differ between rolling elements, and what a new kind of them needs."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, motion, taper
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj

N = 5
TAPER = bj.BearingElement(taper(N), quadrature=bj.numerics.Midpoint(8))
Q = jnp.asarray(motion())


def with_deviation(**change):
    return bj.BearingElement(taper(N, **change), quadrature=bj.numerics.Midpoint(8))


def test_rollers_all_larger_are_rollers_of_less_clearance():
    """The raceways stay: each gap is less by half of what the diameter is more."""
    more = 2e-6
    unlike = with_deviation(roller_deviation=np.full(N, more))
    play = -2.0 * more * np.cos(np.deg2rad(1.7235))
    wanted = with_deviation(radial_internal_clearance=play)
    got, want = unlike.evaluate(Q), wanted.evaluate(Q)
    # The diameter itself, a part in 4000, enters lever arms and profile too.
    np.testing.assert_allclose(
        got.force, want.force, atol=3e-3 * float(abs(want.force).max())
    )
    same = TAPER.evaluate(Q).force
    assert abs(same - want.force).max() > 0.05 * abs(want.force).max()


@pytest.mark.slow
def test_larger_roller_carries_more_load_than_neighbours():
    deviation = np.zeros(N)
    deviation[1] = 3e-6
    unlike = with_deviation(roller_deviation=deviation)
    load = [0.0, 0.0, 4e3, 0.0, 0.0, 0.0]
    solved, even = (bj.solve_load(e, load) for e in (unlike, TAPER))
    more = np.asarray(solved.roller_load - even.roller_load)[:, 0]
    assert more[1] > 50.0 and np.all(more[[0, 2]] < 0.0)
    # Inertia and the lengths along the rollers know the roller's own diameter.
    assert solved.line_load.shape == even.line_load.shape

    def load_of(value):
        element = eqx.tree_at(lambda e: e.bearing.roller_deviation, unlike, value)
        return bj.solve_load(element, load).roller_load[1, 0]

    at = jnp.asarray(deviation)
    slope = float(jax.grad(load_of)(at)[1])
    step = jnp.asarray(np.eye(N)[1] * 1e-8)
    difference = float(load_of(at + step) - load_of(at - step)) / 2e-8
    assert slope == pytest.approx(difference, rel=DIFFERENCE)


def test_azimuth_deviation_moves_single_rollers():
    """All turned alike is another first azimuth; one alone changes its own load."""
    turn = 0.07
    all_turned = with_deviation(azimuth_deviation=np.full(N, turn))
    first = with_deviation(first_azimuth=turn)
    got, want = all_turned.evaluate(Q), first.evaluate(Q)
    np.testing.assert_allclose(
        got.force, want.force, atol=ROUNDING * float(abs(want.force).max())
    )
    one = np.zeros(N)
    one[2] = turn
    (rows,) = with_deviation(azimuth_deviation=one).rows(Q)
    (plain,) = TAPER.rows(Q)
    same = np.arange(N) != 2
    np.testing.assert_allclose(rows.azimuth - plain.azimuth, one, atol=1e-15)
    np.testing.assert_allclose(
        rows.contact_load[same], plain.contact_load[same], rtol=SOLVER
    )
    assert abs(rows.contact_load[2] - plain.contact_load[2]).max() > 1.0


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (dict(roller_deviation=[1e-6]), r"has shape \(1,\); it must be \(5,\)"),
        (dict(roller_deviation=[np.nan] * N), "it must be finite"),
        (dict(roller_deviation=[0.02] * N), "smaller in size than the roller diameter"),
        (dict(azimuth_deviation=[0.0, 1.2, 0.0, 0.0, 0.0]), "rad apart"),
        (dict(azimuth_deviation="1 deg"), "must be numbers in rad"),
    ],
)
def test_deviations_are_checked(change, text):
    with pytest.raises((ValueError, TypeError), match=text):
        taper(N, **change)


@pytest.mark.slow
def test_elements_near_by_are_solved_in_fewer_steps():
    """To the same answer; what they became goes into the next call."""
    cold = TAPER.evaluate(Q)
    force, near = TAPER.force(Q, with_near=True)
    np.testing.assert_allclose(
        force, cold.force, atol=ROUNDING * float(abs(force).max())
    )
    beside = Q * (1.0 + 1e-6)
    warm, again = TAPER.evaluate(beside, near=near), TAPER.evaluate(beside)
    model = TAPER.model()
    steps, from_cold = (
        int(jnp.sum(model.solve(beside, start).groups[0].state.steps))
        for start in (near, None)
    )
    assert steps < 0.7 * from_cold
    np.testing.assert_allclose(
        warm.force, again.force, atol=SOLVER * float(abs(force).max())
    )
    function, parameters = TAPER.as_function()
    first = TAPER.nothing_near()
    at_first, carried = jax.jit(function)(Q, 0.0 * Q, 0.0, parameters, first)
    then, _ = jax.jit(function)(beside, 0.0 * Q, 0.0, parameters, carried)
    np.testing.assert_allclose(at_first, force, atol=SOLVER * float(abs(force).max()))
    np.testing.assert_allclose(then, warm.force, atol=SOLVER * float(abs(force).max()))


class OnlyForBalls(bj.element.AbstractKinematics):
    """Of one's own; it says nothing of rollers."""

    def ball(self, part):
        return bj.element.Linearised().ball(part)


def test_elements_near_by_of_other_speeds_are_refused():
    element, speed = bj.BearingElement(balls(6)), bj.Speed(inner=100.0)
    for near, now in ((None, speed), (speed, None)):
        with pytest.raises(ValueError, match="`near` holds .*with a `speed`"):
            element.force(jnp.zeros(12), now, near=element.nothing_near(near))


def test_kinematics_of_ones_own_work_or_are_refused():
    mine = bj.BearingElement(balls(N), kinematics=OnlyForBalls())
    plain = bj.BearingElement(balls(N))
    np.testing.assert_array_equal(mine.force(Q), plain.force(Q))
    with pytest.raises(ValueError, match="has no method `roller`"):
        bj.BearingElement(taper(N), kinematics=OnlyForBalls())


def test_methods_under_jit_hold_their_own_design():
    """Of one structure, and so of one hash; numbers tell them apart."""
    bearing = bj.CylindricalRollerBearing(7, 0.0725, 0.014, 0.01372)
    one = bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(4))
    # Not of weak type, which would be another program.
    length = jnp.asarray(np.float64(0.015))
    other = eqx.tree_at(lambda e: e.bearing.roller_length, one, length)
    q = jnp.zeros(12).at[7].set(-5e-6)
    found = [float(jax.jit(element.energy)(q)) for element in (one, other)]
    assert hash(one) == hash(other) and found[0] != found[1]
    expected = [float(element.energy(q)) for element in (one, other)]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    with pytest.raises(TypeError, match="a design that is traced cannot be hashed"):
        jax.eval_shape(lambda element: jax.jit(element.energy)(q), one)

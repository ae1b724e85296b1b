"""Branches over frequency: folds, flips, Neimark-Sacker points, and how they end."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b
from tolerances import DIFFERENCE
from vibrations import Spring, duffing, oscillator, rotor

from bearingjax.rotor.nonlinear import (
    Arclength,
    BranchEnd,
    ChangeOfParameter,
    HarmonicBalance,
    Shooting,
    Steps,
    follow,
    solve_orbit,
    trace,
)
from bearingjax.rotor.nonlinear.branch import _flip_test, _pairs
from bearingjax.rotor.nonlinear.continuation import BranchPoint

BALANCE, SHOOTING = HarmonicBalance(7, 32, steps=24), Shooting(24)
STEPS = Steps(first=0.05, largest=0.5)
FORCE, CUBIC, RATIO = 0.15, 0.05, 0.03


def folds_of_one_harmonic():
    """Of the Duffing oscillator, (1 - w² + 3/4 c a²)² + (2 z w)² = (F/a)²."""
    a = np.linspace(0.3, 3.0, 200_000)
    middle = 1.0 + 0.75 * CUBIC * a**2 - 2.0 * RATIO**2
    root = middle**2 - (1.0 + 0.75 * CUBIC * a**2) ** 2 + (FORCE / a) ** 2
    high, low = (
        np.sqrt(middle[root > 0] + s * np.sqrt(root[root > 0])) for s in (1, -1)
    )
    turns = np.nonzero(np.diff(np.sign(np.diff(high))))[0]
    return sorted([float(high[turns[0]]), float(low.max())])


@pytest.fixture(scope="module")
def branches():
    system = duffing(CUBIC, FORCE, RATIO)
    balance = follow(system, 0.6, 1.6, BALANCE, steps=STEPS)
    (told,) = balance.warnings
    lost = int((~balance.stable).sum())
    assert told.startswith(f"{lost} of {len(balance.stable)} periodic vibrations are")
    return {
        "balance": balance,
        "shooting": follow(system, 0.6, 1.6, SHOOTING, steps=STEPS),
        "parameter": follow(
            system, 0.6, 1.6, BALANCE, parameter=ChangeOfParameter(), steps=STEPS
        ),
    }


@pytest.mark.slow
def test_duffing(branches):
    for branch in branches.values():
        assert branch.ending == BranchEnd.LIMIT and branch.frequency[-1] == 1.6
        assert branch.residual.max() < 1e-8
        assert [event.kind for event in branch.events] == ["fold", "fold"]
        folds = sorted(event.frequency for event in branch.events)
        assert np.allclose(folds, folds_of_one_harmonic(), rtol=5e-3)
        theirs = sorted(event.frequency for event in branches["shooting"].events)
        assert np.allclose(folds, theirs, rtol=DIFFERENCE)
        # Unstable between the folds, and nowhere else.
        first, last = (event.after for event in branch.events)
        assert first < last
        assert branch.stable[: first + 1].all() and branch.stable[last + 1 :].all()
        assert not branch.stable[first + 1 : last + 1].any()
        for event in branch.events:
            assert event.located
            assert np.abs(event.multipliers - 1.0).min() < 1e-4
            half = 0.5 * np.ptp(event.displacement, axis=0)
            assert np.allclose(half, event.amplitude, rtol=0.01)  # between the samples


def test_hundreds_of_pairs_of_multipliers():
    """Their product, of 820 factors near 0.05, is no number above zero."""
    blank: Any = len(BranchPoint._fields) * [None]
    for last, sign in ((0.99, 1.0), (1.01, -1.0)):
        turned = last * np.array([[np.cos(1), -np.sin(1)], [np.sin(1), np.cos(1)]])
        matrix = np.diag([*np.linspace(0.95, 0.98, 39), 0.0, 0.0])
        matrix[39:, 39:] = turned
        point = BranchPoint(*blank)._replace(monodromy=matrix)
        assert np.isclose(sign * _pairs(point), abs(last**2 - 1.0))
        assert _flip_test(point) > 0


def test_a_branch_ends_at_frequency_zero(branches):
    system = duffing(CUBIC, FORCE, RATIO)
    branch = follow(system, 0.6, -0.6, BALANCE, steps=STEPS)
    assert branch.ending == BranchEnd.REST
    assert 0 < branch.frequency[-1] < 0.5 and (branch.frequency > 0).all()
    with pytest.raises(ValueError, match="`begin` is 0 rad/s"):
        follow(system, 0.0, 0.6, BALANCE, steps=STEPS)


def test_follow_does_not_retrace_for_new_values(branches):
    traces = []

    class Counted(eqx.Module):
        spring: Spring

        def __call__(self, q, velocity, phase, frequency):
            traces.append(1)
            return self.spring(q, velocity, phase, frequency)

    def run(cubic, begin, step):
        spring = Counted(Spring(jnp.asarray(cubic), jnp.asarray(0.0)))
        system = oscillator(spring, FORCE, RATIO)
        steps = Steps(first=step, largest=0.5, points=40)
        return follow(system, begin, 0.9, BALANCE, steps=steps)

    run(0.05, 0.6, 0.05)
    before = len(traces)
    run(0.02, 0.7, 0.04)
    assert len(traces) == before


def test_flips_and_branch_points_of_mathieu():
    """On the branch at rest of a stiffness that varies by 0.4."""
    system = oscillator(Spring(jnp.asarray(0.1), jnp.asarray(0.4)))
    steps = Steps(first=0.01, largest=0.02, frequency=0.01)
    branch = follow(system, 0.9, 2.4, SHOOTING, steps=steps)
    assert np.diff(branch.frequency).max() < 0.01 * float(
        system.reference_frequency
    ) * (1.0 + DIFFERENCE)

    def boundary(characteristic, order, low, high):
        def apart(w):
            return characteristic(order, 0.8 / w**2) - 4.0 / w**2

        return brentq(apart, low, high)

    wanted = {
        "branch_point": [(mathieu_a, 2, 0.8, 1.02), (mathieu_b, 2, 0.95, 1.1)],
        "flip": [(mathieu_a, 1, 1.7, 2.0), (mathieu_b, 1, 2.0, 2.3)],
    }
    for kind, numbers in wanted.items():
        found = sorted(e.frequency for e in branch.events if e.kind == kind)
        goal = sorted(boundary(*number) for number in numbers)
        assert np.allclose(found, goal, rtol=DIFFERENCE)
    assert len(branch.events) == 4
    along = [event.frequency for event in branch.events]  # which only rises here
    assert along == sorted(along)
    between = (branch.frequency > found[0] + 1e-3) & (
        branch.frequency < found[1] - 1e-3
    )
    assert not branch.stable[between].any()
    sizes = np.abs(branch.multipliers)
    assert (np.diff(sizes, axis=1) <= 0).all() and sizes.max() > 1.1


@pytest.mark.slow
def test_the_rotor_softens_and_becomes_almost_periodic():
    """36 degrees, a base that shakes: the traits of the published figures."""
    system = rotor(36, damping_ratio=0.01, base_acceleration=5.0)
    unit = float(system.reference_frequency)
    method = HarmonicBalance(6, 32, steps=24)
    branch = follow(system, 1.05 * unit, 0.8 * unit, method, steps=Steps(points=120))
    assert branch.ending == BranchEnd.LIMIT and branch.residual.max() < 1e-8
    kinds = [event.kind for event in branch.events]
    assert kinds.count("neimark_sacker") == 2 and kinds.count("fold") == 4
    # It softens: the peak of y at B lies below the natural frequency.
    assert branch.frequency[branch.amplitude[:, 3].argmax()] < 0.99 * unit
    assert branch.amplitude[:, 4].max() > 0.01 * branch.amplitude[:, 1].max()
    # Stability changes at marked points, and only there.
    changes = np.nonzero(np.diff(branch.stable.astype(int)))[0]
    assert [event.after for event in branch.events] == list(changes)
    for event in branch.events:
        if event.kind == "neimark_sacker":
            pair = event.multipliers[np.abs(np.imag(event.multipliers)) > 1e-3]
            assert np.abs(np.abs(pair) - 1.0).min() < 1e-6
    # The same orbit and multipliers by shooting, where no ball lifts off: within what
    # the harmonics that are left out make of the amplitudes.
    free = branch.amplitude[:, 1].argmin()
    orbit = solve_orbit(system, branch.frequency[free], SHOOTING)
    assert np.allclose(orbit.amplitude, branch.amplitude[free], rtol=1e-4)


class Wall(eqx.Module):
    """A spring that there is no more of beyond some motion."""

    def __call__(self, q, velocity, phase, frequency):
        return jnp.where(jnp.abs(q) > 1.0, jnp.nan, q)


def test_follow_reports_ending():
    system = oscillator(Wall(), 0.2, 0.05)
    branch = follow(system, 0.6, 1.6, BALANCE, steps=STEPS)
    assert branch.ending == BranchEnd.SMALL_STEP
    assert 0.9 < branch.amplitude.max() < 1.01 and branch.refused > 5
    few = dataclasses.replace(STEPS, points=3)
    short = follow(system, 0.6, 1.6, BALANCE, steps=few)
    assert short.ending == BranchEnd.POINTS and len(short.frequency) == 3
    none = follow(system, 1.0, 1.6, BALANCE, steps=STEPS)
    assert none.ending == BranchEnd.NO_START and len(none.frequency) == 0


def test_many_systems_at_once():
    steps = Steps(first=0.05, largest=0.5, points=60)

    @jax.jit
    @jax.vmap
    def run(force):
        system = duffing(CUBIC, force, RATIO)
        begin = jnp.zeros(16).at[-1].set(0.6)
        return trace(system, BALANCE, begin, jnp.asarray(1.6), Arclength(), steps)

    found = run(jnp.array([0.05, 0.2]))
    assert (np.asarray(found.ending) == BranchEnd.LIMIT).all()
    assert found.n_points[1] > found.n_points[0]
    ends = found.x[jnp.arange(2), found.n_points - 1, -1]
    assert np.allclose(ends, 1.6)

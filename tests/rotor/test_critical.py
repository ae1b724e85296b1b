"""Critical speeds and unbalance response: the paper's table, ROSS, closed forms."""

import dataclasses
import re

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from machines import friswell
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.rotor import AbstractSupport
from bearingjax.rotor.linear.critical import _count_missed


def test_critical_speeds_lie_on_campbell_diagram():
    """With damping: modes at the speed found vibrate once per revolution."""
    rotor = friswell(1e6, 0.8e6, 5e2)
    critical = bj.rotor.critical_speeds(rotor, count=4)
    assert (np.asarray(critical.whirl) == [-1, 1, -1, 1]).all()
    for speed, ratio in zip(critical.speed, critical.damping_ratio, strict=True):
        at = bj.rotor.modes(rotor, speed, count=6)
        k = np.argmin(abs(2 * np.pi * at.frequency - speed))
        np.testing.assert_allclose(2 * np.pi * at.frequency[k], speed, rtol=SOLVER)
        np.testing.assert_allclose(at.damping_ratio[k], ratio, rtol=DIFFERENCE)
    assert critical.damping_ratio.min() > 1e-3
    near = "critical_speeds: -.* rpm lies within 10 % of the forward critical speed of"
    speed = -1.05 * float(critical.speed[1])
    at = bj.rotor.critical_speeds(rotor, count=4, operating_speed=speed)
    (told,) = at.warnings
    assert re.match(near, told) and told.size == pytest.approx(0.05)
    assert critical.warnings == ()
    (told,) = dataclasses.replace(
        at, missed=jnp.asarray(2), operating_speed=None
    ).warnings
    assert "2 may be missing below" in told
    # A search that misses the second one has a wrong count.
    rate = -critical.damping_ratio * critical.speed
    point = jnp.stack([rate, critical.speed], axis=1)
    for found, missed in (([1, 1, 1, 1], 0), ([1, 0, 1, 1], 1)):
        found = jnp.array(found, dtype=bool)
        assert eqx.filter_jit(_count_missed)(rotor, found, point) == missed
    # Dampers that all but lock the supports: still all of them, each once, and within
    # what the dampers still give way.
    locked = bj.rotor.critical_speeds(friswell(1e6, 0.8e6, 6e4), count=4)
    rigid = bj.rotor.critical_speeds(friswell(1e10, 0.9e10, 5e2), count=4)
    assert (np.asarray(locked.whirl) == [-1, 1, -1, 1]).all()
    np.testing.assert_allclose(locked.speed, rigid.speed, rtol=0.01)
    assert critical.missed == locked.missed == rigid.missed == 0


def test_critical_speeds_keep_multiplicity():
    """A disc without moments of inertia on supports alike in x and y."""
    shaft = bj.rotor.Shaft([-0.1, 0.0, 0.1], 0.04, material=bj.Material(density=1e-3))
    for damping in (0.0, 300.0):
        support = bj.rotor.LinearSupport.isotropic(
            1, 4e6, 9e6, 1e5, radial_damping=damping
        )
        rotor = bj.rotor.Rotor(
            shaft, [bj.rotor.Disc(1, 9.0, 1e-9, 0.03)], [support], rigid=True
        )
        found = bj.rotor.critical_speeds(rotor, count=4)
        natural = np.sqrt(4e6 / 9.0)
        damped = np.sqrt(natural**2 - (damping / 18.0) ** 2)
        exact = [damped, damped, 1000.0, np.sqrt(1e5 / 0.03)]
        np.testing.assert_allclose(found.speed, exact, rtol=DIFFERENCE)
        assert found.missed == 0 and (found.whirl[:3] == 0).all()


class Stiffening(AbstractSupport):
    """Its stiffness rises with the square of the speed."""

    station: int = eqx.field(static=True)
    housing: None = None

    def force(self, motion, velocity, speed, angle=0.0):
        return (1e6 + 2.0 * speed**2) * motion + 40.0 * velocity


def test_supports_may_follow_the_speed():
    """Of a mass m on k + aΩ², with damping c: Ω² = (k - (c/2)²/m)/(m - a)."""
    shaft = bj.rotor.Shaft([-0.1, 0.0, 0.1], 0.04)
    rotor = bj.rotor.Rotor(
        shaft, [bj.rotor.PointMass(1, 5.0)], [Stiffening(1)], rigid=True
    )
    critical = bj.rotor.critical_speeds(rotor, count=3)
    m = float(rotor.mass)
    exact = np.sqrt((1e6 - 20.0**2 / m) / (m - 2.0))
    np.testing.assert_allclose(critical.speed, exact, rtol=SOLVER)
    natural = np.sqrt((1e6 + 2.0 * exact**2) / m)
    ratio = 20.0 / m / natural
    np.testing.assert_allclose(critical.damping_ratio, ratio, rtol=SOLVER)


def test_unbalance_response_of_jeffcott_rotor():
    """x + iy = m e Ω²/(k - mΩ² + icΩ) exp(i(Ωt + φ)): a circle, turning forward."""
    k, c, moment, phase = 4e6, 800.0, 1e-3, 0.7
    shaft = bj.rotor.Shaft([-0.1, 0.0, 0.1], 0.04)
    support = bj.rotor.LinearSupport(1, [k, k, 0, k, k], [c, c, 0, 0, 0])
    rotor = bj.rotor.Rotor(
        shaft, [bj.rotor.Disc(1, 9.0, 0.04, 0.03)], [support], rigid=True
    )
    m = float(rotor.mass)
    speeds = np.array([0.0, 100.0, np.sqrt(k / m), 5000.0])
    found = bj.rotor.unbalance_response(
        rotor, [bj.rotor.Unbalance(1, moment, phase)], speeds
    )
    x = moment * speeds**2 * np.exp(1j * phase) / (k - m * speeds**2 + 1j * c * speeds)
    motion = np.asarray(found.motion)
    np.testing.assert_allclose(motion[:, 1, 0], x, rtol=SOLVER, atol=1e-20)
    np.testing.assert_allclose(motion[:, 1, 1], -1j * x, rtol=SOLVER, atol=1e-20)
    np.testing.assert_allclose(found.major_axis[:, 1], abs(x), rtol=SOLVER, atol=1e-20)
    # Many speeds, which are solved in batches.
    many = bj.rotor.unbalance_response(
        rotor, [bj.rotor.Unbalance(1, moment, phase)], np.tile(speeds, 10)
    )
    np.testing.assert_allclose(np.asarray(many.motion)[8:12], motion, rtol=SOLVER)
    # At rest nothing moves, though nothing holds it along z.
    assert not motion[0].any() and np.isfinite(motion).all()
    # The base that shakes along x, while the rotor turns at a speed of its own.
    shaken = bj.rotor.RotorLoads(
        bj.rotor.Unbalance(1, moment, phase), base_acceleration=(2.0, 0, 0)
    )
    both = bj.rotor.harmonic_response(rotor, shaken, speeds, 300.0)
    base = -2.0 * m / (k - m * speeds**2 + 1j * c * speeds)
    motion = np.asarray(both.motion)
    np.testing.assert_allclose(motion[:, 1, 0], x + base, rtol=SOLVER)
    np.testing.assert_allclose(motion[:, 1, 1], -1j * x, rtol=SOLVER, atol=1e-20)

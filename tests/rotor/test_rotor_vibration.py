"""Rotors of shaft, discs and supports in the nonlinear solvers."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from tolerances import ROUNDING, SOLVER
from vibrations import ROTOR, grooves, rotor

import bearingjax as bj
from bearingjax.numerics.types import Scalar, as_real
from bearingjax.rotor import AbstractSupport, Housing, Rotor, Shaft, Unbalance
from bearingjax.rotor.nonlinear import (
    HarmonicBalance,
    HarmonicLoad,
    LawSupport,
    solve_orbit,
    vibrating_rotor,
)

BALANCE = HarmonicBalance(3, 16, steps=16)


class Cubic(AbstractSupport):
    """Springs that stiffen, and dampers."""

    station: int = eqx.field(static=True)
    cubic: Scalar = eqx.field(converter=as_real)
    housing: Housing | None = eqx.field(default=None, kw_only=True)

    def force(self, motion, velocity, speed, angle=0.0):
        square = motion[0] ** 2 + motion[1] ** 2
        hard = self.cubic * square * jnp.array([1.0, 1.0, 0.0, 0.0, 0.0]) * motion
        return 2e7 * motion + hard + 200.0 * velocity


def test_vibrating_rotor_with_linear_supports_matches_linear_rotor():
    housing = Housing(4.0, [3e8, 3e8, 3e8], [100.0, 100.0, 100.0])
    shaft = Shaft([0.0, 0.2, 0.5], [0.03, 0.03])
    disc = bj.rotor.Disc(1, 6.0, 0.02, 0.01)
    supports = [
        Cubic(station=0, cubic=0.0),
        Cubic(station=2, cubic=0.0, housing=housing),
    ]
    whole = Rotor(shaft, [disc], supports, damping=bj.rotor.ModalDamping(0.01))
    weight = Unbalance(1, 1e-5, 0.3)
    system = vibrating_rotor(whole, weight, scale=1e-5, reference_frequency=1e3)
    orbit = solve_orbit(system, 900.0, BALANCE)
    linear = bj.rotor.unbalance_response(whole, weight, [900.0])
    motions = np.asarray(whole.motions())
    found = np.asarray(orbit.displacement) @ motions.T
    phase = 2.0 * np.pi * np.arange(16) / 16
    complex_motion = np.concatenate(
        [np.ravel(linear.motion[0]), np.ravel(linear.housing[0])]
    )
    wanted = np.real(complex_motion[None, :] * np.exp(1j * phase)[:, None])
    assert np.abs(found - wanted).max() < SOLVER * np.abs(wanted).max()
    assert orbit.steps == 1


def test_vibrating_rotor_modal_damping_with_speed_supports():
    series = np.zeros((2, 5, 5))
    series[0] = np.diag([2e7, 2e7, 1e7, 1e3, 1e3])
    series[1] = -0.5 * series[0]
    supports = [bj.rotor.SpeedSupport(k, series, np.zeros(5), 1000.0) for k in (0, 2)]
    whole = Rotor(
        Shaft([0.0, 0.2, 0.5], [0.03, 0.03]),
        [bj.rotor.Disc(1, 6.0, 0.02, 0.01)],
        supports,
        damping=bj.rotor.ModalDamping(0.01),
    )
    unbalance = Unbalance(1, 1e-5)
    for speed in (None, 800.0):
        system = vibrating_rotor(
            whole, unbalance, scale=1e-5, reference_frequency=1e3, speed=speed
        )
        wanted = whole.linearise(speed or 0.0).damping
        largest = float(np.abs(wanted).max())
        assert np.allclose(system.damping, wanted, rtol=0, atol=ROUNDING * largest)
    # About an equilibrium at speed: the stiffness of the supports there.
    settled = bj.rotor.static_equilibrium(whole, None, 800.0)
    system = vibrating_rotor(
        whole, unbalance, scale=1e-5, reference_frequency=1e3, about=settled
    )
    assert np.allclose(system.damping, wanted, rtol=0, atol=ROUNDING * largest)
    assert system.supports is whole.supports


def test_rigid_rotor_matches_paper_rotor():
    angle, law = 36, grooves(36).fixed_angle()
    own = rotor(angle, damping_ratio=0.01, unbalance=3e-6)
    shaft = Shaft([0.0, 0.125, 0.5], [0.025, 0.025], material=bj.Material(2.1e11, 0.3))
    disc = bj.rotor.Disc(1, 10.0, 0.2, 0.1)
    bearings = [
        LawSupport(0, law),
        LawSupport(2, law, turned=True),
    ]
    damping = bj.rotor.ModalDamping(0.01)
    whole = Rotor(shaft, [disc], bearings, damping=damping, rigid=True)
    system = vibrating_rotor(
        whole,
        Unbalance(1, 3e-6),
        scale=law.preload_displacement,
        reference_frequency=own.reference_frequency,
    )
    w = 0.9 * float(own.reference_frequency)
    one, two = (solve_orbit(s, w, BALANCE) for s in (own, system))
    motion = np.asarray(two.displacement)
    # (ux uy uz gx gy) at A; x at B is ux + l gy, y is uy - l gx.
    x, y, z, gx, gy = motion.T
    seen = np.stack([x, y, x + 0.5 * gy, y - 0.5 * gx, z], axis=1)
    assert np.abs(seen - one.displacement).max() < 1e-6 * one.amplitude.max()
    assert float(one.amplitude.max()) > 0.05 * float(law.preload_displacement)
    assert np.isclose(ROTOR.mass()[4, 4], whole.mass, rtol=1e-12)


def test_harmonic_load_of_accelerating_unbalance():
    """The force is less the second derivative of its moment in time."""
    load = eqx.tree_at(
        lambda load: (load.unbalance_cosine, load.unbalance_sine),
        HarmonicLoad.zero(2),
        (jnp.array([2.0, 0.5]), jnp.array([-1.0, 3.0])),
    )

    def phase(t):
        return 0.3 + 5.0 * t + 2.0 * t**2

    def moment(t):
        c, s = jnp.cos(phase(t)), jnp.sin(phase(t))
        return c * load.unbalance_cosine + s * load.unbalance_sine

    t = jnp.asarray(0.7)
    wanted = -jax.jacfwd(jax.jacfwd(moment))(t)
    frequency = jax.grad(phase)
    found = load(phase(t), frequency(t), jax.grad(frequency)(t))
    assert np.allclose(found, wanted, rtol=ROUNDING)

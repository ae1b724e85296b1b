"""Craig-Bampton reduction: frequencies, and nonlinear orbits of fewer freedoms."""

import jax.numpy as jnp
import numpy as np
import pytest
from machines import bearing, stepped
from scipy.linalg import eigh
from tolerances import SOLVER
from vibrations import grooves

import bearingjax as bj
from bearingjax.rotor import craig_bampton, reduction_error
from bearingjax.rotor.nonlinear import (
    HarmonicBalance,
    LawSupport,
    solve_orbit,
    vibrating_rotor,
)

BALLS = bj.BearingElement(bearing(6.852, 27.5125))


def frequencies(matrices, count=6):
    """Lowest natural frequencies at rest without damping [rad/s]."""
    stiffness = 0.5 * (matrices.stiffness + matrices.stiffness.T)
    return np.sqrt(eigh(stiffness, matrices.mass, eigvals_only=True)[:count])


def test_frequencies():
    """From above, nearer with each mode, exact with all; housings are kept."""
    rotor = stepped()
    whole = rotor.linearise()
    wanted, last = frequencies(whole), np.inf
    for modes in (0, 2, 6, 1000):
        basis = craig_bampton(rotor, modes)
        found = frequencies(whole.project(basis))
        error = (found / wanted - 1.0).max()
        assert (found >= wanted * (1.0 - 1e-9)).all() and error < last + 1e-9
        last = error
    assert basis.shape == (whole.mass.shape[0],) * 2
    np.testing.assert_allclose(found, wanted, rtol=SOLVER)


def test_error_of_a_linear_response():
    """Against NumPy, of an unbalance between the supports."""
    rotor, omega = stepped(), 700.0
    loads = bj.rotor.RotorLoads(unbalances=bj.rotor.Unbalance(1, 1e-4, 0.3))
    cosine, sine = map(np.asarray, loads.unbalance_forces(rotor))
    force = omega**2 * (cosine - 1j * sine)
    whole = rotor.linearise(omega)

    def moved(matrices):
        mass, rates, stiffness, motions = (
            np.asarray(part)
            for part in (
                matrices.mass,
                matrices.rates,
                matrices.stiffness,
                matrices.motions,
            )
        )
        dynamic = stiffness + 1j * omega * rates - omega**2 * mass
        found = motions @ np.linalg.solve(dynamic, motions.T @ force)
        return found[: 5 * whole.n_nodes].reshape(-1, 5)[:, :3]

    exact = moved(whole)
    for modes in (0, 4):
        reduced = moved(whole.project(craig_bampton(rotor, modes)))
        wanted = np.abs(reduced - exact).max() / np.abs(exact).max()
        at = jnp.asarray(omega)
        found = reduction_error(rotor, loads, at, at, modes)
        np.testing.assert_allclose(found, wanted, rtol=1e-6)
        assert (found > 0.01) == (modes == 0)


@pytest.mark.slow
def test_orbit():
    """An orbit on nonlinear bearings, with a fifth of the freedoms."""
    law = grooves(26).fixed_angle()
    shaft = bj.rotor.Shaft([0.0, 0.2, 0.5], 0.03, divisions=(2, 3))
    rotor = bj.rotor.Rotor(
        shaft,
        bj.rotor.Disc(1, 6.0, 0.02, 0.012),
        [LawSupport(0, law), LawSupport(2, law, turned=True)],
        bj.rotor.ModalDamping(0.01),
    )
    loads = bj.rotor.RotorLoads(bj.rotor.Unbalance(1, 2e-3), gravity=(0.0, -9.81, 0.0))
    method = HarmonicBalance(3, 16, steps=16)
    orbits = []
    for modes in (None, 4):
        system = vibrating_rotor(
            rotor, loads, scale=1e-5, reference_frequency=1e3, modes=modes
        )
        orbit = solve_orbit(system, 500.0, method)
        orbits.append(np.asarray(orbit.displacement @ system.motions.T))
    full, reduced = orbits
    size = np.abs(full[:, :3]).max()
    assert size > 5e-6
    for rows in (slice(0, 3), slice(-5, -2)):
        assert np.abs(reduced[:, rows] - full[:, rows]).max() < 1e-4 * size
    # Freedoms that move all nodes as a motion does, and back.
    q = jnp.arange(1.0, 1.0 + system.mass.shape[0])
    np.testing.assert_allclose(system.freedoms(system.motions @ q), q, rtol=1e-6)


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda r: craig_bampton(r, -1), "`modes` is -1"),
        (lambda r: craig_bampton(r, True), "`modes` is True"),
        (lambda r: craig_bampton(bj.rotor.Rotor(r.shaft), 2), "no supports"),
        (
            lambda r: craig_bampton(
                bj.rotor.Rotor(r.shaft, (), r.supports, rigid=True), 2
            ),
            "is rigid",
        ),
        (
            lambda r: vibrating_rotor(
                r,
                bj.rotor.Unbalance(1, 1e-5),
                scale=1e-5,
                reference_frequency=1e3,
                rotation=0.3,
            ),
            "with a `rotation` unbalance",
        ),
        (
            lambda r: vibrating_rotor(
                bj.rotor.Rotor(
                    r.shaft, (), bj.rotor.BearingSupport(0, BALLS, passage=True)
                ),
                bj.rotor.RotorLoads(),
                scale=1e-5,
                reference_frequency=1e3,
                speed=100.0,
            ),
            "rolling elements that orbit",
        ),
    ],
)
def test_bad_input(change, message):
    with pytest.raises((TypeError, ValueError), match=message):
        change(stepped())

"""The peak of a response, and its derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from vibrations import duffing

from bearingjax.numerics import SolveError
from bearingjax.rotor.nonlinear import HarmonicBalance, Shooting, Steps, follow, peak

METHODS = {
    "balance": (HarmonicBalance(5, 24, steps=16), 1e-6),
    "shooting": (Shooting(24), 1e-5),
}
STEPS = Steps(first=0.05, largest=0.3)


@pytest.mark.parametrize(
    "name", ["balance", pytest.param("shooting", marks=pytest.mark.slow)]
)
def test_peak_of_a_hardening_oscillator(name):
    method, goal = METHODS[name]
    point = jnp.array([0.05, 0.1, 0.05])

    def measures(numbers):
        orbit = peak(duffing(*numbers), branch, 0, method)
        return jnp.stack([orbit.amplitude[0], orbit.frequency])

    branch = follow(duffing(*point), 0.8, 1.3, method, steps=STEPS, locate=False)
    found = np.asarray(measures(point))
    # Nothing on a finer branch is larger, and little is missing.
    fine = follow(
        duffing(*point), 0.8, 1.3, method, steps=Steps(largest=0.02), locate=False
    )
    top = fine.amplitude[:, 0].max()
    assert branch.amplitude[:, 0].max() < top <= found[0] < 1.0001 * top
    slopes = np.asarray(jax.jacfwd(measures)(point))
    best = np.full((2, 3), np.inf)
    for size in (1e-2, 1e-3):
        for k, step in enumerate(size * np.diag(np.asarray(point))):
            a, b, c, d = (
                np.asarray(measures(point + j * step)) for j in (-2, -1, 1, 2)
            )
            apart = (a - 8 * b + 8 * c - d) / (12 * step[k]) - slopes[:, k]
            best[:, k] = np.minimum(best[:, k], np.abs(apart))
    assert (best < goal * np.abs(slopes).max(axis=1, keepdims=True)).all()


def test_peak_of_a_linear_oscillator():
    """At ω² = 1 - 2 ζ², 1/(2 ζ sqrt(1 - ζ²)) of the static displacement."""
    method, z = METHODS["balance"][0], 0.1
    system = duffing(*jnp.array([0.0, 0.3, z]))
    branch = follow(system, 0.8, 1.3, method, steps=STEPS, locate=False)
    orbit = peak(system, branch, 0, method)
    assert np.isclose(orbit.frequency, np.sqrt(1.0 - 2.0 * z**2), rtol=1e-9)
    assert np.isclose(orbit.amplitude[0], 0.15 / (z * np.sqrt(1.0 - z**2)), rtol=1e-9)
    with pytest.raises(ValueError, match="follow the branch further"):
        peak(system, branch, 0, method, between=(1.05, 1.2))
    # A branch that has stepped over the peak says so, one of small steps finds it.
    z = 1e-4
    system = duffing(*jnp.array([0.0, 2.0 * z, z]))
    branch = follow(system, 0.9, 1.1, method, steps=STEPS, locate=False)
    assert branch.amplitude.max() < 0.01
    with pytest.raises(SolveError, match="points of the branch are too far apart"):
        peak(system, branch, 0, method)
    fine = Steps(first=1e-4, largest=0.1)
    branch = follow(system, 0.999, 1.001, method, steps=fine, locate=False)
    orbit = peak(system, branch, 0, method)
    assert np.isclose(orbit.frequency, np.sqrt(1.0 - 2.0 * z**2), rtol=1e-9)
    assert np.isclose(orbit.amplitude[0], 1.0 / np.sqrt(1.0 - z**2), rtol=1e-9)

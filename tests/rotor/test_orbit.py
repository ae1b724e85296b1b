"""Periodic orbits by shooting and by harmonic balance: each other, exact answers."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import mathieu_a, mathieu_b
from slopes import with_slopes
from tolerances import DIFFERENCE, ROUNDING, SOLVER
from vibrations import Contact, Spring, duffing, oscillator, rotor

import bearingjax as bj
from bearingjax.numerics.lapack import eigvals, solve_any
from bearingjax.rotor.nonlinear import (
    HarmonicBalance,
    Shooting,
    VibratingSystem,
    solve_orbit,
)
from bearingjax.rotor.nonlinear.flow import (
    flow_slopes,
    integrate,
    transition,
    transition_phases,
)
from bearingjax.rotor.nonlinear.harmonic_balance import interpolation

BALANCE, SHOOTING = HarmonicBalance(9, 48, steps=32), Shooting(48)
METHODS = {"balance": BALANCE, "shooting": SHOOTING}


@eqx.filter_jit
def of_hill(method, system, z, ratio):
    """Floquet multipliers by Hill's method, independent of the integration.

    A small change e^(λφ) p(φ) of the orbit, p periodic: with p a Fourier series like
    the orbit, λ is an eigenvalue of a quadratic problem of the harmonic balance. Of its
    2n(2H + 1) values only 2n are exponents, the others repeat them shifted by ik: those
    of least imaginary part are least spoilt by the harmonics left out.

    Source: Hill (1886); Lazarus & Thomas, C. R. Mecanique 338 (2010) 510.
    """
    at = method._basis(z.dtype)
    _, (*parts, _) = method.slopes(system, z, ratio)
    _, damping, inertia = parts
    still = method.project(parts, (at.value, at.rate, at.second))
    first = method.project((damping, inertia), (at.value, 2.0 * at.rate))
    square = method.project((inertia,), (at.value,))
    unit = jnp.eye(z.size, dtype=z.dtype)
    below = -solve_any(square, jnp.concatenate([still, first], 1))
    above = jnp.concatenate([jnp.zeros_like(unit), unit], 1)
    exponents = eigvals(jnp.concatenate([above, below], 0))
    order = jnp.argsort(jnp.abs(exponents.imag))[: 2 * system.scale.shape[0]]
    return jnp.exp(2.0 * jnp.pi * exponents[order])


def test_both_methods_find_the_same_orbit():
    system = duffing()
    one, two = (solve_orbit(system, 0.9, method) for method in (BALANCE, SHOOTING))
    assert np.allclose(one.displacement, two.displacement, atol=1e-6)
    assert np.allclose(one.velocity, two.velocity, atol=1e-6)
    assert np.isclose(one.amplitude[0], two.amplitude[0], rtol=1e-7)
    assert max(one.residual, two.residual) < 1e-10
    # Independently: nothing changes after a period.
    rest = solve_ivp(
        lambda t, y: [
            y[1],
            0.2 * np.cos(0.9 * t) - 0.1 * y[1] - y[0] - 0.05 * y[0] ** 3,
        ],
        (0.0, 2.0 * np.pi / 0.9),
        [two.displacement[0, 0], two.velocity[0, 0]],
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    )
    assert np.allclose(rest.y[:, -1], rest.y[:, 0], atol=SOLVER)
    # Where one ends the other may begin.
    assert solve_orbit(system, 0.9, BALANCE, two.displacement).steps <= 1


@pytest.mark.parametrize("frequency", (0.5, 1.1))
def test_multipliers_by_three_ways(frequency):
    system = duffing()
    orbits = [solve_orbit(system, frequency, method) for method in METHODS.values()]
    hill = of_hill(BALANCE, system, orbits[0].unknowns, jnp.asarray(frequency))
    first, second, third = (
        np.sort_complex(np.asarray(x))
        for x in (orbits[0].multipliers, orbits[1].multipliers, hill)
    )
    assert np.allclose(first, second, atol=DIFFERENCE)
    assert np.allclose(first, third, atol=DIFFERENCE)
    # Liouville: the product is exp(-trace of the damping over a period).
    assert np.isclose(np.prod(first), np.exp(-0.1 * 2 * np.pi / frequency), rtol=1e-8)


def test_without_damping_the_flow_keeps_volume():
    """Of the rotor: gyroscopic, five freedoms, off its resonance."""
    system = rotor(36, damping_ratio=0.0, base_acceleration=2.0)
    ratio = jnp.asarray(0.8)
    orbit = solve_orbit(system, ratio * system.reference_frequency, SHOOTING)
    multipliers = np.asarray(orbit.multipliers)
    assert (np.diff(np.abs(multipliers)) <= 0).all()
    assert np.isclose(np.prod(multipliers), 1.0, rtol=DIFFERENCE)
    inverse = np.sort_complex(np.round(1.0 / multipliers, 6))
    assert np.allclose(np.sort_complex(np.round(multipliers, 6)), inverse, atol=1e-5)
    assert orbit.stable
    # The Jacobian of the flow is that of small changes along the orbit.
    balance = HarmonicBalance(5, 24, steps=48)
    other = solve_orbit(system, orbit.frequency, balance, orbit.displacement)
    apart = np.abs(np.asarray(other.multipliers)[:, None] - multipliers[None])
    assert apart.min(axis=0).max() < DIFFERENCE and apart.min(axis=1).max() < DIFFERENCE


def test_mathieu():
    """Boundaries of stability: multipliers ±1 at the characteristic numbers."""

    @jax.jit
    def trace(stiffness, varying):
        system = oscillator(Spring(jnp.asarray(0.0), varying / stiffness))
        # y'' + (a - 2 q cos 2τ) y = 0 with φ = 2τ: frequency² 4/a.
        ratio = 2.0 / jnp.sqrt(stiffness)
        none = jnp.zeros(2)
        _, jacobian, _ = SHOOTING.linearise(system, none, ratio)
        return jnp.trace(SHOOTING.monodromy(system, ratio, jacobian, ()))

    for q in (0.5, 2.0):
        for order, goal in ((0, 2.0), (1, -2.0), (2, 2.0)):
            numbers = [mathieu_a(order, q)] + [mathieu_b(order, q)] * (order > 0)
            for number in numbers:
                if number > 0:
                    found = trace(jnp.asarray(number), jnp.asarray(-2.0 * q))
                    assert np.isclose(found, goal, atol=DIFFERENCE)


@pytest.mark.parametrize("order", ("closed", "open"))
def test_order_of_the_flow(order):
    system = oscillator(Contact(), 0.3, 0.02)
    start = jnp.array([0.3 if order == "closed" else 1.5, 0.0])
    numbers = (12, 24) if order == "closed" else (24, 192)

    def after_a_period(steps):
        return Shooting(steps).residual(system, start, jnp.asarray(1.0))

    coarse, fine = (
        float(jnp.max(jnp.abs(after_a_period(2 * n) - after_a_period(n))))
        for n in numbers
    )
    found = np.log(coarse / fine) / np.log(numbers[1] / numbers[0])
    # 9; with a kink 2.5, but for where in a step it falls.
    assert found > 7.0 if order == "closed" else found > 1.5


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.slow
def test_gradients_against_differences(name):
    method, goal = METHODS[name], {"balance": 1e-6, "shooting": 1e-5}[name]

    def measures(numbers):
        cubic, force, ratio, frequency = numbers
        spring = Spring(cubic, jnp.zeros_like(cubic))
        system = oscillator(spring, force, ratio)
        orbit = solve_orbit(system, frequency, method, throw=False)
        size = jnp.abs(orbit.multipliers)
        return jnp.stack([orbit.amplitude[0], orbit.multipliers[0].real, size[0]])

    point = jnp.array([0.05, 0.2, 0.05, 0.85])
    # Backward through the flow, forward through the balance.
    run = with_slopes(measures, jax.jacfwd if name == "balance" else jax.jacrev)
    exact = np.asarray(run(point)[0])
    best = np.full((3, 4), np.inf)
    for size in (1e-3, 1e-4, 1e-5):
        steps = size * np.diag(np.asarray(point))
        for k, step in enumerate(steps):
            points = [run(point + j * step)[1] for j in (-2, -1, 1, 2)]
            a, b, c, d = map(np.asarray, points)
            slope = (a - 8 * b + 8 * c - d) / (12 * step[k])
            best[:, k] = np.minimum(best[:, k], np.abs(slope - exact[:, k]))
    assert (best < goal * np.abs(exact).max(axis=1, keepdims=True)).all()


def test_harmonic_balance_jacobian():
    system, z = rotor(36, base_acceleration=5.0), 0.3 * jnp.sin(jnp.arange(25.0))
    balance, ratio = HarmonicBalance(2, 12), jnp.asarray(0.9)
    left, jacobian, _ = eqx.filter_jit(balance.linearise)(system, z, ratio)

    @jax.jit
    def change(step):
        return balance.residual(system, z + step[:-1], ratio + step[-1])

    exact = jax.jacfwd(change)(jnp.zeros(26))
    assert np.abs(jacobian - exact).max() < ROUNDING * np.abs(exact).max()
    assert np.allclose(left, change(jnp.zeros(26)), rtol=ROUNDING)


def test_slopes_of_the_flow():
    """By the start and by the frequency, against derivatives of the integration."""
    system, start = duffing(), jnp.asarray([0.3, -0.2])

    @jax.jit
    def both(x):
        def end(x):
            return integrate(system, x[:-1], x[-1], 24)[0]

        return flow_slopes(system, x[:-1], x[-1], 24), (end(x), jax.jacfwd(end)(x))

    found, wanted = both(jnp.append(start, 0.9))
    for one, other in zip(found, wanted, strict=True):
        np.testing.assert_allclose(one, other, rtol=SOLVER, atol=SOLVER)


def test_solve_orbit_reports_failure_and_invalid_arguments():
    system = duffing(force=jnp.nan)
    with pytest.raises(bj.SolveError, match="0.9 rad/s.*non_finite"):
        solve_orbit(system, 0.9, BALANCE)
    orbit = solve_orbit(system, 0.9, BALANCE, throw=False)
    assert orbit.result == bj.Result.NON_FINITE and not orbit.stable
    with pytest.raises(ValueError, match="`mass` has the shape"):
        VibratingSystem(
            np.eye(2), np.eye(1), np.eye(1), Contact(), Contact(), np.ones(1), 1.0
        )
    with pytest.raises(ValueError, match="7 harmonics need more than 14"):
        HarmonicBalance(7, 14)


def test_a_fast_mode_does_not_spoil_the_multipliers():
    """Small changes beside a vibration of 50 per period, with 24 steps: exact."""

    @partial(jax.jit, static_argnums=(0, 1))
    def over_a_period(matrix_at, steps):
        return transition(jax.vmap(jax.vmap(matrix_at))(transition_phases(steps)))

    fast = 50.25
    turn = jnp.asarray(np.array([[0.0, fast], [-fast, 0.0]]))
    found = over_a_period(lambda phase: turn, 24)
    assert np.allclose(found, [[0.0, 1.0], [-1.0, 0.0]], atol=SOLVER)

    # Of one that varies the error falls with the sixth power of the step.
    def varying(phase):
        return jnp.stack(
            [jnp.stack([0.0 * phase, 1.0 + 0.0 * phase]),
             jnp.stack([-1.2 - 0.6 * jnp.cos(phase), -0.1 + 0.0 * phase])]
        )  # fmt: skip

    coarse, fine, finest = (np.asarray(over_a_period(varying, n)) for n in (12, 24, 96))
    before, after = (np.abs(one - finest).max() for one in (coarse, fine))
    assert 40.0 < before / after < 90.0


@pytest.mark.parametrize("samples", [9, 12])
def test_interpolation_of_a_short_series(samples):
    def series(phase):
        return 0.3 + np.cos(phase) - 2.0 * np.sin(3.0 * phase) + np.cos(4.0 * phase)

    phase = transition_phases(7)
    even = series(2.0 * np.pi * np.arange(samples) / samples)
    found = interpolation(phase, samples) @ even
    assert np.allclose(found, series(phase), atol=ROUNDING)

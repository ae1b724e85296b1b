"""Whirl modes and Campbell diagrams.

Published ones, of Friswell et al. and of ROSS, are the validation cases
`friswell_campbell` and `friswell_damped`.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from machines import friswell, paper, stepped
from slopes import with_slopes
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.rotor import AbstractSupport

TURN = 2 * np.pi


def test_whirl_at_rest_turning_and_turning_back():
    found = bj.rotor.campbell(friswell(), [0.0, 150.0, 300.0], count=6)
    assert (found.whirl[0] == 0).all()  # at rest each mode is in a plane
    np.testing.assert_array_equal(found.whirl[1:, :5], [[-1, 1, -1, 1, -1]] * 2)
    assert abs(found.damping_ratio).max() < SOLVER
    # Turning the other way it is its mirror image: forward is with the speed.
    other = bj.rotor.campbell(friswell(), [0.0, -150.0, -300.0], count=6)
    np.testing.assert_allclose(other.frequency, found.frequency, rtol=SOLVER)
    np.testing.assert_array_equal(other.whirl, found.whirl)
    # Largest motion 1 m, and real.
    sizes = abs(np.asarray(found.shape) * [1, 1, 1, 1.5, 1.5])
    np.testing.assert_allclose(sizes.max(axis=(2, 3)), 1.0, rtol=SOLVER)


@pytest.mark.parametrize("across", [0.0, -1e3], ids=["coincident", "equal_frequency"])
def test_order_of_equal_frequencies_does_not_hang_on_round_off(across):
    """At rest forward and backward whirl have one frequency, and with stiffness from
    one direction to the other opposite growth. The slower, or more damped, is first."""

    def turned(sign):
        stiffness = np.diag([1e6, 1e6, 0.0, 0.0, 0.0])
        stiffness[0, 1], stiffness[1, 0] = across, -across
        noise = np.random.default_rng(2).normal(size=(5, 5))
        stiffness += sign * 1e-14 * 1e6 * noise
        rotor = eqx.tree_at(
            lambda r: [s.stiffness for s in r.supports],
            friswell(),
            [jnp.asarray(stiffness)] * 2,
        )
        return bj.rotor.campbell(rotor, [0.0, 150.0, 300.0], count=6)

    exact, *others = map(turned, (0.0, -1.0, 1.0, -2.0, 2.0, 5.0))
    whirl = np.tile([-1, 1], 3) if not across else np.tile([1, -1], 3)
    np.testing.assert_array_equal(exact.whirl[1:], [whirl] * 2)
    for found in others:
        np.testing.assert_allclose(
            found.eigenvalue,
            exact.eigenvalue,
            rtol=SOLVER,
            atol=SOLVER * float(abs(exact.eigenvalue).max()),
        )
        np.testing.assert_array_equal(found.whirl[1:], exact.whirl[1:])


def test_measures_of_damping():
    # Isotropic bearings with damping, at rest: pairs of equal modes.
    damped = bj.rotor.modes(friswell(1e6, 1e6, 3e3), count=6)
    natural = np.abs(damped.eigenvalue) / TURN
    ratio = damped.damping_ratio
    exact = np.sqrt(1 - (damped.frequency / natural) ** 2)
    np.testing.assert_allclose(ratio, exact, rtol=DIFFERENCE)
    decrement = TURN * ratio / np.sqrt(1 - ratio**2)
    np.testing.assert_allclose(damped.log_decrement, decrement, rtol=SOLVER)
    assert (damped.whirl == 0).all()


def test_a_disc_on_a_massless_shaft():
    """Stodola's rotor: a disc at the end of a cantilever, with gyroscopic moments.

    With z = ux + i uy and the slope s = gy - i gx: (K - ω² diag(m, Id) + ωΩ
    diag(0, Ip)) (z, s) = 0, forward whirl for ω > 0.
    """
    length, outer, m, polar, diametral, speed = 0.4, 0.03, 8.0, 0.09, 0.05, 900.0
    radial, tilt = 2e8, 5e6
    light = bj.Material(211e9, 0.3, 0.1)
    shaft = bj.rotor.Shaft([0.0, length], outer, material=light, divisions=2)
    support = bj.rotor.LinearSupport.isotropic(0, radial, 1e8, tilt)
    rotor = bj.rotor.Rotor(shaft, [bj.rotor.Disc(1, m, polar, diametral)], [support])
    ei = 211e9 * np.pi / 64 * outer**4
    kga = 6 * 1.3 / (7 + 6 * 0.3) * 211e9 / 2.6 * np.pi / 4 * outer**2
    softness = np.array(
        [
            [
                length**3 / 3 / ei + length / kga + 1 / radial + length**2 / tilt,
                length**2 / 2 / ei + length / tilt,
            ],
            [length**2 / 2 / ei + length / tilt, length / ei + 1 / tilt],
        ]
    )
    k = np.linalg.inv(softness)
    inertia, turning = np.diag([m, diametral]), np.diag([0.0, polar])
    zero, one = np.zeros((2, 2)), np.eye(2)
    state = np.block(
        [
            [zero, one],
            [np.linalg.solve(inertia, k), speed * np.linalg.solve(inertia, turning)],
        ]
    )
    exact = np.linalg.eigvals(state).real
    exact = exact[np.argsort(abs(exact))]
    found = bj.rotor.modes(rotor, speed, count=6)
    got = TURN * np.asarray(found.frequency) * np.asarray(found.whirl)
    got = got[got != 0][:4]
    # The shaft has some millionths of the disc's mass.
    np.testing.assert_allclose(got, exact, rtol=DIFFERENCE)
    # Forward critical speed: the disc's inertia is Id - Ip < 0, there is only one.
    squares = np.linalg.eigvals(np.linalg.solve(np.diag([m, diametral - polar]), k))
    critical = bj.rotor.critical_speeds(rotor, count=4)
    forward = np.asarray(critical.speed)[np.asarray(critical.whirl) == 1]
    np.testing.assert_allclose(forward, np.sqrt(max(squares)), rtol=DIFFERENCE)
    assert min(squares) < 0


def test_modes_are_followed_through_crossings():
    """Isotropic supports: forward, backward and axial modes never mix."""
    speeds = np.linspace(0.0, 8000.0, 25)
    rotor = paper(1.1592e8, 1.2238e8)
    found = bj.rotor.campbell(rotor, speeds, count=5)
    whirl = np.asarray(found.whirl)
    assert (whirl[1:] == whirl[-1]).all()
    assert sorted(whirl[-1]) == [-1, -1, 0, 1, 1]
    change = np.diff(np.asarray(found.frequency), axis=0)
    assert (change[:, whirl[-1] == 1] > 0).all()
    assert (change[:, whirl[-1] == -1] < 0).all()
    assert abs(change[:, whirl[-1] == 0]).max() < SOLVER * found.frequency.max()
    # They do cross: sorted by frequency the whirl would not stay.
    order = np.argsort(found.frequency, axis=1)
    assert (order != order[0]).any()


def veering():
    """Unequal supports and gyroscopic discs: lines cross, and some part again."""
    rotor = bj.rotor.Rotor(
        bj.rotor.Shaft([0.0, 0.15, 0.3, 0.5], 0.035),
        [bj.rotor.Disc(1, 6.0, 0.1, 0.06), bj.rotor.Disc(3, 3.0, 0.05, 0.03)],
        [
            bj.rotor.LinearSupport(0, [9e7, 2.4e7, 1e7, 0, 0], [420, 420, 0, 0, 0]),
            bj.rotor.LinearSupport(2, [18e7, 2.4e7, 0, 0, 0], [420, 420, 0, 0, 0]),
        ],
    )
    return rotor


def test_campbell_lines_independent_of_speed_count():
    """Against modes followed with NumPy in small steps."""
    rotor, top = veering(), 6283.0

    def values(speed) -> Any:
        at = rotor.linearise(speed)
        n = at.mass.shape[0]
        lower = np.linalg.solve(at.mass, np.hstack([at.stiffness, at.rates]))
        state = np.block([[np.zeros((n, n)), np.eye(n)], [-lower]])
        found, vectors = np.linalg.eig(state)
        return found, np.linalg.inv(vectors), vectors

    value, left, _ = values(0.0)
    first = np.argsort(np.where(value.imag > 0, value.imag, np.inf))[:6]
    left = left[first]
    for speed in np.linspace(0.0, top, 1501)[1:]:
        value, rows, vectors = values(speed)
        now = np.abs(left @ vectors).argmax(axis=1)
        assert len(set(now)) == len(now)
        left = rows[now]
    exact = value[now].imag / TURN
    for count in (2, 6, 60):
        found = bj.rotor.campbell(rotor, np.linspace(0.0, top, count), count=6)
        np.testing.assert_allclose(found.frequency[-1], exact, rtol=DIFFERENCE)


@pytest.mark.parametrize("cause", ("stiffness", "damping"))
def test_modes_warns_of_unstable_mode_and_cause(cause):
    """Two masses, each on k: with k', -k' across the ratio is -k'/2k, with dampers c
    across it is -c/2√(km)."""
    k, mass, share = 1e7, 4.0, 8e-6
    stiffness, damping = k * np.eye(5), np.zeros((5, 5))
    if cause == "stiffness":
        stiffness[0, 1], stiffness[1, 0] = -share * k, share * k
    else:
        damping[0, 1] = damping[1, 0] = share * np.sqrt(k * mass)
    ends = [bj.rotor.PointMass(n, mass) for n in (0, 1)]
    supports = [bj.rotor.LinearSupport(n, stiffness, damping) for n in (0, 1)]
    rotor = bj.rotor.Rotor(bj.rotor.Shaft([0.0, 1.0], 1e-4), ends, supports, rigid=True)
    found = bj.rotor.modes(rotor)
    (text,) = found.warnings
    assert "unstable at 0 rad/s (0 rpm)" in text and text.size > text.limit
    assert jax.jit(lambda r: jnp.asarray(len(bj.rotor.modes(r).warnings)))(rotor) == 0
    assert ("unsymmetric part" in text) == (cause == "stiffness")
    assert "damping ratio is -4e-06" in text
    ratio = np.asarray(found.damping_ratio).min()
    np.testing.assert_allclose(ratio, -0.5 * share, rtol=1e-4)


class _Stop(AbstractSupport):
    """A spring that becomes ten thousand times as stiff at a speed."""

    station: int = eqx.field(static=True)
    housing: None = None

    def force(self, motion, velocity, speed, angle=0.0):
        return jnp.where(speed > 500.0, 1e9, 1e5) * motion


def test_a_campbell_diagram_says_where_modes_are_not_followed():
    rotor = bj.rotor.Rotor(bj.rotor.Shaft([0.0, 0.2, 0.5], 0.03), [], _Stop(0))
    found = bj.rotor.campbell(rotor, np.linspace(0.0, 1000.0, 6), count=4)
    (told,) = found.warnings
    assert "between 400 and 600 rad/s" in told and told.size < told.limit


@pytest.mark.parametrize("turn", [0.0, 0.4, np.pi / 4, 1.2, -0.7])
@pytest.mark.parametrize("aside", [0.0, 0.2, -0.5, 1.0])
def test_major_axis_of_inclined_orbit(turn, aside):
    """Half axes 1 and `aside`, turned by `turn`: as far as the orbit goes from its
    middle, whatever its direction and sense."""
    begun = np.exp(0.3j)
    x = begun * (np.cos(turn) - 1j * aside * np.sin(turn))
    y = begun * (np.sin(turn) + 1j * aside * np.cos(turn))
    assert bj.rotor.major_axis(x, y) == pytest.approx(1.0, rel=ROUNDING)
    phase = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 20001))
    far = np.hypot((x * phase).real, (y * phase).real).max()
    assert far == pytest.approx(bj.rotor.major_axis(x, y), rel=1e-7)
    both = bj.rotor.major_axis(jnp.asarray([x, 2.0 * x]), jnp.asarray([y, 2.0 * y]))
    assert np.allclose(both, [1.0, 2.0], rtol=ROUNDING)


# Numbers of `stepped`, and what they are counted in.
NUMBERS = jnp.array([0.01, 0.17, 2e7, 300.0, 0.02, 5e7])


def measured(numbers):
    """Frequencies, damping ratios, critical speeds and their damping, amplitudes."""
    rotor = stepped(*numbers)
    modes = bj.rotor.modes(rotor, 700.0, count=5)
    critical = bj.rotor.critical_speeds(rotor, count=4)
    response = bj.rotor.unbalance_response(
        rotor, bj.rotor.Unbalance(1, 1e-3), jnp.array([300.0, 900.0])
    )
    return jnp.concatenate(
        [
            modes.frequency,
            modes.damping_ratio,
            critical.speed,
            critical.damping_ratio,
            response.amplitude[:, 3, :2].reshape(-1),
            response.major_axis[:, 3],
        ]
    )


@pytest.mark.slow
def test_modes_gradients_match_differences():
    run = with_slopes(measured)
    slope, values = run(NUMBERS)
    assert np.isfinite(slope).all()
    scale = NUMBERS[None, :] / values[:, None]
    for k, number in enumerate(NUMBERS):
        step = 2e-4 * number * np.eye(len(NUMBERS))[k]
        # Of fourth order: steps that are large against the round-off of eigenvalues.
        near, far = (
            run(NUMBERS + n * step)[1] - run(NUMBERS - n * step)[1] for n in (1, 2)
        )
        change = (8 * near - far) / 12 / (2e-4 * values)
        np.testing.assert_allclose(slope[:, k] * scale[:, k], change, atol=DIFFERENCE)


def test_derivatives_where_modes_coincide():
    """Isotropic and at rest: pairs that stay pairs as the supports stiffen. Nor does a
    critical speed that is not there spoil the others."""

    def speeds(stiffness):
        rotor = paper(stiffness, 1e8, bj.rotor.ModalDamping(0.01))
        return bj.rotor.modes(rotor).frequency, bj.rotor.critical_speeds(
            rotor, count=5
        ).speed

    at = jnp.array(1.2e8)
    slopes, values = with_slopes(speeds)(at)
    for value, slope in zip(values, slopes, strict=True):
        there = np.isfinite(value)
        value, slope = np.asarray(value)[there], np.asarray(slope)[there]
        # Radial ones of the rigid rotor go with the root of the stiffness.
        expected = np.array(0.5 * value / 1.2e8)
        expected[np.argmin(abs(slope))] = 0.0
        np.testing.assert_allclose(slope, expected, rtol=DIFFERENCE, atol=1e-16)


def test_modes_of_unsupported_rotor():
    rotor = friswell(0.0, 0.0)
    found = bj.rotor.modes(rotor, 100.0)
    n = len(found.frequency)
    assert n == 35 and np.isfinite(found.shape).all()
    assert np.isfinite(found.damping_ratio).all()
    # Free in x, y and z; its tilts precess: backward at 0, forward with Ip/Id.
    frequency = np.asarray(found.frequency)
    assert ((frequency == 0).sum(), (frequency > 0).sum()) == (4, 31)
    slope = jax.grad(lambda k: bj.rotor.modes(friswell(k, k), 100.0).frequency.sum())(
        0.0
    )
    assert np.isfinite(slope)


@pytest.mark.parametrize(
    "call, error, shown",
    [
        (lambda r: bj.rotor.modes(r, np.nan), ValueError, "modes: `speed`.*finite"),
        (lambda r: bj.rotor.modes(r, count=0), ValueError, "modes: `count` is 0"),
        (
            lambda r: bj.rotor.campbell(r, 3.0),
            ValueError,
            r"campbell: `speeds` has shape \(\)",
        ),
        (lambda r: bj.rotor.campbell(r, [0.0, np.inf]), ValueError, "`speeds`.*finite"),
        (lambda r: bj.rotor.critical_speeds(r, count=1.5), TypeError, "`count` is 1.5"),
        (
            lambda r: bj.rotor.unbalance_response(
                r, [bj.rotor.Unbalance(9, 1.0)], [1.0]
            ),
            ValueError,
            "station 9; the last station of the shaft is 2",
        ),
        (
            lambda r: bj.rotor.unbalance_response(r, [3.0], [1.0]),
            TypeError,
            "holds a float",
        ),
        (lambda r: bj.rotor.Unbalance(0, -1.0), ValueError, "`moment` is -1 kg m"),
    ],
)
def test_bad_input_is_named(call, error, shown):
    with pytest.raises(error, match=shown):
        call(paper(1e8, 1e8))


class Whirling(AbstractSupport):
    """Pushes along the whirl, in proportion to the speed; and damps."""

    station: int = eqx.field(static=True)
    across: Any
    constant: Any
    damping: Any
    housing: None = None

    def force(self, motion, velocity, speed, angle=0.0):
        x, y, z, *_ = motion
        push = self.across * speed + self.constant
        pushed = jnp.stack([push * y, -push * x, 0 * z, 0 * z, 0 * z])
        return 1e6 * motion + self.damping * velocity + pushed


def test_the_onset_of_instability():
    """A push κΩ across: λ = iω where κΩ = cω. Signs of c and κ as they come."""
    shaft = bj.rotor.Shaft([-0.1, 0.0, 0.1], 0.04)
    speeds = np.linspace(0.0, 600.0, 4)

    def onsets(across, constant, damping):
        support = Whirling(1, *map(jnp.asarray, (across, constant, damping)))
        rotor = bj.rotor.Rotor(
            shaft, [bj.rotor.PointMass(1, 5.0)], [support], rigid=True
        )
        found = bj.rotor.campbell(rotor, speeds, count=3)
        return bj.rotor.instability_onsets(rotor, speeds, found), float(rotor.mass)

    (found,), mass = onsets(50.0, 0.0, 40.0)
    natural = np.sqrt(1e6 / mass)
    np.testing.assert_allclose(found.speed, 0.8 * natural, rtol=DIFFERENCE)
    np.testing.assert_allclose(TURN * found.frequency, natural, rtol=DIFFERENCE)
    # A damping ratio of -1e-6 is the noise of a tangent; one of -1e-3 is there at rest.
    assert not onsets(0.0, 2.0, 0.0)[0]
    (found,), _ = onsets(0.0, 2e3, 0.0)
    assert found.speed == 0.0

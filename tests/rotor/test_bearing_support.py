"""A bearing of the library as a support, against the published rotor's bearings."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from machines import bearing
from published import inputs
from scipy.optimize import brentq
from tolerances import DIFFERENCE, ROUNDING, SOLVER
from vibrations import OUTER, grooves

import bearingjax as bj
from bearingjax.rotor import BearingSupport

_ANGLES = np.degrees(inputs("filipkovskii_preload", "bearing.contact_angle"))
_PRELOADS = inputs("filipkovskii_preload", "operating.load.Fz")
PAPER = {angle: (_ANGLES[k].round(3), _PRELOADS[k]) for angle, k in ((12, 0), (26, 2))}
"""Free angle [deg] and preload [N] by the angle under preload [deg]."""


@jax.jit
def held(support, motion, speed):
    """Force and stiffness of a support."""
    rest = jnp.zeros(5)
    return support.force(motion, rest, speed), support.linearise(motion, speed)[0]


def preloaded(angle, **choices):
    """A support whose bearing is pressed with P0."""
    free, preload = PAPER[angle]
    element = bj.BearingElement(bearing(free, OUTER[angle]))
    loose = BearingSupport(0, element, **choices)
    sign = -1.0 if loose.turned else 1.0

    def left(uz):
        pushed = jnp.zeros(5).at[2].set(sign * uz)
        return sign * float(held(loose, pushed, 0.0)[0][2]) - preload

    uz = brentq(left, 1e-6, 1e-4, xtol=1e-14)
    return BearingSupport(0, element, [0, 0, uz, 0, 0], **choices)


@pytest.mark.parametrize("angle", PAPER)
def test_stiffness_of_the_published_bearings(angle):
    """That of a contact angle that follows the motion of the groove centres.

    Curvatures are taken at another angle than there, 0.1 % of the constants."""
    law = grooves(angle).moving_angle().stiffness()
    force, stiffness = held(preloaded(angle), jnp.zeros(5), 0.0)
    np.testing.assert_allclose(force[2], PAPER[angle][1], rtol=1e-8)
    np.testing.assert_allclose(stiffness[2, 2], law[2, 2], rtol=5e-3)
    across = np.diagonal(stiffness)[:2]
    np.testing.assert_allclose(across, law[0, 0], rtol=5e-3)
    np.testing.assert_allclose(across[0], across[1], rtol=ROUNDING)


def test_bearing_support_turned():
    """The same bearing looks the other way: a half turn about x of motion and force."""
    plain, turned = (preloaded(12, turned=t) for t in (False, True))
    motion = jnp.array([3e-6, -2e-6, 1e-6, 2e-5, -1e-5])
    half = np.array([1.0, -1.0, -1.0, 1.0, -1.0])
    force, stiffness = held(plain, motion, 0.0)
    other, seen = held(turned, half * motion, 0.0)
    np.testing.assert_allclose(other, half * force, rtol=1e-9)
    np.testing.assert_allclose(seen, np.outer(half, half) * stiffness, rtol=1e-9)


def test_bearing_support_stiffness_and_damping():
    """The stiffness is that of differences; damping adds to force and linear part."""
    support = preloaded(12, damping=[10.0, 20.0, 30.0, 0.1, 0.2])
    motion = jnp.array([3e-6, -2e-6, 1e-6, 2e-5, -1e-5])
    stiffness, damping = support.linearise(motion, jnp.asarray(0.0))
    np.testing.assert_array_equal(damping, np.diag([10.0, 20.0, 30.0, 0.1, 0.2]))
    steps = 1e-9 * np.diag([1.0, 1.0, 1.0, 30.0, 30.0])
    ends = [
        np.stack([held(support, motion + s * step, 0.0)[0] for step in steps], axis=1)
        for s in (1.0, -1.0)
    ]
    found = (ends[0] - ends[1]) / (2.0 * np.diagonal(steps))[None, :]
    size = np.sqrt(np.outer(np.diagonal(stiffness), np.diagonal(stiffness)))
    np.testing.assert_allclose(found / size, stiffness / size, atol=DIFFERENCE)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.slow
def test_bearing_support_ball_passage(turned):
    """Balls orbit with the shaft; after a pitch they stand as at first."""
    support = preloaded(12, turned=turned, passage=True)
    motion = jnp.array([2e-5, -1e-5, 1e-6, 2e-5, -1e-5])
    pitch = 2.0 * np.pi / 7

    @jax.jit
    def forced(support, angle):
        return support.force(motion, jnp.zeros(5), jnp.asarray(0.0), angle)

    ratio = 0.5 * (1.0 - 11.51e-3 * np.cos(np.radians(6.852)) / 43.5125e-3)
    first, half, whole = (forced(support, k * pitch / ratio) for k in (0, 0.5, 1))
    np.testing.assert_allclose(whole, first, rtol=1e-8)
    assert np.abs(half - first).max() > 1e-3 * np.abs(first).max()
    # The same with the balls put there: seen from behind they go round the other way.
    sense = -1.0 if turned else 1.0
    put = eqx.tree_at(
        lambda s: s.element.bearing.first_azimuth, support, sense * 0.5 * pitch
    )
    np.testing.assert_allclose(forced(put, 0.0), half, rtol=1e-8)


def test_bearing_support_modes_match_linear_support():
    """A rotor takes it as it takes its springs."""
    supports = [preloaded(26), preloaded(26, turned=True)]
    supports[1] = BearingSupport(
        2, supports[1].element, supports[1].offset, turned=True
    )
    shaft = bj.rotor.Shaft(
        [0.0, 0.125, 0.5], 0.025, material=bj.Material(2.1e11, 0.3, 7850)
    )
    disc = bj.rotor.Disc(1, 10.0, 0.2, 0.1)
    springs = [
        bj.rotor.LinearSupport(s.station, held(s, jnp.zeros(5), 0.0)[1])
        for s in supports
    ]
    of_bearings, of_springs = (
        bj.rotor.modes(
            bj.rotor.Rotor(shaft, [disc], held_by, rigid=True), 0.0
        ).frequency
        for held_by in (supports, springs)
    )
    np.testing.assert_allclose(of_bearings, of_springs, rtol=1e-9)


@pytest.mark.parametrize(
    "make, error, message",
    [
        (lambda e: BearingSupport(0, "6210"), TypeError, "BearingElement"),
        (lambda e: BearingSupport(0, e, [0.0, 1.0]), ValueError, "`offset` has shape"),
        (lambda e: BearingSupport(0, e, [np.nan] * 5), ValueError, "finite"),
        (lambda e: BearingSupport(-1, e), ValueError, "station"),
        (lambda e: BearingSupport(0, e, damping=[1.0]), ValueError, "`damping`"),
        (lambda e: BearingSupport(0, e, turned=1), TypeError, "turned"),
    ],
)
def test_bad_input(make, error, message):
    element = bj.BearingElement(bearing(6.852, OUTER[12]))
    with pytest.raises(error, match=message):
        make(element)


@pytest.mark.parametrize("turned", [False, True])
def test_support_of_known_numbers_is_that_of_traced_ones(turned):
    """By the program of its kind, and as part of another."""
    bearing = bj.AngularContactBallBearing(
        7, 0.052, 0.0095, contact_angle=0.44, outer_osculation=0.53,
        inner_osculation=0.52,
    )  # fmt: skip
    offset = [0.0, 0.0, 2e-5, 0.0, 0.0]
    element = bj.BearingElement(bearing)
    support = BearingSupport(0, element, offset, turned=turned, inertia=True)
    motion = np.array([4e-6, -7e-6, 3e-6, 2e-4, -1e-4])
    speed = jnp.asarray(2500.0)
    found = support.respond_alone(motion, speed)
    wanted = jax.jit(lambda at: support.respond(at, speed))(jnp.asarray(motion))
    for a, b in zip(found, wanted, strict=True):
        b = np.asarray(b)
        np.testing.assert_allclose(a, b, 0, SOLVER * np.abs(b).max(initial=0.0))

"""The rotor of method 002: law of its bearings, expansion, natural frequencies."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from machines import paper
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk
from tolerances import DIFFERENCE, PUBLISHED, ROUNDING, SOLVER
from vibrations import OUTER, ROTOR, grooves, of_drawing, rotor

import bearingjax as bj
from bearingjax.rotor.nonlinear import (
    CubicExpansion,
    FixedAngle,
    HarmonicBalance,
    MovingAngle,
    OpposedPair,
    natural_frequencies,
    solve_orbit,
)

LAWS = {angle: grooves(angle).fixed_angle() for angle in OUTER}


@jax.jit
def described(law, mass, gyroscopic):
    stiffness = jax.hessian(OpposedPair(law, law).potential)(jnp.zeros(5))
    plane = np.array([0, 2])
    m, k = (x[plane][:, plane] for x in (mass, stiffness))
    skew = gyroscopic[plane][:, plane + 1]
    one = law.stiffness()
    return one, stiffness, natural_frequencies(mass, stiffness), (m, k, skew)


@pytest.mark.parametrize("angle", (12, 40))
def test_a_pair_of_bearings(angle):
    """The published table, and errors of the cubic expansion, are the validation cases
    `filipkovskii_bearing` and `filipkovskii_rotor`, the latter by the modes of a rotor
    in general."""
    law = LAWS[angle]
    one, both, natural, (m, k, skew) = described(law, ROTOR.mass(), ROTOR.gyroscopic())
    # K (M - G)⁻¹: unbalance turns with the rotor, and gyroscopic moments stiffen.
    critical = np.linalg.eigvals(np.linalg.solve(np.asarray(m - skew), np.asarray(k)))
    forward = np.sqrt(critical[critical > 0])
    general = paper(one[0, 0], one[2, 2])
    hertz = np.array([*natural.radial, *natural.radial, natural.axial]) / (2.0 * np.pi)
    modes = bj.rotor.modes(general).frequency
    assert np.allclose(np.sort(hertz), modes, rtol=DIFFERENCE)
    found = bj.rotor.critical_speeds(general, count=4)
    assert np.allclose(forward, found.speed[found.whirl == 1], rtol=DIFFERENCE)
    # The pair: nothing of even order is left, and twice the axial stiffness.
    assert np.isclose(both[4, 4], 2.0 * one[2, 2], rtol=ROUNDING)
    assert np.allclose(np.diag(both)[:4], one[0, 0], rtol=ROUNDING)
    assert np.abs(both - np.diag(np.diag(both))).max() < ROUNDING * one[0, 0]


def test_hertz_constant_is_the_printed_one():
    bearing = grooves(26)
    cosine, ball, groove = np.cos(np.radians(26)), 11.51e-3, 5.93e-3
    for k, (sign, radius) in enumerate(((1.0, 16e-3), (-1.0, 27.5399e-3))):
        along = 2 / ball + sign * cosine / (radius + sign * groove * (1 - cosine))
        across = 2 / ball - 1 / groove
        total, difference = along + across, (along - across) / (along + across)

        def apart(ratio, difference=difference):
            first, second = ellipk(1 - ratio**-2), ellipe(1 - ratio**-2)
            share = (ratio**2 + 1) * second - 2 * first
            return share / ((ratio**2 - 1) * second) - difference

        ratio: Any = brentq(apart, 1.5, 50.0, xtol=1e-14, rtol=1e-15)
        square = 1 - ratio**-2
        first, second = ellipk(square), ellipe(square)
        eta = (1 - 0.3**2) / (np.pi * 2.1e11)
        inner = 9 / 8 * (2 * eta) ** 2 * (1 - square) * total / second
        printed = first * inner ** (1 / 3)
        ours = float(bearing.raceway_constants()[k]) ** (-2 / 3)
        assert np.isclose(printed, ours, rtol=ROUNDING)


def test_the_cubic_expansion():
    law = LAWS[12]
    cubic, z0 = CubicExpansion.from_law(law), law.preload_displacement

    @jax.jit
    def orders(law):
        function = law.potential
        found = []
        for _ in range(4):
            function = jax.jacfwd(function)
            found.append(function(jnp.zeros(3)))
        return found

    for true, ours in zip(orders(law), orders(cubic), strict=True):
        assert np.abs(true - ours).max() < 1e-10 * np.abs(true).max()
    # As printed.
    x, y, z = 3e-6, -2e-6, 4e-6
    radial, tangent2 = cubic.radial_stiffness, np.tan(np.radians(12)) ** 2
    axial, square = 2 * radial * tangent2, x**2 + y**2
    common = (
        1 + z / (2 * z0) - square / (32 * z0**2 * tangent2) - z**2 / (8 * z0**2)
    ) * radial
    along = (
        law.preload() + axial * (z + z**2 / (4 * z0) - z**3 / (24 * z0**2))
        + radial * square * (1 / (4 * z0) - z / (8 * z0**2))
    )  # fmt: skip
    printed = [x * common, y * common, along]
    assert np.allclose(cubic.force(jnp.array([x, y, z])), printed, rtol=ROUNDING)


def test_angle_that_follows_stiffens_little_across():
    for angle in LAWS:
        moving = grooves(angle).moving_angle().stiffness()
        fixed = LAWS[angle].stiffness()
        assert 1.0 < moving[0, 0] / fixed[0, 0] < 1.011


def test_fixed_angle_derivatives_are_finite_at_lift_off():
    law, touching = LAWS[36], jnp.array([0.0, 0.0, -LAWS[36].preload_displacement])
    for motion in (touching, jnp.array([3e-5, 0.0, 0.0]), -jnp.ones(3)):
        slope = jax.hessian(law.potential)(motion)
        assert np.isfinite(law.force(motion)).all() and np.isfinite(slope).all()
    with pytest.raises(ValueError, match="n_balls"):
        CubicExpansion.from_law(FixedAngle(1e10, 0.4, 1e-5, 4))


def test_small_vibration_is_linear_and_axial_motion_of_second_order():
    method = HarmonicBalance(2, 8, steps=16)
    system = rotor(36, base_acceleration=1e-3)
    twice = rotor(36, base_acceleration=2e-3)
    near = float(system.reference_frequency) * np.array([0.996, 1.0, 1.004])
    one, two = solve_orbit(system, near[1], method), solve_orbit(twice, near[1], method)
    growth = np.asarray(two.amplitude / one.amplitude)
    # Cubic terms are a millionth of the linear ones here.
    assert np.allclose(growth[:4], 2.0, rtol=1e-5)
    assert np.isclose(growth[4], 4.0, rtol=1e-5)
    # Linear answer from the matrices; gyroscopic moments couple both planes.
    mass, w = np.asarray(system.mass), near[1]
    stiffness = np.asarray(jax.jacfwd(lambda q: system.force(q, q, w, w))(jnp.zeros(5)))
    damping = np.asarray(system.damping_matrix(jnp.asarray(w)))
    load = -1e-3 * mass @ np.array([0.0, 1.0, 0.0, 1.0, 0.0])
    linear = np.linalg.solve(stiffness - w**2 * mass + 1j * w * damping, load)
    assert np.allclose(one.amplitude[:4], np.abs(linear)[:4], rtol=DIFFERENCE)


@pytest.mark.parametrize("angle", LAWS)
def test_laws_of_bearing_from_design_and_preload(angle):
    """The bearing of the drawing, pushed with P0, gives the laws of the drawing.

    Its free angle follows from the radii, so the preloaded one is a result.
    """
    drawn = LAWS[angle]
    preload = float(drawn.preload())
    element = bj.BearingElement(of_drawing(angle))
    offset = bj.rotor.preload_offset(element, preload)
    law = FixedAngle.of_bearing(element, offset)
    assert np.isclose(law.preload(), preload, rtol=SOLVER)
    assert np.isclose(np.degrees(law.contact_angle), angle, rtol=PUBLISHED)
    for name in ("constant", "preload_displacement"):
        assert np.isclose(getattr(law, name), getattr(drawn, name), rtol=PUBLISHED)
    moving = MovingAngle.of_bearing(element, offset)
    assert np.isclose(moving.force(jnp.zeros(3))[2], preload, rtol=SOLVER)
    cubic = CubicExpansion.of_bearing(element, offset)
    assert cubic.radial_stiffness == CubicExpansion.from_law(law).radial_stiffness


def test_laws_of_bearing_reject_unloaded_and_roller_bearings():
    element = bj.BearingElement(of_drawing(12))
    with pytest.raises(ValueError, match="`offset` is -0.001 m; it must be so large"):
        FixedAngle.of_bearing(element, -1e-3)
    four = bj.load_bearing("cylindrical_rig")
    with pytest.raises(TypeError, match="CylindricalRollerBearing; it must hold one"):
        MovingAngle.of_bearing(bj.BearingElement(four), 1e-5)

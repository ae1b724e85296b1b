"""The oracle against closed forms and symmetries."""

import math

import numpy as np
import oracle
import pytest
from oracle import OracleBearing, evaluate, line_moments, midpoint_slices

C, HALF = 1.3e11, 7e-3


def _wedge(a, b):
    """Closed form of a straight contact loaded from s = -a/b to HALF, b > 0."""
    m = a + b * HALF
    p = [m ** (k + 1 / 9) / (k + 1 / 9) for k in range(1, 4)]
    force = C * 9 / 10 * 10 / 9 * p[1] / b
    moment = C * (p[2] - a * p[1]) / b**2
    energy = C * 9 / 19 * p[2] / b
    second = [p[0] / b, (p[1] - a * p[0]) / b**2]
    second.append((p[2] - 2 * a * p[1] + a * a * p[0]) / b**3)
    return energy, force, moment, C * 10 / 9 * np.array(second)


def _close(result, expected, rtol):
    scale = np.array([1.0, HALF, HALF**2])
    for i, tolerance in ((0, rtol), (1, rtol)):
        assert result[i] == pytest.approx(expected[i], rel=tolerance)
    assert result[2] == pytest.approx(expected[2], abs=rtol * expected[1] * HALF)
    limit = 10 * rtol * expected[3][0] * scale
    assert np.all(np.abs(result[3] - expected[3]) <= limit)


@pytest.mark.parametrize("a, b", [(2e-6, 1e-3), (-1e-6, 4e-4), (-6.9e-6, 1e-3)])
def test_partly_loaded_straight_contact_has_closed_form(a, b):
    energy, force, moment, second = _wedge(a, b)
    _close(line_moments(a, b, np.zeros_like, C, HALF), _wedge(a, b), 1e-13)
    mirrored = energy, force, -moment, second * [1, -1, 1]
    _close(line_moments(a, -b, np.zeros_like, C, HALF), mirrored, 1e-13)


def test_fully_loaded_straight_contact_has_closed_form():
    a = 1.7e-5
    second = 2 * HALF * C * 10 / 9 * a ** (1 / 9) * np.array([1, 0, HALF**2 / 3])
    force = 2 * HALF * C * a ** (10 / 9)
    expected = force * a * 9 / 19, force, 0.0, second
    _close(line_moments(a, 0.0, np.zeros_like, C, HALF), expected, 1e-13)


@pytest.mark.parametrize("height", [1e-5, 1e-7, 1e-12])
def test_parabolic_zone_has_closed_form_down_to_a_sliver(height):
    radius, middle = 0.4, 1.2345e-3
    b = middle / radius
    a = height - 0.5 * middle**2 / radius
    gamma = math.gamma

    def beta(n):
        return math.sqrt(math.pi) * gamma(n + 1) / gamma(n + 1.5)

    width = math.sqrt(2 * radius * height)
    force = C * height ** (10 / 9) * width * beta(10 / 9)
    stiffness = C * 10 / 9 * height ** (1 / 9) * width * beta(1 / 9)
    result = line_moments(a, b, lambda s: s * s / (2 * radius), C, HALF)
    # The sum a + b s - drop itself is only good to about 1e-21 m.
    rtol = 1e-13 + 1e-20 / height
    assert result[1] == pytest.approx(force, rel=rtol)
    assert result[2] == pytest.approx(force * middle, rel=rtol)
    assert result[3][0] == pytest.approx(stiffness, rel=10 * rtol)


def test_line_moments_vanish_for_open_contact():
    energy, force, moment, second = line_moments(-1e-6, 1e-5, np.zeros_like, C, HALF)
    assert (energy, force, moment) == (0.0, 0.0, 0.0)
    assert not second.any()


@pytest.mark.parametrize("seed", [1, 3, 4, 5])
@pytest.mark.parametrize("exact", [False, True])
def test_force_and_stiffness_are_derivatives(seed, exact):
    bearing, q, _ = oracle.random_case(seed)
    middle = (midpoint_slices(bearing.roller_length, 20),) * 2
    slices = oracle.graded(bearing, 100) if exact else middle
    way = np.random.default_rng(seed).uniform(-1, 1, 12)
    way *= np.tile(np.repeat([1.0, 20.0], 3), 2)
    force, stiffness = oracle.differences(bearing, q, slices, way, 1e-8)
    assert force < 1e-8
    assert stiffness < 1e-6


@pytest.mark.parametrize("seed", range(10, 18))
def test_balance_and_rigid_modes(seed):
    bearing, q, info = oracle.random_case(seed)
    result = evaluate(bearing, q, (midpoint_slices(bearing.roller_length, 20),) * 2)
    assert oracle.imbalance(result["force"]) < 1e-11
    stiffness = result["stiffness"]
    lever = np.tile(np.repeat([1.0, 0.5 * bearing.pitch_diameter], 3), 2)
    scaled = stiffness / np.outer(lever, lever)
    size = np.max(np.abs(scaled))
    np.testing.assert_allclose(scaled, scaled.T, atol=1e-14 * size)
    np.testing.assert_allclose(scaled[:, :6] + scaled[:, 6:], 0.0, atol=1e-12 * size)
    assert not stiffness[[5, 11]].any()
    assert np.linalg.eigvalsh(scaled)[0] > -1e-13 * size
    if info["kind"] == "cylindrical" and not info["ribs"]:
        assert np.max(np.abs(result["force"][[2, 8]])) < 1e-12 * size * 1e-5


def test_turning_everything_turns_the_forces():
    bearing, q, info = oracle.random_case(4)
    angle = 0.7
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.kron(np.eye(4), [[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    slices = (midpoint_slices(bearing.roller_length, 20),) * 2
    base = evaluate(bearing, q, slices)
    info["first_azimuth"] += angle
    turned = evaluate(oracle.build(info), turn @ q, slices)
    scale = np.max(np.abs(base["force"]))
    np.testing.assert_allclose(
        turned["force"], turn @ base["force"], atol=1e-11 * scale
    )
    np.testing.assert_allclose(turned["roller_load"], base["roller_load"], rtol=1e-9)
    stiffness = turn @ base["stiffness"] @ turn.T
    scale = np.max(np.abs(stiffness))
    np.testing.assert_allclose(turned["stiffness"], stiffness, atol=1e-11 * scale)


def _surrogate():
    drop, kinks = oracle.make_drop(
        {"type": "crowned_ends", "radius": 1.0, "straight_length": 9e-3}, 0.0, 0.0
    )
    return OracleBearing(
        n_rollers=12,
        pitch_diameter=72.5e-3,
        roller_diameter=14e-3,
        roller_length=13.72e-3,
        # Palmgren's constant for E = 206 GPa, nu = 0.3.
        line_constant=(6.01313e4 * 10 ** (19 / 3),) * 2,
        first_azimuth=0.5 * math.pi,
        drop_outer=drop,
        drop_inner=drop,
        kinks=kinks,
    )


def test_alike_raceways_leave_the_roller_half_way():
    bearing = _surrogate()
    q = np.zeros(12)
    q[1], q[3] = -30e-6, -5e-4
    slices = (midpoint_slices(bearing.roller_length, 20),) * 2
    motion = evaluate(bearing, q, slices)["roller_motion"][0]
    assert motion[1:] == pytest.approx([-15e-6, 2.5e-4], rel=1e-12)


def test_evaluate_vanishes_for_loose_rollers():
    bearing = _surrogate()
    bearing.clearance = 60e-6
    slices = (midpoint_slices(bearing.roller_length, 20),) * 2
    # Pushed far enough for the inner ring to carry rollers along, not to press them.
    q = np.array([0, 20e-6, 0, 1e-4, 0, 0, 0, -9e-6, 0, 0, 0, 0])
    result = evaluate(bearing, q, slices)
    for name in ("force", "stiffness", "roller_load", "energy"):
        assert not np.any(result[name])
    assert np.all(np.isfinite(result["roller_motion"]))


def test_constant_load_goes_to_the_outer_ring():
    bearing = _surrogate()
    bearing.clearance = 20e-6
    q = np.zeros(12)
    q[7] = 13e-6
    slices = (midpoint_slices(bearing.roller_length, 20),) * 2
    load = evaluate(bearing, q, slices, [0.0, 300.0, 0.0])["roller_load"]
    assert load[:, 0] - load[:, 1] == pytest.approx(300.0, rel=1e-11)
    assert load[0, 1] > 0 and load[6, 1] == 0
    bearing.roller_axis_angle = 0.1
    with pytest.raises(RuntimeError, match="equilibrium"):
        evaluate(bearing, q, slices, [0.0, 300.0, 0.0])


def test_ribs_at_the_pole_close_by_their_gap():
    bearing = _surrogate()
    gap, constant, press = 20e-6, 5e10, 3e-6
    same = (0.2, 0.5 * bearing.roller_diameter, gap, constant)
    bearing.ribs = {"outer_minus": same, "inner_plus": same}
    q = np.zeros(12)
    q[2], q[8] = gap + press, -gap - press
    result = evaluate(bearing, q, (midpoint_slices(bearing.roller_length, 20),) * 2)
    assert result["rib_load"][:, [0, 3]] == pytest.approx(
        constant * press**1.5, rel=1e-9
    )
    assert result["force"][2] == pytest.approx(12 * constant * press**1.5, rel=1e-9)


@pytest.mark.parametrize("name", oracle.RIBS)
def test_rib_is_straight_through_the_contact_height(name):
    bearing, *_ = oracle.random_case(5)
    radius, height, gap = 0.3, 1.3e-3, 1e-5
    bearing.ribs = {name: (radius, height, gap, 1.0)}
    point, normal = oracle.rib(bearing, name)
    centre, t, m = bearing.frame
    end = 1 if name.endswith("plus") else -1
    ring = 0 if name.startswith("outer") else 1
    foot, _ = oracle.raceway(bearing, ring, [0.5 * end * bearing.roller_length])
    along = np.array([-normal[1], normal[0]])
    assert abs(along @ (point - foot[0])) == pytest.approx(height, rel=1e-10)
    # From the raceway the contact lies on the side of the roller axis.
    assert ((point - foot[0]) @ m > 0) == (ring == 1)
    assert end * (normal @ t) > 0.9
    sphere = point - (radius + gap) * normal
    assert (sphere - centre) @ m == pytest.approx(0.0, abs=1e-15)

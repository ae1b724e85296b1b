"""The operating point: what it condenses, and that it is the function's Jacobian."""

import jax
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj

SPEED = bj.Speed(inner=800.0)
LOAD = np.array([150.0, -900.0, 700.0, 0.0, 0.0, 0.0])
ELEMENT = bj.BearingElement(balls(5), raceway_control=bj.element.CentrifugalOnly())


@pytest.fixture(scope="module")
def point():
    return bj.linearise(ELEMENT, LOAD, speed=SPEED)


def test_linearise_matches_jacobian_of_element_function(point):
    function, parameters = ELEMENT.as_function(SPEED)
    rest = np.zeros(12)
    force = function(point.motion, rest, 0.0, parameters)
    np.testing.assert_allclose(force, point.force, atol=SOLVER * 900)
    np.testing.assert_allclose(force[6:], LOAD, atol=SOLVER * 900)
    jacobian = jax.jit(jax.jacfwd(function))(point.motion, rest, 0.0, parameters)
    largest = abs(jacobian).max()
    # A stiffness holds gz, of which the function's force is a function too.
    others = np.delete(np.arange(12), [5, 11])
    np.testing.assert_allclose(
        jacobian[:, others], point.stiffness[:, others], atol=SOLVER * largest
    )
    assert abs(point.stiffness[:, [5, 11]]).max() == 0.0
    np.testing.assert_array_equal(point.ring_stiffness, point.stiffness[6:, 6:])


def test_condensed_stiffness_of_free_and_prescribed_directions(point):
    k = np.asarray(point.ring_stiffness)
    # By the definition: the compliance of all that is free, seen from what is kept.
    free = [0, 1, 2, 3, 4]
    expected = np.linalg.inv(np.linalg.inv(k[np.ix_(free, free)])[:3, :3])
    scale = abs(expected).max()
    np.testing.assert_allclose(point.condense(), expected, atol=SOLVER * scale)
    np.testing.assert_allclose(
        point.condense(("uy", "ux", "uz")),
        expected[np.ix_([1, 0, 2], [1, 0, 2])],
        atol=SOLVER * scale,
    )
    assert abs(expected - k[:3, :3]).max() > 0.01 * scale
    given = {name: float(point.motion[6 + i]) for i, name in ((3, "gx"), (4, "gy"))}
    held = bj.linearise(
        ELEMENT, LOAD, support=bj.Support(prescribed=given), speed=SPEED
    )
    np.testing.assert_allclose(held.condense(), k[:3, :3], atol=SOLVER * abs(k).max())
    four = held.condense(("ux", "uy", "uz", "gx"))
    np.testing.assert_array_equal(four, held.ring_stiffness[:4, :4])


def test_linearise_warns_of_missing_stiffness():
    point = bj.linearise(ELEMENT, speed=SPEED)
    (told,) = (one for one in point.warnings if one.kind == "no_stiffness")
    assert "gx" in told.where and told.startswith(f"no stiffness in {told.where}")
    assert list(point.warnings) == bj.warnings(point.solution)
    with pytest.raises(TypeError, match="the solution is traced"):
        jax.jit(lambda p: len(p.warnings))(point)


def test_condensed_stiffness_drops_direction_without_stiffness():
    rollers = bj.CylindricalRollerBearing(
        7, 0.065, 0.010, 0.010, radial_internal_clearance=-4e-6
    )
    element = bj.BearingElement(rollers, quadrature=bj.numerics.Midpoint(8))
    free = ("ux", "uy", "uz", "gx", "gy")  # nothing holds uz
    held = bj.Support(free=free)
    point = bj.linearise(element, [0, -2000.0, 0, 0, 0, 0], support=held)
    assert any("no stiffness in uz" in one for one in point.warnings)
    k = np.asarray(point.ring_stiffness)
    tilts = np.ix_([3, 4], [3, 4])
    expected = k[:2, :2] - k[:2, 3:5] @ np.linalg.inv(k[tilts]) @ k[3:5, :2]
    kept = point.condense(("ux", "uy"))
    np.testing.assert_allclose(kept, expected, atol=SOLVER * abs(k).max())


@pytest.mark.slow
def test_under_jit_and_grad():
    """d(condensed stiffness)/d(load), through the solve and the condensation."""

    @jax.jit
    def stiffness(load):
        point = bj.linearise(ELEMENT, load, speed=SPEED, throw=False)
        return point.condense(("ux", "uy"))[1, 1]

    slope = jax.jit(jax.grad(stiffness))(LOAD)
    change = 90.0 * np.array([0.5, -1.0, 0.7, 0, 0, 0])
    errors = []
    for h in (1e-2, 1e-3, 1e-4):
        difference = stiffness(LOAD + h * change) - stiffness(LOAD - h * change)
        errors.append(abs(difference / (2 * h) - slope @ change))
    assert min(errors) < DIFFERENCE * abs(slope @ change)


def test_bad_names_and_failures(point):
    for keep in ((), ("ux", "ux"), ("x",)):
        with pytest.raises(ValueError, match="`keep`"):
            point.condense(keep)
    with pytest.raises(bj.SolveError, match="uz"):
        bj.linearise(ELEMENT, -LOAD, speed=SPEED)

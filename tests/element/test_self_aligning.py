"""Finite ring rotations of balls, and the self-aligning bearing that needs them."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, motion
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj
from bearingjax.element import inertia_load


def row(clearance=-4e-6, **change):
    values = dict(
        inner_osculation=0.52, row_offset=0.006, radial_internal_clearance=clearance
    )
    return bj.SelfAligningBallRow(10, 0.046, 0.0087, **(values | change))


@pytest.fixture(scope="module")
def aligning():
    return bj.BearingElement(bj.BearingSet.self_aligning(row()))


@eqx.filter_jit
def evaluate(element, q, speed=None):
    model = element.model(speed)
    solved = model.solve(q)
    return model.evaluate(q, solved), inertia_load(model.results(q, solved))


def tilted(angle, direction=0.3):
    """Inner ring turned about an axis across the bearing's (12,)."""
    way = jnp.asarray([np.cos(direction), np.sin(direction)])
    return jnp.zeros(12).at[9:11].set(angle * way)


@pytest.mark.slow
def test_self_aligning_tilt_keeps_energy(aligning):
    """The balls go with the inner ring, over the sphere."""
    straight = evaluate(aligning, tilted(0.0))[0]
    assert float(straight.energy) > 1e-4  # preloaded
    size = float(straight.magnitude)
    for angle in (1e-4, 0.009, 0.011, 0.05, 0.2):
        e = evaluate(aligning, tilted(angle))[0]
        assert int(e.result) == bj.Result.CONVERGED
        assert float(e.energy) == pytest.approx(float(straight.energy), rel=1e-10)
        # Seen from the ring the balls are not quite evenly spaced: at 0.2 rad 1e-10.
        if angle < 0.1:
            assert np.abs(np.asarray(e.force)).max() < 1e-12 * size
        # Rings turned together, and moved.
        both = tilted(angle).at[:6].set(tilted(angle)[6:])
        both = both.at[jnp.array([1, 7])].add(1e-4)
        e = evaluate(aligning, both)[0]
        assert float(e.energy) == pytest.approx(float(straight.energy), rel=1e-10)


def test_moment_about_the_centre_of_the_sphere(aligning):
    """The contact forces of the outer raceway meet there, whatever load and tilt.

    What is left is the moment of the tangential forces that the cage holds, of the
    second order in the tilt, and the shift of the inner ring times the load.
    """
    q = tilted(0.03).at[7:9].set(jnp.asarray([-1e-5, 4e-6]))
    e, _ = evaluate(aligning, q)
    outer = np.asarray(e.force)[:6]
    assert np.abs(outer[:3]).max() > 500.0
    assert np.abs(outer[3:5]).max() < 1e-12 * np.abs(outer[:3]).max()
    assert np.allclose(e.force[:3], -e.force[6:9], rtol=0, atol=1e-9)


def test_force_and_stiffness_are_derivatives(aligning):
    q = tilted(0.03).at[6:9].set(jnp.asarray([3e-6, -1e-5, 4e-6]))
    e, _ = evaluate(aligning, q)
    value, gradient = eqx.filter_jit(
        lambda element, q: jax.value_and_grad(element.energy)(q)
    )(aligning, q)
    force, k = np.asarray(e.force), np.asarray(e.stiffness)
    assert abs(float(value) - float(e.energy)) < ROUNDING * float(e.energy)
    assert np.abs(gradient - force).max() < ROUNDING * np.abs(force).max()
    for freedom, step in ((7, 3e-9), (10, 3e-7)):
        ends = [
            np.asarray(evaluate(aligning, q.at[freedom].add(s * step))[0].force)
            for s in (1, -1)
        ]
        slope = (ends[0] - ends[1]) / (2 * step)
        error = np.abs(slope - k[:, freedom]).max() / np.abs(slope).max()
        assert error < 100 * DIFFERENCE
    assert np.allclose(k, k.T, rtol=0, atol=ROUNDING * np.abs(k).max())


@pytest.mark.slow
def test_a_turning_one_balances_and_has_the_exact_jacobian(aligning):
    speed = bj.Speed(inner=1200.0)
    q = tilted(0.02).at[7].set(-8e-6)
    e, inertia = evaluate(aligning, q, speed)
    force, k = np.asarray(e.force), np.asarray(e.stiffness)
    total = force[:6] + force[6:] + np.asarray(inertia)
    assert np.abs(total[:3]).max() < 1e-9 * np.abs(force).max()
    step = 3e-9
    ends = [
        np.asarray(evaluate(aligning, q.at[7].add(s * step), speed)[0].force)
        for s in (1, -1)
    ]
    slope = (ends[0] - ends[1]) / (2 * step)
    assert np.abs(slope - k[:, 7]).max() < 100 * DIFFERENCE * np.abs(k[:, 7]).max()


@pytest.mark.slow
def test_load_solve_at_a_tilt():
    """Tilt is prescribed: nothing restrains it."""
    bearing = bj.BearingSet.self_aligning(row(10e-6))
    element = bj.BearingElement(bearing)
    assert bj.statics.restrained_freedoms(bearing) == ("ux", "uy", "uz")
    sag = [
        float(
            bj.solve_load(
                element,
                [0, -800.0, 100.0, 0, 0, 0],
                support=bj.Support(prescribed={"gx": tilt, "gy": 0}),
            ).displacement[7]
        )
        for tilt in (0.0, 0.04)
    ]
    # The radial stiffness does not care for the tilt; the axial load turns with it.
    assert sag[1] == pytest.approx(sag[0], rel=0.05) and sag[1] != sag[0]


@pytest.mark.slow
def test_finite_and_linearised_agree_to_first_order():
    """Their difference falls with the square of the motion."""
    bearing = balls(contact_angle=0.4)
    both = [
        bj.BearingElement(bearing, kinematics=kind)
        for kind in (bj.element.Linearised(), bj.element.Finite())
    ]
    off = []
    for size in (1.0, 0.1):
        force = [np.asarray(evaluate(e, size * motion())[0].force) for e in both]
        off.append(np.abs(force[0] - force[1]).max() / np.abs(force[0]).max())
    assert off[0] < 2e-3 and 5.0 < off[0] / off[1] < 20.0


def test_row_in_a_set_is_placed_exactly():
    """A pair turned as a whole: with finite rotations its rows do not work."""
    angular = balls(contact_angle=0.4)
    pair = bj.BearingSet.back_to_back(angular, 0.03, 10e-6)
    element = bj.BearingElement(pair, kinematics=bj.element.Finite())
    straight = evaluate(element, jnp.zeros(12))[0]
    angle = 0.02
    both = tilted(angle).at[:6].set(tilted(angle)[6:])
    turned = evaluate(element, both)[0]
    # The balls stay in fixed sections: of the second order in the tilt.
    assert float(turned.energy) == pytest.approx(float(straight.energy), rel=1e-6)
    assert np.abs(np.asarray(turned.force)).max() < angle**2 * float(straight.magnitude)


@pytest.mark.slow
def test_free_tilts_are_warned_of(aligning):
    load = np.zeros(6)
    s = bj.solve_load(
        aligning, load, support=bj.Support(free=["ux", "uy", "uz", "gx", "gy"])
    )
    (line,) = bj.statics.warnings(s)
    assert line.startswith("no stiffness in gx, gy of the inner ring")
    # The forces between the rings: of a thrust pair they are all axial.
    washer = balls(kind=bj.ThrustBallBearing)
    pair = bj.BearingSet.back_to_back(washer, 0.03, 14e-6)
    finite, small = (
        evaluate(bj.BearingElement(pair, kinematics=kind), jnp.zeros(12))[0]
        for kind in (bj.element.Finite(), bj.element.Linearised())
    )
    assert float(finite.magnitude) == pytest.approx(float(small.magnitude), rel=1e-9)


def test_bad_input():
    with pytest.raises(ValueError, match="`outer_osculation` is given"):
        row(outer_osculation=0.52)
    with pytest.raises(ValueError, match="`row_offset`"):
        row(row_offset=-0.006)
    with pytest.raises(ValueError, match="metres meant"):
        row(0.02)
    with pytest.raises(ValueError, match="`outer_osculation` is missing"):
        bj.DeepGrooveBallBearing(8, 0.046, 0.0087, inner_osculation=0.52)
    with pytest.raises(TypeError, match="SelfAligningBallRow"):
        bj.BearingSet.self_aligning(balls())
    with pytest.raises(ValueError, match="must be 0 m"):
        bj.BearingSet((bj.SetRow(row(), 0.01),))
    mixed = bj.BearingSet((bj.SetRow(row()), bj.SetRow(balls(), 0.04)))
    for bearing in (bj.BearingSet.self_aligning(row()), mixed):
        with pytest.raises(ValueError, match="resist its tilt"):
            bj.BearingElement(bearing, kinematics=bj.element.Linearised())
        assert isinstance(bj.BearingElement(bearing).kinematics, bj.element.Finite)
    spring = bj.PreloadSpring(300.0)
    pair = bj.BearingSet.back_to_back(balls(), 0.02, spring=spring)
    with pytest.raises(ValueError, match="is finite, and a spring presses a row"):
        bj.BearingElement(pair, kinematics=bj.element.Finite())

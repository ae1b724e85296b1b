"""Finite kinematics, formula (3), undeformed normals: what holds and what does not.

Source: Sorokin, Zhang, Ivannikov (2018), eq. (3); its consequences (saddle, moments
that do not balance) worked out for the surrogate roller: raceway radii 29.25 and
43.25 mm, D = 14 mm, l = 13.72 mm, 20 slices.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import bearings, motion
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj


def surrogate(n_rollers=12, **change):
    values = dict(roller_profile=bj.CrownedEnds(0.009, 1.0))
    bearing = bj.CylindricalRollerBearing(
        n_rollers, 0.0725, 0.014, 0.01372, **(values | change)
    )
    return bj.BearingElement(
        bearing, kinematics=bj.element.Finite(), quadrature=bj.numerics.Midpoint(20)
    )


@eqx.filter_jit
def by_autodiff(element, q):
    gradient = jax.grad(lambda q: element.energy(q))(q)
    return gradient, jax.jvp(lambda q: element.force(q), (q,), (q,))[1]


@pytest.mark.slow
def test_force_and_stiffness_are_derivatives():
    for element in (
        surrogate(7),
        bj.BearingElement(
            bearings()["taper, large rib"], kinematics=bj.element.Finite()
        ),
    ):
        q = jnp.asarray(motion())
        gradient, along = by_autodiff(element, q)
        e = element.evaluate(q)
        force, k = np.asarray(e.force), np.asarray(e.stiffness)
        assert int(e.result) == bj.Result.CONVERGED
        assert np.abs(gradient - force).max() < ROUNDING * np.abs(force).max()
        lever = np.tile(np.repeat([1.0, 0.03], 3), 2)
        scale = np.abs(k * np.outer(1 / lever, 1 / lever)).max() * np.outer(
            lever, lever
        )
        bend = np.abs(np.asarray(along) - k @ np.asarray(q)) / lever
        size = np.abs(np.asarray(q) * lever).max() * scale[0, 0]
        assert bend.max() < ROUNDING * size
        assert (np.abs(k - k.T) / scale).max() < ROUNDING


def test_differences_and_vmap():
    element = surrogate(5)
    q = jnp.asarray(motion())
    way = (
        jnp.asarray(np.tile(np.repeat([1.0, 40.0], 3), 2)).at[jnp.array([5, 11])].set(0)
    )
    step = 3e-10
    batch = jax.jit(jax.vmap(lambda q: element.evaluate(q)))(
        jnp.stack([q, q + step * way, q - step * way])
    )
    bend = np.asarray(batch.force[1] - batch.force[2]) / (2 * step)
    exact = np.asarray(batch.stiffness[0]) @ np.asarray(way)
    assert np.abs(bend - exact).max() < 10 * DIFFERENCE * np.abs(exact).max()
    one = element.evaluate(q)
    size = np.abs(np.asarray(one.force)).max()
    assert np.abs(np.asarray(batch.force[0] - one.force)).max() < SOLVER * size


def test_linearised_is_the_limit_of_small_rotations():
    q = jnp.asarray(motion())
    finite = surrogate()
    straight = eqx.tree_at(lambda e: e.kinematics, finite, bj.element.Linearised())
    gaps = []
    for size in (1.0, 0.1):
        # The same compression, smaller turns: the difference is of second order.
        turned = q.at[jnp.array([3, 4, 9, 10])].multiply(size)
        a, b = finite.force(turned), straight.force(turned)
        gaps.append(float(jnp.abs(a - b).max() / jnp.abs(b).max()))
    assert gaps[1] < 0.2 * gaps[0] < 1e-3


def test_moments_of_the_rings_do_not_balance():
    """Their sum is F (R_e sin th_e - R_i sin th_i - D sin th): 5.8 % in the example."""
    element = surrogate(1, first_azimuth=0.0)
    q = np.zeros(12)
    q[0], q[4] = -0.03e-3, 5e-4  # v and θ of the outer ring at azimuth 0
    force = np.asarray(element.force(jnp.asarray(q)))
    row = element.rows(jnp.asarray(q))[0]
    normal = float(row.contact_load[:, :2][0, 0])
    tilt = 0.5 * 5e-4
    expected = normal * (0.04325 * np.sin(5e-4) - 0.014 * np.sin(tilt))
    assert abs(force[4] + force[10]) > 0.0
    assert abs(abs(force[4] + force[10]) - expected) < 2e-3 * expected
    assert abs(abs((force[4] + force[10]) / force[4]) - 0.058) < 5e-4
    # Forces do balance.
    assert np.abs(force[:3] + force[6:9]).max() < ROUNDING * np.abs(force).max()


def sharp(slices, kinematics):
    element = surrogate(1, roller_profile=bj.CircularCrown(0.02))
    return bj.BearingElement(
        element.bearing, kinematics=kinematics, quadrature=bj.numerics.Midpoint(slices)
    )


def result_of(element, push):
    q = np.zeros(12)
    q[0] = -push
    return bj.Result(int(element.evaluate(jnp.asarray(q)).result))


def test_finite_kinematics_reports_saddle():
    """Tilting an upright roller shortens it: on one slice it never stands."""
    assert result_of(sharp(21, bj.element.Finite()), 20e-6) is bj.Result.SADDLE
    assert result_of(sharp(21, bj.element.Linearised()), 20e-6) is bj.Result.CONVERGED


def test_two_slices_stand_up_to_a_limit():
    """Approach of the two middle slices above 2 n s²/D = 18.7 um: a saddle."""
    element = sharp(20, bj.element.Finite())
    s = 0.5 * 0.01372 / 20
    drop = float(bj.CircularCrown(0.02).drop(jnp.asarray(s), 0.01372, 0.014))
    limit = 2 * (10 / 9) * s**2 / 0.014
    assert abs(limit - 18.7e-6) < 0.05e-6
    assert result_of(element, 2 * (0.98 * limit + drop)) is bj.Result.CONVERGED
    assert result_of(element, 2 * (1.02 * limit + drop)) is bj.Result.SADDLE


def test_load_solve_with_finite_kinematics():
    load = [0.0, -10600.0, 0.0, -2.0, 0.0, 0.0]
    finite = surrogate(first_azimuth=np.pi / 2)
    straight = eqx.tree_at(lambda el: el.kinematics, finite, bj.element.Linearised())
    a = bj.solve_load(finite, load, support=bj.Support(fixed_ring="inner"))
    b = bj.solve_load(straight, load, support=bj.Support(fixed_ring="inner"))
    assert float(a.stats.residual) < SOLVER
    # A roller loses the tilt stiffness F D: close, and not the same (3 % in the tilt).
    assert np.allclose(a.displacement, b.displacement, rtol=5e-2, atol=1e-9)
    assert not np.allclose(a.displacement, b.displacement, rtol=1e-9, atol=1e-15)

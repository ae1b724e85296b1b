"""Acceptance facts of the energy model of a roller bearing.

Source: Sorokin, Zhang, Ivannikov (2018) and the surrogate bearing worked out from it:
12 rollers 14 x 13.72 mm between raceways of 29.25 and 43.25 mm radius, zero clearance,
no ribs, straight middle of 9 mm, crown radius 1 m, 20 equal slices. Facts of numbers
(9 to 13) are validation cases, `sorokin_*`; 1, 2 and 5, the slice law and the inverse
update, are tests of `contact` and `numerics`.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.element import azimuths
from bearingjax.element.energy import derivatives, response
from bearingjax.element.equilibrium import solve_element


def surrogate(points=20, equilibrium=None, **change):
    values = dict(first_azimuth=np.pi / 2, roller_profile=bj.CrownedEnds(0.009, 1.0))
    bearing = bj.CylindricalRollerBearing(
        12, 0.0725, 0.014, 0.01372, **(values | change)
    )
    return bj.BearingElement(
        bearing,
        quadrature=bj.numerics.Midpoint(points),
        equilibrium=equilibrium or bj.numerics.TrustRegionNewton(),
    )


def loaded(element, force, moment):
    """Outer ring loaded by (-force, moment), inner ring fixed: um, mrad, solution."""
    s = bj.solve_load(
        element,
        [0.0, -force, 0.0, moment, 0.0, 0.0],
        support=bj.Support(fixed_ring="inner"),
        options=bj.statics.SolveOptions(points=41),
    )
    return 1e6 * float(s.displacement[1]), 1e3 * float(s.displacement[3]), s


@pytest.fixture(scope="module")
def roller():
    """Model of one roller of the surrogate, and the paper's ring motion."""
    element = surrogate()
    model = element.model().rows[0].element
    # Node on the axis to roller centre: x_m = v, x_t = u - R_m θ, θ.
    lever = 0.5 * 0.0725
    outer = jnp.asarray([-lever * 5e-4, -0.03e-3, 5e-4])
    # The inner ring stays; the roller sees its motion against the outer one.
    return model, -outer


def test_fact_3_gradient_of_the_energy(roller):
    model, rings = roller
    x = jnp.asarray([1e-6, 2e-6, -1e-6])
    d = derivatives(model, rings, x)
    z = np.concatenate([rings, x])

    @jax.jit
    def energy(z):
        return derivatives(model, z[:3], z[3:], with_hessian=False).energy

    step = np.array([1e-8, 1e-8, 1e-6] + [1e-8] * 3)
    slopes = [
        float(energy(z + e) - energy(z - e)) / (2 * h)
        for e, h in zip(np.diag(step), step, strict=True)
    ]
    gradient = np.asarray(d.gradient)
    scale = np.abs(gradient * step).max()
    assert np.abs((slopes - gradient) * step).max() < 1e-8 * scale


@pytest.mark.parametrize(
    "solver", [bj.numerics.BFGS(), bj.numerics.TrustRegionNewton()]
)
def test_fact_4_quasi_newton_reaches_the_newton_point(roller, solver):
    """By symmetry half of the ring's motion, from the paper's start at rest."""
    model, rings = roller
    half_length = 0.5 * 0.01372
    # x counts from the mean of the rings; the roller at rest is minus that.
    rest = 0.5 * rings * jnp.asarray([1.0, 1.0, half_length])

    def function(x, with_hessian):
        known = response(model, rings, x)
        d = derivatives(model, rings, x, known, of_own=True)
        scale = jnp.sum(known.aux)
        hessian = d.hessian if with_hessian else d.hessian[:0]
        noise = 1e-9 * jnp.ones_like(scale)
        return bj.numerics.Evaluation(d.energy, d.gradient, hessian, scale, noise)

    minimum = jax.jit(lambda s: solver.minimise(function, s, jnp.asarray(3e-5)))(rest)
    assert int(minimum.result) == bj.Result.CONVERGED
    v = -0.015e-3 + float(minimum.x[1])
    tilt = 2.5e-4 + float(minimum.x[2]) / half_length
    assert abs(v + 0.015e-3) < SOLVER * 0.015e-3
    assert abs(tilt - 2.5e-4) < 1e3 * SOLVER * 2.5e-4  # BFGS stops at 1e-9 of the load
    assert int(minimum.steps) <= 30  # the paper's code took 10


def test_fact_6_condensed_stiffness_is_the_derivative_of_the_force(roller):
    model, rings = roller
    solver = bj.numerics.TrustRegionNewton()
    magnitude = jnp.asarray(1e-4)

    @jax.jit
    def both(rings):
        _, found = solve_element(model, rings, magnitude, solver)
        return found.gradient, found.hessian

    # An unsymmetric state: the inner ring tilts too.
    rings = rings.at[2].add(-1e-4)
    force, stiffness = map(np.asarray, both(rings))
    step = np.array([1e-8, 1e-8, 1e-6])
    columns = [
        (both(rings + e)[0] - both(rings - e)[0]) / (2 * h)
        for e, h in zip(np.diag(step), step, strict=True)
    ]
    difference = np.abs((np.stack(columns, axis=1) - stiffness) * step)
    assert difference.max() < 1e-7 * np.abs(stiffness * step).max()
    assert float(np.abs(force).max()) > 1000.0


def test_fact_7_kernel_of_the_whole_bearing():
    element = surrogate()
    _, _, s = loaded(element, 10600.0, -2.0)
    k, force = np.asarray(s.stiffness), np.asarray(s.force)
    size = np.abs(k).max()
    assert np.abs(k - k.T).max() <= ROUNDING * size
    assert not k[[5, 11]].any() and not k[:, [5, 11]].any()
    assert np.abs(force[:6] + force[6:]).max() < ROUNDING * np.abs(force).max()
    common = np.vstack([np.eye(6), np.eye(6)])[:, :5]
    assert np.abs(k @ common).max() < ROUNDING * size
    # No ribs: the axial freedom is free as well.
    scale = np.tile([1, 1, 1, 30.0, 30.0, 30.0], 2)
    rank = np.linalg.matrix_rank(k * scale * scale[:, None], rtol=1e-10)
    assert rank == 4


def test_fact_8_orbit_of_the_rollers():
    element = surrogate(first_azimuth=0.0)
    turned = azimuths(element.bearing, jnp.zeros(12).at[11].set(1.0))
    harris = 0.5 * (1.0 - 14.0 / 72.5)
    assert abs(float(turned[0]) - harris) < ROUNDING
    both = azimuths(element.bearing, jnp.zeros(12).at[jnp.array([5, 11])].set(0.3))
    assert abs(float(both[0]) - 0.3) < ROUNDING


def test_fact_14_free_roller():
    """Clearance and no load: P* = 0, K* = 0, no NaN in any derivative."""
    element = surrogate(radial_internal_clearance=20e-6)

    @eqx.filter_jit
    def all_of(element, q):
        e = element.evaluate(q)
        return e, jax.grad(element.energy)(q), jax.hessian(element.energy)(q)

    for q in (np.zeros(12), np.eye(12)[6] * 3e-6):
        e, gradient, hessian = all_of(element, jnp.asarray(q))
        assert float(e.energy) == 0.0
        for number in (e.force, e.stiffness, gradient, hessian):
            assert np.all(np.asarray(number) == 0.0)

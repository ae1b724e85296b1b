"""Slices that press on each other, against the half-space and against Lundberg.

The half-space solver knows every cell, coupled slices one number per slice: they are
held to a hundredth of its load, where independent slices are off by a tenth.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.contact import LineContact, Palmgren
from bearingjax.contact.halfspace import RollerContact
from bearingjax.contact.line_contact import response

LENGTH, DIAMETER = 0.015, 0.010
STEEL = bj.Material(210e9, 0.3)
RULE = bj.numerics.ContactMapped()  # of no use to coupled slices
MODULUS = 210e9 / (2 * 0.91)
PROFILES = {
    "straight": bj.Straight(),
    "crowned": bj.CircularCrown(2.0),
    "logarithmic": bj.Logarithmic(),
}


def coupled(profile, slices=24):
    plain = LineContact(
        Palmgren().constant(STEEL, STEEL, jnp.asarray(LENGTH)),
        jnp.asarray(LENGTH),
        jnp.asarray(DIAMETER),
        profile,
        bj.Straight(),
    )
    law = bj.contact.CoupledSlices(slices)
    return law.contact(
        plain, lambda s: jnp.full_like(s, 0.5 * DIAMETER), jnp.asarray(MODULUS)
    )


@pytest.fixture(scope="module")
def at():
    @jax.jit
    def evaluate(line, a, b):
        made = line.table(RULE)
        xi = jnp.linspace(-0.6, 0.6, 7)
        return response(line, made, RULE, a, b), line.load_along(made, xi, a, b)

    def run(line, a, b=0.0):
        return evaluate(line, jnp.asarray(a), jnp.asarray(b))

    return run


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("tilt", [0.0, 3e-4])
@pytest.mark.slow
def test_coupled_slices_match_halfspace(name, tilt, at):
    profile = PROFILES[name]
    roller = RollerContact(
        LENGTH,
        DIAMETER,
        DIAMETER,
        roller_profile=profile,
        material=STEEL,
        raceway_material=STEEL,
    )
    for load in (1000.0, 5000.0):
        grid = roller.grid(2.5 * roller.line_half_width(load))
        solved = roller.solve(load, tilt=tilt, grid=grid)
        got, along = at(coupled(profile), solved.approach, 0.5 * LENGTH * tilt)
        assert float(got.load[0]) == pytest.approx(load, rel=0.01)
        moment = 0.5 * LENGTH * float(got.load[1])
        assert abs(moment - float(solved.moment)) < 0.01 * load * 0.5 * LENGTH
        # Line load where the zone is full, away from its edges.
        y = 0.5 * LENGTH * np.linspace(-0.6, 0.6, 7)
        wanted = np.interp(y, solved.grid.y, solved.line_load)
        middle = wanted > 0.6 * wanted.max()
        assert middle.sum() >= 3
        assert np.allclose(along[middle], wanted[middle], rtol=0.01)


def test_the_ends_of_a_straight_roller(at):
    """The last slice bears a twentieth too little: the contact is wider there."""
    roller = RollerContact(
        LENGTH, DIAMETER, DIAMETER, material=STEEL, raceway_material=STEEL
    )
    grid = roller.grid(1.8 * roller.line_half_width(5000.0))
    solved = roller.solve(5000.0, grid=grid)
    edges = np.linspace(-0.5, 0.5, 25) * LENGTH
    borne = np.cumsum(solved.line_load * np.diff(grid.edges))
    borne = np.interp(edges, grid.edges, np.concatenate([[0.0], borne]))
    line = coupled(bj.Straight())
    xi = jnp.asarray((2 * np.arange(24) + 1) / 24 - 1)
    zero = jnp.asarray(0.0)
    got = line.load_along(line.table(RULE), xi, solved.approach, zero) * LENGTH / 24
    ratio = np.asarray(got) / np.diff(borne)
    assert np.abs(ratio[2:-2] - 1).max() < 0.005
    assert np.abs(ratio[[1, -2]] - 1).max() < 0.015
    assert np.abs(ratio[[0, -1]] - 1).max() < 0.07


def test_a_long_even_load_has_lundbergs_approach():
    """Whatever the slices: mid length, far from the ends of the load."""
    radius, load = 0.5 * DIAMETER, 3e5 * 1.5  # 1.5 m of it
    line_load = 3e5
    half_width = np.sqrt(4 * line_load * radius / (np.pi * MODULUS))
    wanted = line_load / (np.pi * MODULUS)
    wanted *= 2 * np.log(1.5 / (2 * half_width)) + 4 * np.log(2) + 1
    for slices in (301, 999):
        line = LineContact(
            jnp.asarray(1.0),
            jnp.asarray(1.5),
            jnp.asarray(DIAMETER),
            bj.Straight(),
            bj.Straight(),
        )
        contact = bj.contact.CoupledSlices(slices).contact(
            line, lambda s: jnp.full_like(s, radius), jnp.asarray(MODULUS)
        )
        made = contact.table(RULE)
        loads = jnp.full((slices,), load / 1.5 / (np.pi * MODULUS))
        own = loads[0] * (1 + jnp.log(made.limit[0] / loads[0]))
        sinks = (made.matrix @ loads)[slices // 2] + own
        assert float(sinks) == pytest.approx(float(wanted), rel=1e-4)


@pytest.mark.parametrize("name", PROFILES)
def test_energy_load_and_stiffness_are_derivatives(name, at):
    line = coupled(PROFILES[name], 16)
    for a, b in ((6e-6, 1e-6), (2e-6, -5e-6), (1e-4, 4e-5)):
        got, _ = at(line, a, b)
        aa, ab, bb = np.asarray(got.stiffness)
        matrix = np.array([[aa, ab], [ab, bb]])
        assert np.linalg.eigvalsh(matrix).min() > 0
        for k, way in enumerate(([1, 0], [0, 1])):
            slopes, bends = [], []
            for h in 10.0 ** -np.arange(7.0, 13.0):
                far = [
                    at(line, a + s * h * way[0], b + s * h * way[1])[0] for s in (1, -1)
                ]
                slopes.append(float(far[0].energy - far[1].energy) / (2 * h))
                bends.append(np.asarray(far[0].load - far[1].load) / (2 * h))
            slope = np.abs(np.array(slopes) / float(got.load[k]) - 1).min()
            bend = np.abs(np.array(bends) - matrix[k]).max(axis=1).min()
            assert slope < DIFFERENCE
            assert bend < DIFFERENCE * np.abs(matrix).max()


def test_derivatives_by_the_design():
    """Load and stiffness by crown radius, length and modulus."""

    @jax.jit
    def function(x):
        plain = LineContact(
            jnp.asarray(1.0),
            x[1],
            jnp.asarray(DIAMETER),
            bj.CircularCrown(x[0]),
            bj.Straight(),
        )
        line = bj.contact.CoupledSlices(16).contact(
            plain, lambda s: jnp.full_like(s, 0.005), x[2]
        )
        got = response(
            line, line.table(RULE), RULE, jnp.asarray(6e-6), jnp.asarray(1e-6)
        )
        return jnp.concatenate([got.load, got.stiffness])

    x = jnp.asarray([4.0, LENGTH, MODULUS])
    for exact in (jax.jit(jax.jacfwd(function))(x), jax.jit(jax.jacrev(function))(x)):
        for k in range(3):
            errors = []
            for h in 10.0 ** -np.arange(3.0, 8.0):
                step = jnp.zeros(3).at[k].set(h * x[k])
                slope = (function(x + step) - function(x - step)) / (2 * h * x[k])
                errors.append(np.abs(slope - exact[:, k]) / np.abs(exact[:, k]))
            assert np.min(errors, axis=0).max() < DIFFERENCE


def test_apart_touching_and_at_a_huge_load(at):
    line = coupled(bj.Straight())
    apart, along = at(line, -1e-6, 0.0)
    assert float(apart.energy) == 0 and not np.any(apart.load) and not np.any(along)
    assert not np.any(apart.stiffness)
    for a in (0.0, 1e-18, 1e-12, 1e-3, 1.0):
        got, _ = at(line, a, 0.3 * a)
        assert all(np.all(np.isfinite(part)) for part in got)
    lost, _ = at(line, np.nan, 0.0)
    assert np.all(np.isnan(lost.load))


def test_coupled_slices_batch_equals_single_cases(at):
    line = coupled(bj.Logarithmic())
    rng = np.random.default_rng(3)
    a = 10 ** rng.uniform(-8, -4, 64)
    b = a * rng.uniform(-2, 2, 64)
    made = line.table(RULE)
    many = jax.jit(jax.vmap(lambda a, b: response(line, made, RULE, a, b)))(
        jnp.asarray(a), jnp.asarray(b)
    )
    for k in range(0, 64, 7):
        one, _ = at(line, a[k], b[k])
        size = abs(float(one.load[0]))
        assert np.allclose(many.load[k], one.load, rtol=0, atol=SOLVER * size)


@pytest.mark.slow
def test_solve_load_with_coupled_slices():
    """A load is carried, line loads and their sums agree, and the raceway balances."""
    bearing = bj.CylindricalRollerBearing(
        9, 0.0725, DIAMETER, LENGTH, radial_internal_clearance=10e-6
    )
    element = bj.BearingElement(bearing, bj.contact.CoupledSlices(16))
    load = [8000.0, 0, 0, 0, 0, 0]
    free = ("ux", "uy", "gx", "gy")
    got = bj.solve_load(
        element,
        load,
        support=bj.Support(free=free),
        options=bj.statics.SolveOptions(points=16),
    )
    assert got.converged
    assert np.allclose(got.force[6:11], load[:5], atol=1e-6)
    loads = np.asarray(got.roller_load)
    assert np.allclose(loads[:, 0], loads[:, 1], rtol=ROUNDING, atol=1e-6)
    # Straight ends: the line load rises to them, which independent slices cannot do.
    top = np.asarray(got.line_load)[loads[:, 1].argmax(), 1]
    assert top[0] > 1.15 * top[8] and top[-1] > 1.15 * top[8]
    # Palmgren's law is a twelfth stiffer or softer than the half-space.
    plain = bj.solve_load(
        bj.BearingElement(bearing), load, support=bj.Support(free=free)
    )
    assert float(plain.displacement[6]) == pytest.approx(
        float(got.displacement[6]), rel=0.1
    )


def test_coupled_slices_average_tabulated_profile():
    """Ridges from one point of a table to the next, of which a slice has some four."""
    s = np.linspace(-0.5, 0.5, 49) * LENGTH
    ridges = 4e-6 * (np.arange(49) % 4 > 0)
    profile = bj.Tabulated(s, ridges)
    made = coupled(profile, 12).table(RULE)
    fine = (2.0 * np.arange(12 * 2000) + 1.0) / (12 * 2000) - 1.0
    drop = profile.drop(jnp.asarray(0.5 * LENGTH * fine), LENGTH, DIAMETER)
    want = np.mean(np.asarray(drop).reshape(12, 2000), axis=1)
    # 64 nodes to a slice, of a drop whose bend jumps from point to point.
    np.testing.assert_allclose(made.drop, want, rtol=1e-3)


def test_coupled_slices_reject_invalid_arguments():
    with pytest.raises(ValueError, match="`slices` is 3; it must be a whole number"):
        bj.contact.CoupledSlices(3)
    bearing = bj.CylindricalRollerBearing(9, 0.0725, DIAMETER, LENGTH)
    with pytest.raises(ValueError, match="`quadrature` is for independent slices"):
        bj.BearingElement(
            bearing, bj.contact.CoupledSlices(), quadrature=bj.numerics.Midpoint()
        )

"""The shaft: one element against the printed matrices, whole shafts against beams.

The printed matrices are those of Przemieniecki, Theory of Matrix Structural Analysis
(1968), sec. 11.7, as Friswell et al., Dynamics of Rotating Machines (2010), sec. 5.4
and ROSS have them, for deflection and slope in one plane; here dux/dz = gy and
duy/dz = -gx.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.linalg
from machines import STEEL
from slopes import with_slopes
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.rotor.shaft import element_matrices, shear_coefficient

matrices_of = eqx.filter_jit(lambda shaft: shaft.matrices())
X, Y, SIGN = [0, 4, 5, 9], [1, 3, 6, 8], np.array([1.0, -1.0, 1.0, -1.0])


def section(outer, bore, material=STEEL):
    """E I, κ G A, ρ A, ρ I."""
    e, nu, rho = (
        float(getattr(material, name))
        for name in ("elastic_modulus", "poisson_ratio", "density")
    )
    area = np.pi / 4 * (outer**2 - bore**2)
    inertia = np.pi / 64 * (outer**4 - bore**4)
    m2 = (bore / outer) ** 2
    kappa = 6 * (1 + nu) * (1 + m2) ** 2
    kappa /= (7 + 6 * nu) * (1 + m2) ** 2 + (20 + 12 * nu) * m2
    return e * inertia, kappa * e / 2 / (1 + nu) * area, rho * area, rho * inertia


def symmetric(rows):
    """Of the upper triangle of a 4 x 4 matrix, row by row."""
    matrix = np.zeros((4, 4))
    matrix[np.triu_indices(4)] = rows
    return matrix + np.triu(matrix, 1).T


@pytest.mark.parametrize("length, outer, bore", [(0.3, 0.05, 0.0), (0.02, 0.06, 0.04)])
def test_an_element_is_the_printed_one(length, outer, bore):
    ei, kga, rho_a, rho_i = section(outer, bore)
    el = length
    p = 12 * ei / (kga * el**2)
    k = symmetric(
        [12, 6 * el, -12, 6 * el, (4 + p) * el**2, -6 * el, (2 - p) * el**2]
        + [12, -6 * el, (4 + p) * el**2]
    ) * (ei / (el**3 * (1 + p)))
    m1, m2 = 312 + 588 * p + 280 * p**2, (44 + 77 * p + 35 * p**2) * el
    m3, m4 = 108 + 252 * p + 140 * p**2, -(26 + 63 * p + 35 * p**2) * el
    m5, m6 = (8 + 14 * p + 7 * p**2) * el**2, -(6 + 14 * p + 7 * p**2) * el**2
    moving = symmetric([m1, m2, m3, m4, m5, -m4, m6, m1, -m2, m5])
    moving *= rho_a * el / (840 * (1 + p) ** 2)
    m8, m9 = (3 - 15 * p) * el, (4 + 5 * p + 10 * p**2) * el**2
    m10 = (-1 - 5 * p + 5 * p**2) * el**2
    turning = symmetric([36, m8, -36, m8, m9, -m8, m10, 36, -m8, m9])
    turning *= rho_i / (30 * el * (1 + p) ** 2)
    mass, gyroscopic, stiffness = np.zeros((3, 10, 10))
    for plane, sign in ((X, 1 + 0 * SIGN), (Y, SIGN)):
        at, both = np.ix_(plane, plane), np.outer(sign, sign)
        stiffness[at], mass[at] = k * both, (moving + turning) * both
    # Forward is from x towards y: M x'' + Ω G2 y' with G2 = 2 x rotary inertia.
    gyroscopic[np.ix_(X, Y)] = 2 * turning * SIGN
    gyroscopic -= gyroscopic.T
    e, rho = float(STEEL.elastic_modulus), float(STEEL.density)
    axial = np.ix_([2, 7], [2, 7])
    stiffness[axial] = e * rho_a / rho / el * np.array([[1, -1], [-1, 1]])
    mass[axial] = rho_a * el / 6 * np.array([[2, 1], [1, 2]])
    numbers = (STEEL.elastic_modulus, STEEL.poisson_ratio, STEEL.density)
    got = jax.jit(element_matrices)(*map(jnp.asarray, (length, outer, bore, *numbers)))
    for ours, printed in zip(got, (mass, gyroscopic, stiffness), strict=True):
        size = abs(printed).max(axis=1)
        size = np.sqrt(np.where(size == 0, 1.0, size))
        scale = np.outer(size, size)
        np.testing.assert_allclose(ours / scale, printed / scale, atol=ROUNDING)


def test_shear_coefficient_of_rod_and_thin_tube():
    # Cowper (1966), table 1.
    rod, tube = (shear_coefficient(jnp.array(m), jnp.array(0.3)) for m in (0.0, 1.0))
    np.testing.assert_allclose(rod, 6 * 1.3 / (7 + 6 * 0.3), rtol=ROUNDING)
    np.testing.assert_allclose(tube, 2 * 1.3 / (4 + 3 * 0.3), rtol=ROUNDING)


STEPPED = bj.rotor.Shaft(
    [-0.1, 0.05, 0.3],
    [0.05, 0.03],
    [0.0, 0.01],
    (STEEL, bj.Material.silicon_nitride()),
    (2, 3),
)


def test_a_stepped_shaft():
    mass, gyroscopic, stiffness = map(np.asarray, matrices_of(STEPPED))
    z = np.asarray(STEPPED.nodes)
    np.testing.assert_allclose(z[[0, 2, 5]], [-0.1, 0.05, 0.3], rtol=ROUNDING)
    assert [STEPPED.node(k) for k in range(3)] == [0, 2, 5]
    for matrix in (mass, stiffness):
        assert abs(matrix - matrix.T).max() < ROUNDING * abs(matrix).max()
    assert abs(gyroscopic + gyroscopic.T).max() < ROUNDING * abs(gyroscopic).max()
    rigid = np.asarray(bj.rotor.Rotor(STEPPED, rigid=True).motions())
    # A rigid motion strains nothing.
    assert abs(stiffness @ rigid).max() < ROUNDING * abs(stiffness).max()
    m = float(STEPPED.mass)
    inertia = rigid.T @ mass @ rigid
    np.testing.assert_allclose(np.diag(inertia)[:3], m, rtol=ROUNDING)
    # Moments of inertia about z = 0 and about the axis, cylinder by cylinder.
    diametral = polar = 0.0
    nitride = bj.Material.silicon_nitride()
    for a, b, outer, bore, material in (
        (-0.1, 0.05, 0.05, 0.0, STEEL),
        (0.05, 0.3, 0.03, 0.01, nitride),
    ):
        *_, rho_a, rho_i = section(outer, bore, material)
        diametral += rho_a * (b**3 - a**3) / 3 + rho_i * (b - a)
        polar += 2 * rho_i * (b - a)
    np.testing.assert_allclose(np.diag(inertia)[3:], diametral, rtol=ROUNDING)
    turning = rigid.T @ gyroscopic @ rigid
    np.testing.assert_allclose(turning[3, 4], polar, rtol=ROUNDING)
    np.testing.assert_allclose(turning[4, 3], -polar, rtol=ROUNDING)
    others = turning[np.ix_([0, 1, 2], [0, 1, 2])]
    assert abs(others).max() < ROUNDING * polar


def test_a_cantilever_bends_as_a_beam_with_shear_does():
    """Whatever the division: elements are exact under end loads."""
    length, outer, force = 0.2, 0.04, 100.0
    ei, kga, _, _ = section(outer, 0.0)
    for divisions in (1, 3):
        shaft = bj.rotor.Shaft(
            [0.0, length], outer, material=STEEL, divisions=divisions
        )
        k = np.asarray(matrices_of(shaft)[2])[5:, 5:]
        load = np.zeros(5 * divisions)
        load[-5], load[-4] = force, force
        ux, uy, _, gx, gy = np.linalg.solve(k, load)[-5:]
        bent = force * (length**3 / (3 * ei) + length / kga)
        np.testing.assert_allclose([ux, uy], bent, rtol=SOLVER)
        slope = force * length**2 / (2 * ei)
        np.testing.assert_allclose([-gx, gy], slope, rtol=SOLVER)


def whirl(shaft, speed=0.0):
    """Frequencies ω of exp(iωt) of x + iy on simple supports, by size [rad/s].

    Forward whirl has ω > 0. The shaft is the same in x and y: with x + iy and with
    the slope gy - i gx one complex plane is left of two real ones.
    """
    mass, gyroscopic, stiffness = map(np.asarray, matrices_of(shaft))
    n = shaft.n_nodes
    x = np.array([5 * k + d for k in range(n) for d in (0, 4)])
    y = np.array([5 * k + d for k in range(n) for d in (1, 3)])
    sign = np.tile([1.0, -1.0], n)
    keep = np.delete(np.arange(2 * n), [0, 2 * n - 2])
    at = np.ix_(x[keep], x[keep])
    m, k = mass[at], stiffness[at]
    # M z'' - iΩ G2 z' + K z = 0
    g = (gyroscopic[np.ix_(x, y)] * sign)[np.ix_(keep, keep)]
    if speed == 0.0:
        return np.sqrt(scipy.linalg.eigh(k, m, eigvals_only=True))
    zero, one = np.zeros_like(m), np.eye(len(m))
    state = np.block(
        [[zero, one], [np.linalg.solve(m, k), speed * np.linalg.solve(m, g)]]
    )
    values = np.linalg.eigvals(state).real
    return values[np.argsort(abs(values))]


def beam(mode, length, outer, speed=0.0):
    """The same of the beam itself, forward and backward, lowest branch.

    With w = W sin βz and slope S cos βz: -ρAω² W = κGA (βS - β²W) and
    (-ρIω² + 2ρIΩω) S = -EIβ² S + κGA (βW - S).
    """
    ei, kga, rho_a, rho_i = section(outer, 0.0)
    beta = mode * np.pi / length
    moving = np.poly1d([rho_a, 0, -kga * beta**2])
    turning = np.poly1d([rho_i, -2 * rho_i * speed, -ei * beta**2 - kga])
    roots = (moving * turning - (kga * beta) ** 2).roots
    return sorted(roots.real, key=abs)[:2]


def errors(length, outer, divisions):
    """Of the first two frequencies, against the beam's."""
    exact = np.array([abs(beam(mode, length, outer)[0]) for mode in (1, 2)])
    shafts = (
        bj.rotor.Shaft([0, length], outer, material=STEEL, divisions=n)
        for n in divisions
    )
    return np.array([whirl(shaft)[:2] / exact - 1 for shaft in shafts])


def test_a_slender_shaft_is_a_beam_with_errors_of_fourth_order():
    length, outer = 0.5, 1e-3
    coarse, fine = errors(length, outer, (4, 8))
    np.testing.assert_allclose(np.log2(coarse / fine), 4.0, atol=0.1)
    ei, _, rho_a, _ = section(outer, 0.0)
    euler = np.pi**2 / length**2 * np.sqrt(ei / rho_a)
    # Shear and rotary inertia take some (π d/l)² of it.
    np.testing.assert_allclose(beam(1, length, outer)[1], euler, rtol=1e-5)


def test_a_stout_shaft_whirls_as_a_timoshenko_beam():
    """Shear strain is constant within an element: of the share s of the shear in the
    energy, s ≈ β² E I/(κ G A), it misses (βh)²/12."""
    length, outer, n = 0.5, 0.06, 16
    error = errors(length, outer, (n,))[0]
    ei, kga, _, _ = section(outer, 0.0)
    beta = np.pi / length * np.array([1, 2])
    share = beta**2 * ei / kga
    missed = 0.5 * share / (1 + share) * (beta * length / n) ** 2 / 12
    np.testing.assert_allclose(error, missed, rtol=0.1)
    # Turning: forward faster than backward, both as the beam's.
    speed = 3e4
    backward, forward = beam(1, length, outer, speed)
    assert backward < 0 < forward and forward > -1.02 * backward
    shaft = bj.rotor.Shaft([0, length], outer, material=STEEL, divisions=n)
    got = whirl(shaft, speed)[:2]
    np.testing.assert_allclose(got, [backward, forward], rtol=3 * error[0])


def test_axial_vibration_of_a_free_shaft():
    """That of n elements between free ends is known, and tends to nπc/L."""
    length, n = 0.8, 16
    shaft = bj.rotor.Shaft([0.0, length], 0.05, 0.02, STEEL, n)
    got = bj.rotor.modes(bj.rotor.Rotor(shaft)).frequency
    c = np.sqrt(float(STEEL.elastic_modulus / STEEL.density))
    kh = np.pi * np.arange(1, 5) / n
    exact = c * n / length * np.sqrt(6 * (1 - np.cos(kh)) / (2 + np.cos(kh)))
    for one in exact / (2 * np.pi):
        assert abs(got / one - 1).min() < SOLVER
    np.testing.assert_allclose(
        exact[0], np.pi * c / length, rtol=kh[0] ** 2 / 24 * 1.01
    )
    # Rigid-body motions stand still, and come last.
    assert (got[-5:] == 0).all()


def test_more_elements_are_no_longer_program():
    def length(n):
        shaft = bj.rotor.Shaft([0.0, 0.4, 1.0], 0.05, divisions=n)
        program = jax.make_jaxpr(
            lambda d: bj.rotor.Shaft(shaft.stations, d, divisions=n).matrices()
        )(0.05)
        return len(program.eqns)

    assert length(2) == length(30)


def test_matrices_have_derivatives():
    def strain(numbers):
        place, outer, bore = numbers
        shaft = bj.rotor.Shaft([0.0, place, 0.4], outer, bore, STEEL, 2)
        bend = jnp.cos(jnp.arange(25.0))
        mass, gyroscopic, stiffness = shaft.matrices()
        return jnp.stack(
            [
                bend @ mass @ bend,
                bend @ gyroscopic @ bend[::-1],
                bend @ stiffness @ bend,
            ]
        )

    at = jnp.array([0.15, 0.05, 0.02])
    run = with_slopes(strain)
    slope, _ = run(at)
    for k, step in enumerate(1e-5 * np.diag(at)):
        change = (run(at + step)[1] - run(at - step)[1]) / (2 * step[k])
        np.testing.assert_allclose(slope[:, k], change, rtol=DIFFERENCE)


@pytest.mark.usefixtures("untyped")
@pytest.mark.parametrize(
    "change, error, shown",
    [
        ({"stations": [0.0]}, ValueError, "`stations` has shape"),
        ({"stations": [0.0, 0.2, 0.2]}, ValueError, "`stations`.*rising"),
        ({"stations": "1 m"}, TypeError, "`stations` is '1 m'"),
        ({"stations": [0.0, 0.1, np.nan]}, ValueError, "`stations`.*finite"),
        ({"outer_diameter": [0.05]}, ValueError, "`outer_diameter` has shape.* 2, one"),
        ({"outer_diameter": [0.05, 0.0]}, ValueError, "`outer_diameter`.*above 0 m"),
        ({"bore": -1e-3}, ValueError, "`bore`.*at least 0 m"),
        ({"bore": [0.01, 0.05]}, ValueError, "`bore`.*below the outer diameter"),
        ({"material": "steel"}, TypeError, "`material` is 'steel'"),
        ({"material": (STEEL,)}, TypeError, "`material`.*a tuple of 2"),
        ({"divisions": 0}, ValueError, "`divisions` is 0"),
        ({"divisions": 1.5}, TypeError, "`divisions` is 1.5"),
        ({"divisions": [1, 2, 3]}, ValueError, "`divisions` has 3 numbers"),
    ],
)
def test_bad_input_is_named(change, error, shown):
    given = {"stations": [0.0, 0.1, 0.4], "outer_diameter": [0.05, 0.04]} | change
    with pytest.raises(error, match=f"Shaft: {shown}"):
        bj.rotor.Shaft(**given)

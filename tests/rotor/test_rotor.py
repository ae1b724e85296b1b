"""The assembly: the paper's rigid rotor, discs, supports, housings, damping."""

import re

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from machines import paper, stepped
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj

linearised = eqx.filter_jit(lambda rotor, speed: rotor.linearise(speed))


def test_the_rigid_rotor_of_the_paper():
    """Filipkovskii and Belomyttsev (2014): m11, m12, m22, G2 in x1, y1, x2, y2, z;
    a pair of equal bearings holds it by c_r each and by 2 c_a (AF002-8)."""
    rho, m0, i0, i1 = 7850.0, 10.0, 0.2, 0.1
    d, length, zeta = 0.025, 0.5, 0.125
    cr, ca = 1.4e8, 1.3e7
    area, inertia = np.pi / 4 * d**2, np.pi / 64 * d**4
    n1, n2 = 1 - zeta / length, zeta / length
    own, turned = rho * area * length, rho * inertia / length
    m11 = own / 3 + turned + m0 * n1**2 + i1 / length**2
    m12 = own / 6 - turned + m0 * n1 * n2 - i1 / length**2
    m22 = own / 3 + turned + m0 * n2**2 + i1 / length**2
    g2 = (i0 + 2 * rho * inertia * length) / length**2 * np.array([[1, -1], [-1, 1]])
    m2 = np.array([[m11, m12], [m12, m22]])
    # (ux uy uz gx gy) at z = 0 from (x1, x2, y1, y2, z).
    to = np.zeros((5, 5))
    to[0, 0] = to[1, 2] = to[2, 4] = 1.0
    to[4, :2] = [-1 / length, 1 / length]
    to[3, 2:4] = [1 / length, -1 / length]
    got = linearised(paper(cr, ca), 1.0).project(jnp.asarray(to))
    zero = np.zeros((2, 2))
    expected = {
        "mass": np.block(
            [
                [m2, zero, np.zeros((2, 1))],
                [zero, m2, np.zeros((2, 1))],
                [np.zeros((1, 4)), own + m0],
            ]
        ),
        "gyroscopic": np.pad(np.block([[zero, g2], [-g2, zero]]), (0, 1)),
        "stiffness": np.diag([cr, cr, cr, cr, 2 * ca]),
        "damping": np.zeros((5, 5)),
    }
    for name, matrix in expected.items():
        # Lengths are some tenths of a metre: entries of one size.
        atol = ROUNDING * max(abs(matrix).max(), 1e-300)
        np.testing.assert_allclose(getattr(got, name), matrix, atol=atol, err_msg=name)


def test_rotor_matrices_symmetry_and_mass():
    rotor = stepped()
    matrices = linearised(rotor, 100.0)
    mass, gyroscopic = np.asarray(matrices.mass), np.asarray(matrices.gyroscopic)
    assert abs(mass - mass.T).max() < ROUNDING * mass.max()
    assert np.linalg.eigvalsh(mass).min() > 0
    assert abs(gyroscopic + gyroscopic.T).max() < ROUNDING * gyroscopic.max()
    heave = np.zeros(len(mass))
    heave[1::5][:6] = 1.0
    heave[-3:] = 0.0
    np.testing.assert_allclose(heave @ mass @ heave, rotor.mass, rtol=ROUNDING)
    np.testing.assert_allclose(rotor.mass, float(rotor.shaft.mass) + 6.5, rtol=ROUNDING)
    heave[-2] = 1.0  # and its housing
    np.testing.assert_allclose(heave @ mass @ heave, rotor.mass + 4.0, rtol=ROUNDING)
    # Cross terms of a support stand as they were given, d(force)/d(motion).
    k = np.asarray(matrices.stiffness)
    assert k[0, 1] == 0.1 * 2e7 and k[1, 0] == -0.05 * 2e7 and matrices.speed == 100.0
    # Moving together with its housing, the support feels nothing.
    shaft = np.zeros(len(k))
    shaft[[25, 30]] = 1.0  # ux of the last node and of the housing
    assert abs((k @ shaft)[30] / 5e7 - 1) < ROUNDING


def test_disc_of_size_inertia_and_gyroscopic_moment():
    outer, bore, wide, rho = 0.3, 0.05, 0.07, 7850.0
    disc = bj.rotor.Disc.of_size(0, outer, wide, bore)
    m = rho * np.pi / 4 * (outer**2 - bore**2) * wide
    np.testing.assert_allclose(disc.mass, m, rtol=ROUNDING)
    polar, diametral = (
        m / 8 * (outer**2 + bore**2),
        m / 48 * (3 * (outer**2 + bore**2) + 4 * wide**2),
    )
    np.testing.assert_allclose(disc.polar_inertia, polar, rtol=ROUNDING)
    np.testing.assert_allclose(disc.diametral_inertia, diametral, rtol=ROUNDING)
    _, gyroscopic = disc.inertia()
    # Spin H = polar (gy, -gx, 1): the moment is its rate.
    rate = np.array([0, 0, 0, 0.3, 0.7])
    moment = polar * np.array([0, 0, 0, 0.7, -0.3])
    np.testing.assert_allclose(gyroscopic @ rate, moment, rtol=ROUNDING)
    mass, still = bj.rotor.PointMass(0, 2.0).inertia()
    np.testing.assert_array_equal(mass, np.diag([2.0, 2.0, 2.0, 0.0, 0.0]))
    assert not still.any()


def test_disc_warns_of_impossible_inertia():
    disc = bj.rotor.Disc(0, 6.0, 0.0201, 0.01)
    (told,) = bj.warnings(disc)
    assert "is above twice `diametral_inertia`" in told
    assert (told.kind, told.size, told.limit) == ("polar_inertia", 0.0201, 0.02)
    rotor = bj.rotor.Rotor(bj.rotor.Shaft([0.0, 0.2], 0.03), disc)
    assert rotor.warnings == (told,)
    assert bj.rotor.Disc(0, 6.0, 0.02, 0.01).warnings == ()  # flat
    assert jax.jit(lambda d: jnp.asarray(len(d.warnings)))(disc) == 0


def test_a_housing_is_in_series():
    """A rigid rotor of mass m on k, on a housing of mass h on kh: two masses."""
    k, kh, h = 3e7, 5e7, 20.0
    base = bj.rotor.Housing(h, [kh, 2 * kh, 3 * kh])
    shaft = bj.rotor.Shaft([-0.1, 0.0, 0.1], 0.1)
    support = bj.rotor.LinearSupport.isotropic(1, k, k, 1e6, housing=base)
    rotor = bj.rotor.Rotor(shaft, (), [support], rigid=True)
    found = bj.rotor.modes(rotor)
    m = float(rotor.mass)
    exact = []
    for factor in (1, 2, 3):
        stiffness = np.array([[k, -k], [-k, k + factor * kh]])
        exact += list(np.linalg.eigvals(stiffness / np.array([[m], [h]])))
    omega = 2 * np.pi * np.asarray(found.frequency)
    for one in np.sqrt(exact):
        assert abs(omega / one - 1).min() < SOLVER
    assert found.housing.shape == (8, 1, 3) and found.shape.shape == (8, 3, 5)


def test_modal_damping_applies_to_every_mode():
    for rigid in (True, False):
        found = bj.rotor.modes(paper(1.4e8, 1.3e7, bj.rotor.ModalDamping(0.02), rigid))
        np.testing.assert_allclose(found.damping_ratio, 0.02, rtol=1e-5)
    # Nothing holds it along z: that motion is not damped.
    loose = bj.rotor.modes(paper(1.4e8, 0.0, bj.rotor.ModalDamping(0.02)))
    np.testing.assert_allclose(loose.damping_ratio[:4], 0.02, rtol=SOLVER)
    assert loose.eigenvalue[4] == 0 and loose.damping_ratio[4] == 0
    assert jnp.isinf(loose.log_decrement[4])


def test_proportional_damping_of_a_free_shaft():
    a, b = 3.0, 2e-7
    shaft = bj.rotor.Shaft([0.0, 0.5], 0.04, divisions=4)
    found = bj.rotor.modes(
        bj.rotor.Rotor(shaft, damping=bj.rotor.ProportionalDamping(a, b))
    )
    omega = np.abs(found.eigenvalue)[:6]
    expected = 0.5 * (a / omega + b * omega)
    np.testing.assert_allclose(found.damping_ratio[:6], expected, rtol=DIFFERENCE)
    # Rigid-body motions creep to a stop with exp(-at).
    assert not found.oscillates[-5:].any()
    rates = np.asarray(found.eigenvalue[-5:].real)
    assert ((abs(rates) < 1e-2) | (abs(rates + a) < 1e-2)).all()


@pytest.mark.usefixtures("untyped")
@pytest.mark.parametrize(
    "make, error, shown",
    [
        (lambda: bj.rotor.Disc(-1, 1.0, 0.1, 0.1), ValueError, "Disc: `station` is -1"),
        (lambda: bj.rotor.Disc(0, -1.0, 0.1, 0.1), ValueError, "`mass` is -1 kg"),
        (
            lambda: bj.rotor.Disc(0, 1.0, np.nan, 0.1),
            ValueError,
            "`polar_inertia`.*kg m²",
        ),
        (lambda: bj.rotor.Disc.of_size(0, 0.1, 0.0), ValueError, "`width` is 0 m"),
        (
            lambda: bj.rotor.Disc.of_size(0, 0.1, 0.1, 0.2),
            ValueError,
            "`bore` is 0.2 m",
        ),
        (lambda: bj.rotor.PointMass(0.5, 1.0), ValueError, "`station` is 0.5"),
        (
            lambda: bj.rotor.LinearSupport(0, [1e8, 1e8]),
            ValueError,
            r"`stiffness` has shape \(2, 2\); it must be \(5, 5\), or 5 numbers",
        ),
        (
            lambda: bj.rotor.LinearSupport(0, np.eye(5), -np.eye(5)),
            ValueError,
            "must be finite, and at least 0 on its diagonal",
        ),
        (
            lambda: bj.rotor.LinearSupport(0, np.eye(5), housing=3.0),
            TypeError,
            "`housing` is a .*; it must be a Housing or None",
        ),
        (lambda: bj.rotor.Housing(0.0, [1.0, 1.0, 1.0]), ValueError, "`mass` is 0 kg"),
        (lambda: bj.rotor.ModalDamping(-0.1), ValueError, "`ratio` is -0.1"),
        (
            lambda: bj.rotor.Rotor(
                bj.rotor.Shaft([0, 1], 0.1), [bj.rotor.PointMass(2, 1.0)]
            ),
            ValueError,
            "`discs` holds a PointMass on station 2; the last station .* is 1",
        ),
        (
            lambda: bj.rotor.Rotor(
                bj.rotor.Shaft([0, 1], 0.1), supports=[bj.rotor.PointMass(0, 1.0)]
            ),
            TypeError,
            "`supports` holds a PointMass; it must hold supports",
        ),
        (
            lambda: bj.rotor.Rotor(bj.rotor.Shaft([0, 1], 0.1), damping=0.01),
            TypeError,
            "`damping` is a float; it must be a Damping or None",
        ),
    ],
)
def test_bad_input_is_named(make, error, shown):
    with pytest.raises(error, match=shown):
        make()


def test_a_disc_of_impossible_inertia_is_odd():
    assert bj.rotor.Disc(0, 1.0, 0.2, 0.1).warnings == ()  # flat
    (told,) = bj.rotor.Disc(0, 1.0, 0.21, 0.1).warnings
    assert re.search("0.21 kg m².* above twice .*0.1 kg m²", told)

"""Whole bearings against published and independently computed numbers.

* NU215-type cylindrical roller bearing, ISO/TS 16281 lamina model: geometry after
  Yan (2025), numbers of an independent program. Our two raceway contacts in series are
  the lamina model's one: per contact 2^(10/9) times its constant, the profile's drop on
  each contact, a quarter of the clearance at each. Inner ring: ux = dr, gy = -psi.
* 209 cylindrical roller bearing under radial load (Harris's example): ISO and Palmgren
  constants, numbers of an independent program. No profile: laminae do not matter.
* Tapered roller bearing of Kumar (2005), axial load: straight profile, half angle 0, no
  ribs, tilts locked; the source takes a per-contact constant for the whole roller.

Tolerances are those of the printed digits.
"""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj

SERIES = 2.0 ** (10.0 / 9.0)
PER_METRE = 10.0 ** (19.0 / 3.0)  # N/mm^(19/9) in N/m^(19/9)


def nu215(laminae):
    bearing = bj.CylindricalRollerBearing(
        18,
        0.103535,
        0.015,
        0.017,
        radial_internal_clearance=70e-6,
        roller_profile=bj.Logarithmic(),
    )
    law = bj.contact.LineConstant(35948.0 * SERIES * 17.0 ** (-1 / 9) * PER_METRE)
    quadrature = bj.numerics.Midpoint(laminae)
    return bj.BearingElement(bearing, line_law=law, quadrature=quadrature)


@eqx.filter_jit
def state(element, q):
    row = element.rows(q)[0]
    return element.force(q), row.contact_load[:, :2]


@pytest.mark.parametrize(
    "laminae, load, moment, largest",
    [
        (30, 16598.7701, -10223.5418, 5544.2496),
        (1000, 16612.842, -10304.7525, 5552.4327),
    ],
)
def test_nu215_prescribed(laminae, load, moment, largest):
    q = np.zeros(12)
    # The lamina model writes x_k tan(psi).
    q[6], q[10] = 60e-6, -np.tan(0.5e-3)
    force, roller = state(nu215(laminae), jnp.asarray(q))
    assert float(force[6]) == pytest.approx(load, rel=1e-6)
    assert 1e3 * float(force[10]) == pytest.approx(moment, rel=1e-6)
    assert float(roller.max()) == pytest.approx(largest, rel=1e-6)


@pytest.mark.parametrize(
    "load, psi, displacement, moment, largest",
    [
        (10e3, 0.0, 0.053618, 0.0, 3670.0397),
        (10e3, 0.5, 0.0534974, -7729.381, 3667.7992),
        (10e3, 1.0, 0.0531304, -15063.375, 3635.5625),
        (20e3, 0.0, 0.0631368, 0.0, 6480.8353),
        (20e3, 0.5, 0.063069, -11045.4, 6493.5599),
        (20e3, 1.0, 0.0628589, -22320.881, 6481.6562),
    ],
)
def test_nu215_equilibrium(load, psi, displacement, moment, largest):
    s = bj.solve_load(
        nu215(30),
        [load, 0.0, 0.0, 0.0, 0.0, 0.0],
        support=bj.Support(prescribed={"gy": -np.tan(1e-3 * psi)}, free=["ux"]),
    )
    assert 1e3 * float(s.displacement[6]) == pytest.approx(displacement, rel=1e-5)
    assert 1e3 * float(s.force[10]) == pytest.approx(moment, rel=1e-5, abs=1e-6)
    assert float(s.roller_load.max()) == pytest.approx(largest, rel=1e-5)


@pytest.mark.parametrize(
    "law, clearance, displacement, largest",
    [
        ("iso", 0.041, 0.032436, 1958.7),
        ("palmgren", 0.041, 0.032088, 1967.2),
        ("iso", 0.0, 0.008246, 1298.8),
    ],
)
def test_209_roller_bearing(law, clearance, displacement, largest):
    # K of the whole roller [N/mm^(10/9)], as printed.
    whole = {"iso": 268414.0, "palmgren": 278581.0}[law]
    constant = bj.contact.LineConstant(whole * SERIES / 9.6 * PER_METRE)
    bearing = bj.CylindricalRollerBearing(
        14, 0.065, 0.010, 0.0096, radial_internal_clearance=1e-3 * clearance
    )
    element = bj.BearingElement(bearing, line_law=constant)
    s = bj.solve_load(element, [4450.0, 0, 0, 0, 0, 0], support=bj.Support(free=["ux"]))
    assert 1e3 * float(s.displacement[6]) == pytest.approx(displacement, rel=2e-4)
    assert float(s.roller_load.max()) == pytest.approx(largest, rel=2e-4)


def test_209_constants_are_those_of_the_laws():
    """What is printed as K follows from our laws within their printed digits."""
    length = jnp.asarray(9.6e-3)
    steel = bj.Material()
    iso = (
        float(bj.contact.ISO16281().constant(steel, steel, length))
        / PER_METRE
        * 9.6
        / SERIES
    )
    assert iso == pytest.approx(268414.0, rel=2e-6)
    # The case rounds Palmgren's form to 3.84e-5; steel of 206 GPa gives 3.8465e-5.
    ours = bj.contact.Palmgren().constant(steel, steel, length)
    palmgren = float(ours) / PER_METRE * 9.6 / SERIES
    assert palmgren == pytest.approx(278581.0, rel=2.5e-3)


KUMAR = [
    # Fa [N], Kxx, Kzz published, Kxx, Kzz computed [MN/mm], delta [mm], Q [N]
    (4000, 3.84, 2.80, 3.84050, 2.80127, 0.0008202, 386.8833),
    (20000, None, 3.29, 4.51112, 3.29043, 0.0034913, 1934.4166),  # misprint of Kxx
    (40000, 4.83, 3.53, 4.83490, 3.52659, 0.0065150, 3868.8333),
    (60000, 5.03, 3.67, 5.03497, 3.67252, 0.0093841, 5803.2499),
    (85000, 5.21, 3.80, 5.21343, 3.80269, 0.0128391, 8221.2707),
    (98000, 5.29, 3.86, 5.28815, 3.85720, 0.0145936, 9478.6415),
]


@pytest.mark.parametrize("row", KUMAR, ids=lambda row: f"{row[0]} N")
def test_taper_of_kumar(row):
    load, kxx_printed, kzz_printed, kxx, kzz, approach, roller = row
    whole = 7.86e4 * 18.251 ** (8.0 / 9.0)
    angle = np.deg2rad(31.128)
    bearing = bj.TaperedRollerBearing(
        20, 0.081, 0.008, 0.018251, roller_axis_angle=angle
    )
    constant = bj.contact.LineConstant(whole * SERIES / 18.251 * PER_METRE)
    element = bj.BearingElement(
        bearing, line_law=constant, quadrature=bj.numerics.Midpoint(10)
    )
    s = bj.solve_load(
        element,
        [0, 0, load, 0, 0, 0],
        support=bj.Support(free=["uz"], prescribed={"ux": 0.0}),
    )
    k = 1e-9 * np.asarray(s.stiffness)[6:9, 6:9]
    normal = 1e3 * float(s.displacement[8]) * np.sin(angle)
    assert k[0, 0] == pytest.approx(kxx, rel=1e-6, abs=6e-6)
    assert k[1, 1] == pytest.approx(kxx, rel=1e-6, abs=6e-6)
    assert k[2, 2] == pytest.approx(kzz, rel=1e-6, abs=6e-6)
    assert normal == pytest.approx(approach, abs=6e-8)
    assert np.asarray(s.roller_load) == pytest.approx(roller, rel=2e-7)
    assert k[2, 2] == pytest.approx(kzz_printed, abs=6e-3)
    if kxx_printed is not None:
        assert k[0, 0] == pytest.approx(kxx_printed, abs=6e-3)

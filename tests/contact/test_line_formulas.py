"""Published approach formulas against printed values, and the package against them.

Sources: Teutsch & Sauer (2004), table 1, worked out for a roller of 20 x 30 mm on a
pitch circle of 60 mm, rings 6 mm thick, 203.1 GPa, 0.3 (case LC-1, 1e-4); stresses
under a line contact (Johnson, 4.46), integrated; the half-space solver (LC-2c, LC-3).
"""

import jax.numpy as jnp
import numpy as np
import pytest
from line_formulas import LINE_FORMULAS, LineBodies, lundberg, tripp
from scipy.integrate import quad
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact.halfspace import RollerContact

MATERIAL = bj.Material(elastic_modulus=203.1e9)
PAIR = {"roller": MATERIAL, "ring": MATERIAL}
LOADS = np.array([3e3, 15e3, 60e3])
INNER = LineBodies(0.030, 0.010, 0.020, **PAIR)
OUTER = LineBodies(0.030, 0.010, -0.040, ring_thickness=0.006, **PAIR)
# In um, inner then outer raceway.
TABLE = {
    "lundberg": ([4.0127, 17.7680, 63.1633], [3.8150, 16.7794, 59.2090]),
    "dinnik": ([3.4885, 15.1471, 52.6800], [2.7497, 11.4529, 37.9030]),
    "kowalsky": ([3.5305, 15.3573, 53.5205], [2.7917, 11.6630, 38.7435]),
    "palmgren_steel": ([3.4044, 14.4916, 50.4627],) * 2,
    "kunert_steel": ([3.7003, 16.3978, 59.1142],) * 2,
    "tripp": ([3.4085, 14.7473, 51.0806], [2.7512, 11.4605, 37.9335]),
}


@pytest.mark.parametrize("name", LINE_FORMULAS)
def test_table(name):
    for bodies, printed in zip((INNER, OUTER), TABLE[name], strict=True):
        found = 1e6 * LINE_FORMULAS[name](LOADS, bodies)
        np.testing.assert_allclose(found, printed, rtol=1e-4)


def test_half_width_of_the_table():
    widths = [1e3 * b.half_width(LOADS) for b in (INNER, OUTER)]
    printed = [[0.087215, 0.195018, 0.390036], [0.123340, 0.275797, 0.551595]]
    np.testing.assert_allclose(widths, printed, rtol=1e-5)


def test_line_formulas_spread():
    spread = []
    for bodies in (INNER, OUTER):
        found = np.stack([f(LOADS, bodies) for f in LINE_FORMULAS.values()])
        spread.append(found.max(axis=0) / found.min(axis=0) - 1.0)
    np.testing.assert_allclose(
        spread, [[0.179, 0.226, 0.252], [0.387, 0.465, 0.562]], atol=1e-3
    )


def test_palmgren_of_steel_is_the_line_law_of_the_package():
    """To 0.2 %: the form for any material, at 206 GPa."""
    found = LINE_FORMULAS["palmgren_steel"](1000.0, LineBodies(0.010, 0.005, 0.02))
    steel = bj.Material()
    constant = bj.contact.Palmgren().constant(steel, steel, jnp.asarray(0.010))
    general = (1e5 / float(constant)) ** 0.9
    assert float(found) == pytest.approx(general, rel=2e-3)


def test_ring_against_the_strain_below_the_contact():
    """Tripp's term of a ring: strain from the surface to its thickness, on the axis."""
    steel, soft = bj.Material(), bj.Material(elastic_modulus=3e9, poisson_ratio=0.4)
    thickness, load = 0.006, 3.0

    def ring(material):
        return LineBodies(
            0.030, 0.010, np.inf, ring_thickness=thickness, roller=steel, ring=material
        )

    bodies = ring(soft)
    width = float(bodies.half_width(load))
    peak = 2.0 * 3.0 / (np.pi * width * 0.030)

    def strain(depth):
        z = depth / width
        down = -1.0 / np.hypot(1.0, z)
        across = -((1.0 + 2.0 * z * z) / np.hypot(1.0, z) - 2.0 * z)
        nu = 0.4
        return peak * (1.0 - nu**2) / 3e9 * (down - nu / (1.0 - nu) * across)

    squeezed = -quad(strain, 0.0, thickness, epsabs=0.0, epsrel=1e-10, limit=200)[0]
    # The roller's share, with both bodies as they are.
    part = (1.0 - 0.3**2) / (np.pi * 206e9) * (np.log(0.04 / width) - 0.5)
    found = float(tripp(load, bodies)) - 2.0 * 3.0 / 0.030 * part
    # The formula lacks terms of (width/thickness)^2.
    assert width / thickness < 0.004
    assert found == pytest.approx(squeezed, rel=1e-5)


def test_exchange_of_two_cylinders():
    """Which of two cylinders is called the roller does not matter."""
    a, b = bj.Material(), bj.Material.silicon_nitride()
    load = 5e3
    for name in ("lundberg", "dinnik", "kowalsky", "tripp"):
        one = LINE_FORMULAS[name](load, LineBodies(0.01, 0.004, 0.03, roller=a, ring=b))
        two = LINE_FORMULAS[name](load, LineBodies(0.01, 0.03, 0.004, roller=b, ring=a))
        assert float(one) == pytest.approx(float(two), rel=ROUNDING)


def test_lundberg_against_half_spaces():
    """Right for Lundberg's profile at its design load, soft by 7 % for square ends."""
    material = bj.Material(elastic_modulus=206e9)
    pair = {"material": material, "raceway_material": material}
    roller = RollerContact(
        0.010, 0.010, 0.010, roller_profile=bj.Lundberg(5000.0), **pair
    )
    plane = LineBodies(0.010, 0.005, np.inf, roller=material, ring=material)
    formula = float(lundberg(5000.0, plane))
    solved = float(roller.solve(5000.0).approach)
    assert formula == pytest.approx(14.852e-6, rel=1e-4)
    assert solved / formula == pytest.approx(14.903 / 14.852, rel=2e-3)
    material = bj.Material(elastic_modulus=208e9)
    pair = {"material": material, "raceway_material": material}
    square = RollerContact(0.010, 0.010, 0.010, **pair).solve(2000.0)
    plane = LineBodies(0.010, 0.005, np.inf, roller=material, ring=material)
    formula = float(lundberg(2000.0, plane))
    assert formula == pytest.approx(6.3996e-6, rel=1e-4)
    assert float(square.approach) / formula == pytest.approx(5.977 / 6.3996, rel=2e-3)

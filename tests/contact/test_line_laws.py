"""Line constants: closed forms, derivatives, laws of other materials.

Numbers of the literature are the validation case `line_law_constants`.
"""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import bearings, motion
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact import (
    ISO16281,
    AbstractSliceLaw,
    LineConstant,
    LineContact,
    Palmgren,
)
from bearingjax.contact.line_contact import response
from bearingjax.design import Material, Straight
from bearingjax.numerics import ContactMapped, Midpoint
from bearingjax.numerics.types import as_real
from bearingjax.numerics.units import unit

STEEL = Material()
UNIT = 10.0 ** (19 / 3)  # one N/mm^(19/9) in N/m^(19/9)
RATIO = 2.0 ** (10 / 9)  # one contact to two in series


def constant(law, millimetres, roller=STEEL, ring=STEEL):
    """C in N/mm^(19/9)."""
    return float(law.constant(roller, ring, jnp.asarray(1e-3 * millimetres))) / UNIT


@pytest.mark.parametrize("length", [1.0, 13.72, 80.0])
def test_iso(length):
    """35948 l^(8/9) of both contacts: spread over l, and twice as near per contact."""
    both = 35948.0 * length ** (8 / 9) / length
    np.testing.assert_allclose(constant(ISO16281(), length), RATIO * both, rtol=1e-12)


def test_laws_of_other_materials():
    """Both laws scale with the contact modulus; steel of 206 GPa is the reference."""
    ceramic = Material.silicon_nitride()
    modulus = 1.0 / ((1 - 0.3**2) / 206e9 + (1 - 0.26**2) / 310e9)
    want = modulus / (206e9 / (2 * (1 - 0.3**2)))
    for law in (Palmgren(), ISO16281()):
        got = constant(law, 10.0, roller=ceramic) / constant(law, 10.0)
        np.testing.assert_allclose(got, want, rtol=ROUNDING)
        swapped = constant(law, 10.0, ring=ceramic) / constant(law, 10.0)
        np.testing.assert_allclose(swapped, want, rtol=ROUNDING)


def test_palmgren_in_any_unit():
    """(3.81 compliance^0.9)^(-10/9) l^(-1/9), in millimetres and newtons."""
    compliance = 2 * (1 - 0.3**2) / (np.pi * 206e3)
    want = (3.81 * compliance**0.9) ** (-10 / 9) * 13.72 ** (-1 / 9)
    np.testing.assert_allclose(constant(Palmgren(), 13.72), want, rtol=ROUNDING)


def test_given_constant():
    law = LineConstant(6e4 * UNIT)
    assert constant(law, 1.0) == pytest.approx(6e4, rel=ROUNDING)
    assert constant(law, 50.0, Material.zirconia()) == constant(law, 1.0)
    for bad, words in ((0.0, "is 0 "), (-1.0, "is -1 "), (np.nan, "is nan ")):
        with pytest.raises(ValueError, match=rf"`value` {words}N/m\^\(19/9\)"):
            LineConstant(bad)


def test_derivative_by_the_length():
    """length^(-1/9), so that l C'/C is -1/9 for both laws."""
    for law in (Palmgren(), ISO16281()):
        got = jax.jit(
            jax.grad(lambda x, law=law: jnp.log(law.constant(STEEL, STEEL, x)))
        )
        slope = got(jnp.asarray(0.01372)) * 0.01372
        np.testing.assert_allclose(slope, -1 / 9, rtol=ROUNDING)


def slice_of(depth):
    """Energy, load and stiffness per length of an even contact 13.72 mm long."""
    length = jnp.asarray(0.01372)
    c = Palmgren().constant(STEEL, STEEL, length)
    line = LineContact(c, length, jnp.asarray(0.014), Straight(), Straight())
    rule = Midpoint(1)
    zero = jnp.zeros_like(depth)
    r = response(line, line.table(rule), rule, depth, zero)
    return r.energy / length, r.load[0] / length, r.stiffness[0] / length


def test_densities_follow_from_each_other():
    """Load is the derivative of the energy, stiffness that of the load; zero apart."""
    depth = jnp.asarray([1e-9, 1e-7, 1e-5, 1e-4, 0.0, -1e-5])
    densities = jax.vmap(slice_of)(depth)
    for order in (0, 1):
        slope = jax.vmap(jax.grad(lambda x, n=order: slice_of(x)[n]))(depth)
        np.testing.assert_allclose(slope, densities[order + 1], rtol=1e-10)
    for value in densities:
        np.testing.assert_array_equal(value[4:], 0.0)
    # Against differences, because the slope follows a rule of its own.
    step = 1e-4 * depth[:4]
    ends = [jax.vmap(slice_of)(depth[:4] + s * step)[0] for s in (1, -1)]
    slope = (ends[0] - ends[1]) / (2 * step)
    np.testing.assert_allclose(slope, densities[1][:4], rtol=1e-8)
    c = float(Palmgren().constant(STEEL, STEEL, jnp.asarray(0.01372)))
    expected = c * np.asarray(depth[:4]) ** (10 / 9)
    np.testing.assert_allclose(densities[1][:4], expected, rtol=ROUNDING)


class Power(AbstractSliceLaw):
    """q = C x^n, at any n."""

    factor: jax.Array = eqx.field(converter=as_real, metadata=unit("N/m"))
    power: jax.Array = eqx.field(converter=as_real, metadata=unit("1"))

    def line_load(self, approach, radius, modulus, length):
        return self.factor * approach**self.power


@pytest.mark.slow
def test_custom_line_law_matches_built_in_of_equal_power():
    """Of an element: energy, force and stiffness, and derivatives by the law."""
    bearing, q = bearings()["cylindrical, crowned ends"], jnp.asarray(motion())

    def of(value, own):
        law = Power(value, 10 / 9) if own else LineConstant(value)
        rule = ContactMapped(24)
        e = bj.BearingElement(bearing, law, quadrature=rule).evaluate(q)
        found = e.energy, e.force[6:], jnp.diagonal(e.stiffness)[6:]
        return found, found

    own, built = (
        jax.jit(jax.jacfwd(partial(of, own=own), has_aux=True))(jnp.asarray(1.2e11))
        for own in (True, False)
    )
    for mine, theirs in zip(*map(jax.tree.leaves, (own, built)), strict=True):
        size = np.abs(theirs).max()
        np.testing.assert_allclose(mine, theirs, rtol=1e-7, atol=1e-9 * size)


def test_an_elastic_foundation_by_hand():
    """q = k x: a roller pressed all along and tilted, W = k L (a²/2 + b²/6)."""
    k, length, a, b = 3e10, 0.012, 5e-6, 2e-6
    modulus, width, size = map(jnp.asarray, (1.3e11, length, 0.014))
    line = LineContact(modulus, width, size, Straight(), Straight())
    contact = Power(k, 1.0).contact(line, lambda s: 0.005 + 0.0 * s, jnp.asarray(1e11))
    rule = ContactMapped()
    r = response(contact, contact.table(rule), rule, jnp.asarray(a), jnp.asarray(b))
    whole = k * length
    assert float(r.energy) == pytest.approx(whole * (a**2 / 2 + b**2 / 6), rel=1e-9)
    assert np.allclose(r.load, [whole * a, whole * b / 3], rtol=1e-9, atol=0.0)
    wanted = [whole, 0.0, whole / 3]
    assert np.allclose(r.stiffness, wanted, rtol=1e-9, atol=1e-9 * whole)

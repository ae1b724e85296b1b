"""One roller on one raceway: energy, load and stiffness, and their derivatives.

A roller with straight middle and arcs on a logarithmic raceway: kinks, and a profile
that depends on length and diameter. Motions (a, b): loaded all over one end, tilted,
the middle only, grazing, apart. The plain reference is a sum over 400 000 slices.
"""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, QUADRATURE_FORCE, ROUNDING

from bearingjax.contact import LineContact
from bearingjax.contact.line_contact import response
from bearingjax.design import (
    CircularCrown,
    CrownedEnds,
    FujiwaraKawase,
    Logarithmic,
    Straight,
)
from bearingjax.numerics import ContactMapped, Midpoint

# Constant [N/m^(19/9)], length, diameter, straight length, crown radius, coefficient.
DESIGN = np.array([1.3e11, 0.01372, 0.014, 0.009, 1.0, 0.00035])
NAMES = ("constant", "length", "diameter", "straight", "radius", "coefficient")
MOTIONS = np.array(
    [
        [3.0e-5, 0.0],
        [2.0e-5, 1.6e-5],
        [-1.0e-5, 3.5e-5],
        [2.0e-6, 0.0],
        [1.0e-6, -4.0e-6],
        [-1.0e-6, 0.5e-6],
    ]
)
APART = 5
RULES = {"midpoint": Midpoint(200), "mapped": ContactMapped()}


def contact(x):
    constant, length, diameter, straight, radius, coefficient = x
    crown, raceway = CrownedEnds(straight, radius), Logarithmic(coefficient)
    return LineContact(constant, length, diameter, crown, raceway)


def flat(rule, x, motion):
    """Energy, two loads, three stiffnesses."""
    line = contact(x)
    got = response(line, line.table(rule), rule, motion[0], motion[1])
    return jnp.concatenate([got.energy[None], got.load, got.stiffness])


def compiled(rule):
    """Values and derivatives by design and motion, for many motions: one program."""

    def energy(x, motion):
        return flat(rule, x, motion)[0]

    def both(x, motion):
        got = {
            "value": flat(rule, x, motion),
            "forward": jax.jacfwd(lambda x, m: flat(rule, x, m), (0, 1))(x, motion),
            "reverse": jax.grad(energy, (0, 1))(x, motion),
        }
        if isinstance(rule, Midpoint):  # the derivative rule is the same for both
            got["hessian"] = jax.hessian(energy, 1)(x, motion)
        return got

    return jax.jit(jax.vmap(both, (None, 0)))


@pytest.fixture(scope="module", params=RULES)
def solved(request):
    """Rule and what it makes of every motion; a call for other designs."""
    rule = RULES[request.param]
    call = compiled(rule)

    def at(design, motions=MOTIONS):
        return call(jnp.asarray(design), jnp.asarray(motions))

    return request.param, at, at(DESIGN)


def plain(design, motion, slices=400_000):
    """The six integrals by plain sums, formulas written out."""
    constant, length, diameter, straight, radius, coefficient = design
    xi = -1.0 + (2.0 * np.arange(slices) + 1.0) / slices
    s = 0.5 * length * xi
    out = np.maximum(np.abs(s) - 0.5 * straight, 0.0)
    drop = radius - np.sqrt(radius**2 - out**2)
    drop = drop - coefficient * diameter * np.log((1 - xi) * (1 + xi))
    f = np.maximum(motion[0] + motion[1] * xi - drop, 0.0)
    step = length / slices
    energy = 9 / 19 * constant * np.sum(f ** (19 / 9)) * step
    load = constant * f ** (10 / 9)
    stiffness = np.where(f > 0, 10 / 9 * constant * f ** (1 / 9), 0.0)
    return np.array(
        [
            energy,
            *(np.sum(load * xi**k) * step for k in range(2)),
            *(np.sum(stiffness * xi**k) * step for k in range(3)),
        ]
    )


def size_of(values):
    """Moments are compared with the first of their order."""
    return np.abs(values[..., [0, 1, 1, 3, 3, 3]])


@pytest.mark.slow
def test_against_plain_sums(solved):
    name, _, got = solved
    value = np.asarray(got["value"])
    for i, motion in enumerate(MOTIONS[:APART]):
        want = plain(DESIGN, motion, 200 if name == "midpoint" else 400_000)
        error = np.abs(value[i] - want) / size_of(want)
        if name == "midpoint":  # the same sum
            assert np.max(error) < 1e-9
        else:  # a slice at the zone's edge leaves (1/slices)^(10/9) of the stiffness
            assert np.max(error[:3]) < QUADRATURE_FORCE
            assert np.max(error[3:]) < 1e-4


def test_load_and_stiffness_are_derivatives(solved):
    """By `grad` and `hessian`: exactly, as the rule says."""
    _, _, got = solved
    value = np.asarray(got["value"])
    by_motion = np.asarray(got["forward"][1])
    load, stiffness = value[:, 1:3], value[:, [3, 4, 4, 5]].reshape(-1, 2, 2)
    size = np.max(np.abs(load))
    np.testing.assert_allclose(got["reverse"][1], load, atol=ROUNDING * size)
    np.testing.assert_allclose(by_motion[:, 0], load, atol=ROUNDING * size)
    size = np.max(np.abs(stiffness))
    if "hessian" in got:
        np.testing.assert_allclose(got["hessian"], stiffness, atol=ROUNDING * size)
    np.testing.assert_allclose(by_motion[:, 1:3], stiffness, atol=ROUNDING * size)


def differences(at, pick, step):
    """Central differences of all values along one design number or motion."""
    ends = [
        np.asarray(at(*shifted)["value"])
        for shifted in (
            (DESIGN + side * pick[0] * step, MOTIONS + side * pick[1] * step)
            for side in (1.0, -1.0)
        )
    ]
    return (ends[0] - ends[1]) / (2 * step)


def test_motion_against_differences(solved):
    """Load and stiffness are what energy and load do when the roller moves."""
    name, at, got = solved
    value, by_motion = np.asarray(got["value"]), np.asarray(got["forward"][1])
    for j in range(2):
        want = differences(at, (np.zeros(6), np.eye(2)[j]), 1e-10)
        error = np.abs(by_motion[..., j] - want)[:APART]
        # Measured against the derivative by a.
        size = np.stack([value[:, 1], value[:, 3], value[:, 3]], axis=1)[:APART]
        if name == "midpoint":
            size[3:, 1:] *= 1e2  # a slice enters within the step: its stiffness jumps
        assert np.max(error[:, :3] / size) < 3 * DIFFERENCE


@pytest.mark.parametrize("number", range(6), ids=NAMES)
def test_design_against_differences(solved, number):
    """Moving zone edges, kinks and the loaded end of a roller that gets longer."""
    name, at, got = solved
    by_design = np.asarray(got["forward"][0])[..., number]
    step = 1e-6 * DESIGN[number]
    want = differences(at, (np.eye(6)[number], np.zeros(2)), step)
    size = size_of(np.asarray(got["value"])) / DESIGN[number]
    error = (np.abs(by_design - want)[:APART] / size[:APART]).T
    assert np.max(error[:3]) < 1e-5
    if name == "mapped":
        # Slices enter and leave one by one; only moving edges follow the stiffness.
        assert np.max(error[3:]) < 1e-4


def test_reverse_by_design(solved):
    """Reverse equals forward."""
    _, _, got = solved
    by_design = np.asarray(got["forward"][0])
    reverse = np.asarray(got["reverse"][0])
    size = np.max(np.abs(by_design[:, 0]), axis=0)
    assert np.max(np.abs(reverse - by_design[:, 0]) / size) < 1e-10


def test_line_contact_is_proportional_to_constant(solved):
    _, _, got = solved
    value, by_design = np.asarray(got["value"]), np.asarray(got["forward"][0])
    error = np.abs(by_design[..., 0] * DESIGN[0] - value)
    assert np.all(error <= ROUNDING * size_of(value))


def test_line_contact_vanishes_when_apart(solved):
    """No contact: zero, and so is every derivative."""
    _, _, got = solved
    for leaf in jax.tree.leaves(got):
        np.testing.assert_array_equal(leaf[APART], 0.0)


def test_nan_is_not_apart(solved):
    _, at, _ = solved
    motions = MOTIONS.copy()
    motions[0, 0] = motions[1, 1] = np.nan
    value = np.asarray(at(DESIGN, motions)["value"])
    assert np.all(np.isnan(value[:2])) and np.all(np.isfinite(value[2:]))
    design = DESIGN.copy()
    design[0] = np.nan
    assert np.all(np.isnan(np.asarray(at(design)["value"])[:APART]))


def line_of(roller, raceway):
    constant, length, diameter = (jnp.asarray(v) for v in (1.3e11, 0.01372, 0.014))
    return LineContact(constant, length, diameter, roller, raceway)


def test_drops_add_up():
    roller, raceway = CircularCrown(1.0), Logarithmic()
    line = line_of(roller, raceway)
    xi = jnp.linspace(-0.9, 0.9, 7)
    s, sizes = 0.00686 * xi, (line.length, line.diameter)
    want = roller.drop(s, *sizes) + raceway.drop(s, *sizes)
    np.testing.assert_allclose(line.drop(xi), want, rtol=ROUNDING)


def test_kinks_of_both_bodies_in_order():
    line = line_of(FujiwaraKawase(2e4, 1.0, 0.5, 2e-5), CrownedEnds(0.009, 1.0))
    end = 0.009 / 0.01372
    np.testing.assert_allclose(line.kinks(), [-end, -0.5, 0.5, end], rtol=ROUNDING)
    assert line_of(Straight(), CircularCrown(1.0)).kinks() == ()


def test_straight_roller_in_closed_form():
    """Even approach: every integral is a product; ∫ξ² ds is L/3."""
    rule = ContactMapped(16)
    line = line_of(Straight(), Straight())
    depth = 1e-5
    got = response(line, line.table(rule), rule, jnp.asarray(depth), jnp.asarray(0.0))
    load = 1.3e11 * depth ** (10 / 9) * 0.01372
    np.testing.assert_allclose(got.load, [load, 0.0], rtol=1e-12, atol=1e-12 * load)
    np.testing.assert_allclose(got.energy, 9 / 19 * load * depth, rtol=1e-12)
    stiffness = 10 / 9 * load / depth
    want = [stiffness, 0.0, stiffness / 3]
    np.testing.assert_allclose(got.stiffness, want, rtol=1e-12, atol=1e-12 * stiffness)
    np.testing.assert_allclose(
        line.line_load(jnp.asarray([depth, -depth])), [load / 0.01372, 0.0], rtol=1e-12
    )


class Scanned(LineContact):
    """As if its profiles were not made of arcs."""

    @property
    def arcs(self):
        return False


def test_arcs_need_no_scan():
    """The same edges as by the scan, also where the top stands exactly at a kink."""
    rng = np.random.default_rng(0)
    a = jnp.asarray(10.0 ** rng.uniform(-8, -3.3, 400))
    tilt = 10.0 ** rng.uniform(-8, -3.0, 400) * rng.choice([-1.0, 1.0], 400)
    b = jnp.asarray(np.where(np.arange(400) < 100, 0.0, tilt))
    rule = ContactMapped()

    def responses(kind):
        line = kind(
            jnp.asarray(2e11),
            jnp.asarray(0.015),
            jnp.asarray(0.010),
            CrownedEnds(4e-3, 0.5, 1e-3, 5e-3),
            Straight(),
        )
        one = partial(response, line, line.table(rule), rule)
        return jax.jit(jax.vmap(one))(a, b)

    got, want = responses(LineContact), responses(Scanned)
    for part, other in zip(got, want, strict=True):
        size = np.abs(other).reshape(400, -1).max(axis=1) + 1e-300
        error = np.abs(part - other).reshape(400, -1).max(axis=1) / size
        # An edge that is off by e changes the stiffness by e^(10/9).
        assert np.max(error) < 1e-10

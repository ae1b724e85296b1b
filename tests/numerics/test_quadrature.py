"""Moments over the loaded part of [-1, 1] against SciPy's adaptive integration.

The offsets h here are convex, so that the loaded part is one interval around the top
of a + b ξ - h. The cases are made from the top: its position and how far it is in.
The reference finds the ends with Brent's method from the top outwards, splits at kinks
and integrates with `scipy.integrate.quad`.
"""

import math
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.numerics import ContactMapped, Midpoint, positive_power

# Sizes of a real roller: drops of some micrometres, E-3.5 D of a logarithm.
CROWN, LOG, FLAT, ARC = 12.5e-6, 3.5e-6, 0.4, 20e-6
HALF = 5e-3
TINY = math.sqrt(np.finfo(float).tiny)
# (power, moment): energy; load and its moment; three of stiffness.
WANTED = ((19, 0), (10, 0), (10, 1), (1, 0), (1, 1), (1, 2))
UNKNOWN = ((np.nan, 1e-5), (0.0, np.nan))  # a and b of two hopeless cases
FORCE, STIFFNESS = slice(0, 3), slice(3, 6)


def crown(p, xi):
    return p[0] * xi * xi


def logarithm(p, xi):
    return -p[0] * jnp.log(jnp.maximum((1.0 - xi) * (1.0 + xi), TINY))


def flat_and_arc(p, xi):
    out = jnp.maximum(jnp.abs(xi) - p[1], 0.0)
    return p[0] * out * out


def arc(p, xi):
    """Of radius p, in half lengths; the half length is 5 mm."""
    return HALF * xi * xi / (p[0] + jnp.sqrt(p[0] ** 2 - xi * xi))


def straight(p, xi):
    return 0.0 * xi * p[0]


class Case:
    """A profile: h for JAX; h, h' and kinks for the reference; its parameters.

    `arcs`: whether the rule may take its panels for arcs.
    """

    def __init__(self, offset, p, plain, slope, kinks=lambda p: (), arcs=False):
        self.offset, self.p, self.arcs = offset, np.array(p), arcs
        self.plain, self.slope, self.kinks = plain, slope, kinks


def plain_log(p, x):
    return -p[0] * math.log(max((1 - x) * (1 + x), TINY))


CASES = {
    "crown": Case(crown, [CROWN], lambda p, x: p[0] * x * x, lambda p, x: 2 * p[0] * x),
    "logarithm": Case(
        logarithm, [LOG], plain_log, lambda p, x: 2 * p[0] * x / ((1 - x) * (1 + x))
    ),
    "flat and arc": Case(
        flat_and_arc,
        [ARC, FLAT],
        lambda p, x: p[0] * max(abs(x) - p[1], 0.0) ** 2,
        lambda p, x: 2 * p[0] * max(abs(x) - p[1], 0.0) * math.copysign(1.0, x),
        lambda p: (-p[1], p[1]),
    ),
    "straight": Case(straight, [1.0], lambda p, x: 0.0, lambda p, x: 0.0),
    # A radius of four half lengths is far from flat.
    "arc": Case(
        arc,
        [4.0],
        lambda p, x: HALF * x * x / (p[0] + math.sqrt(p[0] ** 2 - x * x)),
        lambda p, x: HALF * x / math.sqrt(p[0] ** 2 - x * x),
        arcs=True,
    ),
}
for _name in ("crown", "flat and arc", "straight"):
    _case = CASES[_name]
    CASES[f"{_name}, no scan"] = Case(
        _case.offset, _case.p, _case.plain, _case.slope, _case.kinks, arcs=True
    )


def motions(case, rng, count=200):
    """(a, b, top): a tenth open, the others from grazing to loaded all over."""
    found = []
    for i in range(count):
        kind = i % 10
        top = rng.uniform(-0.999, 0.999)
        depth = 10.0 ** rng.uniform(-9, -4)
        if kind == 0:  # apart: h is 0 at least
            b = rng.uniform(-3e-5, 3e-5)
            found.append((-abs(b) - 10.0 ** rng.uniform(-12, -5), b, None))
            continue
        if kind in (1, 2):  # a zone much shorter than the distance of scan points
            depth = 10.0 ** rng.uniform(-12, -10)
        if kind == 3:  # one end only: the steepest tilt
            top = rng.choice([-1.0, 1.0]) * (1 - 10.0 ** rng.uniform(-2, -1))
        if kind == 4:  # both ends, up to 1e-6 of the end on the logarithm
            top, depth = rng.uniform(-0.1, 0.1), rng.uniform(10.0, 13.0) * LOG
        if case.offset is straight:
            b = rng.uniform(-3e-5, 3e-5)
            # The highest point is an end of the interval.
            top = math.copysign(1.0, b)
        else:
            b = case.slope(case.p, top)
        found.append((case.plain(case.p, top) - b * top + depth, b, top))
    return found


def loaded(case, p, a, b, top):
    """Ends of the loaded interval."""

    def f(x):
        return a + b * x - case.plain(p, x)

    if top is None or f(top) <= 0:
        return None
    ends = []
    for end in (-1.0, 1.0):
        if top == end or f(end) >= 0:
            ends.append(end)
        else:
            ends.append(brentq(f, top, end, xtol=1e-16, rtol=1e-15))
    return ends


def reference(case, p, a, b, top, wanted=WANTED):
    """Moments by adaptive integration, the singular ends of a piece graded away."""
    ends = loaded(case, p, a, b, top)
    if ends is None:
        return np.zeros(len(wanted))
    cuts = [ends[0], *(k for k in case.kinks(p) if ends[0] < k < ends[1]), ends[1]]
    total = []
    for power, moment in wanted:
        value = 0.0
        for left, right in zip(cuts[:-1], cuts[1:], strict=True):
            width = right - left

            def integrand(t, left=left, width=width, power=power, moment=moment):
                # x = left + width·u with u = t⁵/(t⁵ + (1-t)⁵).
                t5, s5 = t**5, (1 - t) ** 5
                x = left + width * (t5 / (t5 + s5))
                grade = 5 * (t * (1 - t)) ** 4 / (t5 + s5) ** 2
                f = a + b * x - case.plain(p, x)
                return (f ** (power / 9) if f > 0 else 0.0) * x**moment * grade * width

            # Full output: no warning where round-off in `f` ends the refinement.
            value += quad(integrand, 0.0, 1.0, epsabs=0.0, epsrel=1e-11, full_output=1)[
                0
            ]
        total.append(value)
    return np.array(total)


def integrals(rule, case, p, a, b):
    """The same moments by one of the package's rules."""

    def bound(args, xi):
        return case.offset(args, xi)

    table = rule.table(partial(case.offset, p), case.kinks(p), p.dtype, case.arcs)
    nodes = rule.nodes(bound, p, table, a, b, case.arcs)
    tau = jnp.asarray(rule.reference()[0])
    xi = nodes.middle[:, None] + nodes.half[:, None] * tau[None, :]
    weight = nodes.half[:, None] * rule.basis(p.dtype)[None, :, 0]
    return jnp.stack(
        [
            jnp.sum(weight * positive_power(nodes.argument, power, 9) * xi**moment)
            for power, moment in WANTED
        ]
    )


def compiled(rule, case):
    """Moments and their derivatives in a, b, p of many (a, b): one program."""

    def moments(a, b, p):
        return integrals(rule, case, p, a, b)

    def all_of(a, b, p):
        return moments(a, b, p), jax.jacfwd(moments, (0, 1, 2))(a, b, p)

    return jax.jit(jax.vmap(all_of, (0, 0, None)))


@pytest.fixture(scope="module", params=CASES)
def solved(request):
    """Profile, its motions, references, and what `ContactMapped` makes of them."""
    case = CASES[request.param]
    found = motions(case, np.random.default_rng(list(CASES).index(request.param)))
    want = np.array([reference(case, case.p, *m) for m in found])
    a, b = (jnp.asarray([*(m[i] for m in found), *UNKNOWN[i]]) for i in (0, 1))
    got, slopes = compiled(ContactMapped(), case)(a, b, jnp.asarray(case.p))
    return case, found, want, np.asarray(got), [np.asarray(x) for x in slopes]


def size_of(moments):
    """Moments are compared with the first of their power: |ξ| ≤ 1."""
    return np.repeat(moments[..., [0, 1, 3]], (1, 2, 3), axis=-1)


@pytest.mark.slow
def test_contact_mapped_moments(solved):
    """32 nodes a panel; grazing cases are conditioned by round-off of a + b ξ."""
    case, found, want, got, _ = solved
    apart = np.array([m[2] is None for m in found])
    assert np.sum(apart) == 20
    np.testing.assert_array_equal(got[:-2][apart], 0.0)
    assert np.all(np.isnan(got[len(want) :]))  # NaN is not taken for apart
    got = got[: len(want)]
    error = np.max(np.abs(got - want)[~apart] / size_of(want[~apart]), axis=0)
    # Reached: 2e-8 and 2e-8 (logarithm), 4e-9 and 2e-9 (the others).
    assert np.max(error[FORCE]) < 1e-7
    assert np.max(error[STIFFNESS]) < 1e-6


@pytest.mark.slow
def test_derivatives_in_a_and_b(solved):
    """d/da and d/db of energy and load are moments of load and stiffness."""
    case, found, want, _, (by_a, by_b, _) = solved
    touching = np.array([m[2] is not None for m in found])
    energy, load, moment, *stiffness = want[touching].T
    by_a, by_b = by_a[:-2][touching].T, by_b[:-2][touching].T
    for got, exact, size in (
        (by_a[0], 19 / 9 * load, load),
        (by_b[0], 19 / 9 * moment, load),
        (by_a[1], 10 / 9 * stiffness[0], stiffness[0]),
        (by_b[1], 10 / 9 * stiffness[1], stiffness[0]),
        (by_a[2], 10 / 9 * stiffness[1], stiffness[0]),
        (by_b[2], 10 / 9 * stiffness[2], stiffness[0]),
    ):
        # Reached: 3e-7 (logarithm).
        assert np.max(np.abs(got - exact) / size) < 1e-6


def test_derivatives_where_apart(solved):
    _, found, _, _, slopes = solved
    apart = np.array([m[2] is None for m in found])
    for slope in slopes:
        np.testing.assert_array_equal(slope[:-2][apart], 0.0)


def test_derivatives_against_differences(solved):
    """In a, b and the profile's parameters, moving zone edges and kinks included."""
    case, found, want, _, (by_a, by_b, by_p) = solved
    deep = [i for i, m in enumerate(found) if m[2] is not None and i % 10 > 3]
    deep = [
        i
        for i in deep
        if found[i][0] + found[i][1] * found[i][2] - case.plain(case.p, found[i][2])
        > 1e-6
    ][:8]
    assert len(deep) == 8
    for i in deep:
        a, b, top = found[i]
        x = np.array([a, b, *case.p])
        got = np.concatenate([by_a[i][:, None], by_b[i][:, None], by_p[i]], axis=1)
        for j in range(2 if case.offset is straight else x.size):
            step = 2e-10 if j < 2 or x[j] < 1e-3 else 1e-5
            step = np.eye(x.size)[j] * step
            ends = [
                reference(case, y[2:], y[0], y[1], top) for y in (x + step, x - step)
            ]
            difference = (ends[0] - ends[1]) / (2 * step[j])
            # Moments are compared with the first of their power, as it moves with a.
            factor = 1.0 if j < 2 else abs(got[0, j] / got[0, 0])
            size = factor * np.abs(size_of(got[:, 0]))
            error = np.abs(got[:, j] - difference) / size
            # Reached: 6e-6 and 2e-5 on the logarithm, whose very end is singular.
            looser = 10.0 if case.offset is logarithm else 1.0
            assert np.max(error[FORCE]) < looser * DIFFERENCE
            assert np.max(error[STIFFNESS]) < 10 * looser * DIFFERENCE


def test_midpoint_is_the_plain_sum():
    """Slices of equal width, each taken at its middle; nothing else."""
    case = CASES["crown"]
    found = motions(case, np.random.default_rng(9), 40)
    found.append((np.nan, 0.0, None))
    a, b = (np.array([m[i] for m in found])[:, None, None] for i in (0, 1))
    xi = -1.0 + (2.0 * np.arange(20) + 1.0) / 20
    f = a + b * xi - CROWN * xi**2
    power, moment = (np.array(WANTED)[:, i, None] for i in (0, 1))
    values = np.where(f <= 0, 0.0, np.where(f <= 0, 1.0, f) ** (power / 9))
    want = np.sum(values * xi**moment, axis=-1) * 0.1
    got = jax.jit(jax.vmap(partial(integrals, Midpoint(20), case), (None, 0, 0)))(
        jnp.asarray(case.p), jnp.asarray(a[:, 0, 0]), jnp.asarray(b[:, 0, 0])
    )
    np.testing.assert_allclose(got, want, rtol=ROUNDING, atol=1e-30)


def test_midpoint_converges():
    """To the same integrals, at the slow rate of a rule that ignores zone edges."""
    case = CASES["flat and arc"]
    found = [m for m in motions(case, np.random.default_rng(8), 60) if m[2] is not None]
    deep = [m for m in found if m[0] + m[1] * m[2] - case.plain(case.p, m[2]) > 1e-7]
    want = np.array([reference(case, case.p, *m) for m in deep])
    a, b = (jnp.asarray([m[i] for m in deep]) for i in (0, 1))
    errors = []
    for points in (100, 10_000):
        call = jax.jit(
            jax.vmap(partial(integrals, Midpoint(points), case), (None, 0, 0))
        )
        got = call(jnp.asarray(case.p), a, b)
        errors.append(np.max(np.abs(got - want) / size_of(want), axis=0))
    # Per slice at a zone edge: (1/points)^(10/9) of the stiffness, more of the others.
    assert np.all(errors[1][FORCE] < 1e-4) and np.all(errors[1][STIFFNESS] < 1e-2)
    assert np.all(errors[1] < 0.1 * errors[0])


@pytest.mark.parametrize("rule", [Midpoint(7), ContactMapped(7)])
def test_reference_rule(rule):
    """Weights sum to 2, are positive, and the rule is symmetric."""
    tau, weight = rule.reference()
    assert tau.shape == weight.shape == (7,)
    np.testing.assert_allclose(np.sum(weight), 2.0, rtol=ROUNDING)
    assert np.all(weight > 0) and np.all(np.abs(tau) < 1)
    np.testing.assert_allclose(tau, -tau[::-1], atol=ROUNDING)
    np.testing.assert_allclose(weight, weight[::-1], rtol=ROUNDING)
    basis = rule.basis(jnp.float64)
    want = np.stack([weight, weight * tau, weight * tau**2], axis=-1)
    np.testing.assert_allclose(basis, want, rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.parametrize("rule", [Midpoint, ContactMapped])
@pytest.mark.parametrize("points", [0, -3, True, 2.0, "20", None])
def test_points_are_checked(rule, points):
    # Without the type checks of the tests' conftest it is ValueError throughout.
    with pytest.raises((TypeError, ValueError), match="points"):
        rule(points)

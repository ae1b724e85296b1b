"""Measured profiles with several high spots, against sums that know no structure.

The reference samples the argument finely, finds every change of sign by bisection and
integrates from one sample to the next with nodes graded to both ends; profiles are
written out in NumPy. Motions: one ridge touches, both, all, none; tilted and not.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import QUADRATURE_FORCE, QUADRATURE_STIFFNESS

import bearingjax as bj
from bearingjax.contact import LineContact
from bearingjax.contact.line_contact import response
from bearingjax.design import Logarithmic, Straight, Tabulated
from bearingjax.statics.rollers import approaches

L, D, C = 0.01372, 0.014, 1.3e11
RULE = bj.numerics.ContactMapped()
MOTIONS = np.array(
    [
        [0.6e-6, 0.0],
        [0.6e-6, 0.9e-6],
        [4.0e-6, -3e-6],
        [0.15e-6, 0.0],
        [2.0e-5, 1.5e-5],
        [-3.0e-6, 0.5e-6],
    ]
)
APART = 5


def ridges(x):
    """Two ridges of 4 um, a twenty-fifth of the length wide."""
    return 4e-6 * (np.abs(np.abs(x) - 0.45) > 0.02)


def wavy(x):
    """A crown with waves of 0.4 um rms."""
    return 12e-6 * x**2 + 0.4e-6 * np.sqrt(2.0) * (1.0 + np.sin(23.0 * x))


def steps(x):
    return 1e-6 * (x > 0.13) + 0.5e-6 * (x < -0.5)


EVEN, UNEVEN = np.linspace(-1.0, 1.0, 41), np.array([-1.1, -0.5, -0.31, 0.2, 0.7, 1.0])
# Positions and drops of the raceway, and of the roller if it is measured as well.
CASES = {
    "ridges": ((EVEN, ridges), Straight()),
    "waves beside a logarithm": ((EVEN, wavy), Logarithmic()),
    "steps beside a table": ((EVEN, steps), (UNEVEN, lambda x: 5e-6 * x**2)),
}


def table(points, shape):
    return Tabulated(0.5 * L * points, shape(points))


def line(case, change=(0.0, 0.0)):
    """The contact; `change` of all drops and of the length, to be differentiated."""
    raceway, roller = CASES[case]
    raceway = table(*raceway)
    wave = jnp.cos(jnp.arange(raceway.drops.size))
    raceway = Tabulated(raceway.positions, raceway.drops + change[0] * wave)
    roller = roller if isinstance(roller, Straight | Logarithmic) else table(*roller)
    length = jnp.asarray(L) + change[1]
    return LineContact(jnp.asarray(C), length, jnp.asarray(D), roller, raceway)


def flat(case, motion, change=(0.0, 0.0)):
    """Energy, two loads, three stiffnesses."""
    contact = line(case, change)
    got = response(contact, contact.table(RULE), RULE, motion[0], motion[1])
    return jnp.concatenate([got.energy[None], got.load, got.stiffness])


def cubics(points, shape):
    """Blended parabolas through the points, by Lagrange's formula."""
    values, last = shape(points), len(points) - 1

    def parabola(middle, x):
        i = np.clip(middle, 1, last - 1)
        total = 0.0
        for j in (-1, 0, 1):
            others = [k for k in (-1, 0, 1) if k != j]
            top = np.prod([x - points[i + k] for k in others], axis=0)
            low = np.prod([points[i + j] - points[i + k] for k in others], axis=0)
            total = total + values[i + j] * top / low
        return total

    def drop(x):
        k = np.clip(np.searchsorted(points, x, side="right") - 1, 0, last - 1)
        t = (x - points[k]) / (points[k + 1] - points[k])
        return (1.0 - t) * parabola(k, x) + t * parabola(k + 1, x)

    return drop


def plain(case, motion, samples=4000):
    """The six integrals."""
    raceway, roller = CASES[case]
    drops = [cubics(*raceway)]
    cuts = [np.linspace(-1.0, 1.0, samples + 1), raceway[0]]
    if isinstance(roller, tuple):
        drops.append(cubics(*roller))
        cuts.append(roller[0])
    elif isinstance(roller, Logarithmic):
        tiny = np.sqrt(np.finfo(float).tiny)
        drops.append(
            lambda x: -0.00035 * D * np.log(np.maximum((1 - x) * (1 + x), tiny))
        )

    def argument(x):
        return motion[0] + motion[1] * x - sum(drop(x) for drop in drops)

    x = np.unique(np.clip(np.concatenate(cuts), -1.0, 1.0))
    positive = argument(x) > 0
    (edge,) = np.nonzero(positive[:-1] != positive[1:])
    low, high = x[edge], x[edge + 1]
    for _ in range(50):
        middle = 0.5 * (low + high)
        same = (argument(middle) > 0) == positive[edge]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    x = np.sort(np.concatenate([x, 0.5 * (low + high)]))
    tau, weight = bj.numerics.ContactMapped(12).reference()
    half = 0.5 * np.diff(x)[:, None]
    xi, weight = 0.5 * (x[1:] + x[:-1])[:, None] + half * tau, half * weight
    f = np.maximum(argument(xi), 0.0)
    load = f ** (10 / 9)
    stiffness = np.where(f > 0, 10 / 9 * np.where(f > 0, f, 1.0) ** (1 / 9), 0.0)
    sums = [
        np.sum(weight * 9 / 19 * f * load),
        *(np.sum(weight * load * xi**k) for k in range(2)),
        *(np.sum(weight * stiffness * xi**k) for k in range(3)),
    ]
    return 0.5 * L * C * np.array(sums)


def size_of(values):
    """Moments are compared with the first of their order."""
    return np.abs(values[..., [0, 1, 1, 3, 3, 3]])


@pytest.fixture(
    scope="module", params=["waves beside a logarithm", "steps beside a table"]
)
def solved(request):
    """Case and values; derivatives by all drops and by the length, both ways."""
    case = request.param
    change = jnp.zeros(2)

    def both(motion, change):
        forward = jax.jacfwd(lambda c: flat(case, motion, c))(change)
        reverse = jax.grad(lambda c: flat(case, motion, c)[0])(change)
        return flat(case, motion, change), forward, reverse

    call = jax.jit(jax.vmap(both, (0, None)))
    return case, call, [np.asarray(x) for x in call(jnp.asarray(MOTIONS), change)]


@pytest.mark.slow
def test_every_high_spot_bears(solved):
    case, _, (value, *_) = solved
    want = np.array([plain(case, motion) for motion in MOTIONS[:APART]])
    error = np.abs(value[:APART] - want) / size_of(want)
    # Reached: 5e-8 and 1e-6.
    assert np.max(error[:, 1:3]) < QUADRATURE_FORCE
    assert np.max(error[:, [0, 3, 4, 5]]) < QUADRATURE_STIFFNESS
    np.testing.assert_array_equal(value[APART], 0.0)


@pytest.mark.slow
def test_derivatives_by_the_table_and_the_length(solved):
    """Every zone edge moves; reverse is forward."""
    case, call, (value, forward, reverse) = solved
    size = np.max(np.abs(forward[:, 0]), axis=0)
    assert np.max(np.abs(reverse - forward[:, 0]) / size) < 1e-10
    motions = jnp.asarray(MOTIONS)
    # Per micrometre of drop, and per length.
    for k, step, unit in ((0, 2e-11, 1e-6), (1, 1e-6 * L, L)):
        shift = jnp.zeros(2).at[k].set(step)
        ends = [np.asarray(call(motions, side * shift)[0]) for side in (1.0, -1.0)]
        want = (ends[0] - ends[1]) / (2.0 * step) * unit
        error = np.abs(forward[..., k] * unit - want)[:APART]
        error = error / (size_of(value) + size_of(want))[:APART]
        assert np.max(error[:, :3]) < 1e-5
        assert np.max(error[:, 3:]) < 1e-3


def test_nan_is_not_apart(solved):
    _, call, _ = solved
    motions = MOTIONS.copy()
    motions[0, 0] = motions[APART, 1] = np.nan
    value = np.asarray(call(jnp.asarray(motions), jnp.zeros(2))[0])
    unknown = np.tile(np.isnan(motions).any(axis=1), (6, 1)).T
    np.testing.assert_array_equal(np.isnan(value), unknown)


def test_the_bearing_carries_on_two_ridges():
    """A ring moved by 1.2 um presses rollers by less than a scan would see."""
    bearing = bj.CylindricalRollerBearing(
        5,
        0.0725,
        D,
        L,
        inner_raceway_profile=table(EVEN, ridges),
        first_azimuth=-np.pi / 2,
    )
    element = bj.BearingElement(bearing)
    q = jnp.zeros(12).at[7].set(-1.2e-6)
    got = element.evaluate(q)
    assert int(got.result) == bj.Result.CONVERGED
    # As the reference has it, of the one roller that lies beneath.
    (row,) = element.rows(q)
    loads = np.asarray(row.contact_load)
    assert loads.max() > 1.0
    np.testing.assert_allclose(loads[:, 0], loads[:, 1], rtol=1e-9, atol=1e-9)
    a, b = np.asarray(approaches(row))[loads[:, 1].argmax(), 1]
    constants = row.element.constants
    want = plain("ridges", (a, b))[1] * float(constants.lines[1].constant) / C
    np.testing.assert_allclose(loads.max(), want, rtol=QUADRATURE_FORCE)

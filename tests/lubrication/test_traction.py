"""Traction of whole contacts against plain integrals in NumPy and closed forms."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj
from bearingjax.lubrication import (
    AbstractTraction,
    Barus,
    Density,
    DryFriction,
    Exponential,
    Eyring,
    LimitingStress,
    Newtonian,
    SlipCurve,
    ellipse_patch,
    line_patch,
    mil_l_23699,
)
from bearingjax.numerics import positive_power

WARM = 303.15
MU, ALPHA = 0.04, 1.5e-8
ROLLING, TRANSVERSE, PEAK, FILM = 1.2e-4, 9e-4, 0.8e9, 3e-7
SLIP, SPIN = (0.05, -0.01), 45.0
AMBIENT = Exponential(MU, WARM, 3000.0, 0.0)
OIL = bj.Lubricant(AMBIENT, Barus(ALPHA), Density(880.0))
EVEN = bj.Lubricant(AMBIENT, Barus(0.0), Density(880.0))
LAWS = {
    "newtonian": Newtonian(),
    "eyring": Eyring(5e6),
    "limiting": LimitingStress(0.05, 1e5),
    "curve": SlipCurve(0.03, 0.2, 5.0),
    "dry": DryFriction(0.1, 1e-2),
}


def plain_stress(name, speed, film, pressure, viscosity):
    """Shear stress at slip speeds above zero, as in textbooks."""
    newtonian = viscosity * speed / film
    if name == "newtonian":
        return newtonian
    if name == "eyring":
        return 5e6 * np.arcsinh(newtonian / 5e6)
    if name == "limiting":
        yielding = np.hypot(1.0, 1e-5 / speed) / (1e5 + 0.05 * pressure)
        return 1 / np.hypot(1 / newtonian, yielding)
    if name == "curve":
        curve = (-0.03 + 0.2 * speed) * np.exp(-5.0 * speed) + 0.03
        return pressure * curve
    return 0.1 * pressure * speed / np.hypot(speed, 1e-2)


def plain_resultants(name, x, y, area, pressure, film, slip, spin):
    ux, uy = slip[0] + y * spin, slip[1] - x * spin
    speed = np.hypot(ux, uy)
    viscosity = MU * np.exp(ALPHA * pressure)
    stress = plain_stress(name, speed, film, pressure, viscosity)
    tx, ty = -stress * ux / speed, -stress * uy / speed
    parts = tx, ty, x * ty - y * tx, -(tx * ux + ty * uy)
    return np.asarray([np.sum(area * part) for part in parts])


def angles(n):
    node, weight = np.polynomial.legendre.leggauss(n)
    return 0.5 * np.pi * node, 0.5 * np.pi * weight


def listed(resultants):
    return jnp.stack([*resultants.force, resultants.moment, resultants.heat])


def of_ellipse(law, oil, contact):
    rolling, transverse, peak, *motion = contact
    warm = jnp.asarray(WARM, rolling.dtype)
    patch = ellipse_patch(oil, warm, rolling, transverse, peak)
    return listed(law.resultants(patch, *motion))


NUMBERS: Any = tuple(
    jnp.asarray(x) for x in (ROLLING, TRANSVERSE, PEAK, FILM, jnp.asarray(SLIP), SPIN)
)
compiled = jax.jit(of_ellipse)


@pytest.mark.parametrize("name", LAWS)
def test_ellipse(name):
    """Over x = b sin A, y = a cos A sin B, where p = p_max cos A cos B."""
    (a, wa), (b, wb) = angles(160), angles(160)
    a, b = np.meshgrid(a, b, indexing="ij")
    x, y = ROLLING * np.sin(a), TRANSVERSE * np.cos(a) * np.sin(b)
    area = np.outer(wa, wb) * ROLLING * TRANSVERSE * np.cos(a) ** 2 * np.cos(b)
    pressure = PEAK * np.cos(a) * np.cos(b)
    want = plain_resultants(name, x, y, area, pressure, FILM, SLIP, SPIN)
    got = compiled(LAWS[name], OIL, NUMBERS)
    np.testing.assert_allclose(got, want, rtol=1e-5)


def test_closed_forms():
    """Constant viscosity: F = -μ/h π a b u; M = μ/h w π a b (a² + b²)/4, against the
    spin (the slip of a positive w turns the other way, from y to x)."""
    conductance = MU / FILM * np.pi * ROLLING * TRANSVERSE
    polar = conductance * (ROLLING**2 + TRANSVERSE**2) / 4
    got = compiled(Newtonian(), EVEN, NUMBERS)
    force = -conductance * np.asarray(SLIP)
    heat = conductance * np.dot(SLIP, SLIP) + polar * SPIN**2
    np.testing.assert_allclose(got, [*force, polar * SPIN, heat], rtol=ROUNDING)
    # Yielding all over: friction times load, 2/3 p_max of the mean.
    load = 2 / 3 * np.pi * ROLLING * TRANSVERSE * PEAK
    moved = *NUMBERS[:4], jnp.asarray([50.0, 0.0]), jnp.asarray(0.0)
    got = compiled(DryFriction(0.1, 1e-6), OIL, moved)
    # The rays of a flat ellipse are not quite evenly spaced.
    np.testing.assert_allclose(got[0], -0.1 * load, rtol=1e-9)
    got = compiled(LimitingStress(0.05, 1.0), OIL, moved)
    np.testing.assert_allclose(got[0], -0.05 * load, rtol=1e-3)


LENGTH = np.polynomial.legendre.leggauss(20)
ROLLER = (
    jnp.asarray(5e-3 * LENGTH[0]),
    jnp.asarray(5e-3 * LENGTH[1]),
    jnp.asarray(1e5 * (1 + 0.5 * LENGTH[0])).at[:3].set(0.0),
    jnp.asarray(8e-5 * np.sqrt(1 + 0.5 * LENGTH[0])).at[:3].set(0.0),
)
"""A tilted roller that does not touch at one end."""


@jax.jit
def of_line(law):
    patch = line_patch(OIL, WARM, *ROLLER, across=40)
    return listed(law.resultants(patch, *NUMBERS[3:]))


@pytest.mark.parametrize("name", LAWS)
def test_line(name):
    angle, weight = angles(64)
    s, width, line_load, half = (np.asarray(v)[3:, None] for v in ROLLER)
    x, y = half * np.sin(angle), np.broadcast_to(s, (17, 64))
    area = width * half * np.cos(angle) * weight
    pressure = 2 * line_load / (np.pi * half) * np.cos(angle)
    want = plain_resultants(name, x, y, area, pressure, FILM, SLIP, SPIN)
    got = of_line(LAWS[name])
    np.testing.assert_allclose(got, want, rtol=1e-6)


def test_newtonian_by_moments_and_by_nodes():
    class ByNodes(AbstractTraction):
        def resistance(self, slip_squared, film, pressure, viscosity):
            return viscosity / film

    short, long = (compiled(law, OIL, NUMBERS) for law in (Newtonian(), ByNodes()))
    np.testing.assert_allclose(short, long, rtol=1e-7)
    short, long = (of_line(law) for law in (Newtonian(), ByNodes()))
    np.testing.assert_allclose(short, long, rtol=1e-10)


@pytest.mark.parametrize("name", LAWS)
def test_traction_never_drives_the_slip(name):
    """τ·u ≤ 0 at points; heat ≥ 0 over contacts, and equal to what forces lose."""
    law, rng = LAWS[name], np.random.default_rng(7)
    n = 400
    slip = rng.normal(size=(n, 2)) * 10 ** rng.uniform(-9, 1.5, (n, 1))
    pressure, film = rng.uniform(0, 4e9, n), 10 ** rng.uniform(-9, -5, n)
    viscosity = 10 ** rng.uniform(-3, 16, n)
    points = [jnp.asarray(v) for v in (slip, film, pressure, viscosity)]
    stress = np.asarray(jax.jit(jax.vmap(law.stress))(*points))
    power = np.sum(stress * slip, axis=1)
    assert np.all(power <= 0) and np.all(np.isfinite(stress))
    size = np.linalg.norm(stress, axis=1)
    speed = np.linalg.norm(slip, axis=1)
    far = speed > 1e-2
    want = plain_stress(name, speed[far], film[far], pressure[far], viscosity[far])
    np.testing.assert_allclose(size[far], want, rtol=1e-8)

    @jax.jit
    @jax.vmap
    def whole(slip, spin):
        patch = ellipse_patch(OIL, WARM, *NUMBERS[:3], radial=12, angular=8)
        found = law.resultants(patch, NUMBERS[3], slip, spin)
        lost = spin * found.moment - jnp.dot(found.force, slip)
        return found.heat, lost

    spin = rng.normal(size=n) * 10 ** rng.uniform(-3, 3, n)
    heat, lost = whole(points[0], jnp.asarray(spin))
    assert np.all(heat >= 0)
    np.testing.assert_allclose(heat, lost, rtol=1e-10)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.slow
def test_smooth_at_zero_slip(name):
    """Value, gradient and Hessian finite; odd; the slope is that of the limit."""
    law = LAWS[name]
    zero = jnp.zeros(3)

    def both(motion):
        slip, spin = motion[:2], motion[2]
        point = law.stress(slip, FILM, PEAK, 1e3)
        whole = of_ellipse(law, OIL, (*NUMBERS[:4], slip, spin))
        return jnp.concatenate([point, whole])

    chain = jax.jit(lambda m: (both(m), jax.jacfwd(both)(m), jax.hessian(both)(m)))
    value, slope, curvature = chain(zero)
    np.testing.assert_array_equal(value, 0.0)
    assert np.all(np.isfinite(slope)) and np.all(np.isfinite(curvature))
    slopes = {"curve": PEAK * (0.03 * 5.0 + 0.2), "dry": 0.1 * PEAK / 1e-2}
    slopes["limiting"] = 1 / np.hypot(FILM / 1e3, 1e-5 / (1e5 + 0.05 * PEAK))
    np.testing.assert_allclose(slope[0, 0], -slopes.get(name, 1e3 / FILM), rtol=1e-5)
    np.testing.assert_array_equal(curvature[:5], 0.0)


def test_thinning_near_zero():
    """asinh(z)/z where the series meets the function, and its slope."""
    law, one = Eyring(1.0), jnp.asarray(1.0)

    def ratio(z):
        return law.resistance(z * z, one, 0.0 * one, one)

    z = jnp.asarray([1e-8, 1e-3, 0.0999, 0.1, 0.1001, 3.0, 1e8])
    value, slope = jax.jit(jax.vmap(jax.value_and_grad(ratio)))(z)
    np.testing.assert_allclose(value, np.arcsinh(z) / z, rtol=1e-14)
    want = (1 / np.sqrt(1 + z**2) - value) / z
    np.testing.assert_allclose(slope[1:], want[1:], rtol=1e-9)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.slow
def test_derivatives(name):
    """By every real number of law, oil and contact."""
    leaves, tree = jax.tree.flatten((LAWS[name], OIL, NUMBERS))
    sizes = [leaf.size for leaf in leaves]
    at = jnp.concatenate([jnp.ravel(leaf) for leaf in leaves])

    def of(x):
        parts = jnp.split(x, np.cumsum(sizes)[:-1])
        shaped = [p.reshape(leaf.shape) for p, leaf in zip(parts, leaves, strict=True)]
        return of_ellipse(*jax.tree.unflatten(tree, shaped))

    value, exact = jax.jit(lambda x: (of(x), jax.jacfwd(of)(x)))(at)
    steps = 1e-5 * jnp.diag(at)
    many = jax.jit(jax.vmap(of))
    ends = [many(at[None] + s * steps) for s in (1.0, -1.0)]
    change = (ends[0] - ends[1]).T / 2e-5 / value[:, None]
    got = exact * at[None] / value[:, None]
    np.testing.assert_allclose(got, change, atol=DIFFERENCE)


def test_unloaded():
    """No load: no traction, and finite derivatives of it."""

    def of(load, law):
        root = positive_power(load, 1, 3)
        axes = 1e-5 * root, 1e-4 * root, 2e8 * root
        ball = ellipse_patch(OIL, WARM, *axes, radial=4, angular=4)
        loads = load * ROLLER[2], load * ROLLER[3]
        roller = line_patch(OIL, WARM, *ROLLER[:2], *loads, across=2)
        found = [law.resultants(patch, *NUMBERS[3:]) for patch in (ball, roller)]
        return jnp.stack([listed(each) for each in found])

    both = jax.jit(lambda load, law: (of(load, law), jax.jacfwd(of)(load, law)))
    for law in (Newtonian(), LAWS["eyring"]):
        value, slope = both(jnp.asarray(0.0), law)
        np.testing.assert_array_equal(value, 0.0)
        assert np.all(np.isfinite(slope))


def test_high_pressure():
    """Finite up to 4 GPa with the oil of the bearing, where it is a glass."""
    oil = mil_l_23699()

    @jax.jit
    @jax.value_and_grad
    def heat(peak, law):
        return of_ellipse(law, oil, (*NUMBERS[:2], peak, *NUMBERS[3:]))[3]

    for law in LAWS.values():
        for peak in (1e9, 2.5e9, 4e9):
            value, slope = heat(jnp.asarray(peak), law)
            assert np.isfinite(value) and np.isfinite(slope) and value > 0


def test_nodes_are_enough():
    """The errors that `ellipse_patch` and `line_patch` state for a Newtonian film,
    against many nodes; largest of force, moment, heat."""
    oil, peaks = mil_l_23699(), jnp.asarray([0.5e9, 1e9, 1.5e9, 4e9])

    @partial(jax.jit, static_argnums=0)
    @partial(jax.vmap, in_axes=(None, 0))
    def line(across, peak):
        half = jnp.asarray([1e-4])
        slices = 0 * half, half, 0.5 * jnp.pi * peak * half, half
        return line_patch(oil, WARM, *slices, across=across).moments[0]

    got = jax.jit(jax.vmap(partial(ellipse_patch, oil, WARM, *NUMBERS[:2])))(peaks)
    s, weight = np.polynomial.legendre.leggauss(200)  # radius² = 1 - (p/p_max)²
    share = 0.5 * (1.0 + s)
    pressure = jnp.asarray(np.outer(peaks, share))
    stiff = np.asarray(oil.viscosity(pressure, WARM)) * share * weight
    want = np.pi * ROLLING * TRANSVERSE * stiff.sum(axis=1)
    polar = np.pi * ROLLING * TRANSVERSE * (stiff @ (1.0 - share**2)) / 2
    polar *= ROLLING**2 + TRANSVERSE**2
    for moment, exact in ((0, want), (2, polar)):
        error = np.abs(got.moments[:, moment] / exact - 1)
        np.testing.assert_array_less(error, [1e-13, 1e-12, 2e-6, 7e-3])
    error = np.abs(line(12, peaks) / line(60, peaks) - 1)
    np.testing.assert_array_less(error, [5e-8, 6e-8, 2e-5, 2e-2])


@pytest.mark.parametrize("name", ["eyring", "limiting", "dry"])
@pytest.mark.slow
def test_rolling_pole_anywhere(name):
    """Stress of oil that yields turns around within micrometres of the rolling pole.
    Values and slopes by the slip, with the pole from the middle to outside the ellipse,
    as `ellipse_patch` states them; against many nodes."""
    law: Any = {**LAWS, "dry": DryFriction(0.05, 1e-4)}[name]
    oil, spin = mil_l_23699(), NUMBERS[5]
    peaks = jnp.asarray([0.5e9, 2e9, 4e9])
    away = spin * jnp.asarray([ROLLING, TRANSVERSE])
    places = jnp.asarray([(0.5, 0.0), (0.1, 0.6), (0.1, 0.9), (0.0, 1.0), (0.1, 1.4)])
    slips = (places * away[None])[:, ::-1]

    @partial(jax.jit, static_argnums=(0, 1))
    @partial(jax.vmap, in_axes=(None, None, 0, None))
    @partial(jax.vmap, in_axes=(None, None, None, 0))
    def found(radial, angular, peak, slip):
        axes = NUMBERS[0], NUMBERS[1], peak
        patch = ellipse_patch(oil, WARM, *axes, radial=radial, angular=angular)

        def of(slip):
            return listed(law.resultants(patch, FILM, slip, spin))[
                jnp.asarray([0, 2, 3])
            ]

        return of(slip), jax.jacfwd(of)(slip)[:, 0] * away[1]

    few, many = found(24, 32, peaks, slips), found(90, 200, peaks, slips)
    dry = [4e-5] * 3, [1e-3] * 3
    stated = dry if name == "dry" else ([4e-5, 5e-4, 1e-3], [2e-4, 3e-3, 1e-2])
    size = np.max(np.abs(many[0]), axis=1, keepdims=True)
    for got, want, most in zip(few, many, stated, strict=True):
        error = np.max(np.abs(got - want) / size, axis=(1, 2))
        np.testing.assert_array_less(error, most)


def test_float32():
    """ln μ up to 10: resultants to 2e-5."""
    narrow = [
        jax.tree.map(lambda x: x.astype(jnp.float32), part) for part in (OIL, NUMBERS)
    ]
    for law in LAWS.values():
        single = jax.tree.map(lambda x: x.astype(jnp.float32), law)
        got = compiled(single, *narrow)
        assert got.dtype == jnp.float32
        np.testing.assert_allclose(got, compiled(law, OIL, NUMBERS), rtol=2e-5)


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: Eyring(-5e6), r"Eyring: `stress_scale` is -5e\+06 Pa.*above 0 Pa"),
        (lambda: LimitingStress(-0.1), r"`slope` is -0.1; .*at least 0"),
        (lambda: LimitingStress(0.1, 0.0), r"`ambient` is 0 Pa.*above 0 Pa"),
        (lambda: LimitingStress(creep=-1.0), r"`creep` is -1 m/s.*at least 0"),
        (lambda: SlipCurve(0.03, np.nan, 5.0), r"`rise` is nan s/m.*finite"),
        (lambda: DryFriction(0.1, -1.0), r"`creep` is -1 m/s.*above 0 m/s"),
        (
            lambda: ellipse_patch(OIL, WARM, *NUMBERS[:3], radial=0),
            r"`radial` is 0; .*least 1",
        ),
        (lambda: ellipse_patch(OIL, -3.0, *NUMBERS[:3]), r"`temperature` is -3 K"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message) as raised:
        make()
    assert "\n" not in str(raised.value)

"""Profiles against formulas written out in NumPy, their kinks and their derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.design import (
    CircularCrown,
    CrownedEnds,
    FujiwaraKawase,
    JohnsGohar,
    Logarithmic,
    Lundberg,
    Straight,
    Tabulated,
)

L, D, E = 0.01372, 0.014, 206e9 / (2 * (1 - 0.3**2))
UNIT = 20e3 / (np.pi * L * E)  # Q/(π L E*) at 20 kN
GRID = np.linspace(-L / 2, L / 2, 2001)


def arc(x, radius):
    """Drop of a circle, in extended precision."""
    x, radius = np.longdouble(x), np.longdouble(radius)
    return np.float64(radius - np.sqrt(radius**2 - x**2))


def dub_off(s):
    """The sharper circle has its centre on the normal of the crown at the join."""
    straight, crown, length, radius = 0.009, 1.0, 0.001, 0.3
    join = L / 2 - length
    angle = np.arcsin((join - straight / 2) / crown)
    sharp = join - radius * np.sin(angle), crown * (1 - np.cos(angle))
    level = sharp[1] + radius * np.cos(angle)
    end = level - np.sqrt(radius**2 - (np.abs(s) - sharp[0]) ** 2)
    begin = arc(np.maximum(np.abs(s) - straight / 2, 0.0), crown)
    return np.where(np.abs(s) < join, begin, end)


def logarithm(unit, part):
    def drop(s):
        x = np.minimum(np.abs(2 * s / L), 1 - 1e-15)
        return -unit * np.log1p(-part * x * x)

    return drop


def fujiwara(s):
    unit, begin = 1.5 * UNIT, L / 2 * (1 - 0.6)
    x = np.maximum(np.abs(s) - begin, 0.0) / (L / 2 - begin)
    return unit * np.log(1.0 / (1.0 - (1.0 - np.exp(-20e-6 / unit)) * x**2))


TABLE = np.linspace(-L / 2, L / 2, 12)
PROFILES = {
    "straight": (Straight(), lambda s: 0 * s),
    "crown": (CircularCrown(1.2), lambda s: arc(s, 1.2)),
    "crowned ends": (
        CrownedEnds(0.009, 1.0),
        lambda s: arc(np.maximum(np.abs(s) - 0.0045, 0.0), 1.0),
    ),
    "dub-off": (CrownedEnds(0.009, 1.0, 0.001, 0.3), dub_off),
    "logarithmic": (Logarithmic(), logarithm(0.00035 * D, 1.0)),
    "Lundberg": (Lundberg(20e3), logarithm(UNIT, 1.0)),
    "Johns-Gohar": (JohnsGohar(20e3, 1e-4), logarithm(UNIT, 1 - 0.3033e-4 / (L / 2))),
    "Fujiwara-Kawase": (FujiwaraKawase(20e3, 1.5, 0.6, 20e-6), fujiwara),
    "tabulated": (Tabulated(TABLE, 0.5 * TABLE**2), lambda s: 0.5 * s**2),
}
LIMITED = ("logarithmic", "Lundberg")  # infinite at the very end, limited there
KINKS = {
    "crowned ends": (-0.0045, 0.0045),
    "dub-off": (-L / 2 + 0.001, -0.0045, 0.0045, L / 2 - 0.001),
    "Fujiwara-Kawase": (-0.2 * L, 0.2 * L),
}
LENGTH, DIAMETER = jnp.asarray(L), jnp.asarray(D)


def everywhere(profile, s):
    """Drop and its first and second derivative at every position."""

    def drop(s):
        return profile.drop(s, LENGTH, DIAMETER)

    return jax.jit(
        lambda s: (
            drop(s),
            jax.vmap(jax.grad(drop))(s),
            jax.vmap(jax.grad(jax.grad(drop)))(s),
        )
    )(jnp.asarray(s))


@pytest.fixture(scope="module", params=PROFILES)
def sampled(request):
    """Name, profile, formula; drop and derivatives on the grid and at the kinks."""
    profile, formula = PROFILES[request.param]
    at = np.concatenate([GRID, [0.0, -0.0], [float(k) for k in profile.kinks(LENGTH)]])
    return request.param, profile, formula, at, everywhere(profile, at)


def test_formula(sampled):
    name, _, formula, at, (drop, *_) = sampled
    inner = np.abs(at) < L / 2 * (1 - 1e-9) if name in LIMITED else at == at
    np.testing.assert_allclose(
        np.asarray(drop)[inner], formula(at[inner]), rtol=1e-9, atol=1e-18
    )


def test_shape(sampled):
    """Nothing removed in the middle, symmetric, convex, nowhere negative."""
    name, _, _, at, (drop, _, _) = sampled
    drop = np.asarray(drop)
    # Exactly zero; a table of the parabola blends numbers of some micrometres.
    assert np.all(
        np.abs(drop[len(GRID) : len(GRID) + 2]) <= (name == "tabulated") * 1e-20
    )
    on_grid = drop[: len(GRID)]
    assert np.all(on_grid >= 0) and np.all(np.isfinite(on_grid))
    np.testing.assert_allclose(on_grid, on_grid[::-1], rtol=1e-9, atol=1e-18)
    bend = np.diff(on_grid, 2)
    # Round-off of a drop of some micrometres.
    assert np.all(bend >= -1e-19 - 4 * np.finfo(float).eps * np.max(on_grid[1:-1]))


def test_derivatives_are_finite_everywhere(sampled):
    """Ends, kinks and middle included."""
    name, _, _, at, (_, first, second) = sampled
    assert np.all(np.isfinite(first)) and np.all(np.isfinite(second))
    if name != "tabulated":
        # Convex by its own derivative too; a limited end is flat.
        inner = np.abs(at) < L / 2 * (1 - 1e-9)
        assert np.all(np.asarray(second)[inner] >= 0)
    assert np.asarray(first)[len(GRID)] == pytest.approx(0.0, abs=1e-15)


def test_derivatives_against_differences(sampled):
    """Between the kinks, away from the ends."""
    name, profile, _, at, _ = sampled
    s = np.array([-0.93, -0.71, -0.3, 0.11, 0.55, 0.88]) * L / 2
    step = 1e-6 * L
    _, first, second = everywhere(profile, s)
    ends = [everywhere(profile, x) for x in (s + step, s - step)]
    for order, got in ((0, first), (1, second)):
        difference = np.asarray(ends[0][order] - ends[1][order]) / (2 * step)
        size = np.max(np.abs(difference)) + 1e-30
        assert np.max(np.abs(got - difference)) / size < DIFFERENCE


def test_kinks(sampled):
    name, profile, *_ = sampled
    kinks = [float(k) for k in profile.kinks(LENGTH)]
    np.testing.assert_allclose(kinks, KINKS.get(name, ()), rtol=ROUNDING)
    assert np.all(np.diff(kinks) > 0)
    # The second derivative does jump there, and the first does not.
    for kink in kinks:
        _, first, second = everywhere(profile, kink + np.array([-1e-9, 1e-9]))
        assert abs(second[1] - second[0]) > 1e-3 * np.max(np.abs(second))
        assert abs(first[1] - first[0]) < 1.5e-9 * 2 * np.max(np.abs(second))


def test_derivatives_by_every_parameter(sampled):
    """Finite at ends, kinks and middle; right where a difference can tell."""
    name, profile, _, _, _ = sampled
    numbers, structure = jax.tree.flatten((profile, LENGTH, DIAMETER))
    kinks = [float(k) for k in profile.kinks(LENGTH)]
    at = jnp.asarray([-L / 2, 0.0, L / 2, *kinks, 0.4 * L, -0.31 * L])
    sure = slice(len(at) - 2, None)

    def drop(numbers):
        profile, length, diameter = jax.tree.unflatten(structure, numbers)
        return profile.drop(at, length, diameter)

    call = jax.jit(drop)
    slopes = jax.jit(jax.jacfwd(drop))(numbers)
    for i, slope in enumerate(slopes):
        assert np.all(np.isfinite(slope))
        if numbers[i].ndim:
            continue  # a table: its derivative is the next test's
        step = 1e-6 * float(numbers[i])
        ends = [
            call([x + (side * step if j == i else 0.0) for j, x in enumerate(numbers)])
            for side in (1.0, -1.0)
        ]
        difference = np.asarray(ends[0] - ends[1])[sure] / (2 * step)
        size = np.max(np.abs(difference)) + float(jnp.max(ends[0]) / numbers[i]) * 1e-3
        assert np.max(np.abs(slope[sure] - difference)) <= 1e-5 * size + 1e-30


def test_end_drops():
    """What the makers of the profiles state about the very end."""
    end = np.array([-L / 2, L / 2])
    got = everywhere(PROFILES["Fujiwara-Kawase"][0], end)[0]
    np.testing.assert_allclose(got, 20e-6, rtol=1e-9)
    got = everywhere(PROFILES["Johns-Gohar"][0], end)[0]
    want = UNIT * np.log(1 / (0.3033 * 1e-4 / (L / 2)))
    np.testing.assert_allclose(got, want, rtol=1e-9)
    for name in LIMITED:
        got = everywhere(PROFILES[name][0], end)[0]
        unit = UNIT if name == "Lundberg" else 0.00035 * D
        # A logarithm of the root of the smallest number.
        limit = -0.5 * np.log(np.finfo(float).tiny)
        np.testing.assert_allclose(got, limit * unit, rtol=1e-9)


def test_one_rounding_off_the_end_is_the_end_in_float32():
    """ln 2^63 was left at the end, 0.13 mm, and tilted rollers reached it: an edge of
    3 GPa where float64 has none, whose limit is used now."""
    dtype = "float32"
    length, diameter = jnp.asarray(0.0115, dtype), jnp.asarray(0.0082, dtype)
    profile = Logarithmic(jnp.asarray(3.5e-4, dtype))
    end = 0.5 * length
    beside = jnp.nextafter(end, jnp.zeros_like(end))
    drop = profile.drop(jnp.stack([-end, -beside, beside, end]), length, diameter)
    assert drop.dtype == dtype
    np.testing.assert_allclose(drop, 354.198209 * 3.5e-4 * 0.0082, rtol=1e-6)


def test_iso_coefficient():
    assert float(Logarithmic().coefficient) == 0.00035
    # Half way to the end, 0.00035 D ln(4/3).
    got = Logarithmic().drop(0.25 * LENGTH, LENGTH, DIAMETER)
    np.testing.assert_allclose(got, 0.00035 * D * np.log(4 / 3), rtol=ROUNDING)


def test_crown_without_cancellation():
    """At 1 um from the middle of a 100 m arc: s²/2R to the last digit."""
    got = CircularCrown(100.0).drop(jnp.asarray(1e-6), LENGTH, DIAMETER)
    np.testing.assert_allclose(got, 5e-15, rtol=ROUNDING)


def test_tabulated_profile_is_smooth_through_points():
    """Through every point, and with one slope from one cubic to the next."""
    rng = np.random.default_rng(0)
    s = np.sort(rng.uniform(-0.9, 0.9, 9)) * L / 2
    s = np.concatenate([[-L / 2], s, [L / 2]])
    d = 1e-6 * rng.uniform(0.0, 5.0, s.size)
    profile = Tabulated(s, d)
    got, slope, _ = everywhere(profile, s)
    np.testing.assert_allclose(got, d, rtol=1e-9, atol=1e-18)
    # That of the parabola through three points.
    i = 4
    want = np.polyder(np.polyfit(s[i - 1 : i + 2] - s[i], d[i - 1 : i + 2], 2))[-1]
    np.testing.assert_allclose(slope[i], want, rtol=1e-9)
    gap = np.min(np.diff(s)) * 1e-7
    left, right = (everywhere(profile, s[1:-1] + side * gap) for side in (-1, 1))
    for a, b in zip(left[:2], right[:2], strict=True):
        # The second derivative is finite: the jump is as small as the gap.
        assert np.max(np.abs(a - b)) < 1e-4 * np.max(np.abs(a))


def test_tabulated_profile_around_matches_drop():
    """`around` one position per interval, many at once; and past the ends."""
    points = np.array([-0.6, -0.2, 0.1, 0.55]) * L
    profile = Tabulated(points, 1e-6 * np.array([3.0, 0.0, 1.0, 2.0]))
    t = jnp.linspace(0.0, 1.0, 5)[None]
    s = points[:-1, None] + np.diff(points)[:, None] * t
    got = profile.between_knots(jnp.mean(s, axis=1, keepdims=True)).drop(
        s, LENGTH, DIAMETER
    )
    want = profile.drop(s, LENGTH, DIAMETER)
    np.testing.assert_allclose(got, want, rtol=1e-9, atol=1e-18)


def test_tabulated_profile_is_linear_in_drops():
    """The derivative by the drops is a partition of unity."""
    s = jnp.linspace(-L / 2, L / 2, 41)
    table = jnp.asarray(TABLE)

    def drop(d):
        return Tabulated(table, d).drop(s, LENGTH, DIAMETER)

    slope = jax.jit(jax.jacfwd(drop))(jnp.asarray(0.5 * TABLE**2))
    np.testing.assert_allclose(jnp.sum(slope, axis=1), 1.0, rtol=ROUNDING)
    np.testing.assert_allclose(
        slope @ jnp.asarray(TABLE**2), np.asarray(s) ** 2, rtol=1e-9, atol=1e-18
    )


def test_fujiwara_kawase_end_drop_at_sharp_ends():
    """Beyond 37 A the argument of the logarithm is lost against 1 unless it is built
    up from the end; beyond some 350 A the drop is limited."""
    unit = 1e3 / (np.pi * L * 206e9 / (2 * (1 - 0.3**2)))
    for ratio in (1.0, 36.0, 40.0, 300.0):
        profile = FujiwaraKawase(1e3, 1.0, 0.4, ratio * unit)
        ends = jnp.array([-0.5, 0.5]) * L

        def drop(zm, profile=profile, ends=ends):
            changed = FujiwaraKawase(profile.design_load, 1.0, 0.4, zm)
            return changed.drop(ends, jnp.asarray(L), jnp.asarray(D))

        got, slope = jax.jvp(drop, (profile.end_drop,), (jnp.ones(()),))
        assert np.allclose(got, ratio * unit, rtol=1e-12)
        assert np.allclose(slope, 1.0, rtol=1e-12)
    assert np.all(np.isfinite(drop(jnp.asarray(1e-3))))

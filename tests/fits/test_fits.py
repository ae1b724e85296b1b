"""Fits against Lamé's formulas by hand, closed forms for steel, and limits."""

from dataclasses import replace
from itertools import product

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from slopes import with_slopes
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.design import Material
from bearingjax.fits import (
    FitConditions,
    Limits,
    Mounting,
    WarmMaterial,
    ball_clearance,
    bore_limits,
    clearance_range,
    fit_state,
    limits,
    needed_drive_up,
    outside_limits,
)
from bearingjax.fits.fits import smoothing

MICRON = 1e-6
ALUMINIUM = WarmMaterial(Material(70e9, 0.33, 2700.0), 23e-6)
HARD = WarmMaterial(Material(1e22, 0.3), 12e-6)
LOOSE = -10 * MICRON

state = eqx.filter_jit(fit_state)
scatter = eqx.filter_jit(clearance_range)


def mounting(**changes):
    """A 6205 of raceways about a pitch diameter of 38.5 mm, balls of 7.94 mm."""
    design = Mounting(
        bore=0.025,
        inner_raceway=0.03056,
        outer_raceway=0.04645,
        outside_diameter=0.052,
        housing_diameter=0.080,
        radial_clearance=12.5 * MICRON,
        shaft_interference=10 * MICRON,
        housing_interference=LOOSE,
    )
    return replace(design, **changes)


def taken(found, design=None):
    """Clearance that fits and temperatures take."""
    design = mounting() if design is None else design
    return float(design.radial_clearance - found.radial_clearance)


def test_a_solid_shaft_of_steel():
    found = state(mounting(), FitConditions())
    # Of one material the raceway grows by d/F of the interference.
    growth = 10 * MICRON * 25 / 30.56
    np.testing.assert_allclose(found.inner_raceway_growth, growth, rtol=ROUNDING)
    np.testing.assert_allclose(taken(found), growth, rtol=1e-9)  # 1e-5 less 8e-6
    # p = I E (1 - k²)/(2 d)
    pressure = 10e-6 * 206e9 * (1 - (25 / 30.56) ** 2) / (2 * 0.025)
    np.testing.assert_allclose(found.shaft_pressure, pressure, rtol=ROUNDING)
    assert found.housing_pressure == 0 and found.outer_raceway_growth == 0


def test_a_hollow_shaft_of_steel():
    found = state(mounting(shaft_bore=0.020), FitConditions())
    k, k0 = 25 / 30.56, 20 / 25
    growth = 10 * MICRON * k * (1 - k0**2) / (1 - k**2 * k0**2)
    np.testing.assert_allclose(found.inner_raceway_growth, growth, rtol=ROUNDING)


def test_a_housing_of_steel():
    tight = mounting(shaft_interference=LOOSE, housing_interference=10 * MICRON)
    found = state(tight, FitConditions())
    h, h0 = 46.45 / 52, 52 / 80
    loss = 10 * MICRON * h * (1 - h0**2) / (1 - h**2 * h0**2)
    np.testing.assert_allclose(found.outer_raceway_growth, -loss, rtol=ROUNDING)
    assert found.shaft_pressure == 0 and found.inner_raceway_growth == 0


def test_both_fits_of_other_materials():
    design = mounting(
        shaft_bore=0.010, housing_interference=20 * MICRON, housing=ALUMINIUM
    )
    found = state(design, FitConditions())
    # Radial displacements u(r) = (1 - ν) A r + (1 + ν) B/r, with A and B of stresses
    # E (A ∓ B/r²), from pressures on both sides.
    assert np.isclose(
        lame(0.005, 0.0125, 0.0, found.shaft_pressure, 206e9, 0.3, 0.0125) + 5 * MICRON,
        lame(0.0125, 0.01528, found.shaft_pressure, 0.0, 206e9, 0.3, 0.0125),
        rtol=1e-12,
        atol=0,
    )
    assert np.isclose(
        lame(0.023225, 0.026, 0.0, found.housing_pressure, 206e9, 0.3, 0.026)
        + 10 * MICRON,
        lame(0.026, 0.040, found.housing_pressure, 0.0, 70e9, 0.33, 0.026),
        rtol=1e-12,
        atol=0,
    )
    raceways = (
        2 * lame(0.0125, 0.01528, found.shaft_pressure, 0.0, 206e9, 0.3, 0.01528),
        2 * lame(0.023225, 0.026, 0.0, found.housing_pressure, 206e9, 0.3, 0.023225),
    )
    np.testing.assert_allclose(found.inner_raceway_growth, raceways[0], rtol=1e-12)
    np.testing.assert_allclose(found.outer_raceway_growth, raceways[1], rtol=1e-12)
    np.testing.assert_allclose(taken(found), raceways[0] - raceways[1], rtol=1e-9)


def lame(inside, outside, within, without, modulus, nu, radius):
    """Radial displacement of a thick cylinder in plane stress, by its two constants."""
    a2, b2 = inside**2, outside**2
    mean = (within * a2 - without * b2) / (b2 - a2)
    shear = (within - without) * a2 * b2 / (b2 - a2)
    return ((1 - nu) * mean * radius + (1 + nu) * shear / radius) / modulus


def test_a_thin_ring_on_a_hard_shaft_takes_all_interference():
    thin = mounting(inner_raceway=0.025 * (1 + 1e-7), shaft=HARD)
    found = state(thin, FitConditions())
    np.testing.assert_allclose(found.inner_raceway_growth, 10 * MICRON, rtol=1e-6)


def test_a_rigid_housing():
    design = mounting(
        shaft_interference=LOOSE, housing_interference=10 * MICRON, housing=HARD
    )
    found = state(design, FitConditions())
    # All of the interference is pressed into the ring: hollow, free inside.
    h = 46.45 / 52
    loss = 10 * MICRON * 2 * h / ((1 + h**2) - 0.3 * (1 - h**2))
    np.testing.assert_allclose(-found.outer_raceway_growth, loss, rtol=1e-9)


def test_equal_temperatures_of_equal_materials_change_only_the_clearance():
    warm = FitConditions(*5 * [60.0])
    cold, hot = state(mounting(), FitConditions()), state(mounting(), warm)
    np.testing.assert_allclose(hot.shaft_pressure, cold.shaft_pressure, rtol=1e-9)
    # The clearance grows like all lengths; its own is a share of 7e-4 of 12.5 µm.
    np.testing.assert_allclose(
        hot.radial_clearance - cold.radial_clearance,
        12.5 * MICRON * 60 * 12e-6,
        rtol=1e-6,
    )


def test_a_warm_inner_ring_on_a_warm_shaft():
    # As catalogues have it: clearance falls by α ΔT of the outer raceway, with rolling
    # elements as warm as the inner ring.
    warm = FitConditions(shaft=10.0, inner_ring=10.0, elements=10.0)
    loss = taken(state(mounting(), warm)) - taken(state(mounting(), FitConditions()))
    np.testing.assert_allclose(loss, 12e-6 * 10 * (0.04645 - 12.5 * MICRON), rtol=1e-9)


def test_true_temperatures_are_rises_above_the_reference():
    rises = FitConditions(10.0, 12.0, 8.0, 5.0, 0.0, 300.0)
    true = FitConditions(303.0, 305.0, 301.0, 298.0, 293.0, 300.0, reference=293.0)
    for one, other in zip(
        state(mounting(), rises), state(mounting(), true), strict=True
    ):
        np.testing.assert_allclose(one, other, rtol=1e-12)


def test_an_aluminium_housing_lets_go_when_warm():
    design = mounting(housing_interference=20 * MICRON, housing=ALUMINIUM)
    warm = FitConditions(outer_ring=60.0, housing=60.0)
    found = state(design, warm)
    left = 20 * MICRON - 0.052 * 60 * (23e-6 - 12e-6)
    np.testing.assert_allclose(found.housing_interference, left, rtol=1e-9)
    assert left < 0 and found.housing_pressure == 0


def test_fit_state_growth_of_rotating_ring():
    speed = 3000.0
    loose = mounting(shaft_interference=-1e-4)
    found = state(loose, FitConditions(speed=speed))
    # Thin: ρ ω² r³/E; the thick ring is between those of its two radii.
    free = [2 * 7850 * speed**2 * r**3 / 206e9 for r in (0.0125, 0.01528)]
    assert free[0] < found.inner_raceway_growth < free[1]
    # Equation of motion: stress of the ring by summing up its equilibrium in layers.
    growth = 2 * spun(0.0125, 0.01528, speed)
    np.testing.assert_allclose(found.inner_raceway_growth, growth, rtol=1e-5)
    thin = mounting(inner_raceway=0.025 * (1 + 1e-7), shaft_interference=-1e-4)
    found = state(thin, FitConditions(speed=speed))
    np.testing.assert_allclose(found.inner_raceway_growth, free[0], rtol=1e-6)


def spun(inside, outside, speed, layers=2000):
    """Displacement of the outer surface of a ring that rotates, by finite differences.

    u'' + u'/r - u/r² + (1 - ν²) ρ ω² r/E = 0, radial stress zero at both surfaces.
    """
    nu, force = 0.3, (1 - 0.3**2) * 7850 * speed**2 / 206e9
    r = np.linspace(inside, outside, layers + 1)
    step = r[1] - r[0]
    matrix = np.zeros((layers + 3, layers + 3))
    right = np.zeros(layers + 3)
    for i, at in enumerate(r):  # unknowns begin one step before the first surface
        matrix[i, i : i + 3] = (
            1 / step**2 - 1 / (2 * step * at),
            -2 / step**2 - 1 / at**2,
            1 / step**2 + 1 / (2 * step * at),
        )
        right[i] = -force * at
    for row, i in ((layers + 1, 0), (layers + 2, layers)):
        matrix[row, i : i + 3] = -1 / (2 * step), nu / r[i], 1 / (2 * step)
    return np.linalg.solve(matrix, right)[layers + 1]


def test_speed_loosens_the_ring():
    still = state(mounting(), FitConditions())
    fast = state(mounting(), FitConditions(speed=6000.0))
    assert 0 < fast.shaft_pressure < still.shaft_pressure
    assert fast.inner_raceway_growth > still.inner_raceway_growth


def test_smoothing_takes_interference():
    assert np.isclose(smoothing(4e-6, 2e-6), 2.4e-6)
    smooth = state(mounting(shaft_smoothing=2.4e-6), FitConditions())
    less = state(mounting(shaft_interference=7.6e-6), FitConditions())
    np.testing.assert_allclose(
        smooth.radial_clearance, less.radial_clearance, rtol=1e-12
    )


def test_slopes_are_those_of_differences():
    design = mounting(
        shaft_bore=0.010,
        housing_interference=40 * MICRON,
        housing=ALUMINIUM,
        shaft_smoothing=1 * MICRON,
        ring_width=0.015,
        bore_taper=1 / 30,
        drive_up=0.2e-3,
    )
    warm = FitConditions(30.0, 25.0, 22.0, 12.0, 8.0, 1500.0, 900.0)
    numbers, tree = jax.tree.flatten((design, warm))
    scale = np.array([float(n) for n in numbers])

    def clearance(x):
        return fit_state(*jax.tree.unflatten(tree, list(x))).radial_clearance

    one = with_slopes(clearance)
    slopes = np.array(one(jnp.array(scale))[0])
    for i, value in enumerate(scale):
        step = 1e-5 * (abs(value) if value else 1e-6)
        shift = step * np.eye(len(scale))[i]
        ends = [float(one(jnp.array(scale + s * shift))[1]) for s in (1, -1)]
        difference = (ends[0] - ends[1]) / (2 * step)
        # As changes of clearance by each step: numbers of no effect give 0 and 0.
        np.testing.assert_allclose(
            slopes[i] * step, difference * step, rtol=DIFFERENCE, atol=1e-18
        )
    assert (slopes != 0).sum() == len(scale) - 3  # elastic constants of elements


def sizes(shaft="k5", housing="H7"):
    return {
        "clearance": ball_clearance("CN", 0.025),
        "shaft": limits(shaft, 0.025),
        "bore": bore_limits(0.025),
        "housing": limits(housing, 0.052),
        "outside_diameter": outside_limits(0.052),
    }


def test_the_usual_fits_of_a_6205():
    found = scatter(mounting(), **sizes())
    # Shaft k5: 2 to 21 µm of interference, of which 25/30.56 reach the raceway; H7 is
    # loose or just closed.
    share = 25 / 30.56
    worst = np.array([5 - 21 * share, 20 - 2 * share]) * MICRON
    np.testing.assert_allclose(found.worst, worst, rtol=1e-9)
    np.testing.assert_allclose(found.middle, (12.5 - 11.5 * share) * MICRON, rtol=1e-9)
    half = np.sqrt(7.5**2 + share**2 * (4.5**2 + 5**2)) * MICRON
    np.testing.assert_allclose(
        found.probable, [found.middle - half, found.middle + half], rtol=1e-9
    )


def test_tight_housings_take_clearance():
    loose, tight = (scatter(mounting(), **sizes("k5", name)) for name in ("H7", "P7"))
    assert tight.worst.lower < loose.worst.lower
    assert tight.middle < loose.middle
    assert tight.worst.lower < tight.probable.lower < tight.middle


def test_the_probable_is_within_the_worst():
    # A loose shaft takes no clearance: the largest is that of the drawing.
    found = scatter(
        mounting(), **{**sizes("h5", "G7"), "clearance": Limits(1e-5, 1e-5)}
    )
    assert found.middle < found.worst.upper
    np.testing.assert_allclose(found.worst.upper, 1e-5, rtol=1e-12)
    np.testing.assert_allclose(found.probable.upper, 1e-5, rtol=1e-12)
    assert found.worst.lower < found.probable.lower < found.middle


def test_the_worst_cases_are_those_of_all_corners():
    given = sizes("m6", "P7")
    found = scatter(mounting(), **given)
    corners = [
        state(
            mounting(
                radial_clearance=clearance,
                shaft_interference=shaft - bore,
                housing_interference=outside - housing,
            ),
            FitConditions(),
        ).radial_clearance
        for clearance, shaft, bore, housing, outside in product(*given.values())
    ]
    np.testing.assert_allclose(found.worst, [min(corners), max(corners)], rtol=1e-9)


def test_slopes_of_a_range():
    def middle(diameter):
        return clearance_range(mounting(shaft_bore=diameter), **sizes()).middle

    slope = jax.grad(middle)(0.015)
    difference = (middle(0.015 + 1e-6) - middle(0.015 - 1e-6)) / 2e-6
    np.testing.assert_allclose(slope, difference, rtol=DIFFERENCE)


def driven(travel, taper=1 / 12, **changes):
    """The mounting with a tapered bore."""
    changes = {"shaft_interference": 0.0, **changes}
    return mounting(bore_taper=taper, drive_up=travel, **changes)


@pytest.mark.parametrize("taper", [1 / 12, 1 / 30])
def test_driving_up_is_an_interference(taper):
    """The raceway grows by d/F of the drive-up's interference, d in mid-bore."""
    np.testing.assert_allclose(
        state(driven(10e-6 / taper, taper), FitConditions()).radial_clearance,
        state(mounting(), FitConditions()).radial_clearance,
        rtol=ROUNDING,
    )
    wide = state(driven(10e-6 / taper, taper, ring_width=0.015), FitConditions())
    mean = 25.0 + 0.5 * taper * 15.0
    growth = 10 * MICRON * mean / 30.56
    np.testing.assert_allclose(wide.inner_raceway_growth, growth, rtol=ROUNDING)
    np.testing.assert_allclose(wide.shaft_interference, 10 * MICRON, rtol=ROUNDING)


def test_the_drive_up_of_a_reduction_is_the_inverse():
    rough = dict(shaft_bore=0.010, shaft_smoothing=2.4 * MICRON, ring_width=0.015)
    seats = driven(0.0, **rough)
    travel = needed_drive_up(seats, 7 * MICRON)
    found = state(replace(seats, drive_up=travel), FitConditions())
    np.testing.assert_allclose(taken(found), 7 * MICRON, rtol=1e-9)
    slope = jax.grad(
        lambda s: state(replace(seats, drive_up=s), FitConditions()).radial_clearance
    )(travel)
    steps = [
        float(
            state(replace(seats, drive_up=travel + h), FitConditions()).radial_clearance
        )
        for h in (-1e-5, 1e-5)
    ]
    np.testing.assert_allclose(slope, (steps[1] - steps[0]) / 2e-5, rtol=DIFFERENCE)
    # The slope of the inverse is the inverse slope.
    back = jax.grad(lambda x: needed_drive_up(seats, x))(7 * MICRON)
    np.testing.assert_allclose(-slope * back, 1.0, rtol=ROUNDING)


def test_drive_up_rejects_invalid_bores():
    with pytest.raises(
        ValueError, match="`drive_up` is 0.0001 m; it must be 0 m: a cy"
    ):
        mounting(drive_up=1e-4)
    with pytest.raises(
        ValueError, match="`drive_up` is 0.01 m; it must be below 0.003"
    ):
        driven(0.01)
    with pytest.raises(
        ValueError, match="`bore_taper` is 12; it must be at least 0 an"
    ):
        driven(1e-4, taper=12.0)
    with pytest.raises(
        ValueError, match="`bore_taper`.*mean bore is below the raceway"
    ):
        driven(0.0, taper=0.2, ring_width=0.06)
    with pytest.raises(ValueError, match="needed_drive_up: `bore_taper` is 0"):
        needed_drive_up(mounting(), 1e-6)
    with pytest.raises(
        ValueError, match="`reduction` is -1e-06 m; it must be at least"
    ):
        needed_drive_up(driven(0.0), -1e-6)


def test_fits_reject_invalid_arguments(untyped):
    with pytest.raises(
        ValueError, match="Mounting: `inner_raceway`.*above `bore`, 0.025"
    ):
        mounting(inner_raceway=0.02)
    with pytest.raises(
        ValueError, match="`housing_diameter`.*above `outside_diameter`"
    ):
        mounting(housing_diameter=0.05)
    with pytest.raises(ValueError, match="`shaft_bore` is 0.03 m"):
        mounting(shaft_bore=0.03)
    with pytest.raises(ValueError, match="`shaft_smoothing` is -1e-06 m"):
        mounting(shaft_smoothing=-1e-6)
    with pytest.raises(ValueError, match="`radial_clearance`.*finite"):
        mounting(radial_clearance=np.nan)
    with pytest.raises(ValueError, match="FitConditions: `speed`.*finite"):
        FitConditions(speed=np.inf)
    with pytest.raises(
        ValueError, match="`shaft` is 0 K; it must be from -280 to 1500 K above `refer"
    ):
        FitConditions(inner_ring=320.0, reference=293.0)
    with pytest.raises(ValueError, match="smoothing: `ring` is -1e-06 m"):
        smoothing(1e-6, -1e-6)
    with pytest.raises(TypeError, match="`mounting` is a NoneType; it must be Mount"):
        fit_state(None)  # pyright: ignore[reportArgumentType]
    with pytest.raises(TypeError, match="`conditions` is a float; it must be FitCond"):
        fit_state(mounting(), 40.0)  # pyright: ignore[reportArgumentType]
    for clearance, wanted in (
        (12e-6, "`clearance` is 1.2e-05; it must be Limits, two numbers in m"),
        (Limits(5, 20), "`clearance` is 5 m; it must be above -0.01 and below 0.01 m"),
        (Limits(np.nan, 1e-6), "`clearance` is nan m; it must be a finite number"),
        (Limits("5", "20"), "`clearance` is '5'; it must be a number in m"),
    ):
        with pytest.raises((TypeError, ValueError), match=wanted):
            clearance_range(mounting(), **{**sizes(), "clearance": clearance})
    with pytest.raises(ValueError, match="`bore` is 1e-06 to 0 m.*lower limit"):
        clearance_range(mounting(), **{**sizes(), "bore": Limits(1e-6, 0.0)})

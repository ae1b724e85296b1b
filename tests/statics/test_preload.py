"""Preload by force and by spring."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj

STILL = jnp.zeros(12)


@pytest.fixture(scope="module")
def pair():
    return bj.BearingElement(bj.BearingSet.back_to_back(balls(), 0.02))


@eqx.filter_jit
def evaluate(element, q):
    model = element.model()
    solved = model.solve(q)
    axial = jnp.stack([force[8] for force in forces_of_rows(model, q, solved)])
    return model.evaluate(q, solved), axial, model.results(q, solved)


def forces_of_rows(model, q, solved):
    """What each row alone passes to the rings."""
    parts = zip(model.rows, *(model.in_order(part) for part in solved), strict=True)
    return [jax.grad(row.energy)(q, azimuth, state) for row, azimuth, state in parts]


def test_each_side_carries_the_preload(pair):
    ground = bj.preload(pair, 400.0)
    e, axial, _ = evaluate(ground, STILL)
    assert np.allclose(axial, [400.0, -400.0], rtol=1e-9)
    assert np.abs(np.asarray(e.force)).max() < 1e-6
    # A pair already pressed is pressed to the same force, from where it is.
    pressed = bj.BearingElement(bj.BearingSet.back_to_back(balls(), 0.02, 3e-6))
    again = bj.preload(pressed, 400.0)
    for one, other in zip(ground.bearing.rows, again.bearing.rows, strict=True):
        assert float(one.inner_offset) == pytest.approx(
            float(other.inner_offset), rel=1e-9
        )


@pytest.mark.slow
def test_preload_of_unlike_sides():
    """Two rows against one: together they carry what the other one carries."""
    one, other = balls(), balls(8, contact_angle=0.3)
    rows = (
        bj.SetRow(one, -0.03),
        bj.SetRow(one, -0.01, inner_offset=2e-6),
        bj.SetRow(other, 0.02, mirrored=True),
    )
    ground = bj.preload(bj.BearingElement(bj.BearingSet(rows)), 600.0)
    _, axial, _ = evaluate(ground, STILL)
    assert float(axial[0] + axial[1]) == pytest.approx(600.0, rel=1e-9)
    assert float(axial[2]) == pytest.approx(-600.0, rel=1e-9)
    # The second row was 2 um ahead, and stays so.
    offsets = [float(row.inner_offset) for row in ground.bearing.rows]
    assert offsets[1] - offsets[0] == pytest.approx(2e-6, rel=1e-9)
    assert float(axial[1]) > float(axial[0])


@pytest.mark.slow
def test_offset_follows_force_and_design(pair):
    """Closed form: rows of n balls pressed axially; its slope, by differences."""

    def offset(force, angle):
        changed = bj.BearingSet.back_to_back(balls(contact_angle=angle), 0.02)
        element = eqx.tree_at(lambda e: e.bearing, pair, changed)
        return bj.preload(element, force).bearing.rows[0].inner_offset * 1e6

    at = (jnp.asarray(400.0), jnp.asarray(0.4))
    slopes = jax.grad(offset, argnums=(0, 1))(*at)
    for k, step in enumerate((1e-2, 1e-6)):
        moved = [
            offset(*(v + sign * step * (i == k) for i, v in enumerate(at)))
            for sign in (1, -1)
        ]
        slope = float(moved[0] - moved[1]) / (2 * step)
        assert float(slopes[k]) == pytest.approx(slope, rel=1e-6)


SPRUNG = {
    "balls, soft": (balls(), bj.PreloadSpring(300.0, 8e4)),
    "balls, constant": (balls(), bj.PreloadSpring(300.0)),
}


@pytest.fixture(scope="module", params=SPRUNG)
def sprung(request):
    bearing, spring = SPRUNG[request.param]
    pair = bj.BearingSet.face_to_face(bearing, 0.03, spring=spring)
    return bj.BearingElement(pair), spring


def push(spring, travel):
    return max(float(spring.force) - float(spring.stiffness) * travel, 0.0)


def test_sprung_row_load_equals_spring_force(sprung):
    element, spring = sprung
    for way in (0.0, 5e-6, -2e-5, -2e-4):
        e, axial, rows = evaluate(element, STILL.at[8].set(way))
        assert int(e.result) == bj.Result.CONVERGED
        row = rows[1]
        travel = float(row.travel)
        # In X arrangement the row at +z faces +z.
        assert float(axial[1]) == pytest.approx(push(spring, travel), rel=1e-9)
    # The ring slides after its row: the travel makes up for the way.
    start = float(evaluate(element, STILL)[2][1].travel)
    assert travel == pytest.approx(start + 2e-4, rel=1e-2)


def test_slack_spring():
    """Beyond its travel the spring does not pull, and the row passes nothing."""
    spring = bj.PreloadSpring(10.0, 1e6)  # slack after 10 um
    element = bj.BearingElement(bj.BearingSet.face_to_face(balls(), 0.03, 0.0, spring))
    e, axial, rows = evaluate(element, STILL.at[8].set(-30e-6))
    assert float(axial[1]) == 0.0 and int(e.result) == bj.Result.CONVERGED
    assert np.all(np.isfinite(e.stiffness))
    # Its energy is spent: force²/(2 stiffness).
    stored, _, _ = spring.push(rows[1].travel)
    assert float(stored) == pytest.approx(-(10.0**2) / 2e6, rel=1e-12)


def test_force_and_stiffness_are_derivatives(sprung):
    element, _ = sprung
    q = jnp.asarray([0.0] * 6 + [2e-6, -4e-6, 5e-6, 1e-4, -5e-5, 0.0])
    e, _, _ = evaluate(element, q)
    force, k = np.asarray(e.force), np.asarray(e.stiffness)

    @eqx.filter_jit
    def by_autodiff(element, q):
        along = jax.jvp(element.force, (q,), (q,))[1]
        return jax.grad(element.energy)(q), along

    gradient, along = by_autodiff(element, q)
    assert np.abs(gradient - force).max() < 10 * ROUNDING * np.abs(force).max()
    scale = np.abs(k @ np.asarray(q)).max()
    assert np.abs(along - k @ np.asarray(q)).max() < 10 * ROUNDING * scale
    step = 1e-9
    ends = [
        np.asarray(evaluate(element, q.at[8].add(sign * step))[0].force)
        for sign in (1, -1)
    ]
    slope = (ends[0] - ends[1]) / (2 * step)
    assert np.abs(slope - k[:, 8]).max() < 100 * DIFFERENCE * np.abs(k).max()


def test_load_solve_with_a_spring():
    """A load that closes the sprung row moves the shaft as the spring allows."""
    spring = bj.PreloadSpring(300.0, 8e4)
    element = bj.BearingElement(bj.BearingSet.back_to_back(balls(), 0.03, 0.0, spring))
    solutions = [
        bj.solve_load(element, [0.0, 0.0, axial, 0.0, 0.0, 0.0])
        for axial in (0.0, 100.0, -400.0)
    ]
    free, closed, opened = solutions
    # The fixed row takes what closes it; the spring then gives a little less.
    assert float(free.spring_force[1]) == pytest.approx(
        300.0 - 8e4 * float(free.spring_travel[1]), rel=1e-12
    )
    assert float(free.spring_force[0]) == 0.0
    assert 0 < float(closed.displacement[8] - free.displacement[8]) < 5e-6
    # Against the spring: it alone holds 400 N, after 100 N/(80 N/mm) of travel.
    moved = -float(opened.displacement[8])
    assert float(opened.spring_force[1]) == pytest.approx(400.0, rel=1e-9)
    assert moved == pytest.approx(100.0 / 8e4, rel=0.03)
    assert float(opened.stiffness[8, 8]) == pytest.approx(8e4, rel=0.01)


@pytest.mark.slow
def test_remaining_preload_of_sets(pair):
    ground = bj.preload(pair, 400.0)
    left = remaining(ground)
    assert float(left) == pytest.approx(400.0, rel=1e-9)
    # Two rows against another one: the inner rings stand where both sides press alike.
    one, other = balls(), balls(8, contact_angle=0.3)
    uneven = bj.BearingSet(
        (
            bj.SetRow(one, -0.03, inner_offset=3e-6),
            bj.SetRow(one, -0.01, inner_offset=5e-6),
            bj.SetRow(other, 0.02, mirrored=True),
        )
    )
    element = bj.BearingElement(uneven)
    q = bj.solve_load(
        element, np.zeros(6), support=bj.Support(free=["uz"])
    ).displacement
    _, axial, _ = evaluate(element, q)
    assert float(axial[0] + axial[1]) == pytest.approx(-float(axial[2]), rel=1e-9)
    assert float(remaining(element)) == pytest.approx(-float(axial[2]), rel=1e-9)
    # With play there is none, and no slope.
    loose = bj.BearingElement(bj.BearingSet.back_to_back(balls(), 0.02, -4e-6))
    assert float(remaining(loose)) == 0.0


@eqx.filter_jit
def remaining(element):
    return bj.statics.remaining_preload(element, throw=False)


@pytest.mark.slow
def test_remaining_preload_gradient():
    """Of a pair it is the stiffness of one row, for half of the approach."""

    @eqx.filter_jit
    def both(offset):
        def force(offset):
            pair = bj.BearingSet.back_to_back(balls(), 0.02, offset)
            return bj.statics.remaining_preload(bj.BearingElement(pair))

        return jax.value_and_grad(force)(offset)

    for offset in (8e-6, -4e-6):
        slope = float(both(offset)[1])
        ends = [float(both(offset + sign * 1e-9)[0]) for sign in (1, -1)]
        difference = (ends[0] - ends[1]) / 2e-9
        assert slope == pytest.approx(difference, rel=1e-6, abs=1e-9)
    assert slope == 0.0


def test_remaining_preload_equals_spring_force(sprung):
    element, spring = sprung
    left = float(bj.statics.remaining_preload(element))
    q = bj.solve_load(
        element, np.zeros(6), support=bj.Support(free=["uz"])
    ).displacement
    travel = float(evaluate(element, q)[2][1].travel)
    assert left == pytest.approx(push(spring, travel), rel=1e-9)


ALIGNING = bj.SelfAligningBallRow(
    9, 0.046, 0.0087, inner_osculation=0.52, row_offset=0.006
)


def test_bad_input(pair):
    one_way = bj.BearingElement(bj.BearingSet.tandem(balls(), 0.02))
    roller = bj.CylindricalRollerBearing(6, 0.065, 0.01, 0.01)
    sprung = bj.BearingSet.back_to_back(balls(), 0.02, spring=bj.PreloadSpring(10.0))
    for element, problem in (
        (bj.BearingElement(balls()), "a bearing alone"),
        (one_way, "no rows face each other"),
        (bj.BearingElement(bj.BearingSet.back_to_back(roller, 0.02)), "no axial load"),
        (bj.BearingElement(sprung), "a spring presses a row"),
        (bj.BearingElement(bj.BearingSet.self_aligning(ALIGNING)), "one inner ring"),
    ):
        with pytest.raises(ValueError, match=problem):
            bj.preload(element, 100.0)
        if "spring" not in problem:
            with pytest.raises(ValueError, match=f"remaining_preload: .*{problem}"):
                bj.statics.remaining_preload(element)
    loose = bj.BearingSet.back_to_back(roller, 0.02, spring=bj.PreloadSpring(10.0))
    with pytest.raises(ValueError, match="row 1 has a spring, but holds no axial"):
        bj.solve_load(bj.BearingElement(loose), [0, -10.0, 0, 0, 0, 0])
    for force in (-1.0, 0.0, np.nan):
        with pytest.raises(ValueError, match="`force` is"):
            bj.preload(pair, force)
    with pytest.raises(TypeError, match="BearingElement"):
        bj.preload(pair.bearing, 100.0)
    with pytest.raises(ValueError, match="`force`"):
        bj.PreloadSpring(-5.0)
    with pytest.raises(ValueError, match="`stiffness`"):
        bj.PreloadSpring(5.0, -1.0)
    with pytest.raises(TypeError, match="spring"):
        bj.SetRow(balls(), spring=300.0)


def test_the_force_is_one_number(untyped, pair):
    """A list ended in an error of float()."""
    with pytest.raises(ValueError, match=r"preload: `force` has shape \(1,\)"):
        bj.preload(pair, [400.0])
    with pytest.raises(TypeError, match="preload: `force` is '400 N'"):
        bj.preload(pair, "400 N")

"""Identities of the element, over all registered bearings and both quadratures."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import bearings, motion, quadratures, speeds, taper
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj

CASES = [
    (name, rule, speed)
    for name in bearings()
    for rule in quadratures()
    for speed in speeds()
]


@pytest.fixture(scope="module", params=CASES, ids=lambda c: " / ".join(c))
def case(request):
    name, rule, speed = request.param
    element = bj.BearingElement(bearings()[name], quadrature=quadratures()[rule])
    return element, speeds()[speed]


@eqx.filter_jit
def evaluate(element, q, speed):
    return element.evaluate(q, speed)


@eqx.filter_jit
def by_autodiff(element, q, speed):
    energy = lambda q: element.energy(q, speed)  # noqa: E731
    return jax.grad(energy)(q), jax.hessian(energy)(q)


@eqx.filter_jit
def inertia_of(element, q, speed):
    row = element.row(q, speed)
    return row.inertia, row.transform


def scale_of(k):
    d = np.sqrt(np.maximum(np.diag(k), 0.0))
    largest = np.tile(np.repeat([d[[0, 1, 2]].max(), d[[3, 4]].max()], 3), 2)
    return np.outer(largest, largest)


def rigid_modes(bearing):
    """Common motions and spins that cost nothing (12, 7)."""
    modes = np.zeros((12, 7))
    for i in range(5):
        modes[[i, 6 + i], i] = 1.0
    modes[5, 5] = modes[11, 6] = 1.0
    return modes


def test_everything_at_a_loaded_point(case):
    element, speed = case
    q = jnp.asarray(motion())
    e = evaluate(element, q, speed)
    force, k = np.asarray(e.force), np.asarray(e.stiffness)
    assert int(e.result) == bj.Result.CONVERGED
    assert np.abs(force).max() > 100.0  # the case must load something

    gradient, hessian = map(np.asarray, by_autodiff(element, q, speed))
    # The rule of the contact makes the two equal to round-off, in both quadratures.
    assert np.abs(gradient - force).max() < ROUNDING * np.abs(force).max()
    assert (np.abs(hessian - k) / scale_of(k)).max() < ROUNDING
    assert (np.abs(k - k.T) / scale_of(k)).max() < ROUNDING
    assert np.all(k[[5, 11]] == 0) and np.all(k[:, [5, 11]] == 0)

    moved = k @ rigid_modes(element.bearing) / np.sqrt(scale_of(k).diagonal())[:, None]
    assert np.abs(moved).max() < ROUNDING * np.sqrt(scale_of(k).max())

    # Rings and inertia of the row balance, forces and moments at the origin.
    inertia, transform = inertia_of(element, q, speed)
    total = force[:6] + force[6:]
    if inertia is not None:
        total = total + np.einsum("lai,a->i", transform[:, :3, :6], inertia)
    assert np.abs(total).max() < ROUNDING * np.abs(force).max()


def test_differences_are_v_shaped(case):
    """The error of central differences falls with the step, then round-off lifts it."""
    element, speed = case
    q = motion()
    way = np.tile(np.repeat([1.0, 40.0], 3), 2) * np.random.default_rng(1).uniform(
        -1, 1, 12
    )
    way[[5, 11]] = 0.0
    exact = evaluate(element, jnp.asarray(q), speed)
    slope = float(exact.force @ way)
    bend = np.asarray(exact.stiffness @ way)
    errors = []
    for step in 10.0 ** -np.arange(6.0, 12.5, 1.0):
        far = [
            evaluate(element, jnp.asarray(q + s * step * way), speed) for s in (1, -1)
        ]
        energy = (float(far[0].energy) - float(far[1].energy)) / (2 * step)
        force = (np.asarray(far[0].force) - np.asarray(far[1].force)) / (2 * step)
        errors.append(
            [
                abs(energy - slope) / abs(slope),
                np.abs(force - bend).max() / np.abs(bend).max(),
            ]
        )
    errors = np.array(errors)
    for column in errors.T:
        best = column.argmin()
        assert column[best] < DIFFERENCE
        assert column[0] > 3 * column[best] and column[-1] > 3 * column[best]


def test_common_rigid_motion_and_turn_by_one_pitch(case):
    element, speed = case
    q = motion()
    e = evaluate(element, jnp.asarray(q), speed)
    together = np.tile([3e-5, -2e-5, 1e-5, 2e-4, -3e-4, 0.0], 2)
    moved = evaluate(element, jnp.asarray(q + together), speed)
    difference = float(moved.energy - e.energy)
    if speed is not None:
        # The potential of the inertia force falls with the common motion.
        inertia, transform = inertia_of(element, jnp.asarray(q), speed)
        difference += float(
            np.einsum("lai,a,i->", transform[:, :3, :6], inertia, together[:6])
        )
    assert abs(difference) < SOLVER * abs(float(e.energy))

    # Turning both rings by one pitch angle carries each roller to the next place.
    turned = q.copy()
    turned[[5, 11]] = 2 * np.pi / element.bearing.n_rollers
    t = evaluate(element, jnp.asarray(turned), speed)
    assert np.allclose(t.force, e.force, rtol=0, atol=SOLVER * np.abs(e.force).max())


def test_zero_when_apart_and_finite_at_zero(case):
    element, speed = case
    bearing = element.bearing
    for q in (np.zeros(12), motion(), 1e3 * motion()):
        gradient, hessian = by_autodiff(element, jnp.asarray(q), speed)
        assert np.all(np.isfinite(gradient)) and np.all(np.isfinite(hessian))
    if speed is None and isinstance(bearing, bj.TaperedRollerBearing):
        apart = np.zeros(12)
        apart[8] = -1e-3
        e = evaluate(element, jnp.asarray(apart), speed)
        assert float(e.energy) == 0.0
        assert np.all(np.asarray(e.force) == 0) and np.all(np.asarray(e.stiffness) == 0)


def test_nan_in_nan_or_failure_out(case):
    element, speed = case
    q = motion()
    q[7] = np.nan
    e = evaluate(element, jnp.asarray(q), speed)
    assert int(e.result) == bj.Result.NON_FINITE
    assert not np.all(np.isfinite(e.force))


def test_free_rollers_carry_nothing():
    """AF000-14: clearance and no load: P* = 0, K* = 0, no NaN in any derivative."""
    bearing = bj.CylindricalRollerBearing(
        7, 0.0725, 0.014, 0.01372, radial_internal_clearance=20e-6
    )
    for rule in quadratures().values():
        element = bj.BearingElement(bearing, quadrature=rule)
        for q in (np.zeros(12), np.eye(12)[6] * 3e-6):
            e = evaluate(element, jnp.asarray(q), None)
            assert float(e.energy) == 0.0
            assert np.all(np.asarray(e.force) == 0)
            assert np.all(np.asarray(e.stiffness) == 0)
            gradient, hessian = by_autodiff(element, jnp.asarray(q), None)
            assert np.all(np.asarray(gradient) == 0)
            assert np.all(np.asarray(hessian) == 0)


def test_vmap_is_a_loop_and_jit_is_eager():
    element = bj.BearingElement(taper(5), quadrature=bj.ContactMapped(8))
    qs = jnp.asarray(np.stack([motion(seed) for seed in range(3)]))
    batch = eqx.filter_jit(eqx.filter_vmap(lambda q: element.evaluate(q)))(qs)
    for i in range(3):
        one = evaluate(element, qs[i], None)
        assert np.allclose(batch.force[i], one.force, rtol=SOLVER, atol=1e-9)
        scale = np.asarray(scale_of(np.asarray(one.stiffness)))
        assert np.max(np.abs(batch.stiffness[i] - one.stiffness) / scale) < SOLVER
    with jax.disable_jit(False):
        eager = element.force(qs[0])
    assert np.allclose(eager, batch.force[0], rtol=SOLVER, atol=1e-9)


def test_absent_term_is_a_term_of_zero():
    """Ribs that cannot be reached, and speed zero, change nothing."""
    q = jnp.asarray(motion())
    plain = bearings()["cylindrical, crowned ends"]
    far = bj.Ribs.arrangement("NUP", bj.Rib(0.3, 1.5e-3), 4.0)
    with_ribs = eqx.tree_at(lambda b: b.ribs, plain, far)
    a = evaluate(bj.BearingElement(plain), q, None)
    b = evaluate(bj.BearingElement(with_ribs), q, None)
    c = evaluate(bj.BearingElement(plain), q, bj.Speed(0.0, 0.0))
    for other in (b, c):
        assert np.allclose(a.force, other.force, rtol=SOLVER, atol=1e-9)
        scale = scale_of(np.asarray(a.stiffness))
        assert np.max(np.abs(a.stiffness - other.stiffness) / scale) < SOLVER


def test_one_trace_for_ten_designs():
    @eqx.filter_jit
    @eqx.debug.assert_max_traces(max_traces=1)
    def force(element, q):
        return element.force(q)

    for i in range(10):
        bearing = taper(5, radial_internal_clearance=1e-6 * i)
        force(
            bj.BearingElement(bearing, quadrature=bj.Midpoint(4)),
            jnp.asarray(motion(i)),
        )

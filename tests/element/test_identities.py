"""Identities of the element, over all registered bearings and both quadratures."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import (
    ball_elements,
    bearings,
    holds,
    motion,
    quadratures,
    speeds,
    taper,
)
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.design import rows_of
from bearingjax.element import inertia_load

CASES = [
    (name, rule, speed)
    for name in bearings()
    for rule in quadratures()
    for speed in speeds()
    # With inertia one rule will do: it knows nothing of the quadrature.
    if holds(name, speed) and (rule, speed) != ("midpoint", "turning")
]


CASES += [(name, "", speed) for name, (_, speed) in ball_elements().items()]

# One of each kind; every other design compiles programs of its own, as long as these.
QUICK = {
    ("cylindrical, crowned ends", "midpoint", "still"),
    ("taper, large rib", "contact_mapped", "still"),
    ("taper, large rib", "contact_mapped", "turning"),
    ("deep groove, clearance", "", "still"),
    ("four-point, unlike balls, load share", "", "turning"),
    ("ball pair, O", "", "turning"),
}
QUICK_DESIGNS = {"taper, large rib", "deep groove, clearance"}


def marked(values, quick):
    """Parameters, of which all but the quick ones are slow."""
    slow = pytest.mark.slow
    return [pytest.param(v, marks=[] if v in quick else slow) for v in values]


# Each design once: equal slices have no smooth stiffness, and a program costs seconds.
DESIGNS = {c[0]: (c, c[2] == "turning") for c in CASES if c[1] != "midpoint"}
"""Name to case, and whether its derivatives see how the turns of the rings carry the
elements along."""
DESIGNS["cage torque"] = DESIGNS["deep groove, clearance"][0], True


def named(case):
    return " / ".join(filter(None, case))


def made(name, rule, speed):
    if name in ball_elements():
        return ball_elements()[name][0], speeds()[speed]
    element = bj.BearingElement(bearings()[name], quadrature=quadratures()[rule])
    return element, speeds()[speed]


@pytest.fixture(scope="module", params=marked(CASES, QUICK), ids=named)
def case(request):
    return made(*request.param)


@eqx.filter_jit
def _evaluate(element, q, speed):
    model = element.model(speed)
    solved = model.solve(q)
    return model.evaluate(q, solved), inertia_load(model.results(q, solved))


def mapped(bearing):
    """As the cases have it, so that their programs serve."""
    return bj.BearingElement(bearing, quadrature=quadratures()["contact_mapped"])


def evaluate(element, q, speed):
    return _evaluate(element, jnp.asarray(q), speed)[0]


@eqx.filter_jit
def by_autodiff(element, q, speed):
    """Gradient of the energy, and the derivative of the force along q.

    Where there is no potential the force stands for the gradient.
    """

    def force(q):
        return element.force(q, speed)

    value, along = jax.jvp(force, (q,), (q,))
    if not element.has_potential(speed):
        return value, along
    return jax.grad(lambda q: element.energy(q, speed))(q), along


def scale_of(k):
    d = np.sqrt(np.maximum(np.diag(k), 0.0))
    largest = np.tile(np.repeat([d[[0, 1, 2]].max(), d[[3, 4]].max()], 3), 2)
    return np.outer(largest, largest)


def rigid_modes():
    """Common motions and spins that cost nothing (12, 7)."""
    modes = np.zeros((12, 7))
    for i in range(5):
        modes[[i, 6 + i], i] = 1.0
    modes[5, 5] = modes[11, 6] = 1.0
    return modes


@pytest.mark.slow
def test_evaluate_matches_autodiff_at_loaded_point(case):
    element, speed = case
    q = jnp.asarray(motion())
    e, inertia = _evaluate(element, q, speed)
    force, k = np.asarray(e.force), np.asarray(e.stiffness)
    assert int(e.result) == bj.Result.CONVERGED
    assert np.abs(force).max() > 100.0  # the case must load something

    # The rule of the contact makes these equal to round-off, in both quadratures.
    gradient, along = map(np.asarray, by_autodiff(element, q, speed))
    potential = element.has_potential(speed)
    assert np.abs(gradient - force).max() < ROUNDING * np.abs(force).max()
    scale = scale_of(k)
    size = np.abs(np.asarray(q)) * np.sqrt(np.diag(scale))
    assert (
        np.abs(along - k @ np.asarray(q)) / np.sqrt(np.diag(scale))
    ).max() < ROUNDING * size.max()
    asymmetry = (np.abs(k - k.T) / scale).max()
    # What has no potential is a small part: below a tenth, but not nothing.
    assert asymmetry < ROUNDING if potential else 1e-8 < asymmetry < 0.1
    assert np.all(k[[5, 11]] == 0) and np.all(k[:, [5, 11]] == 0)

    moved = k @ rigid_modes() / np.sqrt(scale.diagonal())[:, None]
    assert np.abs(moved).max() < ROUNDING * np.sqrt(scale.max())

    # Rings and inertia of the row balance, forces and moments at the origin.
    total = force[:6] + force[6:] + inertia
    assert np.abs(total).max() < ROUNDING * np.abs(force).max()


@pytest.mark.slow
def test_differences_are_v_shaped(case):
    """The error of central differences falls with the step, then round-off lifts it."""
    element, speed = case
    q = motion()
    rng = np.random.default_rng(1)
    way = np.tile(np.repeat([1.0, 40.0], 3), 2) * rng.uniform(-1, 1, 12)
    way[[5, 11]] = 0.0
    exact = evaluate(element, q, speed)
    slope = float(np.asarray(exact.force) @ way)
    bend = np.asarray(exact.stiffness) @ way
    errors = []
    for step in 10.0 ** -np.arange(6.0, 15.5, 1.5):
        far = [evaluate(element, q + s * step * way, speed) for s in (1, -1)]
        energy = (float(far[0].energy) - float(far[1].energy)) / (2 * step)
        force = (np.asarray(far[0].force) - np.asarray(far[1].force)) / (2 * step)
        errors.append(
            [
                abs(energy - slope) / abs(slope),
                np.abs(force - bend).max() / np.abs(bend).max(),
            ]
        )
    potential = element.has_potential(speed)
    for column in np.array(errors).T[0 if potential else 1 :]:
        best = column.argmin()
        assert column[best] < DIFFERENCE
        assert column[0] > 3 * column[best] and column[-1] > 3 * column[best]


def test_common_rigid_motion_and_turn_by_one_pitch(case):
    element, speed = case
    q = motion()
    e, inertia = _evaluate(element, jnp.asarray(q), speed)
    together = np.tile([3e-5, -2e-5, 1e-5, 2e-4, -3e-4, 0.0], 2)
    moved = evaluate(element, q + together, speed)
    difference = float(moved.energy - e.energy)
    # The potential of the inertia force falls with the common motion.
    difference += float(inertia @ together[:6])
    if element.has_potential(speed):
        assert abs(difference) < SOLVER * abs(float(e.energy))
    assert np.allclose(
        moved.force, e.force, rtol=0, atol=SOLVER * np.abs(np.asarray(e.force)).max()
    )

    # Turning both rings by one pitch angle carries each roller to the next place.
    turned = q.copy()
    counts = {row.bearing.n_elements for row in rows_of(element.bearing)}
    if len(counts) > 1 or getattr(element.bearing, "ball_deviation", None) is not None:
        return  # no such symmetry
    turned[[5, 11]] = 2 * np.pi / counts.pop()
    t = evaluate(element, turned, speed)
    size = np.abs(np.asarray(e.force)).max()
    assert np.allclose(t.force, e.force, rtol=0, atol=SOLVER * size)


@pytest.mark.slow
def test_finite_at_rest_and_at_a_thousandfold_load(case):
    element, speed = case
    for q in (np.zeros(12), 1e3 * motion()):
        for number in by_autodiff(element, jnp.asarray(q), speed):
            assert np.all(np.isfinite(number))


def test_nan_in_failure_out(case):
    element, speed = case
    q = motion()
    q[7] = np.nan
    e = evaluate(element, q, speed)
    assert int(e.result) == bj.Result.NON_FINITE
    assert not np.all(np.isfinite(e.force))


def test_evaluate_vanishes_when_apart():
    element = mapped(taper())
    apart = np.zeros(12)
    apart[8] = -1e-3
    e = evaluate(element, apart, None)
    assert float(e.energy) == 0.0
    assert np.all(np.asarray(e.force) == 0) and np.all(np.asarray(e.stiffness) == 0)
    gradient, hessian = by_autodiff(element, jnp.asarray(apart), None)
    assert np.all(np.asarray(gradient) == 0) and np.all(np.asarray(hessian) == 0)


@pytest.mark.parametrize(
    "name",
    marked(["taper, large rib", "cylindrical NUP, logarithmic"], {"taper, large rib"}),
)
def test_condensed_stiffness_is_the_whole_hessian(name):
    element = mapped(bearings()[name])
    q = jnp.asarray(motion())
    k = np.asarray(evaluate(element, q, None).stiffness)
    hessian = np.asarray(jax.jit(jax.hessian(element.energy))(q))
    by_force = np.asarray(jax.jit(jax.jacrev(element.force))(q))
    for other in (hessian, by_force):
        assert (np.abs(other - k) / scale_of(k)).max() < ROUNDING


def test_thrown_off_without_a_rib():
    """A turning taper without its large rib: no equilibrium, and the code says so."""
    element = bj.BearingElement(bearings()["taper, half angle zero"])
    e = evaluate(element, motion(), speeds()["turning"])
    assert int(e.result) == bj.Result.NO_LOAD_PATH


@pytest.mark.slow
def test_vmap_is_a_loop_and_jit_is_eager():
    element = mapped(taper())
    qs = jnp.asarray(np.stack([motion(seed) for seed in range(3)]))
    batch = jax.jit(jax.vmap(lambda q: element.evaluate(q)))(qs)
    for i in range(3):
        one = evaluate(element, qs[i], None)
        assert np.allclose(batch.force[i], one.force, rtol=SOLVER, atol=1e-9)
        scale = scale_of(np.asarray(one.stiffness))
        difference = np.abs(np.asarray(batch.stiffness[i] - one.stiffness))
        assert np.max(difference / scale) < SOLVER
    with jax.disable_jit():
        small = bj.BearingElement(taper(2), quadrature=bj.numerics.Midpoint(3))
        eager = np.asarray(small.force(qs[0]))
    jitted = np.asarray(small.force(qs[0]))
    assert np.allclose(eager, jitted, rtol=0, atol=SOLVER * np.abs(jitted).max())


@pytest.mark.slow
def test_absent_term_is_a_term_of_zero():
    """Ribs that cannot be reached, and speed zero, change nothing."""
    q = jnp.asarray(motion())
    plain = bearings()["cylindrical, crowned ends"]
    far = bj.Ribs.arrangement("NUP", bj.Rib(0.3, 1.5e-3), 4.0)
    with_ribs = eqx.tree_at(lambda b: b.ribs, plain, far)
    a = evaluate(mapped(plain), q, None)
    b = evaluate(mapped(with_ribs), q, None)
    c = evaluate(mapped(plain), q, bj.Speed(0.0, 0.0))
    for other in (b, c):
        assert np.allclose(a.force, other.force, rtol=SOLVER, atol=1e-9)
        scale = scale_of(np.asarray(a.stiffness))
        difference = np.abs(np.asarray(a.stiffness - other.stiffness))
        assert np.max(difference / scale) < SOLVER


def test_one_trace_for_ten_designs():
    @eqx.filter_jit
    @eqx.debug.assert_max_traces(max_traces=1)
    def force(element, q):
        return element.force(q)

    for i in range(10):
        bearing = taper(5, radial_internal_clearance=1e-6 * i)
        element = bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(4))
        force(element, jnp.asarray(motion(i)))


def test_no_host_callback_inside():
    element = bj.BearingElement(taper(3), quadrature=bj.numerics.Midpoint(4))
    text = str(jax.make_jaxpr(jax.hessian(element.energy))(jnp.asarray(motion())))
    assert "callback" not in text


def of_design(element, q, speed, load):
    """What a design decides at given ring freedoms, and under a load."""
    found = element.evaluate(q, speed)
    solution = bj.solve_load(
        element,
        load,
        support=bj.Support(prescribed={"gz": q[11]}, fixed_displacement=q[:6]),
        start=q[6:],
        speed=speed,
        # As far as round-off lets it: differences feel what is left.
        options=bj.statics.SolveOptions(tolerance=1e-15),
        throw=False,
    )
    numbers = {
        "force": found.force,
        "stiffness": found.stiffness,
        "displacement under load": solution.displacement[6:11],
        "force under load": solution.force,
        "stiffness under load": solution.stiffness,
    }
    # Without a potential the force is no derivative of the energy.
    return numbers | ({"energy": found.energy} if element.has_potential(speed) else {})


@eqx.filter_jit
def along_design(element, change, *given):
    """`of_design`, and its derivative along a change of the design."""
    numbers, rest = eqx.partition(element, eqx.is_inexact_array)

    def of_numbers(numbers):
        return of_design(eqx.combine(numbers, rest), *given)

    return jax.jvp(of_numbers, (numbers,), (change,))


def numbers_of(element, rng):
    """Name of every real number or list of a design, and a change of it alone."""
    numbers = eqx.filter(element, eqx.is_inexact_array)
    leaves, structure = jax.tree.flatten(numbers)
    paths, _ = zip(*jax.tree_util.tree_leaves_with_path(numbers), strict=True)
    for k, path in enumerate(paths):
        name = jax.tree_util.keystr(path)
        size = np.abs(leaves[k]).max() or (0.1 if "azimuth" in name else 1e-5)
        changes = [jnp.zeros_like(leaf) for leaf in leaves]
        changes[k] = jnp.asarray(size * rng.uniform(0.5, 1.0, leaves[k].shape))
        yield name, jax.tree.unflatten(structure, changes)


@pytest.mark.parametrize("name", marked(DESIGNS, QUICK_DESIGNS))
@pytest.mark.slow
def test_derivative_by_every_number_of_the_design(name):
    case, cage_torque = DESIGNS[name]
    element, speed = made(*case)
    element = bj.BearingElement(
        element.bearing, choices=element.choices, cage_torque=cage_torque
    )
    # Rings that have turned carry the elements along, by a ratio of the design.
    q = motion()
    q[[5, 11]] = 0.02, -0.05
    q = jnp.asarray(q)
    load = np.array(evaluate(element, q, speed).force[6:])
    load[np.abs(load) < 1e-6 * np.abs(load).max()] = 0.0
    load[5] = 0.0
    given = q, speed, jnp.asarray(load)
    for number, change in numbers_of(element, np.random.default_rng(2)):

        def at(step, change=change):
            moved = eqx.apply_updates(element, jax.tree.map(lambda d: step * d, change))
            return along_design(moved, change, *given)

        values, slopes = at(0.0)
        errors = []
        for step in (1e-3, 1e-4, 1e-5, 1e-6):
            ends = at(step)[0], at(-step)[0]
            errors.append(
                {
                    what: np.abs((ends[0][what] - ends[1][what]) / (2 * step) - slope)
                    for what, slope in slopes.items()
                }
            )
        for what, slope in slopes.items():
            error = min(e[what].max() for e in errors)
            # The round-off of a solve, over the largest step.
            noise = 10 * SOLVER * np.abs(values[what]).max()
            allowed = DIFFERENCE * np.abs(slope).max() + noise
            assert error < allowed, (number, what)

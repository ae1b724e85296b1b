"""The load solve: loads and displacements mixed, result codes, derivatives."""

import functools

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import robust_loads
import robust_sweep
from registry import balls, bearings, taper
from slopes import with_slopes
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.element import azimuths
from bearingjax.lubrication import iso_vg
from bearingjax.numerics.warning import warnings_of_cases
from bearingjax.statics import load_result, warnings
from bearingjax.statics.warning import sizes
from bearingjax.statics.warning_kinds import SOLUTION_KINDS

RADIAL = [0.0, -4000.0, 0.0, 1.0, 0.0, 0.0]
FREE = ["ux", "uy", "gx", "gy"]


@pytest.fixture(scope="module")
def crowned():
    return bj.BearingElement(bearings()["cylindrical, crowned ends"])


@pytest.fixture(scope="module")
def tapered():
    return bj.BearingElement(taper())


def loads_of(s, ring):
    return np.asarray(s.force)[6:] if ring == "inner" else np.asarray(s.force)[:6]


@pytest.mark.slow
def test_either_ring_may_be_fixed(crowned):
    inner = bj.solve_load(crowned, RADIAL)
    outer = bj.solve_load(
        crowned, [-x for x in RADIAL], support=bj.Support(fixed_ring="inner")
    )
    assert np.allclose(
        inner.displacement[6:], -outer.displacement[:6], rtol=1e-7, atol=1e-15
    )
    assert np.allclose(
        loads_of(inner, "inner")[[0, 1, 3, 4]], [0, -4000, 1, 0], atol=1e-6
    )
    assert np.all(np.asarray(inner.displacement)[:6] == 0)


def test_fixed_ring_may_stand_anywhere(crowned):
    """Common rigid motion changes nothing."""
    at = [3e-5, -2e-5, 1e-5, 2e-4, -1e-4, 0.0]
    a = bj.solve_load(crowned, RADIAL, support=bj.Support(fixed_displacement=at))
    b = bj.solve_load(crowned, RADIAL)
    # Without ribs the axial freedom stays where it was put: at zero, not at 1e-5.
    difference = np.asarray(a.displacement - b.displacement)[[6, 7, 9, 10]]
    assert np.allclose(difference, np.array(at)[[0, 1, 3, 4]], rtol=1e-6, atol=1e-12)


def test_loads_and_displacements_mixed(tapered):
    s = bj.solve_load(
        tapered,
        [2000.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        support=bj.Support(prescribed={"uz": 40e-6, "gx": 2e-4, "gz": 0.3}),
    )
    q, force = np.asarray(s.displacement), np.asarray(s.force)
    assert np.allclose(q[[8, 9, 11]], [40e-6, 2e-4, 0.3], rtol=1e-15)
    assert np.allclose(force[[6, 7, 10]], [2000.0, 0.0, 0.0], atol=1e-6)
    assert force[8] > 1000.0  # the axial preload that this takes
    # gz turned the set of rollers.
    bearing = tapered.bearing
    turned = azimuths(bearing, jnp.asarray(q)) - azimuths(bearing, jnp.zeros(12))
    assert np.allclose(turned, 0.5 * 0.3 * (1 - 8.2 * np.cos(np.deg2rad(11)) / 52))


@pytest.mark.slow
def test_solve_load_with_all_freedoms_prescribed(crowned):
    at = {"ux": 1e-5, "uy": -2e-5, "uz": 0.0, "gx": 0.0, "gy": 1e-4}
    s = bj.solve_load(crowned, None, support=bj.Support(prescribed=at, free=[]))
    q = np.asarray(s.displacement)
    assert np.allclose(q[6:11], list(at.values()))
    assert np.allclose(s.force, crowned.force(jnp.asarray(q)), rtol=SOLVER, atol=1e-9)
    assert int(s.stats.iterations) == 0


def test_solve_load_outputs_are_consistent(tapered):
    s = bj.solve_load(
        tapered,
        [1000.0, 0, 6000.0, 0, 0, 0],
        speed=bj.Speed(inner=300.0),
        options=bj.statics.SolveOptions(points=1001),
    )
    length = 0.0115
    x = np.asarray(s.position)
    assert np.allclose([x[0], x[-1]], [-length / 2, length / 2])
    # The line load integrates to the load of the roller.
    total = np.trapezoid(np.asarray(s.line_load), x, axis=-1)
    assert np.allclose(total, s.roller_load, rtol=1e-3)  # trapezoids of a steep end
    assert np.asarray(s.rib_load)[:, [0, 1, 3]].max() == 0.0
    assert np.asarray(s.rib_load)[:, 2].min() > 0.0
    # Axial balance: outer raceways carry the axial load.
    angle = np.deg2rad(11 + 1.7235)
    axial = float(jnp.sum(s.roller_load[:, 0])) * np.sin(angle)
    assert axial == pytest.approx(6000.0, rel=1e-9)
    # p = 2 q/(π b)
    q, p, b = (
        np.asarray(v) for v in (s.line_load, s.contact_pressure, s.contact_half_width)
    )
    loaded = q > 1.0
    assert np.allclose(p[loaded], 2 * q[loaded] / (np.pi * b[loaded]), rtol=1e-12)
    assert not np.asarray(s.edge_loaded).any()
    assert s.load_zone.all() and bool(s.converged)


def test_edge_loaded_rollers_are_warned_of(crowned):
    s = bj.solve_load(crowned, [0.0, -20e3, 0, 0, 0, 0])
    assert np.asarray(s.edge_loaded).any()
    text = bj.statics.warnings(s)
    assert text and all("edge-loaded" in line for line in text)


@pytest.mark.slow
def test_a_freedom_without_stiffness_is_warned_of(crowned):
    load = [0.0, -500.0, 0, 0, 0, 0]
    s = bj.solve_load(crowned, load, support=bj.Support(free=["ux", "uy", "uz"]))
    (line,) = (t for t in bj.statics.warnings(s) if "no stiffness" in t)
    assert line.startswith("no stiffness in uz of the inner ring: nothing holds it")
    held = bj.solve_load(crowned, load, support=bj.Support(free=["ux", "uy"]))
    assert not any("no stiffness" in t for t in bj.statics.warnings(held))


@pytest.mark.parametrize(
    "load, name",
    [([0, 0, -6000.0, 0, 0, 0], "uz"), ([3000.0, 0, 0, 0, 0, 0], "uz")],
)
def test_taper_without_axial_load_has_no_path(tapered, load, name):
    with pytest.raises(bj.SolveError, match=f"No load path in {name} of the inner"):
        bj.solve_load(tapered, load)
    s = bj.solve_load(tapered, load, throw=False)
    assert int(s.result) == bj.Result.NO_LOAD_PATH
    assert bj.FREEDOMS[int(s.unrestrained)] == name


def test_axial_load_on_nu_and_moment_about_the_axis(crowned):
    for load, name in (
        ([0, -1e3, 5.0, 0, 0, 0], "uz"),
        ([0, -1e3, 0, 0, 0, 1.0], "gz"),
    ):
        s = bj.solve_load(crowned, load, throw=False)
        assert int(s.result) == bj.Result.NO_LOAD_PATH
        assert bj.FREEDOMS[int(s.unrestrained)] == name


def test_solve_load_reports_step_limit(tapered):
    with pytest.raises(bj.SolveError, match="Step limit reached after 2 steps"):
        bj.solve_load(
            tapered,
            [0, 0, 6000.0, 0, 0, 0],
            options=bj.statics.SolveOptions(max_steps=2),
        )


def test_message_reports_round_off_of_rolling_elements(tapered):
    """Rings in balance, rolling elements nearly so: more steps would not help."""
    s = bj.solve_load(tapered, [0, 0, 6000.0, 0, 0, 0])
    for local, times, words in (
        (5e-10, 10.0, "balance to 5.0e-10 of their load"),
        (5e-10, 1.0, "Step limit of the rolling elements: the rings balance to"),
        (1e-3, 10.0, "Step limit of the rolling elements: the rings balance to"),
    ):
        late = eqx.tree_at(
            lambda s: (s.result, s.stats.roller_residual, s.roller_pressure),
            s,
            (
                jnp.int32(bj.Result.STEP_LIMIT),
                jnp.asarray(local),
                times * s.roller_pressure,
            ),
        )
        assert words in late.failure_message
        assert "SolveOptions" not in late.failure_message


@pytest.mark.slow
def test_a_failed_solve_has_no_derivative(tapered):
    """Of any size it would pass for one."""

    def moved(load):
        s = bj.solve_load(
            tapered, load, throw=False, options=bj.statics.SolveOptions(max_steps=2)
        )
        return s.displacement[8]

    slope = jax.jit(jax.grad(moved))(jnp.asarray([0, 0, 6000.0, 0, 0, 0]))
    assert np.isnan(slope).all()


def test_non_finite_input(crowned):
    load = [0.0, np.nan, 0.0, 0.0, 0.0, 0.0]
    assert int(bj.solve_load(crowned, load, throw=False).result) == bj.Result.NON_FINITE


def test_throw_under_jit(tapered):
    @jax.jit
    def push(axial):
        return bj.solve_load(tapered, axial * jnp.eye(6)[2]).displacement

    assert float(push(6000.0)[8]) > 0
    words = "solve_load: No load path in uz of the inner ring: .* Call with throw=False"
    # Plain `jit` passes it on as an error of its own.
    with pytest.raises(Exception, match=words):
        jax.block_until_ready(push(-6000.0))
    with pytest.raises(Exception, match="solve_load: numbers that are not finite"):
        jax.block_until_ready(jax.vmap(push)(jnp.asarray([-6000.0, jnp.nan])))


def test_bad_case_stays_alone_in_a_batch(tapered):
    loads = jnp.asarray([[0, 0, f, 0, 0, 0] for f in (6e3, -6e3, np.nan, 3e3)])
    s = jax.vmap(lambda load: bj.solve_load(tapered, load, throw=False))(loads)
    codes = [bj.Result(int(c)).label for c in s.result]
    assert codes == ["converged", "no_load_path", "non_finite", "converged"]
    alone = bj.solve_load(tapered, loads[3])
    assert np.allclose(s.displacement[3], alone.displacement, rtol=1e-7, atol=1e-14)


def numbers_of(thing):
    """Name and value of every array, and of every property that its class defines."""
    if isinstance(thing, dict):
        return thing
    kinds = [kind for kind in type(thing).__mro__ if "bearingjax" in kind.__module__]
    names = {n for k in kinds for n, v in vars(k).items() if isinstance(v, property)}
    names -= {"weakest", "failure_message"}  # They are of one case alone.
    found = vars(thing) | {name: getattr(thing, name) for name in names}
    return {n: v for n, v in found.items() if hasattr(v, "dtype")}


def of_solution(solution):
    """What follows from a solution, its life, torques and films."""
    oil = iso_vg(68.0)
    return {
        "solution": solution,
        "life": bj.rating_life(
            solution, conditions=bj.LifeConditions(viscosity=2e-5, contamination=0.5)
        ),
        "torque": bj.friction_torque(solution, 2e-5),
        "skf": bj.friction.skf_friction_torque(solution, 2e-5),
        "films": bj.films(solution, oil, 340.0, 2e-7),
        "warnings": sizes(solution),
    }


@pytest.mark.parametrize(
    "bearing",
    [
        balls(8, bj.DeepGrooveBallBearing, radial_internal_clearance=10e-6),
        bearings()["cylindrical, crowned ends"],
    ],
    ids=["balls", "rollers"],
)
@pytest.mark.slow
def test_solve_load_batch_equals_single_solutions(bearing):
    element = bj.BearingElement(bearing)
    # The third is so light that what it carries is round-off beside the others.
    down = jnp.asarray([300.0, 5e3, 1e-6, 9e3])
    loads = jnp.outer(down, jnp.asarray([0.0, -1.0, 0.0, 1e-4, 2e-4, 0.0]))
    speed = bj.Speed(inner=1200.0)

    @jax.jit
    def solve(load):
        return bj.solve_load(element, load, speed=speed, throw=False)

    batch, singles = jax.vmap(solve)(loads), [solve(load) for load in loads]
    follows = jax.jit(of_solution)
    together, apart = jax.vmap(follows)(batch), [follows(one) for one in singles]
    for what, thing in together.items():
        wanted = [numbers_of(one[what]) for one in apart]
        for name, value in numbers_of(thing).items():
            stacked = np.stack([one[name] for one in wanted])
            assert value.shape == stacked.shape, (what, name)
            size = np.abs(np.where(np.isfinite(stacked), stacked, 0.0)).max()
            close = np.allclose(value, stacked, 1e-6, 1e-7 * size, equal_nan=True)
            assert close, (what, name)
    assert warnings(batch) == warnings_of_cases(
        jax.tree.map(np.asarray, together["warnings"]), SOLUTION_KINDS
    )
    for function in (
        lambda s: bj.friction_torque(s, 2e-5),
        lambda s: bj.films(s, iso_vg(68.0), 340.0),
        bj.rating_life,
    ):
        with pytest.raises(ValueError, match="several cases; map over them"):
            function(batch)
    with pytest.raises(ValueError, match="several cases; map over them"):
        str(batch.failure_message)


@pytest.mark.parametrize("way", [jax.jacrev, jax.jacfwd])
@pytest.mark.slow
def test_gradient_of_a_batch_past_masked_cases(tapered, way):
    """By a number of the design that all cases share, and by their loads."""

    def total(x):
        clearance, *forces = x
        element = eqx.tree_at(
            lambda e: e.bearing.radial_internal_clearance, tapered, clearance
        )

        def solve(force):
            load = jnp.zeros(6).at[2].set(force)
            s = bj.solve_load(element, load, throw=False)
            return s.converged, s.displacement[8], bj.rating_life(s).reference_load

        good, moved, load = jax.vmap(solve)(jnp.stack(forces))
        told = jnp.where(good, 1e3 * moved + 1e-3 * load, 0.0)
        return jnp.sum(told)

    total, clearance = (
        with_slopes(total, way),
        tapered.bearing.radial_internal_clearance,
    )
    x = jnp.asarray([float(clearance), 6e3, -6e3, np.nan, 3e3])
    slopes, _ = total(x)
    assert slopes[2] == 0 and slopes[3] == 0
    for k, step in ((0, 1e-8), (1, 1.0), (4, 1.0)):
        after, before = (total(x.at[k].add(sign * step))[1] for sign in (1.0, -1.0))
        difference = float(after - before) / (2.0 * step)
        assert abs(difference) > 1e-6
        assert float(slopes[k]) == pytest.approx(difference, rel=1e-6)


@pytest.mark.slow
def test_many_devices_and_a_batch_of_open_size(tapered):
    """The recipes of `bearingjax.statics` for a program of one's own."""

    def moved(load):
        return bj.solve_load(tapered, load, throw=False).displacement

    loads = jnp.asarray([[0, 0, force, 0, 0, 0] for force in (6e3, 3e3)])
    mesh = jax.sharding.Mesh(np.asarray(jax.devices()[:1]), ("case",))
    case = jax.P("case")
    on_devices = jax.shard_map(
        jax.vmap(moved), mesh=mesh, in_specs=case, out_specs=case, check_vma=False
    )
    found = jax.jit(on_devices)(loads)
    of_any_size = jax.jit(lambda loads: jax.lax.map(moved, loads))
    shape = (*jax.export.symbolic_shape("n"), 6)
    program = jax.export.export(of_any_size)(jax.ShapeDtypeStruct(shape, loads.dtype))
    for rows in (loads, loads[:1]):
        np.testing.assert_allclose(program.call(rows), found[: len(rows)], 1e-7, 1e-14)


@pytest.mark.parametrize(
    "call, text",
    [
        (dict(load=[1.0, 2.0]), r"`load` has shape \(2,\).*Fx Fy Fz Mx My Mz"),
        (dict(load=RADIAL, start=[0.0]), r"`start` has shape \(1,\)"),
    ],
)
def test_wrong_calls(crowned, call, text):
    with pytest.raises(ValueError, match=text):
        bj.solve_load(crowned, **call)


@pytest.mark.parametrize(
    "given, text",
    [
        (dict(fixed_ring="left"), "`fixed_ring` is 'left'.*'outer'"),
        (dict(free=["vx"]), "`free` names 'vx'; freedoms are ux"),
        (dict(prescribed={"rz": 0.0}), "`prescribed` names 'rz'"),
        (dict(prescribed={"uz": [0.0, 1.0]}), r"`prescribed\['uz'\]` has shape"),
        (dict(free=["ux"], prescribed={"ux": 0.0}), "both free and presc"),
        (dict(free=["gz"]), "gz, which no rolling bearing restrains"),
        (dict(fixed_displacement=[0.0]), "`fixed_displacement` has shape"),
    ],
)
def test_wrong_supports(given, text):
    with pytest.raises(ValueError, match=text):
        bj.Support(**given)


def test_wrong_tolerance():
    with pytest.raises(ValueError, match="`tolerance` is 2;"):
        bj.statics.SolveOptions(tolerance=2.0)


def fall(bearing, load):
    """A response whose derivatives are asked for: sag and stiffness."""
    s = bj.solve_load(bj.BearingElement(bearing), load)
    return jnp.stack([1e6 * s.displacement[7], 1e-8 * s.stiffness[7, 7]])


DESIGN = {
    "length": (lambda b: b.roller_length, 1e-6),
    "straight part": (lambda b: b.roller_profile.straight_length, 1e-6),
    "crown radius": (lambda b: b.roller_profile.crown_radius, 1e-4),
    "clearance": (lambda b: b.radial_internal_clearance, 1e-9),
    "elastic modulus": (lambda b: b.material.elastic_modulus, 1e6),
}


@pytest.mark.slow
def test_design_gradients_of_displacement_and_stiffness():
    """Forward, reverse and differences, with rollers loaded to their ends."""
    load = jnp.asarray([300.0, -20e3, 0.0, 5.0, 0.0, 0.0])
    bearing = bearings()["cylindrical, crowned ends"]
    assert np.asarray(bj.solve_load(bj.BearingElement(bearing), load).edge_loaded).any()
    getters = [get for get, _ in DESIGN.values()]

    @jax.jit
    def of(values):
        changed = eqx.tree_at(lambda b: [g(b) for g in getters], bearing, list(values))
        return fall(changed, load)

    at = jnp.stack([get(bearing) for get in getters])
    forward, reverse = jax.jacfwd(of)(at), jax.jacrev(of)(at)
    assert np.allclose(forward, reverse, rtol=1e-8, atol=0)
    for k, (name, (_, step)) in enumerate(DESIGN.items()):
        move = jnp.zeros_like(at).at[k].set(step)
        slope = np.asarray(of(at + move) - of(at - move)) / (2 * step)
        # Differences of solves that end at 1e-11 of the load.
        assert np.allclose(forward[:, k], slope, rtol=1e-5), name


@pytest.mark.slow
def test_solve_load_design_gradient_with_held_freedom():
    """Five rollers, none opposite another: ux is coupled to uy, and held at zero."""

    def sag(clearance):
        bearing = bj.CylindricalRollerBearing(
            5, 0.046, 0.0095, 0.0095, radial_internal_clearance=clearance
        )
        element = bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(5))
        load = jnp.array([0.0, -500.0, 0.0, 0.0, 0.0, 0.0])
        return bj.solve_load(
            element, load, support=bj.Support(free=["uy"])
        ).displacement[7]

    slope = jax.jit(jax.value_and_grad(sag))
    at, h = 1e-6, 1e-8
    difference = (slope(at + h)[0] - slope(at - h)[0]) / (2 * h)
    assert abs(slope(at)[1] - difference) < DIFFERENCE * abs(difference)


@pytest.mark.slow
def test_gradient_with_respect_to_a_prescribed_turn(crowned):
    """gz moves the rollers: the answer follows, though force and stiffness hold it."""

    @jax.jit
    @jax.value_and_grad
    def sag(turn):
        s = bj.solve_load(
            crowned, RADIAL, support=bj.Support(prescribed={"gz": turn}, free=FREE)
        )
        return 1e6 * (s.displacement[7] + 2.0 * s.displacement[6])

    at, h = 0.1, 1e-5
    difference = (sag(at + h)[0] - sag(at - h)[0]) / (2 * h)
    assert abs(difference) > 0.1
    assert abs(sag(at)[1] - difference) < DIFFERENCE * abs(difference)


@pytest.mark.parametrize(
    "held, why",
    [
        (dict(prescribed={"gx": 1e-4}), "prescribed"),
        (dict(free=["ux", "uy", "gy"]), "not among `free`"),
    ],
)
@pytest.mark.slow
def test_a_load_on_a_held_freedom_is_not_dropped(crowned, held, why):
    load = [0.0, -4000.0, 0.0, 20.0, 0.0, 0.0]
    with pytest.raises(ValueError, match=f"has Mx = 20 N m, but gx is {why}"):
        bj.solve_load(crowned, load, support=bj.Support(**held))
    with pytest.raises(ValueError, match=f"Mx = 20 N m in case 1, but gx is {why}"):
        cases = bj.Cases(
            [RADIAL[:3] + [0.0] * 3, load], prescribed=held.get("prescribed")
        )
        bj.sweep(crowned, cases, support=bj.Support(free=held.get("free")))
    support = bj.Support(**held)
    s = jax.jit(lambda f: bj.solve_load(crowned, f, support=support, throw=False))(
        jnp.asarray(load)
    )
    assert int(s.result) == bj.Result.NO_LOAD_PATH
    assert "load has Mx, but gx of the inner ring is held" in s.failure_message
    assert s.held == (("gx",) if "prescribed" in held else ("uz", "gx"))


def test_numbers_do_not_compile_anew(crowned, monkeypatch):
    """Tolerance, step limit, and what is prescribed: an infinite displacement too."""
    traces, describe = [], load_result.describe
    monkeypatch.setattr(
        load_result, "describe", lambda *args: traces.append(1) or describe(*args)
    )
    for moved, tolerance, steps in ((0.0, 1e-7, 50), (np.inf, 1e-8, 60)):
        s = bj.solve_load(
            crowned,
            RADIAL,
            support=bj.Support(prescribed={"ux": moved}),
            # With a number of points that no other test has.
            options=bj.statics.SolveOptions(7, tolerance, steps),
            throw=False,
        )
    assert len(traces) == 1
    assert int(s.result) == bj.Result.NON_FINITE


@pytest.mark.slow
def test_gradient_with_respect_to_load_is_the_compliance(tapered):
    load = jnp.asarray([1000.0, 300.0, 5000.0, 2.0, -1.0, 0.0])
    of = jax.jit(lambda f: bj.solve_load(tapered, f).displacement[6:11])
    compliance = np.asarray(jax.jacfwd(of)(load))[:, :5]
    stiffness = np.asarray(bj.solve_load(tapered, load).stiffness)[6:11, 6:11]
    assert np.allclose(compliance @ stiffness, np.eye(5), atol=1e-7)


@functools.cache
def moved_inside_clearance(name):
    """How far a radial force moves one ball at its end of the clearance, or rollers, by
    force and speed, and the slopes."""
    size = dict(radial_internal_clearance=10e-6)
    if name == "balls":
        bearing = balls(8, bj.DeepGrooveBallBearing, first_azimuth=-np.pi / 2, **size)
    else:
        bearing = bj.CylindricalRollerBearing(7, 0.0725, 0.014, 0.01372, **size)
    element = bj.BearingElement(bearing)

    @with_slopes
    def moved(x):
        load = jnp.zeros(6).at[1].set(-x[0])
        return bj.solve_load(element, load, speed=bj.Speed(x[1])).displacement[7]

    return moved


@pytest.mark.parametrize("speed", [0.0, 1000.0])
@pytest.mark.parametrize("name", ["balls", "rollers"])
@pytest.mark.slow
def test_solve_load_gradient_inside_clearance(name, speed):
    """No number at zero load, at speed neither: what turns then presses the outer ring
    alone. Beyond, that of differences, however few elements hold the ring."""

    def moved(force):
        return moved_inside_clearance(name)(jnp.asarray([force, speed]))

    slope, value = moved(0.0)
    assert float(value) == 0.0 and not np.isfinite(slope[0]) and slope[1] == 0.0
    for force in (1e-3, 1.0):
        step = 1e-4 * force
        difference = float(moved(force + step)[1] - moved(force - step)[1]) / (2 * step)
        assert float(moved(force)[0][0]) == pytest.approx(difference, rel=1e-4)


@pytest.mark.slow
def test_solve_load_derivatives_of_floating_ring_oblique_load():
    """One ball holds it along the load alone: by clearance its derivative is half a
    unit along, by load across infinite."""
    direction = -1.1
    along = np.array([np.cos(direction), np.sin(direction)])

    @with_slopes
    def moved(x):
        bearing = balls(
            8,
            bj.DeepGrooveBallBearing,
            first_azimuth=direction,
            radial_internal_clearance=x[2],
        )
        load = jnp.concatenate([x[:2], jnp.zeros(4)])
        return bj.solve_load(bj.BearingElement(bearing), load).displacement[6:8]

    slopes, _ = moved(np.array([*(5.0 * along), 10e-6]))
    assert np.all(np.isinf(slopes[:, :2]))
    # The curvature of its raceway follows the clearance too.
    np.testing.assert_allclose(slopes[:, 2], 0.5 * along, rtol=1e-5)


@pytest.mark.slow
def test_second_derivative_of_the_displacement():
    """The curvature of sag against load, by the implicit rule and by differences."""
    element = bj.BearingElement(taper(5), quadrature=bj.numerics.Midpoint(8))

    def sag(factor):
        load = factor * jnp.asarray([500.0, 0.0, 4000.0, 0.0, 0.0, 0.0])
        return 1e6 * bj.solve_load(element, load).displacement[8]

    slope = jax.jit(jax.value_and_grad(jax.grad(sag)))
    bend = float(slope(1.0)[1])
    difference = float(slope(1.0 + 1e-4)[0] - slope(1.0 - 1e-4)[0]) / 2e-4
    assert bend == pytest.approx(difference, rel=1e-5)
    assert bend < 0.0  # a contact hardens


@pytest.mark.parametrize(
    "load",
    [
        [9.14145e-04, 4.07135e-04, 1.35571e-05, -3.00663e-07, -4.50735e-07, 0.0],
        [2.68547e-04, -1.22744e-03, 7.92611e-05, 3.77482e-07, 1.27362e-07, 0.0],
        [8.65353e-04, 7.49509e-04, -7.45943e-06, 3.41934e-07, -3.54767e-07, 0.0],
    ],
)
def test_millinewtons_on_a_wedged_roller(load):
    """A roller that the ribs tilt carries a thousandth of a load of millinewtons.

    Its state once jumped with the looseness of the roller, and with it the energy.
    """
    element = bj.BearingElement(robust_loads.designs()["NUP, logarithmic"](20e-6))
    s = bj.solve_load(element, load)
    out = (np.asarray(s.force)[6:] - load) / np.array([1, 1, 1, *[0.0325] * 3])
    assert np.linalg.norm(out[:5]) < 1e-8 * np.linalg.norm(load)


@pytest.mark.slow
def test_sweep_converges_for_rollers_at_crawling_speed():
    """6e-8 N on an unloaded roller: it once crept along its crown beyond all steps."""
    element = bj.BearingElement(robust_sweep.bearing())
    load = [-4109.0207, -6304.7216, 0.0, -2.9155, 7.2852, 0.0]
    cases = bj.Cases(np.array([load] * 4), inner_speed=[0.0383802, 0.0406, 0.041, 0.05])
    solved = bj.sweep(element, cases, outputs=["residual"])
    assert solved.converged.all() and solved.residual.max() < SOLVER


@pytest.mark.slow
def test_small_robustness_run():
    """Seeded, small version of benchmarks/robust_loads.py."""
    for row in robust_loads.run(2, seed=1, only=["NUP, logarithmic"], beyond=["taper"]):
        assert row.get("failed", 0) == 0 and row.get("silently_wrong", 0) == 0, row
        if "named_uz" in row:
            assert row["named_uz"] == row["uncarried_loads"], row


@pytest.mark.parametrize("speed", [0.05, 0.45, 3.7])
@pytest.mark.slow
def test_slow_taper(speed):
    """Idle rollers of a slow bearing, seated by next to nothing, do not fail the solve;
    it is that of the bearing at rest, but for inertia: at 3.7 rad/s some 2e-5 of the
    load of a roller, and in proportion to the square of the speed."""
    element = bj.BearingElement(bj.load_bearing("30206"))
    load, held = [0.0, -900.0, 300.0, 0.0, 0.0, 0.0], {"gx": 0.0, "gy": 0.0}
    turning = bj.Speed(jnp.asarray(speed))
    slow = bj.solve_load(
        element,
        load,
        support=bj.Support(prescribed=held),
        speed=turning,
        options=bj.statics.SolveOptions(points=2),
    )
    rest = bj.solve_load(
        element,
        load,
        support=bj.Support(prescribed=held),
        options=bj.statics.SolveOptions(points=2),
    )
    idle = np.asarray(rest.roller_load).min(axis=1) == 0
    assert 2 < idle.sum() < 15
    np.testing.assert_allclose(
        slow.displacement[6:9],
        rest.displacement[6:9],
        rtol=1e-8 + 2e-5 * (speed / 3.7) ** 2,
        atol=1e-12,
    )

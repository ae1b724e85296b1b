"""Sweeps against single solves, over devices and processes, and as tables."""

import os
import socket
import subprocess
import sys
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
from sweep_in_process import loads, small_element
from tolerances import SOLVER

import bearingjax as bj
from bearingjax.cases import near_starts, sweep_program, sweep_table
from bearingjax.cases.sweep import n_designs
from bearingjax.files.table_file import write_table
from bearingjax.numerics.compiled import batched_loop
from bearingjax.statics import SolveOptions, load_search

COUPLED = """
import jax, numpy as np, bearingjax as bj
jax.config.update("jax_enable_x64", True)
jax.config.update("jax_num_cpu_devices", 2)
bearing = bj.CylindricalRollerBearing(14, 0.065, 0.010, 0.010)
loads = np.outer(np.linspace(100.0, 5000.0, 64), [0.0, -1.0, 0.0, 1e-3, 0.0, 0.0])
element = bj.BearingElement(bearing, bj.contact.CoupledSlices(30))
batches = bj.cases.Batches(chunk=32)
solved = bj.sweep(element, loads, outputs=["displacement"], batches=batches)
assert len(jax.devices()) == 2 and not solved.result.any()
"""
SCRIPT = Path(__file__).parents[1] / "sweep_in_process.py"
ELEMENT = small_element()
NAMES = ["displacement", "stiffness", "largest_load", "iterations"]
BAD = {5: "non_finite", 7: "no_load_path"}


@pytest.fixture(scope="module")
def swept():
    """Fifty loads, two of them bad, in chunks that do not divide fifty."""
    return bj.sweep(ELEMENT, loads(), outputs=NAMES, batches=bj.cases.Batches(chunk=8))


@pytest.fixture(scope="module")
def from_contact():
    """The same, each from first contact."""
    return bj.sweep(
        ELEMENT, loads(), outputs=NAMES, batches=bj.cases.Batches(chunk=8, near=False)
    )


@pytest.mark.slow
def test_each_case_is_the_single_solve(swept):
    single = jax.jit(partial(bj.solve_load, ELEMENT, throw=False))
    for k, load in enumerate(loads()):
        solution = single(jnp.asarray(load))
        assert swept.result[k] == solution.result
        if k in BAD:
            continue
        for name in ("displacement", "stiffness"):
            want = np.asarray(getattr(solution, name))
            error = np.abs(getattr(swept, name)[k] - want).max()
            assert error <= 1e-9 * np.abs(want).max()
        assert swept.largest_load[k] == pytest.approx(float(solution.roller_load.max()))


def test_a_bad_case_is_named_and_spoils_no_other(swept):
    assert swept.counts() == {"converged": 48, "no_load_path": 1, "non_finite": 1}
    for k, label in BAD.items():
        assert bj.Result(int(swept.result[k])).label == label
        assert np.isnan(swept.displacement[k]).all()
    assert swept.unrestrained[7] == 2
    assert np.isfinite(swept.displacement[swept.converged]).all()


def test_near_starts_save_steps_and_change_no_answer(swept, from_contact):
    np.testing.assert_array_equal(swept.result, from_contact.result)
    for name in NAMES[:3]:
        got, want = getattr(swept, name), getattr(from_contact, name)
        most = np.nanmax(np.abs(want))
        np.testing.assert_allclose(got, want, rtol=1e-8, atol=1e-10 * most)
    assert swept.iterations.mean() < 0.5 * from_contact.iterations.mean()


def test_a_case_lost_from_a_near_start_is_solved_again(swept, monkeypatch):
    runs = []
    honest = sweep_program.Program._blocks

    def lossy(self, held, like, near, *choices):
        found = honest(self, held, like, near, *choices)
        runs.append((held[0].count, near))
        if near:
            found[sweep_program._LOST][3] = True
            found["result"][3] = bj.Result.STEP_LIMIT
            found["displacement"][3] = np.nan
        return found

    monkeypatch.setattr(sweep_program.Program, "_blocks", lossy)
    solved = bj.sweep(
        ELEMENT, loads(), outputs=NAMES, batches=bj.cases.Batches(chunk=8)
    )
    # Beside it number 7, which nothing can carry.
    assert runs == [(50, True), (2, False)] and solved.converged[3]
    np.testing.assert_allclose(
        solved.displacement[3], swept.displacement[3], rtol=1e-8, atol=1e-14
    )


def known_cases():
    """Three solved cases by hand; the second did not converge."""
    rng = np.random.default_rng(0)
    load, there = np.zeros((3, 6)), 1e-5 * rng.normal(size=(3, 6))
    load[:, 0], load[:, 1] = [1000.0, 1100.0, 600.0], [0.0, 50.0, 100.0]
    root = rng.normal(size=(6, 6)) + 3.0 * np.eye(6)
    size = np.array([1e4, 1e4, 1e4, 3e1, 3e1, 3e1])
    stiffness = size[:, None] * (root @ root.T) * size
    known = near_starts.nothing_known(1, 1, 0)
    for array, rows in zip(known, (load, known.other[:3], there), strict=False):
        array[:3] = rows
    known.stiffness[:3] = stiffness
    known.usable[:3] = [True, False, True]
    return jax.tree.map(jnp.asarray, known), load, there, stiffness


def started_at(known, loads, free, pitch=0.0, prescribed=None, play=False):
    """Starts by `near_starts`, the names of free freedoms given."""
    flags = tuple(name in free for name in bj.FREEDOMS)
    alike = near_starts.Likeness(flags, pitch, play)
    loads = np.asarray(loads)
    cases = bj.Cases(loads, prescribed=prescribed)
    none = jnp.zeros((len(loads), 0))
    return np.asarray(near_starts.starts(known, cases, none, alike))


def test_sweep_start_extrapolates_nearest_answer_by_stiffness():
    known, load, there, k = known_cases()
    free = [0, 1, 3, 4]
    names = [bj.FREEDOMS[i] for i in free]
    new = np.array([1100.0, 50.0, 0.0, 0.0, 0.0, 0.0])
    quarter = np.array([-50.0, 1100.0, 0.0, 0.0, 0.0, 0.0])
    want = there[0].copy()
    shift = [i for i in range(6) if i not in free]
    push = (new - load[0])[free] + k[np.ix_(free, shift)] @ want[shift]
    want[free] += np.linalg.solve(k[np.ix_(free, free)], push)
    want[shift] = 0.0
    start, turned = started_at(known, [new, quarter], names, 0.5 * np.pi)
    np.testing.assert_allclose(start, want, rtol=1e-9, atol=1e-18)
    x, y, z, a, b, g = want
    np.testing.assert_allclose(turned, [-y, x, z, -b, a, g], rtol=1e-9, atol=1e-18)
    # gx is prescribed: what it pushes is balanced.
    free, names = [0, 1, 4], ["ux", "uy", "gy"]
    tilt, want = 3e-4, there[0].copy()
    shift = [i for i in range(6) if i not in free]
    given = tilt * (np.array(shift) == 3)
    held = given - want[shift]
    push = (new - load[0])[free] - k[np.ix_(free, shift)] @ held
    want[free] += np.linalg.solve(k[np.ix_(free, free)], push)
    want[shift] = given
    (start,) = started_at(known, [new], names, prescribed={"gx": [tilt]})
    np.testing.assert_allclose(start, want, rtol=1e-9, atol=1e-18)


def test_sweep_start_without_usable_neighbour_is_nan():
    known, load, *_ = known_cases()
    names = ["ux", "uy", "uz", "gx", "gy"]
    opposite, axial = -load[0], load[0] + [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    starts = started_at(known, [load[0], opposite, 1e4 * load[0], axial], names)
    np.testing.assert_array_equal(np.isnan(starts[:, 0]), [False, True, True, True])
    assert np.isnan(started_at(known, load, names, play=True)).all()
    nothing = known._replace(usable=jnp.zeros_like(known.usable))
    assert np.isnan(started_at(nothing, load, names)).all()


def many(count, axial, speed=None):
    """Loads in all directions, some along the axis of an element, as cases."""
    rng = np.random.default_rng(1)
    size, way = 10 ** rng.uniform(1.5, 4, count), rng.uniform(0, 2 * np.pi, count)
    way[::4] = np.pi / 3 * np.round(way[::4] * 3 / np.pi)
    loads = np.zeros((count, 6))
    loads[:, 0], loads[:, 1] = size * np.cos(way), size * np.sin(way)
    loads[:, 2] = axial * size * rng.uniform(-1, 1, count) * (np.arange(count) % 3 > 0)
    loads[:, 3:5] = (size * rng.uniform(-1e-3, 1e-3, (2, count))).T
    return bj.Cases(loads, inner_speed=speed, design=rng.integers(0, 3, count))


def ribbed(clearance):
    ribs = bj.Ribs.arrangement("NUP", bj.Rib(0.3, 1.5e-3), 60e-6)
    bearing = bj.CylindricalRollerBearing(
        6, 0.065, 0.01, 0.01, radial_internal_clearance=clearance, ribs=ribs
    )
    return bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(8))


def grooved(clearance):
    bearing = bj.DeepGrooveBallBearing(
        6,
        0.0385,
        0.008,
        outer_osculation=0.52,
        inner_osculation=0.52,
        radial_internal_clearance=clearance,
    )
    return bj.BearingElement(bearing)


@pytest.mark.parametrize(
    "made, axial, speed",
    [(ribbed, 0.08, None), (grooved, 0.5, np.linspace(0.0, 3000.0, 48))],
)
@pytest.mark.slow
def test_play_lifted_balls_and_designs_end_where_first_contact_ends(made, axial, speed):
    """A start must not choose among equilibria: between ribs any uz is one."""
    element = bj.stack_designs([made(c) for c in (5e-6, 10e-6, 30e-6)])
    cases = many(48, axial, speed)
    names = ["displacement", "largest_load", "iterations"]
    near, contact = (
        bj.sweep(
            element, cases, outputs=names, batches=bj.cases.Batches(chunk=12, near=flag)
        )
        for flag in (True, False)
    )
    np.testing.assert_array_equal(near.result, contact.result)
    assert contact.converged.all()
    size = np.abs(contact.displacement).max(axis=1, keepdims=True)
    assert (np.abs(near.displacement - contact.displacement) <= 1e-7 * size).all()
    np.testing.assert_allclose(near.largest_load, contact.largest_load, rtol=1e-8)
    assert near.iterations.mean() < 0.9 * contact.iterations.mean()


@pytest.mark.slow
def test_cases_in_a_queue_are_solved_as_together(from_contact, monkeypatch):
    """Fewer slots than cases: each bad one leaves its slot to the next."""
    used, honest = [], batched_loop._run_queue

    def seen(task, *of_lanes):
        used.append(task.slots[0])
        return honest(task, *of_lanes)

    monkeypatch.setattr(batched_loop, "_run_queue", seen)
    monkeypatch.setattr(load_search, "SLOTS", 6)
    jax.clear_caches()  # a search traced before has the slots of then
    queued = bj.sweep(
        ELEMENT, loads(), outputs=NAMES, batches=bj.cases.Batches(chunk=50)
    )
    assert 6 in used
    np.testing.assert_array_equal(queued.result, from_contact.result)
    np.testing.assert_array_equal(queued.iterations, from_contact.iterations)
    for name in NAMES[:3]:
        got, want = getattr(queued, name), getattr(from_contact, name)
        np.testing.assert_allclose(got, want, rtol=1e-9, atol=1e-12 * np.nanmax(want))


def test_blocks_follow_each_other(swept, monkeypatch):
    monkeypatch.setattr(sweep_program, "BLOCK", 2)
    short = bj.sweep(
        ELEMENT, loads(), outputs=["displacement"], batches=bj.cases.Batches(chunk=8)
    )
    np.testing.assert_allclose(
        short.displacement, swept.displacement, rtol=1e-9, atol=1e-16
    )


@pytest.mark.slow
def test_designs_speeds_and_displacements_vary():
    def made(clearance):
        bearing = bj.CylindricalRollerBearing(
            6, 0.065, 0.010, 0.010, radial_internal_clearance=clearance
        )
        return bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(8))

    clearances = np.array([0.0, 10e-6, 30e-6])
    stacked = bj.stack_designs([made(c) for c in clearances])
    assert n_designs(stacked) == 3 and n_designs(made(0.0)) is None
    speeds, tilts = np.array([0.0, 300.0, 600.0]), np.array([0.0, 1e-4, 3e-4])
    cases = bj.Cases(
        [0, -2e3, 0, 0, 0, 0],
        prescribed={"gx": tilts},
        inner_speed=speeds,
        design=[2, 0, 1],
        hours=[1.0, 2.0, 3.0],
    )
    solved = bj.sweep(stacked, cases, outputs=["displacement"])
    under_vmap = bj.sweep(
        jax.vmap(made)(jnp.asarray(clearances[[2, 0, 1]])),
        bj.Cases(cases.load, prescribed={"gx": tilts}, inner_speed=speeds),
        outputs=["displacement"],
    )
    for k, design in enumerate(cases.design):
        one = bj.solve_load(
            made(clearances[design]),
            cases.load[k],
            support=bj.Support(prescribed={"gx": tilts[k]}),
            speed=bj.Speed(inner=speeds[k]),
        )
        for found in (solved, under_vmap):
            np.testing.assert_allclose(
                found.displacement[k], one.displacement, rtol=1e-8, atol=1e-14
            )


@pytest.mark.slow
def test_all_fields_or_a_function_of_the_solution():
    whole = bj.sweep(ELEMENT, loads()[:3], options=bj.statics.SolveOptions(points=5))
    assert whole.contact_pressure.shape == (3, 6, 2, 5)
    chosen = bj.sweep(
        ELEMENT, loads()[:3], outputs=lambda s: {"sag": s.displacement[7]}
    )
    named = {name for name in chosen.outputs if not name.startswith("warning_")}
    assert named == {"sag", "result", "unrestrained"}
    np.testing.assert_allclose(chosen.sag, whole.displacement[:, 7], rtol=1e-9)
    with pytest.raises(
        AttributeError, match="no output 'pressure'; it has result, sag"
    ):
        _ = chosen.pressure


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    """Two processes with two devices each."""
    folder = tmp_path_factory.mktemp("processes")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    runs = {
        "first": ["2", str(port), "2", "0"],
        "second": ["2", str(port), "2", "1"],
    }
    processes = {
        name: subprocess.Popen(
            [sys.executable, str(SCRIPT), str(folder / f"{name}.npz"), *arguments],
            stderr=subprocess.PIPE,
            text=True,
        )
        for name, arguments in runs.items()
    }
    for name, process in processes.items():
        _, errors = process.communicate(timeout=300)
        assert process.returncode == 0, f"{name}: {errors}"
    return {name: np.load(folder / f"{name}.npz") for name in runs}


@pytest.mark.parametrize("name", ["first", "second"])
@pytest.mark.slow
def test_devices_and_processes_share_the_cases(started, swept, name):
    found = started[name]
    assert found["devices"] == 4
    np.testing.assert_array_equal(found["result"], swept.result)
    np.testing.assert_allclose(
        found["displacement"], swept.displacement, rtol=1e-9, atol=1e-16
    )


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_table_has_units_and_a_result_for_each_case(swept, tmp_path, ending):
    path = tmp_path / f"table{ending}"
    write_table(sweep_table.columns(swept), path)
    read = pyarrow.csv.read_csv if ending == ".csv" else pyarrow.parquet.read_table
    table = read(path).to_pydict()
    assert list(table)[:4] == ["Fy [N]", "Fz [N]", "Mx [N m]", "result"]
    for header in ("displacement_inner_uy [m]", "stiffness_inner_ux_inner_gy [N]"):
        assert header in table
    assert table["result"][5] == "non_finite" and table["result"][7] == "no_load_path"
    np.testing.assert_allclose(
        np.array(table["displacement_inner_uy [m]"], dtype=float),
        swept.displacement[:, 7],
        rtol=1e-12,
    )


def test_sweep_to_xarray_has_names_and_units(swept):
    found = swept.to_xarray()
    moved = found.displacement.sel(ring_freedom="inner_uy")
    np.testing.assert_array_equal(moved, swept.displacement[:, 7])
    spring = found.stiffness.sel(ring_freedom="inner_ux", moved_ring_freedom="inner_gy")
    np.testing.assert_array_equal(spring, swept.stiffness[:, 6, 10])
    assert found.largest_load.dims == ("case",) and found.largest_load.units == "N"
    assert found.stiffness.units == "N/m, N, N m"
    np.testing.assert_array_equal(found["load"].sel(component="Fy"), loads()[:, 1])
    assert found.result.values[5] == "non_finite"


def test_columns_of_round_off_are_zero():
    """A true small number stays: one that is large in a single case, or of its unit."""
    moved = np.full((3, 12), np.nan)
    moved[:2] = 1e-5
    moved[0, :6] = [3e-22, 2e-22, 2e-15, 1e-22, 3e-14, 1e-22]
    moved[1, :6] = [-1e-21, 2e-8, 1e-15, -1e-22, 2e-14, 0.0]
    outputs = {
        "result": np.array([0, 0, 2]),
        "displacement": moved,
        "residual": moved[:, 0],
    }
    found = bj.cases.Sweep(bj.Cases(np.zeros((3, 6))), outputs, "inner")
    plain, exact = sweep_table.columns(found), sweep_table.columns(found, exact=True)
    names = [f"displacement_outer_{n} [m]" for n in ("ux", "uy", "uz")]
    names += [f"displacement_outer_{n} [rad]" for n in ("gx", "gy", "gz")]
    zero = {header for header in plain if not np.any(np.nan_to_num(plain[header]))}
    assert zero == {names[0], names[3], names[5]}
    for k, name in enumerate(names):
        np.testing.assert_array_equal(exact[name], moved[:, k])
        if name in zero:
            np.testing.assert_array_equal(plain[name], [0.0, 0.0, np.nan])
        else:
            np.testing.assert_array_equal(plain[name], moved[:, k])
    np.testing.assert_array_equal(plain["residual"], moved[:, 0])


LOADS = np.zeros((3, 6))
WRONG = {
    "outputs name": (dict(outputs=["presure"]), "names 'presure'; there are rib_load"),
    "outputs text": (dict(outputs="result"), "must be a list of names"),
    "displacements": (
        dict(support=bj.Support(prescribed={"uz": 1e-6})),
        "`support` has displacements; give them to the cases",
    ),
    "memory": (dict(options=bj.statics.SolveOptions(10**8)), "GiB, more than"),
    "design": (dict(cases=bj.Cases(LOADS, design=[0, 0, 0])), "`element` is one"),
}


@pytest.mark.parametrize("what", WRONG)
def test_bad_calls(what):
    change, message = WRONG[what]
    with pytest.raises(ValueError, match=message):
        bj.sweep(ELEMENT, **{"cases": LOADS, **change})


def test_bad_batches():
    with pytest.raises(ValueError, match="`chunk` is 0; it must be a whole number"):
        bj.cases.Batches(chunk=0)


def test_bad_cases():
    for wrong, message in [
        (dict(hours=[1.0, 2.0]), "not one number of cases: hours 2, load 3"),
        (dict(hours=[0.0, 0.0, 0.0]), "`hours` is 0 h in all; it must be finite, at"),
        (dict(hours=[1.0, 2.0, -3.0]), "`hours` is -3 h in case 2; it must be finite"),
        (dict(hours=[1.0, -1.0, 1.0]), "at least 0 h each"),
        (dict(prescribed={"uw": 0.0}), "names 'uw'"),
        (dict(load=np.zeros((3, 5))), r"shape \(3, 5\)"),
        (dict(load=np.zeros(6)), "nothing has a case axis"),
    ]:
        with pytest.raises(ValueError, match=message):
            bj.Cases(**{"load": LOADS, **wrong})


def test_cases_have_the_dtype_of_their_solutions():
    """Integers and float32 of JAX kept theirs: starts from others ended in the loop."""
    for dtype in (jnp.int32, jnp.float32):
        cases = bj.Cases(jnp.asarray(LOADS, dtype), inner_speed=jnp.arange(3))
        assert cases.load.dtype == cases.inner_speed.dtype == jnp.float64


def test_sweep_in_float32_starts_from_first_contact(monkeypatch):
    asked = []

    def noted(program, cases, near, *_):
        asked.append(near)
        return {"result": np.zeros(cases.count, int)}

    monkeypatch.setattr(sweep_program.Program, "run", noted)
    for wide in (True, False):
        with jax.enable_x64(wide):
            element = jax.tree.map(lambda a: jnp.asarray(a, float), ELEMENT)
            bj.sweep(element, bj.Cases(np.asarray(LOADS)))
    assert asked == [True, False]


def test_outputs_of_a_function_are_a_dict_of_arrays():
    """Others ended in an AttributeError of the program; a number passes."""
    solution = SimpleNamespace(converged=jnp.asarray(False), result=1, unrestrained=-1)

    def outputs(kept):
        task = sweep_program.Task(bj.Support(), SolveOptions(), lambda _: kept, False)
        return task.outputs(solution, bj.Cases(np.zeros((1, 6))))

    with pytest.raises(TypeError, match="`outputs` returns a list; .* dict of arrays"):
        outputs([1.0])
    with pytest.raises(TypeError, match="returns a dict as 'a'; .* array or a number"):
        outputs({"a": {"b": 1.0}})
    assert np.isnan(outputs({"a": 1.0})["a"])


def test_designs_of_several_numbers_of_rollers():
    """Each is as if alone; empty places have no results, and enter no largest one."""
    counts, load = (5, 9, 7), [400.0, 1500.0, 0, 0, 0, 0]
    bearings = [
        bj.CylindricalRollerBearing(n, 0.065, 0.010, 0.010, first_azimuth=0.1 * n)
        for n in counts
    ]
    stacked = bj.stack_designs([bj.BearingElement(b) for b in bearings])
    outputs = ["roller_load", "azimuth", "displacement", "largest_load"]
    outputs += ["basic_rating_life", "reference_rating_life"]
    swept = bj.sweep(stacked, np.tile(load, (3, 1)), outputs=outputs)
    for k, bearing in enumerate(bearings):
        alone = bj.solve_load(bj.BearingElement(bearing), load)
        n = bearing.n_rollers
        for name in ("roller_load", "azimuth"):
            found = getattr(swept, name)[k]
            assert np.isnan(found[n:]).all()
            np.testing.assert_allclose(found[:n], getattr(alone, name), 1e-9, 1e-6)
        np.testing.assert_allclose(swept.largest_load[k], alone.roller_load.max())
        np.testing.assert_allclose(
            swept.displacement[k], alone.displacement, rtol=SOLVER, atol=1e-15
        )
        life = bj.rating_life(alone)
        for name in ("basic_rating_life", "reference_rating_life"):
            np.testing.assert_allclose(
                getattr(swept, name)[k], getattr(life, name), rtol=SOLVER
            )


def test_bad_designs(swept):
    stacked = bj.stack_designs([ELEMENT, ELEMENT])
    with pytest.raises(ValueError, match="it holds designs, 2 of them"):
        bj.solve_load(stacked, LOADS[0])
    with pytest.raises(ValueError, match="2 designs for 3 cases"):
        bj.sweep(stacked, LOADS)
    with pytest.raises(ValueError, match="from 0 to 2; there are designs 0 to 1"):
        bj.sweep(stacked, bj.Cases(LOADS, design=[0, 1, 2]))
    ribs = bj.Ribs(inner_plus=bj.Rib(0.3, 1.5e-3))
    other = bj.CylindricalRollerBearing(7, 0.065, 0.01, 0.01, ribs=ribs)
    other = bj.BearingElement(other)
    with pytest.raises(ValueError, match="design 1 is of another structure"):
        bj.stack_designs([ELEMENT, other])
    with pytest.raises(ValueError, match="is empty"):
        bj.stack_designs([])
    with pytest.raises(ValueError, match="ends in .csv, .parquet, .xlsx"):
        write_table(sweep_table.columns(swept), "table.xls")


@pytest.mark.slow
def test_coupled_slices_on_two_devices_come_to_an_end():
    """A batch of their matrices is no LAPACK call whose parts wait for each other."""
    threads = {k: v for k, v in os.environ.items() if k != "PJRT_NPROC"}
    subprocess.run(
        [sys.executable, "-c", COUPLED], env=threads, timeout=300, check=True
    )


def test_a_traced_sweep_is_refused_at_once():
    with pytest.raises(TypeError, match="traced.*Map `solve_load"):
        jax.jit(lambda f: bj.sweep(ELEMENT, f).displacement)(jnp.asarray(loads()))

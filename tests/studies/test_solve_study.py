"""A solved scene as JSON and as a report, and by `bearingjax solve`: the same numbers,
or none at all."""

import dataclasses
import json
import re
import struct
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from runs import SEARCH, WORDS, Runs, Study
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.element import BallKinematics
from bearingjax.report.json_output import write_numbers
from bearingjax.studies.bearing.read_scene import Scene
from bearingjax.studies.bearing.solved import SolvedScene
from bearingjax.studies.solve.output import solution_json
from bearingjax.studies.solve.report import report, ring_force
from bearingjax.studies.solve.run import run_scene

POINTS = 21
TAPER = f"output.points={POINTS}"

FILES = {"--json": "a.json", "--plot": "a.png", "--table": "a.csv"}
STUDIES = {
    "rig": Study(
        ("solve", "cylindrical_rig"),
        WORDS | SEARCH,
        files=FILES,
        again=None,
    ),
    "taper": Study(
        ("solve", "tapered", "--set", TAPER),
        WORDS | SEARCH,
        files=FILES,
        again=None,
        unsolved={
            "pulled": (
                ("--set", "operating.load.Fz=-6 kN"),
                "no_load_path",
                "no_load_path: No load path in uz of the inner ring",
            )
        },
        slow=(False, False),
    ),
}


def test_ring_force_of_an_unloaded_bearing_is_zero(untyped):
    """Preloaded or turning, its rolling elements leave some round-off."""
    given = np.array([0.0] * 6 + [-7.1054e-14, 1.2e-8, 0.0, 1e-13, 0.0, 0.0])
    found = SimpleNamespace(force=given, roller_load=np.array([[65.0, 52.0]]))
    assert not ring_force(found).any()
    found.force = given + 0.5
    np.testing.assert_array_equal(ring_force(found), found.force)


class TestRuns(Runs):
    """Runs of the command; `test_echo` tests that its JSON is a scene again."""

    test_run_of_its_json_is_the_same = None  # pyright: ignore


@dataclasses.dataclass(frozen=True)
class Solved:
    """A scene, its solution, and what is written of them."""

    scene: Scene
    solution: bj.statics.Solution
    numbers: dict

    def __getitem__(self, name):
        return np.asarray(self.numbers[name])

    @property
    def found(self):
        return SolvedScene(self.scene, self.solution)

    @property
    def moving(self):
        return slice(0, 6) if self.scene.moving_ring == "outer" else slice(6, 12)


def solve(name, *settings):
    scene = bj.read_scene(name, settings)
    solution = run_scene(scene)
    return Solved(scene, solution, solution_json(SolvedScene(scene, solution)))


# Two structures are compiled; all else differs from them in numbers only.


@pytest.fixture(scope="module")
def rig():
    return solve("cylindrical_rig")


@pytest.fixture(scope="module")
def taper():
    return solve("tapered", TAPER)


@pytest.fixture(scope="module")
def pulled():
    return solve("tapered", TAPER, "operating.load.Fz=-6 kN")


@pytest.fixture(params=["rig", "taper"])
def solved(request):
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("name", ["taper", pytest.param("rig", marks=pytest.mark.slow)])
def test_solve_command_writes_and_prints_the_solution(request, written, name):
    done, numbers, paths = written(name)
    wanted = request.getfixturevalue(name)
    assert numbers == wanted.numbers
    assert done.out == f"{report(wanted.found)}\n"
    width, height = struct.unpack(">II", paths["--plot"].read_bytes()[16:24])
    assert width > 800 and height > 500
    assert paths["--plot"].stat().st_size > 50_000
    # A row for each rolling element.
    loads = np.transpose(wanted["roller_load"])
    for header, column in (
        ("element", np.arange(loads.shape[1])),
        ("azimuth [rad]", wanted["azimuth"]),
        ("roller_load_outer [N]", loads[0]),
        ("roller_load_inner [N]", loads[1]),
    ):
        assert np.array_equal(written(name).column(header), column)


def test_residual_is_that_of_the_solver(solved):
    assert solved.numbers["residual"] < SOLVER and solved.numbers["iterations"] > 0


def test_stiffness_is_symmetric_without_rows_of_the_set(solved):
    k = solved["stiffness"]
    assert np.allclose(k, k.T, rtol=0.0, atol=ROUNDING * np.abs(k).max())
    assert np.all(k[[5, 11]] == 0.0) and np.all(k[:, [5, 11]] == 0.0)


def test_force_is_the_load_and_stands_in_balance(solved):
    force, load = solved["force"], np.asarray(solved.scene.load)
    mine = force[solved.moving]
    free = [0, 1, 2, 3, 4] if solved.scene.free is None else [0, 1, 3, 4]
    atol = SOLVER * np.abs(load).max()
    assert np.allclose(mine[free], load[free], rtol=0.0, atol=atol)
    # No inertia acts along the axis or on the whole set, and moments are at the origin.
    assert np.allclose(force[:6] + force[6:], 0.0, rtol=0.0, atol=atol)


def test_displacement_of_fixed_ring_is_zero(solved):
    q = solved["displacement"].copy()
    q[solved.moving] = 0.0
    assert np.all(q == 0.0)


def test_positions_run_from_end_to_end(solved):
    half = 0.5 * float(solved.scene.element.bearing.roller_length)
    expected = np.linspace(-half, half, solved.scene.points)
    assert np.allclose(solved["position"], expected, rtol=0.0, atol=ROUNDING * half)


def test_azimuths_are_those_of_the_drawing(solved):
    bearing = solved.scene.element.bearing
    step = 2.0 * np.pi / bearing.n_rollers
    expected = float(bearing.first_azimuth) + step * np.arange(bearing.n_rollers)
    assert np.allclose(solved["azimuth"], expected, rtol=ROUNDING, atol=0.0)


def test_contact_pressure_nonzero_where_loaded(solved):
    load, pressure = solved["line_load"], solved["contact_pressure"]
    assert load.min() == 0.0 and pressure.min() == 0.0
    assert np.array_equal(load > 0.0, pressure > 0.0)
    assert 1e8 < pressure.max() < 5e9


def test_line_load_adds_up_to_the_roller_load(rig):
    sums = np.trapezoid(rig["line_load"], rig["position"], axis=2)
    # The solver's 20 slices against 100 trapezia; the load zone ends between them.
    assert np.allclose(sums, rig["roller_load"], rtol=5e-3, atol=1.0)


def test_logarithmic_rollers_are_unloaded_at_their_ends(taper):
    load = taper["line_load"]
    assert np.all(load[:, :, [0, -1]] == 0.0)
    assert load[:, :, POINTS // 2].min() > 0.0


@pytest.mark.slow
def test_solve_warns_of_free_tilt(taper):
    (text,) = taper.numbers["warnings"]
    tilt = 1e3 * np.hypot(*taper["displacement"][9:11])
    assert text.startswith(f"the ring tilts freely, {tilt:.3g} mrad where makers of ro")
    straight = solve("tapered", TAPER, "operating.prescribed={gx='0 deg', gy='0 deg'}")
    assert straight.numbers["warnings"] == []


def test_rib_load_at_existing_rib_only(rig, taper):
    assert np.all(rig["rib_load"] == 0.0)
    ribs = taper["rib_load"]
    assert np.all(ribs[:, [0, 1, 3]] == 0.0) and np.all(ribs[:, 2] > 0.0)


def test_edge_load_is_a_warning(rig):
    (text,) = rig.numbers["warnings"]
    assert text.startswith("edge-loaded roller:")
    for name in ("outer", "inner"):
        assert f"{name} raceway: rollers 0 to 2, 10, 11" in text
    assert rig["line_load"][0, :, 0].min() > 0.0


def test_json_is_the_dictionary(taper, tmp_path):
    path = tmp_path / "out.json"
    write_numbers(path, solution_json(taper.found))
    text = path.read_text(encoding="utf-8")
    assert text.endswith("}\n")
    assert json.loads(text) == taper.numbers


def test_json_without_solution_omits_numbers(pulled, tmp_path):
    assert {*pulled.numbers} == WORDS | SEARCH
    assert pulled.numbers["result"] == "no_load_path"
    assert pulled.numbers["message"].startswith("No load path in uz of the inner ring")
    assert pulled.numbers["warnings"] == []
    write_numbers(tmp_path / "out.json", solution_json(pulled.found))
    read = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))
    assert read == pulled.numbers


def test_json_has_null_for_nan(tmp_path):
    solved = solve("cylindrical_rig", "operating.load.Fy=1e300 N")
    assert {*solved.numbers} == WORDS | SEARCH
    assert solved.numbers["result"] == "non_finite"
    assert solved.numbers["residual"] is None
    write_numbers(tmp_path / "out.json", solution_json(solved.found))


ROW = re.compile(r"^ +(\d+) +(-?[\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+)(.*)$")


def rows(text):
    """Rows of the table of rollers: its numbers, and what stands behind them."""
    found = [ROW.match(line) for line in text.splitlines()]
    return [([float(x) for x in m.groups()[:6]], m[7]) for m in found if m]


def motion(text):
    """Displacements and loads of the report by name."""
    held = "(?: +reaction of its support)?"
    pattern = rf"^([ug][xyz]) +(\S+) (µm|mrad) +([FM][xyz]) +(\S+) (kN|N m){held}$"
    found = re.findall(pattern, text, re.MULTILINE)
    scale = {"µm": 1e-6, "mrad": 1e-3, "kN": 1e3, "N m": 1.0}
    shift = {f: float(v) * scale[unit] for f, v, unit, *_ in found}
    load = {f: float(v) * scale[unit] for *_, f, v, unit in found}
    return shift, load


def test_report_and_dict_run_no_jax_operations(solved):
    """Each small JAX operation on the way would be compiled, for 20 ms and more."""
    turning = BallKinematics(*np.ones((2, 4)), *np.ones((3, 4, 2)))
    with jax.transfer_guard("disallow"):  # nor can JAX compute with NumPy's numbers
        with pytest.raises(jax.errors.JaxRuntimeError):
            jnp.abs(turning.spin)
        assert str(report(solved.found))
        assert solution_json(solved.found) == solved.numbers
        assert np.all(turning.spin_to_roll == 1.0)
        assert np.allclose(turning.pitch_angle, np.pi / 4, rtol=SOLVER, atol=0.0)


@pytest.mark.slow
def test_spherical_roller_bearing_of_a_fan():
    """Rollers of row 0, then of row 1; no moment about the centre of the sphere."""
    fan = solve("spherical_roller", TAPER, "operating.inner_speed=0 rpm")
    assert fan["roller_load"].shape == (36, 2)
    assert fan["position"].shape == (36, POINTS)
    angle = np.deg2rad(9.5)
    shift = np.repeat([0.0, np.pi / 18], 18)
    turn = np.tile(2.0 * np.pi / 18 * np.arange(18), 2) + shift
    np.testing.assert_allclose(fan["azimuth"], turn, rtol=ROUNDING)
    load = np.array([0.0, -40e3, 8e3])
    atol = SOLVER * 40e3
    np.testing.assert_allclose(fan["force"][6:9], load, rtol=0.0, atol=atol)
    # About the origin of the inner ring, which has moved from there. Sections leave out
    # what axial forces do at its displacement along the circumference.
    moved = fan["displacement"][6:9]
    moment = -np.cross(moved, load)[:2]
    beside = np.hypot(*moved[:2]) * load[2]
    assert beside < 0.1 * np.hypot(*moment)
    np.testing.assert_allclose(fan["force"][9:11], moment, rtol=0.0, atol=beside)
    # The outer raceways see forces through the middle: along these normals.
    normal = [np.cos(turn) * np.cos(angle), np.sin(turn) * np.cos(angle)]
    normal.append(np.repeat([1.0, -1.0], 18) * np.sin(angle))
    sums = np.array(normal) @ fan["roller_load"][:, 0]
    np.testing.assert_allclose(sums, load, rtol=0.0, atol=1e-3 * 40e3)
    with jax.transfer_guard("disallow"):
        assert "each row: spherical roller" in str(report(fan.found))


def test_report_tells_the_motion_of_the_loaded_ring(solved):
    text = str(report(solved.found))
    moving, fixed = solved.scene.moving_ring, solved.scene.fixed_ring
    assert f"\n{moving} ring ({fixed} ring fixed)\n" in text
    assert f"\nstiffness of the {moving} ring (" in text
    shift, load = motion(text)
    assert list(shift) == list(bj.FREEDOMS)
    assert list(load) == ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    # Five digits; round-off of what cancels is shown as zero.
    q, force = solved["displacement"][solved.moving], solved["force"][solved.moving]
    assert np.allclose(list(shift.values()), q, rtol=1e-4, atol=1e-12)
    assert np.allclose(list(load.values()), force, rtol=1e-4, atol=1e-6)


def test_report_tells_the_stiffness(solved):
    text = str(report(solved.found))
    shown = re.findall(r"^[ug][xyz]((?: +[-+.e\d]+){5})$", text, re.MULTILINE)
    shown = np.array([[float(x) for x in line.split()] for line in shown])
    # kN/mm, kN/mrad, N m/mrad
    unit = np.full((5, 5), 1e6)
    unit[3:, 3:] = 1e3
    k = solved["stiffness"][solved.moving, solved.moving][:5, :5]
    assert np.allclose(unit * shown, k, rtol=1e-4, atol=1e-10 * np.abs(k).max())


def test_report_has_a_row_for_each_loaded_roller(solved):
    table = rows(str(report(solved.found)))
    loads = solved["roller_load"]
    pressure = np.asarray(solved.solution.roller_pressure)
    loaded = np.flatnonzero(loads.max(axis=1) > 1e-9 * loads.max())
    assert [int(numbers[0]) for numbers, _ in table] == list(loaded)
    degrees = np.rad2deg(solved["azimuth"][loaded]) % 360.0
    shown = np.array([numbers[1:] for numbers, _ in table])
    assert np.allclose(shown[:, 0], degrees, rtol=0.0, atol=0.051)
    assert np.allclose(1e3 * shown[:, 1:3], loads[loaded], rtol=0.0, atol=0.051)
    assert np.allclose(1e6 * shown[:, 3:], pressure[loaded], rtol=0.0, atol=0.051e6)


def test_report_of_the_rig(rig):
    text = str(report(rig.found))
    assert text.startswith(
        "cylindrical_rig: cylindrical roller bearing, 12 rollers 14 x 13.72 mm on a"
        " pitch circle of 72.5 mm\n"
        "radial internal clearance 0 µm; ribs: none; roller profile: CrownedEnds\n"
    )
    assert all(behind == "  edge-loaded" for _, behind in rows(text))
    assert "\n7 of 12 rollers are out of contact\n" in text
    assert len(re.findall(r"(?m)^warning: edge-loaded roller", text)) == 1
    assert "converged in " in text and "contact angle" not in text


def test_report_of_the_taper(taper):
    text = str(report(taper.found))
    assert "; ribs: inner_minus; roller profile: Logarithmic\n" in text
    assert "\ncontact angle: outer 12.72, inner 9.277 deg\n" in text
    shown = [float(behind) for _, behind in rows(text)]
    ribs = taper["rib_load"].sum(axis=1)
    assert np.allclose(shown, ribs, rtol=0.0, atol=0.051)
    assert "out of contact" not in text
    (warning,) = re.findall("(?m)^warning: (.*)$", text)
    assert warning == taper.numbers["warnings"][0]


def test_report_states_freedoms_speeds_materials_and_laws(rig, taper):
    """Freedoms, speeds, materials, laws: without them no number can be judged."""
    text = str(report(taper.found))
    assert "\nfree: ux uy uz gx gy (the default: all that the bearing" in text
    assert "\nouter ring 0 rpm, inner ring 3000 rpm; n·dm 1.56e+05 mm/min\n" in text
    material = "E = 206 GPa, Poisson's ratio 0.3, 7850 kg/m³\n"
    assert f"\nrollers and rings: {material}" in text
    assert "\nline law: Palmgren\n" in text
    text = str(report(rig.found))
    assert "\nfree: ux uy gx gy (as the scene says); held at zero: uz\n" in text
    assert "\nboth rings at rest\n" in text
    assert "\nquadrature: Midpoint (points 20)\n" in text
    hybrid = dataclasses.replace(
        rig.solution.element.bearing,
        material=bj.Material.silicon_nitride(),
        ring_material=bj.Material(),
    )
    other = eqx.tree_at(lambda s: s.element.bearing, rig.solution, hybrid)
    text = str(report(SolvedScene(rig.scene, other)))
    assert "\nrollers: E = 310 GPa, Poisson's ratio 0.26, 3200 kg/m³\n" in text
    assert f"\nrings: {material}" in text


def test_a_warning_of_the_drawing_is_told_with_the_solution():
    solved = solve("tapered", TAPER, "bearing.roller_half_angle=1.6 deg")
    text, _ = solved.numbers["warnings"]
    assert text.startswith("TaperedRollerBearing: the apexes of outer raceway")
    assert f"\nwarning: {text}" in str(report(solved.found))


def test_report_without_load():
    solved = solve("cylindrical_rig", "operating.load={}")
    text = str(report(solved.found))
    assert rows(text) == []
    assert "\n12 of 12 rollers are out of contact\n" in text
    assert np.all(solved["roller_load"] == 0.0)
    (line,) = solved.numbers["warnings"]
    assert line.startswith("no stiffness in ux, uy, gx, gy of the outer ring")


def test_nearest_cases_count_the_load_of_a_prescribed_place(run):
    place = "operating.prescribed={uz='150 um'}"
    done = run("solve", "deep_groove", "--set", place, "--set", "operating.load=unset")
    told = " ".join(done.out.partition("\nnearest cases ")[2].split())
    assert told and "times its load/d²" in told and "no load" not in told

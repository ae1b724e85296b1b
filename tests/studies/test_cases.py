"""`[cases]` of a scene: grid, list and spectrum, what may be wrong, the command."""

import json
import sys
from html import unescape

import equinox as eqx
import jax
import numpy as np
import pyarrow.csv
import pytest
from pages import missing_on_page

from bearingjax.cases import Cases, Sweep, sweep_table
from bearingjax.files import SceneError, table_file
from bearingjax.files import column_list as cases_list
from bearingjax.life import LifeConditions
from bearingjax.numerics.warning import Warning
from bearingjax.studies.bearing.read_scene import read_scene
from bearingjax.studies.cases import designs
from bearingjax.studies.cases import read_cases as cases_table
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.cases.sweep_run import (
    add_hours,
    default_outputs,
    design_columns,
    sweep_report,
)
from bearingjax.studies.solve.run import run_scene

HEAD = """
[bearing]
type = "cylindrical_roller"
n_rollers = 6
pitch_diameter = "65 mm"
roller_diameter = "10 mm"
roller_length = "10 mm"
radial_internal_clearance = "25 um"

[numerics]
quadrature = "midpoint"
points = 8

[operating]
load = { Fy = "-2 kN" }
"""
GRID = """
[cases.grid]
bearing.radial_internal_clearance = ["0 um", "20 um"]
operating.prescribed.gx = { start = "0 mrad", stop = "1 mrad", count = 3 }
operating.load.Fy = ["-1 kN", "-2000 N"]
"""
SPECTRUM = """
[[cases.spectrum]]
hours = "100 h"
operating.load.Fy = "-1 kN"
operating.inner_speed = "600 rpm"
[[cases.spectrum]]
hours = "30 min"
operating.load.Fy = "-4 kN"
operating.inner_speed = "60 rpm"
"""
LIST = """operating.load.Fy [kN],operating.load.Mx [N m],hours [h],bearing.n_rollers
-1,0.5,10,6

-2,0,20, 6
, , ,
"""


@pytest.fixture
def scene(tmp_path):
    """Write a scene with these cases; its path."""

    def write(text, head=HEAD, files=None):
        for name, content in (files or {}).items():
            (tmp_path / name).write_text(content)
        path = tmp_path / "many.toml"
        path.write_text(head + text)
        return path

    return write


def test_cases_grid_varies_last_key_fastest(scene):
    table = read_cases(scene(GRID))
    cases = table.cases
    assert cases.count == 12
    assert table.varied == (
        "bearing.radial_internal_clearance",
        "operating.prescribed.gx",
        "operating.load.Fy",
    )
    np.testing.assert_array_equal(cases.load[:, 1], [-1e3, -2e3] * 6)
    tilts = np.repeat([0.0, 0.5e-3, 1e-3, 0.0, 0.5e-3, 1e-3], 2)
    np.testing.assert_allclose(cases.prescribed["gx"], tilts, atol=1e-18)
    np.testing.assert_array_equal(cases.design, np.repeat([0, 1], 6))
    (structure,) = table.design_groups
    stacked = structure.element.bearing.radial_internal_clearance
    np.testing.assert_allclose(stacked, [0.0, 20e-6], atol=1e-18)
    (header,) = table.settings[1]
    assert header == "bearing.radial_internal_clearance [m]"
    assert table.settings[1][header] == 20e-6


def test_spectrum_has_hours(scene):
    table = read_cases(scene(SPECTRUM))
    np.testing.assert_allclose(np.array(table.cases.hours), [100.0, 0.5])
    np.testing.assert_allclose(table.cases.load[:, 1], [-1e3, -4e3])
    np.testing.assert_allclose(
        np.array(table.cases.inner_speed), [20 * np.pi, 2 * np.pi]
    )
    assert table.cases.design is None


def test_cases_list_units_in_header(scene):
    table = read_cases(scene('[cases]\nfile = "l.csv"', files={"l.csv": LIST}))
    np.testing.assert_allclose(table.cases.load[:, 1], [-1e3, -2e3])
    np.testing.assert_allclose(table.cases.load[:, 3], [0.5, 0.0])
    np.testing.assert_allclose(np.array(table.cases.hours), [10.0, 20.0])
    np.testing.assert_array_equal(table.cases.design, [0, 0])


OF_OTHERS = {
    "semicolons": ("utf-8", LIST.replace(",", ";").replace("0.5", "0,5")),
    "semicolons and points": ("utf-8", LIST.replace(",", ";")),
    "first line": ("utf-8-sig", "sep=;\r\n" + LIST.replace(",", ";")),
    "another first line": ("utf-8", "sep=|\n" + LIST.replace(",", "|")),
    "tabs": ("utf-16", LIST.replace(",", "\t").replace("0.5", "0,5")),
    "UTF-16": ("utf-16", LIST),
    "Windows": ("utf-8-sig", LIST.replace("\n", "\r\n")),
    "Macintosh": ("utf-8", LIST.replace("\n", "\r")),
    "minus": ("utf-8", LIST.replace("-1", "−1")),
}


@pytest.mark.parametrize("what", OF_OTHERS)
def test_cases_list_of_other_programs(scene, tmp_path, what):
    encoding, text = OF_OTHERS[what]
    name = "Lasten für Süd (1), 'neu'.csv"
    (tmp_path / name).write_bytes(text.encode(encoding))
    table = read_cases(scene(f'[cases]\nfile = "{name}"'))
    np.testing.assert_array_equal(table.cases.load[:, 1], [-1e3, -2e3])
    np.testing.assert_array_equal(table.cases.load[:, 3], [0.5, 0.0])
    np.testing.assert_array_equal(table.cases.design, [0, 0])


def test_cases_list_of_one_column_has_decimal_commas(scene):
    files = {"one.csv": "operating.load.Fy [kN]\n-1,5\n-2,25\n"}
    table = read_cases(scene('[cases]\nfile = "one.csv"', files=files))
    np.testing.assert_array_equal(table.cases.load[:, 1], [-1500.0, -2250.0])


def test_solve_leaves_the_cases_alone(scene):
    with_cases, without = read_scene(scene(GRID)), read_scene(scene(""))
    assert with_cases.load == without.load


@pytest.mark.slow
def test_command_writes_a_row_per_case(run, undrawn, scene, tmp_path):
    path = scene(GRID)
    csv, out, page = (tmp_path / f"t.{end}" for end in ("csv", "json", "html"))
    picture = tmp_path / "t.png"
    drawn = ("--report", page, "--plot", picture)
    ended = run("sweep", path, "--table", csv, "--json", out, *drawn)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert ended.status == 0 and "12 converged" in ended.out
    text = unescape(page.read_text(encoding="utf-8"))
    assert not missing_on_page(text, ended.out)
    assert path.read_text() in text and text.count("<td>converged</td>") == 12
    assert '<th scope="col">displacement_<wbr>inner_<wbr>uy [µm]</th>' in text
    shown = pyarrow.csv.read_csv(csv).to_pydict()
    assert list(shown)[0] == "bearing.radial_internal_clearance [µm]"
    assert shown["bearing.radial_internal_clearance [µm]"][::6] == [0.0, 20.0]
    table = {k: v.tolist() for k, v in sweep_table.read(csv).items()}
    # What stands still by construction has no column.
    moves = [name for name in table if name.startswith("displacement")]
    assert moves == [
        "displacement_inner_ux [m]",
        "displacement_inner_uy [m]",
        "displacement_inner_gx [rad]",
        "displacement_inner_gy [rad]",
    ]
    assert table["result"] == ["converged"] * 12
    one = run_scene(
        read_scene(
            path,
            [
                "bearing.radial_internal_clearance=20 um",
                "operating.prescribed.gx=1 mrad",
                "operating.load.Fy=-1 kN",
            ],
        )
    )
    for header, want in [
        ("displacement_inner_uy [m]", one.displacement[7]),
        ("largest_load [N]", one.roller_load.max()),
        ("peak_pressure [Pa]", one.roller_pressure.max()),
    ]:
        assert table[header][10] == pytest.approx(float(want), rel=1e-8)
    numbers = json.loads(out.read_text())
    assert numbers["counts"] == {"converged": 12}
    largest = numbers["columns"]["largest_load [N]"]
    np.testing.assert_allclose(table["largest_load [N]"], largest, rtol=1e-14)
    undrawn("sweep_overview", out, "sweep", path, "--table", csv, others=[csv])


def test_sweep_command_reports_failed_cases(run, scene, tmp_path):
    cases = '[cases.grid]\noperating.load.Fz = ["0 N", "100 N"]'
    ended = run("sweep", scene(cases), "--table", tmp_path / "t.csv")
    assert ended.status == 3 and "1 of 2 cases not solved" in ended.err
    table = pyarrow.csv.read_csv(tmp_path / "t.csv").to_pydict()
    assert table["result"] == ["converged", "no_load_path"]


def entry(text):
    return f'[[cases.spectrum]]\nhours = "1 h"\n{text}'


WRONG = {
    "none": ("", "`cases` is missing"),
    "nothing": ("[cases]\noutputs = ['n_loaded']", "must have one of `grid`, `file`"),
    "two": (GRID + SPECTRUM, "must have one of `grid`, `file`"),
    "empty grid": ("[cases.grid]", "is not a table of keys with their values"),
    "no list": (
        '[cases.grid]\noperating.load.Fy = "1 kN"',
        "`cases.grid.operating.load.Fy`: '1 kN' is not a list of values",
    ),
    "no unit": ("[cases.grid]\noperating.load.Fy = [1]", "has no unit; a force"),
    "wrong unit": ('[cases.grid]\noperating.load.Fy = ["1 mm"]', "is not a force"),
    "unknown key": ('[cases.grid]\noperating.load.Fq = ["1 kN"]', "cannot vary; what"),
    "numerics": ("[cases.grid]\nnumerics.points = [8]", "cannot vary; what can"),
    "bearing alone": ("[cases.grid]\nbearing = [8]", "cannot vary; what can"),
    "range key": (
        '[cases.grid]\noperating.load.Fy = { start = "0 N", end = "1 N", count = 3 }',
        "a range has start, stop and count",
    ),
    "range count": (
        '[cases.grid]\noperating.load.Fy = { start = "0 N", stop = "1 N", count = 1 }',
        "`count` is 1; a whole number from 2",
    ),
    "range units": (
        "[cases.grid]\nbearing.roller_length ="
        ' { start = "9 mm", stop = "1 cm", count = 3 }',
        "one and the same unit",
    ),
    "design value": ('[cases.grid]\nbearing.roller_length = ["-1 mm"]', "above 0 m"),
    "uneven outputs that can be kept": (
        '[cases]\noutputs = ["azimuth"]\n[cases.grid]\nbearing.n_rollers = [6, 7]',
        "then: displacement, force, stiffness, pitch_radius, equivalent_load,",
    ),
    "uneven outputs": (
        '[cases]\noutputs = ["roller_load"]\n[cases.grid]\nbearing.n_rollers = [6, 7]',
        "`cases.outputs`: 'roller_load' is of each rolling element or row, and their",
    ),
    "unknown table key": ("[cases]\ngird = 3\n" + GRID, "unknown key"),
    "no hours": (
        '[[cases.spectrum]]\noperating.load.Fy = "1 kN"',
        "`cases.spectrum[0].hours`: is missing",
    ),
    "uneven": (
        entry('operating.load.Fy = "1 kN"') + "\n" + entry(""),
        "`cases.spectrum[1].operating.load.Fy`: is missing",
    ),
    "no hours in all": ('[[cases.spectrum]]\nhours = "0 h"', "above 0 h in all"),
    "no file": ('[cases]\nfile = "none.csv"', "none.csv: cannot be read"),
    "header only": ('[cases]\nfile = "head.csv"', "has no cases"),
    "short row": ('[cases]\nfile = "short.csv"', "line 3 has 1 values, not 2"),
    "bad header": ('[cases]\nfile = "bad.csv"', "is no header such as"),
    "bad cell": (
        '[cases]\nfile = "cell.csv"',
        "cell.csv: line 4: operating.load.Fy: 'much' is not a finite number",
    ),
    "comma in a cell": (
        '[cases]\nfile = "comma.csv"',
        "line 2: operating.load.Fy: '1,5' is not a finite number; write a decimal po",
    ),
    "nan in a cell": ('[cases]\nfile = "nan.csv"', "'nan' is not a finite number"),
    "empty cell": ('[cases]\nfile = "gap.csv"', "line 3: operating.load.Fx: '' is not"),
    "empty setting": (
        '[cases]\nfile = "hole.csv"',
        "line 2: bearing.roller_length is empty",
    ),
    "unit missing": (
        '[cases]\nfile = "unit.csv"',
        'operating.load.Fy has no unit; head the column "operating.load.Fy [kN]"',
    ),
    "unit of another kind": (
        '[cases]\nfile = "kind.csv"',
        "kind.csv: the unit of operating.load.Fy: '1 mm' is not a force;",
    ),
    "twice": ('[cases]\nfile = "twice.csv"', "names a column twice"),
    "twice in two units": ('[cases]\nfile = "two.csv"', "twice, operating.load.Fy"),
    "two decimal marks": (
        '[cases]\nfile = "both.csv"',
        "both.csv: line 2 has a decimal comma, '1,5', and line 3 a decimal point",
    ),
    "thousands": (
        '[cases]\nfile = "thousands.csv"',
        "thousands.csv: line 2: the comma of '1,500' may be a decimal one or part th",
    ),
    "thousands and decimals": (
        '[cases]\nfile = "german.csv"',
        "german.csv: line 2: operating.load.Fy: '1.500,5' is not a finite number",
    ),
    "semicolons in a short row": (
        '[cases]\nfile = "semi.csv"',
        "semi.csv: line 3 has 1 values, not 2",
    ),
    "NUL": (
        '[cases]\nfile = "a\\u0000b.csv"',
        "cannot be read: a file name has no NUL",
    ),
    "pipe": ('[cases]\nfile = "/dev/zero"', "/dev/zero: cannot be read: it is a pipe"),
    "not text": ('[cases]\nfile = "zero.csv"', "zero.csv: cannot be read"),
    "folder": (
        '[cases]\nfile = "."',
        "`cases.file`: .: cannot be read: Is a directory",
    ),
    "no name": ("[cases]\nfile = 3", "`cases.file`: 3 is not a text"),
    "twice in a grid": (
        '[cases.grid]\n"operating.load.Fy" = ["1 N"]\noperating.load.Fy = ["2 N"]',
        "`cases.grid.operating.load.Fy`: stands there twice",
    ),
    "empty spectrum": ("[cases]\nspectrum = []", "[[cases.spectrum]], one at least"),
    "many": (
        "[cases.grid]\n"
        'operating.load.Fy = { start = "0 N", stop = "1 N", count = 10000 }\n'
        'operating.load.Fx = { start = "0 N", stop = "1 N", count = 10000 }',
        "has 100000000 cases; at most 10000000",
    ),
    "outputs": ('[cases]\noutputs = "all"\n' + GRID, "is not a list of names"),
}
FILES = {
    "head.csv": "operating.load.Fy [N]\n",
    "short.csv": "operating.load.Fy [N],operating.load.Fx [N]\n1,2\n1\n",
    "bad.csv": "load in y!\n1\n",
    "cell.csv": "operating.load.Fy [N]\n1\n\nmuch\n",
    "comma.csv": 'operating.load.Fy [N],operating.load.Fx [N]\n"1,5",2\n',
    "nan.csv": "operating.load.Fy [N]\nnan\n",
    "gap.csv": "operating.load.Fy [N],operating.load.Fx [N]\n1,2\n1,\n , \n",
    "hole.csv": "bearing.roller_length [mm],operating.load.Fx [N]\n,2\n",
    "kind.csv": "operating.load.Fy [mm]\n1\n",
    "two.csv": "operating.load.Fy [N],operating.load.Fy [kN]\n1,1\n",
    "semi.csv": "operating.load.Fy [N];operating.load.Fx [N]\n1,5;2\n1,5\n",
    "both.csv": "operating.load.Fy [N];operating.load.Fx [N]\n1,5;2\n1;2.5\n",
    "thousands.csv": "operating.load.Fy [N]\n1,500\n2,500\n",
    "german.csv": "operating.load.Fy [N];operating.load.Fx [N]\n1.500,5;2\n",
    "zero.csv": "operating.load.Fy [N]\n" + 200_000 * "1",
    "unit.csv": "operating.load.Fy\n1\n",
    "twice.csv": "operating.load.Fy [N],operating.load.Fy [N]\n1,1\n",
}


@pytest.mark.parametrize("what", WRONG)
def test_wrong_cases(scene, what):
    text, message = WRONG[what]
    with pytest.raises(SceneError) as caught:
        read_cases(scene(text, files=FILES))
    assert message in str(caught.value) and str(caught.value).startswith("many.toml:")
    assert "\n" not in str(caught.value)


def test_too_many_designs(scene, monkeypatch):
    monkeypatch.setattr(designs, "MOST_DESIGNS", 1)
    with pytest.raises(SceneError, match="`cases`: make 2 designs; at most 1"):
        read_cases(scene(GRID))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ('prescribed = { uy = "1 um" }', "Fy acts on uy, which is prescribed"),
        ('free = ["uy", "gx"]', "gx is free in this scene"),
    ],
)
def test_cases_against_the_scene(scene, change, message):
    head = HEAD.replace('load = { Fy = "-2 kN" }', change)
    with pytest.raises(SceneError, match=message):
        read_cases(scene(GRID, head))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--devices", "0"], "must be at least 1"),
        (["--devices", "1000000"], "the cores that there are"),
    ],
)
def test_sweep_command_rejects_invalid_arguments(run, scene, arguments, message):
    ended = run("sweep", scene(GRID), *arguments)
    assert ended.status == 2 and message in ended.err


@pytest.mark.parametrize(
    ("name", "needed"),
    [("x.parquet", "pandas and pyarrow"), ("x.XLSX", "pandas and openpyxl")],
)
def test_sweep_table_rejected_without_optional_package(
    run, scene, monkeypatch, name, needed
):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    monkeypatch.setattr("bearingjax.studies.cases.sweep_run.run_cases", None)
    ended = run("sweep", scene(GRID), "--table", name)
    problem = f"{name[1:].lower()} tables need {needed}, .csv nothing"
    cure = 'pip install "bearingjax[table]"'
    assert ended == (2, "", f"bearingjax: {problem}: {cure}\n")
    # All that is missing at once.
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    ended = run("sweep", scene(GRID), "--table", name, "--plot", "x.png")
    cure = 'pip install "bearingjax[plot,table]"'
    problem = f"pictures need matplotlib; {problem}"
    assert ended == (2, "", f"bearingjax: {problem}: {cure}\n")


def test_sweep_table_rejects_rows_above_sheet_limit(run, scene, monkeypatch):
    monkeypatch.setattr(table_file, "MOST_ROWS", 11)
    monkeypatch.setattr("bearingjax.studies.cases.sweep_run.run_cases", None)
    ended = run("sweep", scene(GRID), "--table", "x.xlsx")
    assert ended.status == 2
    assert "x.xlsx: 12 rows, and a sheet has 11 at most; write .csv" in ended.err


COUNTS = """
[cases.grid]
bearing.n_rollers = [6, 7]
operating.load.Fy = ["-1 kN", "-2000 N"]
"""
PROFILES = """
bearing.roller_profile = [{ type = "straight" }, { type = "logarithmic" }]
"""


@pytest.mark.slow
def test_designs_of_several_structures(run, scene, tmp_path):
    """As many programs, one table."""
    path, out, sheet = scene(COUNTS), tmp_path / "t.json", tmp_path / "t.xlsx"
    ended = run("sweep", path, "--json", out, "--table", sheet)
    assert ended.status == 0 and "4 converged" in ended.out
    assert "2 designs of 2 structures, solved one after the other" in ended.out
    found = json.loads(out.read_text())["columns"]
    assert found["bearing.n_rollers"] == [6, 6, 7, 7]
    settings = ["bearing.n_rollers=7", "operating.load.Fy=-2 kN"]
    one = run_scene(read_scene(path, settings))
    assert found["largest_load [N]"][3] == pytest.approx(
        float(one.roller_load.max()), rel=1e-8
    )
    # The sheet holds the same numbers, to the 16 digits that it has.
    again = sweep_table.read(sheet)
    assert list(again) == list(found)
    for header, column in found.items():
        if np.asarray(column).dtype.kind == "U":
            assert list(again[header]) == column
        else:
            np.testing.assert_allclose(again[header], column, rtol=1e-14)


def test_profiles_may_vary(scene):
    table = read_cases(scene(COUNTS + PROFILES))
    assert [list(part.designs) for part in table.design_groups] == [[0], [1], [2], [3]]
    column = design_columns(table)["bearing.roller_profile"]
    assert column[2] == "{'type': 'logarithmic'}" and column.size == 8


def test_the_echo_is_the_scene(scene, tmp_path):
    table = read_cases(scene(GRID))
    echo = tmp_path / "echo.json"
    echo.write_text(json.dumps({"inputs": table.inputs}))
    again = read_cases(echo)
    assert again.inputs == table.inputs and again.settings == table.settings
    for one, other in zip(
        jax.tree.leaves((table.cases, table.design_groups[0].element)),
        jax.tree.leaves((again.cases, again.design_groups[0].element)),
        strict=True,
    ):
        np.testing.assert_array_equal(one, other)


def test_wrong_outputs(run, scene):
    ended = run("sweep", scene('[cases]\noutputs = ["presure"]\n' + GRID))
    assert ended.status == 2 and "names 'presure'; there are" in ended.err


def test_warnings_of_designs_merge_if_alike_but_for_numbers():
    texts = "loose by 0.42 µm", "loose by 3e-1 µm", "x"
    said = [Warning("loose_ring", text) for text in texts]
    told = cases_table._merge_warnings(said[:1], said)
    assert told == ("loose by 0.42 µm (2 designs alike)", "x")


def test_a_report_shows_no_round_off(scene):
    """Of stiffness beside it of the same unit; small pure numbers stay."""
    grid = '[cases]\ngrid = { "operating.load.Fy" = ["-1 kN", "-2 kN"] }\n'
    table = read_cases(scene(grid))
    stiffness = np.zeros((2, 12, 12))
    stiffness[:, 6, [6, 7]], stiffness[:, 9, [9, 10]] = (5e8, 4e-8), (7e3, 2e-5)
    outputs = {
        "result": np.zeros(2, int),
        "stiffness": stiffness,
        "residual": np.full(2, 3e-16),
        "force": np.full((2, 12), -7.1e-14),
        "largest_load": np.full(2, 65.0),
        "iterations": np.full(2, 9),
    }
    report = sweep_report(table, Sweep(table.cases, outputs, "inner"), 1.0)
    lines = str(report).splitlines()
    told = {line.split()[0]: line.split()[1:] for line in lines if line}
    assert told["stiffness_inner_ux_inner_ux"] == ["5e+08", "5e+08", "N/m"]
    assert "stiffness_inner_ux_inner_uy" not in told and "force_inner_Fx" not in told
    assert told["stiffness_inner_gx_inner_gy"] == ["2e-05", "2e-05", "N", "m"]
    assert told["residual"] == ["3e-16", "3e-16"]


@pytest.mark.parametrize("text, value", [("12", 12), ("1.5", 1.5), ("C3", "C3")])
def test_cells_without_unit_are_numbers_or_text(text, value):
    found = cases_list._parse_value(text)
    assert found == value and isinstance(found, type(value))


def test_a_method_that_needs_an_energy_is_refused_for_turning_balls():
    turning = "cases={ grid = { 'operating.inner_speed' = ['0 rpm', '3000 rpm'] } }"
    with pytest.raises(SceneError, match="`numerics.equilibrium`: minimises an energy"):
        read_cases("deep_groove", ["numerics.equilibrium=bfgs", turning])


def test_cases_of_one_design_are_of_the_preloaded_pair():
    loads = "cases={ grid = { 'operating.load.Fy' = ['-1 kN', '-2 kN'] } }"
    pressed = "set={ arrangement = 'back_to_back', spacing = '17 mm',"
    pressed += " preload_force = '300 N' }"
    table = read_cases("ball_pair", [pressed, loads])
    (group,) = table.design_groups
    assert eqx.tree_equal(group.element, table.scene.running())
    assert not eqx.tree_equal(group.element, table.scene.element)


def test_sweep_tells_lives_of_a_scene_with_life():
    """In hours beside the revolutions, and whether the required one is kept."""
    element = read_scene("cylindrical_rig").element
    kept = default_outputs(element, None, True)
    assert not any("life" in name for name in kept)
    oiled = LifeConditions(viscosity=1e-5, contamination=0.5, required=100.0)
    kept = default_outputs(element, oiled, True)
    assert {"modified_rating_life", "life_hours", "a_iso"} < set(kept)
    assert "life_hours" not in default_outputs(element, LifeConditions(), False)
    cases = Cases(np.zeros((3, 6)), inner_speed=np.array([100.0, 50.0, 0.0]))
    turns = np.array([100.0, 50.0, 0.0]) * 3600 / (2 * np.pi)
    life = np.array([2e7, 2e6, np.inf])
    found = {"basic_rating_life [rev]": life, "damage [1/rev]": 1 / life}
    made = add_hours(found, cases, oiled)
    hours = made["basic_rating_life [h]"]
    np.testing.assert_allclose(hours[:2], life[:2] / turns[:2], rtol=1e-12)
    np.testing.assert_allclose(made["life_factor"], hours / 100.0, rtol=1e-12)
    assert made["life_kept"].tolist() == [True, False, True]
    assert list(add_hours(found, Cases(np.zeros((3, 6))), oiled)) == list(found)
    counted = add_hours(found, cases, LifeConditions(required_revolutions=1e7))
    np.testing.assert_allclose(counted["life_factor"], life / 1e7)

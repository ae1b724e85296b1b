"""A sweep that is interrupted keeps what is solved, and is taken up where it ended."""

import json
import signal

import numpy as np
import pyarrow.csv
import pytest
from test_cases import HEAD

from bearingjax import FREEDOMS, Cases
from bearingjax.cases import Sweep, batches, sweep_program, sweep_table
from bearingjax.cases.sweep_table import (
    case_columns,
    left_out,
    read,
    restore_outputs,
)
from bearingjax.files import table_file
from bearingjax.files.table_file import write_table
from bearingjax.numerics.result import Result
from bearingjax.studies.cases import resume
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.cases.sweep_run import design_columns

# In the part that is solved first one load is nought throughout.
LIST = """operating.load.Fy [kN],operating.load.Fx [kN]
-1,0
-1.5,0
-2,0
-2.5,1
-3,1
-4,1
"""


@pytest.fixture
def struck(monkeypatch):
    """Blocks of two cases; the signal that is set comes while one is under way."""
    wanted = []
    honest = sweep_program._solve_block

    def solve(*given):
        out = honest(*given)
        if wanted:
            signal.raise_signal(wanted.pop())
        return out

    monkeypatch.setattr(sweep_program, "_solve_block", solve)
    monkeypatch.setattr(sweep_program, "BLOCK", 1)
    monkeypatch.setattr(batches, "CHUNK", 2)
    monkeypatch.setattr(resume, "CHECKED", 2)
    # Begun in the background, this process would not hear it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield wanted
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def scene(tmp_path):
    def write(name="many.toml", head=HEAD, rows=LIST):
        (tmp_path / "l.csv").write_text(rows)
        (tmp_path / name).write_text(f'{head}\n[cases]\nfile = "l.csv"\n')
        return tmp_path / name

    return write


def columns(path):
    return pyarrow.csv.read_csv(path).to_pydict()


@pytest.mark.parametrize("ending", ["csv", "parquet", "xlsx"])
@pytest.mark.slow
def test_interrupted_twice_and_taken_up(run, scene, tmp_path, struck, ending):
    path, table, out = scene(), tmp_path / f"t.{ending}", tmp_path / "t.json"
    words = ("sweep", str(path), "--table", str(table), "--json", str(out))
    struck.append(signal.SIGINT)
    done = run(*words)
    assert done.status == 130 and "2 converged, 4 not_run" in done.out
    again = f"bearingjax {' '.join(words)} --resume"
    want = f"bearingjax: interrupted: 4 of 6 cases not run; go on with: {again}"
    assert done.err.splitlines()[-1] == want
    first = json.loads(out.read_text())["columns"]
    assert first["result"] == ["converged"] * 2 + ["not_run"] * 4
    assert first["Fx [N]"] == [0.0, 0.0, 0.0, 1e3, 1e3, 1e3]
    assert first["largest_load [N]"][2:] == [None] * 4
    struck.append(signal.SIGTERM)
    done = run(*words, "--resume")
    assert done.status == 143 and "4 converged, 2 not_run" in done.out
    assert done.err.splitlines()[-1].endswith(
        f"2 of 6 cases not run; go on with: {again}"
    )
    done = run(*words, "--resume")
    assert done.status == 0 and "6 converged" in done.out
    resumed = json.loads(out.read_text())["columns"]
    assert run("sweep", path, "--json", out).status == 0
    whole = json.loads(out.read_text())["columns"]
    assert list(resumed) == list(whole)
    for header, column in whole.items():
        # Steps depend on the cases that were solved before.
        if header not in ("result", "residual", "iterations", "warnings"):
            np.testing.assert_allclose(
                resumed[header], column, rtol=1e-9, atol=1e-15, err_msg=header
            )
    assert any(whole["warnings"]) and resumed["warnings"] == whole["warnings"]
    np.testing.assert_allclose(
        resumed["largest_load [N]"][:2], first["largest_load [N]"][:2], rtol=1e-14
    )
    # Nothing left: the table as it is.
    done = run(*words, "--resume")
    assert done.status == 0 and "6 converged" in done.out


def test_resume_puts_new_cases_in_their_places(scene, tmp_path, monkeypatch):
    """Cases that are missing between those that were solved, and a failed one."""
    ran = []

    def run_cases(table, *_):
        load = -np.asarray(table.cases.load)[:, 1]
        ran.append(load.tolist())
        outputs = {"result": np.where(load == 3e3, 1, 0), "largest_load": 2 * load}
        return Sweep(table.cases, outputs, "inner")

    monkeypatch.setattr(resume, "run_cases", run_cases)
    monkeypatch.setattr(resume, "CHECKED", 2)
    table, place = read_cases(scene()), tmp_path / "t.csv"
    whole = run_cases(table)
    left = np.isin(np.arange(6), [1, 3, 5])
    outputs = {
        "result": np.where(left, int(Result.NOT_RUN), whole.outputs["result"]),
        "largest_load": np.where(left, np.nan, whole.outputs["largest_load"]),
    }
    write_table(
        sweep_table.columns(
            Sweep(table.cases, outputs, "inner"), design_columns(table)
        ),
        place,
    )
    again = resume.resume_cases(table, place)
    for name, values in whole.outputs.items():
        np.testing.assert_array_equal(again.outputs[name], values)
    # The last of those that were solved, to check them, then what is missing.
    assert ran[1:] == [[1e3, 2e3], [1.5e3, 2.5e3, 4e3]]


def test_resume_rejects_table_of_other_scene(run, scene, tmp_path, struck):
    path, table = scene(), tmp_path / "t.csv"
    struck.append(signal.SIGINT)
    assert run("sweep", path, "--table", table).status == 130
    before = table.read_bytes()
    for rows, problem in {
        LIST.replace("-1.5,0", "-1.6,0"): (
            "Fy [N] of case 1 is -1500.0, in this scene -1600.0; name the table"
        ),
        LIST + "-5,1\n": "has 6 cases, this scene 7",
        LIST.replace("Fx [kN]", "Fz [kN]"): "has no column 'Fz [N]', which this scene",
    }.items():
        done = run("sweep", scene(rows=rows), "--table", table, "--resume")
        assert done.status == 2 and done.err.count("\n") == 1
        assert f"t.csv: {problem}" in done.err
    thick = HEAD.replace('length = "10 mm"', 'length = "11 mm"')
    done = run("sweep", scene(head=thick), "--table", table, "--resume")
    assert done.status == 2
    assert "t.csv: 2 of its cases, solved again, end otherwise" in done.err
    assert table.read_bytes() == before
    table.write_bytes(before.replace(b"largest_load", b"load"))
    done = run("sweep", scene(), "--table", table, "--resume")
    assert done.status == 2 and "t.csv: has no column 'largest_load [N]'" in done.err
    table.write_text("no table\n")
    done = run("sweep", scene(), "--table", table, "--resume")
    assert done.status == 2 and "has no column 'result'" in done.err


@pytest.mark.parametrize("ending", ["csv", "parquet", "xlsx"])
def test_resume_design_columns_round_trip(tmp_path, ending):
    """A clearance with its unit, bare numbers of other spellings, a load of nought."""
    grid = """
[cases.grid]
bearing.radial_internal_clearance = ["0 um", "1e-3 mm"]
bearing.material.poisson_ratio = [0.3, 31e-2]
operating.load.Fy = ["-0.1 kN", "-1 kN"]
"""
    path, place = tmp_path / "many.toml", tmp_path / f"t.{ending}"
    path.write_text(HEAD + grid)
    table = read_cases(path)
    load = np.where(np.arange(8) < 7, np.arange(8.0), np.nan)
    outputs = {"result": np.repeat([0, 5], [7, 1]), "largest_load": load}
    designs = design_columns(table)
    write_table(
        sweep_table.columns(Sweep(table.cases, outputs, "inner"), designs), place
    )
    known = read(place)
    resume.check_asked(place, known, {**designs, **case_columns(table.cases)}, 8)
    again = restore_outputs(known, outputs)
    for name, values in outputs.items():
        np.testing.assert_array_equal(again[name], values)


def test_resume_restores_omitted_zero_columns(tmp_path):
    """A tilt held at zero, free motions that are, a ring that stands; a tilt that is
    zero in some cases only has its column."""
    tilts = {"gx": [0.0, 0.0, 0.0], "gy": [0.0, 1e-3, 0.0]}
    load, speeds = np.tile([0, -1e3, 0, 0, 0, 0], (3, 1)), {"outer_speed": 0.0}
    cases = Cases(load, prescribed=tilts, inner_speed=[0.0, 5.0, 5.0], **speeds)
    q = np.zeros((3, 12))
    q[:, 7], q[:, 10] = [-1e-6, -2e-6, np.nan], tilts["gy"]
    q[2] = np.nan
    outputs = {"result": np.array([0, 0, 5]), "displacement": q}
    outputs["n_loaded"] = np.zeros(3, int)
    outer = tuple(f"outer_{name}" for name in FREEDOMS)
    zeros = (("displacement", (*outer, "inner_gz")),)
    sweep = Sweep(cases, outputs, "inner", zeros)
    place = tmp_path / "t.csv"
    write_table(sweep_table.columns(sweep), place)
    known = read(place)
    wanted = [f"displacement_inner_{name}" for name in ("uy [m]", "gy [rad]")]
    given = ["Fy [N]", "prescribed_gy [rad]", "inner_speed [rad/s]"]
    assert list(known) == [*given, "result", *wanted]
    again = restore_outputs(known, outputs, left_out(sweep))
    for name, values in outputs.items():
        np.testing.assert_array_equal(again[name], values)
    del known["displacement_inner_uy [m]"]
    with pytest.raises(ValueError, match="no column 'displacement_inner_uy"):
        restore_outputs(known, outputs, left_out(sweep))


def test_interrupted_while_the_table_is_written(
    run, scene, tmp_path, struck, monkeypatch
):
    def late(*given):
        signal.raise_signal(signal.SIGINT)
        return write_table(*given)

    monkeypatch.setattr(table_file, "write_table", late)
    table = tmp_path / "t.csv"
    done = run("sweep", scene(), "--table", table)
    assert done.status == 0
    assert done.err.splitlines()[-1].endswith("interrupted, but all cases were run")
    assert columns(table)["result"] == ["converged"] * 6


def test_resume_needs_a_table(run, scene):
    done = run("sweep", scene(), "--resume")
    problem = "--resume takes up a table; name it with --table"
    assert done == (2, "", f"bearingjax: {problem}\n")


def test_interrupted_sweep_without_table_suggests_resume(run, scene, struck):
    struck.append(signal.SIGINT)
    done = run("sweep", scene())
    assert done.status == 130
    assert done.err.splitlines()[-1].endswith(
        "4 of 6 cases not run; with --table what is solved is kept, and --resume goes"
        " on from it"
    )

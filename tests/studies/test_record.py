"""A record in time as `[cases]`: reading, what is refused, `bearingjax life`."""

import json
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas
import pytest
from tolerances import SOLVER

import bearingjax as bj
from bearingjax.cases import SERIES_OUTPUTS, Sweep, series_life
from bearingjax.files import SceneError
from bearingjax.lubrication import OILS
from bearingjax.studies.cases.life_run import _record_in_words
from bearingjax.studies.cases.read_cases import read_cases

SCENE = """
[bearing]
type = "deep_groove_ball"
n_balls = 7
pitch_diameter = "43.5 mm"
ball_diameter = "11.5 mm"
outer_osculation = 0.53
inner_osculation = 0.52
radial_internal_clearance = "10 um"

[operating]
load = { Fx = "2 kN" }
free = ["ux", "uy", "uz"]

[life]
dynamic_capacity = "23.4 kN"
contamination = 0.5

[lubricant]
name = "ISO VG 68"
temperature = "70 °C"

[cases]
file = "duty.csv"
"""
HEAD = "time [s],operating.load.Fx [kN],operating.inner_speed [rpm]\n"
SWING = "oscillation.amplitude [deg],oscillation.frequency [Hz]"
OIL = "time [s],lubricant.temperature [°C]\n"
PLAIN = HEAD + "0,1,100\n600,2,100\n1200,1,100\n1800,2.5,0\n"


@pytest.fixture
def read(tmp_path):
    """Read a record with the scene; more lines of [cases]."""

    def of(text, more="", scene=SCENE, name="duty.csv"):
        if isinstance(text, str):
            (tmp_path / name).write_text(text, encoding="utf-8")
        path = tmp_path / "scene.toml"
        path.write_text(scene.replace("duty.csv", name) + more, encoding="utf-8")
        return read_cases(path)

    return of


def numbers(table):
    """Loads, speeds and hours of the rows of a record."""
    series = table.series
    cases = series.cases
    columns = cases.load[:, 0], cases.inner_speed
    return [*(np.asarray(c)[series.case] for c in columns), series.hours]


WRITTEN = {
    "semicolons": HEAD.replace(",", ";") + "0;1;100\n600;2;1e2\n1200;1;100\n1800;2,5;0",
    "tabs": PLAIN.replace(",", "\t"),
    "first line": "sep=;\n" + PLAIN.replace(",", ";"),
    "empty lines": PLAIN.replace("\n", "\n\n"),
    "quotes": PLAIN.replace("2.5", '"2.5"'),
    "instants": PLAIN.replace("time [s]", "time")
    .replace("\n0,", "\n2024-02-28T23:50,")
    .replace("\n600,", "\n2024-02-29 00:00:00,")
    .replace("\n1200,", "\n2024-02-29T00:10,")
    .replace("\n1800,", "\n2024-02-29T00:20:00.000,"),
    "offsets": PLAIN.replace("time [s]", "time")
    .replace("\n0,", "\n2024-10-27T02:50+02:00,")
    .replace("\n600,", "\n2024-10-27T02:00+01:00,")
    .replace("\n1200,", "\n2024-10-27T01:10Z,")
    .replace("\n1800,", "\n2024-10-27T02:20+01:00,"),
    "hours": PLAIN.replace("time [s]", "time [h]")
    .replace("\n600,", f"\n{1 / 6},")
    .replace("\n1200,", f"\n{1 / 3},")
    .replace("\n1800,", "\n0.5,"),
}


@pytest.mark.parametrize("what", WRITTEN)
def test_record_is_read_however_it_is_written(read, what):
    for found, expected in zip(
        numbers(read(WRITTEN[what])), numbers(read(PLAIN)), strict=True
    ):
        np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("instants", [False, True])
def test_record_of_a_parquet_table(read, tmp_path, instants):
    rows = np.array([row.split(",") for row in PLAIN.split()[4:]], float)
    frame = pandas.DataFrame(rows, columns=HEAD.strip().split(","))
    if instants:
        when = pandas.to_datetime(frame.pop("time [s]"), unit="s")
        frame.insert(0, "time", when.dt.tz_localize("UTC"))
    frame.to_parquet(tmp_path / "duty.parquet")
    found = numbers(read(None, name="duty.parquet"))
    for one, expected in zip(found, numbers(read(PLAIN)), strict=True):
        np.testing.assert_array_equal(one, expected)
    frame.iloc[2, 1] = np.nan
    frame.to_parquet(tmp_path / "duty.parquet")
    with pytest.raises(SceneError, match="line 3: Fx is no finite number"):
        read(None, name="duty.parquet")


def test_temperature_of_each_row_is_that_of_its_oil(read):
    oil = OILS["ISO VG 68"]()
    expected = [float(oil.kinematic_viscosity(273.15 + t)) for t in (40, 70, 40)]
    turning = read(
        OIL.replace("\n", ",operating.inner_speed [rpm]\n") + "0,40,9\n1,70,9\n2,40,9\n"
    )
    found = np.asarray(turning.cases.viscosity)[turning.series.case]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert turning.cases.count == 2 and turning.design_groups[0].designs is None


def test_oscillations_turn_with_their_mean_speed(read):
    head = HEAD.strip() + f",{SWING}\n"
    table = read(head + "0,1,0,30,0.5\n600,1,100,0,0\n")
    cases, case = table.cases, table.series.case
    mean = 4 * np.radians(30) * 0.5
    np.testing.assert_allclose(
        np.asarray(cases.inner_speed)[case], [mean, 100 * np.pi / 30]
    )
    np.testing.assert_allclose(
        np.asarray(cases.oscillation)[case], [np.radians(30), 0.0]
    )


WRONG = {
    "is 600 s in line 3 and 500 s in line 4; it must ascend": HEAD
    + "0,1,9\n600,2,9\n500,1,9",
    "is 600 s in line 4 and 500 s in line 5": HEAD + "\n0,1,9\n600,2,9\n500,1,9",
    "is 600 s in line 3 and 600 s in line 4": HEAD + "0,1,9\n600,2,9\n600,1,9",
    "has gaps: line 3: Fx is no finite number. Leave": HEAD
    + "0,1,9\n600,nan,9\n700,1,9",
    "has gaps: line 4: Fx is no": HEAD + "0,1,9\n\n600,abc,9\n700,1,9",
    "line 3: inner_speed is no": HEAD + "0,1,9\n600,2,\n700,1,9",
    "line 2: time is no finite": HEAD + "then,1,9\n600,2,2\n700,1,9",
    "line 5: Fx is no finite number; line 7: Fx is no finite number; and 7 more": HEAD
    + "".join(f"{k},{'x' if k % 2 else 1},9\n" for k in range(20)),
    "line 7: 277.8 h until the next row, 0.0002778 h are usual": HEAD
    + "".join(f"{k + 1e6 * (k > 5)},1,9\n" for k in range(20)),
    "line 2: time is '0', without a unit; head the column \"time [s]\"": HEAD.replace(
        " [s]", ""
    )
    + "0,1,9\n600,2,9",
    "is array([nan, nan]); it must be numbers, or instants such as": HEAD.replace(
        " [s]", ""
    )
    + "1.5.2024 12:10,1,9\n1.5.2024 12:20,2,9",
    "unknown unit 'foo'": HEAD.replace("[s]", "[foo]") + "0,1,9\n1,1,9",
    "'1 rpm' is not a force": HEAD.replace("[kN]", "[rpm]") + "0,1,9\n1,1,9",
    "operating.load.Fx has no unit": HEAD.replace(" [kN]", "") + "0,1,9\n1,1,9",
    "has two rows at least, and no `hours`": HEAD + "0,1,9",
    "has no cases; a header": HEAD,
    "a header and rows are wanted": "",
    "line 3 has 2 values, not 3": HEAD + "0,1,9\n1,1\n",
    "names a column twice": "time [s],time [h]\n0,1\n1,2",
    "and no `hours`": "time [s],hours [h]\n0,1\n1,2",
    "bearing.n_bals`: unknown key": "time [s],bearing.n_bals\n0,7\n1,8",
    "is 20 deg in line 3; it must be 0 or, at rings of 0 rpm": HEAD.strip()
    + f",{SWING}\n0,1,9,0,0\n1,1,9,20,1",
    "is 181 deg in line 2; it must be 0": HEAD.strip()
    + f",{SWING}\n0,1,0,181,1\n1,1,9,0,0",
    "is -5 deg in line 2": HEAD.strip() + f",{SWING}\n0,1,0,-5,1\n1,1,9,0,0",
    "and a frequency above 0 Hz, up to 180 deg": HEAD.strip()
    + f",{SWING}\n0,1,0,5,0\n1,1,9,0,0",
    "`cases.oscillation.frequency`: is missing beside": (
        f"time [s],{SWING[:27]}\n0,1\n1,2"
    ),
    "is 300 °C in a case; it must be -60": OIL + "0,70\n1,300",
    "line 3: viscosity, or temperature, of the oil is no finite number": (
        OIL.replace("\n", ",operating.inner_speed [rpm]\n") + "0,40,9\n1,,9\n2,40,9\n"
    ),
    "cases.life.viscosity`: cannot vary": "time [s],life.viscosity [mm^2/s]\n0,9\n1,8",
}


@pytest.mark.parametrize("message", WRONG)
def test_record_that_is_refused(read, message):
    with pytest.raises(SceneError) as refused:
        read(WRONG[message])
    assert message in str(refused.value)
    assert "scene.toml:" in str(refused.value)


def test_settings_of_records_that_are_refused(read):
    plain = "operating.load.Fx [kN]\n1\n2\n"
    with pytest.raises(SceneError, match="is of a record in time, a `file` with"):
        read(plain, 'gaps = "leave_out"')
    with pytest.raises(SceneError, match="'skip' is not known; it must be one of"):
        read(PLAIN, 'gaps = "skip"')
    dry = SCENE.replace("contamination = 0.5", "")
    with pytest.raises(SceneError, match="needs .lubricant. and `life.contamination`"):
        read(OIL + "0,40\n600,70\n", scene=dry)


def test_gaps_that_are_left_out_are_named(read):
    text = HEAD + "0,1,9\n600,nan,9\n1200,1,9\n1800,1,9\n"
    series = read(text, 'gaps = "leave_out"').series
    np.testing.assert_allclose(series.hours * 3600.0, [600, 0, 600, 600])
    assert series.gaps == ("line 3: Fx is no finite number",)


def test_a_record_at_rest_uses_no_life(read):
    """A damage of 0 is never 1, however often the record repeats."""
    table = read(PLAIN.replace(",100", ",0"))
    count = table.cases.count
    safety, none = np.full(count, 5.0), np.zeros(count)
    outputs: dict[str, Any] = {
        "damage": none,
        "raceway_damage": np.zeros((count, 1, 2)),
        "static_safety": safety,
        "peak_pressure": 1e9 * safety,
        "largest_load": safety,
    }
    swept = Sweep(table.cases, outputs, "inner")
    used = series_life(table.series, swept)
    assert used.damage == 0.0 and used.life_hours == np.inf
    run = SimpleNamespace(record=used, table=table, solved=swept)
    words = " ".join(map(str, _record_in_words(run)))
    assert "damage 0, as no row has any" in words and "inf" not in words


@pytest.mark.slow
def test_life_of_a_record_is_that_of_python(read, run, tmp_path):
    rng = np.random.default_rng(5)
    rows = [f"{HEAD.strip()},lubricant.temperature [°C],{SWING}"]
    for k in range(30):
        speed, swing = (
            (0, 20 * (k % 4)) if k % 3 == 0 else (100 * rng.integers(1, 9), 0)
        )
        load, oil = "x" if k == 11 else 0.5 * rng.integers(1, 8), 40 + 10 * (k % 3)
        rows.append(f"{600 * k},{load},{speed},{oil},{swing},{0.2 if swing else 0}")
    table = read("\n".join(rows), 'gaps = "leave_out"')
    out = tmp_path / "out.json"
    ended = run("life", tmp_path / "scene.toml", "--json", out)
    assert ended.status == 0
    found = json.loads(out.read_text())
    record = found["record"]
    assert record["gaps"] == ["line 13: Fx is no finite number"]
    assert "columns" not in found and "most of it in an hour in line" in ended.out
    assert "the record has gaps: line 13" in ended.err + ended.out
    assert "oscillations count by" in ended.out
    scene = table.scene
    solved = bj.sweep(
        scene.running(),
        table.cases,
        outputs=SERIES_OUTPUTS,
        life=scene.life,
        support=bj.Support(scene.free, fixed_ring=scene.fixed_ring),
        options=scene.solve_options,
    )
    used = series_life(table.series, solved)
    for name in ("damage", "raceway_damage", "life_hours"):
        np.testing.assert_allclose(record[name], getattr(used, name), rtol=SOLVER)
    assert record["rows"] == used.rows
    np.testing.assert_allclose(found["life_hours"], used.life_hours, rtol=SOLVER)

"""Reading of validation cases, and the command that compares them."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import bearingjax as bj
from bearingjax import cli
from bearingjax.studies.bearing.credibility import credibility_section
from bearingjax.studies.validate.run import Comparison
from bearingjax.validation import SUBJECTS, Case, Number, cases, nearest
from bearingjax.validation.case import as_number, read_case

CASE = """
title = "A case"
source = "A book"
trust = "printed"
subject = "life"
calculation = "numbers.some"

[rows]
load = ["1 kN", "2 kN"]

[numbers."a number"]
theirs = [1.0, 2.0]
tolerance = 1e-3
"""


def case_of(tmp_path, old="", new=""):
    path = tmp_path / "case.toml"
    path.write_text(CASE.replace(old, new))
    return read_case(path)


def test_case_is_read(tmp_path):
    case = case_of(tmp_path)
    assert case.name == "case" and case.count == 2
    assert case.numbers[0].is_test and case.numbers[0].size == 1.0


@pytest.mark.parametrize(
    "old, new, message",
    [
        ('"life"', '"lives"', "case.toml: `subject` must be one of contact"),
        ('"printed"', '"certain"', "case.toml: `trust` must be one of measured"),
        ('["1 kN", "2 kN"]', '["1 kN"]', "a number: `theirs` needs 1 values"),
        ("tolerance = 1e-3", "", "a number: `reason` is missing"),
        ("tolerance = 1e-3", "tolerance = 0.1", "a number: `reason` is missing"),
        ("tolerance = 1e-3", 'tolerance = 1e-3\nunit = "kn"', "unit 'kn' is not known"),
        ('title = "A case"', "", "missing .*title"),
        ("tolerance", "tolerence", "tolerence"),
        ("load =", 'speed = ["1 rpm"]\nload =', "lists of `rows` differ in length"),
    ],
)
def test_case_that_contradicts_itself_is_refused(tmp_path, old, new, message):
    with pytest.raises(ValueError, match=message):
        case_of(tmp_path, old, new)


def test_inputs_are_read_with_their_units():
    given = {
        "load": "2 kN",
        "name": "6205",
        "table": {"lengths": {"values": [1, 2], "unit": "mm"}},
        "temperatures": ["20 °C", 3],
    }
    found = as_number(given)
    assert found["load"] == 2000.0 and found["name"] == "6205"
    np.testing.assert_allclose(found["table"]["lengths"], [1e-3, 2e-3])
    assert found["temperatures"] == [293.15, 3]


@pytest.mark.parametrize(
    "ours, tolerance, within, kept",
    [
        ([1.0, 2.1, 9.0], 0.06, 0.0, True),
        ([1.0, 2.1, 9.0], 0.04, 0.0, False),
        ([1.0, 2.1, 9.0], 0.0, 0.11, True),
        ([1.0, 2.1, 9.0], 0.04, 0.05, True),
        ([1.0, np.nan, 9.0], 0.9, 0.9, False),
    ],
)
def test_comparison(ours, tolerance, within, kept):
    """Of what they do not give, ours may be anything."""
    number = Number("x", np.array([1.0, 2.0, np.nan]), "", tolerance, within)
    case = Case("c", "", "", "printed", "life", "", (number,))
    one = Comparison(case, number, np.array(ours))
    assert one.count == 2 and one.kept is kept
    if np.isfinite(ours).all():
        assert one.worst == 1 and one.largest == pytest.approx(0.05)


def test_every_subject_has_a_case():
    assert {case.subject for case in cases().values()} == {*SUBJECTS}


def test_command_lists_cases(capsys):
    assert cli.main(["validate", "--list", "preload"]) == 0
    assert "nsk_preloaded_pairs" in capsys.readouterr().out


def test_command_refuses_an_unknown_case(capsys):
    assert cli.main(["validate", "nsk_preloaded_pair"]) == 2
    message = capsys.readouterr().err
    assert "did you mean `nsk_preloaded_pairs`" in message and "--list" in message


def test_command_writes_every_number(tmp_path, capsys):
    files = {kind: tmp_path / f"out.{kind}" for kind in ("json", "csv", "html")}
    given = ["validate", "hertz_tables"]
    for option, path in zip(("json", "table", "report"), files.values(), strict=True):
        given += [f"--{option}", str(path)]
    assert cli.main(given) == 0
    shown = capsys.readouterr().out
    case = cases()["hertz_tables"]
    written = json.loads(files["json"].read_text())["cases"]["hertz_tables"]
    assert written.keys() == {number.name for number in case.numbers}
    lines = files["csv"].read_text().splitlines()
    assert len(lines) == 1 + sum(number.theirs.size for number in case.numbers)
    page = files["html"].read_text()
    for number in case.numbers:
        assert number.name in shown and number.name in page


def made_case(name, pitch, load, kind="deep_groove_ball"):
    return Case(
        name,
        "",
        "",
        "printed",
        "life",
        "",
        (),
        type=kind,
        pitch_diameter=pitch,
        load=load,
    )


@pytest.mark.parametrize(
    "load, order",
    [
        (1000.0, "like small heavy"),
        (4e3, "heavy like small"),
        (0.0, "heavy like small"),
    ],
)
def test_nearest_cases(monkeypatch, load, order):
    """In size and in load over the square of the pitch diameter, of the same type."""
    made = [
        made_case("heavy", 0.04, 8e3),
        made_case("small", 0.02, 250.0),
        made_case("like", 0.04, 1.1e3),
        made_case("roller", 0.04, 1e3, "cylindrical_roller"),
        made_case("no load", 0.04, 0.0),
    ]
    monkeypatch.setattr(nearest, "cases", lambda: {one.name: one for one in made})
    bearing = bj.DeepGrooveBallBearing(
        9, 0.04, 0.008, outer_osculation=0.53, inner_osculation=0.52
    )
    found = nearest.nearest_cases(bearing, load, 3)
    assert [one.case.name for one in found] == order.split()
    like = next(one for one in found if one.case.name == "like")
    assert like.size == pytest.approx(1.0)
    assert like.load == pytest.approx(load / 1.1e3)


def test_report_names_the_nearest_cases(monkeypatch):
    one = "harris_218_thrust"
    known = {one: cases()[one]}
    monkeypatch.setattr(nearest, "cases", lambda: known)
    found = SimpleNamespace(
        bearing=bj.AngularContactBallBearing(
            16,
            0.5 * 0.12526,
            0.5 * 0.022225,
            contact_angle=0.7,
            outer_osculation=0.5232,
            inner_osculation=0.5232,
        ),
        kinematics=bj.element.Linearised(),
    )
    (facts,) = credibility_section(found, [0, 0, 0.5 * 17.8e3, 0, 0, 0])
    text = " ".join(str(facts).split())
    told = (
        "harris_218_thrust (independent program): this bearing has 0.5 times its pitch"
    )
    assert f"{told} diameter d and 2 times its load/d²" in text
    (facts,) = credibility_section(found, [0.0] * 6)
    assert "diameter d, and no load" in " ".join(str(facts).split())
    assert "tilts up to 10 mrad" in text

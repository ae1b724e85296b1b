"""Reading of validation cases, and the command that compares them."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import bearingjax as bj
from bearingjax import cli
from bearingjax.report.report_model import Grid
from bearingjax.studies.bearing.credibility import _MODELS, credibility_section
from bearingjax.studies.study import STUDIES as COMMANDS
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


def made_case(name, pitch, load, kind="deep_groove_ball", subject="life"):
    return Case(
        name,
        "",
        "",
        "printed",
        subject,
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
    made.append(made_case("torque", 0.04, 1e3, subject="friction"))
    found = nearest.nearest_cases(bearing, load, 1, ["friction", "fits"])
    assert [one.case.name for one in found] == ["torque"]
    assert nearest.nearest_cases(bearing, load, subjects=["fits"]) == ()
    with pytest.raises(ValueError, match=r"`subjects` is \['lives'\]; it must be of"):
        nearest.nearest_cases(bearing, load, subjects=["lives"])


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

    def told(study, *bearings):
        (facts,) = credibility_section(study, bearings)
        return " ".join(str(facts).split())

    half, none = [0, 0, 0.5 * 17.8e3, 0, 0, 0], [0.0] * 6
    text = told("solve", ("", found, half))
    words = (
        "harris_218_thrust (independent program): this bearing has 0.5 times its pitch"
    )
    assert f"nearest cases {words} diameter d and 2 times its load/d²" in text
    assert text.endswith("`bearingjax validate CASE` compares theirs with ours")
    text = told("solve", ("", found, none))
    assert "diameter d, and no load" in text and "tilts up to 10 mrad" in text
    # It is about statics: no case of noise. Nothing is told of how to compare then.
    text = told("noise", ("", found, half))
    assert "nearest cases none of this type" in text and "validate" not in text
    # Like bearings together, the largest load of several cases; those without one.
    roller = SimpleNamespace(
        bearing=bj.CylindricalRollerBearing(14, 0.06, 0.01, 0.01),
        kinematics=bj.element.Finite(),
    )
    shaft = ("A", found, half), ("B", found, [half, np.multiply(half, 2)])
    text = told("shaft", *shaft, ("C", roller, half), ("D", roller, half))
    words = "A, B: harris_218_thrust (independent program): these bearings have 0.5"
    assert f"{words} times its pitch diameter d and 2 to 4 times its load/d²" in text
    assert text.count("harris_218") == 1 and "C, D: none of this type" in text
    assert "of no bearing by itself: pygritbx_gear_shaft" in text
    assert "tilts" in text and "tilts" not in told("shaft", ("C", roller, half))
    assert "half_space_point_contacts" in told("contact")


@pytest.mark.parametrize("study", _MODELS)
def test_models_of_reports_name_subjects_of_cases(study):
    *words, subjects = _MODELS[study]
    assert set(subjects.split()) <= SUBJECTS.keys() and study in COMMANDS
    (facts,) = credibility_section(study)
    assert isinstance(facts, Grid)
    assert facts.columns[1].values[:2] == tuple(" ".join(x.split()) for x in words)

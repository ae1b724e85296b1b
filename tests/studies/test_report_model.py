"""Reports as data: text and page show the same cells."""

import re

import numpy as np
import pytest
from pages import missing_on_page

from bearingjax.report import Column, Grid, Origin, Report, report_page
from bearingjax.report.html_report import flat
from bearingjax.report.report_model import DEGREES, labelled_facts, with_values


@pytest.mark.parametrize(
    "column, cells",
    [
        (Column("load", [1.0, -0.0, 12345.6], "N"), ["0.001", "0", "12.346"]),
        (Column("heat", [12345.6, 1234567.0], "W", ".3g"), ["12346", "1.23e+06"]),
        (Column("angle", [np.pi], "rad", ".1f", DEGREES), ["180.0"]),
        (Column("life", [np.inf, np.nan, None], "rev"), ["infinite", "-", "-"]),
        (Column("both", [1e-6, 2e-3], ["m", "rad"]), ["1 µm", "2 mrad"]),
        (Column("count", [3, np.int64(4)]), ["3", "4"]),
        (Column("words", ["a", 1.5]), ["a", "1.5"]),
    ],
)
def test_column_cells(column, cells):
    assert column.cells() == cells


def test_column_heading_units():
    assert Column("load", [1.0], "N").heading == ("load", "kN")
    assert Column("both", [1e-6], ["m"]).heading == ("both", "")
    assert Column("none", [], "Pa").heading == ("none", "MPa")


def test_grid_text_lines_up_numbers_on_the_right_and_words_on_the_left():
    grid = Grid([Column("ring", ["outer", "in"]), Column("p", [1e6, 2e9], "Pa")], "of")
    assert str(grid).splitlines() == [
        "of",
        "ring      p",
        "        MPa",
        "outer     1",
        "in     2000",
    ]


def test_grid_text_wraps_long_words_below_themselves():
    words = " ".join(["word"] * 40)
    lines = str(Grid([Column("n", [1]), Column("why", [words])])).splitlines()
    assert len(lines) == 4 and max(map(len, lines)) <= 100
    assert all(line.startswith("   word") for line in lines[2:])
    assert " ".join(" ".join(lines[1:]).split()) == f"1 {words}"


def test_report_text_and_page_hold_the_same():
    report = Report(
        {
            "First": ["<said> once", labelled_facts([("power", "2 W & more")])],
            "Empty": [],
            "Second": [Grid([Column("x < y", [1.0, 2.0], "m")], "of all")],
        },
        ["beware"],
    )
    text = str(report)
    assert text.splitlines()[-1] == "warning: beware" and text.count("-" * 78) == 1
    page = report_page("title", report, {}, Origin("bearingjax", "", (), "now"))
    for mark, letter in (("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")):
        page = page.replace(mark, letter)
    assert not missing_on_page(page, text)
    assert page.index("beware") < page.index("<h2>First</h2>")
    assert "<h2>Empty</h2>" not in page and page.count('<table class="grid">') == 2


def test_inputs_are_rounded_but_for_integers():
    angle, modulus = "0.43633231299858233 rad", "206000000000.0 Pa"
    inputs = {"a": [angle, modulus], "seed": 1234567891, "on": True, "b": {"c": 0.1}}
    assert flat(inputs) == [
        ("a", "0.43633231 rad, 2.06e+11 Pa"),
        ("seed", "1234567891"),
        ("on", "true"),
        ("b.c", "0.1"),
    ]


def test_inputs_of_a_page_have_the_units_of_the_scene():
    """As written there; what it leaves out in the units of the reports."""
    inputs = {
        "bearing": {"ball_diameter": "0.00794 m", "clearance": "1.25e-05 m"},
        "operating": {"inner_speed": "157.07963267948966 rad/s", "fixed_ring": "outer"},
        "temperature": {"shaft": "333.15 K"},
        "cases": {"grid": {"operating.load.Fy": ["1 kN", "2 kN"]}},
    }
    written = {"bearing.clearance": "0.0125 mm"}
    cells = ["7.94 mm", "0.0125 mm", "1500 rpm", "outer", "60 °C", "1 kN, 2 kN"]
    origin = "bearingjax", "", (), "now"
    page = report_page("t", Report({}), inputs, Origin(*origin, written))
    assert re.findall(r'<td class="number">(.*?)</td>', page) == cells
    assert "in the units of the scene" in page
    page = report_page("t", Report({}), inputs, Origin(*origin))
    assert "0.00794 m" in page and "in SI, [cases] as written" in page


def test_report_only_selects_sections():
    report = Report({"a": ["first"], "b": ["second"]}, ["odd"]).with_sections(
        ("b", "none")
    )
    assert str(report) == "second\nwarning: odd"


def test_with_values_leaves_out_columns_without_any():
    life, wear = Column("life", [None, 0.0], "h"), Column("wear", [None, None], "m")
    assert with_values(life, wear) == [life]

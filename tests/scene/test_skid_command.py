"""`bearingjax skid`: exit status, files, and that they hold what the library says."""

import csv
import json
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from scipy.integrate import simpson
from tolerances import ROUNDING

from bearingjax import plot
from bearingjax.dynamics import skid_warnings
from bearingjax.lubrication import Regime
from bearingjax.scene import read_skid, run_skid, skid_as_dict, skid_report

# Six balls under axial and radial load, at twelve places.
GIVEN = (
    "bearing.n_balls=6",
    "operating.load.Fy=40 N",
    "operating.load.Fz=150 N",
    "dynamics.places=12",
)
SMALL = ("skid", "skid_combined", *(w for s in GIVEN for w in ("--set", s)))
PICTURE = 1e-3  # 25 rings of points, the outermost where the pressure ends as a root
WORDS = {"result", "message", "residual", "iterations", "warnings", "version"}


@pytest.fixture(autouse=True)
def close_figures():
    yield
    for number in plt.get_fignums():
        plt.figure(number).canvas.draw()  # nothing may fail or warn while drawing
    plt.close("all")


@pytest.fixture(scope="module")
def end():
    """The end state."""
    return run_skid(read_skid("skid_combined", GIVEN, steady=True))


def test_end_state(run, end, tmp_path):
    out, table, picture = (tmp_path / f"end.{kind}" for kind in ("json", "csv", "png"))
    outputs = ("--json", out, "--table", table, "--plot", picture)
    done = run(*SMALL, "--steady", *outputs)
    assert done.status == 0 and done.err == ""
    assert done.out == skid_report(end) + "\n"
    numbers, found = json.loads(out.read_text()), end.found
    assert numbers == skid_as_dict(end)
    # Of the twelve places every other one has a ball.
    for name in (
        "orbit_speed",
        "rolling_orbit_speed",
        "slip",
        "spin",
        "film",
        "sliding_speed",
        "contact_spin",
        "heat",
        "contact_load",
        "contact_angle",
    ):
        value = getattr(found, name)
        assert numbers["orbit"][name] == value.tolist()
        assert numbers[name] == value[::2].tolist()
    for name in ("cage_speed", "friction_torque", "wander"):
        assert numbers[name] == float(getattr(found, name))
    assert numbers["azimuth"] == found.solution.azimuth.tolist()
    assert set(numbers["power"]) == {"drive", "contacts", "drag", "cage"}
    drive, *rest = numbers["power"].values()
    np.testing.assert_allclose(sum(rest), drive, rtol=1e-8)
    assert numbers["result"] == numbers["message"] == "converged"
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for header, value in (
        ("azimuth [rad]", found.azimuth),
        ("slip", found.slip),
        ("spin_z [rad/s]", found.spin[:, 2]),
        ("sliding_speed_inner [m/s]", found.sliding_speed[:, 1]),
    ):
        column = [float(row[header]) for row in rows]
        np.testing.assert_allclose(column, value, rtol=ROUNDING)
    assert picture.stat().st_size > 20_000


def test_report(end):
    text = skid_report(end)
    rolling = 12.0 / (1.0 / end.found.rolling_orbit_speed).sum()
    slip = 100.0 * (1.0 - float(end.found.cage_speed) / rolling)
    assert f"pure rolling {rolling:.6g} rad/s, slip {slip:.3g} %" in text
    assert "MIL-L-23699 at 30 °C: 37.64 mPa s, 15.11 1/GPa" in text
    assert "films: piezoviscous and elastic" in text
    assert f"power           drive {float(end.found.power.drive):.5g} W = con" in text
    assert text.count("warning: ") == 1
    assert f"warning: balls wander {1e6 * float(end.found.wander):.4g} µm" in text


def test_no_solution_leaves_no_numbers(run, tmp_path):
    out, table = tmp_path / "lost.json", tmp_path / "lost.csv"
    table.write_text("of an earlier run")
    outputs = ("--json", out, "--table", table)
    pulled = ("--set", "operating.load.Fz=-150 N")
    done = run(*SMALL, "--steady", *pulled, *outputs)
    assert done.status == 3 and done.out == ""
    assert "bearingjax: no_load_path: No load path in uz of the inner" in done.err
    assert set(json.loads(out.read_text())) == WORDS
    assert not table.exists()


def test_bad_input(run, tmp_path):
    table = ("--table", tmp_path / "end.txt")
    done = run(*SMALL, "--steady", *table)
    assert done.status == 2 and "a table ends in .csv or .parquet" in done.err
    done = run(*SMALL, "--steady", "--set", "dynamics.places=1")
    assert done.status == 2 and "`places` is 1, but the balls bear unlike" in done.err
    done = run("skid", "deep_groove", "--steady")
    assert done.status == 2 and "`operating.inner_speed`: is missing" in done.err


def changed(state, **values):
    full = {name: np.full_like(getattr(state, name), v) for name, v in values.items()}
    return state._replace(**full)


def test_what_is_doubtful(end):
    """Each kind of warning, of conditions as they might be."""
    model, found, state = end.task.model, end.found, end.state

    def told(**values):
        wander, text = skid_warnings(model, found, changed(state, **values))
        assert "pocket clearance is 200 µm: the cage takes part" in wander
        return text

    assert "a Newtonian film at 1.2 GPa" in told(peak_pressure=1.2e9)
    assert "range of its law in all of the contacts" in told(outside_fluid_range=True)
    rigid = told(regime=int(Regime.ISOVISCOUS_RIGID))
    assert "films of all of the contacts are isoviscous and rigid" in rigid
    assert "films down to 0.02 µm, less than 3 times" in told(least_film=2e-8)


def lines(ax):
    return [np.asarray(line.get_ydata()) for line in ax.get_lines()]


def test_pictures_along_the_orbit(end):
    found = end.found
    outer, inner = lines(plot.load_over_orbit(found))
    np.testing.assert_array_equal(outer[:-1], found.contact_load[:, 0])
    assert inner[-1] == inner[0] == found.contact_load[0, 1]
    ax = plot.sliding_over_orbit(found)
    np.testing.assert_array_equal(lines(ax)[1][:-1], 1e3 * found.sliding_speed[:, 1])
    assert "[mm/s]" in ax.get_ylabel() and "[deg]" in ax.get_xlabel()
    for k, spin in enumerate(lines(plot.spin_over_orbit(found))):
        np.testing.assert_array_equal(spin[:-1], found.spin[:, k])


def test_heat_of_a_contact_is_that_of_its_picture(end):
    """The integral over the points of the picture, by Simpson's rule."""
    found, model = end.found, end.task.model
    at = 3, 0
    ellipse = plot.sliding_ellipse(model, found, end.state, at)
    radius = np.linspace(0.0, 1.0, len(ellipse.heat))
    around = ellipse.heat[:, :-1].mean(axis=1)
    whole = 2.0 * np.pi * np.prod(end.state.semi_axes[at])
    total = whole * simpson(around * radius, x=radius)
    np.testing.assert_allclose(total, found.heat[at], rtol=PICTURE)
    mesh: Any = plot.sliding_map(ellipse).collections[0]
    speed = 1e3 * np.linalg.norm(ellipse.slip, axis=-1)
    np.testing.assert_allclose(mesh.get_array().ravel(), speed.ravel(), rtol=ROUNDING)
    # In the middle the slip is that of the ball.
    np.testing.assert_allclose(ellipse.slip[0, 0], found.sliding[at], rtol=ROUNDING)

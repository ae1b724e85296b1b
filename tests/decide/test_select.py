"""`bj.select`: what excludes a bearing, and the numbers of those that are solved."""

import dataclasses

import jax
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.cases.sweep import SUMMARIES, structure_of
from bearingjax.catalogue.entry import bearing_of_entry
from bearingjax.decide import Requirements
from bearingjax.decide.select import (
    _as_bounds,
    _with_common_places,
    bearing_as_drawn,
    judge_bearing,
)
from bearingjax.decide.select_positions import _loads, _requirements
from bearingjax.life.life_warning import minimum_load
from bearingjax.shafts import Drive, DutyResult, Seat, ShaftLine, ShaftSystem
from bearingjax.statics import Installed

TURNING = bj.Cases([[0.0, -2000.0, 0.0, 0.0, 0.0, 0.0]], inner_speed=150.0)
NOTHING = {"outside_diameter": (None, 1e-3)}


def excluded(asked, **more):
    """What each bearing misses, of requirements that none keeps; nothing is solved."""
    found = bj.select(asked, **more)
    assert found.fits == [] and found.smallest is None
    return {row["designation"]: row for row in found.excluded}


def test_select_ends_with_every_bearing_of_the_catalogue():
    rows = excluded(Requirements(TURNING, bounds=NOTHING))
    assert set(rows) == {entry.designation for entry in bj.catalogue_entries()}
    assert {row["requirement"] for row in rows.values()} == {"outside_diameter"}
    assert rows["6208"]["value"] == 0.08 and rows["6208"]["limit"] == 1e-3


@pytest.mark.parametrize(
    "load, kept, lost, name",
    [
        ([0, 0, 500.0, 0, 0, 0], "NUP 208 EC", "NU 208 EC", "Fz"),
        ([0, 0, -500.0, 0, 0, 0], "6208", "7208 BE", "Fz"),
        ([0, 100.0, 0, 5.0, 0, 0], "6208", "1208 E", "Mx"),
        ([0, 100.0, 10.0, 0, 0, 0], "6208", "C 2209", "Fz"),
        ([0, 100.0, 0, 0, 0, 0], "NJ 208 EC", "30208 J2", "Fz"),
        ([0, 100.0, 10.0, 0, 0, 0], "51108", "81108 TN", "Fy"),
    ],
)
def test_select_excludes_types_that_cannot_carry_the_load(load, kept, lost, name):
    never = {"static_safety": 1e9}
    entries = [bj.catalogue_entry(one) for one in (kept, lost)]

    def stop(entry):
        raise ValueError(f"{entry.designation} comes to be solved")

    with pytest.raises(ValueError, match=f"{kept} comes to be solved"):
        bj.select(Requirements(load, bounds=never), entries=entries, install=stop)
    (row,) = excluded(Requirements(load, bounds=never), entries=entries[1:]).values()
    assert row["requirement"] == name and row["limit"] == 0.0
    assert row["why"].startswith("it carries")


def test_select_sieves_by_speed_and_class():
    asked = Requirements(TURNING, bounds={"limiting_speed": 1e-6})
    entries = [bj.catalogue_entry(one) for one in ("6208", "RB 4010")]
    rows = excluded(asked, entries=entries)
    assert entries[0].limiting_speed is not None
    ratio = 150.0 / entries[0].limiting_speed
    assert rows["6208"]["value"] == pytest.approx(ratio, rel=ROUNDING)
    assert rows["RB 4010"]["why"] == "it is not known"
    asked = Requirements(TURNING, clearance_class="C5")
    rows = excluded(asked, entries=[*entries[1:], bj.catalogue_entry("7208 BE")])
    assert {row["requirement"] for row in rows.values()} == {"clearance_class"}


def test_select_estimates_masses_that_are_not_printed():
    found = bj.select(Requirements(TURNING, bounds=NOTHING)).table
    printed = found["mass_printed"]
    masses = {e.designation: e.mass for e in bj.catalogue_entries() if e.mass}
    mass = dict(zip(found["designation"], found["mass"], strict=True))
    assert {k: mass[k] for k in found["designation"][printed]} == masses
    assert 0.25 < mass["6208"] < 0.5  # 0.37 kg, as makers print it


def test_select_judges_by_what_is_missed_most():
    asked = Requirements(
        bj.Cases(np.tile(TURNING.load, (2, 1)), inner_speed=150.0, hours=[1.0, 3.0]),
        bj.LifeConditions(required=1000.0),
        bounds={"static_safety": 2.0, "peak_pressure": 3e9, "stiffness_uy": (1e8, 2e8)},
    )
    found = {
        "result": np.zeros(2, int),
        "damage": np.array([1e-8, 2e-8]),
        "basic_rating_life": np.array([1e8, 1e8]),
        "static_safety": np.array([1.5, 4.0]),
        "equivalent_load": np.array([500.0, 300.0]),
        "reference_load": np.array([450.0, 400.0]),
        "minimum_load": np.full(2, 100.0),
        "peak_pressure": np.array([2e9, 2.5e9]),
        "friction_torque": np.array([1.0, 2.0]),
        "stiffness": np.array([1e8, 8e8])[:, None, None] * np.eye(12),
    }
    row = {}
    miss = judge_bearing(asked, found, row)
    assert miss is not None and miss.requirement == "stiffness_uy"
    assert (miss.value, miss.limit, miss.share) == (8e8, 2e8, 0.25)
    turns = 150.0 * 3600.0 / (2.0 * np.pi)
    hours = 4.0 / (turns * (1.0 * 1e-8 + 3.0 * 2e-8))
    wanted = {"life_hours": hours, "static_safety": 1.5, "load_ratio": 4.0}
    wanted |= {"peak_pressure": 2.5e9, "friction_torque": 1.75}
    for name, value in wanted.items():
        assert row[name] == pytest.approx(value, rel=ROUNDING)
    miss = judge_bearing(asked, found | {"result": np.array([0, 3])}, row)
    assert miss is not None and miss.requirement == "solved" and "case 1" in miss.why


@pytest.mark.parametrize(
    "one, other",
    [("NA 4900", "NA 4828"), ("QJ 202", "176211"), ("RB 3010", "RB 11012")],
)
def test_bearings_of_a_type_share_a_program(one, other):
    entries = map(bj.catalogue_entry, (one, other))
    structures = [
        structure_of(_with_common_places(bearing_as_drawn(e), e.type)) for e in entries
    ]
    assert structures[0] == structures[1]


def test_bounds_by_one_number_have_the_sense_of_their_name():
    given = {"bore": 0.04, "static_safety": 2, "peak_pressure": 3e9, "mass": (1, 2)}
    wanted = {"bore": (0.04, 0.04), "static_safety": (2.0, None), "mass": (1.0, 2.0)}
    assert _as_bounds(given) == wanted | {"peak_pressure": (None, 3e9)}


@pytest.mark.parametrize(
    "change, told",
    [
        ({"load": np.zeros(6)}, "not zero in all cases"),
        ({"load": [0, np.nan, 0, 0, 0, 0]}, "finite"),
        ({"bounds": {"bore": (0.05, 0.04)}}, r"0.04\] m; .* the least before"),
        (
            {"bounds": {"life_hours": 2e4}, "life": bj.LifeConditions(required=1e4)},
            "`life_hours` is 'given'; it must be left out beside that which `life` has",
        ),
        ({"bounds": {"bore": -0.04}}, "above 0"),
        ({"bounds": {"bore": (None, None)}}, "above 0"),
        ({"bounds": {"boer": 0.04}}, "one of bore"),
        ({"load": bj.Cases(np.ones((2, 6)), design=[0, 1])}, "without `design`"),
        ({"rank_by": "price"}, "one of bore"),
        ({"rank_by": ()}, "`rank_by` is ..; it must be one name at least"),
        ({"types": []}, "`types` is ..; it must be one name at least"),
        ({"rank_by": "friction_torque"}, "without speed and oil"),
        ({"clearance_class": "C6"}, "one of C2"),
        ({"life": bj.LifeConditions(required=1e4), "load": np.ones(6)}, "no ring"),
        ({"life": bj.LifeConditions(dynamic_capacity=1e4)}, "each bearing has its own"),
        ({"support": bj.Support(["ux", "uz"])}, "not among `free`"),
    ],
)  # fmt: skip
def test_requirements_that_are_refused(change, told):
    with pytest.raises(ValueError, match=told):
        Requirements(**{"load": TURNING, **change})


def test_requirements_refuse_what_is_traced():
    with pytest.raises(TypeError):
        jax.jit(lambda load: Requirements(load).load.load)(np.ones(6))


def test_select_refuses_other_types_and_no_entries(untyped):
    asked = Requirements(TURNING, types="sleeve")
    with pytest.raises(ValueError, match="`types` is 'sleeve'"):
        bj.select(asked)
    with pytest.raises(ValueError, match="`entries` is empty"):
        bj.select(Requirements(TURNING), entries=[])
    with pytest.raises(TypeError, match="`Requirements`"):
        bj.select(TURNING)  # pyright: ignore


SPEEDS = (150.0, 300.0)
SPECTRUM = bj.Cases(
    [[0.0, -3000.0, 0.0, 0.0, 0.0, 0.0], [200.0, -900.0, 0.0, 0.0, 0.0, 0.0]],
    prescribed={"gx": [4e-4, 0.0], "gy": [0.0, 0.0]},
    inner_speed=SPEEDS,
    hours=[300.0, 700.0],
)
LASTING = bj.LifeConditions(viscosity=2e-5, contamination=0.4)
OILED = bj.LifeConditions(viscosity=2e-5, contamination=0.4, required=2e4)


@pytest.mark.slow
def test_select_finds_the_lives_of_single_solves(untyped):
    """Three bearings of two types, with empty places."""
    names = ("6208", "6205", "NU 208 EC")
    entries = [bj.catalogue_entry(name) for name in names]
    found = bj.select(Requirements(SPECTRUM, OILED), entries=entries)
    table = {name: k for k, name in enumerate(found.table["designation"])}
    for entry in entries:
        element = bj.BearingElement(bearing_of_entry(entry))
        lives, pressures = [], []
        for k in range(2):
            speed = bj.Speed(inner=float(SPEEDS[k]))
            held = {name: float(v[k]) for name, v in SPECTRUM.prescribed.items()}
            given = SPECTRUM.load[k], bj.Support(prescribed=held)
            solution = bj.solve_load(element, given[0], support=given[1], speed=speed)
            lives.append(bj.rating_life(element, solution, OILED))
            pressures.append(float(SUMMARIES["peak_pressure"](solution)))
        whole = bj.spectrum_life(SPECTRUM, np.array([float(x.damage) for x in lives]))
        least = minimum_load(element.bearing, lives[0].ratings)
        wanted = {
            "life_hours": whole.life_hours,
            "rating_life": whole.rating_life,
            "static_safety": min(float(x.static_safety) for x in lives),
            "minimum_load": least,
            "peak_pressure": max(pressures),
        }
        for name, value in wanted.items():
            mine = found.table[name][table[entry.designation]]
            assert mine == pytest.approx(float(value), rel=SOLVER), (entry, name)
        fits = float(whole.life_hours) >= 2e4
        names = [row["designation"] for row in found.fits]
        assert (entry.designation in names) == fits
    shown = str(found)
    assert "smallest" in shown and str(found.smallest) in shown
    pandas = pytest.importorskip("pandas")
    frame = found.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == 3
    assert found.to_xarray()["bore"].attrs["units"] == "m"


@pytest.mark.slow
def test_select_solves_bearings_on_their_seats_at_each_speed(untyped):
    entry = bj.catalogue_entry("6208")
    seats = bj.Mounting(
        bore=0.04,
        outside_diameter=0.08,
        housing_diameter=0.12,
        shaft_interference=2e-5,
        housing_interference=0.0,
    )
    installed = Installed(bj.BearingElement(bearing_of_entry(entry)), mounting=seats)
    more = {"entries": [entry], "install": lambda one: installed}
    (row,) = bj.select(Requirements(SPECTRUM, LASTING), **more).fits
    fast = dataclasses.replace(SPECTRUM, inner_speed=np.array([600.0, 1200.0]))
    (other,) = bj.select(Requirements(fast, LASTING), **more).fits
    assert row["static_safety"] == pytest.approx(other["static_safety"], rel=SOLVER)
    damages = []
    for k in range(2):
        speed = bj.Speed(inner=float(SPEEDS[k]))
        held = {name: float(v[k]) for name, v in SPECTRUM.prescribed.items()}
        element = installed.element_at(speed)
        given = SPECTRUM.load[k], bj.Support(prescribed=held)
        solution = bj.solve_load(element, given[0], support=given[1], speed=speed)
        damages.append(float(bj.rating_life(element, solution, LASTING).damage))
    whole = bj.spectrum_life(SPECTRUM, np.array(damages))
    assert row["life_hours"] == pytest.approx(float(whole.life_hours), rel=SOLVER)


@pytest.mark.parametrize("turned, y, z", [(False, 1.0, 1.0), (True, -1.0, -1.0)])
def test_loads_of_a_position_are_in_the_axes_of_its_bearing(turned, y, z):
    """A shaft along global x, whose local x, y, z are global y, z, x; a bearing that is
    turned by 180 degrees about local x."""
    place = Installed(bj.BearingElement(bj.load_bearing("6208")))
    seats = [Seat(n, "s", p, place, turned=turned) for n, p in (("A", 0.1), ("B", 0.3))]
    line = ShaftLine("s", [0.4], [0.04], axis=(1.0, 0.0, 0.0))
    system = ShaftSystem(line, seats, Drive("s", 150.0, torque=0.0))
    load, moved = np.zeros((2, 2, 2, 6))
    load[:, 1] = [[700.0, 200.0, 500.0, 0, 0, 0], [-900.0, 200.0, 0, 0, 0, 0]]
    moved[0, 1] = [0, 0, 0, 0, 1e-3, 3e-3]
    none = np.zeros((2, 0)), np.full((2, 1), 150.0), np.zeros(2), np.zeros(2, int)
    found = DutyResult(load, moved, *none, np.zeros((2, 2)), {}, ({}, {}))
    asked = _requirements([system], bj.LifeConditions(), found, 1, None, {})
    own = [[200.0, y * 500.0, z * 700.0, 0, 0, 0], [200.0, 0, -z * 900.0, 0, 0, 0]]
    np.testing.assert_allclose(asked.load.load, own, rtol=ROUNDING)
    tilts = [float(asked.load.prescribed[name][0]) for name in ("gx", "gy")]
    np.testing.assert_allclose(tilts, [1e-3, y * 3e-3], rtol=ROUNDING)
    assert np.asarray(asked.load.inner_speed).tolist() == [z * 150.0] * 2
    assert _loads([system], found, 1) == {
        "radial_force": pytest.approx(np.hypot(200.0, 500.0)),
        "axial_force": pytest.approx(-z * 900.0),
    }

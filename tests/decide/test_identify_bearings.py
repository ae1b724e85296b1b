"""Numbers of bearings, pairs and rotors from measurements."""

import dataclasses
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import inputs, theirs
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.decide import CaseModel, predict
from bearingjax.decide.identify import _read_call
from bearingjax.numerics.warning import Warning
from bearingjax.optimise import Variable
from bearingjax.rotor import rotor_design

CASE = "nsk_preloaded_pairs"
PATHS = (
    ["bearing.contact_angle"],
    ["bearing.outer_osculation", "bearing.inner_osculation"],
)
NAMES = "stiffness_uz", "displacement_uz"


class Pair(eqx.Module):
    """Rigidity and clearance of a pair under preloads: the fourth is the last unknown,
    and the last case is the load under which the maker measures clearance."""

    bearing: CaseModel

    def __call__(self, values, cases):
        load = cases.load.at[3, 2].set(values[2])
        cases = eqx.tree_at(lambda c: c.load, cases, load)
        one = self.bearing(values[:2], cases)
        moved = one["displacement_uz"]
        return {
            "rigidity": 2.0 * one["stiffness_uz"][:-1],
            "clearance": -2.0 * (moved[:-1] - moved[-1]),
        }


def nsk(row):
    """Model, cases, unknowns, printed rigidities and clearances of a pair."""
    bore, outside, angle, diameter, count = (
        inputs(CASE, name)[row]
        for name in (
            "bore", "outside_diameter", "contact_angle", "ball_diameter", "n_balls"
        )
    )  # fmt: skip
    bearing = bj.AngularContactBallBearing(
        int(count),
        0.5 * (bore + outside),
        diameter,
        contact_angle=angle,
        outer_osculation=0.52,
        inner_osculation=0.52,
    )
    model = CaseModel(bj.BearingElement(bearing), bj.Support(free=["uz"]))
    loads = [*inputs(CASE, "preload")[row], inputs(CASE, "measuring_load")[row]]
    cases = bj.Cases([[0.0, 0.0, force, 0.0, 0.0, 0.0] for force in loads])
    ends = np.radians([-4.0, 4.0]) + angle
    unknowns = [
        Variable("angle", *ends, start=angle),
        Variable("osculation", 0.505, 0.56, start=0.52),
        Variable("preload", 0.5 * loads[3], 2.0 * loads[3], start=0.8 * loads[3]),
    ]
    printed = {
        "rigidity": theirs(CASE, "axial rigidity of the pair")[row],
        "clearance": theirs(CASE, "measured axial clearance")[row],
        "angle": angle,
    }
    return Pair(model.for_numbers(PATHS, NAMES)), cases, unknowns, printed


def errors_of(printed):
    """Those of rounding, to 1 N/um, 1 um and whole degrees, and 1 % for what is not
    known of the maker's formula."""
    units = {"rigidity": 1e6, "clearance": 1e-6, "angle": np.radians(1.0)}
    return {
        name: np.hypot(units[name] / 12**0.5, 0.01 * (name != "angle") * values)
        for name, values in printed.items()
    }


PAIRS = {"7010C": 7, "7034C": 10, "7010A5": 13, "7020A5": 15}
"""With 19 to 22 balls: one program."""


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_preload_and_inside_of_printed_pairs(name):
    """From four rigidities and clearances, with error bars: osculation near 0.52, the
    contact angle as printed, and the highest preload, which is not told."""
    model, cases, unknowns, printed = nsk(PAIRS[name])
    found = bj.identify(model, cases, unknowns, printed, errors_of(printed))
    assert found.converged and found.identifiable
    angle, osculation, preload = found.estimate
    error = found.standard_error
    assert abs(angle - printed["angle"]) < np.radians(0.5)
    assert 0.518 < osculation < 0.524 and error[1] < 0.003
    known = float(cases.load[3, 2])
    assert abs(preload - known) < 2.0 * error[2] < 0.1 * known
    assert found.probability > 0.01


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_fourth_rigidity_from_three(name):
    """Within 1 % of the printed one, and within twice the band and its own error."""
    model, cases, unknowns, printed = nsk(PAIRS[name])
    error = errors_of(printed)
    read = {
        key: np.where(np.arange(4) < 3, values, np.nan) if key != "angle" else values
        for key, values in printed.items()
    }
    read["preload"], error["preload"] = cases.load[3, 2], 1e-3 * cases.load[3, 2]
    found = bj.identify(model, cases, unknowns, read, error, wanted=["rigidity"])
    value, band = found.prediction["rigidity"][3], found.prediction_error["rigidity"][3]
    off = printed["rigidity"][3] - value
    assert abs(off) < 0.01 * value
    assert abs(off) < 2.0 * np.hypot(band, error["rigidity"][3])
    # A reading of what is wanted tells most of it.
    assert found.candidates[0].name == "rigidity"


@pytest.mark.slow
def test_slopes_of_cases_match_central_differences():
    model, cases, unknowns, printed = nsk(PAIRS["7010C"])
    error = errors_of(printed)
    given = _read_call(model, cases, unknowns, printed, error, ())
    at = np.array([0.45, 0.3, 0.4])
    slopes = given.fit(at, 1).slopes
    for k in range(3):
        step = 1e-4 * np.eye(3)[k]
        near, far = (
            given.fit(at + n * step, 1).numbers - given.fit(at - n * step, 1).numbers
            for n in (1, 2)
        )
        change = given.split((8.0 * near - far) / 12e-4)
        for name, ours in given.split(slopes[:, k]).items():
            most = DIFFERENCE * max(abs(ours).max(), 1e-12)
            np.testing.assert_allclose(ours, change[name], atol=most, err_msg=name)


def test_names_of_numbers():
    bearing = bj.DeepGrooveBallBearing(
        9, 39e-3, 7.938e-3, outer_osculation=0.525, inner_osculation=0.52
    )
    model = CaseModel(bj.BearingElement(bearing))
    assert model.place("displacement_uz") == model.place("displacement_inner_uz")
    whole = model.place("stiffness_inner_uy_inner_uy")
    assert model.place("stiffness_uy") == whole and whole.unit == "N/m"
    assert model.place("stiffness_uy_gx").unit == "N"
    assert model.place("roller_load_8_inner").unit == "N"
    assert model.place("life_hours").unit == "h"
    assert model.place("operating_radial_clearance").unit == "m"
    # Behind the elements stand empty places, whose number is not counted.
    kept = model.for_numbers([], ["roller_load_8_inner"])
    assert dict(kept.places)["roller_load_8_inner"].entry == 17
    with pytest.raises(ValueError, match="did you mean `displacement_inner_uz`"):
        model.place("displacement_iner_uz")
    with pytest.raises(ValueError, match="'roller_load_9_inner' is not known"):
        model.place("roller_load_9_inner")
    with pytest.raises(ValueError, match="one of .*displacement, force"):
        model.place("wobble")
    with pytest.raises(ValueError, match="friction_torque needs an oil"):
        model.place("friction_torque")
    with pytest.raises(TypeError, match="of anything else give a function"):
        CaseModel(bearing)


def test_friction_is_that_of_the_oil_of_each_case(monkeypatch):
    """As the life, which has the viscosity of its case; solves are made up."""
    bearing = bj.DeepGrooveBallBearing(
        9, 39e-3, 7.938e-3, outer_osculation=0.525, inner_osculation=0.52
    )
    life = bj.LifeConditions(viscosity=2e-5, contamination=0.5)
    model = CaseModel(bj.BearingElement(bearing), life=life)
    solved = SimpleNamespace(converged=True, displacement=jnp.zeros(6))
    task = SimpleNamespace(outputs=lambda *_: {})
    monkeypatch.setattr(predict, "solved_case", lambda *_: solved)
    monkeypatch.setattr(predict, "Task", lambda *_: task)
    monkeypatch.setattr(
        predict, "friction_torque", lambda _, oil, __: SimpleNamespace(torque=oil)
    )
    numbers = model.for_numbers([], ["friction_torque"])
    load, oil = np.zeros((2, 6)), [1e-5, 3e-5]
    for given, used in (({"viscosity": oil}, oil), ({}, 2e-5)):
        cases = bj.Cases(load, inner_speed=100.0, **given)
        found = numbers(jnp.zeros(0), cases)["friction_torque"]
        np.testing.assert_allclose(found, used)


ANGLE = "bearing.contact_angle"
REFUSED = {
    "name": (
        dict(readings={"displacement_iner_uz": 0.0}),
        "did you mean `displacement",
    ),
    "cases": (dict(cases=np.zeros((3, 6))), "`cases` is a ndarray"),
    "path": (dict(unknowns=[Variable("bearing.angle", 0.1, 0.5)]), "has no number"),
    "twice": (dict(unknowns=[Variable(ANGLE, 0.2, 0.5)] * 2), "is a variable twice"),
    "start": (
        dict(unknowns=[Variable(ANGLE, 0.3, 0.5)]),
        "must lie between its bounds",
    ),
    "bound": (dict(unknowns=[Variable(ANGLE, 0.1, 2.0)]), "which the design does not"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_identify_rejects_for_a_design(name):
    changes, words = REFUSED[name]
    bearing = bj.AngularContactBallBearing(
        12,
        53.5e-3,
        12.7e-3,
        contact_angle=0.26,
        outer_osculation=0.52,
        inner_osculation=0.52,
    )
    given = dict(
        model=bj.BearingElement(bearing),
        cases=bj.Cases([[0.0, 0.0, 1e3, 0.0, 0.0, 0.0]]),
        unknowns=[Variable(ANGLE, 0.2, 0.5)],
        readings={"displacement_uz": 1e-5},
        errors=1e-7,
    )
    with pytest.raises((ValueError, TypeError), match=words):
        bj.identify(**{**given, **changes})


VARIED = {
    "unknown": ({ANGLE: [0.2, 0.3]}, f"{ANGLE} differs from case to case"),
    "count": ({"bearing.inner_osculation": [0.52]}, r"has shape \(1,\)"),
    "path": ({"bearing.wobble": [1.0, 2.0]}, "has no number"),
}


@pytest.mark.parametrize("name", VARIED)
def test_numbers_that_may_not_differ_from_case_to_case(name):
    varied, words = VARIED[name]
    model = CaseModel(spindle().design.seats[0].installed.drawing, varied=varied)
    cases = bj.Cases([[0.0, 0.0, 1e3, 0.0, 0.0, 0.0]] * 2)
    unknowns = [Variable(ANGLE, 0.2, 0.5)]
    with pytest.raises(ValueError, match=words):
        bj.identify(model, cases, unknowns, {"displacement_uz": 1e-5}, 1e-7)


def spindle():
    """A stiff rotor on two preloaded bearings in elastic housings."""
    bearing = bj.AngularContactBallBearing(
        12,
        53.5e-3,
        12.7e-3,
        contact_angle=0.26,
        outer_osculation=0.52,
        inner_osculation=0.52,
    )
    element = bj.BearingElement(bearing)
    mount = bj.rotor.Housing(3.0, [1e8] * 3)
    shaft = bj.rotor.Shaft([0.0, 0.125, 0.5], 0.025)
    rotor = bj.rotor.Rotor(
        shaft,
        [bj.rotor.Disc(1, 10.0, 0.2, 0.1)],
        [
            bj.rotor.BearingSupport(k, element, housing=mount, turned=turned)
            for k, turned in ((0, False), (2, True))
        ],
        rigid=True,
    )
    seats = [bj.rotor.RotorSeat(bj.Installed(element), 500.0) for _ in range(2)]
    loads = bj.rotor.RotorLoads(bj.rotor.Unbalance(1, 6e-5))
    return CaseModel(bj.rotor.RotorDesign(rotor, seats, loads, 4))


OF_SPINDLE = [
    Variable([f"seats.{k}.preload" for k in (0, 1)], 50.0, 1000.0),
    Variable(
        [
            f"rotor.supports.{k}.housing.stiffness.{axis}.{axis}"
            for k in (0, 1)
            for axis in range(3)
        ],
        5e7,
        1e9,
    ),
    Variable("loads.unbalances.0.moment", 1e-5, 1e-3),
]
READ = {"frequency_1": 0.2, "frequency_2": 0.2, "frequency_3": 0.2, "uy_1": 1e-8}


@pytest.mark.slow
def test_preload_housing_and_unbalance_of_a_rotor():
    """From natural frequencies to 0.2 Hz and an amplitude, at three speeds; one
    frequency at rest does not tell preload and housing apart."""
    model, cases = spindle(), bj.rotor.RotorCases([0.0, 500.0, 1000.0])
    true = jnp.array([300.0, 3e8, 1e-4])
    numbers = model.for_numbers([one.path for one in OF_SPINDLE], tuple(READ))
    function = jax.jit(lambda values: numbers(values, cases))
    exact, noise = function(true), np.random.default_rng(5)
    readings = {
        name: np.asarray(exact[name]) + error * noise.standard_normal(3)
        for name, error in READ.items()
    }
    found = bj.identify(model, cases, OF_SPINDLE, readings, READ)
    assert found.converged and found.identifiable
    assert np.all(abs(found.estimate - true) < 3.0 * found.standard_error)
    assert np.all(found.standard_error < 0.1 * true)
    lost = np.full(3, np.nan)
    first = np.where(np.arange(3) == 0, readings["frequency_1"], np.nan)
    few = dict.fromkeys(READ, lost) | {"frequency_1": first, "uy_1": readings["uy_1"]}
    alone = bj.identify(model, cases, OF_SPINDLE, few, READ)
    assert not alone.identifiable
    assert "trade" in alone.untold[0]
    # Slopes against differences of fourth order.
    slopes = jax.jit(jax.jacfwd(lambda values: numbers(values, cases)))(true)
    for k, name in ((0, "frequency_1"), (1, "frequency_3"), (2, "uy_1")):
        step = 1e-3 * true * np.eye(3)[k]
        near, far = (
            np.asarray(function(true + n * step)[name])
            - np.asarray(function(true - n * step)[name])
            for n in (1, 2)
        )
        change = (8.0 * near - far) / (12.0 * float(step[k]))
        np.testing.assert_allclose(slopes[name][:, k], change, rtol=DIFFERENCE)


def test_warnings_have_the_oil_that_may_be_unknown(monkeypatch):
    """Its viscosity, in place of that of the life."""
    place = bj.Installed(bj.BearingElement(bj.load_bearing("6205")))
    life = bj.LifeConditions(viscosity=1e-5, contamination=0.5)
    oiled = predict.Oiled(**vars(place), viscosity=3e-5)

    def task(support, options, keep, warn, lives, life):
        sizes = {"warning_oil": life.viscosity, "oil": 1.0}
        return SimpleNamespace(outputs=lambda *_: sizes if warn else {})

    monkeypatch.setattr(predict, "Task", task)
    monkeypatch.setattr(CaseModel, "_in_cases", lambda self, f, *_: f(oiled, 0, 0))

    def told(sizes, kinds):
        return [Warning(name, f"{float(size):.3g}") for name, size in sizes.items()]

    monkeypatch.setattr(predict, "warnings_of_cases", told)
    model = CaseModel(oiled, life=life)
    (one,) = model.warnings((), bj.Cases(np.zeros((1, 6))))
    assert one.kind == "oil" and one == "3e-05"


def test_a_system_without_warnings_of_its_own_is_not_solved_for_them(monkeypatch):
    def solve(*_):
        raise AssertionError("nothing is to be solved")

    monkeypatch.setattr(predict, "_solve_system", solve)
    model, cases = spindle(), bj.rotor.RotorCases([0.0, 500.0])
    assert model.warnings((), cases) == []
    # One that looks at its solved cases gets them once, and has those of their loads.
    own, of_loads = Warning("own", "of the system"), Warning("loads", "of the loads")
    solved = iter([SimpleNamespace(solution=[of_loads], own=own)])
    monkeypatch.setattr(predict, "_solve_system", lambda *_: next(solved))
    monkeypatch.setattr(predict, "solution_warnings", lambda loads: loads)
    monkeypatch.setattr(
        bj.rotor.RotorDesign,
        "warnings",
        lambda self, cases, solved: [solved().own, solved().own],
    )
    assert model.warnings((), cases) == [of_loads, own, own]


def test_preload_pushes_along_the_shaft_and_fits_turn_with_it(monkeypatch):
    """Each in the axes of its support; the solve for the preload is made up."""
    speeds = []

    def element_at(installed, speed, *, throw):
        speeds.append(float(speed.inner))
        return installed.drawing

    monkeypatch.setattr(bj.Installed, "element_at", element_at)
    monkeypatch.setattr(
        rotor_design, "preload_offset", lambda _, force, *, throw: 1e-8 * force
    )
    design = spindle().design
    seats = [dataclasses.replace(design.seats[0], preload=300.0), design.seats[1]]
    supports = dataclasses.replace(design, seats=seats).rotor_at(jnp.array(90.0))
    for k, along in enumerate((3e-6, 5e-6)):
        own = supports.supports[k].offset
        np.testing.assert_allclose(own, [0.0, 0.0, along, 0.0, 0.0], rtol=1e-12)
    assert speeds == [90.0, -90.0]


def test_readings_of_a_rotor_are_those_of_its_stations(monkeypatch):
    """Between which there may be more nodes; the solves are made up."""
    model = spindle()
    shaft = bj.rotor.Shaft([0.0, 0.125, 0.5], 0.025, divisions=[2, 3])
    rotor = dataclasses.replace(model.design.rotor, shaft=shaft)
    design = dataclasses.replace(model.design, rotor=rotor, seats=(None, None))
    settled = SimpleNamespace(rotor=rotor, result=0)
    moved = jnp.asarray(10.0 * np.arange(6.0)[:, None] + np.arange(5.0))
    parts = {
        "static_equilibrium": settled,
        "modes": SimpleNamespace(frequency=jnp.arange(4.0)),
        "unbalance_response": SimpleNamespace(amplitude=moved[None]),
    }
    for name, one in parts.items():
        monkeypatch.setattr(rotor_design, name, lambda *_, one=one, **__: one)
    case = SimpleNamespace(speed=jnp.array(1.0))
    found = design.solve_case(case, None, None)
    for name, wanted in (("uy_0", 1.0), ("ux_1", 20.0), ("gy_2", 54.0)):
        place = design.readings()[name]
        assert float(jnp.ravel(found.amplitude)[place.entry]) == wanted
    place = design.readings()["frequency_2"]
    assert float(found.frequency[place.entry]) == 1.0


def test_rotor_of_wrong_parts_is_refused():
    model = spindle()
    design = model.design
    with pytest.raises(ValueError, match="`seats` are 1 of 2 supports"):
        dataclasses.replace(design, seats=design.seats[:1])
    with pytest.raises(ValueError, match="'frequency_5' is not known"):
        model.place("frequency_5")
    cases = bj.Cases([[0.0, 0.0, 1e3, 0.0, 0.0, 0.0]])
    with pytest.raises(TypeError, match="`cases` is a Cases.*RotorCases"):
        bj.identify(model, cases, OF_SPINDLE, {"frequency_1": 100.0}, 1.0)

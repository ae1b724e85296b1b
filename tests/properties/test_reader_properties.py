"""Readers of quantities, scenes, lists and designations: whatever stands in a file ends
in an answer or in one line that says what is wrong."""

import copy
import functools
import json
import math
import tempfile
import tomllib
from pathlib import Path

from holds_for import holds_for, reals
from hypothesis import assume, example
from hypothesis import strategies as st
from tolerances import ROUNDING

from bearingjax.catalogue.designation import split_designation
from bearingjax.catalogue.entry import _names
from bearingjax.files import SceneError, shipped_scenes
from bearingjax.files.quantity import QUANTITIES, to_si
from bearingjax.studies.study import STUDIES, study_of

_DEG, _TURN = math.pi / 180, 2 * math.pi
UNITS = {
    "length": {"m": 1, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "um": 1e-6, "in": 0.0254},
    "angle": {"rad": 1, "mrad": 1e-3, "deg": _DEG, "°": _DEG, "turn": _TURN},
    "force": {"N": 1, "mN": 1e-3, "kN": 1e3, "MN": 1e6, "lbf": 4.4482216152605},
    "moment": {"N m": 1, "Nm": 1, "N mm": 1e-3, "kN m": 1e3, "mNm": 1e-3},
    "speed": {
        "rad/s": 1,
        "rpm": _TURN / 60,
        "1/min": _TURN / 60,
        "min^-1": _TURN / 60,
        "deg/s": _DEG,
    },
    "frequency": {"rad/s": 1, "Hz": _TURN, "kHz": 1e3 * _TURN, "rpm": _TURN / 60},
    "pressure": {"Pa": 1, "MPa": 1e6, "GPa": 1e9, "N/mm^2": 1e6, "bar": 1e5},
    "stiffness": {"N/m": 1, "N/mm": 1e3, "N/µm": 1e6, "kN/mm": 1e6},
    "time": {"s": 1, "ms": 1e-3, "µs": 1e-6, "min": 60, "h": 3600},
    "duration": {"h": 1, "min": 1 / 60, "s": 1 / 3600, "d": 24},
    "mass": {"kg": 1, "g": 1e-3, "t": 1e3, "lb": 0.45359237},
    "unbalance": {"kg m": 1, "g mm": 1e-6, "kg mm": 1e-3},
    "viscosity": {"Pa s": 1, "mPa s": 1e-3, "mPas": 1e-3, "cP": 1e-3},
    "kinematic viscosity": {"m^2/s": 1, "mm^2/s": 1e-6, "mm²/s": 1e-6, "cSt": 1e-6},
    "power": {"W": 1, "kW": 1e3, "N m/s": 1},
    "density": {"kg/m^3": 1, "kg/m³": 1, "g/cm^3": 1e3},
    "acceleration": {"m/s^2": 1, "mm/s²": 1e-3},
}
"""Kind of quantity to units in which it may be written, with their sizes in SI."""


def answer(read, *given):
    """Result of a reader, or `None` if it refuses in one line."""
    try:
        return read(*given)
    except SceneError as error:
        text = str(error)
        assert text and "\n" not in text and "Traceback" not in text
        assert len(text) < 5000
        return None


@holds_for(
    unit=st.sampled_from([(kind, name) for kind in UNITS for name in UNITS[kind]]),
    number=reals(-1e9, 1e9),
    space=st.sampled_from(["", " ", "  "]),
)
def test_units_give_the_same_number(unit, number, space):
    """And in the SI unit to the last digit, as the inputs in JSON are written."""
    kind, name = unit
    value = to_si(f"{number!r}{space}{name}", kind)
    assert math.isclose(value, number * UNITS[kind][name], rel_tol=ROUNDING)
    assert to_si(f"{value!r} {QUANTITIES[kind][0]}", kind) == value


_PIECES = st.sampled_from(
    "m mm µm N kN rad deg s min rpm K °C Pa % 1 2 -1 9 ^ ** * · / ( ) ² ³ ⁻¹ . , + - e"
    " 1e9 nan inf 0 _ ' \" ; = [ ] { } \n \t \x00 ﻿ … ∞ π".split(" ")
)
_WORDS = st.one_of(
    st.text(max_size=20),
    st.lists(_PIECES, max_size=12).map("".join),
    st.lists(_PIECES, max_size=12).map(" ".join),
)


_QUANTITIES = st.one_of(
    _WORDS,
    st.tuples(st.sampled_from(["1", "-2.5", "1e3", "0", "1e999", "٣"]), _WORDS).map(
        " ".join
    ),
)


@holds_for(text=_QUANTITIES, kind=st.sampled_from(list(QUANTITIES)))
@example("1 m^9^9^9^9", "length")
def test_any_text_is_a_quantity_or_refused_in_a_line(text, kind):
    value = answer(to_si, text, kind)
    assert value is None or math.isfinite(value)


_DEEP_GROOVE = sorted(
    name for name in _names() if _names()[name][0] == "deep_groove_ball"
)
"""Names of bearings that may have all of the letters below."""


@holds_for(
    name=st.sampled_from(_DEEP_GROOVE),
    maker=st.sampled_from(["", "SKF ", "FAG ", "NSK "]),
    suffixes=st.tuples(
        *(
            st.sampled_from(pair)
            for pair in (["", "2RS1", "2Z"], ["", "TN9"], ["", "P6"])
        )
    ),
    clearance=st.sampled_from([None, "C2", "CN", "C3", "C4", "C5"]),
    dash=st.sampled_from(["-", "/", " ", "."]),
    small=st.booleans(),
)
def test_suffixes_leave_the_designation(name, maker, suffixes, clearance, dash, small):
    suffixes = [one for one in suffixes if one]
    marks = [*suffixes, clearance] if clearance else suffixes
    written = dash.join([maker + name, *marks])
    found, read = split_designation(written.lower() if small else written, _names())
    assert (found, read.clearance) == (name, clearance)
    assert len(read.without_effect) == len(suffixes)


@functools.cache
def shipped(name):
    """A shipped scene as parsed."""
    return tomllib.loads(shipped_scenes()[name].read_text(encoding="utf-8"))


def leaves(data, path=()):
    """Paths of all entries of a scene, tables and their values alike."""
    pairs = data.items() if isinstance(data, dict) else enumerate(data)
    for key, value in pairs:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from leaves(value, (*path, key))


def parent(data, path):
    return functools.reduce(lambda inner, key: inner[key], path[:-1], data)


def read(data):
    """Read a scene as its command does, from a file of its own."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.json"
        path.write_text(json.dumps({"inputs": data}), encoding="utf-8")
        return STUDIES[study_of(path)].read(path)


SCENES = {
    "quick": "deep_groove cylindrical_ribs tapered spherical_roller hybrid_spindle"
    " taper_contact rotor_paper_12 skid_roller".split(),
    # To read that of noise of a pair takes 20 s.
    "all": sorted(set(shipped_scenes()) - {"noise_pair"}),
}
"""Scenes that are read in no time, and all of them."""
of_scenes = functools.partial(
    holds_for, SCENES, frozenset({"quick"}), examples=st.data()
)


def changes(draw, data):
    """Multiply some of the quantities of a scene."""
    for path in leaves(data):
        inner = parent(data, path)
        value = inner[path[-1]]
        number, _, unit = (
            value.partition(" ") if isinstance(value, str) else ("", "", "")
        )
        try:
            number = float(number)
        except ValueError:
            continue
        if unit and draw(st.booleans()):
            inner[path[-1]] = f"{number * draw(reals(0.98, 1.02))!r} {unit}"


@of_scenes(rarely=3)
def test_inputs_of_a_scene_are_the_scene(design, examples):
    """As written in JSON they are read again to the last bit."""
    data = copy.deepcopy(shipped(examples.draw(st.sampled_from(design))))
    changes(examples.draw, data)
    scene = answer(read, data)
    assume(scene is not None)
    again = read(scene.inputs)
    assert again.inputs == scene.inputs


_ODD = st.one_of(
    st.sampled_from(
        [None, True, False, 0, -1, 1, 3, 10**30, -0.5, 1e308, math.nan, math.inf]
    ),
    st.sampled_from(["", " ", "none", "0 m", "-3 mm", "1e308 kN", "nan N", "20 °C"]),
    st.sampled_from([[], {}, [[]], [{}], {"": 1}, {"a": {"b": []}}, ["x"], [1, "2 m"]]),
    _WORDS,
)


@st.composite
def odd_scenes(draw, names):
    """A shipped scene, of which a few entries are others, lost or renamed."""
    data = copy.deepcopy(shipped(draw(st.sampled_from(names))))
    for _ in range(draw(st.integers(1, 3))):
        path = draw(st.sampled_from(list(leaves(data)) or [()]))
        if not path:
            break
        inner = parent(data, path)
        way = draw(st.sampled_from(["odd", "odd", "odd", "lost", "renamed", "twice"]))
        value = inner[path[-1]]
        if way == "odd":
            inner[path[-1]] = draw(_ODD)
        elif isinstance(inner, list):
            inner.append(value) if way == "twice" else inner.remove(value)
        else:
            if way != "twice":
                del inner[path[-1]]
            if way != "lost":
                inner[draw(_WORDS)] = value
    return data


@of_scenes()
def test_any_scene_is_read_or_refused_in_a_line(design, examples):
    data = examples.draw(odd_scenes(design))
    answer(read, data)


@holds_for(
    text=st.one_of(
        st.text(max_size=60),
        st.lists(_PIECES, max_size=20).map("".join),
        st.binary(max_size=40),
    ),
    ending=st.sampled_from([".toml", ".json"]),
)
def test_any_file_is_a_scene_or_refused_in_a_line(text, ending):
    def from_file(content):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"scene{ending}"
            path.write_bytes(content)
            return STUDIES[study_of(path)].read(path)

    content = text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass")
    assert answer(from_file, content) is None


_HEADS = [
    "operating.load.Fy [kN]",
    "operating.load.Fz [N]",
    "operating.inner_speed [rpm]",
    "bearing.ball_diameter [mm]",
    "bearing.n_balls",
    "bearing.material",
    "operating.load.Fy",
    "bearing",
    "x [",
    "",
]
_CELLS = st.one_of(
    st.sampled_from(["-1", "2.5", "1,5", "1e3", "", "nan", "steel", '"', "12", "1 mm"]),
    _WORDS,
)


@holds_for(
    heads=st.lists(st.sampled_from(_HEADS), min_size=1, max_size=4),
    rows=st.lists(st.lists(_CELLS, max_size=4), max_size=4),
    comma=st.sampled_from([",", ";", "\t", ", "]),
    line=st.sampled_from(["\n", "\r\n", "\r"]),
    code=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "latin-1"]),
)
def test_any_list_of_cases_is_read_or_refused_in_a_line(heads, rows, comma, line, code):
    data = shipped("deep_groove") | {"cases": {"file": "cases.csv"}}
    text = line.join(comma.join(row) for row in [heads, *rows])

    def from_list(content):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.json"
            path.write_text(json.dumps({"inputs": data}), encoding="utf-8")
            path.with_name("cases.csv").write_bytes(content)
            return STUDIES["sweep"].read(path)

    answer(from_list, text.encode(code, "replace"))

"""Quantities with units: every unit that is listed, what is alike, what is refused."""

import itertools
import math

import pytest
from tolerances import ROUNDING

from bearingjax.files.quantity import (
    _UNITS,
    QUANTITIES,
    SceneError,
    _registry,
    scene_number,
    to_si,
)
from bearingjax.files.schema import Key

G, LB, IN, TURN = 9.80665, 0.45359237, 0.0254, 2.0 * math.pi
PSI = LB * G / IN**2
TABLE = {
    "length": {
        **{"nm": 1e-9, "µm": 1e-6, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "m": 1.0},
        **{"km": 1e3, "mil": IN / 1e3, "in": IN, "ft": 12 * IN},
    },
    "angle": {
        **{"µrad": 1e-6, "mrad": 1e-3, "rad": 1.0, "°": TURN / 360, "deg": TURN / 360},
        **{"′": TURN / 21600, "arcmin": TURN / 21600, "″": TURN / 1296000},
        **{"arcsec": TURN / 1296000, "gon": TURN / 400, "turn": TURN},
    },
    "force": {
        **{"µN": 1e-6, "mN": 1e-3, "N": 1.0, "kN": 1e3, "MN": 1e6},
        **{"kp": G, "kgf": G, "lbf": LB * G},
    },
    "moment": {
        **{"µNm": 1e-6, "mNm": 1e-3, "Nmm": 1e-3, "Ncm": 1e-2, "Nm": 1.0},
        **{"kNmm": 1.0, "kNm": 1e3, "MNm": 1e6},
    },
    "speed": {"rpm": TURN / 60},
    "duration": {"s": 1 / 3600, "min": 1 / 60, "h": 1.0, "d": 24.0, "a": 8766.0},
    "pressure": {
        **{"Pa": 1.0, "hPa": 100.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9},
        **{"mbar": 100.0, "bar": 1e5, "psi": PSI, "kpsi": 1e3 * PSI, "Mpsi": 1e6 * PSI},
    },
    "time": {
        **{"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1.0},
        **{"min": 60.0, "h": 3600.0, "d": 86400.0, "a": 365.25 * 86400},
    },
    "temperature": {"K": 5.0, "°C": 278.15, "°F": 258.15},  # of 5 degrees
    "viscosity": {"Pas": 1.0, "mPas": 1e-3, "P": 0.1, "cP": 1e-3},
    "kinematic viscosity": {"St": 1e-4, "cSt": 1e-6},
    "mass": {
        **{"µg": 1e-9, "mg": 1e-6, "g": 1e-3, "kg": 1.0, "t": 1e3},
        **{"oz": LB / 16, "lb": LB},
    },
    "unbalance": {"gmm": 1e-6, "kgmm": 1e-3},
    "frequency": {"Hz": TURN, "kHz": 1e3 * TURN, "rpm": TURN / 60},
    "rate": {"Hz": 1.0, "kHz": 1e3},
    "natural frequency": {"Hz": 1.0, "kHz": 1e3},
    "power": {
        **{"µW": 1e-6, "mW": 1e-3, "W": 1.0, "kW": 1e3, "MW": 1e6},
        **{"PS": 75 * G, "hp": 550 * LB * G * 12 * IN},
    },
}
"""Factors from the definitions of SI 9, NIST SP 811 and, for PS, DIN 66036."""


def test_listed_units_have_their_factors():
    assert {kind: set(units) for kind, units in TABLE.items()} == {
        kind: set(units.split()) for kind, units in _UNITS.items()
    }
    for kind, units in TABLE.items():
        for unit, factor in units.items():
            got = to_si(f"5 {unit}", kind)
            wanted = factor if kind == "temperature" else 5.0 * factor
            assert got == pytest.approx(wanted, rel=ROUNDING), (kind, unit)


def test_names_of_units_have_no_prefixes_and_endings_but_those_listed():
    names = set(_registry())
    for name, prefix, ending in itertools.product(names, ["", *"µmkMG"], ["", "s"]):
        other = f"{prefix}{name}{ending}"
        if other not in names:
            with pytest.raises(SceneError, match="has the unknown unit"):
                to_si(f"5 {other}", "unbalance")


@pytest.mark.parametrize("kind", QUANTITIES)
def test_suggested_unit_is_of_its_kind(kind):
    unit, example = QUANTITIES[kind]
    assert to_si(f"1 {unit}", kind) == 1.0
    assert to_si(f"5 {example}", kind) > 0.0


ALIKE = {
    "speed": (
        "1500 rpm|1500 RPM|1500 1/min|1500/min|1500 1 / min|1500 min-1|1500 min^-1"
        "|1500 min⁻¹|1500 min**-1|1500 min^(-1)|1500 U/min|1500 tr/min|1500 r/min"
        "|1500 rev/min|1.5e3 rpm|25 rev/s|9000 deg/s"
    ),
    "moment": (
        "2 N m|2 Nm|2 N-m|2 N·m|2 N⋅m|2 N.m|2 N*m|2e3 N mm|2000Nmm|0.002 kNm|2\u00a0Nm"
        "|2\u202fN\u2009m|200 Ncm"
    ),
    "length": (
        "5 µm|5 μm|5 um|5µm|5\u00a0µm|5\u2009µm|5\u202fµm|5\tµm|5\u200bµm|+5 µm|5. µm"
        "|5E-3 mm|5e-3mm|.005 mm|0.5e1 µm|5e3 nm|5 mm²/m|5 mm2/m"
    ),
    "force": "-4 kN|−4 kN|-4000 N|-4e3N|−4e−3 MN|-4 kN m/m",
    "angle": "30 arcmin|30′|30'|0.5°|0.5 °|0.5 º|0.5 deg|0.5 degrees|1800″",
    "temperature": "20 °C|20 ℃|20 ºC|20°C|20 degC|293.15 K|68 °F|68 degF",
    "thermal conductivity": (
        "46 W/(m K)|46 W/(m·K)|46 W/m/K|46 W m^-1 K^-1|46 W m⁻¹ K⁻¹|46 W·m-1·K-1"
        "|46 W/(m °C)|0.046 kW/(m K)"
    ),
    "temperature coefficient": "1e-6 1/K|1e-6/K|1e-6 K^-1|1 µm/(m K)|1e-6 1/°C",
    "pressure": "2 GPa|2000 N/mm^2|2000 N/mm²|2000 N/mm2|2 kN/mm²|2e4 bar",
    "line constant": "1 N/m^(19/9)|1 N m^(-19/9)|1 N/m^(1)/m^(10/9)",
    "viscosity": "80 mPa s|80 mPa·s|80 mPas|0.08 Pa s|80 cP|80e-9 MPa s",
}


@pytest.mark.parametrize("kind", ALIKE)
def test_units_that_are_alike(kind):
    first, *others = ALIKE[kind].split("|")
    for other in others:
        assert to_si(other, kind) == pytest.approx(to_si(first, kind), rel=ROUNDING)


def test_foot_pounds_and_horsepower():
    foot_pound = 12 * IN * LB * G
    for text in ("7 ft-lb", "7 ft lb", "7 lb-ft", "7 ft-lbf", "7 ft·lbs", "84 in-lb"):
        assert to_si(text, "moment") == pytest.approx(7 * foot_pound, rel=ROUNDING)
    assert to_si("7 lb in", "unbalance") == pytest.approx(7 * LB * IN, rel=ROUNDING)


def test_numbers_in_messages_have_units_of_scenes():
    shown = {
        ("length", 0.0725): "72.5 mm",
        ("angle", math.pi / 180): "1 deg",
        ("speed", 100 * math.pi): "3000 rpm",
        ("frequency", 100 * math.pi): "50 Hz",
        ("pressure", 206e9): "206 GPa",
        ("pressure", 3e6): "3 MPa",
        ("force", 12e3): "12 kN",
        ("force", 12.0): "12 N",
        ("time", 3.0): "3 s",
    }
    for (kind, value), text in shown.items():
        assert scene_number(value, kind) == text
        assert to_si(text, kind) == pytest.approx(value, rel=ROUNDING)
    assert scene_number(500.0, "force", 2e3) == "0.5 kN"
    length = Key("", "length", least=0.0, below=1e-4)
    assert length.range_words == "from 0 to below 0.1 mm"
    assert length.shown_value(2.0) == "2000 mm"
    assert Key("", "temperature", most=50).shown_value(60.0) == "60 °C"
    assert Key("", above=0).range_words == "above 0"


REFUSED = {
    "20 Grad": ("angle", "unknown unit 'Grad' (write deg for degrees, or gon); an"),
    "20 grad": ("angle", "unknown unit 'grad' (write deg for degrees, or gon); an"),
    "70 C": ("temperature", "unknown unit 'C' (write °C); a temperature with its unit"),
    "70 Grad": ("temperature", "(write °C)"),
    "70 deg": ("temperature", "is not a temperature (write °C)"),
    "70 °C/s": ("temperature", "is not a temperature"),
    "30 HP": ("power", "(write hp, 745.7 W, or PS, 735.5 W)"),
    "500 lb": ("force", "is not a force (write lbf)"),
    "50 kg": ("force", "is not a force (write kgf)"),
    "5 kg/cm2": ("pressure", "is not a pressure (write kgf/cm2)"),
    "1 g": ("acceleration", "(write m/s^2; 1 g is 9.80665 m/s^2)"),
    "5 KN": ("force", "unknown unit 'KN' (write kN); a force with its unit is wanted"),
    "5 MM": ("length", "(write mm)"),
    "206 Gpa": ("pressure", "(write GPa)"),
    "206 mPa": ("pressure", "unknown unit 'mPa' (write MPa)"),
    "5 KN/MM": ("stiffness", "(write kN/mm)"),
    "5 GN": ("force", "; its units: µN, mN, N, kN, MN, kp, kgf, lbf"),
    "5 u": ("mass", "unknown unit 'u'"),
    "5 mass": ("angle", "unknown unit 'mass'"),
    "5 %": ("length", "unknown unit '%'"),
    "5 mms": ("length", "unknown unit 'mms'"),
    "5 m//s": ("sliding speed", "unknown unit 'm//s'"),
    "5 m per s": ("sliding speed", "unknown unit 'm per s'"),
    "5 (mm": ("length", "unknown unit '(mm'"),
    "5 m²·9": ("length", "unknown unit"),
    "5 kpsi^19/psi^19 m^(-9)^9^9^9": ("length", "unknown unit"),
    f"5 m {'kpsi^9 ' * 13}/{'/psi^9' * 13}": ("length", "unknown unit"),
    "5 N rad": ("force", "is not a force"),
    "25 Hz": ("speed", "is a frequency; give rpm, deg/s or rad/s"),
    "1,5 mm": ("length", "has a comma; write a decimal point"),
    "1.500,5 mm": ("length", "has a comma; write a decimal point"),
    "1 500 mm": ("length", "has parted digits; write them together"),
    "1\u00a0500 mm": ("length", "has parted digits"),
    "1\u2009500 mm": ("length", "has parted digits"),
    "1'500 mm": ("length", "has parted digits"),
    "1’500 mm": ("length", "has parted digits"),
    "1_500 mm": ("length", "has parted digits"),
    "10² mm": ("length", "has parted digits"),
    "5½ mm": ("length", "has parted digits"),
    "1.5.2 mm": ("length", "unknown unit"),
    "5 1/2 mm": ("length", "unknown unit"),
    "1/2 mm": ("length", "unknown unit"),
    "20° 30′": ("angle", "unknown unit"),
    "nan mm": ("length", "does not begin with a finite number"),
    "inf mm": ("length", "does not begin with a finite number"),
    "∞ mm": ("length", "does not begin with a finite number"),
    "٥ mm": ("length", "does not begin with a finite number"),
    "": ("length", "does not begin with a finite number"),
    "1e999 mm": ("length", "is out of range"),
    "1e-999 mm": ("length", "is out of range"),
    "1e308 km": ("length", "is out of range"),
    "1e-322 nm": ("length", "is out of range"),
    f"1e{'9' * 30} mm": ("length", "is out of range"),
    f"5 mm^{'9' * 30}": ("length", "unknown unit"),
    "5 mm^0": ("length", "unknown unit"),
    f"5 {'m ' * 400}": ("length", "is not a length"),
}


@pytest.mark.parametrize("text", REFUSED)
def test_to_si_rejects(text):
    kind, message = REFUSED[text]
    with pytest.raises(SceneError) as caught:
        to_si(text, kind)
    told = str(caught.value)
    assert told.startswith(f"{text!r} ") and message in told and "\n" not in told

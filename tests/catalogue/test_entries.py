"""Numbers of the catalogue against the plans of ISO 15, and against each other."""

import re
from collections import defaultdict

import numpy as np
import pytest

import bearingjax as bj

ENTRIES = bj.catalogue_entries()
NO_PLAN = ("HK", "NK", "NKI", "NKS", "RNA", "RA", "RB", "T", "MR")
BALLS = {e.type for e in ENTRIES if e.type.endswith("ball")}
OUTSIDE = {
    8: "19 21 24 26 32 37 42 47 52 58 65 72 78 85 90 95 100 110 115 120 125",
    9: "22 24 28 30 37 42 47 55 62 68 72 80 85 90 100 105 110 120 125 130 140",
    0: "26 28 32 35 42 47 55 62 68 75 80 90 95 100 110 115 125 130 140 145 150",
    2: "30 32 35 40 47 52 62 72 80 85 90 100 110 120 125 130 140 150 160 170 180",
    3: "35 37 42 47 52 62 72 80 90 100 110 120 130 140 150 160 170 180 190 200 215",
}
"""Outside diameters of ISO 15 by diameter series, of the bore codes 00 to 20 [mm]."""
ONE_WIDTH = (
    "62 72 N2 NJ2 NU2 NUP2 QJ2 12",
    "63 73 N3 NJ3 NU3 NUP3 QJ3 13 213",
    "60 70 NJ10 NU10",
    "619 719",
    "NJ22 NU22 NUP22 22 222 C22",
    "NJ23 NU23 NUP23 23 223 C23",
    "230 C30",
    "231 C31",
)
"""Series of one dimension series of ISO 15, and so of one width at a bore."""
BESIDE_7013_AC = ("7011 AC", "7013 AC", "7014 AC")
"""EPK prints twice the limiting speed of the series for the 7013 AC."""


def prefixed(entry):
    """Series with the letters before it, NU2; "" of what has no plan."""
    first = re.split(r"[ \d]", entry.designation)[0]
    inch = entry.type == "tapered_roller" and not re.fullmatch(
        r"3[0-3]\d(\d\d|/\d\d)( \w+)?", entry.designation
    )
    plain = (
        not inch
        and not entry.own_clearance
        and first not in NO_PLAN
        and entry.series[0]
    )
    return first + entry.series[0] if plain else ""


def alike():
    """Entries of one series, letter of the design and source, by bore."""
    found = defaultdict(dict)
    for e in ENTRIES:
        letters = re.sub(r"[JX]+$", "", e.series[1])
        found[e.type, prefixed(e), letters, e.sources["capacity"]][e.bore] = e
    return [[v[b] for b in sorted(v)] for k, v in found.items() if k[1] and len(v) > 2]


def test_bore_is_that_of_the_number():
    """00, 01, 02, 03 are 10, 12, 15, 17 mm; from 04 on five times the code."""
    for e in (e for e in ENTRIES if prefixed(e) and e.bore >= 0.01):
        number = re.search(r"(\d+)(/\d+)?", e.designation)
        assert number is not None
        code = int(number[1][-2:])
        whole = number[2] and int(number[2][1:])
        bore = whole or {0: 10, 1: 12, 2: 15, 3: 17}.get(code, 5 * code)
        assert e.bore == pytest.approx(1e-3 * bore), e.designation


def test_boundary_dimensions_are_those_of_iso15():
    widths = {name: group for group in ONE_WIDTH for name in group.split()}
    found = defaultdict(set)
    for e in ENTRIES:
        series = prefixed(e)
        thrust = "thrust" in e.type
        if not series or e.designation == "22205/20 E":  # the rings of a 22205
            continue
        # Of thrust bearings the whole series; the 161 is of no diameter series.
        alone = e.type if thrust or series == "161" else ""
        found[alone, series[-1 - 2 * thrust :], e.bore].add(e.outside_diameter)
        if e.designation not in ("1224", "1226"):  # wider, as the maker prints them
            group = widths.get(series, (e.type, series))
            found["width", group, e.bore].add(e.width)
    assert all(len(values) == 1 for values in found.values())
    for series, printed in OUTSIDE.items():
        for code, outside in enumerate(printed.split()):
            bore = {0: 10, 1: 12, 2: 15, 3: 17}.get(code, 5 * code) / 1000
            assert found["", str(series), bore] <= {int(outside) / 1000}


def test_ratings_are_in_proportion_to_sizes():
    """Pu is some C0/22 of balls and C0/8.2 of rollers, less of large bearings."""
    for e in ENTRIES:
        ring = np.pi / 4.0 * (e.outside_diameter**2 - e.bore**2) * e.width * 7850.0
        if e.mass is not None and not e.own_clearance:  # no insert
            assert 0.5 < e.mass / ring < 1.0, e.designation
        if e.fatigue_load_limit is not None:
            assert e.static_capacity is not None
            large = max((e.bore + e.outside_diameter) / 0.2, 1.0) ** 0.3
            ratio = e.static_capacity / e.fatigue_load_limit / large
            low, high = (17, 31) if e.type in BALLS else (7, 11.5)
            assert low < ratio < high, e.designation


@pytest.mark.parametrize(
    "field, power, most",
    [
        ("dynamic_capacity", 0.7, 0.33),
        ("static_capacity", 0.8, 0.3),
        ("fatigue_load_limit", 0.8, 0.3),
        ("mass", 1.0, 0.2),
        ("reference_speed", -0.33, 0.17),
        ("limiting_speed", -0.33, 0.45),
    ],
)
def test_numbers_lie_between_those_of_the_neighbours_in_the_series(field, power, most):
    """Over a power of the volume, by the logarithm of the bore, in one source."""
    checked = 0
    for entries in alike():
        known = [e for e in entries if getattr(e, field) is not None]
        x = np.log([e.bore for e in known])
        size = [(e.outside_diameter**2 - e.bore**2) * e.width for e in known]
        y = np.log([getattr(e, field) for e in known]) - power * np.log(size)
        part = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
        off = y[1:-1] - y[:-2] - part * (y[2:] - y[:-2])
        for e, one in zip(known[1:-1], off, strict=True):
            beside = field == "limiting_speed" and e.designation in BESIDE_7013_AC
            assert abs(one) < (0.8 if beside else most), (e.designation, one)
        checked += len(off)
    assert checked > 600

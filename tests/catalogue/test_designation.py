"""Designations: letters of makers, and that none is taken for another bearing."""

import re
from pathlib import Path

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.catalogue.entry import CLEARANCES, class_limits
from bearingjax.fits import fit_limits

LINES = Path(__file__).with_name("designations.txt").read_text("utf-8").splitlines()
PRINTED = [[x.strip() for x in line.split("|")] for line in LINES if line[0] != "#"]
ENTRIES = bj.catalogue_entries()
ANGLES = {"A": 30, "A5": 25, "AC": 25, "AD": 25, "B": 40, "BE": 40, "C": 15, "CD": 15}


def designated(text):
    """The listed designation; "-" if there is none."""
    try:
        return bj.catalogue_entry(text).designation
    except ValueError as error:
        assert "\n" not in str(error)
        return "-"


def test_catalogue_entry_knows_what_eight_makers_print():
    wrong = {t: designated(t) for _, t, wanted in PRINTED if designated(t) != wanted}
    assert wrong == {}
    # With the maker in front, behind and glued to it.
    for maker, text, wanted in PRINTED:
        for whole in (f"{maker} {text}", f"{text} {maker}", f"{maker}{text}".lower()):
            assert designated(whole) == (wanted if "с3" not in whole else "-"), whole
    known = [one for one in PRINTED if one[2] != "-"]
    assert len({maker for maker, *_ in known}) == 8
    assert len(PRINTED) == 193 and len(known) == 177


def test_each_letter_without_effect_is_named():
    notes = bj.catalogue_entry("E2.6205-2RS1TN9/P63VL0241WT").notes
    for words in (
        "E2 (low friction, not calculated)",
        "2RS1 (seals or shields)",
        "TN9 (cage)",
        "P63 (accuracy, with a class of clearance)",
        "VL0241 (coating or insulation)",
        "WT (grease)",
    ):
        assert f"{words}: no effect" in notes


def number_of(text):
    """The first number, of series 68 and 69 as ISO writes it."""
    found = re.search(r"\d+", text)
    assert found is not None
    return re.sub(r"^6([89])(\d\d)$", r"61\1\2", found[0])


SEALS = ["2RS1", "2RSH", "ZZ", "DDU", "LLU", "2Z", "2NSE9", "2HRS", "2RU"]
LETTERS = {
    "deep_groove_ball": SEALS,
    "cylindrical_roller": ["TVP2", "M1", "ML", "T2X"],
    "spherical_roller": ["W33", "MB", "VA405"],
    "tapered_roller": ["Q", "P5"],
    "angular_contact_ball": ["TVP", "M", "P4A", "UL"],
}


def test_generated_designations_name_the_bearing_they_are_made_of():
    """1000 of all entries: prefixes, separators, letters, cases and classes."""
    draw = np.random.default_rng(48)
    for _ in range(1000):
        entry = ENTRIES[draw.integers(len(ENTRIES))]
        text = entry.designation.replace(" ", draw.choice(["", " ", "-", "."]))
        for letters in draw.permutation(LETTERS.get(entry.type, ["P6", "M"]))[:2]:
            glued = "" if letters[0] != "2" or len(text) < 3 else "-"
            text += draw.choice([glued, " ", "-", "/"]) + letters
        wanted = entry.designation
        if entry.type in CLEARANCES and draw.random() < 0.7:
            name = draw.choice(["C2", "C3", "C4", "C3H", "C2L", "P63"])
            text += draw.choice(["", " ", "/", "-"]) + name
            wanted += "/" + name.replace("P63", "C3")
        text = draw.choice(["", "SKF ", "SKF", "FAG "]) + text
        text = text.lower() if draw.random() < 0.3 else text
        try:
            found = bj.catalogue_entry(text)
        except ValueError as error:  # of small bores some classes, of inserts none
            unknown = "`name` is", "`bore` is", "no classes"
            assert any(words in str(error) for words in unknown), text
            continue
        assert found.designation == wanted, text
        assert found.bore == entry.bore and found.width == entry.width


def test_mistyped_designations_are_refused_or_of_their_own_number():
    draw = np.random.default_rng(49)
    accepted = 0
    for _ in range(500):
        entry = ENTRIES[draw.integers(len(ENTRIES))]
        head, number, tail = re.split(r"(\d+)", entry.designation, maxsplit=1)
        k = int(draw.integers(len(number)))
        digit = str(draw.integers(10))
        made = {
            "one more": number[:k] + digit + number[k:],
            "one less": number[:k] + number[k + 1 :],
            "another": number[:k] + digit + number[k + 1 :],
            "swapped": number[:k] + number[k : k + 2][::-1] + number[k + 2 :],
            "parted": number[:k] + draw.choice(list("/-. ")) + number[k:],
        }
        text = head + made[draw.choice(list(made))] + tail
        text += draw.choice(["", "-2RS1", "ZZ", "/C3", " M", "TVP2"])
        found = designated(text)
        if found != "-":
            accepted += 1
            whole = re.split(r"[A-Za-z]", re.sub(r"^\D+", "", text))[0].strip("-/. ")
            numbers = {number_of(whole)}
            if whole.endswith("2"):  # of seals, 62052RS
                numbers.add(number_of(whole)[:-1])
            # NSK 7914 C is 71914 C.
            numbers |= {f"71{n[1:]}" for n in numbers if re.fullmatch(r"79\d\d", n)}
            assert number_of(found) in numbers, text
    assert 25 < accepted < 250


@pytest.mark.parametrize("prefix", ["", "FAG B"])
def test_letters_of_a_contact_angle_are_never_taken_for_others(prefix):
    known = {"C": 15, "E": 25} if prefix else ANGLES
    letters = ["A5", *(a + b for a in "ABCDEFU" for b in "ABCDEU")]
    for size in ("7205", "7006", "7310"):
        for name in ["", *"ABCDEFGHIJKLMNOPQRSTUVWXYZ", *letters]:
            found = designated(f"{prefix}{size}{name}")
            if name in known or found != "-":
                if found == "-":
                    assert size == "7006" and known[name] in (30, 40)  # unlisted
                    continue
                first = max((k for k in known if name.startswith(k)), key=len)
                angle = bj.catalogue_entry(found).design["contact_angle"]
                # The AC bearings of EPK have 26 degrees, by the older GOST 831.
                assert np.rad2deg(angle) == pytest.approx(known[first], abs=1.01), name
    for name in ("7205CA", "7205E", "7205F", "7205", "7205AB", "7205DB", "B7205A"):
        assert designated(name) == "-"


REFUSED = {
    "64/22": "/22 is a bore of 22 mm, part of the number",
    "SKF 64/22-2RS1": "/22 is a bore of 22 mm",
    "303/28 J2": "/28 is a bore of 28 mm",
    "6025": "near it: 6052, 6205, 6005, 6015, 6020, 6021",
    "30205 K": "letters after 30205 that are not known: 'K'",
    "6205 2RS XQ": "not known: 'XQ'",
    "6205 + H 205": "not known: 'H'",
    "22220 EK + H 310": "H310 is no sleeve of it; one has its bore code and",
    "22220 E + H 320": "H320 is no sleeve of it",
    "6205 P62/C3": "names two classes of clearance, C2 and C3",
    "1205 K K30": "names K and K30, which exclude each other",
    "6932RS": "may be 6932 with RS or 693 with 2RS; write 6932-RS or 693-2RS",
    "62202Z/C3": "may be 62202 with Z-C3 or 6220 with 2Z-C3; write 62202-Z-C3 or",
    "NK2016": "near it: BK2016, NK20/16",
    "6205/CM/C3": "names two classes of clearance, CM and C3",
    "61820 CM": "`bore` is 0.1 m; it must be above 0.0099 m and 0.08 m or less",
    "NU 205 CM": "`name` is 'CM'; it must be one of C2, CN, C3, C4, C5",
    "6205ß": "is not a bearing of the catalogue",
    "6²05": "is not a bearing of the catalogue",
    "620(5)": "is not a bearing of the catalogue",
    "62 05": "is not a bearing of the catalogue",
    "SN 205": "is not a bearing of the catalogue",
    "/-+": "is not a designation, such as",
    "6205" + 50 * "U" + "2Q9": "letters after 6205 that are not known",
    "6205" + 90 * "P": "is not a designation, such as",
}


@pytest.mark.parametrize("text", REFUSED)
def test_catalogue_entry_refuses_and_says_why(text):
    with pytest.raises(ValueError, match=re.escape(REFUSED[text])):
        bj.catalogue_entry(text)


def test_random_text_is_refused_or_of_its_own_number():
    draw = np.random.default_rng(50)
    signs = list("0123456789ABCEKNUPZRS /-.+()[]äµ²½６Ａ\x00\n\u200b'")
    for _ in range(500):
        text = "".join(draw.choice(signs, draw.integers(12)))
        text = draw.choice(["", "6205", "NU", "7205", "222"]) + text
        found = designated(text)
        if found != "-":
            plain = text.translate({0xFF16: "6", 0xFF21: "A"}).upper()
            assert number_of(found) in re.sub(r"(?<!1)6([89])", r"61\1", plain), text


def test_steel_and_balls_by_designation():
    """Stainless bearings have no known ratings, hybrid ones balls of their own."""
    plain, steel = (bj.catalogue_entry(name) for name in ("6205", "W 6205"))
    assert steel.dynamic_capacity is None and steel.design == plain.design
    assert "stainless steel" in steel.sources["capacity"]
    hybrid = bj.catalogue_entry("6205-2RSLTN9/HC5C3WT")
    assert hybrid.dynamic_capacity == plain.dynamic_capacity
    made = bj.load_bearing(hybrid.designation)
    assert float(made.material.elastic_modulus) == 310e9
    assert float(made.ring_material.elastic_modulus) == 206e9
    again = bj.catalogue_entry(hybrid.designation)
    assert again.designation == hybrid.designation and again.design == hybrid.design


def test_clearance_of_motors():
    assert bj.catalogue_entry("6205DDUCM").clearance_class == "CM"


def test_series_of_jis_are_those_listed():
    for entry in ENTRIES:
        if re.fullmatch(r"61[89]\d\d", entry.designation):
            text = f"6{entry.designation[2:]}"
            assert designated(text) == designated(f"NSK {text}") == entry.designation
    assert designated("6864") == designated("6964") == "-"  # 61864 is not listed


@pytest.mark.parametrize("kind", CLEARANCES)
@pytest.mark.parametrize("taper", ["", "K"])
def test_clearances_of_every_listed_bore_are_those_of_its_range(kind, taper):
    """Every row of a table is reached but those of bores larger or less than listed."""
    find = class_limits(kind, taper)
    bores = sorted({e.bore for e in ENTRIES if e.type == kind})
    if find is None:
        assert kind in ("deep_groove_ball", "cylindrical_roller", "needle_roller")
        return
    name, low, high = TABLES[kind]
    table = fit_limits.CLEARANCES[f"{name}_tapered" if taper else name]["up_to"]
    rows = {int(end): row for end, row in table.items()}
    reached = {next(end for end in rows if 1e3 * b <= end + 1e-9) for b in bores}
    assert set(rows) - reached == {e for e in rows if not low <= e <= high}
    for bore in (b for b in bores if not taper or b > 0.03):
        limits = np.array([find(c, bore) for c in ("CN", "C3")], float).ravel()
        end = next(end for end in rows if 1e3 * bore <= end + 1e-9)
        np.testing.assert_allclose(1e6 * limits, rows[end][2:6], rtol=1e-9)


TABLES = {
    "deep_groove_ball": ("ball", 6, 315),
    "cylindrical_roller": ("cylindrical_roller", 24, 180),
    "needle_roller": ("cylindrical_roller", 24, 400),
    "self_aligning_ball": ("self_aligning_ball", 10, 140),
    "spherical_roller": ("spherical_roller", 24, 280),
    "toroidal_roller": ("toroidal_roller", 30, 280),
}
"""Clearances by type, and the ends of the ranges of the least and largest bore [mm]."""

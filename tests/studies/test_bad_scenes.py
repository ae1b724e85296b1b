"""Wrong scenes: one line that names file, key, fault and remedy; exit status 2."""

import math
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from bearingjax import SceneError, read_scene
from bearingjax.files import shipped_scenes
from bearingjax.files.scene_file import find_scene
from bearingjax.studies.bearing.read_design import BALLS, ROLLERS
from bearingjax.studies.study import STUDIES, study_of

TAPER = """
[bearing]
type = "tapered_roller"
n_rollers = 17
pitch_diameter = "52 mm"
roller_diameter = "8.2 mm"
roller_length = "11.5 mm"
roller_axis_angle = "11 deg"
roller_half_angle = "1.7235 deg"
"""

KNOWN_BEARINGS = ", ".join((*ROLLERS, *BALLS))
WHOLE = "is not a whole number of at least 1"
NO_UNIT = 'has no unit; a length with its unit is wanted, such as "5 mm"'
RIB = '{end_radius = "300 mm", contact_height = "1.5 mm"}'


def one_line(run):
    """The message of a refused run: nothing else is said."""
    assert run.status == 2
    assert run.out == ""
    assert run.err.startswith("bearingjax: ") and run.err.count("\n") == 1
    assert "Traceback" not in run.err
    return run.err.removeprefix("bearingjax: ").rstrip("\n")


def without_line(message):
    """A message without the lines after names of scenes, and the first file's line."""
    found = re.match(r"[^ ]+\.toml:(\d+):", message)
    return re.sub(r"\.toml:\d+:", ".toml:", message), found and int(found[1])


def assert_names(path, line, message):
    """The line of a message has the key, or is that of a table in which it is missing
    or unknown, or of the part that a message without a key names first."""
    if line is None:
        return
    text = path.read_text(encoding="utf-8").splitlines()[line - 1]
    keys = re.findall(r"[`\[]([\w.\[\]]+?)[`\]]:", message)
    if not keys:
        part = text.strip(" []").rpartition(".")[2]
        assert re.search(rf"\b{part}\b", message), text
        return
    key = re.sub(r"\[\d+\]", "", keys[0])
    words = re.findall(r"[\w.]+", text.partition("#")[0])
    named = [part for word in words for part in (word, *word.split("."))]
    assert named and any(part in named for part in (key, *key.split("."))), text


def a_file(folder, text):
    path = folder / "bad.toml"
    path.write_text(text, encoding="utf-8")
    return path


REFUSED = Path(__file__).with_name("refused")


def refused_settings():
    """Cases of refused/settings.txt: command, scene, settings, begin of the message.

    A command with its scene stands at the margin, settings are indented by two, and the
    message after "file: " by four. A scene NAME.toml stands beside the list.
    """
    settings, text = [], (REFUSED / "settings.txt").read_text(encoding="utf-8")
    for line in text.replace("{KNOWN_BEARINGS}", KNOWN_BEARINGS).splitlines():
        if not line.startswith(" "):
            command, scene, *marks = line.split()
            marks = [getattr(pytest.mark, mark) for mark in marks]
        elif not line.startswith("    "):
            settings.append(line[2:])
        else:
            given, settings = settings, []
            case = f"{command} {scene} {' '.join(given)}"
            yield pytest.param(command, scene, given, line[4:], id=case, marks=marks)


@pytest.mark.parametrize("command, scene, settings, message", [*refused_settings()])
def test_wrong_setting(run, tmp_path, monkeypatch, command, scene, settings, message):
    """One line names file, key, fault and remedy, before anything is solved."""

    def refuse(*_, **__):
        raise AssertionError("solved a scene")

    for study in STUDIES.values():
        module = sys.modules[study.run.__module__]
        monkeypatch.setattr(module, study.run.__name__, refuse)
    changes = [word for setting in settings for word in ("--set", setting)]
    source = REFUSED / scene if scene.endswith(".toml") else scene
    out = tmp_path / "out.json"
    told = one_line(run(command, source, *changes, "--json", out))
    start, line = without_line(told)
    assert start.startswith(f"{scene.removesuffix('.toml')}.toml: {message}")
    assert_names(find_scene(source), line, told)
    assert not out.exists()
    with pytest.raises(SceneError) as caught:
        STUDIES[command].read(source, settings)
    assert str(caught.value) == told


@pytest.mark.parametrize(
    "path", sorted(REFUSED.glob("*.toml")), ids=lambda path: path.stem
)
def test_scene_of_wrong_settings_reads(path):
    changes = ["fit.drive_up=0.5 mm"] if path.stem == "tapered_bore" else []
    read: Any = STUDIES[study_of(path)].read(path, changes)
    assert getattr(read, "scene", read).name == path.stem


def without(key):
    """The taper with one line left out."""
    return re.sub(rf"(?m)^{key} = .*\n", "", TAPER)


TEXTS = {
    "nothing at all": ("", "`bearing`: is missing; it must be a table"),
    "no type": (
        without("type"),
        "`bearing.designation`: is missing; give it, or a `type` with all sizes, one of"
        f" {KNOWN_BEARINGS}",
        2,
    ),
    "no count": (
        without("n_rollers"),
        "`bearing.n_rollers`: is missing; it must be a whole number",
        2,
    ),
    "no pitch diameter": (
        without("pitch_diameter"),
        "`bearing.pitch_diameter`: is missing; it must be a length, a text with its"
        " unit",
        2,
    ),
    "misspelt pitch diameter": (
        TAPER.replace("pitch_diameter", "pitch_diametre"),
        "`bearing.pitch_diameter`: is missing (`pitch_diametre` is there instead); it"
        " must be a length",
        2,
    ),
    "no axis angle": (
        without("roller_axis_angle"),
        "`bearing.roller_axis_angle`: is missing",
        2,
    ),
    "arrangement of a taper": (
        TAPER + f'arrangement = "NJ"\nrib = {RIB}',
        "`bearing.arrangement`: is for cylindrical and needle rollers; others name"
        " their `ribs`",
        10,
    ),
    "rib without height": (
        TAPER + '[bearing.ribs.inner_minus]\nend_radius = "90 mm"',
        "`bearing.ribs.inner_minus.contact_height`: is missing; it must be a length",
        10,
    ),
    "broken TOML": (
        TAPER + "[operating",
        "cannot be read as TOML: Expected ']' at the end of a table declaration",
    ),
    "unquoted quantity": (
        "[bearing]\npitch_diameter = 52 mm",
        "cannot be read as TOML: Expected newline or end of document after a"
        " statement (at line 2, column 21)",
    ),
    "key twice": (
        TAPER + "n_rollers = 17",
        "cannot be read as TOML: Cannot overwrite a value",
    ),
}


@pytest.mark.parametrize("name", TEXTS)
def test_wrong_file(run, tmp_path, name):
    text, expected, *line = TEXTS[name]
    message, found = without_line(one_line(run("solve", a_file(tmp_path, text))))
    assert message.startswith(f"bad.toml: {expected}") and [found] == (line or [None])


def test_scene_file_not_utf8(run, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_bytes(b"[bearing]\nname = '\xff'")
    message = one_line(run("solve", path))
    assert message.startswith("bad.toml: cannot be read: 'utf-8' codec")


def test_missing_file(run, tmp_path):
    path = tmp_path / "none.toml"
    assert one_line(run("solve", path)) == f"{path}: no such file"


def test_folder_in_place_of_a_file(run, tmp_path):
    assert one_line(run("solve", tmp_path)).startswith(f"{tmp_path}: neither a .toml")
    folder = tmp_path / "x.toml"
    folder.mkdir()
    assert one_line(run("solve", folder)) == f"{folder}: is a folder; name a file"


def test_scene_file_without_read_permission(run, tmp_path, monkeypatch):
    path = a_file(tmp_path, TAPER)

    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(type(path), "read_bytes", refuse)
    assert one_line(run("solve", path)) == "bad.toml: cannot be read: Permission denied"


def test_scene_file_with_deep_nesting(run, tmp_path):
    text = TAPER + "x = " + 2000 * "[" + 2000 * "]"
    assert one_line(run("solve", a_file(tmp_path, text))).startswith("bad.toml: ")


@pytest.mark.parametrize("command", ["solve", "sweep", "optimise"])
def test_scene_of_a_contact(run, command):
    message = one_line(run(command, "taper_contact"))
    assert message == (
        "taper_contact.toml: is the scene of one contact, a [roller] on a [raceway],"
        " not of a [bearing]; `bearingjax contact taper_contact` solves it"
    )


def test_scene_file_with_byte_order_mark(tmp_path):
    """As editors of Windows write it."""
    path = tmp_path / "marked.toml"
    path.write_text(TAPER, encoding="utf-8-sig")
    assert read_scene(path).element.bearing.n_rollers == 17


@pytest.mark.parametrize(
    "unit", ["1/min", "min^-1", "min⁻¹", "r/min", "rev/min", "RPM"]
)
def test_revolutions_per_minute(unit):
    scene = read_scene("cylindrical_rig", [f"operating.inner_speed=1500 {unit}"])
    assert float(scene.speed.inner) == pytest.approx(50.0 * math.pi, rel=1e-15)


@pytest.mark.parametrize("text", ["2 Nm", "2000 N mm", "2000 Nmm", "0.002 kNm"])
def test_moment_unit_spellings(text):
    scene = read_scene("tapered", [f"operating.load.Mx={text}"])
    assert scene.load[3] == pytest.approx(2.0, rel=1e-15)


def test_name_of_no_scene(run):
    shipped = ", ".join(shipped_scenes())
    assert (
        one_line(run("solve", "cylindrical_rigg"))
        == f"cylindrical_rigg: neither a .toml file nor a shipped scene ({shipped})"
    )


@pytest.mark.parametrize("setting", ["operating.load.Fy", "=3", "a..b=3", "a b=3"])
def test_solve_rejects_malformed_setting(run, setting):
    message = one_line(run("solve", "cylindrical_rig", "--set", setting))
    start = f"cylindrical_rig.toml: {setting!r} is not a setting; write key=value, "
    assert message.startswith(start)


def test_setting_of_two_lines_is_rejected():
    """The second line went unread."""
    with pytest.raises(SceneError, match=r"points`: '7\\nmore = 8' is not a whole"):
        read_scene("cylindrical_rig", ["output.points=7\nmore = 8"])


@pytest.mark.parametrize("name, unit", [("dynamic_capacity", "MN"), ("static", "N")])
def test_ratings_in_another_unit(name, unit):
    name = f"{name.removesuffix('_capacity')}_capacity"
    (told,) = read_scene("life_spectrum", [f"life.{name}=23.4 {unit}"]).warnings
    assert told.startswith(f"life: `{name}` is ")
    assert told.endswith("bearings of this size have some 17 kN (another unit meant?)")


def test_errors_are_value_errors():
    with pytest.raises(ValueError, match="no such file"):
        read_scene("none.toml")


@pytest.mark.parametrize("kind", ["spherical", "crossed"])
def test_bearings_of_two_rows_are_in_no_set(kind):
    told = f"`set`: a {kind} roller bearing has both its rows already"
    with pytest.raises(SceneError, match=told):
        read_scene(f"{kind}_roller", ["set.arrangement=tandem"])
    row = read_scene(f"{kind}_roller").inputs["bearing"]
    row.pop("staggered", None)
    text = ", ".join(
        f"{key} = {value if isinstance(value, int) else repr(value)}"
        for key, value in row.items()
        if not isinstance(value, dict)
    )
    rows = f"set={{arrangement='rows', rows=[{{position='0 mm', bearing={{{text}}}}}]}}"
    told = rf"`set.rows\[0\].bearing`: a {kind} roller bearing is no row of a set"
    with pytest.raises(SceneError, match=told):
        read_scene("cylindrical_rig", [rows])


def test_a_sphere_or_a_pitch_diameter_is_needed(tmp_path):
    text = shipped_scenes()["spherical_roller"].read_text("utf-8")
    text = re.sub("(?m)^outer_raceway_radius.*$", "", text)
    told = "`bearing.pitch_diameter`: is missing, and so is `outer_raceway_radius`; one"
    with pytest.raises(SceneError, match=told):
        read_scene(a_file(tmp_path, text))


BAD_UNITS = [
    "bearing.pitch_diameter=72.5 (mm",
    "bearing.pitch_diameter=72.5 mm/",
    "bearing.pitch_diameter=72.5 mm^",
    "bearing.pitch_diameter=72.5 $",
    "bearing.pitch_diameter='72.5 #'",
    "bearing.pitch_diameter=72.5 mm^(1/0)",
    """bearing.pitch_diameter="5 '\"""",
    # 1/s, Bq and baud count cycles, 2 pi from radians
    "operating.inner_speed=25 1/s",
    "operating.inner_speed=25 s^-1",
    "operating.inner_speed=25 Bq",
    "operating.inner_speed=25 baud",
    "bearing.first_azimuth=5 percent",
    "bearing.first_azimuth=5 count",
    "bearing.first_azimuth=5 bit",
    "bearing.first_azimuth=5 sr",
    "bearing.pitch_diameter=72.5 1 mm",
    "bearing.pitch_diameter=72.5 mm!",
    "bearing.pitch_diameter=72.5 {mm}",
]


@pytest.mark.parametrize("setting", BAD_UNITS)
def test_read_scene_rejects_invalid_units(setting):
    with pytest.raises(SceneError, match=setting.split("=")[0].replace(".", r"\.")):
        read_scene("cylindrical_rig", [setting])


def test_key_of_two_lines_makes_one_line(run, tmp_path):
    text = TAPER + '"two\\nlines" = 1'
    assert "unknown key" in one_line(run("solve", a_file(tmp_path, text)))


@pytest.mark.parametrize(
    "key, digits",
    [("n_rollers", 400), ("material.poisson_ratio", 400), ("n_rollers", 5000)],
)
def test_huge_integer(run, key, digits):
    setting = f"bearing.{key}={'9' * digits}"
    one_line(run("solve", "cylindrical_rig", "--set", setting))

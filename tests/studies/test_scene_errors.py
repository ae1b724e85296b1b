"""The line of a scene that an error names."""

import re

import pytest

from bearingjax import SceneError, read_scene
from bearingjax.files import shipped_scenes
from bearingjax.files.scene_errors import _keys, line_of_key, place_of
from bearingjax.files.scene_file import parse_scene
from bearingjax.files.table import Table
from bearingjax.studies.shaft.read import read_shafts

FORMS = '''\
# bearing.bore = "in a comment"
name = "a scene"
words = """
[bearing]
bore = 1
"""
last.word = \'\'\'bore = 2
[roller]\'\'\'
bearing.rows = 2
[bearing.roller] # the first rollers
length = "12 mm"
"a key" = 1
'b.c' = { deep.key = 3, list = [
    { one = 1 },
    { two = 2 },
] }

[[discs]]
mass = "1 kg"
[discs.at]
station = 0
[[discs]]
mass = "2 kg"
grid = [
    # comment = 1
    [1.0, 2.0],
    [
        3.0,
    ],
]
points = [{ x = 1 },
          { x = 2, y = [
          ] },
]
[[discs.at]]
station = 1
[[discs.at]]
station = 2
["a table".inner]
text = """one \\
    line = 3
    more"""
end = 1
'''
LINES = {
    "name": 2,
    "words": 3,
    "last": 7,
    "last.word": 7,
    "bearing": 9,
    "bearing.rows": 9,
    "bearing.roller": 10,
    "bearing.roller.length": 11,
    "bearing.roller.'a key'": 12,
    "bearing.roller.b.c": 13,
    "bearing.roller.b.c.deep": 13,
    "bearing.roller.b.c.deep.key": 13,
    "bearing.roller.b.c.list": 13,
    "bearing.roller.b.c.list[0]": 14,
    "bearing.roller.b.c.list[0].one": 14,
    "bearing.roller.b.c.list[1]": 15,
    "bearing.roller.b.c.list[1].two": 15,
    "discs": 18,
    "discs[0]": 18,
    "discs[0].mass": 19,
    "discs[0].at": 20,
    "discs[0].at.station": 21,
    "discs[1]": 22,
    "discs[1].mass": 23,
    "discs[1].grid": 24,
    "discs[1].points": 31,
    "discs[1].points[0]": 31,
    "discs[1].points[0].x": 31,
    "discs[1].points[1]": 32,
    "discs[1].points[1].x": 32,
    "discs[1].points[1].y": 32,
    "discs[1].at": 35,
    "discs[1].at[0]": 35,
    "discs[1].at[0].station": 36,
    "discs[1].at[1]": 37,
    "discs[1].at[1].station": 38,
    "'a table'": 39,
    "'a table'.inner": 39,
    "'a table'.inner.text": 40,
    "'a table'.inner.end": 43,
}


@pytest.fixture
def forms(tmp_path):
    path = tmp_path / "forms.toml"
    path.write_text(FORMS, encoding="utf-8")
    return path


def test_line_of_key_forms(forms):
    keys = [key for key, _ in _keys(parse_scene(forms, ()))]
    assert sorted(keys) == sorted(LINES)
    assert {key: line_of_key(FORMS, key) for key in keys} == LINES


@pytest.mark.parametrize(
    "key, line",
    [
        ("bearing.roller.radius", 10),
        ("bearing.roller.ends.radius", 10),
        ("discs[0].stiffness", 18),
        ("discs[1].stiffness", 22),
        ("discs[1].at[1].stiffness", 37),
        ("discs[1].points[1].z", 32),
        ("bearings", None),
        ("bearings.own.bore", None),
    ],
)
def test_place_of_missing_key(forms, key, line):
    assert place_of(forms, key) == f"forms.toml:{line}".removesuffix(":None")


def test_place_of_value_not_in_file(forms):
    assert place_of(forms, "bearing.rows", 2) == "forms.toml:9"
    assert place_of(forms, "bearing.rows", 3) == "forms.toml"
    assert place_of(forms, "bearing.width", 3) == "forms.toml"
    assert place_of(forms, "discs[0]", {"mass": "1 kg"}) == "forms.toml"


@pytest.mark.parametrize("text", [None, "name = ", "name = '''\n", b"name = '\xff'"])
def test_place_of_no_scene(tmp_path, text):
    path = tmp_path / "bad.toml"
    if text is not None:
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
    assert place_of(path, "name") == "bad.toml"
    assert place_of("6205", "name") == "6205"


@pytest.mark.parametrize(
    "ends, mark", [("\n", ""), ("\r\n", ""), ("\r\n", "\ufeff"), ("\n", "\ufeff")]
)
def test_place_of_line_ends(tmp_path, ends, mark):
    path = tmp_path / "forms.toml"
    path.write_bytes((mark + FORMS.replace("\n", ends)).encode())
    for key, line in LINES.items():
        assert place_of(path, key) == f"forms.toml:{line}"


def written_keys(text):
    """Lines of headers and of keys that begin a line, of scenes without texts of
    several lines, read as a person would."""
    path, count, found = "", {}, {}
    for number, line in enumerate(text.splitlines(), start=1):
        if match := re.match(r"(\[\[?)([^\[\]]+)\]", line):
            path = match[2].replace('"', "")
            if match[1] == "[[":
                found.setdefault(path, number)
                count[path] = count.get(path, -1) + 1
                path = f"{path}[{count[path]}]"
            found[path] = number
        elif match := re.match(r'("[^"]+"|[\w-]+) *=', line):
            key = match[1].replace('"', "")
            found[f"{path}.{key}" if path else key] = number
    return found


@pytest.mark.parametrize("name", shipped_scenes())
def test_line_of_key_shipped(name):
    """A key stands where a person finds it; one within a line, in that line."""
    text = shipped_scenes()[name].read_text(encoding="utf-8")
    written, lines = written_keys(text), text.splitlines()
    for key, _ in _keys(parse_scene(shipped_scenes()[name], ())):
        line = line_of_key(text, key)
        if key in written:
            assert line == written.pop(key), key
        else:
            end = r"{" if key.endswith("]") else rf"\b{key.rpartition('.')[2]}\b"
            assert re.search(end, lines[line - 1]), key
    assert not written


BEARING = """\
[bearing]
type = "cylindrical_roller"
n_rollers = 14
pitch_diameter = "54 mm"
roller_diameter = "9 mm"
roller_length = "10 mm"
radial_internal_clearance = "20 um"
arrangement = "NU"
rib = { end_radius = "300 mm", contact_height = "1.5 mm" }
[operating.load]
Fy = "-4 kN"
[contact]
friction = 0.1
"""


@pytest.mark.parametrize(
    "old, new, place",
    [
        ("14", "1.5", "3: `bearing.n_rollers`"),
        ('"9 mm"', '"9"', "5: `bearing.roller_diameter`"),
        ("end_radius", "radius", "9: `bearing.rib.end_radius`"),
        ('"1.5 mm"', "1", "9: `bearing.rib.contact_height`"),
        ("Fy", "fy", "11: `operating.load.fy`"),
        ('"9 mm"', '"90 mm"', "5: `bearing.roller_diameter`"),
        ("friction", "[contact.law]\nfriction", "13: `contact.law`"),
    ],
)
def test_scene_error_names_line(tmp_path, old, new, place):
    path = tmp_path / "mine.toml"
    path.write_text(BEARING.replace(old, new), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value).startswith(f"mine.toml:{place}")


def test_scene_error_of_setting_names_no_line(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(BEARING, encoding="utf-8")
    with pytest.raises(SceneError, match=r"^mine\.toml: `bearing\.n_rollers`: 1\.5"):
        read_scene(path, ["bearing.n_rollers=1.5"])


def test_scene_error_of_machine_names_line(tmp_path):
    """A bearing of shafts is read with other names of its keys."""
    text = shipped_scenes()["shaft_gearbox"].read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    lines = text.splitlines()
    first = next(k for k, s in enumerate(lines) if s.startswith("[bearings."))
    lines.insert(first + 1, 'contact.law = "soft"')
    path.write_text("\n".join(lines), encoding="utf-8")
    name = lines[first].partition("]")[0].strip("[")
    with pytest.raises(SceneError) as caught:
        read_shafts(path)
    assert str(caught.value).startswith(f"mine.toml:{first + 2}: `{name}.contact.law`")


def test_scene_error_of_system_names_line_of_part(tmp_path):
    text = shipped_scenes()["shaft_gearbox"].read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(text.replace('hand = "left"', 'hand = "right"'), encoding="utf-8")
    line = text.splitlines().index("[gear.pinion]") + 1
    words = f"mine.toml:{line}: `hand` is 'right' of pinion and 'right' of wheel"
    with pytest.raises(SceneError, match=f"^{words}"):
        read_shafts(path)


def test_table_error_places():
    table = Table(
        {"bearing": {"rows": "x"}}, "a.toml", places={"bearing": "bearings.A"}
    )
    with pytest.raises(SceneError, match=r"^a\.toml: `bearings\.A\.rows`: 'x' is not"):
        table.table("bearing").integer("rows")


def test_a_key_that_a_setting_took_away_has_no_line():
    pair = "set={ arrangement = 'back_to_back', preload_force = '300 N' }"
    with pytest.raises(SceneError, match=r"^ball_pair.toml: `set.spacing`: is missing"):
        read_scene("ball_pair", [pair])

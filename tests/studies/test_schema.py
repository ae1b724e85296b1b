"""The schema of scene files: what editors check, what the guide tells, what is read."""

import dataclasses
import json
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest

from bearingjax import SceneError, read_scene, studies
from bearingjax.files import shipped_scenes
from bearingjax.files.quantity import QUANTITIES
from bearingjax.files.schema import Keys, fields_of, key_of, read_keys
from bearingjax.files.table import Table
from bearingjax.numerics.units import unit
from bearingjax.studies.contact.read import read_contact
from bearingjax.studies.noise.read import read_noise
from bearingjax.studies.rotor.read import read_rotor
from bearingjax.studies.scene_schema import key_guide, scene_schema
from bearingjax.studies.select.read import read_select
from bearingjax.studies.shaft.read import read_shafts
from bearingjax.studies.skid.read import read_skid


def classes(kind=Keys):
    for sub in kind.__subclasses__():
        yield sub
        yield from classes(sub)


TABLES = sorted(classes(), key=lambda kind: kind.__name__)


@pytest.fixture(scope="module")
def validator():
    schema = scene_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def faults(validator, data):
    return [
        f"{list(e.absolute_path)}: {e.message}" for e in validator.iter_errors(data)
    ]


@pytest.mark.parametrize("name", shipped_scenes())
@pytest.mark.slow
def test_schema_holds_for_shipped_scenes_and_their_echo(name, validator):
    path = shipped_scenes()[name]
    data = tomllib.loads(path.read_text("utf-8"))
    assert not faults(validator, data)
    if "rotor" in data:
        found = read_rotor(name)
    elif "shaft" in data:
        found = read_shafts(name)
    elif "roller" in data:
        found = read_contact(name)
    elif "vibration" in data:
        found = read_noise(name)
    elif "select" in data:
        found = read_select(name)
    elif "dynamics" in data:
        found = read_skid(name, steady=True)
    else:
        found = read_scene(name)
    assert not faults(validator, found.inputs)


@pytest.mark.parametrize(
    "change",
    [
        {"operating": {"load": {"Fq": "1 kN"}}},
        {"operating": {"inner_speed": 3000}},
        {"operating": {"fixed_ring": "left"}},
        {"numerics": {"tolerance": 0.5}},
        {"bearing": {"type": "deep_groove_ball", "n_balls": 8}},
        {"bearing": {"designation": "6205", "n_balls": 0}},
        {"life": {"reliability": 95}},
        {"strange": {}},
    ],
    ids=json.dumps,
)
def test_schema_refuses(change, validator):
    data = {"bearing": {"designation": "6205"}, **change}
    assert faults(validator, data)


@pytest.mark.parametrize("speed", ["1500 1/min", "1500/min", "−1.5e3 min⁻¹"])
def test_schema_allows_alternative_spellings(speed, validator):
    data = {"bearing": {"designation": "6205"}, "operating": {"inner_speed": speed}}
    assert not faults(validator, data)


def test_guide_of_keys_is_current():
    guide = Path(studies.__file__).with_name("KEYS.md").read_text("utf-8")
    assert guide.endswith("\n\n" + key_guide()), (
        "put what `bearingjax schema --keys` prints in place of the tables"
    )


def test_schema_command_prints_json_and_tables_of_keys(run):
    assert json.loads(run("schema").out) == json.loads(json.dumps(scene_schema()))
    done = run("schema", "--keys", "operating.load")
    assert done.status == 0 and done.out.count("| force |") == 3
    done = run("schema", "--keys", "operating.lod")
    assert done.status == 2 and "did you mean `operating.load`?" in done.err
    done = run("schema", "--keys", "bearings")
    assert done.status == 0 and done.out.startswith("### `[bearings.NAME]`")
    done = run("schema", "--keys", "temperature")
    assert "| `reference` | temperature | 20 °C |" in done.out


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    ["solve deep_groove", "catalogue 6205"],
    ids=lambda text: text.split()[0],
)
def test_commands_without_docstrings(command):
    without_docstrings(*command.split())


def without_docstrings(*words):
    """Output of a command of `python -OO`."""
    call = [sys.executable, "-OO", "-m", "bearingjax", *words]
    done = subprocess.run(call, capture_output=True, check=True, timeout=600)
    return done.stdout.decode("utf-8")


def test_schema_needs_no_docstrings():
    assert json.loads(without_docstrings("schema")) == json.loads(
        json.dumps(scene_schema())
    )
    assert without_docstrings("schema", "--keys") == key_guide()


def bad_values(field):
    """Values that a key must refuse, with part of the message."""
    key, kinds = field.key, field.kinds
    if key.reader is not None or key.of:
        return
    if kinds == (float,) and key.kind:
        unit, example = QUANTITIES[key.kind]
        yield 3, "has no unit"
        yield f"3 {example}lots", "has the unknown unit"
        other = "kg" if unit != "kg" else "mm"
        yield f"3 {other}", "is not a"
    elif kinds == (float,):
        yield "3 mm", "is not a bare number"
        yield float("nan"), "is not a finite number"
    elif kinds == (int,):
        yield 2.5, "is not a whole number"
        yield -1, "is not a whole number of at least"
    elif kinds == (bool,):
        yield "yes", "is not true or false"
    elif kinds == (str,) and key.choices:
        yield "no such word", "is not known"
    if kinds[0] in (int, float) and not key.kind:
        for end, step in (("above", 0), ("least", -1), ("below", 0), ("most", 1)):
            value = getattr(key, end)
            if value is not None and (kinds[0] is float or end == "most"):
                yield kinds[0](value + step), ""


@pytest.mark.parametrize("kind", TABLES, ids=lambda kind: kind.__name__)
def test_every_key_refuses_wrong_values(kind):
    assert kind.about and dataclasses.is_dataclass(kind)
    names = [field.name for field in fields_of(kind)]
    assert len(set(names)) == len(names)
    for field in fields_of(kind):
        assert field.key.about and not field.key.about.endswith(".")
        for value, told in bad_values(field):
            with pytest.raises(SceneError) as caught:
                read_keys(kind, Table({field.name: value}, "x.toml", "t"))
            message = str(caught.value)
            # What is required may be missed first.
            if "is missing" not in message and "goes with" not in message:
                assert message.startswith(f"x.toml: `t.{field.name}`: "), message
                assert told in message and "\n" not in message


@dataclasses.dataclass
class Weight:
    mass: float = dataclasses.field(
        default=2.0, metadata=unit("kg", "mass of it", above=0.0)
    )


class WeightKeys(Keys):
    about = "[weight]: keys of the domain, one of them changed"

    mass: float = key_of(Weight, "mass")
    heavy: float | None = key_of(Weight, "mass", default=None, most=9.0)


class OtherKeys(Keys):
    about = "[other]: a key of another table"

    heavy: float = key_of(WeightKeys, "heavy", default=dataclasses.MISSING)


def test_keys_of_another_class(tmp_path):
    mass, heavy = fields_of(WeightKeys)
    assert (mass.key.about, mass.key.kind, mass.default) == ("mass of it", "mass", 2.0)
    assert (mass.key.above, mass.key.most) == (0.0, None)
    assert (heavy.name, heavy.default, heavy.key.most) == ("heavy", None, 9.0)
    (other,) = fields_of(OtherKeys)
    assert other.required and other.key == heavy.key
    table = Table({"mass": "3 g"}, tmp_path / "a.toml")
    assert read_keys(WeightKeys, table).given == {"mass": 3e-3}
    with pytest.raises(SceneError, match="`mass`: 0 kg is not allowed; above 0 kg"):
        read_keys(WeightKeys, Table({"mass": "0 kg"}, tmp_path / "a.toml"))
    with pytest.raises(KeyError, match="weight"):
        key_of(Weight, "weight")

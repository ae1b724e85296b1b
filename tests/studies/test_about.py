"""What the program tells about itself: versions, citations, shell completion."""

import re
import subprocess
import tomllib
from pathlib import Path

import jax
import pytest

import bearingjax as bj
from bearingjax import cli

PACKAGE = Path(bj.__file__).parent
ROOT = Path(__file__).parents[2]
REFERENCES = (PACKAGE / "cli/references.bib").read_text(encoding="utf-8")
ENTRY = re.compile(r"^@\w+\{(\w+),(.*?)(?=^@|\Z)", re.M | re.S)


def told(capsys, *arguments):
    """Return what an option prints before the program ends."""
    with pytest.raises(SystemExit) as stop:
        cli.main(arguments)
    assert stop.value.code == 0
    return capsys.readouterr().out


def cited(text):
    return {found[1] for found in ENTRY.finditer(text)}


def field(entry, name):
    found = re.search(rf"\b{name} = \{{\{{?(.*?)\}}", entry)
    return None if found is None else found[1]


def test_version_tells_libraries_backend_and_precision(capsys):
    rows = dict(line.split(" ", 1) for line in told(capsys, "--version").splitlines())
    assert rows["bearingjax"] == bj.__version__ and rows["jax"] == jax.__version__
    assert rows["backend"] == jax.default_backend() and rows["precision"] == "float64"
    assert rows["devices"] == f"{jax.device_count()} x {jax.devices()[0].device_kind}"


def test_version_where_jax_does_not_start(capsys, monkeypatch):
    def refuse():
        raise RuntimeError("Unable to initialize backend 'cuda'")

    monkeypatch.setattr(jax, "devices", refuse)
    text = told(capsys, "--version")
    assert "backend none\n" in text and "'cuda'" in text and "float64" in text


def test_cite_names_this_version_alone(capsys):
    text = told(capsys, "--cite")
    assert cited(text) == {"bearingjax"} and bj.__version__ in text


@pytest.mark.parametrize(
    "scene, used, unused",
    [
        ("tapered", {"sorokin2018", "harris2006", "iso16281"}, {"iso281", "pan1989"}),
        ("life_spectrum", {"iso281", "iso76", "hamrock1977"}, {"sorokin2018"}),
        ("taper_contact", {"mi2011", "love1929"}, {"sorokin2018", "iso281"}),
        ("noise_four_point", {"kurushin2011", "jones1960"}, {"han2015"}),
        ("skid_axial", {"han2015", "hamrock1977"}, {"kurushin2011"}),
        ("rotor_paper_12", {"filipkovskii2014", "krack2019"}, {"sorokin2018"}),
        ("rotor_spindle", {"jones1960"}, {"filipkovskii2014", "krack2019"}),
        ("fujiwara_kawase", {"fujiwara2007"}, {"iso16281"}),
    ],
)
def test_cite_of_a_scene_names_what_its_study_uses(capsys, scene, used, unused):
    keys = cited(told(capsys, "--cite", scene))
    assert used | {"bearingjax", "jax"} <= keys and not unused & keys


def test_cite_refuses_what_is_no_scene(capsys):
    assert cli.main(["--cite", "no_such_scene"]) == 2
    assert "neither a .toml file nor a shipped scene" in capsys.readouterr().err


def test_reference_rules_are_choices_of_scenes():
    guide = (PACKAGE / "studies/KEYS.md").read_text(encoding="utf-8")
    entries = [found[2] for found in ENTRY.finditer(REFERENCES)]
    rules = {r for e in entries for r in re.split("; | & ", field(e, "usedby") or "")}
    for rule in rules - {""}:
        path, _, word = rule.partition("=")
        key = path.split(".")[-1]
        assert f"| `{key}` |" in guide or re.search(rf"`\[{key}[\].]", guide), rule
        assert f"`{word}`" in guide or not word, rule


def test_citation_file_agrees_with_version_and_references():
    lines = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    head, _, methods = lines.partition("references:\n")
    software = next(ENTRY.finditer(REFERENCES))[2]
    assert re.search(r"^version: (.*)$", head, re.M)[1] == bj.__version__  # type: ignore[index]
    assert f'title: "{field(software, "title")}"' in head
    assert f"license: {project['license']}\n" in head
    name = field(software, "author")
    assert f"name: {name}\n" in head and project["authors"] == [{"name": name}]
    known = {field(found[2], "title"): found[2] for found in ENTRY.finditer(REFERENCES)}
    listed = methods.split("  - type: article\n")[1:]
    assert len(listed) == 5
    for text in listed:
        given = dict(re.findall(r"^    (\w+): (.*)$", text, re.M))
        entry = known[given["title"]]
        names = re.findall(r"family-names: (.*)\n +given-names: (.*)", text)
        assert field(entry, "author") == " and ".join(map(", ".join, names))
        pages = "--".join(given[k] for k in ("start", "end") if k in given)
        assert (field(entry, "pages") or "") == pages
        for ours, theirs in [("number", "issue"), *((k, k) for k in _SAME)]:
            assert field(entry, ours) == given.get(theirs)


_SAME = ("journal", "year", "volume", "doi")


@pytest.mark.parametrize(
    "words, found",
    [
        ("solve tapere", "tapered"),
        ("solve CITATION.c", "CITATION.cff"),
        ("new NU210", "NU210EC"),
        ("examples skid_r", "skid_roller"),
        ("solve tapered --js", "--json"),
    ],
)
def test_bash_completes_scenes_designations_and_options(script, words, found):
    call = 'source "$0"; COMP_WORDS=(bearingjax "$@"); COMP_CWORD=$#; '
    call += '_shtab_bearingjax; echo "${COMPREPLY[*]}"'
    done = subprocess.run(
        ["bash", "-c", call, script, *words.split()],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert done.stdout.split() == [found], done.stderr


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    pytest.importorskip("shtab")
    from bearingjax.cli.completion import completion_script
    from bearingjax.cli.entry import parser

    path = tmp_path_factory.mktemp("shell") / "bearingjax"
    path.write_text(completion_script(parser(), "bash"))
    for shell in ("zsh", "fish"):
        assert "skid_roller" in completion_script(parser(), shell)
    return path

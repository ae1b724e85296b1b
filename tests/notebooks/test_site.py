"""The pages of the site that follow from the code have all of it."""

import importlib
import inspect
import json
import re
import tomllib
from pathlib import Path

import pytest
import site_pages

import bearingjax as bj
from bearingjax.studies.scene_schema import scene_schema

TEXTS = {package: site_pages.api_page(package) for package in site_pages.packages()}
DOCUMENTED = re.findall(
    r"^\.\. auto(?!module)\w+:: (\S+)$", "".join(TEXTS.values()), re.M
)
KINDS = {
    table["properties"]["type"]["const"]
    for table in scene_schema()["$defs"]["bearing"]["anyOf"]
    if "const" in table["properties"].get("type", {})
}


def value_of(name):
    package, _, word = name.rpartition(".")
    return getattr(importlib.import_module(package), word)


@pytest.mark.parametrize("package", TEXTS)
def test_reference_has_every_public_name(package):
    module = importlib.import_module(package)
    shown = [value_of(name) for name in DOCUMENTED]
    for name in module.__all__:
        value = getattr(module, name)
        here = f"{package}.{name}" in DOCUMENTED
        elsewhere = package == "bearingjax" and any(value is one for one in shown)
        assert inspect.ismodule(value) or here or elsewhere, name


def test_reference_has_every_name_once_and_every_package():
    assert len(set(DOCUMENTED)) == len(DOCUMENTED) > 500
    folder = Path(bj.__path__[0])
    listing = [p for p in folder.rglob("__init__.py") if "\n__all__" in p.read_text()]
    parts = [p.parent.relative_to(folder.parent).parts for p in listing]
    assert set(TEXTS) == {".".join(one) for one in parts}


def test_every_type_of_a_scene_is_drawn():
    drawn = set(site_pages.DRAWN)
    files = (site_pages.HERE / "types").glob("*_roller.toml")
    scenes = {path.stem for path in files}
    assert KINDS == drawn | scenes and not drawn & scenes
    for kind, name in site_pages.DRAWN.items():
        assert bj.catalogue_entry(name).type == kind


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_page_of_a_type(kind):
    text = site_pages.type_page(kind)
    assert f"../drawings/{kind}.svg" in text and f"| `type` | `{kind}` |" in text
    (python,) = re.findall(r"```python\n(.*?)```", text, re.S)
    compile(python, kind, "exec")
    load = json.loads(re.findall(r"(\[.*\]),  # Fx", python)[0])
    asked = tomllib.loads(site_pages.scene_text(kind))["operating"]["load"]
    newtons = {"N": 1.0, "kN": 1e3}
    for place, name in enumerate(("Fx", "Fy", "Fz", "Mx", "My", "Mz")):
        number, unit = asked.get(name, "0 N").split()
        assert load[place] == float(number) * newtons[unit]
    for block in re.findall(r"```toml\n(.*?)```", text, re.S):
        assert tomllib.loads(block)["bearing"]["type"] == kind


@pytest.mark.parametrize("source", site_pages.INCLUDED)
def test_links_of_an_included_text_lead_somewhere(source):
    text = re.sub(r"```.*?```|`[^`\n]*`", "", site_pages.included(source), flags=re.S)
    for target in re.findall(r"\]\((?!\w+:|#)([^)#]+)", text):
        own = Path(target).stem in site_pages.INCLUDED.values()
        assert own or (site_pages.MADE / target).resolve().is_file(), target

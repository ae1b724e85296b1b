"""What the theory pages name exists: public names, paths, functions, scripts, pages."""

import ast
import functools
import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent
FOLDER = ROOT / "notebooks" / "theory"
PAGES = sorted(FOLDER.glob("*.md"))
ROLE = re.compile(r"\{(\w+)\}`([^`]+)`")
CODE = re.compile(r"(?<!\})`(\w[\w/]*\.py)(?:::([\w.]+))?`")
LINK = re.compile(r"\]\(([^)]+)\)")

on_each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)


def public_value(target: str):
    """The object that a role points to, by the package that lists its name."""
    package, name = target.rsplit(".", 1)
    try:
        module = importlib.import_module(package)
    except ModuleNotFoundError:
        return getattr(public_value(package), name)  # of a class
    assert name in module.__all__, f"{package} does not list {name}"
    return getattr(module, name)


@functools.cache
def names_in(path: str) -> set[str]:
    """Names that a file defines; those of a class as "Class.name"."""

    def defined(body, prefix=""):
        for node in body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                yield prefix + node.name
            if isinstance(node, ast.ClassDef):
                yield from defined(node.body, f"{prefix}{node.name}.")
            targets = getattr(node, "targets", [getattr(node, "target", None)])
            yield from (prefix + t.id for t in targets if isinstance(t, ast.Name))

    return set(defined(ast.parse((ROOT / path).read_text(encoding="utf-8")).body))


@on_each_page
def test_theory_page_names_what_is_public(page):
    roles = ROLE.findall(page.read_text(encoding="utf-8"))
    assert roles
    for kind, target in roles:
        if kind == "mod":
            importlib.import_module(target)
            continue
        value = public_value(target)
        assert callable(value), target
        assert isinstance(value, type) is (kind == "class"), (kind, target)
        assert kind in ("func", "class", "meth"), kind


@on_each_page
def test_theory_page_names_paths_and_functions_that_exist(page):
    named = CODE.findall(page.read_text(encoding="utf-8"))
    assert named
    for path, name in named:
        file = path if "/" in path else f"benchmarks/{path}"
        assert (ROOT / file).is_file(), path
        assert not name or name in names_in(file), f"{path}::{name}"


@on_each_page
def test_theory_page_is_well_formed(page):
    text = page.read_text(encoding="utf-8")
    assert text.startswith("# ")
    assert text.count("$$") % 2 == 0
    assert text.replace("$$", "").count("$") % 2 == 0
    for target in LINK.findall(text):
        assert (FOLDER / target).is_file(), target


def test_theory_index_lists_every_page_in_order():
    text = (FOLDER / "index.md").read_text(encoding="utf-8")
    table = [Path(target).stem for target in LINK.findall(text)]
    (tree,) = re.findall(r"```\{toctree\}(.*?)```", text, flags=re.DOTALL)
    tree = [line for line in tree.split("\n") if line and not line.startswith(":")]
    assert tree == table
    assert {page.stem for page in PAGES} == {"index", *table}

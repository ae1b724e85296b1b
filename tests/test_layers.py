"""The shape of the package: who may import whom, what is public, what is documented."""

import ast
import importlib
import inspect
import json
import pkgutil
import pydoc
import re
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import bearingjax as bj

PACKAGE = Path(bj.__file__).parent
LAYERS = (
    "numerics files design fits contact lubrication element statics life"
    " cases catalogue friction optimise skid rotor shafts noise decide validation"
    " report plot studies cli"
).split()


def modules():
    return sorted(p for p in PACKAGE.rglob("*.py") if p.parent != PACKAGE)


def imported_layers(path):
    """Folders of the package that a module imports, lazily or not."""
    package = ("bearingjax", *path.relative_to(PACKAGE).with_suffix("").parts[:-1])
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = package[: len(package) - node.level + 1]
            whole = [*base, *(node.module or "").split(".")]
            names = [n.name for n in node.names] if len(base) == 1 else []
            yield from whole[1:2] if node.module or len(base) > 1 else names
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith(
            "bearingjax"
        ):
            yield (node.module or "").split(".")[1]


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_module_imports_respect_layers(path):
    own = path.relative_to(PACKAGE).parts[0]
    allowed = set(LAYERS[: LAYERS.index(own) + 1])
    foreign = set(imported_layers(path)) & set(LAYERS) - allowed
    assert not foreign, f"{path.name} imports {foreign}"


def own_imports(path, tree):
    """Files of the package that the import statements of a syntax tree name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = path.parents[node.level - 1].joinpath(
                *(node.module or "").split(".")
            )
            for place in [base / alias.name for alias in node.names] + [base]:
                files = place.with_suffix(".py"), place / "__init__.py"
                yield from (file for file in files if file.is_file())


# Fast starts: commands import what they need, and `rosenbrock` imports Diffrax.
LATE_IMPORTS = {"cli", "studies", "skid/transients/integration.py"}


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_module_imports_stand_at_its_top(path):
    name = path.relative_to(PACKAGE)
    functions = [n for n in ast.walk(ast.parse(path.read_text())) if is_function(n)]
    late = {file for node in functions for file in own_imports(path, node)}
    assert not late or LATE_IMPORTS & {name.as_posix(), name.parts[0]}, late


def is_function(node):
    return isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)


def test_imports_of_modules_form_no_circle():
    graph = {p: set(own_imports(p, ast.parse(p.read_text()))) for p in modules()}
    graph = {p: found - {p} for p, found in graph.items() if p.name != "__init__.py"}
    assert len(list(TopologicalSorter(graph).static_order())) > 300


STUDIES = (
    *"bearing solve cases contact noise skid rotor shaft select".split(),
    "optimise",
    "identify",
    "catalogue",
    "programs",
    "tolerances",
    "validate",
)


@pytest.mark.parametrize("folder", STUDIES)
def test_studies_import_those_before_them(folder):
    before = {*STUDIES[: STUDIES.index(folder) + 1]}
    for path in (PACKAGE / "studies" / folder).glob("*.py"):
        files = own_imports(path, ast.parse(path.read_text()))
        places = [file.relative_to(PACKAGE).parts for file in files]
        seen = {p[1] for p in places if p[0] == "studies" and len(p) == 3}
        assert seen <= before, path


def test_no_folder_holds_more_than_twenty_files():
    folders = {path.parent for path in PACKAGE.rglob("*.py")}
    assert max(len([*folder.glob("*.py")]) for folder in folders) <= 20


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_only_one_file_calls_lapack(path):
    """A batch of matrices may wait for ever, see `numerics/lapack.py`; these call no
    LAPACK: `norm` and `block_diag`. NumPy's own waits for nobody."""
    if path == PACKAGE / "numerics" / "lapack.py":
        return
    text = path.read_text()
    called = set(re.findall(r"(?:jnp|lax|jax\.numpy|scipy)\.linalg\.(\w+)", text))
    imported = re.findall(
        r"from jax[\w.]* import linalg|(?:from|import) jax.*linalg", text
    )
    assert called <= {"norm", "block_diag"} and not imported


def public_objects():
    for info in pkgutil.walk_packages(bj.__path__, "bearingjax."):
        module = importlib.import_module(info.name)
        for name, value in vars(module).items():
            mine = getattr(value, "__module__", None) == info.name
            if mine and not name.startswith("_") and callable(value):
                yield f"{info.name}.{name}", value


def test_every_public_object_has_a_docstring():
    bare = [name for name, value in public_objects() if not inspect.getdoc(value)]
    assert not bare


def test_top_level_packages():
    """All packages stand there, and none has the name of a function as well."""
    names = [name for name in dir(bj) if not name.startswith("_")]
    modules = {name for name in names if inspect.ismodule(getattr(bj, name))}
    packages = modules - {"jaxtyping"}  # of the import hook of the tests
    folders = {p.parent.name for p in PACKAGE.glob("*/__init__.py")}
    assert folders - {"cli"} <= packages <= folders
    with pytest.raises(AttributeError, match="no attribute 'vibration'"):
        _ = bj.vibration  # pyright: ignore


EXPORTING = [p for p in PACKAGE.rglob("__init__.py") if "import" in p.read_text()]


@pytest.mark.parametrize("path", EXPORTING, ids=lambda p: p.parent.name)
def test_public_names_are_listed(path):
    """`__all__` has what the package imports, each name documented, and its docstring
    lists the same names by subject, under "Names": `help` shows both."""
    module = importlib.import_module(
        ".".join(path.parent.relative_to(PACKAGE.parent).parts)
    )
    imported = {
        alias.name
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom) and node.level
        for alias in node.names
    }
    section = re.split(r"\n\w+\n-+\n", (module.__doc__ or "").split("\nNames\n")[1])[0]
    lines = re.split(r"\n(?=- )", section)[1:]
    listed = [name for line in lines for name in re.findall(r"`(\w+)`", line)]
    assert module.__all__ == listed and set(listed) == imported
    assert len(set(listed)) == len(listed)
    shown = {name: getattr(module, name) for name in listed}
    assert all(inspect.getdoc(v) for v in shown.values() if callable(v))
    page = pydoc.plain(pydoc.text.document(module))
    headed = set(re.findall(r"^ {4}(?:class )?(\w+)(?: =|\()", page, re.M))
    modules = {name for name, value in shown.items() if inspect.ismodule(value)}
    assert set(listed) - modules - {"__version__"} <= headed


def public_functions(body, in_class=False):
    """Public functions and methods of a module: name, arguments, what they return."""
    for node in body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            given = node.args
            arguments = [*given.posonlyargs, *given.args, *given.kwonlyargs]
            more = [a for a in (given.vararg, given.kwarg) if a is not None]
            static = "staticmethod" in map(ast.unparse, node.decorator_list)
            first = 1 if in_class and not static else 0
            yield node.name, arguments[first:] + more, node.returns
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from public_functions(node.body, True)


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_public_functions_are_annotated(path):
    functions = public_functions(ast.parse(path.read_text()).body)
    bare = [
        name
        for name, arguments, returned in functions
        if returned is None or any(a.annotation is None for a in arguments)
    ]
    assert not bare


def test_no_star_imports():
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert all(alias.name != "*" for alias in node.names), path


FRESH = """
import importlib, json, pkgutil, sys, warnings
import jax
before = dict(jax.config.values)
import bearingjax as bj
told = {"settings": [k for k, v in before.items() if jax.config.values[k] != v]}
told["modules"] = list(sys.modules)
for info in pkgutil.walk_packages(bj.__path__, "bearingjax."):
    if not info.name.endswith("__main__"):
        importlib.import_module(info.name)
jax.config.update("jax_num_cpu_devices", 2)
told["devices"] = len(jax.devices("cpu"))
with warnings.catch_warnings(record=True) as seen:
    warnings.simplefilter("always")
    bj.BearingElement(bj.CylindricalRollerBearing(9, 0.06, 0.01, 0.01))
told["warnings"] = [str(w.message) for w in seen]
print(json.dumps(told))
"""


@pytest.fixture(scope="module")
def fresh():
    """What a process of its own says after importing the package."""
    done = subprocess.run(
        [sys.executable, "-c", FRESH], capture_output=True, check=True, timeout=120
    )
    return json.loads(done.stdout)


def test_import_leaves_settings_and_heavy_packages_alone(fresh):
    assert fresh["settings"] == []
    late = "bearingjax." + " bearingjax.".join(bj._LATE)  # pyright: ignore
    others = "diffrax matplotlib optax optimistix pint scipy tqdm"
    assert {*late.split(), *others.split()}.isdisjoint(fresh["modules"])


def test_import_makes_no_array(fresh):
    # An array would fix the number of devices, and the precision of a default value.
    assert fresh["devices"] == 2


def test_float64_is_asked_for(fresh):
    assert any("jax_enable_x64" in text for text in fresh["warnings"])

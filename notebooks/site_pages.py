"""The pages that follow from the code and its texts, written before the site is built.

`_generated/` holds them; nothing in it is committed. A file that would be the same is
left alone, so that Sphinx reads again what has changed.
"""

import functools
import importlib
import inspect
import os
import pkgutil
import re
import tomllib
from pathlib import Path

import site_validation

import bearingjax as bj
from bearingjax.design.keywords import BALLS, ROLLERS
from bearingjax.skid.model import _KINDS as SKIDDING
from bearingjax.statics.support import axial_senses, restrained_freedoms
from bearingjax.studies.bearing.read_scene import scene_of
from bearingjax.studies.catalogue.catalogue_report import new_scene
from bearingjax.studies.scene_schema import key_guide

HERE = Path(__file__).parent
MADE = HERE / "_generated"
INCLUDED = {
    "bearingjax/studies/README.md": "scenes",
    "bearingjax/studies/KEYS.md": "keys",
    "benchmarks/README.md": "benchmarks",
    "CONTRIBUTING.md": "contributing",
    "CHANGELOG.md": "changelog",
}
"""Texts of the repository that are pages here, and their names."""
DRAWN = tomllib.loads((HERE / "types" / "designations.toml").read_text())


def write_pages():
    """Write all pages that are generated."""
    texts = {f"api/{package}.rst": api_page(package) for package in packages()}
    texts |= {f"types/{kind}.md": type_page(kind) for kind in (*BALLS, *ROLLERS)}
    texts["validation.md"] = site_validation.validation_page()
    texts |= {f"{name}.md": included(source) for source, name in INCLUDED.items()}
    head, *parts = re.split(r"\n(?=## )", texts["keys.md"])  # long: a page for each
    named = {re.sub(r"\W+", "_", p.split("\n")[0][3:]).lower(): p for p in parts}
    for name, part in named.items():
        texts[f"keys/{name}.md"] = re.sub("(?m)^#(?=#)", "", part)
    listed = "\n".join(f"keys/{name}" for name in named)
    texts["keys.md"] = f"{head}\n```{{toctree}}\n:maxdepth: 2\n\n{listed}\n```\n"
    for name, text in texts.items():
        place = MADE / name
        place.parent.mkdir(parents=True, exist_ok=True)
        if not place.exists() or place.read_text("utf-8") != text:
            place.write_text(text, "utf-8")
    (MADE / "drawings").mkdir(exist_ok=True)
    for kind in (*BALLS, *ROLLERS):
        draw(kind)
    site_validation.draw_overview()


@functools.cache
def packages():
    """Names of the packages with public names, bearingjax first."""
    inside = pkgutil.walk_packages(bj.__path__, "bearingjax.")
    names = ["bearingjax", *(one.name for one in inside if one.ispkg)]
    return [n for n in names if hasattr(importlib.import_module(n), "__all__")]


@functools.cache
def homes():
    """Full names of all public objects, each at the package that documents it.

    Those of the top level stand in the package of their subject, if they are there.
    """
    found = {}
    for package in reversed(packages()):
        module = importlib.import_module(package)
        for name in module.__all__:
            value = getattr(module, name)
            again = package == "bearingjax" and any(value is v for v in found.values())
            if not inspect.ismodule(value) and not again:
                found[f"{package}.{name}"] = value
    return found


def api_page(package):
    """Reference of a package: its docstring, then its names by their subjects."""
    words = inspect.getdoc(importlib.import_module(package)) or ""
    text = f"{package}\n{'=' * len(package)}\n\n.. automodule:: {package}\n\n"
    section = re.split(r"\n\w+\n-+\n", words.split("\nNames\n")[1])[0]
    for line in re.split(r"\n(?=- )", section)[1:]:
        subject = line[2:].partition(":")[0]
        named = (f"{package}.{name}" for name in re.findall(r"`(\w+)`", line))
        here = [name for name in named if name in homes()]
        text += f"{subject}\n{'-' * len(subject)}\n\n" if here else ""
        for name in here:
            value = homes()[name]
            kind = "function" if callable(value) else "data"
            if inspect.isclass(value):
                kind = "exception" if issubclass(value, BaseException) else "class"
            text += f".. auto{kind}:: {name}\n"
            more = "   :members:\n   :show-inheritance:\n\n"
            text += more if inspect.isclass(value) else "\n"
    return text


def scene_text(kind):
    """Scene of the bearing that a type's page draws: of a designation, or its file."""
    if kind in DRAWN:
        return new_scene(bj.catalogue_entry(DRAWN[kind]))
    return Path(HERE, "types", f"{kind}.toml").read_text()


def type_page(kind):
    """Page of a type of bearing: drawing, model, smallest example, validation."""
    text, about = scene_text(kind), (BALLS | ROLLERS)[kind]
    scene = scene_of(tomllib.loads(text), Path(kind))
    bearing = scene.element.bearing
    new, python, shown = "", f'bj.load_bearing("{kind}.toml")', "the scene below"
    if kind in DRAWN:
        new = f'bearingjax new "{DRAWN[kind]}" > {kind}.toml\n'
        python = f'bj.load_bearing("{DRAWN[kind]}")'
        shown = f"{DRAWN[kind]}, its inside {bj.catalogue_entry(DRAWN[kind]).geometry}"
    sizes = [e.geometry for e in bj.catalogue_entries() if e.type == kind]
    known = f"inside published of {sizes.count('published')}, else estimated"
    along = "along a line, in slices or on a half-space, with the roller's profile"
    senses = (f"{sense:+d}z".replace("1", "") for sense in axial_senses(bearing))
    title = kind.replace("f_a", "f-a").replace("_point", "-point contact")
    tables = re.split(r"\n(?=##)", key_guide("bearing"))
    (keys,) = [t for t in tables if t.startswith(f"### `[bearing]`, {kind}\n")]
    template = Path(HERE, "types", "page.md").read_text()
    return template.format(
        title=title.replace("_", " ").capitalize() + " bearing",
        kind=kind,
        name=about.__name__,
        about=(inspect.getdoc(about) or "").partition("Attributes")[0].strip(),
        shown=shown,
        rows=len(bj.design.rows_of(bearing)),
        contact=along if kind in ROLLERS else "elliptical (Hertz), of balls in grooves",
        freedoms=", ".join(restrained_freedoms(bearing)),
        senses=" and ".join(senses) or "none without ribs",
        sizes=f"{len(sizes)} sizes, {known}" if sizes else "none",
        skids="yes" if isinstance(bearing, SKIDDING) else "no",
        keys=keys[keys.index("| key") :].strip(),
        scene="" if new else f"`{kind}.toml`:\n\n```toml\n{text}```\n\n",
        new=new,
        python=python,
        load=[*map(float, scene.load)],
        speed=float(scene.speed.inner),
        validation=site_validation.cases_of_type(kind),
    )


def included(source):
    """A text of the repository, its relative links leading to the same from here."""

    def moved(link):
        place = os.path.normpath(Path(source).parent / link[2])
        if place in INCLUDED:
            return f"{link[1]}({INCLUDED[place]}.md{link[3] or ''})"
        kept = (HERE.parent / place).is_file()
        return f"{link[1]}(../../{place}{link[3] or ''})" if kept else link[1][1:-1]

    text = (HERE.parent / source).read_text("utf-8")
    return re.sub(r"(!?\[[^\]]*\])\((?!\w+:|#)([^)#\s]+)(#[^)\s]*)?\)", moved, text)


def lead_to_pages(app, name, text):
    """Lead links of a page to a text of the repository to its page here."""
    up = "../" * name.count("/")
    for source, page in INCLUDED.items():
        text[0] = text[0].replace(f"]({up}../{source}", f"]({up}_generated/{page}.md")


def draw(kind):
    """Draw the bearing of a type."""
    scene = scene_of(tomllib.loads(scene_text(kind)), Path(kind))
    figure = bj.plot.drawing(scene.element.bearing, DRAWN.get(kind, ""))
    figure.savefig(MADE / "drawings" / f"{kind}.svg", metadata={"Date": None})

"""Units of fields, which checks, scenes, tables and reports read, are those of the
docstrings."""

import dataclasses
import importlib
import inspect
import pkgutil
import re
from typing import Annotated, NamedTuple

import equinox as eqx
import numpy as np
import pytest

import bearingjax as bj
from bearingjax import design
from bearingjax.cases.output_labels import label_output
from bearingjax.cases.sweep import SUMMARIES
from bearingjax.files.quantity import QUANTITIES, kind_of
from bearingjax.numerics.labels import axes_of
from bearingjax.numerics.types import as_real
from bearingjax.numerics.units import (
    field_metadata,
    shown_change,
    shown_count,
    shown_number,
    unit,
    unit_of,
    units,
)
from bearingjax.statics.solution import BallSolution, RollerSolution

MEASURES = [
    bj.optimise.PeakPressure(),
    bj.optimise.MeanPressure(),
    bj.optimise.EdgeLoad(),
    *(bj.optimise.Displacement(freedom) for freedom in ("ux", "gy")),
    *(bj.optimise.Stiffness(freedom) for freedom in ("uz", "gx")),
    bj.optimise.RatingLife(hours=True),
]


OUTSIDE = "bearingjax.plot", "bearingjax.__main__"


def with_units():
    """Classes of the package whose own fields are real numbers, or have a unit."""
    for module in pkgutil.walk_packages(bj.__path__, "bearingjax."):
        if not module.name.startswith(OUTSIDE):
            for kind in vars(importlib.import_module(module.name)).values():
                own = isinstance(kind, type) and kind.__module__ == module.name
                if own and any(numbers(kind)):
                    yield kind


def stated_units(kind, name):
    """Units in the last brackets of the entry of an attribute in the docstrings of a
    class and its parents, else in their first lines."""
    entry = rf"^ +(?:\w+, )*{name}(?:, \w+)*: (.*?)(?=^ +\w+(?:, \w+)*: |^\s*$|\Z)"
    for base in kind.__mro__:
        text = inspect.cleandoc(base.__dict__.get("__doc__") or "")
        if found := re.search(entry, text, re.M | re.S):
            for part in (found[1], text.partition("\n")[0]):
                if units := re.findall(r"\[([^]]*)\]", part):
                    return {" ".join(u.split()) for u in units[-1].split(",")}
    raise KeyError(f"{kind.__name__}: the docstring does not state {name}")


def numbers(kind):
    """Names of the fields of a class that are, or become, real numbers."""
    if dataclasses.is_dataclass(kind):
        for field in dataclasses.fields(kind):
            converter = field.metadata.get("converter")
            if converter is as_real or "unit" in field.metadata:
                yield field.name


def with_axes():
    """Classes of results that xarray gets."""
    for module in pkgutil.walk_packages(bj.__path__, "bearingjax."):
        if not module.name.startswith(OUTSIDE):
            for kind in vars(importlib.import_module(module.name)).values():
                own = isinstance(kind, type) and kind.__module__ == module.name
                if own and hasattr(kind, "to_xarray"):
                    yield kind


@pytest.mark.parametrize("kind", list(with_units()), ids=lambda kind: kind.__name__)
def test_units_of_fields_are_those_of_the_docstring(kind):
    fields = {field.name: field for field in dataclasses.fields(kind)}
    for name in numbers(kind):
        stated = fields[name].metadata
        units = {*np.ravel(stated.get("unit", stated.get("units")))}
        assert units == stated_units(kind, name), name


def test_unit_of_array_entry():
    class Example(eqx.Module):
        motion: tuple = eqx.field(metadata=unit(("m", "m", "rad")))
        ratio: float = eqx.field(metadata=unit("1"))
        number: int

    assert [unit_of(Example, "motion", (7, k)) for k in range(4)] == [
        "m",
        "m",
        "rad",
        "m",
    ]
    assert unit_of(Example, "ratio") == unit_of(Example, "number") == ""
    part = design.Rib(1.0, 0.1, 0.0)
    assert unit_of(design.Ribs(part), "outer_minus.axial_gap") == "m"
    assert unit_of(Example, "motion") == ""
    with pytest.raises(KeyError, match="none"):
        unit_of(Example, "none")


def floats(kind):
    """Name and axes of the real numbers of a class."""
    for field in dataclasses.fields(kind):
        found = re.search(r"Float\[[^']*'(.*?)'\]", str(field.type))
        if found:
            yield field.name, found[1].split()


@pytest.mark.parametrize("kind", [k for k in vars(design).values() if any(numbers(k))])
def test_a_scene_can_hold_every_number_of_the_drawing(kind):
    for name in numbers(kind):
        unit = unit_of(kind, name)
        assert not unit or QUANTITIES[kind_of(unit)][0] == unit, name


@pytest.mark.parametrize("kind", [RollerSolution, BallSolution])
def test_columns_of_a_sweep_have_the_unit_of_the_docstring(kind):
    for name, axes in floats(kind):
        sizes = [axis.rpartition("=")[2] for axis in axes]
        shape = tuple(int(size) if size.isdigit() else 2 for size in sizes)
        units = {
            header.partition(" [")[2].rstrip("]")
            for header, *_ in label_output(name, np.zeros((1, *shape))).columns(name)
        }
        assert units == stated_units(kind, name), name


def results():
    """Named tuples that packages of the top level export, and their real numbers."""
    for package in ("lubrication", "statics", "optimise", "skid", "rotor", "shafts"):
        yield from _tuples(importlib.import_module(f"bearingjax.{package}"))
    for module in (bj.rotor.nonlinear, bj.noise):
        yield from _tuples(module)


def _tuples(module):
    for kind in vars(module).values():
        if isinstance(kind, type) and issubclass(kind, tuple):
            real = [
                name
                for name in getattr(kind, "_fields", ())
                if re.search("Float|Scalar", str(kind.__annotations__.get(name)))
            ]
            if real:
                yield pytest.param(kind, real, id=kind.__name__)


@pytest.mark.parametrize("kind, names", list(results()))
def test_results_state_their_units(kind, names):
    for name in names:
        assert {"unit", "units"} & field_metadata(kind, name).keys(), name


@pytest.mark.parametrize("kind", list(with_axes()), ids=lambda kind: kind.__name__)
def test_results_name_their_axes_and_state_their_units(kind):
    names = [*getattr(kind, "_fields", ()), *getattr(kind, "__dataclass_fields__", ())]
    for name in names:
        axes = axes_of(kind, name)
        text = str(inspect.get_annotations(kind).get(name))
        assert not any(axis.isdigit() for axis in axes or ()), name
        real = re.search("Float|Complex", text) and not text.startswith("dict")
        if real and (kind.__name__, name) != ("Spectrum", "amplitude"):
            assert {"unit", "units"} & field_metadata(kind, name).keys(), name


def tuples():
    """Named tuples of the package with units."""
    for module in pkgutil.walk_packages(bj.__path__, "bearingjax."):
        if not module.name.startswith("bearingjax.__main__"):
            for kind in vars(importlib.import_module(module.name)).values():
                own = isinstance(kind, type) and kind.__module__ == module.name
                names = getattr(kind, "_fields", ()) if own else ()
                if any(field_metadata(kind, name) for name in names):
                    yield kind


@pytest.mark.parametrize("kind", list(tuples()), ids=lambda kind: kind.__name__)
def test_units_of_named_tuples_are_those_of_the_docstring(kind):
    for name in kind._fields:
        found = field_metadata(kind, name)
        units = {*found.get("units", ()), *np.ravel(found.get("unit", ()))}
        assert not units or units == stated_units(kind, name), name


def test_unit_of_a_named_tuple():
    class Example(NamedTuple):
        force: Annotated[float, units("N", "N m")]
        moments: Annotated[list, unit(("N", "N m"))]
        life: Annotated[float | None, unit("rev")]
        ratio: Annotated[float, unit("1")]
        rows: int

    found = Example(1.0, [2.0, 2.0], 3.0, 4.0, 5)
    names = "life", "ratio", "rows", "force"
    assert [unit_of(found, name) for name in names] == ["rev", "", "", ""]
    assert unit_of(Example, "moments.1") == unit_of(Example, "moments", (1,)) == "N m"
    assert unit_of(Example, "moments") == ""
    with pytest.raises(KeyError, match="none"):
        unit_of(Example, "none")

    class Derived(Example):
        """A named tuple with methods has the fields of its parent."""

    assert unit_of(Derived, "life") == "rev"


@pytest.mark.parametrize("measure", MEASURES, ids=lambda measure: measure.label)
def test_measures_have_the_unit_of_their_docstring(measure):
    first = type(measure).__doc__.partition(".\n")[0]
    units = re.findall(r"\[([^]]*)\]", first)[0].split(", ")
    assert measure.unit in units


def test_a_column_of_another_shape_than_the_field_has_no_unit_of_one_entry():
    def headers(name, *shape):
        values = np.zeros((1, *shape))
        return [header for header, *_ in label_output(name, values).columns(name)]

    assert headers("displacement", 12)[1] == "displacement_outer_uy [m]"
    assert headers("displacement", 2) == ["displacement_0", "displacement_1"]
    assert headers("stiffness") == ["stiffness"]
    assert headers("roller_load", 7)[3] == "roller_load_3 [N]"
    assert headers("roller_motion", 1, 4)[3] == "roller_motion_0_3"
    assert headers("edge_load", 1, 2, 2)[1] == "edge_load_0_0_1 [N/m]"
    assert [headers(name) for name in SUMMARIES] == [
        ["largest_load [N]"],
        ["peak_pressure [Pa]"],
        ["n_loaded"],
        ["iterations"],
        ["residual"],
    ]
    assert headers("power") == ["power"]


def test_one_thing_is_shown_in_the_singular():
    shown = [shown_count(count, "step") for count in (0, 1, 2)]
    assert shown == ["0 steps", "1 step", "2 steps"]


def test_numbers_without_end_are_shown_in_words():
    assert shown_number(np.inf, "m") == shown_change(np.inf, "K") == "infinite"
    assert shown_number(-np.inf, "K") == "-infinite"
    assert shown_change(2.0, "K") == "2 K" and shown_number(333.15, "K") == "60 °C"

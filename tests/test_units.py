"""Units that scenes, tables and reports name are those of the docstrings."""

import dataclasses
import itertools
import re

import pytest

import bearingjax as bj
from bearingjax import design
from bearingjax.scene.bearing_table import KIND_OF
from bearingjax.scene.quantity import KINDS
from bearingjax.statics.solution import BallSolution, RollerSolution
from bearingjax.statics.sweep_table import _label

# Of the set, not of the drawing of a row: no key of [bearing].
OF_A_SET = (bj.SetRow, bj.BearingSet, bj.PreloadSpring)
DRAWN = [
    kind
    for kind in vars(design).values()
    if dataclasses.is_dataclass(kind) and kind not in OF_A_SET
]
MEASURES = [
    bj.PeakPressure(),
    bj.MeanPressure(),
    bj.EdgeLoad(),
    *(bj.Displacement(freedom) for freedom in ("ux", "gy")),
    *(bj.Stiffness(freedom) for freedom in ("uz", "gx")),
]


def stated(kind, name):
    """Units that a class or its parents state of an attribute, in their docstrings."""
    for base in kind.__mro__:
        entry = rf"^ +{name}: (.*?)(?=^ +\w+: |^\s*$|\Z)"
        found = re.search(entry, base.__doc__ or "", re.M | re.S)
        if found:
            units = re.findall(r"\[([^]]*)\]", found[1])
            return {unit.strip() for unit in units[-1].split(",")} if units else set()
    raise AssertionError(f"{kind.__name__}: nothing is said of {name}")


def floats(kind):
    """Name and axes of the real numbers of a class."""
    for field in dataclasses.fields(kind):
        found = re.search(r"Float\[[^']*'(.*?)'\]", str(field.type))
        if found:
            yield field.name, found[1].split()


@pytest.mark.parametrize("kind", DRAWN, ids=lambda kind: kind.__name__)
def test_numbers_of_the_drawing_are_read_in_the_unit_of_the_docstring(kind):
    for name, axes in floats(kind):
        if not axes:
            of_kind = KIND_OF[name]
            unit = "1" if of_kind == "number" else KINDS[of_kind][0]
            assert stated(kind, name) == {unit.replace("^3", "³")}, name


@pytest.mark.parametrize("kind", [RollerSolution, BallSolution])
def test_columns_of_a_sweep_have_the_unit_of_the_docstring(kind):
    for name, axes in floats(kind):
        shape = tuple(int(axis) if axis.isdigit() else 2 for axis in axes)
        units = {
            _label(name, index, shape)[1]
            for index in itertools.product(*(range(n) for n in shape))
        }
        assert units == stated(kind, name), name


@pytest.mark.parametrize("measure", MEASURES, ids=lambda measure: measure.label)
def test_measures_have_the_unit_of_their_docstring(measure):
    first = type(measure).__doc__.partition(".\n")[0]
    units = re.findall(r"\[([^]]*)\]", first)[0].split(", ")
    assert measure.unit in units

"""Names and units of arrays are those that the class states."""

import sys
from typing import Annotated, NamedTuple

import equinox as eqx
import numpy as np
import pytest
from jaxtyping import Array, Float, Int

from bearingjax.numerics import labels
from bearingjax.numerics.labels import (
    LabelledArray,
    axes_of,
    labelled_fields,
    make_dataset,
    name_axis,
    summaries,
    to_xarray,
)
from bearingjax.numerics.result import Result
from bearingjax.numerics.units import unit, units


@pytest.fixture(autouse=True)
def names(monkeypatch):
    monkeypatch.setattr(labels, "AXIS_LABELS", {})
    name_axis("side", ("left", "right"))
    name_axis("way", "uvw")


class Part(NamedTuple):
    speed: Annotated[Float[Array, "*item"], unit("rad/s")]
    turn: Annotated[Float[Array, "*item way=3"], units("m", "rad")]


class Example(eqx.Module):
    load: Float[Array, "item side=2"] = eqx.field(
        metadata=unit("N", largest="most_load")
    )
    motion: Float[Array, "item way=3"] = eqx.field(metadata=unit(("m", "m", "rad")))
    place: Float[Array, "*item point"] = eqx.field(metadata=unit("m"))
    travel: Float[Array, " item"] | None = eqx.field(metadata=unit("m"))
    result: Int[Array, ""]
    part: Part | None
    name: str = eqx.field(static=True, default="x")


def example(*cases, place=(5,)):
    return Example(
        np.zeros((*cases, 4, 2)),
        np.zeros((*cases, 4, 3)),
        np.zeros((*cases, *place)),
        None,
        np.full(cases, int(Result.CONVERGED)),
        Part(np.zeros((*cases, 4)), np.ones((*cases, 4, 3))),
    )


def test_axes_of_a_field():
    assert axes_of(Example, "load") == ("item", "side")
    assert axes_of(Example, "place") == ("*item", "point")
    assert axes_of(Example, "travel") == ("item",)
    assert axes_of(Part, "turn") == ("*item", "way")
    assert axes_of(Example, "result") == () and axes_of(Example, "part") is None


@pytest.mark.parametrize("cases", [(), (6,), (6, 7)])
@pytest.mark.parametrize("place", [(5,), (4, 5)])
def test_labelled_fields_with_leading_cases(cases, place):
    found = labelled_fields(example(*cases, place=place))
    lead = {0: (), 1: ("case",), 2: ("case_0", "case_1")}[len(cases)]
    assert list(found) == ["load", "motion", "place", "result"]
    assert found["load"].axes == (*lead, "item", "side")
    item = ("item",) if len(place) == 2 else ()
    assert found["place"].axes == (*lead, *item, "point")
    assert found["result"].axes == lead


def test_columns_have_names_along_their_last_axes():
    found = labelled_fields(example(6))
    headers = [header for header, *_ in found["motion"].columns("motion")]
    assert headers[1:4] == ["motion_0_v [m]", "motion_0_w [rad]", "motion_1_u [m]"]
    counted = LabelledArray(
        np.arange(8).reshape(1, 2, 4), ("case", "side", "item"), "N"
    )
    (header, names, values), *_ = list(counted.columns("load"))[5:]
    assert (header, names, values) == ("load_1_1 [N]", ("1", "1"), 5)
    assert next(LabelledArray(np.ones((3, 2)), ("case", "side"), "N").columns(""))[
        0
    ] == ("left [N]")


def test_values_of_another_shape_than_the_class_states_have_no_names():
    for shape in ((2,), (4, 3), (4, 2, 2)):
        found = LabelledArray.field(Example, "load", np.zeros(shape))
        named = ("load_0", "load_1", "load_2")[: len(shape)]
        assert found.axes == named and found.units == "N"
    assert LabelledArray.field(Example, "load", np.zeros((4, 2))).axes == (
        "item",
        "side",
    )


def test_to_xarray_has_names_units_and_words():
    found = to_xarray(example(6), "part")
    assert dict(found.sizes) == {"case": 6, "item": 4, "side": 2, "way": 3, "point": 5}
    assert list(found.side.values) == ["left", "right"] and "item" not in found.coords
    assert found["load"].sel(side="left").dims == ("case", "item")
    assert (found["load"].attrs, found.motion.attrs) == (
        {"units": "N"},
        {"units": "m, rad"},
    )
    assert found.turn.attrs == {"units": "m, rad"} and found.speed.units == "rad/s"
    assert set(found.result.values) == {"converged"}


def test_make_dataset_keeps_axes_apart():
    """A name that an array has too, and one axis name of two lengths."""
    one = LabelledArray(np.zeros((3, 2)), ("motion", "side"))
    two = {"motion": LabelledArray(np.zeros((2, 2)), ("motion", "side")), "free": one}
    two["none"] = LabelledArray(np.zeros((0, 2)), ("seat", "side"))
    two["time"] = LabelledArray(np.arange(4.0), ("time",), "s")
    found = make_dataset(two, {"side": ("a", "b")})
    assert found.motion.dims == ("motion_axis", "side")
    assert found.free.dims == ("motion_axis_of_free", "side")
    assert list(found.side.values) == ["a", "b"]
    assert found.indexes["time"].tolist() == [0.0, 1.0, 2.0, 3.0]


def test_to_xarray_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match=r'pip install "bearingjax\[table\]"'):
        to_xarray(example())


def test_summaries_are_those_that_fields_state():
    assert summaries(Example) == {"most_load": "load"}

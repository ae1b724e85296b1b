"""One class of warnings, and the tables of their kinds."""

import copy
import dataclasses
import json
import math
import pickle

import pytest

from bearingjax.numerics.warning import Kind, Warning, in_cases, warnings_of


def test_warning_is_its_sentence():
    one = Warning("hot", "the oil is hot", 90.0, 80.0, "sump")
    assert one == str(one) == one.words == "the oil is hot"
    assert (one.kind, one.size, one.limit, one.where) == ("hot", 90.0, 80.0, "sump")
    assert json.loads(json.dumps([one])) == ["the oil is hot"]
    assert type(str(one)) is str
    assert math.isnan(Warning("odd", "it is odd").size)
    with pytest.raises(dataclasses.FrozenInstanceError):
        one.size = 3.0  # pyright: ignore[reportAttributeAccessIssue]


@pytest.mark.parametrize(
    "twin", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))]
)
def test_warning_survives_copies(twin):
    one = Warning("hot", "the oil is hot", 90.0, 80.0, "sump")
    assert type(twin(one)) is Warning
    assert vars(twin(one)) == vars(one) and twin(one) == one


def test_warning_of_a_part_begins_with_its_name():
    (one,) = warnings_of("fan", [Warning("hot", "the oil is hot", 90.0, 80.0, "sump")])
    assert one == "fan: the oil is hot"
    assert (one.kind, one.size, one.where) == ("hot", 90.0, "fan: sump")
    assert Warning("hot", "the oil is hot").about("fan").where == "fan"


def test_kind_shows_size_and_limit_in_its_unit():
    kind = Kind(2e-6, "{size:g} µm over {limit:g}{where}", shown=lambda x: 1e6 * x)
    one = kind.warning("gap", 5e-6, " (row 1)")
    assert one == "5 µm over 2 (row 1)" and one.where == "row 1"
    assert (one.kind, one.size, one.limit) == ("gap", 5e-6, 2e-6)
    worst = in_cases(one, 2, 9, 4)
    assert worst == "5 µm over 2 (row 1), in 2 of 9 cases, worst case 4"
    assert worst.size == one.size and in_cases(one, 1, 1, 0) == one
    assert in_cases(one, 1, 2, 0).endswith(", in 1 of 2 cases, worst case 0")

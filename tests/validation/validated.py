"""Tests of validation cases, shared by the files of this folder."""

import functools
import json
from pathlib import Path

import numpy as np
import pytest

from bearingjax.studies.validate.run import compare_case
from bearingjax.validation import cases

STORED = Path(__file__).parents[2] / "notebooks" / "validation.json"
"""Our numbers as the site shows them; written by `bearingjax validate --json`."""
_SAME = 1e-5
"""Relative difference of numbers that count as the stored ones."""


def parameters(*subjects):
    """Return a parameter for each case of some subjects."""
    return [
        pytest.param(case, marks=[pytest.mark.slow] if case.slow else [], id=name)
        for name, case in cases().items()
        if case.subject in subjects
    ]


def check_case(case):
    """Assert that ours are as near to theirs as the case asks for, and those stored."""
    stored = _stored().get(case.name, {})
    for one in compare_case(case):
        number = one.number
        if number.is_test:
            where = f"{number.name}: {one.ours} {number.unit}, theirs {number.theirs}"
            assert one.kept, f"{where}: differs by {one.largest:.3g}"
        assert number.name in stored, f"run bearingjax validate --json {STORED.name}"
        old = np.array(stored[number.name]["ours"], float)
        asked = np.isfinite(number.theirs)  # the others may be round-off
        # What is zero but for round-off is so within what the case allows.
        least = max(1e-9 * np.abs(one.flat_ours).max(), number.within)
        np.testing.assert_allclose(one.flat_ours, old[asked], rtol=_SAME, atol=least)


@functools.cache
def _stored():
    return json.loads(STORED.read_text("utf-8"))["cases"]

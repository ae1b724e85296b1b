"""Validation cases of loads, displacements, preload and bearings at speed."""

import pytest
from validated import check_case, parameters


@pytest.mark.parametrize("case", parameters("statics", "preload", "speed"))
def test_case(case):
    check_case(case)

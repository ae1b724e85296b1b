"""Validation cases of rotors, noise, skidding and shafts."""

import pytest
from validated import check_case, parameters


@pytest.mark.parametrize("case", parameters("skidding", "rotors", "noise", "shafts"))
def test_case(case):
    check_case(case)

"""Validation cases of single contacts, lives, friction, oils, fits, the catalogue."""

import pytest
from validated import check_case, parameters

SUBJECTS = "contact", "life", "friction", "lubrication", "fits", "catalogue"


@pytest.mark.parametrize("case", parameters(*SUBJECTS))
def test_case(case):
    check_case(case)

"""Numbers of validation cases, for tests that come to them by another way."""

from bearingjax.validation import cases
from bearingjax.validation.case import as_number


def inputs(case, name):
    """Return the inputs under a name, one for each row of a case [SI]."""
    return as_number(cases()[case].rows[name])


def theirs(case, name):
    """Return the values that a case states [SI]."""
    (number,) = (one for one in cases()[case].numbers if one.name == name)
    return number.size * number.theirs

"""Properties, checked on examples that hypothesis makes."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st


def holds_for(
    designs: Mapping[str, Any] | None = None,
    quick: frozenset[str] = frozenset(),
    rarely: int = 1,
    **strategies: st.SearchStrategy,
) -> Callable:
    """Make a test of a property: on few examples, and slow, on many.

    Args:
        designs: Name to argument `design` of tests of their own; slow unless `quick`.
        rarely: Divides the number of examples, of properties whose examples take long.
        strategies: Strategies by the names of the arguments. Numbers of compiled
            functions are arrays, or each example compiles anew.
    """
    cases = [
        pytest.param(
            design, profile, id=f"{name}{profile and '-'}{profile}", marks=marks
        )
        for name, design in ({"": None} if designs is None else designs).items()
        for profile in ("", "long")
        # A test without designs is quick.
        for marks in [
            pytest.mark.slow if profile or (name and name not in quick) else ()
        ]
    ]

    def test_of(check: Callable[..., Any]):
        @pytest.mark.parametrize("design, profile", cases)
        def test(design, profile):
            # Without a name: that which `--hypothesis-profile` chooses, `fast`.
            profile = settings.get_profile(profile) if profile else settings()
            examples = max(profile.max_examples // rarely, 5)
            drawn = dict(strategies)
            if designs is not None:
                drawn["design"] = st.just(design)
            settings(profile, max_examples=examples)(given(**drawn)(check))()

        test.__name__, test.__doc__ = check.__name__, check.__doc__
        return test

    return test_of


def reals(low: float, high: float) -> st.SearchStrategy[float]:
    """Finite floats within bounds."""
    return st.floats(low, high, allow_subnormal=False)

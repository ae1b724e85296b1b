"""States of a mounted bearing, and its clearance over the tolerances of its sizes.

Compiles nothing for a mounting of NumPy numbers, as from `jax.device_get`.
"""

from typing import Annotated, Any, NamedTuple

import equinox as eqx

from ..design.checks import floats, in_range, must_be, one_of
from ..numerics.units import unit
from .fits import FitConditions, FitState, Mounting, fit_state, positive_part
from .iso286 import Limits

_WIDEST = 0.01
"""Beyond all clearances and deviations of bearings up to 1 m; micrometres meant? [m]"""


class SizeLimits(NamedTuple):
    """Limits of the sizes on which the clearance of a mounted bearing depends.

    They are arguments of `clearance_range` and `mounting_at`: `*limits`.

    Attributes:
        clearance: Limits of the radial clearance before mounting [m].
        shaft: Limits of the deviation of the shaft's diameter [m].
        bore: Limits of the deviation of the bore [m].
        housing: Limits of the deviation of the housing's bore [m].
        outside_diameter: Limits of the deviation of the outside diameter [m].
    """

    clearance: Annotated[Limits, unit("m")]
    shaft: Annotated[Limits, unit("m")]
    bore: Annotated[Limits, unit("m")]
    housing: Annotated[Limits, unit("m")]
    outside_diameter: Annotated[Limits, unit("m")]


class ClearanceRange(NamedTuple):
    """Radial internal clearance of many bearings whose sizes scatter.

    Attributes:
        middle: Clearance with all sizes in the middle of their limits [m].
        worst: Least and largest clearance [m].
        probable: Root sum of squares of the effects of single sizes about the middle:
            it contains the same share of bearings as the limits do of each size, if
            sizes are normal and independent, and fits do not come loose. Where they do,
            it is cut off at `worst` [m].
    """

    middle: Annotated[Any, unit("m")]
    worst: Annotated[Limits, unit("m")]
    probable: Annotated[Limits, unit("m")]


def clearance_range(
    mounting: Mounting,
    clearance: Limits,
    shaft: Limits,
    bore: Limits,
    housing: Limits,
    outside_diameter: Limits,
    conditions: FitConditions | None = None,
) -> ClearanceRange:
    """Radial internal clearance over the tolerances of all sizes of a mounting.

    Args:
        mounting: The bearing and its seats; its clearance and interferences do not
            count, all else does.
        clearance: Limits of the clearance before mounting [m].
        shaft, bore, housing, outside_diameter: Limits of the deviations of shaft
            diameter, bore, housing bore and outside diameter (`limits`, `bore_limits`,
            `outside_limits`) [m].
        conditions: As in `fit_state`.

    Raises:
        ValueError: If a lower limit is above the upper one.
    """
    cases = _Cases(
        mounting, _check_given(clearance, shaft, bore, housing, outside_diameter)
    )
    middle, half = cases.clearance_spread(conditions)[:2]
    least, most = (cases.clearance(side, conditions) for side in (-1.0, 1.0))
    return ClearanceRange(
        middle,
        Limits(least, most),
        Limits(_larger_of(middle - half, least), -_larger_of(-middle - half, -most)),
    )


class FitStates(NamedTuple):
    """Clearance and seats of a bearing, from before mounting to operation.

    Attributes:
        free: Radial clearance before mounting [m].
        mounted: State when mounted, at rest, at the reference temperature.
        operating: State in operation.
        mounted_range: Clearance over all tolerances, mounted; `None` without limits.
        operating_range: Clearance over all tolerances, in operation, likewise.
        loosest: State in operation at the sizes with the largest clearance, likewise.
    """

    free: Annotated[Any, unit("m")]
    mounted: FitState
    operating: FitState
    mounted_range: ClearanceRange | None
    operating_range: ClearanceRange | None
    loosest: FitState | None


def fit_states(
    mounting: Mounting,
    conditions: FitConditions | None = None,
    limits: SizeLimits | None = None,
) -> FitStates:
    """Clearance and seats of a bearing before mounting, mounted and in operation.

    Args:
        mounting: The bearing and its seats.
        conditions: Temperatures and speeds in operation; `None`: as mounted.
        limits: Limits of its sizes; `None`: nothing is said of tolerances.

    Raises: as `clearance_range`.
    """
    free = mounting.radial_clearance
    cold, warm = (fit_state(mounting, one) for one in (None, conditions))
    if limits is None:
        return FitStates(free, cold, warm, None, None, None)
    return FitStates(
        free,
        cold,
        warm,
        clearance_range(mounting, *limits),
        clearance_range(mounting, *limits, conditions),
        fit_state(mounting_at(mounting, "loosest", *limits), conditions),
    )


def _larger_of(one, other):
    return other + positive_part(one - other)


PLACES = {
    "middle": 0.0,
    "tightest": -1.0,
    "loosest": 1.0,
    "probable_tightest": -1.0,
    "probable_loosest": 1.0,
}
"""Places that `mounting_at` takes, each with its side: + is large clearance."""


def mounting_at(
    mounting: Mounting,
    place: str,
    clearance: Limits,
    shaft: Limits,
    bore: Limits,
    housing: Limits,
    outside_diameter: Limits,
    conditions: FitConditions | None = None,
) -> Mounting:
    """A mounting with sizes at given places within their tolerances.

    Args:
        mounting: The bearing and its seats; its clearance and interferences do not
            count, all else does.
        place: "middle": all sizes in the middle of their limits. "tightest", "loosest":
            at those that leave the least and the largest clearance.
            "probable_tightest", "probable_loosest": at the sizes that most likely give
            the limits of `ClearanceRange.probable` (exact as long as no fit comes
            loose).
        clearance, shaft, bore, housing, outside_diameter: As in `clearance_range`.
        conditions: As in `fit_state`; the probable places depend on them.

    Raises:
        ValueError: If there is no such place, or a lower limit is above the upper one.
    """
    one_of("mounting_at", "place", place, PLACES)
    given = _check_given(clearance, shaft, bore, housing, outside_diameter)
    cases, side = _Cases(mounting, given), PLACES[place]
    if not place.startswith("probable"):
        return cases.mounting(dict.fromkeys(given, side))
    _, half, effects = cases.clearance_spread(conditions)
    whole = half + 1e-30  # 0 if all sizes are exact, and so are their effects
    return cases.mounting({name: side * e / whole for name, e in effects.items()})


def _check_given(clearance, shaft, bore, housing, outside_diameter):
    given = {
        "clearance": clearance,
        "shaft": shaft,
        "bore": bore,
        "housing": housing,
        "outside_diameter": outside_diameter,
    }
    for name, pair in given.items():
        whole = isinstance(pair, tuple) and len(pair) == 2
        allowed = "Limits, two numbers in m"
        must_be("clearance_range", name, pair, whole, allowed, TypeError)
        for end in pair:
            in_range("clearance_range", name, -_WIDEST, _WIDEST, end, "m")
        known = floats(*pair)
        if known is not None and known[0] > known[1]:
            raise ValueError(
                f"clearance_range: `{name}` is {known[0]:.6g} to {known[1]:.6g} m; its"
                " lower limit must not be above its upper one."
            )
    return given


class _Cases(NamedTuple):
    """A mounting and the limits of its sizes.

    A place in the limits of a size is a number from -1, where it leaves the least
    clearance, to 1.
    """

    base: Mounting
    limits: dict[str, Limits]

    def mounting(self, places) -> Mounting:
        """The mounting with each size at its place within its limits."""
        sizes = {}
        for name, (lower, upper) in self.limits.items():
            # Large shafts and outside diameters take clearance, the others give it.
            turned = -1.0 if name in ("shaft", "outside_diameter") else 1.0
            shift = 0.5 * turned * places[name] * (upper - lower)
            sizes[name] = 0.5 * (lower + upper) + shift
        return eqx.tree_at(
            lambda m: (
                m.radial_clearance,
                m.shaft_interference,
                m.housing_interference,
            ),
            self.base,
            (
                sizes["clearance"],
                sizes["shaft"] - sizes["bore"],
                sizes["outside_diameter"] - sizes["housing"],
            ),
            is_leaf=lambda leaf: leaf is None,
        )

    def clearance(self, place, conditions, **others):
        """Radial clearance with all sizes at one place but for `others`."""
        places = {**dict.fromkeys(self.limits, place), **others}
        return fit_state(self.mounting(places), conditions).radial_clearance

    def clearance_spread(self, conditions):
        """Clearance in the middle, root sum of squares about it, and what each does."""
        effects = {
            name: 0.5
            * (
                self.clearance(0.0, conditions, **{name: 1.0})
                - self.clearance(0.0, conditions, **{name: -1.0})
            )
            for name in self.limits
        }
        half = sum(effect**2 for effect in effects.values()) ** 0.5
        return self.clearance(0.0, conditions), half, effects

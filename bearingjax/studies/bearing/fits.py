"""Seats of the bearing of a scene: their effects, and the bearing on them."""

import dataclasses
import functools
from typing import Any

import jax

from ...design import AbstractBearing, BearingSet
from ...element import BearingElement, Speed
from ...fits import (
    FitConditions,
    Mounting,
    clearance_range,
    fit_state,
    mounting_at,
    with_bearing_dimensions,
)
from ...fits.fit_range import ClearanceRange
from ...fits.fits import FitState
from ...statics.installed import Installed
from ...statics.service_warning import seat_warnings
from .catalogue_keys import FromCatalogue


@dataclasses.dataclass(frozen=True)
class FitFacts:
    """Effects of fits, as plain numbers.

    Attributes:
        free: Radial clearance before mounting [m].
        mounted: State when mounted, at rest, at the reference temperature.
        operating: State in operation.
        mounted_range: Radial clearance over all tolerances, mounted.
        operating_range: Radial clearance over all tolerances, in operation.
        loosest: State in operation at the sizes with the largest clearance.
    """

    free: float
    mounted: FitState
    operating: FitState
    mounted_range: ClearanceRange
    operating_range: ClearanceRange
    loosest: FitState


@dataclasses.dataclass(frozen=True)
class Fits:
    """Seats of the bearing of a scene.

    Attributes:
        mounting: The seats, with the interferences at `place`; raceways and clearance
            are those of the bearing.
        conditions: Temperatures and speeds.
        place: Position within the tolerances, one of `PLACES`.
        limits: `Limits` of clearance and seats, as in `clearance_range`.
        names: Tolerance classes of shaft and housing; empty for numbers.
        unknown: Parts of the bearing of unknown thermal expansion, at reference
            temperature, with the key of their material in [bearing].
        bearing: The bearing on them, unmounted.
    """

    mounting: Mounting
    conditions: FitConditions
    place: str
    limits: dict[str, Any]
    names: tuple[str, str]
    unknown: dict[str, str]
    bearing: AbstractBearing | BearingSet

    @functools.cached_property
    def facts(self) -> FitFacts:
        """Their effects."""
        mounting = jax.device_get(with_bearing_dimensions(self.mounting, self.bearing))
        warm, cold = jax.device_get((self.conditions, FitConditions()))
        loosest = mounting_at(mounting, "loosest", **self.limits)
        return FitFacts(
            float(mounting.radial_clearance),
            fit_state(mounting, cold),
            fit_state(mounting, warm),
            clearance_range(mounting, **self.limits, conditions=cold),
            clearance_range(mounting, **self.limits, conditions=warm),
            fit_state(loosest, warm),
        )


def fit_warnings(fits: Fits, load_fixed_to: str = "space") -> list[str]:
    """Return warnings about fits, one sentence each.

    Args:
        fits: From `read_fits`.
        load_fixed_to: As in `LifeConditions`.
    """
    facts, conditions = fits.facts, fits.conditions
    speed = Speed(conditions.speed, conditions.outer_speed)
    seats = facts.mounted, facts.operating, facts.loosest
    return seat_warnings(*seats, speed=speed, load_fixed_to=load_fixed_to)


def fits_at_speed(fits: Fits | None, speed: float) -> Fits | None:
    """Return the fits on a rotating shaft in a stationary housing.

    Args:
        fits: From `read_fits`.
        speed: Speed of shaft and inner ring [rad/s].
    """
    if fits is None:
        return None
    given = dataclasses.replace(fits.conditions, speed=speed, outer_speed=0.0)
    return dataclasses.replace(fits, conditions=given)


def install(
    drawing: BearingElement[Any],
    preload: float | None,
    fits: Fits | None,
    catalogue: FromCatalogue | None = None,
) -> Installed:
    """Return a bearing with the preload and the seats of its scene.

    Args:
        drawing: The bearing with its laws and numerics.
        preload: Preload force to which its rows are ground [N], or `None`.
        fits: From `read_fits`.
        catalogue: Catalogue entry of its designation, or `None`.
    """
    names = "limiting_speed", "reference_speed"
    speeds = {k: getattr(catalogue.entry, k) for k in names} if catalogue else {}
    if fits is None:
        return Installed(drawing, preload, **speeds)
    return Installed(drawing, preload, fits.mounting, fits.conditions, **speeds)

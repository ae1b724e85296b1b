"""Warnings about the service of a bearing: its seats and its speed."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..element.inertia import Speed
from ..fits.fits import FitState
from ..numerics.types import as_real
from ..numerics.warning import Warning, in_cases
from .preload import SetPreload

MOST_STRESS = 127e6
"""Hoop stress above which a fit is warned of, of bearing steel [Pa]: the largest that
catalogues of rolling bearings (JTEKT, NTN) allow a fit."""

MOST_DRIFT = 0.5e-6
"""Change of radial clearance over the speed above which it is warned of [m]."""

MOST_CHANGE = 2.0
"""Ratio to the preload as ground from which a change of preload is warned of [1]."""

_EXACT = 1e-9
"""Interference below which a seat is neither tight nor loose, by round-off [m]."""

_SEATS = {"housing": "the outer ring", "shaft": "the inner ring on its shaft"}
"""Seats in the order of the rings (outer, inner), and what sits there."""


def turns_against_load(
    speed: Speed | None, load_fixed_to: str = "space"
) -> Float[Array, "2"]:
    """1 where a ring turns against the load, 0 where it does not (outer, inner).

    Both may; if none does, or no speed is known, the inner ring counts as turning, or
    the outer one if the load is fixed to the inner.

    Args:
        speed: Ring speeds.
        load_fixed_to: As in `LifeConditions`.
    """
    usual = as_real([1.0, 0.0] if load_fixed_to == "inner" else [0.0, 1.0])
    if speed is None:
        return usual
    frames = {"inner": speed.inner, "outer": speed.outer}
    load = frames.get(load_fixed_to, jnp.zeros_like(speed.inner))
    against = jnp.stack([speed.outer, speed.inner]) != load
    return jnp.where(jnp.any(against), jnp.where(against, 1.0, 0.0), usual)


def seat_warnings(
    mounted: FitState,
    operating: FitState,
    loosest: FitState | None = None,
    *,
    speed: Speed | None = None,
    load_fixed_to: str = "space",
) -> list[Warning]:
    """Warnings about the seats of a bearing.

    A ring that turns against the load creeps on a seat without interference, and wears
    it; one against which the load stands still may be loose.

    Args:
        mounted: State mounted, at rest, at the temperature of the measured sizes;
            concrete, as all states.
        operating: State in operation.
        loosest: State in operation, at the sizes with the largest clearance; `None`:
            not checked.
        speed: Speeds of the rings; `None`: at rest, where nothing creeps.
        load_fixed_to: As in `LifeConditions`.

    Source: rule of catalogues of rolling bearings: rotating load, tight fit.
    """
    found = []
    for when, state in (("mounted", mounted), ("in operation", operating)):
        stress = float(state.ring_stress)
        if stress > MOST_STRESS:
            words = (
                f"fit: the hoop stress of the inner ring is {1e-6 * stress:.4g} MPa"
                f" {when}, above {1e-6 * MOST_STRESS:g} MPa, which bearing steel bears"
                " for long"
            )
            about = stress, MOST_STRESS, "inner ring"
            found.append(Warning("hoop_stress", words, *about))
            break
    turning = (False, False)
    if speed is not None and float(speed.inner) != float(speed.outer):
        turning = np.asarray(turns_against_load(speed, load_fixed_to)) > 0
    for (seat, ring), turns in zip(_SEATS.items(), turning, strict=True):
        before, after, left = (
            x if abs(x) > _EXACT else 0.0
            for state in (mounted, operating, loosest or operating)
            for x in [float(getattr(state, f"{seat}_interference"))]
        )
        kind, words, lost = "", "", abs(after)
        loose = f"is loose by {1e6 * lost:.3g} µm" if lost else "has no interference"
        if turns and after <= 0.0:
            once = ", though tight when mounted" if before > 0.0 else ""
            kind = "creeping_ring"
            words = f"turns against the load and {loose} in operation{once}"
            words += ": it creeps and wears its seat"
        elif before > 0.0 >= after:
            kind = "loose_ring"
            words = (
                f"is tight when mounted, but {loose} in operation: its seat has no"
                " pressure"
            )
        elif (turns or seat == "shaft") and left <= 0.0 < after:
            lost = abs(left)
            kind = "loose_within_tolerances"
            words = (
                f"is loose in operation, by {1e6 * lost:.3g} µm, at the loosest sizes"
                " of the tolerances"
            )
        if kind:
            found.append(Warning(kind, f"fit: {ring} {words}", lost, 0.0, seat))
    return found


def speed_warnings(
    turns: Any,
    *,
    limiting_speed: Any = None,
    reference_speed: Any = None,
) -> list[Warning]:
    """Warnings about a speed beyond those that a catalogue names.

    Args:
        turns: Speed of one ring against the other, of one or many cases [rad/s].
        limiting_speed: Speed limit of the maker's standard bearing [rad/s].
        reference_speed: At which it warms by the 50 K of the reference [rad/s].

    Source: ISO 15312 of the reference speed.
    """
    size, found = np.abs(np.asarray(turns)), []
    for kind, limit, words in (
        (
            "limiting_speed",
            limiting_speed,
            "the limiting speed of the catalogue, {} rpm: cage, accuracy and"
            " lubrication for it are needed",
        ),
        (
            "reference_speed",
            reference_speed,
            "the reference speed of the catalogue, {} rpm: without cooling it runs"
            " warmer than the 70 °C of ISO 15312, or its load must be less",
        ),
    ):
        if limit is None:
            continue
        most, limit = float(size.max()), float(limit)
        above = size > limit * (1.0 + 1e-9)  # by more than round-off
        if not above.any():
            continue
        top, allowed = (f"{x * 30 / np.pi:.5g}" for x in (most, limit))
        words = f"speed of {top} rpm, above {words.format(allowed)}"
        one = Warning(kind, words, most, limit)
        if above.ndim:
            one = in_cases(one, int(above.sum()), above.size, int(np.argmax(size)))
        found.append(one)
    return found


def preload_warnings(found: SetPreload) -> list[Warning]:
    """Warnings about the preload of a set on its seats.

    Args:
        found: From `Installed.set_preload`.
    """
    ground, operating = found.ground, found.operating
    least, most = found.operating_range or (operating, operating)
    ends = ""
    if found.operating_range is not None:
        ends = f" ({shown_preload(least)} to {shown_preload(most)} over the tolerances)"
    if operating == 0.0 < ground:
        words = (
            f"preload: the set, ground to {shown_preload(ground)}, has none left in"
            f" operation{ends}: fits, warmth and speed take it"
        )
        return [Warning("lost_preload", words, operating)]
    if ground > 0.0 and not 1.0 / MOST_CHANGE < operating / ground < MOST_CHANGE:
        words = (
            f"preload: {shown_preload(ground)} as ground are {shown_preload(operating)}"
            f" in operation{ends}, by fits, warmth and speed"
        )
        return [Warning("changed_preload", words, operating)]
    if least == 0.0 < ground:
        words = (
            "preload: at the loosest sizes of the tolerances the set has none left in"
            " operation"
        )
        return [Warning("lost_preload", words, least, where="loosest sizes")]
    return []


def preload_range_warnings(ground: float, least: float, most: float) -> list[Warning]:
    """Warnings about the preload of a set over many cases.

    Args:
        ground: Preload as ground, before mounting [N].
        least, most: Preload in operation, over the cases [N].
    """
    if least == 0.0:
        words = (
            f"preload: the set, ground to {shown_preload(ground)}, has none left in"
            " operation in some of the cases"
        )
        return [Warning("lost_preload", words, least)]
    if ground / MOST_CHANGE < least and most < MOST_CHANGE * ground:
        return []
    ends = " to ".join(dict.fromkeys(map(shown_preload, (least, most))))
    words = (
        f"preload: {shown_preload(ground)} as ground are {ends} in operation over the"
        " cases, by fits, warmth and speed"
    )
    return [Warning("changed_preload", words, most)]


def shown_preload(force: float) -> str:
    """Preload in words; NaN where the set has no equilibrium, or no contact angle.

    Args:
        force: Preload force [N].
    """
    return f"{force:.4g} N" if np.isfinite(force) else "not possible"

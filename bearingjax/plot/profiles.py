"""Profiles of rollers and raceways."""

import jax.numpy as jnp
import numpy as np

from ..design import AbstractRollerBearing
from ..design.profile import between_arcs, drops
from .panel import ALONG, finish
from .style import COLOURS, ROLLER, SMALL, Ax, Axes, axes_or_new


def drop_along(
    bearing: AbstractRollerBearing, name: str, points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions along a roller, and the drop of a profile there (point,) [m].

    Args:
        bearing: The design.
        name: Field with the profile.
        points: Their number; they gather at the ends, where profiles are steep.
    """
    length, turn = bearing.roller_length, np.linspace(0.0, np.pi, points)
    along = -0.5 * float(length) * np.cos(turn)
    there, diameter = jnp.asarray(along, length.dtype), bearing.roller_diameter
    return along, np.asarray(drops(getattr(bearing, name), there, length, diameter))


def profile(bearing: AbstractRollerBearing, ax: Ax = None) -> Axes:
    """Plot the drop [µm] of the roller and of both raceways along the roller.

    The drop points downwards, as the material falls away. Profiles that grow without
    limit at their very end are cut there. Of barrel rollers the profile of the roller
    is measured from its arc, those of the raceways from the same arc.
    """
    ax = axes_or_new(ax)
    x = 1e3 * drop_along(bearing, "roller_profile", 801)[0]
    near_end = np.abs(x) <= 0.95 * x[-1]
    lines = {
        "roller": (ROLLER, "-", 2.0),
        "outer raceway": (COLOURS["outer"], "--", 1.8),
        "inner raceway": (COLOURS["inner"], ":", 2.4),
    }
    limit, barrel = 0.0, bearing.arc_radii is not None
    flatter = 1e6 * np.concatenate([[0.0 * x], arc_gaps(bearing, 1e-3 * x)])
    for k, (name, (colour, style, width)) in enumerate(lines.items()):
        field = f"{name.replace(' ', '_')}_profile"
        drop = 1e6 * drop_along(bearing, field, 801)[1] + flatter[k]
        ax.plot(x, drop, color=colour, linestyle=style, linewidth=width, label=name)
        full = float(np.max(drop, initial=0.0, where=np.isfinite(drop)))
        inside = float(np.max(drop[near_end], initial=0.0))
        limit = max(limit, min(full, 3.0 * inside) if inside > 0 else full)
    limit = limit or 1.0
    ax.set_ylim(1.1 * limit, -0.1 * limit)
    ax.set_xlim(x[0], x[-1])
    title = "Profiles, from the roller's arc" if barrel else "Profiles"
    finish(ax, title, ALONG.label, "drop [µm]")
    ax.legend(fontsize=SMALL, loc="lower center")
    return ax


def arc_gaps(bearing: AbstractRollerBearing, position: np.ndarray) -> np.ndarray:
    """Return the gaps that the arcs of roller and raceways leave along the roller.

    Args:
        bearing: The design.
        position: Positions along the roller (point,) [m].

    Returns:
        At outer and inner raceway (2, point) [m]; zero without arcs.
    """
    if bearing.arc_radii is None:
        return np.zeros((2, len(position)))
    own, *raceways = bearing.arc_radii
    there = jnp.asarray(position, own.dtype)
    return np.stack([between_arcs(there, (own, radius)) for radius in raceways])

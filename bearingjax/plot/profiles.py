"""Profiles of rollers and raceways."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..design import AbstractRollerBearing
from ..design.profile import between_arcs, drops
from .panel import ALONG, finish
from .style import COLOURS, ROLLER, SMALL, Ax, Axes, axes_or_new


def profile(bearing: AbstractRollerBearing, ax: Ax = None) -> Axes:
    """Plot the drop [µm] of the roller and of both raceways along the roller.

    The drop points downwards, as the material falls away. Profiles that grow without
    limit at their very end are cut there. Of barrel rollers the profile of the roller
    is measured from its arc, those of the raceways from the same arc.
    """
    ax = axes_or_new(ax)
    length, diameter = bearing.roller_length, bearing.roller_diameter
    # Points gather at the ends, where profiles are steep.
    turn = np.linspace(0.0, np.pi, 801)
    along = -0.5 * float(length) * np.cos(turn)
    position, x = jnp.asarray(along, length.dtype), 1e3 * along
    near_end = np.abs(x) <= 0.95 * x[-1]
    lines = {
        "roller": (bearing.roller_profile, ROLLER, "-", 2.0),
        "outer raceway": (bearing.outer_raceway_profile, COLOURS["outer"], "--", 1.8),
        "inner raceway": (bearing.inner_raceway_profile, COLOURS["inner"], ":", 2.4),
    }
    limit, barrel = 0.0, bearing.arc_radii is not None
    flatter = 1e6 * np.concatenate([[0.0 * x], arc_gaps(bearing, position)])
    for k, (name, (shape, colour, style, width)) in enumerate(lines.items()):
        drop = 1e6 * np.asarray(drops(shape, position, length, diameter)) + flatter[k]
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


def arc_gaps(bearing: AbstractRollerBearing, position: Array) -> np.ndarray:
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
    return np.stack([between_arcs(position, (own, radius)) for radius in raceways])

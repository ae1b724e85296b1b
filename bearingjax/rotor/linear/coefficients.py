"""Stiffness over rotor speed, for programs of linear rotordynamics."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.checks import finite, is_traced, of_shape, one_of, real_numbers
from ...element import FREEDOMS, LOADS, RINGS, BearingElement, Speed
from ...element.bearing_element import check_element
from ...numerics import Result, Warning, as_real
from ...numerics.compiled.programs import program
from ...numerics.result import raise_unless_converged
from ...statics import OperatingPoint, Support, linearise, restrained_freedoms
from ...statics.warning_sizes import SOFTEST_SHIFT, stiffness_scale
from .modes import speed_list

TILTS = ("held", "free")


def stiffness_table(
    element: BearingElement,
    speeds: Any,
    load: Any,
    *,
    tilts: str = "held",
    fixed_ring: str = "outer",
) -> Float[Array, "speed 3 3"]:
    """Return the stiffness of the moving ring in x, y and z at each rotor speed.

    At every speed the bearing is linearised at its equilibrium under the load, with the
    inertia of its rolling elements. The other ring is at rest; the rolling elements are
    at `first_azimuth`.

    Args:
        element: The bearing.
        speeds: Speeds of the moving ring, positive from x towards y (speed,) [rad/s].
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring [N, N m], one for all
            speeds (6,) or one for each (speed, 6).
        tilts: "held": the moving ring does not tilt, as on a stiff shaft: the block
            of the full stiffness. "free": its tilts balance the moments of the load
            and follow (condensed), as on a slender shaft that holds no moment.
        fixed_ring: "outer" or "inner".

    Returns:
        d(Fx, Fy, Fz)/d(ux, uy, uz) (speed, 3, 3) [N/m], differentiable with respect
        to design, speeds and load. uz stays zero where the bearing cannot hold it.
        `stiffness_warnings` says if nothing holds a direction at some speed, as without
        load.

    Raises:
        ValueError: For wrong shapes, names or non-finite numbers, or moments about
            tilts that are held.
        SolveError: If a solve fails; the message names the first such speed.
    """
    speeds, load = _check(element, speeds, load, tilts, fixed_ring)
    stiffness, result = _sweep(element, speeds, load, tilts, fixed_ring)

    def first_failure():
        index = int(jnp.argmax(result != Result.CONVERGED))
        # Solved once more: the sweep keeps no more than it returns.
        point = _point(element, speeds[index], load[index], tilts, fixed_ring)
        return (
            f"stiffness_table: speed {float(speeds[index]):g} rad/s:"
            f" {Result(int(result[index])).label}:"
            f" {point.solution.failure_message}"
        )

    return raise_unless_converged(stiffness, result, first_failure, "stiffness_table")


def stiffness_warnings(
    element: BearingElement, speeds: Any, stiffness: Any
) -> list[Warning]:
    """Return a warning where the ring has no stiffness: it is useless further on.

    Args:
        element: The bearing, concrete.
        speeds: Speeds of the moving ring (speed,) [rad/s].
        stiffness: From `stiffness_table` (speed, 3, 3) [N/m].
    """
    nothing = SOFTEST_SHIFT * float(stiffness_scale(element.bearing))
    own = np.diagonal(np.asarray(stiffness), axis1=1, axis2=2)
    held = [name in restrained_freedoms(element.bearing) for name in FREEDOMS[:3]]
    slack = (own <= nothing) & np.array(held)
    if not slack.any():
        return []
    index = int(slack.any(axis=1).argmax())
    names = [FREEDOMS[k] for k in np.flatnonzero(slack[index])]
    words = (
        f"stiffness_table: no stiffness in {', '.join(names)} at"
        f" {float(speeds[index]):g} rad/s: nothing holds the ring there; give the load"
        " that it runs with"
    )
    size = float(own[index, slack[index]].min())
    return [Warning("no_stiffness", words, size, nothing, ", ".join(names))]


@program(quick=True)
def _sweep(element, speeds, load, tilts, fixed_ring):
    """Return stiffness (speed, 3, 3) and result code (speed,)."""

    def coefficients_at(speed, load):
        point = _point(element, speed, load, tilts, fixed_ring)
        return point.condense(), point.solution.result

    return jax.vmap(coefficients_at)(speeds, load)


def _point(element, speed, load, tilts, fixed_ring) -> OperatingPoint:
    held = {"gx": 0.0, "gy": 0.0} if tilts == "held" else None
    support = Support(prescribed=held, fixed_ring=fixed_ring)
    turning = Speed(**{support.moving_ring: speed})
    return linearise(element, load, speed=turning, support=support, throw=False)


def _check(element, speeds, load, tilts, fixed_ring):
    """Return checked speeds (speed,) and loads (speed, 6)."""
    name = "stiffness_table"
    one_of(name, "fixed_ring", fixed_ring, RINGS, "'outer' or 'inner'")
    one_of(name, "tilts", tilts, TILTS, " or ".join(map(repr, TILTS)))
    check_element(name, element)
    for what, value in (("speeds", speeds), ("load", load)):
        real_numbers(name, what, value, "numbers (units belong in scene files)")
    speeds, load = speed_list(name, speeds), as_real(load)
    allowed = f"(6,) or {(*speeds.shape, 6)}: {' '.join(LOADS)}, in N and N m"
    fits = load.shape in ((6,), (*speeds.shape, 6))
    of_shape(name, "load", fits, allowed, load)
    finite(name, "load", load, "N, N m")
    if not is_traced(load):
        moments = load[..., 3:5]
        if tilts == "held" and bool(jnp.any(moments != 0)):
            raise ValueError(
                f"{name}: `load` has Mx or My, but the tilts are held, whose moments"
                " are results; take tilts='free', or no moments."
            )
    return speeds, jnp.broadcast_to(load, (*speeds.shape, 6))

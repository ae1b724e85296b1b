"""Preload by force: the ring offsets that give a set an axial preload, and the preload
that remains."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp

from ..design import AbstractBearing, BearingSet, SetRow, rows_of
from ..design.bearing_set import is_self_aligning
from ..design.checks import positive
from ..element.bearing_element import BearingElement, check_element
from ..element.inertia import Speed
from ..numerics.types import Number, Scalar, as_real
from ..numerics.units import unit
from .load import solve_load
from .solution import Solution
from .support import Support, restrained_freedoms


class SetPreload(NamedTuple):
    """Axial preload force between the rows of a set, without external load [N].

    Attributes:
        ground: As ground, before mounting [N].
        mounted: When mounted, at rest, at the reference temperature [N].
        operating: In operation [N].
        mounted_range: Mounted, at the loosest and the tightest sizes of shaft, housing
            and rings; `None` where all sizes are exact. NaN: with that fit the balls
            have no contact angle, or no equilibrium was found [N].
        operating_range: In operation at the loosest and the tightest sizes [N].
    """

    ground: Annotated[float, unit("N")]
    mounted: Annotated[float, unit("N")]
    operating: Annotated[float, unit("N")]
    mounted_range: Annotated[tuple[float, float] | None, unit("N")]
    operating_range: Annotated[tuple[float, float] | None, unit("N")]


def preload(
    element: BearingElement[Any], force: Number, *, throw: bool = True
) -> BearingElement[Any]:
    """Return the set with its rings ground so that its rows have a given preload.

    With the rings coaxial, at rest and unloaded, the rows that carry load along +z bear
    `force` together, and so do those that carry load along -z. Rows of the same side
    move together: the differences between their values of `inner_offset` stay.

    Args:
        element: A set with rows of both sides.
        force: Axial preload [N].
        throw: Raise if a solve fails; otherwise the offsets are then NaN.

    Returns:
        Element with new `inner_offset` (of a pair plus and minus half of the total
        that is ground off), differentiable with respect to design and force (implicit
        function theorem).

    Raises:
        TypeError: If `element` is no BearingElement.
        ValueError: As `check_preload`.
        SolveError: If a solve fails and `throw` is set.
    """
    check_element("preload", element)
    bearing = element.bearing
    check_preload(bearing, force)
    offsets = {}
    for side in (False, True):
        sign = -1.0 if side else 1.0
        mine = [row for row in bearing.rows if row.mirrored is side]
        # In the rows' own axes, side by side: coaxial rings, so the place is no matter.
        rows = [
            SetRow(
                r.bearing,
                k * r.bearing.pitch_diameter,
                inner_offset=sign * r.inner_offset,
            )
            for k, r in enumerate(mine)
        ]
        group = BearingSet(tuple(rows))
        alone = eqx.tree_at(lambda e: e.bearing, element, group)
        load = jnp.zeros(6, bearing.rows[0].position.dtype).at[2].set(force)
        solution = solve_load(alone, load, support=Support(free=["uz"]), throw=throw)
        travel = jnp.where(solution.converged, solution.displacement[8], jnp.nan)
        offsets[side] = sign * travel

    def row_offset(row):
        return row.inner_offset + offsets[row.mirrored]

    return eqx.tree_at(
        lambda e: [r.inner_offset for r in e.bearing.rows],
        element,
        [row_offset(row) for row in bearing.rows],
    )


def remaining_preload(
    element: BearingElement[Any], speed: Speed | None = None, *, throw: bool = True
) -> Scalar:
    """Axial force with which the rows of a set press each other, unloaded [N].

    Of a set as it is: ground, or mounted and warm. Its rings are coaxial, and its inner
    rings stand where the rows of both sides press alike; 0 where there is play.

    Args:
        element: A set with rows of both sides.
        speed: Speeds of the rings, which moves balls outwards; `None`: at rest.
        throw: Raise if the solve fails; otherwise the force is then NaN.

    Returns:
        Sum of the loads of the rows that carry load along +z, on their inner rings;
        differentiable.

    Raises:
        TypeError: If `element` is no BearingElement.
        ValueError: As `check_opposed`.
        SolveError: If the solve fails and `throw` is set.
    """
    check_element("remaining_preload", element)
    bearing = element.bearing
    check_opposed("remaining_preload", bearing)
    still = jnp.zeros(6, bearing.rows[0].position.dtype)
    solution = solve_load(
        element, still, support=Support(free=["uz"]), speed=speed, throw=throw
    )
    return row_preload_force(solution)


def row_preload_force(solution: Solution) -> Scalar:
    """Axial force on the inner rings of the rows that carry load along +z [N].

    Args:
        solution: Solution of a set with rows of both sides.

    Returns:
        The force [N], NaN if the solve did not converge.
    """
    element, rows = solution.element, solution.element.bearing.rows
    mine = BearingSet(tuple(row for row in rows if not row.mirrored))
    alone = eqx.tree_at(lambda e: e.bearing, element, mine)
    force = alone.force(solution.displacement, solution.speed)[8]
    return jnp.where(solution.converged, force, jnp.nan)


def check_preload(bearing: AbstractBearing | BearingSet, force: Number) -> None:
    """Raise unless `preload` can preload this bearing.

    Args:
        bearing: The design.
        force: Axial preload [N].

    Raises:
        TypeError: If the force is no number.
        ValueError: If it is no set, no two rows face each other, the rows share one
            inner ring, a row holds no axial load or has a spring, or the force is not
            positive.
    """
    check_opposed("preload", bearing)
    if any(row.spring is not None for row in rows_of(bearing)):
        raise ValueError(
            "preload: `force` is given, and a spring presses a row already."
        )
    positive("preload", "force", as_real(force), "N")


def check_opposed(owner: str, bearing: AbstractBearing | BearingSet) -> None:
    """Raise unless rows of a set can press each other along the axis.

    Raises:
        ValueError: If `is_opposed` is false, with the reason.
    """
    problem = _not_opposed(bearing)
    if problem:
        raise ValueError(f"{owner}: {problem}.")


def is_opposed(bearing: AbstractBearing | BearingSet) -> bool:
    """Whether a bearing is a set whose rows press each other along the axis."""
    return _not_opposed(bearing) is None


def _not_opposed(bearing) -> str | None:
    if not isinstance(bearing, BearingSet):
        return "a bearing alone is preloaded by its clearance or by a load"
    if {row.mirrored for row in bearing.rows} != {False, True}:
        return "no rows face each other"
    if is_self_aligning(bearing):
        return "the rows of a self-aligning bearing share one inner ring"
    if any("uz" not in restrained_freedoms(row.bearing) for row in bearing.rows):
        return "a row holds no axial load"
    return None

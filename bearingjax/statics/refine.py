"""One roller of a solved bearing, its contact with a raceway cell by cell."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from ..contact import AbstractLineContact, peak_pressure
from ..contact.halfspace import (
    AbstractPressureSolver,
    FreeEnds,
    Grid,
    RollerContact,
)
from ..contact.slices import SliceComparison, Slices
from ..design import AbstractRollerBearing, rows_of
from ..design.checks import one_of
from ..element import RINGS, BearingElement, RowResults
from ..element.bearing_element import check_element
from ..element.constants import relative_radii
from ..numerics.types import Scalar, as_real
from .rollers import approaches, contact_loads
from .solution import RollerSolution, Solution

_SAME = 1e-4
"""Largest relative difference between the load of a roller in the solution and the same
load solved again here; it allows for single precision."""


class RefinedContact(SliceComparison):
    """Contact of a roller on the half-space, compared with the slices of the bearing.

    y runs along the generatrix as the `position` of a `RollerSolution` does, also in
    the mirrored rows of a set: from the large end of a taper to its small end.

    Attributes:
        contact: Roller and raceway.
        roller: Which rolling element.
        raceway: "outer" or "inner".

    Static: roller, raceway.
    """

    contact: RollerContact
    roller: int = eqx.field(static=True)
    raceway: str = eqx.field(static=True)


def refine(
    element: BearingElement,
    solution: Solution,
    roller: int | None = None,
    raceway: str = "inner",
    *,
    free_ends: FreeEnds | None = None,
    grid: Grid | None = None,
    solver: AbstractPressureSolver | None = None,
    throw: bool = True,
) -> RefinedContact:
    """Contact of one roller of a solved bearing, both bodies elastic half-spaces.

    Load and tilt are those of the solution, which works with slices. The half-space
    gives the pressure under them, roller ends included, and its own approach.

    Args:
        element: The bearing that was solved.
        solution: Its solution, a single one.
        roller: Which rolling element, of a set counted row by row; default: that with
            the largest load on the raceway.
        raceway: "inner" or "outer".
        free_ends: As in `RollerContact`.
        grid: The cells; `None`: 35 by 64, graded, of a width found by coarse solves,
            which takes concrete numbers.
        solver: As in `solve_pressure`.
        throw: Whether to raise if it does not converge.

    Returns:
        RefinedContact: pressure field, edge factor against the slices.

    Raises:
        TypeError: For balls.
        ValueError: For an unknown roller or raceway, a solution that did not converge
            or is not that of the element, or a roller that is not loaded
            there.
        SolveError: If `throw` and it did not converge.

    Fails: as `solve_pressure`.
    """
    check_element("refine", element)
    if not isinstance(solution, RollerSolution):
        raise TypeError("refine: the bearing has balls; it takes one with rollers.")
    one_of("refine", "raceway", raceway, RINGS, "'outer' or 'inner'")
    if jnp.ndim(solution.result) or not bool(solution.converged):
        raise ValueError("refine: `solution` must be a single one that converged.")
    ring = RINGS.index(raceway)
    loads = solution.roller_load[:, ring]
    if roller is None:
        roller = int(jnp.argmax(loads))
    count = loads.shape[0]
    if not 0 <= roller < count:
        raise ValueError(
            f"refine: `roller` is {roller}; it must be from 0 to {count - 1}."
        )
    # More than round-off.
    if not float(loads[roller]) > 1e-9 * float(jnp.max(solution.roller_load)):
        raise ValueError(
            f"refine: roller {roller} bears no load on the {raceway} raceway."
        )
    row, bearing, place = _row_of(element, solution, roller)
    again = float(contact_loads(row)[0][place, ring])
    if not abs(again - float(loads[roller])) <= _SAME * float(loads[roller]):
        raise ValueError(
            f"refine: roller {roller} bears {float(loads[roller]):.5g} N in `solution`,"
            f" and {again:.5g} N in `element` where its rings are there: give the"
            " element that was solved."
        )
    a, b = approaches(row)[place, ring]
    contact = roller_contact(row, bearing, ring, free_ends)
    tilt = 2.0 * b / contact.roller_length
    solved = contact.solve(
        loads[roller], tilt=tilt, grid=grid, solver=solver, throw=throw
    )
    sliced = _slices(row, ring, a, b, solved.grid.y)
    return RefinedContact(solved, sliced, contact, roller, raceway)


def roller_contact(
    row: RowResults,
    bearing: AbstractRollerBearing,
    ring: int,
    free_ends: FreeEnds | None = None,
) -> RollerContact:
    """Roller and raceway of a row as a contact of its own.

    Args:
        row: Solved rollers of one row.
        bearing: Its design.
        ring: 0: outer, 1: inner raceway.
        free_ends: As in `RollerContact`.
    """
    constants = row.element.constants
    half, sign = bearing.half_angle, 1.0 - 2.0 * ring
    zero = jnp.zeros((1,), constants.diameter.dtype)
    roller_radius = 0.5 * constants.diameter / jnp.cos(half)
    relative = relative_radii(constants, zero)[ring, 0]
    taper, arcs = bearing.roller_length * jnp.sin(half), bearing.arc_radii
    angle = bearing.axis_angle + sign * half
    raceway = 1.0 / (1.0 / relative - 1.0 / roller_radius)
    # A flat washer: a plane at any angle.
    flat = angle > 0.5 * np.pi - 1e-5
    profiles = (bearing.outer_raceway_profile, bearing.inner_raceway_profile)
    return RollerContact(
        bearing.roller_length,
        constants.diameter - taper,
        constants.diameter + taper,
        half_angle=half,
        raceway_radius=jnp.where(flat, jnp.inf, raceway),
        raceway_half_angle=jnp.where(flat, 0.0, angle),
        arc_radii=None if arcs is None else (arcs[0], arcs[1 + ring]),
        roller_profile=bearing.roller_profile,
        raceway_profile=profiles[ring],
        material=bearing.material,
        raceway_material=bearing.rings,
        free_ends=free_ends,
    )


def _row_of(element, solution, roller):
    """Solved row of a rolling element, design of the row, number within the row."""
    model = element.model(solution.speed)
    rows = model.results(solution.displacement, model.solve(solution.displacement))
    ends = np.cumsum(solution.row_sizes)
    k = int(np.searchsorted(ends, roller, side="right"))
    bearing: Any = rows_of(element.bearing)[k].bearing
    return rows[k], bearing, roller - int(ends[k] - solution.row_sizes[k])


def _slices(row, ring, a, b, y) -> Slices:
    """Load and pressure of the bearing's own slices at y."""
    constants = row.element.constants
    line: AbstractLineContact = constants.lines[ring]
    xi = y / constants.half_length
    load: Scalar = line.load_along(constants.tables[ring], xi, a, b)
    radius = relative_radii(constants, y)[ring]
    pressure = peak_pressure(load, radius, constants.modulus)
    return Slices(as_real(a), load, pressure)

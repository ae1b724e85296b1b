"""Loads of laminae from the pressures of half-spaces, for the rating life."""

from typing import Annotated, NamedTuple

import numpy as np

from ..contact.halfspace import Grid
from ..element import RINGS, BearingElement
from ..numerics.units import unit
from ..numerics.warning import Warning
from ..statics import RefinedContact, RollerSolution, refine
from .reference_life import LEAST_LAMINAE, ROLLERS


class LaminaLoads(NamedTuple):
    """Loads of laminae from the pressures of half-spaces.

    Attributes:
        load: Load of each lamina on both raceways (roller, raceway, lamina) [N].
        warnings: A warning if the pressure is largest at the ends of contacts.
    """

    load: Annotated[np.ndarray, unit("N")]
    warnings: tuple[Warning, ...] = ()


def refined_lamina_loads(
    element: BearingElement,
    solution: RollerSolution,
    n_laminae: int = 50,
    *,
    grid: Grid | None = None,
) -> LaminaLoads:
    """Loads of laminae whose Hertz pressure is that of half-spaces, ends included.

    For `rating_life(..., lamina_load=found.load)` in place of the standard's
    concentration of stress at the ends. Every loaded roller is solved on both raceways
    (`refine`), so that it takes seconds; it is not differentiable.

    Args:
        element: The bearing that was solved.
        solution: Its solution, a single one that converged.
        n_laminae: Laminae of a roller, at least 30.
        grid: As in `refine`.

    Returns:
        LaminaLoads; a load is π ρ p²/E* of the largest pressure p across the contact
        times the length of a lamina, ρ the relative radius; within a lamina the mean
        of the power by which it tires.

    Raises:
        TypeError, ValueError, SolveError: As `refine`; too few laminae.

    Valid:  ends that carry no load or run out smoothly, as logarithmic profiles do (a
        life within 3 % of that with `edge_stress`). At a sharp end under load the
        pressure of half-spaces is infinite: the life then falls with ever finer cells,
        by orders of magnitude, and its `warnings` say so.
    Source: Hertz's line contact; the stress that tires is that of the pressure.
    """
    if n_laminae < LEAST_LAMINAE:
        raise ValueError(
            f"refined_lamina_loads: `n_laminae` is {n_laminae}; it must be at least"
            f" {LEAST_LAMINAE}."
        )
    loads = np.asarray(solution.roller_load)
    found = np.zeros((*loads.shape, n_laminae))
    sharp = []
    for roller, ring in zip(*np.nonzero(loads > 1e-9 * loads.max()), strict=True):
        contact = refine(element, solution, int(roller), RINGS[ring], grid=grid)
        found[roller, ring] = _of_laminae(contact, n_laminae)
        if _peaks_at_an_end(contact):
            sharp.append(f"roller {roller} on the {RINGS[ring]} raceway")
    if not sharp:
        return LaminaLoads(found)
    words = (
        f"refined_lamina_loads: the pressure is largest at the ends of {len(sharp)}"
        f" contacts, such as that of {sharp[0]}. At a sharp end it has no limit: it"
        " grows, and the life falls, with ever finer cells. Give the rollers a profile"
        " that runs out, or use the laminae of the solution."
    )
    one = Warning("sharp_ends", words, float(len(sharp)), 0.0, "; ".join(sharp))
    return LaminaLoads(found, (one,))


def _peaks_at_an_end(found: RefinedContact) -> bool:
    along = np.asarray(found.solution.pressure).max(axis=0)
    return along.argmax() in (0, along.size - 1)


def _of_laminae(found: RefinedContact, count: int) -> np.ndarray:
    y = np.asarray(found.solution.grid.y)
    pressure = np.asarray(found.solution.pressure).max(axis=0)
    radius = np.asarray(found.contact.relative_radius(found.solution.grid.y))
    line = np.pi * radius * pressure**2 / float(found.contact.modulus)
    length = float(found.contact.roller_length)
    # Each cell reaches half-way to its neighbours, those at the ends to the ends.
    cells = np.concatenate([[-0.5 * length], 0.5 * (y[1:] + y[:-1]), [0.5 * length]])
    n, d = ROLLERS.share
    tired = np.concatenate([[0.0], np.cumsum(line ** (n / d) * np.diff(cells))])
    edges = length * (np.arange(count + 1) / count - 0.5)
    mean = np.diff(np.interp(edges, cells, tired)) * count / length
    return mean ** (d / n) * length / count

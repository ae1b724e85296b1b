"""Running a scene of one contact: all its loads in one call."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..contact.halfspace import ConjugateGradients, ContactSolution
from ..contact.slices import Slices, slices
from .contact_table import ContactScene


@dataclasses.dataclass(frozen=True)
class ContactCase:
    """One solved load of a scene.

    Attributes:
        solution: Read its result code.
        slices: What independent slices give under the same load and tilt.
    """

    solution: ContactSolution
    slices: Slices

    @property
    def half_width(self) -> np.ndarray:
        """Half width of the contact along the roller (n,) [m].

        Hertz's pressure squared is linear in x²: where that line through the two
        outermost cells in contact meets zero, within a cell.
        """
        grid = self.solution.grid
        pressure = np.asarray(self.solution.pressure)
        x, cell = np.asarray(grid.x), 2.0 * float(grid.half_x)
        count, columns = (pressure > 0).sum(axis=0), np.arange(pressure.shape[1])
        last = np.maximum(count - 1, 0)
        before = np.maximum(last - 1, 0)
        outer, inner = pressure[last, columns] ** 2, pressure[before, columns] ** 2
        fall = np.where(inner > outer, inner - outer, np.inf)
        square = x[last] ** 2 + outer * (x[last] ** 2 - x[before] ** 2) / fall
        found = np.where(count > 1, np.sqrt(square), x[last] + 0.5 * cell)
        limited = np.clip(found, x[last], x[last] + cell)
        return np.where(count > 0, limited, 0.0)

    @property
    def peak(self) -> int:
        """Place along the roller of the cell with the largest pressure."""
        pressure = np.asarray(self.solution.pressure)
        return int(np.argmax(pressure.max(axis=0)))

    @property
    def edge_factor(self) -> float:
        """Largest pressure over that of the slices [1]."""
        return float(self.solution.peak_pressure / self.slices.peak_pressure)

    @property
    def touches(self) -> bool:
        """Whether there is a contact."""
        return bool(np.asarray(self.solution.pressure).any())


def run_contact(scene: ContactScene) -> list[ContactCase]:
    """Solve the contact of a scene for each of its loads.

    Args:
        scene: From `read_contact`.

    Returns:
        A case for each load, in order; nothing is raised for a failed solve.

    Fails: as `solve_pressure`.
    """
    contact, cases = scene.contact, scene.cases
    widths = [
        contact._half_width(case) if scene.half_width is None else scene.half_width
        for case in cases
    ]
    given = {name: jnp.asarray([case[name] for case in cases]) for name in cases[0]}
    solver = ConjugateGradients(scene.tolerance, scene.max_steps)
    sizes = (scene.across, scene.along, scene.grading)
    solved = _solved(contact, jnp.asarray(widths), given, solver, sizes)
    sliced = _sliced(contact, solved, scene.law)
    return [ContactCase(_one(solved, k), _one(sliced, k)) for k in range(len(cases))]


@eqx.filter_jit
def _solved(contact, widths, given, solver, sizes):
    def solve(width, case):
        grid = contact.grid(width, *sizes)
        return contact.solve(**case, grid=grid, solver=solver, throw=False)

    return jax.vmap(solve)(widths, given)


@eqx.filter_jit
def _sliced(contact, solved, law):
    def slice_(one):
        return slices(contact, one.load, one.tilt, one.grid.y, law)

    return eqx.filter_vmap(slice_)(solved)


def _one(tree: Any, k: int) -> Any:
    return jax.tree.map(lambda leaf: leaf[k], tree)

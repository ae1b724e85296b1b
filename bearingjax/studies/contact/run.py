"""Solve the scene of one contact, or one roller contact of a bearing's scene."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp

from ...contact.halfspace import ConjugateGradients, FreeEnds
from ...contact.line import Palmgren
from ...contact.slices import SliceComparison, slices
from ...element import RINGS
from ...files.quantity import SceneError
from ...files.scene_errors import problem_of
from ...files.schema import read_keys
from ...files.table import Table
from ...numerics.compiled.programs import program
from ...statics import Solution, refine
from ...statics.warning import solution_warnings
from ..bearing.read_scene import Scene
from .read import ContactNumericsKeys, ContactOperatingKeys, ContactScene


def run_contact(scene: ContactScene) -> list[SliceComparison]:
    """Solve the contact of a scene for each of its loads.

    Returns:
        A case for each load, in order; a failed solve does not raise.

    Fails: as `solve_pressure`.
    """
    contact, cases, asked = scene.contact, scene.cases, scene.numerics
    widths = [
        contact.grid_half_width(case) if asked.half_width is None else asked.half_width
        for case in cases
    ]
    given = {name: jnp.asarray([case[name] for case in cases]) for name in cases[0]}
    solver = ConjugateGradients(asked.tolerance, asked.max_steps)
    sizes = (asked.across, asked.along, asked.grading)
    solved = _solve(contact, jnp.asarray(widths), given, solver, sizes)
    sliced = _slice(contact, solved, scene.law)
    return [
        SliceComparison(_case(solved, k), _case(sliced, k)) for k in range(len(cases))
    ]


def run_refined(
    scene: Scene,
    solution: Solution,
    roller: int | None = None,
    raceway: str | None = None,
    free_ends: bool = False,
) -> tuple[ContactScene, list[SliceComparison]]:
    """Solve the contact of one roller of a bearing's scene, on the default grid.

    Args:
        scene: From `read_scene`.
        solution: From `run_scene`, converged.
        roller, raceway: As in `refine`; default: the inner raceway.
        free_ends: Whether the roller's end faces are free, modelled by `FreeEnds()`.

    Returns:
        The scene of that contact, and its single case.

    Raises:
        SceneError: For a bearing with balls, or an unknown or unloaded roller.

    Fails: as `solve_pressure`.
    """
    try:
        found = refine(
            solution.element,
            solution,
            roller,
            "inner" if raceway is None else raceway,
            free_ends=FreeEnds() if free_ends else None,
            throw=False,
        )
    except (TypeError, ValueError) as error:
        raise SceneError(f"{scene.name}: {problem_of(error)}") from error
    solved = found.solution
    across, along = solved.grid.n_across, solved.grid.shape[1]
    load = float(solution.roller_load[found.roller, RINGS.index(found.raceway)])
    table = Table({"across": across, "along": along}, scene.name)
    contact = ContactScene(
        name=f"{scene.name}, roller {found.roller}, {found.raceway} raceway",
        contact=found.contact,
        operating=ContactOperatingKeys(
            table=table, load=load, approach=None, moment=None, tilt=float(solved.tilt)
        ),
        numerics=read_keys(ContactNumericsKeys, table),
        law=scene.element.line_law or Palmgren(),
        warnings=(*scene.warnings, *solution_warnings(solution)),
        inputs=scene.inputs,
    )
    return contact, [found]


@program(quick=True)
def _solve(contact, widths, given, solver, sizes):
    def solve(width, case):
        grid = contact.grid(width, *sizes)
        return contact.solve(**case, grid=grid, solver=solver, throw=False)

    return jax.vmap(solve)(widths, given)


@program(quick=True)
def _slice(contact, solved, law):
    def slice_(one):
        return slices(contact, one.load, one.tilt, one.grid.y, law)

    return eqx.filter_vmap(slice_)(solved)


def _case(tree: Any, k: int) -> Any:
    return jax.tree.map(lambda leaf: leaf[k], tree)

"""Warnings about a solution: one list for the library and the command line."""

from typing import Any

import jax
import numpy as np

from ..design.checks import is_traced
from ..numerics.types import array_namespace
from ..numerics.warning import Warning, warnings_of_cases
from .solution import Solution
from .warning_kinds import SOLUTION_KINDS


def warnings(found: Any) -> list[Warning]:
    """Warnings about a solution, or those that another result or a design has.

    The command line prints the same list; of many cases see `Sweep.warnings`.

    Args:
        found: Solution, concrete; its warnings begin with those of its design. With a
            leading case axis, as `optimise` has it, each sentence says in how many
            cases. A case that did not converge gives no warnings. Or anything with
            `warnings` of its own: a bearing, an element, a disc, a rotor, its modes.

    Returns:
        `numerics.Warning`, each a sentence with its kind and size; empty if there are
        none.

    Raises:
        TypeError: For a solution under `jit`, `vmap` or `grad`.
    """
    if not isinstance(found, Solution):
        own: Any = found.warnings
        every: Any = own() if callable(own) else own
        return list(every)
    return [*found.element.warnings, *solution_warnings(found)]


def solution_warnings(solution: Solution) -> list[Warning]:
    """Warnings about a solution without those of its design.

    Args, raises: as `warnings`.
    """
    if any(is_traced(leaf) for leaf in jax.tree.leaves(solution)):
        raise TypeError(
            "warnings: the solution is traced; ask outside of jit, vmap and grad."
        )
    held = jax.tree.map(np.asarray, solution)
    if held.result.ndim:
        ones = [
            jax.tree.map(lambda leaf, k=k: leaf[k], held)
            for k in range(len(held.result))
        ]
        found = [sizes(one) for one in ones]
        warned = {name: np.array([f[name] for f in found]) for name in found[0]}
        return warnings_of_cases(warned, SOLUTION_KINDS)
    with np.errstate(all="ignore"):
        return [
            SOLUTION_KINDS[name].warning(
                name, float(size), SOLUTION_KINDS[name].where(held)
            )
            for name, size in sizes(held).items()
            if size > SOLUTION_KINDS[name].limit
        ]


def sizes(solution: Solution) -> dict[str, Any]:
    """Size of every kind of warning that can arise; NaN if the solve failed.

    Args:
        solution: Solution of one case, traced or not.
    """
    xp = array_namespace(solution.result)
    solved = solution.result == 0
    with np.errstate(all="ignore"):
        return {
            name: xp.where(solved, kind.size(solution), xp.nan)
            for name, kind in SOLUTION_KINDS.items()
            if kind.applies(solution.element, solution.speed)
        }

"""Warnings about a solution: one list for the library and the command line."""

from collections.abc import Mapping
from typing import Any

import jax
import numpy as np

from ..design.checks import is_traced
from ..numerics.types import array_namespace
from .solution import Solution
from .warning_kinds import KINDS


def warnings(solution: Solution) -> list[str]:
    """Warnings about a solution, a sentence each; empty if there are none.

    The command line prints the same list; of many cases see `Sweep.warnings`.

    Args:
        solution: Concrete; with a leading case axis, as `optimise` has it, each
            sentence says in how many cases. A case that did not converge gives no
            warnings.

    Raises:
        TypeError: For a solution under `jit`, `vmap` or `grad`.
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
        return sentences_of_cases(warned)
    out = []
    for name, size in sizes(held).items():
        kind = KINDS[name]
        if size > kind.limit:
            with np.errstate(all="ignore"):
                out.append(kind.words(float(size), kind.where(held)))
    return out


def loose(solution: Solution) -> str:
    """The warning that a free direction has no stiffness, or "".

    Args:
        solution: Concrete, of one case.
    """
    texts = [text for text in warnings(solution) if text.startswith("no stiffness")]
    return texts[0] if texts else ""


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
            for name, kind in KINDS.items()
            if kind.applies(solution.element, solution.speed)
        }


def exceeded_kinds(
    warned: Mapping[str, np.ndarray], kinds: Mapping[str, Any] = KINDS
) -> dict[str, np.ndarray]:
    """Whether each case has each kind, by name (case,); kinds without cases left out.

    Args:
        warned: Name -> size of the warning (case,), NaN where it does not apply.
        kinds: Kinds of warnings by name, in the order in which they are reported.

    Raises:
        KeyError: For a name that is not among the kinds: lives have kinds of their own
            (`life.life_warning.ALL`), and a warning must not be lost.
    """
    if unknown := sorted(set(warned) - set(kinds)):
        raise KeyError(f"no kind of warning is called {', '.join(unknown)}")
    over = {
        name: warned[name] > kind.limit
        for name, kind in kinds.items()
        if name in warned
    }
    for name in [name for name in over if kinds[name].of_all]:
        if (~over[name] & np.isfinite(warned[name])).any():
            del over[name]
    return {name: cases for name, cases in over.items() if cases.any()}


def sentences_of_cases(
    warned: Mapping[str, np.ndarray], kinds: Mapping[str, Any] = KINDS
) -> list[str]:
    """The sentences of many cases: each kind once, with its worst case.

    Args:
        warned: Size of each kind of warning by name (case,), NaN where it does not
            apply.
        kinds: Kinds of warnings by name, in the order in which they are reported.

    Raises:
        KeyError: For a name that is not among the kinds.
    """
    out = []
    for name, cases in exceeded_kinds(warned, kinds).items():
        worst = int(np.nanargmax(warned[name]))
        said = kinds[name].words(float(warned[name][worst]), "")
        out.append(
            f"{said}, in {int(cases.sum())} of {len(cases)} cases, worst case {worst}"
        )
    return out

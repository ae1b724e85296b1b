"""Outcome of a solved bearing, for `solve` and the commands based on it."""

from collections.abc import Callable
from typing import Any

from ..outcome import Outcome, picture


def solution_outcome(
    scene: Any,
    numbers: Callable | None = None,
    brief: Any = None,
    columns: Callable | None = None,
) -> Outcome:
    """Solve the bearing of a scene for its load.

    Args:
        scene: From `read_scene`.
        numbers: Returns the JSON of the solved scene; default: `solution_json`.
        brief: Sections of the report shown on the terminal; default: all.
        columns: Returns the table of the solved scene; default: `element_columns`.
    """
    from .output import element_columns, solution_json
    from .report import report
    from .run import solve_scene

    found = solve_scene(scene)
    solution = found.solution
    full_report = report(found) if found.converged else None

    # Mounted and preloaded if given in the scene.
    bearing = (solution if found.converged else scene).element.bearing
    draw = picture("overview", bearing, solution, scene.name, scene.entry)
    return Outcome(
        scene.name,
        scene.inputs,
        lambda: (numbers or solution_json)(found),
        full_report
        if brief is None or full_report is None
        else full_report.with_sections(brief),
        (lambda: (columns or element_columns)(found)) if found.converged else None,
        page=None if full_report is None else lambda: full_report,
        pictures={"Section, load zone, contacts": draw} if found.converged else {},
        drawing=picture("drawing", bearing, scene.name, scene.entry),
        problems=[] if found.converged else [why_unsolved(found)],
    )


def why_unsolved(found: Any) -> str:
    """Return the reason why a bearing was not solved.

    Args:
        found: From `solve_scene`, not converged.
    """
    from ...numerics import Result

    label = Result(int(found.solution.result)).label
    return f"{label}: {found.solution.failure_message}"

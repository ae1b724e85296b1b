"""`bearingjax solve` and `bearingjax compare`."""

from argparse import Namespace
from collections.abc import Callable
from typing import Any

from ..outcome import Outcome, Tools, picture
from ..status import complain


def run(options: Namespace, tools: Tools) -> Outcome:
    """Solve the bearing of a scene file and print a report."""
    from ...files.scene_file import has_cases
    from ..bearing.read_scene import read_scene

    scene = read_scene(options.scene, options.set)
    if has_cases(options.scene, options.set):
        complain("one load, that of [operating]; [cases] are for sweep, life, optimise")
    return solution_outcome(scene)


def compare(options: Namespace, tools: Tools) -> Outcome:
    """Solve the bearings of several scene files, each for its load, and set results and
    inputs that differ side by side, the largest differences first."""
    from ...files import SceneError
    from ..bearing.read_scene import read_scene
    from .compare import compare_as_dict, compare_columns, compare_report, run_compare

    if len(options.scenes) < 2:
        raise SceneError("compare: give two scenes or more")
    scenes = [read_scene(source, options.set) for source in options.scenes]
    found = run_compare(scenes)
    named = list(zip(found.names, found.solved, strict=True))
    some = any(one.converged for one in found.solved)
    return Outcome(
        ", ".join(found.names),
        {f"{name}: {k}": v for name, one in named for k, v in one.scene.inputs.items()},
        lambda: compare_as_dict(found),
        compare_report(found, options.set) if some else None,
        (lambda: compare_columns(found, options.si)) if some else None,
        problems=[
            f"{name}: {why_unsolved(one)}" for name, one in named if not one.converged
        ],
    )


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

"""What other programs read: a solution as JSON, in SI."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..numerics.result import Result
from ..statics.solution import Solution, message, warnings
from .read import Scene

ARRAYS = (
    "displacement",
    "force",
    "stiffness",
    "roller_load",
    "rib_load",
    "roller_motion",
    "azimuth",
    "position",
    "line_load",
    "contact_pressure",
)
"""Fields of the solution that are written, with their names."""


def as_dict(scene: Scene, solution: Solution) -> dict[str, Any]:
    """Solution of a scene as plain numbers and lists, in SI.

    Args:
        scene: What was solved.
        solution: Its solution.

    Returns:
        The fields of `ARRAYS` (m, rad, N, N m, Pa), and result, message, residual,
        iterations, warnings and version. If the solve did not converge the arrays are
        left out: there are no results.
    """
    from .. import __version__

    result = Result(int(solution.result))
    solved = result is Result.CONVERGED
    numbers = {name: np.asarray(getattr(solution, name)).tolist() for name in ARRAYS}
    residual = float(solution.stats.residual)
    return {
        **(numbers if solved else {}),
        "result": result.label,
        "message": message(solution, scene.moving_ring),
        "residual": residual if np.isfinite(residual) else None,
        "iterations": int(solution.stats.iterations),
        "warnings": [*scene.warnings, *(warnings(solution) if solved else [])],
        "version": __version__,
    }


def write_json(path: str | Path, scene: Scene, solution: Solution) -> None:
    """Write `as_dict` to a file.

    Raises:
        OSError: If the file cannot be written.
    """
    text = json.dumps(as_dict(scene, solution), indent=1, allow_nan=False)
    Path(path).write_text(text + "\n", encoding="utf-8")

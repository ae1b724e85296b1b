"""Output of a solution as JSON, in SI."""

from typing import Any

import numpy as np

from ...numerics.labels import array_fields, labelled_fields
from ...numerics.result import Result
from ...report.json_output import run_json, to_json
from ..bearing.fit_report import fit_as_dict, preload_as_dict
from ..bearing.life_report import life_as_dict, life_verdict, verdict_as_dict
from ..bearing.oil import oil_as_dict
from ..bearing.read_scene import Scene
from ..bearing.solved import SolvedScene

NOT_WRITTEN = {
    "result",
    "unrestrained",
    "pitch_radius",
    "roller_pressure",
    "contact_half_width",
    "edge_load",
    "edge_pressure",
}
"""Arrays of a solution that are not written; all others are, under their names."""

KINEMATICS = {
    "orbital_speed": "orbit",
    "rotation_speed": "rotation",
    "pitch_angle": "pitch_angle",
    "spin": "spin",
    "spin_to_roll": "spin_to_roll",
}
"""Fields of `BallKinematics` by their names in the file."""


def solution_json(found: SolvedScene) -> dict[str, Any]:
    """Return the solution of a scene as plain numbers and lists, in SI.

    Returns:
        The arrays of the solution but for those of `NOT_WRITTEN`, of balls at speed
        also `KINEMATICS` (m, rad, N, N m, Pa, rad/s), and result, message, residual,
        iterations, warnings, inputs (the scene in SI, which `read_scene` reads again
        from the file) and version. With fits also `fit`, as in `fit_as_dict`; with
        [life] also `life_as_dict`; with a lubricant and a speed also `oil_as_dict`.
        If the solve did not converge the arrays are left out. Infinite values (the
        margin of a shoulder that is not given) are null. For a catalogue bearing also
        `catalogue`: designation, geometry, overridden.
    """
    scene = found.scene
    return {
        **(_numbers(found.numbers) if found.converged else {}),
        **oil_as_dict(found.oil),
        **fits_json(scene),
        **_catalogue(scene),
        **_life(found),
        **solved_json(found),
    }


def _life(found: SolvedScene) -> dict[str, Any]:
    life = found.life
    if life is None:
        return {}
    verdict = life_verdict(found.scene, life)
    return life_as_dict(life, found.scene) | verdict_as_dict(found.scene.life, verdict)


def element_columns(found: SolvedScene) -> dict[str, np.ndarray]:
    """Return a row for each rolling element, columns by header, in SI: what is of it or
    of its contacts, but for what lies along them."""
    solution = found.numbers
    parts = ["kinematics"] if getattr(solution, "kinematics", None) is not None else []
    columns = {
        header: column
        for name, array in labelled_fields(solution, *parts).items()
        if array.axes[:1] == ("element",) and "point" not in array.axes
        for header, _, column in array.columns(name)
    }
    azimuth = {k: v for k, v in columns.items() if k.startswith("azimuth")}
    return {"element": np.arange(len(solution.azimuth))} | azimuth | columns


def solved_json(found: SolvedScene) -> dict[str, Any]:
    """Return the status of a solve: result, message, residual, iterations, warnings."""
    scene, solution = found.scene, found.numbers
    status = {
        "result": Result(int(solution.result)).label,
        "message": solution.failure_message or "converged",
        "residual": solution.stats.residual,
        "iterations": solution.stats.iterations,
    }
    return run_json(status, found.warnings, scene.inputs)


def solved_life_as_dict(found: SolvedScene) -> dict[str, Any]:
    """Return the rating life of a solved scene as plain numbers and lists, in SI.

    Args:
        found: From `solve_scene`, of a scene with [life].

    Returns:
        Contents of `life_as_dict`, `fits_json` and `solved_json`; the last one
        only if the solve did not converge.
    """
    fits = fits_json(found.scene) if found.converged else {}
    return {**_life(found), **fits, **solved_json(found)}


def fits_json(scene: Scene) -> dict[str, Any]:
    """Return under `fit` the output of `fit_as_dict`, and `preload` of a set, from
    `preload_as_dict`, if it was computed; empty for a scene without fits.
    """
    if scene.fits is None:
        return {}
    found = fit_as_dict(scene)
    if scene.preload_of_set is not None:
        found["preload"] = preload_as_dict(scene.preload_of_set)
    return {"fit": found}


def _catalogue(scene):
    taken = scene.catalogue
    if taken is None:
        return {}
    return {
        "catalogue": {
            "designation": taken.entry.designation,
            "geometry": taken.entry.geometry,
            "overridden": list(taken.overridden),
        }
    }


def _numbers(solution) -> dict[str, Any]:
    found = array_fields(solution)
    numbers: dict[str, Any] = {k: v for k, v in found.items() if k not in NOT_WRITTEN}
    if (moving := getattr(solution, "kinematics", None)) is not None:
        numbers |= {name: getattr(moving, field) for name, field in KINEMATICS.items()}
    return to_json(numbers)

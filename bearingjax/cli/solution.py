"""Outcome of a solved bearing, for `solve` and the commands based on it."""

from .execute import Outcome


def solution_outcome(scene, numbers=None, brief=None) -> Outcome:
    """Solve the bearing of a scene for its load.

    Args:
        scene: From `read_scene`.
        numbers: Returns the JSON of a scene and its solution; default: `as_dict`.
        brief: Sections of the report shown on the terminal; default: all.
    """
    from ..scene import as_dict, report, run_scene, with_set_preload

    solution = run_scene(scene)
    solved = bool(solution.converged)
    if solved:
        scene = with_set_preload(scene)

    told = report(scene, solution) if solved else None

    def draw():
        from ..plot import overview

        return overview(solution.element.bearing, solution, title=scene.name)

    def draw_bearing():
        from ..plot import drawing

        # Mounted and preloaded if given in the scene.
        element = solution.element if solved else scene.element
        return drawing(element.bearing, scene.name)

    return Outcome(
        scene.name,
        scene.inputs,
        lambda: (numbers or as_dict)(scene, solution),
        told if brief is None or told is None else told.only(brief),
        page=None if told is None else lambda: told,
        pictures={"Section, load zone, contacts": draw} if solved else {},
        drawing=draw_bearing,
        problems=[] if solved else [why_unsolved(scene, solution)],
    )


def why_unsolved(scene, solution) -> str:
    """Return the reason why a bearing was not solved.

    Args:
        scene: The scene.
        solution: Its solution, not converged.
    """
    from ..numerics import Result
    from ..statics.solution import message

    label = Result(int(solution.result)).label
    return f"{label}: {message(solution, scene.moving_ring)}"

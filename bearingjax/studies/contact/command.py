"""`bearingjax contact`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, picture
from ..solve.command import why_unsolved


def run(options: Namespace, tools: Tools) -> Outcome:
    """Solve the contact of one roller and one raceway, both elastic half-spaces, cell
    by cell; beside it what independent slices give."""
    from ...files import SceneError
    from ..bearing.read_scene import read_scene
    from ..bearing.solved import SolvedScene
    from ..solve.output import solution_json
    from ..solve.run import run_scene
    from .read import is_bearing, read_contact
    from .report import contact_as_dict, contact_report, contact_warnings
    from .run import run_contact, run_refined

    if is_bearing(options.scene, options.set):
        bearing = read_scene(options.scene, options.set)
        found = SolvedScene(bearing, run_scene(bearing))
        if not found.converged:
            return Outcome(
                bearing.name,
                bearing.inputs,
                lambda: solution_json(found),
                problems=[why_unsolved(found)],
            )
        scene, cases = run_refined(
            bearing, found.solution, options.roller, options.raceway, options.free_ends
        )
    elif options.roller is not None or options.raceway is not None:
        raise SceneError("--roller and --raceway are for the scene of a bearing")
    elif options.free_ends:
        cure = "a contact's scene has `free_ends` in its [roller]"
        raise SceneError(f"--free-ends is for the scene of a bearing; {cure}")
    else:
        scene = read_contact(options.scene, options.set)
        cases = run_contact(scene)
    lost = _why_lost(scene, cases)

    draw = picture(
        "contact_overview",
        [case.solution for case in cases],
        [case.slices for case in cases],
        title=scene.name,
    )
    none = len(lost) == len(cases)
    warned = contact_warnings(scene, cases) if none else []
    return Outcome(
        scene.name,
        scene.inputs,
        lambda: contact_as_dict(scene, cases),
        None if none else contact_report(scene, cases),
        pictures={} if lost else {"Pressures": draw},
        problems=[*(f"warning: {one}" for one in warned), *lost],
    )


def _why_lost(scene, cases) -> list[str]:
    """Return the reasons why loads of a contact were not solved, by load."""
    from ...numerics import Result

    found = []
    for given, case in zip(scene.cases, cases, strict=True):
        if not case.solution.converged:
            where = f" {given['load']:.5g} N:" if scene.operating.listed else ""
            label = Result(int(case.solution.result)).label
            found.append(f"{label}:{where} {case.solution.failure_message}")
    return found

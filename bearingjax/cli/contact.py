"""`bearingjax contact`."""

from . import jax_settings
from .options import add_plot, add_report, add_scene
from .outputs import Reporter, check_outputs, save, write
from .status import NOT_SOLVED, SOLVED, complain, tell_unsolved


def add(commands):
    """What may be written after it."""
    command = commands.add_parser(
        "contact",
        help="one roller on one raceway, its ends included",
        description="Solve the contact of one roller and one raceway, both elastic"
        " half-spaces, cell by cell; beside it what independent slices give.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    add_scene(command)
    command.add_argument(
        "--roller",
        type=int,
        help="of a bearing's scene; default: the one with the largest load",
    )
    command.add_argument(
        "--raceway", choices=("inner", "outer"), help="likewise; default: inner"
    )
    command.add_argument(
        "--free-ends",
        action="store_true",
        help="likewise: the roller's end faces bear no stress",
    )
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options) -> int:
    """Solve a contact on its own, or one of a bearing."""
    from ..scene import (
        SceneError,
        contact_report,
        contact_warnings,
        is_bearing,
        read_contact,
        read_scene,
        run_contact,
        run_refined,
        run_scene,
        write_contact_json,
        write_json,
    )

    check_outputs(options)
    page = Reporter(options)
    if is_bearing(options.scene, options.set):
        bearing = read_scene(options.scene, options.set)
        solution = run_scene(bearing, jax_settings.programs())
        if not solution.converged:
            write(
                (options.json, lambda path: write_json(path, bearing, solution)),
                (options.plot, None),
                (options.report, None),
            )
            return tell_unsolved(bearing, solution)
        scene, cases = run_refined(
            bearing, solution, options.roller, options.raceway, options.free_ends
        )
    elif options.roller is not None or options.raceway is not None:
        raise SceneError("--roller and --raceway are for the scene of a bearing")
    elif options.free_ends:
        cure = "a contact's scene has `free_ends` in its [roller]"
        raise SceneError(f"--free-ends is for the scene of a bearing; {cure}")
    else:
        scene = read_contact(options.scene, options.set)
        cases = run_contact(scene)
    lost = [case.solution for case in cases if not case.solution.converged]

    warned = contact_warnings(scene, cases)
    text = contact_report(scene, cases) if len(lost) < len(cases) else ""

    def draw(path, **format):
        from ..plot import contact_overview

        figure = contact_overview(
            [case.solution for case in cases],
            [case.slices for case in cases],
            title=scene.name,
        )
        save(figure, path, **format)

    def tell(path):
        texts, draws = {"Contact": text}, {"Pressures": draw}
        page(path, scene.name, texts, scene.inputs, draws, warnings=warned)

    drawn = write(
        (options.json, lambda path: write_contact_json(path, scene, cases)),
        (options.plot, None if lost else draw),
        (options.report, None if lost else tell),
    )
    if text:
        print(text, flush=True)
    for one in warned:
        complain(f"warning: {one}")
    return _tell_lost(scene, cases) or drawn


def _tell_lost(scene, cases) -> int:
    """Name the loads of a contact that were not solved; exit status."""
    from ..contact.halfspace.pressure import message
    from ..numerics import Result

    status = SOLVED
    for given, case in zip(scene.cases, cases, strict=True):
        if case.solution.converged:
            continue
        status = NOT_SOLVED
        where = f" {given['load']:.5g} N:" if scene.listed else ""
        label = Result(int(case.solution.result)).label
        complain(f"{label}:{where} {message(case.solution)}")
    return status

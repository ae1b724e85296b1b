"""The command line: `bearingjax solve`, `sweep`, `optimise`, `life`, `contact`, `skid`,
`rotor`, `noise`, `catalogue`, `new`, `examples`."""

import contextlib
import gc
import io
import os
import shlex
import signal
import sys
import time
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .arguments import parser

SOLVED, BAD_INPUT, NOT_SOLVED, INTERRUPTED = 0, 2, 3, 130
"""Exit status."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        arguments: Without the program's name; default: those of the process.

    Returns:
        Exit status: 0 solved, 2 bad input (or an output that cannot be written), 3 not
        solved, 130 interrupted.
    """
    options = parser().parse_args(arguments)
    options.given = list(sys.argv[1:] if arguments is None else arguments)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # which may not know "µ"
            stream.reconfigure(errors="backslashreplace")
    from .scene import SceneError

    # Tracing makes many small objects; searching them for cycles takes a seventh of the
    # time of a command that ends before memory matters.
    collecting = gc.isenabled()
    gc.disable()
    try:
        _configure_jax(options)
        return _COMMANDS[options.command](options)
    except SceneError as error:
        print(f"bearingjax: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("bearingjax: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of the report has seen enough.
        _forget_output()
        return SOLVED
    except OSError as error:
        place = error.filename or "standard output"
        print(f"bearingjax: {place}: {error.strerror or error}", file=sys.stderr)
        if error.filename is None:
            _forget_output()
        return BAD_INPUT
    finally:
        if collecting:
            gc.enable()


def _forget_output() -> None:
    """What standard output still holds goes nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _configure_jax(options):
    """float64, and compiled programs kept from one run to the next."""
    import jax

    # XLA prints a page of false alarms about CPU features when it loads a kept program.
    jax.config.update("jax_logging_level", "CRITICAL")

    jax.config.update("jax_enable_x64", True)
    if options.command == "sweep":
        count = _devices(options)
        with contextlib.suppress(RuntimeError):  # JAX runs already, in a test
            jax.config.update("jax_num_cpu_devices", count)
    # Where in the sources an operation was written is of no use to a user.
    jax.config.update("jax_include_full_tracebacks_in_locations", False)
    if getattr(jax.config, "jax_compilation_cache_dir", None) is None:
        cache = _cache() / "jax"
        # JAX would warn of every program that it cannot keep, among our own warnings.
        with contextlib.suppress(OSError):
            cache.mkdir(mode=0o700, parents=True, exist_ok=True)
            if os.access(cache, os.W_OK | os.X_OK) and not _is_shared(cache):
                jax.config.update("jax_compilation_cache_dir", str(cache))
    message = ".*persistent compilation cache.*"  # such as of a full disk
    warnings.filterwarnings("ignore", message)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", 0)


def _cache() -> Path:
    """Where this user's files of the package are kept."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "bearingjax"


def _is_shared(folder: Path) -> bool:
    """Whether others can write what would be run from there; says so."""
    from .scene.programs import is_private

    shared = hasattr(os, "geteuid") and not is_private(folder.lstat())
    if shared:
        problem = "is not yours alone to write, so no compiled programs are kept there"
        print(f"bearingjax: {folder}: {problem}", file=sys.stderr)
    return shared


def _programs() -> Path | None:
    """Where the programs of `solve` are kept; `None` if JAX is to keep none."""
    import jax

    kept = jax.config.values["jax_enable_compilation_cache"]
    return _cache() / "programs" if kept else None


def _devices(options) -> int:
    """Parts of the processor that a sweep uses: as many as asked for, or all cores."""
    from .scene import SceneError

    linux = sys.platform == "linux"
    cores = len(os.sched_getaffinity(0)) if linux else os.cpu_count() or 1
    count = cores if options.devices is None else options.devices
    if not 1 <= count <= cores:
        allowed = f"it must be at least 1 and at most {cores}, the cores that there are"
        raise SceneError(f"--devices is {count}; {allowed}")
    return count


def _solve(options) -> int:
    from .numerics import Result
    from .scene import read_scene, report, run_scene, solve_page, write_json

    if options.report is not None:
        _check_report(options.report)
        _check_matplotlib()
    _check_outputs(options)
    scene = read_scene(options.scene, options.set)
    origin = _origin(options)
    solution = run_scene(scene, _programs())

    def draw(path, **format):
        from .plot import overview

        figure = overview(solution.element.bearing, solution, title=scene.name)
        figure.savefig(path, dpi=150, **format)

    def tell(path):
        picture = io.BytesIO()
        draw(picture, format="png")
        pictures = {"Section, load zone, contacts": picture.getvalue()}
        page = solve_page(scene, solution, pictures, origin)
        path.write_text(page, encoding="utf-8")

    solved = Result(int(solution.result)) is Result.CONVERGED
    _write(
        (options.json, lambda path: write_json(path, scene, solution)),
        (options.plot, draw if solved else None),
        (options.report, tell if solved else None),
    )
    if not solved:
        return _tell_unsolved(scene, solution)
    print(report(scene, solution), flush=True)
    return SOLVED


def _origin(options):
    """Where a report comes from; read before anything is solved."""
    import datetime

    from .scene import Origin
    from .scene.scene_file import find_scene

    now = datetime.datetime.now().astimezone()
    return Origin(
        shlex.join(["bearingjax", *options.given]),
        find_scene(options.scene).read_text(encoding="utf-8-sig"),
        tuple(options.set),
        now.strftime("%Y-%m-%d %H:%M %z"),
    )


def _tell_unsolved(scene, solution) -> int:
    """Say why a bearing was not solved; exit status."""
    from .numerics import Result
    from .statics.solution import message

    label = Result(int(solution.result)).label
    text = message(solution, scene.moving_ring)
    print(f"bearingjax: {label}: {text}", file=sys.stderr)
    return NOT_SOLVED


def _sweep(options) -> int:
    from .numerics import Result
    from .scene import (
        Interrupt,
        SceneError,
        design_columns,
        read_cases,
        resume_cases,
        run_cases,
        sweep_page,
        sweep_report,
        write_sweep_json,
    )
    from .statics.sweep_table import write

    if options.report is not None:
        _check_report(options.report)
    _check_table(options)
    _check_outputs(options)
    _devices(options)
    if options.resume and options.table is None:
        raise SceneError("--resume takes up a table; name it with --table")
    begin = time.perf_counter()
    table = read_cases(options.scene, options.set)
    _check_table(options, table.cases.count)
    origin = _origin(options)
    shown = not options.quiet and sys.stderr.isatty()
    with Interrupt() as interrupt:
        done = options.table if options.resume else None
        if done is not None and done.exists():
            solved = resume_cases(table, done, shown, interrupt)
        else:
            solved = run_cases(table, shown, interrupt)
        summary = sweep_report(table, solved, time.perf_counter() - begin)

        def tell(path):
            page = sweep_page(table, solved, summary, origin)
            path.write_text(page, encoding="utf-8")

        _write(
            (options.table, lambda path: write(solved, path, design_columns(table))),
            (options.json, lambda path: write_sweep_json(path, table, solved)),
            (options.report, tell),
        )
    print(summary, flush=True)
    left = int((np.asarray(solved.result) == Result.NOT_RUN).sum())
    if left or interrupt.number is not None:
        _tell_interrupted(options, left, solved.cases.count)
        return 128 + (interrupt.number or signal.SIGINT)
    if solved.converged.all():
        return SOLVED
    lost = int((~solved.converged).sum())
    print(
        f"bearingjax: {lost} of {solved.cases.count} cases not solved", file=sys.stderr
    )
    return NOT_SOLVED


def _tell_interrupted(options, left: int, count: int) -> None:
    """Say how an interrupted sweep goes on."""
    words = f"interrupted: {left} of {count} cases not run"
    if left and options.table is not None:
        given = [word for word in options.given if word != "--resume"]
        again = shlex.join(["bearingjax", *given, "--resume"])
        words += f"; go on with: {again}"
    elif left:
        words += "; with --table what is solved is kept, and --resume goes on from it"
    print(f"bearingjax: {words}", file=sys.stderr)


def _optimise(options) -> int:
    from .numerics import SolveError
    from .scene import (
        optimisation_as_dict,
        optimisation_report,
        read_optimisation,
        run_optimisation,
        unsolved_start_as_dict,
        write_numbers,
    )

    _check_outputs(options)
    task = read_optimisation(options.scene, options.set)
    try:
        found = run_optimisation(task, progress=options.progress)
    except SolveError as error:
        numbers = unsolved_start_as_dict(task, error)
        _write(
            (options.json, lambda path: write_numbers(path, numbers)),
            (options.plot, None),
        )
        print(f"bearingjax: {error}", file=sys.stderr)
        return NOT_SOLVED

    def draw(path):
        from .plot import optimised

        optimised(found, title=task.scene.name).savefig(path, dpi=150)

    _write(
        (
            options.json,
            lambda path: write_numbers(path, optimisation_as_dict(task, found)),
        ),
        (options.plot, draw if found.converged else None),
    )
    if not found.converged:
        print(f"bearingjax: {found.result}: {found.message}", file=sys.stderr)
        return NOT_SOLVED
    print(optimisation_report(task, found), flush=True)
    return SOLVED


def _life(options) -> int:
    from .scene import has_cases

    _check_table(options)
    _check_outputs(options)
    if has_cases(options.scene, options.set):
        return _life_of_cases(options)
    return _life_of_load(options)


def _life_of_load(options) -> int:
    from .numerics import Result
    from .scene import (
        SceneError,
        life_as_dict,
        life_report,
        read_scene,
        run_scene,
        scene_life,
        solved_as_dict,
        write_numbers,
    )

    if options.table is not None:
        raise SceneError("--table is for a scene with [cases]; this one has one load")
    scene = read_scene(options.scene, options.set)
    solution = run_scene(scene, _programs())
    solved = Result(int(solution.result)) is Result.CONVERGED
    life = scene_life(scene, solution) if solved else None
    numbers = solved_as_dict(scene, solution)
    if life is not None:
        numbers = {**life_as_dict(life), **numbers}
    _write((options.json, lambda path: write_numbers(path, numbers)))
    if life is None:
        return _tell_unsolved(scene, solution)
    print(f"{scene.name}\n{life_report(scene, solution, life)}")
    for text in numbers["warnings"]:
        print(f"warning: {text}")
    sys.stdout.flush()
    return SOLVED


def _life_of_cases(options) -> int:
    from .scene import (
        read_cases,
        run_life,
        spectrum_as_dict,
        spectrum_report,
        unsolved,
        write_numbers,
    )
    from .statics.sweep_table import write

    table = read_cases(options.scene, options.set)
    run = run_life(table, not options.quiet and sys.stderr.isatty())
    _write(
        (options.table, lambda path: write(run.solved, path)),
        (options.json, lambda path: write_numbers(path, spectrum_as_dict(run))),
    )
    if not run.converged:
        print(f"bearingjax: {unsolved(run)}", file=sys.stderr)
        return NOT_SOLVED
    print(spectrum_report(run), flush=True)
    return SOLVED


def _contact(options) -> int:
    from .scene import (
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

    _check_outputs(options)
    if is_bearing(options.scene, options.set):
        bearing = read_scene(options.scene, options.set)
        solution = run_scene(bearing, _programs())
        if not solution.converged:
            _write(
                (options.json, lambda path: write_json(path, bearing, solution)),
                (options.plot, None),
            )
            return _tell_unsolved(bearing, solution)
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

    def draw(path):
        from .plot import contact_overview

        figure = contact_overview(
            [case.solution for case in cases],
            [case.slices for case in cases],
            title=scene.name,
        )
        figure.savefig(path, dpi=150)

    _write(
        (options.json, lambda path: write_contact_json(path, scene, cases)),
        (options.plot, None if lost else draw),
    )
    if len(lost) < len(cases):
        print(contact_report(scene, cases), flush=True)
    for text in contact_warnings(scene, cases):
        print(f"bearingjax: warning: {text}", file=sys.stderr)
    return _tell_lost(scene, cases)


def _tell_lost(scene, cases) -> int:
    """Name the loads of a contact that were not solved; exit status."""
    from .contact.halfspace.pressure import message
    from .numerics import Result

    status = SOLVED
    for given, case in zip(scene.cases, cases, strict=True):
        if case.solution.converged:
            continue
        status = NOT_SOLVED
        where = f" {given['load']:.5g} N:" if scene.listed else ""
        label = Result(int(case.solution.result)).label
        text = f"{label}:{where} {message(case.solution)}"
        print(f"bearingjax: {text}", file=sys.stderr)
    return status


def _skid(options) -> int:
    from .scene import (
        read_skid,
        run_skid,
        skid_columns,
        skid_message,
        skid_report,
        write_skid_json,
    )
    from .statics.sweep_table import write_columns

    _check_table(options)
    _check_outputs(options)
    task = read_skid(options.scene, options.set, steady=options.steady)
    run = run_skid(task, shown=not options.quiet and sys.stderr.isatty())

    def draw(path):
        from .plot import skid_overview

        figure = skid_overview(task.model, run.found, run.state, title=task.name)
        figure.savefig(path, dpi=150)

    def tabulate(path):
        write_columns(skid_columns(run), path)

    _write(
        (options.json, lambda path: write_skid_json(path, run)),
        (options.table, tabulate if run.has_numbers else None),
        (options.plot, draw if run.converged else None),
    )
    if not run.converged:
        text = f"{run.result.label}: {skid_message(run)}"
        print(f"bearingjax: {text}", file=sys.stderr)
        return NOT_SOLVED
    print(skid_report(run), flush=True)
    return SOLVED


def _rotor(options) -> int:
    from .scene import (
        SceneError,
        read_rotor,
        rotor_columns,
        rotor_report,
        rotor_series,
        run_rotor,
        write_rotor_json,
    )
    from .statics.sweep_table import write_columns

    _check_table(options)
    _check_outputs(options)
    task = read_rotor(options.scene, options.set)
    if options.table is None and options.series is not None:
        raise SceneError("--series is for a table; name it with --table")
    series = None if options.table is None else rotor_series(task, options.series)
    shown = not options.quiet and sys.stderr.isatty()
    run = run_rotor(task, _show_stage if shown else None)
    if shown:
        _show_stage("")

    def draw(path):
        from .plot import rotor_overview

        figure = rotor_overview(run, title=task.name)
        figure.savefig(path, dpi=150)

    columns = {} if series is None else rotor_columns(run, series)
    _write(
        (options.json, lambda path: write_rotor_json(path, run)),
        (
            options.table,
            (lambda path: write_columns(columns, path)) if columns else None,
        ),
        (options.plot, None if run.settled is None else draw),
    )
    if run.settled is not None:
        print(rotor_report(run), flush=True)
    for failure in run.failures:
        text = f"{failure.result.label}: {failure.part}: {failure.message}"
        print(f"bearingjax: {text}", file=sys.stderr)
    return SOLVED if run.converged else NOT_SOLVED


def _noise(options) -> int:
    from .scene import (
        SceneError,
        noise_columns,
        noise_report,
        read_noise,
        run_noise,
        write_noise_json,
        write_noise_sound,
    )
    from .statics.sweep_table import write_columns

    _check_table(options)
    _check_sound(options.wav)
    _check_outputs(options)
    count = options.monte_carlo
    if count is not None and not 1 <= count <= 100_000:
        allowed = "it must be at least 1 and at most 100000"
        raise SceneError(f"--monte-carlo is {count}; {allowed}")
    task = read_noise(options.scene, options.set, bearings=count or 0)
    shown = not options.quiet and sys.stderr.isatty()
    run = run_noise(task, _show_stage if shown else None)
    if shown:
        _show_stage("")
    full = []

    def draw(path):
        from .plot import noise_overview

        noise_overview(run, title=task.name).savefig(path, dpi=150)

    solved = run.converged
    _write(
        (options.json, lambda path: write_noise_json(path, run)),
        (
            options.table,
            (lambda path: write_columns(noise_columns(run), path)) if solved else None,
        ),
        (
            options.wav,
            (lambda path: full.append(write_noise_sound(path, run)))
            if solved
            else None,
        ),
        (options.plot, draw if solved else None),
    )
    if not solved:
        print(f"bearingjax: {run.result.label}: {run.message}", file=sys.stderr)
        return NOT_SOLVED
    print(noise_report(run), flush=True)
    if full:
        print(f"{options.wav}: full scale is {full[0]:.4g} m/s²", flush=True)
    return SOLVED


def _catalogue(options) -> int:
    from .scene import (
        SceneError,
        catalogue,
        catalogue_as_dict,
        catalogue_details,
        catalogue_entry,
        catalogue_table,
        check_outputs,
        select,
        write_numbers,
    )

    named = tuple(catalogue_entry(name) for name in options.designation)
    if options.plot is not None:
        if not named:
            raise SceneError("--plot draws the bearings that are named; name some")
        _check_plot(options.plot)
    check_outputs({"--json": options.json, "--plot": options.plot})
    chosen = select(
        named or catalogue(),
        options.type,
        options.bore,
        options.outside,
        options.capacity,
    )

    def draw(path):
        from .plot import cross_sections

        titles = [f"{e.designation}, inner geometry {e.geometry}" for e in chosen]
        figure = cross_sections([entry.bearing for entry in chosen], titles)
        figure.savefig(path, dpi=150)

    _write(
        (options.json, lambda path: write_numbers(path, catalogue_as_dict(chosen))),
        (options.plot, draw if chosen else None),
    )
    if named:
        print("\n\n".join(catalogue_details(entry) for entry in chosen), flush=True)
    else:
        print(catalogue_table(chosen), flush=True)
    return SOLVED


def _new(options) -> int:
    from .scene import catalogue_entry, new_scene

    print(new_scene(catalogue_entry(" ".join(options.designation))), end="", flush=True)
    return SOLVED


def _examples(options) -> int:
    from .scene import SceneError, not_among, scene_list, shipped_scenes

    if options.name is None:
        print(scene_list(), flush=True)
        return SOLVED
    scenes = shipped_scenes()
    if options.name not in scenes:
        raise SceneError(f"examples: {not_among(options.name, tuple(scenes))}")
    print(scenes[options.name].read_text(encoding="utf-8"), end="", flush=True)
    return SOLVED


def _check_sound(path: Path | None) -> None:
    from .scene import SceneError

    if path is not None and path.suffix.lower() != ".wav":
        raise SceneError(f"{path}: a sound ends in .wav")


def _show_stage(name: str) -> None:
    """The stage that a long run is in, on one line of standard error."""
    print(f"\r\x1b[K{name}{'…' if name else ''}", end="", file=sys.stderr, flush=True)


def _check_table(options, rows: int = 0) -> None:
    """Fail before anything is solved if a table, of so many rows, cannot be written."""
    from .scene import SceneError
    from .statics.sweep_table import check_writable

    if options.table is None:
        return
    try:
        check_writable(options.table, rows)
    except (ValueError, ImportError) as error:
        raise SceneError(str(error)) from error


def _check_outputs(options) -> None:
    """Fail before anything is solved if outputs cannot be written or hit an input."""
    from .scene import check_outputs, scene_files

    names = ("json", "plot", "table", "wav", "report")
    outputs = {f"--{name}": getattr(options, name, None) for name in names}
    if outputs["--plot"] is not None:
        _check_plot(outputs["--plot"])
    check_outputs(outputs, scene_files(options.scene, options.set))


def _write(*outputs) -> None:
    """Write the outputs of a run; say which of an earlier one were removed."""
    from .scene import write_outputs

    for path in write_outputs(outputs):
        print(f"bearingjax: {path}: of an earlier run, removed", file=sys.stderr)


def _check_report(path: Path) -> None:
    from .scene import SceneError

    if path.suffix.lower() not in (".html", ".htm"):
        raise SceneError(f"{path}: a report ends in .html")


def _check_matplotlib() -> None:
    from .scene import SceneError

    try:
        import matplotlib
    except ImportError as error:
        problem = 'pictures need matplotlib: pip install "bearingjax[plot]"'
        raise SceneError(problem) from error
    matplotlib.use("Agg")


def _check_plot(path: Path) -> None:
    from .scene import SceneError

    _check_matplotlib()
    if path.suffix.lower() not in (".png", ".pdf", ".svg"):
        raise SceneError(f"{path}: a picture ends in .png, .pdf or .svg")


_COMMANDS = {
    "solve": _solve,
    "sweep": _sweep,
    "optimise": _optimise,
    "life": _life,
    "contact": _contact,
    "skid": _skid,
    "rotor": _rotor,
    "noise": _noise,
    "catalogue": _catalogue,
    "new": _new,
    "examples": _examples,
}

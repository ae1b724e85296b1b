"""Common path from options to outputs, for every command that writes files.

A command reads and solves, and returns an `Outcome`; `execute` checks the options
before, and writes, prints and reports problems after.
"""

import contextlib
import io
import json
import shlex
import sys
from pathlib import Path
from typing import Any

from ..studies.commands import Command
from ..studies.outcome import Draw, Outcome, Stage, Tools
from ..studies.outputs import (
    OUTPUTS,
    check_outputs,
    check_table,
    failure_of_output,
    save,
    sources_of,
    write_outputs,
)
from ..studies.status import BAD_INPUT, NOT_SOLVED, SOLVED, complain


def execute(command: Command, options: Any) -> int:
    """Run a command: check the options, solve, write, print.

    Args:
        command: Its `run(options, tools)` returns an `Outcome`.
        options: Command line options.

    Returns:
        Exit status.

    Raises:
        SceneError: For bad input, or outputs that cannot be written.
    """
    from ..numerics.compiled.programs import load_ahead, tell_compiling

    check_outputs(options)
    check_table(options)
    origin = _origin(options)
    terminal = sys.stderr.isatty()
    shown, stage = terminal and not options.quiet, None
    if not options.quiet:
        stage = Stage(terminal)
        tell_compiling(stage.during)
    with contextlib.ExitStack() as stack:
        stack.enter_context(load_ahead(f"{options.command} {sources_of(options)}"))
        try:
            found = command.run(options, Tools(shown, stage, stack.enter_context))
        finally:
            tell_compiling(None)
            if stage is not None:
                stage.end()
        messages: list[str] = []
        failed = _write(found, options, origin, messages)
        ended = found.interrupted()
    if found.report is not None:
        print("\n".join([str(found.report), *messages]), flush=True)
    if ended is not None:
        complain(ended[0])
        return ended[1]
    for problem in found.problems:
        complain(problem)
    return NOT_SOLVED if found.problems else BAD_INPUT if failed else SOLVED


def _write(found: Outcome, options, origin, messages: list[str]) -> bool:
    """Write the outputs of a run; return whether one of them failed."""
    from ..files.table_file import write_table
    from ..report.json_output import write_numbers

    def tabulate(path):
        write_table(_columns(found, options), path)

    def write_sound(path):
        assert found.sound is not None
        messages.append(found.sound(path))

    def picture(draw):
        return None if draw is None else lambda path: save(draw(), path)

    writers = {
        "json": lambda path: write_numbers(path, found.numbers()),
        "table": None if found.columns is None else tabulate,
        "wav": None if found.sound is None else write_sound,
        "plot": picture(next(iter(found.pictures.values()), None)),
        "drawing": picture(found.drawing),
        "report": None
        if found.report is None
        else lambda path: _write_page(path, found, origin, options),
    }
    return write_outputs([(getattr(options, k, None), writers[k]) for k in OUTPUTS])


def _columns(found: Outcome, options) -> Any:
    """Return the table of a run in the units of the reports, or in SI on request."""
    from ..files.table_file import in_shown_units

    assert found.columns is not None
    return found.columns() if options.si else in_shown_units(found.columns())


def _write_page(path: Path, found: Outcome, origin, options) -> None:
    """Write the HTML page of a run.

    Raises:
        Incomplete: If a picture failed; a line is shown in its place.
    """
    from ..files.output_files import Incomplete
    from ..report import report_page

    missing: list[str] = []

    def draw_picture(name: str, draw: Draw) -> bytes | str:
        try:
            picture = io.BytesIO()
            save(draw(), picture, format="png")
            return picture.getvalue()
        except OSError:
            raise
        except Exception as error:
            missing.append(f"{name}: {failure_of_output(error)}")
            return f"This picture {failure_of_output(error)}"

    assert found.report is not None
    page = report_page(
        found.name,
        found.report if found.page is None else found.page(),
        found.inputs,
        origin,
        {name: draw_picture(name, draw) for name, draw in found.pictures.items()},
        _columns(found, options) if found.table_on_page and found.columns else None,
        found.problems,
        None if found.drawing is None else draw_picture("Drawing", found.drawing),
    )
    path.write_text(page, encoding="utf-8")
    if missing:
        raise Incomplete("; ".join(missing))


def _origin(options):
    """Return the origin of a report; called before solving, so that it has the scene as
    read."""
    import datetime

    from ..files.scene_file import find_scene, parse_scene
    from ..files.text_file import read_text
    from ..report import Origin
    from ..report.html_report import flat

    now = datetime.datetime.now().astimezone()
    texts, written = [], {}
    for source in sources_of(options):
        path = find_scene(source)
        text = read_text(path)
        if path.suffix.lower() == ".json":  # of an earlier run: without its results
            inputs = json.loads(text).get("inputs")
            text = json.dumps({"inputs": inputs}, indent=1, ensure_ascii=False)
        elif hasattr(options, "scene"):
            written = dict(flat(parse_scene(path, options.set)))
        texts.append(text)
    return Origin(
        shlex.join(["bearingjax", *options.given]),
        "\n".join(texts),
        tuple(getattr(options, "set", ())),
        now.strftime("%Y-%m-%d %H:%M %z"),
        None if options.si else written,
    )

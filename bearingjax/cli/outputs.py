"""Files that commands write: refused before anything is solved, written at its end."""

import io
import json
import shlex
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from .status import BAD_INPUT, SOLVED, complain


def check_outputs(options) -> None:
    """Fail before anything is solved if outputs cannot be written or hit an input."""
    from ..scene import check_outputs, scene_files

    names = ("json", "plot", "drawing", "table", "wav", "report")
    outputs = {f"--{name}": getattr(options, name, None) for name in names}
    for picture in (outputs["--plot"], outputs["--drawing"]):
        if picture is not None:
            check_plot(picture)
    if outputs["--report"] is not None:
        check_report(outputs["--report"])
    check_outputs(outputs, scene_files(options.scene, options.set))


def check_table(options, rows: int = 0) -> None:
    """Fail before anything is solved if a table, of so many rows, cannot be written."""
    from ..scene import SceneError
    from ..statics.sweep_table import check_writable

    if options.table is None:
        return
    try:
        check_writable(options.table, rows)
    except (ValueError, ImportError) as error:
        raise SceneError(str(error)) from error


def check_report(path: Path) -> None:
    """Fail if a page cannot be made, or has another ending."""
    from ..scene import SceneError

    check_matplotlib()
    if path.suffix.lower() not in (".html", ".htm"):
        raise SceneError(f"{path}: a report ends in .html")


def check_plot(path: Path) -> None:
    """Fail if a picture cannot be drawn, or not in this format."""
    from ..scene import SceneError

    check_matplotlib()
    if path.suffix.lower() not in (".png", ".pdf", ".svg"):
        raise SceneError(f"{path}: a picture ends in .png, .pdf or .svg")


def check_matplotlib() -> None:
    """Fail if pictures cannot be drawn."""
    from ..scene import SceneError

    try:
        import matplotlib
    except ImportError as error:
        problem = 'pictures need matplotlib: pip install "bearingjax[plot]"'
        raise SceneError(problem) from error
    matplotlib.use("Agg")


def save_drawing(bearing, title: str, path, **format) -> None:
    """Write the drawing of a bearing."""
    from ..plot import drawing

    save(drawing(bearing, title), path, **format)


def save(figure, path, **format) -> None:
    """Write a picture, to a file or a stream."""
    figure.savefig(path, dpi=150, **format)


def draws_solution(scene, solution):
    """What draws the page of a solved bearing, to a file or a stream."""

    def draw(path, **format):
        from ..plot import overview

        figure = overview(solution.element.bearing, solution, title=scene.name)
        save(figure, path, **format)

    return draw


def draws_bearing(scene, element):
    """What draws the bearing of an element, to a file or a stream."""

    def draw(path, **format):
        from ..plot import drawing

        save(drawing(element.bearing, scene.name), path, **format)

    return draw


def tells_solution(scene, solution, page: "Reporter"):
    """What writes the report of a solved bearing.

    Args:
        scene, solution: What was solved.
        page: Begun before that.
    """

    def tell(path: Path):
        from ..scene import sections

        draws = {"Section, load zone, contacts": draws_solution(scene, solution)}
        drawing = draws_bearing(scene, solution.element)
        texts = sections(scene, solution)
        page(path, scene.name, texts, scene.inputs, draws, drawing=drawing)

    return tell


def png(draw) -> bytes:
    """The picture that `draw` draws."""
    picture = io.BytesIO()
    draw(picture, format="png")
    return picture.getvalue()


def write(*outputs) -> int:
    """Write the outputs of a run, pairs of a path and what writes there.

    What cannot be told of an unsolved run has `None` as its second. Says which files of
    an earlier run were removed, and what could not be made: a picture that fails costs
    neither tables nor numbers.

    Returns:
        Exit status of a run that is solved.
    """
    from ..scene import write_outputs

    written = write_outputs(outputs)
    for path in written.removed:
        complain(f"{path}: of an earlier run, removed")
    for path, error in written.failed:
        complain(f"{path}: {_in_words(error)}")
    return BAD_INPUT if written.failed else SOLVED


def _in_words(error: Exception) -> str:
    """Why an output, or a part of one, is missing."""
    from ..scene import Incomplete

    if isinstance(error, Incomplete):
        return str(error)
    return f"could not be made: {type(error).__name__}: {error}"


def _origin(options):
    """Where a report comes from."""
    import datetime

    from ..scene import Origin
    from ..scene.scene_file import find_scene

    now = datetime.datetime.now().astimezone()
    path = find_scene(options.scene)
    text = path.read_text(encoding="utf-8-sig")
    if path.suffix.lower() == ".json":  # of an earlier run: without its results
        inputs = json.loads(text).get("inputs")
        text = json.dumps({"inputs": inputs}, indent=1, ensure_ascii=False)
    return Origin(
        shlex.join(["bearingjax", *options.given]),
        text,
        tuple(options.set),
        now.strftime("%Y-%m-%d %H:%M %z"),
    )


class Reporter:
    """Writes `--report`; made before anything is solved, so that it tells the scene
    that was read.

    Args:
        options: Of the command line.
    """

    def __init__(self, options):
        self._origin = _origin(options)

    def __call__(
        self,
        path: Path,
        title: str,
        texts: Mapping[str, str],
        inputs: Mapping[str, Any],
        draws: Mapping[str, Callable] = MappingProxyType({}),
        table: Mapping[str, Any] | None = None,
        warnings: Sequence[str] = (),
        drawing: Callable | None = None,
    ) -> None:
        """Write the page of a run; arguments as of `report_page`, but that `draws` and
        `drawing` are what writes the pictures.

        Raises:
            Incomplete: If a picture failed; a line stands in its place.
        """
        from ..scene import Incomplete, report_page

        missing: list[str] = []

        def shown(name: str, draw: Callable) -> bytes | str:
            try:
                return png(draw)
            except OSError:
                raise
            except Exception as error:
                missing.append(f"{name}: {_in_words(error)}")
                return f"This picture {_in_words(error)}"

        page = report_page(
            title,
            texts,
            inputs,
            self._origin,
            {name: shown(name, draw) for name, draw in draws.items()},
            table,
            warnings,
            None if drawing is None else shown("Drawing", drawing),
        )
        path.write_text(page, encoding="utf-8")
        if missing:
            raise Incomplete("; ".join(missing))

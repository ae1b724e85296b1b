"""Output files of commands: checked before a run, written after it."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from .status import complain

OUTPUTS = {
    "json": "write numbers in SI",
    "table": "write a row per {} (.csv, .parquet, .xlsx)",
    "wav": "write the acceleration along the sensor as sound (.wav)",
    "plot": "{} (.png, .pdf, .svg)",
    "drawing": "write a drawing {}, with all its dimensions (.png, .pdf, .svg)",
    "report": "write a report that stands alone (.html), with inputs and {}",
}
"""Options that name a file, with their help, in the order in which the files are
written."""

_PICTURE = (".png", ".pdf", ".svg"), "a picture ends in .png, .pdf or .svg"
_ENDINGS = {
    "plot": _PICTURE,
    "drawing": _PICTURE,
    "report": ((".html", ".htm"), "a report ends in .html"),
    "wav": ((".wav",), "a sound ends in .wav"),
}


def write_outputs(outputs: Iterable[tuple[Path | None, Callable | None]]) -> bool:
    """Write files, pairs of a path (`None`: not requested) and its writer.

    Reports which files of an earlier run were removed, and which failed: a failed
    picture does not affect tables and numbers.

    Returns:
        Whether one of them failed.
    """
    from ..files.output_files import write_outputs

    written = write_outputs(outputs)
    for path in written.removed:
        complain(f"{path}: of an earlier run, removed")
    for path, error in written.failed:
        complain(f"{path}: {failure_of_output(error)}")
    return bool(written.failed)


def save(figure: Any, path: Any, **format: Any) -> None:
    """Write a picture, to a file or a stream."""
    figure.savefig(path, dpi=150, **format)
    # Laid out once: a layout of what has its place already would shift it.
    figure.set_layout_engine("none")


def failure_of_output(error: Exception) -> str:
    """Describe why an output, or a part of one, is missing."""
    from ..files.output_files import Incomplete

    if isinstance(error, Incomplete):
        return str(error)
    return f"could not be made: {type(error).__name__}: {error}"


def check_outputs(options: Any, inputs: Sequence[Path] | None = None) -> None:
    """Fail before solving if outputs cannot be written or overwrite an input.

    Args:
        options: Command line options.
        inputs: Files that are read; default: those of the scene.
    """
    from ..files import SceneError
    from ..files.output_files import check_outputs, scene_files

    outputs = {name: getattr(options, name, None) for name in OUTPUTS}
    for name, (endings, words) in _ENDINGS.items():
        path = outputs[name]
        if path is not None and path.suffix.lower() not in endings:
            raise SceneError(f"{path}: {words}")
    _check_packages(outputs)
    if inputs is None:
        inputs = [
            path
            for source in sources_of(options)
            for path in scene_files(source, options.set)
        ]
    check_outputs({f"--{name}": path for name, path in outputs.items()}, inputs)


def check_table(options: Any, rows: int = 0) -> None:
    """Fail before solving if a table with this number of rows cannot be written."""
    from ..files import SceneError
    from ..files.table_file import check_writable

    table = getattr(options, "table", None)
    if table is None:
        return
    try:
        check_writable(table, rows)
    except (ValueError, ImportError) as error:
        raise SceneError(str(error)) from error


def _check_packages(outputs: Mapping[str, Path | None]) -> None:
    """Fail if optional packages are missing; the message names all of them."""
    from ..files import SceneError
    from ..files.table_file import missing_packages

    missing = {}
    if any(outputs[name] for name in ("plot", "drawing", "report")):
        try:
            import matplotlib

            matplotlib.use("Agg")
        except ImportError:
            missing["plot"] = "pictures need matplotlib"
    if outputs["table"] and (words := missing_packages(outputs["table"])):
        missing["table"] = words
    if missing:
        cure = f'pip install "bearingjax[{",".join(missing)}]"'
        raise SceneError(f"{'; '.join(missing.values())}: {cure}")


def sources_of(options: Any) -> list[str]:
    """Return the scenes of a command, of which some have none."""
    own = [options.scene] if hasattr(options, "scene") else []
    return getattr(options, "scenes", own)

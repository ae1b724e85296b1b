"""Output files of a command: checked, written to a temporary file, then moved.

A reader of an output file sees either all of the old file or all of the new one.
"""

import contextlib
import os
import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .quantity import SceneError
from .scene_file import bearing_files, find_scene, parse_scene, profile_files
from .table import text_of
from .text_file import Line, check_regular, read_rows

Writer = Callable[[Path], None]
"""Writes a file at a path."""


class Incomplete(Exception):
    """Raised by a writer if a part of its file is missing; the message names it."""


class Written(NamedTuple):
    """Files removed and files that failed in `write_outputs`.

    Attributes:
        removed: Files of an earlier run for which this run has no content.
        failed: Files that are missing or incomplete, with the error.
    """

    removed: list[Path]
    failed: list[tuple[Path, Exception]]


_STREAMS = ("/dev/std", "/dev/fd/", "/proc/self/fd/")


def check_outputs(
    outputs: Mapping[str, Path | None], inputs: Iterable[Path] = ()
) -> None:
    """Raise unless all outputs can be written without overwriting an input.

    Args:
        outputs: Paths by the option that names them; `None`: no output.
        inputs: Files that are read.

    Raises:
        SceneError: For a folder that does not exist or cannot be written, a folder or
            a write-protected file in place of a file, an input, or one path twice.
    """
    inputs = list(inputs)
    seen: list[tuple[str, Path]] = []
    for option, path in outputs.items():
        if path is None or _is_stream(path):
            continue
        if str(path) == "-":
            raise SceneError(f"{option} -: name a file; /dev/stdout is the screen")
        target = _target(path)
        if not target.parent.is_dir():
            raise SceneError(f"{path}: its folder does not exist")
        if target.is_dir():
            raise SceneError(f"{path}: is a folder; name a file")
        for given in inputs:
            if _are_same(target, given):
                problem = f"is read as {given.name} here; {option} would overwrite it"
                raise SceneError(f"{path}: {problem}; name another file")
        for other, place in seen:
            if _are_same(target, place):
                problem = f"is named by {other} and by {option}; name two files"
                raise SceneError(f"{path}: {problem}")
        if target.exists() and not os.access(target, os.W_OK):
            raise SceneError(f"{path}: is write-protected; name another file")
        if not os.access(target.parent, os.W_OK | os.X_OK):
            raise SceneError(f"{path}: its folder is write-protected")
        seen.append((option, target))


def write_outputs(outputs: Iterable[tuple[Path | None, Writer | None]]) -> Written:
    """Write temporary files, and move them to their paths once all are complete.

    A file of an earlier run for which this run has no content is removed, so that it
    is not mistaken for a result of this run. If a writer fails, such as a plot of
    non-finite numbers, only its file is missing.

    Args:
        outputs: Path (`None`: not requested) and its writer (`None`: nothing to
            write).

    Raises:
        SceneError: If a file cannot be written (a full disk); then none has changed.
    """
    moves: list[tuple[Path, Path, Path]] = []
    written = Written([], [])
    stale = []
    try:
        for path, writer in outputs:
            if path is None:
                continue
            made = writer is not None and _write_temporary(path, writer, moves, written)
            if not made and path.is_file():
                stale.append(path)
        for path, temporary, target in moves:
            with _name_in_errors(path):
                os.replace(temporary, target)
    finally:
        for _, temporary, _ in moves:
            temporary.unlink(missing_ok=True)
    for path in stale:
        with _name_in_errors(path):
            path.unlink()
        written.removed.append(path)
    return written


def _write_temporary(path: Path, writer: Writer, moves, written: Written) -> bool:
    """Write a temporary file; return whether it was written."""
    stream, target = _is_stream(path), _target(path)
    # The suffix determines the format.
    name = f".bearingjax-{os.getpid()}-{len(moves)}{target.suffix.lower()}"
    temporary = path if stream else target.with_name(name)
    if not stream:
        moves.append((path, temporary, target))
    with _name_in_errors(path):
        try:
            writer(temporary)
        except Incomplete as error:
            written.failed.append((path, error))
        except (OSError, SceneError):
            raise
        except Exception as error:
            written.failed.append((path, error))
            if not stream:
                moves.pop()
                temporary.unlink(missing_ok=True)
            return False
        if not stream and target.exists():
            shutil.copymode(target, temporary)
    return True


@contextlib.contextmanager
def _name_in_errors(path: Path):
    """Add the file name to an OSError, which that of a full disk lacks."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise SceneError(f"{path}: cannot be written: {reason}") from error


def scene_files(source: str | Path, settings: Iterable[str] = ()) -> list[Path]:
    """Return the files that a scene reads: itself, tables, profiles, bearings of a
    rotor.

    Args: as `read_scene`.

    Raises:
        SceneError: If there is no such scene, or it cannot be read.
    """
    path = find_scene(source)
    data = parse_scene(path, settings)
    tables = (("cases", "file"), ("identify", "data"), ("select", "file"))
    owners = ((data.get(table), key) for table, key in tables)
    names = (text_of(one.get(key)) for one, key in owners if isinstance(one, dict))
    listed = [path.parent / name for name in names if isinstance(name, str)]
    named = *listed, *profile_files(data, path), *bearing_files(data, path)
    return [path, *(one for one in named if "\0" not in str(one))]  # refused later


def read_matrix(path: Path) -> np.ndarray:
    """Read a matrix of numbers.

    Args:
        path: A NumPy file (.npy), a MatrixMarket file (.mtx), or text with semicolons,
            commas or blanks between the numbers of a row.

    Raises:
        ValueError: If it cannot be read, or is no square matrix of real numbers; the
            message names the file.
    """
    ending = path.suffix.lower()
    try:
        check_regular(path)
        if ending == ".npy":
            found = np.load(path, allow_pickle=False)
        elif ending == ".mtx":
            from scipy.io import mmread

            read: Any = mmread(path)
            found = read.toarray() if hasattr(read, "toarray") else read
        else:
            found = _numbers(read_rows(path))
        if np.iscomplexobj(found):
            raise ValueError("has complex numbers; real ones are wanted")
        found = np.asarray(found, float)
        if found.ndim != 2 or found.shape[0] != found.shape[1]:
            raise ValueError(f"has the shape {found.shape}; a square is wanted")
        if not np.isfinite(found).all():
            row, column = np.argwhere(~np.isfinite(found))[0] + 1
            problem = f"row {row}, column {column} is {found[row - 1, column - 1]}"
            raise ValueError(f"{problem}; finite numbers are wanted")
    except OSError as error:
        raise ValueError(f"{path.name}: cannot be read: {error.strerror}") from error
    except (ValueError, TypeError, EOFError) as error:
        raise ValueError(f"{path.name}: {error}") from error
    return found


def _numbers(rows: Sequence[Line]) -> np.ndarray:
    """Return lines of numbers as an array."""
    found: list[list[float]] = []
    for line, cells in rows:
        try:
            found.append([float(cell.replace("−", "-")) for cell in cells])
        except ValueError as error:
            raise ValueError(f"line {line}: {error}") from error
        if len(found[-1]) != len(found[0]):
            problem = f"has {len(found[-1])} numbers, not {len(found[0])}"
            raise ValueError(f"line {line} {problem}")
    if not found:
        raise ValueError("has no numbers")
    return np.array(found)


def _target(path: Path) -> Path:
    """Resolve a symbolic link, so that the link itself is kept."""
    return Path(os.path.realpath(path))


def _is_stream(path: Path) -> bool:
    """Whether a path is a stream or a pipe, which is written to directly."""
    whole = Path(os.path.abspath(path))
    return str(whole).startswith(_STREAMS) or (
        whole.exists() and not whole.is_file() and not whole.is_dir()
    )


def _are_same(one: Path, other: Path) -> bool:
    """Whether two paths are the same file, by name or by a hard link."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return _target(one) == _target(other)

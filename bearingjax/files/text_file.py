"""Text files of other programs: their encoding, columns and decimal marks."""

import codecs
import csv
import os
import re
import stat
from collections.abc import Iterable, Sequence
from pathlib import Path

Line = tuple[int, list[str]]
"""Cells of a line, with its number."""

_COMMA = re.compile(r"\s*[-+−]?\d*,\d+(?:[eE][-+−]?\d+)?\s*")
_POINT = re.compile(r"\s*[-+−]?(?:\d+\.\d*|\.\d+)(?:[eE][-+−]?\d+)?\s*")
_THOUSANDS = re.compile(r"\s*[-+−]?[1-9]\d{0,2},\d{3}\s*")


def check_regular(path: Path) -> None:
    """Raise unless a path is that of a file that has an end.

    Raises:
        ValueError: For a name that is none, a file that is not there, a pipe or a
            device; the message does not name the file, which the caller adds.
    """
    try:
        mode = os.stat(path).st_mode
    except OSError as error:
        raise ValueError(f"cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise ValueError("cannot be read: a file name has no NUL") from error
    if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
        raise ValueError("cannot be read: it is a pipe or a device; name a file")


def read_text(path: Path) -> str:
    """Read a text in UTF-8, or in UTF-16 if it begins with a byte order mark, as Excel
    and Windows write it.

    Raises:
        ValueError: As `check_regular`; if it is a folder or of another encoding.
    """
    check_regular(path)
    try:
        content = path.read_bytes()
        marked = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        text = content.decode("utf-16" if marked else "utf-8-sig")
    except OSError as error:
        raise ValueError(f"cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"cannot be read: {error}; save it as UTF-8") from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_columns(path: Path) -> list[Line]:
    """Read the lines of a table with a header, but for empty ones.

    Commas, semicolons or tabs part the columns, as in the header or as a first line
    "sep=;" says. Where they are no commas, numbers may have decimal commas; they are
    returned with points.

    Raises:
        ValueError: As `read_text`; if a number has a comma of two meanings.
    """
    lines = read_text(path).split("\n")
    told = re.fullmatch(r'"?sep=(.)"?', lines[0], re.IGNORECASE)
    if told:
        lines[0] = ""
    head = next((line for line in lines if line.strip()), "")
    mark = told[1] if told else next((m for m in ";\t," if m in head), "")
    try:
        # Under a header of one column a comma is that of a number.
        reader = csv.reader(lines, delimiter=mark or ";")
        rows = [(reader.line_num, row) for row in reader if any(map(str.strip, row))]
    except csv.Error as error:
        raise ValueError(f"cannot be read: {error}") from error
    return rows if mark == "," else [*_with_points(rows, mark == ";")]


def read_rows(path: Path) -> list[Line]:
    """Read the lines of a table of numbers, but for empty ones and comments (#).

    Semicolons, commas, or blanks part the numbers; decimal commas are those that blanks
    do not follow in a table with blanks, and those beside semicolons.

    Raises: as `read_columns`.
    """
    texts = [line.partition("#")[0] for line in read_text(path).split("\n")]
    ended = [text.strip().rstrip(",;").rstrip() for text in texts]
    lines = [(k, text) for k, text in enumerate(ended, 1) if text]
    whole = "\n".join(text for _, text in lines)
    if ";" in whole:
        return [*_with_points([(k, text.split(";")) for k, text in lines], True)]
    if "," in whole and not re.search(r",\d[^\s,]*[ \t]+[-+.\d]", whole):
        return [(k, text.split(",")) for k, text in lines]
    return [*_with_points([(k, text.split()) for k, text in lines], False)]


def _with_points(rows: Sequence[Line], sure: bool) -> Iterable[Line]:
    """Replace decimal commas by points.

    Args:
        rows: Lines.
        sure: Whether the file shows by its semicolons that commas are decimal.
    """
    cells = [(k, cell) for k, row in rows for cell in row]
    commas = [(k, cell) for k, cell in cells if _COMMA.fullmatch(cell)]
    points = [(k, cell) for k, cell in cells if _POINT.fullmatch(cell)]
    if commas and points:
        (one, comma), (other, point) = commas[0], points[0]
        raise ValueError(
            f"line {one} has a decimal comma, {comma.strip()!r}, and line {other} a"
            f" decimal point, {point.strip()!r}; write points"
        )
    if commas and not sure and all(_THOUSANDS.fullmatch(cell) for _, cell in commas):
        k, cell = commas[0]
        raise ValueError(
            f"line {k}: the comma of {cell.strip()!r} may be a decimal one or part"
            " thousands; write a decimal point, and no thousands"
        )
    for k, row in rows:
        yield k, [c.replace(",", ".") if _COMMA.fullmatch(c) else c for c in row]

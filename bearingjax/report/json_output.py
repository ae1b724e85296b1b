"""Numbers of runs as JSON, in SI."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._version import __version__


def write_numbers(path: str | Path, numbers: Mapping[str, Any]) -> None:
    """Write plain numbers and lists as JSON; non-finite numbers become null.

    Raises:
        OSError: If the file cannot be written.
    """
    text = json.dumps(to_json(numbers), indent=1, allow_nan=False)
    Path(path).write_text(text + "\n", encoding="utf-8")


def to_json(value: Any) -> Any:
    """Return what the JSON has: lists for arrays, `None` for non-finite numbers.

    Args:
        value: A number, an array, a word or `None`, or tables and lists of these.
    """
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return {key: to_json(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [to_json(inner) for inner in value]
    values = np.asarray(value)
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        finite, values = np.isfinite(values), values.astype(object)
        values[~finite] = None
    return values.tolist()


def run_json(
    numbers: Mapping[str, Any], warnings: Iterable[str], inputs: dict[str, Any]
) -> dict[str, Any]:
    """Return the JSON of a run.

    Args:
        numbers: Its numbers and status, as `to_json` takes them.
        warnings: Its warnings.
        inputs: The scene as it was read.
    """
    common = {"warnings": list(warnings), "inputs": inputs, "version": __version__}
    return {**to_json(numbers), **common}

"""Differences between the cases of a scene, in words."""

from collections import Counter

import numpy as np

from ...cases.sweep_table import case_columns
from ...numerics.units import shown_number
from .read_cases import CaseTable
from .sweep_run import design_columns

_LONGEST = 24
"""Most characters shown of a text setting, such as a list of profiles."""


def varied_settings(table: CaseTable) -> dict[str, np.ndarray]:
    """Return the quantities that differ between the cases of a scene, except hours.

    Returns:
        Values (case,) by "name [unit]": loads, displacements, speeds, and settings of
        the design, numbers in SI.
    """
    found = case_columns(table.cases) | design_columns(table)
    return {
        header: values
        for header, values in found.items()
        if header not in ("design", "hours [h]") and len(set(values.tolist())) > 1
    }


def case_words(found: dict[str, np.ndarray], case: int) -> list[str]:
    """Describe the settings that distinguish a case, one each: "Fy -2.5 kN".

    Args:
        found: From `varied_settings`.
        case: Number of the case.
    """
    names = [header.partition(" [")[0] for header in found]
    ends = Counter(map(_end, names))
    words = []
    for name, (header, values) in zip(names, found.items(), strict=True):
        short = _end(name) if ends[_end(name)] == 1 else name
        unit = header.partition(" [")[2].rstrip("]")
        value = values[case].item()
        if isinstance(value, str):
            text = value if len(value) <= _LONGEST else f"{value[: _LONGEST - 1]}…"
        else:
            text = shown_number(value, unit)
        words.append(f"{short.replace('_', ' ')} {text}")
    return words


def _end(name: str) -> str:
    """Return the last part of a dotted key, without `prescribed_`."""
    return name.rpartition(".")[2].removeprefix("prescribed_")

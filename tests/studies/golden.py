"""Golden files: what a run wrote as JSON, in few numbers, to see whatever moves them.

`python -m pytest tests/studies -m "" -k golden --write-golden` writes them anew. A
number that moves on purpose is written anew in the commit that moves it, which says
why. They hold on the kind of machine that wrote them, see `machine`: elsewhere write
them on the commit before, and compare.
"""

import hashlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

import jax
import numpy as np

from bearingjax.numerics.compiled.programs import _processor

FOLDER = Path(__file__).with_name("golden_files")
LEFT_OUT = frozenset({"version", "residual", "iterations", "steps", "seconds", "data"})
LEFT_OUT |= {"excluded", "counts"}
"""Keys whose values depend on the machine, on round-off or on all of the catalogue, or
are paths."""
SHORT = 6
"""Numbers of a list that stand in the file one by one."""
TOLERANCE = 1e-9


MACHINE = FOLDER / "machine.txt"


def machine() -> str:
    """The release of JAX, and a digest of the processor.

    Another processor, or another release, sums in another order. Motions in time and
    optimised designs then differ by far more than round-off: with the instructions of
    SSE4.2 in place of AVX2 the cage force of `skid_axial` moves by some per cent.
    """
    return f"{jax.__version__} {hashlib.sha256(_processor().encode()).hexdigest()}\n"


def digest(value: Any, path: str = "") -> dict[str, Any]:
    """What stands in the golden file of a JSON value, by path.

    A long array of numbers is its shape, its norm, its product with fixed weights and
    the number of entries that are null: one entry that moves moves the product.
    """
    if isinstance(value, dict):
        found = {}
        for key in sorted(set(value) - LEFT_OUT):
            found |= digest(value[key], f"{path}.{key}" if path else key)
        return found
    if isinstance(value, float):
        return {path: float(f"{value:.13g}")}
    if not isinstance(value, list) or not value:
        return {path: value}
    if all(isinstance(one, str) for one in value):
        several = len(value) > SHORT and len(set(value)) <= SHORT
        return {path: dict(sorted(Counter(value).items())) if several else value}
    try:
        numbers = np.array(value, float)  # null is NaN
    except (TypeError, ValueError):
        found = {}
        for k, one in enumerate(value):
            found |= digest(one, f"{path}[{k}]")
        return found
    if numbers.size <= SHORT:
        return {
            path: [None if np.isnan(x) else float(f"{x:.13g}") for x in numbers.flat]
        }
    known = np.nan_to_num(numbers.ravel())
    weights = np.cos(np.arange(1.0, known.size + 1.0))
    of_all = float(np.linalg.norm(known)), float(known @ weights)
    return {
        path: {
            "shape": list(numbers.shape),
            "null": int(np.isnan(numbers).sum()),
            "numbers": [float(f"{x:.13g}") for x in of_all],
        }
    }


def differences(found: dict[str, Any], kept: dict[str, Any]) -> list[str]:
    """Lines that name what differs from the golden file, with both values."""
    return [
        f"{path}: {kept.get(path, 'absent')!r} is now {found.get(path, 'absent')!r}"
        for path in sorted(set(found) | set(kept))
        if path not in found or path not in kept or not agree(found[path], kept[path])
    ]


def agree(one: Any, other: Any) -> bool:
    """Whether two entries are equal but for round-off, lists by their largest."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(agree(one[k], other[k]) for k in one)
    pair = [x if isinstance(x, list) else [x] for x in (one, other)]
    numbers = [[x for x in some if _is_number(x)] for some in pair]
    if [_is_number(x) for x in pair[0]] != [_is_number(x) for x in pair[1]]:
        return False
    if [x for x in pair[0] if not _is_number(x)] != [
        x for x in pair[1] if not _is_number(x)
    ]:
        return False
    size = max((abs(x) for some in numbers for x in some), default=0.0)
    return all(abs(a - b) <= TOLERANCE * size for a, b in zip(*numbers, strict=True))


def _is_number(value):
    return isinstance(value, int | float) and not isinstance(value, bool)


def read(name: str) -> dict[str, Any]:
    """Entries of a golden file, by path."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def write(name: str, entries: dict[str, Any]) -> None:
    """Write a golden file, a line for each path."""
    lines = [
        f"{json.dumps(k)}: {json.dumps(v, ensure_ascii=False)}"
        for k, v in entries.items()
    ]
    text = "{\n" + ",\n".join(lines) + "\n}\n"
    (FOLDER / f"{name}.json").write_text(text, encoding="utf-8")
    MACHINE.write_text(machine(), encoding="utf-8")

"""Command line, tables, pictures, clocks and verdicts of the benchmarks.

Importing it turns float64 on, and lets scripts import what the tests share.
"""

import argparse
import inspect
import json
import os
import random
import re
import resource
import string
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

jax.config.update("jax_enable_x64", True)
sys.path.append(str(Path(__file__).parent.parent / "tests"))


def benchmark(
    small: str = "a small version",
    show: Callable | None = None,
    plot: Callable | None = None,
    wrong: Callable[[Any], Any] | None = None,
    **notes: str | dict,
) -> Callable[[Callable], Callable]:
    """Make a function the command line of its script, and run it there.

    Its parameters are the options, by their names and defaults (`False`: a switch);
    `smoke` is the first. What it returns or yields (the first item of a tuple) is
    printed as JSON, a line for each row of a list; with `show` only under `--json`. It
    returns `None`, or whether all is well, if it has printed everything itself.

    Args:
        small: What `--smoke` runs.
        show: Prints the result (of a tuple, all items are its arguments).
        plot: Gets the same and returns the figure that `--plot` writes, or several by
            what is put behind the name of the file.
        wrong: Gets the same; what is wrong, if anything, printed before exit status 1.
        **notes: Help of an option, or what argparse takes.
    """

    def run(main: Callable) -> Callable:
        if main.__module__ == "__main__":
            sys.exit(_run(main, {"smoke": small, **notes}, show, plot, wrong))
        return main

    return run


def _run(main, notes, show, plot, wrong):
    question = main.__globals__["__doc__"].splitlines()[0]
    parser = argparse.ArgumentParser(description=question)
    if show:
        parser.add_argument("--json", action="store_true", help="figures as JSON")
    if plot:
        parser.add_argument("--plot", metavar="OUT", type=Path, help="write a picture")
    for name, option in inspect.signature(main).parameters.items():
        note = notes.get(name, "default: %(default)s")
        kind = {"action": "store_true"}
        if name != "smoke" and option.default is not False:
            of = option.default
            kind = {"default": of, "type": str if of is None else type(of)}
            if isinstance(of, list):
                kind |= {"nargs": "+", "type": type(of[0])}
        kind |= {"help": note} if isinstance(note, str) else note
        parser.add_argument(f"--{name}", **kind)
    given = vars(parser.parse_args())
    as_json, target = not show or given.pop("json"), plot and given.pop("plot")
    result = main(**given)
    if isinstance(result, np.bool_):
        result = bool(result)
    told = result if isinstance(result, tuple) else (result,)
    if told[0] is None or isinstance(told[0], bool):
        print(machine())
    elif not as_json:
        show(*told)
        print(f"\n{machine()}")
    else:
        rows = told[0]
        for row in [rows] if isinstance(rows, Mapping) else rows:
            print(json.dumps(row), flush=True)
    if target:
        drawn = plot(*told)
        for name, figure in (drawn if isinstance(drawn, dict) else {"": drawn}).items():
            end = f"_{name}{target.suffix or '.png'}" if name else target.suffix
            figure.savefig(target.with_name(target.stem + end), dpi=figure.dpi)
    fault = wrong and wrong(*told)
    if fault:
        print(f"{parser.prog}: {fault}", file=sys.stderr)
    return int(bool(fault) or told[0] is False)


def no_rows_with(*keys: str) -> Callable[[Iterable[dict]], None]:
    """Return a function that prints rows as they come, then sums of counts to be zero.

    Args:
        keys: Of the counts in a row, or of lists that are to be empty.
    """

    def show(rows):
        sums = dict.fromkeys(keys, 0)
        for row in rows:
            print(json.dumps(row), flush=True)
            for key in keys:
                found = row.get(key, 0)
                sums[key] += len(found) if isinstance(found, list) else int(found)
        for key, count in sums.items():
            print(verdict(key.replace("_", " "), count, 0))

    return show


class _Cells(string.Formatter):
    def format_field(self, value, format_spec):
        return "-" if value is None else super().format_field(value, format_spec)


def table(rows: Iterable[Any], columns: Mapping[str, str]) -> None:
    """Print rows of figures.

    Args:
        rows: Dicts.
        columns: Format of the cells by heading, as "{error:.0e}"; text ("{name}")
            stands left, and "-" for `None`.
    """
    cell = _Cells().format
    cells = [[cell(form, **row) for form in columns.values()] for row in rows]
    sides = ["<" if ":" not in form else ">" for form in columns.values()]
    widths = [max(map(len, c)) for c in zip(columns, *cells, strict=True)]
    for line in (columns, *cells):
        shown = zip(line, sides, widths, strict=True)
        print("  ".join(f"{c:{side}{w}}" for c, side, w in shown).rstrip())


def subplots(*shape: int, **more: Any) -> tuple[Any, Any]:
    """Figure, drawn without a window, and its axes."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(*shape, **{"layout": "tight", "dpi": 150} | more)
    for axis in np.ravel(axes):
        axis.grid(alpha=0.3)
        axis.spines[["top", "right"]].set_visible(False)
    return figure, axes


def shades(shares: Any) -> Any:
    """Colours of the map viridis."""
    from matplotlib import colormaps

    return colormaps["viridis"](shares)


def slopes_beside(
    value: Callable[[Any], Any],
    slopes: Any,
    steps: Sequence[float],
    sizes: Any,
    places: Iterable[int],
    order: int = 4,
) -> Iterator[tuple[int, np.ndarray]]:
    """Least error of derivatives beside central differences, over steps that form a V.

    Args:
        value: Results (m,) of relative changes (n,) of numbers.
        slopes: Their derivatives at no change (m, n), by autodiff.
        steps: Of the differences.
        sizes: What errors are measured by where it is more than a derivative (m,).
        places: Which of the n numbers.
        order: Of the differences, 2 or 4.

    Yields:
        The number and the errors of the m results by it.
    """
    none = jnp.zeros(np.shape(slopes)[1])
    for k in places:
        least = np.full(len(slopes), np.inf)
        for step in steps:

            def apart(times, k=k, step=step):
                ends = [value(none.at[k].set(s * times * step)) for s in (1, -1)]
                return np.asarray(ends[0]) - np.asarray(ends[1])

            slope = apart(1) / (2.0 * step)
            if order == 4:
                slope = (8.0 * apart(1) - apart(2)) / (12.0 * step)
            scale = np.maximum(np.abs(slopes[:, k]), sizes)
            least = np.fmin(least, np.abs(slope - slopes[:, k]) / scale)
        yield k, least


def processor() -> str:
    """Model of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return "processor unknown"
    return next((x.split(": ")[1] for x in lines if "model name" in x), "unknown")


def machine() -> str:
    """Processor, cores, devices, and how busy others keep them."""
    load = os.getloadavg()[0]
    devices = jax.devices()
    return (
        f"{processor()}, {os.cpu_count()} cores, load average {load:.1f}; devices:"
        f" {len(devices)} {devices[0].device_kind}; jax {jax.__version__}"
    )


def timed(call: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds that a call takes until its result is there, and the result."""
    begin = time.perf_counter()
    out = jax.block_until_ready(call())
    return time.perf_counter() - begin, out


def shuffled(
    calls: dict[Any, Callable[[], Any]], rounds: int, seed: int = 0, warm: bool = True
) -> dict[Any, list[float]]:
    """Seconds of every call, in shuffled order.

    Args:
        calls: By name; compiled.
        rounds: How often each is timed.
        seed: Of the order.
        warm: Whether each is called once before.
    """
    rng = random.Random(seed)
    found: dict[Any, list[float]] = {name: [] for name in calls}
    if warm:
        for call in calls.values():
            timed(call)
    order = list(calls)
    for _ in range(rounds):
        rng.shuffle(order)
        for name in order:
            found[name].append(timed(calls[name])[0])
    return found


def compiled(function: Callable, *arguments) -> tuple[Any, float]:
    """A function compiled for its arguments, and seconds of tracing and compiling."""
    begin = time.perf_counter()
    program = jax.jit(function).lower(*arguments).compile()
    return program, time.perf_counter() - begin


def peak_memory() -> float:
    """Most memory that this process has held [GiB]."""
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return used / (2**30 if sys.platform == "darwin" else 2**20)


def relative(got: Any, want: Any) -> float:
    """Largest difference relative to the largest number wanted."""
    got, want = np.asarray(got), np.asarray(want)
    return float(np.max(np.abs(got - want)) / np.max(np.abs(want)))


def verdict(what: str, figure: float, goal: float, most: bool = True) -> str:
    """One line: a figure beside its goal, and whether it is met.

    Args:
        what: What is measured, with its unit.
        figure: Measured.
        goal: Wanted.
        most: Whether the goal is an upper bound.
    """
    met = figure <= goal if most else figure >= goal
    sign = "at most" if most else "at least"
    return f"{what}: {figure:.3g} ({sign} {goal:g}): {'met' if met else 'MISSED'}"


def readme(text: str) -> str:
    """The README, each row of a script as the script's docstring has it.

    Its question is the first sentence. Figure, goal and whether it is met stand behind
    "README:", a bar between them; of a second row an option of the script stands before
    the colon, and its question behind.
    """

    def row(found):
        script, option = found.groups()
        words = Path(__file__).with_name(script).read_text()
        told = re.search(rf'^README{option}: (.*?)\n(\n|""")', words, re.M | re.S)
        cells = " ".join(told[1].split()).split(" | ") if told else []
        if not option:
            cells.insert(0, words[3:].split("?")[0] + "?")
        cells = [cell.strip(" |") for cell in (*cells, "", "")[:4]]
        cells.insert(1, f"[`{script}`]({script}){option}")
        return "| " + " | ".join(cells) + " |"

    return re.sub(r"^\|.*\[`(\w+\.py)`\]\(\1\)(.*?) \|.*$", row, text, flags=re.M)


if __name__ == "__main__":
    README = Path(__file__).with_name("README.md")
    README.write_text(readme(README.read_text()))

"""Plots of the results of a sweep over its inputs."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..cases.sweep import Sweep
from ..cases.sweep_table import columns
from ..numerics.units import display_unit
from .panel import finish
from .style import CURVES, SMALL, Figure, head, new_page, power_of_ten, without_offset

_MOST_RESULTS = 9
_NO_RESULTS = ("design", "iterations", "residual", "hours [h]")
_NUMBER = "case"
_MOST_NAMES, _LETTERS = 30, 40
"""Most names along an axis, and most letters of them before they stand upright."""
Names = Mapping[str, Sequence[str]]
"""Names that an input takes, by its header: its numbers count them."""


class _Curve(NamedTuple):
    """Abscissae, cases, number of the colour, and name ("": none) of a curve."""

    along: np.ndarray
    cases: np.ndarray
    colour: int
    name: str


def sweep_overview(
    solved: Sweep,
    extra: Mapping[str, np.ndarray] | None = None,
    title: str = "",
) -> Figure:
    """Plot the first nine results that differ from case to case.

    For a grid, results are over the input with most values, a curve for each setting
    of the others; its colour marks the first of them with at most six values. Other
    cases are over the names that tell them apart, else over their number. Cases that
    were not solved are left out, and so are prescribed quantities.

    Args:
        solved: From `sweep`, with a case solved.
        extra: Inputs that make the designs, as in `columns`.
        title: Head of the page; "Sweep" if empty.

    Returns:
        The figure, 5 inches wide for each of at most three columns.
    """
    found = columns(solved, extra)
    names = list(found)
    split = names.index("result")
    good = solved.converged
    given, named = _counted({name: found[name] for name in names[:split]})
    inputs = _varying_columns(given, good)
    results = _varying_columns({name: found[name] for name in names[split + 1 :]}, good)
    results = {
        name: values
        for name, values in results.items()
        if not any(
            np.allclose(values, x, atol=0.0, equal_nan=True) for x in inputs.values()
        )
    }
    shown = list(results.items())[:_MOST_RESULTS]
    across = 2 if len(shown) == 4 else max(1, min(3, len(shown)))
    down = max(1, -(-len(shown) // across))
    figure = new_page(5.0 * across, 0.8 + 3.4 * down, 0.1)
    label, note, curves = _curves(inputs, good, named)
    ticks = named.get(label, ())
    upright = 90 * (sum(map(len, ticks)) > _LETTERS)
    for k, (header, values) in enumerate(shown):
        ax = without_offset(figure.add_subplot(down, across, k + 1))
        words, scale = _display(header, values)
        number, many = label == _NUMBER, len(good) > 60
        look: Any = {"linewidth": 1.0, "markersize": 3.0 if many else 7.0}
        for curve in curves:
            y, style = scale * values[curve.cases], "." if number or ticks else ".-"
            colour = CURVES[curve.colour]
            ax.plot(curve.along, y, style, color=colour, label=curve.name, **look)
        finish(ax, words, label)
        ax.title.set_fontsize(11)
        if ticks:
            every = slice(None, None, -(-len(ticks) // _MOST_NAMES))
            places = np.arange(len(ticks))[every]
            ax.set_xticks(places, ticks[every], rotation=upright, fontsize=SMALL)
        elif number:
            ax.locator_params(axis="x", integer=True)
        if k == 0 and any(curve.name for curve in curves):
            # Curves of one colour are listed once.
            handles = dict(zip(*reversed(ax.get_legend_handles_labels()), strict=True))
            figure.legend(
                handles.values(),
                handles.keys(),
                loc="outside lower center",
                ncols=min(3, len(handles)),
                fontsize=SMALL,
                title=f"curves of one colour: {note}" if note else None,
                title_fontsize=SMALL,
            )
        elif k == 0 and note:
            figure.supxlabel(f"each curve: {note}", fontsize=SMALL)
    if not shown:
        figure.text(0.5, 0.5, "no result differs from case to case", ha="center")
    head(figure, title or "Sweep")
    return figure


def _counted(given) -> tuple[dict[str, np.ndarray], Names]:
    """Inputs with names counted from 0 in their order, and these names by header."""
    named = {
        header: tuple(dict.fromkeys(map(str, column)))
        for header, column in given.items()
        if np.asarray(column).dtype.kind not in "biuf"
    }
    counted = {
        header: np.array([named[header].index(str(one)) for one in column])
        for header, column in given.items()
        if header in named
    }
    return {**given, **counted}, named


def _varying_columns(found, good) -> dict[str, np.ndarray]:
    """Columns of numbers that differ over the cases by more than round-off, which is
    told from the largest number of their unit."""
    kept, largest = {}, {}
    for header, column in found.items():
        values = np.asarray(column)
        if values.dtype.kind not in "fi" or header in _NO_RESULTS:
            continue
        values = np.where(good & np.isfinite(values), values.astype(float), np.nan)
        if np.isfinite(values).any():
            kept[header] = values
            unit = _unit(header)
            size = float(np.nanmax(np.abs(values)))
            largest[unit] = max(largest.get(unit, 0.0), size)
    return {
        header: values
        for header, values in kept.items()
        if np.nanmax(values) - np.nanmin(values) > 1e-9 * largest[_unit(header)]
    }


def _curves(inputs, good, named: Names) -> tuple[str, str, list[_Curve]]:
    """Return the label of the abscissa, a note on inputs that neither it nor colours
    tell, and the curves."""
    solved = np.flatnonzero(good)
    by_number = _NUMBER, "", [_Curve(solved, solved, 0, "")]
    if not inputs:
        return by_number
    counts = {name: len(np.unique(x[solved])) for name, x in inputs.items()}
    along = max(counts, key=lambda name: counts[name])
    apart = [name for name in named if counts.get(name) == len(solved)]
    along = (apart or [along])[0]
    x = inputs[along]
    others = [pair for pair in inputs.items() if pair[0] != along]
    if apart:
        rest = ", ".join(_span(n, x, named) for n, x in others)
        return along, rest, [_Curve(x[solved], solved, 0, "")]
    kind = np.zeros(len(solved), int)
    if others:
        settings = np.array([values[solved] for _, values in others])
        _, kind = np.unique(settings.T, axis=0, return_inverse=True)
        kind = kind.reshape(-1)
    groups = [solved[kind == k] for k in range(kind.max() + 1)]
    if not all(len(set(x[mine])) == len(mine) > 1 for mine in groups):
        return by_number
    words, scale = _display(along, x)
    name, values, kinds = _colouring(others, solved)
    curves = []
    for mine in groups:
        rising = mine[np.argsort(x[mine])]
        colour = int(np.searchsorted(kinds, values[mine[0]])) if name else 0
        text, factor = _display(name, values) if name else ("", 0.0)
        value = factor * values[mine[0]] if name else 0.0
        told = named[name][int(value)] if name in named else f"{value:.4g}"
        name_and_value = f"{text}: {told}" if name else ""
        curves.append(_Curve(scale * x[rising], rising, colour, name_and_value))
    rest = ", ".join(_span(n, x, named) for n, x in others if n != name)
    return words, rest, curves


def _span(header, values, named: Names):
    """Return the name of an input, and its least and largest value, as text."""
    if header in named:
        return f"{header} from {named[header][0]} to {named[header][-1]}"
    words, scale = _display(header, values)
    low, high = scale * np.nanmin(values), scale * np.nanmax(values)
    name = words.partition(" [")[0]
    return f"{name} from {low:.4g} to {high:.4g} {_unit(words)}".rstrip()


def _colouring(others, solved):
    """Header, values and kinds of the input that colours tell; "" if there is none."""
    for header, values in others:
        kinds = np.unique(values[solved])
        if len(kinds) <= len(CURVES):
            return header, values, kinds
    return "", np.zeros(0), np.zeros(0)


def _unit(header):
    return header.partition(" [")[2].rstrip("]")


def _display(header, values) -> tuple[str, float]:
    """Return the header with its display unit, and the factor to it."""
    name = header.partition(" [")[0]
    largest = float(np.nanmax(np.abs(values)))
    scale, shown = display_unit(_unit(header), largest)
    factor, power = power_of_ten(scale * largest)
    unit = " ".join(word for word in (power, shown) if word)
    return (f"{name} [{unit}]" if unit else name), scale * factor

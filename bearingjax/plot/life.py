"""Lives and damage of the cases of a load spectrum."""

import textwrap
from typing import Any

import numpy as np

from .panel import finish
from .style import COLOURS, GREY, ROLLER, SMALL, Figure, head, new_page, write_foot

_MOST = 16
"""Most cases drawn."""
_RANGE = 1e5
"""Life over the shortest above which bars are cut off [1]."""
_NAMED = 5
"""Most cases with their distinguishing settings below."""
_ACROSS, _DOWN = 65, 7
"""Most letters in a line under a plot, and most lines of settings of a case."""

_COLOURS = {
    "basic_rating_life": GREY,
    "reference_rating_life": COLOURS["outer"],
    "modified_rating_life": ROLLER,
}


def life_overview(run: Any, title: str = "") -> Figure:
    """Plot the life of every case alone, and its share in time and damage.

    Of many cases those that use most of the life.

    Args:
        run: From `run_life`, with all cases solved.
        title: Head of the page; "Rating life" if empty.

    Returns:
        The figure, 12 by 6 inches.
    """
    figure = new_page(12.0, 6.0)
    parts: Any = figure.subfigures(2, 1, height_ratios=[5.4, 0.6])
    upper, foot = parts
    left, right = upper.subplots(1, 2)
    order = np.sort(run.worst_cases(_MOST)[0])
    _lives(run, order, left)
    _shares(run, order, right)
    write_foot(foot, _results(run))
    head(figure, title or "Rating life")
    return figure


def _lives(run, order, ax):
    """Plot the life of each case alone, in million revolutions."""
    width = 0.8 / len(run.lives)
    every = {
        name: 1e-6 * np.asarray(getattr(run.solved, name), dtype=float)[order]
        for name in run.lives
    }
    known = np.concatenate(list(every.values()))
    known = known[np.isfinite(known)]
    # A case that hardly loads the bearing would squash all others.
    most = known[known <= _RANGE * known.min(initial=np.inf)].max(initial=0.0)
    top = 10.0 * most if most > 0.0 else 1.0
    for k, (name, alone) in enumerate(every.items()):
        beyond = ~(alone <= top)
        drawn = ax.bar(
            np.arange(len(order)) + (k - 0.5 * (len(run.lives) - 1)) * width,
            np.where(beyond, top, alone),
            width,
            color=_COLOURS[name],
            label=_word(name),
        )
        words = [f"{x:.1e}" if np.isfinite(x) else "no end" for x in alone]
        labels = [word if far else "" for word, far in zip(words, beyond, strict=True)]
        ax.bar_label(drawn, labels, fontsize=SMALL, rotation=90, padding=2)
    ax.set_yscale("log")
    if known.size:
        highest = top if any(~(x <= top).all() for x in every.values()) else most
        ax.set_ylim(0.3 * known.min(), 10.0 * highest)  # room for labels and legend
    title, of = "Life of each case, if it were alone", "life [million revolutions]"
    _finish(run, order, ax, title, of)
    ax.legend(fontsize=SMALL, ncols=len(every), loc="upper right")


def _shares(run, order, ax):
    """Plot shares of the cases in time, and in damage, in percent."""
    hours, damage = run.table.cases.hours, run.asked.damage_share
    count = run.table.cases.count
    time = np.ones(count) if hours is None else np.asarray(hours, dtype=float)
    bars = (
        ("time", time / time.sum(), GREY),
        (f"damage ({run.asked_name} life)", np.asarray(damage), COLOURS["inner"]),
    )
    for side, (label, share, colour) in zip((-0.2, 0.2), bars, strict=True):
        drawn = ax.bar(
            np.arange(len(order)) + side,
            100.0 * share[order],
            0.38,
            color=colour,
            label=label,
        )
        if len(order) <= 8:
            ax.bar_label(drawn, fmt="%.3g", fontsize=SMALL, padding=2)
    ax.margins(y=0.25)  # room for the legend above all bars
    _finish(run, order, ax, "Shares of the cases", "share [%]")
    ax.legend(fontsize=SMALL, ncols=2, loc="upper center")


def _finish(run, order, ax, title, of):
    left = run.table.cases.count - len(order)
    names = [str(k) for k in order]
    if len(order) <= _NAMED:
        across = _ACROSS // len(order)
        names = [_name_case(k, run.words(int(k)), across) for k in order]
    ax.set_xticks(np.arange(len(order)), names, fontsize=SMALL)
    over = f"case (the worst; {left} more are not drawn)" if left else "case"
    finish(ax, title, over, of, axis="y")
    ax.legend(fontsize=SMALL)


def _name_case(case, words, across: int) -> str:
    """Return the number of a case and its settings, in lines of limited width."""
    lines = []
    for k, word in enumerate(words):
        new = textwrap.wrap(word, across, break_on_hyphens=False)
        if len(lines) + len(new) + (k < len(words) - 1) > _DOWN:
            lines.append(f"and {len(words) - k} more")
            break
        lines += new
    return "\n".join([str(case), *lines])


def _results(run: Any) -> str:
    """Return two lines of text: the lives under all cases; load and static safety."""
    lives = []
    for name, life in run.lives.items():
        words = f"{_word(name)} {1e-6 * float(life.rating_life):.4g} million rev"
        if life.life_hours is not None:
            words += f" = {float(life.life_hours):.5g} h"
        lives.append(words)
    rated = run.ratings
    source = run.origins.get("dynamic_capacity", rated.dynamic_source)
    return (
        f"under all cases:  {';  '.join(lives)}\n"
        f"C {1e-3 * float(rated.dynamic_capacity):.4g} kN ({source}),  "
        f"least static safety {run.least_safety()}"
    )


def _word(name):
    return name.removesuffix("_rating_life")

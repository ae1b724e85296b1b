"""A chart as data: which quantity over what, grouped by what; drawn in one place.

A `Panel` has its numbers in SI. Their labels, display units and scales come from its
`Axis`, which knows the unit from the metadata of a result's field. A function that
returns a panel becomes a plot by `@chart`.
"""

import dataclasses
import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ParamSpec

import numpy as np

from ..numerics.units import display_unit, unit_of
from .style import CURVES, OUTER, SMALL, Ax, Axes, axes_or_new, without_offset

P = ParamSpec("P")
NEWTONS = 1.0, "N"
MM = 1e3, "mm"
"""Factors from SI and units, of small forces and of places in a drawing."""


@dataclasses.dataclass(frozen=True)
class Axis:
    """Quantity along an axis.

    Attributes:
        name: Its name.
        unit: SI unit; empty for a pure number.
        shown: Factor from SI and the displayed unit; default: `display_unit`.
    """

    name: str
    unit: str = ""
    shown: tuple[float, str] | None = None

    @classmethod
    def from_field(
        cls, result: Any, field: str, shown: tuple[float, str] | None = None
    ) -> "Axis":
        """Return the axis of a field of a result, with the unit of its metadata."""
        return cls(field.replace("_", " "), unit_of(result, field), shown)

    @property
    def scale(self) -> float:
        """Factor from SI to the displayed unit."""
        return (self.shown or display_unit(self.unit))[0]

    @property
    def shown_unit(self) -> str:
        """Displayed unit."""
        return (self.shown or display_unit(self.unit))[1]

    @property
    def label(self) -> str:
        """Name and displayed unit."""
        return f"{self.name} [{self.shown_unit}]" if self.shown_unit else self.name


ALONG = Axis("position along the roller", "m", MM)
PRESSURE = Axis("contact pressure", "Pa")


@dataclasses.dataclass(frozen=True)
class Curve:
    """Line through points, or the band between two lines.

    Attributes:
        x, y: Coordinates (point,) [SI].
        label: Label of the legend; empty or with a leading underscore: none.
        colour, style: As Matplotlib takes them.
        look: Further keywords of Matplotlib's `plot`, or `fill_between`.
        to: Other edge of a band (point,) [SI]; `None`: a line.
    """

    x: Any
    y: Any
    label: str = ""
    colour: Any = OUTER
    style: str = "-"
    look: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    to: Any = None

    def draw(self, ax: Axes, across: float, up: float) -> None:
        """Draw the curve, in the units displayed."""
        x, y = across * np.asarray(self.x, float), up * np.asarray(self.y, float)
        if self.to is not None:
            other = up * np.asarray(self.to, float)
            ax.fill_between(x, y, other, color=self.colour, linewidth=0, **self.look)
            return
        more = {"label": self.label} if self.label else {}
        ax.plot(x, y, self.style, color=self.colour, **more, **self.look)


@dataclasses.dataclass(frozen=True)
class Bars:
    """Bars of one colour, at places numbered from 0.

    Attributes:
        heights: (place,) [SI].
        label: Label of the legend.
        colour: As Matplotlib takes it, one or one for each.
        away: Distance of their middles from the places [1].
        width: Width of each [1].
        told: Format of the number above each, or the words; `None`: none.
        look: Further keywords of Matplotlib's `bar_label`.
    """

    heights: Any
    label: str = ""
    colour: Any = OUTER
    away: float = 0.0
    width: float = 0.8
    labels: Any = None
    look: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    def draw(self, ax: Axes, across: float, up: float) -> None:
        """Draw the bars, in the unit displayed."""
        heights = up * np.asarray(self.heights, float)
        places = np.arange(len(heights)) + self.away
        more: Any = {"label": self.label} if self.label else {}
        bars = ax.bar(places, heights, self.width, color=self.colour, **more)
        if self.labels is not None:
            words = isinstance(self.labels, list)
            text = {"labels": self.labels} if words else {"fmt": self.labels}
            ax.bar_label(bars, **text, fontsize=SMALL, **{"padding": 2, **self.look})


@dataclasses.dataclass(frozen=True)
class Panel:
    """One quantity over another, as several curves or groups of bars.

    Attributes:
        title: Title.
        over: Quantity along the horizontal axis.
        of: Quantity along the vertical axis.
        marks: Curves and bars, in the order of drawing.
        span: Ends of the horizontal axis [SI]; default: Matplotlib's.
        floor: Whether the vertical axis begins at 0.
        most: Magnitude beyond which values are cut off [displayed unit].
        room: Height that stays free above, over that of the values.
        names: Names of the places along the horizontal axis.
        legend: Keywords of Matplotlib's `legend`, which is drawn if marks have labels;
            `None`: none.
        twin: Panel on a vertical axis of its own at the right.
        also: Function of the axes that draws further parts.
        size: Size of a new figure [inch].
    """

    title: str
    over: Axis
    of: Axis
    marks: Sequence[Curve | Bars]
    span: Any = None
    floor: bool = False
    most: float = np.inf
    room: float = 0.0
    names: Sequence[str] | None = None
    legend: Mapping[str, Any] | None = dataclasses.field(default_factory=dict)
    twin: "Panel | None" = None
    also: Callable[[Any], Any] = lambda ax: None
    size: tuple[float, float] = (7.0, 5.0)

    def draw(self, ax: Ax = None) -> Axes:
        """Draw the panel on given axes, or on those of a new figure.

        Returns:
            The axes.
        """
        ax = axes_or_new(ax, self.size)
        pairs: list[tuple[Panel, Any]] = [(self, ax)]
        if self.twin is not None:
            pairs.append((self.twin, without_offset(ax.twinx())))
        for panel, own in pairs:
            panel._fill(own)
        if self.twin is not None:  # told apart by its colour
            pairs[1][1].yaxis.label.set_color(self.twin.marks[0].colour)
        if self.span is not None:
            ax.set_xlim(*(self.over.scale * float(end) for end in self.span))
        if self.names is not None:
            ax.set_xticks(np.arange(len(self.names)), self.names)
        # Bars hide the lines of the grid, which only measures their heights.
        bars = any(isinstance(mark, Bars) for mark in self.marks)
        finish(ax, self.title, self.over.label, axis="y" if bars else "both")
        found = [own.get_legend_handles_labels() for _, own in pairs]
        handles, labels = (sum(parts, []) for parts in zip(*found, strict=True))
        if labels and self.legend is not None:
            ax.legend(handles, labels, **{"fontsize": SMALL, **self.legend})
        self.also(ax)
        return ax

    def _fill(self, ax):
        """Draw marks, limits and label of one vertical axis."""
        for mark in self.marks:
            mark.draw(ax, self.over.scale, self.of.scale)
        if self.floor:
            ax.set_ylim(bottom=0.0)
        low, high = ax.get_ylim()
        low, high = max(low, -self.most), min(high, self.most)
        if self.room or self.most < np.inf:
            ax.set_ylim(low, high + self.room * (high - low))
        ax.set_ylabel(self.of.label)


def curves(x: Any, columns: Any, names: Sequence[str] = (), **look: Any) -> list[Curve]:
    """Return a curve of the next colour for each column.

    Args:
        x: (point,) [SI].
        columns: (point, curve) [SI].
        names: Names of the curves; those beyond have none.
        look: As in `Curve`.
    """
    columns = np.asarray(columns, float)
    labels = [*names, *(f"_curve {k}" for k in range(len(names), columns.shape[1]))]
    return [
        Curve(x, column, labels[k], CURVES[k % len(CURVES)], look=look)
        for k, column in enumerate(columns.T)
    ]


def finish(ax: Any, title: str, across: str, up: str = "", axis: str = "both") -> None:
    """Add title, labels and the grid to axes.

    Args:
        ax: Axes.
        title: Title.
        across, up: Labels of the axes; empty: left as it is.
        axis: Direction in which lines of the grid measure, "x", "y" or "both".
    """
    ax.grid(axis=axis, color="0.93")
    ax.set_axisbelow(True)
    ax.set_title(title)
    ax.set_xlabel(across)
    if up:
        ax.set_ylabel(up)


def chart(panel: Callable[P, Panel]) -> "Callable[P, Axes]":
    """Return a function that draws the panel that a function returns.

    Args:
        panel: Function of results and of the axes `ax`; a new figure if they are
            `None`. It is kept as attribute `panel` of the result.
    """
    known = inspect.signature(panel)

    @functools.wraps(panel)
    def draw(*args: P.args, **kwargs: P.kwargs) -> Axes:
        made = panel(*args, **kwargs)
        return made.draw(known.bind(*args, **kwargs).arguments.get("ax"))

    draw.__signature__ = known.replace(return_annotation=Axes)  # type: ignore
    draw.panel = panel  # type: ignore
    return draw

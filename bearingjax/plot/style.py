"""Common parts of all plots: matplotlib on demand, colours, labels."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Ax = Axes | None
else:  # names alone: it is imported at the first plot
    Axes, Figure = "matplotlib.axes.Axes", "matplotlib.figure.Figure"
    Ax = "matplotlib.axes.Axes | None"

Size = tuple[float, float]
"""Width and height of axes or of a figure [inch]."""
Points = np.ndarray | Sequence
"""One point or several: arrays, or the numbers themselves."""

OUTER = "#0072B2"
"""Colour of the outer ring and its raceway (Okabe and Ito, colour-blind safe)."""
INNER = "#D55E00"
"""Colour of the inner ring and its raceway."""
ROLLER = "#009E73"
"""Colour of the rollers."""
CURVES = OUTER, INNER, ROLLER, "#CC79A7", "#E69F00", "#56B4E9"
"""Colours of curves of one kind."""
GREY = "#595959"
"""Colour of lines that are not data."""
SMALL = 9.0
"""Smallest font size [pt]."""
ELEMENT: dict[str, Any] = {"facecolor": "#DDF1EA", "edgecolor": ROLLER}
"""Look of a rolling element."""
BOX: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
"""White ground of words on lines."""

RACEWAYS = ("outer", "inner")
COLOURS = {"outer": OUTER, "inner": INNER}

SPIN_NAMES = ("tangential", "radial", "axial")
SPIN_COLOURS = (GREY, ROLLER, INNER)
"""Parts of the spin of a ball, x, y and z."""


def pyplot() -> Any:
    """`matplotlib.pyplot`, imported at the first plot.

    Raises:
        ImportError: If matplotlib is not installed.
    """
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError(
            'plots need matplotlib: pip install "bearingjax[plot]"'
        ) from error
    return plt


def axes_or_new(ax: Ax, size: Size = (7.0, 5.0), polar: bool = False) -> Axes:
    """Return given axes, or those of a new figure, without an offset of ticks.

    Args:
        ax: Axes or `None`.
        size: Width and height of a new figure [inch].
        polar: Whether the plot needs polar axes.

    Raises:
        ValueError: If a polar plot is given other axes.
    """
    if ax is None:
        figure = pyplot().figure(figsize=size, layout="constrained")
        axes: Axes = figure.add_subplot(projection="polar" if polar else None)
    else:
        axes = ax
    if polar and axes.name != "polar":
        raise ValueError('load_zone needs polar axes: subplot(projection="polar").')
    return without_offset(axes)


def without_offset(ax: Axes) -> Axes:
    """Return the axes after switching off the offset of tick labels."""
    for axis in (ax.xaxis, ax.yaxis):
        formatter: Any = axis.get_major_formatter()
        if hasattr(formatter, "set_useOffset"):
            formatter.set_useOffset(False)
    return ax


_POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(largest: float) -> tuple[float, str]:
    """Return a factor to numbers of at most five digits, and its power of ten.

    Args:
        largest: The largest number, without a sign.

    Returns:
        1 and "" for numbers from 0.0001 to 100 000; else such as 1e-6 and "10⁶".
    """
    if largest == 0.0 or not np.isfinite(largest) or 1e-4 <= largest < 1e5:
        return 1.0, ""
    power = 3 * int(np.floor(np.log10(largest) / 3.0))
    return 10.0**-power, f"10{str(power).translate(_POWERS)}"


def widen_limits(values: Any, least: float, share: float = 0.08) -> tuple[float, float]:
    """Return limits of an axis around values, wide enough to hide round-off.

    Args:
        values: Values drawn.
        least: Smallest distance of the limits, in the unit of the values.
        share: Share of the span that stays free at each end.
    """
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    low, high = (values.min(), values.max()) if values.size else (0.0, 0.0)
    half = max(0.5 * least, (0.5 + share) * (high - low))
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half


def raceway_index(raceway: str) -> int:
    """Return the index of a raceway on the ring axis of a solution.

    Raises:
        ValueError: If it is neither "outer" nor "inner".
    """
    if raceway not in RACEWAYS:
        raise ValueError(f"`raceway` is {raceway!r}; it must be 'outer' or 'inner'.")
    return RACEWAYS.index(raceway)


def row_slices(solution: Any) -> list[slice]:
    """Return the slices of the rows on the element axis.

    Args:
        solution: A single solution.
    """
    ends = np.cumsum(solution.row_sizes)
    return [
        slice(int(e) - n, int(e)) for e, n in zip(ends, solution.row_sizes, strict=True)
    ]


def row_slice(solution: Any, row: int) -> slice:
    """Return the slice of one row on the element axis.

    Args:
        solution: A single solution.
        row: Index of the row in a set.

    Raises:
        ValueError: If there is no such row.
    """
    rows = row_slices(solution)
    if not 0 <= row < len(rows):
        raise ValueError(f"`row` is {row}; the solution has rows 0 to {len(rows) - 1}.")
    return rows[row]


def degrees(azimuth: Any) -> np.ndarray:
    """Return azimuths from 0 up to 360 degrees, without round-off at the seam.

    Args:
        azimuth: Angle [rad].
    """
    angle = np.round(np.rad2deg(np.asarray(azimuth, dtype=float)), 6) % 360.0
    return angle + 0.0


def force_text(force: float) -> str:
    """Return a force with its unit as text, N below 1 kN.

    Args:
        force: Force [N].
    """
    if abs(force) < 999.5:  # three digits of more are 1e+03
        return f"{force:.3g} N"
    return f"{1e-3 * force:.3g} kN"


def faded(colour: Any, share: float) -> tuple[float, ...]:
    """Return a colour that lets what is behind it show through.

    Args:
        colour: Any colour of Matplotlib.
        share: Opacity, from 0 (not seen) to 1 [1].
    """
    from matplotlib.colors import to_rgba

    return to_rgba(colour, share)


def towards_white(colour: Any, share: float) -> tuple[float, ...]:
    """Return a lighter colour.

    Args:
        colour: Any colour of Matplotlib.
        share: Share of white, from 0 to 1 [1].
    """
    from matplotlib.colors import to_rgb

    return tuple(c + share * (1.0 - c) for c in to_rgb(colour))


def mark_peaks(ax: Axes, x: Any, y: Any, colour: Any, name: str, **look: Any) -> None:
    """Draw triangles, which may reach beyond the axes.

    Args:
        ax: Axes.
        x, y: Points (n,).
        colour: Any colour of Matplotlib.
        name: Name of what they mark, not for the legend.
        look: Further keywords of Matplotlib's `plot`.
    """
    outside = {"clip_on": False, "in_layout": False, "label": f"_{name}"}
    ax.plot(x, y, "^", markersize=7, color=colour, **outside, **look)


def write(place: Any, at: Any, text: str, **look: Any) -> None:
    """Write small words in the middle of a point.

    Args:
        place: Axes or figure.
        at: The point (2,).
        text: The words.
        look: Further keywords of Matplotlib's `text`.
    """
    usual = {"ha": "center", "va": "center", "fontsize": SMALL}
    place.text(*at, text, **{**usual, **look})


def write_beside(ax: Axes, at: Any, away: Any, text: str, **look: Any) -> None:
    """Write small words next to a point.

    Args:
        ax: Axes.
        at: The point (2,).
        away: From the point to the words (2,) [pt].
        text: The words.
        look: Further keywords of Matplotlib's `annotate`.
    """
    usual: Any = {"textcoords": "offset points", "fontsize": SMALL}
    ax.annotate(text, tuple(at), away, **{**usual, **look})


def write_foot(place: Any, text: str, **look: Any) -> None:
    """Write main results in the middle of a part of a page; arguments as of `write`."""
    write(place, (0.5, 0.5), text, fontsize=10, linespacing=1.5, **look)


def new_page(
    width: float, height: float, beside: float = 0.12, below: float = 0.1
) -> Any:
    """Return a new figure of a size whose parts find their places.

    Args:
        width, height: Width and height [inch].
        beside, below: Room beside and below each part [inch].
    """
    figure = pyplot().figure(figsize=(width, height))
    figure.set_layout_engine("constrained", w_pad=beside, h_pad=below)
    return figure


def head(figure: Any, title: str, **place: Any) -> None:
    """Write the title of a page literally: file names may contain a dollar."""
    figure.suptitle(title, fontsize=14, fontweight="bold", parse_math=False, **place)

"""Plots of bearing noise: record, spectrum, bands, contact states, and their page."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import noise
from ..element.frame import DIRECTIONS
from ..noise.level import LOWEST_LEVEL
from ..noise.lines import UNNAMED
from ..noise.scatter import SOURCES
from .panel import Ax, Axis, Curve, Panel, chart, finish
from .style import CURVES, GREY, SMALL, Axes, Figure, axes_or_new, head, new_page

STATES = ("#D55E00", "#E69F00", "#F0F0F0", "#56B4E9", "#0072B2")
"""Colours of 0, 1, 2, 3, 4 contacts."""
_NAMED = 8
"""Most named lines of a spectrum."""
_COLUMNS = 1600
"""Most columns of a map."""
_TICKS = 18
"""Most rolling elements that are numbered on the axis of a map."""


@chart
def acceleration_over_time(record: noise.Vibration, ax: Ax = None) -> Panel:
    """Plot the acceleration of the moving ring over the turns of the shaft [m/s²].

    Args:
        record: From `vibration`.
    """
    turns = np.asarray(record.time) * float(record.shaft_frequency)
    values = np.asarray(record.acceleration)[:, : len(DIRECTIONS)]
    # What moves most lies below, so that it hides nothing.
    above = np.argsort(np.argsort(-values.std(axis=0)))
    marks = [
        Curve(turns, values[:, k], name, CURVES[k], look={"lw": 0.6, "zorder": 2 + z})
        for k, (name, z) in enumerate(zip(DIRECTIONS, above, strict=True))
    ]
    return Panel(
        "Vibration of the moving ring",
        Axis("turns of the shaft"),
        Axis("acceleration", "m/s²"),
        marks,
        (0.0, record.turns),
        legend={"loc": "upper right", "ncols": len(DIRECTIONS)},
        also=lambda ax: [line.set_linewidth(2) for line in ax.get_legend().get_lines()],
    )


def noise_spectrum(
    spectrum: noise.Spectrum,
    lines: Sequence[noise.Line] = (),
    ax: Ax = None,
    *,
    reference: float = noise.REFERENCE_ACCELERATION,
    measured: noise.Spectrum | None = None,
    has_unit: bool = True,
) -> Axes:
    """Plot the level of every line of a spectrum, summed over directions.

    Args:
        spectrum: Spectrum of the acceleration, amplitudes (line, ...) [m/s²].
        lines: From `name_lines`; the largest have their names.
        reference: Acceleration of 0 dB [m/s²]; levels are of root mean squares.
        measured: Spectrum of a measured acceleration, on lines of its own.
        has_unit: Whether its amplitudes are in m/s²; if not, its largest line is put at
            the level of the largest calculated one.
    """
    ax = axes_or_new(ax)
    frequency, size = _sizes(spectrum)

    def decibel(peak):
        least = 1e-12 * size.max(initial=reference)
        return 20.0 * np.log10(np.maximum(peak, least) / np.sqrt(2.0) / reference)

    values = decibel(size)
    ax.plot(frequency, values, color=CURVES[0], lw=0.6, label="_spectrum")
    largest = sorted(lines, key=lambda line: -line.amplitude)
    named = [line for line in largest if line.name != UNNAMED][:_NAMED]
    ax.plot(
        [line.frequency for line in named],
        decibel(np.array([line.amplitude for line in named])),
        "o", color=CURVES[1], ms=3.5, ls="none", label="_named",
    )  # fmt: skip
    if measured is not None:
        others = _plot_measured(ax, measured, has_unit, size, decibel)
        values = np.concatenate([values, others])
    top = float(values.max())
    bottom = max(float(np.percentile(values, 1)), top - 100.0)
    ax.set_ylim(bottom - 5.0, top + 0.5 * (top - bottom))
    ax.set_xscale("log")
    ax.set_xlim(frequency[0], frequency[-1])
    _names(ax, named, decibel)
    finish(ax, "Spectrum", "frequency [Hz]", _level("level of lines", reference).label)
    return ax


def _plot_measured(ax, measured, has_unit, size, shown):
    """Plot a measured spectrum behind the calculated one, of the sizes given; return
    what is shown of each of its lines."""
    frequency, there = _sizes(measured)
    scale, word = 1.0, "measured"
    if not has_unit:
        scale, word = size.max() / (there.max() or 1.0), "measured, without unit"
    others = shown(scale * there)
    ax.plot(frequency, others, color=CURVES[1], lw=0.6, zorder=1.9, label=word)
    ax.lines[0].set_label("calculated")
    ax.legend(fontsize=SMALL, loc="upper left")
    return others


def _sizes(spectrum):
    """Return frequencies [Hz] and amplitudes over all directions, without the mean."""
    there = np.asarray(spectrum.frequency) > 0.0
    amplitude = np.abs(np.asarray(spectrum.amplitude))[there]
    size = np.linalg.norm(amplitude.reshape(len(amplitude), -1), axis=1)
    return np.asarray(spectrum.frequency)[there], size


def noise_envelope(
    spectrum: noise.Spectrum,
    lines: Sequence[noise.Line] = (),
    ax: Ax = None,
    *,
    band: Sequence[float] | None = None,
    measured: noise.Spectrum | None = None,
    has_unit: bool = True,
) -> Axes:
    """Plot the spectrum of an envelope, over all its directions [m/s²].

    Args:
        spectrum: From `envelope_spectrum`.
        lines: From `name_lines`; the largest have their names.
        band: Lower and upper frequency of the band, for the title [Hz].
        measured, has_unit: Spectrum of a measured envelope, as in `noise_spectrum`.
    """
    ax = axes_or_new(ax)
    frequency, size = _sizes(spectrum)
    ax.plot(frequency, size, color=CURVES[0], lw=0.6, label="_envelope")
    named = sorted(lines, key=lambda line: -line.amplitude)
    named = [line for line in named if line.name != UNNAMED][:_NAMED]
    at = [line.frequency for line in named], [line.amplitude for line in named]
    ax.plot(*at, "o", color=CURVES[1], ms=3.5, label="_named")
    ends = (line.frequency for line in lines)
    ax.set_xlim(0.0, 1.1 * max(ends, default=frequency[-1] / 1.1))
    highest = size[frequency <= ax.get_xlim()[1]].max()
    if measured is not None:
        others = _plot_measured(ax, measured, has_unit, size, lambda sizes: sizes)
        seen = _sizes(measured)[0] <= ax.get_xlim()[1]
        highest = others[seen].max(initial=highest)
    ax.set_ylim(0.0, 1.6 * highest or 1.0)
    _names(ax, named, lambda amplitude: amplitude)
    title = "Spectrum of the envelope"
    if band is not None:
        title += f" of {band[0]:.5g} to {band[1]:.5g} Hz"
    finish(ax, title, "frequency [Hz]", "amplitude of lines [m/s²]")
    return ax


def _level(name, reference) -> Axis:
    return Axis(name, f"dB over {reference:.3g} m/s²")


def _names(ax, lines, decibel):
    """Write names above the spectrum without overlap."""
    if not lines:
        return
    lines = sorted(lines, key=lambda line: line.frequency)
    along = ax.transScale.transform  # on a logarithmic axis or another
    (low, _), (high, _) = along([(x, 1.0) for x in ax.get_xlim()])
    at = along([(line.frequency, 1.0) for line in lines])[:, 0]
    place = (at - low) / (high - low)
    apart = 0.045
    shown = place.copy()
    for k in range(1, len(shown)):
        shown[k] = max(shown[k], shown[k - 1] + apart)
    shown -= max(0.0, shown[-1] - 0.97)
    for k in range(len(shown) - 2, -1, -1):
        shown[k] = min(shown[k], shown[k + 1] - apart)
    for line, x in zip(lines, shown, strict=True):
        ax.annotate(
            line.name,
            (line.frequency, float(decibel(line.amplitude))),
            (x, 0.72), textcoords="axes fraction",
            rotation=90, fontsize=SMALL - 1.0, ha="center", va="bottom",
            arrowprops={"arrowstyle": "-", "color": "0.6", "lw": 0.6},
        )  # fmt: skip


def band_bars(
    bands: noise.Bands,
    level: Any,
    ax: Ax = None,
    *,
    norm: Any = None,
    reference: float = noise.REFERENCE_ACCELERATION,
) -> Axes:
    """Plot the level of every band and direction, with the norm if there is one.

    Args:
        bands: The bands.
        level: (band, direction) [dB]; NaN for bands that are not held.
        norm: Largest allowed level of each band (band,) [dB].
        reference: Acceleration of 0 dB [m/s²].
    """
    ax = axes_or_new(ax)
    level = np.asarray(level, dtype=float)
    level = np.where(level > LOWEST_LEVEL, level, np.nan)  # where nothing moves
    count, directions = level.shape
    place, width = np.arange(count), 0.8 / directions
    for k in range(directions):
        away = (k - 0.5 * (directions - 1)) * width
        ax.bar(place + away, level[:, k], width, color=CURVES[k], label=DIRECTIONS[k])
    shown = level[np.isfinite(level)]
    if norm is not None:
        norm = np.asarray(norm, dtype=float)
        edges = np.concatenate([place - 0.5, [count - 0.5]])
        ax.stairs(norm, edges, color="black", lw=1.6, label="norm", baseline=None)
        shown = np.concatenate([shown, norm])
    if len(shown):
        low = min(0.0, float(shown.min()) - 5.0)
        ax.set_ylim(low, max(1.18 * float(shown.max()), low + 10.0))
    every = max(1, -(-count // 14))
    ax.set_xticks(
        place[::every], [f"{c:g}" for c in bands.centre[::every]], fontsize=SMALL
    )
    ax.set_xlim(-0.6, count - 0.4)
    label = _level("level", reference).label
    finish(ax, "Bands", "centre of the band [Hz]", label, axis="y")
    ax.legend(fontsize=SMALL, ncols=4, loc="upper left")
    return ax


def contact_state_map(
    record: noise.Vibration,
    states: noise.ContactStates,
    ax: Ax = None,
) -> Axes:
    """Map the number of contacts of every rolling element over turns of the shaft.

    Args:
        record: From `vibration`.
        states: From `contact_states`.
    """
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    ax = axes_or_new(ax)
    number = states.number[:: -(-len(states.number) // _COLUMNS)]
    most = len(states.samples)
    ax.imshow(
        number.T,
        aspect="auto",
        interpolation="nearest",
        origin="lower",
        cmap=ListedColormap(STATES[:most]),
        vmin=-0.5,
        vmax=most - 0.5,
        extent=(0.0, float(record.turns), -0.5, number.shape[1] - 0.5),
    )
    if np.count_nonzero(states.samples) == 1:
        text = f"{np.argmax(states.samples)} contacts all the time"
        ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center")
    ax.set_yticks(range(0, number.shape[1], -(-number.shape[1] // _TICKS)))
    ax.tick_params(axis="y", labelsize=SMALL)
    ax.set_xlabel("turns of the shaft")
    ax.set_ylabel("rolling element")
    ax.set_title("Contacts of every rolling element; share of the time", pad=24.0)
    ax.legend(
        handles=[
            Patch(
                facecolor=STATES[k],
                edgecolor=GREY,
                lw=0.5,
                label=f"{k}: {100.0 * states.shares[k]:.3g} %",
            )
            for k in range(most)
        ],
        fontsize=SMALL,
        ncols=most,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        frameon=False,
        borderpad=0.2,
        handlelength=1.2,
        columnspacing=1.0,
    )
    return ax


@chart
def level_distribution(
    level: Any, ax: Ax = None, *, reference: float = noise.REFERENCE_ACCELERATION
) -> Panel:
    """Plot the cumulative distribution of levels over bearings [%].

    Args:
        level: Level of each bearing (bearing, direction) [dB]; NaN of those that
            failed.
        reference: Acceleration of 0 dB [m/s²].
    """
    marks = []
    for k, values in enumerate(np.asarray(level, dtype=float).T):
        values = np.sort(values[values > LOWEST_LEVEL])
        share = (np.arange(len(values)) + 0.5) / max(len(values), 1)
        marks.append(Curve(values, share, DIRECTIONS[k], CURVES[k], ".-", {"lw": 1.2}))
    return Panel(
        "Random bearings",
        _level("level", reference),
        Axis("bearings below", "", (100.0, "%")),
        marks,
        also=lambda ax: ax.set_ylim(0.0, 100.0),
    )


def source_bars(contributions: noise.SourceContributions, ax: Ax = None) -> Any:
    """Plot the share of each source in the mean square of the acceleration [%].

    Args:
        contributions: From `source_contributions`.

    Returns:
        The axes; the largest source is at the top. Thin lines are standard errors.
    """
    ax = axes_or_new(ax)
    part = 100.0 * np.asarray(contributions.share) / float(contributions.mean_square)
    order = np.argsort(part)
    names = [
        SOURCES[contributions.sources[k]].replace(" of the ", "\nof the ")
        for k in order
    ]
    error = (
        100.0
        * np.asarray(contributions.error)[order]
        / float(contributions.mean_square)
    )
    bars = ax.barh(
        names, part[order], color=CURVES[0], xerr=np.nan_to_num(error), ecolor=GREY
    )
    ax.tick_params(axis="y", labelsize=SMALL)
    ax.bar_label(bars, fmt="%.3g", fontsize=SMALL, padding=3)
    ax.margins(x=0.15)
    label = "part of the mean square of the acceleration [%]"
    finish(ax, "Sources of the noise", label, axis="x")
    return ax


def noise_overview(run: Any, title: str = "") -> Figure:
    """Plot record, spectrum, bands, contact states and envelope on one page.

    A measured spectrum, and the envelope of a record, stand beside the calculated one
    along the sensor. Of random bearings also the distribution of their levels, and what
    makes it.

    Args:
        run: Results of a scene of noise, with a record.
        title: Head of the page; "Noise" if empty.

    Returns:
        The figure, 15 inches wide.
    """
    task, analysis, many = run.task, run.analysis, run.many
    rows = 3 if many is None else 4
    figure = new_page(15.0, 4.8 * rows)
    across: Any = [figure.add_subplot(rows, 2, k) for k in (1, 2, 3, 4)]
    given = {"reference": task.reference}
    acceleration_over_time(analysis.record, across[0])
    noise_spectrum(analysis.spectrum, analysis.lines, across[1], **given)
    band_bars(task.bands, analysis.band_level, across[2], norm=task.norm, **given)
    contact_state_map(analysis.record, analysis.states, across[3])
    measured, sensor = task.measured, task.model.sensor
    ax = figure.add_subplot(rows, 1 if measured is None else 2, 3 + 2 * bool(measured))
    found, there = analysis.envelope, analysis.measured_envelope
    unknown = measured is not None and not measured.has_unit
    beside = {"measured": there and there.spectrum, "has_unit": not unknown}
    noise_envelope(found.spectrum, found.lines, ax, band=found.band, **beside)
    if measured is not None:
        ax = figure.add_subplot(rows, 2, 6)
        beside = {"measured": measured.spectrum, "has_unit": measured.has_unit}
        noise_spectrum(run.heard, (), ax, **beside, **given)
        along = "the loudest axis" if sensor is None else "the sensor"
        ax.set_title(f"Calculated along {along}, and {measured.name}", parse_math=False)
    if many is not None:
        level = many.levels.level
        level_distribution(level, figure.add_subplot(rows, 2, 7), **given)
        if many.contributions is not None:
            source_bars(many.contributions, figure.add_subplot(rows, 2, 8))
    head(figure, title or "Noise")
    return figure

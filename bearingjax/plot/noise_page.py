"""One page on the noise of a bearing."""

from typing import Any

from .noise import (
    acceleration_over_time,
    band_bars,
    contact_state_map,
    level_distribution,
    noise_envelope,
    noise_spectrum,
    source_bars,
)
from .style import Figure, head, new_page


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

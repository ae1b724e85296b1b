"""One page on the noise of a bearing."""

from typing import Any

from .noise import (
    acceleration_over_time,
    band_bars,
    contact_state_map,
    level_distribution,
    noise_spectrum,
    source_bars,
)
from .style import Figure, head, new_page


def noise_overview(run: Any, title: str = "") -> Figure:
    """Plot record, spectrum with named lines, bands and contact states on one page.

    Of random bearings also the distribution of their levels, and what makes it.

    Args:
        run: Results of a scene of noise, with a record.
        title: Head of the page; "Noise" if empty.

    Returns:
        The figure, 15 inches wide.
    """
    task, analysis = run.task, run.analysis
    rows = 2 if run.many is None else 3
    figure = new_page(15.0, 4.8 * rows)
    axes = figure.subplots(rows, 2)
    acceleration_over_time(analysis.record, axes[0, 0])
    reference = task.reference
    noise_spectrum(analysis.spectrum, analysis.lines, axes[0, 1], reference=reference)
    band_bars(
        task.bands, analysis.band_level, axes[1, 0], norm=task.norm, reference=reference
    )
    contact_state_map(analysis.record, analysis.states, axes[1, 1])
    if run.many is not None:
        level_distribution(run.many.levels.level, axes[2, 0], reference=reference)
        if run.many.contributions is None:
            axes[2, 1].set_axis_off()
        else:
            source_bars(run.many.contributions, axes[2, 1])
    head(figure, title or "Noise")
    return figure

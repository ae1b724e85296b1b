"""One page on the noise of a bearing."""

from typing import TYPE_CHECKING, Any

from .noise import (
    acceleration_over_time,
    band_bars,
    contact_state_map,
    noise_spectrum,
)
from .style import head, pyplot

if TYPE_CHECKING:
    import matplotlib.figure


def noise_overview(run: Any, title: str = "") -> "matplotlib.figure.Figure":
    """Record, spectrum with named lines, bands and contact states on one page.

    Args:
        run: What came of a scene of noise, with a record.
        title: Head of the page; "Noise" if empty.

    Returns:
        The figure, 15 inches wide.
    """
    task, heard = run.task, run.heard
    figure = pyplot().figure(figsize=(15.0, 9.6))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    axes = figure.subplots(2, 2)
    acceleration_over_time(heard.record, axes[0, 0])
    reference = task.reference
    noise_spectrum(heard.spectrum, heard.lines, axes[0, 1], reference=reference)
    band_bars(
        task.bands, heard.band_level, axes[1, 0], norm=task.norm, reference=reference
    )
    contact_state_map(heard.record, heard.states, axes[1, 1])
    head(figure, title or "Noise")
    return figure

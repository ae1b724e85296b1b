"""Axial sections of several bearings side by side."""

from collections.abc import Sequence

from ...catalogue.entry import CatalogueEntry
from ...design import AbstractBearing, BearingSet
from ..style import Figure, pyplot
from .section import cross_section


def cross_sections(
    bearings: Sequence[AbstractBearing | BearingSet],
    titles: Sequence[str],
    catalogue: Sequence[CatalogueEntry] = (),
) -> Figure:
    """Draw axial sections of bearings, each to its own scale [mm].

    Args:
        bearings: At least one.
        titles: Head of each.
        catalogue: Catalogue entry of each, whose boundary dimensions are drawn too.

    Returns:
        The figure, 7 by 6 inches a bearing, at most three in a row.

    Raises:
        ValueError: If there is no bearing, or not a title for each.
    """
    if not bearings or len(titles) != len(bearings):
        raise ValueError(
            f"cross_sections: {len(bearings)} bearings and {len(titles)} titles; there"
            " must be at least one bearing, and a title for each."
        )
    across = min(3, len(bearings))
    down = -(-len(bearings) // across)
    figure = pyplot().figure(figsize=(7.0 * across, 6.0 * down), layout="constrained")
    for k, (bearing, title) in enumerate(zip(bearings, titles, strict=True)):
        entry = catalogue[k] if catalogue else None
        ax = cross_section(bearing, figure.add_subplot(down, across, k + 1), entry)
        ax.set_title(title)
    return figure

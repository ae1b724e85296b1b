"""Bearings by their designation: entries, suffixes, estimated internal dimensions.

`bearingjax.load_bearing("6205")` is the bearing, with its published ratings.
`catalogue_entry("6205")`, one of `catalogue_entries()`, is what the catalogue knows of
it: boundary dimensions, ratings, speeds, sources; its `design` is data.

`estimate_geometry(bore, outside_diameter, width, kind, C, C0)` makes a design of a
bearing of which only the catalogue data are known: the rolling elements that best fit
the ratings and the usual proportions. It is an estimate; `report()` states its misfit.

Names
-----

- Entries: `catalogue_entry`, `catalogue_entries`, `CatalogueEntry`.
- Estimated inside: `estimate_geometry`, `GeometryEstimate`.
"""

from .entry import CatalogueEntry, catalogue_entries, catalogue_entry
from .estimate import GeometryEstimate, estimate_geometry

__all__ = [
    "catalogue_entry", "catalogue_entries", "CatalogueEntry", "estimate_geometry",
    "GeometryEstimate",
]  # fmt: skip

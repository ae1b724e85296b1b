"""Bearings by their designation: entries, suffixes, estimated internal dimensions.

`catalogue_entry(designation)` is one of `catalogue_entries()`; its `design` holds the
keywords of `design.bearing_of`, with published ratings.

`estimate_geometry(bore, outside_diameter, width, kind, C, C0)` makes a design of a
bearing of which only the catalogue data are known: the rolling elements that best fit
the ratings and the usual proportions. It is an estimate; `report()` states its misfit.
"""

from .entry import CatalogueEntry as CatalogueEntry
from .entry import catalogue_entries as catalogue_entries
from .entry import catalogue_entry as catalogue_entry
from .estimate import GeometryEstimate as GeometryEstimate
from .estimate import estimate_geometry as estimate_geometry

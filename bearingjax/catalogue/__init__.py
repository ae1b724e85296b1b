"""Bearings by their designation: entries, suffixes, estimated internal dimensions."""

from .entry import CatalogueEntry as CatalogueEntry
from .entry import catalogue_entries as catalogue_entries
from .entry import catalogue_entry as catalogue_entry
from .estimate import GeometryEstimate as GeometryEstimate
from .estimate import estimate_geometry as estimate_geometry

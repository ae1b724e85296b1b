"""A choice of bearing among those of the catalogue."""

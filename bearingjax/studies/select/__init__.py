"""Selection of bearings from the catalogue by the requirements of a scene."""

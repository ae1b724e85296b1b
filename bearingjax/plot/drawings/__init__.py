"""Drawings of bearings to scale, with their dimensions."""

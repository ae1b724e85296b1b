"""Optimised bearings and systems of shafts."""

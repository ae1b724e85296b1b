"""Plots of identified numbers, tolerances and choices."""

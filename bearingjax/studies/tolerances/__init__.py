"""Tolerance analysis of a scene: distributions of results, tolerances to tighten."""

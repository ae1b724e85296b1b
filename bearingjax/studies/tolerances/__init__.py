"""The tolerances of a scene: quantiles, misses, and what to tighten."""

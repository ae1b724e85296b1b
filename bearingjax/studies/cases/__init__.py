"""A bearing under many cases: sweeps and life under a load spectrum."""

"""The few tolerances of the tests, each with its reason."""

ROUNDING = 1e-12  # the same real number by two routes in float64
SOLVER = 1e-9  # two solvers, each polished to round-off
DIFFERENCE = 1e-6  # central differences at their best step
QUADRATURE_FORCE = 1e-6  # 32 contact-mapped nodes, from benchmarks/quadrature.py
QUADRATURE_STIFFNESS = 1e-5  # likewise
PUBLISHED = 1e-3  # four printed digits

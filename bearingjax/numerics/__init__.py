"""Numerical tools without bearing words: powers, quadrature, minimisers and more.

Names
-----

- Results of solves: `Result`, `SolveError`, `Warning`.
- Compiled programs: `keep_programs`, `QUICK_COMPILATION`.
- Minimisers: `TrustRegionNewton`, `BFGS`, `AbstractMinimiser`, `Evaluation`, `Minimum`.
- Quadrature along rollers: `ContactMapped`, `Midpoint`, `AbstractQuadrature`.
- For laws and designs of your own: `as_real`, `positive_power`, `smooth_power`.
"""

from .bfgs import BFGS
from .compiled.programs import QUICK_COMPILATION, keep_programs
from .minimise import AbstractMinimiser, Evaluation, Minimum, TrustRegionNewton
from .power import positive_power, smooth_power
from .quadrature import AbstractQuadrature, ContactMapped, Midpoint
from .result import Result, SolveError
from .types import as_real
from .warning import Warning

__all__ = [
    "Result", "SolveError", "Warning", "keep_programs", "QUICK_COMPILATION",
    "TrustRegionNewton", "BFGS", "AbstractMinimiser", "Evaluation", "Minimum",
    "ContactMapped", "Midpoint", "AbstractQuadrature", "as_real", "positive_power",
    "smooth_power",
]  # fmt: skip

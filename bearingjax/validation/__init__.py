"""Cases with known answers: published, measured, or computed by independent programs.

A case is a file of this package's folder `cases`: where its numbers come from and how
far they are to be trusted, the inputs, their answers, and how near ours must come. The
tests, `bearingjax validate` and the site read the same files.

Names
-----

- Cases: `cases`, `Case`, `Number`, `SUBJECTS`, `TRUST`.
- Those nearest to a bearing: `nearest_cases`, `Near`.
"""

from .case import SUBJECTS, TRUST, Case, Number, cases
from .nearest import Near, nearest_cases

__all__ = ["cases", "Case", "Number", "SUBJECTS", "TRUST", "nearest_cases", "Near"]

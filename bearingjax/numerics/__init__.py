"""Numerical tools without bearing words: powers, quadrature, minimisers and more."""

from .bfgs import BFGS as BFGS
from .bfgs import inverse_update as inverse_update
from .compiled.programs import keep_programs as keep_programs
from .elliptic import carlson_rd as carlson_rd
from .elliptic import complete as complete
from .implicit import attach as attach
from .implicit import attach_roots as attach_roots
from .linear import smallest_pivot as smallest_pivot
from .linear import solve_symmetric as solve_symmetric
from .minimise import AbstractMinimiser as AbstractMinimiser
from .minimise import Evaluation as Evaluation
from .minimise import Minimum as Minimum
from .minimise import TrustRegionNewton as TrustRegionNewton
from .power import ninth_root as ninth_root
from .power import positive_power as positive_power
from .power import smooth_power as smooth_power
from .quadrature import AbstractQuadrature as AbstractQuadrature
from .quadrature import ContactMapped as ContactMapped
from .quadrature import Midpoint as Midpoint
from .result import Result as Result
from .result import SolveError as SolveError
from .types import as_real as as_real

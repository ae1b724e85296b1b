"""Many load cases: sweeps over loads, speeds and designs, and duty spectra."""

from .cases import Cases as Cases
from .cases import solve_case as solve_case
from .spectrum import SpectrumLife as SpectrumLife
from .spectrum import spectrum_life as spectrum_life
from .sweep import Sweep as Sweep
from .sweep import stack_designs as stack_designs
from .sweep import sweep as sweep

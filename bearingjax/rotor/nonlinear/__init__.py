"""Nonlinear vibration of rotors: periodic orbits, their stability, branches, time.

`vibrating_rotor(rotor, unbalance, scale=1e-5, reference_frequency=3000.0)` keeps the
supports' true forces (or those of `RotorLoads`, weight and shaking base included);
`modes=8` holds a shaft of many elements to Craig-Bampton motions, `BearingSupport(...,
passage=True)` lets the rolling elements orbit (variable compliance);
`LawSupport(station, law)` is a law below as a support. `rigid_rotor` is a rotor of five
freedoms on two preloaded bearings, whose forces are gradients of an energy:
`FixedAngle`, its `CubicExpansion`, `MovingAngle`; `Grooves` has their numbers from the
drawing, `FixedAngle.of_bearing(element, offset)` those of a bearing of the library.
`VibratingSystem` takes matrices and functions of your own.

`solve_orbit(system, frequency, method)` finds the motion that repeats with the
excitation, by `Shooting(steps)` or by `HarmonicBalance(harmonics)`: displacements over
the period, amplitudes, Floquet multipliers, whether it is stable, all differentiable
with respect to every number. `follow(system, begin, end, method)` follows a branch
through its folds, in one compiled loop, and marks and locates folds, flips,
Neimark-Sacker and branch points; `branch.ending` says why it ends. Two marked points of
a kind between neighbouring points of a branch are not seen: shorten
`Steps(largest=...)`. While all balls bear, 5 harmonics or 24 steps a period leave 1e-9
of the amplitude; where some lift off, force has a kink in its slope, and 15 harmonics
or 96 steps leave 5e-6 (benchmarks/rotor_response.py).

In time, `simulate(system, times, frequency, end_frequency=...)` integrates decay,
run-up through critical speeds (the phase is the exact integral of the frequency; the
inertia of a changing speed takes part) and forces of your own over time; `poincare` has
the states once per period, `waterfall` the spectra over the frequency, `envelope` the
amplitude and `spectra_over_time` the spectra of a run-up over its speed.

`backbone(system, peaks, freedom, method)` has the frequency and the damping ratio of
free vibration over its amplitude, along which resonances bend; `peak(system, branch,
freedom, method)` the largest amplitude on a branch, between its points, with
derivatives of its height and frequency.

Names
-----

- Systems: `vibrating_rotor`, `VibratingRotor`, `VibratingSystem`,
  `AbstractVibratingSystem`, `HarmonicLoad`.
- Two bearings under a rigid rotor: `rigid_rotor`, `RigidRotor`, `OpposedPair`,
  `natural_frequencies`.
- Laws of supports: `LawSupport`, `FixedAngle`, `CubicExpansion`, `MovingAngle`,
  `Grooves`, `AbstractSupportLaw`.
- Periodic orbits: `solve_orbit`, `PeriodicOrbit`, `HarmonicBalance`, `Shooting`,
  `AbstractMethod`.
- Branches: `follow`, `trace`, `Branch`, `BranchEnd`, `Event`, `Steps`, `Arclength`,
  `ChangeOfParameter`, `peak`.
- Free vibration: `backbone`, `Backbone`.
- In time: `simulate`, `IntegrationOptions`, `History`, `FrequencyTable`, `poincare`,
  `envelope`.
- Spectra over speed: `waterfall`, `Waterfall`, `steady_spectra`, `spectra_over_time`,
  `Spectra`.
"""

from ...numerics.in_time import IntegrationOptions
from .backbone import Backbone, backbone
from .branch import Branch, Event, follow
from .continuation import Arclength, BranchEnd, ChangeOfParameter, Steps, trace
from .harmonic_balance import HarmonicBalance
from .law_support import LawSupport
from .method import AbstractMethod
from .orbit import PeriodicOrbit, solve_orbit
from .peak import peak
from .rigid_rotor import OpposedPair, RigidRotor, natural_frequencies, rigid_rotor
from .run_up import FrequencyTable
from .shooting import Shooting
from .support_law import (
    AbstractSupportLaw,
    CubicExpansion,
    FixedAngle,
    Grooves,
    MovingAngle,
)
from .system import AbstractVibratingSystem, HarmonicLoad, VibratingSystem
from .transient import History, envelope, poincare, simulate
from .vibrating_rotor import VibratingRotor, vibrating_rotor
from .waterfall import Spectra, Waterfall, spectra_over_time, steady_spectra, waterfall

__all__ = [
    "vibrating_rotor", "VibratingRotor", "VibratingSystem", "AbstractVibratingSystem",
    "HarmonicLoad", "rigid_rotor", "RigidRotor", "OpposedPair", "natural_frequencies",
    "LawSupport", "FixedAngle", "CubicExpansion", "MovingAngle", "Grooves",
    "AbstractSupportLaw", "solve_orbit", "PeriodicOrbit", "HarmonicBalance", "Shooting",
    "AbstractMethod", "follow", "trace", "Branch", "BranchEnd", "Event", "Steps",
    "Arclength", "ChangeOfParameter", "peak", "backbone", "Backbone", "simulate",
    "IntegrationOptions", "History", "FrequencyTable", "poincare", "envelope",
    "waterfall", "Waterfall", "steady_spectra", "spectra_over_time", "Spectra",
]  # fmt: skip

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

In time, `simulate(system, duration, frequency, end_frequency=...)` integrates decay,
run-up through critical speeds (the phase is the exact integral of the frequency; the
inertia of a changing speed takes part) and forces of your own over time; `poincare` has
the states once per period, `waterfall` the spectra over the frequency, `envelope` the
amplitude and `spectra_over_time` the spectra of a run-up over its speed.

`backbone(system, peaks, freedom, method)` has the frequency and the damping ratio of
free vibration over its amplitude, along which resonances bend; `peak(system, branch,
freedom, method)` the largest amplitude on a branch, between its points, with
derivatives of its height and frequency.
"""

from .backbone import Backbone as Backbone
from .backbone import backbone as backbone
from .branch import Branch as Branch
from .branch import Event as Event
from .branch import follow as follow
from .continuation import Arclength as Arclength
from .continuation import BranchEnd as BranchEnd
from .continuation import ChangeOfParameter as ChangeOfParameter
from .continuation import Steps as Steps
from .continuation import trace as trace
from .harmonic_balance import HarmonicBalance as HarmonicBalance
from .law_support import LawSupport as LawSupport
from .method import AbstractMethod as AbstractMethod
from .orbit import PeriodicOrbit as PeriodicOrbit
from .orbit import solve_orbit as solve_orbit
from .peak import peak as peak
from .rigid_rotor import OpposedPair as OpposedPair
from .rigid_rotor import RigidRotor as RigidRotor
from .rigid_rotor import natural_frequencies as natural_frequencies
from .rigid_rotor import rigid_rotor as rigid_rotor
from .run_up import FrequencyTable as FrequencyTable
from .shooting import Shooting as Shooting
from .support_law import AbstractSupportLaw as AbstractSupportLaw
from .support_law import CubicExpansion as CubicExpansion
from .support_law import FixedAngle as FixedAngle
from .support_law import Grooves as Grooves
from .support_law import MovingAngle as MovingAngle
from .system import AbstractVibratingSystem as AbstractVibratingSystem
from .system import HarmonicLoad as HarmonicLoad
from .system import VibratingSystem as VibratingSystem
from .transient import History as History
from .transient import envelope as envelope
from .transient import poincare as poincare
from .transient import simulate as simulate
from .vibrating_rotor import VibratingRotor as VibratingRotor
from .vibrating_rotor import vibrating_rotor as vibrating_rotor
from .waterfall import Spectra as Spectra
from .waterfall import Waterfall as Waterfall
from .waterfall import spectra_over_time as spectra_over_time
from .waterfall import steady_spectra as steady_spectra
from .waterfall import waterfall as waterfall

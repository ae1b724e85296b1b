"""Bearings in rotors: modes, critical speeds, unbalance, equilibrium, vibration.

A rotor (`Rotor`) is a `Shaft` of Timoshenko beam elements between stations (stepped,
hollow, of several materials), `Disc`s and `PointMass`es, and supports, on ground or on
a `Housing`. A support is a `LinearSupport` (springs and dampers of five freedoms, ux uy
uz gx gy) or a `BearingSupport(station, element, offset, turned=...)`, which is a
bearing itself, with its preload as the `offset` of its inner ring
(`preload_offset(element, force)` computes it): its tangent stiffness at that offset in
linear analyses (zero if it is unloaded there), its true force in nonlinear ones.
User-defined supports derive from `AbstractSupport` and define their force over motion,
velocity and speed. `ModalDamping` and `ProportionalDamping` damp the shaft; `Rotor(...,
rigid=True)` is a shaft that does not bend. Torsion and the stiffness of an axially
loaded shaft are left out.

Linear analyses
---------------

`modes(rotor, speed)` gives eigenvalues, frequencies [Hz], damping ratios, logarithmic
decrements, mode shapes and the sense of whirl (+1 forward, -1 backward, 0 in a plane or
axial); `campbell` follows each mode over the speeds by its shape, `instability_onsets`
finds the speed from which one is unstable; `critical_speeds` are
solved for, not read off, with a warning if strong dampers may have hidden one
(`missed`); `unbalance_response` and `harmonic_response` give amplitudes;
`rotor.linearise(speed)` the matrices M, C, G, K. Frequencies, damping ratios, critical
speeds and amplitudes have first derivatives with respect to every number of the rotor,
also where modes coincide. They agree with ROSS to all ten digits that its tests print.
The eigenvalues come from LAPACK, which JAX has on the CPU only. Beside other work on
the processor set `OPENBLAS_NUM_THREADS=1` (as commands do): threads of LAPACK wait for
each other otherwise, and a Campbell diagram took thirty times as long.

Coefficients for other programs
-------------------------------

`bearingjax.linearise(element, load)` gives the stiffness of a bearing at its operating
point; `stiffness_table(element, speeds, load)` that in x, y and z over rotor speed
(speed, 3, 3), tilts held or free; `to_ross(element, n, speeds, load, damping=...)`
makes a `ross.BearingElement` of it (the axes of ROSS are ours).

At rest in its bearings
-----------------------

`static_equilibrium(rotor, RotorLoads(gravity=(0, -9.80665, 0),
forces=StationForce(...)), speed)` is the equilibrium under weight, constant forces and
preload with the bearings' true forces: displacements, load and stiffness of each
bearing, differentiable with respect to every number. It warns of an unloaded bearing
and of an unsupported motion, and names the freedom of an unsupported load.
`settled.rotor` is the rotor on springs of that stiffness, for all linear analyses.
Where rolling elements feel the speed (`BearingSupport(..., inertia=True)`),
`static_equilibrium_over(rotor, loads, top_speed).rotor` has springs that follow it, as
polynomials with a measured error. Two bearings of one structure are compiled once.

For nonlinear vibration see `bearingjax.rotor.nonlinear`. Examples: the notebooks
linear_rotordynamics, rotor_in_jax and rotor_on_bearings.

Names
-----

- Nonlinear vibration: `nonlinear`.
- The rotor: `Rotor`, `Shaft`, `Disc`, `PointMass`, `Housing`, `AbstractPart`,
  `STATION_FREEDOMS`, `seat_size_warnings`.
- Supports: `BearingSupport`, `LinearSupport`, `SpeedSupport`, `AbstractSupport`,
  `preload_offset`.
- Damping: `ModalDamping`, `ProportionalDamping`, `AbstractDamping`.
- Loads: `RotorLoads`, `StationForce`, `Unbalance`.
- Equilibrium: `static_equilibrium`, `StaticEquilibrium`, `static_equilibrium_over`,
  `StaticEquilibriumOver`.
- Modes: `modes`, `Modes`, `campbell`, `critical_speeds`, `CriticalSpeeds`,
  `instability_onsets`, `Onset`, `major_axis`.
- Response: `unbalance_response`, `harmonic_response`, `UnbalanceResponse`.
- Matrices: `RotorMatrices`, `craig_bampton`, `reduction_error`, `reduction_warnings`.
- Coefficients for other programs: `stiffness_table`, `stiffness_warnings`, `to_ross`.
- Rotors whose numbers are identified: `RotorDesign`, `RotorSeat`, `RotorCases`.
"""

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

from .bearing_support import BearingSupport
from .damping import AbstractDamping, ModalDamping, ProportionalDamping
from .linear.coefficients import stiffness_table, stiffness_warnings
from .linear.critical import CriticalSpeeds, critical_speeds
from .linear.harmonic import (
    harmonic_response,
    reduction_error,
    reduction_warnings,
    unbalance_response,
)
from .linear.modes import Modes, campbell, major_axis, modes
from .linear.onset import Onset, instability_onsets
from .linear.reduction import craig_bampton
from .linear.response import Unbalance, UnbalanceResponse
from .loads import RotorLoads, StationForce
from .parts import (
    AbstractPart,
    AbstractSupport,
    Disc,
    Housing,
    LinearSupport,
    PointMass,
)
from .preload_offset import preload_offset
from .ross import to_ross
from .rotor import Rotor, RotorMatrices
from .shaft import STATION_FREEDOMS, Shaft, seat_size_warnings
from .speed_support import SpeedSupport
from .statics import StaticEquilibrium, static_equilibrium
from .statics_over_speed import StaticEquilibriumOver, static_equilibrium_over

if _TYPE_CHECKING:
    from . import nonlinear
    from .rotor_design import RotorCases, RotorDesign, RotorSeat

__all__ = [
    "nonlinear", "Rotor", "Shaft", "Disc", "PointMass", "Housing", "AbstractPart",
    "STATION_FREEDOMS", "seat_size_warnings", "BearingSupport", "LinearSupport",
    "SpeedSupport", "AbstractSupport", "preload_offset", "ModalDamping",
    "ProportionalDamping", "AbstractDamping", "RotorLoads", "StationForce", "Unbalance",
    "static_equilibrium", "StaticEquilibrium", "static_equilibrium_over",
    "StaticEquilibriumOver", "modes", "Modes", "campbell", "critical_speeds",
    "CriticalSpeeds", "instability_onsets", "Onset", "major_axis", "unbalance_response",
    "harmonic_response", "UnbalanceResponse", "RotorMatrices", "craig_bampton",
    "reduction_error", "reduction_warnings", "stiffness_table",
    "stiffness_warnings", "to_ross", "RotorDesign", "RotorSeat", "RotorCases",
]  # fmt: skip


_LATE = {
    "nonlinear": "nonlinear",
    **dict.fromkeys(("RotorDesign", "RotorSeat", "RotorCases"), "rotor_design"),
}


def __getattr__(name: str):
    """Import the file of a name at its first use: systems of shafts do without."""
    if name not in _LATE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = _import_module(f".{_LATE[name]}", __name__)
    globals()[name] = found if name == _LATE[name] else getattr(found, name)
    return globals()[name]

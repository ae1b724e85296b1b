"""Dynamics: balls and rollers that skid.

`SkidModel(element, lubricant, temperature, traction=..., drag=..., cage=...,
least_film=..., inlet_heating=...)` is a bearing with its oil.

The state in the end
--------------------

`skid.steady(model, load, speed=..., support=...)` finds the steady state of the balls
without integrating in time: orbit and spin relative to pure rolling (`slip`), film,
sliding and heat of every contact, friction torque and power balance. The torque is that
of sliding and of drag: resistance to rolling, hysteresis and seals, most of what a
catalogue's formula gives, are left out (benchmarks/skid_friction.py). Under an axial
load one ball stands for all; otherwise the motion repeats from orbit to orbit and is
found at places along it (`places`). It is differentiable with respect to design, oil,
load and speeds, and a map over loads is one `jax.vmap` (`places=1, throw=False`; read
`result`). Contact loads, angles and the place of the ring belong to the same
equilibrium: balls are thrown outwards by the orbit that they have (`load_speed=speed`:
by that of pure rolling, as in the published method), with the raceway control of the
bearing (`EqualShare()` there). "Converged" says that forces and powers balance, the
powers to a millionth (`imbalance`). Balls are free in their pockets: compare `wander`
with the pocket clearance. No oil sustains shear stresses of more than some 0.12 times
the pressure, which a Newtonian film soon exceeds: `skid_warnings` warns of it, and
`traction=Eyring()` or `LimitingStress()` of `bearingjax.lubrication` yields. At
high speed films are thinner, because the oil is sheared warm before it enters:
`inlet_heating=True`.

In time
-------

`skid.simulate(model, load, speed=..., times=...)` follows every ball and the cage from
rolling, from rest (`speed=SpeedTable(...)`, `ramp(...)`) or from a motion of your own,
with pocket contact on both sides, drag and gravity (`SkidOptions(axis="horizontal")`),
by a linearly implicit method with the exact Jacobian. Speeds, slip, films, heat, cage
forces and friction torque come with a balance of all powers (`imbalance`), a result
code, and derivatives in either mode (`derivatives="reverse"` or `"forward"`). Loads
over time (`LoadHistory`, `SinusoidalLoad`, or your own function of time) are balanced
at every time with the balls where they are; a constant load is tabulated around the
bearing, which is three times faster and does not see balls bunch (`balanced=True`
does). Against SciPy's stiff solvers at like errors: benchmarks/skid_transient.py; a map
of 1000 end states in one call: benchmarks/skid_map.py. Where others use the processor
too, set `OPENBLAS_NUM_THREADS=1` for end states under radial loads: LAPACK's threads
otherwise wait for each other.

`sliding_spectrum(history)` has the lines of a ball's sliding, `zones(steady)` the parts
of the orbit with loads above those of the axial load alone, `sliding_ellipse` slip and
heat over one contact; `raceway_heat` of an end state is the sum over all contacts.

Rollers
-------

Cylindrical and needle rollers skid in the same model: `skid.steady` of a roller bearing
gives its cage speed under light radial load (`cage_speed`, `slip`), the spin of each
roller along its orbit, sliding and heat, and the force with which the cage
pushes rollers forwards or holds them back (`cage_force`). All rollers orbit with the
cage, which those under load drive against the drag of the oil (Harris 1966); inertia of
the spin is included, friction on ribs and in pockets is not. In time (`skid.simulate`,
under a constant load) rollers meet front and rear of pockets with clearance; with tight
and stiff ones they end where `skid.steady` says. Loads over time are those of the
centrifugal force of pure rolling; where slip is gross, give `load_speed=Speed(w, w)`, w
the cage speed of the end state. The drag decides: its `fill`, the share of oil between
the rings, is seldom known (benchmarks/skid_roller.py).

Design
------

`SkiddingBearing(SkidModel(...), preload=400.0)` is optimised as a bearing is
(`bearingjax.optimise`), with the measures `FrictionTorque`, `FrictionPower` (weighted
by hours) and `CageSlip`; variables are then "preload",
"model.element.bearing.contact_angle", "model.temperature" and the like. Least friction
torque with at most 1 % slip over a spectrum: benchmarks/skid_design.py. `skid_warnings`
warns of pockets too tight for the end state or too wide for the balls,
shear stresses that no oil sustains, an oil that is a glass, films that are not
elastohydrodynamic or too thin, gross skidding.

Names
-----

- The bearing in its oil: `SkidModel`, `Cage`, `Drag`.
- Steady motion: `steady`, `SteadySkid`, `SteadyRollerSkid`, `Power`, `zones`, `Zone`.
- Motion in time: `simulate`, `SkidOptions`, `SkidHistory`, `SkidRollerHistory`,
  `SkidState`, `rest_state`, `SpeedTable`, `ramp`, `LoadHistory`, `SinusoidalLoad`.
- Contacts: `conditions`, `Conditions`, `sliding_ellipse`, `Ellipse`,
  `sliding_spectrum`, `SlidingSpectrum`.
- Optimisation: `SkiddingBearing`, `FrictionTorque`, `FrictionPower`, `CageSlip`.
- Warnings: `skid_warnings`.
"""

from .conditions import Conditions, conditions
from .contact_ellipse import Ellipse, sliding_ellipse
from .model import SkidModel
from .motion import SkidState, rest_state
from .orbits.orbit_zones import Zone, zones
from .orbits.steady import steady
from .orbits.steady_results import Power, SteadyRollerSkid, SteadySkid
from .ring_load import LoadHistory, SinusoidalLoad
from .ring_speed import SpeedTable, ramp
from .skidding_bearing import CageSlip, FrictionPower, FrictionTorque, SkiddingBearing
from .surroundings import Cage, Drag
from .transients.history import (
    SkidHistory,
    SkidRollerHistory,
    SlidingSpectrum,
    sliding_spectrum,
)
from .transients.transient import SkidOptions, simulate
from .warning import skid_warnings

__all__ = [
    "SkidModel", "Cage", "Drag", "steady", "SteadySkid", "SteadyRollerSkid", "Power",
    "zones", "Zone", "simulate", "SkidOptions", "SkidHistory", "SkidRollerHistory",
    "SkidState", "rest_state", "SpeedTable", "ramp", "LoadHistory", "SinusoidalLoad",
    "conditions",
    "Conditions", "sliding_ellipse", "Ellipse", "sliding_spectrum", "SlidingSpectrum",
    "SkiddingBearing", "FrictionTorque", "FrictionPower", "CageSlip", "skid_warnings",
]  # fmt: skip

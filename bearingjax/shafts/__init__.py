"""Systems of shafts: gears, belts, bearings in place, housing, load cases, heat.

A `ShaftSystem` holds `ShaftLine`s (segments, and where they are in space), `Seat`s
(bearings in their places), wheels (`Gear`, `Pulley`) that couple shafts or are driven
from outside, `Coupling`s, free `ShaftLoad`s, a `Drive`, and the stiffness of the
housing. All numbers are traced; names and the order of the stations are static.

    system = ShaftSystem(shafts, seats, Drive("in", speed=155.0, power=22e3), wheels)
    found = solve_system(system)                  # loads, tilts, lines, misalignment
    bearings = bearing_solutions(system, found)   # a Solution for each: lives, films …
    slopes = jax.jit(jax.grad(lambda s: solve_system(s).load[0, 1]))(system)

`power_flow` gives speeds, torques and forces of the wheels alone. Positions, diameters,
preloads, clearances and the rest are changed by `equinox.tree_at`; many cases are
solved by `jax.vmap`, or with their lives by `solve_duty`; `bearing_hours` adds up
their damage and `system_life` is the life that all bearings reach together.

`solve_heat(system, HeatNetwork(...))` finds the temperatures in equilibrium with
friction, or says that they run away (`runaway_speed` from which speed), and `warm_up`
follows them in time.

`bearingjax.optimise` takes a `ShaftDesign` with its `load_cases`, any number of the
system as `Variable`, and the measures `SystemLife`, `Worst` (life, static safety,
pressure, tilt, misalignment), `PowerLoss`, `ShaftMass`.

The frame, the signs of torques and the force of a gear are described in `shafts.line`
and `shafts.parts`. Left out: torsion, loops of meshes (planetary gears), stiffness of
teeth, friction of floating rings, heat along the shaft from one bearing to the next.

Names
-----

- The system: `ShaftSystem`, `ShaftLine`, `Seat`, `Gear`, `Pulley`, `Coupling`, `Drive`,
  `ShaftLoad`, `HousingStiffness`.
- Equilibrium: `solve_system`, `SystemSolution`, `ShaftState`, `bearing_solutions`,
  `power_flow`, `PowerFlow`.
- Load cases: `solve_duty`, `DutyResult`, `bearing_hours`, `system_life`.
- Heat: `solve_heat`, `HeatNetwork`, `ThermalPaths`, `ThermalState`, `BearingOil`,
  `usual_conductance`, `runaway_speed`, `warm_up`.
- Optimisation: `ShaftDesign`, `load_cases`, `ShaftCases`, `SystemLife`, `Worst`,
  `PowerLoss`, `ShaftMass`.
"""

from .bearing_oil import BearingOil
from .duty import DutyResult, bearing_hours, solve_duty, system_life
from .equilibrium import solve_system
from .heat import (
    HeatNetwork,
    ThermalPaths,
    ThermalState,
    runaway_speed,
    solve_heat,
    usual_conductance,
    warm_up,
)
from .line import ShaftLine
from .parts import Coupling, Drive, Gear, Pulley, Seat, ShaftLoad
from .power import PowerFlow, power_flow
from .seats import bearing_solutions
from .shaft_design import (
    PowerLoss,
    ShaftCases,
    ShaftDesign,
    ShaftMass,
    SystemLife,
    Worst,
    load_cases,
)
from .state import ShaftState, SystemSolution
from .system import HousingStiffness, ShaftSystem

__all__ = [
    "ShaftSystem", "ShaftLine", "Seat", "Gear", "Pulley", "Coupling", "Drive",
    "ShaftLoad", "HousingStiffness", "solve_system", "SystemSolution", "ShaftState",
    "bearing_solutions", "power_flow", "PowerFlow", "solve_duty", "DutyResult",
    "bearing_hours", "system_life", "solve_heat", "HeatNetwork", "ThermalPaths",
    "ThermalState", "BearingOil", "usual_conductance", "runaway_speed", "warm_up",
    "ShaftDesign", "load_cases", "ShaftCases", "SystemLife", "Worst", "PowerLoss",
    "ShaftMass",
]  # fmt: skip

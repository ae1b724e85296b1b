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
"""

from .bearing_oil import BearingOil as BearingOil
from .duty import DutyResult as DutyResult
from .duty import bearing_hours as bearing_hours
from .duty import solve_duty as solve_duty
from .duty import system_life as system_life
from .equilibrium import solve_system as solve_system
from .heat import HeatNetwork as HeatNetwork
from .heat import ThermalPaths as ThermalPaths
from .heat import ThermalState as ThermalState
from .heat import runaway_speed as runaway_speed
from .heat import solve_heat as solve_heat
from .heat import warm_up as warm_up
from .line import ShaftLine as ShaftLine
from .parts import Coupling as Coupling
from .parts import Drive as Drive
from .parts import Gear as Gear
from .parts import Pulley as Pulley
from .parts import Seat as Seat
from .parts import ShaftLoad as ShaftLoad
from .power import PowerFlow as PowerFlow
from .power import power_flow as power_flow
from .seats import bearing_solutions as bearing_solutions
from .shaft_design import PowerLoss as PowerLoss
from .shaft_design import ShaftCases as ShaftCases
from .shaft_design import ShaftDesign as ShaftDesign
from .shaft_design import ShaftMass as ShaftMass
from .shaft_design import SystemLife as SystemLife
from .shaft_design import Worst as Worst
from .shaft_design import load_cases as load_cases
from .state import ShaftState as ShaftState
from .state import SystemSolution as SystemSolution
from .system import HousingStiffness as HousingStiffness
from .system import ShaftSystem as ShaftSystem

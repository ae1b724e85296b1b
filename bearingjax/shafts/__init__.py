"""Systems of shafts: gears, belts, bearings in place, housing, load cases, heat."""

from .duty import DutyResult as DutyResult
from .duty import bearing_hours as bearing_hours
from .duty import solve_duty as solve_duty
from .duty import system_life as system_life
from .equilibrium import ShaftState as ShaftState
from .equilibrium import SystemSolution as SystemSolution
from .equilibrium import bearing_solutions as bearing_solutions
from .equilibrium import solve_system as solve_system
from .heat import HeatNetwork as HeatNetwork
from .heat import ThermalPaths as ThermalPaths
from .heat import ThermalState as ThermalState
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
from .system import HousingStiffness as HousingStiffness
from .system import ShaftSystem as ShaftSystem

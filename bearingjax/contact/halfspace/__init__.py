"""Elastic contact without Hertz's assumptions: bodies as half-spaces, cell by cell.

Slices are independent of their neighbours, while profiles are made for the end values.
Here roller and raceway are elastic half-spaces; preconditioned conjugate gradients take
a score of steps on any grid, and cells graded towards the ends save most of the grid:

    roller = RollerContact(0.015, 0.010, 0.010, roller_profile=Logarithmic())
    contact = roller.solve(3000.0, tilt=3e-4)  # N, rad; or moment=..., or approach=...
    print(contact.peak_pressure, contact.approach, contact.moment, contact.steps)

The raceway is a plane unless `raceway_radius` says otherwise (positive: convex,
negative: hollow); tapers have two diameters. `contact.centre_pressure` and `line_load`
run along the roller, at `contact.grid.y`. A sharp end under a longer raceway has an
infinite pressure, of which a cell shows the more the smaller it is: compare at fixed
distances from the end. Derivatives go through the solve, for about one more (cells that
come into contact or leave it make kinks); under `jit` give the cells,
`grid=roller.grid(half_width)`; where they do not hold the contact, the result is
`grid_misfit`.

`FreeEnds` gives the roller's end faces no stress to bear (a half-space is too stiff
there): the pressure mirrored at them acts as well, weighted by place as a quarter-space
asks for (benchmarks/quarter_space.py). `stress_below` has the whole stress tensor at
any points of either body; `plot.contact_stress` draws a section. `bearingjax.refine`
takes a roller of any solved bearing here. Worked: the notebook half_space_contact.

Names
-----

- A roller on a raceway: `RollerContact`, `FreeEnds`.
- Any two bodies: `solve_pressure`, `ContactSolution`, `influence`, `AbstractInfluence`.
- Cells: `Grid`, `even_grid`, `graded_grid`.
- Pressure solvers: `ConjugateGradients`, `Strips`, `AbstractPressureSolver`, `Problem`,
  `PressureSolution`.
- Stress below the surface: `stress_below`, `Stress`.
"""

from .ends import FreeEnds
from .gradients import AbstractPressureSolver, ConjugateGradients
from .grid import Grid, even_grid, graded_grid
from .influence import AbstractInfluence, influence
from .pressure import ContactSolution, solve_pressure
from .problem import PressureSolution, Problem
from .roller import RollerContact
from .stress import Stress, stress_below
from .strips import Strips

__all__ = [
    "RollerContact", "FreeEnds", "solve_pressure", "ContactSolution", "influence",
    "AbstractInfluence", "Grid", "even_grid", "graded_grid", "ConjugateGradients",
    "Strips", "AbstractPressureSolver", "Problem", "PressureSolution", "stress_below",
    "Stress",
]  # fmt: skip

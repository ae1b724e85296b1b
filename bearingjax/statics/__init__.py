"""Load solves, preload, linearisation, and their results.

`solve_load(element, load)` finds the displacement of the rings under a load and returns
a `Solution`: displacement, stiffness, the load and pressure of every contact.
`warnings(solution)` lists the warnings about it (pressure beyond 4 GPa, a truncated
ellipse, a direction that nothing holds), as the command line prints it; a sweep counts
them (`swept.warning_counts()`). A preloaded pair is one of three: `preload_offset` (a
displacement), `preload(element, force)` (the offsets that give the force,
differentiable), or `spring=PreloadSpring(force, stiffness)` on the row at +z (then see
`solution.spring_force` and `spring_travel`).

A solve that fails
------------------

- `no_load_path` names the freedom that nothing holds: turn the load round, add preload,
  or prescribe that freedom.
- `step_limit` gives the residual: raise `SolveOptions(max_steps=...)`, or look at
  clearance and preload.
- `non_finite`: look for NaN, or loads, speeds and sizes of another scale.
- `saddle`: finite kinematics only.
- `grid_misfit` (half-space contacts): more than a thousandth of the load stands at the
  sides of the grid, or the contact is fewer than three cells wide or long.

Under `jit` and `vmap` use `throw=False` and read `solution.result`, one code per case.

A freedom that is prescribed, or left out of `free`, is held (`solution.held`): a load
on it is an error, or under `jit` the result code `no_load_path`, because its support
would take it. What the support passes to the bearing is in `force`.

Failed cases in a gradient: the derivative of a failed solve is NaN. Where a mask leaves
it out it is zero, of a life (`rating_life`) too::

    s = jax.vmap(lambda load: solve_load(element, load, throw=False))(loads)
    total = jnp.sum(jnp.where(s.converged[:, None], s.displacement, 0.0))

Mask what was solved itself: NaN comes back from what else is computed from a failed
case before the mask.

Names
-----

- Load solves: `solve_load`, `Support`, `SolveOptions`, `Solution`, `BallSolution`,
  `RollerSolution`, `Stats`.
- Preload and seats: `Installed`, `preload`, `remaining_preload`, `SetPreload`.
- Stiffness: `linearise`, `OperatingPoint`, `restrained_freedoms`.
- Half-space contact of one roller: `refine`, `RefinedContact`.
- Warnings: `warnings`, `seat_warnings`, `speed_warnings`.
"""

from .installed import Installed
from .linearise import OperatingPoint, linearise
from .load import solve_load
from .options import SolveOptions
from .preload import SetPreload, preload, remaining_preload
from .refine import RefinedContact, refine
from .service_warning import seat_warnings, speed_warnings
from .solution import BallSolution, RollerSolution, Solution, Stats
from .support import Support, restrained_freedoms
from .warning import warnings

__all__ = [
    "solve_load", "Support", "SolveOptions", "Solution", "BallSolution",
    "RollerSolution", "Stats", "Installed", "preload", "remaining_preload",
    "SetPreload", "linearise", "OperatingPoint", "restrained_freedoms", "refine",
    "RefinedContact", "warnings", "seat_warnings", "speed_warnings",
]  # fmt: skip

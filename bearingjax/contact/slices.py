"""A roller in slices, compared with its contact cell by cell."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jax import lax

from ..numerics import ContactMapped, Result, Warning, as_real
from ..numerics.compiled.programs import program
from ..numerics.implicit import attach_roots, stop_gradient
from ..numerics.shown import Printable
from ..numerics.types import Number, Scalar, Vector
from ..numerics.units import unit
from .halfspace.pressure import ContactSolution
from .halfspace.roller import RollerContact
from .line import LINE_EXPONENT, AbstractLineLaw, Palmgren, peak_pressure
from .line_contact import LineContact, response

_ENOUGH = 1e-13
"""Share of the approach by which the last step may still move."""

_STEPS = 60

WIDE = 0.2
"""Half width of a contact over the roller radius above which a warning is given [1]."""

FEW = 5
"""Cells across or along a contact below which a warning is given."""


class Slices(Printable):
    """Line contact under the load and tilt of a contact.

    Attributes:
        approach: At y = 0 [m].
        line_load: Load per length (n,) [N/m].
        pressure: Hertz's largest pressure across the contact (n,) [Pa].
    """

    approach: Scalar = eqx.field(metadata=unit("m"))
    line_load: Vector = eqx.field(metadata=unit("N/m"))
    pressure: Vector = eqx.field(metadata=unit("Pa"))

    @property
    def peak_pressure(self) -> Scalar:
        """Largest pressure [Pa]."""
        return jnp.max(self.pressure)


@program(quick=True)
def slices(
    contact: RollerContact,
    load: Number,
    tilt: Number,
    position: Vector,
    law: AbstractLineLaw | None = None,
) -> Slices:
    """Return the solution of independent slices.

    The approach is found by Newton's method: the load is a convex function of it, so
    that steps come from above after the first.

    Args:
        contact: Roller and raceway.
        load: Load, zero or more [N].
        tilt: Tilt, positive where it closes the gap at y > 0 [rad].
        position: Positions along the roller, y (n,) [m].
        law: Line law of independent slices; default `Palmgren()`.

    Fails: NaN if the approach is not found.
    """
    law = Palmgren() if law is None else law
    length, load, tilt = contact.roller_length, as_real(load), as_real(tilt)
    line = LineContact(
        constant=law.constant(contact.material, contact.raceway_material, length),
        length=length,
        diameter=contact.diameter,
        roller_profile=contact.roller_profile,
        raceway_profile=contact.raceway_profile,
        arc_radii=contact.arc_radii,
    )
    rule = ContactMapped()
    made = line.table(rule)
    end, xi = 0.5 * length * tilt, 2.0 * position / length
    # The approach of an even load, counted from where the bodies touch first.
    first = jnp.min(line.drop(xi) - tilt * position)
    even = (load / (line.constant * length)) ** (LINE_EXPONENT[1] / LINE_EXPONENT[0])

    def load_error(approach, args):
        line, made, load, end = args
        found = response(line, made, rule, approach, end)
        return load - found.load[0], found.stiffness[0]

    args = line, made, load, end
    frozen, even, far = stop_gradient((args, even, even + jnp.abs(end)))

    def step(state):
        approach, _, steps = state
        rest, slope = load_error(approach, frozen)
        change = rest / jnp.where(slope > 0, slope, 1.0)
        return approach + change, change, steps + 1

    def continues(state):
        _, change, steps = state
        return (jnp.abs(change) > _ENOUGH * far) & (steps < _STEPS)

    begin = step((stop_gradient(first) + even, even, 0))
    approach, change, _ = lax.while_loop(continues, step, begin)
    # Round-off may keep the last digits moving; where more than half of them do, it is
    # no answer.
    half = jnp.finfo(change.dtype).eps ** 0.5
    approach = jnp.where(jnp.abs(change) <= half * far, approach, jnp.nan)
    approach = attach_roots(lambda x, args: load_error(x, args)[0], approach, args)
    line_load = line.load_along(made, xi, approach, end)
    radius = contact.relative_radius(position)
    pressure = peak_pressure(line_load, radius, contact.modulus)
    return Slices(approach, line_load, pressure)


class SliceComparison(Printable):
    """A single solved contact, and slices under the same load and tilt.

    Attributes:
        solution: Solved contact; check its result code.
        slices: Solution of the slices.
    """

    solution: ContactSolution
    slices: Slices

    @property
    def half_width(self) -> np.ndarray:
        """Half width of the contact along the roller (n,) [m].

        Hertz's pressure squared is linear in x²: where that line through the two
        outermost cells in contact meets zero, within a cell.
        """
        grid = self.solution.grid
        side = np.asarray(grid.x) >= 0
        x, cell = np.asarray(grid.x)[side], 2.0 * float(grid.half_x)
        pressure = np.asarray(self.solution.pressure)[side]
        count, columns = (pressure > 0).sum(axis=0), np.arange(pressure.shape[1])
        last = np.maximum(count - 1, 0)
        before = np.maximum(last - 1, 0)
        outer, inner = pressure[last, columns] ** 2, pressure[before, columns] ** 2
        fall = np.where(inner > outer, inner - outer, np.inf)
        square = x[last] ** 2 + outer * (x[last] ** 2 - x[before] ** 2) / fall
        found = np.where(count > 1, np.sqrt(square), x[last] + 0.5 * cell)
        limited = np.clip(found, x[last], x[last] + cell)
        return np.where(count > 0, limited, 0.0)

    @property
    def peak(self) -> int:
        """Place along the roller of the cell with the largest pressure."""
        pressure = np.asarray(self.solution.pressure)
        return int(np.argmax(pressure.max(axis=0)))

    @property
    def peak_at_end(self) -> bool:
        """Whether that cell is the first or the last one along the roller."""
        return self.peak in (0, np.shape(self.solution.pressure)[1] - 1)

    @property
    def edge_factor(self) -> float:
        """Largest pressure over that of the slices [1]."""
        return float(self.solution.peak_pressure / self.slices.peak_pressure)

    @property
    def touches(self) -> bool:
        """Whether there is a contact."""
        return bool(np.asarray(self.solution.pressure).any())


def compared_warnings(
    contact: RollerContact, cases: list[SliceComparison], narrowed: str | None = None
) -> list[Warning]:
    """Warnings about solved contacts of a roller.

    Args:
        contact: The roller and its raceway, concrete as all that is given.
        cases: Its contacts; unsolved ones are skipped, except for a grid that is too
            narrow.
        narrowed: Name of the setting that made the grid narrower than the bodies;
            `None`: it is as wide as they are.
    """
    found = []
    solved = [case for case in cases if case.solution.converged]
    for case in solved:
        if not case.touches:
            approach = float(case.solution.approach)
            words = f"approach {1e6 * approach:.4g} um: the bodies do not touch"
            found.append(Warning("no_contact", words, approach))
    held = (int(Result.CONVERGED), int(Result.GRID_MISFIT))
    narrow = [
        c for c in cases if c.solution.truncated and int(c.solution.result) in held
    ]
    if narrow:
        cure = "it is as wide as the roller or its raceway"
        if narrowed is not None:
            cure = f"give a larger `{narrowed}`, or none"
        words = "the contact reaches the sides of the grid; what it carries beyond them"
        one = Warning("narrow_grid", f"{words} is missing; {cure}")
        found.append(one.about(_loads(narrow)))
    coarse = [case for case in solved if case.touches and _is_coarse(case.solution)]
    if coarse:
        words = (
            f"the contact is less than {FEW} cells wide or long; its pressures may be"
            " off by some hundredths: take more cells"
        )
        found.append(Warning("coarse_grid", words, limit=FEW).about(_loads(coarse)))
    radius = 0.5 * float(contact.small_diameter)
    wide = [case for case in solved if case.half_width.max() > WIDE * radius]
    if wide:
        words = (
            f"the contact is too wide beside the roller, more than {WIDE:g} of its"
            " radius to each side, for both bodies to be half-spaces"
        )
        size = max(float(case.half_width.max()) for case in wide) / radius
        found.append(Warning("wide_contact", words, size, WIDE).about(_loads(wide)))
    sharp = [case for case in solved if case.touches and case.peak_at_end]
    if sharp:
        length = 2e6 * float(sharp[0].solution.grid.half_y[0])
        words = (
            f"the peak pressure is that of an end cell, {length:.4g} µm long; under a"
            " sharp end it grows without limit as cells shrink: compare at fixed"
            " distances from the end"
        )
        found.append(Warning("sharp_ends", words).about(_loads(sharp)))
    return found


def _is_coarse(solution):
    across, along = (int(count) for count in solution.cells)
    return across < FEW or along < min(FEW, solution.grid.shape[1])


def _loads(cases):
    return ", ".join(f"{float(case.solution.load):.5g}" for case in cases) + " N"

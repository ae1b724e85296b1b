"""One roller on one raceway, as the contact of two half-spaces."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.checks import check, floats, in_range, is_traced, positive
from ...design.material import Material, contact_modulus
from ...design.profile import AbstractProfile, Straight, between_arcs, sagitta
from ...numerics.types import Number, Real, RealOrNone, Reals, Scalar, as_real
from ...numerics.units import real
from ...numerics.warning import Warning
from .ends import FreeEnds
from .gradients import AbstractPressureSolver, ConjugateGradients
from .grid import Grid, even_grid, graded_grid
from .influence import AbstractInfluence, influence
from .pressure import LEAST_CELLS, ContactSolution, solve_pressure

MARGIN = 1.6
"""Half width of the grid over that of the contact: sharp ends bulge."""

_MOST = 512
"""Cells along the roller where its width is looked for."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


class RollerContact(eqx.Module):
    """A roller on a raceway, pressed together along a common generatrix.

    y runs along the generatrix from the middle of the roller, x across it. The small
    end of a taper is at y > 0, as in the `position` of a solved bearing.

    Attributes:
        roller_length: Effective length L [m].
        small_diameter: Diameter of the roller at y = L/2 [m].
        large_diameter: Diameter of the roller at y = -L/2 [m].
        half_angle: Half cone angle of the roller [rad]; `None`: from the diameters,
            arctan of their difference over 2L.
        raceway_radius: Radius of curvature of the raceway normal to the generatrix, at
            y = 0: positive for a convex one (inner ring), negative for a hollow one
            (outer ring), infinite for a plane [m].
        raceway_half_angle: Half cone angle of the raceway, which widens towards the
            roller's large end, y < 0 [rad].
        arc_radii: Radii of the arcs along the generatrices of roller and raceway, that
            of the raceway hollow, from which the profiles are measured [m]; `None`:
            straight ones.
        roller_profile, raceway_profile: Profiles.
        material, raceway_material: Materials.
        free_ends: `FreeEnds()`: the roller's end faces are free; `None`: it is taken as
            a half-space, too stiff at its ends.

    Traced: all fields.
    Source: sections of a cone normal to its generatrix: Mi & Xia (2011), eq. (10) to
        (13), with the exact ellipse in place of (12).
    """

    roller_length: Real = eqx.field(**real("m", "effective length"))
    small_diameter: Real = eqx.field(**real("m", "diameter at the small end"))
    large_diameter: Real = eqx.field(**real("m", "diameter at the large end"))
    half_angle: RealOrNone = eqx.field(
        **real("rad", "half cone angle"), default=None, kw_only=True
    )
    raceway_radius: Real = eqx.field(**real("m"), default=np.inf, kw_only=True)
    raceway_half_angle: Real = eqx.field(**real("rad"), default=0.0, kw_only=True)
    arc_radii: tuple[Scalar, Scalar] | None = eqx.field(default=None, kw_only=True)
    roller_profile: AbstractProfile = eqx.field(default_factory=Straight, kw_only=True)
    raceway_profile: AbstractProfile = eqx.field(default_factory=Straight, kw_only=True)
    material: Material = eqx.field(default_factory=Material, kw_only=True)
    raceway_material: Material = eqx.field(default_factory=Material, kw_only=True)
    free_ends: FreeEnds | None = eqx.field(default=None, kw_only=True)

    def __check_init__(self):
        positive(self, "roller_length")
        positive(self, "small_diameter")
        positive(self, "large_diameter")
        radius = self.raceway_radius
        check(
            self,
            "raceway_radius",
            radius != 0,
            "positive (convex), negative (hollow) or infinite (plane)",
        )
        if self.half_angle is not None:
            in_range(self, "half_angle", -0.7, 0.7)
        in_range(self, "raceway_half_angle", -0.5 * np.pi, 0.5 * np.pi)
        numbers = floats(
            self.roller_length, self.small_diameter, self.large_diameter, self.angle
        )
        if numbers is not None:
            self._check_against(numbers, floats(radius))
        length, diameter = self.roller_length, self.diameter
        self.roller_profile.check(length, diameter)
        self.raceway_profile.check(length, diameter)

    def _check_against(self, numbers, radius):
        _, small, large, angle = numbers
        check(
            self,
            "large_diameter",
            large >= small,
            f"at least `small_diameter`, {small:g} m",
        )
        if radius is not None and radius[0] < 0:
            check(
                self,
                "raceway_radius",
                -radius[0] > 0.5 * large / np.cos(angle),
                "larger in size than the roller's own radius, if it is hollow",
            )

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """A warning if the half angle is not that of the diameters; none if traced."""
        numbers = floats(
            self.roller_length, self.small_diameter, self.large_diameter, self.angle
        )
        if numbers is None:
            return ()
        length, small, large, angle = numbers
        taper = np.arctan((large - small) / (2.0 * length))
        apart, limit = abs(angle - taper), 0.01 * max(abs(angle), abs(taper))
        if not apart > limit:
            return ()
        words = (
            f"the half angle is {np.rad2deg(angle):.4g}°, but diameters of"
            f" {1e3 * small:g} and {1e3 * large:g} mm over {1e3 * length:g} mm make"
            f" {np.rad2deg(taper):.4g}°; both are used as they are"
        )
        return (Warning("half_angle", words, float(apart), float(limit)),)

    @property
    def diameter(self) -> Scalar:
        """Mean diameter [m]."""
        return 0.5 * (self.small_diameter + self.large_diameter)

    @property
    def angle(self) -> Scalar:
        """Half cone angle, given or from the diameters [rad]."""
        if self.half_angle is not None:
            return self.half_angle
        taper = self.large_diameter - self.small_diameter
        return jnp.arctan2(0.5 * taper, self.roller_length)

    @property
    def modulus(self) -> Scalar:
        """Contact modulus E* [Pa]."""
        return contact_modulus(self.material, self.raceway_material)

    def influence(self, grid: Grid) -> AbstractInfluence:
        """Influence of pressure between this roller and its raceway.

        Args:
            grid: The cells, as long as the roller.
        """
        mirrored = None
        if self.free_ends is not None:
            mirrored = self.free_ends.weight(self.material, self.raceway_material)
        return influence(grid, self.modulus, mirrored)

    def roller_radius(self, y: Reals) -> Reals:
        """Radius of curvature of the roller normal to the generatrix at y [m]."""
        slope = (self.large_diameter - self.small_diameter) / self.roller_length
        radius, cosine = 0.5 * (self.diameter - slope * y), jnp.cos(self.angle)
        if self.arc_radii is None:
            return radius / cosine
        arc = self.arc_radii[0]
        lean = self.angle + jnp.arcsin(y / arc)
        return (radius - sagitta(y, arc) * cosine) / jnp.cos(lean)

    def relative_radius(self, y: Reals) -> Reals:
        """Radius of relative curvature 1/(1/roller + 1/raceway) at y [m]."""
        return 1.0 / (1.0 / self.roller_radius(y) + self._raceway_curvature(y))

    def _raceway_curvature(self, y):
        """One over the radius, so that a plane is a number like any other."""
        side, angle = jnp.sign(self.raceway_radius), self.raceway_half_angle
        wider = -y * jnp.tan(angle)
        if self.arc_radii is None:
            return 1.0 / (self.raceway_radius + side * wider)
        # Over the cosine of the angle, as is what becomes wider.
        arc = self.arc_radii[1]
        wider = wider + side * sagitta(y, arc)
        lean = jnp.cos(angle - side * jnp.arcsin(y / arc)) / jnp.cos(angle)
        return lean / (self.raceway_radius + side * wider)

    def drop(self, y: Reals) -> Reals:
        """Material removed from both bodies at y [m]."""
        length, diameter = self.roller_length, self.diameter
        drop = self.roller_profile.drop(
            y, length, diameter
        ) + self.raceway_profile.drop(y, length, diameter)
        if self.arc_radii is None:
            return drop
        return drop + between_arcs(y, self.arc_radii)

    def gap(self, grid: Grid) -> Float[Array, "m n"]:
        """Distance of roller and raceway as they touch, at each cell [m].

        Along even cells at their middles, along graded ones the mean of the drop.

        Args:
            grid: The cells, as long as the roller.

        Returns:
            Gap; NaN if a traced grid is not as long as the roller.

        Raises:
            ValueError: If `grid` is not as long as the roller.
        """
        x, y = grid.x, grid.y
        fits = self._covers_roller(grid)
        drop = self.drop(y)
        if not grid.even:
            nodes = jnp.asarray(_NODES, y.dtype)[:, None]
            weights = jnp.asarray(0.5 * _WEIGHTS, y.dtype)
            drop = weights @ self.drop(y[None] + nodes * grid.half_y[None])
        roller = _section(x, 1.0 / self.roller_radius(y), self.angle)
        raceway = _section(x, self._raceway_curvature(y), self.raceway_half_angle)
        gap = roller + raceway + drop[None]
        return jnp.where(fits, gap, jnp.nan) if is_traced(fits) else gap

    def _covers_roller(self, grid):
        """Whether cells reach from end to end of the roller."""
        edges, length = grid.edges, self.roller_length
        traced = is_traced(edges) or is_traced(length)
        xp = jnp if traced else np
        edges = xp.asarray(edges)
        ends = xp.stack([-edges[0], edges[-1]])
        half = 0.5 * xp.asarray(length, ends.dtype)
        fits = xp.all(xp.abs(ends - half) <= 1e-5 * half)
        if not traced:
            allowed = f"as long as the roller, {2.0 * half:.6g} m, and centred"
            length = edges[-1] - edges[0]
            check("RollerContact.gap", "grid", fits, allowed, length, "m")
        return fits

    def grid(
        self,
        half_width: Number,
        n_across: int = 35,
        n_along: int = 64,
        grading: float = 2.0,
    ) -> Grid:
        """Cells for this roller.

        Args:
            half_width: Half the width across the roller [m].
            n_across, n_along: Number of cells.
            grading: As in `graded_grid`; 1: even cells.
        """
        if grading == 1.0:
            return even_grid(self.roller_length, half_width, n_across, n_along)
        return graded_grid(
            self.roller_length, half_width, n_across, n_along, grading=grading
        )

    def line_half_width(self, load: Number) -> Scalar:
        """Half width of an endless roller under the mean line load (Hertz) [m]."""
        radius = self.relative_radius(jnp.zeros_like(self.roller_length))
        line_load = as_real(load) / self.roller_length
        return jnp.sqrt(4.0 * line_load * radius / (jnp.pi * self.modulus))

    def solve(
        self,
        load: Number | None = None,
        *,
        approach: Number | None = None,
        moment: Number | None = None,
        tilt: Number | None = None,
        grid: Grid | None = None,
        solver: AbstractPressureSolver | None = None,
        throw: bool = True,
    ) -> ContactSolution:
        """Pressure between roller and raceway.

        Args:
            load, approach, moment, tilt, solver, throw: As in `solve_pressure`; the
                tilt closes the gap at y > 0, a taper's small end.
            grid: The cells; `None`: `self.grid` of a width found by coarse solves,
                which takes concrete numbers.

        Returns:
            ContactSolution.

        Raises:
            ValueError: As `solve_pressure`; if `grid` is wider than the roller, or not
                as long; if `grid` is `None` under a JAX transformation.
            SolveError: If `throw` and it did not converge.

        Fails: as `solve_pressure`.
        """
        given: dict[str, Any] = {
            "load": load,
            "approach": approach,
            "moment": moment,
            "tilt": tilt,
        }
        if grid is None:
            grid = self.grid(self.grid_half_width(given))
        width = grid.half_width
        fits = width < jnp.min(_reach(self, grid.y))
        check(self, "half_width", fits, "less than the roller's", width, "m")
        return solve_pressure(
            self.influence(grid),
            self.gap(grid),
            **given,
            solver=solver,
            throw=throw,
        )

    def grid_half_width(self, given: dict[str, Any]) -> float:
        """Half width of a grid that holds the contact, by coarse solves [m].

        Args:
            given: Arguments load, approach, moment and tilt of `solve`.

        Raises:
            ValueError: If a number is traced.
        """
        if any(is_traced(leaf) for leaf in jax.tree.leaves((self, given))):
            raise ValueError(
                "RollerContact.solve: give a `grid` under jit, grad and vmap, for"
                " example `contact.grid(1.6 * half_width)`."
            )
        radius = float(self.relative_radius(jnp.zeros_like(self.roller_length)))
        width, inside = 1e-2 * radius, 0.0
        most = 0.98 * float(_reach(self, jnp.zeros_like(self.roller_length)))
        cells: tuple[int, float] = (32, 2.0)
        for _ in range(24):
            width = min(width, most)
            coarse = self.grid(width, 16, *cells)
            found = solve_pressure(
                self.influence(coarse),
                self.gap(coarse),
                **given,
                solver=ConjugateGradients(tolerance=1e-4),
                throw=False,
            )
            touched = jnp.any(found.touching, axis=1)
            inside = float(jnp.max(jnp.where(touched, coarse.x, 0.0) + coarse.half_x))
            if 0 < int(found.cells[1]) < LEAST_CELLS and cells[0] < _MOST:
                # Too short a contact for cells that are long in the middle.
                cells = (4 * cells[0], 1.0)
            elif bool(found.truncated) and width < most:
                width *= 4.0
            elif inside < 0.25 * width and found.touching.any():
                width = max(MARGIN * inside, 0.1 * width)
            else:
                break
        return min(MARGIN * inside, most)


def _section(x, curvature, angle):
    """Height of a cone's sections normal to its generatrix (m, n) [m].

    A plane is one of curvature zero: with its radius, which is infinite, derivatives
    would be NaN.
    """
    x, curvature = x[:, None], curvature[None]
    rest = 1.0 - (x * curvature / jnp.cos(angle)) ** 2 * jnp.cos(2.0 * angle)
    return x * x * curvature / (1.0 + jnp.sqrt(rest))


def _reach(contact, y):
    """Half the width of the roller's section at y [m]."""
    angle = contact.angle
    roller = contact.roller_radius(y) * jnp.cos(angle) / jnp.sqrt(jnp.cos(2.0 * angle))
    return jnp.minimum(roller, 1.0 / jnp.abs(contact._raceway_curvature(y)))

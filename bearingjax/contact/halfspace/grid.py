"""Cells of a contact: rectangles, all of a width, of even or graded lengths."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...design.checks import check, positive
from ...numerics.types import Number, Real, Scalar, Vector, as_real
from ...numerics.units import real, unit


class Grid(eqx.Module):
    """Rectangular cells on the plane of contact, x across the roller, y along it.

    Where everything is symmetric about x = 0, which it is for a roller that is not
    skewed, only cells with x ≥ 0 are kept: half the work.

    Attributes:
        half_width: Half of the grid's width across the roller [m].
        edges: Ends of the cells along the roller, ascending (n+1,) [m].
        n_across: Cells across the whole width.
        symmetric: Whether only cells with x ≥ 0 are kept.
        even: Whether all cells are equally long.

    Static: n_across, symmetric, even.
    """

    half_width: Real = eqx.field(**real("m"))
    edges: Float[Array, " edge"] = eqx.field(converter=as_real, metadata=unit("m"))
    n_across: int = eqx.field(static=True)
    symmetric: bool = eqx.field(static=True)
    even: bool = eqx.field(static=True)

    def __check_init__(self):
        positive(self, "half_width")
        check(self, "n_across", self.n_across >= 3, "at least 3")
        rising = jnp.all(jnp.diff(self.edges) > 0)
        check(self, "edges", rising, "ascending")

    @property
    def shape(self) -> tuple[int, int]:
        """Number of cells kept: across, along."""
        across = (self.n_across + 1) // 2 if self.symmetric else self.n_across
        return across, self.edges.shape[0] - 1

    @property
    def half_x(self) -> Scalar:
        """Half the width of a cell [m]."""
        return self.half_width / self.n_across

    @property
    def half_y(self) -> Vector:
        """Half the length of each cell [m]."""
        return 0.5 * jnp.diff(self.edges)

    @property
    def x(self) -> Float[Array, " m"]:
        """Middles of the cells across the roller [m]."""
        count = self.shape[0]
        first = 0.5 * (1 - self.n_across % 2) if self.symmetric else 0.5 * (1 - count)
        place = jnp.arange(count, dtype=self.half_width.dtype) + first
        return 2.0 * self.half_x * place

    @property
    def y(self) -> Vector:
        """Middles of the cells along the roller [m]."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def times(self) -> Float[Array, " m"]:
        """Number of cells that each cell across represents: two, one in the middle."""
        twice = 2.0 * jnp.ones((self.shape[0],), self.half_width.dtype)
        if not self.symmetric:
            return 0.5 * twice
        return twice.at[0].set(1.0) if self.n_across % 2 else twice

    def unfold(self, field: Float[Array, "m n"]) -> Float[Array, "across n"]:
        """Expand a symmetric field from the cells kept to all cells [any unit]."""
        if not self.symmetric:
            return field
        other = field[1:] if self.n_across % 2 else field
        return jnp.concatenate([other[::-1], field])

    @property
    def area(self) -> Float[Array, "m n"]:
        """Area that each cell represents [m²]."""
        return 4.0 * self.half_x * self.times[:, None] * self.half_y[None]


def even_grid(
    length: Number,
    half_width: Number,
    n_across: int,
    n_along: int,
    *,
    symmetric: bool = True,
) -> Grid:
    """Cells of one size.

    Args:
        length: Along the roller [m]; the cells fill it from -length/2 on.
        half_width: Half the width across the roller [m].
        n_across, n_along: Number of cells across the whole width, and along.
        symmetric: Whether the contact is symmetric about x = 0.
    """
    return _grid(length, half_width, n_across, n_along, 1.0, symmetric)


def graded_grid(
    length: Number,
    half_width: Number,
    n_across: int,
    n_along: int,
    *,
    grading: float = 2.0,
    symmetric: bool = True,
) -> Grid:
    """Cells that are shorter towards both ends of the roller, as s^grading.

    Args:
        length, half_width, n_across, n_along, symmetric: As in `even_grid`.
        grading: Exponent, at least 1: cells in the middle are so many times longer
            than even ones; the length of the end cells is about
            length·n_along^(-grading).
    """
    check("graded_grid", "grading", grading >= 1, "at least 1", grading, "")
    return _grid(length, half_width, n_across, n_along, grading, symmetric)


def _grid(length, half_width, n_across, n_along, grading, symmetric):
    check("grid", "n_along", n_along >= 3, "at least 3", n_along, "")
    length = as_real(length)
    t = jnp.linspace(0.0, 1.0, n_along + 1, dtype=length.dtype)
    # From the nearer end, so that cells at both ends are equally long.
    near = jnp.minimum(t, 1.0 - t)
    part = near**grading / (near**grading + (1.0 - near) ** grading)
    place = jnp.where(t <= 0.5, part - 0.5, 0.5 - part)
    return Grid(half_width, length * place, n_across, symmetric, grading == 1.0)

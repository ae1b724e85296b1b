"""Equilibrium of the moving ring, common to solving, reporting and differentiation."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.types import Ring, Scalar
from .load_case import LoadCase


class Balance(eqx.Module):
    """Forces on the moving ring, in unknowns of one unit.

    The unknowns y (6,) are the freedoms of the moving ring in metres: shifts as they
    are, rotations times the pitch radius. Free ones are solved for, held ones have
    given values.

    Attributes:
        load: Load on the moving ring (6,) [N, N m].
        given: Displacements of the moving ring that are prescribed, zero of the others
            (6,) [m, rad].
        fixed: Displacement of the fixed ring (6,) [m, rad].
        scale: Displacement of the moving ring over y (6,) [1, 1/m].
        free: 1 where the freedom is free, 0 where it is held (6,) [1].
        radius: Pitch radius [m].
        outer_moves: Whether the outer ring is the moving one.

    Traced: all real numbers. Static: outer_moves.
    """

    load: Float[Array, "6"]
    given: Float[Array, "6"]
    fixed: Float[Array, "6"]
    scale: Float[Array, "6"]
    free: Float[Array, "6"]
    radius: Scalar
    outer_moves: bool = eqx.field(static=True)

    @property
    def moving_slice(self) -> slice:
        """Place of the moving ring among the ring freedoms (12,)."""
        return slice(0, 6) if self.outer_moves else slice(6, 12)

    @property
    def held_values(self) -> Float[Array, "6"]:
        """Unknowns of the held freedoms, zero of the free ones (6,) [m]."""
        return (1.0 - self.free) * (self.given / self.scale)

    def ring_freedoms(self, y: Float[Array, "6"]) -> Ring:
        """Freedoms of both rings (12,) [m, rad].

        Args:
            y: Unknowns [m].
        """
        mine = self.scale * y
        pair = [mine, self.fixed] if self.outer_moves else [self.fixed, mine]
        return jnp.concatenate(pair)

    def free_part(self, force: Float[Array, "6"]) -> Float[Array, "6"]:
        """Components of a force on the moving ring along the free unknowns (6,) [N].

        Moments are divided by the pitch radius; the equation of equilibrium is
        along(ring force - load) = 0.

        Args:
            force: Force and moment [N, N m].
        """
        return self.free * (self.scale * force)

    def out_of_balance(self, force: Ring) -> Float[Array, "6"]:
        """Force that is left on the free unknowns (6,) [N].

        Args:
            force: External load that would hold both rings where they are (12,)
                [N, N m].
        """
        return self.free_part(force[self.moving_slice] - self.load)


def balance_of(case: LoadCase, radius: Scalar) -> Balance:
    """The balance of a load case.

    Args:
        case: Load case.
        radius: Pitch radius [m].
    """
    one = jnp.ones_like(radius)
    return Balance(
        case.load,
        case.given,
        case.fixed,
        scale=jnp.concatenate([jnp.tile(one, 3), jnp.tile(1.0 / radius, 3)]),
        free=case.loose,
        radius=radius,
        outer_moves=case.moving_ring == "outer",
    )

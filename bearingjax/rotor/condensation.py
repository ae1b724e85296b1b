"""A linear rotor as seen from the motions of its supported stations.

Without speed a linear shaft between its supports is a stiffness between the supported
stations alone: the rest is condensed exactly.
"""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..numerics.lapack import solve_any
from ..numerics.types import Scalar
from .like_parts import map_parts
from .linear.reduction import held_motions
from .parts import AbstractSupport
from .rotor import N_HOUSING, N_STATION, Rotor

Supported = tuple[
    Float[Array, "support 5"],
    Float[Array, "support 5 5"],
    Float[Array, "support 5 5"],
]
"""Force, stiffness and damping of every support."""


class CondensedRotor(eqx.Module):
    """Linear rotor condensed to the motions of its supported stations.

    Attributes:
        stiffness, force: On them, per unit of `scale` (m, m), (m,) [N].
        rows: Motion of every support (support, 5, m) [1, 1/m].
        back, there: All motions (motion, m) and what the forces between supports add
            (motion,) [m, rad].
        supports: As in the rotor.
        speed: Speed of the rotor, or of each support (support,) [rad/s].
    """

    stiffness: Float[Array, "m m"]
    force: Float[Array, " m"]
    rows: Float[Array, "support 5 m"]
    back: Float[Array, "motion m"]
    there: Float[Array, " motion"]
    supports: tuple[AbstractSupport, ...]
    speed: Scalar | Float[Array, " support"]

    def motion(self, y: Float[Array, " m"]) -> Float[Array, " motion"]:
        """Return all motions [m, rad]."""
        return self.back @ y + self.there

    def of_supports(self, y: Float[Array, " m"]) -> Supported:
        """Force, stiffness and damping of every support."""
        moved = self.rows @ y
        if jnp.ndim(self.speed):
            return map_parts(
                lambda s, *at: s.respond(*at), self.supports, moved, self.speed
            )
        return map_parts(lambda s, at: s.respond(at, self.speed), self.supports, moved)

    def zeros(self) -> Supported:
        """Return zeros of the shapes of `of_supports`."""
        n, none = self.rows.shape[0], jnp.zeros_like(self.force[0])
        matrices = jnp.tile(none, (n, N_STATION, N_STATION))
        return matrices[:, 0], matrices, matrices

    def out_of_balance(
        self, y: Float[Array, " m"], force: Float[Array, "support 5"]
    ) -> Float[Array, " m"]:
        """Return the force of springs and supports less the applied one (m,) [N]."""
        along = jnp.einsum("sim,si->m", self.rows, force)
        return along + self.stiffness @ y - self.force

    def slope(self, stiffness: Float[Array, "support 5 5"]) -> Float[Array, "m m"]:
        """Return the total stiffness, from that of the supports (m, m) [N/m]."""
        rows = self.rows
        return jnp.einsum("sim,sij,sjn->mn", rows, stiffness, rows) + self.stiffness


def condense(
    rotor: Rotor, force: Float[Array, " motion"], speed: Scalar
) -> CondensedRotor:
    """Return a rotor condensed to its supported stations.

    Shifts of supported stations are in m, tilts in m at the end of half the shaft.

    Args:
        rotor: With supports.
        force: Constant force on all motions (motion,) [N, N m].
        speed: Speed of the rotor [rad/s].
    """
    own = rotor.unsupported_matrices().stiffness
    rows, every = rotor.at_supports(), rotor.motions()
    n, shaft = own.shape[0], rotor.shaft
    arm = 0.5 * (shaft.stations[-1] - shaft.stations[0])
    body = jnp.stack([arm / arm] * N_HOUSING + [1.0 / arm] * (N_STATION - N_HOUSING))
    n_housings = (n - N_STATION * shaft.n_nodes) // N_HOUSING
    ends = jnp.ones(N_HOUSING * n_housings, body.dtype)
    if rotor.rigid:
        # The tilts of a rigid shaft count about its own station of z = 0.
        back = every * jnp.concatenate([body, ends])[None, :]
        there = jnp.zeros_like(force)
    else:
        scale = jnp.concatenate([jnp.tile(body, shaft.n_nodes), ends])
        kept, rest = held_motions(rotor)
        back = jnp.eye(n, dtype=own.dtype)[:, kept] * scale[None, kept]
        there = jnp.zeros_like(force)
        if len(rest):
            inner = own[np.ix_(rest, rest)]
            across = own[np.ix_(rest, kept)] * scale[None, kept]
            known = jnp.concatenate([-across, force[rest, None]], axis=1)
            follow = solve_any(inner, known)
            back = back.at[rest].set(follow[:, :-1])
            there = there.at[rest].set(follow[:, -1])
    stiffness = back.T @ own @ back
    return CondensedRotor(
        stiffness=0.5 * (stiffness + stiffness.T),
        force=back.T @ force,
        rows=rows @ back,
        back=back,
        there=there,
        supports=rotor.supports,
        speed=speed,
    )

"""The bearing at an operating point, for linear rotordynamics."""

from collections.abc import Sequence

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..element import FREEDOMS, RINGS, BearingElement, Speed
from ..element.bearing_element import check_element
from ..numerics.lapack import pseudoinverse
from ..numerics.types import Ring, RingStiffness
from ..numerics.warning import Warning
from .load import raise_if_failed, solve
from .load_case import Vector
from .options import SolveOptions
from .solution import Solution
from .support import RESTRAINED, Support
from .warning import warnings

_SLACK = 1e-9
"""Share of the largest stiffness below which a direction counts as free [1]."""


class OperatingPoint(eqx.Module):
    """Equilibrium of a bearing under a load, and its stiffness there.

    Held at a nearby motion q, the rings take force + stiffness (q - motion), the
    azimuths of the rolling elements unchanged.

    Attributes:
        solution: Solution of the load solve; check its `result`.
    """

    solution: Solution

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about its solution, such as a direction without stiffness.

        Raises: as `warnings`.
        """
        return tuple(warnings(self.solution))

    @property
    def motion(self) -> Ring:
        """Ring freedoms (12,) [m, rad]."""
        return self.solution.displacement

    @property
    def force(self) -> Ring:
        """External load that holds the rings (12,) [N, N m]."""
        return self.solution.force

    @property
    def stiffness(self) -> RingStiffness:
        """Tangent stiffness d(force)/d(motion) (12, 12) [N/m, N, N m]."""
        return self.solution.stiffness

    @property
    def ring_stiffness(self) -> Float[Array, "6 6"]:
        """Stiffness of the moving ring, the other one fixed (6, 6) [N/m, N, N m]."""
        first = 6 * RINGS.index(self.solution.moving_ring)
        return self.solution.stiffness[first : first + 6, first : first + 6]

    def condense(
        self, keep: Sequence[str] = ("ux", "uy", "uz")
    ) -> Float[Array, "kept kept"]:
        """Stiffness of a few freedoms of the moving ring, the others condensed.

        Freedoms that were free in the solve are condensed: they move so that their
        load stays the same, K_kk - K_ko K_oo⁻¹ K_ok. Freedoms that were held or
        prescribed do not move. A direction without stiffness (such as a tilt that no
        contact resists) is left out.

        Args:
            keep: Freedoms to keep, in this order.

        Returns:
            (kept, kept) [N/m, N, N m].

        Raises:
            ValueError: For unknown or repeated names, or none.

        Source: static condensation, Guyan, AIAA J. 3 (1965).
        """
        if not keep or len(set(keep)) < len(keep) or not set(keep) <= set(FREEDOMS):
            raise ValueError(
                f"OperatingPoint: `keep` is {tuple(keep)}; it must name freedoms, each"
                f" once, out of {', '.join(FREEDOMS)}."
            )
        kept = np.array([FREEDOMS.index(name) for name in keep])
        others = [name for name in self.solution.free if name not in keep]
        k = self.ring_stiffness
        block = k[jnp.ix_(kept, kept)]
        if not others:
            return block
        other = np.array([FREEDOMS.index(name) for name in others])
        # All in N/m, so that one threshold serves forces and moments.
        radius = self.solution.pitch_radius
        scale = jnp.diag(jnp.where(other < 3, jnp.ones_like(radius), 1.0 / radius))
        own = scale @ k[jnp.ix_(other, other)] @ scale
        across = k[jnp.ix_(kept, other)] @ scale
        back = scale @ k[jnp.ix_(other, kept)]
        slack = max(_SLACK, 100.0 * float(jnp.finfo(own.dtype).eps))
        return block - across @ pseudoinverse(own, slack) @ back


def linearise(
    element: BearingElement,
    load: Vector | None = None,
    *,
    speed: Speed | None = None,
    support: Support = RESTRAINED,
    throw: bool = True,
) -> OperatingPoint:
    """Linearise a bearing about its equilibrium under a load.

    This is the static linearisation of `element.as_function`: the stiffness is its
    Jacobian there, gz held. The rolling elements are at the azimuths that belong to
    gz; for gz = 0 they are those of `first_azimuth`.

    Args: as `solve_load`.

    Returns:
        OperatingPoint, differentiable with respect to design, load and speeds; its
        `warnings` say if a free direction has no stiffness there, as without load.

    Raises: as `solve_load`.

    Fails: as `solve_load`; with `throw=False` read `solution.result`.
    """
    check_element("linearise", element)
    solution = solve(element, load, support, SolveOptions(points=2), speed=speed)
    if throw:
        solution = raise_if_failed(solution, "linearise")
    return OperatingPoint(solution)

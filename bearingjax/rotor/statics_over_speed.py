"""Static equilibrium of a rotor under weight, forces and preload, over its speed.

For supports that follow the speed: equilibria are found at some speeds, and springs of
polynomial stiffness represent the supports at all others.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from ..design.checks import check, is_traced, positive
from ..design.checks import count as whole
from ..numerics.compiled.programs import program
from ..numerics.result import Result, raise_unless_converged, worst_code
from ..numerics.shown import Printable
from ..numerics.types import Scalar, as_count, as_real
from ..numerics.units import rpm
from ..numerics.warning import Warning
from .rotor import Rotor
from .speed_support import SpeedSupport, chebyshev_analysis
from .statics import StaticEquilibrium, checked_loads, equilibrium_at

MOST_ERROR = 1e-3
"""Error of the stiffness over the speed above which a warning is given [1]."""


class StaticEquilibriumOver(Printable):
    """Static equilibria of a rotor at speeds from rest to a top speed.

    Attributes:
        rotor: The rotor on springs that follow the speed (`SpeedSupport`), for all
            linear analyses up to the top speed.
        speed: Speeds of the equilibria (place,) [rad/s]. displacement, support_load,
        stiffness: There, as in `StaticEquilibrium`, with `place` as
            first axis.
        error: Error of the polynomials, over the largest stiffness [1].
        result: Worst `Result` code; the numbers are NaN unless it is `CONVERGED`.
    """

    rotor: Rotor
    speed: Float[Array, " place"]
    displacement: Float[Array, "place node 5"]
    support_load: Float[Array, "place support 5"]
    stiffness: Float[Array, "place support 5 5"]
    error: Scalar
    result: Int[Array, ""]

    @property
    def failure_message(self) -> str:
        """Why they were not found, in words; empty if they were."""
        if int(self.result) == Result.CONVERGED:
            return ""
        return (
            f"static_equilibrium_over: {Result(int(self.result)).label} at one of the"
            " speeds; `static_equilibrium` there says more."
        )

    @property
    def top_speed(self) -> Scalar:
        """Highest speed for which the springs hold [rad/s]."""
        first: Any = self.rotor.supports[0]
        return first.top_speed

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about the springs of its rotor; empty where they are traced."""
        if is_traced(self.error) or not float(self.error) > MOST_ERROR:
            return ()
        error = float(self.error)
        words = (
            "the stiffness of the bearings over the speed is known to"
            f" {100.0 * error:.2g} % between rest and {rpm(self.top_speed)}, in"
            " critical speeds and Campbell diagram"
        )
        return (Warning("coarse_stiffness", words, error, MOST_ERROR),)

    def critical_speed_warnings(self, speeds: Any) -> list[Warning]:
        """Warnings about critical speeds beyond the top speed.

        Args:
            speeds: Critical speeds of its rotor [rad/s].
        """
        top, speeds = float(self.top_speed), np.asarray(speeds)
        beyond = speeds[speeds > top]
        if not beyond.size:
            return []
        words = (
            f"above {rpm(self.top_speed)} critical speeds are those of the stiffness"
            " that bearings have there"
        )
        return [Warning("beyond_known_stiffness", words, float(beyond.max()), top)]


def static_equilibrium_over(
    rotor: Any,
    loads: Any,
    top_speed: Any,
    *,
    places: Any = 13,
    throw: bool = True,
) -> StaticEquilibriumOver:
    """Find equilibria from rest to a top speed, for supports that follow the speed.

    The rotor is settled at Chebyshev's points between, and the stiffness of every
    support there made a polynomial of the speed: linear analyses then cost no more than
    on springs. `error` is the size of the last two coefficients; where it is not small
    more places help, unless rolling elements lose contact with the speed, which makes
    a kink. If no support follows the speed, `static_equilibrium` gives the same.

    Args:
        rotor, loads: As in `static_equilibrium`.
        top_speed: Highest speed, above 0 [rad/s].
        places: Number of points, 3 or more. Static.
        throw: Raise if one is not settled. Static.

    Returns:
        StaticEquilibriumOver, with first derivatives with respect to all numbers.

    Fails, raises: as `static_equilibrium`.
    """
    loads = checked_loads("static_equilibrium_over", rotor, loads)
    top_speed, places = as_real(top_speed), as_count(places)
    positive("static_equilibrium_over", "top_speed", top_speed, "rad/s")
    whole("static_equilibrium_over", "places", places)
    check("static_equilibrium_over", "places", places >= 3, "at least 3", places, "")
    share = 0.5 * (1.0 - np.cos(np.pi * (np.arange(places) + 0.5) / places))
    speeds = top_speed * jnp.asarray(share, top_speed.dtype)
    every = _at_each(rotor, loads, speeds)
    found = _settled_over(rotor, top_speed, speeds, every)

    if not throw:
        return found
    owner = "static_equilibrium_over"
    return raise_unless_converged(
        found, found.result, lambda: found.failure_message, owner
    )


def _at_each(rotor, loads, speeds) -> StaticEquilibrium:
    """Return equilibria at all speeds, without `rotor`; first axis `place`."""

    def equilibrium_of(speed):
        found = equilibrium_at(rotor, loads, speed)[0]
        return eqx.tree_at(lambda f: f.rotor, found, None)

    if any(is_traced(leaf) for leaf in jax.tree.leaves((rotor, loads, speeds))):
        return lax.map(equilibrium_of, speeds)
    # One after the other by the program of `static_equilibrium`, which is often there
    # already.
    return jax.tree.map(lambda *leaf: jnp.stack(leaf), *map(equilibrium_of, speeds))


@program(quick=True)
def _settled_over(rotor, top_speed, speeds, found) -> StaticEquilibriumOver:
    series = jnp.asarray(chebyshev_analysis(speeds.shape[0]), top_speed.dtype)
    stiffness = jnp.tensordot(series, found.stiffness, 1)
    springs = [
        SpeedSupport(s.station, stiffness[:, k], d, top_speed, housing=s.housing)
        for k, (s, d) in enumerate(zip(rotor.supports, found.damping[0], strict=True))
    ]
    return StaticEquilibriumOver(
        rotor=eqx.tree_at(lambda r: r.supports, rotor, tuple(springs)),
        speed=speeds,
        displacement=found.displacement,
        support_load=found.support_load,
        stiffness=found.stiffness,
        error=jnp.max(jnp.abs(stiffness[-2:])) / jnp.max(jnp.abs(stiffness)),
        result=worst_code(found.result),
    )

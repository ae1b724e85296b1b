"""Static equilibrium of a bearing on its rig."""

import dataclasses

import jax.numpy as jnp
from jaxtyping import Array, Int

from ..element.balls.ball_speed import CentrifugalOnly
from ..numerics.implicit import stop_gradient
from ..numerics.linear import combine_rows
from ..numerics.result import Result
from ..numerics.types import Scalar, Vector
from .dynamics.element_positions import ElementPositions
from .dynamics.system import NoiseSystem
from .model import NoiseModel

_CARRIES = 1e-7
"""Load of a rolling element over the largest contact load below which it is unloaded
[1]: round-off of a search without load."""


def static_start(
    model: NoiseModel, system: NoiseSystem, orbits: bool = True
) -> tuple[Vector, Int[Array, ""]]:
    """Return the equilibrium of ring and elements under load, without form errors.

    The inertia of the orbit acts as it does in the equations of motion.

    Args:
        model: The bearing.
        system: Its equations of motion.
        orbits: Whether the rolling elements orbit; if not, unloaded ones are in no
            contact. Static.

    Returns:
        Coordinates (n,) [m, rad] and the `Result` code; differentiable.

    Fails: as `solve_load`; `NO_LOAD_PATH` too where no rolling element is pressed
    between both rings: the moving one then lies anywhere.
    """
    element = model.small_motions
    if orbits and element.raceway_control is not None:
        # As here, where balls roll at the free contact angle whatever the load.
        choices = dataclasses.replace(
            element.choices, raceway_control=CentrifugalOnly()
        )
        element = dataclasses.replace(element, choices=choices)
    speed = model.speed if orbits else None
    solution = model.solve(element, speed)
    q = solution.displacement
    rows = element.rows(q, speed)
    u, v, tilt = jnp.concatenate([found.motions() for found in rows]).T
    if (placements := system.placements) is not None:
        u, v, tilt = (
            placements.sign * u,
            v + placements.position * tilt,
            placements.sign * tilt,
        )

    def places_of(element, *motion):
        return combine_rows(element.own.T, jnp.stack(motion))[: element.mass.shape[0]]

    places = system.row.map(places_of, u, v, tilt)
    ring = (q[6:] if system.moving else q[:6])[: system.mass.shape[0]]
    motion = jnp.concatenate([ring, places.T.ravel()])
    between, most = _carried_loads(system, motion)
    loose = (solution.result == Result.CONVERGED) & ~(between > _CARRIES * most)
    result = jnp.where(loose, int(Result.NO_LOAD_PATH), solution.result)
    return motion, result.astype(jnp.int32)


def _carried_loads(system, motion) -> tuple[Scalar, Scalar]:
    """Return the largest load through an element, and the largest of all [N]."""
    motion = stop_gradient(motion)
    found = ElementPositions.from_azimuth(system.azimuth(jnp.zeros((), motion.dtype)))
    outer, inner = (
        jnp.linalg.norm(force.components[:, :2], axis=1)
        for force in system.on_raceways(motion, found)
    )
    return jnp.max(jnp.minimum(outer, inner)), jnp.max(jnp.maximum(outer, inner))


def describe_failure(model: NoiseModel) -> str:
    """Describe why a bearing has no equilibrium under its load.

    Args:
        model: The bearing; concrete.
    """
    solution = model.solve(model.small_motions)
    if int(solution.result) == Result.CONVERGED:
        return (
            "nothing presses the rolling elements between the rings, and the"
            f" {model.moving_ring} ring lies anywhere; add load or preload"
        )
    return solution.failure_message

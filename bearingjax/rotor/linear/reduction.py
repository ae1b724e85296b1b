"""Craig-Bampton reduction of a flexible rotor at its supports."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ...design.checks import count
from ...numerics.compiled.programs import program
from ...numerics.lapack import cholesky, congruent, eigh, solve_any
from ...numerics.types import as_count
from ..rotor import N_HOUSING, N_STATION, Rotor

Basis = Float[Array, "motion fewer"]


def craig_bampton(rotor: Rotor, modes: Any) -> Basis:
    """Return the reduced basis, for `rotor.linearise(...).project(basis)`.

    The motions of supported stations and of housings stay freedoms as they are; each
    takes the rest of the shaft along as without inertia. To these come the slowest
    modes of the shaft with discs between its supports, all of them clamped. Without
    inertia it is exact for loads at supported stations; a mode left out of frequency
    ω_c is missed by about (ω/ω_c)² of its share at a vibration of ω.

    Args:
        rotor: With supports, and a shaft that bends.
        modes: Number of clamped modes; a symmetric rotor has them in pairs.

    Returns:
        Columns: freedoms of supported stations (rising) and housings, then one for
        each mode, scaled to a largest motion of 1 m, tilts counted as those of half
        of the shaft's length. Modes have no derivatives: with them held the reduced
        rotor's derivatives are as near to those of the rotor as its motions are.

    Raises:
        TypeError: If `modes` is no whole number.
        ValueError: If the shaft is rigid, nothing supports it, or `modes` is negative.

    Source: Craig & Bampton, AIAA J. 6 (1968) 1313-1319.
    """
    modes = as_count(modes)
    count("craig_bampton", "modes", modes, least=0)
    if rotor.rigid or not rotor.supports:
        why = "is rigid" if rotor.rigid else "has no supports"
        raise ValueError(f"craig_bampton: `rotor` {why}; there is nothing to reduce.")
    return _basis(rotor, modes)


@program(quick=True)
def _basis(rotor, modes):
    own = rotor.unsupported_matrices()
    kept, rest = held_motions(rotor)
    inner = np.ix_(rest, rest)
    shapes = jnp.eye(own.mass.shape[0], dtype=own.mass.dtype)[:, kept]
    if len(rest):
        follow = -solve_any(own.stiffness[inner], own.stiffness[np.ix_(rest, kept)])
        shapes = shapes.at[rest].set(follow)
    count = min(modes, len(rest))
    if not count:
        return shapes
    mass, stiffness = (lax.stop_gradient(m[inner]) for m in (own.mass, own.stiffness))
    factor = cholesky(mass)
    _, vectors = eigh(congruent(factor, stiffness))
    clamped = solve_any(factor.T, vectors[:, :count], "upper")
    body = jnp.stack(_sizes(lax.stop_gradient(rotor.shaft.stations)))
    places = rest[rest < N_STATION * rotor.shaft.n_nodes] % N_STATION
    largest = jnp.max(jnp.abs(clamped) / body[places][:, None], axis=0)
    more = jnp.zeros((shapes.shape[0], count), shapes.dtype)
    return jnp.concatenate(
        [shapes, more.at[rest].set(clamped / largest[None, :])], axis=1
    )


def _sizes(stations):
    """Return the scale of every freedom of a station, per 1 m of displacement."""
    one = jnp.ones_like(stations[0])
    tilt = 2.0 / (stations[-1] - stations[0])
    return [one] * N_HOUSING + [tilt] * (N_STATION - N_HOUSING)


def held_motions(rotor: Rotor) -> tuple[np.ndarray, np.ndarray]:
    """Return indices of motions of supported stations and housings, and of others."""
    n = rotor.at_supports().shape[-1]
    places = [
        np.arange(n)[rotor.slice_at(support.station)] for support in rotor.supports
    ]
    housings = np.arange(N_STATION * rotor.shaft.n_nodes, n)
    kept = np.unique(np.concatenate([*places, housings]))
    return kept, np.setdiff1d(np.arange(n), kept)

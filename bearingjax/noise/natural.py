"""Natural modes of a bearing on its rig, rolling elements with their own masses.

At the equilibrium of the bearing under its load, K v = ω² M v with the second
derivatives K of the energy of all contacts. An unloaded rolling element has no
stiffness: its modes have frequencies of almost zero. Where the elements orbit,
their inertia presses them on the outer raceway, and the outer ring carries their mass.

Source: Kurushin, Kurushin, Zhilnikov, Murashkin (Vestnik SGAU, 2011), there with balls
    that move radially.
"""

import dataclasses
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design import rows_of
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient
from ..numerics.labels import to_xarray
from ..numerics.lapack import eigh
from ..numerics.types import Square, Vector
from ..numerics.units import unit, units
from .dynamics.system import NoiseSystem
from .model import NoiseModel
from .static_start import static_start

LOOSE = 1.0
"""Frequency below which a mode is that of an unloaded element [Hz]."""
_RING = 0.5
"""Least share of the ring in the motion of a ring mode [1]."""


class NaturalModes(NamedTuple):
    """Natural modes, in order of frequency.

    Attributes:
        frequency: (mode,) [Hz].
        ring: Motion of the moving ring's freedoms, of unit modal mass
            (mode, k) [m, rad].
        places: Motion of every rolling element, along z and outwards for balls
            (mode, element, m) [m, rad].
        ring_share: Share of the moving ring in the energy of motion (mode,) [1].
        result: `Result` code of the place at which the modes are.
    """

    frequency: Annotated[Float[Array, " mode"], unit("Hz")]
    ring: Annotated[Float[Array, "mode k"], units("m", "rad")]
    places: Annotated[Float[Array, "mode element m"], units("m", "rad")]
    ring_share: Annotated[Float[Array, " mode"], unit("1")]
    result: Int[Array, ""]

    to_xarray = to_xarray


def contact_stiffness(system: NoiseSystem, motion: Vector) -> Square:
    """Return the second derivatives of the energy of all contacts [N/m, N, N m].

    Args:
        system: The equations of motion; without form errors.
        motion: Coordinates (n,) [m, rad].
    """
    zero = jnp.zeros((), motion.dtype)
    k = jax.jacfwd(system.contact_forces)(motion, zero)
    return 0.5 * (k + k.T)


def stiffness(system: NoiseSystem, motion: Vector) -> Square:
    """Return `contact_stiffness` plus the stiffness of the sensor."""
    k = contact_stiffness(system, motion)
    if system.sensor is None:
        return k
    s = system.sensor
    return k.at[:3, :3].add(s.stiffness * s.projector)


def after_orbit(model: NoiseModel, angle: Any) -> NoiseModel:
    """Return a copy with its rolling elements orbited on from time zero.

    Args:
        model: The bearing.
        angle: Orbit angle; of a set one for each row [rad].
    """

    def places(model):
        return [r.bearing.first_azimuth for r in rows_of(model.element.bearing)]

    return eqx.tree_at(places, model, [at + angle for at in places(model)])


def natural_modes(model: NoiseModel) -> NaturalModes:
    """Return the natural modes of a bearing under its load.

    Rolling elements are at their positions of time zero; for others, as modes change
    along the orbit where elements differ or few of them carry load, see `after_orbit`.

    Args:
        model: The bearing; its form errors are ignored.

    Returns:
        Modes. First derivatives of frequencies are exact, also where some coincide (of
        their mixture); derivatives of shapes are not available.

    Fails: as `solve_load`; the frequencies are then those of no balance.
    """
    # Only form errors depend on the contact width: one program with it and without.
    return _natural_modes(dataclasses.replace(model, half_width=None), model.orbits)


@program(quick=True)
def _natural_modes(model, orbits) -> NaturalModes:
    system = model.still_system()
    motion, result = static_start(model, system, orbits)
    root = jnp.sqrt(system.masses)
    k = stiffness(system, motion) / jnp.outer(root, root)
    _, vectors = eigh(stop_gradient(k))
    # Eigenvectors held: the derivative is that of the eigenvalue.
    square = jnp.einsum("im,ij,jm->m", vectors, k, vectors)
    positive = square > 0.0
    angular = jnp.where(positive, jnp.sqrt(jnp.where(positive, square, 1.0)), 0.0)
    share = jnp.sum(vectors[: system.mass.shape[0]] ** 2, axis=0)
    ring, places = jax.vmap(system.split)(vectors.T / stop_gradient(root)[None])
    return NaturalModes(angular / (2.0 * jnp.pi), ring, places, share, result)


def ring_modes(modes: NaturalModes, model: NoiseModel) -> list[tuple[str, float]]:
    """Return name and frequency [Hz] of the modes with mostly ring motion.

    Args:
        modes: As NumPy holds them.
        model: The bearing.
    """
    masses = np.repeat(float(model.mass), 3)
    names = [f"along {name}" for name in "xyz"]
    if (inertia := model.inertia) is not None:
        tilting = np.repeat(float(inertia), 2)
        masses = np.concatenate([masses, tilting])
        names += ["tilting about x", "tilting about y"]
    found: list[tuple[str, float]] = []
    for frequency, ring, share in zip(
        modes.frequency, modes.ring, modes.ring_share, strict=True
    ):
        if share < _RING or frequency < LOOSE:
            continue
        name = f"natural mode {names[int(np.argmax(masses * ring**2))]}"
        same = sum(one.startswith(name) for one, _ in found)
        found.append((f"{name} ({same + 1})" if same else name, float(frequency)))
    return found

"""Quasi-static excitation by form errors, without inertia.

Every instant is a static problem, solved exactly, with the positions of the rolling
elements and the raceway deviations of that instant. Two results bound the vibration of
a real ring: the force on a ring that is held, and the displacement of one that is free
under its load.
"""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..design.bearing_set import bearings_of, with_bearings
from ..design.checks import check, count, of_class
from ..design.deviation import with_raceways
from ..element.bearing_element import BearingElement
from ..element.rolling_element import split_rings
from ..numerics.compiled.programs import program
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar
from .dynamics.dynamic_row import of_rows
from .dynamics.system import NoiseSystem
from .model import NoiseModel

_LANES = 64
"""Number of instants solved in parallel."""


class Excitation(eqx.Module):
    """Quasi-static excitation of the moving ring over time; leading axis sample.

    Samples are even, over whole turns of the shaft, without the end point.

    Attributes:
        time: (sample,) [s].
        force: Force of the contacts on the moving ring, less the reaction to its load
            (sample, 6) [N, N m]. Of a free ring it is zero in its freedoms.
        displacement: Displacement of the moving ring from its position without form
            errors (sample, 6) [m, rad]. Of a held ring it is zero.
        azimuth: Azimuth of every rolling element (sample, element) [rad].
        shaft_frequency: Frequency of the ring that turns faster [Hz].
        result: `Result` code of each instant (sample,).
    """

    time: Float[Array, " sample"]
    force: Float[Array, "sample 6"]
    displacement: Float[Array, "sample 6"]
    azimuth: Float[Array, "sample element"]
    shaft_frequency: Scalar
    result: Int[Array, " sample"]

    @property
    def failure_message(self) -> str:
        """How many instants were not solved, in words; empty if all were."""
        bad = int(jnp.sum(self.result != Result.CONVERGED))
        if not bad:
            return ""
        return f"excitation: {bad} of {self.result.size} instants were not solved."


def excitation(
    model: NoiseModel,
    *,
    turns: int = 1,
    samples: int = 256,
    held: bool = True,
    throw: bool = True,
) -> Excitation:
    """Return force on a held ring, or displacement of a free one, over some turns.

    A bearing without form errors excites its ring too where few rolling elements carry
    the load and orbit (variable compliance); both are included. Masses, the cage, the
    retardation and the sensor, soft against the bearing, are neglected.

    Args:
        model: The bearing.
        turns: Turns of the shaft. Static.
        samples: Per turn. Static.
        held: Whether the ring is held at its equilibrium without form errors at time
            zero, or may move under its load. Static.
        throw: Raise if the bearing finds no place under its load or an instant cannot
            be solved; otherwise read `result`. Static.

    Returns:
        `Excitation`, differentiable with respect to every number of the model.

    Raises:
        TypeError: For another model, or counts that are none.
        ValueError: For counts below 1, or a shaft that stands still.
        SolveError: If it failed and `throw` is set.

    Fails: as `solve_load`.
    """
    of_class("excitation", "model", model, NoiseModel, "a NoiseModel")
    for name, value in (("turns", turns), ("samples", samples)):
        count("excitation", name, value)
    shaft = model.shaft_speed
    check("excitation", "speed", shaft > 0, "another than 0", shaft, "rad/s")
    found = _excitation(model, turns, samples, held)
    if not throw:
        return found

    return raise_unless_converged(
        found, found.result, lambda: found.failure_message, "excitation"
    )


def at_instant(
    element: BearingElement, system: NoiseSystem, time: Scalar
) -> BearingElement:
    """Return the bearing at a time, with element positions and raceway deviations.

    Args:
        element: Element of the model.
        system: Its equations of motion.
        time: [s].
    """
    bearing: Any = element.bearing
    turned = system.speeds[2] * time
    deviations = system.deviations(system.azimuth(time), time)

    def rows(tree):
        return list(bearings_of(tree))

    now = []
    for k, row in enumerate(rows(bearing)):
        # All elements of a row orbit alike.
        orbit = turned if turned.ndim == 0 else of_rows(turned, bearing)[k][0]
        row = eqx.tree_at(lambda b: b.first_azimuth, row, row.first_azimuth + orbit)
        now.append(
            row
            if deviations is None
            else with_raceways(row, of_rows(deviations, bearing)[k])
        )
    bearing = with_bearings(bearing, now)
    return eqx.tree_at(lambda e: e.bearing, element, bearing)


@program(quick=True)
def _excitation(model, turns, samples, held) -> Excitation:
    system = dataclasses.replace(model, cage=None).system()
    whole = model.small_motions
    standing = model.solve(whole)
    start = split_rings(standing.displacement)[system.moving]
    frequency = model.shaft_speed / (2.0 * jnp.pi)
    time = jnp.arange(turns * samples, dtype=frequency.dtype) / (frequency * samples)

    def force_at(time):
        element = at_instant(whole, system, time)
        if held:
            found = element.evaluate(standing.displacement)
            force, moved = found.force, jnp.zeros_like(start)
        else:
            found = model.solve(element, start=start)
            force = found.force
            moved = split_rings(found.displacement)[system.moving] - start
        # The contacts push the ring with what would have to hold it, reversed.
        pushed = model.load - split_rings(force)[system.moving]
        result = jnp.maximum(found.result, standing.result)
        return pushed, moved, system.azimuth(time), result

    lanes = min(turns * samples, _LANES)
    force, moved, azimuth, result = jax.lax.map(force_at, time, batch_size=lanes)
    return Excitation(time, force, moved, azimuth, frequency, result.astype(jnp.int32))

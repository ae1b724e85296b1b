"""Optimised designs as scenes, with their fits and warnings."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import numpy as np

from ...design import rows_of
from ...fits import Limits, radial_clearance
from ...numerics.types import as_array
from ...statics.installed import Installed
from ..bearing.fits import Fits, fit_warnings
from .read_optimise import Optimisation
from .read_shaft_optimise import ShaftOptimisation


def scene_of_design(task: Optimisation | ShaftOptimisation, design: Any) -> Any:
    """Return the scene with its design replaced.

    Args:
        task: The optimisation task.
        design: Best or first design: `Optimised.element`, `initial`.

    Returns:
        Scene with the bearing, preload, seats and temperatures of the design, at the
        highest speed of the cases, and the warnings of these seats; of a system of
        shafts, with its system.
    """
    if isinstance(task, ShaftOptimisation):
        return dataclasses.replace(task.scene, system=design.system)
    force = None if design.preload is None else float(design.preload)
    scene = dataclasses.replace(task.scene, element=design.drawing, preload_force=force)
    if scene.fits is None:
        return scene
    fits = _fits(scene.fits, design, {v.name for v in task.variables})
    fits = _turning(fits, task)
    fixed_to = "space" if scene.life is None else scene.life.load_fixed_to
    old = fit_warnings(scene.fits, fixed_to)
    kept = [text for text in scene.warnings if text not in old]
    warned = (*kept, *fit_warnings(fits, fixed_to))
    return dataclasses.replace(scene, fits=fits, warnings=warned)


def _fits(fits: Fits, design: Installed, varied: set[str]) -> Fits:
    """Return the fits of a design; optimised numbers have no tolerance."""
    exact = Limits(0.0, 0.0)
    limits, names = dict(fits.limits), list(fits.names)
    mounting: Any = jax.device_get(design.mounting)
    for k, (seat, ring) in enumerate(
        (("shaft", "bore"), ("housing", "outside_diameter"))
    ):
        if f"fit.{seat}_interference" in varied:
            own = float(getattr(mounting, f"{seat}_interference"))
            # Sign as a deviation: a small housing is tight.
            own = own if seat == "shaft" else -own
            limits |= {seat: Limits(own, own), ring: exact}
            names[k] = ""
    if any(name.startswith("bearing.") for name in varied):
        row = rows_of(design.drawing.bearing)[0].bearing
        free = float(radial_clearance(row))
        limits["clearance"] = Limits(free, free)
    return dataclasses.replace(
        fits,
        mounting=design.mounting,
        conditions=design.conditions,
        limits=limits,
        names=(names[0], names[1]),
        bearing=design.drawing.bearing,
    )


def _turning(fits: Fits, task: Optimisation) -> Fits:
    """Return the fits at the highest inner ring speed of the cases."""
    speeds = task.cases.inner_speed
    if speeds is None:
        return fits
    fastest = np.asarray(speeds)[np.argmax(np.abs(speeds))]
    conditions = eqx.tree_at(
        lambda c: c.speed, fits.conditions, as_array(fastest, float)
    )
    return dataclasses.replace(fits, conditions=conditions)

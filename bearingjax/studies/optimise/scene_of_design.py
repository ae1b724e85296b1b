"""Optimised designs as scenes, with their fits and warnings."""

import dataclasses
from typing import Any

import jax
import numpy as np

from ...design import rows_of
from ...element import Speed
from ...fits import Limits, radial_clearance
from ...statics.installed import Installed
from .read_optimise import Optimisation
from .read_shaft_optimise import ShaftOptimisation


def scene_of_design(task: Optimisation | ShaftOptimisation, design: Any) -> Any:
    """Return the scene with its design replaced.

    Args:
        task: The optimisation task.
        design: Best or first design: `OptimisedDesign.element`, `initial`.

    Returns:
        Scene with the bearing, preload, seats and temperatures of the design, at the
        highest speed of the cases, and the warnings of these seats; of a system of
        shafts, with its system.
    """
    if isinstance(task, ShaftOptimisation):
        return dataclasses.replace(task.scene, system=design.system)
    scene = dataclasses.replace(task.scene, installed=_as_run(task, design))
    if scene.fits is None:
        return scene
    varied = {v.name for v in task.variables}
    classes = [
        "" if f"fit.{seat}_interference" in varied else name
        for seat, name in zip(("shaft", "housing"), scene.fits.classes, strict=True)
    ]
    notes = scene.fits._replace(classes=tuple(classes))
    fixed_to = "space" if scene.life is None else scene.life.load_fixed_to
    old = task.scene.installed.seat_warnings(fixed_to)
    kept = [text for text in scene.warnings if text not in old]
    warned = (*kept, *scene.installed.seat_warnings(fixed_to))
    return dataclasses.replace(scene, fits=notes, warnings=warned)


def _as_run(task: Optimisation, design: Installed) -> Installed:
    """Return a design with its seats at the highest inner ring speed of the cases;
    optimised numbers have no tolerance."""
    limits, warm = design.limits, design.conditions
    if limits is None or warm is None:
        return design
    varied = {v.name for v in task.variables}
    exact, fits = Limits(0.0, 0.0), jax.device_get(design.mounting)
    if "fit.shaft_interference" in varied:
        own = fits.shaft_interference
        limits = limits._replace(shaft=Limits(own, own), bore=exact)
    if "fit.housing_interference" in varied:
        # As a deviation: a small housing is tight.
        own = -fits.housing_interference
        limits = limits._replace(housing=Limits(own, own), outside_diameter=exact)
    if any(name.startswith("bearing.") for name in varied):
        free = radial_clearance(rows_of(design.drawing.bearing)[0].bearing)
        limits = limits._replace(clearance=Limits(free, free))
    design = dataclasses.replace(design, limits=limits)
    if (speeds := task.cases.inner_speed) is None:
        return design
    fastest = np.asarray(speeds)[np.argmax(np.abs(speeds))]
    return design.with_speed(Speed(fastest, warm.outer_speed))

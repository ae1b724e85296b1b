"""Settings of a solve in words: freedoms, speeds, materials, laws."""

from typing import Any

import numpy as np

from ...design import AbstractBearing, BearingSet, Material, rows_of
from ...element.frame import FREEDOMS, RINGS
from ...numerics.shown import facts_of
from ...statics.options import DEFAULT_TOLERANCE
from ...statics.solution import Solution
from ...statics.warning_sizes import speed_factor
from ..bearing.read_scene import Scene


def freedoms(scene: Scene, solution: Solution) -> str:
    """Describe which freedoms of the moving ring were free and which were held.

    Args:
        scene: Solved scene.
        solution: Its solution, in NumPy.
    """
    why = (
        "the default: all that the bearing restrains"
        if scene.free is None
        else "as the scene says"
    )
    given = [name for name in FREEDOMS if name in scene.prescribed]
    zero = [name for name in solution.held if name not in given and name != "gz"]
    parts = [f"free: {' '.join(solution.free) or 'none'} ({why})"]
    if given:
        parts.append(f"prescribed: {' '.join(given)}")
    if zero:
        parts.append(f"held at zero: {' '.join(zero)}")
    return "; ".join(parts)


def operation(scene: Scene, solution: Solution) -> str:
    """Describe freedoms, speeds, materials, laws and numerics.

    Args:
        scene: Solved scene.
        solution: Its solution, in NumPy.
    """
    element = solution.element
    lines = [freedoms(scene, solution), _speeds(solution)]
    lines += _materials(element.bearing)
    choices = vars(element.choices)
    if solution.speed is None:
        choices = {k: v for k, v in choices.items() if k != "raceway_control"}
    made = [
        f"{name.replace('_', ' ')}: {words(choice)}"
        for name, choice in choices.items()
        if choice is not None
    ]
    tolerance = scene.tolerance or DEFAULT_TOLERANCE["float64"]
    solver = type(element.equilibrium).__name__
    made.append(f"equilibrium: {solver}, tolerance {tolerance:.3g}")
    return "\n".join([*lines, *made])


def _speeds(solution):
    speed = solution.speed
    if speed is None:
        return "both rings at rest"
    shown = [
        f"{ring} ring {float(getattr(speed, ring)) * 30.0 / np.pi:.6g} rpm"
        for ring in RINGS
    ]
    return f"{', '.join(shown)}; n·dm {float(speed_factor(solution)):.4g} mm/min"


def _materials(bearing: AbstractBearing | BearingSet) -> list[str]:
    """Return a line for each distinct material of rolling elements and rings."""
    part = f"{bearing.noun}s"
    lines = []
    for row in rows_of(bearing):
        own, rings = row.bearing.material, row.bearing.rings
        alike = _material(own) == _material(rings)
        if alike:
            lines.append(f"{part} and rings: {_material(own)}")
        else:
            lines += [f"{part}: {_material(own)}", f"rings: {_material(rings)}"]
    return list(dict.fromkeys(lines))


def _material(material: Material) -> str:
    modulus, ratio, density = (
        float(x)
        for x in (material.elastic_modulus, material.poisson_ratio, material.density)
    )
    return (
        f"E = {1e-9 * modulus:.5g} GPa, Poisson's ratio {ratio:.4g},"
        f" {density:.5g} kg/m³"
    )


def words(choice: Any) -> str:
    """Format a law, a kinematics or a method by its class name and fields.

    Args:
        choice: Module.
    """
    shown = ", ".join(f"{name} {value}" for _, name, value, _ in facts_of(choice))
    name = type(choice).__name__
    return f"{name} ({shown})" if shown else name

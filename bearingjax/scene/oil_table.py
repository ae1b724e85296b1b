"""The [lubricant] table of a scene that is solved: its oil, films and friction."""

import dataclasses
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..lubrication import Lubricant
from ..numerics.types import as_array
from ..statics.contact_films import Films, films
from ..statics.friction import SUPPLIES, Friction, friction_torque
from ..statics.solution import Solution
from .lubricant_table import described, read_lubricant, read_traction
from .table import Table

OWN = ("supply", "roughness")
"""Keys that only a solve has a use for."""


@dataclasses.dataclass(frozen=True)
class Oil:
    """What a scene says of its oil.

    Attributes:
        name: Of the oil, or of its law.
        lubricant: The oil.
        temperature: Its temperature [K].
        supply: One of `SUPPLIES`.
        roughness: Root mean square of both surfaces together [m], or `None`.
    """

    name: str
    lubricant: Lubricant
    temperature: float
    supply: str
    roughness: float | None


class OilFacts(NamedTuple):
    """Friction and films of a solved scene, in NumPy's numbers."""

    friction: Friction
    films: Films


def read_oil(table: Table) -> tuple[Oil, tuple[str, ...]]:
    """The oil of a solve, and what was assumed of it.

    Args:
        table: `[lubricant]`.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    lubricant, temperature, odd = read_lubricant(table)
    read_traction(table)  # of a bearing that skids
    supply = table.choice("supply", SUPPLIES, "oil_bath")
    roughness = table.quantity("roughness", "length", None)
    if roughness is not None and not 0.0 < roughness < 1e-4:
        problem = f"{roughness:g} m is not allowed; above 0 and below 0.1 mm"
        raise table.error("roughness", problem)
    name = str(table.raw("name", None) or table.raw("law", None))
    return Oil(name, lubricant, temperature, supply, roughness), odd


def oil_facts(oil: Oil, solution: Solution) -> OilFacts | None:
    """Friction and films of a solution; `None` at rest.

    Args:
        oil: From `read_oil`.
        solution: Converged.
    """
    if solution.speed is None or float(_turning(solution)) == 0.0:
        return None
    numbers = jax.tree.map(jnp.asarray, solution)
    rough = None if oil.roughness is None else as_array(oil.roughness, float)
    temperature = as_array(oil.temperature, float)
    found = _facts(numbers, oil.lubricant, temperature, oil.supply, rough)
    return jax.device_get(found)


def _turning(solution):
    return np.asarray(solution.speed.inner) - np.asarray(solution.speed.outer)


@eqx.filter_jit
def _facts(solution, lubricant, temperature, supply, roughness):
    viscosity = lubricant.kinematic_viscosity(temperature)
    return OilFacts(
        friction_torque(solution, viscosity, supply),
        films(solution, lubricant, temperature, roughness),
    )


def oil_report(oil: Oil, solution: Solution) -> str:
    """Readable report of friction and films; "" at rest.

    Args:
        oil, solution: As of `oil_facts`.
    """
    facts = oil_facts(oil, solution)
    if facts is None:
        return ""
    friction = facts.friction
    parts = {
        "load": friction.load_torque,
        "oil": friction.viscous_torque,
        "ribs": friction.flange_torque,
    }
    told = ", ".join(f"{k} {1e3 * v.sum():.4g}" for k, v in parts.items() if v.any())
    lines = [
        f"{oil.name}, {oil.supply.replace('_', ' ')}, at"
        f" {described(oil.lubricant, oil.temperature)}",
        f"friction torque (Palmgren) {1e3 * float(friction.torque):.4g} N mm ({told});"
        f" {float(friction.power):.4g} W",
    ]
    thin = facts.films.minimum
    if np.isfinite(thin).any():
        element, contact = np.unravel_index(np.argmin(thin), thin.shape)
        ring = ("outer", "inner")[int(contact >= thin.shape[1] // 2)]
        line = (
            f"least film {1e6 * thin[element, contact]:.3g} µm, of element {element} on"
            f" the {ring} raceway"
        )
        if facts.films.ratio is not None:
            line += f"; over the roughness {np.min(facts.films.ratio):.3g}"
        lines.append(line)
    return "\n".join(lines)


def oil_as_dict(oil: Oil, solution: Solution) -> dict[str, Any]:
    """Friction and films of a solved scene as plain numbers, in SI; empty at rest.

    Args:
        oil, solution: As of `oil_facts`.

    Returns:
        friction_torque [N m]; friction: load, viscous, flange (row) [N m], power [W];
        film: central, minimum [m], entrainment [m/s] and with a roughness ratio, each
        (element, contact), null where no load is carried. Contacts as of
        `contact_load` of balls, as of `roller_load` of rollers.
    """
    facts = oil_facts(oil, solution)
    if facts is None:
        return {}
    friction, found = facts
    names = ["entrainment", "central", "minimum"]
    names += ["ratio"] if found.ratio is not None else []
    return {
        "friction_torque": float(friction.torque),
        "friction": {
            "load": friction.load_torque.tolist(),
            "viscous": friction.viscous_torque.tolist(),
            "flange": friction.flange_torque.tolist(),
            "power": float(friction.power),
        },
        "film": {name: _listed(getattr(found, name)) for name in names},
    }


def _listed(values):
    return [[float(x) if np.isfinite(x) else None for x in row] for row in values]

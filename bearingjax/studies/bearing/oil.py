"""The [lubricant] table of a solved scene: oil, films and friction."""

import contextlib
import dataclasses
from typing import Any, NamedTuple

import jax
import numpy as np

from ...files.schema import read_keys
from ...files.table import Table
from ...friction.contact_films import Films, films
from ...friction.friction import Friction, friction_torque
from ...friction.friction_skf import (
    SkfFriction,
    skf_friction_torque,
    skf_series,
    skf_series_of,
)
from ...lubrication import Lubricant
from ...numerics.compiled.programs import program
from ...numerics.labels import array_fields
from ...numerics.types import as_array
from ...report.json_output import to_json
from ...statics.empty_places import solution_with_empty_places, take_elements
from ...statics.solution import Solution
from .catalogue_keys import FromCatalogue
from .read_lubricant import LubricantKeys, describe_oil
from .read_operating import relative_speed


@dataclasses.dataclass(frozen=True)
class Oil:
    """Oil of a scene.

    Attributes:
        name: Name of the oil, or of its law.
        lubricant: The oil.
        temperature: Its temperature [K].
        supply: One of `SUPPLIES`.
        roughness: Combined root mean square of both surfaces [m], or `None`.
    """

    name: str
    lubricant: Lubricant
    temperature: float
    supply: str
    roughness: float | None


class OilFacts(NamedTuple):
    """Friction and films of a solved scene, in NumPy.

    Attributes:
        friction: Friction by Palmgren; `None` for types without known constants.
        skf: Friction by SKF's model; `None` for types that it does not cover.
        films: Films of every contact.
    """

    friction: Friction | None
    skf: SkfFriction | None
    films: Films


def read_oil(table: Table) -> tuple[Oil, tuple[str, ...]]:
    """Read the oil of a solve, and the assumptions made about it.

    Args:
        table: `[lubricant]`.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    keys = read_keys(LubricantKeys, table)
    known = keys.temperature, keys.supply, keys.roughness
    return Oil(keys.oil_name, keys.oil(), *known), keys.assumed


def oil_facts(
    oil: Oil, solution: Solution, catalogue: FromCatalogue | None = None
) -> OilFacts | None:
    """Compute friction and films of a solution; `None` at rest.

    Args:
        oil: From `read_oil`.
        solution: Converged solution.
        catalogue: Catalogue entry of the bearing's designation.
    """
    if relative_speed(solution.speed) == 0.0:
        return None
    numbers = solution_with_empty_places(jax.device_put(solution))
    rough = None if oil.roughness is None else as_array(oil.roughness, float)
    temperature = as_array(oil.temperature, float)
    series, diameters = None, None
    if catalogue is not None:
        entry = catalogue.entry
        series = skf_series_of(entry)
        sizes = entry.bore, entry.outside_diameter
        diameters = tuple(as_array(size, float) for size in sizes)
    known = oil.supply, rough, series, diameters
    facts = _facts(numbers, oil.lubricant, temperature, *known)
    here = take_elements(facts.films, solution.element)
    return jax.device_get(facts._replace(films=here))


@program(quick=True, what="friction and films")
def _facts(solution, lubricant, temperature, supply, roughness, series, diameters):
    viscosity = lubricant.kinematic_viscosity(temperature)
    friction, skf = None, None
    more = dict(series=series, diameters=diameters)
    # Types without constants, or without the diameters that those are for, are refused.
    with contextlib.suppress(ValueError):
        friction = friction_torque(solution, viscosity, supply)
    if skf_series(solution.element.bearing):
        with contextlib.suppress(ValueError):
            skf = skf_friction_torque(solution, viscosity, supply, **more)
    return OilFacts(
        friction,
        skf,
        films(solution, lubricant, temperature, roughness),
    )


def oil_report(oil: Oil, facts: OilFacts | None) -> list[str]:
    """Return the report lines of friction and films; empty at rest."""
    if facts is None:
        return []
    friction = facts.friction
    lines = [
        f"{oil.name}, {oil.supply.replace('_', ' ')}, at"
        f" {describe_oil(oil.lubricant, oil.temperature)}"
    ]
    if friction is None:
        lines.append("friction torque: no constants of Palmgren's formula are known")
    else:
        parts = {
            "load": friction.load_torque,
            "oil": friction.viscous_torque,
            "ribs": friction.flange_torque,
        }
        sums = {k: 1e3 * v.sum() for k, v in parts.items() if v.any()}
        text = ", ".join(f"{k} {value:.4g}" for k, value in sums.items())
        lines.append(
            f"friction torque (Palmgren) {1e3 * float(friction.torque):.4g} N mm"
            f" ({text}); {float(friction.power):.4g} W"
        )
    if facts.skf is not None:
        skf = facts.skf
        lines.append(
            f"friction torque (SKF, {series_words(skf)}) {1e3 * float(skf.torque):.4g}"
            f" N mm (rolling {1e3 * skf.rolling_torque.sum():.4g}, sliding"
            f" {1e3 * skf.sliding_torque.sum():.4g}); {float(skf.power):.4g} W"
        )
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
    return lines


def series_words(skf: SkfFriction) -> str:
    """Tell whose constants of SKF's table a friction torque has."""
    assumed = ", assumed, as no designation tells it" if skf.assumed else ""
    return f"series {skf.series}{assumed}"


def oil_as_dict(facts: OilFacts | None) -> dict[str, Any]:
    """Return friction and films as plain numbers, in SI; empty at rest.

    Returns:
        friction_torque [N m]; friction: load, viscous, flange (row) [N m], power [W];
        both for types with known constants;
        friction_skf, for types covered by SKF's model: torque [N m], rolling, sliding
        (row) [N m], power [W], series of the constants used, assumed: whether that
        is an assumption;
        film: central, minimum [m], entrainment [m/s] and with a roughness ratio, each
        (element, contact), null where no load is carried. Contacts as in
        `contact_load` for balls and in `roller_load` for rollers.
    """
    if facts is None:
        return {}
    friction, skf, found = facts
    numbers: dict[str, Any] = {}
    if friction is not None:
        numbers = {
            "friction_torque": friction.torque,
            "friction": {
                "load": friction.load_torque,
                "viscous": friction.viscous_torque,
                "flange": friction.flange_torque,
                "power": friction.power,
            },
        }
    if skf is not None:
        numbers["friction_skf"] = {
            "torque": skf.torque,
            "rolling": skf.rolling_torque,
            "sliding": skf.sliding_torque,
            "power": skf.power,
            "series": skf.series,
            "assumed": skf.assumed,
        }
    return to_json({**numbers, "film": array_fields(found)})

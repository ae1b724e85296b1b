"""Rollers on raceways: line laws, and half-spaces cell by cell."""

from typing import Any

import jax.numpy as jnp
import numpy as np

from ....contact.halfspace import RollerContact
from ....contact.line import (
    ISO16281,
    Palmgren,
    half_width,
    peak_pressure,
    relative_radius,
)
from ....design import Lundberg, Logarithmic, Material, Straight, contact_modulus

_PROFILES = {"straight": Straight, "logarithmic": Logarithmic, "lundberg": Lundberg}


def line_laws(length: np.ndarray, line_load: float, depth: float) -> dict[str, Any]:
    """Return constants of the line laws for steel, and approaches by them.

    Args:
        length: Lengths of the contact (n,) [m].
        line_load: Load per length [N/m].
        depth: Approach of a slice [m].

    Returns:
        Constants of one contact and of two in series times the length, which is the
        load of a roller over approach^(10/9); by Palmgren's law the approach of the
        load, and load and energy per length of the slice, of one contact.
    """
    steel, size = Material(), jnp.asarray(length)
    found = {}
    for law in (Palmgren(), ISO16281()):
        name = type(law).__name__.lower()
        constant = np.asarray(law.constant(steel, steel, size))
        found[name] = constant
        found[f"{name}_roller"] = constant * length
        found[f"{name}_two"] = constant * length / 2.0 ** (10 / 9)
    found["approach"] = (line_load / found["palmgren"]) ** 0.9
    found["slice_load"] = found["palmgren"] * depth ** (10 / 9)
    return found | {"slice_energy": 9 / 19 * depth * found["slice_load"]}


def line_contact(
    length: float,
    roller_diameter: float,
    raceway_radius: float,
    load: float,
    elastic_modulus: float,
    poisson_ratio: float,
) -> dict[str, float]:
    """Return Hertz's half width and pressure, and approaches of a line contact.

    Args:
        length, roller_diameter: Of a cylindrical roller [m].
        raceway_radius: Above 0: convex; below: hollow [m].
        load: [N].
        elastic_modulus, poisson_ratio: Of both bodies [Pa], [1].
    """
    steel = Material(elastic_modulus, poisson_ratio)
    modulus = contact_modulus(steel, steel)
    size = jnp.asarray(length)
    radius = relative_radius(
        jnp.asarray(0.5 * roller_diameter), jnp.asarray(raceway_radius)
    )
    of_line = jnp.asarray(load) / size, radius, modulus
    constant = Palmgren().constant(steel, steel, size)
    roller = RollerContact(
        length,
        roller_diameter,
        roller_diameter,
        raceway_radius=raceway_radius,
        material=steel,
        raceway_material=steel,
    )
    return {
        "half_width": float(half_width(*of_line)),
        "pressure": float(peak_pressure(*of_line)),
        "palmgren": float((of_line[0] / constant) ** 0.9),
        "half_spaces": float(roller.solve(load).approach),
    }


def roller_on_plane(
    length: float,
    small_diameter: float,
    large_diameter: float,
    elastic_modulus: float,
    load: float,
    profile: str = "straight",
    parameters: dict[str, float] | None = None,
    half_angle: float | None = None,
    grid: np.ndarray | None = None,
    places: np.ndarray | None = None,
    tilt: float = 0.0,
    free_to_tilt: bool = False,
) -> dict[str, Any]:
    """Return the contact of a steel roller on a plane, both half-spaces.

    Args:
        length, small_diameter, large_diameter: Of the roller [m].
        elastic_modulus: Of both bodies; Poisson's ratio is 0.3 [Pa].
        load: [N].
        profile: "straight", "logarithmic" or "lundberg", with its `parameters`.
        half_angle: Half cone angle; by default that of the diameters [rad].
        grid: Half width of the cells [m], numbers across and along, grading; by
            default as the contact needs.
        places: Distances from the small end at which the pressure is wanted (n,) [m].
        tilt: [rad].
        free_to_tilt: Whether there is no moment, in place of the tilt.

    Returns:
        Approach, tilt, moment, peak pressure, pressures at `places`, and of the cells
        at small and large end, with their line loads; shares of the load within a
        millimetre of either end; least and largest pressure 2 mm and more from them;
        Hertz's pressure in the middle of an endless roller.
    """
    steel = Material(elastic_modulus, 0.3)
    roller = RollerContact(
        length,
        small_diameter,
        large_diameter,
        half_angle=half_angle,
        roller_profile=_PROFILES[profile](**(parameters or {})),
        material=steel,
        raceway_material=steel,
    )
    cells = None
    if grid is not None:
        width, across, along, grading = map(float, grid)
        cells = roller.grid(width, int(across), int(along), grading)
    held = {"moment": 0.0} if free_to_tilt else {"tilt": tilt}
    found = roller.solve(load, grid=cells, **held)
    edges = np.asarray(found.grid.edges)
    y, pressure = edges[-1] - np.asarray(found.grid.y), found.centre_pressure
    pressure, line_load = np.asarray(pressure), np.asarray(found.line_load)

    def at(place):
        return np.interp(place, y[::-1], pressure[::-1])

    carried = np.cumsum(line_load * np.diff(edges)) / load
    near = np.interp([1e-3, length - 1e-3], edges[1:] - edges[0], carried)
    hertz = peak_pressure(
        jnp.asarray(load / length), roller.relative_radius(jnp.zeros(())), roller.modulus
    )
    between = at(np.linspace(2e-3, length - 2e-3, 1101))
    return {
        "approach": float(found.approach),
        "tilt": float(found.tilt),
        "moment": float(found.moment),
        "peak": float(found.peak_pressure),
        "at": at(np.asarray(0.5 * length if places is None else places)),
        "small_end": pressure[-1],
        "large_end": pressure[0],
        "small_over_large": pressure[-1] / (pressure[0] or np.nan),
        "end_loads": line_load[[-1, 0]],
        "end_shares": np.array([1.0 - near[1], near[0]]),
        "hertz": float(hertz),
        "between": np.array([between.min(), between.max()]),
    }

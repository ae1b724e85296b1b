"""Rollers on raceways: line laws, and half-spaces cell by cell."""

from typing import Any

import jax.numpy as jnp
import numpy as np

from ....contact.halfspace import RollerContact
from ....contact.line import ISO16281, Palmgren, peak_pressure
from ....design import Lundberg, Material, Straight


def line_laws(length: np.ndarray, line_load: float, depth: float) -> dict[str, Any]:
    """Return constants of the line laws for steel, and approaches by them.

    Args:
        length: Lengths of the contact (n,) [m].
        line_load, depth: Load per length, approach of a slice [N/m, m].

    Returns:
        Constants of one contact; times the length, of one and of two in series; by
        Palmgren's law the approach of the load, load and energy of the slice.
    """
    steel, found = Material(), {}
    for law in (Palmgren(), ISO16281()):
        name = type(law).__name__.lower()
        sizes = map(jnp.asarray, length)
        constant = np.array([law.constant(steel, steel, size) for size in sizes])
        found[name] = constant
        found[f"{name}_roller"] = constant * length
        found[f"{name}_two"] = constant * length / 2.0 ** (10 / 9)
    found["approach"] = (line_load / found["palmgren"]) ** 0.9
    found["slice_load"] = found["palmgren"] * depth ** (10 / 9)
    return found | {"slice_energy": 9 / 19 * depth * found["slice_load"]}


def roller_on_plane(
    roller: dict[str, Any],
    elastic_modulus: float,
    load: float,
    places: np.ndarray,
    design_load: float | None = None,
    grid: np.ndarray | None = None,
    free_to_tilt: bool = False,
) -> dict[str, Any]:
    """Return the contact of a roller on a plane, both half-spaces.

    Args:
        roller: Sizes of a `RollerContact`.
        elastic_modulus: Elastic modulus of both bodies, whose Poisson's ratio is 0.3
            [Pa].
        load: Load that presses them together [N].
        places: Distances from the small end at which the pressure is wanted (n,) [m].
        design_load: Of Lundberg's profile; none: no profile [N].
        grid: Half width of the cells [m], numbers across and along, grading; by
            default as the contact needs.
        free_to_tilt: Whether there is no moment, in place of no tilt.

    Returns:
        Approach, tilt, pressures at `places`; of the cells at small and large end
        pressures and line loads; shares of the load within 1 mm of either end; least
        and largest pressure 2 mm and more from them; Hertz's of an endless roller.
    """
    steel = Material(elastic_modulus, 0.3)
    contact = RollerContact(
        **roller,
        roller_profile=Straight() if design_load is None else Lundberg(design_load),
        material=steel,
        raceway_material=steel,
    )
    cells = None
    if grid is not None:
        width, across, along, grading = map(float, grid)
        cells = contact.grid(width, int(across), int(along), grading)
    held: dict[str, Any] = {"moment" if free_to_tilt else "tilt": 0.0}
    found = contact.solve(load, grid=cells, **held)
    edges = np.asarray(found.grid.edges)
    y, length = edges[-1] - np.asarray(found.grid.y), edges[-1] - edges[0]
    pressure, line_load = map(np.asarray, (found.centre_pressure, found.line_load))

    def at(place):
        return np.interp(place, y[::-1], pressure[::-1])

    carried = np.cumsum(line_load * np.diff(edges)) / load
    near = np.interp([1e-3, length - 1e-3], edges[1:] - edges[0], carried)
    between = at(np.linspace(2e-3, length - 2e-3, 1101))
    radius = contact.relative_radius(jnp.zeros(()))
    hertz = peak_pressure(jnp.asarray(load / length), radius, contact.modulus)
    return {
        "approach": float(found.approach),
        "tilt": float(found.tilt),
        "at": at(places),
        "small_end": pressure[-1],
        "large_end": pressure[0],
        "small_over_large": pressure[-1] / (pressure[0] or np.nan),
        "end_loads": line_load[[-1, 0]],
        "end_shares": np.array([1.0 - near[1], near[0]]),
        "between": np.array([between.min(), between.max()]),
        "hertz": float(hertz),
    }

"""Stress below the contact of a roller, in a section."""

import numpy as np

from ..contact.halfspace import ContactSolution, stress_below
from .contact_lines import load_text
from .style import Ax, Axes, axes_or_new

_POINTS = 61, 41
STRESSES = {"von_mises": "von Mises stress", "greatest_shear": "largest shear stress"}
SECTIONS = ("across", "along")


def contact_stress(
    solution: ContactSolution,
    ax: Ax = None,
    *,
    section: str = "across",
    y: float | None = None,
    kind: str = "von_mises",
    poisson: float = 0.3,
) -> Axes:
    """Plot von Mises or largest shear stress [MPa] in a section below the contact.

    The depth is three half widths of the contact. A cross marks the largest value
    drawn; the first tenth of a half width below the surface, where the steps of the
    pressure are visible, is left out.

    Args:
        solution: A single solution with a contact.
        section: "across" the roller, or "along" it at x = 0.
        y: Position of the "across" section [m]; `None`: at the centre of the load.
        kind: "von_mises" or "greatest_shear".
        poisson: Poisson's ratio of the body [1].

    Returns:
        The axes; the colour bar is next to it.

    Raises:
        ValueError: For another section or kind, or without a contact.
    """
    if section not in SECTIONS:
        raise ValueError(f"`section` is {section!r}; it must be 'across' or 'along'.")
    if kind not in STRESSES:
        raise ValueError(
            f"`kind` is {kind!r}; it must be one of {', '.join(STRESSES)}."
        )
    grid, pressure = solution.grid, np.asarray(solution.pressure)
    if not pressure.any():
        raise ValueError("contact_stress: there is no contact, and no stress.")
    y = float(solution.moment / solution.load) if y is None else y
    cells = np.abs(np.asarray(grid.x))[(pressure > 0).any(axis=1)]
    half_width = float(cells.max() + grid.half_x)
    z = np.linspace(0.1, 3.0, _POINTS[1]) * half_width
    if section == "across":
        places = np.linspace(-2.0, 2.0, _POINTS[0]) * half_width
        x, along, unit = places, np.full_like(places, y), 1e6
    else:
        places = along = np.asarray(grid.y)
        x, unit = np.zeros_like(along), 1e3
    found = stress_below(solution, x[:, None], along[:, None], z[None], poisson)
    values = 1e-6 * np.asarray(getattr(found, kind))
    ax = axes_or_new(ax, (8.0, 4.5))
    image = ax.contourf(unit * places, 1e6 * z, values.T, 20, cmap="viridis")
    ax.figure.colorbar(image, ax=ax, pad=0.02).set_label(f"{STRESSES[kind]} [MPa]")
    i, k = np.unravel_index(values.argmax(), values.shape)
    ax.plot(unit * places[i], 1e6 * z[k], "+", color="white", markersize=10)
    ax.invert_yaxis()
    ax.set_ylabel("depth [µm]")
    where = f"x = 0, largest {values.max():.0f} MPa"
    if section == "across":
        ax.set_aspect("equal")
        ax.set_xlabel("across the roller [µm]")
        where = f"at {1e3 * y:.4g} mm, largest {values.max():.0f} MPa"
    else:
        ax.set_xlabel("position along the roller [mm]")
    ax.set_title(
        f"{STRESSES[kind][0].upper()}{STRESSES[kind][1:]} under {load_text(solution)}:"
        f" {where} in {1e6 * z[k]:.3g} µm"
    )
    return ax

"""The loaded area of a contact: nodes with their pressures and viscosities.

It depends on the load alone, so that an integration in time makes it once.
"""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import count
from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .lubricant import Lubricant


class Patch(eqx.Module):
    """A loaded contact area; from `ellipse_patch`, `line_patch`.

    x is the rolling direction, y runs across it, both from the middle of the contact.

    Attributes:
        x: Positions of the nodes (node,) [m].
        y: Positions of the nodes (node,) [m].
        area: Their shares of the area (node,) [m²].
        pressure: Pressure (node,) [Pa].
        viscosity: Viscosity at that pressure (node,) [Pa s].
        moments: Integrals of μ, μ y and μ (x² + y²) over the area (3,)
            [N s, N m s, N m² s]; that of μ x vanishes.
    """

    x: Float[Array, " node"] = eqx.field(metadata=unit("m"))
    y: Float[Array, " node"] = eqx.field(metadata=unit("m"))
    area: Float[Array, " node"] = eqx.field(metadata=unit("m²"))
    pressure: Float[Array, " node"] = eqx.field(metadata=unit("Pa"))
    viscosity: Float[Array, " node"] = eqx.field(metadata=unit("Pa s"))
    moments: Float[Array, "3"] = eqx.field(metadata=unit(("N s", "N m s", "N m² s")))

    def without_nodes(self) -> "Patch":
        """The moments alone, for a law of traction that needs no more."""
        none = jnp.zeros((*self.area.shape[:-1], 0), self.area.dtype)
        return eqx.tree_at(
            lambda p: (p.x, p.y, p.area, p.pressure, p.viscosity), self, (none,) * 5
        )


def ellipse_patch(
    lubricant: Lubricant,
    temperature: Scalar | float,
    rolling: Scalar,
    transverse: Scalar,
    peak_pressure: Scalar,
    radial: int = 24,
    angular: int = 32,
) -> Patch:
    """Nodes on a Hertz ellipse.

    On the unit disc, the angles evenly spaced, the radii by Gauss and Legendre in s
    with p/p_max = 1 - s²: the pressure itself is the variable, crowded at the middle,
    where the viscosity is largest.

    Args:
        lubricant: Oil.
        temperature: Its temperature [K].
        rolling: Semi-axis in rolling direction [m].
        transverse: Semi-axis across [m].
        peak_pressure: Largest pressure [Pa].
        radial, angular: Numbers of radii and of angles. Static.

    Errors of the defaults in force, moment and heat, MIL-L-23699 at 30 °C: Newtonian
        1e-13 at 1 GPa, 2e-6 at 1.5 GPa, 7e-3 up to 4 GPa; oil that thins or yields
        1e-9 at 0.5 GPa, 1e-3 at 1 GPa, 9e-3 up to 4 GPa.
    """
    count("ellipse_patch", "radial", radial)
    count("ellipse_patch", "angular", angular)
    like = as_real(peak_pressure)
    s, weight = _half_interval(radial)
    share = 1.0 - s * s
    radius = s * np.sqrt(1.0 + share)
    ring = 2.0 * np.pi * share * 2.0 * s * weight  # r dr dφ of each radius
    angle = 2.0 * np.pi * (np.arange(angular) + 0.5) / angular

    def constant(values):
        return jnp.asarray(values, like.dtype)

    pressure = like * constant(share)
    viscosity = lubricant.viscosity(pressure, temperature)
    area = rolling * transverse
    total = area * jnp.dot(constant(ring), viscosity)
    polar = area * jnp.dot(constant(0.5 * ring * radius**2), viscosity)
    spread = np.ones(angular)
    return Patch(
        x=rolling * constant(np.outer(radius, np.cos(angle)).ravel()),
        y=transverse * constant(np.outer(radius, np.sin(angle)).ravel()),
        area=area * constant(np.outer(ring, spread / angular).ravel()),
        pressure=jnp.repeat(pressure, angular),
        viscosity=jnp.repeat(viscosity, angular),
        moments=jnp.stack(
            [total, jnp.zeros_like(total), polar * (rolling**2 + transverse**2)]
        ),
    )


def line_patch(
    lubricant: Lubricant,
    temperature: Scalar | float,
    position: Float[Array, " slice"],
    width: Float[Array, " slice"],
    line_load: Float[Array, " slice"],
    half_width: Float[Array, " slice"],
    across: int = 12,
) -> Patch:
    """Nodes of a line contact in slices.

    Across a slice they are those of Gauss and Legendre in the angle whose cosine is
    p/p_max, from the middle to either edge.

    Args:
        lubricant: Oil.
        temperature: Its temperature [K].
        position: Where each slice is along the roller (slice,) [m].
        width: How much of the length each one stands for (slice,) [m].
        line_load: Load per length, at least 0 (slice,) [N/m].
        half_width: Half width of the contact (slice,) [m].
        across: Nodes from the middle of a slice to each edge. Static.

    Errors of the default across a slice, MIL-L-23699 at 30 °C: Newtonian 6e-8 at
        1 GPa, 2e-5 at 1.5 GPa, 2e-2 up to 4 GPa.
    """
    count("line_patch", "across", across)
    s, weight = _half_interval(across)
    angle = 0.5 * np.pi * np.concatenate([-s[::-1], s])
    weight = 0.5 * np.pi * np.concatenate([weight[::-1], weight])
    sine, share, strip = (
        jnp.asarray(v, position.dtype)
        for v in (np.sin(angle), np.cos(angle), weight * np.cos(angle))
    )
    loaded = half_width > 0
    peak = 2.0 * line_load / (np.pi * jnp.where(loaded, half_width, 1.0))
    pressure = jnp.outer(jnp.where(loaded, peak, 0.0), share).ravel()
    viscosity = lubricant.viscosity(pressure, temperature)
    area = jnp.outer(half_width * width, strip).ravel()
    x, y = jnp.outer(half_width, sine).ravel(), jnp.repeat(position, sine.size)
    lever = jnp.stack([jnp.ones_like(x), y, x * x + y * y])
    return Patch(x, y, area, pressure, viscosity, moments=lever @ (area * viscosity))


def _half_interval(points):
    """Gauss-Legendre nodes and weights of the interval from 0 to 1."""
    node, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (1.0 + node), 0.5 * weight

"""The loaded area of a contact: nodes with their pressures and viscosities.

Terms that depend on the load only are kept here, and computed once in an integration in
time. The nodes of an ellipse move with its slip: they are placed around the rolling
pole, the point without slip, where the stress of an oil that yields turns around.
"""

import abc
from typing import Annotated, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import count
from ..numerics.types import Number, Reals, Scalar, as_real
from ..numerics.units import unit
from .lubricant import Lubricant

_INNER = 0.7
"""Square of the pole's distance, over the ellipse's, up to which nodes follow it."""
_RETURN = 3.0
"""Rate of their return to the middle as the pole leaves the ellipse: at most 0.93 of
the way to the edge."""
_FROM = 0.75
"""Point where rays would meet, as a share of the way from middle to centre [1]."""
_LEAST_MOTION = 1e-30
"""Square of a motion that counts as none [rad²/s²]."""
_LEAST_AXIS = 1e-12
"""Semi-axis of an ellipse without load [m]."""
_OF_MOMENTS = 24
"""Nodes of the integrals for moments."""


class Nodes(NamedTuple):
    """Points of a loaded area. x is the rolling direction, y runs across it.

    On one axis or two: slices of a line, rays of an ellipse.

    Attributes:
        x: Positions from the middle of the contact (*node,) [m].
        y: Positions (*node,) [m].
        area: Their shares of the area (*node,) [m²].
        pressure: Pressure (*node,) [Pa].
        viscosity: Viscosity at that pressure (*node,) [Pa s].
    """

    x: Annotated[Float[Array, "*node"], unit("m")]
    y: Annotated[Float[Array, "*node"], unit("m")]
    area: Annotated[Float[Array, "*node"], unit("m²")]
    pressure: Annotated[Float[Array, "*node"], unit("Pa")]
    viscosity: Annotated[Float[Array, "*node"], unit("Pa s")]


class AbstractPatch(eqx.Module):
    """A loaded contact area.

    Attributes:
        moments: Integrals of μ, μ y and μ (x² + y²) over the area (3,)
            [N s, N m s, N m² s]; that of μ x vanishes.
    """

    moments: eqx.AbstractVar[Float[Array, "3"]]

    @abc.abstractmethod
    def nodes(self, slip: Float[Array, "2"], spin: Scalar) -> Nodes:
        """Nodes at which the traction of a motion is summed.

        Args:
            slip: Slip in the middle, u_x and u_y (2,) [m/s].
            spin: Spin w of the slip (u_x + y w, u_y - x w) [rad/s].
        """

    @property
    @abc.abstractmethod
    def extent(self) -> Float[Array, "*n 2"]:
        """Area and its polar moment about the middle (2,) [m², m⁴]."""

    @property
    @abc.abstractmethod
    def thinnest(self) -> Float[Array, "*n"]:
        """Viscosity at the lowest pressure [Pa s]."""

    @property
    @abc.abstractmethod
    def peak(self) -> Float[Array, "*n"]:
        """Largest pressure [Pa]."""

    @abc.abstractmethod
    def numbers(self) -> tuple[Reals, ...]:
        """Quantities, other than the moments, that depend on the load, for
        interpolation between two loads."""

    @abc.abstractmethod
    def with_numbers(
        self, numbers: tuple[Reals, ...], moments: Float[Array, "*n 3"]
    ) -> "AbstractPatch":
        """Return the patch with other `numbers` and moments."""


class EllipsePatch(AbstractPatch):
    """A Hertz ellipse; from `ellipse_patch`.

    Attributes:
        lubricant: Oil.
        temperature: Its temperature [K].
        rolling: Semi-axis in rolling direction [m].
        transverse: Semi-axis across [m].
        peak_pressure: Largest pressure [Pa].
        moments: As in `AbstractPatch` (3,) [N s, N m s, N m² s].
        radial, angular: Numbers of nodes along a ray and of rays.

    Static: radial, angular.
    """

    lubricant: Lubricant
    temperature: Scalar = eqx.field(metadata=unit("K"))
    rolling: Scalar = eqx.field(metadata=unit("m"))
    transverse: Scalar = eqx.field(metadata=unit("m"))
    peak_pressure: Scalar = eqx.field(metadata=unit("Pa"))
    moments: Float[Array, "3"] = eqx.field(metadata=unit(("N s", "N m s", "N m² s")))
    radial: int = eqx.field(static=True)
    angular: int = eqx.field(static=True)

    def nodes(self, slip: Float[Array, "2"], spin: Scalar) -> Nodes:
        """Nodes of an ellipse.

        On rays from a centre c to points e of the edge, in units of the semi-axes: c is
        the rolling pole where that lies in the ellipse, and the middle where it is far
        outside. At the share s of the way the point is c + s (e - c), the area is
        s ds (1 - c·e) dφ, with φ the angle of e, and (p/p_max)² =
        (1 - s)(1 + s - 2 s c·e - c² (1 - s)). Along a ray nodes are those of Gauss and
        Legendre in t, s = t (2 - t), which takes away the root at the edge and crowds
        them at the centre. The rays are those that leave the point 3/4 c at evenly
        spaced angles: even angles about c would make the area change fast, even angles
        about the middle the direction of the slip.
        """
        a = jnp.maximum(self.rolling, _LEAST_AXIS)
        b = jnp.maximum(self.transverse, _LEAST_AXIS)
        t, weight = _half_interval(self.radial)
        way, step = t * (2.0 - t), 2.0 * (1.0 - t) * weight * t * (2.0 - t)
        even = 2.0 * np.pi * (np.arange(self.angular) + 0.5) / self.angular
        cos, sin, way, step = (
            jnp.asarray(v, a.dtype) for v in (np.cos(even), np.sin(even), way, step)
        )
        # The slip turns fast beside the short axis of a flat ellipse: rays crowd there.
        flat = (a / b) ** 0.25
        stretch = 1.0 / (cos * cos + flat * flat * sin * sin)
        dx, dy = cos * jnp.sqrt(stretch), flat * sin * jnp.sqrt(stretch)
        cx, cy = _centre(slip[1] / a, -slip[0] / b, spin)
        fx, fy = _FROM * cx, _FROM * cy
        along = fx * dx + fy * dy
        half = jnp.sqrt(along * along + 1.0 - fx * fx - fy * fy)
        ray = half - along
        ex, ey = fx + ray * dx, fy + ray * dy
        turn = 2.0 * np.pi / self.angular * flat * stretch * ray / half
        toward, left = cx * ex + cy * ey, 1.0 - way
        x = jnp.outer(left, jnp.full_like(ex, cx)) + jnp.outer(way, ex)
        y = jnp.outer(left, jnp.full_like(ey, cy)) + jnp.outer(way, ey)
        inner = 1.0 + way - (cx * cx + cy * cy) * left
        share = jnp.sqrt(
            left[:, None] * (inner[:, None] - jnp.outer(2.0 * way, toward))
        )
        area = self.rolling * self.transverse * jnp.outer(step, (1.0 - toward) * turn)
        # Two axes to the end: in one row, the compiler would make no vectors of them.
        pressure = self.peak_pressure * share
        viscosity = self.lubricant.viscosity(pressure, self.temperature)
        return Nodes(a * x, b * y, area, pressure, viscosity)

    @property
    def extent(self) -> Float[Array, "*n 2"]:
        area = jnp.pi * self.rolling * self.transverse
        polar = 0.25 * area * (self.rolling**2 + self.transverse**2)
        return jnp.stack([area, polar], axis=-1)

    @property
    def thinnest(self) -> Float[Array, "*n"]:
        def ambient_viscosity(oil, kelvin):
            return oil.viscosity(jnp.zeros_like(kelvin), kelvin)

        for _ in range(self.temperature.ndim):
            ambient_viscosity = jax.vmap(ambient_viscosity)
        return ambient_viscosity(self.lubricant, self.temperature)

    @property
    def peak(self) -> Float[Array, "*n"]:
        return self.peak_pressure

    def numbers(self) -> tuple[Reals, ...]:
        return self.rolling, self.transverse, self.peak_pressure

    def with_numbers(
        self, numbers: tuple[Reals, ...], moments: Float[Array, "*n 3"]
    ) -> "AbstractPatch":
        rolling, transverse, peak = (jnp.maximum(n, 0.0) for n in numbers)
        return eqx.tree_at(
            lambda p: (p.rolling, p.transverse, p.peak_pressure, p.moments),
            self,
            (rolling, transverse, peak, moments),
        )


class LinePatch(AbstractPatch):
    """A line contact in slices; from `line_patch`.

    Attributes:
        fixed: Its nodes, the same for every motion.
        moments: As in `AbstractPatch` (3,) [N s, N m s, N m² s].
    """

    fixed: Nodes
    moments: Float[Array, "3"] = eqx.field(metadata=unit(("N s", "N m s", "N m² s")))

    def nodes(self, slip: Float[Array, "2"], spin: Scalar) -> Nodes:
        """Return the nodes, which do not depend on the motion."""
        return self.fixed

    @property
    def extent(self) -> Float[Array, "*n 2"]:
        at = self.fixed
        polar = jnp.sum(at.area * (at.x**2 + at.y**2), axis=-1)
        return jnp.stack([jnp.sum(at.area, axis=-1), polar], axis=-1)

    @property
    def thinnest(self) -> Float[Array, "*n"]:
        return jnp.min(self.fixed.viscosity, axis=-1)

    @property
    def peak(self) -> Float[Array, "*n"]:
        return jnp.max(self.fixed.pressure, axis=-1)

    def numbers(self) -> tuple[Reals, ...]:
        return (*self.fixed[:4], jnp.log(self.fixed.viscosity))

    def with_numbers(
        self, numbers: tuple[Reals, ...], moments: Float[Array, "*n 3"]
    ) -> "AbstractPatch":
        x, y, area, pressure, log_viscosity = numbers
        area, pressure = jnp.maximum(area, 0.0), jnp.maximum(pressure, 0.0)
        fixed = Nodes(x, y, area, pressure, jnp.exp(log_viscosity))
        return eqx.tree_at(lambda p: (p.fixed, p.moments), self, (fixed, moments))


def ellipse_patch(
    lubricant: Lubricant,
    temperature: Number,
    rolling: Scalar,
    transverse: Scalar,
    peak_pressure: Scalar,
    radial: int = 24,
    angular: int = 32,
) -> EllipsePatch:
    """A Hertz ellipse.

    Its moments are integrated by Gauss and Legendre in s with p/p_max = 1 - s²: the
    pressure itself is the variable, crowded at the middle, where the viscosity is
    largest. For other sums see `EllipsePatch.nodes`.

    Args:
        lubricant: Oil.
        temperature: Its temperature [K].
        rolling: Semi-axis in rolling direction [m].
        transverse: Semi-axis across [m].
        peak_pressure: Largest pressure [Pa].
        radial, angular: Numbers of nodes along a ray and of rays. Static.

    Errors of the defaults in force, moment and heat, MIL-L-23699: Newtonian, by the
        moments, at 30 °C 1e-13 at 1 GPa, 2e-6 at 1.5 GPa, 7e-3 up to 4 GPa. Oil that
        thins or yields, at 30 and 100 °C, with the pole anywhere, relative to the
        largest values over all places: 4e-5 at 0.5 GPa, 5e-4 up to 2 GPa, 1e-3 at
        4 GPa; slopes by the slip 2e-4, 3e-3, 1e-2. Dry friction 4e-5, slopes 1e-3.
    """
    count("ellipse_patch", "radial", radial)
    count("ellipse_patch", "angular", angular)
    like, warm = as_real(peak_pressure), as_real(temperature)
    s, weight = _half_interval(_OF_MOMENTS)
    share = 1.0 - s * s
    square = s * s * (1.0 + share)  # of the radius
    ring = 4.0 * np.pi * share * s * weight  # r dr dφ of each radius
    ring, lever, share = (jnp.asarray(v, like.dtype) for v in (ring, square, share))
    stiff = ring * lubricant.viscosity(like * share, warm)
    total = rolling * transverse * jnp.sum(stiff)
    polar = 0.5 * rolling * transverse * jnp.dot(stiff, lever)
    polar = polar * (rolling**2 + transverse**2)
    moments = jnp.stack([total, jnp.zeros_like(total), polar])
    return EllipsePatch(
        lubricant=lubricant,
        temperature=warm,
        rolling=as_real(rolling),
        transverse=as_real(transverse),
        peak_pressure=like,
        moments=moments,
        radial=radial,
        angular=angular,
    )


def line_patch(
    lubricant: Lubricant,
    temperature: Number,
    position: Float[Array, " slice"],
    width: Float[Array, " slice"],
    line_load: Float[Array, " slice"],
    half_width: Float[Array, " slice"],
    across: int = 12,
) -> LinePatch:
    """A line contact in slices.

    Across a slice they are those of Gauss and Legendre in the angle whose cosine is
    p/p_max, from the middle to either edge.

    Args:
        lubricant: Oil.
        temperature: Its temperature [K].
        position: Position of each slice along the roller (slice,) [m].
        width: Length that each one represents (slice,) [m].
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
    nodes = Nodes(x, y, area, pressure, viscosity)
    return LinePatch(fixed=nodes, moments=lever @ (area * viscosity))


def _centre(x, y, spin):
    """Start of the rays of an ellipse, in units of its semi-axes: at the rolling
    pole (x, y)/spin, or, as it leaves the ellipse, back towards the middle.

    With c² the square of its distance: pole/[1 + 3 (c² - 0.7)³], continuous with two
    derivatives, multiplied by powers of the spin, which may be zero.
    """
    size = x * x + y * y + spin * spin
    moves = size > _LEAST_MOTION
    scale = jnp.where(moves, 1.0 / jnp.sqrt(jnp.where(moves, size, 1.0)), 0.0)
    x, y, spin = x * scale, y * scale, spin * scale
    turning = spin * spin
    over = jnp.maximum(x * x + y * y - _INNER * turning, 0.0)
    whole = jnp.where(moves, turning**3 + _RETURN * over**3, 1.0)
    factor = spin * turning * turning / whole
    return x * factor, y * factor


def _half_interval(points):
    """Gauss-Legendre nodes and weights of the interval from 0 to 1."""
    node, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (1.0 + node), 0.5 * weight

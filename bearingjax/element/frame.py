"""Definition of axes, freedoms and their order.

z is the bearing axis, right-handed; azimuth from +x towards +y. Twelve freedoms:
(ux uy uz gx gy gz) of the outer ring, then of the inner ring, in m and rad, all at the
origin on the axis in the middle of the row. In the axial section at azimuth φ a body
has (u axial, v radial, θ about e_t turning +z towards +r).
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.labels import name_axis
from ..numerics.types import Number, Scalar

FREEDOMS = name_axis("freedom", ("ux", "uy", "uz", "gx", "gy", "gz"))
LOADS = name_axis("component", ("Fx", "Fy", "Fz", "Mx", "My", "Mz"))
RINGS = name_axis("raceway", ("outer", "inner"))
DIRECTIONS = name_axis("direction", "xyz")
name_axis("section_freedom", ("u", "v", "theta"))
name_axis("ring_component", (f"{ring}_{load}" for ring in RINGS for load in LOADS))
for _axis in "ring_freedom", "moved_ring_freedom":
    name_axis(_axis, (f"{ring}_{name}" for ring in RINGS for name in FREEDOMS))

TWELVE = "(12,): outer ring (ux uy uz gx gy gz), then inner ring"
"""Allowed shape of the freedoms of both rings, in messages."""
MOTION_UNITS = ("m", "m", "m", "rad", "rad", "rad")
LOAD_UNITS = ("N", "N", "N", "N m", "N m", "N m")
STIFFNESS_UNITS = (
    *3 * (("N/m", "N/m", "N/m", "N", "N", "N"),),
    *3 * (("N", "N", "N", "N m", "N m", "N m"),),
)
"""Units of freedoms, of loads, and of loads per freedom; those of `rad` are 1."""


def section_matrix(azimuth: Scalar) -> Float[Array, "3 6"]:
    """Section freedoms (u, v, θ) from the six freedoms of a ring.

    Args:
        azimuth: Azimuth of the section [rad].

    Returns:
        Matrix A with (u, v, θ) = A (ux, uy, uz, gx, gy, gz).

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (8), first row restored.
    """
    c, s = jnp.cos(azimuth), jnp.sin(azimuth)
    o, i = jnp.zeros_like(c), jnp.ones_like(c)
    return jnp.stack(
        [
            jnp.stack([o, o, i, o, o, o]),
            jnp.stack([c, s, o, o, o, o]),
            jnp.stack([o, o, o, -s, c, o]),
        ]
    )


def placement(position: Scalar, sign: Scalar) -> Float[Array, "6 6"]:
    """Ring freedoms at the origin of a row, from those of its set.

    A mirrored row sees z reversed: uz and the tilts change their sign.

    Args:
        position: z of the row's origin in the set [m].
        sign: -1 for a row that is turned round, else 1.
    """
    one = jnp.ones_like(sign)
    p = jnp.diag(jnp.stack([one, one, sign, sign, sign, one]))
    # Displacement of the point (0, 0, position): u + g x r.
    return p.at[0, 4].add(position).at[1, 3].add(-position)


def turn_factors(square: Scalar) -> tuple[Scalar, Scalar]:
    """sin|g|/|g| and (1 - cos|g|)/|g|² of a rotation vector g, smooth at zero.

    With them R v = v + sin|g|/|g| g x v + (1 - cos|g|)/|g|² g x (g x v).

    Args:
        square: |g|² [rad²].

    Source: Rodrigues' formula.
    """
    small = square < 1e-4
    angle = jnp.sqrt(jnp.where(small, 1.0, square))
    half = jnp.sin(0.5 * angle)
    # Series below 0.01 rad, good to round-off there with the first two derivatives.
    one = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
    two = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0))
    one = jnp.where(small, one, jnp.sin(angle) / angle)
    return one, jnp.where(small, two, 2.0 * half * half / (angle * angle))


def to_roller_axes(
    axis_angle: Scalar, pitch_radius: Scalar, place: Number = 0.0
) -> Float[Array, "3 3"]:
    """Motion of the roller centre's point of a body, along and across the roller.

    (x_t, x_m, θ) = T (u, v, θ): displacement of the point (z, r) = (z_m, R_m) along
    the roller axis t and across it (m, outwards), and the rotation.

    Args:
        axis_angle: Angle of the roller axis to the bearing axis [rad].
        pitch_radius: R_m [m].
        place: z_m [m].

    Returns:
        T, of determinant 1.
    """
    # t = (cos β, sin β) with β = -axis_angle; m = (-sin β, cos β).
    c, s = jnp.cos(axis_angle), jnp.sin(axis_angle)
    o, i = jnp.zeros_like(c), jnp.ones_like(c)
    return jnp.stack(
        [
            jnp.stack([c, -s, -c * pitch_radius - s * place]),
            jnp.stack([s, c, c * place - s * pitch_radius]),
            jnp.stack([o, o, i]),
        ]
    )


def from_roller_axes(
    axis_angle: Scalar, pitch_radius: Scalar, place: Number = 0.0
) -> Float[Array, "3 3"]:
    """Inverse of `to_roller_axes`."""
    c, s = jnp.cos(axis_angle), jnp.sin(axis_angle)
    o, i = jnp.zeros_like(c), jnp.ones_like(c)
    return jnp.stack(
        [
            jnp.stack([c, s, i * pitch_radius]),
            jnp.stack([-s, c, -i * place]),
            jnp.stack([o, o, i]),
        ]
    )


def roll_ratio(diameter: Scalar, pitch_diameter: Scalar, cosine: Scalar) -> Scalar:
    """G = D cos α / d_m of the rolling kinematics [1]."""
    return diameter * cosine / pitch_diameter


def orbit(ratio: Scalar, outer: Number, inner: Number) -> Scalar:
    """Turn, or speed, of the set of rolling elements from those of the rings.

    Args:
        ratio: G of `roll_ratio` [1].
        outer: Turn [rad] or speed [rad/s] of the outer ring.
        inner: Turn [rad] or speed [rad/s] of the inner ring.

    Source: rolling without slip, ½[(1 - G) inner + (1 + G) outer].
    """
    return 0.5 * ((1.0 - ratio) * inner + (1.0 + ratio) * outer)


def rotation(
    ratio: Scalar,
    diameter: Scalar,
    pitch_diameter: Scalar,
    outer: Number,
    inner: Number,
) -> Scalar:
    """Speed of a rolling element about its own axis, seen from the set [rad/s].

    Args:
        ratio: G of `roll_ratio` [1].
        diameter, pitch_diameter: D and d_m [m].
        outer, inner: Speeds of the rings [rad/s].

    Returns:
        Opposite in sense to the inner ring where the outer one stands.

    Source: rolling without slip, -d_m/(2D) (1 - G²) (inner - outer).
    """
    return -0.5 * pitch_diameter / diameter * (1.0 - ratio**2) * (inner - outer)


def even_azimuths(
    first: Scalar, count: Scalar | int, places: int
) -> Float[Array, " element"]:
    """Azimuths of evenly spaced rolling elements [rad].

    Args:
        first: Azimuth of element 0 [rad].
        count: Number of elements.
        places: Number of azimuths; those beyond `count` go round again.
    """
    return first + 2.0 * jnp.pi / count * jnp.arange(places, dtype=first.dtype)

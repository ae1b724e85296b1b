"""Approach coordinates of all contacts of a roller from the rigid motions.

The approach along a raceway is affine in the position whatever the motion, so each
raceway contact has two approach coordinates: a at the middle of the roller and b, the
part from tilt at its +ξ end; each rib has one. In order: (a, b) outer, (a, b) inner,
ribs. All are in metres.

Motions are in roller axes (`frame.to_roller_axes`): of both rings (6,), outer first;
linearised kinematics take that of the inner against the outer one (3,) as well. The
roller's own three unknowns x are counted from the mean of both rings, with the tilt
times half the length, so that all are in metres:
motion = (outer + inner)/2 + (x_t, x_m, x_θ/(L/2)).
"""

import abc

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from .constants import ContactConstants
from .frame import from_roller_axes

Rings = Float[Array, " r"]
Unknowns = Float[Array, "3"]
Approaches = Float[Array, " contact"]


def roller_motion(constants: ContactConstants, rings: Rings, x: Unknowns) -> Unknowns:
    """Motion of the roller in roller axes.

    Args:
        constants: From `contact_constants`.
        rings: Motion of outer and inner ring in roller axes (6,) [m, rad].
        x: The roller's unknowns [m].

    Returns:
        (x_t, x_m, θ) [m, m, rad].
    """
    one = jnp.ones_like(constants.half_length)
    scale = jnp.stack([one, one, 1.0 / constants.half_length])
    return 0.5 * (rings[:3] + rings[3:]) + scale * x


class AbstractKinematics(eqx.Module):
    """How rigid motions become approaches."""

    @abc.abstractmethod
    def prepare(self, constants: ContactConstants):
        """What does not depend on the motion, computed once per design."""

    @abc.abstractmethod
    def approaches(self, prepared, rings: Rings, x: Unknowns) -> Approaches:
        """Approach coordinates [m]."""

    @abc.abstractmethod
    def jacobian(
        self, prepared, rings: Rings, x: Unknowns
    ) -> Float[Array, "contact r+3"]:
        """Their derivatives with respect to (rings, x)."""

    @abc.abstractmethod
    def curvature(
        self, prepared, rings: Rings, x: Unknowns, forces: Approaches
    ) -> Float[Array, "r+3 r+3"] | None:
        """Σ force · second derivative of the approach, or `None` if it is zero."""


class Linearised(AbstractKinematics):
    """Small rotations: the gap is affine and the energy convex. The default.

    The displacement of a point (z, r) is (u - r θ, v + z θ); approaches depend only
    on the motion of each ring relative to the roller.

    Valid: tilts well below roller diameter / roller length.
    Source: `Finite` to first order.
    """

    def prepare(self, constants):
        rows = _rows(constants)
        k = rows.shape[0]
        outer = jnp.asarray(_on_outer(constants), dtype=rows.dtype)[:, None]
        # Ring minus roller = ±(inner - outer)/2 - x.
        sign = 1.0 - 2.0 * outer
        scale = jnp.ones((3,), rows.dtype).at[2].set(1.0 / constants.half_length)
        jacobian = jnp.concatenate([0.5 * sign * rows, -scale[None, :] * rows], axis=1)
        start = jnp.full((k,), 0.0, rows.dtype)
        start = start.at[jnp.array([0, 2])].set(-constants.gap)
        if constants.ribs is not None:
            start = start.at[4:].set(-constants.ribs.gap)
        return start, jacobian

    def approaches(self, prepared, rings, x):
        start, jacobian = prepared
        # The difference first: a common motion then costs nothing, to round-off.
        between = rings if rings.shape[0] == 3 else rings[3:] - rings[:3]
        moved = jacobian[:, :3] * between[None, :] + jacobian[:, 3:] * x[None, :]
        return start + jnp.sum(moved, axis=1)

    def jacobian(self, prepared, rings, x):
        _, jacobian = prepared
        if rings.shape[0] == 3:
            return jacobian
        return jnp.concatenate([-jacobian[:, :3], jacobian], axis=1)

    def curvature(self, prepared, rings, x, forces):
        return None


class ConstantAngle(Linearised):
    """Contacts of balls keep their free contact angle. For balls at rest.

    For comparison with catalogues and with reduced models, which take a contact angle
    that no load changes; errs where loads are high or angles small. For angular
    contact and thrust bearings. Contacts of rollers keep their normals anyhow: for them
    it is `Linearised`. A turning ball finds no balance, because nothing holds it along
    its raceways: no `speed`. All normals of a row meet in one point of the axis, its
    pressure centre: a single row resists no tilt about it, so prescribe gx and gy, or
    take a set.
    """


class Finite(AbstractKinematics):
    """Finite rotations in the section, normals undeformed: formula (3) of the paper.

    To compare with the paper. The energy is not convex (tilting an upright roller
    shortens its projection) and the moments of the rings balance only to first
    order; a solve may end in a saddle and then says so.

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (3).
    """

    def prepare(self, constants):
        return constants

    def approaches(self, prepared, rings, x):
        c = prepared
        back = from_roller_axes(c.axis_angle, c.pitch_radius)
        outer, inner = back @ rings[:3], back @ rings[3:]
        roller = back @ roller_motion(c, rings, x)
        axes = _section_axes(c)
        place = jnp.stack([jnp.zeros_like(c.pitch_radius), c.pitch_radius])
        out = []
        sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
        for ring, sign in ((outer, 1.0), (inner, -1.0)):
            normal = axes @ jnp.stack([sin, sign * cos])
            direction = axes @ jnp.stack([cos, -sign * sin])
            middle = place + axes @ jnp.stack([0.0 * cos, sign * 0.5 * c.diameter])
            moved = _displacement(ring, middle) - _displacement(roller, middle)
            turned = _turn(ring[2], direction) - _turn(roller[2], direction)
            out += [-c.gap - normal @ moved, -c.half_length * (normal @ turned)]
        ribs = c.ribs
        if ribs is None:
            return jnp.stack(out)
        for k, on_outer in enumerate(ribs.on_outer):
            ring = outer if on_outer else inner
            moved = _displacement(ring, place + axes @ ribs.point[k]) - _displacement(
                roller, place + axes @ ribs.centre[k]
            )
            out.append(-ribs.gap[k] - (axes @ ribs.normal[k]) @ moved)
        return jnp.stack(out)

    def jacobian(self, prepared, rings, x):
        return jnp.concatenate(
            jax.jacfwd(self.approaches, argnums=(1, 2))(prepared, rings, x), axis=1
        )

    def curvature(self, prepared, rings, x, forces):
        def weighted(y):
            return forces @ self.approaches(prepared, y[:6], y[6:])

        return jax.hessian(weighted)(jnp.concatenate([rings, x]))


def _rows(constants):
    """Rows g with approach change = g · (ring motion - roller motion)."""
    c = constants
    sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
    lever = 0.5 * c.diameter * sin
    zero, half = jnp.zeros_like(sin), c.half_length
    rows = [
        jnp.stack([-sin, -cos, lever]),
        jnp.stack([zero, zero, -half]),
        jnp.stack([-sin, cos, -lever]),
        jnp.stack([zero, zero, half]),
    ]
    if c.ribs is not None:
        n, s = c.ribs.normal, c.ribs.centre
        turn = s[:, 0] * n[:, 1] - s[:, 1] * n[:, 0]
        rows += list(-jnp.stack([n[:, 0], n[:, 1], turn], axis=1))
    return jnp.stack(rows)


def _on_outer(constants):
    ribs = () if constants.ribs is None else constants.ribs.on_outer
    return [True, True, False, False, *ribs]


def _section_axes(constants):
    """Columns t, m in (z, r)."""
    c, s = jnp.cos(constants.axis_angle), jnp.sin(constants.axis_angle)
    return jnp.stack([jnp.stack([c, s]), jnp.stack([-s, c])])


def _turn(angle, vector):
    """Change of a vector (z, r) turned by `angle` from z towards r."""
    # 1 - cos without cancellation.
    versine, sine = 2.0 * jnp.sin(0.5 * angle) ** 2, jnp.sin(angle)
    return jnp.stack(
        [
            -versine * vector[0] - sine * vector[1],
            -versine * vector[1] + sine * vector[0],
        ]
    )


def _displacement(motion, point):
    """Displacement of a point of a body that moves by (u, v, θ) about O."""
    return motion[:2] + _turn(motion[2], point)

"""Results of solved balls: contact angles, ellipses, pressures, spin."""

from collections.abc import Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..contact.point_law import AbstractPointLaw, ball_ellipses, balls_of
from ..design import AbstractBallBearing
from ..element import BallKinematics, RowResults
from ..element.balls.ball_contacts import angles
from ..element.balls.ball_inertia import gyroscopic_moment
from ..numerics.units import unit


class BallResults(eqx.Module):
    """Axis contact: (outer, inner), or with two arcs per ring (outer, outer, inner,
    inner), each ring's arc for a positive contact angle first.

    Attributes:
        contact_load: Load of each contact (ball, contact) [N].
        contact_angle: Angle of the line through ball centre and groove centre, also
            of open contacts, positive where the row carries an inner-ring load along
            +z (before it is mirrored) (ball, contact) [rad]. At most π/2 in size; 0 for
            a ball at the groove centre.
        contact_pressure: Hertz peak pressure (ball, contact) [Pa].
        semi_axes: Semi-axes of the contact ellipse, in rolling direction and across
            (ball, contact, 2) [m].
        approach: Approach of ball and raceway, negative where apart (ball, contact)
            [m]. Beyond the groove centre it stays at its lowest value.
        shoulder_margin: Height of the shoulder above the end of the contact ellipse
            (ball, contact) [m]; negative: the ellipse is truncated. Infinite where no
            shoulder is given or no load carried.
        kinematics: Orbit, rotation and spin, leading axis ball; `None` without speed.
        gyroscopic_moment: Gyroscopic moment of each ball (ball,) [N m], zero where it
            is left out; `None` without speed.
        centrifugal_force: Centrifugal force of each ball (ball,) [N], likewise.
    """

    contact_load: Float[Array, "element contact"] = eqx.field(metadata=unit("N"))
    contact_angle: Float[Array, "element contact"] = eqx.field(metadata=unit("rad"))
    contact_pressure: Float[Array, "element contact"] = eqx.field(metadata=unit("Pa"))
    semi_axes: Float[Array, "element contact half_axis=2"] = eqx.field(
        metadata=unit("m")
    )
    approach: Float[Array, "element contact"] = eqx.field(metadata=unit("m"))
    shoulder_margin: Float[Array, "element contact"] = eqx.field(metadata=unit("m"))
    kinematics: BallKinematics | None
    gyroscopic_moment: Float[Array, " element"] | None = eqx.field(metadata=unit("N m"))
    centrifugal_force: Float[Array, " element"] | None = eqx.field(metadata=unit("N"))

    @property
    def n_contacts(self) -> Int[Array | np.ndarray, "*case ball"]:
        """Number of contacts of each ball that carry load above round-off."""
        return above_round_off(self.contact_load).sum(axis=-1)

    @property
    def lifted(self) -> Array | np.ndarray:
        """Whether each ball runs on the outer raceway only, off the inner one."""
        carrying = above_round_off(self.contact_load)
        half = carrying.shape[-1] // 2
        outer, inner = carrying[..., :half], carrying[..., half:]
        return outer.any(axis=-1) & ~inner.any(axis=-1)


def above_round_off(load: Any) -> Any:
    """Whether each load is above the round-off of the largest one of its bearing.

    Args:
        load: (..., element, contact) [N], of NumPy or of JAX; each case is a bearing.
    """
    return load > 1e-9 * load.max(axis=(-2, -1), keepdims=True)


def ball_results(
    rows: tuple[RowResults, ...],
    bearings: Sequence[AbstractBallBearing],
    law: AbstractPointLaw,
) -> dict:
    """Fields of `BallResults`, `roller_load` and `roller_pressure`, of solved rows."""
    contacts = max(row.contact_load.shape[1] for row in rows)
    parts = [
        _row_results(row, bearing, law, contacts)
        for row, bearing in zip(rows, bearings, strict=True)
    ]
    return jax.tree.map(lambda *values: jnp.concatenate(values), *parts)


def _per_arc(values, contacts):
    """Values of a row with one arc per ring in the shape of rows with two."""
    if values.shape[1] == contacts:
        return values
    shape = (values.shape[0], contacts, *values.shape[2:])
    return jnp.zeros(shape, values.dtype).at[:, jnp.array([0, 2])].set(values)


def _row_results(
    row: RowResults, bearing: AbstractBallBearing, law, contacts: int
) -> dict:
    """Ball results of one row, with room for `contacts` contacts per ball."""
    ball = row.element
    touching = row.map(lambda ball, *at: ball.contacts(*at))
    outwards = jnp.asarray(ball.grooves.outwards)
    vectors = outwards[None, :, None] * touching.normal
    load = row.contact_load
    balls = balls_of(bearing)
    cosine = law.cosine(bearing.free_cosine, vectors[..., 1].T)
    if bearing.ball_deviation is not None:
        diameters = balls.diameter + bearing.ball_deviation
        balls = balls._replace(diameter=diameters[None, :])
    ellipses = ball_ellipses(balls, bearing.grooves, cosine)
    axes = jnp.stack(ellipses.semi_axes(load.T), axis=-1).swapaxes(0, 1)
    # With two arcs the load of a raceway is the resultant of both.
    forces = load[..., None] * vectors
    half = load.shape[1] // 2
    pair = forces.reshape(load.shape[0], 2, half, 2).sum(axis=2)
    square = jnp.sum(pair**2, axis=-1)
    loaded = square > 0
    sides = jnp.where(loaded, jnp.sqrt(jnp.where(loaded, square, 1.0)), 0.0)
    pressure = ellipses.peak_pressure(load.T).T
    kinematics = moment = force = None
    if ball.ball_inertia is not None:
        kinematics = row.map(lambda ball, *at: ball.ball_kinematics(*at))
        inertia = ball.ball_inertia
        moment = gyroscopic_moment(inertia.moment, kinematics)
        force = row.map(lambda ball, *at: ball.inertia(*at)[1])
        if not inertia.control.has_moment:
            moment = jnp.zeros_like(moment)
    by_contact = {
        "contact_load": load,
        "contact_angle": angles(vectors),
        "contact_pressure": pressure,
        "semi_axes": axes,
        "approach": touching.approach,
        "shoulder_margin": _margins(bearing, vectors, axes, load),
    }
    return {
        **{name: _per_arc(values, contacts) for name, values in by_contact.items()},
        "roller_load": sides,
        "roller_pressure": jnp.max(pressure.reshape(-1, 2, half), axis=2),
        "kinematics": kinematics,
        "gyroscopic_moment": moment,
        "centrifugal_force": force,
    }


def _margins(bearing, vectors, axes, load):
    """Shoulder height less the height of the far end of the ellipse [m].

    The ellipse is laid along the arc of the groove; heights are measured from the
    deepest point of the raceway.
    """
    margins = []
    for k, groove in enumerate(bearing.grooves):
        name = "outer_shoulder" if groove.on_outer else "inner_shoulder"
        shoulder = getattr(bearing, name)
        if shoulder is None:
            margins.append(jnp.full(load.shape[:1], jnp.inf))
            continue
        angle = angles(vectors[:, k]) - bearing.groove_axis
        end = jnp.abs(angle) + axes[:, k, 1] / groove.radius
        height = groove.radius * (groove.deepest - jnp.cos(end))
        margins.append(jnp.where(load[:, k] > 0, shoulder - height, jnp.inf))
    return jnp.stack(margins, axis=1)

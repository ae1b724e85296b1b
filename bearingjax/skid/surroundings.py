"""Surroundings of balls and rollers: drag of the oil, and the cage."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from ..design.checks import check_fields
from ..numerics.power import smooth_power
from ..numerics.types import Real, Scalar
from ..numerics.units import real

_REST = 1e-3
"""Speed below which drag is quadratic [m/s]."""


class Drag(eqx.Module):
    """Drag of balls and rollers in a mixture of oil and air.

    1/8 ρ c_v A (d_m ω_c)^1.95 in SI units, against the orbit; ρ is the fill times the
    density of the oil, A the frontal area: π D²/4 of a ball, D L of a roller. The
    exponent is an empirical reduction of the square, so that the formula holds for m/s
    alone.

    Attributes:
        coefficient: Drag coefficient c_v [1].
        fill: Share of oil in the space between the rings [1].

    Traced: all fields.
    Source: Harris & Kotzalas, Advanced Concepts of Bearing Technology.
    """

    coefficient: Real = eqx.field(
        **real("1", "drag coefficient of a ball or roller", least=0), default=2.0
    )
    fill: Real = eqx.field(
        **real("1", "share of oil in the space between the rings", least=0, most=1),
        default=0.1,
    )

    def __check_init__(self):
        check_fields(self)

    def force(
        self, orbit: Scalar, area: Scalar, pitch_radius: Scalar, density: Scalar
    ) -> Scalar:
        """Return the force on a ball or roller, in the sense of angles [N].

        Args:
            orbit: Orbital speed [rad/s].
            area: Frontal area [m²].
            pitch_radius: Radius of the orbit [m].
            density: Density of the oil [kg/m³].
        """
        speed = 2.0 * pitch_radius * orbit
        mixture = self.fill * density * self.coefficient
        size = 0.125 * mixture * area * smooth_power(speed, 1.95, _REST)
        return -jnp.sign(speed) * size


class Cage(eqx.Module):
    """Rigid cage guided by the balls or rollers through pocket contact.

    It turns, and that is all its motion. One whose centre moves too, in the clearance
    of a land, is `noise.GuidedCage`: the two share a clearance and an inertia, but
    neither freedoms nor the law of the pockets.

    Attributes:
        pocket_clearance: Play of a ball or roller in its pocket along the orbit, from
            front to rear [m].
        stiffness: Stiffness of a pocket against the rolling element [N/m].
        inertia: Moment of inertia about the bearing axis [kg m²].

    Traced: all fields.
    """

    about: ClassVar[str] = "the cage of balls or rollers that skid"
    pocket_clearance: Real = eqx.field(
        **real("m", "play of a rolling element in its pocket along the orbit", least=0),
        default=2e-4,
    )
    stiffness: Real = eqx.field(
        **real("N/m", "stiffness of a pocket against the rolling element", above=0),
        default=1e6,
    )
    inertia: Real = eqx.field(
        **real("kg m²", "moment of inertia about the bearing axis", above=0),
        default=2.5e-5,
    )

    def __check_init__(self):
        check_fields(self)

    def force(self, lag: Scalar) -> Scalar:
        """Return the force on a ball or roller, in the sense of angles [N].

        Args:
            lag: Lead of its pocket over it, along the orbit [m].
        """
        play = 0.5 * self.pocket_clearance
        return self.stiffness * (
            jnp.maximum(lag - play, 0.0) - jnp.maximum(-lag - play, 0.0)
        )

"""Forces of a preloaded angular contact ball bearing, from one potential.

The outer ring is held, the inner one moves by x, y and z from the preloaded position.
A law is a strain energy; its gradient is the force. It falls short of a
`BearingElement` (no tilts, no inertia of balls), and costs a fraction of it.

Source: Filipkovskii & Belomyttsev (2014), eqs. (1), (2).
"""

import abc
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...contact.hertz import ellipse
from ...design import AbstractBallBearing, Material, contact_modulus
from ...design.checks import is_traced, positive
from ...element import FREEDOMS, BearingElement
from ...numerics.power import positive_power
from ...numerics.types import Real, Scalar, as_count, as_real
from ...numerics.units import real, unit


class AbstractSupportLaw(eqx.Module):
    """Strain energy of a bearing as a function of the motion of its inner ring."""

    @abc.abstractmethod
    def potential(self, motion: Float[Array, "3"]) -> Scalar:
        """Strain energy [J].

        Args:
            motion: x, y, z from the preloaded position [m]; +z adds to the preload.
        """

    def force(self, motion: Float[Array, "3"]) -> Float[Array, "3"]:
        """Gradient of the energy: P_x, P_y, P_z [N]."""
        return jax.grad(self.potential)(motion)

    @eqx.filter_jit
    def stiffness(self) -> Float[Array, "3 3"]:
        """Stiffness in the preloaded position [N/m]."""
        return jax.hessian(self.potential)(jnp.zeros(3))


def _directions(count: int):
    """Return cosines and sines of the azimuths of the balls."""
    azimuth = 2.0 * np.pi * np.arange(count) / count
    return np.cos(azimuth), np.sin(azimuth)


def _hertz_energy(constant, approach):
    """Return the energy of Hertz contacts [J]."""
    return 0.4 * constant * jnp.sum(positive_power(approach, 5, 2))


class _Preloaded(NamedTuple):
    """Balls of an axially preloaded bearing.

    Attributes:
        constant: Load of a ball over the 3/2 power of its approach [N/m^(3/2)].
        angle: Contact angle [rad].
        approach: Approach of a ball, both raceways together [m].
    """

    constant: Annotated[Scalar, unit("N/m^(3/2)")]
    angle: Annotated[Scalar, unit("rad")]
    approach: Annotated[Scalar, unit("m")]


def _preload(element: BearingElement, offset: Any) -> _Preloaded:
    bearing, offset = element.bearing, as_real(offset)
    if not isinstance(bearing, AbstractBallBearing) or len(bearing.grooves) != 2:
        raise TypeError(
            f"`element` holds a {type(bearing).__name__}; it must hold one row of balls"
            " with one groove in each ring"
        )
    outer, inner = bearing.grooves
    # From the groove centre of the outer ring to that of the inner one.
    radial = inner.radial - outer.radial
    axial = inner.axial - outer.axial + offset
    approach = jnp.hypot(radial, axial) - bearing.centre_distance
    bears = (approach > 0.0) & (axial > 0.0)
    if not is_traced(bears) and not bool(bears):
        raise ValueError(
            f"`offset` is {float(offset):g} m; it must be so large that the balls bear"
        )
    angle = jnp.arctan2(axial, radial)
    pushed = jnp.zeros(2 * len(FREEDOMS), approach.dtype)
    held = element.force(pushed.at[len(FREEDOMS) + 2].set(offset))[len(FREEDOMS) + 2]
    each = held / (bearing.n_balls * jnp.sin(angle))
    return _Preloaded(each / positive_power(approach, 3, 2), angle, approach)


def _count(bearing) -> int:
    """Return its number of balls, which is the length of arrays of a law."""
    return int(bearing.n_elements)


class FixedAngle(AbstractSupportLaw):
    """Law with a fixed contact angle of every ball.

    Attributes:
        constant: K of both raceways in series [N/m^(3/2)].
        contact_angle: α [rad].
        preload_displacement: z0; the approach under preload is z0·sin α [m].
        n_balls: Number of balls.

    Traced: all but `n_balls`.
    """

    constant: Real = eqx.field(**real("N/m^(3/2)"))
    contact_angle: Real = eqx.field(**real("rad"))
    preload_displacement: Real = eqx.field(**real("m"))
    n_balls: int = eqx.field(static=True, converter=as_count)

    def __check_init__(self):
        positive(self, "constant")
        positive(self, "contact_angle")

    @classmethod
    def of_bearing(cls, element: BearingElement, offset: Any) -> "FixedAngle":
        """Create the law of a ball bearing at its preloaded contact angle.

        Under the preload alone force and contact angle are those of the bearing.

        Args:
            element: The bearing, one row of balls; ball 0 is taken to stand at +x.
            offset: Axial displacement of its inner ring under the preload, as in
                `preload_offset` [m].
        """
        constant, angle, approach = _preload(element, offset)
        return cls(constant, angle, approach / jnp.sin(angle), _count(element.bearing))

    def potential(self, motion: Float[Array, "3"]) -> Scalar:
        x, y, z = motion
        cosine, sine = jnp.cos(self.contact_angle), jnp.sin(self.contact_angle)
        radial = sum(
            a * jnp.asarray(b)
            for a, b in zip((x, y), _directions(self.n_balls), strict=True)
        )
        axial = z + self.preload_displacement
        return _hertz_energy(self.constant, radial * cosine + axial * sine)

    @eqx.filter_jit
    def preload(self) -> Scalar:
        """Axial preload P0 [N]."""
        return self.force(jnp.zeros(3))[2]


class MovingAngle(AbstractSupportLaw):
    """Law with the contact angle along the line of groove centres of every ball.

    Attributes:
        constant: K of both raceways in series [N/m^(3/2)].
        contact_angle: Under preload [rad].
        preload_approach: Approach of a ball under preload, both raceways [m].
        centre_distance: Distance of the groove centres without load [m].
        n_balls: Number of balls.

    Traced: all but `n_balls`.
    """

    constant: Real = eqx.field(**real("N/m^(3/2)"))
    contact_angle: Real = eqx.field(**real("rad"))
    preload_approach: Real = eqx.field(**real("m"))
    centre_distance: Real = eqx.field(**real("m"))
    n_balls: int = eqx.field(static=True, converter=as_count)

    @classmethod
    def of_bearing(cls, element: BearingElement, offset: Any) -> "MovingAngle":
        """The law of a ball bearing; arguments as in `FixedAngle.of_bearing`."""
        constant, angle, approach = _preload(element, offset)
        bearing = element.bearing
        distance = bearing.centre_distance
        return cls(constant, angle, approach, distance, _count(bearing))

    def potential(self, motion: Float[Array, "3"]) -> Scalar:
        x, y, z = motion
        apart = self.centre_distance + self.preload_approach
        radial = sum(
            a * jnp.asarray(b)
            for a, b in zip((x, y), _directions(self.n_balls), strict=True)
        )
        radial = radial + apart * jnp.cos(self.contact_angle)
        axial = z + apart * jnp.sin(self.contact_angle)
        length = jnp.sqrt(radial**2 + axial**2)
        return _hertz_energy(self.constant, length - self.centre_distance)


class CubicExpansion(AbstractSupportLaw):
    """Expansion of `FixedAngle` to third order in the motion, five balls or more.

    Within 1e-2 of it up to the motion at which the first ball lifts off.

    Attributes:
        radial_stiffness: c_r [N/m].
        contact_angle: α [rad].
        preload_displacement: z0 [m].

    Traced: all fields.
    """

    radial_stiffness: Real = eqx.field(**real("N/m"))
    contact_angle: Real = eqx.field(**real("rad"))
    preload_displacement: Real = eqx.field(**real("m"))

    @classmethod
    def from_law(cls, law: FixedAngle) -> "CubicExpansion":
        """Create the expansion of a law with five balls or more."""
        if law.n_balls < 5:
            raise ValueError(
                f"`n_balls` is {law.n_balls}; the expansion needs 5 or more, with fewer"
                " its terms depend on where the balls stand"
            )
        angle, z0 = law.contact_angle, law.preload_displacement
        root = positive_power(z0 * jnp.sin(angle), 1, 2)
        radial = 0.75 * law.n_balls * law.constant * root * jnp.cos(angle) ** 2
        return cls(radial, angle, z0)

    @classmethod
    def of_bearing(cls, element: BearingElement, offset: Any) -> "CubicExpansion":
        """Create the law of a ball bearing; arguments as in `FixedAngle.of_bearing`."""
        return cls.from_law(FixedAngle.of_bearing(element, offset))

    def potential(self, motion: Float[Array, "3"]) -> Scalar:
        x, y, z = motion
        square, z0 = x**2 + y**2, self.preload_displacement
        tangent2 = jnp.tan(self.contact_angle) ** 2
        axial = 2.0 * tangent2
        # P0 = (2/3) c_a z0.
        terms = (
            axial * (2.0 / 3.0 * z0 * z + z**2 / 2.0)
            + axial * (z**3 / (12.0 * z0) - z**4 / (96.0 * z0**2))
            + square * (0.5 + z / (4.0 * z0) - z**2 / (16.0 * z0**2))
            - square**2 / (128.0 * z0**2 * tangent2)
        )
        return self.radial_stiffness * terms


class Grooves(eqx.Module):
    """Groove geometry of an angular contact ball bearing, and preloaded angle.

    Attributes:
        inner_radius: Radius of the bottom of the inner groove, R1 [m].
        outer_radius: Radius of the bottom of the outer groove, R2 [m].
        groove_radius: Radius of curvature of both grooves, R_K [m].
        ball_diameter: d_B [m].
        contact_angle: α under preload [rad].
        n_balls: Number of balls.
        material: Material of balls and rings.

    Traced: all but `n_balls`.
    """

    inner_radius: Real = eqx.field(**real("m"))
    outer_radius: Real = eqx.field(**real("m"))
    groove_radius: Real = eqx.field(**real("m"))
    ball_diameter: Real = eqx.field(**real("m"))
    contact_angle: Real = eqx.field(**real("rad"))
    n_balls: int = eqx.field(static=True, converter=as_count)
    material: Material

    @eqx.filter_jit
    def raceway_constants(self) -> Float[Array, "2"]:
        """K_i of the inner and outer contact of a ball [N/m^(3/2)]."""
        cosine = jnp.cos(self.contact_angle)
        drop = self.groove_radius * (1.0 - cosine)
        of_ball = 2.0 / self.ball_diameter
        inner = of_ball + cosine / (self.inner_radius + drop)
        outer = of_ball - cosine / (self.outer_radius - drop)
        rolling = jnp.stack([inner, outer])
        across = jnp.broadcast_to(of_ball - 1.0 / self.groove_radius, rolling.shape)
        modulus = contact_modulus(self.material, self.material)
        return ellipse(rolling, across, modulus).constant

    @property
    def constant(self) -> Scalar:
        """K of both contacts in series [N/m^(3/2)]."""
        softness = jnp.sum(positive_power(self.raceway_constants(), -2, 3))
        return positive_power(softness, -3, 2)

    @property
    def centre_distance(self) -> Scalar:
        """Distance of the groove centres without load [m]."""
        return 2.0 * self.groove_radius - self.ball_diameter

    @property
    def approach(self) -> Scalar:
        """Approach w of a ball under the preload that follows from its angle [m]."""
        radial = self.inner_radius + 2.0 * self.groove_radius - self.outer_radius
        return radial / jnp.cos(self.contact_angle) - self.centre_distance

    def fixed_angle(self) -> FixedAngle:
        """Return the law of fixed contact angle."""
        z0 = self.approach / jnp.sin(self.contact_angle)
        return FixedAngle(self.constant, self.contact_angle, z0, self.n_balls)

    def moving_angle(self) -> MovingAngle:
        """Return the law of groove centres."""
        return MovingAngle(
            self.constant,
            self.contact_angle,
            self.approach,
            self.centre_distance,
            self.n_balls,
        )

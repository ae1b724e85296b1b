"""Kinematics: maps from rigid motions to coordinates of the contacts, by class.

A class implements rollers, balls, or both. Elements not implemented are rejected.
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from ..design.bearing_set import SetRow
from .balls.ball_geometry import AbstractBallGeometry, FiniteBall, LinearisedBall
from .constants import ContactConstants
from .roller_geometry import AbstractRollerGeometry, FiniteRoller, LinearisedRoller


class AbstractKinematics(eqx.Module):
    """Map from rigid motions to coordinates of the contacts."""

    def roller(self, constants: ContactConstants) -> AbstractRollerGeometry:
        """Geometry of one roller; once per design.

        Args:
            constants: Its contact constants.
        """
        raise NotImplementedError

    def ball(self, part: SetRow) -> AbstractBallGeometry:
        """Geometry of the balls of a row.

        Args:
            part: The row, of balls, and its place.
        """
        raise NotImplementedError

    @property
    def turns_far(self) -> bool:
        """Whether rings may turn by any angle. Static."""
        return False

    @property
    def keeps_arcs(self) -> bool:
        """Whether arcs of raceways keep their shape when they move. Static."""
        return False

    @property
    def holds_angles(self) -> bool:
        """Whether balls keep their free contact angle. Static."""
        return False

    def check(self, elements: str) -> None:
        """Raise unless the class implements a kind of rolling element.

        Args:
            elements: "roller" or "ball".

        Raises:
            ValueError: If it does not.
        """
        if getattr(type(self), elements) is getattr(AbstractKinematics, elements):
            name = type(self).__name__
            raise ValueError(
                f"BearingElement: `kinematics` is {name}(), which does not say how"
                f" {elements}s move: it has no method `{elements}`."
            )


class Linearised(AbstractKinematics):
    """Small rotations: gaps are affine and the energy is convex. The default.

    Forces depend only on the motion of the rings against each other and against the
    rolling element.

    Valid: tilts well below roller diameter / roller length.
    Source: `Finite` to first order.
    """

    def roller(self, constants: ContactConstants) -> AbstractRollerGeometry:
        return LinearisedRoller.from_constants(constants)

    def ball(self, part: SetRow) -> AbstractBallGeometry:
        bearing: Any = part.bearing
        dtype = bearing.pitch_diameter.dtype
        sides = [0.5 if g.on_outer else -0.5 for g in bearing.grooves]
        tilted = [
            jnp.zeros((2,), dtype) if g.on_outer else jnp.stack([-g.radial, g.axial])
            for g in bearing.grooves
        ]
        radius = 0.5 * bearing.pitch_diameter
        return LinearisedBall(
            tilted=jnp.stack(tilted),
            sides=jnp.asarray(sides, dtype),
            pitch_radius=radius,
        )


class ConstantAngle(Linearised):
    """Contacts of balls keep their free contact angle. For balls at rest.

    For comparison with catalogues and with reduced models, which take a contact angle
    that no load changes; errs where loads are high or angles small. For angular
    contact and thrust bearings. Contacts of rollers keep their normals anyway: for them
    it is `Linearised`. A turning ball has no equilibrium, because it is not restrained
    along its raceways: no `speed`. All normals of a row meet in one point of the axis,
    its pressure centre: a single row resists no tilt about it, so prescribe gx and gy,
    or take a set.
    """

    @property
    def holds_angles(self) -> bool:
        return True


class Finite(AbstractKinematics):
    """Finite rotations: of ball bearings by any angle, of rollers in the section.

    For rollers formula (3) of the paper, normals undeformed, to compare with it; for
    barrel rollers the distances to arcs that keep their shape: raceways that are tilted
    against each other then push a roller out of the wedge between them. The energy is
    not convex (tilting an upright roller shortens its projection) and the moments of
    the rings balance only to first order; a solve may end in a saddle and then says so.

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (3).
    """

    @property
    def turns_far(self) -> bool:
        return True

    @property
    def keeps_arcs(self) -> bool:
        return True

    def roller(self, constants: ContactConstants) -> AbstractRollerGeometry:
        return FiniteRoller.from_constants(constants)

    def ball(self, part: SetRow) -> AbstractBallGeometry:
        bearing: Any = part.bearing
        sign = -1.0 if part.mirrored else 1.0
        along = bearing.axial_place + sign * part.position
        radius = 0.5 * bearing.pitch_diameter
        arcs = len(bearing.grooves) // 2
        return FiniteBall(
            along=along,
            inner_offset=sign * part.inner_offset,
            pitch_radius=radius,
            n_arcs=arcs,
        )

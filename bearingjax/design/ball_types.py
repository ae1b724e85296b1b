"""The types of ball bearings: what each adds to `AbstractBallBearing`."""

import dataclasses
import math
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from ..numerics.types import (
    Number,
    Real,
    RealOrNone,
    Scalar,
    array_namespace,
    as_real,
    in_numpy,
)
from ..numerics.units import real
from .abstract import AbstractBearing
from .ball import AbstractBallBearing, Groove
from .checks import check, check_fields, floats, in_range, number


class DeepGrooveBallBearing(AbstractBallBearing):
    """Deep groove ball bearing: one full groove per ring, axial load both ways.

    At zero displacement the rings are centred, axially too: with clearance no ball
    touches. Attributes are those of `AbstractBallBearing`, and one of
        radial_internal_clearance: Diametral play; negative is preload [m].
        contact_angle: Free contact angle, from 0 to below π/2 [rad].
    Neither: no clearance.

    Traced: all fields but `n_balls`.
    """

    about: ClassVar[str] = "one full groove per ring, axial load both ways"
    radial_internal_clearance: RealOrNone = eqx.field(
        **real("m", "diametral play; negative is preload"), default=None, kw_only=True
    )
    contact_angle: RealOrNone = eqx.field(
        **real(
            "rad",
            "free contact angle, in place of the clearance",
            least=0,
            below=0.5 * np.pi,
        ),
        default=None,
        kw_only=True,
    )

    @property
    def clearance(self) -> Scalar:
        if self.radial_internal_clearance is not None:
            return self.radial_internal_clearance
        if self.contact_angle is not None:
            return clearance_of(self.contact_angle, self.centre_distance)
        return jnp.zeros_like(self.pitch_diameter)

    @property
    def free_contact_angle(self) -> Scalar:
        if self.contact_angle is not None:
            return self.contact_angle
        return super().free_contact_angle

    @property
    def free_cosine(self) -> Scalar:
        cosine = 1.0 - 0.5 * self.clearance / self.centre_distance
        return array_namespace(cosine).minimum(1.0, cosine)

    @property
    def nominal_contact_angle(self) -> Scalar:
        return as_real(0.0)

    @property
    def touching_angle(self) -> Scalar:
        return jnp.zeros_like(self.pitch_diameter)

    def with_clearance(self, clearance: Scalar) -> Any:
        return dataclasses.replace(
            self, radial_internal_clearance=clearance, contact_angle=None
        )

    @property
    def raceway_diameters(self) -> tuple[Scalar, Scalar]:
        pitch, size = self.pitch_diameter, self.ball_diameter
        return pitch - size, pitch + size

    @property
    def grooves(self) -> tuple[Groove, ...]:
        outer, inner = self.centre_distances
        # Radially the groove centres are nearer by half of the diametral play.
        share = 1.0 - 0.5 * self.clearance / self.centre_distance
        zero, radius = jnp.zeros_like(outer), 0.5 * self.ball_diameter
        one = jnp.ones_like(outer)
        return (
            Groove(True, zero, -share * outer, outer + radius, False, one),
            Groove(False, zero, share * inner, inner + radius, False, one),
        )

    def __check_init__(self):
        clearance, angle = self.radial_internal_clearance, self.contact_angle
        if clearance is not None and angle is not None:
            raise ValueError(
                f"{type(self).__name__}: `radial_internal_clearance` and"
                " `contact_angle` are both given; one follows from the other."
            )
        check_fields(self)
        if clearance is None:
            return
        number(self, "radial_internal_clearance")
        numbers = floats(clearance, in_numpy(self).centre_distance)
        if numbers is not None:
            most = 2.0 * numbers[1]
            allowed = (
                f"below {most:.6g} m in size, where the groove centres meet (metres"
                " meant?)"
            )
            fits = abs(numbers[0]) < most
            check(self, "radial_internal_clearance", fits, allowed)


class AngularContactBallBearing(AbstractBallBearing):
    """Single-row angular contact ball bearing.

    At zero displacement the balls just touch, at the contact angle. Beyond the bottom
    of its groove each raceway goes on as a cylinder (the cut shoulder): the bearing
    carries axial load on one side only, an inner-ring load along +z.

    Attributes are those of `AbstractBallBearing`, and
        contact_angle: Free contact angle, above 0 and below π/2 [rad].
        rated_contact_angle: Nominal contact angle, which load ratings and equivalent
            loads refer to, if different, as for a mounted bearing [rad];
            `None`: the free one.

    Traced: all fields but `n_balls`.
    """

    about: ClassVar[str] = "single-row angular contact ball bearing"

    rated_fields = (*AbstractBallBearing.rated_fields, "contact_angle")

    contact_angle: Real = eqx.field(
        **real("rad", "free contact angle", above=0, below=0.5 * np.pi), kw_only=True
    )
    rated_contact_angle: RealOrNone = eqx.field(
        **real(
            "rad", "nominal contact angle of the load ratings", otherwise="the free one"
        ),
        default=None,
        kw_only=True,
    )

    @property
    def free_contact_angle(self) -> Scalar:
        return self.contact_angle

    @property
    def free_cosine(self) -> Scalar:
        return array_namespace(self.contact_angle).cos(self.contact_angle)

    @property
    def nominal_contact_angle(self) -> Scalar:
        return _nominal(self)

    @property
    def touching_angle(self) -> Scalar:
        return jnp.zeros_like(self.pitch_diameter)

    @property
    def clearance(self) -> Scalar:
        return clearance_of(self.contact_angle, self.centre_distance)

    def with_clearance(self, clearance: Scalar) -> Any:
        quarter = clearance / (4.0 * self.centre_distance)
        known = floats(clearance, quarter)
        if known is not None:
            allowed = (
                f"above 0 and below {0.5 * known[0] / known[1]:.6g} m"
                if known[1]
                else "above 0 m"
            )
            check(
                "with_radial_clearance",
                "clearance",
                0.0 < known[1] < 0.5,
                f"{allowed}: an angular contact bearing with less has no contact angle",
                clearance,
                "m",
            )
        angle = 2.0 * jnp.arcsin(jnp.sqrt(quarter))
        return dataclasses.replace(self, contact_angle=angle)

    def rated_as(self, drawing: "AbstractBearing") -> "AbstractBearing":
        return _rated_as(self, drawing)

    @property
    def is_one_sided(self) -> bool:
        return True

    @property
    def grooves(self) -> tuple[Groove, ...]:
        return _pair(self, self.free_contact_angle, open_side=True)

    def __check_init__(self):
        check_fields(self)
        _check_rated(self)


class DoubleRowBallRow(AngularContactBallBearing):
    """One row of a double-row angular contact ball bearing, such as a 3208 A.

    It bears an inner-ring load along +z, on the -z side of the middle, which is the
    origin. Its mirror image runs on the same two rings, back to back (O):
    `BearingSet.double_row` makes the bearing of both.

    Attributes are those of `AngularContactBallBearing`, and
        row_offset: Distance of the row from the middle of the bearing [m].

    Traced: all fields but `n_balls`.
    """

    about: ClassVar[str] = "both rows of angular contact balls in one pair of rings"
    is_paired: ClassVar[bool] = True

    row_offset: Real = eqx.field(
        **real("m", "distance of the row from the middle of the bearing", above=0),
        kw_only=True,
    )

    @property
    def axial_place(self) -> Scalar:
        return -self.row_offset


class ThrustBallBearing(AbstractBallBearing):
    """Single-direction thrust ball bearing, contact angle 90 degrees.

    The inner ring is the shaft washer, at -z of the balls. Attributes are those of
    `AbstractBallBearing`.

    Traced: all fields but `n_balls`.
    """

    about: ClassVar[str] = "thrust ball bearing of one direction, contact angle 90°"
    is_thrust: ClassVar[bool] = True

    @property
    def free_contact_angle(self) -> Scalar:
        return jnp.full_like(self.pitch_diameter, 0.5 * np.pi)

    @property
    def free_cosine(self) -> Scalar:
        return jnp.zeros_like(self.pitch_diameter)

    @property
    def clearance(self) -> Scalar:
        return 2.0 * self.centre_distance

    @property
    def groove_axis(self) -> Number:
        return 0.5 * np.pi

    @property
    def is_one_sided(self) -> bool:
        return True

    @property
    def grooves(self) -> tuple[Groove, ...]:
        outer, inner = self.centre_distances
        zero, radius = jnp.zeros_like(outer), 0.5 * self.ball_diameter
        one = jnp.ones_like(outer)
        return (
            Groove(True, -outer, zero, outer + radius, True, one),
            Groove(False, inner, zero, inner + radius, True, one),
        )


class FourPointBallBearing(AbstractBallBearing):
    """Four-point contact ball bearing: each raceway is two arcs (a split ring).

    The arcs are ground as one groove with a shim between the halves; without it a
    ball rests on both arcs of a ring, at plus and minus the shim angle.

    Attributes are those of `AbstractBallBearing`, and
        shim_angle: Angle at which a ball rests in the arcs of one ring [rad].
        radial_internal_clearance: Diametral play; negative is preload [m].
        rated_contact_angle: As in `AngularContactBallBearing` [rad].

    Traced: all fields but `n_balls`.
    """

    about: ClassVar[str] = "each raceway is two arcs, of a split ring"
    rated_rows: ClassVar[int] = 2
    rated_fields = (*AbstractBallBearing.rated_fields, "shim_angle")

    shim_angle: Real = eqx.field(
        **real(
            "rad",
            "angle at which a ball rests in the arcs of one ring",
            above=0,
            below=0.5 * np.pi,
        ),
        kw_only=True,
    )
    radial_internal_clearance: Real = eqx.field(
        **real("m", "diametral play; negative is preload"), default=0.0, kw_only=True
    )
    rated_contact_angle: RealOrNone = eqx.field(
        **real(
            "rad", "nominal contact angle of the load ratings", otherwise="the free one"
        ),
        default=None,
        kw_only=True,
    )

    @property
    def clearance(self) -> Scalar:
        return self.radial_internal_clearance

    @property
    def nominal_contact_angle(self) -> Scalar:
        return _nominal(self)

    def rated_as(self, drawing: "AbstractBearing") -> "AbstractBearing":
        return _rated_as(self, drawing)

    @property
    def free_cosine(self) -> Scalar:
        play = 0.5 * self.clearance / self.centre_distance
        cosine = array_namespace(self.shim_angle).cos(self.shim_angle) - play
        return array_namespace(cosine).minimum(1.0, cosine)

    @property
    def grooves(self) -> tuple[Groove, ...]:
        outer, inner = self.centre_distances
        half = 0.25 * self.clearance
        sine, cosine = jnp.sin(self.shim_angle), jnp.cos(self.shim_angle)
        radius = 0.5 * self.ball_diameter
        out = []
        for on_outer, distance in ((True, outer), (False, inner)):
            sign = -1.0 if on_outer else 1.0
            # First the arc that carries with a positive contact angle.
            for side in (sign, -sign):
                out.append(
                    Groove(
                        on_outer,
                        side * distance * sine,
                        sign * (distance * cosine - half),
                        distance + radius,
                        False,
                        jnp.cos(jnp.arcsin(distance * sine / (distance + radius))),
                    )
                )
        return tuple(out)

    def __check_init__(self):
        check_fields(self)
        _check_rated(self)
        clearance = self.radial_internal_clearance
        number(self, "radial_internal_clearance")
        distance = in_numpy(self).centre_distance
        numbers = floats(clearance, distance, self.shim_angle)
        if numbers is not None:
            most = 2.0 * numbers[1] * math.cos(numbers[2])
            allowed = (
                f"below {most:.6g} m in size, where the groove centres meet (metres"
                " meant?)"
            )
            fits = abs(numbers[0]) < most
            check(self, "radial_internal_clearance", fits, allowed)


class SelfAligningBallRow(AbstractBallBearing):
    """One row of a self-aligning ball bearing: its outer raceway is a sphere.

    The centre of the sphere is the origin of the bearing, on the axis, so that the
    rings tilt freely about it. `BearingSet.self_aligning` makes the bearing of two
    such rows. At zero displacement the rings are centred, with half of the play at
    each raceway.

    Attributes are those of `AbstractBallBearing` without `outer_osculation`, which
    follows from the sphere, and
        row_offset: z of the row from the middle of the bearing [m].
        radial_internal_clearance: Diametral play; negative is preload [m].

    Traced: all fields but `n_balls`.
    """

    about: ClassVar[str] = "both rows of balls in an outer raceway that is a sphere"
    aligns: ClassVar[bool] = True
    rated_fields = (*AbstractBallBearing.rated_fields, "row_offset")

    row_offset: Real = eqx.field(
        **real("m", "z of the row from the middle of the bearing", above=0),
        kw_only=True,
    )
    radial_internal_clearance: Real = eqx.field(
        **real("m", "diametral play; negative is preload"), default=0.0, kw_only=True
    )

    @property
    def free_contact_angle(self) -> Scalar:
        across = 0.5 * self.pitch_diameter
        return array_namespace(across, self.row_offset).arctan2(self.row_offset, across)

    @property
    def free_cosine(self) -> Scalar:
        angle = self.free_contact_angle
        return array_namespace(angle).cos(angle)

    @property
    def groove_axis(self) -> Number:
        return self.free_contact_angle

    @property
    def clearance(self) -> Scalar:
        return self.radial_internal_clearance

    @property
    def centre_distances(self) -> tuple[Scalar, Scalar]:
        gap = 0.25 * self.clearance * self.free_cosine
        square = 0.25 * self.pitch_diameter**2 + self.row_offset**2
        outer = array_namespace(square).sqrt(square)
        return outer + gap, (self.inner_osculation - 0.5) * self.ball_diameter

    @property
    def play(self) -> Scalar:
        # The gap along the contact angle gives axial play over its sine, radial play
        # over its cosine.
        longer = jnp.maximum(1.0, 0.5 * self.pitch_diameter / self.row_offset)
        return 0.5 * self.clearance * longer

    @property
    def axial_place(self) -> Scalar:
        return self.row_offset

    @property
    def grooves(self) -> tuple[Groove, ...]:
        outer, inner = self.centre_distances
        gap = 0.25 * self.clearance * self.free_cosine
        near = inner - gap
        sine, cosine = jnp.sin(self.free_contact_angle), self.free_cosine
        radius, pitch = 0.5 * self.ball_diameter, 0.5 * self.pitch_diameter
        one = jnp.ones_like(inner)
        return (
            Groove(True, -self.row_offset, -pitch, outer + radius, False, one),
            Groove(False, near * sine, near * cosine, inner + radius, False, one),
        )

    def __check_init__(self):
        check_fields(self)
        clearance = self.radial_internal_clearance
        number(self, "radial_internal_clearance")
        own = in_numpy(self)
        numbers = floats(clearance, own.centre_distances[1], own.free_cosine)
        if numbers is not None:
            most = 4.0 * numbers[1] / numbers[2]
            allowed = (
                f"below {most:.6g} m in size, where the inner groove centre meets the"
                " ball (metres meant?)"
            )
            fits = abs(numbers[0]) < most
            check(self, "radial_internal_clearance", fits, allowed)

    def _check_groove(self, ring):
        if ring == "inner":
            super()._check_groove(ring)
            return
        for name in ("outer_osculation", "outer_shoulder"):
            if getattr(self, name) is not None:
                raise ValueError(
                    f"{type(self).__name__}: `{name}` is given, but the outer raceway"
                    " is a sphere about the middle of the bearing."
                )


def clearance_of(contact_angle: Scalar, centre_distance: Scalar) -> Scalar:
    """Radial internal clearance of a free contact angle, s = 2A (1 - cos α0) [m].

    Args:
        contact_angle: Free contact angle α0 [rad].
        centre_distance: Distance A of the groove centres [m].

    Source: Harris, Rolling Bearing Analysis, geometry of ball bearings.
    """
    xp = array_namespace(contact_angle)
    return 4.0 * centre_distance * xp.sin(0.5 * contact_angle) ** 2


def _nominal(bearing):
    rated = bearing.rated_contact_angle
    return bearing.free_contact_angle if rated is None else rated


def _rated_as(bearing, drawing):
    return dataclasses.replace(
        bearing, rated_contact_angle=drawing.nominal_contact_angle
    )


def _check_rated(bearing):
    if bearing.rated_contact_angle is not None:
        in_range(bearing, "rated_contact_angle", 0.0, 0.5 * np.pi, include_low=True)


def _pair(bearing, angle, open_side):
    outer, inner = bearing.centre_distances
    sine, cosine = jnp.sin(angle), jnp.cos(angle)
    radius = 0.5 * bearing.ball_diameter
    one = jnp.ones_like(outer)
    return (
        Groove(True, -outer * sine, -outer * cosine, outer + radius, open_side, one),
        Groove(False, inner * sine, inner * cosine, inner + radius, open_side, one),
    )

"""Bearings of barrel rollers, thrust rollers and crossed rollers."""

import math
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from ..numerics.types import Number, Real, RealOrNone, Scalar
from ..numerics.units import real
from .bearing import AbstractRollerBearing, TaperedRollerBearing
from .checks import check, check_fields, floats, in_range, is_traced, number, positive
from .profile import sagitta

_FAR = 0.01
"""Distance of the centre of the outer sphere from the axis, over its radius, above
which the drawing contradicts itself."""


class AbstractBarrelBearing(AbstractRollerBearing):
    """Single row of barrel rollers between concave raceways: base class.

    `Finite` kinematics are the default, with independent slices and without measured
    profiles. The generators of roller and raceways are arcs that touch in the middle of
    the roller; `roller_profile` and the raceway profiles are measured from these arcs.

    Attributes are those of `AbstractRollerBearing`, and
        roller_profile_radius: Radius of the arc of the roller, R_r [m].
        outer_raceway_radius: Radius of the arc of the outer raceway, r_o [m].
        inner_raceway_radius: Radius of the arc of the inner raceway, r_i [m].

    The distance of the centres of both raceway arcs, r_o + r_i - D, takes the place of
    that of the groove centres of a ball bearing.
    """

    roller_profile_radius: Real = eqx.field(
        **real("m", "radius of the arc of the roller, R_r"), kw_only=True
    )
    outer_raceway_radius: RealOrNone = eqx.field(
        **real("m", "radius of the arc of the outer raceway, r_o"), kw_only=True
    )
    inner_raceway_radius: Real = eqx.field(
        **real("m", "radius of the arc of the inner raceway, r_i"), kw_only=True
    )

    @property
    def arc_radii(self) -> tuple[Scalar, Scalar, Scalar]:
        assert self.outer_raceway_radius is not None
        return (
            self.roller_profile_radius,
            self.outer_raceway_radius,
            self.inner_raceway_radius,
        )

    @property
    def gap(self) -> Scalar:
        return 0.25 * self.radial_internal_clearance * jnp.cos(self.axis_angle)

    def with_clearance(self, clearance: Scalar) -> Any:
        return eqx.tree_at(lambda b: b.radial_internal_clearance, self, clearance)

    @property
    def holds_axially(self) -> bool:
        return True

    def __check_init__(self):
        # Infinite radii are straight generators.
        for name in ("roller_profile_radius", "inner_raceway_radius"):
            _radius(self, name)
        # Before the radius of a sphere, which follows from it.
        check_fields(self)
        if self.outer_raceway_radius is not None:
            _radius(self, "outer_raceway_radius")
        elif not isinstance(self, _AbstractSphere):
            raise ValueError(
                f"{type(self).__name__}: `outer_raceway_radius` is None; it must be a"
                " number in m: only that of a sphere follows from other sizes."
            )
        numbers = floats(*self.arc_radii)
        if numbers is None:
            return
        for name, radius in zip(("outer", "inner"), numbers[1:], strict=True):
            allowed = (
                f"at least `roller_profile_radius`, {numbers[0]:.6g} m, or the roller"
                " would bear on its ends"
            )
            key = f"{name}_raceway_radius"
            check(self, key, radius >= numbers[0], allowed, radius, "m")

    def end_drop(self) -> float:
        numbers = floats(self.roller_profile_radius, self.roller_length)
        if numbers is None or not np.isfinite(numbers[0]):
            return 0.0
        # In Python's numbers: under `vmap` what JAX computes is traced, even of these.
        radius, half = numbers[0], 0.5 * numbers[1]
        return half * half / (radius + math.sqrt(radius * radius - half * half))


class _AbstractSphere(AbstractBarrelBearing):
    """Barrel rollers whose outer raceway is a sphere about a point of the axis.

    Attributes are those of `AbstractBarrelBearing`, and
        contact_angle: Contact angle of the outer raceway [rad].
        outer_raceway_radius: Radius of the sphere [m]; `None`: that about the axis.
    """

    rated_fields = (*AbstractRollerBearing.rated_fields, "contact_angle")

    contact_angle: Real = eqx.field(
        **real(
            "rad",
            "contact angle; of a thrust bearing that of its outer raceway",
            above=0,
            below=0.5 * np.pi,
        ),
        kw_only=True,
    )
    outer_raceway_radius: RealOrNone = eqx.field(
        **real(
            "m",
            "radius of the sphere of the outer raceway",
            otherwise="that about the axis",
        ),
        kw_only=True,
        default=None,
    )

    @property
    def axis_angle(self):
        return self.contact_angle - self.half_angle

    @property
    def sphere_radius(self) -> Scalar:
        """Radius of a sphere about the axis that leaves `gap` at the rollers [m]."""
        radial = 0.5 * (
            self.pitch_diameter + self.roller_diameter * jnp.cos(self.axis_angle)
        )
        return radial / jnp.cos(self.contact_angle) + self.gap

    @property
    def arc_radii(self):
        outer = self.outer_raceway_radius
        return (
            self.roller_profile_radius,
            self.sphere_radius if outer is None else outer,
            self.inner_raceway_radius,
        )

    @property
    def play(self):
        # The gap along the contact angle gives axial play over its sine, radial play
        # over its cosine.
        return (
            2.0
            * self.gap
            / jnp.minimum(jnp.sin(self.contact_angle), jnp.cos(self.contact_angle))
        )

    def __check_init__(self):
        if self.outer_raceway_radius is None:
            return
        numbers = floats(self.outer_raceway_radius, self.sphere_radius)
        if numbers is not None and np.isfinite(numbers[1]):
            allowed = (
                f"{numbers[1]:.6g} m to {100 * _FAR:g} %, which puts the centre of the"
                " sphere on the axis (the radius may be left out)"
            )
            near = abs(numbers[0] - numbers[1]) <= _FAR * numbers[1]
            check(self, "outer_raceway_radius", near, allowed)


class SphericalRollerRow(_AbstractSphere):
    """One row of a spherical roller bearing: its outer raceway is a sphere.

    The origin of the bearing is the point of the axis where the contact normals meet,
    the centre of the sphere, so that the rings tilt freely about it.
    `BearingSet.self_aligning` makes the bearing of two such rows. At zero displacement
    the rings are centred. Guide ring and cage bear what inertia pushes the rollers
    along their axes.

    Attributes are those of `AbstractBarrelBearing`, and
        contact_angle: Contact angle of the symmetric rollers, above 0 [rad].
        outer_raceway_radius: Radius of the sphere [m]; `None`: that about the origin.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "both rows of rollers in an outer raceway that is a sphere"
    aligns: ClassVar[bool] = True
    caged: ClassVar[bool] = True

    @property
    def axial_place(self) -> Scalar:
        return 0.5 * self.pitch_diameter * jnp.tan(self.contact_angle)


class ToroidalRollerBearing(AbstractBarrelBearing):
    """Toroidal roller bearing: long barrel rollers, raceways of large profile radius.

    Rings that are moved along the axis by s lose radial clearance by
    s²/(r_o + r_i - D), and nothing holds them axially but that, as `Finite` kinematics
    see it: `lost_clearance`, `free_travel`.

    Attributes are those of `AbstractBarrelBearing`.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "long barrel rollers, raceways of large profile radius"
    tilts_alone: ClassVar[bool] = True

    @property
    def _centres(self):
        """Distance of the centres of both arcs when rollers touch both raceways, and
        that of the inner one from the axis [m]."""
        _, outer, inner = self.arc_radii
        middle = 0.5 * (self.pitch_diameter - self.roller_diameter) - self.gap
        return outer + inner - self.roller_diameter, middle + inner

    def lost_clearance(self, travel: Number, tilt: Number = 0.0) -> Scalar:
        """Radial internal clearance that axial travel and tilt of the rings take [m].

        A tilt moves the arc of the inner raceway along the axis by its centre's
        distance from the axis times the tilt, at opposite rollers in opposite
        directions, and lowers it.

        Args:
            travel: Axial displacement of the rings against each other from where their
                raceways stand opposite [m].
            tilt: Tilt of ring against ring [rad].

        Returns:
            Diametral, in the plane of the tilt; below zero where the tilt gives more
            than it takes [m]. Differentiable.

        Source: two arcs whose centres are r_o + r_i - D apart. SKF prints
            k2 s²/B, where B/k2 is that distance, and for the axial displacement that a
            tilt α amounts to k1 B α, where k1 B is the distance from the axis.
        """
        apart, arm = self._centres
        aside = arm * jnp.sin(tilt)
        lowered = 2.0 * arm * jnp.sin(0.5 * tilt) ** 2
        taken = [sagitta(s, apart) - lowered for s in (travel + aside, travel - aside)]
        return taken[0] + taken[1]

    def free_travel(self, clearance: Number) -> Scalar:
        """Axial travel of untilted rings that takes a radial internal clearance [m].

        Args:
            clearance: Radial internal clearance, diametral, at least zero [m].

        Returns:
            To either side: where `lost_clearance` is `clearance`. Differentiable.
        """
        apart, _ = self._centres
        return jnp.sqrt(clearance * (apart - 0.25 * clearance))

    @property
    def holds_axially(self) -> bool:
        return False

    @property
    def play(self) -> Scalar:
        # Radial: axial travel is free over millimetres, and a search begins with this.
        return 0.5 * self.radial_internal_clearance


class SphericalThrustRollerBearing(_AbstractSphere):
    """Spherical roller thrust bearing: asymmetric barrel rollers, one direction.

    The inner ring is the shaft washer, at -z of the rollers; an inner-ring load along
    +z closes the bearing. Asymmetric rollers bear on a rib of the shaft washer with
    their large ends (`ribs.inner_minus`). The origin lies in the plane of the roller
    centres; the rings tilt freely about the centre of the sphere.

    Attributes are those of `AbstractBarrelBearing`, and
        contact_angle: Contact angle of the outer raceway, above 0 [rad].
        outer_raceway_radius: Radius of the sphere [m]; `None`: that about the axis.
        profile_offset: Distance of the largest section from the middle of the roller,
            towards the large end [m]; zero for symmetric rollers.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "asymmetric barrel rollers, one direction of thrust"
    is_thrust: ClassVar[bool] = True
    tilts_alone: ClassVar[bool] = True

    profile_offset: Real = eqx.field(
        **real(
            "m",
            "distance of the largest section from the middle, to the large end",
            least=0,
        ),
        kw_only=True,
        default=0.0,
    )

    @property
    def half_angle(self) -> Scalar:
        return jnp.arcsin(self.profile_offset / self.roller_profile_radius)

    @property
    def gap(self) -> Scalar:
        return jnp.zeros_like(self.pitch_diameter)

    @property
    def play(self) -> Scalar:
        return jnp.zeros_like(self.pitch_diameter)

    def __check_init__(self):
        in_range(
            self, "profile_offset", 0.0, 0.5 * self.roller_length, include_low=True
        )
        _no_clearance(self)


class CylindricalThrustRollerBearing(AbstractRollerBearing):
    """Cylindrical roller thrust bearing: rollers at 90 degrees between flat washers.

    The inner ring is the shaft washer, at -z of the rollers; an inner-ring load along
    +z closes the bearing. Several rollers side by side in one pocket are rows of a
    `BearingSet`, at their own pitch diameters. Without ribs the cage bears the
    centrifugal force of the rollers.

    Attributes are those of `AbstractRollerBearing`.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "rollers at 90° between flat washers"
    is_thrust: ClassVar[bool] = True
    bears_radially: ClassVar[bool] = False
    caged: ClassVar[bool] = True

    @property
    def axis_angle(self) -> Scalar:
        return jnp.full_like(self.pitch_diameter, 0.5 * np.pi)

    @property
    def free_cosine(self) -> Scalar:
        return jnp.zeros_like(self.pitch_diameter)

    @property
    def holds_axially(self) -> bool:
        return True

    def __check_init__(self):
        _no_clearance(self)


class TaperedThrustRollerBearing(TaperedRollerBearing):
    """Tapered roller thrust bearing, one direction.

    Attributes, and the need for a rib, are those of `TaperedRollerBearing`. The inner
    ring is the shaft washer. The sum of both angles is the contact angle of the outer
    raceway: 90 degrees for a flat housing washer.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "tapered roller thrust bearing of one direction"
    is_thrust: ClassVar[bool] = True

    def __check_init__(self):
        outer = self.axis_angle + self.half_angle
        numbers = floats(outer)
        if numbers is not None:
            allowed = (
                "above 45° and at most 90° with `roller_axis_angle` added: the contact"
                " angle of the outer raceway of a thrust bearing"
            )
            steep = 0.25 * np.pi < numbers[0] < 0.5 * np.pi + 1e-6
            check(self, "roller_half_angle", steep, allowed)
        _no_clearance(self)


class CrossedRollerRow(AbstractRollerBearing):
    """Rollers of one orientation in a crossed roller bearing, at 45 degrees.

    Every other roller in the groove is turned by 90 degrees. `BearingSet.crossed`
    makes the bearing of both orientations. The rollers are a little shorter than
    thick, so that their ends carry nothing but, at speed, the axial part of their own
    inertia force, which is left out.

    Attributes are those of `AbstractRollerBearing`, with
        n_rollers: Number of rollers of both orientations, even.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "rollers of both orientations, at 45°"
    caged: ClassVar[bool] = True
    is_crossed: ClassVar[bool] = True

    def with_clearance(self, clearance: Scalar) -> Any:
        return eqx.tree_at(lambda b: b.radial_internal_clearance, self, clearance)

    @property
    def axis_angle(self) -> Scalar:
        return jnp.full_like(self.pitch_diameter, 0.25 * np.pi)

    @property
    def gap(self) -> Scalar:
        return 0.25 * self.radial_internal_clearance * jnp.cos(self.axis_angle)

    @property
    def n_places(self) -> int:
        """Number of places for rollers of one orientation."""
        return self.n_rollers // 2

    @property
    def holds_axially(self) -> bool:
        return True

    def __check_init__(self):
        even = self.n_rollers % 2 == 0
        allowed = "even: every other roller is turned"
        check(self, "n_rollers", even, allowed, self.n_rollers, "rollers")
        numbers = floats(self.roller_length, self.roller_diameter)
        if numbers is not None:
            allowed = f"at most the roller diameter, {numbers[1]:.6g} m"
            check(self, "roller_length", numbers[0] <= numbers[1], allowed)


def pitch_on_sphere(
    *,
    outer_raceway_radius: Number,
    contact_angle: Number,
    roller_diameter: Number,
    roller_profile_radius: Number,
    profile_offset: Number = 0.0,
    radial_internal_clearance: Number = 0.0,
    **_: object,
) -> Any:
    """Return the pitch diameter at which a spherical outer raceway is about the axis.

    Args: numbers, under the names of their fields; others have no effect.

    Returns:
        Inverse of `sphere_radius`, a float; differentiable if a number is traced [m].
    """
    radius, angle, gap = outer_raceway_radius, contact_angle, radial_internal_clearance
    numbers = radius, angle, gap, roller_diameter, roller_profile_radius, profile_offset
    traced = any(map(is_traced, numbers))
    xp: Any = jnp if traced else np
    with np.errstate(all="ignore"):  # nonsense is refused with the bearing
        half = xp.arcsin(xp.divide(profile_offset, roller_profile_radius))
    axis = angle - half
    radius = radius - 0.25 * gap * xp.cos(axis)
    pitch = 2.0 * radius * xp.cos(angle) - roller_diameter * xp.cos(axis)
    return pitch if traced else float(pitch)


def _radius(owner, name):
    value = getattr(owner, name)
    numbers = floats(value)
    if numbers is not None and numbers[0] == np.inf:
        return
    positive(owner, name)
    length = floats(owner.roller_length)
    if numbers is not None and length is not None:
        least = 0.5 * length[0]
        allowed = f"above half the roller length, {least:.6g} m"
        check(owner, name, numbers[0] > least, allowed)


def _no_clearance(owner):
    number(owner, "radial_internal_clearance")
    numbers = floats(owner.radial_internal_clearance)
    if numbers is not None:
        allowed = "0 m: a thrust bearing of one direction has no clearance"
        check(owner, "radial_internal_clearance", numbers[0] == 0.0, allowed)

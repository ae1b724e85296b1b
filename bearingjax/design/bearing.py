"""Roller bearings as on the drawing: dimensions and their checks."""

import math
from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..numerics.types import (
    Real,
    Scalar,
    array_namespace,
    as_count,
    as_real,
    in_numpy,
)
from ..numerics.units import meaning, real, unit
from ..numerics.warning import Warning
from .abstract import AbstractBearing
from .checks import (
    check,
    check_fields,
    floats,
    in_range,
    instance,
    is_traced,
    number,
)
from .deviation import check_deviation, check_raceways, check_spacing
from .material import Material
from .profile import AbstractProfile, Straight
from .published import PublishedRatings
from .rib import Ribs


class AbstractRollerBearing(AbstractBearing):
    """Single-row roller bearing: base class of all types.

    Attributes:
        n_rollers: Number of rollers.
        pitch_diameter: Diameter of the circle of the roller centres, D_pw [m].
        roller_diameter: Mean roller diameter, D_we [m].
        roller_length: Effective contact length along the generator, L_we [m].
        radial_internal_clearance: Diametral play; negative is preload [m]. Unloaded
            and centred, a quarter of it is the gap at each raceway, along the contact
            normal.
        first_azimuth: Azimuth of roller 0, from +x towards +y [rad].
        roller_deviation: Mean diameter of each roller less `roller_diameter`
            (roller,) [m]; `None`: all equal.
        azimuth_deviation: Azimuth of each roller less that of even spacing (roller,)
            [rad]; `None`: evenly spaced.
        raceway_deviation: Deviations of outer and inner raceway at each roller
            (roller, 2, 3) [m]: displacement of the raceway along z and from the axis,
            height of the contact along its normal; `None`: as on the drawing.
        roller_profile: Profile of the rollers.
        outer_raceway_profile: Profile of the outer raceway.
        inner_raceway_profile: Profile of the inner raceway.
        ribs: The ribs.
        material: Material of the rollers.
        ring_material: Material of the rings; `None`: as the rollers.
        published: Ratings and factors that a catalogue prints for it, or `None`.
        filled: Number of places with a roller, the first of `n_rollers`
            (`with_places`); `None`: all.
        caged: Whether without ribs the cage, or a free end, bears what inertia pushes
            the rollers along their axes.
    """

    noun: ClassVar[str] = "roller"
    is_thrust: ClassVar[bool] = False
    caged: ClassVar[bool] = False
    rated_fields: ClassVar[tuple[str, ...]] = (
        "n_rollers",
        "pitch_diameter",
        "roller_diameter",
        "roller_length",
    )

    n_rollers: int = eqx.field(
        static=True, converter=as_count, metadata=meaning("number of rollers")
    )
    pitch_diameter: Real = eqx.field(
        **real("m", "diameter of the circle of the roller centres, D_pw", above=0)
    )
    roller_diameter: Real = eqx.field(
        **real("m", "mean roller diameter, D_we", above=0)
    )
    roller_length: Real = eqx.field(
        **real("m", "effective contact length along the generator, L_we", above=0)
    )
    radial_internal_clearance: Real = eqx.field(
        **real("m", "diametral play; negative is preload"), default=0.0, kw_only=True
    )
    first_azimuth: Real = eqx.field(
        **real("rad", "azimuth of roller 0, from +x towards +y"),
        default=0.0,
        kw_only=True,
    )
    roller_deviation: Float[Array, " roller"] | None = eqx.field(
        converter=as_real,
        metadata=unit(
            "m",
            "mean diameter of each roller less `roller_diameter`",
            otherwise="all equal",
        ),
        default=None,
        kw_only=True,
    )
    azimuth_deviation: Float[Array, " roller"] | None = eqx.field(
        converter=as_real,
        metadata=unit(
            "rad",
            "azimuth of each roller less that of even spacing",
            otherwise="evenly spaced",
        ),
        default=None,
        kw_only=True,
    )
    raceway_deviation: Float[Array, "roller 2 3"] | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None, kw_only=True
    )
    roller_profile: AbstractProfile = eqx.field(default_factory=Straight, kw_only=True)
    outer_raceway_profile: AbstractProfile = eqx.field(
        default_factory=Straight, kw_only=True
    )
    inner_raceway_profile: AbstractProfile = eqx.field(
        default_factory=Straight, kw_only=True
    )
    ribs: Ribs = eqx.field(default_factory=Ribs, kw_only=True)
    material: Material = eqx.field(default_factory=Material, kw_only=True)
    ring_material: Material | None = eqx.field(default=None, kw_only=True)
    published: PublishedRatings | None = eqx.field(default=None, kw_only=True)
    filled: Int[Array, ""] | None = eqx.field(default=None, kw_only=True)

    @property
    def axis_angle(self) -> Scalar:
        """Angle of the roller axis to the bearing axis [rad]."""
        pitch = in_numpy(self.pitch_diameter)
        return array_namespace(pitch).zeros_like(pitch)

    @property
    def half_angle(self) -> Scalar:
        """Half cone angle of the roller [rad]."""
        pitch = in_numpy(self.pitch_diameter)
        return array_namespace(pitch).zeros_like(pitch)

    @property
    def arc_radii(self) -> tuple[Scalar, Scalar, Scalar] | None:
        """Radii of the arcs along the generators of roller, outer and inner raceway
        [m]; `None`: straight ones."""
        return None

    @property
    def axial_place(self) -> Scalar:
        """z of the circle of roller centres from the origin of the bearing [m]."""
        return jnp.zeros_like(self.pitch_diameter)

    @property
    def gap(self) -> Scalar:
        """Gap at each raceway along the contact normal, unloaded and centred [m]."""
        return 0.25 * self.radial_internal_clearance

    @property
    def free_cosine(self) -> Scalar:
        return jnp.cos(self.axis_angle)

    @property
    def nominal_contact_angle(self) -> Scalar:
        # The load of a taper leaves through its outer raceway, which has no rib.
        return self.axis_angle + self.half_angle

    @property
    def touching_angle(self) -> Scalar:
        return self.axis_angle + self.half_angle

    @property
    def clearance(self) -> Scalar:
        angle = self.touching_angle
        return 4.0 * self.gap / array_namespace(angle).cos(angle)

    def with_clearance(self, clearance: Scalar) -> Any:
        # The clearance of a taper is along the normal.
        own = clearance * jnp.cos(self.touching_angle)
        return eqx.tree_at(lambda b: b.radial_internal_clearance, self, own)

    @property
    def raceway_diameters(self) -> tuple[Scalar, Scalar]:
        axis, half = self.axis_angle, self.half_angle
        pitch, size = self.pitch_diameter, self.roller_diameter
        return pitch - size * jnp.cos(axis - half), pitch + size * jnp.cos(axis + half)

    @property
    def deviation_bounds(self) -> tuple[Any, ...]:
        return (0.5 * self.roller_diameter,)

    @property
    def element_length(self) -> Any:
        return self.roller_length

    @property
    def rib_names(self) -> tuple[str, ...]:
        return self.ribs.present

    @property
    def holds_axially(self) -> bool:
        pairs = ("outer_minus", "inner_plus"), ("outer_plus", "inner_minus")
        return any(set(pair) <= set(self.ribs.present) for pair in pairs)

    @property
    def play(self) -> Scalar:
        ribs = [getattr(self.ribs, name).axial_gap for name in self.ribs.present]
        plays = [0.5 * self.radial_internal_clearance, *(2 * gap for gap in ribs)]
        return jnp.max(jnp.stack(plays))

    @property
    def n_places(self) -> int:
        """Number of places for rollers."""
        return self.n_rollers

    @property
    def element_diameter(self) -> Scalar:
        """Mean diameter of the rollers [m]."""
        return self.roller_diameter

    @property
    def element_deviation(self) -> Float[Array, " roller"] | None:
        """Diameter of each roller less the common one [m]; `None`: all equal."""
        return self.roller_deviation

    def __check_init__(self):
        self._check_common()
        check_fields(self)
        number(self, "radial_internal_clearance")
        self._check_parts()
        self._check_row()
        self._check_deviation()

    def _check_parts(self):
        profiles = (
            "roller_profile",
            "outer_raceway_profile",
            "inner_raceway_profile",
        )
        for name in profiles:
            instance(self, name, AbstractProfile)
        instance(self, "ribs", Ribs)
        for name in profiles:
            getattr(self, name).check(self.roller_length, self.roller_diameter)
        for name in self.ribs.present:
            self._check_rib(name)

    def _check_deviation(self):
        what = "the mean diameter of each roller less `roller_diameter` in m"
        value = check_deviation(self, "roller_deviation", self.n_places, what)
        numbers = floats(self.roller_diameter)
        if numbers is None:
            return
        diameter = numbers[0]
        check_spacing(self, self.n_places, diameter)
        check_raceways(self, self.n_places, 0.5 * diameter)
        if value is not None:
            allowed = f"smaller in size than the roller diameter, {diameter:.6g} m"
            check(self, "roller_deviation", abs(value) < diameter, allowed)

    def _check_rib(self, name):
        rib = getattr(self.ribs, name)
        numbers = floats(
            rib.contact_height,
            rib.end_radius,
            self.roller_diameter,
            self.roller_length,
            self.half_angle,
        )
        if numbers is None:
            return
        height, end_radius, diameter, length, half = numbers
        side = -1.0 if name.endswith("minus") else 1.0
        disc = 0.5 * (diameter - side * length * math.sin(half))
        allowed = f"below the diameter of the roller end, {2 * disc:.6g} m"
        key = f"ribs.{name}.contact_height"
        check(self, key, height < 2 * disc, allowed, height, "m")
        allowed = f"above the radius of the roller end, {disc:.6g} m"
        check(
            self, f"ribs.{name}.end_radius", end_radius > disc, allowed, end_radius, "m"
        )

    def _check_row(self):
        numbers = floats(
            self.pitch_diameter,
            self.roller_diameter,
            self.roller_length,
            self.axis_angle,
            self.half_angle,
            self.radial_internal_clearance,
        )
        if numbers is None:
            return
        pitch, diameter, length, axis, half, clearance = numbers
        lost = self.end_drop()
        # Middle and ends of the roller: its radius there, and that of their circle.
        for side in (-1.0, 0.0, 1.0):
            along = 0.5 * side * length * math.cos(half)
            radius = 0.5 * diameter - along * math.tan(half) - abs(side) * lost
            circle = 0.5 * pitch - along * math.sin(axis)
            allowed = (
                "small enough to leave an inner raceway inside the pitch circle of"
                f" {pitch:.6g} m"
            )
            fits = radius > 0 and circle > radius * math.cos(axis)
            check(self, "roller_diameter", fits, allowed)
            most = int(math.pi / math.asin(min(1.0, radius / circle)))
            allowed = (
                "low enough that rollers do not overlap around the pitch circle (at"
                f" most {most} of this size)"
            )
            if not is_traced(self.n_stated):
                n = int(self.n_stated)
                apart = n == 1 or radius < circle * math.sin(math.pi / n)
                check(self, "n_rollers", apart, allowed, n, "rollers")
        allowed = "smaller in size than the roller diameter (metres meant?)"
        small = abs(clearance) < diameter
        check(self, "radial_internal_clearance", small, allowed)

    def end_drop(self) -> float:
        """Roller radius that is missing at the ends, profile apart [m]."""
        return 0.0


class CylindricalRollerBearing(AbstractRollerBearing):
    """Cylindrical roller bearing, any arrangement of ribs.

    Attributes are those of `AbstractRollerBearing`. The usual types by name:
    `ribs=Ribs.arrangement("NUP", Rib(...), axial_internal_clearance)`.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "cylindrical rollers, any arrangement of ribs"

    @property
    def axial_senses(self) -> frozenset[int]:
        ribs = self.ribs
        paths = {
            1: (ribs.inner_minus, ribs.outer_plus),
            -1: (ribs.inner_plus, ribs.outer_minus),
        }
        return frozenset(sense for sense, pair in paths.items() if None not in pair)


class NeedleRollerBearing(AbstractRollerBearing):
    """Needle roller bearing: long thin rollers, mostly without ribs.

    Attributes are those of `AbstractRollerBearing`; the roller length must be at
    least 2.5 roller diameters.

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "long thin rollers, mostly without ribs"

    def __check_init__(self):
        numbers = floats(self.roller_length, self.roller_diameter)
        if numbers is not None:
            length, least = numbers[0], 2.5 * numbers[1]
            allowed = f"at least 2.5 roller diameters, {least:.6g} m, for a needle"
            check(self, "roller_length", length >= least, allowed)


class TaperedRollerBearing(AbstractRollerBearing):
    """Single-row tapered roller bearing.

    The large roller ends lie at -z; an inner-ring load along +z closes the bearing.
    A roller with a half cone angle needs the large rib (`ribs.inner_minus`): without
    it no contact holds the roller along its axis, as there is no friction.

    Attributes are those of `AbstractRollerBearing`, and
        roller_axis_angle: Angle of the roller axis to the bearing axis [rad].
        roller_half_angle: Half cone angle of the roller [rad].

    Traced: all fields but `n_rollers`.
    """

    about: ClassVar[str] = "single-row tapered roller bearing"

    rated_fields = (
        *AbstractRollerBearing.rated_fields,
        "roller_axis_angle",
        "roller_half_angle",
    )

    roller_axis_angle: Real = eqx.field(
        **real(
            "rad",
            "angle of the roller axis to the bearing axis",
            above=0,
            below=0.5 * jnp.pi,
        ),
        kw_only=True,
        default=jnp.nan,
    )
    roller_half_angle: Real = eqx.field(
        **real("rad", "half cone angle of the roller", least=0),
        kw_only=True,
        default=0.0,
    )

    @property
    def holds_axially(self) -> bool:
        return True

    @property
    def axis_angle(self) -> Scalar:
        return self.roller_axis_angle

    @property
    def half_angle(self) -> Scalar:
        return self.roller_half_angle

    def __check_init__(self):
        check_fields(self)
        most = self.roller_axis_angle
        in_range(self, "roller_half_angle", 0.0, most, include_low=True)

    def apexes(self) -> tuple[Scalar, Scalar, Scalar]:
        """Apexes of outer raceway, roller axis and inner raceway on the bearing axis.

        Returns:
            z of the three apexes from the roller centre [m]; all equal when
            tan(half angle) = (D/2) sin(axis angle)/(pitch radius).
        """
        return _apexes(*_angles_and_size(self), jnp)

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """A warning if the apexes lie apart; empty where its numbers are traced."""
        numbers = floats(*jax.tree.leaves(_angles_and_size(self)))
        if numbers is None or numbers[1] == 0.0:
            return ()
        axis, half, pitch, diameter = numbers
        outer, roller, inner = _apexes(axis, half, pitch, diameter, math)
        apart, limit = max(abs(outer - roller), abs(inner - roller)), 0.01 * abs(roller)
        if not apart > limit:
            return ()
        words = (
            f"{type(self).__name__}: the apexes of outer raceway, roller axis and"
            f" inner raceway lie at z = {1e3 * outer:.4g}, {1e3 * roller:.4g} and"
            f" {1e3 * inner:.4g} mm; they differ by more than 1 %, so the rollers"
            " cannot roll without sliding."
        )
        return (Warning("apexes_apart", words, apart, limit),)


def _angles_and_size(taper):
    return (
        taper.roller_axis_angle,
        taper.roller_half_angle,
        taper.pitch_diameter,
        taper.roller_diameter,
    )


def _apexes(axis, half, pitch_diameter, diameter, m):
    """The three apexes; `m` is the module of sin, cos and tan: math or jax.numpy."""
    pitch = 0.5 * pitch_diameter
    z, r = 0.5 * diameter * m.sin(axis), 0.5 * diameter * m.cos(axis)
    return (
        z + (pitch + r) / m.tan(axis + half),
        pitch / m.tan(axis),
        -z + (pitch - r) / m.tan(axis - half),
    )

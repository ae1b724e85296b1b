"""Parts of a rotor: discs, point masses, supports and their housings."""

import dataclasses
from abc import abstractmethod
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import (
    check,
    instance,
    is_traced,
    must_be,
    non_negative,
    of_shape,
    positive,
)
from ..design.material import Material
from ..numerics.compiled.programs import program
from ..numerics.types import (
    Number,
    Real,
    Scalar,
    array_namespace,
    as_count,
    as_real,
    in_numpy,
)
from ..numerics.units import real, unit
from ..numerics.warning import Warning

Five = Float[Array, "5"]
"""Along (ux uy uz gx gy) of a station: a motion, its rate, or a force."""
Responded = tuple[Any, Any, Any]
"""Force (5,), stiffness and damping (5, 5) of a support."""
_FLAT = 2.0 * (1.0 + 1e-6)
"""Polar over diametral moment of inertia of a flat disc, with round-off [1]."""
STIFFNESS_UNITS = (
    *3 * (("N/m", "N/m", "N/m", "N", "N"),),
    *2 * (("N", "N", "N", "N m", "N m"),),
)
DAMPING_UNITS = (
    *3 * (("N s/m", "N s/m", "N s/m", "N s", "N s"),),
    *2 * (("N s", "N s", "N s", "N m s", "N m s"),),
)


def check_station(owner: Any, station: Any) -> None:
    """Check that a station is a whole number from 0."""
    whole = isinstance(station, int) and not isinstance(station, bool)
    allowed = "the number of a station of the shaft, from 0"
    must_be(owner, "station", station, whole and station >= 0, allowed)


class AbstractPart(eqx.Module):
    """A rigid body on a station.

    Attributes:
        station: Number of the station that it sits on.
        mass: Mass [kg].
    """

    station: eqx.AbstractVar[int]
    mass: eqx.AbstractVar[Scalar]

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about its numbers; empty where they are traced."""
        return ()

    @abstractmethod
    def inertia(self) -> tuple[Float[Array, "5 5"], Float[Array, "5 5"]]:
        """Mass matrix, and gyroscopic matrix at 1 rad/s, of (ux uy uz gx gy)."""


class Disc(AbstractPart):
    """A rigid disc whose centre of mass lies on its station.

    Attributes:
        station: Number of the station that it sits on.
        mass: Mass [kg].
        polar_inertia: Moment of inertia about the shaft axis [kg m²].
        diametral_inertia: Moment of inertia about a diameter [kg m²].

    Traced: all fields but `station`.
    """

    station: int = eqx.field(static=True, converter=as_count)
    mass: Real = eqx.field(**real("kg", "mass of the disc"))
    polar_inertia: Real = eqx.field(
        **real("kg m²", "moment of inertia about the shaft")
    )
    diametral_inertia: Real = eqx.field(
        **real("kg m²", "moment of inertia about a diameter")
    )

    def __check_init__(self):
        check_station(self, self.station)
        for name in ("mass", "polar_inertia", "diametral_inertia"):
            non_negative(self, name)

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """A warning if the polar moment of inertia is above twice the diametral one,
        which no body has; empty where they are traced."""
        sizes = self.polar_inertia, self.diametral_inertia
        if any(is_traced(size) for size in sizes):
            return ()
        polar, diametral = map(float, sizes)
        if not polar > _FLAT * diametral:
            return ()
        words = (
            f"Disc: `polar_inertia` ({polar:.5g} kg m²) is above twice"
            f" `diametral_inertia` ({diametral:.5g} kg m²); no body has that, a"
            " flat disc has just twice as much"
        )
        return (Warning("polar_inertia", words, polar, 2.0 * diametral),)

    @classmethod
    def of_size(
        cls,
        station: int,
        outer_diameter: Any,
        width: Any,
        bore: Any = 0.0,
        material: Material | None = None,
    ) -> "Disc":
        """Create a cylindrical disc.

        Args:
            station: Number of the station that it sits on.
            outer_diameter, width, bore: Sizes [m].
            material: Material of the disc; steel unless given.
        """
        sizes = [as_real(size) for size in (outer_diameter, width, bore)]
        material = Material() if material is None else material
        (outer, wide, hole), density = in_numpy((sizes, material.density))
        positive(cls, "outer_diameter", outer, "m")
        positive(cls, "width", wide, "m")
        non_negative(cls, "bore", hole, "m")
        if not is_traced(outer) and not is_traced(hole):
            check(cls, "bore", hole < outer, "below the outer diameter", hole, "m")
        mass = density * 0.25 * jnp.pi * (outer**2 - hole**2) * wide
        squares = outer**2 + hole**2
        diametral = mass * (squares / 16.0 + wide**2 / 12.0)
        return cls(station, mass, mass * squares / 8.0, diametral)

    def inertia(self) -> tuple[Float[Array, "5 5"], Float[Array, "5 5"]]:
        """Mass matrix, and gyroscopic matrix at 1 rad/s, of (ux uy uz gx gy).

        The angular momentum is that of a spin about the disc's own axis
        (gy, -gx, 1): its rate is the moment.
        """
        m, diametral = self.mass, self.diametral_inertia
        gyroscopic = jnp.zeros((5, 5), dtype=m.dtype).at[3, 4].set(self.polar_inertia)
        mass = jnp.diag(jnp.stack([m, m, m, diametral, diametral]))
        return mass, gyroscopic - gyroscopic.T


class PointMass(AbstractPart):
    """A mass without moments of inertia.

    Attributes:
        station: Number of the station that it sits on.
        mass: Mass [kg].

    Traced: mass.
    """

    station: int = eqx.field(static=True, converter=as_count)
    mass: Real = eqx.field(**real("kg"))

    def __check_init__(self):
        check_station(self, self.station)
        non_negative(self, "mass")

    def inertia(self) -> tuple[Float[Array, "5 5"], Float[Array, "5 5"]]:
        """Mass matrix, and gyroscopic matrix (zero), of (ux uy uz gx gy)."""
        nothing = jnp.zeros_like(self.mass)
        return Disc(self.station, self.mass, nothing, nothing).inertia()


def square_matrix(value: Any) -> Any:
    """Converter: a number, or one per freedom, becomes a diagonal matrix."""
    value = as_real(value)
    if getattr(value, "ndim", 0) != 1:
        return value
    known = in_numpy(value)
    return as_real(array_namespace(known).diag(known))


def check_matrix(owner: Any, name: str, size: int) -> None:
    """Raise unless a field is a square matrix of stiffness or damping."""
    value = getattr(owner, name)
    allowed = f"{(size, size)}, or {size} numbers, those of the diagonal"
    of_shape(owner, name, np.shape(value) == (size, size), allowed)
    if not is_traced(value):
        fine = np.isfinite(value).all() and (np.diagonal(value) >= 0).all()
        check(owner, name, fine, "finite, and at least 0 on its diagonal")


class Housing(eqx.Module):
    """Housing of a support: a mass on springs and dampers to ground.

    It moves in x, y and z and does not tilt.

    Attributes:
        mass: Mass [kg].
        stiffness: Against ground, in x, y and z (3, 3), or its diagonal (3,) [N/m].
        damping: Damping in the same directions (3, 3), or its diagonal (3,) [N s/m].

    Traced: all fields.
    """

    mass: Real = eqx.field(**real("kg", "mass of the housing"))
    stiffness: Float[Array, "3 3"] = eqx.field(
        converter=square_matrix, metadata=unit((("N/m",) * 3,) * 3)
    )
    damping: Float[Array, "3 3"] = eqx.field(
        converter=square_matrix,
        metadata=unit((("N s/m",) * 3,) * 3),
        default=(0.0, 0.0, 0.0),
    )

    def __check_init__(self):
        positive(self, "mass")
        check_matrix(self, "stiffness", 3)
        check_matrix(self, "damping", 3)


def check_support(owner: Any) -> None:
    """Check fields of a support: station, damping (5, 5), housing or `None`."""
    check_station(owner, owner.station)
    check_matrix(owner, "damping", 5)
    instance(owner, "housing", Housing, None)


class AbstractSupport(eqx.Module):
    """Support of a station of the shaft on ground or on a housing.

    A support is a force over motion and velocity; linear analyses take its slopes.

    Attributes:
        station: Number of the supported station.
        housing: Its housing; `None`: ground.
    """

    station: eqx.AbstractVar[int]
    housing: eqx.AbstractVar[Housing | None]

    @abstractmethod
    def force(
        self, motion: Five, velocity: Five, speed: Scalar, angle: Number = 0.0
    ) -> Five:
        """Force that moves the station against the support (5,) [N, N m].

        Args:
            motion: (ux uy uz gx gy) of the station less those of the housing [m, rad].
            velocity: Its rate [m/s, rad/s].
            speed: Speed of the rotor [rad/s].
            angle: By which the rotor has turned, from x towards y [rad].
        """

    def respond(self, motion: Five, speed: Scalar) -> Responded:
        """Force (5,), stiffness and damping (5, 5) at a motion and a speed, at rest.

        Args:
            motion, speed: As `force`.
        """

        def with_value(motion, velocity):
            force = self.force(motion, velocity, speed)
            return force, force

        rest = jnp.zeros_like(motion)
        slopes, force = jax.jacfwd(with_value, (0, 1), has_aux=True)(motion, rest)
        return force, *slopes

    def respond_alone(self, motion: np.ndarray, speed: Any) -> Responded:
        """Return `respond` of known numbers, by a program of its kind of support.

        Args:
            motion: Motion of the station less that of the housing (5,) [m, rad].
            speed: Speed of the rotor [rad/s]; `None`: at rest.
        """
        return _respond(self, motion, np.zeros(()) if speed is None else speed)

    def linearise(
        self, motion: Five, speed: Scalar
    ) -> tuple[Float[Array, "5 5"], Float[Array, "5 5"]]:
        """Stiffness and damping (5, 5) at a motion and a speed, at rest there.

        Args:
            motion, speed: As `force`.
        """
        return self.respond(motion, speed)[1:]

    def without_place(self) -> "AbstractSupport":
        """Return a copy on station 0 and ground; like supports then compare equal."""
        return dataclasses.replace(self, station=0, housing=None)


@program(quick=True)
def _respond(support, motion, speed):
    return support.respond(motion, speed)


class LinearSupport(AbstractSupport):
    """Linear springs and dampers.

    Attributes:
        station: Number of the supported station.
        stiffness: d(Fx, Fy, Fz, Mx, My)/d(ux, uy, uz, gx, gy) (5, 5), or its diagonal
            (5,) [N/m, N, N m].
        damping: Damping force over the rates of the motion [N s/m, N s, N m s].
        housing: Its housing; `None`: ground.

    Traced: stiffness, damping, housing.
    """

    station: int = eqx.field(static=True, converter=as_count)
    stiffness: Float[Array, "5 5"] = eqx.field(
        converter=square_matrix, metadata=unit(STIFFNESS_UNITS)
    )
    damping: Float[Array, "5 5"] = eqx.field(
        converter=square_matrix, metadata=unit(DAMPING_UNITS), default=(0.0,) * 5
    )
    housing: Housing | None = eqx.field(default=None, kw_only=True)

    def __check_init__(self):
        check_support(self)
        check_matrix(self, "stiffness", 5)

    @classmethod
    def isotropic(
        cls,
        station: int,
        radial: Any,
        axial: Any = 0.0,
        tilt: Any = 0.0,
        *,
        radial_damping: Any = 0.0,
        axial_damping: Any = 0.0,
        tilt_damping: Any = 0.0,
        housing: Housing | None = None,
    ) -> "LinearSupport":
        """Create an isotropic support without coupling.

        Args:
            station: Number of the supported station.
            radial, axial: Stiffness in x and y, and in z [N/m].
            tilt: Stiffness against tilting about x and y [N m].
            radial_damping, axial_damping: Damping [N s/m].
            tilt_damping: Damping of tilting [N m s].
            housing: Its housing; `None`: ground.
        """

        def diagonal(radial, axial, tilt):
            r, a, t = (as_real(value) for value in (radial, axial, tilt))
            return jnp.stack([r, r, a, t, t])

        return cls(
            station,
            diagonal(radial, axial, tilt),
            diagonal(radial_damping, axial_damping, tilt_damping),
            housing=housing,
        )

    def force(
        self, motion: Five, velocity: Five, speed: Scalar, angle: Number = 0.0
    ) -> Five:
        """Force that moves the station against the support (5,) [N, N m]."""
        return self.stiffness @ motion + self.damping @ velocity

    def respond_alone(self, motion: np.ndarray, speed: Any) -> Responded:
        stiffness, damping = np.asarray(self.stiffness), np.asarray(self.damping)
        return stiffness @ motion, stiffness, damping

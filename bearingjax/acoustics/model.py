"""A bearing on a noise rig: one ring turns, the other one may move.

M q'' + ∂E/∂q + sensor = load for the moving ring, m p'' + ∂E/∂p = inertia of the orbit
for every rolling element, with E(q, p, t) the strain energy of all contacts. Its time
enters by the places of the rolling elements and by the form errors that they meet. The
cage carries them round evenly, at the speed of rolling without slip.

A film, and what else damps in a contact, resists the change of the contact's force:
forces are f + τ df/dt, with a retardation time τ. No force jumps where a contact opens.
Damping over stiffness of whole bearings is some 2.5 to 25 us, and contacts in series
have the τ of each. The default lies in the middle of that range.

With a `Cage` every ball also has a place along the pitch circle: m s'' = its traction
and what its pocket does. Its contacts with the raceways move along; that they push it
along too, by slopes of form errors, is left out.

Source: Kurushin, Kurushin, Zhilnikov, Murashkin (Vestnik SGAU, 2011) for balls moving
    radially; here with all freedoms of the section, on the energy of the contacts.
    Retardation: Krämer, Dynamics of Rotors and Foundations (1993), and Friswell et al.,
    Dynamics of Rotating Machines (2010), p. 182-185: (0.25 to 2.5) 1e-5 s.
"""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBallBearing
from ..design.checks import (
    check,
    concrete,
    instance,
    is_real,
    is_traced,
    non_negative,
    positive,
)
from ..design.form_error import FormErrors, Surfaces
from ..element.bearing_element import BearingElement
from ..element.frame import FREEDOMS, RINGS, orbit, roll_ratio, rotation
from ..element.inertia import Speed
from ..element.rolling_element import RingMotion
from ..element.row import Row, shifted
from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from ..statics.options import SolveOptions
from .cage import Cage, cage_forces
from .free_element import FreeElement, forces, free_element


class Sensor(eqx.Module):
    """A spring and a dashpot that hold the moving ring along a line.

    The spring is set when the bearing is loaded: it carries no part of the load.

    Attributes:
        stiffness: [N/m].
        damping: [N s/m].
        direction: Of the line (x, y, z), of any length (3,) [1].

    Traced: all fields.
    """

    stiffness: Scalar = eqx.field(converter=as_real, metadata=unit("N/m"))
    damping: Scalar = eqx.field(converter=as_real, metadata=unit("N s/m"), default=0.0)
    direction: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit("1"), default=(0.0, 1.0, 0.0)
    )

    def __check_init__(self):
        non_negative(self, "stiffness")
        non_negative(self, "damping")
        if np.shape(self.direction) != (3,):
            raise ValueError(
                f"Sensor: `direction` has shape {np.shape(self.direction)}; it must be"
                " (3,): (x, y, z)."
            )
        if not is_traced(self.direction):
            some = np.any(np.asarray(self.direction) != 0.0)
            check(self, "direction", some, "another than (0, 0, 0)")

    @property
    def projector(self) -> Float[Array, "3 3"]:
        """d dᵀ of the unit vector along the line."""
        d = self.direction
        return jnp.outer(d, d) / jnp.sum(d * d)


class NoiseModel(eqx.Module):
    """A bearing whose vibration from form errors is wanted.

    Attributes:
        element: The bearing, a single row, with linearised kinematics.
        mass: Of the moving ring, and of what moves with it [kg].
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring (6,) [N, N m]; moments only
            if it may tilt.
        speed: Of the rings.
        errors: Form errors.
        tilting_inertia: Moment of inertia of the moving ring about a diameter [kg m²];
            `None`: it does not tilt.
        sensor: What holds the moving ring beside the bearing; `None`: nothing.
        retardation: τ of the contacts' damping [s]. Damping ratio of a mode of ω that
            is held by contacts alone: ω τ/2.
        moving_ring: "outer" or "inner". Static.
        cage: `None`: the rolling elements go round evenly, each in its place.

    Traced: all numbers.
    """

    element: BearingElement
    mass: Scalar = eqx.field(converter=as_real, metadata=unit("kg"))
    load: Float[Array, "6"] = eqx.field(
        converter=as_real, metadata=unit(("N", "N", "N", "N m", "N m", "N m"))
    )
    speed: Speed
    errors: FormErrors = eqx.field(default_factory=FormErrors)
    tilting_inertia: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("kg m²"), default=None
    )
    sensor: Sensor | None = None
    retardation: Scalar = eqx.field(converter=as_real, metadata=unit("s"), default=1e-5)
    moving_ring: str = eqx.field(static=True, default="outer")
    cage: Cage | None = None

    def __check_init__(self):
        instance(self, "element", BearingElement)
        instance(self, "cage", Cage, None)
        bearing = self.element.bearing
        if not hasattr(bearing, "raceway_deviation"):
            raise TypeError(
                f"NoiseModel: `element` is of a {type(bearing).__name__}; it must be of"
                " one row of balls or rollers."
            )
        kinematics = self.element.kinematics
        if kinematics.turns_far:
            raise ValueError(
                f"NoiseModel: `element` has {type(kinematics).__name__}() kinematics;"
                " it must have Linearised()."
            )
        if bearing.raceway_deviation is not None:
            raise ValueError(
                "NoiseModel: `element` has a `raceway_deviation`, which stands still;"
                " form errors that turn are `errors`."
            )
        if self.cage is not None and not isinstance(bearing, AbstractBallBearing):
            raise TypeError(
                f"NoiseModel: `cage` is given for a {type(bearing).__name__}; it is for"
                " ball bearings."
            )
        positive(self, "mass")
        instance(self, "speed", Speed)
        instance(self, "errors", FormErrors)
        instance(self, "sensor", Sensor, None)
        if self.tilting_inertia is not None:
            positive(self, "tilting_inertia")
        non_negative(self, "retardation")
        if self.moving_ring not in RINGS:
            raise ValueError(
                f"NoiseModel: `moving_ring` is {self.moving_ring!r}; it must be 'outer'"
                " or 'inner'."
            )
        if not is_real(self.load) or np.shape(self.load) != (6,):
            raise ValueError(
                f"NoiseModel: `load` has shape {np.shape(self.load)}; it must be (6,):"
                " (Fx, Fy, Fz, Mx, My, Mz)."
            )
        if is_traced(self.load):
            return
        check(self, "load", np.isfinite(self.load), "finite")
        held = np.asarray(self.load)[len(self.freedoms) :]
        allowed = "zero for freedoms that the ring does not have: give tilting_inertia"
        check(self, "load", held[: 5 - len(self.freedoms)] == 0.0, allowed)
        check(self, "load", np.asarray(self.load)[5] == 0.0, "zero about the axis")

    @property
    def freedoms(self) -> tuple[str, ...]:
        """Freedoms of the moving ring."""
        return FREEDOMS[: 3 if self.tilting_inertia is None else 5]

    @property
    def fixed_ring(self) -> str:
        """The ring that does not move, but may turn."""
        return RINGS[1 - RINGS.index(self.moving_ring)]

    @property
    def orbits(self) -> bool:
        """Whether a ring turns; speeds that are traced count as such."""
        return concrete(self.speed.outer, self.speed.inner) != [0.0, 0.0]

    @property
    def shaft_speed(self) -> Scalar:
        """Of the ring that turns faster, without its sign [rad/s]."""
        return jnp.maximum(jnp.abs(self.speed.outer), jnp.abs(self.speed.inner))

    @property
    def solve_options(self) -> SolveOptions:
        """Settings of the load solve that finds where the ring stands."""
        return SolveOptions(free=self.freedoms, fixed_ring=self.fixed_ring, points=2)

    def system(self, points: int = 4096) -> "NoiseSystem":
        """The equations of motion, all constants worked out.

        Args:
            points: Angles at which form errors are tabulated. Static.
        """
        return _system(self, points)

    def still_system(self) -> "NoiseSystem":
        """The same without form errors, the rolling elements carried evenly."""
        return dataclasses.replace(self.system(8), errors=None, cage=None)


class NoiseSystem(eqx.Module):
    """Equations of motion of a `NoiseModel`.

    Coordinates are those of the ring, then of every rolling element: (n,). With a cage
    follow how far every rolling element is ahead of the even orbit, along the pitch
    circle, and the cage's x, y and turn beyond that orbit.

    Attributes:
        row: The rolling elements, each a `FreeElement`.
        errors: Form errors, tabulated; `None`: none.
        surfaces: Where the contacts run.
        turning: Speeds of outer ring, inner ring, orbit and of the elements about
            their own axes, against the orbit [rad/s].
        mass: Of the ring's freedoms (k,) [kg, kg m²].
        load: On them (k,) [N, N m].
        growth: Time in which form errors grow from nothing, so that they excite no
            vibration of their own by being there; `None`: they are there [s].
        sensor: As of the model.
        retardation: As of the model [s].
        moving: 0 for the outer ring, 1 for the inner one. Static.
        cage: As of the model.
    """

    row: Row
    errors: FormErrors | None
    surfaces: Surfaces
    turning: tuple[Scalar, Scalar, Scalar, Scalar]
    mass: Float[Array, " k"]
    load: Float[Array, " k"]
    sensor: Sensor | None
    retardation: Scalar
    growth: Scalar | None
    moving: int = eqx.field(static=True)
    cage: Cage | None = None

    @property
    def masses(self) -> Float[Array, " n"]:
        """Of all coordinates [kg, kg m²]."""
        at = self.row.azimuth
        each = self.row.each(lambda free, _: free.mass, at)
        masses = [self.mass, each.ravel()]
        if (cage := self.cage) is not None:
            own = jnp.stack([cage.mass, cage.mass, cage.inertia])
            masses = [*masses, each[:, 0], own]
        return jnp.concatenate(masses)

    def rings(self, ring: Float[Array, " k"]) -> RingMotion:
        """Motions of both rings [m, rad]."""
        q = jnp.zeros((6,), ring.dtype).at[: ring.shape[0]].set(ring)
        still = jnp.zeros_like(q)
        return RingMotion(still, q) if self.moving else RingMotion(q, still)

    def parted(
        self, motion: Float[Array, " n"]
    ) -> tuple[Float[Array, " k"], Float[Array, "element m"]]:
        """Ring's and rolling elements' coordinates."""
        k = self.mass.shape[0]
        count = self.row.azimuth.shape[0]
        end = k + count * self.row.element.mass.shape[-1]
        return motion[:k], motion[k:end].reshape(count, -1)

    def caged(
        self, motion: Float[Array, " n"]
    ) -> tuple[Float[Array, " element"], Float[Array, "3"]]:
        """Places along the pitch circle, and the cage's coordinates, where it is."""
        count = self.row.azimuth.shape[0]
        return motion[-3 - count : -3], motion[-3:]

    def azimuth(
        self, time: Scalar, motion: Float[Array, " n"] | None = None
    ) -> Float[Array, " element"]:
        """Where the rolling elements are [rad].

        Args:
            time: [s].
            motion: Coordinates (n,) [m, rad], which count where there is a cage;
                `None`: on the even orbit.
        """
        even = self.row.azimuth + self.turning[2] * time
        if self.cage is None or motion is None:
            return even
        return even + self.caged(motion)[0] / self.row.pitch_radius

    def met(
        self, azimuth: Float[Array, " element"], time: Scalar
    ) -> Float[Array, "element 2 3"] | None:
        """How every rolling element finds the raceways, `Deviation.raceway` [m].

        Args:
            azimuth: Where they are [rad].
            time: [s].
        """
        if self.errors is None:
            return None
        outer, inner, _, spin = self.turning
        rolled = jnp.full_like(azimuth, 1.0) * spin * time
        turns = outer * time, inner * time
        met = self.errors.met(self.surfaces, azimuth, *turns, rolled)
        return met if self.growth is None else _grown(time / self.growth) * met

    def _each(self, function, motion, time, met=None):
        """Map function(free, axes, rings, place) over the elements, as they are met."""
        ring, places = self.parted(motion)
        local, azimuth = self.rings(ring), self.azimuth(time, motion)
        met = self.met(azimuth, time) if met is None else met
        met = () if met is None else (met,)

        def one(free, azimuth, place, *met):
            axes, seen = free.element.axes(azimuth), local
            if met:
                seen = shifted(local, azimuth, met[0][:, :2])
                free = free.raised(met[0][:, 2])
            rings = RingMotion(axes @ seen.outer, axes @ seen.inner)
            return function(free, axes, rings, place)

        return self.row.each(one, azimuth, places, *met)

    def contact_forces(
        self,
        motion: Float[Array, " n"],
        time: Scalar,
        met: Float[Array, "element 2 3"] | None = None,
    ) -> Float[Array, " n"]:
        """∂E/∂(q, p) at a time [N, N m].

        Args:
            motion: Coordinates (n,) [m, rad].
            time: [s].
            met: How the rolling elements find the raceways [m]; `None`: as `met`.
        """

        def one(free, axes, rings, place):
            on_rings, on_place = forces(free, rings, place)
            return axes.T @ on_rings[self.moving], on_place - free.force

        on_ring, on_places = self._each(one, motion, time, met)
        k = self.mass.shape[0]
        on_ring = jnp.sum(on_ring, axis=0)[:k]
        if (cage := self.cage) is None:
            return jnp.concatenate([on_ring, on_places.ravel()])
        arcs, place = self.caged(motion)
        guided = RINGS.index(cage.guiding_ring) == self.moving
        guide = motion[:2] if guided else jnp.zeros((2,), motion.dtype)
        radius, azimuth = self.row.pitch_radius, self.azimuth(time, motion)
        found = cage_forces(cage, place, arcs, azimuth, guide, radius)
        if guided:
            on_ring = on_ring.at[:2].add(found.ring)
        return jnp.concatenate([on_ring, on_places.ravel(), found.arcs, found.cage])

    def contact_loads(
        self, motion: Float[Array, " n"], time: Scalar
    ) -> Float[Array, "element contact"]:
        """Load of every contact [N]; arguments as of `contact_forces`."""

        def one(free, axes, rings, place):
            return free.loads(rings, place)

        return self._each(one, motion, time)

    def traction(
        self,
        cage: Cage,
        motion: Float[Array, " n"],
        velocity: Float[Array, " n"],
        time: Scalar,
    ) -> Float[Array, " element"]:
        """Force of both raceways on every ball along the pitch circle [N].

        It draws the ball to the orbit on which it would roll: that of its own diameter
        and contact angle, the mean of its contacts by their loads. Between the two it
        slides, with friction on all its loads. Its turn about its own axis follows
        without delay.

        Args:
            cage: Of the bearing.
            motion, velocity: [m, rad], [m/s, rad/s].
            time: [s].
        """
        outer, inner, even, _ = self.turning
        radius = self.row.pitch_radius

        def one(free, axes, rings, place):
            load, cosine = free.carried(rings, place)
            diameter = free.element.diameter
            own = roll_ratio(diameter, 2.0 * radius, cosine)
            return load, radius * (orbit(own, outer, inner) - even)

        load, ahead = self._each(one, motion, time)
        slip = ahead - self.caged(velocity)[0]
        return cage.friction * load * jnp.tanh(slip / cage.sliding_speed)

    def forces(
        self,
        motion: Float[Array, " n"],
        velocity: Float[Array, " n"],
        time: Scalar,
        start: Float[Array, " n"],
    ) -> Float[Array, " n"]:
        """What acts on every coordinate [N, N m].

        Args:
            motion, velocity: [m, rad], [m/s, rad/s].
            time: [s].
            start: Where the sensor was set [m, rad].
        """
        rates = velocity, jnp.ones_like(time)
        found, rate = jax.jvp(self.contact_forces, (motion, time), rates)
        force = (
            (-found - self.retardation * rate).at[: self.mass.shape[0]].add(self.load)
        )
        if self.cage is not None:
            count = self.row.azimuth.shape[0]
            force = force.at[-3 - count : -3].add(
                self.traction(self.cage, motion, velocity, time)
            )
            force = force.at[-3:-1].add(self.cage.load)
        if self.sensor is None:
            return force
        s = self.sensor
        pull = s.stiffness * (motion[:3] - start[:3]) + s.damping * velocity[:3]
        return force.at[:3].add(-s.projector @ pull)


def _grown(share):
    """From 0 at 0 to 1 at 1 and beyond, with two derivatives."""
    t = jnp.clip(share, 0.0, 1.0)
    return t * t * t * (10.0 - t * (15.0 - 6.0 * t))


@eqx.filter_jit
def _system(model, points) -> NoiseSystem:
    bearing: Any = model.element.bearing
    (row,) = model.element.model().rows
    outer, inner = model.speed.outer, model.speed.inner
    carried = orbit(row.ratio, outer, inner)
    surfaces = Surfaces.of(bearing)
    diameters = 2.0 * surfaces.element.radius, 2.0 * row.pitch_radius
    own = rotation(row.ratio, *diameters, outer, inner)

    def free(element) -> FreeElement:
        return free_element(
            element, bearing.material, row.pitch_radius, model.speed, carried
        )

    elements = row.each(free)
    row = eqx.tree_at(lambda r: r.element, row, elements)
    some = jax.tree.leaves(model.errors)
    mass = jnp.repeat(model.mass, 3)
    if model.tilting_inertia is not None:
        mass = jnp.concatenate([mass, jnp.repeat(model.tilting_inertia, 2)])
    return NoiseSystem(
        row=row,
        errors=model.errors.tabulated(surfaces, points) if some else None,
        surfaces=surfaces,
        turning=(outer, inner, carried, own),
        mass=mass,
        load=model.load[: mass.shape[0]],
        sensor=model.sensor,
        retardation=model.retardation,
        growth=None,
        moving=RINGS.index(model.moving_ring),
        cage=model.cage,
    )

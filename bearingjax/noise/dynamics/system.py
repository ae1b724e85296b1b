"""Equations of motion of a bearing on a noise rig: one ring moves, one is held.

M q'' + ∂E/∂q + sensor = load for the moving ring, m p'' + ∂E/∂p = inertia of the orbit
for every rolling element, with E(q, p, t) the strain energy of all contacts. Its time
enters by the places of the rolling elements and by the form errors that they meet. The
cage carries them round evenly, at the speed of rolling without slip.

A film, and what else damps in a contact, resists the change of the contact's force:
forces are f + τ df/dt, with a retardation time τ, along the axes of each rolling
element's section: that they go round with it is no change. No force jumps where a
contact opens.
Damping over stiffness of whole bearings is some 2.5 to 25 us, and contacts in series
have the τ of each. The default lies in the middle of that range.

With a `GuidedCage` every ball also has a place along the pitch circle: m s'' = its
traction and what its pocket does. Its contacts with the raceways move along; that they
push it along too, by slopes of form errors, is left out.

Source: Kurushin, Kurushin, Zhilnikov, Murashkin (Vestnik SGAU, 2011) for balls moving
    radially; here with all freedoms of the section, on the energy of the contacts.
    Retardation: Krämer, Dynamics of Rotors and Foundations (1993), and Friswell et al.,
    Dynamics of Rotating Machines (2010), p. 182-185: (0.25 to 2.5) 1e-5 s.
"""

from typing import Annotated, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.form_error import FormErrors, Surfaces
from ...element.frame import RINGS, orbit, roll_ratio
from ...element.row import Row, RowPlacement
from ...numerics.types import Reals, Scalar, Vector
from ...numerics.units import unit, units
from ..sensor import Sensor
from .cage import GuidedCage, cage_forces, cage_loads
from .dynamic_balls import ball_forces, is_written_out
from .dynamic_element import DynamicElement, forces
from .element_positions import Each, ElementPositions, Section


class NoiseSystem(eqx.Module):
    """Equations of motion of a `NoiseModel`.

    Coordinates (n,) are those of the ring, then the first of all rolling elements, the
    second of all and so on: a compiler works best on like neighbours. With a cage
    follow the lead of every rolling element over the uniform orbit, along the pitch
    circle, and the cage's x, y and turn relative to that orbit. Those of a rolling
    element are in the axes of its row, whose z is reversed if it is mirrored.

    Attributes:
        row: The rolling elements, each a `DynamicElement`; of a set, those of all rows.
        placements: Positions of the rows of a set; `None`: of a single row.
        errors: Form errors of each row, tabulated; `None`: none.
        surfaces: Contact tracks of each row.
        speeds: Speeds of outer ring, inner ring, orbit and of the elements about
            their own axes, against the orbit [rad/s]; of a set the latter two of every
            element.
        mass: Mass of the ring's freedoms (k,) [kg, kg m²].
        load: On them (k,) [N, N m].
        growth: Time in which form errors grow from zero, so that their onset excites
            no vibration; `None`: they are present from the start [s].
        sensor: As in the model.
        retardation: As in the model [s].
        moving: 0 for the outer ring, 1 for the inner one. Static.
        counts: Rolling elements of each row. Static.
        cage: As in the model.
    """

    row: Row
    placements: RowPlacement | None
    errors: tuple[FormErrors, ...] | None
    surfaces: tuple[Surfaces, ...]
    speeds: tuple[Scalar, Scalar, Reals, Reals]
    mass: Float[Array, " k"]
    load: Float[Array, " k"]
    sensor: Sensor | None
    retardation: Scalar
    growth: Scalar | None
    moving: int = eqx.field(static=True)
    counts: tuple[int, ...] = eqx.field(static=True)
    cage: GuidedCage | None = None

    @property
    def masses(self) -> Vector:
        """Masses of all coordinates [kg, kg m²]."""
        each = self._of_each("mass")
        masses = [self.mass, each.T.ravel()]
        if (cage := self.cage) is not None:
            own = jnp.stack([cage.mass, cage.mass, cage.inertia])
            masses = [*masses, each[:, 0], own]
        return jnp.concatenate(masses)

    def _of_each(self, name):
        """Return a property of the rolling elements, with leading axis element."""
        return self.row.map(lambda element, _: getattr(element, name), self.row.azimuth)

    def split(
        self, motion: Vector
    ) -> tuple[Float[Array, " k"], Float[Array, "element m"]]:
        """Split coordinates into those of ring and rolling elements."""
        k = self.mass.shape[0]
        count = self.row.azimuth.shape[0]
        end = k + count * self.row.element.mass.shape[-1]
        return motion[:k], motion[k:end].reshape(-1, count).T

    def cage_places(self, motion: Vector) -> tuple[Each, Float[Array, "3"]]:
        """Return places along the pitch circle and the coordinates of the cage."""
        count = self.row.azimuth.shape[0]
        return motion[-3 - count : -3], motion[-3:]

    def azimuth(self, time: Scalar, motion: Vector | None = None) -> Each:
        """Return the azimuths of the rolling elements [rad].

        Args:
            time: [s].
            motion: Coordinates (n,) [m, rad], which count where there is a cage;
                `None`: on the even orbit.
        """
        even = self.row.azimuth + self.speeds[2] * time
        if self.cage is None or motion is None:
            return even
        return even + self.cage_places(motion)[0] / self.row.pitch_radius

    def deviations(
        self, azimuth: Each, time: Scalar
    ) -> Float[Array, "element 2 3"] | None:
        """Return `Deviation.raceway` at every rolling element [m].

        Args:
            azimuth: Azimuths of the elements [rad].
            time: [s].
        """
        if self.errors is None:
            return None
        outer, inner, _, spin = self.speeds
        rolled = jnp.full_like(azimuth, 1.0) * spin * time
        turns = outer * time, inner * time
        cut = np.cumsum(self.counts)[:-1]
        parts = zip(
            self.errors,
            self.surfaces,
            jnp.split(azimuth, cut),
            jnp.split(rolled, cut),
            strict=True,
        )
        of_rows = [one.deviations(s, at, *turns, roll) for one, s, at, roll in parts]
        deviations = of_rows[0] if len(of_rows) == 1 else jnp.concatenate(of_rows)
        return (
            deviations
            if self.growth is None
            else _smooth_step(time / self.growth) * deviations
        )

    def positions(self, azimuth: Each, time: Scalar) -> ElementPositions:
        """Return positions with deviations; arguments as in `deviations`."""
        found = ElementPositions.from_azimuth(azimuth)
        deviations = self.deviations(azimuth, time)
        if deviations is None or self.errors is None:
            return found
        return found.with_deviations(
            deviations, any(one.raise_surfaces for one in self.errors)
        )

    def course(self, time: Scalar) -> tuple[ElementPositions, ElementPositions] | None:
        """Return `positions` at a time and their rates, if they depend on time alone.

        Args:
            time: [s].

        Returns:
            `None` with a cage: element positions then depend on the motion.
        """
        if self.cage is not None:
            return None

        def positions_at(time):
            return self.positions(self.azimuth(time), time)

        return jax.jvp(positions_at, (time,), (jnp.ones_like(time),))

    def _cage_course(self, motion, velocity, time):
        """Return `course` of a motion with a cage."""

        def at(motion, time):
            return self.positions(self.azimuth(time, motion), time)

        return jax.jvp(at, (motion, time), (velocity, jnp.ones_like(time)))

    def _motions(self, motion, positions):
        """Return motions of both rings at the elements, and places of the elements."""
        ring, places = self.split(motion)
        moved = (None, ring) if self.moving else (ring, None)
        outer, inner = (
            positions.motion(q, k, self.placements) for k, q in enumerate(moved)
        )
        return outer, inner, places

    def _each(self, function, motion, positions):
        """Map function(element, rings, place) over the elements at these positions."""
        outer, inner, places = self._motions(motion, positions)
        rings = outer.components, inner.components
        heights = positions.heights
        given = () if heights is None else (heights.T,)

        def one(element, outer, inner, place, *heights):
            if heights:
                element = element.with_heights(heights[0])
            return function(element, element.in_element_axes(outer, inner), place)

        return self.row.map(one, *rings, places, *given)

    def _contacts(self, motion, positions):
        """Return derivatives of the energy by both ring sections, and by places."""
        if is_written_out(self.row.element):
            given = self._motions(motion, positions)
            return ball_forces(self.row.element, *given, positions.heights)

        def element_forces(element, rings, place):
            on_rings, on_place = forces(element, rings, place)
            return [element.in_section(force) for force in on_rings], on_place

        on_rings, on_places = self._each(element_forces, motion, positions)
        return [Section(*force.T) for force in on_rings], on_places

    def on_raceways(
        self, motion: Vector, positions: ElementPositions
    ) -> tuple[Section, Section]:
        """Return reversed forces of the rolling elements on both raceways [N, N m].

        Args: as `resistance`.
        """
        (outer, inner), _ = self._contacts(motion, positions)
        return outer, inner

    def contact_forces(
        self,
        motion: Vector,
        time: Scalar,
        deviations: Float[Array, "element 2 3"] | None = None,
    ) -> Vector:
        """Return ∂E/∂(q, p) at a time [N, N m].

        Args:
            motion: Coordinates (n,) [m, rad].
            time: [s].
            deviations: Deviations at the elements [m]; `None`: those of `errors`.
        """
        azimuth = self.azimuth(time, motion)
        if deviations is not None:
            return self.resistance(
                motion,
                ElementPositions.from_azimuth(azimuth).with_deviations(deviations),
            )
        return self.resistance(motion, self.positions(azimuth, time))

    def resistance(self, motion: Vector, positions: ElementPositions) -> Vector:
        """Return ∂E/∂(q, p) at given positions [N, N m].

        Args:
            motion: Coordinates (n,) [m, rad].
            positions: Positions of the rolling elements.
        """
        return self._assembled(motion, positions, self._pressed(motion, positions))

    def _pressed(self, motion, positions) -> "_Pressed":
        """Return forces in the axes of the elements, and along normals of the cage."""
        on_rings, on_places = self._contacts(motion, positions)
        on_ring = on_rings[self.moving]
        pockets = land = None
        if self.cage is not None:
            given = self._cage_places(motion)
            pockets, land = cage_loads(self.cage, *given, positions.azimuth)
        return _Pressed(on_ring, on_places - self._of_each("force"), pockets, land)

    def _assembled(self, motion, positions, pressed: "_Pressed") -> Vector:
        """Assemble these forces on all coordinates."""
        on_ring = positions.push(pressed.on_ring, self.mass.shape[0], self.placements)
        parts = [on_ring, pressed.on_places.T.ravel()]
        cage, pockets, land = self.cage, pressed.pockets, pressed.land
        if cage is None or pockets is None or land is None:
            return jnp.concatenate(parts)
        places = *self._cage_places(motion), positions.azimuth
        found = cage_forces(pockets, land, *places)
        if RINGS.index(cage.guiding_ring) == self.moving:
            parts[0] = on_ring.at[:2].add(found.ring)
        return jnp.concatenate([*parts, found.arcs, found.cage])

    def _cage_places(self, motion):
        """Places of the cage [m, rad], of the elements along the pitch circle [m]
        and of the guiding ring [m]; and the pitch radius [m]."""
        assert self.cage is not None  # callers check it
        arcs, place = self.cage_places(motion)
        guided = RINGS.index(self.cage.guiding_ring) == self.moving
        guide = motion[:2] if guided else jnp.zeros((2,), motion.dtype)
        return place, arcs, guide, self.row.pitch_radius

    def contact_loads(
        self, motion: Vector, time: Scalar
    ) -> Float[Array, "element contact"]:
        """Return the load of every contact [N]; arguments as in `contact_forces`."""
        positions = self.positions(self.azimuth(time, motion), time)
        return self._each(DynamicElement.loads, motion, positions)

    def traction(
        self,
        cage: GuidedCage,
        motion: Vector,
        velocity: Vector,
        positions: ElementPositions,
    ) -> Each:
        """Return the traction of both raceways on every ball on its orbit [N].

        It draws the ball to the orbit on which it would roll: that of its own diameter
        and contact angle, the mean of its contacts by their loads. Between the two it
        slides, with friction on all its loads. Its turn about its own axis follows
        without delay.

        Args:
            cage: Cage of the bearing.
            motion, velocity: [m, rad], [m/s, rad/s].
            positions: Positions of the rolling elements.
        """
        outer, inner, even, _ = self.speeds
        radius = self.row.pitch_radius

        def element_traction(element, rings, place):
            load, cosine = element.load_and_cosine(rings, place)
            diameter = element.element.diameter
            own = roll_ratio(diameter, 2.0 * radius, cosine)
            return load, radius * (orbit(own, outer, inner) - even)

        load, ahead = self._each(element_traction, motion, positions)
        slip = ahead - self.cage_places(velocity)[0]
        return cage.friction * load * jnp.tanh(slip / cage.sliding_speed)

    def forces(
        self,
        motion: Vector,
        velocity: Vector,
        time: Scalar,
        start: Vector,
        course: tuple[ElementPositions, ElementPositions] | None = None,
    ) -> Vector:
        """Return the forces on all coordinates [N, N m].

        Args:
            motion, velocity: [m, rad], [m/s, rad/s].
            time: [s].
            start: Motion at which the sensor is free of force [m, rad].
            course: `course` at that time, if already known.
        """
        if course is None:
            course = self._cage_course(motion, velocity, time)
        positions, change = course
        given = (motion, positions), (velocity, change)
        pressed, rate = jax.jvp(self._pressed, *given)
        damped = jax.tree.map(lambda f, r: f + self.retardation * r, pressed, rate)
        force = -self._assembled(motion, positions, damped)
        force = force.at[: self.mass.shape[0]].add(self.load)
        if self.cage is not None:
            count = self.row.azimuth.shape[0]
            force = force.at[-3 - count : -3].add(
                self.traction(self.cage, motion, velocity, positions)
            )
            force = force.at[-3:-1].add(self.cage.load)
        if self.sensor is None:
            return force
        s = self.sensor
        pull = s.stiffness * (motion[:3] - start[:3]) + s.damping * velocity[:3]
        return force.at[:3].add(-s.projector @ pull)


class _Pressed(NamedTuple):
    """Forces of the damped contacts, reversed.

    Attributes:
        on_ring: Forces on the moving ring's raceway, in the elements' axial sections
            [N, N m].
        on_places: Forces on the elements (element, m) [N, N m].
        pockets, land: As `cage_loads` [N]; `None` without a cage.
    """

    on_ring: Annotated[Section, units("N", "N m")]
    on_places: Annotated[Float[Array, "element m"], units("N", "N m")]
    pockets: Annotated[Each | None, unit("N")]
    land: Annotated[Scalar | None, unit("N")]


def _smooth_step(share):
    """Return a smooth step from 0 at 0 to 1 at 1, with two derivatives."""
    t = jnp.clip(share, 0.0, 1.0)
    return t * t * t * (10.0 - t * (15.0 - 6.0 * t))

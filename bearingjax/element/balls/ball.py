"""One ball between its rings: its contacts with the grooves, and its orbit."""

import dataclasses
from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from ...contact.hertz import POINT_EXPONENT
from ...contact.point_law import at_angle
from ...numerics.expansion import Expansion
from ...numerics.power import positive_power
from ...numerics.types import Reals, Scalar, Vector
from ..energy import ball_energy
from ..rolling_element import AbstractRollingElement, RingMotion, Unknowns
from ..search_hints import SearchHints
from .ball_contacts import Contacts, GrooveGeometry, along_normals, angles, bend_step
from .ball_geometry import AbstractBallGeometry
from .ball_inertia import BallInertia, CarriedLoads, carried_loads
from .ball_speed import BallKinematics

_N, _D = POINT_EXPONENT


class Ball(AbstractRollingElement):
    """One ball: its grooves, contact constants and orbit.

    A contact bears 2/5 c (l - L)₊^(5/2): l is the distance of ball centre and groove
    centre, L = groove radius - ball radius. So the contact angles follow from the
    geometry and are never fixed. With small ring rotations l is the norm of an affine
    function, and the energy is convex; the grooves go on straight where they end.

    Without potential: constants that follow the operating angle (the stiffness of
    the contact is then not symmetric), and centrifugal force and gyroscopic moment at
    the operating angles (`reaction`).

    Attributes:
        grooves: Positions of the grooves.
        geometry: Motion of the ball relative to them.
        constant: Constants of the point law (contact, ...).
        ball_diameter: Ball diameter [m].
        spring: Spring constant of the tether [N/m].
        ball_inertia: Its inertia and speeds; `None`: at rest.
        follows_angle: Whether the constants follow the operating angle.

    Static: follows_angle.
    """

    grooves: GrooveGeometry
    geometry: AbstractBallGeometry
    constant: Float[Array, "contact ..."]
    ball_diameter: Scalar
    spring: Scalar
    ball_inertia: BallInertia | None
    follows_angle: bool = eqx.field(static=True)

    n_unknowns: ClassVar[int] = 2

    energy = ball_energy

    @property
    def diameter(self) -> Scalar:
        return self.ball_diameter

    @property
    def tether(self) -> Reals:
        return self.spring

    def axes(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        return self.geometry.axes(azimuth)

    def with_heights(self, heights: Float[Array, "2"]) -> "AbstractRollingElement":
        of_contacts = jnp.repeat(heights, len(self.grooves.on_outer) // 2)
        reach = self.grooves.reach - of_contacts
        grooves = dataclasses.replace(self.grooves, reach=reach)
        return dataclasses.replace(self, grooves=grooves)

    def coordinates(self, rings: RingMotion, x: Unknowns) -> Any:
        return self.geometry.travel(rings, x)

    def respond(self, coordinates: Any) -> Expansion:
        contacts = self.grooves.touch(coordinates)
        c = self.constants(contacts)
        power = positive_power(contacts.approach, _N - _D, _D)
        load = c * power * contacts.approach
        rate = (_N / _D) * c * power
        energy = (_D / (_N + _D)) * (load * contacts.approach)
        # Of a contact: its stiffness along the normal, load over length across.
        z, r = contacts.normal[:, 0], contacts.normal[:, 1]
        turn = load * contacts.inverse
        kzz = (rate - turn) * z * z + turn * contacts.mask[:, 0]
        kzr = (rate - turn) * z * r
        krr = (rate - turn) * r * r + turn * contacts.mask[:, 1]
        stiffness = jnp.stack(
            [jnp.stack([kzz, kzr], axis=1), jnp.stack([kzr, krr], axis=1)], axis=1
        )
        force = load[:, None] * contacts.normal
        if self.follows_angle:
            # The constant changes too, without work.
            slope = jax.jacfwd(lambda u: self.constants(self.grooves.touch(u)))
            change = jnp.sum(slope(coordinates), axis=1)
            stiffness = stiffness + (force / c[:, None])[:, :, None] * change[:, None]
        return Expansion(energy, force, stiffness, load)

    def contacts(self, rings: RingMotion, x: Unknowns) -> Contacts:
        """Geometry of all contacts at given motions; arguments as in `coordinates`."""
        return self.grooves.touch(self.coordinates(rings, x))

    def constants(self, contacts: Contacts) -> Float[Array, " contact"]:
        """c of every contact at its angle [N/m^(3/2)]."""
        if not self.follows_angle:
            return self.constant
        outwards = jnp.asarray(self.grooves.outwards, contacts.length.dtype)
        return at_angle(self.constant, angles(outwards[:, None] * contacts.normal))

    @property
    def has_reaction(self) -> bool:
        """Whether orbit and gyroscopic moment follow the operating angles. Static."""
        return self.ball_inertia is not None and self.ball_inertia.control.has_reaction

    def reaction(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[RingMotion, Unknowns] | None:
        if not self.has_reaction:
            return None
        now = self._carried_loads(self.contacts(rings, x))
        pushed = now.on_ball.at[1].add(now.centrifugal)
        _, back = jax.vjp(self.geometry.places, rings, x)
        return back((-pushed, -now.on_rings))

    def ball_kinematics(self, rings: RingMotion, x: Unknowns) -> BallKinematics:
        """Orbit, rotation and spin; only of a turning ball."""
        return self._carried_loads(self.contacts(rings, x)).kinematics

    def _carried_loads(self, contacts) -> CarriedLoads:
        assert self.ball_inertia is not None
        power = positive_power(contacts.approach, _N, _D)
        load = self.constants(contacts) * power
        directions = self.grooves.directions(contacts, load, self.diameter)
        return carried_loads(self.ball_inertia, *directions)

    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        return self.geometry.motion(rings, x)

    def inertia(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"] | None:
        t = self.ball_inertia
        if t is None:
            return None
        force, moment = t.centrifugal, jnp.zeros_like(t.centrifugal)
        if self.has_reaction:
            c = self._carried_loads(self.contacts(rings, x))
            force = c.centrifugal
            moment = -0.5 * self.diameter * (c.traction[0] + c.traction[1])
        moment = moment + self.geometry.lever(x) * force
        return jnp.stack([jnp.zeros_like(force), force, moment])

    @property
    def has_potential(self) -> bool:
        return not (self.follows_angle or self.has_reaction)

    @property
    def is_convex(self) -> bool:
        return self.geometry.is_linear

    @property
    def sees_difference(self) -> bool:
        # Inertia does work on the motion of both rings.
        return self.geometry.is_linear and self.ball_inertia is None

    @property
    def places_itself(self) -> bool:
        return not self.geometry.is_linear

    @property
    def n_displacements(self) -> int:
        return self.geometry.n_displacements

    @property
    def hints(self) -> SearchHints:
        return BallSearchHints(self)


class BallSearchHints(SearchHints):
    """Hints for the search of the equilibrium of a ball."""

    element: Ball

    @property
    def gap(self) -> Scalar:
        return self.element.grooves.gap

    def reach(self, rings: Any) -> Scalar:
        return self.element.geometry.reach(rings)

    def approximate_load(self, approach: Scalar) -> Scalar:
        grooves = self.element.grooves
        one = jnp.ones_like(grooves.reach)
        free = Contacts(one, one, one, grooves.free, jnp.ones_like(grooves.free))
        constant = self.element.constants(free)
        return jnp.max(constant) * positive_power(approach, _N, _D)

    def inertia_scale(self) -> Scalar | None:
        inertia = self.element.ball_inertia
        return None if inertia is None else inertia.centrifugal

    def midpoint(self, rings: Any) -> Vector:
        return self.element.geometry.midpoint(rings)

    def at_rest(self, rings: Any) -> tuple[Vector, Bool[Array, ""]] | None:
        """A turning ball that does not reach the inner ring lies in the outer one.

        From the midpoint a small centrifugal force would take it there in steps of any
        length. From the land beside the groove, on which only the tether moves it, it
        would creep: a ball that the load zone leaves may have gone on to it.
        """
        element, midway = self.element, self.midpoint(rings)
        if element.ball_inertia is None:
            return None
        start, reach = element.grooves.start, element.grooves.reach
        outer = [k for k, on_outer in enumerate(element.grooves.on_outer) if on_outer]
        centre = sum((start[k] for k in outer[1:]), start=start[outer[0]])
        aside = (start[outer[0]] - centre / len(outer))[0]
        pressed = (
            element.ball_inertia.centrifugal
            / len(outer)
            / self.approximate_load(jnp.ones_like(aside))
        )
        length = reach[outer[0]] + positive_power(pressed, _D, _N)
        height = jnp.sqrt(jnp.maximum(length**2 - aside**2, 0.0))
        target = jnp.stack([jnp.zeros_like(height), height])
        moved = element.coordinates(rings, midway)[outer[0]]
        seat = midway + target - centre / len(outer) - moved
        inner = element.contacts(rings, seat).approach[len(outer) :]
        return seat, jnp.max(inner) < 0.0

    @property
    def keeps_response(self) -> bool:
        return False

    @property
    def slots(self) -> tuple[int, int]:
        return 64, 32

    @property
    def corrects_steps(self) -> bool:
        return True

    def correct_step(self, rings: Any, x: Vector, step: Vector, size: Scalar) -> Vector:
        """Step along the groove that carries most, no deeper into others than needed.

        Straight, a step along a groove would press the ball into it by step²/(2l);
        and a step across a gap would end where the force is decades too large.
        """
        element = self.element
        c = element.contacts(rings, x)
        constant = element.constants(c)
        load = constant * positive_power(c.approach, _N, _D)
        turned = bend_step(c, load, step)
        # An open contact is entered so far that it carries the unbalanced force.
        wanted = positive_power(size, _D, _N) / positive_power(constant, _D, _N)
        reached = element.contacts(rings, x + turned).approach
        entered = (c.approach < 0.0) & (reached > wanted)
        # The approach along the step, as a parabola through both its ends.
        slope = along_normals(c, step)
        rise = wanted - c.approach
        curve = reached - c.approach - slope
        root = jnp.sqrt(jnp.maximum(slope**2 + 4.0 * curve * rise, 0.0))
        share = 2.0 * rise / jnp.where(entered, slope + root, 1.0)
        share = jnp.where(share > 0.0, jnp.minimum(share, 1.0), 1.0)
        return bend_step(c, load, step * jnp.min(jnp.where(entered, share, 1.0)))

    @property
    def may_be_ejected(self) -> bool:
        return self.element.grooves.washers or super().may_be_ejected

    def is_ejected(self, rings: Any, x: Vector) -> Bool[Array, ""]:
        away = super().is_ejected(rings, x)
        if not self.element.grooves.washers:
            return away
        # A washer's groove does not reach up to its centre: there a ball comes to rest
        # that the other washer has left, and the normal's axial part is round-off.
        c = self.element.contacts(rings, x)
        flat = jnp.abs(c.normal[:, 0]) < jnp.sqrt(jnp.finfo(x.dtype).eps)
        return away | jnp.any((c.approach > 0.0) & flat)

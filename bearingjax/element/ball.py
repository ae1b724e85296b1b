"""The strain energy of one ball between its rings: the physics, written once.

U(rings, x) = Σ_contacts 2/5 c (l - L)₊^(5/2) + guide/2 |x|². l is the distance of ball
centre and groove centre, L = groove radius - ball radius; so the contact angles follow
from the geometry and are never fixed.

With small ring rotations (`LinearisedBall`) l is the norm of an affine function, and U
is convex. Only the motion of the inner ring against the outer one counts then, seen
from the outer ring; with that ring fixed these are the textbook equations. A
`FiniteBall` follows the groove centres of rings that turn by any angle.

What has no potential goes through its own channel: contact constants that follow the
operating angle, the centrifugal force and the gyroscopic moment at the operating
angles.
"""

import abc
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..contact.hertz import EXPONENT
from ..contact.point_law import at_angle
from ..numerics.linear import dot
from ..numerics.power import positive_power
from ..numerics.types import Scalar
from .ball_contacts import Contacts, GrooveGeometry, along_normals, angles, bent
from .ball_inertia import Carried, Turning, carried
from .ball_speed import BallKinematics
from .model import AbstractModel, Rings, Unknowns

_N, _D = EXPONENT


class AbstractBallModel(AbstractModel):
    """One ball: its grooves, contact constants and how it is carried round.

    Attributes:
        grooves: Where the grooves lie.
        constant: From the point law (contact, ...).
        pitch_radius: Radius of the circle of ball centres [m].
        ball_diameter: Ball diameter [m].
        spring: Guide spring constant [N/m].
        turning: Speeds, or `None`.
        follows_angle: Whether the constants follow the operating angle.

    Static: follows_angle.
    """

    grooves: GrooveGeometry
    constant: Float[Array, "contact ..."]
    pitch_radius: Scalar
    ball_diameter: Scalar
    spring: Scalar
    turning: Turning | None
    follows_angle: bool = eqx.field(static=True)

    n_unknowns: ClassVar[int] = 2

    @abc.abstractmethod
    def moved(self, rings: Rings, x: Unknowns) -> Float[Array, "contact 2"]:
        """Motion (z, r) of the ball centre against each groove centre [m].

        Args:
            rings: Motion of the rings (r,) [m, rad].
            x: Ball centre (axial, radial) from where the rings take it [m].
        """

    @abc.abstractmethod
    def _pushed(self, rings, x, on_contacts, on_ball, on_rings, of_own) -> Array:
        """Generalised forces on (rings, x), or on x.

        From forces (z, r) against each groove (contact, 2), on the ball (2,), and on
        each ring at the ball's place (2, 3); any may be `None`.
        """

    @property
    def guide(self):
        return self.spring

    @property
    def diameter(self):
        return self.ball_diameter

    @property
    def gap(self):
        return self.grooves.gap

    @property
    def has_potential(self):
        return not (self.follows_angle or self._has_reaction)

    @property
    def _has_reaction(self):
        return self.turning is not None and self.turning.control.has_reaction

    @property
    def shapes_steps(self):
        return True

    def contacts(self, rings: Rings, x: Unknowns) -> Contacts:
        """Geometry of all contacts at given motions; arguments as of `moved`."""
        return self.grooves.touch(self.moved(rings, x))

    def constants(self, contacts: Contacts) -> Float[Array, " contact"]:
        """c of every contact at its angle [N/m^(3/2)]."""
        if not self.follows_angle:
            return self.constant
        outwards = jnp.asarray(self.grooves.outwards, contacts.length.dtype)
        return at_angle(self.constant, angles(outwards[:, None] * contacts.normal))

    def pressed(self, approach):
        one = jnp.ones_like(self.grooves.reach)
        free = self.grooves.free
        constant = self.constants(Contacts(one, one, one, free, jnp.ones_like(free)))
        return jnp.max(constant) * positive_power(approach, _N, _D)

    def first(self, rings):
        """A turning ball that does not reach the inner ring lies in the outer one.

        From amid the rings a small centrifugal force would take it there in steps
        of any length.
        """
        amid = self.amid(rings)
        if self.turning is None:
            return amid
        start, reach = self.grooves.start, self.grooves.reach
        outer = [k for k, on_outer in enumerate(self.grooves.on_outer) if on_outer]
        centre = sum((start[k] for k in outer[1:]), start=start[outer[0]])
        aside = (start[outer[0]] - centre / len(outer))[0]
        pressed = (
            self.turning.centrifugal / len(outer) / self.pressed(jnp.ones_like(aside))
        )
        length = reach[outer[0]] + positive_power(pressed, _D, _N)
        height = jnp.sqrt(jnp.maximum(length**2 - aside**2, 0.0))
        target = jnp.stack([jnp.zeros_like(height), height])
        seat = amid + target - centre / len(outer) - self.moved(rings, amid)[outer[0]]
        inner = self.contacts(rings, seat).approach[len(outer) :]
        return jnp.where(jnp.max(inner) < 0.0, seat, amid)

    def shape(self, rings, x, step, size):
        """Along the groove that carries most, and no deeper into others than needed.

        Straight, a step along a groove would press the ball into it by step²/(2l);
        and a step across a gap would end where the force is decades too large.
        """
        c = self.contacts(rings, x)
        constant = self.constants(c)
        load = constant * positive_power(c.approach, _N, _D)
        turned = bent(c, load, step)
        # An open contact is entered so far that it carries what is out of balance.
        wanted = positive_power(size, _D, _N) / positive_power(constant, _D, _N)
        reached = self.contacts(rings, x + turned).approach
        entered = (c.approach < 0.0) & (reached > wanted)
        # The approach along the step, as a parabola through both its ends.
        slope = along_normals(c, step)
        rise = wanted - c.approach
        curve = reached - c.approach - slope
        root = jnp.sqrt(jnp.maximum(slope**2 + 4.0 * curve * rise, 0.0))
        share = 2.0 * rise / jnp.where(entered, slope + root, 1.0)
        share = jnp.where(share > 0.0, jnp.minimum(share, 1.0), 1.0)
        return bent(c, load, step * jnp.min(jnp.where(entered, share, 1.0)))

    @property
    def may_leave(self):
        return self.grooves.washers or super().may_leave

    def thrown_off(self, rings, x):
        away = super().thrown_off(rings, x)
        if not self.grooves.washers:
            return away
        # A washer's groove does not reach up to its centre.
        c = self.contacts(rings, x)
        return away | jnp.any((c.approach > 0.0) & (c.mask[:, 0] == 0.0))

    def _contact_terms(self, contacts):
        """Load (contact,), their energy, forces (contact, 2), stiffness (…, 2, 2)."""
        c = self.constants(contacts)
        power = positive_power(contacts.approach, _N - _D, _D)
        load = c * power * contacts.approach
        rate = (_N / _D) * c * power
        energy = (_D / (_N + _D)) * dot(load, contacts.approach)
        # Of a contact: its stiffness along the normal, load over length across.
        z, r = contacts.normal[:, 0], contacts.normal[:, 1]
        turn = load * contacts.inverse
        kzz = (rate - turn) * z * z + turn * contacts.mask[:, 0]
        kzr = (rate - turn) * z * r
        krr = (rate - turn) * r * r + turn * contacts.mask[:, 1]
        blocks = jnp.stack(
            [jnp.stack([kzz, kzr], axis=1), jnp.stack([kzr, krr], axis=1)], axis=1
        )
        return load, energy, load[:, None] * contacts.normal, blocks

    def inertia_size(self):
        return None if self.turning is None else self.turning.centrifugal

    def kinematics(self, contacts: Contacts) -> BallKinematics:
        """Orbit, rotation and spin at given contacts; the model must be turning."""
        return self._carried(contacts).kinematics

    def _carried(self, contacts) -> Carried:
        assert self.turning is not None
        power = positive_power(contacts.approach, _N, _D)
        load = self.constants(contacts) * power
        directions = self.grooves.directions(contacts, load, self.diameter)
        return carried(self.turning, *directions)

    def inertia(self, rings, x):
        t = self.turning
        if t is None:
            return None
        zero = jnp.zeros_like(t.centrifugal)
        if not self._has_reaction:
            return jnp.stack([zero, t.centrifugal, zero])
        c = self._carried(self.contacts(rings, x))
        moment = -0.5 * self.diameter * (c.traction[0] + c.traction[1])
        return jnp.stack([zero, c.centrifugal, moment])

    def _without_potential(self, rings, x, of_own):
        """Forces that no energy gives, and what they add to the tangent.

        Of a contact whose constant follows its angle the force is in the gradient
        already, and here adds the change of its constant to the tangent alone.
        """
        now = self.contacts(rings, x)
        c = self.constants(now)
        power = positive_power(now.approach, _N, _D)[:, None] * now.normal

        def channel(change):
            beside = rings if of_own else rings + change[:-2]
            x_beside = x + change[-2:]
            near = self.contacts(beside, x_beside)
            on_contacts = on_ball = on_rings = None
            if self.follows_angle:
                on_contacts = (self.constants(near) - c)[:, None] * power
            if self._has_reaction:
                reaction = self._carried(near)
                push = reaction.on_ball.at[1].add(reaction.centrifugal)
                on_ball, on_rings = -push, -reaction.on_rings
            pushes = on_contacts, on_ball, on_rings
            return self._pushed(beside, x_beside, *pushes, of_own)

        size = 2 if of_own else rings.shape[0] + 2
        at = jnp.zeros((size,), x.dtype)
        return channel(at), jax.jacfwd(channel)(at)

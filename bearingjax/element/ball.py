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
from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..contact.hertz import EXPONENT
from ..contact.point_law import AbstractPointLaw, at_angle, balls_of
from ..design.ball import ThrustBallBearing
from ..design.bearing_set import SetRow
from ..numerics.implicit import stop
from ..numerics.linear import dot
from ..numerics.power import positive_power
from ..numerics.types import Scalar
from .ball_contacts import Contacts, GrooveGeometry, add, along_normals, bent
from .ball_inertia import Carried, Turning, carried, turning
from .ball_speed import AbstractRacewayControl, BallKinematics
from .constants import GUIDE
from .frame import section_matrix, turn_factors
from .inertia import Speed
from .kinematics import AbstractKinematics, Finite
from .model import AbstractModel, Derivatives, Rings, Unknowns

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
        washers: Whether the raceways are those of a thrust bearing.

    Static: follows_angle, washers.
    """

    grooves: GrooveGeometry
    constant: Float[Array, "contact ..."]
    pitch_radius: Scalar
    ball_diameter: Scalar
    spring: Scalar
    turning: Turning | None
    follows_angle: bool = eqx.field(static=True)
    washers: bool = eqx.field(static=True)

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
        z, r = outwards * contacts.normal[:, 0], outwards * contacts.normal[:, 1]
        return at_angle(self.constant, jnp.arctan2(z, r))

    def pressed(self, approach):
        start = self.grooves.start
        normal = start / jnp.sqrt(jnp.sum(start**2, axis=1))[:, None]
        one = jnp.ones_like(self.grooves.reach)
        constant = self.constants(Contacts(one, one, one, normal, one))
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

    def thrown_off(self, rings, x):
        away = super().thrown_off(rings, x)
        if not self.washers:
            return away
        # A washer's groove does not reach up to its centre.
        c = self.contacts(rings, x)
        return away | jnp.any((c.approach > 0.0) & (c.mask == 0.0))

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
        kzz = (rate - turn) * z * z + turn * contacts.mask
        kzr = (rate - turn) * z * r
        krr = (rate - turn) * r * r + turn
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


class LinearisedBall(AbstractBallModel):
    """A ball between rings that turn by small angles. Convex.

    `rings` are the inner ring's motion against the outer one at the ball's place
    (3,), or, turning, both rings' motions (6,). x counts from the mean of the rings.

    Attributes:
        lever: Part of the motion of an inner groove centre from the ring's tilt,
            subtracted (contact, 2) [m/rad]; zero at the outer ring.
    """

    lever: Float[Array, "contact 2"]

    def transform(self, azimuth):
        shift = jnp.eye(3, dtype=self.diameter.dtype).at[0, 2].set(-self.pitch_radius)
        section = shift @ section_matrix(azimuth)
        if self.turning is None:
            return jnp.concatenate([-section, section], axis=1)
        zero = jnp.zeros_like(section)
        return jnp.block([[section, zero], [zero, section]])

    def _between(self, rings):
        """Motion of the inner ring against the outer one, at the ball centre."""
        return rings if self.turning is None else rings[3:] - rings[:3]

    def reach(self, rings):
        between = self._between(rings)
        lever = jnp.max(jnp.abs(self.lever))
        moved = jnp.abs(between[0]) + jnp.abs(between[1])
        return moved + lever * jnp.abs(between[2])

    def motion(self, rings, x, outer):
        between = self._between(rings)
        # Without speed `rings` know only the motion against the outer ring.
        u = outer[0] - self.pitch_radius * outer[2] + 0.5 * between[0] + x[0]
        v = outer[1] + 0.5 * between[1] + x[1]
        return jnp.stack([u, v, jnp.zeros_like(u)])

    def moved(self, rings, x):
        between = self._between(rings)
        moved = self._sides()[:, None] * between[None, :2] + x[None, :]
        return moved + self.lever * between[2]

    def _sides(self):
        sides = [0.5 * outwards for outwards in self.grooves.outwards]
        return jnp.asarray(sides, self.diameter.dtype)

    def derivatives(self, rings, x, of_own=False):
        contacts = self.contacts(rings, x)
        load, energy, force, blocks = self._contact_terms(contacts)
        energy = energy + 0.5 * self.guide * dot(x, x)
        kzz, kzr, krr = blocks[:, 0, 0], blocks[:, 0, 1], blocks[:, 1, 1]

        def matrix(*rows):
            return jnp.stack([jnp.stack(row) for row in rows])

        pzz, pzr, prr = add(kzz) + self.guide, add(kzr), add(krr) + self.guide
        hessian = own = matrix([pzz, pzr], [pzr, prr])
        gradient = self._generalised(force[:, 0], force[:, 1], of_own)
        gradient = gradient + self.guide * jnp.pad(x, (gradient.shape[0] - 2, 0))
        if not of_own:
            s, (lz, lr) = self._sides(), (self.lever[:, 0], self.lever[:, 1])
            # Per contact: d(moved)/d(between) = [s 0 lz; 0 s lr], d(moved)/dx = 1.
            tz, tr = kzz * lz + kzr * lr, kzr * lz + krr * lr
            stz, str_ = add(s * tz), add(s * tr)
            # s² is a quarter.
            ring = matrix(
                [0.25 * add(kzz), 0.25 * add(kzr), stz],
                [0.25 * add(kzr), 0.25 * add(krr), str_],
                [stz, str_, add(lz * tz + lr * tr)],
            )
            side = matrix(
                [add(s * kzz), add(s * kzr)],
                [add(s * kzr), add(s * krr)],
                [add(tz), add(tr)],
            )
            hessian = self._expanded(ring, side, own)
        if self.turning is not None and not self._has_reaction:
            pull = self._on_all(jnp.stack([0.0 * x[0], self.turning.centrifugal]))
            gradient = gradient - (pull[-2:] if of_own else pull)
            raised = 0.5 * (rings[1] + rings[4]) + x[1]
            energy = energy - self.turning.centrifugal * raised
        if not self.has_potential:
            extra, jacobian = self._without_potential(rings, x, of_own)
            gradient, hessian = gradient + extra, hessian + jacobian
        return Derivatives(energy, gradient, hessian, load)

    def _generalised(self, fz, fr, of_own):
        """Forces on (rings, x), or on x, from forces at the contacts (contact,)."""
        own = jnp.stack([add(fz), add(fr)])
        if of_own:
            return own
        s = self._sides()
        tilt = add(self.lever[:, 0] * fz + self.lever[:, 1] * fr)
        between = jnp.stack([add(s * fz), add(s * fr), tilt])
        rings = [between] if self.turning is None else [-between, between]
        return jnp.concatenate([*rings, own])

    def _expanded(self, ring, side, own):
        """Stiffness for (rings, x) from that for (between, x)."""
        if self.turning is None:
            return jnp.block([[ring, side], [side.T, own]])
        return jnp.block(
            [[ring, -ring, -side], [-ring, ring, side], [-side.T, side.T, own]]
        )

    def _on_all(self, force):
        """A force on the ball (2,), as generalised force on (rings, x)."""
        # x counts from the mean of the rings: half of the force on each.
        half = jnp.pad(0.5 * force, (0, 1))
        return jnp.concatenate([half, half, force])

    def _pushed(self, rings, x, on_contacts, on_ball, on_rings, of_own):
        size = 2 if of_own else rings.shape[0] + 2
        out = jnp.zeros((size,), x.dtype)
        if on_contacts is not None:
            out = out + self._generalised(on_contacts[:, 0], on_contacts[:, 1], of_own)
        if on_ball is not None:
            out = out + (on_ball if of_own else self._on_all(on_ball))
        if on_rings is not None and not of_own:
            out = out + jnp.pad(on_rings.reshape(-1), (0, 2))
        return out


class FiniteBall(AbstractBallModel):
    """A ball between rings that turn by any angle: groove centres move exactly.

    `rings` are both rings' displacements and rotation vectors at the node, seen in
    axes (radial, tangential, axial) at the ball's azimuth (12,). The ball stays in
    that axial section of the outer ring's node; x counts from there. Forces are
    conjugate to the rotation vectors: moments about the axes for small tilts, and
    about the axis of a tilt of any size.

    A ring is a body of revolution: only its axis e = R z counts, and of the ball its
    height along that axis and its distance from it.

    Attributes:
        along: z of the circle of ball centres from the node [m].
        inner_offset: Place of the inner raceway along its own axis, from the
            drawing's [m].
    """

    along: Scalar
    inner_offset: Scalar

    @property
    def is_convex(self):
        return False

    @property
    def places_itself(self):
        return True

    def transform(self, azimuth):
        c, s = jnp.cos(azimuth), jnp.sin(azimuth)
        o, i = jnp.zeros_like(c), jnp.ones_like(c)
        rows = [[c, s, o], [-s, c, o], [o, o, i]]
        turn = jnp.stack([jnp.stack(row) for row in rows])
        # A body of revolution does not feel a turn about its own axis.
        tilt = turn.at[2, 2].set(0.0)
        return jax.scipy.linalg.block_diag(turn, tilt, turn, tilt)

    def _against(self, seen):
        """Motion (z, r) of the ball in the axes of a ring.

        `seen` (5,): displacement (radial, tangential, axial) of the ball against the
        ring's node, and the tilts gx, gy of the ring.
        """
        x, y, z, gx, gy = seen
        radius, along = self.pitch_radius, self.along
        sine, versine = turn_factors(gx * gx + gy * gy)
        lift = -versine * (gx * gx + gy * gy)
        axial = sine * (gy * (radius + x) - gx * y) + lift * (along + z) + z
        # r² - R² without cancellation.
        change = x * (2.0 * radius + x) + y * y + z * (2.0 * along + z)
        change = change - axial * (2.0 * along + axial)
        away = jnp.sqrt(radius * radius + change)
        return jnp.stack([axial, change / (away + radius)])

    def _maps(self):
        """What `_against` sees of (rings, x), for both rings (2, 5, 14)."""
        maps = np.zeros((2, 5, 14))
        for ring in (0, 1):
            maps[ring, 0, 13] = maps[ring, 2, 12] = 1.0
            maps[ring, 3, 6 * ring + 3] = maps[ring, 4, 6 * ring + 4] = 1.0
        for k in range(3):
            maps[1, k, k], maps[1, k, 6 + k] = 1.0, -1.0
        return jnp.asarray(maps, self.along.dtype)

    def moved(self, rings, x):
        both = jax.vmap(self._against)(self._maps() @ jnp.concatenate([rings, x]))
        both = both.at[1, 0].add(-self.inner_offset)
        return jnp.repeat(both, len(self.grooves.on_outer) // 2, axis=0)

    def amid(self, rings):
        between = rings[6:9] - rings[:3]
        gx, gy = rings[9], rings[10]
        sine, versine = turn_factors(gx * gx + gy * gy)
        z = between[2] - sine * gy * self.pitch_radius
        z = z - versine * (gx * gx + gy * gy) * self.along
        r = between[0] + sine * gy * self.along - versine * gy * gy * self.pitch_radius
        return jnp.stack([z, r])

    def reach(self, rings):
        return jnp.max(jnp.sum(jnp.abs(self.moved(rings, self.amid(rings))), axis=1))

    def motion(self, rings, x, outer):
        return jnp.stack([rings[2] + x[0], rings[0] + x[1], jnp.zeros_like(x[0])])

    def inertia(self, rings, x):
        out = super().inertia(rings, x)
        return None if out is None else out.at[2].add(self.along * out[1])

    def derivatives(self, rings, x, of_own=False):
        contacts = self.contacts(rings, x)
        load, energy, force, blocks = self._contact_terms(contacts)
        # The guide has no reaction on the rings: it is no part of the bearing.
        off = x - stop(self.amid(rings))
        energy = energy + 0.5 * self.guide * dot(off, off)
        y = jnp.concatenate([rings, x])
        size = 2 if of_own else 14
        own = jnp.pad(jnp.ones_like(x), (size - 2, 0))
        gradient = self.guide * jnp.pad(off, (size - 2, 0))
        hessian = self.guide * jnp.diag(own)
        # Of each ring: forces and stiffness of its contacts, and how they turn.
        f = jnp.sum(force.reshape(2, -1, 2), axis=1)
        stiff = jnp.sum(blocks.reshape(2, -1, 2, 2), axis=1)
        maps = self._maps()
        slope = jax.vmap(jax.jacfwd(self._against))(maps @ y)
        curve = jax.vmap(jax.jacfwd(jax.jacfwd(self._against)))(maps @ y)
        k = jnp.einsum("kai,kab,kbj->kij", slope, stiff, slope)
        k = k + jnp.einsum("ka,kaij->kij", f, curve)
        maps = maps[:, :, -size:]
        gradient = gradient + jnp.einsum("kai,kab,kbj->j", f[:, :, None], slope, maps)
        hessian = hessian + jnp.einsum("kai,kab,kbj->ij", maps, k, maps)
        if self.turning is not None and not self._has_reaction:
            pull = jnp.stack([0.0 * x[0], self.turning.centrifugal])
            gradient = gradient - self._on_ball(pull, of_own)
            energy = energy - self.turning.centrifugal * (rings[0] + x[1])
        if not self.has_potential:
            extra, jacobian = self._without_potential(rings, x, of_own)
            gradient, hessian = gradient + extra, hessian + jacobian
        return Derivatives(energy, gradient, hessian, load)

    def _on_ball(self, force, of_own):
        if of_own:
            return force
        zero = jnp.zeros_like(force[0])
        node = jnp.stack([force[1], zero, force[0]])
        return jnp.concatenate([node, jnp.zeros((9,), force.dtype), force])

    def _pushed(self, rings, x, on_contacts, on_ball, on_rings, of_own):
        size = 2 if of_own else 14
        out = jnp.zeros((size,), x.dtype)
        if on_contacts is not None:
            _, back = jax.vjp(lambda x, rings: self.moved(rings, x), x, rings)
            own, on_these = back(on_contacts)
            out = own if of_own else jnp.concatenate([on_these, own])
        if on_ball is not None:
            out = out + self._on_ball(on_ball, of_own)
        if on_rings is not None and not of_own:
            for k in (0, 1):
                axial, radial, moment = on_rings[k]
                moment = moment - self.pitch_radius * axial + self.along * radial
                pushes = jnp.stack([radial, 0.0 * radial, axial, 0.0 * radial, moment])
                out = out.at[6 * k : 6 * k + 5].add(pushes)
        return out


def ball_model(
    part: SetRow,
    law: AbstractPointLaw,
    kinematics: AbstractKinematics,
    speed: Speed | None,
    control: AbstractRacewayControl,
    deviation: Scalar | None = None,
) -> AbstractBallModel:
    """Everything that the energy of one ball needs.

    Args:
        part: The row, of balls, and its place.
        law: Law of the contact constants.
        kinematics: `Linearised()` or `Finite()`.
        speed: Ring speeds or `None`.
        control: Raceway control.
        deviation: Diameter of this ball less the common one [m].
    """
    bearing: Any = part.bearing
    diameter = bearing.ball_diameter
    balls, grooves = balls_of(bearing), bearing.grooves
    if deviation is not None:
        diameter = diameter + deviation
        balls = balls._replace(diameter=diameter)
    centres = jnp.stack([jnp.stack([g.axial, g.radial]) for g in grooves])
    inertia = None if speed is None else turning(bearing, diameter, speed, control)
    common: dict[str, Any] = dict(
        grooves=GrooveGeometry(
            start=-centres,
            reach=jnp.stack([g.radius - 0.5 * diameter for g in grooves]),
            on_outer=tuple(g.on_outer for g in grooves),
            open_side=tuple(g.open_side for g in grooves),
        ),
        constant=law.constants(balls, grooves, bearing.free_cosine),
        pitch_radius=0.5 * bearing.pitch_diameter,
        ball_diameter=diameter,
        spring=_guide(balls, diameter),
        turning=inertia,
        follows_angle=law.follows_angle,
        washers=isinstance(bearing, ThrustBallBearing),
    )
    if isinstance(kinematics, Finite):
        sign = -1.0 if part.mirrored else 1.0
        along = bearing.axial_place + sign * part.position
        return FiniteBall(along=along, inner_offset=sign * part.inner_offset, **common)
    # Motion of an inner groove centre less that of the ball's place, per tilt.
    lever = jnp.stack([centres[:, 1], -centres[:, 0]], axis=1)
    inner = jnp.asarray([0.0 if g.on_outer else 1.0 for g in grooves], diameter.dtype)
    return LinearisedBall(lever=inner[:, None] * lever, **common)


def _guide(balls, diameter):
    # A raceway contact pressed by a ten-thousandth of the ball diameter, E* D^(1/2).
    return GUIDE * balls.modulus * diameter * 1e-2

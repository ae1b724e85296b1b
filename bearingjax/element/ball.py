"""The strain energy of one ball between its rings: the physics, written once.

U(rings, x) = Σ_contacts 2/5 c (l - L)₊^(5/2) + guide/2 |x|². l is the distance of ball
centre and groove centre, L = groove radius - ball radius; so the contact angles follow
from the geometry and are never fixed. With small ring rotations l is the norm of an
affine function, and U is convex.

Only the motion of the inner ring against the outer one counts, seen from the outer
ring; with that ring fixed these are the textbook equations. What has no potential goes
through its own channel: contact constants that follow the operating angle, the
centrifugal force and the gyroscopic moment at the operating angles.
"""

from typing import ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..contact.hertz import EXPONENT
from ..contact.point_law import AbstractPointLaw, at_angle, balls_of
from ..design.ball import AbstractBallBearing
from ..numerics.linear import dot
from ..numerics.power import positive_power
from ..numerics.types import Scalar
from .ball_speed import (
    MOST_FRICTION,
    AbstractRacewayControl,
    BallKinematics,
    ball_kinematics,
    ball_mass,
)
from .constants import GUIDE
from .frame import roll_ratio, section_matrix
from .inertia import Speed
from .model import AbstractModel, Derivatives, Rings, Unknowns

_N, _D = EXPONENT


class Turning(NamedTuple):
    """What a turning ball needs to know.

    Attributes:
        speed: Ring speeds.
        control: Raceway control.
        ratio: γ = D/d_m [1].
        centrifugal: Centrifugal force at the free contact angle [N].
        mass: Mass of the ball [kg].
        moment: Its moment of inertia [kg m²].
    """

    speed: Speed
    control: AbstractRacewayControl
    ratio: Scalar
    centrifugal: Scalar
    mass: Scalar
    moment: Scalar


class Contacts(NamedTuple):
    """Contacts of one ball at given motions, each array with the axis contact.

    Attributes:
        approach: l - L [m].
        length: l, above zero [m].
        normal: Unit vector (z, r) from groove centre to ball centre (contact, 2).
        mask: 0 where the axial part counts for nothing (cylinder), else 1.
    """

    approach: Float[Array, " contact"]
    length: Float[Array, " contact"]
    normal: Float[Array, "contact 2"]
    mask: Float[Array, " contact"]


class BallModel(AbstractModel):
    """One ball: its grooves, contact constants and how it is carried round.

    Attributes:
        start: Vector (z, r) from each groove centre to the ball centre, unloaded
            (contact, 2) [m].
        reach_of: L of each groove (contact,) [m].
        lever: Part of the motion of an inner groove centre from the ring's tilt,
            subtracted (contact, 2) [m/rad]; zero at the outer ring.
        constant: From the point law (contact, ...).
        pitch_radius: Radius of the circle of ball centres [m].
        ball_diameter: Ball diameter [m].
        spring: Guide spring constant [N/m].
        turning: Speeds, or `None`.
        on_outer: Which contacts belong to the outer ring.
        open_side: Which raceways are cylinders beyond the groove bottom.
        follows_angle: Whether the constants follow the operating angle.

    Static: on_outer, open_side, follows_angle.
    """

    start: Float[Array, "contact 2"]
    reach_of: Float[Array, " contact"]
    lever: Float[Array, "contact 2"]
    constant: Float[Array, "contact ..."]
    pitch_radius: Scalar
    ball_diameter: Scalar
    spring: Scalar
    turning: Turning | None
    on_outer: tuple[bool, ...] = eqx.field(static=True)
    open_side: tuple[bool, ...] = eqx.field(static=True)
    follows_angle: bool = eqx.field(static=True)

    n_unknowns: ClassVar[int] = 2

    @property
    def guide(self):
        return self.spring

    @property
    def diameter(self):
        return self.ball_diameter

    @property
    def gap(self):
        square = jnp.sum(self.start**2, axis=1)
        return jnp.max(jnp.abs(jnp.sqrt(square) - self.reach_of))

    @property
    def has_potential(self):
        return not (self.follows_angle or self._has_reaction)

    @property
    def _has_reaction(self):
        return self.turning is not None and self.turning.control.has_reaction

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

    def first(self, rings):
        """A turning ball that does not reach the inner ring lies in the outer one.

        From amid the rings a small centrifugal force would take it there in steps
        of any length.
        """
        amid = super().first(rings)
        if self.turning is None:
            return amid
        outer = [k for k, on_outer in enumerate(self.on_outer) if on_outer]
        centre = sum((self.start[k] for k in outer[1:]), start=self.start[outer[0]])
        aside = (self.start[outer[0]] - centre / len(outer))[0]
        pressed = (
            self.turning.centrifugal / len(outer) / self.pressed(jnp.ones_like(aside))
        )
        length = self.reach_of[outer[0]] + positive_power(pressed, _D, _N)
        height = jnp.sqrt(jnp.maximum(length**2 - aside**2, 0.0))
        target = jnp.stack([jnp.zeros_like(height), height])
        seat = target - centre / len(outer) - 0.5 * self._between(rings)[:2]
        inner = self.contacts(rings, seat).approach[len(outer) :]
        return jnp.where(jnp.max(inner) < 0.0, seat, amid)

    @property
    def shapes_steps(self):
        return True

    def shape(self, rings, x, step, size):
        """Along the groove that carries most, and no deeper into others than needed.

        Straight, a step along a groove would press the ball into it by step²/(2l);
        and a step across a gap would end where the force is decades too large.
        """
        c = self.contacts(rings, x)
        constant = self.constants(c)
        load = constant * positive_power(c.approach, _N, _D)
        bent = _bent(c, load, step)
        # An open contact is entered so far that it carries what is out of balance.
        wanted = positive_power(size / constant, _D, _N)
        reached = self.contacts(rings, x + bent).approach
        entered = (c.approach < 0.0) & (reached > wanted)
        # The approach along the step, as a parabola through both its ends.
        slope = _across(c.normal, step)
        rise = wanted - c.approach
        curve = reached - c.approach - slope
        root = jnp.sqrt(jnp.maximum(slope**2 + 4.0 * curve * rise, 0.0))
        share = 2.0 * rise / jnp.where(entered, slope + root, 1.0)
        share = jnp.where(share > 0.0, jnp.minimum(share, 1.0), 1.0)
        return _bent(c, load, step * jnp.min(jnp.where(entered, share, 1.0)))

    def pressed(self, approach):
        normal = self.start / jnp.sqrt(jnp.sum(self.start**2, axis=1))[:, None]
        one = jnp.ones_like(self.reach_of)
        constant = self.constants(Contacts(one, one, normal, one))
        return jnp.max(constant) * positive_power(approach, _N, _D)

    def inertia_size(self):
        return None if self.turning is None else self.turning.centrifugal

    def motion(self, rings, x, outer):
        between = self._between(rings)
        # Without speed `rings` know only the motion against the outer ring.
        u = outer[0] - self.pitch_radius * outer[2] + 0.5 * between[0] + x[0]
        v = outer[1] + 0.5 * between[1] + x[1]
        return jnp.stack([u, v, jnp.zeros_like(u)])

    def contacts(self, rings: Rings, x: Unknowns) -> Contacts:
        """Geometry of all contacts at given motions.

        Args:
            rings: Motion of both rings, or of the inner against the outer one.
            x: Ball centre from the mean of both rings (axial, radial) [m].
        """
        between = self._between(rings)
        moved = self._sides()[:, None] * between[None, :2] + x[None, :]
        moved = moved + self.lever * between[2]
        vector = self.start + moved
        along = jnp.asarray(self._outwards(), x.dtype) * vector[:, 0]
        beyond = jnp.asarray(self.open_side) & (along < 0)
        mask = jnp.where(beyond, 0.0, 1.0)
        # From groove centre to ball centre; what does not count is left out.
        z, r = mask * vector[:, 0], vector[:, 1]
        square = z * z + r * r
        tiny = jnp.finfo(x.dtype).tiny
        length = jnp.sqrt(jnp.maximum(square, tiny))
        # (l² - L²)/(l + L) without the cancellation, where the start is known.
        start2 = jnp.sum(self.start**2, axis=1) - self.reach_of**2
        change = jnp.sum(moved * (2.0 * self.start + moved), axis=1)
        difference = jnp.where(beyond, square - self.reach_of**2, start2 + change)
        approach = difference / (length + self.reach_of)
        normal = jnp.stack([z / length, r / length], axis=1)
        return Contacts(approach, length, normal, mask)

    def _sides(self):
        return jnp.asarray(
            [0.5 if o else -0.5 for o in self.on_outer], self.start.dtype
        )

    def _outwards(self):
        return [1.0 if o else -1.0 for o in self.on_outer]

    def constants(self, contacts: Contacts) -> Float[Array, " contact"]:
        """c of every contact at its angle [N/m^(3/2)]."""
        if not self.follows_angle:
            return self.constant
        outwards = jnp.asarray(self._outwards(), contacts.length.dtype)
        return at_angle(self.constant, outwards * contacts.normal[:, 1])

    def directions(
        self, contacts: Contacts, load: Float[Array, " contact"]
    ) -> tuple[Float[Array, "2 2"], Float[Array, "2"]]:
        """Where a ball rolls on each raceway, and its load there.

        On two arcs it rolls on the one that it presses more deeply; while both are
        pressed within a thousandth of its diameter of each other, in between.

        Args:
            contacts: From `contacts`.
            load: Load of each contact [N].

        Returns:
            Unit vectors (sin α, cos α) (2, 2), outer and inner, and loads (2,) [N],
            of two arcs their sum.
        """
        vectors = jnp.asarray(self._outwards(), load.dtype)[:, None] * contacts.normal
        normals, loads = [], []
        for ring in (True, False):
            mine = [k for k, on_outer in enumerate(self.on_outer) if on_outer is ring]
            if len(mine) == 1:
                normals.append(vectors[mine[0]])
                loads.append(load[mine[0]])
                continue
            first, second = mine
            deeper = contacts.approach[first] - contacts.approach[second]
            t = jnp.clip(0.5 + deeper / (2e-3 * self.diameter), 0.0, 1.0)
            share = t * t * (3.0 - 2.0 * t)
            mean = share * vectors[first] + (1.0 - share) * vectors[second]
            normals.append(mean / jnp.sqrt(dot(mean, mean)))
            loads.append(load[first] + load[second])
        return jnp.stack(normals), jnp.stack(loads)

    def derivatives(self, rings, x, of_own=False):
        contacts = self.contacts(rings, x)
        c = self.constants(contacts)
        power = positive_power(contacts.approach, _N - _D, _D)
        load = c * power * contacts.approach
        rate = (_N / _D) * c * power
        energy = (_D / (_N + _D)) * dot(load, contacts.approach)
        energy = energy + 0.5 * self.guide * dot(x, x)
        # Of a contact: its stiffness along the normal, load over length across.
        z, r = contacts.normal[:, 0], contacts.normal[:, 1]
        turn = load / contacts.length
        kzz = (rate - turn) * z * z + turn * contacts.mask
        kzr = (rate - turn) * z * r
        krr = (rate - turn) * r * r + turn
        fz, fr = load * z, load * r

        def matrix(*rows):
            return jnp.stack([jnp.stack(row) for row in rows])

        pzz, pzr, prr = _sum(kzz) + self.guide, _sum(kzr), _sum(krr) + self.guide
        hessian = own = matrix([pzz, pzr], [pzr, prr])
        gradient = self._generalised(fz, fr, of_own)
        gradient = gradient + self.guide * jnp.pad(x, (gradient.shape[0] - 2, 0))
        if not of_own:
            s, (lz, lr) = self._sides(), (self.lever[:, 0], self.lever[:, 1])
            # Per contact: d(vector)/d(between) = [s 0 lz; 0 s lr], d(vector)/dx = 1.
            tz, tr = kzz * lz + kzr * lr, kzr * lz + krr * lr
            stz, str_ = _sum(s * tz), _sum(s * tr)
            # s² is a quarter.
            ring = matrix(
                [0.25 * _sum(kzz), 0.25 * _sum(kzr), stz],
                [0.25 * _sum(kzr), 0.25 * _sum(krr), str_],
                [stz, str_, _sum(lz * tz + lr * tr)],
            )
            side = matrix(
                [_sum(s * kzz), _sum(s * kzr)],
                [_sum(s * kzr), _sum(s * krr)],
                [_sum(tz), _sum(tr)],
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
        own = jnp.stack([_sum(fz), _sum(fr)])
        if of_own:
            return own
        s = self._sides()
        tilt = _sum(self.lever[:, 0] * fz + self.lever[:, 1] * fr)
        between = jnp.stack([_sum(s * fz), _sum(s * fr), tilt])
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

    def _without_potential(self, rings, x, of_own):
        """Forces that no energy gives, and what they add to the tangent.

        Of a contact whose constant follows its angle the force is in the gradient
        already, and here adds the change of its constant to the tangent alone.
        """
        now = self.contacts(rings, x)
        c = self.constants(now)
        power = positive_power(now.approach, _N, _D)[:, None] * now.normal

        def channel(moved):
            beside = rings if of_own else rings + moved[:-2]
            near = self.contacts(beside, x + moved[-2:])
            out = jnp.zeros_like(moved)
            if self.follows_angle:
                change = self.constants(near) - c
                force = change[:, None] * power
                out = out + self._generalised(force[:, 0], force[:, 1], of_own)
            if self._has_reaction:
                inertia = self._inertia_forces(near)
                out = out - (inertia[-2:] if of_own else inertia)
            return out

        size = 2 if of_own else rings.shape[0] + 2
        at = jnp.zeros((size,), x.dtype)
        return channel(at), jax.jacfwd(channel)(at)

    def kinematics(self, contacts: Contacts) -> BallKinematics:
        """Orbit, rotation and spin at given contacts; the model must be turning."""
        return self._carried(contacts)[0]

    def _carried(self, contacts):
        """Kinematics, normals of both raceways and tractions there."""
        t = self.turning
        assert t is not None
        power = positive_power(contacts.approach, _N, _D)
        normals, loads = self.directions(contacts, self.constants(contacts) * power)
        # In balance the outer raceway carries the centrifugal force at least; on the
        # way there shares must not jump where a ball in flight first touches.
        least = jnp.maximum(loads[0], 0.1 * t.centrifugal)
        shared = jnp.stack([least, loads[1]])
        share = t.control.rolling_share(shared)
        kinematics = ball_kinematics(normals[0], normals[1], share, t.ratio, t.speed)
        demand = 2.0 / self.diameter * gyroscopic_moment(t.moment, kinematics)
        # Whatever the control says, no contact holds more than friction lets it.
        most = MOST_FRICTION * loads
        traction = jnp.clip(t.control.traction(shared, demand), -most, most)
        return kinematics, normals, traction

    def _inertia_forces(self, contacts):
        """Centrifugal force and tractions, as generalised forces on (rings, x).

        A traction T acts on the ball along (-cos α, sin α) at the outer raceway and
        opposite to it at the inner one, and back on the ring at the ball's surface.
        """
        t = self.turning
        assert t is not None
        kinematics, normals, traction = self._carried(contacts)
        centrifugal = self.pitch_radius * t.mass * kinematics.orbit**2
        across = jnp.stack([-normals[:, 1], normals[:, 0]], axis=1)
        signed = jnp.stack([traction[0], -traction[1]])
        on_ball = signed[:, None] * across
        total = on_ball[0] + on_ball[1]
        total = total.at[1].add(centrifugal)
        turn = -0.5 * self.diameter * traction[:, None]
        on_rings = jnp.concatenate([-on_ball, turn], axis=1).reshape(-1)
        return self._on_all(total) + jnp.pad(on_rings, (0, 2))

    def inertia(self, rings, x):
        t = self.turning
        if t is None:
            return None
        zero = jnp.zeros_like(t.centrifugal)
        if not self._has_reaction:
            return jnp.stack([zero, t.centrifugal, zero])
        kinematics, _, traction = self._carried(self.contacts(rings, x))
        moment = -0.5 * self.diameter * (traction[0] + traction[1])
        force = self.pitch_radius * t.mass * kinematics.orbit**2
        return jnp.stack([zero, force, moment])


def _across(normals, step):
    """Part of a step along each normal."""
    return normals[:, 0] * step[0] + normals[:, 1] * step[1]


def _bent(c: Contacts, load, step):
    """The step, turned along the circle around the centre of the busiest groove."""
    chosen = (load == jnp.max(load)) & (load > 0.0) & (c.mask > 0.0)
    weight = jnp.where(chosen, 1.0, 0.0)
    weight = weight / jnp.maximum(_sum(weight), 1.0)
    normal = _sum(weight[:, None] * c.normal)
    length = _sum(weight * c.length)
    along = dot(normal, step)
    new = length * normal + step
    size = jnp.sqrt(jnp.maximum(dot(new, new), jnp.finfo(step.dtype).tiny))
    # new/size·(length + along) - length·normal, without cancellation.
    across2 = jnp.maximum(dot(step, step) - along * along, 0.0)
    short = across2 / (size + length + along)
    bends = (length + along > 0.0) & (length > 0.0)
    return jnp.where(bends, step - short / size * new, step)


def gyroscopic_moment(
    moment_of_inertia: Float[Array, "..."], kinematics: BallKinematics
) -> Float[Array, "..."]:
    """Moment that turns the ball's axis with its orbit, I ω_c ω_R sin β [N m].

    Args:
        moment_of_inertia: Of the ball [kg m²].
        kinematics: Of the ball.
    """
    k = kinematics
    return moment_of_inertia * k.orbit * k.rotation * k.axis[..., 0]


def ball_model(
    bearing: AbstractBallBearing,
    law: AbstractPointLaw,
    speed: Speed | None,
    control: AbstractRacewayControl,
    deviation: Scalar | None = None,
) -> BallModel:
    """Everything that the energy of one ball needs.

    Args:
        bearing: The design.
        law: Law of the contact constants.
        speed: Ring speeds or `None`.
        control: Raceway control.
        deviation: Diameter of this ball less the common one [m].
    """
    diameter = bearing.ball_diameter
    balls, grooves = balls_of(bearing), bearing.grooves
    if deviation is not None:
        diameter = diameter + deviation
        balls = balls._replace(diameter=diameter)
    constant = law.constants(balls, grooves, bearing.free_cosine)
    centres = jnp.stack([jnp.stack([g.axial, g.radial]) for g in grooves])
    # Motion of an inner groove centre less that of the ball's place, per tilt.
    lever = jnp.stack([centres[:, 1], -centres[:, 0]], axis=1)
    inner = jnp.asarray([0.0 if g.on_outer else 1.0 for g in grooves], diameter.dtype)
    pitch = bearing.pitch_diameter
    return BallModel(
        start=-centres,
        reach_of=jnp.stack([g.radius - 0.5 * diameter for g in grooves]),
        lever=inner[:, None] * lever,
        constant=constant,
        pitch_radius=0.5 * pitch,
        ball_diameter=diameter,
        spring=_guide(balls, diameter),
        turning=_turning(bearing, diameter, speed, control),
        on_outer=tuple(g.on_outer for g in grooves),
        open_side=tuple(g.open_side for g in grooves),
        follows_angle=law.follows_angle,
    )


def _guide(balls, diameter):
    # A raceway contact pressed by a ten-thousandth of the ball diameter, E* D^(1/2).
    return GUIDE * balls.modulus * diameter * 1e-2


def _turning(bearing, diameter, speed, control):
    if speed is None:
        return None
    mass, moment = ball_mass(diameter, bearing.material.density)
    ratio = roll_ratio(diameter, bearing.pitch_diameter, bearing.free_cosine)
    orbit = 0.5 * ((1.0 - ratio) * speed.inner + (1.0 + ratio) * speed.outer)
    centrifugal = 0.5 * bearing.pitch_diameter * mass * orbit**2
    gamma = diameter / bearing.pitch_diameter
    return Turning(speed, control, gamma, centrifugal, mass, moment)


def _sum(terms):
    """Sum over the contacts, written out so that it fuses."""
    total = terms[0]
    for k in range(1, terms.shape[0]):
        total = total + terms[k]
    return total

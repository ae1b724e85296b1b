"""Contact constants of one roller, from the dimensions on the drawing.

All quantities are in the roller's own axes: t along the roller axis, m across it
(outwards), origin at the roller centre.
"""

import dataclasses

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..contact.hertz import sphere_constant
from ..contact.line import AbstractLineLaw, relative_radius
from ..contact.line_contact import AbstractLineContact, LineContact
from ..design import AbstractRollerBearing, contact_modulus
from ..design.profile import sagitta
from ..numerics.quadrature import AbstractQuadrature
from ..numerics.types import Reals, Scalar
from .frame import from_roller_axes, to_roller_axes
from .rolling_element import RingMotion, Unknowns

# The tether spring, relative to the stiffness of a raceway contact (about 1e-6 N/m). It
# keeps a direction regular in which nothing else holds the roller. A roller that is
# held by no more than the tether is loose and passes nothing (`equilibrium.is_loose`).
TETHER = 1e-14


class RibContacts(eqx.Module):
    """The ribs that exist, stacked in their fixed order.

    Attributes:
        constant: c of Q = c approach^(3/2) (rib,) [N/m^(3/2)].
        gap: Gap along the normal, unloaded (rib,) [m].
        normal: Unit normal from roller to rib in (t, m) (rib, 2).
        centre: Centre of the end sphere in (t, m) (rib, 2) [m].
        point: Contact point on the rib in (t, m) (rib, 2) [m].
        names: Which ribs these are.

    Static: names.
    """

    constant: Float[Array, " rib"]
    gap: Float[Array, " rib"]
    normal: Float[Array, "rib 2"]
    centre: Float[Array, "rib 2"]
    point: Float[Array, "rib 2"]
    names: tuple[str, ...] = eqx.field(static=True)

    @property
    def on_outer(self) -> tuple[bool, ...]:
        """Whether each rib belongs to the outer ring."""
        return tuple(name.startswith("outer") for name in self.names)


class ContactConstants(eqx.Module):
    """All contacts of one roller of a bearing.

    Attributes:
        lines: Contact with the outer and with the inner raceway.
        tables: Quadrature tables of both.
        ribs: Rib contacts, or `None`.
        axis_angle: Angle of the roller axis to the bearing axis [rad].
        half_angle: Half cone angle of the roller [rad].
        pitch_radius: Radius of the circle of roller centres [m].
        diameter: Mean roller diameter [m].
        half_length: Half the roller length [m].
        gap: Gap at the outer and the inner raceway, unloaded and centred (2,) [m].
        tether: Tether spring constant [N/m].
        density: Density of the roller [kg/m³].
        modulus: Contact modulus E* of roller and ring [Pa].
        axial_place: z of the roller centres from the origin of the row [m].
        arc_radii: Radii of the arcs along the generators of roller, outer and inner
            raceway [m]; `None`: straight generators.
    """

    lines: tuple[AbstractLineContact, AbstractLineContact]
    tables: tuple
    ribs: RibContacts | None
    axis_angle: Scalar
    half_angle: Scalar
    pitch_radius: Scalar
    diameter: Scalar
    half_length: Scalar
    gap: Float[Array, "2"]
    tether: Scalar
    density: Scalar
    modulus: Scalar
    axial_place: Scalar
    arc_radii: tuple[Scalar, Scalar, Scalar] | None

    @property
    def to_axes(self) -> Float[Array, "3 3"]:
        """Roller axes from the section motion of a body, `frame.to_roller_axes`."""
        return to_roller_axes(self.axis_angle, self.pitch_radius, self.axial_place)

    @property
    def from_axes(self) -> Float[Array, "3 3"]:
        """Inverse of `to_axes`."""
        return from_roller_axes(self.axis_angle, self.pitch_radius, self.axial_place)

    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        """Motion (t, m, θ) of the roller in its own axes [m, m, rad].

        Args:
            rings: Motions of the rings in roller axes [m, rad].
            x: Its unknowns, from the mean of the rings, tilt times L/2 (3,) [m].
        """
        one = jnp.ones_like(self.half_length)
        return rings.mean + x * jnp.stack([one, one, 1.0 / self.half_length])


def contact_constants(
    bearing: AbstractRollerBearing,
    line_law: AbstractLineLaw,
    quadrature: AbstractQuadrature,
    deviation: Scalar | None = None,
    *,
    exact: bool = False,
) -> ContactConstants:
    """Constants of every contact of a roller.

    Args:
        bearing: The design.
        line_law: Law that gives the line constant.
        quadrature: Rule whose tables are wanted.
        deviation: Mean diameter of this roller less the common one [m]; the raceways
            stay where they are.
        exact: Whether raceways that are arcs keep their shape when they move. Static.

    Returns:
        Constants, differentiable with respect to every real number of the design.
    """
    length, diameter = bearing.roller_length, bearing.roller_diameter
    gap, arcs = jnp.repeat(bearing.gap, 2), bearing.arc_radii
    if deviation is not None:
        diameter = diameter + deviation
        gap = gap - 0.5 * deviation * jnp.cos(bearing.half_angle)
    constant = line_law.constant(bearing.material, bearing.rings, length)

    def line(ring, raceway_profile):
        return LineContact(
            constant,
            length,
            diameter,
            bearing.roller_profile,
            raceway_profile,
            arc_radii=None if arcs is None else (arcs[0], arcs[1 + ring]),
            exact=exact and arcs is not None,
        )

    raceways = bearing.outer_raceway_profile, bearing.inner_raceway_profile
    lines = line(0, raceways[0]), line(1, raceways[1])
    # Stiffness of a contact pressed by a ten-thousandth of the roller diameter.
    stiffness = constant * length * (1e-4 * diameter) ** (1.0 / 9.0)
    constants = ContactConstants(
        lines=lines,
        tables=(),
        ribs=_rib_contacts(bearing),
        axis_angle=bearing.axis_angle,
        half_angle=bearing.half_angle,
        pitch_radius=0.5 * bearing.pitch_diameter,
        diameter=diameter,
        half_length=0.5 * length,
        gap=gap,
        tether=TETHER * stiffness,
        density=bearing.material.density,
        modulus=contact_modulus(bearing.material, bearing.rings),
        axial_place=bearing.axial_place,
        arc_radii=arcs,
    )

    def radius(raceway):
        return lambda position: relative_radii(constants, position)[raceway]

    contacts = [
        line_law.contact(line, radius(k), constants.modulus)
        for k, line in enumerate(lines)
    ]
    tables = tuple(contact.table(quadrature) for contact in contacts)
    return dataclasses.replace(
        constants, lines=(contacts[0], contacts[1]), tables=tables
    )


def _rib_contacts(bearing):
    names = bearing.ribs.present
    if not names:
        return None
    modulus = contact_modulus(bearing.material, bearing.rings)
    parts = [_rib_geometry(bearing, name) for name in names]
    normal, centre, point = (jnp.stack(part) for part in zip(*parts, strict=True))
    ribs = [getattr(bearing.ribs, name) for name in names]
    return RibContacts(
        constant=jnp.stack([sphere_constant(r.end_radius, modulus) for r in ribs]),
        gap=jnp.stack([r.axial_gap for r in ribs]),
        normal=normal,
        centre=centre,
        point=point,
        names=names,
    )


def _rib_geometry(bearing, name):
    """Normal, sphere centre and contact point of one rib in (t, m).

    With S the centre of the sphere, E the end of the raceway generator and ρ the
    direction of the rib, the height of the contact above E is (S - E)·ρ, because the
    normal through S is square to ρ. That equation gives the angle of ρ.
    """
    rib = getattr(bearing.ribs, name)
    side = -1.0 if name.endswith("minus") else 1.0
    ring = 1.0 if name.startswith("outer") else -1.0
    half = bearing.half_angle
    s, arcs = 0.5 * side * bearing.roller_length, bearing.arc_radii
    along = s * jnp.cos(half)
    radius = 0.5 * bearing.roller_diameter - s * jnp.sin(half)
    centre = jnp.stack([along - side * rib.end_radius, jnp.zeros_like(along)])
    drop = 0.0 if arcs is None else sagitta(s, arcs[1 if ring > 0 else 2])
    edge = jnp.stack(
        [along - drop * jnp.sin(half), ring * (radius - drop * jnp.cos(half))]
    )
    # From the edge to the sphere centre: `inwards` into the row, `up` along m.
    inwards = side * (edge[0] - centre[0])
    up = ring * (edge[1] - centre[1])
    # ρ = (ring-side coordinates) leaves the raceway towards the roller axis:
    # -ring m turned by `angle`, so that (S - E)·ρ = up cos + inwards sin.
    reach = jnp.sqrt(inwards**2 + up**2)
    angle = jnp.arcsin(rib.contact_height / reach) - jnp.arctan2(up, inwards)
    normal = jnp.stack([side * jnp.cos(angle), -ring * jnp.sin(angle)])
    point = centre + (rib.end_radius + rib.axial_gap) * normal
    return normal, centre, point


def relative_radii(
    constants: ContactConstants, position: Reals
) -> Float[Array, "2 ..."]:
    """Radius of relative curvature along both raceway contacts.

    Args:
        constants: From `contact_constants`.
        position: Positions s along the generator [m].

    Returns:
        ρ at the outer and the inner raceway [m]; the sections of tapers and barrels are
        taken square to their generators.
    """
    c, leans = constants, [constants.half_angle] * 3
    drop = jnp.zeros_like(position)
    if c.arc_radii is not None:
        # Angles of the generators there to those of the middle.
        leans = [c.half_angle + jnp.arcsin(position / r) for r in c.arc_radii]
        drop = sagitta(position, c.arc_radii[0])
    sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
    along = position * cos - drop * sin
    roller = 0.5 * c.diameter - position * sin - drop * cos
    radii = []
    for ring, lean in ((1.0, leans[1]), (-1.0, leans[2])):
        race = (
            c.pitch_radius
            - along * jnp.sin(c.axis_angle)
            + ring * roller * jnp.cos(c.axis_angle)
        )
        race_radius = race / jnp.cos(c.axis_angle + ring * lean)
        radii.append(relative_radius(roller / jnp.cos(leans[0]), -ring * race_radius))
    return jnp.stack(radii)

"""Approach of a line contact of finite length: the formulas of the literature.

A line contact between half-spaces has no approach of its own; each author closes the
problem in another way: by the length of the roller, by the size of the bodies, or by
measurement. The formulas differ among themselves by up to 60 %. They are here to be
compared, with one another and with `contact.halfspace`; bearings use the laws of
`contact.line`.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design.checks import check, positive
from ..design.material import Material, contact_modulus
from ..numerics.types import Scalar, as_real
from .line import half_width, relative_radius


class LineBodies(eqx.Module):
    """A roller and a raceway in line contact.

    Attributes:
        length: Length of the contact L [m].
        roller_radius: Radius of the roller normal to the contact line [m].
        raceway_radius: Radius of the raceway likewise, positive where the raceway is
            convex (inner ring), negative where it is concave (outer ring), infinite
            for a plane [m].
        ring_thickness: Thickness of the ring under a raceway that is not convex, or
            `None` [m]. A convex raceway counts as a solid cylinder, and does without.
        roller, ring: Materials.

    Traced: all fields.
    """

    length: Scalar = eqx.field(converter=as_real)
    roller_radius: Scalar = eqx.field(converter=as_real)
    raceway_radius: Scalar = eqx.field(converter=as_real)
    ring_thickness: Scalar | None = eqx.field(
        converter=as_real, default=None, kw_only=True
    )
    roller: Material = eqx.field(default_factory=Material, kw_only=True)
    ring: Material = eqx.field(default_factory=Material, kw_only=True)

    def __check_init__(self):
        positive(self, "length", self.length, "m")
        positive(self, "roller_radius", self.roller_radius, "m")
        outside = (self.raceway_radius > 0) | (
            self.raceway_radius < -self.roller_radius
        )
        check(
            self,
            "raceway_radius",
            self.raceway_radius,
            "m",
            outside,
            "positive (convex) or, if negative (concave), larger than the roller's",
        )
        if self.ring_thickness is not None:
            positive(self, "ring_thickness", self.ring_thickness, "m")

    def half_width(self, load: Float[Array, "..."]) -> Float[Array, "..."]:
        """Half width b of the contact under an even line load (Hertz) [m].

        Args:
            load: Load ≥ 0 [N].
        """
        radius = relative_radius(self.roller_radius, self.raceway_radius)
        modulus = contact_modulus(self.roller, self.ring)
        return half_width(load / self.length, radius, modulus)


def lundberg(load: Float[Array, "..."], bodies: LineBodies) -> Float[Array, "..."]:
    """Lundberg's approach, of half-spaces under an even load along the length.

    delta = 2Q/(π L E*) (ln(L/(2b)) + 2 ln 2 + 1/2). The roller it belongs to has
    Lundberg's profile; one with square ends is stiffer.

    Args:
        load: Load Q; the approach is zero where it is not positive [N].
        bodies: Roller and raceway.

    Returns:
        Approach [m].

    Source: Lundberg (1939), Forschung auf dem Gebiete des Ingenieurwesens 10; the
        constant derived, 1.8864 as printed.
    """
    load, loaded = _positive(load)
    modulus = contact_modulus(bodies.roller, bodies.ring)
    logarithm = jnp.log(2.0 * bodies.length / bodies.half_width(load)) + 0.5
    approach = 2.0 * load / (jnp.pi * bodies.length * modulus) * logarithm
    return jnp.where(loaded, approach, 0.0)


def dinnik(load: Float[Array, "..."], bodies: LineBodies) -> Float[Array, "..."]:
    """Dinnik's approach of two cylinders, ln(2R/b) + 1/3 for each body.

    delta = 2Q/L Σ (1-ν²)/(π E) (ln(d/b) + 1/3), d the diameter of a cylinder or the
    thickness of a ring.

    Args:
        load: Load Q; the approach is zero where it is not positive [N].
        bodies: Roller and raceway.

    Returns:
        Approach [m].

    Raises:
        ValueError: If the raceway is not convex and has no thickness.

    Source: Dinnik, after Teutsch & Sauer (2004), J. Tribol. 126, table 1, of which we
        have values, not the text: for two cylinders as in Young & Roark, Roark's
        Formulas for Stress and Strain (1989); that a ring counts by its thickness
        rests on the values for one ring of 6 mm.
    """
    return _of_bodies(load, bodies, _cylinder(1.0 / 3.0), _cylinder(1.0 / 3.0))


def kowalsky(load: Float[Array, "..."], bodies: LineBodies) -> Float[Array, "..."]:
    """Kowalsky's approach of two cylinders, ln(2R/b) + 0.407 for each body.

    As `dinnik`, with 0.407 in place of 1/3.

    Args:
        load: Load Q; the approach is zero where it is not positive [N].
        bodies: Roller and raceway.

    Returns:
        Approach [m].

    Raises:
        ValueError: If the raceway is not convex and has no thickness.

    Source: Kowalsky, after Teutsch & Sauer (2004), J. Tribol. 126, table 1, of which
        we have values, not the text: they give the constant as 0.40700; for a ring as
        `dinnik`.
    """
    return _of_bodies(load, bodies, _cylinder(0.407), _cylinder(0.407))


def tripp(load: Float[Array, "..."], bodies: LineBodies) -> Float[Array, "..."]:
    """Tripp's approach: a cylinder to its axis, a ring to the depth of its thickness.

    delta = 2Q/L Σ (1-ν²)/(π E) c: c = ln(4R/b) - 1/2 of a cylinder, and of a ring
    c = ln(2t/b) - ν/(2(1-ν)); plane strain.

    Args:
        load: Load Q; the approach is zero where it is not positive [N].
        bodies: Roller and raceway.

    Returns:
        Approach [m].

    Raises:
        ValueError: If the raceway is not convex and has no thickness.

    Source: Tripp (1985), NASA TP 2473, after Teutsch & Sauer (2004), J. Tribol. 126,
        table 1, whose values it gives; the terms as in Johnson, Contact Mechanics
        (1985), section 5.6.
    """

    def layer(depth, width, material):
        nu = material.poisson_ratio
        return jnp.log(2.0 * depth / width) - 0.5 * nu / (1.0 - nu)

    return _of_bodies(load, bodies, _cylinder(jnp.log(2.0) - 0.5), layer)


def palmgren_steel(
    load: Float[Array, "..."], bodies: LineBodies
) -> Float[Array, "..."]:
    """Palmgren's approach of steel on steel: 3.84e-5 Q^0.9/L^0.8 (mm, N).

    Steel alone: materials and radii of `bodies` do not enter. `contact.Palmgren` is
    the form for any material.

    Args:
        load: Load Q; the approach is zero where it is not positive [N].
        bodies: Roller and raceway.

    Returns:
        Approach [m].

    Source: Palmgren (1959); Harris and Kotzalas, Rolling Bearing Analysis.
    """
    return _of_steel(load, bodies, 3.84e-5, 0.9, 0.8)


def kunert_steel(load: Float[Array, "..."], bodies: LineBodies) -> Float[Array, "..."]:
    """Kunert's approach of steel on steel: 4.05e-5 Q^0.925/L^0.85 (mm, N).

    Steel alone: materials and radii of `bodies` do not enter.

    Args:
        load: Load Q; the approach is zero where it is not positive [N].
        bodies: Roller and raceway.

    Returns:
        Approach [m].

    Source: Kunert (1961), Forschung auf dem Gebiete des Ingenieurwesens 27.
    """
    return _of_steel(load, bodies, 4.05e-5, 0.925, 0.85)


LINE_FORMULAS = {
    "lundberg": lundberg,
    "dinnik": dinnik,
    "kowalsky": kowalsky,
    "palmgren_steel": palmgren_steel,
    "kunert_steel": kunert_steel,
    "tripp": tripp,
}
"""The formulas by name; each takes load and bodies, and gives the approach."""


def _positive(load):
    """Load, one where it is not positive, and where it is; NaN passes through."""
    loaded = ~(load <= 0)
    return jnp.where(loaded, load, 1.0), loaded


def _cylinder(constant):
    """ln(2R/b) + constant, of a cylinder as deep as its diameter."""
    return lambda depth, width, _: jnp.log(depth / width) + constant


def _of_bodies(load, bodies, cylinder, ring):
    """2Q/L Σ (1-ν²)/(π E) c, c by the diameter, or by the thickness of a ring."""
    load, loaded = _positive(load)
    width = bodies.half_width(load)
    radius = bodies.raceway_radius
    convex = (radius > 0) & jnp.isfinite(radius)
    of_ring = cylinder(2.0 * jnp.where(convex, radius, 1.0), width, bodies.ring)
    if bodies.ring_thickness is None:
        check(
            bodies,
            "raceway_radius",
            radius,
            "m",
            convex,
            "positive and finite where `ring_thickness` is not given",
        )
        of_ring = jnp.where(convex, of_ring, jnp.nan)
    else:
        thin = ring(bodies.ring_thickness, width, bodies.ring)
        of_ring = jnp.where(convex, of_ring, thin)
    of_roller = cylinder(2.0 * bodies.roller_radius, width, bodies.roller)
    terms = _softness(bodies.roller) * of_roller + _softness(bodies.ring) * of_ring
    return jnp.where(loaded, 2.0 * load / bodies.length * terms, 0.0)


def _softness(material):
    """(1-ν²)/(π E) [1/Pa]."""
    return (1.0 - material.poisson_ratio**2) / (jnp.pi * material.elastic_modulus)


def _of_steel(load, bodies, constant, exponent, of_length):
    load, loaded = _positive(load)
    approach = constant * load**exponent / (1e3 * bodies.length) ** of_length
    return jnp.where(loaded, 1e-3 * approach, 0.0)

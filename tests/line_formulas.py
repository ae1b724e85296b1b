"""Approach of a line contact of finite length: the formulas of the literature.

A line contact between half-spaces has no approach of its own; each author closes the
problem in another way: by the length of the roller, by the size of the bodies, or by
measurement. The formulas differ among themselves by up to 60 %. They are here to be
compared with one another, with the half-space solver and with the package's line laws.

All take the load [N] and the bodies, and give the approach [m], in NumPy.
"""

from dataclasses import dataclass, field

import jax.numpy as jnp
import numpy as np

import bearingjax as bj
from bearingjax.contact import half_width, relative_radius


@dataclass(frozen=True)
class LineBodies:
    """A roller and a raceway in line contact.

    Attributes:
        length: Length of the contact L [m].
        roller_radius: Radius of the roller normal to the contact line [m].
        raceway_radius: Radius of the raceway likewise, positive where the raceway is
            convex (inner ring), negative where it is concave (outer ring), infinite
            for a plane [m].
        ring_thickness: Thickness of the ring under a raceway that is not convex [m].
            A convex raceway counts as a solid cylinder, and does without.
        roller, ring: Materials.
    """

    length: float
    roller_radius: float
    raceway_radius: float
    ring_thickness: float = np.nan
    roller: bj.Material = field(default_factory=bj.Material)
    ring: bj.Material = field(default_factory=bj.Material)

    def half_width(self, load):
        """Half width b of the contact under an even line load (Hertz) [m]."""
        radii = jnp.asarray(self.roller_radius), jnp.asarray(self.raceway_radius)
        compliance = np.pi * (_compliance(self.roller) + _compliance(self.ring))
        line_load = jnp.asarray(load) / self.length
        modulus = jnp.asarray(1.0 / compliance)
        return np.asarray(half_width(line_load, relative_radius(*radii), modulus))


def lundberg(load, bodies):
    """Half-spaces under an even load: 2Q/(π L E*) (ln(L/(2b)) + 2 ln 2 + 1/2).

    The roller it belongs to has Lundberg's profile; one with square ends is stiffer.

    Source: Lundberg (1939), Forschung auf dem Gebiete des Ingenieurwesens 10; the
        constant derived, 1.8864 as printed.
    """
    compliance = _compliance(bodies.roller) + _compliance(bodies.ring)
    logarithm = np.log(2.0 * bodies.length / bodies.half_width(load)) + 0.5
    return 2.0 * load / bodies.length * compliance * logarithm


def dinnik(load, bodies):
    """Two cylinders: 2Q/L Σ (1-ν²)/(π E) (ln(d/b) + 1/3).

    d is the diameter of a cylinder or the thickness of a ring.

    Source: Dinnik, after Teutsch & Sauer (2004), J. Tribol. 126, table 1, of which we
        have values, not the text: for two cylinders as in Young & Roark, Roark's
        Formulas for Stress and Strain (1989); that a ring counts by its thickness
        rests on the values for one ring of 6 mm.
    """
    return _of_bodies(load, bodies, 1.0 / 3.0, lambda nu: 1.0 / 3.0)


def kowalsky(load, bodies):
    """As `dinnik`, with 0.407 in place of 1/3.

    Source: Kowalsky, after Teutsch & Sauer (2004), J. Tribol. 126, table 1, of which
        we have values, not the text: they give the constant as 0.40700; for a ring as
        `dinnik`.
    """
    return _of_bodies(load, bodies, 0.407, lambda nu: 0.407)


def tripp(load, bodies):
    """A cylinder to its axis, a ring to the depth of its thickness t; plane strain.

    2Q/L Σ (1-ν²)/(π E) c, with c = ln(4R/b) - 1/2 of a cylinder, and of a ring
    c = ln(2t/b) - ν/(2(1-ν)).

    Source: Tripp (1985), NASA TP 2473, after Teutsch & Sauer (2004), J. Tribol. 126,
        table 1, whose values it gives; the terms as in Johnson, Contact Mechanics
        (1985), section 5.6.
    """
    two = np.log(2.0)
    return _of_bodies(load, bodies, two - 0.5, lambda nu: two - 0.5 * nu / (1.0 - nu))


def palmgren_steel(load, bodies):
    """Steel on steel: 3.84e-5 Q^0.9/L^0.8 (mm, N). Radii do not enter.

    Source: Palmgren (1959); Harris and Kotzalas, Rolling Bearing Analysis.
    """
    return 3.84e-8 * load**0.9 / (1e3 * bodies.length) ** 0.8


def kunert_steel(load, bodies):
    """Steel on steel: 4.05e-5 Q^0.925/L^0.85 (mm, N). Radii do not enter.

    Source: Kunert (1961), Forschung auf dem Gebiete des Ingenieurwesens 27.
    """
    return 4.05e-8 * load**0.925 / (1e3 * bodies.length) ** 0.85


LINE_FORMULAS = {
    "lundberg": lundberg,
    "dinnik": dinnik,
    "kowalsky": kowalsky,
    "palmgren_steel": palmgren_steel,
    "kunert_steel": kunert_steel,
    "tripp": tripp,
}


def _of_bodies(load, bodies, of_cylinder, of_ring):
    """2Q/L Σ (1-ν²)/(π E) (ln(d/b) + constant)."""
    width, radius = bodies.half_width(load), bodies.raceway_radius
    roller = np.log(2.0 * bodies.roller_radius / width) + of_cylinder
    if 0 < radius < np.inf:
        ring = np.log(2.0 * radius / width) + of_cylinder
    else:
        constant = of_ring(float(bodies.ring.poisson_ratio))
        ring = np.log(bodies.ring_thickness / width) + constant
    terms = _compliance(bodies.roller) * roller + _compliance(bodies.ring) * ring
    return 2.0 * load / bodies.length * terms


def _compliance(material):
    """(1-ν²)/(π E) [1/Pa]."""
    modulus, nu = float(material.elastic_modulus), float(material.poisson_ratio)
    return (1.0 - nu**2) / (np.pi * modulus)

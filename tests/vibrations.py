"""Small vibrating systems of the tests."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

import bearingjax as bj
from bearingjax.design import Material
from bearingjax.numerics.power import positive_power
from bearingjax.numerics.types import as_real
from bearingjax.rotor.nonlinear import Grooves, RigidRotor, VibratingSystem, rigid_rotor


class Spring(eqx.Module):
    """Force of one freedom: linear, cubic, and with a stiffness that varies."""

    cubic: jax.Array
    varying: jax.Array

    def __call__(self, q, velocity, phase, frequency):
        return (1.0 + self.varying * jnp.cos(phase)) * q + self.cubic * q**3


class Contact(eqx.Module):
    """Hertz contact under a load that it opens without."""

    def __call__(self, q, velocity, phase, frequency):
        return (positive_power(1.0 + q, 3, 2) - 1.0) / 1.5


class Cosine(eqx.Module):
    """Harmonic load of one freedom."""

    force: jax.Array

    def __call__(self, phase, frequency, acceleration):
        return (self.force * jnp.cos(phase))[None]


def oscillator(restoring, force=0.0, damping_ratio=0.0):
    """One freedom of mass one."""
    return VibratingSystem(
        mass=np.eye(1),
        damping=2.0 * damping_ratio * np.eye(1),
        gyroscopic=np.zeros((1, 1)),
        restoring=restoring,
        load=Cosine(jnp.asarray(force)),
        scale=np.ones(1),
        reference_frequency=1.0,
    )


def duffing(cubic=0.05, force=0.2, damping_ratio=0.05):
    """Hardening; two folds."""
    spring = Spring(jnp.asarray(cubic), jnp.asarray(0.0))
    return oscillator(spring, force, damping_ratio)


ROTOR = RigidRotor(
    length=0.5,
    shaft_diameter=0.025,
    density=7850.0,
    disc_mass=10.0,
    disc_polar_inertia=0.2,
    disc_diametral_inertia=0.1,
    disc_position=0.125,
)
OUTER = {12: 27.5125, 15: 27.5167, 26: 27.5399, 36: 27.5709, 40: 27.5858}
"""Radius of the outer groove [mm] for each contact angle [deg]."""


def grooves(angle):
    """The bearing of method 002 with a contact angle in degrees."""
    return Grooves(
        inner_radius=16e-3,
        outer_radius=1e-3 * OUTER[angle],
        groove_radius=5.93e-3,
        ball_diameter=11.51e-3,
        contact_angle=np.radians(angle),
        n_balls=7,
        material=Material(2.1e11, 0.3),
    )


def of_drawing(angle):
    """The same bearing as the library has it; its free angle follows from its radii."""
    conformity = 5.93 / 11.51
    radial = 16.0 + 2.0 * 5.93 - OUTER[angle]
    return bj.AngularContactBallBearing(
        7,
        1e-3 * (16.0 + OUTER[angle]),
        11.51e-3,
        outer_osculation=conformity,
        inner_osculation=conformity,
        contact_angle=np.arccos(radial / (2.0 * 5.93 - 11.51)),
        material=bj.Material(2.1e11, 0.3, 7850.0),
    )


def rotor(angle=36, **given):
    """The rotor of method 002 on two such bearings."""
    law, given = grooves(angle).fixed_angle(), jax.tree.map(as_real, given)
    return _rotor(law, **given)


@eqx.filter_jit
def _rotor(law, **given):
    return rigid_rotor(ROTOR, law, law, scale=law.preload_displacement, **given)

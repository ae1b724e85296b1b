"""A rigid rotor with a disc on two opposed preloaded bearings, five freedoms.

Freedoms: x1, y1 at bearing A (ζ = 0), x2, y2 at bearing B (ζ = l), and z [m].

Source: Filipkovskii & Belomyttsev (2014), section 2; see the method's matrices for the
    signs, which make a forward whirl stiffer.
"""

from typing import Annotated, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.checks import positive
from ...numerics.lapack import cholesky, congruent, eigh
from ...numerics.types import Number, Real, Scalar, as_real
from ...numerics.units import real, unit
from ..damping import ModalDamping
from .support_law import AbstractSupportLaw
from .system import HarmonicLoad, VibratingSystem


class RigidRotor(eqx.Module):
    """Shaft and disc.

    Attributes:
        length: Distance of the bearings, l [m].
        shaft_diameter: d [m].
        density: Density of the shaft [kg/m³].
        disc_mass: m0 [kg].
        disc_polar_inertia: I0 [kg m²].
        disc_diametral_inertia: I1 [kg m²].
        disc_position: ζ1, from bearing A [m].

    Traced: all fields.
    """

    length: Real = eqx.field(**real("m"))
    shaft_diameter: Real = eqx.field(**real("m"))
    density: Real = eqx.field(**real("kg/m³"))
    disc_mass: Real = eqx.field(**real("kg"))
    disc_polar_inertia: Real = eqx.field(**real("kg m²"))
    disc_diametral_inertia: Real = eqx.field(**real("kg m²"))
    disc_position: Real = eqx.field(**real("m"))

    def __check_init__(self):
        for name in ("length", "shaft_diameter", "density", "disc_mass"):
            positive(self, name)

    def shares(self) -> Float[Array, "2"]:
        """Motion of the disc's centre over that at either bearing, N1 and N2 [1]."""
        far = self.disc_position / self.length
        return jnp.stack([1.0 - far, far])

    def _section(self):
        """Mass [kg] of the shaft, and ρ I l of its section [kg m²]."""
        area = 0.25 * jnp.pi * self.shaft_diameter**2
        mass = self.density * area * self.length
        return mass, mass * self.shaft_diameter**2 / 16.0

    def mass(self) -> Float[Array, "5 5"]:
        """Mass matrix [kg]."""
        shaft, section = self._section()
        shares = self.shares()
        turning = (section + self.disc_diametral_inertia) / self.length**2
        plane = (
            shaft / 6.0 * jnp.asarray(np.array([[2.0, 1.0], [1.0, 2.0]]))
            + turning * jnp.asarray(_OPPOSED)
            + self.disc_mass * jnp.outer(shares, shares)
        )
        both = jnp.kron(plane, jnp.eye(2))
        return jax.scipy.linalg.block_diag(both, (shaft + self.disc_mass)[None, None])

    def gyroscopic(self) -> Float[Array, "5 5"]:
        """Gyroscopic matrix over the speed [kg]."""
        _, section = self._section()
        polar = (self.disc_polar_inertia + 2.0 * section) / self.length**2
        both = jnp.kron(polar * jnp.asarray(_OPPOSED), jnp.asarray(_SKEW))
        return jax.scipy.linalg.block_diag(both, jnp.zeros((1, 1)))


_OPPOSED = np.array([[1.0, -1.0], [-1.0, 1.0]])
_SKEW = np.array([[0.0, 1.0], [-1.0, 0.0]])


class OpposedPair(eqx.Module):
    """Restoring forces of two bearings mounted in opposition.

    Attributes:
        a, b: Laws of the bearings at A and B; +z preloads A and relieves B.
    """

    a: AbstractSupportLaw
    b: AbstractSupportLaw

    def potential(self, q: Float[Array, "5"]) -> Scalar:
        """Return the strain energy of both bearings [J]; q in m."""
        x1, y1, x2, y2, z = q
        at_a, at_b = jnp.stack([x1, y1, z]), jnp.stack([x2, y2, -z])
        return self.a.potential(at_a) + self.b.potential(at_b)

    def __call__(self, q, velocity, phase, frequency):
        return jax.grad(self.potential)(q)


class Natural(NamedTuple):
    """Natural frequencies of the rotor at rest.

    Attributes:
        radial: Natural frequencies of either plane (2,) [rad/s].
        axial: [rad/s].
    """

    radial: Annotated[Float[Array, "2"], unit("rad/s")]
    axial: Annotated[Scalar, unit("rad/s")]


def natural_frequencies(
    mass: Float[Array, "5 5"], stiffness: Float[Array, "5 5"]
) -> Natural:
    """Return natural frequencies at rest, for bearings isotropic in all planes.

    Args:
        mass: Mass matrix [kg].
        stiffness: Stiffness matrix [N/m].
    """
    plane = jnp.asarray(np.array([0, 2]))
    m = mass[plane][:, plane]
    squares, _ = eigh(congruent(cholesky(m), stiffness[plane][:, plane]))
    return Natural(jnp.sqrt(squares), jnp.sqrt(stiffness[4, 4] / mass[4, 4]))


def rigid_rotor(
    rotor: RigidRotor,
    a: AbstractSupportLaw,
    b: AbstractSupportLaw,
    *,
    scale: Number,
    damping_ratio: Number = 0.01,
    unbalance: Number = 0.0,
    base_acceleration: Number = 0.0,
    speed: Number | None = None,
) -> VibratingSystem:
    """Create the system of the rotor on its bearings for `solve_orbit` and `follow`.

    Args:
        rotor: Shaft and disc.
        a, b: Laws of both bearings.
        scale: Displacement that is called one, such as z0 [m].
        damping_ratio: Damping ratio of every mode at rest [1].
        unbalance: m0·e at the disc [kg m].
        base_acceleration: Amplitude of the base's acceleration along y [m/s²].
        speed: Speed of the rotor [rad/s]; `None`: that of the excitation.
    """
    mass, pair = rotor.mass(), OpposedPair(a, b)
    stiffness = jax.hessian(pair.potential)(jnp.zeros(5))
    natural = natural_frequencies(mass, stiffness)
    undamped = mass, stiffness
    return VibratingSystem(
        mass=mass,
        damping=ModalDamping(damping_ratio).matrix(undamped, undamped),
        gyroscopic=rotor.gyroscopic(),
        restoring=pair,
        load=_load(rotor, mass, as_real(unbalance), as_real(base_acceleration)),
        scale=jnp.broadcast_to(as_real(scale), (5,)),
        reference_frequency=natural.radial[0],
        speed=speed,
    )


def _load(rotor, mass, unbalance, base_acceleration):
    """Return the load of disc unbalance, from x to y, and base excitation along y."""
    along_y = jnp.asarray(np.array([0.0, 1.0, 0.0, 1.0, 0.0]))
    planes = [np.array([1.0, 0.0]), np.array([0.0, 1.0])]
    moments = [
        jnp.append(jnp.outer(unbalance * rotor.shares(), plane).reshape(-1), 0.0)
        for plane in map(jnp.asarray, planes)
    ]
    none = jnp.zeros(5)
    return HarmonicLoad(none, -base_acceleration * (mass @ along_y), none, *moments)

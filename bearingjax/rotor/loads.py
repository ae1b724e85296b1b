"""External loads on a rotor: weight, forces, unbalance, base excitation."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import all_of_class, finite, of_shape
from ..numerics.types import as_count, as_real
from ..numerics.units import unit
from .linear.response import Unbalance
from .parts import check_station
from .rotor import N_HOUSING, N_STATION, Rotor, as_parts

Motions = Float[Array, " motion"]


def _vector(owner, name, size):
    of_shape(owner, name, np.shape(getattr(owner, name)) == (size,), f"({size},)")
    finite(owner, name)


class StationForce(eqx.Module):
    """A constant force and moment on a station.

    Attributes:
        station: Number of the station.
        force: (Fx, Fy, Fz, Mx, My) [N, N m].

    Traced: force.
    """

    station: int = eqx.field(static=True, converter=as_count)
    force: Float[Array, "5"] = eqx.field(
        converter=as_real, metadata=unit(("N", "N", "N", "N m", "N m"))
    )

    def __check_init__(self):
        check_station(self, self.station)
        _vector(self, "force", N_STATION)


class RotorLoads(eqx.Module):
    """Loads of a rotor.

    Attributes:
        unbalances: One or several.
        forces: Constant forces on stations, one or several.
        gravity: Acceleration of free fall along x, y and z, such as
            (0, -9.80665, 0) for a horizontal shaft (3,) [m/s²].
        base_acceleration: Amplitude of the base's acceleration a·cos φ, with φ the
            phase of the excitation (3,) [m/s²]. The rotor's motion is then that
            against the base.

    Traced: all but the numbers of stations.
    """

    unbalances: tuple[Unbalance, ...] = eqx.field(converter=as_parts, default=())
    forces: tuple[StationForce, ...] = eqx.field(converter=as_parts, default=())
    gravity: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit(3 * ("m/s²",)), default=(0.0, 0.0, 0.0)
    )
    base_acceleration: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit(3 * ("m/s²",)), default=(0.0, 0.0, 0.0)
    )

    def __check_init__(self):
        for name, kind in (("unbalances", Unbalance), ("forces", StationForce)):
            all_of_class(self, name, getattr(self, name), kind, f"{kind.__name__}s")
        _vector(self, "gravity", 3)
        _vector(self, "base_acceleration", 3)

    def check(self, rotor: Rotor) -> None:
        """Raise unless the rotor has all loaded stations.

        Raises:
            ValueError: If the rotor lacks a station.
        """
        last = rotor.shaft.n_segments
        for name in ("unbalances", "forces"):
            for one in getattr(self, name):
                if one.station > last:
                    raise ValueError(
                        f"RotorLoads: `{name}` holds one on station {one.station}; the"
                        f" last station of the shaft is {last}."
                    )

    @eqx.filter_jit
    def constant(self, rotor: Rotor) -> Motions:
        """Return weight and constant forces on all motions (motion,) [N, N m]."""
        force = acceleration_load(rotor, self.gravity)
        for one in self.forces:
            force = force.at[rotor.slice_at(one.station)].add(one.force)
        return force

    @eqx.filter_jit
    def unbalance_forces(self, rotor: Rotor) -> tuple[Motions, Motions]:
        """Return amplitudes of cos φ and sin φ of unbalance forces, over Ω² [kg m].

        U (cos(φ + β), sin(φ + β)) at the station of every unbalance.
        """
        cosine = sine = jnp.zeros_like(rotor.motions()[:, 0])
        for one in self.unbalances:
            x, y = one.moment * jnp.cos(one.phase), one.moment * jnp.sin(one.phase)
            at = rotor.slice_at(one.station).start
            cosine = cosine.at[at].add(x).at[at + 1].add(y)
            sine = sine.at[at].add(-y).at[at + 1].add(x)
        return cosine, sine

    @eqx.filter_jit
    def base_force(self, rotor: Rotor) -> Motions:
        """Return the amplitude of cos φ of the forces of base excitation [N, N m]."""
        return -acceleration_load(rotor, self.base_acceleration)


def acceleration_load(rotor: Rotor, acceleration: Any) -> Motions:
    """Return the mass times a uniform acceleration of the rotor (motion,) [N, N m].

    Args:
        rotor: The rotor.
        acceleration: Along x, y and z (3,) [m/s²].
    """
    mass = rotor.unsupported_matrices().mass
    n_nodes = rotor.shaft.n_nodes
    n_housings = (mass.shape[0] - N_STATION * n_nodes) // N_HOUSING
    still = jnp.append(acceleration, jnp.zeros(2, mass.dtype))
    every = [jnp.tile(still, n_nodes), jnp.tile(acceleration, n_housings)]
    return mass @ jnp.concatenate(every)

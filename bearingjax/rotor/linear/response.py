"""Vibration of a linear rotor under unbalance."""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Complex, Float

from ...design.checks import check_fields, number
from ...numerics.compiled.programs import program
from ...numerics.labels import to_xarray
from ...numerics.lapack import solve_any
from ...numerics.shown import Printable
from ...numerics.types import Real, as_count
from ...numerics.units import meaning, real, unit
from ..parts import check_station
from ..shaft import STATION_UNITS
from .modes import major_axis, to_complex

_HELD = 1e-6
"""Stiffness over mass added to everything at frequency zero [1/s²]."""
_BATCH = 16
"""Number of speeds solved at once."""


class Unbalance(eqx.Module):
    """Unbalance: a mass off the axis.

    Attributes:
        station: Number of the station that it sits on.
        moment: Mass times distance from the axis [kg m].
        phase: Azimuth at time 0, from +x towards +y [rad].

    Traced: moment, phase.
    """

    about: ClassVar[str] = "masses off the axis"
    station: int = eqx.field(
        static=True,
        converter=as_count,
        metadata=meaning("station of the shaft", least=0),
    )
    moment: Real = eqx.field(**real("kg m", "mass times eccentricity", least=0))
    phase: Real = eqx.field(
        **real("rad", "azimuth at time 0, from x to y"), default=0.0
    )

    def __check_init__(self):
        check_station(self, self.station)
        check_fields(self)
        number(self, "phase")


class UnbalanceResponse(Printable):
    """Steady vibration at the frequency of the speed, Re(motion · exp(iΩt)).

    Attributes:
        speed: Ω (speed,) [rad/s].
        motion: Complex amplitudes of (ux uy uz gx gy) of every node
            (speed, node, 5) [m, rad].
        housing: Amplitude of (ux uy uz) of every housing (speed, housing, 3) [m].
    """

    speed: Float[Array, " speed"] = eqx.field(metadata=unit("rad/s"))
    motion: Complex[Array, "speed node station_freedom=5"] = eqx.field(
        metadata=unit(STATION_UNITS)
    )
    housing: Complex[Array, "speed housing direction=3"] = eqx.field(metadata=unit("m"))

    to_xarray = to_xarray

    @property
    def amplitude(self) -> Float[Array, "speed node 5"]:
        """Half of peak to peak of every freedom [m, rad]."""
        return jnp.abs(self.motion)

    @property
    def major_axis(self) -> Float[Array, "speed node"]:
        """Longer half axis of the orbit of every node in x and y [m]."""
        return major_axis(self.motion[..., 0], self.motion[..., 1])


@program(quick=True)
def steady(
    rotor: Any,
    moments: Complex[Array, " motion"],
    forces: Complex[Array, " motion"],
    frequencies: Float[Array, " speed"],
    speeds: Float[Array, " speed"],
) -> UnbalanceResponse:
    """Return the vibration of a linear rotor under Re((moments ω² + forces) exp(iωt)).

    Args:
        rotor: The rotor.
        moments, forces: On all motions [kg m], [N, N m].
        frequencies: ω of the excitation [rad/s].
        speeds: Speeds of the rotor at each of them [rad/s].

    Returns:
        UnbalanceResponse; its `speed` is that of the excitation.
    """
    motions = to_complex(rotor.motions())
    moments, forces = motions.T @ moments, motions.T @ forces

    def at_frequency(given):
        frequency, speed = given
        force = to_complex(frequency**2) * moments + forces
        matrices = rotor.linearise(speed)
        stiffness = matrices.dynamic_stiffness(lax.complex(0.0 * frequency, frequency))
        # Motions without stiffness would make it singular at rest.
        little = jnp.where(frequency == 0, _HELD, 0.0) * matrices.mass
        stiffness = stiffness + to_complex(little)
        return motions @ solve_any(stiffness, force)

    motion = lax.map(at_frequency, (frequencies, speeds), batch_size=_BATCH)
    nodes, housing = rotor.linearise(0.0).split(motion)
    return UnbalanceResponse(frequencies, nodes, housing)

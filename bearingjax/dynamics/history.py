"""Results of skidding in time."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from ..numerics.types import namespace
from ..numerics.units import unit
from ..statics.solution import BallSolution
from .motion import SkidState, Work


class SkidHistory(eqx.Module):
    """Motion of skidding balls over time; NaN at times that were not reached. Axes:
    time; ball; contact, as of `BallSolution`.

    Attributes:
        solution: The bearing under its load at the beginning.
        time: Times (time,) [s].
        state: The motion, leading axis time; `SkidState`.
        azimuth: Of the balls (time, ball) [rad].
        contact_load: Loads (time, ball, contact) [N].
        contact_angle: Angles (time, ball, contact) [rad].
        rolling_orbit_speed: With outer raceway control at the contact angles (time,
            ball) [rad/s].
        displacement: Ring freedoms, outer ring first (time, 12) [m, rad].
        film: Central films (time, ball, contact) [m].
        sliding: Slip in the middle of the contacts, along the rolling direction and
            across (time, ball, contact, 2) [m/s].
        contact_spin: About the contact normals (time, ball, contact) [rad/s].
        heat: Of each contact (time, ball, contact) [W].
        cage_force: Of the cage on the balls, in the sense in which angles are counted
            (time, ball) [N].
        friction_torque: That turns the inner ring (time,) [N m].
        power: Momentary powers (time,).
        work: Their integrals since the beginning (time,).
        kinetic_energy: Of balls and cage (time,) [J].
        potential_energy: Of pockets and weights (time,) [J].
        steps: Steps in time, with those that were rejected.
        rejected: Those.
        result: `Result` code.
    """

    solution: BallSolution
    time: Float[Array, " time"] = eqx.field(metadata=unit("s"))
    state: SkidState
    azimuth: Float[Array, "time ball"] = eqx.field(metadata=unit("rad"))
    contact_load: Float[Array, "time ball contact"] = eqx.field(metadata=unit("N"))
    contact_angle: Float[Array, "time ball contact"] = eqx.field(metadata=unit("rad"))
    rolling_orbit_speed: Float[Array, "time ball"] = eqx.field(metadata=unit("rad/s"))
    displacement: Float[Array, "time 12"] = eqx.field(
        metadata=unit(("m", "m", "m", "rad", "rad", "rad") * 2)
    )
    film: Float[Array, "time ball contact"] = eqx.field(metadata=unit("m"))
    sliding: Float[Array, "time ball contact 2"] = eqx.field(metadata=unit("m/s"))
    contact_spin: Float[Array, "time ball contact"] = eqx.field(metadata=unit("rad/s"))
    heat: Float[Array, "time ball contact"] = eqx.field(metadata=unit("W"))
    cage_force: Float[Array, "time ball"] = eqx.field(metadata=unit("N"))
    friction_torque: Float[Array, " time"] = eqx.field(metadata=unit("N m"))
    power: Work
    work: Work
    kinetic_energy: Float[Array, " time"] = eqx.field(metadata=unit("J"))
    potential_energy: Float[Array, " time"] = eqx.field(metadata=unit("J"))
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    result: Int[Array, ""]

    @property
    def orbit_speed(self) -> Float[Array | np.ndarray, "time ball"]:
        """Orbital speeds (time, ball) [rad/s]."""
        return self.state.orbit

    @property
    def spin(self) -> Float[Array | np.ndarray, "time ball 3"]:
        """Spins relative to the orbiting frames (time, ball, 3) [rad/s]."""
        return self.state.spin

    @property
    def cage_speed(self) -> Float[Array | np.ndarray, " time"]:
        """Speed of the cage (time,) [rad/s]."""
        return self.state.cage_speed

    @property
    def slip(self) -> Float[Array | np.ndarray, "time ball"]:
        """1 - orbit/rolling orbit (time, ball) [1]; zero where rings stand still."""
        xp, still = namespace(self.orbit_speed), self.rolling_orbit_speed == 0
        rolling = xp.where(still, 1.0, self.rolling_orbit_speed)
        return xp.where(still, 0.0, 1.0 - self.orbit_speed / rolling)

    @property
    def sliding_speed(self) -> Float[Array | np.ndarray, "time ball contact"]:
        """Sizes of `sliding` (time, ball, contact) [m/s]."""
        return namespace(self.sliding).sqrt((self.sliding**2).sum(axis=-1))

    @property
    def imbalance(self) -> Float[Array | np.ndarray, " time"]:
        """Work of the drive that is not accounted for (time,) [J]."""
        stored = self.kinetic_energy + self.potential_energy
        work = self.work
        return work.drive - work.contacts - work.drag - (stored - stored[0])

"""Results of skidding in time."""

from typing import Annotated, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from ...element.frame import RINGS
from ...numerics.labels import to_xarray
from ...numerics.linear import lengths
from ...numerics.shown import Printable
from ...numerics.spectrum import LEAST, even_step, hann_lines
from ...numerics.units import unit
from ...statics.solution import BallSolution, RollerSolution
from ..conditions import Conditions, by_raceway
from ..motion import SkidState, Work
from ..orbits.steady_results import slip


class SkidMotion(Printable):
    """Motion of balls or rollers over time; NaN at times that were not reached. Axes:
    time; ball or roller; contact.

    Attributes:
        time: Times (time,) [s].
        state: The motion, leading axis time; `SkidState`.
        azimuth: Azimuth of the balls (time, ball) [rad].
        contact_load: Loads (time, ball, contact) [N].
        rolling_orbit_speed: Orbital speed in pure rolling (time, ball) [rad/s].
        displacement: Ring freedoms, outer ring first (time, 12) [m, rad].
        film: Central films (time, ball, contact) [m].
        heat: Heat of each contact (time, ball, contact) [W].
        cage_force: Force of the cage on the balls, in the sense in which angles are
            counted (time, ball) [N].
        friction_torque: On the ring that drives, the one that turns faster, of the
            losses in `SkidModel` (time,) [N m].
        ring_torque: On outer and inner ring (time, 2) [N m].
        power: Momentary powers (time,).
        work: Their integrals since the beginning (time,).
        kinetic_energy: Kinetic energy of balls and cage (time,) [J].
        potential_energy: Potential energy of pockets and weights (time,) [J].
        steps: Steps in time, rejected ones included.
        rejected: Number of rejected steps.
        result: `Result` code.
    """

    time: Float[Array, " time"] = eqx.field(metadata=unit("s"))
    state: SkidState
    azimuth: Float[Array, "time ball"] = eqx.field(metadata=unit("rad"))
    contact_load: Float[Array, "time ball contact"] = eqx.field(metadata=unit("N"))
    rolling_orbit_speed: Float[Array, "time ball"] = eqx.field(metadata=unit("rad/s"))
    displacement: Float[Array, "time ring_freedom=12"] = eqx.field(
        metadata=unit(("m", "m", "m", "rad", "rad", "rad") * 2)
    )
    film: Float[Array, "time ball contact"] = eqx.field(metadata=unit("m"))
    heat: Float[Array, "time ball contact"] = eqx.field(metadata=unit("W"))
    cage_force: Float[Array, "time ball"] = eqx.field(metadata=unit("N"))
    friction_torque: Float[Array, " time"] = eqx.field(metadata=unit("N m"))
    ring_torque: Float[Array, "time raceway=2"] = eqx.field(metadata=unit("N m"))
    power: Work
    work: Work
    kinetic_energy: Float[Array, " time"] = eqx.field(metadata=unit("J"))
    potential_energy: Float[Array, " time"] = eqx.field(metadata=unit("J"))
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    result: Int[Array, ""]

    to_xarray = to_xarray

    @property
    def orbit_speed(self) -> Float[Array | np.ndarray, "time ball"]:
        """Orbital speeds (time, ball) [rad/s]."""
        return self.state.orbit

    @property
    def cage_speed(self) -> Float[Array | np.ndarray, " time"]:
        """Speed of the cage (time,) [rad/s]."""
        return self.state.cage_speed

    @property
    def slip(self) -> Float[Array | np.ndarray, "time ball"]:
        """1 - orbit/rolling orbit (time, ball) [1]; zero where rings are at rest."""
        return slip(self.orbit_speed, self.rolling_orbit_speed)

    @property
    def mean_friction_torque(self) -> tuple[float, int]:
        """Mean friction torque over the last orbits of the cage [N m], and their
        number: half of all orbits, at least one; NaN and 0 without a full orbit.

        The motion must be concrete; the part that was reached is used.
        """
        reached = np.isfinite(np.asarray(self.cage_speed))
        time, torque, turn = (
            np.asarray(v)[reached]
            for v in (self.time, self.friction_torque, self.state.cage_turn)
        )
        turns = np.abs(turn) / (2.0 * np.pi)
        orbits = int(turns[-1]) if turns.size else 0
        if not orbits:
            return float("nan"), 0
        orbits -= orbits // 2
        begin = np.interp(turns[-1] - orbits, turns, time)
        steps = 0.5 * np.diff(time) * (torque[1:] + torque[:-1])
        work = np.append(0.0, np.cumsum(steps))
        done = work[-1] - np.interp(begin, time, work)
        return float(done / (time[-1] - begin)), orbits

    @property
    def imbalance(self) -> Float[Array | np.ndarray, " time"]:
        """Residual of the energy balance (time,) [J]."""
        stored = self.kinetic_energy + self.potential_energy
        work = self.work
        return work.drive - work.contacts - work.drag - (stored - stored[0])


class SkidHistory(SkidMotion):
    """Motion of skidding balls over time. Axis contact as in `BallSolution`; pure
    rolling is outer raceway control at the contact angles.

    Attributes are those of `SkidMotion`, and
        solution: The bearing under its load at the beginning.
        contact_angle: Angles (time, ball, contact) [rad].
        sliding: Slip in the middle of the contacts, along the rolling direction and
            across (time, ball, contact, 2) [m/s].
        contact_spin: About the contact normals (time, ball, contact) [rad/s].
    """

    solution: BallSolution
    contact_angle: Float[Array, "time ball contact"] = eqx.field(metadata=unit("rad"))
    sliding: Float[Array, "time ball contact along_across=2"] = eqx.field(
        metadata=unit("m/s")
    )
    contact_spin: Float[Array, "time ball contact"] = eqx.field(metadata=unit("rad/s"))

    @property
    def spin(self) -> Float[Array | np.ndarray, "time ball 3"]:
        """Spins relative to the orbiting frames (time, ball, 3) [rad/s]."""
        return self.state.spin

    @property
    def sliding_speed(self) -> Float[Array | np.ndarray, "time ball contact"]:
        """Magnitudes of `sliding` (time, ball, contact) [m/s]."""
        return lengths(self.sliding)


class SkidRollerHistory(SkidMotion):
    """Motion of skidding rollers over time. Contacts (outer, inner).

    Attributes are those of `SkidMotion`, and
        solution: The bearing under its load.
        sliding: Slip along the rolling direction (time, roller, contact) [m/s].
        conditions: In the contacts (time, roller, contact).
    """

    solution: RollerSolution
    sliding: Float[Array, "time roller contact"] = eqx.field(metadata=unit("m/s"))
    conditions: Conditions

    @property
    def spin(self) -> Float[Array | np.ndarray, "time roller"]:
        """About the roller axes, relative to the orbiting frames (time, roller)
        [rad/s]."""
        return self.state.spin[..., 0]

    @property
    def sliding_speed(self) -> Float[Array | np.ndarray, "time roller contact"]:
        """Magnitudes of `sliding` (time, roller, contact) [m/s]."""
        return abs(self.sliding)


class SlidingSpectrum(NamedTuple):
    """Spectrum of the sliding speed of a ball or roller.

    Attributes:
        frequency: Frequencies (line,) [Hz].
        amplitude: Amplitude of the sliding speed (line,) [m/s].
        cage: Mean frequency of the cage over the time that was transformed [Hz].
    """

    frequency: Annotated[np.ndarray, unit("Hz")]
    amplitude: Annotated[np.ndarray, unit("m/s")]
    cage: Annotated[float, unit("Hz")]


def sliding_spectrum(
    found: SkidHistory | SkidRollerHistory,
    *,
    ball: int = 0,
    raceway: str = "inner",
    begin: float | None = None,
) -> SlidingSpectrum:
    """Return the spectrum of the sliding speed in the middle of a contact.

    Args:
        found: From `simulate`, at even times.
        ball: Index of the ball.
        raceway: "outer" or "inner".
        begin: Time from which on [s]; default: a third of all.

    Returns:
        Amplitudes as returned by `hann_lines`.

    Raises:
        ValueError: For times that are not even, or too few of them.
    """
    time = np.asarray(found.time)
    step = even_step("spectrum", time)
    kept = time >= (time[-1] / 3.0 if begin is None else begin)
    kept &= np.isfinite(np.asarray(found.cage_speed))
    count = np.count_nonzero(kept)
    if count < LEAST:
        raise ValueError(f"spectrum: {count} times are too few; at least {LEAST}.")
    sliding = by_raceway(found.sliding_speed, found.contact_load)
    values = sliding[kept, ball, RINGS.index(raceway)]
    cage = np.abs(np.mean(np.asarray(found.cage_speed)[kept])) / (2.0 * np.pi)
    return SlidingSpectrum(*hann_lines(values, step), float(cage))

"""Results of the steady motion of skidding balls and rollers."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ...element.inertia import Speed
from ...numerics.labels import name_axis, to_xarray
from ...numerics.linear import lengths
from ...numerics.result import Result
from ...numerics.shown import Printable
from ...numerics.types import Scalar, array_namespace
from ...numerics.units import unit
from ...statics.solution import BallSolution, RollerSolution
from ..conditions import Conditions


def slip(orbit: Any, rolling: Any) -> Any:
    """Return 1 - orbit/rolling, zero where nothing rolls [1].

    Args:
        orbit, rolling: Arrays of NumPy or of JAX [rad/s].
    """
    xp, still = array_namespace(orbit), rolling == 0
    return xp.where(still, 0.0, 1.0 - orbit / xp.where(still, 1.0, rolling))


def driving(outer: Scalar, inner: Scalar, speed: Speed) -> Scalar:
    """Return the torque on the faster ring, for equal speeds on the inner [N m].

    Args:
        outer, inner: Torques on the rings [N m].
        speed: Their speeds.
    """
    return jnp.where(jnp.abs(speed.outer) > jnp.abs(speed.inner), outer, inner)


name_axis("spin_axis", "xyz")


class Power(NamedTuple):
    """Mean powers [W]: that of the drive is the sum of the others.

    Attributes:
        drive: Drive of the rings.
        contacts: Heat of the raceway contacts.
        drag: Lost in the oil between the rings.
        cage: Lost at the cage.
    """

    drive: Annotated[Scalar, unit("W")]
    contacts: Annotated[Scalar, unit("W")]
    drag: Annotated[Scalar, unit("W")]
    cage: Annotated[Scalar, unit("W")]


class SteadyMotion(Printable):
    """Results common to balls and rollers. Axes: place along the orbit; contact.

    Attributes:
        azimuth: The places (place,) [rad]; one place stands for all where all bear
            the same.
        displacement: Ring freedoms, outer ring first (12,) [m, rad].
        contact_load: Loads (place, contact) [N].
        orbit_speed: Orbital speed (place,) [rad/s].
        rolling_orbit_speed: Orbital speed in pure rolling (place,) [rad/s].
        film: Central films (place, contact) [m].
        heat: Heat of each contact (place, contact) [W].
        cage_speed: Mean orbital speed [rad/s].
        friction_torque: On the ring that drives, the one that turns faster; the mean
            over the orbit, of the losses in `SkidModel` [N m].
        ring_torque: On outer and inner ring (2,) [N m].
        power: Mean powers.
        residual: Largest force out of balance, relative to the tractions; of the ring,
            to the contact loads [1].
        steps: Steps of the search.
        result: `Result` code.
    """

    azimuth: Float[Array, " place"] = eqx.field(metadata=unit("rad"))
    displacement: Float[Array, "ring_freedom=12"] = eqx.field(
        metadata=unit(("m", "m", "m", "rad", "rad", "rad") * 2)
    )
    contact_load: Float[Array, "place contact"] = eqx.field(metadata=unit("N"))
    orbit_speed: Float[Array, " place"] = eqx.field(metadata=unit("rad/s"))
    rolling_orbit_speed: Float[Array, " place"] = eqx.field(metadata=unit("rad/s"))
    film: Float[Array, "place contact"] = eqx.field(metadata=unit("m"))
    heat: Float[Array, "place contact"] = eqx.field(metadata=unit("W"))
    cage_speed: Scalar = eqx.field(metadata=unit("rad/s"))
    friction_torque: Scalar = eqx.field(metadata=unit("N m"))
    ring_torque: Float[Array, "raceway=2"] = eqx.field(metadata=unit("N m"))
    power: Power
    residual: Scalar = eqx.field(metadata=unit("1"))
    steps: Int[Array, ""]
    result: Int[Array, ""]

    to_xarray = to_xarray

    @property
    def slip(self) -> Float[Array | np.ndarray, "*n place"]:
        """1 - orbit/rolling orbit (place,) [1]; zero where rings are at rest."""
        return slip(self.orbit_speed, self.rolling_orbit_speed)

    @property
    def failure_message(self) -> str:
        """How far a failed search of one end state came; empty if it converged."""
        result = Result(int(self.result))
        if result is Result.CONVERGED:
            return ""
        out = f"force out of balance {float(self.residual):.1e} of the tractions"
        power = f"power {abs(float(self.imbalance)):.1e} of the losses"
        return f"{result.label} after {int(self.steps)} steps; {out}, {power}"

    @property
    def imbalance(self) -> Float[Array | np.ndarray, "*n"]:
        """Residual of the power balance over all losses [1]."""
        power, xp = self.power, array_namespace(self.power.drive)
        losses = power.contacts + power.drag + power.cage
        still = losses == 0
        missing = (power.drive - losses) / xp.where(still, 1.0, losses)
        return xp.where(still, 0.0, missing)

    @property
    def cage_slip(self) -> Float[Array | np.ndarray, "*n"]:
        """1 - cage speed/that of pure rolling [1]; zero where rings are at rest.

        Both are means in time.
        """
        rolling, xp = (
            self.rolling_orbit_speed,
            array_namespace(self.rolling_orbit_speed),
        )
        still = rolling == 0
        slow = xp.where(still, 0.0, 1.0 / xp.where(still, 1.0, rolling)).mean(axis=-1)
        return xp.where(still.all(axis=-1), 0.0, 1.0 - self.cage_speed * slow)

    @property
    def raceway_heat(self) -> np.ndarray:
        """Mean heat of all contacts of the outer and of the inner raceway (2,) [W]."""
        heat = np.asarray(self.heat)
        # Places are even in angle; a ball spends longer where it is slow.
        orbit = np.abs(np.asarray(self.orbit_speed))
        time = 1.0 / orbit if orbit.all() else np.ones_like(orbit)
        count = len(self.solution.azimuth)  # type: ignore[attr-defined]
        share = time / time.sum() * count
        return (share @ heat).reshape(2, -1).sum(axis=1)

    @property
    def rolling_cage_speed(self) -> np.ndarray:
        """Mean orbital speed of pure rolling, in time [rad/s]."""
        slow = np.mean(1.0 / np.asarray(self.rolling_orbit_speed), axis=-1)
        return np.asarray(1.0 / slow)


class SteadySkid(SteadyMotion):
    """Steady motion of skidding balls. Axis contact as in `BallResults`; pure
    rolling is outer raceway control at the contact angles.

    Attributes are those of `SteadyMotion`, and
        solution: The bearing under its load, in pure rolling.
        contact_angle: Angles (place, contact) [rad].
        spin: Spin of the ball relative to its orbiting frame, tangential, radial, axial
            (place, 3) [rad/s].
        sliding: Slip in the middle of the contacts, along the rolling direction and
            across (place, contact, 2) [m/s].
        contact_spin: About the contact normals (place, contact) [rad/s].
        wander: Range of the lead of a ball over uniform motion [m]: the cage is
            involved if it is not less than the pocket clearance.
    """

    solution: BallSolution
    contact_angle: Float[Array, "place contact"] = eqx.field(metadata=unit("rad"))
    spin: Float[Array, "place spin_axis=3"] = eqx.field(metadata=unit("rad/s"))
    sliding: Float[Array, "place contact along_across=2"] = eqx.field(
        metadata=unit("m/s")
    )
    contact_spin: Float[Array, "place contact"] = eqx.field(metadata=unit("rad/s"))
    wander: Scalar = eqx.field(metadata=unit("m"))

    @property
    def sliding_speed(self) -> Float[Array | np.ndarray, "*n place contact"]:
        """Sizes of `sliding` (place, contact) [m/s]."""
        return lengths(self.sliding)

    @property
    def pitch_angle(self) -> Float[Array | np.ndarray, "*n place"]:
        """Angle between spin axis and bearing axis (place,) [rad]."""
        return array_namespace(self.spin).arctan2(self.spin[..., 1], -self.spin[..., 2])


class SteadyRollerSkid(SteadyMotion):
    """Steady motion of skidding rollers. Contacts (outer, inner).

    All orbit with the cage, so that `orbit_speed` is the same everywhere.

    Attributes are those of `SteadyMotion`, and
        solution: The bearing under its load, in pure rolling.
        spin: About the roller axis, relative to the orbiting frame (place,) [rad/s].
        rolling_spin: Spin in pure rolling (place,) [rad/s].
        sliding: Slip along the rolling direction (place, contact) [m/s].
        cage_force: Force of the cage on a roller, in the sense in which angles are
            counted; where it is positive the rear of a pocket pushes, else the front
            holds back (place,) [N].
        conditions: In the contacts (place, contact).
    """

    solution: RollerSolution
    spin: Float[Array, " place"] = eqx.field(metadata=unit("rad/s"))
    rolling_spin: Float[Array, " place"] = eqx.field(metadata=unit("rad/s"))
    sliding: Float[Array, "place contact"] = eqx.field(metadata=unit("m/s"))
    cage_force: Float[Array, " place"] = eqx.field(metadata=unit("N"))
    conditions: Conditions

    @property
    def sliding_speed(self) -> Float[Array | np.ndarray, "*n place contact"]:
        """Sizes of `sliding` (place, contact) [m/s]."""
        return abs(self.sliding)

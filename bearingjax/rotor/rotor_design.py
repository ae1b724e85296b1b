"""Rotors whose numbers are varied: natural frequencies and vibration over speeds."""

from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design.checks import instance, of_class
from ..element import BearingElement, Speed
from ..numerics.types import Scalar, as_count, as_real, with_fields
from ..numerics.units import unit
from ..optimise.system import AbstractSystem, Reading
from ..statics.installed import Installed
from .bearing_support import BearingSupport
from .like_parts import map_parts
from .linear.harmonic import unbalance_response
from .linear.modes import modes
from .loads import RotorLoads
from .preload_offset import preload_offset
from .rotor import Rotor
from .shaft import STATION_FREEDOMS, STATION_UNITS
from .statics import static_equilibrium


class RotorCases(eqx.Module):
    """Speeds at which a `RotorDesign` is looked at.

    Attributes:
        speed: Speed of the rotor, from x towards y (case,) [rad/s].

    Traced: speed.
    """

    speed: Float[Array | np.ndarray, " case"] = eqx.field(
        converter=as_real, metadata=unit("rad/s")
    )

    def __check_init__(self):
        if np.ndim(self.speed) > 1:
            shape = np.shape(self.speed)
            raise ValueError(
                f"RotorCases: `speed` has shape {shape}; (case,) is right."
            )

    @property
    def count(self) -> int:
        """Number of speeds."""
        return len(self.speed)


class RotorNumbers(NamedTuple):
    """What is measured of a rotor at one speed.

    Attributes:
        frequency: Damped natural frequencies, ascending (mode,) [Hz].
        amplitude: Half of peak to peak of every station under unbalance, in its
            freedoms (station, 5) [m, rad].
        result: `Result` code of the static equilibrium.
    """

    frequency: Float[Array, " mode"]
    amplitude: Float[Array, "station 5"]
    result: Int[Array, ""]


class RotorSeat(eqx.Module):
    """Bearing of a support.

    Attributes:
        installed: The bearing on its seats, which turn with the rotor.
        preload: Axial force on its inner ring before the shaft gives way [N]; `None`:
            the `offset` of the support.

    Traced: all numbers.
    """

    installed: Installed
    preload: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("N"), default=None
    )


class RotorDesign(AbstractSystem):
    """A rotor on its bearings, for `bearingjax.identify`.

    Any number may be an unknown: "seats.0.preload", "rotor.discs.1.mass",
    "seats.0.installed.drawing.bearing.contact_angle", "loads.unbalances.0.moment",
    "rotor.supports.0.housing.stiffness.0.0". Frequencies and amplitudes are those about
    the static equilibrium at the speed of each case.

    Attributes:
        rotor: The rotor; its supports with a seat take their bearing from there.
        seats: Bearing of each support; `None`: it is as in `rotor`.
        loads: Loads on it.
        n_modes: Number of natural frequencies.

    Traced: all numbers. Static: n_modes.

    Raises:
        ValueError: If the seats are not as many as the supports.
        TypeError: If a part is of another class.
    """

    of_cases: ClassVar[type] = RotorCases

    rotor: Rotor
    seats: tuple[RotorSeat | None, ...] = eqx.field(converter=tuple)
    loads: RotorLoads = eqx.field(default_factory=RotorLoads)
    n_modes: int = eqx.field(static=True, converter=as_count, default=10)

    def __check_init__(self):
        of_class("RotorDesign", "rotor", self.rotor, Rotor, "a Rotor")
        instance(self, "loads", RotorLoads)
        count = len(self.rotor.supports)
        if len(self.seats) != count:
            raise ValueError(
                f"RotorDesign: `seats` are {len(self.seats)} of {count} supports; give"
                " one for each, `None` of what stays as it is."
            )
        for support, seat in zip(self.rotor.supports, self.seats, strict=True):
            if seat is not None:
                owner = "RotorDesign", "supports with a seat", support
                of_class(*owner, BearingSupport, "BearingSupports")
        self.loads.check(self.rotor)

    @property
    def element(self) -> BearingElement[Any]:
        raise TypeError("RotorDesign: it has several bearings, `seats`.")

    def check(self, cases: Any) -> None:
        of_class("RotorDesign", "cases", cases, RotorCases, "RotorCases")

    def rotor_at(self, speed: Scalar) -> Rotor:
        """Return the rotor on its bearings, as they are at a speed [rad/s]."""
        supports, pushed = [*self.rotor.supports], {}
        for k, seat in enumerate(self.seats):
            if seat is not None:
                one: Any = supports[k]
                turns = jnp.where(one.turned, -speed, speed)
                turning = Speed(turns, jnp.zeros_like(speed))
                element = seat.installed.element_at(turning, throw=False)
                supports[k] = with_fields(one, element=element)
                if seat.preload is not None:
                    pushed[k] = element, seat.preload
        if pushed:
            given = [*pushed.values()]
            moved = map_parts(lambda one: preload_offset(*one, throw=False), given)
            for k, along in zip(pushed, moved, strict=True):
                offset = jnp.zeros(5, along.dtype).at[2].set(along)
                supports[k] = with_fields(supports[k], offset=offset)
        return with_fields(self.rotor, supports=tuple(supports))

    def solve_case(self, case: Any, support: Any, options: Any) -> RotorNumbers:
        found = static_equilibrium(
            self.rotor_at(case.speed), self.loads, case.speed, throw=False
        )
        frequency = modes(found.rotor, case.speed, count=self.n_modes).frequency
        shaft = self.rotor.shaft
        nodes = np.array([shaft.node(k) for k in range(shaft.n_segments + 1)])
        amplitude = jnp.zeros((nodes.size, len(STATION_FREEDOMS)), frequency.dtype)
        if self.loads.unbalances:
            speed = case.speed[None]
            orbit = unbalance_response(found.rotor, self.loads.unbalances, speed)
            amplitude = orbit.amplitude[0, nodes]
        return RotorNumbers(frequency, amplitude, found.result)

    def failure_message(self, solved: Any) -> str:
        return "the rotor finds no equilibrium on its bearings"

    def readings(self) -> dict[str, Reading]:
        """Numbers that can be measured at a speed: natural frequencies "frequency_1",
        …, ascending; under unbalance half of peak to peak of each station, "uy_1"."""
        found = {
            f"frequency_{k + 1}": Reading("frequency", k, "Hz")
            for k in range(self.n_modes)
        }
        if self.loads.unbalances:
            pairs = [*zip(STATION_FREEDOMS, STATION_UNITS, strict=True)]
            for station in range(self.rotor.shaft.n_segments + 1):
                for k, (name, one) in enumerate(pairs):
                    entry = len(pairs) * station + k
                    found[f"{name}_{station}"] = Reading("amplitude", entry, one)
        return found

"""Kinematic frequencies of a bearing: the lines of its spectrum.

All rolling elements roll without slip, at one contact angle on both raceways. A wave
of order n on a part has n periods around it.
"""

from typing import Annotated, Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import (
    AbstractBearing,
    BearingSet,
)
from ..design.checks import count, number, of_class, one_of
from ..element.azimuth import orbit_ratio
from ..element.frame import orbit, roll_ratio, rotation
from ..element.inertia import Speed
from ..numerics.types import Scalar, array_namespace, as_real
from ..numerics.units import unit

WAVY_PARTS = ("outer", "inner", "element")
"""Parts that have waves: the raceways, and one rolling element."""


class KinematicFrequencies(NamedTuple):
    """Frequencies of a rolling bearing, without their signs [Hz].

    Attributes:
        inner, outer: Frequencies of the rings.
        cage: Frequency of the cage and the set of rolling elements, FTF.
        outer_passage: Passages of rolling elements over one place on the outer raceway,
            BPFO.
        inner_passage: Over one place on the inner raceway, BPFI.
        rotation: Rotation of a rolling element about its axis, seen from the cage, BSF.
            A defect on it meets a raceway at `twice_rotation`.
    """

    inner: Annotated[Scalar, unit("Hz")]
    outer: Annotated[Scalar, unit("Hz")]
    cage: Annotated[Scalar, unit("Hz")]
    outer_passage: Annotated[Scalar, unit("Hz")]
    inner_passage: Annotated[Scalar, unit("Hz")]
    rotation: Annotated[Scalar, unit("Hz")]

    @property
    def twice_rotation(self) -> Scalar:
        """Frequency of an element defect over both raceways, 2 BSF [Hz]."""
        return 2.0 * self.rotation

    @property
    def shaft(self) -> Scalar:
        """Frequency of the inner ring, or of the outer one if the inner rests [Hz]."""
        return jnp.where(self.inner == 0, self.outer, self.inner)

    @property
    def orders(self) -> "KinematicFrequencies":
        """Orders: all frequencies over that of the shaft [1]."""
        return KinematicFrequencies(*(one / self.shaft for one in self))


class WavinessForce(NamedTuple):
    """Frequencies of the ring forces caused by a wave [Hz].

    Attributes:
        axial: Orders excited by axial forces (line,).
        radial: Orders excited by radial forces of constant size that turn, from +x
            towards +y where positive (line,).
    """

    axial: Annotated[Float[Array, " line"], unit("Hz")]
    radial: Annotated[Float[Array, " line"], unit("Hz")]


def kinematic_frequencies(
    bearing: AbstractBearing, speed: Speed, contact_angle: Any = None
) -> KinematicFrequencies:
    """Return the frequencies of cage, passages and rolling elements.

    Args:
        bearing: Design of a single row.
        speed: Ring speeds.
        contact_angle: Contact angle of the balls in operation [rad]; `None`: the free
            one. Rollers have none: theirs is the angle of their axis.

    Returns:
        KinematicFrequencies [Hz], differentiable with respect to the design, speeds
        and contact angle.

    Raises:
        TypeError: If the bearing is a set, or the speed no `Speed`.
        ValueError: If a contact angle is given for rollers.

    Source: rolling without slip; Harris, Rolling Bearing Analysis (2001), chapter 8.
    """
    speeds = _speeds("kinematic_frequencies", bearing, speed, contact_angle)
    z = bearing.n_elements
    passages = z * (speeds.cage - speeds.outer), z * (speeds.inner - speeds.cage)
    found = speeds.inner, speeds.outer, speeds.cage, *passages, speeds.element
    return KinematicFrequencies(*(abs(one) / (2.0 * np.pi) for one in found))


def waviness_force(
    bearing: AbstractBearing,
    speed: Speed,
    part: str,
    order: int,
    contact_angle: Any = None,
) -> WavinessForce:
    """Return the frequencies of the ring forces from waviness of one order.

    For rigid rings, evenly spaced, equally loaded rolling elements, and to first order
    in the height of the wave. With z rolling elements the forces then add up for few
    orders: on a raceway kz axially and kz ± 1 radially; all other orders balance. On
    one rolling element even orders act axially and radially; for odd orders the
    opposite contacts cancel.

    Args:
        bearing, speed, contact_angle: As in `kinematic_frequencies`.
        part: "outer", "inner" (raceway) or "element" (one rolling element).
        order: Number of waves around the part, n ≥ 1.

    Returns:
        WavinessForce [Hz]; without lines if the order makes no force.

    Raises:
        TypeError: As `kinematic_frequencies`; if the order is no whole number.
        ValueError: As `kinematic_frequencies`; for another part; an order below 1.

    Source: Wardle, Proc. IMechE 202 (1988) C5, for a fixed outer ring; here for both
        rings turning. At ball j, azimuth θ_j = ω_c t + 2π j/z, the wave has the height
        Re exp(i n (θ_j - ω t)) on a ring of the speed ω. Σ exp(i n θ_j) is not zero for
        n = kz; Σ exp(i (n ± 1) θ_j) for n = kz ∓ 1.
    """
    speeds = _speeds("waviness_force", bearing, speed, contact_angle)
    one_of("waviness_force", "part", part, WAVY_PARTS, ", ".join(WAVY_PARTS))
    count("waviness_force", "order", order)
    cage, axial, radial = speeds.cage, [], []
    if part == "element":
        if order % 2 == 0:
            axial = [order * speeds.element]
            radial = [cage + order * speeds.element, cage - order * speeds.element]
    else:
        z = bearing.n_elements
        ring = speeds.inner if part == "inner" else speeds.outer
        passed = order * (cage - ring)
        if order % z == 0:
            axial = [passed]
        if (order + 1) % z == 0:
            radial.append(cage + passed)
        if (order - 1) % z == 0:
            radial.append(cage - passed)
    in_hertz = 1.0 / (2.0 * np.pi)
    return WavinessForce(
        in_hertz * abs(_stack(axial, cage)), in_hertz * _stack(radial, cage)
    )


class _Speeds(NamedTuple):
    """Speeds of the parts [rad/s]."""

    inner: Scalar
    outer: Scalar
    cage: Scalar
    element: Scalar


def _speeds(owner, bearing, speed, contact_angle) -> _Speeds:
    if isinstance(bearing, BearingSet):
        raise TypeError(
            f"{owner}: `bearing` is a BearingSet; give one of its rows,"
            " `bearing.rows[0].bearing`."
        )
    of_class(owner, "bearing", bearing, AbstractBearing, "the design of a bearing")
    of_class(owner, "speed", speed, Speed, "Speed(inner, outer) in rad/s")
    diameter, ratio = bearing.element_diameter, orbit_ratio(bearing)
    if contact_angle is not None:
        if not bearing.is_ball:
            raise ValueError(
                f"{owner}: `contact_angle` is given for rollers, which roll at the"
                " angle of their axis; leave it out."
            )
        number(owner, "contact_angle", contact_angle, "rad")
        cosine = jnp.cos(as_real(contact_angle))
        ratio = roll_ratio(diameter, bearing.pitch_diameter, cosine)
    rings = speed.outer, speed.inner
    turned = rotation(ratio, diameter, bearing.pitch_diameter, *rings)
    return _Speeds(speed.inner, speed.outer, orbit(ratio, *rings), turned)


def _stack(lines, like):
    xp = array_namespace(like)
    return xp.stack(lines) if lines else xp.zeros((0,), like.dtype)

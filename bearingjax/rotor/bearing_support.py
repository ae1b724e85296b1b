"""A bearing of the library as what holds a rotor."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check, instance, is_traced
from ..element.bearing_element import BearingElement, check_element
from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..numerics.types import Scalar, as_count, as_real
from ..numerics.units import unit
from .parts import (
    DAMPING_UNITS,
    AbstractSupport,
    Housing,
    check_matrix,
    check_station,
    square_matrix,
)
from .shaft import STATION_FREEDOMS

_N_RING = len(FREEDOMS)
_INNER = slice(_N_RING, _N_RING + len(STATION_FREEDOMS))
"""(ux uy uz gx gy) of the inner ring among the freedoms of both rings."""
_TURNED = np.array([1.0, -1.0, -1.0, 1.0, -1.0])
"""What a half turn about x makes of (ux uy uz gx gy), and of forces and moments."""


class BearingSupport(AbstractSupport):
    """A bearing whose inner ring sits on the shaft, its outer ring on a fixed base.

    Its rolling elements stand where `first_azimuth` of the bearing has them; loads and
    angles are quasi-static.

    Linear analyses take its slopes where the station has not moved, so at `offset`: a
    bearing that bears nothing there, such as one with clearance or without preload,
    has no stiffness and leaves the shaft free, which nothing warns of.

    Attributes:
        station: Number of the station that it holds.
        element: The bearing, or a set of bearings.
        offset: Where the inner ring is in the bearing while the station has not moved,
            (ux uy uz gx gy), such as an axial preload (5,) [m, rad].
        damping: Against ground or housing (5, 5), or its diagonal (5,) [N s/m, N s,
            N m s].
        housing: What it stands on; `None`: ground.
        turned: Whether the bearing is mounted the other way round, its +z along the
            shaft's -z, by a half turn about x; `offset` is in the bearing's own axes.
        inertia: Whether its rolling elements feel the speed of the rotor.

    Traced: element, offset, damping, housing. Static: station, turned, inertia.
    """

    station: int = eqx.field(static=True, converter=as_count)
    element: BearingElement
    offset: Float[Array, "5"] = eqx.field(
        converter=as_real,
        metadata=unit(("m", "m", "m", "rad", "rad")),
        default=(0.0,) * 5,
    )
    damping: Float[Array, "5 5"] = eqx.field(
        converter=square_matrix, metadata=unit(DAMPING_UNITS), default=(0.0,) * 5
    )
    housing: Housing | None = eqx.field(default=None, kw_only=True)
    turned: bool = eqx.field(static=True, default=False, kw_only=True)
    inertia: bool = eqx.field(static=True, default=False, kw_only=True)

    def __check_init__(self):
        check_station(self, self.station)
        check_element("BearingSupport", self.element)
        shape: Any = getattr(self.offset, "shape", None)
        if shape != (5,):
            raise ValueError(
                f"BearingSupport: `offset` has shape {shape}; it must be (5,): ux, uy,"
                " uz in m, gx, gy in rad."
            )
        if not is_traced(self.offset):
            check(self, "offset", np.isfinite(self.offset).all(), "finite")
        check_matrix(self, "damping", 5)
        instance(self, "housing", Housing, None)
        for name in ("turned", "inertia"):
            instance(self, name, bool)

    def force(
        self, motion: Float[Array, "5"], velocity: Float[Array, "5"], speed: Scalar
    ) -> Float[Array, "5"]:
        """Force that moves the station against the bearing (5,) [N, N m].

        With the preload's share: it is not zero where nothing has moved.

        Args:
            motion, velocity, speed: As of `AbstractSupport.force`.
        """
        sense = jnp.asarray(_TURNED if self.turned else np.ones(5), motion.dtype)
        # Seen from the other side the rotor turns the other way.
        spin = -speed if self.turned else speed
        rings = jnp.zeros(2 * _N_RING, motion.dtype)
        rings = rings.at[_INNER].set(self.offset + sense * motion)
        turning = Speed(inner=spin) if self.inertia else None
        held = self.element.force(rings, turning)
        return sense * held[_INNER] + self.damping @ velocity

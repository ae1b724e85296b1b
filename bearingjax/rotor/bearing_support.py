"""Rotor support by a bearing of the library."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..design.checks import finite, instance, must_be, of_shape
from ..element import FREEDOMS, BearingElement, Speed
from ..element.bearing_element import check_element
from ..numerics.result import Result
from ..numerics.types import Number, Scalar, as_array, as_count, as_real
from ..numerics.units import meaning, unit
from ..statics.load_result import solution_at
from ..statics.options import SolveOptions
from ..statics.warning_sizes import stiffness_scale
from .parts import (
    DAMPING_UNITS,
    AbstractSupport,
    Five,
    Housing,
    Responded,
    check_support,
    square_matrix,
)
from .shaft import STATION_FREEDOMS

_N_RING = len(FREEDOMS)
_NO_LOAD = 1e-6
"""Load over E* D that counts as none when idle rolling elements are judged [m]."""
_INNER = slice(_N_RING, _N_RING + len(STATION_FREEDOMS))
"""(ux uy uz gx gy) of the inner ring among the freedoms of both rings."""
_TURN = 2 * _N_RING - 1
"""gz of the inner ring."""
TURNED = np.array([1.0, -1.0, -1.0, 1.0, -1.0])
"""Signs from a half turn about x of (ux uy uz gx gy), and of forces and moments."""


def _flag(value):
    """Converter: traced flag, so that both orientations share one program."""
    return as_array(value, bool) if isinstance(value, bool) else value


class BearingSupport(AbstractSupport):
    """A bearing whose inner ring sits on the shaft, its outer ring on a fixed base.

    Loads and angles are quasi-static. Linear analyses of a `Rotor` take its tangent
    stiffness at `offset`, with the station at zero; a bearing without load there,
    such as one with clearance or without preload, leaves the shaft free.
    `static_equilibrium` finds its position under weight and preload, and warns of one
    without load.

    Attributes:
        station: Number of the supported station.
        element: The bearing, or a set of bearings.
        offset: Displacement of the inner ring in the bearing with the station at zero,
            (ux uy uz gx gy), such as an axial preload (5,) [m, rad].
        damping: Against ground or housing (5, 5), or its diagonal (5,) [N s/m, N s,
            N m s].
        housing: Its housing; `None`: ground.
        turned: Whether the bearing is mounted the other way round, its +z along the
            shaft's -z, by a half turn about x; `offset` is in the bearing's own axes.
        inertia: Whether its rolling elements have inertia forces at rotor speed.
        passage: Whether its rolling elements orbit as the rotor turns, rolling without
            slip, so that its stiffness varies with their passage (variable
            compliance); else they stay at `first_azimuth` of the bearing, as in linear
            analyses.

    Traced: element, offset, damping, housing, turned. Static: station, inertia,
    passage.
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
    turned: Bool[Array, ""] | bool = eqx.field(
        converter=_flag,
        default=False,
        kw_only=True,
        metadata=meaning("whether the bearing faces the other way"),
    )
    inertia: bool = eqx.field(
        static=True,
        default=False,
        kw_only=True,
        metadata=meaning("whether its rolling elements feel the speed"),
    )
    passage: bool = eqx.field(static=True, default=False, kw_only=True)

    def __check_init__(self):
        check_support(self)
        check_element("BearingSupport", self.element)
        allowed = "(5,): ux, uy, uz in m, gx, gy in rad"
        of_shape(self, "offset", np.shape(self.offset) == (5,), allowed)
        finite(self, "offset")
        for name in ("inertia", "passage"):
            instance(self, name, bool)
        kind = getattr(self.turned, "dtype", None)
        known = kind is not None and kind.kind == "b" and not jnp.shape(self.turned)
        must_be(self, "turned", self.turned, known, "True or False", TypeError)

    def force(
        self, motion: Five, velocity: Five, speed: Scalar, angle: Number = 0.0
    ) -> Five:
        """Return the force that moves the station against the bearing (5,) [N, N m].

        With the preload's share: it is not zero where nothing has moved. NaN where a
        rolling element did not converge.

        Args: as `AbstractSupport.force`.
        """
        sense, sign = self._sense(motion.dtype)
        model, rings = self._model(motion, speed)
        azimuths = None
        if self.passage:
            azimuths = model.azimuths(rings.at[_TURN].set(sign * angle))
        held = model.force_or_nan(rings, model.solve(rings, None, azimuths))
        return sense * held[_INNER] + self.damping @ velocity

    def respond(
        self, motion: Five, speed: Scalar
    ) -> tuple[Five, Float[Array, "5 5"], Float[Array, "5 5"]]:
        """Return `AbstractSupport.respond` from one solve of the rolling elements."""
        sense, _ = self._sense(motion.dtype)
        model, rings = self._model(motion, speed)
        # On its way to the loads of the machine a bearing bears nothing at first.
        least = _NO_LOAD * stiffness_scale(self.element.bearing)
        found = model.evaluate(rings, model.solve(rings), least)
        solved = jnp.where(found.result == Result.CONVERGED, 1.0, jnp.nan)
        stiffness = sense[:, None] * found.stiffness[_INNER, _INNER] * sense[None, :]
        return sense * found.force[_INNER] * solved, stiffness * solved, self.damping

    def respond_alone(self, motion: np.ndarray, speed: Any) -> Responded:
        """Return `respond` of known numbers by the program of a kind of bearing.

        Args:
            motion: Motion of the station (5,) [m, rad].
            speed: Speed of its shaft [rad/s]; `None`: at rest.
        """
        sense = np.where(self.turned, TURNED, 1.0)
        rings = np.zeros(2 * _N_RING)
        rings[_INNER] = np.asarray(self.offset) + sense * motion
        turning = None if speed is None else Speed(inner=sense[2] * speed)
        given = self.element, as_real(rings), turning, SolveOptions.points, self.inertia
        found = solution_at(*given, no_load=_NO_LOAD)
        force, stiffness = np.asarray(found.force), np.asarray(found.stiffness)
        solved = 1.0 if int(found.result) == Result.CONVERGED else np.nan
        stiffness = sense[:, None] * stiffness[_INNER, _INNER] * sense
        damping = np.asarray(self.damping)
        return sense * force[_INNER] * solved, stiffness * solved, damping

    def _sense(self, dtype):
        """Return signs of a motion (5,) and of the speed if the bearing is turned."""
        sense = jnp.where(self.turned, jnp.asarray(TURNED, dtype), 1.0)
        # Seen from the other side the rotor turns the other way.
        return sense, sense[2]

    def _model(self, motion, speed):
        """Return the bearing at the speed, and the freedoms of its rings (12,)."""
        sign = self._sense(motion.dtype)[1]
        turning = Speed(inner=sign * speed) if self.inertia else None
        return self.element.model(turning), self.rings(motion)

    def rings(self, motion: Five) -> Float[Array, "12"]:
        """Return the freedoms of both rings at a motion of the station [m, rad].

        Args:
            motion: Motion of the station less that of the housing (5,) [m, rad].
        """
        rings = jnp.zeros(2 * _N_RING, motion.dtype)
        return rings.at[_INNER].set(self.offset + self._sense(motion.dtype)[0] * motion)

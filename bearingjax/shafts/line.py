"""A shaft of a system: its segments, its place in space, and the stations on it.

Bearings and wheels sit at any position along the shaft. The stations of its beam are
the ends of the segments and these positions, in an order that is fixed when the system
is built: positions may then be changed and differentiated as long as none passes
another station.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check, is_traced, of_shape
from ..design.material import Material
from ..numerics.types import array_namespace, as_real, in_numpy
from ..numerics.units import meaning, unit
from ..rotor import Shaft

_SAME = 1e-9
"""Distance over the length of the shaft below which two positions are one station."""
_FINE = 24
"""Beam elements over the length of a shaft, about, for smooth lines."""
_ALONG = 0.9
"""Component of the axis along global x from which y points out local x [1]."""


class Plan(NamedTuple):
    """Order of the stations of a shaft; static.

    Attributes:
        stations: For each station, the name of the part there, or the number of the end
            of a segment.
        segments: Number of the segment between each station and the next.
        divisions: Beam elements there.
        place: Station of each part, by name.
    """

    stations: tuple[str | int, ...]
    segments: tuple[int, ...]
    divisions: tuple[int, ...]
    place: tuple[tuple[str, int], ...]


class ShaftLine(eqx.Module):
    """A shaft of cylindrical segments, and its place in space.

    Positions along the shaft count from the start of its first segment. Its local axes
    are z along `axis`, x the global x made perpendicular to it (or the global y, where
    the axis is along x), and y completing a right-handed system. Angles around the
    shaft count from local x towards local y; a speed is positive in that sense.

    Attributes:
        name: Name, unique in the system.
        length: Length of each segment (segment,) [m].
        outer_diameter: Outer diameter of each segment (segment,) [m].
        bore: Bore of each segment, 0 of a solid one (segment,) [m].
        material: Material of all segments, or a tuple with one for each.
        axis: Direction of the shaft in global axes (3,) [1].
        origin: Start of the first segment in global axes (3,) [m]; `None`: not known,
            meshes are then placed by their angles.
        rigid: Whether it cannot bend or stretch.

    Traced: all numbers. Static: name, rigid.
    """

    name: str = eqx.field(static=True)
    length: Float[Array, " segment"] = eqx.field(converter=as_real, metadata=unit("m"))
    outer_diameter: Float[Array, " segment"] = eqx.field(
        converter=as_real, metadata=unit("m")
    )
    bore: Float[Array, " segment"] = eqx.field(
        converter=as_real, metadata=unit("m"), default=0.0
    )
    material: Material | tuple[Material, ...] = eqx.field(default_factory=Material)
    axis: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit(3 * ("1",)), default=(0.0, 0.0, 1.0)
    )
    origin: Float[Array, "3"] | None = eqx.field(
        converter=as_real, metadata=unit(3 * ("m",)), default=None
    )
    rigid: bool = eqx.field(
        static=True, default=False, metadata=meaning("whether the shaft does not bend")
    )

    def __check_init__(self):
        allowed = "(segment,), the length of each segment in m"
        of_shape(self, "length", jnp.ndim(self.length) == 1, allowed)
        for name, value in (("axis", self.axis), ("origin", self.origin)):
            fits = value is None or jnp.shape(value) == (3,)
            of_shape(self, name, fits, "(3,)")
        if not is_traced(self.axis):
            long = np.linalg.norm(np.asarray(self.axis)) > 0
            check(self, "axis", long, "a direction, not three zeros")
        if not is_traced(self.length):
            check(self, "length", np.asarray(self.length) > 0, "above 0 m")

    @property
    def frame(self) -> Float[Array | np.ndarray, "3 3"]:
        """Local x, y and z in global axes (local, global) [1]."""
        axis = in_numpy(self.axis)
        xp: Any = array_namespace(axis)
        z = axis / xp.sqrt(axis @ axis)
        out = xp.eye(3, dtype=z.dtype)[xp.where(xp.abs(z[0]) > _ALONG, 1, 0)]
        x = out - (out @ z) * z
        x = x / xp.sqrt(x @ x)
        return xp.stack([x, xp.cross(z, x), z])

    def radial_direction(self, angle: Any) -> Float[Array, "3"]:
        """Return the radial direction at an angle around the shaft, in global axes.

        Args:
            angle: From local x towards local y [rad].
        """
        x, y, _ = self.frame
        return jnp.cos(angle) * x + jnp.sin(angle) * y

    def plan(self, places: dict[str, Any]) -> Plan:
        """Return the order of its stations.

        Args:
            places: Positions of the parts on it by name, concrete [m].

        Raises:
            ValueError: If a part is beyond the ends of the shaft.
        """
        ends = np.concatenate([[0.0], np.cumsum(np.asarray(self.length))])
        whole = ends[-1]
        slack = _SAME * whole
        knots: list[tuple[float, str | int]] = [(end, k) for k, end in enumerate(ends)]
        for name, given in places.items():
            position = float(given)
            if not -slack <= position <= whole + slack:
                raise ValueError(
                    f"ShaftSystem: {name} is at {1e3 * position:.6g} mm, beyond the"
                    f" ends of shaft {self.name}, 0 to {1e3 * whole:.6g} mm."
                )
            knots.append((position, name))
        # Of a step and a part in one place the part moves the station.
        knots.sort(key=lambda knot: (knot[0], isinstance(knot[1], int)))
        groups: list[list[tuple[float, str | int]]] = []
        for knot in knots:
            if groups and knot[0] - groups[-1][0][0] <= slack:
                groups[-1].append(knot)
            else:
                groups.append([knot])
        heads = [
            next((k for k in group if isinstance(k[1], str)), group[0])
            for group in groups
        ]
        z = np.array([head[0] for head in heads])
        middles = 0.5 * (z[1:] + z[:-1])
        segments = np.searchsorted(ends, middles) - 1
        divisions = np.maximum(1, np.round(_FINE * np.diff(z) / whole)).astype(int)
        place = tuple(
            (name, station)
            for station, group in enumerate(groups)
            for _, name in group
            if isinstance(name, str)
        )
        if self.rigid:
            divisions = np.ones_like(divisions)
        return Plan(
            tuple(head[1] for head in heads),
            tuple(map(int, segments)),
            tuple(map(int, divisions)),
            place,
        )

    def shaft(self, plan: Plan, places: dict[str, Any]) -> Shaft:
        """Return the beam of the shaft; NaN if the stations are no longer in order.

        Args:
            plan: From `plan`.
            places: Positions of the parts on it by name [m].
        """
        length, widths, places = in_numpy(
            (self.length, (self.outer_diameter, self.bore), places)
        )
        xp: Any = array_namespace(length)
        ends = xp.concatenate([xp.zeros(1, length.dtype), xp.cumsum(length)])
        z = [places[s] if isinstance(s, str) else ends[s] for s in plan.stations]
        xp = array_namespace(*z)
        z = xp.stack(z)
        z = jnp.where(jnp.all(jnp.diff(z) > 0), z, jnp.nan) if is_traced(z) else z
        of = np.array(plan.segments)
        n = self.length.shape[0]
        outer, bore = (
            array_namespace(value).broadcast_to(value, (n,))[of] for value in widths
        )
        material = self.material
        if isinstance(material, tuple):
            material = tuple(material[k] for k in plan.segments)
        return Shaft(z, outer, bore, material, plan.divisions)

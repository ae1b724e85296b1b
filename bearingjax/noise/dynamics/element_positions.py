"""Positions of rolling elements at a time, and the form errors there."""

from typing import Annotated, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from ...element.row import RowPlacement
from ...numerics.units import unit, units

Each = Float[Array, " element"]
"""A number for each rolling element."""


class Section(NamedTuple):
    """Motions of a ring in the axial sections of the elements, or forces on them.

    Attributes:
        axial: (element,) [m, N].
        outwards: (element,) [m, N].
        tilt: From the axis outwards (element,) [rad, N m]; `None`: none.
    """

    axial: Annotated[Each, units("m", "N")]
    outwards: Annotated[Each, units("m", "N")]
    tilt: Annotated[Each | None, units("rad", "N m")]

    @property
    def components(self) -> Float[Array, "element 3"]:
        """All three components."""
        tilt = jnp.zeros_like(self.axial) if self.tilt is None else self.tilt
        return jnp.stack([self.axial, self.outwards, tilt], axis=1)


class ElementPositions(NamedTuple):
    """Positions of the rolling elements, and the raceway deviations there.

    The axis of the elements is the last one: a compiler works on neighbours at once.

    Attributes:
        azimuth: Azimuths of the elements (element,) [rad].
        cosine, sine: Cosine and sine of the azimuth (element,) [1].
        axial: Axial deviation of outer and inner raceway there, (2, element) [m];
            `None`: none.
        outwards: Radial deviation, away from the axis, (2, element) [m]; `None`: none.
        heights: Height of their surfaces towards the element (2, element) [m]; `None`:
            none.
    """

    azimuth: Annotated[Each, unit("rad")]
    cosine: Annotated[Each, unit("1")]
    sine: Annotated[Each, unit("1")]
    axial: Annotated[Float[Array, "2 element"] | None, unit("m")] = None
    outwards: Annotated[Float[Array, "2 element"] | None, unit("m")] = None
    heights: Annotated[Float[Array, "2 element"] | None, unit("m")] = None

    @classmethod
    def from_azimuth(cls, azimuth: Each) -> "ElementPositions":
        """Create positions on raceways without deviations."""
        return cls(azimuth, jnp.cos(azimuth), jnp.sin(azimuth))

    def with_deviations(
        self, deviations: Float[Array, "element 2 3"], raise_surfaces: bool = True
    ) -> "ElementPositions":
        """Return a copy on raceways with deviations.

        Args:
            deviations: `Deviation.raceway` of every element [m].
            raise_surfaces: Whether surfaces are raised anywhere. Static.
        """
        axial, outwards, heights = deviations.transpose(2, 1, 0)
        return self._replace(
            axial=axial, outwards=outwards, heights=heights if raise_surfaces else None
        )

    def motion(
        self,
        ring: Float[Array, " k"] | None,
        raceway: int,
        placements: RowPlacement | None = None,
    ) -> Section:
        """Return raceway motions in the axial section of every element [m, rad].

        Args:
            ring: Motion of the ring, three freedoms or five [m, rad]; `None`: none.
            raceway: 0 for the outer one, 1 for the inner one. Static.
            placements: Placements of the rows; the motion is in their own axes.
        """
        axial = outwards = jnp.zeros_like(self.azimuth)
        tilt = None
        if ring is not None:
            axial = axial + ring[2]
            outwards = ring[0] * self.cosine + ring[1] * self.sine
            if ring.shape[0] > 3:
                tilt = ring[4] * self.cosine - ring[3] * self.sine
            if placements is not None:
                axial = placements.sign * axial
                if tilt is not None:
                    outwards = outwards + placements.position * tilt
                    tilt = placements.sign * tilt
        if placements is not None and raceway == 1:
            axial = axial + placements.offset
        if self.axial is not None and self.outwards is not None:
            axial = axial + self.axial[raceway]
            outwards = outwards + self.outwards[raceway]
        return Section(axial, outwards, tilt)

    def push(
        self, forces: Section, freedoms: int, placements: RowPlacement | None = None
    ) -> Float[Array, " k"]:
        """Return the load on the ring from forces on all sections [N, N m].

        Args:
            forces: On every element's section [N, N m].
            freedoms: Number of freedoms of the ring, three or five. Static.
            placements: As in `motion`.
        """
        axial, outwards, moment = forces
        if placements is not None:
            axial = placements.sign * axial
            if moment is not None:
                moment = placements.sign * moment + placements.position * outwards
        along = [outwards * self.cosine, outwards * self.sine, axial]
        if moment is not None and freedoms > 3:
            along = [*along, -moment * self.sine, moment * self.cosine]
        return jnp.sum(jnp.stack(along), axis=1)

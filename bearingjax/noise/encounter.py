"""Positions of rolling elements at a time, and the form errors there."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from .free_row import Sites


class Section(NamedTuple):
    """Motions of a ring in the axial sections of the elements, or forces on them.

    Attributes:
        axial: (element,) [m, N].
        outwards: (element,) [m, N].
        tilt: From the axis outwards (element,) [rad, N m]; `None`: none.
    """

    axial: Float[Array, " element"]
    outwards: Float[Array, " element"]
    tilt: Float[Array, " element"] | None

    @property
    def stacked(self) -> Float[Array, "element 3"]:
        """All three components."""
        tilt = jnp.zeros_like(self.axial) if self.tilt is None else self.tilt
        return jnp.stack([self.axial, self.outwards, tilt], axis=1)


class Encounter(NamedTuple):
    """Raceway deviations at every rolling element.

    The axis of the elements is the last one: a compiler works on neighbours at once.

    Attributes:
        azimuth: Azimuths of the elements (element,) [rad].
        cosine, sine: Of the azimuth (element,) [1].
        axial: Axial deviation of outer and inner raceway there, (2, element) [m];
            `None`: none.
        outwards: Radial deviation, away from the axis, likewise.
        raised: Height of their surfaces towards the element (2, element) [m]; `None`:
            none.
    """

    azimuth: Float[Array, " element"]
    cosine: Float[Array, " element"]
    sine: Float[Array, " element"]
    axial: Float[Array, "2 element"] | None = None
    outwards: Float[Array, "2 element"] | None = None
    raised: Float[Array, "2 element"] | None = None

    @classmethod
    def at(cls, azimuth: Float[Array, " element"]) -> "Encounter":
        """Create encounters on raceways without deviations."""
        return cls(azimuth, jnp.cos(azimuth), jnp.sin(azimuth))

    def meeting(
        self, met: Float[Array, "element 2 3"], raised: bool = True
    ) -> "Encounter":
        """Return a copy on raceways with deviations.

        Args:
            met: `Deviation.raceway` of every element [m].
            raised: Whether surfaces are raised anywhere. Static.
        """
        axial, outwards, heights = met.transpose(2, 1, 0)
        return self._replace(
            axial=axial, outwards=outwards, raised=heights if raised else None
        )

    def motion(
        self,
        ring: Float[Array, " k"] | None,
        raceway: int,
        sites: Sites | None = None,
    ) -> Section:
        """Return raceway motions in the axial section of every element [m, rad].

        Args:
            ring: Motion of the ring, three freedoms or five [m, rad]; `None`: none.
            raceway: 0 for the outer one, 1 for the inner one. Static.
            sites: Positions of the elements' rows; the motion is in the rows' own axes.
        """
        axial = outwards = jnp.zeros_like(self.azimuth)
        tilt = None
        if ring is not None:
            axial = axial + ring[2]
            outwards = ring[0] * self.cosine + ring[1] * self.sine
            if ring.shape[0] > 3:
                tilt = ring[4] * self.cosine - ring[3] * self.sine
            if sites is not None:
                axial = sites.sign * axial
                if tilt is not None:
                    outwards = outwards + sites.position * tilt
                    tilt = sites.sign * tilt
        if sites is not None and raceway == 1:
            axial = axial + sites.offset
        if self.axial is not None and self.outwards is not None:
            axial = axial + self.axial[raceway]
            outwards = outwards + self.outwards[raceway]
        return Section(axial, outwards, tilt)

    def push(
        self, forces: Section, freedoms: int, sites: Sites | None = None
    ) -> Float[Array, " k"]:
        """Return the load on the ring from forces on all sections [N, N m].

        Args:
            forces: On every element's section [N, N m].
            freedoms: Of the ring, three or five. Static.
            sites: As in `motion`.
        """
        axial, outwards, moment = forces
        if sites is not None:
            axial = sites.sign * axial
            if moment is not None:
                moment = sites.sign * moment + sites.position * outwards
        along = [outwards * self.cosine, outwards * self.sine, axial]
        if moment is not None and freedoms > 3:
            along = [*along, -moment * self.sine, moment * self.cosine]
        return jnp.sum(jnp.stack(along), axis=1)

"""Base class of ball and roller bearings."""

import abc
from typing import ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from ..numerics.types import Scalar
from ..numerics.warning import Warning
from .checks import count, instance, number
from .material import Material
from .published import Published


class AbstractBearing(eqx.Module):
    """A single row of balls or rollers between two rings.

    Attributes:
        pitch_diameter: Diameter of the circle of the element centres, D_pw [m].
        first_azimuth: Azimuth of element 0, from +x towards +y [rad].
        azimuth_deviation: Azimuth of each element less that of even spacing (element,)
            [rad]; `None`: evenly spaced.
        raceway_deviation: Deviations of outer and inner raceway at each element
            (element, 2, 3) [m], see `Deviation.raceway`; `None`: as on the drawing.
        material: Material of the rolling elements.
        ring_material: Material of the rings; `None`: as the rolling elements.
        published: Ratings and factors that a catalogue prints for it, or `None`.
        noun: "ball" or "roller".
        is_thrust: Whether it is a thrust bearing between two washers.
        aligns: Whether it is a row of a self-aligning bearing, with the centre of its
            spherical outer raceway in the origin.
        rated_fields: Names of the fields on which its load ratings depend.
    """

    aligns: ClassVar[bool] = False

    pitch_diameter: eqx.AbstractVar[Scalar]
    first_azimuth: eqx.AbstractVar[Scalar]
    azimuth_deviation: eqx.AbstractVar[Float[Array, " element"] | None]
    raceway_deviation: eqx.AbstractVar[Float[Array, "element 2 3"] | None]
    material: eqx.AbstractVar[Material]
    ring_material: eqx.AbstractVar[Material | None]
    published: eqx.AbstractVar[Published | None]
    noun: eqx.AbstractClassVar[str]
    is_thrust: eqx.AbstractClassVar[bool]
    rated_fields: eqx.AbstractClassVar[tuple[str, ...]]

    @property
    def is_ball(self) -> bool:
        """Whether the rolling elements are balls."""
        return self.noun == "ball"

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about the design; empty where its numbers are traced."""
        return ()

    @property
    @abc.abstractmethod
    def n_elements(self) -> int:
        """Number of rolling elements."""

    @property
    @abc.abstractmethod
    def element_diameter(self) -> Scalar:
        """Diameter of the balls, mean diameter of the rollers [m]."""

    @property
    @abc.abstractmethod
    def element_deviation(self) -> Float[Array, " element"] | None:
        """Diameter of each rolling element less the common one [m]; `None`: equal."""

    @property
    @abc.abstractmethod
    def free_cosine(self) -> Scalar:
        """Cosine of the angle at which the elements roll without load, at most 1 [1].

        Of balls the free contact angle, of rollers the angle of their axis.
        """

    @property
    @abc.abstractmethod
    def holds_axially(self) -> bool:
        """Whether it passes axial load from ring to ring, at least in one direction."""

    @property
    @abc.abstractmethod
    def play(self) -> Scalar:
        """Largest play between the rings, radial or axial [m]; may be negative."""

    @property
    def rings(self) -> Material:
        """Material of the rings."""
        return self.material if self.ring_material is None else self.ring_material

    def _check_common(self):
        number_of = f"n_{self.noun}s"
        count(self, number_of, getattr(self, number_of))
        number(self, "first_azimuth")
        instance(self, "material", Material)
        instance(self, "ring_material", Material, None)
        instance(self, "published", Published, None)

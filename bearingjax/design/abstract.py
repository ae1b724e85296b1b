"""Base class of ball and roller bearings."""

import abc
from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..numerics.shown import Printable
from ..numerics.types import Scalar
from ..numerics.warning import Warning
from .checks import check_filled, count, instance, number
from .material import Material
from .published import PublishedRatings


class AbstractBearing(Printable):
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
        filled: Number of places with an element, the first ones (`with_places`);
            `None`: all.
        noun: "ball" or "roller".
        is_thrust: Whether it is a thrust bearing between two washers.
        aligns: Whether it is a row of a self-aligning bearing, with the centre of its
            spherical outer raceway in the origin.
        is_crossed: Whether it is a row of a crossed roller bearing.
        is_paired: Whether it is a row of a double-row angular contact ball bearing.
        bears_radially: Whether it carries radial load; cylindrical roller thrust
            bearings do not.
        tilts_alone: Whether its rings tilt freely where it is the only row.
        rated_rows: Number of rows that the standards count in it: 2 for four-point
            balls, each of which bears on two pairs of arcs.
        rated_fields: Names of the fields on which its load ratings depend.
    """

    aligns: ClassVar[bool] = False
    is_crossed: ClassVar[bool] = False
    is_paired: ClassVar[bool] = False
    bears_radially: ClassVar[bool] = True
    tilts_alone: ClassVar[bool] = False
    rated_rows: ClassVar[int] = 1

    pitch_diameter: eqx.AbstractVar[Scalar]
    first_azimuth: eqx.AbstractVar[Scalar]
    azimuth_deviation: eqx.AbstractVar[Float[Array, " element"] | None]
    raceway_deviation: eqx.AbstractVar[Float[Array, "element 2 3"] | None]
    material: eqx.AbstractVar[Material]
    ring_material: eqx.AbstractVar[Material | None]
    published: eqx.AbstractVar[PublishedRatings | None]
    filled: eqx.AbstractVar[Int[Array, ""] | None]
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
    def n_elements(self) -> Any:
        """Number of rolling elements, an `int`; a `Scalar` if places may be empty."""
        if self.filled is None:
            return self.n_places
        return self.filled.astype(self.pitch_diameter.dtype)

    @property
    def n_stated(self) -> Any:
        """What its `n_balls` or `n_rollers` says of the elements that are there, of
        crossed rollers those of both orientations; as in `n_elements`."""
        stated = getattr(self, f"n_{self.noun}s")
        if self.filled is None:
            return stated
        return stated // self.n_places * self.filled

    @property
    def empty_places(self) -> Bool[Array, " place"] | None:
        """Whether each place is empty; `None`: none is."""
        if self.filled is None:
            return None
        return jnp.arange(self.n_places, dtype=self.filled.dtype) >= self.filled

    @property
    @abc.abstractmethod
    def n_places(self) -> int:
        """Number of places for rolling elements, the length of arrays of them."""

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
    @abc.abstractmethod
    def nominal_contact_angle(self) -> Scalar:
        """Nominal contact angle of the standards [rad].

        Zero for a deep groove ball bearing of any clearance; for a tapered roller
        bearing the angle of its outer raceway; for a mounted bearing the angle of the
        drawing.
        """

    @property
    @abc.abstractmethod
    def touching_angle(self) -> Scalar:
        """Angle from the radial plane at which elements touch the outer ring [rad].

        0 where balls touch at the bottom; and of angular contact, where what balls grow
        along the axis takes no clearance, but moves the ring that touches them.
        """

    @property
    @abc.abstractmethod
    def clearance(self) -> Scalar:
        """Radial internal clearance, between the ends of its radial play [m].

        Of angular contact bearings 2A (1 - cos α0), A the distance of the groove
        centres. A tapered roller stays with the inner ring and its large rib. Radial
        motion of the outer ring closes the gap by the cosine of the outer raceway's
        angle.
        """

    @abc.abstractmethod
    def with_clearance(self, clearance: Scalar) -> Any:
        """Return the row with another radial internal clearance.

        Of an angular contact bearing it is the free contact angle that changes: grooves
        that come nearer radially are met at a smaller angle.

        Args:
            clearance: Radial internal clearance as in `clearance` [m].

        Raises:
            ValueError: If the bearing does not allow it: an angular contact bearing
                needs some, or there is no contact angle.
        """

    @property
    @abc.abstractmethod
    def raceway_diameters(self) -> tuple[Scalar, Scalar]:
        """Diameters of inner and outer raceway where the elements touch them [m]."""

    @property
    @abc.abstractmethod
    def deviation_bounds(self) -> tuple[Any, ...]:
        """Upper bounds of the size of raceway deviations [m]."""

    @property
    def element_length(self) -> Any:
        """Length of the rollers [m]; `None` of balls."""
        return None

    @property
    def axial_senses(self) -> frozenset[int]:
        """Senses in which it carries axial load on its inner ring: 1 along +z, -1."""
        return frozenset({1} if self.holds_axially else ())

    @property
    def shoulders(self) -> tuple[Any, ...]:
        """Heights of the shoulders that are known [m]; none of rollers."""
        return ()

    @property
    def rib_names(self) -> tuple[str, ...]:
        """Names of the ribs that are there; none of balls."""
        return ()

    def rated_as(self, drawing: "AbstractBearing") -> "AbstractBearing":
        """Return the row with the nominal contact angle of its drawing.

        Args:
            drawing: The row before its clearance changed.
        """
        return self

    @property
    def rings(self) -> Material:
        """Material of the rings."""
        return self.material if self.ring_material is None else self.ring_material

    def _check_common(self):
        number_of = f"n_{self.noun}s"
        count(self, number_of, getattr(self, number_of))
        if self.filled is not None:
            check_filled(self, self.filled, self.n_places)
        number(self, "first_azimuth")
        instance(self, "material", Material)
        instance(self, "ring_material", Material, None)
        instance(self, "published", PublishedRatings, None)


def nearest_entry(table: Mapping[type, Any], instance: Any) -> Any:
    """Entry of the nearest class of an object in a table by class; `None`: none.

    Args:
        table: Entries by class, such as constants or functions of another package.
        instance: A bearing, or its solution.
    """
    bases = type(instance).__mro__
    return next((table[base] for base in bases if base in table), None)

"""Model of a skidding bearing: oil, traction, cage, drag."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx

from ..contact.point_law import AbstractPointLaw
from ..design import (
    AbstractBallBearing,
    CylindricalRollerBearing,
    NeedleRollerBearing,
)
from ..design.checks import instance, positive
from ..element.bearing_element import BearingElement
from ..lubrication import AbstractTraction, Lubricant, Newtonian, WarmInlet
from ..numerics.types import Real, Scalar
from ..numerics.units import meaning, real, unit
from .surroundings import Cage, Drag

_KINDS = AbstractBallBearing, CylindricalRollerBearing, NeedleRollerBearing


class Oil(NamedTuple):
    """Oil in the contacts.

    Attributes:
        lubricant: Its properties.
        temperature: Its temperature [K].
        least_film: Film that remains at rest [m].
        loading: Thermal loading parameter of the inlets at 1 m/s [s²/m²], or `None` if
            they stay cool.
    """

    lubricant: Lubricant
    temperature: Annotated[Scalar, unit("K")]
    least_film: Annotated[Scalar, unit("m")]
    loading: Annotated[Scalar | None, unit("s²/m²")] = None

    def inlet(self, modulus: Scalar) -> WarmInlet | None:
        """Return the inlet heating that thins films at speed.

        Args:
            modulus: Contact modulus [Pa].
        """
        return None if self.loading is None else WarmInlet(self.loading, modulus)


class SkidModel(eqx.Module):
    """A ball or cylindrical roller bearing whose balls or rollers may slip.

    Its friction is that of sliding and spinning in the films, of drag and of the cage.
    It has no resistance to rolling (of the inlets of the films, of the curvature across
    a groove, of hysteresis) and no seals, which often make most of the torque of a real
    bearing: see `benchmarks/skid_friction.py`.

    Attributes:
        element: The bearing, of one row of like balls, or of cylindrical or needle
            rollers, evenly spaced. The raceway control of balls says what holds the
            gyroscopic moment where contact loads and angles are solved;
            `EqualShare()` is that of the source.
        lubricant: Oil.
        temperature: Temperature of the oil in all contacts [K].
        traction: Law of traction.
        drag: Drag of the oil and air between the rings.
        cage: Cage.
        least_film: Thickness that remains of a film at rest, such as the composite
            roughness [m].
        inlet_heating: Whether films are thinner for the oil that is sheared warm in
            their inlets (see `lubrication.inlet_heating`).

    Traced: all numbers. Static: the classes, inlet_heating.
    """

    element: BearingElement
    lubricant: Lubricant
    temperature: Real = eqx.field(**real("K"))
    traction: AbstractTraction = eqx.field(default_factory=Newtonian)
    drag: Drag = eqx.field(default_factory=Drag)
    cage: Cage = eqx.field(default_factory=Cage)
    least_film: Real = eqx.field(
        **real("m", "film that remains at rest, such as the composite roughness"),
        default=1e-8,
    )
    inlet_heating: bool = eqx.field(
        static=True,
        default=False,
        metadata=meaning("whether oil sheared warm in the inlets makes films thinner"),
    )

    def __check_init__(self):
        instance(self, "element", BearingElement)
        bearing = self.element.bearing
        if not isinstance(bearing, _KINDS):
            kind = type(bearing).__name__
            raise TypeError(
                f"SkidModel: `element` is of a {kind}; it must be of one ball bearing,"
                " or of one bearing of cylindrical or needle rollers."
            )
        names = "ball_deviation", "roller_deviation", "azimuth_deviation"
        for name in (*names, "raceway_deviation"):
            if getattr(bearing, name, None) is not None:
                raise ValueError(
                    f"SkidModel: `{name}` is given; all balls or rollers must be"
                    " alike and evenly spaced, so that one orbit stands for all."
                )
        instance(self, "lubricant", Lubricant)
        positive(self, "temperature")
        instance(self, "traction", AbstractTraction)
        instance(self, "drag", Drag)
        instance(self, "cage", Cage)
        positive(self, "least_film")
        instance(self, "inlet_heating", bool)

    @property
    def oil(self) -> Oil:
        """Properties of the oil that the contacts use."""
        loading = None
        if self.inlet_heating:
            loading = self.lubricant.thermal_loading(self.temperature, 1.0)
        return Oil(self.lubricant, self.temperature, self.least_film, loading)

    @property
    def bearing(self) -> Any:
        """Design of the bearing."""
        return self.element.bearing

    @property
    def point_law(self) -> AbstractPointLaw:
        """Law of the contact constants of balls."""
        law = self.element.point_law
        assert law is not None  # balls have one
        return law

    def check_balls(self, title: str) -> None:
        """Raise unless it is a ball bearing.

        Args:
            title: Name of the analysis that requires one.

        Raises:
            TypeError: If it is another bearing.
        """
        if not isinstance(self.bearing, AbstractBallBearing):
            kind = type(self.bearing).__name__
            raise TypeError(
                f"{title}: `model` is of a {kind}; it must be of a ball bearing."
            )

"""Choices of a `BearingElement`: contact laws and kinematics of rollers and of balls.

The contacts of rollers and those of balls are described by one object each. It holds
the choices, and makes the rolling elements of a design. A new kind of rolling element
is another such class, registered for its bearing with `choices_for`.
"""

import abc
import functools
from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp

from ..contact.coupled import CoupledSlices
from ..contact.line import AbstractLineLaw, Palmgren
from ..contact.point_law import AbstractPointLaw, FreeAngle, balls_of
from ..design import AbstractBallBearing, AbstractRollerBearing, SetRow
from ..numerics import AbstractMinimiser, AbstractQuadrature, ContactMapped
from ..numerics.types import Scalar
from .balls.ball import Ball
from .balls.ball_contacts import GrooveGeometry
from .balls.ball_inertia import ball_inertia
from .balls.ball_speed import AbstractRacewayControl, OuterControl
from .constants import TETHER, contact_constants
from .inertia import Speed, inertia_force
from .kinematics import AbstractKinematics, Finite, Linearised
from .roller import Roller
from .rolling_element import AbstractRollingElement

PROFILES = "roller_profile", "outer_raceway_profile", "inner_raceway_profile"
"""Fields of a roller bearing that hold profiles."""

CHOICE_KINDS = {
    "line_law": (
        AbstractLineLaw,
        "Palmgren(), ISO16281(), LineConstant(...) or CoupledSlices()",
    ),
    "kinematics": (
        AbstractKinematics,
        "Linearised(), Finite() or, of balls, ConstantAngle()",
    ),
    "quadrature": (AbstractQuadrature, "ContactMapped() or Midpoint()"),
    "equilibrium": (AbstractMinimiser, "TrustRegionNewton() or BFGS()"),
    "point_law": (
        AbstractPointLaw,
        "FreeAngle(), ZeroAngle(), OperatingAngle() or PointConstant(...)",
    ),
    "raceway_control": (
        AbstractRacewayControl,
        "OuterControl(), InnerControl(), EqualShare(), LoadShare(), FrictionLimited(),"
        " OperatingCentrifugal() or CentrifugalOnly()",
    ),
}
"""Class of each choice of a `BearingElement`, and its description in messages."""


class AbstractChoices(eqx.Module):
    """Choices for the contacts of a kind of rolling element.

    Attributes:
        kinematics: Map from rigid motions to coordinates of the contacts.
    """

    kinematics: eqx.AbstractVar[AbstractKinematics]

    elements: ClassVar[str]
    """Name of the rolling elements in messages."""

    names: ClassVar[tuple[str, ...]]
    """Keywords of `BearingElement` that it takes, including `kinematics`."""

    @classmethod
    @abc.abstractmethod
    def from_rows(cls, rows: tuple[SetRow, ...], **given: Any) -> "AbstractChoices":
        """Return the given choices, with defaults for the rest.

        Args:
            rows: The rows, of a kind of bearing that the class supports.
            **given: Choices by `names`; `None`: the default.

        Raises:
            ValueError: For choices that contradict each other or the bearing.
        """

    @abc.abstractmethod
    def rolling_element(
        self, part: SetRow, speed: Speed | None, deviation: Scalar | None
    ) -> AbstractRollingElement:
        """One rolling element of a row.

        Args:
            part: The row and its place.
            speed: Ring speeds or `None`.
            deviation: Diameter of this one less the common one [m]; `None`: it is.
        """

    def check(self, part: SetRow, speed: Speed | None) -> None:
        """Raise if the choices are not for this row, or this speed."""


@functools.singledispatch
def choices_for(bearing: Any) -> type[AbstractChoices]:
    """The choices that a kind of bearing has; register a new kind of bearing here.

    Args:
        bearing: A single row.
    """
    raise TypeError(
        f"BearingElement: `bearing` is a {type(bearing).__name__}; it must be a roller"
        " bearing, a ball bearing or a BearingSet."
    )


def usual_kinematics(
    rows: tuple[SetRow, ...], law: AbstractLineLaw
) -> AbstractKinematics:
    """Kinematics of rollers for which none are chosen.

    `Finite` for barrel rollers: to first order a toroidal bearing loses no clearance to
    a shift, and rollers that a spherical inner ring takes along as it tilts see no
    axial load. `Linearised` for others, and where `Finite` is not for the choices.
    """
    bearings: list[Any] = [row.bearing for row in rows]
    barrels = all(b.arc_radii is not None for b in bearings)
    measured = any(
        getattr(b, p).knots() is not None for b in bearings for p in PROFILES
    )
    exact = barrels and not measured and not isinstance(law, CoupledSlices)
    sprung = any(row.spring is not None for row in rows)
    return Finite() if exact and not sprung else Linearised()


class RollerChoices(AbstractChoices):
    """Line law, quadrature and kinematics of rollers.

    Attributes:
        line_law: Law of the raceway contacts.
        quadrature: Quadrature of independent slices; `None` with coupled slices.
        kinematics: Map from rigid motions to approaches.
    """

    line_law: AbstractLineLaw
    quadrature: AbstractQuadrature | None
    kinematics: AbstractKinematics

    elements = "rollers"
    names = ("line_law", "quadrature", "kinematics")

    @classmethod
    def from_rows(  # pyright: ignore[reportIncompatibleMethodOverride] its own `names`
        cls,
        rows: tuple[SetRow, ...],
        line_law: Any = None,
        quadrature: Any = None,
        kinematics: Any = None,
    ) -> "AbstractChoices":
        law = line_law or Palmgren()
        if isinstance(law, CoupledSlices):
            if quadrature:
                raise ValueError(
                    "BearingElement: `quadrature` is for independent slices, but"
                    " `line_law` is of coupled slices, which are there already."
                )
        else:
            quadrature = quadrature or ContactMapped()
        kinematics = kinematics or usual_kinematics(rows, law)
        return cls(line_law=law, quadrature=quadrature, kinematics=kinematics)

    def check(self, part: SetRow, speed: Speed | None) -> None:
        kinematics, bearing = self.kinematics, part.bearing
        kinematics.check("roller")
        assert isinstance(bearing, AbstractRollerBearing)
        if not kinematics.keeps_arcs or bearing.arc_radii is None:
            return
        if isinstance(self.line_law, CoupledSlices):
            raise ValueError(
                "BearingElement: `kinematics` is finite, which takes independent slices"
                " of barrel rollers, but `line_law` is of coupled slices; use"
                " linearised kinematics."
            )
        for which in PROFILES:
            if getattr(bearing, which).knots() is not None:
                raise ValueError(
                    "BearingElement: `kinematics` is finite, which takes no measured"
                    f" profiles of barrel rollers, as is `{which}`; use linearised"
                    " kinematics."
                )

    def rolling_element(
        self, part: SetRow, speed: Speed | None, deviation: Scalar | None
    ) -> AbstractRollingElement:
        # Coupled slices take a rule as all laws do, and do not use it.
        quadrature = self.quadrature or ContactMapped()
        bearing: Any = part.bearing
        exact = self.kinematics.keeps_arcs
        constants = contact_constants(
            bearing, self.line_law, quadrature, deviation, exact=exact
        )
        force = None if speed is None else inertia_force(constants, speed)
        if force is not None and bearing.caged and constants.ribs is None:
            force = force.at[0].set(0.0)
        return Roller(
            constants=constants,
            geometry=self.kinematics.roller(constants),
            quadrature=quadrature,
            body_force=force,
        )


class BallChoices(AbstractChoices):
    """Point law, raceway control and kinematics of balls.

    Attributes:
        point_law: Constants of the contacts.
        raceway_control: Raceway control of turning balls.
        kinematics: Map from rigid motions to positions of the groove centres.
    """

    point_law: AbstractPointLaw
    raceway_control: AbstractRacewayControl
    kinematics: AbstractKinematics

    elements = "balls"
    names = ("point_law", "raceway_control", "kinematics")

    @classmethod
    def from_rows(  # pyright: ignore[reportIncompatibleMethodOverride] its own `names`
        cls,
        rows: tuple[SetRow, ...],
        point_law: Any = None,
        raceway_control: Any = None,
        kinematics: Any = None,
    ) -> "AbstractChoices":
        aligning = any(row.bearing.aligns for row in rows)
        default = Finite() if aligning else Linearised()
        return cls(
            point_law=point_law or FreeAngle(),
            raceway_control=raceway_control or OuterControl(),
            kinematics=kinematics or default,
        )

    def check(self, part: SetRow, speed: Speed | None) -> None:
        kinematics, bearing = self.kinematics, part.bearing
        kinematics.check("ball")
        if bearing.aligns and not kinematics.turns_far:
            raise ValueError(
                "BearingElement: `kinematics` is for small rotations, with which a"
                " self-aligning bearing would resist its tilt; use finite kinematics."
            )
        if kinematics.holds_angles and len(bearing.axial_senses) > 1:
            raise ValueError(
                "BearingElement: `kinematics` is of a constant contact angle, for balls"
                " that have one: of angular contact and thrust bearings."
            )
        if part.spring is not None and kinematics.turns_far:
            raise ValueError(
                "BearingElement: `kinematics` is finite, and a spring presses a row,"
                " whose ring would slide along a tilted seat, which is not modelled;"
                " use linearised kinematics."
            )
        if speed is not None and kinematics.holds_angles:
            raise ValueError(
                "BearingElement: `kinematics` is of a constant contact angle, and"
                " nothing holds a turning ball along its raceways then; leave out the"
                " speed, or use linearised kinematics."
            )

    def rolling_element(
        self, part: SetRow, speed: Speed | None, deviation: Scalar | None
    ) -> AbstractRollingElement:
        bearing: Any = part.bearing
        diameter = bearing.ball_diameter
        balls, grooves = balls_of(bearing), bearing.grooves
        if deviation is not None:
            diameter = diameter + deviation
            balls = balls._replace(diameter=diameter)
        control, law = self.raceway_control, self.point_law
        inertia = (
            None if speed is None else ball_inertia(bearing, diameter, speed, control)
        )
        centres = jnp.stack([jnp.stack([g.axial, g.radial]) for g in grooves])
        geometry = GrooveGeometry(
            start=-centres,
            free=-centres / jnp.sqrt(jnp.sum(centres**2, axis=1, keepdims=True)),
            reach=jnp.stack([g.radius - 0.5 * diameter for g in grooves]),
            on_outer=tuple(g.on_outer for g in grooves),
            open_side=tuple(g.open_side for g in grooves),
            washers=bearing.is_thrust,
            straight=self.kinematics.holds_angles,
        )
        return Ball(
            grooves=geometry,
            geometry=self.kinematics.ball(part),
            constant=law.constants(balls, grooves, bearing.free_cosine),
            ball_diameter=diameter,
            # A contact pressed by a ten-thousandth of the ball diameter, E* D^(1/2).
            spring=TETHER * balls.modulus * diameter * 1e-2,
            ball_inertia=inertia,
            follows_angle=law.follows_angle,
        )


@choices_for.register
def _(bearing: AbstractRollerBearing) -> type[AbstractChoices]:
    return RollerChoices


@choices_for.register
def _(bearing: AbstractBallBearing) -> type[AbstractChoices]:
    return BallChoices


def in_one_dtype(tree: Any) -> Any:
    """All real numbers in JAX's floating type: float64, or float32 if that is off."""
    dtype = jax.dtypes.canonicalize_dtype(float)

    def cast_leaf(leaf):
        other = eqx.is_inexact_array(leaf) and leaf.dtype != dtype
        return leaf.astype(dtype) if other else leaf

    return jax.tree.map(cast_leaf, tree)


def check_kinds(choices: dict) -> None:
    """Raise unless each choice is `None` or of its class.

    A text or the class itself (`Finite` for `Finite()`) would be taken for another
    choice, and nothing would say so.
    """
    for name, value in choices.items():
        kind, allowed = CHOICE_KINDS[name]
        if value is not None and not isinstance(value, kind):
            of_itself = isinstance(value, type)
            shown = f"the class {value.__name__}" if of_itself else repr(value)
            raise TypeError(
                f"BearingElement: `{name}` is {shown}; it must be {allowed}."
            )

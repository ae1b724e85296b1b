"""Ball bearings as on the drawing: dimensions and their checks.

A groove is a torus: its section is a circle of the groove radius r = f D around the
groove centre, f being the osculation. Unloaded, a ball that touches both raceways has
its centre on the pitch circle at z = 0; the groove centre of the inner ring then stands
at (r_i - D/2) (sin α, cos α) from it in (z, r), that of the outer ring opposite. A
positive contact angle α carries an inner-ring load along +z.
"""

import abc
import dataclasses
import math
from typing import Annotated, Any, ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..numerics.types import (
    Number,
    Real,
    RealOrNone,
    Scalar,
    array_namespace,
    as_count,
    as_real,
    in_numpy,
)
from ..numerics.units import meaning, real, unit
from .abstract import AbstractBearing
from .checks import check, check_fields, floats, in_range, is_traced, number
from .deviation import check_deviation, check_raceways, check_spacing
from .material import Material
from .published import PublishedRatings


class Groove(NamedTuple):
    """One raceway arc, seen from the ball centre on the pitch circle.

    Attributes:
        on_outer: Whether it belongs to the outer ring. Static.
        axial: z of the groove centre [m].
        radial: Its r less the pitch radius [m].
        radius: Groove radius [m].
        open_side: Whether the raceway goes on as a cylinder beyond the groove
            bottom, so that it carries on one side only. Static.
        deepest: Cosine of the angle, from the middle of the raceway, at which the
            arc is deepest: 1 unless the raceway is two arcs [1].
    """

    on_outer: bool
    axial: Annotated[Scalar, unit("m")]
    radial: Annotated[Scalar, unit("m")]
    radius: Annotated[Scalar, unit("m")]
    open_side: bool
    deepest: Annotated[Scalar, unit("1")]


class AbstractBallBearing(AbstractBearing):
    """Single-row ball bearing: base class of all types.

    Attributes:
        n_balls: Number of balls.
        pitch_diameter: Diameter of the circle of the ball centres, D_pw [m].
        ball_diameter: Ball diameter, D_w [m].
        outer_osculation: Radius of the outer groove over the ball diameter, f_o [1];
            `None` if the raceway is a sphere, of a self-aligning bearing.
        inner_osculation: Radius of the inner groove over the ball diameter, f_i [1].
        first_azimuth: Azimuth of ball 0, from +x towards +y [rad].
        ball_deviation: Diameter of each ball less `ball_diameter` (ball,) [m];
            `None`: all equal.
        azimuth_deviation: Azimuth of each ball less that of even spacing (ball,)
            [rad]; `None`: evenly spaced.
        raceway_deviation: Deviation of outer and inner raceway at each ball
            (ball, 2, 3) [m]: the groove so much further along z and from the axis, the
            contact so much raised along its normal; `None`: as on the drawing.
        outer_shoulder: Height of the outer shoulders above the groove bottom [m];
            `None`: unknown, and truncation is not checked.
        inner_shoulder: Height of the inner shoulders above the groove bottom [m].
        material: Material of the balls.
        ring_material: Material of the rings; `None`: as the balls.
        published: Ratings and factors that a catalogue prints for it, or `None`.
        filled: Number of places with a ball, the first of `n_balls`
            (`with_places`); `None`: all.
    """

    noun: ClassVar[str] = "ball"
    is_thrust: ClassVar[bool] = False
    rated_fields: ClassVar[tuple[str, ...]] = (
        "n_balls",
        "pitch_diameter",
        "ball_diameter",
        "outer_osculation",
        "inner_osculation",
    )

    n_balls: int = eqx.field(
        static=True, converter=as_count, metadata=meaning("number of balls")
    )
    pitch_diameter: Real = eqx.field(
        **real("m", "diameter of the circle of the ball centres, D_pw", above=0)
    )
    ball_diameter: Real = eqx.field(**real("m", "ball diameter, D_w", above=0))
    outer_osculation: RealOrNone = eqx.field(
        **real("1", "radius of the outer groove over the ball diameter, f_o"),
        default=None,
        kw_only=True,
    )
    inner_osculation: Real = eqx.field(
        **real("1", "radius of the inner groove over the ball diameter, f_i"),
        kw_only=True,
    )
    first_azimuth: Real = eqx.field(
        **real("rad", "azimuth of ball 0, from +x towards +y"),
        default=0.0,
        kw_only=True,
    )
    ball_deviation: Float[Array, " ball"] | None = eqx.field(
        converter=as_real,
        metadata=unit(
            "m", "diameter of each ball less `ball_diameter`", otherwise="all equal"
        ),
        default=None,
        kw_only=True,
    )
    azimuth_deviation: Float[Array, " ball"] | None = eqx.field(
        converter=as_real,
        metadata=unit(
            "rad",
            "azimuth of each ball less that of even spacing",
            otherwise="evenly spaced",
        ),
        default=None,
        kw_only=True,
    )
    raceway_deviation: Float[Array, "ball 2 3"] | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None, kw_only=True
    )
    outer_shoulder: RealOrNone = eqx.field(
        **real(
            "m",
            "height of the outer shoulders above the groove bottom",
            otherwise="unknown, and truncation is not checked",
        ),
        default=None,
        kw_only=True,
    )
    inner_shoulder: RealOrNone = eqx.field(
        **real(
            "m",
            "height of the inner shoulders above the groove bottom",
            otherwise="unknown, and truncation is not checked",
        ),
        default=None,
        kw_only=True,
    )
    material: Material = eqx.field(default_factory=Material, kw_only=True)
    ring_material: Material | None = eqx.field(default=None, kw_only=True)
    published: PublishedRatings | None = eqx.field(default=None, kw_only=True)
    filled: Int[Array, ""] | None = eqx.field(default=None, kw_only=True)

    @property
    def n_places(self) -> int:
        """Number of places for balls."""
        return self.n_balls

    @property
    def element_diameter(self) -> Scalar:
        """Diameter of the balls [m]."""
        return self.ball_diameter

    @property
    def element_deviation(self) -> Float[Array, " ball"] | None:
        """Diameter of each ball less the common one [m]; `None`: all equal."""
        return self.ball_deviation

    @property
    def centre_distances(self) -> tuple[Scalar, Scalar]:
        """Groove radius less ball radius, outer and inner [m]."""
        assert self.outer_osculation is not None
        f = self.outer_osculation, self.inner_osculation
        return (f[0] - 0.5) * self.ball_diameter, (f[1] - 0.5) * self.ball_diameter

    @property
    def centre_distance(self) -> Scalar:
        """Distance A = (f_o + f_i - 1) D of the groove centres in contact [m]."""
        outer, inner = self.centre_distances
        return outer + inner

    @property
    def free_contact_angle(self) -> Scalar:
        """Contact angle of the unloaded bearing, pushed axially [rad]; 0 under preload.

        Its derivative is infinite where it leaves zero; `free_cosine` is smooth.
        """
        cosine = self.free_cosine
        xp, inside = array_namespace(cosine), cosine < 1.0
        return xp.where(inside, xp.arccos(xp.where(inside, cosine, 0.0)), 0.0)

    @property
    @abc.abstractmethod
    def clearance(self) -> Scalar:
        """Radial internal clearance, diametral: s = 2A (1 - cos α0) [m]."""

    @property
    @abc.abstractmethod
    def grooves(self) -> tuple[Groove, ...]:
        """All raceway arcs that a ball may touch, outer ring first."""

    @property
    def nominal_contact_angle(self) -> Scalar:
        return self.free_contact_angle

    @property
    def touching_angle(self) -> Scalar:
        return self.free_contact_angle

    def with_clearance(self, clearance: Scalar) -> Any:
        return dataclasses.replace(self, radial_internal_clearance=clearance)

    @property
    def raceway_diameters(self) -> tuple[Scalar, Scalar]:
        across = self.ball_diameter * self.free_cosine
        return self.pitch_diameter - across, self.pitch_diameter + across

    @property
    def deviation_bounds(self) -> tuple[Any, ...]:
        return self.centre_distances

    @property
    def axial_senses(self) -> frozenset[int]:
        return frozenset({1} if self.is_one_sided else {1, -1})

    @property
    def shoulders(self) -> tuple[Any, ...]:
        both = self.outer_shoulder, self.inner_shoulder
        return tuple(height for height in both if height is not None)

    @property
    def holds_axially(self) -> bool:
        return True

    @property
    def is_one_sided(self) -> bool:
        """Whether it carries axial load in one direction only."""
        return False

    @property
    def play(self) -> Scalar:
        axial = 2.0 * self.centre_distance * jnp.sin(self.free_contact_angle)
        if self.is_one_sided:
            return jnp.zeros_like(axial)  # the balls touch at zero displacement
        return jnp.maximum(axial, 0.5 * self.clearance)

    @property
    def groove_axis(self) -> Number:
        """Contact angle in the middle of the raceways [rad]."""
        return 0.0

    @property
    def axial_place(self) -> Scalar:
        """z of the circle of ball centres from the origin of the bearing [m]."""
        return jnp.zeros_like(self.pitch_diameter)

    def __check_init__(self):
        self._check_common()
        check_fields(self)
        own = in_numpy(self)
        for ring in ("outer", "inner"):
            own._check_groove(ring)
        own._check_row()
        own._check_deviation()

    def _check_groove(self, ring):
        name = f"{ring}_osculation"
        value = getattr(self, name)
        if value is None:
            raise ValueError(
                f"{type(self).__name__}: `{name}` is missing; give the groove radius"
                " over the ball diameter, such as 0.52."
            )
        number(self, name)
        numbers = floats(value)
        if numbers is not None:
            allowed = (
                "above 0.5 and below 1: groove radius over ball diameter, such as 0.52"
            )
            check(self, name, 0.5 < numbers[0] < 1.0, allowed)
        name = f"{ring}_shoulder"
        value = getattr(self, name)
        if value is None:
            return
        in_range(self, name, 0.0, self.ball_diameter)

    def _check_row(self):
        numbers = floats(
            self.pitch_diameter, self.ball_diameter, self.free_contact_angle
        )
        if numbers is None:
            return
        pitch, ball, angle = numbers
        allowed = (
            "small enough to leave an inner raceway inside the pitch circle of"
            f" {pitch:.6g} m"
        )
        fits = pitch > ball * math.cos(angle)
        check(self, "ball_diameter", fits, allowed)
        most = int(math.pi / math.asin(min(1.0, ball / pitch)))
        allowed = (
            "low enough that balls do not overlap around the pitch circle (at most"
            f" {most} of this size)"
        )
        if not is_traced(self.n_stated):
            n = int(self.n_stated)
            apart = n == 1 or ball < pitch * math.sin(math.pi / n)
            check(self, "n_balls", apart, allowed, n, "balls")

    def _check_deviation(self):
        what = "the diameter of each ball less `ball_diameter` in m"
        value = check_deviation(self, "ball_deviation", self.n_balls, what)
        numbers = floats(self.ball_diameter, *self.centre_distances)
        if numbers is None:
            return
        ball, *distances = numbers
        check_spacing(self, self.n_balls, ball)
        check_raceways(self, self.n_balls, min(distances))
        if value is None:
            return
        # A ball with the radius of its groove has no point contact.
        most = 2.0 * min(distances)
        allowed = (
            f"above {-ball:.6g} m and below {most:.6g} m, where a ball would"
            " be as large as its groove"
        )
        ok = (value < most) & (value > -ball)
        check(self, "ball_deviation", ok, allowed)

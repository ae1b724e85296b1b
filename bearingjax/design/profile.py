"""Profiles: how much material is removed along a roller or a raceway.

`drop` ≥ 0 is material removed, at the position s along the generator, s = 0 in the
middle. Roller and raceway take profiles of the same family; their drops add up in the
gap. Derivatives in s are finite everywhere, roller ends and kinks included.
"""

import abc
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..numerics.compiled.programs import program
from ..numerics.shown import Printable
from ..numerics.types import Number, Real, RealOrNone, Reals, Scalar
from ..numerics.units import real
from .checks import check, check_fields, in_range, is_traced

_PLACES = np.linspace(-0.999, 0.999, 257)
"""Positions in half lengths at which a profile is checked."""

_ROUND_OFF = 1e-12
"""Drop below zero that is none [m]."""


class AbstractProfile(Printable):
    """Profile of a roller or a raceway."""

    arcs: ClassVar[bool] = False
    """Whether it consists of straight lines and flat arcs with kinks between them."""

    protruding: ClassVar[bool] = False
    """Whether the drop may be negative somewhere: no roller then counts as open because
    the straight line between its raceways is."""

    def __check_init__(self):
        check_fields(self)

    @abc.abstractmethod
    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        """Material removed, measured along the normal of the straight generator.

        Args:
            position: s from the middle of the roller, |s| ≤ length/2 [m].
            length: Effective contact length L [m].
            diameter: Mean roller diameter D [m].

        Returns:
            Drop ≥ 0 [m], shape of `position`.
        """

    def kinks(self, length: Scalar) -> tuple[Scalar, ...]:
        """Interior positions where a derivative of the drop jumps, ascending [m]."""
        return ()

    def knots(self) -> Float[Array, " knot"] | None:
        """Positions of measured points, ascending [m]; `None` for a formula."""
        return None

    def between_knots(self, position: Reals) -> "AbstractProfile":
        """The profile between the two knots around each position [m].

        Its `drop` takes positions that broadcast with `position`.
        """
        return self

    def check(self, length: Scalar, diameter: Scalar) -> None:
        """Raise ValueError unless the profile fits a roller of this size [m]."""
        if any(is_traced(x) for x in (*jax.tree.leaves(self), length, diameter)):
            return
        self._check_against(float(length), float(diameter))
        # What stands out anywhere would be taken for open while it touches.
        places = np.array([-0.999, 0.999]) if self.protruding else _PLACES
        places = np.concatenate([[-1.0], places, [1.0]])
        at = 0.5 * np.asarray(length) * places
        with jax.ensure_compile_time_eval():  # a bearing may be changed under `jit`
            found = np.asarray(drops(self, at, length, diameter))
        fits = (found >= -_ROUND_OFF) & (found < 0.5 * float(diameter))
        check(
            self,
            "crown_drop",
            fits,
            "at least 0 all along the roller (a profile of your own may stand out if it"
            " is `protruding`) and below half the roller diameter,"
            f" {0.5 * float(diameter):.6g} m",
            found.min() if found.min() < -_ROUND_OFF else found.max(),
            "m",
        )

    def _check_against(self, length: float, diameter: float) -> None:
        """Checks of this kind of profile; all numbers are concrete."""


@program(quick=True)
def drops(
    profile: AbstractProfile,
    position: Array | np.ndarray,
    length: Scalar,
    diameter: Scalar,
) -> Array:
    """`AbstractProfile.drop`, compiled as a whole."""
    return profile.drop(jnp.asarray(position), length, diameter)


class Straight(AbstractProfile):
    """No profile: the drop is zero."""

    about: ClassVar[str] = "no profile: the drop is zero"
    arcs: ClassVar[bool] = True

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        return jnp.zeros_like(position)


class CircularCrown(AbstractProfile):
    """A full circular crown: one arc over the whole length.

    Attributes:
        crown_radius: Radius of the arc [m].

    Traced: all fields.
    Source: geometry, drop = R - sqrt(R² - s²).
    """

    about: ClassVar[str] = "a full circular crown: one arc over the whole length"
    arcs: ClassVar[bool] = True

    crown_radius: Real = eqx.field(**real("m", "radius of the arc", above=0))

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        return sagitta(position, self.crown_radius)

    def _check_against(self, length, diameter):
        _check_radius(self, "crown_radius", 0.5 * length)


class CrownedEnds(AbstractProfile):
    """A straight middle with an arc tangent to it at either end, and a dub-off.

    The dub-off is a sharper arc over the last part of the roller, tangent to the
    crown where it begins.

    Attributes:
        straight_length: Length of the straight middle [m].
        crown_radius: Radius of the arcs [m].
        dub_off_length: Length of the dub-off at either end, or `None` [m].
        dub_off_radius: Its radius, or `None` [m].

    Traced: all fields. Static: whether there is a dub-off.
    Source: geometry of tangent arcs.
    """

    about: ClassVar[str] = "a straight middle, an arc at either end, and a dub-off"
    arcs: ClassVar[bool] = True

    straight_length: Real = eqx.field(
        **real("m", "length of the straight middle", above=0)
    )
    crown_radius: Real = eqx.field(**real("m", "radius of the arcs", above=0))
    dub_off_length: RealOrNone = eqx.field(
        **real("m", "length of the dub-off at either end", above=0, otherwise="none"),
        default=None,
    )
    dub_off_radius: RealOrNone = eqx.field(
        **real("m", "radius of the dub-off", above=0, otherwise="none"), default=None
    )

    def __check_init__(self):
        if (self.dub_off_length is None) != (self.dub_off_radius is None):
            raise ValueError(
                "CrownedEnds: `dub_off_length` and `dub_off_radius` go together; one of"
                " them is missing."
            )

    def drop(self, position: Reals, length: Number, diameter: Number) -> Reals:
        out = jnp.maximum(jnp.abs(position) - 0.5 * self.straight_length, 0.0)
        if self.dub_off_length is None or self.dub_off_radius is None:
            return sagitta(out, self.crown_radius)
        begin = 0.5 * (length - self.straight_length) - self.dub_off_length
        crown = sagitta(jnp.minimum(out, begin), self.crown_radius)
        # The sharper arc has the same slope at `offset` from its top.
        offset = self.dub_off_radius * begin / self.crown_radius
        beyond = jnp.maximum(out - begin, 0.0)
        top = sagitta(offset, self.dub_off_radius)
        return crown + sagitta(offset + beyond, self.dub_off_radius) - top

    def kinks(self, length: Scalar) -> tuple[Scalar, ...]:
        inner = 0.5 * self.straight_length
        if self.dub_off_length is None:
            return (-inner, inner)
        outer = 0.5 * length - self.dub_off_length
        return (-outer, -inner, inner, outer)

    def _check_against(self, length, diameter):
        in_range(self, "straight_length", 0.0, length)
        straight, crown = float(self.straight_length), float(self.crown_radius)
        reach = 0.5 * (length - straight)
        _check_radius(self, "crown_radius", reach)
        if self.dub_off_length is None or self.dub_off_radius is None:
            return
        in_range(self, "dub_off_length", 0.0, reach)
        ending, radius = float(self.dub_off_length), float(self.dub_off_radius)
        offset = radius * (reach - ending) / crown
        _check_radius(self, "dub_off_radius", offset + ending)
        allowed = f"at most the crown radius, {crown:.6g} m"
        check(self, "dub_off_radius", radius <= crown, allowed)


@jax.custom_jvp
def sagitta(x: Reals, radius: Scalar) -> Reals:
    """Drop of a circle, R - sqrt(R² - x²), without cancellation [m].

    Args:
        x: Distance from the top, |x| < R [m].
        radius: R [m].
    """
    return x * x / (radius + jnp.sqrt(radius * radius - x * x))


def between_arcs(position: Reals, radii: tuple[Scalar, Scalar]) -> Reals:
    """Drop of a barrel from a concave raceway that it touches in the middle [m].

    Args:
        position: s from the middle [m].
        radii: Radii of the arcs of roller and raceway [m].
    """
    return sagitta(position, radii[0]) - sagitta(position, radii[1])


@sagitta.defjvp
def _sagitta_rule(primals, tangents):
    # By hand: differentiated quotients would need a division for each derivative.
    (x, radius), (dx, dradius) = primals, tangents
    drop = sagitta(x, radius)
    inverse = _inverse_root(radius * radius - x * x)
    return drop, inverse * (x * dx - drop * dradius)


@jax.custom_jvp
def _inverse_root(x):
    return 1.0 / jnp.sqrt(x)


@_inverse_root.defjvp
def _inverse_root_rule(primals, tangents):
    (x,), (dx,) = primals, tangents
    value = _inverse_root(x)
    return value, -0.5 * value * value * value * dx


def _check_radius(owner, name, reach):
    allowed = f"above {reach:.6g} m, so that the arc spans its part of the roller"
    check(owner, name, float(getattr(owner, name)) > reach, allowed)

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

from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .checks import check, in_range, is_traced, positive

STEEL_MODULUS = 206e9 / (2.0 * (1.0 - 0.3**2))
"""Contact modulus E* of steel on steel [Pa]."""


class AbstractProfile(eqx.Module):
    """Profile of a roller or a raceway."""

    arcs: ClassVar[bool] = False
    """Whether it is made of straight lines and flat arcs, kinks between them."""

    protruding: ClassVar[bool] = False
    """Whether the drop may be negative somewhere."""

    @abc.abstractmethod
    def drop(
        self, position: Float[Array, "..."], length: Scalar, diameter: Scalar
    ) -> Float[Array, "..."]:
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

    def around(self, position: Float[Array, "..."]) -> "AbstractProfile":
        """The profile between the two knots around each position [m].

        Its `drop` takes positions of a shape that goes with that of `position`.
        """
        return self

    def check(self, length: Scalar, diameter: Scalar) -> None:
        """Raise ValueError unless the profile fits a roller of this size [m]."""
        if any(is_traced(x) for x in (*jax.tree.leaves(self), length, diameter)):
            return
        self._check_against(float(length), float(diameter))
        ends = 0.5 * np.asarray(length) * np.array([-1.0, -0.999, 0.999, 1.0])
        drops = np.asarray(_drop(self, ends, length, diameter))
        fits = (drops >= 0) & (drops < 0.5 * float(diameter))
        check(
            self,
            "crown_drop",
            fits,
            "at least 0 and below half the roller diameter,"
            f" {0.5 * float(diameter):.6g} m",
            drops.max(),
            "m",
        )

    def _check_against(self, length: float, diameter: float) -> None:
        """What a profile has to check of its own, if all numbers are concrete."""


@eqx.filter_jit
def _drop(profile, position, length, diameter):
    return profile.drop(position, length, diameter)


class Straight(AbstractProfile):
    """No profile: the drop is zero."""

    arcs: ClassVar[bool] = True

    def drop(self, position, length, diameter):
        return jnp.zeros_like(position)


class CircularCrown(AbstractProfile):
    """A full circular crown: one arc over the whole length.

    Attributes:
        crown_radius: Radius of the arc [m].

    Traced: all fields.
    Source: geometry, drop = R - sqrt(R² - s²).
    """

    arcs: ClassVar[bool] = True

    crown_radius: Scalar = eqx.field(converter=as_real, metadata=unit("m"))

    def __check_init__(self):
        positive(self, "crown_radius")

    def drop(self, position, length, diameter):
        return _arc(position, self.crown_radius)

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

    arcs: ClassVar[bool] = True

    straight_length: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    crown_radius: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    dub_off_length: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None
    )
    dub_off_radius: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None
    )

    def __check_init__(self):
        positive(self, "straight_length")
        positive(self, "crown_radius")
        if (self.dub_off_length is None) != (self.dub_off_radius is None):
            raise ValueError(
                "CrownedEnds: `dub_off_length` and `dub_off_radius` go together; one of"
                " them is missing."
            )
        if self.dub_off_length is not None:
            positive(self, "dub_off_length")
            positive(self, "dub_off_radius")

    def drop(self, position, length, diameter):
        out = jnp.maximum(jnp.abs(position) - 0.5 * self.straight_length, 0.0)
        if self.dub_off_length is None or self.dub_off_radius is None:
            return _arc(out, self.crown_radius)
        begin = 0.5 * (length - self.straight_length) - self.dub_off_length
        crown = _arc(jnp.minimum(out, begin), self.crown_radius)
        # The same slope on the sharper circle is met at `offset` from its top.
        offset = self.dub_off_radius * begin / self.crown_radius
        beyond = jnp.maximum(out - begin, 0.0)
        top = _arc(offset, self.dub_off_radius)
        return crown + _arc(offset + beyond, self.dub_off_radius) - top

    def kinks(self, length):
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


class Logarithmic(AbstractProfile):
    """Logarithmic profile of ISO/TS 16281, 0.00035 D ln(1/(1 - (2s/L)²)).

    Infinite at the very end; here limited to 354 times coefficient times D,
    which no load reaches.

    Attributes:
        coefficient: 0.00035 in the standard [1].

    Traced: all fields.
    Source: ISO/TS 16281:2008, reference geometry of rollers.
    """

    coefficient: Scalar = eqx.field(
        converter=as_real, metadata=unit("1"), default=0.00035
    )

    def __check_init__(self):
        positive(self, "coefficient")

    def drop(self, position, length, diameter):
        return self.coefficient * diameter * _log_one_over(2.0 * position / length, 1.0)


class Lundberg(AbstractProfile):
    """Lundberg's profile: even pressure along the roller at the design load.

    Drop Q/(π L E*) ln(1/(1 - (2s/L)²)), infinite at the very end and limited there as
    in `Logarithmic`. It is the drop of roller and raceway together: put it on one.

    Attributes:
        design_load: Load Q of the contact for which it is made [N].
        contact_modulus: E* of the pair [Pa].

    Traced: all fields.
    Source: Lundberg (1939); in the form of Fujiwara and Kawase (2007).
    """

    design_load: Scalar = eqx.field(converter=as_real, metadata=unit("N"))
    contact_modulus: Scalar = eqx.field(
        converter=as_real, metadata=unit("Pa"), default=STEEL_MODULUS
    )

    def __check_init__(self):
        positive(self, "design_load")
        positive(self, "contact_modulus")

    def drop(self, position, length, diameter):
        unit = self.design_load / (jnp.pi * length * self.contact_modulus)
        return unit * _log_one_over(2.0 * position / length, 1.0)


class JohnsGohar(AbstractProfile):
    """Johns and Gohar's profile: Lundberg's with a finite end.

    Drop Q/(π L E*) ln(1/(1 - (1 - 0.3033 b/a)(2s/L)²)) with a = L/2.

    Attributes:
        design_load: Load Q of the contact for which it is made [N].
        half_width: Hertz half width b of the contact at that load, from
            `contact.half_width(Q/L, relative radius, E*)` [m].
        contact_modulus: E* of the pair [Pa].

    Traced: all fields.
    Source: Johns and Gohar (1981); in the form of Fujiwara and Kawase (2007).
    """

    design_load: Scalar = eqx.field(converter=as_real, metadata=unit("N"))
    half_width: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    contact_modulus: Scalar = eqx.field(
        converter=as_real, metadata=unit("Pa"), default=STEEL_MODULUS
    )

    def __check_init__(self):
        positive(self, "design_load")
        positive(self, "half_width")
        positive(self, "contact_modulus")

    def drop(self, position, length, diameter):
        unit = self.design_load / (jnp.pi * length * self.contact_modulus)
        part = 1.0 - 0.3033 * self.half_width / (0.5 * length)
        return unit * _log_one_over(2.0 * position / length, part)

    def _check_against(self, length, diameter):
        in_range(self, "half_width", 0.0, 0.5 * length)


class FujiwaraKawase(AbstractProfile):
    """Fujiwara and Kawase's modified logarithmic profile, three design parameters.

    With A = K1 Q/(π L E*) and x running from 0 where the crowning begins to 1 at the
    end of the roller, drop = A ln(1/(1 - (1 - exp(-zm/A)) x²)); the middle is straight.
    The end drop is limited to some 350 A, which no load reaches.

    Attributes:
        design_load: Load Q of the contact [N].
        load_factor: K1, factor on the design load [1].
        crowned_fraction: K2, crowned part of the length, 0 < K2 ≤ 1 [1].
        end_drop: zm, drop at the very end [m].
        contact_modulus: E* of the pair [Pa].

    Traced: all fields.
    Source: Fujiwara and Kawase, NTN Technical Review 75 (2007), their E' = 2 E*.
    """

    design_load: Scalar = eqx.field(converter=as_real, metadata=unit("N"))
    load_factor: Scalar = eqx.field(converter=as_real, metadata=unit("1"))
    crowned_fraction: Scalar = eqx.field(converter=as_real, metadata=unit("1"))
    end_drop: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    contact_modulus: Scalar = eqx.field(
        converter=as_real, metadata=unit("Pa"), default=STEEL_MODULUS
    )

    def __check_init__(self):
        positive(self, "design_load")
        positive(self, "load_factor")
        positive(self, "crowned_fraction")
        if not is_traced(self.crowned_fraction):
            fraction, allowed = float(self.crowned_fraction), "above 0 and at most 1"
            check(self, "crowned_fraction", fraction <= 1.0, allowed)
        positive(self, "end_drop")
        positive(self, "contact_modulus")

    def drop(self, position, length, diameter):
        load = self.load_factor * self.design_load
        unit = load / (jnp.pi * length * self.contact_modulus)
        # From the end of the roller, where 1 - x² would cancel: x = 1 - out.
        crowned = 0.5 * length * self.crowned_fraction
        out = jnp.minimum((0.5 * length - jnp.abs(position)) / crowned, 1.0)
        rest = out * (2.0 - out) + jnp.exp(-self.end_drop / unit) * (1.0 - out) ** 2
        return -unit * jnp.log(_floored(rest))

    def kinks(self, length):
        begin = 0.5 * length * (1.0 - self.crowned_fraction)
        return (-begin, begin)


class Tabulated(AbstractProfile):
    """A measured profile: a cubic from each point to the next.

    Its slope in each point is that of the parabola through the point and both
    neighbours, so that a parabolic crown is met exactly. From a step the cubics swing
    out on both sides, by 0.074 of its height at even distances. With `ContactMapped`
    every high spot bears, to 1e-6 of the load, at a time that grows with the points: of
    fifty, four times that of five; of five hundred, forty. Thin what is smooth.

    Attributes:
        positions: s, ascending, from one roller end to the other or beyond (n,) [m].
        drops: Drop there, at least 0 (n,) [m].

    Traced: all fields. Static: the number of points.
    Source: Overhauser (1968), for points at any distance.
    """

    positions: Float[Array, " table"] = eqx.field(converter=as_real, metadata=unit("m"))
    drops: Float[Array, " table"] = eqx.field(converter=as_real, metadata=unit("m"))

    protruding: ClassVar[bool] = True
    """Between its points a cubic may swing out."""

    def __check_init__(self):
        shape = jnp.shape(self.positions)
        if len(shape) != 1 or shape[0] < 3 or jnp.shape(self.drops) != shape:
            raise ValueError(
                f"Tabulated: `positions` and `drops` have shapes {shape} and"
                f" {jnp.shape(self.drops)}; they must be two lists of the same length,"
                " at least 3."
            )
        if is_traced(self.positions) or is_traced(self.drops):
            return
        positions, drops = np.asarray(self.positions), np.asarray(self.drops)
        for name, values in (("positions", positions), ("drops", drops)):
            check(self, name, np.isfinite(values), "finite numbers")
        check(self, "positions", np.diff(positions) > 0, "ascending")
        check(self, "drops", drops >= 0, "at least 0 m")

    def drop(self, position, length, diameter):
        return self.around(position).drop(position, length, diameter)

    def knots(self):
        return self.positions

    def around(self, position):
        s, d = self.positions, self.drops
        last = s.shape[0] - 1
        k = jnp.clip(jnp.searchsorted(s, position, side="right") - 1, 0, last - 1)
        step = s[k + 1] - s[k]
        chord = (d[k + 1] - d[k]) / step

        def bend(middle):
            i = jnp.clip(middle, 1, last - 1)
            left, right = s[i] - s[i - 1], s[i + 1] - s[i]
            turn = (d[i + 1] - d[i]) / right - (d[i] - d[i - 1]) / left
            return turn / (left + right)

        # The parabola of the left point passes into that of the right one.
        first = bend(k)
        more = bend(k + 1) - first
        return _Cubic(s[k], (d[k], chord - step * first, first - more, more / step))

    def _check_against(self, length, diameter):
        positions, end = np.asarray(self.positions), 0.5 * length
        covers = min(-positions[0], positions[-1]) >= end * (1.0 - 1e-9)
        allowed = f"a table that covers the roller, from {-end:.6g} to {end:.6g} m"
        check(self, "positions", covers, allowed)


class _Cubic(AbstractProfile):
    """Between two points of a table.

    Attributes:
        start: The first of them (...) [m].
        factors: Of the powers 0 to 3 of the distance from there (...) [m^(1-power)].
    """

    protruding: ClassVar[bool] = True

    start: Float[Array, "..."]
    factors: tuple[Float[Array, "..."], ...]

    def drop(self, position, length, diameter):
        x = position - self.start
        constant, first, second, third = self.factors
        return constant + x * (first + x * (second + x * third))


@jax.custom_jvp
def _arc(x, radius):
    """Drop of a circle, R - sqrt(R² - x²), without cancellation."""
    return x * x / (radius + jnp.sqrt(radius * radius - x * x))


@_arc.defjvp
def _arc_rule(primals, tangents):
    # By hand, as quotients cost a division for each derivative of each derivative.
    (x, radius), (dx, dradius) = primals, tangents
    drop = _arc(x, radius)
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


def _log_one_over(x, part):
    """ln(1/(1 - part x²)), limited where the argument vanishes."""
    root = jnp.sqrt(part)
    rest = (1.0 - root * x) * (1.0 + root * x)
    if rest.dtype == jnp.float64:
        return -jnp.log(_floored(rest))
    # float32 has no number so small that loads would not reach the drop that it leaves,
    # and a rounding of the position beside the end is no better.
    least = 8.0 * jnp.finfo(rest.dtype).eps
    return jnp.where(rest > least, -jnp.log(jnp.maximum(rest, least)), _MOST)


_MOST = 354.198209
"""Logarithm at the very end of a profile that is infinite there [1]: that of float64,
half of ln(1/2.2e-308)."""


def _floored(rest):
    """At least the root of the smallest number, which keeps first and second
    derivatives of its logarithm in range."""
    return jnp.maximum(rest, jnp.sqrt(jnp.finfo(rest.dtype).tiny))


def _check_radius(owner, name, reach):
    allowed = f"above {reach:.6g} m, so that the arc spans its part of the roller"
    check(owner, name, float(getattr(owner, name)) > reach, allowed)

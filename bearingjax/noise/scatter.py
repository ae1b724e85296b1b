"""Scatter of production: random errors of bearings within tolerances.

Sources, each of which may be absent: diameters of the rolling elements, their spacing
by the cage, eccentricity and waves of both raceways, waves of the elements. A source of
scale s gives errors in proportion to s; the random numbers behind them do not depend
on s.
"""

import dataclasses
from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import (
    AbstractBearing,
    BearingSet,
    rows_of,
)
from ..design.checks import check, floats, instance, non_negative, of_class
from ..design.form_error import FormErrors, Harmonics, RacewayErrors
from ..design.tolerance import RunningAccuracy, element_grade
from ..numerics.types import Real, RealOrNone, array_namespace, as_real, in_numpy
from ..numerics.units import real, unit

PEAKS_IN_RMS = 6.0
"""Peak to valley of random waves over their root mean square [1]: ±3 of it."""


SOURCES = {
    "diameter": "diameters of the rolling elements",
    "spacing": "spacing of the rolling elements",
    "outer_eccentricity": "eccentricity of the outer raceway",
    "inner_eccentricity": "eccentricity of the inner raceway",
    "outer_axial": "axial waves of the outer raceway",
    "outer_outwards": "radial waves of the outer raceway",
    "inner_axial": "axial waves of the inner raceway",
    "inner_outwards": "radial waves of the inner raceway",
    "elements": "form of the rolling elements",
}
"""Descriptions of the sources of `Tolerances` by name."""
_WAVES = "outer_axial", "outer_outwards", "inner_axial", "inner_outwards", "elements"


class RandomWaves(eqx.Module):
    """Random waves of a surface: a_k = amplitude (low/k)^slope, times a random size.

    Sizes and phases of all orders are independent: cosine and sine of a wave are each
    distributed normally, so that its size has Rayleigh's distribution with mean square
    1, and its phase is even over the turn.

    Attributes:
        amplitude: Root mean square over bearings of the amplitude of order `low` [m].
        low: First order.
        high: Last order.
        slope: Exponent of the fall over the order [1].
        varies: Whether sizes are random; otherwise they are 1 and only phases are.

    Traced: amplitude, slope. Static: low, high, varies.
    """

    amplitude: Real = eqx.field(**real("m"))
    low: int = eqx.field(static=True)
    high: int = eqx.field(static=True)
    slope: Real = eqx.field(**real("1"), default=1.0)
    varies: bool = eqx.field(static=True, default=True)

    def __check_init__(self):
        non_negative(self, "amplitude")
        for name in ("low", "high"):
            value = getattr(self, name)
            whole = isinstance(value, int) and not isinstance(value, bool)
            check(self, name, whole and value >= 1, "a whole number from 1", value, "")
        allowed = f"{self.low}, the first order, or more"
        check(self, "high", self.high >= self.low, allowed, self.high, "")

    @classmethod
    def of_root_mean_square(
        cls, height: Any, low: int, high: int, slope: Any = 1.0, varies: bool = True
    ) -> "RandomWaves":
        """Create waves of a given root mean square over circumference and bearings.

        Args:
            height: Root mean square height [m]: its square is Σ a_k²/2.
            low, high, slope, varies: See the class.
        """
        one = cls(1.0, low, high, slope, varies)
        square = 0.5 * (in_numpy(one)._shares() ** 2).sum()
        shape = array_namespace(square).sqrt(square)
        return cls(in_numpy(as_real(height)) / shape, low, high, slope, varies)

    def _shares(self):
        share = self.low / np.arange(self.low, self.high + 1)
        return share.astype(self.slope.dtype) ** self.slope

    def sample(self, key: Array, shape: tuple[int, ...] = ()) -> Harmonics:
        """Draw random waves.

        Args:
            key: Key of `jax.random`.
            shape: Shape of the array of surfaces that are drawn.
        """
        sized, turned = jax.random.split(key)
        every = *shape, self.high - self.low + 1
        real = self.amplitude.dtype
        phase = jax.random.uniform(turned, every, real, 0.0, 2.0 * jnp.pi)
        amplitude = jnp.broadcast_to(self.amplitude * self._shares(), every)
        if self.varies:
            square = jax.random.exponential(sized, every, real)
            amplitude = amplitude * jnp.sqrt(square)
        return Harmonics(range(self.low, self.high + 1), amplitude, phase)

    def scale(self, factor: Any) -> "RandomWaves":
        """Return a copy with `factor` times the amplitudes [1]."""
        return eqx.tree_at(lambda w: w.amplitude, self, factor * self.amplitude)


class SampledErrors(NamedTuple):
    """Deviations of one bearing from its design.

    Attributes:
        diameter: Deviation of the diameter of each rolling element (element,) [m];
            `None`: none.
        azimuth: Deviation of the azimuth of each rolling element (element,) [rad];
            `None`: none.
        errors: Form errors.
    """

    diameter: Annotated[Float[Array, " element"] | None, unit("m")]
    azimuth: Annotated[Float[Array, " element"] | None, unit("rad")]
    errors: FormErrors


class Tolerances(eqx.Module):
    """Random errors of bearings of one design; `None`: none.

    Attributes:
        diameter: Range of the diameters of the rolling elements of one bearing [m];
            they are distributed uniformly about the nominal one.
        spacing: Range of the azimuth of a rolling element in its pocket [rad].
        outer_eccentricity: Root mean square over bearings of the eccentricity of the
            outer raceway; its cosine and sine are distributed normally [m].
        inner_eccentricity: Root mean square over bearings of the eccentricity of the
            inner raceway [m].
        outer_axial: Waves of the outer raceway along the axis.
        outer_outwards: Waves of the outer raceway away from the axis.
        inner_axial: Waves of the inner raceway along the axis.
        inner_outwards: Waves of the inner raceway away from the axis.
        elements: Waves of every rolling element around its circle of rolling.

    Traced: all real numbers.
    """

    diameter: RealOrNone = eqx.field(**real("m"), default=None)
    spacing: RealOrNone = eqx.field(**real("rad"), default=None)
    outer_eccentricity: RealOrNone = eqx.field(
        **real("m", "standard deviation of the outer raceway's eccentricity"),
        default=None,
    )
    inner_eccentricity: RealOrNone = eqx.field(
        **real("m", "standard deviation of the inner raceway's eccentricity"),
        default=None,
    )
    outer_axial: RandomWaves | None = None
    outer_outwards: RandomWaves | None = None
    inner_axial: RandomWaves | None = None
    inner_outwards: RandomWaves | None = None
    elements: RandomWaves | None = None

    def __check_init__(self):
        for field in dataclasses.fields(self):
            if field.name in _WAVES:
                instance(self, field.name, RandomWaves, None)
            elif getattr(self, field.name) is not None:
                non_negative(self, field.name)

    @classmethod
    def of_grade(
        cls,
        grade: str,
        bearing: AbstractBearing | BearingSet,
        *,
        runout: RunningAccuracy | None = None,
        waviness: Any = None,
        axial_waviness: Any = None,
        spacing: Any = None,
        highest: tuple[int, int] = (100, 40),
        slope: Any = 1.0,
    ) -> "Tolerances":
        """Create tolerances from a grade of rolling elements, read as distributions.

        A standard bounds parts and says nothing of how they scatter. Here:

        * diameters are even over the variation that a lot is allowed, V_DwL;
        * form errors of an element are waves of orders 2 up whose root mean square is
          a sixth of the deviation of form allowed (`PEAKS_IN_RMS`);
        * cosine and sine of a raceway's eccentricity have the standard deviation of a
          third of the eccentricity allowed, which is half of the runout allowed;
        * waves of raceways are in no standard and must be given.

        Args:
            grade: "G10" of balls or "II" of rollers; see `ball_grade`, `roller_grade`.
            bearing: The bearing; of a set the first row counts.
            runout: Radial runout of the rings, from `running_accuracy`; `None`: no
                eccentricity.
            waviness: Root mean square of the heights of both raceways outwards,
                orders 2 to the first of `highest` [m]; `None`: none.
            axial_waviness: Root mean square of the heights of both raceways along the
                axis [m]; `None`: none.
            spacing: See the class [rad].
            highest: Last orders of the raceways and of the rolling elements.
            slope: Slope of all waves [1].

        Raises:
            TypeError: For another bearing.
            ValueError: If there is no such grade.
        """
        owner, kinds = "Tolerances.of_grade", AbstractBearing | BearingSet
        of_class(owner, "bearing", bearing, kinds, "of balls or rollers")
        row = rows_of(bearing)[0].bearing
        found = element_grade(grade, row)

        def waves(height, low, high):
            if height is None:
                return None
            return RandomWaves.of_root_mean_square(height, low, high, slope)

        of_raceways, of_elements = highest
        radial = waves(waviness, 2, of_raceways)
        axial = waves(axial_waviness, 2, of_raceways)
        share = 0.5 / 3.0 * np.sqrt(2.0)
        return cls(
            diameter=found.lot_variation,
            spacing=spacing,
            outer_eccentricity=None if runout is None else share * runout.outer,
            inner_eccentricity=None if runout is None else share * runout.inner,
            outer_axial=axial,
            outer_outwards=radial,
            inner_axial=axial,
            inner_outwards=radial,
            elements=waves(found.form / PEAKS_IN_RMS, 2, of_elements),
        )

    @property
    def sources(self) -> tuple[str, ...]:
        """Names of the sources present."""
        names = (field.name for field in dataclasses.fields(self))
        return tuple(name for name in names if getattr(self, name) is not None)

    def scale(self, factors: Mapping[str, Any]) -> "Tolerances":
        """Return a copy with some sources scaled.

        Args:
            factors: By the names of sources [1]; 0 switches one off, and leaves the
                program as it is.

        Raises:
            ValueError: For an unknown source.
        """
        for name in factors:
            if name not in self.sources:
                raise ValueError(
                    f"Tolerances.scale: there is no source {name!r}; sources are"
                    f" {', '.join(self.sources) or 'none'}."
                )
        names = tuple(factors)

        def one(name):
            value, factor = getattr(self, name), factors[name]
            waves = isinstance(value, RandomWaves)
            return value.scale(factor) if waves else factor * value

        return eqx.tree_at(
            lambda t: [getattr(t, name) for name in names],
            self,
            [one(name) for name in names],
        )

    def check(self, bearing: AbstractBearing) -> None:
        """Raise if rolling elements of a bearing could overlap around their circle.

        Raises:
            ValueError: If neighbours could, with the worst of spacing and diameter.
        """
        nominal = bearing.element_diameter
        zero = jnp.zeros(())
        diameter = zero if self.diameter is None else self.diameter
        spacing = zero if self.spacing is None else self.spacing
        numbers = floats(nominal, bearing.pitch_diameter, diameter, spacing)
        if numbers is None:
            return
        nominal, pitch, diameter, spacing = numbers
        largest = nominal + 0.5 * diameter
        needed = 2.0 * np.arcsin(min(1.0, largest / pitch))
        room = 2.0 * np.pi / bearing.n_elements - needed
        allowed = f"at most {room:.4g} rad, the room between two neighbours"
        check(self, "spacing", spacing <= room, allowed, spacing, "rad")


def sample_errors(
    tolerances: Tolerances,
    bearing: AbstractBearing,
    key: Array,
) -> SampledErrors:
    """Draw the random errors of one bearing.

    Args:
        tolerances: Scatter of the bearings.
        bearing: Bearing of one row.
        key: Key of `jax.random`. Each source draws with a key of its own: what another
            source is like does not change it.

    Returns:
        Drawn, differentiable with respect to the tolerances.
    """
    count = bearing.n_elements
    names = [field.name for field in dataclasses.fields(tolerances)]
    keys = {name: jax.random.fold_in(key, k) for k, name in enumerate(names)}

    def sample(name):
        width = getattr(tolerances, name)
        if width is None:
            return None
        return width * jax.random.uniform(keys[name], (count,), width.dtype, -0.5, 0.5)

    def waves(name, shape=()):
        found = getattr(tolerances, name)
        return () if found is None else (found.sample(keys[name], shape),)

    def raceway(ring):
        name, outwards = f"{ring}_eccentricity", waves(f"{ring}_outwards")
        size = getattr(tolerances, name)
        if size is not None:
            outwards += (RandomWaves(size, 1, 1).sample(keys[name]),)
        return RacewayErrors(waves(f"{ring}_axial"), outwards)

    errors = FormErrors(raceway("outer"), raceway("inner"), waves("elements", (count,)))
    return SampledErrors(sample("diameter"), sample("spacing"), errors)

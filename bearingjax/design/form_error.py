"""Form errors of raceways and rolling elements, as functions of the angle around them.

Heights are of material that is there beyond the drawing. On a raceway an error either
shifts the groove at that place, along the axis or outwards from it, or raises the
surface towards the rolling element. Every error turns with the part that it is on.
"""

import abc
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..numerics.types import (
    Real,
    Reals,
    Scalar,
    Vector,
    array_namespace,
    as_real,
    in_numpy,
)
from ..numerics.units import real, unit
from .abstract import AbstractBearing
from .checks import (
    all_of_class,
    check,
    finite,
    instance,
    is_real,
    is_traced,
    must_be,
    of_shape,
)
from .deviation import largest_deviation

_NODES = 256
"""Nodes across a contact, enough for waves as short as a hundredth of it."""


class Surface(NamedTuple):
    """Geometry of a rolling contact around a part.

    Attributes:
        radius: Radius of the circle of contact around the part's axis [m].
        relative: Radius of relative curvature along the rolling direction [m].
        half_width: Half width of the contact along the rolling direction, which bridges
            waves [m]; `None`: waves act in full.
        pressure: Exponent p of its pressure (1 - s²)^p, summed across the rolling
            direction: 1 of an ellipse, 1/2 of a line [1].
    """

    radius: Annotated[Scalar, unit("m")]
    relative: Annotated[Scalar, unit("m")]
    half_width: Annotated[Scalar | None, unit("m")] = None
    pressure: Scalar | None = None

    def bridged_share(self, order: Vector) -> Vector:
        """Share of waves that acts on a contact, the mean over its pressure (n,) [1].

        Args:
            order: Waves per turn (n,) [1].

        Source: ∫(1 - s²)^p cos(x s) ds / ∫(1 - s²)^p ds, x = k b/R, of half width b.
        """
        if self.half_width is None or self.pressure is None:
            return jnp.ones_like(order)
        turn = jnp.pi / _NODES * (jnp.arange(_NODES, dtype=order.dtype) + 0.5)
        weight = jnp.sin(turn) ** (2.0 * self.pressure + 1.0)
        x = order * (self.half_width / self.radius)
        return jnp.cos(jnp.outer(x, jnp.cos(turn))) @ (weight / jnp.sum(weight))


class AbstractShape(eqx.Module):
    """One error of form around a part."""

    @abc.abstractmethod
    def height(self, angle: Reals, surface: Surface) -> Any:
        """Height at an angle around the part [m].

        Args:
            angle: From the part's own mark (...) [rad]; any number of turns.
            surface: Contact track.
        """


def _listed(given) -> Array:
    """Numbers in an array of at least one axis."""
    given = in_numpy(as_real(given))
    return as_real(array_namespace(given).atleast_1d(given))


def _orders(given) -> tuple:
    """Orders as they were given, in a tuple."""
    given = np.atleast_1d(np.asarray(given))
    return tuple(k.item() for k in given)


class Harmonics(AbstractShape):
    """Waves: Σ_k a_k cos(k angle + phase_k).

    Order 1 on a raceway is eccentricity (or an axial runout), 2 an oval ring, 3 and
    more the lobes of a chuck or a seat. Waves that are shorter than a contact is long
    are met as they are, where a real contact bridges them, unless the surface has a
    `half_width` (`noise.with_bridged_waves`).

    Attributes:
        order: Waves per turn (n,), whole numbers from 1.
        amplitude: Amplitude of each, half of peak to valley (n,) [m].
        phase: Phase of each at the part's mark (n,) [rad]; default 0.

    Traced: amplitude, phase. Static: order.
    """

    order: tuple[int, ...] = eqx.field(static=True, converter=_orders)
    amplitude: Reals = eqx.field(converter=as_real, metadata=unit("m"))
    phase: Reals = eqx.field(converter=as_real, metadata=unit("rad"), default=None)

    def __init__(self, order: Any, amplitude: Any, phase: Any = None):
        """See the class.

        Raises:
            TypeError: For values that are not numbers.
            ValueError: For orders that are not whole and positive, or another number
                of amplitudes or phases.
        """
        self.order = _orders(order)
        count = len(self.order)
        for name, given in (("amplitude", amplitude), ("phase", phase)):
            fine = given is None or is_real(given)
            must_be("Harmonics", name, given, fine, "numbers", TypeError)
        whole = all(isinstance(k, int) and k >= 1 for k in self.order)
        check("Harmonics", "order", whole, "whole numbers from 1", list(self.order), "")
        self.amplitude = _listed(amplitude)
        zeros = np.zeros(self.amplitude.shape, self.amplitude.dtype)
        self.phase = _listed(zeros if phase is None else phase)
        for name in ("amplitude", "phase"):
            value = getattr(self, name)
            if value.shape[-1] != count:
                raise ValueError(
                    f"Harmonics: `{name}` has shape {value.shape}; its last axis must"
                    f" be that of the {count} orders."
                )
            finite(self, name)

    @classmethod
    def spectrum(
        cls, low: int, high: int, amplitude: Any, slope: Any, phase: Any
    ) -> "Harmonics":
        """Waves of every order from `low` to `high`, smaller the shorter they are.

        Args:
            low, high: First and last order.
            amplitude: Amplitude of order `low` [m].
            slope: Exponent p of a_k = amplitude (low/k)^p [1].
            phase: Phase of each order (high - low + 1,) [rad].
        """
        order = range(low, high + 1)
        share = (low / np.arange(low, high + 1)) ** slope
        return cls(tuple(order), amplitude * share, phase)

    @classmethod
    def from_heights(cls, points: Any, highest: int | None = None) -> "Harmonics":
        """Waves of heights that were measured around a part.

        Args:
            points: Heights at n evenly spaced angles from the part's mark (n,) [m].
                Their mean counts as size, not as form, and is taken off.
            highest: Last order kept; default: all below n/2, whose sum runs through
                the points.

        Raises:
            TypeError: For values that are not numbers.
            ValueError: For fewer than 4 points, or an order that they do not show.
        """
        must_be("Harmonics", "points", points, is_real(points), "numbers", TypeError)
        points = as_real(points)
        n = points.size
        right = points.ndim == 1 and n >= 4
        check("Harmonics", "points", right, "at least 4 heights (n,)", points, "m")
        most = (n - 1) // 2
        last = most if highest is None else highest
        allowed = f"from 1 to {most}, which {n} points show"
        check("Harmonics", "highest", 1 <= last <= most, allowed, last, "")
        order = np.arange(1, last + 1)
        turns = 2.0 * np.pi / n * (np.outer(order, np.arange(n)) % n)
        cosine = jnp.asarray(np.cos(turns)) @ points * (2.0 / n)
        sine = jnp.asarray(np.sin(turns)) @ points * (2.0 / n)
        square = cosine**2 + sine**2
        none = square == 0.0
        size = jnp.where(none, 0.0, jnp.sqrt(jnp.where(none, 1.0, square)))
        return cls(order, size, jnp.arctan2(-sine, jnp.where(none, 1.0, cosine)))

    def height(self, angle: Reals, surface: Surface) -> Any:
        # Orders last, as far as the angles have axes.
        shape = (1,) * angle.ndim + (-1,)
        order = jnp.asarray(self.order, angle.dtype)
        left, order = surface.bridged_share(order).reshape(shape), order.reshape(shape)
        amplitude, phase = self.amplitude.reshape(shape), self.phase.reshape(shape)
        waves = left * amplitude * jnp.cos(order * angle[..., None] + phase)
        return jnp.sum(waves, axis=-1)


class Spall(AbstractShape):
    """A pit across the raceway, over whose edges the rolling element rolls.

    The element, rigid, falls no deeper than rolling around the edges lets it: x inside
    the nearer edge by x²/(2ρ), ρ being the radius of relative curvature, nor deeper
    than the floor.

    Attributes:
        angle: Angle of its middle [rad].
        length: Along the rolling direction [m].
        depth: Depth of its floor [m].

    Traced: all fields.
    """

    angle: Real = eqx.field(**real("rad", "angle of its middle"))
    length: Real = eqx.field(**real("m", "length along the rolling direction"))
    depth: Real = eqx.field(**real("m", "depth of its floor"))

    def __check_init__(self):
        for name in ("length", "depth"):
            value = getattr(self, name)
            if not is_traced(value):
                right = np.all(np.isfinite(value)) and np.all(np.asarray(value) >= 0)
                check(self, name, right, "at least 0")

    def height(self, angle: Reals, surface: Surface) -> Any:
        off = jnp.mod(angle - self.angle + jnp.pi, 2.0 * jnp.pi) - jnp.pi
        inside = 0.5 * self.length - surface.radius * jnp.abs(off)
        inside = jnp.maximum(inside, 0.0)
        return -jnp.minimum(self.depth, 0.5 * inside**2 / surface.relative)


class Table(AbstractShape):
    """Heights and slopes at evenly spaced angles, for errors evaluated very often.

    Between the points a cubic; for waves of order k it errs by (2πk/n)⁴/384 of their
    amplitude. Spalls, which may be shorter than the distance of two points, are kept
    as they are.

    Attributes:
        rows: For every interval: height at its start and its rise [m], slopes there and
            at its end [m per interval], its number [1] (n, 5). The number is included
            because a compiler may compute the place of an angle twice, and round it
            to two neighbouring intervals: place and heights then belong to one.
    """

    rows: Float[Array, "n 5"]

    @classmethod
    def from_shapes(
        cls, shapes: tuple[AbstractShape, ...], surface: Surface, points: int
    ) -> tuple[AbstractShape, ...]:
        """Replace all shapes except spalls by one table of their sum, if there are any.

        Args:
            shapes: Shapes to be summed.
            surface: Contact around the part.
            points: Number of angles. Static.
        """
        spalls = tuple(shape for shape in shapes if isinstance(shape, Spall))
        shapes = tuple(shape for shape in shapes if not isinstance(shape, Spall))
        if not shapes:
            return spalls
        angle = 2.0 * jnp.pi / points * jnp.arange(points, dtype=surface.radius.dtype)

        def sum_shapes(angle):
            return total(shapes, angle, surface)

        of_each = jax.value_and_grad(sum_shapes)
        height, slope = jax.lax.map(of_each, angle, batch_size=min(points, 512))
        slope = 2.0 * jnp.pi / points * slope
        rise, end = jnp.roll(height, -1) - height, jnp.roll(slope, -1)
        number = jnp.arange(points, dtype=height.dtype)
        return (cls(jnp.stack([height, rise, slope, end, number], axis=1)), *spalls)

    def height(self, angle: Reals, surface: Surface) -> Any:
        n = self.rows.shape[0]
        at = angle * (n / (2.0 * jnp.pi))
        row = self.rows[jnp.mod(jnp.floor(at), n).astype(jnp.int32)]
        height, rise, slope, end, number = jnp.moveaxis(row, -1, 0)
        # Whole turns off, whichever interval was found at their end.
        t = at - number
        t = t - n * jnp.round((t - 0.5) / n)
        bend = 3.0 * rise - 2.0 * slope - end
        return height + t * (slope + t * (bend + t * (slope + end - 2.0 * rise)))


def total(shapes: tuple[AbstractShape, ...], angle: Reals, surface: Surface) -> Reals:
    """Sum of the heights of several shapes [m]; arguments as in `height`."""
    height = jnp.zeros_like(angle)
    for shape in shapes:
        height = height + shape.height(angle, surface)
    return height


def _shapes(given: Any) -> tuple:
    """A tuple of shapes, of a single one too."""
    return (given,) if isinstance(given, AbstractShape) else tuple(given)


class RacewayErrors(eqx.Module):
    """Errors of one raceway.

    Attributes:
        axial: Axial displacement of the raceway.
        outwards: Outward radial displacement: waviness as measured radially.
        raised: Height of its surface towards the rolling elements, along the
            contact normal: faults, ripples common to a groove's section.
    """

    axial: tuple[AbstractShape, ...] = eqx.field(converter=_shapes, default=())
    outwards: tuple[AbstractShape, ...] = eqx.field(converter=_shapes, default=())
    raised: tuple[AbstractShape, ...] = eqx.field(converter=_shapes, default=())

    def __check_init__(self):
        for name in ("axial", "outwards", "raised"):
            shapes = getattr(self, name)
            all_of_class(self, name, shapes, AbstractShape, "Harmonics or Spall")

    @property
    def shapes(self) -> tuple[AbstractShape, ...]:
        """All shapes."""
        return (*self.axial, *self.outwards, *self.raised)

    def evaluate(self, angle: Reals, surface: Surface) -> Float[Array, "... 3"]:
        """Axial, outwards and raised at angles around the ring (..., 3) [m]."""
        all_three = self.axial, self.outwards, self.raised
        return jnp.stack([total(s, angle, surface) for s in all_three], axis=-1)

    def as_tables(self, surface: Surface, points: int) -> "RacewayErrors":
        """Return the errors as tables; arguments as in `Table.from_shapes`."""
        all_three = self.axial, self.outwards, self.raised
        return RacewayErrors(
            *(Table.from_shapes(s, surface, points) for s in all_three)
        )


class FormErrors(eqx.Module):
    """Form errors of a row: of both raceways, and of every rolling element.

    Differences of diameter and spacing are fields of the bearing itself
    (`ball_deviation`, `roller_deviation`, `azimuth_deviation`).

    Attributes:
        outer: Errors of the outer raceway.
        inner: Errors of the inner raceway.
        elements: Errors of the rolling elements around the circle on which they roll:
            arrays with a leading axis element.

    Traced: all numbers.
    """

    outer: RacewayErrors = eqx.field(default_factory=RacewayErrors)
    inner: RacewayErrors = eqx.field(default_factory=RacewayErrors)
    elements: tuple[AbstractShape, ...] = eqx.field(converter=_shapes, default=())

    def __check_init__(self):
        instance(self, "outer", RacewayErrors)
        instance(self, "inner", RacewayErrors)

    @property
    def raise_surfaces(self) -> bool:
        """Whether any surface is raised or lowered. Static."""
        return bool(self.outer.raised or self.inner.raised or self.elements)

    def check(self, bearing: Any) -> None:
        """Raise if an error is larger than the bearing allows; traced ones pass.

        Args:
            bearing: A single row.

        Raises:
            ValueError: For heights beyond `largest_deviation`, a spall longer than
                the way around its part, or another number of rolling elements.
        """
        if not (self.outer.shapes or self.inner.shapes or self.elements):
            return
        places = bearing.n_places
        allowed = f"({places}, ...), one entry for each rolling element"
        for leaf in jax.tree.leaves(self.elements):
            of_shape(self, "elements", np.shape(leaf)[:1] == (places,), allowed, leaf)
        most, surfaces = largest_deviation(bearing), Surfaces.from_bearing(bearing)
        parts = {
            "outer raceway": (self.outer.shapes, surfaces.outer),
            "inner raceway": (self.inner.shapes, surfaces.inner),
            "elements": (self.elements, surfaces.element),
        }
        for part, (shapes, surface) in parts.items():
            for shape in shapes:
                numbers = jax.tree.leaves(shape)
                if most is None or any(is_traced(n) for n in (*numbers, surface[0])):
                    continue
                if isinstance(shape, Spall):
                    around, long = 2.0 * np.pi * surface.radius, np.max(shape.length)
                    allowed = f"below {around:.4g} m, the way around the {part}"
                    check("Spall", "length", long < around, allowed, long, "m")
                elif isinstance(shape, Harmonics):
                    high = np.max(np.sum(np.abs(shape.amplitude), axis=-1))
                    allowed = f"below {most:.4g} m in size together on the {part}"
                    check("Harmonics", "amplitude", high < most, allowed, high, "m")

    def deviations(
        self,
        surfaces: "Surfaces",
        azimuth: Float[Array, " element"],
        outer: Scalar,
        inner: Scalar,
        rolled: Float[Array, " element"],
    ) -> Float[Array, "element 2 3"]:
        """Deviations of both raceways at each rolling element, `Deviation.raceway` [m].

        Args:
            surfaces: Contact tracks.
            azimuth: Azimuth of each element [rad].
            outer: Turn of the outer ring [rad].
            inner: Turn of the inner ring [rad].
            rolled: Turn of each element about its own axis against the line from the
                bearing's axis to it [rad].
        """
        found = jnp.stack(
            [
                self.outer.evaluate(azimuth - outer, surfaces.outer),
                self.inner.evaluate(azimuth - inner, surfaces.inner),
            ],
            axis=1,
        )
        if not self.elements:
            return found

        def element_deviation(shapes, rolled):
            # It turns against the inner ring; the raceways stand opposite.
            angles = jnp.stack([-rolled, jnp.pi - rolled])
            return total(shapes, angles, surfaces.element)

        return found.at[:, :, 2].add(jax.vmap(element_deviation)(self.elements, rolled))

    def as_tables(self, surfaces: "Surfaces", points: int = 4096) -> "FormErrors":
        """Return the errors as tables, for many evaluations.

        Args:
            surfaces: Contact tracks.
            points: Number of angles around each part, of elements an eighth. Static.
        """

        def tabulate_element(shapes):
            return Table.from_shapes(shapes, surfaces.element, points // 8)

        elements = jax.vmap(tabulate_element)(self.elements) if self.elements else ()
        outer = self.outer.as_tables(surfaces.outer, points)
        inner = self.inner.as_tables(surfaces.inner, points)
        return FormErrors(outer, inner, elements)


class Surfaces(NamedTuple):
    """Contact geometry of a row.

    Attributes:
        outer: Contact around the outer raceway.
        inner: Contact around the inner raceway.
        element: Contact around a rolling element; its `relative` is the smaller one, at
            the inner raceway.
    """

    outer: Surface
    inner: Surface
    element: Surface

    @classmethod
    def from_bearing(cls, bearing: AbstractBearing) -> "Surfaces":
        """Return the surfaces of a single row, at the free contact angle."""
        radius, cosine = 0.5 * bearing.element_diameter, bearing.free_cosine
        pitch = 0.5 * bearing.pitch_diameter
        gamma = radius * cosine / pitch
        # Along the rolling direction, 1/ρ = (1/r)/(1 ± γ).
        outer, inner = radius * (1.0 + gamma), radius * (1.0 - gamma)
        return cls(
            Surface(pitch + radius * cosine, outer),
            Surface(pitch - radius * cosine, inner),
            Surface(radius, inner),
        )

    def bridging(self, half_width: Scalar, pressure: Scalar) -> "Surfaces":
        """Return surfaces whose contacts bridge waves; arguments as in `Surface`."""
        given = {"half_width": half_width, "pressure": pressure}
        return Surfaces(*(surface._replace(**given) for surface in self))

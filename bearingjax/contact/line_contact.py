"""The energy of one roller on one raceway, as a function of two numbers.

The approach along the roller is affine in the rigid motions up to the profile,

    approach(ξ) = a + b ξ - drop(ξ),      ξ = s/(L/2) in [-1, 1],

so that a raceway contact is W(a, b) = ∫ φ(approach) ds with the energy density
φ = C/(n+1)·approach₊^(n+1), n = 10/9. Its derivatives are moments of φ' (line load)
and φ'' (line stiffness). Each order is discretised as the integral that it is, and
the derivative rule leads from one order to the next.
"""

import abc
import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Annotated, Any, ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.material import Material
from ..design.profile import AbstractProfile, between_arcs, sagitta
from ..numerics import AbstractQuadrature, ContactMapped, positive_power
from ..numerics.expansion import Expansion, expanded_all
from ..numerics.implicit import stop_gradient
from ..numerics.pieces import Pieces, of_intervals
from ..numerics.types import Reals, Scalar
from ..numerics.units import unit
from .line import LINE_EXPONENT, AbstractLineLaw, Palmgren

# φ = C/(n+1) x₊^(n+1), φ' = C x₊^n, φ'' = n C x₊^(n-1), n = 10/9: the powers differ by
# factors of x, so that one root serves all three.
# Source: Sorokin, Zhang, Ivannikov (2018), eq. (1), (2), (4).
_N, _D = LINE_EXPONENT
_FACTORS = (_D / (_N + _D), 1.0, _N / _D)

_NEAR = tuple(1.0 - 10.0**-k for k in (1, 2, 3, 4, 6, 9))
"""Positions ξ that divide a logarithmic profile combined with a measured one."""


_OF_ENERGY = 12
"""Nodes of the energy of a slice: of a power 10/9 to 1e-9."""


class Response(NamedTuple):
    """Energy of a raceway contact and its derivatives with respect to (a, b).

    Attributes:
        energy: W [J].
        load: (∂W/∂a, ∂W/∂b) (2,) [N]; the first is the contact load.
        stiffness: Second derivatives (aa, ab, bb) (3,) [N/m].
    """

    energy: Annotated[Scalar, unit("J")]
    load: Annotated[Float[Array, "2"], unit("N")]
    stiffness: Annotated[Float[Array, "3"], unit("N/m")]


class AbstractLineContact(eqx.Module):
    """One raceway contact of one roller: its energy as a function of (a, b)."""

    @property
    @abc.abstractmethod
    def protruding(self) -> bool:
        """Whether the drop may be negative somewhere. Static."""

    @abc.abstractmethod
    def drop(self, xi: Reals) -> Reals:
        """Material removed from both bodies at ξ [m]."""

    @abc.abstractmethod
    def approximate_load(self, approach: Scalar) -> Scalar:
        """Approximate load of a roller without profile at an even approach [N]."""

    @abc.abstractmethod
    def table(self, quadrature: AbstractQuadrature) -> Any:
        """Terms that depend on the profile only, computed once per design."""

    @abc.abstractmethod
    def integrals(
        self, table: Any, quadrature: AbstractQuadrature, a: Scalar, b: Scalar
    ) -> Response:
        """Energy, load and stiffness; `response` adds the derivative rule."""

    @abc.abstractmethod
    def contact_state(self, table: Any, a: Scalar, b: Scalar) -> Any:
        """Data of a solved contact that `load` takes."""

    @abc.abstractmethod
    def load(self, carried: Any, xi: Float[Array, " point"]) -> Float[Array, " point"]:
        """Load per length at ξ [N/m], from the result of `contact_state`."""

    @abc.abstractmethod
    def summits(
        self, carried: Any, scan: Float[Array, " scan"], weight: Float[Array, " scan"]
    ) -> Float[Array, " place"]:
        """Positions ξ that include that of the largest pressure, both ends first.

        Args:
            carried: Result of `contact_state`.
            scan: Ascending positions from -1 to 1, evenly spaced.
            weight: Relative radius ρ^(-9/10) there: times the approach, this is
                largest where the pressure is.
        """

    def load_along(
        self, table: Any, xi: Float[Array, " point"], a: Scalar, b: Scalar
    ) -> Float[Array, " point"]:
        """Load per length at ξ [N/m]."""
        return self.load(self.contact_state(table, a, b), xi)


class AbstractSliceLaw(AbstractLineLaw):
    """Load of a slice by any smooth law of its own approach.

    `line_load` is all that is to be written: stiffness and strain energy follow.
    """

    @abc.abstractmethod
    def line_load(
        self, approach: Reals, radius: Scalar, modulus: Scalar, length: Scalar
    ) -> Reals:
        """Load per length q [N/m] of a slice that is pressed.

        Args:
            approach: Approach of the slice, above zero [m]. q rises with it from zero.
            radius: Radius of relative curvature in the middle of the roller [m].
            modulus: Contact modulus E* [Pa].
            length: Contact length [m].
        """

    def constant(self, roller: Material, ring: Material, length: Scalar) -> Scalar:
        # Only a measure of stiffness here.
        return Palmgren().constant(roller, ring, length)

    def contact(self, line: Any, radius: Callable, modulus: Scalar) -> Any:
        one = jnp.ones_like(line.constant)
        return SliceContact(
            one,
            line.length,
            line.diameter,
            line.roller_profile,
            line.raceway_profile,
            arc_radii=line.arc_radii,
            exact=line.exact,
            law=self,
            radius=radius(jnp.zeros_like(one)),
            modulus=modulus,
        )


class LineContact(AbstractLineContact):
    """One raceway contact of one roller, in independent slices.

    Attributes:
        constant: Line constant C [N/m^(19/9)].
        length: Contact length L [m].
        diameter: Mean roller diameter, on which some profiles depend [m].
        roller_profile: Profile of the roller.
        raceway_profile: Profile of the raceway.
        arc_radii: Radii of the arcs of roller and raceway from which the profiles are
            measured, that of the raceway concave [m]; `None`: straight generators.
        exact: Whether arcs keep their shape when they move: a and b are then those of
            `_Arc`. Static.

    Traced: all fields but `exact`.
    """

    constant: Scalar
    length: Scalar
    diameter: Scalar
    roller_profile: AbstractProfile
    raceway_profile: AbstractProfile
    arc_radii: tuple[Scalar, Scalar] | None = eqx.field(default=None, kw_only=True)
    exact: bool = eqx.field(static=True, default=False, kw_only=True)

    factors: ClassVar[tuple[float, float, float]] = _FACTORS
    """Factors of φ, φ' and φ'', in addition to `constant` and `densities`."""

    def densities(self, x: Reals) -> tuple[Array, Array, Array]:
        """φ, φ' and φ'' at an approach, without `constant`, `factors`; 0 if apart."""
        root = positive_power(x, _N - _D, _D)
        return x * x * root, x * root, root

    def drop(self, xi: Reals) -> Reals:
        """Material removed from both bodies at ξ [m]."""
        s = 0.5 * self.length * xi
        roller, raceway = self.profiles(s)
        drop = roller + raceway
        if self.arc_radii is None:
            return drop
        return drop + between_arcs(s, self.arc_radii)

    def profiles(self, s: Reals) -> tuple[Array, Array]:
        """Drop of the profiles of roller and raceway at a position s [m]."""
        size = self.length, self.diameter
        return self.roller_profile.drop(s, *size), self.raceway_profile.drop(s, *size)

    def approach(self, a: Scalar, b: Scalar, xi: Reals) -> Reals:
        """Approach at ξ, negative where the bodies are apart [m]."""
        if not self.exact:
            return a + b * xi - self.drop(xi)
        arc = _Arc.from_line(self, a, b)
        beyond = arc.first + arc.end(self) * xi - _hidden_depth((self, arc.lift), xi)
        return arc.approach(beyond, _points(self, xi)[2])[0]

    def kinks(self) -> tuple[Scalar, ...]:
        """Interior positions ξ where a derivative of the drop jumps, ascending."""
        kinks = [
            2.0 * s / self.length
            for profile in (self.roller_profile, self.raceway_profile)
            for s in profile.kinks(self.length)
        ]
        if len(kinks) < 2:
            return tuple(kinks)
        ordered = jnp.sort(jnp.stack(kinks))
        return tuple(ordered[i] for i in range(len(kinks)))

    @property
    def arcs(self) -> bool:
        """Whether the drop is made of straight lines and flat arcs. Static."""
        return self.roller_profile.arcs and self.raceway_profile.arcs

    @property
    def has_table(self) -> bool:
        """Whether a profile is a table. Static."""
        profiles = self.roller_profile, self.raceway_profile
        return any(profile.knots() is not None for profile in profiles)

    @property
    def protruding(self) -> bool:
        """Whether the drop may be negative somewhere. Static."""
        return self.roller_profile.protruding or self.raceway_profile.protruding

    def line_load(self, approach: Reals) -> Reals:
        """Load per length at a given approach [N/m]."""
        return self.constant * positive_power(approach, _N, _D)

    def approximate_load(self, approach: Scalar) -> Scalar:
        return self.length * self.line_load(approach)

    def table(self, quadrature: AbstractQuadrature) -> Any:
        ends = self._intervals()
        if ends is None or not isinstance(quadrature, ContactMapped):
            kinks, dtype = self.kinks(), self.length.dtype
            return quadrature.table(self.drop, kinks, dtype, self.arcs)
        # Each interval with the part of the profiles that it sees.
        middle = 0.25 * self.length * (ends[:-1] + ends[1:])[:, None]
        local = dataclasses.replace(
            self,
            roller_profile=self.roller_profile.between_knots(middle),
            raceway_profile=self.raceway_profile.between_knots(middle),
        )
        rule = of_intervals(quadrature, ends.shape[0] - 1)
        return local, rule.table(partial(_offset, local), ends, ends.dtype), rule

    def integrals(
        self, table: Any, quadrature: AbstractQuadrature, a: Scalar, b: Scalar
    ) -> Response:
        if self.exact:
            return _exact_integrals(self, quadrature, a, b)
        line = self
        if isinstance(table[-1], Pieces):
            line, table, quadrature = table
        nodes = quadrature.nodes(_offset, line, table, a, b, self.arcs)
        return _integrals(self, nodes, quadrature)

    def _intervals(self):
        """Ends ξ of the intervals in which measured profiles are smooth, or `None`."""
        if not self.has_table:
            return None
        profiles = self.roller_profile, self.raceway_profile
        knots = [k for k in (p.knots() for p in profiles) if k is not None]
        # A logarithm bends ever faster towards the ends.
        fine = () if all(p.arcs or p.knots() is not None for p in profiles) else _NEAR
        ends = jnp.asarray([-1.0, *(-x for x in fine), *fine, 1.0], self.length.dtype)
        parts = [ends, *(2.0 * k / self.length for k in knots)]
        kinks = self.kinks()
        if kinks:
            parts.append(jnp.stack(kinks))
        return stop_gradient(jnp.sort(jnp.clip(jnp.concatenate(parts), -1.0, 1.0)))

    def contact_state(self, table: Any, a: Scalar, b: Scalar) -> Any:
        return a, b

    def load(self, carried: Any, xi: Float[Array, " point"]) -> Float[Array, " point"]:
        a, b = carried
        return self.line_load(self.approach(a, b, xi))

    def summits(
        self, carried: Any, scan: Float[Array, " scan"], weight: Float[Array, " scan"]
    ) -> Float[Array, " place"]:
        a, b = carried
        height = weight * self.approach(a, b, scan)
        near = jnp.clip(jnp.argmax(height), 1, scan.shape[0] - 2)
        step = scan[1] - scan[0]
        top = scan[near] + step * _vertex(*(height[near + k] for k in (-1, 0, 1)))
        # Once more, closer.
        slope = 0.5 * (weight[near + 1] - weight[near - 1]) / step
        step = 0.25 * step
        middle = jnp.clip(top, step - 1.0, 1.0 - step)
        around = middle + step * jnp.arange(-1.0, 2.0, dtype=step.dtype)
        height = self.approach(a, b, around)
        height = height * (weight[near] + slope * (around - scan[near]))
        best = middle + step * _vertex(height[0], height[1], height[2])
        places = jnp.stack([scan[0], scan[-1], scan[near], top, best, *self.kinks()])
        knots = self._intervals()
        if knots is None:
            return places
        # Of a measured profile the highest point, and what swings out beside it.
        highest = jnp.argmax(a + b * knots - self.drop(knots))
        last = knots.shape[0] - 1
        left = knots[jnp.maximum(highest - 1, 0)]
        right = knots[jnp.minimum(highest + 1, last)]
        around = left + (right - left) * jnp.linspace(0.0, 1.0, 17, dtype=left.dtype)
        return jnp.concatenate([places, knots[highest][None], around])


class SliceContact(LineContact):
    """A raceway contact whose slices follow an `AbstractSliceLaw`; `constant` is 1.

    Attributes:
        law: The law.
        radius: Radius of relative curvature in the middle of the roller [m].
        modulus: Contact modulus E* [Pa].
    """

    law: AbstractSliceLaw
    radius: Scalar
    modulus: Scalar

    factors: ClassVar[tuple[float, float, float]] = (1.0, 1.0, 1.0)

    def line_load(self, approach: Reals) -> Reals:
        return self.densities(approach)[1]

    def densities(self, x: Reals) -> tuple[Array, Array, Array]:
        pressed = ~(x <= 0)
        some = jnp.where(pressed, x, 1e-9)

        def load_at(x):
            return self.law.line_load(x, self.radius, self.modulus, self.length)

        load, stiffness = jax.jvp(load_at, (some,), (jnp.ones_like(some),))
        # ∫ q dx with x = some·t³: a power begins gently.
        node, weight = np.polynomial.legendre.leggauss(_OF_ENERGY)
        t = 0.5 * (node + 1.0)
        alike = (1,) * some.ndim + (_OF_ENERGY,)
        inner = load_at(some[..., None] * jnp.asarray(t**3, some.dtype).reshape(alike))
        weight = jnp.asarray(1.5 * weight * t * t, some.dtype)
        energy = jnp.where(pressed, some * (inner @ weight), 0.0)
        return energy, jnp.where(pressed, load, 0.0), jnp.where(pressed, stiffness, 0.0)


def _vertex(left, top, right):
    """Vertex of the parabola through three points, in steps from the middle."""
    bend = 2.0 * top - left - right
    curved = (bend > 0) & jnp.isfinite(bend)
    shift = 0.5 * (right - left) / jnp.where(curved, bend, 1.0)
    return jnp.where(curved, jnp.clip(shift, -1.0, 1.0), 0.0)


def _offset(line, xi):
    return line.drop(xi)


class _Arc(NamedTuple):
    """A concave raceway that keeps its shape, as the points of a roller see it.

    The point at s lies by d below the tangent to the roller in its middle, and the
    profile of the raceway by ρ beyond its arc of radius R = 1/κ. The centre of the arc
    stands from the middle by R + a, turned from the normal by τ with b = -sin τ L/2.
    With u = 1 + κ ρ the distance of the point from the centre is R sqrt(u² + 2 κ g),

        g = first + slope s - hidden,
        hidden = lift d + ρ (1 + u)/2 - κ (s² + d²)/2,

    and its approach 2 g/(u + sqrt(u² + 2 κ g)), to first order a + b ξ - d + s² κ/2 -
    ρ; without a difference of large numbers, and for κ = 0.

    Attributes:
        curvature: κ [1/m].
        grown: 1 + κ a [1].
        sine, cosine: b/(L/2) and cos τ [1].
        first: a + κ a²/2 [m].
    """

    curvature: Annotated[Scalar, unit("1/m")]
    grown: Annotated[Scalar, unit("1")]
    sine: Annotated[Scalar, unit("1")]
    cosine: Annotated[Scalar, unit("1")]
    first: Annotated[Scalar, unit("m")]

    @classmethod
    def from_line(cls, line: LineContact, a: Scalar, b: Scalar) -> "_Arc":
        assert line.arc_radii is not None
        curvature, sine = 1.0 / line.arc_radii[1], 2.0 * b / line.length
        grown, cosine = 1.0 + curvature * a, jnp.sqrt(1.0 - sine * sine)
        return cls(curvature, grown, sine, cosine, 0.5 * a * (1.0 + grown))

    @property
    def lift(self) -> Scalar:
        return self.grown * self.cosine

    def end(self, line: LineContact) -> Scalar:
        """Slope times L/2 [m]."""
        return 0.5 * line.length * self.grown * self.sine

    def approach(self, beyond: Array, raceway: Array) -> tuple[Array, Array]:
        """Approach [m] and sqrt(u² + 2 κ g) from g and ρ."""
        up = 1.0 + self.curvature * raceway
        distance = jnp.sqrt(up * up + 2.0 * self.curvature * beyond)
        return 2.0 * beyond / (up + distance), distance


def _points(line, xi):
    """s, d and ρ of `_Arc` at ξ [m]."""
    s = 0.5 * line.length * xi
    roller, raceway = line.profiles(s)
    return s, roller + sagitta(s, line.arc_radii[0]), raceway


def _hidden_depth(args, xi):
    line, lift = args
    (s, lost, raceway), curvature = _points(line, xi), 1.0 / line.arc_radii[1]
    more = raceway * (1.0 + 0.5 * curvature * raceway)
    return lift * lost + more - 0.5 * curvature * (s * s + lost * lost)


def _exact_integrals(line, quadrature, a, b) -> Response:
    """∫ φ ds and its derivatives, of an approach that is not affine in a and b."""
    arc, arcs, half_length = _Arc.from_line(line, a, b), line.arcs, 0.5 * line.length
    args = line, arc.lift
    table = quadrature.table(
        partial(_hidden_depth, args), line.kinks(), line.length.dtype, arcs
    )
    nodes = quadrature.nodes(_hidden_depth, args, table, arc.first, arc.end(line), arcs)
    tau, weight = (jnp.asarray(x, a.dtype) for x in quadrature.reference())
    xi = nodes.middle[:, None] + nodes.half[:, None] * tau[None]
    s, lost, raceway = _points(line, xi)
    x, distance = arc.approach(nodes.argument, raceway)
    scale = half_length * line.constant * nodes.half[:, None] * weight[None]
    energy, load, stiffness = (
        factor * density * scale
        for factor, density in zip(line.factors, line.densities(x), strict=True)
    )
    # Derivatives of g by a and b, and of the approach.
    k, lean = arc.curvature, arc.sine / arc.cosine
    by_a = (arc.grown + k * (arc.sine * s - arc.cosine * lost)) / distance
    by_b = arc.grown / half_length * (s + lean * lost) / distance
    load, push = load / distance, load
    stiffness = stiffness - k * load
    bent = arc.grown * (1.0 + lean**2) / (arc.cosine * half_length**2)
    return Response(
        jnp.sum(energy),
        jnp.stack([jnp.sum(push * by_a), jnp.sum(push * by_b)]),
        jnp.stack(
            [
                jnp.sum(stiffness * by_a * by_a + k * load),
                jnp.sum(stiffness * by_a * by_b + k / arc.grown * push * by_b),
                jnp.sum(stiffness * by_b * by_b + bent * lost * load),
            ]
        ),
    )


def _integrals(line, nodes, quadrature) -> Response:
    """∫ φ ds, ∫ φ' (1, ξ) ds, ∫ φ'' (1, ξ, ξ²) ds with one root per node."""
    x = nodes.argument
    basis = quadrature.basis(x.dtype)
    # Three products, not one of a stack: XLA joins arrays element by element.
    energy, load, stiffness = (values @ basis for values in line.densities(x))
    middle, half = nodes.middle, nodes.half
    scale = 0.5 * line.length * line.constant

    def zeroth(m):
        return scale * jnp.sum(half * m[:, 0])

    def first(m):
        return scale * jnp.sum(half * (middle * m[:, 0] + half * m[:, 1]))

    def second(m):
        inner = middle**2 * m[:, 0] + 2.0 * middle * half * m[:, 1] + half**2 * m[:, 2]
        return scale * jnp.sum(half * inner)

    energy_factor, load_factor, stiffness_factor = line.factors
    return Response(
        energy_factor * zeroth(energy),
        load_factor * jnp.stack([zeroth(load), first(load)]),
        stiffness_factor
        * jnp.stack([zeroth(stiffness), first(stiffness), second(stiffness)]),
    )


def response(
    line: AbstractLineContact,
    table: Any,
    quadrature: AbstractQuadrature,
    a: Scalar,
    b: Scalar,
) -> Response:
    """Energy of one raceway contact and its derivatives, from one pass of nodes.

    Each is differentiable: the derivative of the energy with respect to a and b is
    the load, that of the load the stiffness, by rule; derivatives with respect to the
    design, and all of the stiffness, are those of the quadrature with moving zone
    edges.

    Args:
        line: The contact.
        table: `line.table(quadrature)`.
        quadrature: Rule.
        a: Approach at the middle of the roller without drop [m].
        b: Additional approach at the roller's end ξ = 1 from tilt [m].

    Returns:
        Energy, load and stiffness.
    """
    found = expanded_all(expansion, jnp.stack([a, b]), (line, table, quadrature))
    aa, ab, bb = found.hessian[0, 0], found.hessian[0, 1], found.hessian[1, 1]
    return Response(found.value, found.gradient, jnp.stack([aa, ab, bb]))


def expansion(at: Float[Array, "2"], contact: Any, order: int = 2) -> Expansion:
    """One raceway contact as a function of (a, b), for `numerics.expansion`.

    Args:
        at: (a, b) (2,) [m].
        contact: The contact, its table and the rule, as in `response`.
        order: Not used: one pass gives all.
    """
    line, table, quadrature = contact
    r = line.integrals(table, quadrature, at[0], at[1])
    aa, ab, bb = (r.stiffness[k] for k in range(3))
    hessian = jnp.stack([jnp.stack([aa, ab]), jnp.stack([ab, bb])])
    return Expansion(r.energy, r.load, hessian)

"""One roller between its rings: its contacts with raceways and ribs."""

import dataclasses
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from ..contact.hertz import POINT_EXPONENT
from ..contact.line_contact import expansion
from ..numerics import AbstractQuadrature, positive_power
from ..numerics.expansion import Expansion, compose
from ..numerics.linear import norm, solve
from ..numerics.types import Number, Reals, Scalar, Vector
from .constants import ContactConstants
from .energy import roller_energy
from .frame import section_matrix
from .roller_geometry import AbstractRollerGeometry, Approaches
from .rolling_element import AbstractRollingElement, RingMotion, Unknowns
from .search_hints import SearchHints

_N, _D = POINT_EXPONENT

_TURNED = 0.5
"""Tilt of a roller against its rings beyond which it has left them [rad]."""


_TO_EVEN = 2
"""Steps of Newton's method to where a barrel lies even, to round-off at usual tilts."""


class Roller(AbstractRollingElement):
    """One roller: its contacts, its kinematics and the inertia force on it.

    Ring motions are (t, m, θ) in roller axes; x is the place of the roller from the
    mean of the rings, with the tilt times half its length.

    Attributes:
        constants: Contact constants.
        geometry: Map from motions to approaches.
        quadrature: Quadrature of the raceway contacts.
        body_force: Inertia force and moment in roller axes (3,) [N, N m], or `None`.
    """

    constants: ContactConstants
    geometry: AbstractRollerGeometry
    quadrature: AbstractQuadrature
    body_force: Float[Array, "3"] | None = None

    n_unknowns: ClassVar[int] = 3

    energy = roller_energy

    def axes(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        return self.constants.to_axes @ section_matrix(azimuth)

    def with_heights(self, heights: Float[Array, "2"]) -> "AbstractRollingElement":
        constants = self.constants
        constants = dataclasses.replace(constants, gap=constants.gap - heights)
        geometry = self.geometry.with_heights(heights)
        return dataclasses.replace(self, constants=constants, geometry=geometry)

    def coordinates(self, rings: RingMotion, x: Unknowns) -> Any:
        return self.geometry.coordinates(rings, x)

    def approaches(self, rings: RingMotion, x: Unknowns) -> Approaches:
        """Approaches of all contacts; arguments as in `coordinates`."""
        at = self.coordinates(rings, x)
        return at if self.geometry.is_linear else self.geometry.expansion(at).value

    def respond(self, coordinates: Any) -> Expansion:
        at, met = coordinates, None
        if not self.geometry.is_linear:
            met = self.geometry.expansion(coordinates)
            at = met.value
        raceway = _raceways(self.constants, self.quadrature, at.raceway)
        load = raceway.gradient[:, 0]
        rib = Expansion(None, None, None)
        if at.rib is not None:
            rib = _ribs(self.constants.ribs, at.rib)
            load = jnp.concatenate([load, rib.gradient[:, 0]])
        found = Expansion(
            value=Approaches(raceway.value, rib.value),
            gradient=Approaches(raceway.gradient, rib.gradient),
            hessian=Approaches(raceway.hessian, rib.hessian),
            aux=load,
        )
        return found if met is None else compose(found, met)

    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        return self.constants.from_axes @ self.constants.motion(rings, x)

    def inertia(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"] | None:
        if self.body_force is None:
            return None
        return self.body_force @ self.constants.to_axes

    @property
    def diameter(self) -> Scalar:
        return self.constants.diameter

    @property
    def tether(self) -> Reals:
        return self.constants.tether

    @property
    def is_convex(self) -> bool:
        return self.geometry.is_linear

    @property
    def sees_difference(self) -> bool:
        # Inertia does work on the motion of both rings.
        return self.geometry.is_linear and self.body_force is None

    @property
    def hints(self) -> SearchHints:
        return RollerSearchHints(self)


class RollerSearchHints(SearchHints):
    """Hints for the search of the equilibrium of a roller."""

    element: Roller

    @property
    def gap(self) -> Scalar:
        return jnp.max(jnp.abs(self.element.constants.gap))

    def reach(self, rings: Any) -> Scalar:
        t, m, tilt = jnp.abs(rings.difference)
        return t + m + tilt * self.element.constants.half_length

    @property
    def spread(self) -> Number:
        c = self.element.constants
        if self.element.geometry.is_linear:
            return 1.0
        # Exact motions are those of points that turn about O, or about the centre of
        # their arc.
        lever = c.pitch_radius
        if c.arc_radii is not None:
            arc = c.arc_radii[0]
            lever = lever + jnp.where(jnp.isfinite(arc), arc, 0.0)
        return 1.0 + lever / c.half_length

    def approximate_load(self, approach: Scalar) -> Scalar:
        return self.element.constants.lines[0].approximate_load(approach)

    def passed_load(self, load: Float[Array, "*element contact"]) -> Any:
        return jnp.min(load[..., :2], axis=-1)

    @property
    def may_be_ejected(self) -> bool:
        return not self.element.geometry.is_linear or super().may_be_ejected

    def is_ejected(self, rings: Any, x: Vector) -> Bool[Array, ""]:
        gone = super().is_ejected(rings, x)
        if self.element.geometry.is_linear:
            return gone
        # A roller that is turned over meets no raceway.
        return gone | (jnp.abs(x[2]) > _TURNED * self.element.constants.half_length)

    def inertia_scale(self) -> Scalar | None:
        return None if self.element.body_force is None else norm(self._on_unknowns())

    def is_open(self, rings: Any) -> Bool[Array, ""] | None:
        element = self.element
        protruding = any(line.protruding for line in element.constants.lines)
        if element.body_force is not None or protruding:
            return None
        at = element.approaches(rings, self.midpoint(rings))
        # No profile stands out: nowhere along a raceway is the approach larger.
        open_ = jnp.all(at.raceway[:, 0] + jnp.abs(at.raceway[:, 1]) <= 0)
        return open_ if at.rib is None else open_ & jnp.all(at.rib <= 0)

    def start(self, rings: Any) -> Vector:
        element, midway = self.element, self._aligned_start(rings)
        if element.body_force is None:
            return midway
        # A loose roller is thrown on the outer raceway: from anywhere but flat on it,
        # or as near to that as the inner one leaves it, a slow one would creep along
        # its crown for hundreds of steps.

        there, rates = element.geometry.on_raceways(rings, midway)
        seat = jnp.concatenate(
            [
                jnp.zeros((1,), midway.dtype),
                solve(rates[0, :, 1:], -there[0], symmetric=False),
            ]
        )
        inner = element.geometry.on_raceways(rings, midway + seat)[0][1]
        places = jnp.linspace(-1.0, 1.0, 9, dtype=midway.dtype)
        drop = element.constants.lines[1].drop(places)
        before, after = (
            jnp.max(v[0] + v[1] * places - drop) for v in (there[1], inner)
        )
        # Convex between: no more than touching at this share of the way.
        closing = jnp.where(after > before, after - before, 1.0)
        share = jnp.where(after <= 0, 1.0, jnp.clip(-before / closing, 0.0, 1.0))
        # What the tether could hold carries nothing (`equilibrium.is_loose`).
        size = self.gap + self.reach(rings) + norm(seat)
        thrown = norm(self._on_unknowns()) > 10.0 * element.tether * size
        return midway + jnp.where(thrown & (before < 0), share, 0.0) * seat

    def _aligned_start(self, rings):
        """The midpoint; of a barrel where it lies even on both raceways (3,) [m].

        That is its equilibrium between equal raceways without ribs.
        """
        midway, element = self.midpoint(rings), self.element
        if element.constants.arc_radii is None or element.constants.ribs is not None:
            return midway

        def unevenness(both):
            return jnp.stack([both[0, 1], both[1, 1], both[0, 0] - both[1, 0]])

        def step(_, x):
            off, rates = map(unevenness, element.geometry.on_raceways(rings, x))
            # Least squares: straight raceways say nothing of a shift along them.
            normal = rates.T @ rates + 1e-12 * jnp.eye(3, dtype=x.dtype)
            return x - solve(normal, rates.T @ off, symmetric=True)

        if element.geometry.is_linear:
            return step(0, midway)
        return lax.fori_loop(0, _TO_EVEN, step, midway)

    def _on_unknowns(self):
        """Generalised force on x: the tilt unknown is θ·L/2."""
        force = self.element.body_force
        assert force is not None
        one = jnp.ones_like(self.element.constants.half_length)
        return force * jnp.stack([one, one, 1.0 / self.element.constants.half_length])


def _raceways(constants: ContactConstants, quadrature, at) -> Expansion:
    """Both raceway contacts: in one batch if their profiles are of one structure."""

    def expand(line, table, ab) -> Expansion:
        return expansion(ab, (line, table, quadrature))

    pairs = list(zip(constants.lines, constants.tables, strict=True))
    leaves = [jax.tree.leaves(pair) for pair in pairs]
    same = jax.tree.structure(pairs[0]) == jax.tree.structure(pairs[1]) and all(
        a.shape == b.shape for a, b in zip(*leaves, strict=True)
    )
    if same:
        stacked: Any = jax.tree.map(lambda a, b: jnp.stack([a, b]), *pairs)
        return jax.vmap(expand)(stacked[0], stacked[1], at)
    results = [expand(line, table, at[k]) for k, (line, table) in enumerate(pairs)]
    return jax.tree.map(lambda a, b: jnp.stack([a, b]), *results)


def _ribs(ribs, at) -> Expansion:
    """Rib contacts, c·2/5 approach₊^(5/2).

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (1), (5); Hertz.
    """
    c, approach = ribs.constant[:, None], at
    power = positive_power(approach, _N - _D, _D)
    load = c * power * approach
    energy = _D / (_N + _D) * (load * approach)
    return Expansion(energy[:, 0], load, (_N / _D * c * power)[..., None])

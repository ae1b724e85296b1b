"""The strain energy of one roller between its rings: the physics, written once.

U(rings, x) = Σ_raceways W(a, b) + Σ_ribs 2/5 c approach₊^(5/2) + guide/2 |x|². Force
and stiffness are its derivatives: the contacts' by their own rule
(`contact.line_contact`), the motions' by the chain rule of the kinematics. Inertia is
a constant force with the potential -F·y.
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..contact import line_contact
from ..contact.hertz import EXPONENT
from ..numerics.linear import dot, norm, solve
from ..numerics.power import positive_power
from ..numerics.quadrature import AbstractQuadrature
from .constants import ContactConstants
from .frame import from_roller_axes, section_matrix, to_roller_axes
from .kinematics import AbstractKinematics, Approaches, Linearised, roller_motion
from .model import AbstractModel, Derivatives

_N, _D = EXPONENT


class RollerModel(AbstractModel):
    """One roller: its contacts, its kinematics and the inertia force on it.

    Attributes:
        constants: Contact constants.
        prepared: What the kinematics computed once.
        kinematics: Linearised or finite.
        quadrature: Quadrature of the raceway contacts.
        body_force: Inertia force and moment in roller axes (3,) [N, N m], or `None`.
    """

    constants: ContactConstants
    prepared: Any
    kinematics: AbstractKinematics
    quadrature: AbstractQuadrature
    body_force: Float[Array, "3"] | None = None

    n_unknowns: ClassVar[int] = 3

    @property
    def guide(self):
        return self.constants.guide

    @property
    def diameter(self):
        return self.constants.diameter

    @property
    def gap(self):
        return jnp.abs(self.constants.gap)

    @property
    def is_convex(self):
        return isinstance(self.kinematics, Linearised)

    def section(self, azimuth):
        return self._axes() @ section_matrix(azimuth)

    @property
    def relative(self):
        # Inertia does work on the motion of both rings.
        return isinstance(self.kinematics, Linearised) and self.body_force is None

    def _axes(self):
        return to_roller_axes(self.constants.axis_angle, self.constants.pitch_radius)

    def reach(self, rings):
        between = rings if self.relative else rings[3:] - rings[:3]
        reach = jnp.abs(between[0]) + jnp.abs(between[1])
        return reach + jnp.abs(between[2]) * self.constants.half_length

    def is_open(self, rings):
        if self.body_force is not None or any(c.proud for c in self.constants.lines):
            return None
        midway = self.amid(rings)
        approaches = self.kinematics.approaches(self.prepared, rings, midway)
        # No profile stands out: nowhere along a raceway is the approach larger.
        raceways = approaches[:4:2] + jnp.abs(approaches[1:4:2])
        return jnp.all(jnp.concatenate([raceways, approaches[4:]]) <= 0)

    def first(self, rings):
        midway = self.amid(rings)
        if self.body_force is None:
            return midway
        # A loose roller is thrown on the outer raceway: from anywhere but flat on it,
        # or as near to that as the inner one leaves it, a slow one would creep along
        # its crown for hundreds of steps.
        there = self.kinematics.approaches(self.prepared, rings, midway)
        rates = self.kinematics.jacobian(self.prepared, rings, midway)[:2, -2:]
        seat = jnp.concatenate(
            [jnp.zeros((1,), rings.dtype), solve(rates, -there[:2], symmetric=False)]
        )
        way = midway + seat
        inner = self.kinematics.approaches(self.prepared, rings, way)
        places = jnp.linspace(-1.0, 1.0, 9, dtype=rings.dtype)
        drop = self.constants.lines[1].drop(places)
        before, after = (jnp.max(v[2] + v[3] * places - drop) for v in (there, inner))
        # Convex between: no more than touching at this share of the way.
        closing = jnp.where(after > before, after - before, 1.0)
        share = jnp.where(after <= 0, 1.0, jnp.clip(-before / closing, 0.0, 1.0))
        # What the guide could hold is loose (`equilibrium.is_loose`), and stays midway.
        size = self.gap + self.reach(rings) + norm(seat)
        thrown = norm(self._on_unknowns()) > 10.0 * self.guide * size
        return midway + jnp.where(thrown & (before < 0), share, 0.0) * seat

    def pressed(self, approach):
        return self.constants.lines[0].pressed(approach)

    def inertia_size(self):
        return None if self.body_force is None else norm(self._on_unknowns())

    def motion(self, rings, x, outer):
        c = self.constants
        if self.relative:
            first = self._axes() @ outer
            rings = jnp.concatenate([first, first + rings])
        back = from_roller_axes(c.axis_angle, c.pitch_radius)
        return back @ roller_motion(c, rings, x)

    def inertia(self, rings, x):
        return None if self.body_force is None else self.body_force @ self._axes()

    def _on_unknowns(self):
        """Generalised force on x: the tilt unknown is θ·L/2."""
        assert self.body_force is not None
        one = jnp.ones_like(self.constants.half_length)
        scale = jnp.stack([one, one, 1.0 / self.constants.half_length])
        return self.body_force * scale

    def responses(self, rings, x):
        """Energies, forces and stiffness of all contacts: raceways, then ribs."""
        c = self.constants
        approaches = self.kinematics.approaches(self.prepared, rings, x)
        raceways = _per_raceway(
            lambda line, table, ab: line_contact.response(
                line, table, self.quadrature, *ab
            ),
            c,
            approaches,
        )
        parts = [jax.tree.map(jnp.ravel, tuple(raceways))]
        if c.ribs is not None:
            parts.append(tuple(rib_density(c, approaches, order) for order in range(3)))
        return tuple(jnp.concatenate(same) for same in zip(*parts, strict=True))

    def derivatives(self, rings, x, of_own=False, responses=()):
        kinematics, prepared, c = self.kinematics, self.prepared, self.constants
        energies, forces, stiffness = responses or self.responses(rings, x)
        contact_load = jnp.concatenate([forces[:4:2], forces[4:]])
        first = rings.shape[0] if of_own else 0
        jacobian = kinematics.jacobian(prepared, rings, x)[:, first:]
        size = jacobian.shape[1]
        hessian = (stiffness @ _squares(jacobian)).reshape(size, size)
        curvature = kinematics.curvature(prepared, rings, x, forces)
        if curvature is not None:
            hessian = hessian + curvature[first:, first:]
        energy = jnp.sum(energies) + 0.5 * c.guide * dot(x, x)
        gradient = forces @ jacobian + c.guide * jnp.pad(x, (size - 3, 0))
        if self.body_force is not None:
            pull = self._on_unknowns()
            if not of_own:
                # x counts from the mean of the rings: half of the force on each.
                half = 0.5 * self.body_force
                pull = jnp.concatenate([half, half, pull])
            gradient = gradient - pull
            energy = energy - dot(self.body_force, roller_motion(c, rings, x))
        # The guide acts on x, which stands last.
        guided = np.arange(size) >= size - 3
        hessian = hessian + c.guide * jnp.asarray(np.diag(guided), x.dtype)
        return Derivatives(energy, gradient, hessian, contact_load)


def _squares(jacobian):
    """Products of rows that go with (aa, ab, bb) of both raceways, and ribs.

    Returns:
        (term, n n): the Hessian is Σ stiffness · these.
    """

    first, second = [0, 0, 1, 2, 2, 3], [0, 1, 1, 2, 3, 3]
    ribs = list(range(4, jacobian.shape[0]))
    twice = jnp.asarray(np.not_equal(first + ribs, second + ribs) + 1.0, jacobian.dtype)
    rows = [jnp.stack([jacobian[i] for i in order + ribs]) for order in (first, second)]
    outer = twice[:, None, None] * rows[0][:, :, None] * rows[1][:, None, :]
    return (0.5 * (outer + outer.transpose(0, 2, 1))).reshape(outer.shape[0], -1)


def rib_density(
    constants: ContactConstants, approaches: Approaches, order: int
) -> Float[Array, " rib"]:
    """Energy of the rib contacts (order 0), their loads (1) or stiffness (2).

    Args:
        constants: Contact constants with ribs.
        approaches: Approach coordinates of all contacts [m].
        order: 0, 1 or 2.

    Returns:
        (rib,) [J], [N] or [N/m].

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (1), (5); Hertz.
    """
    factor = (_D / (_N + _D), 1.0, _N / _D)[order]
    power = positive_power(approaches[4:], _N + (1 - order) * _D, _D)
    if constants.ribs is None:
        return power
    return factor * constants.ribs.constant * power


def _per_raceway(function, constants, approaches):
    """Apply to both raceways: in one batch if their profiles are of one structure."""
    pairs = list(zip(constants.lines, constants.tables, strict=True))
    ab = approaches[:4].reshape(2, 2)
    leaves = [jax.tree.leaves(pair) for pair in pairs]
    same = jax.tree.structure(pairs[0]) == jax.tree.structure(pairs[1]) and all(
        a.shape == b.shape for a, b in zip(*leaves, strict=True)
    )
    if same:
        stacked = jax.tree.map(lambda a, b: jnp.stack([a, b]), *pairs)
        return jax.vmap(function)(*stacked, ab)
    results = [function(*pair, ab[k]) for k, pair in enumerate(pairs)]
    return jax.tree.map(lambda a, b: jnp.stack([a, b]), *results)

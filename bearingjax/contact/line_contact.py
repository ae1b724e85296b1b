"""The energy of one roller on one raceway, as a function of two numbers.

The approach along the roller is affine in the rigid motions up to the profile,

    approach(ξ) = a + b ξ - drop(ξ),      ξ = s/(L/2) in [-1, 1],

so that a raceway contact is W(a, b) = ∫ φ(approach) ds with the energy density
φ = C/(n+1)·approach₊^(n+1), n = 10/9. Its derivatives are moments of φ' (line load)
and φ'' (line stiffness). Each order is discretised as the integral that it is, and
the derivative rule leads from one order to the next.
"""

from functools import partial
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ..design.profile import AbstractProfile
from ..numerics.power import positive_power
from ..numerics.quadrature import AbstractQuadrature
from ..numerics.types import Scalar
from .line import EXPONENT

_N, _D = EXPONENT


class LineContact(eqx.Module):
    """One raceway contact of one roller.

    Attributes:
        constant: Line constant C [N/m^(19/9)].
        length: Contact length L [m].
        diameter: Mean roller diameter, on which some profiles depend [m].
        roller_profile: Profile of the roller.
        raceway_profile: Profile of the raceway.

    Traced: all fields.
    """

    constant: Scalar
    length: Scalar
    diameter: Scalar
    roller_profile: AbstractProfile
    raceway_profile: AbstractProfile

    def drop(self, xi: Float[Array, "..."]) -> Float[Array, "..."]:
        """Material removed from both bodies at ξ [m]."""
        s = 0.5 * self.length * xi
        return self.roller_profile.drop(
            s, self.length, self.diameter
        ) + self.raceway_profile.drop(s, self.length, self.diameter)

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

    def line_load(self, approach: Float[Array, "..."]) -> Float[Array, "..."]:
        """Load per length at a given approach [N/m]."""
        return density(self.constant, approach, 1)


def density(
    constant: Scalar, approach: Float[Array, "..."], order: int
) -> Float[Array, "..."]:
    """Energy per length (order 0), or its first or second derivative.

    φ = C/(n+1) x₊^(n+1), φ' = C x₊^n, φ'' = n C x₊^(n-1), n = 10/9.

    Args:
        constant: Line constant C [N/m^(19/9)].
        approach: Approach x [m].
        order: 0, 1 or 2.

    Returns:
        [J/m], [N/m] or [N/m²].

    Source: Sorokin, Zhang, Ivannikov (2018), eq. (1), (2), (4).
    """
    factor = (_D / (_N + _D), 1.0, _N / _D)[order]
    return factor * constant * positive_power(approach, _N + (1 - order) * _D, _D)


def _offset(line, xi):
    return line.drop(xi)


def table(line: LineContact, quadrature: AbstractQuadrature) -> tuple:
    """What the quadrature needs of the profile alone, once per design."""
    kinks = line.kinks()
    return quadrature.table(line.drop, kinks, line.length.dtype)


def _moments(line, nodes, quadrature):
    """∫ φ^(k) ξ^j ds for k, j = 0..2: (3, 3)."""
    stacked = jnp.stack([density(line.constant, nodes.argument, k) for k in range(3)])
    local = stacked @ quadrature.basis(line.length.dtype)
    middle, half = nodes.middle[None, :], nodes.half[None, :]
    m0, m1, m2 = local[..., 0], local[..., 1], local[..., 2]
    moments = jnp.stack(
        [
            m0,
            middle * m0 + half * m1,
            middle**2 * m0 + 2.0 * middle * half * m1 + half**2 * m2,
        ],
        axis=-1,
    )
    return 0.5 * line.length * jnp.sum(half[..., None] * moments, axis=1)


class Response(NamedTuple):
    """Energy of a raceway contact and its derivatives with respect to (a, b).

    Attributes:
        energy: W [J].
        load: (∂W/∂a, ∂W/∂b) (2,) [N]; the first is the contact load.
        stiffness: Second derivatives (aa, ab, bb) (3,) [N/m].
    """

    energy: Scalar
    load: Float[Array, "2"]
    stiffness: Float[Array, "3"]


def response(
    line: LineContact,
    table: tuple,
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
        table: From `table`.
        quadrature: Rule.
        a: Approach at the middle of the roller without drop [m].
        b: Additional approach at the roller's end ξ = 1 from tilt [m].

    Returns:
        Energy, load and stiffness.
    """
    numbers, structure = jax.tree.flatten((line, table))
    return _response((structure, quadrature), a, b, numbers)


@partial(jax.jit, static_argnums=0)
def _plain(static, a, b, numbers) -> Response:
    structure, quadrature = static
    line, table = jax.tree.unflatten(structure, numbers)
    nodes = quadrature.nodes(_offset, line, table, a, b)
    m = _moments(line, nodes, quadrature)
    return Response(m[0, 0], m[1, :2], m[2])


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _response(static, a, b, numbers) -> Response:
    return _plain(static, a, b, numbers)


@partial(_response.defjvp, symbolic_zeros=True)
def _response_rule(static, primals, tangents):
    a, b, numbers = primals
    *dab, dnumbers = tangents
    value = _response(static, a, b, numbers)
    da, db = (jnp.zeros_like(a) if _is_zero(d) else d for d in dab)
    energy = value.load[0] * da + value.load[1] * db
    load = value.stiffness[:2] * da + value.stiffness[1:] * db
    _, stiffness = jax.jvp(
        lambda a, b: _plain(static, a, b, numbers).stiffness, (a, b), (da, db)
    )
    change = Response(energy, load, stiffness)
    if not all(_is_zero(d) for d in dnumbers):
        dnumbers = [
            jnp.zeros_like(x) if _is_zero(d) else d
            for d, x in zip(dnumbers, numbers, strict=True)
        ]
        _, design = jax.jvp(lambda n: _plain(static, a, b, n), (numbers,), (dnumbers,))
        change = jax.tree.map(jnp.add, change, design)
    return value, change


def _is_zero(x):
    return isinstance(x, SymbolicZero)

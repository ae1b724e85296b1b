"""The strain energy of one roller between its rings: the physics, written once.

U(rings, x) = Σ_raceways W(a, b) + Σ_ribs 2/5 c approach₊^(5/2) + guide/2 |x|². Force
and stiffness are its derivatives: the contacts' by their own rule
(`contact.line_contact`), the motions' by the chain rule of the kinematics.
"""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..contact import line_contact
from ..contact.hertz import EXPONENT
from ..numerics.power import positive_power
from ..numerics.quadrature import AbstractQuadrature
from ..numerics.types import Scalar
from .constants import ContactConstants
from .kinematics import AbstractKinematics, Approaches, Rings, Unknowns

_N, _D = EXPONENT


class RollerModel(eqx.Module):
    """Everything that the energy of one roller needs besides its state.

    Attributes:
        constants: Contact constants.
        prepared: What the kinematics computed once.
        kinematics: Linearised or finite.
        quadrature: Quadrature of the raceway contacts.
    """

    constants: ContactConstants
    prepared: tuple | ContactConstants
    kinematics: AbstractKinematics
    quadrature: AbstractQuadrature


class Derivatives(NamedTuple):
    """Energy of one roller and its derivatives with respect to (rings, x).

    Attributes:
        energy: U [J].
        gradient: (9,) [N, N m].
        hessian: (9, 9) [N/m, N, N m].
        raceway_load: Contact load on each raceway (2,) [N].
        rib_load: Load on each rib that exists (rib,) [N].
    """

    energy: Scalar
    gradient: Float[Array, "9"]
    hessian: Float[Array, "9 9"]
    raceway_load: Float[Array, "2"]
    rib_load: Float[Array, " rib"]


def energy(model: RollerModel, rings: Rings, x: Unknowns) -> Scalar:
    """Strain energy U of one roller [J].

    Args:
        model: The roller.
        rings: Motion of both rings in roller axes (6,) [m, rad].
        x: The roller's unknowns [m].
    """
    return derivatives(model, rings, x).energy


def derivatives(model: RollerModel, rings: Rings, x: Unknowns) -> Derivatives:
    """Energy of one roller, its gradient and Hessian, from one pass over the nodes.

    All are differentiable; what is not used of them is not computed under `jit`.

    Args:
        model: The roller.
        rings: Motion of both rings in roller axes (6,) [m, rad].
        x: The roller's unknowns [m].
    """
    kinematics, prepared, c = model.kinematics, model.prepared, model.constants
    approaches = kinematics.approaches(prepared, rings, x)
    raceways = _per_raceway(
        lambda line, table, ab: line_contact.response(
            line, table, model.quadrature, *ab
        ),
        c,
        approaches,
    )
    total, forces = jnp.sum(raceways.energy), raceways.load.reshape(-1)
    ribs = [jnp.zeros((0,), approaches.dtype)] * 3
    if c.ribs is not None:
        ribs = [rib_density(c, approaches, order) for order in range(3)]
        total, forces = total + jnp.sum(ribs[0]), jnp.concatenate([forces, ribs[1]])
    jacobian = kinematics.jacobian(prepared, rings, x)
    pull = jnp.sum(jacobian * forces[:, None], axis=0)
    curvature = kinematics.curvature(prepared, rings, x, forces)
    return Derivatives(
        energy=total + 0.5 * c.guide * jnp.sum(x * x),
        gradient=pull.at[6:].add(c.guide * x),
        hessian=_assemble(model, jacobian, raceways.stiffness, ribs[2], curvature),
        raceway_load=raceways.load[:, 0],
        rib_load=ribs[1],
    )


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
    return factor * constants.ribs.constant * power


def _assemble(model, jacobian, blocks, ribs, curvature):
    """Jᵀ K J with 2 x 2 blocks of the raceways and a diagonal of the ribs."""
    raceway = jacobian[:4].reshape(2, 2, 9)
    # Broadcast sums: for such small sizes far cheaper under vmap than batched dots.
    half = jnp.sum(blocks[:, :, :, None] * raceway[:, None, :, :], axis=2)
    total = jnp.sum(raceway[:, :, :, None] * half[:, :, None, :], axis=(0, 1))
    if ribs.shape[0]:
        rows = jacobian[4:]
        total = total + jnp.sum(
            rows[:, :, None] * (ribs[:, None] * rows)[:, None, :], axis=0
        )
    if curvature is not None:
        total = total + curvature
    index = jnp.arange(6, 9)
    return total.at[index, index].add(model.constants.guide)


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

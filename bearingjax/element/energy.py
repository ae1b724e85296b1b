"""The strain energy of one roller between its rings: the physics, written once.

U(rings, x) = Σ_raceways W(a, b) + Σ_ribs 2/5 c approach₊^(5/2) + guide/2 |x|². Force
and stiffness are its derivatives: the contacts' by their own rule
(`contact.line_contact`), the motions' by the chain rule of the kinematics.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..contact import line_contact
from ..contact.hertz import EXPONENT
from ..numerics.linear import dot
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
    prepared: Any
    kinematics: AbstractKinematics
    quadrature: AbstractQuadrature


class Derivatives(NamedTuple):
    """Energy of one roller and its derivatives with respect to (rings, x).

    Attributes:
        energy: U [J].
        gradient: (9,), or (3,) with respect to x alone [N, N m].
        hessian: (9, 9), or (3, 3) likewise [N/m, N, N m].
        raceway_load: Contact load on each raceway (2,) [N].
        rib_load: Load on each rib that exists (rib,) [N].
    """

    energy: Scalar
    gradient: Float[Array, " n"]
    hessian: Float[Array, "n n"]
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


def derivatives(
    model: RollerModel, rings: Rings, x: Unknowns, of_roller: bool = False
) -> Derivatives:
    """Energy of one roller, its gradient and Hessian, from one pass over the nodes.

    All are differentiable; what is not used of them is not computed under `jit`.

    Args:
        model: The roller.
        rings: Motion of both rings in roller axes (6,) [m, rad].
        x: The roller's unknowns [m].
        of_roller: Derivatives with respect to x alone, (3,) and (3, 3).
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
    energies, forces = raceways.energy, raceways.load.reshape(-1)
    stiffness = raceways.stiffness.reshape(-1)
    rib_load = jnp.zeros((0,), approaches.dtype)
    if c.ribs is not None:
        ribs = [rib_density(c, approaches, order) for order in range(3)]
        rib_load = ribs[1]
        energies = jnp.concatenate([energies, ribs[0]])
        forces = jnp.concatenate([forces, rib_load])
        stiffness = jnp.concatenate([stiffness, ribs[2]])
    first = 6 if of_roller else 0
    jacobian = kinematics.jacobian(prepared, rings, x)[:, first:]
    size = 9 - first
    hessian = (stiffness @ _squares(jacobian)).reshape(size, size)
    curvature = kinematics.curvature(prepared, rings, x, forces)
    if curvature is not None:
        hessian = hessian + curvature[first:, first:]
    # The guide acts on x, which stands last.
    guided = np.arange(size) >= size - 3
    return Derivatives(
        energy=jnp.sum(energies) + 0.5 * c.guide * dot(x, x),
        gradient=forces @ jacobian + c.guide * jnp.pad(x, (size - 3, 0)),
        hessian=hessian + c.guide * jnp.asarray(np.diag(guided), x.dtype),
        raceway_load=raceways.load[:, 0],
        rib_load=rib_load,
    )


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

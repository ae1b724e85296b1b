"""Equilibrium of one roller between given rings, and its condensation.

The roller's three freedoms are those that minimise U(rings, x) - F·y, a convex problem
with linearised kinematics; F is the constant inertia force and y the roller's motion.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..numerics.implicit import attach, stop
from ..numerics.linear import dot, norm, smallest_pivot, solve_symmetric, trace
from ..numerics.minimise import AbstractMinimiser, Evaluation
from ..numerics.result import Result
from ..numerics.types import Scalar
from .energy import Derivatives, RollerModel, derivatives
from .kinematics import Linearised, Rings, Unknowns, roller_motion


class RollerState(NamedTuple):
    """Solved state of one roller.

    Attributes:
        x: The roller's unknowns (3,) [m].
        residual: Force that is out of balance, relative to the contact loads [1].
        steps: Evaluations that the solve took.
        result: `Result` code.
    """

    x: Unknowns
    residual: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]


def _inertia_on_unknowns(model, inertia):
    """Generalised force on x: the tilt unknown is θ·L/2."""
    one = jnp.ones_like(model.constants.half_length)
    return inertia * jnp.stack([one, one, 1.0 / model.constants.half_length])


def solve_roller(
    model: RollerModel,
    rings: Rings,
    inertia: Float[Array, "3"] | None,
    magnitude: Scalar,
    minimiser: AbstractMinimiser,
) -> RollerState:
    """Minimise the energy of one roller over its own freedoms.

    Args:
        model: The roller.
        rings: Motion of both rings in roller axes (6,) [m, rad].
        inertia: Inertia force in roller axes (3,) [N, N, N m], or `None`.
        magnitude: Size of the displacements from which `rings` was computed, for
            the round-off floor of the residual [m].
        minimiser: Local solver.

    Returns:
        State whose `x` is differentiable, to every order, with respect to the
        design, the ring motion and the inertia force.

    Fails: `STEP_LIMIT`, `NON_FINITE`; `NO_LOAD_PATH` if inertia throws the roller off,
        because no contact holds it; `SADDLE` with finite kinematics.
    """
    state = _solve(stop(model), stop(rings), stop(inertia), stop(magnitude), minimiser)

    def residual(x, args):
        model, rings, inertia = args
        g = derivatives(model, rings, x, of_roller=True).gradient
        return g if inertia is None else g - _inertia_on_unknowns(model, inertia)

    x = attach(residual, state.x, (model, rings, inertia))
    return state._replace(x=x)


def is_loose(
    model: RollerModel, x: Unknowns, magnitude: Scalar, load: Scalar, pull: Unknowns
) -> Bool[Array, ""]:
    """Whether a roller is held by no more than the guide spring.

    Its contacts then carry next to nothing, and what they carry does not balance on
    the roller, as a real squeeze between the rings does. The energy being convex, the
    load left out is bounded by the small one found here.

    Args:
        model: The roller.
        x: The roller's unknowns [m].
        magnitude: Size of the displacements of the rings [m].
        load: Sum of the sizes of contact loads and inertia force [N].
        pull: Derivative of the energy with respect to x, less inertia [N].

    Returns:
        False for NaN, which must not pass for an open contact.
    """
    guide = model.constants.guide
    contacts = pull - guide * x
    unbalanced = dot(contacts, contacts) >= (0.03 * load) ** 2
    # About 1e-8 N. With ten times this, rollers jump that matter to loads of 1e-3 N;
    # with a tenth, some loose rollers do not come to rest (benchmarks/robust_*.py).
    return unbalanced & (load <= 100.0 * guide * _size(model, x, magnitude))


def _size(model, x, magnitude):
    return magnitude + jnp.abs(model.constants.gap) + norm(x)


def solved_derivatives(
    model: RollerModel,
    rings: Rings,
    inertia: Float[Array, "3"] | None,
    magnitude: Scalar,
    x: Unknowns,
) -> Derivatives:
    """Energy and derivatives of a solved roller; all zero if it is loose.

    Without this a roller that the guide spring leans on two rings would pass the
    stiffness of that contact, which falls only with the tenth root of its load.

    Args:
        model, rings, inertia, magnitude: As in `solve_roller`.
        x: The solved unknowns [m].
    """
    d = derivatives(model, rings, x)
    load = jnp.sum(d.raceway_load) + jnp.sum(d.rib_load)
    if inertia is not None:
        load = load + jnp.sum(jnp.abs(_inertia_on_unknowns(model, inertia)))
    loose = is_loose(*stop((model, x, magnitude, load, d.gradient[6:])))
    return jax.tree.map(lambda v: jnp.where(loose, 0.0, v), d)


def _solve(model, rings, inertia, magnitude, minimiser):
    c = model.constants
    f = None if inertia is None else _inertia_on_unknowns(model, inertia)
    eps = jnp.finfo(rings.dtype).eps

    def function(x, with_hessian):
        d = derivatives(model, rings, x, of_roller=True)
        value, g, h = d.energy, d.gradient, d.hessian
        scale = jnp.sum(d.raceway_load) + jnp.sum(d.rib_load)
        if f is not None:
            value, g = value - dot(f, x), g - f
            scale = scale + norm(f)
        # Round-off of positions, and what is small against the guide's own force.
        noise = _size(model, x, magnitude) * (eps * trace(h) + 1e-6 * c.guide)
        # A loose roller need not be placed: its solve is over.
        loose = is_loose(model, x, magnitude, scale, g)
        noise = jnp.where(loose, norm(g), noise)
        scale = jnp.where(loose, jnp.inf, scale)
        return Evaluation(value, g, h if with_hessian else h[:0], scale, noise)

    between = rings[:3] - rings[3:]
    reach = jnp.abs(between[0]) + jnp.abs(between[1])
    reach = reach + jnp.abs(between[2]) * c.half_length
    radius = reach + jnp.abs(c.gap) + 1e-6 * c.diameter
    start = jnp.zeros((3,), rings.dtype)
    minimum = minimiser.minimise(function, start, radius)
    result = minimum.result
    if not isinstance(model.kinematics, Linearised):
        h = derivatives(model, rings, minimum.x, of_roller=True).hessian
        saddle = (smallest_pivot(h) < -1e-9) & (result == Result.CONVERGED)
        result = jnp.where(saddle, int(Result.SADDLE), result)
    if f is not None:
        # Thrown off: inertia along a direction that only the guide holds.
        away = norm(minimum.x) > 10.0 * c.diameter
        lost = away & (result != int(Result.NON_FINITE))
        result = jnp.where(lost, int(Result.NO_LOAD_PATH), result)
    return RollerState(
        minimum.x, minimum.residual, minimum.steps, result.astype(jnp.int32)
    )


def condensed_energy(
    model: RollerModel,
    rings: Rings,
    inertia: Float[Array, "3"] | None,
    x: Unknowns,
    solved: Derivatives,
) -> Scalar:
    """V = U - F·y at the solved state [J].

    Args:
        model: The roller.
        rings: Motion of both rings in roller axes (6,) [m, rad].
        inertia: Inertia force in roller axes [N, N, N m], or `None`.
        x: The solved unknowns [m].
        solved: Derivatives of the energy there.
    """
    if inertia is None:
        return solved.energy
    return solved.energy - inertia @ roller_motion(model.constants, rings, x)


def condensed_force(
    inertia: Float[Array, "3"] | None, solved: Derivatives
) -> Float[Array, "6"]:
    """dV/d(rings) at the solved state, in roller axes [N, N m].

    x counts from the mean of the rings, so half of the inertia force acts on each
    in these coordinates.
    """
    force = solved.gradient[:6]
    if inertia is None:
        return force
    return force - 0.5 * jnp.concatenate([inertia, inertia])


def condensed_stiffness(hessian: Float[Array, "9 9"]) -> Float[Array, "6 6"]:
    """K_rr - K_rx K_xx⁻¹ K_xr, symmetric to round-off.

    Args:
        hessian: Of the energy with respect to (rings, x).

    Source: static condensation 9 to 6, Sorokin, Zhang, Ivannikov (2018).
    """
    coupling = hessian[6:, :6]
    moved = solve_symmetric(hessian[6:, 6:], coupling)
    k = hessian[:6, :6] - jnp.sum(coupling[:, :, None] * moved[:, None, :], axis=0)
    return 0.5 * (k + k.T)

"""A cylindrical roller bearing as others would solve it: what ours is timed beside.

Written from the formulas alone: no ribs, linearised kinematics, equal slices. A roller
has two unknowns that matter, radial shift and tilt times half the length, counted from
the mean of the rings; so has the difference of the rings, outer less inner. SI units.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import jax.scipy.optimize
import numpy as np
import scipy.optimize

LINE = 10 / 9
UNIT = 1e-6  # m, of the unknowns of general minimisers
SIZE = 1e3  # N, of the forces that they see
GOAL = 1e-8  # of the gradient, in SIZE
STEPS = 200

Pair = tuple[Any, Any]
Evaluate = Callable[[Any], Pair]


class Plain(NamedTuple):
    """The bearing in numbers.

    Attributes:
        azimuth: Of every roller (roller,) [rad].
        half: Half of the roller length [m].
        gap: Of one raceway, rings concentric [m].
        guide: Spring that holds an open roller between the rings [N/m].
        xi: Middles of the slices, from -1 to 1 (slice,).
        weight: Line constant times width of a slice (slice,) [N/m^(10/9)].
        drop: Of roller and raceway (raceway, slice) [m].
    """

    azimuth: np.ndarray
    half: float
    gap: float
    guide: float
    xi: np.ndarray
    weight: np.ndarray
    drop: np.ndarray

    @property
    def rows(self):
        """(v, tilt half) of the difference of the rings from its six freedoms."""
        cos, sin, zero = np.cos(self.azimuth), np.sin(self.azimuth), 0 * self.azimuth
        radial = [cos, sin, zero, zero, zero, zero]
        tilt = [zero, zero, zero, -self.half * sin, self.half * cos, zero]
        return np.stack([np.stack(radial, -1), np.stack(tilt, -1)], axis=1)


def plain(element, slices):
    """The numbers of a `BearingElement` of cylindrical rollers without ribs."""
    constants, bearing = element.model().rows[0].element.constants, element.bearing
    xi = (2 * np.arange(slices) + 1) / slices - 1
    half = float(constants.half_length)
    turns = np.arange(bearing.n_rollers) / bearing.n_rollers
    return Plain(
        azimuth=float(bearing.first_azimuth) + 2 * np.pi * turns,
        half=half,
        gap=float(constants.gap[0]),
        guide=float(constants.tether),
        xi=xi,
        weight=np.full(slices, float(constants.lines[0].constant) * 2 * half / slices),
        drop=np.stack(
            [np.asarray(line.drop(jnp.asarray(xi))) for line in constants.lines]
        ),
    )


def assemble(bearing, shares, blocks, xp=np):
    """Force (case, 12) and stiffness (case, 12, 12) from those of the rollers."""
    rows = bearing.rows
    force = xp.einsum("clk,lki->ci", shares, rows)
    block = xp.einsum("lki,clkm,lmj->cij", rows, blocks, rows)
    both = xp.concatenate([block, -block], axis=2)
    return (
        xp.concatenate([force, -force], axis=1),
        xp.concatenate([both, -both], axis=1),
    )


def between(bearing, q, xp=np):
    """Difference of the rings at every roller (case, roller, 2) [m]."""
    return xp.einsum("lki,ci->clk", bearing.rows, q[:, :6] - q[:, 6:])


# NumPy, vectorised over all rollers of all cases.


def contacts(bearing, d, x):
    """Energy [J], loads (n, 2, 2) [N] and stiffness (n, 2, 2, 2) [N/m] of n rollers.

    The second axis is the raceway; the others belong to (shift, tilt half).
    """
    moved = np.stack([x - 0.5 * d, -x - 0.5 * d], axis=1)
    approach = moved[..., :1] + moved[..., 1:] * bearing.xi - bearing.gap - bearing.drop
    m = np.maximum(approach, 0.0)
    root = bearing.weight * m ** (LINE - 1.0)
    load, powers = root * m, bearing.xi ** np.arange(3)[:, None]
    energy = np.sum(load * m, axis=(1, 2)) / (LINE + 1.0)
    s = LINE * root @ powers.T
    stiffness = np.stack([s[..., :2], s[..., 1:]], axis=-2)
    return energy, load @ powers[:2].T, stiffness


def of_roller(bearing, loads, stiffness, x):
    """Gradient (n, 2) and Hessian (n, 2, 2) by the roller's unknowns."""
    gradient = loads[:, 0] - loads[:, 1] + bearing.guide * x
    return gradient, stiffness.sum(axis=1) + bearing.guide * np.eye(2)


def settle(bearing, d):
    """Where n rollers rest (n, 2) [m]: damped Newton steps, those unsettled only."""
    x = np.zeros_like(d)
    damping = np.full(len(d), 1e-3)
    todo = np.arange(len(d))
    for _ in range(STEPS):
        mine, y = d[todo], x[todo]
        energy, loads, stiffness = contacts(bearing, mine, y)
        value = energy + 0.5 * bearing.guide * np.sum(y * y, axis=1)
        gradient, hessian = of_roller(bearing, loads, stiffness, y)
        size = np.linalg.norm(gradient, axis=1)
        going = size > 1e-13 * loads[:, :, 0].sum(axis=1) + 2e-6 * bearing.guide
        if not going.any():
            break
        todo, mine, y = todo[going], mine[going], y[going]
        gradient, hessian = gradient[going], hessian[going]
        trace = np.trace(hessian, axis1=1, axis2=2)
        lifted = hessian + (damping[todo] * trace)[:, None, None] * np.eye(2)
        step = -np.linalg.solve(lifted, gradient[..., None])[..., 0]
        new, new_loads, new_stiffness = contacts(bearing, mine, y + step)
        new = new + 0.5 * bearing.guide * np.sum((y + step) ** 2, axis=1)
        after, _ = of_roller(bearing, new_loads, new_stiffness, y + step)
        better = new < value[going]
        better |= np.linalg.norm(after, axis=1) < 0.5 * size[going]
        x[todo[better]] += step[better]
        damping[todo] *= np.where(better, 0.01, 10.0)
    return x


def with_numpy(bearing: Plain) -> Evaluate:
    """q (case, 12) -> force and stiffness."""

    def evaluate(q):
        d = between(bearing, np.asarray(q))
        flat = d.reshape(-1, 2)
        return _condensed(bearing, d.shape, flat, settle(bearing, flat))

    return evaluate


def with_scipy(bearing: Plain) -> Evaluate:
    """q (case, 12) -> force and stiffness; one `scipy.optimize.root` a roller."""

    def balance(z, d):
        x = UNIT * z[None]
        _, loads, stiffness = contacts(bearing, d[None], x)
        gradient, hessian = of_roller(bearing, loads, stiffness, x)
        return gradient[0] / SIZE, hessian[0] * UNIT / SIZE

    def evaluate(q):
        d = between(bearing, np.asarray(q))
        flat = d.reshape(-1, 2)
        found = [
            scipy.optimize.root(balance, np.zeros(2), (one,), jac=True, tol=1e-12).x
            for one in flat
        ]
        return _condensed(bearing, d.shape, flat, UNIT * np.array(found))

    return evaluate


def _condensed(bearing, shape, d, x):
    _, loads, stiffness = contacts(bearing, d, x)
    _, hessian = of_roller(bearing, loads, stiffness, x)
    # By the rings each approach changes by -1/2, by the roller by +1 and -1.
    coupling = -0.5 * (stiffness[:, 0] - stiffness[:, 1])
    block = 0.25 * stiffness.sum(axis=1) - coupling @ np.linalg.solve(hessian, coupling)
    shares = -0.5 * loads.sum(axis=1)
    return assemble(bearing, shares.reshape(shape), block.reshape(*shape, 2))


# General minimisers in JAX: one energy, vmapped over the rollers.


def energy(bearing, d, x):
    """Of one roller [J]."""
    moved = jnp.stack([x - 0.5 * d, -x - 0.5 * d])
    approach = moved[:, :1] + moved[:, 1:] * bearing.xi - bearing.gap - bearing.drop
    positive = approach > 0
    m = jnp.where(positive, approach, 1.0)
    power = jnp.where(positive, m ** (LINE + 1.0), 0.0)
    own = 0.5 * bearing.guide * (x @ x)
    return jnp.sum(bearing.weight * power) / (LINE + 1.0) + own


def _bfgs(function):
    found = jax.scipy.optimize.minimize(
        function, jnp.zeros(2), method="BFGS", tol=GOAL, options={"maxiter": STEPS}
    )
    return found.x


def _optimistix(function):
    import optimistix

    solver = optimistix.BFGS(rtol=GOAL, atol=GOAL)
    found = optimistix.minimise(
        lambda z, _: function(z), solver, jnp.zeros(2), max_steps=STEPS, throw=False
    )
    return found.value


def with_minimiser(bearing: Plain, minimise: Callable) -> Evaluate:
    """q (case, 12) -> force and stiffness, jitted.

    Args:
        bearing: The bearing.
        minimise: Function of two scaled unknowns -> its minimiser.
    """

    def roller(d):
        z = minimise(lambda z: energy(bearing, d, UNIT * z) / (UNIT * SIZE))
        both = jnp.concatenate([d, UNIT * jax.lax.stop_gradient(z)])

        def whole(both):
            return energy(bearing, both[:2], both[2:])

        force, h = jax.grad(whole)(both)[:2], jax.hessian(whole)(both)
        return force, h[:2, :2] - h[:2, 2:] @ jnp.linalg.solve(h[2:, 2:], h[2:, :2])

    def evaluate(q):
        shares, blocks = jax.vmap(jax.vmap(roller))(between(bearing, q, jnp))
        return assemble(bearing, shares, blocks, jnp)

    return jax.jit(evaluate)


def with_jax_bfgs(bearing: Plain) -> Evaluate:
    """`jax.scipy.optimize.minimize(method="BFGS")` for every roller."""
    return with_minimiser(bearing, _bfgs)


def with_optimistix(bearing: Plain) -> Evaluate | None:
    """`optimistix.BFGS` for every roller; `None` where it is not installed."""
    try:
        import optimistix  # noqa: F401
    except ImportError:
        return None
    return with_minimiser(bearing, _optimistix)

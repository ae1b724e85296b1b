"""Whirl modes of a rotor at a speed, and over speeds (Campbell diagram).

Eigenvalues λ of λ² M + λ (C + Ω G) + K come from LAPACK's eigenvalues of the state
matrix, which JAX has on the CPU only. One Newton step with left and right eigenvectors
that count as fixed, λ - wᵀP(λ)v / wᵀP'(λ)v, then takes away their round-off; its
derivative is that of the eigenvalue, -wᵀ dP v / wᵀP'v. First derivatives are exact,
second ones are not; those of mode shapes are not there.

Source: Lancaster, On eigenvalues of matrices dependent on a parameter, Numer. Math. 6
    (1964) 377-387.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Complex, Float, Int

from ..design.checks import check, is_traced, number, real_numbers
from ..design.checks import count as whole
from ..numerics.implicit import stop
from ..numerics.types import as_count, as_real
from .damping import mass_normal
from .rotor import Rotor, RotorMatrices

_COINCIDENT = 1e-7
"""Relative distance below which two eigenvalues are one, of several modes [1]."""
_PLANAR = 1e-6
"""Share of whirl below which a mode has no direction [1]."""
_STILL = 7.0
"""In roots of the round-off: the share of the largest frequency of the model below
which a mode counts as still, since round-off hides whether it oscillates [1]."""
_SPARE = 8
"""Modes above those asked for that a Campbell diagram follows as well."""


class Modes(eqx.Module):
    """Modes of a rotor, those that oscillate first, with rising frequency.

    Behind them follow those that do not: rigid-body motions, and motions damped so
    much that they creep. Over speeds every field has `speed` as first axis.

    Attributes:
        eigenvalue: λ; the motion goes as exp(λ t) (mode,) [rad/s].
        whirl: +1 forward (with the speed; at rest from x towards y), -1 backward, 0 in
            a plane or axial; 0 too where modes coincide, since any mixture of them is
            a mode (mode,).
        shape: (ux uy uz gx gy) of every node (mode, node, 5) [m, rad]; the largest
            motion is real and 1 m, tilts counted as those of the shaft's length.
        housing: (ux uy uz) of every housing (mode, housing, 3) [m].
    """

    eigenvalue: Complex[Array, "*speed mode"]
    whirl: Int[Array, "*speed mode"]
    shape: Complex[Array, "*speed mode node 5"]
    housing: Complex[Array, "*speed mode housing 3"]

    @property
    def oscillates(self) -> Any:
        """Whether a mode oscillates (mode,)."""
        return jnp.imag(self.eigenvalue) > 0

    @property
    def frequency(self) -> Float[Array, "*speed mode"]:
        """Damped natural frequency Im λ/2π (mode,) [Hz]."""
        return jnp.imag(self.eigenvalue) / (2.0 * jnp.pi)

    @property
    def damping_ratio(self) -> Float[Array, "*speed mode"]:
        """-Re λ/|λ| (mode,) [1]; negative: unstable. 0 for a rigid-body motion."""
        size = jnp.abs(self.eigenvalue)
        none = size == 0
        return jnp.where(
            none, 0.0, -jnp.real(self.eigenvalue) / jnp.where(none, 1.0, size)
        )

    @property
    def log_decrement(self) -> Float[Array, "*speed mode"]:
        """-2π Re λ/Im λ (mode,) [1], infinite where nothing oscillates."""
        rate, angular = jnp.real(self.eigenvalue), jnp.imag(self.eigenvalue)
        none = angular == 0
        decrement = -2.0 * jnp.pi * rate / jnp.where(none, 1.0, angular)
        return jnp.where(none, jnp.inf, decrement)


def modes(rotor: Rotor, speed: Any = 0.0, *, count: Any = None) -> Modes:
    """Modes of a rotor that turns at a speed.

    Args:
        rotor: The rotor.
        speed: Positive from x towards y [rad/s].
        count: Number of modes; `None`: as many as freedoms.

    Returns:
        Modes, with first derivatives with respect to all numbers of the rotor and to
        the speed. Where modes coincide the derivative of each is that of a mixture;
        their sum is right, and each is if they stay together.
    """
    speed = as_real(speed)
    number("modes", "speed", speed, "rad/s")
    return _modes(rotor, speed, _counted("modes", count))


@eqx.filter_jit
def _modes(rotor, speed, count):
    matrices = rotor.linearised(speed)
    return shown(eigenpairs(matrices, count), matrices, speed)


def campbell(rotor: Rotor, speeds: Any, *, count: Any = 8) -> Modes:
    """Modes over speeds, each followed from one speed to the next.

    Modes are numbered by their frequencies at the first speed. A mode is followed by
    its shape: eigenvectors of one speed are orthogonal to the left ones of another
    mode at the next, but for what the step of the speed changes. Take small steps
    where frequencies of one direction come close.

    Args:
        rotor: As in `modes`.
        speeds: (speed,) [rad/s].
        count: Number of modes.

    Returns:
        Modes with `speed` as first axis.
    """
    return _campbell(rotor, speed_list("campbell", speeds), _counted("campbell", count))


@eqx.filter_jit
def _campbell(rotor, speeds, count):
    matrices = rotor.linearised(speeds[0])
    n = matrices.mass.shape[0]
    followed = min(n, n if count is None else count + _SPARE)
    pairs = lax.map(lambda speed: eigenpairs(rotor.linearised(speed), followed), speeds)
    fixed = stop(pairs)

    def step(before, now):
        speed, pairs = now
        order = _pairing(_likeness(before, pairs, rotor.linearised(speed)))
        return jax.tree.map(lambda leaf: leaf[order], pairs), order

    first = jax.tree.map(lambda leaf: leaf[0], fixed)
    later = jax.tree.map(lambda leaf: leaf[1:], fixed)
    _, orders = lax.scan(step, first, (stop(speeds[1:]), later))
    orders = jnp.concatenate([jnp.arange(followed)[None], orders])[:, :count]

    def show(order, pairs, speed):
        pairs = jax.tree.map(lambda leaf: leaf[order], pairs)
        return shown(pairs, matrices, speed)

    return jax.vmap(show)(orders, pairs, speeds)


def _likeness(before, now, matrices):
    """How much modes of one speed (row) are those of the next (column) [1].

    Left and right vectors of different modes obey w·((λ + λ') M + C + Ω G) v = 0.
    """
    mass, rates = (to_complex(part) for part in (matrices.mass, matrices.rates))
    left, right = before.left.conj(), now.right.T
    sums = before.value[:, None] + now.value[None, :]
    product = sums * (left @ mass @ right) + left @ rates @ right
    sizes = jnp.abs(before.value)[:, None] + jnp.abs(now.value)[None, :]
    return jnp.abs(product) / jnp.where(sizes == 0, 1.0, sizes)


def _pairing(likeness):
    """For each row the column that is most like it, each column once."""
    n = likeness.shape[0]

    def pick(_, state):
        left, columns = state
        i, j = jnp.divmod(jnp.argmax(left), n)
        return left.at[i].set(-1.0).at[:, j].set(-1.0), columns.at[i].set(j)

    start = likeness, jnp.zeros(n, dtype=int)
    return lax.fori_loop(0, n, pick, start)[1]


class Pairs(eqx.Module):
    """Eigenvalues and vectors in the freedoms of the rotor.

    Attributes:
        value: Eigenvalues (mode,) [rad/s].
        coincident: Whether another one is the same (mode,).
        right, left: Vectors (mode, freedom) of unit length in the mass matrix.
    """

    value: Complex[Array, "*speed mode"]
    coincident: Bool[Array, "*speed mode"]
    right: Complex[Array, "*speed mode freedom"]
    left: Complex[Array, "*speed mode freedom"]


def eigenpairs(matrices: RotorMatrices, count: int | None) -> Pairs:
    """The first modes; vectors have no derivative."""
    fixed = stop(matrices)
    n = fixed.mass.shape[0]
    factor, stiffness, state = _state(fixed)
    values, left, right = lax.linalg.eig(state)
    eps = jnp.finfo(stiffness.dtype).eps
    floor = _STILL * jnp.sqrt(eps * jnp.linalg.norm(stiffness))
    values = jnp.where(jnp.abs(values) <= floor, 0.0, values)
    real = to_complex(values.real)
    values = jnp.where(jnp.abs(values.imag) <= floor, real, values)
    # First what oscillates, then what does not, then the conjugates of the first.
    last = 1.0 + jnp.max(jnp.abs(values))
    behind = jnp.where(values.imag < 0, 2.0 * last, last + jnp.abs(values))
    chosen = jnp.argsort(jnp.where(values.imag > 0, values.imag, behind))
    chosen = chosen[: n if count is None else min(n, count)]
    value = values[chosen]
    distance = jnp.abs(value[:, None] - values[None, :])
    coincident = jnp.sum(distance <= _COINCIDENT * jnp.abs(value)[:, None], axis=1) > 1

    def vectors(columns):
        sizes = jnp.linalg.norm(columns, axis=0)
        unit = columns / to_complex(jnp.where(sizes == 0, 1.0, sizes))[None, :]
        return jax.scipy.linalg.solve_triangular(to_complex(factor.T), unit).T

    right, left = vectors(right[:n, chosen]), vectors(left[n:, chosen])
    value = jax.vmap(lambda *pair: _refined(matrices, *pair))(value, right, left)
    return Pairs(value, coincident, right, left)


def _state(matrices):
    """Factor of the mass matrix, stiffness and state matrix in mass-normal freedoms."""
    factor = jnp.linalg.cholesky(matrices.mass)
    stiffness = mass_normal(factor, matrices.stiffness)
    eye = jnp.eye(factor.shape[0], dtype=factor.dtype)
    lower = [-stiffness, -mass_normal(factor, matrices.rates)]
    return factor, stiffness, jnp.block([[jnp.zeros_like(eye), eye], lower])


def resonances_above(matrices: RotorMatrices, frequency: Any) -> Int[Array, ""]:
    """How many modes that can resonate oscillate faster than at a frequency.

    Args:
        matrices: Of the rotor.
        frequency: ω [rad/s].
    """
    *_, state = _state(matrices)
    values = jnp.linalg.eigvals(state)
    return jnp.sum((values.imag > frequency) & resonates(values))


def resonates(value: Complex[Array, "*mode"]) -> Bool[Array, "*mode"]:
    """Whether the damping ratio is below √½: a response with a peak.

    Args:
        value: Eigenvalues [rad/s].
    """
    return jnp.abs(value.real) < value.imag


def _refined(matrices, value, right, left):
    """One Newton step of an eigenvalue, with its derivative."""
    left = left.conj()
    rates = to_complex(matrices.rates) @ right
    slope = left @ (2.0 * value * (to_complex(matrices.mass) @ right) + rates)
    residual = left @ (matrices.dynamic_stiffness(value) @ right)
    # No derivative where there is none: critically damped, or a rigid-body motion.
    none = jnp.abs(slope) <= 1e-8 * jnp.abs(value)
    step = jnp.where(none, 0.0, residual / stop(jnp.where(none, 1.0, slope)))
    refined = value - step
    # What does not oscillate stays without a trace of an imaginary part.
    return jnp.where(value.imag > 0, refined, to_complex(refined.real))


def shown(pairs: Pairs, matrices: RotorMatrices, speed: Any) -> Modes:
    """Modes as they are reported.

    Args:
        pairs: Eigenvalues and vectors.
        matrices: Of the rotor; only what its freedoms move is read.
        speed: Of the rotor, whose sense is called forward [rad/s].
    """
    matrices = stop(matrices)
    moved = pairs.right @ to_complex(matrices.motions).T
    nodes, housing = matrices.split(moved)
    largest, nodes = largest_real(nodes, matrices.length)
    housing = housing / largest
    whirl = direction(nodes, matrices.length) * jnp.where(speed < 0, -1, 1)
    whirl = jnp.where(pairs.coincident | (pairs.value.imag == 0), 0, whirl)
    return Modes(pairs.value, whirl, nodes, housing)


def largest_real(
    shape: Complex[Array, "mode node 5"], length: Any
) -> tuple[Complex[Array, "mode 1 1"], Complex[Array, "mode node 5"]]:
    """Largest motion of each mode, and the modes divided by it.

    Args:
        shape, length: As in `direction`.
    """
    scale = jnp.array([1.0, 1.0, 1.0, length, length])[None, None, :]
    sizes = (shape * to_complex(scale)).reshape(shape.shape[0], -1)
    largest = jnp.argmax(jnp.abs(sizes), axis=1)[:, None]
    largest = jnp.take_along_axis(sizes, largest, axis=1)
    largest = jnp.where(largest == 0, 1.0, largest)[:, :, None]
    return largest, shape / largest


def direction(shape: Complex[Array, "*mode node 5"], length) -> Int[Array, "*mode"]:
    """+1 from x towards y, -1 the other way, 0 neither: how most of a mode whirls.

    Neither is a mode in a plane, and one of which half or more goes along the shaft.

    A motion (x, y) = Re (a, b) exp(iωt) is the sum of a circle from x towards y of
    radius |a + ib|/2 and of one the other way of radius |a - ib|/2.

    Args:
        shape: Complex motion of all nodes [m, rad].
        length: Of the shaft, by which tilts are compared with displacements [m].
    """
    length = to_complex(length)
    x = jnp.concatenate([shape[..., 0], length * shape[..., 3]], axis=-1)
    y = jnp.concatenate([shape[..., 1], length * shape[..., 4]], axis=-1)
    # |a + ib|² - |a - ib|² = 4 Im(a b*)
    turning = 2.0 * jnp.sum(jnp.imag(x * y.conj()), axis=-1)
    axial = jnp.sum(jnp.abs(shape[..., 2]) ** 2, axis=-1)
    size = jnp.sum(jnp.abs(x) ** 2 + jnp.abs(y) ** 2, axis=-1) + axial
    whirls = (jnp.abs(turning) > _PLANAR * size) & (axial <= 0.5 * size)
    return jnp.where(whirls, jnp.sign(turning).astype(int), 0)


def speed_list(owner: str, speeds: Any) -> Float[Array, " speed"]:
    """Speeds as an array, or the error that they deserve."""
    real_numbers(owner, "speeds", speeds, "speeds in rad/s")
    speeds = as_real(speeds)
    if speeds.ndim != 1 or speeds.shape[0] == 0:
        raise ValueError(
            f"{owner}: `speeds` has shape {speeds.shape}; it must be (speed,) in rad/s."
        )
    if not is_traced(speeds):
        check(owner, "speeds", jnp.isfinite(speeds), "finite", speeds, "rad/s")
    return speeds


def _counted(owner, count):
    count = as_count(count)
    if count is not None:
        whole(owner, "count", count)
    return count


def to_complex(matrix: Any) -> Any:
    """A real array as a complex one."""
    return lax.complex(matrix, jnp.zeros_like(matrix))

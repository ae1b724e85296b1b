"""Whirl modes of a rotor at a speed, and over speeds (Campbell diagram).

Eigenvalues λ of λ² M + λ (C + Ω G) + K come from LAPACK's eigenvalues of the state
matrix, which JAX has on the CPU only. One Newton step with left and right eigenvectors
that count as fixed, λ - wᵀP(λ)v / wᵀP'(λ)v, then takes away their round-off; its
derivative is that of the eigenvalue, -wᵀ dP v / wᵀP'v. First derivatives are exact,
second ones are not; derivatives of mode shapes are not available.

Source: Lancaster, On eigenvalues of matrices dependent on a parameter, Numer. Math. 6
    (1964) 377-387.
"""

import dataclasses
from collections.abc import Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Complex, Float, Int

from ...design.checks import count as whole
from ...design.checks import finite, is_traced, number, of_shape, real_numbers
from ...numerics.compiled.programs import program
from ...numerics.implicit import stop_gradient
from ...numerics.labels import to_xarray
from ...numerics.lapack import cholesky, congruent, eig, eigvals, solve_any
from ...numerics.shown import Printable
from ...numerics.types import Scalar, array_namespace, as_count, as_real
from ...numerics.units import unit
from ...numerics.warning import Warning
from ..rotor import Rotor, RotorMatrices
from ..shaft import STATION_UNITS

_COINCIDENT = 1e-7
"""Relative distance below which eigenvalues of modes coincide [1]."""
_PLANAR = 1e-6
"""Share of whirl below which a mode has no direction [1]."""
_STILL = 7.0
"""Share of the largest frequency below which a mode counts as not oscillating, over
the square root of the round-off [1]."""
_GROWS = 1e-9
"""Growth over frequency above which a mode is unstable, beyond round-off [1]."""
_ALONE = 0.01
"""Largest share of a growth from secondary causes [1]."""
_ALIKE = 0.7
"""Overlap of a mode with itself at the next speed, below which the step is halved."""
_HALVINGS = 10
"""Most halvings of a step between two speeds of a Campbell diagram."""
_CROSSING = 2e-3
"""Step within which frequencies may cross, over the range of speeds: a longer one
would miss modes that approach and veer [1]."""


_AXIAL = 0.99
"""Share of axial motion above which a mode is one along the axis [1]."""


def is_axial(shape: Any) -> np.ndarray:
    """Return whether modes move almost only along the axis.

    Args:
        shape: Mode shapes (..., node, 5) [m, rad], as in `Modes`.
    """
    squares = np.sum(np.abs(np.asarray(shape)) ** 2, axis=-2)
    return squares[..., 2] > _AXIAL * squares[..., :3].sum(axis=-1)


def major_axis(x: Any, y: Any) -> Any:
    """Return the longer half axis of the orbits Re (x, y) exp(iωt) [m].

    Args:
        x, y: Complex amplitudes [m].
    """
    xp = array_namespace(x)
    return 0.5 * (xp.abs(x + 1j * y) + xp.abs(x - 1j * y))


class Modes(Printable):
    """Modes of a rotor: oscillating ones first, in order of frequency.

    Of equal frequencies the most damped one comes first. Rigid-body and overdamped
    motions follow. Over speeds every field has `speed` as first axis.

    Attributes:
        eigenvalue: λ; the motion goes as exp(λ t) (mode,) [rad/s].
        whirl: +1 forward (with the speed; at rest from x towards y), -1 backward, 0 in
            a plane or axial; 0 too where modes coincide, since any mixture of them is
            a mode (mode,).
        shape: (ux uy uz gx gy) of every node (mode, node, 5) [m, rad]; the largest
            motion is real and 1 m, tilts counted as those of the shaft's length.
        housing: (ux uy uz) of every housing (mode, housing, 3) [m].
        speed: Speed of the rotor, from x towards y [rad/s].
        driven: Part of Re λ by the unsymmetric part of the stiffness of supports
            (mode,) [rad/s]; `None` from `campbell`.
        overlap: Least overlap of each mode on the way from the speed before (speed,
            mode) [1]; `None` from `modes`.
    """

    eigenvalue: Complex[Array, "*speed mode"] = eqx.field(metadata=unit("rad/s"))
    whirl: Int[Array, "*speed mode"]
    shape: Complex[Array, "*speed mode node station_freedom=5"] = eqx.field(
        metadata=unit(STATION_UNITS)
    )
    housing: Complex[Array, "*speed mode housing direction=3"] = eqx.field(
        metadata=unit("m")
    )
    speed: Float[Array, "*speed"] | None = eqx.field(
        metadata=unit("rad/s"), default=None
    )
    driven: Float[Array, " mode"] | None = eqx.field(
        metadata=unit("rad/s"), default=None
    )
    overlap: Float[Array, "speed mode"] | None = eqx.field(
        metadata=unit("1"), default=None
    )

    to_xarray = to_xarray

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings of the first unstable mode, of `modes`, and of modes that were not
        followed for certain, of `campbell`; empty where numbers are traced."""
        if any(is_traced(leaf) for leaf in jax.tree.leaves(self)):
            return ()
        return (*_instability_warning(self), *_following_warning(self))

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
    """Return the modes of a rotor at a speed.

    Args:
        rotor: The rotor.
        speed: Positive from x towards y [rad/s].
        count: Number of modes; `None`: as many as freedoms.

    Returns:
        Modes, with first derivatives with respect to all numbers of the rotor and to
        the speed. Where modes coincide the derivative of each is that of a mixture;
        their sum is right, and each is if they stay together. Its `warnings` say if a
        mode grows, and whether the unsymmetric part of the stiffness of supports does
        it.
    """
    speed = as_real(speed)
    number("modes", "speed", speed, "rad/s")
    found, driven = _modes(rotor, speed, _count("modes", count))
    return dataclasses.replace(found, speed=speed, driven=driven)


@program(quick=True, what="modes")
def _modes(rotor, speed, count):
    """Return modes, and the part of unsymmetric stiffness in Re λ of each [rad/s]."""
    matrices = rotor.linearise(speed)
    pairs = eigenpairs(matrices, count)
    fixed, known = stop_gradient(matrices), stop_gradient(pairs)
    own = jnp.diagonal(_products(known, known, fixed))
    unsymmetric = to_complex(0.5 * (fixed.stiffness - fixed.stiffness.T))
    work = jnp.sum((known.left.conj() @ unsymmetric) * known.right, axis=1)
    driven = jnp.where(own == 0, 0.0, -work / jnp.where(own == 0, 1.0, own)).real
    return _modes_of(pairs, matrices, speed), driven


def _instability_warning(found) -> Iterator[Warning]:
    """Yield a warning of the first unstable mode."""
    if found.driven is None:
        return
    speed, driven = float(found.speed), np.asarray(found.driven)
    value = np.asarray(found.eigenvalue)
    rate, angular = np.real(value), np.imag(value)
    grows = np.flatnonzero((angular > 0) & (rate > _GROWS * np.abs(value)))
    if not len(grows):
        return
    k = grows[0]
    ratio = rate[k] / np.abs(value[k])
    cause = ""
    if driven[k] >= (1.0 - _ALONE) * rate[k]:
        cause = (
            "; what drives it is the unsymmetric part of the stiffness of supports, and"
            f" a damping ratio above {ratio:.2g} more holds it"
        )
    yield Warning(
        "unstable_mode",
        f"modes: unstable at {speed:.5g} rad/s ({speed * 30.0 / np.pi:.5g} rpm): the"
        f" mode of {angular[k] / (2.0 * np.pi):.5g} Hz grows, its damping ratio is"
        f" {-ratio:.2g}{cause}",
        float(ratio),
        _GROWS,
        f"mode {k + 1}",
    )


def campbell(rotor: Rotor, speeds: Any, *, count: Any = 8) -> Modes:
    """Return modes over speeds, each followed from one speed to the next.

    Modes are numbered by their frequencies at the first speed, and those that coincide
    by theirs at the next one. A mode is followed by its shape: its overlap with each
    mode of the next speed is the product of two scalar products, of left and of right
    vectors, and sums up to one. Where that with itself is below 0.7, and where
    frequencies cross, speeds between are looked at too, so that the lines hang little
    on how many speeds are given.

    Args:
        rotor: As in `modes`.
        speeds: (speed,) [rad/s].
        count: Number of modes.

    Returns:
        Modes with `speed` as first axis. Its `warnings` say if a mode is not clearly
        the same at the next speed, however small the step; it may then change places
        with another one.
    """
    speeds = speed_list("campbell", speeds)
    found, overlap = follow_modes(rotor, speeds, _count("campbell", count))
    return dataclasses.replace(found, speed=speeds, overlap=overlap)


def _following_warning(found) -> Iterator[Warning]:
    """Yield a warning of modes that were not followed reliably."""
    if found.overlap is None:
        return
    speeds, overlap = np.asarray(found.speed), np.asarray(found.overlap)
    poor = ~(overlap >= _ALIKE)
    steps = np.flatnonzero(poor.any(axis=1))
    if not len(steps):
        return
    where = [
        f"mode {', '.join(str(m + 1) for m in np.flatnonzero(poor[k]))} between"
        f" {speeds[k - 1]:.5g} and {speeds[k]:.5g} rad/s"
        for k in steps[:3]
    ]
    more = f" and in {len(steps) - 3} steps more" if len(steps) > 3 else ""
    yield Warning(
        "swapping_modes",
        f"campbell: not followed for certain: {'; '.join(where)}{more}; there modes may"
        " change places",
        float(overlap.min()),
        _ALIKE,
        "; ".join(where),
    )


@program(quick=True, what="modes over the speed")
def follow_modes(
    rotor: Rotor, speeds: Float[Array, " speed"], count: int | None
) -> tuple[Modes, Float[Array, "speed mode"]]:
    """Return modes over speeds, and the least overlap of each between them.

    Args:
        rotor, speeds, count: As in `campbell`.
    """
    matrices = rotor.linearise(speeds[0])
    n = matrices.mass.shape[0]
    count = n if count is None else min(n, count)
    fixed = stop_gradient(rotor)
    crossing = _CROSSING * stop_gradient(jnp.max(speeds) - jnp.min(speeds))

    def at_speed(speed, before):
        """Return eigenpairs, their order by those before, and the overlaps."""
        there = fixed.linearise(speed)
        now = _biorthogonal(eigenpairs(there, None), there)
        return now, *_match(before, now, there)

    def follow(state, given):
        before, at = state
        speed, first = given
        way = speed - at

        def step(state):
            at, size, pairs, least, _ = state
            left = speed - at
            last = first | (jnp.abs(size) >= jnp.abs(left))
            trial = jnp.where(last, speed, at + size)
            now, order, overlap = at_speed(trial, pairs)
            order = jnp.where(first, jnp.arange(n), order)
            overlap = jnp.where(first, 1.0, overlap[:count])
            now = jax.tree.map(lambda leaf: leaf[order], now)
            short = jnp.abs(size) <= jnp.abs(way) / 2**_HALVINGS
            crossed = (
                (jnp.abs(size) > crossing) & _has_crossed(pairs, now, count) & ~first
            )
            good = (jnp.all(overlap >= _ALIKE) & ~crossed) | short
            pairs = jax.tree.map(lambda a, b: jnp.where(good, a, b), now, pairs)
            least = jnp.where(good, jnp.minimum(least, overlap), least)
            size = jnp.where(good, 2.0 * size, 0.5 * size)
            return jnp.where(good, trial, at), size, pairs, least, good & last

        begin = at, way, before, jnp.ones(count, speed.dtype), jnp.asarray(False)
        _, _, pairs, least, _ = lax.while_loop(lambda s: ~s[4], step, begin)
        return (pairs, speed), (jax.tree.map(lambda leaf: leaf[:count], pairs), least)

    blank = jax.eval_shape(lambda: eigenpairs(matrices, None))
    blank = jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), blank)
    first = jnp.arange(len(speeds)) == 0
    turning = stop_gradient(speeds)
    _, (pairs, overlap) = lax.scan(follow, (blank, turning[0]), (turning, first))

    def show(pairs, speed):
        # Vectors have no derivative; eigenvalues have that of one Newton step.
        own = rotor.linearise(speed)
        value = jax.vmap(lambda *pair: _refine(own, *pair))(
            pairs.value, pairs.right, pairs.left
        )
        pairs = eqx.tree_at(lambda p: p.value, pairs, value)
        return _modes_of(pairs, matrices, speed)

    return lax.map(lambda both: show(*both), (pairs, speeds)), overlap


def _products(left, right, matrices):
    """Return w·((λ + λ') M + C + Ω G) v of left and right vectors (mode, mode): zero
    for different modes of one speed [kg/s]."""
    mass, rates = (to_complex(part) for part in (matrices.mass, matrices.rates))
    w, v = left.left.conj(), right.right.T
    sums = left.value[:, None] + right.value[None, :]
    return sums * (w @ mass @ v) + w @ rates @ v


def _coincide(pairs):
    """Return which modes have coincident eigenvalues (mode, mode)."""
    apart = jnp.abs(pairs.value[:, None] - pairs.value[None, :])
    return apart <= _COINCIDENT * jnp.abs(pairs.value)[:, None]


def _biorthogonal(pairs, matrices):
    """Combine left vectors so that `_products` is the unit matrix, also for coincident
    modes; modes that do not oscillate are unchanged."""
    swings = pairs.value.imag > 0
    own = _coincide(pairs) & swings[:, None] & swings[None, :]
    products = jnp.where(own, _products(pairs, pairs, matrices), 0.0)
    products = products + jnp.diag(to_complex(jnp.where(swings, 0.0, 1.0)))
    left = solve_any(products, pairs.left.conj()).conj()
    return eqx.tree_at(lambda p: p.left, pairs, left)


def _match(before, now, matrices):
    """Match each mode to one of the next speed, where they are in order; return their
    numbers and overlaps, of coincident modes those of their subspaces [1]."""
    shares = _products(before, now, matrices) * _products(now, before, matrices).T
    order = _pairing(jnp.where(jnp.isfinite(shares), jnp.abs(shares), 0.0))
    # Coincident modes have no shape of their own, and go on in order of frequency.
    group = jnp.argmax(_coincide(before), axis=1)
    order = order.at[jnp.argsort(group)].set(order[jnp.lexsort((order, group))])
    one, other = _coincide(before), _coincide(now)
    one, other = (same.astype(before.value.real.dtype) for same in (one, other))
    together = jnp.abs(to_complex(one) @ shares @ to_complex(other).T)
    sizes = jnp.minimum(jnp.sum(one, 1)[:, None], jnp.sum(other, 1)[None, :])
    overlap = jnp.take_along_axis(together / sizes, order[:, None], axis=1)[:, 0]
    swings = (before.value.imag > 0) & (now.value.imag[order] > 0)
    return order, jnp.where(swings, jnp.minimum(overlap, 1.0), 1.0)


def _has_crossed(before, now, count):
    """Return whether the frequency of one of the first modes crosses another."""
    one, other = before.value.imag, now.value.imag
    gaps = (x[:count, None] - x[None, :] for x in (one, other))
    swing = (one > 0) & (other > 0)
    alike = (_coincide(before) | _coincide(now))[:count]
    turned = jnp.prod(jnp.stack([jnp.sign(gap) for gap in gaps]), axis=0) < 0
    return jnp.any(turned & swing[:count, None] & swing[None, :] & ~alike)


def _pairing(likeness):
    """Return the most similar column of each row, each column once."""
    n = likeness.shape[0]

    def pick(_, state):
        left, columns = state
        i, j = jnp.divmod(jnp.argmax(left), n)
        return left.at[i].set(-1.0).at[:, j].set(-1.0), columns.at[i].set(j)

    start = likeness, jnp.zeros(n, dtype=int)
    return lax.fori_loop(0, n, pick, start)[1]


class Pairs(eqx.Module):
    """Eigenvalues and eigenvectors in the freedoms of the rotor.

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
    """Return the first modes; vectors have no derivative."""
    fixed = stop_gradient(matrices)
    n = fixed.mass.shape[0]
    factor, stiffness, state = _state(fixed)
    values, left, right = eig(state)
    eps = jnp.finfo(stiffness.dtype).eps
    floor = _STILL * jnp.sqrt(eps * jnp.linalg.norm(stiffness))
    values = jnp.where(jnp.abs(values) <= floor, 0.0, values)
    real = to_complex(values.real)
    values = jnp.where(jnp.abs(values.imag) <= floor, real, values)
    chosen = _by_frequency(values)[: n if count is None else min(n, count)]
    value = values[chosen]
    distance = jnp.abs(value[:, None] - values[None, :])
    coincident = jnp.sum(distance <= _COINCIDENT * jnp.abs(value)[:, None], axis=1) > 1

    def vectors(columns):
        sizes = jnp.linalg.norm(columns, axis=0)
        unit = columns / to_complex(jnp.where(sizes == 0, 1.0, sizes))[None, :]
        return solve_any(to_complex(factor.T), unit, "upper").T

    right, left = vectors(right[:n, chosen]), vectors(left[n:, chosen])
    value = jax.vmap(lambda *pair: _refine(matrices, *pair))(value, right, left)
    return Pairs(value, coincident, right, left)


def _by_frequency(values):
    """Order eigenvalues: oscillating modes, of equal frequencies the most damped first;
    then the others, then conjugates of the first."""
    last = 1.0 + jnp.max(jnp.abs(values))
    behind = jnp.where(values.imag < 0, 2.0 * last, last + jnp.abs(values))
    key = jnp.where(values.imag > 0, values.imag, behind)
    order = jnp.argsort(key)
    key = key[order]
    new = (jnp.diff(key) > _COINCIDENT * key[1:]) | (key[1:] >= last)
    group = jnp.cumsum(jnp.append(False, new))
    return order[jnp.lexsort((values.real[order], group))]


def _state(matrices):
    """Return mass factor, stiffness and state matrix in mass-normal freedoms."""
    factor = cholesky(matrices.mass)
    stiffness = congruent(factor, matrices.stiffness)
    eye = jnp.eye(factor.shape[0], dtype=factor.dtype)
    lower = [-stiffness, -congruent(factor, matrices.rates)]
    return factor, stiffness, jnp.block([[jnp.zeros_like(eye), eye], lower])


def resonances_above(matrices: RotorMatrices, frequency: Any) -> Int[Array, ""]:
    """Count the modes that can resonate above a frequency.

    Args:
        matrices: Matrices of the rotor.
        frequency: ω [rad/s].
    """
    *_, state = _state(matrices)
    values = eigvals(state)
    return jnp.sum((values.imag > frequency) & resonates(values))


def resonates(value: Complex[Array, "*mode"]) -> Bool[Array, "*mode"]:
    """Return whether the damping ratio is below √½: a response with a peak.

    Args:
        value: Eigenvalues [rad/s].
    """
    return jnp.abs(value.real) < value.imag


def _refine(matrices, value, right, left):
    """Make one Newton step of an eigenvalue, with its derivative."""
    left = left.conj()
    rates = to_complex(matrices.rates) @ right
    slope = left @ (2.0 * value * (to_complex(matrices.mass) @ right) + rates)
    residual = left @ (matrices.dynamic_stiffness(value) @ right)
    # No derivative where there is none: critically damped, or a rigid-body motion.
    none = jnp.abs(slope) <= 1e-8 * jnp.abs(value)
    step = jnp.where(none, 0.0, residual / stop_gradient(jnp.where(none, 1.0, slope)))
    refined = value - step
    # What does not oscillate stays without a trace of an imaginary part.
    return jnp.where(value.imag > 0, refined, to_complex(refined.real))


def _modes_of(pairs, matrices, speed):
    """Return `Modes` from eigenpairs; the sense of the speed is called forward."""
    matrices = stop_gradient(matrices)
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
    """Return the largest motion of each mode, and the modes divided by it.

    Args:
        shape, length: As in `direction`.
    """
    scale = jnp.array([1.0, 1.0, 1.0, length, length])[None, None, :]
    sizes = (shape * to_complex(scale)).reshape(shape.shape[0], -1)
    largest = jnp.argmax(jnp.abs(sizes), axis=1)[:, None]
    largest = jnp.take_along_axis(sizes, largest, axis=1)
    largest = jnp.where(largest == 0, 1.0, largest)[:, :, None]
    return largest, shape / largest


def direction(
    shape: Complex[Array, "*mode node 5"], length: Scalar | float
) -> Int[Array, "*mode"]:
    """Return the whirl of a mode: +1 from x towards y, -1 opposite, 0 neither.

    Neither is a planar mode, and one that is at least half axial.

    A motion (x, y) = Re (a, b) exp(iωt) is the sum of a circle from x towards y of
    radius |a + ib|/2 and of one the other way of radius |a - ib|/2.

    Args:
        shape: Complex motion of all nodes [m, rad].
        length: Length of the shaft, by which tilts are compared with displacements [m].
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
    """Return speeds as a checked array."""
    real_numbers(owner, "speeds", speeds, "speeds in rad/s")
    speeds = as_real(speeds)
    several = speeds.ndim == 1 and speeds.size > 0
    of_shape(owner, "speeds", several, "(speed,) in rad/s", speeds)
    finite(owner, "speeds", speeds, "rad/s")
    return speeds


def _count(owner, count):
    count = as_count(count)
    if count is not None:
        whole(owner, "count", count)
    return count


def to_complex(matrix: Any) -> Any:
    """Return a real array as complex."""
    return lax.complex(matrix, jnp.zeros_like(matrix))

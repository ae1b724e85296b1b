"""Largest amplitude along a branch, with derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from ...numerics.compiled.programs import program
from ...numerics.implicit import attach_by, stop_gradient, unless_failed
from ...numerics.lapack import solve_any
from ...numerics.result import Result, raise_unless_converged
from .branch import Branch
from .continuation import place
from .method import AbstractMethod
from .orbit import PeriodicOrbit, amplitudes, describe_orbit
from .system import AbstractVibratingSystem

_SPLITS = 50
"""Most points at which the peak is sought."""
_CLOSE = 1e-10
"""Tolerance of its position along the branch [1]."""
_SMOOTH = 1e-5
"""Slope of an amplitude at a smooth peak, over that around it [1]."""


def peak(
    system: AbstractVibratingSystem,
    branch: Branch,
    freedom: int,
    method: AbstractMethod,
    *,
    between: tuple[float, float] | None = None,
    throw: bool = True,
) -> PeriodicOrbit:
    """Find the orbit of largest amplitude of one freedom along a branch.

    It is sought on the curve between the points of the branch.

    Args:
        system: System of the branch, or one so near that the points of the branch are
            good guesses, as in differences.
        branch: From `follow`, by the same method.
        freedom: Whose amplitude. Static.
        method: `Shooting` or `HarmonicBalance`.
        between: Frequencies between which it lies [rad/s]; `None`: anywhere.
        throw: Raise if it is not found. Static.

    Returns:
        The orbit. Its frequency and amplitudes are differentiable with respect to every
        number of the system: the orbit moves along with the peak.

    Raises:
        ValueError: If the largest amplitude is at an end of the branch (or of what is
            between), where it is no peak.
        SolveError: If the peak was not found and `throw`.

    Fails: `STEP_LIMIT`, where the amplitude has a corner at its largest too, or a peak
        far narrower than the steps of the branch;
        `NON_FINITE`.
    """
    low, high = (-np.inf, np.inf) if between is None else sorted(between)
    inside = (branch.frequency >= low) & (branch.frequency <= high)
    sizes = np.where(inside, branch.amplitude[:, freedom], -np.inf)
    k = int(np.argmax(sizes)) if inside.any() else -1
    if not 0 < k < len(sizes) - 1 or not inside[k - 1 : k + 2].all():
        raise ValueError(
            "peak: the largest amplitude of this freedom is at an end of the branch or"
            " of `between`: follow the branch further."
        )
    ratio = branch.frequency / stop_gradient(system.reference_frequency)
    points = [
        jnp.append(jnp.asarray(branch.unknowns[i]), ratio[i]) for i in (k - 1, k, k + 1)
    ]
    orbit = _find(system, jnp.stack(points), freedom, method)
    if not throw:
        return orbit
    return raise_unless_converged(
        orbit,
        orbit.result,
        lambda: (
            f"peak: not found near {float(branch.frequency[k]):.6g} rad/s"
            f" ({Result(int(orbit.result)).label}): the amplitude has a corner there,"
            " the points of the branch are too far apart for so narrow a peak (follow"
            " it with smaller `Steps`), or the system is not that of the branch."
        ),
        "peak",
    )


def _size(system, freedom, method):
    """Return (unknowns, frequency ratio) -> amplitude over the scale [1]."""

    def amplitude(x):
        return amplitudes(method.motion(system, x[:-1], x[-1])[0])[freedom]

    return amplitude


@program
def _find(system, points, freedom, method):
    fixed = stop_gradient(system)
    size = _size(fixed, freedom, method)

    def on_branch(x, direction):
        point, result = place(fixed, method, x, direction, direction)
        return point, jax.jvp(size, (point.x,), (point.tangent,))[1], result

    across = points[2] - points[0]
    across = across / jnp.linalg.norm(across)
    here, rise, first = on_branch(points[1], across)
    # The peak is on the side to which the amplitude rises.
    far = jnp.where(rise > 0, points[2], points[0])
    there, fall, second = on_branch(far, across)
    span = across @ (there.x - here.x)

    def continues(state):
        (a, _), (b, _), _, _, slope, _, count = state
        return (jnp.abs(b - a) > _CLOSE) & (slope != 0) & (count < _SPLITS)

    def split(state):
        (a, at_a), (b, at_b), last, *_, count = state
        share = at_a / (at_a - at_b)
        # Illinois' method; halves the interval now and then for good.
        share = jnp.where(count % 4 == 3, 0.5, jnp.clip(share, 0.01, 0.99))
        middle = a + share * (b - a)
        point, slope, found = on_branch(here.x + middle * across, across)
        left = slope * rise > 0
        new = middle, slope
        a_new = jax.tree.map(lambda x, y: jnp.where(left, x, y), new, (a, at_a))
        b_new = jax.tree.map(lambda x, y: jnp.where(left, y, x), new, (b, at_b))
        side = jnp.where(left, 1, -1).astype(jnp.int32)
        half = jnp.where(side == last, 0.5, 1.0)
        a_new = a_new[0], jnp.where(left, a_new[1], half * a_new[1])
        b_new = b_new[0], jnp.where(left, half * b_new[1], b_new[1])
        return a_new, b_new, side, point, slope, found, count + 1

    nothing = jnp.zeros_like(span)
    none = jnp.int32(0)
    begin = (nothing, rise), (span, fall), none, here, rise, first, none
    *_, point, slope, last, count = lax.while_loop(continues, split, begin)
    worst = jnp.maximum(jnp.maximum(first, second), last)
    smooth = jnp.abs(slope) <= _SMOOTH * (jnp.abs(rise) + jnp.abs(fall))
    bracketed = rise * fall <= 0
    missed = jnp.where(smooth & bracketed, 0, int(Result.STEP_LIMIT))
    result = jnp.maximum(worst, missed.astype(jnp.int32))
    finite = jnp.isfinite(slope) & jnp.all(jnp.isfinite(point.x))
    result = jnp.where(finite, result, jnp.int32(int(Result.NON_FINITE)))

    def split_up(y):
        return y[: point.x.shape[0]], y[point.x.shape[0] :]

    def residual(y, given):
        """Return residuals of orbit, tangent, and slope of the amplitude along it."""
        (x, tangent), (system, about) = split_up(y), given
        left, along = jax.jvp(
            lambda x: method.residual(system, x[:-1], x[-1]), (x,), (tangent,)
        )
        _, slope = jax.jvp(_size(system, freedom, method), (x,), (tangent,))
        length = tangent @ about - 1.0
        return jnp.concatenate([left, along, jnp.stack([length, slope])])

    def correction(of_y, y, change, _):
        return -solve_any(jax.jacfwd(of_y)(y), change)

    y = jnp.concatenate([point.x, point.tangent])

    def orbit(system):
        x, _ = split_up(attach_by(residual, y, (system, point.tangent), correction))
        return describe_orbit(system, method, x, point.residual, count, result)

    return unless_failed(orbit, (system,), result == int(Result.CONVERGED))

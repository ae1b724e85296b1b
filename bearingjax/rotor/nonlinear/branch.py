"""A branch of periodic orbits with its stability and its marked points."""

from collections.abc import Callable
from typing import Annotated, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.checks import positive
from ...numerics import Result, Warning, as_real
from ...numerics.compiled.programs import program
from ...numerics.types import Number
from ...numerics.units import unit, units
from .continuation import (
    Arclength,
    BranchEnd,
    BranchPoint,
    ChangeOfParameter,
    Steps,
    TracedBranch,
    place,
    trace,
)
from .method import AbstractMethod
from .orbit import STABLE, beginning
from .system import AbstractVibratingSystem

_LOCATED = 1e-7
"""Tolerance of the position of an event along the branch, over its frequency [1]."""


class Event(NamedTuple):
    """Event on a branch: a bifurcation point.

    Attributes:
        kind: "fold" (a multiplier passes +1 and the branch turns back in frequency),
            "flip" (-1), "neimark_sacker" (a pair leaves the unit circle), or
            "branch_point" (another branch crosses here).
        frequency: [rad/s].
        amplitude: Half of peak to peak (n,) [m, rad].
        displacement: At even phases from 0 on (sample, n) [m, rad].
        multipliers: (2n,) [1].
        after: Index of the last point of the branch before it.
        located: Whether an orbit was found there; if not, numbers are those of the
            last attempt.
    """

    kind: str
    frequency: Annotated[float, unit("rad/s")]
    amplitude: Annotated[np.ndarray, units("m", "rad")]
    displacement: Annotated[np.ndarray, units("m", "rad")]
    multipliers: Annotated[np.ndarray, unit("1")]
    after: int
    located: bool


class Branch(NamedTuple):
    """Periodic orbits over the frequency of their excitation, in order.

    Attributes:
        frequency: (point,) [rad/s].
        amplitude: Half of peak to peak over the period (point, n) [m, rad].
        displacement: At even phases from 0 on (point, sample, n) [m, rad].
        multipliers: Floquet multipliers, the largest first (point, 2n) [1].
        stable: Whether all multipliers lie within the unit circle (point,).
        unknowns: Unknowns of the method (point, m) [1].
        residual: Residual of its equations, largest (point,) [1].
        newton: Newton steps (point,).
        events: Marked points, in order.
        refused: Steps that were tried in vain.
        ending: Why the branch ends.
    """

    frequency: Annotated[np.ndarray, unit("rad/s")]
    amplitude: Annotated[np.ndarray, units("m", "rad")]
    displacement: Annotated[np.ndarray, units("m", "rad")]
    multipliers: Annotated[np.ndarray, unit("1")]
    stable: np.ndarray
    unknowns: Annotated[np.ndarray, unit("1")]
    residual: Annotated[np.ndarray, unit("1")]
    newton: np.ndarray
    events: tuple[Event, ...]
    refused: int
    ending: BranchEnd

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings: orbits that are unstable."""
        lost = int((~self.stable).sum())
        if not lost:
            return ()
        words = (
            f"{lost} of {len(self.stable)} periodic vibrations are unstable: the system"
            " does not stay there"
        )
        return (Warning("unstable_vibration", words, float(lost), 0.0),)


def follow(
    system: AbstractVibratingSystem,
    begin: Number,
    end: Number,
    method: AbstractMethod,
    start: Float[Array, "sample n"] | None = None,
    *,
    parameter: Arclength | ChangeOfParameter | None = None,
    steps: Steps | None = None,
    locate: bool = True,
) -> Branch:
    """Follow a branch of periodic orbits from one frequency towards another.

    Args:
        system: The system.
        begin, end: Frequencies [rad/s], `begin` above zero; `end` may be below it. At
            zero, where nothing repeats, the branch ends.
        method: `Shooting` or `HarmonicBalance`.
        start: Displacements at `begin` to start with, at even phases from 0 on, such
            as an orbit's by any method (sample, n) [m, rad]; `None`: rest.
        parameter: Quantity held between points; `None`: `Arclength()`.
        steps: Lengths of steps, and most points; `None`: `Steps()`.
        locate: Whether folds, flips, Neimark-Sacker and branch points are located, to
            1e-6 in frequency.

    Returns:
        The branch. It always comes back; `ending` says why it ends.

    Raises:
        ValueError: If `begin` is not above zero.
    """
    positive("follow", "begin", begin, "rad/s")
    parameter, steps = parameter or Arclength(), steps or Steps()
    motion, begin, end = beginning(system, start), as_real(begin), as_real(end)
    found = _trace(system, method, motion, begin, end, parameter, steps)
    *every, count, refused, ending = jax.tree.map(np.asarray, found)
    at = BranchPoint(*(x[:count] for x in every))
    scale, unit = np.asarray(system.scale), float(system.reference_frequency)
    multipliers = np.linalg.eigvals(at.monodromy)
    # LAPACK's order hangs on round-off.
    order = np.argsort(-np.abs(multipliers), axis=1, kind="stable")
    multipliers = np.take_along_axis(multipliers, order, axis=1)
    stable = np.abs(multipliers).max(axis=1, initial=0.0) <= 1.0 + STABLE
    return Branch(
        frequency=np.asarray(at.x[:, -1]) * unit,
        amplitude=np.asarray(at.amplitude) * scale,
        displacement=np.asarray(at.motion) * scale,
        multipliers=multipliers,
        stable=stable,
        unknowns=np.asarray(at.x[:, :-1]),
        residual=np.asarray(at.residual),
        newton=np.asarray(at.newton),
        events=_events(system, method, at) if locate else (),
        refused=int(refused),
        ending=BranchEnd(int(ending)),
    )


@program(quick=True, level=1)
def _trace(system, method, motion, begin, end, parameter, steps) -> TracedBranch:
    z, unit = method.unknowns(motion), system.reference_frequency
    return trace(
        system,
        method,
        jnp.append(z, begin / unit),
        end / unit,
        parameter,
        steps,
    )


@program(quick=True, level=1)
def _correct_at(system, method, x, tangent, length):
    """Return the point of the branch at a length along its tangent from `x`."""
    return place(system, method, x + length * tangent, tangent, tangent)


def _flip_test(point: BranchPoint) -> float:
    return _signed_least(np.linalg.eigvals(point.monodromy) + 1.0)


def _pairs(point: BranchPoint) -> float:
    """Return a function that is zero if two multipliers have the product one."""
    k = np.linalg.eigvals(point.monodromy)
    i, j = np.triu_indices(len(k), 1)
    return _signed_least(k[i] * k[j] - 1.0)


def _signed_least(factors: np.ndarray) -> float:
    """Return the least of some factors with the sign of their real product.

    It changes sign where the product does, which would underflow for many factors.
    """
    sizes = np.abs(factors)
    signs = factors / np.where(sizes == 0, 1.0, sizes)
    return float(np.copysign(sizes.min(), np.prod(signs).real))


def _side(point: BranchPoint) -> float:
    return float(point.side)


_TESTS: dict[str, Callable[[BranchPoint], float]] = {
    "fold": lambda point: float(point.tangent[-1]),
    "flip": _flip_test,
    "neimark_sacker": _pairs,
    "branch_point": _side,
}
"""Test functions, which change sign at events."""


def _events(system, method, points: BranchPoint) -> tuple[Event, ...]:
    every = [BranchPoint(*(x[k] for x in points)) for k in range(len(points.x))]
    events = []
    for kind, test in _TESTS.items():
        signs = np.sign([test(point) for point in every])
        for k in np.nonzero(signs[1:] * signs[:-1] < 0)[0]:
            found = _locate(system, method, every, int(k), kind, test)
            if found is not None:
                events.append(found)
    return tuple(event for _, event in sorted(events, key=lambda found: found[0]))


def _locate(system, method, every, k, kind, test):
    """Locate an event: return its position along the branch, in points, and itself."""
    # Imported here, which keeps the import of the package fast.
    from scipy.optimize import brentq

    here, there = every[k], every[k + 1]
    if kind == "neimark_sacker" and _count_unstable(here) == _count_unstable(there):
        # Two real multipliers with the product one, or a system without damping.
        return None

    def point_at(length):
        found, result = _correct_at(
            system, method, here.x, here.tangent, jnp.asarray(length, here.x.dtype)
        )
        return jax.tree.map(np.asarray, found), int(result) == Result.CONVERGED

    span = float(here.tangent @ (there.x - here.x))
    ends = {0.0: here, span: there}
    length = brentq(
        lambda length: test(ends[length] if length in ends else point_at(length)[0]),
        0.0,
        span,
        xtol=_LOCATED * abs(float(here.x[-1])),
    )
    point, solved = point_at(length)
    event = Event(
        kind,
        float(point.x[-1]) * float(system.reference_frequency),
        np.asarray(point.amplitude) * np.asarray(system.scale),
        np.asarray(point.motion) * np.asarray(system.scale),
        np.linalg.eigvals(point.monodromy),
        k,
        solved,
    )
    return k + float(here.tangent @ (point.x - here.x)) / span, event


def _count_unstable(point: BranchPoint) -> int:
    """Return the number of multipliers outside the unit circle."""
    return int(np.sum(np.abs(np.linalg.eigvals(point.monodromy)) > 1.0 + STABLE))

"""Where weight, constant forces and preload put a rotor in its bearings.

Without speed a linear shaft between its supports is a stiffness between the supported
stations alone: the rest is condensed exactly. Of the motions of these stations the
balance is solved by the trust-region Newton method that solves single bearings too,
judged by forces, because supports need not have a potential.
"""

import warnings
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from ..design.checks import check, is_traced, number, positive
from ..design.checks import count as whole
from ..numerics.implicit import attach_by, recall, stop, unless_failed
from ..numerics.linear import solve
from ..numerics.minimise import Evaluation, Minimum, TrustRegionNewton
from ..numerics.result import Result, raise_unless_converged, worst
from ..numerics.types import Scalar, as_count, as_real
from .held import of_each
from .loads import RotorLoads
from .parts import AbstractSupport, LinearSupport
from .reduction import held_motions
from .rotor import N_HOUSING, N_STATION, Rotor
from .shaft import STATION_FREEDOMS
from .speed_support import SpeedSupport, chebyshev_analysis

_FIRST_STEP = 1e-5
"""First bound of the steps [m]."""
_FREE = 1e-9
"""Stiffness over the largest one below which a motion counts as free [1]."""
_SOLVER = TrustRegionNewton(
    tolerance=1e-11, max_steps=200, symmetric=False, softest=0.03
)


class Settled(eqx.Module):
    """A rotor at rest in its supports, at one speed.

    Attributes:
        displacement: (ux uy uz gx gy) of every node (node, 5) [m, rad].
        housing: (ux uy uz) of every housing (housing, 3) [m].
        support_load: What the shaft puts on every support (support, 5) [N, N m].
        stiffness: Of every support there (support, 5, 5) [N/m, N, N m].
        damping: Likewise (support, 5, 5) [N s/m, N s, N m s].
        rotor: The rotor on springs and dampers of that stiffness and damping, for all
            linear analyses about this place.
        motion: Displacements of all nodes and housings (motion,) [m, rad].
        speed: At which the supports were asked [rad/s].
        residual: Force that is left over that which acts [1].
        steps: Steps of the search.
        result: `Result` code; the numbers are NaN unless it is `CONVERGED`.
        free: Motion that nothing holds (motion,), zeros if everything is held [1].
    """

    displacement: Float[Array, "node 5"]
    housing: Float[Array, "housing 3"]
    support_load: Float[Array, "support 5"]
    stiffness: Float[Array, "support 5 5"]
    damping: Float[Array, "support 5 5"]
    rotor: Rotor
    motion: Float[Array, " motion"]
    speed: Scalar
    residual: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]
    free: Float[Array, " motion"]


def settle(
    rotor: Any,
    loads: Any = None,
    speed: Any = 0.0,
    *,
    throw: bool = True,
) -> Settled:
    """Equilibrium under weight, constant forces and the preload of the bearings.

    Args:
        rotor: `Rotor`: shaft, discs, supports; one support at least.
        loads: `RotorLoads`; the constant ones count; `None`: nothing but preload.
        speed: Of the rotor, for supports that follow it [rad/s].
        throw: Raise if there is none. Static.

    Returns:
        Settled, with first derivatives with respect to all numbers of rotor, loads
        and speed.

    Fails: `STEP_LIMIT`, `NO_LOAD_PATH`, `NON_FINITE`.

    Raises:
        SolveError: If it was not found and `throw`; it says where the rotor went.
        TypeError: If `rotor` or `loads` is something else.
        ValueError: If the rotor has no support, or a loaded station is not there.

    Warns:
        UserWarning: If a bearing bears nothing, or nothing holds the rotor along some
            motion (which then stays what it is).
    """
    loads = _checked("settle", rotor, loads)
    speed = as_real(speed)
    number("settle", "speed", speed, "rad/s")
    found, place = _settle(rotor, loads, speed)
    if throw:
        found = raise_unless_converged(
            found, found.result, lambda: _message(rotor, found, place)
        )
    known = not is_traced(found.motion) and not is_traced(found.result)
    if known and int(found.result) == Result.CONVERGED:
        _warn(rotor, found)
    return found


class SettledOver(eqx.Module):
    """A rotor at rest in its supports, at speeds from rest to a top speed.

    Attributes:
        rotor: The rotor on springs that follow the speed (`SpeedSupport`), for all
            linear analyses up to the top speed.
        speed: Where it was settled (place,) [rad/s].
        displacement, support_load, stiffness: There, as of `Settled`, with `place` as
            first axis.
        error: What the polynomials may miss, over the largest stiffness [1].
        result: Worst `Result` code; the numbers are NaN unless it is `CONVERGED`.
    """

    rotor: Rotor
    speed: Float[Array, " place"]
    displacement: Float[Array, "place node 5"]
    support_load: Float[Array, "place support 5"]
    stiffness: Float[Array, "place support 5 5"]
    error: Scalar
    result: Int[Array, ""]


def settle_over(
    rotor: Any,
    loads: Any,
    top_speed: Any,
    *,
    places: Any = 13,
    throw: bool = True,
) -> SettledOver:
    """Equilibrium from rest to a top speed, for supports that follow the speed.

    The rotor is settled at Chebyshev's points between, and the stiffness of every
    support there made a polynomial of the speed: linear analyses then cost no more than
    on springs. `error` is the size of the last two coefficients; where it is not small
    more places help, unless rolling elements lose contact with the speed, which makes
    a kink. If no support follows the speed, `settle` tells the same.

    Args:
        rotor, loads: As of `settle`.
        top_speed: Highest speed, above 0 [rad/s].
        places: Number of points, 3 or more. Static.
        throw: Raise if one is not settled. Static.

    Returns:
        SettledOver, with first derivatives with respect to all numbers.

    Fails, raises: as `settle`.
    """
    loads = _checked("settle_over", rotor, loads)
    top_speed, places = as_real(top_speed), as_count(places)
    positive("settle_over", "top_speed", top_speed, "rad/s")
    whole("settle_over", "places", places)
    check("settle_over", "places", places >= 3, "at least 3", places, "")
    share = 0.5 * (1.0 - np.cos(np.pi * (np.arange(places) + 0.5) / places))
    speeds = top_speed * jnp.asarray(share, top_speed.dtype)
    every = _settled_at(rotor, loads, speeds)
    found = _settled_over(rotor, top_speed, speeds, every)

    def message():
        label = Result(int(found.result)).label
        return f"settle_over: {label} at one of the speeds; `settle` there says more."

    return raise_unless_converged(found, found.result, message) if throw else found


def _settled_at(rotor, loads, speeds) -> Settled:
    """The rotor settled at every speed, without `rotor`; with `place` as first axis."""

    def one(speed):
        found = _settle(rotor, loads, speed)[0]
        return eqx.tree_at(lambda f: f.rotor, found, None)

    if any(is_traced(leaf) for leaf in jax.tree.leaves((rotor, loads, speeds))):
        return lax.map(one, speeds)
    # One after the other by the program of `settle`, which is often there already.
    return jax.tree.map(lambda *leaf: jnp.stack(leaf), *map(one, speeds))


@eqx.filter_jit
def _settled_over(rotor, top_speed, speeds, found) -> SettledOver:
    series = jnp.asarray(chebyshev_analysis(speeds.shape[0]), top_speed.dtype)
    stiffness = jnp.tensordot(series, found.stiffness, 1)
    springs = [
        SpeedSupport(s.station, stiffness[:, k], d, top_speed, housing=s.housing)
        for k, (s, d) in enumerate(zip(rotor.supports, found.damping[0], strict=True))
    ]
    return SettledOver(
        rotor=eqx.tree_at(lambda r: r.supports, rotor, tuple(springs)),
        speed=speeds,
        displacement=found.displacement,
        support_load=found.support_load,
        stiffness=found.stiffness,
        error=jnp.max(jnp.abs(stiffness[-2:])) / jnp.max(jnp.abs(stiffness)),
        result=worst(found.result),
    )


def _checked(owner, rotor, loads) -> RotorLoads:
    loads = RotorLoads() if loads is None else loads
    for name, value, kind in (("rotor", rotor, Rotor), ("loads", loads, RotorLoads)):
        if not isinstance(value, kind):
            raise TypeError(
                f"{owner}: `{name}` is a {type(value).__name__}; it must be a"
                f" {kind.__name__}."
            )
    if not rotor.supports:
        raise ValueError(f"{owner}: `rotor` has no supports; nothing holds it.")
    loads.check(rotor)
    return loads


_Supported = tuple[
    Float[Array, "support 5"],
    Float[Array, "support 5 5"],
    Float[Array, "support 5 5"],
]
"""Force, stiffness and damping of every support."""


class _Condensed(eqx.Module):
    """A linear rotor as seen from the motions of its supported stations.

    Attributes:
        stiffness, force: On them, per unit of `scale` (m, m), (m,) [N].
        rows: Motion of every support (support, 5, m) [1, 1/m].
        back, there: All motions (motion, m) and what the forces between supports add
            (motion,) [m, rad].
        supports, speed: As of the rotor.
    """

    stiffness: Float[Array, "m m"]
    force: Float[Array, " m"]
    rows: Float[Array, "support 5 m"]
    back: Float[Array, "motion m"]
    there: Float[Array, " motion"]
    supports: tuple[AbstractSupport, ...]
    speed: Scalar

    def motion(self, y):
        """All motions [m, rad]."""
        return self.back @ y + self.there

    def of_supports(self, y) -> _Supported:
        """Force, stiffness and damping of every support."""
        return of_each(
            lambda support, moved: support.pushed(moved, self.speed),
            self.supports,
            self.rows @ y,
        )

    def nothing(self) -> _Supported:
        """Of the shapes of `of_supports`."""
        n, none = len(self.supports), jnp.zeros_like(self.force[0])
        matrices = jnp.tile(none, (n, N_STATION, N_STATION))
        return matrices[:, 0], matrices, matrices

    def out_of_balance(self, y, force):
        """Force that springs and supports take up less that which acts (m,) [N]."""
        along = jnp.einsum("sim,si->m", self.rows, force)
        return along + self.stiffness @ y - self.force

    def slope(self, stiffness):
        """Stiffness against all motions, from that of the supports (m, m) [N/m]."""
        rows = self.rows
        return jnp.einsum("sim,sij,sjn->mn", rows, stiffness, rows) + self.stiffness


def _condensed(rotor: Rotor, loads: RotorLoads, speed: Scalar) -> _Condensed:
    """Shifts of supported stations in m, tilts in m at the end of half the shaft."""
    own, force = rotor.unsupported().stiffness, loads.constant(rotor)
    rows, every = rotor.at_supports(), rotor.motions()
    n, shaft = own.shape[0], rotor.shaft
    arm = 0.5 * (shaft.stations[-1] - shaft.stations[0])
    body = jnp.stack([arm / arm] * N_HOUSING + [1.0 / arm] * (N_STATION - N_HOUSING))
    n_housings = (n - N_STATION * shaft.n_nodes) // N_HOUSING
    ends = jnp.ones(N_HOUSING * n_housings, body.dtype)
    if rotor.rigid:
        # The tilts of a rigid shaft count about its own station of z = 0.
        back = every * jnp.concatenate([body, ends])[None, :]
        there = jnp.zeros_like(force)
    else:
        scale = jnp.concatenate([jnp.tile(body, shaft.n_nodes), ends])
        kept, rest = held_motions(rotor)
        back = jnp.eye(n, dtype=own.dtype)[:, kept] * scale[None, kept]
        there = jnp.zeros_like(force)
        if len(rest):
            inner = own[np.ix_(rest, rest)]
            across = own[np.ix_(rest, kept)] * scale[None, kept]
            known = jnp.concatenate([-across, force[rest, None]], axis=1)
            follow = jnp.linalg.solve(inner, known)
            back = back.at[rest].set(follow[:, :-1])
            there = there.at[rest].set(follow[:, -1])
    stiffness = back.T @ own @ back
    return _Condensed(
        stiffness=0.5 * (stiffness + stiffness.T),
        force=back.T @ force,
        rows=rows @ back,
        back=back,
        there=there,
        supports=rotor.supports,
        speed=speed,
    )


def _searched(parts: _Condensed, length) -> Minimum:
    """Where the supports carry the load, and they themselves. Without derivatives."""
    load = parts.force
    size = jnp.linalg.norm(load)

    def function(y, _, __):
        supported = parts.of_supports(y)
        slope = parts.slope(supported[1])
        left = parts.out_of_balance(y, supported[0])
        # The forces of the supports cancel, where they preload each other.
        along = jnp.einsum("sim,si->sm", parts.rows, supported[0])
        cancels = jnp.sum(jnp.linalg.norm(along, axis=1))
        softness = jnp.trace(slope) * jnp.linalg.norm(y)
        return Evaluation(
            value=jnp.full_like(cancels, jnp.nan),
            gradient=left + load,
            hessian=slope,
            scale=cancels,
            noise=jnp.finfo(y.dtype).eps * (cancels + softness),
            memory=supported,
        )

    return _SOLVER.minimise(
        function,
        jnp.zeros_like(load),
        jnp.asarray(_FIRST_STEP, load.dtype),
        memory=parts.nothing(),
        direction=load / jnp.where(size > 0, size, 1.0),
        limit=length,
        force=load,
    )


def _balance(y, parts):
    return parts.out_of_balance(y, parts.of_supports(y)[0])


def _undone(of_y, y, change, parts):
    return -solve(parts.slope(parts.of_supports(y)[1]), change, False)


def _place(rotor, loads, speed):
    """Condensed rotor, what the search found, and its unknowns with derivatives."""
    parts = _condensed(rotor, loads, speed)
    length = rotor.shaft.stations[-1] - rotor.shaft.stations[0]
    found = _searched(stop(parts), stop(length))
    y = attach_by(_balance, found.x, parts, _undone)
    solved = found.result == Result.CONVERGED
    y = unless_failed(jnp.where(solved, y, jnp.nan), solved)
    return parts, found, y


@eqx.filter_jit
def _settle(rotor, loads, speed) -> tuple[Settled, Float[Array, " motion"]]:
    """The result, and where the search ended even if it is none (motion,)."""
    parts, found, y = _place(rotor, loads, speed)
    motion = parts.motion(y)
    known = jax.tree.map(
        lambda leaf: jnp.where(found.result == Result.CONVERGED, leaf, jnp.nan),
        found.memory,
    )
    load, stiffness, damping = recall(
        lambda parts, y: parts.of_supports(y), known, (parts, y)
    )
    springs = [
        LinearSupport(support.station, k, c, housing=support.housing)
        for support, k, c in zip(rotor.supports, stiffness, damping, strict=True)
    ]
    n = N_STATION * rotor.shaft.n_nodes
    settled = Settled(
        displacement=motion[:n].reshape(-1, N_STATION),
        housing=motion[n:].reshape(-1, N_HOUSING),
        support_load=load,
        stiffness=stiffness,
        damping=damping,
        rotor=eqx.tree_at(lambda r: r.supports, rotor, tuple(springs)),
        motion=motion,
        speed=speed,
        residual=found.residual,
        steps=found.steps,
        result=found.result,
        free=_free(stop(parts), stop(parts.slope(stiffness))),
    )
    return settled, stop(parts).motion(found.x)


def _free(parts, slope):
    """The softest motion, if it is free."""
    known = jnp.where(jnp.isfinite(slope), slope, 0.0)
    values, vectors = jnp.linalg.eigh(0.5 * (known + known.T))
    moved = parts.back @ vectors[:, 0]
    loose = values[0] <= _FREE * jnp.max(jnp.diagonal(known))
    return jnp.where(loose, moved, 0.0)


def _named(rotor, motion) -> str:
    """The freedom of a station or housing that a motion moves most."""
    n = N_STATION * rotor.shaft.n_nodes
    length = float(rotor.shaft.stations[-1] - rotor.shaft.stations[0])
    nodes = np.abs(motion[:n].reshape(-1, N_STATION)) * ([1.0] * 3 + [length] * 2)
    stations = [rotor.shaft.node(k) for k in range(rotor.shaft.n_segments + 1)]
    nodes = nodes[stations]
    station, freedom = np.unravel_index(int(np.argmax(nodes)), nodes.shape)
    if n < len(motion) and np.abs(motion[n:]).max() > nodes.max():
        return (
            f"{STATION_FREEDOMS[int(np.argmax(np.abs(motion[n:]))) % 3]} of a housing"
        )
    return f"{STATION_FREEDOMS[freedom]} of station {station}"


def _message(rotor, found, place) -> str:
    result = Result(int(found.result))
    start = f"settle: {result.label} at {float(found.speed):g} rad/s:"
    if result is Result.NO_LOAD_PATH and not is_traced(place):
        return (
            f"{start} nothing takes up the load along"
            f" {_named(rotor, np.asarray(place))}; give the rotor a"
            " support that holds it."
        )
    if result is Result.NON_FINITE:
        return f"{start} a force of a support is no number."
    return (
        f"{start} {float(found.residual):.3g} of the load is left after"
        f" {int(found.steps)} steps."
    )


def _warn(rotor, found):
    loads = np.asarray(found.support_load)
    idle = [
        str(support.station)
        for support, load in zip(rotor.supports, loads, strict=True)
        if not load.any() and not isinstance(support, LinearSupport)
    ]
    if idle:
        warnings.warn(
            f"settle: the bearing on station {', '.join(idle)} bears nothing: it has"
            " no stiffness here; give it a preload or a load",
            stacklevel=3,
        )
    free = np.asarray(found.free)
    springs = all(isinstance(support, LinearSupport) for support in rotor.supports)
    if free.any() and not springs:
        warnings.warn(
            f"settle: nothing holds {_named(rotor, free)}: it stays where it is, and"
            " a mode of frequency zero goes with it",
            stacklevel=3,
        )

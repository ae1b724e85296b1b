"""Static equilibrium of a rotor in its bearings under weight, forces and preload.

Of the motions of the supported stations, on which the linear shaft is condensed, the
balance is solved by the trust-region Newton method that solves single bearings too,
judged by forces, because supports need not have a potential.
"""

import dataclasses
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design.checks import are_known, number, of_class
from ..element.frame import LOAD_UNITS
from ..numerics.compiled.programs import program
from ..numerics.implicit import attach_by, recall, stop_gradient, unless_failed
from ..numerics.labels import to_xarray
from ..numerics.lapack import eigh
from ..numerics.linear import solve
from ..numerics.minimise import (
    Evaluation,
    Minimum,
    Problem,
    TrustRegionNewton,
)
from ..numerics.result import Result, raise_unless_converged
from ..numerics.shown import Printable
from ..numerics.types import Scalar, as_real, with_fields
from ..numerics.units import unit, units
from ..numerics.warning import Warning
from .bearing_support import BearingSupport
from .condensation import CondensedRotor, Supported, condense
from .loads import Motions, RotorLoads
from .parts import (
    DAMPING_UNITS,
    STIFFNESS_UNITS,
    AbstractSupport,
    LinearSupport,
    Responded,
)
from .rotor import N_HOUSING, N_STATION, Rotor
from .shaft import STATION_UNITS
from .statics_words import describe_failure, equilibrium_warnings

_FIRST_STEP = 1e-5
"""First bound of the steps [m]."""
_NOTHING = 1e-9
"""Force that counts as none where no load acts [N]."""
_FREE = 1e-9
"""Stiffness over the largest below which a motion counts as free [1]."""
_SOLVER = TrustRegionNewton(
    tolerance=1e-11, max_steps=200, symmetric=False, softest=0.03
)
"""Solver of the balance, the same whether supports are parts of its program or not."""


class StaticEquilibrium(Printable):
    """Static equilibrium of a rotor in its supports, at one speed.

    Attributes:
        displacement: (ux uy uz gx gy) of every node (node, 5) [m, rad].
        housing: (ux uy uz) of every housing (housing, 3) [m].
        support_load: Load of the shaft on every support (support, 5) [N, N m].
        stiffness: Stiffness of every support there (support, 5, 5) [N/m, N, N m].
        damping: Damping of each support (support, 5, 5) [N s/m, N s, N m s].
        rotor: The rotor on springs and dampers of that stiffness and damping, for all
            linear analyses about this place.
        motion: Displacements of all nodes and housings (motion,) [m, rad].
        speed: Speed of the evaluation of supports [rad/s].
        residual: Force that is left over that which acts [1].
        steps: Steps of the search.
        result: `Result` code; the numbers are NaN unless it is `CONVERGED`.
        free: Motion that nothing holds (motion,), zeros if everything is held [1].
        given: The rotor as it was given, on its own supports.
        place: Where the search ended (motion,) [m, rad], even if it failed.
    """

    displacement: Float[Array, "node station_freedom=5"] = eqx.field(
        metadata=unit(STATION_UNITS)
    )
    housing: Float[Array, "housing direction=3"] = eqx.field(metadata=unit("m"))
    support_load: Float[Array, "support station_component=5"] = eqx.field(
        metadata=unit(LOAD_UNITS[:5])
    )
    stiffness: Float[Array, "support station_freedom=5 moved_station_freedom=5"] = (
        eqx.field(metadata=unit(STIFFNESS_UNITS))
    )
    damping: Float[Array, "support station_freedom=5 moved_station_freedom=5"] = (
        eqx.field(metadata=unit(DAMPING_UNITS))
    )
    rotor: Rotor = eqx.field(repr=False)
    motion: Float[Array, " motion"] = eqx.field(metadata=units("m", "rad"))
    speed: Scalar = eqx.field(metadata=unit("rad/s"))
    residual: Scalar = eqx.field(metadata=unit("1"))
    steps: Int[Array, ""]
    result: Int[Array, ""]
    free: Float[Array, " motion"] = eqx.field(metadata=unit("1"))
    given: Rotor | None = eqx.field(repr=False, default=None)
    place: Float[Array, " motion"] | None = eqx.field(
        metadata=units("m", "rad"), default=None
    )

    to_xarray = to_xarray

    @property
    def failure_message(self) -> str:
        """Why there is no equilibrium, in words; empty if there is one."""
        return describe_failure(self)

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings of bearings without load or that lost their preload, and of a motion
        that nothing holds; empty without equilibrium, and where numbers are traced."""
        return equilibrium_warnings(self)


def static_equilibrium(
    rotor: Any,
    loads: Any = None,
    speed: Any = 0.0,
    *,
    throw: bool = True,
) -> StaticEquilibrium:
    """Find the equilibrium under weight, constant forces and bearing preload.

    Args:
        rotor: `Rotor`: shaft, discs, supports; one support at least.
        loads: `RotorLoads`; the constant ones count; `None`: nothing but preload.
        speed: Speed of the rotor, for supports that follow it [rad/s].
        throw: Raise if there is none. Static.

    Returns:
        StaticEquilibrium, with first derivatives with respect to all numbers of rotor,
        loads and speed. Its `warnings` say if a bearing bears nothing or loses its
        preload because the shaft gives way, or nothing holds the rotor along some
        motion (which then stays what it is).

    Fails: `STEP_LIMIT`, `NO_LOAD_PATH`, `NON_FINITE`.

    Raises:
        SolveError: If it was not found and `throw`; it says where the rotor went.
        TypeError: If `rotor` or `loads` is something else.
        ValueError: If the rotor has no support, or lacks a loaded station.
    """
    loads = checked_loads("static_equilibrium", rotor, loads)
    speed = as_real(speed)
    number("static_equilibrium", "speed", speed, "rad/s")
    found, place = equilibrium_at(rotor, loads, speed)
    found = dataclasses.replace(found, given=rotor, place=place)
    if not throw:
        return found
    return raise_unless_converged(
        found, found.result, lambda: found.failure_message, "static_equilibrium"
    )


def checked_loads(owner: str, rotor: Any, loads: Any) -> RotorLoads:
    """Return the loads after a check of loads and rotor.

    Args:
        owner: Function that was called.
        rotor, loads: As in `static_equilibrium`.

    Raises:
        TypeError, ValueError: As `static_equilibrium`.
    """
    loads = RotorLoads() if loads is None else loads
    for name, value, kind in (("rotor", rotor, Rotor), ("loads", loads, RotorLoads)):
        of_class(owner, name, value, kind, f"a {kind.__name__}")
    if not rotor.supports:
        raise ValueError(f"{owner}: `rotor` has no supports; nothing holds it.")
    loads.check(rotor)
    return loads


def search_equilibrium(parts: CondensedRotor, length: Scalar | float) -> Minimum:
    """Search the equilibrium, without derivatives; its memory are the supports.

    Args:
        parts: Condensed rotor, or several.
        length: Limit of the displacements [m].
    """

    def function(y, _, __):
        return _evaluation(parts, y, parts.of_supports(y))

    return _SOLVER.loop().run(_search_problem(parts, length, function))


def _search_problem(
    parts: CondensedRotor, length: Scalar | float, function: Callable | None = None
) -> Problem:
    """Return the problem that `_SOLVER` solves in the search of an equilibrium.

    Args:
        parts: Condensed rotor, or several.
        length: Limit of the displacements [m].
        function: From the motions to an `Evaluation`; `None`: it is not called.
    """
    load = parts.force
    size = jnp.linalg.norm(load)
    return Problem(
        function or _unknown,
        jnp.zeros_like(load),
        jnp.asarray(_FIRST_STEP, load.dtype),
        memory=parts.zeros(),
        direction=load / jnp.where(size > 0, size, 1.0),
        limit=jnp.asarray(length),
        force=load,
    )


def _unknown(*_) -> Evaluation:
    raise AssertionError("supports are evaluated between the steps")


def _evaluation(parts: CondensedRotor, y: Array, supported: Supported) -> Evaluation:
    """Return the function of the search at motions at which supports are known."""
    load = parts.force
    # Without load what is left is round-off of the forces inside the bearings.
    idle = jnp.where(jnp.linalg.norm(load) > 0, 0.0, _NOTHING).astype(load.dtype)
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
        noise=jnp.finfo(y.dtype).eps * (cancels + softness) + idle,
        memory=supported,
    )


def search_by_parts(
    parts: CondensedRotor,
    length: Scalar,
    supports: Sequence[Callable[[np.ndarray], Responded]],
) -> Minimum:
    """Search as `search_equilibrium`, with a call of a program for each support.

    The program of a bearing is by far the largest. Called alone it is that of a kind of
    bearing, which all machines share; what is left to those of a machine is small.

    Args:
        parts: Condensed rotor, or several; its own supports are not looked at.
        length: Limit of the displacements [m].
        supports: Force, stiffness and damping of each support at its motion (5,).
    """
    parts = with_fields(parts, supports=())
    state = _begin(parts, length)
    moved: Any = np.zeros((len(supports), N_STATION), parts.force.dtype)
    found, ended = None, False
    while not ended:
        pairs = zip(supports, np.asarray(moved), strict=True)
        known = zip(*(respond(at) for respond, at in pairs), strict=True)
        supported = tuple(np.stack(one) for one in known)
        state, moved, found, ended = _advance(parts, length, state, supported)
    assert found is not None  # the first step does not end it
    return found


@program(quick=True)
def _begin(parts, length):
    return _SOLVER.init(_search_problem(parts, length))


@program(quick=True)
def _advance(parts, length, state, supported):
    """Return the state after a step, where it asks for supports, the end if it is."""
    problem = _search_problem(parts, length)
    step = _SOLVER.propose(problem, state)
    there = _evaluation(parts, state.x + step, supported)
    either = _SOLVER.judge(problem, state, step, there)
    state = jax.tree.map(partial(jnp.where, either.flag), either.yes, either.no)
    following = state.x + _SOLVER.propose(problem, state)
    found, ended = _SOLVER.finish(problem, state), _SOLVER.terminate(problem, state)
    return state, parts.rows @ following, found, ended


def _balance(y, parts):
    return parts.out_of_balance(y, parts.of_supports(y)[0])


def _correction(of_y, y, change, parts):
    return -solve(parts.slope(parts.of_supports(y)[1]), change, False)


def at_equilibrium(found: Minimum, parts: CondensedRotor) -> tuple[Array, *Supported]:
    """Return the condensed motions, and force, stiffness, damping of the supports.

    They are differentiable with respect to `parts`, and NaN if the search failed.

    Args:
        found: From `search_equilibrium`.
        parts: Condensed rotor, or several.
    """
    y = attach_by(_balance, found.x, parts, _correction)
    _, *known = known_at(found)
    states = recall(lambda parts, y: parts.of_supports(y), tuple(known), (parts, y))
    solved = found.result == Result.CONVERGED
    return jnp.where(solved, y, jnp.nan), *states


def known_at(found: Minimum) -> tuple[Array, *Supported]:
    """Return what `at_equilibrium` does, without derivatives.

    Args:
        found: From a search.
    """
    solved = found.result == Result.CONVERGED
    known = found.x, *found.memory
    return jax.tree.map(lambda leaf: jnp.where(solved, leaf, jnp.nan), known)


def equilibrium_at(
    rotor: Rotor, loads: RotorLoads, speed: Any
) -> tuple[StaticEquilibrium, Float[Array, " motion"]]:
    """Return the result, and the end point of the search even if it failed (motion,).

    A rotor of known numbers is solved with a call of a program for each support; one
    that is traced is one program, which has derivatives.

    Args:
        rotor, loads, speed: As in `static_equilibrium`, checked.
    """
    if not are_known(rotor, loads, speed):
        return _equilibrium_in_one(rotor, loads, speed)
    bare = with_fields(rotor, supports=tuple(map(_without_spring, rotor.supports)))
    parts, length = _assemble(bare, loads, speed)
    respond = []
    for support in rotor.supports:
        resting = isinstance(support, BearingSupport) and not support.inertia
        at = None if resting else speed
        respond.append(partial(support.without_place().respond_alone, speed=at))
    return _describe(bare, parts, search_by_parts(parts, length, respond), speed)


def _without_spring(support: AbstractSupport) -> LinearSupport:
    """Return a support that holds the place of another one."""
    zero = as_real(np.zeros((N_STATION, N_STATION)))
    return LinearSupport(support.station, zero, zero, housing=support.housing)


@program(quick=True)
def _assemble(rotor, loads, speed):
    length = rotor.shaft.stations[-1] - rotor.shaft.stations[0]
    return condense(rotor, loads.constant(rotor), speed), length


@program(quick=True)
def _describe(rotor, parts, found, speed):
    known = known_at(found)
    return _state_at(found, known, rotor, parts, speed), parts.motion(found.x)


@program(quick=True)
def _equilibrium_in_one(rotor, loads, speed):
    parts = condense(rotor, loads.constant(rotor), speed)
    length = rotor.shaft.stations[-1] - rotor.shaft.stations[0]
    found = search_equilibrium(stop_gradient(parts), stop_gradient(length))
    solved = found.result == Result.CONVERGED

    def recompute(rotor, parts, speed):
        at = at_equilibrium(found, parts)
        return _state_at(found, at, rotor, parts, speed)

    equilibrium = unless_failed(recompute, (rotor, parts, speed), solved)
    return equilibrium, stop_gradient(parts).motion(found.x)


def _state_at(found, at, rotor, parts, speed) -> StaticEquilibrium:
    """Return the result of a search, from `at_equilibrium`."""
    y, load, stiffness, damping = at
    motion = parts.motion(y)
    springs = [
        LinearSupport(support.station, k, c, housing=support.housing)
        for support, k, c in zip(rotor.supports, stiffness, damping, strict=True)
    ]
    n = N_STATION * rotor.shaft.n_nodes
    return StaticEquilibrium(
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
        free=softest(stop_gradient(parts), stop_gradient(parts.slope(stiffness))),
    )


def softest(parts: CondensedRotor, slope: Array) -> Motions:
    """Return the softest of all motions if it is free, else zeros.

    Args:
        parts: Condensed rotor, or several.
        slope: Its total stiffness (m, m) [N/m].
    """
    known = jnp.where(jnp.isfinite(slope), slope, 0.0)
    values, vectors = eigh(known)
    moved = parts.back @ vectors[:, 0]
    loose = values[0] <= _FREE * jnp.max(jnp.diagonal(known))
    return jnp.where(loose, moved, 0.0)

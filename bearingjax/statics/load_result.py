"""Result of a load solve: the fields of a `Solution` and its result code."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..design import Material
from ..design.bearing_set import pitch_radius
from ..design.checks import is_traced
from ..element import FREEDOMS, BearingElement, BearingModel, Speed
from ..numerics import Minimum, Result
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient
from ..numerics.types import Ring, as_array
from .balance import Balance
from .empty_places import of_kind, points_of_kind, without_empty_places
from .load_case import LoadCase
from .load_search import SearchStart, differentiable_unknowns
from .options import SolveOptions
from .solution import Solution, Stats, describe, solution_kind
from .warning_sizes import stiffness_scale


class LoadOutcome(NamedTuple):
    """Outcome of a load solve.

    Attributes:
        result: `Result` code.
        unrestrained: As in `Solution`.
    """

    result: Int[Array, ""]
    unrestrained: Int[Array, ""]


def solution_of(
    element: BearingElement,
    model: BearingModel,
    balance: Balance,
    case: LoadCase,
    options: SolveOptions,
    begin: SearchStart,
    minimum: Minimum,
) -> Solution:
    """Solution at the end `minimum` of the search that was begun at `begin`."""
    y = differentiable_unknowns(model, balance, minimum)
    q = balance.ring_freedoms(y)
    # gz may be prescribed: the results follow it through the azimuths.
    solved = model.follow_azimuths(q, minimum.memory.solved)
    fields, evaluated = describe(element, model, q, options.points, solved)
    left = stop_gradient(balance.out_of_balance(fields["force"]))
    reference = jnp.where(begin.size > 0, begin.size, evaluated.magnitude)
    tiny = jnp.finfo(left.dtype).tiny
    residual = jnp.sqrt(left @ left) / jnp.maximum(reference, tiny)
    # What presses contacts by the size of the bearing: numbers of another scale.
    most = stop_gradient(stiffness_scale(element.bearing) * balance.radius)
    strong = (begin.size > most) | (begin.inertia > most)
    far = begin.y[:5] @ begin.y[:5] >= (8.0 * balance.radius) ** 2
    ending = _outcome(
        balance,
        minimum,
        evaluated.result,
        _loaded_unheld(case),
        strong | far,
        fields["force"],
    )
    return solution_kind(element.choices)(
        **fields,
        element=element,
        speed=case.speed,
        free=case.free,
        held=case.held,
        moving_ring=case.moving_ring,
        pitch_radius=balance.radius,
        result=ending.result,
        unrestrained=ending.unrestrained,
        stats=Stats(residual, minimum.steps, evaluated.residual, evaluated.steps),
    )


def solution_at(
    element: BearingElement,
    q: Ring,
    speed: Speed | None,
    points: int,
    inertia: bool = True,
    no_load: float = 0.0,
    fixed_stiffness: bool = False,
) -> Solution:
    """Solution of a bearing whose rings are held where they are given.

    With known numbers, of a bearing with empty places or none, the program is that of
    all bearings of a kind.

    Args:
        element: The bearing.
        q: Ring freedoms [m, rad].
        speed: Ring speeds, or `None`.
        points: Positions along the rollers at which loads are reported. Static.
        inertia: Whether rolling elements feel the speed; if not, balls orbit and spin
            as at the speed, without centrifugal force and gyroscopic moment. Static.
        no_load: Load over E* D that counts as none for idle rolling elements [m].
        fixed_stiffness: As in `BearingModel.evaluate`. Static.
    """
    small = as_array(no_load, q.dtype)
    if any(map(is_traced, jax.tree.leaves((element, q, speed)))):
        given = element, q, speed, points, inertia, small
        return _solution_at(*given, fixed_stiffness)
    points = points_of_kind(element, points)
    found = _solution_at(of_kind(element), q, speed, points, inertia, small)
    return without_empty_places(found, element)


@program(quick=True, what="a bearing in its place")
def _solution_at(
    element, q, speed, points, inertia, no_load, fixed_stiffness=False
) -> Solution:
    least = no_load * stiffness_scale(element.bearing)
    model = element.model(speed if inertia else None)
    rolling = None
    if speed is not None and not inertia:
        rolling = without_mass(element).model(speed)
    solved = model.solve(q)
    given = element, model, q, points, solved, rolling, least
    fields, found = describe(*given, fixed_stiffness)
    nothing = jnp.zeros_like(q[0])
    return solution_kind(element.choices)(
        **fields,
        element=element,
        speed=speed,
        free=(),
        held=FREEDOMS[:5],
        moving_ring="inner",
        pitch_radius=pitch_radius(element.bearing),
        result=found.result,
        unrestrained=jnp.full_like(found.result, -1),
        stats=Stats(nothing, jnp.zeros_like(found.result), found.residual, found.steps),
    )


def without_mass(element: BearingElement) -> BearingElement:
    """Return the bearing of materials without density."""

    def light(part):
        if not isinstance(part, Material):
            return part
        return eqx.tree_at(lambda m: m.density, part, 0.0 * part.density)

    return jax.tree.map(light, element, is_leaf=lambda part: isinstance(part, Material))


def _loaded_unheld(case: LoadCase) -> Bool[Array, "6"]:
    """Loads on freedoms that are held, or that this type of bearing cannot restrain."""
    return (case.loose == 0) & ~(case.load == 0)


def _outcome(
    balance: Balance,
    minimum: Minimum,
    of_elements: Int[Array, ""],
    loaded: Bool[Array, "6"],
    absurd: Bool[Array, ""],
    force: Ring,
) -> LoadOutcome:
    """Most severe result code of a solve, and the freedom that it concerns.

    Args:
        balance: The load and what holds the rings.
        minimum: End of the search.
        of_elements: Worst result code of the rolling elements.
        loaded: Freedoms whose load no contact takes.
        absurd: Whether numbers are of another scale than the bearing.
        force: Force of the solution [N, N m].
    """
    result = jnp.maximum(minimum.result, of_elements)
    result = jnp.where(
        jnp.any(loaded) & (result != Result.NON_FINITE),
        int(Result.NO_LOAD_PATH),
        result,
    )
    result = jnp.where(
        absurd & (result != Result.CONVERGED), int(Result.NON_FINITE), result
    )
    inputs = jnp.concatenate([balance.load, balance.given, balance.fixed])
    bad = ~jnp.all(jnp.isfinite(inputs)) | ~jnp.all(jnp.isfinite(force))
    result = jnp.where(bad, int(Result.NON_FINITE), result).astype(jnp.int32)
    runaway = _runaway(minimum.x, balance.free)
    freedom = jnp.where(jnp.any(loaded), jnp.argmax(loaded), runaway)
    of_ring = jnp.any(loaded) | (minimum.result == Result.NO_LOAD_PATH)
    named = of_ring & (result == Result.NO_LOAD_PATH)
    return LoadOutcome(result, jnp.where(named, freedom, -1).astype(jnp.int32))


def _runaway(y: Float[Array, "6"], free: Float[Array, "6"]) -> Int[Array, ""]:
    """Freedom that diverges: the axial one if it takes part, else the largest."""
    size = jnp.abs(y) * free
    return jnp.where(size[2] > 0.1 * jnp.max(size), 2, jnp.argmax(size))

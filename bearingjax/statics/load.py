"""Where the rings go under load.

Minimises V(q) - load·q over the free freedoms of the moving ring. With linearised
kinematics this is convex, so the trust-region Newton method on the exact V, V′, V″
converges from anywhere, or runs away where nothing holds the load, and says so.
"""

from collections.abc import Mapping, Sequence

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design import (
    AbstractBallBearing,
    is_ball,
    pitch_radius,
    rows_of,
)
from ..design.checks import in_range, real_numbers
from ..element.bearing_element import BearingElement, check_element
from ..element.bearing_model import BearingModel
from ..element.frame import FREEDOMS, LOADS, RINGS
from ..element.inertia import Speed
from ..numerics.implicit import attach, stop, unless_failed
from ..numerics.minimise import Evaluation, Problem, TrustRegionNewton, continuation
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar, as_array
from .solution import BallSolution, RollerSolution, Solution, Stats, describe, message
from .support import check_held, restrained_freedoms
from .warning_sizes import stiffness_scale

Vector = Float[Array | np.ndarray, "6"] | Sequence[float | int]
"""Six numbers."""

DEFAULT_TOLERANCE = {"float64": 1e-11, "float32": 1e-4}


def solve_load(
    element: BearingElement,
    load: Vector | None = None,
    *,
    prescribed: Mapping[str, float | int | Array | np.ndarray] | None = None,
    free: Sequence[str] | None = None,
    fixed_ring: str = "outer",
    fixed_displacement: Vector | None = None,
    speed: Speed | None = None,
    points: int = 101,
    tolerance: float | Scalar | None = None,
    max_steps: int | Int[Array, ""] = 200,
    start: Vector | None = None,
    throw: bool = True,
) -> Solution:
    """Equilibrium of a bearing under any mix of loads and displacements.

    Args:
        element: The bearing.
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring at the origin [N, N m];
            `None` is no load. A load on a freedom that is held, prescribed or left out
            of `free`, is an error: the support would take it, unseen by the bearing.
        prescribed: Displacements given instead of loads, by freedom name [m, rad];
            their loads are results; gz turns the set of rollers.
        free: Freedoms of the moving ring that may move. Default: all that the
            bearing can restrain and that are not prescribed; a load on any other is
            then "no load path". The others are held at zero; what holds them there
            is a result.
        fixed_ring: "outer" or "inner".
        fixed_displacement: Displacement of the fixed ring (6,) [m, rad]; default 0.
        speed: Ring speeds; `None`: no inertia.
        points: Positions along the rollers at which loads are reported.
        tolerance: Relative residual at which the solve ends; default 1e-11 in
            float64, 1e-4 in float32.
        max_steps: Step limit of the load solve.
        start: Displacement of the moving ring (6,) from which the solve starts, such
            as that under a load near by; NaN, farther than the pitch radius, or
            `None`: from first contact [m, rad].
        throw: Raise if the solve fails, outside or under `jit`; otherwise read
            `solution.result`.

    Returns:
        Solution, differentiable with respect to design, load, prescribed values and
        speeds (implicit function theorem).

    Raises:
        TypeError: For a bearing in place of an element, or text in place of numbers.
        ValueError: For unknown names, contradictory choices or non-finite input.
        SolveError: If the solve did not converge and `throw` is set.

    Fails: `STEP_LIMIT`, `NO_LOAD_PATH` (freedom in `solution.unrestrained`; so too a
        traced load on a held freedom), `NON_FINITE`, `SADDLE` (finite kinematics).
    """
    if fixed_ring not in RINGS:
        raise ValueError(
            f"solve_load: `fixed_ring` is {fixed_ring!r}; it must be 'outer' or"
            " 'inner'."
        )
    check_element("solve_load", element)
    dtype = pitch_radius(element.bearing).dtype
    load = _six("load", load, dtype)
    fixed = _six("fixed_displacement", fixed_displacement, dtype)
    prescribed = _named(prescribed)
    _check_names("prescribed", prescribed)
    given = _six("prescribed", [prescribed.get(f, 0.0) for f in FREEDOMS], dtype)
    default_free = free is None
    if isinstance(free, str):
        raise TypeError(f"solve_load: `free` is {free!r}; it must be a list of names.")
    if free is None:
        free = [f for f in restrained_freedoms(element.bearing) if f not in prescribed]
    _check_names("free", free)
    both = sorted(set(free) & set(prescribed))
    if both:
        raise ValueError(
            f"solve_load: {', '.join(both)} is both free and prescribed; choose one."
        )
    if "gz" in free:
        raise ValueError(
            "solve_load: `free` contains gz, which no rolling bearing restrains; it"
            " is operating data (prescribe it to turn the set of rollers)."
        )
    check_held("solve_load", load, prescribed, None if default_free else free)
    for k, row in enumerate(rows_of(element.bearing)):
        if row.spring is not None and "uz" not in restrained_freedoms(row.bearing):
            raise ValueError(
                f"solve_load: row {k} has a spring, but holds no axial load."
            )
    is_free = tuple(name in free for name in FREEDOMS)
    left_out = () if default_free else set(FREEDOMS[:5]) - set(free)
    held = tuple(name in prescribed or name in left_out for name in FREEDOMS)
    if tolerance is None:
        tolerance = DEFAULT_TOLERANCE[str(dtype)]
    in_range("solve_load", "tolerance", 0.0, 1.0, tolerance, "")
    # As arrays, so that another value does not compile anew.
    ends, max_steps = as_array(tolerance, dtype), as_array(max_steps, jnp.int32)
    solution = _solve(
        element,
        element.model(speed),
        speed,
        load,
        given,
        fixed,
        is_free,
        held,
        fixed_ring,
        points,
        ends,
        max_steps,
        None if start is None else _six("start", start, dtype),
    )
    if throw:
        moving = RINGS[1 - RINGS.index(fixed_ring)]
        solution = raise_unless_converged(
            solution, solution.result, lambda: message(solution, moving)
        )
    return solution


@eqx.filter_jit
def _solve(
    element,
    model,
    speed,
    load,
    given,
    fixed,
    is_free,
    held,
    fixed_ring,
    points,
    tolerance,
    max_steps,
    start,
):
    radius = pitch_radius(element.bearing)
    one = jnp.ones_like(radius)
    # Metres for every unknown: rotations times the pitch radius.
    scale = jnp.concatenate([jnp.tile(one, 3), jnp.tile(1.0 / radius, 3)])
    free = jnp.asarray(np.array(is_free, dtype=float), dtype=load.dtype)
    moving = slice(6, 12) if fixed_ring == "outer" else slice(0, 6)
    begin = (1.0 - free) * given / scale

    def ring_freedoms(y, scale, fixed):
        mine = scale * y
        pair = [fixed, mine] if fixed_ring == "outer" else [mine, fixed]
        return jnp.concatenate(pair)

    # All that depends on the trace goes through the arguments: a derivative rule must
    # not close over it.
    args = (model, load, given, fixed, scale, free)
    frozen = stop(args)
    symmetric = model.has_potential

    def function(y, _, near):
        model, _, _, fixed, scale, free = frozen
        q = ring_freedoms(y, scale, fixed)
        e = model.evaluate(q, model.solve(q, near))
        g = free * (scale * e.force[moving])
        h = jnp.outer(free * scale, free * scale) * e.stiffness[moving, moving]
        trace = jnp.trace(h)
        h = h + jnp.diag(1.0 - free)
        eps = jnp.finfo(load.dtype).eps
        # Round-off of forces that cancel, and of positions in a stiff bearing.
        noise = eps * (e.magnitude + trace * jnp.sqrt(y @ y))
        value = e.energy if symmetric else jnp.full_like(e.energy, jnp.nan)
        return Evaluation(value, g, h, e.magnitude, noise, e.near)

    pull = free * stop(scale) * stop(load)
    size = jnp.sqrt(pull @ pull)
    direction = pull / jnp.where(size > 0, size, 1.0)
    play = _play(frozen[0])
    # A load that presses the contacts by far less than the play that it takes up is
    # approached from a larger one, by tens: with it, as with a barrier method, all
    # contacts that matter are found early and Newton's method stays on their side.
    pressing = _load_for(frozen[0], play)
    factor = jnp.where(size > 0, jnp.maximum(1.0, pressing / size), 1.0)
    if start is not None:
        near = free * jnp.where(jnp.isfinite(start), start, 0.0) / scale
        known = jnp.all(jnp.isfinite(start)) & (near @ near < radius * radius)
        begin = begin + jnp.where(known, near, 0.0)
        factor = jnp.where(known, 1.0, factor)
    solver = TrustRegionNewton(symmetric=symmetric, softest=0.03)
    problem = Problem(
        function,
        stop(begin),
        1e-7 * stop(radius) + play,
        memory=frozen[0].nothing_near(),
        direction=direction,
        limit=8.0 * stop(radius) + jnp.abs(stop(begin[5])),
        force=pull,
        tolerance=tolerance,
        max_steps=max_steps,
    )
    minimum = continuation(solver, problem, factor)

    def residual(y, args):
        model, load, given, fixed, scale, free = args
        # A held freedom follows what is prescribed for it, not `y`: between it and the
        # free ones the Jacobian would not be symmetric.
        held = (1.0 - free) * (given / scale)
        q = ring_freedoms(free * y + held, scale, fixed)
        # gz may be prescribed: the answer follows it through the azimuths.
        force = model.force(q, turns=True)[moving]
        return free * scale * (force - load) + (1.0 - free) * y - held

    y = attach(residual, minimum.x, args, symmetric)
    y = unless_failed(y, minimum.result == Result.CONVERGED)
    q = ring_freedoms(y, scale, fixed)
    fields, evaluated = describe(element, model, q, points, minimum.memory)

    out = free * scale * (fields["force"][moving] - load)
    reference = jnp.where(size > 0, size, evaluated.magnitude)
    tiny = jnp.finfo(load.dtype).tiny
    final = jnp.sqrt(stop(out) @ stop(out)) / jnp.maximum(reference, tiny)
    stats = Stats(final, minimum.steps, evaluated.residual, evaluated.steps)

    result = jnp.maximum(minimum.result, evaluated.result)
    # A load on a freedom that is held, or that this type of bearing cannot restrain.
    loaded = jnp.asarray(~np.array(is_free)) & ~(load == 0)
    result = jnp.where(
        jnp.any(loaded) & (result != Result.NON_FINITE),
        int(Result.NO_LOAD_PATH),
        result,
    )
    # What presses contacts by the size of the bearing: numbers of another scale.
    most = stop(stiffness_scale(element.bearing) * radius)
    absurd = (size > most) | (_inertia(frozen[0]) > most)
    absurd = absurd | (begin[:5] @ begin[:5] >= (8.0 * radius) ** 2)
    result = jnp.where(
        absurd & (result != Result.CONVERGED), int(Result.NON_FINITE), result
    )
    runaway = _runaway(minimum.x, free)
    unrestrained = jnp.where(jnp.any(loaded), jnp.argmax(loaded), runaway)
    inputs = jnp.concatenate([load, given, fixed])
    bad = ~jnp.all(jnp.isfinite(inputs)) | ~jnp.all(jnp.isfinite(fields["force"]))
    result = jnp.where(bad, int(Result.NON_FINITE), result).astype(jnp.int32)
    of_ring = jnp.any(loaded) | (minimum.result == Result.NO_LOAD_PATH)
    unrestrained = jnp.where(
        of_ring & (result == Result.NO_LOAD_PATH), unrestrained, -1
    )
    kind = BallSolution if is_ball(element.bearing) else RollerSolution
    return kind(
        **fields,
        element=element,
        speed=speed,
        free=tuple(f for f, yes in zip(FREEDOMS, is_free, strict=True) if yes),
        held=tuple(f for f, yes in zip(FREEDOMS, held, strict=True) if yes),
        moving_ring=RINGS[1 - RINGS.index(fixed_ring)],
        pitch_radius=radius,
        result=result,
        unrestrained=unrestrained.astype(jnp.int32),
        stats=stats,
    )


def _play(model: BearingModel) -> Scalar:
    """Largest play between the rings, radial or axial [m]."""
    rows = [row.part for row in model.rows]
    plays = [row.bearing.play + jnp.abs(row.inner_offset) for row in rows]
    # Less than this and a small load would follow the groove in tiny steps.
    least = [
        2e-3 * row.bearing.centre_distances[1]
        for row in rows
        if isinstance(row.bearing, AbstractBallBearing)
    ]
    return jnp.max(jnp.stack([jnp.zeros_like(plays[0]), *plays, *least]))


def _load_for(model: BearingModel, approach: Scalar) -> Scalar:
    """Load of one raceway contact pressed by `approach` [N]."""
    loads = [row.each(lambda one: one.pressed(approach)) for row in model.rows]
    return jnp.max(jnp.stack([jnp.max(load) for load in loads]))


def _inertia(model: BearingModel) -> Scalar | float:
    """Largest inertia force of a rolling element [N]."""
    sizes = [row.each(lambda one: one.inertia_size()) for row in model.rows]
    found = [jnp.max(size) for size in sizes if size is not None]
    return jnp.max(jnp.stack(found)) if found else 0.0


def _runaway(y: Float[Array, "6"], free: Float[Array, "6"]) -> Array:
    """Freedom that runs away: the axial one if it takes part, else the largest."""
    size = jnp.abs(y) * free
    return jnp.where(size[2] > 0.1 * jnp.max(size), 2, jnp.argmax(size))


def _named(prescribed) -> dict:
    if prescribed is None:
        return {}
    if not isinstance(prescribed, Mapping):
        raise TypeError(
            f"solve_load: `prescribed` is {prescribed!r}; it must be a dict of freedoms"
            " with their values in m or rad, such as {'uz': 1e-5}."
        )
    return dict(prescribed)


def _six(name, value, dtype):
    value = np.zeros(6) if value is None else value
    order, unit = (LOADS, "N, N m") if name == "load" else (FREEDOMS, "m, rad")
    wanted = f"six numbers, {' '.join(order)} in {unit} (units belong in scene files)"
    real_numbers("solve_load", name, value, wanted)
    try:
        array = as_array(value, dtype)
    except ValueError as error:  # lists of unlike length
        raise ValueError(f"solve_load: `{name}` must be {wanted}.") from error
    if array.shape != (6,):
        raise ValueError(
            f"solve_load: `{name}` has shape {array.shape}; it must be (6,):"
            f" {' '.join(order)}."
        )
    return array


def _check_names(what, names):
    unknown = [n for n in names if n not in FREEDOMS]
    if unknown:
        raise ValueError(
            f"solve_load: `{what}` names {', '.join(map(repr, unknown))}; freedoms are"
            f" {', '.join(FREEDOMS)}."
        )

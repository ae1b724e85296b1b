"""What a solved bearing is: everything that a designer asks of it."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from ..contact.line import half_width, peak_pressure
from ..design.rib import RIB_NAMES
from ..element.bearing_element import BearingElement, Evaluated, Row, roller_motions
from ..element.constants import relative_radii
from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..numerics.result import Result
from ..numerics.types import Ring, RingStiffness, Scalar


class Stats(eqx.Module):
    """How the solve went.

    Attributes:
        residual: Force out of balance on the free freedoms relative to the load,
            moments divided by the pitch radius [1].
        iterations: Steps of the load solve.
        roller_residual: Largest relative residual of a roller [1].
        roller_iterations: Most steps of a roller in the last evaluation.
    """

    residual: Scalar
    iterations: Int[Array, ""]
    roller_residual: Scalar
    roller_iterations: Int[Array, ""]


class Solution(eqx.Module):
    """A solved bearing. Axes: raceway and ring (outer, inner); ribs by `RIB_NAMES`.

    If `result` is not `CONVERGED` the numbers are those of the last step, not an
    answer.

    Attributes:
        displacement: Ring freedoms (12,) [m, rad].
        force: External load that holds the rings (12,) [N, N m].
        stiffness: Tangent stiffness (12, 12) [N/m, N, N m].
        roller_load: Load of each roller on each raceway (roller, 2) [N].
        rib_load: Load of each roller on each rib (roller, 4), 0 where there is no
            rib [N].
        roller_motion: (u, v, θ) of each roller in its section, at the node on the
            axis (roller, 3) [m, m, rad].
        azimuth: Azimuth of each roller [rad].
        position: Uniform positions along the roller, end to end (point,) [m].
        line_load: Load per length (roller, 2, point) [N/m].
        contact_pressure: Hertz peak pressure (roller, 2, point) [Pa].
        contact_half_width: Hertz half width (roller, 2, point) [m].
        edge_loaded: Line load above zero at the roller end (roller, 2, end), ends
            at -L/2 and +L/2.
        result: `Result` code.
        unrestrained: Index of the freedom of the moving ring that no contact holds
            against the load, if the result is `NO_LOAD_PATH`; otherwise -1 (also if
            it is a roller that nothing holds).
        stats: How the solve went.
    """

    displacement: Ring
    force: Ring
    stiffness: RingStiffness
    roller_load: Float[Array, "roller 2"]
    rib_load: Float[Array, "roller 4"]
    roller_motion: Float[Array, "roller 3"]
    azimuth: Float[Array, " roller"]
    position: Float[Array, " point"]
    line_load: Float[Array, "roller 2 point"]
    contact_pressure: Float[Array, "roller 2 point"]
    contact_half_width: Float[Array, "roller 2 point"]
    edge_loaded: Bool[Array, "roller 2 2"]
    result: Int[Array, ""]
    unrestrained: Int[Array, ""]
    stats: Stats

    @property
    def load_zone(self) -> Bool[Array, " roller"]:
        """Which rollers carry load between the raceways, more than round-off."""
        least = 1e-9 * jnp.max(self.roller_load)
        return jnp.all(self.roller_load > least, axis=1)

    @property
    def converged(self) -> Bool[Array, ""]:
        """Whether the result code is `CONVERGED`."""
        return self.result == Result.CONVERGED


def message(solution: Solution, moving_ring: str) -> str:
    """Cause and cure of a result, in words; for concrete, single solutions."""
    result = Result(int(solution.result))
    stats = solution.stats
    if result is Result.CONVERGED:
        return "converged"
    if result is Result.NO_LOAD_PATH:
        if int(solution.unrestrained) < 0:
            return (
                "No load path for a roller: inertia throws it off, because no rib"
                " holds it along its axis. Add the rib, or lower the speed."
            )
        freedom = FREEDOMS[int(solution.unrestrained)]
        return (
            f"No load path in {freedom} of the {moving_ring} ring: the bearing does"
            " not hold the load in this direction. Add load or preload that closes"
            " it, turn the load round, or prescribe that freedom."
        )
    if result is Result.NON_FINITE:
        return (
            "Non-finite numbers in the solve: check loads, prescribed displacements"
            " and dimensions for NaN, infinity or sizes far outside the bearing."
        )
    if result is Result.SADDLE:
        return (
            "A roller's equilibrium is a saddle, not a minimum (finite kinematics):"
            " use linearised kinematics, or more load or length of contact."
        )
    return (
        f"Step limit reached after {int(stats.iterations)} steps, relative residual"
        f" {float(stats.residual):.1e}, rollers {float(stats.roller_residual):.1e}:"
        " raise the step limit, or use the trust-region Newton method for the"
        " rollers."
    )


def warnings(solution: Solution) -> list[str]:
    """Physics warnings of a concrete, single solution, one sentence each."""
    out = []
    for ring, name in enumerate(("outer", "inner")):
        edges = np.asarray(solution.edge_loaded)[:, ring].any(axis=1)
        rollers = [int(i) for i in np.flatnonzero(edges)]
        if rollers:
            listed = ", ".join(map(str, rollers))
            out.append(
                f"edge-loaded roller: line load at the roller end above zero on the"
                f" {name} raceway (rollers {listed}); the line-contact laws know no"
                " end pressure peak"
            )
    return out


def distribution(row: Row, points: int) -> tuple[Array, Array, Array, Array]:
    """Line load, pressure and half width along every roller.

    Args:
        row: Solved rollers.
        points: Number of positions, end to end.

    Returns:
        position (point,) [m]; line load [N/m], pressure [Pa] and half width [m], each
        (roller, 2, point).
    """
    c = row.model.constants
    xi = jnp.linspace(-1.0, 1.0, points, dtype=c.half_length.dtype)
    position = c.half_length * xi
    drops = jnp.stack([line.drop(xi) for line in c.lines])
    approaches = _approaches(row)[:, :4].reshape(-1, 2, 2)
    along = approaches[..., :1] + approaches[..., 1:] * xi[None, None, :] - drops[None]
    load = jax.vmap(
        lambda a: jnp.stack([line.line_load(a[k]) for k, line in enumerate(c.lines)])
    )(along)
    radius = relative_radii(c, position)
    radius = radius[None]
    return (
        position,
        load,
        peak_pressure(load, radius, c.modulus),
        half_width(load, radius, c.modulus),
    )


def contact_loads(
    row: Row,
) -> tuple[Float[Array, "roller 2"], Float[Array, "roller 4"]]:
    """Load of every roller on both raceways and on the four ribs [N]."""
    raceways, ribs = row.solved.raceway_load, row.solved.rib_load
    all_ribs = jnp.zeros((raceways.shape[0], len(RIB_NAMES)), raceways.dtype)
    present = row.model.constants.ribs
    if present is not None:
        columns = jnp.array([RIB_NAMES.index(name) for name in present.names])
        all_ribs = all_ribs.at[:, columns].set(ribs)
    return raceways, all_ribs


def _approaches(row):
    model = row.model
    return jax.vmap(lambda r, x: model.kinematics.approaches(model.prepared, r, x))(
        row.rings, row.state.x
    )


def describe(
    element: BearingElement,
    q: Ring,
    speed: Speed | None,
    points: int,
) -> tuple[dict, Evaluated]:
    """All fields of a `Solution` that follow from the ring freedoms.

    Args:
        element: The bearing.
        q: Ring freedoms [m, rad].
        speed: Ring speeds or `None`.
        points: Positions along the roller.
    """
    row = element.row(q, speed)
    evaluated = element.evaluate_row(row, q, speed)
    roller_load, rib_load = contact_loads(row)
    position, line_load, pressure, width = distribution(row, points)
    return {
        "displacement": q,
        "force": evaluated.force,
        "stiffness": evaluated.stiffness,
        "roller_load": roller_load,
        "rib_load": rib_load,
        "roller_motion": roller_motions(row),
        "azimuth": row.azimuth,
        "position": position,
        "line_load": line_load,
        "contact_pressure": pressure,
        "contact_half_width": width,
        "edge_loaded": line_load[..., jnp.array([0, -1])] > 0,
    }, evaluated

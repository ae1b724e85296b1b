"""What a designer asks of solved rollers: rib loads, line loads, pressures."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..contact.line import half_width, peak_pressure
from ..design.rib import RIB_NAMES
from ..element.constants import relative_radii
from ..element.roller import RollerModel
from ..element.row import Row


class RollerResults(eqx.Module):
    """Axes: raceway (outer, inner); ribs by `RIB_NAMES`.

    Attributes:
        rib_load: Load of each roller on each rib (roller, 4), 0 where there is no
            rib [N].
        position: Uniform positions along the roller, end to end (point,), of a set
            with rollers of several lengths (roller, point) [m].
        line_load: Load per length (roller, 2, point) [N/m].
        contact_pressure: Hertz peak pressure (roller, 2, point) [Pa].
        contact_half_width: Hertz half width (roller, 2, point) [m].
        edge_loaded: Line load above zero at the roller end (roller, 2, end), ends
            at -L/2 and +L/2.
    """

    rib_load: Float[Array, "roller 4"]
    position: Float[Array, "*roller point"]
    line_load: Float[Array, "roller 2 point"]
    contact_pressure: Float[Array, "roller 2 point"]
    contact_half_width: Float[Array, "roller 2 point"]
    edge_loaded: Bool[Array, "roller 2 2"]


def roller_results(rows: tuple[Row, ...], points: int) -> dict[str, Array]:
    """Fields of `RollerResults`, and `roller_load`, of solved rows.

    Args:
        rows: Solved rollers of all rows.
        points: Positions along a roller, end to end.
    """
    parts = [(*contact_loads(row), *distribution(row, points)) for row in rows]
    loads, ribs, positions, *along = (list(p) for p in zip(*parts, strict=True))
    position = positions[0]
    if len(rows) > 1:
        counts = [load.shape[0] for load in loads]
        position = jnp.concatenate(
            [jnp.tile(p, (n, 1)) for p, n in zip(positions, counts, strict=True)]
        )
    line_load, pressure, width = (jnp.concatenate(part) for part in along)
    return {
        "roller_load": jnp.concatenate(loads),
        "rib_load": jnp.concatenate(ribs),
        "position": position,
        "line_load": line_load,
        "contact_pressure": pressure,
        "contact_half_width": width,
        "edge_loaded": line_load[..., jnp.array([0, -1])] > 0,
    }


def roller_warnings(solution: RollerResults) -> list[str]:
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
    assert isinstance(row.model.element, RollerModel)
    c = row.model.element.constants
    xi = jnp.linspace(-1.0, 1.0, points, dtype=c.half_length.dtype)
    position = c.half_length * xi
    pairs = list(zip(c.lines, c.tables, strict=True))

    def along(each):
        loads = [
            line.along(table, xi, *each[2 * k : 2 * k + 2])
            for k, (line, table) in enumerate(pairs)
        ]
        return jnp.stack(loads)

    load = jax.vmap(along)(approaches(row))
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
    raceways, ribs = jnp.split(row.solved.contact_load, [2], axis=1)
    all_ribs = jnp.zeros((raceways.shape[0], len(RIB_NAMES)), raceways.dtype)
    assert isinstance(row.model.element, RollerModel)
    present = row.model.element.constants.ribs
    if present is not None:
        columns = jnp.array([RIB_NAMES.index(name) for name in present.names])
        all_ribs = all_ribs.at[:, columns].set(ribs)
    return raceways, all_ribs


def approaches(row: Row) -> Float[Array, "roller contact"]:
    """Approaches of every roller: a and b at the outer, at the inner raceway, ribs.

    Args:
        row: Solved rollers.

    Returns:
        (roller, 4 + rib) [m]; a in the middle, b more of it at +L/2.
    """
    model = row.model.element
    assert isinstance(model, RollerModel)
    return jax.vmap(lambda r, x: model.kinematics.approaches(model.prepared, r, x))(
        row.rings, row.state.x
    )

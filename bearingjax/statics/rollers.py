"""What a designer asks of solved rollers: rib loads, line loads, pressures."""

from typing import NamedTuple

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
from ..numerics.units import unit

EDGE_PRESSURE = 300e6
"""Pressure at a roller end beyond which the end counts as loaded [Pa].

A fifth of 1500 MPa, the contact stress of the fatigue load limit of ISO 281: the peak
that a line contact does not know, at a sharp end a small multiple of this, then stays
harmless.
"""

_SCAN = 33
"""Positions from which the peak is sought: found to 1e-4 of the pressure at worst,
between a straight part and a crown; profiles without kinks to 1e-6."""


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
        edge_load: Load per length at the roller ends, at -L/2 and +L/2
            (roller, 2, end) [N/m].
        edge_pressure: Hertz pressure there, which knows no peak (roller, 2, end) [Pa].
    """

    rib_load: Float[Array, "roller 4"] = eqx.field(metadata=unit("N"))
    position: Float[Array, "*roller point"] = eqx.field(metadata=unit("m"))
    line_load: Float[Array, "roller 2 point"] = eqx.field(metadata=unit("N/m"))
    contact_pressure: Float[Array, "roller 2 point"] = eqx.field(metadata=unit("Pa"))
    contact_half_width: Float[Array, "roller 2 point"] = eqx.field(metadata=unit("m"))
    edge_load: Float[Array, "roller 2 2"] = eqx.field(metadata=unit("N/m"))
    edge_pressure: Float[Array, "roller 2 2"] = eqx.field(metadata=unit("Pa"))

    @property
    def edge_loaded(self) -> Bool[Array | np.ndarray, "roller 2 2"]:
        """Which roller ends bear more than `EDGE_PRESSURE`."""
        return self.edge_pressure > EDGE_PRESSURE


def roller_results(rows: tuple[Row, ...], points: int) -> dict[str, Array]:
    """Fields of `RollerResults`, `roller_load` and `roller_pressure`, of solved rows.

    Args:
        rows: Solved rollers of all rows.
        points: Positions along a roller, end to end.
    """
    loads, ribs = zip(*(contact_loads(row) for row in rows), strict=True)
    parts = [distribution(row, points) for row in rows]
    if len(rows) > 1:
        parts = [
            part._replace(position=jnp.tile(part.position, (load.shape[0], 1)))
            for part, load in zip(parts, loads, strict=True)
        ]
    return {
        "roller_load": jnp.concatenate(loads),
        "rib_load": jnp.concatenate(ribs),
        **{
            name: jnp.concatenate([getattr(part, name) for part in parts])
            for name in Distribution._fields
        },
    }


class Distribution(NamedTuple):
    """What stands along every roller of a row.

    Attributes:
        position: (point,) [m].
        line_load, contact_pressure, contact_half_width: As of `RollerResults`.
        roller_pressure: Largest pressure (roller, 2) [Pa], whatever the positions.
        edge_load, edge_pressure: As of `RollerResults`.
    """

    position: Array
    line_load: Array
    contact_pressure: Array
    contact_half_width: Array
    roller_pressure: Array
    edge_load: Array
    edge_pressure: Array


def distribution(row: Row, points: int) -> Distribution:
    """Line load, pressure and half width along every roller, and their extremes.

    Args:
        row: Solved rollers.
        points: Number of positions, end to end.
    """
    assert isinstance(row.model.element, RollerModel)
    c = row.model.element.constants
    dtype = c.half_length.dtype
    xi = jnp.linspace(-1.0, 1.0, points, dtype=dtype)
    scan = jnp.linspace(-1.0, 1.0, _SCAN, dtype=dtype)
    weight = relative_radii(c, c.half_length * scan) ** -0.9

    def along(each):
        loads, summits, places = [], [], []
        for k, (line, table) in enumerate(zip(c.lines, c.tables, strict=True)):
            carried = line.carried(table, *each[2 * k : 2 * k + 2])
            places.append(line.summits(carried, scan, weight[k]))
            summits.append(line.at(carried, places[k]))
            loads.append(line.at(carried, xi))
        return jnp.stack(loads), summits, places

    load, summits, places = jax.vmap(along)(approaches(row))
    count = places[0].shape[1]
    both = jnp.concatenate(places, axis=1)
    radius = relative_radii(c, c.half_length * both)
    radius = jnp.concatenate([radius[0, :, :count], radius[1, :, count:]], axis=1)
    peaks = peak_pressure(jnp.concatenate(summits, axis=1), radius, c.modulus)
    peaks = peaks[:, :count], peaks[:, count:]
    radius = relative_radii(c, c.half_length * xi)[None]
    return Distribution(
        c.half_length * xi,
        load,
        peak_pressure(load, radius, c.modulus),
        half_width(load, radius, c.modulus),
        jnp.stack([jnp.max(p, axis=1) for p in peaks], axis=1),
        jnp.stack([load[:, :2] for load in summits], axis=1),
        jnp.stack([p[:, :2] for p in peaks], axis=1),
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

"""Results of solved rollers: rib loads, line loads, pressures."""

from typing import Annotated, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..contact.line import half_width, peak_pressure
from ..design.rib import RIB_NAMES
from ..element.constants import relative_radii
from ..element.solved_row import RowResults
from ..numerics.units import unit

EDGE_PRESSURE = 300e6
"""Pressure at a roller end above which the end counts as edge-loaded [Pa].

A fifth of 1500 MPa, the contact stress at the fatigue load limit of ISO 281. The line
contact leaves out the pressure peak at a sharp end, which is a small multiple of this
pressure: up to this limit it stays harmless.
"""

_SCAN = 33
"""Positions at which the search for the largest pressure begins. It is found to 1e-6;
with a kink in the profile, as from a straight part to a crown, to 1e-4."""


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
        edge_pressure: Hertz pressure there, without the peak of a sharp end
            (roller, 2, end) [Pa].
    """

    rib_load: Float[Array, "element rib=4"] = eqx.field(metadata=unit("N"))
    position: Float[Array, "*element point"] = eqx.field(metadata=unit("m"))
    line_load: Float[Array, "element raceway=2 point"] = eqx.field(metadata=unit("N/m"))
    contact_pressure: Float[Array, "element raceway=2 point"] = eqx.field(
        metadata=unit("Pa")
    )
    contact_half_width: Float[Array, "element raceway=2 point"] = eqx.field(
        metadata=unit("m")
    )
    edge_load: Float[Array, "element raceway=2 end=2"] = eqx.field(metadata=unit("N/m"))
    edge_pressure: Float[Array, "element raceway=2 end=2"] = eqx.field(
        metadata=unit("Pa")
    )

    @property
    def edge_loaded(self) -> Bool[Array | np.ndarray, "*case roller 2 2"]:
        """Whether each roller end has a pressure above `EDGE_PRESSURE`."""
        return self.edge_pressure > EDGE_PRESSURE


def roller_results(rows: tuple[RowResults, ...], points: int) -> dict[str, Array]:
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
    along = jax.tree.map(lambda *values: jnp.concatenate(values), *parts)
    return {
        "roller_load": jnp.concatenate(loads),
        "rib_load": jnp.concatenate(ribs),
        **along._asdict(),
    }


class Distribution(NamedTuple):
    """Line load and pressure along every roller of a row.

    Attributes:
        position: (point,) [m].
        line_load, contact_pressure, contact_half_width: As in `RollerResults`.
        roller_pressure: Largest pressure (roller, 2) [Pa], whatever the positions.
        edge_load, edge_pressure: As in `RollerResults`.
    """

    position: Annotated[Array, unit("m")]
    line_load: Array
    contact_pressure: Array
    contact_half_width: Array
    roller_pressure: Annotated[Array, unit("Pa")]
    edge_load: Array
    edge_pressure: Array


def distribution(row: RowResults, points: int) -> Distribution:
    """Line load, pressure and half width along every roller, and their extremes.

    Args:
        row: Solved rollers.
        points: Number of positions, end to end.
    """
    dtype = row.contact_load.dtype
    xi = jnp.linspace(-1.0, 1.0, points, dtype=dtype)
    scan = jnp.linspace(-1.0, 1.0, _SCAN, dtype=dtype)

    def roller_distribution(roller, approaches):
        c = roller.constants
        weight = relative_radii(c, c.half_length * scan) ** -0.9
        loads, peaks, ends = [], [], []
        for k, (line, table) in enumerate(zip(c.lines, c.tables, strict=True)):
            carried = line.contact_state(table, *approaches[k])
            places = line.summits(carried, scan, weight[k])
            summits = line.load(carried, places)
            radius = relative_radii(c, c.half_length * places)[k]
            pressures = peak_pressure(summits, radius, c.modulus)
            peaks.append(jnp.max(pressures))
            ends.append((summits[:2], pressures[:2]))
            loads.append(line.load(carried, xi))
        load, radius = jnp.stack(loads), relative_radii(c, c.half_length * xi)
        edge_load, edge_pressure = (jnp.stack(v) for v in zip(*ends, strict=True))
        return Distribution(
            c.half_length * xi,
            load,
            peak_pressure(load, radius, c.modulus),
            half_width(load, radius, c.modulus),
            jnp.stack(peaks),
            edge_load,
            edge_pressure,
        )

    found = row.row.map(roller_distribution, approaches(row))
    # All rollers are of one length.
    return found._replace(position=found.position[0])


def contact_loads(
    row: RowResults,
) -> tuple[Float[Array, "roller 2"], Float[Array, "roller 4"]]:
    """Load of every roller on both raceways and on the four ribs [N]."""
    raceways, ribs = jnp.split(row.contact_load, [2], axis=1)
    all_ribs = jnp.zeros((raceways.shape[0], len(RIB_NAMES)), raceways.dtype)
    present = row.element.constants.ribs
    if present is not None:
        columns = jnp.array([RIB_NAMES.index(name) for name in present.names])
        all_ribs = all_ribs.at[:, columns].set(ribs)
    return raceways, all_ribs


def line_loads(
    row: RowResults, xi: Float[Array, " point"]
) -> Float[Array, "roller 2 point"]:
    """Load per length of every roller on both raceways [N/m].

    Args:
        row: Solved rollers.
        xi: Positions s/(L/2) along the roller, from -1 to 1 (point,).
    """

    def roller_loads(roller, approaches):
        c = roller.constants
        contacts = zip(c.lines, c.tables, approaches, strict=True)
        return jnp.stack(
            [line.load_along(table, xi, *at) for line, table, at in contacts]
        )

    return row.row.map(roller_loads, approaches(row))


def approaches(row: RowResults) -> Float[Array, "roller 2 2"]:
    """Approaches of every roller at the outer and the inner raceway.

    Returns:
        (roller, raceway, 2) [m]: a in the middle, a + b at +L/2.
    """
    return row.map(lambda roller, *at: roller.approaches(*at).raceway)

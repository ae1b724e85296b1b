"""Zones of the orbit of balls under axial and radial load."""

from typing import Annotated, NamedTuple

import numpy as np

from ...numerics.units import unit
from ..conditions import by_raceway
from .steady_results import SteadyMotion, SteadySkid


class Zone(NamedTuple):
    """Zone of the orbit.

    Attributes:
        name: "A" to "D".
        begin, end: Azimuths, the end above the beginning [rad].
        loaded: Whether balls carry more than their share of the axial load there.
    """

    name: str
    begin: Annotated[float, unit("rad")]
    end: Annotated[float, unit("rad")]
    loaded: bool


def zones(found: SteadyMotion) -> list[Zone]:
    """Return parts of the orbit with loads above those of the axial load alone.

    Under axial and radial load on a ring that may tilt there are two, B and D, of
    which B has the larger load; A comes before B, in the sense of the orbit.

    Args:
        found: From `skid.steady`.

    Returns:
        A, B, C, D in this order; empty where the parts are not these four.

    Source: Han & Chu, J. Sound Vib. 354 (2015) 219-235, figures 11 and 12.
    """
    if not isinstance(found, SteadySkid):
        return []  # of rollers
    azimuth, load = (
        np.asarray(found.azimuth),
        by_raceway(found.contact_load, found.contact_load),
    )
    inner = load[:, 1]
    if len(azimuth) < 8 or not np.isfinite(inner).all():
        return []
    # Of the axial load each ball bears the same on the mean.
    angle = by_raceway(found.contact_angle, found.contact_load)[:, 1]
    axial = np.mean(inner * np.sin(angle))
    if abs(np.mean(angle)) < 1e-6:
        return []
    over = inner - axial / np.sin(np.mean(angle))
    after = np.roll(over, -1)
    up, down = (
        np.flatnonzero((over <= 0) & (after > 0)),
        np.flatnonzero((over > 0) & (after <= 0)),
    )
    if len(up) != 2:
        return []
    step = 2.0 * np.pi / len(azimuth)

    def crossing(k):
        return azimuth[k] + step * over[k] / (over[k] - after[k])

    forward = np.asarray(found.cage_speed) >= 0
    spans = []
    for k in up:
        begin = crossing(k)
        apart = [(crossing(d) - begin) % (2.0 * np.pi) for d in down]
        within = (azimuth - begin) % (2.0 * np.pi) < min(apart)
        spans.append((begin, begin + min(apart), inner[within].max()))
    spans.sort(key=lambda span: -span[2])
    (b0, b1, _), (d0, d1, _) = spans
    d0, d1 = (d0 - b0) % (2.0 * np.pi) + b0, (d1 - b0) % (2.0 * np.pi) + b0
    between, beyond = (b1, d0), (d1, b0 + 2.0 * np.pi)
    before, behind = (beyond, between) if forward else (between, beyond)
    return [
        Zone("A", *before, False),
        Zone("B", b0, b1, True),
        Zone("C", *behind, False),
        Zone("D", d0, d1, True),
    ]

"""Outlines of a roller bearing in its axial section."""

from typing import Annotated, NamedTuple

import numpy as np

from ...contact import Palmgren
from ...design.bearing import AbstractRollerBearing
from ...element.constants import contact_constants
from ...numerics import Midpoint
from ...numerics.compiled.programs import program
from ...numerics.units import unit
from ..profiles import drop_along
from ..style import RACEWAYS

_BODY = 0.35  # thickness of the schematic rings, roller diameters
_BESIDE = 0.28  # width of the schematic rings past roller and ribs, roller diameters


class Section(NamedTuple):
    """Section of a bearing through the axis of one roller; points are (z, r) [mm].

    Attributes:
        roller: Outline of the roller (point, 2).
        rings: Outlines of outer and inner ring, each (point, 2).
        raceways: Both raceways along the roller (2, point, 2): ring, point, (z, r);
            two points of straight ones.
        axis: Ends of the roller axis (2, 2).
        generators: Unit vectors along both generators in their middle, from the -t end
            of the roller on (2, 2).
        rib_points: Contact point on every rib (rib, 2).
        rib_normals: Unit normals there, from the roller to the rib (rib, 2).
        centre: Centre of the roller (2,).
        diameter: Roller diameter [mm].
        length: Roller length [mm].
    """

    roller: Annotated[np.ndarray, unit("mm")]
    rings: Annotated[tuple[np.ndarray, np.ndarray], unit("mm")]
    raceways: Annotated[np.ndarray, unit("mm")]
    axis: Annotated[np.ndarray, unit("mm")]
    generators: Annotated[np.ndarray, unit("mm")]
    rib_points: Annotated[np.ndarray, unit("mm")]
    rib_normals: Annotated[np.ndarray, unit("mm")]
    centre: Annotated[np.ndarray, unit("mm")]
    diameter: Annotated[float, unit("mm")]
    length: Annotated[float, unit("mm")]


def section(bearing: AbstractRollerBearing) -> Section:
    """Return outlines of roller and rings in the section plane."""
    length = 1e3 * float(bearing.roller_length)
    diameter = 1e3 * float(bearing.roller_diameter)
    centre = 1e3 * np.array(
        [float(bearing.axial_place), 0.5 * float(bearing.pitch_diameter)]
    )
    # Along and across the rings: z and r, of washers -r and z.
    frame = np.array([[0.0, -1.0], [1.0, 0.0]]) if bearing.is_thrust else np.eye(2)
    half, tilt = float(bearing.half_angle), -float(bearing.axis_angle)
    along = frame @ np.array([np.cos(tilt), np.sin(tilt)])
    across = frame @ np.array([-np.sin(tilt), np.cos(tilt)])

    def to_rings(points):
        """Return points in the roller's axes (t, m) along and across the rings."""
        points = np.asarray(points)
        return points[..., :1] * along + points[..., 1:] * across

    def to_plane(points):
        """Return (z, r) of points along and across the rings."""
        return centre + np.asarray(points) @ frame

    ends = np.array([-1.0, 1.0])
    reach, gap = 0.5 * length * np.cos(half), 1e3 * float(bearing.gap)
    arcs = bearing.arc_radii
    arcs = [np.inf] * 3 if arcs is None else [1e3 * float(radius) for radius in arcs]
    straight = not np.isfinite(arcs[1:]).any()
    along_it = ends if straight else np.linspace(-1.0, 1.0, 61)
    # Far beyond the roller, for the rings to end where they do.
    far = min(3.0 * (length + diameter), *(0.6 * radius for radius in arcs[1:]))
    raceways, generators, curves = [], [], []
    for sign, radius in zip((1.0, -1.0), arcs[1:], strict=True):
        way = np.array([np.cos(half), -sign * np.sin(half)])
        away = np.array([np.sin(half), sign * np.cos(half)])
        middle = np.array([0.0, 0.5 * sign * diameter]) + gap * away

        def curve(s, middle=middle, way=way, away=away, radius=radius):
            back = _sagitta(s, radius)
            return to_rings(middle + s[:, None] * way - back[:, None] * away)

        raceways.append(curve(0.5 * length * along_it))
        curves.append(curve(far * (ends if straight else np.linspace(-1.0, 1.0, 601))))
        generators.append(way[0] * along + way[1] * across)

    ribs = _ribs(bearing)
    roller = to_rings(_roller_outline(bearing, ribs, arcs[0]))
    lines = {
        name: _rib_line(name, rib, to_rings, diameter) for name, rib in ribs.items()
    }
    # Side faces of the rings: clear of the roller and of all ribs.
    corners = np.concatenate([roller, *raceways, *lines.values()])
    low, high = corners[:, 0].min(), corners[:, 0].max()
    faces = low - _BESIDE * diameter, high + _BESIDE * diameter
    if bearing.aligns:  # both rows on the same rings
        faces = min(low, -centre[0]), faces[1]
    if bearing.is_thrust:
        faces = faces[0], min(faces[1], max(high, 0.8 * centre[1]))
    body = _BODY * diameter
    if bearing.is_crossed:
        rings = [_groove(sign, diameter, gap, body) for sign in (1.0, -1.0)]
    else:
        rings = [
            _ring_outline(name, raceways[i], curves[i], lines, faces, body)
            for i, name in enumerate(RACEWAYS)
        ]
    outer, inner = (to_plane(ring) for ring in rings)
    if not bearing.is_thrust:  # not beyond the axis
        bore = 0.3 * to_plane(raceways[1])[:, 1].min()
        inner[:, 1] = np.maximum(inner[:, 1], bore)
    return Section(
        roller=to_plane(roller),
        rings=(outer, inner),
        raceways=to_plane(np.stack(raceways)),
        axis=to_plane(to_rings(np.stack([ends * reach, np.zeros(2)], axis=1))),
        generators=np.stack(generators) @ frame,
        rib_points=to_plane(
            to_rings(np.array([rib["point"] for rib in ribs.values()]).reshape(-1, 2))
        ),
        rib_normals=to_rings(
            np.array([rib["normal"] for rib in ribs.values()]).reshape(-1, 2)
        )
        @ frame,
        centre=centre,
        diameter=diameter,
        length=length,
    )


@program(quick=True)
def _rib_contacts(bearing):
    return contact_constants(bearing, Palmgren(), Midpoint()).ribs


def _ribs(bearing):
    """Return contact point, normal, height and sphere radius of every rib, in mm."""
    contacts = _rib_contacts(bearing)
    if contacts is None:
        return {}
    return {
        name: {
            "point": 1e3 * np.asarray(contacts.point[i]),
            "normal": np.asarray(contacts.normal[i]),
            "height": 1e3 * float(getattr(bearing.ribs, name).contact_height),
            "end_radius": 1e3 * float(getattr(bearing.ribs, name).end_radius),
        }
        for i, name in enumerate(contacts.names)
    }


def _rib_line(name, rib, to_rings, diameter):
    """Return foot and top of a rib face (2, 2), along and across the rings."""
    sign = 1.0 if name.startswith("outer") else -1.0
    normal = rib["normal"]
    # Square to the normal, from the raceway towards the roller axis.
    rise = np.array([-normal[1], normal[0]])
    rise *= -sign * np.sign(rise[1])
    height = max(rib["height"] + 0.08 * diameter, 0.18 * diameter)
    foot = rib["point"] - rib["height"] * rise
    return to_rings(np.stack([foot, foot + height * rise]))


def _sagitta(s, radius):
    return s**2 / (radius + np.sqrt(radius**2 - s**2))


def _roller_outline(bearing, ribs, radius):
    """Return the outline of the roller (t, m), with profile and end spheres, in mm."""
    length, half = 1e3 * float(bearing.roller_length), float(bearing.half_angle)
    diameter = 1e3 * float(bearing.roller_diameter)
    s, drop = (1e3 * x for x in drop_along(bearing, "roller_profile", 401))
    back = _sagitta(s, radius)
    x = s * np.cos(half) - back * np.sin(half)
    y = 0.5 * diameter - s * np.sin(half) - back * np.cos(half) - drop
    # Some profiles grow without limit at the very end.
    keep = np.isfinite(drop) & (drop < 0.01 * diameter)
    spheres = {}
    for side, word in ((-1.0, "minus"), (1.0, "plus")):
        radius = [r["end_radius"] for n, r in ribs.items() if n.endswith(word)]
        spheres[side] = radius[0] if radius else np.inf

    def end(side, height):
        radius = spheres[side]
        back = 0.0
        if np.isfinite(radius):
            back = radius - np.sqrt(np.maximum(radius**2 - height**2, 0.0))
        return side * (0.5 * length * np.cos(half) - back)

    keep &= (x >= end(-1.0, y)) & (x <= end(1.0, y))
    x, y = x[keep], y[keep]
    left, right = np.linspace(0.0, y[0], 40), np.linspace(y[-1], 0.0, 40)
    upper = np.concatenate(
        [
            np.stack([end(-1.0, left) + 0.0 * left, left], axis=1),
            np.stack([x, y], axis=1),
            np.stack([end(1.0, right) + 0.0 * right, right], axis=1),
        ]
    )
    return np.concatenate([upper, upper[::-1] * np.array([1.0, -1.0])])


def _ring_outline(name, raceway, curve, lines, faces, body):
    """Outline of a ring: side faces, ribs that exist, raceway, then the back."""
    sign = 1.0 if name == "outer" else -1.0
    sides = []
    for word, face, end in zip(("minus", "plus"), faces, (0, -1), strict=True):
        line = lines.get(f"{name}_{word}")
        if line is None:
            part = [np.array([face, np.interp(face, *curve.T)])]
        else:
            # Rib face and raceway meet in a corner.
            foot, top = line
            slope = raceway[end] - raceway[(1, -2)[end]]
            matrix = np.stack([slope, foot - top], axis=1)
            corner = (
                raceway[end] + slope * np.linalg.solve(matrix, foot - raceway[end])[0]
            )
            part = [np.array([face, top[1]]), top, corner]
        sides.append(part)
    low, high = sides[0][-1][0], sides[1][-1][0]
    between = curve[(curve[:, 0] > low) & (curve[:, 0] < high)]
    inside = np.array([*sides[0], *between, *sides[1][::-1]])
    back = sign * ((sign * inside[:, 1]).max() + body)
    return np.concatenate([inside, [[faces[1], back], [faces[0], back]]])


def _groove(sign, diameter, gap, body):
    """Outline of a ring of a crossed roller bearing, whose raceways make a V."""
    deep, open_ = np.sqrt(0.5) * diameter + np.sqrt(2.0) * gap, 0.06 * diameter
    face, back = deep + _BESIDE * diameter, deep + body
    edge = deep - open_
    half = [[face, open_], [face, back], [-face, back], [-face, open_], [-edge, open_]]
    line = np.array([[0.0, deep], [edge, open_], *half])
    return line * np.array([1.0, sign])

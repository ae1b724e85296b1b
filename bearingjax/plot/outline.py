"""Outlines of a roller bearing in its axial section."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np

from ..contact import Palmgren
from ..design.bearing import AbstractRollerBearing
from ..design.profile import drops
from ..element.constants import contact_constants
from ..numerics import Midpoint
from ..numerics.programs import program
from .style import RACEWAYS

_BODY = 0.35  # thickness of the schematic rings, roller diameters
_BESIDE = 0.28  # width of the schematic rings past roller and ribs, roller diameters


class Section(NamedTuple):
    """Section of a bearing through the axis of one roller; points are (z, r) [mm].

    Attributes:
        roller: Outline of the roller (point, 2).
        rings: Outlines of outer and inner ring, each (point, 2).
        raceways: Ends of both raceway generators (2, 2, 2): ring, end, point.
        axis: Ends of the roller axis (2, 2).
        generators: Unit vectors along both generators, towards +z (2, 2).
        rib_points: Contact point on every rib (rib, 2).
        rib_normals: Unit normals there, from the roller to the rib (rib, 2).
        pitch_radius: Radius of the pitch circle [mm].
        diameter: Roller diameter [mm].
        length: Roller length [mm].
    """

    roller: np.ndarray
    rings: tuple[np.ndarray, np.ndarray]
    raceways: np.ndarray
    axis: np.ndarray
    generators: np.ndarray
    rib_points: np.ndarray
    rib_normals: np.ndarray
    pitch_radius: float
    diameter: float
    length: float


def section(bearing: AbstractRollerBearing) -> Section:
    """Return outlines of roller and rings in the section plane.

    Args:
        bearing: The design.
    """
    length = 1e3 * float(bearing.roller_length)
    diameter = 1e3 * float(bearing.roller_diameter)
    pitch_radius = 0.5e3 * float(bearing.pitch_diameter)
    half, tilt = float(bearing.half_angle), -float(bearing.axis_angle)
    along = np.array([np.cos(tilt), np.sin(tilt)])
    across = np.array([-np.sin(tilt), np.cos(tilt)])

    def to_plane(points):
        """Return (z, r) of points in the roller's axes (t, m)."""
        points = np.asarray(points)
        return (
            np.array([0.0, pitch_radius])
            + points[..., :1] * along
            + points[..., 1:] * across
        )

    reach = 0.5 * length * np.cos(half)
    ends = np.array([-1.0, 1.0])
    radii = 0.5 * diameter - ends * 0.5 * length * np.sin(half)
    clearance = 0.25e3 * float(bearing.radial_internal_clearance)
    raceways, generators = [], []
    for sign in (1.0, -1.0):
        away = np.array([np.sin(half), sign * np.cos(half)])
        edge = np.stack([ends * reach, sign * radii], axis=1)
        raceways.append(to_plane(edge + clearance * away))
        generators.append(np.cos(half) * along - sign * np.sin(half) * across)
    raceways, generators = np.stack(raceways), np.stack(generators)

    ribs = _ribs(bearing)
    roller = to_plane(_roller_outline(bearing, ribs))
    lines = {
        name: _rib_line(name, rib, to_plane, along, across, diameter)
        for name, rib in ribs.items()
    }
    # Side faces of the rings: clear of the roller and of all ribs.
    corners = np.concatenate([roller, raceways.reshape(-1, 2), *lines.values()])
    faces = (
        corners[:, 0].min() - _BESIDE * diameter,
        corners[:, 0].max() + _BESIDE * diameter,
    )
    outer, inner = (
        _ring_outline(name, raceways[i], lines, faces, _BODY * diameter)
        for i, name in enumerate(RACEWAYS)
    )
    return Section(
        roller=roller,
        rings=(outer, inner),
        raceways=raceways,
        axis=to_plane(np.stack([ends * reach, np.zeros(2)], axis=1)),
        generators=generators,
        rib_points=to_plane(
            np.array([rib["point"] for rib in ribs.values()]).reshape(-1, 2)
        ),
        rib_normals=np.array([rib["normal"] for rib in ribs.values()]).reshape(-1, 2)
        @ np.stack([along, across]),
        pitch_radius=pitch_radius,
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


def _rib_line(name, rib, to_plane, along, across, diameter):
    """Return foot and top of a rib face (2, 2), in (z, r)."""
    sign = 1.0 if name.startswith("outer") else -1.0
    normal = rib["normal"]
    # Square to the normal, from the raceway towards the roller axis.
    rise = np.array([-normal[1], normal[0]])
    rise *= -sign * np.sign(rise[1])
    height = max(rib["height"] + 0.08 * diameter, 0.18 * diameter)
    foot = rib["point"] - rib["height"] * rise
    return to_plane(np.stack([foot, foot + height * rise]))


def _roller_outline(bearing, ribs):
    """Return the outline of the roller (t, m), with profile and end spheres, in mm."""
    length, half = 1e3 * float(bearing.roller_length), float(bearing.half_angle)
    diameter = 1e3 * float(bearing.roller_diameter)
    s = -0.5 * length * np.cos(np.linspace(0.0, np.pi, 401))
    position = jnp.asarray(1e-3 * s, bearing.roller_length.dtype)
    drop = 1e3 * np.asarray(
        drops(
            bearing.roller_profile,
            position,
            bearing.roller_length,
            bearing.roller_diameter,
        )
    )
    x, y = s * np.cos(half), 0.5 * diameter - s * np.sin(half) - drop
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


def _ring_outline(name, raceway, lines, faces, body):
    """Outline of a ring: back, side faces, ribs that exist, raceway."""
    slope = (raceway[1] - raceway[0]) / (raceway[1, 0] - raceway[0, 0])
    inside = []
    for word, face in zip(("minus", "plus"), faces, strict=True):
        line = lines.get(f"{name}_{word}")
        if line is None:
            part = [raceway[0] + slope * (face - raceway[0, 0])]
        else:
            # Rib face and raceway meet in a corner.
            foot, top = line
            matrix = np.stack([slope, foot - top], axis=1)
            corner = raceway[0] + slope * np.linalg.solve(matrix, foot - raceway[0])[0]
            part = [np.array([face, top[1]]), top, corner]
        inside.append(part if word == "minus" else part[::-1])
    inside = np.array(inside[0] + inside[1])
    if name == "outer":
        back = inside[:, 1].max() + body
    else:
        back = inside[:, 1].min() - min(body, 0.7 * inside[:, 1].min())
    return np.concatenate([inside, [[faces[1], back], [faces[0], back]]])

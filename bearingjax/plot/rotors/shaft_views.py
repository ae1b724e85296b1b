"""All shafts of a system in one frame, seen from the end and from the side."""

from typing import Any

import numpy as np

from ..style import GREY, INNER, OUTER, Axes, faded, write_beside

_AXES = "xyz"


def placed_shafts(system: Any) -> list[Any]:
    """Return the shafts of a system whose places are known."""
    return [line for line in system.shafts if line.origin is not None]


def system_views(run: Any, end: Axes, side: Axes) -> None:
    """Draw all shafts whose places are known, with wheels and meshes, to scale.

    Wheels are cylinders of their pitch radius, a dot is where the force of a mesh acts.

    Args:
        run: Result of the scene of a system of shafts, solved.
        end: Axes of the view against the first shaft.
        side: Axes of the view across it, along the direction in which the shafts lie
            less far apart.
    """
    lines = placed_shafts(run.task.system)
    along = int(np.argmax(np.abs(np.asarray(lines[0].frame[2]))))
    others = (along + 1) % 3, (along + 2) % 3
    apart = np.ptp([np.asarray(line.origin) for line in lines], axis=0)
    up = max(others[::-1], key=lambda k: apart[k])
    _view(end, run, lines, others)
    _view(side, run, lines, (along, up))
    lacking = [s.name for s in run.task.system.shafts if s.origin is None]
    without = f", without {', '.join(lacking)}, not placed" if lacking else ""
    end.set_title(f"All shafts, seen against {_AXES[along]}, to scale{without}")
    side.set_title("All shafts, from the side")


def _view(ax, run, lines, seen):
    """Draw the projection on two global axes."""
    system, seen = run.task.system, [*seen]
    for line in lines:
        frame = np.asarray(line.frame)
        start, way = 1e3 * np.asarray(line.origin), 1e3 * frame[2]
        ends = np.cumsum([0.0, *np.asarray(line.length)])
        for k, size in enumerate(np.asarray(line.outer_diameter)):
            span = start + np.outer(ends[k : k + 2], way)
            _cylinder(ax, span, 500.0 * size * frame[:2], seen, GREY)
        for seat in [seat for seat in system.seats if seat.shaft == line.name]:
            at = (start + float(seat.position) * way)[seen]
            if np.abs(frame[2, seen]).max() > 0.1:  # else they hide each other
                ax.plot(*at, "x", color=INNER, ms=9, zorder=5, label="_bearing")
                write_beside(ax, at, (0, -5), seat.name, ha="center", va="top")
        for wheel in [wheel for wheel in system.wheels if wheel.shaft == line.name]:
            middle, radius = start + float(wheel.position) * way, float(wheel.radius)
            width = getattr(wheel, "face_width", None)
            half = 0.5 * float(0.5 * radius if width is None else width)
            span = middle + np.outer([-half, half], way)
            _cylinder(ax, span, 1e3 * radius * frame[:2], seen, OUTER)
            away = 1.0
            for mesh in run.solution.power.meshes:
                if mesh.wheel == wheel.name:
                    point = 1e3 * np.asarray(mesh.place)
                    at = (middle + point)[seen]
                    ax.plot(*at, "o", color="black", ms=4, zorder=7, label="_mesh")
                    away = -1.0 if point[seen[1]] > 1e-6 else 1.0
            at = middle[seen] + [0.0, away * 1e3 * radius]
            side = "bottom" if away > 0.0 else "top"
            look = {"ha": "center", "va": side, "zorder": 7}
            write_beside(ax, at, (0.0, 3.0 * away), _words(wheel), **look)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.15)
    ax.set_xlabel(f"{_AXES[seen[0]]} [mm]")
    ax.set_ylabel(f"{_AXES[seen[1]]} [mm]")


def _words(wheel):
    """Return the name of a wheel, and the hand of its helix."""
    if getattr(wheel, "hand", "none") == "none":
        return wheel.name
    return f"{wheel.name}, {wheel.hand} {np.rad2deg(float(wheel.helix_angle)):.3g}°"


def _cylinder(ax, ends, radii, seen, colour):
    """Fill the outline of a cylinder between two points, with two radii (2, 3)."""
    from scipy.spatial import ConvexHull

    turn = np.linspace(0.0, 2.0 * np.pi, 73)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1) @ radii
    points = np.concatenate([end + circle for end in ends])[:, seen]
    outline = points[ConvexHull(points).vertices]
    ax.fill(*outline.T, facecolor=faded(colour, 0.2), edgecolor=colour, linewidth=1.0)

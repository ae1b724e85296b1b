"""Pictures of a system of shafts: drawings to scale, lines, load zones."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ..numerics.constants import GRAVITY
from ..numerics.units import CELSIUS
from ..rotor import BearingSupport, LinearSupport, Rotor
from .load import load_zone, zone_legend
from .panel import Axis, Bars, Panel
from .rotors.rotor import rotor_section
from .style import (
    GREY,
    INNER,
    OUTER,
    Axes,
    Figure,
    faded,
    head,
    pyplot,
    towards_white,
    write,
    write_beside,
)

_ACROSS = 4
"""Most load zones side by side."""
_AXES = ("x", "y")
_COLOURS = (INNER, OUTER)


def shaft_overview(run: Any, title: str = "") -> Figure:
    """Plot each shaft to scale with its lines, and the load zone of each bearing.

    Several shafts whose places are known come first, in one frame. Under load cases
    all is of the first, as the head says. Temperatures, of the nodes and over the time
    of warming up, come last.

    Args:
        run: Result of the scene of a system of shafts, solved.
        title: Head of the page; "Shafts" if empty.

    Returns:
        The figure, 16 inches wide.
    """
    system = run.task.system
    shown = [b for b in run.bearings if b.solution is not None]
    across = max(1, min(_ACROSS, len(shown)))
    whole = int(len(placed_shafts(system)) > 1)
    n_shafts, rows = whole + len(system.shafts), -(-len(shown) // across)
    warm = int(run.thermal is not None)
    tall = 1.5 + 4.6 * n_shafts + 4.4 * (rows + warm)
    figure = pyplot().figure(figsize=(18.0, tall))
    grid = figure.add_gridspec(
        n_shafts + rows + warm, 15, left=0.05, right=0.95, wspace=1.6, hspace=0.42,
        top=1.0 - 1.4 / tall, bottom=0.6 / tall,
    )  # fmt: skip
    if whole:
        ends = (figure.add_subplot(grid[0, :6]), figure.add_subplot(grid[0, 6:]))
        system_views(run, *ends)
    for k, line in enumerate(system.shafts):
        row, state = whole + k, run.solution.shafts[k]
        ax = figure.add_subplot(grid[row, :6])
        _drawing(ax, run, k)
        ax.set_title(f"Shaft {line.name}, to scale; forces on it (x, y, z) in kN")
        # The moment that bends in the plane of x is about y.
        bent = np.stack([state.moment[:, 1], -state.moment[:, 0]], axis=1)
        lines = {
            "Deflection [µm]": 1e6 * state.displacement[:, :2],
            "Shear force [kN]": 1e-3 * state.shear[:, :2],
            "Bending moment [kN m]": 1e-3 * bent,
        }
        for place, (label, values) in enumerate(lines.items()):
            ax = figure.add_subplot(grid[row, 6 + 3 * place : 9 + 3 * place])
            _line(ax, state.position, values, label)
            if k == place == 0:  # of all lines
                ax.legend(fontsize="small")
    named: dict[str, Any] = {}
    for k, bearing in enumerate(shown):
        row, place = divmod(k, across)
        wide = 15 // across
        spec = grid[n_shafts + row, place * wide : (place + 1) * wide]
        ax = figure.add_subplot(spec, projection="polar")
        load_zone(bearing.solution, ax)
        ax.set_title(f"Bearing {bearing.name}\n{ax.get_title()}")
        # One legend for each line of load zones, beside the last.
        legend: Any = ax.get_legend()
        labels = [text.get_text() for text in legend.get_texts()]
        named = {} if place == 0 else named
        named |= dict(zip(labels, legend.legend_handles, strict=True))
        legend.remove()
        if place + 1 == across or k + 1 == len(shown):
            named = {n: h for n, h in named.items() if f"{n}, row 0" not in named}
            zone_legend(ax, list(named.values()), list(named))
    if warm:
        left = 0 if run.warming is None else 9
        _draw_nodes(figure.add_subplot(grid[n_shafts + rows, left:]), run)
    if run.warming is not None:
        _draw_warm_up(figure.add_subplot(grid[n_shafts + rows, :8]), run)
    case = f"{run.shown_case}: {run.case_words(0)}" if run.shown_case else ""
    place = 1.0 - 0.3 / tall
    head(figure, ", ".join(filter(None, (title or "Shafts", case))), y=place)
    return figure


def _draw_warm_up(ax, run):
    """Plot the temperatures of rings and housing over time."""
    for k, (name, warm) in enumerate(run.warm_nodes.items()):
        style = "--" if name.endswith("outer") else "-"
        colour = GREY if name == "housing" else f"C{k // 2}"
        ax.plot(run.task.times / 60.0, warm - CELSIUS, style, color=colour, label=name)
    ax.set_xlabel("time [min]")
    ax.set_ylabel("temperature [°C]")
    ax.set_title("Warming up from the cold")
    ax.legend(fontsize="small")


def _draw_nodes(ax, run):
    """Plot the temperatures of rings, and of the housing, in equilibrium."""
    warm, seats = run.thermal, run.task.system.seats
    known = [k for k, seat in enumerate(seats) if seat.installed is not None]
    outer, inner = (
        np.asarray(x)[known] - CELSIUS for x in (warm.outer_ring, warm.inner_ring)
    )
    marks = [
        Bars(outer, "outer ring", OUTER, -0.2, 0.4, "%.0f"),
        Bars(inner, "inner ring", INNER, 0.2, 0.4, "%.0f"),
    ]
    housing = float(warm.housing) - CELSIUS
    ax.axhline(
        housing, color=GREY, ls="--", label=f"housing or surroundings, {housing:.0f}"
    )
    across, up = Axis("bearing"), Axis("temperature", "", (1.0, "°C"))
    names = [seats[k].name for k in known]
    title, legend = "Temperatures in equilibrium", {"ncols": 3, "loc": "upper left"}
    Panel(title, across, up, marks, room=0.2, names=names, legend=legend).draw(ax)


def _line(ax, position, values, label):
    for k, axis in enumerate(_AXES):
        ax.plot(1e3 * position, values[:, k], color=_COLOURS[k], label=axis)
    ax.axhline(0.0, color=GREY, lw=0.7)
    ax.set_xlabel("z [mm]")
    ax.set_title(label)


def _drawing(ax, run, index):
    """Draw a shaft with its bearings and wheels, and the forces on it."""
    system = run.task.system
    line, frame = system.shafts[index], np.asarray(system.shafts[index].frame)
    supports, radius = [], 500.0 * float(np.max(line.outer_diameter))
    for k, seat in enumerate(system.seats):
        if seat.shaft != line.name:
            continue
        station = system.station(seat)[1]
        solution = run.bearings[k].solution
        if solution is None:
            supports.append(LinearSupport(station, seat.stiffness))
        else:
            element = jax.tree.map(jnp.asarray, solution.element)
            supports.append(BearingSupport(station, element, turned=seat.turned))
    rotor_section(Rotor(system.beam(index), (), supports), ax)
    forces = [(s, run.solution.load[k], True) for k, s in enumerate(system.seats)]
    forces += [(load, np.asarray(load.force), False) for load in system.loads]
    for mesh in run.solution.power.meshes:
        wheel = system.wheel(mesh.wheel)
        forces.append((wheel, np.asarray(mesh.force), False))
        if wheel.shaft == line.name:
            z, r = 1e3 * float(wheel.position), 1e3 * float(wheel.radius)
            width = getattr(wheel, "face_width", None)
            half = 500.0 * float(0.25 * wheel.radius if width is None else width)
            ax.fill(
                [z - half, z + half, z + half, z - half],
                [-r, -r, r, r],
                facecolor=towards_white(OUTER, 0.75),
                edgecolor=OUTER,
                alpha=0.8,
                zorder=1,
            )
            radius = max(radius, r)
    for part, force, reaction in forces:
        if part.shaft != line.name:
            continue
        own = frame @ np.asarray(force)[:3] * (-1.0 if reaction else 1.0)
        own = np.where(np.abs(own) > 1e-6 * np.abs(own).max(), own, 0.0) + 0.0
        words = ", ".join(f"{1e-3 * f:.3g}" for f in own)
        at = 1e3 * float(part.position), 0.03 if reaction else 0.95
        write(
            ax, at, f"{part.name}\n({words})", transform=ax.get_xaxis_transform(),
            va="bottom" if reaction else "top", fontsize="x-small", zorder=9,
        )  # fmt: skip
    middle = 500.0 * float(np.sum(line.length))
    ax.update_datalim([(middle, 1.5 * radius), (middle, -1.5 * radius)])
    ax.autoscale_view()
    if float(np.linalg.norm(system.gravity)) > 0:
        pull = frame @ np.asarray(system.gravity) / GRAVITY
        ax.set_xlabel(f"z [mm]; weight along ({', '.join(f'{g:.2g}' for g in pull)})")


_DIRECTIONS = "xyz"


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
    end.set_title(f"All shafts, seen against {_DIRECTIONS[along]}, to scale{without}")
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
    ax.set_xlabel(f"{_DIRECTIONS[seen[0]]} [mm]")
    ax.set_ylabel(f"{_DIRECTIONS[seen[1]]} [mm]")


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

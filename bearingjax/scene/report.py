"""A solution as text for people: µm, mrad, kN, N m, MPa.

A report is a list of sections, each a title and a function of scene and solution that
gives its text. The terminal shows the texts, `html_report` puts them on a page. What
is new in a report is one more line of `SECTIONS`.
"""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np

from ..design import Bearing, BearingSet, TaperedRollerBearing, is_ball, rows_of
from ..element.frame import FREEDOMS, LOAD_UNITS, LOADS, MOTION_UNITS, RINGS
from ..numerics.units import display_unit
from ..statics.life_warning import life_warnings
from ..statics.solution import BallSolution, Solution
from ..statics.warning import warnings
from .fit_report import ACROSS_TAPERS, fit_report, outer_cosine
from .life_report import life_report, scene_life
from .oil_table import oil_report
from .operation_report import operation
from .read import Scene
from .set_preload import preload_report

_RULE = "-" * 78

ROUND_OFF = 1e-11
"""Size over the largest of its kind below which a number is shown as zero [1]."""

Section = Callable[[Scene, Solution], str]
"""Text of a section, of a scene and its solution in NumPy; "": nothing to tell."""


def report(scene: Scene, solution: Solution) -> str:
    """Readable report of a solved scene.

    Args:
        scene: What was solved.
        solution: Its solution, converged.
    """
    return f"\n{_RULE}\n".join(sections(scene, solution).values())


def sections(scene: Scene, solution: Solution) -> dict[str, str]:
    """The texts of a report by their titles, those left out that are empty.

    Args:
        scene: What was solved.
        solution: Its solution, converged.
    """
    # As NumPy holds it: JAX would compile every small operation on the way.
    solution = jax.device_get(solution)
    texts = {title: section(scene, solution) for title, section in SECTIONS.items()}
    return {title: text for title, text in texts.items() if text}


def design_sections(scene: Scene) -> dict[str, str]:
    """The texts by their titles that need no solution: the bearing, and its fits.

    Args:
        scene: What is asked.
    """
    texts = {
        "Bearing": bearing_text(scene, jax.device_get(scene.running().bearing)),
        "Fits and clearance": _fits(scene, None),
    }
    return {title: text for title, text in texts.items() if text}


def _bearing(scene, solution):
    return bearing_text(scene, solution.element.bearing, solution)


def bearing_text(
    scene: Scene, bearing: Bearing | BearingSet, solution: Solution | None = None
) -> str:
    """Kind, sizes and arrangement of a bearing.

    Args:
        scene: What was asked.
        bearing: As it is mounted, in NumPy.
        solution: With it, springs are told too.
    """
    lines = []
    if isinstance(bearing, BearingSet):
        places = ", ".join(
            f"{1e3 * _place(row):.4g} mm{' (mirrored)' if row.mirrored else ''}"
            for row in bearing.rows
        )
        lines.append(f"{scene.name}: set of {len(bearing.rows)} rows at z = {places}")
        if scene.preload_force is not None:
            mounted = "" if scene.fits is None else ", which fits and warmth change"
            lines.append(f"ground to a preload of {scene.preload_force:.5g} N{mounted}")
        lines += [] if solution is None else _springs(bearing, solution)
    tell = ball_row if is_ball(bearing) else roller_row
    parts = [row.bearing for row in rows_of(bearing)]
    alike = len({"\n".join(tell(part, "")) for part in parts}) == 1
    if alike:
        own = tell(parts[0], "each row" if lines else scene.name)
    else:
        own = [line for k, part in enumerate(parts) for line in tell(part, f"row {k}")]
    listed = [] if scene.catalogue is None else [str(scene.catalogue)]
    return "\n".join([*lines, *own, *listed])


def _fits(scene, solution):
    return fits_text(scene)


def fits_text(scene: Scene) -> str:
    """Fits of a scene, and what they make of the preload of a set.

    Args:
        scene: What was asked.

    Returns:
        Text, empty without fits.
    """
    if scene.fits is None:
        return ""
    text = fit_report(scene.fits, scene.element.bearing)
    if scene.set_preload is None:
        return text
    return f"{text}\n{preload_report(scene.set_preload)}"


def _oil(scene, solution):
    if scene.oil is None:
        return ""
    return oil_report(scene.oil, solution, scene.catalogue)


def _place(row):
    within = float(getattr(row.bearing, "axial_place", 0.0))
    return float(row.position) + (-within if row.mirrored else within)


def _springs(bearing, solution):
    if solution.spring_force is None:
        return []
    return [
        f"row {k} (z = {1e3 * _place(row):.4g} mm): its spring presses with"
        f" {float(solution.spring_force[k]):.5g} N after"
        f" {1e6 * float(solution.spring_travel[k]):.4g} µm of travel"
        for k, row in enumerate(bearing.rows)
        if row.spring is not None
    ]


def ball_row(bearing, head) -> list[str]:
    """Kind and sizes of a row of balls, in words."""
    pitch, diameter = (
        1e3 * float(x) for x in (bearing.pitch_diameter, bearing.ball_diameter)
    )
    kind = type(bearing).__name__.removesuffix("BallBearing").removesuffix("BallRow")
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in kind).strip()
    angle = np.rad2deg(float(bearing.free_contact_angle))
    return [
        f"{head}: {words} ball bearing, {bearing.n_balls} balls of {diameter:.4g} mm on"
        f" a pitch circle of {pitch:.4g} mm",
        f"osculation: outer {_osculation(bearing.outer_osculation)}, inner"
        f" {float(bearing.inner_osculation):.4g}; free contact angle {angle:.4g} deg"
        + _clearance(bearing),
    ]


def _clearance(bearing):
    """The clearance of a ball bearing, where it is a number of the design."""
    clearance = getattr(bearing, "radial_internal_clearance", None)
    if clearance is None:
        return ""
    return f"; radial internal clearance {1e6 * float(clearance):.4g} µm"


def _osculation(value):
    return "of a sphere" if value is None else f"{float(value):.4g}"


def roller_row(bearing, head) -> list[str]:
    """Kind and sizes of a row of rollers, in words."""
    size = [bearing.pitch_diameter, bearing.roller_diameter, bearing.roller_length]
    pitch, diameter, length = (1e3 * float(x) for x in size)
    kind = type(bearing).__name__.removesuffix("RollerBearing").lower()
    ribs = ", ".join(bearing.ribs.present) or "none"
    lines = [
        f"{head}: {kind} roller bearing, {bearing.n_rollers} rollers"
        f" {diameter:.4g} x {length:.4g} mm on a pitch circle of {pitch:.4g} mm",
        f"{_roller_clearance(bearing)}; ribs: {ribs};"
        f" roller profile: {type(bearing.roller_profile).__name__}",
    ]
    if isinstance(bearing, TaperedRollerBearing):
        angles = (bearing.roller_axis_angle, bearing.roller_half_angle)
        axis, half = (float(np.rad2deg(float(angle))) for angle in angles)
        raceways = [axis + half, axis - half]
        lines.append(
            f"contact angle: outer {raceways[0]:.4g}, inner {raceways[1]:.4g} deg"
        )
    return lines


def _roller_clearance(bearing):
    """The clearance of rollers, of tapers along both ways that it is measured."""
    clearance = 1e6 * float(bearing.radial_internal_clearance)
    if not isinstance(bearing, TaperedRollerBearing):
        return f"radial internal clearance {clearance:.4g} µm"
    return (
        f"internal clearance {clearance:.4g} µm {ACROSS_TAPERS}, radially"
        f" {clearance / outer_cosine(bearing):.4g} µm"
    )


def _ring(scene):
    index = RINGS.index(scene.moving_ring)
    return slice(6 * index, 6 * index + 6)


def _motion(scene, solution):
    moving = _ring(scene)
    displacement = np.asarray(solution.displacement)[moving]
    force = np.asarray(solution.force)[moving]
    lines = [f"{scene.moving_ring} ring ({scene.fixed_ring} ring fixed)"]
    motion, loads = without_round_off(displacement), without_round_off(force)
    for i in range(6):
        scale, unit = display_unit(MOTION_UNITS[i])
        load_scale, load_unit = display_unit(LOAD_UNITS[i])
        lines.append(
            f"  {FREEDOMS[i]} {scale * motion[i]:12.5g} {unit:<5}"
            f"   {LOADS[i]} {load_scale * loads[i]:12.5g} {load_unit}"
            + ("   reaction of its support" if FREEDOMS[i] in solution.held else "")
        )
    return "\n".join(lines)


def _stiffness(scene, solution):
    moving = _ring(scene)
    k = np.asarray(solution.stiffness)[moving, moving]
    lines = [
        f"stiffness of the {scene.moving_ring} ring (kN/mm, kN/mrad, N m/mrad)",
        "     " + "".join(f"{name:>12}" for name in FREEDOMS[:5]),
    ]
    # N/m, N/rad and N m/rad in the units of the heading.
    scale = np.full((5, 5), 1e-6)
    scale[3:, 3:] = 1e-3
    shown = scale * without_round_off(k[:5, :5])
    for i in range(5):
        lines.append(f"  {FREEDOMS[i]:<3}" + "".join(f"{v:12.5g}" for v in shown[i]))
    return "\n".join(lines)


def without_round_off(values: Any) -> Any:
    """Numbers of one kind, those zero that are round-off beside the largest."""
    return np.where(np.abs(values) < ROUND_OFF * np.abs(values).max(), 0.0, values)


def _elements(scene, solution):
    of_balls = isinstance(solution, BallSolution)
    return _balls(solution) if of_balls else _rollers(solution)


def _rollers(solution):
    load = np.asarray(solution.roller_load)
    rib = np.asarray(solution.rib_load)
    touching = 1e-9 * max(load.max(), rib.max())
    pressure = 1e-6 * np.asarray(solution.roller_pressure)
    edge = np.any(np.asarray(solution.edge_loaded), axis=(1, 2))
    ribs = rib.any()
    head = (
        " roller azimuth   outer load  inner load   outer pmax  inner pmax"
        + ("    ribs" if ribs else "")
        + "\n"
        + "            deg           kN          kN          MPa         MPa"
        + ("       N" if ribs else "")
    )
    lines = [head]
    angles = np.rad2deg(np.asarray(solution.azimuth)) % 360.0
    for i in range(load.shape[0]):
        if max(load[i].max(), rib[i].max()) <= touching:
            continue
        line = (
            f" {i:6d} {angles[i]:7.1f}  {1e-3 * load[i, 0]:11.4f} "
            f"{1e-3 * load[i, 1]:11.4f}  {pressure[i, 0]:11.1f} {pressure[i, 1]:11.1f}"
        )
        if ribs:
            line += f" {rib[i].sum():7.1f}"
        lines.append(line + ("  edge-loaded" if edge[i] else ""))
    loose = load.shape[0] - (len(lines) - 1)
    if loose:
        lines.append(f" {loose} of {load.shape[0]} rollers are out of contact")
    return "\n".join(lines)


def _balls(solution):
    load = np.asarray(solution.contact_load)
    angle = np.rad2deg(np.asarray(solution.contact_angle))
    pressure = 1e-6 * np.asarray(solution.contact_pressure)
    raceway = np.asarray(solution.roller_load)
    azimuth = np.rad2deg(np.asarray(solution.azimuth)) % 360.0
    states, touching = np.asarray(solution.n_contacts), 1e-9 * load.max()
    half = load.shape[1] // 2
    turning = solution.kinematics
    head = (
        "   ball azimuth  outer load inner load  outer angle inner  outer pmax"
        "  inner  points" + ("  spin/roll" if turning else "") + "\n"
        "            deg           N          N          deg   deg         MPa"
        "    MPa" + ("       (larger)" if turning else "")
    )
    lines = [head]
    for i in range(load.shape[0]):
        if load[i].max() <= touching:
            continue
        # Of two arcs on a ring, the one that carries more.
        o, k = np.argmax(load[i, :half]), half + np.argmax(load[i, half:])
        line = (
            f" {i:6d} {azimuth[i]:7.1f}  {raceway[i, 0]:10.5g} {raceway[i, 1]:10.5g}"
            f"  {angle[i, o]:11.2f} {_angle(angle[i, k], load[i, k], touching)}"
            f"  {pressure[i, o]:10.0f} {pressure[i, k]:6.0f}  {states[i]:6d}"
        )
        if turning:
            line += f"  {np.asarray(turning.spin_to_roll)[i].max():9.3f}"
        lines.append(line)
    loose = load.shape[0] - (len(lines) - 1)
    if loose:
        lines.append(f" {loose} of {load.shape[0]} balls are out of contact")
    return "\n".join(lines)


def _angle(angle, load, touching):
    """An open contact has no angle worth printing."""
    return f"{angle:5.2f}" if load > touching else "    -"


def _life(scene, solution):
    if scene.life is None:
        return ""
    return life_report(scene, solution, scene_life(scene, solution))


def _ending(scene, solution):
    stats = solution.stats
    lines = [
        f"converged in {int(stats.iterations)} steps, residual"
        f" {float(stats.residual):.1e} of the load"
    ]
    told = [*scene.warnings, *warnings(solution)]
    if scene.life is not None:
        life = scene_life(scene, solution)
        told += life_warnings(scene.element.bearing, life.ratings, vars(life))
    lines += [f"warning: {w}" for w in told]
    return "\n".join(lines)


SECTIONS: dict[str, Section] = {
    "Bearing": _bearing,
    "Operation, materials and laws": operation,
    "Fits and clearance": _fits,
    "Displacement and load": _motion,
    "Stiffness": _stiffness,
    "Rolling elements": _elements,
    "Rating life": _life,
    "Friction and films": _oil,
    "Solution and warnings": _ending,
}
"""Sections of a report by their titles, in their order."""

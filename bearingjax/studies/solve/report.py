"""A solution as text: µm, mrad, kN, N m, MPa.

A report consists of titled sections, assembled in `report`. The terminal shows them as
text, `html_report` as a page.
"""

from typing import Any

import jax
import numpy as np

from ...cases.sweep_table import ROUND_OFF
from ...design import (
    AbstractBallBearing,
    AbstractBarrelBearing,
    AbstractBearing,
    AbstractRollerBearing,
    BearingSet,
    TaperedRollerBearing,
    rows_of,
)
from ...design.abstract import nearest_entry
from ...design.bearing_set import bearings_of
from ...element.frame import FREEDOMS, LOAD_UNITS, LOADS, MOTION_UNITS, RINGS
from ...numerics.labels import array_fields
from ...numerics.units import field_metadata, shown_count, unit_of
from ...report.report_model import DEGREES, NEWTONS, Column, Grid, Report, Section
from ...statics.solution import BallSolution, RollerSolution, Solution
from ...statics.warning_sizes import ends_over
from ..bearing.credibility import credibility_section
from ..bearing.fit_report import (
    ACROSS_TAPERS,
    fit_report,
    outer_cosine,
    preload_report,
)
from ..bearing.life_report import life_section
from ..bearing.oil import oil_report
from ..bearing.read_scene import Scene
from ..bearing.solved import SolvedScene
from .operation_report import operation

_NOTHING = 1e-9
"""Share of the largest load of a contact below which a load is none [1]."""


def report(found: SolvedScene) -> Report:
    """Return the readable report of a solved scene.

    Args:
        found: From `solve_scene`, converged.

    Returns:
        Sections by their titles; `str` of the report is the terminal text.
    """
    scene, solution, life, oil = found.scene, found.numbers, found.life, found.oil
    sections = {
        "Bearing": [bearing_text(scene, solution.element.bearing, solution)],
        "Operation, materials and laws": [operation(scene, solution)],
        "Fits and clearance": fits_section(scene),
        "Displacement and load": _motion(scene, solution),
        "Stiffness": [_stiffness(scene, solution)],
        "Rolling elements": _elements(solution),
        "Rating life": [] if life is None else life_section(scene, solution, life),
        "Friction and films": [] if scene.oil is None else oil_report(scene.oil, oil),
        "Solution": [
            f"converged in {shown_count(int(solution.stats.iterations), 'step')},"
            f" residual {float(solution.stats.residual):.1e} of the load"
        ],
        "Credibility": credibility_section(
            "solve" if life is None else "life",
            # Of a ring whose place is prescribed the load is not that of the scene.
            [("", solution.element, ring_force(solution)[_ring(scene)])],
        ),
    }
    return Report(sections, found.warnings)


def design_sections(scene: Scene) -> dict[str, Section]:
    """Return the sections that need no solution, by title: the bearing and its fits."""
    bearing = jax.device_get(scene.running().bearing)
    return {
        "Bearing": [bearing_text(scene, bearing)],
        "Fits and clearance": fits_section(scene),
    }


def bearing_text(
    scene: Scene,
    bearing: AbstractBearing | BearingSet,
    solution: Solution | None = None,
) -> str:
    """Describe type, sizes and arrangement of a bearing.

    Args:
        scene: The scene.
        bearing: The mounted bearing, in NumPy.
        solution: If given, springs are described too.
    """
    lines = []
    crossed = rows_of(bearing)[0].bearing.is_crossed
    if isinstance(bearing, BearingSet) and not crossed:
        places = ", ".join(
            f"{1e3 * _place(row):.4g} mm{' (mirrored)' if row.mirrored else ''}"
            for row in bearing.rows
        )
        lines.append(f"{scene.name}: set of {len(bearing.rows)} rows at z = {places}")
        if scene.preload_force is not None:
            mounted = "" if scene.fits is None else ", which fits and warmth change"
            lines.append(f"ground to a preload of {scene.preload_force:.5g} N{mounted}")
        lines += [] if solution is None else _springs(bearing, solution)
    parts, tell = list(bearings_of(bearing)), describe_row
    alike = len({"\n".join(tell(part, "")) for part in parts}) == 1
    if alike:
        own = tell(parts[0], "each row" if lines else scene.name)
    else:
        own = [line for k, part in enumerate(parts) for line in tell(part, f"row {k}")]
    listed = [] if scene.catalogue is None else [str(scene.catalogue)]
    return "\n".join([*lines, *own, *listed])


def fits_section(scene: Scene) -> Section:
    """Report the fits of a scene, and the set preload on them; empty without fits."""
    found = fit_report(scene)
    if scene.preload_of_set is not None:
        found += preload_report(scene.preload_of_set)
    return found


def _place(row):
    part, within = row.bearing, 0.0
    if part.is_ball:
        within = float(part.axial_place)
    elif part.aligns:
        within = 0.5 * float(part.pitch_diameter) * np.tan(float(part.contact_angle))
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


def _kind(bearing):
    """Return the type of a bearing in words: "deep groove ball", "spherical roller"."""
    name = type(bearing).__name__.removesuffix("Bearing").removesuffix("Row")
    return "".join(f" {c.lower()}" if c.isupper() else c for c in name).strip()


def describe_row(bearing: AbstractBearing, head: str) -> list[str]:
    """Describe type and sizes of a row.

    Args:
        bearing: The row.
        head: First words.
    """
    return nearest_entry(_ROWS, bearing)(bearing, head)


def _ball_row(bearing, head) -> list[str]:
    """Describe type and sizes of a row of balls."""
    pitch, diameter = (
        1e3 * float(x) for x in (bearing.pitch_diameter, bearing.ball_diameter)
    )
    angle = np.rad2deg(float(bearing.free_contact_angle))
    return [
        f"{head}: {_kind(bearing)} bearing, {bearing.n_balls} balls of"
        f" {diameter:.4g} mm on a pitch circle of {pitch:.4g} mm",
        f"osculation: outer {_osculation(bearing.outer_osculation)}, inner"
        f" {float(bearing.inner_osculation):.4g}; free contact angle {angle:.4g} deg"
        + _clearance(bearing),
    ]


def _clearance(bearing):
    """Describe the clearance of a ball bearing, where it is a design number."""
    clearance = getattr(bearing, "radial_internal_clearance", None)
    if clearance is None:
        return ""
    return f"; radial internal clearance {1e6 * float(clearance):.4g} µm"


def _osculation(value):
    return "of a sphere" if value is None else f"{float(value):.4g}"


def _roller_row(bearing, head) -> list[str]:
    """Describe type and sizes of a row of rollers."""
    size = [bearing.pitch_diameter, bearing.roller_diameter, bearing.roller_length]
    pitch, diameter, length = (1e3 * float(x) for x in size)
    ribs = ", ".join(bearing.ribs.present) or "none"
    play = "" if bearing.is_thrust else f"{_roller_clearance(bearing)}; "
    lines = [
        f"{head}: {_kind(bearing)} bearing, {bearing.n_rollers} rollers"
        f" {diameter:.4g} x {length:.4g} mm on a pitch circle of {pitch:.4g} mm",
        f"{play}ribs: {ribs}; roller profile: {type(bearing.roller_profile).__name__}",
    ]
    axis, half = _angles(bearing)
    if bearing.is_crossed:
        lines.append(
            f"contact angle: {axis:.4g} deg, of every other roller -{axis:.4g}"
        )
    elif half:
        raceways = [axis + half, axis - half]
        lines.append(
            f"contact angle: outer {raceways[0]:.4g}, inner {raceways[1]:.4g} deg"
        )
    elif axis:
        lines.append(f"contact angle: {axis:.4g} deg")
    return [*lines, *nearest_entry(_RADII, bearing)(bearing)]


def _profile_radii(bearing):
    radius = bearing.outer_raceway_radius
    outer = "a sphere about the axis"
    if radius is not None:
        sphere = " (a sphere)" if hasattr(bearing, "contact_angle") else ""
        outer = f"{1e3 * float(radius):.5g} mm{sphere}"
    radii = bearing.roller_profile_radius, bearing.inner_raceway_radius
    roller, inner = (f"{1e3 * float(one):.5g} mm" for one in radii)
    return [f"profile radii: roller {roller}, raceways outer {outer}, inner {inner}"]


_RADII = {AbstractRollerBearing: lambda _: [], AbstractBarrelBearing: _profile_radii}


def _angles(bearing):
    """Return the angles of the axis of the rollers and of their half cone [deg]."""
    half = 0.0
    if isinstance(bearing, TaperedRollerBearing):
        axis, half = bearing.roller_axis_angle, bearing.roller_half_angle
    elif bearing.is_crossed:
        axis = 0.25 * np.pi
    elif hasattr(bearing, "contact_angle"):
        offset = float(getattr(bearing, "profile_offset", 0.0))
        half = np.arcsin(offset / float(bearing.roller_profile_radius))
        axis = float(bearing.contact_angle) - half
    else:
        axis = 0.5 * np.pi if bearing.is_thrust else 0.0
    return np.rad2deg(float(axis)), np.rad2deg(float(half))


def _roller_clearance(bearing):
    """Describe the clearance of rollers, for tapers in both measuring directions."""
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
    motion = without_round_off(np.asarray(solution.displacement)[moving])
    loads = ring_force(solution)[moving]
    held = ["reaction of its support" if f in solution.held else "" for f in FREEDOMS]
    columns = [
        Column("", FREEDOMS),
        Column("displacement", motion, MOTION_UNITS),
        Column("", LOADS),
        Column("load", loads, LOAD_UNITS),
        *([Column("", held)] if any(held) else []),
    ]
    return [Grid(columns, f"{scene.moving_ring} ring ({scene.fixed_ring} ring fixed)")]


def _stiffness(scene, solution):
    moving = _ring(scene)
    k = np.asarray(solution.stiffness)[moving, moving]
    # N/m, N/rad and N m/rad in the units of the title.
    scale = np.full((5, 5), 1e-6)
    scale[3:, 3:] = 1e-3
    shown = scale * without_round_off(k[:5, :5])
    names = FREEDOMS[:5]
    columns = [Column(name, shown[:, j]) for j, name in enumerate(names)]
    return Grid(
        [Column("", names), *columns],
        f"stiffness of the {scene.moving_ring} ring (kN/mm, kN/mrad, N m/mrad)",
    )


def without_round_off(values: Any, least: float = 0.0) -> Any:
    """Set numbers to zero that are round-off relative to the largest of their kind, or
    below `least`."""
    size = np.abs(values)
    return np.where(size < max(ROUND_OFF * size.max(), least), 0.0, values)


def ring_force(solution: Solution) -> Any:
    """Return `force` of a solution, zero where it is what the balance leaves of the
    loads of the rolling elements (12,) [N, N m]."""
    borne = np.abs(np.asarray(solution.roller_load)).max()
    return without_round_off(np.asarray(solution.force), _NOTHING * float(borne))


def _elements(solution):
    touching, grid = nearest_entry(_ELEMENTS, solution)(solution)
    kind, open_ = f"{solution.element.bearing.noun}s", int((~touching).sum())
    away = f"{open_} of {len(touching)} {kind} are out of contact"
    return [*([grid] if touching.any() else []), *([away] if open_ else [])]


def _number_columns(kind, solution, shown):
    """Return the columns of number and azimuth of the rolling elements shown."""
    azimuth = np.asarray(solution.azimuth)[shown] % (2.0 * np.pi)
    return [
        Column(kind, shown),
        Column("azimuth", azimuth, "rad", ".1f", DEGREES),
    ]


def _stated_columns(solution, shown, **formats) -> list[Column]:
    """Return the columns of the results whose fields state a heading.

    Args:
        solution: In NumPy.
        shown: Indices of the rolling elements.
        formats: `format` and `shown` of a `Column`, by the name of the field.
    """
    columns = []
    found = array_fields(solution)
    for name in dict.fromkeys((*Solution.__dataclass_fields__, *found)):
        heading = field_metadata(solution, name).get("column")
        if heading is not None:
            values = without_round_off(found[name])
            make = by_ring if values.ndim > 1 else lambda *given: [Column(*given)]
            unit = unit_of(solution, name)
            columns += make(heading, values[shown], unit, *formats.get(name, ()))
    return columns


def by_ring(name: str, values: Any, *given: Any) -> list[Column]:
    """Return a column of the outer raceway and one of the inner.

    Args:
        name: Name of the quantity.
        values: By raceway (row, 2).
        given: `unit`, `format` and `shown`, as in `Column`.
    """
    return [
        Column(f"{ring} {name}", values[:, k], *given) for k, ring in enumerate(RINGS)
    ]


def _rollers(solution):
    load = np.asarray(solution.roller_load)
    rib = np.asarray(solution.rib_load)
    largest = np.maximum(load.max(axis=1), rib.max(axis=tuple(range(1, rib.ndim))))
    touching = largest > _NOTHING * largest.max()
    shown = np.flatnonzero(touching)
    edge = np.any(np.asarray(ends_over(solution)), axis=(1, 2))[shown]
    columns = [
        *_number_columns("roller", solution, shown),
        *_stated_columns(
            solution, shown, roller_load=(".4f",), roller_pressure=(".1f",)
        ),
    ]
    if rib.any():
        on_ribs = rib[shown].reshape(len(shown), -1).sum(axis=1)
        columns.append(Column("ribs", on_ribs, "N", ".1f", NEWTONS))
    if edge.any():
        columns.append(Column("", ["edge-loaded" if e else "" for e in edge]))
    return touching, Grid(columns)


def _balls(solution):
    load = np.asarray(solution.contact_load)
    touching = load.max(axis=1) > _NOTHING * load.max()
    shown = np.flatnonzero(touching)
    # Of two arcs on a ring, the more loaded one.
    half = load.shape[1] // 2
    outer, inner = load[:, :half].argmax(axis=1), half + load[:, half:].argmax(axis=1)
    most = np.stack([outer, inner], axis=1)

    def at_largest(values):
        return np.take_along_axis(np.asarray(values), most, axis=1)[shown]

    # An open contact has no meaningful angle.
    bears = at_largest(load) > _NOTHING * load.max()
    angle = np.where(bears, at_largest(solution.contact_angle), np.nan)
    stated = _stated_columns(
        solution, shown, roller_load=(".5g", NEWTONS), roller_pressure=(".0f",)
    )
    columns = [
        *_number_columns("ball", solution, shown),
        *stated[:2],
        *by_ring("angle", angle, "rad", ".2f", DEGREES),
        *stated[2:],
        Column("points", np.asarray(solution.n_contacts)[shown]),
    ]
    if solution.kinematics:
        ratio = np.asarray(solution.kinematics.spin_to_roll).max(axis=1)
        columns.append(Column("spin/roll (larger)", ratio[shown], "", ".3f"))
    return touching, Grid(columns)


_ROWS = {AbstractBallBearing: _ball_row, AbstractRollerBearing: _roller_row}
_ELEMENTS = {BallSolution: _balls, RollerSolution: _rollers}

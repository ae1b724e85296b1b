"""A system of shafts as text: mm, µm, mrad, kN, GPa, rpm, h."""

from typing import Any

import numpy as np

from ...numerics.units import rpm, shown_count
from ...report.report_model import (
    CASES_SHOWN,
    NEWTONS,
    Column,
    Grid,
    Part,
    Report,
    Section,
    with_values,
)
from ..bearing.credibility import credibility_section
from ..bearing.life_report import life_number, life_section, verdict_in_words
from ..bearing.oil import oil_report, series_words
from ..solve.report import fits_section
from .run import ShaftRun, bearing_loss

_MICRO = 1e6, "µrad"
_TIMES = 9
"""Most times of the warming up that are shown."""


def shaft_report(run: ShaftRun) -> Report:
    """Return the readable report of a solved system of shafts.

    Args:
        run: From `run_shafts`, its first case solved.
    """
    loads = run.solution.load[None] if run.duty is None else run.duty.load
    placed = [
        (bearing.name, bearing.solution.element, loads[:, k])
        for k, bearing in enumerate(run.bearings)
        if bearing.solution is not None
    ]
    sections: dict[str, Section] = {
        "System": [*_head(run), _shafts(run)],
        "Wheels": _wheels(run),
        "Bearings": _bearings(run),
        "Temperatures": _temperatures(run),
        "Rating life": _lives(run),
        "Load cases": _cases(run),
        "Solution": [
            f"converged in {shown_count(int(run.solution.steps), 'step')}, residual"
            f" {float(run.solution.residual):.1e} of the load"
        ],
        "Credibility": credibility_section("shaft", placed),
    }
    return Report(sections, run.warnings)


def shaft_page(run: ShaftRun) -> Report:
    """Return the report with details of each bearing, for the page.

    Args:
        run: From `run_shafts`, its first case solved.
    """
    report = shaft_report(run)
    sections = dict(report.sections)
    for bearing in run.bearings:
        scene, solution, life = bearing.scene, bearing.solution, bearing.life
        if scene is None or solution is None or life is None:
            continue
        parts: list[Part] = [*life_section(scene, solution, life), *fits_section(scene)]
        if scene.oil is not None:
            parts += oil_report(scene.oil, bearing.oil)
        sections[f"Bearing {bearing.name}{_of_case(run)}"] = parts
    return Report(sections, report.warnings)


def _head(run: ShaftRun) -> list[Part]:
    task, power = run.task, run.solution.power
    system = task.system
    count = len(system.shafts), len(system.seats)
    lines = [
        f"{task.name}: {count[0]} shaft{'s' * (count[0] > 1)} on {count[1]} bearings"
        f"{_of_case(run)}"
    ]
    drive = system.drive
    if drive is None:
        return [*lines, "at rest, not driven"]
    names = [shaft.name for shaft in system.shafts]
    into = drive.into if drive.into in names else system.wheel(drive.into).shaft
    speed = float(power.speed[names.index(into)])
    lines.append(
        f"driven at {drive.into}: {float(power.drive):.5g} N m at {rpm(speed)},"
        f" {1e-3 * float(power.drive) * speed:.5g} kW"
    )
    if power.output is not None and abs(float(power.output)) > 0:
        at = names.index(str(power.output_shaft))
        out = -float(power.output * power.speed[at])
        lines.append(
            f"out by shaft {power.output_shaft}: {abs(float(power.output)):.5g} N m at"
            f" {rpm(power.speed[at])}, {1e-3 * out:.5g} kW"
        )
    losses = {"meshes": float(power.loss), "bearings": bearing_loss(run)}
    shown = [f"{k} {v:.4g} W" for k, v in losses.items() if v is not None and v > 1e-6]
    return [*lines, *([f"losses: {', '.join(shown)}"] if shown else [])]


def _of_case(run: ShaftRun) -> str:
    """Return in brackets the case of which numbers are; empty without cases."""
    return f" ({run.shown_case})" if run.shown_case else ""


def _shafts(run: ShaftRun) -> Grid:
    states = run.solution.shafts
    bent = [np.linalg.norm(s.displacement[:, :2], axis=1).max() for s in states]
    # Rounded to 1 µN m, so that a shaft without load does not show round-off.
    moment = [np.linalg.norm(s.moment, axis=1).max().round(6) for s in states]
    where = [s.position[np.linalg.norm(s.moment, axis=1).argmax()] for s in states]
    return Grid(
        [
            Column("shaft", [line.name for line in run.task.system.shafts]),
            Column("speed", [float(s.speed) for s in states], ["rad/s"] * len(bent)),
            Column("deflection", bent, "m", ".2f"),
            Column("bending moment", moment, "N m", ".4g"),
            Column("at", where, "m", ".1f", (1e3, "mm")),
        ],
        f"largest of each shaft{_of_case(run)}",
    )


def _wheels(run: ShaftRun) -> Section:
    meshes = run.solution.power.meshes
    if not meshes:
        return []
    widths = [
        getattr(run.task.system.wheel(mesh.wheel), "face_width", None)
        for mesh in meshes
    ]
    across = [
        None if width is None else abs(apart) * float(width)
        for width, apart in zip(widths, run.solution.misalignment, strict=True)
    ]
    angles = [
        float(apart) if np.any(mesh.line) else None
        for mesh, apart in zip(meshes, run.solution.misalignment, strict=True)
    ]
    force = np.array([mesh.force for mesh in meshes])
    columns = [
        Column("wheel", [mesh.wheel for mesh in meshes]),
        Column("mate", [mesh.mate or "-" for mesh in meshes]),
        Column("torque", [float(mesh.torque) for mesh in meshes], "N m", ".5g"),
        *(
            Column(f"F{axis}", force[:, k], "N", ".1f", NEWTONS)
            for k, axis in enumerate("xyz")
        ),
        Column("misalignment", angles, "rad", ".1f", _MICRO),
        *with_values(Column("over the face", across, "m", ".2f")),
    ]
    what = "torque on the shaft and force on the wheel, global axes"
    return [Grid(columns, f"{what}{_of_case(run)}")]


def _bearings(run: ShaftRun) -> Section:
    system, found = run.task.system, run.solution
    radial, axial, tilt = [], [], []
    for k, seat in enumerate(system.seats):
        frame = np.asarray(system.shaft(seat.shaft).frame)
        own = frame @ found.load[k, :3]
        radial.append(float(np.hypot(own[0], own[1])))
        axial.append(float(own[2]))
        tilt.append(float(np.linalg.norm(frame[:2] @ found.displacement[k, 3:])))
    pressure = [
        b.solution and float(np.max(b.solution.roller_pressure)) for b in run.bearings
    ]
    safety = [b.life and float(b.life.static_safety) for b in run.bearings]
    torque = [bearing.friction_torque for bearing in run.bearings]
    columns = [
        Column("bearing", [seat.name for seat in system.seats]),
        Column("", [_name(b) for b in run.bearings]),
        Column("shaft", [seat.shaft for seat in system.seats]),
        Column("radial", radial, "N", ".1f", NEWTONS),
        Column("axial", axial, "N", ".1f", NEWTONS),
        Column("tilt", tilt, "rad", ".3f"),
        Column("pressure", pressure, "Pa", ".3f", (1e-9, "GPa")),
        Column("C0/P0", safety, "1", ".3g", (1.0, "")),
        *with_values(
            Column("friction", torque, "N m", ".1f", (1e3, "N mm")),
            Column("clearance", [b.clearance for b in run.bearings], "m", ".1f"),
        ),
    ]
    told = [
        f"friction of {b.name}: {series_words(b.oil.skf)}"
        for b in run.bearings
        if b.oil is not None and b.oil.skf is not None and b.oil.skf.assumed
    ]
    words = "load of the shaft on the inner ring; axial along its shaft"
    return [Grid(columns, f"{words}{_of_case(run)}"), *told]


def _temperatures(run: ShaftRun) -> Section:
    state = run.thermal
    if state is None:
        return []
    celsius = [np.asarray(t) - 273.15 for t in (state.inner_ring, state.outer_ring)]
    columns = [
        Column("bearing", [seat.name for seat in run.task.system.seats]),
        Column("inner ring", celsius[0], ["°C"] * len(celsius[0]), ".1f"),
        Column("outer ring", celsius[1], ["°C"] * len(celsius[1]), ".1f"),
        Column("friction", np.asarray(state.friction), "W", ".4g"),
    ]
    parts: list[Part] = [Grid(columns, f"in equilibrium with friction{_of_case(run)}")]
    if run.task.heat is not None and run.task.heat.housing is not None:
        parts.append(f"housing and oil: {float(state.housing) - 273.15:.1f} °C")
    if float(state.slowest) > 0:
        parts.append(
            "the slowest disturbance decays in"
            f" {1.0 / float(state.slowest) / 60.0:.3g} min"
        )
    times = run.task.times
    if run.warming is not None and times is not None:
        at = np.unique(np.linspace(0, len(times) - 1, _TIMES).round().astype(int))
        columns = [Column("time", times[at], ["s"] * len(at), ".4g")]
        for name, warm in run.warm_nodes.items():
            shown = warm[at] - 273.15
            columns.append(Column(name, shown, ["°C"] * len(at), ".1f"))
        parts.append(Grid(columns, f"warming up from the cold{_of_case(run)}"))
    return parts


def _name(bearing: Any) -> str:
    scene = bearing.scene
    if scene is None:
        return "springs"
    if scene.catalogue is not None:
        return scene.catalogue.entry.designation
    return str(scene.inputs["bearing"].get("type", "")).replace("_", " ")


def _lives(run: ShaftRun) -> Section:
    system, rows = run.task.system, []
    if run.duty is not None:
        hours = run.hours
        safety = [
            None if np.isnan(of).all() else float(np.nanmin(of))
            for of in run.duty.lives["static_safety"].T
        ]
        most = [
            None if np.isnan(of).all() else float(np.nanmax(of))
            for of in run.duty.peak_pressure.T
        ]
        rows = [
            Column("bearing", [seat.name for seat in system.seats]),
            Column("life", hours, "h"),
            Column("worst case", ["-" if w is None else w for w in run.worst_cases]),
            Column("least C0/P0", safety, "1", ".3g", (1.0, "")),
            Column("most pressure", most, "Pa", ".3f", (1e-9, "GPa")),
        ]
        if run.rings is not None:
            warm = np.nanmax(run.rings, axis=(0, 2)) - 273.15
            rows.append(Column("warmest ring", warm, ["°C"] * len(warm), ".1f"))
        title = f"under all {len(run.task.cases)} cases, one after the other"
    else:
        known = [b.life for b in run.bearings]
        turning = [
            0.0
            if b.scene is None or b.scene.speed is None
            else abs(float(b.scene.speed.inner)) * 3600.0 / (2.0 * np.pi)
            for b in run.bearings
        ]

        def hours_of(name):
            return [
                None
                if life is None or getattr(life, name) is None or not turns
                else float(getattr(life, name)) / turns
                for life, turns in zip(known, turning, strict=True)
            ]

        rows = [
            Column("bearing", [seat.name for seat in system.seats]),
            Column("basic, ISO 281", hours_of("basic_rating_life"), "h"),
            Column("reference, ISO/TS 16281", hours_of("reference_rating_life"), "h"),
        ]
        modified = Column("modified", hours_of("modified_rating_life"), "h")
        if with_values(modified):
            kappa = [life and life.viscosity_ratio for life in known]
            rows += [modified, Column("κ", kappa, "1", ".3g", (1.0, ""))]
        title = "rating lives" if any(turning) else "at rest: no lives in hours"
    over = [verdict and verdict.factor for verdict in run.verdicts]
    rows += with_values(Column("over required", over, "1", ".3g", (1.0, "")))
    parts: list[Part] = [Grid(rows, title)]
    for bearing, verdict in zip(run.bearings, run.verdicts, strict=True):
        if bearing.scene is not None and verdict is not None and not verdict.kept:
            words = verdict_in_words(bearing.scene.life, verdict)
            parts += [f"{bearing.name}: {line}" for line in words]
    together = run.system_hours
    if together is not None:
        parts.append(
            f"all bearings together, with the reliability of each:"
            f" {life_number(together)} h"
        )
    return parts


def _cases(run: ShaftRun) -> Section:
    duty, task = run.duty, run.task
    if duty is None:
        return []
    cases = range(min(CASES_SHOWN, len(task.cases)))
    columns = [Column("case", list(cases))]
    if all(case.hours is not None for case in task.cases):
        columns.append(Column("hours", [task.cases[k].hours for k in cases]))
    columns += [
        Column(
            key.replace("operating.", ""), [str(task.settings[k][key]) for k in cases]
        )
        for key in task.varied
    ]
    columns += [
        Column(
            seat.name,
            np.linalg.norm(duty.load[: len(cases), k, :3], axis=1),
            "N",
            ".0f",
            NEWTONS,
        )
        for k, seat in enumerate(task.system.seats)
    ]
    parts: list[Part] = [Grid(columns, "load of each bearing")]
    if len(task.cases) > CASES_SHOWN:
        parts.append(f"and {len(task.cases) - CASES_SHOWN} more; `--table` has all")
    return parts

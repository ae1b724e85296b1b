"""Skidding balls or rollers, as text."""

import numpy as np

from ...lubrication import Regime
from ...numerics.units import rpm, shown_count
from ...report.report_model import (
    DEGREES,
    NEWTONS,
    Column,
    Grid,
    Report,
    labelled_facts,
    load_text,
)
from ..bearing.credibility import credibility_section
from ..bearing.read_lubricant import TRACTIONS, describe_oil
from ..solve.report import by_ring, describe_row
from .output import at_balls, each_ball, rolling_cage_speed
from .run import SkidRun

_SMALL = 1e-6
"""Load over the largest one below which a contact counts as open."""


def skid_report(run: SkidRun) -> Report:
    """Return the readable report of skidding balls or rollers.

    Args:
        run: From `run_skid`, converged.
    """
    whole = _end(run) if run.task.steady else _motion(run)
    sections = {
        "Bearing and oil": [_bearing(run)],
        "Cage, torque and power" if run.task.steady else "Motion": whole,
        "Balls" if run.state else "Rollers": [_balls(run)],
        "Solution": [*_films(run), _convergence(run)],
        "Credibility": credibility_section(
            "skid", [("", run.task.model.element, run.task.scene.load)]
        ),
    }
    return Report(sections, run.warnings)


def _bearing(run):
    task, model = run.task, run.task.model
    named = {kind: name for name, kind in TRACTIONS.items()}
    load = load_text(task.scene.load)
    speed, varies = task.speed, "" if task.loads is None else ", varying in time"
    return "\n".join(
        [
            *describe_row(model.bearing, task.name),
            f"load on the {task.scene.moving_ring} ring: {load or 'none'}{varies};"
            f" inner ring {rpm(speed.inner)}, outer ring {rpm(speed.outer)}",
            f"{task.oil} at {describe_oil(model.lubricant, float(model.temperature))};"
            f" traction: {named[type(model.traction)]}",
        ]
    )


def _cage(speed, rolling):
    slip = f", slip {100.0 * (1.0 - speed / rolling):.3g} %" if rolling else ""
    text = f"{speed:.6g} rad/s ({rpm(speed)}); pure rolling {rolling:.6g} rad/s{slip}"
    return "cage", text


def _torque(run, torque, when=""):
    speed = run.task.speed
    faster = abs(float(speed.outer)) > abs(float(speed.inner))
    value, ring = f"{1e3 * _clean(torque):.5g} N mm", "outer" if faster else "inner"
    text = f"{value} on the {ring} ring{when} (of sliding and drag alone)"
    return "friction torque", text


def _mean_torque(run):
    mean, orbits = run.found.mean_friction_torque
    last = float(run.found.friction_torque[-1])
    if not orbits:
        return _torque(run, last, " at the end, within the first orbit of the cage")
    many = "orbit" if orbits == 1 else f"{orbits} orbits"
    now = f"; at the end {1e3 * _clean(last):.5g} N mm"
    return _torque(run, mean, f", mean of the last {many} of the cage{now}")


def _end(run):
    found, power = run.found, run.found.power
    rows = [
        _cage(float(found.cage_speed), float(rolling_cage_speed(run))),
        _torque(run, found.friction_torque),
        (
            "power",
            f"drive {_clean(power.drive):.5g} W = contacts"
            f" {_clean(power.contacts):.5g} W + drag {_clean(power.drag):.5g} W + cage"
            f" {_clean(power.cage):.5g} W",
        ),
    ]
    if hasattr(found, "cage_force"):
        least, most = (
            float(f) for f in (found.cage_force.min(), found.cage_force.max())
        )
        words = f"pushes with up to {most:.4g} N, holds back with up to {-least:.4g} N"
        rows.append(("cage on a roller", words))
    elif len(found.azimuth) > 1:
        play = float(run.task.model.cage.pocket_clearance)
        words = f"{1e6 * float(found.wander):.4g} µm about even motion;"
        rows.append(("balls wander", f"{words} pocket clearance {1e6 * play:.4g} µm"))
    return [labelled_facts(rows)]


def _motion(run):
    found = run.found
    work, slip = found.work, found.slip
    kinetic, potential = (
        float(energy[-1] - energy[0])
        for energy in (found.kinetic_energy, found.potential_energy)
    )
    when, _ = np.unravel_index(np.argmax(np.abs(slip)), slip.shape)
    force, kind = np.abs(found.cage_force), "ball" if run.state else "roller"
    pressed = 100.0 * np.mean(force > 0)
    cage = float(found.cage_speed[-1]), float(rolling_cage_speed(run)[-1])
    rows = [
        _cage(*cage),
        _mean_torque(run),
        (
            "work",
            f"of the drive {_clean(work.drive[-1]):.5g} J ="
            f" contacts {_clean(work.contacts[-1]):.5g} J + drag"
            f" {_clean(work.drag[-1]):.5g} J + motion {_clean(kinetic):.5g} J"
            f" + pockets and weights {_clean(potential):.5g} J",
        ),
        (
            "slip",
            f"of a {kind} at most {100.0 * np.abs(slip).max():.4g} %, at"
            f" {float(found.time[when]):.4g} s",
        ),
        (
            f"cage on a {kind}",
            f"{force.max():.4g} N at most; it touches its pocket for {pressed:.3g} % of"
            " the time",
        ),
    ]
    return [f"after {float(found.time[-1]):.4g} s:", labelled_facts(rows)]


def _balls(run):
    """Tabulate the final state of each ball or roller, or of one if all are alike."""
    found, steady = run.found, run.task.steady
    balls = run.state is not None
    alike = steady and len(found.azimuth) == 1
    rows = at_balls(run) if steady else slice(None)
    each = {n: (v if steady else v[-1])[rows] for n, v in each_ball(run).items()}
    azimuth = found.solution.azimuth if steady else each["azimuth"]
    load = each["contact_load"]
    small = _SMALL * load.max()
    columns = [
        Column("ball" if balls else "roller", range(len(azimuth))),
        Column("azimuth", azimuth % (2.0 * np.pi), "rad", ".1f", DEGREES),
        *by_ring("load", np.where(load > small, load, 0.0), "N", ".4g", NEWTONS),
        Column("slip", each["slip"], "1", ".3g", (100.0, "%")),
    ]
    if balls:
        pitch = np.arctan2(each["spin"][:, 1], -each["spin"][:, 2])  # spin, bearing
        columns.append(Column("pitch", np.round(pitch, 4), "rad", ".1f", DEGREES))
    else:
        cage = np.round(each["cage_force"], 1)
        columns.append(Column("cage", cage, "N", ".1f", NEWTONS))
    for name, what, *scale in (
        ("film", "film", "m", ".3g"),
        ("sliding", "sliding_speed", "m/s", ".4g", (1e3, "mm/s")),
        ("heat", "heat", "W", ".3g"),
    ):
        # An open contact has no meaningful film.
        columns += by_ring(name, np.where(load > small, each[what], np.nan), *scale)
    if alike:
        words = ["all"], ["-"]
        columns = [
            Column(c.name, w or c.values[:1], c.unit, c.format, c.shown)
            for c, w in zip(columns, (*words, *[None] * len(columns)), strict=False)
        ]
    return Grid(columns)


def _films(run):
    """Name the final lubrication regimes of the ball contacts."""
    if run.state is None:
        return []
    regime, load = run.state.regime, run.found.contact_load
    if not run.task.steady:
        regime, load = regime[-1], load[-1]
    regimes = np.unique(regime[load > _SMALL * load.max()])
    names = [Regime(int(r)).name.lower().replace("_", " and ") for r in regimes]
    return [f"films: {', '.join(names)}"]


def _convergence(run):
    found = run.found
    if run.task.steady:
        done = (
            f"converged in {shown_count(int(found.steps), 'step')}, residual"
            f" {float(found.residual):.1e} of the tractions"
        )
    else:
        missing = float(np.abs(found.imbalance).max())
        done = (
            f"integrated in {shown_count(int(found.steps), 'step')},"
            f" {int(found.rejected)} of them rejected; {missing:.1e} J of the work not"
            " accounted for"
        )
    return done


def _clean(value):
    """Remove the sign of a zero."""
    return float(value) + 0.0

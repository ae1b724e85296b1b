"""Balls that skid, as text for people."""

import numpy as np

from ..element.frame import LOADS
from ..lubrication import Regime
from .lubricant_table import TRACTIONS, described
from .report import ball_row
from .skid_output import at_balls, each_ball, rolling_cage_speed
from .skid_run import SkidRun

_RULE = "-" * 78
_RPM = 30.0 / np.pi


def skid_report(run: SkidRun) -> str:
    """Readable report of balls that skid.

    Args:
        run: From `run_skid`, converged.
    """
    parts = [_bearing(run), _whole(run), _balls(run), _ending(run)]
    return f"\n{_RULE}\n".join(parts)


def _bearing(run):
    task, model = run.task, run.task.model
    named = {kind: name for name, kind in TRACTIONS.items()}
    load = ", ".join(
        f"{name} {value:.5g} {'N' if name[0] == 'F' else 'N m'}"
        for name, value in zip(LOADS, task.scene.load, strict=True)
        if value
    )
    speed = task.speed
    return "\n".join(
        [
            *ball_row(model.bearing, task.name),
            f"load on the {task.scene.moving_ring} ring: {load or 'none'};"
            f" inner ring {_rpm(speed.inner)}, outer ring {_rpm(speed.outer)}",
            f"{task.oil} at {described(model.lubricant, float(model.temperature))};"
            f" traction: {named[type(model.traction)]}",
        ]
    )


def _rpm(speed):
    return f"{float(speed) * _RPM:.5g} rpm"


def _whole(run):
    found, power = run.found, run.found.power
    rolling, speed = rolling_cage_speed(run), float(found.cage_speed)
    slip = f", slip {100.0 * (1.0 - speed / rolling):.3g} %" if rolling else ""
    play = float(run.task.model.cage.pocket_clearance)
    lines = [
        f"cage            {speed:.6g} rad/s ({_rpm(speed)}); pure rolling"
        f" {rolling:.6g} rad/s{slip}",
        f"friction torque {1e3 * _clean(found.friction_torque):.5g} N mm on the inner"
        " ring",
        f"power           drive {_clean(power.drive):.5g} W = contacts"
        f" {_clean(power.contacts):.5g} W + drag {_clean(power.drag):.5g} W + cage"
        f" {_clean(power.cage):.5g} W",
    ]
    if len(found.azimuth) > 1:
        lines.append(
            f"balls wander    {1e6 * float(found.wander):.4g} µm about even motion;"
            f" pocket clearance {1e6 * play:.4g} µm"
        )
    return "\n".join(lines)


def _balls(run):
    """A line for each ball, or one where all move alike."""
    places = at_balls(run)
    alike = len(run.found.azimuth) == 1
    balls = {name: values[places] for name, values in each_ball(run).items()}
    angle = np.rad2deg(run.found.pitch_angle[places])
    azimuth = np.rad2deg(run.found.solution.azimuth) % 360.0
    pairs = "".join(f"{name:>18}" for name in ("film, µm", "sliding, mm/s", "heat, W"))
    sides = f"{'outer':>9}{'inner':>9}"
    lines = [
        f"  ball azimuth{'load, N':>18}    slip  pitch{pairs}",
        f"{'deg':>14}{sides}{'%':>8}{'deg':>7}{3 * sides}",
    ]
    for k in range(1 if alike else len(places)):
        where = "   all       -" if alike else f"{k:6d}{azimuth[k]:8.1f}"
        load, film = balls["contact_load"][k], 1e6 * balls["film"][k]
        slide, heat = 1e3 * balls["sliding_speed"][k], balls["heat"][k]
        after = "".join(f"{v:9.3g}" for v in (*film, *slide, *heat))
        lines.append(
            f"{where}{load[0]:9.4g}{load[1]:9.4g}{100.0 * balls['slip'][k]:8.3g}"
            f"{angle[k]:7.1f}{after}"
        )
    return "\n".join(lines)


def _ending(run):
    found = run.found
    regimes = np.unique(run.state.regime)
    names = [Regime(int(r)).name.lower().replace("_", " and ") for r in regimes]
    return "\n".join(
        [
            f"films: {', '.join(names)}",
            f"converged in {int(found.steps)} steps, residual"
            f" {float(found.residual):.1e} of the tractions",
            *(f"warning: {text}" for text in run.warnings),
        ]
    )


def _clean(value):
    """No minus before a zero."""
    return float(value) + 0.0

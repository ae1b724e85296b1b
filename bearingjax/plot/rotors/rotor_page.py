"""One page on a rotor with the results of its scene."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...rotor import STATION_FREEDOMS
from ...rotor.nonlinear import envelope, spectra_over_time
from ..style import Figure, head, new_page
from .rotor import rotor_section
from .rotor_modes import campbell_diagram, mode_shapes
from .rotor_motion import orbits, waterfall, waveforms
from .rotor_response import linear_curve, response_curve, speed_curve

_ACROSS = 3
"""Number of pictures side by side."""
_LEAST_TIMES = 100
"""Least number of times for spectra of a run-up."""


def rotor_overview(run: Any, title: str = "") -> Figure:
    """Plot the rotor with available modes, Campbell diagram, response and motion.

    Args:
        run: Results of the scene of a rotor; parts that are `None` are not drawn.
        title: Head of the page; "Rotor" if empty.

    Returns:
        The figure, 16 inches wide.
    """
    drawn = [*_linear(run), *_response(run), *_transient(run)]
    rows = -(-len(drawn) // _ACROSS)
    figure = new_page(16.0, 5.0 + 4.6 * rows)
    grid = figure.add_gridspec(
        1 + rows, 6, height_ratios=[1.0] + rows * [1.0] if rows else [1.0]
    )
    rotor_section(run.rotor, figure.add_subplot(grid[0, :]))
    for k, draw in enumerate(drawn):
        row, place = divmod(k, _ACROSS)
        # The last row is filled by as many as there are.
        wide = 6 // min(_ACROSS, len(drawn) - row * _ACROSS)
        draw(figure.add_subplot(grid[1 + row, place * wide : (place + 1) * wide]))
    head(figure, title or "Rotor")
    return figure


def _linear(run) -> list[Callable]:
    drawn = []
    if run.modes is not None:
        drawn.append(lambda ax: mode_shapes(run.rotor, run.modes, ax))
    if run.campbell is not None:
        drawn.append(
            lambda ax: campbell_diagram(
                run.task.campbell, run.campbell, run.critical, ax
            )
        )
    return drawn


def _response(run) -> list[Callable]:
    found, task = run.response, run.task.response
    if found is None or not len(found.frequency):
        return []
    freedom = STATION_FREEDOMS.index(task.coordinate)
    amplitude = np.asarray(found.amplitude)[:, task.station, freedom]
    unit = "um" if freedom < 3 else "mrad"
    where = f"{task.coordinate} at station {task.station}"
    largest = int(np.nanargmax(amplitude))
    hertz = float(found.frequency[largest]) / (2.0 * np.pi)
    at_peak = np.asarray(found.displacement)[largest]

    def curve(ax):
        if found.branch is None:
            linear_curve(found.frequency, amplitude, ax, unit=unit)
        else:
            response_curve(found.branch, amplitude, ax, unit=unit)
        method = found.method.replace("_", " ")
        ax.set_title(f"Response of {where}, {method}")

    def paths(ax):
        orbits(at_peak[:, [task.station], :2], ax, names=(f"station {task.station}",))
        ax.set_title(f"Orbits at {hertz:.4g} Hz")

    def waves(ax):
        waveforms(at_peak[:, task.station, :3], ax, names=STATION_FREEDOMS[:3])
        ax.set_title(f"Waveforms at {hertz:.4g} Hz")

    return [curve, paths, waves]


def _transient(run) -> list[Callable]:
    found, task = run.transient, run.task.transient
    if found is None or found.n_reached < 2:
        return []
    n = int(found.n_reached)
    time, speed = np.asarray(found.time)[:n], np.asarray(found.speed)[:n]
    freedom = STATION_FREEDOMS.index(task.coordinate)
    station = np.asarray(found.displacement)[:n, task.station]
    motion, unit = station[:, freedom], "um" if freedom < 3 else "mrad"
    name = f"{task.coordinate} at station {task.station}"
    drawn: list[Callable] = [
        lambda ax: waveforms(motion[:, None], ax, time=time, names=(name,), unit=unit)
    ]
    if np.ptp(speed) == 0.0:
        later = station[n // 2 :, None, :2]

        def paths(ax):
            orbits(later, ax, names=(f"station {task.station}",), closed=False)
            ax.set_title("Orbit, second half of the time")

        return [*drawn, paths]

    def draw_run_up(ax):
        speed_curve(
            *envelope(time, speed, motion), ax, unit=unit, names=(name,), title="Run-up"
        )

    drawn.append(draw_run_up)
    if n >= _LEAST_TIMES:
        spectra = spectra_over_time(time, speed, motion)
        drawn.append(lambda ax: waterfall(spectra, ax, unit=unit))
    return drawn

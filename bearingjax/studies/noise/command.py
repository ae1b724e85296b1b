"""`bearingjax noise`."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "noise",
        help="vibration and noise from form errors",
        description="The vibration of a bearing with the form errors of its"
        " [deviations] on the rig of its [vibration]: levels, bands, lines and what"
        " makes them.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    add_scene(command)
    command.add_argument(
        "--monte-carlo",
        metavar="N",
        type=int,
        help="also N random bearings, as [vibration.tolerance] has them scatter",
    )
    command.add_argument(
        "--wav",
        metavar="OUT",
        type=Path,
        help="write the acceleration along the sensor as sound (.wav)",
    )
    add_table(command, "time")
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Simulate the vibration of a bearing with form errors."""
    from ...files import SceneError
    from .output import noise_as_dict, noise_columns, write_noise_sound
    from .read import read_noise
    from .report import noise_report
    from .run import run_noise

    count = options.monte_carlo
    if count is not None and not 1 <= count <= 100_000:
        allowed = "it must be at least 1 and at most 100000"
        raise SceneError(f"--monte-carlo is {count}; {allowed}")
    task = read_noise(options.scene, options.set, bearings=count or 0)
    done = run_noise(task, tools.stage)
    solved = done.converged

    def write_sound(path):
        full = write_noise_sound(path, done)
        return f"{options.wav}: full scale is {full:.4g} m/s²"

    return Outcome(
        task.name,
        task.inputs,
        lambda: noise_as_dict(done),
        noise_report(done) if solved else None,
        (lambda: noise_columns(done)) if solved else None,
        {"Overview": picture("noise_overview", done, title=task.name)}
        if solved
        else {},
        sound=write_sound if solved else None,
        problems=[] if solved else [f"{done.result.label}: {done.message}"],
    )

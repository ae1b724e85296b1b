"""`bearingjax noise`."""

from pathlib import Path

from .options import add_plot, add_quiet, add_report, add_scene, add_table
from .outputs import Reporter, check_outputs, check_table, save, write
from .progress import stages
from .status import NOT_SOLVED, complain


def add(commands):
    """What may be written after it."""
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
    add_quiet(command, "progress")
    return command


def run(options) -> int:
    """Vibration of a bearing with form errors."""
    from ..scene import (
        SceneError,
        noise_columns,
        noise_report,
        read_noise,
        run_noise,
        write_noise_json,
        write_noise_sound,
    )
    from ..statics.sweep_table import write_columns

    check_table(options)
    _check_sound(options.wav)
    check_outputs(options)
    count = options.monte_carlo
    if count is not None and not 1 <= count <= 100_000:
        allowed = "it must be at least 1 and at most 100000"
        raise SceneError(f"--monte-carlo is {count}; {allowed}")
    task = read_noise(options.scene, options.set, bearings=count or 0)
    page = Reporter(options)
    with stages(options) as show:
        done = run_noise(task, show)
    full = []

    def draw(path, **format):
        from ..plot import noise_overview

        save(noise_overview(done, title=task.name), path, **format)

    text = noise_report(done) if done.converged else ""

    def tell(path):
        texts, draws = {"Vibration and noise": text}, {"Overview": draw}
        page(path, task.name, texts, task.inputs, draws)

    def tabulate(path):
        write_columns(noise_columns(done), path)

    def sound(path):
        full.append(write_noise_sound(path, done))

    solved = done.converged
    drawn = write(
        (options.json, lambda path: write_noise_json(path, done)),
        (options.table, tabulate if solved else None),
        (options.wav, sound if solved else None),
        (options.plot, draw if solved else None),
        (options.report, tell if solved else None),
    )
    if not solved:
        complain(f"{done.result.label}: {done.message}")
        return NOT_SOLVED
    print(text, flush=True)
    if full:
        print(f"{options.wav}: full scale is {full[0]:.4g} m/s²", flush=True)
    return drawn


def _check_sound(path: Path | None) -> None:
    from ..scene import SceneError

    if path is not None and path.suffix.lower() != ".wav":
        raise SceneError(f"{path}: a sound ends in .wav")

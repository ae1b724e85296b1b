"""`bearingjax noise`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture


def run(options: Namespace, tools: Tools) -> Outcome:
    """The vibration of a bearing with the form errors of its [deviations] on the rig of
    its [vibration]: levels, bands, lines and what makes them."""
    from ...files import SceneError
    from . import output
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
        full = output.write_noise_sound(path, done)
        return f"{options.wav}: full scale is {full:.4g} m/s²"

    return outcome_of(
        task.name,
        task.inputs,
        (done,),
        output.noise_as_dict,
        noise_report,
        output.noise_columns if solved else None,
        {"Overview": picture("noise_overview", done, title=task.name)},
        solved=solved,
        sound=write_sound if solved else None,
        problems=[] if solved else [f"{done.result.label}: {done.message}"],
    )

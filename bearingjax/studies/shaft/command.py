"""`bearingjax shaft`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture


def run(options: Namespace, tools: Tools) -> Outcome:
    """Equilibrium of the shafts of a scene on their bearings and in their housing,
    under gears, belts, forces and weight: load, tilt, pressure, static safety, rating
    life, friction and clearance of each bearing, deflection of the shafts, misalignment
    of the meshes; with [cases] the lives under a load spectrum."""
    from . import output, read, report
    from .run import run_shafts

    task = read.read_shafts(options.scene, options.set)
    done = run_shafts(task, tools.stage)
    return outcome_of(
        task.name,
        task.inputs,
        (done,),
        output.shafts_as_dict,
        report.shaft_report,
        output.shaft_columns if done.converged else None,
        {"Overview": picture("shaft_overview", done, title=task.name)},
        solved=bool(done.bearings),
        page=lambda: report.shaft_page(done),
        problems=[done.problem] if done.problem else [],
    )

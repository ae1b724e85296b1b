"""`bearingjax compare`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_json, add_report, add_set, add_table
from ..outcome import Outcome, Tools
from .solution_outcome import why_unsolved


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "compare",
        help="several designs side by side",
        description="Solve the bearings of several scene files, each for its load, and"
        " set results and inputs that differ side by side, the largest differences"
        " first.",
        epilog="A change of one scene: `bearingjax solve A.toml --set key=value --json"
        " b.json`, then `bearingjax compare A.toml b.json`. Exit status: 0 all"
        " solved, 2 bad input, 3 some not solved.",
    )
    command.add_argument("scenes", metavar="SCENE", nargs="+", help="two or more")
    add_json(command)
    add_set(command, "change all scenes alike")
    add_table(command, "result")
    add_report(command, "differences")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Solve and compare scenes."""
    from ...files import SceneError
    from ..bearing.read_scene import read_scene
    from .compare import compare_as_dict, compare_columns, compare_report, run_compare

    if len(options.scenes) < 2:
        raise SceneError("compare: give two scenes or more")
    scenes = [read_scene(source, options.set) for source in options.scenes]
    found = run_compare(scenes)
    named = list(zip(found.names, found.solved, strict=True))
    some = any(one.converged for one in found.solved)
    return Outcome(
        ", ".join(found.names),
        {f"{name}: {k}": v for name, one in named for k, v in one.scene.inputs.items()},
        lambda: compare_as_dict(found),
        compare_report(found, options.set) if some else None,
        (lambda: compare_columns(found, options.si)) if some else None,
        problems=[
            f"{name}: {why_unsolved(one)}" for name, one in named if not one.converged
        ],
    )

"""`bearingjax validate`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_json, add_plot, add_report, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "validate",
        help="published and independent numbers beside ours",
        description="Calculate the numbers of the validation cases and set them beside"
        " those published, measured or computed by others.",
        epilog="Exit status: 0 all as near as their cases ask for, 2 bad input, 3 some"
        " not.",
    )
    command.add_argument(
        "cases",
        metavar="CASE",
        nargs="*",
        help="name of a case, or a subject such as life; default: all",
    )
    command.add_argument("--list", action="store_true", help="list cases, run none")
    add_json(command)
    add_table(command, "number")
    add_plot(command, "write a picture of ours over theirs")
    add_report(command, "every number, its source and difference")
    command.set_defaults(scenes=[], set=[])
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Compare the numbers of cases."""
    from . import report
    from .run import compare_case, select_cases

    chosen = select_cases(options.cases)
    if options.list:
        return Outcome("Validation", {}, lambda: {}, report.case_list(chosen))
    found = []
    for place, case in enumerate(chosen):
        if tools.stage is not None:
            tools.stage(f"{place + 1} of {len(chosen)}: {case.name}", counts=True)
        found += compare_case(case)
    pairs = report.pairs_and_trust(found)
    return Outcome(
        "Validation",
        {},
        lambda: report.numbers(found),
        report.validation_report(found, single=len(chosen) == 1),
        lambda: report.columns(found),
        {"Ours over theirs": picture("validation_overview", *pairs)},
        page=lambda: report.validation_report(found, single=True),
        problems=[
            f"{one.case.name}: {one.number.name} differs by {100 * one.largest:.3g} %"
            for one in found
            if one.number.is_test and not one.kept
        ],
    )

"""`bearingjax validate`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, picture


def run(options: Namespace, tools: Tools) -> Outcome:
    """Calculate the numbers of the validation cases and set them beside those
    published, measured or computed by others."""
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

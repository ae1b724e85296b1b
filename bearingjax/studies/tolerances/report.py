"""Tolerance analysis of a scene as a report, as numbers in SI, and as a table."""

from typing import Any

import numpy as np

from ...decide import Spread
from ...decide.tolerance_effects import QUANTILES
from ...numerics.units import shown_change, shown_count, shown_number
from ...numerics.warning import Warning
from ...optimise import Constraint
from ...optimise.variable import rated_paths
from ...report.json_output import run_json
from ...report.report_model import Column, Grid, Part, Report
from .read import ToleranceTask
from .run import ToleranceRun

_STEP = 0.1
"""Change of a width, or of a middle, whose effect is reported, over the width [1]."""
_PERCENT = 100.0, "%"


def tolerance_report(task: ToleranceTask, run: ToleranceRun) -> Report:
    """Return the readable report."""
    found, scatters = run.found, task.given[2]
    head = (
        f"{task.scene.name}: {shown_count(len(found.result), 'sample')} of"
        f" {shown_count(len(scatters), 'number')} that scatter, each under"
        f" {shown_count(task.given[1].count, 'operating case')}"
    )
    rows = []
    for one, unit in zip(scatters, task.units, strict=True):
        values = (shown_number(x, unit) for x in (*one.ends, one.centre))
        rows.append((one.name, *values, shown_change(one.spread, unit)))
    numbers = Grid.of_rows(("number", "from", "to", "mean", "deviation"), rows)
    causes = [Column("number", [one.name for one in scatters])]
    for one in found.spreads:
        pairs = (one.name, one.shares), ("by gradient", one.first_order_shares)
        causes += [Column(word, x, "", ".3g", _PERCENT) for word, x in pairs]
    title = "share of the variance that each number causes alone"
    sections: dict[str, list[Part]] = {
        "Tolerances": [head, "", numbers],
        "Results": [_results(found.spreads)],
        "Causes": [Grid(causes, title)],
    }
    if found.misses is not None:
        sections["Requirements"] = _requirements(task, found)
    if run.narrower is not None:
        sections["Tightening"] = _tightening(task, run.narrower)
    return Report(sections, tolerance_warnings(task, run))


def tolerance_warnings(task: ToleranceTask, run: ToleranceRun) -> list[Warning]:
    """Return warnings of the scene, of unsolved samples, and of scattering numbers for
    which published ratings do not hold."""
    failed, n = int(np.count_nonzero(run.found.result)), len(run.found.result)
    words = f"{failed} of {n} samples were not solved; they count as misses"
    lost = [Warning("failed_samples", words, failed / n, 0.0)] if failed else []
    design, _, scatters, _ = task.given
    for one in scatters:
        if rated_paths(design, one.path):
            words = f"{one.name} scatters, on which load ratings depend: those of the"
            words += " standards stand in place of the published ones, which are of the"
            lost.append(Warning("ratings_dropped", f"{words} drawn size alone"))
    return [*task.scene.warnings, *run.found.warnings, *lost]


def tolerances_as_dict(task: ToleranceTask, run: ToleranceRun) -> dict[str, Any]:
    """Return the results as plain numbers and lists, in SI.

    Returns:
        "tolerances": of each measure mean, standard_deviation, quantiles, errors,
        first_order, misses, shares; "misses": share, error and derivatives by number;
        "numbers", "samples", "failed"; "tightening" if asked for; "warnings", "inputs",
        "version".
    """
    found, names = run.found, [one.name for one in task.given[2]]

    def by_name(values: Any) -> dict[str, float]:
        return dict(zip(names, values, strict=True))

    numbers: dict[str, Any] = {
        "tolerances": {
            _key(one): {
                "mean": one.mean,
                "standard_deviation": one.deviation,
                "quantiles": dict(zip(map(str, QUANTILES), one.quantiles, strict=True)),
                "errors": one.errors,
                "first_order": {
                    "mean": one.first_order[0],
                    "standard_deviation": one.first_order[1],
                    "shares": by_name(one.first_order_shares),
                    "slopes": by_name(one.slopes),
                },
                "misses": one.misses,
                "shares": by_name(one.shares),
            }
            for one in found.spreads
        },
        "numbers": {
            one.name: {"mean": one.centre, "standard_deviation": one.spread}
            for one in task.given[2]
        },
        "samples": len(found.result),
        "failed": np.count_nonzero(found.result),
    }
    for name, part in (("misses", found.misses), ("tightening", run.narrower)):
        if part is not None:
            numbers[name] = {
                k: by_name(v) if np.ndim(v) else v for k, v in vars(part).items()
            }
    return run_json(numbers, tolerance_warnings(task, run), task.inputs)


def tolerance_columns(task: ToleranceTask, run: ToleranceRun) -> dict[str, Any]:
    """Return the table with a row for each sample, columns by header, in SI."""
    found = run.found
    names = [one.name for one in task.given[2]] + [_key(x) for x in found.spreads]
    units = [*task.units, *(one.unit for one in found.spreads)]
    heads = [f"{n} [{u or '1'}]" for n, u in zip(names, units, strict=True)]
    return dict(zip(heads, np.hstack([found.samples, found.values]).T, strict=True))


def _key(spread: Spread) -> str:
    return spread.name.replace(" ", "_")


def _results(spreads) -> Grid:
    """Return quantiles and moments of each measure, and below those by the gradient."""
    rows = []
    for one in spreads:
        ends = [shown_number(x, one.unit) for x in one.quantiles]
        for name, first, moments in (
            (one.name, ends, (one.mean, one.deviation)),
            ("  by the gradient", [""] * len(ends), one.first_order),
        ):
            mean, deviation = moments
            last = shown_number(mean, one.unit), shown_change(deviation, one.unit)
            rows.append([name, *first, *last])
    heads = "", *(f"{100.0 * share:g} %" for share in QUANTILES), "mean", "deviation"
    title = "quantiles, mean and standard deviation of the samples"
    return Grid.of_rows(heads, rows, title)


def _requirements(task, found) -> list[Part]:
    misses, parts = found.misses, []
    for asked, one in zip(task.given[3], found.spreads, strict=True):
        if isinstance(asked, Constraint):
            words = asked.bounds_text(lambda x, unit=one.unit: shown_number(x, unit))
            parts.append(f"{one.name} {words}: {100.0 * one.misses:.3g} % miss it")
    parts.append(
        f"all requirements: {100.0 * misses.share:.3g} % miss one or several"
        f" (standard error {100.0 * misses.error:.2g} %)"
    )
    names = [one.name for one in task.given[2]]
    prices = [np.nan if x.cost is None else x.cost * x.width for x in task.given[2]]
    saved = misses.by_width / prices
    columns = [
        Column("number", names),
        Column("width", -_STEP * misses.by_width, "", "+.2g", _PERCENT),
        Column("error", _STEP * misses.errors, "", ".1g", _PERCENT),
        Column("middle", _STEP * misses.by_middle, "", "+.2g", _PERCENT),
        Column("saved by a unit of cost", saved, "", ".2g", _PERCENT),
    ]
    title = "change of that share with a tolerance a tenth narrower, and with its"
    parts += ["", Grid(columns, f"{title} middle a tenth of the width higher")]
    for words, gain in (("", misses.by_width), (" for its cost", np.nan_to_num(saved))):
        if gain.max(initial=0.0) > 0.0:
            first = names[gain.argmax()]
            parts.append(f"most is saved{words} by less width of {first}")
    return parts


def _tightening(task, narrower) -> list[Part]:
    rows = []
    given = zip(task.given[2], task.units, narrower.widths, strict=True)
    for one, unit, share in given:
        widths = (shown_change(x * one.width, unit) for x in (1.0, share))
        rows.append((one.name, *widths, f"{100.0 * share:.3g} %"))
    grid = Grid.of_rows(("number", "width", "narrower", "of that given"), rows)
    before, after, error = (
        f"{100.0 * x:.3g} %" for x in (narrower.before, narrower.after, narrower.error)
    )
    words = f"{before} before, {after} after (standard error {error})"
    asked = f"asked {100.0 * task.tighten.most_misses:g} %"
    missed = f"share that misses, in new samples: {words}, {asked}"
    return [grid, missed, f"cost {narrower.cost:.4g}"]

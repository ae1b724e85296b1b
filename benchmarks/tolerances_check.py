"""Are quantiles, misses and derivatives of `tolerances` those of brute force?

Brute force: five bearings on the seats of the scene tolerances_seats, their sizes drawn
by NumPy as plain random numbers, each bearing solved by itself with `solve_load` and
`rating_life`; means, deviations and quantiles compared over their standard errors.
Derivatives: of the share of bearings that miss the requirements of that scene, by the
width of each tolerance, beside differences of whole runs of the same samples with
widths a fifth larger and smaller. Many: 100 000 bearings beside single calls. Shafts: a
shaft whose near bearing bears most; its life is required, narrowing costs the same at
both, and `tighten` chooses.

README: brute force within 3.3 standard errors (five bearings, seven statistics of life
    and clearance); derivatives of the share within 0.8; on a shaft the tolerance of the
    bearing that bears most is narrowed (to 46 %, 22 % misses become 14 %); 131 072
    bearings on their seats in 32 CPU s, each in 0.011 of a single call | 4; 3 | yes

jax 0.10.1, float64, two cores shared with others: 690 CPU s in all.
"""

import tempfile
import time
from pathlib import Path

import numpy as np
from bench import benchmark

import bearingjax as bj
from bearingjax.decide import tighten
from bearingjax.decide.tolerance_effects import QUANTILES, Sampled
from bearingjax.optimise import Constraint
from bearingjax.optimise.variable import with_numbers
from bearingjax.studies.tolerances.read import read_tolerances

SCENE = "tolerances_seats"
BEARINGS = ("6208/C3", "6008/C3", "6308/C3", "NU 208 ECP/C3", "NU 1008 ML/C3")
RADIAL = ("operating.load.Fz=0 kN", "operating.free=['ux', 'uy']")
SHAFT = """
[drive]
speed = "1500 rpm"
power = "1 kW"

[shaft.s]
segments = [{ length = "200 mm", outer_diameter = "40 mm" }]

[load.pull]
position = "50 mm"
Fy = "-6 kN"

[coupling.out]

[bearings.near]
designation = "6208/C3"
position = "10 mm"

[bearings.far]
designation = "6208/C3"
position = "190 mm"
floating = true

[bearings.near.fit]
shaft = "k6"
housing = "H7"
housing_diameter = "120 mm"

[bearings.far.fit]
shaft = "k6"
housing = "H7"
housing_diameter = "120 mm"

[tolerances]
samples = 256
measures = [{ measure = "rating_life", of = "near" }]

[tolerances.numbers]
"bearings.near.fit.clearance" = { narrowing = { by = "5 um", costs = 1.0 } }
"bearings.far.fit.clearance" = { narrowing = { by = "5 um", costs = 1.0 } }
"""


def single(place, cases, paths, factors, support, options, values):
    """Life [h], largest pressure and clearance of one bearing."""
    numbers = dict(zip(paths, factors @ values, strict=True))
    speed = bj.Speed(float(cases.inner_speed[0]), 0.0)
    element = with_numbers(place, numbers).element_at(speed)
    given = {"speed": speed, "support": support, "options": options}
    solved = bj.solve_load(element, np.asarray(cases.load[0]), **given)
    life = bj.rating_life(element, solved, speed=speed)
    return float(life.life_hours), float(element.bearing.radial_internal_clearance)


def drawn(scatters, count, seed):
    source = np.random.default_rng(seed)
    return np.stack(
        [one.distribution.rvs(count, random_state=source) for one in scatters], axis=1
    )


def brute_force(name, count):
    """Largest deviation of all statistics of life and clearance [standard errors]."""
    more = RADIAL if name.startswith("NU") else ()
    settings = (f"bearing.designation='{name}'", *more)
    task = read_tolerances(SCENE, settings)
    place, cases, scatters, asked = task.given
    options = task.options | {"samples": max(64, 4 * count)}
    found = bj.tolerances(place, cases, scatters, asked, **options)
    paths = tuple(dict.fromkeys(p for one in scatters for p in one.path))
    factors = np.array([[s.path.get(p, 0.0) for s in scatters] for p in paths])
    fixed = cases, paths, factors, options["support"], options["solve"]
    samples = drawn(scatters, count, 11)
    values = np.array([single(place, *fixed, one) for one in samples])
    worst = 0.0
    for spread, column in zip(found.spreads, values.T, strict=True):
        theirs = np.array(
            [column.mean(), column.std(), *np.quantile(column, QUANTILES)]
        )
        again = np.random.default_rng(0).choice(column, (400, count))
        error = np.concatenate(
            [
                [again.mean(1).std(), again.std(1).std()],
                np.quantile(again, QUANTILES, axis=1).std(1),
            ]
        )
        ours = np.array([spread.mean, spread.deviation, *spread.quantiles])
        size = np.hypot(error, spread.errors)
        worst = max(worst, float(np.max(np.abs(ours - theirs) / size)))
    return worst


def derivatives(samples):
    """Differences of both derivatives by widths [standard errors], and the numbers."""
    task = read_tolerances(SCENE)
    sampled = Sampled(*task.given, **task.options | {"samples": samples})
    misses = sampled.misses(*sampled.run())
    rows, step = [], 0.2
    for k, one in enumerate(sampled.scatters):
        missed = []
        for sign in (1.0, -1.0):
            widths = np.ones(len(sampled.scatters))
            widths[k] += sign * step
            _, values, result = sampled.run(widths)
            lost = np.any([b.are_missed(values) for b in sampled.bounds], axis=0)
            missed.append((lost | (result != 0)).astype(float))
        sets = [part.mean() for part in np.split(missed[0] - missed[1], 8)]
        change = np.mean(sets) / (2.0 * step)
        error = np.hypot(np.std(sets, ddof=1) / 8**0.5 / (2.0 * step), misses.errors[k])
        off = abs(misses.by_width[k] - change) / max(error, 1e-12)
        rows.append([one.name, float(misses.by_width[k]), float(change), float(off)])
    return rows, misses


def many(samples, singles):
    """Time of many bearings on their seats, with misses and causes, beside single
    solves and lives of the same bearing, in a call of each [s of the processor]."""
    task = read_tolerances(SCENE)
    options = task.options | {"samples": samples}
    bj.tolerances(*task.given, **options)  # compiles
    begun = time.process_time()
    found = bj.tolerances(*task.given, **options)
    used, count = time.process_time() - begun, len(found.result)
    place, cases, scatters, _ = task.given
    paths = tuple(dict.fromkeys(p for one in scatters for p in one.path))
    factors = np.array([[s.path.get(p, 0.0) for s in scatters] for p in paths])
    fixed = cases, paths, factors, options["support"], options["solve"]
    begun = time.process_time()
    for values in drawn(scatters, singles, 12):
        single(place, *fixed, values)
    alone = (time.process_time() - begun) / singles
    return {"samples": count, "cpu_s": used, "ratio": used / count / alone}


def on_a_shaft():
    """Widths that `tighten` leaves the tolerances of both bearings of a shaft."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "shaft.toml")
        path.write_text(SHAFT, "utf-8")
        task = read_tolerances(path)
    design, cases, scatters, (life,) = task.given
    found = bj.tolerances(design, cases, scatters, [life], **task.options)
    limit = float(np.quantile(found.values[:, 0], 0.2))
    asked = [Constraint(life, lower=limit)]
    done = tighten(design, cases, scatters, asked, 0.16, **task.options)
    return {
        "widths": dict(zip([s.name for s in scatters], done.widths, strict=True)),
        "before": done.before,
        "after": done.after,
        "converged": done.converged,
    }


def wrong(found):
    if max(found["brute force"].values()) > 4.0:
        return "brute force gives other numbers"
    if max(row[-1] for row in found["derivatives"]) > 3.0:
        return "derivatives of the share are not those of differences"
    widths = found.get("shaft", {}).get("widths")
    if (
        widths
        and not widths["bearings.near.fit.clearance"]
        < 0.9
        < widths["bearings.far.fit.clearance"]
    ):
        return "the tolerance of the wrong bearing is narrowed"
    return None


@benchmark("one bearing, few samples, no shaft", wrong=wrong)
def main(smoke=False, singles=1000, samples=8192):
    bj.keep_programs()
    begun = time.process_time()
    bearings = BEARINGS[:1] if smoke else BEARINGS
    forced = {one: brute_force(one, 40 if smoke else singles) for one in bearings}
    rows, misses = derivatives(256 if smoke else samples)
    found = {
        "brute force": forced,
        "share": misses.share,
        "smoothed": misses.smoothed,
        "derivatives": rows,
        "many": many(256 if smoke else 100_000, 4 if smoke else 100),
    }
    if not smoke:
        found["shaft"] = on_a_shaft()
    return found | {"cpu_s": time.process_time() - begun}

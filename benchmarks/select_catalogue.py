"""Which bearings of the whole catalogue fit, and are they those of single solves?

`select` of every bearing of the catalogue that carries a radial load (and, apart, one
with an axial part) at a speed, with oil and a required life: the first call, which
compiles a program for each kind, one with the programs stored, and one with them at
hand. Then random requirements (bore, load, speed, tilt, oil, life, static safety,
minimum load) for each type in turn; of each a part of the bearings that were solved is
solved alone by `solve_load` and `rating_life`: largest difference of the lives, and
whether the verdict is the same.

README: 2230 bearings, 1470 of them solved: 13 programs in 166 s of a processor that
others used too, 17 s where they are stored, then 13; 145 of 145 verdicts of 13 types
those of single solves, numbers within 4.1e-13 | 1e-9 | yes

Last run, beside other work:

first                     263.15 s  165.96 s CPU  1000 of 1470 fit
programs stored            26.39 s   17.08 s CPU  1000 of 1470 fit
programs at hand           16.75 s   13.38 s CPU  1000 of 1470 fit
with an axial load         83.47 s   65.42 s CPU   808 of 1298 fit
excluded under the radial load: {'Fz': 730, 'life_hours': 470, 'Fy': 30}
56 random requirements: 145 of 145 verdicts are those
of single solves, 4 at least of a type; within 4.1e-13
AMD EPYC, 2 cores; jax 0.10.1
"""

import sys
import tempfile
import time

import numpy as np
from bench import benchmark

import bearingjax as bj
from bearingjax.catalogue.entry import bearing_of_entry
from bearingjax.decide import Requirements
from bearingjax.life.life_warning import minimum_load

PART = 3
"""Bearings of a requirement that are solved alone."""

ONE_WAY = "angular_contact_ball", "tapered_roller"
"""Types whose radial load needs an axial one."""

OIL = bj.LifeConditions(viscosity=2e-5, contamination=0.4, required=2e4)


def requirements(rng, kind):
    """Random requirements that some bearing of a type keeps more often than not."""
    entries = [e for e in bj.catalogue_entries() if e.type == kind]
    bore = entries[rng.integers(len(entries))].bore
    size = 10.0 ** rng.uniform(-1.5, -0.3) * 1.5e7 * bore**2
    axial = size * rng.choice([0.3, 1.0] if kind in ONE_WAY else [0.0, 0.0, 0.2, 1.0])
    angle = rng.uniform(0.0, 2.0 * np.pi)
    load = [size * np.cos(angle), size * np.sin(angle), axial, 0.0, 0.0, 0.0]
    if kind == "toroidal_roller":  # it carries no axial load
        load[2] = 0.0
    load = [0.0, 0.0, size, 0.0, 0.0, 0.0] if "thrust" in kind else load
    speed = 2.0 * np.pi / 60.0 * 10.0 ** rng.uniform(2.0, 3.6)
    held = {"gx": rng.uniform(0.0, 5e-4), "gy": 0.0}
    life = bj.LifeConditions(
        viscosity=10.0 ** rng.uniform(-5.0, -4.0),
        contamination=rng.uniform(0.2, 0.8),
        required=10.0 ** rng.uniform(3.0, 5.0),
        reliability=float(rng.choice([0.9, 0.95, 0.99])),
    )
    bounds = {"bore": bore, "static_safety": rng.uniform(0.5, 4.0)}
    bounds |= {"load_ratio": 1.0} if rng.random() < 0.3 else {}
    cases = bj.Cases([load], prescribed=held, inner_speed=speed)
    return Requirements(cases, life, bounds, types=kind)


def solve_alone(asked, designation):
    """Numbers of a bearing by a solve of its own, and whether it fits."""
    element = bj.BearingElement(bearing_of_entry(bj.catalogue_entry(designation)))
    cases = asked.load
    held = {name: float(values[0]) for name, values in cases.prescribed.items()}
    support = bj.Support(prescribed=held)
    speed = bj.Speed(inner=float(np.max(cases.inner_speed)))
    found = bj.solve_load(
        element, cases.load[0], support=support, speed=speed, throw=False
    )
    if not bool(found.converged):
        return None, False
    life = bj.rating_life(element, found, asked.life)
    load = max(float(life.equivalent_load), float(life.reference_load))
    numbers = {
        "life_hours": float(life.life_hours),
        "basic_rating_life": float(life.basic_rating_life),
        "static_safety": float(life.static_safety),
        "load_ratio": load / float(minimum_load(element.bearing, life.ratings)),
    }
    least = {"life_hours": float(asked.life.required)}
    least |= {k: ends[0] for k, ends in asked.bounds.items() if k in numbers}
    return numbers, all(numbers[k] >= (1.0 - 1e-9) * low for k, low in least.items())


def whole(asked, what):
    """Print the time of a choice, and return it."""
    begin = time.perf_counter(), time.process_time()
    found = bj.select(asked)
    wall, used = time.perf_counter() - begin[0], time.process_time() - begin[1]
    solved = int(np.isfinite(found.table["rating_life"]).sum())
    print(f"{what:24}{wall:8.2f} s{used:8.2f} s CPU{len(found.fits):6} of {solved} fit")
    sys.stdout.flush()
    return found


def compare(asked):
    """Return the difference from single solves, verdicts that agree, and all."""
    table = bj.select(asked).table
    solved = np.flatnonzero(np.isfinite(table["rating_life"]))
    lost = np.flatnonzero(table["requirement"] == "solved")
    apart, same = [0.0], []
    for k in (*solved[:: max(1, solved.size // PART)], *lost[:1]):
        numbers, fits = solve_alone(asked, str(table["designation"][k]))
        unsolved = (numbers is None) == (k in lost)
        same.append(unsolved and fits == (table["requirement"][k] == ""))
        apart += [
            abs(table[n][k] / value - 1.0) for n, value in (numbers or {}).items()
        ]
    return max(apart), sum(same), len(same)


@benchmark(
    "deep groove balls, one random requirement",
    n="random requirements",
    alone="compare the random requirements alone",
)
def main(smoke, n=56, alone=False):
    kinds = ("deep_groove_ball",) if smoke else None
    with tempfile.TemporaryDirectory() as folder:
        loads = [[0.0, -4000.0, axial, 0.0, 0.0, 0.0] for axial in (0.0, 1000.0)]
        radial, both = (
            Requirements(bj.Cases([load], inner_speed=100.0), OIL, types=kinds)
            for load in loads
        )
        for what in () if alone else ("first", "programs stored"):
            bj.keep_programs(folder, few_calls=True)
            found = whole(radial, what)
        if not alone:
            whole(radial, "programs at hand")
            whole(both, "with an axial load")
            print(f"excluded under the radial load: {found.counts}")
        bj.keep_programs(folder, few_calls=True)
        every = kinds or sorted({entry.type for entry in bj.catalogue_entries()})
        rng, agreed = np.random.default_rng(0), {kind: [0, 0] for kind in every}
        worst = 0.0
        for k in range(1 if smoke else n):
            kind = every[k % len(every)]
            apart, *counts = compare(requirements(rng, kind))
            agreed[kind] = [a + b for a, b in zip(agreed[kind], counts, strict=True)]
            worst = max(worst, apart)
            print(f"{kind}: {agreed[kind]} within {apart:.1e}", file=sys.stderr)
        bj.keep_programs(keep=False)
    same, count = np.array([*agreed.values()]).T
    print(f"{n} random requirements: {same.sum()} of {count.sum()} verdicts are those")
    print(f"of single solves, {count.min()} at least of a type; within {worst:.1e}")
    return worst < 1e-9 and bool(np.all(same == count)) and count.min() > 0

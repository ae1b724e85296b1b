"""Does the half-space solver always find the pressure, or say why not?

Random rollers on planes: 1 to 1e6 N, straight, crowned and logarithmic profiles of any
depth; 8 x 8 to 64 x 128 cells, even and graded, and for one in ten 32 x 512, 512 x 32
or 512 x 512, even where there are 512 along; held upright, at a given tilt of up to 20
mrad, with a given moment (centre of pressure up to 0.98 of the half length, so that one
end carries all), or at a given approach and tilt. A problem counts as wrong if it
claims to be solved and gaps inside the contact, overlaps outside or the load, computed
anew, are off by more than the tolerance allows; one whose moment asks for a centre of
pressure beyond the last cells must say `no_load_path`.

README: 500 random rollers, 1 N to 1e6 N: all solved or a moment beyond the ends named,
at most 69 steps | 0 unsolved, 0 wrong | yes

Last run:

            steps  most  results
upright        16    69  127 solved
tilted         17    54  116 solved
moment         19    67  129 solved, 1 beyond the ends, and says so
approach       17    59  127 solved

not solved: 0 (goal 0); 162 s

AMD EPYC, 2 cores, load average 1.6; devices: 1 cpu; jax 0.10.1
"""

import collections

import jax.numpy as jnp
import numpy as np
from bench import benchmark, table, timed, verdict

import bearingjax as bj
from bearingjax.contact.halfspace import (
    even_grid,
    graded_grid,
    influence,
    solve_pressure,
)

MODULUS = 115.385e9
SIZES = ((8, 8), (16, 32), (35, 35), (35, 64), (64, 128))
LARGE = ((32, 512), (512, 32), (512, 512))
FEW = 0.1  # share of large ones
KINDS = ("upright", "tilted", "moment", "approach")
ALLOWED = 1e-9  # ten times the solver's tolerance
SMOKE = 12


def problem(rng, smoke):
    """Grid, gap, and what is given, of one random roller."""
    sizes = SIZES[:2] if smoke else LARGE if rng.random() < FEW else SIZES
    across, along = sizes[rng.integers(len(sizes))]
    length = 10 ** rng.uniform(-2.3, -1.3)
    radius = length * 10 ** rng.uniform(-1.2, 0.2)
    load = 10 ** rng.uniform(0, 6)
    half_width = 1.6 * np.sqrt(4 * load / length * radius / (np.pi * MODULUS))
    # A graded kernel of so many cells along is large.
    make = even_grid if along > 128 or rng.random() < 0.5 else graded_grid
    grid = make(length, half_width, across, along)
    place = 2 * np.asarray(grid.y) / length
    drop = (
        0 * place,
        10 ** rng.uniform(-6.5, -4) * place**2,
        -(10 ** rng.uniform(-6.5, -5)) * np.log(1 - np.abs(place) ** 3),
    )[rng.integers(3)]
    gap = np.asarray(grid.x)[:, None] ** 2 / (2 * radius) + drop
    tilt, off = 10 ** rng.uniform(-5, -1.7), rng.uniform(-0.98, 0.98)
    approach = 10 ** rng.uniform(-7, -4)
    kind = KINDS[rng.integers(len(KINDS))]
    given = {
        "upright": {"load": load},
        "tilted": {"load": load, "tilt": tilt},
        "moment": {"load": load, "moment": 0.5 * load * length * off},
        "approach": {"approach": approach, "tilt": tilt * rng.integers(2)},
    }[kind]
    return kind, grid, jnp.asarray(gap), given


def is_right(solution, given):
    """Complementarity and balance of a solution, computed anew."""
    pressure, distance = np.asarray(solution.pressure), np.asarray(solution.distance)
    if not pressure.any():
        return distance.min() >= 0
    area = np.asarray(solution.grid.area)
    displaced = distance - np.asarray(solution.problem.gap) + float(solution.approach)
    displaced = displaced + float(solution.tilt) * np.asarray(solution.grid.y)
    scale = np.sum(area * pressure * displaced) / np.sum(area * pressure)
    right = np.abs(distance[pressure > 0]).max() <= ALLOWED * scale
    right &= distance.min() >= -ALLOWED * scale and pressure.min() >= 0
    if "load" in given:
        right &= abs(float(solution.load) / given["load"] - 1) <= ALLOWED
    if "moment" in given:
        reach = given["load"] * 0.5 * float(solution.grid.edges[-1])
        right &= abs(float(solution.moment) - given["moment"]) <= ALLOWED * reach
    return bool(right)


def run(count, smoke=False, seed=0):
    """A row of figures for each kind of problem."""
    rng = np.random.default_rng(seed)
    found = {kind: collections.Counter() for kind in KINDS}
    steps = {kind: [0] for kind in KINDS}
    for _ in range(count):
        kind, grid, gap, given = problem(rng, smoke)
        solution = solve_pressure(influence(grid, MODULUS), gap, **given, throw=False)
        label = bj.Result(int(solution.result)).label
        reach = np.abs(np.asarray(grid.y)).max()
        beyond = abs(given.get("moment", 0.0)) > given.get("load", 1.0) * reach
        # Of a contact that its grid does not suit, the solver's task is the same.
        if label in ("converged", "grid_misfit"):
            steps[kind].append(int(solution.steps))
            label = "solved" if is_right(solution, given) and not beyond else "wrong"
        elif beyond and label == "no_load_path":
            label = "beyond the ends, and says so"
        found[kind][label] += 1
    return [
        {
            "kind": kind,
            "results": dict(found[kind]),
            "median_steps": float(np.median(steps[kind])),
            "most_steps": max(steps[kind]),
        }
        for kind in KINDS
    ]


def show(found):
    rows = [r | {"told": ", ".join(f"{n} {k}" for k, n in r["results"].items())}
            for r in found["rows"]]  # fmt: skip
    table(rows, {"": "{kind}", "steps": "{median_steps:.0f}", "most": "{most_steps:d}",
                 "results": "{told}"})  # fmt: skip
    print()
    print(verdict("not solved", found["unsolved"], 0))
    print(f"{found['seconds']:.0f} s")


@benchmark(f"{SMOKE} small ones", show, wrong=lambda f: f["unsolved"] and "not solved")
def main(smoke, count=500):
    seconds, rows = timed(lambda: run(SMOKE if smoke else count, smoke))
    good = "solved", "beyond the ends, and says so"
    told = [item for row in rows for item in row["results"].items()]
    bad = sum(n for label, n in told if label not in good)
    return {"rows": rows, "unsolved": bad, "seconds": seconds}

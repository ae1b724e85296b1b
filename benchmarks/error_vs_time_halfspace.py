"""What does an error cost in the pressure of half-spaces, with even and graded cells?

The tapered roller of method 004 (15 mm long, 10 and 12 mm thick, on a plane) at 3000 N,
whose sharp ends have an infinite pressure: cells over 15 x 0.3528 mm, of one length, or
shorter towards the ends (exponent 2). Only the half that symmetry leaves is kept.

Errors, relative: of the approach; of the pressure at x = 0, 0.5 mm from either end (the
larger error), and in the middle of the roller, by cubic interpolation between the
middles of cells, of the pressure times the root of the distance from the ends.
Reference: graded cells, exponent 2.5, with how much coarser ones
differ. Length: of the cell at the end, and of that in the middle. Time: a compiled
solve to 1e-10, kernel made before, shortest of the repeats.

README: sharp-ended taper: 35 x 64 graded cells are better than even 256 x 512 and take
a 119th of the time | a tenth of the time | yes

Last run:

                        worst relative error          cell, mm
cells              approach   0.5 mm in    middle     end  middle  steps       ms
even     17 x 16      9e-03       4e-02     7e-03  0.9375  0.9375     16     0.97
even     35 x 32      6e-03       1e-02     4e-03  0.4688  0.4688     23     2.06
even     35 x 64      3e-03       2e-03     2e-03  0.2344  0.2344     24     3.61
even     35 x 128     2e-03       3e-03     1e-03  0.1172  0.1172     26     7.03
even     35 x 256     9e-04       2e-03     6e-04  0.0586  0.0586     25    14.06
even     35 x 512     4e-04       1e-03     3e-04  0.0293  0.0293     26    36.46
even     35 x 1024    2e-04       6e-04     1e-04  0.0146  0.0146     26    85.36
even    256 x 512     5e-04       1e-03     3e-04  0.0293  0.0293     42   627.65
graded   17 x 16      3e-04       3e-04     1e-03  0.0664  1.8462     18     0.55
graded   17 x 32      2e-04       5e-03     7e-04  0.0156  0.9339     20     1.13
graded   35 x 32      1e-04       4e-03     3e-05  0.0156  0.9339     23     1.86
graded   35 x 48      2e-06       6e-04     1e-05  0.0068  0.6239     24     3.12
graded   35 x 64      4e-05       3e-04     3e-05  0.0038  0.4683     25     5.29
graded   35 x 128     7e-05       1e-04     4e-05  0.0009  0.2343     25    30.29
graded   65 x 128     1e-05       1e-04     2e-05  0.0009  0.2343     27    74.60

all errors below      1e-02    1e-03    3e-04
even, ms                3.6     85.4        -
graded, ms              0.6      0.6     30.3

time of even 256 x 512 over graded 35 x 48, no worse: 201 (at least 10): met
of even 35 x 512: 11.7
of even 35 x 1024: 27.4

reference: approach 6.32121 µm, at 0.5, 7.5, 14.5 mm 1299.00, 1104.12, 1206.77 MPa
coarser reference differs by 2e-05
AMD EPYC, 2 cores, load average 1.6; devices: 1 cpu; jax 0.10.1

35 x 64 graded cells are better in all errors than even 256 x 512 and 35 x 1024, at a
119th and a 16th of their time, and than even 35 x 512 at a 7th. 35 x 48, which the
lines above name, have 2e-6 in the approach by luck of signs.
"""

import functools

import jax.numpy as jnp
import numpy as np
from bench import benchmark, compiled, shuffled, subplots, table, verdict
from scipy.interpolate import CubicSpline
from strips_halfspace import HALF_WIDTH, LENGTH, LOAD, MODULUS, taper

from bearingjax.contact.halfspace import graded_grid, influence, solve_pressure

# Cells across and along.
FULL = {
    "even": (
        (17, 16),
        (35, 32),
        (35, 64),
        (35, 128),
        (35, 256),
        (35, 512),
        (35, 1024),
        (256, 512),
    ),
    "graded": ((17, 16), (17, 32), (35, 32), (35, 48), (35, 64), (35, 128), (65, 128)),
}
SMOKE = {"even": ((9, 16), (9, 32)), "graded": ((9, 16),)}
# Cells and exponent of the reference, and of what it is judged by.
REFERENCE = ((129, 384, 2.5), (89, 256, 2.5))
COARSE = ((9, 48, 2.5), (9, 32, 2.5))
ASKED = ("approach", "near_ends", "middle")
NAMES = ("approach", "0.5 mm from ends", "middle")
TARGETS = (1e-2, 1e-3, 3e-4)
GOAL = 10.0  # times cheaper than even cells that are as good
MODEL = (256, 512)  # the even cells that the goal is about
COLORS = {"even": "#D55E00", "graded": "#0072B2"}
PLACES = (0.5e-3, 7.5e-3, 14.5e-3)  # from the small end [m]


def answer(grid):
    """Compiled solve -> approach, pressure at x = 0, steps; seconds of compiling."""
    matrix, gap = influence(grid, MODULUS), taper().gap(grid)

    def solve(matrix, gap, load):
        found = solve_pressure(matrix, gap, load=load, throw=False)
        return found.approach, found.centre_pressure, found.steps, found.converged

    given = matrix, gap, jnp.asarray(LOAD)
    call, seconds = compiled(solve, *given)
    return functools.partial(call, *given), seconds


def values(grid, found):
    """Approach, and pressures at `PLACES`."""
    approach, pressure, steps, converged = found
    if not converged:
        raise RuntimeError(f"not converged in {int(steps)} steps")
    y = np.asarray(grid.edges[-1] - grid.y)[::-1]
    # Without its infinite ends, it is smooth.
    smooth = CubicSpline(y, _root(y) * np.asarray(pressure)[::-1])
    places = np.array(PLACES)
    return np.array([float(approach), *(smooth(places) / _root(places))])


def _root(y):
    """What the pressure is like near the ends, inverse."""
    return np.sqrt(y * (LENGTH - y))


def errors(got, want):
    """Of the approach, near the ends (the larger), in the middle."""
    approach, small, middle, large = np.abs(got / want - 1)
    found = (approach, max(small, large), middle)
    return {name: float(x) for name, x in zip(ASKED, found, strict=True)}


def reference(asked):
    """Values, and how much those of coarser cells differ."""
    found = []
    for across, along, grading in asked:
        grid = graded_grid(LENGTH, HALF_WIDTH, across, along, grading=grading)
        found.append(values(grid, answer(grid)[0]()))
    return found[0], max(errors(found[1], found[0]).values())


def study(sizes, want, rounds):
    """A row for each kind and number of cells."""
    calls, rows = {}, []
    for kind, asked in sizes.items():
        for across, along in asked:
            grading = 1.0 if kind == "even" else 2.0
            grid = taper().grid(HALF_WIDTH, across, along, grading=grading)
            call, seconds = answer(grid)
            found = call()
            half = 1e3 * np.asarray(grid.half_y)
            rows.append(
                {
                    "kind": kind,
                    "across": across,
                    "along": along,
                    **errors(values(grid, found), want),
                    "end_mm": 2 * float(half[0]),
                    "middle_mm": 2 * float(half[along // 2]),
                    "steps": int(found[2]),
                    "compile_s": seconds,
                }
            )
            calls[kind, across, along] = call
    times = shuffled(calls, rounds)
    for row in rows:
        row["ms"] = 1e3 * min(times[row["kind"], row["across"], row["along"]])
    return rows


def price(rows, kind, target):
    """Least time [ms] at which all errors are below a target; `None` if never."""
    good = [r for r in rows if max(r[a] for a in ASKED) <= target]
    return min((r["ms"] for r in good if r["kind"] == kind), default=None)


def advantage(rows):
    """Time of the even cells of the goal over that of graded ones that are no worse in
    anything, and these."""
    model = next((r for r in rows if (r["across"], r["along"]) == MODEL), rows[0])
    good = [
        r
        for r in rows
        if r["kind"] == "graded" and all(r[a] <= model[a] for a in ASKED)
    ]
    if not good:
        return 0.0, None
    best = min(good, key=lambda r: r["ms"])
    return model["ms"] / best["ms"], best


def show(rows, want, doubt):
    print("worst relative error of approach and pressure; size of cells, mm")
    table(rows, {
        "cells": "{kind}", "": "{across} x {along}", "approach": "{approach:.0e}",
        "0.5 mm in": "{near_ends:.0e}", "middle": "{middle:.0e}", "end, mm":
        "{end_mm:.4f}", "middle, mm": "{middle_mm:.4f}", "steps": "{steps:d}",
        "ms": "{ms:.2f}",
    })  # fmt: skip
    print(f"\n{'all errors below':18}" + "".join(f"{t:>9.0e}" for t in TARGETS))
    for kind in dict.fromkeys(r["kind"] for r in rows):
        prices = [price(rows, kind, target) for target in TARGETS]
        told = ["-" if p is None else f"{p:.1f}" for p in prices]
        print(f"{kind + ', ms':18}" + "".join(f"{p:>9}" for p in told))
    ratio, best = advantage(rows)
    print()
    what = f"time of even {MODEL[0]} x {MODEL[1]} over graded "
    if best is not None:
        what += f"{best['across']} x {best['along']}, no worse"
    print(verdict(what, ratio, GOAL, most=False))
    for row in rows:
        if best is None or (row["kind"], row["across"]) != ("even", best["across"]):
            continue
        if row["along"] >= MODEL[1]:
            ratio = row["ms"] / best["ms"]
            print(f"of even {row['across']} x {row['along']}: {ratio:.3g}")
    print(
        f"\nreference: approach {1e6 * want[0]:.5f} µm, at 0.5, 7.5, 14.5 mm "
        + ", ".join(f"{1e-6 * p:.2f}" for p in want[1:])
        + f" MPa\ncoarser reference differs by {doubt:.0e}"
    )


def plot(rows, *_):
    """Error against time, one panel for each quantity."""
    figure, axes = subplots(1, 3, figsize=(11, 4), sharex=True, sharey=True)
    for axis, asked, name in zip(axes, ASKED, NAMES, strict=True):
        for kind in dict.fromkeys(r["kind"] for r in rows):
            mine = [r for r in rows if r["kind"] == kind]
            axis.loglog(
                [r["ms"] for r in mine],
                [r[asked] for r in mine],
                "o",
                color=COLORS[kind],
                markersize=5,
                label=f"{kind} cells",
            )
            for r in mine:
                axis.annotate(
                    f"{r['across']}×{r['along']}",
                    (r["ms"], r[asked]),
                    # Graded ones lie below: there is room.
                    xytext=(4, 3) if kind == "even" else (-3, -4),
                    ha="left" if kind == "even" else "right",
                    va="bottom" if kind == "even" else "top",
                    textcoords="offset points",
                    fontsize=6.5,
                    color=COLORS[kind],
                )
        axis.set_title(name[0].upper() + name[1:], loc="left")
        axis.set_xlabel("time of a solve, ms")
    spent = [r["ms"] for r in rows]
    axes[0].set_xlim(0.2 * min(spent), 5 * max(spent))
    axes[0].set_ylabel("relative error")
    axes[0].legend(frameon=False)
    return figure


@benchmark("few cells", show, plot)
def main(smoke):
    want, doubt = reference(COARSE if smoke else REFERENCE)
    return study(*((SMOKE, want, 2) if smoke else (FULL, want, 9))), want, doubt

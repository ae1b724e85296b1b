"""What does a quadrature node buy? Error of force and stiffness against nodes.

Random bearings of the test oracle, cylindrical and tapered, reduced to three rollers:
crowned, logarithmic, and flat and arc (its kinks make three panels); rings tilted, and
at least one loaded roller touches on less than 95 % of a raceway. The reference is the
oracle's own: Gauss-Legendre nodes graded to the ends of every loaded interval.

Errors: of the force relative to the largest force (moments: to the largest moment); of
the stiffness entries K_ij relative to sqrt(K_ii K_jj). Time: one jitted call of
`evaluate`, minimum of repeats, mean over the kinds of bearing. Nodes count per panel.
A full run takes five minutes: it compiles 78 programs.

README: 32 contact-mapped nodes: 2e-9 in force, 3e-9 in stiffness, worst case; 20 000
slices: 3e-7 and 6e-5 | 1e-6; 1e-5 | yes

Last run:

                         force         stiffness       worst force, by kind
rule           nodes   worst  median   worst  median  crowned     log.     flat time, µs
midpoint          10   4e-01   3e-02   5e-01   7e-02    1e-01    4e-01    3e-01      206
midpoint          20   1e-01   7e-03   3e-01   4e-02    9e-02    1e-01    5e-02      191
midpoint          30   7e-02   1e-03   1e-01   3e-02    4e-02    7e-02    3e-02      195
midpoint         100   7e-03   2e-04   3e-02   7e-03    7e-03    5e-03    3e-03      243
midpoint         300   6e-04   2e-05   1e-02   2e-03    5e-04    6e-04    1e-04      376
midpoint        1000   2e-04   1e-06   2e-03   6e-04    6e-05    2e-04    3e-05      728
midpoint       20000   3e-07   3e-09   6e-05   2e-05    1e-07    3e-07    1e-08    11592
contact mapped     8   5e-04   2e-06   9e-05   1e-05    4e-05    5e-04    8e-06      371
contact mapped    12   3e-05   4e-09   4e-06   7e-07    5e-07    3e-05    5e-08      365
contact mapped    16   3e-06   4e-11   4e-07   1e-07    1e-09    3e-06    3e-10      327
contact mapped    24   2e-08   3e-13   2e-08   7e-09    2e-11    2e-08    4e-12      371
contact mapped    32   2e-09   4e-14   3e-09   1e-09    2e-11    2e-09    5e-12      374
contact mapped    48   2e-11   3e-14   9e-10   8e-11    2e-11    5e-12    5e-12      406

36 bearings of 3 rollers; AMD EPYC

Goal of 32 mapped nodes: 1e-6 in force, 1e-5 in stiffness.
"""

import time
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, subplots, table
from from_oracle import bearing
from oracle import build, evaluate, graded, midpoint_slices, raceway, random_case, rows
from test_against_oracle import errors

import bearingjax as bj

PROFILES = {
    "circular": "crowned",
    "logarithmic": "logarithmic",
    "crowned_ends": "flat and arc",
}
HEADS = {"crowned": "crowned", "logarithmic": "log.", "flat and arc": "flat"}
KINDS = ("cylindrical", "tapered")
NODES = {
    "midpoint": (10, 20, 30, 100, 300, 1000, 20000),
    "contact mapped": (8, 12, 16, 24, 32, 48),
}
SMOKE = {"midpoint": (20, 300), "contact mapped": (16, 32)}
RULES = {"midpoint": bj.numerics.Midpoint, "contact mapped": bj.numerics.ContactMapped}
COLORS = {"midpoint": "#D55E00", "contact mapped": "#0072B2"}
WHICH = ("worst", "median")
ROLLERS = 3
PARTLY = 0.95  # share of the length below which a contact is partly loaded


def loaded_share(truth, q, motions):
    """Smallest share of a raceway's length that touches, of the contacts that do."""
    s, _ = midpoint_slices(truth.roller_length, 1000)
    shares = [1.0]
    for roller, y in enumerate(motions):
        azimuth = truth.first_azimuth + 2 * np.pi * roller / truth.n_rollers
        cos, sin = np.cos(azimuth), np.sin(azimuth)
        for ring, drop in enumerate((truth.drop_outer, truth.drop_inner)):
            ux, uy, uz, gx, gy, _ = q[6 * ring : 6 * ring + 6]
            rings = np.array([uz, ux * cos + uy * sin, gy * cos - gx * sin])
            moved = rows(*raceway(truth, ring, s)) @ (rings - y)
            touching = np.mean(0.25 * truth.clearance + drop(s) + moved < 0)
            shares.append(touching or 1.0)
    return min(shares)


def cases(count, kinds, profiles):
    """(kind, profile) -> list of (info, q, reference), all of them partly loaded."""
    groups = {(kind, profile): [] for kind in kinds for profile in profiles}
    seed = -1
    while any(len(group) < count for group in groups.values()):
        seed += 1
        _, q, info = random_case(seed)
        group = groups.get((info["kind"], info["profile"]["type"]))
        if group is None or len(group) == count:
            continue
        info = {**info, "n_rollers": ROLLERS}
        truth = build(info)
        want = evaluate(truth, q, graded(truth))
        if not np.any(want["roller_load"] > 0):
            continue
        if loaded_share(truth, q, want["roller_motion"]) < PARTLY:
            group.append((info, q, want))
    return groups


def element(info, quadrature):
    law = bj.contact.LineConstant(info["line_constant"])
    return bj.BearingElement(bearing(info, True), law, quadrature=quadrature)


def shortest(call, repeats):
    """Shortest time of a call [s]."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        jax.block_until_ready(call())
        times.append(time.perf_counter() - begin)
    return min(times)


def study(group, quadrature, repeats):
    """Errors (case, force and stiffness) and mean time [s] of one kind and rule."""
    found, times, call = [], [], None
    for info, q, want in group:
        numbers, static = eqx.partition(element(info, quadrature), eqx.is_array)
        if call is None:
            call = jax.jit(lambda x, q, rest=static: eqx.combine(x, rest).evaluate(q))
        call_now = partial(call, numbers, jnp.asarray(q))
        got = call_now()
        if int(got.result) != bj.Result.CONVERGED:
            raise RuntimeError(f"not converged: {info}")
        found.append(errors(got, want))
        times.append(shortest(call_now, repeats))
    return np.array(found), float(np.mean(times))


def row(rule, nodes, profile, found, seconds):
    """One line of results."""
    (force, stiffness) = found.T
    return {
        "rule": rule,
        "nodes": nodes,
        "profile": profile,
        "bearings": len(found),
        "force_worst": float(force.max()),
        "force_median": float(np.median(force)),
        "stiffness_worst": float(stiffness.max()),
        "stiffness_median": float(np.median(stiffness)),
        "time_us": 1e6 * seconds,
    }


def measure(groups, nodes, repeats):
    """A row for every rule, count of nodes and profile, and over all profiles."""
    rows = []
    for rule, counts in nodes.items():
        for count in counts:
            quadrature = RULES[rule](count)
            parts = {k: study(g, quadrature, repeats) for k, g in groups.items()}
            for profile, label in [*PROFILES.items(), (None, "all")]:
                mine = [p for k, p in parts.items() if profile in (k[1], None)]
                if not mine:
                    continue
                found = np.concatenate([p[0] for p in mine])
                seconds = float(np.mean([p[1] for p in mine]))
                rows.append(row(rule, count, label, found, seconds))
    return rows


def show(rows):
    labels = [label for label in PROFILES.values() if _rows_of(rows, label)]
    columns = {"rule": "{rule}", "nodes": "{nodes:d}"}
    for quantity in ("force", "stiffness"):
        columns |= {f"{quantity}, {x}": f"{{{quantity}_{x}:.0e}}" for x in WHICH}
    columns |= {HEADS[label]: f"{{{label}:.0e}}" for label in labels}
    mine = []
    for r in _rows_of(rows, "all"):
        same = [x for x in rows if (x["rule"], x["nodes"]) == (r["rule"], r["nodes"])]
        mine.append(r | {x["profile"]: x["force_worst"] for x in same})
    print("errors of force and stiffness; worst of the force, by kind of profile")
    table(mine, columns | {"time, µs": "{time_us:.0f}"})
    print(f"\n{rows[-1]['bearings']} bearings of {ROLLERS} rollers")


def _rows_of(rows, label):
    return [r for r in rows if r["profile"] == label]


def plot(rows):
    """Error against nodes, both rules, worst and median."""
    figure, axes = subplots(1, 2, figsize=(9, 4), sharey=True)
    for axis, quantity in zip(axes, ("force", "stiffness"), strict=True):
        for rule, color in COLORS.items():
            mine = [r for r in rows if r["rule"] == rule and r["profile"] == "all"]
            for which, style in (("worst", "o-"), ("median", "o--")):
                axis.loglog(
                    [r["nodes"] for r in mine],
                    [r[f"{quantity}_{which}"] for r in mine],
                    style,
                    color=color,
                    markersize=4,
                    markerfacecolor=color if which == "worst" else "white",
                    label=f"{rule}, {which}",
                )
        axis.set_title(f"Error of the {quantity}", loc="left")
        axis.set_xlabel("nodes per panel")
    axes[0].set_ylabel("relative error")
    axes[0].legend(frameon=False)
    return figure


@benchmark("few bearings and nodes", show, plot, count="bearings of each kind")
def main(smoke, count=6):
    if smoke:
        return measure(cases(2, KINDS[:1], ["circular"]), SMOKE, 5)
    return measure(cases(count, KINDS, PROFILES), NODES, 30)

"""How little friction is possible in a spindle bearing whose balls may not skid?

An angular contact bearing of the 7010 size (18 balls of 8.731 mm on 65 mm, osculations
0.52, 25 degrees, preload 450 N by a spring) in ISO VG 32 of 50 °C with a limiting shear
stress, over six cases from 15000 to 2000 rpm; the shaft does not tilt. Preload, contact
angle and both osculations are to make the mean friction torque least, with at most 1 %
slip of the cage in every case, either way; at most 1.6 GPa; at least 20 N/µm axially.

Gradients at start and end are compared with fourth-order differences, over the largest
slope of each measure. The end is checked by random designs about it that keep the
limits. Multipliers: what the objective gains as a limit, or a bound of a variable,
gives way; from the gradients of the free variables by least squares.

README: 7010, slip at most 1 %: 178.9 to 150.4 mN m (-16 %), preload 450 to 252 N; 7
designs |  |

Last run:

                              before     after
preload [N]                    450.0     252.1
contact angle [deg]            25.00     12.00
outer osculation              0.5200    0.5100
inner osculation              0.5200    0.5240
friction torque [mN m]       178.879   150.372
largest slip [%]               1.557     1.000
peak pressure [GPa]            1.339     1.529
axial stiffness [N/µm]        24.851    27.676

  N,    N,    rpm  torque, mN m       heat, W  cage slip, %  sliding, m/s     axis, deg
   0     0  15000 326.94 268.15 513.55 421.21  -1.17   1.00   0.99   0.52   2.30   1.00
  40    20  14000 283.11 235.59 415.06 345.40  -1.56   0.66   0.91   0.43   2.42   1.22
 100    50  10000 141.04 123.00 147.69 128.81  -1.23   0.33   0.40   0.26   3.88   2.73
 200   150   6000  51.58  45.70  32.41  28.71   0.13   0.25   0.29   0.13  18.43  13.05
   0  1200   3000  16.00  15.77   5.03   4.95   0.02   0.01   0.00   0.00  29.19  19.57
 400   500   2000   6.19   5.76   1.30   1.21   0.03   0.02   0.01   0.00  28.25  17.61

what holds it: d(friction torque)/d(limit), SI
  slip of the cage             -0.2602
  peak pressure             -8.554e-12
  contact angle                0.03731
  outer osculation             0.08986
  slope that is left           2.8e-17
gradients against differences: 5.9e-10 at the start, 4.0e-09 at the end
of 60 random designs about the best 13 keep the limits; their least torque is +0.25 %
with 144 places in place of 72 measures change by 1.5e-14
converged: 7 designs in 19.2 s, after 150 s in which the program is compiled; AMD EPYC

(On a busy machine; "axis": mean angle between the spin axes of the balls and that of
the bearing. The largest pressure in the limit is a p-norm over all balls and cases, 5 %
above the true one. Slip at the start is a lead: gyroscopic moments lay the spin axes
flat, so that the orbit is faster than in rolling without spin at the outer raceway,
while the balls slide by 1 m/s. With the geometry of the start slip is within 1 % from
some 850 N on only, at 178 mN m.)
"""

import time

import numpy as np
from bench import benchmark, subplots

import bearingjax as bj
from bearingjax.element.balls.ball_speed import EqualShare
from bearingjax.lubrication import LimitingStress, iso_vg
from bearingjax.optimise.design_problem import Problem
from bearingjax.skid import CageSlip, Drag, FrictionTorque, SkiddingBearing, SkidModel
from bearingjax.statics import SolveOptions

CASES = np.array(  # radial load and axial load [N], speed [rpm], share of the time
    [
        (0.0, 0.0, 15000.0, 0.15),
        (40.0, 20.0, 14000.0, 0.30),
        (100.0, 50.0, 10000.0, 0.25),
        (200.0, 150.0, 6000.0, 0.15),
        (0.0, 1200.0, 3000.0, 0.10),
        (400.0, 500.0, 2000.0, 0.05),
    ]
)
BEARING = "model.element.bearing."
NAMES = ("preload", "contact angle", "outer osculation", "inner osculation")
UNITS = (1.0, np.pi / 180.0, 1.0, 1.0)
VARIABLES = (
    bj.optimise.Variable("preload", 20.0, 1000.0),
    bj.optimise.Variable(BEARING + "contact_angle", *np.radians([12.0, 40.0])),
    bj.optimise.Variable(BEARING + "outer_osculation", 0.51, 0.56),
    bj.optimise.Variable(BEARING + "inner_osculation", 0.51, 0.56),
)
CONSTRAINTS = (
    bj.optimise.Constraint(CageSlip(), upper=0.01),
    bj.optimise.Constraint(bj.optimise.PeakPressure(), upper=1.6e9),
    bj.optimise.Constraint(bj.optimise.Stiffness("uz"), lower=20e6),
)
STEP = 2e-4  # of the differences, over the ranges
AROUND = 0.03  # how far random designs are from the best, over the ranges
NEAR = 1e-9  # of a bound, over the range: round-off
KEPT = 1e-6  # share by which a limit may be passed


def start(places):
    bearing = bj.AngularContactBallBearing(
        18,
        0.065,
        8.731e-3,
        outer_osculation=0.52,
        inner_osculation=0.52,
        contact_angle=np.radians(25.0),
    )
    element = bj.BearingElement(bearing, raceway_control=EqualShare())
    oil, law = iso_vg(32.0), LimitingStress()
    model = SkidModel(element, oil, 323.15, traction=law, drag=Drag(fill=0.05))
    return SkiddingBearing(model, 450.0, places)


def spectrum():
    load = np.zeros((len(CASES), 6))
    load[:, 1], load[:, 2] = -CASES[:, 0], CASES[:, 1]
    return bj.Cases(
        load,
        inner_speed=CASES[:, 2] * np.pi / 30.0,
        hours=CASES[:, 3],
        prescribed={"gx": 0.0, "gy": 0.0},
    )


def problem_of(places, constraints=CONSTRAINTS):
    least, options = FrictionTorque(), SolveOptions()
    given = (VARIABLES, least, constraints, options)
    return Problem(start(places), spectrum(), *given)


def error_of_gradients(problem, unit):
    """Largest difference, over the largest slope of its measure."""
    got, width = np.asarray(problem.run(unit, True).jacobian), len(VARIABLES)
    want = np.empty_like(got)
    for k, way in enumerate(STEP * np.eye(width)):
        two, one, less, least = (
            np.asarray(problem.run(unit + n * way, True).measures)
            for n in (2, 1, -1, -2)
        )
        want[:, k] = (8.0 * (one - less) - (two - least)) / (12.0 * STEP)
    return float(np.max(np.abs(got - want) / np.abs(want).max(axis=1, keepdims=True)))


def multipliers(problem, trial):
    """What holds the design: name, and d objective/d limit [SI].

    Returns:
        Those of active limits and bounds; the largest slope that they leave.
    """
    low, high = trial.unit < NEAR, trial.unit > 1.0 - NEAR
    free, active = ~(low | high), trial.margins < 1e-5
    normals = trial.margin_slopes[active]
    found = np.linalg.lstsq(normals[:, free].T, trial.slope[free], rcond=None)[0]
    left = trial.slope - normals.T @ found
    rows = []
    for bound, value in zip(np.flatnonzero(active), found, strict=True):
        bound = problem.bounds[bound]
        per = bound.sign * value * problem.size / bound.size
        rows.append((problem.measures[bound.measure].label, float(per)))
    for k in np.flatnonzero(~free):
        rows.append((NAMES[k], float(left[k] * problem.size / problem.width[k])))
    wrong = (low & (left < 0)) | (high & (left > 0))
    return rows, float(np.abs(np.where(free | wrong, left, 0.0)).max())


def about(problem, best, count):
    """Random designs near the best: how many keep the limits, and their least torque
    over that of the best, less 1."""
    rng, kept = np.random.default_rng(4), []
    for _ in range(count):
        away = AROUND * rng.uniform(-1.0, 1.0, len(VARIABLES))
        trial = problem.evaluate(np.clip(best.unit + away, 0.0, 1.0), True)
        if not trial.fault and trial.violation <= KEPT:
            kept.append(trial.objective / best.objective - 1.0)
    return len(kept), float(min(kept)) if kept else None


def over_preload(problem, values, preloads):
    """Torque [N m] and slip of the cage [1] of a design with other preloads."""
    rows = []
    for force in preloads:
        found = problem.run(problem.to_unit_box([force, *values[1:]]), True)
        solved = not np.asarray(found.solution.result).any()
        rows.append(np.asarray(found.exact)[:2] if solved else [np.nan, np.nan])
    return np.array(rows)


def side(outcome):
    """What the tables and pictures show of a design."""
    solved = outcome.solution
    axis = np.degrees(np.asarray(solved.pitch_angle))
    return {
        "values": (outcome.values / UNITS).tolist(),
        "measures": [outcome.exact, *outcome.exact_constraints.tolist()],
        "torque": np.asarray(solved.friction_torque).tolist(),
        "heat": np.asarray(solved.power.drive).tolist(),
        "cage_slip": np.asarray(solved.cage_slip).tolist(),
        "sliding": np.asarray(solved.sliding_speed).max(axis=(1, 2)).tolist(),
        "axis": axis.mean(axis=1).tolist(),
        "wander": np.asarray(solved.wander).tolist(),
    }


def measure(places, finer, points, scan):
    """One search and its checks."""
    problem = problem_of(places)
    first = problem.to_unit_box([v.start_in(problem.element) for v in VARIABLES])
    begin = time.perf_counter()
    problem.run(first, True)
    compiled = time.perf_counter() - begin
    begin = time.perf_counter()
    found = bj.optimise.optimise(
        problem.element, spectrum(), VARIABLES, FrictionTorque(), CONSTRAINTS
    )
    seconds = time.perf_counter() - begin
    problem.begin(first, True)
    best = problem.evaluate(problem.to_unit_box(found.values), True)
    rows, left = multipliers(problem, best)
    kept, least = about(problem, best, points)
    result = {
        "places": places,
        "result": found.result,
        "optimality": found.optimality,
        "evaluations": found.n_evaluations,
        "compiled_s": compiled,
        "seconds": seconds,
        "before": side(found.before),
        "after": side(found.after),
        "smooth": [found.after.objective, *found.after.constraints.tolist()],
        "gradients": [error_of_gradients(problem, u) for u in (first, best.unit)],
        "multipliers": rows,
        "left": left,
        "around": [points, kept, least],
    }
    if finer:
        fine = problem_of(finer)
        coarse = np.asarray(problem.run(best.unit, True).measures)
        change = np.asarray(fine.run(best.unit, False).measures) / coarse - 1.0
        result["finer"] = [finer, float(np.abs(change).max())]
    if scan:
        preloads = np.geomspace(100.0, 1000.0, scan)
        result["preloads"] = preloads.tolist()
        for name, outcome in (("before", found.before), ("after", found.after)):
            rows = over_preload(problem, outcome.values, preloads)
            result[name]["over_preload"] = rows.tolist()
    return result


def show(r):
    pair = r["before"], r["after"]
    print(f"{'':26}{'before':>10}{'after':>10}")
    formats = "{:10.1f}", "{:10.2f}", "{:10.4f}", "{:10.4f}"
    units = " [N]", " [deg]", "", ""
    for k, name in enumerate(NAMES):
        cells = (formats[k].format(s["values"][k]) for s in pair)
        print(f"{name + units[k]:26}" + "".join(cells))
    scaled = (
        ("friction torque [mN m]", 1e3),
        ("largest slip [%]", 1e2),
        ("peak pressure [GPa]", 1e-9),
        ("axial stiffness [N/µm]", 1e-6),
    )
    for k, (name, scale) in enumerate(scaled):
        cells = (f"{scale * s['measures'][k]:10.3f}" for s in pair)
        print(f"{name:26}" + "".join(cells))
    heads = "torque, mN m", "heat, W", "cage slip, %", "sliding, m/s", "axis, deg"
    print(f"\n{'N,    N,    rpm':>17}" + "".join(f"{h:>14}" for h in heads))
    for k, (radial, axial, speed, _) in enumerate(CASES):
        cells = ""
        columns = ("torque", 1e3), ("heat", 1), ("cage_slip", 100), ("sliding", 1)
        for name, scale in (*columns, ("axis", 1)):
            one, other = (scale * s[name][k] for s in pair)
            cells += f"{one:7.2f}{other:7.2f}"
        print(f"{radial:4.0f} {axial:5.0f} {speed:6.0f}{cells}")
    print("\nwhat holds it: d(friction torque)/d(limit), SI")
    for name, value in r["multipliers"]:
        print(f"  {name:24}{value:12.4g}")
    print(f"  slope that is left      {r['left']:12.1e}")
    one, other = r["gradients"]
    print(
        f"gradients against differences: {one:.1e} at the start, {other:.1e} at the end"
    )
    points, kept, least = r["around"]
    if kept:
        print(
            f"of {points} random designs about the best {kept} keep the limits;"
            f" their least torque is {100 * least:+.2f} %"
        )
    if "finer" in r:
        print(
            f"with {r['finer'][0]} places in place of {r['places']} measures change by"
            f" {r['finer'][1]:.1e}"
        )
    print(
        f"{r['result']}: {r['evaluations']} designs in {r['seconds']:.1f} s, after"
        f" {r['compiled_s']:.0f} s in which the program is compiled"
    )


def plot(r):
    """Torque and slip over the preload; slip of the cases."""
    figure, axes = subplots(1, 3, figsize=(13.0, 4.3))
    looks = {"before": ("#8a8a8a", "s"), "after": ("#0072B2", "o")}
    for shift, (name, (colour, mark)) in zip((-0.2, 0.2), looks.items(), strict=True):
        mine, preload = r[name], r[name]["values"][0]
        rows = np.array(mine.get("over_preload", np.full((0, 2), np.nan)))
        for k, (ax, scale) in enumerate(zip(axes, (1e3, 1e2), strict=False)):
            x, y = r.get("preloads", []), scale * rows[:, k]
            label = f"geometry {name}, any preload"
            ax.plot(x, y, color=colour, label=label if k == 0 else None)
            value = scale * mine["measures"][k]
            ax.plot(preload, value, mark, color=colour, ms=8, label=name)
        places = np.arange(len(CASES)) + shift
        values = 100.0 * np.array(mine["cage_slip"])
        axes[2].bar(places, values, 0.38, color=colour, label=name)
    for ax in axes[:2]:
        ax.set_xscale("log")
        ticks = [100, 200, 300, 500, 1000]
        ax.set_xticks(ticks, [str(t) for t in ticks])
        ax.minorticks_off()
        ax.set_xlabel("preload [N]")
    axes[0].set_ylabel("mean friction torque [mN m]")
    axes[0].set_title("Friction torque over the spectrum", loc="left")
    axes[1].set_ylabel("largest slip of the cage, either way [%]")
    axes[1].set_ylim(0.0, 5.0)
    axes[1].axhline(1.0, color="#D55E00", lw=1.2, label="limit")
    axes[1].set_title("Slip over the spectrum", loc="left")
    for level in (-1.0, 1.0):
        axes[2].axhline(level, color="#D55E00", lw=1.2)
    axes[2].axhline(0.0, color="0.3", lw=0.8)
    names = [f"{c[2] / 1e3:.0f}" for c in CASES]
    axes[2].set_xticks(np.arange(len(CASES)), names)
    axes[2].set_xlabel("speed of the case [1000 rpm]")
    axes[2].set_ylabel("slip of the cage [%]; below 0 it leads")
    axes[2].set_title("Slip of the cases", loc="left")
    for ax in axes:
        ax.set_axisbelow(True)
        ax.legend(frameon=False, fontsize=9)
    return figure


@benchmark("few places and checks", show, plot, places="along the orbit")
def main(smoke, places=72):
    return measure(18, 0, 4, 2) if smoke else measure(places, 2 * places, 60, 16)

"""How many evaluations, and how much time, does the gradient save in design?

The worked case: profile of a cylindrical roller (NU, 12 rollers of 14 x 13.72 mm) under
a spectrum of four loads, 18 to 4 kN, the shaft tilted by 2 to 0.5 mrad with them. The
three Fujiwara-Kawase parameters are to make the (smooth) peak pressure least, with at
most 10 N/mm on the roller ends. SLSQP takes that as it stands. The methods without
gradients, Nelder and Mead's and Rosenbrock's (as the literature used), get the same
problem with an exact penalty: the share by which the edge load is too large is added to
the objective over its value at the reference; so does L-BFGS-B, with the square of that
share, which is smooth but gives way a little.

All start from the same random designs, in shuffled order, and share compiled programs,
which are warmed up before. "Above the best": smooth peak pressure over the least that
any of them found with the edge load kept. A grid around the best design checks it.

README: three numbers, four loads: SLSQP 14 designs (median), Rosenbrock's search 158,
Nelder and Mead's 326; one search does not repay compiling |  |

Last run:

                 designs evaluated         load    time   first    above the best  edge
method         median    least     most  solves       s call, s   median    worst  kept
slsqp              14       10       17      56    0.37    98.6  1.9e-05  1.9e-05   6/6
l-bfgs-b           16        2      102      64    0.56    25.6  4.9e-05  2.7e-02   6/6
nelder-mead       326      297      455    1306    7.62    15.0  6.1e-11  3.5e-07   6/6
rosenbrock        158       92      215     632    3.48     4.3  1.9e-05  3.1e-05   6/6

best design: K1 = 1.539, K2 = 1, zm = 21.66 µm;
smooth peak 2217.0 MPa (reference 2234.8), true peak 2121.3
Johns and Gohar's (K1 = K2 = 1, zm = 7.82 µm): smooth peak 2222.1 MPa,
edge load 515 N/mm
least on a grid of ±0.1 of the ranges around the best, over the best: +0.0e+00
24 searches; AMD EPYC

(On a busy machine: "first call" compiles, the more the earlier in the run; a single
search does not earn the price of the gradient's program, which the command line keeps
from run to run. L-BFGS-B: the square of a large miss dwarfs the peak; two of six end
early. Above an end drop of 20 µm little depends on it: SLSQP may end at 36 µm. In
several runs Rosenbrock's search took 6 to 9 times as long as SLSQP once compiled,
Nelder and Mead's 11 to 20 times.)
"""

import time

import jax.numpy as jnp
import numpy as np
from bench import benchmark, subplots

import bearingjax as bj
from bearingjax.optimise.design_problem import Problem
from bearingjax.optimise.search import SearchOutcome
from bearingjax.statics import SolveOptions

REFERENCE = (1.0, 0.6, 8e-6)
LOWER, UPPER = (0.5, 0.2, 2e-6), (8.0, 1.0, 60e-6)
NAMES = ("load_factor", "crowned_fraction", "end_drop")
EDGE = 10e3
KEPT = 1e-3  # share by which an edge load may pass its bound and still count as kept
STEPS = {"slsqp": 200, "l-bfgs-b": 200, "nelder-mead": 1000, "rosenbrock": 1000}
PEAK, ENDS = bj.optimise.PeakPressure(), bj.optimise.EdgeLoad()


def bearing_and_cases():
    """The NU bearing with the reference profile, and its spectrum."""
    bearing = bj.CylindricalRollerBearing(
        12,
        0.0725,
        0.014,
        0.01372,
        radial_internal_clearance=25e-6,
        first_azimuth=-0.5 * np.pi,
        roller_profile=bj.FujiwaraKawase(8e3, *REFERENCE),
    )
    load = np.zeros((4, 6))
    load[:, 1] = [-18e3, -12e3, -8e3, -4e3]
    tilt = {"gx": [2e-3, 1.5e-3, 1e-3, 0.5e-3], "gy": 0.0}
    hours = [500.0, 1500.0, 4000.0, 2000.0]
    return bj.BearingElement(bearing), bj.Cases(load, prescribed=tilt, hours=hours)


def variables(start):
    rows = zip(NAMES, LOWER, UPPER, start, strict=True)
    return [
        bj.optimise.Variable(f"bearing.roller_profile.{n}", a, b, s)
        for n, a, b, s in rows
    ]


def excess(element, cases, solution):
    """Share by which the edge load is too large, 0 if it is kept."""
    return jnp.maximum(ENDS(element, cases, solution) / EDGE - 1.0, 0.0)


def penalised(size):
    """Objective with the exact penalty."""

    def objective(element, cases, solution):
        miss = excess(element, cases, solution)
        return PEAK(element, cases, solution) / size + miss

    return objective


def smoothly_penalised(size):
    """Objective with the square of the miss."""

    def objective(element, cases, solution):
        miss = excess(element, cases, solution)
        return PEAK(element, cases, solution) / size + miss**2

    return objective


def rosenbrock(attempt, start, max_steps, tolerance, step):
    """Rosenbrock's search: along axes that turn to where it has got on.

    Source: Rosenbrock (1960): steps grow by 3 on success and turn back by half on
        failure; when each axis has seen both, new axes by Gram and Schmidt.
    """
    n = start.size
    axes, x = np.eye(n), start
    best = attempt(x).objective
    for _ in range(max_steps):
        lengths, gone = np.full(n, 0.1), np.zeros(n)
        won, lost = np.zeros(n, bool), np.zeros(n, bool)
        begin = x
        while not np.all(won & lost) and np.abs(lengths).max() > 0.1 * tolerance:
            for k in range(n):
                target = x + lengths[k] * axes[k]
                inside = np.all((target >= 0.0) & (target <= 1.0))
                value = attempt(target).objective if inside else np.inf
                if value <= best:
                    x, best = target, value
                    gone[k] += lengths[k]
                    lengths[k] *= 3.0
                    won[k] = True
                else:
                    lengths[k] *= -0.5
                    lost[k] = True
        step(x)
        if np.linalg.norm(x - begin) <= tolerance:
            return SearchOutcome(x, True, "the last stage got nowhere")
        axes = turned(axes, gone)
    return SearchOutcome(x, False, "stages used up")


def turned(axes, gone):
    """Orthonormal axes, the first along the way gone."""
    ways = np.cumsum((gone[:, None] * axes)[::-1], axis=0)[::-1]
    # What has not moved keeps its axis.
    ways = np.where(np.linalg.norm(ways, axis=1, keepdims=True) > 1e-12, ways, axes)
    turned, triangle = np.linalg.qr(ways.T)
    if np.abs(np.diag(triangle)).min() < 1e-12 * np.abs(triangle).max():
        return axes
    return (turned * np.sign(np.diag(triangle))).T


def run(method, element, cases, start, size_of, points):
    """One search from one start."""
    kept = [bj.optimise.Constraint(ENDS, upper=EDGE)] if method == "slsqp" else []
    objective = {"slsqp": PEAK, "l-bfgs-b": size_of["smooth"]}.get(
        method, size_of["exact"]
    )
    begin = time.perf_counter()
    found = bj.optimise.optimise(
        element,
        cases,
        variables(start),
        objective,
        kept,
        search=bj.optimise.SearchOptions(
            rosenbrock if method == "rosenbrock" else method,
            max_steps=STEPS[method],
            solve=SolveOptions(points=points),
        ),
    )
    seconds = time.perf_counter() - begin
    solution = found.after.solution
    peak, edge = (float(m(found.element, cases, solution)) for m in (PEAK, ENDS))
    return {
        "method": method,
        "result": found.result,
        "values": [float(v) for v in found.values],
        "peak": peak,
        "true_peak": float(jnp.max(solution.roller_pressure)),
        "edge": edge,
        "evaluations": found.n_evaluations,
        "gradients": found.n_gradients,
        "solves": found.n_evaluations * cases.count,
        "rejected": len(found.rejected),
        "seconds": seconds,
        "history": found.history.objective.tolist(),
        "at": found.history.evaluations.tolist(),
    }


def measure(starts, points, methods=tuple(STEPS)):
    element, cases = bearing_and_cases()
    options = SolveOptions(points=points)
    problem = Problem(element, cases, variables(REFERENCE), PEAK, (), options)
    reference = problem.run(problem.to_unit_box(REFERENCE), False)
    size = float(reference.measures[0])
    objectives = {"exact": penalised(size), "smooth": smoothly_penalised(size)}
    compile_times = {}
    for method in methods:
        begin = time.perf_counter()
        run(method, element, cases, REFERENCE, objectives, points)
        compile_times[method] = time.perf_counter() - begin
    rng = np.random.default_rng(5)
    corners = np.array(LOWER), np.array(UPPER) - np.array(LOWER)
    designs = [
        REFERENCE,
        *(corners[0] + corners[1] * rng.uniform(size=(starts - 1, 3))),
    ]
    jobs = [(m, k) for m in methods for k in range(starts)]
    rng.shuffle(jobs)
    rows = []
    for method, k in jobs:
        k = int(k)
        row = run(method, element, cases, designs[k], objectives, points)
        rows.append({**row, "start": k, "first_call": compile_times[method]})
    kept = [r["peak"] for r in rows if r["edge"] <= EDGE * (1 + KEPT)]
    for row in rows:
        row["above_best"] = row["peak"] / min(kept) - 1.0
        row["kept"] = row["edge"] <= EDGE * (1 + KEPT)
        row["reference"] = size
    return sorted(rows, key=lambda r: (list(STEPS).index(r["method"]), r["start"]))


def check_by_grid(rows, points, n):
    """Least smooth peak on a grid around the best design, edge load kept [Pa]."""
    element, cases = bearing_and_cases()
    best = min((r for r in rows if r["kept"]), key=lambda r: r["peak"])
    options = SolveOptions(points=points)
    kept = (bj.optimise.Constraint(ENDS, upper=EDGE),)
    problem = Problem(element, cases, variables(REFERENCE), PEAK, kept, options)
    middle = problem.to_unit_box(best["values"])
    sides = [np.clip(m + np.linspace(-0.1, 0.1, n), 0.0, 1.0) for m in middle]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3)
    found = np.array([problem.run(x, False).measures for x in grid])
    allowed = found[:, 1] <= EDGE
    least = float(found[allowed, 0].min()) / best["peak"] - 1.0
    published = problem.run(problem.to_unit_box(johns_gohar()), False).measures
    return least, best, [float(x) for x in published]


def johns_gohar():
    """Johns and Gohar's profile of the design load, in Fujiwara and Kawase's numbers:
    K1 = K2 = 1 and an end drop of A ln(1/(0.3033 b/a))."""
    load, length, modulus = 8e3, 0.01372, 206e9 / (2 * (1 - 0.3**2))
    radius = bj.contact.relative_radius(jnp.array(0.007), jnp.array(0.02925))
    half = bj.contact.half_width(jnp.array(load / length), radius, jnp.array(modulus))
    unit = load / (np.pi * length * modulus)
    return 1.0, 1.0, float(unit * np.log(0.5 * length / (0.3033 * float(half))))


def show(rows, best, published):
    grid = rows[0]["grid"]
    print(
        f"{'':12}{'designs evaluated':^27}{'load':>8}{'time':>8}{'first':>8}"
        f"{'above the best':>18}{'edge':>6}\n"
        f"{'method':12}{'median':>9}{'least':>9}{'most':>9}{'solves':>8}{'s':>8}"
        f"{'call, s':>8}{'median':>9}{'worst':>9}{'kept':>6}"
    )
    for method in dict.fromkeys(r["method"] for r in rows):
        mine = [r for r in rows if r["method"] == method]
        n = [r["evaluations"] for r in mine]
        above = [r["above_best"] for r in mine]
        print(
            f"{method:12}{np.median(n):9.0f}{min(n):9d}{max(n):9d}"
            f"{np.median([r['solves'] for r in mine]):8.0f}"
            f"{np.median([r['seconds'] for r in mine]):8.2f}"
            f"{mine[0]['first_call']:8.1f}"
            f"{np.median(above):9.1e}{max(above):9.1e}"
            f"{sum(r['kept'] for r in mine):4d}/{len(mine)}"
        )
    k1, k2, zm = best["values"]
    first = next(r for r in rows if r["start"] == 0)
    print(
        f"\nbest design: K1 = {k1:.4g}, K2 = {k2:.4g}, zm = {1e6 * zm:.4g} µm;"
        f"\nsmooth peak {1e-6 * best['peak']:.1f} MPa (reference"
        f" {1e-6 * first['reference']:.1f}), true peak {1e-6 * best['true_peak']:.1f}"
        f"\nJohns and Gohar's (K1 = K2 = 1, zm = {1e6 * johns_gohar()[2]:.3g} µm):"
        f" smooth peak {1e-6 * published[0]:.1f} MPa,"
        f" edge load {1e-3 * published[1]:.0f} N/mm"
        "\nleast on a grid of ±0.1 of the ranges around the best, over the best:"
        f" {grid:+.1e}\n{len(rows)} searches"
    )


def plot(rows, *_):
    """Objective against designs evaluated, one line a search."""
    colours = {
        "slsqp": "#009E73",
        "l-bfgs-b": "#0072B2",
        "nelder-mead": "#D55E00",
        "rosenbrock": "#CC79A7",
    }
    figure, axis = subplots(figsize=(7.5, 4.5))
    for method, colour in colours.items():
        mine = [r for r in rows if r["method"] == method]
        if not mine:
            continue
        x = [r["evaluations"] for r in mine]
        y = [max(r["above_best"], 1e-9) for r in mine]
        kept = np.array([r["kept"] for r in mine])
        for mask, face in ((kept, colour), (~kept, "none")):
            if mask.any():
                axis.loglog(
                    np.array(x)[mask],
                    np.array(y)[mask],
                    "o",
                    color=colour,
                    markerfacecolor=face,
                    label=method if face != "none" else f"{method}, edge load not kept",
                )
    axis.set_xlabel("designs evaluated until the search ended")
    axis.set_ylabel("smooth peak pressure above the best")
    axis.set_title("Profile of a roller, three numbers, several starts", loc="left")
    axis.legend(frameon=False)
    return figure


@benchmark("one start, few points", show, plot, starts="random starts")
def main(smoke, starts=8):
    if smoke:
        rows = measure(1, 21, ("slsqp", "nelder-mead"))
        grid, *more = check_by_grid(rows, 21, 2)
    else:
        rows = measure(starts, 101)
        grid, *more = check_by_grid(rows, 101, 9)
    return [row | {"grid": grid} for row in rows], *more

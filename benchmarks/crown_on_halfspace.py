"""How much does a tapered roller gain if its crown is optimised on the half-space?

The roller of method 004 (15 mm long, 10 and 12 mm thick, 210 GPa; angle of the taper
from the diameters) on a plane, and on the cone of an inner ring with the same apex (20
mm radius of curvature in the middle). Least is made the largest pressure at x = 0 over
cells and operating cases: "aligned", 1000 to 5000 N; "tilted", 3000 to 5000 N, each
with tilts of -0.5, 0 and 0.5 mrad. Smoothly: T ln(sum of exp(p/T)), T 40, then 10, then
3 MPa. L-BFGS-B; gradients in reverse mode, through the solves of all cases at once.
Free are

- "F. & K.": Fujiwara and Kawase's load factor, crowned fraction and end drop;
- "even": four numbers, the same at both ends; drop = sum of h ((s - s0)/(1 - s0))^2
  where s > s0, s from 0 in the middle to 1 at the end, s0 = 0, 0.6, 0.88, 0.975, h from
  0 to 20, 20, 30, 30 µm; any such drop is convex;
- "free": eight numbers, four for either end.

A contact that reaches the end of the roller has an infinite pressure there, of which a
cell shows the more the shorter it is. A search that may load the end cells just as much
as the others therefore finds profiles that are good on its own cells only: without more
ado its best one had 1514 MPa with end cells of 3.8 µm, and 2808 with 0.9 µm. So the end
cells count 30-fold, which keeps contacts off the ends; and the same designs are solved
with 65 x 128 cells; of three searches that counts whose result is best on these.

Cells: 35 x 64, graded, of one width, that of a straight roller in the worst case.
Margin: half width of the grid over that of the widest contact. The pressure
called "even": of an endless roller with an even pressure, which no profile comes below
by much. Evaluations
(value and gradient, of all cases) and time: of the median search; times of one
evaluation: shortest of nine.

README: 5000 N: 1516 MPa, ISO logarithmic 1671; tilted by 0.5 mrad 1723 and 1795;
gradient 1.2 to 1.4 solves, error below 6e-7 | finer cells within 1 %; gradient 1e-5 |
yes

Last run:

on a plane, aligned: largest pressure of a cell, MPa (end cells 3.8 µm; even: 1490)
                       straight    ISO log   Lundberg    F. & K.       even       free
1000 N                   4868.4      906.1      748.5      767.8      800.5      758.9
2000 N                   7947.1     1168.6     1002.4     1020.8     1045.6     1013.5
3000 N                  10579.7     1363.4     1200.5     1214.5     1234.7     1206.6
4000 N                  12959.4     1526.0     1377.8     1383.6     1394.0     1371.8
5000 N                  15164.9     1670.5     1795.9     1542.7     1539.1     1515.7
worst                   15164.9     1670.5     1795.9     1542.7     1539.1     1515.7
worst, 0.9 µm cells     30450.6     1668.4     1745.9     1540.6     1552.9     1527.5
worst over even          10.176      1.121      1.205      1.035      1.033      1.017
approach, µm             10.060     12.557     10.780     10.942     11.138     10.893
margin                     1.67       2.06       2.33       2.33       2.33       2.33
evaluations                   -          -          -         32         95        404
solves                        -          -          -        160        475       2020
time, s                       -          -          -        2.3        5.0       26.2
compile, s                    -          -          -        9.9        8.9       14.4
evaluation, ms                -          -          -       25.2       27.8       26.2
with gradient, times          -          -          -       1.37       1.38       1.35
gradient error                -          -          -      2e-08      1e-09      3e-07
spread of searches            -          -          -      5e-13      1e-02      6e-03
F. & K.: K1 = 1.25, K2 = 1, zm = 50.8 µm
even: 2.05, 0.86, 1.80, 1.57 µm (end drops 6.27)
free: 2.17, 0.64, 1.81, 1.52 | 0.17, 2.04, 1.84, 1.62 µm (end drops 6.15, 5.66)
unlike ends below like ones: 1.52 %

on a plane, tilted: largest pressure of a cell, MPa (end cells 3.8 µm; even: 1490)
                       straight    ISO log   Lundberg    F. & K.       even       free
3000 N, -0.5 mrad       16200.2     1477.5     1957.3     1464.3     1436.1     1421.8
3000 N                  10579.7     1363.4     1200.5     1339.6     1377.0     1359.2
3000 N, +0.5 mrad       15561.7     1419.0     1845.1     1402.6     1397.6     1409.3
4000 N, -0.5 mrad       18380.1     1645.4     2666.1     1631.3     1597.0     1580.3
4000 N                  12959.4     1526.0     1377.8     1501.0     1530.0     1515.6
4000 N, +0.5 mrad       17662.6     1579.1     2420.4     1559.6     1551.5     1571.6
5000 N, -0.5 mrad       20424.1     1795.1     3360.4     1780.3     1739.8     1722.6
5000 N                  15164.9     1670.5     1795.9     1641.8     1667.8     1654.1
5000 N, +0.5 mrad       19635.2     1716.7     3202.6     1695.6     1686.7     1708.7
worst                   20424.1     1795.1     3360.4     1780.3     1739.8     1722.6
worst, 0.9 µm cells     41039.6     1794.6     3196.3     1779.0     1743.0     1720.7
worst over even          13.705      1.205      2.255      1.195      1.167      1.156
approach, µm             10.060     12.557     10.780     12.251     12.482     12.334
margin                     1.30       2.06       1.84       2.06       2.06       2.06
evaluations                   -          -          -         20        159        235
solves                        -          -          -        180       1431       2115
time, s                       -          -          -        3.6       23.3       13.6
compile, s                    -          -          -       11.5       10.0       20.5
evaluation, ms                -          -          -      117.9      137.8       54.9
with gradient, times          -          -          -       1.24       1.24       1.38
gradient error                -          -          -      1e-08      5e-09      1e-08
spread of searches            -          -          -      6e-03      4e-03      2e-03
F. & K.: K1 = 3.96, K2 = 1, zm = 10.9 µm
even: 6.00, 0.26, 2.32, 1.79 µm (end drops 10.37)
free: 6.70, 0.00, 2.62, 2.12 | 3.81, 2.16, 2.01, 1.83 µm (end drops 11.44, 9.80)
unlike ends below like ones: 0.99 %

on a cone, tilted: largest pressure of a cell, MPa (end cells 3.8 µm; even: 1683)
                       straight    ISO log   Lundberg    F. & K.       even       free
3000 N, -0.5 mrad       17249.1     1663.8     2149.2     1651.0     1620.1     1600.2
3000 N                  11373.3     1541.0     1356.7     1503.2     1556.4     1522.8
3000 N, +0.5 mrad       16566.0     1594.5     2025.7     1573.3     1573.2     1589.2
4000 N, -0.5 mrad       19594.9     1851.7     3112.9     1835.5     1797.7     1774.1
4000 N                  13928.0     1718.0     1557.2     1681.2     1724.1     1695.4
4000 N, +0.5 mrad       18827.3     1778.9     2843.9     1754.1     1749.1     1774.0
5000 N, -0.5 mrad       21796.6     2020.7     3645.6     2005.4     1959.6     1937.3
5000 N                  16295.0     1884.1     2003.3     1844.1     1881.8     1857.0
5000 N, +0.5 mrad       20949.9     1931.4     3474.1     1905.4     1900.6     1933.8
worst                   21796.6     2020.7     3645.6     2005.4     1959.6     1937.3
worst, 0.9 µm cells     43782.2     2018.7     3534.7     2002.8     1964.0     1939.7
worst over even          12.950      1.201      2.166      1.191      1.164      1.151
approach, µm             10.282     12.789     10.997     12.400     12.727     12.476
margin                     1.84       2.69       2.33       2.69       2.69       2.69
evaluations                   -          -          -         23        158        141
solves                        -          -          -        207       1422       1269
time, s                       -          -          -        5.3       22.3       16.5
compile, s                    -          -          -       12.5       11.3       10.6
evaluation, ms                -          -          -      103.9       66.6       58.7
with gradient, times          -          -          -       1.34       1.18       1.23
gradient error                -          -          -      5e-07      1e-08      8e-08
spread of searches            -          -          -      5e-03      4e-04      5e-03
F. & K.: K1 = 3.72, K2 = 1, zm = 10.9 µm
even: 6.13, 0.08, 2.41, 1.96 µm (end drops 10.58)
free: 6.68, 0.00, 4.18, 9.41 | 3.32, 1.82, 2.55, 2.02 µm (end drops 20.27, 9.71)
unlike ends below like ones: 1.14 %
largest error of a gradient: 5.24e-07 (at most 1e-05): met
worst peak of an optimum, fine cells: 0.00896 (at most 0.01): met
AMD EPYC, 2 cores, load average 4.3; devices: 1 cpu; jax 0.10.1

(On a busy machine; only ratios within a line count. Searches end in different places, a
hundredth apart or less: cells that come into contact or leave it make kinks. About as
much is what unlike ends gain.)
"""

import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, compiled, shuffled, subplots, verdict
from jaxtyping import Array, Float
from scipy.optimize import minimize

import bearingjax as bj
from bearingjax.contact.halfspace import RollerContact, influence, solve_pressure
from bearingjax.design.profile import AbstractProfile

MODULUS = 210e9 / (2 * (1 - 0.3**2))
LENGTH = 0.015
RADIUS = 0.020  # of the inner raceway, in the middle
MOST = 5000.0
TILT = 0.5e-3
CELLS, FINE = (35, 64), (65, 128)
SMOKE_CELLS = (15, 24)
SETS = {
    "aligned": [(f, 0.0) for f in (1000.0, 2000.0, 3000.0, 4000.0, 5000.0)],
    "tilted": [(f, t) for f in (3000.0, 4000.0, 5000.0) for t in (-TILT, 0.0, TILT)],
}
SHARPNESS = (40e6, 10e6, 3e6)
BEGINS = (0.0, 0.6, 0.88, 0.975)
SCALES = (20e-6, 20e-6, 30e-6, 30e-6)  # largest heights, 100 µm together
ENDS = 30.0  # by how much pressures of end cells count
FIRST_STEP = 0.1  # of the box
PLACES = (("plane", "aligned"), ("plane", "tilted"), ("cone", "tilted"))
GOALS = {"gradient": 1e-5, "fine": 0.01}
COLOURS = {
    "straight": "#595959",
    "ISO log": "#E69F00",
    "Lundberg": "#CC79A7",
    "F. & K.": "#009E73",
    "even": "#56B4E9",
    "free": "#0072B2",
}


class Free(AbstractProfile):
    """Powers that begin nearer and nearer to the ends.

    Attributes:
        heights: What each part adds at the end, small end first (2, part) [m].
    """

    heights: Float[Array, "2 part"]

    def drop(self, position, length, diameter):
        begins = jnp.asarray(BEGINS)
        begins = begins.reshape((-1,) + (1,) * position.ndim)
        drop = jnp.zeros_like(position)
        for heights, sign in zip(self.heights, (1.0, -1.0), strict=True):
            out = jnp.maximum(2.0 * sign * position / length, 0.0)[None]
            share = jnp.maximum((out - begins) / (1.0 - begins), 0.0) ** 2
            drop = drop + jnp.tensordot(heights, share, 1)
        return drop


def modified_log(x):
    factor, fraction, drop = 0.1 + 7.9 * x[0], 0.1 + 0.9 * x[1], 1.0 + 99.0 * x[2]
    return bj.FujiwaraKawase(MOST, factor, fraction, 1e-6 * drop, MODULUS)


def same_ends(x):
    return Free(jnp.stack([x, x]) * jnp.asarray(SCALES)[None])


def own_ends(x):
    return Free(x.reshape(2, -1) * jnp.asarray(SCALES)[None])


# From the numbers in a unit box to the profile; where to begin.
FAMILIES = {
    "F. & K.": (modified_log, np.array([0.2, 0.9, 0.3])),
    "even": (same_ends, np.full(4, 0.05)),
    "free": (own_ends, np.full(8, 0.05)),
}
KNOWN = {
    "straight": bj.Straight(),
    "ISO log": bj.Logarithmic(),
    "Lundberg": bj.Lundberg(MOST, MODULUS),
}


def contact(profile, raceway):
    """The roller with a profile, on a plane or a cone."""
    steel = bj.Material(elastic_modulus=210e9)
    given = {}
    if raceway == "cone":
        # Same apex: both radii of curvature grow from it in proportion.
        growth = contact(profile, "plane").roller_radius(jnp.array([0.0, -1.0]))
        angle = jnp.arctan(RADIUS * (growth[1] / growth[0] - 1.0))
        given = {"raceway_radius": RADIUS, "raceway_half_angle": angle}
    return RollerContact(
        LENGTH,
        0.010,
        0.012,
        roller_profile=profile,
        material=steel,
        raceway_material=steel,
        **given,
    )


def even_pressure(raceway, load):
    """Of an endless roller, line loads as the radii [Pa]."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    radius = contact(bj.Straight(), raceway).relative_radius(
        jnp.asarray(0.5 * LENGTH * nodes)
    )
    area = 0.5 * LENGTH * float(jnp.asarray(weights) @ radius)
    return np.sqrt(load * MODULUS / (np.pi * area))


class Cases:
    """Operating cases on one raceway, solved at once on one grid."""

    def __init__(self, raceway, cases, half_width, cells):
        self.raceway, self.cases = raceway, cases
        self.grid = contact(bj.Straight(), raceway).grid(half_width, *cells)
        self.influence = influence(self.grid, MODULUS)
        self.run = eqx.filter_jit(self.solve)
        self.loads, self.tilts = (jnp.asarray(v) for v in zip(*cases, strict=True))

    def gap(self, profile):
        return contact(profile, self.raceway).gap(self.grid)

    def solve(self, gap, matrix):
        def one(load, tilt):
            return solve_pressure(matrix, gap, load=load, tilt=tilt, throw=False)

        return jax.vmap(one)(self.loads, self.tilts)

    def report(self, profile):
        """Numbers of every case, as arrays."""
        found = self.run(self.gap(profile), self.influence)
        if not bool(jnp.all(found.converged)):
            raise RuntimeError(f"not converged: {found.result}")
        grid, pressure = self.grid, np.asarray(found.pressure)
        reach = np.where(pressure > 0, np.asarray(grid.x + grid.half_x)[:, None], 0.0)
        return {
            "peak": pressure.max(axis=(1, 2)),
            "approach": np.asarray(found.approach),
            "margin": float(grid.half_width) / reach.max(axis=(1, 2)),
            "centre": pressure[:, 0],
        }

    def objective(self, build):
        """(numbers, temperature, influence) -> smooth largest pressure [Pa]."""

        def value(x, temperature, matrix):
            pressure = self.solve(self.gap(build(x)), matrix).pressure[:, 0]
            pressure = pressure.at[:, jnp.array([0, -1])].multiply(ENDS)
            return temperature * jax.nn.logsumexp(pressure / temperature)

        return value


def optimised(cases, check, family, starts, sharpness, max_steps):
    """Best numbers of a family, as judged by other cells, and what they cost."""
    build, start = FAMILIES[family]
    value = cases.objective(build)
    given = jnp.asarray(start), jnp.asarray(sharpness[0]), cases.influence
    only, value_s = compiled(value, *given)
    both, both_s = compiled(jax.value_and_grad(value), *given)
    searches = []
    for begin in begins(start, starts):
        since = time.perf_counter()
        searches.append(descend(both, begin, sharpness, max_steps, cases.influence))
        searches[-1]["seconds"] = time.perf_counter() - since
    least = min(s["value"] for s in searches)

    def judged(search):
        return check.report(build(jnp.asarray(search["x"])))["peak"].max()

    best = min(searches, key=judged)
    at = (jnp.asarray(best["x"]), jnp.asarray(sharpness[-1]), cases.influence)
    calls = {"value": lambda: only(*at), "both": lambda: both(*at)}
    times = {name: min(spent) for name, spent in shuffled(calls, 9).items()}
    count = [s["evaluations"] for s in searches]
    return {
        "x": [float(v) for v in best["x"]],
        "smooth": best["value"],
        "spread": max(s["value"] for s in searches) / least - 1.0,
        "evaluations": float(np.median(count)),
        "solves": float(np.median(count)) * len(cases.cases),
        "seconds": float(np.median([s["seconds"] for s in searches])),
        "compile_s": value_s + both_s,
        "ms": 1e3 * times["value"],
        "gradient": times["both"] / times["value"],
        "error": gradient_error(both, only, *at),
    }


def begins(start, count):
    """The start, and others from a half to twice as large."""
    rng = np.random.default_rng(7)
    factors = 2.0 ** rng.uniform(-1.0, 1.0, size=(count - 1, start.size))
    return [start, *np.clip(start[None] * factors, 0.0, 1.0)]


def descend(both, x, sharpness, max_steps, matrix):
    """L-BFGS-B, the maximum sharper and sharper."""
    evaluations, value = 0, np.inf
    size, _ = both(jnp.asarray(x), jnp.asarray(sharpness[0]), matrix)
    for temperature in sharpness:

        def scaled(steps, temperature=temperature):
            x = jnp.asarray(FIRST_STEP * steps)
            value, slope = both(x, jnp.asarray(temperature), matrix)
            return float(value / size), FIRST_STEP * np.asarray(slope / size)

        done = minimize(
            scaled,
            x / FIRST_STEP,
            jac=True,
            method="l-bfgs-b",
            bounds=[(0.0, 1.0 / FIRST_STEP)] * x.size,
            options={"maxiter": max_steps, "ftol": 1e-8, "gtol": 1e-6},
        )
        x, value = FIRST_STEP * done.x, float(done.fun * size)
        evaluations += done.nfev
    return {"x": x, "value": value, "evaluations": evaluations}


def gradient_error(both, only, x, temperature, matrix):
    """Largest difference of the gradient from central differences, relative.

    Beside the optimum, where the gradient is not small. Cells that come and go make
    kinks, which a step may straddle: of three steps the best for each number.
    """
    x = jnp.clip(0.9 * x + 0.05, 0.02, 0.98)
    slope = np.asarray(both(x, temperature, matrix)[1])
    errors = []
    for step in (1e-4, 1e-5, 1e-6):
        moves = [step * e for e in jnp.eye(x.size)]
        rise = [
            float(only(x + m, temperature, matrix) - only(x - m, temperature, matrix))
            for m in moves
        ]
        errors.append(np.abs(np.array(rise) / (2.0 * step) - slope))
    return float(np.max(np.min(errors, axis=0)) / np.max(np.abs(slope)))


def study(raceway, kind, operating, cells, fine, families, **how):
    """A row for each design."""
    load, tilt = max(operating, key=lambda c: (c[0], c[1]))
    plain = contact(bj.Straight(), raceway)
    width = 2.5 * plain.line_half_width(load)
    if fine != cells:
        width = plain.solve(load, tilt=tilt).grid.half_width
    coarse = check = Cases(raceway, operating, width, cells)
    if fine != cells:
        check = Cases(raceway, operating, width, fine)
    designs: dict[str, tuple] = {name: (p, {}) for name, p in KNOWN.items()}
    for family in families:
        cost = optimised(coarse, check, family, **how)
        designs[family] = FAMILIES[family][0](jnp.asarray(cost["x"])), cost
    rows = []
    for name, (profile, cost) in designs.items():
        found, finer = coarse.report(profile), check.report(profile)
        y = np.asarray(coarse.grid.y)
        rows.append(
            {
                "raceway": raceway,
                "cases": kind,
                "design": name,
                "operating": operating,
                "peak": found["peak"].tolist(),
                "fine": finer["peak"].tolist(),
                "approach": found["approach"].tolist(),
                "margin": float(found["margin"].min()),
                "even": even_pressure(raceway, max(c[0] for c in operating)),
                "end_cell": 2.0 * float(coarse.grid.half_y[0]),
                "fine_end_cell": 2.0 * float(check.grid.half_y[0]),
                "y": y.tolist(),
                "drop": np.asarray(
                    profile.drop(coarse.grid.y, jnp.array(LENGTH), jnp.array(0.011))
                ).tolist(),
                "centre": found["centre"][operating.index((load, tilt))].tolist(),
                **cost,
            }
        )
    return rows


def show(rows):
    for raceway, kind in dict.fromkeys((r["raceway"], r["cases"]) for r in rows):
        mine = [r for r in rows if (r["raceway"], r["cases"]) == (raceway, kind)]
        show_place(raceway, kind, mine)
    made = [r for r in rows if "x" in r]
    worst = max(r["error"] for r in made)
    print(verdict("largest error of a gradient", worst, GOALS["gradient"]))
    off = max(abs(max(r["fine"]) / max(r["peak"]) - 1.0) for r in made)
    print(verdict("worst peak of an optimum, fine cells", off, GOALS["fine"]))


def show_place(raceway, kind, mine):
    width = 11

    def line(name, values, form):
        told = (f"{'-' if v is None else format(v, form):>{width}}" for v in values)
        print(f"{name:20}" + "".join(told))

    even, end = mine[0]["even"], 1e6 * mine[0]["end_cell"]
    print(
        f"\non a {raceway}, {kind}: largest pressure of a cell, MPa (end cells"
        f" {end:.1f} µm; even: {1e-6 * even:.0f})"
    )
    line("", [r["design"] for r in mine], "s")
    for k, (load, tilt) in enumerate(mine[0]["operating"]):
        name = f"{load:.0f} N" + (f", {1e3 * tilt:+.1f} mrad" if tilt else "")
        line(name, [1e-6 * r["peak"][k] for r in mine], ".1f")
    line("worst", [1e-6 * max(r["peak"]) for r in mine], ".1f")
    finer = 1e6 * mine[0]["fine_end_cell"]
    line(f"worst, {finer:.1f} µm cells", [1e-6 * max(r["fine"]) for r in mine], ".1f")
    line("worst over even", [max(r["peak"]) / even for r in mine], ".3f")
    level = mine[0]["operating"].index((MOST, 0.0))
    line("approach, µm", [1e6 * r["approach"][level] for r in mine], ".3f")
    line("margin", [r["margin"] for r in mine], ".2f")
    for name, key, form in (
        ("evaluations", "evaluations", ".0f"),
        ("solves", "solves", ".0f"),
        ("time, s", "seconds", ".1f"),
        ("compile, s", "compile_s", ".1f"),
        ("evaluation, ms", "ms", ".1f"),
        ("with gradient, times", "gradient", ".2f"),
        ("gradient error", "error", ".0e"),
        ("spread of searches", "spread", ".0e"),
    ):
        line(name, [r.get(key) for r in mine], form)
    for r in mine:
        if "x" in r:
            print(f"{r['design']}: {numbers(r)}")
    found = {r["design"]: max(r["peak"]) for r in mine}
    if {"even", "free"} <= set(found):
        gain = 1.0 - found["free"] / found["even"]
        print(f"unlike ends below like ones: {100 * gain:.2f} %")


def numbers(row):
    profile = FAMILIES[row["design"]][0](jnp.asarray(row["x"]))
    if isinstance(profile, bj.FujiwaraKawase):
        return (
            f"K1 = {float(profile.load_factor):.3g}, K2 ="
            f" {float(profile.crowned_fraction):.3g}, zm ="
            f" {1e6 * float(profile.end_drop):.3g} µm"
        )
    ends = 1e6 * np.asarray(profile.heights)
    if row["design"] == "even":
        ends = ends[:1]
    told = " | ".join(", ".join(f"{h:.2f}" for h in end) for end in ends)
    return f"{told} µm (end drops {', '.join(f'{e.sum():.2f}' for e in ends)})"


def plot(rows):
    """Profiles, and pressures along the roller under the worst case."""
    places = list(dict.fromkeys((r["raceway"], r["cases"]) for r in rows))
    figure, axes = subplots(
        2,
        len(places),
        figsize=(4.6 * len(places), 6.4),
        sharex=True,
        sharey="row",
        squeeze=False,
        layout="constrained",
    )
    for column, (raceway, kind) in enumerate(places):
        above, below = axes[:, column]
        mine = [r for r in rows if (r["raceway"], r["cases"]) == (raceway, kind)]
        for r in mine:
            y = 1e3 * np.asarray(r["y"])
            look = {"color": COLOURS[r["design"]], "linewidth": 1.3}
            if "x" not in r:
                look["linestyle"] = "--"
            above.plot(y, 1e6 * np.asarray(r["drop"]), label=r["design"], **look)
            below.plot(y, 1e-6 * np.asarray(r["centre"]), **look)
        tilt = max(t for _, t in mine[0]["operating"])
        told = f", {1e3 * tilt:+.1f} mrad" if tilt else ""
        above.set_title(f"On a {raceway}, {kind}", loc="left")
        below.set_title(f"{MOST:.0f} N{told}", loc="left")
        below.set_xlabel("position along the roller, mm")
    axes[0, 0].set_ylabel("drop, µm")
    axes[0, 0].set_ylim(12, 0)
    axes[1, 0].set_ylabel("pressure at x = 0, MPa")
    axes[1, 0].set_ylim(800, 2400)
    axes[0, 0].legend(frameon=False, loc="lower center", fontsize=8, ncols=2)
    return figure


@benchmark("few cells, two steps", show, plot, starts="searches of each kind")
def main(smoke, starts=3):
    if smoke:
        how = {"starts": 1, "sharpness": SHARPNESS[:1], "max_steps": 2}
        cells = SMOKE_CELLS, SMOKE_CELLS
        operating = [(MOST, 0.0), (MOST, TILT)]
        return study("plane", "tilted", operating, *cells, ["F. & K."], **how)
    how = {"starts": starts, "sharpness": SHARPNESS, "max_steps": 40}
    rows = []
    for raceway, kind in PLACES:
        rows += study(raceway, kind, SETS[kind], CELLS, FINE, FAMILIES, **how)
    return rows

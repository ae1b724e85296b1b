"""What do others take for the pressure between half-spaces?

The tapered roller of method 004 at 3000 N (15 mm long, 10 and 12 mm thick, on a plane;
cells fill its rectangle of 15 x 0.3528 mm) and a sphere (10 mm, 100 N), on even cells.
ContactMechanics 1.8.3 (free, not periodic, half-space): its own conjugate gradients
after Polonsky and Keer, and those of NuMPI on its dual objective with the load as mean
value; Tamaas 2.9.0: `PolonskyKeerRey` with the operator of `registerNonPeriodic` (its
default one is periodic). Both are optional: `pip install ContactMechanics tamaas`.

Residual: largest gap in contact, or overlap outside, over the mean displacement of the
loaded surface, or missing share of the load if larger; of all solvers' pressures by one
function. Each peer gets the loosest of its own tolerances (in steps of a square root of
ten) that reaches the residual wanted. Difference: of pressures, from ours, relative to
the largest; a time is given only if it is less than 100 times that residual. Whatever
depends on the cells alone is made before the clock starts: kernels, plans, compiling.
Ours on all cells, as theirs, and on the half that symmetry leaves; many loads (1 to
5 kN, 128 x 128 cells) at once under `jax.vmap`, theirs one by one, every eighth. One
core. Steps of peers take two products with the influence matrix (NuMPI's one); ours up
to two, and two with its approximate inverse.

README: 256 x 256 cells to 1e-6: 355 ms, others 5.7 to 6.5 times; 64 loads at once 137
ms each, others 4.2 to 5.4 times | fastest peer's time; 3 times faster for 64 | yes

Last run:

problem     cells wanted  solver                 ms  ratio  steps  residual  difference
taper   128 x 128  1e-06  ours, all cells      55.8    1.0     22     4e-07       0e+00
taper   128 x 128  1e-06  ours, half           28.2    0.5     22     4e-07       2e-13
taper   128 x 128  1e-06  ContactMechanics    502.6    9.0     77     6e-07       4e-05
taper   128 x 128  1e-06  with NuMPI's CG     431.1    7.7     78     5e-07       6e-05
taper   128 x 128  1e-06  Tamaas              563.0   10.1     78     3e-07       3e-05
taper   128 x 128  1e-09  ours, all cells      67.5    1.0     28     3e-10       0e+00
taper   128 x 128  1e-09  ours, half           35.8    0.5     28     3e-10       2e-13
taper   128 x 128  1e-09  ContactMechanics    804.5   11.9    130     5e-10       3e-08
taper   128 x 128  1e-09  with NuMPI's CG     924.9   13.7    135     6e-10       5e-08
taper   128 x 128  1e-09  Tamaas              912.2   13.5    130     4e-10       3e-08
taper   256 x 256  1e-06  ours, all cells     354.9    1.0     29     8e-07       0e+00
taper   256 x 256  1e-06  ours, half          222.9    0.6     29     8e-07       3e-13
taper   256 x 256  1e-06  ContactMechanics   2012.8    5.7     95     4e-07       7e-05
taper   256 x 256  1e-06  with NuMPI's CG    2294.7    6.5     95     6e-07       9e-05
taper   256 x 256  1e-06  Tamaas                  -      -    106     6e-07       1e-04
sphere  128 x 128  1e-06  ours, all cells      30.6    1.0     11     5e-07       0e+00
sphere  128 x 128  1e-06  ours, half           18.3    0.6     11     5e-07       1e-13
sphere  128 x 128  1e-06  ContactMechanics    198.6    6.5     33     3e-07       3e-05
sphere  128 x 128  1e-06  with NuMPI's CG     261.5    8.5     30     4e-07       3e-05
sphere  128 x 128  1e-06  Tamaas              244.8    8.0     32     4e-07       3e-05

64 loads of the taper, 128 x 128 cells
solver               ms/load  ratio  residual  difference
ours, all cells        136.8    1.0     1e-06       0e+00
ours, half              68.1    0.5     1e-06       3e-13
ContactMechanics       568.1    4.2     8e-07       1e-04
with NuMPI's CG        682.6    5.0     5e-07       7e-05
Tamaas                 736.7    5.4     4e-07       3e-05

least time of a peer over ours, all cells, alone, 128 x 128: 6.49 (at least 1): met
least time of a peer over ours, all cells, alone, 256 x 256: 5.67 (at least 1): met
least time of a peer over ours, all cells, many: 4.15 (at least 3): met

AMD EPYC, 2 cores, load average 1.2; devices: 1 cpu; jax 0.10.1
"""

import contextlib
import importlib.util
import io
import os
import tempfile
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, compiled, relative, shuffled, table, verdict
from strips_halfspace import HALF_WIDTH, MODULUS, taper

from bearingjax.contact.halfspace import (
    ConjugateGradients,
    even_grid,
    influence,
    solve_pressure,
)

LOADS = {"taper": 3000.0, "sphere": 100.0}
RADIUS = 0.010  # of the sphere [m]
FULL: dict[str, Any] = {
    "runs": (
        ("taper", 128, 1e-6),
        ("taper", 128, 1e-9),
        ("taper", 256, 1e-6),
        ("sphere", 128, 1e-6),
    ),
    "rounds": 3,
    "batch": {"n": 128, "count": 64, "wanted": 1e-6, "every": 8},
}
SMOKE: dict[str, Any] = {
    "runs": (("taper", 16, 1e-6),),
    "rounds": 1,
    "batch": {"n": 16, "count": 4, "wanted": 1e-6, "every": 2},
}
PACKAGES = {"ContactMechanics": "ContactMechanics", "tamaas": "Tamaas"}
NOISE = 100.0  # difference of pressures over residual, at most
MOST = 1000  # steps of a peer


class Case:
    """One problem on n x n cells.

    Attributes:
        load: Load [N].
        size: Of the rectangle, across and along [m].
        gap: On all cells [m].
        area: Of a cell [m²].
    """

    def __init__(self, name, n):
        self.name, self.n, self.load = name, n, LOADS[name]
        half = (0.75 * self.load * RADIUS / MODULUS) ** (1 / 3)
        width, length = {
            "taper": (HALF_WIDTH, 0.015),
            "sphere": (1.25 * half, 2.5 * half),
        }[name]
        self.size = (2 * width, length)
        self.grids = {
            "all cells": even_grid(length, width, n, n, symmetric=False),
            "half": even_grid(length, width, n, n),
        }
        self.gap = np.asarray(self.gap_on(self.grids["all cells"]))
        self.area = self.size[0] * self.size[1] / n**2
        whole = influence(self.grids["all cells"], MODULUS)
        self.displaced = jax.jit(lambda pressure: whole(pressure))

    def gap_on(self, grid):
        if self.name == "taper":
            return taper().gap(grid)
        return (grid.x[:, None] ** 2 + grid.y[None] ** 2) / (2 * RADIUS)

    def residual(self, pressure, load):
        """How far a pressure on all cells is from a solution [1]."""
        moved = np.asarray(self.displaced(jnp.asarray(pressure)))
        inside = pressure > 0
        gap = moved + self.gap
        gap = gap - gap[inside].mean()
        off = np.where(inside, np.abs(gap), np.maximum(-gap, 0)).max()
        off = off * pressure.sum() / (pressure * moved).sum()
        missing = abs(pressure.sum() * self.area / load - 1)
        return float(max(off, missing, -pressure.min() / pressure.max()))


class Ours:
    """Our solver, compiled, on all cells or on half of them."""

    def __init__(self, case, which, tolerance, loads):
        grid = case.grids[which]
        matrix, gap = influence(grid, MODULUS), case.gap_on(grid)
        solver = ConjugateGradients(tolerance)

        def solve(matrix, gap, load):
            kept = {"load": load, "solver": solver, "throw": False}
            solution = solve_pressure(matrix, gap, **kept)
            return solution.pressure, solution.steps

        many = jax.vmap(solve, in_axes=(None, None, 0))
        self.symmetric = grid.symmetric
        self.given = matrix, gap, jnp.asarray(loads)
        function = many if np.ndim(loads) else solve
        self.program, self.compile_s = compiled(function, *self.given)

    def __call__(self):
        return self.program(*self.given)

    def found(self):
        """Pressure on all cells, steps."""
        pressure, steps = (np.asarray(v) for v in self())
        if self.symmetric:
            other = np.flip(pressure, axis=-2)
            pressure = np.concatenate([other, pressure], axis=-2)
        return pressure, int(steps.max())


class Gradients:
    """ContactMechanics: Polonsky and Keer's conjugate gradients."""

    name = "ContactMechanics"
    package = "ContactMechanics"

    def __init__(self, case):
        from ContactMechanics import FreeFFTElasticHalfSpace  # pyright: ignore[reportMissingImports]
        from SurfaceTopography import Topography  # pyright: ignore[reportMissingImports]

        self.case = case
        cells = (case.n, case.n)
        self.substrate = FreeFFTElasticHalfSpace(cells, MODULUS, case.size)
        self.surface = Topography(-case.gap, case.size)
        # Roughly the displacement that the residual counts in, for each newton.
        self.scale = 1 / (MODULUS * np.sqrt(case.size[0] * case.size[1]))

    def solve(self, load, tolerance):
        """Pressure, steps."""
        from ContactMechanics.Optimization import constrained_conjugate_gradients  # pyright: ignore

        n = self.case.n
        start = np.zeros(self.substrate.nb_subdomain_grid_pts)
        start[:n, :n] = -load / n**2
        found = constrained_conjugate_gradients(
            self.substrate,
            self.surface,
            external_force=load,
            initial_forces=start,
            pentol=tolerance * load * self.scale,
            forcetol=np.inf,
            thermotol=np.inf,
            maxiter=MOST,
        )
        if not found.success:
            return None, found.nit
        return np.asarray(found.jac) / self.case.area, found.nit


class Dual(Gradients):
    """NuMPI's conjugate gradients on the dual objective of ContactMechanics."""

    name = "with NuMPI's CG"

    def __init__(self, case):
        from ContactMechanics.Systems import NonSmoothContactSystem  # pyright: ignore[reportMissingImports]

        super().__init__(case)
        self.system = NonSmoothContactSystem(self.substrate, self.surface)

    def solve(self, load, tolerance):
        from NuMPI.Optimization import CCGWithoutRestart  # pyright: ignore[reportMissingImports]

        n = self.case.n
        # It prints what it thinks of round-off.
        with contextlib.redirect_stdout(io.StringIO()):
            found = CCGWithoutRestart.constrained_conjugate_gradients(
                self.system.dual_objective(0.0, gradient=True),
                self.system.dual_hessian_product,
                x0=np.full((n, n), load / n**2),
                mean_val=load / n**2,
                gtol=tolerance * load * self.scale,
                maxiter=MOST,
            )
        if not found.success:
            return None, found.nit
        return np.asarray(found.x).reshape(n, n) / self.case.area, found.nit


class Rey:
    """Tamaas: Polonsky and Keer's method as Rey has it."""

    name = "Tamaas"
    package = "tamaas"

    def __init__(self, case):
        import tamaas  # pyright: ignore[reportMissingImports]

        tamaas.set_log_level(tamaas.LogLevel.error)
        self.case, self.tamaas = case, tamaas
        kind = tamaas.model_type.basic_2d
        cells = [case.n, case.n]
        self.model = tamaas.ModelFactory.createModel(kind, list(case.size), cells)
        self.model.E, self.model.nu = MODULUS, 0.0
        tamaas.ModelFactory.registerNonPeriodic(self.model, "free")
        self.solvers = {}

    def _solver(self, tolerance):
        if tolerance not in self.solvers:
            solver = self.tamaas.PolonskyKeerRey(self.model, -self.case.gap, tolerance)
            solver.setIntegralOperator("free")
            solver.max_iter = MOST
            self.solvers[tolerance] = solver
        return self.solvers[tolerance]

    def solve(self, load, tolerance):
        solver = self._solver(tolerance)
        # It starts from what is there.
        self.model.traction[...] = 0.0
        off = solver.solve(load / (self.case.size[0] * self.case.size[1]))
        if off > tolerance:
            return None, 0
        return np.array(self.model.traction), 0

    def count(self, load, tolerance):
        """Steps of a solve, which only the log tells."""
        solver, levels = self._solver(tolerance), self.tamaas.LogLevel
        often, solver.dump_freq = solver.dump_freq, 1
        self.tamaas.set_log_level(levels.info)
        with tempfile.TemporaryFile() as file:
            kept = [os.dup(stream) for stream in (1, 2)]
            for stream in (1, 2):
                os.dup2(file.fileno(), stream)
            try:
                self.solve(load, tolerance)
            finally:
                for stream, old in zip((1, 2), kept, strict=True):
                    os.dup2(old, stream)
                    os.close(old)
                self.tamaas.set_log_level(levels.error)
                solver.dump_freq = often
            file.seek(0)
            lines = file.read().decode().splitlines()
        counts = [line.split()[0] for line in lines if len(line.split()) == 3]
        return max((int(count) for count in counts if count.isdigit()), default=0)


def available():
    """Peers that are installed."""
    return [
        peer
        for peer in (Gradients, Dual, Rey)
        if importlib.util.find_spec(peer.package) is not None
    ]


def loosest(peer, load, wanted):
    """Largest tolerance of a peer's own with which it reaches a residual, and what it
    then finds; `None` if none does."""
    for power in range(7):
        own = 10 * wanted * 10 ** (-power / 2)
        pressure, steps = peer.solve(load, own)
        if pressure is None:
            return None
        if peer.case.residual(pressure, load) <= wanted:
            return own, pressure, steps
    return None


def beside(name, n, wanted, rounds):
    """Rows: a problem on n x n cells, solved to a residual by all."""
    case = Case(name, n)
    calls, rows = {}, []
    truth = None
    for which in case.grids:
        ours = Ours(case, which, wanted, case.load)
        pressure, steps = ours.found()
        truth = pressure if truth is None else truth
        rows.append(row(case, which, wanted, "ours, " + which, pressure, steps, truth))
        calls["ours, " + which] = ours
    for make in available():
        peer = make(case)
        got = loosest(peer, case.load, wanted)
        if got is None:
            rows.append(row(case, "all cells", wanted, peer.name, None, 0, truth))
            continue
        own, pressure, steps = got
        steps = peer.count(case.load, own) if isinstance(peer, Rey) else steps
        rows.append(row(case, "all cells", wanted, peer.name, pressure, steps, truth))
        if rows[-1]["difference"] <= NOISE * wanted:
            calls[peer.name] = _once(peer, case.load, own)
    times = shuffled(calls, rounds)
    for found in rows:
        if found["solver"] in times:
            found["ms"] = 1e3 * float(np.median(times[found["solver"]]))
    return rows


def _once(peer, load, own):
    return lambda: peer.solve(load, own)[0]


def row(case, which, wanted, solver, pressure, steps, truth):
    """What is known before the clock starts."""
    found = {"problem": case.name, "n": case.n, "wanted": wanted, "solver": solver}
    if pressure is None:
        return found | {"steps": 0, "residual": None, "difference": None, "ms": None}
    return found | {
        "steps": int(steps),
        "residual": case.residual(pressure, case.load),
        "difference": relative(pressure, truth),
        "ms": None,
    }


def many(n, count, wanted, every):
    """Rows: many loads of the taper, time a load; ours at once, peers one by one.

    Args:
        n: Cells each way.
        count: Number of loads.
        wanted: Residual.
        every: Peers solve one load in so many.
    """
    case = Case("taper", n)
    loads = np.linspace(1000.0, 5000.0, count)
    few = loads[::every]
    rows, calls, truth = [], {}, np.zeros(())
    for which in case.grids:
        ours = Ours(case, which, wanted, loads)
        pressure, _ = ours.found()
        truth = pressure if not truth.ndim else truth
        calls["ours, " + which] = ours
        rows.append(together(case, loads, "ours, " + which, pressure, truth))
    times = {k: np.array(v) / count for k, v in shuffled(calls, 3).items()}
    for make in available():
        peer = make(case)
        got = loosest(peer, few[0], wanted)
        if got is None:
            continue
        kept = []

        def each(peer=peer, own=got[0], kept=kept):
            kept[:] = [peer.solve(load, own)[0] for load in few]

        spent = shuffled({peer.name: each}, 1, warm=False)[peer.name]
        if all(pressure is not None for pressure in kept):
            times[peer.name] = np.array(spent) / len(few)
            rows.append(together(case, few, peer.name, kept, truth[::every]))
    for found in rows:
        found["ms"] = 1e3 * float(np.median(times[found["solver"]]))
    return rows


def together(case, loads, solver, pressure, truth):
    """Worst figures of many loads."""
    residuals = [case.residual(*pair) for pair in zip(pressure, loads, strict=True)]
    return {
        "solver": solver,
        "n": case.n,
        "cases": len(loads),
        "residual": max(residuals),
        "difference": relative(pressure, truth),
    }


def figures(rows, batch):
    """The least advantage over the fastest peer, alone and for many loads."""
    found = {}
    for n in dict.fromkeys(r["n"] for r in rows):
        ratios = []
        for key in dict.fromkeys((r["problem"], r["wanted"]) for r in rows):
            mine = [r for r in rows if (r["problem"], r["wanted"], r["n"]) == (*key, n)]
            best = _best(mine)
            if best is not None:
                ratios.append(best)
        if ratios:
            found[f"alone, {n} x {n}"] = min(ratios)
    best = _best(batch)
    if best is not None:
        found["many"] = best
    return found


def _best(rows):
    """Time of the fastest peer over ours on all cells."""
    ours = next((r["ms"] for r in rows if r["solver"] == "ours, all cells"), None)
    peers = [r["ms"] for r in rows if not r["solver"].startswith("ours") and r["ms"]]
    return min(peers) / ours if peers and ours else None


def show(result):
    rows = []
    for r in result["rows"]:
        if r["solver"] == "ours, all cells":
            base = r["ms"]
        rows.append(r | {"ratio": r["ms"] / base if r["ms"] else None})
    errors = {"residual": "{residual:.0e}", "difference": "{difference:.0e}"}
    table(rows, {
        "problem": "{problem}", "cells": "{n} x {n}", "wanted": "{wanted:.0e}",
        "solver": "{solver}", "ms": "{ms:.1f}", "ratio": "{ratio:.1f}",
        "steps": "{steps:d}", **errors,
    })  # fmt: skip
    if result["batch"]:
        one = result["batch"][0]
        print(f"\n{one['cases']} loads of the taper, {one['n']} x {one['n']} cells")
        table([r | {"ratio": r["ms"] / one["ms"]} for r in result["batch"]], {
            "solver": "{solver}", "ms/load": "{ms:.1f}", "ratio": "{ratio:.1f}",
            **errors,
        })  # fmt: skip
    print()
    for name, figure in result["figures"].items():
        goal = 3.0 if name == "many" else 1.0
        what = "least time of a peer over ours, all cells, " + name
        print(verdict(what, figure, goal, most=False))
    if result["absent"]:
        print("not installed, not timed: " + ", ".join(result["absent"]))


def wrong(result):
    """Whether ours missed its tolerance."""
    ours = [r for r in result["rows"] if r["solver"].startswith("ours")]
    missed = [r for r in ours if r["residual"] is None or r["residual"] > r["wanted"]]
    return missed and "ours missed its tolerance."


@benchmark("few cells", show, wrong=wrong)
def main(smoke):
    sizes = SMOKE if smoke else FULL
    # So that no thread of XLA helps.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    rows = [
        r
        for name, n, wanted in sizes["runs"]
        for r in beside(name, n, wanted, sizes["rounds"])
    ]
    batch = many(**sizes["batch"])
    there = {peer.package for peer in available()}
    absent = [name for key, name in PACKAGES.items() if key not in there]
    told = {"rows": rows, "batch": batch, "figures": figures(rows, batch)}
    return told | {"absent": absent}

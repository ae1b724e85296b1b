"""How far is one call of a roller bearing from a C loop of the same algorithm?

A cylindrical roller bearing with 14 crowned rollers, 32 nodes per raceway contact:
under a radial load; under the same load with the rings out of line; and that again with
crowned raceways, outer and inner unlike. Between equal raceways a roller without
inertia stands midway from the start, so that only the third case takes Newton steps.

`c_loop.c` is compiled on demand; its result is checked against JAX, then all variants
are timed in shuffled order: hot (the same call in a block) and cold (one call after
64 MB of other memory). Only ratios within one run count.

Variants: the C loop by its own clock (the base of the ratios) and through `ctypes`, as
Python calls it (the base of the ratio "call", for the cold call); `filter_jit` with the
element as an argument, so that any design may come; and `jit` with the element closed
over (constants folded), as is and compiled ahead of time; and one bearing's share of a
call with 256 motions, in chunks of 32, where the overhead of a call is shared.

Then the third case with 32 slices, as others would solve it (`peers.py`): NumPy,
`scipy.optimize.root`, `jax.scipy` BFGS and `optimistix.BFGS`, one of each per roller
and all from midway; median of a call, first call (which compiles) apart.

Half of what a caller sees may be the hand-over from his thread to one of XLA. It is
gone on one core (`--pinned`), or where the calling thread does the work (`--inline`:
`jax.config.update("jax_cpu_enable_async_dispatch", False)` before all else).

README: 14 rollers, 32 nodes: 15 to 44 times the C loop hot, 33 to 50 cold; one of 256
in a call 3.2 to 3.8 | 5 times hot, 8 cold | **missed** 3- to 9-fold

Last run:

radial: most steps 0 (JAX 0)
                                     hot, µs         cold, µs         ratio to C
                                 min  median      min  median    hot  cold  call
C loop                           4.3     5.0     11.1    14.2    1.0   1.0   0.3
C through ctypes                 4.6     5.9     25.3    45.6    1.2   3.2   1.0
filter_jit(element, q)         255.8   368.6   1096.3  1480.5   73.9 104.1  32.5
jit(q), element closed over    147.8   220.9    512.8   654.6   44.3  46.0  14.4
the same, ahead of time        152.5   207.3    281.9   736.0   41.6  51.7  16.2
one of 256 in a call            14.6    18.2     15.3    21.9    3.7   1.5   0.5

misaligned: most steps 0 (JAX 0)
                                     hot, µs         cold, µs         ratio to C
                                 min  median      min  median    hot  cold  call
C loop                           4.2     4.6      9.4    13.2    1.0   1.0   0.3
C through ctypes                 4.5     4.9     16.4    45.7    1.1   3.5   1.0
filter_jit(element, q)         219.8   315.4    865.8  1440.4   68.9 108.7  31.5
jit(q), element closed over    136.2   186.5    414.0   668.0   40.7  50.4  14.6
the same, ahead of time        136.5   192.3    431.7   664.2   42.0  50.1  14.5
one of 256 in a call            12.0    17.4     14.2    20.4    3.8   1.5   0.4

misaligned, raceways unlike: most steps 4 (JAX 4)
                                     hot, µs         cold, µs         ratio to C
                                 min  median      min  median    hot  cold  call
C loop                          18.1    18.9     21.7    26.0    1.0   1.0   0.5
C through ctypes                18.5    19.2     37.8    55.5    1.0   2.1   1.0
filter_jit(element, q)         304.8   397.7    983.9  2101.8   21.1  80.9  37.9
jit(q), element closed over    229.9   283.7    384.0   856.2   15.0  33.0  15.4
the same, ahead of time        226.8   279.3    368.3   813.1   14.8  31.3  14.6
one of 256 in a call            50.8    61.0     52.1    66.0    3.2   2.5   1.2

goal: hot ≤ 5, cold ≤ 8

raceways unlike, 32 slices          µs   ratio  first, s  error: force  stiffness
C through ctypes                 159.1    0.33      0.00         0e+00      0e+00
ours                             474.8    1.00      1.65         5e-17      3e-16
NumPy                           2375.7    5.00      0.05         6e-16      9e-16
SciPy root                      6299.6   13.27      0.00         7e-16      7e-16
jax.scipy BFGS                 14558.9   30.66      3.74         4e-08      6e-09
optimistix BFGS                 6481.8   13.65      1.94         7e-11      2e-12

AMD EPYC, 2 cores, load average 1.5; devices: 1 cpu; jax 0.10.1

Why a single call does not reach the C loop: a call of a compiled JAX program that does
nothing takes 6 to 8 µs here, more than the whole C loop (4.3 µs; it leaves open rollers
out, which a program of fixed shape cannot). The compiled program runs hundreds of
kernels, a fraction of a microsecond each (`skip_what_is_absent.py` counts some 160 in
its text, a loop's body once). In a batch the overhead is shared, rollers that the rings
leave room are left out, and rollers that are done no longer wait for the slowest; what
remains is, by a profile, arithmetic spread over many small kernels, the assembly, and
the fixed passes of the search for the edges of the contact zones.
"""

import ctypes
import functools
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import peers
from bench import benchmark, relative, shuffled, timed

import bearingjax as bj

SOURCE = Path(__file__).with_name("c_loop.c")
FLAGS = (
    "-std=c99 -O3 -march=native -fopenmp-simd -fno-math-errno -fno-trapping-math"
    " -shared -fPIC"
).split()
GOAL = {"hot": 5.0, "cold": 8.0}
AGREEMENT = {"force": 1e-9, "stiffness": 1e-8}
NUMBERS = (
    "n_rollers constant half_length diameter crown_radius gap guide pitch_radius ratio"
    " first_azimuth outer_radius inner_radius"
).split()
RADIAL_LOAD = 4e3  # N
TILT = 1.5e-3  # rad
C_LOOP, C_CALL = "C loop", "C through ctypes"
BATCH, CHUNK = 256, 32
IN_BATCH = f"one of {BATCH} in a call"


def element(quadrature=None, **profiles):
    """The bearing that is measured, with profiles of the raceways if wanted."""
    return bj.BearingElement(
        bj.CylindricalRollerBearing(
            14, 0.065, 0.010, 0.010,
            radial_internal_clearance=25e-6,
            roller_profile=bj.CircularCrown(1.0),
            **profiles,
        ),
        quadrature=quadrature,
    )  # fmt: skip


def unlike():
    """Profiles of raceways between which a roller does not rest midway."""
    return {
        "outer_raceway_profile": bj.CircularCrown(2.0),
        "inner_raceway_profile": bj.CircularCrown(6.0),
    }


def cases(few=False):
    """Name -> element and ring freedoms (12,) [m, rad]; the `few` are one."""
    load = jnp.array([RADIAL_LOAD, 0.0, 0.0, 0.0, 0.0, 0.0])
    tilted = {"gx": 0.3 * TILT, "gy": TILT}
    plain = element()
    radial = {"radial": (plain, bj.solve_load(plain, load).displacement)}
    if few:
        return radial
    uneven = element(**unlike())
    return radial | {
        "misaligned": (
            plain,
            bj.solve_load(
                plain, load, support=bj.Support(prescribed=tilted)
            ).displacement,
        ),
        "misaligned, raceways unlike": (
            uneven,
            bj.solve_load(
                uneven, load, support=bj.Support(prescribed=tilted)
            ).displacement,
        ),
    }


class CLoop:
    """The compiled C loop with the numbers of one element."""

    def __init__(self, library, el):
        constants = el.model().rows[0].element.constants
        quadrature, b = el.quadrature, el.bearing
        line = constants.lines[0]
        numbers = {
            "n_rollers": b.n_rollers,
            "constant": line.constant,
            "half_length": constants.half_length,
            "diameter": constants.diameter,
            "crown_radius": b.roller_profile.crown_radius,
            "gap": constants.gap[0],
            "guide": constants.tether,
            "pitch_radius": constants.pitch_radius,
            "ratio": b.roller_diameter / b.pitch_diameter,
            "first_azimuth": b.first_azimuth,
            "outer_radius": getattr(b.outer_raceway_profile, "crown_radius", 0.0),
            "inner_radius": getattr(b.inner_raceway_profile, "crown_radius", 0.0),
        }
        self.force, self.stiffness = np.zeros(12), np.zeros((12, 12))
        self.steps = ctypes.c_int()
        self.loop = library
        library.repeat.restype = ctypes.c_double
        self.design = ctypes.create_string_buffer(library.design_size())
        library.prepare(
            pointer(np.array([float(numbers[name]) for name in NUMBERS])),
            *(pointer(x) for x in quadrature.reference()),
            pointer(scan_points(el)),
            self.design,
        )

    def arguments(self, q):
        """What a C call takes; results land in `force` and `stiffness`."""
        self.q = np.array(q)
        out = (pointer(self.force), pointer(self.stiffness))
        return self.design, pointer(self.q), *out, ctypes.byref(self.steps)

    def batch(self, q, force, stiffness):
        """Force and stiffness of many cases, into arrays; other threads go on."""
        self.loop.batch(len(q), self.design, *map(pointer, (q, force, stiffness)))

    def results(self, q):
        """Force [N, N m], stiffness and most steps of a roller."""
        self.loop.force_stiffness(*self.arguments(q))
        return self.force.copy(), self.stiffness.copy(), self.steps.value


def scan_points(el):
    """Where C looks for the loaded zone; of equal slices their middles."""
    if isinstance(el.quadrature, bj.numerics.Midpoint):
        return el.quadrature.reference()[0]
    t = np.linspace(0.0, 1.0, el.quadrature.scan)
    left, right = t**5, (1.0 - t) ** 5
    return (left - right) / (left + right)


def pointer(array):
    """What ctypes hands over for an array of real numbers."""
    array = np.ascontiguousarray(array, dtype=np.float64)
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def compiler():
    """A C compiler, or `None`."""
    return next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)


def compile_c(folder, el, source=SOURCE):
    """Shared library from `c_loop.c`, or `None` without a compiler."""
    if compiler() is None:
        return None
    rule = el.quadrature
    sizes = {
        "POINTS": rule.points,
        "SCAN": len(scan_points(el)),
        "MIDPOINT": int(isinstance(rule, bj.numerics.Midpoint)),
    }
    target = os.path.join(folder, f"{source.stem}_{type(rule).__name__}.so")
    given = [f"-D{name}={value}" for name, value in sizes.items()]
    command = [compiler(), *FLAGS, *given, "-o", target, str(source), "-lm"]
    subprocess.run(command, check=True)
    return ctypes.CDLL(target)


def both(element, q):
    """Force and stiffness of a bearing element or model."""
    e = element.evaluate(q)
    return e.force, e.stiffness


def jax_calls(el, q, few=False):
    """The JAX variants: name -> function of q; the `few` have one program."""
    filtered = eqx.filter_jit(both)
    closed = jax.jit(lambda q: both(el, q))
    calls = {
        "jit(q), element closed over": closed,
        "the same, ahead of time": closed.lower(q).compile(),
    }
    return (
        calls if few else {"filter_jit(element, q)": lambda q: filtered(el, q)} | calls
    )


def batch_call(el):
    """Function of many motions: their force and stiffness in one call, in chunks."""
    one = functools.partial(both, el)
    return jax.jit(lambda qs: jax.lax.map(one, qs, batch_size=CHUNK))


def disagreement(el, reference, result):
    """Relative error of force and stiffness, with moments over the pitch radius."""
    arm = 0.5 * float(el.bearing.pitch_diameter)
    unit = np.tile([1.0, 1.0, 1.0, 1.0 / arm, 1.0 / arm, 1.0 / arm], 2)
    errors = {}
    for name, weight, want, got in zip(
        AGREEMENT, (unit, unit[:, None] * unit), reference, result, strict=False
    ):
        change = np.abs(weight * (np.asarray(got) - want))
        errors[name] = float(change.max() / np.abs(weight * want).max())
    return errors


def timers(c, calls, batch, q):
    """Name -> (seconds per call for n calls in a block, seconds of one call)."""
    arguments = c.arguments(q)
    repeat, single = c.loop.repeat, c.loop.force_stiffness

    def own(n):
        return repeat(n, *arguments) / n

    def timed(call, ready):
        def block(n):
            begin = time.perf_counter()
            for _ in range(n):
                ready(call())
            return (time.perf_counter() - begin) / n

        return block

    out = {C_LOOP: own, C_CALL: timed(lambda: single(*arguments), lambda _: None)}
    for name, call in calls.items():
        out[name] = timed(lambda call=call: call(q), jax.block_until_ready)
    qs = q * jnp.linspace(0.97, 1.03, BATCH)[:, None]
    whole = timed(lambda: batch(qs), jax.block_until_ready)
    out[IN_BATCH] = lambda n: whole(max(1, n // BATCH)) / BATCH
    return out


def measure(timers, rounds, block):
    """Seconds per call: name -> hot and cold lists, in shuffled order."""
    rng = random.Random(0)
    other = np.zeros(8_000_000)
    figures = {name: {"hot": [], "cold": []} for name in timers}
    tasks = [(name, kind) for name in timers for kind in GOAL]
    for _ in range(rounds):
        rng.shuffle(tasks)
        for name, kind in tasks:
            run = timers[name]
            if kind == "hot":
                run(max(1, block // 10))
                figures[name][kind].append(run(block))
            else:
                np.add(other, 1.0, out=other)
                figures[name][kind].append(run(1))
    return figures


def summary(figures):
    """Minimum and median [µs] and ratios of medians to the C loop and the C call."""
    base = {kind: np.median(figures[C_LOOP][kind]) for kind in GOAL}
    called = np.median(figures[C_CALL]["cold"])
    rows = {}
    for name, times in figures.items():
        rows[name] = {}
        for kind, t in times.items():
            rows[name][f"{kind}_min_us"] = 1e6 * float(np.min(t))
            rows[name][f"{kind}_median_us"] = 1e6 * float(np.median(t))
            rows[name][f"{kind}_ratio"] = float(np.median(t) / base[kind])
        rows[name]["cold_ratio_to_call"] = float(np.median(times["cold"]) / called)
    return rows


def study(c, el, q, rounds, block, calls, batch):
    """Agreement and times of one case, by JAX the `calls` and the `batch_call`."""
    *reference, steps = c.results(q)
    errors = {name: disagreement(el, reference, f(q)) for name, f in calls.items()}
    every = timers(c, calls, batch, q)
    rows = summary(measure(every, rounds, block))
    for name, error in errors.items():
        rows[name] |= {f"error_{key}": value for key, value in error.items()}
    return {"steps": steps, "jax_steps": int(el.evaluate(q).steps), "rows": rows}


def beside_peers(library, el, q, rounds):
    """Rows: the same bearing with slices as others would solve it."""
    c, model = CLoop(library, el), el.model()
    ours = jax.jit(functools.partial(both, model))
    bearing = peers.plain(el, el.quadrature.points)
    solvers = {
        "NumPy": peers.with_numpy(bearing),
        "SciPy root": peers.with_scipy(bearing),
        "jax.scipy BFGS": peers.with_jax_bfgs(bearing),
        "optimistix BFGS": peers.with_optimistix(bearing),
    }
    calls = {C_CALL: lambda: c.results(q)[:2], "ours": lambda: ours(q)}
    for name, solver in solvers.items():
        if solver is None:
            print(f"{name} is not installed: not timed.", file=sys.stderr)
        else:
            calls[name] = lambda solver=solver: [x[0] for x in solver(q[None])]
    first = {name: timed(call) for name, call in calls.items()}
    times = shuffled(calls, rounds, warm=False)
    want = first[C_CALL][1]
    return [
        {
            "solver": name,
            "us": 1e6 * float(np.median(times[name])),
            "first_s": seconds,
            "error_force": relative(got[0], want[0]),
            "error_stiffness": relative(got[1], want[1]),
        }
        for name, (seconds, got) in first.items()
    ]


def show_peers(rows):
    print(
        f"\n{'raceways unlike, 32 slices':28}{'µs':>10}{'ratio':>8}{'first, s':>10}"
        f"{'error: force':>14}{'stiffness':>11}"
    )
    for r in rows:
        print(
            f"{r['solver']:28}{r['us']:10.1f}{r['us'] / rows[1]['us']:8.2f}"
            f"{r['first_s']:10.2f}{r['error_force']:14.0e}{r['error_stiffness']:11.0e}"
        )


def show(case, result):
    print(f"\n{case}: most steps {result['steps']} (JAX {result['jax_steps']})")
    print(
        f"{'':28}{'hot, µs':>16}{'cold, µs':>17}{'ratio to C':>19}{'error to C':>17}\n"
        f"{'':28}{'min':>8}{'median':>8}{'min':>9}{'median':>8}"
        f"{'hot':>7}{'cold':>6}{'call':>6}{'force':>9}{'stiff.':>8}"
    )
    for name, r in result["rows"].items():
        times = (
            f"{r['hot_min_us']:8.1f}{r['hot_median_us']:8.1f}"
            f"{r['cold_min_us']:9.1f}{r['cold_median_us']:8.1f}"
        )
        ratios = (
            f"{r['hot_ratio']:7.1f}{r['cold_ratio']:6.1f}{r['cold_ratio_to_call']:6.1f}"
        )
        error = ""
        if "error_force" in r:
            error = f"{r['error_force']:9.0e}{r['error_stiffness']:8.0e}"
        print(f"{name:28}{times}{ratios}{error}")


def agrees(results):
    """Whether every JAX variant gives what C gives."""
    return all(
        row.get(f"error_{key}", 0.0) <= bound
        for result in results.values()
        for row in result["rows"].values()
        for key, bound in AGREEMENT.items()
    )


def show_all(report):
    for case, result in report["cases"].items():
        show(case, result)
    print(f"\ngoal: hot ≤ {GOAL['hot']:g}, cold ≤ {GOAL['cold']:g}")
    if report["peers"] is not None:
        show_peers(report["peers"])


def disagree(report):
    """What is said of results that are not those of C."""
    return not report["agrees"] and "C and JAX disagree."


def needed(library):
    """What a C compiler made; without one, there is nothing to do."""
    if library is None:
        print("no C compiler (cc, gcc, clang); skipped.", file=sys.stderr)
        sys.exit(0)
    return library


@benchmark(
    "one case, no peers", show_all, wrong=disagree,
    pinned="on one core", inline="by the calling thread",
)  # fmt: skip
def main(smoke, pinned=False, inline=False):
    # Before JAX starts its threads.
    if pinned:
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    if inline:
        jax.config.update("jax_cpu_enable_async_dispatch", False)
    rounds, block = (1, 2) if smoke else (40, 100)
    with tempfile.TemporaryDirectory() as folder:
        library = needed(compile_c(folder, element()))
        results, others = {}, None
        for case, (el, q) in cases(smoke).items():
            calls = jax_calls(el, q, smoke), batch_call(el)
            results[case] = study(CLoop(library, el), el, q, rounds, block, *calls)
        if not smoke:
            sliced = element(bj.numerics.Midpoint(32), **unlike())
            *_, (_, q) = cases().values()
            others = beside_peers(compile_c(folder, sliced), sliced, q, rounds)
    report = {"goal": GOAL, "agrees": agrees(results), "cases": results}
    return report | {"peers": others}

"""How many load solves a second?

A cylindrical roller bearing (NU), 14 crowned rollers, 32 nodes per raceway contact;
outer ring fixed; ux, uy, gx and gy of the inner ring free. Random loads, 1e2 to 1e5 N,
and a path of loads (a spiral). With straight raceways the rollers rest midway; with
crowned ones, outer and inner unlike, each takes Newton steps of its own.

Ours is `bj.sweep` on one core: each case from the nearest one solved before, to the
default tolerance and to looser ones, and from first contact
(`Batches(near=False)`). Beside it
on that core, in shuffled order, all from first contact: C with the same algorithm
(`c_load.c`; it leaves open rollers out, and solves one case at a time), and a loop of
`scipy.optimize.root`, which calls our compiled force and stiffness, or a NumPy bearing
(`peers.py`, slices). Error: of the displacement, relative to its largest of all cases,
against C. A SciPy answer counts as failed if SciPy says so.

Then ours alone, with errors against the answers from first contact: radial loads in all
directions, loads with moments, 300 N to 20 kN, and a ball bearing under radial and
axial loads.

README: one core, µs a case: rollers 72 (radial loads), 112 (moments), balls 90; from
first contact 1.6 to 2.7 times as long; none fails | 80 µs; twice C's time; 100 times
SciPy's root | **missed**: 3.9 times C from first contact, 58 times SciPy; 80 µs yes

Last run:

straight raceways, random (trace and compile 16.4 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048     119.3     8380    1.00    4.5    20       0   8e-11
tolerance 1e-6            2048     107.0     9348    0.90    3.6    19       0   6e-06
tolerance 1e-4            2048      97.2    10293    0.81    2.9    19       0   7e-04
from first contact        2048     219.0     4567    1.83   11.0    21       0   6e-16
C                         2048      56.5    17706    0.47   11.0    21       0   0e+00
SciPy root, our stiffness   64   10602.6       94   88.85   50.0    97       1   3e-01
SciPy root, NumPy bearing   64   12120.9       83  101.57   49.5   107       3   4e-01

straight raceways, path (trace and compile 0.1 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048     100.5     9948    1.00    3.8    14       0   2e-10
tolerance 1e-6            2048      86.6    11547    0.86    2.8    13       0   2e-05
tolerance 1e-4            2048      76.0    13152    0.76    2.0    13       0   2e-03
from first contact        2048     207.5     4819    2.06   10.6    14       0   7e-16
C                         2048      54.8    18253    0.55   10.6    14       0   0e+00
SciPy root, our stiffness   64   10256.4       98  102.03   47.8    86       2   5e-01
SciPy root, NumPy bearing   64   11757.4       85  116.96   47.0    79       2   5e-01

unlike raceways, random (trace and compile 17.1 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048     290.6     3441    1.00    4.7    21       0   1e-10
tolerance 1e-6            2048     262.1     3816    0.90    3.7    20       0   2e-05
tolerance 1e-4            2048     235.1     4254    0.81    3.0    19       0   8e-04
from first contact        2048     558.5     1790    1.92   11.3    22       0   6e-15
C                         2048     196.6     5087    0.68   11.3    22       0   0e+00
SciPy root, our stiffness   64   16972.1       59   58.40   53.3   105       1   3e-01
SciPy root, NumPy bearing   64   54563.8       18  187.76   49.8    96       5   4e-01

unlike raceways, path (trace and compile 0.0 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048     250.3     3995    1.00    3.8    14       0   2e-10
tolerance 1e-6            2048     212.9     4698    0.85    2.8    13       0   1e-05
tolerance 1e-4            2048     190.0     5263    0.76    2.1    12       0   3e-03
from first contact        2048     540.8     1849    2.16   10.9    15       0   1e-14
C                         2048     198.2     5047    0.79   10.9    15       0   0e+00
SciPy root, our stiffness   64   15398.9       65   61.52   48.2    76       2   5e-01
SciPy root, NumPy bearing   64   59042.7       17  235.87   49.2    76       2   5e-01

rollers, radial loads (trace and compile 0.0 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048      71.8    13932    1.00    2.8    12       0   5e-12
tolerance 1e-6            2048      59.5    16799    0.83    1.8    12       0   5e-07
tolerance 1e-4            2048      53.7    18639    0.75    1.4    11       0   9e-05
from first contact        2048     133.9     7468    1.87    7.8    13       0   0e+00

rollers, loads with moments (trace and compile 0.0 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048     112.0     8931    1.00    4.1    15       0   3e-11
tolerance 1e-6            2048      96.8    10336    0.86    3.2    14       0   2e-06
tolerance 1e-4            2048      84.0    11910    0.75    2.5    13       0   4e-04
from first contact        2048     183.4     5452    1.64    9.0    15       0   0e+00

balls, radial and axial loads (trace and compile 18.2 s)
solver                   cases   µs/case  cases/s   ratio  steps  most  failed   error
bj.sweep                  2048      89.6    11158    1.00    4.2    23       0   2e-11
tolerance 1e-6            2048      81.8    12227    0.91    3.3    22       0   2e-06
tolerance 1e-4            2048      75.1    13308    0.84    2.6    21       0   2e-04
from first contact        2048     242.7     4121    2.71   15.5    23       0   0e+00

time against C, worst: 3.88 (at most 2): MISSED
times faster than SciPy: 58.4 (at least 100): MISSED
times faster than from first contact, least: 1.64

one core; AMD EPYC, 2 cores, load average 1.2; devices: 1 cpu; jax 0.10.1

Radial loads take 72 µs a case (goal: 80). From first contact straight and unlike
raceways take 1.8 to 2.2 times as long as `bj.sweep`; C takes 0.47 to 0.79 of the time
of `bj.sweep`, 0.26 to 0.37 of that of ours from first contact.
"""

import ctypes
import functools
import os
import tempfile
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import peers
import scipy.optimize
import single_call
from bench import benchmark, relative, shuffled, table, timed, verdict

import bearingjax as bj

SOURCE = Path(__file__).with_name("c_load.c")
GOALS = {"of_c": 2.0, "scipy": 100.0}
OUTPUTS = ("displacement", "iterations")
FREE = (0, 1, 3, 4)
ARM = 1e-3  # m, of the moments
FULL = {"cases": 2048, "scipy": 64, "rounds": 3}
SMOKE = {"cases": 128, "scipy": 2, "rounds": 1}
AGREEMENT = 1e-8
OURS, CONTACT, C = "bj.sweep", "from first contact", "C"
CHOICES = {
    OURS: {},
    "tolerance 1e-6": {"tolerance": 1e-6},
    "tolerance 1e-4": {"tolerance": 1e-4},
    CONTACT: {"near": False},
}
SCIPY, SCIPY_NUMPY = "SciPy root, our stiffness", "SciPy root, NumPy bearing"


def random_loads(count, seed=0):
    """On the inner ring (count, 6) [N, N m]."""
    rng = np.random.default_rng(seed)
    size, way = 10 ** rng.uniform(2, 5, count), rng.uniform(0, 2 * np.pi, count)
    return _loads(size, way, rng.uniform(-ARM, ARM, (2, count)))


def path_of_loads(count):
    """Loads that follow each other: a spiral of ten turns, 1 kN to 20 kN."""
    along = np.linspace(0, 1, count)
    way = 20 * np.pi * along
    return _loads(1e3 * 20**along, way, ARM * np.stack([np.sin(way), np.cos(way)]))


def _loads(size, way, arms):
    loads = np.zeros((len(size), 6))
    loads[:, 0], loads[:, 1] = size * np.cos(way), size * np.sin(way)
    loads[:, 3:5] = (size * arms).T
    return loads


LOADS = {"random": random_loads, "path": path_of_loads}


def middle_loads(count, arm=0.0, axial=0.0, seed=0):
    """Middle-sized radial loads (count, 6), with moments or axial ones [N, N m]."""
    rng = np.random.default_rng(seed)
    size, way = 10 ** rng.uniform(2.5, 4.3, count), rng.uniform(0, 2 * np.pi, count)
    loads = _loads(size, way, arm * rng.normal(size=(2, count)))
    loads[:, 2] = axial * size * rng.uniform(0.1, 1.0, count)
    return loads


def alone():
    """Name -> element, loads of a number of cases."""
    rollers = bj.CylindricalRollerBearing(
        14, 0.065, 0.010, 0.010,
        radial_internal_clearance=10e-6, roller_profile=bj.CircularCrown(3.0),
    )  # fmt: skip
    balls = bj.DeepGrooveBallBearing(
        9, 0.0385, 0.00794,
        outer_osculation=0.52, inner_osculation=0.52, radial_internal_clearance=10e-6,
    )  # fmt: skip
    rollers, balls = bj.BearingElement(rollers), bj.BearingElement(balls)
    return {
        "rollers, radial loads": (rollers, middle_loads),
        "rollers, loads with moments": (rollers, lambda n: middle_loads(n, arm=ARM)),
        "balls, radial and axial loads": (balls, lambda n: middle_loads(n, axial=0.5)),
    }


class CLoad:
    """The load solve in C: loads -> displacement, steps, failures."""

    def __init__(self, library, element):
        self.loop = single_call.CLoop(library, element)

    def __call__(self, loads):
        n = len(loads)
        q, k, steps = np.empty((n, 12)), np.empty((n, 12, 12)), np.zeros(n, np.int32)
        failed = self.loop.loop.sweep(
            n,
            self.loop.design,
            single_call.pointer(loads),
            False,
            single_call.pointer(q),
            single_call.pointer(k),
            steps.ctypes.data_as(ctypes.POINTER(ctypes.c_int)),
        )
        return q, steps, failed


def ours(element, loads, tolerance=None, near=True):
    """As `CLoad`."""
    here = jax.devices()[:1]
    s = bj.sweep(
        element,
        loads,
        outputs=OUTPUTS,
        options=bj.statics.SolveOptions(tolerance=tolerance),
        batches=bj.cases.Batches(devices=here, near=near),
    )
    return s.displacement, s.iterations, int(np.sum(~s.converged))


def by_scipy(element, evaluate, loads):
    """As `CLoad`: one `scipy.optimize.root` a load, from first contact."""
    radius = 0.5 * float(element.bearing.pitch_diameter)
    play = 0.5 * float(element.bearing.radial_internal_clearance)
    scale, moving = np.array([1.0, 1.0, 1 / radius, 1 / radius]), np.array(FREE)
    inner = 6 + moving
    found, steps, failed = np.zeros((len(loads), 12)), [], 0
    for q, load in zip(found, loads, strict=True):
        pull = scale * load[moving]
        size = np.linalg.norm(pull)

        def balance(y, q=q, pull=pull, size=size):
            q[inner] = scale * 1e-6 * y
            force, stiffness = evaluate(q)
            k = np.asarray(stiffness)[np.ix_(inner, inner)]
            g = scale * np.asarray(force)[inner] - pull
            return g / size, 1e-6 * scale[:, None] * k * scale / size

        start = 1e6 * (play + 1e-6) * pull / size
        answer = scipy.optimize.root(balance, start, jac=True, tol=1e-10)
        q[inner] = scale * 1e-6 * answer.x
        steps.append(answer.nfev)
        failed += not answer.success
    return found, np.array(steps), failed


def callers(element, c):
    """Name -> function of loads."""
    model = element.model()
    compiled = jax.jit(functools.partial(single_call.both, model))
    plain = peers.with_numpy(peers.plain(element, element.quadrature.points))

    def with_numpy(q):
        force, stiffness = plain(q[None])
        return force[0], stiffness[0]

    return {
        **{k: functools.partial(ours, element, **c) for k, c in CHOICES.items()},
        C: c,
        SCIPY: functools.partial(by_scipy, element, lambda q: compiled(jnp.asarray(q))),
        SCIPY_NUMPY: functools.partial(by_scipy, element, with_numpy),
    }


def study(element, make, sizes, folder=None):
    """A row for every solver; without a folder to compile C in, of ours alone."""
    loads, reference = make(sizes["cases"]), C
    if folder is None:
        reference = CONTACT
        every = {k: functools.partial(ours, element, **c) for k, c in CHOICES.items()}
    else:
        library = single_call.compile_c(folder, element, SOURCE)
        every = callers(element, CLoad(library, element))
    few = loads[:: max(1, len(loads) // sizes["scipy"])][: sizes["scipy"]]
    given = {name: few if name in (SCIPY, SCIPY_NUMPY) else loads for name in every}
    calls = {k: functools.partial(call, given[k]) for k, call in every.items()}
    first, _ = timed(calls[OURS])
    times = shuffled(calls, sizes["rounds"])
    rows = []
    for name, call in calls.items():
        displacement, steps, failed = call()
        each = 1e6 * float(np.median(times[name])) / len(given[name])
        want, *_ = every[reference](given[name])
        rows.append(
            {
                "solver": name,
                "us": each,
                "cases": len(given[name]),
                "steps": float(np.mean(steps)),
                "most_steps": int(np.max(steps)),
                "failed": failed,
                "error": relative(displacement, want),
            }
        )
    again = rows[0]["us"] * 1e-6 * len(loads)
    return {"compile_s": max(0.0, first - again), "rows": rows}


def measure(sizes):
    """(bearing, kind of loads) -> rows."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, profiles in (("straight", {}), ("unlike", single_call.unlike())):
            element = single_call.element(**profiles)
            for kind, make in LOADS.items():
                found[f"{name} raceways, {kind}"] = study(element, make, sizes, folder)
                if sizes is SMOKE:
                    return found
    of_ours = {k: study(e, make, sizes) for k, (e, make) in alone().items()}
    return found | of_ours


def figures(results):
    """Worst of all: time against C, both from first contact; times faster than SciPy
    with our stiffness, and than from first contact."""
    each = [{r["solver"]: r["us"] for r in x["rows"]} for x in results.values()]
    beside = [us for us in each if C in us]
    return {
        "of_c": max(us[CONTACT] / us[C] for us in beside),
        "scipy": min(us[SCIPY] / us[OURS] for us in beside),
        "near": min(us[CONTACT] / us[OURS] for us in each),
    }


def show(report):
    results = report["cases"]
    for name, result in results.items():
        print(f"\n{name} (trace and compile {result['compile_s']:.1f} s)")
        rows = result["rows"]
        more = [{"each": 1e6 / r["us"], "ratio": r["us"] / rows[0]["us"]} for r in rows]
        table(map(dict.__or__, rows, more), {
            "solver": "{solver}", "cases": "{cases:d}", "µs/case": "{us:.1f}",
            "cases/s": "{each:.0f}", "ratio": "{ratio:.2f}", "steps": "{steps:.1f}",
            "most": "{most_steps:d}", "failed": "{failed:d}", "error": "{error:.0e}",
        })  # fmt: skip
    worst = report["figures"]
    print()
    print(verdict("time against C, worst", worst["of_c"], GOALS["of_c"]))
    print(verdict("times faster than SciPy", worst["scipy"], GOALS["scipy"], False))
    print(f"times faster than from first contact, least: {worst['near']:.2f}")


def agrees(results):
    """Whether ours ends where C or first contact ends, and none fails."""
    strict = (OURS, CONTACT, C)
    rows = [r for x in results.values() for r in x["rows"] if r["solver"] in strict]
    return all(r["error"] <= AGREEMENT and not r["failed"] for r in rows)


@benchmark("few loads", show, wrong=single_call.disagree)
def main(smoke):
    single_call.needed(single_call.compiler())
    # Before JAX starts its threads: one core for everyone.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    found = measure(SMOKE if smoke else FULL)
    told = {"goals": GOALS, "figures": figures(found), "agrees": agrees(found)}
    return told | {"cases": found}

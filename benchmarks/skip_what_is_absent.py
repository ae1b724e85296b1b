"""What does a scene pay for what it does not have?

A cylindrical roller bearing with 14 crowned rollers between crowned raceways, outer and
inner unlike (so that every roller takes Newton steps), rings out of line. From the full
variant (force and stiffness, four ribs far off, speed, all rollers loaded) parts are
taken away, one by one.

Hot: the same compiled call in a block, shortest of the rounds, in shuffled order; only
ratios within one run count. Kernels: instructions of the compiled program outside of
fusions, a loop's body counted once. Trace and compile: shortest of the repeats, nothing
kept. Steps: most Newton steps of a roller. Of 256: the same in one call for a batch,
where open rollers are left out.

Then sweeps of load solves, where outputs are what may be absent, and the moments of the
loads: microseconds a case, shortest of the rounds; the first
call, which compiles, apart.

README: one call without ribs and speed 0.92 of the time; sweeps for displacement and
stiffness alone 0.8, loads without moments 0.3 |  |

Last run:

                          loaded         hot, µs    ratio  of 256          trace compile
variant                  rollers steps    min median      µs each kernels      s       s
full                          14     4    271    363 1.00    67.4     164   1.00    2.17
no speed                      14     4    259    395 0.95    64.2     169   0.97    1.97
no ribs                       14     4    250    373 0.92    64.6     153   0.88    1.88
no speed, no ribs             14     4    248    356 0.92    61.9     158   0.81    1.71
  and few rollers loaded       3     3    231    323 0.85    20.9     158   0.95    1.77
  and rings in line           14     4    246    344 0.91    62.8     158   0.84    1.71
  and force only              14     4    227    349 0.84    61.5     132   0.77    1.47
  and energy only             14     4    235    338 0.87    60.6     131   0.84    1.58
force only                    14     4    255    367 0.94    62.9     140   0.86    1.51
energy only                   14     4    256    384 0.94    61.8     138   0.88    1.65

load solves, kept                         µs/case  ratio  compile, s
all outputs                                1858.7   1.00        10.4
displacement, stiffness, roller loads      1640.7   0.88         7.9
displacement and stiffness                 1475.7   0.79         9.6
displacement                               1683.6   0.91        10.8
displacement, loads without moments         473.0   0.25         0.3

AMD EPYC, 2 cores, load average 1.5; devices: 1 cpu; jax 0.10.1
"""

import random
import re
import time
from functools import partial
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shuffled, table, timed

import bearingjax as bj

FAR_RIB = bj.Rib(0.3, 1.5e-3, 1e-3)
SPEED = bj.Speed(inner=3000 * 2 * np.pi / 60)
CLEARANCE = {"all": -20e-6, "few": 60e-6}
FREE = (
    "parameter constant get-tuple-element tuple bitcast call while conditional".split()
)
FULL = "full"


class Variant(NamedTuple):
    """What is asked of which bearing."""

    wanted: str = "force and stiffness"
    ribs: bool = True
    speed: bool = True
    loaded: str = "all"
    tilted: bool = True


VARIANTS = {
    FULL: Variant(),
    "no speed": Variant(speed=False),
    "no ribs": Variant(ribs=False),
    "no speed, no ribs": Variant(speed=False, ribs=False),
    "  and few rollers loaded": Variant(speed=False, ribs=False, loaded="few"),
    "  and rings in line": Variant(speed=False, ribs=False, tilted=False),
    "  and force only": Variant("force", ribs=False, speed=False),
    "  and energy only": Variant("energy", ribs=False, speed=False),
    "force only": Variant("force"),
    "energy only": Variant("energy"),
}
SMOKE = (FULL, "no speed, no ribs")
# Outputs that are kept, and whether loads have moments.
SWEEPS = {
    "all outputs": (None, True),
    "displacement, stiffness, roller loads": (
        ("displacement", "stiffness", "roller_load"),
        True,
    ),
    "displacement and stiffness": (("displacement", "stiffness"), True),
    "displacement": (("displacement",), True),
    "displacement, loads without moments": (("displacement",), False),
}
SWEPT = 2048
BATCH = 256  # bearings in one call


def element(variant):
    ribs = bj.Ribs.arrangement("NUP", FAR_RIB) if variant.ribs else bj.Ribs()
    return bj.BearingElement(
        bj.CylindricalRollerBearing(
            14, 0.065, 0.010, 0.010,
            radial_internal_clearance=CLEARANCE[variant.loaded],
            roller_profile=bj.CircularCrown(1.0),
            outer_raceway_profile=bj.CircularCrown(2.0),
            inner_raceway_profile=bj.CircularCrown(6.0),
            ribs=ribs,
        )
    )  # fmt: skip


def motion(variant):
    """Ring freedoms (12,): the inner ring moves and tilts."""
    shift = {"all": 5e-6, "few": 35e-6}[variant.loaded]
    tilt = 1.0 if variant.tilted else 0.0
    q = jnp.zeros(12).at[6].set(shift)
    return q.at[9].set(2e-4 * tilt).at[10].set(6e-4 * tilt)


class Case:
    """One variant, ready to be compiled and called."""

    def __init__(self, variant):
        self.element = element(variant)
        speed = SPEED if variant.speed else None
        numbers, static = eqx.partition(self.element, eqx.is_array)
        self.arguments = numbers, motion(variant), speed

        def wanted(numbers, q, speed):
            el = eqx.combine(numbers, static)
            if variant.wanted == "energy":
                return el.energy(q, speed)
            if variant.wanted == "force":
                return el.force(q, speed)
            e = el.evaluate(q, speed)
            return e.force, e.stiffness

        self.wanted, self.batched = wanted, None

    def compile(self):
        """Trace and compile anew; seconds of both."""
        jax.clear_caches()
        marks = [time.perf_counter()]
        lowered = jax.jit(self.wanted).lower(*self.arguments)
        marks.append(time.perf_counter())
        self.compiled = lowered.compile()
        marks.append(time.perf_counter())
        return marks[1] - marks[0], marks[2] - marks[1]

    def block(self, count):
        """Seconds per call."""
        begin = time.perf_counter()
        for _ in range(count):
            jax.block_until_ready(self.compiled(*self.arguments))
        return (time.perf_counter() - begin) / count

    def batch(self):
        """Microseconds a bearing of one call for many, the rings' places alike."""
        numbers, q, speed = self.arguments
        many = q * (1.0 + 1e-3 * jnp.linspace(-1.0, 1.0, BATCH)[:, None])
        if self.batched is None:
            all_of = jax.vmap(self.wanted, in_axes=(None, 0, None))
            self.batched = jax.jit(all_of).lower(numbers, many, speed).compile()
            jax.block_until_ready(self.batched(numbers, many, speed))
        begin = time.perf_counter()
        jax.block_until_ready(self.batched(numbers, many, speed))
        return 1e6 * (time.perf_counter() - begin) / BATCH

    def course(self):
        """Most steps, loaded rollers, and how the solve ended."""
        _, q, speed = self.arguments
        row = self.element.model(speed).solve(q).groups[0]
        loads = np.asarray(row.energies.aux.contact_load[:, :2]).max(axis=1)
        result = bj.Result(int(row.state.result.max())).label
        return int(row.state.steps.max()), int(np.sum(loads > 0)), result


def kernels(text):
    """Instructions of a program that run by themselves, not free, not in a fusion."""
    inner = set(re.findall(r"(?:calls|to_apply)=%?([\w.\-]+)", text))
    # What a `call` runs is a part of the program like any other.
    inner -= set(re.findall(r" call\(.*?to_apply=%?([\w.\-]+)", text))
    count, skip = 0, True
    for line in text.splitlines():
        if line.endswith("{") and not line.startswith(" "):
            name = re.match(r"(?:ENTRY )?%?([\w.\-]+)", line)
            skip = line.startswith("HloModule") or name is None or name[1] in inner
        found = re.match(r"\s+(?:ROOT )?%?[\w.\-]+ = .*? ([a-z][\w\-]*)\(", line)
        if found and not skip and found[1] not in FREE:
            count += 1
    return count


def measure(names, rounds, block, repeats):
    """A row for every variant."""
    cases = {name: Case(VARIANTS[name]) for name in names}
    built = {name: [] for name in names}
    times = {name: [] for name in names}
    batches = {name: [] for name in names}
    order = list(names)
    jax.jit(jnp.linalg.norm).lower(jnp.ones(3)).compile()  # JAX itself warms up
    for _ in range(repeats):
        random.shuffle(order)
        for name in order:
            built[name].append(cases[name].compile())
    for _ in range(rounds):
        random.shuffle(order)
        for name in order:
            cases[name].block(max(1, block // 10))
            times[name].append(cases[name].block(block))
            batches[name].append(cases[name].batch())
    return [
        row(n, cases[n], built[n], times[n], times[FULL])
        | {"batch_us": min(batches[n])}
        for n in names
    ]


def row(name, case, built, times, full):
    steps, loaded, result = case.course()
    trace, compile_ = np.min(built, axis=0)
    return {
        "variant": name,
        **VARIANTS[name]._asdict(),
        "steps": steps,
        "loaded_rollers": loaded,
        "result": result,
        "hot_us": 1e6 * min(times),
        "median_us": 1e6 * float(np.median(times)),
        "ratio": min(times) / min(full),
        "kernels": kernels(case.compiled.as_text()),
        "trace_s": float(trace),
        "compile_s": float(compile_),
    }


def swept_loads(moments):
    """Radial loads (case, 6) [N, N m], with or without moments."""
    rng = np.random.default_rng(0)
    size, way = 10 ** rng.uniform(2, 5, SWEPT), rng.uniform(0, 2 * np.pi, SWEPT)
    arms = rng.uniform(-1e-3, 1e-3, (2, SWEPT)) * moments
    loads = np.zeros((SWEPT, 6))
    loads[:, 0], loads[:, 1] = size * np.cos(way), size * np.sin(way)
    loads[:, 3:5] = (size * arms).T
    return loads


def sweeps(rounds):
    """A row for every sweep: time a case, time of the first call, steps."""
    el = element(Variant(ribs=False, loaded="few"))
    calls = {
        name: partial(bj.sweep, el, swept_loads(moments), outputs=outputs)
        for name, (outputs, moments) in SWEEPS.items()
    }
    first = {name: timed(call)[0] for name, call in calls.items()}
    times = shuffled(calls, rounds, warm=False)
    best = {name: min(t) / SWEPT for name, t in times.items()}
    base = next(iter(best.values()))
    return [
        {
            "sweep": name,
            "us": 1e6 * t,
            "ratio": t / base,
            "compile_s": first[name] - t * SWEPT,
        }
        for name, t in best.items()
    ]


def show(rows, swept):
    table(rows, {
        "variant": "{variant}", "loaded": "{loaded_rollers:d}", "steps": "{steps:d}",
        "hot, µs": "{hot_us:.0f}", "median": "{median_us:.0f}", "ratio": "{ratio:.2f}",
        f"of {BATCH}, µs": "{batch_us:.1f}", "kernels": "{kernels:d}", 
        "trace, s": "{trace_s:.2f}", "compile, s": "{compile_s:.2f}",
    })  # fmt: skip
    print()
    table(swept, {
        "load solves, kept": "{sweep}", "µs/case": "{us:.1f}", "ratio": "{ratio:.2f}",
        "compile, s": "{compile_s:.1f}",
    })  # fmt: skip


def unsolved(rows, _):
    others = {r["result"] for r in rows} - {"converged"}
    return others and "a variant did not converge."


@benchmark("two variants", show, wrong=unsolved)
def main(smoke):
    if smoke:
        return measure(SMOKE, rounds=5, block=20, repeats=1), []
    rows = measure(tuple(VARIANTS), rounds=40, block=50, repeats=3)
    return rows, sweeps(rounds=5)

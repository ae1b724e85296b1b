"""How many bearings a second (force and stiffness)?

A cylindrical roller bearing (NU: no ribs), 14 crowned rollers, 32 nodes per raceway
contact, inner ring pushed and tilted at random. Ours is `jax.lax.map` over chunks;
blocks of chunks go to the devices, and all forces and stiffnesses are kept on the host.

First the size of a chunk is chosen, at one batch size; then batches of 1e3 to 1e6 cases
on one core beside the C loop (`c_loop.c`, same quadrature) on the same core; then one
device against two, on two cores, and the peak memory of the process that keeps 1e6
cases. The peers (`peers.py`) solve a bearing with crowned raceways, outer and inner
unlike, whose rollers do not rest midway, with `Midpoint(32)`; all start midway.

Each part runs in a process of its own: the first pinned to one core, so that no thread
of XLA helps. Errors are relative to the largest entry; those of the batches against the
C loop, those of the peers against ours.

README: one core: 10 to 13 µs a case, slices 8 to 10; 3100 times jax.scipy's BFGS, 6.6
times NumPy; 1e6 cases 7.8 s, 1.8 GiB | C's speed; 1.8 times on two cores; 50 times
BFGS; 2 GiB | **missed**: 0.25 to 0.43 of C, 1.73 times (1.93 on a Xeon); rest yes

Last run:

chunk         16      32      64     128     256
µs/case     13.7    10.9    10.1     9.9     9.8

in chunks of 256, one core
rule        cases  ours, µs  C, µs  of C  error
mapped       1000      10.8    4.3   40%  7e-16
mapped      10000      10.4    4.3   41%  7e-16
mapped     100000      10.2    4.2   42%  7e-16
mapped    1000000      12.7    4.2   33%  7e-16
midpoint     1000       7.9    2.4   30%  1e-15
midpoint    10000       7.9    2.3   30%  1e-15
midpoint   100000       7.7    2.3   30%  1e-15
midpoint  1000000       9.7    2.5   25%  1e-15

raceways unlike, midpoint  µs/case   ratio  error: force  stiffness
ours                          18.3     1.0         0e+00      0e+00
C                              7.9     0.4         4e-16      1e-14
NumPy, vectorised            120.8     6.6         1e-15      9e-14
jax.scipy BFGS, vmapped    55876.5  3058.1         5e-07      4e-04
SciPy root                  2940.5   160.9         6e-16      1e-15
optimistix BFGS, vmapped    2909.2   159.2         5e-11      6e-10

µs/case   cases  one device  2 devices    C  C, 2 threads
mapped    50000        10.0        5.3  4.3           2.2
midpoint  50000         7.2        4.2  2.3           1.2

1000000 cases kept: 7.8 s, peak memory 1.81 GiB

speed against the C loop, one core, worst batch: 0.252 (at least 1): MISSED
times faster than jax.scipy BFGS: 3.06e+03 (at least 50): met
speed-up on two cores, worse rule: 1.73 (at least 1.8): MISSED
peak memory, GiB: 1.81 (at most 2): met

AMD EPYC, 2 cores, load average 1.8; devices: 1 cpu; jax 0.10.1

The C loop leaves open rollers out. Two of the 16 cores of an Intel Xeon are 1.94
(mapped) and 1.93 times (midpoint) as fast as one.
"""

import functools
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import jax
import numpy as np
import peers
import single_call
from bench import benchmark, machine, peak_memory, relative, shuffled, table, verdict
from jax.sharding import Mesh, NamedSharding, PartitionSpec

import bearingjax as bj

RULES = {"mapped": bj.numerics.ContactMapped(32), "midpoint": bj.numerics.Midpoint(32)}
CHUNKS = {"cpu": (16, 32, 64, 128, 256), "gpu": (1024, 4096, 16384)}
BLOCK = {"cpu": 1024, "gpu": 16384}  # cases of a device between visits of the host
FULL = {
    "rules": ("mapped", "midpoint"),
    "chosen_at": 4096,
    "batches": (1_000, 10_000, 100_000, 1_000_000),
    "devices_at": 50_000,
    "kept": 1_000_000,
    "peers": 64,
    "rounds": 5,
}
SMOKE = {
    "rules": ("mapped",),
    "chosen_at": 0,
    "batches": (1_000,),
    "devices_at": 0,
    "kept": 0,
    "peers": 0,
    "rounds": 1,
}
GOALS = {"per_core": 1.0, "two_cores": 1.8, "bfgs": 50.0, "memory": 2.0}
CHECKED = 1000  # cases compared with C
CALLS = 3e5  # cases that a batch size is timed with, at most
AGREEMENT = 1e-11


def motions(count, seed=0):
    """Ring freedoms (count, 12) [m, rad] that load some of the rollers."""
    rng = np.random.default_rng(seed)
    q = np.zeros((count, 12))
    way, push = rng.uniform(0, 2 * np.pi, count), rng.uniform(15e-6, 35e-6, count)
    q[:, 6], q[:, 7] = push * np.cos(way), push * np.sin(way)
    q[:, 9:11] = rng.uniform(-1e-3, 1e-3, (count, 2))
    return q


def room(count):
    """Arrays for the forces and stiffnesses of all cases."""
    return np.empty((count, 12)), np.empty((count, 12, 12))


class Ours:
    """Force and stiffness of many cases on some devices."""

    def __init__(self, element, chunk, devices):
        self.block = BLOCK[devices[0].platform] * len(devices)
        mesh = Mesh(np.array(devices), ("case",))
        self.spread = NamedSharding(mesh, PartitionSpec("case"))
        one = functools.partial(single_call.both, element.model())
        self.program = jax.jit(
            jax.shard_map(
                lambda q: jax.lax.map(one, q, batch_size=chunk),
                mesh=mesh,
                in_specs=PartitionSpec("case"),
                out_specs=PartitionSpec("case"),
                check_vma=False,
            )
        )

    def __call__(self, q, out):
        """Solve all cases; a block is fetched while the next is on its way."""
        pending = None
        for begin in [*range(0, len(q), self.block), None]:
            submitted = None
            if begin is not None:
                part = q[begin : begin + self.block]
                missing = self.block - len(part)
                whole = np.pad(part, ((0, missing), (0, 0)), mode="edge")
                given = jax.device_put(whole, self.spread)
                submitted = begin, len(part), self.program(given)
            if pending is not None:
                first, size, values = pending
                for kept, value in zip(out, values, strict=True):
                    kept[first : first + size] = np.asarray(value)[:size]
            pending = submitted


def rounds_of(count, rounds):
    """How often a batch is timed: large ones need it less."""
    return int(np.clip(CALLS // count, 1, rounds))


def best_chunk(sizes, device):
    """Microseconds a case for every size of a chunk, and the best."""
    if not sizes["chosen_at"]:
        return {}, CHUNKS[device.platform][1]
    q, out = motions(sizes["chosen_at"]), room(sizes["chosen_at"])
    element = single_call.element(RULES["mapped"])
    calls = {
        chunk: functools.partial(Ours(element, chunk, [device]), q, out)
        for chunk in CHUNKS[device.platform]
    }
    times = shuffled(calls, sizes["rounds"])
    found = {chunk: 1e6 * float(np.median(t)) / len(q) for chunk, t in times.items()}
    return found, min(found, key=found.__getitem__)


def batches(sizes, chunk, device, folder):
    """Rows: ours beside C, for every rule and batch size."""
    rows = []
    for rule in sizes["rules"]:
        element = single_call.element(RULES[rule])
        library = single_call.compile_c(folder, element)
        c = single_call.CLoop(library, element)
        ours = Ours(element, chunk, [device])
        few = motions(CHECKED)
        got, want = room(CHECKED), room(CHECKED)
        ours(few, got)
        c.batch(few, *want)
        for count in sizes["batches"]:
            q, out = motions(count), room(count)
            calls = {
                "ours": functools.partial(ours, q, out),
                "C": functools.partial(c.batch, q, *out),
            }
            times = shuffled(calls, rounds_of(count, sizes["rounds"]), warm=False)
            rows.append(
                {"rule": rule, "cases": count}
                | {
                    f"{k}_us": 1e6 * float(np.median(t)) / count
                    for k, t in times.items()
                }
                | {"per_core": float(np.median(times["C"]) / np.median(times["ours"]))}
                | errors(got, want)
            )
    return rows


def errors(got, want):
    """Of force and stiffness, relative to the largest entry."""
    pairs = zip(("force", "stiffness"), got, want, strict=True)
    return {f"error_{name}": relative(x, y) for name, x, y in pairs}


def beside_peers(sizes, chunk, device, folder):
    """Rows: every way to solve the same unlike raceways with equal slices."""
    count = sizes["peers"]
    if not count:
        return []
    element = single_call.element(RULES["midpoint"], **single_call.unlike())
    c = single_call.CLoop(single_call.compile_c(folder, element), element)
    ours = Ours(element, chunk, [device])
    bearing = peers.plain(element, RULES["midpoint"].points)
    q = motions(BLOCK[device.platform])
    want, by_c = room(len(q)), room(len(q))
    small, few = q[:count], q[:4]
    calls = {
        "ours": (lambda: ours(q, want), len(q)),
        "C": (lambda: c.batch(q, *by_c), len(q)),
        "NumPy, vectorised": (_of(peers.with_numpy(bearing), small), count),
        "jax.scipy BFGS, vmapped": (_of(peers.with_jax_bfgs(bearing), small), count),
        "SciPy root": (_of(peers.with_scipy(bearing), few), len(few)),
    }
    optimistix = peers.with_optimistix(bearing)
    if optimistix is None:
        print("optimistix is not installed: not timed.", file=sys.stderr)
    else:
        calls["optimistix BFGS, vmapped"] = (_of(optimistix, small), count)
    times = shuffled({k: call for k, (call, _) in calls.items()}, rounds=2)
    rows = []
    for name, (call, n) in calls.items():
        got = {"ours": want, "C": by_c}.get(name) or call()
        each = 1e6 * float(np.median(times[name])) / n
        reference = tuple(x[:n] for x in want)
        rows.append({"peer": name, "us": each} | errors(got, reference))
    return rows


def _of(evaluate, q):
    return lambda: evaluate(q)


def on_one_core(sizes):
    """Chunks, batches and peers."""
    device = jax.devices()[0]
    with tempfile.TemporaryDirectory() as folder:
        chunks, chunk = best_chunk(sizes, device)
        return {
            "machine": machine(),
            "chunks_us": chunks,
            "chunk": chunk,
            "batches": batches(sizes, chunk, device, folder),
            "peers": beside_peers(sizes, chunk, device, folder),
        }


def on_all_devices(sizes, chunk):
    """One device against all, the C loop on as many threads; memory of many cases."""
    devices = jax.devices()
    count, rows = sizes["devices_at"], []
    for rule, quadrature in RULES.items():
        if not count:
            break
        element = single_call.element(quadrature)
        q, out = motions(count), room(count)
        with tempfile.TemporaryDirectory() as folder:
            c = single_call.CLoop(single_call.compile_c(folder, element), element)
        one, every = Ours(element, chunk, devices[:1]), Ours(element, chunk, devices)
        calls = {
            "one": functools.partial(one, q, out),
            "all": functools.partial(every, q, out),
            "C": functools.partial(c.batch, q, *out),
            "C, threads": functools.partial(_in_threads, c, q, out, len(devices)),
        }
        times = shuffled(calls, sizes["rounds"])
        each = {k: 1e6 * float(np.median(t)) / count for k, t in times.items()}
        rows.append({"rule": rule, "cases": count, "devices": len(devices)} | each)
    return {"devices": rows, "machine": machine()}


def _in_threads(c, q, out, threads):
    parts = zip(*(np.array_split(x, threads) for x in (q, *out)), strict=True)
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(lambda part: c.batch(*part), parts))


def keeping(sizes, chunk):
    """Seconds and peak memory of one process that solves and keeps many cases."""
    count = sizes["kept"]
    if not count:
        return {}
    ours = Ours(single_call.element(RULES["mapped"]), chunk, jax.devices())
    q, out = motions(count), room(count)
    ours(q[:1], out)  # compiles
    before = peak_memory()
    times = shuffled({"ours": lambda: ours(q, out)}, 1, warm=False)
    return {
        "cases": count,
        "seconds": times["ours"][0],
        "GiB": peak_memory(),
        "GiB_before": before,
        "finite": bool(all(np.isfinite(x).all() for x in out)),
    }


PARTS = {"one": on_one_core, "all": on_all_devices, "keep": keeping}


def apart(name, device, smoke, **given):
    """The figures of one part, from a process of its own."""
    command = [sys.executable, __file__, "--part", name, "--device", device]
    command += ["--smoke"] * smoke + [f"--{k}={v}" for k, v in given.items()]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def set_up(name, device):
    """One core for the first part, as many host devices as cores for the others."""
    jax.config.update("jax_platforms", "cuda,cpu" if device == "gpu" else "cpu")
    if device == "gpu":
        return
    if name == "one":
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    else:
        jax.config.update("jax_num_cpu_devices", min(2, os.cpu_count() or 1))


def figures(result):
    """What the goals are about."""
    found = {"per_core": min(row["per_core"] for row in result["batches"])}
    each = {row["peer"]: row["us"] for row in result["peers"]}
    if each:
        found["bfgs"] = each["jax.scipy BFGS, vmapped"] / each["ours"]
    if result["devices"]:
        found["two_cores"] = min(r["one"] / r["all"] for r in result["devices"])
    if result["keep"]:
        found["memory"] = result["keep"]["GiB"]
    return found


def show(result):
    if result["chunks_us"]:
        print("chunk   " + "".join(f"{c:>8}" for c in result["chunks_us"]))
        print("µs/case " + "".join(f"{t:8.1f}" for t in result["chunks_us"].values()))
    print(f"\nin chunks of {result['chunk']}, one core")
    table(result["batches"], {
        "rule": "{rule}", "cases": "{cases:d}", "ours, µs": "{ours_us:.1f}",
        "C, µs": "{C_us:.1f}", "of C": "{per_core:.0%}",
        "error": "{error_stiffness:.0e}",
    })  # fmt: skip
    if result["peers"]:
        ours = result["peers"][0]["us"]
        print()
        table([r | {"ratio": r["us"] / ours} for r in result["peers"]], {
            "raceways unlike, midpoint": "{peer}", "µs/case": "{us:.1f}",
            "ratio": "{ratio:.1f}", "error: force": "{error_force:.0e}",
            "stiffness": "{error_stiffness:.0e}",
        })  # fmt: skip
    if result["devices"]:
        n = result["devices"][0]["devices"]
        print()
        table(result["devices"], {
            "µs/case": "{rule}", "cases": "{cases:d}", "one device": "{one:.1f}",
            f"{n} devices": "{all:.1f}", "C": "{C:.1f}",
            f"C, {n} threads": "{C, threads:.1f}",
        })  # fmt: skip
    keep = result["keep"]
    if keep:
        print(
            f"\n{keep['cases']} cases kept: {keep['seconds']:.1f} s, peak memory"
            f" {keep['GiB']:.2f} GiB"
        )
    print()
    words = {
        "per_core": ("speed against the C loop, one core, worst batch", False),
        "two_cores": ("speed-up on two cores, worse rule", False),
        "bfgs": ("times faster than jax.scipy BFGS", False),
        "memory": ("peak memory, GiB", True),
    }
    for key, figure in result["figures"].items():
        what, most = words[key]
        print(verdict(what, figure, GOALS[key], most))


def agrees(result):
    """Whether ours gives what C gives."""
    rows = result["batches"] + [r for r in result["peers"] if r["peer"] == "C"]
    worst = max(max(r["error_force"], r["error_stiffness"]) for r in rows)
    return worst <= AGREEMENT


@benchmark(
    "small batches, one rule", show, wrong=single_call.disagree,
    device={"choices": ("cpu", "gpu")}, chunk="of a part by itself",
    part={"choices": PARTS, "help": "one part, in this process"},
)  # fmt: skip
def main(smoke, device="cpu", part=None, chunk=64):
    single_call.needed(single_call.compiler())
    if part:
        set_up(part, device)
        given = {} if part == "one" else {"chunk": chunk}
        print(json.dumps(PARTS[part](SMOKE if smoke else FULL, **given)))
        sys.exit()
    result = apart("one", device, smoke)
    result |= {"devices": [], "keep": {}}
    if not smoke:
        chunk = result["chunk"]
        more = apart("all", device, False, chunk=chunk)
        result |= more | {"keep": apart("keep", device, False, chunk=chunk)}
    told = {"goals": GOALS, "figures": figures(result), "agrees": agrees(result)}
    return told | result

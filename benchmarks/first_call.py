"""How long until the first answer?

Fresh processes, one at a time: import of the package; a bearing of 14 rollers and its
element; first force and stiffness (compiled anew, no cache on disk), all by the clock
of the process itself, counted from the start of the import; and the command line as a
whole, by the clock outside: once with an empty cache of compiled programs, then twice
again. Medians of the repeats, and of the processor time (both cores: above the wall
time where the compiler has both, below it where others use the machine).

Run: python benchmarks/first_call.py [--json] [--smoke] [--repeats N]

Last run:

seconds                    scene             median    min    max    CPU  goal
import jax                                     0.53   0.46   0.74   0.56
import bearingjax                              0.38   0.26   0.42   0.29
bearing and element                            0.12   0.10   0.13   0.10
evaluate                                       2.87   2.53   3.98   3.97
again                                          0.00   0.00   0.00   0.00
first force and stiffness                      3.69   3.58   5.26   4.92   4.0
solve, first               cylindrical_rig     8.73   6.56  14.18   8.93  10.0
solve, second              cylindrical_rig     2.68   2.61   4.78   2.68   2.5  missed
solve, third               cylindrical_rig     3.23   3.08   4.40   3.06   2.5  missed
solve, first               cylindrical_ribs   13.63  12.17  15.52  12.83  10.0  missed
solve, second              cylindrical_ribs    3.30   3.24   5.74   3.25   2.5  missed
solve, third               cylindrical_ribs    3.41   3.10   5.87   3.41   2.5  missed
solve, first               tapered             8.68   8.17  19.79  11.22  10.0
solve, second              tapered             3.32   3.13   3.47   3.29   2.5  missed
solve, third               tapered             3.52   3.34   3.65   3.64   2.5  missed

3 repeats; AMD EPYC, 2 cores, load average before 2.8
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

GOALS = {
    "first force and stiffness": 4.0,
    "solve, first": 10.0,
    "solve, second": 2.5,
    "solve, third": 2.5,
}
SCENES = ("cylindrical_rig", "cylindrical_ribs", "tapered")
LIBRARY = """
import json, time
clocks = lambda: (time.perf_counter(), time.process_time())
marks = [clocks()]
mark = lambda: marks.append(clocks())
import jax
jax.config.update("jax_enable_x64", True)
mark()
import bearingjax as bj
mark()
element = bj.BearingElement(
    bj.CylindricalRollerBearing(
        14, 0.065, 0.010, 0.010,
        radial_internal_clearance=25e-6,
        roller_profile=bj.CircularCrown(1.0),
    )
)
mark()
import jax.numpy as jnp
e = element.evaluate(jnp.array([0.0] * 6 + [3e-5, 0.0, 0.0, 0.0, 1e-3, 0.0]))
e.stiffness.block_until_ready()
mark()
e = element.evaluate(jnp.array([0.0] * 6 + [4e-5, 0.0, 0.0, 0.0, 2e-3, 0.0]))
e.stiffness.block_until_ready()
mark()
print(json.dumps([(b[0] - a[0], b[1] - a[1]) for a, b in zip(marks, marks[1:])]))
"""
STEPS = ("import jax", "import bearingjax", "bearing and element", "evaluate", "again")
COMMAND = "import sys; from bearingjax.cli import main; sys.exit(main())"


def run(arguments, cache):
    """Output, wall and processor time [s] of a fresh process with its own cache."""
    dropped = ("JAX_COMPILATION_CACHE_DIR", "JAX_ENABLE_COMPILATION_CACHE")
    environment = {k: v for k, v in os.environ.items() if k not in dropped}
    begin, used = time.perf_counter(), children_time()
    done = subprocess.run(
        [sys.executable, "-c", *arguments],
        env=environment | {"XDG_CACHE_HOME": cache},
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout, (time.perf_counter() - begin, children_time() - used)


def children_time():
    """Processor time of the processes that have ended [s]."""
    times = os.times()
    return times.children_user + times.children_system


def library():
    """(wall, processor) [s] of every step in one process, and to the first result."""
    with tempfile.TemporaryDirectory() as cache:
        output, _ = run([LIBRARY], cache)
    steps = dict(zip(STEPS, json.loads(output), strict=True))
    needed = [times for name, times in steps.items() if name != "again"]
    return steps | {"first force and stiffness": np.sum(needed, axis=0)}


def command_line(scene):
    """(wall, processor) [s] of a first, second and third solve with one cache."""
    with tempfile.TemporaryDirectory() as cache:
        times = [run([COMMAND, "solve", scene], cache)[1] for _ in range(3)]
    names = ("solve, first", "solve, second", "solve, third")
    return dict(zip(names, times, strict=True))


def measure(scenes, repeats):
    """A row for every step: median, shortest, longest; median processor time."""
    found = {}
    for _ in range(repeats):
        for what, seconds in library().items():
            found.setdefault((what, ""), []).append(seconds)
        for scene in scenes:
            for what, seconds in command_line(scene).items():
                found.setdefault((what, scene), []).append(seconds)
    return [
        {
            "what": what,
            "scene": scene,
            "median_s": float(np.median(times, axis=0)[0]),
            "min_s": float(np.min(times, axis=0)[0]),
            "max_s": float(np.max(times, axis=0)[0]),
            "processor_s": float(np.median(times, axis=0)[1]),
            "goal_s": GOALS.get(what),
        }
        for (what, scene), times in found.items()
    ]


def show(rows, repeats, load):
    print(
        f"{'seconds':27}{'scene':17}{'median':>7}{'min':>7}{'max':>7}{'CPU':>7}"
        f"{'goal':>6}"
    )
    for r in rows:
        goal = "" if r["goal_s"] is None else f"{r['goal_s']:6.1f}"
        missed = r["goal_s"] is not None and r["median_s"] > r["goal_s"]
        print(
            f"{r['what']:27}{r['scene']:17}{r['median_s']:7.2f}{r['min_s']:7.2f}"
            f"{r['max_s']:7.2f}{r['processor_s']:7.2f}{goal}"
            + ("  missed" if missed else "")
        )
    print(
        f"\n{repeats} repeats; {processor()}, {os.cpu_count()} cores,"
        f" load average before {load:.1f}"
    )


def processor():
    """Model of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return "processor unknown"
    return next((x.split(": ")[1] for x in lines if "model name" in x), "unknown")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one line per result")
    parser.add_argument("--smoke", action="store_true", help="the library alone, once")
    parser.add_argument("--repeats", type=int, default=5)
    args = parser.parse_args()
    repeats = 1 if args.smoke else args.repeats
    load = os.getloadavg()[0]
    rows = measure(() if args.smoke else SCENES, repeats)
    if args.json:
        for r in rows:
            print(json.dumps(r))
    else:
        show(rows, repeats, load)
    return 0


if __name__ == "__main__":
    sys.exit(main())

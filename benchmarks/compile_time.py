"""How long until the first answer?

Fresh processes, one at a time: import of the package; a bearing of 14 rollers and its
element; first force and stiffness (compiled anew, no cache on disk), all by the clock
of the process itself, counted from the start of the import; and the command line as a
whole, by the clock outside: with an empty cache of compiled programs, then again. So
for a solve from Python after `keep_programs`, and its gradient under `jax.jit`.
Medians of the repeats, and of the processor time (both cores: above the wall time where
the compiler has both, below it where others use the machine). What a process takes that
imports JAX and adds two arrays tells how quiet the machine is.

Of the program of every scene also the equations that are traced and the instructions
that XLA makes of them. `--beside TREE` runs another checkout in turn.

README: first force and stiffness 3.7 s; `solve` 4.2 to 9.9 s, with its program kept 1.7
to 2.9; from Python 7.4 and 1.6, with gradient 12 | 4 s; 8 s; 2 s | yes; **missed**:
pairs of ball rows, spherical rollers, 8.3 to 9.9 and 2.3 to 2.9 s

`--commands` runs the other commands in place of `solve`.

Last run, `--repeats 1`, nothing else running (`sprung_pair`, `thrust_ball` and
`thrust_roller`: beside one other job), while importing JAX and adding two arrays took
0.64 s:

seconds                    solve, first  solve, second  equations  instr.
tapered                            5.0            1.9        6144   11287
needle                             5.8            2.0        6989   11827
nj_axial                           5.0            1.9        6618   11615
hybrid_spindle                     5.3            2.0        6297   11314
deep_groove                        4.6            1.9        5280   10559
angular_contact                    6.2            2.1        8389   18083
ball_pair                          6.4            2.1        9944   19882
noise_pair                         9.0            2.4        9944   19882
crossed_roller                     5.7            2.1        7543   12730
thrust_ball                        5.9            2.4        7362   15781
spherical_roller                   8.3            2.3       12646   19897
sprung_pair                        9.9            2.9       15377   31921
self_aligning                      9.1            2.4       14410   26536

`import bearingjax` takes 0.35 s beside 0.38 s of JAX, the first force and stiffness of
the library 3.7 s. Pairs with seats or springs solve twice: as mounted, and loaded.

Last run, `--commands --repeats 1`, nothing else running, importing JAX and adding two
arrays 0.79 s; wall and processor time [s]:

solve_load                   as it is 7.4, to be kept 4.5, kept 1.6; and gradient 11.9
    processor time                   10.4             5.3       1.7               14.6
                                     first       second
life life_spectrum                16.3 22.8     2.7  2.8
sweep load_map                    11.9 17.2     2.3  2.4
rotor rotor_spindle               20.3 22.9     4.8  5.3
rotor rotor_flexible              24.8 29.4     6.7  7.8
shaft shaft_spindle               36.4 39.1     7.0  7.5
skid skid_axial --steady          19.5 21.6     3.2  3.3
skid skid_roller --steady         15.0 17.3     3.9  4.8
noise noise_deep_groove           23.3 25.6     8.5  8.7
    --monte-carlo 16, 4 turns     90.3 95.8    67.2 67.5

`shaft_spindle` is a spindle that warms up. The integration takes 6 s of the second run
of noise, and 60 s of that with 16 random bearings, each of which runs once as it is and
once without each of four sources (these two were run by hand). Of the second run of
`rotor_flexible` 2.4 s are the branch and 1.2 s the loading of programs; of the first
17 s are XLA.
AMD EPYC, 2 cores; jax 0.10.1
"""

import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from bench import benchmark

GOALS = {"first force and stiffness": 4.0, "solve, first": 8.0, "solve, second": 2.0}
ADD = "import jax.numpy as jnp; jnp.ones(3) + jnp.ones(3)"
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
COMMANDS = (
    "life life_spectrum",
    "sweep load_map",
    "rotor rotor_spindle",
    "rotor rotor_flexible",
    "shaft shaft_spindle",
    "skid skid_axial --steady",
    "skid skid_roller --steady",
    "noise noise_deep_groove",
)
SOLVE = """
import sys
import jax
jax.config.update("jax_enable_x64", True)
import bearingjax as bj

if sys.argv[1] == "kept":
    bj.keep_programs()
bearing = bj.CylindricalRollerBearing(
    14, 0.065, 0.010, 0.010, radial_internal_clearance=25e-6
)
load = jax.numpy.array([4e3, 0.0, 0.0, 0.0, 0.0, 0.0])
if sys.argv[1] == "gradient":
    def sag(clearance):
        changed = bj.CylindricalRollerBearing(
            14, 0.065, 0.010, 0.010, radial_internal_clearance=clearance
        )
        return bj.solve_load(bj.BearingElement(changed), load).displacement[6]
    quick = {"compiler_options": bj.numerics.QUICK_COMPILATION}
    print(jax.jit(jax.value_and_grad(sag), **quick)(25e-6))
else:
    print(bj.solve_load(bj.BearingElement(bearing), load).displacement[6])
"""
SIZES = """
import functools, re, sys
import equinox as eqx, jax
jax.config.update("jax_enable_x64", True)
import bearingjax as bj

def inner(equation):
    params = dict(equation.params)
    if equation.primitive.name == "batched_loop":  # not traced before it is lowered
        program = functools.partial(params.pop("task").program, **params)
        shapes = [(v.aval.shape, v.aval.dtype) for v in equation.invars]
        given = [jax.ShapeDtypeStruct(*shape) for shape in shapes]
        return [jax.make_jaxpr(program)(*given).jaxpr]
    is_inner = lambda value: hasattr(value, "eqns")
    return [p for p in jax.tree.leaves(params, is_leaf=is_inner) if is_inner(p)]

def equations(jaxpr):
    return len(jaxpr.eqns) + sum(equations(p) for e in jaxpr.eqns for p in inner(e))

scene = bj.read_scene(sys.argv[1])

def program(element, load):
    return bj.solve_load(
        element, load, speed=scene.speed, support=scene.support,
        options=scene.solve_options, throw=False,
    )

given = scene.element, jax.numpy.asarray(scene.load)
traced, _, _ = eqx.filter_make_jaxpr(program)(*given)
text = eqx.filter_jit(program).lower(*given).compile().compiled.as_text()
print(equations(traced.jaxpr), len(re.findall(r"(?m)^ +(?:ROOT )?%\\S+ = ", text)))
"""


def run(arguments, cache, tree=None):
    """Output, wall and processor time [s] of a fresh process with its own cache.

    Args:
        arguments: Of Python's `-c`.
        cache: Folder.
        tree: Another checkout of the package, or `None` for the installed one.
    """
    dropped = (
        "JAX_COMPILATION_CACHE_DIR",
        "JAX_ENABLE_COMPILATION_CACHE",
        "PYTHONDONTWRITEBYTECODE",  # an installed package has its bytecode
    )
    environment = {k: v for k, v in os.environ.items() if k not in dropped}
    if tree is not None:
        environment["PYTHONPATH"] = tree
    begin, used = time.perf_counter(), children_time()
    done = subprocess.run(
        [sys.executable, "-c", *arguments],
        env=environment | {"XDG_CACHE_HOME": cache},
        cwd=cache,  # where no other checkout is found before `tree`
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


def last_change(tree):
    """When a source of the package was last changed."""
    top = pathlib.Path(tree or importlib.util.find_spec("bearingjax").origin)
    top = top / "bearingjax" if tree else top.parent
    return max(path.stat().st_mtime for path in top.rglob("*.py"))


def command_line(command, tree):
    """(wall, processor) [s] of a first and a second run with one cache."""
    given, before = [COMMAND, *command.split()], last_change(tree)
    with tempfile.TemporaryDirectory() as cache:
        times = [run(given, cache, tree)[1] for _ in range(2)]
    if last_change(tree) != before:
        sys.exit(f"{command}: sources changed meanwhile; no program is kept over that")
    name = command.split()[0]
    return dict(zip((f"{name}, first", f"{name}, second"), times, strict=True))


def python():
    """(wall, processor) [s] of scripts that solve: as it is, kept, with a gradient."""
    with tempfile.TemporaryDirectory() as cache:
        hows = ("", "kept", "kept", "gradient")
        times = [run([SOLVE, how], cache)[1] for how in hows]
    what = ("", ", to be kept", ", kept", " and gradient")
    return {f"solve_load{w}": t for w, t in zip(what, times, strict=True)}


def sizes(scene, tree):
    """Equations that are traced of a scene's program, instructions of XLA's."""
    with tempfile.TemporaryDirectory() as cache:
        output, _ = run([SIZES, scene], cache, tree)
    return tuple(map(int, output.split()))


def bearings():
    """Names of the shipped scenes of bearings."""
    import bearingjax as bj

    scenes = bj.files.shipped_scenes()
    texts = {name: path.read_text() for name, path in scenes.items()}
    return [name for name, text in texts.items() if "\n[bearing]\n" in text]


def row(what, times, scene="", tree=None, size=(None, None)):
    """Median, shortest, longest of (wall, processor) [s]; median processor time."""
    return {
        "what": what,
        "scene": scene,
        "tree": tree,
        "median_s": float(np.median(times, axis=0)[0]),
        "min_s": float(np.min(times, axis=0)[0]),
        "max_s": float(np.max(times, axis=0)[0]),
        "processor_s": float(np.median(times, axis=0)[1]),
        "goal_s": GOALS.get(what),
        "equations": size[0],
        "instructions": size[1],
    }


def gathered(runs):
    """Times of every step, out of one dict of steps for every run."""
    runs = list(runs)
    return {what: [steps[what] for steps in runs] for what in runs[0]}


def import_and_add():
    """(wall, processor) [s] of a process that imports JAX and adds two arrays."""
    with tempfile.TemporaryDirectory() as cache:
        return {"import jax and add": run([ADD], cache)[1]}


def measure(commands, repeats, trees):
    """Rows, each as soon as it is measured. Trees take turns within a command."""
    for tree in trees:
        with tempfile.TemporaryDirectory() as cache:
            run(["import bearingjax.cli"], cache, tree)  # which writes the bytecode
    for program in (import_and_add, library, python):
        for what, times in gathered(program() for _ in range(repeats)).items():
            yield row(what, times)
    for command in commands:
        runs = [[command_line(command, tree) for tree in trees] for _ in range(repeats)]
        name, scene = command.split()[:2]
        for tree, of_tree in zip(trees, zip(*runs, strict=True), strict=True):
            size = sizes(scene, tree) if name == "solve" else (None, None)
            for what, times in gathered(of_tree).items():
                yield row(what, times, scene, tree, size)


def show(rows):
    print(
        f"{'seconds':26}{'scene':17}{'median':>7}{'min':>7}{'max':>7}{'CPU':>7}"
        f"{'goal':>5}{'equations':>10}{'instr.':>8}"
    )

    for row in rows:
        print(line(row), flush=True)


def line(r):
    goal = "" if r["goal_s"] is None else f"{r['goal_s']:.1f}"
    missed = r["goal_s"] is not None and r["median_s"] > r["goal_s"]
    size = ""
    if r["equations"] is not None:
        size = f"{r['equations']:10d}{r['instructions']:8d}"
    return (
        f"{r['what']:26}{r['scene']:17}{r['median_s']:7.2f}{r['min_s']:7.2f}"
        f"{r['max_s']:7.2f}{r['processor_s']:7.2f}{goal:>5}{size}"
        + ("  missed" if missed else "")
        + (f"  {r['tree']}" if r["tree"] else "")
    )


@benchmark(
    "the library alone, once", show, commands="but solve",
    scenes={"nargs": "+", "metavar": "NAME"},
    beside={"metavar": "TREE", "help": "another checkout"},
)  # fmt: skip
def main(smoke, repeats=5, scenes=None, commands=False, beside=None):
    trees = [None] if beside is None else [os.path.abspath(beside), None]
    run = [f"solve {scene}" for scene in scenes or bearings()]
    run = () if smoke else COMMANDS if commands else run
    return measure(run, 1 if smoke else repeats, trees)

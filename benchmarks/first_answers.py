"""How long until the answer about a second bearing, or about a changed machine?

Whole commands in fresh processes, one after another with one cache of programs, which
is empty at first: a bearing, another one of its kind with more balls, its life; systems
of shafts as they are, once more, and with a bearing turned round, a gear moved, a
bearing of the same kind elsewhere; a search for the best gearbox. Processor time, and
that as a multiple of what a process takes that imports JAX and adds two arrays.
`--beside TREE` runs another checkout in turn. Answers are compared: a run with kept
programs prints what the first one did.

README: an import of JAX takes 1.2 to 1.7 s of this machine's processor, 0.86 on that of
the goals; a second bearing of a kind 2.5 times that, the first 8.3; gearbox 37 s,
stored 7.2; fan 39 and 9.1; wind turbine 36 and 9.0; heated spindle 89 and 15; search
for a gearbox 135 and 32; flexible rotor 67 and 15 | 3 times; shafts 12 s, 3.5 s; wind
turbine 20, 6; search 40, 15; rotors 28 and 6 imports | bearings yes; **missed**:
gearbox 24 and 4.7 s, turbine 23 and 5.8, spindle 58 and 10, search 88 and 21, rotor 44
and 9.6 imports

Last run, in three parts:

what                          wall s   CPU s
solve 6206, first               13.3    14.1
solve 6206, once more            3.1     3.5
solve 6205, same kind            4.1     4.1
solve 6310, same kind            4.0     4.1
life 6206, first                 5.0     5.2
life 6310, same kind             4.2     4.3

gearbox, first                  34.0    36.5
gearbox, once more               5.3     7.2
output torque halved             5.4     7.1
bearing of another size          4.7     6.4
pair turned round                8.4    11.0
fan, after the gearbox          36.8    39.3
fan, once more                   7.4     9.1
wind turbine, first             33.4    35.6
wind turbine, once more          7.2     9.0

gearbox, first                  35.3    37.7
optimise gearbox, first        129.4   135.1
optimise gearbox, once more     26.2    31.9
heated spindle, first           85.1    89.0
heated spindle, once more       11.9    14.7
flexible rotor, first           57.4    67.0
flexible rotor, once more       11.1    14.7
spindle rotor, first            50.1    55.8
spindle rotor, once more         9.7    12.3

two cores, load average 1.1; jax 0.10.1

Where it goes. A machine: about 6.5 s for each kind of bearing in its place, of which 4
are tracing and lowering; stored, 3 s are imports and 2.5 loading. The flexible rotor:
31 s the branch of orbits, of which 23 are XLA's (10 for the two bearings and their
slopes; at its lowest level 13, but then the branch takes 13 s to run in place of 6), 10
two bearings in their places, 7 critical speeds.
"""

import pathlib
import tempfile
from statistics import median

from bench import benchmark
from compile_time import ADD, COMMAND, os, run

from bearingjax.files.scene_file import find_scene

GEARBOX = "shaft shaft_gearbox"
BEARINGS = (
    ("solve 6206, first", "solve 6206.toml"),
    ("solve 6206, once more", "solve 6206.toml"),
    ("solve 6205, same kind", "solve 6205.toml"),
    ("solve 6310, same kind", "solve 6310.toml"),
    ("life 6206, first", "life 6206.toml"),
    ("life 6310, same kind", "life 6310.toml"),
)
MACHINES = (
    ("gearbox, first", GEARBOX),
    ("gearbox, once more", GEARBOX),
    ("output torque halved", f"{GEARBOX} --set drive.power=7kW"),
    ("bearing of another size", f"{GEARBOX} --set bearings.A.designation=6309"),
    ("pair turned round", f"{GEARBOX} --set bearings.C.turned=true"
     " --set bearings.D.turned=false"),
    ("fan, after the gearbox", "shaft shaft_fan"),
    ("fan, once more", "shaft shaft_fan"),
    ("wind turbine, first", "shaft shaft_wind_turbine"),
    ("wind turbine, once more", "shaft shaft_wind_turbine"),
    ("optimise gearbox, first", "optimise gearbox.toml --quiet"),
    ("optimise gearbox, once more", "optimise gearbox.toml --quiet"),
    ("heated spindle, first", "shaft shaft_spindle"),
    ("heated spindle, once more", "shaft shaft_spindle"),
    ("flexible rotor, first", "rotor rotor_flexible"),
    ("flexible rotor, once more", "rotor rotor_flexible"),
    ("spindle rotor, first", "rotor rotor_spindle"),
    ("spindle rotor, once more", "rotor rotor_spindle"),
)  # fmt: skip
SEARCH = """
[optimise]
objective = "system_life"
[optimise.variables]
"bearings.A.position" = { from = "20 mm", to = "55 mm" }
"bearings.C.preload" = { from = "50 N", to = "3000 N" }
[[optimise.constraints]]
measure = "misalignment"
at_most = "0.4 mrad"
"""
"""Two numbers and a bound of the gearbox."""
GOALS = {
    "solve 6205, same kind": "3 times",
    "solve 6310, same kind": "3 times",
    "gearbox, first": "12 s",
    "gearbox, once more": "3.5 s",
    "output torque halved": "as stored",
    "bearing of another size": "as stored",
    "pair turned round": "as stored, plus 2 s",
    "optimise gearbox, first": "40 s",
    "optimise gearbox, once more": "15 s",
    "wind turbine, first": "20 s",
    "wind turbine, once more": "6 s",
}


def scenes(folder, tree):
    """Write the scene of a designation for each of the bearings."""
    names = {part for _, command in BEARINGS for part in command.split()[1:]}
    for name in sorted(names):
        given = [COMMAND, "new", pathlib.Path(name).stem]
        text, _ = run(given, folder, tree)
        (pathlib.Path(folder) / name).write_text(text)
    own = find_scene("shaft_gearbox").read_text()
    (pathlib.Path(folder) / "gearbox.toml").write_text(own + SEARCH)


def told(output):
    """What a run prints, without its warnings and the place of its files."""
    return [line for line in output.splitlines() if not line.startswith("warning")]


def measure(tree, asked):
    with tempfile.TemporaryDirectory() as cache:
        run(["import bearingjax.cli"], cache, tree)  # which writes the bytecode
        unit = median(run([ADD], cache, tree)[1][1] for _ in range(5))
        scenes(cache, tree)
        before = {}
        for what, command in asked:
            output, (wall, processor) = run([COMMAND, *command.split()], cache, tree)
            if before.setdefault(command, told(output)) != told(output):
                raise SystemExit(f"{what}: not what it printed at first")
            yield {
                "what": what,
                "tree": tree or "",
                "wall_s": wall,
                "processor_s": processor,
                "times_import": processor / unit,
                "goal": GOALS.get(what, ""),
            }


def show(rows):
    print(f"{'what':28}{'wall s':>8}{'CPU s':>8}{'imports':>9}  goal", flush=True)
    for r in rows:
        print(
            f"{r['what']:28}{r['wall_s']:8.1f}{r['processor_s']:8.1f}"
            f"{r['times_import']:9.1f}  {r['goal']} {r['tree']}",
            flush=True,
        )


@benchmark(
    "one bearing, twice", show, beside={"metavar": "TREE", "help": "another checkout"}
)
def main(smoke, only="", beside=None):
    asked = BEARINGS[:2] if smoke else (*BEARINGS, *MACHINES)
    asked = [one for one in asked if only in one[0]]
    trees = [None] if beside is None else [os.path.abspath(beside), None]
    print(f"load average {os.getloadavg()[0]:.1f}", flush=True) if not smoke else None
    for tree in trees:
        yield from measure(tree, asked)

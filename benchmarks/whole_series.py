"""Which deep groove ball bearings last? All of the catalogue under one load, in a call.

Every deep groove ball bearing of the catalogue, with 6 to 29 balls, as one
stack of designs (`stack_designs`: rows of fewer balls have empty places). One compiled
call solves each under a load and gives its reference rating life by ISO/TS 16281 and
its basic rating life by ISO 281; a second call has another load. Beside it each bearing
alone, all by the kept program of their kind, as a loop of `solve_load` and
`rating_life` has it, a part of them; their lives are compared. Shoulders of grooves,
which some entries have and others do not, are left out: they change no life.

README: 164 deep groove ball bearings of the catalogue in a call: 3.9 ms each, in a loop
19 |  |

Last run:

164 bearings of 6 to 29 balls
entries and stack                   3.51 s    2.44 s CPU    21.39 ms a bearing
first call, with compilation       22.68 s   22.01 s CPU   138.31 ms a bearing
another load                        0.63 s    0.63 s CPU     3.85 ms a bearing
a loop, extrapolated                3.11 s    3.11 s CPU    18.97 ms a bearing
164 converged; lives within 1.6e-14 of those alone
AMD EPYC, 2 cores, load average 3.8; devices: 1 cpu; jax 0.10.1
"""

import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark

import bearingjax as bj

LOAD = jnp.asarray([0.0, -1000.0, 200.0, 0.0, 0.0, 0.0])
SPEED = bj.Speed(inner=100.0)


def elements(count=None):
    """Elements of all entries, or of some of them evenly chosen."""
    found = []
    for entry in bj.catalogue_entries():
        if entry.type == "deep_groove_ball":
            bearing = eqx.tree_at(
                lambda b: (b.outer_shoulder, b.inner_shoulder),
                bj.load_bearing(entry.designation),
                (None, None),
                is_leaf=lambda leaf: leaf is None,
            )
            found.append(bj.BearingElement(bearing))
    return found if count is None else found[:: max(1, len(found) // count)]


def lives(element, load):
    """Whether it converged, reference and basic rating life [rev]."""
    solution = bj.solve_load(element, load, speed=SPEED, throw=False)
    life = bj.rating_life(element, solution, speed=SPEED)
    return solution.converged, life.reference_rating_life, life.basic_rating_life


def clock():
    return np.array([time.perf_counter(), time.process_time()])


@benchmark("twelve bearings")
def main(smoke):
    begin = clock()
    every = elements(12 if smoke else None)
    stack = bj.stack_designs(every)
    built = clock()
    together = jax.jit(
        jax.vmap(lives, in_axes=(0, None)),
        compiler_options=bj.numerics.QUICK_COMPILATION,
    )
    first = jax.block_until_ready(together(stack, LOAD))
    compiled = clock()
    jax.block_until_ready(together(stack, 1.1 * LOAD))
    again = clock()
    some = every[:: max(1, len(every) // 8)]
    for element in some:  # which compiles
        lives(element, LOAD)
    before = clock()
    alone = [lives(element, LOAD) for element in some]
    after = clock()
    found = np.asarray(first[1])[:: max(1, len(every) // 8)]
    apart = np.abs(found / np.asarray([one[1] for one in alone]) - 1.0).max()
    n, balls = len(every), [element.bearing.n_balls for element in every]
    rows = {
        "entries and stack": built - begin,
        "first call, with compilation": compiled - built,
        "another load": again - compiled,
        "a loop, extrapolated": (after - before) * n / len(some),
    }
    print(f"{n} bearings of {min(balls)} to {max(balls)} balls")
    for what, (wall, processor) in rows.items():
        per = 1e3 * wall / n
        print(f"{what:32}{wall:8.2f} s{processor:8.2f} s CPU{per:9.2f} ms a bearing")
    print(f"{int(np.sum(first[0]))} converged; lives within {apart:.1e} of those alone")
    return bool(np.all(first[0])) and apart < 1e-9

"""Does a branch of vibration end at its limit, or say why, and never jump unseen?

Random rotors like that of method 002: contact angles of 12 to 40 degrees, interference
of one bearing like that of the paper, that of the other from its double down to a
clearance as large (preload shared, small, lost), a base that shakes with 0.3 to
20 m/s², unbalance up to 30 g mm, damping of 0.3 to 5 %: balls lift off in most. Each is
followed downwards in frequency, from 1.3 to 0.5 times the first natural frequency of
the preloaded rotor; where no orbit is found from rest, the motion after 150 periods is
the first guess.

Every point that was accepted is put into the equations anew (at most 1e-8). Between
any two neighbours a third point is sought half way, in the plane across: it must be
found, and lie nearer to the line between them than a fifth of their distance. If it is
not found, or lies further off, the branch is followed between them once more with steps
of a sixteenth of their distance, and if that fails of a 64th: it must arrive at the
second one. Else it was a jump.

README: 50 random rotors: 45 branches end at their limit, 5 say that 800 points were too
few; residuals at most 4e-10; no jump | 1e-8; no jump | yes

Last run:

endings: 45 limit, 5 points
   limit: interference -0.956 to 1.99, points 29 to 676, largest amplitude 0.0558 to
   30.9, refused steps 0 to 59
   points: interference -0.811 to 1.13, points 800 to 800, largest amplitude 3.5 to
   15.7, refused steps 12 to 51
17 began from a motion integrated in time, not from rest
marked: 404 fold, 173 neimark_sacker, 12 flip
13295 points, 7244 unstable, 1 pairs looked at closer;
234 s for the branches, with compilation
largest residual, evaluated anew: 3.9e-10 (at most 1e-08): met
jumps that were not seen: 0 (at most 0): met
AMD EPYC, 2 cores, load average 9.1; devices: 1 cpu; jax 0.10.1
"""

import time
from collections import Counter

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, verdict
from vibrations import ROTOR, grooves

from bearingjax.rotor.nonlinear import (
    BranchEnd,
    FixedAngle,
    HarmonicBalance,
    OpposedPair,
    Steps,
    follow,
    rigid_rotor,
    simulate,
)
from bearingjax.rotor.nonlinear.continuation import place

RANGE = 1.3, 0.5
SOLVED, ASIDE, FINER = 1e-8, 0.2, (16, 64)
SETTLE, SAMPLES = 150, 64
CONSTANT = float(grooves(36).fixed_angle().constant)


def drawn(rng):
    """A random rotor, and what it is like."""
    angle = np.radians(rng.uniform(12, 40))
    z0 = 1e-6 * rng.uniform(10, 25)
    other = z0 * rng.uniform(-1.0, 2.0)
    shaken = float(np.exp(rng.uniform(np.log(0.3), np.log(20.0))))
    nominal, a, b = (
        FixedAngle(CONSTANT, angle, interference, 7) for interference in (z0, z0, other)
    )
    system = rigid_rotor(
        ROTOR,
        nominal,
        nominal,
        scale=z0,
        damping_ratio=float(np.exp(rng.uniform(np.log(0.003), np.log(0.05)))),
        unbalance=rng.uniform(0.0, 3e-5),
        base_acceleration=shaken,
    )
    return eqx.tree_at(lambda s: s.restoring, system, OpposedPair(a, b)), other / z0


@eqx.filter_jit
def checked(system, method, x):
    """Residuals of points, and of each pair how far aside of their middle it bends."""
    left = jax.vmap(lambda x: method.residual(system, x[:-1], x[-1]))(x)

    def between(pair):
        here, there = pair
        step = there - here
        length = jnp.linalg.norm(step)
        along = step / length
        middle = 0.5 * (here + there)
        found, result = place(system, method, middle, along, along)
        return jnp.linalg.norm(found.x - middle) / length, result

    aside, result = jax.lax.map(between, (x[:-1], x[1:]))
    return jnp.max(jnp.abs(left), axis=1), aside, result


@eqx.filter_jit
def arrives(system, method, here, there, finer):
    """Whether short steps lead from one point to the other."""
    chord = there - here
    size = jnp.linalg.norm(chord) / finer
    begin, _ = place(system, method, here, chord, chord)

    def one(carry, _):
        x, along, good = carry
        found, result = place(system, method, x + size * along, along, along)
        near = jnp.linalg.norm(found.x - x - size * along) < 0.5 * size
        return (found.x, found.tangent, good & (result == 0) & near), (found.x, good)

    start = here, begin.tangent, jnp.asarray(True)
    _, (path, good) = jax.lax.scan(one, start, length=2 * finer)
    apart = jnp.where(good, jnp.linalg.norm(path - there[None], axis=1), jnp.inf)
    return jnp.min(apart) < size


def settled(system, frequency):
    """Displacements over the last of many periods from rest, integrated in time."""
    periods = SETTLE + np.arange(SAMPLES) / SAMPLES
    times = 2.0 * np.pi / frequency * periods
    found = simulate(system, times, frequency, throw=False)
    return found.displacement


def one(rng, method, points):
    system, interference = drawn(rng)
    unit = float(system.reference_frequency)
    steps = Steps(largest=0.1, points=points)
    begun = time.perf_counter()
    given = RANGE[0] * unit, RANGE[1] * unit, method
    branch = follow(system, *given, steps=steps)
    begun_anew = branch.ending == BranchEnd.NO_START
    if begun_anew:
        last = settled(system, RANGE[0] * unit)
        branch = follow(system, *given, last, steps=steps)
    seconds = time.perf_counter() - begun
    count = len(branch.frequency)
    row = {
        "interference": float(interference),
        "ending": branch.ending.label,
        "begun_anew": bool(begun_anew),
        "points": count,
        "refused": branch.refused,
        "seconds": seconds,
        "unstable": int((~branch.stable).sum()),
        "events": dict(Counter(event.kind for event in branch.events)),
        "residual": 0.0,
        "bends": 0,
        "jumps": 0,
        "largest": 0.0,
    }
    if count < 2:
        return row
    x = np.concatenate([branch.unknowns, branch.frequency[:, None] / unit], axis=1)
    # One program for all: rows beyond the branch repeat its last two points.
    more = points - count
    tail = np.tile(x[-2:], (more // 2 + 1, 1))[:more]
    left, aside, result = map(
        np.asarray, checked(system, method, jnp.asarray(np.concatenate([x, tail])))
    )
    left, aside, result = left[:count], aside[: count - 1], result[: count - 1]
    doubtful = np.nonzero((result != 0) | ~(aside < ASIDE))[0]
    row["residual"] = float(left.max())
    row["bends"] = len(doubtful)
    row["jumps"] = sum(
        not any(
            bool(arrives(system, method, jnp.asarray(x[k]), jnp.asarray(x[k + 1]), n))
            for n in FINER
        )
        for k in doubtful
    )
    row["largest"] = float((branch.amplitude / np.asarray(system.scale)).max())
    return row


def show(rows):
    endings = Counter(row["ending"] for row in rows)
    print("endings: " + ", ".join(f"{n} {k}" for k, n in endings.most_common()))
    for name in endings:
        some = [row for row in rows if row["ending"] == name]
        parts = [
            f"{label} {min(v):.3g} to {max(v):.3g}"
            for label, v in (
                ("interference", [row["interference"] for row in some]),
                ("points", [row["points"] for row in some]),
                ("largest amplitude", [row["largest"] for row in some]),
                ("refused steps", [row["refused"] for row in some]),
            )
        ]
        print(f"  {name}: " + ", ".join(parts))
    anew = sum(row["begun_anew"] for row in rows)
    print(f"{anew} began from a motion integrated in time, not from rest")
    events = Counter()
    for row in rows:
        events.update(row["events"])
    print("marked: " + ", ".join(f"{n} {k}" for k, n in events.most_common()))
    total = sum(row["points"] for row in rows)
    unstable, bends = (sum(row[k] for row in rows) for k in ("unstable", "bends"))
    seconds = sum(row["seconds"] for row in rows)
    print(f"{total} points, {unstable} unstable, {bends} pairs looked at closer;")
    print(f"{seconds:.0f} s for the branches, with compilation")
    worst = max(row["residual"] for row in rows)
    print(verdict("largest residual, evaluated anew", worst, SOLVED))
    jumps = float(sum(row["jumps"] for row in rows))
    print(verdict("jumps that were not seen", jumps, 0.0))


@benchmark("two rotors, few points", show)
def main(smoke, count=50, seed=0):
    method, points = HarmonicBalance(7, 64, steps=32), 800
    if smoke:
        method, count, points = HarmonicBalance(2, 8, steps=8), 2, 40
    rng = np.random.default_rng(seed)
    return [one(rng, method, points) for _ in range(count)]

"""How long do 64 rotors with scattered preloads take in one call?

The rotor of method 002 with bearings of 36 degrees, base shaken along y by 3 m/s², 1 %
modal damping; the axial preload of either bearing scatters by 20 % (standard
deviation), so that the two differ and the rotor is not symmetric. Each rotor's branch
of periodic orbits is followed through both resonances, with its Floquet multipliers,
by harmonic balance and pseudo-arclength: the compiled loop of one rotor, and the same
loop mapped over all. Checked: every branch of the batch against its own single run,
and the residual of every point.

README: 4456 points of 64 branches: 3.9 s, 0.9 ms a point, no faster than 64 calls |  |

Last run:

64 rotors, 4456 points: one call 3.94 s, singly 3.88 s (1.0 times); 0.89 ms a point
endings {'limit': 64}; 64 with as many points as alone, their amplitudes apart
  3e-14; residual 2e-10
peaks of y at B from 2.10 to 2.55 um; 37 rotors have unstable orbits
AMD EPYC, 2 cores, load average 1.9; devices: 1 cpu; jax 0.10.1

One call is no faster than 64 on two cores: a batch waits for its slowest branch.
"""

from collections import Counter

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shuffled
from vibrations import ROTOR, grooves

from bearingjax.rotor.nonlinear import (
    Arclength,
    BranchEnd,
    FixedAngle,
    HarmonicBalance,
    Steps,
    rigid_rotor,
    trace,
)
from bearingjax.rotor.nonlinear.orbit import amplitudes, beginning

METHOD = HarmonicBalance(5, 32, steps=24)
LAW = grooves(36).fixed_angle()
SCALE = float(LAW.preload_displacement)
BEGIN, END = 2.0 * np.pi * 720.0, 2.0 * np.pi * 540.0
POINTS = 120


def vibration(preloads):
    """Rotor whose bearings have preloads over the nominal one (2,)."""

    def law(factor):
        # P = Z K (z0 sin α)^(3/2) sin α.
        z0 = LAW.preload_displacement * factor ** (2.0 / 3.0)
        return FixedAngle(LAW.constant, LAW.contact_angle, z0, LAW.n_balls)

    a, b = law(preloads[0]), law(preloads[1])
    return rigid_rotor(
        ROTOR, a, b, scale=SCALE, damping_ratio=0.01, base_acceleration=3.0
    )


def branch(preloads):
    """Frequencies [rad/s], amplitude of y at B [m], stability, and how it went."""
    system = vibration(preloads)
    unit = system.reference_frequency
    start = METHOD.unknowns(beginning(system, None))
    found = trace(
        system,
        METHOD,
        jnp.append(start, BEGIN / unit),
        END / unit,
        Arclength(),
        Steps(largest=0.06, points=POINTS),
    )
    amplitude = jax.vmap(amplitudes)(found.motion)[:, 3] * SCALE
    radius = jnp.max(jnp.abs(jnp.linalg.eigvals(found.monodromy)), axis=1)
    used = jnp.arange(POINTS) < found.n_points
    return {
        "frequency": jnp.where(used, found.x[:, -1] * unit, jnp.nan),
        "amplitude": jnp.where(used, amplitude, jnp.nan),
        "unstable": jnp.sum(used & (radius > 1.0 + 1e-6)),
        "residual": jnp.max(jnp.where(used, found.residual, 0.0)),
        "count": found.n_points,
        "ending": found.ending,
    }


def show(found):
    points, seconds = found["points"], found["seconds"]
    print(
        f"{found['rotors']} rotors, {points} points: one call {seconds['all']:.2f} s,"
        f" singly {seconds['singly']:.2f} s"
        f" ({seconds['singly'] / seconds['all']:.1f} times);"
        f" {1e3 * seconds['all'] / points:.2f} ms a point\n"
        f"endings {found['endings']}; {found['same_counts']} with as many points as"
        f" alone, their amplitudes apart {found['apart']:.0e}; residual"
        f" {found['residual']:.0e}"
    )
    low, high = (1e6 * peak for peak in found["peaks"])
    print(
        f"peaks of y at B from {low:.2f} to {high:.2f} um; {found['unstable']} rotors"
        " have unstable orbits"
    )


@benchmark("three", show)
def main(smoke):
    count, rounds = (3, 1) if smoke else (64, 5)
    rng = np.random.default_rng(0)
    preloads = jnp.asarray(np.clip(1.0 + 0.2 * rng.standard_normal((count, 2)), 0.3, 2))
    one = eqx.filter_jit(branch)
    every = eqx.filter_jit(jax.vmap(branch))
    alone = [jax.tree.map(np.asarray, one(given)) for given in preloads]
    batch = jax.tree.map(np.asarray, every(preloads))
    # A batch goes on until its slowest branch has ended: the same points otherwise.
    same = [k for k, s in enumerate(alone) if batch["count"][k] == s["count"]]
    apart = [batch["amplitude"][k] / alone[k]["amplitude"] - 1.0 for k in same]
    calls = {
        "all": lambda: every(preloads),
        "singly": lambda: [one(given) for given in preloads],
    }
    peak = np.nanmax(batch["amplitude"], axis=1)
    endings = Counter(BranchEnd(int(e)).label for e in batch["ending"])
    return {
        "rotors": count,
        "points": int(batch["count"].sum()),
        "seconds": {n: float(np.median(t)) for n, t in shuffled(calls, rounds).items()},
        "endings": dict(endings),
        "same_counts": len(same),
        "apart": float(max(np.nanmax(np.abs(a)) for a in apart)),
        "residual": float(batch["residual"].max()),
        "peaks": [float(peak.min()), float(peak.max())],
        "unstable": int((batch["unstable"] > 0).sum()),
    }

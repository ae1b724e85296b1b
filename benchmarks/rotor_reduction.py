"""What does a shaft of many elements cost in the nonlinear solver, reduced or not?

A shaft of 30 mm and 0.5 m with a disc of 6 kg on two opposed bearings of method 002
(26 degrees, fixed contact angle, balls that lift off), under its weight and an
unbalance of 1e-3 kg m, with 1 % modal damping. One periodic orbit is sought from rest
by harmonic balance with 3 harmonics, at a speed below and one above the first
resonance: of all freedoms, and held to Craig-Bampton motions with some clamped modes.
Beside it the rigid shaft of five freedoms. Time is that of Newton's method until the
residual is 1e-10, compiled; error is that of the largest amplitude of any station
against the full rotor of as many elements.

README: 40 elements, 8 Craig-Bampton modes: 2.6 times the rigid rotor, error 1e-4;
without reduction 366 times | 10 times; 1e-3 | yes

Last run:

elements  modes  freedoms  speed  steps       ms   over rigid    error
   rigid      0         5    450      3     1.44          1.0
   rigid      0         5   1000      4     1.32          1.0
       5      2        12    450      4     2.59          1.8   1.2e-03
       5      2        12   1000      4     2.12          1.6   1.1e-03
       5      4        14    450      4     3.09          2.1   5.5e-05
       5      4        14   1000      4     2.46          1.9   1.0e-03
       5      8        18    450      4     3.06          2.1   2.3e-05
       5      8        18   1000      4     3.55          2.7   8.9e-05
       5    all        30    450      4    11.61          8.0   0.0e+00
       5    all        30   1000      4     7.52          5.7   0.0e+00
      10      2        12    450      4     2.02          1.4   1.2e-03
      10      2        12   1000      4     2.36          1.8   1.1e-03
      10      4        14    450      4     2.16          1.5   6.0e-05
      10      4        14   1000      4     3.06          2.3   1.0e-03
      10      8        18    450      4     3.50          2.4   2.7e-05
      10      8        18   1000      4     3.38          2.6   1.0e-04
      10    all        55    450      4    25.59         17.7   0.0e+00
      10    all        55   1000      4    27.12         20.5   0.0e+00
      20      2        12    450      4     2.08          1.4   1.2e-03
      20      2        12   1000      4     2.40          1.8   1.1e-03
      20      4        14    450      4     2.27          1.6   6.1e-05
      20      4        14   1000      4     2.59          2.0   1.0e-03
      20      8        18    450      4     3.49          2.4   2.8e-05
      20      8        18   1000      4     3.71          2.8   1.0e-04
      20    all       105    450      4   110.39         76.4   0.0e+00
      20    all       105   1000      4   104.69         79.2   0.0e+00
      40      2        12    450      4     2.44          1.7   1.2e-03
      40      2        12   1000      4     2.03          1.5   1.1e-03
      40      4        14    450      4     2.23          1.5   6.1e-05
      40      4        14   1000      4     3.15          2.4   1.0e-03
      40      8        18    450      4     3.33          2.3   2.8e-05
      40      8        18   1000      4     3.43          2.6   1.0e-04
      40    all       205    450      4   528.76        366.2   0.0e+00
      40    all       205   1000      4   469.93        355.3   0.0e+00
40 elements, 8 modes: time over that of the rigid rotor: 2.59 (at most 10): met
40 elements, 8 modes: error of the largest amplitude: 0.000103 (at most 0.001): met
AMD EPYC, 2 cores, load average 1.5; devices: 1 cpu; jax 0.10.1
"""

from functools import partial

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shuffled, table, verdict
from vibrations import grooves

import bearingjax as bj
from bearingjax.rotor.nonlinear import HarmonicBalance, LawSupport, vibrating_rotor
from bearingjax.rotor.nonlinear.orbit import (
    along_frequency,
    amplitudes,
    beginning,
    correct,
)

METHOD = HarmonicBalance(3, 16, steps=16)
MODES = (2, 4, 8)
SPEEDS = 450.0, 1000.0
GOAL_COST, GOAL_ERROR = 10.0, 1e-3


def rotor(elements, rigid=False):
    law = grooves(26).fixed_angle()
    shaft = bj.rotor.Shaft(
        [0.0, 0.2, 0.5], 0.03, divisions=(2 * elements // 5, 3 * elements // 5)
    )
    supports = [LawSupport(0, law), LawSupport(2, law, turned=True)]
    disc = bj.rotor.Disc(1, 6.0, 0.02, 0.012)
    return bj.rotor.Rotor(
        shaft, disc, supports, bj.rotor.ModalDamping(0.01), rigid=rigid
    )


LOADS = bj.rotor.RotorLoads(bj.rotor.Unbalance(1, 1e-3), gravity=(0.0, -9.81, 0.0))


def vibration(elements, modes=None, rigid=False):
    whole = rotor(elements, rigid)
    settled = bj.rotor.static_equilibrium(whole, LOADS)
    system = vibrating_rotor(
        whole,
        LOADS,
        scale=1e-5,
        reference_frequency=1e3,
        modes=modes,
        about=None if rigid else settled.motion,
    )
    return system, whole


@eqx.filter_jit
def orbit(system, frequency):
    ratio = frequency / system.reference_frequency
    x = jnp.append(METHOD.unknowns(beginning(system, None)), ratio)
    return correct(system, METHOD, x, along_frequency(x.shape[0] - 1, x.dtype), 50)


def stations(system, whole, found):
    """Amplitudes of ux and uy at the stations [m]."""
    u, _ = METHOD.motion(system, found.x[:-1], found.x[-1])
    every = np.asarray(amplitudes((u * system.scale) @ system.motions.T))
    places = [whole.slice_at(k).start for k in range(whole.shaft.n_segments + 1)]
    return np.array([every[at : at + 2] for at in places])


def show(rows):
    rigid = {r["speed"]: r["milliseconds"] for r in rows if r["elements"] == "rigid"}
    for r in rows:
        r["over"] = r["milliseconds"] / rigid[r["speed"]]
        r["kept"] = "all" if r["modes"] is None else r["modes"]
    table(rows, {
        "elements": "{elements:}", "modes": "{kept:}", "freedoms": "{freedoms:d}",
        "speed": "{speed:.0f}", "steps": "{steps:d}", "ms": "{milliseconds:.2f}",
        "over rigid": "{over:.1f}", "error": "{error:.1e}", "solved": "{solved}",
    })  # fmt: skip
    count = rows[-1]["elements"]
    most = [row for row in rows if row["elements"] == count and row["modes"] == 8]
    cost, error = (max(row[k] for row in most) for k in ("over", "error"))
    label = f"{count} elements, 8 modes:"
    print(verdict(f"{label} time over that of the rigid rotor", cost, GOAL_COST))
    print(verdict(f"{label} error of the largest amplitude", error, GOAL_ERROR))


@benchmark("five elements, once", show)
def main(smoke):
    cases = {("rigid", 0): vibration(5, rigid=True)}
    for count in (5,) if smoke else (5, 10, 20, 40):
        for modes in (*MODES, None):
            cases[count, modes] = vibration(count, modes)
    calls = {
        (*name, speed): partial(orbit, system, jnp.asarray(speed))
        for name, (system, _) in cases.items()
        for speed in SPEEDS
    }
    found = {name: call() for name, call in calls.items()}
    times = shuffled(calls, 1 if smoke else 5, warm=False)
    rows = []
    for (count, modes, speed), here in found.items():
        system, whole = cases[count, modes]
        error = None
        if count != "rigid":
            got = stations(system, whole, here)
            full = stations(*cases[count, None], found[count, None, speed])
            error = float(np.abs(got - full).max() / np.abs(full).max())
        rows.append({
            "elements": count, "modes": modes, "speed": speed, "error": error,
            "freedoms": int(system.mass.shape[0]), "steps": int(here.steps),
            "milliseconds": 1e3 * float(np.median(times[count, modes, speed])),
            "solved": int(here.result) == 0,
        })  # fmt: skip
    return rows

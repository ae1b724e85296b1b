"""Are the derivatives of what a rotor does those of differences?

A disc of 6 kg on a shaft of two diameters between two preloaded angular contact ball
bearings, under weight and unbalance. Derivatives with respect to preload (axial offset
of both bearings), contact angle, both diameters, unbalance and damping of the bearings:

* settled: sag of the disc, stiffness of a bearing, and about that place a natural
  frequency and damping ratio at speed, the first critical speed of forward whirl, the
  amplitude of the disc under unbalance;
* periodic orbits with the true force of every ball, shaft rigid, by harmonic balance
  and by shooting: amplitude and size of the largest multiplier.

All in reverse mode. Beside them differences of fourth order with steps from 3e-2 to
1e-3 of the number: the least of the errors over the steps, which form a V. Errors are
relative to the derivative, or to a thousandth of the result over the number where that
is more (numbers that do not matter).

README: settled rotor within 5e-9; by harmonic balance 2e-9, by shooting 6e-10 | 1e-6;
1e-5 shooting | yes

Last run, the largest error of each result and the number that it belongs to:

settled and linear, goal 1e-06
  sag                 6e-11 diameter 2
  radial stiffness    7e-10 diameter 1
  axial stiffness     6e-11 diameter 1
  natural frequency   2e-11 preload
  damping ratio       5e-09 diameter 1
  critical speed      5e-12 contact angle
  unbalance amplitude 5e-10 diameter 1
harmonic balance, goal 1e-06
  amplitude           3e-10 contact angle
  largest multiplier  2e-09 contact angle
shooting, goal 1e-05
  amplitude           4e-11 damping
  largest multiplier  6e-10 preload
AMD EPYC, 2 cores, load average 3.9; devices: 1 cpu; jax 0.10.1
"""

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, slopes_beside, table

import bearingjax as bj
from bearingjax.rotor.nonlinear import (
    HarmonicBalance,
    Shooting,
    solve_orbit,
    vibrating_rotor,
)

NUMBERS = {
    "preload": 10e-6,
    "contact angle": np.deg2rad(15.0),
    "diameter 1": 0.025,
    "diameter 2": 0.03,
    "unbalance": 5e-6,
    "damping": 300.0,
}
"""SI units."""
AT = jnp.array(list(NUMBERS.values()))
STEPS = 3e-2, 1e-2, 3e-3, 1e-3
SPEED, FAST = 700.0, 3000.0
"""Of the linear analyses, and of the orbits [rad/s]."""


def built(numbers, rigid):
    """Rotor and loads."""
    preload, angle, first, second, moment, damping = numbers
    bearing = bj.AngularContactBallBearing(
        7, 0.04, 0.008, contact_angle=angle, outer_osculation=0.52,
        inner_osculation=0.52,
    )  # fmt: skip
    element = bj.BearingElement(bearing)
    offset = jnp.zeros(5).at[2].set(preload)
    dampers = jnp.zeros(5).at[:3].set(damping)
    supports = [
        bj.rotor.BearingSupport(k, element, offset, dampers, turned=turned)
        for k, turned in ((0, False), (2, True))
    ]
    shaft = bj.rotor.Shaft([0.0, 0.12, 0.3], jnp.stack([first, second]))
    disc = bj.rotor.Disc.of_size(1, 0.2, 0.025, 0.025)
    own = None if rigid else bj.rotor.ModalDamping(0.005)
    rotor = bj.rotor.Rotor(shaft, disc, supports, own, rigid=rigid)
    return rotor, bj.rotor.RotorLoads(
        bj.rotor.Unbalance(1, moment), gravity=[0.0, -9.81, 0.0]
    )


def settled(numbers):
    rotor, loads = built(numbers, False)
    found = bj.rotor.static_equilibrium(rotor, loads, throw=False)
    modes = bj.rotor.modes(found.rotor, SPEED, count=4)
    critical = bj.rotor.critical_speeds(found.rotor, count=2)
    response = bj.rotor.unbalance_response(found.rotor, loads.unbalances, [SPEED])
    return {
        "sag": found.displacement[1, 1],
        "radial stiffness": found.stiffness[0, 1, 1],
        "axial stiffness": found.stiffness[0, 2, 2],
        "natural frequency": modes.frequency[1],
        "damping ratio": modes.damping_ratio[1],
        "critical speed": critical.speed[1],
        "unbalance amplitude": response.major_axis[0, 1],
    }


def orbit(method):
    def results(numbers):
        rotor, loads = built(numbers, True)
        system = vibrating_rotor(
            rotor, loads, scale=1e-6, reference_frequency=FAST
        )  # fmt: skip
        found = solve_orbit(system, FAST, method, throw=False)
        return {
            "amplitude": found.amplitude[1],
            "largest multiplier": jnp.max(jnp.abs(found.multipliers)),
        }

    return results


GROUPS = {
    "settled and linear": (settled, 1e-6),
    "harmonic balance": (orbit(HarmonicBalance(5, 32, steps=32)), 1e-6),
    "shooting": (orbit(Shooting(48)), 1e-5),
}


def compared(name, steps):
    """Print the table of a group; whether errors are within the goal."""
    results, goal = GROUPS[name]
    names = list(jax.eval_shape(results, AT))

    def row(changes):
        found = results(AT * (1.0 + changes))
        return jnp.stack([found[what] for what in names])

    value, none = jax.jit(row), jnp.zeros_like(AT)
    slopes = np.asarray(jax.jit(jax.jacrev(row))(none))
    here = np.abs(np.asarray(value(none)))
    assert np.isfinite(slopes).all() and np.isfinite(here).all()
    found = slopes_beside(value, slopes, steps, 1e-3 * here, range(len(AT)))
    errors = np.stack([error for _, error in found], axis=1)
    print(f"\n{name}, goal {goal:g}")
    rows = []
    for i, what in enumerate(names):
        for k, (number, size) in enumerate(NUMBERS.items()):
            told = {"result": what, "number": number, "error": errors[i, k]}
            missed = "" if errors[i, k] <= goal else "MISSED"
            rows.append(told | {"missed": missed, "slope": slopes[i, k] / size})
    table(rows, {"result": "{result}", "with respect to": "{number}",
                 "derivative": "{slope:.4e}", "error": "{error:.0e}",
                 "": "{missed}"})  # fmt: skip
    return bool((errors <= goal).all())


@benchmark("the first group, one step")
def main(smoke):
    groups = list(GROUPS)[:1] if smoke else list(GROUPS)
    return all([compared(name, STEPS[2:3] if smoke else STEPS) for name in groups])

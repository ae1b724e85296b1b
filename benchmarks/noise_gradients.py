"""Are the derivatives of a bearing's noise those of differences?

Seven balls in a four-point bearing, waves on both raceways, axial and radial load, and
a preloaded pair of two rows of seven whose shaft tilts; the record of a turn after a
turn. Derivatives of the level in a band with respect to the amplitudes of waves,
radial clearance, load, osculation and retardation, to preload offset and spacing of the
pair, in reverse and in forward mode, through every step of the motion and the place
where it begins. Beside them differences of fourth order with steps from 1e-3 to 3e-6 of
the number: the least of the errors over the steps, which form a V. Errors are relative
to the derivative by the logarithm of the number, or to 0.01 dB where that is more.

README: level of a band after two turns: within 8e-7 of differences, forward within
2e-11 of reverse | 1e-5 | yes

Last run:

four-point bearing: 6 steps a sample
levels [80.22625721 73.50668884 71.2234341 ] dB
number            derivative by its logarithm, x y z [dB]   error
outer waves       [ 0.47969098  0.68870566 -0.03778939]  8e-07
inner waves       [8.38238847 9.26440121 9.93270949]  3e-09
clearance         [-0.78543688 -0.47574789 -1.21505539]  1e-08
axial load        [-1.3790143  -2.09023497 -1.36192892]  5e-08
radial load       [-0.03504312  0.37660919  0.24266542]  7e-08
outer osculation  [49.4892456  17.4911979  10.06163497]  9e-09
retardation       [-0.03969593 -0.05508997 -0.18216277]  3e-07
pair: 15 steps a sample
levels [69.42235992 69.97484957 69.79559212] dB
number            derivative by its logarithm, x y z [dB]   error
outer waves       [ 8.80254958 15.38856053  5.7612741 ]  7e-12
preload offset    [   2.84316709  -53.7542603  -157.78491346]  2e-09
spacing           [  17.96902942  -82.72240928 -139.46320568]  7e-11
forward against reverse: 1.66e-11 (at most 1e-09): met
against differences: 8.25e-07 (at most 1e-05): met
AMD EPYC, 2 cores, load average 2.7; devices: 1 cpu; jax 0.10.1
"""

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, slopes_beside, verdict

import bearingjax as bj
from bearingjax.design import FormErrors, Harmonics, RacewayErrors
from bearingjax.noise import NoiseModel, level, needed_steps, vibration

NUMBERS = {
    "outer waves": 0.2e-6,
    "inner waves": 0.3e-6,
    "clearance": 40e-6,
    "axial load": 85.0,
    "radial load": 25.0,
    "outer osculation": 0.52,
    "retardation": 4e-6,
}
"""SI units."""
PAIRED = {"outer waves": 0.2e-6, "preload offset": 10e-6, "spacing": 40e-3}
"""Of the pair, SI units."""
STEPS = 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6
SAMPLES, LINES = 256, slice(8, 33)
"""Per turn; lines of the record of one turn that form the band."""
LEAST = 0.01
"""Derivative below which errors are counted against it [dB]."""


def model(numbers):
    """The bearing."""
    outer, inner, clearance, axial, radial, osculation, retardation = numbers
    bearing = bj.FourPointBallBearing(
        7, 0.0775, 0.014288, outer_osculation=osculation, inner_osculation=0.52,
        shim_angle=np.deg2rad(24.0), radial_internal_clearance=clearance,
        material=bj.Material(density=7850.0),
    )  # fmt: skip
    zero = jnp.zeros(())
    errors = FormErrors(
        RacewayErrors(outwards=Harmonics((3, 8), outer * jnp.array([1.0, 0.5]))),
        RacewayErrors(
            axial=Harmonics((2, 7), inner * jnp.ones(2), [0.4, 1.0]),
            outwards=Harmonics((6, 8), inner * jnp.array([1.0, 0.7]), [1.0, 2.0]),
        ),
    )
    load = jnp.stack([zero, -radial, axial, zero, zero, zero])
    # Fast, so that a step is a large share of a turn.
    speed = bj.Speed(inner=1000.0)
    return NoiseModel(
        bj.BearingElement(bearing),
        0.37,
        load,
        speed,
        errors,
        retardation=retardation,
        tilts=False,
    )


def pair(numbers):
    """Two rows back to back, with waves of their own, whose inner ring tilts."""
    waves, offset, spacing = numbers
    row = bj.AngularContactBallBearing(
        7, 0.05, 0.0095, contact_angle=np.deg2rad(25.0), outer_osculation=0.52,
        inner_osculation=0.53,
    )  # fmt: skip
    errors = tuple(
        FormErrors(RacewayErrors(outwards=Harmonics(orders, waves * jnp.ones(2))))
        for orders in ((2, 6), (3, 8))
    )
    return NoiseModel(
        bj.BearingElement(bj.BearingSet.back_to_back(row, spacing, offset)), 2.0,
        [0.0, -30.0, 20.0, 0.0, 0.0, 0.0], bj.Speed(inner=1000.0), errors, 0.005,
        moving_ring="inner",
    )  # fmt: skip


def band(model, steps):
    """Level of a band along each direction [dB], by the lines of a plain sum."""
    found = vibration(
        model, turns=1, settle=1, samples=SAMPLES, steps=steps, throw=False
    )
    # No fast transform within a larger program: on processors it may wait for ever.
    number = np.arange(SAMPLES)
    turned = 2 * np.pi / SAMPLES * np.outer(number[LINES], number)
    real = jnp.asarray(np.cos(turned)) @ found.acceleration[:, :3]
    imaginary = jnp.asarray(np.sin(turned)) @ found.acceleration[:, :3]
    square = jnp.sum(real**2 + imaginary**2, axis=0) * (2.0 / SAMPLES**2)
    return level(jnp.sqrt(square))


def study(name, model, numbers, smoke):
    """Print the table of one bearing; how far modes, and differences, are apart."""
    names, at = list(numbers), jnp.array(list(numbers.values()))
    steps = needed_steps(model(at), SAMPLES)
    print(f"{name}: {steps} steps a sample")

    def value(changes):
        return band(model(at * (1.0 + changes)), steps)

    run, none = jax.jit(value), jnp.zeros_like(at)
    forward = np.asarray(jax.jit(jax.jacfwd(value))(none))
    reverse = forward
    if not smoke:
        reverse = np.asarray(jax.jit(jax.jacrev(value))(none))
    apart = float(np.max(np.abs(forward - reverse)) / np.max(np.abs(forward)))
    print(f"levels {np.asarray(run(none))} dB")
    print(f"{'number':17s} derivative by its logarithm, x y z [dB]   error")
    worst, tried = 0.0, STEPS[2:3] if smoke else STEPS
    places = range(1 if smoke else len(names))
    for k, least in slopes_beside(run, reverse, tried, LEAST, places):
        worst = max(worst, float(np.max(least)))
        print(f"{names[k]:17s} {forward[:, k]}  {np.max(least):.0e}", flush=True)
    return apart, worst


@benchmark("one number, one step")
def main(smoke):
    cases = [("four-point bearing", model, NUMBERS), ("pair", pair, PAIRED)]
    found = [study(*case, smoke) for case in (cases[:1] if smoke else cases)]
    apart, worst = (max(one) for one in zip(*found, strict=True))
    print(verdict("forward against reverse", apart, 1e-9))
    # Of a single step size in the small run.
    goal = 1e-3 if smoke else 1e-5
    print(verdict("against differences", worst, goal))
    return apart <= 1e-9 and worst <= goal

"""Are the derivatives of skidding those of differences, of every real number?

Slip of the cage, friction torque and largest sliding speed, of the bearing of Han & Chu
at the end state (`skid.steady`, 120 N axial) and after 3 ms from rolling
(`skid.simulate`, 16 N, pockets without clearance), with respect to preload, speeds and
every real number of design, oil, drag and cage. All in one pass backwards; forwards
too, one way. Beside them central differences with steps from 1e-2 to 1e-6 of the
number: the least of the errors over the steps, which form a V. Errors are relative to
the derivative, or to a thousandth of what is differentiated over the number where that
is more (numbers that do not matter). In time the clearance of the pockets is left out:
it is zero, at its bound, and a ball that first has to cross it moves otherwise.

README: end state, 38 numbers: 6e-7; 3 ms in time: 7e-6; where balls meet the cage 1e-2,
at tolerance 1e-10 2e-3 | 1e-6; 1e-4 | **missed** through impacts; rest yes

Last run:

end state: 38 numbers; forwards and backwards agree to 6e-14
  slip: largest errors contact_angle 6e-07, inner 7e-09, least_film 5e-09
  torque: largest errors inner_osculation 1e-07, outer_osculation 4e-08,
    reference_viscosity 2e-08
  sliding: largest errors inner_osculation 1e-08, density 3e-09,
    reference_viscosity 3e-09
in time: 37 numbers; forwards and backwards agree to 3e-09
  slip: largest errors cage.stiffness 6e-06, cage.inertia 1e-06
  torque: largest errors cage.stiffness 7e-06, pitch_diameter 3e-08
  sliding: largest errors cage.stiffness 1e-06, cage.inertia 3e-07
AMD EPYC, 2 cores, load average 3.3; devices: 1 cpu; jax 0.10.1

Where balls meet the cage on the way the force has a kink inside a step, and derivatives
are as good as the steps are short: with pockets of 1 µm, slip by the inner speed and by
the clearance are 1e-2 off at a tolerance of 1e-8, 2e-3 and 3e-4 at 1e-10.
"""

from functools import partial

import equinox as eqx
import jax
import jax.flatten_util
import jax.numpy as jnp
import numpy as np
from bench import benchmark, slopes_beside
from han_chu import FREE, MODEL

from bearingjax import Speed, Support, skid

WHAT = "slip", "torque", "sliding"
STEPS = 1e-2, 1e-3, 1e-4, 1e-5, 1e-6
BOUNDS = {"end state": 1e-6, "in time": 1e-4}


def numbers(load):
    """All that may be changed: one pytree."""
    cage = eqx.tree_at(
        lambda m: m.cage.pocket_clearance, MODEL, jnp.zeros_like(MODEL.temperature)
    )
    return {
        "load": jnp.asarray(load),
        "inner": jnp.asarray(209.4395),
        "outer": jnp.asarray(0.0),
        "model": cage,
    }


def given(numbers):
    """Arguments of both functions."""
    load = jnp.zeros(6).at[2].set(numbers["load"])
    return load, Speed(inner=numbers["inner"], outer=numbers["outer"])


def of_results(found, orbit, rolling):
    sliding = jnp.max(jnp.sqrt(jnp.sum(found.sliding**2, axis=-1)))
    torque = jnp.ravel(found.friction_torque)[-1]
    return jnp.stack([1.0 - orbit / rolling, torque, sliding])


def end_state(numbers, _):
    load, speed = given(numbers)
    found = skid.steady(
        numbers["model"],
        load,
        speed=speed,
        support=Support(free=FREE),
        places=1,
        throw=False,
    )
    return of_results(found, found.cage_speed, found.rolling_orbit_speed[0])


def in_time(numbers, derivatives):
    load, speed = given(numbers)
    found = skid.simulate(
        numbers["model"],
        load,
        speed=speed,
        times=np.array([0.0, 0.003]),
        support=Support(free=FREE),
        options=skid.SkidOptions(1e-8, 512, derivatives, places=1),
        throw=False,
    )
    rolling = found.rolling_orbit_speed[-1, 0]
    last = eqx.tree_at(lambda f: f.sliding, found, found.sliding[-1])
    return of_results(last, found.cage_speed[-1], rolling)


def flat(tree):
    """All real numbers in a row, their names, and the way back."""
    inexact, rest = eqx.partition(tree, eqx.is_inexact_array)
    vector, back = jax.flatten_util.ravel_pytree(inexact)
    names = [
        jax.tree_util.keystr(path) + (f"[{k}]" if leaf.size > 1 else "")
        for path, leaf in jax.tree_util.tree_leaves_with_path(inexact)
        for k in range(leaf.size)
    ]
    return vector, names, lambda v: eqx.combine(back(v), rest)


def compared(name, function, load, steps, order=2):
    """Print the worst errors; whether they are within bounds."""
    vector, names, back = flat(numbers(load))
    size = jnp.where(vector == 0, 1.0, jnp.abs(vector))
    # Tilts and lengths of zero, such as a pocket without clearance, move a little.
    size = jnp.where(vector == 0, 1e-6, size)

    @partial(jax.jit, static_argnames="derivatives")
    def value(factors, derivatives):
        return function(back(vector + factors * size), derivatives)

    moved = partial(value, derivatives="reverse")
    none = jnp.zeros_like(vector)
    slopes = jax.jit(jax.jacrev(lambda f: moved(f)))(none)
    assert np.all(np.isfinite(slopes))
    way = jnp.asarray(np.random.default_rng(0).normal(size=vector.size))
    _, forward = jax.jvp(lambda f: value(f, derivatives="forward"), (none,), (way,))
    both = np.max(np.abs(forward - slopes @ way) / np.abs(forward))
    here = np.abs(moved(none))
    left_out = [name == "in time" and "pocket_clearance" in n for n in names]
    found = np.full((len(WHAT), vector.size), np.inf)
    found[:, left_out] = 0.0
    places = np.flatnonzero(np.logical_not(left_out))
    for k, error in slopes_beside(moved, slopes, steps, 1e-3 * here, places, order):
        found[:, k] = error
    count = vector.size - sum(left_out)
    print(f"{name}: {count} numbers; forwards and backwards agree to {both:.0e}")
    within = both < BOUNDS[name]
    for row, what in zip(found, WHAT, strict=True):
        order = np.argsort(row)[::-1][:3]
        worst = ", ".join(f"{names[k]} {row[k]:.0e}" for k in order)
        print(f"  {what}: largest errors {worst}", flush=True)
        within = within and row[order[0]] < BOUNDS[name]
    return within


@benchmark("the end state, two steps")
def main(smoke):
    if smoke:
        return compared("end state", end_state, 120.0, STEPS[1:3], order=4)
    within = compared("end state", end_state, 120.0, STEPS)
    return compared("in time", in_time, 16.0, STEPS) and within

"""What does a GPU buy? Many bearings, load solves and gradients in one call.

A cylindrical roller bearing (NU), 14 crowned rollers, 32 nodes per raceway contact, in
float64: force and stiffness at random ring motions; displacement under random radial
loads with moments, from first contact; the sag under such a load and its gradient by
clearance, roller length and crown radius. The processor runs chunks of 64 cases in one
call, which uses few of its cores; the GPU runs all cases at once, and where the steps
that they need differ, `numerics.compiled.batched_loop.WIDER` times as many at a time as
the processor. Times are those of hot calls, medians of three, results left on the
device. Errors are relative to the largest result of the processor.

README: H100: force and stiffness 0.28 µs a case, load solves 4.2, with gradient 4.2;
one call on its host's processor 24, 513, 589 |  |

`--seconds` leaves out the larger batches once so much time is spent.

Last runs, `--device gpu --seconds 150`, the gradients in a run of their own:

                           device    cases   µs/case  compile, s  failed   error
force and stiffness           cpu     1000     26.36         3.2       0   0e+00
force and stiffness           cpu    10000     23.63         3.3       0   0e+00
force and stiffness           gpu     1000      0.99         5.2       0   3e-16
force and stiffness           gpu    10000      0.36         3.6       0   3e-16
force and stiffness           gpu   100000      0.30         4.1       0   3e-16
force and stiffness           gpu  1000000      0.28         4.7       0   3e-16
load solve                    cpu     1000    485.99         6.8       0   0e+00
load solve                    cpu    10000    513.34         5.2       0   0e+00
load solve                    gpu     1000     11.73         5.7       0   3e-16
load solve                    gpu    10000      5.50         7.0       0   3e-16
load solve                    gpu   100000      4.17         9.8       0   3e-16
gradient of a load solve      cpu     1000    614.08        21.2       0   0e+00
gradient of a load solve      cpu    10000    589.21        14.4       0   0e+00
gradient of a load solve      gpu     1000     12.13        11.6       0   2e-15
gradient of a load solve      gpu    10000      5.76        11.9       0   2e-15
gradient of a load solve      gpu   100000      4.20        14.9       0   2e-15

Intel Xeon, 16 cores, load average 2.4; devices: 1 NVIDIA H100; jax 0.11.2
An H200 took 0.30, 3.8 and 5.4 (10 000 cases) µs a case.
"""

import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from batch_throughput import motions
from bench import benchmark, relative, shuffled, timed, verdict
from load_solve_throughput import middle_loads

import bearingjax as bj

CHUNK = 64
COUNTS = {
    "force and stiffness": (1_000, 10_000, 100_000, 1_000_000),
    "load solve": (1_000, 10_000, 100_000),
    "gradient of a load solve": (1_000, 10_000, 100_000),
}
SMOKE = 70
CHECKED = 1_000
AGREEMENT = 1e-8


def bearing():
    return bj.CylindricalRollerBearing(
        14, 0.065, 0.010, 0.010,
        radial_internal_clearance=10e-6, roller_profile=bj.CircularCrown(3.0),
    )  # fmt: skip


def force_and_stiffness(q):
    e = bj.BearingElement(bearing()).evaluate(q)
    return jnp.concatenate([e.force, 1e-6 * e.stiffness.reshape(-1)])


def displacement(load):
    return bj.solve_load(bj.BearingElement(bearing()), load, throw=False).displacement


NUMBERS = (
    lambda b: b.radial_internal_clearance,
    lambda b: b.roller_length,
    lambda b: b.roller_profile.crown_radius,
)


def sag_and_gradient(load):
    def sag(values):
        changed = eqx.tree_at(lambda b: [g(b) for g in NUMBERS], bearing(), values)
        moved = bj.solve_load(bj.BearingElement(changed), load, throw=False)
        return jnp.linalg.norm(moved.displacement[6:8])

    value, slopes = jax.value_and_grad(sag)([g(bearing()) for g in NUMBERS])
    return jnp.stack([value, *slopes])


QUESTIONS = {
    "force and stiffness": (force_and_stiffness, motions),
    "load solve": (displacement, lambda n: middle_loads(n, arm=1e-3)),
    "gradient of a load solve": (sag_and_gradient, lambda n: middle_loads(n, arm=1e-3)),
}


def program(function, device):
    """Many cases on a device, and seconds of compiling for a number of them."""
    if device.platform == "cpu":
        many = jax.jit(lambda given: jax.lax.map(function, given, batch_size=CHUNK))
    else:
        many = jax.jit(jax.vmap(function))
    return lambda given: many(jax.device_put(given, device))


def study(name, devices, counts, until):
    """Rows of a question: batches on every device."""
    function, make = QUESTIONS[name]
    want = None
    for device in devices:
        many = program(function, device)
        for count in counts:
            if time.monotonic() > until and count != counts[0]:
                break
            if device.platform == "cpu" and count > max(10_000, counts[0]):
                continue
            given = make(count)
            first, out = timed(lambda many=many, given=given: many(given))
            calls = {name: lambda many=many, given=given: many(given)}
            seconds = float(np.median(shuffled(calls, 3, warm=False)[name]))
            few = np.asarray(many(make(min(CHECKED, counts[0]))))
            want = few if want is None else want
            yield {
                "question": name,
                "device": device.platform,
                "cases": count,
                "us": 1e6 * seconds / count,
                "compile_s": first - seconds,
                "failed": int(np.sum(~np.isfinite(np.asarray(out)).all(axis=1))),
                "error": relative(few, want),
            }


@benchmark("one small batch each", device={"choices": ("cpu", "gpu")})
def main(smoke, device="cpu", seconds=1e9):
    if device == "gpu":
        jax.config.update("jax_platforms", "cuda,cpu")
    until = time.monotonic() + seconds
    devices = [jax.devices("cpu")[0]]
    devices += [jax.devices()[0]] if device == "gpu" else []
    print(
        f"{'':26}{'device':>7}{'cases':>9}{'µs/case':>10}{'compile, s':>12}"
        f"{'failed':>8}{'error':>8}"
    )
    worst = 0.0
    for name in QUESTIONS:
        for row in study(name, devices, (SMOKE,) if smoke else COUNTS[name], until):
            worst = max(worst, row["error"])
            print(
                f"{row['question']:26}{row['device']:>7}{row['cases']:9d}"
                f"{row['us']:10.2f}{row['compile_s']:12.1f}{row['failed']:8d}"
                f"{row['error']:8.0e}",
                flush=True,
            )
    print(verdict("difference between the devices", worst, AGREEMENT))
    return worst <= AGREEMENT

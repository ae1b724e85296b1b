"""One process of a sweep: `python sweep_in_process.py OUT DEVICES PORT COUNT RANK`.

Run by test_sweep.py, to see a sweep over several processes of several devices.
"""

import sys

import jax

jax.config.update("jax_enable_x64", True)

import numpy as np  # noqa: E402

import bearingjax as bj  # noqa: E402


def small_element():
    """Six rollers with eight slices: quick to compile."""
    bearing = bj.CylindricalRollerBearing(
        6, 0.065, 0.010, 0.010, radial_internal_clearance=25e-6
    )
    return bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(8))


def loads(count=50):
    """Loads (count, 6) [N, N m]; number 5 is NaN, number 7 nothing can carry."""
    out = np.zeros((count, 6))
    out[:, 1] = -np.linspace(100.0, 5000.0, count)
    out[:, 3] = 1e-3 * out[:, 1]
    out[5] = np.nan
    out[7, 2] = 100.0
    return out


def main(out, devices, port, count, rank):
    jax.config.update("jax_num_cpu_devices", int(devices))
    jax.distributed.initialize(f"127.0.0.1:{port}", int(count), int(rank))
    solved = bj.sweep(
        small_element(),
        loads(),
        outputs=["displacement"],
        batches=bj.cases.Batches(chunk=4),
    )
    np.savez(
        out,
        devices=len(jax.devices()),
        displacement=solved.displacement,
        result=solved.result,
    )


if __name__ == "__main__":
    main(*sys.argv[1:])

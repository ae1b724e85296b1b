"""How much does the cage of a ball bearing slip, over axial load and speed?

The bearing of Han & Chu, 25 axial loads of 20 to 600 N times 40 speeds of 500 to 12 000
rpm: 1000 end states in one call of `skid.steady` under `jax.vmap`, load solves
included. Beside it points solved alone, and how far both differ. Under a radial load
too, of two thirds of the axial one, 96 places along the orbit: 5 x 8 points.

Slip counts against outer raceway control at the operating contact angles. It is below
zero where balls orbit faster than that.

LAPACK's threads wait for each other where others use the cores: the combined map then
takes up to 60 times as long, and OPENBLAS_NUM_THREADS=1 cures it. So it was run here.

README: 1000 end states in 7.9 s; 40 under both loads in 3.4 s; none fails | time stated
| yes

Last run:

axial: 1000 points, first 74.9 s, again 7858 ms, 7858 us a point; alone 17054 us; not
solved 0; slip -1.565 to 73.2 %; together and alone differ by 2e-15
combined: 40 points, first 65.1 s, again 3406 ms, 85140 us a point; alone 98026 us; not
solved 0; slip 0.044 to 10.0 %; together and alone differ by 1e-15
AMD EPYC, 2 cores, load average 3.3; devices: 1 cpu; jax 0.10.1

Contact loads follow the orbit that is found since then: before, with loads of pure
rolling, the axial map took 0.9 s on a faster machine.
"""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, subplots, timed
from han_chu import FREE, MODEL

from bearingjax import Speed, Support, skid

RADIAL = 2.0 / 3.0


def end_state(places, share, load, speed):
    """Mean slip, friction torque, result of one point."""
    force = jnp.zeros(6).at[0].set(share * load).at[2].set(load)
    found = skid.steady(
        MODEL,
        force,
        speed=Speed(inner=speed),
        support=Support(free=FREE),
        places=places,
        throw=False,
    )
    slip = 1.0 - found.cage_speed / jnp.mean(found.rolling_orbit_speed)
    return slip, found.friction_torque, found.result


@eqx.filter_jit
def together(places, share, loads, speeds):
    """All points in one call."""
    return jax.vmap(partial(end_state, places, share))(loads, speeds)


def grid(loads, speeds):
    """All pairs, one after the other."""
    pairs = np.meshgrid(loads, np.asarray(speeds) * np.pi / 30.0, indexing="ij")
    return tuple(jnp.asarray(p.ravel()) for p in pairs)


def draw(_, loads, speeds, slip):
    """The map."""
    from matplotlib.colors import BoundaryNorm

    figure, axes = subplots(figsize=(6.4, 4.4), layout="constrained")
    percent = 100.0 * slip.reshape(len(loads), len(speeds))
    levels = [-2.0, -1.0, -0.5, 0.0, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
    norm = BoundaryNorm(levels, 256)
    drawn = axes.pcolormesh(speeds, loads, percent, norm=norm, shading="gouraud")
    lines = axes.contour(speeds, loads, percent, [1.0, 10.0], colors="white")
    axes.clabel(lines, fmt=lambda value: f"{value:g} %")
    figure.colorbar(drawn, label="slip of the cage, %")
    axes.set(xlabel="speed of the inner ring, rpm", ylabel="axial load, N")
    return figure


def run(name, places, share, loads, speeds, alone):
    """Time of a map, and of points of it alone; returns the slips."""
    points = grid(loads, speeds)
    given = places, share
    first, _ = timed(lambda: together(*given, *points))
    again, (slip, torque, result) = timed(lambda: together(*given, *points))
    count = slip.shape[0]
    failed = int(np.sum(np.asarray(result) != 0))
    assert np.all(np.isfinite(np.asarray(slip)[np.asarray(result) == 0]))
    single = jax.jit(partial(end_state, *given))
    picked = np.linspace(0, count - 1, alone).astype(int)
    jax.block_until_ready(single(*(p[0] for p in points)))
    seconds, worst = 0.0, 0.0
    for k in picked:
        one, found = timed(lambda k=k: single(*(p[k] for p in points)))
        seconds += one
        if not int(result[k]):
            worst = max(worst, abs(float(found[0] - slip[k])))
    print(
        f"{name}: {count} points, first {first:.1f} s, again {1e3 * again:.0f} ms,"
        f" {1e6 * again / count:.0f} us a point; alone {1e6 * seconds / alone:.0f} us;"
        f" not solved {failed}; slip {100 * float(jnp.nanmin(slip)):.3f} to"
        f" {100 * float(jnp.nanmax(slip)):.1f} %; together and alone differ by"
        f" {worst:.0e}",
        flush=True,
    )
    return np.asarray(slip)


@benchmark("a few points", plot=draw)
@benchmark("a few points", plot=draw)
def main(smoke):
    loads, speeds = np.linspace(20.0, 600.0, 25), np.linspace(500.0, 12e3, 40)
    if smoke:
        loads, speeds = loads[::12], speeds[::20]
    slip = run("axial", 1, 0.0, loads, speeds, 2 if smoke else 50)
    if not smoke:
        run("combined", 96, RADIAL, loads[4::5], speeds[::5], 5)
    return None, loads, speeds, slip

"""Does every run of skidding end, or say why not?

300 runs of `skid.simulate`: five balls with a cage, designs, oil temperatures of -40 to
200 °C, drag up to an immersed bearing, pockets without clearance, from still stand or
rolling, ramps of up to 3 million mm/min (D_m n) in 0.1 s, constant loads of 0 to 5 kN
with radial parts, and loads that drop to nothing and come back, balanced at every time.
Every third run takes another law of traction, or next to no oil. A run fails if its
result code is that of a failure; it is wrong if it converged with NaN in it, if its
power balance is out by more than the tolerance, 1e-4 of the work or of the kinetic
energy of balls that roll at the fastest speed, or if numbers follow on a time that was
not reached.

README: 300 runs: 260 end, 34 need more than 5000 steps, 6 say that no step is small
enough; none wrong | none wrong | yes

Last run:

300 runs in 5961 s (others used the machine): 260 converged, 34 step_limit, 6
non_finite; wrong: none
AMD EPYC, 2 cores, load average 5.9; devices: 1 cpu; jax 0.10.1

The 34 need more than 5000 steps, 23 of them with the ring balanced at every time. The 6
are Newtonian films of oils that pressure has made a glass, where no step is small
enough.
"""

import collections
import time

import numpy as np
from bench import benchmark

import bearingjax as bj
from bearingjax import skid
from bearingjax.lubrication import Eyring, LimitingStress, Newtonian, mil_l_23699
from bearingjax.numerics import Result
from bearingjax.skid import Cage, Drag, LoadHistory, SkidModel, SpeedTable

BALLS = 5
FREE = ["ux", "uy", "uz", "gx", "gy"]
KINDS = ("constant", "balanced")


def model(rng, traction):
    """A random bearing, its oil and cage."""
    diameter = rng.uniform(0.006, 0.02)
    pitch = diameter * rng.uniform(3.0, 6.0)
    bearing = bj.AngularContactBallBearing(
        BALLS,
        pitch,
        diameter,
        outer_osculation=rng.uniform(0.51, 0.54),
        inner_osculation=rng.uniform(0.51, 0.54),
        contact_angle=np.radians(rng.uniform(12.0, 40.0)),
        material=bj.Material(206e9, 0.3, 7850.0),
    )
    fill = rng.choice([0.0, 0.05, 0.2, 1.0])
    mass = np.pi / 6.0 * 7850.0 * diameter**3
    return SkidModel(
        bj.BearingElement(bearing),
        mil_l_23699(),
        273.15 + rng.choice([-40.0, 0.0, 30.0, 100.0, 200.0]),
        traction=traction,
        drag=Drag(fill=fill),
        cage=Cage(
            pocket_clearance=rng.choice([0.0, 1e-4, 1e-3]),
            stiffness=10.0 ** rng.uniform(5.0, 7.0),
            inertia=mass * pitch**2 * rng.uniform(0.1, 1.0),
        ),
        least_film=10.0 ** rng.uniform(-9.0, -7.0),
    )


def load_of(rng, size):
    """A load with a path: axial, and less across."""
    axial = size * 10.0 ** rng.uniform(-3.0, 0.0)
    across = rng.choice([0.0, 0.3, 0.9]) * axial
    force = np.array([across, 0.0, axial, 0.0, 0.0, 0.0])
    return force * rng.choice([1.0, 1.0, 1.0, 0.0])


def given(rng, kind, pitch):
    """Load, speed, duration."""
    load, duration = load_of(rng, 5000.0), rng.choice([0.005, 0.02, 0.1])
    end = rng.choice([0.0, 10.0, 200.0, 2.0 * np.pi * 50.0 / pitch])  # 3e6 mm/min
    begin = end if rng.random() < 0.5 else 0.0
    speed = SpeedTable([0.0, 0.1], [begin, end])
    if kind == "balanced":
        knots = np.array([0.0, 0.3, 0.35, 0.6, 0.65]) * duration
        load = LoadHistory(knots, np.outer([1.0, 1.0, 0.0, 0.0, 1.0], load))
    return load, speed, duration


def judged(found, rolling):
    """Name the faults of a run; `rolling` is an energy to compare with."""
    code = Result(int(found.result))
    numbers = [found.cage_speed, found.slip, found.film, found.heat, found.power.drive]
    finite = np.all(
        [np.isfinite(n).reshape(len(n), -1).all(axis=1) for n in numbers], 0
    )
    if code is not Result.CONVERGED:
        gaps = np.any(np.diff(finite.astype(int)) > 0)
        return code.label, "numbers after a gap" if gaps else ""
    if not finite.all():
        return code.label, "NaN"
    work = found.work
    size = [work.drive, work.contacts, work.drag, found.kinetic_energy]
    size = max(rolling, np.max(np.abs(np.stack(size))))
    if size > 0 and np.max(np.abs(found.imbalance)) > 1e-4 * size + 1e-12:
        return code.label, f"power out by {np.max(np.abs(found.imbalance)) / size:.0e}"
    return code.label, ""


@benchmark("two")
def main(smoke, first=0, runs=300):
    runs = 2 if smoke else runs
    codes, wrong, begin = collections.Counter(), [], time.perf_counter()
    for k in range(first, first + runs):
        rng = np.random.default_rng(k)
        kind = KINDS[0] if smoke else KINDS[k % 2]
        laws = Newtonian(), LimitingStress(0.08), Eyring(5e6)
        one = model(rng, laws[0] if smoke else laws[k % 3])
        load, speed, duration = given(rng, kind, float(one.bearing.pitch_diameter))
        found = skid.simulate(
            one,
            load,
            speed=speed,
            times=duration * np.linspace(0.0, 1.0, 21),
            support=bj.Support(free=FREE),
            options=skid.SkidOptions(
                1e-4, 5_000, places=None if kind == "balanced" else 48
            ),
            throw=False,
        )
        pitch = 0.4 * float(one.bearing.pitch_diameter) * np.abs(speed.inner).max()
        mass = np.pi / 6.0 * 7850.0 * float(one.bearing.ball_diameter) ** 3
        label, fault = judged(found, 0.5 * BALLS * mass * (0.5 * pitch) ** 2)
        codes[label] += 1
        if label != "converged" or fault:
            print(f"run {k}, {kind}: {label} after {int(found.steps)} steps; {fault}")
            wrong += [k] if fault else []
    count = ", ".join(f"{n} {label}" for label, n in codes.most_common())
    seconds = time.perf_counter() - begin
    print(f"{runs} runs in {seconds:.0f} s: {count}; wrong: {wrong or 'none'}")
    return not wrong

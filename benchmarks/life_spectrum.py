"""How many cases of a load spectrum become a life in a second?

A 6305 deep groove ball bearing under 10 000 random cases: radial load of 0.5 to 4 kN in
any direction, axial load of -1 to 1 kN, tilts up to 0.5 mrad, each with its hours. One
call of `bj.sweep` solves the cases (ux, uy, uz) and takes their reference rating lives
by ISO/TS 16281, with all warnings, and `bj.spectrum_life` adds up the damage; "load
solve" is the same sweep without lives. The gradient is that of the life with respect to
every real number of the design, in reverse mode, batch by batch, at the displacements
that the sweep found; beside it the difference along the clearance (some of 10 000 cases
open or close a contact at any step: eight cases alone agree to 5e-9).

Beside it on the same core a loop that an engineer would write: `scipy.optimize.root` on
a NumPy bearing of the same equations (balls in series contact, L10r in NumPy), started
at a radial displacement. It runs a part of the cases; its cases a second are those of
that part, and its time for all of them is extrapolated.

README: 6305, 10 000 cases in a call: 4200 a second, as many as load solves alone; 2800
with the gradient; SciPy's root on NumPy 460 |  |

Last run:

                   cases  cases/s  all cases, s  ratio
load solve         10000     4133          2.42   1.02
life               10000     4200          2.38      1
life and gradient  10000     2821          3.55   1.49
SciPy loop           100      460          21.7   9.13 (extrapolated)

life 664.815 million revolutions; trace and compile 30.2 s, with the gradient 93.6 s
SciPy: 0 failed; its damage within 3.3e-11 of ours
slope along the clearance within 1.9e-06 of differences

one core; AMD EPYC, 2 cores, load average 1.5; devices: 1 cpu; jax 0.10.1
"""

import os

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, compiled, shuffled, table, timed
from scipy.optimize import root

import bearingjax as bj
from bearingjax.cases import solve_case

CAPACITY = 23400.0
CONDITIONS = bj.LifeConditions(dynamic_capacity=CAPACITY)
FULL = {"cases": 10_000, "batch": 500, "loop": 100, "rounds": 3, "gradient": True}
SMOKE = {"cases": 8, "batch": 4, "loop": 2, "rounds": 1, "gradient": False}


def bearing(clearance=10e-6):
    return bj.DeepGrooveBallBearing(
        7, 43.5e-3, 11.5e-3,
        outer_osculation=0.53, inner_osculation=0.52,
        radial_internal_clearance=clearance,
    )  # fmt: skip


def spectrum(count):
    """Random cases."""
    rng = np.random.default_rng(0)
    size, angle = rng.uniform(500.0, 4e3, count), rng.uniform(0, 2 * np.pi, count)
    load = np.zeros((count, 6))
    load[:, 0], load[:, 1] = size * np.cos(angle), size * np.sin(angle)
    load[:, 2] = rng.uniform(-1e3, 1e3, count)
    tilts = {name: rng.uniform(-5e-4, 5e-4, count) for name in ("gx", "gy")}
    return bj.Cases(load, prescribed=tilts, hours=rng.uniform(0.1, 10.0, count))


def swept(design, cases, outputs=("damage", "displacement")):
    """The cases, each started from the nearest one that is solved by then."""
    return bj.sweep(
        bj.BearingElement(design),
        cases,
        outputs=outputs,
        life=CONDITIONS if "damage" in outputs else None,
        batches=bj.cases.Batches(devices=jax.devices()[:1]),
    )


def damage_of(element, case, start):
    """Part of the life that a revolution of one case uses."""
    solution = solve_case(element, case, start=start)
    return bj.rating_life(element, solution, conditions=CONDITIONS).damage


def gradient(numbers, structure, cases, starts, batch):
    """Gradient of the life; batch by batch, so that it needs the memory of one."""

    def used(numbers, cases, starts):
        element = bj.BearingElement(eqx.combine(numbers, structure))
        found = jax.vmap(lambda *given: damage_of(element, *given))(cases, starts)
        return jnp.sum(cases.hours * found)

    def of_batch(part):
        return jax.value_and_grad(used)(numbers, *part)

    parts = jax.tree.map(lambda a: a.reshape(-1, batch, *a.shape[1:]), (cases, starts))
    total, slopes = jax.tree.map(
        lambda a: jnp.sum(a, axis=0), jax.lax.map(of_batch, parts)
    )
    by_damage = -jnp.sum(cases.hours) / total**2
    return jax.tree.map(lambda slope: by_damage * slope, slopes)


class Plain:
    """The same bearing in NumPy: contacts of a ball in series, one constant."""

    def __init__(self, design):
        self.z = design.n_balls
        self.d, self.dm = float(design.ball_diameter), float(design.pitch_diameter)
        f = float(design.outer_osculation), float(design.inner_osculation)
        self.re, self.ri = f[0] * self.d, f[1] * self.d
        self.a = self.re + self.ri - self.d
        self.play = float(design.radial_internal_clearance)
        self.angle = 2 * np.pi * np.arange(self.z) / self.z
        self.constant = 1.0

    def balls(self, moved, tilts):
        """Compression and direction of every ball, of the centres of the grooves.

        The inner groove centre stands off the pitch circle, at the lever of its tilt.
        """
        c, s = np.cos(self.angle), np.sin(self.angle)
        share = 1.0 - 0.5 * self.play / self.a
        lever = 0.5 * self.dm + share * (self.ri - 0.5 * self.d)
        tilt = tilts[0] * s - tilts[1] * c
        radial = share * self.a + moved[0] * c + moved[1] * s
        axial = moved[2] + lever * tilt
        length = np.hypot(radial, axial)
        return np.maximum(length - self.a, 0.0), radial / length, axial / length

    def force(self, moved, tilts):
        """On the inner ring, from outside."""
        depth, radial, axial = self.balls(moved, tilts)
        load = self.constant * depth**1.5
        c, s = np.cos(self.angle), np.sin(self.angle)
        parts = (load * radial * c, load * radial * s, load * axial)
        return np.array([part.sum() for part in parts])

    def damage(self, loads):
        """Part of the reference life that a revolution uses."""
        g = self.d / self.dm
        less = [2 * r - self.d for r in (self.re, self.ri)]
        ratio = 1.044 * ((1 - g) / (1 + g)) ** 1.72
        ratio *= (self.ri / self.re * less[0] / less[1]) ** 0.41
        qi = CAPACITY / (0.407 * self.z) * (1 + ratio ** (10 / 3)) ** 0.3
        qe = CAPACITY / (0.389 * self.z) * (1 + ratio ** (-10 / 3)) ** 0.3
        inner, outer = np.mean(loads**3) ** (1 / 3), np.mean(loads ** (10 / 3)) ** 0.3
        return ((inner / qi) ** (10 / 3) + (outer / qe) ** (10 / 3)) ** 0.9 / 1e6

    def calibrate(self, solution):
        """The constant of two contacts in series, from a ball of our own solution."""
        q = np.asarray(solution.displacement)
        depth, *_ = self.balls(q[6:9], q[9:11])
        most = int(np.argmax(depth))
        load = float(solution.roller_load[most, 1])
        self.constant = load / depth[most] ** 1.5

    def case(self, load, tilts):
        """Damage of a case, and whether SciPy says that it is solved."""
        start = 1e-5 * load[:3] / np.hypot(*load[:2])
        start = start * (1.0 + 0.5 * self.play / 1e-5)
        found = root(lambda x: self.force(x, tilts) - load[:3], start, tol=1e-11)
        depth, *_ = self.balls(found.x, tilts)
        return self.damage(self.constant * depth**1.5), found.success


def loop(plain, cases, count):
    """Damage of the first cases, one after the other; NaN where SciPy fails."""
    out = np.full(count, np.nan)
    for k in range(count):
        tilts = [float(cases.prescribed[name][k]) for name in ("gx", "gy")]
        value, solved = plain.case(np.asarray(cases.load[k]), tilts)
        if solved:
            out[k] = value
    return out


def study(sizes):
    cases, design = spectrum(sizes["cases"]), bearing()
    numbers, structure = eqx.partition(design, eqx.is_inexact_array)
    on_device = jax.tree.map(jnp.asarray, cases)

    def value(x):
        found = swept(eqx.combine(x, structure), cases)
        return float(bj.spectrum_life(cases, found.damage).rating_life), found

    calls = {
        "load solve": lambda: swept(design, cases, ("displacement",)).displacement,
        "life": lambda: value(numbers)[0],
    }
    first, _ = timed(calls["life"])
    again, (life, solved) = timed(lambda: value(numbers))
    compile_s, slope = [first - again], None
    if sizes["gradient"]:

        def whole(x, cases, starts):
            return gradient(x, structure, cases, starts, sizes["batch"])

        starts = solved.displacement[:, 6:]
        slopes, slopes_s = compiled(whole, numbers, on_device, starts)

        def both():
            life, solved = value(numbers)
            return life, slopes(numbers, on_device, solved.displacement[:, 6:])

        calls["life and gradient"] = both
        compile_s.append(compile_s[0] + slopes_s)
        slope = slope_error(lambda x: value(x)[0], both()[1], numbers)
    element = bj.BearingElement(design)
    single = jax.tree.map(lambda a: a[0], on_device)
    plain = Plain(design)
    plain.calibrate(jax.jit(lambda case: solve_case(element, case))(single))
    calls["SciPy loop"] = lambda: loop(plain, cases, sizes["loop"])
    times = {
        name: float(np.median(t))
        for name, t in shuffled(calls, sizes["rounds"]).items()
    }
    part = jax.tree.map(lambda a: a[: sizes["loop"]], on_device)
    ours = jax.jit(jax.vmap(lambda c: damage_of(element, c, None)))(part)
    theirs = loop(plain, cases, sizes["loop"])
    solved = np.isfinite(theirs)
    counts = {name: sizes["cases"] for name in calls} | {"SciPy loop": sizes["loop"]}
    return {
        "rows": [row(name, counts[name], t, times, sizes) for name, t in times.items()],
        "compile_s": compile_s,
        "failed": int((~solved).sum()),
        "error": float(np.max(np.abs(theirs / ours - 1.0)[solved], initial=0.0)),
        "gradient_error": slope,
        "life": life,
    }


def row(name, count, seconds, times, sizes):
    each = seconds / count
    return {
        "name": name,
        "cases": count,
        "cases_per_s": 1.0 / each,
        "all_s": each * sizes["cases"],
        "ratio": each / (times["life"] / sizes["cases"]),
    }


def slope_error(value, gradient, numbers):
    """Gradient with respect to the clearance against differences of fourth order."""
    exact = float(gradient.radial_internal_clearance)

    def at(step):
        play = numbers.radial_internal_clearance + step
        changed = eqx.tree_at(lambda b: b.radial_internal_clearance, numbers, play)
        return value(changed)

    least = np.inf
    for h in (1e-6, 3e-7, 1e-7, 3e-8):
        f = [at(k * h) for k in (-2, -1, 1, 2)]
        slope = (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h)
        least = min(least, abs(slope / exact - 1.0))
    return least


def show(found):
    print("SciPy loop: extrapolated to all cases")
    table(found["rows"], {
        "": "{name}", "cases": "{cases:d}", "cases/s": "{cases_per_s:.0f}",
        "all cases, s": "{all_s:.3g}", "ratio": "{ratio:.3g}",
    })  # fmt: skip
    seconds = ", with the gradient ".join(f"{t:.3g} s" for t in found["compile_s"])
    print(
        f"\nlife {found['life'] / 1e6:.6g} million revolutions; trace and compile"
        f" {seconds}\nSciPy: {found['failed']} failed; its damage within"
        f" {found['error']:.1e} of ours"
    )
    if found["gradient_error"] is not None:
        print(f"slope along the clearance within {found['gradient_error']:.1e}")


@benchmark("few cases", show)
def main(smoke):
    # Before JAX starts its threads: one core for everyone.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    return study(SMOKE if smoke else FULL)

"""What do shooting and harmonic balance find of a rotor on preloaded ball bearings?

The rotor of Filipkovskii & Belomyttsev (2014) on two opposed bearings with contact
angles of 12 to 40 degrees, preloads as the printed geometry implies. Excitation and
damping of the paper are lost: here the base shakes along y with an amplitude of 3 m/s²
(5 m/s² where five freedoms are drawn), and every mode at rest has a damping ratio of
1 %. Law of fixed contact angle with balls that lift off.

Agreement: every point of a branch by harmonic balance is the start of a shooting solve
in the plane across the branch; largest difference of the five amplitudes, relative to
the largest of them, and of the frequency. Folds and Neimark-Sacker points are located
by both methods on their own. Time: 200 points of a branch with their multipliers,
beside SciPy (`solve_ivp` DOP853 with rtol 1e-8 and `fsolve`), forces in NumPy for all
balls at once, each orbit from its neighbour; fewer orbits are timed and scaled.

README: both methods within 2.3e-5 in amplitude, 1.4e-6 at folds; 14 and 84 times faster
than SciPy | 1e-4; 1e-3; 10 and 50 times | yes

Last run:

angle  natural   peak of y at B      z     points  unstable  residual
 12 deg   707.6   707.3 Hz   1.794   0.033 um    51       11    1e-10  limit
 15 deg   703.6   704.2 Hz   1.820   0.039 um    46        9    8e-11  limit
 26 deg   676.1   680.5 Hz   1.994   0.054 um    57        7    8e-11  limit
 36 deg   636.6   643.6 Hz   2.281   0.078 um    66        3    9e-11  limit
 40 deg   614.7   622.3 Hz   2.460   0.102 um    71        0    9e-11  limit
 36 deg   636.6   625.3 Hz   3.579   0.388 um   109       41    1e-10  limit  (5 m/s²)

marked points [Hz]: harmonic balance | shooting
 12 deg fold            660.38 672.28 706.04 706.93 | 660.38 672.28 706.04 706.93
 15 deg fold            659.30 668.95 703.03 703.49 | 659.30 668.95 703.03 703.49
 26 deg fold            641.65 644.45 | 641.65 644.45
 36 deg fold            608.91 608.99 | 608.91 608.99
 36 deg fold            579.58 602.17 624.52 632.55 | 579.58 602.17 624.53 632.55
 36 deg neimark_sacker  596.82 611.93 | 596.82 611.92

 12 deg: 40 of 40 points: amplitudes apart 9.2e-06, frequency 7.5e-07; fold 6.9e-07
 15 deg: 40 of 40 points: amplitudes apart 7.6e-06, frequency 7.0e-07; fold 3.7e-07
 26 deg: 40 of 40 points: amplitudes apart 2.0e-07, frequency 2.5e-08; fold 3.3e-12
 36 deg: 40 of 40 points: amplitudes apart 1.4e-09, frequency 4.4e-11; fold 2.5e-11
 40 deg: 40 of 40 points: amplitudes apart 2.4e-09, frequency 4.1e-11;
 36 deg: 40 of 40 points: amplitudes apart 2.3e-05, frequency 2.5e-06; fold 1.4e-06,
 neimark_sacker 1.4e-05
amplitudes of both methods apart: 2.27e-05 (at most 0.0001): met
folds apart: 1.42e-06 (at most 0.001): met

a point of a branch, ms: harmonic balance 0.58 (187 points), shooting 3.58 (187),
 SciPy 49; states apart 5e-08
SciPy's time over that of shooting: 13.6 (at least 10): met
over that of harmonic balance: 84.3 (at least 50): met
error of the amplitudes, no ball lifts off: 3 harmonics 2e-09, 5 harmonics 2e-11,
 7 harmonics 2e-11, 11 harmonics 2e-11, 15 harmonics 2e-11, 24 steps 2e-11,
 48 steps 4e-13, 96 steps 6e-13, 192 steps 2e-13
error of the amplitudes, balls lift off: 3 harmonics 2e-04, 5 harmonics 3e-04,
 7 harmonics 8e-06, 11 harmonics 2e-05, 15 harmonics 5e-06, 24 steps 1e-05,
 48 steps 8e-05, 96 steps 4e-06, 192 steps 1e-06
AMD EPYC, 2 cores, load average 8.1; devices: 1 cpu; jax 0.10.1

On a busy machine earlier runs gave 7 to 33 for shooting and 36 to 173 for harmonic
balance. Each angle shows two peaks, of backward and forward whirl, as the rotor turns
with the excitation; they bend to lower frequencies where the balls' force softens,
unstable parts begin and end at folds and Neimark-Sacker points, and x and z take part
in what shakes along y.
"""

import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shades, subplots, verdict
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from vibrations import grooves, rotor

from bearingjax.rotor.nonlinear import (
    HarmonicBalance,
    Shooting,
    Steps,
    follow,
    solve_orbit,
)
from bearingjax.rotor.nonlinear.continuation import place
from bearingjax.rotor.nonlinear.orbit import amplitudes

ANGLES = (12, 15, 26, 36, 40)
NAMES = ("x at A", "y at A", "x at B", "y at B", "z")
DAMPING = 0.01
SHAKEN, SHAKEN_MORE = 3.0, 5.0
RANGE = 1.06, 0.75
"""Frequencies, of the first natural one at rest."""


def branch_of(angle, acceleration, method, points):
    system = rotor(angle, damping_ratio=DAMPING, base_acceleration=acceleration)
    unit = float(system.reference_frequency)
    given = {"steps": Steps(largest=0.06, points=points)}
    return system, follow(system, RANGE[0] * unit, RANGE[1] * unit, method, **given)


@eqx.filter_jit
def beside(system, balance, shooting, z, ratio):
    """Shooting solutions across a branch by harmonic balance."""
    motions = jax.vmap(lambda z, r: balance.motion(system, z, r))(z, ratio)
    x = jnp.concatenate([jax.vmap(shooting.unknowns)(motions), ratio[:, None]], axis=1)
    secant = jnp.concatenate([x[1:2] - x[:1], x[2:] - x[:-2], x[-1:] - x[-2:-1]])
    secant = secant / jnp.linalg.norm(secant, axis=1, keepdims=True)

    def one(given):
        x, secant, motion = given
        found, result = place(system, shooting, x, secant, secant, 20)
        ours, theirs = amplitudes(motion), amplitudes(found.motion)
        apart = jnp.max(jnp.abs(ours - theirs)) / jnp.max(theirs)
        return apart, jnp.abs(found.x[-1] / x[-1] - 1.0), result

    return jax.lax.map(one, (x, secant, motions[0]))


def agreement(system, branch, balance, shooting, points):
    every = np.linspace(0, len(branch.frequency) - 1, points).astype(int)
    ratio = branch.frequency / float(system.reference_frequency)
    given = jnp.asarray(branch.unknowns[every]), jnp.asarray(ratio[every])
    apart, frequency, result = beside(system, balance, shooting, *given)
    solved = np.asarray(result) == 0
    return {
        "amplitude": float(np.asarray(apart)[solved].max()),
        "frequency": float(np.asarray(frequency)[solved].max()),
        "solved": int(solved.sum()),
        "points": len(every),
    }


def events(branch):
    return [(e.kind, e.frequency / (2.0 * np.pi)) for e in branch.events]


def described(system, branch):
    unit = float(system.reference_frequency)
    at = branch.amplitude[:, 3].argmax()
    return {
        "natural": unit / (2.0 * np.pi),
        "peak": float(branch.frequency[at] / (2.0 * np.pi)),
        "amplitude": float(branch.amplitude[at, 3]),
        "axial": float(branch.amplitude[:, 4].max()),
        "points": len(branch.frequency),
        "unstable": int((~branch.stable).sum()),
        "residual": float(branch.residual.max()),
        "ending": branch.ending.label,
        "events": events(branch),
    }


def in_numpy(system, angle):
    """Rates of the state, as one would write them with NumPy."""
    law = grooves(angle).fixed_angle()
    constant, z0 = float(law.constant), float(law.preload_displacement)
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    azimuth = 2.0 * np.pi * np.arange(7) / 7
    side, up = cosine * np.cos(azimuth), cosine * np.sin(azimuth)
    mass, damping = np.asarray(system.mass), np.asarray(system.damping)
    gyroscopic, inverse = np.asarray(system.gyroscopic), np.linalg.inv(mass)
    along = mass @ np.array([0.0, 1.0, 0.0, 1.0, 0.0])

    def bearing(x, y, z):
        load = constant * np.maximum(x * side + y * up + (z + z0) * sine, 0.0) ** 1.5
        return load @ side, load @ up, sine * load.sum()

    def rates(t, y, w):
        q, v = y[:5], y[5:]
        ax, ay, az = bearing(q[0], q[1], q[4])
        bx, by, bz = bearing(q[2], q[3], -q[4])
        force = np.array([ax, ay, bx, by, az - bz]) + (damping + w * gyroscopic) @ v
        return np.concatenate([v, -inverse @ (force + SHAKEN * np.cos(w * t) * along)])

    return rates


def by_scipy(system, angle, frequencies, start, scale):
    """Orbits, each from the one before; seconds, and the states at phase 0."""
    rates, y, found = in_numpy(system, angle), np.array(start), []
    begun = time.perf_counter()
    for w in frequencies:
        size = np.concatenate([np.full(5, scale), np.full(5, scale * w)])

        def apart(y, w=w, size=size):
            span = 0.0, 2.0 * np.pi / w
            tight = {"method": "DOP853", "rtol": 1e-8, "atol": 1e-8 * size}
            return (
                solve_ivp(rates, span, y * size, args=(w,), **tight).y[:, -1] / size - y
            )

        y = fsolve(apart, y, xtol=1e-8)
        found.append(y)
    return time.perf_counter() - begun, np.array(found)


def timed_branch(system, method, points, begin, end):
    """Seconds of a branch that is compiled, and its number of points."""
    unit = float(system.reference_frequency)
    seconds = []
    for _ in range(7):
        begun = time.perf_counter()
        branch = follow(
            system,
            begin * unit,
            end * unit,
            method,
            steps=Steps(largest=0.02, points=points),
            locate=False,
        )
        seconds.append(time.perf_counter() - begun)
    return min(seconds[1:]), branch


def speed(balance, shooting, points, by_them, precise, angle=36):
    system = rotor(angle, damping_ratio=DAMPING, base_acceleration=SHAKEN)
    scale = float(system.scale[0])
    row = {}
    for name, method in (("balance", balance), ("shooting", shooting)):
        seconds, branch = timed_branch(system, method, points, *RANGE)
        row[name] = 1e3 * seconds / len(branch.frequency)
        row[f"{name}_points"] = len(branch.frequency)
    # Theirs: the last points of that branch, all of them stable.
    last = branch.frequency[-by_them:]
    given = system, angle, last, branch.unknowns[-by_them], scale
    seconds, found = min((by_scipy(*given) for _ in range(2)), key=lambda one: one[0])
    row["scipy"] = 1e3 * seconds / by_them
    row["apart"] = float(np.abs(found - branch.unknowns[-by_them:]).max())
    if not precise:
        return row
    row["precision_closed"] = precision(system, branch, -1)
    more = rotor(angle, damping_ratio=DAMPING, base_acceleration=SHAKEN_MORE)
    _, branch = timed_branch(more, balance, 400, *RANGE)
    row["precision_open"] = precision(more, branch, branch.amplitude[:, 1].argmax())
    return row


def precision(system, branch, at):
    """Error of the amplitudes of a point, over harmonics and over steps."""
    given = branch.frequency[at], branch.displacement[at]

    def solved(method):
        return solve_orbit(system, given[0], method, given[1]).amplitude

    exact = solved(Shooting(1536))
    methods = [
        (f"{h} harmonics", HarmonicBalance(h, 16 * h)) for h in (3, 5, 7, 11, 15)
    ]
    methods += [(f"{n} steps", Shooting(n)) for n in (24, 48, 96, 192)]
    return [
        (name, float(jnp.max(jnp.abs(solved(one) - exact)) / jnp.max(exact)))
        for name, one in methods
    ]


def measure(angles, balance, shooting, points, compared, timing):
    rows, curves = [], {}
    for angle in angles:
        row = {"angle": angle}
        system, branch = branch_of(angle, SHAKEN, balance, points)
        row["balance"] = described(system, branch)
        row |= agreement(system, branch, balance, shooting, compared)
        _, other = branch_of(angle, SHAKEN, shooting, points)
        row["shooting"] = described(system, other)
        curves[angle] = branch
        rows.append(row)
    system, more = branch_of(36, SHAKEN_MORE, balance, points)
    row = {"angle": 36, "balance": described(system, more)}
    row |= agreement(system, more, balance, shooting, compared)
    row["shooting"] = described(system, branch_of(36, SHAKEN_MORE, shooting, points)[1])
    rows.append(row)
    return {"branches": rows, "speed": speed(*timing)}, curves, more


def matched(ours, theirs):
    """Largest relative difference of marked points by kind; infinite if unlike."""
    worst = {}
    for kind in {kind for kind, _ in ours + theirs}:
        a, b = (sorted(f for k, f in one if k == kind) for one in (ours, theirs))
        same = len(a) == len(b)
        worst[kind] = (
            max(abs(x / y - 1) for x, y in zip(a, b, strict=True)) if same else np.inf
        )
    return worst


def show(r, *_):
    print("angle  natural   peak of y at B      z     points  unstable  residual")
    for k, row in enumerate(r["branches"]):
        b = row["balance"]
        print(
            f"{row['angle']:3d} deg {b['natural']:7.1f} {b['peak']:7.1f} Hz"
            f" {1e6 * b['amplitude']:7.3f} {1e6 * b['axial']:7.3f} um {b['points']:5d}"
            f" {b['unstable']:8d}    {b['residual']:.0e}  {b['ending']}"
            + ("  (5 m/s²)" if k == len(r["branches"]) - 1 else "")
        )
    print("\nmarked points [Hz]: harmonic balance | shooting")
    for row in r["branches"]:
        ours, theirs = row["balance"]["events"], row["shooting"]["events"]
        for kind in sorted({kind for kind, _ in ours + theirs}):
            lists = (
                " ".join(
                    f"{f:.2f}" for k, f in sorted(one, key=lambda e: e[1]) if k == kind
                )
                for one in (ours, theirs)
            )
            print(f"{row['angle']:3d} deg {kind:15s} " + " | ".join(lists))
    print()
    for row in r["branches"]:
        unlike = matched(row["balance"]["events"], row["shooting"]["events"])
        apart = ", ".join(f"{kind} {x:.1e}" for kind, x in sorted(unlike.items()))
        print(
            f"{row['angle']:3d} deg: {row['solved']} of {row['points']} points:"
            f" amplitudes apart {row['amplitude']:.1e},"
            f" frequency {row['frequency']:.1e}; {apart}"
        )
    worst = max(row["amplitude"] for row in r["branches"])
    print(verdict("amplitudes of both methods apart", worst, 1e-4))
    every = [
        matched(x["balance"]["events"], x["shooting"]["events"]) for x in r["branches"]
    ]
    print(verdict("folds apart", max(x.get("fold", 0.0) for x in every), 1e-3))
    s = r["speed"]
    print(
        f"\na point of a branch, ms: harmonic balance {s['balance']:.2f}"
        f" ({s['balance_points']} points), shooting {s['shooting']:.2f}"
        f" ({s['shooting_points']}), SciPy {s['scipy']:.0f};"
        f" states apart {s['apart']:.0e}"
    )
    ratios = s["scipy"] / s["shooting"], s["scipy"] / s["balance"]
    print(verdict("SciPy's time over that of shooting", ratios[0], 10.0, most=False))
    print(verdict("over that of harmonic balance", ratios[1], 50.0, most=False))
    titles = ("closed", "no ball lifts off"), ("open", "balls lift off")
    for name, title in titles if "precision_open" in s else ():
        print(f"error of the amplitudes, {title}: ", end="")
        print(
            ", ".join(f"{label} {error:.0e}" for label, error in s[f"precision_{name}"])
        )


def draw(ax, branch, freedom, color, label):
    """A branch with its stable parts and marked points."""
    hertz, size = branch.frequency / (2 * np.pi), 1e6 * branch.amplitude[:, freedom]
    ax.plot(hertz, size, ":", color=color, lw=1.2)
    ax.plot(
        hertz, np.where(branch.stable, size, np.nan), color=color, lw=1.8, label=label
    )
    for event in branch.events:
        mark = {"fold": "o", "neimark_sacker": "s"}.get(event.kind, "^")
        at = event.frequency / (2 * np.pi), 1e6 * event.amplitude[freedom]
        ax.plot(*at, mark, color=color, ms=5, mfc="white")


def plot(_, curves, more):
    figure, axes = subplots(1, 2, figsize=(13, 5.2), layout="constrained", dpi=140)

    colors = shades(np.linspace(0.0, 0.85, len(curves)))
    for color, (angle, branch) in zip(colors, curves.items(), strict=True):
        draw(axes[0], branch, 3, color, f"{angle}°")
    for k, name in enumerate(NAMES):
        draw(axes[1], more, k, f"C{k}", name)
    axes[0].set_title("y at B over the contact angle, base 3 m/s²", loc="left")
    axes[1].set_title("36°, base 5 m/s²; ○ folds, □ Neimark-Sacker", loc="left")
    for ax in axes:
        ax.set_xlabel("frequency [Hz]; dotted: unstable")
        ax.set_ylabel("half of peak to peak [µm]")
        ax.legend(frameon=False, fontsize=9)
    return figure


@benchmark("one angle, few points", show, plot)
def main(smoke):
    if smoke:
        small = HarmonicBalance(3, 16, steps=16), Shooting(16)
        return measure((36,), *small, 30, 4, (*small, 30, 1, False))
    fine = HarmonicBalance(15, 192, steps=96), Shooting(192)
    timing = HarmonicBalance(5, 32, steps=24), Shooting(24), 200, 20, True
    return measure(ANGLES, *fine, 400, 40, timing)

"""Does the rotor of Filipkovskii & Belomyttsev behave as in their figures 3 to 6?

Their excitation and damping are lost. Here the base shakes along y with 5 m/s², every
mode at rest has a damping ratio of 1 %, and the rotor turns at the frequency of the
excitation. Law of fixed contact angle with balls that lift off, preloads as the printed
geometry implies. Figure 3: y at B for five contact angles; 4: all freedoms at 36
degrees, with folds (A) and Neimark-Sacker points (B, C); 5 and 6: motions over a period
at the two resonances of y at B.

Traits: the resonances bend to lower frequencies than the peaks of the linear response;
z, which is not shaken, grows with the square of a small shaking; unstable parts begin
and end at folds or Neimark-Sacker points; harmonic balance and shooting agree
(amplitudes 1e-4 where both are solved, folds 0.1 %).

README: both resonances bend 3 to 8 % below linear ones; methods within 6e-5, folds
4e-6; every change of stability marked | 1e-4; 0.1 %; none unmarked | yes

Last run:

angle  linear peaks  peaks of y at B  y B, z [um]  z grows  points, unstable, unmarked
 12  686.3  721.8   632.4  662.2    2.642   0.088 x^2.000 60 27 0 limit/limit
 15  682.5  717.7   630.1  661.4    2.696   0.113 x^2.000 66 28 0 limit/limit
 26  655.8  689.6   610.2  647.8    3.032   0.228 x^2.000 91 41 0 limit/limit
 36  617.5  649.3   585.6  625.3    3.579   0.388 x^2.000 109 41 0 limit/limit
 40  596.3  627.0   570.3  608.1    3.905   0.457 x^2.000 116 35 0 limit/limit

marked points [Hz], harmonic balance | shooting
 12 fold            608.57 661.70 663.16 694.49 | 608.57 661.71 663.16 694.49
 12 neimark_sacker  636.93 689.41 | 636.97 689.41
 15 fold            608.12 660.06 660.94 691.56 | 608.12 660.06 660.94 691.56
 15 neimark_sacker  634.77 685.97 | 634.74 685.97
 26 fold            596.92 636.56 647.23 667.94 | 596.92 636.56 647.23 667.94
 26 neimark_sacker  618.22 659.06 | 618.09 659.06
 36 fold            579.58 602.17 624.52 632.55 | 579.58 602.17 624.53 632.55
 36 neimark_sacker  596.82 611.93 | 596.82 611.92
 40 fold            566.37 582.50 607.29 612.02 | 566.37 582.50 607.29 612.02

 12: 40 of 40 points: amplitudes apart 4.8e-05, frequency 6.1e-06
 15: 40 of 40 points: amplitudes apart 6.0e-05, frequency 8.9e-06
 26: 40 of 40 points: amplitudes apart 3.6e-05, frequency 4.5e-06
 36: 40 of 40 points: amplitudes apart 2.3e-05, frequency 2.5e-06
 40: 40 of 40 points: amplitudes apart 3.8e-06, frequency 6.1e-07
amplitudes of both methods apart: 6e-05 (at most 0.0001): met
folds apart: 4.2e-06 (at most 0.001): met
highest shift of a peak from the linear one: -0.0302 (at most 0): met
changes unmarked: 0 (at most 0): met
order of z off two: 5.47e-07 (at most 0.001): met
AMD EPYC, 2 cores, load average 6.6; devices: 1 cpu; jax 0.10.1

Both resonances bend 3 to 8 % below those of the linear response; stability changes at
marked points only, at 40 degrees at a point 1e-9 from its fold.
"""

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shades, subplots, verdict
from rotor_response import (
    ANGLES,
    DAMPING,
    NAMES,
    agreement,
    branch_of,
    draw,
    events,
    matched,
)
from vibrations import rotor

from bearingjax.rotor.nonlinear import HarmonicBalance, Shooting, solve_orbit

SHAKEN, SHOWN, AT = 5.0, 36, 3
"""Acceleration of the base [m/s²], the contact angle of figure 4, y at B."""


def peaks(size):
    """Indices of the largest two local maxima along a branch."""
    top = np.nonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:]))[0] + 1
    return sorted(top[np.argsort(size[top])[::-1][:2]])


def linear_peaks(angle):
    """Frequencies of the largest two peaks of the linear response of y at B [rad/s]."""
    system = rotor(angle, damping_ratio=DAMPING)
    mass = np.asarray(system.mass)
    none, unit = jnp.zeros(5), float(system.reference_frequency)
    stiffness = np.asarray(jax.jacfwd(lambda q: system.restoring(q, q, 0.0, 0.0))(none))
    damping, gyroscopic = np.asarray(system.damping), np.asarray(system.gyroscopic)
    load = -SHAKEN * mass @ np.array([0.0, 1.0, 0.0, 1.0, 0.0])
    w = unit * np.linspace(0.75, 1.1, 4001)
    each = w[:, None, None]
    dynamic = stiffness - each**2 * mass + 1j * each * (damping + each * gyroscopic)
    size = np.abs(np.linalg.solve(dynamic, load[:, None])[:, AT, 0])
    return w[peaks(size)]


def order_of_z(angle):
    """Exponent with which the amplitude of z grows with a small shaking."""
    sizes = []
    for acceleration in (1e-3, 2e-3):
        given = {"damping_ratio": DAMPING, "base_acceleration": acceleration}
        system = rotor(angle, **given)
        unit = float(system.reference_frequency)
        orbit = solve_orbit(system, unit, HarmonicBalance(2, 8, steps=16))
        sizes.append(float(orbit.amplitude[4]))
    return float(np.log2(sizes[1] / sizes[0]))


def unmarked(branch):
    """Changes of stability that no fold, flip or Neimark-Sacker point explains.

    Multipliers are of the motion, folds of the equations of so many harmonics: a point
    within 1e-6 of a fold may be on either side of it.
    """
    changes = np.nonzero(np.diff(branch.stable.astype(int)))[0]

    def explained(k):
        ends = branch.frequency[k : k + 2]
        return any(
            event.after == k or np.abs(ends / event.frequency - 1.0).min() < 1e-6
            for event in branch.events
        )

    return sum(not explained(k) for k in changes)


def measure(angles, balance, shooting, points, compared):
    rows, branches = [], {}
    for angle in angles:
        system, branch = branch_of(angle, SHAKEN, balance, points)
        _, other = branch_of(angle, SHAKEN, shooting, points)
        top = peaks(branch.amplitude[:, AT])
        rows.append(
            {
                "angle": angle,
                "linear": (linear_peaks(angle) / (2 * np.pi)).tolist(),
                "peak": sorted((branch.frequency[top] / (2 * np.pi)).tolist()),
                "amplitude": branch.amplitude[:, AT].max(),
                "z": branch.amplitude[:, 4].max(),
                "order_of_z": order_of_z(angle),
                "points": len(branch.frequency),
                "unstable": int((~branch.stable).sum()),
                "unmarked": unmarked(branch),
                "residual": float(branch.residual.max()),
                "endings": [branch.ending.label, other.ending.label],
                "balance": events(branch),
                "shooting": events(other),
                **{
                    f"apart_{k}": v
                    for k, v in agreement(
                        system, branch, balance, shooting, compared
                    ).items()
                },
            }
        )
        branches[angle] = branch
    return rows, branches


def show(rows, _):
    print(
        "angle  linear peaks  peaks of y at B  y B, z [um]  z grows  points,"
        " unstable, unmarked"
    )
    for r in rows:
        linear, peak = (" ".join(f"{f:6.1f}" for f in r[k]) for k in ("linear", "peak"))
        print(
            f"{r['angle']:3d} {linear}  {peak}  {1e6 * r['amplitude']:7.3f}"
            f" {1e6 * r['z']:7.3f} x^{r['order_of_z']:.3f} {r['points']}"
            f" {r['unstable']} {r['unmarked']} {'/'.join(r['endings'])}"
        )
    print("\nmarked points [Hz], harmonic balance | shooting")
    for r in rows:
        for kind in sorted({k for k, _ in r["balance"] + r["shooting"]}):
            lists = (
                " ".join(f"{f:.2f}" for k, f in sorted(r[m]) if k == kind)
                for m in ("balance", "shooting")
            )
            print(f"{r['angle']:3d} {kind:15s} " + " | ".join(lists))
    print()
    for r in rows:
        print(
            f"{r['angle']:3d}: {r['apart_solved']} of {r['apart_points']} points:"
            f" amplitudes apart {r['apart_amplitude']:.1e}, frequency"
            f" {r['apart_frequency']:.1e}"
        )
    every = [matched(r["balance"], r["shooting"]) for r in rows]
    worst = max(r["apart_amplitude"] for r in rows)
    print(verdict("amplitudes of both methods apart", worst, 1e-4))
    print(verdict("folds apart", max(x.get("fold", 0.0) for x in every), 1e-3))
    shift = max(
        f / g - 1.0 for r in rows for f, g in zip(r["peak"], r["linear"], strict=False)
    )
    print(verdict("highest shift of a peak from the linear one", shift, 0.0))
    print(verdict("changes unmarked", float(sum(r["unmarked"] for r in rows)), 0.0))
    off = max(abs(r["order_of_z"] - 2.0) for r in rows)
    print(verdict("order of z off two", off, 1e-3))


def plot(_, branches):
    figure, axes = subplots(2, 2, figsize=(13, 9.5), layout="constrained", dpi=110)
    colors = shades(np.linspace(0.0, 0.85, len(branches)))
    for color, (angle, branch) in zip(colors, branches.items(), strict=True):
        draw(axes[0, 0], branch, AT, color, f"{angle}°")
    shown = branches[SHOWN]
    for k, name in enumerate(NAMES):
        draw(axes[0, 1], shown, k, f"C{k}", name)
    for ax in axes[0]:
        ax.set_xlabel("frequency [Hz]; dotted: unstable")
        ax.set_ylabel("half of peak to peak [µm]")
    axes[0, 0].set_title("Figure 3: y at B over the contact angle", loc="left")
    axes[0, 1].set_title(
        f"Figure 4: {SHOWN}°; ○ folds (A), □ Neimark-Sacker (B, C)", loc="left"
    )
    tops = peaks(shown.amplitude[:, AT])[::-1]
    for number, ax, at in zip((5, 6), axes[1], tops, strict=True):
        motion = 1e6 * np.concatenate(
            [shown.displacement[at], shown.displacement[at][:1]]
        )
        for k, name in enumerate(NAMES):
            ax.plot(np.linspace(0.0, 1.0, len(motion)), motion[:, k], label=name)
        hertz = shown.frequency[at] / (2 * np.pi)
        kind = "" if shown.stable[at] else ", unstable"
        ax.set_title(f"Figure {number}: resonance at {hertz:.1f} Hz{kind}", loc="left")
        ax.set_xlabel("time over the period")
        ax.set_ylabel("displacement [µm]")
    for ax in axes.flat:
        ax.legend(frameon=False, fontsize=9)
    return figure


@benchmark("one angle, few points", show, plot)
def main(smoke):
    if smoke:
        return measure((SHOWN,), HarmonicBalance(2, 8, steps=8), Shooting(12), 150, 2)
    return measure(ANGLES, HarmonicBalance(15, 192, steps=96), Shooting(192), 500, 40)

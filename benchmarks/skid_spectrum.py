"""What do radial and sinusoidal loads do to the slip of a ball, and to its spectrum?

The bearing of Han & Chu, 600 N axial, still outer ring, inner ring at 2000 rpm, radial
load along +Y, angles from +X. The published words on its slip, turned into numbers.

Over an orbit: `skid.steady`, one ball in its periodic orbit, radial loads of 100 to
500 N. Zones B and D are where it bears more than under axial load alone, A and C lie
between; A is the one in which the load rises towards B.

In time: `skid.simulate` with the ring balanced at every time, radial load 400 N
[1 + e sin(w_i t)] with e = 0, 0.2, 0.4, from rolling on; the last 2.5 s, over 30
orbits. The balls run ahead of even motion and fall behind it by about a millimetre, so
that the cage, whose pockets leave 0.2 mm, takes part; beside it one that leaves 8 mm.
"apart": root mean square of how far the sliding speed of a ball differs from that one
orbit before, over that of the speed itself. "floor": largest amplitude away from all
lines named.

README: sliding up to 138 mm/s where load rises, 91 where it falls, below 0.01 under
load; varying loads 3.2 to 5.6 times; places 0.03 orbit off | zones and lines as
published | yes

Last run:

over an orbit, by skid.steady; sliding speeds in mm/s
       centres, share    load, N      inner, most         inner, middle
radial     B      D      B      D      A      C   C/A       B      D
 100 N  0.250  0.750  146.4  115.7    0.3    0.3  0.95   0.018  0.116
 200 N  0.250  0.750  200.2  136.3    2.0    1.7  0.82   0.001  0.042
 300 N  0.250  0.750  258.9  159.3   16.2   11.7  0.72   0.000  0.014
 400 N  0.250  0.750  318.0  180.9  138.0   90.7  0.66   0.000  0.005
 500 N  0.250  0.750  376.3  199.8  607.9  371.1  0.61   0.000  0.002

outer raceway in the middle of B and D, ripple of the orbital speed (half of
its range), cage against axial load alone, how far a ball wanders
 100 N   0.040   0.167   0.77 %  -0.00 %   0.41 mm
 200 N   0.006   0.068   1.31 %  -0.01 %   0.70 mm
 300 N   0.001   0.027   1.69 %  -0.04 %   0.91 mm
 400 N   0.000   0.011   1.98 %  -0.13 %   1.07 mm
 500 N   0.000   0.005   2.28 %  -0.33 %   1.26 mm

in time, radial load 400 N [1 + e sin(w_i t)]
pockets    e  largest mm/s  apart   cage Hz  orbits  cage force N  steps     s
 0.2 mm  0.0      159.1    0.0085   13.008    32.5       336.6    108470   167
 0.2 mm  0.2      506.0    1.2090   13.001    32.5       404.8    120790   136
 0.2 mm  0.4      807.5    1.3554   13.002    32.5       476.9    115526    58
 8.0 mm  0.0      133.7    0.0196   13.061    32.7        17.2     44755    23
 8.0 mm  0.2      441.0    1.2533   13.075    32.7        17.1     47401    73
 8.0 mm  0.4      749.8    1.3900   13.060    32.7        22.4     55472    65

amplitudes [mm/s] at multiples k of the cage's frequency
pockets    e       1       2       3       4       5       6   floor
 0.2 mm  0.0   12.05   32.47   12.43   21.57   12.54   14.86    0.03
 0.2 mm  0.2   15.92   47.19   17.19   31.99   17.03   20.62    0.16
 0.2 mm  0.4   22.47   74.30   25.83   48.93   24.65   27.11    1.00
 8.0 mm  0.0    7.55   26.90   12.23   20.65   11.36   11.77    0.05
 8.0 mm  0.2   10.75   39.51   17.49   29.83   16.38   17.04    0.20
 8.0 mm  0.4   17.04   64.90   27.83   45.67   24.97   23.91    1.45

amplitudes [mm/s] at the inner ring's frequency and k times the cage's off
pockets    e     -5     -4     -3     -2     -1     +0     +1     +2     +3     +4
 0.2 mm  0.0   0.01   0.00   0.00   0.01   0.01   0.01   0.01   0.01   0.01   0.00
 0.2 mm  0.2  11.35  18.57  11.29  24.79   9.52  27.15   9.12  24.76  10.08  17.83
 0.2 mm  0.4  20.04  33.86  21.74  49.17  17.85  55.20  16.83  48.52  18.75  32.19
 8.0 mm  0.0   0.03   0.01   0.02   0.01   0.02   0.01   0.02   0.02   0.02   0.02
 8.0 mm  0.2  11.00  16.02   9.91  24.73   6.22  25.37   6.34  23.40   8.49  17.39
 8.0 mm  0.4  20.59  31.03  20.02  50.64  12.81  52.97  12.34  47.38  16.72  33.23
AMD EPYC, 2 cores, load average 2.8; devices: 1 cpu; jax 0.10.1

Zones, and that slip all but vanishes in B and D, grows with the radial load and is
larger in A than in C, are as published; the centres of B and D are published as 0.28
and 0.78 of an orbit whose beginning is not told. The ripple of the orbital speed is
that of the contact angle, and above 1 % from 200 N on. A load that varies with the
inner ring leaves no two orbits alike, makes the largest sliding 3.2 (e = 0.2) and 5.1
to 5.6 times (e = 0.4) as large, and sets beside the multiples of the cage's frequency
lines at all w_i + k w_c.
"""

import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shades, subplots
from han_chu import FREE, MODEL, SPEED

import bearingjax as bj
from bearingjax import skid
from bearingjax.skid import SinusoidalLoad

AXIAL, RADIAL = 600.0, 400.0
DRIVE = float(SPEED.inner)
INNER = 1
"""Of the raceways."""
HARMONICS = range(1, 7)
SIDES = (-5, -4, -3, -2, -1, 0, 1, 2, 3, 4)
"""Multiples of the cage's frequency by which lines lie off that of the inner ring."""
WINDOW = 2
"""Lines of a spectrum to either side that Hann's window fills."""
ZONES = "ABCD"


def load(radial):
    return jnp.asarray([0.0, radial, AXIAL, 0.0, 0.0, 0.0])


def over_orbit(radials, places):
    """The periodic orbit under radial loads, the first of them none."""

    @jax.jit
    @jax.vmap
    def solve(radial):
        given = {"speed": SPEED, "support": bj.Support(FREE), "places": places}
        found = skid.steady(MODEL, load(radial), **given)
        sliding, borne = found.sliding_speed, found.contact_load
        return (
            sliding,
            borne[:, INNER],
            found.orbit_speed,
            found.cage_speed,
            found.wander,
        )

    sliding, borne, orbit, cage, wander = map(np.asarray, solve(jnp.asarray(radials)))
    share = np.arange(places) / places
    even = borne[0].mean()
    rows = []
    for k, radial in enumerate(radials[1:], 1):
        zones = split(share, borne[k] > even)
        inner = 1e3 * sliding[k, :, INNER]
        rows.append(
            {
                "radial": radial,
                "centres": [middle(share, zones[z]) for z in "BD"],
                "load": [float(borne[k, zones[z]].max()) for z in "BD"],
                "most": {z: float(inner[zones[z]].max()) for z in ZONES},
                "least": {z: float(inner[zones[z]].min()) for z in ZONES},
                "outer_middle": [
                    float(1e3 * sliding[k, nearest(share, zones[z]), 0]) for z in "BD"
                ],
                "inner_middle": [float(inner[nearest(share, zones[z])]) for z in "BD"],
                "ripple": float(np.ptp(orbit[k]) / 2 / cage[k]),
                "cage": float(cage[k] / cage[0] - 1.0),
                "wander": float(1e3 * wander[k]),
            }
        )
    return rows, share, borne, 1e3 * sliding


def split(share, above):
    """Places of the four zones: B about a quarter of the orbit, D opposite."""
    near = np.abs(share - 0.25) < 0.25
    ahead = np.where(share > 0.75, share - 1.0, share) < 0.25
    found = {"B": above & near, "D": above & ~near}
    return found | {"A": ~above & ahead, "C": ~above & ~ahead}


def middle(share, zone):
    return float(share[zone].mean())


def nearest(share, zone):
    return int(np.argmin(np.abs(share - share[zone].mean())))


def in_time(model, varying, begin, duration, rate):
    """Sliding speed of ball 0 at the inner raceway at even times, its angle, the cage's
    frequency, cage forces."""
    change = jnp.zeros(6).at[1].set(RADIAL * varying)
    found = skid.simulate(
        model,
        SinusoidalLoad(load(RADIAL), change, DRIVE),
        speed=SPEED,
        times=duration * np.linspace(0.0, 1.0, round(duration * rate) + 1),
        support=bj.Support(free=FREE),
        options=bj.skid.SkidOptions(1e-5, 2_000_000, "forward"),
    )
    late = np.asarray(found.time) >= begin
    lines = bj.skid.sliding_spectrum(found, begin=begin)
    angle = np.unwrap(np.asarray(found.azimuth)[:, 0])[late]
    sliding = 1e3 * np.asarray(found.sliding_speed)[late, 0, INNER]
    force = float(np.abs(np.asarray(found.cage_force)[late]).max())
    return angle, sliding, lines, force, int(found.steps)


def measures(angle, sliding, lines):
    """Largest sliding speed, what differs between orbits, amplitudes of lines."""
    at = np.arange(angle[0], angle[-1] - 2.0 * np.pi, 0.01)
    now = np.interp(at, angle, sliding)
    then = np.interp(at + 2.0 * np.pi, angle, sliding)
    frequency, amplitude = lines.frequency, 1e3 * lines.amplitude
    ring, step = DRIVE / (2.0 * np.pi), lines.frequency[1]
    multiples = [k * lines.cage for k in HARMONICS]
    sides = [abs(ring + k * lines.cage) for k in SIDES]

    def height(f):
        return float(amplitude[np.abs(frequency - f) < WINDOW * step].max())

    every = [k * lines.cage for k in range(40)]
    every += [abs(m * ring + k * lines.cage) for k in range(-40, 40) for m in (1, 2, 3)]
    apart = np.min(np.abs(frequency[:, None] - np.array(every)), axis=1)
    away = (apart > 2.5 * step) & (frequency < multiples[-1])
    return {
        "most": float(sliding.max()),
        "apart": float(np.sqrt(np.mean((now - then) ** 2) / np.mean(now**2))),
        "cage": float(lines.cage),
        "orbits": float((angle[-1] - angle[0]) / (2.0 * np.pi)),
        "multiples": [height(f) for f in multiples],
        "sides": [height(f) for f in sides],
        "floor": float(amplitude[away].max()) if away.any() else float("nan"),
    }


def measure(radials, places, shares, pockets, begin, duration, rate):
    rows, *curves = over_orbit(radials, places)
    runs, spectra = [], []
    for pocket in pockets:
        model = eqx.tree_at(
            lambda m: m.cage.pocket_clearance, MODEL, jnp.asarray(1e-3 * pocket)
        )
        for varying in shares:
            begun = time.perf_counter()
            *found, force, steps = in_time(model, varying, begin, duration, rate)
            seconds = time.perf_counter() - begun
            run = {"pocket": pocket, "share": varying, "force": force, "steps": steps}
            runs.append(run | measures(*found) | {"seconds": seconds})
            spectra.append(found)
    return {"orbit": rows, "runs": runs}, curves, spectra


def show(r, *_):
    print("over an orbit, by skid.steady; sliding speeds in mm/s")
    print("       centres, share    load, N      inner, most         inner, middle")
    print("radial     B      D      B      D      A      C   C/A       B      D")
    for o in r["orbit"]:
        a, c = o["most"]["A"], o["most"]["C"]
        cells = "".join(f"{x:7.3f}" for x in o["centres"])
        cells += "".join(f"{x:7.1f}" for x in (*o["load"], a, c)) + f"{c / a:6.2f} "
        cells += "".join(f"{x:7.3f}" for x in o["inner_middle"])
        print(f"{o['radial']:4.0f} N{cells}")
    print(
        "\nouter raceway in the middle of B and D, ripple of the orbital speed (half of"
    )
    print("its range), cage against axial load alone, how far a ball wanders")
    for o in r["orbit"]:
        cells = "".join(f"{x:8.3f}" for x in o["outer_middle"])
        cells += "".join(f"{100 * o[x]:7.2f} %" for x in ("ripple", "cage"))
        print(f"{o['radial']:4.0f} N{cells} {o['wander']:6.2f} mm")
    print("\nin time, radial load 400 N [1 + e sin(w_i t)]")
    print(
        "pockets    e  largest mm/s  apart   cage Hz  orbits  cage force N  steps     s"
    )
    for run in r["runs"]:
        print(
            f"{run['pocket']:4.1f} mm  {run['share']:3.1f} {run['most']:10.1f}"
            f" {run['apart']:9.4f} {run['cage']:8.3f} {run['orbits']:7.1f}"
            f" {run['force']:11.1f} {run['steps']:9d} {run['seconds']:5.0f}"
        )
    print("\namplitudes [mm/s] at multiples k of the cage's frequency")
    print("pockets    e" + "".join(f"{k:8d}" for k in HARMONICS) + "   floor")
    for run in r["runs"]:
        cells = "".join(f"{a:8.2f}" for a in run["multiples"])
        print(f"{run['pocket']:4.1f} mm  {run['share']:3.1f}{cells}{run['floor']:8.2f}")
    print(
        "\namplitudes [mm/s] at the inner ring's frequency and k times the cage's off"
    )
    print("pockets    e" + "".join(f"{k:+8d}" for k in SIDES))
    for run in r["runs"]:
        cells = "".join(f"{a:7.2f}" for a in run["sides"])
        print(f"{run['pocket']:4.1f} mm  {run['share']:3.1f}{cells}")


def plot(r, curves, spectra):
    """Sliding over an orbit with the zones; over angle in time; spectra."""
    share, borne, sliding = curves
    figure, axes = subplots(1, 3, figsize=(15.0, 4.5), layout="constrained", dpi=140)
    ax, last = axes[0], len(r["orbit"])
    colours = shades(np.linspace(0.85, 0.0, last))
    for k, o in enumerate(r["orbit"], 1):
        label = f"{o['radial']:.0f} N"
        ax.semilogy(share, sliding[k, :, INNER], color=colours[k - 1], label=label)
    zones = split(share, borne[last] > borne[0].mean())
    for name in "BD":
        inside = share[zones[name]]
        ax.axvspan(inside[0], inside[-1], color="0.92", zorder=0)
    for name, x in zip("ABCDA", (0.05, 0.25, 0.5, 0.75, 0.95), strict=True):
        ax.text(
            x, 0.97, name, transform=ax.get_xaxis_transform(), ha="center", va="top"
        )
    ax.set_title("Sliding over an orbit, 600 N axial", loc="left")
    ax.set_xlabel("share of the orbit; radial load at 0.25")
    ax.legend(
        frameon=False,
        fontsize=9,
        title="radial load",
        loc="upper center",
        bbox_to_anchor=(0.5, 0.93),
        ncols=5,
        columnspacing=0.8,
        handlelength=1.0,
    )
    ax.set_ylim(1e-3, 1e5)
    ax.margins(x=0)
    widest = r["runs"][-1]["pocket"]
    rows = [k for k, run in enumerate(r["runs"]) if run["pocket"] == widest]
    looks = dict(zip(rows, ("#009E73", "#0072B2", "#D55E00"), strict=False))
    for k in reversed(rows):
        angle, slip, lines = spectra[k]
        turns = (angle - angle[0]) / (2.0 * np.pi)
        shown = turns < 5.0
        label = f"e = {r['runs'][k]['share']:.1f}"
        axes[1].plot(turns[shown], slip[shown], color=looks[k], lw=1.0, label=label)
        low = lines.frequency < 90.0
        amplitude = 1e3 * lines.amplitude[low]
        axes[2].semilogy(
            lines.frequency[low], amplitude, color=looks[k], lw=1.0, label=label
        )
    cage = r["runs"][-1]["cage"]
    for k in HARMONICS:
        axes[2].axvline(k * cage, color="0.6", ls=":", lw=0.9)
    axes[2].axvline(DRIVE / (2.0 * np.pi), color="0.3", ls="--", lw=0.9)
    axes[2].text(DRIVE / (2.0 * np.pi) - 0.5, 150, "inner ring", ha="right", fontsize=9)
    axes[2].set_ylim(0.05, 300.0)
    axes[1].set_title(f"Sliding in time, pockets {widest:g} mm", loc="left")
    axes[1].set_xlabel("orbits of the ball")
    axes[2].set_title("Spectrum of it; dotted: multiples of the cage's", loc="left")
    axes[2].set_xlabel("frequency [Hz]")
    for ax in axes[1:]:
        ax.legend(frameon=False, fontsize=9)
    for ax in axes:
        ax.set_ylabel("sliding speed at the inner raceway [mm/s]")
    axes[2].set_ylabel("amplitude [mm/s]")
    return figure


@benchmark("short and few", show, plot)
def main(smoke):
    if smoke:
        return measure((0.0, RADIAL), 48, (0.4,), (8.0,), 0.02, 0.12, 1000.0)
    loads = 0.0, 100.0, 200.0, 300.0, 400.0, 500.0
    return measure(loads, 240, (0.0, 0.2, 0.4), (0.2, 8.0), 0.5, 3.0, 2000.0)

"""Are our linear rotors those of ROSS, and at which speeds is a linear answer wrong?

First the same shafts, discs and springs in ROSS 2.3 (`pip install "bearingjax[ross]"`;
left out where it is not installed), with the same theory of beams (Timoshenko, shear
coefficient of Cowper): damped frequencies and logarithmic decrements of all modes up to
the highest compared, at rest and at speed, and the complex unbalance response of every
node. ROSS twists as well; its modes of torsion have no partner and are left out.
Differences of frequencies are relative, those of decrements are not; those of a
response are relative to the largest displacement of the rotor at that speed. Run it
from a folder without shared libraries: a package of ROSS takes any for REFPROP.

Then what a linear rotor cannot tell: the same kind of shaft on two preloaded angular
contact ball bearings. Linear: bearings as springs, as they are at rest under weight and
preload. Beside it the stiffness of the bearings settled at a speed, balls with their
inertia, and periodic orbits with the true force of every ball, which may lift off
(`follow`, harmonic balance, balls without inertia), for several unbalances. Speeds at
which the linear amplitude of the disc differs by more than 10 % from that of a stable
orbit are listed.

README: within 2e-12 of ROSS 2.3; with 10 g mm unbalance on true bearings up to 37 %
wrong, from 9312 to 9461 rpm | 1e-6 | yes

Last run:

rotor                                   speed  modes  frequency  decrement
Friswell et al., examples 5.9.1 to 5.9      0     12      9e-13      1e-13
Friswell et al., examples 5.9.1 to 5.9    300     12      2e-12      4e-13
Friswell et al., examples 5.9.1 to 5.9   1200     12      5e-13      2e-12
Friswell et al., examples 5.9.1 to 5.9 unbalance response at 60 speeds    3e-13
hollow, stepped, overhung, cross terms      0     12      8e-13      7e-13
hollow, stepped, overhung, cross terms    300     12      3e-13      6e-13
hollow, stepped, overhung, cross terms   1200     12      1e-12      1e-12
hollow, stepped, overhung, cross terms unbalance response at 60 speeds    8e-13
largest difference from ROSS: 1.95e-12 (at most 1e-06): met

settled   radial, axial stiffness  first forward mode
     0 rpm     73.03    13.93 N/um     154.13 Hz
  9549 rpm     64.13    12.69 N/um     155.79 Hz
 19099 rpm     48.78    11.30 N/um     155.56 Hz
 38197 rpm     43.44    14.75 N/um     155.82 Hz
critical speeds, linear: 9063 rpm, 9377 rpm
unbalance   peak, linear       peak, true        wrong by more than 10 % at
   1 g mm    13.7 um   9379 rpm    13.7 um   9379 rpm   no speed
    largest error 0 %; 56 points, 0 unstable, 0 events; limit, residual 8e-11
  10 g mm   136.6 um   9377 rpm   137.7 um   9436 rpm   9312 to 9390, 9410 to 9461 rpm
    largest error 37 %; 400 points, 0 unstable, 0 events; points, residual 8e-11
AMD EPYC, 2 cores, load average 5.3; devices: 1 cpu; jax 0.10.1

The last table was run by itself. In these bearings 10 g mm bend the resonance upwards
by 0.6 %, half of its width, and what is linear is up to 37 % off on both sides of it.
"""

import importlib
import warnings

import numpy as np
from bench import benchmark, verdict
from rotor.machines import STEEL, friswell

import bearingjax as bj
from bearingjax.rotor.nonlinear import HarmonicBalance, Steps, follow, vibrating_rotor

GOAL = 1e-6
SHEAR = float(STEEL.elastic_modulus) / (2.0 * (1.0 + float(STEEL.poisson_ratio)))


def hollow():
    """A stepped shaft, hollow in part, overhung disc, springs with cross terms."""
    stations = np.array([0.0, 0.08, 0.2, 0.4, 0.55, 0.65])
    shaft = bj.rotor.Shaft(
        stations,
        [0.04, 0.06, 0.07, 0.06, 0.04],
        [0.0, 0.02, 0.03, 0.02, 0.0],
        STEEL,
        (1, 2, 3, 2, 1),
    )
    discs = [
        bj.rotor.Disc.of_size(3, 0.25, 0.04, 0.06, STEEL),
        bj.rotor.Disc.of_size(5, 0.2, 0.03, 0.04, STEEL),
    ]

    def support(station, stiffness):
        k = np.diag([1.0, 0.7, 0.4, 0.0, 0.0])
        k[0, 1], k[1, 0] = 0.2, -0.1
        c = np.diag([400.0, 300.0, 100.0, 0.0, 0.0])
        c[0, 1] = c[1, 0] = 50.0
        return bj.rotor.LinearSupport(station, stiffness * k, c)

    return bj.rotor.Rotor(shaft, discs, [support(1, 5e7), support(4, 2e7)])


ROTORS = {
    "Friswell et al., examples 5.9.1 to 5.9.5": friswell(damping=100.0),
    "hollow, stepped, overhung, cross terms": hollow(),
}


def the_same_in_ross(ross, rotor):
    """A rotor of `LinearSupport`s as one of ROSS."""
    steel = ross.Material("steel", rho=7810.0, E=211e9, G_s=SHEAR)
    shaft = rotor.shaft
    segment = np.repeat(np.arange(shaft.n_segments), shaft.divisions)
    lengths = np.diff(np.asarray(shaft.nodes))
    parts = [
        ross.ShaftElement(
            float(length), float(shaft.bore[k]), float(shaft.outer_diameter[k]),
            material=steel, shear_method_calc="cowper",
        )
        for length, k in zip(lengths, segment, strict=True)
    ]  # fmt: skip
    discs = [
        ross.DiskElement(
            n=shaft.node(d.station), m=float(d.mass), Id=float(d.diametral_inertia),
            Ip=float(d.polar_inertia),
        )
        for d in rotor.discs
    ]  # fmt: skip

    def bearing(support):
        k, c = np.asarray(support.stiffness), np.asarray(support.damping)
        names = {"xx": (0, 0), "xy": (0, 1), "yx": (1, 0), "yy": (1, 1), "zz": (2, 2)}
        given = {f"k{name}": k[at] for name, at in names.items()}
        given |= {f"c{name}": c[at] for name, at in names.items()}
        return ross.BearingElement(n=shaft.node(support.station), **given)

    return ross.Rotor(parts, discs, [bearing(one) for one in rotor.supports])


def modes_apart(theirs, rotor, speed, count):
    """How many modes, and what frequencies and decrements differ from ROSS at most.

    Each of ours is compared with the nearest of ROSS.
    """
    found = bj.rotor.modes(rotor, speed, count=count)
    ours = np.asarray(found.eigenvalue)[np.asarray(found.oscillates)]
    values = np.linalg.eigvals(np.asarray(theirs.A(speed)))
    nearest = values[np.argmin(np.abs(values[None] - ours[:, None]), axis=1)]
    frequency = np.abs(np.imag(nearest) / np.imag(ours) - 1.0)
    decrements = [2.0 * np.pi * np.real(v) / np.imag(v) for v in (nearest, ours)]
    decrement = decrements[0] - decrements[1]
    return len(ours), frequency.max(), np.abs(decrement).max()


def response_apart(theirs, rotor, speeds):
    """Largest difference of the displacements of all nodes over the largest one."""
    station = rotor.discs[0].station
    ours = bj.rotor.unbalance_response(
        rotor, bj.rotor.Unbalance(station, 1e-3, 0.4), speeds
    )
    found = theirs.run_unbalance_response(
        [rotor.shaft.node(station)], [1e-3], [0.4], frequency=speeds
    ).forced_resp
    nodes = np.asarray(found).reshape(rotor.shaft.n_nodes, 6, len(speeds))
    nodes = np.moveaxis(nodes[:, :3], 2, 0)
    own = np.asarray(ours.motion)[..., :3]
    size = np.abs(own).max(axis=(1, 2), keepdims=True)
    return np.max(np.abs(nodes - own) / size)


def beside_ross(smoke):
    """Print differences; the largest."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ross = importlib.import_module("ross")
    except ImportError as error:
        print(f"ROSS is not installed ({error}): nothing to compare with.")
        return None
    worst = 0.0
    print("rotor                                   speed  modes  frequency  decrement")
    for name, rotor in ROTORS.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            theirs = the_same_in_ross(ross, rotor)
        for speed in (300.0,) if smoke else (0.0, 300.0, 1200.0):
            count, frequency, decrement = modes_apart(theirs, rotor, speed, 12)
            worst = max(worst, frequency, decrement)
            print(f"{name[:38]:38s} {speed:6g} {count:6d} {frequency:10.0e}"
                  f" {decrement:10.0e}")  # fmt: skip
        speeds = np.linspace(20.0, 1200.0, 3 if smoke else 60)
        apart = response_apart(theirs, rotor, speeds)
        worst = max(worst, apart)
        print(
            f"{name[:38]:38s} unbalance response at {len(speeds)} speeds {apart:8.0e}"
        )
    return worst


WRONG = 0.1
"""Relative error of an amplitude from which a linear answer counts as wrong."""
MOMENTS = 1e-6, 1e-5
"""Unbalances of the disc [kg m]."""
SPEEDS = 800.0, 1150.0
"""Range of speeds [rad/s]."""
RPM = 30.0 / np.pi
METHOD = HarmonicBalance(5, 32)


def on_bearings(inertia=False):
    """A disc of 6 kg between two angular contact ball bearings, face to face."""
    bearing = bj.AngularContactBallBearing(
        7, 0.04, 0.008, contact_angle=np.deg2rad(15.0), outer_osculation=0.52,
        inner_osculation=0.52,
    )  # fmt: skip
    element = bj.BearingElement(bearing)
    preload = [0.0, 0.0, 10e-6, 0.0, 0.0]
    damping = [300.0, 300.0, 300.0, 0.0, 0.0]
    supports = [
        bj.rotor.BearingSupport(
            k, element, preload, damping, turned=turned, inertia=inertia
        )
        for k, turned in ((0, False), (2, True))
    ]
    shaft = bj.rotor.Shaft([0.0, 0.12, 0.3], 0.025, divisions=(2, 3))
    disc = bj.rotor.Disc.of_size(1, 0.2, 0.025, 0.025)
    return bj.rotor.Rotor(shaft, disc, supports, bj.rotor.ModalDamping(0.005))


def loads(moment=0.0):
    return bj.rotor.RotorLoads(bj.rotor.Unbalance(1, moment), gravity=[0.0, -9.81, 0.0])


def orbits(rotor, settled, moment, points):
    """Branch of true orbits, and longer half axes of the disc's first harmonic [m]."""
    system = vibrating_rotor(
        rotor, loads(moment), scale=3e-5, reference_frequency=1000.0, modes=6,
        about=settled.motion,
    )  # fmt: skip
    start = system.freedoms(settled.motion)[None]
    branch = follow(
        system, *SPEEDS, METHOD, start, steps=Steps(largest=0.2, points=points),
    )  # fmt: skip
    at = rotor.slice_at(1).start
    moved = np.asarray(branch.displacement) @ np.asarray(system.motions)[at : at + 2].T
    x, y = (np.fft.rfft(moved, axis=1)[:, 1] * 2.0 / moved.shape[1]).T
    return branch, 0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y))


def ranges(speeds, chosen):
    """Where neighbouring speeds are chosen, in words [rpm]."""
    edges = np.diff(np.concatenate([[0], chosen.astype(int), [0]]))
    pairs = zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
    rpm = RPM * speeds
    found = ", ".join(f"{rpm[a]:.0f} to {rpm[b - 1]:.0f}" for a, b in pairs)
    return f"{found} rpm" if found else "no speed"


def over_speed(smoke):
    """Print what the speed of the balls does to the bearings and the first modes."""
    rotor = on_bearings(inertia=True)
    print("settled   radial, axial stiffness  first forward mode")
    for speed in (0.0,) if smoke else (0.0, 1000.0, 2000.0, 4000.0):
        found = bj.rotor.static_equilibrium(rotor, loads(), speed)
        k = np.asarray(found.stiffness[0])
        modes = bj.rotor.modes(found.rotor, speed, count=6)
        # At rest both directions are one mode.
        first = np.flatnonzero(np.asarray(modes.whirl) >= (speed > 0))[0]
        print(f"{RPM * speed:6.0f} rpm {1e-6 * k[1, 1]:9.2f} {1e-6 * k[2, 2]:8.2f} N/um"
              f" {float(modes.frequency[first]):10.2f} Hz", flush=True)  # fmt: skip


def linear_against_true(smoke):
    """Print where a linear answer is wrong."""
    rotor = on_bearings()
    settled = bj.rotor.static_equilibrium(rotor, loads())
    critical = bj.rotor.critical_speeds(settled.rotor, count=2)
    print("critical speeds, linear: "
          + ", ".join(f"{RPM * float(v):.0f} rpm" for v in critical.speed))  # fmt: skip
    print("unbalance   peak, linear       peak, true        wrong by more than 10 % at")
    for moment in MOMENTS[-1:] if smoke else MOMENTS:
        branch, size = orbits(rotor, settled, moment, 8 if smoke else 400)
        speeds = branch.frequency
        linear = bj.rotor.unbalance_response(
            settled.rotor, bj.rotor.Unbalance(1, moment), speeds
        )
        linear = np.asarray(linear.major_axis[:, rotor.shaft.node(1)])
        error = np.where(branch.stable, np.abs(linear / size - 1.0), 0.0)
        top, linear_top = int(np.argmax(size)), int(np.argmax(linear))
        peak, wrong = 1e6 * size[top], ranges(speeds, error > WRONG)
        print(
            f"{1e6 * moment:4.0f} g mm {1e6 * linear[linear_top]:7.1f} um"
            f" {RPM * speeds[linear_top]:6.0f} rpm {peak:7.1f} um"
            f" {RPM * branch.frequency[top]:6.0f} rpm   {wrong}"
        )
        print(
            f"    largest error {100.0 * error.max():.0f} %; {len(speeds)} points,"
            f" {np.sum(~branch.stable)} unstable, {len(branch.events)} events;"
            f" {branch.ending.label}, residual {branch.residual.max():.0e}",
            flush=True,
        )


@benchmark("few speeds and points")
def main(smoke):
    worst = beside_ross(smoke)
    if worst is not None:
        print(verdict("largest difference from ROSS", worst, GOAL))
    print()
    over_speed(smoke)
    linear_against_true(smoke)
    return worst is None or worst <= GOAL

"""Which claims about the noise of a four-point ball bearing does the model confirm?

Kurushin, Kurushin, Zhilnikov and Murashkin (Vestnik SGAU, 2011): bearing 85-176211D1
with 14 balls of 14.288 mm at 1500 rev/min, 85 N along the axis and 25 N across, the
outer ring, which does not tilt, on a sensor of 10 N/mm; two balls 24 um larger than the
others, at different distances. Lost in the paper, and assumed: osculation 0.52;
0.3716 kg of the ring (which fits both published frequencies under radial load where a
ball has two contacts; in a four-point bearing it then has four, and modes are 15 %
higher); a retardation of 10 us; waves of orders 2 to 300 on both raceways, amplitude
falling with the square of the order, scaled once such that equal balls come near the
75 dB that the paper calculated (74 dB); of the cage 30 g, a film of 1 um and a friction
of balls of 0.05. Clearances of pockets and land, 0.5 mm, and the law of contact are the
paper's. Cases of large balls have a cage that carries the balls evenly; sources are
told apart by runs of 16 turns, those with a cage with a free one.

In the combined case both squared frequencies of the paper are 1.28 and 1.31 times ours:
one factor near 1.5^(2/3) = 1.31, which stiffnesses have for a constant K of 3/2 its
size. No geometry moves both alike, and the radial case has no such factor: it is an
inconsistency of the paper. Its large balls stand at most 5 balls apart; those of the
scene noise_four_point are 6 apart, opposite each other.

README: natural frequencies 2695 and 2244 Hz (published 2695, 2245), lines, bands; not
the levels of large balls and cage | 0.2 % of the ratio | yes

Last run:

natural frequencies and loads: ours | published
  along, radial 250 N [Hz]                    2695 | 2695
  across [Hz]                                 2244 | 2245
  their ratio                                1.201 | 1.2004
  lowest ball mode above [kHz]                11.7 | 11.7
  highest [kHz]                              17.12 | 17.2
  along at 1500 rev/min, all balls on the ring [Hz]      2543 | 2695
  along, four contacts a ball [Hz]            3111 | 2695
  across, four contacts a ball [Hz]           2588 | 2245
  largest ball load [N]                      78.09 | 78.09
  axial, 80 and 25 N at 23.6 deg [Hz]         1725 | 1950
  radial [Hz]                                 2712 | 3110
  radial over axial                          1.572 | 1.5915
octave sums of the published bands, and total levels
  serial                  79.59 80
  one large ball          77.26 78
  two, adjacent           77.75 78
  two, 1 ball between     77.74 78
  two, 2 balls between    78.02 78
  two, 3 balls between    77.16 77
  two, 4 balls between    76.89 77
  two, 5 balls between    76.91 77
levels to accelerations [m/s²]: 73.3 dB 0.1433 75 dB 0.1743 78 dB 0.2462 80 dB 0.3100
    90.8 dB 1.0749
equal balls: levels x, y, z 74.4, 74.2, 74.6 dB
  octaves 4 to 8000 Hz, y:  -40  -38  -18    8   44    -    -   62   60   73   65   39
  contacts of a ball 2: 99.8%, 3: 0.2%; 4 changes a turn; 39.0 s
  lines, 9 to 22 Hz: no line
one large ball: levels x, y, z 82.3, 83.6, 81.7 dB
  octaves 4 to 8000 Hz, y:  -11   62   58   54   58   61   65   81   73   75   65   51
  contacts of a ball 2: 92.0%, 3: 8.0%; 10 changes a turn; 19.5 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage
two, adjacent: levels x, y, z 80.2, 79.4, 81.0 dB
  octaves 4 to 8000 Hz, y:    -   63   56   51   59   60   64   75   73   74   64   47
  contacts of a ball 2: 96.1%, 3: 3.9%; 8 changes a turn; 17.8 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage, 22.5 Hz unnamed
two, 1 ball between: levels x, y, z 78.1, 78.1, 81.0 dB
  octaves 4 to 8000 Hz, y:    -   63   50   47   56   58   61   67   75   74   61   42
  contacts of a ball 2: 94.4%, 3: 5.6%; 7 changes a turn; 19.4 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage
two, 2 balls between: levels x, y, z 78.2, 78.4, 79.7 dB
  octaves 4 to 8000 Hz, y:    -   64   45   48   51   57   59   64   76   74   57   24
  contacts of a ball 2: 95.3%, 3: 4.7%; 3 changes a turn; 19.1 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage
two, 3 balls between: levels x, y, z 78.4, 77.9, 79.4 dB
  octaves 4 to 8000 Hz, y:    -   64   38   47   52   55   58   62   73   75   57   33
  contacts of a ball 2: 87.7%, 3: 12.3%; 6 changes a turn; 21.9 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage
two, 4 balls between: levels x, y, z 78.6, 79.0, 80.9 dB
  octaves 4 to 8000 Hz, y:    -   65    -   49   52    -   58   62   71   78   55   26
  contacts of a ball 2: 86.7%, 3: 13.3%; 8 changes a turn; 23.3 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage
two, 5 balls between: levels x, y, z 78.5, 78.5, 78.7 dB
  octaves 4 to 8000 Hz, y:    -   66   43   50   52   55   59   63   75   75   58   22
  contacts of a ball 2: 70.6%, 3: 15.0%, 4: 14.4%; 6 changes a turn; 21.7 s
  lines, 9 to 22 Hz: 10.5 Hz cage, 18.5 Hz unnamed, 21.0 Hz 2 cage
two, 6 between (opposite): levels x, y, z 116.7, 109.9, 112.8 dB
  octaves 4 to 8000 Hz, y:    6   19   72   71   74   78   91  102  107  104   97   89
  contacts of a ball 0: 0.1%, 1: 3.4%, 2: 70.6%, 3: 10.0%, 4: 15.9%; 231 changes a turn;
      20.9 s
  lines, 9 to 22 Hz: 21.0 Hz 2 cage
ring errors alone: x, y, z 74.5, 74.1, 74.6 dB; 28.6 s
balls alone: x, y, z 64.3, 64.3, 23.2 dB; 5.5 s
cage alone: x, y, z 59.9, 83.8, 69.6; cage x, y, round 88.8, 100.9, 97.8 dB; 67.4 s
balls and cage alone: x, y, z 90.4, 92.4, 77.6; cage x, y, round 104.8, 110.3, 103.2 dB;
    38.0 s
all alone: x, y, z 90.4, 92.4, 82.2; cage x, y, round 104.8, 110.5, 103.2 dB; 35.1 s
AF003-  the paper | the model | judged
   1  C = 3.23165e7 N/m at 100 N | 3.23165e+07 N/m | confirmed
   2  2695, 2245 Hz, ratio 1.2004 | 2695, 2244, 1.2011 | confirmed
   3  other modes 11.7 to 17.2 kHz | 11.7 to 17.1 kHz | confirmed
   4  first mode: ring, balls move alike | ring -1.6, ball -0.84 | confirmed
   5  1950, 3110 Hz, ratio 1.5915 | 1725, 2712, 1.572 | ratio confirmed; squares 1.28,
       1.32 times ours: 1.5^(2/3) = 1.31, the paper's own
   6  4.37 W/z: 78.09 N | 78.09 N | confirmed
   7  bands sum to totals within 0.8 dB | 0.74 dB at most | confirmed
   8  0.1433 to 1.0749 m/s² at 73.3 to 90.8 dB | apart by 4e-05 m/s² | confirmed
   9  radial 1, 13, 15, 27, ...; axial 14, 28, 42 | 1, 13, 15, 27, 29, 41, 43; 14, 28,
       42 | confirmed
  10  24 um hardly change 75 dB | 74.2 dB; spread 77.9 to 79.0, one 83.6, adjacent 79.4
      | NOT confirmed
  10  above 3 kHz: near the mean | 54 to 63 dB, 25 dB away at most | NOT confirmed
  11  opposite balls are loudest | two, 6 between (opposite): 110 dB | confirmed
  12  balls enter 3 contacts or leave the inner ring | not 2 contacts: 0.2 % of the time
      of equal balls, 3.9 to 29.4 % of others; changes a turn 4, 3 to 10 | contacts
      confirmed, more changes NOT confirmed
  12  they excite the ring at 2.5-3 kHz | -15 to -4 dB against equal balls | NOT
      confirmed
  13  cage 73.3 up, 90.8 across, 75 round | 110.5, 104.8, 103.2 dB | NOT confirmed
  13  cage ten times the ring (its own 15.8 dB are 6.2) | across over ring up 4.2, over
      ring across 5.2, largest over largest 8.0 times | 6.2 confirmed, ten NOT confirmed
  14  16 Hz band 25 to 46 dB by a large ball | -18 to 38-58 dB; lines 10.5 Hz cage, 18.5
      Hz unnamed, 21.0 Hz 2 cage | confirmed
  15  balls and cage are the main sources | ring errors 74.1, balls 64.3, cage 83.8,
      balls and cage 92.4, all 92.4 dB along y | cage confirmed, balls NOT confirmed
      (waves are scaled)
cage 10.51 Hz, shaft less cage 14.49 Hz
AMD EPYC, 2 cores, load average 2.9; devices: 1 cpu; jax 0.10.1

In short: large balls add 4 to 9 dB, and make 2.5 to 3 kHz no louder; natural
frequencies under combined load are 12 % lower than published; the cage has 103 to 111
dB (published 73 to 91), the ring 4 to 8 times less (published: ten). The goal of 0.2 %
for the ratio under radial load is met.
"""

import dataclasses

import jax
import numpy as np
from bench import benchmark, timed

import bearingjax as bj
from bearingjax.contact import Ellipse
from bearingjax.design import FormErrors, Harmonics, RacewayErrors
from bearingjax.noise import (
    Hann,
    NoiseModel,
    Sensor,
    acceleration_of,
    band_levels,
    combine_levels,
    kinematic_frequencies,
    level,
    name_lines,
    natural_modes,
    octave_bands,
    spectrum,
    vibration,
    waviness_force,
)
from bearingjax.validation import cases as known_cases

MASS, OVERSIZE = 0.3716, 24e-6
SPEED = bj.Speed(inner=1500 * np.pi / 30)
CASES = {
    "equal balls": (),
    "one large ball": (0,),
    "two, adjacent": (0, 1),
    **{f"two, {n} ball{'s' * (n > 1)} between": (0, n + 1) for n in (1, 2, 3, 4, 5)},
    "two, 6 between (opposite)": (0, 7),
}
_LEVELS = known_cases()["kurushin_levels"]
MEASURED = {
    name: (np.array(bands), total)
    for name, bands, total in zip(
        ["serial", *list(CASES)[1:8]],
        _LEVELS.rows["levels"],
        _LEVELS.numbers[1].theirs,
        strict=True,
    )
}
"""Measured level in each octave band, and their printed total, by the arrangement of
large balls [dB]."""
COMMON = {
    "outer_osculation": 0.52,
    "inner_osculation": 0.52,
    "first_azimuth": np.pi / 2,
}
SIZE = 14, 0.0775, 0.014288


def of_ring(found, direction):
    """The mode in which the ring moves most along a direction [Hz]."""
    share = (
        MASS
        * np.asarray(found.ring) ** 2
        * (np.asarray(found.ring_share) > 0.5)[:, None]
    )
    return float(found.frequency[int(np.argmax(share[:, direction]))])


def modes():
    """AF003-2 to 6."""
    deep = bj.BearingElement(bj.DeepGrooveBallBearing(*SIZE, **COMMON))
    still = NoiseModel(deep, MASS, [0, -250.0, 0, 0, 0, 0], bj.Speed(), tilts=False)
    radial = natural_modes(still)
    turning = natural_modes(dataclasses.replace(still, speed=SPEED))
    four = bj.BearingElement(
        bj.FourPointBallBearing(*SIZE, shim_angle=np.radians(26.0), **COMMON)
    )
    four = natural_modes(dataclasses.replace(still, element=four))
    load = bj.solve_load(
        deep,
        [0, -250.0, 0, 0, 0, 0],
        support=bj.Support(fixed_ring="inner", free=("ux", "uy", "uz")),
    )
    angular = bj.AngularContactBallBearing(
        *SIZE, contact_angle=np.radians(23.6), **COMMON
    )
    both = natural_modes(
        dataclasses.replace(
            still, element=bj.BearingElement(angular), load=[0, -25.0, -80.0, 0, 0, 0]
        )
    )
    along, across = of_ring(radial, 1), of_ring(radial, 0)
    axial, radial_too = of_ring(both, 2), of_ring(both, 1)
    frequency = np.asarray(radial.frequency)
    above = frequency[frequency > along * 1.01]
    first = int(np.argmin(np.abs(frequency - along)))
    # The ring presses the ball in the line of the load, whose outwards is y.
    mode = float(radial.ring[first, 1]), float(radial.places[first, 0, 1])
    facts = {
        "along, radial 250 N [Hz]": (along, 2695.0),
        "across [Hz]": (across, 2245.0),
        "their ratio": (along / across, 1.2004),
        "lowest ball mode above [kHz]": (above.min() / 1e3, 11.7),
        "highest [kHz]": (above.max() / 1e3, 17.2),
        "along at 1500 rev/min, all balls on the ring [Hz]": (
            of_ring(turning, 1),
            2695.0,
        ),
        "along, four contacts a ball [Hz]": (of_ring(four, 1), 2695.0),
        "across, four contacts a ball [Hz]": (of_ring(four, 0), 2245.0),
        "largest ball load [N]": (float(np.max(load.roller_load)), 78.09),
        "axial, 80 and 25 N at 23.6 deg [Hz]": (axial, 1950.0),
        "radial [Hz]": (radial_too, 3110.0),
        "radial over axial": (radial_too / axial, 1.5915),
    }
    return facts, mode


def model_of(large):
    deviation = np.zeros(14)
    deviation[list(large)] = OVERSIZE
    bearing = bj.FourPointBallBearing(
        *SIZE,
        shim_angle=np.radians(26.0),
        radial_internal_clearance=40e-6,
        ball_deviation=deviation,
        **COMMON,
    )
    rng = np.random.default_rng(0)

    def waves(amplitude):
        phase = rng.uniform(0, 2 * np.pi, 299)
        return Harmonics.spectrum(2, 300, amplitude, 2.0, phase)

    raceways = [RacewayErrors(axial=waves(SCALE), outwards=waves(SCALE)) for _ in "oi"]
    return NoiseModel(
        bj.BearingElement(bearing),
        MASS,
        [0.0, -25.0, -85.0, 0.0, 0.0, 0.0],
        SPEED,
        FormErrors(*raceways),
        sensor=Sensor(1e4),
        tilts=False,
    )


SCALE = 280e-9
"""Amplitude of the waves of order 2 [m]."""


CAGE_MASS = 0.03
"""Lost in the paper: a ring of duralumin, 5 by 16 mm, less its pockets [kg]."""
CAGE = bj.noise.GuidedCage(
    CAGE_MASS,
    CAGE_MASS * (0.5 * SIZE[1]) ** 2,
    bj.noise.CageContact(film=1e-6),
    pocket_clearance=0.5e-3,
    land_clearance=0.5e-3,
    load=[0.0, -9.81 * CAGE_MASS],
)
SPREAD = "two, 3 balls between"
"""Balls of the runs with a cage: the paper does not say which case its figures are."""
SOURCES = {
    "ring errors": ((), True, False),
    "balls": ((0, 4), False, False),
    "cage": ((), False, True),
    "balls and cage": ((0, 4), False, True),
    "all": ((0, 4), True, True),
}
"""Large balls, whether raceways have waves, whether the cage is free."""


def moved(model, turns, samples):
    """A record, with twice the steps where contacts prove too stiff for 8."""
    for steps in (8, 16, 32):
        found = vibration(
            model, turns=turns, settle=2, samples=samples, steps=steps, throw=False
        )
        if int(found.result) == int(bj.Result.CONVERGED):
            return found
    raise SystemExit(f"not solved: {bj.Result(int(found.result)).label}")


def of_source(large, waves, free):
    """The model with some of its sources of noise."""
    model = model_of(large)
    none = dataclasses.replace(
        model, errors=jax.tree.map(lambda x: 0.0 * x, model.errors)
    )
    return dataclasses.replace(model if waves else none, cage=CAGE if free else None)


def switches(loads):
    """Changes of the number of contacts, of all balls over the record."""
    touching = (np.asarray(loads) > 0).sum(axis=2)
    return int((np.diff(touching, axis=0) != 0).sum()), touching


def within(heard, low, high):
    """Level along y of what lies between two frequencies [dB]."""
    inside = (np.asarray(heard.frequency) >= low) & (np.asarray(heard.frequency) < high)
    power = np.asarray(heard.power)[inside, 1].sum()
    return float(level(np.sqrt(power)))


def by_hand():
    """AF003-1, 7, 8, 9: formulas, tables, and orders of waves that shake a ring."""
    one = np.ones(())
    contact = Ellipse(one, one * 1e10, one, one)
    rate = jax.grad(contact.load)(contact.approach(one * 100.0))
    apart = max(
        abs(float(combine_levels(bands)) - total) for bands, total in MEASURED.values()
    )
    levels = known_cases()["kurushin_accelerations"]
    found = acceleration_of(np.array(levels.inputs["levels"]))
    off = np.asarray(found) - levels.numbers[0].theirs
    bearing = bj.DeepGrooveBallBearing(*SIZE, **COMMON)
    made = {n: waviness_force(bearing, SPEED, "outer", n) for n in range(1, 44)}
    radial = [n for n, found in made.items() if found.radial.size]
    axial = [n for n, found in made.items() if found.axial.size]
    return float(rate), apart, float(np.abs(off).max()), radial, axial


def judged(met):
    return "confirmed" if met else "NOT confirmed"


def judged_claims(facts, mode, cases, sources):
    """AF003-1 to 15: what is said, what the model gives, whether it agrees."""
    rate, apart, off, radial, axial = by_hand()
    along, across, ratio = (facts[k][0] for k in list(facts)[:3])
    lowest, highest = (facts[k][0] for k in list(facts)[3:5])
    largest = facts["largest ball load [N]"][0]
    both = [facts[k][0] for k in list(facts)[-3:]]
    yield (
        "1", "C = 3.23165e7 N/m at 100 N", f"{rate:.6g} N/m",
        judged(abs(rate / 3.23165e7 - 1) < 1e-6),
    )  # fmt: skip
    yield (
        "2", "2695, 2245 Hz, ratio 1.2004", f"{along:.0f}, {across:.0f}, {ratio:.4f}",
        judged(abs(ratio / 1.2004 - 1) < 2e-3),
    )  # fmt: skip
    yield (
        "3", "other modes 11.7 to 17.2 kHz", f"{lowest:.1f} to {highest:.1f} kHz",
        judged(lowest > 10.0),
    )  # fmt: skip
    yield (
        "4", "first mode: ring, balls move alike",
        f"ring {mode[0]:+.2g}, ball {mode[1]:+.2g}", judged(mode[0] * mode[1] > 0),
    )  # fmt: skip
    yield (
        "5", "1950, 3110 Hz, ratio 1.5915",
        f"{both[0]:.0f}, {both[1]:.0f}, {both[2]:.3f}",
        f"ratio {judged(abs(both[2] / 1.5915 - 1) < 0.02)}; squares"
        f" {(1950 / both[0]) ** 2:.2f}, {(3110 / both[1]) ** 2:.2f} times ours:"
        " 1.5^(2/3) = 1.31, the paper's own",
    )  # fmt: skip
    yield (
        "6", "4.37 W/z: 78.09 N", f"{largest:.2f} N",
        judged(abs(largest / 78.09 - 1) < 1e-3),
    )  # fmt: skip
    yield (
        "7", "bands sum to totals within 0.8 dB", f"{apart:.2f} dB at most",
        judged(apart < 0.9),
    )  # fmt: skip
    yield (
        "8", "0.1433 to 1.0749 m/s² at 73.3 to 90.8 dB", f"apart by {off:.0e} m/s²",
        judged(off < 1e-4),
    )  # fmt: skip
    yield (
        "9", "radial 1, 13, 15, 27, ...; axial 14, 28, 42",
        f"{', '.join(map(str, radial))}; {', '.join(map(str, axial))}",
        judged(
            radial == [1, 13, 15, 27, 29, 41, 43] and axial == [14, 28, 42]
        ),
    )  # fmt: skip
    if len(cases) < len(CASES):
        return
    equal = cases["equal balls"]
    spread = [cases[n]["level"][1] for n in list(CASES)[3:8]]
    single, beside = (cases[n]["level"][1] for n in list(CASES)[1:3])
    yield (
        "10", "24 um hardly change 75 dB",
        f"{equal['level'][1]:.1f} dB; spread {min(spread):.1f} to {max(spread):.1f},"
        f" one {single:.1f}, adjacent {beside:.1f}",
        judged(max(*spread, single, beside) - equal["level"][1] < 3.0),
    )  # fmt: skip
    above = [cases[n]["above"] for n in list(CASES)[1:8]]
    means = [cases[n]["level"][1] for n in list(CASES)[1:8]]
    away = np.abs(np.array(above) - means)
    yield (
        "10", "above 3 kHz: near the mean",
        f"{min(above):.0f} to {max(above):.0f} dB, {away.max():.0f} dB away at most",
        judged(away.max() < 6.0),
    )  # fmt: skip
    loudest = max(cases, key=lambda name: cases[name]["level"][1])
    yield (
        "11", "opposite balls are loudest",
        f"{loudest}: {cases[loudest]['level'][1]:.0f} dB",
        judged("opposite" in loudest),
    )  # fmt: skip
    changes = [cases[n]["switches"] for n in list(CASES)[1:8]]
    other = [100.0 * (1.0 - cases[n]["states"][2]) for n in CASES]
    yield (
        "12", "balls enter 3 contacts or leave the inner ring",
        f"not 2 contacts: {other[0]:.1f} % of the time of equal balls,"
        f" {min(other[1:8]):.1f} to {max(other[1:8]):.1f} % of others; changes a turn"
        f" {equal['switches']:.0f}, {min(changes):.0f} to {max(changes):.0f}",
        f"contacts {judged(min(other[1:8]) > 2.0 * other[0])},"
        f" more changes {judged(min(changes) > 2.0 * equal['switches'])}",
    )  # fmt: skip
    rings = [cases[n]["rings"] - equal["rings"] for n in list(CASES)[1:8]]
    yield (
        "12", "they excite the ring at 2.5-3 kHz",
        f"{min(rings):+.0f} to {max(rings):+.0f} dB against equal balls",
        judged(min(rings) > 0),
    )  # fmt: skip
    caged, ring = sources["all"]["cage"], sources["all"]["level"]
    yield (
        "13", "cage 73.3 up, 90.8 across, 75 round",
        f"{caged[1]:.1f}, {caged[0]:.1f}, {caged[2]:.1f} dB",
        judged(abs(caged[1] - 73.3) < 3 and abs(caged[0] - 90.8) < 3),
    )  # fmt: skip
    # The paper divides across by the ring, whose direction it does not say.
    times = [
        10 ** ((x - y) / 20)
        for x, y in (
            (caged[0], ring[1]), (caged[0], ring[0]), (max(caged[:2]), max(ring)),
        )
    ]  # fmt: skip
    yield (
        "13", "cage ten times the ring (its own 15.8 dB are 6.2)",
        "across over ring up {:.1f}, over ring across {:.1f}, largest over largest"
        " {:.1f} times".format(*times),
        f"6.2 {judged(min(times) < 6.2 < max(times))}, ten {judged(min(times) > 9.0)}",
    )  # fmt: skip
    middle = [cases[n]["bands"][2][1] for n in list(CASES)[1:8]]
    yield (
        "14", "16 Hz band 25 to 46 dB by a large ball",
        f"{equal['bands'][2][1]:.0f} to {min(middle):.0f}-{max(middle):.0f} dB; lines"
        f" {cases['one large ball']['lines']}",
        judged(min(middle) > equal["bands"][2][1] + 10.0),
    )  # fmt: skip
    own = {name: sources[name]["level"][1] for name in SOURCES}
    yield (
        "15", "balls and cage are the main sources",
        ", ".join(f"{name} {x:.1f}" for name, x in own.items()) + " dB along y",
        f"cage {judged(own['cage'] > own['ring errors'])},"
        f" balls {judged(own['balls'] > own['ring errors'])} (waves are scaled)",
    )  # fmt: skip


def measured(large, turns, samples):
    """Figures of the bearing with these balls oversize."""
    model = dataclasses.replace(model_of(large))
    seconds, found = timed(lambda: moved(model, turns, samples))
    # Lines of the cage fall between those of whole turns.
    record = found.acceleration, found.duration, found.shaft_frequency
    heard = spectrum(*record, window=Hann())
    rms = np.asarray(found.acceleration).std(axis=0)
    count, touching = switches(found.contact_load)
    lines = name_lines(heard, model.element.bearing, SPEED)
    low = [x for x in lines if 9.0 < x.frequency < 22.5]
    return {
        "level": np.asarray(level(rms)).tolist(),
        "bands": np.asarray(band_levels(heard, octave_bands())).tolist(),
        "states": (np.bincount(touching.ravel(), minlength=5) / touching.size).tolist(),
        "switches": count / turns,
        "seconds": seconds,
        "above": within(heard, 3e3, np.inf),
        "rings": within(heard, 2.5e3, 3e3),
        "lines": ", ".join(f"{x.frequency:.1f} Hz {x.name}" for x in low) or "no line",
    }


def sourced(given, turns, samples):
    """Levels of one source alone."""
    seconds, found = timed(lambda: moved(of_source(*given), turns, samples))
    of_ring = np.asarray(found.acceleration).std(axis=0)
    got = {"level": np.asarray(level(of_ring)).tolist(), "seconds": seconds}
    if found.cage is not None:
        of_cage = np.asarray(found.cage.acceleration).std(axis=0)
        got["cage"] = np.asarray(level(of_cage)).tolist()
    return got


def show(out):
    def listed(numbers):
        return ", ".join(f"{x:.1f}" for x in numbers)

    print("natural frequencies and loads: ours | published")
    for name, (ours, paper) in out["facts"].items():
        print(f"  {name:38s} {ours:9.4g} | {paper:g}")
    print("octave sums of the published bands, and total levels")
    for name, (bands, total) in MEASURED.items():
        print(f"  {name:22s} {float(combine_levels(bands)):6.2f} {total:g}")
    levels = (73.3, 75.0, 78.0, 80.0, 90.8)
    told = (f"{x:g} dB {float(acceleration_of(x)):.4f}" for x in levels)
    print("levels to accelerations [m/s²]:", *told)
    for name, case in out["cases"].items():
        print(f"{name}: levels x, y, z {listed(case['level'])} dB")
        heard = np.array(case["bands"])[:, 1]
        row = " ".join("   -" if np.isnan(x) else f"{x:4.0f}" for x in heard)
        print("  octaves 4 to 8000 Hz, y:", row)
        states = enumerate(case["states"])
        print(
            "  contacts of a ball "
            + ", ".join(f"{k}: {100 * s:.1f}%" for k, s in states if s)
            + f"; {case['switches']:.0f} changes a turn; {case['seconds']:.1f} s"
        )
        print("  lines, 9 to 22 Hz:", case["lines"])
    for name, got in out["sources"].items():
        cage = f"; cage x, y, round {listed(got['cage'])}" if "cage" in got else ""
        said = listed(got["level"]) + cage
        print(f"{name} alone: x, y, z {said} dB; {got['seconds']:.1f} s")
    print("AF003-  the paper | the model | judged")
    for number, paper, ours, judged in out["table"]:
        print(f"  {number:>2s}  {paper} | {ours} | {judged}")
    cage = float(kinematic_frequencies(model_of(()).element.bearing, SPEED).cage)
    print(f"cage {cage:.2f} Hz, shaft less cage {25 - cage:.2f} Hz")


def owed(out):
    """List results that the library misses; claims about noise are the paper's."""
    rows = [row for row in out["table"] if row[0] in "1 2 3 4 6 7 8 9".split()]
    return [row[0] for row in rows if row[3].startswith("NOT")]


@benchmark("one case, one turn", show, wrong=owed)
def main(smoke, turns=64):
    turns, samples = (1, 256) if smoke else (turns, 1024)
    facts, mode = modes()
    few = dict(list(CASES.items())[: 1 if smoke else None])
    cases = {name: measured(large, turns, samples) for name, large in few.items()}
    sources = {
        name: sourced(given, min(turns, 16), samples)
        for name, given in ({} if smoke else SOURCES).items()
    }
    rows = list(judged_claims(facts, mode, cases, sources))
    return {"facts": facts, "cases": cases, "sources": sources, "table": rows}

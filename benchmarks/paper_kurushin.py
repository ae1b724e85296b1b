"""Which claims about the noise of a four-point ball bearing does the model confirm?

Kurushin, Kurushin, Zhilnikov and Murashkin (Vestnik SGAU, 2011): bearing 85-176211D1
with 14 balls of 14.288 mm at 1500 rev/min, 85 N along the axis and 25 N across, the
outer ring on a sensor of 10 N/mm; two balls 24 um larger than the others, at different
distances. Its waviness, conformity, mass of the ring and damping are lost: 0.52, 0.3716
kg (which fits both published frequencies under radial load) and a retardation of 2 us
are assumed, and waves of orders 2 to 60 on both raceways, amplitude falling with the
order, scaled once such that equal balls give about the 75 dB that the paper calculated.
Differences between cases are the model's own. The cage carries the balls evenly.

Run: python benchmarks/paper_kurushin.py [--turns N] [--smoke] [--json]

Last run:
"""

import argparse
import dataclasses
import json

import jax

jax.config.update("jax_enable_x64", True)

import numpy as np  # noqa: E402
from timing import machine, timed  # noqa: E402

import bearingjax as bj  # noqa: E402
from bearingjax.acoustics import (  # noqa: E402
    Hann,
    NoiseModel,
    Sensor,
    acceleration_of,
    band_levels,
    combined,
    kinematic_frequencies,
    level,
    name_lines,
    natural_modes,
    octave_bands,
    spectrum,
    vibration,
)
from bearingjax.acoustics.reference_levels import MEASURED, NORM, TOTAL  # noqa: E402
from bearingjax.design import FormErrors, Harmonics, RacewayErrors  # noqa: E402

MASS, OVERSIZE = 0.3716, 24e-6
SPEED = bj.Speed(inner=1500 * np.pi / 30)
CASES = {
    "equal balls": (),
    "one large ball": (0,),
    "two, adjacent": (0, 1),
    **{f"two, {n} ball{'s' * (n > 1)} between": (0, n + 1) for n in (1, 2, 3, 4, 5)},
    "two, 6 between (opposite)": (0, 7),
}
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
    still = NoiseModel(deep, MASS, [0, -250.0, 0, 0, 0, 0], bj.Speed())
    radial = natural_modes(still)
    turning = natural_modes(dataclasses.replace(still, speed=SPEED))
    load = bj.solve_load(
        deep, [0, -250.0, 0, 0, 0, 0], fixed_ring="inner", free=("ux", "uy", "uz")
    )
    angular = bj.AngularContactBallBearing(
        *SIZE, contact_angle=np.radians(23.6), **COMMON
    )
    both = natural_modes(
        NoiseModel(
            bj.BearingElement(angular), MASS, [0, -25.0, -80.0, 0, 0, 0], bj.Speed()
        )
    )
    along, across = of_ring(radial, 1), of_ring(radial, 0)
    axial, radial_too = of_ring(both, 2), of_ring(both, 1)
    frequency = np.asarray(radial.frequency)
    above = frequency[frequency > along * 1.01]
    return {
        "along, radial 250 N [Hz]": (along, 2695.0),
        "across [Hz]": (across, 2245.0),
        "their ratio": (along / across, 1.2004),
        "lowest ball mode above [kHz]": (above.min() / 1e3, 11.7),
        "highest [kHz]": (above.max() / 1e3, 17.2),
        "along at 1500 rev/min, all balls on the ring [Hz]": (
            of_ring(turning, 1),
            2695.0,
        ),
        "largest ball load [N]": (float(np.max(load.roller_load)), 78.09),
        "axial, 80 and 25 N at 23.6 deg [Hz]": (axial, 1950.0),
        "radial [Hz]": (radial_too, 3110.0),
        "radial over axial": (radial_too / axial, 1.5915),
    }


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
        phase = rng.uniform(0, 2 * np.pi, 59)
        return Harmonics.spectrum(2, 60, amplitude, 1.5, phase)

    raceways = [RacewayErrors(axial=waves(SCALE), outwards=waves(SCALE)) for _ in "oi"]
    return NoiseModel(
        bj.BearingElement(bearing),
        MASS,
        [0.0, -25.0, -85.0, 0.0, 0.0, 0.0],
        SPEED,
        FormErrors(*raceways),
        sensor=Sensor(1e4),
    )


SCALE = 20e-9
"""Amplitude of the waves of order 2 [m]."""


def switches(loads):
    """Changes of the number of contacts, of all balls over the record."""
    touching = (np.asarray(loads) > 0).sum(axis=2)
    return int((np.diff(touching, axis=0) != 0).sum()), touching


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--turns", type=int, default=32)
    parser.add_argument("--smoke", action="store_true")
    parser.add_argument("--json", action="store_true")
    args = parser.parse_args()
    turns, samples = (1, 256) if args.smoke else (args.turns, 1024)
    cases = dict(list(CASES.items())[: 1 if args.smoke else None])
    out = {"facts": modes(), "cases": {}}
    if not args.json:
        print("natural frequencies and loads: ours | published")
        for name, (ours, paper) in out["facts"].items():
            print(f"  {name:38s} {ours:9.4g} | {paper:g}")
        print("octave sums of the published bands, and total levels")
        for name, bands in (("serial", NORM), *MEASURED.items()):
            print(
                f"  {name:22s} {float(combined(np.array(bands))):6.2f} {TOTAL[name]:g}"
            )
        print(
            "levels to accelerations [m/s²]:",
            *(
                f"{x:g} dB {float(acceleration_of(x)):.4f}"
                for x in (73.3, 75.0, 78.0, 80.0, 90.8)
            ),
        )
    bands = octave_bands()
    base = model_of(())
    for name, large in cases.items():
        model = dataclasses.replace(model_of(large))
        seconds, found = timed(
            lambda model=model: vibration(
                model, turns=turns, settle=2, samples=samples, steps=8
            )
        )
        record = found.acceleration, found.duration, found.shaft_frequency
        # Lines of the cage fall between those of whole turns.
        heard = spectrum(*record, window=Hann())
        levels = np.asarray(band_levels(heard, bands))
        rms = np.asarray(found.acceleration).std(axis=0)
        count, touching = switches(found.contact_load)
        states = np.bincount(touching.ravel(), minlength=5) / touching.size
        out["cases"][name] = {
            "level": np.asarray(level(rms)).tolist(),
            "bands": levels.tolist(),
            "states": states.tolist(),
            "switches": count / turns,
            "seconds": seconds,
        }
        if args.json:
            continue
        print(
            f"{name}: levels x, y, z "
            + ", ".join(f"{x:.1f}" for x in level(rms))
            + " dB"
        )
        row = " ".join("   -" if np.isnan(x) else f"{x:4.0f}" for x in levels[:, 1])
        print("  octaves 4 to 8000 Hz, y:", row)
        shown = ", ".join(f"{k}: {100 * s:.1f}%" for k, s in enumerate(states) if s)
        print(
            f"  contacts of a ball {shown}; {count / turns:.0f} changes a turn;"
            f" {seconds:.1f} s"
        )
        lines = name_lines(heard, model.element.bearing, SPEED)
        low = [x for x in lines if 9.0 < x.frequency < 22.5]
        print(
            "  lines, 9 to 22 Hz:",
            ", ".join(f"{x.frequency:.1f} Hz {x.name}" for x in low) or "no line",
        )
    if not args.json:
        k = kinematic_frequencies(base.element.bearing, SPEED)
        print(
            f"cage {float(k.cage):.2f} Hz, shaft less cage {25 - float(k.cage):.2f} Hz"
        )
        print(machine())
    else:
        print(json.dumps(out))


if __name__ == "__main__":
    main()

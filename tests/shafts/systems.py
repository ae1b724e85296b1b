"""Systems of shafts that several tests share."""

import numpy as np

import bearingjax as bj
from bearingjax.shafts import (
    Drive,
    Gear,
    HousingStiffness,
    Seat,
    ShaftLine,
    ShaftSystem,
)

BALL = bj.DeepGrooveBallBearing(
    8, 0.065, 0.015081, outer_osculation=0.53, inner_osculation=0.52,
    radial_internal_clearance=1e-5,
)  # fmt: skip
ELEMENT = bj.BearingElement(BALL)
STIFF = np.array([1e11, 1e11, 1e11, 0.0, 0.0])


def ball(name, shaft, position, **more):
    return Seat(name, shaft, position, bj.Installed(ELEMENT), **more)


def springs(name, shaft, position, stiffness=STIFF, **more):
    return Seat(name, shaft, position, stiffness=stiffness, **more)


def stage(seats=springs, housing=None, gravity=(0.0, 0.0, 0.0), **gear):
    """A helical stage: pinion and wheel on two shafts that are apart by their pitch
    circles, driven at the first."""
    helix = {"helix_angle": np.deg2rad(15.0)}
    pinion = Gear("pinion", "in", 0.1, 23, 4e-3, hand="right", **helix, **gear)
    wheel = Gear(
        "wheel",
        "out",
        0.12,
        68,
        4e-3,
        hand="left",
        mates_with="pinion",
        **helix,
        **gear,
    )
    apart = float(pinion.radius + wheel.radius)
    across = apart * np.array([np.cos(0.7), np.sin(0.7)])
    shafts = [
        ShaftLine(
            "in", [0.06, 0.16, 0.04], [0.04, 0.048, 0.04], origin=(0.0, 0.0, 0.0)
        ),
        ShaftLine("out", [0.3], [0.06], origin=(*across, -0.02)),
    ]
    places = [("A", "in", 0.04), ("B", "in", 0.24), ("C", "out", 0.03)]
    places.append(("D", "out", 0.27))
    if housing is not None:
        housing = HousingStiffness.of_seats(dict.fromkeys("ABCD", housing))
    return ShaftSystem(
        shafts,
        [seats(*place) for place in places],
        Drive("in", 155.0, power=22e3),
        [pinion, wheel],
        housing=housing,
        gravity=gravity,
    )


def three_bearings(load, kind=ball, **more):
    """A stepped shaft on three bearings under a free load: statically indeterminate."""
    line = ShaftLine("s", [0.15, 0.25, 0.1], [0.04, 0.05, 0.04])
    seats = [kind(n, "s", z) for n, z in (("A", 0.05), ("B", 0.25), ("C", 0.45))]
    return ShaftSystem(line, seats, loads=load, **more)

"""Rotors that several tests share, so that their programs are compiled once."""

import numpy as np

import bearingjax as bj

STEEL = bj.Material(211e9, 211.0 / (2.0 * 81.2) - 1.0, 7810.0)
"""Of the examples in Friswell's book, and of ROSS: G = 81.2 GPa."""


def friswell(kxx=1e6, kyy=0.8e6, damping=0.0, material=STEEL):
    """Two discs on a shaft of 1.5 m, examples 5.9.1 to 5.9.5 of Friswell et al.,
    Dynamics of Rotating Machines (2010), as the tests of ROSS have them too."""
    shaft = bj.rotor.Shaft(0.25 * np.arange(7), 0.05, material=material)
    discs = [
        bj.rotor.Disc.of_size(2, 0.28, 0.07, 0.05, material),
        bj.rotor.Disc.of_size(4, 0.35, 0.07, 0.05, material),
    ]
    supports = [
        bj.rotor.LinearSupport(k, [kxx, kyy, 0, 0, 0], [damping, damping, 0, 0, 0])
        for k in (0, 6)
    ]
    return bj.rotor.Rotor(shaft, discs, supports)


def paper(radial, axial, damping=None, rigid=True):
    """The rotor of Filipkovskii and Belomyttsev (2014) on linear supports."""
    shaft = bj.rotor.Shaft(
        [0.0, 0.125, 0.5], 0.025, material=bj.Material(2.1e11, 0.3, 7850)
    )
    supports = [bj.rotor.LinearSupport.isotropic(k, radial, axial) for k in (0, 2)]
    return bj.rotor.Rotor(
        shaft, [bj.rotor.Disc(1, 10.0, 0.2, 0.1)], supports, damping, rigid=rigid
    )


def stepped(
    bore=0.01, place=0.17, stiffness=2e7, damping=300.0, polar=0.02, housing=5e7
):
    """A hollow stepped shaft, one support with cross terms, one in a housing."""
    base = bj.rotor.Housing(
        4.0, [housing, 0.7 * housing, housing], [200.0, 300.0, 100.0]
    )
    k = np.diag([1.0, 0.8, 0.5, 2e-4, 2e-4])
    k[0, 1], k[1, 0] = 0.1, -0.05
    k[0, 4] = k[4, 0] = 3e-3
    return bj.rotor.Rotor(
        bj.rotor.Shaft([0.0, place, 0.4], [0.05, 0.03], bore, STEEL, (2, 3)),
        [bj.rotor.Disc(1, 6.0, polar, 0.012), bj.rotor.PointMass(2, 0.5)],
        [
            bj.rotor.LinearSupport(
                0, k * stiffness, damping * np.diag([1, 1, 0.5, 0, 0])
            ),
            bj.rotor.LinearSupport.isotropic(
                2, 1e7, 1e6, radial_damping=100.0, housing=base
            ),
        ],
        bj.rotor.ProportionalDamping(1.0, 1e-6),
    )


def bearing(free, outer):
    """The bearing of method 002, from its drawing."""
    conformity = 5.93 / 11.51
    return bj.AngularContactBallBearing(
        7,
        1e-3 * (16.0 + outer),
        11.51e-3,
        outer_osculation=conformity,
        inner_osculation=conformity,
        contact_angle=np.radians(free),
        material=bj.Material(2.1e11, 0.3, 7850.0),
    )

"""How far may barrel rollers travel, or their rings lean, in linearised kinematics?

A spherical roller bearing (22220 class, 40 kN across its axis) and a toroidal one
(60 kN): the inner ring is moved along the axis and held there, or leant in the plane of
the load; the leaning spherical one finds its place along the axis. Errors of
`Linearised` against `Finite`, which is exact: of the axial force over the larger of it
and a tenth of the load, and of the largest roller load. Beside them what `travel_error`
states of the linearised answer alone, and whether a warning comes of it (above 3 %).

README: spherical: axial force 3.2 % off at 0.5 mm, 5.0 % at 0.8 mm; largest load 3.7 %
at 1°, 14.5 % at 3° | warned above 3 % | **missed** at 0.5 mm

Last run:

               travel    tilt    error, % of            stated
    bearing        mm     deg    axial  largest load         %  warned
    spherical    0.05    0.00    -0.17          0.11      0.26  no
    spherical    0.10    0.00    -0.39          0.09      0.53  no
    spherical    0.20    0.00    -1.40         -0.22      1.15  no
    spherical    0.35    0.00    -2.37         -0.70      2.04  no
    spherical    0.50    0.00    -3.21         -0.98      2.89  no
    spherical    0.80    0.00    -4.98         -1.62      4.57  yes
    spherical    0.00    0.10    -0.00          0.75      0.49  no
    spherical    0.00    0.25    -0.00          1.25      1.18  no
    spherical    0.00    0.50     0.00         -0.46      2.32  no
    spherical    0.01    1.00     0.00         -3.70      4.62  yes
    spherical    0.01    2.00     0.00         -9.47      9.21  yes
    spherical    0.02    3.00    -0.00        -14.49     13.80  yes
    toroidal     0.50    0.00    -0.69          0.10      0.44  no
    toroidal     1.00    0.00    -1.37          0.38      1.64  no
    toroidal     2.00    0.00    -2.75          1.54      6.34  yes
    toroidal     4.00    0.00    -5.62          6.93     24.86  yes
    toroidal     8.00    0.00   -22.06         16.21     98.45  yes
    toroidal     0.00    0.10     1.02          0.14      1.17  no
    toroidal     0.00    0.25     2.55          0.86      6.94  yes
    toroidal     0.00    0.50     5.11          3.52     27.26  yes
    toroidal     0.00    1.00    10.22         16.35    108.02  yes

Goal: a warning wherever an error exceeds 3 %; met but at 0.5 mm of the spherical
bearing (3.2 %). Of the toroidal bearing 6 times the error of the largest load is stated
where a ring leans by 1 degree or travels by 8 mm.
"""

import equinox as eqx
import numpy as np
from bench import benchmark, table

import bearingjax as bj
from bearingjax.statics.warning_sizes import travel_error

DEGREE = np.pi / 180


def designs():
    """Bearing, load across the axis [N], travels [m], tilts [rad]."""
    spherical = bj.BearingSet.self_aligning(
        bj.SphericalRollerRow(
            18,
            0.1376,
            0.0215,
            0.0185,
            contact_angle=9.5 * DEGREE,
            roller_profile_radius=0.078,
            inner_raceway_radius=0.0805,
            radial_internal_clearance=20e-6,
        )
    )
    toroidal = bj.ToroidalRollerBearing(
        20,
        0.140,
        0.0195,
        0.030,
        roller_profile_radius=0.4074,
        outer_raceway_radius=0.42,
        inner_raceway_radius=0.42,
        radial_internal_clearance=40e-6,
    )
    return {
        "spherical": (
            spherical,
            40e3,
            1e-3 * np.array([0.05, 0.1, 0.2, 0.35, 0.5, 0.8]),
            DEGREE * np.array([0.1, 0.25, 0.5, 1.0, 2.0, 3.0]),
        ),
        "toroidal": (
            toroidal,
            60e3,
            1e-3 * np.array([0.5, 1.0, 2.0, 4.0, 8.0]),
            DEGREE * np.array([0.1, 0.25, 0.5, 1.0]),
        ),
    }


@eqx.filter_jit
def solve(element, load, travel, tilt):
    """`travel` is None where the ring is free along the axis."""
    held = {"gx": tilt, "gy": 0.0}
    if travel is not None:
        held["uz"] = travel
    return bj.solve_load(
        element,
        [0.0, -load, 0.0, 0.0, 0.0, 0.0],
        support=bj.Support(
            free=("ux", "uy", "uz")[: 2 + (travel is None)], prescribed=held
        ),
        options=bj.statics.SolveOptions(points=3),
        throw=False,
    )


def run(smoke=False):
    for name, (bearing, load, travels, tilts) in designs().items():
        free = None if name == "spherical" else 0.0
        places = [(u, 0.0) for u in travels] + [(free, t) for t in tilts]
        for travel, tilt in places[:: 5 if smoke else 1]:
            linear, exact = (
                solve(
                    bj.BearingElement(bearing, kinematics=kinematics),
                    *(
                        None if v is None else np.asarray(v)
                        for v in (load, travel, tilt)
                    ),
                )
                for kinematics in (bj.element.Linearised(), bj.element.Finite())
            )
            axial = [float(s.force[8]) for s in (linear, exact)]
            most = [float(np.max(s.roller_load)) for s in (linear, exact)]
            told = any("travel along barrel rollers" in w for w in bj.warnings(linear))
            yield {
                "design": name,
                "travel_mm": 1e3 * float(exact.displacement[8]),
                "tilt_deg": tilt / DEGREE,
                "codes": [int(linear.result), int(exact.result)],
                "axial_error": (axial[0] - axial[1]) / max(abs(axial[1]), 0.1 * load),
                "largest_load_error": most[0] / most[1] - 1.0,
                "stated": float(travel_error(linear)),
                "warned": told,
            }


def show(rows):
    percent = {"axial": "axial_error", "largest load": "largest_load_error"}
    columns = {"bearing": "{design}", "travel, mm": "{travel_mm:.2f}",
               "tilt, deg": "{tilt_deg:.2f}"}  # fmt: skip
    columns |= {f"{k}, % off": f"{{{v}:.2%}}" for k, v in percent.items()}
    table(rows, columns | {"stated": "{stated:.2%}", "warned": "{warned}",
                           "codes": "{codes}"})  # fmt: skip


@benchmark("a few places", show)
def main(smoke):
    return run(smoke)

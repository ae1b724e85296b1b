"""The bearing as an element: one energy, its equilibrium and its derivatives.

`BearingElement(bearing, ...)` is a pure function of the ring displacements q (12) and,
if given, of speeds: `energy`, `force` = dV/dq, `stiffness` = its derivative, `evaluate`
all of them. For your own equations of motion M a = F - f:

    function, parameters = element.as_function(speed, damping=500.0)  # N s/m, yours
    f = jax.jit(function)(motion, velocity, time, parameters)

Its rolling elements orbit with time, so that it shakes at their pass frequency; it goes
through Diffrax, and traces once for all bearings of one structure. Nothing damps unless
you say so. An integrator that carries the rolling elements along solves them from where
they were: `force, near = function(motion, velocity, t, parameters, near)`, first with
`near = element.nothing_near(speed)`. So do `element.force(q, near=near,
with_near=True)`, `stiffness` and `evaluate`.

Which numerics?
---------------

- Quadrature along rollers: `ContactMapped(32)` (default): nodes follow the loaded zone,
  worst error 1e-8 in force and stiffness; 16 nodes give 3e-6. Measured profiles
  (`Tabulated`) are integrated from point to point, every high spot: 1e-6.
  `Midpoint(n)`: the customary slices, to compare with other codes; when a zone ends
  inside the roller 30 slices err by 1e-3 in force and 3e-2 in stiffness (median; worst
  7e-2 and 1e-1).
- Equilibrium of rollers: `TrustRegionNewton()` (default) never failed in a million
  random rollers. `BFGS()`, the method of the energy paper, takes two to three times the
  steps.
- Kinematics: `Linearised()` (default) is convex, rings balance; right for the tilts
  that bearings bear. `ConstantAngle()`: balls at rest whose contact angle no load
  changes, as in catalogues and reduced models; a single row then resists no tilt about
  its pressure centre (prescribe gx, gy). `Finite()`: rings of ball bearings turn by any
  angle, what self-aligning bearings have; balls stay in the axial sections of the
  untilted outer ring (at 0.04 rad energy is off by 0.26 %, axial force by 4 %). Of
  rollers the paper's formula, to compare: may meet a saddle, and says so.
- Ball contacts: `FreeAngle()` (default): exact Hertz constants, curvatures at the free
  contact angle; forces have a potential. `ZeroAngle()` as ISO/TS 16281;
  `OperatingAngle()`: curvatures that follow the load. `PointConstant(outer, inner)` for
  your own.
- Turning balls: `OuterControl()` (default), `InnerControl()`, `EqualShare()`,
  `LoadShare()`: where the ball does not spin, and which raceway takes the gyroscopic
  moment. `FrictionLimited(0.06)`: shared by load, no more than friction can hold.
  `CentrifugalOnly()`: no gyroscopic moment, the orbit of the free contact angle,
  symmetric stiffness; `OperatingCentrifugal()` that of the operating contact angles.
- Line law: `Palmgren()` (default), `ISO16281()`: 3.8 % apart; never mix them.
  `LineConstant(c)` for your own. `CoupledSlices()`: slices that press on each other,
  loads within half a hundredth of the half-space where independent slices are off by a
  twelfth (medians; worst 4 and 27 hundredths), line loads that rise towards a sharp
  end; a load solve takes 63 times as long (benchmarks/coupled_slices.py).

Faster
------

Jit the loop around the element, with the element closed over
(`jax.jit(element.force)`): its contact constants are then worked out once. If the
design is traced, work them out before the loop: `model = element.model(speed)`, then
`model.force(q)`. Many cases: `bearingjax.sweep`; in a program of your own
`jax.lax.map(..., batch_size=256)`: there rolling elements wait in a queue, not for each
other. Many small calls, one after the other, as in an integrator:
`jax.config.update("jax_cpu_enable_async_dispatch", False)` before all else saves the
hand-over between threads, half of the time of a call (benchmarks/single_call.py
--inline). What a scene lacks (ribs, speed) is not compiled.

Names
-----

- The bearing: `BearingElement`, `BearingModel`, `BearingResponse`, `Speed`.
- As a function of time: `orbiting_force`, `ring_force`, `FunctionParameters`.
- Kinematics: `Linearised`, `Finite`, `ConstantAngle`, `AbstractKinematics`.
- Turning balls: `OuterControl`, `InnerControl`, `EqualShare`, `LoadShare`,
  `FrictionLimited`, `CentrifugalOnly`, `OperatingCentrifugal`,
  `AbstractRacewayControl`, `ball_kinematics`, `BallKinematics`, `ball_mass`.
- Rolling elements of a row: `azimuths`, `roller_speeds`, `inertia_load`, `Row`,
  `RowResults`.
- Parents of your own rolling elements: `AbstractRollingElement`, `AbstractChoices`,
  `choices_for`, `contact_energy`, `RingMotion`.
- Names along axes: `FREEDOMS`, `LOADS`, `RINGS`.
"""

from .azimuth import azimuths
from .balls.ball_speed import (
    AbstractRacewayControl,
    BallKinematics,
    CentrifugalOnly,
    EqualShare,
    FrictionLimited,
    InnerControl,
    LoadShare,
    OperatingCentrifugal,
    OuterControl,
    ball_kinematics,
    ball_mass,
)
from .bearing_element import BearingElement
from .bearing_model import BearingModel, BearingResponse
from .choices import AbstractChoices, choices_for
from .frame import FREEDOMS, LOADS, RINGS
from .function import FunctionParameters, orbiting_force, ring_force
from .inertia import Speed, roller_speeds
from .kinematics import AbstractKinematics, ConstantAngle, Finite, Linearised
from .rolling_element import AbstractRollingElement, RingMotion, contact_energy
from .row import Row
from .solved_row import RowResults, inertia_load

__all__ = [
    "BearingElement", "BearingModel", "BearingResponse", "Speed", "orbiting_force",
    "ring_force", "FunctionParameters", "Linearised", "Finite", "ConstantAngle",
    "AbstractKinematics", "OuterControl", "InnerControl", "EqualShare", "LoadShare",
    "FrictionLimited", "CentrifugalOnly", "OperatingCentrifugal",
    "AbstractRacewayControl", "ball_kinematics", "BallKinematics", "ball_mass",
    "azimuths", "roller_speeds", "inertia_load", "Row", "RowResults",
    "AbstractRollingElement", "AbstractChoices", "choices_for", "contact_energy",
    "RingMotion", "FREEDOMS", "LOADS", "RINGS",
]  # fmt: skip

"""The bearing of Han & Chu (2015), as far as it is known.

Its table is lost: sizes are a surrogate (D = 12.7 mm, d_m = 53.285 mm, 12 balls, both
osculations 0.52), which has the ratio γ = 0.238339 that follows from the text.
"""

import numpy as np

import bearingjax as bj
from bearingjax.element.balls.ball_speed import EqualShare
from bearingjax.element.inertia import Speed
from bearingjax.lubrication import mil_l_23699
from bearingjax.skid import SkidModel

DIAMETER, PITCH_DIAMETER = 0.0127, 0.053285
OIL_TEMPERATURE = 303.15
BEARING = bj.AngularContactBallBearing(
    12,
    PITCH_DIAMETER,
    DIAMETER,
    outer_osculation=0.52,
    inner_osculation=0.52,
    contact_angle=np.radians(25.0),
    material=bj.Material(206e9, 0.3, 7850.0),
)
ELEMENT = bj.BearingElement(BEARING, raceway_control=EqualShare())
MODEL = SkidModel(ELEMENT, mil_l_23699(), OIL_TEMPERATURE)
SPEED = Speed(inner=209.4395)
FREE = ["ux", "uy", "uz", "gx", "gy"]

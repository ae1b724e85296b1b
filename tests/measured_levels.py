"""Measured levels of a four-point ball bearing with large balls.

Bearing 85-176211D1 (55 x 100 x 21 mm, 14 balls of 14.288 mm) at 1500 rev/min on the rig
KVP-104, with no ball, one ball or two balls 24 µm larger than the others. Levels are
counted from 0.31e-4 m/s².

Source: Kurushin, Kurushin, Zhilnikov, Murashkin, Vestnik SGAU (2011), table 2.
"""

MEASURED = {
    "one large ball": (
        *(23.0, 25.0, 46.0, 47.0, 42.0, 49.0),
        *(50.0, 54.0, 61.0, 68.0, 74.0, 73.0),
    ),
    "two, adjacent": (
        *(23.0, 25.0, 47.0, 45.0, 40.0, 49.0),
        *(50.0, 52.0, 61.0, 68.0, 75.0, 73.0),
    ),
    "two, 1 ball between": (
        *(22.0, 27.0, 47.0, 44.0, 43.0, 48.0),
        *(50.0, 54.0, 61.0, 71.0, 74.0, 73.0),
    ),
    "two, 2 balls between": (
        *(24.0, 27.0, 45.0, 47.0, 43.0, 50.0),
        *(50.0, 54.0, 61.0, 70.0, 75.0, 73.0),
    ),
    "two, 3 balls between": (
        *(25.0, 27.0, 34.0, 49.0, 41.0, 48.0),
        *(51.0, 55.0, 64.0, 69.0, 74.0, 72.0),
    ),
    "two, 4 balls between": (
        *(25.0, 26.0, 43.0, 50.0, 44.0, 49.0),
        *(52.0, 59.0, 66.0, 69.0, 73.0, 72.0),
    ),
    "two, 5 balls between": (
        *(26.0, 25.0, 51.0, 49.0, 44.0, 51.0),
        *(53.0, 60.0, 67.0, 70.0, 73.0, 71.0),
    ),
}
"""Measured level in each octave band, by the arrangement of large balls [dB]."""

TOTAL = {
    "serial": 80.0,
    "one large ball": 78.0,
    "two, adjacent": 78.0,
    "two, 1 ball between": 78.0,
    "two, 2 balls between": 78.0,
    "two, 3 balls between": 77.0,
    "two, 4 balls between": 77.0,
    "two, 5 balls between": 77.0,
}
"""Measured total level of a series bearing, and of those with large balls [dB].

The octave bands of the norm sum to that of the series, 79.6 dB.
"""

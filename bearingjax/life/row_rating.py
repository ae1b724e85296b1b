"""Load ratings of one row, or of several alike, by the formulas of ISO 281 and ISO 76.

All from plain numbers, so that a row may be rated before it is a bearing. The standards
print f_c and f_0 as tables; here they follow from the formulas and the definition that
the tables were made by, and agree with them to the last printed digit.

Source: dynamic: ISO 281:2007, with f_c by the formulas of ISO/TR 1281-1 (Lundberg &
    Palmgren 1947, 1952); static: ISO 76:2006, with f_0 from its definition, the load
    at which the hardest contact has a given peak pressure, by exact Hertz contact.
"""

import math
from typing import Annotated, NamedTuple

import jax
import jax.numpy as jnp

from ..contact.hertz import ellipse
from ..numerics.types import Flag, Number, Scalar
from ..numerics.units import unit

_PER_MM = 1e3
"""Millimetres in a metre: the factors of the standards are made for mm and N."""

_MODULUS = 0.5 * 2.07e11 / (1.0 - 0.3**2)
"""Contact modulus of the steel that ISO 76 counts with, 207 GPa and 0.3 [Pa]."""

THRUST_ANGLE = 0.25 * math.pi
"""Nominal contact angle above which a bearing is a thrust bearing [rad] (ISO 281)."""

_FATIGUE_PRESSURE = 1500e6
"""Peak pressure of a contact at the fatigue limit [Pa] (ISO 281:2007, annex B)."""

_LARGE_BALL = 25.4
"""Diameter above which a ball's rating grows more slowly [mm]."""


class BallKind(NamedTuple):
    """Constants of the standards for one type of ball bearing.

    Attributes:
        reduction: λ of f_c [1].
        counted: Osculations, outer and inner, from which f_c is computed [1]; `None`:
            a sphere about the centre of the bearing.
        open: Osculations up to which the table of f_c holds, and from which f_0 is
            computed [1].
        stress: Peak pressure under the static rating [Pa].
    """

    reduction: Annotated[Number, unit("1")]
    counted: Annotated[tuple[Number | None, Number], unit("1")]
    open: Annotated[tuple[Number | None, Number], unit("1")]
    stress: Annotated[Number, unit("Pa")]


ANGULAR_CONTACT = BallKind(0.95, (0.52, 0.52), (0.53, 0.52), 4200e6)
"""Also one row of a deep groove bearing."""
RADIAL_CONTACT_ROWS = ANGULAR_CONTACT._replace(reduction=0.90)
SELF_ALIGNING = BallKind(1.0, (None, 0.53), (None, 0.53), 4600e6)
THRUST = BallKind(0.90, (0.535, 0.535), (0.54, 0.54), 4200e6)


Capacity = tuple[Scalar, Scalar, Scalar]


class BallRow(NamedTuple):
    """Numbers of one row of balls.

    Attributes:
        n_elements: Balls in the row.
        diameter: Ball diameter [m].
        pitch_diameter: Pitch diameter [m].
        contact_angle: Nominal contact angle [rad].
        osculation: Outer (`None`: a sphere) and inner [1].
    """

    n_elements: Scalar | int
    diameter: Annotated[Scalar, unit("m")]
    pitch_diameter: Annotated[Scalar, unit("m")]
    contact_angle: Annotated[Scalar, unit("rad")]
    osculation: Annotated[tuple[Number | None, Number], unit("1")]

    @property
    def power(self) -> float:
        """Power of the number of rows in C [1]."""
        return 0.7

    @property
    def limit(self) -> tuple[float, float]:
        """C0 over C_u, and the power by which it grows with the pitch diameter [1]."""
        return 22.0, 0.5

    def capacity(self, rows: "Rows", is_thrust: bool, axial: Flag) -> Capacity:
        """C of radial and steep rows, and C0 of an element [N].

        Args:
            rows, is_thrust: As in `capacities`.
            axial: Whether the rows are rated axially.
        """
        kind = rows.kind
        assert kind is not None
        if kind.open[0] is not None:
            # Only self-aligning bearings have other raceways when steep.
            pairs = THRUST, kind
            kind = jax.tree.map(lambda a, b: jnp.where(axial, a, b), *pairs)
        rate = thrust_ball_dynamic if is_thrust else steep_ball_dynamic
        dynamic = radial_ball_dynamic(self, kind, rows.n_rows)
        return dynamic, rate(self, kind, rows.one_way), ball_static(self, kind)


class RollerRow(NamedTuple):
    """Numbers of one row of rollers.

    Attributes:
        n_elements: Rollers in the row.
        diameter: Mean roller diameter [m].
        length: Effective length [m].
        pitch_diameter: Pitch diameter [m].
        contact_angle: Nominal contact angle [rad].
        quality: b_m of the type, for today's material and manufacture [1].
    """

    n_elements: Scalar | int
    diameter: Annotated[Scalar, unit("m")]
    length: Annotated[Scalar, unit("m")]
    pitch_diameter: Annotated[Scalar, unit("m")]
    contact_angle: Annotated[Scalar, unit("rad")]
    quality: Annotated[Number, unit("1")] = 1.1

    @property
    def power(self) -> float:
        """Power of the number of rows in C [1]."""
        return 7.0 / 9.0

    @property
    def limit(self) -> tuple[float, float]:
        """C0 over C_u, and the power by which it grows with the pitch diameter [1]."""
        return 8.2, 0.3

    def capacity(self, rows: "Rows", is_thrust: bool, axial: Flag) -> Capacity:
        """C of radial and steep rows, and C0 of an element [N].

        Args: as `BallRow.capacity`.
        """
        dynamic = radial_roller_dynamic(self, rows.n_rows)
        return dynamic, steep_roller_dynamic(self, rows.one_way), roller_static(self)


class Rows(NamedTuple):
    """Alike rows as numbers, so that all bearings of a type share one program.

    Attributes:
        row: One of them.
        kind: Constants of the standards for their type; `None` for rollers.
        n_rows: Number of rows.
        one_way: Number of rows that share an axial load: the weaker of two sides.
    """

    row: BallRow | RollerRow
    kind: BallKind | None
    n_rows: Scalar
    one_way: Scalar


def capacities(rows: Rows, is_thrust: bool) -> tuple[Scalar, Scalar]:
    """Basic load ratings C and C0 of alike rows, radial or axial [N].

    Args:
        rows: The rows.
        is_thrust: Whether they are of a thrust bearing; of balls at 90 degrees. Static.
    """
    row, angle = rows.row, rows.row.contact_angle
    axial = is_thrust | (angle > THRUST_ANGLE)
    dynamic, steep, load = row.capacity(rows, is_thrust, axial)
    radial = 0.2 * rows.n_rows * jnp.cos(angle)
    share = jnp.where(axial, rows.one_way * jnp.sin(angle), radial)
    return jnp.where(axial, steep, dynamic), row.n_elements * load * share


def radial_ball_dynamic(row: BallRow, kind: BallKind, rows: Scalar | int) -> Scalar:
    """Basic dynamic radial load rating of alike rows of balls [N].

    C = 1.3 f_c (i cos α)^0.7 Z^(2/3) D^1.8, D^1.4 25.4^0.4 for balls above 25.4 mm.

    A groove more open than the table of f_c allows reduces C as f_c by its formula; a
    closer one does not raise it. C is smooth but where a groove comes to this limit, or
    a ball to 25.4 mm.

    Args:
        row: One of the rows.
        kind: The type of bearing.
        rows: Their number i.
    """
    factor = 0.41 * _ball_factor(row, kind, 1.04)
    return factor * (rows * jnp.cos(row.contact_angle)) ** 0.7 * _balls(row)


def steep_ball_dynamic(row: BallRow, kind: BallKind, rows: Scalar | int) -> Scalar:
    """Basic dynamic axial load rating of alike rows at 45 to below 90 degrees [N].

    C = 1.3 f_c (i cos α)^0.7 tan α Z^(2/3) D^1.8; large balls and open grooves as of
    `radial_ball_dynamic`. Rows count that carry the load together.
    """
    angle = row.contact_angle
    factor = (1 - jnp.sin(angle) / 3) * _ball_factor(row, kind, 1.0)
    along = (rows * jnp.cos(angle)) ** 0.7 * jnp.tan(angle)
    return factor * along * _balls(row)


def thrust_ball_dynamic(row: BallRow, kind: BallKind, rows: Scalar | int) -> Scalar:
    """Basic dynamic axial load rating of alike rows of balls, at 90 degrees [N].

    C = 1.3 f_c i^0.7 Z^(2/3) D^1.8, else as `steep_ball_dynamic`.
    """
    gamma = row.diameter / row.pitch_diameter
    raceways = _raceways(row, kind, 1.0, gamma) * gamma**0.3
    factor = 1.3 * 98.0665 * kind.reduction * (1 - 1 / 3) * raceways
    return factor * rows**0.7 * _balls(row)


def radial_roller_dynamic(row: RollerRow, rows: Scalar | int) -> Scalar:
    """Basic dynamic radial load rating of alike rows of rollers [N].

    C = b_m f_c (i L cos α)^(7/9) Z^(3/4) D^(29/27).
    """
    size = row.diameter / row.pitch_diameter
    factor = _roller_factor(row, 0.377 * 0.83, 1.04) * size ** (2 / 9)
    return factor * jnp.cos(row.contact_angle) * _rollers(row, rows)


def steep_roller_dynamic(row: RollerRow, rows: Scalar | int) -> Scalar:
    """Basic dynamic axial load rating of alike rows of rollers, 45 to 90 degrees [N].

    C = b_m f_c (i L cos α)^(7/9) tan α Z^(3/4) D^(29/27), at 90 degrees
    b_m f_c (i L)^(7/9) Z^(3/4) D^(29/27) with f_c = 293.1 (D/D_pw)^(2/9). The cosines
    of f_c and of the length make one formula of both: sin α in place of tan α.
    """
    sine, size = jnp.sin(row.contact_angle), row.diameter / row.pitch_diameter
    factor = _roller_factor(row, 0.73 * (1 - 0.15 * sine), 1.0) * size ** (2 / 9)
    return factor * sine * _rollers(row, rows)


def ball_static(row: BallRow, kind: BallKind) -> Scalar:
    """Load of a ball [N] with the peak pressure of the static rating at a raceway.

    f_0 D² is a fifth of this load, that of thrust bearings all of it. A groove closer
    than the standard counts with, 0.52 of inner and 0.53 of outer rings, is taken as
    that.
    """
    outer, inner = _open_osculations(row, kind)
    return _ball_load(row._replace(osculation=(outer, inner)), kind.stress)


def ball_fatigue(row: BallRow) -> Scalar:
    """Q_u: load of a ball [N] with a peak pressure of 1500 MPa at a raceway.

    That of the fatigue limit of bearing steels, with the grooves as they are.
    """
    return _ball_load(row, _FATIGUE_PRESSURE)


def _ball_load(row, pressure):
    """Load of a ball [N] with this peak pressure at the raceway that has it first."""
    gamma = _gamma(row)
    rolling = 2 - 2 * gamma / (1 + gamma), 2 + 2 * gamma / (1 - gamma)
    across = [
        r if f is None else 2 - 1 / f
        for r, f in zip(rolling, row.osculation, strict=True)
    ]
    # Of a ball of unit diameter: the load grows with its square.
    contact = ellipse(jnp.stack(rolling), jnp.stack(across), jnp.asarray(_MODULUS))
    axes = contact.rolling * contact.transverse
    least = jnp.min((jnp.pi * pressure / 1.5 * axes) ** 3, axis=0)
    return least * row.diameter**2


def roller_static(row: RollerRow) -> Scalar:
    """Load of a roller [N] with the peak pressure of the static rating, 4000 MPa.

    At the inner raceway, which is the harder one: 221 (1 - D cos α/D_pw) D L, with mm
    and N, which ISO 76 rounds to 220.
    """
    return 220e6 * (1 - _gamma(row)) * row.diameter * row.length


def _gamma(row):
    """Ball or roller diameter over pitch diameter, D cos α/D_pw [1]."""
    return row.diameter * jnp.cos(row.contact_angle) / row.pitch_diameter


def _speeds(gamma):
    """Radius of the inner over that of the outer raceway [1]."""
    return (1 - gamma) / (1 + gamma)


def _ball_factor(row, kind, weight):
    """1.3 f_c of contact angles below 90 degrees, but for its factors of the angle."""
    gamma = _gamma(row)
    raceways = _raceways(row, kind, weight * _speeds(gamma) ** 1.72, gamma)
    shape = gamma**0.3 * (1 - gamma) ** 1.39 / jnp.cbrt(1 + gamma)
    return 1.3 * 98.0665 * kind.reduction * raceways * shape


def _raceways(row, kind, weight, gamma):
    """Factor of f_c from the osculations and the radii of both raceways."""

    def share(outer, inner):
        # 2 r/(2 r - D) of the groove radii r.
        inside = 2 * inner / (2 * inner - 1)
        outside = 1 + gamma if outer is None else 2 * outer / (2 * outer - 1)
        ratio = weight * (inside / outside) ** 0.41
        return inside**0.41 * (1 + ratio ** (10 / 3)) ** -0.3

    return (
        share(*kind.counted) * share(*_open_osculations(row, kind)) / share(*kind.open)
    )


def _open_osculations(row, kind):
    """Osculations, none closer than the standards count with."""
    pairs = zip(row.osculation, kind.open, strict=True)
    return [None if least is None else jnp.maximum(f, least) for f, least in pairs]


def _balls(row):
    """Z^(2/3) D^1.8 [mm^1.8], less for large balls."""
    size = _PER_MM * row.diameter
    grown = size**1.4 * jnp.minimum(size, _LARGE_BALL) ** 0.4
    return row.n_elements ** (2 / 3) * grown


def _roller_factor(row, reduction, weight):
    """f_c without (D cos α/D_pw)^(2/9), which has no derivative at 90 degrees."""
    gamma = _gamma(row)
    ratio = weight * _speeds(gamma) ** (143 / 108)
    shape = (1 - gamma) ** (29 / 27) / (1 + gamma) ** 0.25
    return 551.13373 * reduction * shape * (1 + ratio**4.5) ** (-2 / 9)


def _rollers(row, rows):
    """b_m (i L)^(7/9) Z^(3/4) D^(29/27) [mm^(50/27)]."""
    size, length = _PER_MM * row.diameter, _PER_MM * row.length
    grown = row.n_elements**0.75 * size ** (29 / 27)
    return row.quality * (rows * length) ** (7 / 9) * grown

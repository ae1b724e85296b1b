"""Fits of rings on shaft and in housing, and the radial internal clearance they leave.

Shaft, rings and housing are thick-walled cylinders in plane stress, each ring as thick
as from its seat to the bottom of its raceway: without shoulders, of full section. All
lengths are of diameters. An interference is positive where the fit is tight; a loose
fit has no pressure.

`fit_state` compiles nothing for a mounting of NumPy numbers, as from `jax.device_get`.
"""

from types import SimpleNamespace
from typing import Annotated, Any, NamedTuple

import equinox as eqx

from ..design.checks import (
    check,
    floats,
    in_range,
    instance,
    non_negative,
    number,
    positive,
)
from ..numerics.shown import Printable
from ..numerics.types import Real, RealOrNone, array_namespace
from ..numerics.units import real, unit
from .warm_material import WarmMaterial


class Mounting(Printable):
    """A radial bearing on its shaft and in its housing.

    Attributes:
        bore: Bore diameter of the inner ring, d; of a tapered bore where it is
            smallest [m].
        outside_diameter: Outside diameter of the outer ring, D [m].
        housing_diameter: Outside diameter of the housing around the bearing [m].
        shaft_interference: Diameter of the shaft less the bore, as measured [m].
        housing_interference: Outside diameter of the bearing less the housing's bore,
            as measured [m].
        inner_raceway: Diameter of the inner raceway where it is smallest, F [m];
            `None`: that of the bearing (`with_bearing_dimensions`). A larger one stands
            for shoulders, which stiffen the ring.
        outer_raceway: Diameter of the outer raceway where it is largest, E [m];
            `None`: that of the bearing.
        radial_clearance: Radial internal clearance before mounting [m]; `None`: that
            of the bearing.
        contact_angle: Angle from the radial plane at which rolling elements touch,
            along which what they grow takes clearance [rad]; `None`: that of the
            bearing (`with_bearing_dimensions`), 0 if there is none.
        shaft_bore: Bore of a hollow shaft; 0 of a solid one [m].
        shaft_smoothing: Interference that the smoothed surfaces take away, on the shaft
            (`smoothing`) [m].
        housing_smoothing: Smoothing of the seat in the housing [m].
        ring_width: Width of a ring, B, or T of a tapered roller bearing [m]. A set
            needs it: between its rows the rings grow along the axis over this length,
            beyond it shaft and housing (or spacers as warm as these). On shafts too, if
            it is given; `None`: their middle stays where it is on the seat.
            The mean diameter of a tapered bore follows from it; `None`: `bore` counts.
        bore_taper: Taper of bore and seat, of their diameters over the length, such as
            1/12 or 1/30 [1]; 0: cylindrical.
        drive_up: Travel of the inner ring up its tapered seat from where it just
            touches all round [m]. It adds `bore_taper` times itself to
            `shaft_interference`, which is 0 for a seat of the same taper.
        shaft, inner_ring, outer_ring, housing, elements: Materials; of the rolling
            elements only their expansion counts.

    Traced: all fields.
    """

    bore: Real = eqx.field(**real("m", "bore of the bearing"))
    outside_diameter: Real = eqx.field(**real("m", "outside diameter of the bearing"))
    housing_diameter: Real = eqx.field(
        **real("m", "outside diameter of the housing around the bearing")
    )
    shaft_interference: Real = eqx.field(**real("m"))
    housing_interference: Real = eqx.field(**real("m"))
    inner_raceway: RealOrNone = eqx.field(
        **real("m", "mean outside diameter up to which the inner ring counts"),
        default=None,
    )
    outer_raceway: RealOrNone = eqx.field(
        **real("m", "mean inside diameter from which the outer ring counts"),
        default=None,
    )
    radial_clearance: RealOrNone = eqx.field(**real("m"), default=None)
    contact_angle: RealOrNone = eqx.field(**real("rad"), default=None)
    shaft_bore: Real = eqx.field(**real("m", "bore of a hollow shaft"), default=0.0)
    shaft_smoothing: Real = eqx.field(**real("m"), default=0.0)
    housing_smoothing: Real = eqx.field(**real("m"), default=0.0)
    ring_width: RealOrNone = eqx.field(
        **real(
            "m",
            "width of a ring, B or T, over which it grows itself; of sets and tapered"
            " seats, elsewhere only if it is written",
        ),
        default=None,
    )
    bore_taper: Real = eqx.field(**real("1"), default=0.0)
    drive_up: Real = eqx.field(
        **real(
            "m",
            "travel of the inner ring up a tapered seat, from where it just touches",
        ),
        default=0.0,
    )
    shaft: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    inner_ring: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    outer_ring: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    housing: WarmMaterial = eqx.field(default_factory=WarmMaterial)
    elements: WarmMaterial = eqx.field(default_factory=WarmMaterial)

    def __check_init__(self):
        positive(self, "bore")
        smaller = "bore"
        for name in _DIAMETERS[1:]:
            if getattr(self, name) is not None:
                _check_larger(self, name, smaller)
                smaller = name
        in_range(self, "shaft_bore", 0.0, self.bore, include_low=True)
        if self.radial_clearance is not None:
            number(self, "radial_clearance")
        if self.contact_angle is not None:
            in_range(self, "contact_angle", 0.0, 1.5, include_low=True)
        if self.ring_width is not None:
            in_range(self, "ring_width", 0.0, 2.0 * self.outside_diameter)
        in_range(self, "bore_taper", 0.0, _STEEPEST, include_low=True)
        in_range(self, "drive_up", 0.0, self.bore, include_low=True)
        known = floats(self.bore_taper, self.drive_up, self.bore)
        if known is not None:
            cylindrical = known[0] == 0.0
            allowed = "0 m: a cylindrical bore (`bore_taper` 0) has no drive-up"
            check(self, "drive_up", not cylindrical or known[1] == 0.0, allowed)
            most = _LARGEST * known[2] / max(known[0], 1e-9)
            allowed = f"below {most:.6g} m, an interference of 1 % of `bore`"
            check(self, "drive_up", known[1] < most, allowed)
        own = self.inner_raceway
        ring = self.outside_diameter if own is None else own
        known = floats(mean_bore(self), ring)
        if known is not None:
            allowed = f"such that the mean bore is below the raceway, {known[1]:.6g} m"
            check(self, "bore_taper", known[0] < known[1], allowed)
        for name, seat in _SEATS.items():
            number(self, name)
            known = floats(getattr(self, name), getattr(self, seat))
            if known is not None:
                most = _LARGEST * known[1]
                allowed = f"below {most:.6g} m in size, 1 % of `{seat}` (metres meant?)"
                check(self, name, abs(known[0]) < most, allowed)
        for name in ("shaft_smoothing", "housing_smoothing"):
            non_negative(self, name)
        for name in ("shaft", "inner_ring", "outer_ring", "housing", "elements"):
            instance(self, name, WarmMaterial)


_SEATS = {"shaft_interference": "bore", "housing_interference": "outside_diameter"}
_STEEPEST = 0.25
"""Taper of no bore of a bearing [1]."""

_LARGEST = 0.01
"""Share of a diameter that no fit reaches: steel would yield at a fifth of it."""

_DIAMETERS = (
    "bore",
    "inner_raceway",
    "outer_raceway",
    "outside_diameter",
    "housing_diameter",
)


def _check_larger(owner, name, smaller):
    """Raise unless a diameter is above another one, which the message names."""
    positive(owner, name)
    known = floats(getattr(owner, name), getattr(owner, smaller))
    if known is not None:
        check(owner, name, known[0] > known[1], f"above `{smaller}`, {known[1]:.6g} m")


class FitConditions(Printable):
    """Temperatures and speed.

    Attributes:
        shaft: Temperature of the shaft, uniform, on the scale of `reference`, as all
            of these [K].
        inner_ring: Temperature of the inner ring [K].
        elements: Temperature of the rolling elements [K].
        outer_ring: Temperature of the outer ring [K].
        housing: Temperature of the housing [K].
        reference: Temperature of the measured sizes [K]. 0: the others are rises above
            it. Otherwise they are true temperatures, and all five must be given.
        speed: Speed at which shaft and inner ring rotate [rad/s].
        outer_speed: Speed at which outer ring and housing rotate [rad/s].

    Traced: all fields.

    Raises:
        ValueError: If a temperature is not within -280 to 1500 K of `reference`.
    """

    shaft: Real = eqx.field(**real("K"), default=0.0)
    inner_ring: Real = eqx.field(**real("K"), default=0.0)
    elements: Real = eqx.field(**real("K"), default=0.0)
    outer_ring: Real = eqx.field(**real("K"), default=0.0)
    housing: Real = eqx.field(**real("K"), default=0.0)
    speed: Real = eqx.field(**real("rad/s"), default=0.0)
    outer_speed: Real = eqx.field(**real("rad/s"), default=0.0)
    reference: Real = eqx.field(**real("K"), default=0.0)

    def __check_init__(self):
        for name in (*WARM_PARTS, "reference", "speed", "outer_speed"):
            number(self, name)
        for name in WARM_PARTS:
            known = floats(getattr(self, name), self.reference)
            if known is not None:
                rise, base = known[0] - known[1], f"`reference`, {known[1]:.6g} K"
                allowed = f"from {_COLDER:g} to {_HOTTER:g} K above {base}"
                check(self, name, _COLDER <= rise <= _HOTTER, allowed)


_COLDER, _HOTTER = -280.0, 1500.0
"""Plausible rises [K]; a part left at 0 K among true temperatures is outside."""

_REST = SimpleNamespace(
    shaft=0.0,
    inner_ring=0.0,
    elements=0.0,
    outer_ring=0.0,
    housing=0.0,
    reference=0.0,
    speed=0.0,
    outer_speed=0.0,
)
"""`FitConditions()` in NumPy's numbers."""

WARM_PARTS = ("shaft", "inner_ring", "elements", "outer_ring", "housing")
"""Parts of a mounting that have a temperature and a material."""


def smoothing(seat: Any, ring: Any) -> Any:
    """Interference that two fitted surfaces lose as their peaks are smoothed [m].

    0.4 (Rz + Rz), of the diameter.

    Args:
        seat, ring: Mean roughness depth Rz of shaft or housing, and of the ring [m].

    Source: DIN 7190-1 (2017), as the manual of the bearing program of MESYS states it;
        earlier editions took twice as much.
    """
    for name, value in (("seat", seat), ("ring", ring)):
        non_negative("smoothing", name, value, "m")
    return 0.4 * (seat + ring)


class AxialStrains(NamedTuple):
    """Mean axial strains [1], of a seat where no ring stands on it."""

    shaft: Any
    inner_ring: Any
    outer_ring: Any
    housing: Any


class FitState(NamedTuple):
    """State of a bearing after fits, temperatures and speed.

    Attributes:
        shaft_interference: Interference left between shaft and inner ring, less the
            smoothing; negative is loose [m].
        housing_interference: Interference between outer ring and housing [m].
        shaft_pressure: Pressure between shaft and inner ring, 0 where loose [Pa].
        housing_pressure: Pressure between outer ring and housing, 0 where loose [Pa].
        inner_raceway_growth: Growth of the inner raceway's diameter [m].
        outer_raceway_growth: Growth of the outer raceway's diameter [m].
        radial_clearance: Radial internal clearance in these conditions [m].
        ring_stress: Hoop stress of the inner ring at its bore, its largest, from fit
            and speed [Pa].
        element_strain: Thermal strain of the rolling elements beyond the mean of both
            rings [1].
        strains: Axial strains of shaft, inner ring, outer ring and housing: mean of
            each part, from warmth, speed and, of the rings, their fits [1].
    """

    shaft_interference: Annotated[Any, unit("m")]
    housing_interference: Annotated[Any, unit("m")]
    shaft_pressure: Annotated[Any, unit("Pa")]
    housing_pressure: Annotated[Any, unit("Pa")]
    inner_raceway_growth: Annotated[Any, unit("m")]
    outer_raceway_growth: Annotated[Any, unit("m")]
    radial_clearance: Annotated[Any, unit("m")]
    ring_stress: Annotated[Any, unit("Pa")]
    element_strain: Annotated[Any, unit("1")]
    strains: Annotated[AxialStrains, unit("1")]


def fit_state(mounting: Mounting, conditions: FitConditions | None = None) -> FitState:
    """Fits and radial internal clearance of a mounted bearing, unloaded.

    Differentiable with respect to every number; where a fit just comes loose the slope
    is the mean of both sides.

    Args:
        mounting: The bearing and its seats.
        conditions: Temperatures and speed; `None` is mounted, at rest, at the
            temperature of the measured sizes.

    Source: Lamé's thick cylinders and rotating discs, Timoshenko & Goodier, Theory of
        Elasticity (1970), articles 28 and 32.
    """
    if not isinstance(mounting, Mounting):
        raise _not_a("mounting", mounting, "Mounting")
    if not isinstance(conditions, FitConditions | None):
        raise _not_a("conditions", conditions, "FitConditions or None")
    _check_sized(mounting)
    m: Any = mounting
    c: Any = _REST if conditions is None else conditions
    warm = {part: _strain(getattr(m, part), c, part) for part in WARM_PARTS}
    bore = mean_bore(m)
    shaft_interference = (
        m.shaft_interference
        + m.bore_taper * m.drive_up
        - m.shaft_smoothing
        + bore * (warm["shaft"] - warm["inner_ring"])
        + _spin(m.shaft.material, bore, m.shaft_bore, c.speed)
        - _spin(m.inner_ring.material, bore, m.inner_raceway, c.speed)
    )
    out = m.outside_diameter
    housing_interference = (
        m.housing_interference
        - m.housing_smoothing
        + out * (warm["outer_ring"] - warm["housing"])
        + _spin(m.outer_ring.material, out, m.outer_raceway, c.outer_speed)
        - _spin(m.housing.material, out, m.housing_diameter, c.outer_speed)
    )
    shaft_pressure = positive_part(shaft_interference) / (
        _squeeze(m.shaft.material, m.shaft_bore, bore)
        + _stretch(m.inner_ring.material, bore, m.inner_raceway)
    )
    housing_pressure = positive_part(housing_interference) / (
        _squeeze(m.outer_ring.material, m.outer_raceway, out)
        + _stretch(m.housing.material, out, m.housing_diameter)
    )
    inner = (
        m.inner_raceway * warm["inner_ring"]
        + _spin(m.inner_ring.material, m.inner_raceway, bore, c.speed)
        + shaft_pressure * _effect(m.inner_ring.material, bore, m.inner_raceway, bore)
    )
    outer = (
        m.outer_raceway * warm["outer_ring"]
        + _spin(m.outer_ring.material, m.outer_raceway, out, c.outer_speed)
        - housing_pressure * _effect(m.outer_ring.material, m.outer_raceway, out, out)
    )
    strains = AxialStrains(
        warm["shaft"]
        - _axial_shortening(m.shaft.material, m.shaft_bore, bore, c.speed),
        warm["inner_ring"]
        - _axial_shortening(
            m.inner_ring.material, bore, m.inner_raceway, c.speed, shaft_pressure
        ),
        warm["outer_ring"]
        - _axial_shortening(
            m.outer_ring.material,
            m.outer_raceway,
            out,
            c.outer_speed,
            outside=housing_pressure,
        ),
        warm["housing"]
        - _axial_shortening(m.housing.material, out, m.housing_diameter, c.outer_speed),
    )
    # Two rolling elements and the clearance fill the room between the raceways. What
    # elements grow beyond the rings closes contacts along their normals, and so by
    # 1/cos² of the angle more than the room, which is measured radially.
    apart = m.outer_raceway - m.inner_raceway
    angle = m.contact_angle
    steep = 0.0 if angle is None else array_namespace(angle).tan(angle) ** 2
    beyond = warm["elements"] - 0.5 * (warm["inner_ring"] + warm["outer_ring"])
    elements = (apart - m.radial_clearance) * warm["elements"] + apart * steep * beyond
    return FitState(
        shaft_interference,
        housing_interference,
        shaft_pressure,
        housing_pressure,
        inner,
        outer,
        m.radial_clearance + outer - inner - elements,
        shaft_pressure * _ratio(bore, m.inner_raceway)
        + _hoop(m.inner_ring.material, bore, m.inner_raceway, c.speed),
        beyond,
        strains,
    )


def mean_bore(mounting: Mounting) -> Any:
    """Mean diameter of the bore, in the middle of a tapered one [m]."""
    width = mounting.ring_width
    longer = 0.0 if width is None else 0.5 * mounting.bore_taper * width
    return mounting.bore + longer


def needed_drive_up(mounting: Mounting, reduction: Any) -> Any:
    """Drive-up of a tapered bore that takes a given radial clearance [m].

    At rest, at the temperature of the measured sizes; the inverse of what `fit_state`
    gives for the inner ring. What the housing takes is not part of it. Real seats give
    way more than thick-walled cylinders, and surfaces are smoothed, which counts most
    in small ones. Makers' tables for spherical roller bearings print a tenth more
    travel on average: 0.9 to 1.3 times this one above 40 mm bore, by series and bore,
    and 0.95 to 1.8 times up to 40 mm, where the clearance to be taken is 10 to 25 µm.

    Source: SKF, general catalogue (2006), and its later card of drive-up data; Timken,
        engineering manual, table of clearance limits.

    Args:
        mounting: The seats; their `drive_up` does not count.
        reduction: Radial clearance to be taken, at least 0 [m].

    Returns:
        Travel from where the surfaces just touch [m], differentiable.

    Raises:
        ValueError: If the bore is not tapered, or the reduction negative.
    """
    if not isinstance(mounting, Mounting):
        raise _not_a("mounting", mounting, "Mounting")
    _check_sized(mounting)
    m: Any = mounting
    positive("needed_drive_up", "bore_taper", m.bore_taper, "1")
    non_negative("needed_drive_up", "reduction", reduction, "m")
    bore = mean_bore(m)
    seats = _squeeze(m.shaft.material, m.shaft_bore, bore) + _stretch(
        m.inner_ring.material, bore, m.inner_raceway
    )
    growth = _effect(m.inner_ring.material, bore, m.inner_raceway, bore)
    interference = reduction * seats / growth + m.shaft_smoothing
    return (interference - m.shaft_interference) / m.bore_taper


def _not_a(name, value, wanted):
    found = type(value).__name__
    return TypeError(f"fit_state: `{name}` is a {found}; it must be {wanted}.")


def _check_sized(mounting):
    """Raise if sizes are left to a bearing that is not known here."""
    for name in ("inner_raceway", "outer_raceway", "radial_clearance"):
        if getattr(mounting, name) is None:
            raise ValueError(
                f"Mounting: `{name}` is None; give it, or take that of the bearing by"
                " `with_bearing_dimensions`."
            )


def positive_part(number: Any) -> Any:
    """A number where it is positive, as an interference of a tight fit, else 0; its
    slope at 0 is the mean of both sides."""
    return 0.5 * (number + abs(number))


def _ratio(inside, outside):
    return (outside**2 + inside**2) / (outside**2 - inside**2)


def _strain(body, conditions, part):
    return body.expansion * (getattr(conditions, part) - conditions.reference)


def _squeeze(material, inside, outside):
    """Loss of outside diameter over a pressure on it [m/Pa]."""
    ratio = _ratio(inside, outside)
    return outside / material.elastic_modulus * (ratio - material.poisson_ratio)


def _stretch(material, inside, outside):
    """Growth of inside diameter over a pressure in it [m/Pa]."""
    ratio = _ratio(inside, outside)
    return inside / material.elastic_modulus * (ratio + material.poisson_ratio)


def _effect(material, inside, outside, pressed):
    """Change of the other diameter of a ring over a pressure on one, `pressed` [m/Pa].

    The stress at the free surface is a hoop stress alone, 2 p pressed²/(b² - a²).
    """
    free = inside + outside - pressed
    stress = 2.0 * pressed**2 / (outside**2 - inside**2)
    return stress * free / material.elastic_modulus


def _spin(material, own, other, speed):
    """Growth of one diameter of a free ring that rotates [m]."""
    return own * _hoop(material, own, other, speed) / material.elastic_modulus


def _hoop(material, own, other, speed):
    """Hoop stress at one free surface of a ring that rotates [Pa].

    σ = ρ ω²/4 ((3 + ν) other² + (1 - ν) own²), in radii.
    """
    nu = material.poisson_ratio
    squares = (3.0 + nu) * other**2 + (1.0 - nu) * own**2
    return material.density * speed**2 / 16.0 * squares


def _axial_shortening(material, inner, outer, speed, inside=0.0, outside=0.0):
    """Axial strain that a ring loses to the stresses in its plane, ν/E (σr + σθ) [1].

    Their sum over the ring is that of Lamé, 2 (p_i a² - p_o b²)/(b² - a²), the same
    everywhere, and of the speed on average ρ ω²(a² + b²)/2, in radii: the virial of
    the centrifugal forces.
    """
    squares = outer**2 + inner**2
    fit = 2.0 * (inside * inner**2 - outside * outer**2) / (outer**2 - inner**2)
    turning = material.density * speed**2 * squares / 8.0
    return material.poisson_ratio / material.elastic_modulus * (fit + turning)

"""Fits of rings on shaft and in housing, and the radial internal clearance they leave.

Shaft, rings and housing are thick-walled cylinders in plane stress, each ring as thick
as from its seat to the bottom of its raceway: without shoulders, of full section. All
lengths are of diameters. An interference is positive where the fit is tight; a loose
fit has no pressure.

`fit_state` and the functions after it compile nothing for a mounting of NumPy numbers,
as of `jax.device_get`.
"""

from types import SimpleNamespace
from typing import Any, NamedTuple

import equinox as eqx

from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .checks import check, concrete, in_range, instance, non_negative, number, positive
from .iso286 import Limits
from .material import Material


class WarmMaterial(eqx.Module):
    """A material and its thermal expansion, by default of bearing steel.

    Attributes:
        material: Elastic constants and density.
        expansion: Coefficient of linear thermal expansion α [1/K].

    Traced: all fields.

    Source: 12e-6 1/K of bearing steel: catalogue of SNH; NTN and IKO print 12.5e-6.
        The others: usual data-sheet values, 3 to 3.3e-6 for silicon nitride.
    """

    material: Material = eqx.field(default_factory=Material)
    expansion: Scalar = eqx.field(
        converter=as_real, metadata=unit("1/K"), default=12e-6
    )

    def __check_init__(self):
        instance(self, "material", Material)
        in_range(self, "expansion", -1e-4, 1e-3)

    @classmethod
    def steel(cls) -> "WarmMaterial":
        """Bearing steel: 206 GPa, 0.3, 7850 kg/m³, 12e-6 1/K."""
        return cls()

    @classmethod
    def cast_iron(cls) -> "WarmMaterial":
        """Grey cast iron: 110 GPa, 0.26, 7200 kg/m³, 10.5e-6 1/K."""
        return cls(Material(110e9, 0.26, 7200.0), 10.5e-6)

    @classmethod
    def aluminium(cls) -> "WarmMaterial":
        """Aluminium alloys: 70 GPa, 0.33, 2700 kg/m³, 23e-6 1/K."""
        return cls(Material(70e9, 0.33, 2700.0), 23e-6)

    @classmethod
    def silicon_nitride(cls) -> "WarmMaterial":
        """Silicon nitride, as `Material.silicon_nitride`: 3.2e-6 1/K."""
        return cls(Material.silicon_nitride(), 3.2e-6)

    @classmethod
    def zirconia(cls) -> "WarmMaterial":
        """Zirconia, as `Material.zirconia`: 10.5e-6 1/K."""
        return cls(Material.zirconia(), 10.5e-6)


WARM_MATERIALS = {
    "steel": WarmMaterial.steel,
    "cast_iron": WarmMaterial.cast_iron,
    "aluminium": WarmMaterial.aluminium,
    "silicon_nitride": WarmMaterial.silicon_nitride,
    "zirconia": WarmMaterial.zirconia,
}
"""Makers of the named materials."""


class Mounting(eqx.Module):
    """A radial bearing on its shaft and in its housing.

    Attributes:
        bore: Bore diameter of the inner ring, d [m].
        outside_diameter: Of the outer ring, D [m].
        housing_diameter: Outside diameter of the housing around the bearing [m].
        shaft_interference: Diameter of the shaft less the bore, as measured [m].
        housing_interference: Outside diameter of the bearing less the housing's bore,
            as measured [m].
        inner_raceway: Diameter of the inner raceway where it is smallest, F [m];
            `None`: that of the bearing (`sized`). A larger one stands for shoulders,
            which stiffen the ring.
        outer_raceway: Diameter of the outer raceway where it is largest, E [m];
            `None`: that of the bearing.
        radial_clearance: Radial internal clearance before mounting [m]; `None`: that
            of the bearing.
        shaft_bore: Bore of a hollow shaft; 0 of a solid one [m].
        shaft_smoothing: Interference that the smoothed surfaces take away, on the shaft
            (`smoothing`) [m].
        housing_smoothing: Likewise in the housing [m].
        shaft, inner_ring, outer_ring, housing, elements: Materials; of the rolling
            elements only their expansion counts.

    Traced: all fields.
    """

    bore: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    outside_diameter: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    housing_diameter: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    shaft_interference: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    housing_interference: Scalar = eqx.field(converter=as_real, metadata=unit("m"))
    inner_raceway: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None
    )
    outer_raceway: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None
    )
    radial_clearance: Scalar | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None
    )
    shaft_bore: Scalar = eqx.field(converter=as_real, metadata=unit("m"), default=0.0)
    shaft_smoothing: Scalar = eqx.field(
        converter=as_real, metadata=unit("m"), default=0.0
    )
    housing_smoothing: Scalar = eqx.field(
        converter=as_real, metadata=unit("m"), default=0.0
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
                _larger(self, name, smaller)
                smaller = name
        in_range(self, "shaft_bore", 0.0, self.bore, include_low=True)
        if self.radial_clearance is not None:
            number(self, "radial_clearance")
        for name, seat in _SEATS.items():
            number(self, name)
            known = concrete(getattr(self, name), getattr(self, seat))
            if known is not None:
                most = _LARGEST * known[1]
                allowed = f"below {most:.6g} m in size, 1 % of `{seat}` (metres meant?)"
                check(self, name, abs(known[0]) < most, allowed)
        for name in ("shaft_smoothing", "housing_smoothing"):
            non_negative(self, name)
        for name in ("shaft", "inner_ring", "outer_ring", "housing", "elements"):
            instance(self, name, WarmMaterial)


_SEATS = {"shaft_interference": "bore", "housing_interference": "outside_diameter"}
_LARGEST = 0.01
"""Share of a diameter that no fit reaches: steel would yield at a fifth of it."""

_WIDEST = 0.01
"""Beyond all clearances and deviations of bearings up to 1 m; micrometres meant? [m]"""

_DIAMETERS = (
    "bore",
    "inner_raceway",
    "outer_raceway",
    "outside_diameter",
    "housing_diameter",
)


def _larger(owner, name, smaller):
    """Raise unless a diameter is above another one, which the message names."""
    positive(owner, name)
    known = concrete(getattr(owner, name), getattr(owner, smaller))
    if known is not None:
        check(owner, name, known[0] > known[1], f"above `{smaller}`, {known[1]:.6g} m")


class FitConditions(eqx.Module):
    """Temperatures and speed.

    Attributes:
        shaft: Temperature of the shaft, even throughout it, on the scale of
            `reference`; likewise below [K].
        inner_ring: Of the inner ring [K].
        elements: Of the rolling elements [K].
        outer_ring: Of the outer ring [K].
        housing: Of the housing [K].
        reference: Temperature of the measured sizes [K]. 0: the others are rises above
            it. Otherwise they are true temperatures, and all five must be given.
        speed: Speed at which shaft and inner ring rotate [rad/s].
        outer_speed: Speed at which outer ring and housing rotate [rad/s].

    Traced: all fields.

    Raises:
        ValueError: If a temperature is not within -280 to 1500 K of `reference`.
    """

    shaft: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    inner_ring: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    elements: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    outer_ring: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    housing: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)
    speed: Scalar = eqx.field(converter=as_real, metadata=unit("rad/s"), default=0.0)
    outer_speed: Scalar = eqx.field(
        converter=as_real, metadata=unit("rad/s"), default=0.0
    )
    reference: Scalar = eqx.field(converter=as_real, metadata=unit("K"), default=0.0)

    def __check_init__(self):
        for name in (*PARTS, "reference", "speed", "outer_speed"):
            number(self, name)
        for name in PARTS:
            known = concrete(getattr(self, name), self.reference)
            if known is not None:
                rise, base = known[0] - known[1], f"`reference`, {known[1]:.6g} K"
                allowed = f"from {_COLDER:g} to {_HOTTER:g} K above {base}"
                check(self, name, _COLDER <= rise <= _HOTTER, allowed)


_COLDER, _HOTTER = -280.0, 1500.0
"""Rises that are possible [K]: one left at 0 K beside a true temperature is not."""

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

PARTS = ("shaft", "inner_ring", "elements", "outer_ring", "housing")
"""What has a temperature, and a material, in a mounting."""


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


class FitState(NamedTuple):
    """What fits, temperatures and speed do to a bearing.

    Attributes:
        shaft_interference: Interference left between shaft and inner ring, less the
            smoothing; negative is loose [m].
        housing_interference: Likewise between outer ring and housing [m].
        shaft_pressure: Pressure between shaft and inner ring, 0 where loose [Pa].
        housing_pressure: Likewise between outer ring and housing [Pa].
        inner_raceway_growth: Growth of the inner raceway's diameter [m].
        outer_raceway_growth: Growth of the outer raceway's diameter [m].
        radial_clearance: Radial internal clearance in these conditions [m].
        ring_stress: Hoop stress of the inner ring at its bore, its largest, from fit
            and speed [Pa].
    """

    shaft_interference: Any
    housing_interference: Any
    shaft_pressure: Any
    housing_pressure: Any
    inner_raceway_growth: Any
    outer_raceway_growth: Any
    radial_clearance: Any
    ring_stress: Any


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
    warm = {part: _strain(getattr(m, part), c, part) for part in PARTS}
    shaft_interference = (
        m.shaft_interference
        - m.shaft_smoothing
        + m.bore * (warm["shaft"] - warm["inner_ring"])
        + _spin(m.shaft.material, m.bore, m.shaft_bore, c.speed)
        - _spin(m.inner_ring.material, m.bore, m.inner_raceway, c.speed)
    )
    out = m.outside_diameter
    housing_interference = (
        m.housing_interference
        - m.housing_smoothing
        + out * (warm["outer_ring"] - warm["housing"])
        + _spin(m.outer_ring.material, out, m.outer_raceway, c.outer_speed)
        - _spin(m.housing.material, out, m.housing_diameter, c.outer_speed)
    )
    shaft_pressure = _tight(shaft_interference) / (
        _squeeze(m.shaft.material, m.shaft_bore, m.bore)
        + _stretch(m.inner_ring.material, m.bore, m.inner_raceway)
    )
    housing_pressure = _tight(housing_interference) / (
        _squeeze(m.outer_ring.material, m.outer_raceway, out)
        + _stretch(m.housing.material, out, m.housing_diameter)
    )
    inner = (
        m.inner_raceway * warm["inner_ring"]
        + _spin(m.inner_ring.material, m.inner_raceway, m.bore, c.speed)
        + shaft_pressure
        * _across(m.inner_ring.material, m.bore, m.inner_raceway, m.bore)
    )
    outer = (
        m.outer_raceway * warm["outer_ring"]
        + _spin(m.outer_ring.material, m.outer_raceway, out, c.outer_speed)
        - housing_pressure * _across(m.outer_ring.material, m.outer_raceway, out, out)
    )
    # Two rolling elements and the clearance fill the room between the raceways.
    room = m.outer_raceway - m.inner_raceway - m.radial_clearance
    elements = room * warm["elements"]
    return FitState(
        shaft_interference,
        housing_interference,
        shaft_pressure,
        housing_pressure,
        inner,
        outer,
        m.radial_clearance + outer - inner - elements,
        shaft_pressure * _ratio(m.bore, m.inner_raceway)
        + _hoop(m.inner_ring.material, m.bore, m.inner_raceway, c.speed),
    )


def _not_a(name, value, wanted):
    found = type(value).__name__
    return TypeError(f"fit_state: `{name}` is a {found}; it must be {wanted}.")


def _check_sized(mounting):
    """Raise if sizes are left to a bearing that is not known here."""
    for name in ("inner_raceway", "outer_raceway", "radial_clearance"):
        if getattr(mounting, name) is None:
            raise ValueError(
                f"Mounting: `{name}` is None; give it, or take that of the bearing by"
                " `sized`."
            )


def _tight(interference):
    """An interference where it is one, 0 where the fit is loose."""
    return 0.5 * (interference + abs(interference))


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


def _across(material, inside, outside, pressed):
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


class ClearanceRange(NamedTuple):
    """Radial internal clearance of many bearings whose sizes scatter.

    Attributes:
        middle: With all sizes in the middle of their limits [m].
        worst: Least and largest of all [m].
        probable: Root sum of squares of what each size does alone, about the middle:
            the same share of bearings is within as of each size within its limits, if
            sizes are normal and independent, and fits do not come loose. Where they do,
            it is cut off at `worst` [m].
    """

    middle: Any
    worst: Limits
    probable: Limits


def clearance_range(
    mounting: Mounting,
    clearance: Limits,
    shaft: Limits,
    bore: Limits,
    housing: Limits,
    outside_diameter: Limits,
    conditions: FitConditions | None = None,
) -> ClearanceRange:
    """Radial internal clearance over the tolerances of all sizes of a mounting.

    Args:
        mounting: The bearing and its seats; its clearance and interferences do not
            count, all else does.
        clearance: Limits of the clearance before mounting [m].
        shaft, bore, housing, outside_diameter: Limits of the deviations of shaft
            diameter, bore, housing bore and outside diameter (`limits`, `bore_limits`,
            `outside_limits`) [m].
        conditions: As of `fit_state`.

    Raises:
        ValueError: If a lower limit is above the upper one.
    """
    cases = _Cases(mounting, _given(clearance, shaft, bore, housing, outside_diameter))
    middle, half = cases.spread(conditions)[:2]
    least, most = (cases.clearance(side, conditions) for side in (-1.0, 1.0))
    return ClearanceRange(
        middle,
        Limits(least, most),
        Limits(_larger_of(middle - half, least), -_larger_of(-middle - half, -most)),
    )


def _larger_of(one, other):
    return other + _tight(one - other)


PLACES = {
    "middle": 0.0,
    "tightest": -1.0,
    "loosest": 1.0,
    "probable_tightest": -1.0,
    "probable_loosest": 1.0,
}
"""Where `mounting_at` can be, each with its side: + is much clearance."""


def mounting_at(
    mounting: Mounting,
    place: str,
    clearance: Limits,
    shaft: Limits,
    bore: Limits,
    housing: Limits,
    outside_diameter: Limits,
    conditions: FitConditions | None = None,
) -> Mounting:
    """A mounting with the sizes that it has somewhere in their tolerances.

    Args:
        mounting: The bearing and its seats; its clearance and interferences do not
            count, all else does.
        place: "middle": all sizes in the middle of their limits. "tightest", "loosest":
            at those that leave the least and the largest clearance.
            "probable_tightest", "probable_loosest": at the sizes that most likely give
            the limits of `ClearanceRange.probable` (exact as long as no fit comes
            loose).
        clearance, shaft, bore, housing, outside_diameter: As of `clearance_range`.
        conditions: As of `fit_state`; the probable places depend on them.

    Raises:
        ValueError: If there is no such place, or a lower limit is above the upper one.
    """
    if place not in PLACES:
        raise ValueError(
            f"mounting_at: `place` is {place!r}; it must be one of {', '.join(PLACES)}."
        )
    given = _given(clearance, shaft, bore, housing, outside_diameter)
    cases, side = _Cases(mounting, given), PLACES[place]
    if not place.startswith("probable"):
        return cases.mounting(dict.fromkeys(given, side))
    _, half, effects = cases.spread(conditions)
    whole = half + 1e-30  # 0 if all sizes are exact, and so are their effects
    return cases.mounting({name: side * e / whole for name, e in effects.items()})


def _given(clearance, shaft, bore, housing, outside_diameter):
    given = {
        "clearance": clearance,
        "shaft": shaft,
        "bore": bore,
        "housing": housing,
        "outside_diameter": outside_diameter,
    }
    for name, pair in given.items():
        if not isinstance(pair, tuple) or len(pair) != 2:
            raise TypeError(
                f"clearance_range: `{name}` is {pair!r}; it must be Limits, two numbers"
                " in m."
            )
        for end in pair:
            in_range("clearance_range", name, -_WIDEST, _WIDEST, end, "m")
        known = concrete(*pair)
        if known is not None and known[0] > known[1]:
            raise ValueError(
                f"clearance_range: `{name}` is {known[0]:.6g} to {known[1]:.6g} m; its"
                " lower limit must not be above its upper one."
            )
    return given


class _Cases(NamedTuple):
    """A mounting and the limits of its sizes.

    A place in the limits of a size is a number from -1, where it leaves the least
    clearance, to 1.
    """

    base: Mounting
    limits: dict[str, Limits]

    def mounting(self, places) -> Mounting:
        """The mounting with each size at its place."""
        sizes = {}
        for name, (lower, upper) in self.limits.items():
            # Large shafts and outside diameters take clearance, the others give it.
            turned = -1.0 if name in ("shaft", "outside_diameter") else 1.0
            shift = 0.5 * turned * places[name] * (upper - lower)
            sizes[name] = 0.5 * (lower + upper) + shift
        return eqx.tree_at(
            lambda m: (
                m.radial_clearance,
                m.shaft_interference,
                m.housing_interference,
            ),
            self.base,
            (
                sizes["clearance"],
                sizes["shaft"] - sizes["bore"],
                sizes["outside_diameter"] - sizes["housing"],
            ),
            is_leaf=lambda leaf: leaf is None,
        )

    def clearance(self, place, conditions, **others):
        """Radial clearance with all sizes at one place, but for others."""
        places = {**dict.fromkeys(self.limits, place), **others}
        return fit_state(self.mounting(places), conditions).radial_clearance

    def spread(self, conditions):
        """Clearance in the middle, root sum of squares about it, and what each does."""
        effects = {
            name: 0.5
            * (
                self.clearance(0.0, conditions, **{name: 1.0})
                - self.clearance(0.0, conditions, **{name: -1.0})
            )
            for name in self.limits
        }
        half = sum(effect**2 for effect in effects.values()) ** 0.5
        return self.clearance(0.0, conditions), half, effects

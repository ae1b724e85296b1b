"""A bearing from plain keywords in SI: the words and numbers of its drawing."""

from collections.abc import Mapping
from typing import Any

from .abstract import AbstractBearing
from .ball_types import (
    AngularContactBallBearing,
    DeepGrooveBallBearing,
    DoubleRowBallRow,
    FourPointBallBearing,
    SelfAligningBallRow,
    ThrustBallBearing,
)
from .barrel import (
    CrossedRollerRow,
    CylindricalThrustRollerBearing,
    SphericalRollerRow,
    SphericalThrustRollerBearing,
    TaperedThrustRollerBearing,
    ToroidalRollerBearing,
)
from .bearing import (
    CylindricalRollerBearing,
    NeedleRollerBearing,
    TaperedRollerBearing,
)
from .bearing_set import BearingSet, shares_rings
from .logarithmic import FujiwaraKawase, JohnsGohar, Logarithmic, Lundberg
from .material import MATERIALS
from .profile import CircularCrown, CrownedEnds, Straight
from .rib import Rib, Ribs
from .tabulated import Tabulated

ROLLERS = {
    "cylindrical_roller": CylindricalRollerBearing,
    "needle_roller": NeedleRollerBearing,
    "tapered_roller": TaperedRollerBearing,
    "spherical_roller": SphericalRollerRow,
    "toroidal_roller": ToroidalRollerBearing,
    "cylindrical_thrust_roller": CylindricalThrustRollerBearing,
    "tapered_thrust_roller": TaperedThrustRollerBearing,
    "spherical_thrust_roller": SphericalThrustRollerBearing,
    "crossed_roller": CrossedRollerRow,
}
BALLS = {
    "deep_groove_ball": DeepGrooveBallBearing,
    "angular_contact_ball": AngularContactBallBearing,
    "double_row_ball": DoubleRowBallRow,
    "four_point_ball": FourPointBallBearing,
    "self_aligning_ball": SelfAligningBallRow,
    "thrust_ball": ThrustBallBearing,
}
"""Bearings by `type`; scenes, their schema and messages follow from `ROLLERS` and
`BALLS`."""
PROFILES = {
    "straight": Straight,
    "circular_crown": CircularCrown,
    "crowned_ends": CrownedEnds,
    "logarithmic": Logarithmic,
    "lundberg": Lundberg,
    "johns_gohar": JohnsGohar,
    "fujiwara_kawase": FujiwaraKawase,
    "tabulated": Tabulated,
}


def both_rows(
    bearing: AbstractBearing, staggered: bool = True
) -> AbstractBearing | BearingSet:
    """Return the set of both rows of a bearing whose rows share rings, else itself.

    Args:
        bearing: The bearing, or one of both rows.
        staggered: Whether the elements of one row stand between those of the other.
    """
    if not shares_rings(bearing):
        return bearing
    if isinstance(bearing, CrossedRollerRow):
        return BearingSet.crossed(bearing)
    if isinstance(bearing, DoubleRowBallRow):
        return BearingSet.double_row(bearing)
    return BearingSet.self_aligning(bearing, staggered=staggered)


def bearing_of(design: Mapping[str, Any]) -> AbstractBearing | BearingSet:
    """Build a bearing from the keywords of its design.

    Args:
        design: `type`, a key of `ROLLERS` or `BALLS`, and the fields of that class in
            SI. Of rollers, `roller_profile` holds the `type` of a profile and its
            fields; ribs are the `ribs` by name, or the `rib` of an `arrangement` with
            its `axial_internal_clearance`; materials may be names of `MATERIALS`.

    Returns:
        The bearing, or the set of both rows of one whose rows share rings.

    Raises:
        KeyError: If a type is not known.
        TypeError, ValueError: As the class raises them.
    """
    values = dict(design)
    kind = values.pop("type")
    for key in {"material", "ring_material"} & set(values):
        if isinstance(values[key], str):
            values[key] = MATERIALS[values[key]]()
    if kind in BALLS:
        return both_rows(BALLS[kind](**values))
    profile = dict(values.pop("roller_profile", {"type": "straight"}))
    ribs = {name: Rib(**one) for name, one in values.pop("ribs", {}).items()}
    if "arrangement" in values:
        play = values.pop("axial_internal_clearance", None)
        rib = Rib(**values.pop("rib"))
        found = Ribs.arrangement(values.pop("arrangement"), rib, play)
    else:
        found = Ribs(**ribs)
    shape = PROFILES[profile.pop("type")](**profile)
    return both_rows(ROLLERS[kind](**values, roller_profile=shape, ribs=found))

"""Laws, kinematics and numerics that a scene chooses by name."""

from typing import Any

from ..contact.coupled import CoupledSlices
from ..contact.line import ISO16281, AbstractLineLaw, LineConstant, Palmgren
from ..contact.point_law import (
    AbstractPointLaw,
    FreeAngle,
    OperatingAngle,
    PointConstant,
    ZeroAngle,
)
from ..design import Bearing, BearingSet, is_ball, n_elements, rows_of
from ..element import (
    RINGS,
    AbstractKinematics,
    AbstractRacewayControl,
    CentrifugalOnly,
    ConstantAngle,
    EqualShare,
    Finite,
    FrictionLimited,
    InnerControl,
    Linearised,
    LoadShare,
    OperatingCentrifugal,
    OuterControl,
)
from ..numerics import BFGS, ContactMapped, Midpoint, TrustRegionNewton
from ..numerics.quadrature import AbstractQuadrature
from ..numerics.units import unit_of
from ..statics.load_search import SLOTS
from .table import Table

LINE_LAWS = {
    "palmgren": Palmgren,
    "iso16281": ISO16281,
    "coupled_slices": CoupledSlices,
}
QUADRATURES = {"contact_mapped": ContactMapped, "midpoint": Midpoint}
KINEMATICS = {
    "linearised": Linearised,
    "constant_angle": ConstantAngle,
    "finite": Finite,
}
POINT_LAWS = {
    "free_angle": FreeAngle,
    "zero_angle": ZeroAngle,
    "operating_angle": OperatingAngle,
}
CONTROLS = {
    "outer": OuterControl,
    "inner": InnerControl,
    "equal_share": EqualShare,
    "load_share": LoadShare,
    "friction_limited": FrictionLimited,
    "centrifugal_only": CentrifugalOnly,
    "operating_centrifugal": OperatingCentrifugal,
}
EQUILIBRIA = {"newton": TrustRegionNewton, "bfgs": BFGS}
MOST_SLICES = 10_000
"""Most slices of a roller."""


def read_choices(
    contact: Table, operating: Table, numerics: Table, bearing: Bearing | BearingSet
) -> dict[str, Any]:
    """Keywords of `BearingElement` that a scene chooses.

    Args:
        contact, operating, numerics: Tables of the scene.
        bearing: Its bearing.
    """
    if is_ball(bearing):
        choices: dict[str, Any] = {
            "point_law": _point_law(contact),
            "raceway_control": _control(operating),
        }
        if "kinematics" in numerics:
            choices["kinematics"] = _kinematics(numerics)
    else:
        law = read_line_law(contact)
        n_rollers = sum(n_elements(row.bearing) for row in rows_of(bearing))
        choices = {"line_law": law, "kinematics": _kinematics(numerics)}
        if not isinstance(law, CoupledSlices):
            choices["quadrature"] = _quadrature(numerics, n_rollers)
    solver = numerics.choice("equilibrium", tuple(EQUILIBRIA), "newton")
    return {**choices, "equilibrium": EQUILIBRIA[solver]()}


def read_line_law(contact: Table) -> AbstractLineLaw:
    """Line law of a `[contact]` table."""
    law = contact.choice("line_law", tuple(LINE_LAWS), "palmgren")
    if law == "coupled_slices":
        with contact.building():
            return CoupledSlices(contact.integer("slices", CoupledSlices().slices))
    constant = contact.real("line_constant", unit_of(LineConstant, "value"), None)
    if constant is None:
        return LINE_LAWS[law]()
    with contact.building():
        return LineConstant(constant)


def _quadrature(numerics: Table, n_rollers: int) -> AbstractQuadrature:
    rule = numerics.choice("quadrature", tuple(QUADRATURES), "contact_mapped")
    points = numerics.integer("points", None)
    if rule == "midpoint" and points is not None and points > MOST_SLICES:
        size = 8e-9 * SLOTS * 2 * n_rollers * points
        problem = (
            f"{points} is too many slices: {size:.3g} GB in each array of a sweep, of"
            f" {SLOTS} cases at a time; at most {MOST_SLICES}"
        )
        raise numerics.error("points", problem)
    with numerics.building():
        chosen = QUADRATURES[rule]() if points is None else QUADRATURES[rule](points)
    numerics.fill("points", chosen.points)
    return chosen


def _kinematics(numerics: Table) -> AbstractKinematics:
    return KINEMATICS[numerics.choice("kinematics", tuple(KINEMATICS), "linearised")]()


def _point_law(contact: Table) -> AbstractPointLaw:
    law = contact.choice("point_law", tuple(POINT_LAWS), "free_angle")
    outer, inner = (
        contact.real(f"{ring}_constant", unit_of(PointConstant, ring), None)
        for ring in RINGS
    )
    if outer is None and inner is None:
        return POINT_LAWS[law]()
    for name, value in (("outer_constant", outer), ("inner_constant", inner)):
        if value is None:
            raise contact.error(name, "is missing; give the constants of both rings")
    with contact.building():
        return PointConstant(outer, inner)


def _control(operating: Table) -> AbstractRacewayControl:
    name = operating.choice("raceway_control", tuple(CONTROLS), "outer")
    friction = "friction_coefficient"
    if name != "friction_limited":
        if friction in operating:
            problem = 'goes with `raceway_control` = "friction_limited" only'
            raise operating.error(friction, problem)
        return CONTROLS[name]()
    with operating.building():
        unit = unit_of(FrictionLimited, "friction")
        return FrictionLimited(operating.real(friction, unit))

"""Laws, kinematics and numerics that a scene chooses by name."""

from typing import Any

from ... import element
from ...contact.coupled import CoupledSlices
from ...contact.line import ISO16281, AbstractLineLaw, LineConstant, Palmgren
from ...contact.point_law import (
    AbstractPointLaw,
    FreeAngle,
    OperatingAngle,
    PointConstant,
    ZeroAngle,
)
from ...design import AbstractBearing, BearingSet, rows_of
from ...element.choices import usual_kinematics
from ...files.schema import Keys, key_of, read_keys, scene_key
from ...files.table import Table
from ...numerics import BFGS, ContactMapped, Midpoint, TrustRegionNewton
from ...numerics.quadrature import AbstractQuadrature
from ...statics.load_search import SLOTS

LINE_LAWS = {
    "palmgren": Palmgren,
    "iso16281": ISO16281,
    "coupled_slices": CoupledSlices,
}
QUADRATURES = {"contact_mapped": ContactMapped, "midpoint": Midpoint}
KINEMATICS = {
    "linearised": element.Linearised,
    "constant_angle": element.ConstantAngle,
    "finite": element.Finite,
}
POINT_LAWS = {
    "free_angle": FreeAngle,
    "zero_angle": ZeroAngle,
    "operating_angle": OperatingAngle,
}
CONTROLS = {
    "outer": element.OuterControl,
    "inner": element.InnerControl,
    "equal_share": element.EqualShare,
    "load_share": element.LoadShare,
    "friction_limited": element.FrictionLimited,
    "centrifugal_only": element.CentrifugalOnly,
    "operating_centrifugal": element.OperatingCentrifugal,
}
EQUILIBRIA = {"newton": TrustRegionNewton, "bfgs": BFGS}
MOST_SLICES = 10_000
"""Most slices of a roller."""


class LineContactKeys(Keys):
    about = "[contact] of rollers: the law of their slices"

    line_law: str = scene_key(
        "approach and load of a slice", choices=tuple(LINE_LAWS), default="palmgren"
    )
    line_constant: float | None = scene_key(
        "constant of q = K δ^(10/9), in place of the law's",
        "line constant",
        only={"line_law": ("palmgren", "iso16281")},
    )
    slices: int = scene_key(
        "slices of a roller",
        default=CoupledSlices().slices,
        only={"line_law": ("coupled_slices",)},
    )

    @property
    def law(self) -> AbstractLineLaw:
        """Line law of the slices."""
        with self.table.building(value="line_constant"):
            if self.line_law == "coupled_slices":
                return CoupledSlices(self.slices)
            if self.line_constant is not None:
                return LineConstant(self.line_constant)
        return LINE_LAWS[self.line_law]()


class PointContactKeys(Keys):
    about = "[contact] of balls: the law of their contacts"

    point_law: str = scene_key(
        "contact angle for which the constants are worked out",
        choices=tuple(POINT_LAWS),
        default="free_angle",
    )
    outer_constant: float | None = key_of(PointConstant, "outer")
    inner_constant: float | None = key_of(PointConstant, "inner")

    def check(self) -> None:
        for name, other in _BOTH:
            if getattr(self, name) is None and getattr(self, other) is not None:
                problem = "is missing; give the constants of both rings"
                raise self.table.error(name, problem)

    @property
    def law(self) -> AbstractPointLaw:
        """Point law of the contacts."""
        if self.outer_constant is None or self.inner_constant is None:
            return POINT_LAWS[self.point_law]()
        with self.table.building(outer="outer_constant", inner="inner_constant"):
            return PointConstant(self.outer_constant, self.inner_constant)


_BOTH = (("outer_constant", "inner_constant"), ("inner_constant", "outer_constant"))


class ControlKeys(Keys):
    about = "Raceway control of balls that turn"

    raceway_control: str = scene_key(
        "raceway on which balls roll without spin, for their gyroscopic moment",
        choices=tuple(CONTROLS),
        default="outer",
    )
    friction_coefficient: float | None = key_of(
        element.FrictionLimited, "friction", default=None
    )

    def check(self) -> None:
        limited = self.raceway_control == "friction_limited"
        if limited and self.friction_coefficient is None:
            self.table.number("friction_coefficient")
        if not limited and self.friction_coefficient is not None:
            problem = 'goes with `raceway_control` = "friction_limited" only'
            raise self.table.error("friction_coefficient", problem)

    @property
    def control(self) -> element.AbstractRacewayControl:
        """Raceway control of the balls."""
        if self.friction_coefficient is None:
            return CONTROLS[self.raceway_control]()
        with self.table.building(friction="friction_coefficient"):
            return element.FrictionLimited(self.friction_coefficient)


class BallNumericsKeys(Keys):
    about = "[numerics] of balls"

    kinematics: str | None = scene_key(
        "how rings displace the raceways",
        choices=tuple(KINEMATICS),
        otherwise="`finite`",
    )
    equilibrium: str = scene_key(
        "solver of the rolling elements' own equilibrium",
        choices=tuple(EQUILIBRIA),
        default="newton",
    )


class RollerNumericsKeys(BallNumericsKeys):
    about = "[numerics] of rollers"

    kinematics: str = key_of(
        BallNumericsKeys, "kinematics", default="linearised", otherwise=""
    )
    quadrature: str = scene_key(
        "rule along the rollers", choices=tuple(QUADRATURES), default="contact_mapped"
    )
    points: int | None = scene_key(
        "nodes of a contact, or slices of a roller", otherwise="those of the rule"
    )

    def rule(self, n_rollers: int) -> AbstractQuadrature:
        """Return the quadrature rule along the rollers.

        Args:
            n_rollers: Number of rollers of all rows.
        """
        points, kind = self.points, QUADRATURES[self.quadrature]
        if self.quadrature == "midpoint" and (points or 0) > MOST_SLICES:
            size = 8e-9 * SLOTS * 2 * n_rollers * (points or 0)
            problem = (
                f"{points} is too many slices: {size:.3g} GB in each array of a sweep,"
                f" of {SLOTS} cases at a time; at most {MOST_SLICES}"
            )
            raise self.table.error("points", problem)
        with self.table.building():
            chosen = kind() if points is None else kind(points)
        self.table.fill("points", chosen.points)
        return chosen


class BarrelNumericsKeys(RollerNumericsKeys):
    about = "[numerics] of barrel rollers"

    kinematics: str | None = key_of(
        BallNumericsKeys,
        "kinematics",
        otherwise="`finite`, or `linearised` with coupled slices or measured profiles",
    )


def read_choices(
    contact: Table,
    operating: Table,
    numerics: Table,
    bearing: AbstractBearing | BearingSet,
) -> dict[str, Any]:
    """Return the keyword arguments of `BearingElement` chosen by a scene."""
    if bearing.is_ball:
        choices: dict[str, Any] = {
            "point_law": read_keys(PointContactKeys, contact).law,
            "raceway_control": read_keys(ControlKeys, operating).control,
        }
        keys = read_keys(BallNumericsKeys, numerics)
    else:
        law = read_keys(LineContactKeys, contact).law
        choices = {"line_law": law}
        rows: Any = rows_of(bearing)
        barrels = all(row.bearing.arc_radii is not None for row in rows)
        kind = BarrelNumericsKeys if barrels else RollerNumericsKeys
        keys = rollers = read_keys(kind, numerics)
        if keys.kinematics is None:
            choices["kinematics"] = usual_kinematics(rows, law)
            names = {kind: name for name, kind in KINEMATICS.items()}
            numerics.fill("kinematics", names[type(choices["kinematics"])])
        if not isinstance(law, CoupledSlices):
            count = sum(row.bearing.n_elements for row in rows_of(bearing))
            choices["quadrature"] = rollers.rule(count)
        else:
            for name in ("quadrature", "points"):
                if name in numerics:
                    slices = f"`{contact.path_of('slices')}`"
                    problem = f"is not for coupled slices, which {slices} counts"
                    raise numerics.error(name, problem)
                numerics.fill(name, None)
    if keys.kinematics is not None:
        choices["kinematics"] = KINEMATICS[keys.kinematics]()
    return {**choices, "equilibrium": EQUILIBRIA[keys.equilibrium]()}

"""What a `BearingElement` may be made of: the kinds of its choices, one dtype."""

from typing import Any

import equinox as eqx
import jax

from ..contact.line import AbstractLineLaw
from ..contact.point_law import AbstractPointLaw
from ..numerics.minimise import AbstractMinimiser
from ..numerics.quadrature import AbstractQuadrature
from .ball_speed import AbstractRacewayControl
from .kinematics import AbstractKinematics

KINDS = {
    "line_law": (
        AbstractLineLaw,
        "Palmgren(), ISO16281(), LineConstant(...) or CoupledSlices()",
    ),
    "kinematics": (
        AbstractKinematics,
        "Linearised(), Finite() or, of balls, ConstantAngle()",
    ),
    "quadrature": (AbstractQuadrature, "ContactMapped() or Midpoint()"),
    "equilibrium": (AbstractMinimiser, "TrustRegionNewton() or BFGS()"),
    "point_law": (
        AbstractPointLaw,
        "FreeAngle(), ZeroAngle(), OperatingAngle() or PointConstant(...)",
    ),
    "raceway_control": (
        AbstractRacewayControl,
        "OuterControl(), InnerControl(), EqualShare(), LoadShare(), FrictionLimited(),"
        " OperatingCentrifugal() or CentrifugalOnly()",
    ),
}
"""Of each choice of a `BearingElement`: its class, and what a message says of it."""


def in_one_dtype(tree: Any) -> Any:
    """All real numbers in JAX's floating type: float64, or float32 if that is off."""
    dtype = jax.dtypes.canonicalize_dtype(float)

    def cast(leaf):
        other = eqx.is_inexact_array(leaf) and leaf.dtype != dtype
        return leaf.astype(dtype) if other else leaf

    return jax.tree.map(cast, tree)


def check_kinds(choices: dict) -> None:
    """Raise unless each choice is `None` or of its class.

    A text or the class itself (`Finite` for `Finite()`) would be taken for another
    choice, and nothing would say so.
    """
    for name, value in choices.items():
        kind, allowed = KINDS[name]
        if value is not None and not isinstance(value, kind):
            of_itself = isinstance(value, type)
            shown = f"the class {value.__name__}" if of_itself else repr(value)
            raise TypeError(
                f"BearingElement: `{name}` is {shown}; it must be {allowed}."
            )

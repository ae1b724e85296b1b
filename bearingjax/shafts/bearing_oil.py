"""Oil of a bearing, and the power that the bearing loses with it."""

from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from ..friction.friction import friction_torque
from ..friction.friction_skf import skf_friction_torque
from ..lubrication import Lubricant
from ..numerics.types import RealOrNone, Scalar, as_real
from ..numerics.units import real, unit
from ..statics.solution import Solution


class BearingOil(eqx.Module):
    """Oil of a bearing, for its friction.

    Attributes:
        lubricant: The oil.
        temperature: Its temperature [K]; `None`: that of the rings (`ThermalPaths`).
        supply: As in `friction_torque`.
        skf: Whether friction is that of SKF's model, else of Palmgren's.
        series: Series of SKF's model, as in `skf_friction_torque`.
        diameters: Bore and outside diameter for SKF's model (2,) [m].

    Traced: all numbers. Static: supply, skf, series.
    """

    lubricant: Lubricant
    temperature: RealOrNone = eqx.field(**real("K"), default=None)
    supply: str = eqx.field(static=True, default="oil_bath")
    skf: bool = eqx.field(static=True, default=False)
    series: str | None = eqx.field(static=True, default=None)
    diameters: Float[Array, "2"] | None = eqx.field(
        converter=as_real, metadata=unit(2 * ("m",)), default=None
    )

    def power(self, solution: Solution, temperature: Any = None) -> Scalar:
        """Return the power lost in a bearing [W].

        Args:
            solution: Solution of the bearing, turning.
            temperature: Temperature of the oil, in place of its own [K].

        Raises:
            ValueError: For bearings without known constants of friction.
        """
        warm: Any = self.temperature if temperature is None else temperature
        given = solution, self.lubricant.kinematic_viscosity(warm), self.supply
        if not self.skf:
            return friction_torque(*given).power
        sizes = None if self.diameters is None else tuple(self.diameters)
        return skf_friction_torque(*given, series=self.series, diameters=sizes).power

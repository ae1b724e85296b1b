"""Free end faces: a roller that ends is softer there than a half-space."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from ...design.checks import positive
from ...design.material import Material, contact_modulus
from ...numerics.types import RealOrNone, Scalar
from ...numerics.units import real

WEDGE = 0.5 * np.pi * (1.0 / (0.5 * np.pi + 1.0) + 1.0 / (0.5 * np.pi - 1.0)) - 1.0
"""Factor far along the edge: a line load on a wedge of 90 degrees relative to one on a
half-plane, less the load itself, 2.363."""

_FACTOR = (
    (
        (-3.906, 4.873, 4.0426, -3.4409, 14.1754),
        (0.0437, -0.0696, 0.0798, -0.0656, -0.09),
        (0.0153, -0.1605, 0.0943, -0.0259, 0.0898),
    ),
    (
        (4.6487, -10.4454, 3.5221, -2.8449, 1.1092),
        (-0.2481, 0.322, -0.4458, 0.39, 0.8177),
        (1.067, 1.4561, -3.0513, 1.608, -1.3365),
    ),
    (
        (-3.0683, 8.386, -4.5531, 3.7171, -6.9944),
        (0.1922, -0.5247, 0.4698, -0.4468, -2.0358),
        (-0.4995, -2.6827, 7.3706, -4.0739, 3.204),
    ),
    (
        (0.9861, -2.3142, 0.5672, -0.4415, 1.0155),
        (-0.0933, 0.3165, -0.0307, 0.0597, 1.4441),
        (-0.133, 1.3054, -4.2067, 2.3883, -1.9849),
    ),
)
"""Coefficients of the factor less `WEDGE`: of powers of Poisson's ratio, in those of
2·sqrt(yy')/(y + y'), in those from the first of (2/π)·arctan((y + y')/x).
`benchmarks/quarter_space.py --fit`; they leave 0.002 at most."""


class FreeEnds(eqx.Module):
    """The roller's end faces bear no stress: the pressure mirrored at them, times more.

    The mirrored load takes the shear stress off an end face, and a normal stress is
    left on it; freeing the face of that as well (Hetényi's alternation of two
    half-spaces) makes the mirrored load's displacement `factor` times as large. That
    is no constant: for Poisson's ratio 0.3 it is 1.85 where point and load are equally
    far from the face, 1.5 where one is much farther, and rises to 2.36 where they are
    apart along the edge, as a wedge of 90 degrees has for any ratio. Without a number
    given it is taken for each pair of cells, by their places and Poisson's ratio.

    Only the roller ends; the raceway goes on as a half-space.

    Attributes:
        factor: On the displacement by the mirrored pressure [1]; 1: the mirrored load
            alone; `None`: by place, as above.

    Traced: all fields.
    Source: M. Hetényi, J. Appl. Mech. 37 (1970); the mirrored load with a factor:
        Guilbault, J. Tribol. 133 (2011); the values: `benchmarks/quarter_space.py`.
    Valid: One end at a time: the other far away; end faces square to the generatrix.
    """

    factor: RealOrNone = eqx.field(**real("1"), default=None)

    def __check_init__(self):
        if self.factor is not None:
            positive(self, "factor")

    def weight(self, roller: Material, raceway: Material) -> "MirroredWeight":
        """Weight of the mirrored pressure in the displacement of both bodies together.

        Args:
            roller, raceway: Materials.
        """
        poisson = roller.poisson_ratio
        own = (1.0 - poisson**2) / roller.elastic_modulus
        return MirroredWeight(
            own * contact_modulus(roller, raceway), poisson, factor=self.factor
        )


class MirroredWeight(eqx.Module):
    """Weight of pressure mirrored at an end face, see `FreeEnds`.

    Attributes:
        share: The roller's part of both bodies' compliance [1].
        poisson: Poisson's ratio of the roller [1].
        factor: One for all places [1], or `None`.

    Traced: all fields.
    """

    share: Scalar
    poisson: Scalar
    factor: Scalar | None

    def __call__(self, x: Any, y: Any, other: Any, xp: Any = jnp) -> Any:
        """Weight at a point, for pressure at another (...) [1].

        Args:
            x: Distance between both along the edge (...) [m].
            y, other: Their distances from the end face (...) [m].
            xp: `jax.numpy`, or `numpy` for numbers that nothing traces.
        """
        share, poisson = (xp.asarray(v, y.dtype) for v in (self.share, self.poisson))
        if self.factor is not None:
            return share * xp.asarray(self.factor, y.dtype)
        level = 2.0 * xp.sqrt(y * other) / (y + other)
        angle = xp.arctan2(y + other, x) / (0.5 * np.pi)
        # Innermost first: the largest array takes the fewest steps.
        by_level = ([_power_sum(k, poisson) for k in j] for j in _FACTOR)
        by_angle = [WEDGE, *(_power_sum(j, level) for j in by_level)]
        return share * _power_sum(by_angle, angle)


def _power_sum(coefficients, x):
    total = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = total * x + coefficient
    return total

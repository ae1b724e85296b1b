"""Free end faces: a roller that ends is softer there than a half-space."""

import equinox as eqx
import jax.numpy as jnp

from ...design.checks import positive
from ...design.material import Material, contact_modulus
from ...numerics.types import Scalar, as_real

_OF_POISSON = (6.44, 0.83, 0.76, 1.322)
"""Factor by Poisson's ratio, a cubic, to 0.005 of the values computed at 0 to 0.5."""


class FreeEnds(eqx.Module):
    """The roller's end faces bear no stress: the pressure mirrored at them, times more.

    The mirrored load takes the shear stress off an end face, and a normal stress is
    left on it; freeing the face of that as well (Hetényi's alternation of two
    half-spaces) makes the mirrored load's displacement `factor` times as large. The
    factor is not one number: for Poisson's ratio 0.3 it is 1.85 where point and load
    are equally far from the face, 1.5 where one is much farther, and rises to 2.36
    where they are apart along the edge. Without a number given it is that of a narrow
    contact with one twice as far from the face as the other, 1.80 of steel.

    Only the roller ends; the raceway goes on as a half-space. The factor is spread over
    both bodies by their compliances.

    Attributes:
        factor: On the displacement by the mirrored pressure [1]; 1: the mirrored load
            alone; `None`: as above, of the roller's Poisson's ratio.

    Traced: all fields.
    Source: M. Hetényi, J. Appl. Mech. 37 (1970); the mirrored load with a factor:
        Guilbault, J. Tribol. 133 (2011); the values: `benchmarks/quarter_space.py`.
    Valid: Contacts narrow beside their distance from the face; nearer to it than their
        half width the true displacement is larger still.
    """

    factor: Scalar | None = eqx.field(converter=as_real, default=None)

    def __check_init__(self):
        if self.factor is not None:
            positive(self, "factor", self.factor, "")

    def share(self, roller: Material, raceway: Material) -> Scalar:
        """Factor on the displacement of both bodies together [1].

        Args:
            roller, raceway: Materials.
        """
        poisson = roller.poisson_ratio
        factor = self.factor
        if factor is None:
            factor = jnp.polyval(jnp.asarray(_OF_POISSON, poisson.dtype), poisson)
        own = (1.0 - poisson**2) / roller.elastic_modulus
        return factor * own * contact_modulus(roller, raceway)

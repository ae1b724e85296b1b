"""Viscosity at 100 °C from that at 40 °C and the viscosity index.

Source: ASTM D2270; L and H by the quadratics of its appendix X2, which meet the table
to 1e-3.
"""

import jax.numpy as jnp
import numpy as np
from jax import lax

from ..design.checks import check, floats, in_range, positive
from ..numerics.compiled.programs import program
from ..numerics.implicit import attach_roots, stop_gradient
from ..numerics.types import Number, Scalar, array_namespace, as_real

# Of L and of H = a Y² + b Y + c, mm²/s, from Y on.
_FROM = np.asarray([2, 3.8, 4.4, 5, 6.4, 7, 7.7, 9, 12, 15, 18, 22, 28, 40, 55, 70.0])
_L = np.asarray(
    [
        [1.14673, 1.7576, -0.109],
        [3.38095, -15.4952, 33.196],
        [2.5, -7.2143, 13.812],
        [0.101, 16.635, -45.469],
        [3.35714, -23.5643, 78.466],
        [0.01191, 21.475, -72.870],
        [0.41858, 16.1558, -56.040],
        [0.88779, 7.5527, -16.600],
        [0.7672, 10.7972, -38.180],
        [0.97305, 5.3135, -2.200],
        [0.97256, 5.25, -0.980],
        [0.91413, 7.4759, -21.820],
        [0.87031, 9.7157, -50.770],
        [0.84703, 12.6752, -133.310],
        [0.85921, 11.1009, -83.19],
        [0.83531, 14.6731, -216.246],
    ]
)
_H = np.asarray(
    [
        [0.84155, 1.5521, -0.077],
        [0.78571, 1.7929, -0.183],
        [0.82143, 1.5679, 0.119],
        [0.04985, 9.1613, -18.557],
        [0.22619, 7.7369, -16.656],
        [0.79762, -0.7321, 14.61],
        [0.05794, 10.5156, -28.240],
        [0.26665, 6.7015, -10.810],
        [0.20073, 8.4658, -22.490],
        [0.28889, 5.9741, -4.930],
        [0.24504, 7.416, -16.730],
        [0.20323, 9.1267, -34.230],
        [0.18411, 10.1015, -46.750],
        [0.17029, 11.4866, -80.620],
        [0.1713, 11.368, -76.940],
        [0.16841, 11.8493, -96.947],
    ]
)
_MOST = 1000.0
_HALVINGS = 52


def viscosity_at_100(viscosity: Number, index: Number) -> Scalar:
    """Kinematic viscosity at 100 °C.

    Args:
        viscosity: Kinematic viscosity at 40 °C [m²/s].
        index: Viscosity index, 0 to 400 [1].

    Returns:
        Kinematic viscosity at 100 °C, at least 2e-6 m²/s (where the standard begins)
        [m²/s].

    Raises:
        ValueError: If the viscosity is below that of any oil of that index.
    """
    owner = "viscosity_at_100"
    positive(owner, "viscosity", viscosity, "m²/s")
    in_range(owner, "index", 0.0, 400.0, index, "", include_low=True)
    known = floats(viscosity, index)
    if known is not None:
        least = 1e-6 * float(_at_40(np.float64(_FROM[0]), np.float64(known[1])))
        words = f"at least {least:.4g} m²/s with a viscosity index of {known[1]:.4g}"
        check(owner, "viscosity", known[0] >= least, words, viscosity, "m²/s")
    return _solve(as_real(viscosity), as_real(index))


def _at_40(hot, index):
    """Viscosity at 40 °C of an oil of a given one at 100 °C, both [mm²/s]."""
    np_ = array_namespace(hot)
    row = np_.clip(np_.searchsorted(_FROM, hot, side="right") - 1, 0, len(_FROM) - 1)
    powers = np_.stack([hot * hot, hot, np_.ones_like(hot)])
    low = np_.dot(np_.asarray(_L, hot.dtype)[row], powers)
    high = np_.dot(np_.asarray(_H, hot.dtype)[row], powers)
    factor = 1.0 + 0.00715 * np_.maximum(index - 100.0, 0.0)
    # H·Y^(-N) with 10^N = factor.
    above = high * np_.exp(-np_.log10(factor) * np_.log(hot))
    return np_.where(index <= 100.0, low - 0.01 * index * (low - high), above)


@program(quick=True)
def _solve(viscosity, index):
    def residual(hot, args):
        viscosity, index = args
        return _at_40(hot, index) - 1e6 * viscosity

    frozen = stop_gradient((viscosity, index))

    def halve_interval(_, ends):
        low, high = ends
        middle = jnp.sqrt(low * high)
        above = residual(middle, frozen) > 0
        return jnp.where(above, low, middle), jnp.where(above, middle, high)

    ends = jnp.full_like(viscosity, _FROM[0]), jnp.full_like(viscosity, _MOST)
    low, high = lax.fori_loop(0, _HALVINGS, halve_interval, stop_gradient(ends))
    return 1e-6 * attach_roots(residual, 0.5 * (low + high), (viscosity, index))

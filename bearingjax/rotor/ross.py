"""Adapter to ROSS, rotordynamics by finite elements (`ross-rotordynamics`)."""

import importlib
from typing import Any

import jax.numpy as jnp
import numpy as np

from ..element.bearing_element import BearingElement, check_element
from ..element.function import check_damping
from ..numerics.types import as_real
from .linear.coefficients import stiffness_table


def to_ross(
    element: BearingElement,
    n: int,
    speeds: Any,
    load: Any,
    *,
    damping: Any = 0.0,
    tilts: str = "held",
    fixed_ring: str = "outer",
    **others: Any,
) -> Any:
    """Return a `ross.BearingElement` with bearing stiffness over rotor speed.

    Axes: those of ROSS are ours. Its rotor axis is z along rising node numbers, its
    freedoms of a node are (x, y, z, alpha, beta, theta) with alpha about +x and beta
    about +y, its rotor turns from x towards y, and its gravity pulls along -y. A
    bearing that faces the other way is a row with `mirrored=True` of a `BearingSet`.

    A bearing of ROSS couples translations only, and z with nothing: kxx, kxy, kyx,
    kyy and kzz are passed on; kxz, kzx, kyz, kzy and all moments are not (a shaft
    that is to feel them needs all of `linearise`). ROSS reads the table at the
    frequency of excitation, by default the rotor speed (modes, Campbell diagram,
    unbalance response), between speeds by a cubic spline.

    Args:
        element: The bearing.
        n: Node of the rotor that the moving ring sits on.
        speeds: Rotor speeds, rising (speed,) [rad/s]; one: constant coefficients.
        load: On the moving ring (6,) or (speed, 6) [N, N m].
        damping: c of x, y and z, or C (3, 3), or (speed, 3, 3) [N s/m]; nothing is
            made up: zero unless given.
        tilts, fixed_ring: As `stiffness_table`.
        others: Further arguments of `ross.BearingElement`, such as `n_link`, the node
            that the other ring sits on (default: ground), or `tag`, its name.

    Returns:
        ross.BearingElement.

    Raises:
        ImportError: Without ROSS; `pip install "bearingjax[ross]"`.
        ValueError: As `stiffness_table`; if the speeds do not rise, or the damping is
            of another shape, not finite or negative on its diagonal.
        SolveError: If a solve fails; the message names the speed.

    Source: frame and orders of ROSS 2.3 to 3.1, `ShaftElement.K`, `DiskElement.G`,
        `Rotor._unbalance_force` and `gravitational_force`; a test holds them.
    """
    check_element("to_ross", element)
    try:
        ross = importlib.import_module("ross")
    except ImportError as error:
        raise ImportError(
            "to_ross: ROSS is not installed or misses a package"
            f' ({error}): pip install "bearingjax[ross]".'
        ) from error
    coefficients = _coefficients(element, speeds, load, damping, tilts, fixed_ring)
    return ross.BearingElement(n=n, **coefficients, **others)


def _coefficients(element, speeds, load, damping, tilts, fixed_ring) -> dict:
    """Return arguments of `ross.BearingElement`, each over speed."""
    speeds = np.asarray(speeds, dtype=float)
    if speeds.ndim == 1 and not (np.diff(speeds) > 0).all():
        raise ValueError("to_ross: `speeds` must rise from each to the next [rad/s].")
    k = np.asarray(
        stiffness_table(element, speeds, load, tilts=tilts, fixed_ring=fixed_ring)
    )
    c = as_real(damping)
    check_damping("to_ross", c, ((), (3, 3), k.shape))
    c = c * jnp.eye(3, dtype=c.dtype) if c.ndim == 0 else c
    c = np.broadcast_to(np.asarray(c), k.shape)
    places = {"xx": (0, 0), "xy": (0, 1), "yx": (1, 0), "yy": (1, 1), "zz": (2, 2)}
    table = {f"k{at}": k[:, i, j] for at, (i, j) in places.items()}
    table |= {f"c{at}": c[:, i, j] for at, (i, j) in places.items()}
    return {"frequency": speeds, **table}

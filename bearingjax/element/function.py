"""The bearing as a pure function of time, for a rotor model written in JAX.

Two plain functions and what they are given: nothing is closed over, so that any
integrator may pass the parameters through as traced numbers. The contact constants
are worked out from the design in every call, because then every parameter is a number
of the drawing, with its full derivative, and may change from call to call (a run-up);
in a compiled loop of 2000 calls that cost nothing measurable, rollers or balls.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import BearingSet, rows_of
from ..design.checks import check
from ..numerics.types import Ring, Scalar, as_real
from .inertia import Speed
from .row import azimuths


class FunctionParameters(eqx.Module):
    """All real numbers of a bearing as a function of time.

    Attributes:
        element: The `BearingElement`.
        speed: Ring speeds, or `None`: rings at rest, no inertia.
        damping: None, a number c [N s/m], or a matrix (12, 12) [N s/m, N s, N m s].

    Traced: all real numbers.
    """

    element: Any
    speed: Speed | None
    damping: Float[Array, "..."] | None


Motion = Float[Array | np.ndarray, "12"]
"""Twelve numbers, outer ring first."""

RingFunction = Callable[[Motion, Motion, Any, FunctionParameters], Ring]
"""function(motion, velocity, time, parameters): `ring_force` or `orbiting_force`."""


def ring_force(
    motion: Motion,
    velocity: Motion,
    time: Scalar | float,
    parameters: FunctionParameters,
) -> Ring:
    """Force that holds the rings, the rolling elements where gz has them.

    Args:
        motion: Ring freedoms, outer then inner [m, rad].
        velocity: Their rates [m/s, rad/s].
        time: Not used.
        parameters: From `BearingElement.as_function`.

    Returns:
        Force (12,) [N, N m], NaN if a rolling element did not converge.

    Raises:
        ValueError: If `motion` or `velocity` is not of shape (12,).
    """
    for name, value in (("motion", motion), ("velocity", velocity)):
        if jnp.shape(value) != (12,):
            raise ValueError(
                f"BearingElement: `{name}` has shape {jnp.shape(value)}; it must be"
                " (12,): outer ring (ux uy uz gx gy gz), then inner ring."
            )
    force = parameters.element.model(parameters.speed).force_or_nan(jnp.asarray(motion))
    if parameters.damping is None:
        return force
    damping = parameters.damping
    if damping.ndim == 0:
        damping = damping * jnp.asarray(_BETWEEN_RINGS, damping.dtype)
    return force + damping @ jnp.asarray(velocity)


def orbiting_force(
    motion: Motion,
    velocity: Motion,
    time: Scalar | float,
    parameters: FunctionParameters,
) -> Ring:
    """Force that holds the rings while the rolling elements orbit.

    `ring_force` with the elements turned by what the rings have turned at their
    speeds since time zero; differentiable with respect to time and speed.

    Args:
        motion: Ring freedoms, outer then inner [m, rad]; a gz turns the elements on
            top of that.
        velocity: Their rates [m/s, rad/s].
        time: Time [s].
        parameters: From `BearingElement.as_function`.

    Returns, raises: as `ring_force`.
    """
    element, speed = parameters.element, parameters.speed
    if speed is not None:
        element = _turned(element, speed, time)
        parameters = FunctionParameters(element, speed, parameters.damping)
    return ring_force(motion, velocity, time, parameters)


def as_function(
    element: Any, speed: Speed | None, damping: Any, orbit: bool
) -> tuple[RingFunction, FunctionParameters]:
    """What `BearingElement.as_function` returns; see there."""
    if speed is not None and not isinstance(speed, Speed):
        raise TypeError(
            f"BearingElement: `speed` is a {type(speed).__name__}; it must be a"
            " Speed(inner, outer) in rad/s, or None."
        )
    if damping is not None:
        damping = as_real(damping)
        check_damping("BearingElement", damping, ((), (12, 12)))
    function = orbiting_force if orbit else ring_force
    return function, FunctionParameters(element, speed, damping)


def check_damping(owner: str, damping: Any, shapes: tuple[tuple[int, ...], ...]):
    """Raise unless `damping` has one of the shapes, is finite and does not drive.

    Args:
        owner: Who was given it.
        damping: A number or matrices [N s/m].
        shapes: Those allowed.

    Raises:
        TypeError: If it is no number.
        ValueError: If its shape is another, it is not finite, or a diagonal is
            negative.
    """
    shape = getattr(damping, "shape", None)
    if shape is None:
        raise TypeError(
            f"{owner}: `damping` is {damping!r}; it must be numbers in N s/m."
        )
    if shape not in shapes:
        allowed = " or ".join(str(s) if s else "one number" for s in shapes)
        raise ValueError(f"{owner}: `damping` has shape {shape}; it must be {allowed}.")
    diagonal = jnp.diagonal(damping, axis1=-2, axis2=-1) if shape else damping
    good = jnp.all(jnp.isfinite(damping)) & jnp.all(diagonal >= 0)
    check(owner, "damping", good, "finite, its diagonal at least 0", damping, "N s/m")


def _turned(element: Any, speed: Speed, time: Any) -> Any:
    """The element with its rolling elements where they are at a time.

    They are turned by their first azimuth, not by gz, which derivatives hold.
    """
    gz = jnp.zeros(12, speed.inner.dtype)
    gz = gz.at[5].set(speed.outer * time).at[11].set(speed.inner * time)
    first = [azimuths(row.bearing, gz)[0] for row in rows_of(element.bearing)]
    return eqx.tree_at(_first_azimuths, element, first)


def _first_azimuths(element: Any) -> list:
    bearing = element.bearing
    if isinstance(bearing, BearingSet):
        return [row.bearing.first_azimuth for row in bearing.rows]
    return [bearing.first_azimuth]


_BETWEEN_RINGS = np.kron([[1, -1], [-1, 1]], np.diag([1, 1, 1, 0, 0, 0]))
"""A dashpot between the origins of both rings, alike in x, y and z."""

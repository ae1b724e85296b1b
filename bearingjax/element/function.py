"""The bearing as a pure function of time, for a rotor model written in JAX.

Two plain functions and their parameters: there are no closures, so that any
integrator may pass the parameters through as traced numbers. The contact constants
are computed from the design in every call, because then every parameter is a number
of the drawing, with its full derivative, and may change from call to call (a run-up);
in a compiled loop of 2000 calls that cost nothing measurable, rollers or balls.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check, must_be, of_class, of_shape
from ..numerics.types import Number, Reals, as_real
from .frame import TWELVE
from .inertia import Speed


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
    damping: Reals | None


Motion = Float[Array | np.ndarray, "12"]
"""Twelve numbers, outer ring first."""

RingFunction = Callable[..., Any]
"""function(motion, velocity, time, parameters, near=None): `ring_force` or
`orbiting_force`."""


def ring_force(
    motion: Motion,
    velocity: Motion,
    time: Number,
    parameters: FunctionParameters,
    near: Any = None,
) -> Any:
    """Force that holds the rings, the rolling elements where gz has them.

    Args:
        motion: Ring freedoms, outer then inner [m, rad].
        velocity: Their rates [m/s, rad/s].
        time: Not used.
        parameters: From `BearingElement.as_function`.
        near: The rolling elements near by, as this function returned them.

    Returns:
        Force (12,) [N, N m], NaN if a rolling element did not converge; with `near`
        (force, near) for the next call.

    Raises:
        ValueError: If `motion` or `velocity` is not of shape (12,).
    """
    return _force(motion, velocity, None, parameters, near)


def orbiting_force(
    motion: Motion,
    velocity: Motion,
    time: Number,
    parameters: FunctionParameters,
    near: Any = None,
) -> Any:
    """Force that holds the rings while the rolling elements orbit.

    `ring_force` with the elements turned by the rotation of the rings at their speeds
    since time zero; differentiable with respect to time and speed.

    Args:
        motion: Ring freedoms, outer then inner [m, rad]; a gz turns the elements in
            addition.
        velocity: Their rates [m/s, rad/s].
        time: Time [s].
        parameters: From `BearingElement.as_function`.
        near: As in `ring_force`.

    Returns, raises: as `ring_force`.
    """
    return _force(motion, velocity, time, parameters, near)


def _force(motion, velocity, time, parameters, near):
    for name, value in (("motion", motion), ("velocity", velocity)):
        fits = jnp.shape(value) == (12,)
        of_shape("BearingElement", name, fits, TWELVE, value)
    speed, damping = parameters.speed, parameters.damping
    model = parameters.element.model(speed)
    motion = jnp.asarray(motion)
    turned = motion
    model.check_near(near)
    if time is not None and speed is not None:
        turned = turned.at[_GZ].add(jnp.stack([speed.outer, speed.inner]) * time)
    solved = model.solve(motion, near, model.azimuths(turned))
    force = model.force_or_nan(motion, solved)
    if damping is not None:
        if damping.ndim == 0:
            damping = damping * jnp.asarray(_BETWEEN_RINGS, damping.dtype)
        force = force + damping @ jnp.asarray(velocity)
    return force if near is None else (force, model.starts(solved))


def as_function(
    element: Any, speed: Speed | None, damping: Any, orbit: bool
) -> tuple[RingFunction, FunctionParameters]:
    """Return the function and parameters of `BearingElement.as_function`; see there."""
    allowed = "a Speed(inner, outer) in rad/s, or None"
    of_class("BearingElement", "speed", speed, Speed | None, allowed)
    if damping is not None:
        damping = as_real(damping)
        check_damping("BearingElement", damping, ((), (12, 12)))
    function = orbiting_force if orbit else ring_force
    return function, FunctionParameters(element, speed, damping)


def check_damping(
    owner: str, damping: Any, shapes: tuple[tuple[int, ...], ...]
) -> None:
    """Raise unless `damping` has one of the shapes, is finite and does not drive.

    Args:
        owner: Who was given it.
        damping: A number or matrices [N s/m].
        shapes: Shapes that are allowed.

    Raises:
        TypeError: If it is no number.
        ValueError: If its shape is another, it is not finite, or a diagonal is
            negative.
    """
    shape = getattr(damping, "shape", None)
    numbers = "numbers in N s/m"
    must_be(owner, "damping", damping, shape is not None, numbers, TypeError)
    allowed = " or ".join(str(s) if s else "one number" for s in shapes)
    of_shape(owner, "damping", shape in shapes, allowed, damping)
    diagonal = jnp.diagonal(damping, axis1=-2, axis2=-1) if shape else damping
    good = jnp.all(jnp.isfinite(damping)) & jnp.all(diagonal >= 0)
    check(owner, "damping", good, "finite, its diagonal at least 0", damping, "N s/m")


_GZ = np.array([5, 11])
"""Turns of both rings about the axis among their freedoms."""

_BETWEEN_RINGS = np.kron([[1, -1], [-1, 1]], np.diag([1, 1, 1, 0, 0, 0]))
"""A dashpot between the origins of both rings, alike in x, y and z."""

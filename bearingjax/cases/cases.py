"""Many operating cases of one bearing: loads, displacements, speeds, hours."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design.checks import is_traced, must_be, real_numbers
from ..element import FREEDOMS, BearingElement, Speed
from ..element.frame import LOAD_UNITS, MOTION_UNITS
from ..numerics.labels import LabelledArray
from ..numerics.shown import Printable
from ..numerics.units import unit
from ..statics import Solution, SolveOptions, Support
from ..statics.load import solve
from ..statics.support import DICT_OF_FREEDOMS, RESTRAINED


class Cases(Printable):
    """Operating cases, all fields with a leading axis (case,).

    Loads, displacements and speeds are not checked by value: a case with a NaN or an
    absurd number fails, with its own result code.

    Attributes:
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring (case, 6) [N, N m].
        prescribed: Displacements given instead of loads, by freedom (case,) [m, rad].
        fixed_displacement: Displacement of the fixed ring (case, 6) [m, rad]; `None`:
            zero.
        inner_speed: Speed of the inner ring (case,) [rad/s], or `None`. If both speeds
            are `None` there is no inertia, and none is compiled.
        outer_speed: Speed of the outer ring (case,) [rad/s], or `None`.
        hours: Time that the machine spends in each case (case,) [h], or `None`.
        design: Which of several designs each case has (case,), or `None`.
        viscosity: Kinematic viscosity of the oil in each case, in place of that of the
            `LifeConditions` (case,) [m²/s], or `None`.
        oscillation: Amplitude of the inner ring against the outer one, half of the
            whole swing (case,) [rad]; 0, `None`: the rings turn. The speed is then the
            mean one, as in `rating_life`.

    Traced: all fields.
    """

    load: Float[Array | np.ndarray, "case component=6"] = eqx.field(
        metadata=unit(LOAD_UNITS)
    )
    prescribed: dict[str, Float[Array | np.ndarray, " case"]] = eqx.field(
        metadata=unit(MOTION_UNITS)
    )
    fixed_displacement: Float[Array | np.ndarray, "case freedom=6"] | None = eqx.field(
        metadata=unit(MOTION_UNITS)
    )
    inner_speed: Float[Array | np.ndarray, " case"] | None = eqx.field(
        metadata=unit("rad/s")
    )
    outer_speed: Float[Array | np.ndarray, " case"] | None = eqx.field(
        metadata=unit("rad/s")
    )
    hours: Float[Array | np.ndarray, " case"] | None = eqx.field(metadata=unit("h"))
    design: Int[Array | np.ndarray, " case"] | None
    viscosity: Float[Array | np.ndarray, " case"] | None = eqx.field(
        metadata=unit("m²/s")
    )
    oscillation: Float[Array | np.ndarray, " case"] | None = eqx.field(
        metadata=unit("rad")
    )

    @staticmethod
    def label_entry(freedom: str, values: Any) -> LabelledArray:
        """Return displacements of `prescribed` with their labels."""
        units = "m" if freedom.startswith("u") else "rad"
        return LabelledArray(np.asarray(values), ("case",), units)

    def __init__(
        self,
        load: Any = None,
        *,
        prescribed: Mapping[str, Any] | None = None,
        fixed_displacement: Any = None,
        inner_speed: Any = None,
        outer_speed: Any = None,
        hours: Any = None,
        design: Any = None,
        viscosity: Any = None,
        oscillation: Any = None,
    ):
        """Arguments without a case axis hold for all cases.

        Raises:
            TypeError: For text in place of numbers, or designs that are not whole.
            ValueError: For shapes that do not fit, unknown freedoms, hours below
                zero or without a sum above zero, amplitudes below zero or above half a
                turn, no cases, or if nothing has a case axis.
        """
        given = isinstance(prescribed, Mapping | None)
        allowed = f"{DICT_OF_FREEDOMS}, such as {{'uz': [1e-5, 2e-5]}}"
        must_be("Cases", "prescribed", prescribed, given, allowed, TypeError)
        prescribed = {} if prescribed is None else dict(prescribed)
        unknown = [name for name in prescribed if name not in FREEDOMS]
        if unknown:
            raise ValueError(
                f"Cases: `prescribed` names {', '.join(map(repr, unknown))}; freedoms"
                f" are {', '.join(FREEDOMS)}."
            )
        scalars = {
            "inner_speed": inner_speed,
            "outer_speed": outer_speed,
            "hours": hours,
            "design": design,
            "viscosity": viscosity,
            "oscillation": oscillation,
            **prescribed,
        }
        vectors = {"load": load, "fixed_displacement": fixed_displacement}
        arrays = {
            name: _array(name, value, tail)
            for group, tail in ((scalars, ()), (vectors, (6,)))
            for name, value in group.items()
            if value is not None
        }
        lead = {
            name: a.shape[0] for name, a in arrays.items() if a.ndim > (name in vectors)
        }
        if not lead:
            raise ValueError(
                "Cases: nothing has a case axis; give loads of shape (case, 6), or"
                " speeds, displacements or designs of shape (case,)."
            )
        if len(set(lead.values())) > 1:
            sizes = ", ".join(f"{name} {size}" for name, size in lead.items())
            raise ValueError(f"Cases: not one number of cases: {sizes}.")
        count = next(iter(lead.values()))
        if count == 0:
            raise ValueError("Cases: there are none; one at least.")
        arrays.setdefault("load", np.zeros(6))

        def fill_cases(name) -> Any:
            if name not in arrays:
                return None
            tail = (6,) if name in vectors else ()
            array = arrays[name]
            whole = (count, *tail)
            if array.shape == whole:
                return array
            backend = jnp if isinstance(array, jax.Array) else np
            return backend.broadcast_to(array, whole)

        for name in (*vectors, *scalars):
            if name not in prescribed:
                setattr(self, name, fill_cases(name))
        self.prescribed = {name: fill_cases(name) for name in prescribed}
        check_hours(self.hours)
        if oscillation is not None and not is_traced(oscillation):
            swings = np.asarray(oscillation)
            known = not np.any((swings < 0) | (swings > np.pi + 1e-9))
            allowed = "0 to pi rad, half of the whole swing"
            must_be("Cases", "oscillation", swings, known, allowed)

    def check_oil(self, owner: str) -> None:
        """Raise for cases with an oil of their own, or that oscillate.

        Args:
            owner: Name of the function that does not know such cases.

        Raises:
            ValueError: If `viscosity` or `oscillation` is given.
        """
        for name in ("viscosity", "oscillation"):
            allowed = "left out here; `sweep` with `spectrum_life` knows it"
            must_be(owner, name, "given", getattr(self, name) is None, allowed)

    @property
    def count(self) -> int:
        """Number of cases."""
        return self.load.shape[0]


def _array(name, value, tail):
    if not isinstance(value, jax.Array):
        real_numbers("Cases", name, value, "numbers (units belong in scenes)")
        try:
            value = np.asarray(value)
        except ValueError as error:
            raise ValueError(f"Cases: `{name}` has rows of unlike length.") from error
    if name != "design":
        # JAX's too: a case may start from the solution of the one before it.
        value = value.astype(float)
    elif np.size(value) and value.dtype.kind not in "iu":
        raise TypeError(f"Cases: `design` is {value!r}; it must be whole numbers.")
    shape = np.shape(value)
    if shape not in (tail, shape[:1] + tail):
        wanted = "(6,) or (case, 6)" if tail else "() or (case,)"
        raise ValueError(f"Cases: `{name}` has shape {shape}; it must be {wanted}.")
    return value


def check_hours(hours: Any) -> None:
    """Raise unless the hours of cases are finite, not negative, and not all zero.

    Args:
        hours: Time in each case [h], or `None`; traced ones are not checked.

    Raises:
        ValueError: If they are not.
    """
    if hours is None or is_traced(hours):
        return
    values = np.atleast_1d(hours)
    allowed = "finite, at least 0 h each, and above 0 h in all"
    wrong = np.flatnonzero(~(np.isfinite(values) & (values >= 0)))
    if wrong.size:
        worst = f"{values[wrong[0]]:g} h in case {wrong[0]}"
        raise ValueError(f"Cases: `hours` is {worst}; it must be {allowed}.")
    if not values.sum() > 0:
        raise ValueError(f"Cases: `hours` is 0 h in all; it must be {allowed}.")


def solve_case(
    element: BearingElement[Any],
    case: Cases,
    support: Support = RESTRAINED,
    options: SolveOptions | None = None,
    start: Float[Array, "6"] | None = None,
) -> Solution:
    """One case of many, to be mapped: `jax.vmap(lambda c: solve_case(element, c))`.

    Args:
        element: The bearing of this case.
        case: Cases without their leading axis, as `vmap` hands them out.
        support: What holds the rings; displacements are those of the case.
        options, start: As in `solve_load`.

    Returns:
        Solution with its result code; nothing is raised for a failed solve.
    """
    held = case_support(case, support)
    speed = case_speed(case)
    return solve(element, case.load, held, options, speed=speed, start=start)


def case_support(case: Cases, support: Support) -> Support:
    """The support of all cases, with the displacements of one.

    Args:
        case: Cases without their leading axis.
        support: The free freedoms and the fixed ring.
    """
    return dataclasses.replace(
        support,
        prescribed=case.prescribed,
        fixed_displacement=case.fixed_displacement,
    )


def case_speed(case: Cases) -> Speed | None:
    """Ring speeds of one case; `None` if it has none.

    Args:
        case: Cases without their leading axis; a ring without a speed stands still.
    """
    if case.inner_speed is None and case.outer_speed is None:
        return None
    still = jnp.zeros((), case.load.dtype)
    speeds = (case.inner_speed, case.outer_speed)
    return Speed(*(still if s is None else s for s in speeds))

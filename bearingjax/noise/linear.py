"""Linear vibration of a bearing with constant coefficients, over frequency.

About the equilibrium of the bearing under its load

    M x'' + (τ K + C) x' + (K + S) x = f - G (e + τ e')

with the stiffness K of all contacts, C and S of the sensor, loads f on the coordinates
and the deviations e of the raceways at the rolling elements. G are derivatives
of the contacts' forces by e.

The rolling elements stay at their places of time zero. Where they orbit, K and G turn
with them: the answer then holds for frequencies far above that of their passage, or
where many of them carry alike.
"""

from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Complex, Float, Int

from ..design.checks import check, of_class, real_numbers
from ..numerics.compiled.programs import program
from ..numerics.lapack import solve_any
from ..numerics.types import Scalar, Square, Vector, as_real
from ..numerics.units import unit, units
from .model import NoiseModel
from .natural import contact_stiffness
from .static_start import static_start


class LinearModel(NamedTuple):
    """A bearing on its rig for small motions of its n coordinates.

    Those of the moving ring are first, k of them, then those of every rolling element.

    Attributes:
        mass: (n,) [kg, kg m²].
        stiffness: Stiffness of contacts and sensor (n, n) [N/m, N, N m].
        damping: Damping of both (n, n) [N s/m, N s, N m s].
        push: Loads on the coordinates for deviations of the raceways as in
            `Deviation.raceway` (n, element, 2, 3) [N/m, N].
        retardation: τ, by which the rate of deviations counts too [s].
        result: `Result` code of the place at which it is.
    """

    mass: Annotated[Vector, units("kg", "kg m²")]
    stiffness: Annotated[Square, units("N/m", "N", "N m")]
    damping: Annotated[Square, units("N s/m", "N s", "N m s")]
    push: Annotated[Float[Array, "n element 2 3"], units("N/m", "N")]
    retardation: Annotated[Scalar, unit("s")]
    result: Int[Array, ""]


class Transfer(NamedTuple):
    """Motion of the moving ring for unit causes that vary as exp(iωt).

    Attributes:
        frequency: (line,) [Hz].
        by_force: Displacement for loads on the ring's freedoms, its receptance
            (line, k, k) [m/N, rad/N, rad/(N m)].
        by_errors: Displacement for deviations of the raceways as in
            `Deviation.raceway` (line, k, element, 2, 3) [1, rad/m].
        result: `Result` code of the equilibrium of the bearing.
    """

    frequency: Annotated[Float[Array, " line"], unit("Hz")]
    by_force: Annotated[Complex[Array, "line k k"], units("m/N", "rad/N", "rad/(N m)")]
    by_errors: Annotated[Complex[Array, "line k element 2 3"], units("1", "rad/m")]
    result: Int[Array, ""]

    @property
    def accelerance(self) -> Complex[Array, "line k k"]:
        """Acceleration for loads, as in `by_force` [1/kg, rad/(kg m), rad/(kg m²)]."""
        return self._accelerate(self.by_force)

    @property
    def acceleration_by_errors(self) -> Complex[Array, "line k element 2 3"]:
        """Acceleration for deviations, as in `by_errors` [1/s², rad/(m s²)]."""
        return self._accelerate(self.by_errors)

    def _accelerate(self, motion):
        square = -((2.0 * jnp.pi * self.frequency) ** 2)
        return motion * square.reshape(-1, *(1,) * (motion.ndim - 1)).astype(
            motion.dtype
        )


def linear_model(model: NoiseModel) -> LinearModel:
    """Return the linearised equations of motion of a bearing under its load.

    Args:
        model: The bearing; its form errors are ignored.

    Fails: as `solve_load`.
    """
    return _linear_model(model, model.orbits)


@program(quick=True)
def _linear_model(model, orbits) -> LinearModel:
    system = model.still_system()
    start, result = static_start(model, system, orbits)
    zero = jnp.zeros((), start.dtype)
    none = jnp.zeros((system.row.azimuth.shape[0], 2, 3), start.dtype)

    def contact_forces(deviations):
        return system.contact_forces(start, zero, deviations)

    stiffness = contact_stiffness(system, start)
    damping = system.retardation * stiffness
    if (s := system.sensor) is not None:
        damping = damping.at[:3, :3].add(s.damping * s.projector)
        stiffness = stiffness.at[:3, :3].add(s.stiffness * s.projector)
    push = -jax.jacfwd(contact_forces)(none)
    return LinearModel(
        system.masses, stiffness, damping, push, system.retardation, result
    )


def transfer(model: NoiseModel, frequencies: Any) -> Transfer:
    """Return the linear response of the moving ring to loads and deviations.

    Args:
        model: The bearing.
        frequencies: (line,) [Hz]; above zero where a rolling element is unloaded and
            so without stiffness.

    Returns:
        `Transfer`, differentiable with respect to every number of the model.

    Raises:
        TypeError: For another model, or frequencies that are no numbers.
        ValueError: For frequencies that are no list.

    Fails: as `solve_load`; the numbers are then those of no balance.

    Source: (K + S + iω (τ K + C) - ω² M) x = f - (1 + iωτ) G e.
    """
    of_class("transfer", "model", model, NoiseModel, "a NoiseModel")
    real_numbers("transfer", "frequencies", frequencies, "numbers in Hz")
    frequency = as_real(frequencies)
    right = frequency.ndim == 1 and frequency.size > 0
    check("transfer", "frequencies", right, "a list of them", frequencies, "Hz")
    return _transfer(model, frequency, model.orbits)


@program(quick=True)
def _transfer(model, frequency, orbits) -> Transfer:
    linear = _linear_model(model, orbits)
    k, n = len(model.freedoms), linear.mass.shape[0]
    ring = jnp.eye(n, k, dtype=linear.mass.dtype)
    push = linear.push.reshape(n, -1)

    def response_at(frequency):
        omega = 2.0 * jnp.pi * frequency
        real = linear.stiffness - jnp.diag(omega**2 * linear.mass)
        dynamic = lax.complex(real, omega * linear.damping)
        # Symmetric: the ring's rows of the inverse are its columns.
        rows = solve_any(dynamic, ring.astype(dynamic.dtype)).T
        one = jnp.ones_like(omega)
        by_push = rows @ push.astype(rows.dtype)
        return rows[:, :k], by_push * lax.complex(one, omega * linear.retardation)

    by_force, by_errors = lax.map(response_at, frequency)
    by_errors = by_errors.reshape(*by_errors.shape[:2], *linear.push.shape[1:])
    return Transfer(frequency, by_force, by_errors, linear.result)

"""The bearing as a finite element of twelve freedoms."""

import warnings
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from ..contact.line import AbstractLineLaw, Palmgren
from ..design.bearing import AbstractRollerBearing
from ..numerics.minimise import AbstractMinimiser, TrustRegionNewton
from ..numerics.quadrature import AbstractQuadrature, ContactMapped
from ..numerics.result import worst
from ..numerics.types import Ring, RingStiffness, Scalar
from .constants import ContactConstants, contact_constants
from .energy import Derivatives, RollerModel
from .equilibrium import (
    RollerState,
    condensed_energy,
    condensed_force,
    condensed_stiffness,
    solve_roller,
    solved_derivatives,
)
from .frame import (
    from_roller_axes,
    roll_ratio,
    roller_azimuth,
    section_matrix,
    to_roller_axes,
)
from .inertia import Speed, inertia_force
from .kinematics import AbstractKinematics, Linearised, roller_motion


class Row(NamedTuple):
    """All rollers of a bearing at given ring freedoms.

    Attributes:
        model: The roller, common to all.
        inertia: Inertia force in roller axes, or `None`.
        azimuth: (roller,) [rad].
        transform: Ring motions in roller axes from q (roller, 6, 12).
        rings: Ring motions in roller axes (roller, 6).
        state: Solved rollers, leading axis roller.
        solved: Derivatives of their energies there, leading axis roller.
    """

    model: RollerModel
    inertia: Float[Array, "3"] | None
    azimuth: Float[Array, " roller"]
    transform: Float[Array, "roller 6 12"]
    rings: Float[Array, "roller 6"]
    state: RollerState
    solved: Derivatives


class Evaluated(NamedTuple):
    """Energy, force and stiffness of the bearing, and how the rollers fared.

    Attributes:
        energy: V [J].
        force: dV/dq (12,) [N, N m].
        stiffness: d²V/dq² (12, 12).
        result: Worst `Result` code of the rollers.
        steps: Most steps that a roller took.
        residual: Largest relative residual of a roller [1].
        magnitude: Sum of the sizes of what the rollers pass to the rings, in which
            the ring force may cancel [N].
    """

    energy: Scalar
    force: Ring
    stiffness: RingStiffness
    result: Int[Array, ""]
    steps: Int[Array, ""]
    residual: Scalar
    magnitude: Scalar


class BearingElement(eqx.Module):
    """A roller bearing between two ring nodes, with 12 freedoms.

    V(q) = Σ_rollers min_y [U(q, y) - F·y]; `force` is its gradient, `stiffness` its
    Hessian. All three are differentiable, to any order, with respect to q, every real
    number of the design, the line law and the speeds. The ring rotations gz move the
    set of rollers (rolling without slip) but are operating data: force and stiffness
    hold them constant unless `cage_torque` is set.

    A roller that did not converge makes the numbers NaN-free but untrue: `evaluate`
    returns the code; `solve_load` passes it on.

    Attributes:
        bearing: The design.
        line_law: Law of the raceway contacts.
        kinematics: `Linearised()` or `Finite()`.
        quadrature: `ContactMapped(points)` or `Midpoint(points)`.
        equilibrium: Local solver, `TrustRegionNewton()` or `BFGS()`.
        cage_torque: Differentiate through the azimuth of the rollers.

    Traced: all real numbers. Static: the classes, and `cage_torque`.
    """

    bearing: AbstractRollerBearing
    line_law: AbstractLineLaw = eqx.field(default_factory=Palmgren)
    kinematics: AbstractKinematics = eqx.field(default_factory=Linearised)
    quadrature: AbstractQuadrature = eqx.field(default_factory=ContactMapped)
    equilibrium: AbstractMinimiser = eqx.field(default_factory=TrustRegionNewton)
    cage_torque: bool = eqx.field(static=True, default=False)

    def __check_init__(self):
        if not isinstance(self.bearing, AbstractRollerBearing):
            raise TypeError(
                f"BearingElement: `bearing` is a {type(self.bearing).__name__}; it must"
                " be a roller bearing, such as CylindricalRollerBearing."
            )
        if jax.dtypes.canonicalize_dtype(float) != jnp.float64:
            warnings.warn(
                "BearingElement: float64 is off; in float32 forces are good to 1e-5 at"
                ' best. Before all else: jax.config.update("jax_enable_x64", True)',
                stacklevel=4,
            )

    @eqx.filter_jit
    def energy(self, q: Ring, speed: Speed | None = None) -> Scalar:
        """Condensed strain energy V(q) [J].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds; `None`: no inertia, and nothing of it compiled.

        Raises:
            ValueError: If `q` is not of shape (12,).
        """
        return _energy(self.row(q, speed))

    @eqx.filter_jit
    def force(self, q: Ring, speed: Speed | None = None) -> Ring:
        """External load that holds the rings where they are, dV/dq [N, N m].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds or `None`.
        """
        if self.cage_torque:
            return jax.grad(self.energy)(q, speed)
        row = self.row(q, speed)
        return _sum_forces(row, _roller_forces(row))

    @eqx.filter_jit
    def stiffness(self, q: Ring, speed: Speed | None = None) -> RingStiffness:
        """Tangent stiffness d(force)/dq by static condensation [N/m, N, N m].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds or `None`.
        """
        if self.cage_torque:
            return jax.hessian(self.energy)(q, speed)
        return _stiffness(self.row(q, speed))

    @eqx.filter_jit
    def evaluate(self, q: Ring, speed: Speed | None = None) -> Evaluated:
        """Energy, force and stiffness from one solve of the rollers, with its code."""
        return self.evaluate_row(self.row(q, speed), q, speed)

    @eqx.filter_jit
    def evaluate_row(self, row: Row, q: Ring, speed: Speed | None = None) -> Evaluated:
        """`evaluate` for rollers that are already solved at `q`."""
        shares = _roller_forces(row)
        if self.cage_torque:
            force, stiffness = self.force(q, speed), self.stiffness(q, speed)
        else:
            force, stiffness = _sum_forces(row, shares), _stiffness(row)
        return Evaluated(
            energy=_energy(row),
            force=force,
            stiffness=stiffness,
            result=worst(row.state.result),
            steps=jnp.max(row.state.steps),
            residual=jnp.max(row.state.residual),
            magnitude=jnp.sum(jnp.abs(shares[:, :2])),
        )

    def constants(self) -> ContactConstants:
        """Contact constants of one roller."""
        return contact_constants(self.bearing, self.line_law, self.quadrature)

    @eqx.filter_jit
    def row(self, q: Ring, speed: Speed | None = None) -> Row:
        """Solve every roller at given ring freedoms.

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds or `None`.
        """
        q = jnp.asarray(q, dtype=self.bearing.pitch_diameter.dtype)
        if q.shape != (12,):
            raise ValueError(
                f"BearingElement: `q` has shape {q.shape}; it must be (12,): outer"
                " ring (ux uy uz gx gy gz), then inner ring."
            )
        if speed is not None and not isinstance(speed, Speed):
            raise TypeError(
                f"BearingElement: `speed` is a {type(speed).__name__}; it must be a"
                " Speed(inner, outer) in rad/s, or None."
            )
        constants = self.constants()
        model = RollerModel(
            constants,
            self.kinematics.prepare(constants),
            self.kinematics,
            self.quadrature,
        )
        inertia = None if speed is None else inertia_force(constants, speed)
        turned = q if self.cage_torque else lax.stop_gradient(q)
        azimuth = self.azimuth(turned)
        axes = to_roller_axes(constants.axis_angle, constants.pitch_radius)
        transform = jax.vmap(lambda phi: _ring_transform(axes, phi))(azimuth)
        # gz moves the rollers only through the azimuth: its columns are zero.
        rings = transform @ q
        magnitude = jnp.max(jnp.abs(q[jnp.array([0, 1, 2, 6, 7, 8])]))
        tilt = jnp.max(jnp.abs(q[jnp.array([3, 4, 9, 10])]))
        magnitude = magnitude + constants.pitch_radius * tilt
        state = jax.vmap(
            lambda r: solve_roller(model, r, inertia, magnitude, self.equilibrium)
        )(rings)
        solved = jax.vmap(
            lambda r, x: solved_derivatives(model, r, inertia, magnitude, x)
        )(rings, state.x)
        return Row(model, inertia, azimuth, transform, rings, state, solved)

    def azimuth(self, q: Ring) -> Float[Array, " roller"]:
        """Azimuth of every roller for given ring rotations gz [rad]."""
        b = self.bearing
        ratio = roll_ratio(b.roller_diameter, b.pitch_diameter, b.axis_angle)
        return roller_azimuth(b.first_azimuth, b.n_rollers, ratio, q)


def roller_motions(row: Row) -> Float[Array, "roller 3"]:
    """Section motion (u, v, θ) of every roller at the node on the axis [m, rad]."""
    c = row.model.constants
    back = from_roller_axes(c.axis_angle, c.pitch_radius)
    local = jax.vmap(lambda r, x: roller_motion(c, r, x))(row.rings, row.state.x)
    return local @ back.T


def _ring_transform(axes, azimuth):
    section = axes @ section_matrix(azimuth)
    zero = jnp.zeros_like(section)
    return jnp.block([[section, zero], [zero, section]])


def _energy(row: Row) -> Scalar:
    return jnp.sum(
        jax.vmap(lambda r, x, d: condensed_energy(row.model, r, row.inertia, x, d))(
            row.rings, row.state.x, row.solved
        )
    )


def _roller_forces(row: Row) -> Float[Array, "roller 6"]:
    """What each roller passes to the rings, in roller axes [N, N m]."""
    return jax.vmap(lambda d: condensed_force(row.inertia, d))(row.solved)


def _sum_forces(row: Row, shares: Float[Array, "roller 6"]) -> Ring:
    return jnp.einsum("lai,la->i", row.transform, shares)


def _stiffness(row: Row) -> RingStiffness:
    blocks = jax.vmap(condensed_stiffness)(row.solved.hessian)
    half = jnp.einsum("lab,lbj->laj", blocks, row.transform)
    return jnp.einsum("lai,laj->ij", row.transform, half)

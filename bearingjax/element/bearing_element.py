"""The bearing as a finite element of twelve freedoms."""

import functools
import operator
import warnings
from collections.abc import Callable
from typing import Any, Generic, NamedTuple, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from ..contact.line import AbstractLineLaw, Palmgren
from ..contact.point_law import AbstractPointLaw, FreeAngle
from ..design import (
    AbstractBallBearing,
    AbstractRollerBearing,
    Bearing,
    BearingSet,
    SetRow,
    is_ball,
    n_elements,
    rows_of,
)
from ..numerics.minimise import AbstractMinimiser, TrustRegionNewton
from ..numerics.quadrature import AbstractQuadrature, ContactMapped
from ..numerics.result import worst
from ..numerics.types import Ring, RingStiffness, Scalar
from .ball import ball_model
from .ball_speed import AbstractRacewayControl, OuterControl
from .constants import contact_constants
from .equilibrium import (
    LocalState,
    condensed_force,
    condensed_stiffness,
    settle,
    solve_element,
    solved_derivatives,
)
from .frame import placement, roll_ratio, roller_azimuth, section_matrix
from .inertia import Speed, inertia_force
from .kinematics import AbstractKinematics, Linearised
from .model import AbstractModel, Derivatives
from .roller import RollerModel


class Row(eqx.Module):
    """All rolling elements of a row at given ring freedoms.

    Attributes:
        part: The row and its place.
        local: Ring freedoms at the row's origin, mirrored with it (12,) [m, rad].
        model: One element, common to all; of unlike elements, with a leading axis.
        azimuth: (element,) [rad].
        transform: Ring motions in an element's axes from q (element, r, 12).
        rings: Ring motions in an element's axes (element, r).
        state: Solved elements, leading axis element.
        solved: Their energies, forces and derivatives there, likewise.
        unlike: Whether `model` has a leading axis. Static.
    """

    part: SetRow
    local: Ring
    model: AbstractModel
    azimuth: Float[Array, " element"]
    transform: Float[Array, "element r 12"]
    rings: Float[Array, "element r"]
    state: LocalState
    solved: Derivatives
    unlike: bool = eqx.field(static=True)

    def each(self, function: Callable, *arrays) -> Any:
        """Apply function(model, rings, x, *arrays) to every element.

        Args:
            function: Of one element.
            *arrays: More arguments, with leading axis element.
        """
        return each(
            self.model, self.unlike, function, self.rings, self.state.x, *arrays
        )


def each(model: AbstractModel, unlike: bool, function: Callable, *arrays) -> Any:
    """Apply function(model, *arrays) to every element of a row."""
    axes = (0 if unlike else None,) + (0,) * len(arrays)
    return jax.vmap(function, in_axes=axes)(model, *arrays)


class Evaluated(NamedTuple):
    """Energy, force and stiffness of the bearing, and how its elements fared.

    Attributes:
        energy: V [J].
        force: External load that holds the rings (12,) [N, N m].
        stiffness: d(force)/dq (12, 12).
        result: Worst `Result` code of the rolling elements.
        steps: Most steps that one took.
        residual: Largest relative residual of one [1].
        magnitude: Sum of the sizes of what the elements pass to the rings, in which
            the ring force may cancel [N].
    """

    energy: Scalar
    force: Ring
    stiffness: RingStiffness
    result: Int[Array, ""]
    steps: Int[Array, ""]
    residual: Scalar
    magnitude: Scalar


AnyBearing = TypeVar("AnyBearing", bound=Bearing | BearingSet)


class BearingElement(eqx.Module, Generic[AnyBearing]):
    """A rolling bearing, or a set of bearings, between two ring nodes: 12 freedoms.

    V(q) = Σ_elements min_x [U(q, x) - F·y]; `force` is its gradient, `stiffness` its
    Hessian. All three are differentiable, to any order, with respect to q, every real
    number of the design, the contact law and the speeds. The ring rotations gz move
    the set of rolling elements (rolling without slip) but are operating data: force
    and stiffness hold them constant unless `cage_torque` is set.

    Where part of the forces has no potential (`has_potential`), `force` is the
    balance of all forces, `stiffness` its exact Jacobian, slightly unsymmetric, and
    `energy` the strain energy alone.

    An element that did not converge makes the numbers NaN-free but untrue: `evaluate`
    returns the code; `solve_load` passes it on.

    Attributes:
        bearing: The design, or a `BearingSet`.
        line_law: Law of the raceway contacts of rollers; `Palmgren()`.
        kinematics: `Linearised()` or, for rollers, `Finite()`.
        quadrature: Of roller contacts, `ContactMapped(points)` or `Midpoint(points)`.
        equilibrium: Local solver, `TrustRegionNewton()` or `BFGS()`.
        cage_torque: Differentiate through the azimuth of the rolling elements.
        point_law: Constants of ball contacts: `FreeAngle()`, `ZeroAngle()`,
            `OperatingAngle()` or `PointConstant(outer, inner)`.
        raceway_control: Of turning balls: `OuterControl()`, `InnerControl()`,
            `EqualShare()`, `LoadShare()`, `FrictionLimited(friction)`, or
            `CentrifugalOnly()`.

    Traced: all real numbers. Static: the classes, and `cage_torque`.
    """

    bearing: AnyBearing
    line_law: AbstractLineLaw | None
    kinematics: AbstractKinematics
    quadrature: AbstractQuadrature | None
    equilibrium: AbstractMinimiser
    cage_torque: bool = eqx.field(static=True)
    point_law: AbstractPointLaw | None
    raceway_control: AbstractRacewayControl | None

    def __init__(
        self,
        bearing: AnyBearing,
        line_law: AbstractLineLaw | None = None,
        kinematics: AbstractKinematics | None = None,
        quadrature: AbstractQuadrature | None = None,
        equilibrium: AbstractMinimiser | None = None,
        cage_torque: bool = False,
        *,
        point_law: AbstractPointLaw | None = None,
        raceway_control: AbstractRacewayControl | None = None,
    ):
        """Defaults as above; what the rolling elements have no use for is an error.

        Raises:
            TypeError: If `bearing` is no bearing.
            ValueError: For a choice that the rolling elements have no use for.
        """
        if not isinstance(bearing, Bearing | BearingSet):
            raise TypeError(
                f"BearingElement: `bearing` is a {type(bearing).__name__}; it must be"
                " a roller bearing, a ball bearing or a BearingSet."
            )
        balls = is_ball(bearing)
        wrong = {
            "line_law": balls and line_law,
            "quadrature": balls and quadrature,
            "kinematics": balls and not isinstance(kinematics, Linearised | None),
            "point_law": not balls and point_law,
            "raceway_control": not balls and raceway_control,
        }
        for name, given in wrong.items():
            if given:
                raise ValueError(
                    f"BearingElement: `{name}` is for"
                    f" {'rollers' if balls else 'balls'}, but the bearing is a"
                    f" {type(bearing).__name__}."
                )
        self.bearing = bearing
        self.line_law = None if balls else line_law or Palmgren()
        self.kinematics = kinematics or Linearised()
        self.quadrature = None if balls else quadrature or ContactMapped()
        self.equilibrium = equilibrium or TrustRegionNewton()
        self.cage_torque = cage_torque
        self.point_law = (point_law or FreeAngle()) if balls else None
        self.raceway_control = (raceway_control or OuterControl()) if balls else None
        if jax.dtypes.canonicalize_dtype(float) != jnp.float64:
            warnings.warn(
                "BearingElement: float64 is off; in float32 forces are good to 1e-5 at"
                ' best. Before all else: jax.config.update("jax_enable_x64", True)',
                stacklevel=3,
            )

    def has_potential(self, speed: Speed | None = None) -> bool:
        """Whether all forces derive from `energy`, so that `stiffness` is symmetric.

        Args:
            speed: Ring speeds or `None`.
        """
        if self.point_law is None or self.raceway_control is None:
            return True
        gyroscopic = speed is not None and self.raceway_control.has_reaction
        return not (self.point_law.follows_angle or gyroscopic)

    @eqx.filter_jit
    def energy(self, q: Ring, speed: Speed | None = None) -> Scalar:
        """Condensed strain energy V(q) [J].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds; `None`: no inertia, and nothing of it compiled.

        Raises:
            ValueError: If `q` is not of shape (12,).
        """
        return _energy(self.rows(q, speed))

    @eqx.filter_jit
    def force(self, q: Ring, speed: Speed | None = None) -> Ring:
        """External load that holds the rings where they are [N, N m].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds or `None`.
        """
        if self.cage_torque:
            return jax.grad(self.energy)(q, speed)
        return _total(_sum_forces(row, _forces(row)) for row in self.rows(q, speed))

    @eqx.filter_jit
    def stiffness(self, q: Ring, speed: Speed | None = None) -> RingStiffness:
        """Tangent stiffness d(force)/dq by static condensation [N/m, N, N m].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds or `None`.
        """
        if self.cage_torque:
            return jax.hessian(self.energy)(q, speed)
        return _total(_stiffness(row) for row in self.rows(q, speed))

    @eqx.filter_jit
    def evaluate(self, q: Ring, speed: Speed | None = None) -> Evaluated:
        """Energy, force and stiffness from one solve of the elements, with its code."""
        return self.evaluate_rows(self.rows(q, speed), q, speed)

    @eqx.filter_jit
    def evaluate_rows(
        self, rows: tuple[Row, ...], q: Ring, speed: Speed | None = None
    ) -> Evaluated:
        """`evaluate` for rolling elements that are already solved at `q`."""
        shares = [_forces(row) for row in rows]
        if self.cage_torque:
            force, stiffness = self.force(q, speed), self.stiffness(q, speed)
        else:
            pairs = zip(rows, shares, strict=True)
            force = _total(_sum_forces(row, share) for row, share in pairs)
            stiffness = _total(_stiffness(row) for row in rows)
        loads = [jnp.max(row.solved.contact_load) for row in rows]
        largest = jnp.max(jnp.stack(loads))
        states = [settle(row.state, largest) for row in rows]
        return Evaluated(
            energy=_energy(rows),
            force=force,
            stiffness=stiffness,
            result=worst(jnp.concatenate([s.result for s in states])),
            steps=jnp.max(jnp.concatenate([s.steps for s in states])),
            residual=jnp.max(jnp.concatenate([s.residual for s in states])),
            magnitude=_total(jnp.sum(jnp.abs(share[:, :2])) for share in shares),
        )

    def models(self, speed: Speed | None = None) -> tuple[Any, ...]:
        """One rolling element of each row: a `RollerModel` or a `BallModel`.

        A ball is one of the common diameter.

        Args:
            speed: Ring speeds or `None`.
        """
        return tuple(self._model(row.bearing, speed) for row in rows_of(self.bearing))

    def _model(self, bearing: Any, speed, deviation=None) -> AbstractModel:
        if isinstance(bearing, AbstractBallBearing):
            assert self.point_law is not None and self.raceway_control is not None
            law, control = self.point_law, self.raceway_control
            return ball_model(bearing, law, speed, control, deviation)
        assert self.line_law is not None and self.quadrature is not None
        constants = contact_constants(bearing, self.line_law, self.quadrature)
        body_force = None if speed is None else inertia_force(constants, speed)
        return RollerModel(
            constants,
            self.kinematics.prepare(constants),
            self.kinematics,
            self.quadrature,
            body_force,
        )

    @eqx.filter_jit
    def rows(self, q: Ring, speed: Speed | None = None) -> tuple[Row, ...]:
        """Solve every rolling element at given ring freedoms.

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds or `None`.

        Raises:
            ValueError: If `q` is not of shape (12,).
            TypeError: If `speed` is not a `Speed`.
        """
        parts = rows_of(self.bearing)
        q = jnp.asarray(q, dtype=parts[0].bearing.pitch_diameter.dtype)
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
        if not isinstance(self.bearing, BearingSet):
            return (self._row(parts[0], q, None, speed),)
        rows = []
        for part in parts:
            place = placement(part.position, part.mirrored)
            zero = jnp.zeros_like(place)
            both = jnp.block([[place, zero], [zero, place]])
            rows.append(self._row(part, q, both, speed))
        return tuple(rows)

    def _row(self, part: SetRow, q, place, speed) -> Row:
        bearing = part.bearing
        deviation = getattr(bearing, "ball_deviation", None)
        unlike = deviation is not None
        if unlike:
            model = jax.vmap(lambda d: self._model(bearing, speed, d))(deviation)
        else:
            model = self._model(bearing, speed)
        turned = q if self.cage_torque else lax.stop_gradient(q)
        azimuth = azimuths(bearing, turned)
        transform = each(model, unlike, lambda m, phi: m.transform(phi), azimuth)
        local = q
        if place is not None:
            offset = -part.inner_offset if part.mirrored else part.inner_offset
            local = (place @ q).at[8].add(offset)
        # gz moves the elements only through the azimuth: its columns are zero.
        rings = transform @ local
        if place is not None:
            transform = transform @ place
        magnitude = jnp.max(jnp.abs(local[jnp.array([0, 1, 2, 6, 7, 8])]))
        tilt = jnp.max(jnp.abs(local[jnp.array([3, 4, 9, 10])]))
        magnitude = magnitude + 0.5 * bearing.pitch_diameter * tilt
        state = each(
            model,
            unlike,
            lambda m, r: solve_element(m, r, magnitude, self.equilibrium),
            rings,
        )
        solved = each(
            model,
            unlike,
            lambda m, r, x: solved_derivatives(m, r, magnitude, x),
            rings,
            state.x,
        )
        return Row(part, local, model, azimuth, transform, rings, state, solved, unlike)


def azimuths(bearing: Bearing, q: Ring) -> Float[Array, " element"]:
    """Azimuth of every rolling element for given ring rotations gz [rad].

    Args:
        bearing: A single row.
        q: Ring freedoms [m, rad]; only both gz count.
    """
    if isinstance(bearing, AbstractRollerBearing):
        diameter, cosine = bearing.roller_diameter, jnp.cos(bearing.axis_angle)
    else:
        diameter, cosine = bearing.ball_diameter, bearing.free_cosine
    ratio = roll_ratio(diameter, bearing.pitch_diameter, cosine)
    return roller_azimuth(bearing.first_azimuth, n_elements(bearing), ratio, q)


def motions(row: Row) -> Float[Array, "element 3"]:
    """Section motion (u, v, θ) of every element at the node on the axis [m, rad]."""

    def one(model, rings, x, azimuth):
        outer = section_matrix(azimuth) @ row.local[:6]
        u, v, theta = model.motion(rings, x, outer)
        if row.part.mirrored:
            u, theta = -u, -theta
        return jnp.stack([u, v - row.part.position * theta, theta])

    return row.each(one, row.azimuth)


def inertia_load(rows: tuple[Row, ...]) -> Float[Array, "6"]:
    """What inertia does to all rolling elements, at the node [N, N m].

    The forces that hold both rings add up to minus this.

    Args:
        rows: Solved rows.
    """
    total = jnp.zeros((6,), rows[0].local.dtype)
    for row in rows:
        parts = row.each(lambda m, r, x: m.inertia(r, x))
        if parts is not None:
            section = jax.vmap(section_matrix)(row.azimuth)
            place = placement(row.part.position, row.part.mirrored)
            total = total + jnp.einsum("lai,la->i", section, parts) @ place
    return total


def _total(parts) -> Any:
    return functools.reduce(operator.add, parts)


def _energy(rows) -> Scalar:
    return _total(jnp.sum(row.solved.energy) for row in rows)


def _forces(row: Row) -> Float[Array, "element r"]:
    """What each element passes to the rings, in its axes [N, N m]."""
    return jax.vmap(lambda d: condensed_force(row.model, d))(row.solved)


def _sum_forces(row: Row, shares: Float[Array, "element r"]) -> Ring:
    return jnp.einsum("lai,la->i", row.transform, shares)


def _stiffness(row: Row) -> RingStiffness:
    blocks = jax.vmap(lambda h: condensed_stiffness(row.model, h))(row.solved.hessian)
    half = jnp.einsum("lab,lbj->laj", blocks, row.transform)
    return jnp.einsum("lai,laj->ij", row.transform, half)

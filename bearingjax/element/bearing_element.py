"""The bearing as a finite element of twelve freedoms."""

import warnings
from typing import Any, Generic, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp

from ..contact.coupled import CoupledSlices
from ..contact.line import AbstractLineLaw, Palmgren
from ..contact.point_law import AbstractPointLaw, FreeAngle
from ..design import (
    AbstractBallBearing,
    Bearing,
    BearingSet,
    SetRow,
    has_sphere,
    is_ball,
    rows_of,
)
from ..design.checks import is_traced
from ..numerics.minimise import AbstractMinimiser, TrustRegionNewton
from ..numerics.quadrature import AbstractQuadrature, ContactMapped
from ..numerics.types import Ring, RingStiffness, Scalar
from .ball_model import ball_model
from .ball_speed import AbstractRacewayControl, OuterControl
from .bearing_model import BearingModel, Evaluated
from .choices import check_kinds, in_one_dtype
from .constants import contact_constants
from .function import FunctionParameters, RingFunction, as_function
from .inertia import Speed, inertia_force
from .kinematics import AbstractKinematics, ConstantAngle, Finite, Linearised
from .model import AbstractModel
from .roller import RollerModel
from .row import Row, RowModel


def check_element(owner: str, element: object) -> None:
    """Raise unless it is a BearingElement.

    Args:
        owner: Function that was called.
        element: What it was given.

    Raises:
        TypeError: For anything else, such as a bearing without its contact laws.
    """
    if isinstance(element, BearingElement):
        return
    cure = "a BearingElement"
    if isinstance(element, Bearing | BearingSet):
        cure = "BearingElement(bearing), which holds the contact laws"
    elif isinstance(getattr(element, "element", None), BearingElement):
        cure = "its `element`"
    raise TypeError(
        f"{owner}: `element` is a {type(element).__name__}; it must be {cure}."
    )


AnyBearing = TypeVar("AnyBearing", bound=Bearing | BearingSet, covariant=True)


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
        line_law: Law of the raceway contacts of rollers; `Palmgren()`. With
            `CoupledSlices()` slices press on each other; it takes no `quadrature`.
        kinematics: Small ring rotations, `Linearised()`; `ConstantAngle()`: likewise,
            the contact angles of balls held; or `Finite()`: rings of ball bearings
            turn by any angle, of rollers the paper's formula. Self-aligning bearings:
            `Finite()`.
        quadrature: Of roller contacts, `ContactMapped(points)` or `Midpoint(points)`;
            `None` with balls and `CoupledSlices()`.
        equilibrium: Local solver, `TrustRegionNewton()` or `BFGS()`.
        cage_torque: Whether gz feels that it moves the rolling elements: `force` then
            has moments about z, the virtual work of the contact forces, `stiffness`
            their derivatives.
        point_law: Constants of ball contacts: `FreeAngle()`, `ZeroAngle()`,
            `OperatingAngle()` or `PointConstant(outer, inner)`.
        raceway_control: Of turning balls: `OuterControl()`, `InnerControl()`,
            `EqualShare()`, `LoadShare()`, `FrictionLimited(friction)`,
            `OperatingCentrifugal()` or `CentrifugalOnly()`.

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
            TypeError: If `bearing` is no bearing, or a choice is of another kind, such
                as a text or the class itself.
            ValueError: For a choice that the rolling elements have no use for.
        """
        if not isinstance(bearing, Bearing | BearingSet):
            raise TypeError(
                f"BearingElement: `bearing` is a {type(bearing).__name__}; it must be"
                " a roller bearing, a ball bearing or a BearingSet."
            )
        check_kinds(
            {
                "line_law": line_law,
                "kinematics": kinematics,
                "quadrature": quadrature,
                "equilibrium": equilibrium,
                "point_law": point_law,
                "raceway_control": raceway_control,
            }
        )
        if not isinstance(cage_torque, bool):
            raise TypeError(
                f"BearingElement: `cage_torque` is {cage_torque!r}; it must be True or"
                " False."
            )
        balls = is_ball(bearing)
        wrong = {
            "line_law": balls and line_law,
            "quadrature": balls and quadrature,
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
        coupled = isinstance(line_law, CoupledSlices)
        if quadrature and coupled:
            raise ValueError(
                "BearingElement: `quadrature` is for independent slices, but `line_law`"
                " is CoupledSlices(), which has slices of its own."
            )
        # A jnp.float32 among float64 would stop the solvers, which keep one dtype.
        bearing, line_law, point_law, raceway_control = in_one_dtype(
            (bearing, line_law, point_law, raceway_control)
        )
        self.bearing = bearing
        self.line_law = None if balls else line_law or Palmgren()
        aligning = has_sphere(bearing)
        if aligning and isinstance(kinematics, Linearised):
            raise ValueError(
                "BearingElement: `kinematics` is Linearised(), with which a"
                " self-aligning bearing would resist its tilt; use Finite()."
            )
        constant = isinstance(kinematics, ConstantAngle)
        two_sided = any(
            isinstance(row.bearing, AbstractBallBearing)
            and not row.bearing.is_one_sided
            for row in rows_of(bearing)
        )
        if constant and two_sided:
            raise ValueError(
                "BearingElement: `kinematics` is ConstantAngle(), which is for balls of"
                " one contact angle: of angular contact and thrust bearings."
            )
        sprung = any(row.spring is not None for row in rows_of(bearing))
        if balls and sprung and (aligning or isinstance(kinematics, Finite)):
            raise ValueError(
                "BearingElement: a row has a spring, whose ring would slide along a"
                " tilted seat; with Finite() kinematics that is not modelled."
            )
        self.kinematics = kinematics or (Finite() if aligning else Linearised())
        # What has no use for it keeps none: an element can be made from its fields.
        independent = not balls and not coupled
        self.quadrature = (quadrature or ContactMapped()) if independent else None
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

    def model(self, speed: Speed | None = None) -> BearingModel:
        """The bearing with all its contact constants worked out.

        To evaluate one design many times: `element.model(speed).evaluate(q)`. If no
        number of the design is traced, the constants are known numbers even within
        `jit`, which then need not be computed in every call.

        Args:
            speed: Ring speeds; `None`: no inertia, and nothing of it compiled.

        Raises:
            TypeError: If `speed` is not a `Speed`.
            ValueError: If `speed` is given to balls of constant contact angle, or it
                holds many designs (`stack_designs`).
        """
        if speed is not None and not isinstance(speed, Speed):
            raise TypeError(
                f"BearingElement: `speed` is a {type(speed).__name__}; it must be a"
                " Speed(inner, outer) in rad/s, or None."
            )
        constant = isinstance(self.kinematics, ConstantAngle)
        if speed is not None and constant and is_ball(self.bearing):
            raise ValueError(
                "BearingElement: `kinematics` is ConstantAngle(), with which nothing"
                " holds a turning ball along its raceways; leave out `speed`, or use"
                " Linearised()."
            )
        designs = jnp.shape(rows_of(self.bearing)[0].bearing.pitch_diameter)
        if designs:
            raise ValueError(
                f"BearingElement: it holds designs, {designs[0]} of them, and is asked"
                " as one bearing; take `sweep`, or map over it with `jax.vmap`."
            )
        if any(is_traced(leaf) for leaf in jax.tree.leaves((self, speed))):
            return self._model(speed)
        with jax.ensure_compile_time_eval():
            return self._model(speed)

    @eqx.filter_jit
    def _model(self, speed) -> BearingModel:
        alone = not isinstance(self.bearing, BearingSet)
        rows = tuple(self._row(part, speed, alone) for part in rows_of(self.bearing))
        return BearingModel(rows, self.equilibrium, self.cage_torque)

    def has_potential(self, speed: Speed | None = None) -> bool:
        """Whether all forces derive from `energy`, so that `stiffness` is symmetric.

        Args:
            speed: Ring speeds or `None`.
        """
        return eqx.filter_eval_shape(self.model, speed).has_potential

    def energy(self, q: Ring, speed: Speed | None = None) -> Scalar:
        """Condensed strain energy V(q) [J].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds; `None`: no inertia, and nothing of it compiled.

        Raises:
            ValueError: If `q` is not of shape (12,).
            TypeError: If `speed` is not a `Speed`.
        """
        return self._at("energy", q, speed)

    def force(self, q: Ring, speed: Speed | None = None) -> Ring:
        """External load that holds the rings where they are [N, N m].

        Args, raises: as `energy`.
        """
        return self._at("force", q, speed)

    def stiffness(self, q: Ring, speed: Speed | None = None) -> RingStiffness:
        """Tangent stiffness d(force)/dq by static condensation [N/m, N, N m].

        Args, raises: as `energy`.
        """
        return self._at("stiffness", q, speed)

    def evaluate(self, q: Ring, speed: Speed | None = None) -> Evaluated:
        """Energy, force and stiffness from one solve of the elements, with its code.

        Args, raises: as `energy`.
        """
        return self._at("evaluate", q, speed)

    def rows(self, q: Ring, speed: Speed | None = None) -> tuple[Row, ...]:
        """The rolling elements of every row, solved at given ring freedoms.

        Args, raises: as `energy`.
        """
        return self._at("solve", q, speed)

    def as_function(
        self,
        speed: Speed | None = None,
        damping: Any = None,
        *,
        orbit: bool = True,
    ) -> tuple[RingFunction, FunctionParameters]:
        """The bearing as a pure function of motion, velocity, time and parameters.

        function(motion, velocity, time, parameters) is the force (12,) that holds the
        rings, of the sign of `force`: in the equations of motion of the two rings
        M a = F - f, with F what else acts on them. It is differentiable with respect
        to all four; under `jit` a plain static function, the same for all bearings.

        The rolling elements orbit, rolling without slip: at time t the rings have
        turned by t times their speeds, and the element by what `force` makes of such
        gz. So the stiffness varies with the pass of the elements (variable
        compliance), at n/2 [(1 - G) Ω_i + (1 + G) Ω_o] [rad/s] for n elements with
        G = D cos α/d_m, that of the free contact angle. A gz in `motion` turns them
        on top of that: it is for what differs from the steady turn. Who integrates
        the whole rotation (a run-up) sets `orbit=False`, else it counts twice.

        The inertia of the elements is that of their steady orbit at `speed`; they
        follow the rings without delay. Nothing damps unless `damping` says so.

        Args:
            speed: Ring speeds; `None`: rings at rest, no inertia.
            damping: Linear and viscous: a number c [N s/m], dashpots between the
                origins of the rings in x, y and z; or a matrix C (12, 12) with
                f = … + C velocity [N s/m, N s, N m s], as of a damping in proportion
                to a stiffness, β `linearise(…).stiffness`. None: no damping.
            orbit: Whether the rolling elements orbit with time, or only with the gz
                of `motion`.

        Returns:
            function, parameters. Pass the parameters on as arguments (`args` of
            Diffrax), to differentiate or to change them: `parameters.element` is this
            element, `parameters.speed` and `parameters.damping` what was given.
            Where a rolling element does not converge the force is NaN.

        Raises:
            TypeError: If `speed` is not a `Speed`, or `damping` no number.
            ValueError: If `damping` is of another shape, not finite, or negative on
                its diagonal; by the function, if `motion` or `velocity` is not of
                shape (12,).

        Source: variable compliance, Sunnersjö, J. Sound Vib. 58 (1978).
        """
        return as_function(self, speed, damping, orbit)

    def _at(self, name: str, q, speed):
        """A function of the model, of all in one program if nothing is traced yet."""
        if is_traced(q):
            return getattr(self.model(speed), name)(q)
        return self._jitted(name, q, speed)

    @eqx.filter_jit
    def _jitted(self, name, q, speed):
        return getattr(self.model(speed), name)(q)

    def _row(self, part: SetRow, speed, alone) -> RowModel:
        deviation = getattr(part.bearing, "ball_deviation", None)
        if deviation is None:
            return RowModel(part, self._one(part, speed), False, alone)
        every = jax.vmap(lambda d: self._one(part, speed, d))(deviation)
        return RowModel(part, every, True, alone)

    def _one(self, part: SetRow, speed, deviation=None) -> AbstractModel:
        bearing: Any = part.bearing
        if isinstance(bearing, AbstractBallBearing):
            assert self.point_law is not None and self.raceway_control is not None
            law, control = self.point_law, self.raceway_control
            return ball_model(part, law, self.kinematics, speed, control, deviation)
        assert self.line_law is not None
        # Coupled slices ask for a rule as all laws do, and do without.
        quadrature = self.quadrature or ContactMapped()
        constants = contact_constants(bearing, self.line_law, quadrature)
        body_force = None if speed is None else inertia_force(constants, speed)
        return RollerModel(
            constants,
            self.kinematics.prepare(constants),
            self.kinematics,
            quadrature,
            body_force,
        )

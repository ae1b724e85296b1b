"""The bearing as a finite element of twelve freedoms."""

import warnings
from typing import Any, Generic, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp

from ..contact import AbstractLineLaw, AbstractPointLaw
from ..design import AbstractBearing, BearingSet, SetRow, rows_of
from ..design.ball_types import DoubleRowBallRow
from ..design.bearing_set import bearings_of
from ..design.checks import flag, is_traced, of_class
from ..design.deviation import deviation_of
from ..numerics import AbstractMinimiser, AbstractQuadrature, TrustRegionNewton, Warning
from ..numerics.shown import Printable
from ..numerics.types import Ring, Scalar
from .azimuth import azimuths, orbit_ratio
from .balls.ball_speed import AbstractRacewayControl
from .bearing_model import BearingModel, BearingResponse, RowGroup
from .choices import AbstractChoices, check_kinds, choices_for, in_one_dtype
from .equilibrium import ElementStart
from .function import FunctionParameters, RingFunction, as_function
from .inertia import Speed
from .kinematics import AbstractKinematics
from .row import Row, RowPlacement
from .solved_row import RowResults

State = tuple[ElementStart, ...]
"""Rolling elements solved at ring freedoms near by."""


def check_element(owner: str, element: object) -> None:
    """Raise unless it is a BearingElement.

    Raises:
        TypeError: For anything else, such as a bearing without its contact laws.
    """
    if isinstance(element, BearingElement):
        return
    cure = "a BearingElement"
    if isinstance(element, AbstractBearing | BearingSet):
        cure = "BearingElement(bearing), which holds the contact laws"
    elif isinstance(getattr(element, "element", None), BearingElement):
        cure = "its `element`"
    raise TypeError(
        f"{owner}: `element` is a {type(element).__name__}; it must be {cure}."
    )


AnyBearing = TypeVar("AnyBearing", bound=AbstractBearing | BearingSet, covariant=True)


class BearingElement(Printable, Generic[AnyBearing]):
    """A rolling bearing, or a set of bearings, between two ring nodes: 12 freedoms.

    V(q) = Σ_elements min_x [U(q, x) - F·y]; `force` is its gradient, `stiffness` its
    Hessian. All three are differentiable, to any order, with respect to q, every real
    number of the design, the contact law and the speeds. The ring rotations gz move
    the set of rolling elements (rolling without slip) but are operating data: force
    and stiffness hold them constant unless `cage_torque` is set.

    Where part of the forces has no potential (`has_potential`), `force` is the
    balance of all forces, `stiffness` its exact Jacobian, slightly unsymmetric, and
    `energy` the strain energy alone.

    `jax.jit(element.force)` holds the design, `equinox.filter_jit(element.force)` has
    it as an argument and compiles once for all designs of one structure.

    An element that did not converge makes the numbers NaN-free but untrue: `evaluate`
    returns the code; `solve_load` passes it on.

    Attributes:
        bearing: The design, or a `BearingSet`.
        line_law: Law of the raceway contacts of rollers; `Palmgren()`. With
            `CoupledSlices()` slices press on each other; it takes no `quadrature`.
        kinematics: Small ring rotations, `Linearised()`; `ConstantAngle()`: the same,
            the contact angles of balls held; or `Finite()`: rings of ball bearings
            turn by any angle, of rollers the paper's formula. Self-aligning ball
            bearings and barrel rollers: `Finite()`.
        quadrature: Rule for roller contacts, `ContactMapped(points)` or
            `Midpoint(points)`; `None` with balls and `CoupledSlices()`.
        equilibrium: Local solver, `TrustRegionNewton()` or `BFGS()`.
        cage_torque: Whether gz feels that it moves the rolling elements: `force` then
            has moments about z, the virtual work of the contact forces, `stiffness`
            their derivatives.
        point_law: Constants of ball contacts: `FreeAngle()`, `ZeroAngle()`,
            `OperatingAngle()` or `PointConstant(outer, inner)`.
        raceway_control: For turning balls: `OuterControl()`, `InnerControl()`,
            `EqualShare()`, `LoadShare()`, `FrictionLimited(friction)`,
            `OperatingCentrifugal()` or `CentrifugalOnly()`.
        choices: Laws and kinematics together, for those of the above that are not
            given.

    Traced: all real numbers. Static: the classes, and `cage_torque`.
    """

    bearing: AnyBearing
    choices: AbstractChoices
    equilibrium: AbstractMinimiser
    cage_torque: bool = eqx.field(static=True)

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
        choices: AbstractChoices | None = None,
    ):
        """Defaults as above; a choice that does not apply to the elements is an error.

        Raises:
            TypeError: If `bearing` is no bearing, or a choice is of another kind, such
                as a text or the class itself.
            ValueError: For a choice that the rolling elements have no use for.
        """
        kinds, allowed = AbstractBearing | BearingSet, "a bearing or a BearingSet"
        of_class(self, "bearing", bearing, kinds, allowed)
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
        flag("BearingElement", "cage_torque", cage_torque)
        given = {
            "line_law": line_law,
            "kinematics": kinematics,
            "quadrature": quadrature,
            "point_law": point_law,
            "raceway_control": raceway_control,
        }
        rows = rows_of(bearing)
        kind = choices_for(rows[0].bearing)
        for name, value in given.items():
            if value is not None and name not in kind.names:
                others = "rollers" if kind.elements == "balls" else "balls"
                raise ValueError(
                    f"BearingElement: `{name}` is for {others}, but the bearing is a"
                    f" {type(bearing).__name__}."
                )
        for name in kind.names:
            if given.get(name) is None:
                given[name] = getattr(choices, name, None)
        choices = kind.from_rows(rows, **{name: given[name] for name in kind.names})
        # A jnp.float32 among float64 would stop the solvers, which keep one dtype.
        self.bearing, self.choices = in_one_dtype((bearing, choices))
        self.equilibrium = equilibrium or TrustRegionNewton()
        self.cage_torque = cage_torque
        self._check(None)
        if jax.dtypes.canonicalize_dtype(float) != jnp.float64:
            # Of how Python is set up, not of a bearing: whoever forgot it must see it.
            warnings.warn(
                "BearingElement: float64 is off; in float32 forces are good to 1e-5 at"
                ' best. Before all else: jax.config.update("jax_enable_x64", True)',
                stacklevel=3,
            )

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about the design of the bearing."""
        return self.bearing.warnings

    def __hash__(self) -> int:
        """Hash of the structure and shapes, which `jax.jit` of a method needs.

        Raises:
            TypeError: If a number is traced, which cannot be compared.
        """
        leaves, structure = jax.tree.flatten(self)
        if any(is_traced(leaf) for leaf in leaves):
            raise TypeError(
                "BearingElement: a design that is traced cannot be hashed; for"
                " `jax.jit(element.force)` take `jax.jit(lambda q: element.force(q))`."
            )
        return hash((structure, *(jnp.shape(leaf) for leaf in leaves)))

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
        allowed = "a Speed(inner, outer) in rad/s, or None"
        of_class(self, "speed", speed, Speed | None, allowed)
        self._check(speed)
        designs = jnp.shape(bearings_of(self.bearing)[0].pitch_diameter)
        if designs:
            raise ValueError(
                f"BearingElement: it holds designs, {designs[0]} of them, and is asked"
                " as one bearing; take `sweep`, or map over it with `jax.vmap`."
            )
        if any(is_traced(leaf) for leaf in jax.tree.leaves((self, speed))):
            return self._model(speed)
        with jax.ensure_compile_time_eval():
            return self._model(speed)

    def _check(self, speed):
        for part in rows_of(self.bearing):
            self.choices.check(part, speed)

    @eqx.filter_jit
    def _model(self, speed) -> BearingModel:
        alone = not isinstance(self.bearing, BearingSet)
        rows = tuple(self._row(part, speed, alone) for part in rows_of(self.bearing))
        return BearingModel(RowGroup.group(rows), self.equilibrium, self.cage_torque)

    @property
    def line_law(self) -> AbstractLineLaw | None:
        """Law of the raceway contacts of rollers; `None` with balls."""
        return getattr(self.choices, "line_law", None)

    @property
    def kinematics(self) -> AbstractKinematics:
        """Kinematics: map from rigid motions to coordinates of the contacts."""
        return self.choices.kinematics

    @property
    def quadrature(self) -> AbstractQuadrature | None:
        """Quadrature of roller contacts; `None` with balls and `CoupledSlices()`."""
        return getattr(self.choices, "quadrature", None)

    @property
    def point_law(self) -> AbstractPointLaw | None:
        """Constants of ball contacts; `None` with rollers."""
        return getattr(self.choices, "point_law", None)

    @property
    def raceway_control(self) -> AbstractRacewayControl | None:
        """Raceway control of turning balls; `None` with rollers."""
        return getattr(self.choices, "raceway_control", None)

    def has_potential(self, speed: Speed | None = None) -> bool:
        """Whether all forces derive from `energy`, so that `stiffness` is symmetric.

        Args:
            speed: Ring speeds or `None`.
        """
        return eqx.filter_eval_shape(self.model, speed).has_potential

    def energy(
        self, q: Ring, speed: Speed | None = None, *, near: State | None = None
    ) -> Scalar:
        """Condensed strain energy V(q) [J].

        Args:
            q: Ring freedoms, outer then inner [m, rad].
            speed: Ring speeds; `None`: no inertia, and nothing of it compiled.
            near: The rolling elements at ring freedoms near by, `evaluate(...).near`
                or from `force`: they are then solved from there, in fewer steps.

        Raises:
            ValueError: If `q` is not of shape (12,), or `near` of another structure or
                found with `speed` where there is none now, or the other way.
            TypeError: If `speed` is not a `Speed`.
        """
        return self._call_model("energy", q, speed, near)

    def force(
        self,
        q: Ring,
        speed: Speed | None = None,
        *,
        near: State | None = None,
        with_near: bool = False,
    ) -> Any:
        """External load that holds the rings where they are [N, N m].

        Args:
            q, speed, near: As in `energy`.
            with_near: Return (force, near) for the next call. Static.

        Raises: as `energy`.
        """
        return self._call_model("force", q, speed, near, with_near)

    def stiffness(
        self,
        q: Ring,
        speed: Speed | None = None,
        *,
        near: State | None = None,
        with_near: bool = False,
    ) -> Any:
        """Tangent stiffness d(force)/dq by static condensation [N/m, N, N m].

        Args, raises: as `force`.
        """
        return self._call_model("stiffness", q, speed, near, with_near)

    def evaluate(
        self, q: Ring, speed: Speed | None = None, *, near: State | None = None
    ) -> BearingResponse:
        """Energy, force and stiffness from one solve of the elements, with its code.

        Args, raises: as `energy`.
        """
        return self._call_model("evaluate", q, speed, near)

    def rows(
        self, q: Ring, speed: Speed | None = None, *, near: State | None = None
    ) -> tuple[RowResults, ...]:
        """The rolling elements of every row, solved at given ring freedoms.

        Args, raises: as `energy`.
        """
        return self._call_model("results", q, speed, near)

    def nothing_near(self, speed: Speed | None = None) -> State:
        """Return the initial `near`, before the first call: no element is solved yet.

        Args:
            speed: Ring speeds or `None`, as in the calls.
        """
        model = self.model(speed)
        return model.starts(model.unsolved_state())

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
        M a = F - f, with F all other forces on them. It is differentiable with respect
        to all four; under `jit` a plain static function, the same for all bearings.

        The rolling elements orbit, rolling without slip: at time t the rings have
        turned by t times their speeds, and the elements as in `force` for such gz. So
        the stiffness varies with the pass of the elements (variable
        compliance), at n/2 [(1 - G) Ω_i + (1 + G) Ω_o] [rad/s] for n elements with
        G = D cos α/d_m, that of the free contact angle. A gz in `motion` turns them
        in addition: it is for deviations from the steady rotation. If the whole
        rotation is integrated (a run-up), set `orbit=False`, else it counts twice.

        The inertia of the elements is that of their steady orbit at `speed`; they
        follow the rings without delay. There is no damping unless `damping` is given.

        Args:
            speed: Ring speeds; `None`: rings at rest, no inertia.
            damping: Linear and viscous: a number c [N s/m], dashpots between the
                origins of the rings in x, y and z; or a matrix C (12, 12) with
                f = … + C velocity [N s/m, N s, N m s], as for a damping in proportion
                to a stiffness, β `linearise(…).stiffness`. None: no damping.
            orbit: Whether the rolling elements orbit with time, or only with the gz
                of `motion`.

        Returns:
            function, parameters. Pass the parameters on as arguments (`args` of
            Diffrax), to differentiate or to change them: `parameters.element` is this
            element, `parameters.speed` and `parameters.damping` what was given.
            Where a rolling element does not converge the force is NaN.

            With a fifth argument, `near`, the function returns (force, near): the
            solve of the rolling elements starts from their last state, and their new
            state goes into the next call. The first is `nothing_near(speed)`. An
            integrator that keeps it in its state never starts without one.

        Raises:
            TypeError: If `speed` is not a `Speed`, or `damping` no number.
            ValueError: If `damping` is of another shape, not finite, or negative on
                its diagonal; by the function, if `motion` or `velocity` is not of
                shape (12,).

        Source: variable compliance, Sunnersjö, J. Sound Vib. 58 (1978).
        """
        return as_function(self, speed, damping, orbit)

    def _call_model(self, name: str, q, speed, near, with_near=False) -> Any:
        """Call a function of the model, as one program if nothing is traced yet."""
        if is_traced(q):
            return self._call_traced(name, q, speed, near, with_near)
        return self._call_jitted(name, q, speed, near, with_near)

    @eqx.filter_jit
    def _call_jitted(self, *given):
        return self._call_traced(*given)

    def _call_traced(self, name, q, speed, near, with_near):
        model = self.model(speed)
        model.check_near(near)
        solved = model.solve(q, near)
        value = getattr(model, name)(q, solved)
        return (value, model.starts(solved)) if with_near else value

    def _row(self, part: SetRow, speed, alone) -> Row:
        bearing, deviation = part.bearing, deviation_of(part.bearing)

        def build(deviation):
            found = self.choices.rolling_element(part, speed, deviation.diameter)
            raceway = deviation.raceway
            return found if raceway is None else found.with_heights(raceway[:, 2])

        per_element = deviation.makes_unlike
        element = jax.vmap(build)(deviation) if per_element else build(deviation)
        raceway = deviation.raceway
        shift = None if raceway is None else raceway[:, :, :2]
        place = None
        if not alone or bearing.is_paired:
            none = jnp.zeros_like(part.position)
            sign = none + (-1.0 if part.mirrored else 1.0)
            itself = element.places_itself
            position, offset = part.position, sign * part.inner_offset
            if isinstance(bearing, DoubleRowBallRow):
                position = position + sign * bearing.axial_place
            place = RowPlacement(
                *((none, sign, none) if itself else (position, sign, offset))
            )
        return Row(
            element=element,
            azimuth=azimuths(bearing),
            shift=shift,
            ratio=orbit_ratio(bearing),
            pitch_radius=0.5 * bearing.pitch_diameter,
            place=place,
            spring=part.spring,
            absent=bearing.empty_places,
            per_element=per_element,
        )

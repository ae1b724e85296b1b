"""Bearing on a noise rig: one ring turns, the other one may move."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBallBearing, rows_of
from ..design.bearing_set import is_self_aligning
from ..design.checks import (
    check,
    finite,
    floats,
    instance,
    is_real,
    is_traced,
    non_negative,
    of_shape,
    one_of,
    positive,
)
from ..design.form_error import FormErrors, Surfaces
from ..element import FREEDOMS, RINGS, BearingElement, Speed
from ..numerics.compiled.programs import program
from ..numerics.types import (
    Real,
    RealOrNone,
    Scalar,
    array_namespace,
    as_real,
    in_numpy,
)
from ..numerics.units import real, unit
from ..statics import Solution, SolveOptions, Support
from ..statics.load import solve
from .dynamics.cage import GuidedCage
from .dynamics.dynamic_row import DynamicRow, of_small_motions
from .dynamics.system import NoiseSystem
from .sensor import Sensor


class NoiseModel(eqx.Module):
    """A bearing on its rig, for vibration from form errors.

    Attributes:
        element: The bearing or set, with linearised kinematics; a self-aligning one
            with `Finite()`. Whatever its raceway control, balls are carried as with
            `CentrifugalOnly()`: they orbit at the free contact angle, and have no
            gyroscopic moment; `record_warnings` warns where that moment matters.
        mass: Mass of the moving ring, and of what moves with it [kg].
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring (6,) [N, N m]; moments only
            if it tilts.
        speed: Speed of the rings.
        errors: Form errors; of a set those of each row, in that row's own axes, or one
            that all rows have.
        tilting_inertia: Moment of inertia about a diameter of the moving ring and of
            what moves with it [kg m²]; `None`: `ring_inertia`, as if `mass` were that
            of a ring alone.
        sensor: Sensor spring on the moving ring; `None`: none.
        retardation: τ of the contacts' damping [s]. Damping ratio of a mode of ω that
            is held by contacts alone: ω τ/2.
        moving_ring: "outer" or "inner". Static.
        tilts: Whether the moving ring tilts, as one on a rig does; a shaft in further
            bearings may not. That of a self-aligning bearing never does. Levels may
            depend on it by tens of dB. Static.
        cage: Cage of a single row of balls; `None`: the rolling elements go round
            evenly, each in its place.
        half_width: Half width of the contacts of each row along the rolling direction,
            over which waves are averaged (row,) [m], from `with_bridged_waves`; `None`:
            waves are met as they are, however short.

    Traced: all numbers.
    """

    element: BearingElement
    mass: Real = eqx.field(**real("kg", "mass of the moving ring"))
    load: Float[Array, "6"] = eqx.field(
        converter=as_real, metadata=unit(("N", "N", "N", "N m", "N m", "N m"))
    )
    speed: Speed
    errors: FormErrors | tuple[FormErrors, ...] = eqx.field(default_factory=FormErrors)
    tilting_inertia: RealOrNone = eqx.field(**real("kg m²"), default=None)
    sensor: Sensor | None = None
    retardation: Real = eqx.field(
        **real(
            "s",
            "retardation time of the contacts' damping; whole bearings have 2.5 to 25"
            " us (Krämer 1993)",
        ),
        default=1e-5,
    )
    moving_ring: str = eqx.field(static=True, default="outer")
    tilts: bool = eqx.field(static=True, default=True)
    cage: GuidedCage | None = None
    half_width: Float[Array, " row"] | None = eqx.field(
        converter=as_real, metadata=unit("m"), default=None
    )

    def __check_init__(self):
        instance(self, "element", BearingElement)
        instance(self, "cage", GuidedCage, None)
        self._check_rows()
        positive(self, "mass")
        instance(self, "speed", Speed)
        instance(self, "sensor", Sensor, None)
        if self.tilting_inertia is not None:
            positive(self, "tilting_inertia")
            if not self.tilts:
                raise ValueError(
                    "NoiseModel: `tilting_inertia` is given for a ring that does not"
                    " tilt; leave it out, or `tilts`."
                )
        non_negative(self, "retardation")
        one_of(self, "moving_ring", self.moving_ring, RINGS, "'outer' or 'inner'")
        fits = is_real(self.load) and np.shape(self.load) == (6,)
        of_shape(self, "load", fits, "(6,): (Fx, Fy, Fz, Mx, My, Mz)")
        finite(self, "load")
        if is_traced(self.load):
            return
        held = np.asarray(self.load)[len(self.freedoms) :]
        allowed = "zero for freedoms that the ring does not have: it does not tilt"
        check(self, "load", held[: 5 - len(self.freedoms)] == 0.0, allowed)
        check(self, "load", np.asarray(self.load)[5] == 0.0, "zero about the axis")

    def _check_rows(self):
        bearing, kinematics = self.element.bearing, self.element.kinematics
        aligning = is_self_aligning(bearing)
        arcs = getattr(rows_of(bearing)[0].bearing, "arc_radii", None) is not None
        if kinematics.turns_far and not (aligning or arcs):
            raise ValueError(
                "NoiseModel: `kinematics` is finite; the noise of this bearing is with"
                " linearised kinematics."
            )
        if aligning and self.tilting_inertia is not None:
            raise ValueError(
                "NoiseModel: `tilting_inertia` is given for a self-aligning bearing,"
                " whose ring nothing holds from tilting; leave it out."
            )
        if self.cage is not None and not isinstance(bearing, AbstractBallBearing):
            raise TypeError(
                f"NoiseModel: `cage` is given for a {type(bearing).__name__}; it is for"
                " ball bearings of one row."
            )
        for row in rows_of(bearing):
            if row.bearing.raceway_deviation is not None:
                raise ValueError(
                    "NoiseModel: `raceway_deviation` is of errors that stand still;"
                    " those that turn are `errors` (in a scene, [deviations])."
                )
            if row.spring is not None:
                raise ValueError(
                    "NoiseModel: a spring presses a row, whose ring slides on its seat;"
                    " noise is of sets with a `preload_offset`."
                )
        self._check_errors()

    def _check_errors(self):
        bearing = self.element.bearing
        count = len(rows_of(bearing))
        given = self.errors if isinstance(self.errors, tuple) else (self.errors,)
        of_each = all(isinstance(one, FormErrors) for one in given)
        if not of_each:
            raise TypeError(
                "NoiseModel: `errors` must be FormErrors, or a tuple of them with one"
                " for each row."
            )
        if isinstance(self.errors, tuple) and len(given) != count:
            raise ValueError(
                f"NoiseModel: `errors` are of {len(given)} rows; the bearing has"
                f" {count}."
            )
        for row, errors in zip(rows_of(bearing), self.errors_of_rows, strict=True):
            errors.check(in_numpy(row.bearing))

    @property
    def errors_of_rows(self) -> tuple[FormErrors, ...]:
        """Form errors of each row."""
        if isinstance(self.errors, tuple):
            return self.errors
        return (self.errors,) * len(rows_of(self.element.bearing))

    @property
    def small_motions(self) -> BearingElement:
        """Bearing with linearised kinematics and the freedoms of the ring here."""
        return of_small_motions(self.element)

    @property
    def freedoms(self) -> tuple[str, ...]:
        """Freedoms of the moving ring."""
        return FREEDOMS[: 5 if self._can_tilt else 3]

    @property
    def _can_tilt(self) -> bool:
        return self.tilts and not is_self_aligning(self.element.bearing)

    @property
    def inertia(self) -> Scalar | None:
        """Moment of inertia about a diameter [kg m²]; `None`: the ring is held."""
        if not self._can_tilt:
            return None
        if self.tilting_inertia is not None:
            return self.tilting_inertia
        return ring_inertia(self.element.bearing, self.mass, self.moving_ring)

    @property
    def fixed_ring(self) -> str:
        """The ring that does not move, but may turn."""
        return RINGS[1 - RINGS.index(self.moving_ring)]

    @property
    def orbits(self) -> bool:
        """Whether a ring turns; traced speeds count as turning."""
        return floats(self.speed.outer, self.speed.inner) != [0.0, 0.0]

    @property
    def shaft_speed(self) -> Scalar:
        """Absolute speed of the ring that turns faster [rad/s]."""
        outer, inner = in_numpy((self.speed.outer, self.speed.inner))
        return array_namespace(outer, inner).maximum(abs(outer), abs(inner))

    @property
    def support(self) -> Support:
        """What holds the rings in the equilibrium under the load."""
        return Support(free=self.freedoms, fixed_ring=self.fixed_ring)

    def solve(
        self,
        element: BearingElement[Any],
        speed: Speed | None = None,
        start: Float[Array, "6"] | None = None,
    ) -> Solution:
        """Solve a bearing under the load of the model; never raises for a failure.

        Args:
            element: The bearing, such as that of the model at an instant.
            speed, start: As in `solve_load`.
        """
        options = SolveOptions(points=2)
        given = self.load, self.support, options
        return solve(element, *given, speed=speed, start=start)

    def system(self, points: int = 4096) -> NoiseSystem:
        """Return the equations of motion, with all constants evaluated.

        Args:
            points: Angles at which form errors are tabulated. Static.
        """
        return _system(self, points)

    def still_system(self) -> NoiseSystem:
        """System without form errors, with rolling elements at uniform orbit."""
        return dataclasses.replace(self.system(8), errors=None, cage=None)


def ring_inertia(bearing: Any, mass: Any, moving_ring: str) -> Scalar:
    """Return the moment of inertia about a diameter of a ring of given mass [kg m²].

    Its section is a square about the circle of contact, of the size given by the mass;
    in a set the mass is that of all rings, which tilt about the middle of the set.

    Args:
        bearing: A single row or a set.
        mass: Mass of the ring [kg].
        moving_ring: "outer" or "inner". Static.

    Source: m (3 (R₁² + R₂²) + b²)/12 of a hollow cylinder, with the radii R ± b/2 and
        b² = m/(2πRρ): m (R²/2 + 5 b²/24); and m z² of one that stands at z.
    """
    rows, mass = in_numpy((rows_of(bearing), as_real(mass)))
    part, total = mass / len(rows), 0.0 * mass
    for row in rows:
        radius = getattr(Surfaces.from_bearing(row.bearing), moving_ring).radius
        area = part / (2.0 * jnp.pi * radius * row.bearing.rings.density)
        total = total + part * (0.5 * radius**2 + 5.0 / 24.0 * area + row.position**2)
    return total


_BRIDGING = {"ball": 1.0, "roller": 0.5}


def bridged_surfaces(
    model: NoiseModel, surfaces: tuple[Surfaces, ...]
) -> tuple[Surfaces, ...]:
    """Return the contact tracks of each row, with their averaging of waves.

    Args:
        model: The bearing on its rig.
        surfaces: The tracks without it.
    """
    if (widths := model.half_width) is None:
        return surfaces
    p = _BRIDGING[model.element.bearing.noun]
    rows = zip(surfaces, widths, strict=True)
    return tuple(one.bridging(b, jnp.full_like(b, p)) for one, b in rows)


@program(quick=True)
def _system(model, points) -> NoiseSystem:
    found = DynamicRow.from_element(model.small_motions, model.speed)
    some = jax.tree.leaves(model.errors)
    mass = jnp.repeat(model.mass, 3)
    if (inertia := model.inertia) is not None:
        mass = jnp.concatenate([mass, jnp.repeat(inertia, 2)])
    errors = None
    if some:
        surfaces = bridged_surfaces(model, found.surfaces)
        both = zip(model.errors_of_rows, surfaces, strict=True)
        errors = tuple(one.as_tables(surfaces, points) for one, surfaces in both)
    return NoiseSystem(
        row=found.row,
        placements=found.placements,
        errors=errors,
        surfaces=found.surfaces,
        speeds=(model.speed.outer, model.speed.inner, found.carried, found.own),
        mass=mass,
        load=model.load[: mass.shape[0]],
        sensor=model.sensor,
        retardation=model.retardation,
        growth=None,
        moving=RINGS.index(model.moving_ring),
        counts=tuple(row.bearing.n_elements for row in rows_of(model.element.bearing)),
        cage=model.cage,
    )

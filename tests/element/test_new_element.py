"""Rolling elements of one's own, from this file alone, run through everything.

A torus-shaped roller in toroidal raceways, as CONTRIBUTING tells how to add one, and a
ball of fixed contact angle that has no own unknowns, as reduced models take it.
"""

from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.element import (
    AbstractChoices,
    AbstractRollingElement,
    choices_for,
    contact_energy,
)
from bearingjax.element.frame import section_matrix, to_roller_axes
from bearingjax.numerics.expansion import by_autodiff
from bearingjax.numerics.power import positive_power
from bearingjax.numerics.types import Scalar, as_real
from bearingjax.numerics.units import unit
from bearingjax.statics.warning_kinds import SOLUTION_KINDS


class TorusRollerBearing(bj.CylindricalRollerBearing):
    """Rollers with a profile of one large radius, in raceways of a larger one.

    Attributes are those of `CylindricalRollerBearing`, and
        profile_radius: Of the rollers [m].
        raceway_radius: Of both raceways, in the axial section [m].
        point_constant: c of Q = c·approach^(3/2) at a raceway [N/m^(3/2)].
    """

    profile_radius: Scalar = eqx.field(
        converter=as_real, kw_only=True, metadata=unit("m")
    )
    raceway_radius: Scalar = eqx.field(
        converter=as_real, kw_only=True, metadata=unit("m")
    )
    point_constant: Scalar = eqx.field(
        converter=as_real, kw_only=True, metadata=unit("N/m^(3/2)")
    )


class TorusRoller(AbstractRollingElement):
    """Centre of each profile arc against the centre of the raceway's arc.

    x are the shifts along and across the roller from the mean of the rings, and the
    tilt times the arc radius.
    """

    bearing: TorusRollerBearing

    n_unknowns: ClassVar[int] = 3

    @property
    def diameter(self):
        return self.bearing.roller_diameter

    @property
    def tether(self):
        return 1e-16 * self.bearing.point_constant * jnp.sqrt(self.diameter)

    @property
    def sees_difference(self):
        return True

    def axes(self, azimuth):
        b = self.bearing
        return to_roller_axes(b.axis_angle, 0.5 * b.pitch_diameter) @ section_matrix(
            azimuth
        )

    def coordinates(self, rings, x):
        # An arc of radius r that touches at m = ±D/2 has its centre at ±(D/2 - r).
        b, half = self.bearing, 0.5 * self.bearing.roller_diameter
        out = []
        for ring, side in ((rings.outer, 1.0), (rings.inner, -1.0)):
            own, race = (
                side * (half - b.profile_radius),
                side * (half - b.raceway_radius),
            )
            t, m, tilt = rings.mean + x * jnp.stack(
                [1.0 + 0.0 * half, 1.0 + 0.0 * half, 1.0 / b.profile_radius]
            )
            along = (t - own * tilt) - (ring[0] - race * ring[2])
            apart = side * (b.raceway_radius - b.profile_radius)
            out.append(jnp.stack([along, apart + m - ring[1]]))
        return jnp.stack(out)

    def respond(self, coordinates):
        b = self.bearing
        free = b.raceway_radius - b.profile_radius

        def energy(u):
            approach = jnp.sqrt(u @ u) - free
            return 0.4 * b.point_constant * positive_power(approach, 5, 2)

        found = by_autodiff(energy, coordinates)
        load = jnp.sqrt(jnp.sum(found.gradient**2, axis=1))
        return found._replace(aux=load)

    def energy(self, rings, x, contact_response=None):
        contacts = contact_energy(self, self.coordinates(rings, x), contact_response)
        return contacts + 0.5 * self.tether * jnp.sum(x**2)

    def motion(self, rings, x):
        place = rings.mean + x
        radius = 0.5 * self.bearing.pitch_diameter
        tilt = rings.mean[2] + x[2] / self.bearing.profile_radius
        return jnp.stack([place[0] + radius * tilt, place[1], tilt])


class TorusChoices(AbstractChoices):
    kinematics: bj.element.AbstractKinematics

    elements = "rollers"
    names = ("kinematics",)

    @classmethod
    def from_rows(cls, rows, **given):
        return cls(kinematics=given["kinematics"] or bj.element.Linearised())

    def rolling_element(self, part, speed, deviation) -> AbstractRollingElement:
        return TorusRoller(part.bearing)


@choices_for.register
def _(bearing: TorusRollerBearing) -> type[AbstractChoices]:
    return TorusChoices


TORUS = TorusRollerBearing(
    7,
    0.06,
    0.012,
    0.02,
    profile_radius=0.1,
    raceway_radius=0.103,
    point_constant=3e10,
)
ELEMENT = bj.BearingElement(TORUS)
LOAD = [500.0, -3000.0, 0.0, 0.0, 0.0, 0.0]
# Such rollers follow a shift or a tilt of the rings: nothing holds those.
FREE = ["ux", "uy"]


def test_force_and_stiffness_are_derivatives():
    q = jnp.asarray([0.0] * 6 + [4e-6, -20e-6, 30e-6, 2e-4, -1e-4, 0.0])
    e = ELEMENT.evaluate(q)
    assert int(e.result) == bj.Result.CONVERGED
    assert float(abs(e.force).max()) > 100.0
    gradient = jax.grad(ELEMENT.energy)(q)
    size = float(abs(e.force).max())
    np.testing.assert_allclose(gradient, e.force, atol=ROUNDING * size)
    step = jnp.asarray([3e-9, -2e-9, 4e-9, 1e-7, 2e-7, 0.0] * 2)
    ends = ELEMENT.force(q + step) - ELEMENT.force(q - step)
    along = 2.0 * e.stiffness @ step
    np.testing.assert_allclose(ends, along, atol=DIFFERENCE * float(abs(along).max()))
    # Rings balance.
    total = e.force[:6] + e.force[6:]
    assert float(abs(total).max()) < SOLVER * size


@pytest.mark.slow
def test_load_solve_sweep_and_gradients():
    solution = bj.solve_load(ELEMENT, LOAD, support=bj.Support(free=FREE))
    np.testing.assert_allclose(solution.force[6:8], LOAD[:2], atol=1e-7)
    assert solution.roller_load.shape == (7, 2)
    swept = bj.sweep(
        ELEMENT,
        bj.Cases(np.stack([LOAD, 0.5 * np.asarray(LOAD)])),
        outputs=("displacement", "roller_load"),
        support=bj.Support(free=FREE),
    )
    np.testing.assert_allclose(
        swept.displacement[0], solution.displacement, rtol=1e-9, atol=1e-15
    )

    @jax.jit
    @jax.value_and_grad
    def sag(radius):
        bearing = eqx.tree_at(lambda b: b.raceway_radius, TORUS, radius)
        element = bj.BearingElement(bearing)
        return bj.solve_load(element, LOAD, support=bj.Support(free=FREE)).displacement[
            7
        ]

    at, step = 0.103, 1e-6
    slope = float(sag(at)[1])
    ends = float(sag(at + step)[0] - sag(at - step)[0])
    assert slope == pytest.approx(ends / (2 * step), rel=DIFFERENCE)


def test_load_solve_without_load_and_hints():
    """A ring that is pushed across finds its place, though no load says how far."""
    solution = bj.solve_load(
        ELEMENT, [0.0] * 6, support=bj.Support(prescribed={"uy": 3e-5}, free=("ux",))
    )
    assert abs(float(solution.force[6])) < 1e-9 * float(solution.force[7])
    assert abs(float(solution.displacement[6])) > 1e-7


class FixedAngleBall(AbstractRollingElement):
    """Two contacts in series along the free contact angle: nothing is left to solve."""

    direction: jax.Array
    pitch_radius: jax.Array
    lever: jax.Array
    series: jax.Array
    diameter_: jax.Array

    n_unknowns: ClassVar[int] = 0

    @property
    def diameter(self):
        return self.diameter_

    @property
    def sees_difference(self):
        return True

    def axes(self, azimuth):
        shift = jnp.eye(3).at[0, 2].set(-self.pitch_radius)
        return shift @ section_matrix(azimuth)

    def coordinates(self, rings, x):
        z, r, tilt = rings.difference
        moved = jnp.stack([z, r]) + self.lever * tilt
        return -(self.direction @ moved)[None, None]

    def respond(self, coordinates):
        def energy(u):
            return 0.4 * self.series * positive_power(u[0], 5, 2)

        found = by_autodiff(energy, coordinates)
        load = jnp.concatenate([found.gradient[:, 0], found.gradient[:, 0]])
        return found._replace(aux=load)

    def energy(self, rings, x, contact_response=None):
        return contact_energy(self, self.coordinates(rings, x), contact_response)

    def motion(self, rings, x):
        place = rings.mean
        return jnp.stack([place[0], place[1], 0.0 * place[0]])


class FixedAngleBearing(bj.AngularContactBallBearing):
    """Its balls have a contact angle that no load changes."""


class FixedAngleChoices(TorusChoices):
    elements = "balls"

    def rolling_element(self, part, speed, deviation):
        b = part.bearing
        plain = (
            bj.BearingElement(balls(5), kinematics=bj.element.ConstantAngle())
            .model()
            .rows[0]
            .element
        )
        inner = plain.grooves.free[1]
        outer, own = plain.constant
        return FixedAngleBall(
            direction=inner,
            pitch_radius=0.5 * b.pitch_diameter,
            lever=plain.geometry.tilted[1],
            series=(outer ** (-2 / 3) + own ** (-2 / 3)) ** -1.5,
            diameter_=b.ball_diameter,
        )


@choices_for.register
def _(bearing: FixedAngleBearing) -> type[AbstractChoices]:
    return FixedAngleChoices


def test_an_element_without_unknowns_passes_through_the_same_machinery():
    reduced = bj.BearingElement(
        balls(5, FixedAngleBearing, contact_angle=np.deg2rad(25))
    )
    full = bj.BearingElement(balls(5), kinematics=bj.element.ConstantAngle())
    q = jnp.asarray([0.0] * 6 + [2e-6, -3e-6, 20e-6, 1e-4, -5e-5, 0.0])
    got, want = reduced.evaluate(q), full.evaluate(q)
    size, stiff = float(abs(want.force).max()), float(abs(want.stiffness).max())
    assert size > 10.0 and int(got.steps) == 0
    np.testing.assert_allclose(got.force, want.force, atol=SOLVER * size)
    np.testing.assert_allclose(got.stiffness, want.stiffness, atol=SOLVER * stiff)
    load, held = [0.0, -20.0, 300.0, 0.0, 0.0, 0.0], dict(gx=0.0, gy=0.0)
    one, other = (
        bj.solve_load(e, load, support=bj.Support(prescribed=held))
        for e in (reduced, full)
    )
    np.testing.assert_allclose(one.displacement, other.displacement, atol=1e-9 * 20e-6)


def test_warnings_about_rollers_need_the_results_of_rollers():
    kinds = {
        name for name, kind in SOLUTION_KINDS.items() if kind.applies(ELEMENT, None)
    }
    assert "contact_pressure" in kinds
    assert not kinds & {"edge_loaded", "contact_width", "contact_ellipse"}

"""Inertia of the rollers against a brute-force sum over their volume."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, bearings, taper
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.element import roller_speeds
from bearingjax.element.inertia import inertia_force, mass_and_inertia

SPEED = bj.Speed(inner=300.0, outer=-120.0)


def volume(diameter, length, half, density):
    """Points (axial, across, across) of a frustum from its middle, and their masses."""
    x, wx = np.polynomial.legendre.leggauss(12)
    height = length * np.cos(half)
    z = 0.5 * height * x
    angle = np.arange(24) * 2 * np.pi / 24
    share, ws = 0.5 * (x + 1), 0.5 * wx
    radius = 0.5 * diameter - z * np.tan(half)
    r = radius[:, None, None] * share[None, :, None]
    mass = (
        density
        * (0.5 * height * wx)[:, None, None]
        * (radius[:, None, None] ** 2 * (share * ws)[None, :, None])
        * np.full((1, 1, 24), 2 * np.pi / 24)
    )
    points = np.stack(
        np.broadcast_arrays(z[:, None, None], r * np.cos(angle), r * np.sin(angle))
    )
    return points.reshape(3, -1), mass.ravel()


def brute_force(bearing, orbit, spin):
    """Force along t and m and moment about the centre that inertia exerts."""
    axis, half = float(bearing.axis_angle), float(bearing.half_angle)
    points, mass = volume(
        float(bearing.roller_diameter),
        float(bearing.roller_length),
        half,
        float(bearing.material.density),
    )
    # Axes z, r, tangential (e_z x e_r); t along the roller, m across.
    t = np.array([np.cos(axis), -np.sin(axis), 0.0])
    m = np.array([np.sin(axis), np.cos(axis), 0.0])
    k = np.array([0.0, 0.0, 1.0])
    arm = np.stack([t, m, k], axis=1) @ points
    e_z = np.array([1.0, 0.0, 0.0])
    turn = orbit * e_z + spin * t
    change = orbit * spin * np.cross(e_z, t)
    acceleration = (
        np.cross(turn, np.cross(turn, arm.T)) + np.cross(change, arm.T)
    ) - orbit**2 * 0.5 * float(bearing.pitch_diameter) * np.array([0.0, 1.0, 0.0])
    # The model puts the mass centre at the roller centre.
    centred = arm.T - (mass @ arm.T) / mass.sum()
    force = -(mass @ acceleration)
    moment = -(mass @ np.cross(centred, acceleration))
    return mass, points, np.array([force @ t, force @ m, moment @ k])


@pytest.mark.parametrize("name", ["cylinder", "steep taper without cone", "taper"])
def test_against_the_sum_over_the_volume(name):
    bearing = {
        "cylinder": bearings()["cylindrical, crowned ends"],
        "steep taper without cone": taper(roller_half_angle=0.0, roller_axis_angle=0.5),
        "taper": taper(),
    }[name]
    constants = bj.BearingElement(bearing).model().rows[0].element.constants
    orbit, spin = map(float, roller_speeds(constants, SPEED))
    mass, points, want = brute_force(bearing, orbit, spin)
    got = np.asarray(inertia_force(constants, SPEED))
    total, axial, cross = map(float, mass_and_inertia(constants))
    assert total == pytest.approx(mass.sum(), rel=ROUNDING * 100)
    assert axial == pytest.approx(mass @ (points[1] ** 2 + points[2] ** 2), rel=1e-10)
    assert cross == pytest.approx(mass @ (points[0] ** 2 + points[1] ** 2), rel=1e-10)
    size = np.abs(want).max()
    # A cone's own mass centre lies tan(γ) h²/(3 D) = 0.16 mm off the middle of its
    # axis: 0.12 % of the pitch radius, left out of the force.
    tolerance = 1.5e-3 if name == "taper" else 1e-9
    assert np.abs(got[:2] - want[:2]).max() < tolerance * size
    assert abs(got[2] - want[2]) < 10 * tolerance * max(abs(want[2]), 1e-6 * size)


def test_rolling_without_slip():
    """Surface speeds of roller and raceways agree at both contacts."""
    bearing = bearings()["cylindrical, crowned ends"]
    constants = bj.BearingElement(bearing).model().rows[0].element.constants
    orbit, spin = map(float, roller_speeds(constants, SPEED))
    radius, pitch = 0.007, 0.03625
    assert orbit * pitch + (orbit + spin) * radius == pytest.approx(
        -120.0 * (pitch + radius)
    )
    assert orbit * pitch - (orbit + spin) * radius == pytest.approx(
        300.0 * (pitch - radius)
    )


def test_centrifugal_force_loads_the_outer_raceway():
    bearing = bj.CylindricalRollerBearing(
        8, 0.0725, 0.014, 0.01372, radial_internal_clearance=20e-6
    )
    element = bj.BearingElement(bearing)
    speed = bj.Speed(inner=1000.0)
    row = element.rows(jnp.zeros(12), speed)[0]
    mass, _, _ = mass_and_inertia(element.model().rows[0].element.constants)
    orbit, _ = roller_speeds(element.model().rows[0].element.constants, speed)
    expected = float(mass * 0.03625 * orbit**2)
    load = np.asarray(row.contact_load[:, :2])
    assert np.allclose(load[:, 0], expected, rtol=SOLVER)
    assert np.all(load[:, 1] == 0.0)
    # Quasi-static: by symmetry the rings feel no resultant.
    assert (
        np.abs(np.asarray(element.force(jnp.zeros(12), speed))).max() < 1e-8 * expected
    )


def test_gradient_with_respect_to_speed():
    element = bj.BearingElement(taper())
    q = jnp.zeros(12).at[8].set(30e-6)

    @jax.jit
    @jax.value_and_grad
    def axial(speed):
        return element.force(q, bj.Speed(inner=speed))[8]

    slope = float(axial(800.0)[1])
    difference = float(axial(800.5)[0] - axial(799.5)[0])
    assert abs(slope) > 0.0
    assert slope == pytest.approx(difference, rel=DIFFERENCE)


def test_cage_torque_is_the_derivative_through_the_azimuth():
    """A loaded, turned set of few rollers wants to turn on; held by default."""
    bearing = bj.CylindricalRollerBearing(7, 0.0725, 0.014, 0.01372)
    q = jnp.zeros(12).at[jnp.array([7, 11])].set(jnp.asarray([-30e-6, 0.1]))
    plain = bj.BearingElement(bearing)
    through = bj.BearingElement(bearing, cage_torque=True)
    held, turning = plain.evaluate(q), through.evaluate(q)
    assert float(held.force[11]) == 0.0
    step = 1e-5
    ends = [plain.evaluate(q.at[11].add(s * step)).energy for s in (1, -1)]
    torque = float(ends[0] - ends[1]) / (2 * step)
    assert abs(torque) > 1e-6
    assert float(turning.force[11]) == pytest.approx(torque, rel=1e-6)
    assert np.allclose(turning.force[:5], held.force[:5], rtol=1e-10, atol=1e-9)
    k = np.asarray(turning.stiffness)
    assert abs(k[11, 11]) > 0.0 and np.allclose(k, k.T, rtol=1e-9, atol=1e-3)


@pytest.mark.slow
def test_cage_torque_of_forces_without_potential_is_their_virtual_work():
    """Gyroscopic moments act: the energy does not know all forces."""
    q = 1e-6 * jnp.asarray([3, -2, 5, 90, -60, 0, 8, -35, 25, -120, 200, 1e5])
    speed = bj.Speed(inner=2000.0)
    pair = bj.BearingSet.back_to_back(balls(5), 0.02, 10e-6)
    kinds = [bj.BearingElement(pair, cage_torque=turns) for turns in (False, True)]
    evaluated = [element.evaluate(q, speed) for element in kinds]
    plain, through = (np.asarray(e.force) for e in evaluated)
    keep = [0, 1, 2, 3, 4, 6, 7, 8, 9, 10]
    assert np.array_equal(plain[keep], through[keep])
    blocks = [np.asarray(e.stiffness)[np.ix_(keep, keep)] for e in evaluated]
    # The Jacobian, and the condensed stiffness, of forces up to 1e8 N/m.
    assert np.allclose(*blocks, rtol=SOLVER, atol=1e-3)
    # What the rings' forces do while the balls move on, each row seen by itself.
    torque, step = np.zeros(2), 1e-6
    model = kinds[0].model(speed)
    solved = model.solve(q)
    parts = zip(model.rows, *(model.in_order(part) for part in solved), strict=True)
    for row, azimuth, state in parts:
        local = row.local(q)
        # Ring motions in the balls' axes, the balls turned on.
        ends = [row.in_element_axes(local, azimuth + sign * step) for sign in (1, -1)]
        work = jnp.sum(state.energies.gradient * (ends[0] - ends[1])) / (2 * step)
        ratio = 0.0095 * np.cos(np.deg2rad(25)) / 0.052
        torque = torque + 0.5 * float(work) * np.array([1 + ratio, 1 - ratio])
    assert abs(torque[1]) > 1e-3
    assert np.allclose(through[[5, 11]], torque, rtol=DIFFERENCE)

"""Symmetry, balance and stiffness of an element at any ring freedoms and numbers."""

import functools

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from holds_for import holds_for, reals
from hypothesis import assume
from hypothesis import strategies as st
from registry import balls, taper
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.design import rows_of
from bearingjax.element import inertia_load


def deep_groove(numbers, mirrored=False):
    """Seven turning balls; looks the same from both sides."""
    osculation, size, turn = numbers
    bearing = balls(
        7,
        bj.DeepGrooveBallBearing,
        outer_osculation=0.53 + 0.02 * osculation,
        radial_internal_clearance=10e-6 + 15e-6 * size,
        first_azimuth=turn,
    )
    return bj.BearingElement(bearing), True


def cylinder(numbers, mirrored=False):
    """Six rollers at rest between four ribs."""
    crown, size, turn = numbers
    gaps = {"minus": 1e-6, "plus": 3e-6}
    if mirrored:
        gaps = dict(zip(gaps, reversed(gaps.values()), strict=True))
    ribs = {
        f"{ring}_{side}": bj.Rib(0.3, 1.5e-3, gap)
        for ring in ("outer", "inner")
        for side, gap in gaps.items()
    }
    bearing = bj.CylindricalRollerBearing(
        6,
        0.065,
        0.010,
        0.010,
        roller_profile=bj.CircularCrown(3.0 + crown),
        ribs=bj.Ribs(**ribs),
        radial_internal_clearance=10e-6 * size,
        first_azimuth=turn,
    )
    rule = bj.numerics.ContactMapped(16)
    return bj.BearingElement(bearing, quadrature=rule), False


def row_of(bearing, mirrored, offset=0.0):
    """A set of one row, which may be turned round."""
    sign = -1.0 if mirrored else 1.0
    row = bj.SetRow(bearing, sign * 0.01, mirrored, sign * offset)
    return bj.BearingSet((row,))


def tapered(numbers, mirrored=False):
    """Five turning tapers on a rib."""
    angle, size, turn = numbers
    axis = np.radians(12 + 4 * angle)
    bearing = taper(
        5,
        roller_axis_angle=axis,
        # All apexes in one point.
        roller_half_angle=np.arctan(0.0082 / 0.052 * np.sin(axis)),
        radial_internal_clearance=5e-6 * size,
        first_azimuth=turn,
    )
    # Stiffness and slope of the force differ by the error of the quadrature: with 16
    # points 1.2e-5 in one of the examples, with 24 points 3e-7.
    rule = bj.numerics.ContactMapped(24)
    return bj.BearingElement(row_of(bearing, mirrored), quadrature=rule), True


def operating(numbers, mirrored=False):
    """Six turning balls, whose contacts have no potential."""
    angle, size, turn = numbers
    bearing = balls(contact_angle=np.radians(25 + 8 * angle), first_azimuth=turn)
    element = bj.BearingElement(
        row_of(bearing, mirrored, 4e-6 * size),
        point_law=bj.contact.OperatingAngle(),
        raceway_control=bj.element.LoadShare(),
    )
    return element, True


DESIGNS = {one.__name__: one for one in (deep_groove, cylinder, tapered, operating)}
QUICK = frozenset({"deep_groove", "cylinder"})


def share():
    """A number between -1 and 1."""
    return reals(-1, 1)


ANY = {
    "numbers": st.tuples(share(), share(), share()),
    "way": st.lists(share(), min_size=12, max_size=12),
    "size": st.sampled_from([0.3, 1.0, 3.0, 10.0]),
    "rpm": reals(-6000, 6000),
}
"""Numbers of the design, direction and size of the ring freedoms, and speed."""


def motion(way, size):
    """Ring freedoms that may load some elements; both rings have not turned."""
    q = size * np.asarray(way) * np.tile(np.repeat([1e-5, 2e-4], 3), 2)
    q[7] -= 18e-6
    q[8] += 25e-6
    q[[5, 11]] = 0.0
    return q


@eqx.filter_jit
def _evaluate(element, q, speed):
    model = element.model(speed)
    solved = model.solve(q)
    return model.evaluate(q, solved), inertia_load(model.results(q, solved))


def evaluate(made, q, rpm):
    """Force, stiffness and inertia load at ring freedoms, all converged."""
    element, turns = made
    omega = rpm * np.pi / 30
    speed = bj.Speed(omega, -0.25 * omega) if turns else None
    found, inertia = _evaluate(element, jnp.asarray(q), speed)
    assume(int(found.result) == bj.Result.CONVERGED)
    return np.asarray(found.force), np.asarray(found.stiffness), np.asarray(inertia)


def turn(angle):
    """Matrix that turns motions or loads of both rings about z (12, 12)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.kron(np.eye(4), [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def mirror(axis):
    """Matrix that mirrors motions or loads of both rings across a plane (12, 12).

    Args:
        axis: Number of the axis that is normal to the plane.
    """
    sign = np.ones(3)
    sign[axis] = -1.0
    # Rotations and moments are axial vectors.
    return np.diag(np.tile(np.concatenate([sign, -sign]), 2))


def is_close(force, wanted):
    """Whether forces, and moments over the pitch radius, agree to round-off."""
    arm = np.tile(np.repeat([1.0, 0.03], 3), 2)
    size = np.abs(wanted / arm).max() + 1e-3
    return np.abs((force - wanted) / arm).max() < SOLVER * size


def stiffness_is_close(k, wanted):
    arm = np.tile(np.repeat([1.0, 0.03], 3), 2)
    size = np.abs(wanted / np.outer(arm, arm)).max() + 1.0
    # Where the last element touches, it follows the square root of a motion.
    return np.abs((k - wanted) / np.outer(arm, arm)).max() < 1e-5 * size


of_element = functools.partial(holds_for, DESIGNS, QUICK, **ANY)


@of_element(pitches=st.integers(-3, 3))
def test_turn_of_rings_by_pitches_turns_force(design, pitches, numbers, way, size, rpm):
    """So do the azimuths of the elements, and the rings along with all that moves."""
    made, q = design(numbers), motion(way, size)
    force, k, _ = evaluate(made, q, rpm)
    angle = 2 * np.pi * pitches / rows_of(made[0].bearing)[0].bearing.n_elements
    whole = turn(angle)
    turned, k_turned, _ = evaluate(made, whole @ q, rpm)
    assert is_close(turned, whole @ force)
    assert stiffness_is_close(k_turned, whole @ k @ whole.T)
    carried = q.copy()
    carried[[5, 11]] = angle
    assert is_close(evaluate(made, carried, rpm)[0], force)
    crown, size, first = numbers
    moved = design((crown, size, first + angle))
    assert is_close(evaluate(moved, q, rpm)[0], force)


@of_element(angle=reals(-3, 3))
def test_turn_of_bearing_turns_force(design, angle, numbers, way, size, rpm):
    whole, q = turn(angle), motion(way, size)
    force, k, _ = evaluate(design(numbers), q, rpm)
    moved = design((*numbers[:2], numbers[2] + angle))
    turned, k_turned, _ = evaluate(moved, whole @ q, rpm)
    assert is_close(turned, whole @ force)
    assert stiffness_is_close(k_turned, whole @ k @ whole.T)


@of_element()
def test_mirror_of_bearing_mirrors_force(design, numbers, way, size, rpm):
    """Across the plane y = 0 through the axis, and across the plane of the row."""
    q = motion(way, size)
    force, k, _ = evaluate(design(numbers), q, rpm)
    beside = design((*numbers[:2], -numbers[2]))
    for across, made, speed in (
        (mirror(1), beside, -rpm),
        (mirror(2), design(numbers, True), rpm),
    ):
        mirrored, k_mirrored, _ = evaluate(made, across @ q, speed)
        assert is_close(mirrored, across @ force)
        assert stiffness_is_close(k_mirrored, across @ k @ across)


@of_element()
def test_rings_and_inertia_balance(design, numbers, way, size, rpm):
    force, k, inertia = evaluate(design(numbers), motion(way, size), rpm)
    total = force[:6] + force[6:] + inertia
    assert is_close(np.tile(total, 2) + force, force)
    together = k @ np.tile(np.eye(6), (2, 1))[:, :5]
    assert np.abs(together).max() < ROUNDING * (np.abs(k).max() + 1.0)


@of_element(direction=st.lists(share(), min_size=12, max_size=12))
def test_stiffness_is_the_slope_of_force(design, direction, numbers, way, size, rpm):
    made, q = design(numbers), motion(way, size)
    _, k, _ = evaluate(made, q, rpm)
    potential = made[0].has_potential(bj.Speed(1.0) if made[1] else None)
    along = np.asarray(direction) * np.tile(np.repeat([1.0, 30.0], 3), 2)
    along[[5, 11]] = 0.0
    arm = np.tile(np.repeat([1.0, 0.03], 3), 2)
    scale = np.outer(arm, arm) * ((np.abs(k) / np.outer(arm, arm)).max() + 1.0)
    asymmetry = np.abs((k - k.T) / scale).max()
    assert asymmetry < (ROUNDING if potential else 0.1)
    errors = []
    for step in (3e-9, 3e-10, 3e-11):
        far = [evaluate(made, q + s * step * along, rpm)[0] for s in (1, -1)]
        slope = (far[0] - far[1]) / (2 * step)
        errors.append(np.abs((slope - k @ along) / arm).max())
    size = (np.abs(k) / np.outer(arm, arm)).max() + 1.0
    assert min(errors) < 1e-5 * size

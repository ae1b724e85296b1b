"""A roller of a solved bearing on the half-space, against the bearing's own slices.

What must agree: load and tilt as they were given, curvature and drop along the roller
with the element's, the large end at y < 0 as in `position`. Coupled slices, which know
their neighbours, must agree in moment, approach and pressure as well.
"""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, taper
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact.halfspace import FreeEnds
from bearingjax.element.constants import relative_radii

FREE = ("ux", "uy", "gx", "gy")


@pytest.fixture(scope="module")
def tapered():
    element = bj.BearingElement(taper(9), bj.contact.CoupledSlices())
    return element, bj.solve_load(element, [4000.0, 0, 2500.0, 0, 0, 0])


@pytest.mark.parametrize("raceway", ["inner", "outer"])
@pytest.mark.slow
def test_coupled_slices_agree(tapered, raceway):
    element, solution = tapered
    ring = bj.element.RINGS.index(raceway)
    got = bj.refine(element, solution, raceway=raceway)
    solved, y = got.solution, np.asarray(got.solution.grid.y)
    assert got.roller == int(solution.roller_load[:, ring].argmax())
    load = float(solution.roller_load[got.roller, ring])
    assert float(solved.load) == pytest.approx(load, rel=1e-9)
    # The slices, summed over the cells of the half-space.
    length = 2 * np.asarray(solved.grid.half_y)
    assert np.sum(got.slices.line_load * length) == pytest.approx(load, rel=0.01)
    moment = float(np.sum(got.slices.line_load * length * y))
    assert float(solved.moment) == pytest.approx(moment, abs=0.01 * load * 5.75e-3)
    approach = float(got.slices.approach)
    assert float(solved.approach) == pytest.approx(approach, rel=0.01)
    # Where the zone is full: slices are too long for its edges.
    pressure = np.asarray(solved.centre_pressure)
    middle = (np.abs(y) < 4e-3) & (pressure > 0.5 * pressure.max())
    ratio = np.asarray(solved.centre_pressure / got.slices.pressure)[middle]
    assert np.abs(ratio - 1).max() < 0.01
    assert got.edge_factor == pytest.approx(1.0, abs=0.03)
    # The bearing's own results.
    line_load = np.asarray(solution.line_load)[got.roller, ring]
    wanted = np.interp(y, solution.position, line_load)
    assert np.allclose(got.slices.line_load[middle], wanted[middle], rtol=1e-3)


@pytest.mark.slow
def test_the_contact_has_the_bearings_geometry(tapered):
    element, solution = tapered
    constants = element.model().rows[0].element.constants
    y = jnp.linspace(-5e-3, 5e-3, 5)
    for ring, raceway in enumerate(("outer", "inner")):
        contact = bj.refine(element, solution, raceway=raceway).contact
        wanted = relative_radii(constants, y)[ring]
        assert np.allclose(contact.relative_radius(y), wanted, rtol=ROUNDING)
        xi = y / constants.half_length
        assert np.allclose(contact.drop(y), constants.lines[ring].drop(xi), rtol=1e-9)
        assert float(contact.modulus) == pytest.approx(float(constants.modulus))
        assert np.sign(contact.raceway_radius) == (-1, 1)[ring]


@pytest.mark.slow
def test_positions_are_those_of_the_bearing():
    """Tilted tapers, position by position: the same end bears, in `solve` and here.

    Rollers of a set are counted row by row.
    """
    pair = bj.BearingSet.face_to_face(taper(5), 0.03, 30e-6)
    element = bj.BearingElement(pair, bj.contact.CoupledSlices())
    solution = bj.solve_load(element, [3000.0, 0, 500.0, 0, 6.0, 0])
    assert isinstance(solution, bj.statics.RollerSolution)
    loads = np.asarray(solution.roller_load[:, 1])
    # One of each row, the second of which is mirrored.
    for roller in (int(loads[:5].argmax()), 5 + int(loads[5:].argmax())):
        got = bj.refine(element, solution, roller)
        assert float(got.solution.load) == pytest.approx(loads[roller], rel=1e-9)
        total = np.sum(got.slices.line_load * 2 * got.solution.grid.half_y)
        assert float(total) == pytest.approx(loads[roller], rel=0.01)
        line, s = np.asarray(solution.line_load)[roller, 1], solution.position
        s = np.asarray(s if s.ndim == 1 else s[roller])
        given = np.interp(got.solution.grid.y, s, line)
        found = np.asarray(got.solution.line_load)
        # Where the zone is full: slices are long beside its edges.
        full = given > 0.5 * given.max()
        assert np.allclose(found[full], given[full], rtol=0.05)
        # It would be noticed: the other way round they differ.
        assert not np.allclose(found[::-1][full], given[full], rtol=0.2)
        high, low = got.contact.roller_radius(jnp.asarray([-5e-3, 5e-3]))
        assert high > low


@pytest.mark.slow
def test_a_one_sided_profile():
    """Dropped at s < 0, which is the large end of the roller, on one axis."""
    s = np.linspace(-6e-3, 6e-3, 13)
    drop = np.where(s < 0, 0.4 * s**2, 0.0)
    element = bj.BearingElement(taper(9, roller_profile=bj.Tabulated(s, drop)))
    solution = bj.solve_load(element, [0, 0, 6000.0, 0, 0, 0])
    got = bj.refine(element, solution, 0)
    high, low = got.contact.drop(jnp.asarray([-5.5e-3, 5.5e-3]))
    assert float(high) == pytest.approx(0.4 * 5.5e-3**2, rel=1e-2)
    assert float(low) == 0.0


@pytest.mark.slow
def test_independent_slices_miss_the_end():
    """A straight roller, edge loaded by a moment: the peak is beyond the slices'."""
    bearing = bj.CylindricalRollerBearing(9, 0.0725, 0.010, 0.015)
    element = bj.BearingElement(bearing)
    solution = bj.solve_load(
        element, [8000.0, 0, 0, 0, 30.0, 0], support=bj.Support(free=FREE)
    )
    got = bj.refine(element, solution)
    end = 2 * float(got.solution.grid.half_y[0])
    assert got.edge_factor > 2 and end < 5e-6
    softer = bj.refine(element, solution, free_ends=FreeEnds())
    assert 1 < softer.edge_factor < 0.7 * got.edge_factor


@pytest.mark.slow
def test_bad_input(tapered):
    element, solution = tapered
    with pytest.raises(ValueError, match="`raceway` is 'rib'; it must be"):
        bj.refine(element, solution, raceway="rib")
    with pytest.raises(ValueError, match="`roller` is 9; it must be from 0 to 8"):
        bj.refine(element, solution, 9)
    light = bj.CylindricalRollerBearing(
        9, 0.0725, 0.010, 0.015, radial_internal_clearance=40e-6
    )
    other = bj.BearingElement(light)
    loose = bj.solve_load(other, [1000.0, 0, 0, 0, 0, 0], support=bj.Support(free=FREE))
    with pytest.raises(ValueError, match="roller 4 bears no load on the outer raceway"):
        bj.refine(other, loose, 4, "outer")
    fast = bj.solve_load(
        other,
        [1000.0, 0, 0, 0, 0, 0],
        support=bj.Support(free=FREE),
        speed=bj.Speed(2e3),
    )
    got = bj.refine(other, fast, raceway="outer")
    load = fast.roller_load[got.roller, 0]
    np.testing.assert_allclose(got.solution.load, load, rtol=1e-6)
    play = lambda e: e.bearing.radial_internal_clearance  # noqa: E731
    tighter = eqx.tree_at(play, other, jnp.zeros(()))
    with pytest.raises(ValueError, match="give the element that was solved"):
        bj.refine(tighter, fast, raceway="outer")
    angular = bj.BearingElement(balls())
    solved = bj.solve_load(angular, [0, 0, 1000.0, 0, 0, 0])
    with pytest.raises(TypeError, match="the bearing has balls"):
        bj.refine(angular, solved)
    no_path = jnp.asarray(int(bj.Result.NO_LOAD_PATH), jnp.int32)
    lost = eqx.tree_at(lambda s: s.result, loose, no_path)
    with pytest.raises(ValueError, match="must be a single one that converged"):
        bj.refine(other, lost)

"""Free end faces: images against a longer grid, the factor against a quarter-space."""

import jax.numpy as jnp
import numpy as np
import pytest
import quarter_space
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact.halfspace import (
    FreeEnds,
    Grid,
    RollerContact,
    even_grid,
    graded_grid,
    influence,
)

STEEL = bj.Material(210e9, 0.3)


@pytest.mark.parametrize("make", [even_grid, graded_grid])
def test_images_are_a_longer_roller(make):
    """Mirrored pressure on three lengths, by the plain influence."""
    grid = make(0.01, 2e-4, 6, 8)
    edges = np.asarray(grid.edges)
    three = np.concatenate([-0.01 - edges[::-1][:-1], edges[:-1], 0.01 - edges[::-1]])
    long = Grid(grid.half_width, three, 6, True, False)
    pressure = np.random.default_rng(1).uniform(0, 1e9, grid.shape)
    share = 0.7
    tripled = np.concatenate(
        [share * pressure[:, ::-1], pressure, share * pressure[:, ::-1]], axis=1
    )
    wanted = influence(long, 1e11)(jnp.asarray(tripled))[:, 8:16]
    got = influence(grid, 1e11, share)(jnp.asarray(pressure))
    assert np.allclose(got, wanted, rtol=1e-10)
    # Mutual: areas times influence is symmetric.
    other = np.random.default_rng(2).uniform(0, 1e9, grid.shape)
    there = jnp.sum(grid.area * other * got)
    back = influence(grid, 1e11, share)(jnp.asarray(other))
    assert float(there) == pytest.approx(
        float(jnp.sum(grid.area * pressure * back)), rel=ROUNDING
    )


def test_the_factor_is_that_of_a_quarter_space():
    """Coarse cells; narrow contact, one twice as far from the face as the other."""
    cells = quarter_space.COARSE
    for row in quarter_space.run((0.0, 0.3, 0.45), (1.0, 2.0), (0.0, 30.0), cells):
        near = row["factor"]
        assert row["used"] == pytest.approx(near[1][0], rel=0.01)
        # Far apart along the edge all tend to the wedge of 90 degrees, the slower the
        # smaller Poisson's ratio: at this distance 6 % are left at zero, and 3 % more
        # are these cells'.
        ends = 0.5 * np.pi + 1, 0.5 * np.pi - 1
        wedge = 0.5 * np.pi * (1 / ends[0] + 1 / ends[1]) - 1
        assert near[0][1] == pytest.approx(wedge, rel=0.04 if row["poisson"] else 0.1)


def test_free_ends_are_softer_and_bear_less():
    found = []
    for ends in (None, FreeEnds(1.0), FreeEnds()):
        roller = RollerContact(
            0.015, 0.01, 0.012, material=STEEL, raceway_material=STEEL, free_ends=ends
        )
        found.append(roller.solve(3000.0, grid=roller.grid(1.8e-4)))
    approach = [float(s.approach) for s in found]
    ends = [float(s.centre_pressure[0]) for s in found]
    middle = [float(s.centre_pressure[32]) for s in found]
    assert approach[0] < approach[1] < approach[2] < 1.3 * approach[0]
    assert ends[0] > 2 * ends[1] > 4 * ends[2] > 4 * middle[2]
    assert middle[0] < middle[1] < middle[2]
    assert all(float(s.load) == pytest.approx(3000.0, rel=1e-11) for s in found)


def test_the_share_is_the_rollers():
    rigid = bj.Material(1e30, 0.3)
    assert float(FreeEnds(1.2).share(STEEL, STEEL)) == pytest.approx(0.6, rel=ROUNDING)
    assert float(FreeEnds(1.2).share(rigid, STEEL)) < 1e-15
    ceramic = bj.Material(310e9, 0.26)
    part = (0.9324 / 310) / (0.9324 / 310 + 0.91 / 210)
    assert float(FreeEnds(1.0).share(ceramic, STEEL)) == pytest.approx(part, rel=1e-9)


def test_what_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="`factor` is -1; it must be above 0"):
        FreeEnds(-1.0)
    grid = even_grid(0.01, 2e-4, 6, 8)
    with pytest.raises(ValueError, match="`mirrored` is 1.5; it must be"):
        influence(grid, 1e11, 1.5)

"""Natural modes of a four-point bearing, by hand; the published ones are the validation
case `kurushin_natural_frequencies`."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.noise import NoiseModel, Sensor, natural_modes
from bearingjax.noise.warning import _wandering_modes

# Without the inertia of the orbit, which presses every ball on the outer raceway.
SPEED = bj.Speed()
# Kurushin et al. (2011), 85-176211; a ball stands in the line of the load.
BEARING = bj.DeepGrooveBallBearing(
    14,
    0.0775,
    0.014288,
    outer_osculation=0.52,
    inner_osculation=0.52,
    first_azimuth=np.pi / 2,
    material=bj.Material(density=7850.0),
)
RADIAL = NoiseModel(
    bj.BearingElement(BEARING), 0.3716, [0.0, -250.0, 0.0, 0.0, 0.0, 0.0], SPEED,
    tilts=False,
)  # fmt: skip


@pytest.fixture(scope="module")
def radial():
    return natural_modes(RADIAL)


def ring_modes(found, direction):
    """Frequencies of modes in which the ring moves along a direction most."""
    share = found.ring**2 * 0.3716
    mine = np.argmax(share, axis=1) == direction
    return found.frequency[mine & (found.ring_share > 0.5)]


def test_a_four_point_bearing_has_higher_modes_than_the_paper(radial):
    """Its balls have four contacts under a radial load; the paper's, and the mass that
    was fitted to its figures, are of two.

    At the angle α a ball bears 2 K cos^(5/2) α δ^(3/2) in place of K δ^(3/2), and a
    stiffness goes with K^(2/3) at one load.
    """
    same = "n_balls", "pitch_diameter", "ball_diameter", "first_azimuth", "material"
    bearing = bj.FourPointBallBearing(
        **{name: getattr(BEARING, name) for name in same},
        outer_osculation=0.52,
        inner_osculation=0.52,
        shim_angle=np.radians(26.0),
    )
    element = bj.BearingElement(bearing)
    found = natural_modes(dataclasses.replace(RADIAL, element=element))
    higher = (2.0 * np.cos(np.radians(26.0)) ** 2.5) ** (1 / 3)
    for direction in (0, 1):
        (own,), (two,) = ring_modes(found, direction), ring_modes(radial, direction)
        assert own / two == pytest.approx(higher, rel=5e-3)


@pytest.mark.slow
def test_noise_model_tilting_inertia_of_ring():
    """As a ring of square section around the circle of contact, of the mass given."""
    free = dataclasses.replace(RADIAL, tilts=True)
    radius = 0.5 * (0.0775 + 0.014288)
    side = np.sqrt(0.3716 / (2.0 * np.pi * radius * 7850.0))
    ends = radius + 0.5 * side * np.array([-1.0, 1.0])
    inertia = 0.3716 / 12.0 * (3.0 * np.sum(ends**2) + side**2)
    assert free.inertia is not None
    np.testing.assert_allclose(free.inertia, inertia, rtol=SOLVER)
    assert free.freedoms[3:] == ("gx", "gy") and RADIAL.freedoms == ("ux", "uy", "uz")
    assert RADIAL.inertia is None
    given = dataclasses.replace(free, tilting_inertia=inertia)
    np.testing.assert_allclose(
        natural_modes(given).frequency, natural_modes(free).frequency, rtol=1e-6
    )
    with pytest.raises(ValueError, match="a ring that does not tilt"):
        dataclasses.replace(RADIAL, tilting_inertia=inertia)


def test_ring_share_of_ring_and_ball_modes(radial):
    along = np.flatnonzero(radial.frequency == ring_modes(radial, 1))[0]
    assert np.all(radial.ring_share[along + 1 :] < 0.05)
    # The outer ring presses ball 0, whose outwards is y.
    ring, ball = radial.ring[along, 1], radial.places[along, 0, 1]
    assert ring * ball > 0.0


def test_equations_of_the_paper(radial):
    """Balls that move radially, seven of them loaded: the same frequencies."""
    element = RADIAL.element
    solution = bj.solve_load(
        element,
        RADIAL.load,
        support=bj.Support(fixed_ring="inner", free=("ux", "uy", "uz")),
    )
    load = np.asarray(solution.roller_load)
    psi = np.asarray(bj.element.azimuths(BEARING)) + np.pi / 2
    loaded = load[:, 0] > 0
    assert loaded.sum() == 7
    constants = np.asarray(element.model().rows[0].element.constant)
    rate = 1.5 * constants ** (2 / 3) * load ** (1 / 3)
    mass = np.pi / 6 * 0.014288**3 * 7850.0
    for trig, direction in ((np.cos, 1), (np.sin, 0)):
        n = loaded.sum()
        outer, inner = rate[loaded].T
        c = trig(psi[loaded])
        k = np.zeros((n + 1, n + 1))
        k[0, 0] = np.sum(outer * c**2)
        k[0, 1:] = k[1:, 0] = -outer * c
        k[1:, 1:] = np.diag(outer + inner)
        m = np.array([0.3716, *[mass] * n])
        square = np.linalg.eigvalsh(k / np.sqrt(m[:, None] * m))
        (found,) = ring_modes(radial, direction)
        assert found == pytest.approx(np.sqrt(square[0]) / 2 / np.pi, rel=SOLVER)


def test_natural_modes_of_unloaded_balls_at_speed(radial):
    """Their mass then lowers the ring's frequencies, which no published one shows."""
    turning = dataclasses.replace(RADIAL, speed=bj.Speed(inner=1500 * np.pi / 30))
    found = natural_modes(turning)
    (still,), (along,) = ring_modes(radial, 1), ring_modes(found, 1)
    carried = 7 * np.pi / 6 * 0.014288**3 * 7850.0
    # All of their mass would move along were their springs stiff.
    least = still * np.sqrt(0.3716 / (0.3716 + carried))
    assert least < along < 0.97 * still
    assert np.min(found.frequency) > 100.0


def test_wandering_modes_warning_under_radial_load():
    """Eight of them, on the way of one to the place of the next."""
    eight = dataclasses.replace(BEARING, n_balls=8, radial_internal_clearance=20e-6)
    turning = bj.Speed(inner=10.0)

    def at(angle):
        bearing = dataclasses.replace(eight, first_azimuth=np.pi / 2 + angle)
        element = bj.BearingElement(bearing)
        return dataclasses.replace(RADIAL, element=element, speed=turning)

    places = [natural_modes(at(k * np.pi / 32)) for k in range(8)]
    across = [ring_modes(found, 0)[0] for found in places]
    ends = min(across), max(across)
    assert ends[1] > 1.4 * ends[0]
    for first in (0.0, np.pi / 8):
        (text,) = _wandering_modes(at(first))
        (along,) = (one for one in text.split("; ") if "along x" in one)
        told = along.partition(" between ")[2].split(" Hz")[0].split(" and ")
        np.testing.assert_allclose(np.array(told, float), ends, rtol=1e-4)
    # Under an axial load all places are alike.
    axial = dataclasses.replace(at(0.0), load=jnp.array([0.0, 0, 250.0, 0, 0, 0]))
    assert not list(_wandering_modes(axial))


@pytest.mark.slow
def test_derivatives(radial):
    def highest(values):
        model = dataclasses.replace(RADIAL, mass=values[0], sensor=Sensor(values[1]))
        model = dataclasses.replace(model, load=model.load.at[1].mul(values[2]))
        return natural_modes(model).frequency[-8]

    at = jnp.array([0.3716, 1e6, 1.0])
    slope = jax.grad(highest)(at)
    for k, h in enumerate((1e-5, 1e2, 1e-5)):
        away = jnp.zeros(3).at[k].set(h)
        difference = (highest(at + away) - highest(at - away)) / (2 * h)
        assert float(slope[k]) == pytest.approx(float(difference), rel=DIFFERENCE)

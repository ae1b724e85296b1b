"""Geometry of the rib contact, drawn anew, and its share of the load."""

import jax.numpy as jnp
import numpy as np
import pytest
from registry import taper
from tolerances import ROUNDING, SOLVER

import bearingjax as bj


def section(bearing):
    """t, m, roller centre in (z, r)."""
    b = -float(bearing.axis_angle)
    t = np.array([np.cos(b), np.sin(b)])
    m = np.array([-np.sin(b), np.cos(b)])
    return t, m, np.array([0.0, 0.5 * float(bearing.pitch_diameter)])


@pytest.mark.parametrize("name", bj.design.RIB_NAMES)
@pytest.mark.parametrize("kind", ["cylinder", "taper"])
def test_rib_contact_point_of_sphere_end(kind, name):
    rib = bj.Rib(0.09, 1.2e-3, 5e-6)
    ribs = bj.Ribs(**{name: rib})
    bearing = (
        taper(ribs=ribs)
        if kind == "taper"
        else bj.CylindricalRollerBearing(9, 0.052, 0.0082, 0.0115, ribs=ribs)
    )
    half = float(bearing.half_angle)
    side = -1.0 if name.endswith("minus") else 1.0
    ring = 1.0 if name.startswith("outer") else -1.0
    contacts = bj.BearingElement(bearing).model().rows[0].element.constants.ribs
    assert contacts is not None
    normal, centre, point = (
        np.asarray(v[0]) for v in (contacts.normal, contacts.centre, contacts.point)
    )
    # Sphere: its pole on the axis at the end of the roller length.
    length, diameter = float(bearing.roller_length), float(bearing.roller_diameter)
    pole = side * 0.5 * length * np.cos(half)
    assert np.allclose(centre, [pole - side * 0.09, 0.0], atol=1e-17)
    # End of the raceway generator, on the ring that the rib stands on.
    s = side * 0.5 * length
    edge = np.array([pole, ring * (0.5 * diameter - s * np.sin(half))])
    assert np.hypot(*normal) == pytest.approx(1.0, abs=ROUNDING)
    assert np.allclose(point - centre, (0.09 + 5e-6) * normal, atol=1e-15)
    assert side * normal[0] > 0.9  # away from the roller
    # The rib runs from the edge to the contact: square to the normal, 1.2 mm high.
    direction = np.array([-normal[1], normal[0]])
    direction *= np.sign(direction[1] * -ring)
    assert (centre - edge) @ direction == pytest.approx(1.2e-3, rel=1e-10)


@pytest.mark.slow
def test_axial_load_of_an_nup_passes_through_opposite_ribs():
    ribs = bj.Ribs.arrangement("NUP", bj.Rib(0.3, 1.5e-3), 10e-6)
    bearing = bj.CylindricalRollerBearing(
        14, 0.065, 0.010, 0.010, roller_profile=bj.Logarithmic(), ribs=ribs
    )
    s = bj.solve_load(bj.BearingElement(bearing), [0, -20e3, 1400.0, 0, 0, 0])
    rib = np.asarray(s.rib_load)
    # Inner ring pushed to +z: its -z rib on the rollers, they on the outer +z rib.
    assert rib[:, 0].max() == 0.0 and rib[:, 3].max() == 0.0
    loads = {"outer": rib[:, 1].sum(), "inner": rib[:, 2].sum()}
    for load in loads.values():
        # The ribs open by less than 2 degrees.
        assert load == pytest.approx(1400.0, rel=1e-3)
    # And the other way round.
    back = bj.solve_load(bj.BearingElement(bearing), [0, -20e3, -1400.0, 0, 0, 0])
    assert np.allclose(np.asarray(back.rib_load)[:, [3, 0]], rib[:, [2, 1]], atol=1e-6)


def test_taper_rib_load_follows_from_balance():
    """Roller between two raceways of different angle: the rib takes the rest."""
    element = bj.BearingElement(taper())
    q = jnp.zeros(12).at[8].set(40e-6)
    row = element.rows(q)[0]
    axis, half = np.deg2rad(11), np.deg2rad(1.7235)
    outer, inner = np.asarray(row.contact_load[:, :2])[0]
    rib = float(row.contact_load[0, 2])
    ribs = element.model().rows[0].element.constants.ribs
    assert ribs is not None
    t_m = np.asarray(ribs.normal[0])
    # Forces on the roller along t and across it.
    along = -outer * np.sin(half) - inner * np.sin(half) - rib * t_m[0]
    across = -outer * np.cos(half) + inner * np.cos(half) - rib * t_m[1]
    assert abs(along) < SOLVER * outer and abs(across) < SOLVER * outer
    assert rib == pytest.approx(2 * outer * np.sin(half), rel=0.02)
    axial = 6 * outer * np.sin(axis + half)
    assert float(element.force(q)[8]) == pytest.approx(axial, rel=SOLVER)

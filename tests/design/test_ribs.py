"""Ribs and their arrangements by the names of bearing types."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from bearingjax.design import RIB_NAMES, Rib, Ribs

RIB = Rib(0.1, 0.002, 1e-5)


@pytest.mark.parametrize(
    "name, present",
    [
        ("N", ("inner_minus", "inner_plus")),
        ("NU", ("outer_minus", "outer_plus")),
        ("NJ", ("outer_minus", "outer_plus", "inner_minus")),
        ("NUP", ("outer_minus", "outer_plus", "inner_minus", "inner_plus")),
    ],
)
def test_arrangements(name, present):
    """A quarter of the axial play at each rib; without one, the rib's own gap."""
    ribs = Ribs.arrangement(name, RIB, 8e-5)
    assert ribs.present == present
    for rib in RIB_NAMES:
        assert (getattr(ribs, rib) is not None) == (rib in present)
    for rib in present:
        numbers = getattr(ribs, rib)
        assert float(numbers.axial_gap) == 2e-5
        assert float(numbers.end_radius) == 0.1
        assert float(numbers.contact_height) == 0.002
    own = Ribs.arrangement(name, RIB)
    assert all(float(getattr(own, rib).axial_gap) == 1e-5 for rib in present)


def test_no_ribs():
    assert Ribs().present == ()


def test_order_is_fixed():
    assert Ribs(inner_plus=RIB, outer_minus=RIB).present == (
        "outer_minus",
        "inner_plus",
    )


@pytest.mark.parametrize(
    "change, message",
    [
        ((0.0, 0.002), r"`end_radius` is 0 m.*above 0 m"),
        ((-0.1, 0.002), r"`end_radius` is -0.1 m.*above 0 m"),
        ((0.1, -1e-6), r"`contact_height` is -1e-06 m.*at least 0 m"),
        ((0.1, np.inf), r"`contact_height` is inf m.*finite"),
        ((0.1, 0.002, np.nan), r"`axial_gap` is nan m.*finite"),
        ((0.1, 0.002, [0.0, 0.0]), r"`axial_gap` has shape \(2,\).*in m"),
    ],
)
def test_bad_ribs(change, message):
    with pytest.raises(ValueError, match="Rib: " + message):
        Rib(*change)


def test_ribs_may_touch_and_interfere():
    """No height, and a negative gap, are allowed."""
    rib = Rib(0.1, 0.0, -1e-5)
    assert float(rib.contact_height) == 0.0 and float(rib.axial_gap) == -1e-5


def test_unknown_arrangement():
    with pytest.raises(ValueError, match=r"`arrangement` is 'QJ'.*N, NU, NJ, NUP"):
        Ribs.arrangement("QJ", RIB)


def test_traced_clearance():
    def gap(clearance):
        return Ribs.arrangement("NU", RIB, clearance).outer_plus.axial_gap

    assert jax.jit(jax.grad(gap))(jnp.asarray(8e-5)) == 0.25

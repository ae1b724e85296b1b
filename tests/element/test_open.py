"""Rollers that are known to be open before they are solved."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.element.energy import ring_motions as motions_of_rings
from bearingjax.element.rolling_element import RingMotion

MOTIONS = 40


def cylindrical(**more):
    return bj.CylindricalRollerBearing(
        11, 0.065, 0.010, 0.010, radial_internal_clearance=20e-6, **more
    )


def taper(profile):
    return bj.TaperedRollerBearing(
        17, 0.06, 0.008, 0.012, roller_half_angle=0.033, roller_axis_angle=0.25,
        roller_profile=profile,
        ribs=bj.Ribs(inner_minus=bj.Rib(0.15, 0.0, 1e-3)),
    )  # fmt: skip


class MaybeProtrudingCrown(bj.CircularCrown):
    """Rollers with this profile are never known to be open: all are evaluated."""

    protruding = True


class MaybeProtrudingLogarithmic(bj.Logarithmic):
    protruding = True


def nup(profile):
    ribs = bj.Ribs.arrangement("NUP", bj.Rib(0.3, 10e-6, 1e-3))
    return cylindrical(roller_profile=profile, ribs=ribs)


# A bearing, with its roller profile and with one never known to be open.
DESIGNS = {
    "crowned": (
        lambda profile: cylindrical(roller_profile=profile),
        bj.CircularCrown(1.0),
        MaybeProtrudingCrown(1.0),
    ),
    "logarithmic, NUP": (nup, bj.Logarithmic(), MaybeProtrudingLogarithmic()),
    "taper": (taper, bj.CircularCrown(2.0), MaybeProtrudingCrown(2.0)),
}


def ring_motions():
    rng = np.random.default_rng(4)
    q = rng.normal(size=(MOTIONS, 12)) * np.tile([8e-6] * 3 + [2e-4] * 3, 2)
    return jnp.asarray(q)


def evaluated(element, q, over):
    """Of one motion at a time by `lax.map`, of all in a batch by `vmap`."""
    model = element.model()

    def one(q):
        e = model.evaluate(q)
        return e.energy, e.force, e.stiffness, e.result

    return over(one, q)


def in_a_batch(one, q):
    """Where lanes are gathered."""
    return jax.vmap(one)(q)


@pytest.mark.parametrize("design", DESIGNS)
@pytest.mark.slow
def test_open_rollers_carry_no_load(design):
    build, told, untold = DESIGNS[design]
    element = bj.BearingElement(build(told))
    q = ring_motions()
    model = element.model()
    (row,) = jax.vmap(model.solve)(q).groups
    roller = model.rows[0].element

    def told(rings):
        return roller.hints.is_open(motions_of_rings(roller, rings))

    is_open = np.asarray(jax.vmap(jax.vmap(told))(row.rings))
    assert 0.1 < np.mean(is_open) < 0.9
    assert np.all(np.asarray(row.state.result) == bj.Result.CONVERGED)
    assert np.all(np.asarray(row.energies.aux.contact_load)[is_open] == 0.0)
    # One reference: that a batch is a loop is an identity of every element.
    want = evaluated(bj.BearingElement(build(untold)), q, jax.lax.map)
    for over in (jax.lax.map, in_a_batch):
        got = evaluated(element, q, over)
        for mine, theirs in zip(got, want, strict=True):
            scale = np.max(np.abs(theirs))
            # Each roller is balanced to 1e-13 of its load, from another start.
            np.testing.assert_allclose(mine, theirs, rtol=1e-9, atol=1e-9 * scale)


def test_is_open_is_none_for_protruding_tabulated_profile():
    # Between the points the parabolas swing out to 0.6 um above the generator.
    s = jnp.array([-5.0, -1.5, 1.5, 5.0]) * 1e-3
    profile = bj.Tabulated(s, jnp.array([15e-6, 0.0, 0.0, 15e-6]))
    element = bj.BearingElement(cylindrical(roller_profile=profile))
    assert float(profile.drop(jnp.zeros(()), 0.01, 0.01)) < -5e-7
    roller = element.model().rows[0].element
    zero = jnp.zeros(3)
    assert roller.hints.is_open(RingMotion(zero, zero)) is None


def test_is_open_is_false_for_nan_motion():
    model = bj.BearingElement(cylindrical(roller_profile=bj.CircularCrown(1.0))).model()
    nothing = jnp.full(3, jnp.nan)
    hints = model.rows[0].element.hints
    assert not hints.is_open(RingMotion(nothing, nothing))
    e = model.evaluate(jnp.full(12, jnp.nan))
    assert int(e.result) == bj.Result.NON_FINITE


@pytest.mark.slow
def test_derivatives_of_an_open_bearing_are_finite():
    element = bj.BearingElement(cylindrical(roller_profile=bj.CircularCrown(1.0)))
    energy, force = jax.value_and_grad(element.energy)(jnp.zeros(12))
    assert float(energy) == 0.0
    np.testing.assert_array_equal(force, np.zeros(12))
    model = element.model()
    apart = [model.is_apart(model.solve(jnp.zeros(12).at[7].set(u))) for u in (0, 1e-3)]
    assert apart == [True, False]
    slopes = jax.grad(lambda e: jnp.sum(e.force(jnp.zeros(12))))(element)
    assert all(np.all(np.isfinite(x)) for x in jax.tree.leaves(slopes))


class Bulged(bj.design.AbstractProfile):
    """Stands out in the middle by 5 um."""

    def drop(self, position, length, diameter):
        return 5e-6 * (4.0 * position**2 / length**2 - 0.5)


class ToldBulged(Bulged):
    protruding = True


def test_profile_protruding_in_middle_must_be_declared():
    """Else rollers that it loads are taken for open."""
    with pytest.raises(ValueError, match="crown_drop` is -2.5e-06 m; .*protruding"):
        cylindrical(roller_profile=Bulged())
    # Two bulges of 2.5 um touch where the straight line is up to 5 um apart.
    element = bj.BearingElement(
        cylindrical(roller_profile=ToldBulged()),
        quadrature=bj.numerics.ContactMapped(16),
    )
    q = jnp.zeros(12).at[7].set(-11e-6)
    load = element.rows(q)[0].contact_load[:, :2]
    assert int((load > 1.0).all(axis=1).sum()) >= 3

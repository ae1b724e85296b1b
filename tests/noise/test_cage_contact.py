"""Force law of the cage's contacts, against a bracketing root finder."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.optimize import brentq
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.noise import CageContact

CONTACT = CageContact(film=5e-6)
FORCES = np.logspace(-8, 4, 25)
force = jax.jit(lambda contact, approach: contact.force(approach))


@pytest.mark.parametrize("film", [1e-12, 1e-7, 5e-6, 1e-3])
def test_roots(film):
    contact = CageContact(film)

    def excess(y, d):
        f = np.exp(y)
        return np.log((2.81e-8 * f**1.29 + film * f ** (1 / 40)) / d)

    at = np.asarray(contact.approach(jnp.asarray(FORCES)))
    roots = [brentq(excess, -80, 80, args=(d,), xtol=1e-14, rtol=1e-15) for d in at]
    expected = np.array(roots, dtype=float)
    found = force(contact, jnp.asarray(at))
    # An approach to round-off is a force to 40 times that, where the film is thin.
    np.testing.assert_allclose(
        np.log(found),
        np.asarray(expected, float),
        rtol=0,
        atol=50 * np.finfo(float).eps * 40,
    )
    back = contact.approach(found)
    np.testing.assert_allclose(back, at, rtol=ROUNDING)


def test_apart_and_rising():
    assert np.all(force(CONTACT, jnp.array([-1.0, -1e-300, 0.0])) == 0.0)
    at = jnp.asarray(np.logspace(-7, -2, 200))
    assert np.all(np.diff(force(CONTACT, at)) > 0.0)
    assert np.isnan(force(CONTACT, jnp.array([np.nan]))[0])


def test_contact_force_and_derivatives_are_finite():
    most = np.finfo(float)
    at = [-most.max, -most.tiny, 0.0, most.tiny, 1e-300, 1e-100, 1e-12, 5e-6, 1.0]
    at = jnp.array([*at, 1e100, most.max])
    for contact in (CONTACT, dataclasses.replace(CONTACT, elastic_exponent=0.5)):
        function = contact.force
        for _ in range(4):
            assert np.all(np.isfinite(jax.vmap(function)(at)))
            function = jax.grad(function)


def test_derivatives():
    """To the parts of the law and to the approach; the second one too."""

    @jax.jit
    def total(values):
        contact = CageContact(*(values[:4] * jnp.array([5e-6, 2.81e-8, 1.29, 40.0])))
        return jnp.sum(contact.force(values[4] * jnp.array([5.2e-6, 1e-5, 4e-5, -1.0])))

    slope = jax.jit(jax.grad(total))
    second = jax.jit(jax.hessian(total))(jnp.ones(5))
    for k in range(5):
        away = jnp.zeros(5).at[k].set(1e-5)
        up, down = jnp.ones(5) + away, jnp.ones(5) - away
        found = float(slope(jnp.ones(5))[k])
        assert found == pytest.approx(
            float((total(up) - total(down)) / 2e-5), rel=DIFFERENCE
        )
        difference = (slope(up) - slope(down)) / 2e-5
        scale = 1e-5 * np.abs(second[k]).max()  # four times the error, of h² f''''/6
        np.testing.assert_allclose(second[k], difference, rtol=0, atol=scale)


def test_repeated_substitution_of_the_source_moves_away():
    """003.2: it contracts only for c Fⁿ < a F^(1/m)/51.6, below 3 N here."""
    c, a, n, m = 2.81e-8, 5e-6, 1.29, 40.0
    assert m * n == pytest.approx(51.6)
    for newton, moves_away in ((1.0, False), (2.0, False), (4.0, True), (50.0, True)):
        d = float(CONTACT.approach(jnp.asarray(newton)))
        guess = newton * (1 + 1e-6)
        again = ((d - c * guess**n) / a) ** m
        ratio = abs(again / newton - 1) / 1e-6
        share = m * n * c * newton**n / (a * newton ** (1 / m))
        assert ratio == pytest.approx(share, rel=1e-3)
        assert (ratio > 1.0) == moves_away
        assert float(CONTACT.force(jnp.asarray(d))) == pytest.approx(newton, rel=1e-12)


def test_wrong_contacts():
    with pytest.raises(ValueError, match="`film` is 0 m; it must be above"):
        CageContact(0.0)

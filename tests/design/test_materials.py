"""Materials and the contact modulus."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

from bearingjax.design import MATERIALS, Material, contact_modulus
from bearingjax.design.logarithmic import STEEL_MODULUS


def test_named_materials():
    numbers = {
        "steel": (206e9, 0.3, 7850.0),
        "silicon_nitride": (310e9, 0.26, 3200.0),
        "zirconia": (205e9, 0.30, 6050.0),
    }
    assert set(MATERIALS) == set(numbers)
    for name, want in numbers.items():
        got = MATERIALS[name]()
        fields = (got.elastic_modulus, got.poisson_ratio, got.density)
        assert tuple(map(float, fields)) == want


def test_contact_modulus():
    """Steel on steel 113187 MPa; two materials in series, in either order."""
    steel, ceramic = Material.steel(), Material.silicon_nitride()
    assert round(float(contact_modulus(steel, steel)) / 1e6) == 113187
    np.testing.assert_allclose(
        contact_modulus(steel, steel), STEEL_MODULUS, rtol=ROUNDING
    )
    want = 1.0 / ((1 - 0.3**2) / 206e9 + (1 - 0.26**2) / 310e9)
    for pair in ((steel, ceramic), (ceramic, steel)):
        np.testing.assert_allclose(contact_modulus(*pair), want, rtol=ROUNDING)


def test_derivative_of_the_contact_modulus():
    """Twice as stiff a pair for twice as stiff materials: E dE*/dE sums to E*."""
    got = jax.jit(jax.grad(lambda e: contact_modulus(Material(e), Material(e))))(
        jnp.asarray(206e9)
    )
    np.testing.assert_allclose(got, STEEL_MODULUS / 206e9, rtol=ROUNDING)


@pytest.mark.parametrize(
    "change, message",
    [
        ({"elastic_modulus": 0.0}, r"`elastic_modulus` is 0 Pa.*above 0 Pa"),
        ({"elastic_modulus": -206e9}, r"`elastic_modulus` is -2.06e\+11 Pa.*above 0"),
        ({"elastic_modulus": np.nan}, r"`elastic_modulus` is nan Pa.*finite"),
        ({"elastic_modulus": [2e11, 2e11]}, r"`elastic_modulus`.*shape \(2,\).*in Pa"),
        ({"poisson_ratio": 0.5}, r"`poisson_ratio` is 0.5; .*above -1 and below 0.5"),
        ({"poisson_ratio": 0.6}, r"`poisson_ratio` is 0.6; .*below 0.5"),
        ({"poisson_ratio": -1.0}, r"`poisson_ratio` is -1; .*above -1"),
        ({"density": -7850.0}, r"`density` is -7850 kg/m³.*above 0 kg/m³"),
        ({"density": np.inf}, r"`density` is inf kg/m³.*finite"),
    ],
)
def test_bad_materials(change, message):
    with pytest.raises(ValueError, match=r"Material: " + message):
        Material(**change)

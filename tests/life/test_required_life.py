"""A required life: what would keep it, against the formulas of ISO 281 inverted by
hand."""

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.life.life_factor import CLEANLINESS, Cleanliness
from bearingjax.life.required_life import judge_life
from bearingjax.studies.bearing.life_report import over_required

BALLS = bj.DeepGrooveBallBearing(
    7, 43.5e-3, 11.5e-3, inner_osculation=0.52, outer_osculation=0.53
)
ROLLERS = bj.CylindricalRollerBearing(18, 0.103535, 0.015, 0.017)
CLEAN = bj.LifeConditions(23400.0, viscosity=12e-6, contamination=0.4)
KAPPA, RATIO = 0.7, 0.6  # and C_u/P: κ stays between 0.4 and 1, where one formula holds


def one_part(kappa=(KAPPA,), ratio=(RATIO,)):
    shares = np.tile([[[0.3], [0.7]]], (len(kappa), 1, 1, 1))
    ratios = np.reshape(ratio, (-1, 1, 1))
    numbers = np.array(kappa), shares, ratios
    names = "viscosity_ratio", "damage_share", "limit_ratio"
    return dict(zip(names, numbers, strict=True))


def film(kappa):
    return (2.5671 - 1.9987 * kappa**-0.19087) ** 0.83


def a_iso(kappa, ratio):
    return 0.1 * (1.0 - film(kappa) * np.cbrt(ratio)) ** -9.3


@pytest.mark.parametrize("factor", [0.9, 1.0, 1.3])
def test_needed_conditions_of_one_part_invert_iso_281(factor):
    found = judge_life(BALLS, CLEAN, factor, 0.5 * factor, 2e4, one_part())
    now = a_iso(KAPPA, 0.4 * RATIO)
    assert found.factor == factor and found.kept == (factor >= 1.0)
    rest = (now / factor / 0.1) ** (-1 / 9.3)
    clean = ((1.0 - rest) / film(KAPPA)) ** 3 / RATIO
    assert found.contamination_factor == pytest.approx(clean, rel=1e-9)
    wanted = (1.0 - rest) / np.cbrt(0.4 * RATIO)
    kappa = ((2.5671 - wanted ** (1 / 0.83)) / 1.9987) ** (-1 / 0.19087)
    assert 0.4 < kappa < 1.0
    assert found.viscosity == pytest.approx(12e-6 * kappa / KAPPA, rel=1e-9)
    # L ~ C³ a_ISO, C_u in proportion.
    assert found.dynamic_capacity is not None
    times = found.dynamic_capacity / 2e4
    more = times**3 * a_iso(KAPPA, 0.4 * times * RATIO) / now
    assert more == pytest.approx(1.0 / factor, rel=1e-9)
    assert found.basic_capacity == pytest.approx(2e4 * (0.5 * factor) ** (-1 / 3))
    assert ("oil bath -/21/18" in found.cleanliness) is False
    assert all(name in CLEANLINESS for name in found.cleanliness)
    best = Cleanliness(*CLEANLINESS[found.cleanliness[0]]).factor(KAPPA, 43.5e-3)
    assert float(best) >= clean


def test_needed_conditions_that_do_not_exist():
    """a_ISO ends with κ at 4, e_C at 1: neither doubles this life; C does."""
    numbers = one_part(kappa=[3.9], ratio=[0.02])
    found = judge_life(BALLS, CLEAN, 0.1, 0.1, 2e4, numbers)
    assert found.viscosity is None and found.contamination_factor is None
    assert found.cleanliness == () and not found.kept
    assert found.dynamic_capacity is not None
    assert 2e4 < found.dynamic_capacity < 2e4 * 10 ** (1 / 3)
    # Of one kept by far, the least viscosity is that of κ = 0.1, and any dirt will do.
    found = judge_life(BALLS, CLEAN, 1e3, 1e3, 2e4, one_part())
    assert found.viscosity == pytest.approx(12e-6 * 0.1 / KAPPA)
    assert found.contamination_factor == 0.0


@pytest.mark.parametrize("bearing, power, basic", [(BALLS, 3, 3), (ROLLERS, 4, 10 / 3)])
def test_needed_capacity_without_a_lubricant(bearing, power, basic):
    numbers = one_part()
    del numbers["viscosity_ratio"]
    found = judge_life(bearing, bj.LifeConditions(), 0.5, 0.25, 1e4, numbers)
    assert found.dynamic_capacity == pytest.approx(1e4 * 2 ** (1 / power), rel=1e-9)
    assert found.basic_capacity == pytest.approx(1e4 * 4 ** (1 / basic), rel=1e-9)
    assert found.viscosity is None and found.cleanliness == ()


def test_needed_conditions_of_a_spectrum():
    """Two cases by their shares in the damage; one at rest, with κ = 0, has none."""
    share, kappa, ratio = [0.25, 0.75, 0.0], [0.7, 0.5, 0.0], [0.6, 0.3, 0.5]
    numbers = one_part(kappa, ratio)
    found = judge_life(BALLS, CLEAN, 0.8, 0.8, 2e4, numbers, np.array(share))
    clean = found.contamination_factor
    assert clean is not None
    less = [
        s * a_iso(k, 0.4 * x) / a_iso(k, clean * x)
        for s, k, x in zip(share[:2], kappa[:2], ratio[:2], strict=True)
    ]
    assert sum(less) == pytest.approx(0.8, rel=1e-9)


def test_verdict_without_damage_or_shares_has_a_factor_alone():
    assert judge_life(BALLS, CLEAN, np.inf, np.inf, 2e4, one_part()).kept
    found = judge_life(BALLS, CLEAN, 0.5, 0.5, 2e4, {})
    assert found.dynamic_capacity is None and not found.kept


def test_required_life_is_refused_in_two_units():
    with pytest.raises(ValueError, match="`required_revolutions` too; choose one"):
        bj.LifeConditions(required=2e4, required_revolutions=1e9)
    with pytest.raises(ValueError, match="`required`"):
        bj.LifeConditions(required=-1.0)
    assert bj.LifeConditions(required=2e4).requires
    assert not bj.LifeConditions(required=2e4).without_requirement.requires


def test_life_over_the_required_one():
    """In hours or revolutions; `None` without a requirement, or of hours at rest."""
    hours = bj.LifeConditions(required=2e4)
    turns = bj.LifeConditions(required_revolutions=1e9)
    assert over_required(hours, 5e3, 4e9) == pytest.approx(0.25)
    assert over_required(turns, 5e3, 4e9) == pytest.approx(4.0)
    for conditions, at in ((hours, None), (bj.LifeConditions(), 5e3), (None, 5e3)):
        assert over_required(conditions, at, 4e9) is None

"""A design with other numbers is otherwise the design that was given."""

import equinox as eqx
import jax
import numpy as np
import pytest
import registry

import bearingjax as bj
from bearingjax.optimise import design_numbers
from bearingjax.optimise.variable import with_numbers


def special():
    """Choices that no registered element has."""
    element, taper, ball = bj.BearingElement, registry.taper(), registry.balls()
    row = bj.SelfAligningBallRow(
        6, 0.052, 0.0095, inner_osculation=0.52, row_offset=0.006
    )
    drops = [2e-6, 0.0, 0.0, 3e-6]
    table = bj.Tabulated([-6e-3, -2e-3, 2e-3, 6e-3], drops)
    spring = bj.PreloadSpring(300.0, 1e6)
    return {
        "self-aligning": element(bj.BearingSet.self_aligning(row)),
        "spring": element(bj.BearingSet.back_to_back(ball, 0.02, spring=spring)),
        "coupled pair": element(
            bj.BearingSet.face_to_face(taper, 0.03), bj.contact.CoupledSlices(8)
        ),
        "all that a roller has": element(
            registry.taper(
                first_azimuth=0.3,
                outer_raceway_profile=table,
                material=bj.Material(200e9, 0.28, 7e3),
                ring_material=bj.Material(210e9),
            ),
            bj.contact.LineConstant(1e10),
            bj.element.Finite(),
            bj.numerics.Midpoint(7),
            bj.numerics.BFGS(),
            True,
        ),
        "all that a ball has": element(
            registry.balls(
                ball_deviation=np.linspace(0.0, 1e-6, 6),
                outer_shoulder=2e-3,
                inner_shoulder=1e-3,
            ),
            kinematics=bj.element.Finite(),
            equilibrium=bj.numerics.BFGS(),
            cage_torque=True,
            point_law=bj.contact.PointConstant(1e10, 2e10),
            raceway_control=bj.element.CentrifugalOnly(),
        ),
    }


def elements():
    rollers = {k: bj.BearingElement(b) for k, b in registry.bearings().items()}
    balls = {k: element for k, (element, _) in registry.ball_elements().items()}
    return rollers | balls | special()


@pytest.mark.parametrize("name", elements())
@pytest.mark.slow
def test_element_made_anew_is_the_same(name):
    element = elements()[name]
    numbers = design_numbers(element)
    assert len(numbers) >= 6
    for values in (numbers, {path: float(x) for path, x in numbers.items()}):
        assert eqx.tree_equal(with_numbers(element, values), element)
    for path, value in numbers.items():
        assert eqx.tree_equal(with_numbers(element, {path: value}), element), path


@pytest.mark.parametrize("name", elements())
def test_one_number_changes_alone_and_designs_stack(name):
    element = elements()[name]
    path, value = list(design_numbers(element).items())[-1]
    other = with_numbers(element, {path: 1.0001 * value})
    before, after = design_numbers(element), design_numbers(other)
    assert [p for p in before if before[p] != after[p]] == (
        [path] if value != 0 else []
    )
    assert jax.tree.structure(other) == jax.tree.structure(element)
    both = bj.stack_designs([element, other])
    for k, one in enumerate((element, other)):
        assert eqx.tree_equal(jax.tree.map(lambda leaf: leaf[k], both), one)  # noqa: B023

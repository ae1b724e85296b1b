"""Which errors make which line: by the kinematics, worked out by hand."""

import dataclasses

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.design.form_error import FormErrors, Harmonics, RacewayErrors, Spall
from bearingjax.noise import Line, NoiseModel, line_causes

DIFFERENT = [1e-6, 0.0, 0.0, -1e-6, 0.0, 0.0, 0.0]
BEARING = bj.DeepGrooveBallBearing(
    7, 0.04, 0.0103, outer_osculation=0.52, inner_osculation=0.52,
    ball_deviation=DIFFERENT,
)  # fmt: skip
ERRORS = FormErrors(
    RacewayErrors(outwards=Harmonics([7, 10], [1e-7, 1e-5])),
    RacewayErrors(axial=Harmonics([6, 14], [2e-7, 0.0]), raised=Spall(0.0, 1e-3, 1e-5)),
    Harmonics([2, 3], np.full((7, 2), 1e-8)),
)
MODEL = NoiseModel(
    bj.BearingElement(BEARING), 0.1, [0, 0, 50.0, 0, 0, 0],
    bj.Speed(inner=100.0 * np.pi), ERRORS,
)  # fmt: skip
RATIO = 0.0103 / 0.04  # contact angle 0
SHAFT, CAGE = 50.0, 0.5 * 50.0 * (1 - RATIO)
BPFO, BPFI, BSF = 7 * CAGE, 7 * (50.0 - CAGE), 0.5 * 50.0 * (1 - RATIO**2) / RATIO


def causes(*frequencies, model=MODEL):
    lines = [Line(f / SHAFT, f, 1.0, "") for f in frequencies]
    return line_causes(lines, model, 0.01)


def test_waves_shake_where_their_forces_are():
    outer, inner, element = causes(BPFO, BPFI - SHAFT, 2 * BSF)
    # The cage's seventh turn too, to which balls of other size come; the larger first.
    assert outer == (
        "differences of ball diameter",
        "waves of the outer raceway, order 7",
    )
    assert inner == (
        "spall of the inner raceway",
        "waves of the inner raceway, order 6",
    )
    assert element == ("waves of the rolling elements, order 2",)


def test_line_causes_exclude_balanced_and_absent_waves():
    # Order 10 of 7 balls balances, order 14 has no size, odd waves of balls cancel.
    assert causes(10 * CAGE + 1.0, 2 * BPFI + 0.1, 3 * BSF + 0.1, 17.0) == ((),) * 4


def test_a_load_across_is_passed_by_balls():
    across = dataclasses.replace(MODEL, load=MODEL.load.at[1].set(-10.0))
    (found,) = causes(2 * BPFO, model=across)
    assert found == ("differences of ball diameter", "balls passing the load")


@pytest.mark.parametrize("k", [1, 2])
def test_a_spall_on_a_ball_meets_both_raceways(k):
    pit = Spall(np.zeros(7), np.full(7, 1e-3), np.eye(7)[0] * 1e-5)
    model = dataclasses.replace(MODEL, errors=FormErrors(elements=pit))
    found = causes(2 * k * BSF, 2 * k * BSF - CAGE, model=model)
    assert found == (("spall of a rolling element",),) * 2

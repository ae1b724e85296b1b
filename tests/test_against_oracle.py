"""The package against a plain NumPy bearing that shares no code with it.

Same slices, both sides polished to round-off. Forces are compared relative to the
largest force (moment) of the bearing; stiffness entries relative to
sqrt(K_ii K_jj), with a floor at round-off of the largest, because entries of directions
that nothing holds are exactly zero in one code and round-off in the other.
"""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import oracle
import pytest
from from_oracle import bearing
from tolerances import QUADRATURE_FORCE, QUADRATURE_STIFFNESS, ROUNDING, SOLVER

import bearingjax as bj

SLICES = 20
ROLLERS = 5  # fewer than drawn: one compilation per kind and profile


@eqx.filter_jit
def evaluate(element, q):
    model = element.model()
    solved = model.solve(q)
    return model.evaluate(q, solved), model.results(q, solved)[0]


def case(seed):
    _, q, info = oracle.random_case(seed)
    info = {**info, "n_rollers": min(info["n_rollers"], ROLLERS)}
    return oracle.build(info), q, info


def element(info, quadrature, uniform=True):
    law = bj.contact.LineConstant(info["line_constant"])
    return bj.BearingElement(
        bearing(info, uniform), line_law=law, quadrature=quadrature
    )


def errors(got, want):
    """Largest scaled error of force and of stiffness."""
    f, k = np.asarray(got.force), np.asarray(got.stiffness)
    kind = np.tile(np.repeat([0, 1], 3), 2)
    force = max(
        np.abs(f - want["force"])[kind == i].max()
        / np.abs(want["force"])[kind == i].max()
        for i in (0, 1)
    )
    diagonal = np.sqrt(np.maximum(np.diag(want["stiffness"]), 0.0))
    largest = np.array([diagonal[kind == i].max() for i in (0, 1)])[kind]
    # 1e-12 of the largest entry (tether spring, round-off), in units of the tolerance.
    floor = ROUNDING / SOLVER * np.outer(largest, largest)
    scale = np.outer(diagonal, diagonal) + floor
    return force, (np.abs(k - want["stiffness"]) / scale).max()


@pytest.mark.parametrize("start", range(0, 200, 40))
@pytest.mark.slow
def test_200_random_bearings(start):
    for seed in range(start, start + 40):
        truth, q, info = case(seed)
        slices = oracle.midpoint_slices(truth.roller_length, SLICES)
        want = oracle.evaluate(truth, q, (slices, slices))
        got, solved = evaluate(
            element(info, bj.numerics.Midpoint(SLICES)), jnp.asarray(q)
        )
        assert int(got.result) == bj.Result.CONVERGED, seed
        if not np.any(want["roller_load"] > 0):
            assert np.abs(np.asarray(got.force)).max() < SOLVER, seed
            continue
        force, stiffness = errors(got, want)
        assert force < SOLVER, (seed, force)
        assert stiffness < SOLVER, (seed, stiffness)
        load = np.asarray(solved.contact_load[:, :2])
        scale = want["roller_load"].max()
        assert np.abs(load - want["roller_load"]).max() < SOLVER * scale, seed


@pytest.mark.parametrize("seed", [0, 3, 4, 8, 11, 21])
def test_absent_parts_are_the_same_bearing(seed):
    """Absent ribs and straight raceways themselves, not their stand-ins."""
    truth, q, info = case(seed)
    slices = oracle.midpoint_slices(truth.roller_length, SLICES)
    want = oracle.evaluate(truth, q, (slices, slices))
    got, _ = evaluate(
        element(info, bj.numerics.Midpoint(SLICES), False), jnp.asarray(q)
    )
    force, stiffness = errors(got, want)
    assert force < SOLVER and stiffness < SOLVER


@pytest.mark.parametrize("start", range(0, 24, 8))
@pytest.mark.slow
def test_contact_mapped_quadrature_against_graded_reference(start):
    """32 points per panel against 200 graded nodes on each bisected interval."""
    for seed in range(start, start + 8):
        truth, q, info = case(seed)
        want = oracle.evaluate(truth, q, oracle.graded(truth))
        got, _ = evaluate(element(info, bj.numerics.ContactMapped(32)), jnp.asarray(q))
        if not np.any(want["roller_load"] > 0):
            continue
        force, stiffness = errors(got, want)
        assert force < QUADRATURE_FORCE, (seed, force)
        assert stiffness < QUADRATURE_STIFFNESS, (seed, stiffness)

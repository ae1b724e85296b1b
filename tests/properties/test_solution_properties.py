"""Load solves and lives: symmetry, scaling by loads, and what shortens a life."""

import functools

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from holds_for import holds_for, reals
from hypothesis import assume
from hypothesis import strategies as st
from registry import grooves
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.lubrication import iso_vg

N = 9


def ball(clearance, first):
    """Deep groove ball bearing of nine balls."""
    bearing = bj.DeepGrooveBallBearing(
        N,
        43.5e-3,
        9e-3,
        radial_internal_clearance=clearance,
        first_azimuth=first,
        **grooves(0.53, 0.52),
    )
    return bj.BearingElement(bearing, point_law=bj.contact.ZeroAngle())


def roller(clearance, first):
    """Cylindrical roller bearing of nine straight rollers, without ribs."""
    bearing = bj.CylindricalRollerBearing(
        N,
        0.065,
        0.010,
        0.010,
        radial_internal_clearance=clearance,
        first_azimuth=first,
    )
    return bj.BearingElement(bearing, quadrature=bj.numerics.ContactMapped(16))


DESIGNS = {"ball": ball, "roller": roller}
EXPONENT = {"ball": 2 / 3, "roller": 9 / 10}
LIFE_EXPONENTS = {"ball": (3, 3), "roller": (10 / 3, 4)}
"""Of the basic and of the reference life over the load."""
BOTH = frozenset(DESIGNS)
OIL = {"temperature": 340.0, "dirt": 0.5, "reliability": 0.9}


@eqx.filter_jit
def _solved(design, fixed_ring, clearance, first, load, tilt, oil):
    element = design(clearance, first)
    zero = jnp.zeros(())
    sign = 1.0 if fixed_ring == "outer" else -1.0
    radial = jnp.concatenate([sign * load, jnp.zeros(3)])
    prescribed = {"gx": sign * tilt[0], "gy": sign * tilt[1]}
    if design is roller:
        prescribed["uz"] = zero
    solution = bj.solve_load(
        element,
        radial,
        support=bj.Support(prescribed=prescribed, fixed_ring=fixed_ring),
        speed=None,
        throw=False,
    )
    life = bj.rating_life(
        element,
        solution,
        conditions=bj.LifeConditions(
            viscosity=iso_vg(46.0).kinematic_viscosity(oil["temperature"]),
            contamination=oil["dirt"],
            reliability=oil["reliability"],
        ),
        speed=bj.Speed(inner=150.0),
    )
    return solution, life


def solved(
    design, load, tilt=(0.0, 0.0), clearance=0.0, first=0.0, ring="outer", **oil
):
    """Solution and life under a load (Fx, Fy, Fz) and given tilts, in NumPy."""
    load = np.array(load) * (1.0, 1.0, 0.0 if design is roller else 1.0)
    given = jax.tree.map(
        jnp.asarray, (clearance, first, load, np.array(tilt), OIL | oil)
    )
    found = _solved(design, ring, *given)
    assume(int(found[0].result) == bj.Result.CONVERGED)
    # On one element alone the ring is free to move to its sides.
    assume(np.sum(found[0].roller_load[:, 0] > 0) > 1)
    return jax.tree.map(np.asarray, eqx.filter(found, eqx.is_array))


def lives(life):
    return np.stack(
        [
            life.basic_rating_life,
            life.reference_rating_life,
            life.modified_rating_life,
            life.life_hours,
        ]
    )


def turned(vectors, angle):
    """Vectors in space after a turn about z (..., 3)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(vectors) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])


def close(value, wanted, tolerance=SOLVER, least=0.0):
    """Whether arrays agree, within a share of the largest number."""
    return np.abs(value - wanted).max() <= tolerance * np.abs(wanted).max() + least


def loads():
    """Radial loads of any direction, and axial ones, either way [N]."""
    return st.builds(
        lambda size, angle, axial: (
            size * np.cos(angle),
            size * np.sin(angle),
            size * axial,
        ),
        reals(100, 8000),
        reals(-4, 4),
        reals(-0.8, 0.8),
    )


ANY = {
    "load": loads(),
    "tilt": st.tuples(reals(-1e-3, 1e-3), reals(-1e-3, 1e-3)),
    "clearance": reals(-5e-6, 30e-6),
}
of_both = functools.partial(holds_for, DESIGNS, BOTH)


@of_both(pitches=st.integers(-4, 4), **ANY)
def test_turn_of_load_by_pitches_turns_answer(design, pitches, load, tilt, clearance):
    angle = 2 * np.pi * pitches / N
    solution, life = solved(design, load, tilt, clearance)
    other, other_life = solved(
        design, turned(load, angle), turned((*tilt, 0.0), angle)[:2], clearance
    )
    motion = turned(solution.displacement[6:].reshape(2, 3), angle).ravel()
    assert close(other.displacement[6:9], motion[:3])
    assert close(other.roller_load, np.roll(solution.roller_load, pitches, axis=0))
    assert close(other.force[6:9], turned(solution.force[6:9], angle))
    assert close(other.force[9:], turned(solution.force[9:], angle), least=1e-9)
    assert np.allclose(lives(other_life), lives(life), rtol=SOLVER)


@of_both(**ANY)
def test_mirror_of_load_mirrors_answer(design, load, tilt, clearance):
    """Across the plane y = 0, in which the first rolling element stands."""
    solution, life = solved(design, load, tilt, clearance)
    across = load * np.array([1.0, -1.0, 1.0])
    other, other_life = solved(design, across, (-tilt[0], tilt[1]), clearance)
    sign = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    assert close(other.displacement[6:9], (sign * solution.displacement[6:])[:3])
    assert close(other.force[6:], sign * solution.force[6:])
    places = -np.arange(N) % N
    assert close(other.roller_load, solution.roller_load[places])
    assert np.allclose(lives(other_life), lives(life), rtol=SOLVER)


@of_both(**ANY)
def test_action_is_reaction(design, load, tilt, clearance):
    """The rings press on each other as the load asks; no inertia at rest."""
    solution, _ = solved(design, load, tilt, clearance)
    size = np.abs(load).max()
    assert np.abs(solution.force[:6] + solution.force[6:]).max() < ROUNDING * size
    load = np.array(load) * (1.0, 1.0, 0.0 if design is roller else 1.0)
    assert close(solution.force[6:9], load)


@of_both(factor=reals(1e-2, 1e2), load=loads())
def test_loads_scale_at_zero_clearance(design, factor, load):
    """Hertz: motion as F^(2/3) where a radial load keeps contacts radial; line contacts
    as F^(9/10)."""
    load = np.array(load) * (1.0, 1.0, 0.0)
    (one, life), (other, other_life) = (
        solved(design, size * load) for size in (1.0, factor)
    )
    power = EXPONENT[design.__name__]
    assert close(other.displacement[6:8], factor**power * one.displacement[6:8])
    assert close(other.roller_load, factor * one.roller_load)
    shorter = factor ** -np.array(LIFE_EXPONENTS[design.__name__])
    assert np.allclose(lives(other_life)[:2], shorter * lives(life)[:2], rtol=SOLVER)


@of_both(
    factor=reals(1, 3),
    warmer=reals(0, 40),
    dirtier=reals(0, 1),
    surer=reals(0, 1),
    oil=st.fixed_dictionaries(
        {"temperature": reals(290, 380), "dirt": reals(0.05, 1.0)}
    ),
    load=loads(),
    clearance=reals(0, 30e-6),
)
def test_load_heat_dirt_and_reliability_shorten_lives(
    design, factor, warmer, dirtier, surer, oil, load, clearance
):
    at = functools.partial(solved, design, clearance=clearance)
    before = lives(at(load, **oil)[1]) * (1 + SOLVER)
    assert np.all(lives(at(factor * np.array(load), **oil)[1]) <= before)
    warm = oil | {"temperature": oil["temperature"] + warmer}
    dirty = oil | {"dirt": oil["dirt"] * (1.0 - 0.9 * dirtier)}
    sure = oil | {"reliability": 0.9 + 0.0999 * surer}
    for worse in (warm, dirty, sure):
        assert np.all(lives(at(load, **worse)[1]) <= before)


@holds_for(DESIGNS, **ANY)
def test_load_on_the_other_ring_moves_it_the_other_way(design, load, tilt, clearance):
    inner, _ = solved(design, load, tilt, clearance)
    outer, _ = solved(design, load, tilt, clearance, ring="inner")
    assert close(outer.displacement[:6], -inner.displacement[6:])
    assert close(outer.force, inner.force)
    assert close(outer.roller_load, inner.roller_load)

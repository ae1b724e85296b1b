"""Static equilibrium of rotors in their bearings, and linear analyses about it."""

import re

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from machines import bearing, stepped
from tolerances import DIFFERENCE, SOLVER
from vibrations import OUTER

import bearingjax as bj

STEEL = bj.Material(2.1e11, 0.3, 7850.0)
WEIGHT = bj.rotor.RotorLoads(gravity=(0.0, -9.80665, 0.0))
ELEMENT = bj.BearingElement(bearing(23.855, OUTER[26]))


def opposed(offset=14e-6, diameter=0.025, load=WEIGHT, inertia=False):
    """The rotor of method 002 on two true bearings of 26°, pressed together."""
    shaft = bj.rotor.Shaft([0.0, 0.125, 0.5], diameter, material=STEEL, divisions=2)
    at = jnp.zeros(5).at[2].set(offset)
    supports = [
        bj.rotor.BearingSupport(k, ELEMENT, at, turned=k > 0, inertia=inertia)
        for k in (0, 2)
    ]
    return bj.rotor.Rotor(shaft, bj.rotor.Disc(1, 10.0, 0.2, 0.1), supports), load


def test_static_equilibrium_on_springs():
    """On springs it is what the whole stiffness matrix says."""
    rotor = stepped()
    loads = bj.rotor.RotorLoads(
        gravity=(1.0, -9.8, 2.0), forces=bj.rotor.StationForce(1, [10, 20, 5, 0.1, 0.2])
    )
    found = bj.rotor.static_equilibrium(rotor, loads)
    wanted = np.linalg.solve(rotor.linearise().stiffness, loads.constant(rotor))
    np.testing.assert_allclose(found.motion, wanted, atol=1e-11 * np.abs(wanted).max())
    assert not np.asarray(found.free).any()
    total = 9.8 * (rotor.mass + 4.0) - 20.0
    housing = 0.7 * 5e7 * found.housing[0, 1]
    np.testing.assert_allclose(found.support_load[0, 1] + housing, -total, rtol=SOLVER)


def test_weight_and_preload():
    """Loads balance weight and each other; the place is one of no left-over force."""
    rotor, loads = opposed()
    found = bj.rotor.static_equilibrium(rotor, loads)
    load, weight = np.asarray(found.support_load), 9.80665 * float(rotor.mass)
    np.testing.assert_allclose(load.sum(axis=0)[[1, 2]], [-weight, 0], atol=1e-8)
    # Moments about x at z = 0: -y-force times arm, and what the bearings hold.
    arm = 9.80665 * (10.0 * 0.125 + float(rotor.shaft.mass) * 0.25)
    moments = load[:, 3].sum() - 0.5 * load[1, 1]
    np.testing.assert_allclose(moments, arm, rtol=1e-9)
    assert 400.0 < load[0, 2] < 600.0
    # The linear rotor stands for the true one there.
    matrices = found.rotor.linearise()
    wanted = rotor.linearise(0.0, found.motion)
    scale = np.abs(wanted.stiffness).max()
    np.testing.assert_allclose(matrices.stiffness, wanted.stiffness, atol=1e-12 * scale)


@pytest.mark.slow
def test_derivatives():
    """Of place, load and stiffness, by preload and by diameter."""

    def numbers(x):
        rotor, loads = opposed(1e-6 * x[0], 1e-3 * x[1])
        found = bj.rotor.static_equilibrium(rotor, loads, throw=False)
        return jnp.stack(
            [
                1e6 * found.displacement[1, 1],
                1e-2 * found.support_load[0, 2],
                1e-8 * found.stiffness[1, 0, 0],
            ]
        )

    x = jnp.array([14.0, 25.0])
    slopes = jax.jacrev(numbers)(x)
    best = np.full(slopes.shape, np.inf)
    for step in (1e-3, 1e-4):
        ends = [
            np.stack([numbers(x + s * step * e) for e in np.eye(2)], axis=1)
            for s in (1.0, -1.0)
        ]
        error = np.abs((ends[0] - ends[1]) / (2.0 * step) - slopes)
        best = np.minimum(best, error)
    # Neither bearing is idle, nor does it lose its preload.
    assert bj.rotor.static_equilibrium(*opposed(14e-6, 25e-3)).warnings == ()
    assert (best < DIFFERENCE * np.abs(slopes).max(axis=1)[:, None]).all()


@pytest.mark.slow
def test_static_equilibrium_over_speed():
    """Where balls feel the speed, the rotor over speeds is the one settled at each."""
    rotor, loads = opposed(inertia=True)
    over = bj.rotor.static_equilibrium_over(rotor, loads, 1000.0)
    assert float(over.error) < 1e-7
    there, rest = (
        bj.rotor.static_equilibrium(rotor, loads, speed) for speed in (800.0, 0.0)
    )
    wanted = there.rotor.linearise().stiffness
    scale = np.abs(wanted).max()
    found = over.rotor.linearise(800.0).stiffness
    np.testing.assert_allclose(found, wanted, atol=1e-8 * scale)
    other = rest.rotor.linearise().stiffness
    assert np.abs(other - wanted).max() > 1e-5 * scale
    # The same number under trace, where all places go through one program.
    error = jax.jit(
        lambda top: (
            bj.rotor.static_equilibrium_over(rotor, loads, top, throw=False).error
        )
    )
    np.testing.assert_allclose(error(1000.0), over.error, rtol=1e-3)
    # Outside, the ends hold.
    ends = [over.rotor.linearise(speed).stiffness for speed in (1000.0, 2000.0)]
    np.testing.assert_array_equal(*ends)


def test_static_equilibrium_without_load_path():
    """A load that nothing takes up, and a bearing that bears nothing, are said."""
    rotor, _ = opposed()
    rollers = bj.rotor.Rotor(
        rotor.shaft,
        rotor.discs,
        [bj.rotor.LinearSupport.isotropic(k, 1e8) for k in (0, 2)],
    )
    upright = bj.rotor.RotorLoads(gravity=(0.0, 0.0, -9.80665))
    with pytest.raises(bj.SolveError, match="no_load_path.*along uz of station"):
        bj.rotor.static_equilibrium(rollers, upright)
    failed = bj.rotor.static_equilibrium(rollers, upright, throw=False)
    assert int(failed.result) == bj.Result.NO_LOAD_PATH
    assert np.isnan(failed.motion).all() and np.isnan(failed.stiffness).all()
    assert "along uz of station" in failed.failure_message
    assert failed.warnings == ()
    idle, _ = opposed(-5e-6)
    found = bj.rotor.static_equilibrium(idle)
    assert found.failure_message == ""
    texts = bj.warnings(found)
    assert [one.kind for one in texts] == ["idle_bearing", "free_motion"]
    assert "station 0, 2 bears nothing" in texts[0] and "nothing holds" in texts[1]


@pytest.mark.slow
def test_static_equilibrium_warns_of_lost_preload():
    """Two bearings that face the same way push the shaft until neither presses."""
    rotor, loads = opposed(bj.rotor.preload_offset(ELEMENT, 200.0))
    shoved = bj.rotor.RotorLoads(
        forces=bj.rotor.StationForce(1, [0.0, 0.0, 3000.0, 0.0, 0.0])
    )
    alike = eqx.tree_at(lambda r: r.supports[1].turned, rotor, replace_fn=lambda t: ~t)
    both = "station 0 is preloaded by 200 N .* keeps 0 N; the bearing on station 2"
    for one, load, words in (
        (alike, loads, f"{both}.*no other bearing presses back"),
        (rotor, shoved, "station 2 is preloaded by 200 N .* is more than the preload"),
    ):
        texts = bj.rotor.static_equilibrium(one, load).warnings
        assert any(re.search(words, text) for text in texts), texts
    assert bj.rotor.static_equilibrium(rotor, loads).warnings == ()


def test_static_equilibrium_with_clearance():
    """Bearings with clearance take up the weight where they meet it."""
    rotor, loads = opposed(-5e-6, 0.05)
    found = bj.rotor.static_equilibrium(rotor, loads)
    load, weight = np.asarray(found.support_load), 9.80665 * float(rotor.mass)
    np.testing.assert_allclose(load[:, 1].sum(), -weight, rtol=1e-10)
    assert float(found.displacement[0, 1]) < -5e-6


@pytest.mark.parametrize(
    "make, error, message",
    [
        (
            lambda r: bj.rotor.static_equilibrium(r.shaft),
            TypeError,
            "`rotor` is a Shaft",
        ),
        (
            lambda r: bj.rotor.static_equilibrium(r, bj.rotor.Unbalance(1, 1e-5)),
            TypeError,
            "`loads` is a Unba",
        ),
        (
            lambda r: bj.rotor.static_equilibrium(bj.rotor.Rotor(r.shaft)),
            ValueError,
            "no supports",
        ),
        (
            lambda r: bj.rotor.static_equilibrium(
                r, bj.rotor.RotorLoads(forces=bj.rotor.StationForce(7, [0.0] * 5))
            ),
            ValueError,
            "on station 7; the last station of the shaft is 2",
        ),
        (lambda r: bj.rotor.static_equilibrium(r, speed=np.nan), ValueError, "`speed`"),
        (
            lambda r: bj.rotor.RotorLoads(gravity=9.81),
            ValueError,
            r"`gravity` has shape \(\)",
        ),
        (lambda r: bj.rotor.RotorLoads(unbalances=[3.0]), TypeError, "hold Unbalances"),
        (
            lambda r: bj.rotor.StationForce(1, [1.0, 2.0]),
            ValueError,
            "`force` has shape",
        ),
        (lambda r: bj.rotor.StationForce(1, [np.inf] * 5), ValueError, "finite"),
        (
            lambda r: bj.rotor.static_equilibrium_over(r, None, 0.0),
            ValueError,
            "`top_speed`",
        ),
        (
            lambda r: bj.rotor.static_equilibrium_over(r, None, 1.0, places=2),
            ValueError,
            "`places`",
        ),
    ],
)
def test_bad_input(make, error, message):
    rotor, _ = opposed()
    with pytest.raises(error, match=message):
        make(rotor)


def test_polynomials_of_the_speed():
    """Stiffness over speed and its slope, mapped over speeds in one program."""
    rng = np.random.default_rng(0)
    series = rng.standard_normal((13, 5, 5))
    support = bj.rotor.SpeedSupport(0, series, np.zeros(5), 100.0)
    known = jnp.array([True, True, True])

    def stiffness(speed):
        return support.linearise(jnp.zeros(5), speed)[0]

    @jax.jit
    def both(speeds, known):
        speeds = jnp.where(known, speeds, 1.0)
        return jax.vmap(stiffness)(speeds), jax.vmap(jax.jacfwd(stiffness))(speeds)

    speeds = np.array([10.0, 52.0, 98.0])
    value, slope = both(jnp.asarray(speeds), known)
    np.testing.assert_array_equal(both(-jnp.asarray(speeds), known)[0], value)
    share = 2.0 * speeds / 100.0 - 1.0
    chebyshev = np.polynomial.chebyshev
    wanted = np.moveaxis(chebyshev.chebval(share, series), -1, 0)
    np.testing.assert_allclose(value, wanted, atol=1e-11)
    wanted = np.moveaxis(chebyshev.chebval(share, chebyshev.chebder(series)), -1, 0)
    np.testing.assert_allclose(slope, 0.02 * wanted, atol=1e-10)

"""Forces of balls written out for a row, against derivatives of each ball's energy."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

import bearingjax as bj
from bearingjax.noise import NoiseModel
from bearingjax.noise.dynamics import system as equations
from bearingjax.noise.dynamics.element_positions import ElementPositions

BALLS = 5
MODEL = NoiseModel(
    bj.BearingElement(
        bj.FourPointBallBearing(
            BALLS, 0.0775, 0.014288, outer_osculation=0.52, inner_osculation=0.53,
            shim_angle=0.4, radial_internal_clearance=4e-5,
            ball_deviation=1e-6 * np.arange(BALLS),
        )
    ),
    0.37, [0.0, -25.0, 85.0, 0.0, 0.0, 0.0], bj.Speed(inner=150.0),
    tilting_inertia=1e-3,
)  # fmt: skip


def test_forces_of_balls_are_derivatives_of_their_energy(monkeypatch):
    """Their own derivatives too, from which the damping follows."""
    system = MODEL.system(8)

    def own(system):
        ball = system.row.element.element
        return ball.grooves.start, ball.grooves.reach, ball.constant

    rng = np.random.default_rng(1)
    motion = 2e-5 * rng.standard_normal(5 + 2 * BALLS)
    motion[3:5] *= 10.0
    # One ball beyond the centres of its grooves, outwards and along the axis.
    motion[5], motion[5 + BALLS] = 3e-4, -6e-4
    deviations = 5e-6 * rng.standard_normal((BALLS, 2, 3))
    azimuth = 2 * np.pi / BALLS * np.arange(BALLS) + 0.3
    at = own(system), jnp.asarray(motion), jnp.asarray(azimuth), jnp.asarray(deviations)

    def resistance(numbers, motion, azimuth, deviations):
        moved = eqx.tree_at(own, system, numbers)
        return moved.resistance(
            motion, ElementPositions.from_azimuth(azimuth).with_deviations(deviations)
        )

    change = jax.tree.map(
        lambda x: jnp.asarray(np.asarray(x) * rng.uniform(-1.0, 1.0, np.shape(x))), at
    )
    found = []
    for written_out in (True, False):
        monkeypatch.setattr(equations, "is_written_out", lambda _, w=written_out: w)
        found.append(jax.jit(lambda a, c: jax.jvp(resistance, a, c))(at, change))
    for one, other in zip(*found, strict=True):
        one, other = np.asarray(one), np.asarray(other)
        assert np.count_nonzero(np.abs(other) > 1e-3 * np.abs(other).max()) > BALLS
        # Round-off of groove against ball radius, in approaches of 1e-5 of both.
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())

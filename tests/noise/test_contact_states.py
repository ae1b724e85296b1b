"""Contacts of rolling elements, counted by hand."""

import jax.numpy as jnp
import numpy as np

from bearingjax.noise import Vibration, contact_states


def test_states_and_switches_of_two_elements():
    load = np.zeros((4, 2, 4))
    load[:, 0, :2] = 10.0  # in two contacts all the time
    load[1, 0, 2:] = 1.0  # once in four
    load[2:, 1, 0] = 5.0, 1e-12  # comes into one, and is as good as out again
    record = Vibration(
        time=jnp.arange(4.0),
        displacement=jnp.zeros((4, 3)),
        acceleration=jnp.zeros((4, 3)),
        contact_load=jnp.asarray(load),
        azimuth=jnp.zeros((4, 2)),
        shaft_frequency=jnp.asarray(0.5),
        result=jnp.asarray(0, jnp.int32),
        turns=2,
    )
    found = contact_states(record)
    assert found.number.tolist() == [[2, 0], [4, 0], [2, 1], [2, 0]]
    assert found.samples.tolist() == [3, 1, 3, 0, 1]
    # Two open, two close; one comes and goes; over two turns.
    assert found.switches_per_turn == 3.0
    assert found.shares.sum() == 1.0

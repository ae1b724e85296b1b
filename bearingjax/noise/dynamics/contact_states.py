"""Number of contacts of every rolling element, and how often it changes."""

from typing import Any, NamedTuple

import numpy as np

from ..vibration import Vibration

OPEN = 1e-9
"""Largest relative load of an open contact [1]."""


class ContactStates(NamedTuple):
    """Contacts of the rolling elements over a record.

    Attributes:
        number: Number of closed contacts (time, element).
        samples: Number of samples of all elements with 0, 1, 2, … contacts, up to as
            many as an element can have (number,).
        switches_per_turn: Contacts that open or close, of all elements, from one
            sample to the next, per turn of the shaft.
    """

    number: np.ndarray
    samples: np.ndarray
    switches_per_turn: float

    @property
    def shares(self) -> np.ndarray:
        """Share of each number of contacts in all samples (number,) [1]."""
        return self.samples / self.samples.sum()


def contact_states(record: Vibration) -> ContactStates:
    """Return which contacts of a record are closed.

    A four-point ball has up to four contacts, other balls and rollers two. A contact
    that opens and closes between two samples is missed.

    Args:
        record: From `vibration`; concrete.
    """
    load: Any = np.asarray(record.contact_load)
    closed = load > OPEN * load.max(initial=0.0)
    number = closed.sum(axis=-1)
    samples = np.bincount(number.ravel(), minlength=load.shape[-1] + 1)
    switches = np.count_nonzero(closed[1:] != closed[:-1])
    return ContactStates(number, samples, switches / record.turns)

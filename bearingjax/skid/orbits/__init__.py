"""Steady states, found without integrating in time."""

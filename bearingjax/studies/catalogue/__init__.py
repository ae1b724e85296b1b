"""The catalogue, and new scenes from it."""

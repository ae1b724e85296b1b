"""Decisions: numbers from measurements, the effect of tolerances, a choice of bearing.

Names
-----

"""

__all__ = []

"""Stations of a shaft as scenes name them."""

from ..rotor import Shaft
from .table import Table


def read_station(table: Table, shaft: Shaft, default: int | None = None) -> int:
    """Number of a station of the shaft.

    Args:
        table: In which `station` stands.
        shaft: The shaft.
        default: If absent; `None`: it must be given.
    """
    given = () if default is None else (default,)
    station = table.integer("station", *given, least=0)
    if station > shaft.n_segments:
        problem = f"{station} is not a station of the shaft; from 0 to"
        raise table.error("station", f"{problem} {shaft.n_segments}")
    return station

"""What the scene of a rotor asks for beyond modes: Campbell, response, transient."""

import warnings

import numpy as np

from ..element.frame import FREEDOMS
from ..rotor import RotorLoads, Shaft
from .rotor_scene import ResponseTask, TransientTask
from .stations import read_station
from .table import Table

METHODS = ("linear", "harmonic_balance", "shooting")
_FOR = {
    "harmonics": ("harmonic_balance",),
    "samples": ("harmonic_balance",),
    "steps": ("harmonic_balance", "shooting"),
    "scale": ("harmonic_balance", "shooting"),
    "reduction": ("harmonic_balance", "shooting"),
}
"""Methods that have a use for a key."""
MOST_SPEEDS, MOST_POINTS, MOST_SAMPLES, MOST_TIMES = 2000, 5000, 1024, 20_000


def read_campbell(rotor: Table) -> np.ndarray | None:
    """Speeds of the Campbell diagram [rad/s], or `None` if none is asked for.

    Args:
        rotor: The [rotor] table.
    """
    if "campbell" not in rotor:
        return None
    table = rotor.table("campbell")
    begin = table.quantity("from", "speed", 0.0)
    end = table.quantity("to", "speed")
    if not end > begin:
        raise table.error("to", f"{end:g} rad/s is not above `from`, {begin:g} rad/s")
    count = _at_most(table, "count", 31, 2, MOST_SPEEDS)
    return np.linspace(begin, end, count)


def _at_most(table: Table, key: str, default: int, least: int, most: int) -> int:
    value = table.integer(key, default, least=least)
    if value > most:
        raise table.error(key, f"{value} is too many; at most {most}")
    return value


def read_response(
    rotor: Table, shaft: Shaft, loads: RotorLoads, shown: int
) -> ResponseTask | None:
    """The response that is asked for, or `None`.

    Args:
        rotor: The [rotor] table.
        shaft: The shaft.
        loads: What acts on the rotor.
        shown: Station that is shown unless the table says another.
    """
    if "response" not in rotor:
        return None
    table = rotor.table("response")
    if not loads.unbalances and not np.any(np.asarray(loads.base_acceleration)):
        excitation = rotor.table("excitation")
        problem = "is missing, and so is `base_acceleration`; nothing excites the rotor"
        raise excitation.error("unbalance", problem)
    begin, end = (table.quantity(key, "frequency") for key in ("from", "to"))
    for key, value in (("from", begin), ("to", end)):
        if not value > 0.0:
            raise table.error(key, f"{value:g} rad/s is not allowed; above 0")
    if begin == end:
        raise table.error("to", f"{end:g} rad/s is `from` itself; give a range")
    method = table.choice("method", METHODS, "harmonic_balance")
    for key, users in _FOR.items():
        if key in table and method not in users:
            raise table.error(key, f"goes with `method` = {' or '.join(users)}")
    harmonics = _at_most(table, "harmonics", 7, 1, MOST_SAMPLES // 4)
    samples = _at_most(table, "samples", max(64, 4 * harmonics), 4, MOST_SAMPLES)
    if samples <= 2 * harmonics:
        problem = f"{samples} is not allowed; above twice `harmonics`, {2 * harmonics}"
        raise table.error("samples", problem)
    scale = table.quantity("scale", "length", None)
    if scale is not None and not scale > 0.0:
        raise table.error("scale", f"{scale:g} m is not allowed; above 0 m")
    for key, users in _FOR.items():
        if method not in users:
            table.fill(key, None)
    linear, speed = method == "linear", table.quantity("speed", "speed", None)
    if speed is not None and loads.unbalances:
        warnings.warn(
            "`rotor.response.speed` is fixed, so that its unbalance turns at another"
            " speed, that of the excitation",
            stacklevel=2,
        )
    if speed is None and rotor.quantity("speed", "speed", 0.0) < 0.0:
        warnings.warn(
            "`rotor.speed` is negative, but in the response the rotor turns with its"
            " excitation, from x towards y; give `rotor.response.speed` for the other"
            " sense",
            stacklevel=2,
        )
    return ResponseTask(
        begin=begin,
        end=end,
        method=method,
        harmonics=harmonics,
        samples=samples,
        steps=_at_most(table, "steps", 48, 8, MOST_SAMPLES),
        points=_at_most(table, "points", 201 if linear else 500, 2, MOST_POINTS),
        speed=speed,
        reduction=_reduction(rotor, table),
        scale=scale,
        station=read_station(table, shaft, shown),
        coordinate=table.choice("coordinate", FREEDOMS[:5], "uy"),
    )


def _reduction(rotor: Table, table: Table) -> int | None:
    modes = table.integer("reduction", None, least=0)
    if modes is not None and rotor.flag("rigid", False):
        raise table.error("reduction", "is for a shaft that bends, not a `rigid` one")
    return modes


def read_transient(rotor: Table, shaft: Shaft, shown: int) -> TransientTask | None:
    """The motion in time that is asked for, or `None`.

    Args:
        rotor, shaft, shown: As of `read_response`.
    """
    if "transient" not in rotor:
        return None
    table = rotor.table("transient")
    duration = table.quantity("duration", "time")
    if not 0.0 < duration <= 1e4:
        problem = f"{duration:g} s is not allowed; above 0 and at most 10000 s"
        raise table.error("duration", problem)
    speed_to = table.quantity("speed_to", "speed", None)
    speed = rotor.quantity("speed", "speed", 0.0)
    for place, key, value in ((rotor, "speed", speed), (table, "speed_to", speed_to)):
        if value is not None and value < 0.0:
            problem = f"{value:g} rad/s is not allowed with a motion in time; 0 or more"
            raise place.error(key, problem)
    tolerance = table.number("tolerance", 1e-6)
    if not 1e-12 <= tolerance <= 1e-2:
        problem = f"{tolerance:g} is not allowed; from 1e-12 to 0.01"
        raise table.error("tolerance", problem)
    return TransientTask(
        duration=duration,
        speed_to=speed_to,
        n_times=_at_most(table, "n_times", 1001, 2, MOST_TIMES),
        tolerance=tolerance,
        max_steps=table.integer("max_steps", 200_000),
        reduction=_reduction(rotor, table),
        passage=table.flag("passage", False),
        station=read_station(table, shaft, shown),
        coordinate=table.choice("coordinate", FREEDOMS[:5], "uy"),
    )

"""What the benchmarks share: clocks, shuffled order, memory, machine, verdict."""

import os
import random
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jax
import numpy as np


def processor() -> str:
    """Model of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return "processor unknown"
    return next((x.split(": ")[1] for x in lines if "model name" in x), "unknown")


def machine() -> str:
    """Processor, cores, devices, and how busy others keep them."""
    load = os.getloadavg()[0]
    devices = jax.devices()
    return (
        f"{processor()}, {os.cpu_count()} cores, load average {load:.1f}; devices:"
        f" {len(devices)} {devices[0].device_kind}; jax {jax.__version__}"
    )


def timed(call: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds that a call takes until its result is there, and the result."""
    begin = time.perf_counter()
    out = jax.block_until_ready(call())
    return time.perf_counter() - begin, out


def shuffled(
    calls: dict[Any, Callable[[], Any]], rounds: int, seed: int = 0, warm: bool = True
) -> dict[Any, list[float]]:
    """Seconds of every call, in shuffled order.

    Args:
        calls: By name; compiled.
        rounds: How often each is timed.
        seed: Of the order.
        warm: Whether each is called once before.
    """
    rng = random.Random(seed)
    found: dict[Any, list[float]] = {name: [] for name in calls}
    if warm:
        for call in calls.values():
            timed(call)
    order = list(calls)
    for _ in range(rounds):
        rng.shuffle(order)
        for name in order:
            found[name].append(timed(calls[name])[0])
    return found


def compiled(function: Callable, *arguments) -> tuple[Any, float]:
    """A function compiled for its arguments, and seconds of tracing and compiling."""
    begin = time.perf_counter()
    program = jax.jit(function).lower(*arguments).compile()
    return program, time.perf_counter() - begin


def peak_memory() -> float:
    """Most memory that this process has held [GiB]."""
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return used / (2**30 if sys.platform == "darwin" else 2**20)


def relative(got: Any, want: Any) -> float:
    """Largest difference relative to the largest number wanted."""
    got, want = np.asarray(got), np.asarray(want)
    return float(np.max(np.abs(got - want)) / np.max(np.abs(want)))


def verdict(what: str, figure: float, goal: float, most: bool = True) -> str:
    """One line: a figure beside its goal, and whether it is met.

    Args:
        what: What is measured, with its unit.
        figure: Measured.
        goal: Wanted.
        most: Whether the goal is an upper bound.
    """
    met = figure <= goal if most else figure >= goal
    sign = "at most" if most else "at least"
    return f"{what}: {figure:.3g} ({sign} {goal:g}): {'met' if met else 'MISSED'}"

"""Warnings about what skids: one list for the library and the command line."""

from typing import Any

import jax
import numpy as np

from ..lubrication import Newtonian, Regime
from .conditions import Conditions
from .model import SkidModel

NEWTONIAN_PRESSURE = 1e9
"""Pressure from which no oil bears the stress of a Newtonian film [Pa]."""

GROSS = 0.1
"""Slip of a ball or roller from which skidding is gross [1]."""

STARTED = 0.1
"""Share of the fastest rolling from which times count, of a motion in time [1]."""

MIXED = 3.0
"""Least film over what remains of a film at rest below which surfaces touch [1]."""


def skid_warnings(model: SkidModel, found: Any, state: Conditions | None) -> list[str]:
    """What is doubtful about a skidding motion, a sentence each.

    Args:
        model: The bearing, its oil and what surrounds the balls.
        found: How its balls or rollers move, concrete; from `steady_skid` or `skid`.
        state: From `conditions`; of rollers `None`.
    """
    found, state = jax.tree.map(np.asarray, (found, state))
    loaded = found.contact_load > 1e-9 * np.nanmax(found.contact_load, initial=0.0)
    # Before the rings turn there is no film, and slip means nothing.
    rolling = np.abs(found.rolling_orbit_speed)
    turning = rolling >= STARTED * np.nanmax(rolling, initial=0.0)
    loaded &= turning[..., None]
    if state is None:
        pressure = found.solution.roller_pressure
        told = _slip(found, loaded), _newtonian(model, pressure)
        return [text for text in told if text]
    told = (
        _wander(model, found),
        _slip(found, loaded),
        _newtonian(model, np.where(loaded, state.peak_pressure, 0.0)),
        _glass(model, state, loaded),
        _regimes(state, loaded),
        _mixed(model, state, loaded),
    )
    return [text for text in told if text]


def _wander(model, found):
    wander = getattr(found, "wander", None)
    play = float(model.cage.pocket_clearance)
    if wander is None or not wander > play:
        return ""
    return (
        f"balls wander {1e6 * float(wander):.4g} µm about even motion, and the pocket"
        f" clearance is {1e6 * play:.4g} µm: the cage takes part, which the end state"
        " leaves out; solve the motion in time"
    )


def _slip(found, loaded):
    largest = np.abs(found.slip[loaded.all(axis=-1)]).max(initial=0.0)
    if not largest > GROSS:
        return ""
    return (
        f"gross skidding, slip up to {100.0 * largest:.3g} %: films and viscosities are"
        " those of rolling contacts at the temperature of the oil, which sliding heats"
    )


def _newtonian(model, pressures):
    pressure = float(np.max(pressures))
    if type(model.traction) is not Newtonian or not pressure > NEWTONIAN_PRESSURE:
        return ""
    return (
        f"a Newtonian film at {1e-9 * pressure:.3g} GPa: beyond some 1 GPa no oil bears"
        " such stress; Eyring's law or a limiting stress is right"
    )


def _glass(model, state, loaded):
    glass = state.outside_fluid_range & loaded
    if not glass.any():
        return ""
    least = float(state.peak_pressure[glass].min())
    return (
        f"the oil is a glass from {1e-6 * least:.4g} MPa or less: beyond the range of"
        f" its law in {_share(glass, loaded)} of the contacts"
    )


def _regimes(state, loaded):
    outside = (state.regime != Regime.PIEZOVISCOUS_ELASTIC) & loaded
    if not outside.any():
        return ""
    codes, counts = np.unique(state.regime[outside], return_counts=True)
    name = Regime(int(codes[counts.argmax()])).name.lower().replace("_", " and ")
    return (
        f"films of {_share(outside, loaded)} of the contacts are {name}: the film"
        " formula is for surfaces that flatten under oil that thickens"
    )


def _mixed(model, state, loaded):
    least = MIXED * float(model.least_film)
    mixed = (state.least_film < least) & loaded
    if not mixed.any():
        return ""
    thinnest = float(state.least_film[mixed].min())
    return (
        f"films down to {1e6 * thinnest:.2g} µm, less than {MIXED:g} times what remains"
        f" at rest, in {_share(mixed, loaded)} of the contacts: surfaces touch, and"
        " their friction is not in the law of traction"
    )


def _share(those, loaded):
    share = 100.0 * np.count_nonzero(those) / np.count_nonzero(loaded)
    return "all" if share == 100.0 else f"{share:.3g} %"

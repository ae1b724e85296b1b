"""Warnings on skidding: one list for the library and the command line."""

from typing import Any

import jax
import numpy as np

from ..lubrication import DryFriction, Newtonian, Regime, SlipCurve
from ..numerics.warning import Warning, in_cases
from .conditions import Conditions
from .model import SkidModel
from .transients.history import SkidMotion

MOST_SHEAR = 0.12
"""Largest shear stress over pressure of any oil [1]. Oils yield at 0.03 to 0.12 of the
pressure: Bair & Winer (1979)."""

GROSS = 0.1
"""Slip of a ball or roller above which skidding is gross [1]."""

PRESSED = 1e-2
"""Share of the largest contact load above which a contact's stress counts [1]."""

STARTED = 0.1
"""Share of the fastest rolling from which times count, of a motion in time [1]."""

MIXED = 3.0
"""Least film over the residual film at rest below which surfaces touch [1]."""


def skid_warnings(
    model: SkidModel, found: Any, state: Conditions | None = None
) -> list[Warning]:
    """Return warnings about a skidding motion.

    Args:
        model: The bearing, its oil and its surroundings. found: How its balls
        or rollers move, concrete; from `skid.steady` or `skid.simulate`.
            With a leading case axis, as `optimise` has it, each sentence is that of the
            worst case, and says in how many cases.
        state: From `conditions`; rollers bring their own.
    """
    state = found.conditions if state is None else state
    held = jax.tree.map(np.asarray, (found, state))
    if held[0].result.ndim:
        cases = range(len(held[0].result))
        ones = (jax.tree.map(lambda leaf, k=k: leaf[k], held) for k in cases)
        kinds = zip(*(_doubts(model, *one) for one in ones), strict=True)
        doubts = [_count_cases(kind) for kind in kinds if any(kind)]
    else:
        doubts = [doubt for doubt in _doubts(model, *held) if doubt]
    return [*_pockets(model), *doubts]


def _count_cases(doubts):
    """Return the warning of the worst case, with the number of cases."""
    doubtful = [k for k, doubt in enumerate(doubts) if doubt]
    worst = max(doubtful, key=lambda k: doubts[k].size)
    return in_cases(doubts[worst], len(doubtful), len(doubts), worst)


def _doubts(model, found, state):
    """Return the warning of each kind, or `None`."""
    loaded = found.contact_load > 1e-9 * np.nanmax(found.contact_load, initial=0.0)
    # Before the rings turn there is no film, and slip has no meaning.
    rolling = np.abs(found.rolling_orbit_speed)
    turning = rolling >= STARTED * np.nanmax(rolling, initial=0.0)
    turning &= rolling > 0
    loaded &= turning[..., None]
    return (
        _wander_warning(model, found),
        _slip(found, turning, loaded.all(axis=-1)),
        _sheared_films(model, state, found.contact_load, loaded),
        _glass(model, state, loaded),
        _regimes(state, loaded),
        _mixed_films(model, state, loaded),
    )


def _pockets(model):
    bearing, play = model.bearing, float(model.cage.pocket_clearance)
    size = float(bearing.element_diameter)
    apart = np.pi * float(bearing.pitch_diameter) / bearing.n_elements - size
    if not play > apart:
        return
    yield Warning(
        "pocket_clearance",
        f"a pocket clearance of {1e3 * play:.4g} mm is more than the"
        f" {1e3 * apart:.3g} mm between two {bearing.noun}s: pockets would overlap",
        play,
        apart,
        "cage",
    )


def _wander_warning(model, found):
    wander = getattr(found, "wander", None)
    play = float(model.cage.pocket_clearance)
    if wander is None or not wander > play:
        return None
    return Warning(
        "wander",
        f"balls wander {1e6 * float(wander):.4g} µm about even motion, and the pocket"
        f" clearance is {1e6 * play:.4g} µm: the cage takes part, which the end state"
        " leaves out; solve the motion in time",
        float(wander),
        play,
    )


def _slip(found, turning, driven):
    slip = np.abs(found.slip)
    largest = float(slip[turning].max(initial=0.0))
    if not largest > GROSS:
        return None
    text = f"gross skidding, slip up to {100.0 * largest:.4g} %"
    if not driven.any():
        text += ": nothing is pressed between both raceways, and nothing drives"
        return Warning("gross_skidding", text, largest, GROSS)
    under_load = slip[driven].max(initial=0.0)
    if under_load < largest:
        text = f"{text}, of what both raceways press {100.0 * under_load:.4g} %"
    text = (
        f"{text}: films and viscosities are those of rolling contacts at the"
        " temperature of the oil, which sliding heats"
    )
    if isinstance(found, SkidMotion):
        text += (
            "; contact loads in time have the centrifugal force of pure rolling, if no"
            " `load_speed` is given"
        )
    return Warning("gross_skidding", text, largest, GROSS)


def _sheared_films(model, state, load, loaded):
    # These laws are measured, or of no oil.
    if isinstance(model.traction, DryFriction | SlipCurve):
        return None
    # Little pressure says little: oil bears some stress without any.
    counts = loaded & (load > PRESSED * np.nanmax(load, initial=0.0))
    shear = float(np.where(counts, state.shear, 0.0).max(initial=0.0))
    if not shear > MOST_SHEAR:
        return None
    newtonian = isinstance(model.traction, Newtonian)
    law = "a Newtonian film" if newtonian else "its law of traction"
    cure = "Eyring's law or a limiting stress" if newtonian else "a limiting stress"
    pressure = float(np.where(counts, state.peak_pressure, 0.0).max(initial=0.0))
    return Warning(
        "shear_stress",
        f"shear stresses of {shear:.3g} times the pressure by {law}, at up to"
        f" {1e-9 * pressure:.3g} GPa: no oil bears more than some {MOST_SHEAR:g};"
        f" {cure} is right",
        shear,
        MOST_SHEAR,
    )


def _glass(model, state, loaded):
    glass = state.outside_fluid_range & loaded
    if not glass.any():
        return None
    least = float(state.peak_pressure[glass].min())
    share, words = _share(glass, loaded)
    return Warning(
        "glassy_oil",
        f"the oil is a glass from {1e-6 * least:.4g} MPa or less: beyond the range of"
        f" its law in {words} of the contacts",
        share,
        0.0,
    )


def _regimes(state, loaded):
    outside = (state.regime != Regime.PIEZOVISCOUS_ELASTIC) & loaded
    if not outside.any():
        return None
    codes, counts = np.unique(state.regime[outside], return_counts=True)
    name = Regime(int(codes[counts.argmax()])).name.lower().replace("_", " and ")
    share, words = _share(outside, loaded)
    return Warning(
        "film_regime",
        f"films of {words} of the contacts are {name}: the film"
        " formula is for surfaces that flatten under oil that thickens",
        share,
        0.0,
    )


def _mixed_films(model, state, loaded):
    least = MIXED * float(model.least_film)
    mixed = (state.least_film < least) & loaded
    if not mixed.any():
        return None
    thinnest = float(state.least_film[mixed].min())
    return Warning(
        "mixed_film",
        f"films down to {1e6 * thinnest:.2g} µm, less than {MIXED:g} times what remains"
        f" at rest, in {_share(mixed, loaded)[1]} of the contacts: surfaces touch, and"
        " their friction is not in the law of traction",
        1.0 - thinnest / least,
        0.0,
    )


def _share(those, loaded):
    share = np.count_nonzero(those) / np.count_nonzero(loaded)
    return share, "all" if share == 1.0 else f"{100.0 * share:.3g} %"

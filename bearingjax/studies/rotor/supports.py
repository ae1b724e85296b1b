"""Preloaded supports of the rotor of a scene."""

import dataclasses

import numpy as np

from ...numerics.types import as_array
from ...rotor import (
    AbstractSupport,
    BearingSupport,
    LinearSupport,
    Rotor,
    StaticEquilibrium,
    preload_offset,
)
from ...rotor.nonlinear import LawSupport
from .mounts import FORCE_LAWS, Mount

_AT_LEAST = 1e-5
"""Least unit of length, for rotors without preload or load [m]."""


def support_of(mount: Mount) -> AbstractSupport:
    """Build the support of a mount, with stationary rolling elements.

    Raises:
        SolveError: If a bearing cannot carry its preload.
    """
    keys, damping = mount.keys, mount.keys.damping.diagonal
    housing = None if keys.housing is None else keys.housing.housing
    if mount.installed is None:
        springs = () if keys.stiffness is None else keys.stiffness.diagonal
        return LinearSupport(keys.station, springs, damping, housing=housing)
    element = mount.installed.element_at()
    offset = as_array(keys.offset or 0.0, float)
    if keys.preload is not None:
        offset = preload_offset(element, as_array(keys.preload, float))
    if keys.law is not None:
        law = FORCE_LAWS[keys.law].of_bearing(element, offset)
        return LawSupport(
            keys.station, law, damping, housing=housing, turned=keys.turned
        )
    return BearingSupport(
        keys.station,
        element,
        as_array([0.0, 0.0, float(offset), 0.0, 0.0], float),
        damping,
        housing=housing,
        turned=keys.turned,
        inertia=keys.inertia,
    )


def with_passage(support: AbstractSupport) -> AbstractSupport:
    """Return a support whose rolling elements orbit as the rotor turns.

    Args:
        support: Any support; without rolling elements it is returned unchanged.
    """
    if not isinstance(support, BearingSupport):
        return support
    return dataclasses.replace(support, passage=True)


def unit_of_length(rotor: Rotor, settled: StaticEquilibrium) -> float:
    """Return the unit of length: the largest motion by preload or equilibrium [m]."""
    sizes = [_AT_LEAST, float(np.max(np.abs(np.asarray(settled.displacement)[:, :3])))]
    for support in rotor.supports:
        if isinstance(support, BearingSupport):
            sizes.append(float(np.max(np.abs(np.asarray(support.offset)[:3]))))
        law = getattr(support, "law", None)
        sizes.append(float(getattr(law, "preload_displacement", 0.0)))
        sizes.append(float(getattr(law, "preload_approach", 0.0)))
    return max(sizes)

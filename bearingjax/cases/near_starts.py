"""Starts of the cases of a sweep: from the nearest of the cases solved before.

The first chunk starts from first contact, every other case from a solved one that is
near in direction and size of its load and in all else that cases differ in, moved by
the stiffness found there. Loads and answers are turned by whole pitches of the rolling
elements until the load is next to +x: turned so, a bearing looks the same.
"""

from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from ..design import CylindricalRollerBearing, NeedleRollerBearing, rows_of
from ..design.places import has_empty_places
from ..element import FREEDOMS, RINGS, BearingElement
from ..numerics.linear import solve
from ..numerics.units import unit, units
from ..statics import Solution, Support
from ..statics.warning_sizes import unrestrained_directions
from .cases import Cases

KEPT = 1024
"""Solved cases of a device that others start from. More cost more than they save."""

FAR = 1.5
"""Distance beyond which a case starts from first contact [1]. Directions of loads are
at most 2 apart, sizes by half the logarithm of their ratio, all else by its share of
the range of the sweep."""

_PARTS = slice(0, 2), slice(2, 3), slice(3, 5)
"""Radial force, axial force, moment."""

_COORDINATES = 8
"""Number of coordinates that distinguish designs."""


class Likeness(NamedTuple):
    """Properties that the cases of a sweep have in common. Static.

    Attributes:
        free: Which freedoms of the moving ring are free.
        pitch: Angle by which the bearing may be turned and looks the same [rad]; 0:
            none.
        axial_play: Whether the ring may lie anywhere between ribs.
    """

    free: tuple[bool, ...]
    pitch: Annotated[float, unit("rad")]
    axial_play: bool


class SolvedCases(NamedTuple):
    """Solved cases, turned towards +x; behind `KEPT` room for a chunk that is not read.

    Attributes:
        load: Load on the moving ring [N, N m].
        other: From `unsafe_to_start_near`.
        displacement: Displacement of the moving ring [m, rad].
        stiffness: Stiffness of the moving ring.
        usable: Whether cases may start from it.
        n_solved: Number of solved cases.
    """

    load: Annotated[Float[Array, "known 6"], units("N", "N m")]
    other: Float[Array, "known k"]
    displacement: Annotated[Float[Array, "known 6"], units("m", "rad")]
    stiffness: Float[Array, "known 6 6"]
    usable: Bool[Array, " known"]
    n_solved: Int[Array, " 1"]


def nothing_known(lanes: int, devices: int, coordinates: int) -> SolvedCases:
    """No solved cases, of all devices one after the other, as NumPy arrays.

    Args:
        lanes: Cases of a chunk.
        devices: Number of devices.
        coordinates: Columns of `unsafe_to_start_near`.
    """
    n = devices * (KEPT + lanes)
    tails = (6,), (coordinates,), (6,), (6, 6)
    none: list[Any] = [np.zeros((n, *tail)) for tail in tails]
    last: list[Any] = [np.zeros(n, bool), np.zeros(devices, np.int32)]
    return SolvedCases(*none, *last)


def common_properties(
    element: BearingElement[Any], cases: Cases, support: Support
) -> Likeness:
    """Return the properties that the cases of a sweep have in common."""
    may_move = support.freedoms(element.bearing)
    free = [name for name in may_move if name not in cases.prescribed]
    counts = {row.bearing.n_places for row in rows_of(element.bearing)}
    round_z = all((a in free) == (b in free) for a, b in (("ux", "uy"), ("gx", "gy")))
    round_z = round_z and len(counts) == 1 and not cases.prescribed
    # Designs of several numbers of elements look alike after different turns.
    round_z = round_z and not has_empty_places(element.bearing)
    round_z = round_z and cases.fixed_displacement is None
    pitch = 2.0 * np.pi / counts.pop() if round_z else 0.0
    cylindrical = CylindricalRollerBearing | NeedleRollerBearing
    between_ribs = any(
        isinstance(r.bearing, cylindrical) for r in rows_of(element.bearing)
    )
    freedoms = tuple(name in free for name in FREEDOMS)
    return Likeness(freedoms, pitch, between_ribs and "uz" in free)


def unsafe_to_start_near(element: BearingElement[Any], cases: Cases) -> np.ndarray:
    """Differences of cases other than loads, as shares of the range (case, k) [1].

    Args:
        element: The bearing or designs.
        cases: All cases of the sweep.
    """
    speeds = (cases.inner_speed, cases.outer_speed)
    leaves = jax.tree.leaves((cases.prescribed, cases.fixed_displacement, speeds))
    columns = [np.zeros((cases.count, 0)), *leaves]
    if cases.design is not None:
        numbers = [np.asarray(leaf) for leaf in jax.tree.leaves(element)]
        designs = _shares([a for a in numbers if a.dtype.kind == "f"])
        designs = designs[:, designs.any(axis=0)]
        if designs.shape[1] > _COORDINATES:
            # Distances survive a random projection.
            mixed = np.random.default_rng(0).normal(
                size=(designs.shape[1], _COORDINATES)
            )
            designs = designs @ mixed / np.sqrt(_COORDINATES)
        columns.append(designs[np.asarray(cases.design)])
    return _shares(columns)


def _shares(arrays):
    """Columns of arrays, each from 0 to 1."""
    flat = np.concatenate(
        [np.reshape(a, (len(a), -1 if np.size(a) else 0)) for a in arrays], axis=1
    )
    flat = np.where(np.isfinite(flat), flat, 0.0)
    span = np.ptp(flat, axis=0)
    return (flat - flat.min(axis=0)) / np.where(span > 0, span, 1.0)


def starts(
    known: SolvedCases, cases: Cases, other: Float[Array, "case k"], alike: Likeness
) -> Float[Array, "case 6"]:
    """Displacements of the moving ring to start from [m, rad]; NaN: first contact.

    Args:
        known: Solved cases.
        cases: A chunk.
        other: From `unsafe_to_start_near`, of these.
        alike: From `common_properties`.
    """
    known = jax.tree.map(lambda a: a[:KEPT], known)
    free = jnp.asarray(alike.free)
    angle = _angle(cases.load, alike.pitch)
    load = _rotate_about_z(cases.load, -angle)
    own = jnp.diagonal(known.stiffness, axis1=1, axis2=2)
    counted = known.usable[:, None] & free[None] & (own > 0)
    soft = jnp.where(counted, -0.5 * jnp.log(jnp.where(counted, own, 1.0)), 0.0)
    # Loads are alike by their effect, not by their unit.
    count = jnp.sum(known.usable, dtype=load.dtype)
    scale = jnp.exp(soft.sum(axis=0) / jnp.maximum(count, 1.0))
    scale = jnp.where(free, scale, 0.0)[None]
    there, here = (_place(scale * a, b) for a, b in (known[:2], (load, other)))
    square = jnp.where(known.usable, jnp.sum(there**2, axis=1), jnp.inf)
    apart = square[None] - 2.0 * here @ there.T
    index = jnp.argmin(apart, axis=1)
    apart = jnp.min(apart, axis=1) + jnp.sum(here**2, axis=1)
    near = jax.tree.map(lambda a: a[index], known[:4])
    there, stiffness = near[2:]
    given = jnp.zeros_like(load)
    for name, value in cases.prescribed.items():
        given = given.at[:, FREEDOMS.index(name)].set(value)
    held = jnp.where(free[None], 0.0, given - there)
    push = load - near[0] - (stiffness @ held[:, :, None])[:, :, 0]
    both = (free[:, None] & free[None])[None]
    alone = jnp.where(both, stiffness, jnp.eye(6, dtype=load.dtype)[None])
    change = jax.vmap(solve)(alone, jnp.where(free[None], push, held))
    found = _rotate_about_z(there + change, angle)
    # Nothing holds it, and it may end at a rib, which it touches and seems held by.
    adrift = (load[:, 2] == 0) & alike.axial_play
    return jnp.where(((apart < FAR**2) & ~adrift)[:, None], found, jnp.nan)


def _place(load, other):
    """Coordinates of cases: cases near each other have solutions near each other."""
    size = jnp.sqrt(jnp.sum(load**2, axis=1, keepdims=True))
    size = jnp.where(size > 0, size, 1.0)
    # In a direction that has play and no load, any place within the play is an answer.
    # To find that of first contact, cases without that load keep to themselves.
    none = [jnp.all(load[:, part] == 0, axis=1) for part in _PARTS]
    kind = jnp.where(jnp.stack(none, axis=1), 4.0 * FAR, 0.0)
    return jnp.concatenate([load / size, 0.5 * jnp.log(size), other, kind], axis=1)


def add_solved(
    known: SolvedCases, solutions: Solution, cases: Cases, other: Any, alike: Likeness
) -> tuple[SolvedCases, Bool[Array, " case"]]:
    """Add a chunk of solved cases; return all, and which are not valid as starts.

    Args:
        known: Solved cases.
        solutions: Solutions of the chunk, leading axis case.
        cases, other, alike: As in `starts`.
    """
    load = cases.load
    back = -_angle(load, alike.pitch)
    first = 6 * RINGS.index(solutions.moving_ring)
    moving = slice(first, first + 6)
    k = solutions.stiffness[:, moving, moving].astype(load.dtype)
    k = _rotate_about_z(0.5 * (k + k.swapaxes(1, 2)), back[:, None])
    k = _rotate_about_z(k.swapaxes(1, 2), back[:, None])
    there = _rotate_about_z(solutions.displacement[:, moving].astype(load.dtype), back)
    # Of a ring that nothing holds in some direction this is one answer of many.
    sound = (solutions.result == 0) & (
        jax.vmap(unrestrained_directions)(solutions) == 0
    )
    at = jnp.minimum(known.n_solved[0], KEPT)

    def write(old, new):
        new = jnp.where(jnp.isfinite(new), new, jnp.zeros_like(new)).astype(old.dtype)
        return lax.dynamic_update_slice_in_dim(old, new, at, 0)

    new = (_rotate_about_z(load, back), other, there, k, sound)
    rows: Any = [write(*pair) for pair in zip(known[:5], new, strict=True)]
    return SolvedCases._make([*rows, known.n_solved + len(load)]), ~sound


def _angle(load, pitch):
    """Angle of loads (case, 6) from +x, in whole pitches (case,) [rad]."""
    if not pitch:
        return jnp.zeros_like(load[:, 0])
    radial = jnp.any(load[:, :2] != 0, axis=1)
    x, y = (jnp.where(radial, load[:, k], load[:, 3 + k]) for k in (0, 1))
    return pitch * jnp.round(jnp.arctan2(y, x) / pitch)


def _rotate_about_z(vectors, angle):
    """Loads or freedoms (…, 6) turned about z."""
    c, s = jnp.cos(angle), jnp.sin(angle)
    x, y, z, a, b, g = jnp.moveaxis(vectors, -1, 0)
    turned = [c * x - s * y, s * x + c * y, z, c * a - s * b, s * a + c * b, g]
    return jnp.stack(turned, axis=-1)

"""Where two wheels of a system of shafts touch, by the places of their shafts.

The force of a pair acts on both wheels at one point, so that no couple is left: gears
touch in the middle of the common part of their faces, a belt pulls along the line from
one pulley to the other.
"""

from typing import Annotated, Any, NamedTuple

import jax
from jaxtyping import Array, Float

from ..numerics.types import Scalar, array_namespace, in_numpy
from ..numerics.units import unit
from .parts import APEXES, Gear, Pulley

Pair = tuple[Float[Array, "3"], Float[Array, "3"]]


class MeshPlace(NamedTuple):
    """Where two wheels touch, in global axes.

    Attributes:
        ways: Directions from their shafts to the mesh, of pulleys of the pull (3,) [1].
        radii: Working pitch radii [m].
        points: Where the force acts, from the shaft at each wheel (3,) [m].
        gap: From where the first wheel meshes to where the second does, if their
            places do not agree; zero if places are not known (3,) [m].
        size: Sum of the radii of gears, distance of pulleys [m].
        overlap: Common part of the faces of cylindrical gears, below zero if there is
            none [m]; `None` if a face or a place is not known.
    """

    ways: Annotated[Pair, unit("1")]
    radii: Annotated[tuple[Scalar, Scalar], unit("m")]
    points: Annotated[Pair, unit("m")]
    gap: Annotated[Float[Array, "3"], unit("m")]
    size: Annotated[Scalar, unit("m")]
    overlap: Annotated[Scalar | None, unit("m")]


def mesh_place(one: Any, other: Any, shaft: Any, far: Any) -> MeshPlace | None:
    """Return where two wheels touch; `None` if the places of their shafts do not tell.

    Args:
        one, other: The wheels.
        shaft, far: Their shafts.
    """
    one, other, shaft, far = parts = in_numpy((one, other, shaft, far))
    xp: Any = array_namespace(*jax.tree.leaves(parts))
    z, apart = shaft.frame[2], None
    if shaft.origin is not None and far.origin is not None:
        centres = [
            s.origin + w.position * s.frame[2] for s, w in ((shaft, one), (far, other))
        ]
        apart = centres[1] - centres[0]
    radii, overlap = (one.radius, other.radius), None
    if isinstance(one, Gear) and one.pitch_angle is not None:
        a, b = outward_direction(one, shaft), outward_direction(other, far)
        first, second = unit_vector(part_across(b, a)), unit_vector(part_across(a, b))
    elif apart is None:
        return None
    elif isinstance(one, Pulley):
        first = unit_vector(apart)
        none, gap = xp.zeros_like(apart), (apart @ z) * z
        size = xp.sqrt(apart @ apart)
        return MeshPlace((first, -first), radii, (none, none), gap, size, None)
    else:
        radial = part_across(apart, z)
        distance, first = xp.sqrt(radial @ radial), unit_vector(radial)
        second, share = -first, distance / (radii[0] + radii[1])
        radii = radii[0] * share, radii[1] * share
    points = [radii[0] * first, radii[1] * second]
    size = radii[0] + radii[1]
    gap = xp.zeros_like(first) if apart is None else apart + points[1] - points[0]
    shift = 0.5 * gap
    if apart is not None and one.pitch_angle is None:
        if one.face_width is not None and other.face_width is not None:
            along, half = gap @ z, (0.5 * one.face_width, 0.5 * other.face_width)
            low = xp.maximum(-half[0], along - half[1])
            high = xp.minimum(half[0], along + half[1])
            shift, overlap = 0.5 * (low + high) * z, high - low
    points = points[0] + shift, points[1] + shift - gap
    return MeshPlace((first, second), radii, points, gap, size, overlap)


def outward_direction(gear: Gear, shaft: Any) -> Any:
    """Return the direction along its shaft from the apex of a bevel gear to it."""
    return -APEXES[str(gear.apex)] * shaft.frame[2]


def part_across(vector: Any, axis: Any) -> Any:
    """Return the part of a vector across an axis of length 1."""
    return vector - (vector @ axis) * axis


def unit_vector(vector: Any) -> Any:
    """Return the vector of length 1 along a vector."""
    return vector / array_namespace(vector).sqrt(vector @ vector)

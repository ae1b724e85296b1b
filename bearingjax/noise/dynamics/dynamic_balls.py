"""Explicit forces of all balls of a dynamic row at once.

The derivatives of `DynamicElement.energy` of balls whose contact constants do not
follow the angle. Arrays have the axes (contact, element): a compiler works on many
contacts with one instruction, and a step of a vibration costs a third of what it does
ball by ball, with the derivative of the energy taken by `jax.grad`.
"""

from functools import partial
from typing import Annotated, NamedTuple

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ...contact.hertz import POINT_EXPONENT
from ...element.balls.ball import Ball
from ...element.balls.ball_contacts import add
from ...numerics.power import positive_power
from ...numerics.units import unit
from .dynamic_element import DynamicElement
from .element_positions import Section

_N, _D = POINT_EXPONENT


def is_written_out(balls: DynamicElement) -> bool:
    """Return whether `ball_forces` is valid for elements of this kind. Static."""
    ball = balls.element
    return (
        isinstance(ball, Ball)
        and not (ball.follows_angle or ball.has_reaction or ball.grooves.straight)
        and ball.ball_inertia is None
    )


def ball_forces(
    balls: DynamicElement,
    outer: Section,
    inner: Section,
    places: Float[Array, "element 2"],
    heights: Float[Array, "2 element"] | None,
) -> tuple[tuple[Section, Section], Float[Array, "element 2"]]:
    """Return the derivatives of the energy of all balls [N, N m].

    Args:
        balls: One ball, or balls with a leading axis.
        outer, inner: Motions of the rings at every ball [m, rad].
        places: Places of the balls (z, r) [m].
        heights: Material added in the contacts of the raceways [m], or `None`.

    Returns:
        By the motions of outer and inner ring, and by the places of the balls.

    Source: of a contact c (l - L)^(3/2) along the line of centres, as in `Ball`.
    """
    grooves, geometry = balls.element.grooves, balls.element.geometry
    of = [0 if on_outer else 1 for on_outer in grooves.on_outer]

    def tile(numbers):
        """(contact,), or (element, contact), with the axes (contact, element)."""
        return numbers[:, None] if numbers.ndim == 1 else numbers.T

    start_z, start_r = tile(grooves.start[..., 0]), tile(grooves.start[..., 1])
    reach, constant = tile(grooves.reach), tile(balls.element.constant)
    if heights is not None:
        reach = reach - jnp.stack([heights[k] for k in of])
    z, r = [outer.axial, inner.axial], [outer.outwards, inner.outwards]
    arm = geometry.pitch_radius
    tilts = [ring.tilt for ring in (outer, inner)]
    for k, tilt in enumerate(tilts):
        if tilt is not None:
            z[k] = z[k] - arm * tilt
    # How far each ball has moved against each groove centre.
    moved_z = jnp.stack([places[:, 0] - z[k] for k in of])
    moved_r = jnp.stack([places[:, 1] - r[k] for k in of])
    tilt_z = tilt_r = None
    if tilts != [None, None]:
        tilt_z, tilt_r = tile(geometry.tilted[..., 0]), tile(geometry.tilted[..., 1])
        known = [jnp.zeros_like(z[0]) if t is None else t for t in tilts]
        tilt = (known[1] - known[0])[None]
        moved_z, moved_r = moved_z - tilt_z * tilt, moved_r - tilt_r * tilt
    walls = grooves.open_side, grooves.washers, tuple(grooves.outwards)
    force_z, force_r = _forces(
        walls, (moved_z, moved_r), (start_z, start_r), reach, constant
    )
    on_rings = []
    for ring, turned in ((0, 1.0), (1, -1.0)):
        mine = slice(of.index(ring), len(of) - of[::-1].index(ring))
        axial, outwards = -add(force_z[mine]), -add(force_r[mine])
        moment = None
        if tilt_z is not None and tilt_r is not None:
            moment = turned * add(tilt_z * force_z + tilt_r * force_r) - arm * axial
        on_rings.append(Section(axial, outwards, moment))
    # The tether holds a ball where nothing else does, and does not pull the rings.
    spring = balls.element.tether
    on_z = add(force_z) + spring * (places[:, 0] - 0.5 * (z[0] + z[1]))
    on_r = add(force_r) + spring * (places[:, 1] - 0.5 * (r[0] + r[1]))
    return (on_rings[0], on_rings[1]), jnp.stack([on_z, on_r], axis=1)


class _Contact(NamedTuple):
    """Contacts of balls, each array (contact, element).

    Attributes:
        normal: z and r of the unit vector from groove centre to ball centre [1].
        mask: 0 where the part along z, or along r, counts for nothing, else 1.
        load: [N].
        root: c (l - L)^(1/2), of a contact that is open 0 [N/m].
        turn: Load over length, the stiffness across the normal [N/m].
    """

    normal: Annotated[tuple[Array, Array], unit("1")]
    mask: tuple[Array, Array]
    load: Annotated[Array, unit("N")]
    root: Annotated[Array, unit("N/m")]
    turn: Annotated[Array, unit("N/m")]


def _contact(walls, moved, start, reach, constant) -> _Contact:
    """Return the contact as `GrooveGeometry.touch` does, with its load."""
    open_side, washers, outwards = walls
    sign = jnp.asarray(outwards, reach.dtype)[:, None]
    (moved_z, moved_r), (start_z, start_r) = moved, start
    away_z, away_r = start_z + moved_z, start_r + moved_r
    # Beyond its end a groove goes on straight.
    past_z = jnp.asarray(open_side)[:, None] & (sign * away_z < 0.0)
    past_r = (sign * away_r < 0.0) & (not washers)
    kept_z, kept_r = jnp.where(past_z, 0.0, away_z), jnp.where(past_r, 0.0, away_r)
    square = kept_z * kept_z + kept_r * kept_r
    length = jnp.sqrt(jnp.maximum(square, (1e-9 * reach) ** 2))
    # (l² - L²)/(l + L) without the cancellation, where the start is known.
    begin = start_z * start_z + start_r * start_r - reach * reach
    change = moved_z * (2.0 * start_z + moved_z) + moved_r * (2.0 * start_r + moved_r)
    difference = jnp.where(past_z | past_r, square - reach * reach, begin + change)
    approach = difference / (length + reach)
    root = constant * positive_power(approach, _N - _D, _D)
    load = root * approach
    inverse = 1.0 / length
    mask = jnp.where(past_z, 0.0, 1.0), jnp.where(past_r, 0.0, 1.0)
    normal = kept_z * inverse, kept_r * inverse
    return _Contact(normal, mask, load, root, load * inverse)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _forces(walls, moved, start, reach, constant):
    """Return reversed forces (z, r) on the balls [N]; arrays (contact, element).

    Its derivative is written out, because that of every quotient and root in turn
    costs three times as much.
    """
    at = _contact(walls, moved, start, reach, constant)
    return at.load * at.normal[0], at.load * at.normal[1]


def _forces_jvp(walls, primals, tangents):
    at = _contact(walls, *primals)
    (nz, nr), (mask_z, mask_r) = at.normal, at.mask
    moved, start, reach, constant = tangents
    z, r = _sum(moved[0], start[0]), _sum(moved[1], start[1])
    z, r = (jnp.zeros_like(nz) if x is None else x for x in (z, r))
    along = nz * z + nr * r
    closing = along if _is_zero(reach) else along - reach
    rate = (_N / _D) * at.root * closing
    if not _is_zero(constant):
        rate = rate + at.load / primals[3] * constant
    rate = rate - at.turn * along
    change = rate * nz + at.turn * mask_z * z, rate * nr + at.turn * mask_r * r
    return (at.load * nz, at.load * nr), change


_forces.defjvp(_forces_jvp, symbolic_zeros=True)


def _is_zero(change) -> bool:
    return isinstance(change, SymbolicZero)


def _sum(one, other):
    """Return the sum of two changes, either of which may be absent."""
    some = [x for x in (one, other) if not _is_zero(x)]
    return sum(some[1:], start=some[0]) if some else None

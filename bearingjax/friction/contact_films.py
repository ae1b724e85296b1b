"""Films of the contacts of a solved bearing: thickness over roughness."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import contact_modulus, rows_of
from ..design.abstract import nearest_entry
from ..design.checks import of_class, positive
from ..lubrication import Lubricant
from ..lubrication.film import line_film, point_film
from ..numerics.labels import to_xarray
from ..numerics.shown import Printable
from ..numerics.types import Number, as_real
from ..numerics.units import unit
from ..statics.solution import BallSolution, RollerSolution, Solution, check_single

_SIDES = (1.0, -1.0)
"""Signs of outer and inner raceway: outside and inside of the pitch circle."""


class Films(Printable):
    """Films of all contacts; axis contact as in `BallResults`, of rollers (outer,
    inner). Where no load is carried films are infinite.

    Attributes:
        entrainment: Entrainment speed (element, contact) [m/s].
        central: Film in the middle of the contact (element, contact) [m].
        minimum: Least film (element, contact) [m].
        ratio: Least film over the roughness, Λ (element, contact) [1], or `None`.
    """

    entrainment: Float[Array, "element contact"] = eqx.field(metadata=unit("m/s"))
    central: Float[Array, "element contact"] = eqx.field(metadata=unit("m"))
    minimum: Float[Array, "element contact"] = eqx.field(metadata=unit("m"))
    ratio: Float[Array, "element contact"] | None = eqx.field(metadata=unit("1"))

    to_xarray = to_xarray


def films(
    solution: Solution,
    lubricant: Lubricant,
    temperature: Number,
    roughness: Number | None = None,
) -> Films:
    """Elastohydrodynamic films of a solved bearing whose elements roll without slip.

    The surfaces enter at ω r: r the radius of the contact about the axis, ω the speed
    of its ring less the orbital speed, of balls that of the solution, of rollers that
    of rolling on both raceways. Of rollers the film is that of the mean load per
    length; that of barrel rollers whose contact ends short of their ends is thinner, by
    the power 0.13 to 0.17 of the ratio of the lengths.

    Args:
        solution: Solved at a speed.
        lubricant: The oil.
        temperature: Temperature of the oil at the inlets [K].
        roughness: Root mean square of both surfaces together,
            sqrt(Rq1² + Rq2²) [m]; `None`: no ratio.

    Raises:
        TypeError: If `solution` or `lubricant` is none.
        ValueError: For several solutions at once (map over them), a solution without
            speed, or a roughness or temperature that is not positive.

    Source: Hamrock & Dowson (1977) of balls, Pan & Hamrock (1989) of rollers:
        `lubrication.point_film`, `line_film`.
    """
    _check_call(solution, lubricant, temperature, roughness)
    state = (
        lubricant.viscosity(0.0, temperature),
        lubricant.pressure_coefficient(temperature),
    )
    parts, begin = [], 0
    pairs = zip(solution.row_sizes, rows_of(solution.element.bearing), strict=True)
    for size, row in pairs:
        mine = slice(begin, begin + size)
        begin += size
        of_row = nearest_entry(_FILMS, solution)
        parts.append(of_row(solution, row.bearing, mine, state))
    entrainment, central, minimum = (
        jnp.concatenate(values) for values in zip(*parts, strict=True)
    )
    ratio = None if roughness is None else minimum / as_real(roughness)
    return Films(entrainment, central, minimum, ratio)


def _check_call(solution, lubricant, temperature, roughness):
    of_class("films", "solution", solution, Solution, "a Solution")
    of_class("films", "lubricant", lubricant, Lubricant, "a Lubricant")
    check_single("films", solution)
    if solution.speed is None:
        raise ValueError("films: `solution` is at rest; solve it with `speed`.")
    positive("films", "temperature", as_real(temperature), "K")
    if roughness is not None:
        positive("films", "roughness", as_real(roughness), "m")


def _of_balls(solution, bearing, mine, state):
    load, angle = solution.contact_load[mine], solution.contact_angle[mine]
    axes, orbit = solution.semi_axes[mine], solution.kinematics.orbit[mine]
    arcs = load.shape[1] // 2
    sides = jnp.repeat(jnp.array(_SIDES), arcs)[None]
    rings = jnp.repeat(jnp.stack([solution.speed.outer, solution.speed.inner]), arcs)
    cosine = jnp.cos(angle)
    entrainment = jnp.abs(rings[None] - orbit[:, None]) * _radius(
        bearing, cosine, sides
    )
    loaded = load > 0
    wide = jnp.where(loaded, axes[..., 1], 1.0) / jnp.where(loaded, axes[..., 0], 1.0)
    return _thickness(
        lambda q, ratio, radius, modulus: point_film(q, ratio, radius, modulus, *state),
        entrainment,
        load,
        (jnp.maximum(wide, 1.0), _rolling_radius(bearing, cosine, sides)),
        contact_modulus(bearing.material, bearing.rings),
    )


def _of_rollers(solution, bearing, mine, state):
    load = solution.roller_load[mine] / bearing.roller_length
    sides = jnp.array(_SIDES)
    cosine = jnp.cos(bearing.axis_angle + sides * bearing.half_angle)
    radius = _radius(bearing, cosine, sides)
    rings = jnp.stack([solution.speed.outer, solution.speed.inner])
    orbit = jnp.sum(rings * radius) / jnp.sum(radius)
    entrainment = jnp.abs(rings - orbit) * radius
    return _thickness(
        lambda q, radius, modulus: line_film(q, radius, modulus, *state),
        jnp.broadcast_to(entrainment, load.shape),
        load,
        (jnp.broadcast_to(_rolling_radius(bearing, cosine, sides), load.shape),),
        contact_modulus(bearing.material, bearing.rings),
    )


def _thickness(formula, entrainment, load, sizes, modulus):
    """Entrainment, central and least film of contacts (element, contact)."""

    def film_thickness(speed, load, *sizes):
        film = formula(load, *sizes, modulus)
        return film.central(speed), film.minimum(speed)

    found = jax.vmap(jax.vmap(film_thickness))(entrainment, load, *sizes)
    carried = load > 0
    return entrainment, *(jnp.where(carried, film, jnp.inf) for film in found)


def _diameter(bearing):
    return getattr(bearing, f"{bearing.noun}_diameter")


def _radius(bearing, cosine, sides):
    """Radius of contacts about the axis [m]."""
    return 0.5 * (bearing.pitch_diameter + sides * _diameter(bearing) * cosine)


def _rolling_radius(bearing, cosine, sides):
    """Relative radius of curvature in rolling direction [m]."""
    diameter = _diameter(bearing)
    return 0.5 * diameter * (1.0 + sides * diameter * cosine / bearing.pitch_diameter)


_FILMS = {BallSolution: _of_balls, RollerSolution: _of_rollers}

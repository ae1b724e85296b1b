"""Friction of one row or contact without a solve, and constants of SKF's model."""

import jax
import jax.numpy as jnp
import numpy as np

from ....catalogue.entry import bearing_of_entry, catalogue_entry
from ....contact.hertz import ellipse
from ....design import Material, contact_modulus
from ....design.bearing_set import rows_of
from ....design.keywords import BALLS, ROLLERS
from ....friction import friction_skf as skf
from ....life.equivalent_load import equivalent_load
from ....lubrication import Newtonian, ellipse_patch, mil_l_23699, point_film


def coefficient(
    bearing: str, load: np.ndarray, speed: float, viscosity: float
) -> dict[str, float]:
    """Return M/(P d/2) of a bearing of the catalogue in an oil bath by SKF's model.

    Args:
        bearing: Its designation.
        load: On the bearing (6,), which one row bears [N, N m].
        speed: Speed of the inner ring [rad/s].
        viscosity: Kinematic viscosity of the oil [m²/s].
    """
    entry, force = catalogue_entry(bearing), jnp.asarray(load)
    own = bearing_of_entry(entry)
    row = rows_of(own)[0].bearing
    kind, series = skf._TYPES[type(row)], skf.skf_series_of(entry)
    assert series is not None
    rpm, nu = speed * 30.0 / np.pi, 1e6 * viscosity
    mean, span = skf._diameters(row, kind, (entry.bore, entry.outside_diameter))
    flow, radial = nu * rpm, np.hypot(*load[:2])
    given = kind.series[series], mean, radial, load[2], rpm, entry.static_capacity, flow
    rolling, sliding = (1e-3 * float(x) for x in skf._variables(row, *given))
    warm = 1.0 / (1.0 + 1.84e-9 * (rpm * float(mean)) ** 1.28 * nu**0.64)
    oiled = flow * 2.0 * float(mean) * np.sqrt(kind.kz / (2.0 * float(span)))
    full = np.exp(-skf._STARVED["oil_bath"] * oiled)
    dry = np.exp(-2.6e-8 * flow**1.4 * float(mean))
    film = skf.OILS["mineral"] if kind.film is None else kind.film
    whole = float(warm * full * flow**0.6 * rolling)
    whole += (dry * skf._BOUNDARY + (1.0 - dry) * film) * sliding
    p = float(equivalent_load(own, force).dynamic)
    return {"coefficient": whole / (0.5 * p * entry.bore)}


def constants() -> dict[str, np.ndarray]:
    """Return the sums of the logarithms of SKF's constants over the series of types."""
    kinds = {name: skf._TYPES.get(kind) for name, kind in {**BALLS, **ROLLERS}.items()}
    tables = {name: [*one.series.values()] for name, one in kinds.items() if one}
    return {name: np.log(rows).sum(axis=0) for name, rows in tables.items()}


def traction_slopes(
    ball_diameter: float,
    pitch_diameter: float,
    osculation: float,
    contact_angle: float,
    load: float,
    relative_speed: float,
    temperature: float,
) -> dict[str, jax.Array]:
    """Return by how much the traction at an inner ring grows with the slip of a ball
    that rolls in MIL-L-23699 without spin, `along` its way and `across` [N s/m].

    Args:
        ball_diameter, pitch_diameter: Diameters of ball and pitch circle [m].
        osculation: Groove radius over ball diameter [1].
        contact_angle: Contact angle [rad].
        load: Load of the contact [N].
        relative_speed: Speed of the ring less that of the orbit [rad/s].
        temperature: Temperature of the oil [K].
    """
    oil, modulus = mil_l_23699(), contact_modulus(Material(), Material())
    least = pitch_diameter - ball_diameter * np.cos(contact_angle)
    radius = jnp.asarray(0.5 * ball_diameter * least / pitch_diameter)
    across = jnp.asarray((2.0 - 1.0 / osculation) / ball_diameter)
    contact, pressed = ellipse(1.0 / radius, across, modulus), jnp.asarray(load)
    thin, coefficient = oil.viscosity(0.0, temperature), oil.pressure_coefficient
    given = 1.0 / contact.ratio, radius, modulus, thin, coefficient(temperature)
    film = point_film(pressed, *given).central(0.5 * relative_speed * least)
    peak = contact.peak_pressure(pressed)
    patch = ellipse_patch(oil, temperature, *contact.semi_axes(pressed), peak)
    # A Newtonian force grows evenly with the slip, which is 1 m/s here.
    law, slips = Newtonian(), jnp.eye(2)
    force = [law.resultants(patch, film, slip, 0.0).force for slip in slips]
    return {"along": -force[0][0], "across": -force[1][1]}

"""Rotors, vibration and noise."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....design import Material
from ....element.balls.ball_speed import EqualShare
from ....element.bearing_element import BearingElement
from ....element.inertia import Speed
from ....lubrication import mil_l_23699
from ....noise import (
    NoiseModel,
    natural_modes,
    waviness_force,
)
from ....numerics.power import positive_power
from ....rotor.nonlinear import (
    CubicExpansion,
    Grooves,
    Shooting,
    VibratingSystem,
    backbone,
)
from ....skid import SkidModel, steady
from ....statics.support import Support
from .direct import bearing_by

_TURN = 2.0 * np.pi


def waviness_lines(
    bearing: dict[str, Any], shaft_frequency: float, part: str, order: int
) -> dict[str, np.ndarray]:
    """Return the frequencies of force of one order of waviness [rad/s].

    Args:
        bearing: Its keywords.
        shaft_frequency: Turns of the inner ring per second, as an angular one [rad/s].
        part: "inner", "outer" or "element".
        order: Waves around the part.

    Returns:
        `axial` and `radial`: magnitudes, ascending, two each; NaN where there is none.
    """
    speed = Speed(inner=shaft_frequency)
    found = waviness_force(bearing_by(bearing), speed, part, order)

    def two(lines):
        lines = _TURN * np.sort(np.abs(np.asarray(lines)))
        return np.append(lines, [np.nan, np.nan])[:2]

    return {"axial": two(found.axial), "radial": two(found.radial)}


def ring_frequencies(
    bearing: dict[str, Any], ring_mass: float, load: float
) -> dict[str, float]:
    """Return the natural frequencies of an outer ring on its balls, along a radial load
    and across it, and the lowest and highest of those above both [Hz].

    Args:
        bearing: Its keywords; a ball stands in the line of the load.
        ring_mass: Mass that vibrates [kg].
        load: Radial load [N].
    """
    radial = [0.0, -load, 0.0, 0.0, 0.0, 0.0]
    element = BearingElement(bearing_by(bearing))
    model = NoiseModel(element, ring_mass, radial, Speed(), tilts=False)
    found = natural_modes(model)
    share = found.ring**2 * ring_mass

    def of(direction):
        mine = (np.argmax(share, axis=1) == direction) & (found.ring_share > 0.5)
        return float(found.frequency[mine][0])

    along, across = of(1), of(0)
    others = found.frequency[found.frequency > 1.01 * along]
    names = "along", "across", "ratio", "lowest other", "highest other"
    values = along, across, along / across, others.min(), others.max()
    return dict(zip(names, map(float, values), strict=True))


def _hertz_contact(q, velocity, phase, frequency):
    """Force of a Hertz contact under a load that it opens without."""
    return (positive_power(1.0 + q, 3, 2) - 1.0) / 1.5


def hertz_oscillator(largest: np.ndarray) -> dict[str, np.ndarray]:
    """Return frequency and least motion of free vibration on a Hertz contact,
    u'' + 2/3 ((1 + u)₊^1.5 - 1) = 0.

    Args:
        largest: Largest motion (n,) [1].
    """
    system = VibratingSystem(
        mass=np.eye(1),
        damping=np.zeros((1, 1)),
        gyroscopic=np.zeros((1, 1)),
        restoring=_hertz_contact,
        load=lambda phase, frequency, acceleration: jnp.zeros(1),
        scale=np.ones(1),
        reference_frequency=1.0,
    )
    found = backbone(system, largest, 0, Shooting(400))
    least = np.asarray(largest) - 2.0 * np.asarray(found.amplitude[:, 0])
    return {"frequency": np.asarray(found.frequency), "least": least}


def preloaded_grooves(elastic_modulus: float, **sizes: Any) -> dict[str, Any]:
    """Return preload and stiffness of a bearing whose radii press its balls.

    Args:
        elastic_modulus: Elastic modulus of balls and rings, whose Poisson's ratio is
            0.3 [Pa].
        sizes: Other fields of `Grooves`.

    Returns:
        `approach` [m], `constant` [N/m^1.5], `preload` [N], `displacement` that presses
        the rings [m], `reach` to which it may move across them [m], `radial` and
        `axial` stiffness [N/m], and the axial one where the contact angle follows the
        motion, over it, `stiffening` [1]; errors of the cubic expansion at 0.3, 0.5,
        0.8, 1 of `reach` across and at -0.9, -0.5, 0.5, 1 of `displacement` along [1].
    """
    bearing = Grooves(**sizes, material=Material(elastic_modulus, 0.3))
    law = bearing.fixed_angle()
    stiffness = np.asarray(law.stiffness())
    moving = np.asarray(bearing.moving_angle().stiffness())
    cubic, pressed = CubicExpansion.from_law(law), law.force(jnp.zeros(3))
    pressing = float(law.preload_displacement)
    reach = pressing * float(np.tan(bearing.contact_angle))
    across = np.outer([0.3, 0.5, 0.8, 1.0], [reach, 0.0, 0.0])
    along = np.outer([-0.9, -0.5, 0.5, 1.0], [0.0, 0.0, pressing])

    @jax.vmap
    def off(motion):
        return (cubic.force(motion) - pressed) / (law.force(motion) - pressed) - 1.0

    return {
        "reach": reach,
        "cubic, across": np.asarray(off(across))[:, 0],
        "cubic, along": np.asarray(off(along))[:, 2],
        "approach": float(bearing.approach),
        "constant": float(law.constant),
        "preload": float(law.preload()),
        "displacement": pressing,
        "radial": float(stiffness[0, 0]),
        "axial": float(stiffness[2, 2]),
        "stiffening": float(moving[2, 2] / stiffness[2, 2]),
    }


def skidding_balls(
    bearing: dict[str, Any],
    inner_speed: float,
    oil_temperature: float,
    axial_load: np.ndarray,
) -> dict[str, np.ndarray]:
    """Return where balls end under axial loads, their contact loads being those of pure
    rolling; the oil is MIL-L-23699, and there is no cage.

    Args:
        bearing: Its keywords.
        inner_speed: [rad/s].
        oil_temperature: [K].
        axial_load: (load,) [N].

    Returns:
        Of each load `slip` of the orbit and speed of the `orbit` over that of the ring
        [1], `spin` (tangential, radial, axial) and its `size` [rad/s], `pitch` of the
        spin axis [rad].
    """
    element = BearingElement(bearing_by(bearing), raceway_control=EqualShare())
    model = SkidModel(element, mil_l_23699(), oil_temperature)
    free, speed = ["ux", "uy", "uz", "gx", "gy"], Speed(inner=inner_speed)

    @jax.jit
    @jax.vmap
    def end(axial):
        load = jnp.zeros(6).at[2].set(axial)
        support = Support(free)
        found = steady(
            model, load, speed=speed, support=support, places=1, load_speed=speed
        )
        return {
            "slip": found.slip[0],
            "orbit": found.cage_speed / inner_speed,
            "spin": found.spin[0],
            "size": jnp.linalg.norm(found.spin[0]),
            "pitch": found.pitch_angle[0],
        }

    return jax.device_get(end(jnp.asarray(axial_load)))

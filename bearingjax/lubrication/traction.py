"""Traction: shear stress against slip, and what comes of it over a contact.

Slip is the speed of the body that is looked at (the ball) relative to the other one:
u_x + y·spin in rolling direction and u_y - x·spin across. A law gives the resistance
g ≥ 0 of the shear stress τ = -g u on that body, as a smooth function of |u|²: traction
never does work on the slip, and it is smooth where there is none.
"""

import abc
from typing import Annotated, ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design.checks import check_fields
from ..numerics.types import Number, Real, Scalar, as_real
from ..numerics.units import real, unit
from .patch import AbstractPatch

Points = Float[Array, "*n"]
"""Numbers at points of a contact."""
# Slip speed below which the empirical curve is linear [m/s].
_NO_SLIP = 1e-6


class Resultants(NamedTuple):
    """Traction of a whole contact on the body whose slip was given.

    Attributes:
        force: In rolling direction and across (2,) [N].
        moment: ∫(x τ_y - y τ_x) dA, about the axis from x to y [N m]. Against the sense
            of `spin`, whose slip (y, -x) turns from y to x: a positive spin has a
            positive moment.
        heat: Power turned to heat, -∫τ·u dA = spin·moment - force·slip [W].
    """

    force: Annotated[Float[Array, "2"], unit("N")]
    moment: Annotated[Scalar, unit("N m")]
    heat: Annotated[Scalar, unit("W")]


class AbstractTraction(eqx.Module):
    """A law of traction."""

    def __check_init__(self):
        check_fields(self)

    @abc.abstractmethod
    def resistance(
        self, slip_squared: Points, film: Scalar, pressure: Points, viscosity: Points
    ) -> Points:
        """Shear stress over slip speed, g in τ = -g u [Pa s/m].

        Args:
            slip_squared: Square of the slip speed [m²/s²].
            film: Film thickness, above 0 [m].
            pressure: Pressure [Pa].
            viscosity: Viscosity at that pressure [Pa s].
        """

    def stress(
        self, slip: Float[Array, "2"], film: Number, pressure: Number, viscosity: Number
    ) -> Float[Array, "2"]:
        """Shear stress on the body at a point [Pa].

        Args:
            slip: Slip of the body (2,) [m/s].
            film, pressure, viscosity: As in `resistance`.
        """
        given = (as_real(x) for x in (film, pressure, viscosity))
        return -self.resistance(jnp.dot(slip, slip), *given) * slip

    def resultants(
        self, patch: AbstractPatch, film: Number, slip: Float[Array, "2"], spin: Number
    ) -> Resultants:
        """Traction of the whole contact.

        Args:
            patch: Contact under its load.
            film: Film thickness, above 0 (see `at_least`), the same all over [m].
            slip: Slip in the middle, u_x and u_y (2,) [m/s].
            spin: Spin w of the slip (u_x + y w, u_y - x w) [rad/s].
        """
        turning = as_real(spin)
        at = patch.nodes(slip, turning)
        ux, uy = slip[0] + at.y * turning, slip[1] - at.x * turning
        squared = ux * ux + uy * uy
        resistance = at.area * self.resistance(
            squared, as_real(film), at.pressure, at.viscosity
        )
        return Resultants(
            force=-jnp.stack([jnp.sum(resistance * ux), jnp.sum(resistance * uy)]),
            moment=jnp.sum(resistance * (at.y * ux - at.x * uy)),
            heat=jnp.sum(resistance * squared),
        )


class Newtonian(AbstractTraction):
    """A film that is sheared evenly: τ = -μ(p) u/h.

    Linear in slip and spin, so that the moments of the viscosity are enough. Unphysical
    above some 1 GPa, where no oil bears μ u/h. Where pressure makes the oil a glass
    (3 GPa in the balls of a bearing beyond d_m n = 3e6 mm/min) torque and its
    derivatives are lost in round-off; the laws that yield have both right.
    """

    about: ClassVar[str] = "a film that is sheared evenly: τ = -μ(p) u/h"

    def resistance(
        self, slip_squared: Points, film: Scalar, pressure: Points, viscosity: Points
    ) -> Points:
        return viscosity / film

    def resultants(
        self, patch: AbstractPatch, film: Number, slip: Float[Array, "2"], spin: Number
    ) -> Resultants:
        spin = as_real(spin)
        total, first, polar = patch.moments / as_real(film)
        force = -jnp.stack([total * slip[0] + first * spin, total * slip[1]])
        moment = first * slip[0] + polar * spin
        return Resultants(force, moment, spin * moment - jnp.dot(force, slip))


class Eyring(AbstractTraction):
    """Oil that thins with shear: τ = τ_E asinh(μ u/(h τ_E)).

    Attributes:
        stress_scale: Eyring stress τ_E, 2 to 10 MPa for mineral oils [Pa].

    Traced: all fields.
    Source: Eyring (1936); Johnson & Tevaarwerk, Proc. Royal Society A 356 (1977).
    """

    about: ClassVar[str] = "oil that thins with shear: τ = τ_E asinh(μ u/(h τ_E))"
    stress_scale: Real = eqx.field(
        **real("Pa", "Eyring stress τ_E, 2 to 10 MPa for mineral oils", above=0),
        default=5e6,
    )

    def resistance(
        self, slip_squared: Points, film: Scalar, pressure: Points, viscosity: Points
    ) -> Points:
        newtonian = viscosity / film
        strain = newtonian / self.stress_scale
        return newtonian * _arsinh_over(strain * strain * slip_squared)


class LimitingStress(AbstractTraction):
    """Oil that yields: τ = (μ u/h)/sqrt(1 + (u² + u_c²) [μ/(h τ_L)]²), τ_L = τ_0 + Λ p.

    Without u_c the slip at which it yields, h τ_L/μ, vanishes where pressure makes a
    glass of the oil, and a bearing at rest sticks. In truth its surfaces then creep
    elastically, by some thousandths of their speed.

    Attributes:
        slope: Λ, the traction coefficient of a plastic film [1].
        ambient: Limiting stress without pressure, τ_0 [Pa].
        creep: Least slip at which the stress has reached 0.71 τ_L, u_c [m/s].

    Traced: all fields.
    Source: limiting stress proportional to pressure: Bair & Winer, J. Lubrication
        Technology 101 (1979) 258-265; the smooth transition is the circle of Lee &
        Hamrock (1990).
    """

    about: ClassVar[str] = "oil that yields at τ_L = τ_0 + Λ p"
    slope: Real = eqx.field(
        **real("1", "Λ, the traction coefficient of a plastic film", least=0),
        default=0.05,
    )
    ambient: Real = eqx.field(
        **real("Pa", "limiting stress without pressure, τ_0", above=0), default=1e5
    )
    creep: Real = eqx.field(
        **real(
            "m/s", "least slip at which the stress has reached 0.71 τ_L, u_c", least=0
        ),
        default=1e-5,
    )

    def resistance(
        self, slip_squared: Points, film: Scalar, pressure: Points, viscosity: Points
    ) -> Points:
        newtonian = viscosity / film
        strain = newtonian / (self.ambient + self.slope * pressure)
        least = slip_squared + self.creep * self.creep
        return newtonian / jnp.sqrt(1.0 + strain * strain * least)


class SlipCurve(AbstractTraction):
    """Measured traction: τ = p [far (1 - exp(-C u)) + B u exp(-C u)].

    Rises by far·C + B per slip speed, may pass a maximum, and ends at `far`.

    Attributes:
        far: Traction coefficient at large slip [1].
        rise: B [s/m].
        decay: C [s/m].

    Traced: all fields.
    Source: Gupta, Advanced Dynamics of Rolling Elements (1984), (A + B u) exp(-C u) + D
        with far = D = -A, so that it starts at zero.
    """

    about: ClassVar[str] = "measured: τ = p [far (1 - exp(-C u)) + B u exp(-C u)]"
    far: Real = eqx.field(**real("1", "traction coefficient at large slip", least=0))
    rise: Real = eqx.field(
        **real("s/m", "B, rise of the coefficient with the slip", least=0)
    )
    decay: Real = eqx.field(**real("s/m", "C, decay of that rise", above=0))

    def resistance(
        self, slip_squared: Points, film: Scalar, pressure: Points, viscosity: Points
    ) -> Points:
        speed = jnp.sqrt(slip_squared + _NO_SLIP**2)
        exponent = -self.decay * speed
        begun = -self.far * jnp.expm1(exponent) / speed
        return pressure * (begun + self.rise * jnp.exp(exponent))


class DryFriction(AbstractTraction):
    """Coulomb's friction, τ = f p u/sqrt(u² + creep²), linear at slips below `creep`.

    Attributes:
        friction: Coefficient of friction f [1].
        creep: Slip speed at which it has reached 0.71 f [m/s].

    Traced: all fields.
    """

    about: ClassVar[str] = "Coulomb's friction, τ = f p u/sqrt(u² + creep²)"
    friction: Real = eqx.field(
        **real("1", "coefficient of friction f", least=0), default=0.1
    )
    creep: Real = eqx.field(
        **real("m/s", "slip speed at which it has reached 0.71 f", above=0),
        default=1e-3,
    )

    def resistance(
        self, slip_squared: Points, film: Scalar, pressure: Points, viscosity: Points
    ) -> Points:
        speed = jnp.sqrt(slip_squared + self.creep * self.creep)
        return self.friction * pressure / speed


def _arsinh_over(square):
    """asinh(z)/z of z², smooth at z = 0."""
    small = square < 1e-2
    z = jnp.sqrt(jnp.where(small, 1.0, square))
    w = jnp.where(small, square, 0.0)
    series = jnp.ones_like(w)
    for ratio in (169 / 210, 121 / 156, 81 / 110, 49 / 72, 25 / 42, 9 / 20, 1 / 6):
        series = 1.0 - ratio * w * series
    return jnp.where(small, series, jnp.arcsinh(z) / z)

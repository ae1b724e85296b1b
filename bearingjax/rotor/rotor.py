"""Rotor of shaft, discs and supports, assembled as matrices."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Complex, Float

from ..design.checks import all_of_class, flag, instance
from ..numerics.compiled.programs import program
from ..numerics.types import Scalar, as_real
from ..numerics.units import meaning
from ..numerics.warning import Warning
from .damping import AbstractDamping
from .like_parts import map_parts
from .parts import AbstractPart, AbstractSupport
from .shaft import STATION_FREEDOMS, Shaft

Matrix = Float[Array, "freedom freedom"]
N_STATION = len(STATION_FREEDOMS)
N_HOUSING = 3


def as_parts(parts: Any) -> tuple:
    """Converter: one part, or several, as a tuple."""
    return tuple(parts) if isinstance(parts, Iterable) else (parts,)


class RotorMatrices(eqx.Module):
    """A linear rotor at one speed Ω: M q'' + (C + Ω G) q' + K q = F.

    Attributes:
        mass: M (freedom, freedom) [kg, kg m, kg m²].
        damping: C (freedom, freedom) [N s/m, N s, N m s].
        gyroscopic: G (freedom, freedom), skew [kg, kg m, kg m²].
        stiffness: K (freedom, freedom) [N/m, N, N m].
        motions: Motions per freedom q (motion, freedom): (ux uy uz gx gy) of every
            node, then (ux uy uz) of every housing [m, rad].
        speed: Ω, positive from x towards y [rad/s].
        length: Length of the shaft, by which tilts are compared with displacements [m].
        n_nodes: Number of nodes of the shaft.
    """

    mass: Matrix
    damping: Matrix
    gyroscopic: Matrix
    stiffness: Matrix
    motions: Float[Array, "motion freedom"]
    speed: Scalar
    length: Scalar
    n_nodes: int = eqx.field(static=True)

    @property
    def rates(self) -> Matrix:
        """C + Ω G, the coefficient of the velocity."""
        return self.damping + self.speed * self.gyroscopic

    def dynamic_stiffness(
        self, eigenvalue: Complex[Array, ""]
    ) -> Complex[Array, "freedom freedom"]:
        """Return λ² M + λ (C + Ω G) + K: force over a motion proportional to exp(λ t).

        Args:
            eigenvalue: λ [rad/s].
        """
        mass, rates, stiffness = (
            lax.complex(part, jnp.zeros_like(part))
            for part in (self.mass, self.rates, self.stiffness)
        )
        return eigenvalue**2 * mass + eigenvalue * rates + stiffness

    def project(self, basis: Float[Array, "freedom fewer"]) -> "RotorMatrices":
        """Return the rotor reduced to motions q = basis · p, with freedoms p."""

        def reduce(matrix):
            return basis.T @ matrix @ basis

        return RotorMatrices(
            reduce(self.mass),
            reduce(self.damping),
            reduce(self.gyroscopic),
            reduce(self.stiffness),
            self.motions @ basis,
            self.speed,
            self.length,
            self.n_nodes,
        )

    def split(self, motion: Any) -> tuple[Any, Any]:
        """Split motions (..., motion) into nodes (..., node, 5) and housings."""
        n, lead = N_STATION * self.n_nodes, motion.shape[:-1]
        nodes = motion[..., :n].reshape(*lead, self.n_nodes, N_STATION)
        return nodes, motion[..., n:].reshape(*lead, -1, N_HOUSING)


class UnsupportedMatrices(NamedTuple):
    """Matrices on all motions (motion, motion) of a rotor without its supports.

    Attributes:
        mass, damping, gyroscopic, stiffness: Matrices of shaft, discs and housings, as
            in `RotorMatrices`.
        shaft_mass, shaft_stiffness: Matrices of the shaft alone.
    """

    mass: Matrix
    damping: Matrix
    gyroscopic: Matrix
    stiffness: Matrix
    shaft_mass: Matrix
    shaft_stiffness: Matrix


class Rotor(eqx.Module):
    """Rotor: a shaft with discs and supports.

    Attributes:
        shaft: The shaft.
        discs: Discs and point masses.
        supports: Supports; with a housing each has three freedoms more.
        damping: Damping besides that of the supports; `None`: none.
        rigid: Whether the shaft cannot bend or stretch. It then has five freedoms,
            its rigid motion (ux uy uz gx gy) at z = 0.

    Traced: all but `rigid` and the station numbers.
    """

    shaft: Shaft
    discs: tuple[AbstractPart, ...] = eqx.field(converter=as_parts, default=())
    supports: tuple[AbstractSupport, ...] = eqx.field(converter=as_parts, default=())
    damping: AbstractDamping | None = None
    rigid: bool = eqx.field(
        static=True, default=False, metadata=meaning("whether the shaft does not bend")
    )

    def __check_init__(self):
        instance(self, "shaft", Shaft)
        instance(self, "damping", AbstractDamping, None)
        flag(self, "rigid", self.rigid)
        last = self.shaft.n_segments
        kinds = (("discs", AbstractPart), ("supports", AbstractSupport))
        for name, kind in kinds:
            words = "discs or point masses" if name == "discs" else name
            all_of_class(self, name, getattr(self, name), kind, words)
            for part in getattr(self, name):
                if part.station > last:
                    raise ValueError(
                        f"Rotor: `{name}` holds a {type(part).__name__} on station"
                        f" {part.station}; the last station of the shaft is {last}."
                    )

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about its discs; empty where their numbers are traced."""
        return tuple(one for disc in self.discs for one in disc.warnings)

    @property
    def mass(self) -> Scalar:
        """Mass of shaft, discs and point masses, without housings [kg]."""
        return sum((part.mass for part in self.discs), start=self.shaft.mass)

    def slice_at(self, station: int) -> slice:
        """Return the slice of the five motions of a station in all motions.

        Args:
            station: Number of the station.
        """
        first = N_STATION * self.shaft.node(station)
        return slice(first, first + N_STATION)

    def motions(self) -> Float[Array, "motion freedom"]:
        """Motions of every node, then every housing, per freedom [m, rad]."""
        if not self.rigid:
            return jnp.eye(self._n_motions, dtype=self.shaft.stations.dtype)
        z = self.shaft.nodes
        n = z.shape[0]
        bodies = jnp.tile(jnp.eye(N_STATION, dtype=z.dtype), (n, 1, 1))
        # Displacement of the point (0, 0, z): u + g x r.
        bodies = bodies.at[:, 0, 4].set(z).at[:, 1, 3].set(-z)
        turned = bodies.reshape(N_STATION * n, N_STATION)
        n_more = self._n_motions - N_STATION * n
        full = jnp.zeros((self._n_motions, N_STATION + n_more), dtype=z.dtype)
        full = full.at[: N_STATION * n, :N_STATION].set(turned)
        return full.at[N_STATION * n :, N_STATION:].set(jnp.eye(n_more, dtype=z.dtype))

    def at_supports(self) -> Float[Array, "support 5 motion"]:
        """Return motions of supported stations less their housings, from all motions.

        The force of a support acts on the rotor through the transpose.
        """
        rows = np.zeros((len(self.supports), N_STATION, self._n_motions))
        for row, support, housing in zip(
            rows, self.supports, self._housings(), strict=True
        ):
            row[:, self.slice_at(support.station)] = np.eye(N_STATION)
            if housing is not None:
                row[:N_HOUSING, housing] = -np.eye(N_HOUSING)
        return as_real(rows).astype(self.shaft.stations.dtype)

    @property
    def _n_motions(self) -> int:
        housings = sum(support.housing is not None for support in self.supports)
        return N_STATION * self.shaft.n_nodes + N_HOUSING * housings

    def _housings(self):
        """Yield the slice of each support's housing in all motions; `None`: none."""
        first = N_STATION * self.shaft.n_nodes
        for support in self.supports:
            if support.housing is None:
                yield None
            else:
                yield slice(first, first + N_HOUSING)
                first += N_HOUSING

    def linearise(
        self, speed: Any = 0.0, motion: Float[Array, " motion"] | None = None
    ) -> RotorMatrices:
        """Return the rotor as matrices, linearised.

        Args:
            speed: Speed of the rotor, positive from x towards y [rad/s].
            motion: Motion of nodes and housings, about which supports are linearised
                [m, rad]; zero unless given.

        Returns:
            RotorMatrices, differentiable with respect to every number.
        """
        return _linearise(self, as_real(speed), motion)

    @eqx.filter_jit
    def unsupported_matrices(self) -> "UnsupportedMatrices":
        """Return matrices on all motions without supports and `damping`."""
        n_shaft, n = N_STATION * self.shaft.n_nodes, self._n_motions
        nothing = jnp.zeros((n, n), dtype=self.shaft.stations.dtype)

        def of_all(matrix):
            return nothing.at[:n_shaft, :n_shaft].set(matrix)

        shaft_mass, gyroscopic, shaft_stiffness = map(of_all, self.shaft.matrices())
        if self.rigid:
            shaft_stiffness = nothing
        mass, stiffness, damping = shaft_mass, shaft_stiffness, nothing
        for disc in self.discs:
            at = self.slice_at(disc.station)
            inertia, turning = disc.inertia()
            mass = mass.at[at, at].add(inertia)
            gyroscopic = gyroscopic.at[at, at].add(turning)
        for support, at in zip(self.supports, self._housings(), strict=True):
            base = support.housing
            if base is not None:
                mass = mass.at[at, at].add(base.mass * jnp.eye(N_HOUSING))
                stiffness = stiffness.at[at, at].add(base.stiffness)
                damping = damping.at[at, at].add(base.damping)
        return UnsupportedMatrices(
            mass, damping, gyroscopic, stiffness, shaft_mass, shaft_stiffness
        )


@program(quick=True)
def _linearise(rotor, speed, motion):
    return matrices_about(rotor, speed, motion)


def matrices_about(
    rotor: Rotor,
    speed: Scalar,
    motion: Float[Array, " motion"] | None,
    *,
    supported: bool = True,
) -> RotorMatrices:
    """Return the rotor as matrices; compiled by the caller.

    Args:
        rotor: The rotor.
        speed: Its speed, positive from x towards y [rad/s].
        motion: Motion of nodes and housings, as in `Rotor.linearise` [m, rad].
        supported: Whether its supports count. Modal damping takes them along anyway.
    """
    own, basis, shaft = rotor.unsupported_matrices(), rotor.motions(), rotor.shaft
    every = jnp.eye(basis.shape[0], dtype=basis.dtype)
    if motion is None:
        motion = jnp.zeros_like(every[0])
    length = shaft.stations[-1] - shaft.stations[0]

    def matrices(damping, stiffness):
        whole = own.mass, damping, own.gyroscopic, stiffness, every
        found = RotorMatrices(*whole, speed, length, shaft.n_nodes)
        return found.project(basis) if rotor.rigid else found

    free = held = matrices(own.damping, own.stiffness)
    if rotor.supports and (supported or rotor.damping is not None):
        rows = rotor.at_supports()
        k, c = map_parts(
            lambda support, moved: support.linearise(moved, speed),
            rotor.supports,
            rows @ motion,
        )
        more = [jnp.einsum("sim,sij,sjn->mn", rows, part, rows) for part in (c, k)]
        held = matrices(own.damping + more[0], own.stiffness + more[1])
    found = held if supported else free
    if rotor.damping is None:
        return found
    of_shaft = own.shaft_mass, own.shaft_stiffness
    if rotor.rigid:
        mass, stiffness = (basis.T @ part @ basis for part in of_shaft)
        of_shaft = mass, stiffness
    more = rotor.damping.matrix(of_shaft, (held.mass, held.stiffness))
    return eqx.tree_at(lambda m: m.damping, found, found.damping + more)

"""The shaft of a rotor: stations, segments, and Timoshenko beam elements between them.

The bearing axis z is the shaft axis. A cross-section has five freedoms in the order of
the rings, (ux uy uz gx gy); it does not twist. A straight shaft that tilts by gy moves
along x, dux/dz = gy; one that tilts by gx moves against y, duy/dz = -gx.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..catalogue.entry import SAME_SIZE, CatalogueEntry
from ..design.checks import (
    check,
    count,
    finite,
    is_traced,
    must_be,
    of_shape,
    real_numbers,
)
from ..design.material import Material
from ..element.frame import FREEDOMS, LOADS, MOTION_UNITS
from ..fits import Mounting
from ..numerics.labels import name_axis
from ..numerics.types import Scalar, array_namespace, as_count, as_real
from ..numerics.units import unit
from ..numerics.warning import Warning

STATION_FREEDOMS = name_axis("station_freedom", FREEDOMS[:5])
name_axis("moved_station_freedom", STATION_FREEDOMS)
name_axis("station_component", LOADS[:5])
STATION_UNITS = MOTION_UNITS[:5]
"""Freedoms of a cross-section, and of every station."""

Matrices = tuple[
    Float[Array, "*element 10 10"],
    Float[Array, "*element 10 10"],
    Float[Array, "*element 10 10"],
]
"""Mass, gyroscopic and stiffness matrix."""


class Shaft(eqx.Module):
    """Shaft of cylindrical segments, solid or hollow.

    A segment lies between two neighbouring stations and is divided into elements. A
    disc, a support or an unbalance sits on a station, named by its number from 0; the
    numbers stay the same whatever the division.

    Attributes:
        stations: Axial positions, rising (station,) [m].
        outer_diameter: Outer diameter of each segment (segment,) [m]; one number serves
            all.
        bore: Diameter of the hole of each segment (segment,) [m]; zero: solid.
        material: Material of all segments, or a tuple with one for each.
        divisions: Elements of each segment (segment,); one number serves all.

    Traced: all fields but `divisions`.

    Left out: torsion, the stiffness that an axial load or a torque adds or takes, and
    the damping of the shaft (`Rotor` has it).
    """

    stations: Float[Array, " station"] = eqx.field(metadata=unit("m"))
    outer_diameter: Float[Array, " segment"] = eqx.field(metadata=unit("m"))
    bore: Float[Array, " segment"] = eqx.field(metadata=unit("m"))
    material: Material | tuple[Material, ...]
    divisions: tuple[int, ...] = eqx.field(static=True)

    def __init__(
        self,
        stations: Any,
        outer_diameter: Any,
        bore: Any = 0.0,
        material: Material | tuple[Material, ...] | None = None,
        divisions: Any = 1,
    ):
        for name, value in (
            ("stations", stations),
            ("outer_diameter", outer_diameter),
            ("bore", bore),
        ):
            real_numbers("Shaft", name, value, "numbers in m")
        self.stations = as_real(stations)
        several = self.stations.ndim == 1 and self.stations.size > 1
        allowed = "a list of two or more positions in m"
        of_shape("Shaft", "stations", several, allowed, self.stations)
        self.outer_diameter = self._of_segments("outer_diameter", outer_diameter)
        self.bore = self._of_segments("bore", bore)
        self.material = Material() if material is None else material
        many = isinstance(divisions, tuple | list | np.ndarray)
        counts = divisions if many else (divisions,) * self.n_segments
        self.divisions = tuple(as_count(n) for n in counts)

    def _of_segments(self, name, value):
        value = as_real(value)
        n = self.n_segments
        allowed = f"one number or {n}, one for each segment between two stations, in m"
        of_shape("Shaft", name, value.shape in ((), (n,)), allowed, value)
        return jnp.broadcast_to(value, (n,))

    def __check_init__(self):
        n = self.n_segments
        for name in ("stations", "outer_diameter", "bore"):
            finite(self, name)
        if not is_traced(self.stations):
            rising = np.diff(self.stations) > 0
            check(self, "stations", rising, "rising from each to the next")
        if not is_traced(self.outer_diameter):
            check(
                self, "outer_diameter", np.asarray(self.outer_diameter) > 0, "above 0 m"
            )
        if not is_traced(self.bore):
            check(self, "bore", np.asarray(self.bore) >= 0, "at least 0 m")
            if not is_traced(self.outer_diameter):
                inside = np.asarray(self.bore) < np.asarray(self.outer_diameter)
                check(self, "bore", inside, "below the outer diameter of its segment")
        materials = self.material
        listed = materials if isinstance(materials, tuple) else (materials,) * n
        fits = len(listed) == n and all(isinstance(m, Material) for m in listed)
        allowed = f"a Material, or a tuple of {n}, one for each segment"
        must_be(self, "material", materials, fits, allowed, TypeError)
        if len(self.divisions) != n:
            raise ValueError(
                f"Shaft: `divisions` has {len(self.divisions)} numbers; it must be one,"
                f" or {n}, one for each segment."
            )
        for number in self.divisions:
            count(self, "divisions", number)

    @property
    def n_segments(self) -> int:
        """Number of segments."""
        return self.stations.shape[0] - 1

    @property
    def n_nodes(self) -> int:
        """Number of nodes: ends of elements, the stations among them."""
        return sum(self.divisions) + 1

    def node(self, station: int) -> int:
        """Return the number of the node at a station."""
        return sum(self.divisions[:station])

    @property
    def nodes(self) -> Float[Array, " node"]:
        """Axial positions of all nodes [m]."""
        shares = np.concatenate([np.arange(n) / n for n in self.divisions] + [[1.0]])
        segment = np.append(self._segment, self.n_segments - 1)
        share = as_real(shares)
        first, last = self.stations[segment], self.stations[segment + 1]
        return (1.0 - share) * first + share * last

    @property
    def mass(self) -> Scalar:
        """Mass [kg]."""
        return self.element_masses().sum()

    def element_masses(self) -> Float[Array | np.ndarray, " element"]:
        """Return the mass of each beam element [kg]."""
        _, _, density = self._material_numbers()
        area = 0.25 * jnp.pi * (self.outer_diameter**2 - self.bore**2)
        whole = density * area * (self.stations[1:] - self.stations[:-1])
        return (whole / np.array(self.divisions, whole.dtype))[self._segment]

    @property
    def _segment(self) -> np.ndarray:
        """Index of the segment of each element."""
        return np.repeat(np.arange(self.n_segments), self.divisions)

    def _material_numbers(self):
        """Return modulus, Poisson's ratio and density of each segment."""
        given = self.material
        listed = given if isinstance(given, tuple) else (given,) * self.n_segments
        names = "elastic_modulus", "poisson_ratio", "density"
        every = ([getattr(material, name) for material in listed] for name in names)
        return tuple(array_namespace(*each).stack(each) for each in every)

    def matrices(self) -> tuple[Array, Array, Array]:
        """Return mass, gyroscopic and stiffness matrix of the free shaft.

        Returns:
            Three matrices (5 node, 5 node), node after node; the gyroscopic one is
            that of a speed of 1 rad/s.
        """
        segment = self._segment
        length = jnp.diff(self.stations)[segment] / as_real(self.divisions)[segment]
        section = (self.outer_diameter, self.bore, *self._material_numbers())
        elements = jax.vmap(element_matrices)(
            length, *(part[segment] for part in section)
        )
        place = 5 * np.arange(len(segment))[:, None] + np.arange(10)
        nothing = jnp.zeros((5 * self.n_nodes,) * 2, dtype=length.dtype)
        rows, columns = place[:, :, None], place[:, None, :]
        mass, gyroscopic, stiffness = elements

        def assemble(parts: Array) -> Array:
            return nothing.at[rows, columns].add(parts)

        return assemble(mass), assemble(gyroscopic), assemble(stiffness)


def seat_size_warnings(
    shaft: Shaft, station: int, seat: Mounting | CatalogueEntry
) -> list[Warning]:
    """Warnings about a seat of other diameters than the shaft has there.

    Args:
        shaft: The shaft.
        station: Its station with the bearing; either segment there may fit.
        seat: Seats of the bearing, whose bore and hollow shaft count, or its entry of
            the catalogue, whose bore counts.
    """
    segments = [k for k in (station - 1, station) if 0 <= k < shaft.n_segments]
    diameters = np.stack([np.asarray(shaft.outer_diameter), np.asarray(shaft.bore)])
    there = diameters[:, segments].T
    if isinstance(seat, Mounting):
        wanted = np.array([float(seat.bore), float(seat.shaft_bore)])
        has = (
            f"its fit has a shaft of {1e3 * wanted[0]:.5g} mm with a bore of"
            f" {1e3 * wanted[1]:.5g} mm (`shaft_bore`)"
        )
        sizes = " or ".join(f"{1e3 * a:.5g} and {1e3 * b:.5g}" for a, b in there)
    else:
        wanted, there = np.array([seat.bore]), there[:, :1]
        has = f"{seat.designation} has a bore of {1e3 * seat.bore:.5g} mm"
        sizes = " or ".join(f"{1e3 * size:.5g}" for size in dict.fromkeys(there[:, 0]))
    if (np.abs(there - wanted) < SAME_SIZE * wanted[0]).all(axis=1).any():
        return []
    words = f"{has}; at station {station} the shaft has {sizes} mm"
    return [Warning("seat_size", words, where=f"station {station}")]


def shear_coefficient(bore_ratio: Scalar, poisson_ratio: Scalar) -> Scalar:
    """Return Timoshenko's shear coefficient of a solid or hollow circle [1].

    Args:
        bore_ratio: Bore over outer diameter [1].
        poisson_ratio: Poisson's ratio [1].

    Source: Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech.
        33 (1966) 335-340, table 1.
    """
    square = bore_ratio**2
    full = (7.0 + 6.0 * poisson_ratio) * (1.0 + square) ** 2
    hole = (20.0 + 12.0 * poisson_ratio) * square
    return 6.0 * (1.0 + poisson_ratio) * (1.0 + square) ** 2 / (full + hole)


def element_matrices(
    length: Scalar,
    outer_diameter: Scalar,
    bore: Scalar,
    elastic_modulus: Scalar,
    poisson_ratio: Scalar,
    density: Scalar,
) -> Matrices:
    """Return mass, gyroscopic and stiffness matrix of one cylindrical element.

    Bending with shear, rotary inertia and gyroscopic moments in both planes, and
    stretching, from the energies of the motion that the ends impose on an element
    without load between them: exact under end loads, and mass matrices that go with
    it.

    Args:
        length, outer_diameter, bore: Sizes [m].
        elastic_modulus: Young's modulus [Pa].
        poisson_ratio: Poisson's ratio [1].
        density: Density [kg/m³].

    Returns:
        Three matrices (10, 10), freedoms (ux uy uz gx gy) of the end at smaller z,
        then of the other; the gyroscopic one at 1 rad/s, positive from x towards y.

    Source: shapes of Przemieniecki, Theory of Matrix Structural Analysis (1968), and
        Friswell et al., Dynamics of Rotating Machines (2010), sec. 5.4, here with the
        tilts of the library.
    """
    area = 0.25 * jnp.pi * (outer_diameter**2 - bore**2)
    inertia = jnp.pi / 64.0 * (outer_diameter**4 - bore**4)
    shear_modulus = 0.5 * elastic_modulus / (1.0 + poisson_ratio)
    kappa = shear_coefficient(bore / outer_diameter, poisson_ratio)
    bending, shearing = elastic_modulus * inertia, kappa * shear_modulus * area
    deflection, slope, curvature, shear, weight = _shapes(
        length, 12.0 * bending / (shearing * length**2)
    )

    def integral(a, b):
        return length * jnp.einsum("p,pi,pj->ij", weight, a, b)

    turning = density * inertia * integral(slope, slope)
    moving = density * area * integral(deflection, deflection)
    bent = bending * integral(curvature, curvature) + shearing * integral(shear, shear)
    dtype = length.dtype
    stretched = elastic_modulus * area / length * jnp.array([[1, -1], [-1, 1]], dtype)
    axial = density * area * length / 6.0 * jnp.array([[2, 1], [1, 2]], dtype)
    x, y, z = (jnp.asarray(plane, dtype) for plane in _PLANES)
    mass = x.T @ (moving + turning) @ x + y.T @ (moving + turning) @ y + z.T @ axial @ z
    # Moments 2 ρ I Ω (d gy/dt, -d gx/dt) per length; the slope in y is -gx.
    gyroscopic = 2.0 * (x.T @ turning @ y - y.T @ turning @ x)
    stiffness = x.T @ bent @ x + y.T @ bent @ y + z.T @ stretched @ z
    return mass, gyroscopic, stiffness


def _planes():
    """Return freedoms of an element in bending in x and in y, and in tension."""
    x, y, z = np.zeros((4, 10)), np.zeros((4, 10)), np.zeros((2, 10))
    x[range(4), [0, 4, 5, 9]] = 1.0
    y[range(4), [1, 3, 6, 8]] = [1.0, -1.0, 1.0, -1.0]
    z[range(2), [2, 7]] = 1.0
    return x, y, z


_PLANES = _planes()


def _shapes(length, phi):
    """Return deflection, slope, curvature and shear of a bent element, and weights.

    Each (point, 4), for deflection and slope at either end, at the nodes of a Gauss
    rule that integrates their products exactly.

    Args:
        length: Length of the element [m].
        phi: 12 E I/(κ G A L²), its softness in shear over that in bending [1].
    """
    nodes, weights = np.polynomial.legendre.leggauss(4)
    s = jnp.asarray(0.5 * (1.0 + nodes), dtype=length.dtype)
    weight = jnp.asarray(0.5 * weights, dtype=length.dtype)
    one, rest = jnp.ones_like(s), s * (1.0 - s)

    def rows(*columns):
        return jnp.stack(columns, axis=-1) / (1.0 + phi)

    deflection = rows(
        (1.0 - s) * (1.0 + s - 2.0 * s**2 + phi),
        length * rest * (1.0 - s + 0.5 * phi),
        s * (s * (3.0 - 2.0 * s) + phi),
        -length * rest * (s + 0.5 * phi),
    )
    slope = rows(
        -6.0 * rest / length,
        (1.0 - s) * (1.0 - 3.0 * s + phi),
        6.0 * rest / length,
        s * (3.0 * s - 2.0 + phi),
    )
    curvature = rows(
        -6.0 * (1.0 - 2.0 * s) / length**2,
        (6.0 * s - 4.0 - phi) / length,
        6.0 * (1.0 - 2.0 * s) / length**2,
        (6.0 * s - 2.0 + phi) / length,
    )
    shear = rows(
        -phi / length * one, -0.5 * phi * one, phi / length * one, -0.5 * phi * one
    )
    return deflection, slope, curvature, shear, weight

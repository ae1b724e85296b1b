"""Sets of bearings: rows side by side on one shaft, in one housing."""

from collections.abc import Iterable
from typing import Any

import equinox as eqx
import jax.numpy as jnp

from ..numerics.shown import Printable
from ..numerics.types import Number, Real, Scalar, array_namespace, as_real, with_fields
from ..numerics.units import meaning, real
from ..numerics.warning import Warning
from .abstract import AbstractBearing
from .ball_types import DoubleRowBallRow
from .barrel import CrossedRollerRow
from .checks import (
    all_of_class,
    flag,
    floats,
    instance,
    non_negative,
    number,
    of_class,
    positive,
)
from .checks import count as whole
from .overlap import overlap


class PreloadSpring(Printable):
    """Spring that preloads one row of a set, by sliding one of its rings axially.

    Attributes:
        force: Spring force at the place where the row just touches [N].
        stiffness: Loss of force per travel that closes the row [N/m]; zero: a
            constant force.

    The spring only pushes: beyond a travel of force/stiffness it is slack. In the
    other direction there is no stop. Mounted, it presses with a little less than
    `force`, because the row closes elastically under it.

    Traced: all fields.
    """

    force: Real = eqx.field(
        **real("N", "force of the spring that preloads, where the row just touches")
    )
    stiffness: Real = eqx.field(
        **real("N/m", "force that it loses per travel"), default=0.0
    )

    def __check_init__(self):
        positive(self, "force")
        non_negative(self, "stiffness")

    def push(self, travel: Scalar) -> tuple[Scalar, Scalar, Scalar]:
        """Energy [J], force [N] and its loss per travel [N/m] at a travel [m].

        The energy is minus the work done on the row.
        """
        soft = self.stiffness == 0
        slack = (travel * self.stiffness > self.force) & ~soft
        full = self.force / jnp.where(soft, 1.0, self.stiffness)
        until = jnp.where(slack, full, travel)
        energy = -(self.force - 0.5 * self.stiffness * until) * until
        force = jnp.where(slack, 0.0, self.force - self.stiffness * travel)
        return energy, force, jnp.where(slack, 0.0, self.stiffness)


class SetRow(Printable):
    """One row of a set.

    Attributes:
        bearing: The single-row bearing.
        position: z of its origin in the set [m].
        mirrored: Whether it is turned round: it then carries an inner-ring load
            along -z.
        inner_offset: Axial offset of its inner ring against its outer ring from their
            places in the single bearing, along +z of the set [m]: the preload by
            ground rings or by spacers.
        spring: Spring that preloads the row; its ring then slides on its seat, by a
            travel that follows from equilibrium, added to `inner_offset`.

    Traced: position, inner_offset, spring.
    """

    bearing: AbstractBearing
    position: Real = eqx.field(**real("m", "place along the axis"), default=0.0)
    mirrored: bool = eqx.field(
        static=True, default=False, metadata=meaning("whether it is turned round")
    )
    inner_offset: Real = eqx.field(
        **real(
            "m",
            "axial offset of the inner ring against the outer one: preload by ground"
            " rings",
        ),
        default=0.0,
    )
    spring: PreloadSpring | None = None

    def __check_init__(self):
        row = "a single-row roller or ball bearing"
        of_class(self, "bearing", self.bearing, AbstractBearing, row)
        flag(self, "mirrored", self.mirrored)
        number(self, "position")
        number(self, "inner_offset")
        instance(self, "spring", PreloadSpring, None)


def _as_tuple(rows):
    return tuple(rows) if isinstance(rows, Iterable) else rows


class BearingSet(Printable):
    """Rows of which all inner rings move together, and all outer rings.

    Motions and loads of both are taken at the node, z = 0 of the set. Rows may differ
    in everything but must be all of balls or all of rollers.

    Attributes:
        rows: The rows, in any order.

    Raises:
        ValueError: For an empty set or one of balls and rollers.
    """

    rows: tuple[SetRow, ...] = eqx.field(converter=_as_tuple)

    @property
    def noun(self) -> str:
        """The rolling elements: "ball" or "roller"."""
        return self.rows[0].bearing.noun

    @property
    def is_ball(self) -> bool:
        """Whether the rolling elements are balls."""
        return self.rows[0].bearing.is_ball

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings about the design of its rows, each once."""
        every = (one for row in self.rows for one in row.bearing.warnings)
        return tuple(dict.fromkeys(every))

    @classmethod
    def back_to_back(
        cls,
        bearing: AbstractBearing,
        spacing: Number,
        preload_offset: Number = 0.0,
        spring: PreloadSpring | None = None,
    ) -> "BearingSet":
        """Pair in O arrangement (DB): stiff against tilting.

        Args:
            bearing: Either bearing of the pair.
            spacing: Distance of the middles of the rows [m].
            preload_offset: Axial approach of the inner rings, half of it for each row
                [m]: the whole gap that the nut closes.
            spring: Spring that presses the row at +z.

        Raises:
            ValueError: If `spacing` is not positive.
        """
        return cls._pair(bearing, spacing, preload_offset, spring, (False, True))

    @classmethod
    def face_to_face(
        cls,
        bearing: AbstractBearing,
        spacing: Number,
        preload_offset: Number = 0.0,
        spring: PreloadSpring | None = None,
    ) -> "BearingSet":
        """Pair in X arrangement (DF): tolerates misalignment.

        Args:
            bearing, spacing, spring: As in `back_to_back`.
            preload_offset: Axial approach of the outer rings, half of it for each row
                [m].

        Raises:
            ValueError: If `spacing` is not positive.
        """
        return cls._pair(bearing, spacing, preload_offset, spring, (True, False))

    @classmethod
    def tandem(
        cls, bearing: AbstractBearing, spacing: Number, count: int = 2
    ) -> "BearingSet":
        """Rows that share an axial load along +z.

        Args:
            bearing: Any of the bearings.
            spacing: Distance of the middles of neighbouring rows [m].
            count: Number of rows.

        Raises:
            ValueError: If `spacing` is not positive.
        """
        spacing = _checked_spacing(spacing)
        whole(cls, "count", count)
        places = [spacing * (k - 0.5 * (count - 1)) for k in range(count)]
        return cls(tuple(SetRow(bearing, place) for place in places))

    @classmethod
    def self_aligning(
        cls, row: AbstractBearing, *, staggered: bool = True
    ) -> "BearingSet":
        """Self-aligning ball bearing or spherical roller bearing, of two rows.

        Args:
            row: The row on the +z side; the other is its mirror image.
            staggered: Whether the elements of one row stand between those of the other.

        Raises:
            TypeError: If `row` is no `SelfAligningBallRow` or `SphericalRollerRow`.
        """
        if not getattr(row, "aligns", False):
            raise TypeError(
                f"BearingSet: `row` is a {type(row).__name__}; it must be a"
                " SelfAligningBallRow or a SphericalRollerRow."
            )
        return cls._with_mirrored(row, staggered)

    @classmethod
    def crossed(cls, row: CrossedRollerRow) -> "BearingSet":
        """Crossed roller bearing: every other roller in the groove is turned round.

        Args:
            row: The rollers that carry an inner-ring load along +z.

        Raises:
            TypeError: If `row` is no `CrossedRollerRow`.
        """
        of_class(cls, "row", row, CrossedRollerRow, "a CrossedRollerRow")
        return cls._with_mirrored(row, True)

    @classmethod
    def double_row(cls, row: DoubleRowBallRow) -> "BearingSet":
        """Double-row angular contact ball bearing, back to back (O).

        Args:
            row: The row on the -z side; the other is its mirror image.

        Raises:
            TypeError: If `row` is no `DoubleRowBallRow`.
        """
        of_class(cls, "row", row, DoubleRowBallRow, "a DoubleRowBallRow")
        return cls._with_mirrored(row, True)

    @classmethod
    def _with_mirrored(cls, row, staggered):
        turned = jnp.pi / row.n_elements if staggered else 0.0
        first = row.first_azimuth + turned
        other = eqx.tree_at(lambda r: r.first_azimuth, row, first)
        return cls((SetRow(row), SetRow(other, mirrored=True)))

    @classmethod
    def _pair(cls, bearing, spacing, preload_offset, spring, mirrored):
        spacing, offset = _checked_spacing(spacing), as_real(preload_offset)
        number(cls, "preload_offset", offset, "m")
        rows = []
        for side, turned in zip((-0.5, 0.5), mirrored, strict=True):
            # A row is pressed by its inner ring moving along +z; mirrored, along -z.
            inner = -0.5 * offset if turned else 0.5 * offset
            pressed = spring if side > 0 else None
            rows.append(SetRow(bearing, side * spacing, turned, inner, pressed))
        return cls(tuple(rows))

    def __check_init__(self):
        of_class(self, "rows", self.rows, tuple, "a list or tuple of SetRows")
        if not self.rows:
            raise ValueError("BearingSet: `rows` is empty; it must hold a SetRow.")
        all_of_class(self, "rows", self.rows, SetRow, "SetRows")
        for row in self.rows:
            # Two spheres about different centres could not tilt together.
            numbers = floats(row.position)
            aligning = row.bearing.aligns
            if aligning and numbers is not None and numbers[0] != 0.0:
                raise ValueError(
                    f"BearingSet: `position` of a {type(row.bearing).__name__} is"
                    f" {numbers[0]:g} m; it must be 0 m: its origin is the middle of"
                    " the bearing."
                )
        kinds = {row.bearing.noun for row in self.rows}
        if len(kinds) > 1:
            raise ValueError(
                "BearingSet: `rows` mix balls and rollers; a set must be all of balls"
                " or all of rollers (give two elements instead)."
            )
        for k, row in enumerate(self.rows):
            for other in range(k):
                if overlap(row, self.rows[other]):
                    raise ValueError(
                        f"BearingSet: `position` of row {k} is"
                        f" {float(row.position):.6g} m and of row {other}"
                        f" {float(self.rows[other].position):.6g} m; they must be"
                        " farther apart: their rolling elements overlap."
                    )


def rows_of(bearing: AbstractBearing | BearingSet) -> tuple[SetRow, ...]:
    """The rows of a set, or the bearing as its only row."""
    if isinstance(bearing, BearingSet):
        return bearing.rows
    return (SetRow(bearing),)


def bearings_of(bearing: AbstractBearing | BearingSet) -> tuple[AbstractBearing, ...]:
    """The single-row bearings of a set, or the bearing itself."""
    if isinstance(bearing, BearingSet):
        return tuple(row.bearing for row in bearing.rows)
    return (bearing,)


def with_bearings(
    bearing: AbstractBearing | BearingSet, new: Iterable[AbstractBearing]
) -> Any:
    """Return the set with other bearings in its rows, or the other single bearing.

    Args:
        bearing: A bearing, or a set.
        new: The bearing of each row.
    """
    if isinstance(bearing, BearingSet):
        pairs = zip(bearing.rows, new, strict=True)
        rows = tuple(with_fields(row, bearing=one) for row, one in pairs)
        return with_fields(bearing, rows=rows)
    (only,) = new
    return only


def has_separate_rings(bearing: AbstractBearing | BearingSet) -> bool:
    """Whether it is a set of bearings, each with rings of its own."""
    return isinstance(bearing, BearingSet) and not shares_rings(bearing)


def is_self_aligning(bearing: AbstractBearing | BearingSet) -> bool:
    """Whether its rings tilt freely, as in a self-aligning bearing."""
    return all(row.aligns for row in bearings_of(bearing))


def shares_rings(bearing: AbstractBearing | BearingSet) -> bool:
    """Whether its rows run on the same two rings, as in self-aligning, spherical and
    crossed roller bearings and double-row angular contact ball bearings; a row of such
    a bearing counts too.

    More than two rows of crossed rollers, or of the latter, are several bearings.
    """
    rows = list(bearings_of(bearing))
    if all(row.aligns for row in rows):
        return True
    return len(rows) <= 2 and all(row.is_crossed or row.is_paired for row in rows)


def pitch_radius(bearing: AbstractBearing | BearingSet) -> Scalar:
    """Largest pitch radius of the rows [m]."""
    radii = [0.5 * row.pitch_diameter for row in bearings_of(bearing)]
    xp: Any = array_namespace(*radii)
    return xp.max(xp.stack(radii))


def _checked_spacing(spacing) -> Scalar:
    spacing = as_real(spacing)
    positive(BearingSet, "spacing", spacing, "m")
    return spacing

"""Freedoms that the bearing restrains, and those that its surroundings hold."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from ..design import (
    AbstractBearing,
    BearingSet,
    rows_of,
)
from ..design.bearing_set import bearings_of, is_self_aligning
from ..design.checks import is_traced, must_be, of_shape, one_of, real_numbers
from ..element.frame import FREEDOMS, LOADS, MOTION_UNITS, RINGS
from ..numerics.types import Scalar, as_array, as_real
from ..numerics.units import unit

Prescribed = Mapping[str, float | int | Array | np.ndarray]
DICT_OF_FREEDOMS = "a dict of freedoms with their values in m or rad"
"""Displacements by name of the freedom [m, rad]."""


def _as_names(free: Any) -> Any:
    """A tuple of names; `None` and a text, which is refused, stay as they are."""
    return free if free is None or isinstance(free, str) else tuple(free)


def _as_displacements(prescribed: Any) -> dict[str, Any]:
    if prescribed is None:
        return {}
    known = isinstance(prescribed, Mapping)
    allowed = f"{DICT_OF_FREEDOMS}, such as {{'uz': 1e-5}}"
    must_be("Support", "prescribed", prescribed, known, allowed, TypeError)
    return {name: as_real(value) for name, value in prescribed.items()}


class Support(eqx.Module):
    """What holds the rings of a bearing, apart from the bearing itself.

    Attributes:
        free: Freedoms of the moving ring that may move. `None`: all that the bearing
            can restrain and that are not prescribed; a load on any other is then "no
            load path". The others are held at zero; what holds them there is a result.
        prescribed: Displacements of the moving ring given instead of loads, by freedom
            name [m, rad]; their loads are results; gz turns the set of rollers.
        fixed_ring: "outer" or "inner".
        fixed_displacement: Displacement of the fixed ring (6,) [m, rad]; `None`: zero.

    Traced: the displacements. Static: free, fixed_ring, names of prescribed freedoms.

    Raises:
        TypeError: For a text in place of names or numbers, or no dict.
        ValueError: For unknown names, freedoms both free and prescribed, or shapes
            that do not fit.
    """

    free: tuple[str, ...] | None = eqx.field(
        static=True, converter=_as_names, default=None
    )
    prescribed: dict[str, Scalar] = eqx.field(
        converter=_as_displacements, default=None, metadata=unit(MOTION_UNITS)
    )
    fixed_ring: str = eqx.field(static=True, default="outer")
    fixed_displacement: Float[Array, "6"] | None = eqx.field(
        converter=as_real, default=None, metadata=unit(MOTION_UNITS)
    )

    def __check_init__(self):
        one_of("Support", "fixed_ring", self.fixed_ring, RINGS, "'outer' or 'inner'")
        names = not isinstance(self.free, str)
        must_be("Support", "free", self.free, names, "a list of names", TypeError)
        _check_names("free", self.free or ())
        _check_names("prescribed", tuple(self.prescribed))
        if "gz" in (self.free or ()):
            raise ValueError(
                "Support: `free` contains gz, which no rolling bearing restrains; it"
                " is operating data (prescribe it to turn the set of rollers)."
            )
        both = sorted(set(self.free or ()) & set(self.prescribed))
        if both:
            raise ValueError(
                f"Support: {', '.join(both)} is both free and prescribed; choose one."
            )
        for name, value in self.prescribed.items():
            wanted = "a number in m or rad (units belong in scene files)"
            real_numbers("Support", f"prescribed[{name!r}]", value, wanted)
            fits = np.shape(value) == ()
            of_shape("Support", f"prescribed[{name!r}]", fits, "one number", value)
        if self.fixed_displacement is not None:
            six_numbers("Support", "fixed_displacement", self.fixed_displacement, float)

    @property
    def moving_ring(self) -> str:
        """The ring that the load acts on."""
        return RINGS[1 - RINGS.index(self.fixed_ring)]

    def check_for_cases(self, owner: str) -> None:
        """Raise if displacements are given, which many cases have of their own.

        Args:
            owner: Function that was called, for the message.

        Raises:
            ValueError: If there are any.
        """
        if self.prescribed or self.fixed_displacement is not None:
            raise ValueError(
                f"{owner}: `support` has displacements; give them to the cases, as in"
                " Cases(prescribed={'uz': 1e-5})."
            )

    def given_values(self, dtype: Any) -> Float[Array, "6"]:
        """Prescribed displacements, zero of the other freedoms (6,) [m, rad].

        Args:
            dtype: Dtype of the design.
        """
        values = [self.prescribed.get(name, 0.0) for name in FREEDOMS]
        # Known numbers are put together by NumPy: nothing is compiled for them.
        known = [v if is_traced(v) else np.asarray(v) for v in values]
        return as_array(known, dtype)

    def freedoms(self, bearing: AbstractBearing | BearingSet) -> tuple[str, ...]:
        """Freedoms of the moving ring that may move."""
        free = restrained_freedoms(bearing) if self.free is None else self.free
        return tuple(f for f in FREEDOMS if f in free and f not in self.prescribed)


def _check_names(what: str, names: Sequence[str]) -> None:
    unknown = [name for name in names if name not in FREEDOMS]
    if unknown:
        raise ValueError(
            f"Support: `{what}` names {', '.join(map(repr, unknown))}; freedoms are"
            f" {', '.join(FREEDOMS)}."
        )


RESTRAINED = Support()
"""The usual support: the outer ring is fixed, the inner one free as the bearing is."""


def six_numbers(owner: str, name: str, value: Any, dtype: Any) -> Float[Array, "6"]:
    """Six numbers of a ring, checked, as an array.

    Args:
        owner: Function or class that was given them, for the message.
        name: Its parameter, "load" for loads.
        value: Numbers [N, N m], [m, rad].
        dtype: Dtype of the array.

    Raises:
        TypeError: For text in place of numbers.
        ValueError: For another shape.
    """
    order, units = (LOADS, "N, N m") if name == "load" else (FREEDOMS, "m, rad")
    wanted = f"six numbers, {' '.join(order)} in {units} (units belong in scene files)"
    real_numbers(owner, name, value, wanted)
    try:
        array = as_array(value, dtype)
    except ValueError as error:  # lists of unlike length
        raise ValueError(f"{owner}: `{name}` must be {wanted}.") from error
    allowed = f"(6,): {' '.join(order)}"
    of_shape(owner, name, array.shape == (6,), allowed, array)
    return array


def restrained_freedoms(bearing: AbstractBearing | BearingSet) -> tuple[str, ...]:
    """Freedoms that the bearing can restrain, against a load in the right direction.

    Never gz. Not gx and gy of a self-aligning bearing or of a single spherical roller
    thrust bearing, not ux and uy of cylindrical roller thrust bearings; of a toroidal
    roller bearing ux and uy alone. uz with balls and tapered rollers, and where a pair
    of ribs passes axial load from ring to ring.
    """
    rows = list(bearings_of(bearing))
    axial = any(row.holds_axially for row in rows)
    radial = any(row.bears_radially for row in rows)
    sphere = len(rows) == 1 and rows[0].tilts_alone
    tilts = () if sphere or is_self_aligning(bearing) else ("gx", "gy")
    return (*(("ux", "uy") if radial else ()), *(("uz",) if axial else ()), *tilts)


def axial_senses(bearing: AbstractBearing | BearingSet) -> set[int]:
    """Senses in which it carries axial load on its inner ring: 1 along +z, or -1."""
    return {
        -sense if row.mirrored else sense
        for row in rows_of(bearing)
        for sense in row.bearing.axial_senses
    }


def check_held(
    owner: str,
    load: Float[Array | np.ndarray, "*case 6"],
    support: Support,
    prescribed: Iterable[str] = (),
) -> None:
    """Raise if known loads act on freedoms that are held.

    Args:
        owner: Function that was called, for the message.
        load: Loads of one or of many cases [N, N m]; traced ones are not checked.
        support: What holds the rings.
        prescribed: Freedoms that the cases prescribe beside the support.

    Raises:
        ValueError: Naming the load, the freedom, and why it is held.
    """
    if is_traced(load):
        return
    loads = np.nan_to_num(np.asarray(load).reshape(-1, 6))
    prescribed, free = {*prescribed, *support.prescribed}, support.free
    # Not gz: a moment about the axis has no load path, which the result code says.
    left_out = () if free is None else set(FREEDOMS[:5]) - set(free) - set(prescribed)
    for names, why in ((prescribed, "prescribed"), (left_out, "not among `free`")):
        for index in sorted(FREEDOMS.index(name) for name in names):
            cases = np.flatnonzero(loads[:, index])
            if cases.size == 0:
                continue
            which = "" if np.ndim(load) == 1 else f" in case {cases[0]}"
            unit = "N" if index < 3 else "N m"
            raise ValueError(
                f"{owner}: `load` has {LOADS[index]} ="
                f" {loads[cases[0], index]:.6g} {unit}{which}, but {FREEDOMS[index]} is"
                f" {why}: its support would take that load, and what it passes to the"
                " bearing is a result. Choose one."
            )

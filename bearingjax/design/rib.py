"""Ribs, against which the roller ends bear."""

from typing import ClassVar

import equinox as eqx

from ..numerics.labels import name_axis
from ..numerics.shown import Printable
from ..numerics.types import Number, Real, as_real
from ..numerics.units import real
from .checks import check_fields, instance, number, one_of

RIB_NAMES = name_axis("rib", ("outer_minus", "outer_plus", "inner_minus", "inner_plus"))
"""Order of the ribs wherever they are an axis: ring, then side (-z, +z)."""

ARRANGEMENTS = {
    "N": ("inner_minus", "inner_plus"),
    "NU": ("outer_minus", "outer_plus"),
    "NJ": ("outer_minus", "outer_plus", "inner_minus"),
    "NUP": ("outer_minus", "outer_plus", "inner_minus", "inner_plus"),
}
"""Ribs of the cylindrical roller bearing types; NJ carries inner-ring load to +z."""


class Rib(Printable):
    """A rib that is straight in the axial section, against a spherical roller end.

    The rib's normal passes through the centre of the sphere, so the height of the
    contact fixes the small opening angle of the rib.

    Attributes:
        end_radius: Radius of the sphere of the roller end; its pole lies on the
            roller axis at the end of the roller length [m].
        contact_height: Height of the contact along the rib, from the end of the
            raceway generator that the rib stands on [m].
        axial_gap: Gap between sphere and rib along the rib normal, unloaded and
            centred; negative is interference [m].

    Traced: all fields.
    """

    about: ClassVar[str] = "a rib, straight in the axial section, against a sphere"
    end_radius: Real = eqx.field(
        **real("m", "radius of the sphere of the roller end", above=0)
    )
    contact_height: Real = eqx.field(
        **real("m", "height of the contact along the rib, from the raceway", least=0)
    )
    axial_gap: Real = eqx.field(
        **real("m", "gap along the rib normal, unloaded; negative is interference"),
        default=0.0,
    )

    def __check_init__(self):
        check_fields(self)
        number(self, "axial_gap")


class Ribs(Printable):
    """The ribs of a bearing; an absent one is `None` and is not computed.

    Attributes:
        outer_minus: Rib of the outer ring at the -z end of the rollers.
        outer_plus: Rib of the outer ring at the +z end.
        inner_minus: Rib of the inner ring at the -z end.
        inner_plus: Rib of the inner ring at the +z end.

    Traced: all real numbers of the ribs. Static: which ribs exist.
    """

    outer_minus: Rib | None = None
    outer_plus: Rib | None = None
    inner_minus: Rib | None = None
    inner_plus: Rib | None = None

    @classmethod
    def arrangement(
        cls, name: str, rib: Rib, axial_internal_clearance: Number | None = None
    ) -> "Ribs":
        """Ribs of a cylindrical roller bearing by the name of its type.

        Args:
            name: "N", "NU", "NJ" or "NUP".
            rib: Common data of the ribs.
            axial_internal_clearance: Total axial play of one ring against the other
                between the ribs, a quarter of it at each rib [m]. `None` keeps the
                gap of `rib`.

        Raises:
            ValueError: If the name is unknown.
        """
        one_of(cls, "arrangement", name, ARRANGEMENTS)
        if axial_internal_clearance is not None:
            gap = as_real(0.25 * axial_internal_clearance)
            rib = Rib(rib.end_radius, rib.contact_height, gap)
        return cls(**dict.fromkeys(ARRANGEMENTS[name], rib))

    @property
    def present(self) -> tuple[str, ...]:
        """Names of the ribs that exist, in the fixed order."""
        return tuple(n for n in RIB_NAMES if getattr(self, n) is not None)

    def __check_init__(self):
        for name in RIB_NAMES:
            instance(self, name, Rib, None)

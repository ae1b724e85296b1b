"""Parts on the shafts of a system: gears, pulleys, couplings, loads, bearings.

The force of a wheel follows from the torque T by which its mesh or belt acts on its
shaft, positive about the local z of the shaft. A gear is touched at the radius r of its
pitch circle, in the radial direction e_r; e_t is the direction in which a positive
rotation moves this point, g the line of the tooth of a spur gear (along the cone of a
bevel gear) towards local +z, and n the outward normal of the pitch surface:

    F = T/r (e_t - tan β g) - |T|/r tan α / cos β n

with β positive for a right-hand helix (a tooth that advances along +z turns from x
towards y).

Source: the normal force of involute gears, resolved; ISO 21771 for the geometry.
"""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import (
    check_fields,
    finite,
    floats,
    instance,
    is_traced,
    number,
)
from ..design.checks import count as whole
from ..numerics.types import (
    Real,
    RealOrNone,
    Scalar,
    array_namespace,
    as_count,
    as_real,
)
from ..numerics.units import meaning, real, unit
from ..statics.installed import Installed

HANDS = {"right": 1.0, "left": -1.0, "none": 0.0}
"""Sense of the helix, by its name."""
APEXES = {"+z": 1.0, "-z": -1.0}
"""Side of a bevel gear on which the apex of its cone lies, along the shaft."""


class AbstractPlaced(eqx.Module):
    """A part on a shaft.

    Attributes:
        name: Name, unique in the system.
        shaft: Name of the shaft.
        position: Along the shaft, from the start of its first segment [m].
    """

    name: eqx.AbstractVar[str]
    shaft: eqx.AbstractVar[str]
    position: eqx.AbstractVar[Scalar]


def _one_source(owner) -> None:
    """Raise unless at most one of torque and power is given, both finite."""
    for name in ("torque", "power"):
        if getattr(owner, name) is not None:
            number(owner, name)
    if owner.torque is not None and owner.power is not None:
        raise ValueError(
            f"{type(owner).__name__}: `torque` and `power` are given; give one of them."
        )


def torque_of(part: Any, speed: Any) -> Any:
    """Return the given torque on the shaft of a part [N m]; `None` if none is given.

    Without power there is no torque, also at rest.

    Args:
        part: Part with `torque` and `power`.
        speed: Speed of its shaft [rad/s].
    """
    if part.power is None:
        return part.torque
    idle = (part.power == 0) & (speed == 0)
    return jnp.where(idle, 0.0, part.power / jnp.where(idle, 1.0, speed))


class AbstractWheel(AbstractPlaced):
    """A wheel that drives, or is driven, at its circumference.

    Attributes:
        mates_with: Wheel of another shaft that it meshes with, or whose belt it shares;
            one of the two may name the other. `None`: none of the system.
        torque: By which a mate outside the system acts on the shaft, about its local z
            [N m]; `None`: from the balance of torques, of one wheel at most.
        power: Power into the shaft in place of `torque`, negative out of it [W].
        efficiency: Power out over power in [1]; a pair has the product of both. Each
            mate bears the force of that which gives the power.
    """

    mates_with: str | None = eqx.field(
        static=True,
        default=None,
        kw_only=True,
        metadata=meaning(
            "wheel of another shaft that it meshes with, or whose belt it shares"
        ),
    )
    torque: RealOrNone = eqx.field(
        **real(
            "N m",
            "torque of a mate outside the system on the shaft, about its local z",
            otherwise="from the balance of torques, of one wheel at most",
        ),
        default=None,
        kw_only=True,
    )
    power: RealOrNone = eqx.field(
        **real("W", "power into the shaft in place of `torque`, negative out of it"),
        default=None,
        kw_only=True,
    )
    efficiency: Real = eqx.field(
        **real(
            "1",
            "power out over power in; a pair has the product of both",
            above=0,
            most=1,
        ),
        default=1.0,
        kw_only=True,
    )

    def __check_init__(self):
        check_fields(self)
        _one_source(self)


class Gear(AbstractWheel):
    """An external involute gear: spur, helical, or bevel.

    Attributes:
        name, shaft, position: As in `AbstractPlaced`; of a bevel gear the middle of the
            face.
        teeth: Number of teeth.
        normal_module: Module normal to the teeth; of a bevel gear in the middle of the
            face [m].
        helix_angle: At the pitch circle; of a bevel gear its spiral angle [rad].
        hand: "right" or "left"; "none" of straight teeth.
        pressure_angle: Normal to the teeth [rad].
        mesh_angle: Angle of the mesh around the shaft, from local x towards local
            y [rad]; `None`: from the places of both shafts, with which it must agree.
        pitch_angle: Half the angle of the pitch cone of a bevel gear [rad]; `None`:
            cylindrical.
        apex: Side of its apex, "+z" or "-z" of the shaft; `None` of a cylindrical gear.
        face_width: Width of the teeth, over which a misalignment is told; the force of
            two gears acts in the middle of the common part of their faces [m].

    Others as in `AbstractWheel`. Traced: all numbers but `teeth`.
    """

    about: ClassVar[str] = "an external involute gear: spur, helical, or bevel"
    name: str = eqx.field(static=True)
    shaft: str = eqx.field(static=True)
    position: Real = eqx.field(**real("m"))
    teeth: int = eqx.field(
        static=True, converter=as_count, metadata=meaning("number of teeth")
    )
    normal_module: Real = eqx.field(
        **real(
            "m",
            "module normal to the teeth; of a bevel gear in the middle of the face",
            above=0,
        )
    )
    helix_angle: Real = eqx.field(
        **real(
            "rad",
            "helix angle at the pitch circle; of a bevel gear its spiral angle",
            least=0,
            below=np.deg2rad(60.0),
        ),
        default=0.0,
    )
    hand: str = eqx.field(
        static=True,
        default="none",
        metadata=meaning(
            "`right` or `left`; `none` of straight teeth", choices=tuple(HANDS)
        ),
    )
    pressure_angle: Real = eqx.field(
        **real(
            "rad",
            "pressure angle normal to the teeth",
            above=np.deg2rad(5.0),
            below=np.deg2rad(45.0),
        ),
        default=np.deg2rad(20.0),
    )
    mesh_angle: RealOrNone = eqx.field(
        **real(
            "rad",
            "angle of the mesh around the shaft, from local x towards local y",
            otherwise="from the places of both shafts, with which it must agree",
        ),
        default=None,
    )
    pitch_angle: RealOrNone = eqx.field(
        **real(
            "rad",
            "half the angle of the pitch cone of a bevel gear",
            above=0,
            below=0.5 * np.pi,
            otherwise="cylindrical",
        ),
        default=None,
    )
    apex: str | None = eqx.field(
        static=True,
        default=None,
        metadata=meaning(
            "side of the apex of a bevel gear, along its shaft", choices=tuple(APEXES)
        ),
    )
    face_width: RealOrNone = eqx.field(
        **real("m", "width of the teeth, over which a misalignment is told", above=0),
        default=None,
    )

    def __check_init__(self):
        whole(self, "teeth", self.teeth)
        straight = not is_traced(self.helix_angle) and float(self.helix_angle) == 0.0
        if not straight and self.hand == "none":
            raise ValueError(
                f"Gear: `hand` of {self.name} is missing; a helix is 'right' or 'left'."
            )
        if (self.pitch_angle is None) != (self.apex is None):
            raise ValueError(
                f"Gear: `pitch_angle` and `apex` of {self.name} are of a bevel gear;"
                " give both or neither."
            )

    @property
    def radius(self) -> Scalar:
        """Radius of the pitch circle; of a bevel gear in the middle of the face [m]."""
        cosine = array_namespace(self.helix_angle).cos(self.helix_angle)
        return 0.5 * self.normal_module * self.teeth / cosine

    @property
    def base_radius(self) -> Scalar:
        """Radius of the base circle of a cylindrical gear [m]."""
        tangent = jnp.tan(self.pressure_angle) / jnp.cos(self.helix_angle)
        return self.radius / jnp.sqrt(1.0 + tangent**2)

    def push(
        self, axis: Any, radial: Any, radius: Scalar, sign: Array
    ) -> tuple[Any, Any]:
        """Return force over T/r on the gear at its mesh, and the line of its tooth.

        Args:
            axis: Local z of the shaft in global axes (3,) [1].
            radial: Direction from the shaft to the mesh (3,) [1].
            radius: Working pitch radius [m].
            sign: 1, or -1 of a negative torque [1].
        """
        along = jnp.cross(axis, radial)
        line, normal = axis, radial
        slope = HANDS[self.hand] * jnp.tan(self.helix_angle) * radius / self.radius
        if self.pitch_angle is None:
            cosine = self.base_radius / radius
            push = jnp.sqrt(1.0 - cosine**2) / cosine
        else:
            side = APEXES[self.apex or "+z"]
            cone = jnp.cos(self.pitch_angle), side * jnp.sin(self.pitch_angle)
            line = cone[0] * axis - cone[1] * radial
            normal = cone[0] * radial + cone[1] * axis
            push = jnp.tan(self.pressure_angle) / jnp.cos(self.helix_angle)
        return along - slope * line - sign * push * normal, line


class Pulley(AbstractWheel):
    """A belt pulley, or a chain wheel.

    Attributes:
        name, shaft, position: As in `AbstractPlaced`.
        diameter: Effective diameter [m].
        force_ratio: Force of the belt on the shaft over the tangential force, such as
            1.0 to 1.3 of chains and toothed belts, 1.5 to 2.5 of V-belts, 2 to 5 of
            flat belts [1].
        direction: Direction of the force on the shaft, as angle around it [rad];
            `None`: towards the shaft of the mate.

    Others as in `AbstractWheel`. Traced: all numbers.
    """

    about: ClassVar[str] = "a belt pulley, or a chain wheel"
    name: str = eqx.field(static=True)
    shaft: str = eqx.field(static=True)
    position: Real = eqx.field(**real("m"))
    diameter: Real = eqx.field(**real("m", "effective diameter", above=0))
    force_ratio: Real = eqx.field(
        **real(
            "1",
            "force on the shaft over the tangential force, such as 1.0 to 1.3 of chains"
            " and toothed belts, 1.5 to 2.5 of V-belts, 2 to 5 of flat belts",
            above=0,
        )
    )
    direction: RealOrNone = eqx.field(
        **real(
            "rad",
            "direction of the force on the shaft, as angle around it",
            otherwise="towards the shaft of the mate",
        ),
        default=None,
    )

    @property
    def radius(self) -> Scalar:
        """Half the diameter [m]."""
        return 0.5 * self.diameter


class Coupling(eqx.Module):
    """A coupling: torque enters or leaves a shaft without a force.

    Attributes:
        name: Name, unique in the system.
        shaft: Name of the shaft.
        torque: On the shaft about its local z [N m]; `None`: from the balance.
        power: Power into the shaft in place of `torque`, negative out of it [W].
    """

    about: ClassVar[str] = "torque enters or leaves a shaft without a force"
    name: str = eqx.field(static=True)
    shaft: str = eqx.field(static=True)
    torque: RealOrNone = eqx.field(
        **real(
            "N m", "torque on the shaft about its local z", otherwise="from the balance"
        ),
        default=None,
    )
    power: RealOrNone = eqx.field(
        **real("W", "power into the shaft in place of `torque`, negative out of it"),
        default=None,
    )

    def __check_init__(self):
        _one_source(self)


class Drive(eqx.Module):
    """The place at which the system is driven, its speed and its torque.

    Attributes:
        into: Name of a shaft, driven through a coupling, or of a wheel without a mate.
        speed: Speed of that shaft [rad/s].
        torque: On that shaft about its local z [N m].
        power: In place of the torque, into the shaft [W].
    """

    into: str = eqx.field(static=True)
    speed: Real = eqx.field(**real("rad/s", "speed of that shaft"), default=0.0)
    torque: RealOrNone = eqx.field(**real("N m"), default=None)
    power: RealOrNone = eqx.field(**real("W"), default=None)

    def __check_init__(self):
        number(self, "speed")
        _one_source(self)
        turns = is_traced(self.speed) or float(self.speed) != 0.0
        idle = floats(self.power) == [0.0]
        if self.power is not None and not (turns or idle):
            raise ValueError(
                "Drive: `power` needs a `speed`, from which its torque follows; give"
                " the `torque` of a machine at rest."
            )


class ShaftLoad(AbstractPlaced):
    """A force and a moment on a shaft, in global axes.

    Attributes:
        name, shaft, position: As in `AbstractPlaced`.
        force: (3,) [N].
        moment: (3,) [N m]; its part about the shaft counts in the balance of torques.
    """

    about: ClassVar[str] = "a force and a moment on a shaft, in global axes"
    name: str = eqx.field(static=True)
    shaft: str = eqx.field(static=True)
    position: Real = eqx.field(**real("m"))
    force: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit(3 * ("N",)), default=(0.0, 0.0, 0.0)
    )
    moment: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit(3 * ("N m",)), default=(0.0, 0.0, 0.0)
    )

    def __check_init__(self):
        for name in ("force", "moment"):
            value = getattr(self, name)
            if jnp.shape(value) != (3,):
                raise ValueError(
                    f"ShaftLoad: `{name}` of {self.name} has shape {jnp.shape(value)};"
                    " it must be (3,), in global axes."
                )
            finite(self, name)


class Seat(AbstractPlaced):
    """A bearing in its place: on a shaft, in the housing.

    Attributes:
        name, shaft, position: As in `AbstractPlaced`; the position is that of the
            origin of the bearing.
        installed: The bearing with its preload, seats and temperatures.
        preload: Axial force with which it is adjusted in the cold, before the shaft or
            the housing give way [N]; `None`: none.
        axial_offset: Axial displacement of its inner ring against the outer one as
            mounted in the cold, along the z of the bearing: negative values are play
            before an adjusted bearing touches [m].
        turned: Whether it is mounted the other way round, its +z along the shaft's -z,
            by a half turn about local x.
        floating: Whether its outer ring slides along the housing, so that it carries no
            axial force.
        stiffness: Stiffness of springs in place of the bearing, in local ux uy uz gx gy
            (5,) [N/m, N m]; `None`: the bearing.

    Traced: all numbers. Static: names, floating, turned.
    """

    name: str = eqx.field(static=True)
    shaft: str = eqx.field(static=True)
    position: Real = eqx.field(**real("m"))
    installed: Installed | None = None
    preload: RealOrNone = eqx.field(
        **real(
            "N",
            "axial force with which it is adjusted in the cold",
            above=0,
            hint="without preload leave it out",
        ),
        default=None,
    )
    axial_offset: Real = eqx.field(
        **real("m", "axial displacement as adjusted; negative: play"), default=0.0
    )
    turned: bool = eqx.field(
        static=True,
        default=False,
        metadata=meaning(
            "whether it is mounted the other way round, its +z along the shaft's -z"
        ),
    )
    floating: bool = eqx.field(
        static=True,
        default=False,
        metadata=meaning(
            "whether its outer ring slides in the housing, without axial force"
        ),
    )
    stiffness: Float[Array, "5"] | None = eqx.field(
        converter=as_real,
        metadata=unit(("N/m", "N/m", "N/m", "N m", "N m")),
        default=None,
    )

    def __check_init__(self):
        instance(self, "installed", Installed, None)
        if (self.installed is None) == (self.stiffness is None):
            raise ValueError(
                f"Seat: {self.name} needs a bearing (`installed`) or springs"
                " (`stiffness`), not both."
            )
        check_fields(self)
        number(self, "axial_offset")
        moved = not is_traced(self.axial_offset) and float(self.axial_offset) != 0.0
        for name, given in (
            ("preload", self.preload is not None),
            ("axial_offset", moved),
        ):
            if given and (self.stiffness is not None or self.floating):
                why = "its outer ring slides (`floating`), so that nothing keeps it"
                if self.stiffness is not None:
                    why = "it goes with a bearing, not with springs (`stiffness`)"
                raise ValueError(f"Seat: `{name}` of {self.name} has no effect: {why}.")
        if self.turned and self.stiffness is not None:
            raise ValueError(
                f"Seat: `turned` of {self.name} has no effect: springs are the same"
                " from both sides."
            )

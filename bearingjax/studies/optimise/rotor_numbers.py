"""The rotor of a scene as a design whose numbers may change."""

from collections.abc import Iterator

from ...rotor import Rotor
from ...rotor.rotor_design import RotorDesign, RotorSeat
from ..rotor.read import RotorScene
from ..rotor.supports import support_of
from .read_optimise import installed_numbers


def rotor_design(scene: RotorScene) -> RotorDesign:
    """Return the rotor of a scene on the bearings of its supports."""
    keys, seats = scene.keys, []
    supports = [support_of(mount) for mount in scene.mounts]
    for mount in scene.mounts:
        placed, preload = mount.installed, mount.keys.preload
        if placed is None or mount.keys.law is not None:
            seats.append(None)
        else:
            seats.append(RotorSeat(placed, preload))
    rotor = Rotor(scene.shaft, scene.discs, supports, keys.own_damping, keys.rigid)
    return RotorDesign(rotor, seats, scene.loads, keys.modes)


def rotor_numbers(scene: RotorScene) -> dict[str, tuple[str, ...]]:
    """Return the numbers of a rotor by scene key, with their paths in `RotorDesign`."""
    return dict(_numbers(scene))


def _numbers(scene: RotorScene) -> Iterator[tuple[str, tuple[str, ...]]]:
    found: dict[str, tuple[str, ...]] = {}
    held = {mount.name for mount in scene.mounts if mount.keys.law is not None}
    for k, mount in enumerate(scene.mounts):
        head, own = f"rotor.bearings.{k}", f"rotor.supports.{k}"
        keys = mount.keys
        springs = {"damping": keys.damping.diagonal}
        if mount.scene is not None and keys.law is None:
            own_numbers = installed_numbers(mount.scene).items()
            for key, paths in () if mount.name in held else own_numbers:
                name = f"bearings.{mount.name}.{key.removeprefix('bearing.')}"
                within = tuple(f"seats.{k}.installed.{path}" for path in paths)
                found[name] = (*found.get(name, ()), *within)
            if keys.preload is not None:
                yield f"{head}.preload", (f"seats.{k}.preload",)
        elif keys.stiffness is not None:
            springs["stiffness"] = keys.stiffness.diagonal
        for name, (x, y, *_) in springs.items():
            across = {"radial": "01"} if x == y else {"x": "0", "y": "1"}
            for side, axes in (across | {"axial": "2", "tilt": "34"}).items():
                paths = tuple(f"{own}.{name}.{axis}.{axis}" for axis in axes)
                yield f"{head}.{name}.{side}", paths
        if keys.housing is not None:
            yield f"{head}.housing.mass", (f"{own}.housing.mass",)
            for name in ("stiffness", "damping"):
                place = f"{own}.housing.{name}"
                each = [f"{place}.{axis}.{axis}" for axis in range(3)]
                if len(set(getattr(keys.housing, name))) == 1:
                    yield f"{head}.housing.{name}", tuple(each)
                    continue
                for axis, path in zip("xyz", each, strict=True):
                    yield f"{head}.housing.{name}.{axis}", (path,)
    yield from found.items()
    for k in range(len(scene.keys.shaft)):
        for name in ("outer_diameter", "bore"):
            yield f"rotor.shaft.{k}.{name}", (f"rotor.shaft.{name}.{k}",)
    for k, disc in enumerate(scene.discs):
        for name in ("mass", "polar_inertia", "diametral_inertia"):
            if hasattr(disc, name):
                yield f"rotor.discs.{k}.{name}", (f"rotor.discs.{k}.{name}",)
    for k in range(len(scene.loads.unbalances)):
        for name in ("moment", "phase"):
            key = f"rotor.excitation.unbalance.{k}.{name}"
            yield key, (f"loads.unbalances.{k}.{name}",)

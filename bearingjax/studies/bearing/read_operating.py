"""The [operating], [numerics] and [output] tables of a scene: load, speeds, support."""

from typing import Any

from ...element import FREEDOMS, LOADS, RINGS, Speed
from ...files.schema import Keys, scene_key
from ...statics.options import DEFAULT_TOLERANCE
from ...statics.support import restrained_freedoms

MOST_POINTS = 10_000
"""Most positions along a roller: line load and pressure on two raceways, 0.8 MB per
roller as JSON."""


def relative_speed(speed: Speed | None) -> float:
    """Return the speed of the inner ring less that of the outer [rad/s]; 0 at rest."""
    return 0.0 if speed is None else float(speed.inner) - float(speed.outer)


class LoadKeys(Keys):
    about = "Load on the moving ring"

    Fx: float | None = scene_key("force along x", "force")
    Fy: float | None = scene_key("force along y", "force")
    Fz: float | None = scene_key("axial force", "force")
    Mx: float | None = scene_key("moment about x", "moment")
    My: float | None = scene_key("moment about y", "moment")
    Mz: float | None = scene_key("moment about the axis", "moment")


class MotionKeys(Keys):
    about = "Displacements at which the moving ring is held"

    ux: float | None = scene_key("displacement along x", "length")
    uy: float | None = scene_key("displacement along y", "length")
    uz: float | None = scene_key("axial displacement", "length")
    gx: float | None = scene_key("tilt about x", "angle")
    gy: float | None = scene_key("tilt about y", "angle")
    gz: float | None = scene_key("turn about the axis", "angle")


def _by_name(example: str) -> str:
    return f"name the components, {{ {example} }}"


class OperatingKeys(Keys):
    about = "[operating]: load, support and speeds of a bearing"

    fixed_ring: str = scene_key(
        "ring that stands; load and displacements are those of the other one",
        choices=RINGS,
        default="outer",
    )
    load: LoadKeys | None = scene_key(
        "load on the moving ring", hint=_by_name('Fy = "-4 kN"')
    )
    prescribed: MotionKeys | None = scene_key(
        "displacements at which the moving ring is held", hint=_by_name('uz = "10 um"')
    )
    free: tuple[str, ...] | None = scene_key(
        "freedoms that may move",
        choices=FREEDOMS[:5],
        otherwise="all that the bearing restrains and nothing prescribes",
    )
    inner_speed: float = scene_key("speed of the inner ring", "speed", default=0.0)
    outer_speed: float = scene_key("speed of the outer ring", "speed", default=0.0)

    @property
    def speed(self) -> Speed | None:
        """Ring speeds; `None` if both rings are at rest."""
        if not self.inner_speed and not self.outer_speed:
            return None
        return Speed(self.inner_speed, self.outer_speed)

    @property
    def prescribed_values(self) -> dict[str, float]:
        """Prescribed displacements by freedom [m, rad]."""
        return {} if self.prescribed is None else self.prescribed.given

    @property
    def loads(self) -> tuple[float, ...]:
        """(Fx, Fy, Fz, Mx, My, Mz) on the moving ring [N, N m]."""
        given = {} if self.load is None else self.load.given
        return tuple(given.get(name, 0.0) for name in LOADS)

    def check(self) -> None:
        free, held = self.free, self.prescribed_values
        both = sorted(set(free or ()) & set(held))
        if both:
            problem = f"{', '.join(both)} is both free and prescribed; choose one"
            raise self.table.error("free", problem)
        for freedom, component, load in zip(FREEDOMS, LOADS, self.loads, strict=True):
            left_out = free is not None and freedom not in (*free, "gz")
            if load and (left_out or freedom in held):
                why = "prescribed" if freedom in held else "not among `free`"
                problem = (
                    f"{component} acts on {freedom}, which is {why}: its support would"
                    " take that load; choose one"
                )
                raise self.table.error("load", problem)

    def fill_free(self, bearing: Any) -> None:
        """Fill in the free freedoms of a bearing in the echo."""
        if self.free is None:
            moving = [
                f
                for f in restrained_freedoms(bearing)
                if f not in self.prescribed_values
            ]
            self.table.fill("free", moving)


class SolveKeys(Keys):
    about = "[numerics] of a load solve"

    tolerance: float | None = scene_key(
        "relative residual at which it ends",
        least=1e-14,
        below=0.01,
        otherwise=f"{DEFAULT_TOLERANCE['float64']:g}",
    )


class OutputKeys(Keys):
    about = "[output] of a bearing of rollers"

    points: int = scene_key(
        "positions along a roller at which loads are output", default=101, least=2
    )

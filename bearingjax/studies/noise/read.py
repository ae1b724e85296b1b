"""The [vibration] table of a scene: a bearing on its test rig, and the measurement."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ... import noise
from ...design import FormErrors, rows_of
from ...design.bearing_set import bearings_of, with_bearings
from ...element import FREEDOMS, RINGS, BearingElement
from ...element.frame import DIRECTIONS
from ...files.scene_file import find_scene, parse_bearing
from ...files.schema import Keys, direction_key, key_of, read_keys, scene_key
from ...files.table import Table
from ...noise.bands import BANDS
from ...noise.level import NORM
from ...numerics.warning import Warning
from ..bearing.read_scene import Scene, scene_of, with_speed_warnings
from .read_deviations import read_deviations
from .read_measured import MeasuredKeys, Measurement, read_measured
from .read_tolerance import Tighter, ToleranceKeys, read_tolerance

WINDOWS = {"hann": noise.Hann, "rectangular": noise.Rectangular}
NORMS = {"85-176211": NORM}
"""Largest allowed levels, by bearing."""
HELD = "held"
"""Value of `tilting_inertia` for a ring that does not tilt."""
MOST_SAMPLES = 200_000
"""Most samples of a record: about 20 MB as JSON."""


class VibrationKeys(Keys):
    about = "[vibration]: the test rig of a bearing, the record and its evaluation"

    mass: float = key_of(noise.NoiseModel, "mass")
    moving_ring: str | None = scene_key(
        "ring that the load acts on",
        choices=RINGS,
        otherwise="the one that is not `operating.fixed_ring`; without either `outer`",
    )
    tilting_inertia: float | str | None = scene_key(
        "moment of inertia of the moving ring about a diameter; `held`: it does not"
        " tilt, as with `operating.prescribed` gx and gy at 0",
        "moment of inertia",
        choices=(HELD,),
        otherwise="that of a ring of this mass",
    )
    bridging: bool = scene_key(
        "whether contacts average waves over their width, as they do in fact;"
        " otherwise shorter waves are met as they are, with a warning",
        default=False,
    )
    retardation: float | None = key_of(
        noise.NoiseModel, "retardation", otherwise="10 us", default=None
    )
    sensor_stiffness: float | None = key_of(noise.Sensor, "stiffness")
    sensor_damping: float | None = key_of(noise.Sensor, "damping", default=None)
    sensor_direction: tuple[float, ...] = direction_key(
        "line of the sensor: x, y, z, or its three components",
        dict(zip(DIRECTIONS, map(tuple, np.eye(3).tolist()), strict=True)),
        "y",
        needs=("sensor_stiffness", "sensor_damping"),
    )
    turns: int = key_of(noise.RecordOptions, "turns")
    settle: int = key_of(noise.RecordOptions, "settle", least=0)
    samples: int = key_of(noise.RecordOptions, "samples", least=16)
    steps: int | None = key_of(
        noise.RecordOptions, "steps", otherwise="as many as the stiffest contact needs"
    )
    reference: float = key_of(noise.LevelOptions, "reference", above=0.0)
    bands: str = scene_key(
        "bands of the levels", choices=tuple(BANDS), default="octave"
    )
    norm: str | None = scene_key(
        "largest allowed levels, by the bearing that they are for", choices=tuple(NORMS)
    )
    window: str = scene_key(
        "window of the spectrum", choices=tuple(WINDOWS), default="hann"
    )
    envelope_band: tuple[float, ...] | None = scene_key(
        "lower and upper frequency of the band whose envelope is shown",
        "frequency",
        above=0,
        otherwise="1.8 to 10 kHz, the high band of ISO 15242, within the record",
    )
    measured: MeasuredKeys | None = scene_key(
        "measured acceleration along the sensor, shown beside the calculated one"
    )
    tolerance: ToleranceKeys | None = scene_key(
        "how bearings off the line scatter, for `--monte-carlo`"
    )

    def check(self) -> None:
        if self.samples % 2:
            problem = f"{self.samples} is odd; it must be even"
            raise self.table.error("samples", problem)
        turns = self.turns + self.settle
        if turns * self.samples > MOST_SAMPLES:
            number = f"{turns} turns of {self.samples} are too many"
            problem = f"{number}; at most {MOST_SAMPLES} samples"
            raise self.table.error("samples", problem)
        band = self.envelope_band
        if band is not None and not (len(band) == 2 and band[0] < band[1]):
            problem = "must be two rising frequencies"
            raise self.table.error("envelope_band", problem)
        if self.norm is None:
            return
        if self.bands != "octave":
            raise self.table.error("norm", "is of octaves; take `bands` = octave")
        if self.reference != noise.REFERENCE_ACCELERATION:
            problem = f"counts from {noise.REFERENCE_ACCELERATION:g} m/s²; leave out"
            raise self.table.error("norm", f"{problem} `reference`")

    @property
    def sensor(self) -> noise.Sensor | None:
        """Sensor on the moving ring, or `None`."""
        stiffness, damping = self.sensor_stiffness, self.sensor_damping
        if stiffness is None and damping is None:
            return None
        with self.table.building():
            return noise.Sensor(stiffness or 0.0, damping or 0.0, self.sensor_direction)


@dataclasses.dataclass(frozen=True)
class NoiseScene:
    """Scene of the vibration of a bearing, in SI.

    Attributes:
        scene: The scene without [vibration].
        vibration: The rig, the record and its evaluation, as the table says them.
        model: The bearing on its rig, with its form errors.
        line: Model common to all bearings of the production line: with `waves` and
            `spalls`, but without spectra, profiles and differences of the rolling
            elements, which belong to this bearing only.
        tolerances: Scatter of the bearings, or `None`.
        tighter: Names of the next tighter grade and class, with their factors on the
            sources [1].
        seed: Seed of the random bearings.
        bearings: Number of random bearings.
        measured: Measured acceleration, or `None`.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    scene: Scene
    vibration: VibrationKeys
    model: noise.NoiseModel
    line: noise.NoiseModel
    tolerances: noise.Tolerances | None
    tighter: Tighter
    seed: int
    bearings: int
    measured: Measurement | None
    warnings: tuple[Warning, ...]
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.scene.name

    @property
    def reference(self) -> float:
        """Acceleration of 0 dB [m/s²]."""
        return self.vibration.reference

    @property
    def bands(self) -> noise.Bands:
        """Bands of the levels."""
        return BANDS[self.vibration.bands]()

    @property
    def norm(self) -> np.ndarray | None:
        """Largest allowed level of each band (band,) [dB], or `None`."""
        name = self.vibration.norm
        return None if name is None else np.array(NORMS[name])

    @property
    def window(self) -> noise.AbstractWindow:
        """Window of the spectrum."""
        return WINDOWS[self.vibration.window]()

    def envelope_band(self, highest: float) -> tuple[float, float]:
        """Return the band whose envelope is shown [Hz].

        Args:
            highest: Frequency up to which the record is true [Hz].
        """
        if self.vibration.envelope_band is not None:
            low, high = np.array(self.vibration.envelope_band) / (2.0 * np.pi)
            return float(low), float(high)
        low, high = noise.HIGH_BAND
        return min(low, 0.5 * highest), min(high, highest)

    @property
    def counts(self) -> dict[str, int]:
        """Sizes of a record, by the names of the arguments of `vibration`."""
        asked = self.vibration
        return {name: getattr(asked, name) for name in ("turns", "settle", "samples")}


def read_noise(
    source: str | Path, settings: Iterable[str] = (), *, bearings: int = 0
) -> NoiseScene:
    """Read a scene of the noise of a bearing.

    Args:
        source, settings: As in `read_scene`.
        bearings: Number of additional random bearings.

    Raises:
        SceneError: One line with file, line, key, fault and the allowed values.
    """
    path = find_scene(source)
    return noise_of(parse_bearing(path, settings), path, bearings)


def noise_of(data: dict[str, Any], path: Path, bearings: int = 0) -> NoiseScene:
    """Read a parsed scene of the noise of a bearing.

    Args:
        data: The scene as parsed.
        path: Its path.
        bearings: Number of random bearings; 0: that of the scene.

    Raises:
        SceneError: As `read_noise`.
    """
    top = Table(data, path)
    scene = with_speed_warnings(scene_of(data, path))
    vibration = read_keys(VibrationKeys, top.table("vibration", required=True))
    operating, deviations = top.table("operating"), top.table("deviations")
    row = rows_of(scene.element.bearing)[0].bearing
    if not row.bears_radially:
        problem = "'cylindrical_thrust_roller' has no noise here: it does not hold the"
        raise top.table("bearing").error("type", f"{problem} shaking ring radially")
    _check_operating(operating, scene)
    element = scene.running()
    bearing: Any = element.bearing
    counts = tuple(row.bearing.n_elements for row in rows_of(bearing))
    errors, common = read_deviations(deviations, counts, path.parent)
    deviations.finish()
    values = {
        "mass": vibration.mass,
        "load": scene.load,
        "speed": scene.speed,
        "errors": _of_rows(errors),
        "sensor": vibration.sensor,
        "moving_ring": _moving_ring(vibration, operating),
        **_tilt_settings(vibration, scene),
    }
    if vibration.retardation is not None:
        values["retardation"] = vibration.retardation
    with vibration.table.building(deviations, operating):
        model = noise.NoiseModel(element, **values)
        # Through the scene, so that the echo has it.
        model = dataclasses.replace(model, tilting_inertia=model.inertia)
        line = dataclasses.replace(
            model, element=_nominal(element), errors=_of_rows(common)
        )
    random = vibration.tolerance
    if random is None and bearings:
        random = read_keys(
            ToleranceKeys, vibration.table.table("tolerance", required=True)
        )
    tolerances, tighter = (
        (None, ()) if random is None else read_tolerance(random, bearing)
    )
    shaft = float(model.shaft_speed) / (2.0 * np.pi)
    most = noise.bandwidth(vibration.samples, shaft)
    band = vibration.envelope_band
    if band is not None and band[1] > 2.0 * np.pi * most:
        problem = f"ends above {most:.5g} Hz, the highest of `samples` = "
        problem += f"{vibration.samples} a turn"
        raise vibration.table.error("envelope_band", problem)
    measured = vibration.measured and read_measured(
        vibration.measured, path.parent, shaft, WINDOWS[vibration.window]()
    )
    vibration.table.finish()
    inertia = model.inertia
    vibration = vibration.with_defaults(
        moving_ring=model.moving_ring,
        retardation=float(model.retardation),
        tilting_inertia=HELD if inertia is None else float(inertia),
    )
    found = NoiseScene(
        scene=scene,
        vibration=vibration,
        model=model,
        line=line,
        tolerances=tolerances,
        tighter=tighter,
        seed=0 if random is None else random.seed,
        bearings=bearings,
        measured=measured,
        warnings=scene.warnings,
    )
    own = {"deviations": deviations.echo(), "vibration": vibration.table.echo()}
    inputs = {
        **scene.inputs,
        "operating": _without_supports(scene, model.moving_ring),
        **own,
    }
    return dataclasses.replace(found, inputs=inputs)


def _of_rows(errors: tuple[FormErrors, ...]) -> FormErrors | tuple[FormErrors, ...]:
    first, *more = errors
    return errors if more else first


def _nominal(element: BearingElement) -> BearingElement:
    """Return the bearing with identical rolling elements."""
    fields = "ball_deviation", "roller_deviation", "azimuth_deviation"

    def without_deviations(bearing):
        mine = {k: None for k in fields if getattr(bearing, k, None) is not None}
        return dataclasses.replace(bearing, **mine) if mine else bearing

    bearing: Any = element.bearing
    rows = map(without_deviations, bearings_of(bearing))
    return dataclasses.replace(element, bearing=with_bearings(bearing, rows))


def _without_supports(scene: Scene, moving: str) -> dict[str, Any]:
    """Return the echo of [operating] without supports (see `tilting_inertia`)."""
    kept = dict(scene.inputs["operating"])
    for key in ("free", "prescribed"):
        kept.pop(key, None)
    return {**kept, "fixed_ring": RINGS[1 - RINGS.index(moving)]}


def _check_operating(operating: Table, scene: Scene) -> None:
    """Require rotating rings, and no held freedoms except both tilts, at zero."""
    tilts, moving = set(FREEDOMS[3:5]), set(FREEDOMS[:5])
    words = "the ring shifts in ux, uy and uz; only gx and gy may be held, both at 0"
    if set(scene.free or moving) not in (moving, moving - tilts):
        raise operating.error("free", f"is not that of a vibration: {words}")
    held = {name: x for name, x in scene.prescribed.items() if name != "gz" or x}
    if set(held) not in (set(), tilts) or any(held.values()):
        raise operating.error("prescribed", f"is not that of a vibration: {words}")
    if scene.speed is None:
        problem = "is zero" if "inner_speed" in operating else "is missing"
        rest = "and so is `outer_speed`; nothing vibrates at rest"
        raise operating.error("inner_speed", f"{problem}, {rest}")


def _tilt_settings(vibration: VibrationKeys, scene: Scene) -> dict[str, Any]:
    """Return whether the moving ring tilts, and its inertia if given."""
    held = "gx" in scene.prescribed or "gx" not in (scene.free or FREEDOMS)
    inertia = vibration.tilting_inertia
    if inertia == HELD:
        return {"tilts": False}
    if held and inertia is not None:
        problem = "is given, but [operating] holds gx and gy; choose one"
        raise vibration.table.error("tilting_inertia", problem)
    return {"tilts": not held, "tilting_inertia": inertia}


def _moving_ring(vibration: VibrationKeys, operating: Table) -> str:
    """Return the loaded ring; the outer one unless the scene names the other."""
    fixed, moving = operating.word("fixed_ring"), vibration.moving_ring
    if fixed is None:
        return moving or "outer"
    if moving == fixed:
        problem = f"{moving!r} is the `fixed_ring` of [operating]; it must be the other"
        raise vibration.table.error("moving_ring", problem)
    return RINGS[1 - RINGS.index(fixed)]

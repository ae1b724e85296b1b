"""Tables of the rotor analyses beyond modes: Campbell diagram, response, motion."""

from typing import Any

import numpy as np

from ...element.frame import FREEDOMS
from ...files.quantity import scene_number
from ...files.schema import Keys, key_of, scene_key
from ...rotor.nonlinear import HarmonicBalance

METHODS = ("linear", "harmonic_balance", "shooting")
MOST_SPEEDS, MOST_POINTS, MOST_SAMPLES, MOST_TIMES = 2000, 5000, 1024, 20_000
_BALANCE: Any = {"only": {"method": ("harmonic_balance",)}}
_PERIODIC: Any = {"only": {"method": ("harmonic_balance", "shooting")}}
_STATION: Any = {
    "least": 0,
    "otherwise": "that of the first unbalance, or else disc; without these the middle",
}


class CampbellKeys(Keys):
    about = "[rotor.campbell]: speeds of the Campbell diagram"

    begin: float = scene_key("first speed", "speed", name="from", default=0.0)
    end: float = scene_key("last speed, the higher one", "speed", name="to")
    count: int = scene_key("number of speeds", default=31, least=2, most=MOST_SPEEDS)

    def check(self) -> None:
        if not self.end > self.begin:
            last, first = (scene_number(x, "speed") for x in (self.end, self.begin))
            raise self.table.error("to", f"{last} is not above `from`, {first}")

    @property
    def speeds(self) -> np.ndarray:
        """Speeds of the Campbell diagram (speed,) [rad/s]."""
        return np.linspace(self.begin, self.end, self.count)


class ResponseKeys(Keys):
    about = "[rotor.response]: periodic vibration over a range of frequencies"

    begin: float = scene_key(
        "first frequency of the excitation, in Hz or rpm",
        "frequency",
        name="from",
        above=0,
    )
    end: float = scene_key(
        "last frequency, higher or lower", "frequency", name="to", above=0
    )
    method: str = scene_key(
        "how it is solved; `linear` takes the slopes of the bearings",
        choices=METHODS,
        default="harmonic_balance",
    )
    harmonics: int = key_of(
        HarmonicBalance, "harmonics", most=MOST_SAMPLES // 4, **_BALANCE
    )
    samples: int = key_of(
        HarmonicBalance,
        "samples",
        default=None,
        least=4,
        most=MOST_SAMPLES,
        otherwise="64, or four times `harmonics` if that is more",
        follows=lambda values: max(64, 4 * values["harmonics"]),
        **_BALANCE,
    )
    steps: int = key_of(
        HarmonicBalance, "steps", least=8, most=MOST_SAMPLES, **_PERIODIC
    )
    points: int = scene_key(
        "most points of the curve; of a linear one their number",
        default=None,
        least=2,
        most=MOST_POINTS,
        otherwise="500; 201 of a linear one",
        follows=lambda values: 201 if values["method"] == "linear" else 500,
    )
    speed: float | None = scene_key(
        "speed of the rotor", "speed", otherwise="that of the excitation"
    )
    reduction: int | None = scene_key(
        "Craig-Bampton modes that stand for the shaft",
        least=0,
        otherwise="all freedoms",
        **_PERIODIC,
    )
    scale: float | None = scene_key(
        "displacement that is called one",
        "length",
        above=0,
        otherwise="that of preload or weight; on springs the largest linear vibration",
        **_PERIODIC,
    )
    station: int | None = scene_key("station shown in report and picture", **_STATION)
    coordinate: str = scene_key(
        "coordinate shown there", choices=FREEDOMS[:5], default="uy"
    )

    def check(self) -> None:
        if self.begin == self.end:
            end = scene_number(self.end, "frequency")
            raise self.table.error("to", f"{end} is `from` itself; give a range")
        least = 2 * self.harmonics
        if self.samples <= least:
            problem = f"{self.samples} is not allowed; above twice `harmonics`, {least}"
            raise self.table.error("samples", problem)


class TransientKeys(Keys):
    about = "[rotor.transient]: motion in time from rest in the static equilibrium"

    duration: float = scene_key("duration", "time", above=0, most=1e4)
    speed_to: float | None = scene_key(
        "speed at the end of an even run-up", "speed", otherwise="`rotor.speed`"
    )
    n_times: int = scene_key(
        "number of times that are reported", default=1001, least=2, most=MOST_TIMES
    )
    tolerance: float = scene_key(
        "tolerance of the integration", default=1e-6, least=1e-12, most=1e-2
    )
    max_steps: int = scene_key("most steps of the integration", default=200_000)
    reduction: int | None = key_of(ResponseKeys, "reduction", only={})
    passage: bool = scene_key(
        "whether rolling elements orbit with the cage", default=False
    )
    station: int | None = key_of(ResponseKeys, "station")
    coordinate: str = key_of(ResponseKeys, "coordinate")

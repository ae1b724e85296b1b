"""The table [vibration.measured]: a measured record or spectrum."""

import warnings
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from ...files.column_list import read_list
from ...files.schema import Keys, scene_key
from ...files.table import Table
from ...files.text_file import check_regular
from ...noise import AbstractWindow, Spectrum, spectrum
from ...numerics.types import in_numpy
from ...numerics.units import unit

_LEAST = 64
"""Least number of samples."""
_UNEVEN = 0.1
"""Largest distance of a time from even ones, over their step [1]."""
_KINDS = {
    "time": "time",
    "acceleration": "acceleration",
    "frequency": "frequency",
    "amplitude": "acceleration",
}


class MeasuredKeys(Keys):
    about = "[vibration.measured]: measured acceleration, beside the calculated one"

    file: str = scene_key(
        'WAV file; or CSV file with the columns "time [s]" and "acceleration [m/s^2]",'
        ' or "frequency [Hz]" and "amplitude [m/s^2]", peak values'
    )
    full_scale: float | None = scene_key(
        "acceleration at full scale of a WAV file",
        "acceleration",
        above=0,
        otherwise="not known: its levels are relative to its largest line",
    )
    channel: int | None = scene_key(
        "channel of a WAV file, from 0", least=0, otherwise="the only one"
    )


class Measurement(NamedTuple):
    """Acceleration measured along the sensor.

    Attributes:
        name: Name of the file.
        spectrum: On its own lines [m/s²]; without unit relative to full scale [1].
        has_unit: Whether its unit is known.
        rate: Sampling rate of the record [Hz]; 0 of a spectrum.
        samples: Record (sample,), in the unit of the spectrum; `None` of a spectrum.
    """

    name: str
    spectrum: Spectrum
    has_unit: bool
    rate: Annotated[float, unit("Hz")]
    samples: np.ndarray | None = None


def read_measured(
    keys: MeasuredKeys, folder: Path, shaft_frequency: float, window: AbstractWindow
) -> Measurement:
    """Read a measured record or spectrum; of an odd number of samples not the last.

    Args:
        keys: `[vibration.measured]`.
        folder: Folder of the scene.
        shaft_frequency: [Hz].
        window: Window of the spectrum of a record.

    Raises:
        SceneError: For a file that cannot be read or does not suit.
    """
    table, path, scale = keys.table, folder / keys.file, 1.0
    if path.suffix.lower() == ".wav":
        rate, values = _read_wav(keys, path)
        scale = keys.full_scale
    else:
        for key in ("full_scale", "channel"):
            if key in table:
                raise table.error(key, "is of WAV files; a CSV file names its units")
        columns = read_list(table, folder, _KINDS, "samples")
        if set(columns) == {"frequency", "amplitude"}:
            lines, size = map(jnp.asarray, columns.values())
            lines = lines / (2.0 * np.pi)
            if len(lines) < 2 or np.diff(lines, prepend=-1e-9).min() <= 0:
                raise table.error("file", "frequencies must rise, from 0 or above")
            table.fill("file", str(path.resolve()))
            order = lines / shaft_frequency
            found = Spectrum(lines, order, size.astype(complex), window)
            return Measurement(path.name, in_numpy(found), True, 0.0)
        if set(columns) != {"time", "acceleration"}:
            problem = 'must have the columns "time [s]" and "acceleration [m/s^2]", or'
            problem += ' "frequency [Hz]" and "amplitude [m/s^2]"'
            raise table.error("file", problem)
        rate, values = _even_rate(table, columns["time"]), columns["acceleration"]
    if len(values) < _LEAST or not np.ptp(values) > 0:
        problem = f"has {len(values)} samples, or all alike"
        raise table.error("file", f"{problem}; at least {_LEAST} are needed")
    values = values[: len(values) // 2 * 2] * (scale or 1.0)
    with table.building(duration="file"):
        found = spectrum(values, len(values) / rate, shaft_frequency, window=window)
    table.fill("file", str(path.resolve()))
    return Measurement(path.name, in_numpy(found), scale is not None, rate, values)


def _even_rate(table: Table, time: np.ndarray) -> float:
    """Return the sampling rate of even times [Hz]."""
    step = (time[-1] - time[0]) / max(len(time) - 1, 1)
    off = np.abs(time - time[0] - step * np.arange(len(time)))
    if not step > 0 or off.max() > _UNEVEN * step:
        problem = f"time steps are uneven, as at row {int(np.argmax(off)) + 1}"
        raise table.error("file", f"{problem}; resample the record evenly")
    return float(1.0 / step)


def _read_wav(keys: MeasuredKeys, path: Path) -> tuple[float, np.ndarray]:
    """Return the sampling rate [Hz] and the samples of a channel, over full scale."""
    from scipy.io import wavfile

    table, number = keys.table, keys.channel
    try:
        check_regular(path)
        with warnings.catch_warnings():  # of chunks without samples
            warnings.simplefilter("ignore", wavfile.WavFileWarning)
            rate, samples = wavfile.read(path)
    except Exception as error:  # of a damaged file many kinds
        problem = f"{keys.file}: is no WAV file that can be read: {error}"
        raise table.error("file", problem) from error
    channels: Any = samples.reshape(len(samples), -1)
    count = channels.shape[1]
    if (number is None and count > 1) or (number or 0) >= count:
        problem = f"must be one of 0 to {count - 1}, the channels of {path.name}"
        raise table.error("channel", problem)
    values = channels[:, number or 0]
    if values.dtype.kind in "iu":
        size = 2.0 ** (8 * values.dtype.itemsize - 1)
        values = (values - (size if values.dtype.kind == "u" else 0.0)) / size
    if not np.isfinite(values).all():
        raise table.error("file", f"{keys.file}: has samples that are no numbers")
    return float(rate), np.asarray(values, float)

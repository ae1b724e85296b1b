"""Outputs of a sweep by name: which class states their unit and their axes."""

from collections.abc import Mapping

import numpy as np

from ..fits.fits import Mounting
from ..life.life import Life
from ..numerics.labels import LabelledArray, labelled_fields, summaries
from ..statics.solution import BallSolution, RollerSolution
from .cases import Cases

OPERATING_CLEARANCE = "operating_radial_clearance"
"""Output of sweeps of bearings on their seats: the clearance with which they run."""

OPERATING_PRELOAD = "operating_preload"
"""Output of sweeps of sets on their seats: the preload between the unloaded rows."""

_KINDS = RollerSolution, BallSolution, Life, Mounting

FIELD_OF_LARGEST = summaries(RollerSolution) | summaries(BallSolution)
"""Fields of a `Solution` by the name of the output that is their largest number."""

_FIELD_OF = FIELD_OF_LARGEST | {
    OPERATING_CLEARANCE: "radial_clearance",
    OPERATING_PRELOAD: "roller_load",
}
"""Fields that have the units of outputs of other names."""


def label_output(name: str, values: np.ndarray) -> LabelledArray:
    """Return an output of a sweep with the unit and axes of the field that it has.

    Args:
        name: Name of the output; of no field: a pure number, its axes numbered.
        values: Its values (case, …).
    """
    field = _FIELD_OF.get(name, name)
    for kind in _KINDS:
        if field in kind.__dataclass_fields__:
            found = LabelledArray.field(kind, field, values, ["case"])
            break
    else:
        found = LabelledArray(np.asarray(values), ())
    if len(found.axes) == values.ndim and found.axes[0] == "case":
        return found
    # A user's own array under the name of a field: its axes are unknown.
    axes = ("case", *(f"{name}_{k}" for k in range(1, values.ndim)))
    units = found.units if isinstance(found.units, str) else "1"
    return LabelledArray(found.values, axes, units)


def label_cases(cases: Cases) -> Mapping[str, LabelledArray]:
    """Return the arrays of cases with their labels; `prescribed_ux` and the like."""
    found = labelled_fields(cases)
    for name, values in cases.prescribed.items():
        found[f"prescribed_{name}"] = cases.label_entry(name, values)
    return found

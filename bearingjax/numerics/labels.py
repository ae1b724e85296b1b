"""Labels of results: axes and units of the arrays of a class, and xarray of them.

A field states its axes in its annotation, `Float[Array, "element raceway=2"]`, and its
unit beside it. Tables, reports, JSON and xarray read both from there.
"""

import dataclasses
import inspect
import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, get_args

import numpy as np

from .result import Result
from .units import Units, entry_unit, field_metadata

AXIS_LABELS: dict[str, tuple[str, ...]] = {}
"""Names of the entries along an axis, by the name of the axis, from `name_axis`."""


def name_axis(axis: str, labels: Iterable[str]) -> tuple[str, ...]:
    """Name the entries along an axis of results, and return their names.

    Args:
        axis: Name of the axis, as in annotations.
        labels: Names of its entries.
    """
    AXIS_LABELS[axis] = tuple(labels)
    return AXIS_LABELS[axis]


def axes_of(owner: Any, name: str) -> tuple[str, ...] | None:
    """Return the names of the axes of a field, as its annotation has them.

    Args:
        owner: Class of the field, or an instance.
        name: Field.

    Returns:
        Names in order: a number for an axis without a name, "*name" for any number of
        axes; `None` if the annotation states no axes.
    """
    kind = owner if isinstance(owner, type) else type(owner)
    for base in kind.__mro__:
        annotation = inspect.get_annotations(base).get(name)
        if annotation is not None:
            stated = stated_axes(annotation)
            return stated and tuple(axis.partition("=")[0] for axis in stated)
    return None


def stated_axes(annotation: Any) -> tuple[str, ...] | None:
    """Return the axes of an annotation: none of a number; "2" or "raceway=2" of a fixed
    length.

    Returns:
        Axes in order; `None` if it is no type of arrays.
    """
    if isinstance(stated := getattr(annotation, "dim_str", None), str):
        return tuple(stated.split())
    found = map(stated_axes, get_args(annotation))
    return next((axes for axes in found if axes is not None), None)


def summaries(kind: type) -> dict[str, str]:
    """Return the fields of a class whose largest number is a result, by its name.

    Args:
        kind: Class whose fields state `unit(..., largest=name)`.
    """
    fields = dataclasses.fields(kind)
    return {f.metadata["largest"]: f.name for f in fields if "largest" in f.metadata}


def array_fields(result: Any) -> dict[str, np.ndarray]:
    """Return the fields of a result that are arrays or numbers, in NumPy."""
    names = getattr(result, "_fields", None)
    if names is None:
        names = [field.name for field in dataclasses.fields(result)]
    values = {name: getattr(result, name) for name in names}
    return {
        name: np.asarray(value)
        for name, value in values.items()
        if hasattr(value, "dtype") or isinstance(value, float | int)
    }


@dataclasses.dataclass(frozen=True)
class LabelledArray:
    """An array with its labels.

    Attributes:
        values: The array.
        axes: Name of every axis.
        units: SI unit, or those of the entries along its last axes, as in `unit`.
        mixed: Units of entries in no order, as in `mixed`.
    """

    values: np.ndarray
    axes: tuple[str, ...]
    units: Units = "1"
    mixed: tuple[str, ...] = ()

    @classmethod
    def field(
        cls, owner: Any, name: str, values: Any, leading: Sequence[str] = ()
    ) -> "LabelledArray":
        """Return values of a field with the labels that its class states.

        Args:
            owner: Class of the field, or an instance.
            name: Field.
            values: Its values, of the shape that the class states or another one, then
                without names.
            leading: Names of axes that lead those of the class.
        """
        values, stated = np.asarray(values), axes_of(owner, name)
        axes = _axis_names(name, stated, values.ndim, leading)
        sizes = zip(axes, values.shape, strict=True)
        if any(len(AXIS_LABELS.get(axis, "")) not in (0, n) for axis, n in sizes):
            axes = _axis_names(name, (), values.ndim, ())
        units = field_metadata(owner, name)
        return cls(values, axes, units.get("unit", "1"), units.get("units", ()))

    def labels(self, axis: int) -> tuple[str, ...] | None:
        """Return the names of the entries along an axis, or `None`."""
        known = AXIS_LABELS.get(self.axes[axis], ())
        return known if len(known) == self.values.shape[axis] else None

    def columns(self, name: str) -> Iterator[tuple[str, tuple[str, ...], np.ndarray]]:
        """Yield every column along the first axis: header, names of its entry, values.

        The header is "name_axis [unit]". Entries have their names along the last axes;
        before an axis without names they are counted.

        Args:
            name: Name of the array; empty: none.
        """
        shape, known = self.values.shape[1:], []
        for axis in range(len(shape), 0, -1):
            known.insert(0, self.labels(axis) if None not in known else None)
        for index in itertools.product(*map(range, shape)):
            names = [
                str(k) if labels is None else labels[k]
                for labels, k in zip(known, index, strict=True)
            ]
            label = "_".join([name, *names] if name else names)
            header = column_header(label, entry_unit(self.units, index))
            yield header, tuple(names), self.values[(slice(None), *index)]


def column_header(name: str, unit: str) -> str:
    """Return the header of a column, with the unit, if any, in brackets."""
    return f"{name} [{unit}]" if unit else name


def labelled_fields(result: Any, *parts: str) -> dict[str, LabelledArray]:
    """Return the arrays of a result with the labels that its class states.

    Axes that lead those of the class, such as of `jax.vmap`, are called "case"; of
    several, "case_0", "case_1", ….

    Args:
        result: Dataclass or named tuple.
        parts: Fields that are results themselves, or `None`: their arrays are included;
            one of a name that is taken is called "part_name".
    """
    more = []
    for name, values in array_fields(result).items():
        axes = axes_of(result, name)
        if axes is not None and not any(map(_any_number, axes)):
            more.append(values.ndim - len(axes))
    cases = _numbered_labels("case", max(0, min(more, default=0)))
    found: dict[str, LabelledArray] = {}
    for part in ("", *parts):
        owner = getattr(result, part) if part else result
        for name, values in ({} if owner is None else array_fields(owner)).items():
            shown = f"{part}_{name}" if name in found else name
            found[shown] = LabelledArray.field(owner, name, values, cases)
    return found


def _any_number(axis: str) -> bool:
    return axis.startswith(("*", "..."))


def _axis_names(
    name: str, stated: Sequence[str] | None, ndim: int, leading: Sequence[str]
) -> tuple[str, ...]:
    """Return a name for each axis of a field; numbered if they are not as stated."""
    stated = ["..."] if stated is None else stated
    free = ndim - len(leading) - sum(not _any_number(axis) for axis in stated)
    if free < 0 or (free and not any(map(_any_number, stated))):
        return tuple(f"{name}_{k}" for k in range(ndim))
    axes = list(leading)
    for k, axis in enumerate(stated):
        if _any_number(axis):
            axes += _numbered_labels(axis.strip("*.") or name, free)
        else:
            axes.append(f"{name}_{k}" if axis.isdigit() or axis == "_" else axis)
    return tuple(axes)


def _numbered_labels(name: str, count: int) -> list[str]:
    return [name] if count == 1 else [f"{name}_{k}" for k in range(count)]


def to_xarray(result: Any, *parts: str) -> Any:
    """Return the arrays of a result as an `xarray.Dataset`.

    Dimensions have the names of the axes, their entries those of `name_axis`, and
    variables their SI unit as the attribute `units`. `result` holds words.

    Args:
        result: Dataclass or named tuple.
        parts: As in `labelled_fields`.

    Raises:
        ImportError: Without xarray.
    """
    return make_dataset(labelled_fields(result, *parts))


def make_dataset(
    arrays: Mapping[str, LabelledArray],
    labels: Mapping[str, Sequence[str]] | None = None,
) -> Any:
    """Return labelled arrays as an `xarray.Dataset`.

    Args:
        arrays: By name.
        labels: Names of the entries of axes, in addition to those of `name_axis`.

    Raises:
        ImportError: Without xarray.
    """
    try:
        import xarray
    except ImportError as error:
        problem = 'to_xarray needs xarray: pip install "bearingjax[table]"'
        raise ImportError(problem) from error
    known = {**AXIS_LABELS, **(labels or {})}
    sizes: dict[str, int] = {}
    variables = {}
    for name, array in arrays.items():
        values = array.values
        if name == "result" and values.dtype.kind in "iu":
            values = np.array([code.label for code in Result])[values]
        axes = []
        for axis, size in zip(array.axes, values.shape, strict=True):
            taken = axis in arrays and arrays[axis].axes != (axis,)
            axis = f"{axis}_axis" if taken else axis
            if sizes.setdefault(axis, size) != size:
                axis = f"{axis}_of_{name}"
                sizes[axis] = size
            axes.append(axis)
        units = dict.fromkeys(map(str, (*np.ravel(array.units), *array.mixed)))
        words = ", ".join(unit for unit in units if unit != "1")
        variables[name] = (axes, values, {"units": words} if words else {})
    coordinates = {
        axis: list(known[axis])
        for axis, size in sizes.items()
        if axis in known and len(known[axis]) == size and axis not in variables
    }
    return xarray.Dataset(variables, coordinates)

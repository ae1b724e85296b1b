"""Design variables: their paths in the design, and their bounds."""

import dataclasses
import difflib
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ..design.checks import all_of_class, must_be
from ..files.scene_errors import problem_of
from ..numerics.units import shown_number, unit_of
from .system import Design


@dataclasses.dataclass(frozen=True)
class Variable:
    """A number of the design that an optimisation may change.

    Attributes:
        path: Its dotted path in the element, "bearing.roller_profile.crown_radius"; in
            a set "bearing.rows.0.bearing.…"; in a system from there,
            "model.element.bearing.…"; numbers at the end are the entry of an array.
            Several paths share one value.
        lower: Least value [SI].
        upper: Largest value [SI].
        start: First value [SI]; `None`: that of the design.
        name: In messages and reports; default: the first path.

    Raises:
        TypeError: If a bound is no number, or a path no text.
        ValueError: For bounds that are not finite or not ascending, or a start outside.
    """

    path: Any  # a text, or several; afterwards a tuple of texts
    lower: Any  # numbers; afterwards floats
    upper: Any
    start: Any = None
    name: str = ""

    def __post_init__(self):
        paths = (self.path,) if isinstance(self.path, str) else tuple(self.path)
        texts = bool(paths) and all(isinstance(p, str) and p for p in paths)
        allowed = "a dotted text such as 'bearing.roller_profile.crown_radius'"
        must_be(self, "path", self.path, texts, f"{allowed}, or several", TypeError)
        object.__setattr__(self, "path", paths)
        object.__setattr__(self, "name", self.name or paths[0])
        for key in ("lower", "upper", "start"):
            value = getattr(self, key)
            if key == "start" and value is None:
                continue
            try:
                plain = float(value)
            except (TypeError, ValueError):
                raise TypeError(
                    f"Variable: `{key}` of {self.name} is {value!r}; it must be a"
                    " number in SI (units belong in scene files)."
                ) from None
            if not math.isfinite(plain):
                raise ValueError(
                    f"Variable: `{key}` of {self.name} is {plain}; it must be finite."
                )
            object.__setattr__(self, key, plain)
        if not self.lower < self.upper:
            raise ValueError(
                f"Variable: `lower` of {self.name} is {self.lower:g}; it must be below"
                f" `upper`, {self.upper:g}."
            )
        if self.start is not None:
            self._check_start(self.start)

    def _check_start(self, start: float, unit: str = "") -> None:
        if not self.lower <= start <= self.upper:
            first, low, high = (
                shown_number(x, unit) for x in (start, self.lower, self.upper)
            )
            raise ValueError(
                f"Variable: the start of {self.name} is {first}; it must lie between"
                f" its bounds, {low} and {high}."
            )

    def start_in(self, element: Design) -> float:
        """First value: `start`, or that of the design [SI].

        Raises:
            ValueError: If the path does not lead to a number, or the number of the
                design lies outside the bounds.
        """
        there = design_numbers(element, entries=True)
        for path in self.path:
            if path not in there:
                there = design_numbers(element)
                raise ValueError(
                    f"Variable: `path` is {path!r}, where the design has no"
                    f" number{_suggest(path, there)}; there are"
                    f" {', '.join(there)}."
                )
        if self.start is not None:
            return self.start
        start = float(there[self.path[0]])
        self._check_start(start, unit_of(element, self.path[0]))
        return start


def design_numbers(design: Any, entries: bool = False) -> dict[str, Any]:
    """Every single real number of a design, by its dotted path.

    Args:
        design: An element, bearing or part.
        entries: Whether those of arrays are listed too, "shafts.0.outer_diameter.1";
            the design is then concrete.
    """
    leaves, _ = jax.tree_util.tree_flatten_with_path(design)
    found: dict[str, Any] = {}
    for keys, leaf in leaves:
        if not jnp.issubdtype(jnp.result_type(leaf), jnp.floating):
            continue
        if jnp.shape(leaf) == ():
            found[dotted_path(keys)] = leaf
        elif entries:
            head, values = dotted_path(keys), np.asarray(leaf)
            for index, one in np.ndenumerate(values):
                found[".".join([head, *map(str, index)])] = one
    return found


def dotted_path(keys: Any) -> str:
    """Dotted path of a leaf.

    Args:
        keys: As of `jax.tree_util.tree_flatten_with_path`.
    """
    names = [str(getattr(k, "name", getattr(k, "idx", k))) for k in keys]
    # Laws have the paths of the keywords of BearingElement.
    return ".".join(name for name in names if name != "choices")


def with_numbers(design: Any, values: Mapping[str, Any]) -> Any:
    """The design with other numbers, constructed again, so that its checks run.

    A bearing with another dimension on which its load ratings depend no longer has
    the published ones.

    Args:
        design: An element, bearing or part.
        values: New numbers by dotted path [SI]; traced ones pass unchecked.

    Raises:
        ValueError: If a part does not allow its new number.
    """
    if "" in values:
        return values[""]
    inner: dict[str, dict[str, Any]] = {}
    for path, value in values.items():
        head, _, rest = path.partition(".")
        inner.setdefault(head, {})[rest] = value
    if isinstance(design, jax.Array | np.ndarray):
        for entry, value in values.items():
            index = tuple(map(int, entry.split(".")))
            design = jnp.asarray(design).at[index].set(value)
        return design
    if isinstance(design, tuple):
        parts = enumerate(design)
        return tuple(
            with_numbers(p, inner[str(k)]) if str(k) in inner else p for k, p in parts
        )
    parts = {k: with_numbers(getattr(design, k), v) for k, v in inner.items()}
    published = getattr(design, "published", None)
    if published is not None and set(parts) & set(design.rated_fields):
        # At its start too, or the first step would leap to the ratings of standards.
        parts["published"] = published.without_ratings()
    if hasattr(design, "with_parts"):
        return design.with_parts(**parts)
    return dataclasses.replace(design, **parts)


def with_values(element: Design, paths: Sequence[Sequence[str]], values: Any) -> Any:
    """The element with other numbers, each at all of its paths.

    Args:
        element: The design.
        paths: Dotted paths of each number, one sequence a number.
        values: The numbers [SI].

    Raises:
        ValueError: If the design does not allow them.
    """
    pairs = zip(paths, values, strict=True)
    return with_numbers(element, {path: v for several, v in pairs for path in several})


def rated_paths(design: Any, paths: Iterable[str]) -> list[str]:
    """Return the paths of numbers without which a bearing has no published ratings.

    Args:
        design: An element, installed bearing, or system, of known numbers.
        paths: Dotted paths of numbers that change.
    """
    found = []
    for path in paths:
        *parts, name = path.split(".")
        owner = design
        for part in parts:
            owner = owner[int(part)] if part.isdecimal() else getattr(owner, part)
        published = getattr(owner, "published", None)
        if published is not None and name in owner.rated_fields:
            found += [path] if np.any(published.ratings) else []
    return found


def check_variables(
    element: Design, variables: Sequence[Variable], owner: str = "optimise"
) -> list[float]:
    """Raise unless the design allows the start and each bound by itself.

    Args:
        element: The design.
        variables: Its variables.
        owner: Function that was called, for messages.

    Returns:
        The first values [SI].

    Raises:
        TypeError: If one is no Variable.
        ValueError: If a start or bound is not allowed, there is no variable, or a
            number is named twice.
    """
    if not variables:
        raise ValueError(f"{owner}: `variables` is empty; name at least one.")
    all_of_class(owner, "variables", variables, Variable, "Variables")
    start = [variable.start_in(element) for variable in variables]
    paths = [path for variable in variables for path in variable.path]
    twice = sorted({path for path in paths if paths.count(path) > 1})
    if twice:
        raise ValueError(f"{owner}: {', '.join(twice)} is a variable twice.")
    where = [variable.path for variable in variables]
    with_values(element, where, start)
    for k, variable in enumerate(variables):
        for key in ("lower", "upper"):
            bound = getattr(variable, key)
            try:
                with_values(element, where, [*start[:k], bound, *start[k + 1 :]])
            except ValueError as error:
                shown = shown_number(bound, unit_of(element, variable.path[0]))
                raise ValueError(
                    f"Variable: `{key}` of {variable.name} is {shown}, which the"
                    f" design does not allow: {problem_of(error)}."
                ) from error
    return start


def check_same_in_cases(
    owner: str, numbers: Iterable[Any], cases: Any, varied: Iterable[str] = ()
) -> None:
    """Raise ValueError if a number that is to change is another one in each case.

    Args:
        owner: Function that was called, for messages.
        numbers: Variables, or others with `name` and `path`, which is several.
        cases: Operating cases; those of a system may have `paths`.
        varied: Dotted paths of more numbers that differ from case to case.
    """
    given = [*getattr(cases, "paths", ()), *varied]
    for one in numbers:
        for path in one.path:
            if any(f"{path}.".startswith(f"{other}.") for other in given):
                raise ValueError(
                    f"{owner}: {one.name} differs from case to case; take it out of the"
                    " cases, or leave it as they have it."
                )


def _suggest(word, known):
    close = difflib.get_close_matches(word, known, 1, 0.6)
    return f" (did you mean {close[0]!r}?)" if close else ""

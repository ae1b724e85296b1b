"""Rating life of a scene as text, and as numbers in SI."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...element.frame import RINGS
from ...life.life import LIFE_OUTPUTS, Life, LifeConditions
from ...life.life_warning import LEAST_LOAD, minimum_load
from ...life.required_life import NEEDED, RequiredLife, judge_life
from ...report.json_output import to_json
from ...report.report_model import Column, Grid, Part
from ...statics.solution import RollerSolution, Solution
from .life_ratings import RATING_SOURCES, rating_origins, why_not_published
from .read_operating import relative_speed
from .read_scene import Scene

_SYMBOLS = ("C", "C0", "C_u")


def life_as_dict(life: Life, scene: Scene) -> dict[str, Any]:
    """Return the numbers of a rating life in SI, by name; infinite ones are null.

    Args:
        life: In NumPy.
        scene: Its scene.

    Returns:
        The available numbers of `LIFE_OUTPUTS`, the ratings as in
        `ratings_as_dict`, `minimum_load`, `reliability_factor`, `weakest` (row, ring,
        track), and the `standards` that results follow.
    """
    found = ratings_as_dict(life.ratings, rating_origins(scene, life.ratings))
    for name in (*LIFE_OUTPUTS, "reliability_factor"):
        found[name] = to_json(getattr(life, name))
    row, ring, track = life.weakest
    found["weakest"] = {"row": row, "ring": ring, "track": track}
    found["minimum_load"] = minimum_load(scene.element.bearing, life.ratings)
    return {**found, "standards": dict(life.standards)}


def life_verdict(scene: Scene, life: Life) -> RequiredLife | None:
    """Judge a life by that which [life] requires; `None` if none is, or hours at rest.

    Args:
        scene: The scene.
        life: Its life, in NumPy.
    """
    damage = float(life.damage)
    factor = over_required(
        scene.life, life.life_hours, 1 / damage if damage else np.inf
    )
    if factor is None or scene.life is None:
        return None
    numbers = {name: getattr(life, name) for name in NEEDED}
    return judge_life(
        scene.element.bearing,
        scene.life,
        factor,
        factor * float(life.basic_rating_life) * damage,
        float(life.ratings.dynamic_capacity),
        {k: np.asarray(v)[None] for k, v in numbers.items() if v is not None},
    )


def over_required(
    conditions: LifeConditions | None, hours: Any, revolutions: Any
) -> float | None:
    """Return a life over the required one [1]; `None` if none is required, or hours at
    rest.

    Args:
        conditions: Conditions of the life; `None`: no life is asked for.
        hours: The life [h]; `None` at rest.
        revolutions: The life [rev].
    """
    if conditions is None or conditions.required is None:
        turns = None if conditions is None else conditions.required_revolutions
        return None if turns is None else float(revolutions) / float(turns)
    return None if hours is None else float(hours) / float(conditions.required)


def verdict_as_dict(
    conditions: LifeConditions | None, verdict: RequiredLife | None
) -> dict[str, Any]:
    """Return a verdict: `required_hours` or `required_revolutions`, `kept`, `factor`,
    and where they are known `needed`, the other fields of `RequiredLife`, in SI; empty
    without one."""
    if conditions is None or verdict is None:
        return {}
    asked = conditions.required, conditions.required_revolutions
    names = "required_hours", "required_revolutions"
    found = {k: float(v) for k, v in zip(names, asked, strict=True) if v is not None}
    needed = to_json(dataclasses.asdict(verdict))
    found |= {"kept": verdict.kept, "factor": needed.pop("factor")}
    return found if verdict.dynamic_capacity is None else {**found, "needed": needed}


def verdict_in_words(
    conditions: LifeConditions | None, verdict: RequiredLife | None
) -> list[str]:
    """Say whether the required life is kept, and what it would take.

    Args: as `verdict_as_dict`.
    """
    if conditions is None or verdict is None:
        return []
    hours, turns = conditions.required, conditions.required_revolutions
    asked = f"{float(hours or turns or 0.0):.5g} {'rev' if hours is None else 'h'}"
    oiled = conditions.viscosity is not None
    lines = [
        f"required {asked}: {'kept' if verdict.kept else 'NOT kept'}; the"
        f" {'modified' if oiled else 'reference'} life is {life_number(verdict.factor)}"
        " times that"
    ]
    if verdict.dynamic_capacity is not None:
        words = f"C {_kilo(verdict.dynamic_capacity)} kN with Cu in proportion (for the"
        words += f" basic life {_kilo(verdict.basic_capacity)} kN)"
        size, clean = verdict.viscosity, verdict.contamination_factor
        if oiled:
            words += "; no viscosity" if size is None else f"; {1e6 * size:.4g} mm²/s"
            words += "; no cleanliness" if clean is None else f"; e_C {clean:.3g}"
            words += "".join(f", {name}" for name in verdict.cleanliness)
        lines.append(f"it takes, each by itself, at least {words}")
    return lines


def ratings_as_dict(ratings: Any, origins: Mapping[str, str]) -> dict[str, Any]:
    """Return ratings [N] by name, each with its `..._source`, "given", "published" or
    the standard, and its `..._origin` in words, `None` of a computed rating; and the
    source of the factors of axial load in P and P0.

    Args:
        ratings: `Ratings`, in NumPy.
        origins: As in `rating_origins`.
    """
    found: dict[str, Any] = {}
    for name, source in RATING_SOURCES.items():
        found[name] = to_json(getattr(ratings, name))
        found[f"{name}_source"] = getattr(ratings, source)
        found[f"{name}_origin"] = origins.get(name)
    found["axial_factors_source"] = ratings.factors_source
    return found


def ratings_in_words(ratings: Any, origins: Mapping[str, str]) -> dict[str, str]:
    """Format C, C0 and C_u in kN, each with its origin, and that of Y and Y0.

    Args: as `ratings_as_dict`.
    """
    return {
        shown: f"{shown} {_kilo(getattr(ratings, name))} kN"
        f" ({origins.get(name, getattr(ratings, source))})"
        for shown, (name, source) in zip(_SYMBOLS, RATING_SOURCES.items(), strict=True)
    } | {"Y": f"factors of axial load, Y and Y0: {ratings.factors_source}"}


def life_section(scene: Scene, solution: Solution, life: Life) -> list[Part]:
    """Return the report section of a rating life.

    Args:
        scene: Solved scene.
        solution: Its solution, in NumPy.
        life: Its life, in NumPy.
    """
    r, axially = life.ratings, "axial" if life.ratings.axial else "radial"
    lives = {
        "basic, ISO 281": life.basic_rating_life,
        "reference, ISO/TS 16281": life.reference_rating_life,
    }
    factors_line = []
    if life.modified_rating_life is not None:
        lives["modified (a1, a_ISO)"] = life.modified_rating_life
        factors = {
            "viscosity ratio": life.viscosity_ratio,
            "e_C": life.contamination_factor,
            "a_ISO": life.a_iso,
            "a1": life.reliability_factor,
        }
        parts = (f"{name} {np.asarray(x):.4g}" for name, x in factors.items())
        factors_line.append(", ".join(parts))
    elif life.reliability_factor < 0.999999:
        a1 = float(life.reliability_factor)
        lives[f"reference, a1 {a1:.4g}"] = a1 * life.reference_rating_life
    speed, hours = abs(relative_speed(solution.speed)), None
    if speed:
        hours = {k: 2.0 * np.pi / 3600.0 / speed * x for k, x in lives.items()}
    return [
        lives_grid(lives, hours),
        *factors_line,
        f"{axially} ratings",
        *(
            f"  {words}"
            for words in ratings_in_words(r, rating_origins(scene, r)).values()
        ),
        *why_not_published(scene),
        f"equivalent load: P {_kilo(life.equivalent_load)} kN, of the reference life"
        f" {_kilo(life.reference_load)} kN",
        f"static safety C0/P0 {life_number(life.static_safety)}, P0"
        f" {_kilo(life.static_equivalent_load)} kN (ISO 76)",
        *limits(solution, life),
        f"minimum load {minimum_load(scene.element.bearing, r):.4g} N"
        f" ({LEAST_LOAD[scene.element.bearing.noun]:g} C)",
        describe_turning(life.turns_against_load, solution.speed is None),
        *verdict_in_words(scene.life, life_verdict(scene, life)),
    ]


def lives_grid(lives: Mapping[str, Any], hours: Mapping[str, Any] | None) -> Grid:
    """Tabulate lives by their names.

    Args:
        lives: Lives in revolutions.
        hours: Lives in hours; `None` at rest.
    """
    columns = [
        Column("rating life", list(lives)),
        Column("", list(map(float, lives.values())), "rev"),
    ]
    if hours is not None:
        columns.append(Column("", list(map(float, hours.values())), "h"))
    return Grid(columns)


def limits(solution: Solution, life: Life) -> list[str]:
    """Describe the contact that limits the reference life.

    Args:
        solution: In NumPy.
        life: Its life, in NumPy.
    """
    share = np.asarray(life.damage_share)
    if not share.any():
        return ["no contact is loaded: no fatigue"]
    row, ring, track = life.weakest
    rows = len(solution.row_sizes)
    place = f"{ring} raceway" + (f" of row {row}" if rows > 1 else "")
    size = 100.0 * share[row, RINGS.index(ring)].sum()
    words = f"limited by the {place}: {size:.3g} % of the fatigue"
    tracks = share.shape[2]
    if isinstance(solution, RollerSolution):
        position = np.asarray(solution.position)
        at = 1e3 * np.reshape(position, (-1, position.shape[-1]))[0][2 * track + 1]
        most = 100.0 * share[row, RINGS.index(ring), track]
        words += (
            f", most in lamina {track + 1} of {tracks} at {at:.3g} mm ({most:.3g} %)"
        )
    elif tracks > 1:
        words += f", most in arc {track + 1}"
    return [words]


def describe_turning(turns: Any, at_rest: bool) -> str:
    """Describe which rings rotate relative to the load, or are assumed to at rest.

    Args:
        turns: As `Life.turns_against_load`.
        at_rest: Whether there is no speed.
    """
    rings = [ring for ring, t in zip(RINGS, np.asarray(turns), strict=True) if t]
    words = f"{' and '.join(rings)} ring{'s' if len(rings) > 1 else ''}"
    if at_rest:
        return (
            f"at rest: no life in hours; the {words} is taken as the one that turns"
            " against the load"
        )
    return f"turning against the load: {words}"


def life_number(value: Any) -> str:
    """Format a life or safety factor, or "infinite"."""
    return f"{float(value):.5g}" if np.isfinite(value) else "infinite"


def _kilo(value) -> str:
    return f"{1e-3 * float(value):.5g}"

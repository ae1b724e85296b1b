"""Conditions of the life of a scene's bearing, and the origins of its ratings."""

import dataclasses
from collections.abc import Iterable
from typing import Any

from ...design import rows_of
from ...design.bearing_set import has_separate_rings
from ...life.life import LifeConditions
from ...life.rating import GIVEN, PUBLISHED
from .read_scene import Scene


def life_conditions(scene: Scene, turning: bool = True) -> LifeConditions:
    """Return the conditions of the rating life of a scene, but for a required one.

    Ratings that [life] does not give are those that the bearing carries, published or
    from its geometry (`life.ratings`).

    Args:
        scene: The scene.
        turning: Whether the rings have a relative speed; without it there is no film
            and no modified life.
    """
    own = LifeConditions() if scene.life is None else scene.life.without_requirement
    if not turning:
        own = dataclasses.replace(own, viscosity=None, contamination=None)
    return own


RATING_SOURCES = {
    "dynamic_capacity": "dynamic_source",
    "static_capacity": "static_source",
    "fatigue_load_limit": "limit_source",
}
"""Fields of `Ratings`, and those that tell their sources."""
_OF_ROWS = ("by ISO 281", "by ISO 76", "in proportion to C0")
"""Rules by which the ratings of several rows follow."""


def rating_origins(scene: Scene, ratings: Any) -> dict[str, str]:
    """Describe the origins of ratings that are not computed, by their name.

    Args:
        scene: The scene.
        ratings: Its `Ratings`.

    Returns:
        The [life] of the scene, or the published bearing, the designation that is
        listed as it, and any scaling; ratings from the geometry are left out.
    """
    sources = {name: getattr(ratings, at) for name, at in RATING_SOURCES.items()}
    rules = dict(zip(sources, _OF_ROWS, strict=True))
    found = {
        name: "given in [life]" for name, source in sources.items() if source == GIVEN
    }
    published = [name for name, source in sources.items() if source == PUBLISHED]
    if not published:
        return found
    bearing, rows, listed = scene.element.bearing, "", ""
    words = "published for the bearing of its rows"
    own = any("bearing" in row for row in scene.inputs.get("set", {}).get("rows", ()))
    if scene.catalogue is not None and not own:
        words = f"published for {scene.catalogue.entry.designation}"
    if has_separate_rings(bearing):
        rows = f", of one row; for {len(rows_of(bearing))} rows"
    if scene.catalogue is not None:
        # A plain size has the ratings of the improved design that it is listed as.
        notes = scene.catalogue.entry.notes
        listed = "".join(f"; {note}" for note in notes if " is listed as " in note)
    for name in published:
        how = f"{rows} {rules[name]}" if rows else ""
        found[name] = f"{words}{how}{listed}"
    return found


def why_not_published(scene: Scene, varied: Iterable[str] = ()) -> list[str]:
    """Explain in a line why the published ratings are not used, if they are not."""
    if scene.catalogue is None:
        return []
    taken = scene.catalogue.override(varied)
    entry, changed = taken.entry, taken.rerated_keys
    if entry.dynamic_capacity is None:
        if scene.life is not None and scene.life.dynamic_capacity is not None:
            return []
        return [
            f"  (those of {entry.designation} are {entry.sources['capacity']}; from the"
            " balls of another one they may be some 20 % too high)"
        ]
    if not changed:
        return []
    words = f"{entry.designation}: {', '.join(changed)} differs"
    return [f"  (not the published ones of {words})"]

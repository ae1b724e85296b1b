"""Ratings for the life of a scene's bearing: given in [life], or published."""

import dataclasses
from collections.abc import Iterable

from ..design import BearingSet, rows_of
from ..statics.life import LifeConditions
from ..statics.rating import dynamic_capacity, static_capacity
from .read import Scene

_RATINGS = ("dynamic_capacity", "static_capacity", "fatigue_load_limit")
_UNRATED = (
    "designation type radial_internal_clearance axial_internal_clearance first_azimuth"
    " outer_shoulder inner_shoulder material ring_material roller_profile"
    " raceway_profile ribs rib arrangement ball_deviation roller_deviation"
    " azimuth_deviation"
).split()
"""Keys of [bearing] that do not affect the load ratings."""


def life_conditions(
    scene: Scene, varied: Iterable[str] = (), turning: bool = True
) -> LifeConditions:
    """Return the conditions of the rating life, with the ratings of the designation.

    A catalogue bearing has the published ratings where [life] gives none, scaled for
    a set by ISO 281 and ISO 76, unless the scene or its cases change dimensions that
    affect the ratings.

    Args:
        scene: The scene.
        varied: Keys varied by its cases.
        turning: Whether the rings have a relative speed; without it there is no film
            and no modified life.
    """
    own = LifeConditions() if scene.life is None else scene.life
    if not turning:
        own = dataclasses.replace(own, viscosity=None, contamination=None)
    published = _published(scene, varied)
    return dataclasses.replace(own, **{name: c for name, (c, _) in published.items()})


def rating_origins(scene: Scene, varied: Iterable[str] = ()) -> dict[str, str]:
    """Describe the origins of given ratings, by their name.

    Args:
        scene, varied: As in `life_conditions`.

    Returns:
        The [life] of the scene, or the published bearing and any scaling; ratings
        computed from the geometry are left out.
    """
    own = LifeConditions() if scene.life is None else scene.life
    found = {
        name: "given in [life]" for name in _RATINGS if getattr(own, name) is not None
    }
    return found | {name: w for name, (_, w) in _published(scene, varied).items()}


_OF_ROWS = ("by ISO 281", "by ISO 76", "in proportion to C0")
"""Rules by which ratings of several rows follow from those of one."""


def _published(scene, varied) -> dict[str, tuple[float, str]]:
    """Return the applicable published ratings [N], each with its origin."""
    own = LifeConditions() if scene.life is None else scene.life
    taken = scene.catalogue
    if taken is None or rated_otherwise(scene, varied):
        return {}
    if any("bearing" in row for row in scene.inputs.get("set", {}).get("rows", ())):
        return {}  # rows with bearings of their own
    entry, bearing = taken.entry, scene.element.bearing
    more = {"dynamic_capacity": 1.0, "static_capacity": 1.0}
    alone = entry.bearing
    several = isinstance(bearing, BearingSet) and not isinstance(alone, BearingSet)
    if several:
        for name, rate in (
            ("dynamic_capacity", dynamic_capacity),
            ("static_capacity", static_capacity),
        ):
            more[name] = float(rate(bearing)) / float(rate(alone))
    more["fatigue_load_limit"] = more["static_capacity"]
    words = f"published for {entry.designation}"
    rows = f", of one row; for {len(rows_of(bearing))} rows"
    return {
        name: (
            getattr(entry, name) * more[name],
            f"{words}{rows} {how}" if several else words,
        )
        for name, how in zip(_RATINGS, _OF_ROWS, strict=True)
        if getattr(own, name) is None and getattr(entry, name) is not None
    }


def rated_otherwise(scene: Scene, varied: Iterable[str] = ()) -> list[str]:
    """Return the changed keys of [bearing] that invalidate the published ratings.

    Args:
        scene, varied: As in `life_conditions`.
    """
    if scene.catalogue is None:
        return []
    of_bearing = [key.split(".")[1] for key in varied if key.startswith("bearing.")]
    changed = dict.fromkeys((*scene.catalogue.overridden, *of_bearing))
    return [key for key in changed if key not in _UNRATED]


def not_published(scene: Scene, varied: Iterable[str] = ()) -> list[str]:
    """Explain in a line why the published ratings are not used, if they are not.

    Args:
        scene, varied: As in `life_conditions`.
    """
    if scene.catalogue is None:
        return []
    entry, changed = scene.catalogue.entry, rated_otherwise(scene, varied)
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

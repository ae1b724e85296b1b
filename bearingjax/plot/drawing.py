"""Drawings: every number of a design where it is measured, to scale."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import equinox as eqx

from ..design import (
    RIB_NAMES,
    AbstractRollerBearing,
    Bearing,
    BearingSet,
    Material,
    Straight,
)
from .ball_drawing import ball_clearance_view, dimensioned_balls
from .face_drawing import DEVIATIONS, deviation_view, face_view
from .outline import section
from .profile_drawing import profile_view
from .roller_drawing import (
    PROFILES,
    dimensioned_rollers,
    rib_view,
    roller_clearance_view,
)
from .set_drawing import arrangement_view
from .style import head, pyplot

if TYPE_CHECKING:
    import matplotlib.figure

IN_WORDS = "material", "ring_material"
"""Fields of a bearing that have no place on a drawing: they stand below it."""
_WIDTH = 15.0
_SECTION, _FACE = (9.2, 5.4), (5.8, 5.4)
_SMALL = (4.9, 3.4)
_ACROSS = 3
_FOOT = 0.45


def drawing(
    bearing: Bearing | BearingSet, title: str = ""
) -> "matplotlib.figure.Figure":
    """A drawing of a design: every parameter at the place where it is measured.

    Labels are the names of the Python interface, with values. Sections and the view
    along the axis are to scale; clearances, gaps and profiles, too small to be seen,
    are magnified by factors that stand beside them. Ring bodies are schematic: they
    are no part of a design.

    Args:
        bearing: A bearing, or a set: its arrangement, then every different bearing.
        title: Head of the page; the kind of bearing if empty.

    Returns:
        The figure, 15 inches wide.
    """
    if not isinstance(bearing, BearingSet):
        views = _views(bearing)
        figure = _page(_height(views))
        _draw_bearing(figure, bearing, views)
        head(figure, title or type(bearing).__name__)
        return figure
    kinds = _different([row.bearing for row in bearing.rows])
    views = [_views(one) for one, _ in kinds]
    heights = [_SECTION[1] + 0.4, *(_height(part) + 0.5 for part in views)]
    figure = _page(sum(heights))
    parts: Any = figure.subfigures(len(heights), 1, height_ratios=heights)
    turned = [
        row
        for one, rows in kinds
        for row in rows
        if bearing.rows[row].bearing.first_azimuth != one.first_azimuth
    ]
    size = (_WIDTH - 0.4, _SECTION[1])
    arrangement_view(parts[0].add_subplot(), bearing, turned, size)
    for part, (one, rows), drawn in zip(parts[1:], kinds, views, strict=True):
        _draw_bearing(part, one, drawn)
        names = ", ".join(f"rows.{row}.bearing" for row in rows)
        part.suptitle(f"{names}: {type(one).__name__}", fontweight="bold")
    head(figure, title or type(bearing).__name__)
    return figure


def _page(height):
    figure = pyplot().figure(figsize=(_WIDTH, height + 0.5))
    figure.set_layout_engine("constrained", w_pad=0.05, h_pad=0.08)
    return figure


def _different(bearings):
    """Each bearing with its rows; those that differ in the first azimuth are alike."""
    kinds: list[tuple[Any, list[int]]] = []
    for row, bearing in enumerate(bearings):
        for one, rows in kinds:
            if _alike(one, bearing):
                rows.append(row)
                break
        else:
            kinds.append((bearing, [row]))
    return kinds


def _alike(one, other):
    if type(one) is not type(other):
        return False
    turned = eqx.tree_at(lambda b: b.first_azimuth, other, one.first_azimuth)
    return bool(eqx.tree_equal(one, turned))


def _height(views):
    lines = -(-len(views[1:]) // _ACROSS)
    return _SECTION[1] + lines * (_SMALL[1] + 0.5) + _FOOT


def _draw_bearing(figure, bearing, views):
    """The section beside the view along the axis, the other views below."""
    main, *others = views
    lines = [others[k : k + _ACROSS] for k in range(0, len(others), _ACROSS)]
    heights = [_SECTION[1], *[_SMALL[1] + 0.5] * len(lines), _FOOT]
    parts: Any = figure.subfigures(len(heights), 1, height_ratios=heights)
    widths = [_SECTION[0], _FACE[0]]
    left, right = parts[0].subplots(1, 2, width_ratios=widths)
    main(left)
    face_view(right, bearing, _FACE)
    for part, line in zip(parts[1:-1], lines, strict=True):
        axes = part.subplots(1, len(line), squeeze=False)[0]
        for draw, ax in zip(line, axes, strict=True):
            draw(ax)
    parts[-1].text(0.5, 0.5, _in_words(bearing), ha="center", va="center", fontsize=10)


def _views(bearing) -> list[Callable]:
    """What draws the section and the smaller views that a bearing needs."""
    views = _of_balls(bearing)
    if isinstance(bearing, AbstractRollerBearing):
        views = _of_rollers(bearing)
    return views + [
        lambda ax, name=name: deviation_view(ax, bearing, name)
        for name in DEVIATIONS
        if getattr(bearing, name, None) is not None
    ]


def _of_balls(bearing) -> list[Callable]:
    views: list[Callable] = [lambda ax: dimensioned_balls(ax, bearing, _SECTION)]
    if hasattr(bearing, "radial_internal_clearance"):
        views.append(lambda ax: ball_clearance_view(ax, bearing, _SMALL))
    return views


def _of_rollers(bearing) -> list[Callable]:
    parts = section(bearing)
    profiles = [
        lambda ax, name=name: profile_view(ax, bearing, name)
        for name in PROFILES
        if not isinstance(getattr(bearing, name), Straight)
    ]
    ribs = [
        lambda ax, names=names: rib_view(ax, bearing, parts, names, _SMALL)
        for names in _like_ribs(bearing.ribs)
    ]
    return [
        lambda ax: dimensioned_rollers(ax, bearing, parts, _SECTION),
        lambda ax: roller_clearance_view(ax, bearing, parts, _SMALL),
        *profiles,
        *ribs,
    ]


def _like_ribs(ribs):
    """Names of the ribs, those of the same dimensions together."""
    groups: dict[tuple, list[str]] = {}
    for name in RIB_NAMES:
        rib = getattr(ribs, name)
        if rib is not None:
            numbers = rib.end_radius, rib.contact_height, rib.axial_gap
            groups.setdefault(tuple(map(float, numbers)), []).append(name)
    return list(groups.values())


def _in_words(bearing):
    """What has no place on a drawing."""
    return ",   ".join(
        f"{name}: {_of_material(getattr(bearing, name))}" for name in IN_WORDS
    )


def _of_material(material: Material | None):
    if material is None:
        return "as the rolling elements"
    return (
        f"E = {1e-9 * float(material.elastic_modulus):.4g} GPa,"
        f" ν = {float(material.poisson_ratio):.3g},"
        f" ρ = {float(material.density):.5g} kg/m³"
    )

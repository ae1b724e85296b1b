"""Drawings of a design to scale, with all its dimensions."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Annotated, Any, NamedTuple

import equinox as eqx

from ...catalogue.entry import CatalogueEntry
from ...design import (
    RIB_NAMES,
    AbstractBallBearing,
    AbstractBearing,
    AbstractRollerBearing,
    BearingSet,
    Material,
    Straight,
)
from ...design.abstract import nearest_entry
from ...numerics.units import unit
from ..style import Figure, head, pyplot, write
from .dimension import label
from .face_drawing import DEVIATIONS, deviation_view, face_view
from .outline import section
from .profile_drawing import profile_view
from .row_drawing import (
    PROFILES,
    ball_clearance_view,
    dimensioned_balls,
    dimensioned_rollers,
    rib_view,
    roller_clearance_view,
)
from .section import draw_boundary
from .set_drawing import arrangement_view

MATERIALS = "material", "ring_material"
IN_WORDS = (*MATERIALS, "rated_contact_angle")
"""Fields of a bearing that are listed below a drawing, as they cannot be drawn."""
_WIDTH = 13.2
_SECTION, _FACE = (8.8, 5.2), (4.4, 5.2)
_ACROSS = 3
_SMALL = (_WIDTH / _ACROSS, 3.4)
_HEAD, _PART, _FOOT = 0.35, 0.4, 0.6
"""Height of the page's title, of a bearing's title in a set, of text [inch]."""
_MARGINS = {False: (0.05, 0.05, 0.5, 0.05), True: (0.75, 0.15, 0.5, 0.6)}
"""Margins left, right, above and below a view, with ticks if framed [inch]."""


class _View(NamedTuple):
    """A view and its place on a strip of the page.

    Attributes:
        draw: Draws it, given axes and their width and height [inch].
        size: Width and height, with title and ticks [inch].
        left, down: From the upper left corner of the strip [inch].
        framed: Whether it has ticks.
    """

    draw: Annotated[Callable[[Any, tuple[float, float]], None], unit("inch")]
    size: Annotated[tuple[float, float], unit("inch")]
    left: Annotated[float, unit("inch")] = 0.0
    down: Annotated[float, unit("inch")] = 0.0
    framed: bool = False


class _Strip(NamedTuple):
    """Views over the width of the page, or text.

    Attributes:
        height: Height of the strip [inch].
        views: Its views.
        words: In its middle.
        bold: How they are written.
    """

    height: Annotated[float, unit("inch")]
    views: Sequence[_View] = ()
    words: str = ""
    bold: bool = False


def drawing(
    bearing: AbstractBearing | BearingSet,
    title: str = "",
    catalogue: CatalogueEntry | None = None,
) -> Figure:
    """Draw a design, with every parameter at the place where it is measured.

    Labels are the names of the Python interface, with values. Sections and the view
    along the axis are to scale; clearances, gaps and profiles, too small to be seen,
    are magnified by the factors given. Ring bodies are schematic: they are no part of
    a design.

    Args:
        bearing: A bearing, or a set: its arrangement, then every different bearing.
        title: Head of the page; the kind of bearing if empty.
        catalogue: Its catalogue entry, whose boundary dimensions are drawn too.

    Returns:
        The figure, 13.2 inches wide.
    """
    whole = isinstance(bearing, BearingSet)
    figure = _page(_set_strips(bearing) if whole else _strips(bearing))
    alone: Any = bearing
    apart = bearing.is_ball and not whole  # drawn about the centre of a ball
    centre = 500.0 * float(alone.pitch_diameter) if apart else 0.0
    draw_boundary(figure.axes[0], bearing, catalogue, centre)
    place = 1.0 - 0.1 / figure.get_figheight()
    head(figure, title or type(bearing).__name__, y=place)
    return figure


def _page(strips):
    """Draw the strips below each other, at their known sizes."""
    tall = _HEAD + sum(strip.height for strip in strips)
    figure = pyplot().figure(figsize=(_WIDTH, tall), layout="none")
    top = tall - _HEAD
    for strip in strips:
        weight, size = ("bold", 12.0) if strip.bold else ("normal", 10.0)
        middle, look = (top - 0.5 * strip.height) / tall, {"fontweight": weight}
        write(figure, (0.5, middle), strip.words, fontsize=size, **look)
        for view in strip.views:
            left, right, above, below = _MARGINS[view.framed]
            wide, high = view.size[0] - left - right, view.size[1] - above - below
            foot = top - view.down - above - high
            corner = (view.left + left) / _WIDTH, foot / tall
            ax = figure.add_axes((*corner, wide / _WIDTH, high / tall))
            view.draw(ax, (wide, high))
        top -= strip.height
    return figure


def _set_strips(bearing):
    """Return strips of the arrangement and of each different bearing."""
    kinds = _distinct([row.bearing for row in bearing.rows])
    turned = [
        row
        for one, rows in kinds
        for row in rows
        if bearing.rows[row].bearing.first_azimuth != one.first_azimuth
    ]
    whole = (_WIDTH, _SECTION[1])
    rows = _View(lambda ax, size: arrangement_view(ax, bearing, turned, size), whole)
    strips = [_Strip(whole[1], [rows])]
    for one, numbers in kinds:
        names = ", ".join(f"rows.{row}.bearing" for row in numbers)
        strips.append(_Strip(_PART, words=f"{names}: {type(one).__name__}", bold=True))
        strips += _strips(one)
    return strips


def _distinct(bearings):
    """Return each bearing with its rows, ignoring the first azimuth."""
    kinds: list[tuple[Any, list[int]]] = []
    for row, bearing in enumerate(bearings):
        for one, rows in kinds:
            if _looks_alike(one, bearing):
                rows.append(row)
                break
        else:
            kinds.append((bearing, [row]))
    return kinds


def _looks_alike(one, other):
    if type(one) is not type(other):
        return False
    turned = eqx.tree_at(lambda b: b.first_azimuth, other, one.first_azimuth)
    return bool(eqx.tree_equal(one, turned))


def _strips(bearing):
    """Return strips: section and view along the axis, smaller views, text."""
    first, others = nearest_entry(_VIEWS, bearing)(bearing)
    others += [
        (lambda ax, _, name=name: deviation_view(ax, bearing, name), True)
        for name in DEVIATIONS
        if getattr(bearing, name, None) is not None
    ]
    strips = [_Strip(_SECTION[1], first)]
    for k in range(0, len(others), _ACROSS):
        line = others[k : k + _ACROSS]
        left = 0.5 * (_WIDTH - len(line) * _SMALL[0])
        views = [
            _View(draw, _SMALL, left + m * _SMALL[0], framed=framed)
            for m, (draw, framed) in enumerate(line)
        ]
        strips.append(_Strip(_SMALL[1], views))
    return [*strips, _Strip(_FOOT, words=_in_words(bearing))]


def _of_balls(bearing):
    """Return views of the first strip, and smaller ones with a flag for a frame."""
    views = [_View(lambda ax, size: dimensioned_balls(ax, bearing, size), _SECTION)]
    wide, high = _FACE
    if hasattr(bearing, "radial_internal_clearance"):
        # It finds room below the view along the axis.
        low = 0.46 * high
        high -= low
        views.append(
            _View(
                lambda ax, size: ball_clearance_view(ax, bearing, size),
                (wide, low),
                _SECTION[0],
                high,
            )
        )
    views.insert(1, _face(bearing, (wide, high)))
    return views, []


def _of_rollers(bearing):
    """Return views and details of a roller bearing, as `_of_balls`."""
    parts = section(bearing)
    views = [
        _View(lambda ax, size: dimensioned_rollers(ax, bearing, parts, size), _SECTION),
        _face(bearing, _FACE),
    ]

    def clearance(ax, size):
        roller_clearance_view(ax, bearing, parts, size)

    profiles = [
        (lambda ax, _, name=name: profile_view(ax, bearing, name), True)
        for name in PROFILES
        if not isinstance(getattr(bearing, name), Straight)
    ]
    ribs = [
        (lambda ax, size, names=names: rib_view(ax, bearing, parts, names, size), False)
        for names in _like_ribs(bearing.ribs)
    ]
    return views, [(clearance, False), *profiles, *ribs]


def _face(bearing, size):
    return _View(lambda ax, size: face_view(ax, bearing, size), size, _SECTION[0])


def _like_ribs(ribs):
    """Return names of the ribs, grouped by equal dimensions."""
    groups: dict[tuple, list[str]] = {}
    for name in RIB_NAMES:
        rib = getattr(ribs, name)
        if rib is not None:
            numbers = rib.end_radius, rib.contact_height, rib.axial_gap
            groups.setdefault(tuple(map(float, numbers)), []).append(name)
    return list(groups.values())


def _in_words(bearing):
    """Return labels of fields that cannot be drawn, and of absent deviations."""
    materials = [
        f"{name}: {_of_material(getattr(bearing, name))}" for name in MATERIALS
    ]
    numbers = [name for name in IN_WORDS[len(MATERIALS) :] if hasattr(bearing, name)]
    lacking = [name for name in DEVIATIONS if getattr(bearing, name, ()) is None]
    others = [label(bearing, name) for name in (*numbers, *lacking)]
    return "\n".join(",   ".join(line) for line in (materials, others))


def _of_material(material: Material | None):
    if material is None:
        return "as the rolling elements"
    fields = (field.name for field in dataclasses.fields(material))
    return ", ".join(label(material, name) for name in fields)


_VIEWS = {AbstractBallBearing: _of_balls, AbstractRollerBearing: _of_rollers}

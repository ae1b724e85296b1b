"""Draws `.github/axes.png`, signs and axes: python notebooks/axes_picture.py"""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import patches
from matplotlib.figure import Figure

PLACE = Path(__file__).parent.parent / ".github" / "axes.png"
OUTER, INNER, ROLLER, GREY = "#0072B2", "#D55E00", "#009E73", "#595959"
RINGS = {"fc": "#E0EDF6", "ec": OUTER}, {"fc": "#FAEBE2", "ec": INNER}
BODY: dict[str, Any] = {"fc": "#DDF1EA", "ec": ROLLER}


def arrow(ax, start, end, words="", at=None, colour="k", bend=0.0):
    """Draw an arrow with words at a place, or beyond its head."""
    look = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "lw": 1.3}
    look["connectionstyle"] = f"arc3,rad={bend}"
    ax.annotate("", end, start, arrowprops=look)
    at = np.add(end, 0.13 * np.subtract(end, start)) if at is None else at
    ax.text(*at, words, color=colour, ha="center", va="center")


def front(ax):
    """Draw the bearing seen against z: azimuth and the directions e_r, e_t."""
    around = [np.array([np.cos(a), np.sin(a)]) for a in np.radians(range(0, 360, 40))]
    for size, look, y, words in (
        (1.0, RINGS[0], -1.0, "outer"),
        (0.56, RINGS[1], -0.7, "inner"),
    ):
        ax.add_patch(patches.Annulus((0, 0), size, 0.16, **look))
        ax.plot([0.6 * size, 0.85], [-0.7 * size, y], color=look["ec"], lw=0.7)
        ax.text(0.88, y, f"{words} ring", color=look["ec"], va="center")
    for place in around:
        ax.add_patch(patches.Circle(0.7 * place, 0.14, **BODY))
    arrow(ax, (0, 0), (1.3, 0), "$x$")
    arrow(ax, (0, 0), (0, 1.3), "$y$")
    ax.plot([0, 0], [0, 0], "ko", mfc="w", ms=9)
    ax.text(-0.16, -0.18, "$z$")
    out, along = around[1], np.array([-around[1][1], around[1][0]])
    ax.plot(*np.outer(out, [0, 0.7]), color=GREY, lw=0.8)
    arrow(ax, (0.31, 0), 0.31 * out, "$\\varphi$", (0.22, 0.08), GREY, 0.2)
    arrow(ax, 0.7 * out, 1.32 * out, "$e_r$", colour=ROLLER)
    arrow(ax, 0.7 * out, 0.7 * out + 0.55 * along, "$e_t$", (0.24, 1.07), ROLLER)


def freedoms(ax):
    """Draw the six freedoms of a ring, which are the senses of the loads too."""
    flat = np.array([[1.0, 0.0], [0.0, 1.0], [-0.62, -0.50]])
    words = ((1.33, -0.16), (0.34, 1.27)), ((0.83, 0.36), (-0.46, 0.88))
    words = [
        (*a, b) for a, b in zip(words, ((-0.42, -0.7), (-0.86, -0.12)), strict=True)
    ]
    turn = np.radians(np.linspace(-150, 120, 60))
    circle = np.array([0.78 + 0 * turn, 0.2 * np.cos(turn), 0.2 * np.sin(turn)])
    for k, name in enumerate("xyz"):
        arrow(ax, (0, 0), 1.25 * flat[k], f"$u_{name}$, $F_{name}$", words[0][k])
        way = np.roll(circle, k, axis=0).T @ flat
        ax.plot(*way.T, color=GREY, lw=1.2)
        arrow(ax, way[-4], way[-1], f"$g_{name}$, $M_{name}$", words[1][k], GREY)


def section(ax):
    """Draw a ball and a taper that carry an inner-ring load along +z."""
    ball = [[-0.5, 0.25], [0.5, 0.25]]
    taper = [[1.0, 0.426], [1.83, 0.104]], [[0.9, -0.144], [1.84, -0.283]]
    for look, side, tops in ((RINGS[0], 0.63, taper[0]), (RINGS[1], -0.63, taper[1])):
        for edge in (np.multiply(ball, [1, np.sign(side)]), tops):
            (left, _), (right, _) = edge
            ax.add_patch(patches.Polygon([*edge, (right, side), (left, side)], **look))
        arrow(ax, (-0.25, -0.46), (0.3, -0.46), "$F_z$", (0.41, -0.46), INNER)
        arrow(ax, (1.1, -0.46), (1.5, -0.46), "$F_z$", (1.64, -0.46), INNER)
    ax.add_patch(patches.Circle((0, 0), 0.42, **BODY))
    roller = [[1.04, -0.165], [1.75, -0.27], [1.84, 0.10], [1.17, 0.36]]
    ax.add_patch(patches.Polygon(roller, **BODY))
    ax.plot([-0.29, 0.29], [-0.55, 0.55], "k-.", lw=1)
    ax.plot([0, 0], [0, 0.75], color=GREY, lw=0.8)
    ax.add_patch(patches.Arc((0, 0), 1.36, 1.36, theta1=62, theta2=90, color=GREY))
    ax.text(0.19, 0.76, "$\\alpha>0$", ha="center")
    ax.text(0.8, 0.0, "large\nend", ha="center", fontsize=8, color=ROLLER)
    ax.text(0.7, -0.83, "axis of the bearing", ha="center", color=GREY, fontsize=8)
    arrow(ax, (-0.6, -0.95), (2.0, -0.95), "$z$", (2.1, -0.95))
    arrow(ax, (-0.6, -0.95), (-0.6, 0.9), "$r$", (-0.6, 1.02))


def approach(ax):
    """Draw what an approach is: how far bodies are pressed into each other."""
    ax.add_patch(patches.Rectangle((-0.7, -0.9), 1.4, 0.72, **RINGS[1]))
    ax.add_patch(patches.Circle((0, 0.4), 0.75, **BODY, alpha=0.5, ls="--"))
    for y, far in ((-0.18, 0.1), (-0.35, -0.63)):
        ax.plot([0, 1.0], [y, y], color=GREY, lw=0.7)
        arrow(ax, (0.92, far), (0.92, y))
    words = "$\\delta>0$: pressed together\n$\\delta<0$: a gap"
    ax.text(0, -0.98, words, ha="center", va="top")


PANELS = {
    "Seen against $z$": (front, -1.1, 1.6),
    "Freedoms and loads of a ring": (freedoms, -1.2, 1.7),
    "Contact angle and taper": (section, -0.75, 2.25),
    "Approach": (approach, -1.15, 1.25),
}

if __name__ == "__main__":
    figure = Figure(figsize=(12, 3.5))
    widths = [high - low for _, low, high in PANELS.values()]
    panels = figure.subplots(1, 4, gridspec_kw={"width_ratios": widths})
    for ax, (title, (draw, low, high)) in zip(panels, PANELS.items(), strict=True):
        ax.set(xlim=(low, high), ylim=(-1.3, 1.6), aspect="equal", title=title)
        ax.axis("off")
        draw(ax)
    figure.tight_layout(pad=0.3)
    figure.savefig(PLACE, metadata={"Software": None})

"""How much softer than a half-space is a roller near its free end face?

A quarter-space, load on one face and the other free, by Hetényi's alternation solved
as one system: tractions on both faces, each doubled by its mirror image, so that the
shear stress vanishes on both and the normal stress is what is given. The displacement
beyond a half-space's, over that of the mirrored load, is the factor of `FreeEnds`. Load
and point are apart across the roller by x, and at distances y, y' from the end.
Along the edge the factor tends to 2.36 whatever Poisson's ratio: a wedge of 90 degrees
has (1/(π/2 + 1) + 1/(π/2 - 1))/(2/π) = 3.36 times the plane compliance of a half-space.

Run: python benchmarks/quarter_space.py [--json] [--smoke]

Last run:

Poisson's ratio 0; FreeEnds uses 1.322
  y/y'    x/sqrt(y y') =        0       1      10      30
     1                        1.366   1.374   1.960   2.221
     2                        1.322   1.337   1.944   2.216
     5                        1.196   1.220   1.848   2.167
    20                        1.056   1.070   1.583   2.001
Poisson's ratio 0.3; FreeEnds uses 1.799
  y/y'    x/sqrt(y y') =        0       1      10      30
     1                        1.846   1.845   2.154   2.297
     2                        1.803   1.810   2.148   2.297
     5                        1.678   1.697   2.091   2.272
    20                        1.539   1.552   1.929   2.184
Poisson's ratio 0.5
  y/y'    x/sqrt(y y') =        0       1      10      30
     1                        2.760   2.678   2.397   2.387
     2                        2.716   2.653   2.399   2.387
     5                        2.594   2.566   2.398   2.387
    20                        2.449   2.447   2.396   2.387

(0.15 and 0.4 left out here) 184 s beside other work

AMD EPYC, 2 cores, load average 5.7; devices: 1 cpu; jax 0.10.1
"""

import argparse
import json
import sys
import time

import jax

jax.config.update("jax_enable_x64", True)

import jax.numpy as jnp  # noqa: E402
import numpy as np  # noqa: E402
from timing import machine  # noqa: E402

import bearingjax as bj  # noqa: E402
from bearingjax.contact.halfspace import FreeEnds  # noqa: E402
from bearingjax.contact.halfspace.love import corner  # noqa: E402
from bearingjax.contact.halfspace.stress import corner_stress  # noqa: E402

POISSON = (0.0, 0.15, 0.3, 0.4, 0.5)
DISTANCES = (1.0, 2.0, 5.0, 20.0)
ACROSS = (0.0, 1.0, 10.0, 30.0)
LOADED = 4.0  # middle of the loaded square, in half sides
FULL = {"along": 52, "across": 48, "least": 0.02, "reach": 6000.0}
COARSE = {"along": 26, "across": 24, "least": 0.1, "reach": 600.0}


class Quarter:
    """Both faces in cells that grow away from the edge, symmetric across."""

    def __init__(self, poisson, along, across, least, reach):
        self.poisson = poisson
        ys = np.concatenate([[0.0], np.geomspace(least, reach, along)])
        xs = np.concatenate([[0.0], np.geomspace(2 * least, reach, across)])
        x, y = _pairs(_middles(xs), _middles(ys))
        self.x, self.y = x.ravel(), y.ravel()
        low = [v.ravel() for v in _pairs(xs[:-1], ys[:-1])]
        high = [v.ravel() for v in _pairs(xs[1:], ys[1:])]
        self.cells = (low[0], high[0], low[1], high[1])
        self.twins = (-high[0], -low[0], low[1], high[1])
        self.turn = self._pressed(*self.cells) + self._pressed(*self.twins)

    def _pressed(self, x0, x1, y0, y1):
        """Pressure on the other face by a unit one on rectangles and their images."""

        depth, poisson = jnp.asarray(self.y)[:, None], jnp.asarray(self.poisson)

        def stress(u, v):
            return corner_stress(u, v, depth, poisson)[1]

        return -2 * _cornered(stress, self.x[:, None], 0.0, x0, x1, y0, y1)

    def factors(self, points):
        """Factor at points (x, y) for a square of side 2 loaded."""
        square = [np.array([v]) for v in (-1.0, 1.0, LOADED - 1, LOADED + 1)]
        other = self._pressed(*square)[:, 0]
        # c = -S q, q = -(s + S c): on the loaded face besides what is given.
        system = np.eye(len(self.x)) - self.turn @ self.turn
        added = np.linalg.solve(system, self.turn @ other)
        found = []
        for x, y in points:
            image = _sunk(x, y, square[0], square[1], -square[3], -square[2])[0]
            more = 0.0
            for x0, x1, y0, y1 in (self.cells, self.twins):
                more += _sunk(x, y, x0, x1, y0, y1) @ added
                more += _sunk(x, y, x0, x1, -y1, -y0) @ added
            found.append((image + more) / image)
        return np.array(found)


def _pairs(x, y):
    return np.meshgrid(x, y, indexing="ij")


def _middles(edges):
    return np.concatenate([[edges[1] / 2], np.sqrt(edges[1:-1] * edges[2:])])


def _cornered(function, x, y, x0, x1, y0, y1):
    total = np.zeros(np.broadcast_shapes(np.shape(x - x0), np.shape(y - y0)))
    for sign, a, b in ((1, x0, y0), (-1, x1, y0), (-1, x0, y1), (1, x1, y1)):
        u, v = np.broadcast_arrays(x - a, y - b)
        total = total + sign * np.asarray(function(jnp.asarray(u), jnp.asarray(v)))
    return total


def _sunk(x, y, *rectangles):
    return _cornered(corner, x, y, *rectangles)


def run(poisson=POISSON, distances=DISTANCES, across=ACROSS, cells=FULL):
    """Factor by Poisson's ratio, y/y' and x/sqrt(y y')."""
    rows = []
    for nu in poisson:
        quarter = Quarter(nu, **cells)
        points = [
            (s * LOADED * np.sqrt(t), LOADED * t) for t in distances for s in across
        ]
        found = quarter.factors(points).reshape(len(distances), len(across))
        steel = bj.Material(210e9, nu) if nu < 0.5 else None
        # Of two equal bodies half is the roller's.
        used = None if steel is None else 2 * float(FreeEnds().share(steel, steel))
        rows.append({"poisson": nu, "factor": found.tolist(), "used": used})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one line of figures")
    parser.add_argument("--smoke", action="store_true", help="few, large cells")
    args = parser.parse_args()
    begin = time.perf_counter()
    rows = run((0.3,), cells=COARSE) if args.smoke else run()
    if args.json:
        print(json.dumps({"rows": rows}))
        return 0
    for row in rows:
        used = "" if row["used"] is None else f"; FreeEnds uses {row['used']:.3f}"
        print(f"Poisson's ratio {row['poisson']:g}{used}")
        print("  y/y'    x/sqrt(y y') = " + "".join(f"{s:8g}" for s in ACROSS))
        for t, line in zip(DISTANCES, row["factor"], strict=True):
            print(f"  {t:4g}{'':21}" + "".join(f"{v:8.3f}" for v in line))
    print(f"\n{time.perf_counter() - begin:.0f} s\n\n{machine()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""How much softer than a half-space is a roller near its free end face?

A quarter-space, load on one face and the other free, by Hetényi's alternation:
tractions on both faces, each doubled by its mirror image, so that the shear stress
vanishes on both and the normal stress is what is given. The displacement beyond a
half-space's, over that of the mirrored load, is the factor of `FreeEnds`. Load and
point are apart across the roller by x, and at distances y, y' from the end.

Solved for one wave along the edge: kernels are Bessel functions then, the alternation
is one linear system in the logarithm of the distance from the edge, where the
trapezoidal rule converges as the exponential of the number of points; other waves
follow by scaling, their sum is the point load. Along the edge the factor tends to 2.363
whatever Poisson's ratio: a wedge of 90 degrees has (1/(π/2 + 1) + 1/(π/2 - 1))/(2/π)
= 3.363 times the plane compliance of a half-space.

README: displacement over the mirrored load's, Poisson's ratio 0.3: 1.845 where equally
far from the face, 1.53 twenty times as far; `FreeEnds` within 0.002 |  |

Last run:

found / used by FreeEnds
Poisson   y/y'   x/sqrt(y y') =              0             1            10            30
      0   1.00                   1.3677/1.368  1.3738/1.373  1.9593/1.959  2.2089/2.209
      0   2.01                   1.3226/1.323  1.3359/1.336  1.9374/1.937  2.1997/2.200
      0   4.95                   1.1957/1.196  1.2192/1.220  1.8458/1.846  2.1593/2.160
      0  20.09                   1.0595/1.060  1.0725/1.071  1.5852/1.585  2.0214/2.022
   0.15   1.00                   1.5176/1.518  1.5326/1.532  2.0392/2.039  2.2402/2.241
   0.15   2.01                   1.4728/1.474  1.4940/1.494  2.0210/2.021  2.2328/2.233
   0.15   4.95                   1.3468/1.348  1.3751/1.376  1.9447/1.945  2.2004/2.201
   0.15  20.09                   1.2113/1.212  1.2259/1.225  1.7201/1.720  2.0883/2.089
    0.3   1.00                   1.8451/1.844  1.8429/1.842  2.1469/2.147  2.2810/2.281
    0.3   2.01                   1.7997/1.799  1.8056/1.805  2.1343/2.134  2.2760/2.276
    0.3   4.95                   1.6717/1.671  1.6904/1.690  2.0809/2.081  2.2540/2.254
    0.3  20.09                   1.5332/1.532  1.5450/1.543  1.9192/1.919  2.1776/2.178
    0.4   1.00                   2.2081/2.208  2.1760/2.175  2.2443/2.244  2.3169/2.316
    0.4   2.01                   2.1618/2.162  2.1411/2.141  2.2369/2.237  2.3140/2.314
    0.4   4.95                   2.0311/2.032  2.0330/2.034  2.2055/2.206  2.3014/2.301
    0.4  20.09                   1.8891/1.889  1.8956/1.895  2.1088/2.109  2.2573/2.257
    0.5   1.00                   2.7560/2.755  2.6724/2.671  2.3762/2.376  2.3645/2.364
    0.5   2.01                   2.7085/2.708  2.6419/2.641  2.3761/2.376  2.3645/2.364
    0.5   4.95                   2.5741/2.574  2.5467/2.547  2.3758/2.376  2.3645/2.364
    0.5  20.09                   2.4274/2.426  2.4245/2.424  2.3742/2.374  2.3644/2.364

its pressure on a half-space, 1/distance to: 0.22598  0.22598  0.22598  0.22598  0.22597
(Dundurs and Lee's order: 0.22599)

13 s

AMD EPYC, 2 cores, load average 0.8; devices: 1 cpu; jax 0.10.1

What `FreeEnds` uses leaves 0.002 at most.
"""

import jax.numpy as jnp
import numpy as np
from bench import benchmark
from scipy.interpolate import CubicSpline
from scipy.special import k0, k1

from bearingjax.contact.halfspace.ends import WEDGE, MirroredWeight

POISSON = (0.0, 0.15, 0.3, 0.4, 0.5)
TIMES = (1.0, 2.0, 5.0, 20.0)
ACROSS = (0.0, 1.0, 10.0, 30.0)
LOWEST, HIGHEST = -25.0, 4.0  # logarithms of wave number times distance
STEP = 0.1

# Of the fit: x over y + y' is the cotangent of the angle's share of 90 degrees.
ANGLE = (0.0064, 0.013, 0.025, 0.045, 0.064, 0.1, 0.13, 0.19, 0.26, 0.33, 0.41, 0.49)
ANGLE += (0.59, 0.71, 0.8, 0.87, 1.0)
LOG_TIMES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0, 2.5, 3.0, 3.6, 4.4)
POWERS = (4, 3, 5)


class Edge:
    """Quarter-space under pressure that waves along the edge, wave number 1.

    Attributes:
        step: Of the logarithm of distances from the edge.
        distance: From the edge, of either face (n,).
        pressed: Pressure on one face by a unit line load on the other and its mirror
            image (n, n), first axis: where.
        added: Displacement beyond that of the load and of its image, over that of a
            unit load's 1/r (n, n).
    """

    def __init__(self, poisson, step=STEP):
        self.step = step
        count = round((HIGHEST - LOWEST) / step) + 1
        self.distance = y = np.exp(LOWEST + step * np.arange(count))
        weight = step * y
        self.pressed = _pressed(poisson, y[:, None], y[None])
        turn = self.pressed * weight
        held = np.linalg.solve(np.eye(count) - turn @ turn, turn @ self.pressed)
        self.added = sunk(y, step) * weight @ held

    def factors(self, log_times, x):
        """Factor for y = exp(log_times) and y' = 1, x apart (...)."""
        shift = round(log_times / self.step)
        y = np.exp(shift * self.step)
        if not np.isclose(shift * self.step, log_times):
            raise ValueError(f"{log_times} is no multiple of {self.step}")
        # Waves of any number: distances of the table over those asked for.
        found = np.diagonal(self.added, -shift)
        wave = self.distance[: len(found)]
        # What is left of the wedge is finite at long waves.
        rest = found - (WEDGE - 1.0) * 2.0 * k0(wave * (1.0 + y))
        spline = CubicSpline(np.log(wave), rest)
        factors = []
        for apart in x:
            least = 1e-3 / (1.0 + apart)
            most = min(45.0 / (1.0 + y), wave[-1])
            fine = np.linspace(least, most, 60_001)
            values = np.cos(fine * apart) * spline(np.log(fine))
            total = np.trapezoid(values, fine) + least * values[0]
            factors.append(WEDGE + total / np.pi * np.hypot(apart, 1.0 + y))
        return np.array(factors)


def _pressed(poisson, z, y):
    """Doubled normal stress on the plane of the edge, at depth z, from distance y.

    Boussinesq's stress by the potentials V = 1/r and ∫V dz, their waves: 2K0, whose
    second derivatives follow from Laplace's equation.
    """
    r = np.hypot(z, y)
    down = -2.0 * k1(r) * z / r
    across = 2.0 * (k0(r) * y**2 / r**2 + k1(r) * (2.0 * y**2 / r**3 - 1.0 / r))
    # ∫ from z on, by the double exponential rule.
    t = np.arange(-4.2, 4.6, 0.05)
    place = np.exp(t - np.exp(-t))
    steps = 0.05 * place * (1.0 + np.exp(-t))
    potential = np.zeros_like(r)
    for p, s in zip(place, steps, strict=True):
        potential -= 2.0 * s * k0(np.hypot(y, z + p))
    spread = potential - down
    stress = 2.0 * poisson * down - z * across - (1.0 - 2.0 * poisson) * spread
    return -stress / np.pi


def sunk(y, step):
    """Displacement by a line load and its image; the logarithm's own node apart."""
    apart = np.abs(y[:, None] - y[None])
    np.fill_diagonal(apart, 1.0)
    near = k0(apart)
    own = np.log(4.0 * np.pi / step) - np.log(y) - np.euler_gamma
    np.fill_diagonal(near, own)
    return 2.0 * (near + k0(y[:, None] + y[None]))


def orders(edge):
    """Exponents of the pressure towards the edge, pressed flat on a half-space.

    Local ones, for every step of the logarithm; both bodies of one material.
    """
    y = edge.distance
    images = 2.0 * k0(y[:, None] + y[None])
    both = sunk(y, edge.step)
    matrix = 2.0 * both - images + edge.added
    pressed = y < 0.3
    some = (matrix * edge.step * y)[np.ix_(pressed, pressed)]
    return -np.diff(np.log(np.linalg.solve(some, np.ones(len(some))))) / edge.step


def given(poisson, x, y, other):
    """Factor that `FreeEnds` uses."""
    weight = MirroredWeight(jnp.asarray(1.0), jnp.asarray(poisson), None)
    return weight(x, y, other, np)


def run(poisson=POISSON, times=TIMES, across=ACROSS, step=STEP):
    """Factor by Poisson's ratio, y/y' and x/sqrt(y y'): found here, used there."""
    rows = []
    for nu in poisson:
        edge = Edge(nu, step)
        for wanted in times:
            log_times = step * round(np.log(wanted) / step)
            y = np.exp(log_times)
            x = np.array(across) * np.sqrt(y)
            row = {"poisson": nu, "times": y, "across": list(across)}
            row["found"] = edge.factors(log_times, x).tolist()
            row["used"] = given(nu, x, np.array(y), 1.0).tolist()
            rows.append(row)
    return rows


def fitted(powers=POWERS):
    """Coefficients for `FreeEnds` by least squares, and what they leave."""
    angle = np.array(ANGLE)
    terms, wanted = [], []
    for nu in np.linspace(0.0, 0.5, 6):
        edge = Edge(nu)
        for log_times in LOG_TIMES:
            y = np.exp(log_times)
            wanted.append(
                edge.factors(log_times, (1.0 + y) / np.tan(0.5 * np.pi * angle))
            )
            level = np.full_like(angle, 2.0 * np.sqrt(y) / (1.0 + y))
            terms.append(
                [
                    angle ** (i + 1) * level**j * nu**k
                    for i in range(powers[0])
                    for j in range(powers[1])
                    for k in range(powers[2])
                ]
            )
    terms = np.concatenate(terms, axis=1).T
    wanted = np.concatenate(wanted) - WEDGE
    coefficients = np.round(np.linalg.lstsq(terms, wanted, rcond=None)[0], 4)
    return coefficients.reshape(powers), np.abs(terms @ coefficients - wanted)


def show(found):
    print("found / used by FreeEnds")
    print("Poisson   y/y'   x/sqrt(y y') = " + "".join(f"{s:14g}" for s in ACROSS))
    for row in found["rows"]:
        pairs = zip(row["found"], row["used"], strict=True)
        values = "".join(f"{found:8.4f}/{used:5.3f}" for found, used in pairs)
        print(f"{row['poisson']:7g} {row['times']:6.2f}{'':17}{values}")
    near = round((-16.0 - LOWEST) / STEP)
    found = "  ".join(f"{orders(Edge(nu))[near]:.5f}" for nu in POISSON)
    print(f"\nits pressure on a half-space, 1/distance to: {found}")


@benchmark("one ratio, coarse steps", show, fit="coefficients instead")
def main(smoke, fit=False):
    if fit:
        coefficients, left = fitted()
        print(np.array2string(coefficients, separator=", ", suppress_small=True))
        print(f"left: {left.max():.4f} at most, {left.mean():.4f} in the mean")
        return None
    return {"rows": run((0.3,), step=0.2) if smoke else run()}

"""What do the fits of Hertz contact cost in error, and save in time?

Exact ellipses (`bearingjax.contact.ellipse`, elliptic integrals and a root) against the
fits of Brewe and Hamrock (1977), k = 1.0339 (Ry/Rx)^0.636 with linear E and logarithmic
K, and those of Hamrock and Brewe (1983), k = (Ry/Rx)^(2/π); over the ratios of radii of
ball bearings and beyond. Times are those of a jitted batch, exact over fit.

Two cores of an AMD EPYC (virtual; beside other jobs), jax 0.10.1, float64:

    Ry/Rx          fit     axes  constant  pressure   (largest relative error)
        1 to  1.2  1977   3.4e-02   8.7e-02   2.2e-02
        1 to  1.2  1983   5.4e-03   1.4e-02   4.8e-03
      1.2 to    5  1977   2.8e-02   6.2e-02   1.6e-02
      1.2 to    5  1983   3.6e-02   3.9e-02   1.6e-02
        5 to   30  1977   1.3e-02   1.4e-02   4.8e-03
        5 to   30  1983   3.8e-02   3.6e-02   1.6e-02
       30 to  100  1977   6.3e-02   5.9e-02   2.1e-02
       30 to  100  1983   3.2e-02   6.5e-02   1.0e-02
    exact: 225 ns a contact; 7.4 times the fit of 1977, 7.7 times that of 1983

README: constant off by up to 9 % (1977) and 7 % (1983); the exact ellipse takes 7 times
as long, 0.2 µs |  |
"""

import math
import time

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark

from bearingjax.contact import ellipse

MODULUS = 1.13e11
RANGES = ((1.0, 1.2), (1.2, 5.0), (5.0, 30.0), (30.0, 100.0))


def exact(x, y):
    """Ratio of axes, constant and pressure at 1 N from curvature sums."""
    found = ellipse(x, y, jnp.asarray(MODULUS))
    return 1.0 / found.ratio, found.constant, found.peak_pressure(jnp.ones_like(x))


def _from_fit(x, y, k, e, f):
    radius = 1.0 / (x + y)
    stiffness = 2.0 * MODULUS
    constant = math.pi * k * stiffness * jnp.sqrt(radius * e / (4.5 * f**3))
    major = jnp.cbrt(6.0 * k**2 * e * radius / (math.pi * stiffness))
    return k, constant, 1.5 * k / (math.pi * major**2)


def brewe_hamrock(x, y):
    """Least-squares fits of 1977."""
    a = x / y
    return _from_fit(
        x, y, 1.0339 * a**0.636, 1.0003 + 0.5968 / a, 1.5277 + 0.6023 * jnp.log(a)
    )


def hamrock_brewe(x, y):
    """Simplified fits of 1983, exact for the circle but for k."""
    a, q = x / y, 0.5 * math.pi - 1.0
    return _from_fit(
        x, y, a ** (2.0 / math.pi), 1.0 + q / a, 0.5 * math.pi + q * jnp.log(a)
    )


FITS = {"1977": brewe_hamrock, "1983": hamrock_brewe}


def errors(low, high, count):
    """Largest relative errors of ratio, constant and pressure, of each fit."""
    ratio = jnp.asarray(np.geomspace(low, high, count))
    x = jnp.full_like(ratio, 200.0)
    y = x / ratio
    true = exact(x, y)
    return {
        name: [
            float(jnp.max(jnp.abs(a / b - 1.0)))
            for a, b in zip(fit(x, y), true, strict=True)
        ]
        for name, fit in FITS.items()
    }


def seconds(function, x, y, repeat=20):
    """Best time of a call."""
    jitted = jax.jit(function)
    jax.block_until_ready(jitted(x, y))
    best = math.inf
    for _ in range(repeat):
        start = time.perf_counter()
        jax.block_until_ready(jitted(x, y))
        best = min(best, time.perf_counter() - start)
    return best


@benchmark("a thousand contacts")
def main(smoke, count=100_000):
    count = 1000 if smoke else count
    print("Ry/Rx          fit     axes  constant  pressure   (largest relative error)")
    for low, high in RANGES:
        for name, row in errors(low, high, 1000).items():
            shown = "  ".join(f"{v:8.1e}" for v in row)
            print(f"{low:5g} to {high:4g}  {name}  {shown}")
    ratio = jnp.asarray(np.geomspace(1.0, 100.0, count))
    x = jnp.full_like(ratio, 200.0)
    functions = {"exact": exact, **FITS}
    times = {name: seconds(f, x, x / ratio) for name, f in functions.items()}
    for name, t in times.items():
        ns = 1e9 * t / count
        print(f"{name}: {ns:.0f} ns a contact, exact over it {times['exact'] / t:.1f}")

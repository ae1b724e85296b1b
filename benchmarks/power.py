"""Is the ninth root worth its code?

`ninth_root` against x**(1/9), exp(log(x)/9) and cbrt(cbrt(x)), alone and inside the
three powers of the line contact (x^(19/9), x^(10/9), x^(1/9) from one root). Time per
element of y <- (1 + f(y))/4 in a compiled loop, so that no call is timed: shortest of
the repeats, variants in shuffled order; the row "none" is the loop with f(y) = y.
Error: largest relative one over [1e-12, 1] against NumPy's longdouble power.

README: 2.1 ns in place of 10.3 ns for `x ** (1/9)`, error 3e-15 |  |

Last run:

                                     ns per element   ratio to ninth_root
root            type          size      root    powers      root    powers     error
ninth_root      float64      10000      2.08      2.29       1.0       1.0     2e-15
x ** (1/9)      float64      10000     10.25     10.21       4.9       4.5     3e-16
exp(log(x)/9)   float64      10000      6.11      6.99       2.9       3.1     6e-16
cbrt(cbrt(x))   float64      10000     28.84     29.24      13.8      12.8     6e-16
none            float64      10000      0.11      0.13       0.1       0.1
ninth_root      float64    1000000      2.18      2.34       1.0       1.0     3e-15
x ** (1/9)      float64    1000000     10.68     11.05       4.9       4.7     3e-16
exp(log(x)/9)   float64    1000000      6.43      6.82       2.9       2.9     7e-16
cbrt(cbrt(x))   float64    1000000     29.19     29.68      13.4      12.7     7e-16
none            float64    1000000      0.27      0.31       0.1       0.1
ninth_root      float32      10000      0.92      1.06       1.0       1.0     1e-06
x ** (1/9)      float32      10000      4.40      4.62       4.8       4.4     8e-08
exp(log(x)/9)   float32      10000      1.21      1.33       1.3       1.3     3e-07
cbrt(cbrt(x))   float32      10000     24.63     25.15      26.7      23.7     1e-07
none            float32      10000      0.05      0.07       0.1       0.1
ninth_root      float32    1000000      0.91      1.03       1.0       1.0     1e-06
x ** (1/9)      float32    1000000      4.50      4.73       4.9       4.6     8e-08
exp(log(x)/9)   float32    1000000      1.31      1.41       1.4       1.4     3e-07
cbrt(cbrt(x))   float32    1000000     24.86     25.23      27.2      24.5     1e-07
none            float32    1000000      0.13      0.14       0.1       0.1

AMD EPYC
"""

import random
import time

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, table

from bearingjax.numerics.power import ninth_root

ROOTS = {
    "ninth_root": ninth_root,
    "x ** (1/9)": lambda x: x ** (1.0 / 9.0),
    "exp(log(x)/9)": lambda x: jnp.exp(jnp.log(x) * (1.0 / 9.0)),
    "cbrt(cbrt(x))": lambda x: jnp.cbrt(jnp.cbrt(x)),
    "none": lambda x: x,
}
NO_ROOT = "none"
PER_CALL = 2_000_000  # elements
SIZES = (10_000, 1_000_000)
TYPES = ("float64", "float32")


def three_powers(root):
    """What a line contact needs: the sum of x^(19/9), x^(10/9) and x^(1/9)."""

    def powers(x):
        r = root(x)
        return r + x * r + x * x * r

    return powers


def numbers(count, dtype):
    """Positive numbers over twelve decades (count,)."""
    return (10.0 ** np.random.default_rng(0).uniform(-12, 0, count)).astype(dtype)


def error(root, x):
    """Largest relative error of a root."""
    want = x.astype(np.longdouble) ** (np.longdouble(1) / 9)
    got = np.asarray(jax.jit(root)(jnp.asarray(x))).astype(np.longdouble)
    return float(np.max(np.abs(got - want) / want))


def looped(function, size):
    """The function many times over, each time on its last result."""

    def body(_, x):
        return 0.25 + 0.25 * function(x)

    return jax.jit(lambda x: jax.lax.fori_loop(0, PER_CALL // size, body, x))


def seconds(call, x):
    begin = time.perf_counter()
    call(x).block_until_ready()
    return time.perf_counter() - begin


def times(x, repeats):
    """(variant, what) -> shortest time per element [ns]."""
    calls = {(name, "root"): looped(f, x.size) for name, f in ROOTS.items()}
    for name, f in ROOTS.items():
        calls[name, "powers"] = looped(three_powers(f), x.size)
    found = {key: [] for key in calls}
    for call in calls.values():
        call(x).block_until_ready()
    order = list(calls)
    for _ in range(repeats):
        random.shuffle(order)
        for key in order:
            found[key].append(seconds(calls[key], x))
    return {key: 1e9 * min(t) / PER_CALL for key, t in found.items()}


def measure(sizes, repeats):
    """A row for every type, size and variant."""
    rows = []
    for dtype in TYPES:
        for size in sizes:
            x = numbers(size, dtype)
            found = times(jnp.asarray(x), repeats)
            rows += [
                {
                    "root": name,
                    "dtype": dtype,
                    "size": size,
                    "root_ns": found[name, "root"],
                    "powers_ns": found[name, "powers"],
                    "error": None if name == NO_ROOT else error(f, x),
                }
                for name, f in ROOTS.items()
            ]
    return rows


def show(rows):
    base = rows[0]
    for r in rows:
        base = r if r["root"] == "ninth_root" else base
        r["times"] = r["root_ns"] / base["root_ns"]
        r["times_powers"] = r["powers_ns"] / base["powers_ns"]
    print("ns per element, and ratio to ninth_root")
    table(rows, {
        "root": "{root}", "type": "{dtype}", "size": "{size:d}", "ns": "{root_ns:.2f}",
        "powers, ns": "{powers_ns:.2f}", "ratio": "{times:.1f}",
        "powers": "{times_powers:.1f}", "error": "{error:.0e}",
    })  # fmt: skip


@benchmark("small, few repeats", show)
def main(smoke):
    return measure(SIZES[:1], 1) if smoke else measure(SIZES, 60)

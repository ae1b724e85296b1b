"""What does float32 cost in accuracy?

Bearings of the test registry, cast to float32 and evaluated with x64 switched off, at
20 random motions, against float64. Errors as in the oracle tests: of the force relative
to the largest force (moments: to the largest moment), of the stiffness entries K_ij
relative to sqrt(K_ii K_jj). "Input" is what remains if only design and motion are
rounded to float32 and everything is computed in float64: no code can do better.
"Conv.": motions whose result code is `CONVERGED`. Steps: most of a roller.

README: force within 6e-6, stiffness within 1e-6 (contact mapped; 6e-6 with slices) |  |

Last run:

                                            force         stiffness     steps
bearing                       rule      float32   input float32   input  32  64  conv.
cylindrical, crowned ends     midpoint    1e-06   9e-08   9e-07   3e-08   0   0  20/20
cylindrical NUP, logarithmic  midpoint    5e-06   1e-07   8e-07   9e-08  14  17  20/20
needle, crowned, preloaded    midpoint    2e-06   9e-08   6e-06   5e-07   3   4  20/20
taper, large rib              midpoint    6e-06   7e-08   1e-06   2e-07  14  17  20/20
taper, half angle zero        midpoint    8e-07   7e-08   1e-06   8e-08   0   0  20/20
cylindrical, crowned ends     contact     1e-06   9e-08   1e-06   7e-08   0   0  20/20
cylindrical NUP, logarithmic  contact     2e-06   1e-07   9e-07   1e-07  13  18  20/20
needle, crowned, preloaded    contact     1e-06   8e-08   1e-06   4e-08   2   4  20/20
taper, large rib              contact     6e-06   6e-08   9e-07   7e-08  14  18  20/20
taper, half angle zero        contact     8e-07   7e-08   9e-07   6e-08   0   0  20/20

worst of up to 20 motions; AMD EPYC
"""

import collections

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, table
from registry import bearings as listed
from registry import motion
from registry import quadratures as rules
from test_against_oracle import errors

import bearingjax as bj

MOTIONS = 20
SMOKE = ("cylindrical, crowned ends",)


def cast(tree, dtype):
    """The same tree with all real numbers in another precision."""

    def one(x):
        return x.astype(dtype) if jnp.issubdtype(x.dtype, jnp.floating) else x

    return jax.tree.map(one, tree)


def numbers(evaluated):
    """What is compared, in NumPy float64."""
    return {
        "force": np.asarray(evaluated.force, np.float64),
        "stiffness": np.asarray(evaluated.stiffness, np.float64),
    }


def evaluate_single(element, q):
    """Evaluation in float32, without x64 as a user of float32 runs it."""
    with jax.enable_x64(False):
        return cast(element, jnp.float32).evaluate(jnp.asarray(q, jnp.float32))


def evaluate_rounded(element, q):
    """Evaluation in float64 of a bearing and a motion rounded to float32."""
    rounded = cast(cast(element, jnp.float32), jnp.float64)
    return rounded.evaluate(jnp.asarray(np.float32(q), jnp.float64))


def one(element, q):
    """Errors and course of one evaluation, or `None` if nothing is loaded."""
    truth = element.evaluate(jnp.asarray(q))
    want = numbers(truth)
    if not np.any(want["force"]):
        return None
    got, rounded = evaluate_single(element, q), evaluate_rounded(element, q)
    if got.force.dtype != jnp.float32 or got.stiffness.dtype != jnp.float32:
        raise TypeError(f"float32 became {got.force.dtype}, {got.stiffness.dtype}")
    return {
        "single": errors(got, want),
        "rounded": errors(rounded, want),
        "result": bj.Result(int(got.result)).label,
        "steps": (int(got.steps), int(truth.steps)),
        "residual": float(got.residual),
    }


def study(element, motions):
    """Worst of several motions."""
    found = [one(element, motion(seed)) for seed in range(motions)]
    found = [x for x in found if x is not None]
    single = np.array([x["single"] for x in found])
    rounded = np.array([x["rounded"] for x in found])
    steps = np.max([x["steps"] for x in found], axis=0)
    return {
        "motions": len(found),
        "force_worst": float(single[:, 0].max()),
        "force_median": float(np.median(single[:, 0])),
        "stiffness_worst": float(single[:, 1].max()),
        "stiffness_median": float(np.median(single[:, 1])),
        "rounding_force": float(rounded[:, 0].max()),
        "rounding_stiffness": float(rounded[:, 1].max()),
        "results": dict(collections.Counter(x["result"] for x in found)),
        "steps": int(steps[0]),
        "steps_float64": int(steps[1]),
        "residual": max(x["residual"] for x in found),
    }


def show(rows):
    rows = [r | {"good": r["results"].get("converged", 0)} for r in rows]
    table(rows, {
        "bearing": "{bearing}", "rule": "{quadrature}", "force": "{force_worst:.0e}",
        "its input": "{rounding_force:.0e}", "stiffness": "{stiffness_worst:.0e}",
        "its input ": "{rounding_stiffness:.0e}", "steps": "{steps:d}",
        "of float64": "{steps_float64:d}", "conv.": "{good}/{motions}",
    })  # fmt: skip
    print(f"\nworst of up to {MOTIONS} motions")


def measure(bearings, quadratures, motions):
    """A row for every bearing and rule."""
    rows = []
    for rule, quadrature in quadratures.items():
        for name, bearing in bearings.items():
            element = bj.BearingElement(bearing, quadrature=quadrature)
            row = {"bearing": name, "quadrature": rule.replace("_", " ")}
            rows.append(row | study(element, motions))
    return rows


@benchmark("one bearing, 3 motions", show)
def main(smoke):
    bearings, quadratures = listed(), rules()
    if smoke:
        bearings = {name: bearings[name] for name in SMOKE}
        quadratures = {"midpoint": quadratures["midpoint"]}
    return measure(bearings, quadratures, 3 if smoke else MOTIONS)

"""What does an error in force and stiffness cost in time?

Cylindrical bearings of three rollers, crowned, logarithmic, and flat and arc, between a
straight and a crowned raceway; the rings hold them so that a roller touches along its
whole length, on a part of it, or on one end. Rules: equal slices, Gauss-Legendre nodes
on the whole length, and nodes mapped to the contact; in float64 and float32.

Errors are the worst of all nine cases, as in `quadrature.py`: of the force relative to
the largest, of K_ij relative to sqrt(K_ii K_jj), of the peak pressure relative to it.
Reference: the test oracle's Gauss-Legendre nodes graded to the ends of every loaded
interval; of the pressure, 96 mapped nodes. Time: one call of a compiled program, jitted
with the element closed over, shortest of the repeats, mean of the cases.

README: stiffness within 1e-4: 6 to 62 times cheaper than slices; 1e-8 in 248 µs a call,
which 100 000 slices do not reach | 20 times cheaper at 1e-4; 1e-8 reached | yes

Last run:

                                    worst error             time  compile
rule                   nodes     force stiffness  pressure    µs        s
slices       float64      10     5e-01     5e-01     4e-03   167      2.5
slices       float64      30     3e-02     8e-02     9e-04   127      2.8
slices       float64     100     8e-04     2e-02     2e-04   174      2.8
slices       float64    1000     3e-04     2e-03     1e-06   326      3.0
slices       float64   10000     4e-06     1e-04     2e-07  1471      2.9
slices       float64  100000     1e-06     6e-06     8e-10 15485      2.9
whole length float64      10     4e-01     4e-01     5e-03   133      2.6
whole length float64      30     1e-01     1e-01     7e-04   156      2.5
whole length float64     100     6e-03     3e-02     1e-04   155      2.7
whole length float64     300     4e-04     1e-02     9e-06   180      2.8
whole length float64    1000     6e-06     2e-03     5e-07   329      3.4
mapped       float64       6     7e-03     3e-03     2e-04   247      4.0
mapped       float64       8     3e-04     3e-05     2e-05   266      3.6
mapped       float64      12     1e-04     7e-06     4e-07   269      3.7
mapped       float64      16     1e-05     2e-06     5e-08   281      3.9
mapped       float64      24     7e-07     8e-08     2e-09   256      3.3
mapped       float64      32     3e-07     1e-08     1e-09   256      3.6
mapped       float64      64     9e-11     6e-11     4e-13   248      3.8
slices       float32      30     3e-02     8e-02     9e-04   129      3.4
slices       float32    1000     3e-04     2e-03     1e-06   288      2.7
slices       float32   10000     3e-05     1e-04     5e-07  1143      2.6
mapped       float32       8     3e-04     3e-05     2e-05   150      3.6
mapped       float32      16     1e-05     3e-06     5e-07   166      2.9
mapped       float32      32     4e-06     2e-07     5e-07   176      3.8

price of an error in stiffness, µs
                  1e-04    1e-06    1e-08
slices            15485        -        -
whole length          -        -        -
mapped              248      248      248

slices' time over mapped nodes' at 0.0001 in stiffness: 62.5 (at least 20): met
1e-06 in stiffness reached: met
1e-08 in stiffness reached: met

reference and 96 mapped nodes differ by 4e-12

Of equal slices 10 000 just miss 1e-4 in stiffness, at 6 times the time of mapped nodes,
and 100 000 meet it, at 62 times; these do not reach 1e-6 or 1e-8. The 248 µs are nearly
all overhead of a call (three rollers).

AMD EPYC, 2 cores, load average 1.6; devices: 1 cpu; jax 0.10.1
"""

import functools

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, compiled, shuffled, subplots, table, verdict
from float32_error import cast
from from_oracle import bearing
from oracle import build, evaluate, graded
from test_against_oracle import errors

import bearingjax as bj
from bearingjax.numerics.quadrature import AbstractQuadrature, Nodes
from bearingjax.statics.rollers import roller_results

PROFILES = {
    "crowned": {"type": "circular", "radius": 1.0},
    "logarithmic": {"type": "logarithmic"},
    "flat and arc": {"type": "crowned_ends", "straight_length": 5e-3, "radius": 0.5},
}
# Push [m] and tilt [rad] of the inner ring.
CONTACTS = {"full": (60e-6, 2e-4), "partial": (3e-6, 2e-4), "edge": (4e-6, 3e-3)}
POINTS = 101  # along a roller, at which the pressure is looked for
REFERENCE = 96
TARGETS = (1e-4, 1e-6, 1e-8)
GOAL = 20.0  # times cheaper than slices at the first target
ASKED = ("force", "stiffness", "pressure")


class WholeLength(AbstractQuadrature):
    """Gauss-Legendre nodes on the whole length, wherever the contact ends."""

    points: int

    def reference(self):
        return np.polynomial.legendre.leggauss(self.points)

    def table(self, offset, kinks, dtype, arcs=False):
        return (offset(jnp.asarray(self.reference()[0], dtype)),)

    def nodes(self, offset, args, table, a, b, arcs=False):
        one = jnp.ones((1,), a.dtype)
        tau = jnp.asarray(self.reference()[0], a.dtype)
        return Nodes(0.0 * one, one, (a + b * tau - table[0])[None, :])


RULES = {
    "slices": bj.numerics.Midpoint,
    "whole length": WholeLength,
    "mapped": bj.numerics.ContactMapped,
}
COLORS = {"slices": "#D55E00", "whole length": "#009E73", "mapped": "#0072B2"}
FULL = {
    ("slices", "float64"): (10, 30, 100, 1000, 10_000, 100_000),
    ("whole length", "float64"): (10, 30, 100, 300, 1000),
    ("mapped", "float64"): (6, 8, 12, 16, 24, 32, 64),
    ("slices", "float32"): (30, 1000, 10_000),
    ("mapped", "float32"): (8, 16, 32),
}
SMOKE = {("slices", "float64"): (30,), ("mapped", "float64"): (16,)}


def design(profile):
    """The bearing as the oracle describes it."""
    length = 0.010
    return {
        "kind": "cylindrical",
        "n_rollers": 3,
        "pitch_diameter": 0.065,
        "roller_diameter": 0.010,
        "roller_length": length,
        "roller_axis_angle": 0.0,
        "roller_half_angle": 0.0,
        "clearance": 0.0,
        "first_azimuth": 0.2,
        "line_constant": 8.06e4 * 1e3 ** (19 / 9) * (1e3 * length) ** (-1 / 9),
        "young": 206e9,
        "poisson": 0.3,
        "profile": PROFILES[profile],
        "raceway_profile": {
            "outer": {"type": "straight"},
            "inner": {"type": "circular", "radius": 6.0},
        },
        "ribs": {},
    }


def motion(contact):
    """Ring freedoms (12,) [m, rad]."""
    push, tilt = CONTACTS[contact]
    q = np.zeros(12)
    q[6], q[7], q[9], q[10] = push, 0.3 * push, -0.3 * tilt, tilt
    return q


def element(info, quadrature):
    law = bj.contact.LineConstant(info["line_constant"])
    return bj.BearingElement(bearing(info), law, quadrature=quadrature)


def answer(element, q):
    """Force and stiffness, and the largest contact pressure [Pa]."""
    model = element.model()
    solved = model.solve(q)
    rows = model.results(q, solved)
    pressure = jnp.max(roller_results(rows, POINTS)["roller_pressure"])
    return model.evaluate(q, solved), pressure


def references(profiles):
    """(profile, contact) -> force, stiffness and pressure; and how sure they are."""
    found, doubt = {}, []
    for profile in profiles:
        info = design(profile)
        truth = build(info)
        fine = element(info, bj.numerics.ContactMapped(REFERENCE))
        call = jax.jit(functools.partial(answer, fine))
        for contact in CONTACTS:
            q = motion(contact)
            want = evaluate(truth, q, graded(truth))
            got, pressure = call(jnp.asarray(q))
            found[profile, contact] = want, float(pressure)
            doubt.append(max(errors(got, want)))
    return found, max(doubt)


class Numbers:
    """An evaluation in NumPy float64, as `errors` wants it."""

    def __init__(self, evaluated):
        self.force = np.asarray(evaluated.force, np.float64)
        self.stiffness = np.asarray(evaluated.stiffness, np.float64)


def study(rule, dtype, nodes, references, repeats):
    """Worst errors, mean time and time to compile of one rule and count of nodes."""
    found, times, building = [], [], []
    single = dtype == "float32"
    with jax.enable_x64(not single):
        for profile in dict.fromkeys(name for name, _ in references):
            with jax.enable_x64(True):
                one = element(design(profile), RULES[rule](nodes))
            one = cast(one, jnp.float32) if single else one
            q = {c: jnp.asarray(motion(c), dtype) for c in CONTACTS}
            call, seconds = compiled(functools.partial(answer, one), q["full"])
            building.append(seconds)
            calls = {c: functools.partial(call, q[c]) for c in CONTACTS}
            times += [min(t) for t in shuffled(calls, repeats).values()]
            for contact, run in calls.items():
                got, pressure = run()
                want, peak = references[profile, contact]
                off = abs(float(pressure) / peak - 1.0)
                found.append((*errors(Numbers(got), want), off))
    worst = np.max(found, axis=0)
    return {
        "rule": rule,
        "dtype": dtype,
        "nodes": nodes,
        **{name: float(x) for name, x in zip(ASKED, worst, strict=True)},
        "time_us": 1e6 * float(np.mean(times)),
        "compile_s": float(np.mean(building)),
    }


def price(rows, rule, target, asked="stiffness"):
    """Least time [µs] at which a rule reaches an error; `None` if it does not."""
    mine = [r for r in rows if (r["rule"], r["dtype"]) == (rule, "float64")]
    return min((r["time_us"] for r in mine if r[asked] <= target), default=None)


def advantage(rows):
    """How much cheaper mapped nodes are at the first target; and whether slices
    reach it at all (if not: their dearest call is what they take at least)."""
    slices, mapped = (price(rows, rule, TARGETS[0]) for rule in ("slices", "mapped"))
    most = max(r["time_us"] for r in rows if r["rule"] == "slices")
    if mapped is None:
        return 0.0, slices is not None
    return (slices or most) / mapped, slices is not None


def show(rows, doubt):
    print("worst errors")
    errors = {name: f"{{{name}:.0e}}" for name in ASKED}
    table(rows, {
        "rule": "{rule}", "type": "{dtype}", "nodes": "{nodes:d}", **errors,
        "µs": "{time_us:.0f}", "compile, s": "{compile_s:.1f}",
    })  # fmt: skip
    print(f"\nprice of an error in stiffness, µs\n{'':14}", end="")
    print("".join(f"{target:>9.0e}" for target in TARGETS))
    for rule in dict.fromkeys(r["rule"] for r in rows):
        prices = [price(rows, rule, target) for target in TARGETS]
        told = ["-" if p is None else f"{p:.0f}" for p in prices]
        print(f"{rule:14}" + "".join(f"{p:>9}" for p in told))
    ratio, reached = advantage(rows)
    what = f"slices' time over mapped nodes' at {TARGETS[0]:g} in stiffness"
    print()
    print(verdict(what + ("" if reached else ", at least"), ratio, GOAL, False))
    for target in TARGETS[1:]:
        reached = price(rows, "mapped", target) is not None
        print(f"{target:g} in stiffness reached: {'met' if reached else 'MISSED'}")
    print(f"\nreference and {REFERENCE} mapped nodes differ by {doubt:.0e}")


def plot(rows, _):
    """Error against time, one panel for each quantity."""
    figure, axes = subplots(1, 3, figsize=(11, 4), sharex=True, sharey=True)
    for axis, asked in zip(axes, ASKED, strict=True):
        for rule, dtype in dict.fromkeys((r["rule"], r["dtype"]) for r in rows):
            mine = [r for r in rows if (r["rule"], r["dtype"]) == (rule, dtype)]
            axis.loglog(
                [r["time_us"] for r in mine],
                [max(r[asked], 1e-16) for r in mine],
                "o-" if dtype == "float64" else "o--",
                color=COLORS[rule],
                markersize=4,
                markerfacecolor=COLORS[rule] if dtype == "float64" else "white",
                label=f"{rule}, {dtype}",
            )
        axis.set_title(asked.capitalize(), loc="left")
        axis.set_xlabel("time of a call, µs")
    axes[0].set_ylabel("relative error, worst of nine cases")
    axes[0].legend(frameon=False)
    return figure


@benchmark("one profile, few nodes", show, plot)
def main(smoke):
    wanted, doubt = references(list(PROFILES)[:1] if smoke else PROFILES)
    rows = [
        study(rule, dtype, nodes, wanted, 3 if smoke else 30)
        for (rule, dtype), counts in (SMOKE if smoke else FULL).items()
        for nodes in counts
    ]
    return rows, doubt

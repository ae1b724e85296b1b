"""How near to the half-space do coupled slices come, and can a sweep afford them?

Rollers on planes (10 x 15 and 20 x 20 mm, steel; straight, crowned with 2 m,
logarithmic, Lundberg's profile for 5 kN), 100 N to 20 kN, upright and tilted by 0.3
mrad, solved on the half-space (65 x 64 graded cells) and then given the same approach
and tilt in slices: independent ones (Palmgren) and coupled ones. Errors of load, of
moment (over load and half length) and of the line load in the middle, as median and
worst of all rollers; the contact is evaluated in a batch of all.

Then a whole bearing (14 rollers, logarithmic): energy, force and stiffness in a batch,
and load solves by `sweep`, one time over the other; all on one core.

README: 24 coupled slices: load 0.4 % off (median), 4 % at worst, independent ones 8 and
27 %; a load solve 25 ms, 63 times theirs |  |

Last run:

                         median, worst error of            bearing, µs   load solve, µs
slices             load          moment         middle
independent     0.0813  0.270  0.0007  0.258  0.1294  0.271      22 (1)        402 (1)
coupled, 16     0.0050  0.105  0.0000  0.067  0.0019  0.146    1057 (48)      14212 (35)
coupled, 24     0.0035  0.043  0.0001  0.046  0.0012  0.044    1691 (76)      25202 (63)

64 rollers; in brackets: over independent slices

AMD EPYC, 2 cores, load average 1.6; devices: 1 cpu; jax 0.10.1
"""

import os

os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false")

import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, shuffled

import bearingjax as bj
from bearingjax.contact import LineContact
from bearingjax.contact.halfspace import RollerContact
from bearingjax.contact.line_contact import response

STEEL = bj.Material(210e9, 0.3)
MODULUS = 210e9 / 1.82
SIZES = ((0.010, 0.015), (0.020, 0.020))  # diameter, length
LOADS = (100.0, 1000.0, 5000.0, 20000.0)
TILTS = (0.0, 3e-4)
RULE = bj.numerics.ContactMapped()
LAWS = {
    "independent": bj.contact.Palmgren(),
    "coupled, 16": bj.contact.CoupledSlices(16),
    "coupled, 24": bj.contact.CoupledSlices(24),
}


def profiles(smoke):
    found = {"straight": bj.Straight(), "crowned": bj.CircularCrown(2.0)}
    if not smoke:
        found["logarithmic"] = bj.Logarithmic()
        found["Lundberg"] = bj.Lundberg(5000.0, MODULUS)
    return found


def solved(smoke):
    """Every roller on the half-space: profile, size, and what came of it."""
    rows = []
    for profile in profiles(smoke).values():
        for diameter, length in SIZES[:1] if smoke else SIZES:
            roller = RollerContact(
                length,
                diameter,
                diameter,
                roller_profile=profile,
                material=STEEL,
                raceway_material=STEEL,
            )
            for load in LOADS[1:2] if smoke else LOADS:
                # Crowned, a light load stands on a part of the length.
                grid = roller.grid(4.0 * roller.line_half_width(load), 65, 64)
                for tilt in TILTS:
                    got = roller.solve(load, tilt=tilt, grid=grid, throw=False)
                    if got.truncated:
                        got = roller.solve(load, tilt=tilt)
                    y = got.grid.y
                    rows.append(
                        {
                            "profile": profile,
                            "diameter": diameter,
                            "length": length,
                            "a": got.approach,
                            "b": 0.5 * length * got.tilt,
                            "load": load,
                            "moment": float(got.moment),
                            "middle": float(jnp.interp(0.0, y, got.line_load)),
                        }
                    )
    return rows


def contact_of(law, row):
    """One contact in slices by a law, and what the design fixes."""
    length = jnp.asarray(row["length"])
    line = LineContact(
        law.constant(STEEL, STEEL, length),
        length,
        jnp.asarray(row["diameter"]),
        row["profile"],
        bj.Straight(),
    )

    def radius(s):
        return jnp.full_like(s, 0.5 * row["diameter"])

    return law.contact(line, radius, jnp.asarray(MODULUS))


@jax.jit
def evaluated(contact, a, b):
    made = contact.table(RULE)
    got = response(contact, made, RULE, a, b)
    return got.load, contact.load_along(made, jnp.zeros((1,)), a, b)[0]


def errors(rows, law):
    """Median and worst error of load, moment and middle line load."""
    found = []
    for row in rows:
        load, middle = evaluated(contact_of(law, row), row["a"], row["b"])
        scale = 0.5 * row["load"] * row["length"]
        moment = 0.5 * row["length"] * float(load[1]) - row["moment"]
        some = row["middle"] > 0.1 * row["load"] / row["length"]
        found.append(
            [
                abs(float(load[0]) / row["load"] - 1),
                abs(moment) / scale,
                abs(float(middle) / row["middle"] - 1) if some else 0.0,
            ]
        )
    return np.median(found, axis=0).tolist(), np.max(found, axis=0).tolist()


def times(smoke):
    """Microseconds of a bearing in a batch, and of a load solve in a sweep."""
    bearing = bj.CylindricalRollerBearing(
        14,
        0.0593,
        0.0075,
        0.009,
        radial_internal_clearance=10e-6,
        roller_profile=bj.Logarithmic(),
    )
    count = 4 if smoke else 256
    rng = np.random.default_rng(0)
    qs = np.zeros((count, 12))
    qs[:, 6:8] = 2e-5 * rng.uniform(-1, 1, (count, 2))
    qs[:, 9:11] = 4e-4 * rng.uniform(-1, 1, (count, 2))
    loads = np.zeros((count, 6))
    loads[:, :2] = 6e3 * rng.uniform(-1, 1, (count, 2))
    loads[:, 3:5] = 20 * rng.uniform(-1, 1, (count, 2))
    free = ("ux", "uy", "gx", "gy")
    calls = {}
    for name, law in LAWS.items():
        if smoke and name not in ("independent", "coupled, 16"):
            continue
        element = bj.BearingElement(bearing, law)
        model = element.model()
        batch = jax.jit(jax.vmap(lambda q, m=model: m.evaluate(q)[:3]))
        solve = jax.jit(
            jax.vmap(
                lambda f, e=element: (lambda s: (s.displacement, s.result))(
                    bj.solve_load(
                        e,
                        f,
                        support=bj.Support(free=free),
                        options=bj.statics.SolveOptions(points=2),
                        throw=False,
                    )
                )
            )
        )
        at, under = jnp.asarray(qs), jnp.asarray(loads)
        calls[name, "batch"] = lambda f=batch, x=at: f(x)
        if smoke:
            continue  # compiling load solves takes long
        assert not np.any(solve(under)[1]), name
        calls[name, "solve"] = lambda f=solve, x=under: f(x)
    found = shuffled(calls, 3 if smoke else 7)
    return {key: 1e6 * min(value) / count for key, value in found.items()}


def run(smoke=False):
    rows = solved(smoke)
    spent = times(smoke)
    table = []
    for name, law in LAWS.items():
        if (name, "batch") not in spent:
            continue
        median, worst = errors(rows, law)
        table.append(
            {
                "law": name,
                "median": median,
                "worst": worst,
                "batch": spent[name, "batch"],
                "solve": spent.get((name, "solve")),
            }
        )
    return len(rows), table


def show(found):
    rows = found["rows"]
    base = rows[0]
    print(f"{'':14}{'median, worst error of':^44} bearing, µs   load solve, µs")
    print(f"{'slices':14}{'load':^15}{'moment':^15}{'middle':^15}")
    for row in rows:
        pairs = zip(row["median"], row["worst"], strict=True)
        shown = "".join(f"{m:8.4f}{w:7.3f}" for m, w in pairs)
        spent = [
            f"{row[k]:8.0f} ({row[k] / base[k]:.0f})" if row[k] else f"{'-':>12}"
            for k in ("batch", "solve")
        ]
        print(f"{row['law']:14}{shown}{spent[0]}   {spent[1]}")
    print(f"\n{found['rollers']} rollers; in brackets: over independent slices")


@benchmark("few rollers, few cases", show)
def main(smoke):
    count, rows = run(smoke)
    return {"rollers": count, "rows": rows}

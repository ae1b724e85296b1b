"""What does a load spectrum of a gearbox cost, and what do gradients improve in it?

A helical stage on two shafts, each in a deep groove ball and a cylindrical roller
bearing, in a soft housing.

(a) 1000 load cases of torque, speed and free force in one call, without lives and with
them (`solve_duty`), beside a loop of SciPy's root in NumPy over the shafts condensed on
their bearings, which calls the same bearings as black boxes, compiled once, with their
stiffness; extrapolated from 20.

(b) One equilibrium over the number of shafts, and of beam elements, in a call of 64
cases.

(c) Positions of the four bearings, clearance or preload of both kinds and the crown of
the rollers, chosen by Adam on the gradient of the logarithm of the life of all bearings
under three torques, with a penalty where the flanks of the teeth stand more than 60
µrad askew; projected on bounds.

README: four bearings, 1000 cases: 44 s, SciPy's root 13 times as long; life by 40
gradients 38 400 to 49 400 h | 1e-6; bound kept | yes

Last run:

1000 cases: 44.3 s, with lives 77.4 s (first call 319 s); SciPy, extrapolated 588 s,
  13.3 times; it failed 0 of 20; loads differ by 1.9e-11
1 shaft on 2 bearings, 24 beam elements: 3.94 ms a case, first call 26.6 s
2 shafts on 4 bearings, 48 beam elements: 6.84 ms a case, first call 27.9 s
4 shafts on 8 bearings, 96 beam elements: 8.51 ms a case, first call 38.8 s
1 shaft on 2 bearings, 101 beam elements: 5.63 ms a case, first call 16.9 s
before: A 40, B 240, C 30, D 270 mm; clearance of balls 10, of rollers 10 um; straight
  length of rollers 6 mm; lives 50164, 1.8e7, 131527, 1.6e8 h, all together 38442 h;
  flanks askew by -61.9, -42.2, -31.6 urad
after: A 25, B 223, C 10, D 298 mm (A and C at their bounds); clearance of balls 15.2,
  of rollers 16.8 um; straight length of rollers 4.8 mm; lives 65753, 6.0e6, 162112,
  1.2e8 h, all together 49422 h; flanks askew by -21.7, 12.4, 29.9 urad; 267 s
gradient against differences: 3.37e-07 (at most 1e-06): met
AMD EPYC, 2 cores, load average 4 to 8; devices: 1 cpu; jax 0.10.1
"""

import json
import time
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optax
from bench import benchmark, timed, verdict
from scipy.optimize import root

import bearingjax as bj
from bearingjax import shafts
from bearingjax.life.life import LifeConditions

BEARING = bj.DeepGrooveBallBearing(
    8, 0.065, 0.015081, outer_osculation=0.53, inner_osculation=0.52,
    radial_internal_clearance=1e-5,
)  # fmt: skip
ELEMENT = bj.BearingElement(BEARING)
SEAT = np.array([3e8, 2e8, 1e8])
"""Stiffness of the housing at each seat [N/m]."""
ROLLERS = bj.CylindricalRollerBearing(
    13, 0.0655, 0.011, 0.012, radial_internal_clearance=1e-5,
    roller_profile=bj.CrownedEnds(0.006, 1.0),
)  # fmt: skip
NAMES = "ABCD"
PLACES = np.array([0.04, 0.24, 0.03, 0.27])


def stage(torque=140.0, speed=155.0, force=(0.0, -800.0, 200.0)):
    """A helical stage of 22 kW; its output shaft pulls a belt."""
    helix: dict[str, Any] = {"helix_angle": np.deg2rad(15.0), "efficiency": 0.99}
    pinion = shafts.Gear(
        "pinion", "in", 0.1, teeth=23, normal_module=4e-3, hand="right", **helix
    )
    wheel = shafts.Gear(
        "wheel",
        "out",
        0.12,
        teeth=68,
        normal_module=4e-3,
        hand="left",
        mates_with="pinion",
        **helix,
    )
    apart = float(pinion.radius + wheel.radius)
    across = apart * np.array([np.cos(0.7), np.sin(0.7)])
    lines = [
        shafts.ShaftLine(
            "in", [0.06, 0.16, 0.06], [0.04, 0.048, 0.04], origin=(0.0, 0.0, 0.0)
        ),
        shafts.ShaftLine("out", [0.36], [0.06], origin=(*across, -0.02)),
    ]
    kinds = [BEARING, ROLLERS, BEARING, ROLLERS]
    seats = [
        shafts.Seat(name, shaft, z, bj.Installed(bj.BearingElement(kind)))
        for name, shaft, z, kind in zip(
            NAMES, ("in", "in", "out", "out"), PLACES, kinds, strict=True
        )
    ]
    return shafts.ShaftSystem(
        lines,
        seats,
        shafts.Drive("in", speed, torque=torque),
        [pinion, wheel],
        loads=shafts.ShaftLoad("belt", "out", 0.34, force),
        housing=shafts.HousingStiffness.of_seats(dict.fromkeys(NAMES, SEAT)),
        gravity=(0.0, -9.80665, 0.0),
    )


def spectrum(count):
    """Torque, speed and force of many cases."""
    rng = np.random.default_rng(0)
    torque = rng.uniform(20.0, 300.0, count) * rng.choice([-1.0, 1.0], count)
    force = rng.normal(size=(count, 3)) * [500.0, 500.0, 100.0]
    return torque, rng.uniform(50.0, 300.0, count), force


def varied(system, torque, speed, force):
    return eqx.tree_at(
        lambda s: (s.drive.torque, s.drive.speed, s.loads[0].force),
        system,
        (torque, speed, force),
    )


class Peer:
    """Stage in NumPy, the same one, its bearings called as black boxes."""

    def __init__(self, system):
        self.system = system
        self.bearings = [self._box(seat) for seat in system.seats]
        self.seat_of = [system.station(seat) for seat in system.seats]
        self.shafts = []
        for index in range(2):
            beam = system.beam(index)
            springs = [bj.rotor.LinearSupport(0, np.zeros(5))]
            whole = np.asarray(
                bj.rotor.Rotor(beam, (), springs).unsupported_matrices().stiffness
            )
            kept = [beam.node(s) for i, s in self.seat_of if i == index]
            self.shafts.append((beam, whole, kept))
        self.last = None

    @staticmethod
    def _box(seat):
        support = bj.rotor.BearingSupport(
            1, seat.installed.element_at(), jnp.zeros(5), inertia=True
        )
        call = jax.jit(lambda moved, speed: support.respond(moved, speed)[:2])
        return lambda moved, speed: [np.asarray(part) for part in call(moved, speed)]

    def solve(self, torque, speed, force):
        """Load of each bearing (bearing, 5), and whether SciPy found it."""
        system = varied(self.system, *map(jnp.asarray, (torque, speed, force)))
        flow = shafts.power_flow(system)
        speeds = np.asarray(flow.speed)
        blocks, loads = [], []
        for index, (beam, whole, kept) in enumerate(self.shafts):
            z = np.asarray(beam.nodes)
            nodes = np.zeros((len(z), 5))
            acting = [
                (m.wheel, np.asarray(m.force), np.cross(m.place, m.force))
                for m in flow.meshes
            ]
            acting.append(("belt", np.asarray(force), np.zeros(3)))
            for part in system.parts_on(system.shafts[index].name):
                node = beam.node(system.station(part)[1])
                for name, push, moment in acting:
                    if name == part.name:
                        nodes[node] += [*push, *moment[:2]]
            # Weight of the elements, as the beam's consistent loads have it.
            lengths, weight = np.diff(z), 9.80665 * np.asarray(beam.element_masses())
            nodes[:-1, 1] -= 0.5 * weight
            nodes[1:, 1] -= 0.5 * weight
            nodes[:-1, 3] += weight * lengths / 12.0
            nodes[1:, 3] -= weight * lengths / 12.0
            own = np.concatenate([np.arange(5 * n, 5 * n + 5) for n in kept])
            rest = np.setdiff1d(np.arange(len(whole)), own)
            follow = np.linalg.solve(
                whole[np.ix_(rest, rest)],
                np.column_stack([whole[np.ix_(rest, own)], nodes.ravel()[rest]]),
            )
            across = whole[np.ix_(own, rest)]
            blocks.append(whole[np.ix_(own, own)] - across @ follow[:, :-1])
            loads.append(nodes.ravel()[own] - across @ follow[:, -1])
        stiff, load = np.zeros((32, 32)), np.concatenate([*loads, np.zeros(12)])
        stiff[:10, :10], stiff[10:20, 10:20] = blocks
        stiff[20:, 20:] = np.diag(np.tile(SEAT, 4))
        rows = np.zeros((4, 5, 32))
        for k in range(4):
            rows[k, :, 5 * k : 5 * k + 5] = np.eye(5)
            rows[k, :3, 20 + 3 * k : 23 + 3 * k] = -np.eye(3)
        scale = np.concatenate([np.tile([1.0, 1, 1, 10, 10], 4), np.ones(12)]) * 1e-6

        def pushed(x):
            out = [
                bearing(row @ (scale * x), speeds[seat[0]])
                for bearing, row, seat in zip(
                    self.bearings, rows, self.seat_of, strict=True
                )
            ]
            return [np.stack(part) for part in zip(*out, strict=True)]

        def left(x):
            push, slope = pushed(x)
            value = stiff @ (scale * x) - load + np.einsum("kim,ki->m", rows, push)
            matrix = stiff + np.einsum("kim,kij,kjn->mn", rows, slope, rows)
            return scale * value, scale[:, None] * matrix * scale

        start = np.zeros(32) if self.last is None else self.last
        if self.last is None:
            start[1:20:5] = -20.0
        found = root(left, start, jac=True, method="hybr", options={"xtol": 1e-12})
        if found.success:
            self.last = found.x
        return pushed(found.x)[0], found.success


@eqx.filter_jit
def solved(system, torque, speed, force):
    """Loads and result codes of many cases."""

    def one(given):
        found = shafts.solve_system(varied(system, *given), throw=False)
        return found.load, found.result

    return jax.lax.map(one, (torque, speed, force), batch_size=64)


def cases(count, peers):
    """Question (a)."""
    system = stage()
    given = tuple(map(jnp.asarray, spectrum(count)))
    timed(lambda: solved(system, *given))
    seconds, (load, code) = timed(lambda: solved(system, *given))
    systems = [varied(system, *(part[k] for part in given)) for k in range(count)]
    conditions = [(LifeConditions(),) * 4] * count
    duty_first, _ = timed(lambda: shafts.solve_duty(systems, conditions).load)
    duty, _ = timed(lambda: shafts.solve_duty(systems, conditions).load)
    peer = Peer(system)
    peer.solve(*(part[0] for part in given))
    begin, error, failed = time.perf_counter(), 0.0, 0
    for k in range(peers):
        wanted, success = peer.solve(*(np.asarray(part[k]) for part in given))
        if not success:
            failed += 1
            continue
        own = np.asarray(load[k])[:, :5]
        error = max(error, np.abs(own - wanted).max() / np.abs(wanted).max())
    loop = (time.perf_counter() - begin) / peers * count
    return {
        "cases": count, "unsolved": int((np.asarray(code) != 0).sum()),
        "seconds": seconds, "with lives": duty, "with lives, first call": duty_first,
        "SciPy, extrapolated": loop, "times": loop / seconds,
        "SciPy failed": failed, "of": peers, "load differs by": error,
    }  # fmt: skip


def chain(count, segments=3):
    """So many shafts in a row of spur gears, each in two ball bearings."""
    lines, seats, wheels = [], [], []
    for k in range(count):
        lines.append(
            shafts.ShaftLine(
                f"s{k}", np.full(segments, 0.3 / segments),
                np.linspace(0.04, 0.05, segments), origin=(0.1 * k, 0.0, 0.0),
            )
        )  # fmt: skip
        mate: dict[str, Any] = {"mates_with": f"g{k - 1}"} if k else {"mesh_angle": 0.0}
        wheels.append(
            shafts.Gear(f"g{k}", f"s{k}", 0.14, teeth=25, normal_module=4e-3, **mate)
        )
        seats += [
            shafts.Seat(f"{side}{k}", f"s{k}", z, bj.Installed(ELEMENT))
            for side, z in (("a", 0.03), ("b", 0.27))
        ]
    load = shafts.ShaftLoad("p", "s0", 0.2, (300.0, -700.0, 100.0))
    drive = shafts.Drive("s0", 100.0, torque=100.0)
    return shafts.ShaftSystem(
        lines, seats, drive, wheels if count > 1 else (), (), load
    )


def sizes(batch, some):
    """Question (b)."""
    torque, speed, force = map(jnp.asarray, spectrum(batch))
    for count, segments in some:
        system = chain(count, segments)
        first, _ = timed(lambda s=system: solved(s, torque, speed, force))
        again, (_, code) = timed(lambda s=system: solved(s, torque, speed, force))
        elements = sum(sum(plan.divisions) for plan in system.plans)
        yield {
            "shafts": count, "bearings": 2 * count, "beam elements": elements,
            "ms a case": 1e3 * again / batch, "first call s": first,
            "unsolved": int((np.asarray(code) != 0).sum()),
        }  # fmt: skip


LOW = np.array([0.025, 0.19, 0.01, 0.22, -8.0, -8.0, 2.0])
HIGH = np.array([0.075, 0.275, 0.07, 0.33, 20.0, 20.0, 11.5])
START = np.array([*PLACES, 10.0, 10.0, 6.0])
WORDS = (
    "A [m]", "B [m]", "C [m]", "D [m]", "clearance of balls [um]",
    "clearance of rollers [um]", "straight length of rollers [mm]",
)  # fmt: skip
DUTY = jnp.asarray([(90.0, 0.5), (160.0, 0.4), (260.0, 0.1)])
"""Torques of the drive [N m] and their shares of the time."""
ALLOWED = 60e-6
"""Largest misalignment of the flanks under the largest torque [rad]."""


def designed(system, x):
    """The stage with other positions, clearances and crowns."""
    new = []
    for k, seat in enumerate(system.seats):
        bearing = seat.installed.drawing.bearing
        clearance = 1e-6 * x[4 + k % 2]
        bearing = eqx.tree_at(lambda b: b.radial_internal_clearance, bearing, clearance)
        if k % 2:
            bearing = eqx.tree_at(
                lambda b: b.roller_profile.straight_length, bearing, 1e-3 * x[6]
            )
        new += [x[k], bearing]
    places = [part for seat in range(4) for part in new[2 * seat : 2 * seat + 2]]
    return eqx.tree_at(
        lambda s: [
            part
            for seat in s.seats
            for part in (seat.position, seat.installed.drawing.bearing)
        ],
        system,
        places,
    )


@eqx.filter_jit
def numbers(system, x):
    """Life of each bearing and of all [h], misalignment at each torque [rad]."""
    system = designed(system, x)

    def one(given):
        whole = eqx.tree_at(lambda s: s.drive.torque, system, given)
        found = shafts.solve_system(whole, throw=False)
        lives = [
            bj.rating_life(own.element, own).reference_rating_life
            for own in shafts.bearing_solutions(whole, found, points=101)
        ]
        return jnp.stack(lives), found.misalignment[0], found.power.speed

    lives, apart, speed = jax.lax.map(one, DUTY[:, 0])
    of = jnp.asarray([0, 0, 1, 1])
    hours = shafts.bearing_hours(1.0 / lives, speed[:, of], DUTY[:, 1])
    return hours, shafts.system_life(system, hours), apart


def aim(system, x):
    """Objective: minus the logarithm of the life, and a penalty."""
    _, life, apart = numbers(system, x)
    beyond = jnp.maximum(jnp.abs(apart) / ALLOWED - 1.0, 0.0)
    return -jnp.log(life) + 20.0 * jnp.sum(beyond**2)


def improved(steps):
    """Question (c): designs tried, the best within the bound, and errors of gradients.

    Args:
        steps: Of Adam, on variables over the width of their bounds.
    """
    wide, system = HIGH - LOW, stage()
    gradient = eqx.filter_jit(jax.value_and_grad(lambda u: aim(system, LOW + wide * u)))
    u = jnp.asarray((START - LOW) / wide)
    optimiser = optax.adam(optax.cosine_decay_schedule(0.06, max(steps, 1)))
    state, history = optimiser.init(u), []
    begin = time.perf_counter()
    for _ in range(steps):
        value, slope = gradient(u)
        history.append((float(value), np.asarray(u)))
        change, state = optimiser.update(slope, state)
        u = jnp.clip(optax.apply_updates(u, change), 0.0, 1.0)
    history.append((float(gradient(u)[0]), np.asarray(u)))
    seconds = time.perf_counter() - begin
    best = min(history, key=lambda pair: pair[0])[1]
    # The gradient half way, against differences of fourth order.
    middle = jnp.asarray(0.5 * (history[0][1] + best))
    slope = np.asarray(gradient(middle)[1])
    value = eqx.filter_jit(lambda u: aim(system, LOW + wide * u))
    wanted = []
    for k in range(len(LOW)):
        step = jnp.zeros(len(LOW)).at[k].set(1e-3)
        ends = [float(value(middle + s * step)) for s in (-2, -1, 1, 2)]
        wanted.append((ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / 12e-3)
    error = np.abs(slope - wanted).max() / np.abs(wanted).max()
    return LOW + wide * best, seconds, error


def described(x):
    """Numbers of a design for people."""
    hours, life, apart = jax.device_get(numbers(stage(), jnp.asarray(x)))
    return {
        **{word: round(float(v), 4) for word, v in zip(WORDS, x, strict=True)},
        "lives h": [round(float(h)) for h in hours],
        "system h": round(float(life)),
        "misalignment urad": [round(1e6 * float(a), 1) for a in apart],
    }


def show(parts):
    found = {}
    for row in parts:
        print(json.dumps(row), flush=True)
        found |= row
    if "load differs by" in found:
        print(verdict("loads of SciPy and ours", found["load differs by"], 1e-6))
    if "after" not in found:
        return
    before, after = found["before"], found["after"]
    gained = after["system h"] / before["system h"]
    print(verdict("life of the system, times", gained, 1.0, False))
    worst = max(map(abs, after["misalignment urad"]))
    print(verdict("misalignment [urad]", worst, 1e6 * ALLOWED * 1.02))
    print(verdict("gradient against differences", found["gradient error"], 1e-6))


@benchmark("four cases", show, design="question (c) alone")
def main(smoke, design=False):
    def told(row):
        return {k: float(f"{v:.3g}") for k, v in row.items()}

    if smoke:
        yield cases(4, 1)
        return
    if not design:
        yield told(cases(1000, 20))
        yield from map(told, sizes(64, [(1, 3), (2, 3), (4, 3), (1, 100)]))
    yield {"before": described(START)}
    x, seconds, error = improved(40)
    yield {"after": described(x), "seconds": round(seconds, 1), "gradient error": error}

"""Does every system of shafts end in an equilibrium, or say why not?

Random systems of five structures, each compiled once: a bevel gear and a belt on a
shaft in two tapers that face each other, adjusted by preload or with play; a helical
stage on two shafts in ball and cylindrical roller bearings and a soft housing; a spur
stage and a belt over three shafts; two tapers that face one way; two ball bearings that
both float. Loads from 1e-2 N to 1e6 N, power in both directions, loose bearings
(clearance to 0.3 mm), seats of 1e6 to 1e11 N/m, shafts that hang over, speeds to 6000
rpm in both senses; in one of seven each: nothing acts, weight alone, at rest.

What converged is checked in NumPy from plain numbers: forces and moments on each shaft
and bearings against the largest load (1e-6), torque about each axis, power that enters,
leaves and is lost, and the force of each bearing against its own solution. A system
that nothing holds must be called so.

README: 200 systems: 146 solved, 53 held by nothing, 1 at the step limit, none wrong;
balance 3e-10 of the largest load | none silent; none wrong | **missed**: 1 silent; none
wrong yes

Last run, seed 0, when the pulleys of the three shafts did not stand in one plane, which
is refused now (two of each since: as expected, balance 8e-11):

opposed tapers: 20 in balance; helical stage: 20; three shafts: 20; tapers one way: 3,
  17 held by nothing; both floating: 12, 8 held by nothing
worst errors: forces 2.1e-10, moments 9.5e-11, torques 4.8e-16, power 2.0e-16, bearings
  against their own solutions 1.0e-14; at most 132 steps; 330 s with compiling, beside
  other work
silent: 0 (at most 0): met; called unheld though held: 0: met; wrong: 0: met
seed 1: as well, but one of the opposed tapers ends at the step limit. It bears its
  weight alone at 0.45 rad/s; by itself, where inertia is left out so slow, it converges
both seeds, 200 systems: 146 solved, 53 held by nothing along the shaft, 1 at the step
  limit (goal none silent: missed); balance of each shaft 3e-10, of power 2e-16
AMD EPYC, 2 cores, load average 12; devices: 1 cpu; jax 0.10.1
"""

import time
from collections import Counter
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from bench import benchmark, no_rows_with

import bearingjax as bj
from bearingjax import shafts
from bearingjax.shafts.seats import with_preload_offsets

BALANCED = 1e-6
NOTHING = 1e-3
"""Force below which errors are not measured by what acts [N]."""
G = 9.80665
_FORWARD = "s", "in", "a"
"""Shafts that turn the same way as the drive."""


def ball(clearance):
    return bj.DeepGrooveBallBearing(
        8, 0.065, 0.015081, outer_osculation=0.53, inner_osculation=0.52,
        radial_internal_clearance=clearance,
    )  # fmt: skip


def cylindrical(clearance):
    return bj.CylindricalRollerBearing(
        13, 0.0655, 0.011, 0.012, radial_internal_clearance=clearance,
        roller_profile=bj.Logarithmic(),
    )  # fmt: skip


def taper(clearance):
    return bj.TaperedRollerBearing(
        17, 0.052, 0.0082, 0.0115, radial_internal_clearance=clearance,
        roller_profile=bj.Logarithmic(),
        roller_axis_angle=np.deg2rad(11), roller_half_angle=np.deg2rad(1.7235),
        ribs=bj.Ribs(inner_minus=bj.Rib(0.09, 1.2e-3)),
    )  # fmt: skip


class Draw:
    """Random numbers of one system, and the special case that it is."""

    def __init__(self, rng, k):
        self.rng = rng
        self.idle, self.light, self.rests = (k % 7 == case for case in (4, 5, 6))
        self.size = 10.0 ** rng.uniform(-2, 6)
        self.speed = 0.0 if self.rests else rng.uniform(-630.0, 630.0)
        if self.idle or self.light:
            self.size = 0.0

    def within(self, low, high):
        return float(self.rng.uniform(low, high))

    def sign(self):
        return float(self.rng.choice([-1.0, 1.0]))

    def drive(self, into):
        """Half of the size as a force at some 40 mm of radius."""
        return shafts.Drive(into, self.speed, torque=0.02 * self.size * self.sign())

    def load(self, shaft, position, axial=True):
        """A force of random direction and a small moment."""
        force = self.size * self.rng.normal(size=3) / np.sqrt(3.0)
        moment = 1e-2 * self.size * self.rng.normal(size=3)
        if not axial:
            force[2] = 0.0
        return shafts.ShaftLoad(f"load {shaft}", shaft, position, force, moment)

    def gravity(self):
        return (0.0, 0.0, 0.0) if self.idle else (0.0, -G, 0.0)

    def seat(self, design, name, shaft, position, clearance=None, **more):
        if clearance is None:
            clearance = self.rng.choice([-5e-6, 0.0, 20e-6, 60e-6, 3e-4])
        element = bj.BearingElement(design(float(clearance)))
        return shafts.Seat(name, shaft, position, bj.Installed(element), **more)

    def housing(self, names):
        return shafts.HousingStiffness.of_seats(
            {name: 10.0 ** self.rng.uniform(6, 11, 3) for name in names}
        )


def line(draw, name, length=0.3, **more):
    """A stepped shaft, solid or hollow."""
    outer = draw.within(0.02, 0.08)
    return shafts.ShaftLine(
        name, [0.4 * length, 0.6 * length], [outer, draw.within(0.6, 1.4) * outer],
        bore=draw.within(0.0, 0.55) * outer, **more,
    )  # fmt: skip


def opposed(draw, turned=(False, True), kind=taper, sources=True, **more):
    """One shaft in two bearings, with a bevel gear and a belt."""
    adjust: list[dict[str, Any]] = [{}, {}]
    if kind is taper and not draw.rests:
        for one in adjust:
            one["axial_offset"] = draw.within(-40e-6, 20e-6)
    if kind is taper and draw.rests:
        for one in adjust:
            one["preload"] = 10.0 ** draw.within(1, 4)
    clearance = 0.0 if kind is taper else None
    a = draw.within(0.02, 0.08)
    seats = [
        draw.seat(kind, n, "s", z, clearance, turned=t, **one, **more)
        for n, z, t, one in zip(
            "AB", (a, draw.within(0.16, 0.22)), turned, adjust, strict=True
        )
    ]
    wheels = []
    if sources:
        wheels = [
            shafts.Gear(
                "bevel", "s", 0.29, teeth=24, normal_module=3e-3,
                helix_angle=draw.within(0.01, 0.6), hand="left",
                mesh_angle=draw.within(-3, 3), pitch_angle=draw.within(0.1, 1.4),
                apex="+z", efficiency=draw.within(0.9, 1.0),
            ),
            shafts.Pulley(
                "belt", "s", 0.01, diameter=0.08, force_ratio=draw.within(1.0, 4.0),
                direction=draw.within(-3, 3),
            ),
        ]  # fmt: skip
    return shafts.ShaftSystem(
        line(draw, "s"),
        seats,
        draw.drive("belt" if sources else "s"),
        wheels,
        loads=draw.load("s", 0.13, axial=sources or draw.rng.random() < 0.7),
        housing=draw.housing("AB"),
        gravity=draw.gravity(),
    )


def stage(draw):
    """Two shafts, a helical stage, axially held by one bearing each; one overhung."""
    helix, eta = draw.within(0.01, 0.6), draw.within(0.85, 1.0)
    gear: dict[str, Any] = {"helix_angle": helix, "efficiency": eta}
    pinion = shafts.Gear(
        "pinion", "in", 0.1, teeth=23, normal_module=3e-3, hand="right", **gear
    )
    wheel = shafts.Gear(
        "wheel",
        "out",
        0.12,
        teeth=60,
        normal_module=3e-3,
        hand="left",
        mates_with="pinion",
        **gear,
    )
    angle = draw.within(-3, 3)
    apart = float(pinion.radius + wheel.radius) * draw.within(0.98, 1.04)
    across = apart * np.array([np.cos(angle), np.sin(angle)])
    lines = [
        line(draw, "in", origin=(0.0, 0.0, 0.0)),
        line(draw, "out", origin=(*across, -0.02)),
    ]
    seats = [
        draw.seat(ball, "A", "in", draw.within(0.01, 0.09)),
        draw.seat(cylindrical, "B", "in", draw.within(0.13, 0.3)),
        draw.seat(ball, "C", "out", draw.within(0.0, 0.1)),
        draw.seat(ball, "D", "out", draw.within(0.21, 0.3), floating=True),
    ]
    return shafts.ShaftSystem(
        lines, seats, draw.drive("in"), [pinion, wheel],
        loads=draw.load("out", 0.2), housing=draw.housing("ABC"),
        gravity=draw.gravity(),
    )  # fmt: skip


def three(draw):
    """Three shafts: a spur stage, then a belt; one shaft in three bearings."""
    eta = draw.within(0.85, 1.0)
    wheels = [
        shafts.Gear("g1", "a", 0.1, teeth=20, normal_module=4e-3, efficiency=eta),
        shafts.Gear("g2", "b", 0.1, teeth=40, normal_module=4e-3, mates_with="g1"),
        shafts.Pulley("p1", "b", 0.28, diameter=0.1, force_ratio=draw.within(1.0, 4.0)),
        shafts.Pulley(
            "p2",
            "c",
            0.02,
            diameter=0.2,
            force_ratio=2.0,
            mates_with="p1",
            efficiency=eta,
        ),
    ]
    places = {"a": (0.0, 0.0, 0.0), "b": (0.12, 0.0, 0.0), "c": (0.3, 0.3, 0.26)}
    lines = [line(draw, n, origin=at) for n, at in places.items()]
    seats = [draw.seat(ball, f"{n}1", n, draw.within(0.03, 0.09)) for n in places]
    seats += [draw.seat(ball, f"{n}2", n, 0.2, floating=True) for n in places]
    seats += [draw.seat(cylindrical, "c3", "c", draw.within(0.25, 0.3))]
    axis = draw.load("c", 0.15)
    return shafts.ShaftSystem(
        lines, seats, draw.drive("a"), wheels,
        couplings=[shafts.Coupling("out", "c")], loads=axis,
        housing=draw.housing(["b1", "b2"]), gravity=draw.gravity(),
    )  # fmt: skip


STRUCTURES = {
    "opposed tapers": opposed,
    "helical stage": stage,
    "three shafts": three,
    "tapers one way": lambda draw: opposed(draw, (False, False), sources=False),
    "both floating": lambda draw: opposed(
        draw, (False, False), ball, sources=False, floating=True
    ),
}


def path_along(name, system):
    """Whether something takes up the axial load; `None`: not told by statics alone."""
    if name == "both floating":
        return float(system.loads[0].force[2]) == 0.0
    if name == "tapers one way":
        # The radial load of a taper drives its cone out.
        force = np.asarray(system.loads[0].force)
        if force[2] < 0:
            return False
        return None
    return True


@eqx.filter_jit
def solve(systems):
    """Answers of stacked systems."""
    arrays, rest = eqx.partition(systems, eqx.is_array)

    def one(arrays):
        system = eqx.combine(arrays, rest)
        found = shafts.solve_system(system, throw=False)
        own = shafts.bearing_solutions(system, found, points=2)
        forces = [s.force[6:11] for s in own]
        return found, jnp.stack(forces)

    return jax.lax.map(one, arrays)


def checked(system, found, own):
    """Worst error of a converged answer over what it is measured by, by its name."""
    loads = np.asarray(found.load)
    power = found.power
    names = [s.name for s in system.shafts]
    speeds = np.asarray(power.speed)
    forces = [np.asarray(m.force) for m in power.meshes]
    forces += [np.asarray(load.force) for load in system.loads]
    size = max(NOTHING, np.abs(loads[:, :3]).max(), *(np.abs(f).max() for f in forces))
    errors = dict.fromkeys(("force", "moment", "torque", "power", "bearing"), 0.0)
    work, most = -float(power.loss), 0.0

    def larger(name, value, of):
        errors[name] = max(errors[name], 0.0 if value == 0 else float(value / of))

    for shaft, speed in zip(system.shafts, speeds, strict=True):
        z = np.asarray(shaft.axis, float)
        lengths = np.asarray(shaft.length)
        total, moment, torque = np.zeros(3), np.zeros(3), 0.0
        ends = np.concatenate([[0.0], np.cumsum(lengths)])
        outer, bore = (
            np.broadcast_to(np.asarray(d), lengths.shape)
            for d in (shaft.outer_diameter, shaft.bore)
        )
        of = shaft.material
        of = of if isinstance(of, tuple) else (of,) * len(lengths)
        density = np.array([float(material.density) for material in of])
        mass = density * np.pi / 4 * (outer**2 - bore**2)
        acting = [
            (middle * z, m * np.asarray(system.gravity), np.zeros(3))
            for middle, m in zip(
                0.5 * (ends[1:] + ends[:-1]), mass * lengths, strict=True
            )
        ]
        size = max(size, *(np.abs(force).max() for _, force, _ in acting))
        for mesh in power.meshes:
            wheel = system.wheel(mesh.wheel)
            if wheel.shaft != shaft.name:
                continue
            place, force = np.asarray(mesh.place), np.asarray(mesh.force)
            acting.append((float(wheel.position) * z + place, force, np.zeros(3)))
            torque += float(mesh.torque)
            most = max(most, abs(float(mesh.torque)))
            if place.any():
                own_torque = np.cross(place, force) @ z
                # At rest power flows as if the drive began to turn forwards.
                sense = speed or (1.0 if shaft.name in _FORWARD else -1.0)
                if mesh.mate is not None and float(mesh.torque) * sense > 0:
                    # The force is that of the mate, which gives the power.
                    mate = system.wheel(mesh.mate)
                    own_torque *= float(wheel.efficiency * mate.efficiency)
                scale = max(np.abs(force).max() * np.abs(place).max(), 1e-300)
                larger("torque", abs(own_torque - float(mesh.torque)), scale)
        for load in system.loads:
            if load.shaft == shaft.name:
                own_moment = np.asarray(load.moment)
                at = float(load.position) * z
                acting.append((at, np.asarray(load.force), own_moment))
                torque += own_moment @ z
                work += (own_moment @ z) * speed
                most = max(most, abs(own_moment @ z))
        for seat, load in zip(system.seats, loads, strict=True):
            if seat.shaft == shaft.name:
                acting.append((float(seat.position) * z, -load[:3], -load[3:]))
        for place, force, own_moment in acting:
            total += force
            moment += np.cross(place, force) + own_moment
        for part, value in zip(system.couplings, power.coupling, strict=True):
            if part.shaft == shaft.name:
                torque += float(value)
                work += float(value) * speed
        into = system.drive.into
        if into == shaft.name:
            torque += float(power.drive)
        if power.output is not None and power.output_shaft == shaft.name:
            torque += float(power.output)
            work += float(power.output) * speed
        larger("force", np.abs(total).max(), size)
        across = moment - (moment @ z) * z
        larger("moment", np.abs(across).max(), size * ends[-1])
        larger("torque", abs(torque), max(most, 1e-300))
    into = system.drive.into
    root = names.index(into if into in names else system.wheel(into).shaft)
    work += float(power.drive) * speeds[root]
    for mesh in power.meshes:
        wheel = system.wheel(mesh.wheel)
        if mesh.mate is None and wheel.name != into:
            work += float(mesh.torque) * speeds[names.index(wheel.shaft)]
    flow = max(abs(float(power.drive) * speeds[root]), most * np.abs(speeds).max())
    larger("power", abs(work), max(flow, 1e-300))
    if float(power.loss) < -1e-9 * flow:
        errors["power"] = np.inf
    for seat, load, force in zip(system.seats, loads, own, strict=True):
        frame = np.asarray(system.shaft(seat.shaft).frame)
        local = np.concatenate([frame @ load[:3], (frame @ load[3:])[:2]])
        if seat.turned:
            local *= [1.0, -1.0, -1.0, 1.0, -1.0]
        # Moments count at a lever of 0.1 m.
        apart = np.abs(local - force) / np.array([1.0] * 3 + [0.1] * 2)
        larger("bearing", apart.max(), size)
    return errors


def run(count, seed=0):
    """Rows of figures, one for each structure.

    Args:
        count: Systems of each.
        seed: Of their numbers.
    """
    for index, (name, build) in enumerate(STRUCTURES.items()):
        rng = np.random.default_rng([seed, index])
        systems, refused = [], []
        for k in range(count):
            try:
                systems.append(with_preload_offsets(build(Draw(rng, k))))
            except (ValueError, bj.SolveError) as error:
                refused.append(str(error))
        # The number of beam elements is that of the first.
        leaves, tree = zip(*(jax.tree.flatten(s) for s in systems), strict=True)
        systems = [jax.tree.unflatten(tree[0], of) for of in leaves]
        begin = time.perf_counter()
        whole = jax.tree.map(lambda *of: jnp.stack(of), *systems)
        found, own = jax.device_get(solve(whole))
        seconds = time.perf_counter() - begin
        codes, worst = Counter(), Counter()
        wrong, left, held, steps = [], [], 0, 0
        for k, system in enumerate(systems):
            answer = jax.tree.map(lambda leaf, k=k: leaf[k], found)
            code = bj.Result(int(answer.result))
            codes[code.label] += 1
            path = path_along(name, system)
            steps = max(steps, int(answer.steps))
            if code is bj.Result.NO_LOAD_PATH and path:
                held += 1
                left.append((k, code.label))
            if code not in (bj.Result.NO_LOAD_PATH, bj.Result.CONVERGED):
                left.append((k, code.label))
            if code is not bj.Result.CONVERGED:
                continue
            errors = checked(system, answer, own[k])
            for key, value in errors.items():
                worst[key] = max(worst[key], value)
            if path is False or not max(errors.values()) < BALANCED:
                wrong.append((k, {key: f"{v:.1e}" for key, v in errors.items()}))
        yield {
            "structure": name, "systems": len(systems), "refused": refused,
            "codes": dict(codes), "called unheld though held": held,
            "silent": sum(
                n for label, n in codes.items()
                if label not in (bj.Result.CONVERGED.label, "no_load_path")
            ),
            "unsolved": left, "wrong": wrong, "most_steps": steps,
            "worst": {k: float(f"{v:.2g}") for k, v in worst.items()},
            "seconds": round(seconds, 1),
        }  # fmt: skip


@benchmark(
    "two of each", no_rows_with("silent", "called unheld though held", "wrong"),
    count="of each structure",
)  # fmt: skip
def main(smoke, count=20, seed=0):
    return run(2 if smoke else count, seed)

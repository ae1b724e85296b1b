"""Equilibrium of shafts on bearings, against beams and iterations written anew."""

from dataclasses import replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from systems import ELEMENT, STIFF, ball, springs, stage, three_bearings
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.friction import films
from bearingjax.numerics.implicit import with_zeros
from bearingjax.numerics.types import with_fields
from bearingjax.rotor import BearingSupport
from bearingjax.shafts import (
    Drive,
    Gear,
    HousingStiffness,
    Seat,
    ShaftLine,
    ShaftLoad,
    ShaftSystem,
    bearing_solutions,
    solve_system,
)
from bearingjax.shafts.changes import _state_with_changes
from bearingjax.shafts.equilibrium import search_known, without_bearings
from bearingjax.shafts.seats import axial_growth, offset_of, supports_of
from bearingjax.statics import BallSolution, load_result, warnings

LOAD = [
    ShaftLoad("p", "s", 0.12, (300.0, -2000.0, 700.0), (10.0, -25.0, 0.0)),
    ShaftLoad("q", "s", 0.35, (-1500.0, 800.0, -500.0)),
]


def beam(z, diameters, modulus=206e9, poisson=0.3):
    """Stiffness of a Timoshenko shaft of the nodes z, in NumPy."""
    n = len(z)
    matrix = np.zeros((5 * n, 5 * n))
    shear = modulus / (2 * (1 + poisson))
    kappa = 6 * (1 + poisson) / (7 + 6 * poisson)
    for k, d in enumerate(diameters):
        long, area, inertia = z[k + 1] - z[k], np.pi / 4 * d**2, np.pi / 64 * d**4
        phi = 12 * modulus * inertia / (kappa * shear * area * long**2)
        c = modulus * inertia / (long**3 * (1 + phi))
        bent = c * np.array(
            [
                [12, 6 * long, -12, 6 * long],
                [6 * long, (4 + phi) * long**2, -6 * long, (2 - phi) * long**2],
                [-12, -6 * long, 12, -6 * long],
                [6 * long, (2 - phi) * long**2, -6 * long, (4 + phi) * long**2],
            ]
        )
        for freedoms, sign in (((0, 4), 1.0), ((1, 3), -1.0)):
            at = [5 * k + freedoms[0], 5 * k + freedoms[1]]
            at += [5 * k + 5 + freedoms[0], 5 * k + 5 + freedoms[1]]
            turn = np.diag([1.0, sign, 1.0, sign])
            matrix[np.ix_(at, at)] += turn @ bent @ turn
        along = modulus * area / long * np.array([[1, -1], [-1, 1]])
        at = [5 * k + 2, 5 * k + 7]
        matrix[np.ix_(at, at)] += along
    return matrix


Z = np.array([0.0, 0.05, 0.12, 0.15, 0.25, 0.35, 0.4, 0.45, 0.5])
D = np.array([0.04, 0.04, 0.04, 0.05, 0.05, 0.05, 0.04, 0.04])
AT = {"A": 1, "B": 4, "C": 7}


def forces():
    force = np.zeros(5 * len(Z))
    force[10:15] = [300.0, -2000.0, 700.0, 10.0, -25.0]
    force[25:28] = [-1500.0, 800.0, -500.0]
    return force


def by_hand(bearing):
    """Loads of three bearings (bearing, 5) by Newton's method over all nodes, each
    bearing a function of its displacement called as a black box."""
    shaft, force = beam(Z, D), forces()
    x = np.zeros(len(force))
    # The balls touch: by hand Newton's method finds no way from the play.
    x[1::5], x[2::5] = -3e-5, 1e-5
    for _ in range(60):
        left, slope = shaft @ x - force, shaft.copy()
        for node in AT.values():
            at = slice(5 * node, 5 * node + 5)
            pushed, stiffness = bearing(x[at])
            left[at] += pushed
            slope[at, at] += stiffness
        step = np.linalg.solve(slope, left)
        x -= step * min(1.0, 2e-6 / np.abs(step).max() * 10)
        if np.abs(step).max() < 1e-16:
            break
    return np.array([bearing(x[5 * n : 5 * n + 5])[0] for n in AT.values()]), x


@pytest.mark.slow
def test_three_bearings_by_hand():
    """AF006-2: a statically indeterminate shaft on true bearings."""

    @jax.jit
    def rings(q):
        model = ELEMENT.model(None)
        found = model.evaluate(q, model.solve(q))
        return found.force[6:11], found.stiffness[6:11, 6:11]

    def bearing(moved):
        q = np.zeros(12)
        q[6:11] = moved
        return [np.asarray(part) for part in rings(q)]

    wanted, moved = by_hand(bearing)
    found = solve_system(three_bearings(LOAD))
    load = np.asarray(found.load)[:, :5]
    np.testing.assert_allclose(load, wanted, atol=1e-8 * np.abs(wanted).max())
    state = found.shafts[0]
    own = np.array([state.displacement[np.isclose(state.position, z)][0] for z in Z])
    np.testing.assert_allclose(own.ravel(), moved, atol=1e-8 * np.abs(moved).max())


def test_springs_by_hand():
    """On springs it is one linear system; shear and moment lines are those of cuts."""
    springy = np.array([2e8, 1e8, 5e7, 1e4, 2e4])
    system = three_bearings(LOAD, lambda n, s, z: springs(n, s, z, springy))
    found = solve_system(system)
    matrix = beam(Z, D)
    for node in AT.values():
        at = range(5 * node, 5 * node + 5)
        matrix[at, at] += springy
    x = np.linalg.solve(matrix, forces())
    wanted = np.array([springy * x[5 * n : 5 * n + 5] for n in AT.values()])
    np.testing.assert_allclose(found.load[:, :5], wanted, rtol=1e-9, atol=1e-6)
    state = found.shafts[0]
    z, cut = np.asarray(state.position), 0.3
    k = int(np.flatnonzero(z <= cut)[-1])
    acting = [(p.position, p.force, p.moment) for p in LOAD]
    acting += [
        (Z[n], -w[:3], -np.append(w[3:], 0.0))
        for n, w in zip(AT.values(), wanted, strict=True)
    ]
    before = [(float(p), np.asarray(f), np.asarray(m)) for p, f, m in acting if p < cut]
    shear = -np.sum([f for _, f, _ in before], axis=0)
    turned = [m + np.cross([0, 0, p - z[k]], f) for p, f, m in before]
    bent = -np.sum(turned, axis=0)
    np.testing.assert_allclose(state.shear[k], shear, rtol=1e-9)
    np.testing.assert_allclose(state.moment[k], bent[:2], rtol=1e-9, atol=1e-9)
    for end in (0, -1):
        assert np.abs(state.shear[end]).max() < 1e-8
        assert np.abs(state.moment[end]).max() < 1e-9


def test_loads_of_meshing_shafts_balance():
    """On each of two shafts the bearings bear the force of its wheel, without moment
    about its place but for the torque; a floating one nothing along the shaft."""

    def seats(name, shaft, position):
        return springs(name, shaft, position, floating=name in "BD")

    system = stage(seats)
    found = solve_system(system)
    for mesh in found.power.meshes:
        wheel = system.wheel(mesh.wheel)
        shaft = wheel.shaft
        on = [k for k, seat in enumerate(system.seats) if seat.shaft == shaft]
        load, force = np.asarray(found.load)[on], np.asarray(mesh.force)
        np.testing.assert_allclose(load[:, :3].sum(axis=0), force, rtol=1e-9)
        axis = np.asarray(system.shaft(shaft).origin)
        places = [axis + [0.0, 0.0, float(system.seats[k].position)] for k in on]
        middle = axis + [0.0, 0.0, float(wheel.position)] + np.asarray(mesh.place)
        arms = [place - middle for place in places]
        moment = np.cross(arms, load[:, :3]).sum(axis=0)
        moment += load[:, 3:].sum(axis=0)
        np.testing.assert_allclose(moment[:2], 0.0, atol=1e-6)
    np.testing.assert_allclose(np.asarray(found.load)[[1, 3], 2], 0.0, atol=1e-6)


def test_weight_between_supports():
    """The line of a shaft of even weight: q L²/8 in the middle, 5 q L⁴/384 E I and the
    share of shear."""
    line = ShaftLine("s", [0.5, 0.5], [0.05])
    seats = [springs(n, "s", z) for n, z in (("A", 0.0), ("B", 1.0))]
    found = solve_system(ShaftSystem(line, seats, gravity=(0.0, -9.81, 0.0)))
    state = found.shafts[0]
    weight = 7850.0 * np.pi / 4 * 0.05**2 * 9.81
    middle = np.argmin(np.abs(np.asarray(state.position) - 0.5))
    np.testing.assert_allclose(abs(state.moment[middle, 0]), weight / 8, rtol=1e-9)
    np.testing.assert_allclose(found.load[:, 1], -weight / 2, rtol=1e-9)
    stiff = 206e9 * np.pi / 64 * 0.05**4
    kappa = 6 * 1.3 / (7 + 6 * 0.3)
    area = np.pi / 4 * 0.05**2
    sag = 5 * weight / (384 * stiff) + weight / (8 * kappa * 206e9 / 2.6 * area)
    own = -float(state.displacement[middle, 1]) - weight / 2 / STIFF[0]
    np.testing.assert_allclose(own, sag, rtol=1e-9)


@pytest.mark.slow
def test_stiff_surroundings():
    """AF006-3: on a rigid shaft in a rigid housing a determinate system loads each
    bearing by statics alone, and each is as if alone under that load."""
    line = ShaftLine("s", [0.3], [0.05], rigid=True)
    seats = [
        Seat("A", "s", 0.05, bj.Installed(ELEMENT)),
        Seat("B", "s", 0.25, stiffness=np.array([1e13, 1e13, 0.0, 0.0, 0.0])),
    ]
    load = ShaftLoad("p", "s", 0.1, (800.0, -3000.0, 1200.0))
    found = solve_system(ShaftSystem(line, seats, loads=load))
    # The bearing holds a tilt too: its moment comes with the loads.
    own = np.asarray(found.load[0])
    alone = bj.solve_load(ELEMENT, own)
    np.testing.assert_allclose(alone.displacement[6:11], found.motion[0], rtol=1e-7)
    lever = (0.25 - 0.1) / 0.2 * np.array([800.0, -3000.0])
    held = own[[4, 3]] * np.array([1.0, -1.0]) / 0.2
    np.testing.assert_allclose(own[:2], lever + held, rtol=1e-9)


@pytest.mark.parametrize("name", ["1206", "22206 E"])
@pytest.mark.slow
def test_self_aligning_bearing_is_a_hinge(name):
    """Balls, and barrel rollers by their exact kinematics."""
    element = bj.BearingElement(bj.load_bearing(name))
    assert isinstance(element.kinematics, bj.element.Finite) or name == "1206"
    hinge = bj.Installed(element)
    line = ShaftLine("s", [0.4], [0.03])
    seats = [Seat("A", "s", 0.02, hinge), springs("B", "s", 0.38)]
    load = ShaftLoad("p", "s", 0.2, (0.0, -3000.0, 0.0))
    found = solve_system(ShaftSystem(line, seats, loads=load))
    # What is left of the moment is of second order in the tilt.
    np.testing.assert_allclose(found.load[:, 1], -1500.0, rtol=1e-6)
    assert np.abs(found.load[0, 3:]).max() < 1e-5 * 1500.0 * 0.024
    assert float(found.displacement[0, 3]) > 1e-4


def test_soft_housing_shares_the_load():
    """A housing in series softens the middle one of three springs in a line."""
    line = ShaftLine("s", [0.4], [0.05], rigid=True)
    k = np.array([1e8, 1e8, 1e8, 0.0, 0.0])
    seats = [springs(n, "s", z, k) for n, z in (("A", 0.1), ("B", 0.2), ("C", 0.3))]
    load = ShaftLoad("p", "s", 0.2, (0.0, -900.0, 0.0))
    stiff = solve_system(ShaftSystem(line, seats, loads=load))
    np.testing.assert_allclose(stiff.load[:, 1], -300.0, rtol=1e-9)
    housing = HousingStiffness.of_seats({"B": [5e7, 5e7, 5e7]})
    soft = solve_system(ShaftSystem(line, seats, loads=load, housing=housing))
    series = 1 / (1 / 1e8 + 1 / 5e7)
    share = np.array([1e8, series, 1e8]) / (2e8 + series)
    np.testing.assert_allclose(soft.load[:, 1], -900.0 * share, rtol=1e-9)
    np.testing.assert_allclose(soft.housing[0, 1], -900.0 * share[1] / 5e7, rtol=1e-9)


@pytest.mark.parametrize(
    "wrong, told",
    [
        (lambda: springs("x", "s", 0.1, preload=3.0), "`preload` of x has no effect"),
        (lambda: springs("x", "s", 0.1, axial_offset=1e-6), "goes with a bearing"),
        (lambda: springs("x", "s", 0.1, turned=True), "`turned` of x has no effect"),
        (lambda: ball("x", "s", 0.1, preload=3.0, floating=True), "ring slides"),
        (lambda: HousingStiffness(("x", "x"), np.eye(6)), "`seats` has x twice"),
    ],
)
def test_inputs_without_effect_are_refused(wrong, told):
    with pytest.raises(ValueError, match=told):
        wrong()


def test_housing_matrix():
    """A housing that couples its seats, with rotations, on an oblique shaft: the whole
    linear system in global axes."""
    generator = np.random.default_rng(3)
    root = generator.normal(size=(12, 12)) * 1e3 + 1e4 * np.eye(12)
    matrix = root @ root.T
    axis = np.array([1.0, 2.0, 2.0]) / 3.0
    line = ShaftLine("s", [0.2], [0.05], axis=axis, rigid=True)
    k = np.array([1e8, 2e8, 3e8, 1e4, 1e4])
    seats = [springs(n, "s", z, k) for n, z in (("A", 0.0), ("B", 0.2))]
    load = ShaftLoad("p", "s", 0.05, (100.0, -250.0, 300.0))
    found = solve_system(
        ShaftSystem(
            line, seats, loads=load, housing=HousingStiffness(("A", "B"), matrix)
        )
    )
    frame = np.asarray(line.frame)
    assert np.allclose(frame @ frame.T, np.eye(3)) and np.linalg.det(frame) > 0
    np.testing.assert_allclose(frame[2], axis, rtol=1e-14)
    np.testing.assert_allclose(found.load[:, :3].sum(axis=0), load.force, rtol=1e-9)
    # Loads on the seats move them by the matrix.
    loads = np.asarray(found.load).reshape(-1)
    moved = np.linalg.solve(matrix, loads)
    np.testing.assert_allclose(found.housing.reshape(-1), moved, rtol=1e-8)


@pytest.mark.slow
def test_floating_bearing():
    """A floating ring carries no axial load; the other one takes it all."""
    line = ShaftLine("s", [0.3], [0.04])
    load = ShaftLoad("p", "s", 0.12, (0.0, -2000.0, 900.0))
    for floating in ("A", "B"):
        seats = [
            ball(n, "s", z, floating=n == floating)
            for n, z in (("A", 0.05), ("B", 0.25))
        ]
        found = solve_system(ShaftSystem(line, seats, loads=load))
        axial = np.asarray(found.load[:, 2])
        wanted = np.array([0.0, 900.0]) if floating == "A" else np.array([900.0, 0.0])
        np.testing.assert_allclose(axial, wanted, atol=1e-6)


OIL = bj.lubrication.iso_vg(68.0)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.0, 1.0, 100.0])
def test_balls_of_standing_slow_and_fast_shafts(speed):
    """Whether or not balls feel the speed, a solution at a speed has their kinematics,
    and lives, films, friction and warnings follow from it."""
    seats = [ball("A", "s", 0.05), ball("B", "s", 0.25, floating=True)]
    load = ShaftLoad("p", "s", 0.12, (300.0, -2000.0, 700.0))
    drive = Drive("s", speed, torque=0.0)
    system = ShaftSystem(ShaftLine("s", [0.3], [0.04]), seats, drive, loads=load)
    assert system.inertia is {0.0: None, 1.0: False, 100.0: True}[speed]
    for one in bearing_solutions(system, solve_system(system)):
        assert isinstance(one, BallSolution)
        assert isinstance(warnings(one), list)
        life = bj.rating_life(one.element, one)
        if not speed:
            assert one.speed is None and one.kinematics is None
            assert life.life_hours is None
            continue
        loaded = np.asarray(one.load_zone)
        cosine = np.cos(np.asarray(one.contact_angle)[loaded].mean(axis=1))
        wanted = 0.5 * speed * (1.0 - 0.015081 / 0.065 * cosine)
        assert one.kinematics is not None and one.centrifugal_force is not None
        np.testing.assert_allclose(one.kinematics.orbit[loaded], wanted, rtol=1e-3)
        assert (np.asarray(one.centrifugal_force) > 0).all() == (speed > 10)
        hours = float(life.reference_rating_life) / (speed * 3600.0 / (2.0 * np.pi))
        assert life.life_hours is not None
        np.testing.assert_allclose(float(life.life_hours), hours, rtol=1e-12)
        found = films(one, OIL, 330.0).minimum[loaded]
        assert (np.asarray(found) > 0).all() and np.isfinite(found).all()
        assert float(bj.friction_torque(one, 3e-5).power) > 0


def test_inertia_is_that_of_the_fastest_bearing():
    """Speeds multiply over the stages: 10 000 mm/min of a bearing behind three stages
    that speed up by 3, 2 and 2.5 are 10.3 rpm of the drive."""
    pairs = {"ab": (60, 20), "bc": (40, 20), "cd": (50, 20)}
    lines = [ShaftLine(name, [0.3], [0.03]) for name in "abcd"]
    seats = [
        (ball if name == "d" else springs)(f"{name}{z}", name, z)
        for name in "abcd"
        for z in (0.02, 0.28)
    ]
    wheels = []
    for k, ((near, far), (large, small)) in enumerate(pairs.items()):
        near, far = (near, large), (far, small)
        place = 0.05 * (k + 1)
        wheels += [
            Gear(f"{shaft}{far[0]}", shaft, place, teeth, 3e-3,
                 mates_with=None if teeth == large else f"{near[0]}{far[0]}",
                 mesh_angle=0.3 if teeth == large else None)
            for shaft, teeth in (near, far)
        ]  # fmt: skip
    limit = 1e4 / 65.0 / 15.0 * 2.0 * np.pi / 60.0
    for share in (0.99, 1.01):
        drive = Drive("a", share * limit, torque=1.0)
        system = ShaftSystem(lines, seats, drive, wheels)
        assert system.inertia is (share > 1.0)
        # The slow end of the same gears driven at the other one.
        drive = Drive("d", share * limit, torque=1.0)
        assert ShaftSystem(lines, seats, drive, wheels).inertia is False
    faster = system.with_parts(drive=Drive("a", 2.0 * limit, torque=1.0))
    assert faster.inertia is True


@pytest.mark.slow
def test_solve_system_without_axial_support():
    line = ShaftLine("s", [0.3], [0.04])
    seats = [ball(n, "s", z, floating=True) for n, z in (("A", 0.05), ("B", 0.25))]
    load = ShaftLoad("p", "s", 0.12, (0.0, -2000.0, 900.0))
    with pytest.raises(bj.SolveError, match="takes up the load along uz of shaft s"):
        solve_system(ShaftSystem(line, seats, loads=load))


@pytest.mark.parametrize("axial", [-900.0, 100.0])
@pytest.mark.slow
def test_solve_system_tapers_in_tandem_without_load_path(axial):
    """Nothing holds them against a pull, or against what their radial loads press them
    apart with."""
    taper = bj.Installed(bj.BearingElement(bj.load_bearing("30206")))
    line = ShaftLine("s", [0.3], [0.04])
    seats = [Seat(n, "s", z, taper) for n, z in (("A", 0.05), ("B", 0.25))]
    load = ShaftLoad("p", "s", 0.12, (0.0, -2000.0, axial))
    with pytest.raises(bj.SolveError, match="takes up the load along uz of shaft s"):
        solve_system(ShaftSystem(line, seats, loads=load))


@pytest.mark.slow
def test_solve_system_without_load_and_weight():
    """A turning shaft in loose bearings without load and weight is in balance."""
    line = ShaftLine("s", [0.3], [0.04])
    seats = [ball(n, "s", z) for n, z in (("A", 0.05), ("B", 0.25))]
    found = solve_system(ShaftSystem(line, seats, Drive("s", 500.0)))
    assert np.abs(found.load).max() < 1e-9


@pytest.mark.slow
def test_places_of_gears_and_bearings():
    """Of the gear stage the loads balance forces and moments of each shaft, and the
    solutions of the bearings have the loads of the system."""
    system = stage(ball, housing=[3e8, 2e8, 1e8], gravity=(0.0, -9.81, 0.0))
    found = solve_system(system)
    origin = {s.name: np.asarray(s.origin) for s in system.shafts}
    for name in ("in", "out"):
        force, moment = np.zeros(3), np.zeros(3)
        for mesh in found.power.meshes:
            wheel = system.wheel(mesh.wheel)
            if wheel.shaft == name:
                at = np.array([0.0, 0.0, float(wheel.position)]) + np.asarray(
                    mesh.place
                )
                force += np.asarray(mesh.force)
                moment += np.cross(at, np.asarray(mesh.force))
        for k, seat in enumerate(system.seats):
            if seat.shaft == name:
                own = -np.asarray(found.load[k])
                force += own[:3]
                moment += own[3:] + np.cross([0, 0, float(seat.position)], own[:3])
        index = [s.name for s in system.shafts].index(name)
        shaft = system.beam(index)
        mass = np.asarray(shaft.element_masses())
        middle = 0.5 * (np.asarray(shaft.nodes)[1:] + np.asarray(shaft.nodes)[:-1])
        force[1] -= 9.81 * mass.sum()
        moment[0] += 9.81 * (mass * middle).sum()
        assert np.abs(force).max() < 1e-7 and np.abs(moment[:2]).max() < 1e-8, origin
    for k, one in enumerate(bearing_solutions(system, found)):
        np.testing.assert_allclose(
            one.force[6:11], found.load[k, :5], rtol=1e-7, atol=1e-6
        )
        assert one.speed is not None


@pytest.mark.slow
def test_solve_system_reversed_shaft_keeps_bearing_loads():
    """It is the same shaft, with its bearings turned. The elements stand mirrored about
    local x, and so in the same places: one of them stands at azimuth 0."""
    taper = bj.Installed(bj.BearingElement(bj.load_bearing("30206")))
    loads = []
    for end in (False, True):
        line = ShaftLine("s", [0.3], [0.04], axis=(0.0, 0.0, -1.0 if end else 1.0))
        a, b, at = (0.25, 0.05, 0.2) if end else (0.05, 0.25, 0.1)
        seats = [
            Seat("A", "s", a, taper, preload=200.0, turned=end),
            Seat("B", "s", b, taper, preload=200.0, turned=not end),
        ]
        load = ShaftLoad("p", "s", at, (500.0, -2000.0, 400.0), (3.0, 4.0, 0.0))
        loads.append(solve_system(ShaftSystem(line, seats, loads=load)).load)
    np.testing.assert_allclose(loads[1], loads[0], rtol=1e-7, atol=1e-5)


def test_growth_by_heat():
    """Axial growth of shaft against housing between two bearings."""
    seat = bj.Mounting(0.04, 0.09, 0.12, 0.0, 0.0)
    warm = bj.FitConditions(shaft=30.0, housing=10.0)
    installed = bj.Installed(ELEMENT, None, seat, warm)
    cool = bj.Installed(ELEMENT, None, seat, bj.FitConditions(shaft=10.0, housing=10.0))
    line = ShaftLine("s", [0.5], [0.04])
    seats = [Seat("A", "s", 0.05, installed), Seat("B", "s", 0.45, cool)]
    growth = axial_growth(without_bearings(ShaftSystem(line, seats)), np.zeros(2))
    steel = float(bj.fits.WarmMaterial().expansion)
    np.testing.assert_allclose(growth, [0.0, 0.5 * steel * 20.0 * 0.4], rtol=1e-12)
    # Rings that abut what stands between them grow over half of their width: of the
    # first one 10 mm of ring, 5 K less than the shaft, in place of as much shaft.
    seat = replace(seat, ring_width=0.02)
    warm = replace(warm, inner_ring=25.0, outer_ring=10.0)
    seats[0] = Seat("A", "s", 0.05, bj.Installed(ELEMENT, None, seat, warm))
    wide = axial_growth(without_bearings(ShaftSystem(line, seats)), np.zeros(2))
    np.testing.assert_allclose(wide - growth, [0.0, -steel * 5.0 * 0.01], rtol=1e-9)


NUMBERS = {
    "position of a bearing": lambda s: s.seats[1].position,
    "position of the wheel": lambda s: s.wheels[1].position,
    "diameter of a segment": lambda s: s.shafts[0].outer_diameter,
    "length of a segment": lambda s: s.shafts[0].length,
    "helix angle": lambda s: s.wheels[0].helix_angle,
    "place of a shaft": lambda s: s.shafts[1].origin,
    "power": lambda s: s.drive.power,
    "speed": lambda s: s.drive.speed,
    "ball diameter": lambda s: s.seats[0].installed.drawing.bearing.ball_diameter,
    "housing": lambda s: s.housing.matrix,
}


@pytest.fixture(scope="module")
def answers():
    """Loads, tilts, misalignment, and life of the first bearing, over the numbers."""
    system = stage(ball, housing=[3e8, 2e8, 1e8])
    arrays, rest = eqx.partition(system, eqx.is_inexact_array)

    @jax.jit
    def value(arrays):
        whole = eqx.combine(arrays, rest)
        found = solve_system(whole, throw=False)
        one = bearing_solutions(whole, found)[0]
        life = bj.rating_life(one.element, one).reference_rating_life
        parts = [found.load.ravel(), 1e6 * found.displacement.ravel()]
        return jnp.concatenate([*parts, 1e6 * found.misalignment, life[None] / 1e6])

    @jax.jit
    def slope(arrays, change):
        return jax.jvp(value, (arrays,), (change,))[1]

    return arrays, value, slope


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.slow
def test_derivatives(answers, name):
    """AF006-6: every answer has a derivative by every number."""
    arrays, value, slope = answers
    still = jax.tree.map(jnp.zeros_like, arrays)
    here = NUMBERS[name](arrays)
    way = jnp.zeros_like(here)
    way = way + 1.0 if way.ndim == 0 else way.at[(0,) * way.ndim].set(1.0)
    own = np.asarray(slope(arrays, eqx.tree_at(NUMBERS[name], still, way)))
    size = float(jnp.max(jnp.abs(here)))

    def difference(step):
        ends = [
            value(eqx.tree_at(NUMBERS[name], arrays, here + way * (sign * step)))
            for sign in (1.0, -1.0)
        ]
        return np.asarray((ends[0] - ends[1]) / (2.0 * step))

    coarse, fine = difference(2e-4 * size), difference(1e-4 * size)
    wanted = (4.0 * fine - coarse) / 3.0
    assert np.abs(own).max() > 0
    np.testing.assert_allclose(own, wanted, atol=1e-6 * np.abs(wanted).max())


@pytest.mark.slow
def test_system_of_known_numbers_is_that_of_a_traced_one():
    """Solved by calls of the programs of bearings, and as one program."""
    line = ShaftLine("s", [0.1, 0.3], [0.04, 0.05])
    seats = (
        ball("A", "s", 0.02, preload=150.0),
        ball("B", "s", 0.36, turned=True, preload=150.0),
        springs("C", "s", 0.2, [1e7, 1e7, 0.0, 0.0, 0.0]),
    )
    for drive in (None, Drive("s", 30.0), Drive("s", 900.0)):
        system = ShaftSystem(line, seats, drive, loads=LOAD)
        found = solve_system(system)
        traced = jax.jit(lambda s: solve_system(s, throw=False))(system)
        assert int(found.result) == int(traced.result) == 0
        assert int(found.steps) == int(traced.steps)
        for (path, a), b in zip(
            jax.tree_util.tree_leaves_with_path(found),
            jax.tree.leaves(traced),
            strict=True,
        ):
            a, b, name = np.asarray(a), np.asarray(b), jax.tree_util.keystr(path)
            size = SOLVER * np.abs(b).max(initial=0.0) + 1e-16
            if name != ".residual":
                np.testing.assert_allclose(a, b, 0, size, err_msg=name)


def test_offset_of_a_turned_bearing():
    """What heat moves along the shaft is against the z of a bearing turned round; its
    own offset is in its axes, and so is that of the support by which it is solved."""
    for turned, along in ((False, 5e-6), (True, -1e-6)):
        seat = own("A", 0.02, 8, turned=turned, axial_offset=2e-6)
        offset = offset_of(seat, jnp.asarray(3e-6))
        np.testing.assert_allclose(offset, [0, 0, along, 0, 0], rtol=ROUNDING)
        system = ShaftSystem(ShaftLine("s", [0.4], [0.04]), [seat])
        (support,) = supports_of(system, np.zeros(1), np.array([3e-6]))
        assert isinstance(support, BearingSupport)
        np.testing.assert_allclose(support.offset, offset, rtol=ROUNDING)
        assert bool(support.turned) is turned


def test_known_system_in_a_traced_function():
    """It is solved as one program there: no bearing can be called by itself."""
    line = ShaftLine("s", [0.4], [0.04])
    seats = [own("A", 0.02, 8, preload=100.0), own("B", 0.36, 8, turned=True)]
    system = ShaftSystem(line, seats, loads=LOAD[:1])
    wanted = solve_system(system)
    found = jax.jit(lambda x: x * solve_system(system, throw=False).load)(2.0)
    np.testing.assert_allclose(found, 2.0 * wanted.load, rtol=SOLVER, atol=1e-6)


def test_another_system_compiles_no_bearing(monkeypatch):
    """With a bearing turned round, another load and other sizes of bearings."""
    traces, describe = [], load_result.describe
    monkeypatch.setattr(
        load_result, "describe", lambda *args: traces.append(1) or describe(*args)
    )
    line = ShaftLine("s", [0.4], [0.04])
    solve_system(ShaftSystem(line, [own("A", 0.02, 8), own("B", 0.36, 9)], loads=LOAD))
    # Unless a test before this one solved such a bearing already.
    before = len(traces)
    assert before <= 1
    seats = [own("A", 0.05, 7, turned=True), own("B", 0.2, 9), own("C", 0.36, 8)]
    found = solve_system(ShaftSystem(line, seats, loads=LOAD[:1]))
    assert found.load.shape == (3, 6) and len(traces) == before
    # Another kind is another program.
    other = bj.Installed(
        bj.BearingElement(bj.CylindricalRollerBearing(9, 0.065, 0.01, 0.011))
    )
    seats = [*seats[:2], Seat("N", "s", 0.3, other)]
    solve_system(ShaftSystem(line, seats, loads=LOAD[:1]))
    assert len(traces) == before + 1


def test_change_of_a_state_with_that_of_its_bearings():
    """Loads by the axial offset of a bearing turned round equal central differences."""
    line = ShaftLine("s", [0.4], [0.04])

    def system_at(offset):
        seats = [own("A", 0.02, 8), own("B", 0.36, 8, turned=True, axial_offset=offset)]
        return ShaftSystem(line, seats, loads=LOAD[:1])

    def load_at(offset):
        return np.asarray(solve_system(system_at(offset)).load)

    place, step = 3e-5, 1e-8
    end = search_known(system_at(place))
    still = jax.tree.map(lambda _: None, end.bare)
    seats = still.seats[0], with_fields(still.seats[1], axial_offset=np.ones(1))
    change = with_zeros(end.bare, with_fields(still, seats=seats), 1)
    _, moved = _state_with_changes(
        end.bare, end.found, (change, np.zeros((1, 2, 5)))
    )  # fmt: skip
    wanted = (load_at(place + step) - load_at(place - step)) / (2 * step)
    size = np.abs(wanted).max()
    np.testing.assert_allclose(moved["load"][0], wanted, atol=DIFFERENCE * size)


def own(name, position, count, **more):
    """Seat of a bearing with shoulders of known height."""
    bearing = bj.DeepGrooveBallBearing(
        count, 0.065, 0.015081, outer_osculation=0.53, inner_osculation=0.52,
        radial_internal_clearance=1e-5, outer_shoulder=3e-3, inner_shoulder=3e-3,
    )  # fmt: skip
    return Seat(name, "s", position, bj.Installed(bj.BearingElement(bearing)), **more)

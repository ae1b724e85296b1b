"""Forces of gears and belts, speeds and torques of the shafts that they couple."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from systems import springs, stage

from bearingjax.shafts import (
    Coupling,
    Drive,
    Gear,
    Pulley,
    ShaftDesign,
    ShaftLine,
    ShaftLoad,
    ShaftSystem,
    power_flow,
    solve_duty,
    solve_system,
)

RPM = np.pi / 30.0
MEAN = 49.39342e-3
"""Mean radius of the bevel gear of the published example [m]."""


def published(rigid=True):
    """First shaft of example 3 of pygritbx (Politecnico di Torino)."""
    wheels = [
        Gear("G2", "A1", 0.0435, 24, 4e-3, np.deg2rad(21.0), "right",
             mesh_angle=-np.pi / 2),
        Gear("G3", "A1", 0.2785, 24, 2 * MEAN / 24, mesh_angle=-np.pi / 2,
             pitch_angle=np.pi / 4, apex="+z"),
    ]  # fmt: skip
    return ShaftSystem(
        ShaftLine("A1", [0.3], [0.05], rigid=rigid),
        [springs("A", "A1", 0.151), springs("B", "A1", 0.214)],
        Drive("G2", -750.0 * 32 / 24 * RPM, power=15e3),
        wheels,
    )


def pair(gear=None, far=None, **axis):
    """Two shafts on springs with a pair of gears."""
    gear = {"helix_angle": 0.3, **(gear or {})}
    hands = ("right", "left") if gear["helix_angle"] else ("none", "none")
    one = Gear("one", "a", 0.1, 20, 3e-3, hand=hands[0], **gear)
    other = Gear("two", "b", 0.1, 37, 3e-3, hand=hands[1], mates_with="one",
                 **{**gear, **(far or {})})  # fmt: skip
    shafts = [ShaftLine("a", [0.2], [0.03]), ShaftLine("b", [0.2], [0.03], **axis)]
    seats = [springs(f"{s}{k}", s, z) for s in "ab" for k, z in enumerate((0.02, 0.18))]
    return ShaftSystem(shafts, seats, Drive("a", 100.0, torque=50.0), [one, other])


CONE = np.arctan(20.0 / 37.0)
BEVEL = {"pitch_angle": CONE, "apex": "+z"}
BACK = {"pitch_angle": np.pi / 2 - CONE}


@pytest.mark.parametrize(
    "system",
    [
        pair({"helix_angle": 0.0, "mesh_angle": 0.4}, {"mesh_angle": 0.4 - np.pi}),
        pair({"mesh_angle": -2.0}, {"mesh_angle": None}),
        pair({"mesh_angle": 0.4}, {"mesh_angle": None}, axis=(0.0, 0.0, -1.0)),
        pair({**BEVEL, "helix_angle": 0.0}, {**BACK, "apex": "-z"}, axis=(0.6, 0.8, 0)),
        pair(BEVEL, {**BACK, "apex": "+z"}, axis=(0.6, -0.8, 0.0)),
        pair({**BEVEL, "helix_angle": 0.5}, {**BACK, "apex": "-z"}, axis=(-1, 0, 0)),
        stage(),
    ],
)  # fmt: skip
def test_mesh_forces_are_opposite(system):
    """The force on each gear, from its own torque and geometry, is minus that on its
    mate; and power comes out."""
    flow = power_flow(system)
    one, other = flow.meshes
    size = float(np.abs(np.asarray(one.force)).max())
    np.testing.assert_allclose(one.force, -np.asarray(other.force), atol=1e-9 * size)
    assert abs(float(flow.loss)) < 1e-9
    drive = float(flow.drive * flow.speed[0])
    np.testing.assert_allclose(-flow.output * flow.speed[1], drive, rtol=1e-12)
    # The teeth move along with each other: the normal force does no work.
    names = [shaft.name for shaft in system.shafts]
    speeds = []
    for mesh in (one, other):
        k = names.index(system.wheel(mesh.wheel).shaft)
        axis = np.asarray(system.shafts[k].frame[2])
        speeds.append(float(flow.speed[k]) * np.cross(axis, mesh.place))
    work = np.dot(np.asarray(one.force), speeds[0] - speeds[1])
    assert abs(work) < 1e-9 * size


def test_forces_of_a_textbook_pinion():
    """Ft = T/r, Fr = Ft tan α/cos β, Fa = Ft tan β, and their senses: a right-hand
    pinion that drives in the positive sense is pressed along +z."""
    system = pair({"mesh_angle": 0.0, "helix_angle": 0.3}, {"mesh_angle": None})
    mesh = power_flow(system).meshes[1]
    radius = 0.5 * 20 * 3e-3 / np.cos(0.3)
    tangential = 50.0 / radius
    wanted = [
        -tangential * np.tan(np.deg2rad(20.0)) / np.cos(0.3),
        -tangential,
        tangential * np.tan(0.3),
    ]
    assert mesh.wheel == "one"
    np.testing.assert_allclose(mesh.force, wanted, rtol=1e-12)


def test_working_pitch_circles():
    """Gears apart by more than their pitch circles work on larger ones, with a larger
    pressure angle: the normal force is the torque over the base circle."""
    system = stage()
    wider = np.asarray(system.shafts[1].origin) * np.array([1.01, 1.01, 1.0])
    lines = [system.shafts[0], ShaftLine("out", [0.3], [0.06], origin=wider)]
    system = ShaftSystem(lines, system.seats, system.drive, system.wheels)
    flow = power_flow(system)
    mesh = flow.meshes[1]
    force, gear = np.asarray(mesh.force), system.wheels[0]
    distance = np.linalg.norm(wider[:2])
    radius = distance * 23 / 91
    np.testing.assert_allclose(np.linalg.norm(mesh.place), radius, rtol=1e-12)
    across = force[:2]
    assert isinstance(gear, Gear)
    base = float(gear.base_radius)
    np.testing.assert_allclose(np.linalg.norm(across), abs(float(mesh.torque)) / base)
    lead = np.tan(np.deg2rad(15.0)) / float(gear.radius)
    np.testing.assert_allclose(force[2], abs(float(mesh.torque)) * lead, rtol=1e-12)
    with pytest.raises(ValueError, match="mm apart, their pitch circles touch at"):
        far = ShaftLine("out", [0.3], [0.06], origin=wider * 1.2)
        ShaftSystem([system.shafts[0], far], system.seats, system.drive, system.wheels)


@pytest.mark.parametrize(
    "change",
    [{"normal_module": 4.5e-3}, {"pressure_angle": 0.4}, {"helix_angle": 0.2}]
    + [{"hand": "right"}],
)
def test_mesh_of_unlike_gears_is_rejected(change):
    system = stage()
    pinion, wheel = system.wheels
    other = dataclasses.replace(wheel, **change)
    (name,) = change
    with pytest.raises(ValueError, match=f"`{name}` is .* of wheel and .* of pinion"):
        ShaftSystem(system.shafts, system.seats, system.drive, [pinion, other])


def test_losses():
    """What a mesh loses is missing at the output, whichever wheel names the other."""
    for first in ("one", "two"):
        system = pair({"mesh_angle": 0.3}, {"mesh_angle": None})
        one, two = system.wheels
        if first == "two":
            gear = {"helix_angle": 0.3, "efficiency": 0.97}
            one = Gear(
                "one", "a", 0.1, 20, 3e-3, hand="right", mates_with="two", **gear
            )
            two = Gear("two", "b", 0.1, 37, 3e-3, hand="left", mesh_angle=0.3,
                       helix_angle=0.3)  # fmt: skip
        else:
            two = Gear("two", "b", 0.1, 37, 3e-3, 0.3, "left", mates_with="one",
                       efficiency=0.97)  # fmt: skip
        system = ShaftSystem(system.shafts, system.seats, system.drive, [one, two])
        flow = power_flow(system)
        np.testing.assert_allclose(flow.loss, 0.03 * 5000.0, rtol=1e-12)
        out = -float(flow.output * flow.speed[1])
        np.testing.assert_allclose(out, 0.97 * 5000.0, rtol=1e-12)
        # One force acts on both, that of the torque which drives.
        forces = {m.wheel: np.asarray(m.force) for m in flow.meshes}
        np.testing.assert_allclose(forces["one"], -forces["two"], rtol=1e-12)
        along = np.cross([0.0, 0.0, 1.0], [np.cos(0.3), np.sin(0.3), 0.0])
        tangential = abs(forces["one"] @ along)
        np.testing.assert_allclose(tangential, 50.0 / one.radius, rtol=1e-12)
        # A brake in place of the drive takes what the mesh leaves of the power that
        # comes from the other shaft.
        for speed in (100.0, -100.0):
            brake = Drive("a", speed, power=-5000.0)
            braked = ShaftSystem(system.shafts, system.seats, brake, [one, two])
            flow = power_flow(braked)
            given = 5000.0 / 0.97
            np.testing.assert_allclose(flow.output * flow.speed[1], given, rtol=1e-12)
            np.testing.assert_allclose(flow.loss, given - 5000.0, rtol=1e-12)


def test_derivative_by_efficiency():
    """At the default, no loss, the force of the driver's power P follows from it alone,
    and that of a power P taken by a brake is P / eta."""
    system = pair({"mesh_angle": 0.3}, {"mesh_angle": None})

    def force(efficiency, power):
        drive = Drive("a", 100.0, power=power)
        every = eqx.tree_at(lambda s: s.wheels[0].efficiency, system, efficiency)
        every = eqx.tree_at(lambda s: s.drive, every, drive)
        return jnp.linalg.norm(power_flow(every).meshes[0].force)

    for power, exponent in ((5000.0, 0.0), (-5000.0, -1.0)):
        value, slope = jax.value_and_grad(force)(1.0, power)
        np.testing.assert_allclose(slope, exponent * value, atol=1e-9 * value)


def test_idler_and_belt():
    """Three shafts in a row: the idler turns the other way, carries both meshes, and no
    torque; a belt keeps the sense and pulls each shaft to the other."""
    lines = [
        ShaftLine("a", [0.2], [0.03], origin=(0.0, 0.0, 0.0)),
        ShaftLine("b", [0.2], [0.03], origin=(0.06, 0.0, 0.0)),
        ShaftLine("c", [0.2], [0.03], origin=(0.12, 0.0, 0.0)),
        ShaftLine("d", [0.2], [0.03], origin=(0.12, 0.5, 0.0)),
    ]
    seats = [
        springs(f"{s}{k}", s, z) for s in "abcd" for k, z in enumerate((0.02, 0.18))
    ]
    wheels = [
        Gear("1", "a", 0.1, 20, 3e-3),
        Gear("2", "b", 0.1, 20, 3e-3, mates_with="1"),
        Gear("3", "c", 0.1, 20, 3e-3, mates_with="2"),
        Pulley("4", "c", 0.15, 0.1, 2.0),
        Pulley("5", "d", 0.15, 0.2, 2.0, mates_with="4"),
    ]
    system = ShaftSystem(lines, seats, Drive("a", 50.0, torque=30.0), wheels)
    flow = power_flow(system)
    np.testing.assert_allclose(flow.speed, [50.0, -50.0, 50.0, 25.0], rtol=1e-14)
    np.testing.assert_allclose(flow.output, -60.0, rtol=1e-12)
    assert flow.output_shaft == "d"
    total = sum(np.asarray(m.force) for m in flow.meshes if m.wheel == "2")
    np.testing.assert_allclose(total, [0.0, 2 * 30.0 / 0.03, 0.0], atol=1e-9)
    pulls = {m.wheel: np.asarray(m.force) for m in flow.meshes if m.wheel in "45"}
    np.testing.assert_allclose(pulls["4"], [0.0, 2.0 * 30.0 / 0.05, 0.0], atol=1e-9)
    np.testing.assert_allclose(pulls["5"], -pulls["4"], atol=1e-9)
    # Each mesh of the idler has a misalignment; belts have none.
    found = ShaftDesign(system, (None,) * 8).readings()
    places = {n: one.entry for n, one in found.items() if "misalignment" in n}
    meshes = [(mesh.wheel, mesh.mate) for mesh in flow.meshes]
    assert places == {
        "1.misalignment": meshes.index(("1", "2")),
        "2.misalignment_1": meshes.index(("2", "1")),
        "2.misalignment_3": meshes.index(("2", "3")),
        "3.misalignment": meshes.index(("3", "2")),
    }


def test_free_loads_count_in_the_balance():
    system = pair({"mesh_angle": 0.3}, {"mesh_angle": None})
    brake = ShaftLoad("brake", "b", 0.05, moment=(0.0, 0.0, 7.0))
    loaded = ShaftSystem(
        system.shafts, system.seats, system.drive, system.wheels, loads=brake
    )
    out = [power_flow(s).output for s in (system, loaded)]
    np.testing.assert_allclose(out[1], out[0] - 7.0, rtol=1e-12)


def moved(wheel, **numbers):
    """The wheel with other numbers."""
    return dataclasses.replace(wheel, **numbers)


def fork(*outputs, speed=50.0):
    lines = [ShaftLine(s, [0.2], [0.03]) for s in "abc"]
    seats = [
        springs(f"{s}{k}", s, z) for s in "abc" for k, z in enumerate((0.02, 0.18))
    ]
    wheels = [
        Gear("1", "a", 0.1, 20, 3e-3, mesh_angle=0.0),
        Gear("2", "b", 0.1, 20, 3e-3, mates_with="1"),
        Gear("3", "c", 0.1, 20, 3e-3, mates_with="1", mesh_angle=0.0),
    ]
    drive = Drive("a", speed, torque=30.0)
    return ShaftSystem(lines, seats, drive, wheels, couplings=outputs)


def test_power_flow_with_two_outputs():
    """One of two outputs follows from the other."""
    with pytest.raises(ValueError, match="may leave by the shafts b, c"):
        power_flow(fork())
    flow = power_flow(fork(Coupling("x", "b", power=-500.0), Coupling("y", "c")))
    np.testing.assert_allclose(flow.coupling, [10.0, 20.0], rtol=1e-12)
    flow = power_flow(fork(Coupling("x", "b", power=-500.0)))
    assert flow.output_shaft == "c"
    np.testing.assert_allclose(flow.output, 20.0, rtol=1e-12)
    with pytest.raises(ValueError, match="torques of x, y are not given"):
        power_flow(fork(Coupling("x", "b"), Coupling("y", "c")))


def test_solve_system_rejects_unbalanced_torques():
    system = published()
    wheel = Gear("G3", "A1", 0.2785, 24, 4e-3, mesh_angle=0.0, torque=100.0)
    wrong = ShaftSystem(system.shafts, system.seats, system.drive,
                        [system.wheels[0], wheel])  # fmt: skip
    with pytest.raises(
        ValueError, match="do not balance: 43.239. N m are left on shaft"
    ):
        solve_system(wrong)


@pytest.mark.slow
def test_torques_of_every_case_balance():
    system = published()

    def case(torque):
        wheel = Gear("G3", "A1", 0.2785, 24, 4e-3, mesh_angle=0.0, torque=torque)
        drive = Drive("G2", -104.0, torque=-140.0)
        wheels = [system.wheels[0], wheel]
        return ShaftSystem(system.shafts, system.seats, drive, wheels)

    given = [(None, None)] * 2
    solve_duty([case(140.0), case(140.0)], given)
    with pytest.raises(ValueError, match=r"do not balance: 40 N m .* \(case 1\)"):
        solve_duty([case(140.0), case(100.0)], given)


def test_torque_has_derivatives():
    def force(power):
        system = published()
        drive = Drive("G2", system.drive.speed, power=power)
        return (
            power_flow(ShaftSystem(system.shafts, system.seats, drive, system.wheels))
            .meshes[0]
            .force
        )

    slope = jax.jacfwd(force)(15e3)
    np.testing.assert_allclose(slope, np.asarray(force(15e3)) / 15e3, rtol=1e-12)


def couple(system):
    """Force and moment about the origin of all meshes, in global axes."""
    force, moment = np.zeros(3), np.zeros(3)
    for mesh in power_flow(system).meshes:
        wheel = system.wheel(mesh.wheel)
        shaft = system.shaft(wheel.shaft)
        centre = np.asarray(shaft.origin) + float(wheel.position) * shaft.frame[2]
        force = force + np.asarray(mesh.force)
        moment = moment + np.cross(np.asarray(centre) + mesh.place, mesh.force)
    return force, moment


def in_space(one, other, **axis):
    lines = [ShaftLine("a", [0.2], [0.03], origin=(0.0, 0.0, 0.0)),
             ShaftLine("b", [0.2], [0.03], **axis)]  # fmt: skip
    seats = [springs(f"{s}{k}", s, z) for s in "ab" for k, z in enumerate((0.02, 0.18))]
    return ShaftSystem(lines, seats, Drive("a", 100.0, torque=50.0), [one, other])


ONE, TWO = Gear("1", "a", 0.1, 20, 3e-3), Gear("2", "b", 0.1, 40, 3e-3, mates_with="1")
PLACE = {"origin": (0.09, 0.0, 0.0)}
FACES = {"face_width": 0.04}, {"face_width": 0.03}


@pytest.mark.parametrize(
    "system, middle",
    [
        (in_space(ONE, moved(TWO, position=0.104), **PLACE), 0.102),
        (in_space(moved(ONE, **FACES[0]), moved(TWO, position=0.104, **FACES[1]),
                  **PLACE), 0.104),
        (in_space(moved(ONE, **FACES[0]), moved(TWO, position=0.11, **FACES[1]),
                  **PLACE), 0.1075),
    ],
)  # fmt: skip
def test_wheels_out_of_plane_act_in_one_point(system, middle):
    """The force of a mesh acts in the middle of the common part of both faces, so that
    action and reaction leave no couple."""
    force, moment = couple(system)
    assert np.abs(force).max() < 1e-9 and np.abs(moment).max() < 1e-9
    for mesh in power_flow(system).meshes:
        wheel = system.wheel(mesh.wheel)
        np.testing.assert_allclose(float(wheel.position) + mesh.place[2], middle)


def test_belts_out_of_plane_and_bevel_gears_leave_no_couple():
    pulleys = Pulley("1", "a", 0.1, 0.1, 2.0), Pulley("2", "b", 0.11, 0.2, 2.0,
                                                      mates_with="1")  # fmt: skip
    force, moment = couple(in_space(*pulleys, origin=(0.5, 0.0, 0.0)))
    assert np.abs(force).max() < 1e-9 and np.abs(moment).max() < 1e-9
    bevel = {"pitch_angle": np.pi / 4, "apex": "+z"}
    gears = (
        Gear("1", "a", 0.1, 20, 3e-3, **bevel),
        Gear("2", "b", 0.1, 20, 3e-3, mates_with="1", **bevel),
    )
    at = {"axis": (-1.0, 0.0, 0.0), "origin": (0.13, 0.0, 0.13)}
    force, moment = couple(in_space(*gears, **at))
    assert np.abs(force).max() < 1e-9 and np.abs(moment).max() < 1e-9
    with pytest.raises(ValueError, match="have apexes that are 10 mm"):
        in_space(*gears, **{**at, "origin": (0.13, 0.0, 0.14)})


@pytest.mark.parametrize(
    "wrong, told",
    [
        (lambda: in_space(moved(ONE, mesh_angle=0.1), TWO, **PLACE),
         "of 1 is 5.7.* deg; by the places of the shafts it meshes at 0 deg"),
        (lambda: in_space(moved(ONE, mesh_angle=0.0), moved(TWO, mesh_angle=0.0)),
         "of 1 is 0 deg; by that of 2 it meshes at -?180 deg"),
        (lambda: in_space(moved(ONE, torque=3.0), TWO, **PLACE),
         "1 has a mate, from which its torque follows"),
        (lambda: in_space(ONE, moved(TWO, position=0.11), **PLACE),
         "2 and 1 are 10 mm apart along"),
        (lambda: in_space(moved(ONE, **FACES[0]), moved(TWO, position=0.136,
                          **FACES[1]), **PLACE), "faces of 2 and 1 do not overlap"),
        (lambda: in_space(Pulley("1", "a", 0.1, 0.1, 2.0),
                          Pulley("2", "b", 0.15, 0.2, 2.0, mates_with="1"),
                          origin=(0.5, 0.0, 0.0)), "share a belt, are in one plane"),
        (lambda: fork(Coupling("x", "b", power=-5.0), speed=0.0),
         "`power` of x needs a `speed` of the drive"),
    ],
)  # fmt: skip
def test_contradicting_wheels_are_refused(wrong, told):
    with pytest.raises(ValueError, match=told):
        wrong()


def test_mates_may_name_each_other():
    """A pair that is named from both sides is one mesh."""
    both = in_space(moved(ONE, mates_with="2"), TWO, **PLACE)
    flow, wanted = power_flow(both), power_flow(in_space(ONE, TWO, **PLACE))
    assert len(flow.meshes) == 2
    np.testing.assert_allclose(flow.speed, wanted.speed)
    forces = {mesh.wheel: mesh.force for mesh in flow.meshes}
    for mesh in wanted.meshes:
        np.testing.assert_allclose(forces[mesh.wheel], mesh.force, atol=1e-9)


def test_angle_of_a_sun_is_not_that_of_two_planets():
    planets = [ShaftLine(name, [0.2], [0.03]) for name in "abc"]
    seats = [
        springs(f"{s}{k}", s, z) for s in "abc" for k, z in enumerate((0.02, 0.18))
    ]
    wheels = [
        Gear("sun", "a", 0.1, 20, 3e-3, mesh_angle=0.0),
        Gear("1", "b", 0.1, 20, 3e-3, mates_with="sun"),
        Gear("2", "c", 0.1, 20, 3e-3, mates_with="sun"),
    ]
    drive = Drive("a", 50.0, torque=30.0)
    with pytest.raises(ValueError, match="that of its meshes with 1 and 2; give"):
        ShaftSystem(planets, seats, drive, wheels)


def test_idle_machine_has_no_torque_of_its_power():
    """A case of no power may stand."""
    system = in_space(ONE, TWO, **PLACE)
    still = Drive("a", 0.0, power=0.0)
    flow = power_flow(ShaftSystem(system.shafts, system.seats, still, system.wheels))
    np.testing.assert_array_equal(flow.drive, 0.0)
    np.testing.assert_array_equal(flow.meshes[0].force, 0.0)

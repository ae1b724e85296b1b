"""The adapter against ROSS itself: its frame, its tables, a rotor that it solves.

ROSS asks for a folder without shared libraries as working folder: its dependency
ccp-performance takes any it finds there for REFPROP, and warns if there is none.
"""

import warnings

import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj

ELEMENT = bj.BearingElement(balls(8), raceway_control=bj.element.CentrifugalOnly())
SPEEDS = np.linspace(0.0, 1500.0, 5)
LOAD = np.array([200.0, -600.0, 900.0, 0.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def ross():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip("ross", exc_type=ModuleNotFoundError)


@pytest.fixture(scope="module")
def bearings(ross):
    return [
        bj.rotor.to_ross(ELEMENT, n, SPEEDS, LOAD, damping=150.0, tag=f"at {n}")
        for n in (0, 4)
    ]


@pytest.fixture(scope="module")
def shaft(ross):
    steel = ross.Material("steel", rho=7850, E=206e9, G_s=79e9)
    parts = [ross.ShaftElement(0.1, 0, 0.025, material=steel) for _ in range(4)]
    return parts, [ross.DiskElement.from_geometry(2, steel, 0.04, 0.025, 0.2)]


def test_ross_frame_conventions(ross, bearings, shaft):
    """Freedoms, right-handed tilts, sense of rotation, weight."""
    shafts, disks = shaft
    order = ("x", "y", "z", "alpha", "beta", "theta")
    mapping = disks[0].dof_mapping()
    assert [mapping[f"{name}_0"] for name in order] == list(range(6))
    assert bearings[0].dof_mapping() == {"x_0": 0, "y_0": 1, "z_0": 2}
    # Nodes follow each other along +z: turned rigidly by (gx, gy) about the first
    # node, the second moves by g x (0, 0, L), and the shaft feels nothing.
    for tilt in np.eye(3)[:2]:
        moved = np.cross(tilt, [0.0, 0.0, 0.1])
        q = np.concatenate([np.zeros(3), tilt, moved, tilt])
        k = shafts[0].K()
        assert abs(k @ q).max() < ROUNDING * abs(k).max()
    # A disc with spin H = (0, 0, Ip) along its own axis (gy, -gx, 1):
    # dH/dt = Ip (rate of gy, -rate of gx) is what turns it at unit speed.
    gyroscopic = disks[0].G()
    rate = np.array([0, 0, 0, 0.3, 0.7, 0])
    expected = disks[0].Ip * np.array([0, 0, 0, 0.7, -0.3, 0])
    np.testing.assert_allclose(gyroscopic @ rate, expected, rtol=ROUNDING)
    # Unbalance turns from x towards y; weight pulls along -y.
    rotor = ross.Rotor(shafts, disks, bearings)
    force = rotor._unbalance_force(2, 1.0, 0.0, [1.0])[12:15, 0]
    quarter = (force * np.exp(0.5j * np.pi)).real
    np.testing.assert_allclose(force.real, [1, 0, 0], atol=ROUNDING)
    np.testing.assert_allclose(quarter, [0, 1, 0], atol=ROUNDING)
    weight = rotor.gravitational_force().reshape(-1, 6).sum(axis=0)
    np.testing.assert_allclose(weight[1], -9.8065 * rotor.m, rtol=DIFFERENCE)


def test_to_ross_matrices_match_stiffness_table(bearings):
    table = np.asarray(bj.rotor.stiffness_table(ELEMENT, SPEEDS, LOAD))
    assert abs(table[:, 0, 1]).max() > 1e-3 * table.max()
    for speed, k in zip(SPEEDS, table, strict=True):
        expected = k.copy()
        expected[:2, 2] = expected[2, :2] = 0.0
        # ROSS smooths its splines to one newton per metre.
        np.testing.assert_allclose(bearings[0].K(speed), expected, atol=5.0)
        np.testing.assert_allclose(
            bearings[0].C(speed), 150.0 * np.eye(3), atol=DIFFERENCE
        )


def test_to_ross_rotor_modes(ross, bearings, shaft):
    """Modes of the rotor from our stiffness put into ROSS's shaft by hand."""
    rotor = ross.Rotor(*shaft, bearings)
    speed = SPEEDS[2]
    k = np.asarray(bj.rotor.stiffness_table(ELEMENT, [speed], LOAD))[0]
    bare = ross.Rotor(*shaft, [ross.BearingElement(0, kxx=0.0, cxx=0.0)])
    stiffness, damping = np.array(bare.K(speed)), np.array(bare.C(speed))
    for node in (0, 4):
        at = slice(6 * node, 6 * node + 2)
        stiffness[at, at] += k[:2, :2]
        stiffness[6 * node + 2, 6 * node + 2] += k[2, 2]
        damping[6 * node : 6 * node + 3, 6 * node : 6 * node + 3] += 150.0 * np.eye(3)
    mass, gyroscopic = bare.M(speed), bare.G() * speed
    size = mass.shape[0]
    state = np.block(
        [
            [np.zeros((size, size)), np.eye(size)],
            [
                -np.linalg.solve(mass, stiffness),
                -np.linalg.solve(mass, damping + gyroscopic),
            ],
        ]
    )
    ours = np.sort(abs(np.linalg.eigvals(state).imag))
    theirs = np.sort(abs(np.linalg.eigvals(rotor.A(speed)).imag))
    lowest = ours[ours > 10.0][:8]
    np.testing.assert_allclose(theirs[theirs > 10.0][:8], lowest, rtol=DIFFERENCE)

"""What plots of rotors draw: sizes, lines, names and units, not pixels."""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax import plot
from bearingjax.plot.rotors.rotor import disc_size
from bearingjax.rotor import CriticalSpeeds, Modes
from bearingjax.rotor.nonlinear import (
    Branch,
    BranchEnd,
    Event,
    Waterfall,
    envelope,
    spectra_over_time,
    steady_spectra,
)

STEEL = bj.Material(211e9, 0.3, 7810.0)
SHAFT = bj.rotor.Shaft(
    [0.0, 0.1, 0.3, 0.5], [0.05, 0.07, 0.06], [0.0, 0.02, 0.0], STEEL
)
MM, UM, RPM = 1e3, 1e6, 30.0 / np.pi


def named(ax, label):
    """Data of the lines of a label."""
    return [np.asarray(x.get_xydata()) for x in ax.lines if x.get_label() == label]


def patches(ax, label):
    """Corners of what is filled, least and largest."""
    found = [p for p in ax.patches if p.get_label() == label]
    corners = [p.get_transform().transform(p.get_path().vertices) for p in found]
    inverse = ax.transData.inverted()
    return [(inverse.transform(c).min(0), inverse.transform(c).max(0)) for c in corners]


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def rotor_on_bearings():
    angular = bj.AngularContactBallBearing(
        7, 0.07, 0.012, contact_angle=0.5, outer_osculation=0.52, inner_osculation=0.52
    )
    rollers = bj.CylindricalRollerBearing(7, 0.075, 0.01, 0.01)
    a, b = bj.BearingElement(angular), bj.BearingElement(rollers)
    housing = bj.rotor.Housing(2.0, [1e8, 1e8, 1e8])
    return bj.rotor.Rotor(
        SHAFT,
        [bj.rotor.Disc.of_size(2, 0.3, 0.04, 0.07, STEEL), bj.rotor.PointMass(1, 0.5)],
        [
            bj.rotor.BearingSupport(0, a),
            bj.rotor.BearingSupport(0, a, turned=True),
            bj.rotor.BearingSupport(3, b, housing=housing),
            bj.rotor.LinearSupport.isotropic(1, 1e7),
        ],
    )


def test_a_rotor_is_drawn_to_scale():
    ax = plot.rotor_section(rotor_on_bearings())
    assert ax.get_xlabel() == "z [mm]" and ax.get_aspect() == 1.0
    # Two solid segments, one of two walls.
    segments = patches(ax, "_segment")
    assert len(segments) == 4
    assert np.allclose(segments[0][0], [0.0, -25.0]), segments[0]
    assert np.allclose(segments[1][1], [300.0, 35.0]), segments[1]
    assert np.allclose(segments[1][0], [100.0, 10.0]), segments[1]
    upper, lower = patches(ax, "_disc")
    assert np.allclose(upper, [[280.0, 35.0], [320.0, 150.0]])
    assert np.allclose(lower, [[280.0, -150.0], [320.0, -35.0]])
    ((low, high),) = patches(ax, "_mass")
    volume = np.pi / 6.0 * (1e-3 * (high[0] - low[0])) ** 3
    assert abs(volume * 7810.0 - 0.5) < 1e-3  # its outline is made of curves
    assert len(patches(ax, "_housing")) == 1
    # Springs of the housing and of the linear support, ground below everything.
    assert len(named(ax, "_spring")) == 2 and len(named(ax, "_ground")) == 4


def test_lines_of_action_tell_how_a_bearing_is_mounted():
    lines = named(plot.rotor_section(rotor_on_bearings()), "_line of action")
    feet = sorted({round(float(line[1, 0]), 6) for line in lines})
    away = 35.0 * np.tan(0.5)
    assert np.allclose(feet, [-away, away], atol=1e-5)
    # One that carries an inner-ring load along +z bears from the side of -z.
    assert all(np.isclose(abs(line[0, 1]), 35.0) for line in lines)


@pytest.mark.parametrize("width", [0.02, 0.2])
def test_disc_size_recovers_dimensions(width):
    disc = bj.rotor.Disc.of_size(0, 0.4, width, 0.05, STEEL)
    found = disc_size(disc, 0.05, STEEL)
    assert found is not None
    assert np.allclose(found, [200.0, 25.0, MM * width], rtol=1e3 * ROUNDING)
    # A thin disc, as in the paper: its width follows from its mass.
    thin = disc_size(bj.rotor.Disc(0, 10.0, 0.2, 0.1), 0.025, STEEL)
    assert thin is not None
    solid = 7810.0 * np.pi * 1e-9 * (thin.outer**2 - thin.bore**2) * thin.width
    assert abs(solid / 10.0 - 1.0) < 1e3 * ROUNDING
    assert disc_size(bj.rotor.Disc(0, 10.0, 0.0, 0.0), 0.025, STEEL) is None


def by_hand(x=None, y=None):
    """Four modes of four nodes: backward, forward, axial, one that creeps."""
    across = np.array([0.5, 1.0, -0.25])
    shape = np.zeros((4, 4, 5), complex)
    shape[:2, :3, 0] = across
    shape[0, :3, 1], shape[1, :3, 1] = 1j * across, -1j * across
    shape[2, :, 2] = 1.0
    if x is not None:
        shape[0, :, 0], shape[0, :, 1] = x, y
    value = np.array([-1.0 + 100j, -2.0 + 200j, -3.0 + 300j, -5.0 + 0j])
    return all_modes(value, [-1, 1, 0, 0], shape)


def all_modes(value, whirl, shape):
    housing = np.zeros((*value.shape, 0, 3), complex)
    return Modes(*map(jnp.asarray, (value, whirl, shape, housing)))


def test_mode_shapes_tell_frequency_damping_and_direction():
    rotor = bj.rotor.Rotor(
        SHAFT, [], [bj.rotor.LinearSupport.isotropic(k, 1e7) for k in (0, 2)]
    )
    ax = plot.mode_shapes(rotor, by_hand())
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert names == [
        "15.92 Hz, backward\ndamping 1 %",
        "31.83 Hz, forward\ndamping 1 %",
        "47.75 Hz, axial\ndamping 1 %",
    ]
    (first,) = named(ax, "_mode 0")
    assert np.allclose(first[:, 0], [0.0, 100.0, 300.0, 500.0])
    moved = first[:, 1] - 2.0
    assert np.allclose(np.abs(moved / moved[1]), [0.5, 1.0, 0.25, 0.0])
    assert np.sign(moved[2]) == -np.sign(moved[1])
    assert [len(line) for line in named(ax, "_support")] == [3, 3]


def test_mode_shape_drawn_along_major_axis_of_inclined_orbit():
    turn, size = 0.4, np.array([1.0, 0.5, 0.2, 0.0]) * np.exp(1j)
    along, aside = size, 0.2j * size
    x = along * np.cos(turn) - aside * np.sin(turn)
    y = along * np.sin(turn) + aside * np.cos(turn)
    found = by_hand(x, y)
    rotor = bj.rotor.Rotor(SHAFT)
    (line,) = named(plot.mode_shapes(rotor, found), "_mode 0")
    moved = line[:, 1] - 2.0
    assert np.allclose(np.abs(moved / moved[0]), [1.0, 0.5, 0.2, 0.0])


def test_campbell_diagram_tells_directions_and_critical_speeds():
    speeds = np.linspace(0.0, 300.0, 4)
    values = np.stack([100.0 - 0.1 * speeds, 100.0 + 0.1 * speeds], axis=1)
    whirl = np.array([[0, 0], [-1, 1], [-1, 1], [-1, 1]])
    modes = all_modes(1j * values, whirl, np.zeros((4, 2, 1, 5), complex))
    at = np.array([90.9, 111.1, 120.0, np.nan, 900.0])
    shape = np.zeros((5, 1, 5), complex)
    fields = at, np.array([-1, 1, 1, 0, 1]), np.zeros(5), shape, 0
    critical = CriticalSpeeds(*map(jnp.asarray, fields))
    ax = plot.campbell_diagram(speeds, modes, critical)
    (forward,), (backward,) = named(ax, "forward"), named(ax, "backward")
    assert np.allclose(forward[:, 0], RPM * speeds)
    assert np.allclose(forward[:, 1], values[:, 1] / (2.0 * np.pi))
    assert np.allclose(backward[:, 1], values[:, 0] / (2.0 * np.pi))
    (once,) = named(ax, "speed (1x)")
    assert np.allclose(once[:, 1], once[:, 0] / 60.0)
    marked = np.concatenate(named(ax, "critical speed") + named(ax, "_critical speed"))
    assert np.allclose(marked[:, 0], RPM * at[:3])
    assert [t.get_text() for t in ax.texts] == ["1061 rpm", "1146 rpm"]
    # Points have the colour of their whirl, and that of the legend has none.
    handles, labels = ax.get_legend_handles_labels()
    mark: Any = handles[labels.index("critical speed")]
    assert mark.get_color() == "white"
    assert "planar, axial" not in legend(ax)
    # A mode along the axis has no direction, whatever its trace of whirl.
    axial = all_modes(
        1j * values, whirl, np.eye(5)[[2]] * np.ones((4, 2, 1, 1), complex)
    )
    ax = plot.campbell_diagram(speeds, axial)
    assert legend(ax) == ["planar, axial", "speed (1x)"]


SIZES = 1e-6 * np.arange(2.0, 10.0)


def branch(events=()):
    x = np.arange(8)
    empty = np.zeros((8, 0))
    hertz = np.array([10.0, 11, 12, 13, 12.5, 12, 13, 14])
    return Branch(
        2.0 * np.pi * hertz, 1e-6 * (1.0 + x[:, None]), np.zeros((8, 4, 1)), empty,
        ~np.isin(x, [3, 4]), empty, np.zeros(8), np.zeros(8), events, 0,
        BranchEnd.LIMIT,
    )  # fmt: skip


def test_a_response_tells_stable_from_unstable_and_marks_events():
    events = ("fold", 13.1, 4.3e-6), ("fold", 11.9, 4.5e-6), ("flip", 12.0, 5e-6)
    marks = [
        Event(
            kind, 2.0 * np.pi * f, np.array([a]), np.zeros((2, 1)), np.zeros(2), 3, True
        )
        for kind, f, a in events
    ]
    linear = 2.0 * np.pi * np.array([10.0, 14.0]), np.array([1e-6, 2e-6])
    found = branch(tuple(marks))
    ax = plot.response_curve(found, SIZES, linear=linear)
    assert ax.get_xlabel() == "frequency of the excitation [Hz]"
    assert ax.get_ylabel() == "amplitude [µm]"
    (unstable,) = named(ax, "unstable")
    assert np.allclose(unstable, [[12, 4], [13, 5], [12.5, 6], [12, 7]])
    assert len(named(ax, "stable")) == 1 and len(named(ax, "_stable")) == 1
    assert np.allclose(named(ax, "linear"), [[[10.0, 1.0], [14.0, 2.0]]])
    # Between the points beside it: what is drawn is one more than the freedom here.
    assert np.allclose(named(ax, "fold"), [[[13.1, 5.3]]])
    assert legend(ax) == ["linear", "stable", "unstable", "fold", "flip"]
    tilts = plot.response_curve(branch(), SIZES, unit="mrad")
    assert tilts.get_ylabel() == "amplitude [mrad]"
    with pytest.raises(ValueError, match="'um' or 'mrad'"):
        plot.response_curve(branch(), SIZES, unit="m")


def test_amplitudes_over_speed():
    ax = plot.speed_curve([10.0, 20.0], 1e-6 * np.eye(2), names=("station 1", "b"))
    assert ax.get_xlabel() == "speed [rpm]"
    assert legend(ax) == ["station 1", "b"]
    assert np.allclose(
        named(ax, "b"), [[[RPM * 10.0, 0.0], [RPM * 20.0, 1.0]]], rtol=ROUNDING * 100
    )


def test_amplitude_of_a_run_up():
    time = np.linspace(0.0, 10.0, 40001)
    motion = 2e-6 * np.sin(10.0 * time**2)
    speed, size = envelope(time, 20.0 * time, motion, 40)
    # Every part has a whole revolution, however slow the rotor is.
    assert len(speed) == 40 and np.allclose(size, 2e-6, rtol=1e-3)
    assert 0.0 < speed[0] < speed[-1] < 200.0
    assert len(envelope(time[:3], time[:3], motion[:3])[0]) == 1


PHASE = 2.0 * np.pi * np.arange(8) / 8
CIRCLE = 1e-6 * np.stack([np.cos(PHASE), np.sin(PHASE)], axis=-1)[:, None]


def test_orbits_close_and_show_poincare_points():
    ax = plot.orbits(CIRCLE, names=("station 2",))
    (path,) = named(ax, "station 2")
    assert len(path) == 9 and np.allclose(path[0], path[-1])
    assert np.allclose(named(ax, "_phase 0"), [[[1.0, 0.0]]])
    points = 1e-6 * np.ones((5, 1, 2))
    ax = plot.orbits(CIRCLE, points=points, closed=False)
    assert np.allclose(named(ax, "_phase 0"), np.ones((1, 5, 2)))
    assert len(named(ax, "_station 0")[0]) == 8
    assert ax.get_xlabel() == "x [µm]"


def test_waveforms_over_a_period_and_over_time():
    ax = plot.waveforms(CIRCLE[:, 0], names=("x", "y"))
    (x,) = named(ax, "x")
    assert np.allclose(x[:, 0], np.linspace(0.0, 360.0, 9))
    assert x[-1, 1] == x[0, 1]
    ax = plot.waveforms(CIRCLE[:, 0], time=np.arange(8.0))
    assert ax.get_xlabel() == "time [s]"


def test_spectra_of_a_run_up():
    time = np.linspace(0.0, 4.0, 4000)
    speed = 2.0 * np.pi * (20.0 + 10.0 * time)
    angle = 2.0 * np.pi * (20.0 * time + 5.0 * time**2)
    spectra = spectra_over_time(time, speed, 3e-6 * np.cos(angle), 30)
    peak = spectra.frequency[np.argmax(spectra.amplitude, axis=1)]
    apart = spectra.frequency[1]
    # A line's place is where the speed is, as far as lines lie apart.
    assert np.abs(peak - spectra.speed / (2.0 * np.pi)).max() <= apart
    ax = plot.waterfall(spectra)
    lines = named(ax, "_spectrum")
    assert len(lines) == 30 and ax.get_ylabel() == "speed [rpm]"
    (once,) = named(ax, "_1x")
    assert np.allclose(once[:, 0], once[:, 1] / 60.0)
    steady = Waterfall(
        *map(jnp.asarray, ([100.0, 200.0], [0.0, 1.0], np.ones((2, 2, 1)), [0, 0]))
    )
    lines = named(plot.waterfall(steady_spectra(steady, 0)), "_spectrum")
    # A line at the speed itself, without the mean.
    assert np.allclose(lines[1][:, 0], [100.0 / (2.0 * np.pi)])
    with pytest.raises(ValueError, match="not even"):
        spectra_over_time(time**2, speed, angle)
    with pytest.raises(ValueError, match="too few"):
        spectra_over_time(time[:50], speed[:50], angle[:50])


TASK = SimpleNamespace(station=1, coordinate="uy", speed_to=40.0)
ROTOR = bj.rotor.Rotor(
    SHAFT, [], [bj.rotor.LinearSupport.isotropic(k, 1e7) for k in (0, 2)]
)


def run(**parts):
    """What came of a scene: only the parts that are given."""
    whole = dict.fromkeys("modes critical campbell response transient".split())
    task = SimpleNamespace(campbell=None, response=TASK, transient=TASK)
    return SimpleNamespace(task=task, rotor=ROTOR, **(whole | parts))


def test_rotor_overview_shows_requested_parts():
    page = plot.rotor_overview(run(), "a_$_b")
    assert [ax.get_title() for ax in page.axes] == ["Rotor, to scale"]
    time = np.linspace(0.0, 1.0, 400)
    motion = 1e-6 * np.sin(20.0 * np.pi * time)[:, None, None] * np.ones((1, 4, 5))
    transient = SimpleNamespace(
        time=time, speed=20.0 * time, displacement=motion, n_reached=400
    )
    around = np.zeros((8, 8, 4, 5))
    around[:, :, 1, :2] = CIRCLE[:, 0] * np.arange(1.0, 9.0)[:, None, None]
    sizes = np.ones((8, 4, 5)) * SIZES[:, None, None]
    response = SimpleNamespace(
        frequency=branch().frequency, amplitude=sizes, displacement=around,
        branch=branch(), method="shooting",
    )  # fmt: skip
    page = plot.rotor_overview(
        run(modes=by_hand(), response=response, transient=transient)
    )
    titles = [ax.get_title() for ax in page.axes]
    assert titles[:3] == [
        "Rotor, to scale",
        "Mode shapes",
        "Response of uy at station 1, shooting",
    ]
    assert titles[3] == "Orbits at 14 Hz" and titles[4] == "Waveforms at 14 Hz"
    assert titles[5] == "Waveforms"
    assert titles[6] == "Run-up" and titles[7].startswith("Spectra over the speed")
    orbit = page.axes[3]
    # The largest one, of the station that is shown.
    assert np.allclose(np.abs(named(orbit, "station 1")[0]).max(), 8.0)
    (stable, *_) = named(page.axes[2], "stable")
    assert np.allclose(stable[0], [10.0, 2.0])


def test_a_linear_response_on_the_page():
    response = SimpleNamespace(
        frequency=2.0 * np.pi * np.arange(1.0, 4.0), method="linear", branch=None,
        amplitude=1e-6 * np.ones((3, 4, 5)), displacement=np.zeros((3, 8, 4, 5)),
    )  # fmt: skip
    page = plot.rotor_overview(run(response=response))
    curve = np.asarray(page.axes[1].lines[0].get_xydata())
    assert np.allclose(curve, [[1.0, 1.0], [2.0, 1.0], [3.0, 1.0]])
    assert page.axes[1].get_xlabel() == "frequency of the excitation [Hz]"

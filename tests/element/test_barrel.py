"""Barrel rollers against closed forms and brute force (`barrel_oracle`).

Numbers of independent programs are validation cases: `srb_*`, `toroidal_exact_arcs`.
"""

import dataclasses

import barrel_oracle
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import (
    DIFFERENCE,
    QUADRATURE_FORCE,
    QUADRATURE_STIFFNESS,
    ROUNDING,
    SOLVER,
)

import bearingjax as bj
from bearingjax.contact import LineContact
from bearingjax.contact.halfspace import RollerContact
from bearingjax.contact.line_contact import response
from bearingjax.contact.slices import slices
from bearingjax.element.constants import contact_constants
from bearingjax.element.inertia import inertia_force, mass_and_inertia
from bearingjax.statics.warning_sizes import travel_error

DEG = np.pi / 180
LAW = bj.contact.LineConstant(3.6e10)


def spherical(n=8, **change):
    values = dict(
        contact_angle=0.17,
        roller_profile_radius=0.0745,
        inner_raceway_radius=0.0767,
        radial_internal_clearance=20e-6,
        first_azimuth=0.3,
    )
    return bj.SphericalRollerRow(n, 0.13, 0.0215, 0.0185, **(values | change))


def toroidal(n=7, **change):
    values = dict(
        roller_profile_radius=0.4074,
        outer_raceway_radius=0.42,
        inner_raceway_radius=0.42,
        radial_internal_clearance=40e-6,
        first_azimuth=-90 * DEG,
    )
    return bj.ToroidalRollerBearing(n, 0.140, 0.0195, 0.030, **(values | change))


def spherical_thrust(n=6, **change):
    values = dict(
        contact_angle=0.87,
        roller_profile_radius=0.10,
        inner_raceway_radius=0.104,
        profile_offset=2e-3,
        ribs=bj.Ribs(inner_minus=bj.Rib(0.2, 2e-3)),
    )
    return bj.SphericalThrustRollerBearing(n, 0.12, 0.022, 0.026, **(values | change))


KINDS = {"spherical": spherical, "toroidal": toroidal, "thrust": spherical_thrust}
KINEMATICS = {"linearised": bj.element.Linearised(), "exact": bj.element.Finite()}


def element(bearing, kinematics="exact", **choices):
    return bj.BearingElement(bearing, kinematics=KINEMATICS[kinematics], **choices)


@eqx.filter_jit
def evaluate(element, q, speed=None):
    model = element.model(speed)
    solved = model.solve(q)
    return model.evaluate(q, solved), model.results(q, solved)


def oracle_of(bearing):
    """Return the row in plain numbers; `test_rib_contact` checks the rib geometry."""
    c = contact_constants(bearing, LAW, bj.numerics.ContactMapped())
    ribs = ()
    if c.ribs is not None:
        parts = c.ribs.centre, c.ribs.point, c.ribs.normal, c.ribs.gap, c.ribs.constant
        ribs = tuple(zip(c.ribs.on_outer, *map(np.asarray, parts), strict=True))
    return barrel_oracle.Barrel(
        n=bearing.n_elements,
        pitch=float(bearing.pitch_diameter),
        diameter=float(bearing.roller_diameter),
        length=float(bearing.roller_length),
        axis=float(bearing.axis_angle),
        half=float(bearing.half_angle),
        radii=tuple(map(float, bearing.arc_radii)),
        gap=float(bearing.gap),
        constant=float(LAW.value),
        place=float(bearing.axial_place),
        first=float(bearing.first_azimuth),
        ribs=ribs,
    )


# Random bearings, loads, tilts and speeds against brute force.


def random_bearing(kind, rng, **change):
    """A bearing of another size and shape, of the same structure."""
    bearing, size = KINDS[kind](**change), rng.uniform(0.5, 2.0)
    lengths = [
        *("pitch_diameter", "roller_diameter", "roller_length", "profile_offset"),
        *("roller_profile_radius", "inner_raceway_radius", "outer_raceway_radius"),
        "radial_internal_clearance",
    ]
    values = {
        name: size * float(value) * rng.uniform(0.97, 1.03)
        for name in lengths
        if (value := getattr(bearing, name, None)) is not None
    }
    values["roller_profile_radius"] *= 0.9
    if kind != "toroidal":
        values["contact_angle"] = float(bearing.contact_angle) * rng.uniform(0.8, 1.1)
    if kind == "thrust":
        rib = bj.Rib(0.2 * size, 2e-3 * size)
        values["ribs"] = bj.Ribs(inner_minus=rib)
    loose = dataclasses.replace(bearing, **values)
    radius = rng.uniform(0.95, 0.98) * float(min(loose.arc_radii[1:]))
    return dataclasses.replace(loose, roller_profile_radius=radius), size


def random_load(kind, size, rng):
    """A load that the bearing carries, and what of the rings is prescribed."""
    way, share = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.1, 1.0)
    axial = {"spherical": 0.4, "toroidal": 0.0, "thrust": 5.0}[kind]
    load = np.array([share * np.cos(way), share * np.sin(way), axial, 0.0, 0.0, 0.0])
    tilt = 1e-4 if kind == "thrust" else 1e-3
    outer = np.zeros(6)
    outer[[3, 4]] = rng.uniform(-tilt, tilt, 2)
    held = {name: rng.uniform(-tilt, tilt) for name in ("gx", "gy")}
    if kind == "toroidal":
        held["uz"] = rng.uniform(-1.0, 1.0) * 1e-3 * size
    return 10.0 ** rng.uniform(3.0, 4.5) * size**2 * load, held, outer


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.slow
def test_random_bearings_under_random_loads_against_brute_force(kind, turning):
    """Twelve bearings in all."""
    rng = np.random.default_rng(3 + turning)
    free = ("ux", "uy") if kind == "toroidal" else ("ux", "uy", "uz")
    for _ in range(2):
        # At speed all rollers are held: a loose one has no place of its own.
        tight = {} if kind == "thrust" else {"radial_internal_clearance": -200e-6}
        bearing, size = random_bearing(kind, rng, **(tight if turning else {}))
        load, held, outer = random_load(kind, size, rng)
        speed = bj.Speed(inner=rng.uniform(50.0, 150.0)) if turning else None
        found = bj.solve_load(
            element(bearing, line_law=LAW),
            load,
            support=bj.Support(free=free, prescribed=held, fixed_displacement=outer),
            speed=speed,
        )
        row, inertia = oracle_of(bearing), None
        if speed is not None:
            c = contact_constants(bearing, LAW, bj.numerics.ContactMapped())
            inertia = np.array(inertia_force(c, speed))
            if bearing.caged:
                inertia[0] = 0.0
            inertia = np.asarray(c.to_axes).T @ inertia
        force, stiffness, _ = barrel_oracle.evaluate(
            row, np.asarray(found.displacement), inertia=inertia
        )
        lever = np.tile(np.repeat([1.0, 0.06 * size], 3), 2)
        largest = np.abs(force / lever).max()
        carried = 6 + np.arange(len(free))
        wrong = np.abs(force[carried] - load[carried - 6])
        assert wrong.max() < QUADRATURE_FORCE * largest
        wrong = np.abs(np.asarray(found.force) - force) / lever
        assert wrong.max() < QUADRATURE_FORCE * largest
        diagonal = np.sqrt(np.abs(np.diag(stiffness)))
        floor = 1e-9 * diagonal.max() ** 2
        scale = np.outer(diagonal, diagonal) + floor
        wrong = np.abs(np.asarray(found.stiffness) - stiffness) / scale
        assert wrong.max() < QUADRATURE_STIFFNESS


def test_mass_of_a_barrel_by_summing_discs():
    bearing = spherical_thrust()
    c = contact_constants(bearing, LAW, bj.numerics.ContactMapped())
    half, length = float(c.half_angle), float(bearing.roller_length)
    s = np.linspace(-0.5 * length, 0.5 * length, 200_001)
    drop = 0.10 - np.sqrt(0.10**2 - s**2)
    z = s * np.cos(half) - drop * np.sin(half)
    r = 0.011 - s * np.sin(half) - drop * np.cos(half)

    def integral(f):
        return 7850 * np.pi * np.trapezoid(f, z)

    exact = (
        integral(r**2),
        integral(0.5 * r**4),
        integral(0.25 * r**4 + r**2 * z**2),
    )
    np.testing.assert_allclose(mass_and_inertia(c), exact, rtol=1e-9)


# What geometry alone says.


@pytest.mark.parametrize("kinematics", KINEMATICS)
def test_spherical_roller_tilt_about_sphere_keeps_energy(kinematics):
    """An outer ring turned about the centre of its sphere, by up to 2.5 degrees."""
    aligning = element(bj.BearingSet.self_aligning(spherical(9)), kinematics)
    q = jnp.zeros(12).at[6:9].set(jnp.asarray([60e-6, 10e-6, 40e-6]))
    straight, _ = evaluate(aligning, q)
    force, stiff = np.asarray(straight.force), np.asarray(straight.stiffness)
    largest = np.abs(force).max()
    assert np.abs(stiff[3:5]).max() < ROUNDING * np.abs(stiff).max()
    for tilt in (1e-4, 0.01, 2.5 * DEG):
        turned, _ = evaluate(aligning, q.at[3:5].set(tilt * np.array([0.6, 0.8])))
        assert int(turned.result) == bj.Result.CONVERGED
        # The spring that guides loose rollers stores 1e-11 of the energy.
        assert float(turned.energy) == pytest.approx(float(straight.energy), rel=1e-10)
        # Two solves of the rollers, from different starts.
        assert np.abs(np.asarray(turned.force) - force).max() < 1e-11 * largest
        wrong = np.abs(np.asarray(turned.stiffness) - stiff)
        assert wrong.max() < SOLVER * np.abs(stiff).max()


def test_toroidal_bearing_loses_clearance_as_two_arcs():
    """A roller between two arcs feels the distance of their centres alone.

    So clearance is lost to a shift s as 2 (A0 - sqrt(A0² - s²)), A0 = r_o + r_i - D.
    """
    bearing = toroidal(1, first_azimuth=0.0, radial_internal_clearance=0.0)
    distance = 0.42 + 0.42 - 0.0195
    one = element(bearing)
    push = 30e-6
    centred, _ = evaluate(one, jnp.zeros(12).at[6].set(push))
    for shift in (1e-3, 6.5e-3, 12.7e-3):
        # The roller stands at +x: the inner ring there moves by ux outwards.
        radial = np.sqrt((distance + push) ** 2 - shift**2) - distance
        q = jnp.zeros(12).at[6].set(radial).at[8].set(shift)
        moved, _ = evaluate(one, q)
        assert int(moved.result) == bj.Result.CONVERGED
        assert float(moved.energy) == pytest.approx(float(centred.energy), rel=1e-9)
        force = np.asarray(moved.force[6:9])
        along = np.array([distance + radial, 0.0, shift]) / (distance + push)
        size = float(centred.force[6])
        np.testing.assert_allclose(force, size * along, atol=SOLVER * size)
    # The tilt of the inner ring shifts the centre of its arc by R_I times the tilt.
    arm = 0.5 * 0.140 - 0.5 * 0.0195 + 0.42
    tilt = 5e-3
    exact = np.array([arm * np.sin(tilt), -arm * (1.0 - np.cos(tilt))])
    radial = np.sqrt((distance + push) ** 2 - exact[0] ** 2) - distance - exact[1]
    # θ = -sin φ gx + cos φ gy turns +z towards +r; at φ = 0 that is gy.
    q = jnp.zeros(12).at[6].set(radial).at[10].set(tilt)
    turned, _ = evaluate(one, q)
    assert float(turned.energy) == pytest.approx(float(centred.energy), rel=1e-9)


@pytest.mark.parametrize("travel, tilt", [(6.5e-3, 0.0), (0.0, 5e-3), (3e-3, 2e-3)])
def test_toroidal_lost_clearance_by_travel_and_tilt(travel, tilt):
    """Two opposite rollers, in a clearance a little above and below it."""
    pair = toroidal(2, first_azimuth=0.0, radial_internal_clearance=0.0)
    # A taller bearing, so that a tilt takes clearance: R_I > A0.
    pair = dataclasses.replace(pair, pitch_diameter=1.5)
    apart, arm = 0.42 + 0.42 - 0.0195, 0.5 * (1.5 - 0.0195) + 0.42
    across = travel + np.array([-1.0, 1.0]) * arm * np.sin(tilt)
    needed = apart - arm * (1.0 - np.cos(tilt)) - np.sqrt(apart**2 - across**2)
    lost = float(pair.lost_clearance(travel, tilt))
    assert lost == pytest.approx(needed.sum(), rel=1e-9)
    middle = 0.5 * (needed[1] - needed[0])
    q = jnp.zeros(12).at[8].set(travel).at[10].set(tilt).at[6].set(middle)
    for part, touches in ((1.001, False), (0.999, True)):
        loose = dataclasses.replace(pair, radial_internal_clearance=part * lost)
        got, _ = evaluate(element(loose, line_law=LAW), q)
        load = float(np.abs(np.asarray(got.force[6:9])).max() + got.stiffness[6, 6])
        assert (load > 1.0) is touches
    if tilt == 0.0:
        assert float(pair.free_travel(lost)) == pytest.approx(travel, rel=1e-9)


@pytest.mark.slow
def test_warning_of_travel_along_the_rollers():
    """The warning states about the share of the axial force that is left out."""
    aligning, load = srb_of_the_case(), [0.0, -40000.0, 0.0, 0.0, 0.0, 0.0]
    for travel, warned in ((0.2e-3, False), (0.6e-3, True)):
        linear, exact = (
            bj.solve_load(
                element(aligning, k),
                load,
                support=bj.Support(free=("ux", "uy"), prescribed={"uz": travel}),
            )
            for k in ("linearised", "exact")
        )
        share = float(travel_error(linear))
        wrong = 1.0 - float(linear.force[8] / exact.force[8])
        assert 0.4 < wrong / share < 2.5
        text = "travel along barrel rollers"
        assert any(text in w for w in bj.warnings(linear)) is warned
        assert not any(text in w for w in bj.warnings(exact))


@pytest.mark.slow
def test_rollers_go_with_a_tilted_inner_ring():
    """Its load then is that of the untilted ring under a load turned the other way."""
    aligning, free, tilt = srb_of_the_case(), ("ux", "uy", "uz"), 2.0 * DEG
    exact = element(aligning, line_law=LAW)
    load = [0.0, -40000.0, 0.0, 0.0, 0.0, 0.0]
    turned = [0.0, -40000.0 * np.cos(tilt), 40000.0 * np.sin(tilt), 0.0, 0.0, 0.0]
    held, most = {"gx": tilt, "gy": 0.0}, []
    for force, prescribed in ((load, held), (turned, {"gx": 0.0, "gy": 0.0})):
        found = bj.solve_load(
            exact, force, support=bj.Support(free=free, prescribed=prescribed)
        )
        most.append(float(np.max(found.roller_load)))
    assert most[0] == pytest.approx(most[1], rel=5e-3)
    linear = bj.solve_load(
        element(aligning, "linearised", line_law=LAW),
        load,
        support=bj.Support(free=free, prescribed=held),
    )
    lost = 1.0 - float(np.max(linear.roller_load)) / most[0]
    assert lost > 0.08
    assert float(travel_error(linear)) == pytest.approx(lost, rel=0.3)


def test_axial_clearance_of_a_spherical_bearing():
    """Ga = 2 (sqrt(A² - (A cos α - Gr/2)²) - A sin α), 22317 with Gr = 60 µm."""
    aligning, angle, arm = two_rows(60e-6), 12 * DEG, 2 * 0.081585 - 0.025
    radial = arm * np.cos(angle) - 30e-6
    half = np.sqrt(arm**2 - radial**2) - arm * np.sin(angle)
    for side, touches in ((0.99, False), (1.01, True)):
        q = jnp.zeros(12).at[8].set(half * side)
        got, _ = evaluate(element(aligning, line_law=LAW), q)
        assert (float(got.force[8]) > 0.1) is touches


def test_sets_are_made_under_vmap():
    """Rows of one mapped number: the others are still checked, without a trace."""
    clearances = jnp.array([20e-6, 30e-6])
    made = jax.vmap(
        lambda c: bj.BearingSet.self_aligning(spherical(radial_internal_clearance=c))
    )(clearances)
    for row in made.rows:
        assert isinstance(row.bearing, bj.SphericalRollerRow)
        assert np.array_equal(row.bearing.radial_internal_clearance, clearances)
    # A chord of the roller's arc, as long as the roller.
    drop = 0.0745 * (1.0 - np.cos(np.arcsin(0.0185 / 2 / 0.0745)))
    assert spherical().end_drop() == pytest.approx(drop, rel=1e-12)


def test_toroidal_bearing_requires_outer_raceway_radius():
    with pytest.raises(ValueError, match="`outer_raceway_radius` is None"):
        toroidal(outer_raceway_radius=None)


def test_pitch_diameter_of_a_sphere_is_traceable():
    """A float of plain numbers; slopes are those of differences."""
    sizes = dict(
        contact_angle=0.87,
        roller_diameter=0.022,
        roller_profile_radius=0.10,
        profile_offset=2e-3,
    )
    pitch = bj.design.pitch_on_sphere(outer_raceway_radius=0.104, **sizes)
    assert isinstance(pitch, float)

    def pitch_of(radius, angle):
        given = {**sizes, "contact_angle": angle, "outer_raceway_radius": radius}
        return bj.design.pitch_on_sphere(**given)

    slopes = jax.jit(jax.grad(pitch_of, (0, 1)))(0.104, 0.87)
    steps = [(1e-7, 0.0), (0.0, 1e-6)]
    for slope, (a, b) in zip(slopes, steps, strict=True):
        ends = [pitch_of(0.104 + s * a, 0.87 + s * b) for s in (-1, 1)]
        assert float(slope) == pytest.approx(
            (ends[1] - ends[0]) / (2 * (a + b)), rel=1e-7
        )


def test_slices_of_a_contact_between_arcs():
    """Their loads add up to the given one, and fall with the drop of the arcs."""
    radii, half = (0.078085, 0.0805), 0.5 * 0.0185
    contact = RollerContact(
        *(0.0185, 0.0215, 0.0215),
        raceway_radius=0.06,
        arc_radii=(jnp.asarray(radii[0]), jnp.asarray(radii[1])),
    )
    s = jnp.linspace(-half, half, 4001)
    found = slices(contact, 5e3, 0.0, s, law=LAW)
    rolls, races = (r - np.sqrt(r**2 - np.asarray(s) ** 2) for r in radii)
    pressed = np.maximum(float(found.approach) - (rolls - races), 0.0)
    want = float(LAW.value) * pressed ** (10 / 9)
    np.testing.assert_allclose(found.line_load, want, atol=1e-9 * want.max())
    assert np.trapezoid(want, s) == pytest.approx(5e3, rel=1e-6)


@pytest.mark.parametrize("load", [5e3, 20e3])
def test_coupled_slices_of_a_barrel_against_the_half_space(load):
    """Load at the approach of a half-space solution; independent slices are 6 to 8 %
    off."""
    steel, arcs = bj.Material(210e9, 0.3), (jnp.asarray(0.078085), jnp.asarray(0.0805))
    size = jnp.asarray(0.0185), jnp.asarray(0.0215)
    roller = RollerContact(
        *(*size, size[1]), material=steel, raceway_material=steel, arc_radii=arcs
    )
    grid = roller.grid(4.0 * roller.line_half_width(load), 65, 64)
    wanted = roller.solve(load, tilt=0.0, grid=grid)
    law = bj.contact.CoupledSlices(16)
    straight = bj.Straight(), bj.Straight()
    constant = law.constant(steel, steel, size[0])
    line = LineContact(constant, *size, *straight, arc_radii=arcs)
    coupled = law.contact(
        line, lambda s: jnp.full_like(s, 0.5 * 0.0215), jnp.asarray(210e9 / 1.82)
    )
    rule = bj.numerics.ContactMapped()
    made = coupled.table(rule)
    got = response(coupled, made, rule, wanted.approach, jnp.zeros(()))
    assert float(got.load[0]) == pytest.approx(load, rel=4e-3)
    middle = float(
        coupled.load_along(made, jnp.zeros(1), wanted.approach, jnp.zeros(()))[0]
    )
    assert middle == pytest.approx(
        float(jnp.interp(0.0, wanted.grid.y, wanted.line_load)), rel=6e-3
    )


class StraightArcs(bj.TaperedRollerBearing):
    """A taper whose generators are arcs of infinite radii."""

    @property
    def arc_radii(self):
        far = jnp.full_like(self.pitch_diameter, jnp.inf)
        return far, far, far


def pair_with_infinite_radii(kind, profile):
    """A bearing of the barrel mechanism, and the one that it must equal."""
    common = dict(radial_internal_clearance=10e-6, roller_profile=profile)
    if kind == "tapered":
        common |= dict(roller_axis_angle=11 * DEG, roller_half_angle=1.7 * DEG)
        common |= dict(ribs=bj.Ribs(inner_minus=bj.Rib(0.09, 1.2e-3)))
        size = 9, 0.052, 0.0082, 0.0115
        return StraightArcs(*size, **common), bj.TaperedRollerBearing(*size, **common)
    size = 7, 0.065, 0.010, 0.010
    arcs = ("roller_profile_radius", "outer_raceway_radius", "inner_raceway_radius")
    barrel = bj.ToroidalRollerBearing(*size, **dict.fromkeys(arcs, np.inf), **common)
    return barrel, bj.CylindricalRollerBearing(*size, **common)


@pytest.mark.parametrize("kinematics", KINEMATICS)
@pytest.mark.parametrize("kind", ["cylindrical", "tapered"])
@pytest.mark.slow
def test_infinite_radii_are_the_straight_roller(kind, kinematics):
    """`Finite` without tilts: of straight rollers formula (3) holds the normals that
    arcs turn with their rings, so that moments differ by load times travel."""
    exact = kinematics == "exact"
    profile = bj.Straight() if exact else bj.Logarithmic()
    q = jnp.zeros(12).at[6].set(30e-6).at[8].set(40e-6 if kind == "tapered" else 0.0)
    if not exact:
        q = q.at[9].set(1e-3).at[3].set(-2e-4)
    moved = np.array([0, 1, 2, 6, 7, 8]) if exact else np.arange(12)
    got, want = (
        evaluate(element(b, kinematics), q)[0]
        for b in pair_with_infinite_radii(kind, profile)
    )
    assert float(got.energy) == pytest.approx(float(want.energy), rel=ROUNDING)
    for name, part in (("force", moved), ("stiffness", np.ix_(moved, moved))):
        a, b = (np.asarray(getattr(one, name))[part] for one in (got, want))
        assert np.abs(b).max() > 1.0
        assert np.abs(a - b).max() < ROUNDING * np.abs(b).max()


# Bearings of the cases.


def two_rows(clearance):
    """22317 after Harris with rollers that fit their raceways: a constant line law."""
    row = bj.SphericalRollerRow(
        14,
        0.135077,
        0.025,
        0.020762,
        contact_angle=12 * DEG,
        roller_profile_radius=0.081585,
        outer_raceway_radius=0.081585,
        inner_raceway_radius=0.081585,
        radial_internal_clearance=clearance,
    )
    return bj.BearingSet.self_aligning(row, staggered=False)


def srb_of_the_case():
    angle, gap = 9.5 * DEG, 5e-6
    row = bj.SphericalRollerRow(
        18,
        2 * (0.0805 - 0.0215 / 2) * np.cos(angle),
        0.0215,
        0.0185,
        contact_angle=angle,
        roller_profile_radius=0.078085,
        outer_raceway_radius=0.0805,
        inner_raceway_radius=0.0805,
        radial_internal_clearance=4 * gap / np.cos(angle),
        first_azimuth=-90 * DEG,
    )
    return bj.BearingSet.self_aligning(row)


# Derivatives.


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.slow
def test_derivatives_by_every_number_of_the_drawing(kind):
    """Through the load solve, against central differences."""
    bearing = KINDS[kind]()
    if kind == "spherical":
        bearing = spherical(outer_raceway_radius=float(spherical().sphere_radius))
    load = [0.0, 0.0, 20e3] if kind == "thrust" else [9e3, 4e3, 0.0]
    free = ("ux", "uy", "uz") if kind == "thrust" else ("ux", "uy")
    names = [
        *("roller_profile_radius", "inner_raceway_radius", "outer_raceway_radius"),
        *("contact_angle", "profile_offset"),
    ]
    names = [n for n in names if getattr(bearing, n, None) is not None]

    @eqx.filter_jit
    def measure(values):
        changed = eqx.tree_at(
            lambda b: [getattr(b, n) for n in names], bearing, list(values)
        )
        found = bj.solve_load(
            element(changed, line_law=LAW),
            [*load, 0.0, 0.0, 0.0],
            support=bj.Support(free=free),
        )
        return found.displacement[8 if kind == "thrust" else 6]

    at = jnp.stack([getattr(bearing, n) for n in names])
    slopes = np.asarray(eqx.filter_jit(jax.jacfwd(measure))(at))
    for k, name in enumerate(names):
        step = 1e-4 * max(float(at[k]), 1e-3)
        found = [float(measure(at.at[k].add(d * step))) for d in (-2, -1, 1, 2)]
        difference = (found[0] - 8 * found[1] + 8 * found[2] - found[3]) / (12 * step)
        size = max(abs(difference), 1e-3 * np.abs(slopes).max())
        assert abs(slopes[k] - difference) < 10 * DIFFERENCE * size, name

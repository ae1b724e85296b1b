"""Wrong scenes: one line that names file, key, fault and remedy; exit status 2."""

import math
import re

import pytest

from bearingjax import SceneError, read_scene
from bearingjax.scene import shipped_scenes
from bearingjax.scene.design_keys import BALLS, ROLLERS

TAPER = """
[bearing]
type = "tapered_roller"
n_rollers = 17
pitch_diameter = "52 mm"
roller_diameter = "8.2 mm"
roller_length = "11.5 mm"
roller_axis_angle = "11 deg"
roller_half_angle = "1.7235 deg"
"""

KNOWN_BEARINGS = ", ".join((*ROLLERS, *BALLS))
WHOLE = "is not a whole number of at least 1"
NO_UNIT = 'has no unit; a length with its unit is wanted, such as "5 mm"'
RIB = '{end_radius = "300 mm", contact_height = "1.5 mm"}'

# Scene, setting, text of the message after "file: ".
SETTINGS = {
    # Rating life.
    "unknown key of life": (
        "life_spectrum",
        "life.dynamic_rating=23 kN",
        "`life.dynamic_rating`: unknown key (did you mean `dynamic_capacity`?)",
    ),
    "capacity without its unit": (
        "life_spectrum",
        "life.dynamic_capacity=23400",
        "`life.dynamic_capacity`: 23400 has no unit; a force with its unit is wanted",
    ),
    "capacity below zero": (
        "life_spectrum",
        "life.static_capacity=-11 kN",
        "`life.static_capacity`: -11000 N is not allowed; above 0 N",
    ),
    "limit of no force": (
        "life_spectrum",
        "life.fatigue_load_limit=0 N",
        "`life.fatigue_load_limit`: 0 N is not allowed; above 0 N",
    ),
    "reliability in per cent": (
        "life_spectrum",
        "life.reliability=95",
        "`life.reliability`: 95 is not allowed; from 0.9 to 0.9995 (a share, not %)",
    ),
    "contamination above one": (
        "life_spectrum",
        "life.contamination=1.2",
        "`life.contamination`: 1.2 is not allowed; from 0 to 1 (e_C, or a class of ISO",
    ),
    "contamination of no class": (
        "life_spectrum",
        "life.contamination=grease, hihg",
        "`life.contamination`: 'grease, hihg' is not known (did you mean `grease, high`"
        '?); it must be one of "circulating oil -/13/10", "circulating oil',
    ),
    "two oils of a life": (
        "life_spectrum",
        "life.viscosity=20 mm^2/s",
        "`life.viscosity`: stands beside [lubricant], whose oil has a viscosity",
    ),
    "dynamic viscosity of a life": (
        "life_spectrum",
        "life.viscosity=20 mPa s",
        "`life.viscosity`: '20 mPa s' is not a kinematic viscosity",
    ),
    "thick oil of a life": (
        "life_spectrum",
        "life.viscosity=20 m^2/s",
        "`life.viscosity`: 20 m²/s is not allowed; above 0 and below 1 m²/s",
    ),
    "load fixed to a shaft": (
        "life_spectrum",
        "life.load_fixed_to=shaft",
        "`life.load_fixed_to`: 'shaft' is not known; it must be one of space, inner,",
    ),
    "edge stress in words": (
        "life_spectrum",
        "life.edge_stress=none",
        "`life.edge_stress`: 'none' is not true or false",
    ),
    "film at rest": (
        "cylindrical_rig",
        'life={contamination=0.5,viscosity="20 mm^2/s"}',
        "`life.contamination`: needs a speed of one ring against the other",
    ),
    "contamination without an oil": (
        "tapered",
        "life={contamination=0.5}",
        "`life.viscosity`: is missing, and so is [lubricant]; `contamination` needs an",
    ),
    "oil without contamination": (
        "tapered",
        'life={viscosity="20 mm^2/s"}',
        "`life.contamination`: is missing; the modified life needs it beside",
    ),
    "ends of balls": (
        "life_spectrum",
        "life.edge_stress=false",
        "`life.edge_stress`: is for rollers; balls have no ends",
    ),
    # Keys.
    "unknown table": (
        "cylindrical_rig",
        "bearings.n_rollers=3",
        "`bearings`: unknown key (did you mean `bearing`?); known at the top level:"
        " bearing, cage, cases, contact, deviations, dynamics, fit, life, lubricant,"
        " numerics, operating, optimise, output, set, temperature, vibration",
    ),
    "unknown key in bearing": (
        "cylindrical_rig",
        "bearing.rolerdiameter=14 mm",
        "`bearing.rolerdiameter`: unknown key (did you mean `roller_diameter`?);"
        " known in [bearing]: arrangement, ",
    ),
    "unknown key in a nested table": (
        "cylindrical_rig",
        "bearing.roller_profile.crown_radus=1 m",
        "`bearing.roller_profile.crown_radus`: unknown key (did you mean"
        " `crown_radius`?); known in [bearing.roller_profile]: crown_radius,",
    ),
    "unknown key beside the points": (
        "tapered",
        "output.point=7",
        "`output.point`: unknown key (did you mean `points`?); known in [output]:"
        " points",
    ),
    "misspelt load": (
        "cylindrical_rig",
        "operating.load.F_y=-1 kN",
        "`operating.load.F_y`: unknown key (did you mean `Fy`?); known in"
        " [operating.load]: Fx, Fy, Fz, Mx, My, Mz",
    ),
    "no such load": (
        "cylindrical_rig",
        "operating.load.radial=-1 kN",
        "`operating.load.radial`: unknown key; known in [operating.load]: Fx, Fy,",
    ),
    "misspelt prescribed": (
        "cylindrical_rig",
        "operating.prescribed.u_z=1 um",
        "`operating.prescribed.u_z`: unknown key (did you mean `uz`?); known in",
    ),
    "angle of a taper in a cylinder": (
        "cylindrical_rig",
        "bearing.roller_axis_angle=11 deg",
        "`bearing.roller_axis_angle`: unknown key",
    ),
    "raceway that is not there": (
        "needle",
        "bearing.raceway_profile.outr.type=straight",
        "`bearing.raceway_profile.outr`: unknown key (did you mean `outer`?)",
    ),
    # Quantities.
    "bare number": (
        "cylindrical_rig",
        "bearing.pitch_diameter=72.5",
        f"`bearing.pitch_diameter`: 72.5 {NO_UNIT}",
    ),
    "text without unit": (
        "cylindrical_rig",
        'bearing.pitch_diameter="72.5"',
        f"`bearing.pitch_diameter`: '72.5' {NO_UNIT}",
    ),
    "bare speed": (
        "tapered",
        "operating.inner_speed=3000",
        "`operating.inner_speed`: 3000 has no unit; a speed with its unit is wanted,"
        ' such as "5 rpm"',
    ),
    "force as length": (
        "cylindrical_rig",
        "bearing.roller_length=5 N",
        "`bearing.roller_length`: '5 N' is not a length; a length with its unit",
    ),
    "length as force": (
        "cylindrical_rig",
        "operating.load.Fy=5 mm",
        "`operating.load.Fy`: '5 mm' is not a force; a force with its unit",
    ),
    "force as moment": (
        "cylindrical_rig",
        "operating.load.Mx=3 kN",
        "`operating.load.Mx`: '3 kN' is not a moment; a moment with its unit is"
        ' wanted, such as "5 N m"',
    ),
    "moment as force": (
        "cylindrical_rig",
        "operating.load.Fz=3 N m",
        "`operating.load.Fz`: '3 N m' is not a force",
    ),
    "angle as prescribed length": (
        "cylindrical_rig",
        "operating.prescribed.uz=1 mrad",
        "`operating.prescribed.uz`: '1 mrad' is not a length",
    ),
    "length as angle": (
        "tapered",
        "bearing.roller_axis_angle=11 mm",
        "`bearing.roller_axis_angle`: '11 mm' is not a",
    ),
    "density without volume": (
        "cylindrical_rig",
        "bearing.material.density=7850 kg",
        "`bearing.material.density`: '7850 kg' is not a density; a density",
    ),
    "unknown unit": (
        "cylindrical_rig",
        "bearing.pitch_diameter=5 furlogs",
        "`bearing.pitch_diameter`: '5 furlogs' has the unknown unit 'furlogs'; a",
    ),
    "sum of units": (
        "cylindrical_rig",
        "bearing.pitch_diameter=5 mm+mm",
        "`bearing.pitch_diameter`: '5 mm+mm' has the unknown unit 'mm+mm'",
    ),
    "decimal comma": (
        "cylindrical_rig",
        "bearing.pitch_diameter=72,5 mm",
        "`bearing.pitch_diameter`: '72,5 mm' has a comma; write a decimal point",
    ),
    "nan": (
        "cylindrical_rig",
        "bearing.pitch_diameter=nan mm",
        "`bearing.pitch_diameter`: 'nan mm' does not begin with a finite number;",
    ),
    "infinite": (
        "cylindrical_rig",
        "operating.load.Fy=-inf kN",
        "`operating.load.Fy`: '-inf kN' does not begin with a finite number;",
    ),
    "beyond float64": (
        "cylindrical_rig",
        "operating.load.Fy=1e400 N",
        "`operating.load.Fy`: '1e400 N' is out of range;",
    ),
    "empty": (
        "cylindrical_rig",
        "bearing.pitch_diameter=",
        "`bearing.pitch_diameter`: '' does not begin with a finite number;",
    ),
    "boolean as quantity": (
        "cylindrical_rig",
        "operating.load.Fy=true",
        "`operating.load.Fy`: True is not a quantity; a force with its unit",
    ),
    "date as quantity": (
        "cylindrical_rig",
        "operating.load.Fy=2020-01-01",
        "`operating.load.Fy`: datetime.date(2020, 1, 1) is not a quantity;",
    ),
    "hertz": (
        "tapered",
        "operating.inner_speed=50 Hz",
        "`operating.inner_speed`: '50 Hz' is a frequency; give rpm, deg/s or rad/s",
    ),
    "kilohertz": (
        "tapered",
        "operating.outer_speed=0.05 kHz",
        "`operating.outer_speed`: '0.05 kHz' is a frequency; give rpm,",
    ),
    "poisson ratio with unit": (
        "cylindrical_rig",
        "bearing.material.poisson_ratio=0.3 mm",
        "`bearing.material.poisson_ratio`: '0.3 mm' is not a bare number (no unit",
    ),
    "poisson ratio as text": (
        "cylindrical_rig",
        'bearing.material.poisson_ratio="0.3"',
        "`bearing.material.poisson_ratio`: '0.3' is not a bare number",
    ),
    # Counts.
    "text as count": (
        "cylindrical_rig",
        'bearing.n_rollers="12"',
        f"`bearing.n_rollers`: '12' {WHOLE}",
    ),
    "half a roller": (
        "cylindrical_rig",
        "bearing.n_rollers=12.5",
        f"`bearing.n_rollers`: 12.5 {WHOLE}",
    ),
    "true rollers": (
        "cylindrical_rig",
        "bearing.n_rollers=true",
        f"`bearing.n_rollers`: True {WHOLE}",
    ),
    "no rollers": (
        "cylindrical_rig",
        "bearing.n_rollers=0",
        f"`bearing.n_rollers`: 0 {WHOLE}",
    ),
    "no quadrature points": (
        "cylindrical_rig",
        "numerics.points=0",
        f"`numerics.points`: 0 {WHOLE}",
    ),
    "broken quadrature points": (
        "cylindrical_rig",
        "numerics.points=20.5",
        f"`numerics.points`: 20.5 {WHOLE}",
    ),
    "one position": (
        "cylindrical_rig",
        "output.points=1",
        "`output.points`: 1 is not a whole number of at least 2",
    ),
    # Dimensions that do not fit.
    "negative length": (
        "cylindrical_rig",
        "bearing.roller_length=-5 mm",
        "[bearing]: CylindricalRollerBearing: `roller_length` is -0.005 m; it must be"
        " above 0 m.",
    ),
    "overlap": (
        "cylindrical_rig",
        "bearing.n_rollers=17",
        "[bearing]: CylindricalRollerBearing: `n_rollers` is 17 rollers; it must be"
        " low enough that rollers do not overlap around the pitch circle (at most 16",
    ),
    "roller as large as the bearing": (
        "cylindrical_rig",
        "bearing.roller_diameter=80 mm",
        "[bearing]: CylindricalRollerBearing: `roller_diameter` is 0.08 m; it must be"
        " small enough to leave an inner raceway",
    ),
    "clearance in metres": (
        "cylindrical_rig",
        "bearing.radial_internal_clearance=25 m",
        "[bearing]: CylindricalRollerBearing: `radial_internal_clearance` is 25 m; it"
        " must be smaller",
    ),
    "stout needle": (
        "needle",
        "bearing.roller_length=6 mm",
        "[bearing]: NeedleRollerBearing: `roller_length` is 0.006 m; it must be at"
        " least 2.5 roller diameters",
    ),
    "taper past upright": (
        "tapered",
        "bearing.roller_axis_angle=95 deg",
        "[bearing]: TaperedRollerBearing: `roller_axis_angle` is 1.65806 rad; it must"
        " be above 0 and below",
    ),
    "half angle above axis angle": (
        "tapered",
        "bearing.roller_half_angle=12 deg",
        "[bearing]: TaperedRollerBearing: `roller_half_angle` is 0.20944 rad; it must"
        " be at least 0 and below",
    ),
    "crown radius too small": (
        "cylindrical_rig",
        "bearing.roller_profile.crown_radius=1 mm",
        "[bearing]: CrownedEnds: `crown_radius` is 0.001 m; it must be above 0.00236"
        " m, so that the arc spans",
    ),
    "rib above the roller end": (
        "cylindrical_ribs",
        "bearing.rib.contact_height=12 mm",
        "[bearing]: CylindricalRollerBearing: `ribs.outer_minus.contact_height` is"
        " 0.012 m; it must be below",
    ),
    "poisson ratio of no material": (
        "cylindrical_rig",
        "bearing.material.poisson_ratio=0.6",
        "[bearing.material]: Material: `poisson_ratio` is 0.6; it must be above -1"
        " and below 0.5.",
    ),
    "negative modulus of the rings": (
        "cylindrical_rig",
        "bearing.ring_material.elastic_modulus=-1 GPa",
        "[bearing.ring_material]: Material: `elastic_modulus` is -1e+09 Pa; it must",
    ),
    # Names.
    "ball bearing with rollers": (
        "cylindrical_rig",
        "bearing.type=deep_groove_ball",
        "`bearing.n_balls`: is missing; it must be a whole number",
    ),
    "unknown bearing": (
        "cylindrical_rig",
        "bearing.type=conical_roller",
        "`bearing.type`: 'conical_roller' is not known (did you mean"
        f" `cylindrical_roller`?); it must be one of {KNOWN_BEARINGS}",
    ),
    # Balls.
    "clearance and contact angle": (
        "deep_groove",
        "bearing.contact_angle=15 deg",
        "[bearing]: DeepGrooveBallBearing: `radial_internal_clearance` and"
        " `contact_angle` are both given; one follows from the other.",
    ),
    "osculation the other way": (
        "deep_groove",
        "bearing.outer_osculation=1.06",
        "[bearing]: DeepGrooveBallBearing: `outer_osculation` is 1.06; it must be above"
        " 0.5 and below 1: groove radius over ball diameter, such as 0.52.",
    ),
    "ball as large as the groove": (
        "angular_contact",
        "bearing.inner_osculation=0.5",
        "[bearing]: AngularContactBallBearing: `inner_osculation` is 0.5; it must be",
    ),
    "too many balls": (
        "deep_groove",
        "bearing.n_balls=13",
        "[bearing]: DeepGrooveBallBearing: `n_balls` is 13 balls; it must be low enough"
        " that balls do not overlap around the pitch circle (at most 11 of this size).",
    ),
    "no balls": (
        "deep_groove",
        "bearing.n_balls=0",
        "`bearing.n_balls`: 0 is not a whole number of at least 1",
    ),
    "contact angle of a thrust bearing": (
        "angular_contact",
        "bearing.contact_angle=90 deg",
        "[bearing]: AngularContactBallBearing: `contact_angle` is 1.5708 rad; it must"
        " be above 0 and below 1.5708 rad.",
    ),
    "negative contact angle": (
        "angular_contact",
        "bearing.contact_angle=-25 deg",
        "[bearing]: AngularContactBallBearing: `contact_angle` is -0.436332 rad; it",
    ),
    "shoulder higher than the ball": (
        "deep_groove",
        "bearing.outer_shoulder=23 mm",
        "[bearing]: DeepGrooveBallBearing: `outer_shoulder` is 0.023 m; it must be",
    ),
    "ball clearance in metres": (
        "deep_groove",
        "bearing.radial_internal_clearance=10 m",
        "[bearing]: DeepGrooveBallBearing: `radial_internal_clearance` is 10 m; it must"
        " be below 0.00115 m in size, where the groove centres meet (metres meant?).",
    ),
    "line law of a ball": (
        "deep_groove",
        "contact.line_law=palmgren",
        "`contact.line_law`: unknown key",
    ),
    "quadrature of a ball": (
        "deep_groove",
        "numerics.quadrature=midpoint",
        "`numerics.quadrature`: unknown key",
    ),
    "one constant of two": (
        "deep_groove",
        "contact.outer_constant=3e10 N/m^1.5",
        "`contact.inner_constant`: is missing; give the constants of both rings",
    ),
    "unknown raceway control": (
        "angular_contact",
        "operating.raceway_control=both",
        "`operating.raceway_control`: 'both' is not known",
    ),
    "friction without its control": (
        "angular_contact",
        "operating.raceway_control=outer",
        "`operating.friction_coefficient`: goes with `raceway_control` ="
        ' "friction_limited" only',
    ),
    "negative friction": (
        "angular_contact",
        "operating.friction_coefficient=-0.1",
        "[operating]: FrictionLimited: `friction` is -0.1; it must be above 0.",
    ),
    "too few deviations": (
        "deep_groove",
        'bearing.ball_deviation=["1 um", "2 um"]',
        "[bearing]: DeepGrooveBallBearing: `ball_deviation` has shape (2,); it must be"
        " (7,)",
    ),
    "unknown arrangement of a set": (
        "ball_pair",
        "set.arrangement=DB",
        "`set.arrangement`: 'DB' is not known; it must be one of back_to_back,",
    ),
    "rows at the same place": (
        "ball_pair",
        "set.spacing=0 mm",
        "[set]: BearingSet: `spacing` is 0 m; it must be above 0 m.",
    ),
    "rows that are no list": (
        "ball_pair",
        "set={arrangement = 'rows', rows = 2}",
        "`set.rows`: 2 is not a list of tables",
    ),
    "preload twice": (
        "ball_pair",
        "set.preload_force=300 N",
        "`set.preload_force`: give either `preload_offset` or this, not both",
    ),
    "preload of a sprung pair": (
        "sprung_pair",
        "set.preload_force=300 N",
        "[set]: preload: a row has a spring, which presses it.",
    ),
    "preload that pulls": (
        "ball_pair",
        "set={arrangement='face_to_face', spacing='19 mm', preload_force='-3 N'}",
        "[set]: preload: `force` is -3 N; it must be above 0 N.",
    ),
    "preload of a tandem": (
        "ball_pair",
        "set={arrangement='tandem', spacing='19 mm', spring_force='3 N'}",
        "`set.spring_force`: is for rows that face each other; those of a tandem do",
    ),
    "turning balls of constant angle": (
        "angular_contact",
        "numerics.kinematics=constant_angle",
        "`numerics.kinematics`: constant_angle is for balls at rest; leave out the",
    ),
    "load on what is prescribed": (
        "self_aligning",
        "operating.load.Mx=5 N m",
        "`operating.load`: Mx acts on gx, which is prescribed: its support",
    ),
    "spring without its force": (
        "ball_pair",
        "set.spring_stiffness=80 N/mm",
        "`set.spring_stiffness`: goes with `spring_force`",
    ),
    "spring stiffness as a force": (
        "sprung_pair",
        "set.spring_stiffness=80 N",
        "`set.spring_stiffness`: ",
    ),
    "set of self-aligning bearings": (
        "self_aligning",
        "set.arrangement=tandem",
        "`set`: a self-aligning bearing has both its rows already",
    ),
    "outer osculation of a sphere": (
        "self_aligning",
        "bearing.outer_osculation=0.52",
        "[bearing]: SelfAligningBallRow: `outer_osculation` is given, but the outer"
        " raceway is a sphere about the middle",
    ),
    "linearised self-aligning bearing": (
        "self_aligning",
        "numerics.kinematics=linearised",
        "[numerics]: BearingElement: `kinematics` is Linearised(), with which",
    ),
    "misspelt bearing type": (
        "cylindrical_rig",
        "bearing.type=cylindrical_rolller",
        "`bearing.type`: 'cylindrical_rolller' is not known (did you mean"
        f" `cylindrical_roller`?); it must be one of {KNOWN_BEARINGS}",
    ),
    "unknown profile": (
        "cylindrical_rig",
        "bearing.roller_profile.type=logarithmc",
        "`bearing.roller_profile.type`: 'logarithmc' is not known (did you mean"
        " `logarithmic`?); it must be one of straight, circular_crown, crowned_ends,",
    ),
    "parameter of another profile": (
        "cylindrical_rig",
        "bearing.roller_profile.type=circular_crown",
        "`bearing.roller_profile.straight_length`: unknown key; known in"
        " [bearing.roller_profile]: crown_radius, type",
    ),
    "profile without its parameter": (
        "cylindrical_rig",
        'bearing.roller_profile={type="crowned_ends",straight_length="9 mm"}',
        "`bearing.roller_profile.crown_radius`: is missing; it must be a length",
    ),
    "half a dub-off": (
        "cylindrical_rig",
        "bearing.roller_profile.dub_off_length=1 mm",
        "[bearing.roller_profile]: CrownedEnds: `dub_off_length` and `dub_off_radius`"
        " go together",
    ),
    "table of one quantity": (
        "cylindrical_rig",
        'bearing.roller_profile={type="tabulated",positions="1 mm",drops=["0 um"]}',
        "`bearing.roller_profile.positions`: '1 mm' is not a list of quantities",
    ),
    "table with a bare number": (
        "cylindrical_rig",
        'bearing.roller_profile={type="tabulated",positions=["-7 mm",0,"7 mm"],'
        'drops=["9 um","0 um","9 um"]}',
        f"`bearing.roller_profile.positions`: 0 {NO_UNIT}",
    ),
    "short table": (
        "cylindrical_rig",
        'bearing.roller_profile={type="tabulated",positions=["-5 mm","0 mm","5 mm"],'
        'drops=["9 um","0 um","9 um"]}',
        "[bearing]: Tabulated: `positions` is [-0.005  0.     0.005] m; it must be a"
        " table that covers the roller",
    ),
    "unknown material": (
        "cylindrical_rig",
        "bearing.material=stel",
        "`bearing.material`: 'stel' is not known (did you mean `steel`?); it must be"
        " one of steel, silicon_nitride, zirconia",
    ),
    "unknown ring material": (
        "hybrid_spindle",
        "bearing.ring_material=brass",
        "`bearing.ring_material`: 'brass' is not known; it must be one of steel,",
    ),
    "unknown quadrature": (
        "cylindrical_rig",
        "numerics.quadrature=gauss",
        "`numerics.quadrature`: 'gauss' is not known; it must be one of"
        " contact_mapped, midpoint",
    ),
    "unknown kinematics": (
        "cylindrical_rig",
        "numerics.kinematics=linear",
        "`numerics.kinematics`: 'linear' is not known (did you mean `linearised`?);"
        " it must be one of linearised, constant_angle, finite",
    ),
    "unknown equilibrium": (
        "cylindrical_rig",
        "numerics.equilibrium=bfsg",
        "`numerics.equilibrium`: 'bfsg' is not known (did you mean `bfgs`?); it must"
        " be one of newton, bfgs",
    ),
    "unknown line law": (
        "cylindrical_rig",
        "contact.line_law=harris",
        "`contact.line_law`: 'harris' is not known; it must be one of palmgren,"
        " iso16281",
    ),
    "unknown ring": (
        "cylindrical_rig",
        "operating.fixed_ring=left",
        "`operating.fixed_ring`: 'left' is not known; it must be one of outer, inner",
    ),
    "line constant of another law": (
        "cylindrical_rig",
        "contact.line_constant=8e10 N/m^(10/9)",
        "`contact.line_constant`: '8e10 N/m^(10/9)' is not a line constant; a line"
        ' constant with its unit is wanted, such as "5 N/m^(19/9)"',
    ),
    "negative line constant": (
        "cylindrical_rig",
        "contact.line_constant=-1e11 N/m^(19/9)",
        "[contact]: LineConstant: `value` is -1e+11 N/m^(19/9); it must be above 0",
    ),
    "tolerance too large": (
        "cylindrical_rig",
        "numerics.tolerance=0.5",
        "`numerics.tolerance`: 0.5 is not allowed; from 1e-14 to below 0.01",
    ),
    "tolerance too small": (
        "cylindrical_rig",
        "numerics.tolerance=0.0",
        "`numerics.tolerance`: 0 is not allowed; from 1e-14",
    ),
    "tolerance nan": (
        "cylindrical_rig",
        "numerics.tolerance=nan",
        "`numerics.tolerance`: nan is not a finite number",
    ),
    # Ribs.
    "arrangement and ribs": (
        "cylindrical_ribs",
        f"bearing.ribs.inner_minus={RIB}",
        "`bearing.ribs`: give either `arrangement` or `ribs`, not both",
    ),
    "arrangement without rib": (
        "cylindrical_rig",
        "bearing.arrangement=NU",
        "`bearing.rib`: is missing; it must be a table",
    ),
    "rib without arrangement": (
        "cylindrical_rig",
        f"bearing.rib={RIB}",
        "`bearing.rib`: belongs to an `arrangement`, which is missing",
    ),
    "axial clearance without arrangement": (
        "cylindrical_rig",
        "bearing.axial_internal_clearance=60 um",
        "`bearing.axial_internal_clearance`: belongs to an `arrangement`, which is",
    ),
    "axial clearance twice": (
        "cylindrical_ribs",
        "bearing.rib.axial_gap=15 um",
        "`bearing.axial_internal_clearance`: give either `rib.axial_gap` or this,",
    ),
    "unknown arrangement": (
        "cylindrical_ribs",
        "bearing.arrangement=NH",
        "`bearing.arrangement`: 'NH' is not known (did you mean `N`?); it must be one"
        " of N, NU, NJ, NUP",
    ),
    "unknown rib": (
        "tapered",
        f"bearing.ribs.inner_left={RIB}",
        "`bearing.ribs.inner_left`: unknown key (did you mean `inner_plus`?); known"
        " in [bearing.ribs]: inner_minus, inner_plus, outer_minus, outer_plus",
    ),
    "flat rib of a taper": (
        "tapered",
        "bearing.ribs.inner_minus.end_radius=flat",
        "`bearing.ribs.inner_minus.end_radius`: flat ends have no point contact; give"
        " the radius of the end sphere",
    ),
    "flat rib": (
        "cylindrical_ribs",
        "bearing.rib.end_radius=flat",
        "`bearing.rib.end_radius`: flat ends have no point contact; give the radius",
    ),
    # Freedoms.
    "free and prescribed": (
        "cylindrical_rig",
        "operating.prescribed.ux=1 um",
        "`operating.free`: ux is both free and prescribed; choose one",
    ),
    "gz free": (
        "cylindrical_rig",
        'operating.free=["ux", "gz"]',
        "`operating.free`: 'gz' is not known; it must be one of ux, uy, uz, gx, gy",
    ),
    "unknown freedom": (
        "cylindrical_rig",
        'operating.free=["rx"]',
        "`operating.free`: 'rx' is not known; it must be one of ux, uy, uz, gx, gy",
    ),
    "freedom twice": (
        "cylindrical_rig",
        'operating.free=["ux", "ux"]',
        "`operating.free`: ['ux', 'ux'] names something twice",
    ),
    "freedoms as text": (
        "cylindrical_rig",
        "operating.free=ux uy",
        "`operating.free`: 'ux uy' is not a list of words",
    ),
    # Kinds of values.
    "table where a count is expected": (
        "cylindrical_rig",
        "bearing.n_rollers={value = 12}",
        f"`bearing.n_rollers`: {{'value': 12}} {WHOLE}",
    ),
    "table where a length is expected": (
        "cylindrical_rig",
        'bearing.pitch_diameter={value = 72.5, unit = "mm"}',
        "`bearing.pitch_diameter`: {'value': 72.5, 'unit': 'mm'} is not a quantity;",
    ),
    "table where a word is expected": (
        "cylindrical_rig",
        "numerics.quadrature={points = 20}",
        "`numerics.quadrature`: {'points': 20} is not known; it must be one of",
    ),
    "list where text is expected": (
        "cylindrical_rig",
        'bearing.type=["cylindrical_roller"]',
        "`bearing.type`: ['cylindrical_roller'] is not known; it must be one of"
        f" {KNOWN_BEARINGS}",
    ),
    "list where a length is expected": (
        "cylindrical_rig",
        "bearing.pitch_diameter=[72.5]",
        "`bearing.pitch_diameter`: [72.5] is not a quantity; a length with its unit",
    ),
    "number where a table is expected": (
        "cylindrical_rig",
        "bearing.material=206",
        "`bearing.material`: 206 is not a table",
    ),
    "load without component": (
        "cylindrical_rig",
        "operating.load=5 kN",
        "`operating.load`: '5 kN' is not a table; name the components,"
        ' { Fy = "-4 kN" }',
    ),
    "load as a list": (
        "cylindrical_rig",
        "operating.load=[0, -4000, 0, 0, 0, 0]",
        "`operating.load`: [0, -4000, 0, 0, 0, 0] is not a table; name the components,",
    ),
    "prescribed as a list": (
        "cylindrical_rig",
        "operating.prescribed=['1 um']",
        "`operating.prescribed`: ['1 um'] is not a table; name the components,"
        ' { uz = "10 um" }',
    ),
    # What would fill the memory.
    "nodes": (
        "cylindrical_rig",
        "numerics={points=100000}",
        "[numerics]: `points` is 100000; it must be at most 500: the nodes are"
        " eigenvalues of a full matrix of that size",
    ),
    "slices": (
        "cylindrical_rig",
        "numerics={quadrature='midpoint', points=100000}",
        "`numerics.points`: 100000 is too many slices: 1.23 GB in each array of a"
        " sweep, of 64 cases at a time; at most 10000",
    ),
    "coupled slices": (
        "cylindrical_rig",
        "contact={line_law='coupled_slices', slices=100000}",
        "[contact]: CoupledSlices: `slices` is 100000; it must be at most 1000: each",
    ),
    "positions": (
        "cylindrical_rig",
        "output.points=100000",
        "`output.points`: 100000 is too many, 96 MB of JSON for 12 rollers; at most"
        " 10000",
    ),
    "bearing as text": (
        "cylindrical_rig",
        "bearing=NU210",
        "`bearing`: 'NU210' is not a table",
    ),
    "setting below a value": (
        "cylindrical_rig",
        "bearing.type.name=x",
        "`bearing.type` is not a table, so 'bearing.type.name' fails",
    ),
}


def one_line(run):
    """The message of a refused run: nothing else is said."""
    assert run.status == 2
    assert run.out == ""
    assert run.err.startswith("bearingjax: ") and run.err.count("\n") == 1
    assert "Traceback" not in run.err
    return run.err.removeprefix("bearingjax: ").rstrip("\n")


def a_file(folder, text):
    path = folder / "bad.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", SETTINGS)
def test_wrong_setting(run, name):
    scene, setting, text = SETTINGS[name]
    message = one_line(run("solve", scene, "--set", setting))
    assert message.startswith(f"{scene}.toml: {text}")


def without(key):
    """The taper with one line left out."""
    return re.sub(rf"(?m)^{key} = .*\n", "", TAPER)


TEXTS = {
    "nothing at all": ("", "`bearing`: is missing; it must be a table"),
    "no type": (
        without("type"),
        "`bearing.designation`: is missing; give it, or a `type` with all sizes, one of"
        f" {KNOWN_BEARINGS}",
    ),
    "no count": (
        without("n_rollers"),
        "`bearing.n_rollers`: is missing; it must be a whole number",
    ),
    "no pitch diameter": (
        without("pitch_diameter"),
        "`bearing.pitch_diameter`: is missing; it must be a length, a text with its"
        " unit",
    ),
    "misspelt pitch diameter": (
        TAPER.replace("pitch_diameter", "pitch_diametre"),
        "`bearing.pitch_diameter`: is missing (`pitch_diametre` is there instead); it"
        " must be a length",
    ),
    "no axis angle": (
        without("roller_axis_angle"),
        "`bearing.roller_axis_angle`: is missing",
    ),
    "arrangement of a taper": (
        TAPER + f'arrangement = "NJ"\nrib = {RIB}',
        "`bearing.arrangement`: is for cylindrical and needle rollers; others name"
        " their `ribs`",
    ),
    "rib without height": (
        TAPER + '[bearing.ribs.inner_minus]\nend_radius = "90 mm"',
        "`bearing.ribs.inner_minus.contact_height`: is missing; it must be a length",
    ),
    "broken TOML": (
        TAPER + "[operating",
        "cannot be read as TOML: Expected ']' at the end of a table declaration",
    ),
    "unquoted quantity": (
        "[bearing]\npitch_diameter = 52 mm",
        "cannot be read as TOML: Expected newline or end of document after a"
        " statement (at line 2, column 21)",
    ),
    "key twice": (
        TAPER + "n_rollers = 17",
        "cannot be read as TOML: Cannot overwrite a value",
    ),
}


@pytest.mark.parametrize("name", TEXTS)
def test_wrong_file(run, tmp_path, name):
    text, expected = TEXTS[name]
    message = one_line(run("solve", a_file(tmp_path, text)))
    assert message.startswith(f"bad.toml: {expected}")


def test_scene_file_not_utf8(run, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_bytes(b"[bearing]\nname = '\xff'")
    message = one_line(run("solve", path))
    assert message.startswith("bad.toml: cannot be read as TOML: 'utf-8' codec")


def test_missing_file(run, tmp_path):
    path = tmp_path / "none.toml"
    assert one_line(run("solve", path)) == f"{path}: no such file"


def test_folder_in_place_of_a_file(run, tmp_path):
    assert one_line(run("solve", tmp_path)).startswith(f"{tmp_path}: neither a .toml")
    folder = tmp_path / "x.toml"
    folder.mkdir()
    assert one_line(run("solve", folder)) == f"{folder}: is a folder; name a file"


def test_scene_file_without_read_permission(run, tmp_path, monkeypatch):
    path = a_file(tmp_path, TAPER)

    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(type(path), "read_text", refuse)
    assert one_line(run("solve", path)) == "bad.toml: cannot be read: Permission denied"


def test_scene_file_with_deep_nesting(run, tmp_path):
    text = TAPER + "x = " + 2000 * "[" + 2000 * "]"
    assert one_line(run("solve", a_file(tmp_path, text))).startswith("bad.toml: ")


@pytest.mark.parametrize("command", ["solve", "sweep", "optimise"])
def test_scene_of_a_contact(run, command):
    message = one_line(run(command, "taper_contact"))
    assert message == (
        "taper_contact.toml: is the scene of one contact, a [roller] on a [raceway],"
        " not of a [bearing]; `bearingjax contact taper_contact` solves it"
    )


def test_scene_file_with_byte_order_mark(tmp_path):
    """As editors of Windows write it."""
    path = tmp_path / "marked.toml"
    path.write_text(TAPER, encoding="utf-8-sig")
    assert read_scene(path).element.bearing.n_rollers == 17


@pytest.mark.parametrize(
    "unit", ["1/min", "min^-1", "min⁻¹", "r/min", "rev/min", "RPM"]
)
def test_revolutions_per_minute(unit):
    scene = read_scene("cylindrical_rig", [f"operating.inner_speed=1500 {unit}"])
    assert float(scene.speed.inner) == pytest.approx(50.0 * math.pi, rel=1e-15)


@pytest.mark.parametrize("text", ["2 Nm", "2000 N mm", "2000 Nmm", "0.002 kNm"])
def test_moment_unit_spellings(text):
    scene = read_scene("tapered", [f"operating.load.Mx={text}"])
    assert scene.load[3] == pytest.approx(2.0, rel=1e-15)


def test_name_of_no_scene(run):
    shipped = ", ".join(shipped_scenes())
    assert (
        one_line(run("solve", "cylindrical_rigg"))
        == f"cylindrical_rigg: neither a .toml file nor a shipped scene ({shipped})"
    )


@pytest.mark.parametrize("setting", ["operating.load.Fy", "=3", "a..b=3", "a b=3"])
def test_solve_rejects_malformed_setting(run, setting):
    message = one_line(run("solve", "cylindrical_rig", "--set", setting))
    start = f"cylindrical_rig.toml: {setting!r} is not a setting; write key=value, "
    assert message.startswith(start)


def test_setting_of_two_lines_is_rejected():
    """The second line went unread."""
    with pytest.raises(SceneError, match=r"points`: '7\\nmore = 8' is not a whole"):
        read_scene("cylindrical_rig", ["output.points=7\nmore = 8"])


def test_read_scene_raises_scene_error():
    with pytest.raises(SceneError, match=r"^tapered\.toml: `bearing\.n_rollers`: 0 is"):
        read_scene("tapered", ["bearing.n_rollers=0"])


def test_life_of_few_laminae():
    settings = ["life.reliability=0.95", "output.points=40"]
    with pytest.raises(SceneError, match=r"`output.points`: 40 .*odd and at least 61"):
        read_scene("tapered", settings)


@pytest.mark.parametrize("name, unit", [("dynamic_capacity", "MN"), ("static", "N")])
def test_ratings_in_another_unit(name, unit):
    name = f"{name.removesuffix('_capacity')}_capacity"
    (told,) = read_scene("life_spectrum", [f"life.{name}=23.4 {unit}"]).warnings
    assert told.startswith(f"life: `{name}` is ")
    assert told.endswith("bearings of this size have some 17 kN (another unit meant?)")


def test_errors_are_value_errors():
    with pytest.raises(ValueError, match="no such file"):
        read_scene("none.toml")


# Scene, setting, text of the message after "file: ".
SHAPED = [
    (
        "spherical",
        "type=sphericl_roller",
        "`bearing.type`: 'sphericl_roller' is not kn",
    ),
    ("spherical", "n_balls=18", "`bearing.n_balls`: unknown key (did you mean `n_rol"),
    ("spherical", "contact_angle=9.5", "`bearing.contact_angle`: 9.5 has no unit; an"),
    (
        "spherical",
        "contact_angle=0 deg",
        "[bearing]: SphericalRollerRow: `contact_angl",
    ),
    (
        "spherical",
        "contact_angle=95 deg",
        "[bearing]: SphericalRollerRow: `contact_ang",
    ),
    (
        "spherical",
        "profile_offset=1 mm",
        "`bearing.profile_offset`: unknown key; known",
    ),
    ("spherical", "staggered=yes", "`bearing.staggered`: 'yes' is not true or false"),
    (
        "spherical",
        "arrangement=NJ",
        "`bearing.arrangement`: is for cylindrical and need",
    ),
    (
        "spherical",
        "pitch_diameter=130 mm",
        "[bearing]: SphericalRollerRow: `outer_raceway_radius` is 0.0805 m; it must be"
        " 0.0766588 m to 1 %, which puts the centre of the sphere on the axis",
    ),
    (
        "spherical",
        "inner_raceway_radius=78 mm",
        "[bearing]: SphericalRollerRow: `inner_raceway_radius` is 0.078 m; it must be"
        " at least `roller_profile_radius`, 0.078085 m",
    ),
    (
        "spherical",
        "roller_profile_radius=0 mm",
        "[bearing]: SphericalRollerRow: `roller_profile_radius` is 0 m; it must be",
    ),
    (
        "spherical",
        "roller_profile_radius=9 mm",
        "[bearing]: SphericalRollerRow: `roller_profile_radius` is 0.009 m; it must be"
        " above half the roller length, 0.00925 m",
    ),
    (
        "thrust",
        "radial_internal_clearance=20 um",
        "[bearing]: CylindricalThrustRollerBearing: `radial_internal_clearance` is"
        " 2e-05 m; it must be 0 m: a thrust bearing of one direction",
    ),
    (
        "thrust",
        "n_rollers=30",
        "[bearing]: CylindricalThrustRollerBearing: `n_rollers` is 30 rollers; it must"
        " be low enough that rollers do not overlap",
    ),
    (
        "thrust",
        "staggered=true",
        "`bearing.staggered`: unknown key; known in [bearing]",
    ),
    (
        "thrust",
        "contact_angle=9 deg",
        "`bearing.contact_angle`: unknown key; known in ",
    ),
    (
        "thrust",
        "type=spherical_thrust_roller",
        "`bearing.roller_profile_radius`: is missing",
    ),
    ("thrust", "type=tapered_thrust_roller", "`bearing.roller_axis_angle`: is missing"),
    (
        "crossed",
        "n_rollers=41",
        "[bearing]: CrossedRollerRow: `n_rollers` is 41 rollers; it must be even: every"
        " other roller is turned",
    ),
    (
        "crossed",
        "roller_length=15 mm",
        "[bearing]: CrossedRollerRow: `roller_length` is 0.015 m; it must be at most"
        " the roller diameter, 0.014 m",
    ),
    (
        "crossed",
        f"ribs.inner_minus={RIB}",
        "`bearing.ribs`: is for others; crossed rol",
    ),
]


@pytest.mark.parametrize("kind, setting, message", SHAPED)
def test_wrong_barrels_thrust_and_crossed_rollers(kind, setting, message):
    with pytest.raises(SceneError) as caught:
        read_scene(f"{kind}_roller", [f"bearing.{setting}"])
    assert str(caught.value).startswith(f"{kind}_roller.toml: {message}")


TYPES = {
    "toroidal": """
        pitch_diameter = "140 mm"
        roller_diameter = "19.5 mm"
        roller_length = "30 mm"
        roller_profile_radius = "407.4 mm"
        outer_raceway_radius = "420 mm"
        inner_raceway_radius = "420 mm"
        """,
    "spherical_thrust": """
        pitch_diameter = "120 mm"
        roller_diameter = "22 mm"
        roller_length = "26 mm"
        contact_angle = "50 deg"
        roller_profile_radius = "100 mm"
        inner_raceway_radius = "104 mm"
        profile_offset = "2 mm"
        """,
    "tapered_thrust": """
        pitch_diameter = "120 mm"
        roller_diameter = "14 mm"
        roller_length = "20 mm"
        roller_axis_angle = "83 deg"
        roller_half_angle = "6.7 deg"
        """,
}

TYPED = [
    (
        *("toroidal", "bearing.outer_raceway_radius=400 mm"),
        "[bearing]: ToroidalRollerBearing: `outer_raceway_radius` is 0.4 m; it must be"
        " at least `roller_profile_radius`, 0.4074 m",
    ),
    (
        *("toroidal", "bearing.outer_raceway_radius=-420 mm"),
        "[bearing]: ToroidalRollerBearing: `outer_raceway_radius` is -0.42 m; it must",
    ),
    (
        *("toroidal", "bearing.roller_profile_radius=14 mm"),
        "[bearing]: ToroidalRollerBearing: `roller_profile_radius` is 0.014 m; it must"
        " be above half the roller length, 0.015 m",
    ),
    (
        *("toroidal", "bearing.n_rollers=30"),
        "[bearing]: ToroidalRollerBearing: `n_rollers` is 30 rollers; it must be low",
    ),
    (
        "toroidal",
        "bearing.contact_angle=10 deg",
        "`bearing.contact_angle`: unknown key",
    ),
    ("toroidal", "bearing.staggered=true", "`bearing.staggered`: unknown key"),
    (
        *("spherical_thrust", "bearing.pitch_diameter=0 mm"),
        "[bearing]: SphericalThrustRollerBearing: `pitch_diameter` is 0 m; it must be",
    ),
    (
        *("spherical_thrust", "bearing.contact_angle=0 deg"),
        "[bearing]: SphericalThrustRollerBearing: `contact_angle` is 0 rad; it must be",
    ),
    (
        *("spherical_thrust", "bearing.radial_internal_clearance=10 um"),
        "[bearing]: SphericalThrustRollerBearing: `radial_internal_clearance` is 1e-05",
    ),
    (
        *("spherical_thrust", "bearing.profile_offset=14 mm"),
        "[bearing]: SphericalThrustRollerBearing: `profile_offset` is 0.014 m; it",
    ),
    (
        *("spherical_thrust", "bearing.outer_raceway_radius=150 mm"),
        "[bearing]: SphericalThrustRollerBearing: `outer_raceway_radius` is 0.15 m; it"
        " must be 0.104603 m to 1 %, which puts the centre of the sphere on the axis",
    ),
    (
        *("tapered_thrust", "bearing.roller_axis_angle=85 deg"),
        "[bearing]: TaperedThrustRollerBearing: `roller_half_angle` is 0.116937 rad; it"
        " must be above 45° and at most 90° with `roller_axis_angle` added",
    ),
    (
        *("tapered_thrust", "bearing.roller_axis_angle=30 deg"),
        "[bearing]: TaperedThrustRollerBearing: `roller_half_angle` is 0.116937 rad;",
    ),
    (
        *("tapered_thrust", "bearing.radial_internal_clearance=5 um"),
        "[bearing]: TaperedThrustRollerBearing: `radial_internal_clearance` is 5e-06 m",
    ),
]


@pytest.mark.parametrize("kind, setting, message", TYPED)
def test_wrong_toroidal_and_thrust_bearings(tmp_path, kind, setting, message):
    path = a_file(
        tmp_path,
        f'[bearing]\ntype = "{kind}_roller"\nn_rollers = 14\n'
        f'{TYPES[kind]}\n[operating]\nload = {{ Fx = "0 N" }}\n',
    )
    read_scene(path)
    with pytest.raises(SceneError) as caught:
        read_scene(path, [setting])
    assert str(caught.value).split(": ", 1)[1].startswith(message)


@pytest.mark.parametrize("kind", ["spherical", "crossed"])
def test_bearings_of_two_rows_are_in_no_set(kind):
    told = f"`set`: a {kind} roller bearing has both its rows already"
    with pytest.raises(SceneError, match=told):
        read_scene(f"{kind}_roller", ["set.arrangement=tandem"])
    row = read_scene(f"{kind}_roller").inputs["bearing"]
    row.pop("staggered", None)
    text = ", ".join(
        f"{key} = {value if isinstance(value, int) else repr(value)}"
        for key, value in row.items()
        if not isinstance(value, dict)
    )
    rows = f"set={{arrangement='rows', rows=[{{position='0 mm', bearing={{{text}}}}}]}}"
    told = rf"`set.rows\[0\].bearing`: a {kind} roller bearing is no row of a set"
    with pytest.raises(SceneError, match=told):
        read_scene("cylindrical_rig", [rows])


def test_a_sphere_or_a_pitch_diameter_is_needed(tmp_path):
    text = shipped_scenes()["spherical_roller"].read_text("utf-8")
    text = re.sub("(?m)^outer_raceway_radius.*$", "", text)
    told = "`bearing.pitch_diameter`: is missing, and so is `outer_raceway_radius`; one"
    with pytest.raises(SceneError, match=told):
        read_scene(a_file(tmp_path, text))


BAD_UNITS = [
    # pint ends in its tokenizer's errors, assertions and divisions by zero
    "bearing.pitch_diameter=72.5 (mm",
    "bearing.pitch_diameter=72.5 mm/",
    "bearing.pitch_diameter=72.5 mm^",
    "bearing.pitch_diameter=72.5 $",
    "bearing.pitch_diameter='72.5 #'",
    "bearing.pitch_diameter=72.5 mm^(1/0)",
    """bearing.pitch_diameter="5 '\"""",
    # pint counts 1/s, Bq and baud as rad/s, 2 pi from what is meant
    "operating.inner_speed=25 1/s",
    "operating.inner_speed=25 s^-1",
    "operating.inner_speed=25 Bq",
    "operating.inner_speed=25 baud",
    # to pint every dimensionless unit is an angle
    "bearing.first_azimuth=5 percent",
    "bearing.first_azimuth=5 count",
    "bearing.first_azimuth=5 bit",
    "bearing.first_azimuth=5 sr",
    # pint drops what it cannot read: '1 mm', '!', '{}', '#'
    "bearing.pitch_diameter=72.5 1 mm",
    "bearing.pitch_diameter=72.5 mm!",
    "bearing.pitch_diameter=72.5 {mm}",
]


@pytest.mark.parametrize("setting", BAD_UNITS)
def test_read_scene_rejects_invalid_units(setting):
    with pytest.raises(SceneError, match=setting.split("=")[0].replace(".", r"\.")):
        read_scene("cylindrical_rig", [setting])


@pytest.mark.parametrize(
    "key, meant",
    [
        ("arangement", "arrangement"),
        ("ring_materal", "ring_material"),
        ("axial_internal_clearence", "axial_internal_clearance"),
    ],
)
def test_key_of_a_choice_is_suggested(key, meant):
    with pytest.raises(SceneError, match=rf"did you mean `{meant}`"):
        read_scene("cylindrical_rig", [f"bearing.{key}=x"])


def test_wrong_case_is_suggested():
    with pytest.raises(SceneError, match="did you mean `Fy`"):
        read_scene("cylindrical_rig", ["operating.load.fy=-1 kN"])


def test_key_of_two_lines_makes_one_line(run, tmp_path):
    text = TAPER + '"two\\nlines" = 1'
    assert "unknown key" in one_line(run("solve", a_file(tmp_path, text)))


@pytest.mark.parametrize(
    "key, digits",
    [("n_rollers", 400), ("material.poisson_ratio", 400), ("n_rollers", 5000)],
)
def test_huge_integer(run, key, digits):
    setting = f"bearing.{key}={'9' * digits}"
    one_line(run("solve", "cylindrical_rig", "--set", setting))


def test_message_article_before_angle():
    with pytest.raises(SceneError, match="; an angle with its unit is wanted"):
        read_scene("cylindrical_rig", ["bearing.first_azimuth=90"])


def test_number_for_a_material_names_the_materials():
    with pytest.raises(SceneError, match="steel, silicon_nitride, zirconia"):
        read_scene("cylindrical_rig", ["bearing.material=206"])


def test_text_for_freedoms_names_the_freedoms():
    with pytest.raises(SceneError, match="ux, uy, uz, gx, gy"):
        read_scene("cylindrical_rig", ["operating.free=ux uy"])

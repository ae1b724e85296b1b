"""Sizes of warnings: numbers of a solution that may be too large, and where.

They use only what NumPy and JAX share. A sweep works them out within its compiled
program, `warnings` in NumPy, without compiling anything.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import design
from ..design.abstract import nearest_entry
from ..design.bearing_set import bearings_of, is_self_aligning
from ..design.material import contact_modulus
from ..element import FREEDOMS, RINGS, Linearised
from ..numerics.types import array_namespace
from .balls import above_round_off
from .rollers import EDGE_PRESSURE
from .solution import LARGEST_PRESSURE as LARGEST_PRESSURE
from .solution import BallSolution, RollerSolution, Solution

SOFTEST = 1e-7
"""Stiffness over E* D up to which a direction counts as free [1]: a tenth of the lowest
tilt stiffness of a bearing under 0.1 N."""

SOFTEST_SHIFT = 3e-5
"""Limit as `SOFTEST` for x, y and z only: the stiffness under less than 1e-6 N, a
residual force of the solver where there is no load."""

_ROUND_OFF = 1e-9
"""Stiffness up to which a direction counts as free, over the largest stiffness [1]."""

LARGEST_TILT_ERROR = 0.03
"""Largest error of small rotations, over the largest approach [1]."""

USUAL_TILT_OF_ROLLERS, USUAL_TILT_OF_BALLS = math.radians(4 / 60), math.radians(10 / 60)
"""Largest tilt of ring against ring that makers allow for [rad], 4' and 10'.

Source: catalogues: cylindrical rollers 3' to 4', tapered rollers 2' to 4', deep groove
    ball bearings 2' to 10'. Upper ends, rough ones.
"""

USUAL_TILT_OF_TOROIDAL_ROLLERS = math.radians(0.5)
"""Largest tilt of toroidal roller bearings that SKF allows for [rad] (catalogue)."""

_USUAL_TILTS = {
    design.AbstractBallBearing: USUAL_TILT_OF_BALLS,
    design.AbstractRollerBearing: USUAL_TILT_OF_ROLLERS,
    design.ToroidalRollerBearing: USUAL_TILT_OF_TOROIDAL_ROLLERS,
    design.SphericalThrustRollerBearing: math.inf,
}

_STATIC_LIMITS = {
    design.AbstractBallBearing: 4200e6,
    design.SelfAligningBallRow: 4600e6,
    design.AbstractRollerBearing: 4000e6,
}
"""Contact pressures of the basic static load rating by class [Pa]."""

LARGEST_RADIAL_SHARE = 0.55
"""Radial over axial load of a spherical roller thrust bearing above which SKF asks for
another bearing beside it [1]: some rollers then run without load."""

LARGEST_SPEED = 1e6
"""n·dm, speed times pitch diameter [mm/min].

Source: upper end of tables for greases of rolling bearings, and for oil baths.
"""

LARGEST_WIDTH, LARGEST_ELLIPSE = 0.1, 0.4
"""Half width over the relative radius of rollers; semi-axis over the ball radius [1].

Source: Johnson, Contact Mechanics (1985), section 4.1: strains are of the order of
    half width over radius. At 0.4 of a ball's radius the fourth order of the circles of
    ball and groove, (x²/4)(1/R² + 1/(R r) + 1/r²) of the second, is a tenth.
"""

LARGEST_ANGLE = math.radians(75.0)
"""Largest angle of a contact from the middle of its raceway [rad]. A shoulder that
reaches so far is 0.39 ball diameters high: twice the usual, and more than any."""

LAND_SHARE = 0.05
"""Share of a contact's load beyond the groove bottom that gives a warning [1]."""
SMALLEST_LOAD = 0.05
"""Load of a contact over the largest one up to which it does not matter where it lies
[1]: of a lifted ball its centrifugal force, which is more than it would carry at rest.
The share of such contacts in the fatigue of a raceway, by the cube of the load, is
about 1e-4."""

_PLAUSIBLE = {
    "pitch_diameter": (1e-3, 15.0, "m"),
    "ball_diameter": (1e-4, 0.5, "m"),
    "roller_diameter": (1e-4, 0.5, "m"),
    "roller_length": (1e-4, 1.0, "m"),
    "elastic_modulus": (1e9, 1.2e12, "Pa"),
    "density": (500.0, 25e3, "kg/m³"),
}
"""Usual ranges: from miniature to slewing bearings, from polymers to hard metal."""


def stiffness_scale(bearing: design.AbstractBearing | design.BearingSet) -> Any:
    """E* times the diameter of the rolling elements, the least of all rows [N/m]."""
    scales = [
        _modulus(row.bearing) * _diameter(row.bearing)
        for row in design.rows_of(bearing)
    ]
    least = scales[0]
    for scale in scales[1:]:
        least = array_namespace(scale).minimum(least, scale)
    return least


def _modulus(bearing):
    return contact_modulus(bearing.material, bearing.rings)


def _diameter(bearing):
    return getattr(bearing, f"{bearing.noun}_diameter")


def _of_balls(solution: Solution) -> BallSolution:
    """The solution, of a ball bearing: warnings about balls arise for no other."""
    assert isinstance(solution, BallSolution)
    return solution


def _of_rollers(solution: Solution) -> RollerSolution:
    """The solution, of a roller bearing: warnings about rollers arise for no other."""
    assert isinstance(solution, RollerSolution)
    return solution


def _by_row(solution: Solution, values: Any) -> Iterator[tuple[Any, Any]]:
    """(bearing, values of its rolling elements) of every row."""
    ends = np.cumsum(solution.row_sizes)
    for row, count, end in zip(
        design.rows_of(solution.element.bearing), solution.row_sizes, ends, strict=True
    ):
        yield row.bearing, values[int(end) - count : int(end)]


def _largest_number(solution, numbers):
    xp = array_namespace(solution.result)
    return xp.max(xp.stack([xp.asarray(number) for number in numbers]))


def _ones(solution, flags):
    """1 where flags are set, 0 elsewhere."""
    return array_namespace(solution.result).where(flags, 1.0, 0.0)


def number_ranges(numbers: Any) -> str:
    """Rising whole numbers in words: "0 to 2, 10, 11"."""
    found = np.asarray(numbers, dtype=int)
    runs = np.split(found, np.flatnonzero(np.diff(found) != 1) + 1)
    return ", ".join(
        f"{run[0]} to {run[-1]}" if run.size > 2 else ", ".join(map(str, run))
        for run in runs
        if run.size
    )


def name_by_number(noun: str, numbers: Any) -> str:
    """Some of several by their numbers, in words: "roller 2", "balls 0 to 3"."""
    return f"{noun}{'' if len(numbers) == 1 else 's'} {number_ranges(numbers)}"


def of_raceways(solution: Solution, flags: Any) -> str:
    """Raceways and rolling elements where `flags` (element, 2) are set, in words."""
    noun = solution.element.bearing.noun
    return "; ".join(
        f"{ring} raceway: {name_by_number(noun, np.flatnonzero(mine))}"
        for ring, mine in zip(RINGS, np.asarray(flags).T, strict=True)
        if mine.any()
    )


def _free_stiffness(solution):
    """Stiffness of the free freedoms, all in N/m, and how much counts as none [N/m]."""
    xp = array_namespace(solution.result)
    first = 6 * RINGS.index(solution.moving_ring)
    radius = xp.where(solution.pitch_radius > 0, solution.pitch_radius, 1.0)
    # Rotations times the pitch radius.
    turns = xp.asarray([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], dtype=radius.dtype)
    scale = (1.0 - turns) + turns / radius
    k = solution.stiffness[first : first + 6, first : first + 6]
    k = 0.5 * scale[None, :] * (k + k.T) * scale[:, None]
    # Elements that just touch, where the ring came to rest, hold it to one side only.
    across = _free_shift(solution)
    rest = xp.eye(6, dtype=k.dtype) - across[:, None] * across[None, :]
    k = rest @ k @ rest
    index = np.array([FREEDOMS.index(name) for name in solution.free], dtype=int)
    scale = stiffness_scale(solution.element.bearing)
    nothing = xp.maximum(_ROUND_OFF * abs(k).max(), SOFTEST * scale)
    return k[np.ix_(index, index)], nothing


def _free_shift(solution):
    """Unit vector (6,) of a free shift at right angles to all loaded elements; zero if
    there is none, or finite kinematics, in which a shift across an element lifts it."""
    xp = array_namespace(solution.result)
    loaded = _ones(solution, solution.load_zone)
    double = 2.0 * solution.azimuth
    x, y = (loaded * xp.cos(double)).sum(), (loaded * xp.sin(double)).sum()
    along, count = 0.5 * xp.arctan2(y, x), loaded.sum()
    shift = xp.stack([-xp.sin(along), xp.cos(along)])
    # Of azimuths that differ by 1e-6 rad the sum of squares across is 1e-12.
    one_line = (count > 0) & (0.5 * (count - xp.hypot(x, y)) <= 1e-12 * count)
    linearised = isinstance(solution.element.kinematics, Linearised)
    for part, name in zip(shift, FREEDOMS, strict=False):
        free = linearised and name in solution.free
        one_line = one_line & (free | (abs(part) <= 1e-6))
    shift = shift * _ones(solution, one_line)
    return xp.concatenate([shift, xp.zeros(4, shift.dtype)])


def unrestrained_directions(solution: Solution) -> Any:
    """Number of free directions without stiffness, but of elements that just touch.

    Source: Sylvester's law of inertia: as many pivots are negative as eigenvalues.
    """
    xp = array_namespace(solution.result)
    k, nothing = _free_stiffness(solution)
    n = len(solution.free)
    k = k - nothing * xp.eye(n, dtype=k.dtype)
    count = xp.zeros((), k.dtype)
    for i in range(n):
        pivot = k[i, i]
        count = count + _ones(solution, pivot <= 0)
        k = k - k[:, i, None] * k[None, i] / xp.where(pivot == 0, 1.0, pivot)
    return count


def loose_names(solution: Solution) -> str:
    """Directions without stiffness, each by the freedom that moves most in it."""
    k, nothing = _free_stiffness(solution)
    values, vectors = np.linalg.eigh(k)
    names = {
        solution.free[int(np.abs(vectors[:, i]).argmax())]
        for i in np.flatnonzero(values <= nothing)
    }
    listed = ", ".join(name for name in FREEDOMS if name in names)
    return f"{listed} of the {solution.moving_ring} ring"


def unloaded_rows(solution: Solution) -> Any:
    """Number of rows that carry no load while others do."""
    load = solution.roller_load.min(axis=1)
    tops = [part.max() for _, part in _by_row(solution, load)]
    most = _largest_number(solution, tops)
    return sum(_ones(solution, (top <= 1e-9 * most) & (most > 0)) for top in tops)


def idle_numbers(solution: Solution) -> str:
    """Rows that `unloaded_rows` counts, in words."""
    load = solution.roller_load.min(axis=1)
    tops = [part.max() for _, part in _by_row(solution, load)]
    idle = [k for k, top in enumerate(tops) if top <= 1e-9 * max(tops)]
    return f"row {number_ranges(idle)}"


def slack_springs(solution: Solution) -> Any:
    """Number of springs that have lost their force."""
    slack = (solution.spring_force == 0) & (solution.spring_travel != 0)
    return _ones(solution, slack).sum()


def slack_numbers(solution: Solution) -> str:
    """Rows whose springs `slack_springs` counts, in words."""
    slack = (solution.spring_force == 0) & (solution.spring_travel != 0)
    return f"row {number_ranges(np.flatnonzero(slack))}"


def static_limit(bearing: design.AbstractBearing | design.BearingSet) -> float:
    """Contact pressure of the basic static load rating [Pa].

    Source: ISO 76:2006, 3.2 and 3.3.
    """
    return min(nearest_entry(_STATIC_LIMITS, row) for row in bearings_of(bearing))


def widths(solution: Solution) -> Any:
    """Largest half width over the relative radius ρ, 2 p/E*, of rollers [1]."""
    parts = [
        2.0 * pressure.max() / _modulus(bearing)
        for bearing, pressure in _by_row(solution, solution.roller_pressure)
    ]
    return _largest_number(solution, parts)


def ellipses(solution: Solution) -> Any:
    """Largest semi-axis over the radius of the ball [1]."""
    parts = [
        2.0 * axes.max() / bearing.ball_diameter
        for bearing, axes in _by_row(solution, _of_balls(solution).semi_axes)
    ]
    return _largest_number(solution, parts)


def groove_angles(solution: Solution) -> Any:
    """Largest angle of a loaded contact from the middle of its raceway [rad]."""
    balls = _of_balls(solution)
    loads = _by_row(solution, balls.contact_load)
    angles = _by_row(solution, balls.contact_angle)
    least = 1e-9 * balls.contact_load.max()
    parts = [
        _ones(solution, load > least) * abs(angle - bearing.groove_axis)
        for (bearing, load), (_, angle) in zip(loads, angles, strict=True)
    ]
    return _largest_number(solution, [part.max() for part in parts])


def tilt_error(solution: Solution) -> Any:
    """Error of small rotations, R γ²/2, relative to the quantity in error [1].

    With prescribed tilts that is the approach of the contacts, and loads err by about
    as much. Free tilts adjust to the load, so that it is the motion R γ.
    """
    xp = array_namespace(solution.result)
    q, radius = solution.displacement, solution.pitch_radius
    square = (q[9] - q[3]) ** 2 + (q[10] - q[4]) ** 2
    if isinstance(solution, BallSolution):
        approach = solution.approach.max()
    else:
        approach = _line_approach(solution)
    pressed = approach > 0
    size = approach
    if {"gx", "gy"} <= set(solution.free):
        size = xp.maximum(approach, radius * square**0.5)
    share = 0.5 * radius * square / xp.where(pressed, size, 1.0)
    return xp.where(pressed, share, 0.0)


def _line_approach(solution):
    """About the largest approach of a contact of rollers [m].

    By Palmgren's law, 2.5 b²/ρ, half width b = 2 p ρ/E*.
    """
    return _largest_number(
        solution,
        [
            5.0 * _diameter(bearing) * (pressure.max() / _modulus(bearing)) ** 2
            for bearing, pressure in _by_row(solution, solution.roller_pressure)
        ],
    )


def travel_error(solution: Solution) -> Any:
    """Error of linearised kinematics of barrel rollers by travel along them [1].

    With A = r_o + r_i - D, the distance of the centres of both raceway arcs, and their
    travel w across it, contacts approach by w²/(2 A), here over the largest approach,
    and turn by w/A, here over the contact angle, as the axial force does. Rollers of a
    spherical bearing go with a tilted inner ring, and a radial load F across the tilt γ
    gets the axial part F γ, to be added to it with the factor Y0 = 0.44 cot α.
    """
    xp = array_namespace(solution.result)
    q, shares = solution.displacement, []
    approach = 2.0 * _line_approach(solution)
    pressed = approach > 0
    for row in design.rows_of(solution.element.bearing):
        b: Any = row.bearing
        _, outer, inner = b.arc_radii
        sin, cos, half = (
            xp.sin(b.axis_angle),
            xp.cos(b.axis_angle),
            b.roller_diameter / 2,
        )
        sign = -1.0 if row.mirrored else 1.0
        travel, levers = [], []
        for side, radius, ring in ((-1.0, outer, q[:6]), (1.0, inner, q[6:])):
            # Centre of the arc in (z, r), and the travel of a ring that turns about O.
            beyond = side * (radius - half)
            z = b.axial_place + sign * row.position + beyond * sin
            lever = cos * (b.pitch_diameter / 2 + beyond * cos) + sin * z
            # About the centre of the sphere nothing else moves.
            levers.append(0.0 if b.aligns else side * sign * lever)
            travel.append(side * xp.stack([ring[0], ring[1], ring[2]]))
        x, y, along = travel[0] + travel[1]
        gx = levers[0] * q[3] + levers[1] * q[9]
        gy = levers[0] * q[4] + levers[1] * q[10]
        around = (sin * x + gy) ** 2 + (sin * y - gx) ** 2
        across = abs(cos * along) + around**0.5
        turned = across / (outer + inner - b.roller_diameter)
        slope = xp.where(sin > 0, sin / cos, 1.0)
        closed = 0.5 * across * turned / xp.where(pressed, approach, 1.0)
        f, tilted = solution.force[6:8], 0.0
        if b.aligns:
            size = xp.sum(xp.abs(f))
            across = abs(f[0] * q[10] - f[1] * q[9]) / xp.where(size > 0, size, 1.0)
            tilted = 0.44 / slope * across
        shares.append(closed + turned / slope + tilted)
    return xp.where(pressed, _largest_number(solution, shares), 0.0)


def free_tilt(solution: Solution) -> Any:
    """Tilt that follows from the load alone, over the limit of makers [1]."""
    mine = 6 * RINGS.index(solution.moving_ring)
    free = [FREEDOMS.index(name) for name in ("gx", "gy") if name in solution.free]
    square = sum(solution.displacement[mine + k] ** 2 for k in free)
    return _ones(solution, True) * square**0.5 / usual_tilt(solution.element.bearing)


def prescribed_tilt(solution: Solution) -> Any:
    """Tilt of ring against ring that is prescribed, over that which makers allow for
    [1]."""
    q = solution.displacement
    held = [FREEDOMS.index(name) for name in ("gx", "gy") if name not in solution.free]
    square = sum((q[6 + k] - q[k]) ** 2 for k in held)
    return _ones(solution, True) * square**0.5 / usual_tilt(solution.element.bearing)


def usual_tilt(bearing: design.AbstractBearing | design.BearingSet) -> float:
    """Largest tilt of ring against ring that makers allow for [rad].

    None of bearings with a spherical raceway: their rings tilt freely.
    """
    if is_self_aligning(bearing):
        return math.inf
    return min(nearest_entry(_USUAL_TILTS, row) for row in bearings_of(bearing))


def tilt_in_words(solution: Solution, share: Any) -> str:
    """A tilt and what makers allow for.

    Args:
        solution: Concrete.
        share: The tilt over that which they allow for [1].
    """
    allowed = usual_tilt(solution.element.bearing)
    tilt = float(share) * allowed
    kind = solution.element.bearing.noun
    return (
        f"{1e3 * tilt:.3g} mrad where makers of {kind} bearings allow for about"
        f" {1e3 * allowed:.2g}"
    )


def has_clearance(bearing: design.AbstractBearing | design.BearingSet) -> bool:
    """Whether it has a radial clearance of its own: a single bearing, one that does not
    need another to be set against."""
    rows = design.rows_of(bearing)
    row = rows[0].bearing
    if len(rows) > 1 and not is_self_aligning(bearing):
        return False
    if isinstance(row, design.AbstractBallBearing):
        return not row.is_one_sided
    kinds = design.CylindricalRollerBearing | design.NeedleRollerBearing
    return isinstance(
        row, kinds | design.SphericalRollerRow | design.ToroidalRollerBearing
    )


def radial_share(solution: Solution) -> Any:
    """Radial over axial load of the moving ring [1]."""
    xp = array_namespace(solution.result)
    first = 6 * RINGS.index(solution.moving_ring)
    x, y, z = (solution.force[first + k] for k in range(3))
    # Without load there is none, of a radial load alone it is endless.
    radial = xp.hypot(x, y)
    return radial / xp.where(radial > 0, abs(z), 1.0)


def clearance_lost(solution: Solution) -> Any:
    """Radial clearance below zero of a bearing that turns [m]."""
    assert solution.speed is not None
    row: Any = design.rows_of(solution.element.bearing)[0].bearing
    clearance = row.clearance if row.is_ball else row.radial_internal_clearance
    turns = solution.speed.inner != solution.speed.outer
    return -clearance * _ones(solution, turns)


def speed_factor(solution: Solution) -> Any:
    """n·dm, n of one ring against the other [mm/min]."""
    assert solution.speed is not None
    turns = abs(solution.speed.inner - solution.speed.outer) * (30.0 / math.pi)
    return turns * (2e3 * solution.pitch_radius)


def _implausible(bearing):
    """(name, value, unit, implausible) of every design value with a usual range."""
    materials = [bearing.material]
    if bearing.ring_material is not None:
        materials.append(bearing.ring_material)
    for owner in (bearing, *materials):
        for name, (low, high, unit) in _PLAUSIBLE.items():
            value = getattr(owner, name, None)
            if value is not None:
                yield name, value, unit, (value < low) | (value > high)


def implausible_dimensions(solution: Solution) -> Any:
    """Number of design values far outside their usual ranges."""
    rows = design.rows_of(solution.element.bearing)
    found = [strange for row in rows for *_, strange in _implausible(row.bearing)]
    return sum(_ones(solution, flag) for flag in found)


def odd_names(solution: Solution) -> str:
    """Numbers that `implausible_dimensions` counts, in words."""
    rows = design.rows_of(solution.element.bearing)
    found = [part for row in rows for part in _implausible(row.bearing)]
    return ", ".join(
        dict.fromkeys(
            f"{n} {float(v):.4g} {unit}" for n, v, unit, strange in found if strange
        )
    )


def interference(solution: Solution) -> Any:
    """Largest interference of a rib and the roller ends, unloaded [m]."""
    every: Any = [row.bearing for row in design.rows_of(solution.element.bearing)]
    gaps = [getattr(b.ribs, n).axial_gap for b in every for n in b.ribs.present]
    return _largest_number(solution, [-gap for gap in gaps])


def truncation(solution: Solution) -> Any:
    """Largest reach of a contact ellipse over its shoulder, negative: none [m]."""
    return -_margins(solution).min()


def _margins(solution):
    """`BallResults.shoulder_margin` of contacts that matter, else infinite [m]."""
    balls, xp = _of_balls(solution), array_namespace(solution.result)
    return xp.where(matters(balls.contact_load), balls.shoulder_margin, xp.inf)


def matters(load: Any) -> Any:
    """Whether each load is above `SMALLEST_LOAD` of the largest of its bearing.

    What lies in the unloaded zone, thrown outwards, may lie anywhere.

    Args:
        load: (element, contact) [N], of NumPy or of JAX.
    """
    return load > SMALLEST_LOAD * load.max()


def truncated_balls(solution: Solution) -> str:
    """Raceways and balls whose ellipse reaches over a shoulder, and their load."""
    balls, margin = _of_balls(solution), _margins(solution)
    most = np.asarray(balls.contact_load)[margin < 0].max()
    sides = margin.reshape(margin.shape[0], 2, -1).min(axis=2)
    where = of_raceways(solution, sides < 0)
    return f"contact load of up to {most:.5g} N; {where}"


def load_beyond_groove(solution: Solution) -> Any:
    """Whether balls carry more than `LAND_SHARE` of a load beyond the bottom of their
    groove (ball, 2).

    There the raceway continues as a cylinder, whose normal has no axial component.
    Of a Hertzian contact that is cut at x of its half-length from the middle, the share
    1/2 - 3x/4 + x³/4 lies beyond; in the middle, and past it, one half is counted.
    """
    balls, xp, parts = _of_balls(solution), array_namespace(solution.result), []
    carrying = matters(balls.contact_load)
    # An open ellipse has no length.
    half = xp.where(carrying, balls.semi_axes[..., 1], 1.0)
    cut = xp.where(carrying, balls.contact_angle / half, xp.inf)
    for bearing, of_row in _by_row(solution, cut):
        sides = of_row.reshape(of_row.shape[0], 2, -1).min(axis=2)
        if not isinstance(bearing, design.AngularContactBallBearing):
            parts.append(sides < -xp.inf)
            continue
        osculations = xp.stack([bearing.outer_osculation, bearing.inner_osculation])
        radii = (osculations * bearing.ball_diameter)[None, :]
        x = xp.clip(sides * radii, 0.0, 1.0)
        share = 0.5 - 0.75 * x + 0.25 * x**3
        parts.append(share > LAND_SHARE)
    return xp.concatenate(parts)


def on_land_count(solution: Solution) -> Any:
    """Number of balls that `load_beyond_groove` marks."""
    return _ones(solution, load_beyond_groove(solution).any(axis=1)).sum()


def balls_off_inner_ring(solution: Solution) -> Any:
    """Whether each ball runs on the outer raceway only, pressed there by a centrifugal
    force that is not small compared with the loads (ball,).

    Outside the load zone balls lie on the outer raceway at any speed.
    """
    balls = _of_balls(solution)
    load, force = balls.contact_load, balls.centrifugal_force
    assert force is not None  # this warning arises at a speed alone
    carrying = above_round_off(load).reshape(load.shape[0], 2, -1).any(axis=2)
    return carrying[:, 0] & ~carrying[:, 1] & (force > SMALLEST_LOAD * load.max())


def lifted_count(solution: Solution) -> Any:
    """Number of balls that `balls_off_inner_ring` marks."""
    return _ones(solution, balls_off_inner_ring(solution)).sum()


def edge_pressure(solution: Solution) -> Any:
    """Largest pressure at the end of a roller that passes a load that `matters` [Pa].

    A roller that lies on one raceway, pressed there by its own inertia, is free to lie
    flat.
    """
    rollers = _of_rollers(solution)
    return _end_pressures(rollers, rollers.edge_pressure).max()


def _end_pressures(rollers, pressure):
    """Pressures (roller, 2, end) of rollers that pass a load, 0 of others [Pa]."""
    load = rollers.roller_load
    passes = load.min(axis=1) > SMALLEST_LOAD * load.max()
    return array_namespace(pressure).where(passes[:, None, None], pressure, 0.0)


def ends_over(solution: Solution) -> Any:
    """Whether ends of rollers that pass a load are edge-loaded (roller, 2, end)."""
    rollers = _of_rollers(solution)
    return _end_pressures(rollers, rollers.edge_pressure) > EDGE_PRESSURE

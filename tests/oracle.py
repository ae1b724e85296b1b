"""Independent reference for roller bearings: plain NumPy, slice by slice.

Written from the formulas alone, for clarity rather than speed; it shares nothing with
the package. Every slice and every rib is one affine gap of the section motions
(u, v, theta) of its ring and of the roller, counted at the point O on the bearing axis:

    gap = gap_0 + n . (displacement of the ring - displacement of the roller),
    displacement of a section point (z, r) = (u - r theta, v + z theta),

with the energy w C m^(n+1)/(n+1), m = max(-gap, 0). A roller rests where the sum is
least. Directions that no contact holds carry no stiffness and are left alone.

Sources: Sorokin, Zhang, Ivannikov (2018), Izv. vuzov. Mashinostroenie no. 3, 14-23
(energy model); De Mul, Vree, Maas (1989), J. Tribology 111, 142-155 (sections).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np

RIBS = ("outer_minus", "outer_plus", "inner_minus", "inner_plus")
LINE, POINT = 10 / 9, 3 / 2
LOOSE = 1e-15  # A roller pressed less than this everywhere touches nothing [m].


@dataclass
class OracleBearing:
    """A bearing in plain numbers.

    Attributes:
        n_rollers: Number of rollers.
        pitch_diameter, roller_diameter, roller_length: [m].
        line_constant: C of the outer and of the inner contact [N/m^(19/9)].
        roller_axis_angle, roller_half_angle: [rad].
        clearance: Diametral clearance; a quarter stands at each raceway [m].
        first_azimuth: [rad].
        drop_outer, drop_inner: Total drop of roller and raceway [m] at s [m].
        kinks: Positions s of kinks of the drops [m] (for graded slices only).
        ribs: name -> (end_radius [m], contact_height [m], axial_gap [m],
            rib_constant [N/m^(3/2)]).
    """

    n_rollers: int
    pitch_diameter: float
    roller_diameter: float
    roller_length: float
    line_constant: tuple
    roller_axis_angle: float = 0.0
    roller_half_angle: float = 0.0
    clearance: float = 0.0
    first_azimuth: float = 0.0
    drop_outer: Callable = np.zeros_like
    drop_inner: Callable = np.zeros_like
    kinks: tuple = ()
    ribs: dict = field(default_factory=dict)

    @property
    def frame(self):
        """Roller centre, axis direction t and transverse direction m, all (z, r)."""
        cos, sin = math.cos(self.roller_axis_angle), -math.sin(self.roller_axis_angle)
        centre = np.array([0.0, 0.5 * self.pitch_diameter])
        return centre, np.array([cos, sin]), np.array([-sin, cos])


# Geometry of the section. ring: 0 outer, 1 inner; side: sign of m on that ring.


def raceway(bearing, ring, s):
    """Contact points (slice, 2) [m] and normal (2,) from the roller to the ring."""
    centre, t, m = bearing.frame
    cos, sin = math.cos(bearing.roller_half_angle), math.sin(bearing.roller_half_angle)
    side, s = (1, -1)[ring], np.asarray(s, dtype=float)[:, None]
    radius = 0.5 * bearing.roller_diameter - s * sin
    return centre + s * cos * t + side * radius * m, sin * t + side * cos * m


def rib(bearing, name):
    """Contact point (2,) [m] on the rib and normal (2,) from the roller to the rib."""
    end_radius, height, gap, _ = bearing.ribs[name]
    centre, t, m = bearing.frame
    ring, end = name.split("_")
    side = 1 if ring == "outer" else -1
    sign = 1 if end == "plus" else -1
    half = 0.5 * bearing.roller_length
    pole = centre + sign * half * math.cos(bearing.roller_half_angle) * t
    sphere = pole - sign * end_radius * t
    foot = raceway(bearing, 0 if side == 1 else 1, [sign * half])[0][0]
    # The rib's direction rho lies at the angle acos(height/|d|) from d = sphere - foot;
    # of the two, the one that leads more from the raceway towards the roller axis.
    d = sphere - foot
    along, across = d @ t, d @ m
    opening = math.acos(height / math.hypot(along, across))
    turns = [math.atan2(across, along) + angle for angle in (opening, -opening)]
    turn = min(turns, key=lambda angle: side * math.sin(angle))
    rho = math.cos(turn) * t + math.sin(turn) * m
    normal = np.array([-rho[1], rho[0]])
    normal *= sign * np.sign(normal @ t)
    return sphere + (end_radius + gap) * normal, normal


def rows(points, normal):
    """n . displacement of section points as rows (point, 3) on (u, v, theta)."""
    z, r = np.atleast_2d(points).T
    nz, nr = normal
    return np.stack([nz + 0 * z, nr + 0 * z, nr * z - nz * r], axis=1)


# Contacts of one roller.


@dataclass
class Contacts:
    """All slices of both raceways, then the ribs, of one roller in one state."""

    rows: np.ndarray
    ring: np.ndarray  # 0 outer, 1 inner
    kind: np.ndarray  # 0, 1: raceways; 2..5: ribs
    approach: np.ndarray
    constant: np.ndarray  # weight times C
    power: np.ndarray

    @property
    def energy(self):
        n = self.power
        return float(np.sum(self.constant * self.approach ** (n + 1) / (n + 1)))

    @property
    def load(self):
        return self.constant * self.approach**self.power

    @property
    def stiffness(self):
        n, m = self.power, self.approach
        return np.where(m > 0, n * self.constant * m ** (n - 1), 0.0)


def contacts(bearing, slices, rings, y) -> Contacts:
    """Contacts of a roller at y (3,) between rings (2, 3), section motions at O."""
    parts = []
    for ring, (rule, drop) in enumerate(
        zip(slices, (bearing.drop_outer, bearing.drop_inner), strict=True)
    ):

        def approach(s, ring=ring, drop=drop):
            moved = rows(*raceway(bearing, ring, s)) @ (rings[ring] - y)
            return -(0.25 * bearing.clearance + drop(s) + moved)

        nodes = rule(approach) if callable(rule) else rule
        s, w = nodes  # pyright: ignore[reportGeneralTypeIssues]
        s, w = np.asarray(s, dtype=float), np.asarray(w, dtype=float)
        lever = rows(*raceway(bearing, ring, s))
        one = np.ones_like(s)
        constant = bearing.line_constant[ring] * w
        parts.append((lever, ring * one, ring * one, approach(s), constant, LINE * one))
    for index, name in enumerate(RIBS):
        if name in bearing.ribs:
            lever, ring = rows(*rib(bearing, name)), index // 2
            _, _, gap, constant = bearing.ribs[name]
            gap = gap + lever @ (rings[ring] - y)
            parts.append((lever, [ring], [2 + index], -gap, [constant], [POINT]))
    # One open row more: a rule may return no slices at all.
    parts.append((np.zeros((1, 3)), [0], [0], [-1.0], [0.0], [LINE]))
    both = [np.concatenate(column) for column in zip(*parts, strict=True)]
    both[3] = np.maximum(both[3], 0.0)
    return Contacts(*both)


# Equilibrium of one roller.


def scaling(bearing):
    """Matrix (3, 3): centre along t, along m, tilt times L/2 [m] -> (u, v, theta)."""
    centre, t, m = bearing.frame
    tilt = 2.0 / bearing.roller_length
    return np.array([[t[0], m[0], centre[1] * tilt], [t[1], m[1], 0.0], [0, 0, tilt]])


def decompose(state, turn):
    """Singular values etc. of sqrt(stiffness) rows: roots of the roller's Hessian."""
    root = np.sqrt(state.stiffness)[:, None] * state.rows @ turn
    left, values, right = np.linalg.svd(
        np.vstack([root, np.zeros((3, 3))]), full_matrices=False
    )
    return left[: len(root)], values, right.T


def equilibrium(bearing, slices, rings, inertia):
    """Roller motion (3,) of least energy, and its contacts.

    Levenberg steps on the convex energy, then plain Newton steps (halved where they
    do not help) for as long as the gradient falls.

    Raises:
        RuntimeError: If the forces do not balance to 1e-10 of the contact loads.
    """
    turn = scaling(bearing)
    y = 0.5 * (rings[0] + rings[1])
    outside = turn.T @ inertia
    limit = max(bearing.line_constant) * bearing.roller_length
    typical = LINE * limit * 1e-6 ** (LINE - 1)

    def at(y):
        state = contacts(bearing, slices, rings, y)
        return state, (state.load @ state.rows) @ turn - outside

    def step(state, gradient, damping):
        _, values, basis = decompose(state, turn)
        slope = basis.T @ gradient
        scale = np.sum(state.load) + np.linalg.norm(outside)
        held = values > 1e-13 * values[0]
        held |= np.abs(slope) > 1e-11 * scale
        stiff = values**2 + damping * max(values[0] ** 2, typical)
        held &= stiff > 0
        return -turn @ basis @ np.where(held, slope / np.where(held, stiff, 1.0), 0.0)

    state, gradient = at(y)
    damping = 1e-3
    for _ in range(300):
        if not inertia.any() and state.approach.max() < LOOSE:
            state.approach[:] = 0.0
            return y, state
        scale = np.sum(state.load) + np.linalg.norm(outside)
        if np.linalg.norm(gradient) <= 1e-8 * scale or damping > 1e12:
            break
        trial = y + step(state, gradient, damping)
        new, new_gradient = at(trial)
        if new.energy - state.energy < inertia @ (trial - y):
            y, state, gradient = trial, new, new_gradient
            damping *= 0.1
        else:
            damping = max(10.0 * damping, 1e-12)
    for _ in range(200):
        full = step(state, gradient, 0.0)
        for halving in range(8):
            trial = y + 0.5**halving * full
            new, new_gradient = at(trial)
            if np.linalg.norm(new_gradient) < np.linalg.norm(gradient):
                y, state, gradient = trial, new, new_gradient
                break
        else:
            break
    allowed = 1e-10 * (np.sum(state.load) + np.linalg.norm(outside))
    if not np.linalg.norm(gradient) <= allowed + limit * 1e-13**LINE:
        raise RuntimeError(f"roller not in equilibrium: {gradient} N")
    return y, state


def condense(bearing, state, inertia):
    """Condensed force (6,) and stiffness (6, 6) on the two rings' section freedoms."""
    turn = scaling(bearing)
    on_ring = np.zeros((len(state.rows), 6))
    for ring in (0, 1):
        mine = state.ring == ring
        on_ring[mine, 3 * ring : 3 * ring + 3] = -state.rows[mine]
    # K_rr - K_ro K_oo^+ K_or as a projection: the square roots of the stiffness on the
    # rings, less what the roller can follow. Twice the digits of the textbook form.
    left, values, basis = decompose(state, turn)
    held = values > 1e-13 * values[0]
    left, values, basis = left[:, held], values[held], basis[:, held]
    root = np.sqrt(state.stiffness)[:, None] * on_ring
    rest = root - left @ (left.T @ root)
    unbalanced = turn.T @ (state.load @ state.rows - inertia)
    follow = (root.T @ left / values) @ (basis.T @ unbalanced)
    return state.load @ on_ring - follow, rest.T @ rest


def evaluate(bearing, q, slices, inertia=None) -> dict:
    """Force, stiffness and roller loads of a bearing for given ring motions.

    Args:
        bearing: An `OracleBearing`.
        q: (12,) outer (ux uy uz gx gy gz), then inner [m, rad].
        slices: For outer and inner raceway either positions and widths (s, w) [m] or
            a rule `approach -> (s, w)` as from `graded`.
        inertia: Constant load (3,) on every roller, at O [N, N, N m].

    Returns:
        force (12,), stiffness (12, 12), roller_load (n, 2), rib_load (n, 4),
        roller_motion (n, 3), and energy (contact energy less inertia . motion). Along a
        free direction the roller's centre stays at the mean of the rings.
    """
    inertia = np.zeros(3) if inertia is None else np.asarray(inertia, dtype=float)
    n = bearing.n_rollers
    force, stiffness, energy = np.zeros(12), np.zeros((12, 12)), 0.0
    load, motion = np.zeros((n, 6)), np.zeros((n, 3))
    for roller in range(n):
        azimuth = bearing.first_azimuth + 2 * math.pi * roller / n
        cos, sin = math.cos(azimuth), math.sin(azimuth)
        one = np.zeros((3, 6))
        one[0, 2] = 1.0
        one[1, 0], one[1, 1] = cos, sin
        one[2, 3], one[2, 4] = -sin, cos
        both = np.kron(np.eye(2), one)
        y, state = equilibrium(bearing, slices, (both @ q).reshape(2, 3), inertia)
        local_force, local_stiffness = condense(bearing, state, inertia)
        force += both.T @ local_force
        stiffness += both.T @ local_stiffness @ both
        energy += state.energy - inertia @ y
        motion[roller] = y
        load[roller] = np.bincount(state.kind.astype(int), state.load, minlength=6)
    return {
        "force": force,
        "stiffness": stiffness,
        "roller_load": load[:, :2],
        "rib_load": load[:, 2:],
        "roller_motion": motion,
        "energy": energy,
    }


# Slices and integrals.


def midpoint_slices(length, count):
    """Equal slices: middles and widths [m]."""
    edges = np.linspace(-0.5 * length, 0.5 * length, count + 1)
    return 0.5 * (edges[1:] + edges[:-1]), np.full(count, length / count)


def loaded_intervals(approach, half_length, kinks=()):
    """Intervals where the approach is positive, cut at the kinks, edges to round-off.

    Dense samples, clustered at panel ends, find them; where all samples of a panel are
    open, its maximum is looked for, so that a zone between two samples is found too.
    """
    share = np.linspace(0.0, 1.0, 41)

    def value(s):
        with np.errstate(divide="ignore"):
            return approach(s)

    def edge(inside, outside):
        """Loaded end of a sign change: bisection, forty parts at a time."""
        while True:
            s = np.linspace(inside, outside, len(share))
            open_ = value(s) <= 0
            open_[-1] = True
            index = int(np.argmax(open_[1:]))
            if (s[index], s[index + 1]) == (inside, outside):
                return inside
            inside, outside = s[index], s[index + 1]

    cosine = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 2001))
    close = 10.0 ** np.arange(-15, -6)
    inner = sorted(k for k in set(kinks) if -half_length < k < half_length)
    ends = [-half_length, *inner, half_length]
    found = []
    for start, end in zip(ends[:-1], ends[1:], strict=True):
        s = [start + (end - start) * x for x in (cosine, close)]
        s = np.concatenate([*s, end - (end - start) * close])
        s = np.unique(np.clip(s, start, end))
        f = value(s)
        if not f.max() > 0:
            best, peak = int(np.argmax(f)), s
            for _ in range(12):
                low, high = peak[max(best - 1, 0)], peak[min(best + 1, len(peak) - 1)]
                peak = low + (high - low) * share
                best = int(np.argmax(value(peak)))
            s = np.unique(np.append(s, peak[best]))
            f = value(s)
        change = np.diff(np.concatenate([[0], f > 0, [0]]).astype(int))
        firsts, lasts = np.flatnonzero(change > 0), np.flatnonzero(change < 0) - 1
        for first, last in zip(firsts, lasts, strict=True):
            a = s[first] if first == 0 else edge(s[first], s[first - 1])
            b = s[last] if last == len(s) - 1 else edge(s[last], s[last + 1])
            found.append((a, b))
    return found


@cache
def graded_rule(points):
    """Nodes, counted from the nearer end of [0, 1], and weights; t^9 at both ends."""
    x, w = np.polynomial.legendre.leggauss(points)
    t = 0.5 * (x + 1)
    near = np.minimum(t, t[::-1])
    # Share of the interval passed at t: the regularised incomplete beta function.
    part = sum(
        math.comb(17, j) * near**j * (1 - near) ** (17 - j) for j in range(9, 18)
    )
    return part, 0.5 * w * 17 * math.comb(16, 8) * (t * (1 - t)) ** 8


def graded_slices(approach_fn, half_length, kinks=(), points=200):
    """Gauss-Legendre nodes and weights [m] graded to both ends of each loaded interval.

    The substitution turns the powers 1/9 and 10/9 of a zone edge into polynomials.

    Args:
        approach_fn: Vectorised s [m] -> approach [m].
        half_length: [m].
        kinks: Interior positions [m] where the approach has a kink.
        points: Nodes per interval.

    Returns:
        nodes, weights [m]; empty where nothing is loaded.
    """
    part, weight = graded_rule(points)
    first = np.arange(points) < points // 2
    nodes, weights = [np.zeros(0)], [np.zeros(0)]
    for a, b in loaded_intervals(approach_fn, half_length, kinks):
        nodes.append(np.where(first, a + (b - a) * part, b - (b - a) * part))
        weights.append((b - a) * weight)
    return np.concatenate(nodes), np.concatenate(weights)


def graded(bearing, points=200):
    """Rules for `evaluate` that follow the loaded zones: the exact integrals."""

    def rule(approach):
        return graded_slices(
            approach, 0.5 * bearing.roller_length, bearing.kinks, points
        )

    return rule, rule


def line_moments(a, b, drop, C, half_length, kinks=()):
    """Integrals of one raceway contact with the approach a + b s - drop(s).

    Args:
        a: [m]. b: [1]. C: [N/m^(19/9)]. half_length, kinks: [m].
        drop: Callable s [m] -> [m].

    Returns:
        energy [J], force dE/da [N], moment dE/db [N m], and the second derivatives
        [aa, ab, bb] [N/m, N, N m].
    """
    s, w = graded_slices(lambda s: a + b * s - drop(s), half_length, kinks)
    m = np.maximum(a + b * s - drop(s), 0.0)
    load, stiff = C * w * m**LINE, C * w * LINE * m ** (LINE - 1)
    energy = C / (LINE + 1) * np.sum(w * m ** (LINE + 1))
    second = np.array([np.sum(stiff), np.sum(stiff * s), np.sum(stiff * s * s)])
    return energy, np.sum(load), np.sum(load * s), second


# Random bearings.


def make_drop(profile, diameter, length):
    """Drop function of a profile given as {"type": ..., numbers}, and its kinks [m]."""
    kind = profile["type"]
    if kind == "straight":
        return np.zeros_like, ()
    if kind == "logarithmic":

        def logarithmic(s):
            x = 2 * np.asarray(s) / length
            return -3.5e-4 * diameter * np.log((1 - x) * (1 + x))

        return logarithmic, ()
    radius, flat = profile["radius"], 0.5 * profile.get("straight_length", 0.0)

    def arc(s):
        x = np.maximum(np.abs(s) - flat, 0.0)
        return x * x / (radius + np.sqrt((radius - x) * (radius + x)))

    return arc, ((-flat, flat) if kind == "crowned_ends" else ())


def random_case(seed):
    """A random bearing with at least one loaded roller.

    Returns:
        bearing, q (12,), and a dict of plain numbers [SI] that describe the bearing:
        kind, all dimensions, line_constant (of each contact), young, poisson, ribs
        {name: {end_radius, contact_height, axial_gap}}, profile and raceway_profile
        ({"outer", "inner"}) as {"type": ..., numbers}, the type being "straight",
        "circular" (radius), "crowned_ends" (radius, straight_length), "logarithmic".
    """
    rng = np.random.default_rng(seed)
    while True:
        info = _random_design(rng)
        q = _random_motion(rng, info)
        bearing = build(info)
        rough = midpoint_slices(bearing.roller_length, 15)
        load = evaluate(bearing, q, (rough, rough))["roller_load"]
        if 1.0 < load.max() < 2e6:
            return bearing, q, info


def build(info) -> OracleBearing:
    """The bearing of a description as `random_case` returns it."""
    drops, kinks = {}, ()
    for ring in ("outer", "inner"):
        size = info["roller_diameter"], info["roller_length"]
        roller, kinks = make_drop(info["profile"], *size)
        track, _ = make_drop(info["raceway_profile"][ring], *size)
        drops[ring] = lambda s, roller=roller, track=track: roller(s) + track(s)
    modulus = info["young"] / (2 * (1 - info["poisson"] ** 2))
    ribs = {}
    for name, r in info["ribs"].items():
        hertz = 4 / 3 * modulus * math.sqrt(r["end_radius"])
        ribs[name] = (r["end_radius"], r["contact_height"], r["axial_gap"], hertz)
    same = ("n_rollers", "pitch_diameter", "roller_diameter", "roller_length")
    same += ("roller_axis_angle", "roller_half_angle", "clearance", "first_azimuth")
    return OracleBearing(
        **{name: info[name] for name in same},
        line_constant=(info["line_constant"],) * 2,
        drop_outer=drops["outer"],
        drop_inner=drops["inner"],
        kinks=kinks,
        ribs=ribs,
    )


def _random_design(rng):
    n, diameter = int(rng.integers(5, 10)), rng.uniform(6e-3, 30e-3)
    length = diameter * rng.uniform(0.8, 2.5)
    tapered = bool(rng.random() < 0.5)
    axis = math.radians(rng.uniform(5, 20)) if tapered else 0.0
    half = math.radians(rng.uniform(0.5, 3)) if rng.random() < 0.7 and tapered else 0.0
    # Neither end of a roller may reach its neighbour.
    reach = 0.5 * length * math.cos(half)
    pitch = 2 * max(
        (0.5 * diameter - side * reach * math.tan(half)) / math.sin(math.pi / n)
        + side * reach * math.sin(axis)
        for side in (-1, 1)
    )
    names = [name for name in RIBS if rng.random() < (0.25 if tapered else 0.6)]
    if tapered:
        names = sorted({*names, "inner_minus"}, key=RIBS.index) if half else []
    elif rng.random() < 0.4:
        names = []
    sphere = rng.uniform(0.5, 1.0) / math.tan(half) if half else rng.uniform(4, 40)
    ribs = {
        name: {
            "end_radius": 0.5 * diameter * sphere,
            "contact_height": diameter * rng.uniform(0.02, 0.25),
            "axial_gap": rng.uniform(-2e-6, 20e-6 if tapered else 60e-6),
        }
        for name in names
    }
    kind = rng.choice(["straight", "circular", "crowned_ends", "logarithmic"])
    profile = {"type": str(kind)}
    end_drop = 1e-6 * 20 ** rng.random()
    if kind == "circular":
        profile["radius"] = length**2 / (8 * end_drop)
    elif kind == "crowned_ends":
        profile["straight_length"] = length * rng.uniform(0.3, 0.8)
        profile["radius"] = (length - profile["straight_length"]) ** 2 / (8 * end_drop)
    tracks = {"outer": {"type": "straight"}, "inner": {"type": "straight"}}
    if rng.random() < 0.25:
        name, radius = str(rng.choice(["outer", "inner"])), length**2 / (8 * end_drop)
        tracks[name] = {"type": "circular", "radius": radius}
    palmgren = 8.06e4 * (1e3) ** (19 / 9) * (1e3 * length) ** (-1 / 9)
    return {
        "kind": "tapered" if tapered else "cylindrical",
        "n_rollers": n,
        "pitch_diameter": pitch * rng.uniform(1.03, 1.5),
        "roller_diameter": diameter,
        "roller_length": length,
        "roller_axis_angle": axis,
        "roller_half_angle": half,
        "clearance": rng.uniform(-10e-6, 60e-6),
        "first_azimuth": rng.uniform(0, 2 * math.pi),
        "line_constant": palmgren * rng.uniform(0.8, 1.2),
        "young": 206e9,
        "poisson": 0.3,
        "profile": profile,
        "raceway_profile": tracks,
        "ribs": ribs,
    }


def _random_motion(rng, info):
    size = float(rng.choice([1.0, 0.3, 0.02]))
    q = np.concatenate(
        [rng.uniform(-1, 1, 6) * size * np.repeat([60e-6, 3e-3], 3) for _ in range(2)]
    )
    if size == 0.02:
        # Just enough to press a few rollers; the others stay loose.
        way = rng.uniform(0, 2 * math.pi)
        push = max(0.5 * info["clearance"], 0.0) + rng.uniform(1e-6, 10e-6)
        q[6:8] += push * np.array([math.cos(way), math.sin(way)])
    q[[5, 11]] = 0.0
    return q


def differences(bearing, q, slices, way, step):
    """Relative errors of force and stiffness along `way` by central differences."""
    base = evaluate(bearing, q, slices)
    far = [evaluate(bearing, q + k * step * way, slices) for k in (-2, -1, 1, 2)]
    errors = []
    for low, high in (("energy", "force"), ("force", "stiffness")):
        f = [np.asarray(x[low]) for x in far]
        slope = (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * step)
        exact = base[high] @ way
        errors.append(np.max(np.abs(slope - exact)) / np.max(np.abs(exact)))
    return errors


def imbalance(force):
    """Sum of both rings' forces, relative to the largest force and moment."""
    outer, inner = force.reshape(2, 2, 3)
    return max(
        np.max(np.abs(outer[i] + inner[i])) / np.max(np.abs(outer[i])) for i in (0, 1)
    )


if __name__ == "__main__":
    for seed in range(6):
        bearing, q, info = random_case(seed)
        middle = (midpoint_slices(bearing.roller_length, 20),) * 2
        way = np.random.default_rng(seed).uniform(-1, 1, 12)
        way *= np.tile(np.repeat([1.0, 20.0], 3), 2)
        for name, rule in (("midpoint", middle), ("graded", graded(bearing))):
            force, stiffness = differences(bearing, q, rule, way, 2e-8)
            balance = imbalance(evaluate(bearing, q, rule)["force"])
            print(
                f"{seed} {info['kind']:11s} {info['profile']['type']:12s} {name:8s}"
                f" force {force:.0e}, stiffness {stiffness:.0e}, balance {balance:.0e}"
            )

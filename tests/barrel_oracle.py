"""Independent reference for barrel rollers: plain NumPy, point by point.

Written from the geometry alone. A roller is a set of points P on its two generators,
each raceway an arc about a centre A that its ring carries; both move exactly as rigid
bodies in the axial section. A point goes |P - A| - R beyond the arc, a rib as far as
the displacement of the end sphere along the normal of the drawing says. Energy per
length c/(n + 1) m^(n+1) of a penetration m, n = 10/9. Derivatives: gradients by hand,
Hessians by complex step of the gradients.
"""

import math
from dataclasses import dataclass, field

import numpy as np

LINE, POINT = 10 / 9, 3 / 2


@dataclass
class Barrel:
    """One row in plain numbers, lengths in m, angles in rad.

    Attributes:
        n, pitch, diameter, length: Rollers, their circle and size.
        axis, half: Angle of the roller axis, half cone angle.
        radii: Of the arcs of roller, outer and inner raceway.
        gap: At each raceway along the normal.
        constant: c of either contact [N/m^(19/9)].
        place: z of the roller centres.
        first: Azimuth of roller 0.
        ribs: (on the outer ring, centre (t, m), point (t, m), normal (t, m), gap,
            constant) in roller axes.
    """

    n: int
    pitch: float
    diameter: float
    length: float
    axis: float
    half: float
    radii: tuple
    gap: float
    constant: float
    place: float = 0.0
    first: float = 0.0
    ribs: tuple = field(default=())

    def section(self, rules):
        """Raceways, ribs, axes and roller centre at rest, in (z, r).

        Args:
            rules: Positions and widths of the slices at the outer and inner raceway.
        """
        cos, sin = math.cos(self.axis), math.sin(self.axis)
        axes = np.array([[cos, sin], [-sin, cos]])  # columns t, m in (z, r)
        centre = np.array([self.place, 0.5 * self.pitch])
        out = []
        for (s, width), side, radius in zip(
            rules, (1, -1), self.radii[1:], strict=True
        ):
            drop = self.radii[0] - np.sqrt(self.radii[0] ** 2 - s**2)
            along = np.array([math.cos(self.half), -side * math.sin(self.half)])
            normal = np.array([math.sin(self.half), side * math.cos(self.half)])
            middle = np.array([0.0, side * 0.5 * self.diameter])
            points = middle + s[:, None] * along - drop[:, None] * normal
            arc = middle + (self.gap - radius) * normal
            out.append((centre + points @ axes.T, centre + axes @ arc, radius, width))
        ribs = [
            (outer, centre + axes @ c, centre + axes @ p, axes @ normal, gap, constant)
            for outer, c, p, normal, gap, constant in self.ribs
        ]
        return (out, ribs, self.constant), axes, centre

    def uniform(self, slices):
        """Rules of equal slices."""
        edges = np.linspace(-0.5 * self.length, 0.5 * self.length, slices + 1)
        rule = 0.5 * (edges[1:] + edges[:-1]), np.full(slices, self.length / slices)
        return rule, rule

    def loaded(self, y, nodes=200):
        """Rules of Gauss nodes on the loaded part of each raceway, crowded to its ends.

        The loaded part is one interval: arcs cross at most twice.
        """
        tau, weight = np.polynomial.legendre.leggauss(nodes)
        t = 0.5 * (tau + 1.0)
        part, weight = t**3 * (10 - 15 * t + 6 * t**2), 15 * weight * (t - t**2) ** 2
        s, rules = np.linspace(-0.5 * self.length, 0.5 * self.length, 2001), []
        parts, _, _ = self.section([(s, s)] * 2)
        for ring, (points, arc, radius, _) in enumerate(parts[0]):
            p, a = _moved(y[6:], points)[0], _moved(y[3 * ring : 3 * ring + 3], arc)[0]
            m = np.linalg.norm(p - a, axis=1) - radius
            inside = np.flatnonzero(m > 0)
            if inside.size == 0:
                rules.append((np.zeros(1), np.zeros(1)))
                continue
            ends = []
            for last, way in ((inside[0], -1), (inside[-1], 1)):
                beyond, end = last + way, s[last]
                if 0 <= beyond < s.size:
                    end = end + (s[beyond] - end) * m[last] / (m[last] - m[beyond])
                ends.append(end)
            rules.append((ends[0] + np.ptp(ends) * part, np.ptp(ends) * weight))
        return rules


def _moved(motion, points):
    """Points of a body after (u, v, θ) about O, and their derivatives by θ."""
    cos, sin = np.cos(motion[2]), np.sin(motion[2])
    turn = np.array([[cos, -sin], [sin, cos]])
    turned = points @ turn.T
    return turned + motion[:2], np.stack([-turned[..., 1], turned[..., 0]], axis=-1)


def _gradient(parts, y):
    """Energy and gradient (9,) by the motions of outer ring, inner ring and roller."""
    raceways, ribs, constant = parts
    out, energy = np.zeros(9, dtype=y.dtype), 0.0
    loads = []
    for ring, (points, arc, radius, width) in enumerate(raceways):
        mine, own = slice(3 * ring, 3 * ring + 3), slice(6, 9)
        p, dp = _moved(y[own], points)
        a, da = _moved(y[mine], arc)
        apart = p - a
        distance = np.sqrt(np.sum(apart * apart, axis=1))
        m = distance - radius
        m = np.where(m.real > 0, m, 0.0)
        force = width * constant * m**LINE
        way = apart / distance[:, None]
        energy = energy + np.sum(force * m) / (LINE + 1)
        push = force[:, None] * way
        out[own] += np.concatenate([push.sum(0), [np.sum(push * dp)]])
        out[mine] -= np.concatenate([push.sum(0), [np.sum(push, axis=0) @ da]])
        loads.append(np.sum(force))
    for outer, centre, point, normal, gap, stiff in ribs:
        mine, own = slice(0 if outer else 3, 3 if outer else 6), slice(6, 9)
        c, dc = _moved(y[own], centre)
        p, dp = _moved(y[mine], point)
        m = (c - centre - (p - point)) @ normal - gap
        m = m if m.real > 0 else 0.0 * m
        force = stiff * m**POINT
        energy = energy + force * m / (POINT + 1)
        out[own] += force * np.array([*normal, normal @ dc])
        out[mine] -= force * np.array([*normal, normal @ dp])
        loads.append(force)
    return energy, out, loads


def _hessian(parts, y, which):
    step, columns = 1e-30, []
    for k in which:
        turned = y.astype(complex)
        turned[k] += 1j * step
        columns.append(_gradient(parts, turned)[1].imag / step)
    return np.stack(columns, axis=1)


def evaluate(row: Barrel, q, inertia=None):
    """Force (12,), stiffness (12, 12) and loads of a row at ring motions q (12,).

    Args:
        row: The row.
        q: Outer ring, then inner ring [m, rad].
        inertia: Constant load (u, v, θ) of every roller at O [N, N, N m].

    Raises:
        RuntimeError: If a roller does not come to rest.
    """
    rough, axes, centre = row.section(row.uniform(200))
    inertia = np.zeros(3) if inertia is None else np.asarray(inertia)
    # Unknowns: the centre along t and m, tilt times L/2.
    tilt = 2.0 / row.length
    scale = np.array(
        [
            [axes[0, 0], axes[0, 1], centre[1] * tilt],
            [axes[1, 0], axes[1, 1], -centre[0] * tilt],
            [0.0, 0.0, tilt],
        ]
    )
    force, stiffness, loads = np.zeros(12), np.zeros((12, 12)), []
    for roller in range(row.n):
        azimuth = row.first + 2 * math.pi * roller / row.n
        cos, sin = math.cos(azimuth), math.sin(azimuth)
        one = np.zeros((3, 6))
        one[0, 2] = 1.0
        one[1, 0], one[1, 1] = cos, sin
        one[2, 3], one[2, 4] = -sin, cos
        both = np.kron(np.eye(2), one)
        rings = both @ q
        y = np.concatenate([rings, 0.5 * (rings[:3] + rings[3:])])
        y = _rest(rough, y, scale, inertia)
        for _ in range(3):
            parts, _, _ = row.section(row.loaded(y))
            y = _rest(parts, y, scale, inertia)
        _, gradient, found = _gradient(parts, y)
        loads.append(found)
        if not sum(found) > 1e-9:  # N; apart, or touching
            continue
        hessian = _hessian(parts, y, range(9))
        own = scale.T @ hessian[6:, 6:] @ scale
        cross = scale.T @ hessian[6:, :6]
        follow = np.linalg.solve(own, cross)
        force += both.T @ gradient[:6]
        stiffness += both.T @ (hessian[:6, :6] - cross.T @ follow) @ both
    return force, stiffness, np.array(loads)


def _rest(parts, y, scale, inertia):
    """Newton's method with a growing share of the steepest descent where it fails."""
    damping = 1e-6
    for _ in range(400):
        energy, gradient, loads = _gradient(parts, y)
        slope = scale.T @ (gradient[6:] - inertia)
        size = sum(loads) + np.linalg.norm(inertia)
        if size < 1e-9 or np.linalg.norm(slope) < 1e-11 * size:
            return y
        own = scale.T @ _hessian(parts, y, (6, 7, 8))[6:] @ scale
        stiff = own + damping * np.max(np.abs(own)) * np.eye(3)
        trial = y.copy()
        trial[6:] -= scale @ np.linalg.solve(stiff, slope)
        new, after, _ = _gradient(parts, trial)
        better = new - energy < inertia @ (trial - y)[6:]
        flat = np.linalg.norm(scale.T @ (after[6:] - inertia)) < np.linalg.norm(slope)
        if better or flat:
            y, damping = trial, max(0.1 * damping, 1e-15)
        else:
            damping = max(10.0 * damping, 1e-12)
        if damping > 1e6:
            break
    if np.linalg.norm(slope) < 1e-8 * size:
        return y
    raise RuntimeError(f"roller not at rest: {slope} N of {size} N")

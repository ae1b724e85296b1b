"""Linearly implicit integrator for stiff motion, for Diffrax.

A step solves linear systems alone, with one matrix and the exact Jacobian at its
beginning. Newton's method in an implicit Runge-Kutta step cannot follow contacts whose
stiffness grows by orders of magnitude along the orbit: with 12 balls Kvaerno5 needed 10
times as many steps at a tolerance of 1e-4 and 7 times at 1e-6, Kvaerno3 5 and 3 times.

Imported where it is used, as Diffrax is.
"""

from collections.abc import Callable
from typing import Any, ClassVar

import diffrax
import jax
import jax.numpy as jnp
import numpy as np

_GAMMA = 0.25
_A = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.831036793486759, 0.4955183967433795, 0.0, 0.0, 0.0, 0.0],
        [2.304376582692669, -0.05249275245743001, -1.176798761832782, 0.0, 0.0, 0.0],
        [-7.170454962423024, -4.741636671481785, -16.31002631330971]
        + [-1.062004044111401, 0.0, 0.0],
        [-7.170454962423024, -4.741636671481785, -16.31002631330971]
        + [-1.062004044111401, 1.0, 0.0],
    ]
)
_C = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-12.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-8.791795173947035, -2.207865586973518, 0.0, 0.0, 0.0, 0.0],
        [10.81793056857153, 6.780270611428266, 19.5348594464241, 0.0, 0.0, 0.0],
        [34.19095006749676, 15.49671153725963, 54.7476087596413]
        + [14.16005392148534, 0.0, 0.0],
        [34.62605830930532, 15.30084976114473, 56.99955578662667]
        + [18.40807009793095, -5.714285714285717, 0.0],
    ]
)
_TIME = (0.0, 0.75, 0.21, 0.63, 1.0, 1.0)
_SLOPE = (0.25, -0.5, -0.023504, -0.0362, 0.0, 0.0)
_DENSE = np.array(
    [
        [25.09876703708589, 11.62013104361867, 28.49148307714626, -5.664021568594133]
        + [0.0, 0.0],
        [1.638054557396973, -0.7373619806678748, 8.47791821923899, 15.9925314877952]
        + [-1.882352941176471, 0.0],
    ]
)


class Cubic(diffrax.AbstractLocalInterpolation):
    """Cubic interpolation of the motion within a step."""

    t0: Any
    t1: Any
    y0: Any
    y1: Any
    bend: Any

    def evaluate(self, t0: Any, t1: Any = None, left: bool = True) -> Any:
        """Return the motion at a time, or its change between two."""
        if t1 is not None:
            return jax.tree.map(jnp.subtract, self.evaluate(t1), self.evaluate(t0))
        x = (t0 - self.t0) / jnp.where(self.t1 == self.t0, 1.0, self.t1 - self.t0)

        def interpolate(begin, end, bend):
            return (1.0 - x) * begin + x * (end + (1.0 - x) * (bend[0] + x * bend[1]))

        return jax.tree.map(interpolate, self.y0, self.y1, self.bend)


class Rodas(diffrax.AbstractAdaptiveSolver):
    """RODASP: six stages, order 4, error of order 3, stiffly accurate.

    The `args` of the equation are its `AbstractSystem`, the state is a `CoupledState`.

    Source: Steinebach (1995); the transformed form, without products with the Jacobian,
        of Hairer & Wanner, Solving Ordinary Differential Equations II, IV.7; unknowns
        without mass: VI.4 there.
    """

    term_structure: ClassVar = diffrax.AbstractTerm
    interpolation_cls: ClassVar[Callable[..., Cubic]] = Cubic

    def order(self, terms: Any) -> int:
        """Order of the method."""
        return 4

    def error_order(self, terms: Any) -> float:
        """Order of the error of a step."""
        return 4.0

    def init(self, terms: Any, t0: Any, t1: Any, y0: Any, args: Any) -> None:
        """Return no state: nothing is kept from step to step."""
        return None

    def func(self, terms: Any, t0: Any, y0: Any, args: Any) -> Any:
        """Right-hand side."""
        return args.rates(t0, y0)

    def step(
        self,
        terms: Any,
        t0: Any,
        t1: Any,
        y0: Any,
        args: Any,
        solver_state: Any,
        made_jump: Any,
    ) -> tuple:
        """Make a step, by Diffrax's interface."""
        h, real = t1 - t0, y0.own.dtype
        slopes, masses = args.slopes(t0, y0), args.masses
        solve = slopes.solver(masses, 1.0 / (h * _GAMMA))

        def combine(weights, stages):
            return jax.tree.map(lambda s: jnp.tensordot(weights, s, axes=1), stages)

        def stage(stages, row):
            index, a, c, time, slope = row
            moved = jax.tree.map(jnp.add, y0, combine(a, stages))
            before = masses.times(combine(c / h, stages))
            right = jax.tree.map(
                lambda r, b, t: r + b + (h * slope) * t,
                args.rates(t0 + time * h, moved),
                before,
                slopes.time,
            )
            new = solve(right)
            return jax.tree.map(lambda s, x: s.at[index].set(x), stages, new), None

        # One after the other, but compiled once.
        count = len(_TIME)
        none = jax.tree.map(lambda y: jnp.zeros((count, *y.shape), real), y0)
        rows = [jnp.asarray(v, real) for v in (_A, _C, _TIME, _SLOPE)]
        stages, _ = jax.lax.scan(stage, none, (np.arange(count), *rows))
        error = jax.tree.map(lambda s: s[-1], stages)
        end = combine(rows[0][-1], stages)
        y1 = jax.tree.map(lambda y, x, e: y + x + e, y0, end, error)
        dense = jnp.asarray(_DENSE, real)
        bend = jax.tree.map(lambda s: jnp.tensordot(dense, s, axes=1), stages)
        info = dict(y0=y0, y1=y1, bend=bend)
        return y1, error, info, None, diffrax.RESULTS.successful
